//! Rules of a pair in a rig.

use super::super::layout::entry_key;
use super::super::short::{self, Section};
use super::super::{MemoryLimit, Scenario, ScenarioError, ScenarioWarning};
use super::{DrivenSpeed, duration, model, pitch_line_mm, size};
use crate::damage::check_faults;
use crate::keys::{Check, below, check_rows};
use crate::machine::Rig;
use crate::sensor::check_sensors;
use crate::wheel::{Gears, NamedGears, WheelName};

impl Scenario {
    /// Every value, alone and against the others, as they are and as the model honours them. Returns warnings about what can be simulated.
    pub(in crate::scenario) fn check_rig(
        &self,
        rig: &Rig,
        limit: MemoryLimit,
    ) -> Result<Vec<ScenarioWarning>, ScenarioError> {
        self.check_is_pair()?;
        check_values(self, rig)?;
        let honoured = self.without_ignored_keys();
        if honoured != *self {
            check_values(&honoured, rig).map_err(|mut error| {
                error.problem += &format!(" (the {} model always has the default)", self.model.name());
                model::with_help(self.model, error)
            })?;
        }
        duration::check(&honoured)?;
        size::check(&honoured, limit)?;
        let gears = honoured.gears();
        let speed = DrivenSpeed {
            operation: &honoured.operation,
            key: self.words().speed_key,
            pitch_line_mm: pitch_line_mm(gears.transverse_module_mm(), gears.pinion_teeth),
        };
        speed.check()?;
        let mut warnings = NamedGears::of_pair(&gears).warnings();
        warnings.extend(speed.warnings());
        warnings.extend(honoured.quality().warnings());
        warnings.extend(honoured.operation.reversed_torque());
        warnings.extend(honoured.rig().into_iter().flat_map(|rig| rig.support.former_defaults()));
        Ok(warnings)
    }

    /// A rig holds a pinion and a gear, which mesh.
    fn check_is_pair(&self) -> Check {
        let names = WheelName::BOTH.map(WheelName::name);
        let meshes = matches!(&self.meshes[..], [mesh] if mesh.wheels == names);
        if self.wheel_names() == names && meshes {
            return Ok(());
        }
        let problem = "are not a pinion and a gear that mesh; a rig of condensed shafts holds these";
        Err(ScenarioError::new("gears", format!("{:?}", self.wheel_names()), problem))
    }
}

/// Every value, whether or not the model honours it.
fn check_values(scenario: &Scenario, rig: &Rig) -> Check {
    let check = |Section { name, rows }: Section| check_rows(&rows, scenario, name);
    let gears = scenario.gears();
    let named = NamedGears::of_pair(&gears);
    check(short::gears())?;
    named.check()?;
    check(short::operation())?;
    scenario.operation.check()?;
    check(short::quality())?;
    let is_given = scenario.wheels.iter().filter(|wheel| wheel.profile_errors_mm.is_some()).count();
    if is_given == 1 {
        let problem = "missing; profile errors are given for both wheels or for neither";
        return Err(ScenarioError::new("quality.profile_errors_mm", "", problem));
    }
    scenario.quality().check(&gears)?;
    for (number, fault) in scenario.faults.iter().enumerate() {
        if !WheelName::BOTH.iter().any(|of| of.name() == fault.wheel) {
            let key = entry_key("fault", number, scenario.faults.len(), "wheel");
            let problem = "is no wheel of a pair; must be \"pinion\" or \"gear\"";
            return Err(ScenarioError::new(key, format!("{:?}", fault.wheel), problem));
        }
    }
    let numbers: Vec<usize> = (0..scenario.faults.len()).collect();
    check_faults(&scenario.faults, &numbers, numbers.len(), &named)?;
    model::check(scenario, rig)?;
    check(short::rig())?;
    check_rig(scenario, rig, &gears)?;
    scenario.check_ripple(&WheelName::BOTH.map(WheelName::name))?;
    check_is_written(scenario)?;
    check_sensors(&scenario.sensors, scenario.model)?;
    check(short::solver())
}

/// What the file of a pair cannot state would be lost in it, and in all that is made from it.
fn check_is_written(scenario: &Scenario) -> Check {
    let meshes = || scenario.meshes.iter();
    let lost = [
        ("mesh.phase", meshes().any(|mesh| mesh.phase.is_some())),
        ("mesh.friction", meshes().any(|mesh| mesh.friction != 0.0)),
        ("mesh.random_force", meshes().any(|mesh| mesh.random_force != 0.0)),
        ("wheel.helix_wobble_um", scenario.wheels.iter().any(|wheel| wheel.helix_wobble_um != 0.0)),
    ];
    match lost.into_iter().find(|(_, is_given)| *is_given) {
        Some((key, _)) => {
            Err(ScenarioError::new(key, "", "is a key of gearboxes, and not of one pair in a rig"))
        }
        None => Ok(()),
    }
}

/// The rig with the wheels that run in it.
fn check_rig(scenario: &Scenario, rig: &Rig, gears: &Gears) -> Check {
    rig.support.check()?;
    let eccentricity_mm = scenario.wheels[0].eccentricity_mm;
    below("rig.eccentricity_mm", eccentricity_mm, gears.module_mm, "the module")?;
    for (wheel, shaft) in [(WheelName::Pinion, &rig.pinion_shaft), (WheelName::Gear, &rig.gear_shaft)] {
        let below_pitch_circle = gears.dedendum(wheel) - gears.profile_shift(wheel);
        let root_radius_mm = gears.transverse_module_mm() * f64::from(gears.teeth(wheel)) / 2.0
            - gears.module_mm * below_pitch_circle;
        let limit_is = format!("the root radius of the {}, whose bore it fills", wheel.name());
        below(&format!("rig.{}_shaft.radius_mm", wheel.name()), shaft.radius_mm, root_radius_mm, &limit_is)?;
    }
    Ok(())
}
