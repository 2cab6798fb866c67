//! A run that is killed leaves the results of the run before it whole; where it is killed while it gives its files
//! their names, this can be seen, and the next command names the others.

use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::support::{FAST, Workplace, fast_and, fast_with, program, stderr};
use meshtone_io::signals::read_signals;
use meshtone_io::summary::read_run;

const SUMMARY: &str = "out/summary.json";
const FILES: [&str; 4] = ["out/signals.parquet", "out/panel.svg", "out/panel.png", SUMMARY];

/// A results directory into which two scenarios write in turn.
struct Contest {
    workplace: Workplace,
    earlier: [Vec<u8>; 4],
    /// Whether a run was killed while it gave its files their names.
    caught: std::cell::Cell<bool>,
}

impl Contest {
    /// Long enough for a kill to meet the simulation as well as the writing.
    fn long() -> Self {
        Self::of(&fast_with("sampling_rate_hz", "sampling_rate_hz = 1e5"))
    }

    fn of(scenario: &str) -> Self {
        let workplace = Workplace::new();
        workplace.write("a.toml", scenario);
        workplace.write("b.toml", format!("{scenario}[quality]\ndin_grade = 5\n"));
        workplace.succeeds(&["simulate", "a.toml", "-o", "out"]);
        let earlier = FILES.map(|name| workplace.read(name));
        Self { workplace, earlier, caught: false.into() }
    }

    /// Starts the other scenario, kills it when `now` says so, and looks at what is there. Returns whether it
    /// was killed before it was through.
    fn kill(&self, now: impl Fn() -> bool) -> bool {
        let mut child = program()
            .args(["simulate", "b.toml", "-o", "out"])
            .current_dir(self.workplace.directory.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        while !now() && child.try_wait().unwrap().is_none() {}
        child.kill().unwrap();
        let killed = !child.wait().unwrap().success();
        self.assert_whole_or_finished();
        killed
    }

    fn assert_whole_or_finished(&self) {
        if !self.workplace.path(SUMMARY).exists() {
            self.caught.set(true);
            let warning = stderr(&self.workplace.succeeds(&["panel", "out"]));
            assert!(warning.contains("which they have now"), "{warning}");
        }
        // With a summary, all files are of one run, and every one is whole.
        let signals = read_signals(&self.workplace.path(FILES[0])).unwrap();
        let run_of_signals = signals.run.to_string();
        assert_eq!(read_run(&self.workplace.path(SUMMARY)).unwrap(), signals.run);
        for name in FILES {
            let bytes = self.workplace.read(name);
            let found = bytes.windows(run_of_signals.len()).any(|part| part == run_of_signals.as_bytes());
            assert!(found, "{name} is not of the run {run_of_signals}");
        }
        match signals.scenario.wheels.first().map(|wheel| wheel.din_grade) {
            Some(0) => assert!(
                FILES.map(|name| self.workplace.read(name)) == self.earlier,
                "an earlier result changed"
            ),
            // The other run was through before it was killed.
            grade => {
                assert_eq!(grade, Some(5));
                self.start_again();
            }
        }
    }

    /// The earlier results once more; their summary differs by the computing times.
    fn start_again(&self) {
        self.workplace.succeeds(&["simulate", "a.toml", "-o", "out"]);
        std::fs::write(self.workplace.path(SUMMARY), &self.earlier[3]).unwrap();
    }

    /// Whether a run has begun to write its results, under another name.
    fn is_being_written(&self) -> bool {
        let entries = std::fs::read_dir(self.workplace.path("out")).unwrap().flatten();
        let sizes = entries
            .filter(|entry| entry.file_name().to_string_lossy().starts_with(".meshtone-"))
            .filter_map(|entry| entry.metadata().ok().map(|metadata| metadata.len()));
        sizes.sum::<u64>() > 0
    }

    fn remove_what_the_killed_left(&self) {
        for name in self.workplace.names("out").iter().filter(|name| name.starts_with(".meshtone-")) {
            let path = self.workplace.path("out").join(name);
            let removed =
                if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
            removed.unwrap();
        }
    }
}

#[test]
fn killed_at_any_moment() {
    let contest = Contest::long();
    let mut killed = 0;
    for delay_ms in (0..120).step_by(10) {
        let (start, delay) = (Instant::now(), Duration::from_millis(delay_ms));
        killed += usize::from(contest.kill(|| start.elapsed() >= delay));
    }
    assert!(killed > 0);
}

#[test]
fn killed_while_it_writes() {
    let contest = Contest::long();
    let killed = (0..8).filter(|_| {
        contest.remove_what_the_killed_left();
        contest.kill(|| contest.is_being_written())
    });
    assert!(killed.count() > 0);
}

/// Whether the kill comes in time is a matter of luck; what it leaves must be consistent, or seen not to be, either way.
#[test]
fn killed_while_it_names_its_files() {
    let contest = Contest::of(FAST);
    let summary = contest.workplace.path(SUMMARY);
    for _ in 0..20 {
        contest.kill(|| !summary.exists());
        if contest.caught.get() {
            break;
        }
    }
}

/// Asked to end, a run leaves neither unfinished files nor an empty directory.
#[cfg(unix)]
#[test]
fn asked_to_end() {
    let workplace = Workplace::new();
    workplace.write("long.toml", fast_with("sampling_rate_hz", "sampling_rate_hz = 1e5"));
    let mut ended = 0;
    for number in 1..=12 {
        let mut child = program()
            .args(["simulate", "long.toml", "-o", "out/deep"])
            .current_dir(workplace.directory.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let part = (f64::from(number) * 0.618_033_988_749_895).fract();
        std::thread::sleep(Duration::from_secs_f64(0.2 * part));
        std::process::Command::new("kill").arg(child.id().to_string()).status().unwrap();
        if child.wait().unwrap().success() {
            std::fs::remove_dir_all(workplace.path("out")).unwrap();
            continue;
        }
        ended += 1;
        if workplace.path("out/deep/summary.json").exists() {
            std::fs::remove_dir_all(workplace.path("out")).unwrap();
        }
        assert_eq!(workplace.names("."), ["fast.toml", "long.toml"], "{number}");
    }
    assert!(ended > 0);
}

/// What a killed run has left is removed by the next one, and a run into the same directory is refused because of the first.
#[test]
fn two_at_once_and_what_the_killed_left() {
    let workplace = Workplace::new();
    workplace.write("long.toml", fast_with("sampling_rate_hz", "sampling_rate_hz = 2e6"));
    let mut child = program()
        .args(["simulate", "long.toml", "-o", "out"])
        .current_dir(workplace.directory.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while !workplace.path("out/.meshtone-results").exists() && child.try_wait().unwrap().is_none() {}
    for arguments in [["simulate", "fast.toml", "-o", "out"].as_slice(), &["panel", "out"]] {
        let message = stderr(&workplace.command(arguments).assert().code(1).stdout(""));
        assert!(message.contains("another program is writing results to the directory out"), "{message}");
    }
    child.kill().unwrap();
    child.wait().unwrap();
    std::fs::write(workplace.path("out/.meshtone-unfinished"), "half a file").unwrap();
    assert!(workplace.path("out/.meshtone-results").exists());
    workplace.succeeds(&["simulate", "fast.toml", "-o", "out", "--no-panel"]);
    assert_eq!(workplace.names("out"), ["signals.parquet", "summary.json"]);
    // Files that are written one by one clear up where they are written.
    workplace.write("worn.toml", fast_and("[quality]\ndin_grade = 7"));
    for arguments in [["init", "healthy", "-o", "healthy.toml"], ["wheels", "worn.toml", "-o", "wheels.npz"]]
    {
        workplace.write(".meshtone-unfinished", "half a file");
        workplace.succeeds(&arguments);
        assert!(!workplace.path(".meshtone-unfinished").exists(), "{arguments:?}");
    }
}
