//! Profile shift, basic racks, centre distance and backlash: the flanks that are generated, set on their axes and turned; what
//! the mesh makes of them; and what is refused, with the number that does.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use std::f64::consts::PI;

use crate::physics::*;
use crate::support::{assert_refused, gears as with_keys};
use meshtone::machine::{RigMachine, RigParts, Supports, WheelBody};
use meshtone::scenario::{GearPair, Gears, Material, Model, Scenario, WheelName};
use meshtone::solver::{Block, Output, Recorder};
use meshtone::wheel::{Mounting, Teeth, ToothProfile};

fn shifted(pinion_teeth: u32, gear_teeth: u32, shifts: [f64; 2]) -> Gears {
    let mut gears = Gears::new(3.0, pinion_teeth, gear_teeth, 15.0);
    [gears.pinion_profile_shift, gears.gear_profile_shift] = shifts;
    gears
}

fn apart(mut gears: Gears, by_mm: f64) -> Gears {
    gears.centre_distance_mm = Some(Mounting::without_backlash(&gears).centre_distance_mm + by_mm);
    gears
}

/// (rad) Half the angle that a tooth fills, by the distance from its wheel's centre: its profile in polar coordinates.
struct Polar {
    radius_mm: Vec<f64>,
    angle_rad: Vec<f64>,
}

impl Polar {
    fn new(profile: &ToothProfile) -> Self {
        Self {
            radius_mm: (0..profile.len()).map(|i| profile.radius_mm(i)).collect(),
            angle_rad: profile.x_mm.iter().zip(&profile.y_mm).map(|(x, y)| y.atan2(*x)).collect(),
        }
    }

    /// None beyond the tip.
    fn at(&self, radius_mm: f64) -> Option<f64> {
        let next = self.radius_mm.partition_point(|&r| r < radius_mm);
        assert!(next > 0, "reaches into the root");
        let (before, after) = (self.radius_mm[next - 1], *self.radius_mm.get(next)?);
        let part = (radius_mm - before) / (after - before);
        Some(self.angle_rad[next - 1] + part * (self.angle_rad[next] - self.angle_rad[next - 1]))
    }
}

/// (rad) Angle of the gear's tooth above the line of centres, seen from the gear's centre, when the pinion's tooth at `turned_rad`
/// pushes against it: no point of the pinion's upper flank lies inside it. The pinion's centre is at 0, the gear's at (a, 0).
fn pushed_rad(teeth: &Teeth, gear: &Polar, centre_distance_mm: f64, turned_rad: f64) -> f64 {
    let profile = &teeth.pinion_profile;
    let (sin, cos) = turned_rad.sin_cos();
    let free = profile.x_mm.iter().zip(&profile.y_mm).filter_map(|(x, y)| {
        let (fixed_x, fixed_y) = (x * cos - y * sin - centre_distance_mm, x * sin + y * cos);
        Some(fixed_y.atan2(fixed_x).rem_euclid(2.0 * PI) - gear.at(fixed_x.hypot(fixed_y))?)
    });
    free.fold(f64::INFINITY, f64::min)
}

/// (mm, mm) Over the path of contact, how far the gear leaves the place that the tooth counts give it, largest less smallest, and
/// its play between its two flanks; both along the line of action.
fn kinematic_error_and_play_mm(gears: &Gears) -> (f64, f64) {
    let teeth = linear_teeth(gears, 20.0);
    let distance_mm = Mounting::new(gears).centre_distance_mm;
    let gear = Polar::new(&teeth.gear_profile);
    let (path, pinion) = (&teeth.path, &teeth.pinion);
    let ratio = f64::from(gears.pinion_teeth) / f64::from(gears.gear_teeth);
    // Where the gear's tooth would stand with the pinion's on the line of centres: its end of contact is at the end of the path.
    let standing: Vec<f64> = (1..40)
        .map(|k| {
            let position = path.contact_ratio * f64::from(k) / 40.0;
            let rolled_rad = path.curvature_mm(WheelName::Pinion, position) / pinion.base_radius_mm;
            let turned_rad = rolled_rad - pinion.foot_angle_rad() - pinion.working_pressure_angle_rad;
            pushed_rad(&teeth, &gear, distance_mm, turned_rad) + ratio * turned_rad
        })
        .collect();
    let base_mm = teeth.gear.base_radius_mm;
    let (least, most) =
        standing.iter().fold((f64::MAX, f64::MIN), |(least, most), s| (least.min(*s), most.max(*s)));
    // The tooth below is a pitch away, and pushed the other way by the lower flank.
    let play_rad = least + most - 2.0 * PI + 2.0 * PI / f64::from(gears.gear_teeth);
    ((most - least) * base_mm, play_rad * base_mm)
}

const PAIRS: [(u32, u32, [f64; 2]); 5] = [
    (17, 38, [0.3, 0.2]),
    (17, 38, [0.3, -0.3]),
    (12, 40, [0.5, -0.1]),
    (27, 53, [0.3, -0.1]),
    (17, 38, [0.0, 0.0]),
];

// The profiles are polygons of 10 000 points, chords of a flank whose radius of curvature is some mm: 1e-7 mm.
#[test]
fn generated_flanks_are_conjugate_and_have_the_backlash() {
    for (pinion, gear, shifts) in PAIRS {
        for apart_mm in [0.0, 0.3] {
            let gears = apart(shifted(pinion, gear, shifts), apart_mm);
            let (error, play) = kinematic_error_and_play_mm(&gears);
            let opened = Mounting::new(&gears).opened_backlash_mm;
            println!(
                "{pinion}/{gear} {shifts:?} {apart_mm}: error {error:.1e} mm, play {play:.8} of {opened:.8}"
            );
            assert!(error < 1e-6, "{pinion}/{gear} {shifts:?}: {error:e}");
            assert!((play - opened).abs() < 1e-6, "{pinion}/{gear} {shifts:?}: {play} {opened}");
        }
    }
}

// With a centre distance that does not go with the shifts the same flanks are not in step: the test sees it.
#[test]
fn another_distance_shifts_the_play_only() {
    let gears = shifted(17, 38, [0.3, 0.2]);
    let tight = kinematic_error_and_play_mm(&gears).1;
    let loose = kinematic_error_and_play_mm(&apart(gears, 0.1)).1;
    assert!(tight.abs() < 1e-6 && loose > 0.07, "{tight} {loose}");
}

#[test]
fn teeth_are_as_thick_as_their_shift_makes_them() {
    for (pinion, gear, shifts) in PAIRS {
        let gears = shifted(pinion, gear, shifts);
        let teeth = linear_teeth(&gears, 20.0);
        for (wheel, shift) in WheelName::BOTH.into_iter().zip(shifts) {
            let radius_mm = teeth.wheel(wheel).pitch_radius_mm;
            let thickness = 2.0 * radius_mm * Polar::new(teeth.profile(wheel)).at(radius_mm).unwrap();
            let expected = 3.0 * (PI / 2.0 + 2.0 * shift * 20f64.to_radians().tan());
            assert!((thickness - expected).abs() < 1e-6, "{thickness} {expected}");
        }
    }
}

// A disc of the V circle has the area of the toothed wheel to 4 %, as one of the pitch circle without shift: half of the teeth's
// height is above it, somewhat more below.
#[test]
fn a_disc_of_the_v_circle_has_the_wheels_mass() {
    for (pinion, gear, shifts) in PAIRS {
        let gears = shifted(pinion, gear, shifts);
        let teeth = linear_teeth(&gears, 20.0);
        for name in WheelName::BOTH {
            let (wheel, tooth) = (teeth.wheel(name), Polar::new(teeth.profile(name)));
            // Half a pitch: the root's disc, and the tooth above it.
            let root = tooth.radius_mm[0];
            let above: f64 = (1..tooth.radius_mm.len())
                .map(|i| {
                    let (r, angle) = (&tooth.radius_mm, &tooth.angle_rad);
                    0.5 * (r[i] * r[i] - r[i - 1] * r[i - 1]) * 0.5 * (angle[i] + angle[i - 1])
                })
                .sum();
            let area = PI * root * root + 2.0 * f64::from(wheel.teeth) * above;
            let body = WheelBody::new(wheel, Material::Steel, &Default::default());
            let mass = area * 15.0 * 1e-9 * Material::Steel.density_kg_per_m3();
            let off = deviation(body.mass_kg, mass);
            println!("{} teeth, x {}: {:+.2} %", wheel.teeth, wheel.profile_shift, 100.0 * off);
            assert!(off.abs() < 0.04, "{} teeth, x {}: {off}", wheel.teeth, wheel.profile_shift);
        }
    }
}

fn scenario(model: Model) -> Scenario {
    let mut scenario = Scenario::new(GearPair::example());
    scenario.model = model;
    scenario.meshes[0].points_per_tooth = 2_000;
    (scenario.wheels[0].profile_shift, scenario.wheels[1].profile_shift) = (0.3, 0.2);
    scenario.solver.sampling_rate_hz = 1e5;
    scenario
}

#[derive(Default)]
struct Kept {
    outputs: [Vec<f64>; 5],
}

impl Recorder for Kept {
    fn record(&mut self, block: &Block) {
        for (n, kept) in self.outputs.iter_mut().enumerate() {
            kept.extend_from_slice(block.output(n));
        }
    }
}

// The mesh pushes along a line that the working pressure angle inclines: the gear's mean displacement shows its direction, its
// bearing being as stiff in x as in y. The force is the torque over the base radius, which no shift changes.
#[test]
fn the_mesh_pushes_at_the_working_pressure_angle() {
    let stages = meshtone::stages(scenario(Model::Linear)).unwrap();
    let (inertia, unbalance) = Default::default();
    let parts = RigParts {
        gears: &stages.layout.gears[0],
        rig: stages.scenario.rig().unwrap(),
        inertias: [&inertia; 2],
        unbalances: [&unbalance; 2],
        brake_inertia_kgm2: stages.scenario.operation.brake_inertia_kgm2,
        overruns: false,
    };
    let train = RigMachine::new(parts, &stages.pairs[0].teeth, Supports::Held);
    let coordinate = |name: &str| {
        let number = train.machine.names.iter().position(|other| *other == name).unwrap();
        Output::Coordinate { number, derivative: 0 }
    };
    let outputs = [
        coordinate("x_g"),
        coordinate("y_g"),
        coordinate("theta_b"),
        coordinate("theta_g"),
        Output::MeshForce { mesh: 0 },
    ];
    let mut kept = Kept::default();
    stages.integrate(&outputs, stages.time.first_kept_sample, &mut kept).unwrap();
    let [x, y, brake, gear, force] = kept.outputs.map(|values| mean(&values));
    let angle = (x / y).abs().atan().to_degrees();
    assert!((angle - 22.50252).abs() < 1e-3, "{angle}");
    let torque = (brake - gear) * train.shaft_stiffness_nm_per_rad[1];
    let base_radius_m = 0.057 * 20f64.to_radians().cos();
    assert!(deviation(torque, 10.0).abs() < 1e-3, "{torque}");
    assert!(deviation(force, 10.0 / base_radius_m).abs() < 1e-3, "{force}");
}

#[test]
fn shifted_pairs_run_under_contact() {
    let simulation = meshtone::simulate(scenario(Model::Contact)).unwrap();
    let force = mean(&simulation.channels["mesh_force_n"]);
    let expected = 10.0 / (0.057 * 20f64.to_radians().cos());
    assert!(deviation(force, expected).abs() < 5e-3, "{force} {expected}");
}

/// (N/mm) Stiffness of a single pair at the pitch point.
fn pitch_point_stiffness(gears: &Gears) -> f64 {
    let teeth = linear_teeth(gears, 20.0);
    let gear = &teeth.gear;
    let position = teeth.path.position(WheelName::Gear, gear.curvature_mm(gear.working_pitch_radius_mm));
    sound_pairs(gears, &teeth).at(&SOUND_PAIR, position).stiffness_n_per_mm
}

// ISO 6336-1, Eq. 82, has the flexibility of a pair over tooth counts and shifts: shifts outwards stiffen it. The library's teeth,
// whose compliances are of another kind, follow in sense, but that a shift of 0.4 of 50 teeth alone changes nothing (3e-5): the wheel's
// body, the largest part there, does not depend on the shift.
#[test]
fn shifts_stiffen_a_pair_as_the_standard_says() {
    let flexibility = |z1: f64, z2: f64, [x1, x2]: [f64; 2]| {
        0.04723 + 0.15551 / z1 + 0.25791 / z2
            - 0.00635 * x1
            - 0.11654 * x1 / z1
            - 0.00193 * x2
            - 0.24188 * x2 / z2
            + 0.00529 * x1 * x1
            + 0.00182 * x2 * x2
    };
    for (z1, z2) in [(17, 28), (20, 30), (50, 70)] {
        let own = [[0.0, 0.0], [0.2, 0.1], [0.4, 0.2], [0.4, 0.0]]
            .map(|shifts| (shifts, pitch_point_stiffness(&shifted(z1, z2, shifts))));
        for (shifts, stiffness) in &own[1..] {
            let of_standard = |shifts| flexibility(f64::from(z1), f64::from(z2), shifts);
            let iso = of_standard([0.0; 2]) / of_standard(*shifts) - 1.0;
            let change = deviation(*stiffness, own[0].1);
            println!("{z1}/{z2} {shifts:?}: {:+.2} %, ISO 6336 {:+.2} %", 100.0 * change, 100.0 * iso);
            assert!(change > -1e-4 && iso > 0.0, "{z1}/{z2} {shifts:?}: {change} {iso}");
        }
    }
}

// A larger distance shortens the path, and with it the time that two pairs share the load.
#[test]
fn a_larger_distance_shortens_contact() {
    let ratios: Vec<f64> = [0.0, 0.1, 0.3, 0.9]
        .map(|apart_mm| apart(shifted(17, 38, [0.0, 0.0]), apart_mm))
        .iter()
        .map(|gears| {
            let teeth = linear_teeth(gears, 20.0);
            assert!((teeth.path.contact_ratio - gears.contact_ratio()).abs() < 1e-12);
            teeth.path.contact_ratio
        })
        .collect();
    assert!(ratios.windows(2).all(|pair| pair[1] < pair[0]), "{ratios:?}");
    // dε/da = −(a sin α_w)'/p_b = −1/(p_b sin α_w).
    let slope = (ratios[1] - ratios[0]) / 0.1 * 3.0 * PI * 20f64.to_radians().cos();
    assert!((slope * 20f64.to_radians().sin() + 1.0).abs() < 0.02, "{slope}");
}

/// The number behind `must be at least`, `at most` or `more than`, and on which side of it values do.
fn number_that_does(message: &str) -> (f64, f64) {
    for (words, side) in [("must be at least ", 1.0), ("must be at most ", -1.0), ("must be more than ", 1.0)]
    {
        if let Some((_, rest)) = message.split_once(words) {
            let number: String =
                rest.chars().take_while(|c| c.is_ascii_digit() || ['.', '-'].contains(c)).collect();
            return (number.trim_end_matches('.').parse().unwrap(), side);
        }
    }
    panic!("no number in: {message}")
}

#[test]
fn what_is_refused_names_the_number_that_does() {
    for (fixed, key, value, words) in [
        (
            "",
            "pinion_profile_shift",
            -0.1,
            "17 teeth are undercut at a pressure angle of 20°; must be at least 0.0057",
        ),
        ("", "gear_profile_shift", -1.5, "fit into one another at no distance"),
        ("", "pinion_profile_shift", 1.9, "the tips of 17 teeth would be pointed"),
        ("pinion_profile_shift = 0.5", "pinion_addendum", 1.9, "the tips of 17 teeth would be pointed"),
        (
            "gear_addendum = 0.8\npressure_angle_deg = 30.0",
            "gear_dedendum",
            2.4,
            "would close above their roots",
        ),
        ("", "centre_distance_mm", 82.0, "must be at least 82.5000 mm"),
        ("pinion_profile_shift = 0.3", "centre_distance_mm", 82.5, "have no backlash"),
        ("", "centre_distance_mm", 86.0, "the contact ratio is"),
        ("pinion_profile_shift = 0.3", "gear_addendum", 1.22, "the gear's tips would reach into the fillets"),
        (
            "gear_addendum = 1.1\npinion_profile_shift = 0.1",
            "pinion_dedendum",
            1.0,
            "the gear's tips would touch the pinion's roots",
        ),
        ("gear_addendum = 0.4", "pinion_addendum", 0.5, "the contact ratio is"),
    ] {
        let with = |value: f64| with_keys(&format!("{key} = {value:.6}\n{fixed}"));
        let error = assert_refused(&with(value), &format!("gears.{key}"), 6, &[words]);
        let (number, side) = number_that_does(&error.problem);
        println!("{error}");
        Scenario::from_toml(&with(number + 1e-6 * side)).unwrap();
        let beyond = number - 1.1e-3 * 3.0 * side;
        assert!(Scenario::from_toml(&with(beyond)).is_err(), "{key} = {beyond} is not refused");
    }
    // The least shift depends on the tool's straight flank; so far inwards no pinion goes with it.
    for (dedendum, least) in [(1.25, "must be at least -1.2225"), (1.4, "must be at least -1.0725")] {
        let keys =
            format!("gear_profile_shift = -1.4\npinion_profile_shift = 0.5\ngear_dedendum = {dedendum}");
        let error = assert_refused(
            &with_keys(&keys),
            "gears.gear_profile_shift",
            6,
            &["38 teeth are undercut", least],
        );
        assert!(error.help.unwrap().contains("so many teeth are not undercut"));
    }
    let few = with_keys("pinion_profile_shift = 0.1").replace("pinion_teeth = 17", "pinion_teeth = 12");
    let error = assert_refused(&few, "gears.pinion_profile_shift", 6, &["12 teeth are undercut"]);
    assert!(error.help.unwrap().contains("simulated as if they were not undercut"));
    let error = assert_refused(
        &with_keys("backlash_mm = 0.1\ncentre_distance_mm = 83.0"),
        "gears.backlash_mm",
        6,
        &["opens between teeth of nominal thickness"],
    );
    let (number, _) = number_that_does(&error.problem);
    Scenario::from_toml(&with_keys(&format!("backlash_mm = {number}\ncentre_distance_mm = 83.0"))).unwrap();
}

#[test]
fn keys_out_of_range() {
    for (keys, key, words) in [
        ("pinion_profile_shift = 3.0", "pinion_profile_shift", "from -2 to 2"),
        ("gear_addendum = 0.1", "gear_addendum", "from 0.3 to 2"),
        ("gear_dedendum = 0.1", "gear_dedendum", "from 0.5 to 2.5"),
        ("centre_distance_mm = 0.0", "centre_distance_mm", "more than 0 mm"),
    ] {
        assert_refused(&with_keys(keys), &format!("gears.{key}"), 6, &[words]);
    }
    for (keys, key, words) in [
        ("gear_profile_shift = 0.1", "gear_profile_shift", "only standard wheels"),
        ("centre_distance_mm = 82.6", "centre_distance_mm", "only standard wheels"),
        ("helix_angle_deg = 15.0", "helix_angle_deg", "only spur wheels"),
    ] {
        let text = format!("model = \"published\"\n{}", with_keys(keys));
        assert_refused(&text, &format!("gears.{key}"), 7, &[words, "linear"]);
    }
}

#[test]
fn small_wheels_without_shift_are_warned_of_with_the_shift_that_helps() {
    let warnings = |shift: f64| {
        let gears = shifted(12, 38, [shift, 0.0]);
        let mut scenario = scenario(Model::Linear);
        scenario.set_gears(&gears);
        scenario
            .validate()
            .map(|warnings| warnings.into_iter().map(|w| (w.key, w.message)).collect::<Vec<_>>())
    };
    let undercut = warnings(0.0).unwrap();
    assert_eq!(undercut[0].0, "gears.pinion_teeth");
    assert!(undercut[0].1.contains("gears.pinion_profile_shift = 0.2982 or more"), "{}", undercut[0].1);
    assert_eq!(warnings(0.2982).unwrap(), []);
    assert_eq!(warnings(0.2).unwrap_err().key, "gears.pinion_profile_shift");
    let thin = warnings(0.8).unwrap();
    assert_eq!(thin.len(), 1);
    assert!(
        thin[0].0 == "gears.pinion_profile_shift" && thin[0].1.contains("less than 0.2 modules"),
        "{thin:?}"
    );
}
