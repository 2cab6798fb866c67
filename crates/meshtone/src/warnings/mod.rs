//! What is doubtful about a simulation: before the time loop, and by its signals.

mod step_error;

use std::f64::consts::TAU;

use crate::error::{ScenarioError, ScenarioWarning};
use crate::machine::coordinates::{X_GEAR, X_PINION};
use crate::machine::{DecayingMode, Shaft, Structure, WheelBody};
use crate::scenario::{MemoryLimit, Scenario};
use crate::sensor::Channels;
use crate::simulate::{Simulation, Stages, stages};
use step_error::{StepError, step_error};

/// (-) Part of the starting transient that may be left where the kept signal starts.
const TOLERATED_TRANSIENT: f64 = 0.01;
/// (-) Part of the time that the mesh may pull without a warning.
const TOLERATED_TENSION: f64 = 0.01;
/// (-) Where damage makes the mesh pull, a load that so many times its own would hold the teeth together is worth a word.
const SENSIBLE_LOAD_FACTOR: f64 = 30.0;

/// (-) Part of the module by which the nominal load may press the teeth together without a warning.
const TOLERATED_DEFLECTION: f64 = 0.1;
/// (-) How many times the static force the mesh force may be without a warning.
const TOLERATED_RESONANCE: f64 = 1000.0;
/// (-) How far a shaft's mean speed may be from what the motor drives it at without a warning.
const TOLERATED_SPEED: f64 = 0.2;
/// (-) How far the step may falsify the rms of a signal without a warning.
const TOLERATED_STEP: f64 = 0.02;

/// Runs stages 1 to 6, as [`stages`] does, and tells all that deserves attention before the time loop.
///
/// # Arguments
/// * `scenario` - what is simulated
/// * `limit` - most memory that the simulation may need
///
/// # Errors
/// As [`stages`].
///
/// ```
/// use meshtone::scenario::{GearPair, MemoryLimit, Scenario};
///
/// let mut scenario = Scenario::new(GearPair { module_mm: 3.0, pinion_teeth: 14, gear_teeth: 38, face_width_mm: 15.0, pinion_speed_hz: 40.0, brake_torque_nm: 10.0 });
/// scenario.solver.sampling_rate_hz = 2e4;
/// let (stages, warnings) = meshtone::stages_and_warnings(&scenario, MemoryLimit::default())?;
/// assert_eq!(warnings[0].key, "gears.pinion_teeth");
/// // What the signals show comes after.
/// assert!(stages.simulate()?.warnings_of_signals().iter().all(|warning| warning.key == "operation.brake_torque_nm"));
/// # Ok::<(), meshtone::Error>(())
/// ```
pub fn stages_and_warnings(
    scenario: &Scenario,
    limit: MemoryLimit,
) -> Result<(Stages, Vec<ScenarioWarning>), ScenarioError> {
    let mut warnings = scenario.validate_within(limit)?;
    let stages = stages(scenario)?;
    warnings.extend(scenario.ignored_by_model());
    warnings.extend(stages.warnings());
    Ok((stages, warnings))
}

impl Simulation {
    /// What the signals show to be doubtful: a mesh that pulls (not under `contact`, whose teeth part:
    /// [`Simulation::contact_figures`] says for how long), a resonance beyond all measure, a shaft that does not turn at the speed
    /// that it is driven at, a step too long for a resonance. Where the latter is suspected the simulation is repeated with half the
    /// step.
    pub fn warnings_of_signals(&self) -> Vec<ScenarioWarning> {
        let is_damaged = !self.stages.damaged.is_empty();
        let is_linear = self.stages.mesh.contact().is_none();
        let pulling = is_linear.then(|| tension(&self.channels, is_damaged)).flatten();
        let step = step_error(self).and_then(|error| long_step(error, &self.stages));
        let doubtful = [pulling, self.resonance(), self.other_speed(), step];
        doubtful.into_iter().flatten().collect()
    }

    /// A mesh force so far beyond the static one that the machine could not be.
    fn resonance(&self) -> Option<ScenarioWarning> {
        let (_, torque_nm) = largest_torque(&self.stages.scenario);
        let static_n = self.stages.force_of_torque_n(torque_nm);
        let largest_n =
            self.channels.mesh_force_n.iter().fold(0.0, |largest: f64, force| force.abs().max(largest));
        (static_n > 0.0 && largest_n > TOLERATED_RESONANCE * static_n).then(|| {
            let message = format!(
                "the mesh force reaches {largest_n:.3e} N, {:.0} times the static {static_n:.4} N: a resonance that no machine \
                 survives, or a load too light to be meant; raise the damping, change the speed, or load the pair",
                largest_n / static_n
            );
            ScenarioWarning::new("operation.pinion_speed_hz", message)
        })
    }

    /// A shaft whose mean speed is not what it is driven at.
    fn other_speed(&self) -> Option<ScenarioWarning> {
        let (stages, channels) = (&self.stages, &self.channels);
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let kept = stages.scenario.motion(&stages.time).skip(stages.time.first_kept_sample);
        let driven_hz = match stages.scenario.operation.speed_profile_hz {
            None => stages.scenario.operation.pinion_speed_hz,
            Some(_) => mean(&kept.take(channels.len()).map(|motion| motion.speed_hz).collect::<Vec<_>>()),
        };
        let ratio = f64::from(stages.teeth.pinion.teeth) / f64::from(stages.teeth.gear.teeth);
        let shafts = [
            ("pinion", driven_hz, &channels.pinion_shaft_speed_hz),
            ("gear", driven_hz * ratio, &channels.gear_shaft_speed_hz),
        ];
        let turning = shafts.map(|(wheel, driven_hz, speed_hz)| (wheel, driven_hz, mean(speed_hz)));
        let off = |(_, driven_hz, hz): &(&str, f64, f64)| (hz / driven_hz - 1.0).abs() > TOLERATED_SPEED;
        turning.into_iter().find(off).map(|(wheel, driven_hz, hz)| {
            let message = format!(
                "the {wheel} turns at {hz:.4} Hz on average, while the motor drives it at {driven_hz:.4} Hz: the motion has not \
                 settled, or too many teeth are gone; lengthen solver.settle_fraction, raise the damping, leave out \
                 solver.initial_velocity, or lessen the damage"
            );
            ScenarioWarning::new("solver.settle_fraction", message)
        })
    }
}

/// A step that falsifies a resonance.
fn long_step(error: StepError, stages: &Stages) -> Option<ScenarioWarning> {
    let rate_hz = stages.time.sampling_rate_hz;
    let (error, shown) = match error {
        StepError::Suspected(error) => (error, format!("and the rms may be wrong by {:.1} %", 100.0 * error)),
        StepError::Shown { gain, finer_rate_hz } => {
            let (percent, larger) = (100.0 * gain.abs(), if gain > 0.0 { "larger" } else { "smaller" });
            let shown = format!("and at {finer_rate_hz:.0} S/s the rms is {percent:.1} % {larger}");
            // Of second order.
            (gain.abs() / (1.0 - (rate_hz / finer_rate_hz).powi(2)), shown)
        }
    };
    (error > TOLERATED_STEP).then(|| {
        let finer_hz = rate_hz * (error / TOLERATED_STEP).sqrt().clamp(1.2, 10.0);
        let message = format!(
            "at {rate_hz:.0} S/s the step shifts a resonance that the teeth excite, {shown}; set sampling_rate_hz = {finer_hz:.2e}, \
             and more until this goes"
        );
        ScenarioWarning::new("solver.sampling_rate_hz", message)
    })
}

/// The key of the largest torque, and the torque in N m.
fn largest_torque(scenario: &Scenario) -> (String, f64) {
    let operation = &scenario.operation;
    let values = operation.torque_profile_nm.iter().flat_map(|profile| &profile.value).enumerate();
    let values =
        values.map(|(index, &torque)| (format!("operation.torque_profile_nm.value[{index}]"), torque));
    let constant = ("operation.brake_torque_nm".to_owned(), operation.brake_torque_nm);
    let of_profile = values.reduce(|largest, other| if other.1 > largest.1 { other } else { largest });
    of_profile.unwrap_or(constant)
}

/// A mesh that pulls, and what brings that down.
fn tension(channels: &Channels, is_damaged: bool) -> Option<ScenarioWarning> {
    let fraction = channels.tension_fraction();
    (fraction > TOLERATED_TENSION).then(|| {
        let force = &channels.mesh_force_n;
        let least_n = force.iter().copied().fold(f64::INFINITY, f64::min);
        let mean_n = force.iter().sum::<f64>() / force.len() as f64;
        // The force that deviations and lost material add hardly depends on the load.
        let advice = if is_damaged && mean_n - least_n > SENSIBLE_LOAD_FACTOR * mean_n {
            "no sensible load would hold these teeth together; less damage brings it down"
        } else {
            "a heavier load or better teeth bring it down"
        };
        let message = format!(
            "the mesh force is negative for {:.1} % of the time, down to {least_n:.0} N at a mean of {mean_n:.0} N: this linear \
             mesh pulls where real teeth would part; {advice}",
            100.0 * fraction
        );
        ScenarioWarning::new("operation.brake_torque_nm", message)
    })
}

impl Stages {
    /// What deserves attention though it can be simulated: wheels whose accelerations, or whose supports', cancel in the channels,
    /// a settling too short for the slowest mode, a load that would break the teeth.
    pub fn warnings(&self) -> Vec<ScenarioWarning> {
        let doubtful = [self.equal_wheels(), self.unsettled(), self.crushed()];
        doubtful.into_iter().flatten().collect()
    }

    /// Teeth that the load would bend off.
    fn crushed(&self) -> Option<ScenarioWarning> {
        let (key, torque_nm) = largest_torque(&self.scenario);
        let force_n = self.force_of_torque_n(torque_nm);
        let deflection_mm = force_n / self.mesh.mean_stiffness_n_per_mm();
        let (module_mm, width_mm) = (self.scenario.gears.module_mm, self.scenario.gears.face_width_mm);
        let most_mm = TOLERATED_DEFLECTION * module_mm;
        (deflection_mm > most_mm).then(|| {
            let most_nm = torque_nm * most_mm / deflection_mm;
            let message = format!(
                "{torque_nm:?} N m presses the teeth {deflection_mm:.3} mm together, {:.2} modules, with {force_n:.0} N on {width_mm} mm \
                 of face: they would break; at most {most_nm:.0} N m stays below a tenth of the module",
                deflection_mm / module_mm
            );
            ScenarioWarning::new(key, message)
        })
    }

    /// (-) Part of the starting transient that is left where the kept signal starts, by the slowest active mode's decay.
    pub fn transient_remainder(&self) -> f64 {
        let settling_s = self.time.first_kept_sample as f64 * self.time.step_s();
        (-self.slowest_decay_per_s() * settling_s).exp()
    }

    fn equal_wheels(&self) -> Option<ScenarioWarning> {
        let message = match &self.structure {
            None => {
                let mass = &self.system.mass_diagonal;
                (mass[X_GEAR] == mass[X_PINION]).then_some(
                    "both wheels have the same mass and the same bearings: they move in opposition, and the \
                     horizontal and vertical channels, which are the sum of both wheels' accelerations, are 0; give one \
                     wheel its own mass (rig.gear_inertia.mass_kg)",
                )
            }
            Some(structure) => self.sides_are_alike(structure).then_some(
                "both wheels have the same mass, shafts and bearings: they and their supports move in opposition, and the \
                 horizontal and vertical channels, which are the mean of both supports' accelerations, are 0; give one wheel \
                 its own mass (rig.gear_inertia.mass_kg) or shaft (rig.gear_shaft.bearing_span_mm)",
            ),
        };
        message.map(|message| ScenarioWarning::new("gears.gear_teeth", message))
    }

    /// Whether wheels and shafts are such that both supports move alike, in opposition.
    fn sides_are_alike(&self, structure: &Structure) -> bool {
        let rig = &self.scenario.rig;
        let side = |body: &WheelBody, shaft: &Shaft| {
            let bearing = shaft.bearing_stiffness_n_per_m.unwrap_or(rig.bearing_stiffness_n_per_m);
            let bends =
                [shaft.radius_mm, shaft.bearing_span_mm, shaft.wheel_at, shaft.damping_ratio, bearing];
            (body.mass_kg, body.transverse_kgm2, bends)
        };
        side(&structure.pinion, &rig.pinion_shaft) == side(&structure.gear, &rig.gear_shaft)
    }

    fn unsettled(&self) -> Option<ScenarioWarning> {
        let remainder = self.transient_remainder();
        (remainder > TOLERATED_TRANSIENT).then(|| {
            let decay = self.slowest_decay_per_s();
            let settling_s = self.time.first_kept_sample as f64 * self.time.step_s();
            let advice = if decay > 0.0 {
                format!("it takes {:.3} s to fall to 1 %", -TOLERATED_TRANSIENT.ln() / decay)
            } else {
                "it never decays: a mode has no damping".to_string()
            };
            let percent = 100.0 * remainder;
            let advice = match self.slowest_closed_mode() {
                Some(mode) if decay > 0.0 => format!("{advice}; {}", slowest_mode(&mode)),
                _ => advice,
            };
            let message = format!(
                "up to {percent:.0} % of the start-up transient is left when the kept signal starts, after {settling_s:.3} s; \
                 {advice}"
            );
            ScenarioWarning::new("solver.settle_fraction", message)
        })
    }
}

/// Which mode is slow, and what damps it.
fn slowest_mode(mode: &DecayingMode) -> String {
    let ratio = mode.decay_per_s / (TAU * mode.frequency_hz);
    format!(
        "slowest is the mode at {:.0} Hz, at {:.2} % of critical damping, which the damping_ratio of shafts and supports raises",
        mode.frequency_hz,
        100.0 * ratio
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_that_pulls_is_told_with_what_mends_it() {
        let of = |least_n: f64, pulling: usize, is_damaged: bool| {
            let mut mesh_force_n = vec![200.0; 100];
            mesh_force_n[..pulling].fill(least_n);
            let channels = Channels { mesh_force_n, ..Channels::default() };
            tension(&channels, is_damaged).map(|warning| warning.message).unwrap_or_default()
        };
        assert_eq!(of(-50.0, 1, true), "");
        let told = of(-50.0, 2, true);
        assert!(told.starts_with(
            "the mesh force is negative for 2.0 % of the time, down to -50 N at a mean of 195 N"
        ));
        assert!(told.ends_with("a heavier load or better teeth bring it down"), "{told}");
        assert_eq!(of(-4000.0, 2, false).rsplit("; ").next(), told.rsplit("; ").next());
        let damage = of(-4000.0, 2, true);
        assert!(damage.ends_with("hold these teeth together; less damage brings it down"), "{damage}");
    }
}
