//! Long calls that Ctrl-C ends.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// Interval at which Python is asked whether Ctrl-C was pressed.
const INTERVAL: Duration = Duration::from_millis(50);

/// What the work reports of its progress: how much is finished, and of how much.
pub type Report<'a> = &'a (dyn Fn(u64, u64) + Sync);

/// Does long work in a thread of its own, without the interpreter's lock, and stops it when Python is interrupted.
///
/// The work only stores its progress; this thread, which alone waits for the lock, hands it to Python some times a second and once
/// at the end.
///
/// # Arguments
/// * `progress` - Python's function of what is finished and of how much, if it wants to know
/// * `total` - how much there is to do, as far as it is known before the work reports it, else 0
/// * `work` - given what is set when it shall stop, and what it reports its progress to
///
/// # Errors
/// The exception that interrupted Python, or that `progress` raised: the work has then been stopped.
pub fn interruptible<T: Send>(
    py: Python<'_>,
    progress: Option<Bound<'_, PyAny>>,
    total: u64,
    work: impl FnOnce(&AtomicBool, Report) -> T + Send,
) -> PyResult<T> {
    let cancelled = AtomicBool::new(false);
    let (finished, all) = (AtomicU64::new(0), AtomicU64::new(total));
    let report = |done, of| {
        finished.store(done, Ordering::Relaxed);
        all.store(of, Ordering::Relaxed);
    };
    let progress = progress.map(Bound::unbind);
    let show = |py: Python<'_>| match &progress {
        Some(progress) => {
            let counts = (finished.load(Ordering::Relaxed), all.load(Ordering::Relaxed));
            progress.call1(py, counts).map(drop)
        }
        None => Ok(()),
    };
    let mut outcome = Ok(());
    let result = py.detach(|| {
        let (to, from) = sync_channel(1);
        let (cancelled, report) = (&cancelled, &report);
        std::thread::scope(|scope| {
            // Nobody listens any more only if this thread is unwinding.
            scope.spawn(move || to.send(work(cancelled, report)));
            loop {
                match from.recv_timeout(INTERVAL) {
                    Err(RecvTimeoutError::Timeout) if outcome.is_ok() => {
                        outcome = Python::attach(|py| py.check_signals().and_then(|()| show(py)));
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
    show(py)?;
    result.ok_or_else(|| PyRuntimeError::new_err("the computation ended without a result"))
}
