//! Rolling bearings: their geometry, the contacts of their elements, their spalls, and their load on the shaft.

mod contact;
mod defect;
mod geometry;
mod named;
mod rolling;
mod turning;

pub use contact::{ElementContact, RollingElement};
pub use defect::{BearingDefect, DefectPlace, Spall};
pub use geometry::{BearingError, BearingGeometry, DefectOrders};
pub use named::{NAMED_BEARINGS, NamedBearing};
pub(crate) use rolling::{BearingLoad, ElementDrop, ElementPlaces};
pub use rolling::{RollingBearing, RollingParts};
pub(crate) use turning::{BearingBlock, BearingTurning};
