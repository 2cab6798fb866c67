//! Reading a plan.

mod base;
mod class;
mod growth;
mod keep;
mod rule;
mod split;

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use meshtone_io::experiment::{Tuned, read_tuned};
use meshtone_io::scenario_file::{FileKind, ReadScenarioError, read_text};
use meshtone_toml::{ReadResult, TomlDocument, TomlError, TomlTable, TomlValue};

use super::{About, Class, Content, Plan, PlanFile, Question, Splits, check};
use crate::expression::Condition;
use crate::sampling::Design;

const MOST_UNITS: u64 = 1 << 40;
const MOST_MOUNTINGS: u64 = 1 << 20;
const LICENCE: &str = "CC-BY-4.0";
const VERSION: &str = "1.0.0";

/// Where a plan is, and what was read on the way.
struct Reading<'a> {
    directory: &'a Path,
    /// Whether it is a copy beside its data, where the files that it names have names of their own.
    is_copy: bool,
    files: Vec<PlanFile>,
    sources: Vec<PathBuf>,
    /// What is wrong in another file is told with that file's lines.
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
            Ok(plan)
        }
        (Err(_), Some(error)) => Err(error),
        (Err(error), None) => {
            Err(ReadScenarioError::invalid(FileKind::Plan, path.to_path_buf(), text, error))
        }
    }
}

impl Reading<'_> {
    /// Where a file that the plan names is.
    fn path_of(&self, name: &str, copy: &str) -> PathBuf {
        self.directory.join(if self.is_copy { copy } else { name })
    }
}

fn plan(root: &TomlTable<'_>, reading: &mut Reading) -> ReadResult<Plan> {
    let text = |key| root.optional(key).map(|value| value.string()).transpose();
    let about = About {
        title: text("title")?.unwrap_or("Spur gear vibration").to_owned(),
        description: text("description")?.unwrap_or_default().to_owned(),
        licence: text("licence")?.unwrap_or(LICENCE).to_owned(),
        version: root
            .optional("version")
            .map(|value| version(&value))
            .transpose()?
            .unwrap_or(VERSION)
            .to_owned(),
        published: root.optional("published").map(|value| date(&value)).transpose()?.map(str::to_owned),
        citation: text("citation")?.map(str::to_owned),
        questions: Vec::new(),
    };
    let seed = root.optional("seed").map(|value| value.integer(0..=u64::MAX)).transpose()?;
    let design = root.optional("design").map(|value| value.choice(&Design::NAMES)).transpose()?;
    let base = base::read(root, reading)?;
    let tuned = root.optional("tuned").map(|value| tuned(&value, reading)).transpose()?;
    let base = match &tuned {
        Some((value, tuned)) => base::tuned(&base, tuned, value)?,
        None => base,
    };
    let tuned = tuned.map(|(_, tuned)| tuned);
    let units = root.required("units", "how many units, that is pairs of wheels, share the records")?;
    let units = units.integer(1..=MOST_UNITS)?;
    let mountings = root.optional("mountings").map(|value| value.integer(1..=MOST_MOUNTINGS)).transpose()?;
    let keep = root.table_or_empty("keep")?.read(|table| keep::read(table, &base, tuned.as_ref()))?;
    let classes = class::read_all(root)?;
    let rules = rule::read_all(root)?;
    let constraints = match root.optional("constraints") {
        None => Vec::new(),
        Some(value) => conditions(&value)?,
    };
    let splits = match root.optional("split") {
        None => Splits::default(),
        Some(value) => value.table()?.read(split::read)?,
    };
    let content = Content {
        seed: seed.unwrap_or(1),
        base,
        units,
        mountings: mountings.unwrap_or(1),
        design: design.unwrap_or_default(),
        rules,
        constraints,
        classes,
        splits,
        keep,
        tuned,
    };
    check::check(&content, root)?;
    let questions =
        root.optional("questions").map(|value| questions(&value, &content.classes)).transpose()?;
    Ok(Plan {
        about: About { questions: questions.unwrap_or_default(), ..about },
        content,
        files: std::mem::take(&mut reading.files),
        sources: std::mem::take(&mut reading.sources),
    })
}

/// Three numbers with points between.
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

/// What the data set asks.
fn questions(value: &TomlValue<'_>, classes: &[Class]) -> ReadResult<Vec<Question>> {
    let one = |value: &TomlValue<'_>| {
        let question = value.choice(&Question::NAMES)?;
        match question.obstacle(classes) {
            None => Ok(question),
            Some(obstacle) => {
                Err(value.error(obstacle).with_help("add such a class, or leave the question out"))
            }
        }
    };
    let listed = value.array()?;
    let questions: Vec<Question> = listed.iter().map(one).collect::<ReadResult<_>>()?;
    match (1..questions.len()).find(|&n| questions[..n].contains(&questions[n])) {
        Some(twice) => Err(listed[twice].error("is asked twice")),
        None => Ok(questions),
    }
}

fn tuned<'a>(value: &TomlValue<'a>, reading: &mut Reading) -> ReadResult<(TomlValue<'a>, Tuned)> {
    let path = reading.path_of(value.string()?, PlanFile::NAMES[2]);
    let read = read_text(&path).and_then(|text| Ok((text, read_tuned(&path)?)));
    match read {
        Ok((text, tuned)) => {
            reading.sources.push(path);
            reading.files.push(PlanFile { name: PlanFile::NAMES[2], text });
            Ok((value.clone(), tuned))
        }
        Err(error) => Err(in_another_file(value, error, reading)),
    }
}

/// An error in a file that the plan names.
fn in_another_file(value: &TomlValue<'_>, error: ReadScenarioError, reading: &mut Reading) -> TomlError {
    let told = value.error(error.to_string());
    // A name that leads nowhere is the plan's mistake.
    if !matches!(error, ReadScenarioError::Unreadable { .. }) {
        reading.elsewhere = Some(error);
    }
    told
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
