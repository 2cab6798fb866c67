//! The table `[split]`.

use meshtone_toml::{ReadResult, TomlTable, TomlValue};

use super::super::{Shift, SplitBy, Splits};
use super::{conditions, fraction, over_zero};

/// Deviation of a sum of parts from 1 that is rounding.
const ROUNDING: f64 = 1e-9;

pub(super) fn read(table: &TomlTable<'_>) -> ReadResult<Splits> {
    let by = table.read_optional("by", |value| value.choice(&SplitBy::NAMES))?.unwrap_or_default();
    let parts = Splits::ALIKE.map(|name| table.optional(name));
    let shifts = table.read_optional("shift", shifts)?.unwrap_or_default();
    let mut numbers = [0.0; 3];
    for (number, value) in numbers.iter_mut().zip(&parts) {
        *number = value.as_ref().map_or(Ok(0.0), part)?;
    }
    let sum: f64 = numbers.iter().sum::<f64>() + shifts.iter().map(|shift| shift.part).sum::<f64>();
    let where_reported = parts.iter().rposition(Option::is_some).map_or("shift", |last| Splits::ALIKE[last]);
    let refuse = |help: &str| {
        let problem = format!("the parts of all splits add up to {sum}; must be 1");
        Err(table.error(where_reported, problem).with_help(help))
    };
    if sum > 1.0 + ROUNDING {
        return refuse("parts are fractions of what `by` names: units, or mountings");
    }
    if parts[2].is_none() {
        // The test gets what is left.
        let left = 1.0 - sum;
        numbers[2] = if left < ROUNDING { 0.0 } else { left };
    } else if sum < 1.0 - ROUNDING {
        return refuse("leave out test: it is then what is left");
    }
    Ok(Splits { by, parts: numbers, shifts })
}

fn part(value: &TomlValue<'_>) -> ReadResult<f64> {
    fraction(value, "must be from 0 to 1, a part of the units or mountings")
}

fn shifts(listed: &TomlValue<'_>) -> ReadResult<Vec<Shift>> {
    let mut shifts: Vec<Shift> = Vec::new();
    for value in listed.array()? {
        let shift = value.table()?.read(|table| {
            let name = table.required("name", "the split's name in the column split")?;
            let text = name.string()?;
            let allowed = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
            if text.is_empty() || !text.chars().all(allowed) {
                return Err(name.error("must be letters, digits, - and _"));
            }
            // The data card declares names with _ for -, because Hugging Face's names of splits are words.
            let word = |name: &str| name.replace('-', "_");
            let mut others = Splits::ALIKE.into_iter().chain(shifts.iter().map(|shift| shift.name.as_str()));
            if others.any(|other| word(other) == word(text)) {
                return Err(name.error("is the name of another split; - and _ count as the same"));
            }
            let share =
                table.required("part", "the part of the units, or mountings, that is this split's")?;
            let number = part(&share).and_then(|_| over_zero(&share, "must be more than 0"))?;
            let when = table.required("when", "what holds for its records and for no other: a condition")?;
            let when_read = conditions(&when)?;
            if when_read.is_empty() {
                return Err(when.error("is empty; must be a condition or several"));
            }
            Ok(Shift { name: text.to_owned(), part: number, when: when_read })
        })?;
        shifts.push(shift);
    }
    Ok(shifts)
}
