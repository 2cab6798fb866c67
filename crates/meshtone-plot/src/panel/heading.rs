//! Title, key facts and the columns' headings.

use meshtone::Stages;
use meshtone::scenario::{Gears, Model, Operation, Scenario};

use super::damage;
use super::side::Side;
use crate::canvas::{Canvas, Pixel};
use crate::style::{Stroke, TextStyle, colour};
use crate::text::fitted;
use crate::ticks::number;
use crate::{DamagedTooth, damaged_tooth, font};

/// (px) From the panel's edge to the headings.
const EDGE: f64 = super::LEFT - super::NAME_LEFT - 11.0;

/// The faults and their sizes.
pub(super) fn title(stages: &Stages) -> String {
    let room = f64::from(super::WIDTH) - 2.0 * EDGE;
    let width = |text: &str| font::text_width(text, TextStyle::TITLE.size, TextStyle::TITLE.bold);
    fitted(&damage::title(stages, |text| width(text) <= room), TextStyle::TITLE, room)
}

/// The panel in a sentence, for readers who cannot see it.
pub(super) fn description(stages: &Stages) -> String {
    format!(
        "Results panel of a simulated spur gear pair: teeth, tooth faces, profile errors, averages over the \
         shafts' revolutions and mesh stiffness. {}.",
        facts(&stages.scenario).join(", ")
    )
}

pub(super) fn draw(canvas: &mut Canvas, title: &str, stages: &Stages) {
    canvas.text((EDGE, 36.0), title, TextStyle::TITLE);
    let facts = facts(&stages.scenario).join("  ·  ");
    canvas.text((EDGE, 61.0), &facts, TextStyle::FACTS);
}

pub(super) fn column(canvas: &mut Canvas, (left, baseline): Pixel, width: f64, side: &Side) {
    let damage = damaged_teeth(&side.damaged);
    let text = format!("{}, {}: {} teeth{damage}", side.name, side.shaft, side.wheel.teeth);
    canvas.text((left, baseline), &text, TextStyle::HEADING);
    let rule = Stroke::solid(colour::INK, 1.2);
    canvas.line((left, baseline + 8.0), (left + width, baseline + 8.0), rule);
}

fn facts(scenario: &Scenario) -> Vec<String> {
    let gears = &scenario.gears;
    let wheels = vec![
        format!("{} and {} teeth", gears.pinion_teeth, gears.gear_teeth),
        format!("module {} mm", number(gears.module_mm)),
        format!("face width {} mm", number(gears.face_width_mm)),
        format!("pressure angle {}°", number(gears.pressure_angle_deg)),
    ];
    let run = [
        speed(&scenario.operation),
        torque(&scenario.operation),
        quality(scenario),
        match scenario.model {
            Model::Published => "model as published".to_owned(),
            other => format!("{} model", other.name()),
        },
    ];
    wheels.into_iter().chain(mounting(gears)).chain(run).collect()
}

/// Profile shifts and centre distance, where they are not the standard's.
fn mounting(gears: &Gears) -> impl Iterator<Item = String> {
    let shifts = [gears.pinion_profile_shift, gears.gear_profile_shift];
    let shifted = (shifts != [0.0; 2])
        .then(|| format!("profile shift {} and {}", number(shifts[0]), number(shifts[1])));
    let distance =
        gears.centre_distance_mm.map(|distance_mm| format!("axes {} mm apart", number(distance_mm)));
    shifted.into_iter().chain(distance)
}

/// Which teeth are missing and which are damaged.
fn damaged_teeth(damaged: &[DamagedTooth]) -> String {
    let (missing, others): (Vec<DamagedTooth>, Vec<DamagedTooth>) =
        damaged.iter().partition(|tooth| tooth.is_missing);
    let named = |teeth: &[DamagedTooth], state: &str| match teeth {
        [] => String::new(),
        [DamagedTooth { tooth: 1, .. }] => format!(", the first one {state}"),
        teeth => format!(", {} {state}", damaged_tooth::numbered("", teeth)),
    };
    named(&missing, "missing") + &named(&others, "damaged")
}

fn speed(operation: &Operation) -> String {
    match operation.speed_profile_hz.as_ref().and_then(|profile| extremes(&profile.value)) {
        Some((low, high)) => format!("pinion speed {} to {} Hz", number(low), number(high)),
        None => format!("pinion speed {} Hz", number(operation.pinion_speed_hz)),
    }
}

fn torque(operation: &Operation) -> String {
    match operation.torque_profile_nm.as_ref().and_then(|profile| extremes(&profile.value)) {
        Some((low, high)) => format!("brake torque {} to {} N·m", number(low), number(high)),
        None => format!("brake torque {} N·m", number(operation.brake_torque_nm)),
    }
}

fn extremes(values: &[f64]) -> Option<(f64, f64)> {
    let first = *values.first()?;
    Some(values.iter().fold((first, first), |(low, high), &value| (low.min(value), high.max(value))))
}

fn quality(scenario: &Scenario) -> String {
    let quality = &scenario.quality;
    let contact = scenario.model == Model::Contact;
    match (&quality.profile_errors, quality.iso_class, quality.din_grade) {
        (Some(_), ..) => "given profile errors".to_owned(),
        (None, class @ 1.., _) if contact => format!("ISO 1328-1 class {class}"),
        (None, _, 0) => "ideal teeth".to_owned(),
        (None, _, grade) if contact => format!("DIN 3961 grade {grade}"),
        (None, _, grade) => format!("DIN 3962 grade {grade}"),
    }
}
