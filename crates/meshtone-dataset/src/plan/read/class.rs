//! The array `[[class]]`.

use meshtone::scenario::Fault;
use meshtone_toml::{ReadResult, TomlTable, TomlValue};

use super::super::split::largest_remainder;
use super::super::{Class, Severity};
use super::{growth, rule};
use crate::expression::Expression;

const MOST_RECORDS: u64 = 1 << 40;

/// How many records a class has.
#[derive(Clone, Copy)]
enum Share {
    Count(u64),
    Weight(f64),
}

pub(super) fn read_all(root: &TomlTable<'_>) -> ReadResult<Vec<Class>> {
    let records = root.optional("records");
    let listed = root.required("class", "the classes, [[class]] each")?;
    let values = listed.array()?;
    if values.is_empty() {
        return Err(listed.error("has no class; must have one or more"));
    }
    let mut classes = Vec::with_capacity(values.len());
    let mut shares = Vec::with_capacity(values.len());
    for value in &values {
        let (class, share) = value.table()?.read(class)?;
        if classes.iter().any(|other: &Class| other.label == class.label) {
            return Err(value.error(format!("has the label \"{}\" of another class", class.label)));
        }
        classes.push(class);
        shares.push(share);
    }
    let counts = counts(root, records.as_ref(), &values, &shares)?;
    classes.iter_mut().zip(counts).for_each(|(class, count)| class.count = count);
    Ok(classes)
}

fn counts(
    root: &TomlTable<'_>,
    records: Option<&TomlValue<'_>>,
    classes: &[TomlValue<'_>],
    shares: &[Share],
) -> ReadResult<Vec<u64>> {
    let records = match records {
        Some(value) => Some((value, value.integer(1..=MOST_RECORDS)?)),
        None => None,
    };
    let weights: Vec<f64> = shares
        .iter()
        .filter_map(|share| match share {
            Share::Weight(weight) => Some(*weight),
            _ => None,
        })
        .collect();
    let counts: Vec<u64> = shares
        .iter()
        .filter_map(|share| match share {
            Share::Count(count) => Some(*count),
            _ => None,
        })
        .collect();
    let both = !weights.is_empty() && !counts.is_empty();
    if both {
        let first = shares.iter().position(|share| matches!(share, Share::Weight(_))).unwrap_or(0);
        let problem = "has a weight where another class has a count; must be all of one kind";
        return Err(classes[first].error(problem));
    }
    let Some((value, records)) = records else {
        if !weights.is_empty() {
            // Also where a misspelt key stands in its place.
            root.required("records", "how many records there are, where classes have weights")?;
        }
        return Ok(counts);
    };
    if weights.is_empty() {
        let sum: u64 = counts.iter().sum();
        if sum != records {
            return Err(
                value.error(format!("the classes' counts add up to {sum}; must be the same, or left out"))
            );
        }
        return Ok(counts);
    }
    let counts = largest_remainder(&weights, records);
    if let Some(empty) = counts.iter().position(|&count| count == 0) {
        return Err(classes[empty].error("has so small a weight that no record is left for it"));
    }
    Ok(counts)
}

fn class(table: &TomlTable<'_>) -> ReadResult<(Class, Share)> {
    let label = table.required("label", "the class's name in the column label")?;
    let name = label.string()?;
    if name.is_empty() {
        return Err(label.error("must not be empty"));
    }
    let faults = Fault::list_from_table(table)?;
    let severity = severity(table, !faults.is_empty())?;
    let share = match (table.optional("count"), table.optional("weight")) {
        (Some(count), None) => Share::Count(count.integer(1..=MOST_RECORDS)?),
        (None, Some(weight)) => {
            let number = weight.number()?;
            if number <= 0.0 {
                return Err(weight.error("must be more than 0"));
            }
            Share::Weight(number)
        }
        (None, None) => Share::Weight(1.0),
        (Some(_), Some(_)) => return Err(table.error("weight", "given beside count; give one of the two")),
    };
    let rules = rule::read_all(table)?;
    let growth = table.optional("growth").map(|value| growth::read(&value, &faults)).transpose()?;
    Ok((Class { label: name.to_owned(), faults, count: 0, severity, rules, growth }, share))
}

fn severity(table: &TomlTable<'_>, faulty: bool) -> ReadResult<Severity> {
    let Some(value) = table.optional("severity") else {
        return Ok(Severity::Grade(u8::from(faulty)));
    };
    if !faulty {
        return Err(value.error("given for a healthy class, whose severity is 0").with_help("remove it"));
    }
    if !value.is_table() {
        let grade = value.integer(1..=255)?;
        return Ok(Severity::Grade(u8::try_from(grade).unwrap_or(u8::MAX)));
    }
    value.table()?.read(|severity| {
        let measure = severity.required("measure", "the number that the severity is measured by: a key")?;
        let breaks = severity.required("breaks", "where one grade ends and the next begins, rising")?;
        let limits = breaks.numbers()?;
        if limits.is_empty() || limits.len() > 200 || limits.windows(2).any(|pair| pair[1] <= pair[0]) {
            return Err(breaks.error("must be one to 200 numbers, each larger than the one before"));
        }
        let expression = Expression::parse(measure.string()?);
        let expression = expression.map_err(|problem| measure.error(format!("the expression {problem}")))?;
        Ok(Severity::Measured { measure: expression, breaks: limits })
    })
}
