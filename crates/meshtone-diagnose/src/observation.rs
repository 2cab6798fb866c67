//! Features of the wheels in a recording or a simulation.

use meshtone::signal::{AngleZero, BearingDefects, ForeignTones, SignalError, check_channel};
use meshtone_fourier::{Complex64, real_spectrum};
use meshtone_learn::{MESH_ORDERS, PASSED, WheelLines, separation};

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
    /// Returns the observation with a further mismatch of the recording.
    ///
    /// # Arguments
    /// * `against` - in words; said before what is known already
    pub fn with_mismatch(mut self, against: impl ToString) -> Self {
        let also = self.mismatch.take().map_or_else(String::new, |also| format!("; {also}"));
        self.mismatch = Some(format!("{}{also}", against.to_string()));
        self
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

/// A question: recordings of a rig in one state, and of the same rig when it was healthy.
#[derive(Debug, Clone, Copy)]
pub struct Question<'a> {
    /// Recordings of the state in question, at least one.
    pub now: &'a [Observation],
    /// Recordings of the same rig when it was healthy; may be empty.
    pub healthy: &'a [Observation],
}

impl Question<'_> {
    /// All recordings, those in question first.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Observation> {
        self.now.iter().chain(self.healthy)
    }

    /// Returns whether something speaks against what is stated of a recording.
    pub(crate) fn is_misstated(&self) -> bool {
        self.all().any(|asked| asked.mismatch.is_some())
    }
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
