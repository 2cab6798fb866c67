//! The scenario of a machine with what its healthy recordings tell.

use super::PathEstimate;
use super::sidebands::{SAME, SidebandCause, ripple_order};
use crate::operation::MOST_RIPPLE;
use crate::scenario::{MOST_WOBBLE, Scenario};
use crate::sensor::Sensor;
use crate::signal::GearTrain;

/// (-) Largest share of a tolerance that a run-out may have.
const WHOLE_TOLERANCE: f64 = 1.0;

impl PathEstimate {
    /// Puts into a scenario what was estimated from the recordings: the path of its first sensor, the wander of the speed, the random forces, and
    /// what makes sidebands.
    ///
    /// A torque ripple, or run-out and slope wobble of a shaft's wheels, is multiplied by the factor of its sidebands where 1 is not within the
    /// factor's interval; what draws of the wheels explain stays as stated. Ripples and wobbles are at most what a scenario allows, and
    /// a run-out is at most its tolerance.
    ///
    /// # Arguments
    /// * `scenario` - the one that the path was estimated for
    /// * `train` - its shafts and wheels
    pub fn adapted(&self, scenario: &Scenario, train: &GearTrain) -> Scenario {
        // A sensor that the scenario need not state has a path, too.
        let mut adapted = scenario.clone().with_sensors(scenario.all_sensors());
        if adapted.sensors.is_empty() {
            adapted.sensors.push(Sensor::default());
        }
        if let Some(sensor) = adapted.sensors.first_mut() {
            sensor.frequency_response = Some(self.frequency_response());
        }
        let drive = &self.drive;
        if let Some([wander, ..]) = drive.speed_wander_percent {
            adapted.operation.speed_wander_percent = wander;
        }
        if let Some([factor, ..]) = drive.random_force_factor {
            adapted.meshes.iter_mut().for_each(|mesh| mesh.random_force *= factor);
        }
        for of in &drive.sidebands {
            let [factor, low, high] = of.factor;
            let Some(shaft) = train.shafts.iter().position(|shaft| shaft.name == of.shaft) else { continue };
            if low <= 1.0 && 1.0 <= high {
                continue;
            }
            match of.cause {
                SidebandCause::Torque => {
                    let order = of.order as f64 * train.shafts[shaft].speed_ratio.value();
                    for ripple in &mut adapted.operation.torque_ripple {
                        if (ripple_order(ripple, scenario, train) - order).abs() < SAME {
                            ripple.amplitude *= factor;
                        }
                    }
                }
                SidebandCause::Wheels => {
                    let on_shaft = |wheel: usize| train.wheels[wheel].shaft == shaft;
                    for (_, wheel) in adapted.wheels.iter_mut().enumerate().filter(|(at, _)| on_shaft(*at)) {
                        wheel.run_out_share = (wheel.run_out_share * factor).min(WHOLE_TOLERANCE);
                        wheel.slope_wobble = (wheel.slope_wobble * factor).min(MOST_WOBBLE);
                    }
                }
                SidebandCause::Nothing => {}
            }
        }
        let ripples = &mut adapted.operation.torque_ripple;
        let sum: f64 = ripples.iter().map(|ripple| ripple.amplitude).sum();
        ripples.iter_mut().for_each(|ripple| ripple.amplitude *= (MOST_RIPPLE / sum).min(1.0));
        adapted
    }
}
