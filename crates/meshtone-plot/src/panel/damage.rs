//! The damage in words.

use meshtone::Stages;
use meshtone::damage::{DamageDescription, Fault, damages_of_fault};
use meshtone::scenario::Scenario;

use crate::DamagedTooth;
use crate::drawing::capitalised;

/// The damages in words: what they are, where they are not on the gear's tooth 1, and, as far as there is room, their sizes.
///
/// # Arguments
/// * `scenario`, `stages` - what was simulated
/// * `fits` - whether there is room
pub(super) fn title(scenario: &Scenario, stages: &Stages, fits: impl Fn(&str) -> bool) -> String {
    let damages = damages(scenario, stages);
    let Some((only, _)) = damages.first() else { return "Healthy gear pair".to_owned() };
    let usual = Fault::at_usual_place(only.damage.clone());
    let is_usual = damages.len() == 1 && (&only.wheel, &only.tooth) == (&usual.wheel, &usual.tooth);
    let title = |with_sizes: bool| {
        let all = damages.iter().map(|(fault, damage)| {
            let mut words = damage.title.to_string();
            if !is_usual {
                words += &format!(", {} {}", fault.wheel, fault.tooth.in_words());
            }
            if with_sizes && !damage.sizes.is_empty() {
                words += &format!(": {}", damage.sizes.join(", "));
            }
            words
        });
        capitalised(&all.collect::<Vec<_>>().join("; "))
    };
    let full = title(true);
    if is_usual || fits(&full) { full } else { title(false) }
}

/// The faults that do anything to a tooth, each with what it has done to the first of its teeth.
fn damages<'a>(scenario: &'a Scenario, stages: &'a Stages) -> Vec<(&'a Fault, &'a DamageDescription)> {
    let damaged = &stages.pairs[0].damaged;
    let first = |number: usize| damages_of_fault(damaged, number).first().map(|(_, damage)| *damage);
    let faults = scenario.faults.iter().enumerate();
    faults.filter_map(|(number, fault)| Some((fault, first(number)?))).collect()
}

/// Where a wheel's revolution starts.
///
/// # Arguments
/// * `damaged` - the wheel's damaged teeth
pub(super) fn start_of_revolution(damaged: &[DamagedTooth]) -> &'static str {
    match damaged {
        [DamagedTooth { tooth: 1, is_missing: true, .. }] => "missing tooth would enter contact",
        [DamagedTooth { tooth: 1, .. }] => "damaged tooth enters contact",
        _ => "first tooth enters contact",
    }
}
