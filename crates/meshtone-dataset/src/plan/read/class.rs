//! The array `[[class]]`.

use meshtone::scenario::Scenario;
use meshtone_toml::{ReadResult, TomlTable, TomlValue};

use super::super::split::largest_remainder;
use super::super::{Class, ClassFault, Severity};
use super::{growth, over_zero, rule};

const MOST_RECORDS: u64 = 1 << 40;

pub(super) fn read_all(root: &TomlTable<'_>, base: &Scenario) -> ReadResult<Vec<Class>> {
    let listed = root.required("class", "the classes, [[class]] each")?;
    let values = listed.array()?;
    if values.is_empty() {
        return Err(listed.error("has no class; must have one or more"));
    }
    let (mut classes, mut weights) = (Vec::with_capacity(values.len()), Vec::new());
    for value in &values {
        let (class, weight) = value.table()?.read(|table| class(table, base))?;
        if classes.iter().any(|other: &Class| other.label == class.label) {
            return Err(value.error(format!("has the label \"{}\" of another class", class.label)));
        }
        classes.push(class);
        weights.extend(weight.map(|weight| (weight, value)));
    }
    if let Some(counts) = weighted_counts(root, &classes, &weights)? {
        classes.iter_mut().zip(counts).for_each(|(class, count)| class.count = count);
    }
    Ok(classes)
}

/// The number of records of each class by the weights; none where all classes have counts.
fn weighted_counts(
    root: &TomlTable<'_>,
    classes: &[Class],
    weights: &[(f64, &TomlValue<'_>)],
) -> ReadResult<Option<Vec<u64>>> {
    let [(_, first), ..] = weights else {
        let sum: u64 = classes.iter().map(|class| class.count).sum();
        if let Some(value) = root.optional("records")
            && value.integer(1..=MOST_RECORDS)? != sum
        {
            let problem = format!("the classes' counts add up to {sum}; must be the same, or left out");
            return Err(value.error(problem));
        }
        return Ok(None);
    };
    if weights.len() < classes.len() {
        let problem = "has a weight where another class has a count; must be all of one kind";
        return Err(first.error(problem));
    }
    let records = root.required("records", "how many records there are, where classes have weights")?;
    let parts: Vec<f64> = weights.iter().map(|(weight, _)| *weight).collect();
    let counts = largest_remainder(&parts, records.integer(1..=MOST_RECORDS)?);
    if let Some(empty) = counts.iter().position(|&count| count == 0) {
        return Err(weights[empty].1.error("has so small a weight that no record is left for it"));
    }
    Ok(Some(counts))
}

/// Reads a class, and its weight where it has no count.
fn class(table: &TomlTable<'_>, base: &Scenario) -> ReadResult<(Class, Option<f64>)> {
    let label = table.required("label", "the class's name in the column label")?;
    let name = label.string()?;
    if name.is_empty() {
        return Err(label.error("must not be empty"));
    }
    let faults = ClassFault::read_all(table, base)?;
    let severity = severity(table, !faults.is_empty())?;
    let (count, weight) = match (table.optional("count"), table.optional("weight")) {
        (Some(count), None) => (count.integer(1..=MOST_RECORDS)?, None),
        (None, Some(weight)) => (0, Some(over_zero(&weight, "must be more than 0")?)),
        (None, None) => (0, Some(1.0)),
        (Some(_), Some(_)) => return Err(table.error("weight", "given beside count; give one of the two")),
    };
    let rules = rule::read_all(table)?;
    let growth = table.read_optional("growth", |value| growth::read(value, &faults))?;
    Ok((Class { label: name.to_owned(), faults, count, severity, rules, growth }, weight))
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
        Ok(Severity::Measured { measure: rule::expression(&measure)?, breaks: limits })
    })
}
