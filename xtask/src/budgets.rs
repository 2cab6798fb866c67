//! What the project may cost: lines of code, words, processor time, size, instructions.
//!
//! `budgets.toml` states each budget. A change that needs more raises it in the same commit and says why.

use std::io::ErrorKind;
use std::path::Path;
use std::process::Command;

use toml::Table;

use crate::files;
use crate::rooms::code;
use crate::step::{StepRunner, StepTime, cargo};
use crate::yardstick::Yardstick;

/// The file of the budgets, from the workspace's root.
const FILE: &str = "budgets.toml";

/// The numbers of `[processor_seconds]` that are not of one step.
const OF_NO_STEP: [&str; 5] = ["slack", "yardstick", "first_command", "all_checks", "any_other_step"];

/// The budgets of one table of the file.
struct Budgets {
    name: &'static str,
    table: Table,
}

impl Budgets {
    /// # Errors
    /// The file cannot be read, or has no such table.
    fn read(root: &Path, name: &'static str) -> Result<Self, String> {
        let text = files::read(&root.join(FILE)).map_err(|error| error.to_string())?;
        let mut file: Table = text.parse().map_err(|error| format!("{FILE}: {error}"))?;
        match file.remove(name) {
            Some(toml::Value::Table(table)) => Ok(Self { name, table }),
            _ => Err(format!("{FILE}: there is no table [{name}]")),
        }
    }

    /// A number of the table.
    fn number(&self, key: &str) -> Result<f64, String> {
        let value = self.table.get(key);
        let number =
            value.and_then(|value| value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64)));
        number.ok_or_else(|| format!("{FILE}: [{}] has no number `{key}`", self.name))
    }

    /// The problem where more is used than the budget allows, with `slack` times as much allowed.
    fn problem(&self, key: &str, used: f64, slack: f64) -> Result<Option<String>, String> {
        let budget = self.number(key)?;
        let problem = || {
            let allowed =
                if slack == 1.0 { String::new() } else { format!(", {slack:.2} times as much allowed") };
            format!(
                "{used:.1} is more than the budget of {budget} for `{key}` in [{}] of {FILE}{allowed}: use less, or raise it in \
                 the same commit and say why",
                self.name
            )
        };
        Ok((used > budget * slack).then(problem))
    }

    /// How many times the budgets a step may take: `slack`, times how much slower the processor was than the budgets' machine.
    fn allowed(&self, yardstick: &Yardstick) -> Result<f64, String> {
        let quiet_s = self.number("yardstick")?;
        let measured_s = yardstick.mean_s().unwrap_or(quiet_s);
        println!(
            "    yardstick: {measured_s:.4} s, {:.2} times that of the budgets' machine",
            measured_s / quiet_s
        );
        Ok(self.number("slack")? * measured_s / quiet_s)
    }

    /// The budgets of steps that there are no more, and so would never be exceeded.
    fn without_step(&self, times: &[StepTime]) -> impl Iterator<Item = String> {
        let names = self.table.keys().filter(|key| !OF_NO_STEP.contains(&key.as_str()));
        names.filter(|key| times.iter().all(|time| time.name != **key)).map(|key| {
            format!("{FILE}: [{}] has a budget of `{key}`, and no step has this name: take it out", self.name)
        })
    }
}

/// The budgets of sources that are exceeded.
///
/// # Errors
/// A file that cannot be read.
pub fn of_sources(root: &Path) -> Result<Vec<String>, String> {
    let budgets = Budgets::read(root, "sources")?;
    let lines = code_lines(root).map_err(|error| error.to_string())?;
    let words = words(root).map_err(|error| error.to_string())?;
    let used = [("rust_code_lines", lines), ("book_words", words)];
    let problems = used.map(|(key, used)| budgets.problem(key, used as f64, 1.0));
    Ok(problems.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
}

/// Lines of code of the packages and the checks: without tests, comments and blank lines.
fn code_lines(root: &Path) -> std::io::Result<usize> {
    let crates = root.join("crates");
    let packages = files::names_in(&crates)?.into_iter().map(|name| crates.join(name).join("src"));
    let folders = packages.filter(|folder| folder.is_dir()).chain([root.join("xtask").join("src")]);
    let mut lines = 0;
    for folder in folders {
        for path in files::below(&folder, "rs")? {
            // A file of this name is a module of tests.
            if path.file_name().is_none_or(|name| name != "tests.rs") {
                lines += code_lines_of(&files::read(&path)?);
            }
        }
    }
    Ok(lines)
}

/// Of one file, up to its tests.
fn code_lines_of(text: &str) -> usize {
    code(text).filter(|(_, line)| !line.trim().is_empty()).count()
}

fn words(root: &Path) -> std::io::Result<usize> {
    let pages = files::below(&root.join("docs").join("src"), "md")?;
    pages.iter().map(|page| Ok(files::read(page)?.split_whitespace().count())).sum()
}

/// The budgets of the checks that are exceeded: the processor time of each step and of all, and the size of the program.
///
/// # Arguments
/// * `root` - folder of the workspace, where the program has been built
/// * `times` - of the steps that have ended
/// * `yardstick` - measured beside them
///
/// # Errors
/// A file that cannot be read.
pub fn of_checks(root: &Path, times: &[StepTime], yardstick: &Yardstick) -> Result<Vec<String>, String> {
    let seconds = Budgets::read(root, "processor_seconds")?;
    let slack = seconds.allowed(yardstick)?;
    let total: f64 = times.iter().map(|time| time.processor_s).sum();
    let mut problems = vec![seconds.problem("all_checks", total, slack)?];
    problems.extend(seconds.without_step(times).map(Some));
    for time in times {
        let name = if seconds.table.contains_key(&time.name) { &time.name } else { "any_other_step" };
        let problem = seconds.problem(name, time.processor_s, slack)?;
        problems.push(problem.map(|problem| format!("{}: {problem}", time.name)));
    }
    let program = root.join("target").join("dist").join(format!("meshtone{}", std::env::consts::EXE_SUFFIX));
    let bytes = std::fs::metadata(&program).map_err(|error| format!("{}: {error}", program.display()))?.len();
    problems.push(Budgets::read(root, "program")?.problem("stripped_megabytes", bytes as f64 / 1e6, 1.0)?);
    Ok(problems.into_iter().flatten().collect())
}

/// Measures what the checks leave out, and compares it with its budgets: README's first command in an empty folder, and where there is
/// valgrind the instructions of the program.
///
/// # Errors
/// The exit code of what failed, or 1 where a budget is exceeded.
pub fn measure(row: &StepRunner) -> Result<(), u8> {
    let yardstick = Yardstick::begin();
    let target = row.root().join("target").join("measure");
    row.step("first command, from nothing", || {
        if target.exists() {
            std::fs::remove_dir_all(&target).map_err(|error| row.fail_at(&target, &error))?;
        }
        let mut cargo = cargo();
        let arguments =
            ["run", "--release", "--locked", "--", "simulate", "examples/tooth_breakage.toml", "-o"];
        row.program(cargo.args(arguments).arg(target.join("results")).env("CARGO_TARGET_DIR", &target))
    })?;
    let first_command_s = row.times().last().map_or(0.0, |time| time.processor_s);
    row.check("budget of the first command", |root| {
        let seconds = Budgets::read(root, "processor_seconds")?;
        let problem = seconds.problem("first_command", first_command_s, seconds.allowed(&yardstick)?)?;
        Ok::<_, String>(problem.into_iter().collect())
    })?;
    row.check("budgets of instructions", |root| instructions(root, &target))
}

/// The runs of the program that execute more instructions than their budgets, which are those of valgrind's processor.
fn instructions(root: &Path, target: &Path) -> Result<Vec<String>, String> {
    let budgets = Budgets::read(root, "million_instructions")?;
    let mut problems = Vec::new();
    for example in budgets.table.keys() {
        let command = if example.starts_with("datasets/") { "dataset" } else { "simulate" };
        let mut valgrind = Command::new("valgrind");
        valgrind.args(["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]);
        valgrind.arg(target.join("release").join("meshtone")).arg(command);
        valgrind
            .arg(root.join("examples").join(format!("{example}.toml")))
            .arg("-o")
            .arg(target.join(command));
        let output = match valgrind.current_dir(root).output() {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                println!("    instructions were not counted: there is no valgrind");
                return Ok(problems);
            }
            output => output.map_err(|error| format!("cannot start valgrind: {error}"))?,
        };
        let said = String::from_utf8_lossy(&output.stderr);
        let counted = counted(&said).filter(|_| output.status.success());
        let counted = counted.ok_or_else(|| format!("{example} under valgrind: {said}"))?;
        println!("    {example}: {:.1} million instructions", counted as f64 / 1e6);
        problems.extend(budgets.problem(example, counted as f64 / 1e6, 1.0)?);
    }
    Ok(problems)
}

/// The number in cachegrind's line `I refs:  1,234`.
fn counted(said: &str) -> Option<u64> {
    let line = said.lines().find(|line| line.contains("I refs") || line.contains("I   refs"))?;
    line.rsplit(' ').next()?.replace(',', "").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_comments_and_blank_lines_are_no_code() {
        let text = "//! Words.\n\nfn f() {\n    // Why.\n}\n\n#[cfg(test)]\nmod tests {\n    fn g() {}\n}\n";
        assert_eq!(code_lines_of(text), 2);
    }

    #[test]
    fn a_budget_that_is_exceeded_is_named_with_both_numbers() {
        let table = "lines = 10\nseconds = 2.5".parse().expect("a table");
        let budgets = Budgets { name: "sources", table };
        assert_eq!(budgets.problem("lines", 10.0, 1.0), Ok(None));
        let problem = budgets.problem("lines", 11.0, 1.0).expect("a budget").expect("a problem");
        assert!(problem.contains("11") && problem.contains("10") && problem.contains("`lines` in [sources]"));
        assert_eq!(budgets.problem("seconds", 3.0, 1.5), Ok(None));
        assert!(budgets.problem("words", 1.0, 1.0).is_err_and(|error| error.contains("`words`")));
    }

    #[test]
    fn a_budget_of_a_step_that_is_gone_is_found() {
        let table = "slack = 1.5\nrenamed = 10\ntests = 20".parse().expect("a table");
        let budgets = Budgets { name: "processor_seconds", table };
        let times = [StepTime { name: "tests".into(), processor_s: 1.0 }];
        let problems: Vec<String> = budgets.without_step(&times).collect();
        assert!(matches!(&problems[..], [problem] if problem.contains("`renamed`")), "{problems:?}");
    }

    #[test]
    fn instructions_are_read_from_what_valgrind_says() {
        assert_eq!(counted("==12== \n==12== I refs:        438,031,268\n"), Some(438_031_268));
        assert_eq!(counted("==12== Error"), None);
    }
}
