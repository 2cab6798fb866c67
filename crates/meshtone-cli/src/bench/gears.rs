//! Scores of a gearbox: indicators of each wheel, and how far they are from those of the healthy machine.

use meshtone::scenario::Scenario;
use meshtone::signal::WheelRecords;
use meshtone_dataset::adapt::Judged;
use meshtone_learn::{area_under_curve, median};
use serde_json::{Map, Value, json};

use super::adaptation::{self, Adapter};
use super::diagnosis::{self, Diagnoser};
use super::preset::{HEALTHY, Recorded};
use super::score::{Scored, Scores, columns, each, processed};
use crate::diagnose::reference::ReferenceOptions;
use crate::failure::Failure;
use crate::indicators::bearings::BearingOptions;
use crate::indicators::reading::Input;

/// FM0 of each wheel, FM4 of each, and the distance; or why there are none.
type Numbers = Result<Vec<Option<f64>>, String>;

/// Scores the recordings of a gearbox.
///
/// # Arguments
/// * `recordings` - of the set
/// * `scenario` - of the machine
/// * `kept` - where simulations are kept, if each is to be diagnosed
/// * `adapter` - what adapts sets, if each is to be judged by one
/// * `quiet` - whether nothing is to be shown
pub fn score(
    recordings: &[Recorded],
    scenario: &Scenario,
    kept: Option<&ReferenceOptions>,
    adapter: Option<&Adapter>,
    quiet: bool,
) -> Result<Scores, Failure> {
    let mut found: Vec<Numbers> = each(recordings, quiet, |recording| look(recording, scenario));
    let distances: Vec<_> = (0..found.len()).map(|place| distance(place, recordings, &found)).collect();
    found.iter_mut().zip(distances).for_each(|(found, of)| found.iter_mut().for_each(|found| found.push(of)));
    let adapted = adapter.map(|adapter| adapter.judge(recordings)).unwrap_or_default();
    for (found, answer) in found.iter_mut().zip(&adapted) {
        found.iter_mut().for_each(|found| found.push(answer.as_ref().ok().map(Judged::damaged)));
    }
    let wheels = || scenario.wheels.iter().map(|wheel| &wheel.name);
    let names = ["FM0", "FM4"].into_iter().flat_map(|of| wheels().map(move |wheel| format!("{of} {wheel}")));
    let own = ["distance", "adapted"].into_iter().take(1 + usize::from(adapter.is_some()));
    let heads: Vec<String> = names.chain(own.map(str::to_owned)).collect();
    let (table, areas) = areas(&heads, recordings, &found);
    let scored = |of: Vec<Option<f64>>| Scored {
        cells: of.iter().map(in_words).collect(),
        words: String::new(),
        value: json!({ "indicators": named(&heads, &of) }),
    };
    let each = found.into_iter().map(|found| found.map(scored)).collect();
    let mut scores = Scores { each, table, sums: json!({ "areas": areas }), heads };
    if adapter.is_some() {
        let answers = recordings.iter().zip(&adapted).zip(&scores.each);
        let answers = answers.filter(|(_, scored)| scored.is_ok());
        let answers = answers.map(|((recording, answer), _)| (recording.label.is == HEALTHY, answer));
        let counted = adaptation::counted(answers);
        scores.add("adapted", adapted.iter().map(adaptation::in_numbers), counted);
    }
    if let Some(kept) = kept.filter(|_| scores.each.iter().any(Result::is_ok)) {
        diagnose(&mut scores, recordings, &Diagnoser::new(scenario, kept, quiet)?);
    }
    Ok(scores)
}

/// Diagnoses the recordings that were scored.
fn diagnose(scores: &mut Scores, recordings: &[Recorded], diagnoser: &Diagnoser) {
    let (mut answers, mut of_each) = (Vec::new(), Vec::new());
    for (place, scored) in scores.each.iter_mut().enumerate() {
        let mut shown = Value::Null;
        if let Ok(scored) = scored {
            let healthy = beside(place, recordings, true).map(|other| &recordings[other]).next();
            let answer = diagnoser.diagnose(&recordings[place], healthy);
            (scored.words, shown) = diagnosis::shown(&answer);
            answers.push((recordings[place].label.is == HEALTHY, answer));
        }
        of_each.push(shown);
    }
    scores.add("diagnosis", of_each, diagnosis::counted(&answers));
    scores.heads.push("diagnosis".to_owned());
}

/// FM0 of each wheel of a recording, then FM4 of each.
fn look(recording: &Recorded, scenario: &Scenario) -> Result<Vec<Option<f64>>, Failure> {
    let input = Input::read(&recording.path, &recording.reading, None)?;
    let found = processed(&input, recording, Some(scenario), &BearingOptions::default())?;
    let of_wheel = |name: &str| {
        let has_name = |of: &&WheelRecords| found.turned.train.wheels[of.wheel].name == name;
        Some(&found.records.wheels.iter().find(has_name)?.records.first()?.indicators)
    };
    let wheels: Vec<_> = scenario.wheels.iter().map(|wheel| of_wheel(&wheel.name)).collect();
    Ok([wheels.iter().map(|of| (*of)?.fm0).collect::<Vec<_>>(), wheels.iter().map(|of| (*of)?.fm4).collect()]
        .concat())
}

/// Areas under the curve by each channel: as a table, and in numbers.
fn areas(names: &[String], recordings: &[Recorded], found: &[Numbers]) -> (String, Value) {
    let heads = ["area under the curve".to_owned()].into_iter().chain(names.iter().cloned());
    let mut rows = vec![(heads.collect(), String::new())];
    let mut all = Map::new();
    for Recorded { channel, .. } in recordings {
        if !all.contains_key(channel) {
            let area = |column| area_of(column, channel, recordings, found);
            let areas: Vec<_> = (0..names.len()).map(area).collect();
            let cells = [channel.clone()].into_iter().chain(areas.iter().map(in_words)).collect();
            rows.push((cells, String::new()));
            all.insert(channel.clone(), named(names, &areas));
        }
    }
    (columns(&rows), Value::Object(all))
}

fn named(names: &[String], numbers: &[Option<f64>]) -> Value {
    Value::Object(names.iter().cloned().zip(numbers.iter().map(|number| json!(number))).collect())
}

fn in_words(value: &Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.2}"))
}

/// The healthy recordings by the channel of a recording, at its load or at all others.
fn beside(place: usize, recordings: &[Recorded], at_its_load: bool) -> impl Iterator<Item = usize> {
    let Recorded { channel, number, .. } = &recordings[place];
    let fits = move |other: &Recorded| {
        other.label.is == HEALTHY && other.channel == *channel && (other.number == *number) == at_its_load
    };
    (0..recordings.len()).filter(move |other| fits(&recordings[*other]))
}

/// Distance of a recording from the healthy ones by its channel: rms over wheels, FM0 and FM4 of the logarithm of each over its median
/// there. A healthy recording is not compared with itself, so neither of the two states is compared with healthy ones at its own load.
/// None where there are no others.
fn distance(place: usize, recordings: &[Recorded], found: &[Numbers]) -> Option<f64> {
    let logarithm = |(column, value): (usize, &Option<f64>)| {
        let there = beside(place, recordings, false).filter_map(|other| found[other].as_ref().ok()?[column]);
        let there: Vec<f64> = there.collect();
        (!there.is_empty()).then(|| Some((value.as_ref()? / median(&there)).ln()))?
    };
    let logarithms: Vec<f64> = found[place].as_ref().ok()?.iter().enumerate().filter_map(logarithm).collect();
    let squares: f64 = logarithms.iter().map(|logarithm| logarithm * logarithm).sum();
    (!logarithms.is_empty()).then(|| (squares / logarithms.len() as f64).sqrt())
}

/// Area under the curve of a column by a channel, healthy against damaged.
fn area_of(column: usize, channel: &str, recordings: &[Recorded], found: &[Numbers]) -> Option<f64> {
    let [healthy, damaged] = [true, false].map(|is_healthy| -> Vec<f64> {
        let fits = |of: &Recorded| of.channel == channel && (of.label.is == HEALTHY) == is_healthy;
        let chosen = recordings.iter().zip(found).filter(|(recording, _)| fits(recording));
        chosen.filter_map(|(_, found)| found.as_ref().ok()?[column]).collect()
    });
    area_under_curve(&healthy, &damaged)
}
