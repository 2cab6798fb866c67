//! Reading a plan.

mod background;
mod base;
mod class;
mod growth;
mod keep;
mod rule;
mod split;

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use meshtone::scenario::{Model, Scenario};
use meshtone_io::experiment::{Tuned, read_tuned};
use meshtone_io::scenario_file::{FileKind, ReadScenarioError, read_text};
use meshtone_toml::{ReadResult, TomlDocument, TomlError, TomlTable, TomlValue};

use super::{About, Class, Content, Plan, PlanFile, Question, Rule, Variation, check, identity};
use crate::expression::Condition;
use crate::sampling::Design;

const MOST_UNITS: u64 = 1 << 40;
const MOST_MOUNTINGS: u64 = 1 << 20;
const LICENCE: &str = "CC-BY-4.0";
const VERSION: &str = "1.0.0";

/// The place of a plan, and the files that were read on the way.
struct Reading<'a> {
    directory: &'a Path,
    /// Whether it is a copy beside its data, where the files that it names have names of their own.
    is_copy: bool,
    files: Vec<PlanFile>,
    sources: Vec<PathBuf>,
    /// The problem of another file, if that file has one: it is reported with that file's lines.
    elsewhere: Option<ReadScenarioError>,
}

impl Plan {
    /// Reads a plan and the files that it names, and checks that its first records can be drawn.
    ///
    /// # Arguments
    /// * `path` - the plan; names of other files in it are relative to its directory
    ///
    /// # Errors
    /// A file that cannot be read; what is wrong in one of them, with key and line.
    pub fn read(path: &Path) -> Result<Self, ReadScenarioError> {
        read(read_text(path)?, path, false)
    }

    /// Reads the copy of a plan that stands beside its data, where the files that the plan names have been copied too.
    ///
    /// # Arguments
    /// * `path` - the plan's copy
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_copy(path: &Path) -> Result<Self, ReadScenarioError> {
        read(read_text(path)?, path, true)
    }

    /// As [`Self::read`], of a text.
    ///
    /// # Arguments
    /// * `text` - the plan
    /// * `path` - where it is from
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_text(text: String, path: &Path) -> Result<Self, ReadScenarioError> {
        read(text, path, false)
    }
}

fn read(text: String, path: &Path, is_copy: bool) -> Result<Plan, ReadScenarioError> {
    let directory = path.parent().unwrap_or(Path::new(""));
    let mut reading =
        Reading { directory, is_copy, files: Vec::new(), sources: vec![path.to_path_buf()], elsewhere: None };
    let read = TomlDocument::parse(&text).and_then(|document| {
        let plan = document.root().read(|root| plan(root, &mut reading));
        let checked = plan.and_then(|plan| {
            check::unique_columns(&plan)?;
            check::first_records(&plan)?;
            Ok(plan)
        });
        checked.map_err(|error| document.locate(error))
    });
    match (read, reading.elsewhere) {
        (Ok(mut plan), _) => {
            plan.files.insert(0, PlanFile { name: PlanFile::NAMES[0], text });
            plan.identity = identity(&plan.files);
            Ok(plan)
        }
        (Err(_), Some(error)) => Err(error),
        (Err(error), None) => {
            Err(ReadScenarioError::invalid(FileKind::Plan, path.to_path_buf(), text, error))
        }
    }
}

impl Reading<'_> {
    /// Returns the path of a file that the plan names.
    fn path_of(&self, name: &str, copy: &str) -> PathBuf {
        self.directory.join(if self.is_copy { copy } else { name })
    }
}

/// Reads the whole plan.
///
/// The base scenario is read first and the tuned keys are put into it, because classes, rules and what is kept are read against it. The
/// questions are read last: they name classes, and a plan whose classes do not fit each other shall be refused for that.
fn plan(root: &TomlTable<'_>, reading: &mut Reading) -> ReadResult<Plan> {
    let text = |key, default: &str| -> ReadResult<String> {
        Ok(root.read_optional(key, TomlValue::string)?.unwrap_or(default).to_owned())
    };
    let if_stated = |key| -> ReadResult<Option<String>> {
        Ok(root.read_optional(key, TomlValue::string)?.map(str::to_owned))
    };
    let about = About {
        title: text("title", "Spur gear vibration")?,
        description: text("description", "")?,
        licence: text("licence", LICENCE)?,
        version: root.read_optional("version", version)?.unwrap_or(VERSION).to_owned(),
        published: root.read_optional("published", date)?.map(str::to_owned),
        citation: if_stated("citation")?,
        creator: if_stated("creator")?,
        url: if_stated("url")?,
        doi: if_stated("doi")?,
        questions: Vec::new(),
    };
    let seed = root.read_optional("seed", |value| value.integer(0..=u64::MAX))?;
    let design = root.read_optional("design", |value| value.choice(&Design::NAMES))?;
    let mut base = base::read(root, reading)?;
    let tuned = root.read_optional("tuned", |value| {
        let tuned = tuned(value, reading)?;
        base = base::tuned(&base, &tuned, value)?;
        Ok(tuned)
    })?;
    let units =
        root.required("units", "how many units, that is pairs of wheels or gearboxes, share the records")?;
    let classes = class::read_all(root, &base)?;
    let keep = root.table_or_empty("keep")?.read(|table| keep::read(table, &base, tuned.as_ref()))?;
    let content = Content {
        seed: seed.unwrap_or(1),
        units: units.integer(1..=MOST_UNITS)?,
        mountings: root.read_optional("mountings", |value| value.integer(1..=MOST_MOUNTINGS))?.unwrap_or(1),
        design: design.unwrap_or_default(),
        background: root.read_optional("background", |value| background::read(value, &keep, reading))?,
        keep,
        rules: rules(root, &base, tuned.as_ref(), &classes)?,
        classes,
        constraints: root.read_optional("constraints", conditions)?.unwrap_or_default(),
        splits: root.read_optional("split", |value| value.table()?.read(split::read))?.unwrap_or_default(),
        base,
        tuned,
    };
    check::check(&content, root)?;
    let questions = root.read_optional("questions", |value| questions(value, &content.classes))?;
    Ok(Plan {
        about: About { questions: questions.unwrap_or_default(), ..about },
        content,
        files: std::mem::take(&mut reading.files),
        sources: std::mem::take(&mut reading.sources),
        identity: String::new(),
    })
}

/// The rules for all classes: those of the plan, then those of its variation for keys that nothing else decides.
fn rules(
    root: &TomlTable<'_>,
    base: &Scenario,
    tuned: Option<&Tuned>,
    classes: &[Class],
) -> ReadResult<Vec<Rule>> {
    let mut rules = rule::read_all(root)?;
    let Some(value) = root.optional("variation") else { return Ok(rules) };
    let variation = value.choice(&Variation::NAMES)?;
    if base.model != Model::Contact {
        let problem =
            format!("is for the model \"contact\", and the scenario has model = \"{}\"", base.model.name());
        return Err(value.error(problem).with_help("leave it out and vary keys with [[vary]]"));
    }
    let of_classes = classes.iter().flat_map(|class| &class.rules);
    let mut decided: Vec<String> =
        rules.iter().chain(of_classes).flat_map(|rule| rule.keys.clone()).collect();
    decided.extend(tuned.iter().flat_map(|tuned| &tuned.keys).map(|(key, _)| key.clone()));
    rules
        .extend(variation.rules(base).into_iter().filter(|rule| !decided.iter().any(|key| rule.varies(key))));
    Ok(rules)
}

/// Reads a number that must meet a condition.
///
/// # Arguments
/// * `otherwise` - the problem of a number that does not meet it
fn number_where(value: &TomlValue<'_>, is_allowed: fn(f64) -> bool, otherwise: &str) -> ReadResult<f64> {
    let number = value.number()?;
    if is_allowed(number) { Ok(number) } else { Err(value.error(otherwise)) }
}

/// Reads a number from 0 to 1.
fn fraction(value: &TomlValue<'_>, otherwise: &str) -> ReadResult<f64> {
    number_where(value, |number| (0.0..=1.0).contains(&number), otherwise)
}

/// Reads a number above 0.
fn over_zero(value: &TomlValue<'_>, otherwise: &str) -> ReadResult<f64> {
    number_where(value, |number| number > 0.0, otherwise)
}

/// Three whole numbers with points between.
fn version<'a>(value: &TomlValue<'a>) -> ReadResult<&'a str> {
    let text = value.string()?;
    let is_number = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    if text.split('.').count() == 3 && text.split('.').all(is_number) {
        return Ok(text);
    }
    Err(value.error("must be three whole numbers with points between, as \"1.0.0\""))
}

/// Year, month and day, as ISO 8601 writes them.
fn date<'a>(value: &TomlValue<'a>) -> ReadResult<&'a str> {
    let text = value.string()?;
    let is = |part: &str, digits: usize, allowed: RangeInclusive<u32>| {
        let is_number = part.len() == digits && part.bytes().all(|byte| byte.is_ascii_digit());
        is_number && part.parse().is_ok_and(|number| allowed.contains(&number))
    };
    match text.split('-').collect::<Vec<&str>>()[..] {
        [year, month, day] if is(year, 4, 1..=9999) && is(month, 2, 1..=12) && is(day, 2, 1..=31) => Ok(text),
        _ => Err(value.error("must be a day, as \"2026-11-22\"")),
    }
}

/// The questions that the data set asks.
fn questions(value: &TomlValue<'_>, classes: &[Class]) -> ReadResult<Vec<Question>> {
    distinct(value, "is asked twice", |value| {
        let question = value.choice(&Question::NAMES)?;
        let Some(obstacle) = question.obstacle(classes) else { return Ok(question) };
        Err(value.error(obstacle).with_help("add such a class, or leave the question out"))
    })
}

/// Reads a list in which nothing occurs twice.
///
/// # Arguments
/// * `twice` - the problem of an entry that another one equals
/// * `read` - reads an entry
fn distinct<T: PartialEq>(
    listed: &TomlValue<'_>,
    twice: &str,
    read: impl Fn(&TomlValue<'_>) -> ReadResult<T>,
) -> ReadResult<Vec<T>> {
    let mut entries = Vec::new();
    for value in listed.array()? {
        let entry = read(&value)?;
        if entries.contains(&entry) {
            return Err(value.error(twice));
        }
        entries.push(entry);
    }
    Ok(entries)
}

fn tuned(value: &TomlValue<'_>, reading: &mut Reading) -> ReadResult<Tuned> {
    let path = reading.path_of(value.string()?, PlanFile::NAMES[2]);
    let read = read_text(&path).and_then(|text| Ok((text, read_tuned(&path)?)));
    let (text, tuned) = read.map_err(|error| in_another_file(value, error, reading))?;
    reading.sources.push(path);
    reading.files.push(PlanFile { name: PlanFile::NAMES[2], text });
    Ok(tuned)
}

/// An error in a file that the plan names.
fn in_another_file(value: &TomlValue<'_>, error: ReadScenarioError, reading: &mut Reading) -> TomlError {
    let problem = value.error(error.to_string());
    // A name that leads nowhere is the plan's mistake.
    if !matches!(error, ReadScenarioError::Unreadable { .. }) {
        reading.elsewhere = Some(error);
    }
    problem
}

/// One condition, or an array of them.
fn conditions(value: &TomlValue<'_>) -> ReadResult<Vec<Condition>> {
    let one = |value: &TomlValue<'_>| {
        Condition::parse(value.string()?).map_err(|problem| {
            value.error(format!("the condition {problem}")).with_help(
                "write two terms of keys and numbers with a comparison between, as \"fault.start < fault.end\"",
            )
        })
    };
    if value.is_array() { value.array()?.iter().map(one).collect() } else { Ok(vec![one(value)?]) }
}
