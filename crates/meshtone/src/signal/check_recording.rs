//! All that may be doubtful about a recording and what is stated about it.

use super::{
    AngularSignal, ForeignSearch, ForeignTones, GearTrain, ShaftPhase, SignalWarning, StatedFacts,
    StatedTurning, find_train_mismatch, foreign_tones,
};

/// Looks for a sign that a recording does not fit the stated facts, and for tones that belong to neither shaft.
///
/// Where a stated fact does not fit, the lines at wrong orders follow from it, and only that is reported. Tones are looked for where the mate's
/// teeth are stated, since they may be its own orders otherwise, and where the recording is not [a run-up](ShaftPhase::is_run_up). That nothing repeats with the shaft is
/// among the warnings of a [`Record`](super::Record).
///
/// # Arguments
/// * `angular` - the recording over the angle of the shaft, as it is stated
/// * `stated` - the facts that the user states
/// * `phase` - of the shaft
/// * `sampling_rate_hz` - (S/s) of the recording
///
/// ```
/// use meshtone::signal::{AngularSettings, ShaftPhase, SignalWarning, StatedFacts, StatedTurning, angular_resample, check_recording};
///
/// let wave = |hz: f64, i: usize| (std::f64::consts::TAU * hz * i as f64 / 1e4).cos();
/// let noise = |i: usize| 4e-5 * (i * i % 10_007) as f64;
/// let signal: Vec<f64> = (0..20_000).map(|i| wave(380.0, i) + wave(1313.0, i) + noise(i)).collect();
/// let phase = ShaftPhase::constant(20.0, 1e4, signal.len())?;
/// let angular = angular_resample(&signal, &phase, &AngularSettings::default())?;
/// let stated = StatedFacts { teeth: 19, mate_teeth: Some(38), turning: StatedTurning::Other };
/// let warnings = check_recording(&angular, &stated, &phase, 1e4);
/// assert!(matches!(&warnings[..], [SignalWarning::ForeignTones(tones)] if (tones.strongest[0].frequency_hz - 1313.0).abs() < 0.1));
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn check_recording(
    angular: &AngularSignal,
    stated: &StatedFacts,
    phase: &ShaftPhase,
    sampling_rate_hz: f64,
) -> Vec<SignalWarning> {
    let wheel = ("wheel", stated.teeth);
    let train = match stated.mate_teeth {
        None => GearTrain::of_wheels([wheel]),
        Some(teeth) => GearTrain::of_wheels([wheel, ("mate", teeth)]),
    };
    let checked = RecordingCheck::new(angular, &train, 0, stated.turning, phase, sampling_rate_hz);
    checked.warnings
}

/// What a check of a recording against a train finds.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct RecordingCheck {
    /// What is doubtful.
    pub warnings: Vec<SignalWarning>,
    /// Tones that belong to no shaft and no mesh, where they were looked for.
    pub foreign: Option<ForeignSearch>,
}

impl RecordingCheck {
    /// Checks a recording against the tooth counts of a train, and how one of its shafts turns.
    ///
    /// # Arguments
    /// * `angular` - the recording over the angle of a shaft
    /// * `train` - the tooth counts
    /// * `shaft` - number of the shaft
    /// * `turning` - the source from which its angle is known
    /// * `phase` - of the shaft
    /// * `sampling_rate_hz` - (S/s) of the recording
    pub(super) fn new(
        angular: &AngularSignal,
        train: &GearTrain,
        shaft: usize,
        turning: StatedTurning,
        phase: &ShaftPhase,
        sampling_rate_hz: f64,
    ) -> Self {
        if let Some(mismatch) = find_train_mismatch(angular, train, shaft, turning) {
            return Self { warnings: vec![SignalWarning::DoesNotFit(mismatch)], foreign: None };
        }
        // Over a run-up, what rings at a resonance looks like a foreign tone, and a tone of a constant frequency has no order.
        if train.meshes.is_empty() || phase.is_run_up(sampling_rate_hz) {
            return Self::default();
        }
        let is_followed = matches!(turning, StatedTurning::MeshTone { .. });
        let followed = train.teeth_on(shaft).min().filter(|_| is_followed).map(f64::from);
        let speed_hz = phase.mean_speed_hz(sampling_rate_hz);
        let mut foreign = foreign_tones(angular, train, shaft, speed_hz, followed);
        let tones = foreign.as_ref().and_then(|found| ForeignTones::of(&found.tones));
        let counting = tones.filter(ForeignTones::count);
        if counting.is_none() {
            // Weak ones may be of hunting-tooth orders.
            foreign.iter_mut().filter(|found| found.needed_s.is_some()).for_each(|found| found.tones.clear());
        }
        Self { warnings: counting.map(SignalWarning::ForeignTones).into_iter().collect(), foreign }
    }
}
