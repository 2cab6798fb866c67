//! A check that a recording is as loud as simulations of the rig.

use meshtone::sensor::GRAVITY_M_PER_S2;
use meshtone_learn::{WheelLines, quantiles};

use crate::draw::RECORDS_PER_UNIT;
use crate::layout::Layout;
use crate::learn::Learned;
use crate::observation::{Observation, Question};
use crate::reference::ReferenceRecord;

/// (dB) How far beyond nine in ten of the simulations a level must be: the sensor's path is among what was drawn for them.
const BEYOND_DB: f64 = 10.0;

/// A warning about recordings that are far louder or quieter than all simulations.
///
/// # Arguments
/// * `learned`, `question` - the simulations, and the recordings
pub(crate) fn doubt(learned: &Learned, question: &Question) -> Option<String> {
    let (name, asked) = match question.healthy.first() {
        Some(healthy) => ("healthy recording", healthy),
        None => ("recording", question.now.first()?),
    };
    let asked = observed_db(learned, asked);
    // A healthy recording is held against healthy simulations, at its speed: damage is loud.
    let is_alike = |record: &&ReferenceRecord| {
        let is_at_speed = learned.reference.prior.healthy_speed_hz.is_none()
            || record.number.is_multiple_of(RECORDS_PER_UNIT);
        question.healthy.is_empty() || (record.fault.is_none() && is_at_speed)
    };
    let level = |record: &ReferenceRecord| (level_db(learned, record.wheels.last()), 1.0);
    let levels = learned.reference.records.iter().filter(is_alike).map(level).collect();
    let [low, median, high] = quantiles(levels, [0.05, 0.5, 0.95]);
    let is_within = (low - BEYOND_DB..=high + BEYOND_DB).contains(&asked);
    (!is_within).then(|| {
        format!(
            "the {name} is {:.3} times as loud as the simulations (median), more than a sensor's mounting explains: are its unit (1 g is \
             9.81 m/s²) and the sensitivity right?",
            10f64.powf((asked - median) / 20.0)
        )
    })
}

/// (dB) How near a difference of levels is to that of a recording in m/s² and one in g.
const UNIT_NEAR_DB: f64 = 4.0;

/// A hint for recordings that are about 9.81 times as loud, or as quiet, as the healthy one.
pub(crate) fn unit_hint(learned: &Learned, question: &Question) -> Option<String> {
    let louder_db =
        observed_db(learned, question.now.first()?) - observed_db(learned, question.healthy.first()?);
    let unit_db = 20.0 * GRAVITY_M_PER_S2.log10();
    ((louder_db.abs() - unit_db).abs() < UNIT_NEAR_DB).then(|| {
        format!(
            "it is {:.2} times as loud as the healthy recording: are both in the same unit (1 g is 9.81 m/s²)?",
            10f64.powf(louder_db / 20.0)
        )
    })
}

/// (dB) Level of a recording.
fn observed_db(learned: &Learned, asked: &Observation) -> f64 {
    level_db(learned, asked.wheels.last().and_then(Option::as_ref))
}

/// (dB) Level of the last wheel's average, of a pair the gear's, or of its difference signal where no more is known.
fn level_db(learned: &Learned, wheel: Option<&WheelLines>) -> f64 {
    let Layout { signal, last, .. } = &learned.layout;
    let lines = wheel.map_or_else(Vec::new, |wheel| {
        if signal.has_regular_part() { wheel.lines.clone() } else { wheel.difference() }
    });
    let last = last.last().copied().unwrap_or(0);
    let energy: f64 = lines.iter().take(last + 1).skip(1).map(|line| line.norm_sqr()).sum();
    10.0 * energy.max(f64::MIN_POSITIVE).log10()
}
