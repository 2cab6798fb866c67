//! Generating a data set, from the start or from where it was stopped.

use std::collections::{BTreeMap, HashMap, VecDeque};
use std::fs::File;
use std::io::{self, Seek, SeekFrom};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};

use meshtone::batch::{Control, simulate_many};
use meshtone::scenario::Scenario;
use rayon::prelude::*;

use crate::contents::{Contents, Looked, WRONG_BYTES};
use crate::digest::{Digest, Hashing};
use crate::draw::{DrawnRecord, Sampler};
use crate::error::DatasetError;
use crate::finish;
use crate::manifest::{self, Begun, CARD, MANIFEST, PREVIEW, ReadManifest};
use crate::part_list::Listing;
use crate::plan::{Plan, PlanFile};
use crate::record::{KeepRecords, Role};
use crate::shard::{self, Column, FailedRecord, Item, ShardMetadata, Shards};
use crate::store::Destination;

/// Records that may wait to be written.
const WAITING: usize = 32;

/// A part of a data set: some of its shards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Which, from 1.
    pub number: u64,
    /// Of how many.
    pub of: u64,
}

impl Part {
    /// Everything.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Whether a shard belongs to it: every so many.
    ///
    /// # Arguments
    /// * `shard` - its number
    pub fn has(&self, shard: u64) -> bool {
        shard % self.of == self.number - 1
    }
}

/// What a caller wants to know, and to say, while a data set is generated.
pub struct GenerateControl<'a> {
    /// Called with the number of records that are done, and of all that this run is to do.
    pub progress: &'a (dyn Fn(u64, u64) + Sync),
    /// Set by the caller to stop: shards that are complete stay.
    pub cancelled: &'a AtomicBool,
}

/// What a run has done.
#[derive(Debug, Clone, PartialEq)]
pub struct Generated {
    /// Shards that were there already.
    pub kept_shards: u64,
    /// Shards that were written.
    pub written_shards: u64,
    /// Records of the written shards.
    pub written_records: u64,
    /// Of those, the ones that failed.
    pub failures: Vec<FailedRecord>,
    /// Records that failed before, of the shards that were there already.
    pub earlier_failures: Vec<FailedRecord>,
    /// Files that were there, but not as they were written, and have been made again.
    pub remade: Vec<Remade>,
    /// Whether the data set is complete, with manifest, data card and preview.
    pub complete: bool,
}

/// A file that was not as it was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remade {
    /// Its file, from the data set's directory.
    pub file: String,
    /// What was wrong with it.
    pub reason: String,
}

impl Generated {
    /// All records that failed, of the written shards and of those that were there, in their order.
    pub fn missing(&self) -> Vec<&FailedRecord> {
        let mut missing: Vec<_> = self.earlier_failures.iter().chain(&self.failures).collect();
        missing.sort_by_key(|failed| failed.record);
        missing
    }
}

/// Generates a data set, or goes on with it, in the threads of the current rayon pool.
///
/// # Arguments
/// * `plan` - what it consists of
/// * `to` - where it is written to
/// * `part` - which shards
/// * `control` - progress and cancellation
///
/// Every file that is there and has the SHA-256 that was taken while it was written is kept; others are made again. Where all shards
/// are there, the manifest is completed, and data card and preview are written.
///
/// # Errors
/// A place with other files, or with a data set of another plan; another program that makes the same part there; what cannot be
/// written, as to a full disk: what is complete stays, and the next run goes on from there; a plan of which no record can be
/// simulated.
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
    let sampler = Sampler::new(&plan.content).map_err(|error| manifest::plan_error(plan, error))?;
    let shards = Shards::new(plan, &sampler);
    let complete = manifest::look(plan, shards, to)? == Begun::Complete;
    // What is called complete is looked at all the same: somebody may have lost or damaged a file since.
    let there = if complete { Some(There::look(plan, shards, to, part)?) } else { None };
    if let Some(there) = &there
        && there.missing.is_empty()
        && there.has_documents
    {
        return Ok(there.generated());
    }
    if !complete {
        manifest::begin(plan, to)?;
    }
    let (number, of) = (part.number, part.of);
    let _claimed = to.claim(
        &format!("part-{number}-{of}"),
        &if part == Part::WHOLE {
            "is making a data set in".to_owned()
        } else {
            format!("is making part {number}/{of} in")
        },
    )?;
    to.remove_leftovers();
    let there = there.map_or_else(|| There::look(plan, shards, to, part), Ok)?;
    let mut generated = there.generated();
    let run = Run { plan, sampler: &sampler, shards, to, part, control };
    run.generate(&there.missing, &mut generated)?;
    generated.complete = finish::finish_if_complete(plan, shards, to)?;
    Ok(generated)
}

/// What is there of a part.
struct There {
    kept: u64,
    missing: Vec<u64>,
    remade: Vec<Remade>,
    failures: Vec<FailedRecord>,
    /// Whether all files beside the shards and the manifest are there, as they were written.
    has_documents: bool,
}

impl There {
    /// Reads all shards of a part that are there, and what is written beside them, and compares them with what is known of them.
    fn look(plan: &Plan, shards: Shards, to: &Destination, part: Part) -> Result<Self, DatasetError> {
        let files = to.files()?;
        let manifest = manifest::read(to)?;
        let documents = manifest.as_ref().map(|manifest| manifest.documents.clone()).unwrap_or_default();
        let mut contents = Contents::default();
        let columns = manifest.as_ref().map_or(Ok(()), |manifest| manifest.check_columns(to));
        let is_whole = manifest.as_ref().is_none_or(|manifest| manifest.is_whole);
        contents.add_place(plan, to, &files, manifest.filter(ReadManifest::can_be_relied_on))?;
        let own = (0..shards.count()).into_par_iter().filter(|&shard| part.has(shard));
        let looked = own.map(|shard| {
            let name = shards.name(shard);
            let objection = files.get(&name).map(|&size| {
                contents.objection(shard, size, || {
                    to.digest(&name).map_err(|error| io::Error::other(error.to_string()))
                })
            });
            (shard, objection)
        });
        let (mut changed, has_all) = look_at_documents(plan, to, &files, &documents)?;
        if !is_whole {
            changed.push(Remade { file: MANIFEST.to_owned(), reason: WRONG_BYTES.to_owned() });
        }
        let has_documents = has_all && is_whole;
        let mut there =
            Self { kept: 0, missing: Vec::new(), remade: changed, failures: Vec::new(), has_documents };
        for (shard, objection) in looked.collect::<Vec<_>>() {
            if let Some(None) = objection {
                there.kept += 1;
                let failures = contents.failures.range(shards.range(shard));
                there.failures.extend(
                    failures.map(|(&record, reason)| FailedRecord { record, reason: reason.clone() }),
                );
                continue;
            }
            there.missing.push(shard);
            let remade = objection.flatten().map(|reason| Remade { file: shards.name(shard), reason });
            there.remade.extend(remade);
        }
        // To what is whole nothing is added.
        if there.missing.is_empty() && has_documents { Ok(there) } else { columns.map(|()| there) }
    }

    /// What a run has done that has nothing to do.
    fn generated(&self) -> Generated {
        Generated {
            kept_shards: self.kept,
            written_shards: 0,
            written_records: 0,
            failures: Vec::new(),
            earlier_failures: self.failures.clone(),
            remade: self.remade.clone(),
            complete: true,
        }
    }
}

/// The files beside the shards and the manifest that are there and not as they were written; and whether all are there as they were.
fn look_at_documents(
    plan: &Plan,
    to: &Destination,
    files: &BTreeMap<String, u64>,
    documents: &BTreeMap<String, Digest>,
) -> Result<(Vec<Remade>, bool), DatasetError> {
    let mut changed = Vec::new();
    for (name, digest) in documents.iter().filter(|(name, _)| files.contains_key(*name)) {
        if to.digest(name)? != *digest {
            changed.push(Remade { file: name.clone(), reason: WRONG_BYTES.to_owned() });
        }
    }
    let copies = plan.files.iter().map(|file: &PlanFile| file.name);
    // Of a data set that was finished before there was other metadata, its own list says what it has.
    let listed = documents.keys().map(String::as_str);
    let are_there =
        [CARD].into_iter().chain(PREVIEW).chain(copies).chain(listed).all(|name| files.contains_key(name));
    let has_all = are_there && changed.is_empty();
    Ok((changed, has_all))
}

/// One run.
struct Run<'a> {
    plan: &'a Plan,
    sampler: &'a Sampler<'a>,
    shards: Shards,
    to: &'a Destination,
    part: Part,
    control: &'a GenerateControl<'a>,
}

/// Simulations that were asked for and not yet handed out.
#[derive(Default)]
struct Asked {
    /// By the number of the simulation: what it is for, and the failures that come before it.
    roles: HashMap<usize, (Role, Vec<FailedRecord>)>,
    /// Number of the next simulation.
    next: usize,
    /// Failures of records that are not simulated at all, after the last simulation.
    failed: Vec<FailedRecord>,
}

impl Run<'_> {
    fn generate(&self, missing: &[u64], generated: &mut Generated) -> Result<(), DatasetError> {
        if missing.is_empty() {
            return Ok(());
        }
        let records: u64 = missing.iter().map(|&shard| self.shards.range(shard).count() as u64).sum();
        let stop = AtomicBool::new(false);
        let (sender, receiver) = sync_channel(WAITING);
        let written = std::thread::scope(|scope| {
            let writer = scope.spawn(|| self.write(missing, records, receiver, &stop));
            self.simulate(missing, sender, &stop);
            writer.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        });
        generated.failures = written?;
        generated.written_shards = missing.len() as u64;
        generated.written_records = records;
        Ok(())
    }

    /// Simulates all records of some shards and sends them on, in their order.
    fn simulate(&self, missing: &[u64], sender: SyncSender<Item>, stop: &AtomicBool) {
        let asked = Arc::new(Mutex::new(Asked::default()));
        let source = Source {
            run: self,
            shards: missing.iter(),
            records: 0..0,
            ready: VecDeque::new(),
            asked: asked.clone(),
            stop,
        };
        let role = |number: usize| lock(&asked).roles.get(&number).map(|(role, _)| role.clone());
        let keep = KeepRecords { content: &self.plan.content, role };
        // Nobody listens any more where writing has failed.
        let send = |item: Item| {
            stop.store(sender.send(item).is_err() | stop.load(Ordering::Relaxed), Ordering::Relaxed)
        };
        let control = Control { cancelled: stop, ..Control::default() };
        simulate_many(source, &keep, &control, |number, result| {
            let Some((role, failed)) = lock(&asked).roles.remove(&number) else { return };
            failed.into_iter().for_each(|failed| send(Item::Failed(failed)));
            let reason = match result {
                Ok(Ok(record)) => {
                    return send(match role {
                        Role::Record(_) => Item::Record(record),
                        Role::HealthyTwin(..) => Item::HealthyTwin(record),
                    });
                }
                Ok(Err(reason)) => reason,
                Err(error) => error.to_string(),
            };
            // A twin's failure is told of its record, which misses it.
            if let Role::Record(drawn) = role {
                send(Item::Failed(FailedRecord { record: drawn.index, reason }));
            }
        });
        let rest = std::mem::take(&mut lock(&asked).failed);
        rest.into_iter().for_each(|failed| send(Item::Failed(failed)));
    }

    /// Writes shards as their records arrive. Returns the records that failed.
    fn write(
        &self,
        missing: &[u64],
        records: u64,
        items: Receiver<Item>,
        stop: &AtomicBool,
    ) -> Result<Vec<FailedRecord>, DatasetError> {
        // The receiver ends with this function, so that nobody waits to send.
        let items = items;
        let columns = shard::columns(self.plan);
        let looked = Looked::new(&columns, self.shards);
        let mut listing = Listing::new(self.to, self.plan.hash().to_string(), self.part);
        let done = AtomicU64::new(0);
        let mut failures = Vec::new();
        for &shard in missing {
            let next = || self.next(&items, (&done, records), stop);
            match self.write_shard(shard, &columns, &looked, &mut listing, next) {
                Ok(of_shard) => failures.extend(of_shard),
                Err(error) => {
                    stop.store(true, Ordering::Relaxed);
                    return Err(error);
                }
            }
        }
        Ok(failures)
    }

    /// The next item; none where generating has stopped.
    fn next(
        &self,
        items: &Receiver<Item>,
        (done, records): (&AtomicU64, u64),
        stop: &AtomicBool,
    ) -> Option<Item> {
        if self.control.cancelled.load(Ordering::Relaxed) {
            stop.store(true, Ordering::Relaxed);
            return None;
        }
        let item = items.recv().ok()?;
        if !matches!(item, Item::HealthyTwin(_)) {
            (self.control.progress)(done.fetch_add(1, Ordering::Relaxed) + 1, records);
        }
        Some(item)
    }

    /// Writes and lists a shard. Returns its records that failed.
    fn write_shard(
        &self,
        shard: u64,
        columns: &[Column],
        looked: &Looked<'_>,
        listing: &mut Listing<'_>,
        next: impl FnMut() -> Option<Item>,
    ) -> Result<Vec<FailedRecord>, DatasetError> {
        let metadata = ShardMetadata {
            plan: self.plan.hash().to_string(),
            records: self.shards.range(shard),
            failures: Vec::new(),
        };
        let content = &self.plan.content;
        let written = self.to.write(&self.shards.name(shard), |file: &mut File| {
            let mut hashing = Hashing::new(&mut *file);
            shard::write(&mut hashing, content, columns, metadata, next)?;
            let digest = hashing.digest();
            let (of_shard, seen) =
                looked.shard(shard, shard::read(file.try_clone()?, looked.wanted())?, digest);
            // Reading has moved the place where the file would be written on.
            file.seek(SeekFrom::End(0))?;
            let failures = of_shard.failures.clone();
            // Before the shard has its name, so that none is there that is not listed.
            Ok(listing.add(shard, of_shard, seen).map(|()| failures))
        });
        written.map_err(|error| match error {
            DatasetError::File { source, .. } if source.kind() == io::ErrorKind::Interrupted => {
                DatasetError::Stopped
            }
            error => error,
        })?
    }
}

fn lock(asked: &Mutex<Asked>) -> std::sync::MutexGuard<'_, Asked> {
    // A panic in another thread is passed on when its scope ends.
    asked.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Scenarios of records, one after the other; a faulty record that is enhanced has its healthy twin before it.
struct Source<'a> {
    run: &'a Run<'a>,
    /// Those still to be begun.
    shards: std::slice::Iter<'a, u64>,
    /// Of the shard that was begun last, those still to be drawn.
    records: Range<u64>,
    ready: VecDeque<Scenario>,
    asked: Arc<Mutex<Asked>>,
    stop: &'a AtomicBool,
}

impl Iterator for Source<'_> {
    type Item = Scenario;

    fn next(&mut self) -> Option<Scenario> {
        while self.ready.is_empty() && !self.stop.load(Ordering::Relaxed) {
            let Some(index) = self.records.next() else {
                self.records = self.run.shards.range(*self.shards.next()?);
                continue;
            };
            match self.draw(index) {
                Ok((record, scenario)) => self.ask(record, scenario),
                Err(reason) => lock(&self.asked).failed.push(FailedRecord { record: index, reason }),
            }
        }
        self.ready.pop_front()
    }
}

impl Source<'_> {
    fn draw(&self, index: u64) -> Result<(DrawnRecord, Scenario), String> {
        let sampler = self.run.sampler;
        let record = sampler.record(index).map_err(|error| error.problem)?;
        let scenario = sampler.scenario(&record).map_err(|error| error.to_string())?;
        Ok((record, scenario))
    }

    fn ask(&mut self, record: DrawnRecord, scenario: Scenario) {
        let twin = self.run.plan.content.tuned.is_some() && !scenario.faults.is_empty();
        let mut asked = lock(&self.asked);
        let mut add = |role: Role, scenario: Scenario| {
            let failed = std::mem::take(&mut asked.failed);
            let number = asked.next;
            asked.next += 1;
            asked.roles.insert(number, (role, failed));
            self.ready.push_back(scenario);
        };
        if twin {
            let twin = Role::HealthyTwin(record.clone(), scenario.faults.clone());
            add(twin, scenario.clone().with_faults(Vec::new()));
        }
        add(Role::Record(record), scenario);
    }
}
