//! The squared envelope of a recording in bands of several widths, over the orders of each shaft: what a verdict reads.

use meshtone_fourier::{Complex64, convenient_length, hann_window, inverse_complex, real_spectrum};

use crate::interpolation::UniformLinear;
use crate::signal::check::{check_channel, check_rate};
use crate::signal::spectrum::windowed;
use crate::signal::{FrequencyBand, ShaftPhase, SignalError, upper_median};

/// Equal parts of all frequencies that are looked at, each part as a band: nobody knows which resonance a defect rings in.
const PARTS: [usize; 5] = [1, 2, 4, 8, 16];
/// (Hz) Where the lowest band begins: below, sensors drift.
const LOWEST_HZ: f64 = 20.0;
/// Cells of a revolution over which the squared envelope is averaged: twice as many as the last line needs, so that what is beyond folds back weakly.
const CELLS: usize = 256;
/// (rev) Length of a segment whose spectra are averaged, and of a recording that is one segment.
const SEGMENT: (f64, f64) = (48.0, 60.0);
/// (orders) The last line that is read: the fifth harmonic of the last order that is tried, and its sidebands.
const LAST: f64 = 67.5;
/// (orders) Half the width in which the median of the lines is taken, and (lines) the least.
const BESIDE: (f64, f64) = (0.6, 24.0);
/// Medians in half that width: from one to the next they hardly change, and one for each line would take long.
const MEDIANS: usize = 4;

/// Spectra of the squared envelope in bands, over the orders of one shaft.
#[derive(Debug, Clone)]
pub(super) struct BandSpectra {
    /// The bands.
    pub bands: Vec<FrequencyBand>,
    /// (orders) Distance of two lines; the first is at 0.
    pub step: f64,
    /// (rev) Turns of the shaft in a segment; one over them is what the spectra resolve.
    pub resolved: f64,
    /// (-) How far each line stands out, of line after line that of each band: `ln((1 + P/M)/2)` of its power and the median beside it.
    standing: Vec<f64>,
    /// (-) Amplitudes of the lines over the mean of the squared envelope, likewise.
    depths: Vec<f64>,
}

impl BandSpectra {
    /// How many lines there are.
    pub fn lines(&self) -> usize {
        self.standing.len() / self.bands.len().max(1)
    }

    /// (-) How far a line stands out in each band.
    ///
    /// # Arguments
    /// * `line` - its number
    pub fn standing(&self, line: usize) -> &[f64] {
        &self.standing[line * self.bands.len()..][..self.bands.len()]
    }

    /// (-) Amplitude of the line at an order, or of one beside it, over the mean of the squared envelope.
    ///
    /// # Arguments
    /// * `order` - where
    /// * `band` - number of the band
    pub fn depth(&self, order: f64, band: usize) -> f64 {
        let line = (order / self.step).round() as usize;
        let beside = line.saturating_sub(1)..(line + 2).min(self.lines());
        beside.map(|line| self.depths[line * self.bands.len() + band]).fold(0.0, f64::max)
    }
}

/// Observes a recording: the spectra of its squared envelope in all bands, for each shaft over its orders.
///
/// The whole recording is filtered at once. Each band's squared envelope is averaged over cells of equal angle, so that a changing speed moves no
/// line, and cut into segments that overlap by half, whose power spectra are averaged: what does not last does not count. The recording should have no
/// lines of gears.
///
/// # Arguments
/// * `signal` - (any unit) the recording
/// * `sampling_rate_hz` - (S/s) its sampling rate
/// * `phases` - of each shaft
/// * `least_width_hz` - (Hz) of a band, but for that of all frequencies
///
/// # Errors
/// NaN; a constant signal; a phase that is not the recording's.
pub(super) fn band_spectra(
    signal: &[f64],
    sampling_rate_hz: f64,
    phases: &[ShaftPhase],
    least_width_hz: f64,
) -> Result<Vec<BandSpectra>, SignalError> {
    check_channel(signal)?;
    check_rate(sampling_rate_hz)?;
    phases.iter().try_for_each(ShaftPhase::check)?;
    let spectrum = real_spectrum(signal);
    let per_hz = signal.len() as f64 / sampling_rate_hz;
    let highest_hz = 0.5 * sampling_rate_hz;
    let parts = PARTS.into_iter().filter(|parts| *parts == 1 || highest_hz / *parts as f64 >= least_width_hz);
    let bands: Vec<FrequencyBand> = parts
        .flat_map(|parts| {
            let width_hz = highest_hz / parts as f64;
            (0..parts).map(move |part| FrequencyBand {
                from_hz: (part as f64 * width_hz).max(LOWEST_HZ.min(0.5 * width_hz)),
                to_hz: (part + 1) as f64 * width_hz,
            })
        })
        .collect();
    let edges: Vec<Vec<f64>> = phases.iter().map(cell_edges).collect();
    let mut powers: Vec<Vec<Vec<f64>>> = vec![Vec::new(); phases.len()];
    for band in &bands {
        let line = |hz: f64| ((hz * per_hz).round() as usize).min(spectrum.len());
        let sums = sums_of_squared_envelope(&spectrum[line(band.from_hz)..line(band.to_hz)]);
        let per_sample = (sums.len() - 1) as f64 / signal.len() as f64;
        for (of_shaft, edges) in powers.iter_mut().zip(&edges) {
            of_shaft.push(mean_spectrum(&cells(&sums, edges, per_sample)));
        }
    }
    let of_shaft = |(powers, edges): (Vec<Vec<f64>>, &Vec<f64>)| {
        let (points, padded) = segment(edges.len().saturating_sub(1));
        let step = CELLS as f64 / padded as f64;
        let (mut standing, mut depths) = (Vec::new(), Vec::new());
        let of_bands: Vec<Vec<f64>> = powers.iter().map(|powers| stand_out(powers, step)).collect();
        for line in 0..powers.first().map_or(0, Vec::len) {
            standing.extend(of_bands.iter().map(|of| of[line]));
            depths.extend(powers.iter().map(|of| of[line].sqrt()));
        }
        BandSpectra { bands: bands.clone(), step, resolved: points as f64 / CELLS as f64, standing, depths }
    };
    Ok(powers.into_iter().zip(&edges).map(of_shaft).collect())
}

/// Where each cell of angle begins between the samples, and where the last one ends.
fn cell_edges(phase: &ShaftPhase) -> Vec<f64> {
    let cells = (phase.span_rev() * CELLS as f64) as usize;
    let first = phase.revolutions.first().copied().unwrap_or(0.0);
    (0..=cells).map(|cell| phase.sample_at(first + cell as f64 / CELLS as f64)).collect()
}

/// The sums of the squared envelope of a band up to each of its values, at a rate of its own that holds all of it.
///
/// # Arguments
/// * `lines` - of the spectrum, in the band
fn sums_of_squared_envelope(lines: &[Complex64]) -> Vec<f64> {
    let mut shifted = lines.to_vec();
    // The square is twice as wide as the band.
    shifted.resize(convenient_length(2 * lines.len()), Complex64::default());
    let mut sum = 0.0;
    let up_to = inverse_complex(shifted).into_iter().map(|value| {
        sum += value.norm_sqr();
        sum
    });
    std::iter::once(0.0).chain(up_to).collect()
}

/// The mean of the squared envelope in each cell, over its mean in all.
fn cells(sums: &[f64], edges: &[f64], per_sample: f64) -> Vec<f64> {
    let (up_to, last) = (UniformLinear::uniform(0.0, 1.0, sums), (sums.len() - 1) as f64);
    let sums: Vec<f64> = edges.iter().map(|edge| up_to.at((edge * per_sample).min(last))).collect();
    let widths = edges.windows(2).map(|pair| (pair[1] - pair[0]).max(f64::MIN_POSITIVE));
    let means: Vec<f64> =
        sums.windows(2).zip(widths).map(|(pair, width)| (pair[1] - pair[0]) / width).collect();
    let mean = (means.iter().sum::<f64>() / means.len().max(1) as f64).max(f64::MIN_POSITIVE);
    means.into_iter().map(|value| value / mean).collect()
}

/// Cells of a segment, and with the zeros behind them: lines then lie close enough together for none to fall between two.
fn segment(cells: usize) -> (usize, usize) {
    let (length, whole) = SEGMENT;
    let points = if cells as f64 >= whole * CELLS as f64 { (length * CELLS as f64) as usize } else { cells };
    (points, convenient_length(2 * points))
}

/// Squared amplitudes of the lines with a Hann window, the mean of all segments.
fn mean_spectrum(cells: &[f64]) -> Vec<f64> {
    let (points, padded) = segment(cells.len());
    let lines = ((LAST * padded as f64 / CELLS as f64) as usize).min(padded / 2);
    let window = hann_window(points);
    let mut powers = vec![0.0; lines];
    let starts = (0..=cells.len() - points).step_by((points / 2).max(1));
    let segments = starts.clone().count() as f64;
    for start in starts {
        let mut values = windowed(&cells[start..start + points], &window);
        values.resize(padded, 0.0);
        // A Hann window halves the amplitude, and each line has a mirror image.
        let amplitude = |line: &Complex64| line.norm_sqr() * (4.0 / points as f64).powi(2) / segments;
        powers.iter_mut().zip(&real_spectrum(&values)).for_each(|(power, line)| *power += amplitude(line));
    }
    powers
}

/// How far each line stands out of those beside it. A logarithm, so that no single line outweighs the others; that of noise is bounded below.
fn stand_out(powers: &[f64], step: f64) -> Vec<f64> {
    let half = BESIDE.1.max(BESIDE.0 / step) as usize;
    let stride = (half / MEDIANS).max(1);
    let median = |line: usize| {
        let beside = line.saturating_sub(half).max(1)..(line + half + 1).min(powers.len());
        upper_median(&powers[beside]).max(f64::MIN_POSITIVE)
    };
    let medians: Vec<f64> = (1..powers.len()).step_by(stride).map(median).collect();
    let standing = |line: usize| (0.5 * (1.0 + powers[line] / medians[(line - 1) / stride])).ln();
    let first = powers.first().map(|_| 0.0);
    first.into_iter().chain((1..powers.len()).map(standing)).collect()
}
