//! Fourier transforms of 64-bit floats.
//!
//! A crate of its own because the transforms are generic: every crate, and every test program, that calls them with a number type
//! compiles all of them anew, and they are a fifth of what the simulator compiles. Here they are compiled once.
#![deny(missing_docs)]

use std::cell::RefCell;

use realfft::RealFftPlanner;
use rustfft::FftPlanner;
pub use rustfft::num_complex::Complex64;

/// The longest of the short signals: averages, turns of a wheel.
const LONGEST_SHORT: usize = 1 << 17;
/// Lengths of the short signals whose plans are kept, added up: of an average, of a turn of either wheel, and some that signals of other
/// lengths are padded to, see [`shared_length`].
const KEPT_IN_ALL: usize = 2 * LONGEST_SHORT;
/// The longest signal whose plans are kept; of a longer one they would hold more than some 20 MB in every thread.
const LONGEST_KEPT: usize = 1 << 19;

/// Makes plans of transforms, and keeps those that it has made.
struct Planners {
    len: usize,
    real: RealFftPlanner<f64>,
    complex: FftPlanner<f64>,
}

impl Planners {
    fn new(len: usize) -> Self {
        Self { len, real: RealFftPlanner::new(), complex: FftPlanner::new() }
    }
}

/// A plan for `len` values, that of one of the thread's last transforms, short or long, where it had as many: signals of one length
/// are transformed over and over, whole ones by sensors and averages by the chain, and planning takes longer than transforming.
fn plan<P>(len: usize, make: impl FnOnce(&mut Planners) -> P) -> P {
    thread_local! {
        static LAST_SHORT: RefCell<Vec<Planners>> = const { RefCell::new(Vec::new()) };
        static LAST_LONG: RefCell<Vec<Planners>> = const { RefCell::new(Vec::new()) };
    }
    if len > LONGEST_KEPT {
        return make(&mut Planners::new(len));
    }
    let (last, most) = if len > LONGEST_SHORT { (&LAST_LONG, len) } else { (&LAST_SHORT, KEPT_IN_ALL) };
    last.with_borrow_mut(|last| {
        let known = last.iter().position(|planners| planners.len == len);
        let mut planners = known.map_or_else(|| Planners::new(len), |place| last.remove(place));
        let plan = make(&mut planners);
        last.insert(0, planners);
        // Those that were used longest ago give way.
        let mut kept = 0;
        last.retain(|of| {
            kept += of.len;
            kept <= most
        });
        plan
    })
}

/// The one-sided spectrum of real values, without normalisation: `X_k = Σ_n x_n e^(−2πikn/N)` for k = 0 … ⌊N/2⌋.
///
/// # Arguments
/// * `values` - N of them, at equal distances; in any unit, which is the spectrum's too
///
/// # Examples
/// ```
/// let spectrum = meshtone_fourier::real_spectrum(&[1.0, 0.0, -1.0, 0.0]);
/// assert_eq!(spectrum.iter().map(|line| line.re).collect::<Vec<_>>(), [0.0, 2.0, 0.0]);
/// ```
pub fn real_spectrum(values: &[f64]) -> Vec<Complex64> {
    let plan = plan(values.len(), |planners| planners.real.plan_fft_forward(values.len()));
    let mut input = values.to_vec();
    let mut output = plan.make_output_vec();
    // The lengths are the plan's own, which is all that can fail.
    let done = plan.process(&mut input, &mut output);
    debug_assert!(done.is_ok());
    output
}

/// The real values that have a spectrum: the inverse of [`real_spectrum`], division by `len` included.
///
/// # Arguments
/// * `spectrum` - ⌊`len`/2⌋ + 1 lines; of the first, and of the last where `len` is even, the real part is taken
/// * `len` - number of values, at least 1
pub fn from_real_spectrum(mut spectrum: Vec<Complex64>, len: usize) -> Vec<f64> {
    let plan = plan(len, |planners| planners.real.plan_fft_inverse(len));
    // Real values have real ends of the spectrum; rounding may have left something there.
    spectrum[0].im = 0.0;
    if len.is_multiple_of(2) {
        spectrum[len / 2].im = 0.0;
    }
    let mut output = plan.make_output_vec();
    let done = plan.process(&mut spectrum, &mut output);
    debug_assert!(done.is_ok());
    output.iter_mut().for_each(|x| *x /= len as f64);
    output
}

/// The values of a two-sided spectrum, without normalisation: `x_n = Σ_k X_k e^(2πikn/N)`, not divided by N.
///
/// # Arguments
/// * `spectrum` - N lines, those of negative frequency last
pub fn inverse_complex(mut spectrum: Vec<Complex64>) -> Vec<Complex64> {
    let len = spectrum.len();
    plan(len, |planners| planners.complex.plan_fft_inverse(len)).process(&mut spectrum);
    spectrum
}

/// Hann's window, which keeps a strong line of a spectrum from covering weak ones far from it: `sin²(πn/N)` for n = 0 … N − 1.
///
/// # Arguments
/// * `len` - N, the number of values
///
/// ```
/// assert_eq!(meshtone_fourier::hann_window(2), [0.0, 1.0]);
/// ```
pub fn hann_window(len: usize) -> Vec<f64> {
    (0..len).map(|at| 0.5 - 0.5 * (std::f64::consts::TAU * at as f64 / len as f64).cos()).collect()
}

/// The least length of at least `len` that is even and has no prime factors but 2, 3 and 5: its transform is fast.
pub fn convenient_length(len: usize) -> usize {
    let mut best = len.max(2).next_power_of_two();
    let mut fives = 1;
    while fives < best {
        let mut threes = fives;
        while threes < best {
            let twos = len.div_ceil(threes).next_power_of_two().max(2);
            best = best.min(threes * twos);
            threes *= 3;
        }
        fives *= 5;
    }
    best
}

/// A length of at least `len` that signals of other lengths are padded to as well, so that its plan is made but once: the least that is
/// 4, 5 or 6 times a power of two, at most a third longer. Of long signals, of whose plans one is kept, the [`convenient_length`].
///
/// ```
/// let lengths = [130, 155, 190, 200].map(meshtone_fourier::shared_length);
/// assert_eq!(lengths, [160, 160, 192, 256]);
/// ```
pub fn shared_length(len: usize) -> usize {
    let power = len.div_ceil(4).next_power_of_two();
    let lengths = [power * 5 / 2, power * 3];
    let shared =
        lengths.into_iter().find(|&length| length >= len && length.is_multiple_of(2)).unwrap_or(power * 4);
    if shared > LONGEST_SHORT { convenient_length(len) } else { shared }
}

/// The greatest count of at most `count` that has no prime factors but 2, 3 and 5; 0 where that is 0.
pub fn convenient_count(count: usize) -> usize {
    (1..=count).rev().find(|count| is_smooth(*count)).unwrap_or(0)
}

/// Returns whether a number of at least 1 has no prime factors but 2, 3 and 5.
fn is_smooth(number: usize) -> bool {
    let without = |mut rest: usize, prime: usize| {
        while rest.is_multiple_of(prime) {
            rest /= prime;
        }
        rest
    };
    [2, 3, 5].into_iter().fold(number, without) == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn convenient_lengths() {
        let smooth = |n: &usize| n.is_multiple_of(2) && is_smooth(*n);
        for len in [1, 2, 7, 11, 97, 121, 1001, 44_101, 3_000_001] {
            assert_eq!(Some(convenient_length(len)), (len..).find(smooth), "{len}");
            let shared = shared_length(len);
            assert!(shared >= len && smooth(&shared) && (len < 4 || 3 * shared <= 4 * len), "{len}");
        }
        for (count, convenient) in [(0, 0), (1, 1), (7, 6), (11, 10), (27, 27), (97, 96), (1001, 1000)] {
            assert_eq!(convenient_count(count), convenient);
        }
    }

    #[test]
    fn there_and_back() {
        for len in [1, 2, 5, 8] {
            let values: Vec<f64> = (0..len).map(|i| f64::from(i * i) - 2.0).collect();
            let back = from_real_spectrum(real_spectrum(&values), values.len());
            assert!(back.iter().zip(&values).all(|(a, b)| (a - b).abs() < 1e-13));
        }
    }
}
