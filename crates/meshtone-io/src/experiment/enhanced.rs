//! Enhanced difference signals, and their Parquet file.

use std::io::{self, Write};

use meshtone::scenario::{Fault, Scenario};
use meshtone::tuning::{HybridError, SimulatedCases, TuningIndicator, difference_signals};

use super::Tuned;
use crate::run_identity::fnv_1a;
use crate::table::{CellType, Cells, TableColumn, write_compressed};

/// One draw of an enhanced difference signal.
#[derive(Debug, Clone, PartialEq)]
pub struct EnhancedRecord {
    /// The faults' kinds, or `healthy`.
    pub label: String,
    /// Number of the draw.
    pub draw: u64,
    /// Rms over that of the enhanced healthy signal.
    pub relative_rms: f64,
    /// Kurtosis.
    pub kurtosis: f64,
    /// One revolution of the wheel, over the rms of the enhanced healthy signal.
    pub relative_difference: Vec<f64>,
}

/// Draws of a scenario's enhanced difference signal.
#[derive(Debug, Clone, PartialEq)]
pub struct EnhancedDraws {
    /// (g) Rms of the simulated healthy signal, enhanced: what the records are divided by.
    pub healthy_rms_g: f64,
    /// The draws.
    pub records: Vec<EnhancedRecord>,
}

/// Simulates a scenario and its healthy counterpart, and enhances the difference signal of the wheel that was tuned to.
///
/// # Arguments
/// * `scenario` - what is simulated; where keys were tuned, [`Tuned::apply`] has put them in
/// * `tuned` - how it is enhanced
/// * `seed` - of the noise; the same seed and scenario give the same draws
/// * `draws` - how many, at least 1
///
/// # Errors
/// A scenario that cannot be simulated; a chain that its signals are too short or too slow for.
pub fn enhance(
    scenario: &Scenario,
    tuned: &Tuned,
    seed: u64,
    draws: u64,
) -> Result<EnhancedDraws, HybridError> {
    let healthy = scenario.clone().with_faults(Vec::new());
    let both = if scenario.faults.is_empty() { vec![healthy] } else { vec![healthy, scenario.clone()] };
    let mut signals = difference_signals(both, &tuned.chain())?;
    // A healthy signal does not show where a fault would be.
    let centre_rev = match signals.len() {
        1 => tuned.centre_rev,
        _ => SimulatedCases::new(signals.clone())?.centre_rev(),
    };
    let healthy = signals.swap_remove(0);
    let difference = signals.pop().unwrap_or_else(|| healthy.clone());
    let enhanced = tuned.enhancement.without_noise(&difference, &healthy, centre_rev)?;
    let noise = 1.0 + tuned.enhancement.noise_level.powi(2);
    let healthy_rms_g = enhanced.healthy_rms * noise.sqrt();
    let label = label(&scenario.faults);
    // Files of different scenarios must not share their noise.
    let noise_seed = seed ^ fnv_1a(scenario.to_toml().as_bytes());
    let record = |draw: u64| {
        let mut signal = enhanced.with_noise(noise_seed, draw)?;
        signal.iter_mut().for_each(|value| *value /= healthy_rms_g);
        Ok(EnhancedRecord {
            label: label.clone(),
            draw,
            relative_rms: TuningIndicator::Rms.measure(&signal)?,
            kurtosis: TuningIndicator::Kurtosis.measure(&signal)?,
            relative_difference: signal,
        })
    };
    Ok(EnhancedDraws { healthy_rms_g, records: (0..draws).map(record).collect::<Result<_, HybridError>>()? })
}

/// The kinds of the faults, in their order.
fn label(faults: &[Fault]) -> String {
    let kinds: Vec<_> = faults.iter().map(|fault| fault.damage.kind()).collect();
    if kinds.is_empty() { "healthy".to_owned() } else { kinds.join(" + ") }
}

/// Writes enhanced difference signals, one row a draw.
///
/// The metadata holds everything that the draws depend on, the scenario, the tuned parameters, the version and the seed, so that the file
/// can be made again from itself. Signals are stored in single precision, which halves the file.
///
/// # Arguments
/// * `to` - where the file is written to; it needs no buffer
/// * `scenario`, `tuned`, `seed` - as of [`enhance`]; they go into the file's metadata
/// * `draws` - the rows
///
/// # Errors
/// Those of `to`.
pub fn write_enhanced(
    to: impl Write + Send,
    scenario: &Scenario,
    tuned: &Tuned,
    seed: u64,
    draws: &EnhancedDraws,
) -> io::Result<()> {
    let records = &draws.records;
    let columns = [
        ("label", CellType::Text),
        ("draw", CellType::Int64),
        ("relative_rms", CellType::Float64),
        ("kurtosis", CellType::Float64),
        ("relative_difference", CellType::Float32List),
    ];
    let columns = columns.map(|(name, cells)| TableColumn::new(name, cells)).to_vec();
    let signal = |record: &EnhancedRecord| record.relative_difference.iter().map(|&x| x as f32).collect();
    let signals: Vec<Vec<f32>> = records.iter().map(signal).collect();
    let cells = vec![
        Cells::Text(records.iter().map(|record| Some(record.label.clone())).collect()),
        Cells::Int64(records.iter().map(|record| Some(record.draw as i64)).collect()),
        Cells::Float64(records.iter().map(|record| Some(record.relative_rms)).collect()),
        Cells::Float64(records.iter().map(|record| Some(record.kurtosis)).collect()),
        Cells::Float32List(signals.iter().map(Vec::as_slice).collect()),
    ];
    let metadata = [
        ("meshtone.scenario", scenario.to_toml()),
        ("meshtone.tuned", super::write_tuned(tuned, "an experiment")),
        ("meshtone.version", env!("CARGO_PKG_VERSION").to_owned()),
        ("meshtone.seed", seed.to_string()),
        ("meshtone.healthy_rms_g", format!("{:?}", draws.healthy_rms_g)),
        (
            "meshtone.relative_difference",
            format!(
                "difference signal over one revolution of {}, over the rms of the enhanced healthy signal, meshtone.healthy_rms_g",
                scenario.wheel_in_words(&tuned.wheel)
            ),
        ),
    ];
    write_compressed(to, columns, records.len(), cells, metadata)
}
