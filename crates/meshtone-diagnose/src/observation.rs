//! Features of the wheels in a recording or a simulation.

use meshtone::signal::{
    Alternative, AngleZero, AngularSettings, BearingDefects, ForeignTones, GearTrain, MeanPart, Mismatch,
    SeparationSettings, ShaftPhase, SignalError, StatedFacts, StatedTurning, SynchronousAverage,
    angular_resample, check_channel, find_mismatch,
};
use meshtone_fourier::{Complex64, from_real_spectrum, real_spectrum};

/// Mesh orders of which lines are looked at.
pub(crate) const MESH_ORDERS: usize = 16;
/// (-) Part of a recording's Nyquist order up to which its lines are whole.
pub(crate) const PASSED: f64 = 0.8;

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
    /// Teeth of the wheel, and what else is regular in the average.
    pub separation: SeparationSettings,
    /// (g) Complex amplitude at each order from 0 on: half the peak of a tone, as a line of the spectrum over its length.
    pub lines: Vec<Complex64>,
}

impl WheelLines {
    /// The lines of an average, as far as it is whole and they are looked at.
    ///
    /// # Arguments
    /// * `average` - over the revolutions of the wheel
    /// * `separation` - of the wheel
    pub fn of_average(average: &SynchronousAverage, separation: SeparationSettings) -> Self {
        let passed = (PASSED * average.nyquist_order) as usize;
        Self::of_values(&average.values, separation, passed)
    }

    /// The lines of one revolution.
    ///
    /// # Arguments
    /// * `values` - (g) at equal angles
    /// * `separation` - of the wheel
    /// * `last` - the last order that is whole
    pub fn of_values(values: &[f64], separation: SeparationSettings, last: usize) -> Self {
        let count = values.len().max(1) as f64;
        let mut lines = real_spectrum(values);
        lines.truncate(1 + last.min(Self::most(separation.teeth)));
        lines.iter_mut().for_each(|line| *line /= count);
        Self { separation, lines }
    }

    /// The last order that is looked at, of a wheel of so many teeth.
    pub(crate) fn most(teeth: usize) -> usize {
        MESH_ORDERS * teeth + teeth / 2
    }

    /// Teeth of the wheel.
    pub fn teeth(&self) -> usize {
        self.separation.teeth
    }

    /// The last order there is.
    pub(crate) fn last(&self) -> usize {
        self.lines.len().saturating_sub(1)
    }

    /// The lines without the regular part.
    pub(crate) fn difference(&self) -> Vec<Complex64> {
        let regular = self.separation.regular_orders(self.last());
        let kept =
            |(line, is_regular): (&Complex64, bool)| if is_regular { Complex64::default() } else { *line };
        self.lines.iter().zip(regular).map(kept).collect()
    }
}

/// What is regular in the average of a wheel of so many teeth, alone on its shaft.
pub(crate) fn separation(teeth: u32) -> SeparationSettings {
    SeparationSettings { mean: MeanPart::Removed, ..SeparationSettings::new(teeth as usize) }
}

/// What is regular in the average of each wheel of a train.
pub(crate) fn separations(train: &GearTrain) -> Vec<SeparationSettings> {
    let of = |wheel: usize| train.separation(wheel, &separation(train.wheels[wheel].teeth));
    (0..train.wheels.len()).map(of).collect()
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
    /// Tones of no shaft, however weak.
    pub foreign: Option<ForeignTones>,
    /// Other warnings about it.
    pub doubts: Vec<String>,
    /// What it shows about the bearings of the rig; nothing in a single revolution.
    pub bearings: BearingDefects,
}

impl Observation {
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
            wheels: vec![
                None,
                Some(WheelLines::of_values(values_g, separation(gear_teeth), (PASSED * last) as usize)),
            ],
            noise: vec![Vec::new(); 2],
            mismatch: None,
            foreign: None,
            doubts: beyond_a_revolution(values_g, gear_teeth).into_iter().collect(),
            bearings: BearingDefects::default(),
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
    let inside: f64 = squares.iter().take(WheelLines::most(gear_teeth as usize)).sum();
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn lines_are_those_of_a_revolution() {
        let value = |rev: f64| (TAU * 38.0 * rev).cos() + 0.1 * (TAU * 43.0 * rev).cos();
        let values: Vec<f64> = (0..2048).map(|at| value(f64::from(at) / 2048.0)).collect();
        let lines = WheelLines::of_values(&values, separation(38), 800);
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
