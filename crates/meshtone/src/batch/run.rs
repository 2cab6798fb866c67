//! Hands groups to threads, and results to the caller in order.

use std::collections::{BTreeMap, VecDeque};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use super::group::{Numbered, NumberedResult, simulate_group};
use super::keep::Keep;
use super::plan::groups;
use crate::error::Error;
use crate::scenario::Scenario;
use crate::simd::InstructionSet;
use crate::simulate::KnownStages;
use crate::solver::LANES;
use crate::threads;

/// (bytes) What may be kept for each thread of simulations that are planned together.
const WINDOW_BYTES: usize = 16 << 20;
/// Scenarios that are planned together for each thread, at most: so many that groups are full.
const WINDOW_SCENARIOS: usize = 64;

/// What a caller wants to know, and to say, while many simulations run.
pub struct Control<'a> {
    /// Called with the number of finished simulations whenever some have finished: from any thread, but by one at a time, so that the number
    /// never falls.
    pub progress: &'a (dyn Fn(usize) + Sync),
    /// Set by the caller to stop: simulations that have not begun are left out.
    pub cancelled: &'a AtomicBool,
    /// Vector instructions to use; the same for all simulations.
    pub instructions: InstructionSet,
}

static NEVER: AtomicBool = AtomicBool::new(false);

impl Default for Control<'_> {
    /// No progress, no end before the last, the fastest instructions.
    fn default() -> Self {
        Self { progress: &|_| {}, cancelled: &NEVER, instructions: InstructionSet::in_use() }
    }
}

/// Simulates any number of scenarios, in the threads of the current rayon pool.
///
/// # Arguments
/// * `scenarios` - what is simulated; asked for as they are needed, so that they need not all be in memory
/// * `keep` - what is kept of each
/// * `control` - progress, cancellation, instructions
/// * `take` - given the results in the scenarios' order, with each one's number from 0 on, as they finish
///
/// Returns how many were handed to `take`: all of them, unless cancelled.
///
/// A scenario that cannot be simulated gives its own error, as [`crate::simulate`] does, and stops no other. Beyond
/// what `take` has been given, at most 60 MB a thread are held for signals of common length.
///
/// ```
/// use meshtone::batch::{Control, KeepChannels, simulate_many};
/// use meshtone::scenario::{GearPair, Scenario};
///
/// let scenarios = (0..20).map(|n| {
///     let mut scenario = Scenario::new(GearPair { gear_teeth: 34, brake_torque_nm: 1.0 + f64::from(n), ..GearPair::example() });
///     scenario.solver.sampling_rate_hz = 1e4;
///     scenario
/// });
/// let mut lengths = Vec::new();
/// simulate_many(scenarios, &KeepChannels::default(), &Control::default(), |index, signals| {
///     assert_eq!(index, lengths.len());
///     lengths.push(signals.map_or(0, |signals| signals.channels[0].len()));
/// });
/// assert_eq!(lengths.len(), 20);
/// ```
pub fn simulate_many<K: Keep>(
    scenarios: impl IntoIterator<Item = Scenario, IntoIter: Send>,
    keep: &K,
    control: &Control,
    take: impl FnMut(usize, Result<K::Kept, Error>) + Send,
) -> usize {
    let work = Work {
        state: Mutex::new(State {
            source: scenarios.into_iter(),
            numbered: 0,
            queue: VecDeque::new(),
            in_flight: 0,
            waiting: BTreeMap::new(),
            next: 0,
            take,
        }),
        changed: Condvar::new(),
        finished: Mutex::new(0),
        panicked: AtomicBool::new(false),
        keep,
        known: KnownStages::default(),
        control,
        threads: threads::count(),
    };
    threads::each(|| work.run());
    work.lock().next
}

struct Work<'a, K: Keep, I, F> {
    state: Mutex<State<K, I, F>>,
    changed: Condvar,
    finished: Mutex<usize>,
    /// A thread has panicked: what it had in flight never arrives.
    panicked: AtomicBool,
    keep: &'a K,
    /// What the simulations have in common.
    known: KnownStages,
    control: &'a Control<'a>,
    threads: usize,
}

struct State<K: Keep, I, F> {
    source: I,
    /// Scenarios taken from the source.
    numbered: usize,
    queue: VecDeque<Vec<Numbered>>,
    in_flight: usize,
    /// Results that wait for an earlier one.
    waiting: BTreeMap<usize, Result<K::Kept, Error>>,
    /// Number of the next result to hand out.
    next: usize,
    take: F,
}

/// The end of one thread's work, be it a panic of what the caller gave: the others must not wait for it.
struct Ended<'a, 'b, K: Keep, I, F>(&'a Work<'b, K, I, F>);

impl<K: Keep, I, F> Drop for Ended<'_, '_, K, I, F> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.panicked.store(true, Ordering::Relaxed);
            // Whoever is about to wait holds the lock until it does.
            drop(self.0.state.lock());
        }
        self.0.changed.notify_all();
    }
}

impl<K, I, F> Work<'_, K, I, F>
where
    K: Keep,
    I: Iterator<Item = Scenario> + Send,
    F: FnMut(usize, Result<K::Kept, Error>) + Send,
{
    fn lock(&self) -> MutexGuard<'_, State<K, I, F>> {
        // A thread that panicked has poisoned the lock; rayon passes its panic on when the scope ends.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// One thread's work.
    fn run(&self) {
        let ended = Ended(self);
        while let Some(group) = self.next_group() {
            let count = group.len();
            let results = simulate_group(group, self.keep, &self.known, self.control.instructions);
            self.report(count);
            self.hand_out(count, results);
        }
        drop(ended);
    }

    /// Reports that further simulations have finished.
    fn report(&self, count: usize) {
        // The lock is held during the call: of two threads the one that counted first could otherwise report last.
        let mut finished = self.finished.lock().unwrap_or_else(PoisonError::into_inner);
        *finished += count;
        (self.control.progress)(*finished);
    }

    fn next_group(&self) -> Option<Vec<Numbered>> {
        let mut state = self.lock();
        loop {
            if self.control.cancelled.load(Ordering::Relaxed) || self.panicked.load(Ordering::Relaxed) {
                return None;
            }
            if state.queue.is_empty() && !self.is_full(&state) {
                self.plan(&mut state);
                if state.queue.is_empty() {
                    return None;
                }
            }
            if let Some(group) = state.queue.pop_front() {
                state.in_flight += group.len();
                return Some(group);
            }
            // The results that wait do so for one that is in flight in another thread.
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Whether so many results wait that no more are begun.
    fn is_full(&self, state: &State<K, I, F>) -> bool {
        state.in_flight > 0 && state.waiting.len() >= self.threads * LANES
    }

    /// Takes the next scenarios from the source and puts them into groups.
    fn plan(&self, state: &mut State<K, I, F>) {
        let mut window = Vec::new();
        let mut bytes = 0;
        while !window_is_full(window.len(), bytes, self.threads) {
            let Some(scenario) = state.source.next() else { break };
            bytes += self.keep.kept_bytes(&scenario);
            window.push((state.numbered, scenario));
            state.numbered += 1;
        }
        state.queue.extend(groups(window));
    }

    fn hand_out(&self, count: usize, results: Vec<NumberedResult<K::Kept>>) {
        let mut state = self.lock();
        let State { in_flight, waiting, next, take, .. } = &mut *state;
        *in_flight -= count;
        waiting.extend(results);
        while let Some(result) = waiting.remove(next) {
            take(*next, result);
            *next += 1;
        }
        drop(state);
        self.changed.notify_all();
    }
}

/// Whether no more scenarios are planned together with `scenarios` that keep `bytes`.
fn window_is_full(scenarios: usize, bytes: usize, threads: usize) -> bool {
    // Only whole groups: a group of what is left over would leave most of its lanes idle.
    scenarios.is_multiple_of(LANES)
        && (scenarios >= WINDOW_SCENARIOS * threads || bytes >= WINDOW_BYTES * threads)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn window_holds_whole_groups_whatever_is_kept() {
        for threads in 1..=5 {
            for kept_bytes in [0, 1 << 10, 1_963_840, 5 << 20, 100 << 20] {
                let full = (1..).find(|&n| window_is_full(n, n * kept_bytes, threads));
                let full = full.expect("a window ends");
                assert_eq!(full % LANES, 0, "{threads} threads, {kept_bytes} bytes");
                assert!(full <= WINDOW_SCENARIOS * threads);
                // No more than a group beyond what may be kept.
                assert!((full - LANES) * kept_bytes < WINDOW_BYTES * threads || full == LANES);
            }
        }
    }
}
