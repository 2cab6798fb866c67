//! The figure of a diagnosis.

use meshtone::signal::TrainWheel;
use meshtone_diagnose::{Answer, HEALTHY, KindAnswer};
use meshtone_plot::Figure;
use meshtone_plot::diagnosis::{self, DiagnosisFigure, SeverityView};

/// Draws a diagnosis.
///
/// The severity is that of the likeliest damage even where healthy is likelier; a tooth is marked in the wheel's signal only where damage is
/// the likeliest answer, and on that wheel.
///
/// # Arguments
/// * `answer` - what is drawn
/// * `title` - names of what was recorded
/// * `rig` - wheels of the rig
pub fn draw(answer: &Answer, title: &str, rig: &[TrainWheel]) -> Figure {
    let compared =
        if answer.has_healthy { "with a healthy recording" } else { "without a healthy recording" };
    let words = answer.in_words();
    let facts = [
        words.damaged.unwrap_or_else(|| "nothing can be said".to_owned()),
        words.likeness,
        compared.to_owned(),
        format!("{} simulations", answer.reference_records),
        format!("Meshtone {}", env!("CARGO_PKG_VERSION")),
    ];
    let kinds: Vec<(&str, f64)> = answer.kinds.iter().map(|kind| (kind.label, kind.probability)).collect();
    let damage = if answer.is_outside() { None } else { answer.likeliest_damage() };
    let is_damaged = answer.kinds.first().is_some_and(|kind| kind.label != HEALTHY);
    let shown = &rig[answer.shown_wheel];
    let on_shown =
        damage.and_then(|kind| kind.place).filter(|place| is_damaged && place.wheel == answer.shown_wheel);
    let draws = damage.map_or_else(Vec::new, KindAnswer::severity_histogram);
    let severity = damage.and_then(|kind| {
        let severity = kind.severity?;
        Some(SeverityView {
            kind: kind.label,
            draws: &draws,
            median: severity.median,
            within_50: severity.within_50,
            within_90: severity.within_90,
        })
    });
    let explanations: Vec<(String, &[f64])> = answer
        .explanations
        .iter()
        .map(|explanation| {
            let wheel = explanation.wheel.map(|wheel| {
                format!(" of the {}, severity {:.2}", answer.wheel_in_words(wheel), explanation.severity)
            });
            let words = format!("{}{}", explanation.label, wheel.unwrap_or_default());
            (words, &explanation.difference_g[..])
        })
        .collect();
    diagnosis::draw(&DiagnosisFigure {
        title,
        facts: &facts,
        wheel: &answer.wheel_in_words(answer.shown_wheel),
        teeth: shown.teeth,
        damaged_tooth: on_shown.and_then(|place| place.tooth).map(|tooth| tooth.number),
        difference_g: &answer.difference_g,
        band_g: [&answer.band_g[0], &answer.band_g[1]],
        kinds: if answer.is_outside() { &[] } else { &kinds },
        severity,
        explanations: &explanations,
    })
}
