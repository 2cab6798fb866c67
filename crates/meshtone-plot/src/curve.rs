//! Long curves made short without changing the picture.

use crate::canvas::Pixel;

/// (px) Width of the columns that [`per_column`] keeps the extremes of.
const COLUMN: f64 = 0.5;
/// (px) How far a simplified curve may be from the original.
const TOLERANCE: f64 = 0.12;

/// Of every half pixel along x, the first, lowest, highest and last point; x does not fall.
pub(crate) fn per_column(points: impl Iterator<Item = Pixel>) -> Vec<Pixel> {
    let mut kept = Vec::new();
    let mut column: Option<Column> = None;
    for point in points {
        match &mut column {
            Some(column) if point.0 < column.right => column.add(point),
            _ => {
                if let Some(column) = column.take() {
                    column.flush(&mut kept);
                }
                column = Some(Column {
                    right: ((point.0 / COLUMN).floor() + 1.0) * COLUMN,
                    first: point,
                    low: (point, 0),
                    high: (point, 0),
                    last: point,
                    count: 1,
                });
            }
        }
    }
    if let Some(column) = column {
        column.flush(&mut kept);
    }
    kept
}

/// Points in one column; extremes with their place in the order.
struct Column {
    right: f64,
    first: Pixel,
    low: (Pixel, usize),
    high: (Pixel, usize),
    last: Pixel,
    count: usize,
}

impl Column {
    fn add(&mut self, point: Pixel) {
        if point.1 < self.low.0.1 {
            self.low = (point, self.count);
        }
        if point.1 > self.high.0.1 {
            self.high = (point, self.count);
        }
        self.last = point;
        self.count += 1;
    }

    fn flush(self, kept: &mut Vec<Pixel>) {
        let (a, b) = if self.low.1 < self.high.1 { (self.low, self.high) } else { (self.high, self.low) };
        kept.push(self.first);
        let last = self.count - 1;
        kept.extend(
            [a, b].into_iter().filter(|(_, place)| (1..last).contains(place)).map(|(point, _)| point),
        );
        if last > 0 {
            kept.push(self.last);
        }
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
        let line = Line::new(points[first], points[last]);
        let (mut farthest, mut largest) = (None, TOLERANCE * TOLERANCE);
        for (k, &point) in points.iter().enumerate().take(last).skip(first + 1) {
            let squared = line.squared_distance(point);
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

/// A piece of a straight line.
struct Line {
    start: Pixel,
    /// To its end.
    along: Pixel,
    /// One over its length squared, or 0 where it has none.
    inverse_square: f64,
}

impl Line {
    fn new(start: Pixel, end: Pixel) -> Self {
        let along = (end.0 - start.0, end.1 - start.1);
        let square = along.0 * along.0 + along.1 * along.1;
        Self { start, along, inverse_square: if square > 0.0 { 1.0 / square } else { 0.0 } }
    }

    fn squared_distance(&self, point: Pixel) -> f64 {
        let (dx, dy) = self.along;
        let (px, py) = (point.0 - self.start.0, point.1 - self.start.1);
        let t = ((px * dx + py * dy) * self.inverse_square).clamp(0.0, 1.0);
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
