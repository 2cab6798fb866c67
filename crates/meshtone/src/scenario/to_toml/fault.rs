//! The section `[fault]`.

use super::super::{DestructionLine, Fault, PitCircle};
use super::writer::Section;

pub(super) fn section(fault: &Fault) -> Section {
    let mut section = Section::new("fault");
    section.text("kind", fault.kind());
    match fault {
        Fault::MissingTooth => {}
        Fault::ToothBreakage(breakage) => {
            section
                .number("chip_height_mm", breakage.chip_height_mm)
                .number("chip_width_mm", breakage.chip_width_mm)
                .number("tip_loss_mm", breakage.tip_loss_mm);
        }
        Fault::PartialFace(face) => {
            section.number("width_mm", face.width_mm);
            pit(&mut section, &face.pit);
        }
        Fault::ThroughFace(face) => pit(&mut section, &face.pit),
        Fault::ToothDestruction(destruction) => {
            section.number("start", destruction.start);
            match destruction.line {
                DestructionLine::End(end) => section.number("end", end),
                DestructionLine::SlopeDeg(slope) => section.number("slope_deg", slope),
            };
            section.number("offset_mm", destruction.offset_mm).number("noise_mm", destruction.noise_mm);
        }
    }
    section
}

fn pit(section: &mut Section, pit: &PitCircle) {
    match *pit {
        PitCircle::Fractions { start, end, depth } => {
            section.number("start", start).number("end", end).number("depth", depth);
        }
        PitCircle::Circle { x_mm, y_mm, radius_mm } => {
            section.table("circle", &[("x_mm", x_mm), ("y_mm", y_mm), ("radius_mm", radius_mm)]);
        }
    }
}
