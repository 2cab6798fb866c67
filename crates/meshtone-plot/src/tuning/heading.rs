//! Title and key facts.

use meshtone::tuning::Tuning;

use super::data::Data;
use crate::drawing::{BETWEEN_FACTS, Canvas, TextStyle, number};

const TITLE_BASELINE: f64 = 34.0;
const FACTS_BASELINE: f64 = 57.0;
const FACTS_PITCH: f64 = 19.0;

pub(super) fn draw(canvas: &mut Canvas, title: &str, data: &Data) {
    let width = f64::from(super::WIDTH) - 2.0 * super::TEXT_LEFT;
    let mut line = |baseline: f64, text: &str, style: TextStyle| {
        if let Some(text) = style.wrapped(text, width, 1).first() {
            canvas.text((super::TEXT_LEFT, baseline), text, style);
        }
    };
    line(TITLE_BASELINE, title, TextStyle::TITLE);
    let rows = [parameters(data), keys(data), errors(data)].into_iter().filter(|facts| !facts.is_empty());
    for (row, facts) in rows.enumerate() {
        line(FACTS_BASELINE + FACTS_PITCH * row as f64, &facts.join(BETWEEN_FACTS), TextStyle::FACTS);
    }
}

/// The figure in a sentence, for readers who cannot see it.
pub(super) fn description(data: &Data) -> String {
    format!(
        "Simulated difference signals tuned to measured ones, {} cases: indicators, errors and signals. {}. {}.",
        data.cases(),
        [parameters(data), keys(data)].concat().join(", "),
        errors(data).join(", ")
    )
}

fn parameters(data: &Data) -> Vec<String> {
    let Tuning { enhancement, intervals, .. } = data.tuning;
    let parameters = [
        ("width ratio", enhancement.width_ratio, intervals.width_ratio),
        (
            "fault-to-harmonics ratio",
            enhancement.fault_to_harmonics_ratio,
            intervals.fault_to_harmonics_ratio,
        ),
        ("noise level", enhancement.noise_level, intervals.noise_level),
    ];
    let mut facts = parameters
        .map(|(name, value, [low, high])| {
            format!("{name} {} ({} to {})", short(value), short(low), short(high))
        })
        .to_vec();
    if let Some(last) = facts.last_mut() {
        last.push_str(", in brackets the 95 % intervals");
    }
    facts
}

/// Numbers of the scenario that were tuned as well.
fn keys(data: &Data) -> Vec<String> {
    let Some(keys) = &data.result.with_keys else { return Vec::new() };
    let values = data.experiment.keys.iter().zip(&keys.values);
    values.map(|(key, &value)| format!("{} = {}", key.key, number(value))).collect()
}

fn errors(data: &Data) -> Vec<String> {
    let Tuning { original_error, enhanced_error, scatter, .. } = data.tuning;
    vec![
        format!("mean error of the original simulation {} σ", short(*original_error)),
        format!("enhanced {} σ", short(*enhanced_error)),
        format!("of cases left out of the fit {} σ", short(data.tuning.mean_leave_one_out_error())),
        format!("the measurements’ own scatter {} σ", short(*scatter)),
        "σ: standard deviation of all measured records of an indicator".to_owned(),
    ]
}

/// Three significant digits.
fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return number(value);
    }
    let scale = 10f64.powf(2.0 - value.abs().log10().floor());
    number((value * scale).round() / scale)
}
