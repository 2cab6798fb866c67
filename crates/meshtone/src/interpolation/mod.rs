//! Interpolation of sampled curves.

mod cubic_spline;
mod linear;
mod natural_spline;
mod pchip;
mod pchip_through;

pub use cubic_spline::NotAKnotSpline;
pub use linear::UniformLinear;
pub(crate) use linear::straight_between;
pub use natural_spline::NaturalSpline;
pub use pchip::Pchip;
pub use pchip_through::PchipThrough;

/// Interval of a uniform grid that holds `x`, and the position within it.
///
/// Outside the grid the nearest interval is used, so that the curve's end piece extrapolates.
#[inline]
pub(crate) fn locate(x: f64, start: f64, step: f64, points: usize) -> (usize, f64) {
    let position = (x - start) / step;
    let interval = (position.max(0.0) as usize).min(points - 2);
    (interval, position - interval as f64)
}
