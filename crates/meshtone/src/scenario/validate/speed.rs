//! Limits of the speed of teeth.

use std::f64::consts::PI;

use super::super::{Operation, ScenarioWarning, WarningKind};
use crate::keys::{Check, refuse};

/// (m/s) Fastest pitch line that is simulated: turbo gears, which are helical, run at up to some 200 m/s.
const FASTEST_M_PER_S: f64 = 200.0;
/// (m/s) Fastest pitch line without a warning: beyond, gears are made helical.
const USUAL_M_PER_S: f64 = 60.0;
/// (-) How far a profile's mean may be from the nominal speed without a warning.
const TOLERATED_MEAN: f64 = 0.2;

/// The speed of the shaft that the motor drives.
pub(super) struct DrivenSpeed<'a> {
    pub(super) operation: &'a Operation,
    /// Key of the nominal speed.
    pub(super) key: &'static str,
    /// (mm) Largest π m z of a wheel on that shaft; of a wheel on another, in a revolution of that shaft.
    pub(super) pitch_line_mm: f64,
}

impl DrivenSpeed<'_> {
    /// Refuses a speed that no gear survives: one in revolutions per minute, most probably.
    pub(super) fn check(&self) -> Check {
        let (key, speed_hz) = self.fastest();
        let speed_m_per_s = self.pitch_line_m_per_s(speed_hz);
        if speed_m_per_s <= FASTEST_M_PER_S {
            return Ok(());
        }
        let problem = format!(
            "the teeth would run at {speed_m_per_s:.0} m/s on the pitch line; must be at most {FASTEST_M_PER_S:.0} m/s, which no gear \
             exceeds"
        );
        let fastest_hz = speed_hz * FASTEST_M_PER_S / speed_m_per_s;
        let help = if speed_hz / 60.0 < fastest_hz {
            format!(
                "speeds are in revolutions per second: if {speed_hz:?} is per minute, write {:.4}",
                speed_hz / 60.0
            )
        } else {
            format!(
                "speeds are in revolutions per second, and these wheels turn at most {fastest_hz:.1} times"
            )
        };
        Err(refuse(&key, speed_hz, problem).with_help(help))
    }

    /// Speeds that may be a typing error.
    pub(super) fn warnings(&self) -> Vec<ScenarioWarning> {
        [self.unusual(), self.far_from_nominal()].into_iter().flatten().collect()
    }

    fn unusual(&self) -> Option<ScenarioWarning> {
        let (key, speed_hz) = self.fastest();
        let speed_m_per_s = self.pitch_line_m_per_s(speed_hz);
        (speed_m_per_s > USUAL_M_PER_S).then(|| {
            let message = format!(
                "the teeth run at {speed_m_per_s:.0} m/s on the pitch line, and few gears run faster than {USUAL_M_PER_S:.0} m/s; \
                 speeds are in revolutions per second"
            );
            ScenarioWarning::new(WarningKind::FastTeeth, key, message)
        })
    }

    /// A profile that never comes near the nominal speed, which the sampling rate is chosen for.
    fn far_from_nominal(&self) -> Option<ScenarioWarning> {
        let profile = self.operation.speed_profile_hz.as_ref()?;
        let (first_s, last_s) = (*profile.time_s.first()?, *profile.time_s.last()?);
        let pieces = profile.time_s.windows(2).zip(profile.value.windows(2));
        let turned: f64 = pieces.map(|(time, value)| (time[1] - time[0]) * (value[0] + value[1]) / 2.0).sum();
        let (mean_hz, nominal_hz) = (turned / (last_s - first_s), self.operation.pinion_speed_hz);
        // A run-up passes the nominal speed, whatever its mean.
        let passes = profile.value.iter().any(|&value| value <= nominal_hz)
            && profile.value.iter().any(|&value| value >= nominal_hz);
        (!passes && (mean_hz / nominal_hz - 1.0).abs() > TOLERATED_MEAN).then(|| {
            let message = format!(
                "is {mean_hz:.4} Hz on average, while {}, which the sampling rate is chosen for, is {nominal_hz:?} Hz; set that to about \
                 the mean",
                self.key
            );
            ScenarioWarning::new(WarningKind::SpeedProfileOff, "operation.speed_profile_hz", message)
        })
    }

    /// The key of the fastest speed, and the speed.
    pub(super) fn fastest(&self) -> (String, f64) {
        let nominal = (self.key.to_owned(), self.operation.pinion_speed_hz);
        let values = self.operation.speed_profile_hz.iter().flat_map(|profile| &profile.value).enumerate();
        values.fold(nominal, |(key, fastest), (index, &value)| {
            if value > fastest {
                (format!("operation.speed_profile_hz.value[{index}]"), value)
            } else {
                (key, fastest)
            }
        })
    }

    fn pitch_line_m_per_s(&self, speed_hz: f64) -> f64 {
        self.pitch_line_mm * 1e-3 * speed_hz
    }
}

/// (mm) π m z.
pub(super) fn pitch_line_mm(module_mm: f64, teeth: u32) -> f64 {
    PI * module_mm * f64::from(teeth)
}
