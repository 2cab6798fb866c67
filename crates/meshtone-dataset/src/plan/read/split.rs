//! The table `[split]`.

use meshtone_toml::{ReadResult, TomlTable, TomlValue};

use super::super::{Shift, SplitBy, Splits};
use super::conditions;

/// Deviation of a sum of parts from 1 that is rounding.
const ROUNDING: f64 = 1e-9;

pub(super) fn read(table: &TomlTable<'_>) -> ReadResult<Splits> {
    let by = table.optional("by").map(|value| value.choice(&SplitBy::NAMES)).transpose()?.unwrap_or_default();
    let parts = Splits::ALIKE.map(|name| table.optional(name));
    let shifts = match table.optional("shift") {
        None => Vec::new(),
        Some(value) => shifts(&value)?,
    };
    let mut numbers = [0.0; 3];
    for (number, part) in numbers.iter_mut().zip(&parts) {
        if let Some(value) = part {
            *number = fraction(value)?;
        }
    }
    let given: f64 = numbers.iter().sum::<f64>() + shifts.iter().map(|shift| shift.part).sum::<f64>();
    let where_told = parts.iter().rposition(Option::is_some).map_or("shift", |last| Splits::ALIKE[last]);
    if given > 1.0 + ROUNDING {
        let problem = format!("the parts of all splits add up to {given}; must be 1");
        return Err(table
            .error(where_told, problem)
            .with_help("parts are fractions of what `by` names: units, or mountings"));
    }
    if parts[2].is_none() {
        // What is left.
        numbers[2] = (1.0 - given).max(0.0);
        if numbers[2] < ROUNDING {
            numbers[2] = 0.0;
        }
    } else if given < 1.0 - ROUNDING {
        let problem = format!("the parts of all splits add up to {given}; must be 1");
        return Err(table.error(where_told, problem).with_help("leave out test: it is then what is left"));
    }
    Ok(Splits { by, parts: numbers, shifts })
}

fn fraction(value: &TomlValue<'_>) -> ReadResult<f64> {
    let number = value.number()?;
    if (0.0..=1.0).contains(&number) {
        Ok(number)
    } else {
        Err(value.error("must be from 0 to 1, a part of the units or mountings"))
    }
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
            let taken = Splits::ALIKE.contains(&text) || shifts.iter().any(|shift| shift.name == text);
            if taken {
                return Err(name.error("is the name of another split"));
            }
            let part = table.required("part", "the part of the units, or mountings, that is this split's")?;
            let number = fraction(&part)?;
            if number == 0.0 {
                return Err(part.error("must be more than 0"));
            }
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
