//! NA4.

use crate::signal::SignalError;
use crate::signal::central_moment;
use crate::signal::check::{check_count, check_finite};

/// NA4 of a series of records: the residual's fourth moment over the square of its variance's mean so far,
/// `NA4_j = µ₄(r_j)/((µ₂(r_1) + … + µ₂(r_j))/j)²`.
///
/// Unlike FM4 it goes on rising as a fault spreads, since the variance of the sound beginning stays in the mean. So the order
/// of the records matters.
///
/// # Arguments
/// * `residuals` - residual of each record, in the order of time
///
/// None for a record as long as all residuals are constant.
///
/// # Errors
/// No records; an empty one; NaN.
///
/// Source: J. J. Zakrajsek, D. P. Townsend, H. J. Decker, "An analysis of gear fault detection methods as applied to pitting
/// fatigue failure data", NASA TM-105950 (1993), with the average over the records so far.
///
/// ```
/// let (sound, faulty) = ([1.0, -1.0, 1.0, -1.0], [1.0, -1.0, 3.0, -3.0]);
/// let na4 = meshtone::signal::na4(&[&sound, &faulty])?;
/// assert_eq!(na4, [Some(1.0), Some(41.0 / 9.0)]);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn na4<R: AsRef<[f64]>>(residuals: &[R]) -> Result<Vec<Option<f64>>, SignalError> {
    check_count("records", residuals.len(), 1)?;
    let mut sum = 0.0;
    let mut value = |(record, residual): (usize, &R)| {
        let residual = residual.as_ref();
        check_count("values of a residual", residual.len(), 1)?;
        check_finite(residual)?;
        sum += central_moment(residual, 2);
        let mean: f64 = sum / (record + 1) as f64;
        // Of what is below all units the square is no number.
        Ok((mean * mean).is_normal().then(|| central_moment(residual, 4) / (mean * mean)))
    };
    residuals.iter().enumerate().map(&mut value).collect()
}
