//! Scores of bearings: the verdict of `meshtone indicators` against what is published, and beside it a simple rule.

use std::collections::BTreeSet;

use meshtone::signal::{DefectKind, EnvelopeBand, FrequencyBand};
use meshtone_learn::mean;
use serde_json::{Map, Value, json};

use super::preset::{HEALTHY, Recorded};
use super::score::{Scored, Scores, columns, each, processed};
use crate::failure::Failure;
use crate::indicators::bearings::{BearingOptions, NamedChoice};
use crate::indicators::reading::Input;

/// Times the median beside it from which on the rule takes a line for a defect's.
const RULE: f64 = 10.0;
const OUTCOMES: [&str; 4] = ["right", "wrong race", "missed", "false alarm"];

/// What the verdict and the rule make of a recording.
type Outcomes = [&'static str; 2];

/// Scores the recordings of a bearing.
///
/// # Arguments
/// * `recordings` - of the set
/// * `bearing` - the bearing
/// * `quiet` - whether nothing is to be shown
pub fn score(recordings: &[Recorded], bearing: &NamedChoice, quiet: bool) -> Scores {
    let found = each(recordings, quiet, |recording| look(recording, bearing));
    let told =
        recordings.iter().zip(&found).filter_map(|(of, found)| Some((&*of.label.is, found.as_ref().ok()?.0)));
    let told: Vec<(&str, Outcomes)> = told.collect();
    let (table, sums) = sums(&told);
    Scores {
        heads: ["verdict", "", "rule", "", "over median"].map(str::to_owned).to_vec(),
        each: found.into_iter().map(|found| found.map(|(_, scored)| scored)).collect(),
        table,
        sums,
    }
}

/// Judges a recording, and finds the strongest line of a race in the squared envelope of the whole band.
fn look(recording: &Recorded, bearing: &NamedChoice) -> Result<(Outcomes, Scored), Failure> {
    let input = Input::read(&recording.path, &recording.reading, None)?;
    let whole = FrequencyBand { from_hz: 0.0, to_hz: 0.5 * input.sampling_rate_hz };
    let band_hz = Some(EnvelopeBand::Stated(whole));
    let options = BearingOptions { bearings: vec![bearing.clone()], band_hz, ..BearingOptions::default() };
    let found = processed(&input, recording, None, &options)?;
    let entry = found.bearings.and_then(|mut found| found.entries.pop());
    let entry = entry.ok_or_else(|| Failure::failed("no bearing was looked for"))?;
    let races = entry.lines.iter().filter(|line| line.kind != DefectKind::Cage);
    let strongest = races.max_by(|a, b| a.over_median.total_cmp(&b.over_median));
    let over_median = strongest.map_or(0.0, |line| line.over_median);
    let by_rule = strongest.filter(|line| line.over_median >= RULE).map(|line| line.kind.name());
    let (verdict, in_words) = &entry.verdict;
    let named = DefectKind::ALL.map(DefectKind::name).into_iter().find(|name| name == verdict);
    let outcomes = [named, by_rule].map(|named| outcome(&recording.label.is, named));
    let [of_verdict, of_rule] = outcomes;
    let cells = [verdict, of_verdict, by_rule.unwrap_or("nothing"), of_rule].map(str::to_owned).into_iter();
    let cells = cells.chain([format!("{over_median:.1}")]).collect();
    let why = in_words.strip_prefix("the recording does not tell: ").unwrap_or_default().to_owned();
    let value = json!({
        "sampling_rate_hz": input.sampling_rate_hz,
        "bearing": entry,
        "outcome": of_verdict,
        "rule": { "race": by_rule, "over_median": over_median, "outcome": of_rule },
    });
    Ok((outcomes, Scored { cells, words: why, value }))
}

/// What is said, beside what is.
fn outcome(is: &str, named: Option<&str>) -> &'static str {
    match named {
        None if is == HEALTHY => "right",
        None => "missed",
        Some(_) if is == HEALTHY => "false alarm",
        Some(race) if race == is => "right",
        Some(_) => "wrong race",
    }
}

/// Counts of the outcomes, how many recordings of each state are told rightly, and the mean of the states' parts, for the verdict and for the rule. The table and
/// the numbers are made side by side, as both are the same counts under other names.
///
/// # Arguments
/// * `told` - states, and what is made of them
fn sums(told: &[(&str, Outcomes)]) -> (String, Value) {
    let states: BTreeSet<&str> = told.iter().map(|(is, _)| *is).collect();
    let heads = ["", "balanced accuracy"].into_iter().chain(OUTCOMES).chain(states.iter().copied());
    let mut rows = vec![(heads.map(str::to_owned).collect::<Vec<_>>(), String::new())];
    let mut all = Map::new();
    for (place, name) in ["verdict", "rule"].into_iter().enumerate() {
        let count =
            |fits: &dyn Fn(&str, &str) -> bool| told.iter().filter(|(is, of)| fits(is, of[place])).count();
        let of_outcomes = OUTCOMES.map(|wanted| (wanted, count(&|_, outcome| outcome == wanted)));
        let of_states = states.iter().map(|state| {
            (*state, count(&|is, outcome| is == *state && outcome == "right"), count(&|is, _| is == *state))
        });
        let of_states: Vec<(&str, usize, usize)> = of_states.collect();
        let parts: Vec<f64> = of_states.iter().map(|(_, right, of)| *right as f64 / *of as f64).collect();
        let accuracy = (!parts.is_empty()).then(|| mean(&parts));
        let mut cells = vec![name.to_owned(), accuracy.map_or_else(String::new, |part| format!("{part:.2}"))];
        cells.extend(of_outcomes.iter().map(|(_, count)| count.to_string()));
        cells.extend(of_states.iter().map(|(_, right, of)| format!("{right} of {of}")));
        rows.push((cells, String::new()));
        let outcomes = of_outcomes.iter().map(|(name, count)| (name.replace(' ', "_"), json!(count)));
        let mut numbers: Map<String, Value> = outcomes.collect();
        numbers.insert("balanced_accuracy".to_owned(), json!(accuracy));
        let states = of_states.iter().map(|(state, right, of)| (*state, json!({ "right": right, "of": of })));
        numbers.insert("states".to_owned(), states.collect());
        all.insert(name.to_owned(), Value::Object(numbers));
    }
    (columns(&rows), Value::Object(all))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_state_counts_alike() {
        let told = [
            ("healthy", "right"),
            ("healthy", "false alarm"),
            ("inner race", "right"),
            ("inner race", "wrong race"),
            ("inner race", "missed"),
            ("inner race", "right"),
        ];
        let told = told.map(|(is, outcome)| (is, [outcome, "right"]));
        let (table, sums) = sums(&told);
        assert_eq!(sums["verdict"]["balanced_accuracy"], 0.5);
        assert_eq!(
            [&sums["verdict"]["right"], &sums["verdict"]["wrong_race"], &sums["rule"]["right"]],
            [3, 1, 6]
        );
        assert!(table.contains("2 of 4"), "{table}");
        let of = [
            (HEALTHY, None),
            (HEALTHY, Some("inner race")),
            ("inner race", None),
            ("inner race", Some("inner race")),
            ("inner race", Some("outer race")),
        ];
        assert_eq!(
            of.map(|(is, named)| outcome(is, named)),
            ["right", "false alarm", "missed", "right", "wrong race"]
        );
    }
}
