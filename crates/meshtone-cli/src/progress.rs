//! A sign of life while something takes long.

use std::io::{self, IsTerminal};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Time after which a bar is drawn: shorter work needs none.
const PATIENCE: Duration = Duration::from_secs(1);
const TICK: Duration = Duration::from_millis(120);

/// A bar on a terminal's standard error.
///
/// # Arguments
/// * `counted` - what is counted, such as "simulations"
/// * `wanted` - whether anything is to be shown
pub fn bar(counted: &str, wanted: bool) -> ProgressBar {
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

/// A spinner on a terminal's standard error, from one second on until it is dropped.
pub struct Progress {
    running: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// Starts waiting; nothing is ever shown where standard error is no terminal.
    ///
    /// # Arguments
    /// * `message` - what is being done
    /// * `wanted` - whether anything is to be shown
    pub fn start(message: String, wanted: bool) -> Self {
        if !wanted || !io::stderr().is_terminal() {
            return Self { running: None };
        }
        let (stop, stopped) = channel();
        Self { running: Some((stop, thread::spawn(move || show(message, &stopped)))) }
    }
}

fn show(message: String, stopped: &Receiver<()>) {
    if stopped.recv_timeout(PATIENCE) != Err(RecvTimeoutError::Timeout) {
        return;
    }
    let spinner = ProgressBar::new_spinner().with_message(message).with_elapsed(PATIENCE);
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} {elapsed}") {
        spinner.set_style(style);
    }
    spinner.enable_steady_tick(TICK);
    let _ = stopped.recv();
    spinner.finish_and_clear();
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((stop, thread)) = self.running.take() {
            drop(stop);
            let _ = thread.join();
        }
    }
}
