//! The faults of a class: damaged teeth and spalls of rolling bearings, and where the scenarios of its records have them.

use meshtone::scenario::{
    BearingDefect, Fault, NumberedScenario, Scenario, ScenarioError, ScenarioNumber, names_or_numbers,
};
use meshtone_toml::{ReadResult, TomlTable};

use crate::draw::is_of_plan;

/// A fault of a class, before its varied keys are drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum ClassFault {
    /// Damage to teeth.
    Teeth(Fault),
    /// A spall of a rolling bearing of a gearbox.
    Bearing {
        /// Name of the bearing, as it stands in the brackets of its keys: `input:0`.
        bearing: String,
        /// The spall.
        defect: BearingDefect,
    },
}

impl ClassFault {
    /// Its kind of damage, as the columns of records have it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Teeth(of) => of.damage.kind(),
            Self::Bearing { defect, .. } => defect.race.kind(),
        }
    }

    /// The damage to teeth; none of a bearing's.
    pub(crate) fn teeth(&self) -> Option<&Fault> {
        match self {
            Self::Teeth(of) => Some(of),
            Self::Bearing { .. } => None,
        }
    }

    /// Reads the faults of a class.
    ///
    /// # Arguments
    /// * `table` - the class
    /// * `base` - the scenario whose wheels and bearings are damaged
    pub(super) fn read_all(table: &TomlTable<'_>, base: &Scenario) -> ReadResult<Vec<Self>> {
        let read = |of: &TomlTable<'_>| match base.rig() {
            Some(_) => Fault::from_table(of).map(Self::Teeth),
            None if of.optional("bearing").is_some() => Self::of_bearing(of, base),
            None => Fault::on_named_wheel(of).map(Self::Teeth),
        };
        let faults: Vec<Self> =
            table.tables("fault")?.into_iter().map(|of| of.read(read)).collect::<Result<_, _>>()?;
        let names = base.wheel_names();
        match faults.iter().filter_map(Self::teeth).find(|fault| !names.contains(&fault.wheel.as_str())) {
            None => Ok(faults),
            Some(fault) => {
                let problem = format!(
                    "is on the wheel {:?}, which does not exist; must be one of {}",
                    fault.wheel,
                    names.join(", ")
                );
                Err(table.error("fault", problem))
            }
        }
    }

    /// Reads a spall of a bearing.
    fn of_bearing(table: &TomlTable<'_>, gearbox: &Scenario) -> ReadResult<Self> {
        let value =
            table.required("bearing", "the name of the damaged bearing: its shaft and place, as input:0")?;
        let (bearing, names) = (value.string()?.to_owned(), bearing_names(gearbox));
        let Some(number) = names.iter().position(|name| *name == bearing) else {
            return Err(value.error(format!("does not exist; must be one of {}", names.join(", "))));
        };
        if gearbox.bearings()[number].element().is_none() {
            let help = format!(
                "set kind = \"ball\" or kind = \"roller\" of bearing[{bearing}] of the base scenario"
            );
            return Err(value.error("is a linear bearing, without balls or rollers").with_help(help));
        }
        Ok(Self::Bearing { bearing, defect: BearingDefect::from_table(table)? })
    }
}

/// The names of a gearbox's bearings in the keys of a plan: shaft and place, or the number where two are at one place.
fn bearing_names(gearbox: &Scenario) -> Vec<String> {
    let seats: Vec<Option<String>> =
        gearbox.bearings().iter().map(|bearing| Some(bearing.seat_name())).collect();
    names_or_numbers(&seats)
}

/// The base with the faults of a class.
///
/// # Arguments
/// * `base` - healthy
/// * `faults` - of the class
pub(crate) fn with_faults(base: &Scenario, faults: &[ClassFault]) -> Scenario {
    FaultyBase::new(base, faults).numbered.scenario().clone()
}

/// Where the scenario of a record has a fault of its class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FaultPlace {
    /// The number among the faults of teeth.
    Teeth(usize),
    /// Numbers of a bearing, and of the spall among all that it has.
    Spall { bearing: usize, number: usize },
}

/// The base scenario with the faults of a class.
///
/// The keys of a fault begin with `fault`, or of several with `fault[1]`, whatever part of the machine has it; in the scenario those of a spall
/// are its bearing's.
#[derive(Debug, Clone)]
pub(crate) struct FaultyBase {
    /// The scenario.
    pub numbered: NumberedScenario,
    /// Where it has each fault.
    pub places: Vec<FaultPlace>,
    /// The beginnings of each fault's keys in the plan and in the scenario.
    sections: Vec<[String; 2]>,
}

impl FaultyBase {
    /// Puts faults into the base scenario.
    ///
    /// # Arguments
    /// * `base` - in which no tooth is damaged; spalls that it has are no faults of the class
    /// * `faults` - of the class
    pub fn new(base: &Scenario, faults: &[ClassFault]) -> Self {
        let mut scenario = base.clone();
        scenario.faults.clear();
        let names = bearing_names(&scenario);
        let places: Vec<FaultPlace> =
            faults.iter().filter_map(|fault| put_into(&mut scenario, &names, fault)).collect();
        let sections = sections(&scenario, &places);
        Self { numbered: NumberedScenario::new(scenario), places, sections }
    }

    /// All numbers of the scenario, by the plan's keys.
    pub fn numbers(&self) -> Vec<ScenarioNumber> {
        let mut numbers = self.numbered.scenario().settable_numbers();
        for number in &mut numbers {
            number.key = renamed(&number.key, self.sections.iter().map(|[plan, scenario]| [scenario, plan]));
        }
        numbers
    }

    /// The scenario with the values of a record; those of keys of the plan alone are left out.
    ///
    /// # Arguments
    /// * `values` - by the plan's keys
    ///
    /// # Errors
    /// Values that the scenario does not allow.
    pub fn with_values(&self, values: &[(String, f64)]) -> Result<Scenario, ScenarioError> {
        let of_scenario = values.iter().filter(|(key, _)| !is_of_plan(key));
        let sections = || self.sections.iter().map(|[plan, scenario]| [plan, scenario]);
        let renamed: Vec<(String, f64)> =
            of_scenario.map(|(key, value)| (renamed(key, sections()), *value)).collect();
        let numbers: Vec<(&str, f64)> = renamed.iter().map(|(key, value)| (key.as_str(), *value)).collect();
        self.numbered.with_numbers(&numbers)
    }

    /// (-) How severe each fault is in a scenario of [`Self::with_values`]; none where that cannot be.
    pub fn severities(&self, scenario: &Scenario) -> Option<Vec<f64>> {
        let of_teeth = scenario.fault_severities().ok()?;
        let severity = |place: &FaultPlace| match *place {
            FaultPlace::Teeth(number) => of_teeth.get(number).copied(),
            FaultPlace::Spall { bearing, number } => {
                let parts = scenario.bearings().get(bearing)?.rolling().ok()??;
                parts.spalls.get(number).map(|spall| spall.severity)
            }
        };
        self.places.iter().map(severity).collect()
    }
}

/// Puts a fault into a gearbox. Returns where; none of a bearing that there is not.
fn put_into(gearbox: &mut Scenario, bearings: &[String], fault: &ClassFault) -> Option<FaultPlace> {
    match fault {
        ClassFault::Teeth(fault) => {
            gearbox.faults.push(fault.clone());
            Some(FaultPlace::Teeth(gearbox.faults.len() - 1))
        }
        ClassFault::Bearing { bearing, defect } => {
            let bearing = bearings.iter().position(|name| name == bearing)?;
            let defects = &mut gearbox.bearings_mut()[bearing].defect;
            defects.push(defect.clone());
            Some(FaultPlace::Spall { bearing, number: defects.len() - 1 })
        }
    }
}

/// The beginnings of the keys of faults in the plan and in the scenario.
fn sections(scenario: &Scenario, places: &[FaultPlace]) -> Vec<[String; 2]> {
    let of_list = |number: usize, entries: usize| match entries {
        1 => "fault".to_owned(),
        _ => format!("fault[{number}]"),
    };
    let of_scenario = |place: &FaultPlace| match *place {
        FaultPlace::Spall { bearing, number } => {
            format!("bearing[{}].defect[{number}]", bearing_names(scenario)[bearing])
        }
        FaultPlace::Teeth(number) => of_list(number, scenario.faults.len()),
    };
    let both = |(number, place)| [of_list(number, places.len()), of_scenario(place)];
    places.iter().enumerate().map(both).collect()
}

/// A key whose beginning is replaced.
///
/// # Arguments
/// * `key` - dotted
/// * `sections` - beginnings, each with what stands in place of it
fn renamed<'s>(key: &str, sections: impl Iterator<Item = [&'s String; 2]>) -> String {
    let replaced = |[old, new]: [&String; 2]| {
        let rest = key.strip_prefix(old.as_str())?.strip_prefix('.')?;
        Some(format!("{new}.{rest}"))
    };
    { sections }.find_map(replaced).unwrap_or_else(|| key.to_owned())
}
