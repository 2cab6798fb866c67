//! Which of a wheel's teeth are damaged alike.

use std::fmt;

use meshtone_toml::{ReadResult, TomlValue};

use crate::error::ScenarioError;
use crate::keys::{Check, KeyKind, KeyValue, NumberFiles, Range, Written};

/// Which of a wheel's teeth a fault is on, by their numbers from 1 in the order in which the teeth enter contact.
///
/// It is written as in a scenario file:
///
/// ```
/// use meshtone::scenario::FaultyTeeth;
///
/// let teeth: FaultyTeeth = vec![1, 2, 9].into();
/// assert_eq!((teeth.to_string(), teeth.in_words()), ("[1, 2, 9]".into(), "teeth 1, 2 and 9".into()));
/// assert_eq!(FaultyTeeth::from(5), FaultyTeeth::from(vec![5]));
/// assert_eq!(FaultyTeeth::All.numbers(17).len(), 17);
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum FaultyTeeth {
    /// One.
    One(u32),
    /// Some, each named once.
    These(Vec<u32>),
    /// Every tooth of the wheel.
    All,
}

impl From<u32> for FaultyTeeth {
    fn from(tooth: u32) -> Self {
        Self::One(tooth)
    }
}

impl From<Vec<u32>> for FaultyTeeth {
    fn from(teeth: Vec<u32>) -> Self {
        match teeth[..] {
            [tooth] => Self::One(tooth),
            _ => Self::These(teeth),
        }
    }
}

impl fmt::Display for FaultyTeeth {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::One(tooth) => tooth.fmt(formatter),
            Self::These(teeth) => write!(formatter, "{teeth:?}"),
            Self::All => write!(formatter, "\"{ALL}\""),
        }
    }
}

/// What stands for every tooth.
const ALL: &str = "all";

impl FaultyTeeth {
    /// The teeth's numbers, in the order in which they are named.
    ///
    /// # Arguments
    /// * `teeth` - how many teeth the wheel has
    pub fn numbers(&self, teeth: u32) -> Vec<u32> {
        match self {
            Self::One(tooth) => vec![*tooth],
            Self::These(named) => named.clone(),
            Self::All => (1..=teeth).collect(),
        }
    }

    /// The same teeth where another one is the first.
    ///
    /// # Arguments
    /// * `first` - number of that tooth, from 0
    /// * `teeth` - how many teeth the wheel has
    pub(crate) fn counted_from(&self, first: usize, teeth: u32) -> Self {
        let first = u32::try_from(first).unwrap_or(0) % teeth.max(1);
        // A number that no tooth has stays, and is refused.
        let counted = |tooth: &u32| match tooth {
            1.. if *tooth <= teeth => (tooth - 1 + teeth - first) % teeth + 1,
            _ => *tooth,
        };
        match self {
            Self::One(tooth) => Self::One(counted(tooth)),
            Self::These(named) => Self::These(named.iter().map(counted).collect()),
            Self::All => Self::All,
        }
    }

    /// The number of the tooth, where it is one.
    pub fn only(&self) -> Option<u32> {
        match self {
            Self::One(tooth) => Some(*tooth),
            Self::These(_) | Self::All => None,
        }
    }

    /// The least of the numbers.
    pub fn first(&self) -> u32 {
        match self {
            Self::One(tooth) => *tooth,
            Self::These(named) => named.iter().copied().min().unwrap_or(1),
            Self::All => 1,
        }
    }

    /// Whether a tooth is among them.
    ///
    /// # Arguments
    /// * `tooth` - its number
    pub fn contains(&self, tooth: u32) -> bool {
        match self {
            Self::One(number) => *number == tooth,
            Self::These(named) => named.contains(&tooth),
            Self::All => true,
        }
    }

    /// What they are called: `tooth 5`, `teeth 1 and 2`, `all teeth`.
    pub fn in_words(&self) -> String {
        match self {
            Self::One(tooth) => format!("tooth {tooth}"),
            Self::All => "all teeth".to_owned(),
            Self::These(named) => {
                let numbers: Vec<String> = named.iter().map(u32::to_string).collect();
                match &numbers[..] {
                    [first @ .., last] if !first.is_empty() => {
                        format!("teeth {} and {last}", first.join(", "))
                    }
                    _ => format!("tooth {}", numbers.concat()),
                }
            }
        }
    }

    /// Whether the wheel has all of them, each is named once, and there is one at all. Their numbers start at 1.
    ///
    /// # Arguments
    /// * `teeth` - how many teeth the wheel has
    /// * `wheel` - what the wheel is called
    pub(super) fn check(&self, teeth: u32, wheel: &str) -> Check {
        let beyond = |key: String, tooth: u32| {
            let problem = format!("must be at most {teeth}, {wheel}'s teeth");
            Err(ScenarioError::new(key, tooth, problem))
        };
        match self {
            Self::One(tooth) if *tooth > teeth => beyond(KEY.to_owned(), *tooth),
            Self::One(_) | Self::All => Ok(()),
            Self::These(named) if named.is_empty() => {
                Err(ScenarioError::new(KEY, self, "must name at least one tooth")
                    .with_help("give a number, a list of numbers, or \"all\""))
            }
            Self::These(named) => named.iter().enumerate().try_for_each(|(place, &tooth)| {
                let key = format!("{KEY}[{place}]");
                if tooth > teeth {
                    return beyond(key, tooth);
                }
                match named[..place].contains(&tooth) {
                    true => Err(ScenarioError::new(key, tooth, "is named twice; must be named once")),
                    false => Ok(()),
                }
            }),
        }
    }
}

const KEY: &str = "fault.tooth";

impl KeyValue for FaultyTeeth {
    fn read(&mut self, value: &TomlValue<'_>, files: &dyn NumberFiles) -> ReadResult<()> {
        let number = |value: &TomlValue<'_>| {
            let mut tooth = 0;
            KeyValue::read(&mut tooth, value, files).map(|()| tooth)
        };
        *self = if value.is_array() {
            value.array()?.iter().map(number).collect::<ReadResult<Vec<u32>>>()?.into()
        } else if value.is_text() {
            value.one_of(&[ALL]).map(|_| Self::All)?
        } else if value.is_whole() {
            Self::One(number(value)?)
        } else {
            return Err(value.wrong_type("a whole number, an array of them or \"all\""));
        };
        Ok(())
    }

    fn write(&self) -> Written {
        Written::Value(self.to_string())
    }

    fn check(&self, key: &str, range: &Range, unit: &str) -> Check {
        match self {
            Self::One(tooth) => KeyValue::check(tooth, key, range, unit),
            Self::These(named) => named.iter().enumerate().try_for_each(|(place, tooth)| {
                KeyValue::check(tooth, &format!("{key}[{place}]"), range, unit)
            }),
            Self::All => Ok(()),
        }
    }

    fn kind() -> KeyKind {
        KeyKind::Teeth
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_wheel_has_not_is_named() {
        let refused = |teeth: FaultyTeeth| teeth.check(17, "the pinion").unwrap_err().to_string();
        assert_eq!(refused(18.into()), "fault.tooth = 18: must be at most 17, the pinion's teeth");
        assert_eq!(
            refused(vec![1, 18].into()),
            "fault.tooth[1] = 18: must be at most 17, the pinion's teeth"
        );
        assert_eq!(refused(vec![4, 2, 4].into()), "fault.tooth[2] = 4: is named twice; must be named once");
        assert!(refused(Vec::new().into()).starts_with("fault.tooth = []: must name at least one tooth"));
        assert!(FaultyTeeth::All.check(17, "the pinion").is_ok());
    }
}
