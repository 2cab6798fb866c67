//! Features of the wheels in a recording or a simulation.

use meshtone::operation::greatest_common_divisor;
use meshtone::signal::{
    Alternative, AngleZero, AngularSettings, AngularSignal, ForeignTones, GearTrain, LinesOffShafts,
    Mismatch, SeparationSettings, ShaftPhase, SignalError, SignalWarning, StatedFacts, StatedTurning,
    SynchronousAverage, angular_resample, check_channel, find_mismatch, foreign_tones, kurtosis,
    lines_off_shafts, rms, standard_deviation, synchronous_average, synchronous_part,
};
use meshtone_fourier::{Complex64, from_real_spectrum, real_spectrum};

/// Mesh orders of which lines are looked at.
pub(crate) const MESH_ORDERS: usize = 16;
/// (-) Part of a recording's Nyquist order up to which its lines are whole.
const PASSED: f64 = 0.8;

/// Kind of a signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SignalKind {
    /// A recording: any number of revolutions, from which both wheels' averages are taken.
    Recording,
    /// One revolution of the gear: its synchronous average.
    Average,
    /// One revolution of the gear: the difference signal, mesh harmonics and their sidebands taken away.
    Difference,
}

impl SignalKind {
    /// All with their names.
    pub const NAMES: [(&'static str, Self); 3] =
        [("recording", Self::Recording), ("average", Self::Average), ("difference", Self::Difference)];

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize].0
    }

    /// Returns whether the mesh harmonics are in it.
    pub(crate) fn has_regular_part(self) -> bool {
        self != Self::Difference
    }
}

/// The lines of a wheel's average over the orders of its shaft.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelLines {
    /// Teeth of the wheel.
    pub teeth: u32,
    /// Teeth of the other wheels on its shaft, whose meshes are in the same average.
    pub beside_teeth: Vec<u32>,
    /// (g) Complex amplitude at each order from 0 on: half the peak of a tone, as a line of the spectrum over its length.
    pub lines: Vec<Complex64>,
}

impl WheelLines {
    /// The lines of an average, as far as it is whole and they are looked at.
    ///
    /// # Arguments
    /// * `average` - over the revolutions of the wheel
    /// * `teeth` - of the wheel
    pub fn of_average(average: &SynchronousAverage, teeth: u32) -> Self {
        let passed = (PASSED * average.nyquist_order) as usize;
        Self::of_values(&average.values, teeth, passed)
    }

    /// Returns the lines of a wheel whose shaft carries other wheels too.
    ///
    /// # Arguments
    /// * `beside_teeth` - teeth of the others
    #[must_use]
    pub fn beside(mut self, beside_teeth: Vec<u32>) -> Self {
        self.beside_teeth = beside_teeth;
        self
    }

    /// The lines of one revolution.
    ///
    /// # Arguments
    /// * `values` - (g) at equal angles
    /// * `teeth` - of the wheel
    /// * `last` - the last order that is whole
    pub fn of_values(values: &[f64], teeth: u32, last: usize) -> Self {
        let count = values.len().max(1) as f64;
        let mut lines = real_spectrum(values);
        lines.truncate(1 + last.min(Self::most(teeth)));
        lines.iter_mut().for_each(|line| *line /= count);
        Self { teeth, beside_teeth: Vec::new(), lines }
    }

    /// The last order that is looked at.
    pub(crate) fn most(teeth: u32) -> usize {
        MESH_ORDERS * teeth as usize + teeth as usize / 2
    }

    /// The last order there is.
    pub(crate) fn last(&self) -> usize {
        self.lines.len().saturating_sub(1)
    }

    /// Returns whether an order belongs to the regular part: the shaft's low orders, mesh harmonics and their sidebands.
    fn is_regular(order: usize, teeth: u32, settings: &SeparationSettings) -> bool {
        let (mesh, beside) = (order / teeth.max(1) as usize, order % teeth.max(1) as usize);
        let near =
            (mesh > 0 && beside <= settings.sidebands) || teeth as usize - beside <= settings.sidebands;
        order == 0 || settings.shaft_orders.contains(&order) || near
    }

    /// The lines without the regular part.
    pub(crate) fn difference(&self) -> Vec<Complex64> {
        let settings = SeparationSettings::new(self.teeth as usize);
        let meshes: Vec<u32> = [self.teeth].into_iter().chain(self.beside_teeth.iter().copied()).collect();
        let is_regular = |order| meshes.iter().any(|&teeth| Self::is_regular(order, teeth, &settings));
        let kept =
            |(order, &line): (usize, &Complex64)| if is_regular(order) { Complex64::default() } else { line };
        self.lines.iter().enumerate().map(kept).collect()
    }
}

/// (g) Values of one revolution.
///
/// # Arguments
/// * `lines` - complex amplitudes by order
/// * `points` - how many values
pub(crate) fn revolution(lines: &[Complex64], points: usize) -> Vec<f64> {
    let count = points as f64;
    let mut spectrum: Vec<Complex64> = lines.iter().take(points / 2 + 1).map(|line| line * count).collect();
    spectrum.resize(points / 2 + 1, Complex64::default());
    from_real_spectrum(spectrum, points)
}

/// Features of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// Kind of the signal.
    pub signal: SignalKind,
    /// (Hz) Speed of the shaft that drives, of a pair the pinion's, where it is known.
    pub input_speed_hz: Option<f64>,
    /// Meaning of angle 0 of each wheel, from which its teeth are counted.
    pub zero: Vec<AngleZero>,
    /// The average of each wheel in the rig's order, of a pair pinion and gear; of a single revolution that of the gear alone.
    pub wheels: Vec<Option<WheelLines>>,
    /// (g) Standard deviation of what does not repeat, as it is left in the averages' lines, of each wheel by mesh order from 0 on; empty
    /// where it is not known.
    pub noise: Vec<Vec<f64>>,
    /// Why the recording is not what it is stated to be, where that is seen without a simulation.
    pub mismatch: Option<String>,
    /// Other warnings about it.
    pub doubts: Vec<String>,
}

impl Observation {
    /// Observes a recording over the angles of both shafts.
    ///
    /// # Arguments
    /// * `pinion`, `gear` - the same channel over the angle of either shaft ([`meshtone::signal::angular_resample`]), in g
    /// * `teeth` - of the pinion and of the gear
    /// * `pinion_speed_hz` - (Hz) mean speed of the pinion's shaft
    ///
    /// # Errors
    /// Fewer than two whole revolutions of the gear.
    pub fn of_recording(
        pinion: &AngularSignal,
        gear: &AngularSignal,
        teeth: [u32; 2],
        pinion_speed_hz: f64,
    ) -> Result<Self, SignalError> {
        if let Some(wrong) = teeth.into_iter().find(|teeth| *teeth == 0) {
            let (name, value, allowed) = ("teeth", f64::from(wrong), "at least 1");
            return Err(SignalError::Parameter { name, value, allowed });
        }
        let [of_pinion, of_gear] = [synchronous_average(pinion)?, synchronous_average(gear)?];
        let ratio = f64::from(teeth[1]) / f64::from(teeth[0]);
        let mismatch = nothing_synchronous([(pinion, &of_pinion, teeth[0]), (gear, &of_gear, teeth[1])])
            .or_else(|| silent_part(gear))
            .or_else(|| energy_off_both_shafts(gear, teeth, pinion_speed_hz / ratio));
        Ok(Self {
            signal: SignalKind::Recording,
            input_speed_hz: Some(pinion_speed_hz),
            zero: vec![AngleZero::Given; 2],
            wheels: [(&of_pinion, teeth[0]), (&of_gear, teeth[1])]
                .map(|(average, teeth)| Some(WheelLines::of_average(average, teeth)))
                .into(),
            noise: vec![noise(pinion, teeth[0], teeth[1]), noise(gear, teeth[1], teeth[0])],
            mismatch,
            doubts: too_short(gear.revolutions(), teeth, pinion_speed_hz / ratio).into_iter().collect(),
        })
    }

    /// Returns the observation with the meaning of angle 0.
    ///
    /// # Arguments
    /// * `zero` - of each wheel
    #[must_use]
    pub fn with_zero(mut self, zero: Vec<AngleZero>) -> Self {
        self.zero = zero;
        self
    }

    /// Returns the observation with a further mismatch of the recording.
    ///
    /// # Arguments
    /// * `against` - in words; said before what is known already
    pub fn with_mismatch(mut self, against: impl ToString) -> Self {
        let also = self.mismatch.take().map_or_else(String::new, |also| format!("; {also}"));
        self.mismatch = Some(format!("{}{also}", against.to_string()));
        self
    }

    /// The lines of each wheel, where they are known.
    pub(crate) fn seen(&self) -> Vec<Option<&WheelLines>> {
        self.wheels.iter().map(Option::as_ref).collect()
    }

    /// Observes one revolution of the gear.
    ///
    /// # Arguments
    /// * `values_g` - (g) at equal angles, a whole revolution
    /// * `gear_teeth` - teeth of the gear
    /// * `signal` - whether they are an average or a difference signal
    /// * `last_order` - the last order of the gear's shaft that the recording holds, where it was sampled more slowly than these
    ///   values tell
    ///
    /// # Errors
    /// Values that are not finite, or all the same.
    pub fn of_revolution(
        values_g: &[f64],
        gear_teeth: u32,
        signal: SignalKind,
        last_order: Option<f64>,
    ) -> Result<Self, SignalError> {
        check_channel(values_g)?;
        let nyquist_order = (values_g.len() / 2) as f64;
        let last = last_order.map_or(nyquist_order, |order| order.min(nyquist_order));
        Ok(Self {
            signal,
            input_speed_hz: None,
            zero: vec![AngleZero::FirstSample; 2],
            wheels: vec![None, Some(WheelLines::of_values(values_g, gear_teeth, (PASSED * last) as usize))],
            noise: vec![Vec::new(); 2],
            mismatch: None,
            doubts: beyond_a_revolution(values_g, gear_teeth).into_iter().collect(),
        })
    }
}

/// Looks for tooth counts that fit a recording better than those that are stated, at a stated speed: the phase of another tone than the
/// mesh's hides them.
///
/// # Arguments
/// * `signal`, `sampling_rate_hz` - the recording
/// * `teeth` - of the wheel whose speed is stated, and of its mate
/// * `speed_hz` - (Hz) about the speed of that wheel
///
/// # Errors
/// Those of [`angular_resample`].
pub(crate) fn other_teeth(
    signal: &[f64],
    sampling_rate_hz: f64,
    teeth: [u32; 2],
    speed_hz: f64,
) -> Result<Option<Mismatch>, SignalError> {
    let phase = ShaftPhase::constant(speed_hz, sampling_rate_hz, signal.len())?;
    let angular = angular_resample(signal, &phase, &AngularSettings::default())?;
    let turning = StatedTurning::ConstantSpeed { speed_hz };
    let found =
        find_mismatch(&angular, &StatedFacts { teeth: teeth[0], mate_teeth: Some(teeth[1]), turning });
    Ok(found.filter(|found| {
        matches!(found.alternative, Alternative::Teeth { .. } | Alternative::MateTeeth { .. })
    }))
}

/// (-) Part of the energy beyond the orders that are looked at, from which on values are hardly one revolution.
const BEYOND: f64 = 0.7;

/// Warning about values that are stated to be one revolution: those of many have their mesh orders as many times as high.
fn beyond_a_revolution(values_g: &[f64], gear_teeth: u32) -> Option<String> {
    let squares: Vec<f64> = real_spectrum(values_g).iter().skip(1).map(Complex64::norm_sqr).collect();
    let inside: f64 = squares.iter().take(WheelLines::most(gear_teeth)).sum();
    let all: f64 = squares.iter().sum();
    (all - inside > BEYOND * all).then(|| {
        format!(
            "{:.0} % of the energy is beyond mesh order {MESH_ORDERS}: are these {} values one revolution of a gear with {gear_teeth} \
             teeth, or many?",
            100.0 * (1.0 - inside / all),
            values_g.len()
        )
    })
}

/// Warning about averages over so few revolutions that each wheel's is not free of its mate's, or that noise is not
/// separated from what repeats.
///
/// # Arguments
/// * `gear_revolutions` - in the recording
/// * `teeth` - of the pinion and of the gear
/// * `gear_hz` - (Hz) speed of the gear's shaft
fn too_short(gear_revolutions: usize, [pinion, gear]: [u32; 2], gear_hz: f64) -> Option<String> {
    let lasts = |revolutions: usize| {
        format!("{revolutions} turns of the gear, {:.2} s", revolutions as f64 / gear_hz)
    };
    if gear_revolutions < FEWEST_REVOLUTIONS {
        return Some(format!(
            "the recording is short ({}): to distinguish noise from what the wheels repeat, at least {} are needed",
            lasts(gear_revolutions),
            lasts(FEWEST_REVOLUTIONS)
        ));
    }
    // Revolutions of the gear after which the same teeth meet again.
    let sequence = (pinion / greatest_common_divisor(pinion, gear)) as usize;
    let needed = SEQUENCES * sequence;
    // Over whole sequences each wheel's orders are lines of their own.
    (gear_revolutions < needed && !gear_revolutions.is_multiple_of(sequence)).then(|| {
        format!(
            "the recording is short ({}): what is seen of one wheel is partly of the other until the same teeth have met \
             {SEQUENCES} times ({}); record that long",
            lasts(gear_revolutions),
            lasts(needed)
        )
    })
}

/// Times that the same teeth should meet in a recording.
const SEQUENCES: usize = 3;
/// Revolutions below which noise is not distinguished from what repeats.
const FEWEST_REVOLUTIONS: usize = 6;
/// (-) Median over mean of the squared magnitude of normal noise.
const MEDIAN_OF_SQUARES: f64 = std::f64::consts::LN_2;
/// (-) Mean square of Hann's window.
const WINDOW_SQUARE: f64 = 0.375;
/// (-) The same over its middle half: 3/8 + 1/π.
const MIDDLE_SQUARE: f64 = 0.375 + std::f64::consts::FRAC_1_PI;

/// (g) Standard deviation of the noise in the lines of an average, by mesh order: from the median of the lines beside the orders of
/// both shafts, which tones do not move. Empty where there are too few revolutions.
fn noise(angular: &AngularSignal, teeth: u32, mate_teeth: u32) -> Vec<f64> {
    let revolutions = angular.revolutions();
    if revolutions < FEWEST_REVOLUTIONS {
        return Vec::new();
    }
    let LinesOffShafts { spectrum, is_off } =
        lines_off_shafts(angular, &GearTrain::of_wheels([("wheel", teeth), ("mate", mate_teeth)]), 0);
    let per_mesh_order = teeth as usize * revolutions;
    let count = (revolutions * angular.points_per_revolution) as f64;
    let last = (PASSED * angular.nyquist_order) as usize * revolutions;
    let band = |mesh: usize| {
        let from = (mesh * per_mesh_order).saturating_sub(per_mesh_order / 2);
        let to = (mesh * per_mesh_order + per_mesh_order / 2).min(last).min(spectrum.len());
        let squares = (from..to).filter(|&line| is_off[line]).map(|line| spectrum[line].norm_sqr());
        Some((median(squares.collect())? / MEDIAN_OF_SQUARES / WINDOW_SQUARE).sqrt() / count)
    };
    (0..=MESH_ORDERS).map_while(band).collect()
}

/// The middle one of some values, of an even number the upper one; none of no values.
fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Evidence against a recording of which nothing repeats with either shaft.
///
/// # Arguments
/// * `views` - the recording over the angles of both shafts, with their averages and teeth
fn nothing_synchronous(views: [(&AngularSignal, &SynchronousAverage, u32); 2]) -> Option<String> {
    let parts = views.map(|(view, average, _)| synchronous_part(&view.values, &average.values));
    let [Some(pinion), Some(part)] = parts else { return None };
    let is_known = part.revolutions >= FEWEST_REVOLUTIONS;
    let warning = SignalWarning::NothingSynchronous { part, teeth: views[1].2 };
    (is_known && pinion.is_noise() && part.is_noise()).then(|| warning.to_string())
}

/// (-) Level of the quietest revolution over that of the loudest, below which the sensor did not measure all the time.
const QUIETEST: f64 = 1.0 / 30.0;

/// Evidence against a recording that is silent for a part of the time.
fn silent_part(gear: &AngularSignal) -> Option<String> {
    let levels = gear.values.chunks_exact(gear.points_per_revolution).map(standard_deviation);
    let levels: Vec<f64> = levels.collect();
    let loudest = levels.iter().copied().fold(0.0, f64::max);
    let silent = levels.iter().filter(|level| **level < QUIETEST * loudest).count();
    (silent > 0).then(|| {
        format!(
            "{silent} of {} revolutions of the gear have less than 1/{:.0} of the level of the loudest: a sensor that failed, or knocks; cut the \
             recording to where the machine runs evenly",
            levels.len(),
            1.0 / QUIETEST
        )
    })
}

/// (-) Kurtosis of what belongs to neither shaft, from which on it is impulsive.
const IMPULSIVE: f64 = 4.5;
/// (-) Its part of the energy from which on it counts: teeth that strike and part make up to a seventh that repeats with neither
/// shaft, since it depends on which two teeth meet.
const COUNTS: f64 = 0.15;
/// Evidence against the recording where the orders of the two shafts do not explain it: impulses, or tones, that repeat with neither.
///
/// The lines of both shafts are left out of the spectrum of the whole recording. Of the others, those that stand out of their surroundings are
/// tones; and what they make over time is impulsive where something strikes. Impulses are looked for first, since their lines may stand out
/// like tones.
fn energy_off_both_shafts(gear: &AngularSignal, [pinion, teeth]: [u32; 2], gear_hz: f64) -> Option<String> {
    if gear.revolutions() < FEWEST_REVOLUTIONS {
        return None;
    }
    let whole = gear.revolutions() * gear.points_per_revolution;
    let train = GearTrain::of_wheels([("gear", teeth), ("pinion", pinion)]);
    let mut lines = lines_off_shafts(gear, &train, 0);
    let tones = foreign_tones(gear, &train, 0, gear_hz);
    let passed = (PASSED * gear.nyquist_order) as usize * gear.revolutions();
    for (line, value) in lines.spectrum.iter_mut().enumerate() {
        if !lines.is_off[line] || line >= passed {
            *value = Complex64::default();
        }
    }
    // The middle half, where the window is level enough to leave the shape.
    let rest = from_real_spectrum(lines.spectrum, whole);
    let rest = &rest[whole / 4..3 * whole / 4];
    let part = (rms(rest) / standard_deviation(&gear.values).max(f64::MIN_POSITIVE)).powi(2) / MIDDLE_SQUARE;
    let impulses = kurtosis(rest)?;
    if impulses > IMPULSIVE && part > COUNTS {
        return Some(format!(
            "impulses that repeat with neither shaft make {:.0} % of the recording's energy (kurtosis {impulses:.1}): a bearing, or \
             something else than these teeth",
            100.0 * part
        ));
    }
    tones.as_deref().and_then(ForeignTones::that_count).map(|tones| tones.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshtone::random::{Draws, Purpose};
    use std::f64::consts::TAU;

    const TEETH: [u32; 2] = [17, 38];

    /// Both shafts' views of a signal over the gear's angle, in revolutions of the gear.
    fn views(signal: &mut dyn FnMut(f64) -> f64, revolutions: usize) -> [AngularSignal; 2] {
        [(1024, 38.0 / 17.0), (2048, 1.0)].map(|(points, turns)| {
            let count = (revolutions as f64 * turns) as usize * points;
            AngularSignal {
                points_per_revolution: points,
                start_rev: 0.0,
                nyquist_order: points as f64 / 2.0,
                values: (0..count).map(|at| signal(at as f64 / points as f64 / turns)).collect(),
            }
        })
    }

    fn tones(gear_rev: f64) -> f64 {
        let of_pinion = 38.0 / 17.0 * gear_rev;
        (TAU * 38.0 * gear_rev).cos()
            + 0.1 * (TAU * 43.0 * gear_rev).cos()
            + 0.2 * (TAU * 5.0 * of_pinion).sin()
    }

    // Noise has nothing of either shaft, a sensor that failed nothing of a part of the time; tones in noise have both.
    #[test]
    fn noise_and_silence_are_no_recording_of_the_pair() {
        let mut draws = Draws::new(5, Purpose::DiagnosisNoise, 0);
        let mut said = |signal: &mut dyn FnMut(f64, f64) -> f64| {
            let [pinion, gear] = views(&mut |rev| signal(rev, draws.normal()), 34);
            Observation::of_recording(&pinion, &gear, TEETH, 40.0).unwrap().mismatch
        };
        assert_eq!(said(&mut |rev, noise| tones(rev) + 0.5 * noise), None);
        let of_noise = said(&mut |_, noise| noise).unwrap();
        assert!(of_noise.contains("nothing in the recording clearly repeats"), "{of_noise}");
        let failed = said(&mut |rev, noise| if rev < 20.0 { tones(rev) + 0.1 * noise } else { 0.0 }).unwrap();
        assert!(failed.starts_with("14 of 34 revolutions"), "{failed}");
    }

    // The variance of a mean over revolutions, and of a line of it: the sample's over their number and that of the points.
    #[test]
    fn noise_is_distinguished_from_both_shafts_tones() {
        let mut draws = Draws::new(1, Purpose::DiagnosisNoise, 0);
        let [pinion, gear] = views(&mut |rev| tones(rev) + 0.5 * draws.normal(), 34);
        let observed = Observation::of_recording(&pinion, &gear, TEETH, 40.0).unwrap();
        for (wheel, view) in [&pinion, &gear].into_iter().enumerate() {
            let expected = 0.5 / ((view.revolutions() * view.points_per_revolution) as f64).sqrt();
            for (mesh, said) in observed.noise[wheel].iter().enumerate().skip(1) {
                assert!((said / expected - 1.0).abs() < 0.2, "{wheel} {mesh}: {said} of {expected}");
            }
        }
        assert_eq!(observed.mismatch, None);
    }

    #[test]
    fn impulses_of_neither_shaft_are_reported() {
        // Every 0.2713 revolutions: no order of either shaft.
        let mut struck = |rev: f64| {
            let since = rev % 0.2713;
            tones(rev) + 10.0 * (-since * 400.0).exp() * (TAU * 300.0 * since).sin()
        };
        let [pinion, gear] = views(&mut struck, 34);
        let observed = Observation::of_recording(&pinion, &gear, TEETH, 40.0).unwrap();
        assert!(observed.mismatch.is_some_and(|said| said.contains("neither shaft")));
    }

    #[test]
    fn lines_are_those_of_a_revolution() {
        let value = |rev: f64| (TAU * 38.0 * rev).cos() + 0.1 * (TAU * 43.0 * rev).cos();
        let values: Vec<f64> = (0..2048).map(|at| value(f64::from(at) / 2048.0)).collect();
        let lines = WheelLines::of_values(&values, 38, 800);
        assert_eq!(lines.last(), WheelLines::most(38));
        assert!((lines.lines[38].norm() - 0.5).abs() < 1e-9);
        assert!(lines.difference()[38].norm() == 0.0 && (lines.difference()[43].norm() - 0.05).abs() < 1e-9);
        let error = revolution(&lines.lines, 2048)
            .iter()
            .zip(&values)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(error < 1e-9, "{error}");
    }
}
