//! A plan's rules, checked against each other and against the scenario.

use std::collections::HashMap;

use meshtone::scenario::Scenario;
use meshtone_toml::{ReadResult, TomlError, nearest_name};

use super::values::{SEVERITY, fault_of_severity};
use super::{FAULT_SEVERITY, NOISE_KEYS, PATH_KEYS, Sampler, is_of_plan};
use crate::expression::{Condition, derived_names, underlying};
use crate::plan::{Content, Distribution, Level, Rule, SplitBy, kinds};

/// Keys that every record or unit has its own of.
const OWN: [(&str, &str); 2] =
    [("seed", "every record has a seed of its own"), ("quality.seed", "every unit has wheels of its own")];

/// What a class's records are drawn by.
#[derive(Debug, Clone)]
pub(super) struct ClassRules<'a> {
    /// With the class's faults.
    pub base: Scenario,
    /// All its numbers, by their keys.
    pub numbers: HashMap<String, f64>,
    /// Rules for records, those that others depend on first.
    pub rules: Vec<&'a Rule>,
    /// Constraints that records must meet.
    pub constraints: Vec<&'a Condition>,
}

impl ClassRules<'_> {
    /// Whether there is a number at a key of its records' scenarios, given or found from others.
    fn knows(&self, key: &str) -> bool {
        self.numbers.contains_key(key) || fault_of_severity(key, &self.base.faults).is_some()
    }
}

/// A rule and its key in the plan.
type Placed<'a> = (&'a Rule, String);

pub(super) fn sampler(content: &Content) -> ReadResult<Sampler<'_>> {
    let top: Vec<Placed> =
        content.rules.iter().enumerate().map(|(i, rule)| (rule, format!("vary[{i}]"))).collect();
    let mut classes = Vec::with_capacity(content.classes.len());
    for (c, class) in content.classes.iter().enumerate() {
        let base = content.base.clone().with_faults(class.faults.clone());
        let known: Vec<_> = base.numbers();
        let own: Vec<Placed> =
            class.rules.iter().enumerate().map(|(i, rule)| (rule, format!("class[{c}].vary[{i}]"))).collect();
        for (rule, place) in &own {
            if rule.level != Level::Record {
                let problem = format!("varies by {}; a rule of a class varies by record", rule.level.name());
                return Err(TomlError::new(place, "", problem)
                    .with_help("move it to the top as [[vary]], or write per = \"record\""));
            }
        }
        let has = |key: &str| is_of_plan(key) || known.iter().any(|number| number.key == key);
        // A rule at the top concerns the classes whose faults have its keys.
        let concerned = top.iter().filter(|(rule, _)| rule.keys.iter().all(|key| has(key)));
        let all: Vec<Placed> = concerned.cloned().chain(own).collect();
        check_keys(&all, &known, &base)?;
        check_growth(content, c, &all, &known)?;
        let ordered = in_order(&all, &known)?;
        let rules = ordered.into_iter().filter(|rule| rule.level == Level::Record).collect();
        let numbers = known.iter().map(|number| (number.key.clone(), number.value)).collect();
        classes.push(ClassRules { base, numbers, rules, constraints: Vec::new() });
    }
    check_top(content, &top, &classes)?;
    let base_numbers = content.base.numbers();
    let of_groups: Vec<Placed> =
        top.iter().filter(|(rule, _)| rule.level != Level::Record).cloned().collect();
    let ordered = in_order(&of_groups, &base_numbers)?;
    let of_level = |level: Level| ordered.iter().copied().filter(|rule| rule.level == level).collect();
    let (unit_rules, mounting_rules) = (of_level(Level::Unit), of_level(Level::Mounting));
    let decides = |condition: &Condition| level_of(condition, content);
    let constraints: Vec<(Level, &Condition)> =
        content.constraints.iter().map(|condition| (decides(condition), condition)).collect();
    let (by_record, group_constraints): (Vec<_>, Vec<_>) =
        constraints.into_iter().partition(|(level, _)| *level == Level::Record);
    for class in &mut classes {
        class.constraints = by_record.iter().map(|(_, condition)| *condition).collect();
    }
    let shift_levels: Vec<Vec<Level>> =
        content.splits.shifts.iter().map(|shift| shift.when.iter().map(decides).collect()).collect();
    refuse_unit_shifts(content, &shift_levels)?;
    check_conditions(content, &classes)?;
    check_severities(content, &classes)?;
    let mut end = 0;
    let ends = content.classes.iter().map(|class| {
        end += class.count;
        end
    });
    let ends = ends.collect();
    Ok(Sampler { content, unit_rules, mounting_rules, classes, ends, group_constraints, shift_levels })
}

/// Whether a key is a fault's: `fault.…`, or of several `fault[1].…`.
fn is_of_fault(key: &str) -> bool {
    key.starts_with("fault.") || key.starts_with("fault[")
}

/// Keys that exist, once each, of the right kind.
fn check_keys(
    rules: &[Placed],
    known: &[meshtone::scenario::ScenarioNumber],
    base: &Scenario,
) -> ReadResult<()> {
    let mut seen: Vec<(&str, &str)> = Vec::new();
    for (rule, place) in rules {
        let named = if rule.keys.len() == 1 { "key" } else { "keys" };
        let refuse = |key: &str, problem: String| {
            TomlError::new(format!("{place}.{named}"), format!("{key:?}"), problem)
        };
        for (column, key) in rule.keys.iter().enumerate() {
            if let Some((_, why)) = OWN.iter().find(|(own, _)| own == key) {
                return Err(refuse(key, format!("cannot be varied: {why}")));
            }
            if let Some((_, other)) = seen.iter().find(|(seen, _)| seen == key) {
                return Err(refuse(key, format!("`{key}` is varied by {other} too; must be varied once")));
            }
            seen.push((key, place));
            if is_of_plan(key) {
                if NOISE_KEYS.contains(&key.as_str())
                    && seen.iter().filter(|(seen, _)| NOISE_KEYS.contains(seen)).count() > 1
                {
                    return Err(refuse(
                        key,
                        "noise is given both relative and in g; give one of the two".to_owned(),
                    ));
                }
                continue;
            }
            let Some(number) = known.iter().find(|number| number.key == *key) else {
                return Err(unknown(place, named, key, known, base));
            };
            if number.whole && !is_whole(rule, column) {
                let problem = format!("`{key}` is a whole number, but what is drawn for it is not");
                return Err(refuse(key, problem).with_help("use choice or grid with whole numbers"));
            }
            let fixed_wheels = key.starts_with("gears.") || key.starts_with("quality.");
            if fixed_wheels && rule.level != Level::Unit {
                let problem = format!(
                    "`{key}` would differ between {}s of one unit, which share their wheels",
                    rule.level.name()
                );
                return Err(
                    refuse(key, problem).with_help("leave out per: it is \"unit\" for gears and quality")
                );
            }
            if is_of_fault(key) && rule.level != Level::Record {
                let problem = format!("`{key}` varies by {}; faults vary by record", rule.level.name());
                return Err(refuse(key, problem).with_help("leave out per"));
            }
        }
    }
    Ok(())
}

fn is_whole(rule: &Rule, column: usize) -> bool {
    if rule.times.is_some() || rule.plus.is_some() {
        return false;
    }
    match &rule.distribution {
        Distribution::Fixed(value) => value.fract() == 0.0,
        Distribution::Grid(rows) | Distribution::Choice { rows, .. } => {
            rows.iter().all(|row| row[column].fract() == 0.0)
        }
        _ => false,
    }
}

fn unknown(
    place: &str,
    named: &str,
    key: &str,
    known: &[meshtone::scenario::ScenarioNumber],
    base: &Scenario,
) -> TomlError {
    let fault = kinds(&base.faults).unwrap_or_else(|| "a healthy pair".to_owned());
    let problem = format!("`{key}` is no number of the scenario ({fault}), so it cannot be varied");
    let error = TomlError::new(format!("{place}.{named}"), format!("{key:?}"), problem);
    if fault_of_severity(key, &base.faults).is_some() {
        return error.with_help("write the fault with severity = … in place of its sizes");
    }
    error.with_help(
        match nearest_name(
            key,
            known.iter().map(|number| number.key.as_str()).chain(NOISE_KEYS).chain(PATH_KEYS),
        ) {
            Some(nearest) => meant(key, nearest),
            None => {
                "`meshtone init KIND` prints every key of a kind of fault; sections are part of a key, as in \
                 `operation.pinion_speed_hz`"
                    .to_owned()
            }
        },
    )
}

/// Every rule at the top concerns some class.
fn check_top(content: &Content, top: &[Placed], classes: &[ClassRules]) -> ReadResult<()> {
    for (rule, place) in top {
        let has = |class: &ClassRules, key: &String| is_of_plan(key) || class.numbers.contains_key(key);
        if classes.iter().any(|class| rule.keys.iter().all(|key| has(class, key))) {
            continue;
        }
        let key = rule
            .keys
            .iter()
            .find(|key| !classes.iter().any(|class| has(class, key)))
            .unwrap_or(&rule.keys[0]);
        let named = if rule.keys.len() == 1 { "key" } else { "keys" };
        let mut known = content.base.numbers();
        for class in classes {
            known.extend(class.base.numbers());
        }
        return Err(unknown(place, named, key, &known, &content.base));
    }
    Ok(())
}

/// The rules, each after those that it depends on.
fn in_order<'a>(
    rules: &[Placed<'a>],
    known: &[meshtone::scenario::ScenarioNumber],
) -> ReadResult<Vec<&'a Rule>> {
    let mut waiting: Vec<&Placed> = rules.iter().collect();
    for (rule, place) in rules {
        for (name, term) in [("times", &rule.times), ("plus", &rule.plus)] {
            let Some(expression) = term else { continue };
            for key in underlying(expression.keys()) {
                check_dependency(rule, &format!("{place}.{name}"), key, rules, known)?;
            }
        }
    }
    let mut ordered: Vec<&'a Rule> = Vec::with_capacity(rules.len());
    while !waiting.is_empty() {
        let sets = |rule: &Rule, key: &str| rule.keys.iter().any(|own| own == key);
        let is_ready = |(rule, _): &&Placed| {
            !dependencies(rule).iter().any(|key| waiting.iter().any(|(other, _)| sets(other, key)))
        };
        let Some(next) = waiting.iter().position(is_ready) else {
            let (rule, place) = waiting[0];
            let problem =
                "depends on itself, by its own times or plus or those of the rules that it depends on";
            return Err(TomlError::new(place, rule.keys.join(", "), problem));
        };
        ordered.push(waiting.remove(next).0);
    }
    Ok(ordered)
}

fn dependencies(rule: &Rule) -> Vec<&str> {
    let terms = [&rule.times, &rule.plus];
    underlying(terms.into_iter().flatten().flat_map(|expression| expression.keys()))
}

fn check_dependency(
    rule: &Rule,
    place: &str,
    key: &str,
    rules: &[Placed],
    known: &[meshtone::scenario::ScenarioNumber],
) -> ReadResult<()> {
    let varied = rules.iter().find(|(other, _)| other.keys.iter().any(|own| own == key));
    if varied.is_none() && !known.iter().any(|number| number.key == key) {
        return Err(no_such_number(place, key, known.iter().map(|number| number.key.as_str())));
    }
    if let Some((varied, other)) = varied.filter(|(other, _)| rule.level < other.level) {
        let (by, own) = (varied.level.name(), rule.level.name());
        let problem = format!("depends on `{key}`, which {other} varies by {by}; what a {own} has cannot");
        return Err(TomlError::new(place, "", problem));
    }
    Ok(())
}

/// The key that is meant; who writes revolutions per minute is told what becomes of the values.
fn meant(key: &str, nearest: &str) -> String {
    let by_minute = key.ends_with("rpm") && nearest.ends_with("_hz");
    let unit =
        if by_minute { " Its values are revolutions per second, a sixtieth of those per minute" } else { "" };
    format!("did you mean `{nearest}`?{unit}")
}

fn no_such_number<'n>(place: &str, key: &str, known: impl Iterator<Item = &'n str>) -> TomlError {
    let error = TomlError::new(place, "", format!("`{key}` is no number of the scenario"));
    let others = derived_names().chain([SEVERITY]).map(|name| -> &'n str { name });
    match nearest_name(key, known.chain(others)) {
        Some(nearest) => error.with_help(meant(key, nearest)),
        None => error.with_help("sections are part of a key, as in `gears.module_mm`"),
    }
}

/// What decides a condition: a unit, where all that it is about is the same for all records of one, a mounting likewise, or a record.
fn level_of(condition: &Condition, content: &Content) -> Level {
    let class_rules = content.classes.iter().flat_map(|class| &class.rules);
    let rules: Vec<&Rule> = content.rules.iter().chain(class_rules).collect();
    let level = |key: &str| {
        if key == SEVERITY || is_of_fault(key) {
            return Level::Record;
        }
        let of_key = rules.iter().filter(|rule| rule.keys.iter().any(|own| own == key));
        of_key.map(|rule| rule.level).max().unwrap_or(Level::Unit)
    };
    underlying(condition.keys()).into_iter().map(level).max().unwrap_or(Level::Unit)
}

/// Where mountings are divided a unit may be in several splits: what it has belongs to none of them alone.
fn refuse_unit_shifts(content: &Content, shift_levels: &[Vec<Level>]) -> ReadResult<()> {
    if content.splits.by == SplitBy::Unit {
        return Ok(());
    }
    for (s, (shift, levels)) in content.splits.shifts.iter().zip(shift_levels).enumerate() {
        if let Some(of_unit) = levels.iter().position(|level| *level == Level::Unit) {
            let problem = format!(
                "`{}` is the same for all mountings of a unit, which are in several splits where split.by is \"mounting\"",
                shift.when[of_unit]
            );
            return Err(TomlError::new(super::shift_key(s), "", problem)
                .with_help("leave out split.by, or vary its keys per mounting or record"));
        }
    }
    Ok(())
}

/// A damage that grows is given by its severity, which nothing else varies.
fn check_growth(
    content: &Content,
    class: usize,
    rules: &[Placed],
    known: &[meshtone::scenario::ScenarioNumber],
) -> ReadResult<()> {
    if content.classes[class].growth.is_none() {
        return Ok(());
    }
    let place = format!("class[{class}].growth");
    if !known.iter().any(|number| number.key == FAULT_SEVERITY) {
        let problem =
            "is of a fault without a severity that can be set; must be given by its severity, which grows";
        return Err(TomlError::new(place, "", problem).with_help(
            "write the class's fault as { kind = \"…\", severity = 0.5 }; a missing tooth cannot grow",
        ));
    }
    let of_fault = rules.iter().find_map(|(rule, place)| {
        let key = rule.keys.iter().find(|key| is_of_fault(key) && *key != FAULT_SEVERITY)?;
        Some((key, place))
    });
    if let Some((key, other)) = of_fault {
        let problem = format!("`{key}` would jump from record to record of a run, in which one damage grows");
        return Err(TomlError::new(other, "", problem)
            .with_help("give it in the class's fault, the same for all runs"));
    }
    let of_severity = |condition: &&Condition| {
        underlying(condition.keys()).into_iter().any(|key| key == SEVERITY || key == FAULT_SEVERITY)
    };
    let shifts = content.splits.shifts.iter().flat_map(|shift| &shift.when);
    if let Some(condition) = content.constraints.iter().chain(shifts).find(of_severity) {
        let problem =
            format!("has severities that `{condition}` would leave out; a run passes through all of them");
        return Err(TomlError::new(place, "", problem).with_help("leave out the condition, or the growth"));
    }
    match rules.iter().find(|(rule, _)| rule.keys.iter().any(|key| key == FAULT_SEVERITY)) {
        Some((_, other)) => {
            Err(TomlError::new(place, "", format!("sets `{FAULT_SEVERITY}`, which {other} varies too"))
                .with_help("remove one of the two"))
        }
        None => Ok(()),
    }
}

/// Constraints and conditions of shifts are about numbers that some class has.
fn check_conditions(content: &Content, classes: &[ClassRules]) -> ReadResult<()> {
    let varied = |key: &str| {
        let class_rules = content.classes.iter().flat_map(|class| &class.rules);
        content.rules.iter().chain(class_rules).any(|rule| rule.keys.iter().any(|own| own == key))
    };
    let check = |place: String, condition: &Condition| {
        for key in underlying(condition.keys()) {
            let known = || classes.iter().flat_map(|class| class.numbers.keys().map(String::as_str));
            if key != SEVERITY
                && !classes.iter().any(|class| class.knows(key))
                && !(is_of_plan(key) && varied(key))
            {
                return Err(no_such_number(&place, key, known()));
            }
        }
        let found =
            |key: &str| classes.iter().any(|class| fault_of_severity(key, &class.base.faults).is_some());
        let unvaried =
            !underlying(condition.keys()).iter().any(|key| *key == SEVERITY || varied(key) || found(key));
        if unvaried {
            let problem = format!("`{condition}` is about nothing that varies");
            return Err(TomlError::new(place, "", problem).with_help("vary one of its keys, or remove it"));
        }
        Ok(())
    };
    for (i, constraint) in content.constraints.iter().enumerate() {
        check(format!("constraints[{i}]"), constraint)?;
    }
    for (s, shift) in content.splits.shifts.iter().enumerate() {
        shift.when.iter().try_for_each(|condition| check(super::shift_key(s), condition))?;
    }
    Ok(())
}

/// Every measure of a severity is of numbers that its class has.
fn check_severities(content: &Content, classes: &[ClassRules]) -> ReadResult<()> {
    for (c, (class, rules)) in content.classes.iter().zip(classes).enumerate() {
        let crate::plan::Severity::Measured { measure, .. } = &class.severity else { continue };
        for key in underlying(measure.keys()) {
            if !rules.knows(key) {
                let place = format!("class[{c}].severity.measure");
                return Err(no_such_number(&place, key, rules.numbers.keys().map(String::as_str)));
            }
        }
    }
    Ok(())
}
