//! Wheels of the base scenario, as a plan names them.

use meshtone::scenario::WheelName;

/// The wheels over whose revolutions signals are averaged, by their names: `pinion` or `gear` of a pair.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AveragedWheels {
    /// One wheel: the columns of its average are called as they are.
    One(String),
    /// Several: the names of each one's columns begin with its name.
    Each(Vec<String>),
}

impl AveragedWheels {
    /// The wheels.
    pub fn all(&self) -> &[String] {
        match self {
            Self::One(wheel) => std::slice::from_ref(wheel),
            Self::Each(wheels) => wheels,
        }
    }

    /// The names of the wheels, with commas between.
    pub fn names(&self) -> String {
        self.all().join(", ")
    }

    /// What the names of the columns of a wheel's average begin with.
    ///
    /// # Arguments
    /// * `wheel` - one of these
    pub(crate) fn prefix(&self, wheel: &str) -> String {
        match self {
            Self::One(_) => String::new(),
            Self::Each(_) => format!("{}_", column_part(wheel)),
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
