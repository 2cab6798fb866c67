//! Wheels of the base scenario, as a plan names them.

use std::fmt::{self, Debug, Formatter};

use meshtone::scenario::{Fault, Gearbox, GearboxFault, ScenarioForm, WheelName};
use meshtone_toml::{ReadResult, TomlTable};

/// A wheel of the base scenario.
#[derive(Clone, PartialEq, Eq)]
pub enum Wheel {
    /// The pinion or the gear of a pair.
    OfPair(WheelName),
    /// The wheel of this name of a gearbox.
    OfGearbox(String),
}

/// Shows the name. The text of a plan's hash consists of such texts, which must stay the same for a pair.
impl Debug for Wheel {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::OfPair(wheel) => wheel.fmt(formatter),
            Self::OfGearbox(name) => name.fmt(formatter),
        }
    }
}

impl Wheel {
    /// All wheels of a scenario, in order.
    ///
    /// # Arguments
    /// * `base` - the scenario
    pub fn all(base: &ScenarioForm) -> Vec<Self> {
        match base {
            ScenarioForm::Gearbox(Gearbox { wheels, .. }) => {
                wheels.iter().map(|wheel| Self::OfGearbox(wheel.name.clone())).collect()
            }
            _ => WheelName::BOTH.map(Self::OfPair).to_vec(),
        }
    }

    /// Its name in a plan.
    pub fn name(&self) -> &str {
        match self {
            Self::OfPair(wheel) => wheel.name(),
            Self::OfGearbox(name) => name,
        }
    }
}

/// The wheels over whose revolutions signals are averaged.
#[derive(Clone, PartialEq, Eq)]
pub enum AveragedWheels {
    /// One wheel: the columns of its average are called as they are.
    One(Wheel),
    /// Several: the names of each one's columns begin with its name.
    Each(Vec<Wheel>),
}

/// Shows the wheels, for the same reason as [`Wheel`] does.
impl Debug for AveragedWheels {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::One(wheel) => wheel.fmt(formatter),
            Self::Each(wheels) => wheels.fmt(formatter),
        }
    }
}

impl AveragedWheels {
    /// The wheels.
    pub fn all(&self) -> &[Wheel] {
        match self {
            Self::One(wheel) => std::slice::from_ref(wheel),
            Self::Each(wheels) => wheels,
        }
    }

    /// The names of the wheels, with commas between.
    pub fn names(&self) -> String {
        self.all().iter().map(Wheel::name).collect::<Vec<_>>().join(", ")
    }

    /// What the names of the columns of a wheel's average begin with.
    ///
    /// # Arguments
    /// * `wheel` - one of these
    pub(crate) fn prefix(&self, wheel: &Wheel) -> String {
        match self {
            Self::One(_) => String::new(),
            Self::Each(_) => format!("{}_", column_part(wheel.name())),
        }
    }
}

/// A wheel in words, after `the`: the pinion, the gear, the wheel z1.
///
/// # Arguments
/// * `name` - its name
pub(crate) fn wheel_words(name: &str) -> String {
    if WheelName::BOTH.iter().any(|wheel| wheel.name() == name) {
        name.to_owned()
    } else {
        format!("wheel {name}")
    }
}

/// A name as a part of a column's name: letters, digits and `_`.
pub(crate) fn column_part(name: &str) -> String {
    let allowed = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
    name.chars().map(allowed).collect()
}

/// A fault of a class, before its varied keys are drawn.
#[derive(Clone, PartialEq)]
pub struct ClassFault {
    /// The damaged wheel.
    pub wheel: Wheel,
    /// What is wrong with which of its teeth; on a gearbox the wheel that it names itself does not count.
    pub fault: Fault,
}

/// Shows the fault and, on a gearbox, its wheel, for the same reason as [`Wheel`] does.
impl Debug for ClassFault {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        match &self.wheel {
            Wheel::OfPair(_) => self.fault.fmt(formatter),
            Wheel::OfGearbox(name) => (name, &self.fault).fmt(formatter),
        }
    }
}

impl ClassFault {
    /// The faults of a scenario.
    ///
    /// # Arguments
    /// * `scenario` - of a record
    pub(crate) fn all_of(scenario: &ScenarioForm) -> Vec<Self> {
        match scenario {
            ScenarioForm::Pair(scenario) => scenario.faults.iter().cloned().map(Self::of_pair).collect(),
            ScenarioForm::Gearbox(gearbox) => gearbox.faults.iter().cloned().map(Self::of_gearbox).collect(),
        }
    }

    /// A fault of a pair.
    pub(crate) fn of_pair(fault: Fault) -> Self {
        Self { wheel: Wheel::OfPair(fault.wheel), fault }
    }

    /// A fault of a gearbox.
    pub(crate) fn of_gearbox(fault: GearboxFault) -> Self {
        Self { wheel: Wheel::OfGearbox(fault.wheel), fault: fault.fault }
    }

    /// Reads the faults of a class.
    ///
    /// # Arguments
    /// * `table` - the class
    /// * `base` - the scenario whose wheels are damaged
    pub(super) fn read_all(table: &TomlTable<'_>, base: &ScenarioForm) -> ReadResult<Vec<Self>> {
        let ScenarioForm::Gearbox(_) = base else {
            return Ok(Fault::list_from_table(table)?.into_iter().map(Self::of_pair).collect());
        };
        let faults: Vec<Self> =
            GearboxFault::list_from_table(table)?.into_iter().map(Self::of_gearbox).collect();
        let wheels = Wheel::all(base);
        match faults.iter().find(|fault| !wheels.contains(&fault.wheel)) {
            None => Ok(faults),
            Some(fault) => {
                let names: Vec<&str> = wheels.iter().map(Wheel::name).collect();
                let problem = format!(
                    "is on the wheel {:?}, which does not exist; must be one of {}",
                    fault.wheel.name(),
                    names.join(", ")
                );
                Err(table.error("fault", problem))
            }
        }
    }
}

/// The base with the faults of a class.
///
/// # Arguments
/// * `base` - healthy
/// * `faults` - of the class
pub(crate) fn with_faults(base: &ScenarioForm, faults: &[ClassFault]) -> ScenarioForm {
    let mut damaged = base.clone();
    match &mut damaged {
        ScenarioForm::Gearbox(gearbox) => {
            let of_gearbox = |ClassFault { wheel, fault }: &ClassFault| GearboxFault {
                wheel: wheel.name().to_owned(),
                fault: fault.clone(),
            };
            gearbox.faults = faults.iter().map(of_gearbox).collect();
        }
        ScenarioForm::Pair(scenario) => {
            scenario.faults = faults.iter().map(|fault| fault.fault.clone()).collect();
        }
    }
    damaged
}
