//! A signal at places between its samples, as sums of its samples weighted by tabulated taps.

use super::Edge;
use super::kaiser::windowed_sinc;
use crate::simd::{Dispatch, InstructionSet, Instructions, Lanes, Task};

/// Sums that run side by side, so that none waits for the one before.
const LANES: usize = 16;
/// Places that are read at a time.
const BLOCK: usize = 256;
/// Values of a windowed sinc that are tabulated between two of its zero crossings: straight lines between them are off by
/// `(π/1024)²/8` of the middle one at most, 1.2e-6.
const CURVE_STEPS: usize = 1024;

/// Taps of a filter for evenly many places between two samples.
#[derive(Debug, Clone)]
pub(super) struct FilterBank {
    /// Length of a row: that of the filter, made a multiple of [`LANES`] with zeros.
    taps: usize,
    /// The taps for one place after those for the place before it, the tap of the oldest sample first.
    rows: Vec<f64>,
}

/// Position of a filter bank over a signal.
#[derive(Debug, Clone, Copy)]
pub(super) struct BankPosition {
    /// Sample that the first tap weights; it may lie beyond the signal's ends.
    pub(super) first: isize,
    /// Row of the bank.
    pub(super) row: usize,
    /// (-) Part of the way to the next row; 0 where the row is the filter's own.
    pub(super) between: f64,
}

impl BankPosition {
    /// A place of a [`FilterBank::low_pass`].
    ///
    /// # Arguments
    /// * `place` - in samples from the first
    /// * `reach` - of the bank
    /// * `steps` - rows of the bank from one sample to the next
    #[inline]
    pub(super) fn between_samples(place: f64, reach: usize, steps: usize) -> Self {
        // Rounded down, without a call where the processor may not be able to.
        let towards_zero = place as isize;
        let whole = towards_zero - isize::from((towards_zero as f64) > place);
        let step = (place - whole as f64) * steps as f64;
        let row = (step as usize).min(steps - 1);
        Self { first: whole + 1 - reach as isize, row, between: step - row as f64 }
    }
}

/// A sinc under Kaiser's window, as a curve that is read often.
#[derive(Debug)]
pub(super) struct SincCurve {
    zero_crossings: usize,
    /// From the middle to the last zero crossing, [`CURVE_STEPS`] from one to the next.
    values: Vec<f64>,
}

impl SincCurve {
    /// # Arguments
    /// * `zero_crossings` - on each side, the last one at the window's end
    /// * `beta` - (-) shape of Kaiser's window
    pub(super) fn new(zero_crossings: usize, beta: f64) -> Self {
        let value = |i: usize| windowed_sinc(i as f64 / CURVE_STEPS as f64, zero_crossings as f64, beta);
        Self { zero_crossings, values: (0..=zero_crossings * CURVE_STEPS).map(value).collect() }
    }

    /// The curve at `t` zero crossings from its middle.
    fn at(&self, t: f64) -> f64 {
        let place = t.abs() * CURVE_STEPS as f64;
        let index = place as usize;
        let Some(&[from, to]) = self.values.get(index..index + 2) else {
            return 0.0;
        };
        from + (place - index as f64) * (to - from)
    }
}

impl FilterBank {
    /// The bank with these rows.
    ///
    /// # Arguments
    /// * `rows` - as many taps in each
    pub(super) fn new<R: AsRef<[f64]>>(rows: impl IntoIterator<Item = R>) -> Self {
        let mut bank = Self { taps: 0, rows: Vec::new() };
        for row in rows {
            bank.taps = row.as_ref().len().next_multiple_of(LANES);
            bank.rows.extend_from_slice(row.as_ref());
            bank.rows.resize(bank.rows.len().next_multiple_of(bank.taps), 0.0);
        }
        bank
    }

    /// A low-pass filter for `steps + 1` places from a sample to the next one, both included. Each row is scaled so that a
    /// constant stays one.
    ///
    /// # Arguments
    /// * `curve` - the filter
    /// * `samples_per_crossing` - (at least 1) samples from one of the curve's zero crossings to the next: the old sampling
    ///   rate over the new one where that is lower
    /// * `steps` - places between two samples
    pub(super) fn low_pass(curve: &SincCurve, samples_per_crossing: f64, steps: usize) -> Self {
        let reach = Self::reach(curve, samples_per_crossing);
        Self::new((0..=steps).map(|step| {
            let place = step as f64 / steps as f64 + (reach - 1) as f64;
            let mut row: Vec<f64> =
                (0..2 * reach).map(|i| curve.at((place - i as f64) / samples_per_crossing)).collect();
            let sum: f64 = row.iter().sum();
            row.iter_mut().for_each(|tap| *tap /= sum);
            row
        }))
    }

    /// Samples on each side of a place that [`Self::low_pass`] weights.
    pub(super) fn reach(curve: &SincCurve, samples_per_crossing: f64) -> usize {
        (curve.zero_crossings as f64 * samples_per_crossing).ceil() as usize
    }

    /// Reads signals of one length.
    ///
    /// # Arguments
    /// * `signals` - the samples
    /// * `places` - where
    /// * `edge` - how the signals go on beyond their ends
    ///
    /// Returns the values of each signal. The order of all additions is fixed: a value depends on nothing but the samples
    /// around it.
    pub(super) fn read<T: Copy + Into<f64>, V>(
        &self,
        signals: &[&[T]],
        mut places: impl Iterator<Item = BankPosition>,
        edge: Edge,
        rounded: impl Fn(f64) -> V + Copy,
    ) -> Vec<Vec<V>> {
        let expected = places.size_hint().0;
        let mut values: Vec<Vec<V>> = signals.iter().map(|_| Vec::with_capacity(expected)).collect();
        let mut block = [BankPosition { first: 0, row: 0, between: 0.0 }; BLOCK];
        let mut beyond = vec![0.0; self.taps];
        loop {
            let mut count = 0;
            for (slot, place) in block.iter_mut().zip(&mut places) {
                *slot = place;
                count += 1;
            }
            if count == 0 {
                return values;
            }
            let places = &block[..count];
            let (pairs, last) = signals.as_chunks::<2>();
            let (values_of_pairs, values_of_last) = values.as_chunks_mut::<2>();
            for (signals, values) in pairs.iter().zip(values_of_pairs) {
                self.read_block(*signals, places, edge, &mut beyond, rounded, values);
            }
            for (signal, values) in last.iter().zip(values_of_last) {
                self.read_block([*signal], places, edge, &mut beyond, rounded, std::array::from_mut(values));
            }
        }
    }

    /// Reads a block of places of signals.
    fn read_block<T: Copy + Into<f64>, V, const N: usize>(
        &self,
        signals: [&[T]; N],
        places: &[BankPosition],
        edge: Edge,
        beyond: &mut [f64],
        rounded: impl Fn(f64) -> V,
        values: &mut [Vec<V>; N],
    ) {
        let mut read = [[0.0; N]; BLOCK];
        let read = &mut read[..places.len()];
        InstructionSet::in_use().run(BankReading { bank: self, signals, places, edge, beyond, read });
        for (n, values) in values.iter_mut().enumerate() {
            values.extend(read.iter().map(|value| rounded(value[n])));
        }
    }
}

/// A block of places of signals of one length: all are weighted by the same taps, and no sum waits for another's.
struct BankReading<'a, T, const N: usize> {
    bank: &'a FilterBank,
    signals: [&'a [T]; N],
    places: &'a [BankPosition],
    edge: Edge,
    /// Room for samples of which some lie beyond the signal's ends.
    beyond: &'a mut [f64],
    /// Values of each signal at each place.
    read: &'a mut [[f64; N]],
}

impl<T: Copy + Into<f64>, const N: usize> Task for BankReading<'_, T, N> {
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(self, simd: I) {
        let Self { bank: FilterBank { taps, rows }, signals, places, edge, beyond, read } = self;
        for (values, place) in read.iter_mut().zip(places) {
            let rows = &rows[place.row * taps..];
            // A place before the first sample is far beyond the last one as a number without sign.
            let first = place.first as usize;
            let mut samples: [&[T]; N] = [&[]; N];
            let mut are_within = true;
            for (samples, signal) in samples.iter_mut().zip(signals) {
                match signal.get(first..first.wrapping_add(*taps)) {
                    Some(within) => *samples = within,
                    None => are_within = false,
                }
            }
            if are_within {
                *values = weighted(simd, rows, samples, place.between);
                continue;
            }
            for (value, signal) in values.iter_mut().zip(signals) {
                continued(signal, place.first, edge, beyond);
                [*value] = weighted(simd, rows, [&*beyond], place.between);
            }
        }
    }
}

/// Samples from `first` on, some of which lie beyond the signal's ends.
fn continued<T: Copy + Into<f64>>(signal: &[T], first: isize, edge: Edge, samples: &mut [f64]) {
    for (x, i) in samples.iter_mut().zip(first..) {
        *x = edge.index(i, signal.len()).map_or(0.0, |i| signal[i].into());
    }
}

/// `Σ ((1 − t) a + t b) x` with the row a of taps and the one after it, b; with a alone for t = 0. Of each of the signals' samples x.
#[inline(always)]
fn weighted<I: Instructions, T: Copy + Into<f64>, const N: usize>(
    simd: I,
    rows: &[f64],
    x: [&[T]; N],
    t: f64,
) -> [f64; N] {
    let (row, next) = rows.split_at(x[0].len());
    let chunks = x.map(|x| x.as_chunks::<LANES>().0);
    let mut sums = [Lanes::splat(0.0); N];
    if t == 0.0 {
        for (i, a) in row.as_chunks::<LANES>().0.iter().enumerate() {
            for n in 0..N {
                sums[n] = Lanes(*a).mul_add(simd, in_double(&chunks[n][i]), sums[n]);
            }
        }
    } else {
        let t = Lanes::splat(t);
        let pairs = row.as_chunks::<LANES>().0.iter().zip(next.as_chunks::<LANES>().0);
        for (i, (a, b)) in pairs.enumerate() {
            let tap = Lanes(*b).sub(simd, Lanes(*a)).mul_add(simd, t, Lanes(*a));
            for n in 0..N {
                sums[n] = tap.mul_add(simd, in_double(&chunks[n][i]), sums[n]);
            }
        }
    }
    let mut totals = [0.0; N];
    for n in 0..N {
        totals[n] = total(sums[n].0);
    }
    totals
}

/// Samples in double precision.
#[inline(always)]
fn in_double<T: Copy + Into<f64>>(x: &[T; LANES]) -> Lanes<LANES> {
    let mut double = [0.0; LANES];
    for l in 0..LANES {
        double[l] = x[l].into();
    }
    Lanes(double)
}

/// Their sum: halves onto halves, down to one.
#[inline(always)]
fn total(mut sums: [f64; LANES]) -> f64 {
    let mut width = LANES / 2;
    while width > 0 {
        for l in 0..width {
            sums[l] += sums[l + width];
        }
        width /= 2;
    }
    sums[0]
}
