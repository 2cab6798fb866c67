//! Values that no simulation can have: each is refused by its key, in words that say what is allowed.

use crate::support::{REQUIRED, appended, assert_refused, gears, replaced};
use meshtone::scenario::{
    DampingRatio, DestructionLine, Fault, GearPair, MEMORY_LIMIT_BYTES, MemoryLimit, Model, Profile,
    Scenario, ToothDestruction, WarningKind,
};
use meshtone::wheel::ErrorTable;

#[test]
fn gears_out_of_range() {
    for (old, new, key, line, words) in [
        ("3.0", "0", "gears.module_mm", 2, "must be more than 0 mm"),
        ("3.0", "-2.5", "gears.module_mm", 2, "-2.5: must be more than 0 mm"),
        ("3.0", "300", "gears.module_mm", 2, "at most 100 mm"),
        ("= 17", "= 5", "gears.pinion_teeth", 3, "from 6 to 10000 teeth"),
        ("= 38", "= 0", "gears.gear_teeth", 4, "from 6 to 10000 teeth"),
        ("= 38", "= 20000", "gears.gear_teeth", 4, "from 6 to 10000 teeth"),
        ("15.0", "0.0", "gears.face_width_mm", 5, "must be more than 0 mm"),
        ("15.0", "1e5", "gears.face_width_mm", 5, "at most 10000 mm"),
    ] {
        assert_refused(&replaced(old, new), key, line, &[words]);
    }
    for (keys, key, words) in [
        ("pressure_angle_deg = 5", "gears.pressure_angle_deg", "from 10° to 35°"),
        ("pressure_angle_deg = 40", "gears.pressure_angle_deg", "from 10° to 35°"),
        ("uniform_flank_reduction_mm = -0.1", "gears.uniform_flank_reduction_mm", "must be 0 mm or more"),
        (
            "uniform_flank_reduction_mm = 3",
            "gears.uniform_flank_reduction_mm",
            "less than 2.3562 mm, half the tooth's thickness",
        ),
        ("points_per_tooth = 499", "gears.points_per_tooth", "from 500 to 1000000"),
        ("points_per_tooth = 1000001", "gears.points_per_tooth", "from 500 to 1000000"),
    ] {
        assert_refused(&gears(keys), key, 6, &[words]);
    }
    let pointed = replaced("= 17", "= 6").replace("[operation]", "pressure_angle_deg = 35\n[operation]");
    assert_refused(&pointed, "gears.pressure_angle_deg", 6, &["6 teeth", "pointed", "more teeth"]);
    // The published model's relief does not fit small teeth.
    assert_refused(
        &format!("model = \"published\"\n{}", replaced("3.0", "0.4")),
        "gears.module_mm",
        3,
        &["thins all tips by 1 mm", "a larger module, or another model"],
    );
}

#[test]
fn undercut_is_a_warning() {
    let warned = |pinion, gear, angle| {
        let mut scenario =
            Scenario::new(GearPair { pinion_teeth: pinion, gear_teeth: gear, ..GearPair::example() });
        scenario.meshes[0].pressure_angle_deg = angle;
        let warnings = scenario.validate().unwrap();
        warnings.into_iter().map(|warning| (warning.key, warning.message)).collect::<Vec<_>>()
    };
    assert_eq!(warned(17, 38, 20.0), []);
    assert_eq!(warned(12, 38, 25.0), []);
    let pinion = warned(16, 38, 20.0);
    assert_eq!(pinion.len(), 1);
    assert_eq!(pinion[0].0, "gears.pinion_teeth");
    assert!(pinion[0].1.contains("16 teeth are undercut") && pinion[0].1.contains("at least 17 teeth"));
    assert_eq!(warned(10, 12, 20.0).len(), 2);
}

#[test]
fn operation_out_of_range() {
    for (old, new, key, line, words) in [
        ("40.0", "0", "operation.pinion_speed_hz", 7, "must be more than 0 rev/s"),
        ("40.0", "1e6", "operation.pinion_speed_hz", 7, "at most 100000 rev/s"),
        ("10.0", "-1e10", "operation.brake_torque_nm", 8, "must be from -1e9 N m to 1e9 N m"),
        ("10.0", "1e10", "operation.brake_torque_nm", 8, "must be from -1e9 N m to 1e9 N m"),
    ] {
        assert_refused(&replaced(old, new), key, line, &[words]);
    }
    for (keys, key, words) in [
        ("speed_fluctuation_hz = -1", "speed_fluctuation_hz", "must be 0 Hz or more"),
        ("speed_fluctuation_hz = 40", "speed_fluctuation_hz", "less than the speed that it varies, 40.0 Hz"),
        ("torque_fluctuation_nm = -1", "torque_fluctuation_nm", "must be 0 N m or more"),
        (
            "torque_fluctuation_nm = 11",
            "torque_fluctuation_nm",
            "less than the torque that it varies, 10.0 N m",
        ),
        (
            "speed_profile_hz = { time_s = [0], value = [1] }",
            "speed_profile_hz",
            "has 1 points; must have at least 2",
        ),
        (
            "speed_profile_hz = { time_s = [0, 1], value = [1] }",
            "speed_profile_hz",
            "has 2 times and 1 values",
        ),
        (
            "speed_profile_hz = { time_s = [0, 0], value = [1, 1] }",
            "speed_profile_hz.time_s[1]",
            "times increase",
        ),
        (
            "speed_profile_hz = { time_s = [0, 1], value = [1, 0] }",
            "speed_profile_hz.value[1]",
            "more than 0 rev/s",
        ),
        (
            "torque_profile_nm = { time_s = [0, 1], value = [-1, 0] }",
            "torque_profile_nm.value[0]",
            "0 N m or more",
        ),
    ] {
        assert_refused(&appended(keys), &format!("operation.{key}"), 9, &[words]);
    }
    let below_profile = "speed_fluctuation_hz = 30\nspeed_profile_hz = { time_s = [0, 1], value = [20, 40] }";
    assert_refused(&appended(below_profile), "operation.speed_fluctuation_hz", 9, &["20.0 Hz"]);
    assert!(Scenario::from_toml(&replaced("10.0", "0")).is_ok(), "an idle brake is allowed");
}

#[test]
fn faults_out_of_range() {
    let breakage = |height, width, loss| {
        format!(
            "kind = \"tooth-breakage\"\nchip_height_mm = {height}\nchip_width_mm = {width}\ntip_loss_mm = {loss}"
        )
    };
    let partial = |width, start, end, depth| {
        format!("kind = \"partial-face\"\nwidth_mm = {width}\nstart = {start}\nend = {end}\ndepth = {depth}")
    };
    let circle = |x, y, radius| {
        format!("kind = \"through-face\"\ncircle = {{ x_mm = {x}, y_mm = {y}, radius_mm = {radius} }}")
    };
    let destruction = |start, line: &str| format!("kind = \"tooth-destruction\"\nstart = {start}\n{line}");
    for (keys, key, line, words) in [
        (breakage("0", "12", "3"), "chip_height_mm", 11, "more than 0 mm"),
        (breakage("7", "12", "3"), "chip_height_mm", 11, "less than 6.7500 mm, the tooth's height"),
        (breakage("5", "0", "3"), "chip_width_mm", 12, "more than 0 mm"),
        (breakage("5", "15.5", "3"), "chip_width_mm", 12, "at most 15 mm, the face width"),
        (breakage("5", "12", "-1"), "tip_loss_mm", 13, "0 mm or more"),
        (breakage("5", "12", "6.8"), "tip_loss_mm", 13, "less than 6.7500 mm"),
        (partial("0", "0.2", "0.8", "0.5"), "width_mm", 11, "more than 0 mm"),
        (partial("15", "0.2", "0.8", "0.5"), "width_mm", 11, "\"through-face\""),
        (partial("2", "-0.1", "0.8", "0.5"), "start", 12, "from 0 to less than 1"),
        (partial("2", "1", "0.8", "0.5"), "start", 12, "from 0 to less than 1"),
        (partial("2", "0.8", "0.2", "0.5"), "end", 13, "more than fault.start, 0.8, and at most 1"),
        (partial("2", "0.8", "0.8", "0.5"), "end", 13, "more than fault.start"),
        (partial("2", "0.2", "1.1", "0.5"), "end", 13, "at most 1"),
        (partial("2", "0.2", "0.8", "0"), "depth", 14, "more than 0 and at most 1"),
        (partial("2", "0.2", "0.8", "1.5"), "depth", 14, "more than 0 and at most 1"),
        (circle("-57", "3", "2"), "circle.x_mm", 11, "more than 0 mm"),
        (circle("57", "3", "0"), "circle.radius_mm", 11, "more than 0 mm"),
        (destruction("-1", "end = 0.5"), "start", 11, "more than -1 and less than 1"),
        (destruction("1", "end = 1"), "start", 11, "more than -1 and less than 1"),
        (destruction("0.5", "end = 0.4"), "end", 12, "more than fault.start, 0.5"),
        (destruction("0.5", "end = 1.2"), "end", 12, "at most 1"),
        (destruction("0.5", "slope_deg = 0"), "slope_deg", 12, "more than 0° and less than 90°"),
        (destruction("0.5", "slope_deg = 90"), "slope_deg", 12, "more than 0° and less than 90°"),
        (destruction("0.5", "end = 0.9\noffset_mm = -1"), "offset_mm", 13, "0 mm or more"),
        (destruction("0.5", "end = 0.9\noffset_mm = 3"), "offset_mm", 13, "less than 2.3562 mm"),
        (destruction("0.5", "end = 0.9\nnoise_mm = -1"), "noise_mm", 13, "0 mm or more"),
    ] {
        assert_refused(&appended(&format!("[fault]\n{keys}")), &format!("fault.{key}"), line, &[words]);
    }
}

#[test]
fn rig_and_solver_out_of_range() {
    let modes = "damping_ratio = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]";
    for (keys, key, words) in [
        ("bearing_stiffness_n_per_m = 0", "bearing_stiffness_n_per_m", "more than 0 N/m"),
        (
            "wheel_rotational_stiffness_nm_per_rad = -1",
            "wheel_rotational_stiffness_nm_per_rad",
            "more than 0 N m/rad",
        ),
        ("brake_inertia_kgm2 = 0", "brake_inertia_kgm2", "more than 0 kg m²"),
        ("damping_ratio = 5", "damping_ratio", "from 0 to less than 1"),
        ("damping_ratio = -0.1", "damping_ratio", "0.05, which is 5 %"),
        (modes, "damping_ratio[12]", "from 0 to less than 1"),
        ("eccentricity_mm = -0.1", "eccentricity_mm", "0 mm or more"),
        ("eccentricity_mm = 3", "eccentricity_mm", "less than 3.0000 mm, the module"),
        ("pinion_shaft = { length_mm = 0 }", "pinion_shaft.length_mm", "more than 0 mm"),
        (
            "pinion_shaft = { radius_mm = 22 }",
            "pinion_shaft.radius_mm",
            "less than 21.7500 mm, the root radius",
        ),
        ("gear_shaft = { radius_mm = 0 }", "gear_shaft.radius_mm", "more than 0 mm"),
        ("pinion_inertia = { mass_kg = 0 }", "pinion_inertia.mass_kg", "more than 0 kg"),
        (
            "gear_inertia = { polar_inertia_kgm2 = -1 }",
            "gear_inertia.polar_inertia_kgm2",
            "more than 0 kg m²",
        ),
        (
            "gear_inertia = { transverse_inertia_kgm2 = 0 }",
            "gear_inertia.transverse_inertia_kgm2",
            "more than 0",
        ),
    ] {
        assert_refused(&appended(&format!("[rig]\n{keys}")), &format!("rig.{key}"), 10, &[words]);
    }
    for (keys, key, words) in [
        ("sampling_rate_hz = 0", "sampling_rate_hz", "more than 0 S/s"),
        ("settle_fraction = -0.1", "settle_fraction", "from 0 to less than 1"),
        ("settle_fraction = 1", "settle_fraction", "from 0 to less than 1"),
        (
            "settle_tolerance = -1e-6",
            "settle_tolerance",
            "must be from 0 (the whole settling is simulated) to less than 1",
        ),
        ("settle_tolerance = 1", "settle_tolerance", "to less than 1"),
    ] {
        assert_refused(&appended(&format!("[solver]\n{keys}")), &format!("solver.{key}"), 10, &[words]);
    }
}

#[test]
fn values_that_only_code_can_give() {
    let base = Scenario::new(GearPair::example());
    let refused = |change: &dyn Fn(&mut Scenario)| {
        let mut scenario = base.clone();
        change(&mut scenario);
        let error = scenario.validate().unwrap_err();
        assert_eq!(error.line, None);
        (error.key, error.problem)
    };
    let not_a_number = "must be a finite number";
    for (change, key, words) in [
        (
            (&|s: &mut Scenario| s.meshes[0].module_mm = f64::NAN) as &dyn Fn(&mut Scenario),
            "gears.module_mm",
            not_a_number,
        ),
        (&|s| s.operation.brake_torque_nm = f64::INFINITY, "operation.brake_torque_nm", not_a_number),
        (&|s| s.meshes[0].foundation.m[2] = f64::NAN, "gears.foundation.M[2]", not_a_number),
        (&|s| s.solver.initial_velocity = Some([f64::NAN; 13]), "solver.initial_velocity[0]", not_a_number),
        (
            &|s| s.rig_mut().unwrap().damping_ratio = DampingRatio::Uniform(f64::NAN),
            "rig.damping_ratio",
            not_a_number,
        ),
        (
            &|s| s.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 13),
            "quality.din_grade",
            "from 1 (best) to 12",
        ),
    ] {
        let (found, problem) = refused(change);
        assert_eq!(found, key);
        assert!(problem.contains(words), "{problem}");
    }
    let times = Profile { time_s: vec![0.0, f64::NAN, 2.0], value: vec![40.0; 3] };
    let (key, problem) = refused(&|s| s.operation.speed_profile_hz = Some(times.clone()));
    assert_eq!((key.as_str(), problem.as_str()), ("operation.speed_profile_hz.time_s[1]", not_a_number));
    let slope = DestructionLine::SlopeDeg(f64::NAN);
    let destruction = ToothDestruction { start: 0.1, line: slope, offset_mm: 0.0, noise_mm: 0.0 };
    let (key, _) = refused(&|s| s.faults = vec![Fault::on_first_gear_tooth(destruction)]);
    assert_eq!(key, "fault.slope_deg");
}

#[test]
fn transposed_profile_errors_are_recognised() {
    let mut scenario = Scenario::new(GearPair::example());
    scenario.wheels[0].profile_errors_mm = Some(ErrorTable::filled(17, 100, 0.0));
    scenario.wheels[1].profile_errors_mm = Some(ErrorTable::filled(100, 38, 0.0));
    let error = scenario.validate().unwrap_err();
    assert_eq!(error.key, "quality.pinion_profile_errors_mm");
    assert_eq!(error.value, "17 × 100");
    assert!(error.problem.contains("is 17 × 100; must be 100 × 17"), "{error}");
    assert!(error.help.unwrap().contains("transposed"));
}

#[test]
fn sampling_rates() {
    let healthy = Scenario::new(GearPair::example());
    let destruction = Scenario::new(GearPair {
        module_mm: 3.0,
        pinion_teeth: 18,
        gear_teeth: 35,
        face_width_mm: 30.0,
        pinion_speed_hz: 45.0,
        brake_torque_nm: 15.0,
    });
    // A whole number of samples for a pitch: 148 and 124.
    assert_eq!(healthy.actual_sampling_rate_hz(), 100_640.0);
    assert_eq!(destruction.actual_sampling_rate_hz(), 100_440.0);
    let published = |mut scenario: Scenario| {
        scenario.model = Model::Published;
        scenario
    };
    assert_eq!(published(healthy).actual_sampling_rate_hz(), 258_400.0);
    assert_eq!(published(destruction).actual_sampling_rate_hz(), 283_500.0);
}

#[test]
fn simulations_too_large_for_memory() {
    let words = ["GiB of memory", "at most 8.0 GiB", "lower it"];
    let text = appended("[solver]\nsampling_rate_hz = 1e12");
    assert_refused(&text, "solver.sampling_rate_hz", 10, &words);

    let scenario = Scenario::from_toml(REQUIRED).unwrap();
    let needed = scenario.memory_estimate_bytes();
    // 95 608 kept samples of 8 signals are 6.1 MB; nothing else is much larger.
    assert!((6_100_000..60_000_000).contains(&needed), "{needed}");
    assert!(needed < MEMORY_LIMIT_BYTES);
    assert!(scenario.validate_within(MemoryLimit::Given { bytes: needed }).is_ok());
    let error = scenario.validate_within(MemoryLimit::Given { bytes: needed - 1 }).unwrap_err();
    assert!(error.problem.contains("would need 24."), "{error}");
}

/// The key that is blamed is one that stands in the file, and the one that helps most.
#[test]
fn what_makes_a_simulation_too_large() {
    let line_of = |key: &str| 1 + REQUIRED.lines().position(|line| line.starts_with(key)).unwrap();
    let speed_line = line_of("pinion_speed_hz");
    let slow = replaced("40.0", "1e-9");
    assert_refused(&slow, "operation.pinion_speed_hz", speed_line, &["GiB of memory", "raise it", "76 rev"]);
    let slow_and_fine = format!("{slow}[solver]\nsampling_rate_hz = 1e6\n");
    assert_refused(&slow_and_fine, "operation.pinion_speed_hz", speed_line, &["raise it"]);
    let long = appended("[operation.speed_profile_hz]\ntime_s = [0.0, 1e6]\nvalue = [40.0, 41.0]");
    assert_refused(&long, "operation.speed_profile_hz", 9, &["shorten the profile", "1000000.0 s"]);
    let many = replaced("17", "9999").replace("38", "9998");
    assert_refused(&many, "gears.gear_teeth", line_of("gear_teeth"), &["common factor", "99970002"]);
}

/// Each tooth that something is drawn for has a table with each that it meets.
#[test]
fn drawn_teeth_of_both_wheels_need_memory() {
    let text = |noise_mm: f64| {
        let of = |wheel: &str| {
            format!(
                "[[fault]]\nkind = \"tooth-destruction\"\nwheel = \"{wheel}\"\ntooth = \"all\"\nstart = 0.2\nend = 0.9\nnoise_mm = {noise_mm:?}\n"
            )
        };
        format!("{REQUIRED}{}{}", of("pinion"), of("gear")).replace("17", "61").replace("38", "63")
    };
    let [alike, drawn] = [0.0, 0.001].map(|noise_mm| Scenario::from_toml(&text(noise_mm)).unwrap());
    let [of_alike, of_drawn] = [&alike, &drawn].map(Scenario::memory_estimate_bytes);
    println!("{of_alike} and {of_drawn} bytes");
    assert!(of_drawn > of_alike + 150_000_000 && of_drawn < of_alike + 1_200_000_000);
    let error = drawn.validate_within(MemoryLimit::Given { bytes: of_alike }).unwrap_err();
    let help = error.help.as_deref().unwrap_or_default();
    assert!(
        error.key == "fault" && help.contains("fewer teeth") && help.contains("3844 in all"),
        "{error}, {help}"
    );
}

/// Supports are given by frequencies or by stiffnesses; a file of former stiffnesses is told what it has of former defaults.
#[test]
fn supports_by_frequencies_or_by_stiffnesses() {
    let both = "[rig]\nsupport = { base_hz = 450.0, stiffness_n_per_m = 1e8 }";
    let error =
        assert_refused(&appended(both), "rig.support.stiffness_n_per_m", 10, &["given beside base_hz"]);
    assert_eq!(error.help.as_deref(), Some("remove base_hz, or remove stiffness_n_per_m"));
    let both = "[rig]\nsupport = { coupling_n_per_m = 1e8, differential_hz = 2900.0 }";
    assert_refused(&appended(both), "rig.support.coupling_n_per_m", 10, &["given beside differential_hz"]);
    for differential_hz in ["450.0", "300.0"] {
        let text = format!("[rig]\nsupport = {{ differential_hz = {differential_hz} }}");
        let words = ["must be more than base_hz, 450.0 Hz"];
        assert_refused(&appended(&text), "rig.support.differential_hz", 10, &words);
    }
    let notes = |keys: &str| {
        let text = appended(&format!("[rig]\nsupport = {{ {keys} }}"));
        let warnings = Scenario::from_toml(&text).unwrap().validate().unwrap();
        let former = warnings.into_iter().filter(|warning| warning.kind == WarningKind::FormerDefaults);
        former.map(|warning| warning.to_string()).collect::<Vec<_>>()
    };
    let [note] = &notes("stiffness_n_per_m = 2e8")[..] else { panic!("not one note") };
    assert!(note.contains("mass_kg = 1.6, coupling_n_per_m = 5e8,"), "{note}");
    assert!(notes("mass_kg = 2.0, stiffness_n_per_m = 2e8, coupling_n_per_m = 4e8").is_empty());
    assert!(notes("base_hz = 500.0").is_empty());
}

/// Keys of housing modes that no mode would show are refused.
#[test]
fn housing_modes_without_effect() {
    for (path, key, words) in [
        ("modes_per_khz = 2.0", "sensor.path.strength", "without effect"),
        ("seed = 3", "sensor.path.strength", "without effect"),
        ("strength = 0.2, band_hz = [3500.0, 3600.0]", "sensor.path.band_hz", "holds no mode"),
    ] {
        let text = appended(&format!("[[sensor]]\npath = {{ {path} }}"));
        assert_refused(&text, key, 10, &[words]);
    }
    let text = appended("[[sensor]]\npath = { plate_hz = 0.0, strength = 0.2, seed = 3 }");
    assert!(Scenario::from_toml(&text).is_ok());
}
