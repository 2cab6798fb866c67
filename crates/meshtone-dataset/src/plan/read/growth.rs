//! The table `growth` of a class.

use meshtone_toml::{ReadResult, TomlTable, TomlValue};

use super::super::{ClassFault, Distribution, Growth, Law, SpreadOver};
use super::rule::distribution;
use super::{fraction, number_where};

/// The exponent of Paris's law; ductile steels have 2 to 4.
const PARIS_EXPONENT: f64 = 3.0;
const PITS_EXPONENT: f64 = 2.0;
const PITS: u32 = 40;
const LARGEST_EXPONENT: f64 = 10.0;
/// The keys of all laws.
const KEYS: [&str; 8] = ["law", "exponent", "count", "start", "failure", "life_rev", "censored", "over"];

pub(super) fn read(value: &TomlValue<'_>, faults: &[ClassFault]) -> ReadResult<Growth> {
    let [fault] = faults else {
        let count = faults.len();
        return Err(value.error(format!("is of a class with {count} faults; must be one, which grows")));
    };
    value.table()?.read(|table| growth(table, fault))
}

/// Reads how a damage grows.
///
/// The law is read first, because the keys that it has and their defaults depend on it. Start and failure are checked against each other
/// and against the law: a crack does not grow from nothing, and a life that starts beyond its end would have no records.
fn growth(table: &TomlTable<'_>, fault: &ClassFault) -> ReadResult<Growth> {
    // An unknown key is reported before the key that is missing because of it.
    table.refuse_unknown(&KEYS)?;
    let law = table.required("law", "how the damage grows: paris, archard or pits")?.one_of(&Law::NAMES)?;
    let exponent = |default: f64| -> ReadResult<f64> {
        let is_allowed = |number| number > 0.0 && number <= LARGEST_EXPONENT;
        let read = |value: &_| number_where(value, is_allowed, "must be more than 0 and at most 10");
        Ok(table.read_optional("exponent", read)?.unwrap_or(default))
    };
    let law = match Law::NAMES[law] {
        "paris" => Law::Paris { exponent: exponent(PARIS_EXPONENT)? },
        "pits" => {
            let count = table.read_optional("count", |value| value.integer(1..=100_000))?;
            Law::Pits { count: count.map_or(PITS, |count| count as u32), exponent: exponent(PITS_EXPONENT)? }
        }
        _ => Law::Archard,
    };
    let part = |key| table.read_optional(key, |value| fraction(value, "must be from 0 to 1"));
    let start = part("start")?.unwrap_or(0.02);
    if start == 0.0 && matches!(law, Law::Paris { .. }) {
        return Err(table.error("start", "is 0; a crack grows by Paris's law from more than that"));
    }
    if start == 0.0 && fault.teeth().is_none() {
        return Err(table.error("start", "is 0; a spall of a bearing grows from a width of more than that"));
    }
    let failure = part("failure")?.unwrap_or(1.0);
    if failure <= start {
        let problem = format!("must be more than start, {start:?}: the severity at which it has failed");
        return Err(table.error("failure", problem));
    }
    let life = table.required(
        "life_rev",
        "turns of the damaged wheel, or of the damaged bearing's shaft, from start to failure, as { log_uniform = [1e6, 1e7] }",
    )?;
    let life_rev = match &life {
        value if value.is_table() => value.table()?.read(|table| distribution(table, 1))?,
        value => Distribution::Fixed(value.number()?),
    };
    if matches!(life_rev, Distribution::Grid(_)) {
        return Err(life.error("is a grid; every run has a life of its own, drawn: write choice instead"));
    }
    if life_rev.range()[0] <= 0.0 {
        return Err(life.error("must be more than 0 revolutions"));
    }
    let censored = part("censored")?.unwrap_or(0.0);
    let over = table.read_optional("over", |value| value.choice(&SpreadOver::NAMES))?.unwrap_or_default();
    Ok(Growth { law, start, failure, life_rev, censored, over })
}
