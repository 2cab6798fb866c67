//! What a plan's records are.
//!
//! [`Sampler::record`] gives any record by its number alone: its class, its unit, its split, its values, its scenario.

mod compile;
mod values;

use meshtone::random::{Draws, Purpose};
use meshtone::scenario::{Scenario, ScenarioError};
use meshtone_toml::ReadResult;

use crate::expression::Condition;
use crate::plan::{Content, Distribution, Rule};
use crate::sampling::{Points, permuted};
use compile::ClassRules;
use values::{Values, of_scenario};

/// How often values are drawn anew until all constraints are met.
const MOST_ATTEMPTS: u32 = 10_000;
/// Seeds are exact in double precision, so that every program can read them.
const SEED_BITS: u32 = 53;

/// Keys of the noise that is added to the raw channels.
pub const NOISE_KEYS: [&str; 2] = ["noise.snr_db", "noise.level_g"];

/// What the seeds of a plan's orders and designs are for; the number is the index of their draw.
#[derive(Clone, Copy)]
enum SeedOf {
    Order = 0,
    Splits = 1,
    Units = 2,
    /// And those after it, two for each class.
    Classes = 16,
}

/// Draws a plan's records.
#[derive(Debug, Clone)]
pub struct Sampler<'a> {
    content: &'a Content,
    unit_rules: Vec<&'a Rule>,
    classes: Vec<ClassRules<'a>>,
    /// Number of the record after the last of each class, in the order before it is shuffled.
    ends: Vec<u64>,
    /// Of the constraints and the shifts' conditions, those that a unit alone decides.
    unit_constraints: Vec<&'a Condition>,
    shift_levels: Vec<Vec<bool>>,
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
    /// Number of its split.
    pub split: usize,
    /// Seed of its noise and fluctuations.
    pub seed: u64,
    /// Seed of its unit's profile errors.
    pub wheels_seed: u64,
    /// Grade of its fault, 0 for healthy.
    pub severity: u8,
    /// What the grade was taken from.
    pub severity_measure: Option<f64>,
    /// Values of the varied keys.
    pub values: Vec<(String, f64)>,
}

/// A record whose values could not be drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawError {
    /// Key of the plan that stands in the way.
    pub key: String,
    /// What could not be met.
    pub problem: String,
}

/// Values of a unit.
struct Unit {
    split: usize,
    wheels_seed: u64,
    values: Vec<(String, f64)>,
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
        let count = self.content.classes[class].count;
        // Units are shuffled against the design, whose points of equal distance lie near each other.
        let units = self.content.units;
        let unit_number = (permuted(number, count, unit_seed) + unit_seed % units) % units;
        let unit = self.unit(unit_number)?;
        let seed = keyed(self.content.seed, Purpose::DatasetSeed, index);
        let Suitable { values, severity, severity_measure } =
            self.record_values(class, number, design_seed, &unit)?;
        let Unit { split, wheels_seed, .. } = unit;
        Ok(DrawnRecord {
            index,
            class,
            unit: unit_number,
            split,
            seed,
            wheels_seed,
            severity,
            severity_measure,
            values,
        })
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

    /// The split of a unit.
    ///
    /// # Arguments
    /// * `unit` - its number
    pub fn split_of_unit(&self, unit: u64) -> usize {
        let Content { splits, units, .. } = self.content;
        splits.of_unit(unit, *units, self.seed(SeedOf::Splits as u64))
    }

    fn seed(&self, index: u64) -> u64 {
        Draws::new(self.content.seed, Purpose::DatasetDesign, index).bits()
    }

    fn unit(&self, unit: u64) -> Result<Unit, DrawError> {
        let split = self.split_of_unit(unit);
        let shift = self.content.splits.shift(split);
        let points = Points {
            design: self.content.design,
            seed: self.seed(SeedOf::Units as u64),
            purpose: Purpose::DatasetUnit,
            count: self.content.units,
        };
        let any = &self.classes[0];
        let mut obstacles = Obstacles::default();
        for attempt in 0..MOST_ATTEMPTS {
            let mut values = Values::new(&any.base, &any.numbers);
            draw(&self.unit_rules, points, unit, attempt, &mut values);
            let met = self.meets(&self.unit_constraints, &values, &mut obstacles)
                && self.unit_suits(shift, &values, &mut obstacles);
            if met {
                let wheels_seed = keyed(self.content.seed, Purpose::DatasetWheels, unit);
                return Ok(Unit { split, wheels_seed, values: values.drawn() });
            }
        }
        Err(obstacles.error(&format!("unit {unit} of the split {}", self.content.splits.names()[split])))
    }

    /// Whether a unit of a split, which is a shift or not, may have these values.
    fn unit_suits(&self, own: Option<usize>, values: &Values, obstacles: &mut Obstacles) -> bool {
        let number = |key: &str| values.number(key);
        self.content.splits.shifts.iter().zip(&self.shift_levels).enumerate().all(|(s, (shift, of_unit))| {
            let mut decided = shift.when.iter().zip(of_unit).filter(|(_, of_unit)| **of_unit);
            if own == Some(s) {
                decided.all(|(condition, _)| {
                    let holds = condition.holds(&number) != Some(false);
                    holds || obstacles.note(shift_key(s), format!("`{condition}`"))
                })
            } else {
                let by_unit_alone = of_unit.iter().all(|of_unit| *of_unit);
                let fulfilled =
                    by_unit_alone && decided.all(|(condition, _)| condition.holds(&number) == Some(true));
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
        unit: &Unit,
    ) -> Result<Suitable, DrawError> {
        let rules = &self.classes[class];
        let plan = &self.content.classes[class];
        let points =
            Points { design: self.content.design, seed, purpose: Purpose::DatasetRecord, count: plan.count };
        let mut obstacles = Obstacles::default();
        for attempt in 0..MOST_ATTEMPTS {
            let mut values = Values::new(&rules.base, &rules.numbers);
            unit.values.iter().for_each(|(key, value)| values.set(key, *value));
            draw(&rules.rules, points, number, attempt, &mut values);
            let severity = plan.severity.of(&|key| values.number(key));
            let (grade, measure) = severity.unwrap_or((u8::from(!plan.faults.is_empty()), None));
            // What is the same for a whole class can be held out by its class alone.
            if measure.is_some() {
                values.set_severity(grade);
            }
            let met = self.meets(&rules.constraints, &values, &mut obstacles)
                && self.record_suits(self.content.splits.shift(unit.split), &values, &mut obstacles);
            if met {
                return Ok(Suitable { values: values.drawn(), severity: grade, severity_measure: measure });
            }
        }
        let split = self.content.splits.names()[unit.split];
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
