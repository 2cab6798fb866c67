//! From recordings to what may be wrong: what `meshtone diagnose` is made of.

pub mod figure;
pub mod healthy;
pub mod observe;
pub mod reference;
pub mod refuse;
pub mod table;
