//! Phase from the mesh tone itself.

use std::f64::consts::{PI, TAU};

use meshtone_fourier::{Complex64, convenient_length, inverse_complex, real_spectrum};

use super::mesh_tone_checks::{check, check_fading, check_tone};
use super::{AngleZero, ShaftPhase};
use crate::interpolation::NotAKnotSpline;
use crate::signal::SignalError;

/// Part of the band on each side of its middle that is passed unchanged; from there it falls as a cosine to its ends.
const FLAT: f64 = 0.5;
/// Samples of the tone's phase per period of the band's width.
const OVERSAMPLING: usize = 8;

/// The tone to be followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshTone {
    /// Teeth of the wheel on the shaft.
    pub teeth: u32,
    /// (Hz) The shaft's nominal speed.
    pub shaft_hz: f64,
    /// Number of the harmonic of the mesh frequency: 1 is the mesh frequency itself, the safest. Higher ones give a finer phase
    /// where they stand out.
    pub harmonic: u32,
    /// (Hz) Half width of the band that holds the tone at all times; by default half the shaft's speed, which leaves the
    /// sidebands of one revolution out and allows the speed to vary by half a tooth per revolution.
    pub half_band_hz: Option<f64>,
}

impl MeshTone {
    /// The mesh frequency in the default band.
    ///
    /// # Arguments
    /// They are the fields of the same names.
    pub fn new(teeth: u32, shaft_hz: f64) -> Self {
        Self { teeth, shaft_hz, harmonic: 1, half_band_hz: None }
    }

    pub(in crate::signal) fn per_revolution(&self) -> f64 {
        f64::from(self.teeth) * f64::from(self.harmonic)
    }

    pub(super) fn frequency_hz(&self) -> f64 {
        self.per_revolution() * self.shaft_hz
    }

    pub(super) fn half_band_hz(&self) -> f64 {
        self.half_band_hz.unwrap_or(0.5 * self.shaft_hz)
    }
}

impl ShaftPhase {
    /// The shaft's phase without a tachometer: the unwrapped phase of the band-passed mesh tone's analytic signal, divided
    /// by the teeth.
    ///
    /// White noise makes an error of `√(2 b/(f_s r))/(2π z)` revolutions rms, with b the band's equivalent half width (0.69 of
    /// the given one), r the ratio of the tone's power to all the noise's and z the teeth, as long as the tone stays in the
    /// middle half of the band; towards its ends the tone is weakened and the error grows. Phase modulation within the band,
    /// as from a run-out, is taken for speed; sidebands outside it are left out. The angle's origin is
    /// where the tone has a maximum, so it says nothing about which tooth is which.
    ///
    /// One period of `half_band_hz` is left out at each end of the recording, where the band-pass rings.
    ///
    /// Source: F. Bonnardot, M. El Badaoui, R. B. Randall, J. Danière, F. Guillet, "Use of the acceleration signal of a
    /// gearbox in order to perform angular resampling (with limited speed fluctuation)", Mech. Syst. Signal Process. 19
    /// (2005) 766–785.
    ///
    /// # Arguments
    /// * `signal` - the vibration
    /// * `sampling_rate_hz` - (S/s) its sampling rate
    /// * `tone` - the tone to be followed
    ///
    /// # Errors
    /// NaN; a constant channel; a band that reaches beyond half the sampling rate or below 0; a recording shorter than four
    /// periods of the band's half width; no tone that stands out. Where a line beside the band is at least twice as strong,
    /// or the tone nearly vanishes somewhere, a warning says so.
    ///
    /// ```
    /// use meshtone::signal::{MeshTone, ShaftPhase};
    ///
    /// let tone: Vec<f64> = (0..20_000).map(|i| (std::f64::consts::TAU * 340.0 * i as f64 / 1e4).cos()).collect();
    /// let phase = ShaftPhase::from_mesh_tone(&tone, 1e4, &MeshTone::new(17, 20.1))?;
    /// assert!((phase.mean_speed_hz(1e4) - 20.0).abs() < 1e-5);
    /// # Ok::<(), meshtone::signal::SignalError>(())
    /// ```
    pub fn from_mesh_tone(
        signal: &[f64],
        sampling_rate_hz: f64,
        tone: &MeshTone,
    ) -> Result<Self, SignalError> {
        check(signal, sampling_rate_hz, tone)?;
        let (frequency_hz, half_band_hz) = (tone.frequency_hz(), tone.half_band_hz());
        let mean = signal.iter().sum::<f64>() / signal.len() as f64;
        let length = convenient_length(signal.len());
        let mut padded: Vec<f64> = signal.iter().map(|x| x - mean).collect();
        padded.resize(length, 0.0);
        let spectrum = real_spectrum(&padded);

        let bins_per_hz = length as f64 / sampling_rate_hz;
        let band = Band::new(frequency_hz * bins_per_hz, half_band_hz * bins_per_hz, length / 2);
        let mut warnings = check_tone(&spectrum, &band, tone, bins_per_hz)?;

        // The tone turned back to frequency 0, at a rate that suits its width.
        let points = convenient_length((OVERSAMPLING * 2 * band.half).max(16));
        let baseband = inverse_complex(band.shifted(&spectrum, points));
        let mut cycles: Vec<f64> = baseband.iter().map(|z| z.arg() / TAU).collect();
        unwrap_cycles(&mut cycles);
        let samples_per_point = length as f64 / points as f64;
        let curve = NotAKnotSpline::uniform(0.0, samples_per_point, &cycles);

        let dropped = (sampling_rate_hz / half_band_hz).ceil() as usize;
        let kept = dropped..signal.len() - dropped;
        warnings.extend(check_fading(&baseband, samples_per_point, &kept));
        let carrier = band.middle as f64 / length as f64;
        let angle = |i: usize| (carrier * i as f64 + curve.at(i as f64)) / tone.per_revolution();
        let origin = (angle(kept.start) * tone.per_revolution()).floor() / tone.per_revolution();
        let first_sample = kept.start;
        let phase = Self::new(first_sample, kept.map(|i| angle(i) - origin).collect())?;
        Ok(phase.with_zero(AngleZero::Chance).with_warnings(warnings))
    }
}

/// Bins of the spectrum around the tone.
pub(super) struct Band {
    pub(super) middle: usize,
    pub(super) half: usize,
}

impl Band {
    fn new(middle: f64, half: f64, last: usize) -> Self {
        let middle = middle.round() as usize;
        Self { middle, half: (half.ceil() as usize).clamp(2, middle.min(last - middle).max(2)) }
    }

    pub(super) fn bins(&self) -> std::ops::RangeInclusive<usize> {
        self.middle - self.half..=self.middle + self.half
    }

    fn weight(&self, bin: usize) -> f64 {
        let off = bin.abs_diff(self.middle) as f64 / self.half as f64;
        if off <= FLAT { 1.0 } else { (0.5 * PI * (off - FLAT) / (1.0 - FLAT)).cos().powi(2) }
    }

    /// The band around bin 0 of a spectrum of `points` bins.
    fn shifted(&self, spectrum: &[Complex64], points: usize) -> Vec<Complex64> {
        let mut shifted = vec![Complex64::default(); points];
        for bin in self.bins() {
            shifted[(bin + points - self.middle) % points] = spectrum[bin] * self.weight(bin);
        }
        shifted
    }
}

/// Takes the jumps of a whole cycle out.
fn unwrap_cycles(cycles: &mut [f64]) {
    let mut turns = 0.0;
    for i in 1..cycles.len() {
        let step = cycles[i] + turns - cycles[i - 1];
        turns -= step.round();
        cycles[i] += turns;
    }
}
