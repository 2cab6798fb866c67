//! Phase from the mesh tone itself.

use std::f64::consts::{PI, TAU};

use rustfft::num_complex::Complex64;

use super::ShaftPhase;
use crate::interpolation::NotAKnotSpline;
use crate::signal::check::{check_channel, check_positive};
use crate::signal::fourier::{convenient_length, inverse_complex, real_spectrum};
use crate::signal::{SignalError, SignalWarning};

/// Part of the band on each side of its middle that is passed unchanged; from there it falls as a cosine to its ends.
const FLAT: f64 = 0.5;
/// Samples of the tone's phase per period of the band's width.
const OVERSAMPLING: usize = 8;
/// Least mean power in the band over the median around it.
const LEAST_POWER_RATIO: f64 = 3.0;
/// Amplitude of a line beside the band over the strongest in it that makes one doubt.
const STRONGER: f64 = 2.0;
/// (shaft orders) How far beside the mesh such a line is looked for.
const NEIGHBOURHOOD: f64 = 4.5;
/// Part of the mean amplitude below which the phase is doubtful.
const FADED: f64 = 0.1;

/// The tone to be followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshTone {
    /// Teeth of the wheel on the shaft.
    pub teeth: u32,
    /// (Hz) The shaft's nominal speed.
    pub shaft_hz: f64,
    /// Which harmonic of the mesh frequency: 1 is the mesh frequency itself, the safest. Higher ones give a finer phase
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
    /// As the fields of the same names.
    pub fn new(teeth: u32, shaft_hz: f64) -> Self {
        Self { teeth, shaft_hz, harmonic: 1, half_band_hz: None }
    }

    fn per_revolution(&self) -> f64 {
        f64::from(self.teeth) * f64::from(self.harmonic)
    }

    fn frequency_hz(&self) -> f64 {
        self.per_revolution() * self.shaft_hz
    }

    fn half_band_hz(&self) -> f64 {
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
        Ok(Self::new(first_sample, kept.map(|i| angle(i) - origin).collect())?.with_warnings(warnings))
    }
}

/// Bins of the spectrum around the tone.
struct Band {
    middle: usize,
    half: usize,
}

impl Band {
    fn new(middle: f64, half: f64, last: usize) -> Self {
        let middle = middle.round() as usize;
        Self { middle, half: (half.ceil() as usize).clamp(2, middle.min(last - middle).max(2)) }
    }

    fn bins(&self) -> std::ops::RangeInclusive<usize> {
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

fn check(signal: &[f64], sampling_rate_hz: f64, tone: &MeshTone) -> Result<(), SignalError> {
    check_positive("sampling_rate_hz", sampling_rate_hz)?;
    check_positive("teeth", f64::from(tone.teeth))?;
    check_positive("harmonic", f64::from(tone.harmonic))?;
    check_positive("shaft_hz", tone.shaft_hz)?;
    let (frequency_hz, half_band_hz) = (tone.frequency_hz(), tone.half_band_hz());
    check_positive("half_band_hz", half_band_hz)?;
    if half_band_hz >= frequency_hz {
        return Err(SignalError::parameter("half_band_hz", half_band_hz, "less than the tone's frequency"));
    }
    if frequency_hz + half_band_hz >= 0.5 * sampling_rate_hz {
        return Err(SignalError::MeshOrderBeyondNyquist {
            mesh_order: tone.per_revolution(),
            nyquist_order: 0.5 * sampling_rate_hz / tone.shaft_hz,
        });
    }
    check_channel(signal)?;
    let needed = (4.0 * sampling_rate_hz / half_band_hz).ceil() as usize;
    if signal.len() < needed {
        return Err(SignalError::TooFew {
            what: "samples for a band so narrow",
            given: signal.len(),
            needed,
        });
    }
    Ok(())
}

/// Whether there is a tone in the band, and none stronger beside it.
fn check_tone(
    spectrum: &[Complex64],
    band: &Band,
    tone: &MeshTone,
    bins_per_hz: f64,
) -> Result<Vec<SignalWarning>, SignalError> {
    let power = |bin: usize| spectrum[bin].norm_sqr();
    let mean = band.bins().map(power).sum::<f64>() / (2 * band.half + 1) as f64;
    let around = band.middle / 2..(band.middle + band.middle / 2).min(spectrum.len());
    let mut noise: Vec<f64> = around.filter(|bin| !band.bins().contains(bin)).map(power).collect();
    noise.sort_unstable_by(f64::total_cmp);
    let median = noise.get(noise.len() / 2).copied().unwrap_or(0.0);
    let ratio = if mean > 0.0 { mean / median } else { 0.0 };
    if ratio < LEAST_POWER_RATIO {
        return Err(SignalError::NoMeshTone {
            frequency_hz: tone.frequency_hz(),
            half_band_hz: tone.half_band_hz(),
            ratio,
            needed: LEAST_POWER_RATIO,
        });
    }
    let reach = (NEIGHBOURHOOD * tone.shaft_hz * bins_per_hz) as usize;
    let near = band.middle.saturating_sub(reach)..(band.middle + reach).min(spectrum.len());
    let strongest = |bins: &mut dyn Iterator<Item = usize>| {
        bins.map(|bin| (bin, power(bin))).max_by(|a, b| a.1.total_cmp(&b.1))
    };
    let inside = strongest(&mut band.bins());
    let beside = strongest(&mut near.filter(|bin| !band.bins().contains(bin)));
    let (Some((_, inside)), Some((bin, beside))) = (inside, beside) else { return Ok(Vec::new()) };
    let ratio = (beside / inside).sqrt();
    let frequency_hz = bin as f64 / bins_per_hz;
    let speed_hz = frequency_hz / tone.per_revolution();
    let warning = SignalWarning::StrongerNeighbour { frequency_hz, ratio, speed_hz };
    Ok((ratio >= STRONGER).then_some(warning).into_iter().collect())
}

fn check_fading(
    baseband: &[Complex64],
    samples_per_point: f64,
    kept: &std::ops::Range<usize>,
) -> Option<SignalWarning> {
    let inside = |point: usize| kept.contains(&((point as f64 * samples_per_point) as usize));
    let amplitudes: Vec<(usize, f64)> =
        baseband.iter().map(|z| z.norm()).enumerate().filter(|&(point, _)| inside(point)).collect();
    let mean = amplitudes.iter().map(|(_, amplitude)| amplitude).sum::<f64>() / amplitudes.len() as f64;
    let (point, least) = amplitudes.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let sample = (point as f64 * samples_per_point) as usize;
    (least < FADED * mean).then(|| SignalWarning::MeshToneFades { sample, ratio: least / mean })
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
