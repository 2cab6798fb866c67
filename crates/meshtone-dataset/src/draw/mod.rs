//! What a plan's records are.
//!
//! [`Sampler::record`] gives any record by its number alone: its class, its unit, its split, its values, its scenario.

mod compile;
mod values;

use meshtone::random::{Draws, Purpose};
use meshtone::scenario::{Scenario, ScenarioError};
use meshtone_toml::ReadResult;

use crate::expression::Condition;
use crate::plan::{Age, Content, Distribution, Level, Rule, SplitBy};
use crate::sampling::{Points, permuted};
use compile::ClassRules;
use values::{Values, of_scenario};

/// How often values are drawn anew until all constraints are met.
const MOST_ATTEMPTS: u32 = 10_000;
/// What a growing damage is given by.
const FAULT_SEVERITY: &str = "fault.severity";
/// Seeds are exact in double precision, so that every program can read them.
const SEED_BITS: u32 = 53;

/// Keys of the noise that is added to the raw channels.
pub const NOISE_KEYS: [&str; 2] = ["noise.snr_db", "noise.level_g"];
/// Keys of the path from the simulated sensor's place to where a rig's is.
pub const PATH_KEYS: [&str; 2] = ["path.gain_db", "path.ripple_db"];
/// What names of one's own begin with: numbers that stand in terms and columns alone.
const LATENT: &str = "latent.";

/// Whether a key is of the plan alone: noise, path, or a name of one's own as `latent.load`. No scenario has it.
///
/// # Arguments
/// * `key` - as a rule names it
pub fn is_of_plan(key: &str) -> bool {
    NOISE_KEYS.contains(&key) || PATH_KEYS.contains(&key) || key.strip_prefix(LATENT).is_some_and(is_name)
}

/// Letters, digits and `_`, the first no digit: what a column may be called.
fn is_name(text: &str) -> bool {
    let allowed = |c: char| c.is_ascii_alphanumeric() || c == '_';
    !text.is_empty() && text.chars().all(allowed) && !text.starts_with(|c: char| c.is_ascii_digit())
}

/// What the seeds of a plan's orders and designs are for; the number is the index of their draw.
#[derive(Clone, Copy)]
enum SeedOf {
    Order = 0,
    Splits = 1,
    Units = 2,
    Mountings = 3,
    /// And those after it, two for each class.
    Classes = 16,
}

/// Draws a plan's records.
#[derive(Debug, Clone)]
pub struct Sampler<'a> {
    content: &'a Content,
    unit_rules: Vec<&'a Rule>,
    mounting_rules: Vec<&'a Rule>,
    classes: Vec<ClassRules<'a>>,
    /// Number of the record after the last of each class, in the order before it is shuffled.
    ends: Vec<u64>,
    /// Constraints that a unit alone decides, or a mounting.
    group_constraints: Vec<(Level, &'a Condition)>,
    /// What decides each of the shifts' conditions.
    shift_levels: Vec<Vec<Level>>,
}

/// One record of a plan, before it is simulated.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnRecord {
    /// Its number.
    pub index: u64,
    /// Number of its class.
    pub class: usize,
    /// Number of its unit.
    pub unit: u64,
    /// Number of its mounting, of those of all units.
    pub mounting: u64,
    /// Where it is in its unit's run to failure, where its class has one.
    pub age: Option<Age>,
    /// Number of its split.
    pub split: usize,
    /// Seed of its noise and fluctuations.
    pub seed: u64,
    /// Seed of its unit's profile errors.
    pub wheels_seed: u64,
    /// Seed of what its mounting has of its own.
    pub mounting_seed: u64,
    /// Grade of its fault, 0 for healthy.
    pub severity: u8,
    /// What the grade was taken from.
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

/// A record whose values could not be drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawError {
    /// Key of the plan that stands in the way.
    pub key: String,
    /// What could not be met.
    pub problem: String,
}

/// What a record has in common with others.
struct Group {
    split: usize,
    values: Vec<(String, f64)>,
}

/// Where a record is among its class's.
struct Place {
    unit: u64,
    mounting: u64,
    /// Of the class's records of this unit, from 0.
    of_unit: u64,
    records_of_unit: u64,
}

/// Values of a record that suit its split.
struct Suitable {
    values: Vec<(String, f64)>,
    severity: u8,
    severity_measure: Option<f64>,
}

impl<'a> Sampler<'a> {
    /// Prepares a plan.
    ///
    /// # Arguments
    /// * `content` - of the plan
    ///
    /// # Errors
    /// Rules that contradict each other or the scenario, by their keys in the plan.
    pub fn new(content: &'a Content) -> ReadResult<Self> {
        compile::sampler(content)
    }

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
    /// Constraints that were not met.
    pub fn record(&self, index: u64) -> Result<DrawnRecord, DrawError> {
        let place = permuted(index, self.records(), self.seed(SeedOf::Order as u64));
        let class = self.ends.iter().position(|&end| place < end).unwrap_or(0);
        let start = class.checked_sub(1).map_or(0, |before| self.ends[before]);
        let number = place - start;
        let [design_seed, unit_seed] =
            [0, 1].map(|which| self.seed(SeedOf::Classes as u64 + 2 * class as u64 + which));
        let place = self.place(class, number, unit_seed);
        let group = self.group(place.unit, place.mounting)?;
        let seed = keyed(self.content.seed, Purpose::DatasetSeed, index);
        let growth = self.content.classes[class].growth.as_ref();
        let run_seed = keyed(unit_seed, Purpose::DatasetRun, place.unit);
        let age = growth.map(|growth| growth.age(run_seed, place.of_unit, place.records_of_unit));
        let Suitable { values, severity, severity_measure } =
            self.record_values(class, number, design_seed, &group, age)?;
        Ok(DrawnRecord {
            index,
            class,
            unit: place.unit,
            mounting: place.mounting,
            age,
            split: group.split,
            seed,
            wheels_seed: keyed(self.content.seed, Purpose::DatasetWheels, place.unit),
            mounting_seed: keyed(self.content.seed, Purpose::DatasetMounting, place.mounting),
            severity,
            severity_measure,
            values,
        })
    }

    /// Where a record is among its class's.
    ///
    /// # Arguments
    /// * `class` - its class
    /// * `number` - its number in the class
    /// * `seed` - of the class's units
    fn place(&self, class: usize, number: u64, seed: u64) -> Place {
        let Content { units, mountings, .. } = *self.content;
        let count = self.content.classes[class].count;
        // Units are shuffled against the design, whose points of equal distance lie near each other.
        let first = seed % units;
        let shuffled = first + permuted(number, count, seed);
        let unit = shuffled % units;
        // Those before the class's first one have their first record a turn later.
        let begun = u64::from(unit < first);
        let of_unit = shuffled / units - begun;
        let records_of_unit = (first + count - 1 - unit) / units + 1 - begun;
        // A run is not taken apart.
        let turns = if self.content.classes[class].growth.is_some() { 0 } else { of_unit };
        let turned = keyed(seed, Purpose::DatasetTurn, unit);
        let mounting = unit * mountings + (turned % mountings + turns) % mountings;
        Place { unit, mounting, of_unit, records_of_unit }
    }

    /// The scenario of a record.
    ///
    /// # Arguments
    /// * `record` - of this plan
    ///
    /// # Errors
    /// Values that the scenario does not allow.
    pub fn scenario(&self, record: &DrawnRecord) -> Result<Scenario, ScenarioError> {
        let mut scenario = self.classes[record.class].base.with_numbers(&of_scenario(&record.values))?;
        scenario.seed = record.seed;
        scenario.quality.seed = Some(record.wheels_seed);
        Ok(scenario)
    }

    /// The split of a record by what it shares with others.
    ///
    /// # Arguments
    /// * `unit` - its unit's number
    /// * `mounting` - its mounting's number, of those of all units
    pub fn split_of(&self, unit: u64, mounting: u64) -> usize {
        let Content { splits, units, mountings, .. } = self.content;
        let seed = self.seed(SeedOf::Splits as u64);
        match splits.by {
            SplitBy::Unit => splits.split_of(unit, *units, seed),
            SplitBy::Mounting => splits.split_of(mounting, units * mountings, seed),
        }
    }

    fn seed(&self, index: u64) -> u64 {
        Draws::new(self.content.seed, Purpose::DatasetDesign, index).bits()
    }

    /// What the records of a mounting have in common.
    fn group(&self, unit: u64, mounting: u64) -> Result<Group, DrawError> {
        let Content { design, units, mountings, ref splits, .. } = *self.content;
        let split = self.split_of(unit, mounting);
        let of_unit = match splits.by {
            SplitBy::Unit => Some(split),
            SplitBy::Mounting => None,
        };
        let seed = self.seed(SeedOf::Units as u64);
        let points = Points { design, seed, purpose: Purpose::DatasetUnit, count: units };
        let values = self.group_values(Level::Unit, points, unit, Vec::new(), of_unit)?;
        let seed = self.seed(SeedOf::Mountings as u64);
        let count = units * mountings;
        let points = Points { design, seed, purpose: Purpose::DatasetMounting, count };
        let values = self.group_values(Level::Mounting, points, mounting, values, Some(split))?;
        Ok(Group { split, values })
    }

    /// The values of a unit or a mounting, after those of what it belongs to.
    ///
    /// # Arguments
    /// * `split` - its own; none where its records are in several
    fn group_values(
        &self,
        level: Level,
        points: Points,
        number: u64,
        before: Vec<(String, f64)>,
        split: Option<usize>,
    ) -> Result<Vec<(String, f64)>, DrawError> {
        let rules = if level == Level::Unit { &self.unit_rules } else { &self.mounting_rules };
        let constraints: Vec<&Condition> = self
            .group_constraints
            .iter()
            .filter(|(decided, _)| *decided == level)
            .map(|(_, condition)| *condition)
            .collect();
        let any = &self.classes[0];
        let mut obstacles = Obstacles::default();
        for attempt in 0..MOST_ATTEMPTS {
            let mut values = Values::new(&any.base, &any.numbers);
            before.iter().for_each(|(key, value)| values.set(key, *value));
            draw(rules, points, number, attempt, &mut values);
            let met = self.meets(&constraints, &values, &mut obstacles)
                && split.is_none_or(|split| self.group_suits(level, split, &values, &mut obstacles));
            if met {
                return Ok(values.drawn());
            }
        }
        let names = self.content.splits.names();
        let of_split = split.map(|split| format!(" of the split {}", names[split])).unwrap_or_default();
        Err(obstacles.error(&format!("{} {number}{of_split}", level.name())))
    }

    /// Whether a unit or a mounting of a split, which is a shift or not, may have these values.
    fn group_suits(&self, level: Level, split: usize, values: &Values, obstacles: &mut Obstacles) -> bool {
        let number = |key: &str| values.number(key);
        let own = self.content.splits.shift(split);
        self.content.splits.shifts.iter().zip(&self.shift_levels).enumerate().all(|(s, (shift, levels))| {
            let mut decided = shift.when.iter().zip(levels).filter(|(_, decided)| **decided <= level);
            if own == Some(s) {
                decided.all(|(condition, _)| {
                    let holds = condition.holds(&number) != Some(false);
                    holds || obstacles.note(shift_key(s), format!("`{condition}`"))
                })
            } else {
                let by_group_alone = levels.iter().all(|decided| *decided <= level);
                let fulfilled =
                    by_group_alone && decided.all(|(condition, _)| condition.holds(&number) == Some(true));
                !fulfilled
                    || obstacles.note(shift_key(s), format!("not what belongs to the split {}", shift.name))
            }
        })
    }

    fn record_values(
        &self,
        class: usize,
        number: u64,
        seed: u64,
        group: &Group,
        age: Option<Age>,
    ) -> Result<Suitable, DrawError> {
        let rules = &self.classes[class];
        let plan = &self.content.classes[class];
        let points =
            Points { design: self.content.design, seed, purpose: Purpose::DatasetRecord, count: plan.count };
        let mut obstacles = Obstacles::default();
        for attempt in 0..MOST_ATTEMPTS {
            let mut values = Values::new(&rules.base, &rules.numbers);
            group.values.iter().for_each(|(key, value)| values.set(key, *value));
            if let Some(age) = age {
                values.set(FAULT_SEVERITY, age.severity);
            }
            draw(&rules.rules, points, number, attempt, &mut values);
            let severity = plan.severity.of(&|key| values.number(key));
            let (grade, measure) = severity.unwrap_or((u8::from(!plan.faults.is_empty()), None));
            // What is the same for a whole class can be held out by its class alone.
            if measure.is_some() {
                values.set_severity(grade);
            }
            let met = self.meets(&rules.constraints, &values, &mut obstacles)
                && self.record_suits(self.content.splits.shift(group.split), &values, &mut obstacles);
            if met {
                return Ok(Suitable { values: values.drawn(), severity: grade, severity_measure: measure });
            }
        }
        let split = self.content.splits.names()[group.split];
        Err(obstacles.error(&format!("a record of the class \"{}\" in the split {split}", plan.label)))
    }

    fn meets(&self, constraints: &[&Condition], values: &Values, obstacles: &mut Obstacles) -> bool {
        constraints.iter().all(|constraint| {
            // A constraint on a key that the class lacks does not concern it.
            let holds = constraint.holds(&|key| values.number(key)) != Some(false);
            holds || obstacles.note("constraints".to_owned(), format!("`{constraint}`"))
        })
    }

    fn record_suits(&self, own: Option<usize>, values: &Values, obstacles: &mut Obstacles) -> bool {
        let number = |key: &str| values.number(key);
        self.content.splits.shifts.iter().enumerate().all(|(s, shift)| {
            if own == Some(s) {
                shift.when.iter().all(|condition| {
                    let holds = condition.holds(&number) != Some(false);
                    holds || obstacles.note(shift_key(s), format!("`{condition}`"))
                })
            } else {
                let fulfilled = shift.when.iter().all(|condition| condition.holds(&number) == Some(true));
                !fulfilled
                    || obstacles.note(shift_key(s), format!("not what belongs to the split {}", shift.name))
            }
        })
    }
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
    let mut combination = combination(rules, points, index, attempt);
    for rule in rules {
        let (uniform, mut place) = (if rule.distribution.is_drawn() { coordinates.next() } else { None }, 0);
        if let Distribution::Grid(rows) = &rule.distribution {
            place = (combination % rows.len() as u64) as usize;
            combination /= rows.len() as u64;
        }
        for (key, value) in rule.keys.iter().zip(rule.distribution.at(uniform.unwrap_or(0.0), place)) {
            let term = |expression: &Option<crate::expression::Expression>, default: f64| {
                expression
                    .as_ref()
                    .map_or(default, |e| e.value(&|key| values.number(key)).unwrap_or(f64::NAN))
            };
            let value = term(&rule.plus, 0.0) + value * term(&rule.times, 1.0);
            values.set(key, value);
        }
    }
}

/// Which combination of all grids' values: one after the other, and where that one broke a constraint any other.
fn combination(rules: &[&Rule], points: Points, index: u64, attempt: u32) -> u64 {
    if attempt == 0 {
        return index;
    }
    let grids = rules.iter().any(|rule| matches!(rule.distribution, Distribution::Grid(_)));
    if !grids {
        return 0;
    }
    let seed = Draws::new(points.seed, points.purpose, index).bits();
    Draws::new(seed, points.purpose, u64::from(attempt)).bits() >> 1
}

/// What stood in the way, and how often.
#[derive(Default)]
struct Obstacles {
    counted: Vec<(String, String, u32)>,
}

impl Obstacles {
    /// Notes an obstacle; returns false.
    fn note(&mut self, key: String, what: String) -> bool {
        match self.counted.iter_mut().find(|(_, other, _)| *other == what) {
            Some((_, _, count)) => *count += 1,
            None => self.counted.push((key, what, 1)),
        }
        false
    }

    fn error(mut self, of: &str) -> DrawError {
        self.counted.sort_by_key(|(_, _, count)| std::cmp::Reverse(*count));
        let key = self.counted.first().map(|(key, _, _)| key.clone()).unwrap_or_default();
        let list: Vec<String> = self
            .counted
            .iter()
            .take(3)
            .map(|(_, what, count)| format!("{what} was not met by {count}"))
            .collect();
        let problem =
            format!("{MOST_ATTEMPTS} draws for {of} met not all that is asked: {}", list.join(", "));
        DrawError { key, problem }
    }
}
