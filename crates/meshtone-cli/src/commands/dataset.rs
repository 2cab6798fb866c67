//! `meshtone dataset`

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use clap::{Args, Subcommand};
use meshtone_dataset::draw::Sampler;
use meshtone_dataset::generate::{GenerateControl, Generated, Part, generate};
use meshtone_dataset::merge::merge;
use meshtone_dataset::plan::Plan;
use meshtone_dataset::store::Destination;
use meshtone_dataset::verify::{Check, Verified, verify};
use meshtone_dataset::{DatasetError, counted};
use meshtone_io::scenario_file::FileKind;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::other_kind::{MANIFEST, or_other_kind};
use crate::output_directory::named_after;
use crate::progress::with_bar;
use crate::shown::Shown;
use crate::terminal::{print, print_error_line, warn};

/// Failed records that are reported one by one.
const REPORTED: usize = 3;
/// Failed records whose numbers are listed.
const NAMED: usize = 20;

/// Make a labelled data set from a plan
///
/// Simulates the plan's records and writes them as Parquet files, with a manifest, a data card and a preview. After an
/// interruption the same command continues; the result has the same bytes as an uninterrupted run, with any number of jobs and
/// parts.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(arg_required_else_help = true, after_help = EXAMPLES)]
pub struct Dataset {
    #[command(subcommand)]
    action: Option<Action>,
    #[command(flatten)]
    make: Make,
}

#[derive(Debug, Subcommand)]
enum Action {
    Merge(Merge),
    Verify(Verify),
    Scenario(Scenario),
}

#[derive(Debug, Args)]
struct Make {
    /// The plan; `meshtone init dataset` prints one
    #[arg(value_name = "PLAN.toml", required = true)]
    plan: Option<PathBuf>,
    /// Directory or URL (file:, s3:, …) to write to. [default: <file name without .toml>_dataset in the current directory]
    #[arg(short, long, value_name = "DIR")]
    output: Option<String>,
    /// Threads that simulate. [default: one for each processor]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Only one part of the shards, such as 2/8; parts may be made at the same time, in one directory or apart
    #[arg(long, value_name = "I/N", value_parser = part)]
    part: Option<Part>,
    #[command(flatten)]
    shown: Shown,
}

/// Merge the parts of a data set that were made separately
#[derive(Debug, Args)]
struct Merge {
    /// Directories or URLs of the parts
    #[arg(value_name = "PART", required = true)]
    parts: Vec<String>,
    /// Directory or URL of the merged data set; may be one of the parts
    #[arg(short, long, value_name = "DIR")]
    output: String,
    /// Read also the shards that are already in place, instead of checking only their sizes
    #[arg(long)]
    verify: bool,
    #[command(flatten)]
    shown: Shown,
}

/// Compare every byte of a data set with what was written
///
/// Checks names, sizes, counts, SHA-256, rows and columns of all files. Nothing is written. The exit code is 1 if
/// something is missing or differs; the command that made the data set makes such shards again.
#[derive(Debug, Args)]
struct Verify {
    /// Directory or URL of the data set, or of a part of one
    #[arg(value_name = "DIR")]
    place: String,
    /// Check only names, sizes, counts and the footers of shards
    #[arg(long)]
    sizes_only: bool,
    #[command(flatten)]
    shown: Shown,
}

/// Print the scenario of one record, to simulate and look at it alone
#[derive(Debug, Args)]
struct Scenario {
    /// The plan
    #[arg(value_name = "PLAN.toml")]
    plan: PathBuf,
    /// Number of the record, as in the column record
    #[arg(value_name = "RECORD")]
    record: u64,
}

const EXAMPLES: &str = "\
Examples:
  meshtone init dataset -o plan.toml                     a commented plan to start from
  meshtone dataset plan.toml -o gears                    the data set, into the folder gears; run it again to go on
  meshtone dataset plan.toml -o gears_2 --part 2/8       one eighth of it
  meshtone dataset merge gears_1 gears_2 … -o gears      all eighths together
  meshtone dataset verify gears                          whether every byte is as it was written
  meshtone dataset scenario plan.toml 17 > record.toml   what record 17 is

In Python, meshtone.Dataset.to_bearing_datasets writes one in the schema of the package bearing-datasets";

/// Reads `I/N`.
fn part(text: &str) -> Result<Part, String> {
    let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
    match numbers {
        Some((number, of)) if number >= 1 && number <= of => Ok(Part { number, of }),
        _ => Err("must be I/N with I from 1 to N, such as 2/8".to_owned()),
    }
}

impl Dataset {
    pub fn run(&self) -> Result<(), Failure> {
        match (&self.action, &self.make.plan) {
            (Some(Action::Merge(arguments)), _) => arguments.run(),
            (Some(Action::Verify(arguments)), _) => arguments.run(),
            (Some(Action::Scenario(arguments)), _) => arguments.run(),
            (None, Some(plan)) => self.make.run(plan),
            (None, None) => Failure::refuse("name a plan", "see meshtone dataset --help"),
        }
    }
}

impl Make {
    fn run(&self, path: &Path) -> Result<(), Failure> {
        let plan = read_plan(path)?;
        warn_before_generating(&path.display().to_string(), &plan);
        let to = self.destination(path)?;
        let part = self.part.unwrap_or(Part::WHOLE);
        let threads = usize::from(self.jobs.unwrap_or(0));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| Failure::failed(format!("cannot start threads: {error}")))?;
        let generated = with_bar("records", !self.shown.quiet, |progress| {
            let control = GenerateControl { progress, cancelled: &AtomicBool::new(false) };
            pool.install(|| generate(&plan, &to, part, &control))
        })?;
        warn_after_generating(&generated);
        self.shown.print(&to, || summary(&plan, &generated, &to), || numbers(&generated))?;
        refuse_missing(&path.display().to_string(), &generated)
    }

    fn destination(&self, plan: &Path) -> Result<Destination, Failure> {
        match &self.output {
            Some(output) => Ok(Destination::parse(output)?),
            None => Ok(Destination::directory(named_after(plan, "dataset"))),
        }
    }
}

impl Merge {
    fn run(&self) -> Result<(), Failure> {
        let parts: Vec<Destination> =
            self.parts.iter().map(|part| Destination::parse(part)).collect::<Result<_, _>>()?;
        let to = Destination::parse(&self.output)?;
        let merged = merge(&parts, &to, if self.verify { Check::Bytes } else { Check::Sizes })?;
        let shards = counted(merged.kept_shards + merged.written_shards, "shard");
        self.shown.print(&to, || format!("  {shards}\n\n{to}\n"), || numbers(&merged))?;
        refuse_missing(&to.to_string(), &merged)
    }
}

impl Verify {
    fn run(&self) -> Result<(), Failure> {
        let place = Destination::parse(&self.place)?;
        let check = if self.sizes_only { Check::Sizes } else { Check::Bytes };
        let found = verify(&place, check).map_err(|error| self.refuse(error))?;
        // What it says of the others may be wrong.
        if let Some(problem) = found.problems.get(MANIFEST) {
            print_error_line(format!("{MANIFEST}: {problem}"));
        }
        let missing = found.missing.iter().map(|name| format!("{name}: it is missing"));
        missing.take(NAMED).for_each(print_error_line);
        let others = found.problems.iter().filter(|(name, _)| *name != MANIFEST);
        others.take(NAMED).for_each(|(name, problem)| print_error_line(format!("{name}: {problem}")));
        let wrong = (found.missing.len() + found.problems.len()) as u64;
        if wrong > 0 {
            let files = counted(wrong, "file");
            let are = if wrong == 1 { "is" } else { "are" };
            return Err(Failure::failed(format!("{place}: {files} {are} not as written")).with_help(
                "put the files back from a copy, or remove them and run the command that made the data set: it makes again what \
                 is missing or differs. Move elsewhere what no manifest names",
            ));
        }
        let Verified { complete, shards, rows, bytes, .. } = &found;
        let numbers =
            || json!({ "complete": complete, "shards": shards.len(), "records": rows, "bytes": bytes });
        self.shown.print(&place, || report(&found, &place, self.sizes_only), numbers)?;
        if found.complete {
            return Ok(());
        }
        let help = "run the command that made the data set again: it continues the set";
        Err(Failure::failed(format!("{place}: the data set is not complete")).with_help(help))
    }

    /// Of a path that is no data set, which command reads it.
    fn refuse(&self, error: DatasetError) -> Failure {
        let failure = error.into();
        let path = Path::new(&self.place);
        if path.join(MANIFEST).is_file() { failure } else { or_other_kind(path, "a data set", failure) }
    }
}

fn report(found: &Verified, place: &Destination, sizes_only: bool) -> String {
    let what = if sizes_only { "names, sizes, counts and footers are" } else { "every byte is" };
    format!(
        "  {} in {}, {:.1} MB: {what} as written\n\n{place}\n",
        counted(found.rows, "record"),
        counted(found.shards.len() as u64, "shard"),
        found.bytes as f64 / 1e6
    )
}

impl Scenario {
    fn run(&self) -> Result<(), Failure> {
        let plan = read_plan(&self.plan)?;
        let name = self.plan.display();
        let refuse =
            |problem: String| Failure::bad_input(format!("{name}: record {}: {problem}", self.record));
        if self.record >= plan.records() {
            return Err(refuse(format!("there are {} records, counted from 0", plan.records())));
        }
        let sampler = Sampler::new(&plan.content).map_err(|error| refuse(error.to_string()))?;
        let record = sampler.record(self.record).map_err(|error| refuse(error.problem))?;
        let scenario = sampler.scenario(&record).map_err(|error| refuse(error.to_string()))?;
        let label = &plan.content.classes[record.class].label;
        let split = plan.content.splits.names()[record.split];
        let mut head = format!(
            "# Record {} of {name}: \"{label}\", severity {}, unit {}, {split}. Made by {}.\n",
            self.record,
            record.severity,
            record.unit,
            meshtone::made_by()
        );
        if !scenario.faults.is_empty() {
            head += "# Teeth count from where the first two meet; in the data set, fault_tooth counts from the record's start.\n";
        }
        print(&(head + &scenario.to_toml()))
    }
}

fn read_plan(path: &Path) -> Result<Plan, Failure> {
    Plan::read(path).map_err(|error| Failure::of_file(FileKind::Plan, error))
}

/// Prints warnings about the plan, and what it shows to be missing in the end, before anything is computed.
fn warn_before_generating(name: &str, plan: &Plan) {
    for warning in plan.warnings() {
        warn(format_args!("{name}: {warning}"));
    }
    let foreseen = plan.foreseen_failures();
    if let Some(first) = foreseen.first() {
        let count = counted(foreseen.len() as u64, "record");
        warn(format_args!(
            "{name}: {count} that cannot be simulated will be missing; record {}: {}",
            first.record, first.reason
        ));
    }
}

/// Says what was made again, what failed and what records have.
pub(super) fn warn_after_generating(generated: &Generated) {
    let remade = generated.remade.iter().map(|file| format!("{} was made again: {}", file.file, file.reason));
    warn_of_first(remade, "more file", "made again for such reasons");
    let failures = &generated.failures;
    let failed = failures.iter().map(|failed| format!("record {} failed: {}", failed.record, failed.reason));
    warn_of_first(failed, "more record", "failed; manifest.json lists them");
    for (kind, count) in &generated.warnings {
        let have = if *count == 1 { "has" } else { "have" };
        warn(format_args!(
            "{} {have} the warning {}: {}; the column `warnings` says which",
            counted(*count, "record"),
            kind.code(),
            kind.meaning()
        ));
    }
}

/// Prints the first warnings, and how many more there are.
fn warn_of_first(warnings: impl ExactSizeIterator<Item = String>, more: &str, what: &str) {
    let rest = warnings.len().saturating_sub(REPORTED);
    warnings.take(REPORTED).for_each(warn);
    if rest > 0 {
        warn(format_args!("{} {what}", counted(rest as u64, more)));
    }
}

/// A data set that lacks records of its plan is there, and not what was asked for.
///
/// # Arguments
/// * `of` - the plan's file, or the place of the data set
fn refuse_missing(of: &str, generated: &Generated) -> Result<(), Failure> {
    let missing = generated.missing();
    if missing.is_empty() {
        return Ok(());
    }
    let mut numbers: Vec<String> =
        missing.iter().take(NAMED).map(|failed| failed.record.to_string()).collect();
    if missing.len() > NAMED {
        numbers.push("…".to_owned());
    }
    let (records, are) = match missing.len() {
        1 => ("record", "is"),
        _ => ("records", "are"),
    };
    let problem = format!(
        "{of}: {} that could not be simulated {are} missing: {records} {}; all others were written",
        counted(missing.len() as u64, "record"),
        numbers.join(", ")
    );
    let help = "manifest.json lists them with their reasons; narrow what the plan varies, or add a constraint, and none is missing";
    Failure::refuse(problem, help)
}

/// Returns what was made, for programs.
fn numbers(generated: &Generated) -> Value {
    json!({
        "complete": generated.complete,
        "written_shards": generated.written_shards,
        "kept_shards": generated.kept_shards,
        "written_records": generated.simulated_records(),
        "failed_records": generated.missing().iter().map(|failed| failed.record).collect::<Vec<_>>(),
    })
}

fn summary(plan: &Plan, generated: &Generated, to: &Destination) -> String {
    let written = format!(
        "  {} in {} written, {} {} there already\n",
        counted(generated.simulated_records(), "record"),
        counted(generated.written_shards, "shard"),
        counted(generated.kept_shards, "shard"),
        if generated.kept_shards == 1 { "was" } else { "were" }
    );
    if !generated.complete {
        let rest = "not complete: other parts are missing; `meshtone dataset merge` puts parts together";
        return format!("{written}  {rest}\n\n{to}\n");
    }
    let missing = generated.missing().len() as u64;
    let of_plan = if missing == 0 { String::new() } else { format!(" of the plan's {}", plan.records()) };
    let records = counted(plan.records() - missing, "record");
    let units = counted(plan.content.units, "unit");
    format!("{written}  complete: {records}{of_plan} of {units}, see README.md there\n\n{to}\n")
}
