//! What the tests of the program share.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use serde_json::Value;
use tempfile::{TempDir, tempdir};

pub const PROGRAM: &str = env!("CARGO_BIN_EXE_meshtone");

/// A scenario that takes milliseconds: tooth counts with a large common factor need few samples a revolution.
/// `[gears]` is line 1; `[quality]` and its grade are the last two lines, 10 and 11.
pub const FAST: &str = "[gears]\nmodule_mm = 3.0\npinion_teeth = 20\ngear_teeth = 40\nface_width_mm = 15.0\n\
                        [operation]\npinion_speed_hz = 40.0\nbrake_torque_nm = 200.0\n\
                        [solver]\nsampling_rate_hz = 11200.0\n";

/// A directory with `fast.toml` in it, in which the program runs.
pub struct Workplace {
    pub directory: TempDir,
}

impl Workplace {
    pub fn new() -> Self {
        let workplace = Self { directory: tempdir().unwrap() };
        workplace.write("fast.toml", FAST);
        workplace
    }

    pub fn path(&self, name: &str) -> std::path::PathBuf {
        self.directory.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    /// All names in a directory, sorted.
    pub fn names(&self, directory: &str) -> Vec<String> {
        names(&self.path(directory))
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = program();
        command.current_dir(self.directory.path()).args(arguments);
        Command::from_std(command)
    }

    #[track_caller]
    pub fn succeeds(&self, arguments: &[&str]) -> Assert {
        self.command(arguments).assert().success()
    }

    /// Asserts that the program leaves with `code`, says all of `words`, and neither prints nor writes anything.
    #[track_caller]
    pub fn fails(&self, code: i32, arguments: &[&str], words: &[&str]) {
        let before = self.names(".");
        let assert = self.command(arguments).assert().code(code).stdout("");
        let message = stderr(&assert);
        for word in words {
            assert!(message.contains(word), "`{word}` is not in: {message}");
        }
        assert!(message.starts_with("error: "), "{message}");
        assert_eq!(self.names("."), before, "something was written although {message}");
    }
}

/// The program, where nobody asks for colours and messages find room on their lines.
pub fn program() -> std::process::Command {
    with_room(std::process::Command::new(PROGRAM))
}

/// The program, which cannot write files of more than some blocks: of 512 or 1024 bytes, as the shell likes.
#[cfg(unix)]
pub fn program_with_small_files(blocks: u32) -> std::process::Command {
    let mut shell = std::process::Command::new("sh");
    let limited = "trap '' XFSZ; ulimit -f \"$1\"; shift; exec \"$@\"";
    shell.args(["-c", limited, "sh", &blocks.to_string(), PROGRAM]);
    with_room(shell)
}

fn with_room(mut command: std::process::Command) -> std::process::Command {
    for asks_for_colours in ["CLICOLOR_FORCE", "FORCE_COLOR"] {
        command.env_remove(asks_for_colours);
    }
    command.envs([("NO_COLOR", "1"), ("COLUMNS", "100")]);
    command
}

pub fn names(directory: &Path) -> Vec<String> {
    let entries = fs::read_dir(directory).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

pub fn stdout(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

/// Returns the one line that a command printed with `--json`.
pub fn printed_json(assert: &Assert) -> Value {
    let text = stdout(assert);
    assert_eq!(text.lines().count(), 1, "{text}");
    serde_json::from_str(&text).unwrap()
}

pub fn stderr(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

/// The scenario with another line instead of the one that starts with `key`.
pub fn fast_with(key: &str, line: &str) -> String {
    assert!(FAST.lines().any(|old| old.starts_with(key)), "{key}");
    let line_of = |old: &str| if old.starts_with(key) { format!("{line}\n") } else { format!("{old}\n") };
    FAST.lines().map(line_of).collect()
}

/// The scenario with more lines, from line 11 on.
pub fn fast_and(lines: &str) -> String {
    format!("{FAST}{lines}\n")
}
