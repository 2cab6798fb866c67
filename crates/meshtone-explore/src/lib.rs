//! A page on this machine on which a scenario is changed and seen at once: `meshtone explore`, and in Python `mt.explore`.
//!
//! [`answer()`] is the whole of it: from a scenario to everything that the page draws, in named stages. Around it stand a [`Server`]
//! that only this machine's own page may ask, what the page's controls are made from, and the page itself, in `page/`, as plain
//! HTML, CSS and modules that no build step stands before.
#![deny(missing_docs)]

mod answer;
mod controls;
mod export;
mod packet;
mod presets;
mod question;
mod refusal;
mod server;

pub use answer::{AnswerOptions, Detail, State, answer};
pub use packet::Packet;
pub use presets::{Preset, presets};
pub use refusal::Refusal;
#[cfg(fuzzing)]
pub use server::read_request;
pub use server::{Embedding, Server, ServerSettings};
