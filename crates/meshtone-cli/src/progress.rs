//! A sign of life while something takes long.

use std::io::{self, IsTerminal};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use meshtone_io::printable::printable;

/// Time after which a bar is drawn: shorter work needs none.
const PATIENCE: Duration = Duration::from_secs(1);
const TICK: Duration = Duration::from_millis(120);

/// Does what takes long, with a bar on a terminal's standard error.
///
/// # Arguments
/// * `counted` - what is counted, such as "simulations"
/// * `wanted` - whether anything is to be shown
/// * `work` - what is done; it is given what shows how much is finished, out of how much
pub fn with_bar<T>(counted: &str, wanted: bool, work: impl FnOnce(&(dyn Fn(u64, u64) + Sync)) -> T) -> T {
    let bar = bar(counted, wanted);
    let done = work(&|finished, all| {
        bar.set_length(all);
        bar.set_position(finished);
    });
    bar.finish_and_clear();
    done
}

fn bar(counted: &str, wanted: bool) -> ProgressBar {
    let bar = match wanted {
        true => ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr()),
        false => ProgressBar::hidden(),
    };
    let template = format!("{{bar:30}} {{pos}} of {{len}} {counted}, {{per_sec}}, {{eta}} left");
    match ProgressStyle::with_template(&template) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Does what takes long, with a spinner on a terminal's standard error from one second on.
///
/// # Arguments
/// * `message` - what is being done
/// * `wanted` - whether anything is to be shown; nothing ever is where standard error is no terminal
/// * `work` - what is done
pub fn with_spinner<T>(message: String, wanted: bool, work: impl FnOnce() -> T) -> T {
    if !wanted || !io::stderr().is_terminal() {
        return work();
    }
    thread::scope(|scope| {
        let (_stop, stopped) = channel();
        scope.spawn(move || show(message, &stopped));
        work()
    })
}

/// Shows the spinner until the sender is gone.
fn show(message: String, stopped: &Receiver<()>) {
    if stopped.recv_timeout(PATIENCE) != Err(RecvTimeoutError::Timeout) {
        return;
    }
    let spinner = ProgressBar::new_spinner().with_message(printable(message, &[])).with_elapsed(PATIENCE);
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} {elapsed}") {
        spinner.set_style(style);
    }
    spinner.enable_steady_tick(TICK);
    let _ = stopped.recv();
    spinner.finish_and_clear();
}
