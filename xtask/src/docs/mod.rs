//! The book under `docs/` and the other Markdown files: checked and built.

mod links;
mod markdown;
mod math;

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::files;

/// Folders with Markdown files outside the book whose links are checked too, beside those at the root.
const FOLDERS: [&str; 4] = ["crates", "examples", "python", "xtask"];

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

/// Everything wrong with the book and the other pages of the project, in words.
///
/// # Errors
/// A page that cannot be read.
pub fn problems(root: &Path) -> io::Result<Vec<String>> {
    let in_words = |Problem { file, line, message }: Problem| {
        format!("{}:{line}: {message}", file.strip_prefix(root).unwrap_or(&file).display())
    };
    Ok(check(root)?.into_iter().map(in_words).collect())
}

fn check(root: &Path) -> io::Result<Vec<Problem>> {
    let book = root.join("docs").join("src");
    let pages = files::below(&book, "md")?;
    let mut problems = links::check_summary(&book, &pages)?;
    for page in &pages {
        let text = files::read(page)?;
        problems.extend(links::check(page, &text, Some(&book))?);
        problems.extend(math::check(page, &text));
    }
    let at_root = files::names_in(root)?.into_iter().filter(|name| name.ends_with(".md"));
    let mut others: Vec<PathBuf> = at_root.map(|name| root.join(name)).collect();
    for folder in FOLDERS {
        others.extend(files::below(&root.join(folder), "md")?);
    }
    for page in others {
        problems.extend(links::check(&page, &files::read(&page)?, None)?);
    }
    Ok(problems)
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
