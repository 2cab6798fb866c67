//! The threads of the current rayon pool; without the feature `threads`, the one that asks.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

#[cfg(feature = "threads")]
use rayon::prelude::*;

/// The number of them.
pub(crate) fn count() -> usize {
    #[cfg(feature = "threads")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "threads"))]
    1
}

/// Lets each of them do the same work; comes back when all have ended.
pub(crate) fn each(work: impl Fn() + Sync) {
    #[cfg(feature = "threads")]
    rayon::scope(|scope| {
        for _ in 0..count() {
            scope.spawn(|_| work());
        }
    });
    #[cfg(not(feature = "threads"))]
    work();
}

/// Results of `work` for each item, in the items' order.
pub(crate) fn map<T: Send, R: Send>(
    items: impl IntoIterator<Item = T>,
    work: impl Fn(T) -> R + Sync + Send,
) -> Vec<R> {
    #[cfg(feature = "threads")]
    {
        let mut results = Vec::new();
        items.into_iter().collect::<Vec<T>>().into_par_iter().map(work).collect_into_vec(&mut results);
        results
    }
    #[cfg(not(feature = "threads"))]
    items.into_iter().map(work).collect()
}

/// Does what [`map`] does, but once `work` has failed for an item, it is done for none that has not begun.
///
/// # Errors
/// One of those that `work` gave.
pub(crate) fn try_map<T: Send, R: Send, E: Send>(
    items: impl IntoIterator<Item = T>,
    work: impl Fn(T) -> Result<R, E> + Sync + Send,
) -> Result<Vec<R>, E> {
    let has_failed = AtomicBool::new(false);
    let results = map(items, |item| {
        (!has_failed.load(Relaxed)).then(|| work(item).inspect_err(|_| has_failed.store(true, Relaxed)))
    });
    results.into_iter().flatten().collect()
}
