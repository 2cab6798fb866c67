//! A run that is killed leaves the results of the run before it whole.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::support::{Workplace, fast_with};
use meshtone_io::signals::{Recorded, read_signals};

const PANEL: [&str; 2] = ["panel.svg", "panel.png"];

/// A results directory into which two scenarios write in turn.
struct Contest {
    workplace: Workplace,
    earlier: Recorded,
    earlier_panel: Vec<Vec<u8>>,
}

impl Contest {
    fn new() -> Self {
        let workplace = Workplace::new();
        // Long enough for a kill to meet the simulation as well as the writing.
        let long = fast_with("sampling_rate_hz", "sampling_rate_hz = 1e5");
        workplace.write("a.toml", &long);
        workplace.write("b.toml", format!("{long}[quality]\ndin_grade = 5\n"));
        workplace.succeeds(&["simulate", "a.toml", "-o", "out"]);
        let earlier = read_signals(&workplace.path("out/signals.parquet")).unwrap();
        let earlier_panel = PANEL.map(|name| workplace.read(&format!("out/{name}"))).to_vec();
        Self { workplace, earlier, earlier_panel }
    }

    /// Starts the other scenario, kills it when `now` says so, and looks at what is there. Returns whether it
    /// was killed before it was through.
    fn kill(&self, now: impl Fn() -> bool) -> bool {
        let mut child = Command::new(env!("CARGO_BIN_EXE_meshtone"))
            .args(["simulate", "b.toml", "-o", "out"])
            .current_dir(self.workplace.directory.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        while !now() && child.try_wait().unwrap().is_none() {}
        child.kill().unwrap();
        let killed = !child.wait().unwrap().success();
        self.assert_whole();
        killed
    }

    fn assert_whole(&self) {
        let left = read_signals(&self.workplace.path("out/signals.parquet")).unwrap();
        let summary = self.workplace.read("out/summary.json");
        let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
        assert_eq!(summary["samples"], left.channels.len());
        if left == self.earlier {
            assert_eq!(
                PANEL.map(|name| self.workplace.read(&format!("out/{name}"))).to_vec(),
                self.earlier_panel
            );
            return;
        }
        // The other run was through before it was killed.
        assert_eq!(left.scenario.quality.din_grade, 5);
        self.workplace.succeeds(&["simulate", "a.toml", "-o", "out"]);
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
            std::fs::remove_file(self.workplace.path("out").join(name)).unwrap();
        }
    }
}

#[test]
fn killed_at_any_moment() {
    let contest = Contest::new();
    let mut killed = 0;
    for delay_ms in (0..120).step_by(10) {
        let (start, delay) = (Instant::now(), Duration::from_millis(delay_ms));
        killed += usize::from(contest.kill(|| start.elapsed() >= delay));
    }
    assert!(killed > 0);
}

#[test]
fn killed_while_it_writes() {
    let contest = Contest::new();
    let killed = (0..8).filter(|_| {
        contest.remove_what_the_killed_left();
        contest.kill(|| contest.is_being_written())
    });
    assert!(killed.count() > 0);
}
