//! The time loop over one block of samples: all that is compiled for each instruction set.

use super::history::History;
use super::shared_forcing::SharedForcing;
use super::step::{Coefficients, State, StepForcing};
use crate::mesh::law::MeshLaw;
use crate::simd::{Instructions, Task};

/// Some steps of `L` simulations under the mesh law `M`.
pub(super) struct Stretch<
    'a,
    M: MeshLaw<L, R>,
    const L: usize,
    const N: usize,
    const R: usize,
    const BLOCK: usize,
    const STEADY: bool,
> {
    pub(super) coefficients: &'a Coefficients<L, N, R>,
    pub(super) law: &'a M,
    pub(super) state: &'a mut State<L, N, R>,
    /// Number of steps since the start of the integration.
    pub(super) steps_before: usize,
    /// Forcing of the samples after the state's.
    pub(super) forcing: &'a SharedForcing<M::Sample, L>,
    /// Number of steps.
    pub(super) steps: usize,
    /// Takes the states before each step.
    pub(super) history: Option<&'a mut History<L, N, R, BLOCK>>,
}

impl<M: MeshLaw<L, R>, const L: usize, const N: usize, const R: usize, const BLOCK: usize, const STEADY: bool>
    Task for Stretch<'_, M, L, N, R, BLOCK, STEADY>
{
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(mut self, simd: I) {
        let mut state = *self.state;
        let samples = &self.forcing.samples[..self.steps];
        let external = &self.forcing.external[..self.steps];
        for (k, (sample, external)) in samples.iter().zip(external).enumerate() {
            if let Some(history) = &mut self.history {
                history.store::<STEADY>(k, &state);
            }
            let step = self.steps_before + k + 1;
            let forcing = StepForcing { sample, external };
            self.coefficients.step::<I, M, STEADY>(simd, self.law, &mut state, step, &forcing);
        }
        *self.state = state;
    }
}
