//! Looks for folders of the library that import against the direction of the data.
//!
//! Data flows down the list of rooms and never back, so a room may import only rooms of the floors above its own: no two of them
//! import each other, and what a room depends on is found without a search.

use std::io;
use std::path::Path;

use crate::files;

/// The rooms of `crates/meshtone/src`, floor by floor. A room imports rooms of earlier floors.
const FLOORS: &[&[&str]] = &[
    &["error", "error_table", "random", "interpolation", "simd", "threads", "known", "model", "trace_fields"],
    &["keys"],
    &["wheel", "bearing"],
    &["damage"],
    &["operation"],
    &["stiffness"],
    &["machine"],
    &["mesh"],
    &["solver"],
    &["sensor"],
    &["scenario"],
    &["published", "checks"],
    &["simulate"],
    &["warnings", "signal"],
    &["batch", "trace"],
    &["tuning"],
];

/// The imports of rooms that are not of earlier floors.
///
/// # Arguments
/// * `root` - folder of the workspace
///
/// # Errors
/// A source that cannot be read.
pub fn problems(root: &Path) -> io::Result<Vec<String>> {
    let library = root.join("crates").join("meshtone").join("src");
    let mut problems = Vec::new();
    for path in files::below(&library, "rs")? {
        let room = room_of(path.strip_prefix(&library).unwrap_or(&path));
        let shown = path.strip_prefix(root).unwrap_or(&path).display();
        for (line, imported) in imports(&files::read(&path)?) {
            problems.extend(problem(&room, imported).map(|problem| format!("{shown}:{line}: {problem}")));
        }
    }
    Ok(problems)
}

/// The room that a file, relative to the library's sources, belongs to.
fn room_of(file: &Path) -> String {
    let first = file.components().next().map(|part| part.as_os_str().to_string_lossy().into_owned());
    first.unwrap_or_default().trim_end_matches(".rs").to_string()
}

/// Modules of its own crate that a text names, as `crate::name`: the line, from 1, and the name. Comments and tests are left out.
fn imports(text: &str) -> Vec<(usize, &str)> {
    const MARK: &str = "crate::";
    let code = code(text);
    code.flat_map(|(index, line)| {
        let starts = line.match_indices(MARK).filter(|&(start, _)| is_start(line, start));
        starts.map(move |(start, _)| (index + 1, name(&line[start + MARK.len()..])))
    })
    .collect()
}

/// Lines of a text with their numbers from 0, without comments, up to its module of tests: an attribute of another item does not hide
/// what follows it.
pub fn code(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines: Vec<&str> = text.lines().collect();
    let is_of_tests = |index: usize| {
        let next = lines.get(index + 1).map_or("", |line| line.trim());
        lines[index].trim() == "#[cfg(test)]" && next.starts_with("mod ") && next.ends_with('{')
    };
    let end = (0..lines.len()).find(|&index| is_of_tests(index)).unwrap_or(lines.len());
    lines.into_iter().take(end).enumerate().filter(|(_, line)| !line.trim_start().starts_with("//"))
}

/// Returns whether no longer word ends here, as in `$crate::` or `my_crate::`.
fn is_start(line: &str, start: usize) -> bool {
    !line[..start].ends_with(|before: char| before.is_alphanumeric() || before == '_' || before == '$')
}

fn name(text: &str) -> &str {
    let end = text.find(|letter: char| !(letter.is_alphanumeric() || letter == '_')).unwrap_or(text.len());
    &text[..end]
}

/// Problem of an import, if it has one.
fn problem(room: &str, imported: &str) -> Option<String> {
    if room == imported || room == "lib" {
        return None;
    }
    let floor = |room: &str| FLOORS.iter().position(|rooms| rooms.contains(&room));
    match (floor(room), floor(imported)) {
        (None, _) => Some(format!("`{room}` has no floor: give it one in xtask/src/rooms.rs")),
        // A name of the library's own root, such as `crate::Error`, is judged by its room.
        (_, None) => Some(format!("names `crate::{imported}`, which is no room: name it by its room")),
        (Some(own), Some(other)) if other < own => None,
        _ => Some(format!(
            "`{room}` imports `{imported}`: data flows down the list in xtask/src/rooms.rs and never back"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn imports_are_found_outside_comments_and_tests() {
        let text = "use crate::wheel::Gears;\n// crate::batch\nfn f(a: crate::keys::Row, b: $crate::x) {}\n\
                    #[cfg(test)]\nmod tests {\n use crate::simulate;\n }\n";
        assert_eq!(imports(text), [(1, "wheel"), (3, "keys")]);
        let text = "#[cfg(test)]\nfn f() {}\nuse crate::batch;\n";
        assert_eq!(imports(text), [(3, "batch")]);
    }

    #[test]
    fn data_flows_down() {
        assert_eq!(problem("damage", "wheel"), None);
        assert!(
            problem("wheel", "damage").is_some_and(|problem| problem.contains("`wheel` imports `damage`"))
        );
        assert!(problem("error", "random").is_some());
        assert!(problem("attic", "wheel").is_some_and(|problem| problem.contains("no floor")));
        assert_eq!(room_of(Path::new("wheel/quality/mod.rs")), "wheel");
        assert_eq!(room_of(Path::new("model.rs")), "model");
    }

    #[test]
    fn every_room_is_on_one_floor() {
        let mut rooms: Vec<_> = FLOORS.concat();
        let count = rooms.len();
        rooms.sort_unstable();
        rooms.dedup();
        assert_eq!(rooms.len(), count);
    }
}
