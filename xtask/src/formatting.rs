//! Formatting, and whether it has reached every source.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Output;

use crate::files;
use crate::step::cargo;

/// Folders of the sources.
const SOURCES: [&str; 4] = ["crates", "xtask", "fuzz/src", "fuzz/fuzz_targets"];

/// What is not formatted, and the sources that the formatter has not read: those that no module declares in a way that it follows.
///
/// # Errors
/// The formatter cannot be started, or a folder cannot be read.
pub fn problems(root: &Path) -> Result<Vec<String>, String> {
    let of_workspace = checked(root, &["--all"])?;
    let of_targets = checked(root, &["--manifest-path", "fuzz/Cargo.toml"])?;
    let said = [&of_workspace, &of_targets].map(|output| String::from_utf8_lossy(&output.stdout)).concat();
    // As rustfmt names them: without links.
    let root = &root.canonicalize().map_err(|error| format!("{}: {error}", root.display()))?;
    let mut sources = BTreeSet::new();
    for folder in SOURCES {
        sources.extend(files::below(&root.join(folder), "rs").map_err(|error| error.to_string())?);
    }
    let unread = unread(&sources, &said, root).into_iter().map(|path| {
        format!("{path}: the formatter has not read it: declare it by a plain `mod` of a file that it reads")
    });
    let mut problems: Vec<String> = unread.collect();
    for output in [of_workspace, of_targets].iter().filter(|output| !output.status.success()) {
        let said = String::from_utf8_lossy(&output.stdout);
        let said = said.lines().filter(|line| !is_remark(line)).collect::<Vec<_>>().join("\n");
        problems.push(format!(
            "not formatted (`cargo fmt --all`, in the folder fuzz `cargo fmt`):\n{said}{}",
            String::from_utf8_lossy(&output.stderr)
        ));
    }
    Ok(problems)
}

/// What the formatter says of a workspace or a package.
fn checked(root: &Path, of: &[&str]) -> Result<Output, String> {
    let mut cargo = cargo();
    let output = cargo.arg("fmt").args(of).args(["--check", "--", "--verbose"]).current_dir(root).output();
    output.map_err(|error| format!("cannot start cargo: {error}"))
}

/// The beginning of the line with which rustfmt names a file that it reads.
const READ: &str = "Formatting ";

fn is_remark(line: &str) -> bool {
    [READ, "Using rustfmt config file", "Spent "].iter().any(|start| line.starts_with(start))
}

/// The sources, from the root, that rustfmt does not say that it has read.
fn unread(sources: &BTreeSet<PathBuf>, said: &str, root: &Path) -> Vec<String> {
    // A module that names its file may name it by way of the folder above.
    let direct = |path: &str| Path::new(path).canonicalize().unwrap_or_else(|_| path.into());
    let read: BTreeSet<PathBuf> =
        said.lines().filter_map(|line| line.strip_prefix(READ)).map(direct).collect();
    let unread = sources.iter().filter(|path| !read.contains(*path));
    unread.map(|path| path.strip_prefix(root).unwrap_or(path).display().to_string()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_source_that_was_not_read_is_named() {
        let root = Path::new("/project");
        let sources = ["crates/a/src/lib.rs", "crates/a/src/hidden.rs"].map(|name| root.join(name)).into();
        let said = "Using rustfmt config file /project/rustfmt.toml for …\nFormatting /project/crates/a/src/lib.rs\nSpent 0.001 secs";
        assert_eq!(unread(&sources, said, root), ["crates/a/src/hidden.rs"]);
    }
}
