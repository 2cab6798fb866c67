//! Checks the rules of a plan against each other and against the scenario, and puts them in the order in which they are drawn.

use std::collections::BTreeMap;

use meshtone::scenario::{
    KeyKind, ScenarioNumber, gearbox_sections, key_of_both_wheels, sections, split_key,
};
use meshtone_io::scenario_file::ReadScenarioError;
use meshtone_toml::{ReadResult, TomlError, nearest_name};

use super::values::{SEVERITY, fault_of_severity};
use super::{
    CLASSES, FAULT_SEVERITY, NOISE_KEYS, ORDER, PATH_KEYS, SPLITS, Sampler, design_seed, is_of_plan,
    shift_key,
};
use crate::error::DatasetError;
use crate::expression::{Condition, Expression, derived_names, underlying};
use crate::plan::{
    Content, FaultyBase, Level, Plan, Rule, Severity, SplitBy, kinds, list_and_entry, overlap, refused,
};

/// Keys that cannot be varied, and why.
const OWN: [(&str, &str); 3] = [
    ("seed", "every record has a seed of its own"),
    ("quality.seed", "every unit has wheels of its own"),
    ("wheels_seed", "every unit has wheels of its own"),
];

/// The scenario and the rules by which the records of a class are drawn.
#[derive(Debug, Clone)]
pub(super) struct ClassRules<'a> {
    /// The base scenario with the class's faults.
    pub base: FaultyBase,
    /// All numbers of that scenario by their keys.
    pub numbers: BTreeMap<String, f64>,
    /// Rules for records. Rules that others depend on come first.
    pub rules: Vec<&'a Rule>,
}

impl ClassRules<'_> {
    /// Returns whether the scenarios of the class's records have a number at a key, or one that is computed from others.
    fn knows(&self, key: &str) -> bool {
        self.numbers.contains_key(key) || self.computes_severity(key)
    }

    /// Returns whether a key is the severity of a fault that is given by its sizes or otherwise.
    fn computes_severity(&self, key: &str) -> bool {
        fault_of_severity(key, self.base.places.len()).is_some()
    }
}

/// A rule and its key in the plan.
type Placed<'a> = (&'a Rule, String);

impl<'a> Sampler<'a> {
    /// Checks the rules, constraints, shifts and severities of a plan, and prepares the drawing of its records.
    ///
    /// # Arguments
    /// * `content` - of the plan
    ///
    /// # Errors
    /// Rules that contradict each other or the scenario, by their keys in the plan.
    pub fn new(content: &'a Content) -> ReadResult<Self> {
        let classes = (0..content.classes.len()).map(|class| class_rules(content, class));
        let classes = classes.collect::<ReadResult<Vec<_>>>()?;
        check_top(content, &classes)?;
        let of_groups = content.top_rules().filter(|(rule, _)| rule.level != Level::Record);
        let group_rules = in_order(&of_groups.collect::<Vec<Placed>>(), &content.base.settable_numbers())?;
        let level = |condition| level_of(condition, content);
        let constraints = content.constraints.iter().map(|condition| (level(condition), condition)).collect();
        let shift_levels: Vec<Vec<Level>> =
            content.splits.shifts.iter().map(|shift| shift.when.iter().map(level).collect()).collect();
        refuse_unit_shifts(content, &shift_levels)?;
        check_conditions(content, &classes)?;
        check_severities(content, &classes)?;
        let counts = || content.classes.iter().map(|class| class.count);
        let ends = (1..=content.classes.len()).map(|last| counts().take(last).sum()).collect();
        let split_counts = content.splits.counts(content.divided());
        let order_seeds = [ORDER, SPLITS].map(|index| design_seed(content, index));
        let of_class = |class: u64| [0, 1].map(|which| design_seed(content, CLASSES + 2 * class + which));
        let class_seeds = (0..content.classes.len() as u64).map(of_class).collect();
        Ok(Self {
            content,
            group_rules,
            classes,
            ends,
            split_counts,
            order_seeds,
            class_seeds,
            constraints,
            shift_levels,
        })
    }

    /// As [`Self::new`], of a plan that was read: an error is one of its file.
    pub(crate) fn of_plan(plan: &'a Plan) -> Result<Self, DatasetError> {
        Self::new(&plan.content).map_err(|error| {
            let path = plan.sources.first().cloned().unwrap_or_default();
            let text = plan.files.first().map(|file| file.text.clone()).unwrap_or_default();
            DatasetError::Plan(ReadScenarioError::Invalid { path, text, error: Box::new(error) })
        })
    }
}

/// Checks the rules that concern a class, and puts those for its records in order.
fn class_rules(content: &Content, class: usize) -> ReadResult<ClassRules<'_>> {
    let base = FaultyBase::new(&content.base, &content.classes[class].faults);
    let known = base.numbers();
    let mut own = content.class_rules(class);
    if let Some((rule, place)) = own.find(|(rule, _)| rule.level != Level::Record) {
        let problem = format!("varies by {}; a rule of a class varies by record", rule.level.name());
        return Err(refused(place, problem, "move it to the top as [[vary]], or write per = \"record\""));
    }
    // A rule at the top concerns the classes whose faults have its keys.
    let has = |key: &String| is_of_plan(key) || find(&known, key).is_some();
    let concerned = content.top_rules().filter(|(rule, _)| rule.keys.iter().all(has));
    let rules: Vec<Placed> = concerned.chain(content.class_rules(class)).collect();
    check_keys(&rules, &known, content, class)?;
    check_growth(content, class, &rules, &known)?;
    let mut rules = in_order(&rules, &known)?;
    rules.retain(|rule| rule.level == Level::Record);
    let numbers = known.into_iter().map(|number| (number.key, number.value)).collect();
    Ok(ClassRules { base, numbers, rules })
}

fn find<'n>(known: &'n [ScenarioNumber], key: &str) -> Option<&'n ScenarioNumber> {
    known.iter().find(|number| number.key == key)
}

fn keys(known: &[ScenarioNumber]) -> impl Iterator<Item = &str> {
    known.iter().map(|number| number.key.as_str())
}

/// Returns whether a key is a fault's: `fault.…`, or of several `fault[1].…`.
fn is_of_fault(key: &str) -> bool {
    key.starts_with("fault.") || key.starts_with("fault[")
}

/// Returns whether a key is one of the teeth or of their material, which make a unit what it is.
fn is_of_wheels(key: &str) -> bool {
    const OF_TEETH: [&str; 4] = ["module_mm", "pressure_angle_deg", "helix_angle_deg", "lead_crowning_um"];
    let (section, rest) = split_key(key);
    match list_and_entry(section).0 {
        "gears" | "quality" | "material" | "wheel" => true,
        "mesh" => rest.is_some_and(|rest| OF_TEETH.contains(&rest) || rest.starts_with("end_relief.")),
        _ => false,
    }
}

/// An error about a key that a rule varies.
fn refuse_key((rule, place): &Placed, key: &str, problem: impl Into<String>) -> TomlError {
    let named = if rule.keys.len() == 1 { "key" } else { "keys" };
    TomlError::new(format!("{place}.{named}"), format!("{key:?}"), problem)
}

/// Checks that all keys exist, are varied once each, and suit their level.
///
/// A key that is varied twice would have two values, and one that differs within a unit would give one pair of wheels several shapes. The
/// first problem is reported at its rule, so that a user finds it in the plan.
fn check_keys(rules: &[Placed], known: &[ScenarioNumber], content: &Content, class: usize) -> ReadResult<()> {
    let mut seen: Vec<(&str, &str)> = Vec::new();
    for placed in rules {
        let (rule, place) = placed;
        let refuse = |key: &str, problem: String| refuse_key(placed, key, problem);
        let level = rule.level.name();
        for (column, key) in rule.keys.iter().enumerate() {
            if let Some((_, why)) = OWN.iter().find(|(own, _)| own == key) {
                return Err(refuse(key, format!("cannot be varied: {why}")));
            }
            if let Some((seen, other)) = seen.iter().find(|(seen, _)| overlap(seen, key)) {
                return Err(refuse(key, format!("`{seen}` is varied by {other} too; must be varied once")));
            }
            seen.push((key, place));
            if is_of_plan(key) {
                let is_noise = |key: &str| NOISE_KEYS.contains(&key);
                if is_noise(key) && seen.iter().filter(|(seen, _)| is_noise(seen)).count() > 1 {
                    let problem = "noise is given both relative and in g; give one of the two";
                    return Err(refuse(key, problem.to_owned()));
                }
                continue;
            }
            let Some(number) = find(known, key) else {
                return Err(unknown(placed, key, known, content, Some(class)));
            };
            if number.whole && !draws_whole_numbers(rule, column) {
                let problem = format!("`{key}` is a whole number, but what is drawn for it is not");
                return Err(refuse(key, problem).with_help("use choice or grid with whole numbers"));
            }
            if is_of_wheels(key) && rule.level != Level::Unit {
                let problem =
                    format!("`{key}` would differ between {level}s of one unit, which share their wheels");
                let help = "leave out per: it is \"unit\" for keys of wheels";
                return Err(refuse(key, problem).with_help(help));
            }
            if is_of_fault(key) && rule.level != Level::Record {
                let problem = format!("`{key}` varies by {level}; faults vary by record");
                return Err(refuse(key, problem).with_help("leave out per"));
            }
        }
    }
    Ok(())
}

fn draws_whole_numbers(rule: &Rule, column: usize) -> bool {
    let rows = rule.distribution.rows();
    rule.times.is_none()
        && rule.plus.is_none()
        && !rows.is_empty()
        && rows.iter().all(|row| row[column].fract() == 0.0)
}

/// The error of a key that is no number of the scenario.
///
/// # Arguments
/// * `class` - whose scenario it is; none for the base
fn unknown(
    placed: &Placed,
    key: &str,
    known: &[ScenarioNumber],
    content: &Content,
    class: Option<usize>,
) -> TomlError {
    let faults = class.map_or(&[][..], |class| &content.classes[class].faults);
    let fault = kinds(faults).unwrap_or_else(|| format!("a healthy {}", content.base.words().nouns[0]));
    let problem = format!("`{key}` is no number of the scenario ({fault}), so it cannot be varied");
    let error = refuse_key(placed, key, problem);
    if fault_of_severity(key, faults.len()).is_some() {
        return error.with_help("write the fault with severity = … in place of its sizes");
    }
    if let Some(own) = keys(known).find(|own| key_of_both_wheels(own).as_deref() == Some(key)) {
        return error.with_help(format!("the wheels differ in it: vary `{own}`, or that of the mate"));
    }
    if let Some(default) = computed_default(key, known, content) {
        return error
            .with_help(format!("it is left out (default: {default}); state it in the scenario to vary it"));
    }
    error.with_help(match nearest_name(key, keys(known).chain(NOISE_KEYS).chain(PATH_KEYS)) {
        Some(nearest) => meant(key, nearest),
        None => {
            "`meshtone init KIND --all` prints every key of a kind of fault; sections are part of a key, as in \
             `operation.pinion_speed_hz`"
                .to_owned()
        }
    })
}

/// The default, in words, of a number that the scenario leaves out of one of its sections; none where the key is no such number.
fn computed_default(key: &str, known: &[ScenarioNumber], content: &Content) -> Option<String> {
    let (section, key) = split_key(key);
    if section == "fault" || !keys(known).any(|known| split_key(known).0 == section) {
        return None;
    }
    let described = if content.base.rig().is_some() { sections() } else { gearbox_sections() };
    let of_section = described.into_iter().filter(|of| of.name == list_and_entry(section).0);
    let number = of_section.flat_map(|of| of.keys).find(|of| Some(of.key.as_str()) == key)?;
    matches!(number.kind, KeyKind::Number | KeyKind::Whole).then_some(number.default)
}

/// Checks that every rule at the top concerns some class.
fn check_top(content: &Content, classes: &[ClassRules]) -> ReadResult<()> {
    for placed in content.top_rules() {
        let rule_keys = &placed.0.keys;
        let has = |class: &ClassRules, key: &String| is_of_plan(key) || class.numbers.contains_key(key);
        if classes.iter().any(|class| rule_keys.iter().all(|key| has(class, key))) {
            continue;
        }
        let is_nowhere = |key: &&String| !classes.iter().any(|class| has(class, key));
        let key = rule_keys.iter().find(is_nowhere).unwrap_or(&rule_keys[0]);
        let mut known = content.base.settable_numbers();
        known.extend(classes.iter().flat_map(|class| class.base.numbers()));
        return Err(unknown(&placed, key, &known, content, None));
    }
    Ok(())
}

/// Puts the rules in an order in which each comes after those that it depends on.
fn in_order<'a>(rules: &[Placed<'a>], known: &[ScenarioNumber]) -> ReadResult<Vec<&'a Rule>> {
    let keys_of = |term: &'a Option<Expression>| underlying(term.iter().flat_map(Expression::keys));
    for (rule, place) in rules {
        for (name, term) in [("times", &rule.times), ("plus", &rule.plus)] {
            for key in keys_of(term) {
                check_dependency(rule, &format!("{place}.{name}"), key, rules, known)?;
            }
        }
    }
    let mut waiting: Vec<&Placed> = rules.iter().collect();
    let mut ordered: Vec<&'a Rule> = Vec::with_capacity(rules.len());
    while !waiting.is_empty() {
        let is_ready = |(rule, _): &&Placed<'a>| {
            let mut depends_on = [&rule.times, &rule.plus].into_iter().flat_map(keys_of);
            !depends_on.any(|key| waiting.iter().any(|(other, _)| other.varies(key)))
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

/// Checks that a rule depends only on numbers that exist, and that are the same for all that it draws for.
fn check_dependency(
    rule: &Rule,
    place: &str,
    key: &str,
    rules: &[Placed],
    known: &[ScenarioNumber],
) -> ReadResult<()> {
    let varied = rules.iter().find(|(other, _)| other.varies(key));
    if varied.is_none() && find(known, key).is_none() {
        return Err(no_such_number(place, key, keys(known)));
    }
    if let Some((varied, other)) = varied.filter(|(other, _)| rule.level < other.level) {
        let (by, own) = (varied.level.name(), rule.level.name());
        let problem = format!("depends on `{key}`, which {other} varies by {by}; what a {own} has cannot");
        return Err(TomlError::new(place, "", problem));
    }
    Ok(())
}

/// Proposes the key that is meant. To a user who writes revolutions per minute it says how to convert the values.
fn meant(key: &str, nearest: &str) -> String {
    let by_minute = key.ends_with("rpm") && nearest.ends_with("_hz");
    let unit =
        if by_minute { " Its values are revolutions per second, a sixtieth of those per minute" } else { "" };
    format!("did you mean `{nearest}`?{unit}")
}

fn no_such_number<'n>(place: &str, key: &str, known: impl Iterator<Item = &'n str>) -> TomlError {
    let others = derived_names().chain([SEVERITY]).map(|name| -> &'n str { name });
    let help = match nearest_name(key, known.chain(others)) {
        Some(nearest) => &meant(key, nearest),
        None => "sections are part of a key, as in `gears.module_mm`",
    };
    refused(place, format!("`{key}` is no number of the scenario"), help)
}

/// The level whose values decide a condition: a unit or a mounting, if all numbers in the condition are the same for all records of
/// one, otherwise a record.
fn level_of(condition: &Condition, content: &Content) -> Level {
    let level = |key: &str| {
        if key == SEVERITY || is_of_fault(key) {
            return Level::Record;
        }
        let rules = content.all_rules().filter(|rule| rule.varies(key));
        rules.map(|rule| rule.level).max().unwrap_or(Level::Unit)
    };
    underlying(condition.keys()).into_iter().map(level).max().unwrap_or(Level::Unit)
}

/// Refuses shifts by what a unit has, if mountings are divided: the mountings of a unit may be in several splits.
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
            let help = "leave out split.by, or vary its keys per mounting or record";
            return Err(refused(shift_key(s), problem, help));
        }
    }
    Ok(())
}

/// Checks that a damage that grows is given by its severity, which nothing else varies.
fn check_growth(
    content: &Content,
    class: usize,
    rules: &[Placed],
    known: &[ScenarioNumber],
) -> ReadResult<()> {
    if content.classes[class].growth.is_none() {
        return Ok(());
    }
    let place = format!("class[{class}].growth");
    if find(known, FAULT_SEVERITY).is_none() {
        let problem =
            "is of a fault without a severity that can be set; must be given by its severity, which grows";
        let help = "write the class's fault as { kind = \"…\", severity = 0.5 }; a missing tooth cannot grow";
        return Err(refused(place, problem, help));
    }
    let of_fault = rules.iter().find_map(|(rule, place)| {
        let key = rule.keys.iter().find(|key| is_of_fault(key) && *key != FAULT_SEVERITY)?;
        Some((key, place))
    });
    if let Some((key, other)) = of_fault {
        let problem = format!("`{key}` would jump from record to record of a run, in which one damage grows");
        return Err(refused(other, problem, "give it in the class's fault, the same for all runs"));
    }
    let of_severity = |condition: &&Condition| {
        underlying(condition.keys()).into_iter().any(|key| key == SEVERITY || key == FAULT_SEVERITY)
    };
    let shifts = content.splits.shifts.iter().flat_map(|shift| &shift.when);
    if let Some(condition) = content.constraints.iter().chain(shifts).find(of_severity) {
        let problem =
            format!("has severities that `{condition}` would leave out; a run passes through all of them");
        return Err(refused(place, problem, "leave out the condition, or the growth"));
    }
    if let Some((_, other)) = rules.iter().find(|(rule, _)| rule.varies(FAULT_SEVERITY)) {
        let problem = format!("sets `{FAULT_SEVERITY}`, which {other} varies too");
        return Err(refused(place, problem, "remove one of the two"));
    }
    Ok(())
}

/// Checks that constraints and conditions of shifts are about numbers that some class has, and that vary.
fn check_conditions(content: &Content, classes: &[ClassRules]) -> ReadResult<()> {
    let is_varied = |key: &str| content.all_rules().any(|rule| rule.varies(key));
    let constraints = content.constraints.iter().enumerate();
    let constraints = constraints.map(|(i, condition)| (format!("constraints[{i}]"), condition));
    let shifts = content.splits.shifts.iter().enumerate();
    let shifts =
        shifts.flat_map(|(s, shift)| shift.when.iter().map(move |condition| (shift_key(s), condition)));
    for (place, condition) in constraints.chain(shifts) {
        let keys = underlying(condition.keys());
        let is_known = |key: &str| {
            key == SEVERITY
                || classes.iter().any(|class| class.knows(key))
                || (is_of_plan(key) && is_varied(key))
        };
        if let Some(key) = keys.iter().find(|key| !is_known(key)) {
            let known = classes.iter().flat_map(|class| class.numbers.keys().map(String::as_str));
            return Err(no_such_number(&place, key, known));
        }
        let varies = |key: &str| {
            key == SEVERITY || is_varied(key) || classes.iter().any(|class| class.computes_severity(key))
        };
        if !keys.iter().any(|key| varies(key)) {
            let problem = format!("`{condition}` concerns nothing that varies");
            return Err(refused(place, problem, "vary one of its keys, or remove it"));
        }
    }
    Ok(())
}

/// Checks that every severity is measured by numbers that its class has.
fn check_severities(content: &Content, classes: &[ClassRules]) -> ReadResult<()> {
    for (c, (class, rules)) in content.classes.iter().zip(classes).enumerate() {
        let Severity::Measured { measure, .. } = &class.severity else { continue };
        if let Some(key) = underlying(measure.keys()).iter().find(|key| !rules.knows(key)) {
            let place = format!("class[{c}].severity.measure");
            return Err(no_such_number(&place, key, rules.numbers.keys().map(String::as_str)));
        }
    }
    Ok(())
}
