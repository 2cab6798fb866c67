//! Single numbers of a scenario, by the names of their keys.

use std::sync::OnceLock;

use toml::{Table, Value};

use super::{Scenario, ScenarioError, Sensor};

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

fn collect(table: &Table, path: &str, numbers: &mut Vec<ScenarioNumber>) {
    for (name, value) in table {
        let key = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        match value {
            Value::Table(table) => collect(table, &key, numbers),
            Value::Array(entries) => {
                let tables = entries.iter().filter_map(Value::as_table);
                let named = tables.zip(entry_names(name, entries));
                named.for_each(|(table, entry)| collect(table, &format!("{key}{entry}"), numbers));
            }
            Value::Float(value) => numbers.push(ScenarioNumber { key, value: *value, whole: false }),
            Value::Integer(value) => numbers.push(ScenarioNumber { key, value: *value as f64, whole: true }),
            _ => {}
        }
    }
}

/// What follows the name of a list in the keys of each of its entries: `[z1]` of a wheel, `[p]` of a planetary set, `[z1-z2]` of a mesh, `[input:0]` of a bearing, and
/// the number from 0 where an entry has no name of its own; nothing of the only fault and of the only sensor.
fn entry_names(list: &str, entries: &[Value]) -> Vec<String> {
    let name = |entry: &Value| match list {
        "shaft" | "wheel" | "planetary" => entry.get("name")?.as_str().map(str::to_owned),
        "mesh" => {
            let wheels = entry.get("wheels")?.as_array()?.iter().filter_map(Value::as_str);
            Some(wheels.collect::<Vec<_>>().join("-"))
        }
        "bearing" => Some(format!("{}:{}", entry.get("shaft")?.as_str()?, entry.get("at")?.as_float()?)),
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

/// The number at a key of a scenario file.
fn number_at(table: Result<Table, ScenarioError>, key: &str) -> Option<f64> {
    match at_mut(&mut table.ok()?, key)? {
        Value::Float(number) => Some(*number),
        Value::Integer(number) => Some(*number as f64),
        _ => None,
    }
}

/// Puts numbers into a scenario file. Returns its text; none where there was nothing to put.
///
/// # Arguments
/// * `table` - the scenario file
/// * `numbers` - dotted key, as in the file, and value in the key's unit
/// * `missing` - what is said of a key at which there is no number
fn with_numbers_that(
    table: Result<Table, ScenarioError>,
    numbers: &[(&str, f64)],
    missing: impl Fn(&str, f64) -> Result<(), ScenarioError>,
) -> Result<Option<String>, ScenarioError> {
    let mut table = table?;
    let mut known = false;
    for &(key, value) in numbers {
        match at_mut(&mut table, key) {
            Some(place @ (Value::Integer(_) | Value::Float(_))) => {
                let whole = matches!(place, Value::Integer(_)) && value.fract() == 0.0;
                *place = if whole { Value::Integer(value as i64) } else { Value::Float(value) };
                known = true;
            }
            _ => missing(key, value)?,
        }
    }
    Ok(known.then(|| table.to_string()))
}

/// The error of a number at a key that a scenario does not have.
fn no_such_number(key: &str, value: f64) -> Result<(), ScenarioError> {
    Err(ScenarioError::new(key, format!("{value}"), "the scenario has no number at this key")
        .with_help("`meshtone init KIND` prints every key of a kind of fault"))
}

/// Refuses a seed that is too large for a number of a table.
fn check_seeds(seeds: impl IntoIterator<Item = (String, Option<u64>)>) -> Result<(), ScenarioError> {
    const MOST: u64 = i64::MAX as u64;
    let mut seeds = seeds.into_iter();
    if let Some((key, Some(seed))) = seeds.find(|(_, seed)| seed.is_some_and(|seed| seed > MOST)) {
        let problem =
            format!("must be at most {MOST}, where a scenario's numbers are read or set by their keys");
        return Err(ScenarioError::new(key, seed, problem).with_help("take a smaller seed"));
    }
    Ok(())
}

/// The seeds of sensors' noise, with their keys.
fn noise_seeds<'s>(
    sensors: impl ExactSizeIterator<Item = &'s Sensor>,
) -> impl Iterator<Item = (String, Option<u64>)> {
    let entries = sensors.len();
    sensors.enumerate().map(move |(index, sensor)| {
        let key = match entries {
            1 => "sensor.noise_seed".to_owned(),
            _ => format!("sensor[{index}].noise_seed"),
        };
        (key, sensor.noise_seed)
    })
}

fn parsed(text: &str) -> Result<Table, ScenarioError> {
    text.parse().map_err(|error: toml::de::Error| ScenarioError::new("", "", error.message()))
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
    /// As it was: not to be changed, since [`Self::table`] would not follow.
    scenario: Scenario,
    /// Its file, made when it is needed first.
    table: OnceLock<Result<Table, ScenarioError>>,
}

impl NumberedScenario {
    /// # Arguments
    /// * `scenario` - in which numbers will be set
    pub fn new(scenario: Scenario) -> Self {
        Self { scenario, table: OnceLock::new() }
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
        let table = self.table.get_or_init(|| self.scenario.table()).clone();
        self.scenario.changed(with_numbers_that(table, numbers, no_such_number)?)
    }
}

impl Scenario {
    /// The number at a key of the scenario file, defaults included.
    ///
    /// # Arguments
    /// * `key` - dotted, as in the file; of several faults, `fault[1].…` is the second, and so of sensors; entries of other lists by name,
    ///   `wheel[z1].teeth`, `mesh[z1-z2].module_mm`, `shaft[input].radius_mm`, `bearing[input:0].damping_ratio`
    ///
    /// None where there is no such key in this scenario, or no single number at it; where a seed is more than 2⁶³ − 1, which no
    /// number of a TOML table can be, none at any key.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let scenario = Scenario::new(GearPair::example());
    /// assert_eq!(scenario.number("rig.damping_ratio"), Some(0.05));
    /// assert_eq!(scenario.number("fault.chip_width_mm"), None); // it is healthy
    /// ```
    pub fn number(&self, key: &str) -> Option<f64> {
        number_at(self.table(), key)
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
    /// A value that is not allowed; a seed of more than 2⁶³ − 1.
    pub fn with_known_numbers(&self, numbers: &[(&str, f64)]) -> Result<Self, ScenarioError> {
        self.changed(with_numbers_that(self.table(), numbers, |_, _| Ok(()))?)
    }

    /// The scenario of a text that was made of its table; itself where nothing was changed.
    fn changed(&self, text: Option<String>) -> Result<Self, ScenarioError> {
        let Some(text) = text else { return Ok(self.clone()) };
        // A line of this text is no line that anybody has written.
        let mut changed = Self::from_toml(&text).map_err(|error| error.at_line(None))?;
        if self.wheels.iter().all(|wheel| wheel.profile_errors_mm.is_none()) {
            return Ok(changed);
        }
        // Not part of the text's table.
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
        self.numbers_with([])
    }

    /// Those of [`Self::numbers`], and those at keys of the pinion or the gear alone where both are alike, and have one key.
    ///
    /// # Arguments
    /// * `keys` - dotted, some of them such keys
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let scenario = Scenario::new(GearPair::example());
    /// let key = "gears.gear_flank_relief.amount_um";
    /// assert!(scenario.numbers_with([key]).iter().any(|number| number.key == key));
    /// assert!(scenario.numbers().iter().all(|number| number.key != key));
    /// ```
    pub fn numbers_with<'k>(&self, keys: impl IntoIterator<Item = &'k str>) -> Vec<ScenarioNumber> {
        let mut table = self.table().unwrap_or_default();
        for key in keys {
            at_mut(&mut table, key);
        }
        let mut numbers = Vec::new();
        collect(&table, "", &mut numbers);
        numbers
    }

    /// The scenario file as a table, without the profile errors given, which are large.
    ///
    /// # Errors
    /// A seed that is too large for a number of the table.
    fn table(&self) -> Result<Table, ScenarioError> {
        let own = [
            ("seed".to_owned(), Some(self.seed)),
            (self.words().wheels_seed_key.to_owned(), self.wheels_seed),
        ];
        check_seeds(own.into_iter().chain(noise_seeds(self.sensors.iter())))?;
        let mut small = self.clone();
        small.wheels.iter_mut().for_each(|wheel| wheel.profile_errors_mm = None);
        parsed(&small.to_toml())
    }
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

/// The value at a dotted key, if there is one; of a key of one wheel of a pair beside that of both, which alone is written of wheels that
/// are alike.
fn at_mut<'a>(table: &'a mut Table, key: &str) -> Option<&'a mut Value> {
    let (segment, rest) = split_key(key);
    let (name, entry) = segment.find('[').map_or((segment, ""), |from| segment.split_at(from));
    let of_each = name.strip_prefix("pinion_").or_else(|| name.strip_prefix("gear_"));
    if let Some(both @ ("flank_relief" | "tip_chamfer_mm")) = of_each
        && let Some(value) = table.get(both).cloned()
    {
        table.entry(name).or_insert(value);
    }
    let mut value = table.get_mut(name)?;
    if value.is_array() && (rest.is_some() || !entry.is_empty()) {
        let entries = value.as_array_mut()?;
        let place = entry_names(name, entries).iter().position(|own| own == entry)?;
        value = entries.get_mut(place)?;
    } else if !entry.is_empty() {
        return None;
    }
    match rest {
        Some(rest) => at_mut(value.as_table_mut()?, rest),
        None => Some(value),
    }
}
