//! What is doubtful about a simulation: before the time loop, and by its signals.

use std::f64::consts::TAU;

use crate::error::{ScenarioError, ScenarioWarning};
use crate::machine::coordinates::{X_GEAR, X_PINION};
use crate::machine::{DecayingMode, Shaft, Structure, WheelBody};
use crate::scenario::{MemoryLimit, Scenario};
use crate::sensor::Channels;
use crate::simulate::{Simulation, Stages, stages};

/// (-) Part of the starting transient that may be left where the kept signal starts.
const TOLERATED_TRANSIENT: f64 = 0.01;
/// (-) Part of the time that the mesh may pull without a warning.
const TOLERATED_TENSION: f64 = 0.01;
/// (-) Where damage makes the mesh pull, a load that so many times its own would hold the teeth together is worth a word.
const SENSIBLE_LOAD_FACTOR: f64 = 30.0;

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
    /// What the signals show to be doubtful: a mesh that pulls. Not under `contact`, whose teeth part:
    /// [`Simulation::contact_figures`] says for how long.
    pub fn warnings_of_signals(&self) -> Vec<ScenarioWarning> {
        if self.stages.mesh.contact().is_some() {
            return Vec::new();
        }
        tension(&self.channels, !self.stages.damaged.is_empty()).into_iter().collect()
    }
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
    /// What deserves attention though it can be simulated: wheels whose accelerations, or whose supports', cancel in the channels, and
    /// a settling too short for the slowest mode.
    pub fn warnings(&self) -> Vec<ScenarioWarning> {
        self.equal_wheels().into_iter().chain(self.unsettled()).collect()
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
