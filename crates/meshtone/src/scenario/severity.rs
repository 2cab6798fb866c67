//! How severe a scenario's faults are.

use super::{Fault, Scenario, ScenarioError};
use crate::wheel::{Teeth, teeth};

impl Scenario {
    /// (-) How severe each fault is, from 0, none, to 1, the largest that the tooth allows: as given, or by its sizes.
    ///
    /// # Errors
    /// As [`Scenario::validate`].
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

    /// The same scenario with the sizes of every fault that was given by its severity. A fault of severity 0, or one that is
    /// smaller than the tooth profile's points can show, is left out.
    ///
    /// # Errors
    /// As [`Scenario::validate`].
    pub fn with_own_sizes(&self) -> Result<Self, ScenarioError> {
        self.validate()?;
        let teeth = self.healthy_teeth();
        let sized = |fault: &Fault| Some(Fault::new(fault.wheel, fault.tooth.clone(), fault.sized(&teeth)?));
        let faults = self.faults.iter().filter_map(sized).collect();
        Ok(self.clone().with_faults(faults))
    }

    fn healthy_teeth(&self) -> Teeth {
        let Self { gears, rig, model, .. } = self.as_honoured();
        teeth(&gears, [rig.pinion_shaft.radius_mm, rig.gear_shaft.radius_mm], model)
    }
}
