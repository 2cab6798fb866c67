//! A failure on standard error.

use meshtone_io::printable::printable;

use crate::failure::{Failure, Snippet};
use crate::terminal::{print_colours, shows_colours};

/// (characters) Longest line that is shown. Whole matrices may stand on one.
const LONGEST_LINE: usize = 160;

/// Advice of the library about its limit, and the advice of this program.
const MEMORY_LIMIT: [&str; 2] = ["raise the memory limit", "raise --memory-limit"];

/// Shows the user what went wrong, in colours where the terminal has them.
pub fn print(failure: &Failure) {
    let [of_library, option] = MEMORY_LIMIT;
    let [red, cyan, end] = if shows_colours() { ["\x1b[31m", "\x1b[36m", "\x1b[0m"] } else { [""; 3] };
    let mut text = format!("{red}error:{end} {}\n", printable(&failure.message, &[]));
    if let Some((snippet, line)) = failure.snippet.as_ref().and_then(|of| Some((of, shown_line(of)?))) {
        text += &format!("  {} | {}\n", snippet.line, printable(line, &['\t']));
    }
    if let Some(help) = &failure.help {
        text += &format!("{cyan}help:{end} {}\n", printable(help, &[]));
    }
    print_colours(text.replace(of_library, option).trim_end());
}

fn shown_line(snippet: &Snippet) -> Option<&str> {
    let line = snippet.text.lines().nth(snippet.line.checked_sub(1)?)?;
    (line.chars().count() <= LONGEST_LINE).then_some(line)
}
