//! Tables of the guide, between `<!-- keys of SECTION -->` and `<!-- end -->`.

use std::fmt::Write;

use meshtone::damage::{damage_kinds, keys_of_every_fault};
use meshtone::scenario::{KeyDescription, gearbox_sections, sections};

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
        return rows(&keys_of_every_fault(), &kind);
    }
    if let Some(kind) = damage_kinds().into_iter().find(|kind| kind.name == own) {
        return rows(&kind.keys, "");
    }
    let (sections, own) = match own.strip_prefix("gearbox:") {
        Some("top") => (gearbox_sections(), ""),
        Some(of_gearbox) => (gearbox_sections(), of_gearbox),
        None => (sections(), own),
    };
    let section = sections.iter().find(|section| section.name == own).unwrap_or_else(|| panic!("{name}"));
    rows(&section.keys, "")
}

fn rows(keys: &[KeyDescription], first: &str) -> String {
    let mut text = format!("| key | meaning | unit | default | allowed |\n|---|---|---|---|---|\n{first}");
    for (key, of_gear) in of_both_wheels(keys) {
        let mut defaults = vec![default(key, keys)];
        let mut names = format!("`{}`", key.key);
        if let Some(of_gear) = of_gear {
            write!(names, ", `{}`", of_gear.key).unwrap();
            defaults.push(default(of_gear, keys));
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
