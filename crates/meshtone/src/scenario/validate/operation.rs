//! Rules for `[operation]`.

use super::super::{Convention, Operation, Profile, Scenario, ScenarioError};
use super::rules::{Check, finite, not_negative, positive_up_to, refuse, require};

const FASTEST_HZ: f64 = 1e5;
const LARGEST_TORQUE_NM: f64 = 1e9;

pub(super) fn check(operation: &Operation) -> Check {
    let (speed, torque) = (operation.pinion_speed_hz, operation.brake_torque_nm);
    positive_up_to("operation.pinion_speed_hz", speed, FASTEST_HZ, "rev/s")?;
    not_negative("operation.brake_torque_nm", torque, "N m")?;
    require(
        "operation.brake_torque_nm",
        torque,
        torque <= LARGEST_TORQUE_NM,
        format!("must be at most {LARGEST_TORQUE_NM:e} N m"),
    )?;
    if let Some(profile) = &operation.speed_profile_hz {
        check_profile(
            "operation.speed_profile_hz",
            profile,
            |speed| speed > 0.0,
            "must be more than 0 rev/s",
        )?;
    }
    if let Some(profile) = &operation.torque_profile_nm {
        check_profile(
            "operation.torque_profile_nm",
            profile,
            |torque| torque >= 0.0,
            "must be 0 N m or more",
        )?;
    }
    let slowest = smallest(speed, operation.speed_profile_hz.as_ref());
    fluctuation("operation.speed_fluctuation_hz", operation.speed_fluctuation_hz, slowest, "speed", "Hz")?;
    let lightest = smallest(torque, operation.torque_profile_nm.as_ref());
    fluctuation("operation.torque_fluctuation_nm", operation.torque_fluctuation_nm, lightest, "torque", "N m")
}

/// A speed profile sets the duration, which must outlast what is discarded.
pub(super) fn check_duration(scenario: &Scenario) -> Check {
    let operation = &scenario.operation;
    if scenario.convention == Convention::Published {
        // Convention: the published code ignores the profile.
        return Ok(());
    }
    let Some(end) = operation.speed_profile_hz.as_ref().and_then(|profile| profile.time_s.last()) else {
        return Ok(());
    };
    let revolutions = f64::from(crate::sampling::nominal_revolutions(scenario.gears.gear_teeth));
    let settling = scenario.solver.settle_fraction * revolutions / operation.pinion_speed_hz;
    let problem =
        format!("the profile ends at {end:?} s, within the first {settling:.4} s, which are discarded");
    require("operation.speed_profile_hz", *end, *end > settling, problem)
        .map_err(|error| error.with_help("lengthen the profile, or lower solver.settle_fraction"))
}

fn smallest(nominal: f64, profile: Option<&Profile>) -> f64 {
    profile.map_or(nominal, |profile| profile.value.iter().copied().fold(f64::INFINITY, f64::min))
}

fn fluctuation(key: &str, value: f64, nominal: f64, quantity: &str, unit: &str) -> Check {
    not_negative(key, value, unit)?;
    let problem = format!("must be less than the {quantity} that it varies, {nominal:?} {unit}");
    require(key, value, value == 0.0 || value < nominal, problem)
}

fn check_profile(key: &str, profile: &Profile, allowed: impl Fn(f64) -> bool, rule: &str) -> Check {
    let (times, values) = (profile.time_s.len(), profile.value.len());
    if times != values {
        return Err(ScenarioError::new(
            key,
            "",
            format!("has {times} times and {values} values; must have as many values as times"),
        ));
    }
    if times < 2 {
        let problem = format!("has {times} points; must have at least 2");
        return Err(ScenarioError::new(key, "", problem)
            .with_help("for a constant, leave the profile out: the nominal value is then taken"));
    }
    for (index, &time) in profile.time_s.iter().enumerate() {
        finite(&format!("{key}.time_s[{index}]"), time)?;
    }
    for (index, pair) in profile.time_s.windows(2).enumerate() {
        if pair[1] <= pair[0] {
            let problem = format!("must be more than the time before it, {:?} s: times increase", pair[0]);
            return Err(refuse(&format!("{key}.time_s[{}]", index + 1), pair[1], problem));
        }
    }
    for (index, &value) in profile.value.iter().enumerate() {
        require(&format!("{key}.value[{index}]"), value, allowed(value), rule)?;
    }
    Ok(())
}
