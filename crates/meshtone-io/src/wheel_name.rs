//! Which wheel a file names.

use meshtone::scenario::WheelName;
use meshtone_toml::{ReadResult, TomlValue};

/// Reads the name of a wheel, `"pinion"` or `"gear"`.
///
/// # Arguments
/// * `value` - of the key
///
/// # Errors
/// Another name.
pub fn read_wheel(value: &TomlValue<'_>) -> ReadResult<WheelName> {
    value.choice(&WheelName::BOTH.map(|wheel| (wheel.name(), wheel)))
}
