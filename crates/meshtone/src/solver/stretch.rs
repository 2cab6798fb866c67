//! The time loop over one block of samples: all that is compiled for each instruction set.

use super::history::History;
use super::instruction_set::{Instructions, Task};
use super::shared_forcing::SharedForcing;
use super::step::{Group, State};

/// Some steps of `L` simulations.
pub(super) struct Stretch<
    'a,
    const L: usize,
    const N: usize,
    const R: usize,
    const BLOCK: usize,
    const PUBLISHED: bool,
    const STEADY: bool,
> {
    pub(super) group: &'a Group<'a, L, N, R>,
    pub(super) state: &'a mut State<L, N, R>,
    /// Number of steps since the start of the integration.
    pub(super) steps_before: usize,
    /// Forcing of the samples after the state's.
    pub(super) forcing: &'a SharedForcing<L, R>,
    /// Number of steps.
    pub(super) steps: usize,
    /// Takes the states before each step.
    pub(super) history: Option<&'a mut History<L, N, R, BLOCK>>,
}

impl<
    const L: usize,
    const N: usize,
    const R: usize,
    const BLOCK: usize,
    const PUBLISHED: bool,
    const STEADY: bool,
> Task for Stretch<'_, L, N, R, BLOCK, PUBLISHED, STEADY>
{
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(mut self, simd: I) {
        let mut state = *self.state;
        let forcing = self.forcing.errors.iter().zip(&self.forcing.external).take(self.steps);
        for (k, (errors, external)) in forcing.enumerate() {
            if let Some(history) = &mut self.history {
                history.store::<STEADY>(k, &state);
            }
            let step = self.steps_before + k + 1;
            self.group.step::<I, PUBLISHED, STEADY>(simd, &mut state, step, errors, external);
        }
        *self.state = state;
    }
}
