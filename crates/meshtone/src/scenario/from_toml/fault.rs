//! The section `[fault]`.

use super::super::{
    DestructionLine, Fault, PartialFace, PitCircle, ThroughFace, ToothBreakage, ToothDestruction,
};
use crate::toml_reader::{ReadResult, TomlTable};

type Reader = fn(&TomlTable<'_>) -> ReadResult<Fault>;

const KINDS: [(&str, Reader); 5] = [
    ("missing-tooth", |_| Ok(Fault::MissingTooth)),
    ("tooth-breakage", |table| tooth_breakage(table).map(Fault::ToothBreakage)),
    ("partial-face", |table| partial_face(table).map(Fault::PartialFace)),
    ("through-face", |table| pit(table).map(|pit| Fault::ThroughFace(ThroughFace { pit }))),
    ("tooth-destruction", |table| tooth_destruction(table).map(Fault::ToothDestruction)),
];

impl Fault {
    /// Reads the section or table `fault` of a file, as the scenario file has it.
    ///
    /// # Arguments
    /// * `table` - what the section is in
    ///
    /// None where it is absent.
    ///
    /// # Errors
    /// An unknown kind, a missing or unknown key, a value of the wrong type; ranges are checked with the whole scenario.
    pub fn from_table(table: &TomlTable<'_>) -> ReadResult<Option<Self>> {
        read_optional(table)
    }
}

/// The fault, or none where the section is absent.
pub(super) fn read_optional(root: &TomlTable<'_>) -> ReadResult<Option<Fault>> {
    match root.optional("fault") {
        None => Ok(None),
        Some(value) => value.table()?.read(read).map(Some),
    }
}

fn read(table: &TomlTable<'_>) -> ReadResult<Fault> {
    let names = KINDS.map(|(name, _)| format!("\"{name}\"")).join(", ");
    let meaning = format!("one of {names}; for a healthy pair, leave out the section [fault]");
    let read_kind = table.required("kind", &meaning)?.choice(&KINDS)?;
    read_kind(table)
}

fn tooth_breakage(table: &TomlTable<'_>) -> ReadResult<ToothBreakage> {
    let height = table.required("chip_height_mm", "(mm) the chip's extent from the tip towards the root")?;
    let width = table.required("chip_width_mm", "(mm) the chip's extent along the face, at the tip")?;
    Ok(ToothBreakage {
        chip_height_mm: height.number()?,
        chip_width_mm: width.number()?,
        tip_loss_mm: table.number_or("tip_loss_mm", 0.0)?,
    })
}

fn partial_face(table: &TomlTable<'_>) -> ReadResult<PartialFace> {
    let width = table.required("width_mm", "(mm) the width of the pit along the face")?;
    Ok(PartialFace { width_mm: width.number()?, pit: pit(table)? })
}

fn pit(table: &TomlTable<'_>) -> ReadResult<PitCircle> {
    let circle = table.optional("circle");
    let fractions = ["start", "end", "depth"].map(|key| table.optional(key));
    let any_fraction = fractions.iter().any(Option::is_some);
    match circle {
        Some(_) if any_fraction => Err(table
            .error("circle", "given beside start, end or depth; a pit is described in only one way")
            .with_help("remove circle, or remove start, end and depth")),
        Some(circle) => circle.table()?.read(pit_circle),
        None if any_fraction => Ok(PitCircle::Fractions {
            start: table.required("start", "the pit's first edge as a fraction of the flank")?.number()?,
            end: table.required("end", "the pit's second edge as a fraction of the flank")?.number()?,
            depth: table.required("depth", "the pit's depth over half its chord")?.number()?,
        }),
        None => Err(table
            .error("start", "missing, and circle too; a pit needs one of the two descriptions")
            .with_help("give start, end and depth, or circle = { x_mm = …, y_mm = …, radius_mm = … }")),
    }
}

fn pit_circle(table: &TomlTable<'_>) -> ReadResult<PitCircle> {
    Ok(PitCircle::Circle {
        x_mm: table.required("x_mm", "(mm) the centre's position along the tooth's centre line")?.number()?,
        y_mm: table.required("y_mm", "(mm) the centre's distance from the tooth's centre line")?.number()?,
        radius_mm: table.required("radius_mm", "(mm) the circle's radius")?.number()?,
    })
}

fn tooth_destruction(table: &TomlTable<'_>) -> ReadResult<ToothDestruction> {
    let start = table.required("start", "where the ground line starts, as a fraction of the flank")?;
    Ok(ToothDestruction {
        start: start.number()?,
        line: destruction_line(table)?,
        offset_mm: table.number_or("offset_mm", 0.0)?,
        noise_mm: table.number_or("noise_mm", 0.0)?,
    })
}

fn destruction_line(table: &TomlTable<'_>) -> ReadResult<DestructionLine> {
    match (table.number("end")?, table.number("slope_deg")?) {
        (Some(end), None) => Ok(DestructionLine::End(end)),
        (None, Some(slope_deg)) => Ok(DestructionLine::SlopeDeg(slope_deg)),
        (Some(_), Some(_)) => Err(table
            .error("slope_deg", "given beside end; exactly one of the two says where the line goes")
            .with_help("remove slope_deg, or remove end")),
        (None, None) => Err(table
            .error("end", "missing, and slope_deg too; exactly one of the two says where the line goes")
            .with_help("give end, a fraction of the flank after start, or slope_deg, an angle")),
    }
}
