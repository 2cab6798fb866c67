//! The book under `docs/` and the Markdown files at the root: checked and built.

mod links;
mod markdown;
mod math;

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Markdown files outside the book whose links are checked too.
const ROOT_PAGES: [&str; 3] = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"];

/// One thing wrong in one place.
#[derive(Debug, PartialEq, Eq)]
pub struct Problem {
    /// The file it is in.
    pub file: PathBuf,
    /// 1-based line.
    pub line: usize,
    /// The problem.
    pub message: String,
}

/// Checks the book and prints what is wrong.
///
/// # Errors
/// 1 where something is.
pub fn check_and_report(root: &Path) -> Result<(), u8> {
    let problems = check(root).map_err(|error| {
        eprintln!("error: {error}");
        1
    })?;
    for problem in &problems {
        let file = problem.file.strip_prefix(root).unwrap_or(&problem.file);
        eprintln!("{}:{}: {}", file.display(), problem.line, problem.message);
    }
    if problems.is_empty() { Ok(()) } else { Err(1) }
}

/// Everything wrong with the book and the pages at the root.
fn check(root: &Path) -> io::Result<Vec<Problem>> {
    let book = root.join("docs").join("src");
    let mut pages = Vec::new();
    markdown_files(&book, &mut pages)?;
    pages.sort();
    let mut problems = links::check_summary(&book, &pages)?;
    for page in &pages {
        let text = read(page)?;
        problems.extend(links::check(page, &text, Some(&book))?);
        problems.extend(math::check(page, &text));
    }
    for page in ROOT_PAGES.map(|name| root.join(name)) {
        problems.extend(links::check(&page, &read(&page)?, None)?);
    }
    Ok(problems)
}

/// Adds every Markdown file below `folder` to `found`.
fn markdown_files(folder: &Path, found: &mut Vec<PathBuf>) -> io::Result<()> {
    let entries = fs::read_dir(folder).map_err(|error| about(folder, &error))?;
    for entry in entries {
        let path = entry?.path();
        if path.is_dir() {
            markdown_files(&path, found)?;
        } else if path.extension().is_some_and(|extension| extension == "md") {
            found.push(path);
        }
    }
    Ok(())
}

/// The text of `path`, or an error that names it.
fn read(path: &Path) -> io::Result<String> {
    fs::read_to_string(path).map_err(|error| about(path, &error))
}

/// `error` with the file that it is about.
fn about(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}

/// Builds the book with mdbook.
///
/// # Errors
/// mdbook's exit code, or 1 where it is not installed.
pub fn build(root: &Path) -> Result<(), u8> {
    match Command::new("mdbook").arg("build").arg(root.join("docs")).status() {
        Ok(status) if status.success() => {
            println!("The book is in docs/book: open docs/book/index.html");
            Ok(())
        }
        Ok(status) => Err(crate::step::exit_code(status.code())),
        Err(error) if error.kind() == ErrorKind::NotFound => {
            eprintln!(
                "error: mdbook is not installed. Install it with\n\n    cargo install mdbook --locked\n"
            );
            eprintln!("and run `cargo xtask docs` again. The pages under docs/src can be read without it.");
            Err(1)
        }
        Err(error) => {
            eprintln!("error: cannot start mdbook: {error}");
            Err(1)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_book_is_sound() {
        let problems = check(crate::workspace_root()).unwrap();
        assert!(problems.is_empty(), "{problems:#?}");
    }
}
