//! A steady motion that repeats itself is not simulated to its end.

use super::integrate::{Block, MotionState, Problem, Recorder, StepCounts};

/// (-) Rms of the difference of two hunting-tooth periods, relative to the rms, up to which they are the same.
const SAME: f64 = 1e-6;
/// (-) Part of a signal's mean square below which its variance is rounding.
const ROUNDING: f64 = 1e-18;
/// Fewest periods of a signal that is watched: two are compared, so that of fewer nothing would be saved.
const FEWEST_PERIODS: usize = 3;

/// Passes outputs on, and repeats the last hunting-tooth period to the end once it agrees with the one before.
pub(super) struct Repeating<'r> {
    recorder: &'r mut dyn Recorder,
    /// Samples of a period; none where nothing is repeated.
    period: Option<usize>,
    /// Number of the sample behind the last.
    end: usize,
    /// The last samples of each output, as many as a period has; the first recorded sample has place 0.
    last: Vec<Vec<f64>>,
    /// Of each output, since the present period began: the sum, the sum of squares, and that of the difference from the period before.
    sums: Vec<[f64; 3]>,
    /// Samples that were recorded.
    recorded: usize,
    is_complete: bool,
}

impl<'r> Repeating<'r> {
    pub(super) fn new(problem: &Problem, recorder: &'r mut dyn Recorder) -> Self {
        let end = problem.time.samples;
        let recorded = end.saturating_sub(problem.first_sample);
        let is_long = |period: &usize| *period > 0 && recorded / *period >= FEWEST_PERIODS;
        Self {
            recorder,
            period: problem.hunting_period_samples.filter(is_long),
            end,
            last: Vec::new(),
            sums: Vec::new(),
            recorded: 0,
            is_complete: false,
        }
    }

    /// Compares samples with those a period before, and keeps them.
    ///
    /// # Returns
    /// Whether a period ended that agrees with the one before.
    fn compare(&mut self, block: &Block, period: usize) -> bool {
        let outputs = block.outputs().len();
        self.last.resize_with(outputs, || Vec::with_capacity(period));
        self.sums.resize(outputs, [0.0; 3]);
        let (mut agrees, mut done) = (false, 0);
        while done < block.len() {
            let place = self.recorded % period;
            let count = (block.len() - done).min(period - place);
            for ((output, last), [sum, square, difference]) in
                block.outputs().iter().zip(&mut self.last).zip(&mut self.sums)
            {
                let samples = &output[done..done + count];
                if self.recorded < period {
                    last.extend_from_slice(samples);
                    continue;
                }
                for (before, &sample) in last[place..].iter_mut().zip(samples) {
                    *difference += (sample - *before) * (sample - *before);
                    *sum += sample;
                    *square += sample * sample;
                    *before = sample;
                }
            }
            self.recorded += count;
            done += count;
            if self.recorded >= 2 * period && self.recorded.is_multiple_of(period) {
                // Relative to what varies, so that a shaft's mean speed hides nothing; a signal that is constant agrees up to rounding.
                let is_same = |[sum, square, difference]: &[f64; 3]| {
                    let varying = (square - sum * sum / period as f64).max(ROUNDING * square);
                    *difference <= SAME * SAME * varying
                };
                agrees |= self.sums.iter().all(is_same);
                self.sums.fill([0.0; 3]);
            }
        }
        agrees
    }

    /// Records the last period again and again, from sample `next` to the end.
    fn repeat(&mut self, next: usize, period: usize) {
        let mut sample = next;
        while sample < self.end && self.recorder.goes_on() {
            let place = self.recorded % period;
            let count = (self.end - sample).min(period - place);
            let outputs: Vec<Vec<f64>> =
                self.last.iter().map(|last| last[place..place + count].to_vec()).collect();
            self.recorder.record(&Block::new(sample, &outputs));
            self.recorded += count;
            sample += count;
        }
        self.is_complete = true;
    }
}

impl Recorder for Repeating<'_> {
    fn record(&mut self, block: &Block) {
        if self.is_complete {
            return;
        }
        self.recorder.record(block);
        if let Some(period) = self.period
            && self.compare(block, period)
        {
            self.repeat(block.first_sample + block.len(), period);
        }
    }

    fn wants_state(&self, sample: usize) -> bool {
        self.recorder.wants_state(sample)
    }

    fn keep_state(&mut self, state: MotionState) {
        self.recorder.keep_state(state);
    }

    fn count(&mut self, counts: StepCounts) {
        self.recorder.count(counts);
    }

    fn goes_on(&self) -> bool {
        !self.is_complete && self.recorder.goes_on()
    }
}
