//! The section `[rig]`.

use super::super::{DampingRatio, Rig, Shaft, WheelInertia};
use crate::toml_reader::{ReadResult, TomlTable};

pub(super) fn read(table: &TomlTable<'_>) -> ReadResult<Rig> {
    let default = Rig::default();
    Ok(Rig {
        bearing_stiffness_n_per_m: table
            .number_or("bearing_stiffness_n_per_m", default.bearing_stiffness_n_per_m)?,
        wheel_rotational_stiffness_nm_per_rad: table.number_or(
            "wheel_rotational_stiffness_nm_per_rad",
            default.wheel_rotational_stiffness_nm_per_rad,
        )?,
        brake_inertia_kgm2: table.number_or("brake_inertia_kgm2", default.brake_inertia_kgm2)?,
        damping_ratio: damping_ratio(table, default.damping_ratio)?,
        eccentricity_mm: table.number_or("eccentricity_mm", default.eccentricity_mm)?,
        pinion_shaft: shaft(table, "pinion_shaft", default.pinion_shaft)?,
        gear_shaft: shaft(table, "gear_shaft", default.gear_shaft)?,
        pinion_inertia: inertia(table, "pinion_inertia")?,
        gear_inertia: inertia(table, "gear_inertia")?,
    })
}

fn damping_ratio(table: &TomlTable<'_>, default: DampingRatio) -> ReadResult<DampingRatio> {
    match table.optional("damping_ratio") {
        None => Ok(default),
        Some(value) if value.is_array() => value
            .exactly()
            .map(DampingRatio::PerMode)
            .map_err(|error| error.with_help("give one number for all modes, or 13, one per mode")),
        Some(value) => value.number().map(DampingRatio::Uniform),
    }
}

fn shaft(table: &TomlTable<'_>, key: &'static str, default: Shaft) -> ReadResult<Shaft> {
    table.table_or_empty(key)?.read(|shaft| {
        Ok(Shaft {
            length_mm: shaft.number_or("length_mm", default.length_mm)?,
            radius_mm: shaft.number_or("radius_mm", default.radius_mm)?,
        })
    })
}

fn inertia(table: &TomlTable<'_>, key: &'static str) -> ReadResult<WheelInertia> {
    table.table_or_empty(key)?.read(|wheel| {
        Ok(WheelInertia {
            mass_kg: wheel.number("mass_kg")?,
            polar_inertia_kgm2: wheel.number("polar_inertia_kgm2")?,
            transverse_inertia_kgm2: wheel.number("transverse_inertia_kgm2")?,
        })
    })
}
