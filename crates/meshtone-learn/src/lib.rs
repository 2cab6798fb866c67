//! What simulations teach about a recording, in numbers alone.
//!
//! [`WheelLines`] are what an average over the revolutions of a wheel shows. [`wheel_features`] makes a row of numbers of them, and
//! [`beyond_healthy`] takes away what was there when the wheel was healthy. [`ridge`] and [`Softmax`], or [`ExtraTrees`], learn probabilities of
//! classes from rows, a [`SizeModel`] learns a size with its uncertainty, and an [`OutlierTest`] says how many simulations are as strange as a recording.
//! What the numbers mean for a gear, in words, is the business of the diagnosis, which is compiled without optimisation; this
//! crate is compiled for speed.
#![deny(missing_docs)]

mod area;
mod error;
mod extra_trees;
mod features;
mod fold;
mod healthy;
mod lines;
mod matrix;
mod outlier_test;
mod quantile;
mod size;
mod softmax;

pub use area::area_under_curve;
pub use error::LearnError;
pub use extra_trees::ExtraTrees;
pub use features::{WheelFeatures, wheel_features};
pub use fold::{FOLDS, fold_of};
pub use healthy::beyond_healthy;
pub use lines::{MESH_ORDERS, PASSED, WheelLines, revolution, separation, separations};
pub use matrix::{RandomFeatures, Ridge, ridge};
pub use outlier_test::{OutlierTest, Ranking};
pub use quantile::{Interval, interval, mean, median, quantiles};
pub use size::SizeModel;
pub use softmax::Softmax;
