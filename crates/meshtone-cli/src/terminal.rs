//! Words on the terminal.

use std::fmt::Display;
use std::io::{self, ErrorKind, IsTerminal, Write};

use crate::failure::Failure;

/// Writes to standard output. A reader that has gone away, such as `head`, has seen enough: that is no error.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::failed(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints as [`print`] does, unless the user has asked for warnings and errors only.
pub fn print_unless(is_quiet: bool, text: &str) -> Result<(), Failure> {
    if is_quiet { Ok(()) } else { print(text) }
}

/// Writes a line to standard error; where even that fails, there is nowhere left to report.
pub fn print_error_line(text: impl Display) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Prints a warning.
pub fn warn(text: impl Display) {
    print_error_line(format_args!("warning: {text}"));
}

/// Returns whether standard error is a terminal that shows lines and colours.
pub fn shows_colours() -> bool {
    let no_color = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    let dumb = std::env::var_os("TERM").is_some_and(|value| value == "dumb");
    io::stderr().is_terminal() && !no_color && !dumb
}
