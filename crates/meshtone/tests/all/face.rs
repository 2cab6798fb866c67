//! Helical teeth whose contact lines leave their path: against spur teeth, which are their limit, against an independent simulator, and in
//! any number of slices (see `tests/face/README.md`).
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::PI;
use std::fs::File;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use meshtone::mesh::Mesh;
use meshtone::scenario::*;
use meshtone::{simulate, stages};
use ndarray::{Array2, OwnedRepr};
use ndarray_npy::NpzReader;

use crate::physics::rms;

/// What the independent simulator was given, for a short time.
fn pair(helix_angle_deg: f64) -> Scenario {
    let mut scenario = Scenario::new(GearPair::example());
    let mesh = &mut scenario.meshes[0];
    (mesh.helix_angle_deg, mesh.points_per_tooth, mesh.damping_ratio) = (helix_angle_deg, 2000, 0.15);
    for wheel in &mut scenario.wheels {
        (wheel.tip_chamfer_mm, wheel.active_profile_shortening, wheel.din_grade) = (Some(0.69), 0.1, 0);
    }
    scenario.solver.duration_s = Some(0.15);
    scenario
}

/// (g) Rms of the vertical acceleration, by kind: ideal wheels, such with deviations but no helix slope, a missing tooth, a tooth that has
/// lost its tip, and a deep crack.
fn vertical_g(kind: &str, helix_angle_deg: f64) -> f64 {
    let mut scenario = pair(helix_angle_deg);
    let broken = ToothBreakage { chip_height_mm: 2.4, chip_width_mm: 15.0, tip_loss_mm: 2.4 };
    let damage: Option<Damage> = match kind {
        "missing" => Some(MissingTooth.into()),
        "broken" => Some(broken.into()),
        "cracked" => Some(RootCrack { depth_mm: 3.0, angle_deg: 45.0, length_mm: None }.into()),
        "deviating" => {
            scenario.wheels.iter_mut().for_each(|wheel| (wheel.din_grade, wheel.helix_share) = (7, 0.0));
            None
        }
        _ => None,
    };
    scenario.faults = damage.map(Fault::on_first_gear_tooth).into_iter().collect();
    rms(&simulate(&scenario).unwrap().channels["vertical_g"])
}

/// Ratios to spur teeth: the same at 0.01 and 0.1°, and at 1° those of the independent simulator, where the overlap of 0.03 base pitches is as
/// long as a corner reaches.
#[test]
fn helical_ends_meet_spur_ends() {
    for (kind, at_one_degree) in [
        ("ideal", 0.0743 / 0.0801),
        ("deviating", 0.581 / 0.605),
        ("missing", 5.625 / 5.635),
        ("broken", 1.459 / 1.669),
        ("cracked", 0.0752 / 0.0811),
    ] {
        let spur = vertical_g(kind, 0.0);
        for (angle, expected, tolerance) in [(0.01, 1.0, 5e-3), (0.1, 1.0, 1e-2), (1.0, at_one_degree, 0.1)] {
            let ratio = vertical_g(kind, angle) / spur;
            println!("{kind}, {angle}°: {ratio:.4} of {spur:.4} g, expected {expected:.4}");
            assert!((ratio / expected - 1.0).abs() < tolerance, "{kind} {angle}: {ratio} {expected}");
        }
    }
}

/// The steeper the helix, the quieter: ideal wheels step up by at most 6 % from one angle to the next.
#[test]
fn ideal_wheels_grow_quieter_with_the_helix() {
    for kind in ["ideal", "missing", "broken"] {
        let of = [0.0, 1.0, 5.0, 10.0, 20.0, 30.0].map(|angle| vertical_g(kind, angle));
        println!("{kind}: {of:.4?}");
        assert!(of.windows(2).all(|two| two[1] < 1.06 * two[0]), "{kind}: {of:?}");
    }
}

fn mesh(scenario: &Scenario) -> Mesh {
    stages(scenario).unwrap().meshes_at(NonZeroUsize::new(200).unwrap()).unwrap().swap_remove(0)
}

/// Contact lines in any number of slices are the whole contact line, also where most of the load is on corners; a single one is exact.
#[test]
fn slices_add_up_to_the_whole_contact_line() {
    for angle in [1.0, 10.0, 25.0] {
        let whole = mesh(&pair(angle));
        assert_eq!(whole.slices(), 1);
        for slices in [5, 41] {
            let mut scenario = pair(angle);
            // Flat to the last place.
            (scenario.meshes[0].slices, scenario.meshes[0].lead_crowning_um) = (slices, 1e-13);
            let sliced = mesh(&scenario);
            assert_eq!(sliced.slices(), slices as usize);
            for force_n in [20.0, 187.0, 5000.0] {
                let [one, other] = [&whole, &sliced].map(|mesh| mesh.at_rest(force_n, 0..1).deflection_m);
                let apart = one.iter().zip(&other).map(|(one, other)| (one / other - 1.0).abs());
                let apart = apart.fold(0.0, f64::max);
                assert!(apart < 1e-12, "{angle}° in {slices} slices under {force_n} N: {apart:e}");
            }
        }
    }
}

/// With a whole-number overlap all contact lines together are the same at any time, with what lies outside the path.
#[test]
fn a_whole_overlap_gives_way_alike_at_any_time() {
    for overlap in [1.0, 2.0] {
        let mut scenario = pair(20.0);
        let face_width_mm = overlap * PI * 3.0 / 20f64.to_radians().sin();
        scenario.wheels.iter_mut().for_each(|wheel| wheel.face_width_mm = face_width_mm);
        let at_rest = mesh(&scenario).at_rest(5000.0, 0..1);
        let part = at_rest.peak_to_peak_m() / at_rest.deflection_m[0];
        println!("overlap {overlap}: {part:.1e} of {:.3e} m", at_rest.deflection_m[0]);
        assert!(part < 1e-12, "{overlap}: {part:e}");
    }
}

/// The ends of the path and the corners' separation beyond them, of sound teeth at 10°.
#[test]
fn corners_are_those_of_an_independent_simulator() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../meshtone/tests/face/face.npz");
    let mut npz = NpzReader::new(File::open(path).unwrap()).unwrap();
    let mut array = |name: &str| -> Array2<f64> { npz.by_name::<OwnedRepr<f64>, _>(name).unwrap() };
    let (ends, separation_m) = (array("b10_ends"), array("b10_S_m"));
    let mesh = mesh(&pair(10.0));
    let corners = &mesh.classes[0].corners[0];
    // Its positions: from −0.6 base pitches on, in steps of 0.0005.
    let position = |n: usize| -0.6 + 0.0005 * n as f64;
    for (end, corner) in corners.iter().enumerate() {
        assert!((corner.place - ends[[0, end]]).abs() < 2e-3, "{} {}", corner.place, ends[[0, end]]);
        let outside = |n: &usize| [ends[[0, 0]] - position(*n), position(*n) - ends[[0, 1]]][end];
        for n in (0..separation_m.ncols()).filter(|n| (0.005..0.25).contains(&outside(n))).step_by(7) {
            let v = separation_m[[0, n]].sqrt();
            let reach: f64 = corner.reach.coefficients.iter().zip(1..).map(|(a, j)| a * v.powi(j)).sum();
            assert!((reach / outside(&n) - 1.0).abs() < 1e-3, "end {end}: {reach} {}", outside(&n));
        }
    }
}
