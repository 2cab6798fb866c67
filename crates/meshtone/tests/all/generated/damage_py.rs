//! `python/meshtone/_damage.py`: a class for each kind of damage.

use std::fmt::Write;

use meshtone::damage::{DamageKind, damage_kinds};
use meshtone::scenario::{KeyDescription, KeyKind};

use super::python::{HEAD, argument_type, class_name, has_default_value, inside, lines, parameter};

/// The file.
pub fn text() -> String {
    let kinds = damage_kinds();
    let mut text = format!(
        "\"\"\"A class for each kind of damage.\n\n{HEAD}\n\"\"\"\n\nfrom __future__ import annotations\n\n\
         from collections.abc import Sequence\nfrom dataclasses import dataclass\nfrom typing import Any, ClassVar, Literal, Union\n\n__all__ = [\n"
    );
    let mut names: Vec<String> = kinds.iter().map(|kind| kind.type_name.to_owned()).collect();
    let tables = kinds.iter().flat_map(|kind| kind.keys.iter().filter(|key| key.kind == KeyKind::Table));
    names.extend(tables.map(|table| class_name(&table.key)));
    names.push("Fault".to_owned());
    names.sort();
    names.dedup();
    for name in names {
        writeln!(text, "    \"{name}\",").unwrap();
    }
    text.push_str("]\n");
    let mut tables: Vec<(String, String)> = Vec::new();
    for kind in &kinds {
        for table in kind.keys.iter().filter(|key| key.kind == KeyKind::Table) {
            let entry = (table.key.clone(), class_name(&table.key));
            if !tables.contains(&entry) {
                text.push_str(&table_class(table, &inside(&kind.keys, &table.key)));
                tables.push(entry);
            }
        }
    }
    for kind in &kinds {
        text.push_str(&damage_class(kind));
    }
    let names = kinds.iter().map(|kind| kind.type_name).collect::<Vec<_>>().join(", ");
    write!(
        text,
        "\n\nFault = Union[{names}]\n\"\"\"Any kind of damage.\"\"\"\n\nKINDS: tuple[type[Any], ...] = ({names})\n\
         \"\"\"The classes.\"\"\"\n\nTABLES: dict[str, type[Any]] = {{"
    )
    .unwrap();
    let pairs =
        tables.iter().map(|(key, class)| format!("\"{key}\": {class}")).collect::<Vec<_>>().join(", ");
    write!(text, "{pairs}}}\n\"\"\"Classes of the tables inside a fault, by key.\"\"\"\n").unwrap();
    text
}

fn table_class(table: &KeyDescription, keys: &[KeyDescription]) -> String {
    let summary = sentence(table.meaning);
    let mut text = format!("\n\n@dataclass(frozen=True)\nclass {}:\n", class_name(&table.key));
    text.push_str(&docstring(&summary, keys.iter()));
    for key in keys {
        writeln!(text, "    {}: {}", key.key, argument_type(key)).unwrap();
    }
    text
}

/// The key of a wheel names any wheel: a gearbox has others than a pair.
fn of_any_wheel(mut key: KeyDescription) -> KeyDescription {
    if key.key == "wheel" {
        key.kind = KeyKind::Text;
        key.allowed = "\"pinion\", \"gear\", or the name of a wheel of a gearbox".to_owned();
    }
    key
}

fn damage_class(kind: &DamageKind) -> String {
    let place: Vec<KeyDescription> = kind.place.iter().cloned().map(of_any_wheel).collect();
    let mut own: Vec<&KeyDescription> = kind.keys.iter().filter(|key| !key.key.contains('.')).collect();
    // A field without a default cannot follow one that has one.
    own.sort_by_key(|key| !key.required);
    let mut text = format!("\n\n@dataclass(frozen=True)\nclass {}:\n", kind.type_name);
    text.push_str(&docstring(kind.summary, own.iter().copied().chain(&place)));
    writeln!(text, "    kind: ClassVar[str] = \"{}\"", kind.name).unwrap();
    for key in own {
        let none = if key.required { "" } else { " | None = None" };
        writeln!(text, "    {}: {}{none}", key.key, argument_type(key)).unwrap();
    }
    for key in &place {
        let default =
            if has_default_value(key) { format!(" = {}", key.default) } else { " | None = None".to_owned() };
        writeln!(text, "    {}: {}{default}", key.key, argument_type(key)).unwrap();
    }
    text
}

fn docstring<'a>(summary: &str, keys: impl Iterator<Item = &'a KeyDescription>) -> String {
    let mut text = lines("    ", &format!("\"\"\"{summary}"));
    text.push_str("\n    Parameters\n    ----------\n");
    for key in keys {
        text.push_str(&parameter("    ", key, &key.key, !key.required));
    }
    text.push_str("    \"\"\"\n\n");
    text
}

fn sentence(meaning: &str) -> String {
    let mut letters = meaning.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("{first}{}.", letters.as_str())
}
