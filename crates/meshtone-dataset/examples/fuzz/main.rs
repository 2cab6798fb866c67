//! Wrong input for every reader, drawn from right input: whatever comes, a reader gives a result or an error, in little time and
//! memory.
//!
//! ```sh
//! cargo xtask fuzz --minutes 10                 # all readers in turn, with a seed of its own, which is printed
//! cargo xtask fuzz --minutes 10 --seed 7        # the same inputs as before, as many as the time allows
//! cargo xtask fuzz --seed 7 --reader plan --number 1234   # that input alone
//! ```
//!
//! Every input depends on the seed, the reader and its number alone. One that a reader panics on, or takes too much time or memory
//! for, is kept with how to repeat it; the program then ends with exit code 1. Should a reader end the whole program, its input
//! still stands in the folder of the inputs.
#![allow(clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::print_stderr, missing_docs)]

mod arguments;
mod mutate;
mod readers;

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock};
use std::time::{Duration, Instant};

use arguments::Arguments;
use meshtone::scenario::MemoryLimit;
use mutate::{Draws, mutated};
use peak_alloc::PeakAlloc;
use readers::{Reader, readers};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// (bytes) What a reader is allowed.
const LIMIT_BYTES: u64 = 256 << 20;
/// (bytes) What it may take: buffers stand beside what the limit is about.
const MOST_BYTES: usize = 300 << 20;
/// (s) Longest processor time for one input, which is small: other programs' load hardly changes it.
const LONGEST_S: f64 = 2.0;
/// After so long a reader is taken to be in an endless loop.
const ENDLESS: Duration = Duration::from_secs(60);
/// Findings of one reader, after which it is left alone.
const MOST_FINDINGS: usize = 10;

/// What has been done with one reader.
#[derive(Default)]
struct Tally {
    inputs: u64,
    /// Inputs that were read in spite of what was changed.
    accepted: u64,
    /// (s) Of processor time.
    slowest_s: f64,
    /// (bytes)
    largest: usize,
    findings: usize,
}

fn main() -> ExitCode {
    let arguments = match Arguments::parse(std::env::args().skip(1)) {
        Ok(arguments) => arguments,
        Err(problem) => {
            eprintln!("error: {problem}\n\n{}", arguments::USAGE);
            return ExitCode::from(2);
        }
    };
    MemoryLimit::set(Some(LIMIT_BYTES));
    let folder = PathBuf::from("target").join("fuzz");
    let work = folder.join("input");
    let _ = fs::remove_dir_all(&work);
    fs::create_dir_all(&work).expect("a folder for the inputs");
    let readers = readers(&work);
    let chosen: Vec<&Reader> = readers
        .iter()
        .filter(|reader| arguments.reader.as_deref().is_none_or(|name| name == reader.name))
        .collect();
    if chosen.is_empty() {
        let names: Vec<&str> = readers.iter().map(|reader| reader.name).collect();
        eprintln!("error: there is no such reader; there are {}", names.join(", "));
        return ExitCode::from(2);
    }
    println!("seed {}", arguments.seed);
    let last_panic = remember_panics();
    let watched = watch();
    let mut tallies: Vec<Tally> = chosen.iter().map(|_| Tally::default()).collect();
    let start = Instant::now();
    let trial = Trial { seed: arguments.seed, folder: &folder, work: &work, last_panic: &last_panic };
    for number in arguments.numbers() {
        if arguments.number.is_none() && start.elapsed() > arguments.duration {
            break;
        }
        for (reader, tally) in chosen.iter().zip(&mut tallies) {
            if tally.findings < MOST_FINDINGS {
                watched.store(start.elapsed().as_millis() as u64 + 1, Ordering::Relaxed);
                trial.run(reader, number, tally);
                watched.store(0, Ordering::Relaxed);
            }
        }
    }
    print_table(&chosen, &tallies);
    if tallies.iter().any(|tally| tally.findings > 0) { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// Where inputs are tried.
struct Trial<'a> {
    seed: u64,
    folder: &'a Path,
    work: &'a Path,
    last_panic: &'a Mutex<String>,
}

impl Trial<'_> {
    fn run(&self, reader: &Reader, number: u64, tally: &mut Tally) {
        let mut draws = Draws::new(self.seed, reader.name, number);
        let (place, seed) = &reader.seeds[draws.below(reader.seeds.len())];
        let other = &reader.seeds[draws.below(reader.seeds.len())].1;
        let input = mutated(seed, other, &mut draws);
        let path = self.work.join(place);
        fs::write(&path, &input).expect("the input can be written");
        MEMORY.reset_peak_usage();
        let (before, start_s) = (MEMORY.current_usage(), processor_s());
        let outcome = catch_unwind(AssertUnwindSafe(|| (reader.read)(&path)));
        let (taken_s, peak) = (processor_s() - start_s, MEMORY.peak_usage().saturating_sub(before));
        // The next input of another file begins with this one as it was.
        fs::write(&path, seed).expect("the input can be written");
        tally.inputs += 1;
        tally.accepted += u64::from(matches!(outcome, Ok(true)));
        tally.slowest_s = tally.slowest_s.max(taken_s);
        tally.largest = tally.largest.max(peak);
        let problem = match outcome {
            Err(_) => format!("panics: {}", self.last_panic.lock().expect("no panic holds it")),
            Ok(_) if taken_s > LONGEST_S => format!("takes {taken_s:.1} s"),
            Ok(_) if peak > MOST_BYTES => format!("takes {:.0} MiB", peak as f64 / f64::from(1 << 20)),
            Ok(_) => return,
        };
        tally.findings += 1;
        self.keep(reader, number, &path, &input, &problem);
    }

    fn keep(&self, reader: &Reader, number: u64, path: &Path, input: &[u8], problem: &str) {
        let found = self.folder.join("findings");
        fs::create_dir_all(&found).expect("a folder for the findings");
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let kept = found.join(format!("{}-{}-{number}-{name}", reader.name, self.seed));
        fs::write(&kept, input).expect("the finding can be written");
        let again =
            format!("cargo xtask fuzz --seed {} --reader {} --number {number}", self.seed, reader.name);
        let report = format!("{}: {problem}\n  input: {}\n  again: {again}\n", reader.name, kept.display());
        fs::write(kept.with_extension("txt"), &report).expect("the finding can be written");
        eprint!("{report}");
    }
}

/// Panics print nothing, but are remembered.
fn remember_panics() -> Arc<Mutex<String>> {
    let last = Arc::new(Mutex::new(String::new()));
    let noted = Arc::clone(&last);
    std::panic::set_hook(Box::new(move |panic| {
        if let Ok(mut last) = noted.lock() {
            *last = panic.to_string();
        }
    }));
    last
}

/// Ends the program where one input takes forever. What is returned is the time at which it began, in milliseconds; 0 for none.
fn watch() -> Arc<AtomicU64> {
    let began = Arc::new(AtomicU64::new(0));
    let watched = Arc::clone(&began);
    std::thread::spawn(move || {
        let (mut since, mut at) = (0, Instant::now());
        loop {
            std::thread::sleep(Duration::from_secs(1));
            let now = watched.load(Ordering::Relaxed);
            if now != since {
                (since, at) = (now, Instant::now());
            } else if now != 0 && at.elapsed() > ENDLESS {
                eprintln!("an input takes more than {} s: it stands in target/fuzz/input", ENDLESS.as_secs());
                std::process::exit(1);
            }
        }
    });
    began
}

/// (s) Processor time that this process has used, or where the system does not say (other than Linux) the time that has passed.
fn processor_s() -> f64 {
    static START: OnceLock<Instant> = OnceLock::new();
    let ticks = || {
        let stat = fs::read_to_string("/proc/self/stat").ok()?;
        // Behind the program's name, which may hold anything.
        let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
        Some(fields.get(11)?.parse::<f64>().ok()? + fields.get(12)?.parse::<f64>().ok()?)
    };
    // A hundred ticks a second on every Linux.
    ticks().map_or_else(|| START.get_or_init(Instant::now).elapsed().as_secs_f64(), |ticks| ticks / 100.0)
}

fn print_table(readers: &[&Reader], tallies: &[Tally]) {
    println!(
        "\n| reader | inputs | read all the same | slowest | most memory | findings |\n|---|---:|---:|---:|---:|---:|"
    );
    for (reader, tally) in readers.iter().zip(tallies) {
        println!(
            "| {} | {} | {} | {:.0} ms | {:.1} MiB | {} |",
            reader.title,
            tally.inputs,
            tally.accepted,
            tally.slowest_s * 1e3,
            tally.largest as f64 / f64::from(1 << 20),
            tally.findings
        );
    }
    let all: u64 = tallies.iter().map(|tally| tally.inputs).sum();
    println!("| all | {all} | | | | {} |", tallies.iter().map(|tally| tally.findings).sum::<usize>());
}
