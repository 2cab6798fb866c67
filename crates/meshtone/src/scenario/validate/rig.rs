//! Rules for `[rig]`.

use super::super::{DampingRatio, Gears, Rig, Shaft, WheelInertia};
use super::rules::{Check, below, positive, positive_up_to, require};

const LONGEST_SHAFT_MM: f64 = 1e6;

pub(super) fn check(rig: &Rig, gears: &Gears) -> Check {
    stiffness("rig.bearing_stiffness_n_per_m", rig.bearing_stiffness_n_per_m, "N/m")?;
    let rotational = rig.wheel_rotational_stiffness_nm_per_rad;
    stiffness("rig.wheel_rotational_stiffness_nm_per_rad", rotational, "N m/rad")?;
    mass("rig.brake_inertia_kgm2", rig.brake_inertia_kgm2, "kg m²")?;
    damping(&rig.damping_ratio)?;
    below("rig.eccentricity_mm", rig.eccentricity_mm, gears.module_mm, "the module")?;
    shaft("pinion", &rig.pinion_shaft, gears.pinion_teeth, gears.module_mm)?;
    shaft("gear", &rig.gear_shaft, gears.gear_teeth, gears.module_mm)?;
    inertia("pinion", &rig.pinion_inertia)?;
    inertia("gear", &rig.gear_inertia)
}

/// Beyond these the equations are solved in rounding errors.
const STIFFEST: f64 = 1e15;
const HEAVIEST: f64 = 1e9;

fn stiffness(key: &str, value: f64, unit: &str) -> Check {
    positive_up_to(key, value, STIFFEST, unit)
}

fn mass(key: &str, value: f64, unit: &str) -> Check {
    positive_up_to(key, value, HEAVIEST, unit)
}

fn damping(damping: &DampingRatio) -> Check {
    let check = |key: &str, ratio: f64| {
        require(
            key,
            ratio,
            (0.0..1.0).contains(&ratio),
            "must be from 0 to less than 1 (1 is critical damping)",
        )
        .map_err(|error| error.with_help("a usual ratio is 0.05, which is 5 %"))
    };
    match damping {
        DampingRatio::Uniform(ratio) => check("rig.damping_ratio", *ratio),
        DampingRatio::PerMode(ratios) => ratios
            .iter()
            .enumerate()
            .try_for_each(|(mode, ratio)| check(&format!("rig.damping_ratio[{mode}]"), *ratio)),
    }
}

fn shaft(wheel: &str, shaft: &Shaft, teeth: u32, module_mm: f64) -> Check {
    positive_up_to(&format!("rig.{wheel}_shaft.length_mm"), shaft.length_mm, LONGEST_SHAFT_MM, "mm")?;
    let key = format!("rig.{wheel}_shaft.radius_mm");
    let root_radius_mm = module_mm * (f64::from(teeth) / 2.0 - 1.25);
    positive(&key, shaft.radius_mm, "mm")?;
    let limit_is = format!("the root radius of the {wheel}, whose bore it fills");
    below(&key, shaft.radius_mm, root_radius_mm, &limit_is)
}

fn inertia(wheel: &str, inertia: &WheelInertia) -> Check {
    [
        ("mass_kg", inertia.mass_kg, "kg"),
        ("polar_inertia_kgm2", inertia.polar_inertia_kgm2, "kg m²"),
        ("transverse_inertia_kgm2", inertia.transverse_inertia_kgm2, "kg m²"),
    ]
    .into_iter()
    .filter_map(|(name, value, unit)| value.map(|value| (name, value, unit)))
    .try_for_each(|(name, value, unit)| mass(&format!("rig.{wheel}_inertia.{name}"), value, unit))
}
