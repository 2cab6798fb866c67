//! One timed step of a task, and where its programs write.

use std::cell::RefCell;
use std::ffi::OsString;
use std::fmt::Display;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Runs steps one after another, perhaps beside those of another row.
pub struct StepRunner {
    root: PathBuf,
    /// Folder of the steps' output; without one they write to the terminal.
    logs: Option<PathBuf>,
    /// Output of the step that runs.
    log: RefCell<Option<File>>,
    /// A step has failed, in this row or in the one beside it: none begins any more.
    failed: Arc<AtomicBool>,
}

impl StepRunner {
    /// Steps that write to the terminal.
    ///
    /// # Arguments
    /// * `root` - folder of the workspace, where its programs run
    pub fn at_terminal(root: &Path) -> Self {
        Self { root: root.to_owned(), logs: None, log: RefCell::default(), failed: Arc::default() }
    }

    /// Two rows that run at once. Each of their steps writes to a file of its own, which is shown where the step fails.
    ///
    /// # Arguments
    /// * `root` - folder of the workspace, where their programs run
    /// * `logs` - folder of the files
    ///
    /// # Errors
    /// 1 where the folder cannot be made.
    pub fn pair(root: &Path, logs: &Path) -> Result<[Self; 2], u8> {
        std::fs::create_dir_all(logs).map_err(|error| failed(logs, &error))?;
        let failed = Arc::default();
        let row = || Self {
            root: root.to_owned(),
            logs: Some(logs.to_owned()),
            log: RefCell::default(),
            failed: Arc::clone(&failed),
        };
        Ok([row(), row()])
    }

    /// Folder of the workspace.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Runs `work` as a step, and says how long it took.
    ///
    /// # Errors
    /// The exit code that `work` failed with, or 1 where a step of the other row has failed before.
    pub fn step<T>(&self, name: &str, work: impl FnOnce() -> Result<T, u8>) -> Result<T, u8> {
        if self.failed.load(Ordering::Relaxed) {
            return Err(1);
        }
        let path = self.logs.as_ref().map(|logs| logs.join(format!("{}.log", file_name(name))));
        if let Some(path) = &path {
            let file = File::create(path).map_err(|error| failed(path, &error))?;
            self.log.replace(Some(file));
        }
        println!("==> {name}");
        let start = Instant::now();
        let outcome = work();
        let seconds = start.elapsed().as_secs_f64();
        self.log.replace(None);
        match &outcome {
            Ok(_) if path.is_some() => println!("    ok, {seconds:.1} s: {name}"),
            Ok(_) => println!("    ok, {seconds:.1} s"),
            Err(code) => {
                self.failed.store(true, Ordering::Relaxed);
                let output = path.and_then(|path| std::fs::read(path).ok()).unwrap_or_default();
                // What cannot be shown is in the file.
                let _ = io::stderr().lock().write_all(&output);
                eprintln!("    FAILED with exit code {code} after {seconds:.1} s: {name}");
            }
        }
        outcome
    }

    /// Runs a check as a step, and says everything that it finds wrong.
    ///
    /// # Errors
    /// 1 where something is wrong, and where that cannot be found out.
    pub fn check<E: Display>(
        &self,
        name: &str,
        find: impl FnOnce(&Path) -> Result<Vec<String>, E>,
    ) -> Result<(), u8> {
        self.step(name, || {
            let problems = find(&self.root).map_err(|error| self.fail(&error.to_string()))?;
            for problem in &problems {
                self.fail(problem);
            }
            if problems.is_empty() { Ok(()) } else { Err(1) }
        })
    }

    /// Runs cargo in the workspace's folder as a step named after its arguments.
    ///
    /// # Arguments
    /// * `arguments` - cargo's arguments
    /// * `environment` - variables to set, by name
    ///
    /// # Errors
    /// Cargo's exit code, or 1 where it could not be started or was killed.
    pub fn cargo(&self, arguments: &[&str], environment: &[(&str, OsString)]) -> Result<(), u8> {
        // Cargo informs the programs that it runs which cargo it is.
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo"));
        self.step(&format!("cargo {}", arguments.join(" ")), || {
            self.program(Command::new(&cargo).args(arguments).envs(environment.iter().cloned()))
        })
    }

    /// Runs a program in the workspace's folder to its end.
    ///
    /// # Errors
    /// Its exit code, or 1 where it could not be started or was killed.
    pub fn program(&self, command: &mut Command) -> Result<(), u8> {
        if command.get_current_dir().is_none() {
            command.current_dir(&self.root);
        }
        if self.logs.is_some() {
            // A program that asks something would wait for ever.
            command.stdin(Stdio::null());
        }
        if let Some(file) = self.log.borrow().as_ref() {
            let [out, err] = [file.try_clone(), file.try_clone()];
            command.stdout(out.map_err(|_| 1)?).stderr(err.map_err(|_| 1)?);
        }
        let status = command.status().map_err(|error| {
            self.fail(&format!("cannot start {}: {error}", command.get_program().display()))
        })?;
        if status.success() { Ok(()) } else { Err(exit_code(status.code())) }
    }

    /// Writes a line among what the step's programs write.
    pub fn say(&self, line: &str) {
        match self.log.borrow_mut().as_mut() {
            // As with the terminal, nothing depends on it.
            Some(file) => drop(writeln!(file, "{line}")),
            None => println!("{line}"),
        }
    }

    /// Says what is wrong; returns the exit code 1.
    pub fn fail(&self, problem: &str) -> u8 {
        self.say(&format!("error: {problem}"));
        1
    }

    /// Says what went wrong with a file or folder; returns the exit code 1.
    pub fn fail_at(&self, path: &Path, error: &io::Error) -> u8 {
        self.fail(&format!("{}: {error}", path.display()))
    }
}

/// Runs two rows at once.
///
/// # Errors
/// The first one's exit code, or else the second one's.
pub fn in_parallel(
    one: impl FnOnce() -> Result<(), u8>,
    other: impl FnOnce() -> Result<(), u8> + Send,
) -> Result<(), u8> {
    std::thread::scope(|scope| {
        let other = scope.spawn(other);
        let one = one();
        one.and(other.join().unwrap_or(Err(1)))
    })
}

fn failed(path: &Path, error: &io::Error) -> u8 {
    eprintln!("error: {}: {error}", path.display());
    1
}

/// A step's name as that of a file: its letters and digits, with one hyphen for whatever stands between them.
fn file_name(step: &str) -> String {
    let words = step.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-").to_ascii_lowercase()
}

/// A failed program's exit code as this program's own: never 0, and 1 where it has none.
pub fn exit_code(code: Option<i32>) -> u8 {
    code.and_then(|code| u8::try_from(code).ok()).filter(|&code| code != 0).unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::{exit_code, file_name};

    #[test]
    fn a_failure_never_becomes_success() {
        assert_eq!(exit_code(Some(101)), 101);
        assert_eq!(exit_code(Some(256)), 1);
        assert_eq!(exit_code(Some(0)), 1);
        assert_eq!(exit_code(None), 1);
    }

    #[test]
    fn files_are_named_after_their_steps() {
        assert_eq!(file_name("cargo test --workspace --release"), "cargo-test-workspace-release");
        assert_eq!(file_name("SciPy's results"), "scipy-s-results");
    }
}
