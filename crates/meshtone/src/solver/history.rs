//! States of one block of samples, and what is read off them.

use super::instruction_set::{InstructionSet, Instructions, Task};
use super::lanes::Lanes;
use super::outputs::{EXTERNALS, OutputRow};
use super::step::State;

/// One variable over a block of samples. Starts at a cache line.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Column<const L: usize, const BLOCK: usize> {
    samples: [Lanes<L>; BLOCK],
    /// A block is whole pages: without a line between them, the columns of a state would share one set of the cache.
    apart: [f64; 8],
}

/// States of one block of samples, variable by variable, so that outputs are computed for many samples at once.
pub(super) struct History<const L: usize, const BLOCK: usize> {
    /// Displacements first, then scaled velocities, forces and externals.
    columns: Vec<Column<L, BLOCK>>,
}

/// A [`History`] for the states of `N` modes and `R` directions.
pub(super) struct Columns<'a, const L: usize, const N: usize, const R: usize, const BLOCK: usize> {
    displacement: &'a mut [Column<L, BLOCK>; N],
    scaled_velocity: &'a mut [Column<L, BLOCK>; N],
    force: &'a mut [Column<L, BLOCK>; R],
    external: &'a mut [Column<L, BLOCK>; EXTERNALS],
}

impl<const L: usize, const BLOCK: usize> History<L, BLOCK> {
    /// Room for a block of states.
    ///
    /// # Arguments
    /// * `modes`, `directions` - that a state has
    pub(super) fn new(modes: usize, directions: usize) -> Self {
        let columns = 2 * modes + directions + EXTERNALS;
        Self { columns: vec![Column { samples: [Lanes::splat(0.0); BLOCK], apart: [0.0; 8] }; columns] }
    }

    /// The columns of a state; none where they are not as many.
    pub(super) fn columns<const N: usize, const R: usize>(&mut self) -> Option<Columns<'_, L, N, R, BLOCK>> {
        let (displacement, rest) = self.columns.split_first_chunk_mut()?;
        let (scaled_velocity, rest) = rest.split_first_chunk_mut()?;
        let (force, rest) = rest.split_first_chunk_mut()?;
        let (external, _) = rest.split_first_chunk_mut()?;
        Some(Columns { displacement, scaled_velocity, force, external })
    }
}

impl<const L: usize, const N: usize, const R: usize, const BLOCK: usize> Columns<'_, L, N, R, BLOCK> {
    /// Stores the state of sample `k` of the block.
    #[inline(always)]
    pub(super) fn store<const STEADY: bool>(&mut self, k: usize, state: &State<L, N, R>) {
        // Never larger; lets the compiler see that.
        let k = k % BLOCK;
        for n in 0..N {
            self.displacement[n].samples[k] = state.displacement[n];
            self.scaled_velocity[n].samples[k] = state.scaled_velocity[n];
        }
        for r in 0..R {
            self.force[r].samples[k] = state.force[r];
        }
        if !STEADY {
            for x in 0..EXTERNALS {
                self.external[x].samples[k] = state.external[x];
            }
        }
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
    /// * `modes`, `directions` - of the [`History`]
    /// * `start` - number of the sample at which each lane starts
    pub(super) fn new(rows: [&OutputRow; L], modes: usize, directions: usize, start: [f64; L]) -> Self {
        let variables = |row: &OutputRow| -> Vec<f64> {
            let mut values = vec![0.0; 2 * modes + directions + EXTERNALS];
            let parts = [
                (0, &row.displacement[..]),
                (modes, &row.scaled_velocity),
                (2 * modes, &row.force),
                (2 * modes + directions, &row.external),
            ];
            for (first, part) in parts {
                values[first..first + part.len()].copy_from_slice(part);
            }
            values
        };
        let by_lane = rows.map(variables);
        let weights =
            (0..by_lane[0].len()).map(|variable| (variable, Lanes::from_fn(|l| by_lane[l][variable])));
        Self {
            weights: weights.filter(|(_, weight)| weight.0 != [0.0; L]).collect(),
            constant: Lanes::from_fn(|l| rows[l].constant),
            per_sample: Lanes::from_fn(|l| rows[l].per_sample),
            start: Lanes::from_fn(|l| start[l]),
        }
    }

    /// The output at the samples from `first` on.
    ///
    /// # Arguments
    /// * `instructions` - what the processor may use
    /// * `history` - the states
    /// * `first` - number of steps before the block's first sample
    /// * `output` - set, one per sample
    pub(super) fn evaluate<const BLOCK: usize>(
        &self,
        instructions: InstructionSet,
        history: &History<L, BLOCK>,
        first: usize,
        output: &mut [Lanes<L>],
    ) {
        let column = |variable: usize| &history.columns[variable].samples[..];
        let terms: Vec<_> =
            self.weights.iter().map(|&(variable, weight)| (weight, column(variable))).collect();
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
