//! Wheels of the base scenario, as a plan names them.

use meshtone::scenario::{Scenario, WheelName};

/// A wheel of the base scenario, by its name: `pinion` or `gear` of a pair.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wheel(String);

impl From<WheelName> for Wheel {
    fn from(wheel: WheelName) -> Self {
        Self(wheel.name().to_owned())
    }
}

impl From<String> for Wheel {
    fn from(name: String) -> Self {
        Self(name)
    }
}

impl Wheel {
    /// All wheels of a scenario, in order.
    ///
    /// # Arguments
    /// * `base` - the scenario
    pub fn all(base: &Scenario) -> Vec<Self> {
        base.wheel_names().into_iter().map(|name| Self(name.to_owned())).collect()
    }

    /// Its name in a plan.
    pub fn name(&self) -> &str {
        &self.0
    }
}

/// The wheels over whose revolutions signals are averaged.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AveragedWheels {
    /// One wheel: the columns of its average are called as they are.
    One(Wheel),
    /// Several: the names of each one's columns begin with its name.
    Each(Vec<Wheel>),
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
