//! Words and types as Python has them.

use meshtone::scenario::{KeyDescription, KeyKind};

pub const HEAD: &str =
    "Written by `cargo xtask generate` from the rows of the Rust library: a change belongs there.";
/// Widest line of a docstring.
const WIDTH: usize = 120;

/// Classes of tables that are not called as their key.
const TABLE_NAMES: [(&str, &str); 15] = [
    ("pinion_flank_relief", "FlankRelief"),
    ("gear_flank_relief", "FlankRelief"),
    ("pinion_shaft", "Shaft"),
    ("gear_shaft", "Shaft"),
    ("pinion_inertia", "WheelInertia"),
    ("gear_inertia", "WheelInertia"),
    ("circle", "PitCircle"),
    ("random", "RandomPits"),
    ("path", "SensorPath"),
    ("inertia", "WheelInertia"),
    ("pinion_unbalance", "Unbalance"),
    ("gear_unbalance", "Unbalance"),
    ("defect", "BearingDefect"),
    ("feet", "Foot"),
    ("torque_ripple", "Ripple"),
];

/// The class of a table.
pub fn class_name(key: &str) -> String {
    if let Some((_, name)) = TABLE_NAMES.iter().find(|(table, _)| *table == key) {
        return (*name).to_owned();
    }
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    key.split('_').map(capital).collect()
}

/// The class of a table, behind two empty lines, with a sentence about it.
pub fn table_class(name: &str, summary: &str, keys: &[KeyDescription]) -> String {
    let mut text = format!(
        "\n\nclass {name}(TypedDict, total=False):\n    \"\"\"{summary}\n\n    Attributes\n    ----------\n"
    );
    for key in keys {
        // Of two tables of one class each has its own defaults.
        let mut key = key.clone();
        key.default.clear();
        text.push_str(&parameter("    ", &key, &key.key, false));
    }
    text.push_str("    \"\"\"\n\n");
    for key in keys {
        text.push_str(&format!("    {}: {}\n", key.key, argument_type(key)));
    }
    text
}

/// The keys inside a table, with their own names.
pub fn inside(keys: &[KeyDescription], table: &str) -> Vec<KeyDescription> {
    let inner = |key: &KeyDescription| {
        let name = key.key.strip_prefix(table)?.strip_prefix('.')?.to_owned();
        let mut inner = key.clone();
        inner.key = name;
        Some(inner)
    };
    keys.iter().filter_map(inner).collect()
}

/// Type of an argument.
pub fn argument_type(key: &KeyDescription) -> String {
    match &key.kind {
        KeyKind::Number => "float".into(),
        KeyKind::Whole => "int".into(),
        KeyKind::Teeth => "int | Sequence[int] | Literal[\"all\"]".into(),
        KeyKind::Name(names) => literal(names),
        KeyKind::NameOrTable(names) => format!("{} | Mapping[str, float]", literal(names)),
        KeyKind::Numbers(_) | KeyKind::List => "Sequence[float]".into(),
        KeyKind::NumberOrNumbers(_) => "float | Sequence[float]".into(),
        KeyKind::Table => class_name(&key.key),
        KeyKind::Tables => format!("Sequence[{}]", class_name(&key.key)),
        KeyKind::Profile => "Profile".into(),
        KeyKind::FrequencyResponse => "Mapping[str, Any]".into(),
        KeyKind::Text => "str".into(),
        KeyKind::Texts => "Sequence[str]".into(),
        KeyKind::Matrix => "npt.ArrayLike".into(),
        other => panic!("a type for {other:?}"),
    }
}

/// Type of an attribute, without `None`.
pub fn attribute_type(key: &KeyDescription) -> String {
    match &key.kind {
        KeyKind::Numbers(_) | KeyKind::List => "list[float]".into(),
        KeyKind::NumberOrNumbers(_) => "float | list[float]".into(),
        KeyKind::Profile => "dict[str, list[float]]".into(),
        _ => argument_type(key),
    }
}

fn literal(names: &[&str]) -> String {
    format!("Literal[{}]", names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", "))
}

/// Whether an absent key has a value of its own, rather than words that say what is done without one.
pub fn has_default_value(key: &KeyDescription) -> bool {
    key.default == "as below" || format!("x = {}", key.default).parse::<toml::Table>().is_ok()
}

/// An entry of a numpydoc list, `    name : type` and its description.
pub fn parameter(indent: &str, key: &KeyDescription, name: &str, optional: bool) -> String {
    let words = match &key.kind {
        KeyKind::Name(names) | KeyKind::NameOrTable(names) => {
            let table = if matches!(key.kind, KeyKind::Name(_)) { "" } else { " or dict" };
            format!(
                "{{{}}}{table}",
                names.iter().map(|name| format!("'{name}'")).collect::<Vec<_>>().join(", ")
            )
        }
        KeyKind::Numbers(count) => format!("sequence of {count} floats"),
        KeyKind::List => "sequence of floats".into(),
        KeyKind::Teeth => "int, sequence of ints or 'all'".into(),
        KeyKind::NumberOrNumbers(count) => format!("float or sequence of {count} floats"),
        KeyKind::Profile => "dict of time_s and value".into(),
        KeyKind::FrequencyResponse => "dict of frequency_hz, magnitude and phase_deg".into(),
        KeyKind::Tables => format!("sequence of {}", class_name(&key.key)),
        KeyKind::Texts => "sequence of two strs".into(),
        KeyKind::Matrix if key.key == "segments" => "sequence of pairs of floats".into(),
        KeyKind::Matrix => "array of float64, shape (100, teeth)".into(),
        _ => argument_type(key),
    };
    let optional = if optional { ", optional" } else { "" };
    format!("{indent}{name} : {words}{optional}\n{}", lines(&format!("{indent}    "), &sentences(key)))
}

/// Unit, meaning, limits and default, as sentences.
pub fn sentences(key: &KeyDescription) -> String {
    let unit = if key.unit.is_empty() { String::new() } else { format!("({}) ", key.unit) };
    let mut letters = key.meaning.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    let meaning = format!("{unit}{first}{}.", letters.as_str()).replace('`', "``");
    let is_plain = matches!(key.kind, KeyKind::Name(_) | KeyKind::NameOrTable(_)) || key.allowed.is_empty();
    let allowed =
        if is_plain { String::new() } else { format!(" Allowed: {}.", key.allowed.replace('`', "``")) };
    let default = if key.default.is_empty() || key.default == "as below" {
        String::new()
    } else if key.default.starts_with("required") {
        format!(" R{}.", key.default[1..].replace('`', "``"))
    } else {
        format!(" Default: {}.", key.default.replace('`', "``"))
    };
    let ignored = &key.ignored_in_words;
    format!("{meaning}{allowed}{default}{}{ignored}", if ignored.is_empty() { "" } else { " " })
}

/// A text in lines.
pub fn lines(indent: &str, text: &str) -> String {
    let mut lines = vec![indent.to_owned()];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        let is_empty = lines[last].len() == indent.len();
        if !is_empty && lines[last].chars().count() + 1 + word.chars().count() > WIDTH {
            lines.push(format!("{indent}{word}"));
        } else {
            lines[last].push_str(if is_empty { "" } else { " " });
            lines[last].push_str(word);
        }
    }
    lines.join("\n") + "\n"
}
