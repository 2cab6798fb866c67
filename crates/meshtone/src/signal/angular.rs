//! A signal over the angle of a shaft instead of over time.

use super::check::{check_channel, check_length};
use super::interpolate::{band_limited, pchip};
use super::{Edge, ShaftPhase, SignalError};

/// Relative excess over a power of two that is taken for rounding.
const ROUNDING: f64 = 1e-6;
/// (rev) Distance from a whole revolution that is taken for rounding.
const ANGLE_ROUNDING: f64 = 1e-9;

/// Most points per revolution: half a gigabyte a revolution.
const MOST_POINTS: usize = 1 << 26;

/// Interpolation of the signal between its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Interpolation {
    /// PCHIP, as the published code: [`super::interpolate_pchip`]. It flattens peaks: a tone of 5 samples a period loses 5 %.
    Pchip,
    /// Sinc under Kaiser's window: [`super::interpolate_band_limited`]. Exact to 1.2e-5 of a tone up to 0.8 of half the sampling
    /// rate.
    #[default]
    BandLimited,
}

impl Interpolation {
    /// (-) Part of half the sampling rate up to which a tone loses less than 5 %.
    pub(super) fn passed(self) -> f64 {
        match self {
            Self::Pchip => 0.4,
            Self::BandLimited => 0.8,
        }
    }
}

/// A signal over whole revolutions of a shaft, at equal angles.
#[derive(Debug, Clone, PartialEq)]
pub struct AngularSignal {
    /// Number of values in a revolution.
    pub points_per_revolution: usize,
    /// (rev) Angle of the first value.
    pub start_rev: f64,
    /// (orders) Half the samples in the quickest revolution of the recording: the signal holds nothing beyond it.
    pub nyquist_order: f64,
    /// The values, revolution after revolution.
    pub values: Vec<f64>,
}

impl AngularSignal {
    /// Number of revolutions.
    pub fn revolutions(&self) -> usize {
        self.values.len().checked_div(self.points_per_revolution).unwrap_or(0)
    }
}

/// Settings of the resampling over the angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct AngularSettings {
    /// Number of values in a revolution; by default [`points_per_revolution`].
    pub points_per_revolution: Option<usize>,
    /// Interpolation of the signal between its samples.
    pub interpolation: Interpolation,
    /// Continuation of the signal beyond the recording's ends. With [`Edge::Periodic`] it must span whole revolutions, and all
    /// of them are used; otherwise those whose every value lies between the first and the last sample.
    pub edge: Edge,
}

/// The power of two not below the number of samples in a revolution: `2^⌈log₂ n⌉`.
///
/// Of the slowest revolution, so that nothing is lost where the speed varies.
///
/// # Arguments
/// * `phase` - the shaft's phase
///
/// ```
/// use meshtone::signal::{ShaftPhase, points_per_revolution};
///
/// let phase = ShaftPhase::constant(40.0 * 17.0 / 38.0, 25_000.0, 25_000)?;
/// assert_eq!(points_per_revolution(&phase), 2048); // 1397.06 samples
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn points_per_revolution(phase: &ShaftPhase) -> usize {
    let revolutions = &phase.revolutions;
    let mut start = 0;
    let mut longest = 0.0_f64;
    for end in 1..revolutions.len() {
        while revolutions[end] - revolutions[start + 1] >= 1.0 {
            start += 1;
        }
        let turned = revolutions[end] - revolutions[start];
        let samples = (end - start) as f64;
        if turned >= 1.0 && samples > longest * turned {
            longest = samples / turned;
        }
    }
    if longest == 0.0 {
        longest = revolutions.len().saturating_sub(1) as f64 / phase.span_rev();
    }
    let samples = (longest * (1.0 - ROUNDING)).ceil() as usize;
    samples.checked_next_power_of_two().unwrap_or(usize::MAX)
}

/// Resamples a signal at equal angles of a shaft, over whole revolutions.
///
/// # Arguments
/// * `signal` - the recording
/// * `phase` - the shaft's phase at its samples
/// * `settings` - points per revolution, interpolation, edges
///
/// The first value is at the first whole revolution of the phase: with pulses once a revolution, at a pulse. With
/// [`Edge::Periodic`] it is at the phase's first sample.
///
/// # Errors
/// NaN; a constant channel; a phase that is not the recording's; no number of points between 2 and 2²⁶; fewer than one whole revolution; not whole revolutions where
/// the signal is to be continued periodically.
///
/// Source: K. R. Fyfe, E. D. S. Munck, "Analysis of computed order tracking", Mech. Syst. Signal Process. 11 (1997)
/// 187–205.
///
/// ```
/// use meshtone::signal::{AngularSettings, ShaftPhase, angular_resample};
///
/// // Five periods a revolution, while the shaft speeds up.
/// let phase = ShaftPhase::from_speed_profile(&[0.0, 1.0], &[5.0, 15.0], 4000.0, 4001)?;
/// let signal: Vec<f64> = phase.revolutions.iter().map(|r| (std::f64::consts::TAU * 5.0 * r).sin()).collect();
/// let angular = angular_resample(&signal, &phase, &AngularSettings::default())?;
/// assert_eq!((angular.points_per_revolution, angular.revolutions()), (1024, 10));
/// let steady = |i: usize| (std::f64::consts::TAU * 5.0 * i as f64 / 1024.0).sin();
/// assert!((100..9000).all(|i| (angular.values[i] - steady(i)).abs() < 1e-4));
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn angular_resample(
    signal: &[f64],
    phase: &ShaftPhase,
    settings: &AngularSettings,
) -> Result<AngularSignal, SignalError> {
    check_channel(signal)?;
    phase.check()?;
    let end = phase.first_sample.saturating_add(phase.revolutions.len());
    if end > signal.len() {
        let what = "samples of the recording, by its phase";
        return Err(SignalError::LengthMismatch { what, given: signal.len(), expected: end });
    }
    let points = settings.points_per_revolution.unwrap_or_else(|| points_per_revolution(phase));
    if points < 2 {
        return Err(SignalError::parameter("points_per_revolution", points as f64, "at least 2"));
    }
    let Revolutions { start_rev, count, next_rev } = match settings.edge {
        Edge::Periodic => whole_recording(signal, phase)?,
        Edge::Zero | Edge::Reflect => whole_revolutions(phase, points)?,
    };
    if points > MOST_POINTS {
        return Err(SignalError::parameter("points_per_revolution", points as f64, "at most 67 108 864"));
    }
    let places = places(phase, next_rev, start_rev, points, count);
    let values = match settings.interpolation {
        Interpolation::Pchip => pchip(signal, places, settings.edge),
        Interpolation::BandLimited => band_limited(signal, places, settings.edge),
    };
    Ok(AngularSignal {
        points_per_revolution: points,
        start_rev,
        nyquist_order: nyquist_order(phase),
        values,
    })
}

/// The revolutions that are used.
struct Revolutions {
    start_rev: f64,
    count: usize,
    /// Phase one sample after the last: where a periodic signal begins again.
    next_rev: f64,
}

fn whole_revolutions(phase: &ShaftPhase, points: usize) -> Result<Revolutions, SignalError> {
    let start_rev = (phase.revolutions[0] - ANGLE_ROUNDING).ceil();
    let last_point = 1.0 - 1.0 / points as f64;
    let count = (phase.last() - start_rev - last_point + ANGLE_ROUNDING).floor() + 1.0;
    if count < 1.0 {
        // One may begin anywhere: of two at least one is whole.
        return Err(SignalError::TooFewRevolutions { revolutions: phase.span_rev(), needed: 2 });
    }
    Ok(Revolutions { start_rev, count: count as usize, next_rev: phase.last() })
}

fn whole_recording(signal: &[f64], phase: &ShaftPhase) -> Result<Revolutions, SignalError> {
    let revolutions = &phase.revolutions;
    check_length("phase of a recording that is continued periodically", revolutions.len(), signal.len())?;
    let step = phase.last() - revolutions[revolutions.len() - 2];
    let span = phase.span_rev() + step;
    let count = span.round();
    if count < 1.0 || (span - count).abs() > 0.5 * step {
        return Err(SignalError::NotWholeRevolutions { revolutions: span });
    }
    Ok(Revolutions { start_rev: revolutions[0], count: count as usize, next_rev: revolutions[0] + count })
}

/// Places of the values between the samples, straight lines between the samples' phases.
fn places(
    phase: &ShaftPhase,
    next_rev: f64,
    start_rev: f64,
    points: usize,
    revolutions: usize,
) -> impl Iterator<Item = f64> {
    let known = &phase.revolutions;
    let at = move |sample: usize| known.get(sample).copied().unwrap_or(next_rev);
    let last = if next_rev > phase.last() { known.len() } else { known.len() - 1 };
    let within: Vec<f64> = (0..points).map(|point| point as f64 / points as f64).collect();
    let (mut revolution, mut revolution_start, mut point) = (0, start_rev, 0);
    let (mut sample, mut from, mut to) = (0, at(0), at(1));
    (0..points * revolutions).map(move |_| {
        if point == points {
            revolution += 1;
            (point, revolution_start) = (0, start_rev + revolution as f64);
        }
        let angle = revolution_start + within[point];
        point += 1;
        while sample + 1 < last && to <= angle {
            sample += 1;
            (from, to) = (to, at(sample + 1));
        }
        (phase.first_sample + sample) as f64 + (angle - from) / (to - from)
    })
}

fn nyquist_order(phase: &ShaftPhase) -> f64 {
    let steps = phase.revolutions.windows(2).map(|pair| pair[1] - pair[0]);
    0.5 / steps.fold(0.0, f64::max)
}
