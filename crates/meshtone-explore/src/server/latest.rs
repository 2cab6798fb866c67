//! The newest request of each page: older ones are dropped.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Pages and purposes that are remembered; the one asked longest ago is forgotten first.
const MOST_REMEMBERED: usize = 64;
/// Longest time of an answer.
const MOST_TIME: Duration = Duration::from_secs(60);

/// The newest request of each page, for each purpose.
#[derive(Debug, Default)]
pub(super) struct NewestRequests {
    numbers: Mutex<VecDeque<(String, Arc<AtomicU64>)>>,
}

impl NewestRequests {
    /// Notes a request.
    ///
    /// # Arguments
    /// * `asker` - which page, and for what
    /// * `number` - the request's; later ones are higher
    pub(super) fn note(&self, asker: &str, number: u64) -> RequestTurn {
        let mut numbers = self.numbers.lock().unwrap_or_else(PoisonError::into_inner);
        let known = numbers.iter().position(|(name, _)| name == asker);
        let entry =
            known.and_then(|at| numbers.remove(at)).unwrap_or_else(|| (asker.to_owned(), Arc::default()));
        let latest = Arc::clone(&entry.1);
        numbers.push_back(entry);
        if numbers.len() > MOST_REMEMBERED {
            numbers.pop_front();
        }
        latest.fetch_max(number, Ordering::Relaxed);
        RequestTurn { number, latest, abandoned: Arc::default(), until: Instant::now() + MOST_TIME }
    }
}

/// A request's turn: until a later one comes, nobody waits for it any more, or it has taken too long.
#[derive(Debug, Clone)]
pub(super) struct RequestTurn {
    number: u64,
    latest: Arc<AtomicU64>,
    abandoned: Arc<AtomicBool>,
    until: Instant,
}

impl RequestTurn {
    /// Returns whether its answer is still wanted.
    pub(super) fn is_wanted(&self) -> bool {
        self.latest.load(Ordering::Relaxed) <= self.number
            && !self.abandoned.load(Ordering::Relaxed)
            && !self.is_late()
    }

    /// Returns whether it has taken too long.
    pub(super) fn is_late(&self) -> bool {
        Instant::now() > self.until
    }

    /// A guard that ends the turn when it is dropped: with a connection that is closed.
    pub(super) fn abandoned_on_drop(&self) -> AbandonedOnDrop {
        AbandonedOnDrop(Arc::clone(&self.abandoned))
    }

    /// Set when the turn has been abandoned.
    pub(super) fn abandoned(&self) -> &AtomicBool {
        &self.abandoned
    }
}

/// Ends a turn when nobody waits for its answer.
pub(super) struct AbandonedOnDrop(Arc<AtomicBool>);

impl Drop for AbandonedOnDrop {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_later_request_takes_the_place_of_earlier_ones() {
        let latest = NewestRequests::default();
        let first = latest.note("page", 1);
        assert!(first.is_wanted());
        let second = latest.note("page", 2);
        assert!(!first.is_wanted() && second.is_wanted());
        // One that was overtaken on its way.
        assert!(!latest.note("page", 1).is_wanted());
        assert!(latest.note("another page", 1).is_wanted() && second.is_wanted());
        drop(second.abandoned_on_drop());
        assert!(!second.is_wanted());
    }

    #[test]
    fn no_more_than_some_pages_are_remembered() {
        let latest = NewestRequests::default();
        (0..1000).for_each(|page| drop(latest.note(&page.to_string(), 1)));
        assert_eq!(latest.numbers.lock().unwrap().len(), MOST_REMEMBERED);
    }
}
