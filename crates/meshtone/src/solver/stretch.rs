//! The time loop over one block of samples: all that is compiled for each instruction set.

use super::history::{Columns, History};
use super::instruction_set::{InstructionSet, Instructions, Task};
use super::shared_forcing::SharedForcing;
use super::step::{Group, State};

/// The time loop of `L` simulations, whatever size and convention it is compiled for.
pub(super) trait TimeLoop<const L: usize, const BLOCK: usize> {
    /// Makes steps.
    ///
    /// # Arguments
    /// * `instructions` - what the processor may use
    /// * `steps_before` - number of steps since the start of the integration
    /// * `steps` - how many, at most `BLOCK`
    /// * `forcing` - of the samples after the state's
    /// * `history` - takes the states before each step
    fn advance(
        &mut self,
        instructions: InstructionSet,
        steps_before: usize,
        steps: usize,
        forcing: &SharedForcing<L>,
        history: Option<&mut History<L, BLOCK>>,
    );

    /// Whether lane `l` is still a motion.
    fn is_sound(&self, l: usize) -> bool;
}

/// The time loop of a size and convention.
pub(super) struct SizedLoop<
    'a,
    const L: usize,
    const N: usize,
    const R: usize,
    const PUBLISHED: bool,
    const STEADY: bool,
> {
    pub(super) group: Group<'a, L, N, R>,
    pub(super) state: State<L, N, R>,
}

impl<
    const L: usize,
    const N: usize,
    const R: usize,
    const BLOCK: usize,
    const PUBLISHED: bool,
    const STEADY: bool,
> TimeLoop<L, BLOCK> for SizedLoop<'_, L, N, R, PUBLISHED, STEADY>
{
    fn advance(
        &mut self,
        instructions: InstructionSet,
        steps_before: usize,
        steps: usize,
        forcing: &SharedForcing<L>,
        history: Option<&mut History<L, BLOCK>>,
    ) {
        let history = history.and_then(History::columns);
        let Self { group, state } = self;
        instructions.run(Stretch::<L, N, R, BLOCK, PUBLISHED, STEADY> {
            group,
            state,
            steps_before,
            steps,
            forcing,
            history,
        });
    }

    fn is_sound(&self, l: usize) -> bool {
        self.state.is_sound(l)
    }
}

/// Some steps.
struct Stretch<
    'a,
    const L: usize,
    const N: usize,
    const R: usize,
    const BLOCK: usize,
    const PUBLISHED: bool,
    const STEADY: bool,
> {
    group: &'a Group<'a, L, N, R>,
    state: &'a mut State<L, N, R>,
    steps_before: usize,
    steps: usize,
    forcing: &'a SharedForcing<L>,
    history: Option<Columns<'a, L, N, R, BLOCK>>,
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
        let forcing = self.forcing.errors().iter().zip(&self.forcing.external).take(self.steps);
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
