//! One timed step of a task, and where its programs write.

use std::cell::{Cell, RefCell};
use std::ffi::OsString;
use std::fmt::Display;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use wait4::Wait4;

use crate::compilations::Compilation;

/// Runs steps one after another, perhaps beside those of another row.
pub struct StepRunner {
    root: PathBuf,
    /// Folder of the steps' output; without one they write to the terminal.
    logs: Option<PathBuf>,
    /// Output of the step that runs.
    log: RefCell<Option<File>>,
    /// Processor time of the programs of the step that runs.
    processor: Cell<Duration>,
    /// Variables of all that compiles.
    environment: Vec<(&'static str, OsString)>,
    /// A step has failed, in this row or in the one beside it: none begins any more.
    failed: Arc<AtomicBool>,
    /// The steps of both rows that have ended.
    ended: Arc<Mutex<Vec<StepTime>>>,
}

/// What a step took.
#[derive(Debug, Clone)]
pub struct StepTime {
    /// Its name.
    pub name: String,
    /// (s) Processor time of the programs that it ran; on Unix also of those that they ran.
    pub processor_s: f64,
}

impl StepRunner {
    /// Steps that write to the terminal.
    ///
    /// # Arguments
    /// * `root` - folder of the workspace, where its programs run
    /// * `environment` - variables of all that compiles
    pub fn at_terminal(root: &Path, environment: &[(&'static str, OsString)]) -> Self {
        Self {
            root: root.to_owned(),
            logs: None,
            log: RefCell::default(),
            processor: Cell::default(),
            environment: environment.to_vec(),
            failed: Arc::default(),
            ended: Arc::default(),
        }
    }

    /// Two rows that run at once. Each of their steps writes to a file of its own, which is shown where the step fails.
    ///
    /// # Arguments
    /// * `root` - folder of the workspace, where their programs run
    /// * `logs` - folder of the files
    /// * `environment` - variables of all that compiles in them
    ///
    /// # Errors
    /// 1 where the folder cannot be made.
    pub fn pair(root: &Path, logs: &Path, environment: &[(&'static str, OsString)]) -> Result<[Self; 2], u8> {
        std::fs::create_dir_all(logs).map_err(|error| failed(logs, &error))?;
        let one = Self { logs: Some(logs.to_owned()), ..Self::at_terminal(root, environment) };
        let other = Self {
            logs: Some(logs.to_owned()),
            failed: Arc::clone(&one.failed),
            ended: Arc::clone(&one.ended),
            ..Self::at_terminal(root, environment)
        };
        Ok([one, other])
    }

    /// Variables of all that compiles, so that no step compiles again what another one has.
    pub fn environment(&self) -> impl Iterator<Item = (&'static str, OsString)> {
        self.environment.iter().cloned()
    }

    /// What the steps of both rows took that have ended so far, in the order of their ends.
    pub fn times(&self) -> Vec<StepTime> {
        self.ended.lock().unwrap_or_else(PoisonError::into_inner).clone()
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
        self.processor.set(Duration::ZERO);
        let outcome = work();
        let seconds = start.elapsed().as_secs_f64();
        let processor_s = self.processor.get().as_secs_f64();
        self.log.replace(None);
        let time = StepTime { name: name.to_owned(), processor_s };
        self.ended.lock().unwrap_or_else(PoisonError::into_inner).push(time);
        match &outcome {
            Ok(_) => println!("    ok, {seconds:.1} s, {processor_s:.1} s of processor time: {name}"),
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
        self.run_cargo(&format!("cargo {}", arguments.join(" ")), arguments, environment)
    }

    /// Runs a compilation, and what it compiles where that is tests, as a step of its name.
    ///
    /// # Arguments
    /// * `compilation` - what is compiled
    /// * `further` - arguments behind its own
    /// * `environment` - variables to set, by name
    ///
    /// # Errors
    /// Cargo's exit code, or 1 where it could not be started or was killed.
    pub fn compile(
        &self,
        compilation: &Compilation,
        further: &[&str],
        environment: &[(&str, OsString)],
    ) -> Result<(), u8> {
        let own = compilation.arguments.iter().map(String::as_str);
        let arguments: Vec<&str> = own.chain(further.iter().copied()).collect();
        self.run_cargo(&compilation.name, &arguments, environment)
    }

    /// Runs cargo as a step, with the variables of all that compiles.
    fn run_cargo(&self, name: &str, arguments: &[&str], environment: &[(&str, OsString)]) -> Result<(), u8> {
        let mut cargo = cargo();
        cargo.args(arguments).envs(self.environment()).envs(environment.iter().cloned());
        self.step(name, || self.program(&mut cargo))
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
        let used = command.spawn().and_then(|child| child.wait4()).map_err(|error| {
            self.fail(&format!("cannot start {}: {error}", command.get_program().display()))
        })?;
        self.processor.set(self.processor.get() + used.rusage.utime + used.rusage.stime);
        let status = used.status;
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

/// Cargo, which informs the programs that it runs which cargo it is.
pub fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
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
