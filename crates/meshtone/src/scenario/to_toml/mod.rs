//! A scenario as TOML.

mod fault;
mod writer;

use self::writer::Section;
use super::{
    DampingRatio, Gears, Operation, Profile, Quality, ReliefShape, Rig, Scenario, Shaft, Solver, WheelInertia,
};

impl Scenario {
    /// The scenario as a scenario file that needs no other file: profile errors and profiles are
    /// written inline, defaults explicitly.
    ///
    /// A valid scenario is read back exactly by [`Scenario::from_toml`]. A seed above `i64::MAX` is
    /// read back by it too, but not by other TOML readers.
    ///
    /// ```
    /// use meshtone::scenario::Scenario;
    ///
    /// let scenario = Scenario::new(3.0, 17, 38, 15.0, 40.0, 10.0);
    /// let text = scenario.to_toml();
    /// assert!(text.starts_with("convention = \"corrected\"\nseed = 1\n"));
    /// assert_eq!(Scenario::from_toml(&text)?, scenario);
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn to_toml(&self) -> String {
        let mut top = Section::top_level();
        top.text("convention", self.convention.name()).whole("seed", self.seed);
        let fault = self.fault.as_ref().map(fault::section);
        let sections = [Some(top), Some(gears(&self.gears)), Some(operation(&self.operation))]
            .into_iter()
            .chain([Some(quality(&self.quality)), fault, Some(rig(&self.rig)), Some(solver(&self.solver))]);
        sections.flatten().map(Section::finish).collect::<Vec<_>>().join("\n")
    }
}

fn gears(gears: &Gears) -> Section {
    let mut section = Section::new("gears");
    section
        .number("module_mm", gears.module_mm)
        .whole("pinion_teeth", gears.pinion_teeth)
        .whole("gear_teeth", gears.gear_teeth)
        .number("face_width_mm", gears.face_width_mm)
        .number("pressure_angle_deg", gears.pressure_angle_deg)
        .text("material", gears.material.name());
    match &gears.tip_relief {
        None => section.raw("tip_relief", "false"),
        Some(relief) => {
            let shape = match relief.shape {
                ReliefShape::Parabolic => "parabolic",
                ReliefShape::Linear => "linear",
            };
            let lengths = writer::pairs(&[("length_mm", relief.length_mm), ("depth_mm", relief.depth_mm)]);
            section.raw("tip_relief", &format!("{{ shape = \"{shape}\", {lengths} }}"))
        }
    };
    section.number("crowning_mm", gears.crowning_mm).whole("points_per_tooth", gears.points_per_tooth);
    let rows = &gears.foundation;
    for (name, row) in [("L", rows.l), ("M", rows.m), ("P", rows.p), ("Q", rows.q)] {
        section.numbers(&format!("foundation.{name}"), &row);
    }
    section
}

fn operation(operation: &Operation) -> Section {
    let mut section = Section::new("operation");
    section
        .number("pinion_speed_hz", operation.pinion_speed_hz)
        .number("brake_torque_nm", operation.brake_torque_nm)
        .number("speed_fluctuation_hz", operation.speed_fluctuation_hz)
        .number("torque_fluctuation_nm", operation.torque_fluctuation_nm);
    profile(&mut section, "speed_profile_hz", operation.speed_profile_hz.as_ref());
    profile(&mut section, "torque_profile_nm", operation.torque_profile_nm.as_ref());
    section
}

fn profile(section: &mut Section, key: &str, profile: Option<&Profile>) {
    if let Some(profile) = profile {
        section
            .numbers(&format!("{key}.time_s"), &profile.time_s)
            .numbers(&format!("{key}.value"), &profile.value);
    }
}

fn quality(quality: &Quality) -> Section {
    let mut section = Section::new("quality");
    section.whole("din_grade", quality.din_grade);
    if let Some(seed) = quality.seed {
        section.whole("seed", seed);
    }
    if let Some(errors) = &quality.profile_errors {
        section
            .matrix("pinion_profile_errors_mm", &errors.pinion_profile_errors_mm)
            .matrix("gear_profile_errors_mm", &errors.gear_profile_errors_mm);
    }
    section
}

fn rig(rig: &Rig) -> Section {
    let mut section = Section::new("rig");
    section
        .number("bearing_stiffness_n_per_m", rig.bearing_stiffness_n_per_m)
        .number("wheel_rotational_stiffness_nm_per_rad", rig.wheel_rotational_stiffness_nm_per_rad)
        .number("brake_inertia_kgm2", rig.brake_inertia_kgm2);
    match &rig.damping_ratio {
        DampingRatio::Uniform(ratio) => section.number("damping_ratio", *ratio),
        DampingRatio::PerMode(ratios) => section.numbers("damping_ratio", ratios),
    };
    section.number("eccentricity_mm", rig.eccentricity_mm);
    shaft(&mut section, "pinion_shaft", &rig.pinion_shaft);
    shaft(&mut section, "gear_shaft", &rig.gear_shaft);
    inertia(&mut section, "pinion_inertia", &rig.pinion_inertia);
    inertia(&mut section, "gear_inertia", &rig.gear_inertia);
    section
}

fn shaft(section: &mut Section, key: &str, shaft: &Shaft) {
    section.table(key, &[("length_mm", shaft.length_mm), ("radius_mm", shaft.radius_mm)]);
}

fn inertia(section: &mut Section, key: &str, inertia: &WheelInertia) {
    let given: Vec<_> = [
        ("mass_kg", inertia.mass_kg),
        ("polar_inertia_kgm2", inertia.polar_inertia_kgm2),
        ("transverse_inertia_kgm2", inertia.transverse_inertia_kgm2),
    ]
    .into_iter()
    .filter_map(|(name, value)| value.map(|value| (name, value)))
    .collect();
    if !given.is_empty() {
        section.table(key, &given);
    }
}

fn solver(solver: &Solver) -> Section {
    let mut section = Section::new("solver");
    section
        .number("sampling_rate_hz", solver.sampling_rate_hz)
        .number("settle_fraction", solver.settle_fraction)
        .number("settle_tolerance", solver.settle_tolerance);
    for (key, state) in [
        ("initial_displacement", &solver.initial_displacement),
        ("initial_velocity", &solver.initial_velocity),
    ] {
        if let Some(values) = state {
            section.numbers(key, values);
        }
    }
    section
}
