//! Drawing the records of a plan.
//!
//! [`Sampler::record`] draws any record from its number alone: class, unit, split and values. [`Sampler::scenario`] makes its scenario.

mod compile;
mod values;

use meshtone::random::{Draws, Purpose};
use meshtone::scenario::{Scenario, ScenarioError, SensorPath};
use meshtone_toml::{ReadResult, TomlError};

use crate::expression::{Condition, Expression};
use crate::plan::{Content, Distribution, Level, Rule, RunPosition, SplitBy, Splits};
use crate::sampling::{Points, permuted};
use compile::ClassRules;
use values::Values;

/// Largest number of attempts to draw values that meet all constraints.
const MOST_ATTEMPTS: u32 = 10_000;
/// Key of the severity by which a growing damage is given.
const FAULT_SEVERITY: &str = "fault.severity";
/// Number of bits of a seed. It is exact in double precision, so that every program can read it.
const SEED_BITS: u32 = 53;

/// Keys of the noise that is added to the raw channels.
pub const NOISE_KEYS: [&str; 2] = ["noise.snr_db", "noise.level_g"];
/// Keys of the path from the simulated sensor's place to where a rig's is.
pub const PATH_KEYS: [&str; 4] = ["path.gain_db", "path.ripple_db", PLATE_HZ, STRENGTH];
const PLATE_HZ: &str = "path.plate_hz";
const STRENGTH: &str = "path.strength";
/// Beginning of the names of latent values, which occur only in terms and columns.
const LATENT: &str = "latent.";

/// Returns whether a key belongs to the plan alone and not to the scenario: noise, path, or a latent value such as `latent.load`.
///
/// # Arguments
/// * `key` - as a rule names it
pub fn is_of_plan(key: &str) -> bool {
    NOISE_KEYS.contains(&key) || PATH_KEYS.contains(&key) || key.strip_prefix(LATENT).is_some_and(is_name)
}

/// Returns whether a text may be the name of a column: letters, digits and `_`, not starting with a digit.
fn is_name(text: &str) -> bool {
    let allowed = |c: char| c.is_ascii_alphanumeric() || c == '_';
    !text.is_empty() && text.chars().all(allowed) && !text.starts_with(|c: char| c.is_ascii_digit())
}

/// Indices of the seeds of a plan's orders and designs.
const ORDER: u64 = 0;
const SPLITS: u64 = 1;
const UNITS: u64 = 2;
const MOUNTINGS: u64 = 3;
/// From this index on there are two seeds for each class.
const CLASSES: u64 = 16;

/// Draws a plan's records.
#[derive(Debug, Clone)]
pub struct Sampler<'a> {
    content: &'a Content,
    /// Rules for units and mountings. Rules that others depend on come first.
    group_rules: Vec<&'a Rule>,
    classes: Vec<ClassRules<'a>>,
    /// Number of the record after the last of each class, in the order before it is shuffled.
    ends: Vec<u64>,
    /// Number of units, or mountings, of each split.
    split_counts: Vec<u64>,
    /// Seeds of the order of all records, and of the division of units into splits.
    order_seeds: [u64; 2],
    /// Seeds of each class's design and of its order of units.
    class_seeds: Vec<[u64; 2]>,
    /// Constraints, each with the level whose values decide it.
    constraints: Vec<(Level, &'a Condition)>,
    /// The levels whose values decide each condition of each shift.
    shift_levels: Vec<Vec<Level>>,
}

/// One record of a plan, before it is simulated.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DrawnRecord {
    /// Its number.
    pub index: u64,
    /// Number of its class.
    pub class: usize,
    /// Number of its unit.
    pub unit: u64,
    /// Number of its mounting, of those of all units.
    pub mounting: u64,
    /// Its position in its unit's run to failure, if its class has runs.
    pub age: Option<RunPosition>,
    /// Number of its split.
    pub split: usize,
    /// Seed of its noise and fluctuations.
    pub seed: u64,
    /// Seed of its unit's profile errors.
    pub wheels_seed: u64,
    /// Seed of the values that belong to its mounting alone.
    pub mounting_seed: u64,
    /// Grade of its fault, 0 for healthy.
    pub severity: u8,
    /// The number that the grade was taken from.
    pub severity_measure: Option<f64>,
    /// Values of the varied keys.
    pub values: Vec<(String, f64)>,
}

impl DrawnRecord {
    /// The value of a varied key; none where the record's class does not vary it.
    pub(crate) fn value(&self, key: &str) -> Option<f64> {
        self.values.iter().find(|(varied, _)| varied == key).map(|(_, value)| *value)
    }
}

/// Position of a record among the records of its class.
struct UnitPosition {
    class: usize,
    /// Number of the record in its class.
    number: u64,
    unit: u64,
    mounting: u64,
    /// Position among the class's records of this unit, from 0.
    of_unit: u64,
    records_of_unit: u64,
}

/// The task of drawing values for a unit, a mounting or a record.
struct Drawn {
    level: Level,
    /// The class whose scenario has the values that are not drawn. All classes have those of a unit or a mounting.
    class: usize,
    points: Points,
    /// Number of the point.
    number: u64,
    /// The split that the values must suit; none for a unit whose mountings are in several splits.
    split: Option<usize>,
    /// Values that are known before.
    before: Vec<(String, f64)>,
}

impl Sampler<'_> {
    /// Number of records.
    pub fn records(&self) -> u64 {
        self.ends.last().copied().unwrap_or(0)
    }

    /// Draws a record.
    ///
    /// # Arguments
    /// * `index` - its number, below [`Self::records`]
    ///
    /// # Errors
    /// No values were found that meet the constraints: about the key in the plan of the condition that was broken most often.
    pub fn record(&self, index: u64) -> ReadResult<DrawnRecord> {
        let place = self.place(index);
        let (class, number) = (place.class, place.number);
        let [design_seed, unit_seed] = self.class_seeds[class];
        let split = self.split_of(place.unit, place.mounting);
        let mut before = self.mounting_values(&place, split)?;
        let growth = self.content.classes[class].growth.as_ref();
        let run_seed = keyed(unit_seed, Purpose::DatasetRun, place.unit);
        let age = growth.map(|growth| growth.age(run_seed, place.of_unit, place.records_of_unit));
        before.extend(age.map(|age| (FAULT_SEVERITY.to_owned(), age.severity)));
        let (design, count) = (self.content.design, self.content.classes[class].count);
        let points = Points { design, seed: design_seed, purpose: Purpose::DatasetRecord, count };
        let drawn = Drawn { level: Level::Record, class, points, number, split: Some(split), before };
        Ok(DrawnRecord {
            index,
            class,
            unit: place.unit,
            mounting: place.mounting,
            age,
            split,
            seed: keyed(self.content.seed, Purpose::DatasetSeed, index),
            wheels_seed: keyed(self.content.seed, Purpose::DatasetWheels, place.unit),
            mounting_seed: keyed(self.content.seed, Purpose::DatasetMounting, place.mounting),
            ..self.suitable(drawn)?
        })
    }

    /// Number of a record's split in [`Splits::names`]. Drawing the record takes much longer.
    ///
    /// # Arguments
    /// * `index` - number of the record, below [`Self::records`]
    pub fn split(&self, index: u64) -> usize {
        let place = self.place(index);
        self.split_of(place.unit, place.mounting)
    }

    /// Name of a split.
    ///
    /// # Arguments
    /// * `split` - its number
    pub fn split_name(&self, split: usize) -> &str {
        self.content.splits.names()[split]
    }

    /// The position of a record among the records of its class.
    fn place(&self, index: u64) -> UnitPosition {
        let of_all = permuted(index, self.records(), self.order_seeds[0]);
        let class = self.ends.iter().position(|&end| of_all < end).unwrap_or(0);
        let number = of_all - class.checked_sub(1).map_or(0, |before| self.ends[before]);
        let [_, seed] = self.class_seeds[class];
        let Content { units, mountings, .. } = *self.content;
        let count = self.content.classes[class].count;
        // Units are shuffled: points of the design at equal distances in its order lie near each other.
        let first = seed % units;
        let shuffled = first + permuted(number, count, seed);
        let unit = shuffled % units;
        // Units before the first one of the class get their first record one turn later.
        let begun = u64::from(unit < first);
        let of_unit = shuffled / units - begun;
        let records_of_unit = (first + count - 1 - unit) / units + 1 - begun;
        // A run stays in one mounting.
        let turns = if self.content.classes[class].growth.is_some() { 0 } else { of_unit };
        let turned = keyed(seed, Purpose::DatasetTurn, unit);
        let mounting = unit * mountings + (turned % mountings + turns) % mountings;
        UnitPosition { class, number, unit, mounting, of_unit, records_of_unit }
    }

    /// The scenario of a record.
    ///
    /// # Arguments
    /// * `record` - of this plan
    ///
    /// # Errors
    /// Values that the scenario does not allow.
    pub fn scenario(&self, record: &DrawnRecord) -> Result<Scenario, ScenarioError> {
        // A gain and a ripple in dB may be negative.
        for key in &PATH_KEYS[2..] {
            if let Some(value) = record.value(key).filter(|value| *value < 0.0) {
                return Err(ScenarioError::new(*key, value, "must not be negative"));
            }
        }
        let mut scenario = self.classes[record.class].base.with_values(&record.values)?;
        (scenario.seed, scenario.wheels_seed) = (record.seed, Some(record.wheels_seed));
        // What the plan puts between place and sensor stands instead of the sensor's own.
        for sensor in &mut scenario.sensors {
            if record.value(PLATE_HZ).is_some() {
                sensor.path.plate_hz = 0.0;
            }
            if record.value(STRENGTH).is_some() {
                let plate_hz = sensor.path.plate_hz;
                sensor.path = SensorPath::RIGID;
                sensor.path.plate_hz = plate_hz;
            }
        }
        Ok(scenario)
    }

    /// The split of a record by what it shares with others.
    ///
    /// # Arguments
    /// * `unit` - its unit's number
    /// * `mounting` - its mounting's number, of those of all units
    pub fn split_of(&self, unit: u64, mounting: u64) -> usize {
        let number = match self.content.splits.by {
            SplitBy::Unit => unit,
            SplitBy::Mounting => mounting,
        };
        Splits::split_of(&self.split_counts, number, self.content.divided(), self.order_seeds[1])
    }

    /// The values that the records of a mounting have in common: those of its unit, then its own.
    fn mounting_values(&self, place: &UnitPosition, split: usize) -> ReadResult<Vec<(String, f64)>> {
        let Content { design, units, ref splits, .. } = *self.content;
        let points =
            |seed, purpose, count| Points { design, seed: design_seed(self.content, seed), purpose, count };
        let of_unit = self.suitable(Drawn {
            level: Level::Unit,
            class: 0,
            points: points(UNITS, Purpose::DatasetUnit, units),
            number: place.unit,
            split: (splits.by == SplitBy::Unit).then_some(split),
            before: Vec::new(),
        })?;
        let of_mounting = Drawn {
            level: Level::Mounting,
            class: 0,
            points: points(MOUNTINGS, Purpose::DatasetMounting, self.content.all_mountings()),
            number: place.mounting,
            split: Some(split),
            before: of_unit.values,
        };
        self.suitable(of_mounting).map(|mounted| mounted.values)
    }

    /// Draws values until they meet the constraints and suit the split. Returns a record that has nothing but its values and its
    /// severity.
    fn suitable(&self, drawn: Drawn) -> ReadResult<DrawnRecord> {
        let Drawn { level, class, points, number, split, before } = drawn;
        let ClassRules { base, numbers, rules, .. } = &self.classes[class];
        let of_level = self.group_rules.iter().filter(|rule| rule.level == level).copied().collect();
        let rules = if level == Level::Record { rules } else { &of_level };
        let class = &self.content.classes[class];
        let mut obstacles = Obstacles::default();
        for attempt in 0..MOST_ATTEMPTS {
            let mut values = Values::new(base, numbers);
            before.iter().for_each(|(key, value)| values.set(key, *value));
            draw(rules, points, number, attempt, &mut values);
            let of_record = (level == Level::Record).then_some(&class.severity);
            let drawn = of_record.and_then(|severity| severity.of(&|key| values.number(key)));
            let (severity, severity_measure) = drawn.unwrap_or((u8::from(!class.faults.is_empty()), None));
            // A grade that is the same for a whole class can be held out by the class alone.
            values.severity = severity_measure.map(|_| f64::from(severity));
            if self.meets_constraints(level, &values, &mut obstacles)
                && split.is_none_or(|split| self.suits(level, split, &values, &mut obstacles))
            {
                let values = values.drawn;
                return Ok(DrawnRecord { values, severity, severity_measure, ..DrawnRecord::default() });
            }
        }
        let split = split.map(|split| self.content.splits.names()[split]);
        let of_split =
            |word: &str| split.map(|split| format!(" {word} the split {split}")).unwrap_or_default();
        Err(obstacles.error(&match level {
            Level::Record => format!("a record of the class \"{}\"{}", class.label, of_split("in")),
            Level::Unit | Level::Mounting => format!("{} {number}{}", level.name(), of_split("of")),
        }))
    }

    /// Returns whether values meet the constraints that they decide.
    fn meets_constraints(&self, level: Level, values: &Values, obstacles: &mut Obstacles) -> bool {
        let mut decided = self.constraints.iter().filter(|(decided, _)| *decided == level);
        decided.all(|(_, constraint)| {
            // A constraint on a key that the class lacks does not concern it.
            let holds = constraint.holds(&|key| values.number(key)) != Some(false);
            holds || obstacles.note("constraints".to_owned(), format!("`{constraint}`"))
        })
    }

    /// Returns whether values suit a split: they fulfil the conditions of the split, and not all conditions of another one, as far as they
    /// decide them.
    fn suits(&self, level: Level, split: usize, values: &Values, obstacles: &mut Obstacles) -> bool {
        let number = |key: &str| values.number(key);
        let own = split.checked_sub(Splits::ALIKE.len());
        self.content.splits.shifts.iter().zip(&self.shift_levels).enumerate().all(|(s, (shift, levels))| {
            let decided = shift.when.iter().zip(levels).filter(|(_, decided)| **decided <= level);
            let mut decided = decided.map(|(condition, _)| condition);
            if own == Some(s) {
                decided.all(|condition| {
                    let holds = condition.holds(&number) != Some(false);
                    holds || obstacles.note(shift_key(s), format!("`{condition}`"))
                })
            } else {
                let fulfilled = levels.iter().all(|decided| *decided <= level)
                    && decided.all(|condition| condition.holds(&number) == Some(true));
                !fulfilled
                    || obstacles.note(shift_key(s), format!("not what belongs to the split {}", shift.name))
            }
        })
    }
}

/// The seed of an order or a design of a plan.
fn design_seed(content: &Content, index: u64) -> u64 {
    Draws::new(content.seed, Purpose::DatasetDesign, index).bits()
}

fn shift_key(shift: usize) -> String {
    format!("split.shift[{shift}].when")
}

/// A seed of at most 53 bits.
fn keyed(seed: u64, purpose: Purpose, index: u64) -> u64 {
    Draws::new(seed, purpose, index).bits() >> (u64::BITS - SEED_BITS)
}

/// Draws the values of all rules.
fn draw(rules: &[&Rule], points: Points, index: u64, attempt: u32, values: &mut Values) {
    let drawn = rules.iter().filter(|rule| rule.distribution.is_drawn()).count();
    let mut coordinates = points.point(index, attempt, drawn).into_iter();
    let mut combination = combination(points, index, attempt);
    for rule in rules {
        let (mut uniform, mut place) = (0.0, 0);
        if let Distribution::Grid(rows) = &rule.distribution {
            place = (combination % rows.len() as u64) as usize;
            combination /= rows.len() as u64;
        } else if rule.distribution.is_drawn() {
            uniform = coordinates.next().unwrap_or(0.0);
        }
        for (key, value) in rule.keys.iter().zip(rule.distribution.at(uniform, place)) {
            let term = |expression: &Option<Expression>, default: f64| {
                let value = |expression: &Expression| expression.value(&|key| values.number(key));
                expression.as_ref().map_or(default, |expression| value(expression).unwrap_or(f64::NAN))
            };
            let value = term(&rule.plus, 0.0) + value * term(&rule.times, 1.0);
            values.set(key, value);
        }
    }
}

/// The number of a combination of all grids' values. The first attempts take one combination after the other; later attempts, whose
/// earlier ones broke a constraint, take any.
fn combination(points: Points, index: u64, attempt: u32) -> u64 {
    if attempt == 0 {
        return index;
    }
    let seed = Draws::new(points.seed, points.purpose, index).bits();
    Draws::new(seed, points.purpose, u64::from(attempt)).bits() >> 1
}

/// The conditions that were not met: the key of each, its words, and how often it was not met.
#[derive(Default)]
struct Obstacles(Vec<(String, String, u32)>);

impl Obstacles {
    /// Notes an obstacle; returns false.
    fn note(&mut self, key: String, what: String) -> bool {
        match self.0.iter_mut().find(|(_, other, _)| *other == what) {
            Some((_, _, count)) => *count += 1,
            None => self.0.push((key, what, 1)),
        }
        false
    }

    fn error(mut self, of: &str) -> TomlError {
        self.0.sort_by_key(|(_, _, count)| std::cmp::Reverse(*count));
        let key = self.0.first().map(|(key, _, _)| key.clone()).unwrap_or_default();
        let most = self.0.iter().take(3).map(|(_, what, count)| format!("{what} was not met by {count}"));
        let most = most.collect::<Vec<_>>().join(", ");
        let problem = format!("{MOST_ATTEMPTS} draws for {of} did not meet all conditions: {most}");
        TomlError::new(key, "", problem)
    }
}
