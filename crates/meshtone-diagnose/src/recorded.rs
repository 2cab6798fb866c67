//! Observation of recordings by the angle of a shaft.

use meshtone::signal::{
    AngleZero, AngularSettings, ChainSettings, Mismatch, ShaftPhase, SignalError, SimulatedShafts,
    StatedFacts, StatedTurning, angular_resample, find_mismatch,
};
use meshtone::wheel::WheelName;

use crate::observation::{Observation, other_teeth};

impl Observation {
    /// Observes what was simulated.
    ///
    /// # Arguments
    /// * `signal_g` - (g) the channel
    /// * `shafts` - how the shafts turned
    ///
    /// # Errors
    /// Those of [`Observation::of_recording`].
    pub fn of_simulated(signal_g: &[f64], shafts: &SimulatedShafts) -> Result<Self, SignalError> {
        let over = |shaft| shafts.angular(signal_g, shaft, &ChainSettings::default());
        let (pinion, gear) = (over(WheelName::Pinion)?, over(WheelName::Gear)?);
        let teeth = WheelName::BOTH.map(|shaft| shafts.teeth(shaft));
        let observed = Self::of_recording(&pinion, &gear, teeth, shafts.mean_speed_hz(WheelName::Pinion))?;
        Ok(observed.with_zero(vec![AngleZero::Simulated; 2]))
    }

    /// Observes what was measured, with what speaks against the statements about it.
    ///
    /// # Arguments
    /// * `signal_g`, `sampling_rate_hz` - (g, S/s) the channel
    /// * `shaft` - the phase of the shaft of one of the wheels
    /// * `stated` - teeth of that wheel and of its mate, and how its shaft turns
    /// * `teeth` - of the pinion and of the gear
    ///
    /// # Errors
    /// Those of [`angular_resample`] and of [`Observation::of_recording`].
    pub fn of_measured(
        signal_g: &[f64],
        sampling_rate_hz: f64,
        shaft: &ShaftPhase,
        stated: &StatedFacts,
        teeth: [u32; 2],
    ) -> Result<Self, SignalError> {
        let over = |phase: &ShaftPhase| angular_resample(signal_g, phase, &AngularSettings::default());
        let is_pinion = stated.teeth == teeth[0];
        let of_mate = shaft.of_mate(stated.teeth, teeth[usize::from(is_pinion)])?;
        let (own, mate) = (over(shaft)?, over(&of_mate)?);
        let against = match find_mismatch(&own, stated) {
            None => other_tone(signal_g, sampling_rate_hz, shaft, stated)?,
            against => against,
        };
        let speed_hz = shaft.mean_speed_hz(sampling_rate_hz);
        let ([pinion, gear], zero, pinion_hz) = if is_pinion {
            ([own, mate], vec![shaft.zero, of_mate.zero], speed_hz)
        } else {
            let ratio = f64::from(teeth[1]) / f64::from(teeth[0]);
            ([mate, own], vec![of_mate.zero, shaft.zero], speed_hz * ratio)
        };
        let observed = Self::of_recording(&pinion, &gear, teeth, pinion_hz)?.with_zero(zero);
        Ok(match against {
            Some(against) => observed.with_mismatch(against),
            None => observed,
        })
    }
}

/// Looks for tooth counts that fit a recording better than those that are stated, where its phase is from a doubtful mesh tone: another
/// tone than the mesh's may have been followed.
///
/// # Arguments
/// * `signal`, `sampling_rate_hz` - the recording
/// * `shaft` - its phase
/// * `stated` - teeth of the wheel on that shaft and of its mate, and how it turns
///
/// # Errors
/// Those of [`angular_resample`].
pub fn other_tone(
    signal: &[f64],
    sampling_rate_hz: f64,
    shaft: &ShaftPhase,
    stated: &StatedFacts,
) -> Result<Option<Mismatch>, SignalError> {
    match (stated.turning, stated.mate_teeth) {
        (StatedTurning::MeshTone { nominal_hz }, Some(mate_teeth)) if !shaft.warnings.is_empty() => {
            other_teeth(signal, sampling_rate_hz, [stated.teeth, mate_teeth], nominal_hz)
        }
        _ => Ok(None),
    }
}
