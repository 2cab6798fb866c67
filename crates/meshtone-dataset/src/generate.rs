//! Generating a data set, from its start or from the point where it was stopped.

use std::collections::{BTreeMap, HashMap};
use std::fmt::Display;
use std::fs::File;
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Mutex, PoisonError};

use meshtone::batch::{Control, KeepOf, simulate_many};
use meshtone::scenario::{Scenario, ScenarioError, WarningKind};
use rayon::prelude::*;

use crate::contents::{OTHER_SHARD, WRONG_BYTES, add_warnings, warnings};
use crate::digest::Hashing;
use crate::draw::Sampler;
use crate::error::DatasetError;
use crate::finish;
use crate::manifest::{self, CARD, MANIFEST, PREVIEW};
use crate::plan::{Plan, with_faults};
use crate::record::{KeepRecords, Record, Role, simulated_scenario};
use crate::shard::{self, FailedRecord, Item, Shards, WARNINGS, Wanted};
use crate::store::Destination;
use crate::verify::Check;

/// Largest number of records that wait to be written.
const WAITING: usize = 32;

/// A part of a data set: some of its shards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Number of the part, from 1.
    pub number: u64,
    /// Number of parts.
    pub of: u64,
}

impl Part {
    /// The whole data set.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Returns whether a shard belongs to the part. Shards are dealt to the parts in turn.
    ///
    /// # Arguments
    /// * `shard` - number of the shard
    pub fn has(&self, shard: u64) -> bool {
        shard % self.of == self.number - 1
    }
}

/// Progress and cancellation of a run.
pub struct GenerateControl<'a> {
    /// Called with the number of records that are done, and the number of all records of this run.
    pub progress: &'a (dyn Fn(u64, u64) + Sync),
    /// The caller sets it to stop the run. Complete shards are kept.
    pub cancelled: &'a AtomicBool,
}

/// The result of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Generated {
    /// Shards that were there already.
    pub kept_shards: u64,
    /// Shards that were written.
    pub written_shards: u64,
    /// Records of the written shards.
    pub written_records: u64,
    /// Records of the written shards that failed.
    pub failures: Vec<FailedRecord>,
    /// Number of records of the written shards by the kind of a warning about their simulation.
    pub warnings: BTreeMap<WarningKind, u64>,
    /// Records that failed earlier, in the shards that were there already.
    pub earlier_failures: Vec<FailedRecord>,
    /// Files that were there but had been changed since they were written, and have been made again.
    pub remade: Vec<Remade>,
    /// Whether the data set is complete, with manifest, data card and preview.
    pub complete: bool,
}

/// A file that had been changed since it was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remade {
    /// Name of the file from the data set's directory.
    pub file: String,
    /// What was wrong with the file.
    pub reason: String,
}

impl Generated {
    /// Number of records that were simulated now and stand in the written shards.
    pub fn simulated_records(&self) -> u64 {
        self.written_records - self.failures.len() as u64
    }

    /// All records that failed, in this run and earlier, in their order.
    pub fn missing(&self) -> Vec<&FailedRecord> {
        let mut missing: Vec<_> = self.earlier_failures.iter().chain(&self.failures).collect();
        missing.sort_by_key(|failed| failed.record);
        missing
    }
}

/// Generates a data set, or resumes it, in the threads of the current rayon pool.
///
/// # Arguments
/// * `plan` - the plan of the data set
/// * `to` - the place to write to
/// * `part` - the part to generate
/// * `control` - progress and cancellation
///
/// A shard that is there is kept if it has the SHA-256 in its footer, which was computed while it was written; otherwise it is made again. When all
/// shards are there, the data card, the preview and the complete manifest are written.
///
/// # Errors
/// The place has other files, or a data set of another plan; another program is making the same part there; a file cannot be
/// written, for example because the disk is full (complete shards are kept, and the next run resumes from them); or no record of the
/// plan can be simulated.
///
/// ```
/// use std::path::Path;
/// use meshtone_dataset::generate::{GenerateControl, Part, generate};
/// use meshtone_dataset::plan::Plan;
/// use meshtone_dataset::store::Destination;
///
/// let text = r#"
///     records = 4
///     units = 2
///     split = { train = 0.5 }
///     [scenario.gears]
///     module_mm = 3.0
///     pinion_teeth = 20
///     gear_teeth = 40
///     face_width_mm = 15.0
///     [scenario.operation]
///     pinion_speed_hz = 40.0
///     brake_torque_nm = 10.0
///     [scenario.quality]
///     din_grade = 7
///     [[class]]
///     label = "healthy"
///     [[class]]
///     label = "missing tooth"
///     fault = { kind = "missing-tooth" }
/// "#;
/// let plan = Plan::read_text(text.to_owned(), Path::new("plan.toml"))?;
/// let directory = tempfile::tempdir()?;
/// let control = GenerateControl { progress: &|_, _| {}, cancelled: &false.into() };
/// let to = Destination::directory(directory.path().join("set"));
/// let generated = generate(&plan, &to, Part::WHOLE, &control)?;
/// assert!(generated.complete && generated.failures.is_empty());
/// assert!(directory.path().join("set/README.md").exists());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn generate(
    plan: &Plan,
    to: &Destination,
    part: Part,
    control: &GenerateControl,
) -> Result<Generated, DatasetError> {
    if part.number == 0 || part.number > part.of {
        let problem = format!("there is no part {} of {}", part.number, part.of);
        return Err(DatasetError::refused(problem, "parts are numbered from 1"));
    }
    let sampler = Sampler::of_plan(plan)?;
    let shards = Shards::new(plan, &sampler);
    let (was_complete, _) = manifest::check_place(plan, &shards, to)?;
    // A data set that is called complete is examined all the same: a file may have been lost or damaged since.
    let look = || PartContents::look(plan, &shards, to, part);
    let there = was_complete.then(look).transpose()?;
    if let Some(found) = there.as_ref().filter(|found| found.missing.is_empty() && found.has_documents) {
        return Ok(found.generated.clone());
    }
    if !was_complete {
        manifest::begin(plan, to)?;
    }
    let (number, of) = (part.number, part.of);
    let making = if of == 1 { "a data set".to_owned() } else { format!("part {number}/{of}") };
    let _claimed = to.claim(&format!("part-{number}-{of}"), &format!("is making {making} in"))?;
    to.remove_leftovers();
    let PartContents { missing, mut generated, .. } = there.map_or_else(look, Ok)?;
    let run = Run { plan, sampler: &sampler, shards: &shards, to, control };
    run.generate(&missing, &mut generated)?;
    let files = to.files()?;
    generated.complete = (0..shards.count()).all(|shard| files.contains_key(&shards.name(shard)));
    if generated.complete {
        finish::finish(plan, &shards, to, &files)?;
    }
    Ok(generated)
}

/// The files of a part that are there when a run begins.
struct PartContents {
    /// The part's shards that are missing.
    missing: Vec<u64>,
    /// Whether all files other than shards are there as they were written.
    has_documents: bool,
    /// The result of a run that has nothing to do.
    generated: Generated,
}

impl PartContents {
    /// Reads all files of a part that are there.
    ///
    /// Shards that are as they were written are kept; all others are missing, and those that were damaged are listed with the reason.
    fn look(plan: &Plan, shards: &Shards, to: &Destination, part: Part) -> Result<Self, DatasetError> {
        let files = to.files()?;
        let manifest = manifest::read(to)?;
        let mut generated = Generated { complete: true, ..Generated::default() };
        // A data set that was finished by an earlier version has no other documents than those that its manifest lists.
        let mut wanted: Vec<&str> = [CARD].into_iter().chain(PREVIEW).collect();
        wanted.extend(plan.files.iter().map(|file| file.name));
        if let Some(manifest) = &manifest {
            wanted.extend(manifest.documents.iter().map(|document| document.name.as_str()));
            let changed = manifest.changed_documents(to, &files)?;
            let wrong = changed.into_iter().chain((!manifest.is_whole).then_some(MANIFEST));
            let remade = |file: &str| Remade { file: file.to_owned(), reason: WRONG_BYTES.to_owned() };
            generated.remade.extend(wrong.map(remade));
        }
        let mut has_documents =
            generated.remade.is_empty() && wanted.into_iter().all(|name| files.contains_key(name));
        let own = (0..shards.count()).into_par_iter().filter(|&shard| part.has(shard));
        let found = own.map(|shard| {
            let name = shards.name(shard);
            let read = files.contains_key(&name).then(|| {
                let read = to.checked_shard(&name, &[], Check::Bytes)?;
                let is_it = read.metadata.is_of(&shards.metadata(plan.hash(), shard));
                if is_it { Ok(read) } else { Err(OTHER_SHARD.to_owned()) }
            });
            (shard, read)
        });
        let mut missing = Vec::new();
        for (shard, found) in found.collect::<Vec<_>>() {
            match found {
                Some(Ok(read)) => {
                    generated.kept_shards += 1;
                    generated.earlier_failures.extend(read.metadata.failures);
                    // The manifest may be that of shards which another processor has made.
                    let listed = manifest.as_ref().and_then(|manifest| manifest.files.get(shard as usize));
                    has_documents &= listed.is_some_and(|listed| listed.shard.seal == read.seal);
                }
                Some(Err(reason)) => {
                    missing.push(shard);
                    generated.remade.push(Remade { file: shards.name(shard), reason });
                }
                None => missing.push(shard),
            }
        }
        Ok(Self { missing, has_documents, generated })
    }
}

/// A run that generates the missing shards of a part.
struct Run<'a> {
    plan: &'a Plan,
    sampler: &'a Sampler<'a>,
    shards: &'a Shards<'a>,
    to: &'a Destination,
    control: &'a GenerateControl<'a>,
}

/// Simulations that were asked for and have not returned yet.
#[derive(Default)]
struct PendingSimulations {
    /// What each simulation is for, and the failures that come before it, by the number of the simulation.
    roles: HashMap<usize, (Role, Vec<FailedRecord>)>,
    /// Number of the next simulation.
    next: usize,
    /// Records after the last simulation that cannot be simulated at all.
    failed: Vec<FailedRecord>,
}

impl PendingSimulations {
    /// Asks for the next simulation.
    fn add(&mut self, role: Role) {
        self.roles.insert(self.next, (role, std::mem::take(&mut self.failed)));
        self.next += 1;
    }
}

/// Why a record cannot be simulated, with the advice of its own error.
fn explained(error: &dyn Display, help: Option<&str>) -> String {
    help.map_or_else(|| error.to_string(), |help| format!("{error}; {help}"))
}

impl Run<'_> {
    fn generate(&self, missing: &[u64], generated: &mut Generated) -> Result<(), DatasetError> {
        if missing.is_empty() {
            return Ok(());
        }
        let records: u64 = missing.iter().map(|&shard| self.shards.len(shard)).sum();
        let stop = AtomicBool::new(false);
        let (sender, receiver) = sync_channel(WAITING);
        std::thread::scope(|scope| {
            let writer = scope.spawn(|| self.write(missing, records, receiver, &stop, generated));
            self.simulate(missing, sender, &stop);
            writer.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        })
    }

    /// Simulates all records of some shards and sends them to the writer in their order.
    fn simulate(&self, missing: &[u64], sender: SyncSender<Item>, stop: &AtomicBool) {
        let asked = Mutex::new(PendingSimulations::default());
        let records = missing.iter().flat_map(|&shard| self.shards.records(shard));
        let records = records.take_while(|_| !stop.load(Ordering::Relaxed));
        let scenarios = records.flat_map(|index| self.ask(index, &asked));
        let role = |number: usize| lock(&asked).roles.get(&number).map(|(role, _)| role.clone());
        let keep = KeepRecords { content: &self.plan.content, role };
        // If writing has failed, nobody receives any more.
        let send = |item: Item| {
            stop.store(sender.send(item).is_err() | stop.load(Ordering::Relaxed), Ordering::Relaxed)
        };
        let control = Control { cancelled: stop, ..Control::default() };
        let take = |number: usize, result: Result<Result<Box<Record>, String>, meshtone::Error>| {
            let Some((role, failed)) = lock(&asked).roles.remove(&number) else { return };
            failed.into_iter().for_each(|failed| send(Item::Failed(failed)));
            send(match result.map_err(|error| explained(&error, error.help())).flatten() {
                Ok(record) if role.is_twin => Item::HealthyTwin(record),
                Ok(record) => Item::Record(record),
                // The failure of a twin is reported with its record, which needs the twin.
                Err(_) if role.is_twin => return,
                Err(reason) => Item::Failed(FailedRecord { record: role.drawn.index, reason }),
            });
        };
        if self.plan.content.base.rig().is_some() {
            simulate_many(scenarios, &keep, &control, take);
        } else {
            let keep = KeepOf(|number, simulation| keep.of_train(number, simulation));
            simulate_many(scenarios, &keep, &control, take);
        }
        let rest = std::mem::take(&mut lock(&asked).failed);
        rest.into_iter().for_each(|failed| send(Item::Failed(failed)));
    }

    /// Draws a record and asks for its simulations: a faulty record that is enhanced has its healthy twin before it.
    fn ask(&self, index: u64, asked: &Mutex<PendingSimulations>) -> Vec<Scenario> {
        let drawn = self.sampler.record(index).map_err(|error| error.problem).and_then(|record| {
            let of_scenario = |error: ScenarioError| explained(&error, error.help.as_deref());
            let scenario = self.sampler.scenario(&record).map_err(of_scenario)?;
            let scenario = simulated_scenario(&self.plan.content.keep, &record, scenario);
            let (scenario, window) = scenario.map_err(|error| error.to_string())?;
            Ok((record, scenario, window))
        });
        // The lock is taken after drawing: other threads wait for it.
        let mut asked = lock(asked);
        let (record, scenario, window) = match drawn {
            Ok(drawn) => drawn,
            Err(reason) => {
                asked.failed.push(FailedRecord { record: index, reason });
                return Vec::new();
            }
        };
        let role = Role { drawn: record, window, is_twin: false };
        let mut scenarios = vec![scenario];
        if self.plan.content.tuned.is_some() && !scenarios[0].faults.is_empty() {
            asked.add(Role { is_twin: true, ..role.clone() });
            scenarios.insert(0, with_faults(&scenarios[0], &[]));
        }
        asked.add(role);
        scenarios
    }

    /// Writes shards as their records arrive.
    ///
    /// The simulations stop when a shard cannot be written, and when the user cancels: the shard is then left as it was. What was written is
    /// added to `generated`.
    fn write(
        &self,
        missing: &[u64],
        records: u64,
        items: Receiver<Item>,
        stop: &AtomicBool,
        generated: &mut Generated,
    ) -> Result<(), DatasetError> {
        let columns = shard::columns(self.plan);
        let mut done = 0;
        let mut next = || {
            if self.control.cancelled.load(Ordering::Relaxed) {
                stop.store(true, Ordering::Relaxed);
                return None;
            }
            let item = items.recv().ok()?;
            if !matches!(item, Item::HealthyTwin(_)) {
                done += 1;
                (self.control.progress)(done, records);
            }
            Some(item)
        };
        for &shard in missing {
            let metadata = self.shards.metadata(self.plan.hash(), shard);
            let written = self.to.write(&self.shards.name(shard), |file: &mut File| {
                let mut hashing = Hashing::new(&mut *file);
                let metadata = shard::write(&mut hashing, &self.plan.content, &columns, metadata, &mut next)?;
                let digest = hashing.digest();
                let read = shard::read(file.try_clone()?, Wanted::Columns(&[WARNINGS]))?;
                shard::seal(file, &digest.sha256)?;
                generated.failures.extend(metadata.failures);
                add_warnings(&mut generated.warnings, warnings(&read));
                Ok(())
            });
            written.map_err(|error| {
                stop.store(true, Ordering::Relaxed);
                match error {
                    DatasetError::File { source, .. } if source.kind() == io::ErrorKind::Interrupted => {
                        DatasetError::Stopped
                    }
                    error => error,
                }
            })?;
            generated.written_shards += 1;
            generated.written_records += self.shards.len(shard);
        }
        Ok(())
    }
}

fn lock(asked: &Mutex<PendingSimulations>) -> std::sync::MutexGuard<'_, PendingSimulations> {
    // A panic in another thread is passed on when its scope ends.
    asked.lock().unwrap_or_else(PoisonError::into_inner)
}
