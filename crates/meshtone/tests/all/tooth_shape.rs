//! Shape of the tooth and interpolation, against their defining equations.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use std::f64::consts::PI;

use crate::physics::*;
use meshtone::interpolation::{NaturalSpline, NotAKnotSpline, Pchip, UniformLinear};
use meshtone::wheel::{Gears, Root, ToothProfile, Wheel, WheelName, contact_ratio, tooth_profile};

fn involute(angle: f64) -> f64 {
    angle.tan() - angle
}

/// Every wheel from 6 to 120 teeth at common pressure angles whose teeth are not pointed.
fn wheels() -> impl Iterator<Item = Wheel> {
    [14.5, 20.0, 25.0].into_iter().flat_map(|angle| {
        (6..=120).filter_map(move |teeth| {
            let mut gears = Gears::new(3.0, teeth, teeth, 15.0);
            gears.pressure_angle_deg = angle;
            let wheel = Wheel::new(&gears, WheelName::Gear, 2.0);
            let at_tip = (wheel.base_radius_mm / wheel.tip_radius_mm).acos();
            let foot = wheel.half_thickness_angle_rad() + involute(wheel.pressure_angle_rad);
            (foot > involute(at_tip)).then_some(wheel)
        })
    })
}

fn profile(wheel: &Wheel) -> ToothProfile {
    tooth_profile(wheel, 1_000, 0.0, None, Root::Arc)
}

/// (rad) Polar angle of the involute's foot.
fn foot_angle(wheel: &Wheel) -> f64 {
    wheel.half_thickness_angle_rad() + involute(wheel.pressure_angle_rad)
}

/// (mm, rad) Where the involute starts: the larger of base and root circle, and its polar angle there.
fn involute_start(wheel: &Wheel) -> (f64, f64) {
    let start = wheel.base_radius_mm.max(wheel.root_radius_mm);
    (start, foot_angle(wheel) - involute((wheel.base_radius_mm / start).acos()))
}

#[test]
fn radii_are_the_standard_ones() {
    for wheel in wheels() {
        let (z, m) = (f64::from(wheel.teeth), 3.0);
        assert_close(
            "radii",
            1e-15,
            [
                (wheel.pitch_radius_mm, m * z / 2.0),
                (wheel.tip_radius_mm, m * (z + 2.0) / 2.0),
                (wheel.root_radius_mm, m * (z - 2.5) / 2.0),
                (wheel.base_radius_mm, m * z / 2.0 * wheel.pressure_angle_rad.cos()),
            ],
        );
        let profile = profile(&wheel);
        assert_close("tip radius", 1e-14, [(profile.radius_mm(999), wheel.tip_radius_mm)]);
        assert_close("root radius", 1e-14, [(profile.radius_mm(0), wheel.root_radius_mm)]);
        let steps = profile.x_mm.windows(2).map(|x| x[1] - x[0]);
        let step = (profile.x_mm[999] - profile.x_mm[0]) / 999.0;
        assert_close("uniform in x", 1e-9, steps.map(|s| (s, step)));
    }
}

// θ = θ0 + inv α − inv a with cos a = Rb/r, at every point outside the base circle. As a length along the circle.
#[test]
fn involute_points_satisfy_the_involute_equation() {
    let mut worst: f64 = 0.0;
    for wheel in wheels() {
        let profile = profile(&wheel);
        for i in 0..profile.len() {
            let r = profile.radius_mm(i);
            // Where the fillet starts, inv a, of order a³, does not feel the base circle's rounding.
            let (start, start_angle) = involute_start(&wheel);
            if r <= start * (1.0 + 1e-12) || profile.x_mm[i] < start * start_angle.cos() {
                continue;
            }
            let theta = profile.y_mm[i].atan2(profile.x_mm[i]);
            let expected = foot_angle(&wheel) - involute((wheel.base_radius_mm / r).acos());
            worst = worst.max((theta - expected).abs() * r);
        }
    }
    println!("involute equation: {worst:.1e} mm");
    assert!(worst < 1e-12, "{worst:e}");
}

// The base circle's tangent at the roll angle holds the flank point, at the arc's length from it: the string.
#[test]
fn involute_is_a_string_unwound_from_the_base_circle() {
    for wheel in wheels().step_by(7) {
        let profile = profile(&wheel);
        for i in (0..profile.len()).rev().take(300) {
            let (x, y, base) = (profile.x_mm[i], profile.y_mm[i], wheel.base_radius_mm);
            let string = (x * x + y * y - base * base).sqrt();
            let touch = foot_angle(&wheel) - string / base;
            let (dx, dy) = (x - base * touch.cos(), y - base * touch.sin());
            // The string leaves the base circle at a right angle to its radius, and is as long as the arc.
            assert!((dx.hypot(dy) - string).abs() < 1e-11, "{}", wheel.teeth);
            assert!((dx * touch.cos() + dy * touch.sin()).abs() < 1e-11, "{}", wheel.teeth);
        }
    }
}

// The fillet is an arc: it touches the root circle in the middle of the tooth space, and ends where the involute does. Where the root
// circle is larger than the base circle, it is the root circle.
#[test]
fn fillet_is_an_arc_from_root_circle_to_involute() {
    let (mut worst, mut ends, mut count) = (0.0f64, 0.0f64, 0);
    for wheel in wheels() {
        let (root, z) = (wheel.root_radius_mm, f64::from(wheel.teeth));
        let (base, foot) = involute_start(&wheel);
        let psi = PI / z - foot;
        let rho = (root * root + base * base - 2.0 * root * base * psi.cos())
            / (2.0 * base * psi.cos() - 2.0 * root);
        let centre = ((root + rho) * (PI / z).cos(), (root + rho) * (PI / z).sin());
        if psi <= 0.0 {
            continue;
        }
        if root >= wheel.base_radius_mm {
            assert_close("the root circle itself", 1e-9, [(rho, -root)]);
        }
        let rho = rho.abs();
        let profile = profile(&wheel);
        let foot_x = base * foot.cos();
        let arc = profile.x_mm.iter().zip(&profile.y_mm).filter(|(x, _)| **x < foot_x);
        for (x, y) in arc {
            worst = worst.max(((x - centre.0).hypot(y - centre.1) - rho).abs());
            count += 1;
        }
        let start = profile.y_mm[0].atan2(profile.x_mm[0]);
        ends = ends.max((start - PI / z).abs() * root).max((profile.radius_mm(0) - root).abs());
        ends = ends.max(((foot_x - centre.0).hypot(base * foot.sin() - centre.1) - rho).abs());
        // The two curves meet: no step in y across the base circle beyond what the slopes make.
        let joint = profile.x_mm.partition_point(|&x| x < foot_x);
        if joint >= 2 && joint + 2 < profile.len() {
            let y = &profile.y_mm;
            let jump = (y[joint] - y[joint - 1]).abs();
            let around = (y[joint - 1] - y[joint - 2]).abs().max((y[joint + 1] - y[joint]).abs());
            assert!(
                jump <= 3.0 * around + 1e-9,
                "{} teeth, {}: {jump:e} beside {around:e}",
                wheel.teeth,
                wheel.pressure_angle_rad.to_degrees()
            );
        }
    }
    println!("fillet: arc {worst:.1e} mm over {count} points, ends {ends:.1e} mm");
    assert!(count > 1_000 && worst < 1e-10 && ends < 1e-10, "{worst:e} {ends:e}");
}

// The path of contact over the base pitch, from the radii.
#[test]
fn contact_ratio_is_the_path_over_the_base_pitch() {
    assert_close(
        "contact ratio",
        1e-14,
        [(contact_ratio(62, 62, 20f64.to_radians()), 1.789_779_866_833_045_8)],
    );
    assert_close(
        "contact ratio",
        1e-4,
        [
            (contact_ratio(55, 75, 20f64.to_radians()), 1.7940),
            (contact_ratio(25, 30, 20f64.to_radians()), 1.6326),
        ],
    );
    for (z1, z2, angle) in [(17, 38, 20.0), (80, 90, 14.5), (24, 25, 25.0)] {
        let mut gears = Gears::new(2.5, z1, z2, 10.0);
        gears.pressure_angle_deg = angle;
        gears.points_per_tooth = 500;
        let teeth = linear_teeth(&gears, 10.0);
        let (pinion, gear) = (&teeth.pinion, &teeth.gear);
        let distance = (pinion.pitch_radius_mm + gear.pitch_radius_mm) * pinion.pressure_angle_rad.sin();
        let reach = |wheel: &Wheel| (wheel.tip_radius_mm.powi(2) - wheel.base_radius_mm.powi(2)).sqrt();
        let path = reach(pinion) + reach(gear) - distance;
        let base_pitch = 2.0 * PI * pinion.base_radius_mm / f64::from(z1);
        assert_close("contact ratio", 1e-13, [(teeth.contact.contact_ratio, path / base_pitch)]);
        // Contact begins where the gear's tip meets the line of action: both radii belong to one point of it.
        let from_pinion =
            (teeth.contact.pinion_initial_radius_mm.powi(2) - pinion.base_radius_mm.powi(2)).sqrt();
        assert_close("start of contact", 1e-12, [(from_pinion + reach(gear), distance)]);
    }
}

#[test]
fn splines_reproduce_what_they_must() {
    let cubic = |x: f64| 2.0 - x + 0.5 * x * x - 0.25 * x * x * x;
    let points: Vec<f64> = (0..9).map(|i| cubic(f64::from(i) * 0.3)).collect();
    let spline = NotAKnotSpline::uniform(0.0, 0.3, &points);
    let at = |k: i32| f64::from(k) * 0.017;
    // A cubic is its own not-a-knot spline.
    let worst = largest((0..141).map(|k| spline.at(at(k)) - cubic(at(k))));
    assert!(worst < 1e-14, "{worst:e}");
    // A sine is met to fourth order: 16 per halving.
    let error = |n: usize| {
        let step = 3.0 / n as f64;
        let values: Vec<f64> = (0..=n).map(|i| (i as f64 * step).sin()).collect();
        let spline = NotAKnotSpline::uniform(0.0, step, &values);
        largest((0..=1000).map(|k| f64::from(k) * 3e-3).map(|x| spline.at(x) - x.sin()))
    };
    let ratio = error(80) / error(160);
    assert!((ratio.log2() - 4.0).abs() < 0.25, "{ratio}");
    // Natural spline through (0,0), (1,1), (2,0): y'' in the middle −3, so y = x (3 − x²)/2 up to 1.
    let natural = NaturalSpline::new(vec![0.0, 1.0, 2.0], vec![0.0, 1.0, 0.0]);
    let worst =
        largest((0..=20).map(|k| f64::from(k) * 0.05).map(|x| natural.at(x) - x * (3.0 - x * x) / 2.0));
    assert!(worst < 1e-15, "{worst:e}");
}

#[test]
fn pchip_keeps_the_shape() {
    // Inner slopes are the secants' harmonic mean: secants 1 and 3 give 1.5 in the middle of 0, 1, 4; the ends'
    // one-sided slopes are (3·1 − 3)/2 = 0 and (3·3 − 1)/2 = 4.
    let curve = Pchip::uniform(0.0, 1.0, &[0.0, 1.0, 4.0]);
    let hermite = |t: f64, y0: f64, y1: f64, d0: f64, d1: f64| {
        let s = 1.0 - t;
        y0 * (1.0 + 2.0 * t) * s * s + d0 * t * s * s + y1 * t * t * (3.0 - 2.0 * t) - d1 * t * t * s
    };
    for k in 0..=10 {
        let t = f64::from(k) * 0.1;
        assert!((curve.at(t) - hermite(t, 0.0, 1.0, 0.0, 1.5)).abs() < 1e-14);
        assert!((curve.at(1.0 + t) - hermite(t, 1.0, 4.0, 1.5, 4.0)).abs() < 1e-14);
    }
    let line = Pchip::uniform(-1.0, 0.5, &[3.0, 2.0, 1.0, 0.0]);
    let straight = UniformLinear::uniform(-1.0, 0.5, &[3.0, 2.0, 1.0, 0.0]);
    for k in 0..=30 {
        let x = -1.0 + f64::from(k) * 0.05;
        assert!((line.at(x) - (1.0 - 2.0 * x)).abs() < 1e-14);
        assert!((straight.at(x) - (1.0 - 2.0 * x)).abs() < 1e-14);
    }
    let steps = [0.0, 0.0, 0.1, 5.0, 5.0, 5.2, 9.0];
    let curve = Pchip::uniform(0.0, 1.0, &steps);
    let values: Vec<f64> = (0..=600).map(|k| curve.at(f64::from(k) * 0.01)).collect();
    assert!(values.windows(2).all(|pair| pair[1] >= pair[0] - 1e-14), "monotone data, monotone curve");
}
