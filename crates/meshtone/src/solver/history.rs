//! States of one block of samples, and what is read off them.

use super::outputs::{EXTERNALS, OutputRow};
use super::step::State;
use crate::simd::{InstructionSet, Instructions, Lanes, Task};

/// `V` variables over a block of samples.
struct Columns<const L: usize, const V: usize, const BLOCK: usize>(Box<Aligned<[[Lanes<L>; BLOCK]; V]>>);

/// Starts at a cache line.
#[repr(align(64))]
struct Aligned<T>(T);

/// States of one block of samples, variable by variable, so that outputs are computed for many samples at once.
pub(super) struct History<const L: usize, const N: usize, const R: usize, const BLOCK: usize> {
    displacement: Columns<L, N, BLOCK>,
    scaled_velocity: Columns<L, N, BLOCK>,
    force: Columns<L, R, BLOCK>,
    external: Columns<L, EXTERNALS, BLOCK>,
}

impl<const L: usize, const N: usize, const R: usize, const BLOCK: usize> History<L, N, R, BLOCK> {
    pub(super) fn new() -> Self {
        Self {
            displacement: Columns::new(),
            scaled_velocity: Columns::new(),
            force: Columns::new(),
            external: Columns::new(),
        }
    }

    /// Stores the state of sample `k` of the block.
    #[inline(always)]
    pub(super) fn store<const STEADY: bool>(&mut self, k: usize, state: &State<L, N, R>) {
        // Never larger; lets the compiler see that.
        let k = k % BLOCK;
        for n in 0..N {
            self.displacement.0.0[n][k] = state.displacement[n];
            self.scaled_velocity.0.0[n][k] = state.scaled_velocity[n];
        }
        for r in 0..R {
            self.force.0.0[r][k] = state.force[r];
        }
        if !STEADY {
            for x in 0..EXTERNALS {
                self.external.0.0[x][k] = state.external[x];
            }
        }
    }

    /// Variable `index`: displacements first, then scaled velocities, forces and externals.
    fn variable(&self, index: usize) -> &[Lanes<L>] {
        let all = self.displacement.iter().chain(self.scaled_velocity.iter());
        all.chain(self.force.iter()).chain(self.external.iter()).nth(index).map_or(&[], |column| column)
    }
}

impl<const L: usize, const V: usize, const BLOCK: usize> Columns<L, V, BLOCK> {
    fn new() -> Self {
        Self(Box::new(Aligned([[Lanes::splat(0.0); BLOCK]; V])))
    }

    fn iter(&self) -> impl Iterator<Item = &[Lanes<L>; BLOCK]> {
        self.0.0.iter()
    }
}

/// An output as a combination of a [`History`]'s variables; those whose weight is zero everywhere are left out.
pub(super) struct Row<const L: usize> {
    weights: Vec<(usize, Lanes<L>)>,
    constant: Lanes<L>,
    per_sample: Lanes<L>,
    /// Number of the sample at which each lane starts.
    start: Lanes<L>,
}

impl<const L: usize> Row<L> {
    /// Lines an output of `L` simulations up.
    ///
    /// # Arguments
    /// * `rows` - of each lane
    /// * `start` - number of the sample at which each lane starts
    pub(super) fn new<const N: usize, const R: usize>(rows: [&OutputRow; L], start: Lanes<L>) -> Self {
        let value = |values: &[f64], index: usize| values.get(index).copied().unwrap_or(0.0);
        let displacement = (0..N).map(|n| (n, Lanes::from_fn(|l| value(&rows[l].displacement, n))));
        let velocity = (0..N).map(|n| (N + n, Lanes::from_fn(|l| value(&rows[l].scaled_velocity, n))));
        let force = (0..R).map(|r| (2 * N + r, Lanes::from_fn(|l| value(&rows[l].force, r))));
        let external = (0..EXTERNALS).map(|x| (2 * N + R + x, Lanes::from_fn(|l| rows[l].external[x])));
        let all = displacement.chain(velocity).chain(force).chain(external);
        Self {
            weights: all.filter(|(_, weight): &(usize, Lanes<L>)| weight.0 != [0.0; L]).collect(),
            constant: Lanes::from_fn(|l| rows[l].constant),
            per_sample: Lanes::from_fn(|l| rows[l].per_sample),
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
    pub(super) fn evaluate<const N: usize, const R: usize, const BLOCK: usize>(
        &self,
        instructions: InstructionSet,
        history: &History<L, N, R, BLOCK>,
        first: usize,
        output: &mut [Lanes<L>],
    ) {
        let terms: Vec<_> =
            self.weights.iter().map(|&(variable, weight)| (weight, history.variable(variable))).collect();
        instructions.run(Evaluate { row: self, terms: &terms, first, output });
    }
}

/// Samples whose outputs are summed in registers.
const CHUNK: usize = 8;

/// `output = constant + slope · sample + Σ weight · variable`.
struct Evaluate<'a, const L: usize> {
    row: &'a Row<L>,
    terms: &'a [(Lanes<L>, &'a [Lanes<L>])],
    first: usize,
    output: &'a mut [Lanes<L>],
}

impl<const L: usize> Evaluate<'_, L> {
    #[inline(always)]
    fn constant<I: Instructions>(&self, simd: I, k: usize) -> Lanes<L> {
        let sample = self.row.start.add(simd, Lanes::splat((self.first + k) as f64));
        self.row.per_sample.mul_add(simd, sample, self.row.constant)
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
