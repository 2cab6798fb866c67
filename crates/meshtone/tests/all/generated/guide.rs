//! Tables of the guide, between `<!-- keys of SECTION -->` and `<!-- end -->`.

use std::fmt::Write;

use meshtone::damage::{damage_kinds, keys_of_every_fault};
use meshtone::scenario::{KeyDescription, SectionDescription, gearbox_sections, sections};

use super::both_wheels::of_both_wheels;

/// The pages that have such tables.
pub const PAGES: [&str; 2] = ["docs/src/guide/scenario-file.md", "docs/src/guide/gearboxes.md"];

const START: &str = "<!-- keys of ";
const END: &str = "<!-- end -->";

/// The page with its tables made anew.
pub fn with_tables(page: &str) -> String {
    let mut text = String::new();
    let mut rest = page;
    while let Some((before, after)) = rest.split_once(START) {
        let (name, after) = after.split_once(" -->").unwrap();
        let (_, after) = after.split_once(END).unwrap_or_else(|| panic!("no {END} after the keys of {name}"));
        write!(text, "{before}{START}{name} -->\n\n{}\n{END}", table(name)).unwrap();
        rest = after;
    }
    text + rest
}

/// The table of a section, named as in the file and `top` for what stands above all sections, or of a kind of damage.
fn table(name: &str) -> String {
    let own = if name == "top" { "" } else { name };
    if name == "fault" {
        let names = damage_kinds().iter().map(|kind| format!("`\"{}\"`", kind.name)).collect::<Vec<_>>();
        let kind = format!("| `kind` | the kind of damage | | required | {} |\n", names.join(", "));
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

/// The table of a section of gearboxes: the keys that are the same in the file of a pair are named below it, with where they stand.
fn of_gearbox(section: &SectionDescription) -> String {
    let pair = sections();
    let of_pair = |key: &KeyDescription| {
        let same = |of: &KeyDescription| {
            of.key.strip_prefix("pinion_").unwrap_or(&of.key) == key.key
                && (of.meaning, of.unit) == (key.meaning, key.unit)
                && (&of.default, &of.allowed) == (&key.default, &key.allowed)
        };
        pair.iter().find(|section| section.keys.iter().any(same)).map(|section| section.name)
    };
    let (shared, own): (Vec<_>, Vec<_>) =
        section.keys.iter().cloned().partition(|key| of_pair(key).is_some());
    let mut text = rows(&own, &section.keys, "");
    for of in &pair {
        let names =
            shared.iter().filter(|key| of_pair(key) == Some(of.name)).map(|key| format!("`{}`", key.key));
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
/// * `keys` - those of the table
/// * `all` - of the section
/// * `first` - rows before them
fn rows(keys: &[KeyDescription], all: &[KeyDescription], first: &str) -> String {
    let mut text = format!("| key | meaning | unit | default | allowed |\n|---|---|---|---|---|\n{first}");
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
        let KeyDescription { meaning, unit, allowed, .. } = key;
        let default = defaults.join(", ");
        writeln!(text, "| {names} | {meaning}{ignored} | {unit} | {default} | {allowed} |").unwrap();
    }
    text
}

/// What is taken where a key is left out; of a table whose own keys follow, what they say.
fn default(key: &KeyDescription, keys: &[KeyDescription]) -> String {
    let of_its_keys = format!("{}.", key.key);
    match key.default.as_str() {
        "" => "required".to_owned(),
        table if table.starts_with('{') && keys.iter().any(|other| other.key.starts_with(&of_its_keys)) => {
            "as below".to_owned()
        }
        value if format!("x = {value}").parse::<toml::Table>().is_ok() => format!("`{value}`"),
        words => words.to_owned(),
    }
}
