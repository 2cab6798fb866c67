//! Single numbers of a scenario, by the names of their keys.

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
                let tables = entries.iter().filter_map(Value::as_table).enumerate();
                tables.for_each(|(index, table)| collect(table, &format!("{key}[{index}]"), numbers));
            }
            Value::Float(value) => numbers.push(ScenarioNumber { key, value: *value, whole: false }),
            Value::Integer(value) => numbers.push(ScenarioNumber { key, value: *value as f64, whole: true }),
            _ => {}
        }
    }
}

impl Scenario {
    /// The number at a key of the scenario file, defaults included.
    ///
    /// # Arguments
    /// * `key` - dotted, as in the file; of several faults, `fault[1].…` is the second, and so of sensors
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
        match at_mut(&mut self.table().ok()?, key)? {
            Value::Float(number) => Some(*number),
            Value::Integer(number) => Some(*number as f64),
            _ => None,
        }
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
    /// assert_eq!(graded.quality.din_grade, 7);
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
        self.with_numbers_that(numbers, |key, value| {
            Err(ScenarioError::new(key, format!("{value}"), "the scenario has no number at this key")
                .with_help("`meshtone init KIND` prints every key of a kind of fault"))
        })
    }

    /// Does what [`Self::with_numbers`] does, but numbers at keys that this scenario does not have, such as another fault's, are left out.
    ///
    /// # Arguments
    /// * `numbers` - dotted key, as in the file, and value in the key's unit
    ///
    /// # Errors
    /// A value that is not allowed; a seed of more than 2⁶³ − 1.
    pub fn with_known_numbers(&self, numbers: &[(&str, f64)]) -> Result<Self, ScenarioError> {
        self.with_numbers_that(numbers, |_, _| Ok(()))
    }

    fn with_numbers_that(
        &self,
        numbers: &[(&str, f64)],
        missing: impl Fn(&str, f64) -> Result<(), ScenarioError>,
    ) -> Result<Self, ScenarioError> {
        let mut table = self.table()?;
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
        if !known {
            return Ok(self.clone());
        }
        // A line of this text is no line that anybody has written.
        let mut changed = Self::from_toml(&table.to_string()).map_err(|error| error.at_line(None))?;
        // Not part of the text's table.
        changed.quality.profile_errors.clone_from(&self.quality.profile_errors);
        Ok(changed)
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
        let mut numbers = Vec::new();
        if let Ok(table) = self.table() {
            collect(&table, "", &mut numbers);
        }
        numbers
    }

    /// The scenario file as a table, without the profile errors given, which are large.
    ///
    /// # Errors
    /// A seed that is too large for a number of the table.
    fn table(&self) -> Result<Table, ScenarioError> {
        const MOST: u64 = i64::MAX as u64;
        let of_sensor = |(index, sensor): (usize, &Sensor)| {
            let key = match self.sensors.len() {
                1 => "sensor.noise_seed".to_owned(),
                _ => format!("sensor[{index}].noise_seed"),
            };
            (key, sensor.noise_seed)
        };
        let seeds = [("seed".to_owned(), Some(self.seed)), ("quality.seed".to_owned(), self.quality.seed)];
        let mut seeds = seeds.into_iter().chain(self.sensors.iter().enumerate().map(of_sensor));
        if let Some((key, Some(seed))) = seeds.find(|(_, seed)| seed.is_some_and(|seed| seed > MOST)) {
            let problem =
                format!("must be at most {MOST}, where a scenario's numbers are read or set by their keys");
            return Err(ScenarioError::new(key, seed, problem).with_help("take a smaller seed"));
        }
        let mut small = self.clone();
        small.quality.profile_errors = None;
        small.to_toml().parse().map_err(|error: toml::de::Error| ScenarioError::new("", "", error.message()))
    }
}

/// The value at a dotted key, if there is one.
fn at_mut<'a>(table: &'a mut Table, key: &str) -> Option<&'a mut Value> {
    let (segment, rest) = key.split_once('.').map_or((key, None), |(segment, rest)| (segment, Some(rest)));
    let (name, index) = name_and_index(segment)?;
    let value = match index {
        Some(index) => table.get_mut(name)?.as_array_mut()?.get_mut(index)?,
        None => table.get_mut(name)?,
    };
    match rest {
        Some(rest) => at_mut(value.as_table_mut()?, rest),
        None => Some(value),
    }
}

/// `fault[1]` as name and index from 0.
fn name_and_index(segment: &str) -> Option<(&str, Option<usize>)> {
    match segment.split_once('[') {
        Some((name, index)) => Some((name, Some(index.strip_suffix(']')?.parse().ok()?))),
        None => Some((segment, None)),
    }
}
