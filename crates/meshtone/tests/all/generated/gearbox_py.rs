//! `python/meshtone/_gearbox_keys.py`: the dictionaries that a gearbox is made of.

use meshtone::scenario::{KeyDescription, KeyKind, gearbox_sections};

use super::python::{HEAD, class_name, inside, table_class};

/// Types that a pair has too: they are imported.
const OF_PAIR: [&str; 6] = ["EndRelief", "FlankRelief", "Foundation", "Profile", "Unbalance", "WheelInertia"];
const OF_SENSOR: &str = "SensorPath";

/// The file: a class for each section, before it those of its tables.
pub fn text() -> String {
    let mut text = format!(
        "\"\"\"The dictionaries of a gearbox.\n\n{HEAD}\n\"\"\"\n\nfrom __future__ import annotations\n\n\
         from collections.abc import Mapping, Sequence\nfrom typing import Any, Literal, TypedDict\n\n\
         import numpy.typing as npt\n\nfrom ._keys import {}\nfrom ._sensor import {OF_SENSOR}\n",
        OF_PAIR.join(", ")
    );
    let is_imported = |name: &str| name == OF_SENSOR || OF_PAIR.contains(&name);
    for section in gearbox_sections().into_iter().filter(|section| !section.name.is_empty()) {
        let (inner, keys): (Vec<KeyDescription>, Vec<KeyDescription>) =
            section.keys.into_iter().partition(|key| key.key.contains('.'));
        let of_section = match section.name {
            "housing" | "operation" | "solver" => format!("the section ``[{}]`` of a gearbox", section.name),
            list => format!("an entry ``[[{list}]]`` of a gearbox"),
        };
        let tables = keys.iter().filter(|key| matches!(key.kind, KeyKind::Table | KeyKind::Tables));
        for table in tables.filter(|table| !is_imported(&class_name(&table.key))) {
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
