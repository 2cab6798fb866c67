//! A working flank that has been ground down along a straight line.

use super::face_circle::flank_index;
use super::{ContactWidth, Displacement, FaultDescription, FaultGeometry, ToothSection};
use crate::random::{Draws, Purpose};
use crate::scenario::{Convention, DestructionLine, ScenarioError, ToothDestruction};
use crate::tooth::Teeth;

pub(super) fn geometry(
    fault: &ToothDestruction,
    teeth: &Teeth,
    convention: Convention,
    seed: u64,
) -> Result<FaultGeometry, ScenarioError> {
    let profile = &teeth.gear_profile;
    let contact = &teeth.contact;
    let first_contact = contact.initial_contact_index;
    let least_start = -(first_contact as f64) / (contact.points - 1) as f64;
    if fault.start < least_start {
        let problem = format!("must be at least {least_start:.4}, where this tooth has its root");
        return Err(ScenarioError::new("fault.start", format!("{:?}", fault.start), problem));
    }
    let start = flank_index(fault.start, profile, first_contact);
    let (x_start, y_start) = (profile.x_mm[start], profile.y_mm[start] - fault.offset_mm);
    let tangent = match fault.line {
        DestructionLine::SlopeDeg(slope) => -slope.abs().to_radians().tan(),
        DestructionLine::End(end) => {
            let end = flank_index(end, profile, first_contact);
            if end == start {
                return Err(ScenarioError::new("fault.end", "", "must lie beyond the start of the line"));
            }
            (profile.y_mm[end] - fault.offset_mm - y_start) / (profile.x_mm[end] - x_start)
        }
    };
    let line = |x: f64| y_start + tangent * (x - x_start);
    let first = start.max(first_contact);
    let last = (first..profile.len())
        .rev()
        .find(|&i| line(profile.x_mm[i]) < profile.y_mm[i])
        .filter(|&last| last > first)
        .ok_or_else(|| {
            ScenarioError::new(
                "fault.start",
                fault.start,
                "the line must cut the flank: nowhere beyond its start does it lie below the flank",
            )
            .with_help("increase fault.offset_mm, or the slope or the distance from start to end")
        })?;

    let mut flank_y_mm = profile.y_mm.clone();
    let mut roughness = Draws::new(seed, Purpose::DestructionNoise, 0);
    for i in first..=last {
        let ground = line(profile.x_mm[i]) + roughness.uniform(0.0, fault.noise_mm);
        flank_y_mm[i] = match convention {
            // Convention: where line or roughness lie outside the flank, the published code adds metal.
            Convention::Published => ground,
            Convention::Corrected => ground.min(profile.y_mm[i]),
        };
        if flank_y_mm[i] <= -profile.y_mm[i] {
            return Err(ScenarioError::new(
                "fault",
                format!("offset_mm = {}, slope {:.3}°", fault.offset_mm, tangent.atan().to_degrees()),
                format!(
                    "must leave some of the tooth, which is {:.3} mm thick at x = {:.3} mm",
                    2.0 * profile.y_mm[i],
                    profile.x_mm[i]
                ),
            ));
        }
    }

    let slope_rad = tangent.atan();
    // In the order of contact: the gear's tooth enters at its tip.
    let displacement_mm = (first_contact..profile.len())
        .rev()
        .map(|i| {
            let flank_angle = if i == 0 {
                0.0
            } else {
                ((profile.y_mm[i] - profile.y_mm[i - 1]) / (profile.x_mm[i] - profile.x_mm[i - 1]))
                    .atan()
                    .abs()
            };
            -(profile.y_mm[i] - flank_y_mm[i]) * slope_rad.cos() / (flank_angle + slope_rad).cos()
        })
        .collect();
    Ok(FaultGeometry {
        gear: ToothSection::cut_flank(teeth.gear.face_width_mm, profile, &flank_y_mm),
        pinion: ToothSection::sound(&teeth.pinion, &teeth.pinion_profile),
        no_contact: 0..0,
        contact_width: ContactWidth::Whole,
        displacement: Displacement::Pair { displacement_mm },
        flank_y_mm,
        description: FaultDescription::ToothDestruction { start_index: start, end_index: last, slope_rad },
    })
}
