//! The library, used as its users use it. One test program, because each is linked with all libraries.

mod bearings;
mod drawn;
mod exact;
mod gearbox;
#[cfg(feature = "objects")]
mod objects;
mod places;
mod python;
mod records;
mod refused;
mod support;
mod verified;
