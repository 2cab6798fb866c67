//! The dictionaries that a gearbox is made of, in `python/meshtone/_keys.py`.

use meshtone::scenario::{KeyDescription, KeyKind, gearbox_sections};

use super::python::{class_name, inside, table_class};

/// Types that a pair or its sensors have too.
const OF_PAIR: [&str; 7] =
    ["EndRelief", "FlankRelief", "Foundation", "Profile", "SensorPath", "Unbalance", "WheelInertia"];

/// A class for each section, before it those of its tables.
pub fn classes() -> String {
    let mut text = String::new();
    let is_there = |name: &str| OF_PAIR.contains(&name);
    for section in gearbox_sections().into_iter().filter(|section| !section.name.is_empty()) {
        let (inner, keys): (Vec<KeyDescription>, Vec<KeyDescription>) =
            section.keys.into_iter().partition(|key| key.key.contains('.'));
        let of_section = match section.name {
            "housing" | "operation" | "solver" => format!("the section ``[{}]`` of a gearbox", section.name),
            list => format!("an entry ``[[{list}]]`` of a gearbox"),
        };
        let tables = keys.iter().filter(|key| matches!(key.kind, KeyKind::Table | KeyKind::Tables));
        for table in tables.filter(|table| !is_there(&class_name(&table.key))) {
            let kind = if table.kind == KeyKind::Tables { "An entry of" } else { "The table" };
            let summary = format!("{kind} ``{}`` of {of_section}.", table.key);
            text += &table_class(&class_name(&table.key), &summary, &inside(&inner, &table.key));
        }
        // A gearbox of dictionaries has no directory in which its files could be.
        let keys: Vec<KeyDescription> = keys.into_iter().filter(|key| key.kind != KeyKind::File).collect();
        let summary = format!("{}{}.", of_section[..1].to_uppercase(), &of_section[1..]);
        text += &table_class(&format!("Gearbox{}", class_name(section.name)), &summary, &keys);
    }
    text
}
