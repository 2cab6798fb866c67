//! Lists of keys in the guide, between `<!--keys:SECTION-->` and `<!--end-->`.

use std::fmt::Write;

use meshtone::damage::{damage_kinds, keys_of_every_fault};
use meshtone::scenario::{KeyDescription, SectionDescription, gearbox_sections, sections};

use super::both_wheels::of_both_wheels;

/// The pages that have such lists.
pub const PAGES: [&str; 3] =
    ["docs/src/guide/scenario-file.md", "docs/src/guide/gearboxes.md", "docs/src/guide/planetary.md"];

const START: &str = "<!--keys:";
const END: &str = "<!--end-->";
/// The default of a table whose own keys follow.
const AS_BELOW: &str = "as below";

/// The page with its lists made anew.
pub fn with_lists(page: &str) -> String {
    let mut text = String::new();
    let mut rest = page;
    while let Some((before, after)) = rest.split_once(START) {
        let (name, after) = after.split_once("-->").unwrap();
        let (_, after) = after.split_once(END).unwrap_or_else(|| panic!("no {END} after the keys of {name}"));
        write!(text, "{before}{START}{name}-->\n\n{}\n{END}", list(name)).unwrap();
        rest = after;
    }
    text + rest
}

/// The list of a section, named as in the file and `top` for what stands above all sections, or of a kind of damage.
fn list(name: &str) -> String {
    let own = if name == "top" { "" } else { name };
    if name == "fault" {
        let names = damage_kinds().iter().map(|kind| format!("`\"{}\"`", kind.name)).collect::<Vec<_>>();
        let kind = format!("* `kind` (required): the kind of damage, {}\n", names.join(", "));
        let keys = keys_of_every_fault();
        return rows(&keys, &keys, &kind);
    }
    if let Some(kind) = damage_kinds().into_iter().find(|kind| kind.name == own) {
        return rows(&kind.keys, &kind.keys, "");
    }
    let (sections, own) = match own.strip_prefix("gearbox:") {
        Some("top") => (gearbox_sections(), ""),
        Some(of_gearbox) => (gearbox_sections(), of_gearbox),
        None => (sections(), own),
    };
    let section = sections.iter().find(|section| section.name == own).unwrap_or_else(|| panic!("{name}"));
    if name.starts_with("gearbox:") { of_gearbox(section) } else { rows(&section.keys, &section.keys, "") }
}

/// The list of a section of gearboxes: the keys that mean the same in the file of a pair are named below it, with where they stand and
/// what else is their default, or allowed.
fn of_gearbox(section: &SectionDescription) -> String {
    let pair = sections();
    let in_pair = |key: &KeyDescription| {
        let same = |of: &&KeyDescription| {
            of.key.strip_prefix("pinion_").unwrap_or(&of.key) == key.key
                && (of.meaning, of.unit) == (key.meaning, key.unit)
        };
        pair.iter().find_map(|section| Some((section.name, section.keys.iter().find(same)?)))
    };
    let (shared, own): (Vec<_>, Vec<_>) =
        section.keys.iter().cloned().partition(|key| in_pair(key).is_some());
    let named = |key: &KeyDescription, of: &KeyDescription| {
        let default = (of.default != key.default).then(|| default(key, &section.keys));
        let default = default.filter(|of| of != AS_BELOW).map(|default| format!("default {default}"));
        let allowed = (of.allowed != key.allowed).then(|| allowed(key));
        let differs = default.into_iter().chain(allowed).collect::<Vec<_>>().join("; ");
        if differs.is_empty() { format!("`{}`", key.key) } else { format!("`{}` ({differs})", key.key) }
    };
    let mut text = rows(&own, &section.keys, "");
    for of in &pair {
        let names = shared.iter().filter_map(|key| {
            in_pair(key).filter(|(section, _)| *section == of.name).map(|(_, of)| named(key, of))
        });
        let names = names.collect::<Vec<_>>().join(", ");
        if !names.is_empty() {
            let (title, anchor) = match of.name {
                "" => ("above the sections".to_owned(), "top-level"),
                "sensor" => ("in `[[sensor]]`".to_owned(), "sensor"),
                name => (format!("in `[{name}]`"), name),
            };
            writeln!(text, "\nAs [{title} of a pair](scenario-file.md#{anchor}): {names}.").unwrap();
        }
    }
    text
}

/// # Arguments
/// * `keys` - those of the list
/// * `all` - of the section
/// * `first` - rows before them
fn rows(keys: &[KeyDescription], all: &[KeyDescription], first: &str) -> String {
    let mut text = first.to_owned();
    for (key, of_gear) in of_both_wheels(keys) {
        let mut defaults = vec![default(key, all)];
        let mut names = format!("`{}`", key.key);
        if let Some(of_gear) = of_gear {
            write!(names, ", `{}`", of_gear.key).unwrap();
            defaults.push(default(of_gear, all));
            defaults.dedup();
        }
        let ignored = key.ignored_in_words.clone();
        let ignored = if ignored.is_empty() { ignored } else { format!(". *{ignored}*") };
        let (meaning, allowed) = (key.meaning, allowed(key));
        let allowed = if allowed.is_empty() { allowed } else { format!("; {allowed}") };
        let (unit, default) = (unit(key), defaults.join(", "));
        writeln!(text, "* {names} ({default}{allowed}): {unit}{meaning}{ignored}").unwrap();
    }
    text
}

/// What is allowed, with ranges in short.
fn allowed(key: &KeyDescription) -> String {
    key.allowed.replace("> 0, ≤ ", "up to ").replace("≥ 0, ≤ ", "0…")
}

/// The unit of a key whose name does not end with it.
fn unit(key: &KeyDescription) -> String {
    let mut as_in_names = key.unit.split(", ").last().unwrap_or_default().to_lowercase();
    for (sign, letters) in [
        ("rev/s", "hz"),
        ("s/s", "hz"),
        ("1/", "per"),
        ("/", "per"),
        ("µ", "u"),
        ("°", "deg"),
        ("%", "percent"),
        ("²", "2"),
        ("³", "3"),
    ] {
        as_in_names = as_in_names.replace(sign, letters);
    }
    let is_in_name = key.key.replace('_', "").ends_with(&as_in_names.replace(' ', ""));
    if is_in_name || key.unit == "-" { String::new() } else { format!("({}) ", key.unit) }
}

/// What is taken where a key is left out.
fn default(key: &KeyDescription, keys: &[KeyDescription]) -> String {
    let of_its_keys = format!("{}.", key.key);
    match key.default.as_str() {
        "" => "required".to_owned(),
        table if table.starts_with('{') && keys.iter().any(|other| other.key.starts_with(&of_its_keys)) => {
            AS_BELOW.to_owned()
        }
        value if format!("x = {value}").parse::<toml::Table>().is_ok() => format!("`{value}`"),
        words => words.to_owned(),
    }
}
