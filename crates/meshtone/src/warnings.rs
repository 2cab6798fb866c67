//! What the stages show to be doubtful about a simulation.

use crate::error::ScenarioWarning;
use crate::machine::coordinates::{X_GEAR, X_PINION};
use crate::simulate::Stages;

/// (-) Part of the starting transient that may be left where the kept signal starts.
const TOLERATED_TRANSIENT: f64 = 0.01;

impl Stages {
    /// What deserves attention though it can be simulated: wheels whose accelerations cancel in the sum that the channels
    /// are, and a settling too short for the slowest mode.
    pub fn warnings(&self) -> Vec<ScenarioWarning> {
        self.equal_wheels().into_iter().chain(self.unsettled()).collect()
    }

    /// (-) Part of the starting transient that is left where the kept signal starts, by the slowest active mode's decay.
    pub fn transient_remainder(&self) -> f64 {
        let settling_s = self.time.first_kept_sample as f64 * self.time.step_s();
        (-self.reduced_model().slowest_decay_per_s() * settling_s).exp()
    }

    fn equal_wheels(&self) -> Option<ScenarioWarning> {
        let mass = &self.system.mass_diagonal;
        (mass[X_GEAR] == mass[X_PINION]).then(|| {
            let message = "both wheels have the same mass and the same bearings: they move in opposition, and the \
                           horizontal and vertical channels, which are the sum of both wheels' accelerations, are 0; give one \
                           wheel its own mass (rig.gear_inertia.mass_kg)";
            ScenarioWarning::new("gears.gear_teeth", message)
        })
    }

    fn unsettled(&self) -> Option<ScenarioWarning> {
        let remainder = self.transient_remainder();
        (remainder > TOLERATED_TRANSIENT).then(|| {
            let decay = self.reduced_model().slowest_decay_per_s();
            let settling_s = self.time.first_kept_sample as f64 * self.time.step_s();
            let advice = if decay > 0.0 {
                format!("it takes {:.3} s to fall to 1 %", -TOLERATED_TRANSIENT.ln() / decay)
            } else {
                "it never decays: a mode has no damping".to_string()
            };
            let percent = 100.0 * remainder;
            let message = format!(
                "up to {percent:.0} % of the start-up transient is left when the kept signal starts, after {settling_s:.3} s; \
                 {advice}"
            );
            ScenarioWarning::new("solver.settle_fraction", message)
        })
    }
}
