//! Long calls that Ctrl-C ends.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// Interval at which Python is asked whether Ctrl-C was pressed.
const INTERVAL: Duration = Duration::from_millis(50);

/// Does long work in a thread of its own, without the interpreter's lock, and stops it when Python is interrupted.
///
/// # Arguments
/// * `work` - given what is set when it shall stop
/// * `while_waiting` - called some times a second, with the lock, and once at the end: for progress
///
/// # Errors
/// The exception that interrupted Python, or that `while_waiting` raised: the work has then been stopped.
pub fn interruptible<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send,
    mut while_waiting: impl FnMut(Python<'_>) -> PyResult<()> + Send,
) -> PyResult<T> {
    let cancelled = AtomicBool::new(false);
    let mut outcome = Ok(());
    let result = py.detach(|| {
        let (to, from) = sync_channel(1);
        let cancelled = &cancelled;
        std::thread::scope(|scope| {
            // Nobody listens any more only if this thread is unwinding.
            scope.spawn(move || to.send(work(cancelled)));
            loop {
                match from.recv_timeout(INTERVAL) {
                    Err(RecvTimeoutError::Timeout) if outcome.is_ok() => {
                        outcome = Python::attach(|py| py.check_signals().and_then(|()| while_waiting(py)));
                        // The work may have set it too.
                        cancelled.fetch_or(outcome.is_err(), Ordering::Relaxed);
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                    Ok(result) => break Some(result),
                    Err(RecvTimeoutError::Disconnected) => break None,
                }
            }
        })
    });
    outcome?;
    while_waiting(py)?;
    result.ok_or_else(|| PyRuntimeError::new_err("the computation ended without a result"))
}
