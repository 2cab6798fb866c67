//! Closed forms and limits of the stiffness: each compliance on shapes whose compliance is known, sections against
//! quadrature, and what a tooth's compliances do as the profile is refined.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use std::f64::consts::PI;

use crate::physics::*;
use meshtone::fault::{FaultDescription, LateralBending, ToothSection, fault_geometry};
use meshtone::scenario::{Convention, Fault, FoundationCoefficients, Material, PartialFace, PitCircle};
use meshtone::stiffness::{MeshStiffness, PairStiffness, ToothCompliance, hertz_compliance_mm_per_n};
use meshtone::tooth::{ToothProfile, Wheel};

const E: f64 = 210e3;
const G: f64 = E / 2.6;
const WIDTH: f64 = 15.0;

/// A bar along x, `length` long, whose half thickness is `half(x − x_0)`, with its wheel.
fn bar(points: usize, length: f64, alpha_deg: f64, half: impl Fn(f64) -> f64) -> (Wheel, ToothProfile) {
    let depth = |i: usize| length * i as f64 / (points - 1) as f64;
    let profile = ToothProfile {
        x_mm: (0..points).map(|i| 40.0 + depth(i)).collect(),
        y_mm: (0..points).map(|i| half(depth(i))).collect(),
        tip_relief_index: None,
    };
    let mut gears = plain_gears(3.0, 30, 30, WIDTH);
    gears.pressure_angle_deg = alpha_deg;
    (Wheel::new(&gears, 30, 10.0), profile)
}

fn compliance(wheel: &Wheel, profile: &ToothProfile, section: &ToothSection) -> ToothCompliance {
    let foundation = FoundationCoefficients::default();
    ToothCompliance::new(wheel, profile, section, Material::Steel, &foundation, 0)
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

// The integrands are polynomials of degree 4 at most, for which five Gauss points are exact: rounding only.
#[test]
fn section_of_a_partial_pit_by_quadrature() {
    let mut gears = plain_gears(3.0, 17, 38, WIDTH);
    gears.points_per_tooth = 2_000;
    let teeth = corrected_teeth(&gears, 20.0);
    let pit = PitCircle::Fractions { start: 0.2, end: 0.8, depth: 0.7 };
    let width_mm = 6.0;
    let fault = Fault::PartialFace(PartialFace { width_mm, pit });
    let fault = fault_geometry(&fault, &teeth, Convention::Corrected, 1).unwrap();
    let FaultDescription::FaceFault { pit, .. } = fault.description else { panic!("a pit") };
    let lateral = fault.gear.lateral.as_ref().unwrap();
    let yc = fault.gear.yc_mm.as_ref().unwrap();
    let mut pairs: [Vec<(f64, f64)>; 3] = Default::default();
    for i in (pit.start_index..=pit.end_index).step_by(37) {
        let (y, cut) = (teeth.gear_profile.y_mm[i], fault.flank_y_mm[i]);
        let left = |at: f64| if at < cut { -WIDTH / 2.0 } else { -WIDTH / 2.0 + width_mm };
        let steps = [-y, cut, y];
        let section = quadrature(&steps, |at| (left(at), WIDTH / 2.0));
        pairs[0].extend([
            (fault.gear.area_mm2[i], section.area),
            (yc[i], section.yc),
            (lateral.zc_mm[i], section.zc),
            (fault.gear.iz_mm4[i], section.iz),
            (lateral.iy_mm4[i], section.iy),
        ]);
        pairs[1].push((lateral.iyz_mm4[i], section.iyz));
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
        pairs[2].push((fault.gear.shear_per_mm2[i], energy / (2.0 * section.iz.powi(2))));
    }
    let [section, product, shear] = pairs;
    assert_close("section of a partial pit", 1e-12, section);
    // Iyz is a difference of larger terms at the pit's edges, where the cut is shallow.
    assert_close("product of inertia of a partial pit", 1e-9, product);
    assert_close("shear integral of a partial pit", 1e-12, shear);
}

/// (N mm) Strain energy per mm of length of the section made of `steps` and `strip` under the axial force `−force`
/// at (y, z) and the moment `∫ σ y dA = moment`, both about the section's centre: the linear stress that is in
/// equilibrium with them, squared and integrated. No sign convention of moments enters.
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
    let value = |published_coupling: bool| {
        let mut section = ToothSection::sound(&wheel, &profile);
        section.iz_mm4 = vec![cut.iz; points];
        section.yc_mm = Some(vec![cut.yc; points]);
        section.lateral = Some(LateralBending {
            iy_mm4: vec![cut.iy; points],
            iyz_mm4: vec![cut.iyz; points],
            zc_mm: vec![cut.zc; points],
            load_z_mm: vec![load_z; points],
            published_coupling,
        });
        compliance(&wheel, &profile, &section).bending_mm_per_n[points - 1]
    };
    assert_close("unsymmetric bending", 1e-11, [(value(false), exact + trapezoid)]);
    let slip = deviation(value(true), exact + trapezoid);
    println!("unsymmetric bending with the published sign of the coupling: {:.1} %", 100.0 * slip);
    assert!(slip.abs() > 0.01, "the section is asymmetric enough to tell the two signs apart");
}

// Evaluated for every loaded point at once, the integrals are expanded in powers of the loaded point; here each is
// evaluated on its own by the same trapezoid: only rounding remains, enlarged by what cancels in the expansion.
#[test]
fn expanded_integrals_equal_the_direct_ones() {
    let mut gears = plain_gears(3.0, 17, 38, WIDTH);
    gears.points_per_tooth = 2_000;
    let teeth = corrected_teeth(&gears, 20.0);
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
    let steel = 1e3 / hertz_compliance_mm_per_n(Material::Steel, 20.0) * 206.0 / 210.0;
    assert_close("contact stiffness", 2e-5, [(steel, 3.5559e9)]);
    for material in Material::ALL {
        let (e, nu) = (material.youngs_modulus_mpa(), material.poisson_ratio());
        let plane_strain = e / (1.0 - nu * nu);
        let compliance = hertz_compliance_mm_per_n(material, 8.0);
        assert_close("contact", 1e-14, [(1.0 / compliance, PI * plane_strain * 8.0 / 4.0)]);
        assert_close(
            "contact is inverse in the width",
            1e-14,
            [(compliance, 3.0 * hertz_compliance_mm_per_n(material, 24.0))],
        );
    }
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
    let mut gears = plain_gears(3.0, 17, 38, WIDTH);
    gears.points_per_tooth = 1_000;
    let teeth = corrected_teeth(&gears, 20.0);
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
            let contact = hertz_compliance_mm_per_n(Material::Steel, WIDTH);
            (1.0 / k, pinion.total_mm_per_n(i) + gear.total_mm_per_n(last - i) + contact)
        }),
    );
}

// The default of 10 000 points a tooth against 160 000: the largest difference at equal positions.
// What is left is of first order, since contact starts at a point of the grid: at most a quarter of a step.
#[test]
fn pair_stiffness_converges_with_the_points_of_the_profile() {
    let pair = |points: usize| {
        let mut gears = plain_gears(3.0, 17, 38, WIDTH);
        gears.points_per_tooth = points;
        PairStiffness::new(&gears, &corrected_teeth(&gears, 20.0), None).unwrap()
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
    let pair = |module: f64, width: f64, material: Material| {
        let mut gears = plain_gears(module, 20, 33, width);
        gears.points_per_tooth = 1_000;
        gears.material = material;
        PairStiffness::new(&gears, &corrected_teeth(&gears, 6.0 * module), None).unwrap().healthy_n_per_mm
    };
    let reference = pair(3.0, 15.0, Material::Copper);
    let zip = |other: Vec<f64>, factor: f64| {
        other.into_iter().zip(reference.clone()).map(move |(a, b)| (a, b * factor)).collect::<Vec<_>>()
    };
    assert_close("twice the module", 1e-10, zip(pair(6.0, 15.0, Material::Copper), 1.0));
    assert_close("twice the width", 1e-10, zip(pair(3.0, 30.0, Material::Copper), 2.0));
    // Copper and aluminium have the same Poisson's ratio.
    assert_close("another modulus", 1e-10, zip(pair(3.0, 15.0, Material::Aluminium), 70.0 / 120.0));
}

// With a contact ratio above 2 the mesh is the sum of all pairs; the published sum loses the third.
#[test]
fn mesh_sums_every_pair_in_contact() {
    let mut gears = plain_gears(2.0, 80, 90, 20.0);
    gears.pressure_angle_deg = 14.5;
    gears.points_per_tooth = 1_000;
    let teeth = corrected_teeth(&gears, 20.0);
    assert!(teeth.contact.contact_ratio > 2.2, "{}", teeth.contact.contact_ratio);
    let grid = meshtone::sampling::CycleGrid::new(80, 90, 1e5);
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
    for (convention, most) in [(Convention::Corrected, 9), (Convention::Published, 2)] {
        let mesh = MeshStiffness::new(&pair, &grid, convention);
        assert_close(
            &format!("{convention:?}, up to {most} pairs"),
            1e-12,
            mesh.healthy_mesh_n_per_mm.into_iter().zip(sum(most)),
        );
    }
    let lost = mean(&sum(2)) / mean(&sum(9)) - 1.0;
    println!(
        "contact ratio {:.4}: the published mean is off by {:.1} %",
        teeth.contact.contact_ratio,
        100.0 * lost
    );
    assert!(lost < -0.05, "{lost}");
}
