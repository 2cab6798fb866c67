//! `python/meshtone/_sensor.py`: the class of a sensor.

use std::fmt::Write;

use meshtone::scenario::{KeyDescription, sections};

use super::python::{HEAD, argument_type, inside, lines, parameter, table_class};

/// What its signal is, what refuses it, and where its parts are from.
const NOTES: &str = "
    Notes
    -----
    Its signal is in g, of shape (samples,). What is not allowed is a ``ValueError`` of the scenario that has the sensor.
    Mounted resonance: ISO 5348. Frequency response: ISO 7626-5. The book's chapter \"Sensors\" has the formulas.
";

/// The file.
pub fn text() -> String {
    let of_sensor = sections().into_iter().filter(|section| section.name == "sensor");
    let (inner, keys): (Vec<KeyDescription>, Vec<_>) =
        of_sensor.flat_map(|section| section.keys).partition(|key| key.key.contains('.'));
    let path = table_class("SensorPath", "The table ``path`` of a sensor.", &inside(&inner, "path"));
    let mut text = format!(
        "\"\"\"The class of a sensor.\n\n{HEAD}\n\"\"\"\n\nfrom __future__ import annotations\n\n\
         from collections.abc import Mapping, Sequence\nfrom dataclasses import dataclass\nfrom typing import Any, Literal, TypedDict\n{path}\n\n\
         @dataclass(frozen=True)\nclass Sensor:\n"
    );
    text.push_str(&lines("    ", "\"\"\"An accelerometer on the rig; ``None`` is the default of a key."));
    text.push_str("\n    Parameters\n    ----------\n");
    for key in &keys {
        text.push_str(&parameter("    ", key, &key.key, true));
    }
    text.push_str(NOTES);
    text.push_str("    \"\"\"\n\n");
    for key in &keys {
        writeln!(text, "    {}: {} | None = None", key.key, argument_type(key)).unwrap();
    }
    text
}
