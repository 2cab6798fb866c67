//! Fuzzing that is guided by coverage: the targets of `fuzz/`, built with libFuzzer by the compiler that is there.

use std::collections::VecDeque;
use std::ffi::OsString;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use crate::files;
use crate::step::StepRunner;

/// How `cargo fuzz` has coverage and comparisons noted, without a sanitizer, so that any compiler will do.
const FLAGS: &str = "-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
    -Cllvm-args=-sanitizer-coverage-trace-compares --cfg fuzzing";
/// What an input may take: ten times the 2 s that a file may take the program, which instruments and checks slow down so much, and memory; and
/// its size.
const LIMITS: [&str; 4] = ["-timeout=20", "-rss_limit_mb=1500", "-max_len=2000000", "-print_final_stats=1"];
/// Where the inputs stand as files while they are read, if there is such a folder: in memory.
const IN_MEMORY: &str = "/dev/shm";

/// What was done with one target.
struct Tally {
    target: String,
    inputs: u64,
    seconds: f64,
    /// Places in the code that its inputs reach.
    coverage: String,
    failed: bool,
}

/// Builds the targets, and runs each for its part of the time, as many at once as there are processors.
///
/// # Arguments
/// * `row` - where steps run
/// * `arguments` - `--minutes 5` of all together, `--target NAME` for one alone
///
/// # Errors
/// 1 where an input was found that a target fails on; an exit code of the compiler's; wrong arguments.
pub fn run(row: &StepRunner, arguments: &[&str]) -> Result<(), u8> {
    let (mut minutes, mut chosen) = (5.0, None);
    for pair in arguments.chunks(2) {
        match *pair {
            ["--minutes", number] => {
                minutes = number.parse().map_err(|_| row.fail("--minutes: no number"))?
            }
            ["--target", name] => chosen = Some(name),
            _ => return Err(row.fail("fuzz takes --minutes NUMBER and --target NAME")),
        }
    }
    let names = files::names_in(&row.root().join("fuzz/fuzz_targets"))
        .map_err(|error| row.fail(&error.to_string()))?;
    let names = names.iter().filter_map(|name| name.strip_suffix(".rs"));
    let targets: VecDeque<&str> = names.filter(|name| chosen.is_none_or(|chosen| chosen == *name)).collect();
    if targets.is_empty() {
        return Err(row.fail("there is no such target: fuzz/fuzz_targets has all"));
    }
    let bins = chosen.map_or(vec!["--bins"], |name| vec!["--bin", name]);
    let build =
        ["build", "--release", "--locked", "--manifest-path", "fuzz/Cargo.toml", "--target", "host-tuple"];
    row.cargo(&[&build[..], &bins].concat(), &[("RUSTFLAGS", OsString::from(FLAGS))])?;
    let at_once = std::thread::available_parallelism().map_or(1, |count| count.get()).min(targets.len());
    let seconds = 60.0 * minutes * at_once as f64 / targets.len() as f64;
    let (targets, tallies) = (Mutex::new(targets), Mutex::new(Vec::new()));
    let root = row.root();
    std::thread::scope(|scope| {
        for _ in 0..at_once {
            scope.spawn(|| {
                while let Some(target) = next(&targets) {
                    let tally = fuzzed(root, target, seconds.max(1.0) as u64);
                    tallies.lock().unwrap_or_else(PoisonError::into_inner).push(tally);
                }
            });
        }
    });
    report(tallies.into_inner().unwrap_or_else(PoisonError::into_inner))
}

fn next<'t>(targets: &Mutex<VecDeque<&'t str>>) -> Option<&'t str> {
    targets.lock().unwrap_or_else(PoisonError::into_inner).pop_front()
}

/// Runs one target. What it says is in `target/fuzz/log`, what it fails on in `target/fuzz/findings`, and new inputs in `target/fuzz/corpus`.
fn fuzzed(root: &Path, target: &str, seconds: u64) -> Tally {
    let start = Instant::now();
    let log = root.join("target/fuzz/log").join(target);
    let run = || {
        let corpus = root.join("target/fuzz/corpus").join(target);
        let in_memory = Some(Path::new(IN_MEMORY)).filter(|folder| folder.is_dir());
        let temporary = in_memory.map_or_else(std::env::temp_dir, Path::to_owned);
        let temporary = temporary.join(format!("meshtone-fuzz-{target}-{}", std::process::id()));
        for folder in [&corpus, &root.join("target/fuzz/findings"), &root.join("target/fuzz/log"), &temporary]
        {
            fs::create_dir_all(folder)?;
        }
        let mut fuzzer = Command::new(program(root, target)?);
        fuzzer.args([&corpus, &root.join("fuzz/seeds").join(target)]).args(LIMITS);
        fuzzer.arg(format!("-max_total_time={seconds}"));
        fuzzer.arg(format!("-artifact_prefix=target/fuzz/findings/{target}-"));
        let said = File::create(&log)?;
        fuzzer.stdout(said.try_clone()?).stderr(said).env("TMPDIR", &temporary).current_dir(root);
        let status = fuzzer.status();
        fs::remove_dir_all(&temporary)?;
        status
    };
    let outcome = run().map(|status| status.success()).map_err(|error| eprintln!("error: {target}: {error}"));
    let said = files::read(&log).unwrap_or_default();
    let last = |mark: &str| {
        said.rsplit_once(mark).and_then(|(_, rest)| rest.split_whitespace().next()).unwrap_or("0")
    };
    let failed = outcome != Ok(true);
    if failed {
        let problem = said.lines().rev().find(|line| line.contains("panicked") || line.contains("ERROR"));
        println!("{target} FAILS: {}\n    all that it says: {}", problem.unwrap_or_default(), log.display());
    }
    Tally {
        target: target.to_owned(),
        inputs: last("stat::number_of_executed_units:").parse().unwrap_or(0),
        seconds: start.elapsed().as_secs_f64(),
        coverage: last(" cov: ").to_owned(),
        failed,
    }
}

/// The program of a target, in the folder that is named after this machine's kind.
fn program(root: &Path, target: &str) -> std::io::Result<PathBuf> {
    let built = root.join("fuzz/target");
    let kinds =
        files::names_in(&built)?.into_iter().map(|kind| built.join(kind).join("release").join(target));
    { kinds }.find(|path| path.is_file()).ok_or_else(|| std::io::ErrorKind::NotFound.into())
}

fn report(mut tallies: Vec<Tally>) -> Result<(), u8> {
    tallies.sort_by(|a, b| a.target.cmp(&b.target));
    println!("\n| target | inputs | seconds | coverage | findings |\n|---|---:|---:|---:|---:|");
    for Tally { target, inputs, seconds, coverage, failed } in &tallies {
        println!("| {target} | {inputs} | {seconds:.0} | {coverage} | {} |", u8::from(*failed));
    }
    let failed = tallies.iter().filter(|tally| tally.failed).count();
    println!("| all | {} | | | {failed} |", tallies.iter().map(|tally| tally.inputs).sum::<u64>());
    if failed == 0 { Ok(()) } else { Err(1) }
}
