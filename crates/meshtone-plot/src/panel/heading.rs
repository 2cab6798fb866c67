//! Title, key facts and the columns' headings.

use meshtone::Stages;
use meshtone::scenario::{Gears, Hand, Scenario};

use super::damage;
use super::side::Side;
use crate::drawing::{Canvas, Pixel, TextStyle, WIDTH, number};
use crate::{DamagedTooth, damaged_tooth};

/// (px) Width of the headings.
const ROOM: f64 = WIDTH as f64 - 2.0 * super::EDGE;

/// The faults and their sizes.
pub(super) fn title(scenario: &Scenario, stages: &Stages) -> String {
    let title = damage::title(scenario, stages, |text| TextStyle::TITLE.width(text) <= ROOM);
    TextStyle::TITLE.fitted(&title, ROOM)
}

pub(super) fn column(canvas: &mut Canvas, (left, baseline): Pixel, width: f64, side: &Side) {
    let damage = damaged_teeth(&side.damaged);
    let text = format!("{}, {}: {} teeth{damage}", side.name, side.shaft, side.wheel.teeth);
    canvas.section((left, baseline), width, &text, 8.0);
}

pub(super) fn facts(scenario: &Scenario) -> Vec<String> {
    let gears = &scenario.gears();
    let operation = &scenario.operation;
    let speeds_hz = operation.speed_profile_hz.as_ref().map(|profile| &profile.value[..]);
    let torques_nm = operation.torque_profile_nm.as_ref().map(|profile| &profile.value[..]);
    let wheels = vec![
        format!("{} and {} teeth", gears.pinion_teeth, gears.gear_teeth),
        format!("{} mm", module(gears)),
        format!("face width {} mm", number(gears.face_width_mm)),
        format!("pressure angle {}°", number(gears.pressure_angle_deg)),
    ];
    let run = [
        format!("pinion speed {} Hz", extent(operation.pinion_speed_hz, speeds_hz)),
        format!("brake torque {} N·m", extent(operation.brake_torque_nm, torques_nm)),
        quality(scenario),
        match scenario.model.has_meshes() {
            true => format!("{} model", scenario.model.name()),
            false => "model as published".to_owned(),
        },
    ];
    wheels.into_iter().chain(helix(gears)).chain(mounting(gears)).chain(run).collect()
}

/// The module with its section, in mm.
pub(super) fn module(gears: &Gears) -> String {
    let name = if gears.is_helical() { "normal module" } else { "module" };
    format!("{name} {}", number(gears.module_mm))
}

/// The helix angle of helical wheels, with the hand of the driving one.
pub(super) fn helix(gears: &Gears) -> Option<String> {
    let hand = if gears.hand == Hand::Right { "right" } else { "left" };
    gears.is_helical().then(|| format!("helix angle {}° {hand}", number(gears.helix_angle_deg)))
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

/// A constant, or from the least to the largest value of the profile that is given in its place.
fn extent(constant: f64, profile: Option<&[f64]>) -> String {
    let Some((&first, others)) = profile.and_then(<[f64]>::split_first) else { return number(constant) };
    let [low, high] = [f64::min, f64::max].map(|pick| others.iter().copied().fold(first, pick));
    format!("{} to {}", number(low), number(high))
}

fn quality(scenario: &Scenario) -> String {
    let quality = &scenario.quality();
    let has_class = !scenario.model.ignores("quality.iso_class");
    match (&quality.profile_errors, quality.iso_class, quality.din_grade) {
        (Some(_), ..) => "given profile errors".to_owned(),
        (None, class @ 1.., _) if has_class => format!("ISO 1328-1 class {class}"),
        (None, _, 0) => "ideal teeth".to_owned(),
        (None, _, grade) if has_class => format!("DIN 3961 grade {grade}"),
        (None, _, grade) => format!("DIN 3962 grade {grade}"),
    }
}
