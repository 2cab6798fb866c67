//! The answer of a diagnosis.

use meshtone::signal::AngleZero;
use meshtone::wheel::WheelName;

use crate::bearings::BearingAnswer;
use crate::diagnose::OUTSIDE;
use meshtone_learn::{Interval, quantiles};

use crate::mounting::CommonChange;
use crate::observation::SignalKind;
use crate::rule::Rule;
use crate::warnings::DiagnosisWarning;

/// A size of a damage.
#[derive(Debug, Clone, PartialEq)]
pub struct SizeAnswer {
    /// Key of the scenario file, with the unit at its end.
    pub key: &'static str,
    /// Interval of its likely values.
    pub interval: Interval,
}

/// Place of a damage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaceAnswer {
    /// The damaged wheel, by its place in [`Answer::wheels`].
    pub wheel: usize,
    /// (-) Probability that it is this one rather than another.
    pub wheel_probability: f64,
    /// Whether such damage is on one tooth.
    pub is_on_one_tooth: bool,
    /// The damaged tooth, its probability given the kind and the wheel; none of damage to several teeth, and where
    /// [`Answer::counted_from`] is none.
    pub tooth: Option<ToothAnswer>,
}

/// The tooth that a damage is on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothAnswer {
    /// Its number, counted from 1.
    pub number: u32,
    /// (°) Angle of its wheel at which it enters contact.
    pub angle_deg: f64,
    /// (-) Probability that the tooth is this one.
    pub probability: f64,
}

/// Answer about a damage, whatever its kind: over all kinds, each as probable as it is said to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnyDamage {
    /// (-) How severe it is, from 0 to 1.
    pub severity: Interval,
    /// The damaged wheel, by its place in [`Answer::wheels`].
    pub wheel: usize,
    /// (-) Probability that it is this one rather than another.
    pub wheel_probability: f64,
    /// (-) Probability that it is of a kind that is on one tooth.
    pub one_tooth_probability: f64,
    /// The damaged tooth, as [`PlaceAnswer::tooth`], its probability given the wheel.
    pub tooth: Option<ToothAnswer>,
}

/// Answer about one kind of damage.
#[derive(Debug, Clone, PartialEq)]
pub struct KindAnswer {
    /// `healthy`, the name of a kind of damage, or [`SEVERAL`].
    pub label: &'static str,
    /// (-) Its probability.
    pub probability: f64,
    /// (-) How severe it is, if it is of this kind, from 0 to 1; none of a healthy pair.
    pub severity: Option<Interval>,
    /// (-) Draws of that severity, with their weights.
    pub(crate) severity_draws: Vec<(f64, f64)>,
    /// Its sizes, likewise; none where they are lists.
    pub sizes: Vec<SizeAnswer>,
    /// Its place, likewise.
    pub place: Option<PlaceAnswer>,
}

impl KindAnswer {
    /// (-) Draws of its severity without weights, for a histogram.
    pub fn severity_histogram(&self) -> Vec<f64> {
        const COUNT: usize = 400;
        let parts: [f64; COUNT] = std::array::from_fn(|at| (at as f64 + 0.5) / COUNT as f64);
        quantiles(self.severity_draws.clone(), parts).to_vec()
    }
}

/// A simulation that resembles the recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// `healthy`, or the name of a kind of damage.
    pub label: &'static str,
    /// The damaged wheel, by its place in [`Answer::wheels`]; none of a healthy rig.
    pub wheel: Option<usize>,
    /// (-) How severe it is; 0 of a healthy pair.
    pub severity: f64,
    /// (g) The shown wheel's difference signal over a revolution, turned so that the burst is where the recording has it.
    pub difference_g: Vec<f64>,
}

/// Answer of a diagnosis.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Kind of the signal in question.
    pub signal: SignalKind,
    /// Whether it was compared with a healthy recording of the same rig.
    pub has_healthy: bool,
    /// Recordings that were asked about.
    pub recordings: usize,
    /// Names of the rig's wheels.
    pub wheels: Vec<String>,
    /// (-) Probability that each of them is the damaged one, given that one is.
    pub wheel_probabilities: Vec<f64>,
    /// Meaning of tooth 1 of each wheel; none where teeth cannot be counted: after a mesh tone, or in several
    /// recordings without a mark in common.
    pub counted_from: Vec<Option<AngleZero>>,
    /// The bearings, race by race: those with a defect first, then the others, the most certain lines first. Empty of a rig without ball or roller bearings.
    pub bearings: Vec<BearingAnswer>,
    /// Summary: a sentence about bearings where one is damaged, and one about the teeth.
    pub summary: String,
    /// Answer about a damage, whatever its kind, given that there is one.
    pub any_damage: Option<AnyDamage>,
    /// Simulations of the reference set.
    pub simulated_records: usize,
    /// Simulations of it that are of the asked kind, which it was learnt from.
    pub reference_records: usize,
    /// Simulations of a refined round, of the likeliest damage within its likely severities; 0 where there was none.
    pub refined_records: usize,
    /// The kinds, the most probable first; their probabilities sum to 1.
    pub kinds: Vec<KindAnswer>,
    /// (-) p-value: the part of the simulated records that are as far as the recording, or farther, from the others.
    pub outside_model: f64,
    /// p-value of the healthy recording among healthy simulations alone, with the levels and shapes of rig and path; none where there is no healthy recording.
    pub healthy_outside_model: Option<f64>,
    /// What changed alike in all wheels since the healthy recording; none without one.
    pub common_change: Option<CommonChange>,
    /// Whether something speaks against what is stated of the recordings, as the warnings say.
    pub is_misstated: bool,
    /// What a rule says, whatever the simulations do.
    pub rule: Rule,
    /// Warnings.
    pub warnings: Vec<DiagnosisWarning>,
    /// The wheel that the signals below are of, by its place: the likeliest damaged one.
    pub shown_wheel: usize,
    /// (g) The recording's difference signal over a revolution of that wheel, at equal angles.
    pub difference_g: Vec<f64>,
    /// (g) Between which values nine in ten of the simulated signals that resemble it are, angle by angle.
    pub band_g: [Vec<f64>; 2],
    /// The simulations that resemble it most, the likeliest kinds first.
    pub explanations: Vec<Explanation>,
}

impl Answer {
    /// (-) Probability that something is damaged.
    pub fn damaged(&self) -> f64 {
        let healthy = self.kinds.iter().find(|kind| kind.label == HEALTHY);
        1.0 - healthy.map_or(0.0, |kind| kind.probability)
    }

    /// Returns whether nothing can be said: the recording is unlike what was simulated, the sensor was mounted anew since the healthy one, or a recording is not
    /// what is stated.
    pub fn is_outside(&self) -> bool {
        self.is_recording_outside() || self.is_remounted() || self.is_misstated
    }

    /// Returns whether the recording, beside a healthy one what changed since, is unlike what was simulated: of two tests each has half of the level of one.
    pub(crate) fn is_recording_outside(&self) -> bool {
        self.outside_model < if self.common_change.is_some() { 0.5 * OUTSIDE } else { OUTSIDE }
    }

    /// Returns whether more changed alike in all wheels than in nearly all simulations. What is stated wrongly of a recording is the likelier reason.
    pub fn is_remounted(&self) -> bool {
        !self.is_misstated && self.common_change.is_some_and(|change| change.p < 0.5 * OUTSIDE)
    }

    /// A wheel's name after `the`: gear, or wheel z3 of a gearbox.
    ///
    /// # Arguments
    /// * `wheel` - its place in [`Self::wheels`]
    pub fn wheel_in_words(&self, wheel: usize) -> String {
        wheel_in_words(&self.wheels[wheel])
    }

    /// Returns whether the lines of a bearing's race are detected, whether or not they are of a defect.
    pub fn has_bearing_lines(&self) -> bool {
        self.bearings.iter().any(|of| of.test.is_detected())
    }

    /// The likeliest damage.
    pub fn likeliest_damage(&self) -> Option<&KindAnswer> {
        self.kinds.iter().find(|kind| kind.label != HEALTHY)
    }
}

/// A p-value for reading: `p = 0.748`, or that it is less than the simulations resolve.
///
/// # Arguments
/// * `p` - (-) of [`Answer::outside_model`] or [`Answer::healthy_outside_model`]
///
/// # Examples
/// ```
/// assert_eq!(meshtone_diagnose::p_in_words(0.7481), "p = 0.748");
/// assert_eq!(meshtone_diagnose::p_in_words(0.0002), "p < 0.001");
/// ```
pub fn p_in_words(p: f64) -> String {
    if p < 0.001 { "p < 0.001".to_owned() } else { format!("p = {p:.3}") }
}

/// A wheel's name after `the`: gear, or wheel z3 of a gearbox.
pub(crate) fn wheel_in_words(name: &str) -> String {
    let is_of_pair = WheelName::BOTH.iter().any(|of| of.name() == name);
    if is_of_pair { name.to_owned() } else { format!("wheel {name}") }
}

/// The label of a rig without damage.
pub const HEALTHY: &str = "healthy";
/// The label of two damages of the rig at once.
pub const SEVERAL: &str = "several-damages";
