//! The part of a recording that is not periodic: what is left without the averages of all shafts, or without all tones.

use meshtone_fourier::{Complex64, convenient_length, from_real_spectrum, hann_window, real_spectrum};

use super::check::{check_channel, check_count};
use super::interpolate::band_limited;
use super::{AngularSettings, Edge, ShaftPhase, SignalError, angular_resample, synchronous_average};

/// A recording without what repeats with its shafts.
#[derive(Debug, Clone, PartialEq)]
pub struct SynchronousResidual {
    /// Sample of the recording that the first value belongs to: the first whose angle is known.
    pub first_sample: usize,
    /// (unit of the signal) The values.
    pub values: Vec<f64>,
}

/// Removes the averages over the revolutions of all shafts from a recording, one after the other.
///
/// Each average is interpolated at the angle of each sample and subtracted. Bearings, which slip, and noise stay; an average of R revolutions
/// contains 1/R of their power.
///
/// # Arguments
/// * `signal` - the recording
/// * `phases` - of the shafts, in the order in which their averages are removed; the first sample and the number of all are the same
///
/// # Errors
/// No phase; phases of other samples; those of [`angular_resample`] and [`synchronous_average`].
///
/// Source: P. D. McFadden, M. M. Toozhy, "Application of synchronous averaging to vibration monitoring of rolling element bearings", Mech. Syst.
/// Signal Process. 14 (2000) 891–906.
///
/// ```
/// use std::f64::consts::TAU;
/// use meshtone::signal::{ShaftPhase, synchronous_residual};
///
/// let input = ShaftPhase::constant(20.0, 10_000.0, 100_000)?;
/// let output = input.of_mate(17, 38)?;
/// let mesh = |angle: f64| (TAU * 17.0 * angle).cos() + (TAU * angle).sin() + (TAU * angle * 17.0 / 38.0).sin();
/// let bearing = |angle: f64| 0.1 * (TAU * 3.585 * angle).cos();
/// let signal: Vec<f64> = input.revolutions.iter().map(|angle| mesh(*angle) + bearing(*angle)).collect();
/// let residual = synchronous_residual(&signal, &[input.clone(), output])?;
/// let off = residual.values.iter().zip(&input.revolutions).map(|(value, angle)| (value - bearing(*angle)).abs());
/// assert!(off.fold(0.0, f64::max) < 0.03);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn synchronous_residual(
    signal: &[f64],
    phases: &[ShaftPhase],
) -> Result<SynchronousResidual, SignalError> {
    check_count("phases of shafts", phases.len(), 1)?;
    let samples = |phase: &ShaftPhase| phase.first_sample..phase.first_sample + phase.revolutions.len();
    let covered = samples(&phases[0]);
    let mut residual = signal.to_vec();
    for phase in phases {
        if samples(phase) != covered {
            let (given, expected) = (phase.revolutions.len(), covered.len());
            return Err(SignalError::LengthMismatch { what: "phase of another shaft", given, expected });
        }
        let angular = angular_resample(&residual, phase, &AngularSettings::default())?;
        let average = synchronous_average(&angular)?.values;
        // The average begins at a whole revolution.
        let places = phase.revolutions.iter().map(|angle| angle.rem_euclid(1.0) * average.len() as f64);
        let repeated = band_limited(&average, places, Edge::Periodic);
        residual[covered.clone()].iter_mut().zip(repeated).for_each(|(value, off)| *value -= off);
    }
    Ok(SynchronousResidual { first_sample: covered.start, values: residual[covered].to_vec() })
}

/// A signal in two parts, whose sum it is.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct DiscreteRandomParts {
    /// (unit of the signal) Its tones: what can be predicted from the signal a delay earlier.
    pub discrete: Vec<f64>,
    /// (unit of the signal) All else: noise, and bearings, which slip.
    pub random: Vec<f64>,
}

/// Discrete-random separation: separates a signal of constant speed into its tones and the rest; the speed need not be known.
///
/// The transfer function from the signal a delay earlier to the signal, `H = Σ X Y* / Σ |Y|²` over blocks X with a Hann window, overlapping by
/// half, and the blocks Y a delay before them, is near 1 in size at tones and near 0 elsewhere, where the delay exceeds the memory of what
/// is random. Its size is the filter, without phase, so that nothing is delayed. From B blocks' length of noise it passes about
/// \\(0.9/\sqrt B\\) of the amplitude.
///
/// # Arguments
/// * `signal` - (any unit) the signal; beyond its ends it is taken as 0, so that the discrete part is too small within half a block of them
/// * `block_samples` - (at least 16) length of a block; it resolves tones whose distance is more than about four times the sampling rate
///   over it
/// * `delay_samples` - (at least 1) longer than a burst rings, and than slip leaves the next bursts in step: several revolutions
///
/// # Errors
/// NaN; a constant signal; blocks that are too short; a signal shorter than eight blocks and the delay.
///
/// Source: J. Antoni, R. B. Randall, "Unsupervised noise cancellation for vibration signals: part II – a novel frequency-domain algorithm", Mech.
/// Syst. Signal Process. 18 (2004) 103–117.
///
/// ```
/// use std::f64::consts::TAU;
///
/// let mut bits = 1u64;
/// let mut noise = || {
///     bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
///     (bits >> 11) as f64 / (1u64 << 52) as f64 - 1.0
/// };
/// let tone = |i: usize| 3.0 * (TAU * 0.1234 * i as f64).cos();
/// let signal: Vec<f64> = (0..100_000).map(|i| tone(i) + noise()).collect();
/// let parts = meshtone::signal::discrete_random_separation(&signal, 512, 512)?;
/// let off: Vec<f64> = (1000..99_000).map(|i| parts.discrete[i] - tone(i)).collect();
/// assert!(meshtone::signal::rms(&off) < 0.1);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn discrete_random_separation(
    signal: &[f64],
    block_samples: usize,
    delay_samples: usize,
) -> Result<DiscreteRandomParts, SignalError> {
    check_channel(signal)?;
    let size = |name, value: usize, allowed| Err(SignalError::parameter(name, value as f64, allowed));
    if block_samples < 16 {
        return size("block_samples", block_samples, "at least 16");
    }
    if delay_samples == 0 {
        return size("delay_samples", delay_samples, "at least 1");
    }
    let needed = block_samples.saturating_mul(8).saturating_add(delay_samples);
    check_count("samples for eight blocks and the delay", signal.len(), needed)?;
    let gain = predictable(signal, block_samples, delay_samples);
    // The filter's impulse response about 0, which is even, behind what the blocks' overlap leaves of it.
    let response =
        from_real_spectrum(gain.iter().map(|gain| Complex64::from(*gain)).collect(), block_samples);
    let padded = convenient_length(signal.len() + block_samples);
    let mut filter = vec![0.0; padded];
    for (lag, value) in response.iter().enumerate() {
        let is_ahead = 2 * lag > block_samples;
        filter[if is_ahead { padded - (block_samples - lag) } else { lag }] = *value;
    }
    let mut values = signal.to_vec();
    values.resize(padded, 0.0);
    let mut spectrum = real_spectrum(&values);
    spectrum.iter_mut().zip(real_spectrum(&filter)).for_each(|(line, gain)| *line *= gain);
    let mut discrete = from_real_spectrum(spectrum, padded);
    discrete.truncate(signal.len());
    let random = signal.iter().zip(&discrete).map(|(value, tone)| value - tone).collect();
    Ok(DiscreteRandomParts { discrete, random })
}

/// Part of each frequency's amplitude that can be predicted from the signal a delay earlier.
fn predictable(signal: &[f64], block_samples: usize, delay_samples: usize) -> Vec<f64> {
    let window = hann_window(block_samples);
    let spectrum = |block: &[f64]| {
        real_spectrum(&block.iter().zip(&window).map(|(value, window)| value * window).collect::<Vec<_>>())
    };
    let mut sums = vec![(Complex64::default(), 0.0); block_samples / 2 + 1];
    let last = signal.len() - delay_samples - block_samples;
    for start in (0..=last).step_by(block_samples / 2) {
        let earlier = spectrum(&signal[start..start + block_samples]);
        let now = spectrum(&signal[start + delay_samples..][..block_samples]);
        for ((cross, power), (now, earlier)) in sums.iter_mut().zip(now.iter().zip(&earlier)) {
            *cross += now * earlier.conj();
            *power += earlier.norm_sqr();
        }
    }
    let gain =
        |(cross, power): (Complex64, f64)| if power > 0.0 { (cross.norm() / power).min(1.0) } else { 0.0 };
    sums.into_iter().map(gain).collect()
}
