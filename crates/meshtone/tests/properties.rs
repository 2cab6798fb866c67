//! What must hold whatever the scenario, on random ones.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

mod physics;

use meshtone::dynamics::coordinates::{COORDINATES, CoordinateMatrix, CoordinateVector};
use meshtone::scenario::*;
use meshtone::{Stages, simulate, stages};
use nalgebra::DMatrix;
use physics::*;
use proptest::prelude::*;

fn pit() -> impl Strategy<Value = PitCircle> {
    (0.05..0.6, 0.1..0.35, 0.1..0.5).prop_map(|(start, length, depth)| PitCircle::Fractions {
        start,
        end: start + length,
        depth,
    })
}

/// Faults, for a module of 3 mm and a width of 15 mm.
fn fault() -> impl Strategy<Value = Fault> {
    let line = prop_oneof![
        (0.1..0.5).prop_map(|length: f64| DestructionLine::End(0.5 + length)),
        (25.0..40.0).prop_map(DestructionLine::SlopeDeg),
    ];
    prop_oneof![
        Just(Fault::MissingTooth),
        (0.5..6.0, 0.5..14.0, 0.0..3.0).prop_map(|(chip_height_mm, chip_width_mm, tip_loss_mm)| {
            Fault::ToothBreakage(ToothBreakage { chip_height_mm, chip_width_mm, tip_loss_mm })
        }),
        (0.5..14.0, pit()).prop_map(|(width_mm, pit)| Fault::PartialFace(PartialFace { width_mm, pit })),
        pit().prop_map(|pit| Fault::ThroughFace(ThroughFace { pit })),
        (0.0..0.45, line, 0.0..0.2).prop_map(|(start, line, offset_mm)| {
            Fault::ToothDestruction(ToothDestruction { start, line, offset_mm, noise_mm: 0.0 })
        }),
    ]
}

/// Scenarios; tooth counts have a common factor so that the cycle is short.
fn scenarios(fault: impl Strategy<Value = Option<Fault>>) -> impl Strategy<Value = Scenario> {
    let teeth = (5u32..11, prop_oneof![Just((4u32, 4u32)), Just((4, 8)), Just((6, 4)), Just((4, 6))]);
    let rig = (1e7..1e9, 0.01..0.2, 8.0..15.0);
    (teeth, fault, rig, 20.0..60.0, 5.0..200.0, prop_oneof![Just(17.5), Just(20.0), Just(25.0)], any::<u64>())
        .prop_map(|((unit, (z1, z2)), fault, (bearing, damping, radius), speed, torque, angle, seed)| {
            let mut scenario = Scenario::new(3.0, unit * z1, unit * z2, 15.0, speed, torque);
            scenario.seed = seed;
            scenario.gears.points_per_tooth = 1_500;
            scenario.gears.pressure_angle_deg = angle;
            scenario.gears.tip_relief = None;
            scenario.rig.bearing_stiffness_n_per_m = bearing;
            scenario.rig.damping_ratio = DampingRatio::Uniform(damping);
            scenario.rig.pinion_shaft.radius_mm = radius;
            scenario.solver.sampling_rate_hz = 1e4;
            scenario.fault = fault;
            scenario
        })
}

/// Runs the stages, or lets the case go where the fault does not fit the tooth.
fn fitting(scenario: &Scenario) -> Result<Stages, TestCaseError> {
    stages(scenario).map_err(|error| TestCaseError::reject(error.to_string()))
}

/// Largest asymmetry of a matrix over its largest entry.
fn asymmetry(matrix: &CoordinateMatrix) -> f64 {
    (matrix - matrix.transpose()).amax() / matrix.amax()
}

/// Smallest over largest eigenvalue of the matrix scaled to a diagonal of ones.
fn definiteness(matrix: &CoordinateMatrix) -> f64 {
    let scale = CoordinateVector::from_fn(|n, _| 1.0 / matrix[(n, n)].sqrt());
    let scaled =
        CoordinateMatrix::from_fn(|r, c| 0.5 * (matrix[(r, c)] + matrix[(c, r)]) * scale[r] * scale[c]);
    let eigenvalues =
        DMatrix::from_iterator(COORDINATES, COORDINATES, scaled.iter().copied()).symmetric_eigenvalues();
    eigenvalues.min() / eigenvalues.max()
}

fn few(cases: u32) -> ProptestConfig {
    // The same cases in every run: a failure is the code's.
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(7),
        max_global_rejects: 10_000,
        ..ProptestConfig::default()
    }
}

// The exception below: a shallow through pit near the tip.
#[test]
fn a_through_pit_can_make_the_pair_stiffer() {
    let mut scenario = Scenario::new(3.0, 20, 20, 15.0, 40.0, 10.0);
    scenario.gears.pressure_angle_deg = 17.5;
    scenario.gears.tip_relief = None;
    let pit = PitCircle::Fractions { start: 0.6, end: 0.93, depth: 0.1 };
    scenario.fault = Some(Fault::ThroughFace(ThroughFace { pit }));
    let pair = stages(&scenario).unwrap().pair;
    let faulty = pair.faulty_n_per_mm.unwrap();
    let most = faulty.iter().zip(&pair.healthy_n_per_mm).map(|(f, h)| deviation(*f, *h)).fold(0.0, f64::max);
    println!("through pit: pair up to {:.3} % stiffer", 100.0 * most);
    assert!(most > 0.05 && most < 0.25, "{most}");
}

proptest! {
    #![proptest_config(few(60))]

    // A fault takes material and width away, so no pair gets stiffer. Excepted is the through pit: there the load stays
    // at the pit's edge, which in the first half is nearer to the root than the point that it stands for, and the
    // pressure angle grows by several degrees, which turns the load along the tooth. Both make the pair stiffer than
    // the healthy one at that point, and even than its stiffest: a tenth is allowed.
    #[test]
    fn a_faulty_pair_is_no_stiffer(scenario in scenarios(fault().prop_map(Some))) {
        let stages = fitting(&scenario)?;
        let faulty = stages.pair.faulty_n_per_mm.as_ref().unwrap();
        let through = matches!(scenario.fault, Some(Fault::ThroughFace(_)));
        let stiffest = largest(stages.pair.healthy_n_per_mm.iter().copied());
        for (faulty, healthy) in faulty.iter().zip(&stages.pair.healthy_n_per_mm) {
            prop_assert!(*healthy > 0.0 && faulty.is_finite() && *faulty >= 0.0);
            let limit = if through { stiffest * 1.1 } else { healthy * (1.0 + 1e-12) };
            prop_assert!(*faulty <= limit, "{faulty} beside {healthy}");
        }
        let mesh = &stages.mesh;
        let pitch = stages.cycle.points_per_pitch;
        for (i, k) in mesh.mesh_n_per_mm.iter().enumerate() {
            prop_assert!(*k >= 0.0 && k.is_finite());
            prop_assert!(through || *k <= mesh.healthy_mesh_n_per_mm[i % pitch] * (1.0 + 1e-9));
        }
        // Away from the faulty tooth the mesh is the healthy one.
        for i in mesh.first_pair_n_per_mm.len()..mesh.mesh_n_per_mm.len() {
            prop_assert_eq!(mesh.mesh_n_per_mm[i], mesh.healthy_mesh_n_per_mm[i % pitch]);
        }
    }

    // M is a positive diagonal; C and K are symmetric up to the rounding of turning them; C is positive semidefinite and
    // K, with both shafts' ends held, positive definite.
    #[test]
    fn matrices_are_symmetric_and_definite(
        scenario in scenarios(proptest::option::of(fault())),
        published in any::<bool>(),
    ) {
        let mut scenario = scenario;
        if published {
            scenario.convention = Convention::Published;
        }
        let stages = fitting(&scenario)?;
        let system = &stages.system;
        prop_assert!(system.mass_diagonal.iter().all(|m| *m > 0.0));
        let damping = system.damping_matrix();
        prop_assert!(asymmetry(&damping) < 1e-14);
        prop_assert!(definiteness(&damping) > -1e-13);
        for point in (0..stages.cycle.points_per_gear_revolution).step_by(100) {
            let stiffness = system.stiffness_matrix_at(point);
            prop_assert!(asymmetry(&stiffness) < 1e-14);
            prop_assert!(definiteness(&stiffness) > 0.0, "point {}: {}", point, definiteness(&stiffness));
        }
        let frequencies = system.natural_frequencies_hz();
        prop_assert!(frequencies[0] > 0.0 && frequencies.windows(2).all(|pair| pair[0] <= pair[1]));
        // φᵀ M φ = 1.
        let mass = CoordinateVector::from(system.mass_diagonal);
        for shape in system.modes.shapes.column_iter() {
            let norm = shape.component_mul(&shape).dot(&mass);
            prop_assert!((norm - 1.0).abs() < 1e-12);
        }
    }

    // The profile errors' force is linear in the errors: negated with them, and the sum of both wheels' own.
    #[test]
    fn error_force_is_linear_in_the_errors(scenario in scenarios(proptest::option::of(Just(Fault::MissingTooth)))) {
        let mut scenario = scenario;
        scenario.quality.din_grade = 7;
        let drawn = fitting(&scenario)?.profile_errors.unwrap();
        let force = |pinion: f64, gear: f64| -> Vec<f64> {
            let mut scenario = scenario.clone();
            scenario.quality = Quality {
                din_grade: 0,
                profile_errors: Some(ProfileErrors {
                    pinion_profile_errors_mm: &drawn.pinion_profile_errors_mm * pinion,
                    gear_profile_errors_mm: &drawn.gear_profile_errors_mm * gear,
                }),
            };
            let stages = stages(&scenario).unwrap();
            stages.excitation().take(4_000).map(|sample| sample.error_force_n).collect()
        };
        let both = force(1.0, 1.0);
        prop_assert!(both.iter().any(|f| *f != 0.0));
        prop_assert_eq!(force(-1.0, -1.0), both.iter().map(|f| -f).collect::<Vec<f64>>());
        let (pinion, gear) = (force(1.0, 0.0), force(0.0, 1.0));
        let scale = largest(both.iter().copied());
        for ((both, pinion), gear) in both.iter().zip(&pinion).zip(&gear) {
            prop_assert!((both - pinion - gear).abs() < 1e-12 * scale);
        }
    }
}

proptest! {
    #![proptest_config(few(8))]

    // The same scenario gives the same bits; errors that are given give what they give when they are drawn; another
    // seed changes the errors and nothing before them; the errors do not depend on the fault.
    #[test]
    fn simulations_are_reproducible(scenario in scenarios(proptest::option::of(fault()))) {
        let mut scenario = scenario;
        scenario.quality.din_grade = 6;
        fitting(&scenario)?;
        let first = simulate(&scenario).unwrap();
        prop_assert_eq!(&first.channels, &simulate(&scenario).unwrap().channels);

        let drawn = first.stages.profile_errors.clone();
        let mut given = scenario.clone();
        given.quality = Quality { din_grade: 0, profile_errors: drawn.clone() };
        prop_assert_eq!(&first.channels, &simulate(&given).unwrap().channels);

        let mut reseeded = scenario.clone();
        reseeded.seed = scenario.seed.wrapping_add(1);
        let other = simulate(&reseeded).unwrap();
        prop_assert!(first.channels != other.channels && drawn != other.stages.profile_errors);
        prop_assert_eq!(&first.stages.pair, &other.stages.pair);
        prop_assert_eq!(&first.stages.system, &other.stages.system);

        let mut healthy = scenario.clone();
        healthy.fault = None;
        prop_assert_eq!(drawn, stages(&healthy).unwrap().profile_errors);
    }

    // Ideal wheels: everything that moves is proportional to the torque. Only the torsion of the motor's shaft, which
    // delays the mesh against the motor, is not: it moves the steps of the stiffness against the samples.
    #[test]
    fn response_is_proportional_to_the_torque(scenario in scenarios(Just(None))) {
        let mut scenario = scenario;
        // A shaft that does not turn the pinion by a grid step.
        scenario.rig.pinion_shaft.length_mm = 0.2;
        let once = simulate(&scenario).unwrap().channels;
        scenario.operation.brake_torque_nm *= 2.0;
        let twice = simulate(&scenario).unwrap().channels;
        for (once, twice) in [(&once.vertical_g, &twice.vertical_g), (&once.mesh_force_n, &twice.mesh_force_n)] {
            let off = deviation(rms(twice), 2.0 * rms(once));
            prop_assert!(off.abs() < 1e-2, "{off}");
        }
    }

    // Nothing excites the wheels along their shafts.
    #[test]
    fn nothing_moves_along_the_shafts(scenario in scenarios(proptest::option::of(fault()))) {
        fitting(&scenario)?;
        let channels = simulate(&scenario).unwrap().channels;
        prop_assert!(channels.axial_g.iter().all(|a| *a == 0.0));
        let finite = [&channels.horizontal_g, &channels.vertical_g, &channels.mesh_force_n];
        prop_assert!(finite.iter().all(|signal| signal.iter().all(|value| value.is_finite())));
    }
}
