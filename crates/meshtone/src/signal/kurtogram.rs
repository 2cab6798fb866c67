//! Bands in which a signal is impulsive: spectral kurtosis and the fast kurtogram.

use std::f64::consts::FRAC_PI_4;

use meshtone_fourier::{
    Complex64, convenient_count, convenient_length, hann_window, inverse_complex, real_spectrum,
};

use super::check::{check_channel, check_count, check_rate};
use super::{FrequencyBand, SignalError};

/// Fewest lines of the spectrum in a band.
const FEWEST_LINES: usize = 256;
/// (bandwidths) A band falls from 1 to 0 over so much on either side of its ends.
const TRANSITION: f64 = 0.125;
/// (-) Part of a signal's power below which a band holds nothing but what a recorder, a filter, or the end of a simulation's modes leaves.
const NOTHING: f64 = 1e-5;
/// (-) Part of the power at the strongest line below which a line is what rounding leaves.
const ROUNDING: f64 = 1e-24;
/// Blocks that begin within the length of one.
const OVERLAPPING: usize = 4;

/// Kurtosis of a signal's complex envelope in bands of all widths.
#[derive(Debug, Clone, PartialEq)]
pub struct Kurtogram {
    /// (S/s) Sampling rate of the signal.
    pub sampling_rate_hz: f64,
    /// (-) For each level the kurtosis in its bands, which divide 0 to half the sampling rate into equal parts; that of one band first.
    pub levels: Vec<Vec<f64>>,
}

/// A band of a kurtogram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KurtogramBand {
    /// Its frequencies.
    pub band: FrequencyBand,
    /// Number of bands at its level.
    pub bands: usize,
    /// (-) Kurtosis in it.
    pub kurtosis: f64,
}

impl Kurtogram {
    /// The band with the largest kurtosis.
    ///
    /// # Arguments
    /// * `least_width_hz` - (Hz) narrower bands do not count: an envelope shows no frequency above the width of its band, so that a band to look
    ///   for a defect in should be some three times as wide as its frequency; 0 for all bands
    pub fn best(&self, least_width_hz: f64) -> Option<KurtogramBand> {
        let half = 0.5 * self.sampling_rate_hz;
        let bands = self.levels.iter().flat_map(|kurtosis| {
            let width = half / kurtosis.len() as f64;
            kurtosis.iter().enumerate().map(move |(number, value)| KurtogramBand {
                // The last one ends at half the rate, whatever the rounding.
                band: FrequencyBand {
                    from_hz: number as f64 * width,
                    to_hz: ((number + 1) as f64 * width).min(half),
                },
                bands: kurtosis.len(),
                kurtosis: *value,
            })
        });
        // Where none is wide enough, that of all frequencies.
        bands
            .filter(|of| of.bands == 1 || half >= least_width_hz * of.bands as f64)
            .max_by(|a, b| a.kurtosis.total_cmp(&b.kurtosis))
    }
}

/// Fast kurtogram: the kurtosis of the complex envelope in 1, 2, 3, 4, 6, 8, 12 … equal bands from 0 to half the sampling rate.
///
/// With c the complex envelope in a band it is `⟨|c|⁴⟩/⟨|c|²⟩² − 2`: 0 in Gaussian noise, −1 of a tone, large where bursts stand out. The bands are
/// those of the original's binary and ternary tree; here each is cut out of the spectrum of the whole signal, with half its power at its ends and
/// a cosine's flank about them (0 where it has less than 10⁻⁵ of the whole power), and its inverse transform is the envelope at the band's own low rate. So values differ slightly from those
/// of the original's short filters.
///
/// # Arguments
/// * `signal` - (any unit) the signal; less than 1 % at its end is left out where its length is inconvenient
/// * `sampling_rate_hz` - (S/s) its sampling rate
/// * `most_levels` - there are at most 2 to this power of bands; fewer where a band would hold fewer than 256 lines of the spectrum
///
/// # Errors
/// NaN; a constant signal; fewer than 512 samples.
///
/// Source: J. Antoni, "Fast computation of the kurtogram for the detection of transient faults", Mech. Syst. Signal Process. 21 (2007) 108–124.
///
/// ```
/// // Bursts of 3 kHz in noise and a louder tone of 1 kHz.
/// let tau = std::f64::consts::TAU;
/// let burst = |i: usize| (-((i % 1000) as f64) / 20.0).exp() * (tau * 0.15 * (i % 1000) as f64).sin();
/// let mut bits = 1u64;
/// let mut noise = || {
///     bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
///     (bits >> 11) as f64 / (1u64 << 52) as f64 - 1.0
/// };
/// let signal: Vec<f64> = (0..50_000).map(|i| burst(i) + 2.0 * (tau * 0.05 * i as f64).sin() + 0.1 * noise()).collect();
/// let best = meshtone::signal::kurtogram(&signal, 20_000.0, 6)?.best(0.0).ok_or("no band")?;
/// assert!((best.band.from_hz..best.band.to_hz).contains(&3000.0) && best.kurtosis > 5.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn kurtogram(signal: &[f64], sampling_rate_hz: f64, most_levels: u32) -> Result<Kurtogram, SignalError> {
    check_channel(signal)?;
    check_rate(sampling_rate_hz)?;
    check_count("samples", signal.len(), 2 * FEWEST_LINES)?;
    let mut spectrum = real_spectrum(&signal[..convenient_count(signal.len())]);
    spectrum[0] = Complex64::default();
    let most = (spectrum.len() / FEWEST_LINES).min(1usize.checked_shl(most_levels).unwrap_or(usize::MAX));
    let binary = (0..usize::BITS).map(|level| 1usize << level).take_while(|bands| *bands <= most);
    let counts = binary.flat_map(|bands| [bands, bands * 3 / 2]).filter(|bands| *bands <= most);
    let mut counts: Vec<usize> = counts.collect();
    counts.dedup();
    let levels = counts.into_iter().map(|bands| kurtosis_in_bands(&spectrum, bands)).collect();
    Ok(Kurtogram { sampling_rate_hz, levels })
}

/// Kurtosis in each of equally wide bands.
fn kurtosis_in_bands(spectrum: &[Complex64], bands: usize) -> Vec<f64> {
    let width = (spectrum.len() - 1) as f64 / bands as f64;
    let power = |lines: &[Complex64]| lines.iter().map(Complex64::norm_sqr).sum::<f64>();
    let least_power = NOTHING * power(spectrum);
    let flank = TRANSITION * width;
    // Of all bands, so that they share a plan.
    let length = convenient_length((width + 2.0 * flank) as usize + 2);
    let in_band = |band: usize| {
        let [from, to] = [band, band + 1].map(|edge| edge as f64 * width);
        let first = (from - flank).max(0.0).ceil() as usize;
        let end = ((to + flank) as usize + 1).min(spectrum.len());
        let mut lines = spectrum[first..end].to_vec();
        for (line, value) in (first..).zip(&mut lines) {
            let line = line as f64;
            let (above, below) = ((line - from) / flank, (to - line) / flank);
            if band > 0 && above < 1.0 {
                *value *= (FRAC_PI_4 * (1.0 + above)).sin();
            }
            if band + 1 < bands && below < 1.0 {
                *value *= (FRAC_PI_4 * (1.0 + below)).sin();
            }
        }
        // Where there is nothing, nothing is impulsive.
        if power(&lines) <= least_power {
            return 0.0;
        }
        lines.resize(length, Complex64::default());
        let squares = inverse_complex(lines);
        let squares = squares.iter().map(Complex64::norm_sqr);
        let [second, fourth] =
            squares.fold([0.0; 2], |[second, fourth], square| [second + square, fourth + square * square]);
        fourth * length as f64 / (second * second) - 2.0
    };
    (0..bands).map(in_band).collect()
}

/// Spectral kurtosis: for each frequency how much the power there varies from block to block, `⟨|X|⁴⟩/⟨|X|²⟩² − 2` of the spectra X of blocks with
/// a Hann window, each beginning a quarter of a block after the one before.
///
/// It is 0 in stationary Gaussian noise, −1 at a steady tone, and large where bursts that are shorter than their distance stand out. The
/// spectrum at frequency 0 and at half the sampling rate is real, so that 3 is subtracted there instead of 2.
///
/// # Arguments
/// * `signal` - (any unit) the signal, at least two blocks long
/// * `block_samples` - (at least 4) length of a block: longer than a burst, shorter than the distance of two
///
/// Returns `block_samples/2 + 1` values, from frequency 0 to half the sampling rate; 0 where there is nothing, which is not impulsive.
///
/// # Errors
/// NaN; a constant signal; blocks that are too short or too long.
///
/// Source: J. Antoni, "The spectral kurtosis: a useful tool for characterising non-stationary signals", Mech. Syst. Signal Process. 20 (2006)
/// 282–307.
///
/// ```
/// let wave = |i: usize| (std::f64::consts::TAU * 0.25 * i as f64).cos();
/// let steady: Vec<f64> = (0..4096).map(wave).collect();
/// assert!((meshtone::signal::spectral_kurtosis(&steady, 64)?[16] + 1.0).abs() < 1e-9);
/// let bursts: Vec<f64> = (0..4096).map(|i| if i % 512 < 32 { wave(i) } else { 0.0 }).collect();
/// assert!(meshtone::signal::spectral_kurtosis(&bursts, 64)?[16] > 3.0);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn spectral_kurtosis(signal: &[f64], block_samples: usize) -> Result<Vec<f64>, SignalError> {
    check_channel(signal)?;
    if block_samples < OVERLAPPING {
        return Err(SignalError::parameter("block_samples", block_samples as f64, "at least 4"));
    }
    check_count("samples for two blocks", signal.len(), block_samples.saturating_mul(2))?;
    let window = hann_window(block_samples);
    let mut moments = vec![[0.0; 2]; block_samples / 2 + 1];
    let mut blocks = 0.0;
    for block in signal.windows(block_samples).step_by(block_samples / OVERLAPPING) {
        let windowed: Vec<f64> = block.iter().zip(&window).map(|(value, window)| value * window).collect();
        for ([second, fourth], line) in moments.iter_mut().zip(real_spectrum(&windowed)) {
            let square = line.norm_sqr();
            *second += square;
            *fourth += square * square;
        }
        blocks += 1.0;
    }
    let strongest = moments.iter().map(|[second, _]| *second).fold(0.0, f64::max);
    let value = |(line, [second, fourth]): (usize, [f64; 2])| {
        if second <= ROUNDING * strongest {
            return 0.0;
        }
        let of_noise = if line == 0 || 2 * line == block_samples { 3.0 } else { 2.0 };
        fourth * blocks / (second * second) - of_noise
    };
    Ok(moments.into_iter().enumerate().map(value).collect())
}
