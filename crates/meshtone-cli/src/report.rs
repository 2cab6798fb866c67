//! A failure on standard error: with lines and colours on a terminal, in plain text elsewhere.

use miette::{
    GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, NamedSource, Report, SourceOffset,
};

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
    let plain = plain(&failure);
    let fancy = if shows_colours() { with_lines_and_colours(failure) } else { None };
    print_error_line(fancy.unwrap_or(plain).trim_end());
}

fn plain(failure: &Failure) -> String {
    let mut text = format!("error: {}\n", failure.message);
    if let Some((snippet, line)) = failure.snippet.as_ref().and_then(|s| Some((s, shown_line(s)?))) {
        text += &format!("  {} | {line}\n", snippet.line);
    }
    if let Some(help) = &failure.help {
        text += &format!("help: {help}\n");
    }
    text
}

fn with_lines_and_colours(failure: Failure) -> Option<String> {
    let mut report = MietteDiagnostic::new(failure.message);
    report.help = failure.help;
    let report = match failure.snippet.and_then(|snippet| Some((label(&snippet)?, snippet))) {
        None => Report::new(report),
        Some((label, Snippet { file, text, .. })) => {
            Report::new(report.with_label(label)).with_source_code(NamedSource::new(file, text))
        }
    };
    let mut text = String::new();
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode()).with_width(100);
    handler.render_report(&mut text, report.as_ref()).ok()?;
    Some(text)
}

/// The mark under the line, without its indentation.
fn label(snippet: &Snippet) -> Option<LabeledSpan> {
    let line = shown_line(snippet)?;
    let start = SourceOffset::from_location(&snippet.text, snippet.line, 1).offset();
    let indent = line.len() - line.trim_start().len();
    Some(LabeledSpan::new_primary_with_span(Some("here".to_string()), (start + indent, line.trim().len())))
}

/// The line, where it is short enough to be of use.
fn shown_line(snippet: &Snippet) -> Option<&str> {
    let line = snippet.text.lines().nth(snippet.line.checked_sub(1)?)?;
    (line.chars().count() <= LONGEST_LINE).then_some(line)
}
