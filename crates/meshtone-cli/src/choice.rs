//! Options that take one of several named values.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

/// Name, help and meaning of a value.
pub type Choice<T> = (&'static str, &'static str, T);

/// Name of a value among `choices`.
pub fn name_of<T: PartialEq>(choices: &[Choice<T>], value: T) -> Option<&'static str> {
    choices.iter().find(|(.., choice)| *choice == value).map(|(name, ..)| *name)
}

/// Parser of an option that takes one of `choices`.
pub fn one_of<T: Copy + Send + Sync + 'static>(
    choices: &'static [Choice<T>],
) -> impl TypedValueParser<Value = T> {
    let values = choices.iter().map(|(name, help, _)| match *help {
        "" => PossibleValue::new(*name),
        help => PossibleValue::new(*name).help(help),
    });
    PossibleValuesParser::new(values).try_map(move |given| {
        let chosen = choices.iter().find(|(name, ..)| *name == given);
        chosen.map(|(.., value)| *value).ok_or("it is none of the possible values")
    })
}
