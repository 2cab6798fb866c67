//! Checks of a plan as a whole.

use std::collections::HashSet;

use meshtone::batch::SteppedAlone;
use meshtone::scenario::{Scenario, ScenarioError, ScenarioWarning};
use meshtone::signal::FEWEST_REVOLUTIONS;
use meshtone_toml::{ReadResult, TomlError, TomlTable};

use super::{Class, Content, Distribution, Keep, Level, Plan, Rule, SplitBy, Splits, refused, wheel_words};
use crate::draw::{DrawnRecord, NOISE_KEYS, Sampler, is_of_plan};
use crate::record::Turning;
use crate::shard::FailedRecord;
use crate::words::counted;

/// Largest number of records that are drawn to check a plan.
const DRAWN: u64 = 5_000;
/// Largest number of records of each class whose scenarios are made.
const MADE: usize = 8;
/// Largest number of records of each class with which a value of a choice is tried until one is allowed.
const TRIED: usize = 24;
/// Smallest number of records of a run that show a damage grow.
const FEWEST_OF_A_RUN: u64 = 3;
/// Largest number of values of choices and grids that are tried.
const MOST_VALUES: usize = 2_000;
/// Largest number of records whose stages are made to see whether they are simulated one by one.
const LOOKED_AT: u64 = 16;

/// Checks that rules, units and splits agree.
pub(super) fn check(content: &Content, root: &TomlTable<'_>) -> ReadResult<()> {
    let records: u64 = content.classes.iter().map(|class| class.count).sum();
    if content.units > records {
        return Err(root.error("units", format!("is more than the {records} records")));
    }
    let mounted = content.all_mountings();
    if mounted > records {
        let problem = format!("gives {mounted} mountings of all units, more than the {records} records");
        return Err(root.error("mountings", problem).with_help("lower it, or units"));
    }
    let needed = content.splits.all_parts().iter().filter(|&&part| part > 0.0).count() as u64;
    let divided = content.divided();
    if divided < needed {
        let problem =
            format!("are {divided}, fewer than the {needed} splits, each of which must have one of its own");
        let key = if content.splits.by == SplitBy::Unit { "units" } else { "mountings" };
        return Err(root.error(key, problem).with_help("raise it, or write [split] with train = 1.0"));
    }
    refuse_given_wheels(&content.base)?;
    let mut tuned = content.tuned.iter().flat_map(|tuned| &tuned.keys);
    if let Some((key, _)) = tuned.find(|(key, _)| content.all_rules().any(|rule| rule.varies(key))) {
        let problem = format!("has the key `{key}`, which a rule varies; must be one of the two");
        return Err(root.error("tuned", problem));
    }
    let has_level = |rule: &Rule| NOISE_KEYS.iter().any(|key| rule.varies(key));
    if content.background.is_some() && !content.all_rules().any(has_level) {
        let help =
            "vary noise.snr_db or noise.level_g: [[vary]] with key = \"noise.snr_db\" and uniform = [10, 30]";
        return Err(root.error("background", "has no level").with_help(help));
    }
    Sampler::new(content).map(drop)
}

/// Refuses wheels whose deviations or seed are given: every unit has wheels of its own.
fn refuse_given_wheels(base: &Scenario) -> ReadResult<()> {
    let (key, why) = match base.wheels.iter().position(|wheel| wheel.profile_errors_mm.is_some()) {
        Some(number) => {
            let key = base.key_of_quality(number, "errors_file");
            (key, "units draw their wheels by din_grade or iso_class")
        }
        None if base.wheels_seed.is_some() => {
            (base.words().wheels_seed_key.to_owned(), "every unit has wheels of its own")
        }
        None => return Ok(()),
    };
    let problem = format!("cannot be given: {why}");
    Err(refused(format!("scenario.{key}"), problem, "remove it from the base scenario"))
}

/// Checks that no two columns of the data set have the same name.
pub(super) fn unique_columns(plan: &Plan) -> ReadResult<()> {
    let columns = crate::shard::columns(plan);
    let mut names = HashSet::new();
    let Some(twice) = columns.iter().find(|column| !names.insert(&column.name)) else { return Ok(()) };
    let problem = format!("two columns of the data set would be called `{}`", twice.name);
    Err(refused("keep", problem, "keep or vary one of the two"))
}

/// The records of a class that have been tried.
#[derive(Default)]
struct Tried {
    /// The first records.
    records: Vec<DrawnRecord>,
    /// Whether one of them can be simulated, or why the first one cannot; none where none was made.
    simulated: Option<ReadResult<()>>,
}

/// Checks that the first records can be drawn, that one of each class can be simulated, and that every value of a choice is allowed.
pub(super) fn first_records(plan: &Plan) -> ReadResult<()> {
    let content = &plan.content;
    let sampler = Sampler::new(content)?;
    let mut tried: Vec<Tried> = content.classes.iter().map(|_| Tried::default()).collect();
    for index in 0..plan.records().min(DRAWN) {
        let help = "widen the ranges of the keys that it is about, or the condition";
        let record = sampler.record(index).map_err(|error| error.with_help(help))?;
        refuse_severity(content, &record)?;
        let class = &mut tried[record.class];
        if class.records.len() < MADE && !matches!(class.simulated, Some(Ok(()))) {
            // A key of the plan is where it is mended; one of a record's scenario may be drawn, or written in another file.
            let of_class = |error: ScenarioError| {
                let problem = error.to_string();
                with_help_of(TomlError::new(format!("class[{}]", record.class), "", problem), error)
            };
            let made = sampler.scenario(&record).and_then(|scenario| {
                // The key would be a label without effect.
                let is_varied = |warning: &ScenarioWarning| {
                    record.values.iter().any(|(key, _)| key.starts_with(&warning.key))
                };
                match scenario.ignored_by_model().into_iter().find(is_varied) {
                    Some(ignored) => Err(TomlError::new(ignored.key, "", ignored.message)),
                    None => Ok(scenario),
                }
            });
            let result = made.map_err(of_class).and_then(|scenario| {
                refuse_length(content, &scenario)?;
                meshtone::stages(scenario).map(drop).map_err(of_class)
            });
            if result.is_ok() || class.simulated.is_none() {
                class.simulated = Some(result);
            }
        }
        if class.records.len() < TRIED {
            class.records.push(record);
        }
    }
    for (c, class) in tried.iter_mut().enumerate() {
        if let Some(Err(mut error)) = class.simulated.take() {
            let label = &content.classes[c].label;
            let first = &error.problem;
            error.problem =
                format!("no record of the class \"{label}\" can be simulated; the first: {first}");
            return Err(error);
        }
    }
    every_choice(content, &sampler, &tried)
}

/// An error with the help of the error that it is about.
fn with_help_of(mut error: TomlError, of: TomlError) -> TomlError {
    error.help = of.help;
    error
}

/// Refuses a severity outside 0 to 1: its records would fail one by one.
fn refuse_severity(content: &Content, record: &DrawnRecord) -> ReadResult<()> {
    let is_wrong = |(key, value): &&(String, f64)| is_severity(key) && !(0.0..=1.0).contains(value);
    let Some((key, value)) = record.values.iter().find(is_wrong) else { return Ok(()) };
    let class = &content.classes[record.class];
    let mut rules = content.class_rules(record.class).chain(content.top_rules());
    let rule = rules.find(|(rule, _)| rule.varies(key));
    let distribution = |(rule, place): (&Rule, String)| format!("{place}.{}", rule.distribution.name());
    let place = rule.map_or_else(|| "vary".to_owned(), distribution);
    let problem = format!(
        "gives {key} = {value:.4} to record {} of the class \"{}\"; a severity must be from 0 to 1",
        record.index, class.label
    );
    let help = "narrow what it draws, or add a constraint such as constraints = [\"fault.severity < 1\"]";
    Err(refused(place, problem, help))
}

fn is_severity(key: &str) -> bool {
    key.strip_suffix(".severity").is_some_and(|section| section.starts_with("fault"))
}

impl Plan {
    /// Those of the first 5000 records whose scenarios show that they cannot be simulated, for example because a draw is outside a
    /// fault's limits, a speed profile is shorter than `keep.duration_s`, or that holds too few revolutions. The data set will lack these records.
    pub fn foreseen_failures(&self) -> Vec<FailedRecord> {
        // A plan that was read has been checked, so that its records can be drawn.
        let Ok(sampler) = Sampler::new(&self.content) else { return Vec::new() };
        let cannot = |index: u64| {
            let record = sampler.record(index).ok()?;
            let scenario = sampler.scenario(&record);
            let refused = scenario.and_then(|scenario| refuse_length(&self.content, &scenario)).err()?;
            Some(FailedRecord { record: index, reason: refused.to_string() })
        };
        (0..self.records().min(DRAWN)).filter_map(cannot).collect()
    }

    /// Warnings about what the plan asks for: runs to failure of only one or two records, values of units or mountings that no
    /// record of the training has, and pairs that are simulated one by one.
    pub fn warnings(&self) -> Vec<String> {
        let units = self.content.units;
        let short = self.content.classes.iter().filter_map(|class| short_runs(class, units));
        short.chain(unlearned(self).unwrap_or_default()).chain(stepped_alone(self)).collect()
    }
}

/// A warning about pairs that a batch steps alone, where it steps most side by side.
///
/// The first records tell, the whole stages of each of which are made: twice as many as a plan has classes, and no more than some.
fn stepped_alone(plan: &Plan) -> Option<String> {
    let sampler = Sampler::new(&plan.content).ok()?;
    let reason = |index: u64| {
        let scenario = sampler.scenario(&sampler.record(index).ok()?).ok()?;
        // Of shafts of beams every one is, as it is meant.
        scenario.rig()?;
        meshtone::stages(&scenario).ok()?.stepped_alone()
    };
    let looked_at = plan.records().min(2 * plan.content.classes.len() as u64).min(LOOKED_AT);
    let reasons: Vec<SteppedAlone> = (0..looked_at).filter_map(reason).collect();
    let first = reasons.first()?;
    Some(format!(
        "of the first {}, {} cannot be simulated side by side with others, which takes several times as long: {first}",
        counted(looked_at, "record"),
        reasons.len()
    ))
}

/// A warning about runs to failure that are too short to show a damage grow.
fn short_runs(class: &Class, units: u64) -> Option<String> {
    class.growth.as_ref()?;
    let (least, most) = (class.count / units, class.count.div_ceil(units));
    let records = if least == most { format!("{least}") } else { format!("{least} or {most}") };
    (least < FEWEST_OF_A_RUN).then(|| {
        format!(
            "the runs to failure of the class \"{}\" have {records} records each, {} over {units} units: damage is seen to grow in \
             {FEWEST_OF_A_RUN} or more; raise the records, or lower units",
            class.label, class.count
        )
    })
}

/// A warning about values of units or mountings that occur in validation or test but not in the training.
///
/// Which values come into which split is chance and known only after drawing, so that the plan's first records are drawn as they would be
/// generated. Where these do not include all units nothing is said, because the missing values may still come.
fn unlearned(plan: &Plan) -> ReadResult<Vec<String>> {
    let content = &plan.content;
    let is_chosen = |rule: &&Rule| {
        let listed = matches!(rule.distribution, Distribution::Choice { .. } | Distribution::Grid(_));
        listed && rule.level != Level::Record && rule.times.is_none() && rule.plus.is_none()
    };
    let rules: Vec<&Rule> = content.all_rules().filter(is_chosen).collect();
    if rules.is_empty() || content.splits.parts[0] == 0.0 {
        return Ok(Vec::new());
    }
    let sampler = Sampler::new(content)?;
    let (mut seen, mut groups) = (HashSet::new(), HashSet::new());
    for index in 0..plan.records().min(DRAWN) {
        let Ok(record) = sampler.record(index) else { continue };
        groups.insert((record.unit, record.mounting));
        for (number, rule) in rules.iter().enumerate() {
            let row: Option<Vec<u64>> =
                rule.keys.iter().map(|key| record.value(key).map(f64::to_bits)).collect();
            seen.extend(row.map(|row| (number, record.split, row)));
        }
    }
    // Nothing is known about units that have not been drawn.
    if plan.records() > DRAWN && (groups.len() as u64) < content.all_mountings() {
        return Ok(Vec::new());
    }
    let unlearned = |(number, rule): (usize, &&Rule)| {
        let is_in = |split: usize, row: &[f64]| {
            seen.contains(&(number, split, row.iter().map(|value| value.to_bits()).collect()))
        };
        let is_missing =
            |row: &[f64]| !is_in(0, row) && (1..Splits::ALIKE.len()).any(|split| is_in(split, row));
        let rows = values_of(&rule.distribution).into_iter().map(|(_, row)| row);
        let missing: Vec<String> = rows.filter(|row| is_missing(row)).map(|row| joined(row, "/")).collect();
        (!missing.is_empty()).then(|| {
            format!(
                "{} = {}: chosen once for a {group}, and in validation or test alone: nothing is learned of it in train; have more \
                 {group}s, or fewer values",
                rule.keys.join("/"),
                missing.join(", "),
                group = rule.level.name(),
            )
        })
    };
    Ok(rules.iter().enumerate().filter_map(unlearned).collect())
}

fn joined(row: &[f64], between: &str) -> String {
    row.iter().map(f64::to_string).collect::<Vec<_>>().join(between)
}

/// Checks that every value of a choice or a grid is allowed together with the other values of some record, as far as no profile is
/// needed.
///
/// # Arguments
/// * `tried` - the first records of each class
fn every_choice(content: &Content, sampler: &Sampler, tried: &[Tried]) -> ReadResult<()> {
    let mut left = MOST_VALUES;
    for (c, (class, tried)) in content.classes.iter().zip(tried).enumerate() {
        let rules = content.top_rules().chain(content.class_rules(c));
        for (rule, place) in rules.filter(|(rule, _)| rule.times.is_none() && rule.plus.is_none()) {
            for (key, row) in values_of(&rule.distribution).into_iter().take(left) {
                left -= 1;
                refuse_value(sampler, &tried.records, rule, row).map_err(|error| {
                    let (label, keys, listed) = (&class.label, rule.keys.join(", "), joined(row, ", "));
                    let problem =
                        format!("no record of the class \"{label}\" can have {keys} = {listed}: {error}");
                    with_help_of(TomlError::new(format!("{place}.{key}"), listed, problem), error)
                })?;
            }
        }
    }
    Ok(())
}

/// The listed values that may be drawn, each with its key beside the rule's.
fn values_of(distribution: &Distribution) -> Vec<(String, &[f64])> {
    let name = distribution.name();
    let keyed = |(i, row)| match distribution {
        Distribution::Fixed(_) => Some((name.to_owned(), row)),
        Distribution::Choice { weights, .. } if weights[i] <= 0.0 => None,
        _ => Some((format!("{name}[{i}]"), row)),
    };
    distribution.rows().into_iter().enumerate().filter_map(keyed).collect()
}

/// Refuses values of a rule that are not allowed in any of some records, unless the rule does not concern them.
fn refuse_value(
    sampler: &Sampler,
    records: &[DrawnRecord],
    rule: &Rule,
    row: &[f64],
) -> Result<(), ScenarioError> {
    if rule.keys.iter().all(|key| is_of_plan(key)) {
        return Ok(());
    }
    let mut refused = Ok(());
    for record in records {
        let mut changed = record.clone();
        for (key, value) in rule.keys.iter().zip(row) {
            let Some(place) = changed.values.iter_mut().find(|(drawn, _)| drawn == key) else {
                return Ok(());
            };
            place.1 = *value;
        }
        match sampler.scenario(&changed) {
            Ok(_) => return Ok(()),
            Err(error) => refused = refused.and(Err(error)),
        }
    }
    refused
}

/// Refuses a record that lasts longer than a speed profile or the background, channels over the angle of an unsteady motion, and averages
/// over too few revolutions.
fn refuse_length(content: &Content, scenario: &Scenario) -> ReadResult<()> {
    let Keep { over_angle, duration_s, wheel, .. } = &content.keep;
    let (operation, is_steady) = (&scenario.operation, scenario.operation.is_steady());
    if over_angle.is_some() && !is_steady {
        let problem = "is of a speed and a load that are constant within a record; the scenario's are not";
        let help = "leave it and revolutions out, or the profiles and fluctuations";
        return Err(refused("keep.points_per_revolution", problem, help));
    }
    let time = scenario.time_grid();
    let simulated_s = time.kept_samples() as f64 * time.step_s();
    if let Some(duration_s) = *duration_s
        && operation.speed_profile_hz.is_some()
        && duration_s > simulated_s + time.step_s()
    {
        let problem = format!("is longer than the speed profile, {simulated_s:.4} s");
        let error = TomlError::new("keep.duration_s", duration_s.to_string(), problem);
        return Err(error.with_help("shorten it, or leave it out: a record is then as long as that"));
    }
    let turning = Turning::of(scenario)?;
    let of_wheel = |wheel: &String| &turning.wheels[turning.number(wheel)];
    let first = of_wheel(&wheel.all()[0]);
    // The slowest has the fewest revolutions; its first one begins up to a pitch after the record.
    let slowest = wheel.all().iter().map(of_wheel).min_by(|a, b| a.speed_hz.total_cmp(&b.speed_hz));
    let slowest = slowest.unwrap_or(first);
    let before = if turning.enter_together { 0.0 } else { 1.0 / f64::from(slowest.teeth) };
    let length = scenario.solver.length_key();
    let (key, value, change, seconds) = match (over_angle, duration_s) {
        (Some(angle), _) => {
            let revolutions = angle.revolutions as f64;
            ("keep.revolutions", revolutions, "raise", revolutions / first.speed_hz)
        }
        (None, Some(duration_s)) => ("keep.duration_s", *duration_s, "raise", *duration_s),
        (None, None) => {
            (&*format!("scenario.solver.{}", length.name), length.value, length.change, simulated_s)
        }
    };
    if let Some(background) = &content.background {
        let rate_hz = content.keep.sampling_rate_hz;
        let checked = background.check_length((seconds * rate_hz) as usize, rate_hz);
        checked.map_err(|problem| TomlError::new("background", "", problem))?;
    }
    let revolutions = seconds * slowest.speed_hz - before;
    // A whole number of revolutions may come out a rounding error below it.
    if content.keep.is_analysed() && is_steady && revolutions + 1e-6 < FEWEST_REVOLUTIONS as f64 {
        let problem = format!(
            "gives {revolutions:.3} revolutions of the {} at {:.3} Hz, but an average needs at least {FEWEST_REVOLUTIONS}",
            wheel_words(&slowest.name),
            slowest.speed_hz
        );
        let help = format!("{change} it, or set average, difference and indicators to false");
        return Err(TomlError::new(key, value.to_string(), problem).with_help(help));
    }
    Ok(())
}
