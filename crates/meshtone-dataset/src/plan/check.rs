//! What must hold of a plan as a whole.

use std::collections::HashSet;

use meshtone::scenario::{ScenarioError, WheelName};
use meshtone_toml::{ReadResult, TomlError, TomlTable};

use super::{Class, Content, Distribution, Level, OverAngle, Plan, Rule, SplitBy, Splits};
use crate::draw::{DrawError, DrawnRecord, Sampler, is_of_plan};
use crate::shard::FailedRecord;

/// Records whose values are drawn before anything is written.
const DRAWN: u64 = 5_000;
/// Records of each class whose scenarios are made.
const MADE: usize = 8;
/// Records of each class beside whose other values a value of a choice is tried, until one can be.
const TRIED: usize = 24;
/// Fewest records of a run in which a damage is seen to grow.
const FEWEST_OF_A_RUN: u64 = 3;
/// Values of choices and grids that are tried.
const MOST_VALUES: usize = 2_000;

/// Rules, units and splits agree.
pub(super) fn check(content: &Content, root: &TomlTable<'_>) -> ReadResult<()> {
    let records: u64 = content.classes.iter().map(|class| class.count).sum();
    if content.units > records {
        return Err(root.error("units", format!("is more than the {records} records")));
    }
    let mounted = content.units.saturating_mul(content.mountings);
    if mounted > records {
        let problem = format!("gives {mounted} mountings of all units, more than the {records} records");
        return Err(root.error("mountings", problem).with_help("lower it, or units"));
    }
    let needed = content.splits.all_parts().iter().filter(|&&part| part > 0.0).count() as u64;
    let (key, divided) = match content.splits.by {
        SplitBy::Unit => ("units", content.units),
        SplitBy::Mounting => ("mountings", mounted),
    };
    if divided < needed {
        let problem =
            format!("are {divided}, fewer than the {needed} splits, each of which must have one of its own");
        return Err(root.error(key, problem).with_help("raise it, or write [split] with train = 1.0"));
    }
    for (given, key, why) in [
        (
            content.base.quality.profile_errors.is_some(),
            "errors_file",
            "units draw their wheels by din_grade",
        ),
        (content.base.quality.seed.is_some(), "seed", "every unit has wheels of its own"),
    ] {
        if given {
            return Err(TomlError::new(
                format!("scenario.quality.{key}"),
                "",
                format!("cannot be given: {why}"),
            )
            .with_help("remove it from the base scenario"));
        }
    }
    if let Some(tuned) = &content.tuned {
        let rules = content.rules.iter().chain(content.classes.iter().flat_map(|class| &class.rules));
        let varied: Vec<&String> = rules.flat_map(|rule| &rule.keys).collect();
        if let Some((key, _)) = tuned.keys.iter().find(|(key, _)| varied.contains(&key)) {
            return Err(root.error(
                "tuned",
                format!("has the key `{key}`, which a rule varies; must be one of the two"),
            ));
        }
    }
    Sampler::new(content).map(|_| ())
}

/// No two columns of the data set have the same name.
pub(super) fn unique_columns(plan: &Plan) -> ReadResult<()> {
    let columns = crate::shard::columns(plan);
    let mut names = HashSet::new();
    match columns.iter().find(|column| !names.insert(&column.name)) {
        None => Ok(()),
        Some(twice) => Err(TomlError::new(
            "keep",
            "",
            format!("two columns of the data set would be called `{}`", twice.name),
        )
        .with_help("keep or vary one of the two")),
    }
}

/// The first records can be drawn, of each class one can be simulated, and every value of a choice is allowed.
pub(super) fn first_records(plan: &Plan) -> ReadResult<()> {
    let sampler = Sampler::new(&plan.content)?;
    let mut made = vec![Vec::new(); plan.content.classes.len()];
    let mut first = vec![Vec::new(); plan.content.classes.len()];
    for index in 0..plan.records().min(DRAWN) {
        let record = sampler.record(index).map_err(|DrawError { key, problem }| {
            TomlError::new(key, "", problem)
                .with_help("widen the ranges of the keys that it is about, or the condition")
        })?;
        refuse_severity(&plan.content, &record)?;
        let of_class: &mut Vec<_> = &mut made[record.class];
        let tried_enough = of_class.len() >= MADE || of_class.last().is_some_and(Option::is_none);
        if !tried_enough {
            let result = sampler.scenario(&record).and_then(|scenario| {
                refuse_ignored(&scenario, &record.values)?;
                refuse_short(&plan.content, &scenario)?;
                meshtone::stages(&scenario).map(drop)
            });
            of_class.push(result.err());
        }
        let first_of_class: &mut Vec<DrawnRecord> = &mut first[record.class];
        if first_of_class.len() < TRIED {
            first_of_class.push(record);
        }
    }
    for (c, errors) in made.into_iter().enumerate() {
        // None stands for a record that can be simulated.
        let tried = errors.len();
        let errors: Vec<TomlError> = errors.into_iter().flatten().map(TomlError::from).collect();
        if tried > 0
            && errors.len() == tried
            && let Some(error) = errors.into_iter().next()
        {
            let label = &plan.content.classes[c].label;
            let problem = format!("no record of the class \"{label}\" can be simulated; the first: {error}");
            let mut told = TomlError::new(format!("class[{c}]"), "", problem);
            told.help = error.help;
            return Err(told);
        }
    }
    every_choice(&plan.content, &sampler, &first)
}

/// A severity that is no part of the worst damage would lose its records one by one.
fn refuse_severity(content: &Content, record: &DrawnRecord) -> ReadResult<()> {
    let is_wrong = |(key, value): &&(String, f64)| is_severity(key) && !(0.0..=1.0).contains(value);
    let Some((key, value)) = record.values.iter().find(is_wrong) else { return Ok(()) };
    let class = &content.classes[record.class];
    let of = |rules: &[Rule], before: String| {
        let place = rules.iter().position(|rule| rule.keys.contains(key))?;
        Some(format!("{before}vary[{place}].{}", rules[place].distribution.name()))
    };
    let place =
        of(&class.rules, format!("class[{}].", record.class)).or_else(|| of(&content.rules, String::new()));
    let problem = format!(
        "gives {key} = {value:.4} to record {} of the class \"{}\"; a severity must be from 0 to 1",
        record.index, class.label
    );
    Err(TomlError::new(place.unwrap_or_else(|| "vary".to_owned()), "", problem).with_help(
        "narrow what it draws, or add a constraint such as constraints = [\"fault.severity < 1\"]",
    ))
}

fn is_severity(key: &str) -> bool {
    key.strip_suffix(".severity").is_some_and(|section| section.starts_with("fault"))
}

/// Those of the first records whose scenarios show that they cannot be simulated, without a profile of them being computed.
pub(super) fn foreseen(plan: &Plan) -> ReadResult<Vec<FailedRecord>> {
    let sampler = Sampler::new(&plan.content)?;
    let cannot = |index: u64| {
        let record = sampler.record(index).ok()?;
        let scenario = sampler.scenario(&record).map_err(TomlError::from);
        let refused = scenario.and_then(|scenario| refuse_short(&plan.content, &scenario)).err()?;
        Some(FailedRecord { record: index, reason: refused.to_string() })
    };
    Ok((0..plan.records().min(DRAWN)).filter_map(cannot).collect())
}

/// What is doubtful about a plan whose records can be made.
pub(super) fn doubts(plan: &Plan) -> ReadResult<Vec<String>> {
    let units = plan.content.units;
    let short = plan.content.classes.iter().filter_map(|class| short_runs(class, units));
    Ok(short.chain(unlearned(plan)?).collect())
}

/// Runs to failure in which nothing is seen to grow.
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

/// Values that units or mountings choose, and that validation or test have and the training has not.
fn unlearned(plan: &Plan) -> ReadResult<Vec<String>> {
    let content = &plan.content;
    let is_chosen = |rule: &&Rule| {
        let listed = matches!(rule.distribution, Distribution::Choice { .. } | Distribution::Grid(_));
        listed && rule.level != Level::Record && rule.times.is_none() && rule.plus.is_none()
    };
    let of_classes = content.classes.iter().flat_map(|class| &class.rules);
    let rules: Vec<&Rule> = content.rules.iter().chain(of_classes).filter(is_chosen).collect();
    if rules.is_empty() || content.splits.parts[0] == 0.0 {
        return Ok(Vec::new());
    }
    let sampler = Sampler::new(content)?;
    let (mut seen, mut groups) = (HashSet::new(), HashSet::new());
    for index in 0..plan.records().min(DRAWN) {
        let Ok(record) = sampler.record(index) else { continue };
        groups.insert((record.unit, record.mounting));
        for (number, rule) in rules.iter().enumerate() {
            let row: Option<Vec<f64>> = rule.keys.iter().map(|key| record.value(key)).collect();
            if let Some(row) = row {
                seen.insert((number, record.split, bits(&row)));
            }
        }
    }
    // Of what has not been drawn nothing is known.
    if plan.records() > DRAWN && (groups.len() as u64) < content.units.saturating_mul(content.mountings) {
        return Ok(Vec::new());
    }
    let unlearned = |(number, rule): (usize, &&Rule)| {
        let is_in = |split: usize, row: &[f64]| seen.contains(&(number, split, bits(row)));
        let rows = values_of(&rule.distribution).into_iter().map(|(_, row)| row);
        let missing: Vec<Vec<f64>> = rows
            .filter(|row| !is_in(0, row) && (1..Splits::ALIKE.len()).any(|split| is_in(split, row)))
            .collect();
        (!missing.is_empty()).then(|| {
            let row = |row: &Vec<f64>| row.iter().map(f64::to_string).collect::<Vec<_>>().join("/");
            format!(
                "{} = {}: chosen once for a {group}, and in validation or test alone: nothing is learned of it in train; have more \
                 {group}s, or fewer values",
                rule.keys.join("/"),
                missing.iter().map(row).collect::<Vec<_>>().join(", "),
                group = rule.level.name(),
            )
        })
    };
    Ok(rules.iter().enumerate().filter_map(unlearned).collect())
}

fn bits(row: &[f64]) -> Vec<u64> {
    row.iter().map(|value| value.to_bits()).collect()
}

/// Every value of a choice or a grid is allowed beside the other values of some record, as far as no profile is needed.
///
/// # Arguments
/// * `first` - the first records of each class
fn every_choice(content: &Content, sampler: &Sampler, first: &[Vec<DrawnRecord>]) -> ReadResult<()> {
    let mut left = MOST_VALUES;
    for (c, (class, records)) in content.classes.iter().zip(first).enumerate() {
        let top = content.rules.iter().enumerate().map(|(i, rule)| (rule, format!("vary[{i}]")));
        let own = class.rules.iter().enumerate().map(|(i, rule)| (rule, format!("class[{c}].vary[{i}]")));
        for (rule, place) in top.chain(own).filter(|(rule, _)| rule.times.is_none() && rule.plus.is_none()) {
            for (key, row) in values_of(&rule.distribution).into_iter().take(left) {
                left -= 1;
                refuse_value(sampler, records, rule, &row).map_err(|error| {
                    let listed: Vec<String> = row.iter().map(f64::to_string).collect();
                    let problem = format!(
                        "no record of the class \"{}\" can have {} = {}: {error}",
                        class.label,
                        rule.keys.join(", "),
                        listed.join(", ")
                    );
                    let mut told = TomlError::new(format!("{place}.{key}"), listed.join(", "), problem);
                    told.help = error.help;
                    told
                })?;
            }
        }
    }
    Ok(())
}

/// The rows of a choice or a grid that may come, each with its key beside the rule's.
fn values_of(distribution: &Distribution) -> Vec<(String, Vec<f64>)> {
    let keyed = |name: &str, (i, row): (usize, &Vec<f64>)| (format!("{name}[{i}]"), row.clone());
    match distribution {
        Distribution::Fixed(value) => vec![("fixed".to_owned(), vec![*value])],
        Distribution::Grid(rows) => rows.iter().enumerate().map(|row| keyed("grid", row)).collect(),
        Distribution::Choice { rows, weights } => {
            let chosen = rows.iter().enumerate().filter(|(i, _)| weights[*i] > 0.0);
            chosen.map(|row| keyed("choice", row)).collect()
        }
        _ => Vec::new(),
    }
}

/// The error that a rule's values make with the other values of every one of some records; none where one of them may have
/// them, or the rule does not concern them.
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

/// A record is a hunting period long, and cannot be cut to more.
fn refuse_short(content: &Content, scenario: &meshtone::scenario::Scenario) -> ReadResult<()> {
    if let Some(angle) = content.keep.over_angle {
        refuse_turns(content, scenario, angle)?;
    }
    let Some(duration_s) = content.keep.duration_s else { return Ok(()) };
    let time = scenario.time_grid();
    let period_s = time.kept_samples() as f64 / time.sampling_rate_hz;
    let rate_hz = content.keep.sampling_rate_hz;
    if (duration_s * rate_hz).round() <= (period_s * rate_hz).ceil() {
        return Ok(());
    }
    let problem =
        format!("is longer than the hunting period, {period_s:.4} s, which is all that is simulated");
    Err(TomlError::new("keep.duration_s", duration_s.to_string(), problem)
        .with_help("shorten it, or leave it out: a record is then a whole hunting period long"))
}

/// Channels over the angle are of a steady motion, and no longer than it is simulated.
fn refuse_turns(
    content: &Content,
    scenario: &meshtone::scenario::Scenario,
    angle: OverAngle,
) -> ReadResult<()> {
    let operation = &scenario.operation;
    let is_steady = operation.speed_profile_hz.is_none()
        && operation.torque_profile_nm.is_none()
        && operation.speed_fluctuation_hz == 0.0
        && operation.torque_fluctuation_nm == 0.0;
    if !is_steady {
        let problem = "is of a speed and a load that are constant within a record; the scenario's are not";
        return Err(TomlError::new("keep.points_per_revolution", "", problem)
            .with_help("leave it and revolutions out, or the profiles and fluctuations"));
    }
    let time = scenario.time_grid();
    let turns = time.kept_samples() / time.samples_per_pinion_revolution.max(1);
    let gears = &scenario.gears;
    let simulated = match content.keep.wheel {
        WheelName::Pinion => turns,
        WheelName::Gear => turns * gears.pinion_teeth as usize / gears.gear_teeth as usize,
    };
    if angle.revolutions <= simulated {
        return Ok(());
    }
    let problem = format!(
        "is more than the {simulated} revolutions of the {} that are simulated of {}/{} teeth",
        content.keep.wheel.name(),
        gears.pinion_teeth,
        gears.gear_teeth
    );
    Err(TomlError::new("keep.revolutions", angle.revolutions.to_string(), problem).with_help("lower it"))
}

/// A varied key that the model ignores would be a label without effect.
fn refuse_ignored(scenario: &meshtone::scenario::Scenario, values: &[(String, f64)]) -> ReadResult<()> {
    let ignored = scenario.ignored_by_model();
    match ignored.iter().find(|warning| values.iter().any(|(key, _)| key.starts_with(&warning.key))) {
        Some(warning) => Err(TomlError::new(&warning.key, "", warning.message.clone())),
        None => Ok(()),
    }
}
