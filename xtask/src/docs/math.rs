//! Formulas that reach MathJax as they were meant.
//!
//! mdBook reads a page as Markdown before MathJax sees the formulas in it, so inside `\\( … \\)`
//! and `$$ … $$` a backslash before punctuation must be doubled (`\\,` for a thin space, `\\\\` for
//! a new row), and `_` behind anything but a letter or digit must be written `\_`, or Markdown may
//! take it for emphasis.

use std::path::Path;

use super::{Problem, markdown};

/// Problems that Markdown would make in a page's formulas.
pub fn check(page: &Path, text: &str) -> Vec<Problem> {
    let mut problems = Vec::new();
    let mut problem = |line: usize, message: String| {
        problems.push(Problem { file: page.to_owned(), line, message });
    };
    let mut opened: Option<usize> = None;
    for (index, line) in markdown::without_code(text).iter().enumerate() {
        let number = index + 1;
        for (part, piece) in line.split("$$").enumerate() {
            if part > 0 {
                opened = if opened.is_some() { None } else { Some(number) };
            }
            if opened.is_some() {
                spoilt(piece).into_iter().for_each(|message| problem(number, message));
                continue;
            }
            let mut pieces = piece.split("\\\\(");
            if pieces.next().is_some_and(|before| before.contains("\\\\)")) {
                problem(number, "a formula ends with \\\\) here but does not start on this line".to_owned());
            }
            for formula in pieces {
                match formula.split_once("\\\\)") {
                    Some((formula, _)) => {
                        spoilt(formula).into_iter().for_each(|message| problem(number, message));
                    }
                    None => problem(
                        number,
                        "the formula that starts here with \\\\( does not end on this line".to_owned(),
                    ),
                }
            }
        }
    }
    if let Some(line) = opened {
        problem(line, "the formula that starts here with $$ does not end".to_owned());
    }
    problems
}

/// Problems that Markdown would make in one formula.
fn spoilt(formula: &str) -> Vec<String> {
    let mut messages = Vec::new();
    let mut previous = ' ';
    let mut characters = formula.chars().peekable();
    while let Some(c) = characters.next() {
        if c == '\\' {
            let next = characters.next_if(char::is_ascii_punctuation);
            match next {
                Some('\\') | Some('_') | None => {}
                Some(next) => messages.push(format!("in a formula, \\{next} must be written \\\\{next}")),
            }
            previous = next.unwrap_or(c);
            continue;
        }
        if c == '_' && !previous.is_alphanumeric() {
            messages
                .push("in a formula, _ after anything but a letter or digit must be written \\_".to_owned());
        }
        if c == '*' || c == '<' {
            messages.push(format!("in a formula, {c} must be written as a command (\\ast, \\lt)"));
        }
        previous = c;
    }
    messages
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(text: &str) -> Vec<(usize, String)> {
        check(Path::new("page.md"), text).into_iter().map(|problem| (problem.line, problem.message)).collect()
    }

    #[test]
    fn sound_formulas_pass() {
        let text =
            "\\\\(k_b\\\\) and \\\\(\\mathbf{u}\\_i\\\\)\n$$\na\\\\,b \\\\\\\\\n\\theta_p\n$$\n`\\(x\\)`";
        assert_eq!(messages(text), []);
    }

    #[test]
    fn spoilt_formulas_are_found() {
        let found = messages("$$\nx\\,y\n$$\n\\\\({u}_i\\\\)\n\\\\(open\n$$ never");
        let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
        assert_eq!(lines, [2, 4, 5, 6], "{found:?}");
        assert!(found[0].1.contains("\\\\,"), "{found:?}");
    }
}
