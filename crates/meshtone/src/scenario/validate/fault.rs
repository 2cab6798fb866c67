//! Rules for `[fault]`.

use super::super::{DestructionLine, Fault, Gears, PartialFace, PitCircle, ToothBreakage, ToothDestruction};
use super::gears::{HALF_THICKNESS, half_thickness_mm, tooth_height_mm};
use super::rules::{Check, below, finite, positive, require};

pub(super) fn check(fault: Option<&Fault>, gears: &Gears) -> Check {
    match fault {
        None | Some(Fault::MissingTooth) => Ok(()),
        Some(Fault::ToothBreakage(breakage)) => tooth_breakage(breakage, gears),
        Some(Fault::PartialFace(face)) => partial_face(face, gears),
        Some(Fault::ThroughFace(face)) => pit(&face.pit),
        Some(Fault::ToothDestruction(destruction)) => tooth_destruction(destruction, gears),
    }
}

fn tooth_breakage(breakage: &ToothBreakage, gears: &Gears) -> Check {
    let height = tooth_height_mm(gears.module_mm);
    positive("fault.chip_height_mm", breakage.chip_height_mm, "mm")?;
    below("fault.chip_height_mm", breakage.chip_height_mm, height, "the tooth's height (2.25 modules)")?;
    let width = breakage.chip_width_mm;
    positive("fault.chip_width_mm", width, "mm")?;
    require(
        "fault.chip_width_mm",
        width,
        width <= gears.face_width_mm,
        format!("must be at most {} mm, gears.face_width_mm", gears.face_width_mm),
    )?;
    below("fault.tip_loss_mm", breakage.tip_loss_mm, height, "the tooth's height (2.25 modules)")
}

fn partial_face(face: &PartialFace, gears: &Gears) -> Check {
    let width = face.width_mm;
    positive("fault.width_mm", width, "mm")?;
    let problem = format!("must be less than {} mm, gears.face_width_mm", gears.face_width_mm);
    require("fault.width_mm", width, width < gears.face_width_mm, problem)
        .map_err(|error| error.with_help("for a pit over the whole width, use kind = \"through-face\""))?;
    pit(&face.pit)
}

fn pit(pit: &PitCircle) -> Check {
    match *pit {
        PitCircle::Circle { x_mm, y_mm, radius_mm } => {
            positive("fault.circle.x_mm", x_mm, "mm")?;
            finite("fault.circle.y_mm", y_mm)?;
            positive("fault.circle.radius_mm", radius_mm, "mm")
        }
        PitCircle::Fractions { start, end, depth } => {
            let flank = "0 is where contact starts at the root side, 1 the tip";
            require(
                "fault.start",
                start,
                (0.0..1.0).contains(&start),
                format!("must be from 0 to less than 1; {flank}"),
            )?;
            end_after("fault.end", start, end)?;
            require("fault.depth", depth, depth > 0.0 && depth <= 1.0, "must be more than 0 and at most 1")
                .map_err(|error| {
                    error.with_help("depth is relative: the depth of the pit over half its chord")
                })
        }
    }
}

fn end_after(key: &str, start: f64, end: f64) -> Check {
    let problem = format!("must be more than fault.start, {start:?}, and at most 1");
    require(key, end, end > start && end <= 1.0, problem)
}

fn tooth_destruction(destruction: &ToothDestruction, gears: &Gears) -> Check {
    let start = destruction.start;
    let inside = start > -1.0 && start < 1.0;
    require("fault.start", start, inside, "must be more than -1 and less than 1 (negative: below contact)")?;
    match destruction.line {
        DestructionLine::End(end) => end_after("fault.end", start, end)?,
        DestructionLine::SlopeDeg(slope) => {
            let problem = "must be more than 0° and less than 90°";
            require("fault.slope_deg", slope, slope > 0.0 && slope < 90.0, problem)?;
        }
    }
    let thickness = half_thickness_mm(gears.module_mm);
    below("fault.offset_mm", destruction.offset_mm, thickness, HALF_THICKNESS)?;
    below("fault.noise_mm", destruction.noise_mm, thickness, HALF_THICKNESS)
}
