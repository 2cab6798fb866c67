//! Severities of a scenario's faults.

use super::gearbox::teeth_of_mesh;
use super::healthy_teeth;
use crate::damage::Fault;
use crate::error::ScenarioError;
use crate::scenario::{Gearbox, GearboxLayout, Scenario};
use crate::wheel::Teeth;

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
    /// let faults = vec![Fault::on_first_gear_tooth(chip), Fault::new(Default::default(), 2, MissingTooth)];
    /// let scenario = Scenario::new(GearPair::example()).with_faults(faults);
    /// let severities = scenario.fault_severities()?;
    /// assert!((severities[0] - 0.40).abs() < 0.01);
    /// assert_eq!(severities[1], 1.0);
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn fault_severities(&self) -> Result<Vec<f64>, ScenarioError> {
        self.validate()?;
        let teeth = self.healthy_teeth();
        Ok(self.faults.iter().map(|fault| fault.severity_on(&teeth)).collect())
    }

    /// Returns the scenario with the sizes of every fault that was given by its severity. A fault of severity 0, or one that is
    /// smaller than the tooth profile's points can show, is left out.
    ///
    /// # Errors
    /// Those of [`Scenario::validate`].
    pub fn with_own_sizes(&self) -> Result<Self, ScenarioError> {
        self.validate()?;
        let teeth = self.healthy_teeth();
        let sized = |fault: &Fault| Some(Fault::new(fault.wheel, fault.tooth.clone(), fault.sized(&teeth)?));
        let faults = self.faults.iter().filter_map(sized).collect();
        Ok(self.clone().with_faults(faults))
    }

    fn healthy_teeth(&self) -> Teeth {
        healthy_teeth(&self.without_ignored_keys())
    }
}

impl Gearbox {
    /// (-) How severe each fault is, from 0, none, to 1, the largest that the tooth allows: as given, or by its sizes.
    ///
    /// # Errors
    /// Those of [`Gearbox::validate`].
    pub fn fault_severities(&self) -> Result<Vec<f64>, ScenarioError> {
        self.validate()?;
        let layout = GearboxLayout::new(self)?;
        let mut severities = vec![0.0; self.faults.len()];
        for mesh in 0..self.meshes.len() {
            let teeth = teeth_of_mesh(self, &layout, mesh);
            for (number, fault) in layout.faults_of_mesh(self, mesh) {
                severities[number] = fault.severity_on(&teeth);
            }
        }
        Ok(severities)
    }
}
