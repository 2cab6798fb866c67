//! The program, run as its users run it. One test program, because each is linked with all libraries.
#![allow(clippy::unwrap_used)]

mod adapt;
mod bad_input;
mod bearings;
mod bench;
mod dataset;
mod diagnose;
mod examples;
#[cfg(feature = "explore")]
mod explore;
mod gearbox;
mod guide;
mod indicators;
mod indicators_refused;
mod init;
mod killed;
mod path;
#[path = "../../../meshtone/tests/all/plain.rs"]
mod plain;
mod sensors;
mod simulate;
mod support;
mod tune;
mod unwritable;
mod wheels_and_panel;
