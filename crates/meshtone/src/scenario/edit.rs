//! Single numbers of a scenario, by the names of their keys.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::OnceLock;

use toml::de::{DeTable, DeValue};
use toml::{Spanned, Value};

use super::{Scenario, ScenarioError};
use crate::wheel::WheelName;

/// A number of a scenario.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ScenarioNumber {
    /// Dotted key, as in the scenario file.
    pub key: String,
    /// Its value, in the key's unit.
    pub value: f64,
    /// Only whole numbers are allowed.
    pub whole: bool,
}

/// The keys of `[gears]` of which either wheel may have its own.
const OF_EITHER: [&str; 2] = ["flank_relief", "tip_chamfer_mm"];

/// The line before the keys of a pair's teeth.
const GEARS: &str = "[gears]\n";

/// The text of a scenario file, and the numbers that stand in it.
#[derive(Debug, Clone)]
struct NumberedText {
    text: String,
    places: Vec<NumberPlace>,
}

/// Where a number stands.
#[derive(Debug, Clone)]
struct NumberPlace {
    number: ScenarioNumber,
    /// (bytes) Of the text; empty where a line is put in.
    at: Range<usize>,
    /// Whether it is one of the numbers of a list, as those of a speed profile are.
    is_of_list: bool,
    /// The key on the line that is put in, of a wheel of a pair whose mate has the same value under a key of both.
    line: Option<String>,
}

impl NumberPlace {
    /// The places of the same number of either wheel alone, where this is one that both wheels of a pair have.
    ///
    /// # Arguments
    /// * `at` - (bytes) where the first line of `[gears]` starts
    fn of_each_wheel(&self, at: usize) -> Vec<Self> {
        let shared = self.number.key.strip_prefix("gears.");
        let shared = shared.filter(|shared| OF_EITHER.contains(&split_key(shared).0));
        let place = |(wheel, shared): (WheelName, &str)| {
            let line = format!("{}_{shared}", wheel.name());
            let number = ScenarioNumber { key: format!("gears.{line}"), ..self.number.clone() };
            Self { number, at: at..at, is_of_list: self.is_of_list, line: Some(line) }
        };
        shared
            .into_iter()
            .flat_map(|shared| WheelName::BOTH.map(|wheel| (wheel, shared)))
            .map(place)
            .collect()
    }
}

impl NumberedText {
    /// The file of a scenario, without the profile errors given, which are large.
    fn new(scenario: &Scenario) -> Result<Self, ScenarioError> {
        let mut small = scenario.clone();
        small.wheels.iter_mut().for_each(|wheel| wheel.profile_errors_mm = None);
        let (text, mut places) = (small.to_toml(), Vec::new());
        let root = DeTable::parse(&text).map_err(|error| ScenarioError::new("", "", error.message()))?;
        places_in(root.get_ref(), "", &mut places);
        if let Some(header) = text.find(GEARS) {
            let own = places.iter().flat_map(|place| place.of_each_wheel(header + GEARS.len()));
            places.extend(own.collect::<Vec<_>>());
        }
        Ok(Self { text, places })
    }

    fn place(&self, key: &str) -> Option<&NumberPlace> {
        self.places.iter().find(|place| place.number.key == key)
    }

    /// The text with other numbers; none where there was nothing to put.
    ///
    /// # Arguments
    /// * `numbers` - dotted key, as in the file, and value in the key's unit
    /// * `missing` - what is said of a key at which there is no number
    fn with_numbers(
        &self,
        numbers: &[(&str, f64)],
        missing: impl Fn(&str, f64) -> Result<(), ScenarioError>,
    ) -> Result<Option<String>, ScenarioError> {
        let mut changes = BTreeMap::new();
        for &(key, value) in numbers {
            let Some(NumberPlace { number, at, line, .. }) = self.place(key) else {
                missing(key, value)?;
                continue;
            };
            let is_whole = number.whole && value.fract() == 0.0;
            // Not −0, which is no count.
            let written =
                if is_whole { format!("{:.0}", value + 0.0) } else { Value::Float(value).to_string() };
            let written = match line {
                Some(own) => format!("{own} = {written}\n"),
                None => written,
            };
            changes.insert((at.start, key), (at.clone(), written));
        }
        let mut text = self.text.clone();
        // From the end on, so that what stands before keeps its place.
        changes.values().rev().for_each(|(at, written)| text.replace_range(at.clone(), written));
        Ok((!changes.is_empty()).then_some(text))
    }
}

/// Finds all numbers of a table.
///
/// # Arguments
/// * `table` - of a scenario file
/// * `path` - its dotted key, empty of the whole file
/// * `places` - those that are found are added here
fn places_in(table: &DeTable<'_>, path: &str, places: &mut Vec<NumberPlace>) {
    for (name, value) in table {
        let name = name.get_ref();
        let key = if path.is_empty() { name.to_string() } else { format!("{path}.{name}") };
        match value.get_ref() {
            DeValue::Table(table) => places_in(table, &key, places),
            DeValue::Array(entries) => {
                for (entry, own) in entries.iter().zip(entry_names(name, entries)) {
                    match entry.get_ref() {
                        DeValue::Table(table) => places_in(table, &format!("{key}{own}"), places),
                        _ => places.extend(number_of(entry, format!("{key}{own}"), true)),
                    }
                }
            }
            _ => places.extend(number_of(value, key, false)),
        }
    }
}

/// A value that is a number, with its place.
fn number_of(value: &Spanned<DeValue<'_>>, key: String, is_of_list: bool) -> Option<NumberPlace> {
    let (written, whole) = match value.get_ref() {
        DeValue::Integer(integer) => (integer.as_str(), true),
        DeValue::Float(float) => (float.as_str(), false),
        _ => return None,
    };
    let number = ScenarioNumber { key, value: written.parse().ok()?, whole };
    Some(NumberPlace { number, at: value.span(), is_of_list, line: None })
}

/// What follows the name of a list in the keys of each of its entries: `[z1]` of a wheel, `[p]` of a planetary set, `[z1-z2]` of a mesh, `[input:0]` of a bearing, and
/// the number from 0 where an entry has no name of its own; nothing of the only fault and of the only sensor.
fn entry_names(list: &str, entries: &[Spanned<DeValue<'_>>]) -> Vec<String> {
    let of = |entry: &Spanned<DeValue<'_>>, key: &str| {
        Some(entry.get_ref().get(key)?.get_ref().as_str()?.to_owned())
    };
    let name = |entry: &Spanned<DeValue<'_>>| match list {
        "shaft" | "wheel" | "planetary" => of(entry, "name"),
        "mesh" => {
            let wheels = entry.get_ref().get("wheels")?.get_ref().as_array()?;
            let wheels = wheels.iter().filter_map(|wheel| wheel.get_ref().as_str());
            Some(wheels.collect::<Vec<_>>().join("-"))
        }
        "bearing" => {
            let at: f64 = entry.get_ref().get("at")?.get_ref().as_float()?.as_str().parse().ok()?;
            Some(format!("{}:{at}", of(entry, "shaft")?))
        }
        _ => None,
    };
    if entries.len() == 1 && ["fault", "sensor"].contains(&list) {
        return vec![String::new()];
    }
    let names: Vec<Option<String>> = entries.iter().map(name).collect();
    names_or_numbers(&names).into_iter().map(|name| format!("[{name}]")).collect()
}

/// The names of the entries of a list in keys: each entry's own name where no other entry has it, or else its number from 0.
///
/// # Arguments
/// * `names` - the entries' own names
///
/// ```
/// let own = ["input:0", "input:0", "input:1"].map(|name| Some(name.to_owned()));
/// assert_eq!(meshtone::scenario::names_or_numbers(&own), ["0", "1", "input:1"]);
/// ```
pub fn names_or_numbers(names: &[Option<String>]) -> Vec<String> {
    let is_only = |name: &Option<String>| names.iter().filter(|other| *other == name).count() == 1;
    let shown = |(number, name): (usize, &Option<String>)| match name {
        Some(own) if is_only(name) => own.clone(),
        _ => number.to_string(),
    };
    names.iter().enumerate().map(shown).collect()
}

/// The error of a number at a key that a scenario does not have.
fn no_such_number(key: &str, value: f64) -> Result<(), ScenarioError> {
    Err(ScenarioError::new(key, format!("{value}"), "the scenario has no number at this key")
        .with_help(
            "`meshtone init KIND --all` prints every key of a kind of fault; where the wheels of a pair differ in a value, each has its own key",
        ))
}

/// A scenario in which numbers are set many times.
///
/// ```
/// use meshtone::scenario::{GearPair, NumberedScenario, Scenario};
///
/// let numbered = NumberedScenario::new(Scenario::new(GearPair::example()));
/// let at = |speed_hz: f64| numbered.with_numbers(&[("operation.pinion_speed_hz", speed_hz)]);
/// assert_eq!([at(20.0)?, at(30.0)?].map(|scenario| scenario.operation.pinion_speed_hz), [20.0, 30.0]);
/// assert_eq!(at(20.0)?, numbered.scenario().with_number("operation.pinion_speed_hz", 20.0)?);
/// # Ok::<(), meshtone::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone)]
pub struct NumberedScenario {
    /// As it was: not to be changed, since [`Self::text`] would not follow.
    scenario: Scenario,
    /// Its file, made when it is needed first.
    text: OnceLock<Result<NumberedText, ScenarioError>>,
}

impl NumberedScenario {
    /// # Arguments
    /// * `scenario` - in which numbers will be set
    pub fn new(scenario: Scenario) -> Self {
        Self { scenario, text: OnceLock::new() }
    }

    /// The scenario without the numbers.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Does what [`Scenario::with_numbers`] does.
    ///
    /// # Arguments
    /// * `numbers` - dotted key, as in the file, and value in the key's unit
    ///
    /// # Errors
    /// Those of [`Scenario::with_numbers`].
    pub fn with_numbers(&self, numbers: &[(&str, f64)]) -> Result<Scenario, ScenarioError> {
        let text =
            self.text.get_or_init(|| NumberedText::new(&self.scenario)).as_ref().map_err(Clone::clone)?;
        self.scenario.changed(text.with_numbers(numbers, no_such_number)?)
    }
}

impl Scenario {
    /// The number at a key of the scenario file, defaults included.
    ///
    /// # Arguments
    /// * `key` - dotted, as in the file; of several faults, `fault[1].…` is the second, and so of sensors; entries of other lists by name,
    ///   `wheel[z1].teeth`, `mesh[z1-z2].module_mm`, `shaft[input].radius_mm`, `bearing[input:0].damping_ratio`
    ///
    /// None where there is no such key in this scenario, or no single number at it.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let scenario = Scenario::new(GearPair::example());
    /// assert_eq!(scenario.number("rig.damping_ratio"), Some(0.05));
    /// assert_eq!(scenario.number("fault.chip_width_mm"), None); // it is healthy
    /// ```
    pub fn number(&self, key: &str) -> Option<f64> {
        Some(NumberedText::new(self).ok()?.place(key)?.number.value)
    }

    /// Returns the scenario with another number at a key of the scenario file.
    ///
    /// # Arguments
    /// * `key` - dotted, as in the file
    /// * `value` - in the key's unit
    ///
    /// # Errors
    /// A key that the scenario does not have, a value that is not allowed there, as for the scenario file.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let scenario = Scenario::new(GearPair::example());
    /// let graded = scenario.with_number("quality.din_grade", 7.0)?;
    /// assert_eq!(graded.wheels[1].din_grade, 7);
    /// let error = scenario.with_number("quality.din_grade", 13.0).unwrap_err();
    /// assert_eq!(error.key, "quality.din_grade");
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn with_number(&self, key: &str, value: f64) -> Result<Self, ScenarioError> {
        self.with_numbers(&[(key, value)])
    }

    /// Returns the scenario with other numbers at some keys of the scenario file. All are set before anything is checked, so that
    /// numbers may be allowed together that are not alone.
    ///
    /// # Arguments
    /// * `numbers` - dotted key, as in the file, and value in the key's unit
    ///
    /// # Errors
    /// A key that the scenario does not have, a value that is not allowed there, as for the scenario file.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let line = "[fault]\nkind = \"tooth-destruction\"\nstart = 0.1\nend = 0.3";
    /// let gears = "[gears]\nmodule_mm = 3.0\npinion_teeth = 17\ngear_teeth = 38\nface_width_mm = 15.0";
    /// let operation = "[operation]\npinion_speed_hz = 40.0\nbrake_torque_nm = 10.0";
    /// let scenario = Scenario::from_toml(&[gears, operation, line].join("\n"))?;
    /// assert!(scenario.with_number("fault.start", 0.5).is_err()); // beyond the end
    /// let later = scenario.with_numbers(&[("fault.start", 0.5), ("fault.end", 0.7)])?;
    /// assert_eq!(later.number("fault.start"), Some(0.5));
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn with_numbers(&self, numbers: &[(&str, f64)]) -> Result<Self, ScenarioError> {
        NumberedScenario::new(self.clone()).with_numbers(numbers)
    }

    /// Does what [`Self::with_numbers`] does, but numbers at keys that this scenario does not have, such as another fault's, are left out.
    ///
    /// # Arguments
    /// * `numbers` - dotted key, as in the file, and value in the key's unit
    ///
    /// # Errors
    /// A value that is not allowed.
    pub fn with_known_numbers(&self, numbers: &[(&str, f64)]) -> Result<Self, ScenarioError> {
        self.changed(NumberedText::new(self)?.with_numbers(numbers, |_, _| Ok(()))?)
    }

    /// The scenario of a text that was made of its file; itself where nothing was changed.
    fn changed(&self, text: Option<String>) -> Result<Self, ScenarioError> {
        let Some(text) = text else { return Ok(self.clone()) };
        // A line of this text is no line that anybody has written.
        let mut changed = Self::from_toml(&text).map_err(|error| error.at_line(None))?;
        if self.wheels.iter().all(|wheel| wheel.profile_errors_mm.is_none()) {
            return Ok(changed);
        }
        // Not part of the text.
        for (wheel, before) in changed.wheels.iter_mut().zip(&self.wheels) {
            wheel.profile_errors_mm.clone_from(&before.profile_errors_mm);
        }
        changed.validate().map(|_| changed)
    }

    /// Every key of the scenario file at which this scenario has a single number, defaults included.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let numbers = Scenario::new(GearPair::example()).numbers();
    /// let teeth = numbers.iter().find(|number| number.key == "gears.pinion_teeth").unwrap();
    /// assert!(teeth.whole && teeth.value == 17.0);
    /// ```
    pub fn numbers(&self) -> Vec<ScenarioNumber> {
        self.single_numbers(|place| place.line.is_none())
    }

    /// Every key at which a single number can be set: those of [`Self::numbers`], and of a number that both wheels of a pair have, such
    /// as a chamfer, those of each wheel alone.
    pub fn settable_numbers(&self) -> Vec<ScenarioNumber> {
        self.single_numbers(|_| true)
    }

    fn single_numbers(&self, is_wanted: fn(&NumberPlace) -> bool) -> Vec<ScenarioNumber> {
        let places = NumberedText::new(self).map_or_else(|_| Vec::new(), |text| text.places);
        let single = places.into_iter().filter(|place| !place.is_of_list && is_wanted(place));
        single.map(|place| place.number).collect()
    }
}

/// The key of both wheels of a pair of which a key of one of them is a part: `gears.tip_chamfer_mm` of `gears.pinion_tip_chamfer_mm`.
///
/// # Arguments
/// * `key` - dotted
///
/// ```
/// use meshtone::scenario::key_of_both_wheels;
///
/// assert_eq!(key_of_both_wheels("gears.gear_flank_relief.amount_um").as_deref(), Some("gears.flank_relief.amount_um"));
/// assert_eq!(key_of_both_wheels("gears.pinion_teeth"), None);
/// ```
pub fn key_of_both_wheels(key: &str) -> Option<String> {
    let of_gears = key.strip_prefix("gears.")?;
    let shared =
        WheelName::BOTH.iter().find_map(|wheel| of_gears.strip_prefix(wheel.name())?.strip_prefix('_'))?;
    OF_EITHER.contains(&split_key(shared).0).then(|| format!("gears.{shared}"))
}

/// The first segment of a dotted key, and the rest. A name in brackets may have dots.
///
/// # Arguments
/// * `key` - such as `bearing[input:0.5].damping_ratio`
///
/// ```
/// use meshtone::scenario::split_key;
///
/// assert_eq!(split_key("bearing[input:0.5].damping_ratio"), ("bearing[input:0.5]", Some("damping_ratio")));
/// assert_eq!(split_key("seed"), ("seed", None));
/// ```
pub fn split_key(key: &str) -> (&str, Option<&str>) {
    let bracket = key.find('[').filter(|&from| key.find('.').is_none_or(|dot| from < dot));
    let inside = bracket.and_then(|from| Some(from + key[from..].find(']')?)).unwrap_or(0);
    match key[inside..].find('.') {
        Some(dot) => (&key[..inside + dot], Some(&key[inside + dot + 1..])),
        None => (key, None),
    }
}
