//! The machine of a gearbox against an independent finite element model and ROSS (see `tests/gearbox/README.md`).
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::fs::File;
use std::path::PathBuf;

use meshtone::machine::{
    Bearing, Coupled, Disc, GearboxMachine, GearboxParts, GearboxShaft, Housing, HousingModes, Machine,
    MeshLine, SeatedBearing, WheelBody,
};
use meshtone::scenario::{Material, MaterialConstants};
use nalgebra::{Complex, DVector};
use ndarray::{ArrayD, IxDyn, OwnedRepr};
use ndarray_npy::NpzReader;

/// The arrays of a gearbox by name.
fn arrays(name: &str) -> HashMap<String, ArrayD<f64>> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../meshtone/tests/gearbox")
        .join(format!("{name}.npz"));
    let mut npz = NpzReader::new(File::open(path).unwrap()).unwrap();
    let names = npz.names().unwrap();
    let array = |npz: &mut NpzReader<File>, name: &str| npz.by_name::<OwnedRepr<f64>, IxDyn>(name).unwrap();
    names.iter().map(|name| (name.trim_end_matches(".npy").to_owned(), array(&mut npz, name))).collect()
}

/// The steel of the references.
fn steel(poisson_ratio: f64) -> Material {
    let (youngs_modulus_gpa, density_kg_per_m3) = (206.0, 7850.0);
    Material::Given(MaterialConstants { youngs_modulus_gpa, poisson_ratio, density_kg_per_m3 })
}

/// Two stages on three shafts of 240 mm: teeth, module, face width and directions of both lines of centres.
struct TwoStages {
    teeth: [u32; 4],
    module_mm: f64,
    face_width_mm: f64,
    /// (-) Where along the shafts the wheels of each stage sit.
    at: [f64; 2],
    directions_rad: [f64; 2],
    radius_mm: f64,
    elements: u32,
    poisson_ratio: f64,
    /// Sense of rotation of the input.
    sense: f64,
    /// Helix angle; the hand of the driving wheel is right in the first mesh and left in the second one, so that both wheels on the shaft
    /// between them have the same hand.
    helix_angle_rad: f64,
}

impl TwoStages {
    fn radius_m(&self, wheel: usize) -> f64 {
        self.module_mm * 1e-3 * f64::from(self.teeth[wheel]) / 2.0
    }

    /// The machine; the shafts are coupled to motor and brake where there is a housing.
    fn machine(&self, bearing: &Bearing, housing: Option<&Housing>) -> GearboxMachine {
        let coupled = if housing.is_some() {
            [Coupled::Motor, Coupled::Nothing, Coupled::Brake]
        } else {
            [Coupled::Nothing; 3]
        };
        let shafts: Vec<GearboxShaft> = ["input", "middle", "output"]
            .into_iter()
            .zip(coupled)
            .map(|(name, couples_to)| shaft(name, self.radius_mm, self.elements, couples_to))
            .collect();
        let mut positions = vec![[0.0; 2]];
        for (stage, direction) in self.directions_rad.into_iter().enumerate() {
            let distance = self.radius_m(2 * stage) + self.radius_m(2 * stage + 1);
            let [x, y] = positions[stage];
            positions.push([x + distance * direction.cos(), y + distance * direction.sin()]);
        }
        let shafts: Vec<_> = shafts.iter().zip(positions).collect();
        let disc = |wheel: usize| {
            let (r, b) = (self.radius_m(wheel), self.face_width_mm * 1e-3);
            let mass_kg = PI * r * r * b * 7850.0;
            let transverse_kgm2 = mass_kg * (3.0 * r * r + b * b) / 12.0;
            let body = WheelBody { mass_kg, polar_kgm2: mass_kg * r * r / 2.0, transverse_kgm2 };
            Disc { shaft: [0, 1, 1, 2][wheel], at: self.at[wheel / 2], body, body_stiffness_nm_per_rad: None }
        };
        let alpha = (20f64.to_radians().tan() / self.helix_angle_rad.cos()).atan();
        let thrust = self.helix_angle_rad.tan() * alpha.cos();
        let line = |stage: usize| MeshLine {
            offsets_m: [0.0; 2],
            wheels: [2 * stage, 2 * stage + 1],
            base_radii_m: [0, 1].map(|wheel| self.radius_m(2 * stage + wheel) * alpha.cos()),
            working_pressure_angle_rad: alpha,
            thrust: [thrust, -thrust][stage],
            has_forces_across: false,
        };
        let second = -self.sense * f64::from(self.teeth[0]) / f64::from(self.teeth[1]);
        let third = -second * f64::from(self.teeth[2]) / f64::from(self.teeth[3]);
        let bearings: Vec<Bearing> = (0..6)
            .map(|n| {
                let mut bearing = bearing.clone();
                bearing.at = f64::from(n % 2);
                bearing
            })
            .collect();
        let bearings: Vec<_> =
            bearings.iter().enumerate().map(|(n, bearing)| SeatedBearing::linear(n / 2, bearing)).collect();
        GearboxMachine::new(&GearboxParts {
            shafts: &shafts,
            speed_ratios: &[self.sense, second, third],
            discs: &[0, 1, 2, 3].map(disc),
            meshes: &[line(0), line(1)],
            bearings: &bearings,
            housing,
            material: steel(self.poisson_ratio),
            unbalances: &[],
            brake_inertia_kgm2: 0.02,
            sets: &[],
        })
    }
}

fn shaft(name: &str, radius_mm: f64, elements: u32, couples_to: Coupled) -> GearboxShaft {
    let mut shaft = GearboxShaft::new(name, 240.0, radius_mm);
    (shaft.elements, shaft.couples_to) = (elements, couples_to);
    shaft
}

/// A rigid housing, as the references have it.
fn plain_housing() -> Housing {
    let mut housing = Housing::default();
    (housing.modes, housing.damping_ratio) = (HousingModes::RIGID, 0.02);
    housing
}

/// The largest relative difference of the frequencies that are not 0.
fn largest_difference(found_hz: &[f64], expected_hz: &[f64]) -> f64 {
    assert_eq!(found_hz.len(), expected_hz.len());
    let both = found_hz.iter().zip(expected_hz).filter(|(_, expected)| **expected > 1.0);
    both.map(|(found, expected)| (found / expected - 1.0).abs()).fold(0.0, f64::max)
}

/// A machine of which the coordinates from `n` on are held.
fn held(machine: &Machine, n: usize) -> Machine {
    let mut held = machine.clone();
    held.mass = held.mass.view((0, 0), (n, n)).into_owned();
    held.turn = held.turn.view((0, 0), (n, n)).into_owned();
    held.springs
        .iter_mut()
        .for_each(|spring| spring.stiffness = spring.stiffness.view((0, 0), (n, n)).into_owned());
    for line in &mut held.lines {
        line.at_middle = line.at_middle.rows(0, n).into_owned();
        line.per_m = line.per_m.rows(0, n).into_owned();
    }
    held.names.truncate(n);
    held.rigid_rotation = held.rigid_rotation.rows(0, n).into_owned();
    held
}

#[test]
fn beams_and_meshes_have_the_frequencies_and_responses_of_ross() {
    let reference = arrays("ross_two_stage");
    let stages = TwoStages {
        teeth: [32, 96, 48, 80],
        module_mm: 1.5875,
        face_width_mm: 19.0,
        at: [0.25, 0.625],
        directions_rad: [0.3, PI / 3.0],
        radius_mm: 8.0,
        elements: 8,
        // The shear modulus is 79.23 GPa.
        poisson_ratio: 206.0 / (2.0 * 79.23) - 1.0,
        sense: -1.0,
        helix_angle_rad: 0.0,
    };
    let mut bearing = Bearing::new("", 0.0);
    bearing.axial_stiffness_n_per_m = Some(5e7);
    bearing.tilt_stiffness_nm_per_rad = 0.0;
    // The bearings sit on the ground.
    let machine = held(&stages.machine(&bearing, None).machine, 162);
    let (found_hz, _) = machine.closed_modes(&[3e8, 4e8]);
    let expected_hz: Vec<f64> = reference["frequency_hz"].iter().copied().collect();
    let difference = largest_difference(&found_hz, &expected_hz);
    println!("frequencies: {difference:.1e}");
    assert!(difference < 1e-9, "{difference:.2e}");

    // A transmission error pushes its mesh; the damping is 1e-6 s times the stiffness.
    // y of the first node of the input and of the output.
    let (damping_s, places) = (1e-6, [1, 2 * 9 * 6 + 1]);
    let mut largest: f64 = 0.0;
    let stiffness = machine.closed_stiffness(&[3e8, 4e8]);
    for (row, &frequency_hz) in reference["response_frequency_hz"].iter().enumerate().step_by(40) {
        let omega = TAU * frequency_hz;
        let dynamic = stiffness.map(Complex::from) * Complex::new(1.0, omega * damping_s)
            - machine.mass.map(Complex::from) * Complex::from(omega * omega);
        let solved = dynamic.lu();
        for mesh in 0..2 {
            let force: DVector<f64> = &machine.lines[mesh].at_middle * [3e8, 4e8][mesh];
            let moved = solved.solve(&force.map(Complex::from)).unwrap();
            for (place, &coordinate) in places.iter().enumerate() {
                let column = [row, 2 * mesh + place];
                let expected =
                    Complex::new(reference["response_real"][column], reference["response_imaginary"][column]);
                largest = largest.max((moved[coordinate].norm() / expected.norm() - 1.0).abs());
            }
        }
    }
    println!("responses: {largest:.1e}");
    assert!(largest < 1e-9, "{largest:.2e}");
}

#[test]
fn gearboxes_in_a_housing_have_the_frequencies_of_the_independent_model() {
    for (name, teeth, module_mm, face_width_mm, helix_angle_deg) in [
        ("phm09_spur", [32, 96, 48, 80], 1.5875, 19.05, 0f64),
        ("spectraquest_like", [29, 100, 36, 90], 1.5, 15.0, 0.0),
        ("phm09_helical", [16, 48, 24, 40], 3.175, 25.4, 20.0),
    ] {
        let reference = arrays(name);
        let stages = TwoStages {
            teeth,
            module_mm,
            face_width_mm,
            at: [0.25, 0.75],
            directions_rad: [0.0; 2],
            radius_mm: 7.9375,
            elements: 12,
            poisson_ratio: 0.3,
            sense: 1.0,
            helix_angle_rad: helix_angle_deg.to_radians(),
        };
        let machine = stages.machine(&Bearing::new("", 0.0), Some(&plain_housing())).machine;
        let mean: Vec<f64> = (0..2).map(|mesh| reference["mesh_stiffness_n_per_m"][[mesh, 1]]).collect();
        let (found_hz, _) = machine.closed_modes(&mean);
        // The brake there has five more coordinates of 1 kg on 1e9 N/m.
        let held_hz = 1e9f64.sqrt() / TAU;
        let mut expected_hz: Vec<f64> = reference["closed_frequency_hz"].iter().copied().collect();
        for _ in 0..5 {
            let nearest = |a: &f64, b: &f64| (a - held_hz).abs().total_cmp(&(b - held_hz).abs());
            let place = expected_hz.iter().enumerate().min_by(|a, b| nearest(a.1, b.1)).unwrap().0;
            expected_hz.remove(place);
        }
        let difference = largest_difference(&found_hz, &expected_hz);
        println!("{name}: {difference:.1e}");
        assert!(difference < 1e-6, "{name}: {difference:.2e}");
    }
}
