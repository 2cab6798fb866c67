//! Limits of the speed of teeth.

use std::f64::consts::PI;

use super::super::{Scenario, ScenarioWarning, WarningKind};
use crate::keys::{Check, refuse};

/// (m/s) Fastest pitch line that is simulated: turbo gears, which are helical, run at up to some 200 m/s.
const FASTEST_M_PER_S: f64 = 200.0;
/// (m/s) Fastest pitch line without a warning: beyond, gears are made helical.
const USUAL_M_PER_S: f64 = 60.0;
/// (-) How far a profile's mean may be from the nominal speed without a warning.
const TOLERATED_MEAN: f64 = 0.2;

/// A speed that no gear survives: one in revolutions per minute, most probably.
pub(super) fn check(scenario: &Scenario) -> Check {
    let (key, speed_hz) = fastest(scenario);
    let speed_m_per_s = pitch_line_m_per_s(scenario, speed_hz);
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
        format!("speeds are in revolutions per second, and these wheels turn at most {fastest_hz:.1} times")
    };
    Err(refuse(&key, speed_hz, problem).with_help(help))
}

/// Speeds that may be a typing error.
pub(super) fn warnings(scenario: &Scenario) -> Vec<ScenarioWarning> {
    [unusual(scenario), far_from_nominal(scenario)].into_iter().flatten().collect()
}

fn unusual(scenario: &Scenario) -> Option<ScenarioWarning> {
    let (key, speed_hz) = fastest(scenario);
    let speed_m_per_s = pitch_line_m_per_s(scenario, speed_hz);
    (speed_m_per_s > USUAL_M_PER_S).then(|| {
        let message = format!(
            "the teeth run at {speed_m_per_s:.0} m/s on the pitch line, and few spur gears run faster than {USUAL_M_PER_S:.0} m/s; \
             speeds are in revolutions per second"
        );
        ScenarioWarning::new(WarningKind::FastTeeth, key, message)
    })
}

/// A profile that never comes near the nominal speed, which the sampling rate is chosen for.
fn far_from_nominal(scenario: &Scenario) -> Option<ScenarioWarning> {
    let operation = &scenario.operation;
    let profile = operation.speed_profile_hz.as_ref()?;
    let (first_s, last_s) = (*profile.time_s.first()?, *profile.time_s.last()?);
    let pieces = profile.time_s.windows(2).zip(profile.value.windows(2));
    let turned: f64 = pieces.map(|(time, value)| (time[1] - time[0]) * (value[0] + value[1]) / 2.0).sum();
    let (mean_hz, nominal_hz) = (turned / (last_s - first_s), operation.pinion_speed_hz);
    // A run-up passes the nominal speed, whatever its mean.
    let passes = profile.value.iter().any(|&value| value <= nominal_hz)
        && profile.value.iter().any(|&value| value >= nominal_hz);
    (!passes && (mean_hz / nominal_hz - 1.0).abs() > TOLERATED_MEAN).then(|| {
        let message = format!(
            "is {mean_hz:.4} Hz on average, while operation.pinion_speed_hz, which the sampling rate is chosen for, is \
             {nominal_hz:?} Hz; set that to about the mean"
        );
        ScenarioWarning::new(WarningKind::SpeedProfileOff, "operation.speed_profile_hz", message)
    })
}

/// The key of the fastest speed, and the speed.
fn fastest(scenario: &Scenario) -> (String, f64) {
    let operation = &scenario.operation;
    let nominal = ("operation.pinion_speed_hz".to_owned(), operation.pinion_speed_hz);
    let values = operation.speed_profile_hz.iter().flat_map(|profile| &profile.value).enumerate();
    values.fold(nominal, |(key, fastest), (index, &value)| {
        if value > fastest {
            (format!("operation.speed_profile_hz.value[{index}]"), value)
        } else {
            (key, fastest)
        }
    })
}

fn pitch_line_m_per_s(scenario: &Scenario, pinion_speed_hz: f64) -> f64 {
    let gears = &scenario.gears;
    PI * gears.module_mm * 1e-3 * f64::from(gears.pinion_teeth) * pinion_speed_hz
}
