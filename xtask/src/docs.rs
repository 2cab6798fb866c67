//! The book under `docs/` and the other Markdown files: checked and built.
//!
//! The checks find what a change of a page breaks: a link, a picture or an included file that leads nowhere, a page that is not in the table
//! of contents, a formula that Markdown spoils. A release also has lychee look at the built book and its links to other sites.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::files;

/// Folders with Markdown files outside the book whose links are checked too, beside those at the root.
const FOLDERS: [&str; 4] = ["crates", "examples", "python", "xtask"];
/// How a link, a picture and an included file begin and end. An included file may stand in code.
const LINKS: [(&str, char); 3] = [("](", ')'), ("src=\"", '"'), ("href=\"", '"')];
const INCLUDED: (&str, char) = ("{{#include ", '}');

/// Everything wrong with the book and the other pages of the project, in words.
///
/// # Errors
/// A page that cannot be read.
pub fn problems(root: &Path) -> io::Result<Vec<String>> {
    let book = root.join("docs/src");
    let contents = files::read(&book.join("SUMMARY.md"))?;
    let pages = files::below(&book, "md")?;
    let at_root = files::names_in(root)?.into_iter().filter(|name| name.ends_with(".md"));
    let mut others: Vec<PathBuf> = at_root.map(|name| root.join(name)).collect();
    for folder in FOLDERS {
        others.extend(files::below(&root.join(folder), "md")?);
    }
    let mut problems = Vec::new();
    for page in pages.iter().chain(&others) {
        let of_book = page.strip_prefix(&book).ok();
        let name = page.strip_prefix(root).unwrap_or(page).display();
        if of_book.is_some_and(|of_book| {
            !of_book.ends_with("SUMMARY.md") && !contents.contains(&format!("({})", of_book.display()))
        }) {
            problems.push(format!("{name}:1: this page is not in SUMMARY.md"));
        }
        let found = of_page(page, &files::read(page)?, of_book.is_some());
        problems.extend(found.into_iter().map(|(line, problem)| format!("{name}:{line}: {problem}")));
    }
    Ok(problems)
}

/// What is wrong with a page, with the numbers of the lines. Only pages of the book have formulas.
fn of_page(page: &Path, text: &str, is_of_book: bool) -> Vec<(usize, String)> {
    let mut problems = Vec::new();
    let (mut is_code, mut is_formula) = (false, false);
    for (number, line) in (1..).zip(text.lines()) {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        let prose = if is_code || is_fence { String::new() } else { without_spans(line) };
        let links = LINKS.iter().flat_map(|mark| between(&prose, *mark));
        let broken =
            links.chain(between(line, INCLUDED)).filter(|target| !leads_somewhere(page, text, target));
        problems.extend(broken.map(|target| (number, format!("the link '{target}' leads nowhere"))));
        if is_of_book {
            let (displayed, still) = formulas(&prose, is_formula);
            is_formula = still;
            let spoilt = displayed.iter().filter_map(|formula| spoilt(formula));
            problems.extend(spoilt.map(|problem| (number, problem)));
        }
    }
    if is_formula {
        problems.push((text.lines().count(), "a formula that starts with $$ does not end".to_owned()));
    }
    problems
}

/// A line without its code spans.
fn without_spans(line: &str) -> String {
    line.split('`').step_by(2).collect::<Vec<_>>().join("`")
}

/// Every text of a line between a mark and the next end of it.
fn between<'l>(line: &'l str, (open, close): (&'static str, char)) -> impl Iterator<Item = &'l str> {
    line.split(open).skip(1).filter_map(move |rest| rest.split(close).next())
}

/// Returns whether a link of a page leads to a file that is there, and to a heading of it. Other sites are lychee's.
fn leads_somewhere(page: &Path, text: &str, target: &str) -> bool {
    let target = target.split(' ').next().unwrap_or_default();
    let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
    let path = page.with_file_name(file);
    let has_heading = |text: &str| anchor.is_empty() || text.lines().any(|line| is_heading(line, anchor));
    match file {
        _ if file.contains(':') => true,
        "" => has_heading(text),
        _ if file.ends_with(".md") => files::read(&path).is_ok_and(|text| has_heading(&text)),
        _ => path.exists(),
    }
}

/// Returns whether a line is the heading of an anchor, as mdBook names them: the second one of the same name gets `-1`.
fn is_heading(line: &str, anchor: &str) -> bool {
    let name = line.trim_start_matches('#').trim().chars().filter_map(|c| match c {
        _ if c.is_alphanumeric() => Some(c.to_ascii_lowercase()),
        '_' | '-' => Some(c),
        _ => c.is_whitespace().then_some('-'),
    });
    let rest = anchor.strip_prefix(&name.collect::<String>());
    line.starts_with('#')
        && rest.is_some_and(|rest| rest.trim_start_matches('-').chars().all(|c| c.is_ascii_digit()))
}

/// The parts of a line that are formulas, where a displayed one may go on from the line before; whether one goes on to the next line.
fn formulas(line: &str, goes_on: bool) -> (Vec<&str>, bool) {
    let parts: Vec<&str> = line.split("$$").collect();
    let is_formula = |place: usize| (place % 2 == 1) != goes_on;
    let found = parts.iter().enumerate().flat_map(|(place, part)| {
        if is_formula(place) {
            vec![*part]
        } else {
            part.split("\\\\(").skip(1).filter_map(|rest| rest.split("\\\\)").next()).collect()
        }
    });
    (found.collect(), is_formula(parts.len() - 1))
}

/// What Markdown, which reads a page before MathJax does, makes of a formula: it takes a single backslash before punctuation away, and `_`
/// behind anything but a letter or digit, `*` and `<` for marks of its own.
fn spoilt(formula: &str) -> Option<String> {
    let escaped = formula.replace("\\\\", "  ").replace("\\_", "x");
    let bare = escaped.split('_').rev().skip(1).any(|before| !before.ends_with(char::is_alphanumeric));
    let taken = escaped.split('\\').skip(1).find(|rest| rest.starts_with(|c: char| c.is_ascii_punctuation()));
    match taken {
        Some(rest) => Some(format!("in a formula, write \\\\{}", rest.split_at(1).0)),
        None if bare => {
            Some("in a formula, _ after anything but a letter or digit must be written \\_".to_owned())
        }
        None if escaped.contains(['*', '<']) => Some("in a formula, write \\ast and \\lt".to_owned()),
        None => None,
    }
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
    fn what_a_page_breaks_is_found() {
        let page = crate::workspace_root().join("docs/src/introduction.md");
        let text = "[a](SUMMARY.md#x) [a](SUMMARY.md#summary) ![b](no.png \"t\") `[c](no.md)` <img src=\"no.svg\"> [d](https://example.org)\n\
                    ```\n[e](no.md) {{#include ../../no.py}}\n```\n\
                    \\\\(k_b\\\\) \\\\(\\mathbf{u}\\_i\\\\) \\\\({u}_i\\\\)\n$$\nx\\,y \\\\\\\\\n$$\n\\\\(a*b\\\\) a_ *b*\n";
        let found: Vec<(usize, String)> = of_page(&page, text, true);
        let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
        assert_eq!(lines, [1, 1, 1, 3, 5, 7, 9], "{found:?}");
    }
}
