//! What Meshtone says about public sets: what `meshtone bench` is made of.

pub mod adaptation;
pub mod bearings;
pub mod checksums;
pub mod diagnosis;
pub mod gears;
pub mod preset;
pub mod score;
