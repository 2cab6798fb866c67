//! Whether the parts of a scenario have room: each on its shaft, each shaft in its bearings, none in the way of another.

use super::layout::entry_key;
use super::{Layout, Scenario};
use crate::error::{ScenarioError, ScenarioWarning, WarningKind};
use crate::wheel::WheelName;

/// (mm) How far faces may overlap by rounding.
const ROUNDING_MM: f64 = 1e-6;

impl Layout {
    /// Bores within roots, supports of every shaft, wheels beside other shafts.
    pub(super) fn check_room(&self, scenario: &Scenario) -> Result<(), ScenarioError> {
        let entries = scenario.shafts().len();
        for (number, shaft) in scenario.shafts().iter().enumerate() {
            let supports: Vec<f64> = (scenario.bearings().iter().zip(&self.shaft_of_bearing))
                .filter(|(_, of)| **of == number)
                .map(|(bearing, _)| bearing.at)
                .collect();
            let spread = supports.iter().any(|at| (at - supports[0]).abs() > 1e-6);
            if !spread {
                let problem = format!(
                    "has {} bearings at different places; must have at least two",
                    if supports.is_empty() { 0 } else { 1 }
                );
                return Err(ScenarioError::new(
                    entry_key("shaft", number, entries, "name"),
                    format!("{:?}", shaft.name),
                    problem,
                )
                .with_help("add a [[bearing]] with this shaft and another at"));
            }
        }
        for (index, wheel) in scenario.wheels.iter().enumerate().take(scenario.own_wheels()) {
            let shaft = &scenario.shafts()[self.shaft_of_wheel[index]];
            let bore_mm = shaft.radius_at_mm(wheel.at);
            let Some((mesh, _)) = self.mesh_of(index) else {
                let problem = "is in no mesh; every wheel must be";
                return Err(ScenarioError::new(
                    entry_key("wheel", index, scenario.wheels.len(), "name"),
                    format!("{:?}", wheel.name),
                    problem,
                )
                .with_help("add a [[mesh]] that names it, or remove the wheel"));
            };
            let gears = &self.gears[mesh];
            let root_mm = gears.transverse_module_mm() * f64::from(wheel.teeth) / 2.0
                + gears.module_mm * (wheel.profile_shift - wheel.dedendum);
            if bore_mm >= root_mm {
                let key = entry_key("wheel", index, scenario.wheels.len(), "shaft");
                let problem = format!(
                    "has a radius of {bore_mm:?} mm there; must be less than {root_mm:.4} mm, the root radius of {:?}",
                    wheel.name
                );
                return Err(ScenarioError::new(key, format!("{:?}", wheel.shaft), problem)
                    .with_help("make the shaft thinner, or the wheel larger"));
            }
            self.check_axial_support(scenario, index)?;
            self.check_on_shaft(scenario, index)?;
            self.check_clear_of_shafts(scenario, index)?;
            self.check_clear_of_wheels(scenario, index)?;
        }
        (1..entries).try_for_each(|number| self.check_clear_of_other_shafts(scenario, number))
    }

    /// (mm) Distance of the axes of two shafts.
    fn apart_mm(&self, shaft: usize, other: usize) -> f64 {
        let [a, b] = [shaft, other].map(|number| self.positions_m[number]);
        (a[0] - b[0]).hypot(a[1] - b[1]) * 1e3
    }

    /// A shaft must not reach into an earlier one.
    fn check_clear_of_other_shafts(&self, scenario: &Scenario, number: usize) -> Result<(), ScenarioError> {
        let shafts = scenario.shafts();
        for other in 0..number {
            let both = [number, other].map(|number| &shafts[number]);
            let from_mm = both.map(|shaft| shaft.z_mm(0.0)).into_iter().fold(f64::NEG_INFINITY, f64::max);
            let until_mm = both.map(|shaft| shaft.z_mm(1.0)).into_iter().fold(f64::INFINITY, f64::min);
            let apart_mm = self.apart_mm(number, other);
            let radii_mm = both.map(|shaft| shaft.largest_radius_mm([from_mm, until_mm]));
            let is_inside =
                |inner: usize, outer: usize| apart_mm + radii_mm[inner] <= both[outer].bore_radius_mm;
            if is_inside(0, 1) || is_inside(1, 0) {
                continue;
            }
            if until_mm > from_mm + ROUNDING_MM && apart_mm < radii_mm[0] + radii_mm[1] {
                let problem = format!(
                    "runs into shaft {:?} from z = {from_mm:.3} to {until_mm:.3} mm: their axes are {apart_mm:.3} mm apart, and their radii \
                     reach {:.3} and {:.3} mm there",
                    both[1].name, radii_mm[0], radii_mm[1]
                );
                let key = entry_key("shaft", number, shafts.len(), "start_mm");
                return Err(ScenarioError::new(key, both[0].start_mm, problem).with_help(
                    "let one begin where the other ends, make them shorter, or give them another position_mm",
                ));
            }
        }
        Ok(())
    }

    /// The shaft of a helical wheel is held along its axis.
    fn check_axial_support(&self, scenario: &Scenario, index: usize) -> Result<(), ScenarioError> {
        let own = self.shaft_of_wheel[index];
        let mut bearings = scenario.bearings().iter().zip(&self.shaft_of_bearing);
        let is_held = bearings.any(|(bearing, of)| *of == own && bearing.axial_n_per_m() > 0.0);
        if is_held || self.meshes_of(index).all(|(mesh, _)| !self.gears[mesh].is_helical()) {
            return Ok(());
        }
        let wheel = &scenario.wheels[index];
        let problem = format!(
            "no bearing holds the shaft along its axis, where {:?}, a helical wheel, pushes it; one must have \
             axial_stiffness_n_per_m above 0",
            wheel.name
        );
        let key = entry_key("wheel", index, scenario.wheels.len(), "shaft");
        Err(ScenarioError::new(key, format!("{:?}", wheel.shaft), problem)
            .with_help("give one of the shaft's bearings an axial_stiffness_n_per_m, such as 3e7"))
    }

    /// Shafts on which the axial forces of two helical wheels add up.
    pub(super) fn added_thrusts(&self, scenario: &Scenario) -> impl Iterator<Item = ScenarioWarning> {
        (0..scenario.shafts().len()).filter_map(|shaft| {
            let wheels = (0..scenario.wheels.len()).filter(|wheel| self.shaft_of_wheel[*wheel] == shaft);
            let thrusts = wheels.flat_map(|wheel| self.meshes_of(wheel).map(move |(mesh, side)| (wheel, mesh, side)));
            let pushed: Vec<(usize, usize, f64)> = thrusts
                .map(|(wheel, mesh, side)| {
                    let driving = self.shaft_of_wheel[self.wheels_of_mesh[mesh][0]];
                    let sense = self.ratios[driving].value().signum();
                    (wheel, mesh, side.choose(1.0, -1.0) * sense * self.gears[mesh].thrust())
                })
                .filter(|(.., thrust)| *thrust != 0.0)
                .collect();
            let (last, others) = pushed.split_last()?;
            let adds_up = !others.is_empty() && others.iter().all(|other| other.2 * last.2 > 0.0);
            let names: Vec<&str> =
                pushed.iter().map(|(wheel, ..)| scenario.wheels[*wheel].name.as_str()).collect();
            let message = format!(
                "the axial forces of {} add up on shaft {:?}; with the other hand in this mesh they would oppose",
                names.join(" and "),
                scenario.shafts()[shaft].name
            );
            let key = entry_key("mesh", last.1, scenario.meshes.len(), "hand");
            adds_up.then(|| ScenarioWarning::new(WarningKind::AddedThrust, key, message))
        })
    }

    /// A wheel sits on its shaft with its whole face.
    fn check_on_shaft(&self, scenario: &Scenario, index: usize) -> Result<(), ScenarioError> {
        let (wheel, shaft) = (&scenario.wheels[index], &scenario.shafts()[self.shaft_of_wheel[index]]);
        let half_mm = wheel.face_width_mm / 2.0;
        let [start_mm, end_mm] = self.face_mm(scenario, index);
        let ends_mm = [shaft.z_mm(0.0), shaft.z_mm(1.0)];
        if start_mm >= ends_mm[0] - ROUNDING_MM && end_mm <= ends_mm[1] + ROUNDING_MM {
            return Ok(());
        }
        let key = entry_key("wheel", index, scenario.wheels.len(), "at");
        let problem = format!(
            "the face of {:?} would reach from z = {start_mm:.3} to {end_mm:.3} mm; must stay on its shaft, from {} to {:?} mm",
            wheel.name, ends_mm[0], ends_mm[1]
        );
        let help = if wheel.face_width_mm <= shaft.length_mm {
            let least = half_mm / shaft.length_mm;
            format!("at from {least:.4} to {:.4} keeps it there", 1.0 - least)
        } else {
            "make the shaft longer, or the face narrower".to_owned()
        };
        Err(ScenarioError::new(key, wheel.at, problem).with_help(help))
    }

    /// (mm) From where to where along z the face of a wheel reaches.
    fn face_mm(&self, scenario: &Scenario, wheel: usize) -> [f64; 2] {
        let (middle_mm, half_mm) = (self.z_mm(scenario, wheel), scenario.wheels[wheel].face_width_mm / 2.0);
        [middle_mm - half_mm, middle_mm + half_mm]
    }

    /// (mm) Tip radius of a wheel, which is in a mesh.
    fn tip_mm(&self, scenario: &Scenario, wheel: usize) -> f64 {
        let tip_mm = |(mesh, side): (usize, WheelName)| {
            let gears = &self.gears[mesh];
            let of = &scenario.wheels[wheel];
            gears.transverse_module_mm() * f64::from(of.teeth) / 2.0
                + gears.module_mm * (of.profile_shift + gears.addendum(side))
        };
        self.mesh_of(wheel).map_or(0.0, tip_mm)
    }

    /// A wheel must not reach into an earlier one, on its shaft or on another, unless they mesh.
    fn check_clear_of_wheels(&self, scenario: &Scenario, index: usize) -> Result<(), ScenarioError> {
        let [start_mm, end_mm] = self.face_mm(scenario, index);
        for other in 0..index {
            let [other_start_mm, other_end_mm] = self.face_mm(scenario, other);
            let is_beside = end_mm <= other_start_mm + ROUNDING_MM || other_end_mm <= start_mm + ROUNDING_MM;
            let mesh =
                self.wheels_of_mesh.iter().any(|wheels| wheels.contains(&index) && wheels.contains(&other));
            if is_beside || mesh {
                continue;
            }
            let apart_mm = self.apart_mm(self.shaft_of_wheel[index], self.shaft_of_wheel[other]);
            let tips_mm = [index, other].map(|wheel| self.tip_mm(scenario, wheel));
            if apart_mm >= tips_mm[0] + tips_mm[1] {
                continue;
            }
            let [wheel, known] = [index, other].map(|number| &scenario.wheels[number]);
            let faces = format!(
                "the face of {:?} reaches from z = {start_mm:.3} to {end_mm:.3} mm, that of {:?} from {other_start_mm:.3} to \
                 {other_end_mm:.3} mm",
                wheel.name, known.name
            );
            let problem = if self.shaft_of_wheel[index] == self.shaft_of_wheel[other] {
                format!("overlaps a wheel on the same shaft: {faces}")
            } else {
                format!(
                    "runs into a wheel that it does not mesh with: {faces}, and their axes are {apart_mm:.3} mm apart, less than the \
                     tip radii, {:.3} and {:.3} mm",
                    tips_mm[0], tips_mm[1]
                )
            };
            let key = entry_key("wheel", index, scenario.wheels.len(), "at");
            return Err(ScenarioError::new(key, wheel.at, problem)
                .with_help("move one of the two along its shaft, make faces narrower, or give shafts another position_mm"));
        }
        Ok(())
    }

    /// A wheel must not reach into a shaft that it does not sit on.
    fn check_clear_of_shafts(&self, scenario: &Scenario, index: usize) -> Result<(), ScenarioError> {
        let (wheel, own) = (&scenario.wheels[index], self.shaft_of_wheel[index]);
        let tip_mm = self.tip_mm(scenario, index);
        let z_mm = self.z_mm(scenario, index);
        for (number, other) in scenario.shafts().iter().enumerate().filter(|(number, _)| *number != own) {
            let at = (z_mm - other.start_mm) / other.length_mm;
            let passes = (0.0..=1.0).contains(&at);
            let apart_mm = self.apart_mm(own, number);
            let radius_mm = other.radius_at_mm(at.clamp(0.0, 1.0));
            if passes && apart_mm < tip_mm + radius_mm {
                let key = entry_key("wheel", index, scenario.wheels.len(), "shaft");
                let problem = format!(
                    "{:?} reaches {tip_mm:.3} mm from its axis, into shaft {:?}, whose axis is {apart_mm:.3} mm away and whose radius is \
                     {radius_mm:?} mm",
                    wheel.name, other.name
                );
                return Err(ScenarioError::new(key, format!("{:?}", wheel.shaft), problem)
                    .with_help("give the shafts a position_mm by which the train bends out of the way, or shorten the shaft"));
            }
        }
        Ok(())
    }
}
