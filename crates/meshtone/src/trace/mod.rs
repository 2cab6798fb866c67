//! Every stage's output under one name each, for checking number by number.

mod average;
mod gearbox;
mod run;
mod stages;

pub(crate) use average::{train_record, wheel_record};
use gearbox::gearbox_stages;
pub use run::{trace, trace_at, trace_of};
use stages::static_stages;

pub use crate::trace_fields::{Trace, TraceField};

use crate::simulate::Stages;

/// The fields of a trace that belong to the stages before the time loop.
///
/// # Arguments
/// * `stages` - of a simulation
///
/// ```
/// use meshtone::scenario::{GearPair, Scenario};
///
/// let stages = meshtone::stages(&Scenario::new(GearPair::example()))?;
/// let trace = meshtone::stage_trace(&stages);
/// assert_eq!(trace.get("natural_frequencies_hz").map(|field| field.values.len()), Some(17));
/// # Ok::<(), meshtone::Error>(())
/// ```
pub fn stage_trace(stages: &Stages) -> Trace {
    let mut trace = Trace::default();
    if stages.scenario.rig().is_some() {
        static_stages(&mut trace, stages);
    } else {
        gearbox_stages(&mut trace, stages);
    }
    trace
}
