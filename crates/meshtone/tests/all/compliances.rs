//! Closed forms and limits of the stiffness: each compliance on shapes whose compliance is known, sections against
//! quadrature, and what a tooth's compliances do as the profile is refined.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use std::f64::consts::PI;

use crate::physics::*;
use meshtone::damage::{DamagedTooth, Section, damaged_teeth};
use meshtone::published::compliance::ToothCompliance;
use meshtone::published::damage::{LateralBending, ToothSection, geometry};
use meshtone::published::mesh::{MeshStiffness, PairStiffness};
use meshtone::scenario::{
    Damage, Fault, FoundationCoefficients, GearPair, Gears, Material, Model, PartialFace, PitCircle,
    Scenario, WheelName,
};
use meshtone::stiffness::{FlankLoad, LoadedFlank, hertz_compliance_mm_per_n};
use meshtone::wheel::{Flank, FlankPoint, Teeth, ToothProfile, Wheel};

const E: f64 = 210e3;
const G: f64 = E / 2.6;
const WIDTH: f64 = 15.0;

/// The example's wheels with profiles of as many points.
fn example_with_points(points_per_tooth: usize) -> Gears {
    let mut gears = example_gears();
    gears.points_per_tooth = points_per_tooth;
    gears
}

/// A bar along x, `length` long, whose half thickness is `half(x − x_0)`, with its wheel.
fn bar(points: usize, length: f64, alpha_deg: f64, half: impl Fn(f64) -> f64) -> (Wheel, ToothProfile) {
    let depth = |i: usize| length * i as f64 / (points - 1) as f64;
    let profile = ToothProfile {
        x_mm: (0..points).map(|i| 40.0 + depth(i)).collect(),
        y_mm: (0..points).map(|i| half(depth(i))).collect(),
        // Of no involute.
        involute_radius_mm: vec![0.0; points],
        tip_relief_index: None,
    };
    let mut gears = Gears::new(3.0, 30, 30, WIDTH);
    gears.pressure_angle_deg = alpha_deg;
    (Wheel::new(&gears, WheelName::Gear, 10.0), profile)
}

fn compliance(wheel: &Wheel, profile: &ToothProfile, section: &ToothSection) -> ToothCompliance {
    let foundation = FoundationCoefficients::default();
    ToothCompliance::new(wheel, profile, section, Material::Steel, &foundation, 0)
}

/// A tooth as a load at any of its points sees it.
fn loaded<'a>(
    wheel: &'a Wheel,
    profile: &'a ToothProfile,
    damage: Option<&DamagedTooth>,
    foundation: &FoundationCoefficients,
) -> LoadedFlank<'a> {
    LoadedFlank::new(Flank { wheel, profile }, damage, Material::Steel, foundation)
}

/// A load at the last point of a bar, at `alpha_deg` to the normal of its centre line and `z_mm` from the middle of its face.
fn load_at_the_end(profile: &ToothProfile, alpha_deg: f64, z_mm: f64, width_mm: f64) -> FlankLoad {
    let (sin, cos) = f64::to_radians(alpha_deg).sin_cos();
    let last = profile.len() - 1;
    let (x_mm, y_mm) = (profile.x_mm[last], profile.y_mm[last]);
    let point = FlankPoint { index: last - 1, fraction: 1.0, x_mm, y_mm, load_sin: sin, load_cos: cos };
    FlankLoad { point, sin, cos, z_mm, width_mm }
}

/// The damaged tooth of one or more faults that are all on it.
fn damaged_tooth(teeth: &Teeth, faults: &[Fault]) -> DamagedTooth {
    let mut damaged = damaged_teeth(faults, teeth, 1).unwrap();
    assert_eq!(damaged.len(), 1);
    damaged.remove(0)
}

/// A tooth of which nothing is missing, but that is taken for a damaged one.
fn untouched(wheel: WheelName, profile: &ToothProfile) -> DamagedTooth {
    DamagedTooth::sound(wheel, vec![0], profile)
}

// Steel: ν 0.3. The trapezoidal rule is exact for the linear and constant integrands; that of bending is quadratic,
// where it gives L³/3 (1 + 1/(2 n²)) on n intervals: the tolerance is rounding after that.
#[test]
fn cantilever_of_constant_section() {
    let (points, length, half) = (10_000, 6.0, 1.7);
    let n = (points - 1) as f64;
    let (area, inertia) = (WIDTH * 2.0 * half, WIDTH * (2.0 * half).powi(3) / 12.0);
    for alpha_deg in [0.0, 14.5, 20.0, 25.0] {
        let (wheel, profile) = bar(points, length, alpha_deg, |_| half);
        let tooth = compliance(&wheel, &profile, &ToothSection::sound(&wheel, &profile));
        let (fa, fs) = f64::to_radians(alpha_deg).sin_cos();
        let last = points - 1;
        let across = fs * fs * length.powi(3) / 3.0 * (1.0 + 0.5 / (n * n));
        // The load acts at the surface: its component along the bar bends it back.
        let along = -fs * fa * half * length * length + fa * fa * half * half * length;
        assert_close(
            &format!("cantilever, bending at {alpha_deg}°"),
            1e-12,
            [(tooth.bending_mm_per_n[last], (across + along) / (E * inertia))],
        );
        assert_close(
            "cantilever, shear",
            1e-12,
            [(tooth.shear_mm_per_n[last], fs * fs * 1.2 * length / (G * area))],
        );
        if alpha_deg > 0.0 {
            assert_close(
                "cantilever, axial",
                1e-12,
                [(tooth.axial_mm_per_n[last], fa * fa * length / (E * area))],
            );
        }
        assert_eq!(tooth.bending_mm_per_n[0], 0.0, "no lever at the clamp");
    }
}

// The same under any load: beside the face's middle it bends the bar sideways too. A sound bar and one that is taken for damaged
// have the same compliance.
#[test]
fn cantilever_under_a_load_beside_the_middle() {
    let (points, length, half) = (10_000, 6.0, 1.7);
    let n = (points - 1) as f64;
    let (area, inertia) = (WIDTH * 2.0 * half, WIDTH * (2.0 * half).powi(3) / 12.0);
    let sideways = 2.0 * half * WIDTH.powi(3) / 12.0;
    for (alpha_deg, z_mm) in [(0.0, 0.0), (14.5, 2.0), (31.0, -5.0)] {
        let (wheel, profile) = bar(points, length, alpha_deg, |_| half);
        let (fa, fs) = f64::to_radians(alpha_deg).sin_cos();
        let across = fs * fs * length.powi(3) / 3.0 * (1.0 + 0.5 / (n * n));
        let along = -fs * fa * half * length * length + fa * fa * half * half * length;
        let exact = (across + along) / (E * inertia)
            + fa * fa * z_mm * z_mm * length / (E * sideways)
            + fs * fs * 1.2 * length / (G * area)
            + fa * fa * length / (E * area);
        let load = load_at_the_end(&profile, alpha_deg, z_mm, WIDTH);
        let damaged = untouched(WheelName::Gear, &profile);
        let compliances = [None, Some(&damaged)]
            .map(|damage| loaded(&wheel, &profile, damage, &rigid_foundation()).compliance_mm_per_n(&load));
        assert_close(
            &format!("cantilever at {alpha_deg}°, z = {z_mm} mm"),
            1e-11,
            compliances.map(|compliance| (compliance, exact)),
        );
    }
}

// A wedge y = a − b s has logarithms for its integrals; the trapezoid's error falls by 4 per halving of the step.
#[test]
fn wedge_has_its_closed_form_to_second_order() {
    let (length, a, b, alpha_deg) = (6.0, 2.4_f64, 0.25, 20.0);
    let (fa, fs) = f64::to_radians(alpha_deg).sin_cos();
    let tip: f64 = a - b * length;
    let log = (a / tip).ln();
    let axial = fa * fa * log / b / (2.0 * WIDTH * E);
    let shear = fs * fs * 1.2 * log / b / (2.0 * WIDTH * G);
    // ∫ M²/(E Iz) ds with Iz = 2 W y³/3 and M = fs (s − L) + fa y_L = c0 + c1 y, ds = dy/b.
    let (c0, c1) = (fs * tip / b + fa * tip, -fs / b);
    let (square, cube) = (1.0 / tip - 1.0 / a, (1.0 / (tip * tip) - 1.0 / (a * a)) / 2.0);
    let bending = 1.5 / (WIDTH * E * b) * (c0 * c0 * cube + 2.0 * c0 * c1 * square + c1 * c1 * log);
    let errors = |points: usize| {
        let (wheel, profile) = bar(points, length, alpha_deg, |s| a - b * s);
        let tooth = compliance(&wheel, &profile, &ToothSection::sound(&wheel, &profile));
        [
            deviation(tooth.axial_mm_per_n[points - 1], axial),
            deviation(tooth.shear_mm_per_n[points - 1], shear),
            deviation(tooth.bending_mm_per_n[points - 1], bending),
        ]
    };
    let (coarse, fine) = (errors(501), errors(1001));
    for (before, after) in coarse.iter().zip(&fine) {
        assert!(before.abs() < 3e-6 && (before / after - 4.0).abs() < 0.02, "{coarse:?} {fine:?}");
    }
    println!("wedge at 10 000 points: {:?}", errors(10_000));
}

/// Centre, area and moments of a section given by its strips `y → (z_min, z_max)` between the heights `steps`.
struct Quadrature {
    area: f64,
    yc: f64,
    zc: f64,
    iz: f64,
    iy: f64,
    iyz: f64,
}

fn quadrature(steps: &[f64], strip: impl Fn(f64) -> (f64, f64)) -> Quadrature {
    let over = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
        steps
            .windows(2)
            .map(|ends| {
                integral(ends[0], ends[1], 1, |y| {
                    let (low, high) = strip(y);
                    integral(low, high, 1, |z| f(y, z))
                })
            })
            .sum()
    };
    let area = over(&|_, _| 1.0);
    let (yc, zc) = (over(&|y, _| y) / area, over(&|_, z| z) / area);
    Quadrature {
        area,
        yc,
        zc,
        iz: over(&|y, _| (y - yc).powi(2)),
        iy: over(&|_, z| (z - zc).powi(2)),
        iyz: over(&|y, z| (y - yc) * (z - zc)),
    }
}

/// A section's area, centre and moments, its shear flexibility, and its exact values by quadrature.
struct Compared {
    section: [(f64, f64); 5],
    product: (f64, f64),
    shear: (f64, f64),
}

/// The exact section of half thickness `y` that is narrower by `width_mm` above the height `cut`.
fn cornered_section(y: f64, cut: f64, width_mm: f64) -> (Quadrature, f64) {
    let left = |at: f64| if at < cut { -WIDTH / 2.0 } else { -WIDTH / 2.0 + width_mm };
    let steps = [-y, cut, y];
    let section = quadrature(&steps, |at| (left(at), WIDTH / 2.0));
    // Jourawski's shear stress Q/(Iz b) on the strips.
    let width = |at: f64| WIDTH / 2.0 - left(at);
    let moment_above = |from: f64| -> f64 {
        let up_to = |a: f64, b: f64| integral(a, b, 1, |at| (at - section.yc) * width(at));
        if from < cut { up_to(from, cut) + up_to(cut, y) } else { up_to(from, y) }
    };
    let energy: f64 = steps
        .windows(2)
        .map(|ends| integral(ends[0], ends[1], 1, |at| moment_above(at).powi(2) / width(at)))
        .sum();
    let shear = energy / (2.0 * section.iz.powi(2));
    (section, shear)
}

fn assert_sections(name: &str, compared: Vec<Compared>) {
    assert_close(
        &format!("section of a partial pit, {name}"),
        1e-12,
        compared.iter().flat_map(|c| c.section),
    );
    // Iyz is a difference of larger terms at the pit's edges, where the cut is shallow.
    assert_close("product of inertia of a partial pit", 1e-9, compared.iter().map(|c| c.product));
    assert_close("shear integral of a partial pit", 1e-12, compared.iter().map(|c| c.shear));
}

fn partial_pit(width_mm: f64) -> Damage {
    let pit = PitCircle::Fractions { start: 0.2, end: 0.8, depth: 0.7 };
    Damage::PartialFace(PartialFace { width_mm, pit })
}

// The integrands are polynomials of degree 4 at most, for which five Gauss points are exact: rounding only.
#[test]
fn section_of_a_partial_pit_by_quadrature() {
    let gears = example_with_points(2_000);
    let teeth = published_teeth(&gears, 20.0);
    let width_mm = 6.0;
    let fault = geometry(&partial_pit(width_mm), &teeth, 1).unwrap();
    let [start, end] = fault.description.range;
    let lateral = fault.gear.lateral.as_ref().unwrap();
    let yc = fault.gear.yc_mm.as_ref().unwrap();
    let at = |i: usize| {
        let (exact, shear) = cornered_section(teeth.gear_profile.y_mm[i], fault.flank_y_mm[i], width_mm);
        Compared {
            section: [
                (fault.gear.area_mm2[i], exact.area),
                (yc[i], exact.yc),
                (lateral.zc_mm[i], exact.zc),
                (fault.gear.iz_mm4[i], exact.iz),
                (lateral.iy_mm4[i], exact.iy),
            ],
            product: (lateral.iyz_mm4[i], exact.iyz),
            shear: (fault.gear.shear_per_mm2[i], shear),
        }
    };
    assert_sections("published", (start..=end).step_by(37).map(at).collect());
}

#[test]
fn section_of_a_damaged_tooth_by_quadrature() {
    let gears = example_with_points(2_000);
    let teeth = linear_teeth(&gears, 20.0);
    for (wheel, width_mm) in [(WheelName::Gear, 6.0), (WheelName::Pinion, 2.5)] {
        let tooth = damaged_tooth(&teeth, &[Fault::new(wheel, 3, partial_pit(width_mm))]);
        let [start, end] = tooth.descriptions[0].range;
        let profile = teeth.profile(wheel);
        let at = |i: usize| {
            let (exact, shear) = cornered_section(profile.y_mm[i], tooth.corner_y_mm[i], width_mm);
            let section = Section::damaged(&tooth, profile, WIDTH, i);
            Compared {
                section: [
                    (section.area_mm2, exact.area),
                    (section.yc_mm, exact.yc),
                    (section.zc_mm, exact.zc),
                    (section.iz_mm4, exact.iz),
                    (section.iy_mm4, exact.iy),
                ],
                product: (section.iyz_mm4, exact.iyz),
                shear: (section.shear_per_mm2, shear),
            }
        };
        // Not at the very edges, where nothing but rounding is missing.
        let inside = start + 5..=end - 5;
        assert_sections(wheel.name(), inside.step_by(37).map(at).collect());
        // Where nothing is missing it is the sound tooth's.
        let below = start - 1;
        assert_eq!(
            Section::damaged(&tooth, profile, WIDTH, below),
            Section::sound(WIDTH, profile.y_mm[below])
        );
    }
}

/// (N mm) Strain energy per mm of length of the section made of `steps` and `strip` under the axial force `−force`
/// at (y, z) and the moment `∫ σ y dA = moment`, both about the section's centre: the linear stress that is in
/// equilibrium with them, squared and integrated. No sign model of moments enters.
fn energy_of_equilibrium(cut: &Quadrature, force: f64, [y, z]: [f64; 2], moment: f64) -> f64 {
    // σ = a + b y + c z with ∫ σ = −force, ∫ σ y = moment − force y, ∫ σ z = −force z.
    let (first, second) = (moment - force * y, -force * z);
    let determinant = cut.iz * cut.iy - cut.iyz * cut.iyz;
    let b = (first * cut.iy - second * cut.iyz) / determinant;
    let c = (second * cut.iz - first * cut.iyz) / determinant;
    (b * b * cut.iz + 2.0 * b * c * cut.iyz + c * c * cut.iy) / (2.0 * E)
}

#[test]
fn unsymmetric_bending_from_equilibrium() {
    let (points, length, half, alpha_deg, load_z) = (4_001, 6.0, 1.7, 20.0, 3.0);
    let n = (points - 1) as f64;
    let (wheel, profile) = bar(points, length, alpha_deg, |_| half);
    let steps = [-half, 0.4, half];
    let cut = quadrature(&steps, |y| if y < 0.4 { (-7.5, 7.5) } else { (-1.5, 7.5) });
    let (fa, fs) = f64::to_radians(alpha_deg).sin_cos();
    let arm = [half - cut.yc, load_z - cut.zc];
    // The force across the tooth, on its upper flank, stretches the upper half: ∫ σ y = F_s (L − s).
    let exact = 2.0 * integral(0.0, length, 1, |s| energy_of_equilibrium(&cut, fa, arm, fs * (length - s)));
    let trapezoid = length.powi(3) / (3.0 * n * n) * energy_of_equilibrium(&cut, 0.0, [0.0; 2], fs);
    let value = |coupling: f64| {
        let mut section = ToothSection::sound(&wheel, &profile);
        section.iz_mm4 = vec![cut.iz; points];
        section.yc_mm = Some(vec![cut.yc; points]);
        section.lateral = Some(LateralBending {
            iy_mm4: vec![cut.iy; points],
            iyz_mm4: vec![coupling * cut.iyz; points],
            zc_mm: vec![cut.zc; points],
            load_z_mm: vec![load_z; points],
        });
        compliance(&wheel, &profile, &section).bending_mm_per_n[points - 1]
    };
    assert_close("unsymmetric bending", 1e-11, [(value(-1.0), exact + trapezoid)]);
    let difference = deviation(value(1.0), exact + trapezoid);
    println!("unsymmetric bending with the published sign of the coupling: {:.1} %", 100.0 * difference);
    assert!(difference.abs() > 0.01, "the section is asymmetric enough to distinguish the two signs");
}

#[test]
fn unsymmetric_bending_of_a_damaged_tooth_from_equilibrium() {
    let (points, length, half, alpha_deg, load_z, corner_mm, step) = (4_001, 6.0, 1.7, 20.0, 3.0, 6.0, 0.4);
    let n = (points - 1) as f64;
    let (wheel, profile) = bar(points, length, alpha_deg, |_| half);
    let (cut, shear) = cornered_section(half, step, corner_mm);
    let (fa, fs) = f64::to_radians(alpha_deg).sin_cos();
    let arm = [half - cut.yc, load_z - cut.zc];
    let bending = 2.0 * integral(0.0, length, 1, |s| energy_of_equilibrium(&cut, fa, arm, fs * (length - s)));
    let trapezoid = length.powi(3) / (3.0 * n * n) * energy_of_equilibrium(&cut, 0.0, [0.0; 2], fs);
    let exact = bending + trapezoid + 2.0 * fs * fs * shear * length / G + fa * fa * length / (E * cut.area);
    let mut damage = untouched(WheelName::Pinion, &profile);
    damage.corner_width_mm.fill(corner_mm);
    damage.corner_y_mm.fill(step);
    let tooth = loaded(&wheel, &profile, Some(&damage), &rigid_foundation());
    let load = load_at_the_end(&profile, alpha_deg, load_z, WIDTH - corner_mm);
    assert_close(
        "unsymmetric bending of a damaged tooth",
        1e-11,
        [(tooth.compliance_mm_per_n(&load), exact)],
    );
}

// What misses one end of its whole height is a narrower tooth, if it is loaded in the middle of what is left.
#[test]
fn a_tooth_without_one_end_is_a_narrower_one() {
    let gears = example_with_points(2_000);
    let missing_mm = 4.5;
    let mut narrow = gears.clone();
    narrow.face_width_mm = WIDTH - missing_mm;
    let (teeth, narrow_teeth) = (linear_teeth(&gears, 20.0), linear_teeth(&narrow, 20.0));
    for name in WheelName::BOTH {
        let flank = teeth.flank(name);
        let mut damage = untouched(name, flank.profile);
        damage.missing_width_mm.fill(missing_mm);
        let cut = loaded(flank.wheel, flank.profile, Some(&damage), &gears.foundation);
        let narrow = narrow_teeth.flank(name);
        let whole = loaded(narrow.wheel, narrow.profile, None, &gears.foundation);
        let compliances = (0..=20).map(|k| {
            let position = teeth.path.contact_ratio * f64::from(k) / 20.0;
            let point = flank.at_curvature(teeth.path.curvature_mm(name, position));
            let load = |z_mm: f64| FlankLoad {
                point,
                sin: point.load_sin,
                cos: point.load_cos,
                z_mm,
                width_mm: WIDTH - missing_mm,
            };
            (cut.compliance_mm_per_n(&load(missing_mm / 2.0)), whole.compliance_mm_per_n(&load(0.0)))
        });
        assert_close(&format!("{} without one end", name.name()), 1e-11, compliances);
    }
}

// Two flanks touch where the line of action crosses both, and push along it: ρ_p + ρ_g is the line's length, R² = Rb² + ρ², and
// to the tooth's centre line the flank's normal stands at α₁ = tan a − (θ0 + inv α), cos a = Rb/R. The points of the profile are
// joined by straight lines: to second order in their distance.
#[test]
fn pairs_touch_on_the_line_of_action() {
    let involute = |angle: f64| angle.tan() - angle;
    for (z1, z2, angle_deg) in [(17, 38, 20.0), (62, 62, 20.0), (80, 90, 14.5)] {
        let mut gears = Gears::new(3.0, z1, z2, WIDTH);
        gears.pressure_angle_deg = angle_deg;
        let teeth = linear_teeth(&gears, 20.0);
        let distance = teeth.pinion.pitch_radius_mm + teeth.gear.pitch_radius_mm;
        let line = distance * f64::to_radians(angle_deg).sin();
        let mut radii = Vec::new();
        for k in 0..=40 {
            let position = teeth.path.contact_ratio * f64::from(k) / 40.0;
            let mut from_tangents = 0.0;
            for name in WheelName::BOTH {
                let (flank, base) = (teeth.flank(name), teeth.wheel(name).base_radius_mm);
                let curvature = teeth.path.curvature_mm(name, position);
                from_tangents += curvature;
                let point = flank.at_curvature(curvature);
                let radius = base.hypot(curvature);
                radii.push((point.x_mm.hypot(point.y_mm), radius));
                let at = (base / radius).acos();
                let half_tooth = PI / (2.0 * f64::from(flank.wheel.teeth));
                let load_angle = at.tan() - (half_tooth + involute(f64::to_radians(angle_deg)));
                let angle = point.load_sin.atan2(point.load_cos);
                assert!((angle - load_angle).abs() < 1e-12, "{z1}/{z2}, {name:?}: {angle} and {load_angle}");
            }
            assert!((from_tangents - line).abs() < 1e-12 * line);
        }
        assert_close(&format!("{z1}/{z2}, radii of contact"), 1e-8, radii);
    }
}

// Evaluated for every loaded point at once, the integrals are expanded in powers of the loaded point; here each is
// evaluated on its own by the same trapezoid: only rounding remains, enlarged by what cancels in the expansion.
#[test]
fn expanded_integrals_equal_the_direct_ones() {
    let gears = example_with_points(2_000);
    let teeth = linear_teeth(&gears, 20.0);
    let (wheel, profile) = (&teeth.pinion, &teeth.pinion_profile);
    let tooth = compliance(wheel, profile, &ToothSection::sound(wheel, profile));
    let (fa, fs) = wheel.pressure_angle_rad.sin_cos();
    let (x, y) = (&profile.x_mm, &profile.y_mm);
    assert_close(
        "expanded bending integral",
        1e-11,
        (300..2_000).step_by(97).map(|i| {
            let density = |k: usize| {
                let moment = fs * (x[k] - x[i]) + fa * y[i];
                moment * moment / (E * WIDTH * (2.0 * y[k]).powi(3) / 12.0)
            };
            let direct = (1..=i).map(|k| 0.5 * (x[k] - x[k - 1]) * (density(k) + density(k - 1))).sum();
            (tooth.bending_mm_per_n[i], direct)
        }),
    );
}

// Another program's value: 3.5559e9 N/m for E 206 GPa, ν 0.3 and 20 mm, given to five digits.
#[test]
fn hertzian_contact() {
    let steel = 1e3 / hertz_compliance_mm_per_n([Material::Steel; 2], 20.0) * 206.0 / 210.0;
    assert_close("contact stiffness", 2e-5, [(steel, 3.5559e9)]);
    for material in Material::ALL {
        let (e, nu) = (material.youngs_modulus_mpa(), material.poisson_ratio());
        let plane_strain = e / (1.0 - nu * nu);
        let compliance = hertz_compliance_mm_per_n([material; 2], 8.0);
        assert_close("contact", 1e-14, [(1.0 / compliance, PI * plane_strain * 8.0 / 4.0)]);
        assert_close(
            "contact is inverse in the width",
            1e-14,
            [(compliance, 3.0 * hertz_compliance_mm_per_n([material; 2], 24.0))],
        );
    }
}

// What both teeth and their contact yield by adds up: steel on bronze and bronze on steel together yield as two of steel and two of bronze.
#[test]
fn wheels_of_two_materials() {
    let compliance = |pinion, gear| {
        let mut gears = example_gears();
        (gears.pinion_material, gears.gear_material) = (Some(pinion), Some(gear));
        let teeth = linear_teeth(&gears, 20.0);
        sound_pairs(&gears, &teeth).at(&SOUND_PAIR, 0.4).stiffness_n_per_mm.recip()
    };
    use Material::{Bronze, Steel};
    let mixed = [compliance(Steel, Bronze), compliance(Bronze, Steel)];
    let [steel, bronze] = [Steel, Bronze].map(|material| compliance(material, material));
    assert_close("two materials", 1e-13, [(mixed[0] + mixed[1], steel + bronze)]);
    assert!(mixed.iter().all(|mixed| 1.2 * steel < *mixed && *mixed < 0.9 * bronze), "{mixed:?}");
    // Hertz: 1/E' is the mean of (1 − ν²)/E of both.
    let reduced = [Steel, Bronze]
        .map(|material| (1.0 - material.poisson_ratio().powi(2)) / material.youngs_modulus_mpa());
    let contact = 2.0 * (reduced[0] + reduced[1]) / (PI * 8.0);
    assert_close("contact", 1e-14, [(hertz_compliance_mm_per_n([Steel, Bronze], 8.0), contact)]);
}

// Sainsot's polynomials, evaluated by hand for θ_f 0.1, h 2: X = 100 A + 4 B + 20 C + 10 D + 2 E + F.
#[test]
fn foundation_at_a_known_point() {
    let (half_root, bore) = (40.0 * 0.1f64.tan(), 20.0);
    let (mut wheel, profile) = bar(101, 4.0, 20.0, |s| half_root - 0.5 * s);
    wheel.root_radius_mm = 40.0;
    wheel.bore_radius_mm = bore;
    let tooth = compliance(&wheel, &profile, &ToothSection::sound(&wheel, &profile));
    let by_hand = [
        -5.574e-3 - 7.9944e-3 - 4.603e-3 + 47.7021e-3 + 54.2e-3 + 6.8045,
        60.111e-3 + 112.4e-3 - 166.862e-3 - 99.256e-3 + 324.8e-3 + 0.9086,
        -50.952e-3 + 742.0e-3 + 0.1076e-3 + 533.0e-3 + 579.0e-3 + 0.9236,
        -6.2042e-3 + 36.3556e-3 - 8.1928e-3 + 78.297e-3 - 294.4e-3 + 0.6904,
    ];
    let (cos, tan) = (20f64.to_radians().cos(), 20f64.to_radians().tan());
    assert_close(
        "foundation",
        1e-12,
        [0, 50, 100].map(|i| {
            // S_f = 2 · 0.1 · 40 = 8.
            let u = (profile.x_mm[i] - 40.0 - profile.y_mm[i] * tan) / 8.0;
            let [l, m, p, q] = by_hand;
            let exact = cos * cos / (E * WIDTH) * (l * u * u + m * u + p * (1.0 + q * tan * tan));
            (tooth.foundation_mm_per_n[i], exact)
        }),
    );
}

// A pair is two teeth and a contact in series: with rigid bodies and a stubby tooth little but the contact remains.
#[test]
fn pair_is_its_parts_in_series() {
    let gears = example_with_points(1_000);
    let teeth = published_teeth(&gears, 20.0);
    let pair = PairStiffness::new(&gears, &teeth, None).unwrap();
    let first = teeth.contact.initial_contact_index;
    let tooth = |wheel: &Wheel, profile: &ToothProfile| {
        let section = ToothSection::sound(wheel, profile);
        ToothCompliance::new(wheel, profile, &section, Material::Steel, &gears.foundation, first)
    };
    let (pinion, gear) =
        (tooth(&teeth.pinion, &teeth.pinion_profile), tooth(&teeth.gear, &teeth.gear_profile));
    let last = teeth.contact.points - 1;
    assert_close(
        "pair in series",
        1e-13,
        pair.healthy_n_per_mm.iter().enumerate().map(|(i, k)| {
            let contact = hertz_compliance_mm_per_n([Material::Steel; 2], WIDTH);
            (1.0 / k, pinion.total_mm_per_n(i) + gear.total_mm_per_n(last - i) + contact)
        }),
    );
}

#[test]
fn pair_of_conjugate_teeth_is_its_parts_in_series() {
    let gears = example_with_points(1_000);
    let teeth = linear_teeth(&gears, 20.0);
    let pairs = sound_pairs(&gears, &teeth);
    assert_close(
        "pair in series",
        1e-13,
        (0..=100).map(|k| {
            let position = teeth.path.contact_ratio * f64::from(k) / 100.0;
            let state = pairs.at(&SOUND_PAIR, position);
            assert_eq!(state.face_centre_m, 0.0);
            let parts = WheelName::BOTH.map(|name| {
                let flank = teeth.flank(name);
                let point = flank.at_curvature(teeth.path.curvature_mm(name, position));
                let load =
                    FlankLoad { point, sin: point.load_sin, cos: point.load_cos, z_mm: 0.0, width_mm: WIDTH };
                loaded(flank.wheel, flank.profile, None, &gears.foundation).compliance_mm_per_n(&load)
            });
            let contact = hertz_compliance_mm_per_n([Material::Steel; 2], WIDTH);
            (1.0 / state.stiffness_n_per_mm, parts[0] + parts[1] + contact)
        }),
    );
}

// The same of conjugate teeth, which start contact wherever they do: of second order in the points' distance.
#[test]
fn conjugate_pair_s_stiffness_converges_with_the_points_of_the_profile() {
    let pair = |points: usize| -> Vec<f64> {
        let gears = example_with_points(points);
        let teeth = linear_teeth(&gears, 20.0);
        let pairs = sound_pairs(&gears, &teeth);
        let at = |k: i32| teeth.path.contact_ratio * f64::from(k) / 500.0;
        (0..=500).map(|k| pairs.at(&SOUND_PAIR, at(k)).stiffness_n_per_mm).collect()
    };
    let exact = pair(160_000);
    for points in [1_000, 2_000, 5_000, 10_000, 20_000] {
        let error = largest(pair(points).iter().zip(&exact).map(|(k, exact)| deviation(*k, *exact)));
        println!("stiffness of a conjugate pair at {points} points: {error:.1e}");
        assert!(error * (points as f64).powi(2) <= 20.0, "{points}: {error:e}");
    }
}

// The default of 10 000 points a tooth against 160 000: the largest difference at equal positions.
// What is left is of first order, since contact starts at a point of the grid: at most a quarter of a step.
#[test]
fn pair_stiffness_converges_with_the_points_of_the_profile() {
    let pair = |points: usize| {
        let gears = example_with_points(points);
        PairStiffness::new(&gears, &published_teeth(&gears, 20.0), None).unwrap()
    };
    let exact = pair(160_000);
    let exact = exact.healthy_curve();
    let worst = |points: usize| {
        let pair = pair(points);
        let curve = pair.healthy_curve();
        largest((0..=500).map(|k| {
            let at = pair.span_rev * f64::from(k) / 500.0;
            deviation(curve.at(at), exact.at(at))
        }))
    };
    for points in [1_000, 2_000, 5_000, 10_000, 20_000] {
        let error = worst(points);
        println!("pair stiffness at {points} points: {error:.1e}");
        assert!(error * points as f64 <= 0.25, "{points}: {error:e}");
    }
}

// Stiffness has one scale: E times a length. Module, width and E only scale it where the bore does too.
#[test]
fn stiffness_scales_with_modulus_and_width_and_not_with_module() {
    let gears = |module: f64, width: f64, material: Material| {
        let mut gears = Gears::new(module, 20, 33, width);
        gears.points_per_tooth = 1_000;
        gears.material = material;
        gears
    };
    let published = |gears: Gears| -> Vec<f64> {
        let teeth = published_teeth(&gears, 6.0 * gears.module_mm);
        PairStiffness::new(&gears, &teeth, None).unwrap().healthy_n_per_mm
    };
    let linear = |gears: Gears| -> Vec<f64> {
        let teeth = linear_teeth(&gears, 6.0 * gears.module_mm);
        let pairs = sound_pairs(&gears, &teeth);
        let at = |k: i32| teeth.path.contact_ratio * f64::from(k) / 200.0;
        (0..=200).map(|k| pairs.at(&SOUND_PAIR, at(k)).stiffness_n_per_mm).collect()
    };
    type Pair<'a> = &'a dyn Fn(Gears) -> Vec<f64>;
    for (name, pair) in [("published", &published as Pair<'_>), ("linear", &linear)] {
        let reference = pair(gears(3.0, 15.0, Material::Copper));
        let check = |what: &str, other: Gears, factor: f64| {
            let expected = reference.iter().map(|k| k * factor);
            assert_close(&format!("{name}, {what}"), 1e-10, pair(other).into_iter().zip(expected));
        };
        check("twice the module", gears(6.0, 15.0, Material::Copper), 1.0);
        check("twice the width", gears(3.0, 30.0, Material::Copper), 2.0);
        // Copper and aluminium have the same Poisson's ratio.
        check("another modulus", gears(3.0, 15.0, Material::Aluminium), 70.0 / 120.0);
    }
}

// With a contact ratio above 2 the mesh is the sum of all pairs; the published sum loses the third.
#[test]
fn mesh_sums_every_pair_in_contact() {
    let mut gears = Gears::new(2.0, 80, 90, 20.0);
    gears.pressure_angle_deg = 14.5;
    gears.points_per_tooth = 1_000;
    gears.tip_chamfer_mm = [Some(0.0); 2];
    let mut scenario = Scenario::new(GearPair::example());
    scenario.model = Model::Linear;
    scenario.set_gears(&gears);
    let stages = meshtone::stages(&scenario).unwrap();
    let ratio = stages.pairs[0].teeth.path.contact_ratio;
    assert!(ratio > 2.2, "{ratio}");
    let pairs = stages.tooth_pairs();
    let mesh = mesh(&stages);
    let pitch = mesh.points_per_pitch;
    // A point stands for the interval around it: where the path ends within it, the pair counts for the part on the path.
    let half = 0.5 / pitch as f64;
    let counts = |at: f64| ((at + half).min(ratio) - (at - half).max(0.0)) / (2.0 * half);
    let sum = (0..pitch).map(|i| {
        let positions = (0..9).map(|age| i as f64 / pitch as f64 + f64::from(age));
        positions
            .filter(|&at| at - half < ratio)
            .map(|at| counts(at) * pairs.at(&SOUND_PAIR, at.min(ratio)).stiffness_n_per_mm)
            .sum()
    });
    assert_close("linear, up to 9 pairs", 1e-12, mesh.healthy_stiffness_n_per_mm().into_iter().zip(sum));

    let teeth = published_teeth(&gears, 20.0);
    let grid = meshtone::operation::CycleGrid::new(80, 90, 1e5);
    let pair = PairStiffness::new(&gears, &teeth, None).unwrap();
    let curve = pair.healthy_curve();
    let sum = |most: usize| -> Vec<f64> {
        (0..grid.points_per_pitch)
            .map(|i| {
                (0..most)
                    .map(|j| i as f64 * grid.coarse_step_rev + j as f64 / 80.0)
                    .filter(|&position| position <= pair.span_rev)
                    .map(|position| curve.at(position))
                    .sum()
            })
            .collect()
    };
    let mesh = MeshStiffness::new(&pair, &grid);
    assert_close("published, up to 2 pairs", 1e-12, mesh.healthy_mesh_n_per_mm.into_iter().zip(sum(2)));
    let lost = mean(&sum(2)) / mean(&sum(9)) - 1.0;
    println!(
        "contact ratio {:.4}: the published mean is off by {:.1} %",
        teeth.contact.contact_ratio,
        100.0 * lost
    );
    assert!(lost < -0.05, "{lost}");
}
