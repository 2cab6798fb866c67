//! Stiffness and natural frequencies beside other programs' results and a standard's formulas.
//!
//! None of the numbers is a measurement. What is given to five digits is compared to what the models have in common;
//! every tolerance is explained where it stands and on the documentation's page on validation.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use crate::physics::*;
use meshtone::machine::{LineOfAction, Machine, Modes, RigMachine, RigParts, Spring, Supports};
use meshtone::published::compliance::ToothCompliance;
use meshtone::published::damage::ToothSection;
use meshtone::scenario::{
    BodyRotation, FoundationCoefficients, GearPair, Gears, Material, Scenario, WheelName,
};
use meshtone::stiffness::hertz_compliance_mm_per_n;
use meshtone::wheel::{Teeth, ToothProfile, Wheel, contact_ratio};
use nalgebra::{DMatrix, DVector};

/// Means (and extremes) of the mesh stiffness where two pairs and where one pair carry the load, and over a pitch.
struct Mesh {
    double: Vec<f64>,
    single: Vec<f64>,
    cycle: f64,
}

/// The mesh made of the pair stiffness `pair` over the position in contact in pitches, for `1 < ratio < 2`.
fn mesh(ratio: f64, pair: impl Fn(f64) -> f64) -> Mesh {
    let points = 2_000;
    let over = |from: f64, to: f64, value: &dyn Fn(f64) -> f64| -> Vec<f64> {
        (0..points).map(|k| value(from + (to - from) * (f64::from(k) + 0.5) / f64::from(points))).collect()
    };
    let double = over(0.0, ratio - 1.0, &|at| pair(at) + pair(at + 1.0));
    let single = over(ratio - 1.0, 1.0, &pair);
    let cycle = mean(&double) * (ratio - 1.0) + mean(&single) * (2.0 - ratio);
    Mesh { double, single, cycle }
}

/// (N/m) The library's own mesh, for a modulus of `e_gpa`.
fn library_mesh(gears: &Gears, teeth: &Teeth, e_gpa: f64) -> Mesh {
    let pairs = sound_pairs(gears, teeth);
    mesh(teeth.path.contact_ratio, |at| pairs.at(&SOUND_PAIR, at).stiffness_n_per_mm * 1e3 * e_gpa / 210.0)
}

fn extremes(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, 0.0), |(low, high), &v| (low.min(v), high.max(v)))
}

/// Prints and returns the relative deviations of the two-pair, one-pair and cycle means.
fn compare(name: &str, mesh: &Mesh, [double, single, cycle]: [f64; 3]) -> [f64; 3] {
    let means = [mean(&mesh.double), mean(&mesh.single), mesh.cycle];
    let deviations = [deviation(means[0], double), deviation(means[1], single), deviation(means[2], cycle)];
    println!(
        "{name}: double {:.4e} ({:+.2} %), single {:.4e} ({:+.2} %), cycle {:.4e} ({:+.2} %)",
        means[0],
        100.0 * deviations[0],
        means[1],
        100.0 * deviations[1],
        means[2],
        100.0 * deviations[2]
    );
    deviations
}

fn involute(angle: f64) -> f64 {
    angle.tan() - angle
}

/// The working flank by the involute's own equations, independent of the library's profile; y over x.
struct Flank {
    base_mm: f64,
    foot_rad: f64,
    tip_roll: f64,
}

impl Flank {
    fn new(wheel: &Wheel) -> Self {
        Self {
            base_mm: wheel.base_radius_mm,
            foot_rad: wheel.half_thickness_angle_rad() + involute(wheel.pressure_angle_rad),
            tip_roll: (wheel.base_radius_mm / wheel.tip_radius_mm).acos().tan(),
        }
    }

    fn point(&self, roll: f64) -> (f64, f64) {
        let (sin, cos) = (self.foot_rad - roll).sin_cos();
        (self.base_mm * (cos - roll * sin), self.base_mm * (sin + roll * cos))
    }

    /// `points` points from `first_roll` to the tip, uniform in the square root of the way: dense at the base circle.
    fn profile(&self, first_roll: f64, points: usize) -> Vec<(f64, f64)> {
        (0..points)
            .map(|i| self.point(first_roll + (self.tip_roll - first_roll) * i as f64 / (points - 1) as f64))
            .collect()
    }

    /// The tooth clamped at the base circle.
    fn clamped_at_base_circle(&self) -> ToothProfile {
        as_profile(self.profile(0.0, 10_000))
    }

    /// The tooth as a rack cutter with a rounded tip leaves it: its root is the trochoid of that tip.
    fn with_trochoid(&self, wheel: &Wheel) -> ToothProfile {
        let (m, r) = (wheel.module_mm, wheel.pitch_radius_mm);
        let (sin, cos) = wheel.pressure_angle_rad.sin_cos();
        let rounding = 0.25 * m / (1.0 - sin);
        let (depth, offset) =
            (1.25 * m - rounding, std::f64::consts::FRAC_PI_4 * m + m * sin / cos + rounding * cos);
        let points = 4_000;
        let mut profile: Vec<(f64, f64)> = (0..points)
            .map(|i| {
                let t = i as f64 / f64::from(points);
                let slope = std::f64::consts::FRAC_PI_2 * (1.0 - t) + wheel.pressure_angle_rad * t;
                let turned = (depth / slope.tan() + offset) / r;
                let reach = depth / slope.sin() + rounding;
                (
                    r * turned.cos() - reach * (slope - turned).sin(),
                    r * turned.sin() - reach * (slope - turned).cos(),
                )
            })
            .collect();
        // The involute starts where the straight flank of the rack ends.
        let joint = sin * r - depth / sin;
        let first_roll = joint / self.base_mm;
        profile.extend(self.profile(first_roll, 6_000));
        as_profile(profile)
    }

    /// (rad) Angle between the load at radius `radius_mm` and the normal to the tooth's centre line.
    fn load_angle(&self, radius_mm: f64) -> f64 {
        (self.base_mm / radius_mm).min(1.0).acos().tan() - self.foot_rad
    }
}

fn as_profile(points: Vec<(f64, f64)>) -> ToothProfile {
    let involute_radius_mm = points.iter().map(|(x, y)| x.hypot(*y)).collect();
    let (x_mm, y_mm) = points.into_iter().unzip();
    ToothProfile { x_mm, y_mm, involute_radius_mm, tip_relief_index: None }
}

/// A tooth's compliance, by the library, of a profile that is not the library's.
struct Tooth {
    wheel: Wheel,
    profile: ToothProfile,
    compliance: ToothCompliance,
}

impl Tooth {
    /// Under the load's own direction, which turns with the point of contact, or under the nominal pressure angle.
    fn new(wheel: Wheel, profile: ToothProfile, turned: bool, foundation: &FoundationCoefficients) -> Self {
        let mut section = ToothSection::sound(&wheel, &profile);
        if turned {
            let flank = Flank::new(&wheel);
            let angle = |i: usize| flank.load_angle(profile.radius_mm(i));
            section.pressure_angle_rad = Some((0..profile.len()).map(angle).collect());
        }
        let compliance = ToothCompliance::new(&wheel, &profile, &section, Material::Steel, foundation, 0);
        Self { wheel, profile, compliance }
    }

    /// (mm/N) At the distance `path_mm` along the line of action from its point of tangency.
    fn at(&self, path_mm: f64) -> f64 {
        let radius = self.wheel.base_radius_mm.hypot(path_mm);
        let (mut low, mut high) = (0, self.profile.len() - 1);
        while high - low > 1 {
            let middle = (low + high) / 2;
            if self.profile.radius_mm(middle) < radius { low = middle } else { high = middle }
        }
        let (r0, r1) = (self.profile.radius_mm(low), self.profile.radius_mm(high));
        let total = |i: usize| self.compliance.total_mm_per_n(i);
        total(low) + (radius - r0) / (r1 - r0) * (total(high) - total(low))
    }
}

/// Mesh of two teeth whose flanks touch where the involute's geometry has them touch.
fn conjugate_mesh(gears: &Gears, e_gpa: f64, bore_mm: f64, tooth: impl Fn(Wheel) -> Tooth) -> Mesh {
    let [pinion, gear] = WheelName::BOTH.map(|wheel| tooth(Wheel::new(gears, wheel, bore_mm / 2.0)));
    let reach = |wheel: &Wheel| (wheel.tip_radius_mm.powi(2) - wheel.base_radius_mm.powi(2)).sqrt();
    let sin = pinion.wheel.pressure_angle_rad.sin();
    let distance = (pinion.wheel.pitch_radius_mm + gear.wheel.pitch_radius_mm) * sin;
    let start = distance - reach(&gear.wheel);
    let base_pitch = std::f64::consts::TAU * pinion.wheel.base_radius_mm / f64::from(gears.pinion_teeth);
    let contact = hertz_compliance_mm_per_n([Material::Steel; 2], gears.face_width_mm);
    let ratio = contact_ratio(gears.pinion_teeth, gears.gear_teeth, pinion.wheel.pressure_angle_rad);
    mesh(ratio, |at| {
        let path = start + at * base_pitch;
        let total = pinion.at(path) + gear.at(distance - path) + contact;
        1e3 * e_gpa / 210.0 / total
    })
}

// ---------------------------------------------------------------------------------------------------------------
// Mesh stiffness with fillet and foundation: ROSS 2.3.0.
// ---------------------------------------------------------------------------------------------------------------

const ROSS: [(u32, u32, f64, f64, [f64; 3]); 3] = [
    (62, 62, 35.0, 1.7898, [4.1186e8, 2.2994e8, 3.7366e8]),
    (55, 75, 35.0, 1.7940, [3.9794e8, 2.2113e8, 3.6125e8]),
    (25, 30, 20.0, 1.6326, [4.6403e8, 2.6972e8, 3.9262e8]),
];

// As it is the library is 2 to 5 % stiffer. With the other program's root (a rack cutter's trochoid) fed to the library's
// compliances, up to 5 % remain, which are the foundation's (next test).
#[test]
fn mesh_with_fillet_and_foundation() {
    for (z1, z2, bore, ratio, means) in ROSS {
        let mut gears = Gears::new(2.0, z1, z2, 20.0);
        gears.foundation = with_rotation_in_teeth();
        let teeth = linear_teeth(&gears, bore);
        assert!((teeth.contact.contact_ratio - ratio).abs() < 5e-5);
        let own = compare(&format!("{z1}/{z2}"), &library_mesh(&gears, &teeth, 206.0), means);
        let expected = if z1 > 41 { 0.04..0.055 } else { 0.02..0.04 };
        assert!(own.iter().all(|deviation| expected.contains(deviation)), "{own:?}");
        let alike = conjugate_mesh(&gears, 206.0, bore, |wheel| {
            let profile = Flank::new(&wheel).with_trochoid(&wheel);
            Tooth::new(wheel, profile, true, &FoundationCoefficients::default())
        });
        let alike = compare("   trochoid, load turned", &alike, means);
        assert!(alike.iter().all(|deviation| (0.0..0.05).contains(deviation)), "{alike:?}");
    }
}

// Bending, shear and axial compression of the same tooth under the same load: five digits are given, and the
// trapezoid on 10 000 points is as good, hence 1e-4. The foundation's S_f and u are the other program's own: 15 %; on the
// library's own root, which is wider still, 19 %.
#[test]
fn one_tooth_part_by_part() {
    let gears = Gears::new(2.0, 62, 62, 20.0);
    let wheel = Wheel::new(&gears, WheelName::Gear, 17.5);
    let scale = 1e3 * 206.0 / 210.0;
    let own = linear_teeth(&gears, 35.0).gear_profile.as_ref().clone();
    let trochoid = Flank::new(&wheel).with_trochoid(&wheel);
    for (shape, profile, turned) in [
        ("own, nominal angle", &own, false),
        ("own, turned", &own, true),
        ("trochoid, turned", &trochoid, true),
    ] {
        let tooth = Tooth::new(wheel, profile.clone(), turned, &FoundationCoefficients::default()).compliance;
        let pitch = profile.nearest_to_radius(wheel.pitch_radius_mm);
        for (place, i, ross) in [
            ("pitch point", pitch, [6.3560e8, 1.1498e10, 2.2380e9, 6.2022e10]),
            ("tip", profile.len() - 1, [4.4161e8, 9.6737e8, 1.0291e9, 1.6593e10]),
        ] {
            let parts = [
                &tooth.foundation_mm_per_n,
                &tooth.bending_mm_per_n,
                &tooth.shear_mm_per_n,
                &tooth.axial_mm_per_n,
            ];
            for ((name, part), ross) in
                ["foundation", "bending", "shear", "axial"].iter().zip(parts).zip(ross)
            {
                let value = scale / part[i];
                let off = deviation(value, ross);
                println!("{shape}, {place}, {name}: {value:.4e} ({:+.2} %)", 100.0 * off);
                let tolerance = match (shape, *name) {
                    ("trochoid, turned", "foundation") => 0.15,
                    // The pitch point is the profile's nearest: half a step of bending's slope.
                    ("trochoid, turned", "bending") => 5e-4,
                    ("trochoid, turned", _) => 1.5e-4,
                    ("own, turned", "foundation") => 0.19,
                    ("own, turned", _) => 0.15,
                    _ => 0.40,
                };
                assert!(off.abs() < tolerance, "{shape}, {place}, {name}: {off}");
            }
        }
    }
    let contact = scale / hertz_compliance_mm_per_n([Material::Steel; 2], 20.0);
    assert_close("contact", 2e-5, [(contact, 3.5559e9)]);
}

// ---------------------------------------------------------------------------------------------------------------
// Classic potential energy: cantilever from the base circle; no fillet, no foundation.
// ---------------------------------------------------------------------------------------------------------------

type Classic = (u32, u32, f64, f64, f64, [f64; 6]);
/// Teeth, module, width, modulus; least, largest and mean stiffness of two pairs, of one pair; mean over a cycle.
const CLASSIC: [(Classic, f64); 3] = [
    ((19, 48, 3.175, 16.0, 206.8, [9.5112e8, 1.0555e9, 1.0273e9, 5.7925e8, 6.5633e8, 6.2666e8]), 8.8577e8),
    ((62, 62, 2.0, 20.0, 206.0, [7.1313e8, 7.6051e8, 7.4466e8, 4.4213e8, 4.4524e8, 4.4420e8]), 6.8164e8),
    ((27, 35, 3.0, 25.0, 206.0, [1.6406e9, 1.7619e9, 1.7249e9, 1.0488e9, 1.0986e9, 1.0859e9]), 1.5071e9),
];

// With its clamp, its load direction and its contact points the classic model's five digits come out of the library's
// compliances (2e-4; its mean over a cycle depends on where its grid has the change of pairs, 5e-4). With the nominal
// angle instead of the load's own, 3 % remain. The library's own tooth is clamped at the root instead: a longer
// cantilever below 42 teeth, a shorter one above, so its mesh cannot be compared and only its sign is tested.
#[test]
fn classic_potential_energy() {
    for ((z1, z2, module, width, e, expected), cycle) in CLASSIC {
        let gears = Gears::new(module, z1, z2, width);
        let means = [expected[2], expected[5], cycle];
        let clamped = |turned: bool| {
            conjugate_mesh(&gears, e, 20.0, |wheel| {
                let profile = Flank::new(&wheel).clamped_at_base_circle();
                Tooth::new(wheel, profile, turned, &rigid_foundation())
            })
        };
        let same = clamped(true);
        let [double, single, cycle] = compare(&format!("{z1}/{z2}, load turned"), &same, means);
        assert!(double.abs() < 2e-4 && single.abs() < 2e-4 && cycle.abs() < 5e-4);
        let ((double_low, double_high), (single_low, single_high)) =
            (extremes(&same.double), extremes(&same.single));
        // The least one-pair stiffness lies at the change of pairs, where the other program's grid has its last point.
        assert_close(
            "   extremes",
            1e-3,
            [
                (double_low, expected[0]),
                (double_high, expected[1]),
                (single_low, expected[3]),
                (single_high, expected[4]),
            ],
        );
        let nominal = compare(&format!("{z1}/{z2}, nominal angle"), &clamped(false), means);
        assert!(nominal.iter().all(|deviation| deviation.abs() < 0.03), "{nominal:?}");
        let mut rigid = gears.clone();
        rigid.foundation = rigid_foundation();
        let own = library_mesh(&rigid, &linear_teeth(&rigid, 20.0), e);
        let own = compare(&format!("{z1}/{z2}, clamped at the root"), &own, means);
        assert!(own.iter().all(|deviation| (*deviation > 0.0) == (z1 > 41)), "{own:?}");
    }
}

// ---------------------------------------------------------------------------------------------------------------
// ISO 6336-1.
// ---------------------------------------------------------------------------------------------------------------

/// (N/(mm µm)) Theoretical single stiffness.
fn iso_theoretical([z1, z2]: [f64; 2], [x1, x2]: [f64; 2]) -> f64 {
    1.0 / (0.04723 + 0.15551 / z1 + 0.25791 / z2
        - 0.00635 * x1
        - 0.11654 * x1 / z1
        - 0.00193 * x2
        - 0.24188 * x2 / z2
        + 0.00529 * x1 * x1
        + 0.00182 * x2 * x2)
}

// The standard's wheels are solid; Sainsot's body is a ring whose bore is clamped. Without the rotation of the body c' and c_gamma are on
// either bore 6 to 33 % above the standard's practical stiffness, whose factor 0.8 comes from measurements, and at most 3.5 % above its theoretical one.
#[test]
fn iso_single_stiffness() {
    let golden = iso_theoretical([19.0, 17.0], [0.617, 0.802]);
    assert_close("ISO", 1e-13, [(golden, 18.829_182_051_335_184)]);
    for (z1, z2, theoretical, above) in [
        (62, 62, 18.5535, [[0.161, 0.147], [0.081, 0.075]]),
        (55, 75, 18.6929, [[0.137, 0.125], [0.066, 0.062]]),
        (25, 30, 16.1167, [[0.327, 0.290], [0.275, 0.245]]),
        (18, 35, 15.8132, [[0.282, 0.243], [0.270, 0.233]]),
    ] {
        let iso = iso_theoretical([f64::from(z1), f64::from(z2)], [0.0; 2]);
        assert_close("ISO", 3e-6, [(iso, theoretical)]);
        let gears = Gears::new(2.0, z1, z2, 20.0);
        let smallest_ratio = 2.0 * (f64::from(z1) - 2.5) / 1.4;
        for (bore, above) in [smallest_ratio, if z1 > 50 { 35.0 } else { 20.0 }].into_iter().zip(above) {
            let teeth = linear_teeth(&gears, bore);
            let pairs = sound_pairs(&gears, &teeth);
            let at = |k: i32| teeth.path.contact_ratio * f64::from(k) / 2000.0;
            let single = largest((0..=2000).map(|k| pairs.at(&SOUND_PAIR, at(k)).stiffness_n_per_mm)) * 206.0
                / 210.0
                / 20.0
                * 1e-3;
            let cycle = library_mesh(&gears, &teeth, 206.0).cycle / 20.0 * 1e-6;
            let practical = 0.8 * 0.975 * iso;
            let gamma = practical * (0.75 * teeth.contact.contact_ratio + 0.25);
            println!(
                "{z1}/{z2} bore {bore:.1}: c'th {iso:.4}, c' {practical:.4}, here {single:.4} ({:+.1} %); c_gamma \
                 {gamma:.4}, here {cycle:.4} ({:+.1} %)",
                100.0 * deviation(single, practical),
                100.0 * deviation(cycle, gamma)
            );
            assert!(single < 1.04 * iso, "at most 4 % stiffer than the theoretical stiffness");
            let found = [deviation(single, practical), deviation(cycle, gamma)];
            let differs = found.iter().zip(above).any(|(found, above)| (found - above).abs() > 2e-3);
            assert!(!differs, "{z1}/{z2}: {found:?} instead of {above:?}");
        }
    }
}

// Without the rotation of the body, what is left of the foundation is nearly the same on any bore, as the standard knows none. With the rotation in the
// tooth the stiffness is less than 0.6 of the standard's on thin shafts. An independent program has 1.02, 1.05, 0.92 and 0.95 with its own teeth.
#[test]
fn without_the_rotation_of_bodies_stiffness_is_near_the_standard_s_on_any_bore() {
    for (teeth, bore, with_rotation, expected) in [
        ([32, 96], 15.88, true, 0.52),
        ([32, 96], 15.88, false, 1.054),
        ([32, 96], 30.0, false, 1.096),
        ([48, 80], 15.88, true, 0.55),
        ([48, 80], 15.88, false, 1.016),
        ([48, 80], 30.0, false, 1.074),
    ] {
        let mut gears = Gears::new(1.5875, teeth[0], teeth[1], 19.0);
        gears.foundation.rotation = if with_rotation { BodyRotation::Tooth } else { BodyRotation::Machine };
        let of_pair = linear_teeth(&gears, bore);
        let gamma = 0.8
            * 0.975
            * iso_theoretical(teeth.map(f64::from), [0.0; 2])
            * (0.75 * of_pair.contact.contact_ratio + 0.25);
        let found = library_mesh(&gears, &of_pair, 206.0).cycle / 19.0 * 1e-6 / gamma;
        println!("{teeth:?} bore {bore}: {found:.3} of c_gamma, expected {expected}");
        let most = if with_rotation { 0.06 } else { 2e-3 };
        assert!((found - expected).abs() < most, "{teeth:?} {bore}: {found}");
    }
}

// Two published gearbox reports state profile shifts, centre distances and the stiffnesses of ISO 6336-1 with the factor 0.862 of
// their rims. The geometry is given to four and five digits. The stiffness here depends on the bore, which they do not state.
#[test]
fn shifted_pairs_of_two_gearbox_reports() {
    let [second_stage, first_stage] = [[[0.506, 0.438], [0.451, 0.390]], [[0.748, 0.625], [0.691, 0.576]]];
    for (z, m, width, distance, x, [angle_deg, shortening_mm, ratio], [single, gamma], above) in [
        (
            [18, 36],
            21.0,
            550.0,
            584.0,
            [0.389, 0.5039],
            [24.169, 1.75, 1.370],
            [12.240, 15.640],
            second_stage,
        ),
        (
            [17, 19],
            45.0,
            491.0,
            863.0,
            [0.802, 0.617],
            [28.118, 10.861, 1.115],
            [12.362, 13.426],
            first_stage,
        ),
    ] {
        let mut gears = Gears::new(m, z[0], z[1], width);
        [gears.pinion_profile_shift, gears.gear_profile_shift] = x;
        gears.centre_distance_mm = Some(distance);
        let smaller_root_mm = m * (f64::from(z[0]) - 2.5 + 2.0 * x[0]);
        let practical = 0.8 * 0.862 * 0.975 * iso_theoretical(z.map(f64::from), x);
        assert_close("c'", 1e-3, [(practical, single)]);
        assert_close("c_gamma", 1e-3, [(single * (0.75 * ratio + 0.25), gamma)]);
        for (root_over_bore, above) in [1.4, 2.0].into_iter().zip(above) {
            let teeth = linear_teeth(&gears, smaller_root_mm / root_over_bore);
            let working_deg = teeth.gear.working_pressure_angle_rad.to_degrees();
            assert!((working_deg - angle_deg).abs() < 2e-3, "{working_deg}");
            assert!(
                (-gears.tip_alteration() * m - shortening_mm).abs() < 0.01,
                "{}",
                gears.tip_alteration() * m
            );
            assert!((teeth.path.contact_ratio - ratio).abs() < 1e-3, "{}", teeth.path.contact_ratio);
            let pairs = sound_pairs(&gears, &teeth);
            let at = |k: i32| teeth.path.contact_ratio * f64::from(k) / 2000.0;
            let per_width = 206.0 / 210.0 / width * 1e-3;
            let here =
                largest((0..=2000).map(|k| pairs.at(&SOUND_PAIR, at(k)).stiffness_n_per_mm)) * per_width;
            let cycle = library_mesh(&gears, &teeth, 206.0).cycle / width * 1e-6;
            let found = [deviation(here, single), deviation(cycle, gamma)];
            let differs = found.iter().zip(above).any(|(found, above)| (found - above).abs() > 2e-3);
            assert!(!differs, "{z:?}: {found:?} instead of {above:?}");
            println!(
                "{z:?} root/bore {root_over_bore}: {working_deg:.3} deg, {:.3} mm, {:.4}; c' {single}, here {here:.3} ({:+.1} %); \
                 c_gamma {gamma}, here {cycle:.3} ({:+.1} %)",
                -gears.tip_alteration() * m,
                teeth.path.contact_ratio,
                100.0 * deviation(here, single),
                100.0 * deviation(cycle, gamma)
            );
        }
    }
}

// The root circle crosses the base circle between 41 and 42 teeth. Neither the profile nor the body knows of it: the stiffness goes on
// within 0.13 % from tooth to tooth.
#[test]
fn stiffness_is_continuous_in_the_tooth_count() {
    let stiffness = |z: u32| {
        let gears = Gears::new(3.0, z, z, 15.0);
        let teeth = linear_teeth(&gears, 20.0);
        library_mesh(&gears, &teeth, 210.0).cycle * 1e-6
    };
    for z in [17, 38, 41, 42, 60] {
        println!("{z}/{z}: {:.2} N/um", stiffness(z));
    }
    let values: Vec<f64> = (38..=46).map(stiffness).collect();
    let steps: Vec<f64> = values.windows(2).map(|pair| pair[1] / pair[0] - 1.0).collect();
    println!("{steps:?}");
    assert!(steps.iter().all(|step| step.abs() < 1.3e-3), "{steps:?}");
}

// ---------------------------------------------------------------------------------------------------------------
// Natural frequencies of a pair with 8 degrees of freedom.
// ---------------------------------------------------------------------------------------------------------------

// Given to 0.01 Hz, hence 0.005 Hz and a little; the rigid rotation is a root of rounding. The bearings are as stiff in x as in y, so
// that the line of action may lie along x.
#[test]
fn natural_frequencies_of_a_pair_with_8_coordinates() {
    let (bearing, shaft) = (1e8, 1e5);
    let mut spring = Spring::new(8, 0.0);
    for coordinate in 0..4 {
        spring.resist(&[(coordinate, 1.0)], bearing);
    }
    // Pinion and motor, gear and brake.
    spring.resist(&[(4, 1.0), (6, -1.0)], shaft);
    spring.resist(&[(5, 1.0), (7, -1.0)], shaft);
    let base_radius_m = [0.028_19, 0.056_38];
    let at_middle = vec![1.0, 0.0, -1.0, 0.0, base_radius_m[0], base_radius_m[1], 0.0, 0.0];
    let machine = Machine {
        names: ["x_p", "y_p", "x_g", "y_g", "theta_p", "theta_g", "theta_m", "theta_b"]
            .map(Into::into)
            .to_vec(),
        mass: DMatrix::from_diagonal(&DVector::from_vec(vec![
            0.6, 0.6, 1.5, 1.5, 0.000_27, 0.0027, 0.0043, 0.0045,
        ])),
        turn: DMatrix::identity(8, 8),
        springs: vec![spring],
        lines: vec![LineOfAction { at_middle: at_middle.into(), per_m: DVector::zeros(8), across: None }],
        bearings: Vec::new(),
        turning_forces: Vec::new(),
        spinning: Vec::new(),
        drives: Vec::new(),
        places: Vec::new(),
        rigid_rotation: DVector::zeros(8),
    };
    for (mesh, expected) in [
        (0.81e8, [521.36, 1262.07, 1299.49, 1578.37, 2054.68, 2496.97, 4475.84]),
        (2.10e8, [554.73, 1262.81, 1299.49, 1619.08, 2054.68, 2589.79, 6362.53]),
    ] {
        let (hz, _) = machine.closed_modes(&[mesh]);
        assert!(hz[0] < 0.01, "rigid rotation at {} Hz", hz[0]);
        let worst = largest(hz[1..].iter().zip(expected).map(|(a, b)| a - b));
        println!("mesh {mesh:e}: rigid rotation at {:.1e} Hz, largest deviation {worst:.4} Hz", hz[0]);
        assert!(worst < 0.006, "{hz:?}");
    }
}

// Without the mesh every wheel stands alone on its bearings and its shaft, in series with its body; only the gear shares its shaft with the brake. The wheels
// are midway between their bearings, which do not give way.
#[test]
fn natural_frequencies_without_the_mesh() {
    let scenario = Scenario::new(GearPair::example());
    let (gears, rig) = (&scenario.gears(), scenario.rig().unwrap());
    let (inertia, unbalance) = Default::default();
    let parts = RigParts {
        gears,
        rig,
        inertias: [&inertia; 2],
        unbalances: [&unbalance; 2],
        brake_inertia_kgm2: scenario.operation.brake_inertia_kgm2,
        overruns: false,
    };
    let train = RigMachine::new(parts, &linear_teeth(gears, 20.0), Supports::Held);
    let modes = Modes::damped_alike(&train.machine, 0.0);
    let ([pinion, gear], brake) = (train.wheels, parts.brake_inertia_kgm2);
    let [pinion_shaft, gear_shaft] = train.shaft_stiffness_nm_per_rad;
    // A beam of 130 mm and 20 mm diameter on two supports: L³/(48 E I) under a force in the middle, L/(12 E I) under a moment there.
    // A bearing has half of its stiffness at either end, and a moment turns the shaft about the middle.
    let (bearing, span): (f64, f64) = (1.9e8, 0.13);
    let bending = 210e9 * std::f64::consts::PI / 4.0 * 1e-8;
    let across = 1.0 / (span.powi(3) / (48.0 * bending) + 1.0 / bearing);
    let tilt = 1.0 / (span / (12.0 * bending) + 4.0 / (bearing * span * span));
    let mut squares: Vec<f64> = [gear, pinion]
        .iter()
        .flat_map(|wheel| {
            let [across, along] = [across, bearing].map(|stiffness| stiffness / wheel.mass_kg);
            let tilting = tilt / wheel.transverse_kgm2;
            [across, across, along, tilting, tilting]
        })
        .collect();
    squares.extend([pinion_shaft / pinion.polar_kgm2, gear_shaft * (1.0 / gear.polar_kgm2 + 1.0 / brake)]);
    squares.sort_by(f64::total_cmp);
    assert!(modes.angular_frequencies[0].powi(2) < 1e-9 * squares[0], "gear and brake turn freely");
    let exact = squares.iter().map(|square| square.sqrt());
    assert_close("uncoupled frequencies", 1e-13, modes.angular_frequencies[1..].iter().copied().zip(exact));
    // G = E/(2 (1 + ν)) of steel, radius 10 mm, 200 and 600 mm long, each in series with the wheel's body of 15 mm between bore and root.
    let (pi, shear) = (std::f64::consts::PI, 210e9 / 2.6);
    let by_hand = |length_m: f64, root_mm: f64| {
        let body = (1e4 - 1e6 / (root_mm * root_mm)) / (4.0 * pi * shear * 0.015);
        1.0 / (length_m / (pi * 1e-8 * shear / 2.0) + body)
    };
    let expected = [by_hand(0.2, 21.75), by_hand(0.6, 53.25)];
    assert_close("shafts", 1e-13, [pinion_shaft, gear_shaft].into_iter().zip(expected));
}
