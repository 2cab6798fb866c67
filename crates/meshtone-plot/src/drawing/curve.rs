//! Long curves made short without changing the picture.

use super::canvas::Pixel;

/// (px) Width of the columns that [`per_column`] keeps the extremes of.
const COLUMN: f64 = 0.5;
/// (px) How far a simplified curve may be from the original.
const TOLERANCE: f64 = 0.12;

/// Of every half pixel along x, the first, lowest, highest and last point; x does not fall.
pub(crate) fn per_column(points: impl Iterator<Item = Pixel>) -> Vec<Pixel> {
    let (mut kept, mut column) = (Vec::new(), Vec::new());
    let mut right = f64::NEG_INFINITY;
    for point in points {
        if point.0 >= right {
            keep_extremes(&column, &mut kept);
            column.clear();
            right = ((point.0 / COLUMN).floor() + 1.0) * COLUMN;
        }
        column.push(point);
    }
    keep_extremes(&column, &mut kept);
    kept
}

/// Keeps the first, lowest, highest and last point of a column, each once and in their order.
fn keep_extremes(column: &[Pixel], kept: &mut Vec<Pixel>) {
    let Some(last) = column.len().checked_sub(1) else { return };
    let low = (1..=last).fold(0, |low, k| if column[k].1 < column[low].1 { k } else { low });
    let high = (1..=last).fold(0, |high, k| if column[k].1 > column[high].1 { k } else { high });
    let mut place = None;
    for next in [0, low.min(high), low.max(high), last] {
        if place != Some(next) {
            kept.push(column[next]);
        }
        place = Some(next);
    }
}

/// Leaves out points within [`TOLERANCE`] of the line between their neighbours.
///
/// Source: D. Douglas, T. Peucker, "Algorithms for the reduction of the number of points required to represent a
/// digitized line", Cartographica 10 (1973).
pub(crate) fn simplify(points: &[Pixel]) -> Vec<Pixel> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut keep = vec![false; points.len()];
    keep[0] = true;
    keep[points.len() - 1] = true;
    let mut ranges = vec![(0, points.len() - 1)];
    while let Some((first, last)) = ranges.pop() {
        let squared_distance = squared_distance_from(points[first], points[last]);
        let (mut farthest, mut largest) = (None, TOLERANCE * TOLERANCE);
        for (k, &point) in points.iter().enumerate().take(last).skip(first + 1) {
            let squared = squared_distance(point);
            if squared > largest {
                (farthest, largest) = (Some(k), squared);
            }
        }
        if let Some(k) = farthest {
            keep[k] = true;
            ranges.extend([(first, k), (k, last)]);
        }
    }
    points.iter().zip(keep).filter(|(_, keep)| *keep).map(|(point, _)| *point).collect()
}

/// Squared distance of a point from a piece of a straight line.
fn squared_distance_from(start: Pixel, end: Pixel) -> impl Fn(Pixel) -> f64 {
    let (dx, dy) = (end.0 - start.0, end.1 - start.1);
    let square = dx * dx + dy * dy;
    let inverse_square = if square > 0.0 { 1.0 / square } else { 0.0 };
    move |point| {
        let (px, py) = (point.0 - start.0, point.1 - start.1);
        let t = ((px * dx + py * dy) * inverse_square).clamp(0.0, 1.0);
        (px - t * dx).powi(2) + (py - t * dy).powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_of_a_long_signal_survive() {
        let signal = (0..1_000_000).map(|k| {
            let y = if k == 345_678 { 99.0 } else { f64::from(k % 7) };
            (f64::from(k) * 1e-4, y)
        });
        let kept = per_column(signal);
        assert!(kept.len() <= 4 * 200 + 4, "{}", kept.len());
        assert!(kept.iter().any(|point| point.1 == 99.0));
        assert!(kept.is_sorted_by_key(|point| point.0));
    }

    #[test]
    fn a_straight_line_is_two_points() {
        let line: Vec<Pixel> = (0..500).map(|k| (f64::from(k), 2.0 * f64::from(k))).collect();
        assert_eq!(simplify(&line), [line[0], line[499]]);
        assert_eq!(simplify(&line[..1]), line[..1]);
    }

    #[test]
    fn corners_are_kept() {
        let corner: Vec<Pixel> = (0..=100).map(|k| (f64::from(k), f64::from((k - 50i32).abs()))).collect();
        assert_eq!(simplify(&corner), [(0.0, 50.0), (50.0, 0.0), (100.0, 50.0)]);
    }
}
