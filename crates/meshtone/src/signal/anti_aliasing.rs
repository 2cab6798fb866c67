//! Reading signals at any places behind an anti-aliasing filter.

use std::sync::{Arc, LazyLock};

use super::check::check_positive;
use super::filter_bank::{BankPosition, FilterBank, SincCurve};
use super::resample::{BETA, ZERO_CROSSINGS};
use super::{Edge, SignalError};
use crate::known::Known;

/// Rows of taps between two samples, times the ratio of the rates: straight lines between them are off by 4.7e-6 at most.
const ROW_STEPS: f64 = 512.0;
/// The filter of [`super::resample`].
static CURVE: LazyLock<SincCurve> = LazyLock::new(|| SincCurve::new(ZERO_CROSSINGS, BETA));
/// The steep filter: 80 dB in a transition of 0.2 of half the lower rate, by Kaiser's formulas for its window's β and length.
static STEEP_CURVE: LazyLock<SincCurve> = LazyLock::new(|| SincCurve::new(23, 7.857));
/// (-) Its cutoff over half the lower rate: the middle of the transition from 0.8 to 1.
const STEEP_CUTOFF: f64 = 0.9;
/// Steep filters that are kept: records of a data set are read with few ratios of rates beside their own.
const KEPT: usize = 16;

/// A low-pass filter at half the lower of two sampling rates, whatever their ratio, that reads signals in single precision at
/// any places.
///
/// Its frequency response is that of [`super::resample`]: within 0.2 % of 1 up to 0.8 of half the lower rate, 0.5 at
/// half that rate, and below 0.2 % from 1.2 of it on. The ratio of the rates need not be one of whole numbers.
#[derive(Debug, Clone)]
pub struct AntiAliasing {
    bank: Arc<FilterBank>,
    /// Samples on each side of a place.
    reach: usize,
    /// Rows of taps from one sample to the next.
    steps: usize,
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
        Ok(Self::of_curve(&CURVE, rate_of(from_hz, to_hz)?))
    }

    /// The steep filter for two rates: within 0.02 % of 1 up to 0.8 of half the lower rate, and below 0.02 % from half that rate on,
    /// so that nothing is folded back. It has 2.6 times as many taps.
    ///
    /// Recordings of one vibration that begin at different moments have the same spectrum behind it, also near its end.
    ///
    /// # Arguments
    /// * `from_hz`, `to_hz` - (S/s) as for [`Self::new`]
    ///
    /// # Errors
    /// Those of [`Self::new`].
    ///
    /// Source: J. F. Kaiser, "Nonrecursive digital filter design using the I₀-sinh window function", Proc. IEEE ISCAS (1974) 20–23.
    ///
    /// ```
    /// use meshtone::signal::{AntiAliasing, Edge};
    ///
    /// let tone: Vec<f32> = (0..1000).map(|i| (std::f64::consts::TAU * 0.052 * f64::from(i)).cos() as f32).collect();
    /// let read = AntiAliasing::steep(1000.0, 100.0)?.read(&[&tone], (0..100).map(|i| 10.0 * f64::from(i)), Edge::Periodic);
    /// assert!(read[0].iter().all(|x| x.abs() < 3e-4)); // 52 Hz is beyond what 100 samples a second show
    /// # Ok::<(), meshtone::signal::SignalError>(())
    /// ```
    pub fn steep(from_hz: f64, to_hz: f64) -> Result<Self, SignalError> {
        static KNOWN: LazyLock<Known<u64, AntiAliasing, KEPT>> = LazyLock::new(Known::default);
        let rate = rate_of(from_hz, to_hz)? / STEEP_CUTOFF;
        let filter = || Self::of_curve(&STEEP_CURVE, rate);
        // Up to there a bank has 0.2 MB at any rate.
        Ok(if rate > ROW_STEPS { filter() } else { Self::clone(&KNOWN.get(rate.to_bits(), |_| filter())) })
    }

    /// [`Self::reach`] of the steep filter for two rates.
    ///
    /// # Arguments
    /// * `from_hz`, `to_hz` - (S/s) as for [`Self::new`]
    ///
    /// # Errors
    /// Those of [`Self::new`].
    pub fn steep_reach(from_hz: f64, to_hz: f64) -> Result<usize, SignalError> {
        Ok(FilterBank::reach(&STEEP_CURVE, rate_of(from_hz, to_hz)? / STEEP_CUTOFF))
    }

    /// Samples of the signal on each side of a place that its value depends on.
    pub fn reach(&self) -> usize {
        self.reach
    }

    /// # Arguments
    /// * `curve` - the filter
    /// * `rate` - (-) samples of the signal from one of its zero crossings to the next
    fn of_curve(curve: &SincCurve, rate: f64) -> Self {
        let steps = (ROW_STEPS / rate).ceil() as usize;
        let bank = Arc::new(FilterBank::low_pass(curve, rate, steps));
        Self { bank, reach: FilterBank::reach(curve, rate), steps }
    }

    /// Reads signals of one length at places between their samples.
    ///
    /// # Arguments
    /// * `signals` - the samples
    /// * `places` - in samples from the first; fractions are places between samples
    /// * `edge` - how the signals go on beyond their ends
    ///
    /// Returns the values of each signal.
    pub fn read(&self, signals: &[&[f32]], places: impl Iterator<Item = f64>, edge: Edge) -> Vec<Vec<f32>> {
        self.read_each(signals, &mut { places }, edge)
    }

    /// Does what [`Self::read`] does for one signal in double precision.
    ///
    /// # Arguments
    /// * `signal` - the samples
    /// * `places` - in samples from the first; fractions are places between samples
    /// * `edge` - how the signal goes on beyond its ends
    pub fn read_double(&self, signal: &[f64], places: impl Iterator<Item = f64>, edge: Edge) -> Vec<f64> {
        self.read_one(signal, &mut { places }, edge)
    }

    // The two below have no type parameter, so that the filter is compiled here, for speed, and not once more in each crate that
    // reads: to ask for a place through a table of functions costs little beside the place's taps.

    fn read_each(
        &self,
        signals: &[&[f32]],
        places: &mut dyn Iterator<Item = f64>,
        edge: Edge,
    ) -> Vec<Vec<f32>> {
        self.bank.read(signals, self.bank_positions(places), edge, |value| value as f32)
    }

    fn read_one(&self, signal: &[f64], places: &mut dyn Iterator<Item = f64>, edge: Edge) -> Vec<f64> {
        self.bank.read(&[signal], self.bank_positions(places), edge, |value| value).swap_remove(0)
    }

    fn bank_positions(&self, places: &mut dyn Iterator<Item = f64>) -> impl Iterator<Item = BankPosition> {
        places.map(|place| BankPosition::between_samples(place, self.reach, self.steps))
    }
}

/// (-) Samples of the signal to one that is read, where it is read at a lower rate, else 1.
fn rate_of(from_hz: f64, to_hz: f64) -> Result<f64, SignalError> {
    check_positive("from_hz", from_hz)?;
    check_positive("to_hz", to_hz)?;
    let rate = from_hz / to_hz;
    if !(1e-5..=1e5).contains(&rate) {
        return Err(SignalError::parameter("to_hz", to_hz, "from 1e-5 to 1e5 of from_hz"));
    }
    Ok(rate.max(1.0))
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

    // To Kaiser's 80 dB, at both ends of the transition.
    #[test]
    fn the_steep_filter_passes_and_stops_by_the_half_rate() {
        let filter = AntiAliasing::steep(1e4, 997.3).unwrap();
        let read = |hz: f64| {
            let tone: Vec<f32> =
                (0..10_000).map(|i| (std::f64::consts::TAU * hz * f64::from(i) / 1e4).cos() as f32).collect();
            filter.read(&[&tone], (0..997).map(|i| f64::from(i) * 1e4 / 997.3), Edge::Periodic).remove(0)
        };
        let passed = 0.8 * 997.3 / 2.0;
        let off = |(i, x): (usize, &f32)| {
            (f64::from(*x) - (std::f64::consts::TAU * passed * i as f64 / 997.3).cos()).abs()
        };
        // The tone is not quite periodic: not at the ends.
        let middle = |read: Vec<f32>| read[50..940].to_vec();
        let passing = read(passed);
        assert!(passing.iter().enumerate().skip(50).take(890).map(off).fold(0.0, f64::max) < 3e-4);
        for stopped in [499.0, 560.0, 1300.0, 4000.0] {
            let largest = middle(read(stopped)).iter().fold(0.0f32, |largest, x| largest.max(x.abs()));
            assert!(largest < 3e-4, "{stopped} Hz: {largest}");
        }
    }

    // Within the signals and beyond their ends, in blocks that are full and not.
    #[test]
    fn signals_read_together_are_those_read_alone() {
        let signals: Vec<Vec<f32>> = (0..3).map(|n| noise(700 + n)[n..].to_vec()).collect();
        let signals: Vec<&[f32]> = signals.iter().map(Vec::as_slice).collect();
        let filter = AntiAliasing::steep(1e4, 6789.0).unwrap();
        let places = || (0..600).map(|i| f64::from(i) * 1.3 - 40.0);
        for edge in [Edge::Periodic, Edge::Reflect] {
            let alone: Vec<Vec<f32>> =
                signals.iter().map(|signal| filter.read(&[*signal], places(), edge).remove(0)).collect();
            assert_eq!(filter.read(&signals, places(), edge), alone);
            assert_eq!(filter.read(&signals[..2], places(), edge), alone[..2]);
            assert!(alone[0] != alone[1] && alone[1] != alone[2]);
        }
    }

    #[test]
    fn a_filter_that_was_kept_reads_the_same() {
        let signal = noise(300);
        let read = |to_hz: f64| {
            let filter = AntiAliasing::steep(1e4, to_hz).unwrap();
            assert_eq!(AntiAliasing::steep_reach(1e4, to_hz).unwrap(), filter.reach());
            filter.read(&[&signal], (0..200).map(|i| f64::from(i) * 1.3), Edge::Reflect).remove(0)
        };
        let made = AntiAliasing::of_curve(&STEEP_CURVE, 1e4 / 6789.0 / STEEP_CUTOFF);
        let made = made.read(&[&signal], (0..200).map(|i| f64::from(i) * 1.3), Edge::Reflect).remove(0);
        for _ in 0..2 {
            assert!(read(6789.0) == made && read(6789.0) == made && read(5000.0) != made);
            // So many others push it out.
            (0..KEPT).for_each(|n| assert!(read(4000.0 + n as f64) != made));
        }
    }

    #[test]
    fn rates_that_are_none_are_refused() {
        for (from, to) in [(0.0, 1.0), (1.0, -1.0), (f64::NAN, 1.0), (1e6, 1.0)] {
            assert!(AntiAliasing::new(from, to).is_err(), "{from} {to}");
        }
    }
}
