//! A failure on standard error: with lines and colours on a terminal, in plain text elsewhere.

use crate::failure::{Failure, Snippet};
use crate::terminal::{print_error_line, shows_colours};

/// (characters) Longest line that is shown. Whole matrices may stand on one.
const LONGEST_LINE: usize = 160;

/// Advice of the library about its limit, and the advice of this program.
const MEMORY_LIMIT: [&str; 2] = ["raise the memory limit", "raise --memory-limit"];

/// Shows the user what went wrong.
pub fn print(mut failure: Failure) {
    let [of_library, option] = MEMORY_LIMIT;
    failure.message = failure.message.replace(of_library, option);
    failure.help = failure.help.map(|help| help.replace(of_library, option));
    let text = if shows_colours() { with_lines_and_colours(&failure) } else { plain(&failure) };
    print_error_line(text.trim_end());
}

fn plain(failure: &Failure) -> String {
    let mut text = format!("error: {}\n", failure.message);
    if let Some((snippet, line)) = failure.snippet.as_ref().and_then(|s| Some((s, shown_line(s, s.line)?))) {
        text += &format!("  {} | {line}\n", snippet.line);
    }
    if let Some(help) = &failure.help {
        text += &format!("help: {help}\n");
    }
    text
}

/// With the lines of the file around the one that is wrong, which is marked.
fn with_lines_and_colours(failure: &Failure) -> String {
    let mut text = wrapped(&failure.message, &format!("  {RED}×{END} "), &format!("  {RED}│{END} "));
    if let Some((snippet, line)) = failure.snippet.as_ref().and_then(|s| Some((s, shown_line(s, s.line)?))) {
        text += &framed(snippet, line);
    }
    if let Some(help) = &failure.help {
        text += &wrapped(help, &format!("  {CYAN}help: {END}"), "        ");
    }
    text
}

const RED: &str = "\x1b[31m";
const CYAN: &str = "\x1b[36m";
const DIM: &str = "\x1b[2m";
const MAGENTA: &str = "\x1b[35;1m";
const END: &str = "\x1b[0m";

/// (characters) Longest line of words.
const WIDTH: usize = 92;

/// Lines of whole words, none longer than [`WIDTH`] unless a word is.
///
/// # Arguments
/// * `first`, `others` - what stands before the first line, and before each other one
fn wrapped(text: &str, first: &str, others: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for paragraph in text.lines() {
        let mut line = String::new();
        for word in paragraph.split_inclusive(' ') {
            if line.chars().count() + word.trim_end().chars().count() > WIDTH && !line.trim().is_empty() {
                lines.push(std::mem::take(&mut line));
            }
            line += word;
        }
        lines.push(line);
    }
    let starts = std::iter::once(first).chain(std::iter::repeat(others));
    starts.zip(&lines).map(|(start, line)| format!("{start}{}\n", line.trim_end())).collect()
}

/// The line with a mark under it, and the lines before and after it, in a frame that names the file.
fn framed(snippet: &Snippet, shown: &str) -> String {
    let Snippet { file, line, .. } = snippet;
    let digits = (line + 1).to_string().len();
    let margin = " ".repeat(digits + 2);
    let (indent, marked) = shown.split_at(shown.len() - shown.trim_start().len());
    let marks = marked.trim_end().chars().count();
    let left = marks.saturating_sub(1) / 2;
    let [before, after] = [left, marks.saturating_sub(left + 1)].map(|count| "─".repeat(count));
    let below = " ".repeat(left);
    let column = indent.chars().count() + 1;
    let mut frame = format!("{margin}╭─[{file}:{line}:{column}]\n");
    for number in line - 1..=line + 1 {
        if let Some(shown) = shown_line(snippet, number) {
            frame += &format!(" {DIM}{number:>digits$}{END} │ {shown}\n");
        }
        if number == *line {
            frame += &format!("{margin}· {indent}{MAGENTA}{before}┬{after}{END}\n");
            frame += &format!("{margin}· {indent}{MAGENTA}{below}╰── here{END}\n");
        }
    }
    frame + &format!("{margin}╰────\n")
}

/// A line of the file, where it is short enough to be of use.
///
/// # Arguments
/// * `number` - of the line, 1-based
fn shown_line(snippet: &Snippet, number: usize) -> Option<&str> {
    let line = snippet.text.lines().nth(number.checked_sub(1)?)?;
    (line.chars().count() <= LONGEST_LINE).then_some(line)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wrong_line_is_marked_between_its_neighbours() {
        let text = "[gears]\n  module_mm = -3\n# ten\n".to_owned();
        let snippet = Some(Snippet { file: "mine.toml".to_owned(), text, line: 2 });
        let help = Some("use a larger one".to_owned());
        let failure = Failure {
            snippet,
            help,
            ..Failure::bad_input(format!("is -3; {}", "must be positive ".repeat(6)))
        };
        let mut shown = with_lines_and_colours(&failure);
        for colour in [RED, CYAN, DIM, MAGENTA, END] {
            assert!(shown.contains(colour));
            shown = shown.replace(colour, "");
        }
        let expected =
            "  × is -3; must be positive must be positive must be positive must be positive must be positive
  │ must be positive
   ╭─[mine.toml:2:3]
 1 │ [gears]
 2 │   module_mm = -3
   ·   ──────┬───────
   ·         ╰── here
 3 │ # ten
   ╰────
  help: use a larger one
";
        assert_eq!(shown, expected);
    }
}
