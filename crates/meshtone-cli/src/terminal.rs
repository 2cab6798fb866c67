//! Words on the terminal.

use std::fmt::Display;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use meshtone_io::printable::printable;

use crate::failure::Failure;

/// Whether the program was started without a standard output.
static IS_OUTPUT_CLOSED: AtomicBool = AtomicBool::new(false);

// Rust opens /dev/null in its place before `main`, and all that is written would be lost without an error.
#[cfg(unix)]
ctor::declarative::ctor! {
    #[ctor(unsafe)]
    fn note_closed_output() {
        use std::os::fd::AsFd;

        IS_OUTPUT_CLOSED.store(io::stdout().as_fd().try_clone_to_owned().is_err(), Ordering::Relaxed);
    }
}

/// Writes to standard output. A reader that has gone away, such as `head`, has seen enough: that is no error.
pub fn print(text: &str) -> Result<(), Failure> {
    check_output()?;
    let mut out = io::stdout().lock();
    let text = printable(text, &['\n', '\t']);
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(cannot_write(&error)),
        _ => Ok(()),
    }
}

/// Refuses to print where standard output was closed before the program began.
pub fn check_output() -> Result<(), Failure> {
    if IS_OUTPUT_CLOSED.load(Ordering::Relaxed) { Err(cannot_write(&"it is closed")) } else { Ok(()) }
}

fn cannot_write(why: &dyn Display) -> Failure {
    Failure::failed(format!("cannot write to standard output: {why}"))
}

/// Writes a line to standard error; where even that fails, there is nowhere left to report.
pub fn print_error_line(text: impl Display) {
    print_colours(&printable(text, &[]));
}

/// Writes to standard error what is [printable], with colours.
pub fn print_colours(text: &str) {
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
