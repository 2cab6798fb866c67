//! Reading signals at any places behind an anti-aliasing filter.

use std::sync::OnceLock;

use super::check::check_positive;
use super::kaiser::{kaiser, sinc};
use super::{Edge, SignalError};

/// Zero crossings of the filter on each side and Kaiser's β: those of [`super::resample`].
const ZERO_CROSSINGS: usize = 10;
const BETA: f64 = 5.0;
/// Values of the filter that are tabulated between two zero crossings: straight lines between them are off by 1.2e-6 of the
/// middle tap at most.
const PROTOTYPE_STEPS: usize = 1024;
/// Rows of taps between two samples, times the ratio of the rates: straight lines between them are off by 4.7e-6 at most.
const ROW_STEPS: f64 = 512.0;
/// Sums that run side by side: as many as processors have in four vector registers, so that none waits for the one before.
const LANES: usize = 32;

/// A low-pass filter at half the lower of two sampling rates, whatever their ratio, that reads signals in single precision at
/// any places.
///
/// Its frequency response is that of [`super::resample`]: within 0.2 % of 1 up to 0.8 of half the lower rate, 0.5 at
/// half that rate, and below 0.2 % from 1.2 of it on. The ratio of the rates need not be one of whole numbers.
#[derive(Debug, Clone)]
pub struct AntiAliasing {
    /// Samples on each side of a place.
    reach: usize,
    /// Taps in a row: twice the reach, made a multiple of [`LANES`] with zeros.
    taps: usize,
    steps: usize,
    /// `steps + 1` rows, one for each place between two samples.
    rows: Vec<f32>,
}

impl AntiAliasing {
    /// The filter for two rates.
    ///
    /// # Arguments
    /// * `from_hz` - (S/s) rate of the signals
    /// * `to_hz` - (S/s) rate at which they will be read
    ///
    /// # Errors
    /// A rate that is not positive, or below 1e-5 of the other.
    ///
    /// Source: J. O. Smith, P. Gossett, "A flexible sampling-rate conversion method", Proc. IEEE ICASSP (1984) 19.4.1–4.
    ///
    /// ```
    /// use meshtone::signal::{AntiAliasing, Edge};
    ///
    /// let tone = |t: f64| (std::f64::consts::TAU * 10.0 * t).cos() as f32;
    /// let signal: Vec<f32> = (0..1000).map(|i| tone(f64::from(i) / 1000.0)).collect();
    /// let filter = AntiAliasing::new(1000.0, 123.4)?;
    /// let read = filter.read(&[&signal], (0..123).map(|i| f64::from(i) * 1000.0 / 123.4), Edge::Periodic);
    /// assert!(read[0].iter().enumerate().all(|(i, x)| (x - tone(i as f64 / 123.4)).abs() < 2e-3));
    /// # Ok::<(), meshtone::signal::SignalError>(())
    /// ```
    pub fn new(from_hz: f64, to_hz: f64) -> Result<Self, SignalError> {
        check_positive("from_hz", from_hz)?;
        check_positive("to_hz", to_hz)?;
        let rate = (from_hz / to_hz).max(1.0);
        if rate > 1e5 {
            return Err(SignalError::parameter("to_hz", to_hz, "at least 1e-5 of from_hz"));
        }
        let reach = (ZERO_CROSSINGS as f64 * rate).ceil() as usize;
        let taps = (2 * reach).next_multiple_of(LANES);
        let steps = (ROW_STEPS / rate).ceil() as usize;
        let mut rows = vec![0.0; taps * (steps + 1)];
        for (step, row) in rows.chunks_exact_mut(taps).enumerate() {
            let place = step as f64 / steps as f64 + (reach - 1) as f64;
            let weights: Vec<f64> = (0..2 * reach).map(|i| prototype((place - i as f64) / rate)).collect();
            let sum: f64 = weights.iter().sum();
            row.iter_mut().zip(weights).for_each(|(tap, weight)| *tap = (weight / sum) as f32);
        }
        Ok(Self { reach, taps, steps, rows })
    }

    /// Reads signals of one length at places between their samples.
    ///
    /// # Arguments
    /// * `signals` - the samples
    /// * `places` - in samples from the first; fractions are places between samples
    /// * `edge` - how the signals go on beyond their ends
    ///
    /// Returns the values of each signal. The order of all additions is fixed: the same bits on every machine.
    pub fn read(&self, signals: &[&[f32]], places: impl Iterator<Item = f64>, edge: Edge) -> Vec<Vec<f32>> {
        // Compiled for several sets of vector instructions. None of them fuses a multiplication with an addition here.
        pulp::Arch::new().dispatch(Reading { filter: self, signals, places, edge })
    }

    #[inline(always)]
    fn read_at(&self, signals: &[&[f32]], places: impl Iterator<Item = f64>, edge: Edge) -> Vec<Vec<f32>> {
        let expected = places.size_hint().0;
        let mut values: Vec<Vec<f32>> = signals.iter().map(|_| Vec::with_capacity(expected)).collect();
        let mut taps = vec![0.0; self.taps];
        let mut window = vec![0.0; self.taps];
        for place in places {
            let whole = place.floor();
            self.taps_at(place - whole, &mut taps);
            let first = whole as isize + 1 - self.reach as isize;
            for (values, signal) in values.iter_mut().zip(signals) {
                let inside = usize::try_from(first).ok().and_then(|i| signal.get(i..i + self.taps));
                let samples = inside.unwrap_or_else(|| {
                    for (x, i) in window.iter_mut().zip(first..) {
                        *x = edge.index(i, signal.len()).map_or(0.0, |i| signal[i]);
                    }
                    &window
                });
                values.push(weighted(&taps, samples));
            }
        }
        values
    }

    /// Taps for a place of `fraction` between two samples.
    #[inline(always)]
    fn taps_at(&self, fraction: f64, taps: &mut [f32]) {
        let step = fraction * self.steps as f64;
        let row = (step as usize).min(self.steps - 1);
        let t = (step - row as f64) as f32;
        let [a, b] = [row, row + 1].map(|row| &self.rows[row * self.taps..(row + 1) * self.taps]);
        for ((tap, a), b) in taps.iter_mut().zip(a).zip(b) {
            *tap = a + t * (b - a);
        }
    }
}

/// One call of [`AntiAliasing::read`].
struct Reading<'a, P> {
    filter: &'a AntiAliasing,
    signals: &'a [&'a [f32]],
    places: P,
    edge: Edge,
}

impl<P: Iterator<Item = f64>> pulp::NullaryFnOnce for Reading<'_, P> {
    type Output = Vec<Vec<f32>>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.filter.read_at(self.signals, self.places, self.edge)
    }
}

/// `Σ taps x`, in as many sums as run side by side.
#[inline(always)]
fn weighted(taps: &[f32], x: &[f32]) -> f32 {
    let mut sums = [0.0f32; LANES];
    for (taps, x) in taps.chunks_exact(LANES).zip(x.chunks_exact(LANES)) {
        for lane in 0..LANES {
            sums[lane] += taps[lane] * x[lane];
        }
    }
    // Halves onto halves, down to one.
    let mut width = LANES / 2;
    while width > 0 {
        for lane in 0..width {
            sums[lane] += sums[lane + width];
        }
        width /= 2;
    }
    sums[0]
}

/// The filter at `t` zero crossings from its middle, of height 1.
fn prototype(t: f64) -> f64 {
    static TABLE: OnceLock<Vec<f64>> = OnceLock::new();
    let last = ZERO_CROSSINGS * PROTOTYPE_STEPS;
    let table = TABLE.get_or_init(|| {
        let value = |i: usize| {
            let t = i as f64 / PROTOTYPE_STEPS as f64;
            sinc(t) * kaiser(t / ZERO_CROSSINGS as f64, BETA)
        };
        (0..=last).map(value).collect()
    });
    let place = t.abs() * PROTOTYPE_STEPS as f64;
    let index = place as usize;
    if index >= last {
        return 0.0;
    }
    let fraction = place - index as f64;
    table[index] + fraction * (table[index + 1] - table[index])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::resample;

    /// A periodic signal with content up to half its rate.
    fn noise(len: usize) -> Vec<f32> {
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state as f32 / u32::MAX as f32 - 0.5
        };
        (0..len).map(|_| next()).collect()
    }

    #[test]
    fn at_whole_ratios_it_is_the_polyphase_filter() {
        let signal = noise(600);
        for (up, down) in [(1, 6), (2, 5), (5, 12), (1, 1)] {
            let double: Vec<f64> = signal.iter().map(|&x| f64::from(x)).collect();
            let expected = resample(&double, up, down, Edge::Periodic).unwrap();
            let filter = AntiAliasing::new(down as f64, up as f64).unwrap();
            let places = (0..expected.len()).map(|i| i as f64 * down as f64 / up as f64);
            let read = filter.read(&[&signal], places, Edge::Periodic).remove(0);
            let off = read.iter().zip(&expected).map(|(x, y)| (f64::from(*x) - y).abs()).fold(0.0, f64::max);
            // Here every row of taps adds up to 1, there only all of them together.
            assert!(off < 1e-4, "{up}/{down}: {off}");
        }
    }

    #[test]
    fn what_the_lower_rate_cannot_show_is_taken_away() {
        let tone = |hz: f64| -> Vec<f32> {
            (0..10_000).map(|i| (std::f64::consts::TAU * hz * f64::from(i) / 1e4).cos() as f32).collect()
        };
        let filter = AntiAliasing::new(1e4, 997.3).unwrap();
        let largest = |hz: f64| {
            let read =
                filter.read(&[&tone(hz)], (0..997).map(|i| f64::from(i) * 1e4 / 997.3), Edge::Periodic);
            read[0].iter().fold(0.0f32, |largest, x| largest.max(x.abs()))
        };
        assert!((largest(390.0) - 1.0).abs() < 2.5e-3);
        assert!(largest(610.0) < 2.5e-3);
        assert!(largest(3000.0) < 5e-4);
    }

    #[test]
    fn rates_that_are_none_are_refused() {
        for (from, to) in [(0.0, 1.0), (1.0, -1.0), (f64::NAN, 1.0), (1e6, 1.0)] {
            assert!(AntiAliasing::new(from, to).is_err(), "{from} {to}");
        }
    }
}
