//! The section `[gears]`.

use super::super::{FoundationCoefficients, Gears, Material, ReliefShape, TipRelief};
use crate::toml_reader::{ReadResult, TomlTable, TomlValue};

pub(super) const RELIEF_SHAPES: [(&str, ReliefShape); 2] =
    [("parabolic", ReliefShape::Parabolic), ("linear", ReliefShape::Linear)];

pub(super) fn read(table: &TomlTable<'_>) -> ReadResult<Gears> {
    let module_mm = table.required("module_mm", "(mm) the module of both wheels")?.number()?;
    let pinion_teeth = teeth(table, "pinion_teeth", "the tooth count of the driving wheel")?;
    let gear_teeth = teeth(table, "gear_teeth", "the tooth count of the driven wheel")?;
    let face_width_mm = table.required("face_width_mm", "(mm) the face width of both wheels")?.number()?;
    let default = Gears::new(module_mm, pinion_teeth, gear_teeth, face_width_mm);
    Ok(Gears {
        pressure_angle_deg: table.number_or("pressure_angle_deg", default.pressure_angle_deg)?,
        material: material(table)?,
        tip_relief: table
            .optional("tip_relief")
            .map_or(Ok(default.tip_relief), |value| tip_relief(&value))?,
        crowning_mm: table.number_or("crowning_mm", default.crowning_mm)?,
        points_per_tooth: points_per_tooth(table, default.points_per_tooth)?,
        foundation: table.table_or_empty("foundation")?.read(foundation)?,
        ..default
    })
}

fn teeth(table: &TomlTable<'_>, key: &'static str, meaning: &str) -> ReadResult<u32> {
    let count = table.required(key, meaning)?.integer(0..=u64::from(u32::MAX))?;
    Ok(u32::try_from(count).unwrap_or(u32::MAX))
}

fn material(table: &TomlTable<'_>) -> ReadResult<Material> {
    let choices = Material::ALL.map(|material| (material.name(), material));
    Ok(table.optional("material").map(|value| value.choice(&choices)).transpose()?.unwrap_or_default())
}

fn points_per_tooth(table: &TomlTable<'_>, default: usize) -> ReadResult<usize> {
    let Some(value) = table.optional("points_per_tooth") else {
        return Ok(default);
    };
    let points = value.integer(0..=u64::from(u32::MAX))?;
    Ok(usize::try_from(points).unwrap_or(usize::MAX))
}

fn tip_relief(value: &TomlValue<'_>) -> ReadResult<Option<TipRelief>> {
    if value.is_table() {
        return value.table()?.read(relief_table).map(Some);
    }
    match value.boolean() {
        Ok(false) => Ok(None),
        Ok(true) => Err(value
            .error("must be a table { shape = …, length_mm = …, depth_mm = … }, or false for no relief")
            .with_help("remove the line for the default relief: parabolic, 1 mm × 1 mm")),
        Err(_) => Err(value.wrong_type("a table { shape = …, length_mm = …, depth_mm = … }, or false")),
    }
}

fn relief_table(table: &TomlTable<'_>) -> ReadResult<TipRelief> {
    let default = TipRelief::default();
    let shape = table.optional("shape").map(|value| value.choice(&RELIEF_SHAPES)).transpose()?;
    Ok(TipRelief {
        shape: shape.unwrap_or(default.shape),
        length_mm: table.number_or("length_mm", default.length_mm)?,
        depth_mm: table.number_or("depth_mm", default.depth_mm)?,
    })
}

fn foundation(table: &TomlTable<'_>) -> ReadResult<FoundationCoefficients> {
    let default = FoundationCoefficients::default();
    let coefficients = |key, default| table.optional(key).map_or(Ok(default), |value| value.exactly());
    Ok(FoundationCoefficients {
        l: coefficients("L", default.l)?,
        m: coefficients("M", default.m)?,
        p: coefficients("P", default.p)?,
        q: coefficients("Q", default.q)?,
    })
}
