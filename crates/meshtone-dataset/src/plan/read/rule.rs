//! The array `[[vary]]`, at the top or in a class.

use meshtone::scenario::split_key;
use meshtone_toml::{ReadResult, TomlTable, TomlValue};

use super::super::{Distribution, Level, Rule, list_and_entry};
use super::over_zero;
use crate::expression::Expression;

/// The keys that say how a value is drawn, of which a rule has one.
const DISTRIBUTIONS: [&str; 6] = ["fixed", "grid", "choice", "uniform", "log_uniform", "normal"];
/// Sections whose keys make the wheels and the rig, which a unit's records share unless said otherwise.
const OF_A_UNIT: [&str; 9] =
    ["gears", "quality", "rig", "material", "shaft", "wheel", "mesh", "bearing", "housing"];
const MOST_STEPS: u64 = 100_000;
/// The other keys of a rule.
const OTHER_KEYS: [&str; 5] = ["weights", "times", "plus", "fraction_of", "per"];

pub(super) fn read_all(table: &TomlTable<'_>) -> ReadResult<Vec<Rule>> {
    let rules = table.read_optional("vary", |value| {
        value.array()?.iter().map(|value| value.table()?.read(rule)).collect::<ReadResult<Vec<Rule>>>()
    })?;
    Ok(rules.unwrap_or_default())
}

fn rule(table: &TomlTable<'_>) -> ReadResult<Rule> {
    // An unknown key is reported before the key that is missing because of it.
    table.refuse_unknown(&[&["key", "keys"][..], &DISTRIBUTIONS, &OTHER_KEYS].concat())?;
    let keys = keys(table)?;
    let distribution = distribution(table, keys.len())?;
    let term = |key| table.read_optional(key, expression);
    let (times, plus, fraction_of) = (term("times")?, term("plus")?, term("fraction_of")?);
    if keys.len() > 1 && (times.is_some() || plus.is_some() || fraction_of.is_some()) {
        let problem = "names several keys beside times, fraction_of or plus; these are for a single key";
        return Err(table.error("keys", problem));
    }
    if times.is_some() && fraction_of.is_some() {
        return Err(table.error("fraction_of", "given beside times; give one of the two"));
    }
    if fraction_of.is_some() {
        check_fractions(table, &distribution)?;
    }
    let unit = OF_A_UNIT.contains(&list_and_entry(split_key(&keys[0]).0).0);
    let default = if unit { Level::Unit } else { Level::Record };
    let level = table.read_optional("per", |value| value.choice(&Level::NAMES))?;
    Ok(Rule { keys, level: level.unwrap_or(default), distribution, times: times.or(fraction_of), plus })
}

fn keys(table: &TomlTable<'_>) -> ReadResult<Vec<String>> {
    match (table.optional("key"), table.optional("keys")) {
        (Some(key), None) => Ok(vec![key.string()?.to_owned()]),
        (None, Some(keys)) => {
            let names = keys.array()?;
            if names.len() < 2 {
                return Err(keys.error("must name two or more keys; for a single one write key = \"…\""));
            }
            names.iter().map(|name| Ok(name.string()?.to_owned())).collect()
        }
        (Some(_), Some(_)) => Err(table.error("keys", "given beside key; give one of the two")),
        (None, None) => {
            Err(table.error("key", "missing; it is the dotted key of a number of the scenario file"))
        }
    }
}

pub(super) fn expression(value: &TomlValue<'_>) -> ReadResult<Expression> {
    Expression::parse(value.string()?).map_err(|problem| value.error(format!("the expression {problem}")))
}

pub(super) fn distribution(table: &TomlTable<'_>, keys: usize) -> ReadResult<Distribution> {
    let weights = table.optional("weights");
    let given: Vec<_> =
        DISTRIBUTIONS.into_iter().filter_map(|name| Some((name, table.optional(name)?))).collect();
    let (name, value) = match &given[..] {
        [] => {
            let names = "fixed, grid, choice, uniform, log_uniform or normal";
            return Err(table.error("key", format!("does not state how it varies; give one of {names}")));
        }
        [(name, _), (other, _), ..] => {
            return Err(table.error(other, format!("given beside {name}; give one of the two")));
        }
        [(name, value)] => (*name, value),
    };
    if let (Some(weights), true) = (&weights, name != "choice") {
        return Err(weights.error(format!("given beside {name}; weights are those of a choice")));
    }
    if keys > 1 && !["grid", "choice"].contains(&name) {
        return Err(value.error("is for a single key; several keys vary together by choice or grid"));
    }
    match name {
        "fixed" => Ok(Distribution::Fixed(value.number()?)),
        "grid" if value.is_table() => Ok(Distribution::Grid(value.table()?.read(steps)?)),
        "grid" => Ok(Distribution::Grid(rows(value, keys)?)),
        "choice" => choice(value, weights.as_ref(), keys),
        "uniform" => Ok(Distribution::Uniform(range(value)?)),
        "log_uniform" => {
            let range = range(value)?;
            if range[0] <= 0.0 {
                return Err(value.error("starts at 0 or below; a logarithm needs more than 0"));
            }
            Ok(Distribution::LogUniform(range))
        }
        _ => value.table()?.read(|table| normal(table, value)),
    }
}

fn choice(value: &TomlValue<'_>, weights: Option<&TomlValue<'_>>, keys: usize) -> ReadResult<Distribution> {
    let rows = rows(value, keys)?;
    let weights = match weights {
        None => vec![1.0; rows.len()],
        Some(given) => {
            let numbers = given.numbers()?;
            if numbers.len() != rows.len() {
                let (are, must) = (numbers.len(), rows.len());
                return Err(given.error(format!("has {are} numbers; must have {must}, one for each value")));
            }
            if numbers.iter().any(|&weight| weight < 0.0) || numbers.iter().sum::<f64>() <= 0.0 {
                return Err(given.error("must be 0 or more each, and not all 0"));
            }
            numbers
        }
    };
    Ok(Distribution::Choice { rows, weights })
}

fn rows(value: &TomlValue<'_>, keys: usize) -> ReadResult<Vec<Vec<f64>>> {
    let entries = value.array()?;
    if entries.is_empty() {
        return Err(value.error("is empty; must have one value or more"));
    }
    let row = |entry: &TomlValue<'_>| {
        if keys == 1 {
            return Ok(vec![entry.number()?]);
        }
        let numbers = entry.numbers()?;
        if numbers.len() == keys {
            return Ok(numbers);
        }
        Err(entry.error(format!("has {} numbers; must have {keys}, one for each key", numbers.len())))
    };
    entries.iter().map(row).collect()
}

fn range(value: &TomlValue<'_>) -> ReadResult<[f64; 2]> {
    let [least, largest] = value.exactly()?;
    if least < largest {
        return Ok([least, largest]);
    }
    let help = match least > largest {
        true => format!("write [{largest:?}, {least:?}]"),
        false => format!("for one value write fixed = {least:?}"),
    };
    Err(value.error("must be [least, largest], the second larger than the first").with_help(help))
}

fn steps(table: &TomlTable<'_>) -> ReadResult<Vec<Vec<f64>>> {
    let least = table.required("least", "the first value")?.number()?;
    let largest = table.required("largest", "the last value")?;
    let steps = table.required("values", "how many values")?.integer(2..=MOST_STEPS)?;
    let logarithmic = table.read_optional("logarithmic", TomlValue::boolean)?.unwrap_or(false);
    let last = more_than(least, &largest)?;
    if logarithmic && least <= 0.0 {
        return Err(table.error("least", "must be more than 0 for equal ratios"));
    }
    let value = |i: u64| match i as f64 / (steps - 1) as f64 {
        part if logarithmic => least * libm::exp(part * libm::log(last / least)),
        part => least + part * (last - least),
    };
    Ok((0..steps).map(|i| vec![if i + 1 == steps { last } else { value(i) }]).collect())
}

/// The number at the key `largest`.
fn more_than(least: f64, largest: &TomlValue<'_>) -> ReadResult<f64> {
    let number = largest.number()?;
    let problem = || largest.error(format!("must be more than least, {least:?}"));
    if number > least { Ok(number) } else { Err(problem()) }
}

fn normal(table: &TomlTable<'_>, whole: &TomlValue<'_>) -> ReadResult<Distribution> {
    let mean = table.required("mean", "the mean, before it is truncated")?.number()?;
    let deviation = table.required("standard_deviation", "likewise")?;
    let least = table.required("least", "the least value that is drawn")?.number()?;
    let largest = table.required("largest", "the largest value that is drawn")?;
    let standard_deviation = over_zero(&deviation, "must be more than 0")?;
    let last = more_than(least, &largest)?;
    // Beyond, nothing of the distribution is left to draw from.
    const FARTHEST: f64 = 30.0;
    if least > mean + FARTHEST * standard_deviation || last < mean - FARTHEST * standard_deviation {
        let problem = "has nothing between least and largest: they are 30 standard deviations away";
        return Err(whole.error(problem));
    }
    Ok(Distribution::Normal { mean, standard_deviation, within: [least, last] })
}

/// A fraction is from 0 to 1.
fn check_fractions(table: &TomlTable<'_>, distribution: &Distribution) -> ReadResult<()> {
    let outside = distribution.range().into_iter().find(|end| !(0.0..=1.0).contains(end));
    match outside {
        None => Ok(()),
        Some(end) => Err(table
            .error("fraction_of", format!("a fraction of it may be {end:?}; must be from 0 to 1"))
            .with_help("for other multiples write times instead of fraction_of")),
    }
}
