//! Rules that concern several keys of `[operation]`.

use super::parameters::MOST_RIPPLE;
use super::{Operation, Profile};
use crate::error::ScenarioError;
use crate::keys::{Check, refuse, require};

impl Operation {
    /// Speed and torque with what varies them; every key alone is in its range.
    pub(crate) fn check(&self) -> Check {
        let (speeds, torques) = (self.speed_profile_hz.as_ref(), self.torque_profile_nm.as_ref());
        values(speeds, "operation.speed_profile_hz", |speed| speed > 0.0, "must be more than 0 rev/s")?;
        // Faults and deviations are on the flanks that carry, and these are those of the nominal torque.
        let (sign, rule) = if self.overruns() {
            (-1.0, "must be 0 N m or less, as operation.brake_torque_nm is")
        } else {
            (1.0, "must be 0 N m or more, as operation.brake_torque_nm is")
        };
        values(torques, "operation.torque_profile_nm", |torque| sign * torque >= 0.0, rule)?;
        // The wander may reach five standard deviations.
        let slowest = smallest(self.pinion_speed_hz, speeds) * (1.0 - 5e-2 * self.speed_wander_percent);
        fluctuation("operation.speed_fluctuation_hz", self.speed_fluctuation_hz, slowest, "speed", "Hz")?;
        let lightest = smallest(self.brake_torque_nm, torques);
        fluctuation(
            "operation.torque_fluctuation_nm",
            self.torque_fluctuation_nm,
            lightest,
            "torque",
            "N m",
        )?;
        let amplitudes: f64 = self.torque_ripple.iter().map(|ripple| ripple.amplitude).sum();
        // The sum of 0.8 and 0.4 is a little more than 1.2.
        let problem = "amplitudes add up to more than 1.2; must be less: there would be contact loss for most of the time";
        require("operation.torque_ripple", amplitudes, amplitudes <= MOST_RIPPLE * (1.0 + 1e-9), problem)
    }
}

fn smallest(nominal: f64, profile: Option<&Profile>) -> f64 {
    let sizes =
        |profile: &Profile| profile.value.iter().map(|value| value.abs()).fold(f64::INFINITY, f64::min);
    profile.map_or(nominal.abs(), sizes)
}

fn fluctuation(key: &str, value: f64, nominal: f64, quantity: &str, unit: &str) -> Check {
    let problem = format!("must be less than the {quantity} that it varies, {nominal:?} {unit}");
    require(key, value, value == 0.0 || value < nominal, problem)
}

fn values(profile: Option<&Profile>, key: &str, allowed: impl Fn(f64) -> bool, rule: &str) -> Check {
    let mut values = profile.into_iter().flat_map(|profile| &profile.value).enumerate();
    values.try_for_each(|(index, &value)| {
        require(&format!("{key}.value[{index}]"), value, allowed(value), rule)
    })
}

impl Profile {
    /// Points whose times increase.
    pub(super) fn check_points(&self, key: &str) -> Check {
        let (times, values) = (self.time_s.len(), self.value.len());
        if times != values {
            let problem = format!("has {times} times and {values} values; must have as many values as times");
            return Err(ScenarioError::new(key, "", problem));
        }
        if times < 2 {
            let problem = format!("has {times} points; must have at least 2");
            return Err(ScenarioError::new(key, "", problem)
                .with_help("for a constant, leave the profile out: the nominal value is then taken"));
        }
        for (name, numbers) in [("time_s", &self.time_s), ("value", &self.value)] {
            if let Some((index, &number)) = numbers.iter().enumerate().find(|(_, number)| !number.is_finite())
            {
                return Err(refuse(&format!("{key}.{name}[{index}]"), number, "must be a finite number"));
            }
        }
        if self.time_s[0] < 0.0 {
            return Err(refuse(
                &format!("{key}.time_s[0]"),
                self.time_s[0],
                "must be 0 s or more: the kept signal starts at 0 s, and the motion settles before it",
            ));
        }
        for (index, pair) in self.time_s.windows(2).enumerate() {
            if pair[1] <= pair[0] {
                let problem =
                    format!("must be more than the time before it, {:?} s: times increase", pair[0]);
                return Err(refuse(&format!("{key}.time_s[{}]", index + 1), pair[1], problem));
            }
        }
        Ok(())
    }
}
