//! States of one block of samples, and what is read off them.

use super::outputs::OutputWeights;
use super::step::State;
use crate::simd::{Dispatch, Instructions, Lanes, Task};

/// Samples that are forced, solved and handed out at a time: the states of eight simulations stay in the second-level cache.
pub(super) const BLOCK: usize = 256;

/// `V` variables over a block of samples.
struct Columns<const L: usize, const V: usize>(Box<Aligned<[[Lanes<L>; BLOCK]; V]>>);

/// Starts at a cache line.
#[repr(align(64))]
struct Aligned<T>(T);

/// States of one block of samples, variable by variable, so that outputs are computed for many samples at once.
pub(super) struct History<const L: usize, const N: usize, const R: usize> {
    displacement: Columns<L, N>,
    velocity: Columns<L, N>,
    acceleration: Columns<L, N>,
    force: Columns<L, R>,
}

impl<const L: usize, const N: usize, const R: usize> History<L, N, R> {
    pub(super) fn new() -> Self {
        Self {
            displacement: Columns::new(),
            velocity: Columns::new(),
            acceleration: Columns::new(),
            force: Columns::new(),
        }
    }

    /// Stores the state of sample `k` of the block.
    #[inline(always)]
    pub(super) fn store(&mut self, k: usize, state: &State<L, N, R>) {
        // Never larger; lets the compiler see that.
        let k = k % BLOCK;
        for n in 0..N {
            self.displacement.0.0[n][k] = state.displacement[n];
            self.velocity.0.0[n][k] = state.velocity[n];
            self.acceleration.0.0[n][k] = state.acceleration[n];
        }
        for r in 0..R {
            self.force.0.0[r][k] = state.force[r];
        }
    }

    /// Variable `index`: displacements first, then velocities, accelerations and forces.
    fn variable(&self, index: usize) -> &[Lanes<L>] {
        let all = self.displacement.iter().chain(self.velocity.iter()).chain(self.acceleration.iter());
        all.chain(self.force.iter()).nth(index).map_or(&[], |column| column)
    }
}

impl<const L: usize, const V: usize> Columns<L, V> {
    fn new() -> Self {
        Self(Box::new(Aligned([[Lanes::splat(0.0); BLOCK]; V])))
    }

    fn iter(&self) -> impl Iterator<Item = &[Lanes<L>; BLOCK]> {
        self.0.0.iter()
    }
}

/// An output of several simulations as a combination of a [`History`]'s variables; those whose weight is zero everywhere are left
/// out.
pub(super) struct OutputTerms<const L: usize> {
    weights: Vec<(usize, Lanes<L>)>,
    constant: Lanes<L>,
    per_sample: Lanes<L>,
    /// Number of the sample at which each lane starts.
    start: Lanes<L>,
}

impl<const L: usize> OutputTerms<L> {
    /// Lines an output of `L` simulations up.
    ///
    /// # Arguments
    /// * `outputs` - of each lane; a lane without this output gives 0
    /// * `start` - number of the sample at which each lane starts
    pub(super) fn new<const N: usize, const R: usize>(
        outputs: [Option<&OutputWeights>; L],
        start: Lanes<L>,
    ) -> Self {
        let lanes = |of: &dyn Fn(&OutputWeights) -> f64| Lanes::from_fn(|l| outputs[l].map_or(0.0, of));
        let weight = |variable: usize| {
            let value = |values: &[f64], index: usize| values.get(index).copied().unwrap_or(0.0);
            lanes(&|output| match variable {
                _ if variable < N => value(&output.displacement, variable),
                _ if variable < 2 * N => value(&output.velocity, variable - N),
                _ if variable < 3 * N => value(&output.acceleration, variable - 2 * N),
                _ => value(&output.force, variable - 3 * N),
            })
        };
        let all = (0..3 * N + R).map(|variable| (variable, weight(variable)));
        Self {
            weights: all.filter(|(_, weight)| weight.0 != [0.0; L]).collect(),
            constant: lanes(&|output| output.constant),
            per_sample: lanes(&|output| output.per_sample),
            start,
        }
    }

    /// The output at the samples from `first` on.
    ///
    /// # Arguments
    /// * `instructions` - what the processor may use
    /// * `history` - the states
    /// * `first` - number of steps before the block's first sample
    /// * `output` - set, one per sample
    pub(super) fn evaluate<const N: usize, const R: usize>(
        &self,
        instructions: impl Dispatch,
        history: &History<L, N, R>,
        first: usize,
        output: &mut [Lanes<L>],
    ) {
        let terms: Vec<_> =
            self.weights.iter().map(|&(variable, weight)| (weight, history.variable(variable))).collect();
        instructions.run(Evaluate { of: self, terms: &terms, first, output });
    }
}

/// Samples whose outputs are summed in registers.
const CHUNK: usize = 8;

/// `output = constant + slope · sample + Σ weight · variable`.
struct Evaluate<'a, const L: usize> {
    of: &'a OutputTerms<L>,
    terms: &'a [(Lanes<L>, &'a [Lanes<L>])],
    first: usize,
    output: &'a mut [Lanes<L>],
}

impl<const L: usize> Evaluate<'_, L> {
    #[inline(always)]
    fn constant<I: Instructions>(&self, simd: I, k: usize) -> Lanes<L> {
        let sample = self.of.start.add(simd, Lanes::splat((self.first + k) as f64));
        self.of.per_sample.mul_add(simd, sample, self.of.constant)
    }
}

impl<const L: usize> Task for Evaluate<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(self, simd: I) {
        let samples = self.output.len();
        let whole = samples - samples % CHUNK;
        for start in (0..whole).step_by(CHUNK) {
            // No `from_fn`: its closure would be compiled without the instruction set, and every intrinsic in it a call.
            let mut sums = [Lanes::splat(0.0); CHUNK];
            for k in 0..CHUNK {
                sums[k] = self.constant(simd, start + k);
            }
            for (weight, variable) in self.terms {
                for (sum, value) in sums.iter_mut().zip(&variable[start..start + CHUNK]) {
                    *sum = weight.mul_add(simd, *value, *sum);
                }
            }
            self.output[start..start + CHUNK].copy_from_slice(&sums);
        }
        for k in whole..samples {
            let mut sum = self.constant(simd, k);
            for (weight, variable) in self.terms {
                sum = weight.mul_add(simd, variable[k], sum);
            }
            self.output[k] = sum;
        }
    }
}
