//! Severities of a scenario's faults.

use super::healthy_teeth;
use crate::damage::{Damage, Fault};
use crate::error::ScenarioError;
use crate::scenario::Scenario;
use crate::wheel::{KnownProfiles, Teeth};

impl Scenario {
    /// (-) How severe each fault is, from 0, none, to 1, the largest that the tooth allows: as given, or by its sizes.
    ///
    /// # Errors
    /// Those of [`Scenario::validate`].
    ///
    /// ```
    /// use meshtone::scenario::{Fault, GearPair, MissingTooth, Scenario, ToothBreakage};
    ///
    /// let chip = ToothBreakage { chip_height_mm: 5.0, chip_width_mm: 12.0, tip_loss_mm: 0.0 };
    /// let faults = vec![Fault::on_first_gear_tooth(chip), Fault::new("gear", 2, MissingTooth)];
    /// let scenario = Scenario::new(GearPair::example()).with_faults(faults);
    /// let severities = scenario.fault_severities()?;
    /// assert!((severities[0] - 0.40).abs() < 0.01);
    /// assert_eq!(severities[1], 1.0);
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn fault_severities(&self) -> Result<Vec<f64>, ScenarioError> {
        self.of_faults(|fault, teeth| fault.severity_on(teeth))
    }

    /// Returns the scenario with the sizes of every fault that was given by its severity. A fault of severity 0, or one that is
    /// smaller than the tooth profile's points can show, is left out.
    ///
    /// # Errors
    /// Those of [`Scenario::validate`].
    pub fn with_own_sizes(&self) -> Result<Self, ScenarioError> {
        let sizes = self.of_faults(|fault: &Fault, teeth: &Teeth| fault.sized(teeth))?;
        // In its mesh a wheel is the pinion or the gear, whatever its name.
        let sized = |(fault, damage): (&Fault, Option<Damage>)| {
            Some(Fault::new(&fault.wheel, fault.tooth.clone(), damage?))
        };
        let faults = self.faults.iter().zip(sizes).filter_map(sized).collect();
        Ok(self.clone().with_faults(faults))
    }

    /// What is asked of each fault on the healthy teeth of its wheel's mesh.
    fn of_faults<T: Default>(&self, ask: impl Fn(&Fault, &Teeth) -> T) -> Result<Vec<T>, ScenarioError> {
        self.validate()?;
        let honoured = self.without_ignored_keys();
        let (layout, faults) = (honoured.layout()?, self.placed_faults());
        let mut answers: Vec<T> = faults.iter().map(|_| T::default()).collect();
        for (mesh, teeth) in
            healthy_teeth(honoured.model, &layout, &KnownProfiles::default()).into_iter().enumerate()
        {
            for (number, fault) in layout.faults_of_mesh(&faults, mesh) {
                answers[number] = ask(&fault, &teeth);
            }
        }
        Ok(answers)
    }
}
