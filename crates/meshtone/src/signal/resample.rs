//! Another sampling rate.

use super::anti_aliasing::AntiAliasing;
use super::check::{check_count, check_finite, check_positive};
use super::filter_bank::{BankPosition, FilterBank};
use super::kaiser::windowed_sinc;
use super::{Edge, SignalError};
use crate::operation::greatest_common_divisor;

/// Zero crossings of the default filter on each side, in samples of the lower rate.
pub(super) const ZERO_CROSSINGS: usize = 10;
/// Kaiser's β of the default filter.
pub(super) const BETA: f64 = 5.0;
/// Largest `up` and `down`: the filter has 20 times as many taps.
const LARGEST_FACTOR: usize = 100_000;
/// Relative deviation of a ratio of rates that is taken for rounding.
const RATIO_TOLERANCE: f64 = 1e-12;

/// Resamples a signal to any other rate behind an anti-aliasing filter.
///
/// Where the rates have a ratio of whole numbers up to 100 000, see [`resampling_ratio`], it is [`resample`]. Any other ratio is
/// that of an [`AntiAliasing`] filter, the same low-pass: what lies between its tabulated rows of taps is off by 4.7e-6 of the
/// signal's largest value at most.
///
/// # Arguments
/// * `signal` - the samples
/// * `from_hz` - (S/s) their rate
/// * `to_hz` - (S/s) the rate that is wanted
/// * `edge` - how the signal goes on beyond its ends
///
/// Returns `⌈n to/from⌉` samples; sample m lies at `m from/to` of the signal.
///
/// # Errors
/// An empty signal; a sample that is no number; a rate that is not positive, or above 1e5 of the other.
///
/// ```
/// use meshtone::signal::{Edge, resample_to};
///
/// let tone = |t: f64| (std::f64::consts::TAU * 30.0 * t).cos();
/// let signal: Vec<f64> = (0..1000).map(|i| tone(f64::from(i) / 1000.0)).collect();
/// let resampled = resample_to(&signal, 1000.0, std::f64::consts::PI * 100.0, Edge::Periodic)?;
/// assert!(resampled.iter().enumerate().all(|(i, x)| (x - tone(i as f64 / 314.159265)).abs() < 2e-3));
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn resample_to(signal: &[f64], from_hz: f64, to_hz: f64, edge: Edge) -> Result<Vec<f64>, SignalError> {
    if let Some((up, down)) = whole_ratio(from_hz, to_hz)? {
        return resample(signal, up, down, edge);
    }
    check_count("samples", signal.len(), 1)?;
    check_finite(signal)?;
    let step = from_hz / to_hz;
    let samples = (signal.len() as f64 / step).ceil() as usize;
    let places = (0..samples).map(|m| m as f64 * step);
    Ok(AntiAliasing::new(from_hz, to_hz)?.read_double(signal, places, edge))
}

/// Resamples a signal by the ratio `up/down` behind an anti-aliasing filter.
///
/// The filter is the one of MATLAB's `resample` and SciPy's `resample_poly`: [`resampling_taps`]. It has linear phase and
/// its delay is taken out, so that sample m of the result lies at `m down/up` of the signal. It is within 0.2 % of 1 up to
/// 0.8 of half the lower rate, 0.5 at half that rate, and below 0.2 % from 1.2 of it on.
///
/// # Arguments
/// * `signal` - the samples
/// * `up`, `down` - ratio of the rates, new over old, see [`resampling_ratio`]; common factors are taken out
/// * `edge` - how the signal goes on beyond its ends
///
/// Returns `⌈n up/down⌉` samples.
///
/// # Errors
/// An empty signal; a sample that is no number; a factor of 0 or beyond 100 000.
///
/// ```
/// use meshtone::signal::{Edge, resample};
///
/// let wave = |i: usize, n: f64| (std::f64::consts::TAU * 3.0 * i as f64 / n).cos();
/// let signal: Vec<f64> = (0..100).map(|i| wave(i, 100.0)).collect();
/// let resampled = resample(&signal, 2, 5, Edge::Periodic)?;
/// assert_eq!(resampled.len(), 40);
/// assert!(resampled.iter().enumerate().all(|(i, x)| (x - wave(i, 40.0)).abs() < 1e-3));
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn resample(signal: &[f64], up: usize, down: usize, edge: Edge) -> Result<Vec<f64>, SignalError> {
    let (up, down) = reduced(up, down)?;
    if up == down {
        check_finite(signal)?;
        return Ok(signal.to_vec());
    }
    resample_with(signal, up, down, &resampling_taps(up, down)?, edge)
}

/// Resamples with a filter of one's own: the signal with `up − 1` zeros after every sample, filtered, every `down`-th
/// sample of that.
///
/// # Arguments
/// * `signal` - the samples
/// * `up`, `down` - ratio of the rates, new over old, taken as they are
/// * `taps` - an odd number, at `up` times the signal's rate; the middle one has no delay
/// * `edge` - how the signal goes on beyond its ends
///
/// Returns `⌈n up/down⌉` samples.
///
/// # Errors
/// Those of [`resample`]; an even number of taps.
///
/// Source: R. E. Crochiere, L. R. Rabiner, "Multirate Digital Signal Processing", Prentice-Hall (1983), section 3.3.
///
/// ```
/// use meshtone::signal::{Edge, resample_with};
///
/// let line = resample_with(&[0.0, 1.0, 2.0], 2, 1, &[0.5, 1.0, 0.5], Edge::Reflect)?;
/// assert_eq!(line, [0.0, 0.5, 1.0, 1.5, 2.0, 1.5]);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn resample_with(
    signal: &[f64],
    up: usize,
    down: usize,
    taps: &[f64],
    edge: Edge,
) -> Result<Vec<f64>, SignalError> {
    check_factors(up, down)?;
    check_count("samples", signal.len(), 1)?;
    check_finite(signal)?;
    if taps.len().is_multiple_of(2) {
        return Err(SignalError::parameter("number of taps", taps.len() as f64, "odd"));
    }
    let length = taps.len().div_ceil(up);
    let bank = FilterBank::new((0..up).map(|position| branch(taps, up, position, length)));
    let samples = (signal.len() * up).div_ceil(down);
    // Where the filter's first tap lies at first: on a sample, or so many steps of the high rate behind it.
    let (mut newest, mut behind) = (taps.len() / 2 / up, taps.len() / 2 % up);
    let places = (0..samples).map(|_| {
        let place = BankPosition { first: newest as isize + 1 - length as isize, row: behind, between: 0.0 };
        newest += down / up;
        behind += down % up;
        if behind >= up {
            (newest, behind) = (newest + 1, behind - up);
        }
        place
    });
    Ok(bank.read(&[signal], places, edge, |value| value).swap_remove(0))
}

/// The default filter: an ideal low-pass at half the lower rate under Kaiser's window with β = 5 and 10 zero crossings on
/// each side, scaled to `Σ taps = up`.
///
/// # Arguments
/// * `up`, `down` - ratio of the rates, in lowest terms
///
/// Returns `20 max(up, down) + 1` taps, those of SciPy's `firwin(20 r + 1, 1/r, window=("kaiser", 5.0)) * up` with
/// `r = max(up, down)`.
///
/// # Errors
/// A factor of 0 or beyond 100 000.
///
/// ```
/// let taps = meshtone::signal::resampling_taps(1, 4)?;
/// assert_eq!(taps.len(), 81);
/// assert!((taps.iter().sum::<f64>() - 1.0).abs() < 1e-12);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn resampling_taps(up: usize, down: usize) -> Result<Vec<f64>, SignalError> {
    check_factors(up, down)?;
    let rate = up.max(down);
    let half = ZERO_CROSSINGS * rate;
    let mut taps: Vec<f64> = (0..=2 * half)
        .map(|i| {
            let offset = i as f64 - half as f64;
            windowed_sinc(offset / rate as f64, ZERO_CROSSINGS as f64, BETA)
        })
        .collect();
    let scale = up as f64 / taps.iter().sum::<f64>();
    taps.iter_mut().for_each(|tap| *tap *= scale);
    Ok(taps)
}

/// The ratio `up/down` in lowest terms that turns one sampling rate into another.
///
/// # Arguments
/// * `from_hz` - (S/s) the rate there is
/// * `to_hz` - (S/s) the rate that is wanted
///
/// The best fraction within a relative 1e-12 of the ratio of the rates, by continued fractions.
///
/// # Errors
/// A rate that is not positive; rates with no such fraction up to 100 000.
///
/// ```
/// assert_eq!(meshtone::signal::resampling_ratio(258_400.0, 25_000.0), Ok((125, 1292)));
/// ```
pub fn resampling_ratio(from_hz: f64, to_hz: f64) -> Result<(usize, usize), SignalError> {
    whole_ratio(from_hz, to_hz)?.ok_or_else(|| {
        let required = "a fraction of whole numbers up to 100 000";
        SignalError::parameter("ratio of the sampling rates", to_hz / from_hz, required)
    })
}

/// Those of [`resampling_ratio`]; none where there is no such fraction.
pub(crate) fn whole_ratio(from_hz: f64, to_hz: f64) -> Result<Option<(usize, usize)>, SignalError> {
    check_positive("from_hz", from_hz)?;
    check_positive("to_hz", to_hz)?;
    let wanted = to_hz / from_hz;
    let (mut up, mut down) = ((1.0, wanted.floor()), (0.0, 1.0));
    let mut rest = wanted - wanted.floor();
    while (up.1 / down.1 - wanted).abs() > RATIO_TOLERANCE * wanted {
        let inverse = 1.0 / rest;
        let whole = inverse.floor();
        up = (up.1, whole * up.1 + up.0);
        down = (down.1, whole * down.1 + down.0);
        rest = inverse - whole;
        let largest: f64 = up.1.max(down.1);
        if largest.is_nan() || largest > LARGEST_FACTOR as f64 {
            return Ok(None);
        }
    }
    let found = (up.1 as usize, down.1 as usize);
    Ok((1..=LARGEST_FACTOR).contains(&found.0).then_some(found))
}

/// The filter's taps for a new sample at one of `up` positions between two old ones: every `up`-th of them, that of the oldest
/// sample first, behind zeros where there are fewer than `length`.
fn branch(taps: &[f64], up: usize, position: usize, length: usize) -> Vec<f64> {
    let mut branch: Vec<f64> = taps.iter().skip(position).step_by(up).copied().collect();
    branch.resize(length, 0.0);
    branch.reverse();
    branch
}

fn check_factors(up: usize, down: usize) -> Result<(), SignalError> {
    for (name, factor) in [("up", up), ("down", down)] {
        if factor == 0 || factor > LARGEST_FACTOR {
            return Err(SignalError::parameter(name, factor as f64, "a whole number from 1 to 100 000"));
        }
    }
    Ok(())
}

fn reduced(up: usize, down: usize) -> Result<(usize, usize), SignalError> {
    let divisor = greatest_common_divisor(up, down).max(1);
    check_factors(up / divisor, down / divisor)?;
    Ok((up / divisor, down / divisor))
}
