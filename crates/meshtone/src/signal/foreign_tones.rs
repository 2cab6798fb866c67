//! Tones that belong to neither shaft of a pair.

use meshtone_fourier::{Complex64, hann_window, real_spectrum};

use super::AngularSignal;
use crate::operation::greatest_common_divisor;

/// (lines) How near a line is to an order, to belong to it: the main lobe of Hann's window, and a little.
const NEAR_LINES: f64 = 2.5;
/// (-) A line is a tone where its square is so many times the median of its neighbours'. Of noise, one in 10⁹ is.
const TONE: f64 = 30.0;
/// (-) Part of the energy in tones of neither shaft from which on they count: teeth that strike and part make up to a seventh that repeats
/// with neither shaft, since it depends on which two teeth meet.
const COUNTS: f64 = 0.2;
/// Part of the Nyquist order up to which lines are right.
const PASSED: f64 = 0.8;
/// Lines of neither shaft that are compared with their median: fewer than a resonance has, whose noise is no tone.
const BAND: usize = 48;
/// Fewest revolutions whose lines are distinguished from the shafts' orders.
const FEWEST_REVOLUTIONS: usize = 6;
/// Tones that are named.
const NAMED: usize = 3;
/// (Hz) Mains frequencies, and the highest harmonic that is looked for.
const MAINS_HZ: ([f64; 2], f64) = ([50.0, 60.0], 12.0);

/// A tone that belongs to neither shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForeignTone {
    /// (Hz) At the mean speed of the recording.
    pub frequency_hz: f64,
    /// (orders of the shaft) Its order.
    pub order: f64,
    /// (-) Its part of the recording's energy.
    pub part: f64,
    /// Whether it is a harmonic of a mains frequency.
    pub may_be_mains: bool,
}

/// Tones that belong to neither shaft and make much of a recording.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ForeignTones {
    /// (-) Part of the recording's energy that all of them have.
    pub part: f64,
    /// The strongest of them, at most three.
    pub strongest: Vec<ForeignTone>,
}

/// The spectrum of a recording, and for each line whether it belongs to neither shaft.
#[derive(Debug, Clone)]
pub struct LinesOffShafts {
    /// Of the recording without its mean behind Hann's window: line k is order k/revolutions.
    pub spectrum: Vec<Complex64>,
    /// Whether each line lies beside the orders of both shafts.
    pub is_off: Vec<bool>,
}

/// Finds the lines of a recording that are beside the orders of both shafts of a pair.
///
/// Multiples of 1/q, where the tooth counts are as p to q in lowest terms, are the pair's own as well, since the same teeth meet again after q
/// revolutions. They are left out where the recording is long enough to distinguish them.
///
/// # Arguments
/// * `angular` - the recording over whole revolutions of the shaft of a wheel
/// * `teeth` - of that wheel
/// * `mate_teeth` - of the wheel that meshes with it
pub fn lines_off_shafts(angular: &AngularSignal, teeth: u32, mate_teeth: u32) -> LinesOffShafts {
    let revolutions = angular.revolutions();
    let whole = revolutions * angular.points_per_revolution;
    let mean = angular.values.iter().take(whole).sum::<f64>() / whole.max(1) as f64;
    let windowed = angular.values.iter().zip(hann_window(whole));
    let windowed: Vec<f64> = windowed.map(|(value, window)| window * (value - mean)).collect();
    let spectrum = real_spectrum(&windowed);
    let mut spacings = vec![1.0, f64::from(teeth) / f64::from(mate_teeth)];
    let hunting = f64::from(greatest_common_divisor(teeth, mate_teeth)) / f64::from(mate_teeth);
    if hunting * revolutions as f64 > 4.0 * NEAR_LINES {
        spacings.push(hunting);
    }
    let is_off = |line: usize| {
        let order = line as f64 / revolutions.max(1) as f64;
        let lines_from =
            |spacing: &f64| (order - (order / spacing).round() * spacing).abs() * revolutions as f64;
        spacings.iter().all(|spacing| lines_from(spacing) > NEAR_LINES)
    };
    LinesOffShafts { is_off: (0..spectrum.len()).map(is_off).collect(), spectrum }
}

impl LinesOffShafts {
    /// The tones among the lines of neither shaft, where they make a fifth of the energy or more.
    ///
    /// # Arguments
    /// * `angular` - the recording that the lines are of
    /// * `mean_speed_hz` - (Hz) mean speed of the shaft
    pub fn tones(&self, angular: &AngularSignal, mean_speed_hz: f64) -> Option<ForeignTones> {
        let revolutions = angular.revolutions();
        let passed = ((PASSED * angular.nyquist_order) as usize * revolutions).min(self.spectrum.len());
        if revolutions < FEWEST_REVOLUTIONS {
            return None;
        }
        let square = |line: usize| self.spectrum[line].norm_sqr();
        let energy: f64 = (3..passed).map(square).sum();
        let off: Vec<usize> = (3..passed).filter(|&line| self.is_off[line]).collect();
        let in_tones: Vec<usize> = off
            .chunks(BAND)
            .flat_map(|band| {
                let mut squares: Vec<f64> = band.iter().map(|&line| square(line)).collect();
                let middle = squares.len() / 2;
                let median = *squares.select_nth_unstable_by(middle, f64::total_cmp).1;
                band.iter().copied().filter(move |&line| square(line) > TONE * median)
            })
            .collect();
        let part = in_tones.iter().copied().map(square).sum::<f64>() / energy;
        // A signal without energy has no parts.
        if part.is_nan() || part <= COUNTS {
            return None;
        }
        // Lines beside each other are one tone.
        let hz_per_line = mean_speed_hz / revolutions as f64;
        let mut tones: Vec<ForeignTone> = in_tones
            .chunk_by(|one, next| next - one == 1)
            .map(|lines| {
                let squares: f64 = lines.iter().copied().map(square).sum();
                let centre = lines.iter().map(|&line| line as f64 * square(line)).sum::<f64>() / squares;
                let frequency_hz = centre * hz_per_line;
                let ([fifty, sixty], most) = MAINS_HZ;
                let is_of = |mains_hz: f64| {
                    let harmonic = (frequency_hz / mains_hz).round().clamp(1.0, most);
                    (frequency_hz - harmonic * mains_hz).abs() < 2.0 * hz_per_line
                };
                ForeignTone {
                    frequency_hz,
                    order: centre / revolutions as f64,
                    part: squares / energy,
                    may_be_mains: is_of(fifty) || is_of(sixty),
                }
            })
            .collect();
        tones.sort_by(|a, b| b.part.total_cmp(&a.part));
        tones.truncate(NAMED);
        Some(ForeignTones { part, strongest: tones })
    }
}

impl std::fmt::Display for ForeignTones {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "tones at no order of either shaft make {:.0} % of the recording's energy, the strongest at ",
            100.0 * self.part
        )?;
        for (number, tone) in self.strongest.iter().enumerate() {
            let before = if number == 0 { "" } else { ", " };
            let mains = if tone.may_be_mains { ", a harmonic of the mains" } else { "" };
            let ForeignTone { frequency_hz, order, part, .. } = tone;
            write!(f, "{before}{frequency_hz:.2} Hz (order {order:.3}, {:.0} %{mains})", 100.0 * part)?;
        }
        write!(
            f,
            ": another stage or machine, a bearing, or teeth or speed that are not as stated; the average holds nothing of them"
        )
    }
}
