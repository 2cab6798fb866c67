//! `python/meshtone/_keys.py`: the arguments of a scenario.

use std::fmt::Write;

use meshtone::scenario::{KeyDescription, KeyKind, sections};

use super::both_wheels::of_both_wheels;
use super::python::{
    HEAD, argument_type, attribute_type, class_name, has_default_value, inside, parameter, table_class,
};

/// Keys that are called otherwise in Python: two sections have a `seed`.
const RENAMED: [(&str, &str, &str); 1] = [("quality", "seed", "wheels_seed")];

/// Sections that are lists, whose entries are objects of classes of their own.
const LISTS: [&str; 2] = ["fault", "sensor"];

/// An argument: a key of the file, its section, and its name in Python.
struct Argument {
    section: &'static str,
    name: String,
    key: KeyDescription,
}

fn arguments() -> Vec<Argument> {
    let mut arguments = Vec::new();
    for section in sections().into_iter().filter(|section| !LISTS.contains(&section.name)) {
        for key in section.keys {
            if key.key.contains('.') || key.kind == KeyKind::File {
                continue;
            }
            let renamed = RENAMED.iter().find(|(of, from, _)| *of == section.name && *from == key.key);
            let name = renamed.map_or_else(|| key.key.clone(), |(.., to)| (*to).to_owned());
            arguments.push(Argument { section: section.name, name, key });
        }
    }
    // Those without which there is no scenario come first.
    arguments.sort_by_key(|argument| !argument.key.required);
    arguments
}

/// Classes of tables, each once: the first sentence names all keys of its kind.
fn tables() -> String {
    let sections: Vec<_> = sections().into_iter().filter(|section| !LISTS.contains(&section.name)).collect();
    let mut classes: Vec<(String, Vec<String>, Vec<KeyDescription>)> = Vec::new();
    for section in &sections {
        for table in section.keys.iter().filter(|key| key.kind == KeyKind::Table) {
            let (name, place) = (class_name(&table.key), format!("``{}``", table.key));
            match classes.iter_mut().find(|(known, ..)| *known == name) {
                Some((_, places, _)) => places.push(place),
                None => classes.push((name, vec![place], inside(&section.keys, &table.key))),
            }
        }
    }
    let class = |(name, places, keys): &(String, Vec<String>, Vec<KeyDescription>)| {
        let tables = if places.len() == 1 { "The table" } else { "One of the tables" };
        table_class(name, &format!("{tables} {} of a scenario.", places.join(", ")), keys)
    };
    classes.iter().map(class).collect()
}

/// The keys that another scenario is made with: which there are, so that a misspelt one is found where types are checked.
fn changes(arguments: &[Argument]) -> String {
    let mut text = "class ScenarioChanges(TypedDict, total=False):\n    \"\"\"What ``Scenario.copy`` changes.\"\"\"\n\n    \
                    fault: Any\n    faults: Any\n    sensors: Any\n    shafts: Any\n    wheels: Any\n    meshes: Any\n    \
                    bearings: Any\n    operation: Any\n    housing: Any\n    solver: Any\n"
        .to_owned();
    for argument in arguments {
        writeln!(text, "    {}: Any", argument.name).unwrap();
    }
    text + "\n\n"
}

/// The file.
pub fn text() -> String {
    let arguments = arguments();
    let mut text = format!(
        "\"\"\"The keys of a scenario.\n\n{HEAD}\n\"\"\"\n\nfrom __future__ import annotations\n\n\
         from collections.abc import Mapping, Sequence\nfrom typing import Any, Literal, NoReturn, TypedDict, Union\n\n\
         import numpy as np\nimport numpy.typing as npt\n\nfrom ._sensor import Sensor, SensorPath\nfrom .faults import Fault\n\n\
         Profile = Mapping[str, Union[Sequence[float], npt.NDArray[np.float64]]]\n\
         \"\"\"``time_s`` and ``value``: speed or torque against time.\"\"\"\n"
    );
    text.push_str(&tables());
    text.push_str(&super::gearbox_keys::classes());
    let in_section = |argument: &&Argument| argument.key.kind != KeyKind::Matrix;
    text.push_str("\n\nSECTION_OF_KEY: dict[str, str] = {\n");
    for argument in arguments.iter().filter(in_section) {
        writeln!(text, "    \"{}\": \"{}\",", argument.name, argument.section).unwrap();
    }
    text.push_str("}\n\"\"\"Which section of the scenario file each key stands in.\"\"\"\n\nKEY_IN_FILE: dict[str, str] = {");
    let renamed = RENAMED.map(|(_, from, to)| format!("\"{to}\": \"{from}\"")).join(", ");
    write!(
        text,
        "{renamed}}}\n\"\"\"Keys that are called otherwise in their section.\"\"\"\n\nREQUIRED_KEYS = (\n"
    )
    .unwrap();
    for argument in arguments.iter().filter(|argument| argument.key.required) {
        writeln!(text, "    \"{}\",", argument.name).unwrap();
    }
    text.push_str(")\n\"\"\"Keys without a default.\"\"\"\n\n\n");
    text.push_str(&changes(&arguments));
    text.push_str("class ScenarioKeys:\n    \"\"\"The arguments and attributes of a scenario.\"\"\"\n\n    __slots__ = ()\n\n");
    for argument in arguments.iter().filter(in_section) {
        // What another key can stand in place of has a value all the same.
        let is_given = argument.key.required || argument.key.default.starts_with("required");
        // Of tables of both wheels, none where each has its own.
        let of_each = argument.key.kind == KeyKind::Table
            && arguments.iter().any(|other| other.name == format!("pinion_{}", argument.name));
        let is_there = is_given || has_default_value(&argument.key) && !of_each;
        let none = if is_there { "" } else { " | None" };
        writeln!(text, "    {}: {}{none}", argument.name, attribute_type(&argument.key)).unwrap();
    }
    text.push_str("\n    def __init__(\n        self,\n        *,\n");
    let mut lists = "        fault: Fault | None = None,\n        faults: Sequence[Fault] | None = None,\n        \
                     sensors: Sequence[Sensor] | None = None,\n";
    for Argument { name, key, .. } in &arguments {
        if !key.required {
            text.push_str(std::mem::take(&mut lists));
        }
        let kind = argument_type(key);
        let default = if key.required { "" } else { " | None = None" };
        writeln!(text, "        {name}: {kind}{default},").unwrap();
    }
    text.push_str(
        "        **unknown: NoReturn,\n    ) -> None:\n        \"\"\"A scenario; ``None`` is the default of a key.\n\n        \
         Parameters\n        ----------\n",
    );
    let mut lists = "        fault : a fault, optional\n            The damage, if there is but one; a healthy pair by default.\n        \
         faults : sequence of faults, optional\n            All damage, instead of ``fault``: any number of faults, on any teeth of \
         either wheel.\n        sensors : sequence of Sensor, optional\n            Sensors on the rig, whose signals come first; none by \
         default.\n";
    let keys: Vec<KeyDescription> = arguments.iter().map(|argument| argument.key.clone()).collect();
    for (key, of_gear) in of_both_wheels(&keys) {
        if !key.required {
            text.push_str(std::mem::take(&mut lists));
        }
        let name = |key: &KeyDescription| {
            arguments
                .iter()
                .find(|argument| argument.key == *key)
                .map(|argument| argument.name.clone())
                .unwrap()
        };
        match of_gear {
            Some(other) if other.default == key.default => {
                let names = format!("{}, {}", name(key), name(other));
                text.push_str(&parameter("        ", key, &names, !key.required));
            }
            _ => [Some(key), of_gear].into_iter().flatten().for_each(|key| {
                text.push_str(&parameter("        ", key, &name(key), !key.required));
            }),
        }
    }
    text.push_str(
        "\n        Raises\n        ------\n        ValueError\n            A value that is not allowed: the text names the key, the value and \
         what is allowed.\n        TypeError\n            A key that a scenario does not have.\n        \"\"\"\n        \
         arguments = dict(locals())\n        del arguments[\"self\"], arguments[\"unknown\"]\n        \
         self._from_keys(arguments, unknown)\n\n    \
         def _from_keys(self, arguments: dict[str, Any], unknown: dict[str, Any]) -> None:\n        \
         raise NotImplementedError\n",
    );
    text
}
