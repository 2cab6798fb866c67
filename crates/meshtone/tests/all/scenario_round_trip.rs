//! Whatever scenario is valid is written as a scenario file that is read back exactly.

use meshtone::scenario::{
    BodyRotation, Damage, DampingRatio, DestructionLine, Fault, FaultyTeeth, FlankRelief,
    FoundationCoefficients, GearPair, Gears, Material, MissingTooth, Model, Operation, PartialFace,
    PitCircle, Pits, Profile, ProfileErrors, Quality, ReliefShape, Rig, RootCrack, Scenario, Shaft, Solver,
    Structure, Support, SupportSprings, ThroughFace, ToothBreakage, ToothDestruction, Wear, WheelInertia,
    WheelName,
};
use meshtone::wheel::{ErrorTable, WheelDeviations};
use proptest::array::{uniform4, uniform6, uniform13};
use proptest::option;
use proptest::prelude::*;

fn gears() -> impl Strategy<Value = Gears> {
    let foundation = (uniform4(uniform6(-1e3..1e3)), any::<bool>()).prop_map(|([l, m, p, q], in_machine)| {
        let rotation = if in_machine { BodyRotation::Machine } else { BodyRotation::Tooth };
        FoundationCoefficients { l, m, p, q, rotation }
    });
    let wheels = (1.0..10.0, 17u32..80, 17u32..80, 1.0..100.0, 15.0..30.0);
    let rest = (0usize..6, 500usize..100_000, foundation);
    let of_wheel = || (any::<bool>(), 0.01..1.9, 0.0..50.0, option::of(0.0..0.3), 0.0..0.05);
    let contact = (of_wheel(), option::weighted(0.25, of_wheel()), option::of(0.0..0.5));
    (wheels, rest, contact).prop_map(
        |(wheels, (material, points_per_tooth, foundation), (pinion, gear, backlash))| {
            let (module_mm, pinion_teeth, gear_teeth, face_width_mm, pressure_angle_deg) = wheels;
            let mut gears = Gears::new(module_mm, pinion_teeth, gear_teeth, face_width_mm);
            gears.pressure_angle_deg = pressure_angle_deg;
            gears.material = Material::ALL[material];
            gears.points_per_tooth = points_per_tooth;
            gears.foundation = foundation;
            // Both wheels alike, or each with its own.
            for (wheel, of_wheel) in [pinion, gear.unwrap_or(pinion)].into_iter().enumerate() {
                let (parabolic, length, amount_um, chamfer, reduction_mm) = of_wheel;
                gears.flank_relief[wheel] = FlankRelief {
                    shape: if parabolic { ReliefShape::Parabolic } else { ReliefShape::Linear },
                    length_mm: length * module_mm,
                    amount_um,
                };
                gears.tip_chamfer_mm[wheel] = chamfer.map(|chamfer| chamfer * module_mm);
                gears.uniform_flank_reduction_mm[wheel] = reduction_mm;
            }
            gears.backlash_mm = backlash.map(|backlash| backlash * module_mm);
            gears
        },
    )
}

fn profile() -> impl Strategy<Value = Option<Profile>> {
    let points = prop::collection::vec((1e-3..2.0, 5.0..100.0), 2..20);
    option::of(points.prop_map(|points| {
        let (steps, value): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
        let mut time = 0.0;
        let elapsed = |step| {
            time += step;
            time
        };
        let time_s = steps.into_iter().map(elapsed).collect();
        Profile { time_s, value }
    }))
}

fn operation() -> impl Strategy<Value = Operation> {
    (5.0..100.0, 5.0..1e3, 0.0..4.9, 0.0..4.9, profile(), profile()).prop_map(
        |(
            speed,
            torque,
            speed_fluctuation_hz,
            torque_fluctuation_nm,
            speed_profile_hz,
            torque_profile_nm,
        )| {
            let mut operation = Operation::new(speed, torque);
            operation.speed_fluctuation_hz = speed_fluctuation_hz;
            operation.torque_fluctuation_nm = torque_fluctuation_nm;
            operation.speed_profile_hz = speed_profile_hz;
            operation.torque_profile_nm = torque_profile_nm;
            operation
        },
    )
}

fn deviations(teeth: u32) -> impl Strategy<Value = WheelDeviations> {
    let pitches = option::of(prop::collection::vec(-30.0..30.0, teeth as usize));
    (pitches, option::of(0.0..50.0), option::of(-4.0..4.0), option::of(-20.0..20.0)).prop_map(
        |(cumulative_pitch_um, run_out_um, run_out_phase_rad, helix_slope_um)| {
            let mut deviations = WheelDeviations::default();
            deviations.cumulative_pitch_um = cumulative_pitch_um;
            deviations.run_out_um = run_out_um;
            deviations.run_out_phase_rad = run_out_phase_rad;
            deviations.helix_slope_um = helix_slope_um;
            deviations
        },
    )
}

fn quality(pinion_teeth: u32, gear_teeth: u32) -> impl Strategy<Value = Quality> {
    // Every draw of the 100 × teeth errors would be slow; their digits matter, not their spread.
    let drawn = move |first: f64, step: f64| {
        let errors = |teeth: u32| {
            ErrorTable::from_fn(100, teeth as usize, |row, column| {
                first + step * (row as f64 + 0.1).sqrt() / (column as f64 + 0.3)
            })
        };
        ProfileErrors {
            pinion_profile_errors_mm: errors(pinion_teeth),
            gear_profile_errors_mm: errors(gear_teeth),
        }
    };
    prop_oneof![
        (0u8..=12, prop::option::of(any::<u64>())).prop_map(|(din_grade, seed)| {
            let mut quality = Quality::of_grade(din_grade);
            quality.seed = seed;
            quality
        }),
        (0u8..=11, 0.0..=1.0, 0.0..=1.0, 0.0..=1.0).prop_map(|(iso_class, tooth, pitch, run_out)| {
            let mut quality = Quality::default();
            quality.iso_class = iso_class;
            quality.tooth_share = tooth;
            quality.pitch_share = pitch;
            quality.run_out_share = run_out;
            quality
        }),
        (-0.01..0.01, -1e-3..1e-3).prop_map(move |(first, step)| Quality::of_errors(drawn(first, step))),
        (deviations(pinion_teeth), deviations(gear_teeth), 0u8..=12, 0.0..=1.0).prop_map(
            |(pinion, gear, grade, helix)| {
                let mut quality = Quality::of_grade(grade);
                quality.helix_share = helix;
                quality.pinion_deviations = pinion;
                quality.gear_deviations = gear;
                quality
            }
        ),
    ]
}

fn pit() -> impl Strategy<Value = PitCircle> {
    let fractions = (0.0..0.5, 0.5001..1.0, 1e-6..1.0);
    let circle = (1.0..1e3, -1e3..1e3, 1e-3..1e3);
    prop_oneof![
        fractions.prop_map(|(start, end, depth)| PitCircle::Fractions { start, end, depth }),
        circle.prop_map(|(x_mm, y_mm, radius_mm)| PitCircle::Circle { x_mm, y_mm, radius_mm }),
    ]
}

fn damage(module_mm: f64, face_width_mm: f64) -> impl Strategy<Value = Damage> {
    let breakage = (0.01..2.24, 0.01..=1.0, 0.0..2.24).prop_map(move |(height, width, loss)| ToothBreakage {
        chip_height_mm: height * module_mm,
        chip_width_mm: width * face_width_mm,
        tip_loss_mm: loss * module_mm,
    });
    let partial = (0.01..0.99, pit())
        .prop_map(move |(width, pit)| PartialFace { width_mm: width * face_width_mm, pit });
    let line = prop_oneof![
        (0.51..=1.0).prop_map(DestructionLine::End),
        (0.01..89.9).prop_map(DestructionLine::SlopeDeg),
    ];
    let destruction = (-0.99..0.5, line, 0.0..0.7, 0.0..0.7).prop_map(move |(start, line, offset, noise)| {
        ToothDestruction { start, line, offset_mm: offset * module_mm, noise_mm: noise * module_mm }
    });
    let crack =
        (0.0..2.24, 0.1..=90.0, prop::option::of(0.01..=1.0)).prop_map(move |(depth, angle_deg, length)| {
            let length_mm = length.map(|length: f64| length * face_width_mm);
            RootCrack { depth_mm: depth * module_mm, angle_deg, length_mm }
        });
    prop_oneof![
        Just(Damage::from(MissingTooth)),
        breakage.prop_map(Damage::from),
        crack.prop_map(Damage::from),
        partial.prop_map(Damage::from),
        pit().prop_map(|pit| Damage::from(ThroughFace { pit })),
        destruction.prop_map(Damage::from),
        (0.0..100.0).prop_map(|depth_um| Damage::from(Wear { depth_um })),
        pits(),
    ]
}

/// Listed or drawn.
fn pits() -> impl Strategy<Value = Damage> {
    let drawn = (0.0..1.0, 0.0..1.0, 0.1..1.0, 0.0..2.0, 0.0..0.5).prop_map(
        |(density_per_cm2, spread, radius_mm, radius_spread, depth_mm)| Pits::Drawn {
            density_per_cm2,
            spread,
            radius_mm,
            radius_spread,
            depth_mm,
        },
    );
    let list = prop::collection::vec((0.0..1.0, -1.0..1.0, 0.1..1.0, 0.1..1.0, 0.0..0.5), 1..4);
    let listed = (list, any::<bool>()).prop_map(|(pits, circles)| Pits::Listed {
        at: pits.iter().map(|pit| pit.0).collect(),
        z_mm: pits.iter().map(|pit| pit.1).collect(),
        radius_mm: pits.iter().map(|pit| pit.2).collect(),
        face_radius_mm: (!circles).then(|| pits.iter().map(|pit| pit.3).collect()),
        depth_mm: pits.iter().map(|pit| pit.4).collect(),
    });
    prop_oneof![drawn.prop_map(Damage::from), listed.prop_map(Damage::from)]
}

/// Any number, each on teeth of its own.
fn faults(gears: &Gears) -> impl Strategy<Value = Vec<Fault>> + use<> {
    let damages = prop::collection::vec(damage(gears.module_mm, gears.face_width_mm), 0..4);
    damages.prop_map(|damages| {
        let place = |(index, damage): (usize, Damage)| {
            let wheel = WheelName::BOTH[(index + 1) % 2];
            let tooth = 1 + 3 * index as u32;
            let teeth: FaultyTeeth = if index == 2 { vec![tooth + 1, tooth].into() } else { tooth.into() };
            Fault::new(wheel, teeth, damage)
        };
        damages.into_iter().enumerate().map(place).collect()
    })
}

/// A scenario with any rig.
fn rig() -> impl Strategy<Value = Scenario> {
    let damping = prop_oneof![
        (0.0..1.0).prop_map(DampingRatio::Uniform),
        uniform13(0.0..1.0).prop_map(DampingRatio::PerMode),
    ];
    let inertia = || {
        let part = || option::of(1e-9..1e3);
        (part(), part(), part()).prop_map(|(mass_kg, polar, transverse)| WheelInertia {
            mass_kg,
            polar_inertia_kgm2: polar,
            transverse_inertia_kgm2: transverse,
        })
    };
    let shaft = || {
        let bearings = (1.0..1e3, 0.01..0.99, option::of(1e3..1e12), 0.0..0.9);
        (1.0..1e4, 0.1..7.0, bearings).prop_map(
            |(
                length_mm,
                radius_mm,
                (bearing_span_mm, wheel_at, bearing_stiffness_n_per_m, damping_ratio),
            )| {
                Shaft {
                    bearing_span_mm,
                    wheel_at,
                    bearing_stiffness_n_per_m,
                    damping_ratio,
                    ..Shaft::new(length_mm, radius_mm)
                }
            },
        )
    };
    let stiffnesses = (1e3..1e12, 0.0..1e12).prop_map(|(stiffness_n_per_m, coupling_n_per_m)| {
        SupportSprings::Stiffnesses { stiffness_n_per_m, coupling_n_per_m }
    });
    let frequencies = (1.0..1e4, 1.1..9.0).prop_map(|(base_hz, ratio)| SupportSprings::Frequencies {
        base_hz,
        differential_hz: base_hz * ratio,
    });
    let support = (1e-6..1e3, prop_oneof![stiffnesses, frequencies], 0.0..0.9)
        .prop_map(|(mass_kg, springs, damping_ratio)| Support { mass_kg, springs, damping_ratio });
    let numbers = (1e3..1e12, 1e3..1e12, 1e-6..1e3, 0.0..0.9, 0.0..0.9);
    (numbers, damping, shaft(), shaft(), inertia(), inertia(), support).prop_map(
        |(
            (bearing, rotational, brake, eccentricity_mm, mesh_damping_ratio),
            damping_ratio,
            pinion_shaft,
            gear_shaft,
            pinion,
            gear,
            support,
        )| {
            let mut rig = Rig::default();
            rig.bearing_stiffness_n_per_m = bearing;
            rig.wheel_rotational_stiffness_nm_per_rad = rotational;
            rig.damping_ratio = damping_ratio;
            rig.pinion_shaft = pinion_shaft;
            rig.gear_shaft = gear_shaft;
            rig.support = support;
            let mut scenario = base();
            (scenario.operation.brake_inertia_kgm2, scenario.meshes[0].damping_ratio) =
                (brake, mesh_damping_ratio);
            for (wheel, inertia) in scenario.wheels.iter_mut().zip([pinion, gear]) {
                (wheel.inertia, wheel.eccentricity_mm) = (inertia, eccentricity_mm);
            }
            scenario.structure = Structure::Rig(rig);
            scenario
        },
    )
}

fn solver() -> impl Strategy<Value = Solver> {
    let state = || option::of(uniform13(-1e3..1e3));
    (1.0..2e5, 0.0..1.0, 0.0..1.0, state(), state()).prop_map(
        |(sampling_rate_hz, settle_fraction, settle_tolerance, initial_displacement, initial_velocity)| {
            let mut solver = Solver::default();
            solver.sampling_rate_hz = sampling_rate_hz;
            solver.settle_fraction = settle_fraction;
            solver.settle_tolerance = settle_tolerance;
            solver.initial_displacement = initial_displacement;
            solver.initial_velocity = initial_velocity;
            solver
        },
    )
}

/// Any scenario, whose every part is then another.
fn base() -> Scenario {
    Scenario::new(GearPair::example())
}

fn scenario() -> impl Strategy<Value = Scenario> {
    let model = prop_oneof![Just(Model::Contact), Just(Model::Linear), Just(Model::Published)];
    gears().prop_flat_map(move |gears| {
        let quality = quality(gears.pinion_teeth, gears.gear_teeth);
        let faults = faults(&gears);
        let parts = (Just(gears), operation(), quality, faults, rig(), solver());
        (model.clone(), any::<u64>(), parts).prop_map(
            |(model, seed, (gears, mut operation, quality, faults, of_rig, solver))| {
                operation.brake_inertia_kgm2 = of_rig.operation.brake_inertia_kgm2;
                let mut scenario = of_rig.with_faults(faults).with_seed(seed);
                scenario.model = model;
                scenario.set_gears(&gears);
                scenario.operation = operation;
                scenario.set_quality(quality);
                scenario.solver = solver;
                let profiles = [&scenario.operation.speed_profile_hz, &scenario.operation.torque_profile_nm];
                if profiles.iter().any(|profile| profile.is_some()) {
                    // A profile is kept whole.
                    (scenario.solver.duration_s, scenario.solver.pinion_revolutions) = (None, None);
                }
                scenario
            },
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn scenarios_survive_being_written_and_read(scenario in scenario()) {
        // Two profiles may end at different times, and a tooth that is small may not bear the default relief, which the published model
        // always has.
        prop_assume!(scenario.validate().is_ok());
        let text = scenario.to_toml();
        let read = Scenario::from_toml(&text);
        prop_assert_eq!(read.as_ref(), Ok(&scenario), "{}", text);
    }
}

#[test]
fn sections_come_in_the_order_of_the_documentation() {
    let mut scenario = Scenario::new(GearPair::example());
    scenario.faults = vec![Fault::on_first_gear_tooth(MissingTooth)];
    let text = scenario.to_toml();
    let headers: Vec<&str> = text.lines().filter(|line| line.starts_with('[')).collect();
    assert_eq!(headers, ["[gears]", "[operation]", "[quality]", "[fault]", "[rig]", "[solver]"]);
}

#[test]
fn a_number_that_is_none_is_written_and_refused() {
    let mut scenario = Scenario::new(GearPair::example());
    scenario.wheels.iter_mut().for_each(|wheel| wheel.eccentricity_mm = f64::NAN);
    let error = Scenario::from_toml(&scenario.to_toml()).unwrap_err();
    assert_eq!((error.key.as_str(), error.value.as_str()), ("rig.eccentricity_mm", "nan"));
}
