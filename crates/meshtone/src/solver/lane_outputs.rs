//! Gives the outputs of simulations side by side to the recorder of each.

use super::integrate::{Block, Diverged, MotionState, Problem, Recorder};
use crate::simd::Lanes;

/// Outputs of one block of samples, and who takes them.
pub(super) struct LaneOutputs<'r, const L: usize> {
    /// The outputs of a block, side by side.
    pub(super) values: Vec<Vec<Lanes<L>>>,
    /// What became of each simulation.
    pub(super) results: [Result<(), Diverged>; L],
    /// Steps of the longest simulation, counting the one that leads beyond its last sample.
    pub(super) most_steps: usize,
    /// The outputs of one lane.
    of_lane: Vec<Vec<f64>>,
    spans: [Span; L],
    /// Of the first lanes; the others repeat a simulation, and nobody takes their outputs.
    recorders: Vec<&'r mut dyn Recorder>,
}

/// Samples of one simulation, by their numbers.
#[derive(Clone, Copy)]
struct Span {
    start: usize,
    first_recorded: usize,
    end: usize,
}

impl<'r, const L: usize> LaneOutputs<'r, L> {
    /// Room for blocks of `block` samples of `outputs` outputs.
    pub(super) fn new(
        problems: [&Problem; L],
        outputs: usize,
        block: usize,
        recorders: Vec<&'r mut dyn Recorder>,
    ) -> Self {
        let spans = problems.map(|problem| {
            let time = problem.time;
            Span {
                start: time.first_simulated_sample,
                first_recorded: problem.first_sample,
                end: time.samples,
            }
        });
        Self {
            values: vec![vec![Lanes::splat(0.0); block]; outputs],
            results: [Ok(()); L],
            most_steps: spans.iter().map(|span| span.end.saturating_sub(span.start)).max().unwrap_or(0),
            of_lane: vec![Vec::with_capacity(block); outputs],
            spans,
            recorders,
        }
    }

    /// Whether any simulation records a sample before step `step`.
    pub(super) fn is_recorded(&self, step: usize) -> bool {
        self.spans.iter().any(|span| span.start + step > span.first_recorded)
    }

    /// Whether any of the recorders still wants samples.
    pub(super) fn goes_on(&self) -> bool {
        self.recorders.iter().any(|recorder| recorder.goes_on())
    }

    /// Gives each recorder the motion before the next block, where it wants that.
    ///
    /// # Arguments
    /// * `done` - number of steps so far
    /// * `state` - the motion of a lane, at a sample
    pub(super) fn keep_states(&mut self, done: usize, state: impl Fn(usize, usize) -> MotionState) {
        for (l, recorder) in self.recorders.iter_mut().enumerate() {
            let sample = self.spans[l].start + done;
            if sample < self.spans[l].end && recorder.wants_state(sample) {
                recorder.keep_state(state(l, sample));
            }
        }
    }

    /// Gives each recorder the samples after the first `done` steps.
    ///
    /// # Arguments
    /// * `done` - number of steps before the block
    /// * `steps` - samples in the block
    /// * `is_sound` - whether a lane's solution is one
    pub(super) fn record(&mut self, done: usize, steps: usize, is_sound: impl Fn(usize) -> bool) {
        for (l, recorder) in self.recorders.iter_mut().enumerate() {
            let Span { start, first_recorded, end } = self.spans[l];
            let first = start + done;
            if first < end && !is_sound(l) {
                self.results[l] = self.results[l].and(Err(Diverged { sample: first + steps }));
            }
            let from = first_recorded.saturating_sub(first).min(steps);
            let until = end.saturating_sub(first).min(steps);
            if from >= until || self.results[l].is_err() {
                continue;
            }
            for (output, values) in self.of_lane.iter_mut().zip(&self.values) {
                output.clear();
                output.extend(values[from..until].iter().map(|value| value.0[l]));
            }
            recorder.record(&Block::new(first + from, &self.of_lane));
        }
    }
}
