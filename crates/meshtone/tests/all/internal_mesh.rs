//! A planet in a ring with internal teeth, beside the sun with that planet: against an independent simulator (see `tests/planetary/README.md`),
//! closed forms and limits.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::PI;
use std::fs::File;
use std::path::PathBuf;

use crate::physics::*;
use meshtone::damage::{Fault, FaultFlank, MissingTooth};
use meshtone::scenario::{
    BodyRotation, FoundationCoefficients, Gears, Material, MaterialConstants, WheelName,
};
use meshtone::stiffness::{FlankLoad, LoadedFlank};
use meshtone::wheel::{Mounting, Teeth, Wheel, teeth};
use ndarray::{Array1, OwnedRepr};
use ndarray_npy::NpzReader;

const POISSON: f64 = 0.3;
const E_MPA: f64 = 206e3;

/// The sun with its planet, and the planet in its ring, as the independent simulator has them.
fn meshes(module_mm: f64, [sun, planet, ring]: [u32; 3], face_width_mm: f64) -> [(Gears, Teeth); 2] {
    [(sun, planet, false), (planet, ring, true)].map(|(pinion, gear, internal)| {
        let mut gears = Gears::new(module_mm, pinion, gear, face_width_mm);
        gears.internal = internal;
        gears.foundation = with_rotation_in_teeth();
        gears.material = Material::Given(MaterialConstants {
            youngs_modulus_gpa: E_MPA * 1e-3,
            poisson_ratio: POISSON,
            density_kg_per_m3: 7850.0,
        });
        let teeth = teeth(&gears, [pinion, gear].map(|teeth| f64::from(teeth) * module_mm / 4.0));
        (gears, teeth)
    })
}

/// (N/m) Stiffness of all pairs on their path at 400 positions of a base pitch.
fn stiffness_n_per_m((gears, teeth): &(Gears, Teeth)) -> Vec<f64> {
    let pairs = sound_pairs(gears, teeth);
    let at = |point: i32| {
        let positions = (0..3).map(|pair| f64::from(point) / 400.0 + f64::from(pair));
        let on_path = positions.filter(|position| *position < teeth.path.contact_ratio);
        on_path.map(|position| pairs.at(&SOUND_PAIR, position).stiffness_n_per_mm * 1e3).sum()
    };
    (0..400).map(at).collect()
}

#[test]
fn paths_of_four_sets_as_computed_elsewhere() {
    for (teeth, contact_ratios, pitch_points) in [
        ([19, 31, 81], [1.602242, 1.939677], [0.830369, 1.109308]),
        ([28, 36, 100], [1.665225, 1.927671], [0.846223, 1.081448]),
        ([21, 36, 93], [1.630789, 1.936254], [0.846223, 1.090030]),
        ([24, 27, 78], [1.615783, 1.930206], [0.814832, 1.115374]),
    ] {
        for (n, (gears, teeth)) in meshes(1.0, teeth, 10.0).into_iter().enumerate() {
            assert!(
                (teeth.path.contact_ratio - contact_ratios[n]).abs() < 5e-7,
                "{}",
                teeth.path.contact_ratio
            );
            assert!((teeth.pitch_point() - pitch_points[n]).abs() < 5e-7, "{}", teeth.pitch_point());
            assert!((gears.contact_ratio() - teeth.path.contact_ratio).abs() < 1e-12);
            assert!((teeth.contact.contact_ratio - teeth.path.contact_ratio).abs() < 1e-12);
        }
    }
}

// Where the ring is touched near its root the load meets the tooth's centre line below the root: the other simulator takes 0 for the lever
// of the half plane there, in place of one below 0.
#[test]
fn stiffness_over_a_base_pitch_as_computed_elsewhere() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../meshtone/tests/planetary/stiffness.npz");
    let mut npz = NpzReader::new(File::open(path).unwrap()).unwrap();
    let meshes = meshes(3.2, [19, 31, 81], 38.1);
    for (name, mesh, tolerance) in [("k_sun_n_per_m", &meshes[0], 1e-5), ("k_ring_n_per_m", &meshes[1], 2e-3)]
    {
        let expected: Array1<f64> = npz.by_name::<OwnedRepr<f64>, _>(name).unwrap();
        let computed = stiffness_n_per_m(mesh);
        let [least, most] = [f64::min as fn(f64, f64) -> f64, f64::max]
            .map(|pick| computed.iter().copied().reduce(pick).unwrap() * 1e-6);
        println!("{name}: {least:.1}, {:.1}, {most:.1} kN/mm", mean(&computed) * 1e-6);
        assert_close(name, tolerance, computed.iter().copied().zip(expected.iter().copied()));
        assert_close("mean", tolerance / 5.0, [(mean(&computed), expected.mean().unwrap())]);
    }
}

#[test]
fn stiffest_pair_as_computed_elsewhere() {
    for ((gears, teeth), expected) in meshes(1.0, [21, 36, 93], 1.0).iter().zip([15.24, 18.00]) {
        let pairs = sound_pairs(gears, teeth);
        let at = |n: i32| {
            let position = teeth.path.contact_ratio * f64::from(n) / 1000.0;
            pairs.at(&SOUND_PAIR, position).stiffness_n_per_mm
        };
        // Per mm of face and µm.
        let stiffest = largest((0..=1000).map(at)) * 1e-3;
        println!("{stiffest:.3} N/(mm µm)");
        assert!((stiffest - expected).abs() < 5e-3, "{stiffest} {expected}");
    }
}

/// (mm/N) What a half plane yields under a tooth, by Cornell.
fn half_plane_mm_per_n(teeth: &Teeth, wheel: WheelName, load: &FlankLoad) -> f64 {
    let profile = teeth.profile(wheel);
    let (tan, width_mm) = (load.sin / load.cos, load.width_mm);
    let lever = (load.point.x_mm - profile.x_mm[0] - load.point.y_mm * tan) / (2.0 * profile.y_mm[0]);
    let plane = 1.0 - POISSON * POISSON;
    let sum = 5.306 * lever * lever
        + 2.0 * (1.0 - POISSON) / plane * lever
        + 1.534 * (1.0 + 0.4167 * tan * tan / (1.0 + POISSON));
    load.cos * load.cos * plane / (E_MPA * width_mm) * sum
}

// Of many teeth a wheel and a ring are the same rack, whose tooth bends alike. What is below the tooth is another model's, the half plane's or
// Sainsot's, which is stated for up to some 300 teeth: at 200 they make pairs alike within 16 %.
#[test]
fn a_ring_of_many_teeth_is_a_rack() {
    let of_teeth = |many: u32, internal: bool| {
        let mut gears = Gears::new(3.0, 31, many, 20.0);
        gears.internal = internal;
        gears.material = meshes(3.0, [19, 31, 81], 20.0)[0].0.material;
        let bore_mm = 1.5 * f64::from(many) / 1.4;
        let teeth = teeth(&gears, [10.0, bore_mm]);
        let pitch_point = teeth.pitch_point();
        let flank = teeth.flank(WheelName::Gear);
        let point = flank.at_curvature(teeth.path.curvature_mm(WheelName::Gear, pitch_point));
        let load = FlankLoad { point, sin: point.load_sin, cos: point.load_cos, z_mm: 0.0, width_mm: 20.0 };
        if !internal {
            // A half plane in place of the polynomials for a solid wheel.
            let plane = 1.0 - POISSON * POISSON;
            let constant = |value: f64| [0.0, 0.0, 0.0, 0.0, 0.0, value];
            let foundation = &mut gears.foundation;
            (foundation.l, foundation.m) = (constant(5.306 * plane), constant(2.0 * (1.0 - POISSON)));
            (foundation.p, foundation.q) = (constant(1.534 * plane), constant(0.4167 / (1.0 + POISSON)));
            foundation.rotation = BodyRotation::Tooth;
        }
        let tooth = LoadedFlank::new(flank, None, gears.material, &gears.foundation);
        let bends = tooth.compliance_mm_per_n(&load) - half_plane_mm_per_n(&teeth, WheelName::Gear, &load);
        gears.foundation = FoundationCoefficients::default();
        let stiffness = sound_pairs(&gears, &teeth).at(&SOUND_PAIR, pitch_point).stiffness_n_per_mm;
        [bends, stiffness, teeth.path.contact_ratio, pitch_point]
    };
    for many in [1_000, 10_000, 100_000] {
        // Of first order in the curvature of the pitch circle.
        let tolerance = 20.0 / f64::from(many);
        let [wheel, ring] = [false, true].map(|internal| of_teeth(many, internal));
        assert_close("bending", tolerance, [(ring[0], wheel[0])]);
        assert_close("path", tolerance, [(ring[2], wheel[2]), (ring[3], wheel[3])]);
    }
    let [wheel, ring] = [false, true].map(|internal| of_teeth(200, internal));
    assert_close("pair", 0.16, [(ring[1], wheel[1])]);
}

// The spaces of a ring are the teeth of a wheel: its own teeth fill what these leave, at any radius, and planet and ring fill the pitch
// on the circles that roll on one another.
#[test]
fn teeth_of_a_ring_fill_what_those_of_a_wheel_leave() {
    let involute = |angle: f64| angle.tan() - angle;
    for (shifts, closer_mm) in [([0.0, 0.0], 0.0), ([0.4, 0.2], 0.0), ([-0.1, 0.3], 0.05), ([0.2, 0.2], 0.1)]
    {
        let mut gears = Gears::new(3.0, 31, 81, 20.0);
        (gears.internal, [gears.pinion_profile_shift, gears.gear_profile_shift]) = (true, shifts);
        let tight = Mounting::new(&gears);
        gears.centre_distance_mm = Some(tight.centre_distance_mm - closer_mm);
        let mounting = Mounting::new(&gears);
        let teeth = teeth(&gears, [20.0; 2]);
        let (ring, x) = (&teeth.gear, shifts[1]);
        assert!((ring.tip_radius_mm - (121.5 - 3.0 * (1.0 - x))).abs() < 1e-12);
        assert!((ring.root_radius_mm - (121.5 + 3.0 * (1.25 + x))).abs() < 1e-12);
        let profile = &teeth.gear_profile;
        assert!(profile.x_mm.windows(2).all(|pair| pair[0] < pair[1]));
        assert!((profile.radius_mm(0) - ring.root_radius_mm).abs() < 1e-9);
        for (x_mm, y_mm) in profile.x_mm.iter().zip(&profile.y_mm) {
            let radius_mm = x_mm.hypot(*y_mm);
            let alpha = 20f64.to_radians();
            let half = PI / 162.0 - 2.0 * x * alpha.tan() / 81.0 - involute(alpha)
                + involute((ring.base_radius_mm / radius_mm).acos());
            assert!((y_mm.atan2(-x_mm) - half).abs() < 1e-11, "{radius_mm}");
        }

        let thickness = |wheel: &Wheel| {
            let radius_mm = wheel.working_pitch_radius_mm;
            2.0 * radius_mm * wheel.half_thickness_angle_at_rad(radius_mm)
        };
        let distance_mm = ring.working_pitch_radius_mm - teeth.pinion.working_pitch_radius_mm;
        assert!((distance_mm - mounting.centre_distance_mm).abs() < 1e-11);
        let pitch_mm = 2.0 * PI * ring.working_pitch_radius_mm / 81.0;
        let gap_mm =
            (pitch_mm - thickness(ring) - thickness(&teeth.pinion)) * ring.working_pressure_angle_rad.cos();
        println!("{shifts:?}, {closer_mm} mm closer: gap {gap_mm:.6} mm");
        assert!((gap_mm - mounting.opened_backlash_mm).abs() < 1e-10, "{gap_mm} {mounting:?}");
        assert_eq!(gap_mm > 1e-6, closer_mm > 0.0);
    }
}

#[test]
fn a_fault_of_a_pair_has_no_flank() {
    assert_eq!(Fault::on_first_gear_tooth(MissingTooth).flank, None);
    assert_eq!([FaultFlank::Sun, FaultFlank::default()].map(FaultFlank::name), ["sun", "both"]);
    let fault = crate::support::appended("[fault]\nkind = \"missing-tooth\"\nflank = \"sun\"");
    crate::support::assert_refused(&fault, "fault.flank", 11, &["unknown"]);
}
