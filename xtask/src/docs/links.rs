//! Relative links and pictures that lead somewhere, and a table of contents that is complete.

use std::io;
use std::path::{Component, Path, PathBuf};

use super::{Problem, markdown};
use crate::files::read;

/// A link or picture in a page.
struct Link {
    /// 1-based line.
    line: usize,
    /// Its target, as written.
    target: String,
}

/// Every page of the book must be in `SUMMARY.md`, once. (That the pages in it exist is checked
/// with all other links.)
pub fn check_summary(book: &Path, pages: &[PathBuf]) -> io::Result<Vec<Problem>> {
    let summary = book.join("SUMMARY.md");
    let listed: Vec<(usize, PathBuf)> = links(&read(&summary)?)
        .into_iter()
        .map(|link| (link.line, normalised(&book.join(link.target))))
        .collect();
    let mut problems = Vec::new();
    for (index, (line, page)) in listed.iter().enumerate() {
        if listed[..index].iter().any(|(_, earlier)| earlier == page) {
            let message = format!("{} is listed twice", page.display());
            problems.push(Problem { file: summary.clone(), line: *line, message });
        }
    }
    for page in pages.iter().filter(|page| **page != summary) {
        if !listed.iter().any(|(_, known)| known == page) {
            let message = "this page is not in SUMMARY.md".to_owned();
            problems.push(Problem { file: page.clone(), line: 1, message });
        }
    }
    Ok(problems)
}

/// Every relative link and picture of a page must exist, with its heading where it names one, and
/// stay inside `book` where one is given (what lies outside is not published with it). An included
/// file must exist too; it may lie anywhere, because mdBook copies it into the page.
pub fn check(page: &Path, text: &str, book: Option<&Path>) -> io::Result<Vec<Problem>> {
    let mut problems = Vec::new();
    let linked = links(text).into_iter().map(|link| (link, book));
    let included = includes(text).into_iter().map(|link| (link, None));
    for (link, book) in linked.chain(included) {
        if let Some(message) = fault_of(&link.target, page, text, book)? {
            problems.push(Problem { file: page.to_owned(), line: link.line, message });
        }
    }
    Ok(problems)
}

/// Problem of a link of `page`, if it has one.
fn fault_of(target: &str, page: &Path, text: &str, book: Option<&Path>) -> io::Result<Option<String>> {
    if ["http://", "https://", "mailto:"].iter().any(|scheme| target.starts_with(scheme)) {
        return Ok(None);
    }
    let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
    let path = match page.parent() {
        Some(folder) if !file.is_empty() => normalised(&folder.join(file)),
        _ => page.to_owned(),
    };
    if !path.exists() {
        return Ok(Some(format!("the link '{target}' leads nowhere: there is no {}", path.display())));
    }
    if book.is_some_and(|book| !path.starts_with(book)) {
        return Ok(Some(format!("the link '{target}' leads out of the book")));
    }
    if anchor.is_empty() || path.extension().is_none_or(|extension| extension != "md") {
        return Ok(None);
    }
    let other = if path == page { text.to_owned() } else { read(&path)? };
    if markdown::anchors(&other).iter().any(|known| known == anchor) {
        Ok(None)
    } else {
        Ok(Some(format!("the link '{target}' leads to a heading that {} does not have", path.display())))
    }
}

/// The links and pictures of a page, in Markdown (`[…](target)`) or HTML (`src=`, `href=`).
fn links(text: &str) -> Vec<Link> {
    let of_line = |(index, line): (usize, &String)| {
        let marks = [("](", ')'), ("src=\"", '"'), ("href=\"", '"')];
        let targets = marks.into_iter().flat_map(|(open, close)| between(line, open, close));
        // [text](target "title")
        let target = |target: &str| target.split_whitespace().next().unwrap_or_default().to_owned();
        targets.map(|text| Link { line: index + 1, target: target(text) }).collect::<Vec<_>>()
    };
    markdown::without_code(text).iter().enumerate().flat_map(of_line).collect()
}

/// The whole files that mdBook copies into a page, mostly into its code: `{{#include target}}`.
fn includes(text: &str) -> Vec<Link> {
    let of_line = |(index, line)| {
        let targets = between(line, "{{#include ", '}').into_iter();
        targets.map(move |target| Link { line: index + 1, target: target.trim().to_owned() })
    };
    text.lines().enumerate().flat_map(of_line).collect()
}

/// Every text in `line` between `open` and the next `close`.
fn between<'a>(line: &'a str, open: &str, close: char) -> Vec<&'a str> {
    line.split(open).skip(1).filter_map(|rest| rest.split_once(close)).map(|(inside, _)| inside).collect()
}

/// `path` with `.` and `..` resolved by name alone.
fn normalised(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            other => plain.push(other),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    fn targets(text: &str) -> Vec<String> {
        links(text).into_iter().map(|link| link.target).collect()
    }

    #[test]
    fn finds_links_pictures_and_html() {
        let text = "[a](b.md#c) and ![d](e.png \"title\")\n<img src=\"f.svg\"> `[no](no.md)`";
        assert_eq!(targets(text), ["b.md#c", "e.png", "f.svg"]);
    }

    #[test]
    fn an_included_file_must_exist_wherever_it_lies() {
        let book = crate::workspace_root().join("docs/src");
        let page = book.join("introduction.md");
        let problems = |name: &str| {
            let text = format!("```python\n{{{{#include ../../{name}}}}}\n```\n");
            check(&page, &text, Some(&book)).unwrap()
        };
        assert_eq!(problems("README.md"), []);
        let missing = problems("no/such/file.py");
        assert_eq!(missing.len(), 1);
        assert_eq!(missing[0].line, 2);
        assert!(missing[0].message.contains("leads nowhere"));
    }

    #[test]
    fn says_what_is_wrong_with_a_link() {
        let root = crate::workspace_root();
        let page = root.join("README.md");
        let fault = |target| fault_of(target, &page, "# Here\n", None).unwrap();
        assert_eq!(fault("#here"), None);
        assert_eq!(fault("Cargo.toml"), None);
        assert_eq!(fault("https://example.org/nothing"), None);
        assert!(fault("#there").unwrap().contains("heading"));
        assert!(fault("no/such/file.md").unwrap().contains("leads nowhere"));
        let outside = fault_of("Cargo.toml", &page, "", Some(&root.join("docs"))).unwrap();
        assert!(outside.unwrap().contains("out of the book"));
    }
}
