//! Severities of a scenario's faults.

use super::healthy_teeth;
use crate::damage::Fault;
use crate::error::ScenarioError;
use crate::scenario::{Gearbox, GearboxFault, GearboxLayout, Model, Scenario, ScenarioForm};
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
        let honoured = self.without_ignored_keys();
        healthy_teeth(honoured.model, &GearboxLayout::of_pair(&honoured)).swap_remove(0)
    }
}

impl Gearbox {
    /// (-) How severe each fault is, from 0, none, to 1, the largest that the tooth allows: as given, or by its sizes.
    ///
    /// # Errors
    /// Those of [`Gearbox::validate`].
    pub fn fault_severities(&self) -> Result<Vec<f64>, ScenarioError> {
        self.of_faults(|fault, teeth| fault.severity_on(teeth))
    }

    /// Returns the gearbox with the sizes of every fault that was given by its severity, as [`Scenario::with_own_sizes`] does.
    ///
    /// # Errors
    /// Those of [`Gearbox::validate`].
    pub fn with_own_sizes(&self) -> Result<Self, ScenarioError> {
        let sized = |fault: &Fault, teeth: &Teeth| {
            Some(Fault::new(fault.wheel, fault.tooth.clone(), fault.sized(teeth)?))
        };
        let sized = self.faults.iter().zip(self.of_faults(sized)?);
        let faults =
            sized.filter_map(|(of, fault)| Some(GearboxFault { fault: fault?, wheel: of.wheel.clone() }));
        Ok(Self { faults: faults.collect(), ..self.clone() })
    }

    /// What is asked of each fault on the healthy teeth of its wheel's mesh.
    fn of_faults<T: Default>(&self, ask: impl Fn(&Fault, &Teeth) -> T) -> Result<Vec<T>, ScenarioError> {
        self.validate()?;
        let layout = GearboxLayout::new(self)?;
        let mut answers: Vec<T> = self.faults.iter().map(|_| T::default()).collect();
        for (mesh, teeth) in healthy_teeth(Model::Contact, &layout).into_iter().enumerate() {
            for (number, fault) in layout.faults_of_mesh(&self.placed_faults(), mesh) {
                answers[number] = ask(&fault, &teeth);
            }
        }
        Ok(answers)
    }
}

impl ScenarioForm {
    /// Does what [`Scenario::with_own_sizes`] and [`Gearbox::with_own_sizes`] do.
    ///
    /// # Errors
    /// Those of [`ScenarioForm::validate`].
    pub fn with_own_sizes(&self) -> Result<Self, ScenarioError> {
        Ok(match self {
            Self::Pair(scenario) => Self::Pair(scenario.with_own_sizes()?),
            Self::Gearbox(gearbox) => Self::Gearbox(gearbox.with_own_sizes()?),
        })
    }
}
