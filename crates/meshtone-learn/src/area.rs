//! How well a score separates two groups.

/// The area under the curve: in which part of all pairs of a healthy and a damaged one the damaged one has the larger score; ties count half.
///
/// # Arguments
/// * `healthy`, `damaged` - scores
///
/// Returns the area (-); none where one of the groups is empty.
pub fn area_under_curve(healthy: &[f64], damaged: &[f64]) -> Option<f64> {
    let orders =
        healthy.iter().flat_map(|sound| damaged.iter().map(move |broken| broken.total_cmp(sound) as i8));
    let sum: f64 = orders.map(|order| 0.5 + 0.5 * f64::from(order)).sum();
    let pairs = healthy.len() * damaged.len();
    (pairs > 0).then(|| sum / pairs as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_area_counts_pairs() {
        assert_eq!(area_under_curve(&[1.0, 2.0], &[2.0, 3.0]), Some(0.875));
        assert_eq!((area_under_curve(&[3.0], &[1.0, 2.0]), area_under_curve(&[], &[1.0])), (Some(0.0), None));
    }
}
