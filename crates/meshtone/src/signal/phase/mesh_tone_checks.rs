//! Checks that a mesh tone can be followed.

use meshtone_fourier::Complex64;

use super::mesh_tone::{Band, MeshTone};
use crate::signal::check::{check_channel, check_count, check_positive, check_rate};
use crate::signal::{SignalError, SignalWarning, upper_median};

/// Least mean power in the band over the median around it.
const LEAST_POWER_RATIO: f64 = 3.0;
/// Amplitude of a line beside the band over the strongest in it that makes one doubt.
const STRONGER: f64 = 2.0;
/// (shaft orders) How far beside the mesh such a line is looked for.
const NEIGHBOURHOOD: f64 = 4.5;
/// (shaft orders) Where the other lines of ringing are: beyond a line's own skirt, up to the next sideband.
const RINGING: [f64; 2] = [0.2, 1.25];
/// Least amplitude over those of a line that is a tone of its own.
const STANDS_OUT: f64 = 1.5;
/// Part of the mean amplitude below which the phase is doubtful.
const FADED: f64 = 0.1;

/// Checks whether the tone and its band make sense for the recording.
pub(super) fn check(signal: &[f64], sampling_rate_hz: f64, tone: &MeshTone) -> Result<(), SignalError> {
    check_rate(sampling_rate_hz)?;
    check_positive("teeth", f64::from(tone.teeth))?;
    check_positive("harmonic", f64::from(tone.harmonic))?;
    check_positive("shaft_hz", tone.shaft_hz)?;
    let (frequency_hz, half_band_hz) = (tone.frequency_hz(), tone.half_band_hz());
    check_positive("half_band_hz", half_band_hz)?;
    if half_band_hz >= frequency_hz {
        return Err(SignalError::parameter("half_band_hz", half_band_hz, "less than the tone's frequency"));
    }
    if frequency_hz + half_band_hz >= 0.5 * sampling_rate_hz {
        return Err(SignalError::MeshOrderBeyondNyquist {
            mesh_order: tone.per_revolution(),
            nyquist_order: 0.5 * sampling_rate_hz / tone.shaft_hz,
        });
    }
    check_channel(signal)?;
    let needed = (4.0 * sampling_rate_hz / half_band_hz).ceil() as usize;
    check_count("samples for a band so narrow", signal.len(), needed)
}

/// Checks whether there is a tone in the band, and none stronger beside it.
///
/// Without a tone the phase of the band would be that of noise, which is an error. A stronger tone near by is the mesh at another speed
/// than was stated, perhaps, and a warning; unless many lines beside it are as strong, as where a resonance rings.
pub(super) fn check_tone(
    spectrum: &[Complex64],
    band: &Band,
    tone: &MeshTone,
    bins_per_hz: f64,
) -> Result<Vec<SignalWarning>, SignalError> {
    let power = |bin: usize| spectrum[bin].norm_sqr();
    let mean = band.bins().map(power).sum::<f64>() / (2 * band.half + 1) as f64;
    let around = band.middle / 2..(band.middle + band.middle / 2).min(spectrum.len());
    let noise: Vec<f64> = around.filter(|bin| !band.bins().contains(bin)).map(power).collect();
    let ratio = if mean > 0.0 { mean / upper_median(&noise) } else { 0.0 };
    if ratio < LEAST_POWER_RATIO {
        return Err(SignalError::NoMeshTone {
            frequency_hz: tone.frequency_hz(),
            half_band_hz: tone.half_band_hz(),
            ratio,
            needed: LEAST_POWER_RATIO,
        });
    }
    let reach = (NEIGHBOURHOOD * tone.shaft_hz * bins_per_hz) as usize;
    let near = band.middle.saturating_sub(reach)..(band.middle + reach).min(spectrum.len());
    let strongest = |bins: &mut dyn Iterator<Item = usize>| {
        bins.map(|bin| (bin, power(bin))).max_by(|a, b| a.1.total_cmp(&b.1))
    };
    let inside = strongest(&mut band.bins());
    let beside = strongest(&mut near.filter(|bin| !band.bins().contains(bin)));
    let (Some((_, inside)), Some((bin, beside))) = (inside, beside) else { return Ok(Vec::new()) };
    // Ringing of damaged teeth is many lines about a resonance, none of which is a mesh.
    let [skirt, next] = RINGING.map(|orders| (orders * tone.shaft_hz * bins_per_hz) as usize);
    let others = bin.saturating_sub(next)..(bin + next).min(spectrum.len());
    let around =
        strongest(&mut others.filter(|other| other.abs_diff(bin) > skirt && !band.bins().contains(other)));
    let is_ringing = around.is_some_and(|(_, around)| beside < STANDS_OUT.powi(2) * around);
    let ratio = (beside / inside).sqrt();
    let frequency_hz = bin as f64 / bins_per_hz;
    let speed_hz = frequency_hz / tone.per_revolution();
    let warning = SignalWarning::StrongerNeighbour { frequency_hz, ratio, speed_hz };
    Ok((ratio >= STRONGER && !is_ringing).then_some(warning).into_iter().collect())
}

/// Checks whether the tone nearly vanishes somewhere.
pub(super) fn check_fading(
    baseband: &[Complex64],
    samples_per_point: f64,
    kept: &std::ops::Range<usize>,
) -> Option<SignalWarning> {
    let inside = |point: usize| kept.contains(&((point as f64 * samples_per_point) as usize));
    let amplitudes: Vec<(usize, f64)> =
        baseband.iter().map(|z| z.norm()).enumerate().filter(|&(point, _)| inside(point)).collect();
    let mean = amplitudes.iter().map(|(_, amplitude)| amplitude).sum::<f64>() / amplitudes.len() as f64;
    let (point, least) = amplitudes.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let sample = (point as f64 * samples_per_point) as usize;
    (least < FADED * mean).then(|| SignalWarning::MeshToneFades { sample, ratio: least / mean })
}
