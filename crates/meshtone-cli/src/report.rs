//! A failure on standard error: with lines and colours on a terminal, in plain text elsewhere.

use std::fmt;

use miette::{
    Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceCode, SourceOffset,
};

use crate::failure::{Failure, Snippet};
use crate::terminal::{is_fancy, print_error_line};

/// (characters) Longest line that is shown. Whole matrices may stand on one.
const LONGEST_LINE: usize = 160;

/// What the library says of its limit, and what sets it here.
const MEMORY_LIMIT: [&str; 2] = ["raise the memory limit", "raise --memory-limit"];

/// Tells the user what went wrong.
pub fn print(mut failure: Failure) {
    let [of_library, option] = MEMORY_LIMIT;
    failure.message = failure.message.replace(of_library, option);
    failure.help = failure.help.map(|help| help.replace(of_library, option));
    let fancy = if is_fancy() { with_lines_and_colours(&failure) } else { None };
    print_error_line(fancy.unwrap_or_else(|| plain(&failure)).trim_end());
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

fn with_lines_and_colours(failure: &Failure) -> Option<String> {
    let mut text = String::new();
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode()).with_width(100);
    handler.render_report(&mut text, &Report::new(failure)).ok()?;
    Some(text)
}

/// The line, where it is short enough to be of use.
fn shown_line(snippet: &Snippet) -> Option<&str> {
    let line = snippet.text.lines().nth(snippet.line.checked_sub(1)?)?;
    (line.chars().count() <= LONGEST_LINE).then_some(line)
}

/// A failure as miette shows it.
#[derive(Debug)]
struct Report<'f> {
    failure: &'f Failure,
    source: Option<(NamedSource<String>, LabeledSpan)>,
}

impl<'f> Report<'f> {
    fn new(failure: &'f Failure) -> Self {
        let source = failure.snippet.as_ref().and_then(|snippet| {
            let line = shown_line(snippet)?;
            let start = SourceOffset::from_location(&snippet.text, snippet.line, 1).offset();
            let indent = line.len() - line.trim_start().len();
            let label = LabeledSpan::new_primary_with_span(
                Some("here".to_string()),
                (start + indent, line.trim().len()),
            );
            Some((NamedSource::new(&snippet.file, snippet.text.clone()), label))
        });
        Self { failure, source }
    }
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.failure.message)
    }
}

impl std::error::Error for Report<'_> {}

impl Diagnostic for Report<'_> {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.failure.help.as_ref().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.source.as_ref().map(|(text, _)| text as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let (_, label) = self.source.as_ref()?;
        Some(Box::new(std::iter::once(label.clone())))
    }
}
