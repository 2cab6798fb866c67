//! Diagnosis of a gear from its vibration, by simulations.
//!
//! A [`Prior`] says what may be: kinds of damage and their sizes, and everything that differs from rig to rig. A
//! [`ReferenceSet`] holds simulations of it, as averages over the revolutions of each wheel. An [`Observation`] is what a recording
//! shows; [`diagnose`] says what it may be, by what it learns from the reference set. A [`BearingAnswer`] needs no simulation: it is a test of
//! the recording alone.
#![deny(missing_docs)]

mod answer;
mod any_damage;
mod bearings;
mod consistency;
mod diagnose;
mod draw;
mod error;
mod json;
mod layout;
mod learn;
mod level;
mod mounting;
mod observation;
#[cfg(test)]
#[path = "../../meshtone/tests/all/plain.rs"]
mod plain;
mod prior;
mod recorded;
mod reference;
mod refine;
mod rule;
mod speed;
mod store;
#[cfg(test)]
#[path = "../tests/all/synthetic.rs"]
mod synthetic;
mod warnings;
mod words;

pub use answer::{
    Answer, AnyDamage, Explanation, HEALTHY, KindAnswer, PlaceAnswer, SEVERAL, SizeAnswer, ToothAnswer,
    p_in_words,
};
pub use bearings::BearingAnswer;
pub use diagnose::{OUTSIDE, diagnose};
pub use draw::{Drawn, DrawnFault};
pub use error::DiagnoseError;
pub use learn::Learned;
pub use meshtone_learn::{Interval, WheelLines};
pub use mounting::CommonChange;
pub use observation::{Observation, Question, SignalKind};
pub use prior::{Focus, Prior, Spread};
pub use recorded::other_tone;
pub use reference::{ReferenceRecord, ReferenceSet, build_reference};
pub use refine::{REFINED_RECORDS, Refined, refine};
pub use rule::{Rule, RuleValue};
pub use store::{ReferenceStore, StoreError};
pub use warnings::DiagnosisWarning;
pub use words::AnswerInWords;
