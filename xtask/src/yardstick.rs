//! How slow the processor is while the checks run: a fixed piece of work, timed beside them.
//!
//! Processor time of the same work differs between machines, and on a machine that is shared between hours, by a factor of two and
//! more. Budgets are stated for one quiet machine; what is compared with them is the ratio of two times of one run.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Time between two pieces of work, which take a fiftieth of it.
const PAUSE: Duration = Duration::from_secs(5);

/// The times of a fixed piece of work since [`Yardstick::begin`].
pub struct Yardstick {
    /// (s) Processor time of each.
    times_s: Arc<Mutex<Vec<f64>>>,
}

impl Yardstick {
    /// Begins to measure, until the program ends.
    pub fn begin() -> Self {
        let times_s = Arc::new(Mutex::new(Vec::new()));
        let measured = Arc::clone(&times_s);
        std::thread::spawn(move || {
            while let Some(time_s) = time_of_work_s() {
                measured.lock().unwrap_or_else(PoisonError::into_inner).push(time_s);
                std::thread::sleep(PAUSE);
            }
        });
        Self { times_s }
    }

    /// (s) Mean processor time of the work so far; none where the operating system does not state a thread's.
    pub fn mean_s(&self) -> Option<f64> {
        let times_s = self.times_s.lock().unwrap_or_else(PoisonError::into_inner);
        (!times_s.is_empty()).then(|| times_s.iter().sum::<f64>() / times_s.len() as f64)
    }
}

/// (s) Processor time of the work, which sorts and searches in 2 MB, since compilers wait for memory most of their time.
fn time_of_work_s() -> Option<f64> {
    let begin_s = thread_s()?;
    let mut state = 1u64;
    let words = std::iter::repeat_with(|| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        state >> 20
    });
    let tree: BTreeMap<u64, u64> = words.take(60_000).zip(0..).collect();
    let found = tree.keys().filter(|word| tree.contains_key(&(*word ^ 1))).count();
    std::hint::black_box(found);
    Some(thread_s()? - begin_s)
}

/// (s) Processor time of this thread.
fn thread_s() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(text.split_whitespace().next()?.parse::<f64>().ok()? * 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_work_takes_about_the_same_time() {
        let Some(first_s) = time_of_work_s() else { return };
        let second_s = time_of_work_s().expect("the time of a thread");
        assert!((0.2..5.0).contains(&(second_s / first_s)), "{first_s} s and {second_s} s");
    }
}
