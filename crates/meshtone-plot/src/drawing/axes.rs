//! A pair of axes and what is drawn in them.

use super::canvas::{Canvas, Pixel};
use super::curve;
use super::legend::{self, Entry};
use super::style::{Anchor, Fill, Stroke, TextStyle, colour};
use super::ticks::Ticks;

/// A rectangle of the figure, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Area {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Area {
    pub(crate) const fn new(left: f64, top: f64, width: f64, height: f64) -> Self {
        Self { left, top, width, height }
    }

    pub(crate) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    pub(crate) fn middle(&self) -> Pixel {
        (self.left + self.width / 2.0, self.top + self.height / 2.0)
    }

    /// Equal parts with `gap` between columns and between rows, row by row.
    ///
    /// # Arguments
    /// * `columns`, `rows` - how many
    /// * `gap` - (px) between columns, and between rows
    /// * `tallest` - (px) the greatest height of a part
    pub(crate) fn grid(
        self,
        [columns, rows]: [usize; 2],
        gap: [f64; 2],
        tallest: f64,
    ) -> impl Iterator<Item = Self> {
        let part = |size: f64, gap: f64, count: usize| (size + gap) / count.max(1) as f64 - gap;
        let width = part(self.width, gap[0], columns);
        let height = part(self.height, gap[1], rows).min(tallest);
        (0..columns * rows).map(move |place| {
            let (row, column) = ((place / columns) as f64, (place % columns) as f64);
            let (left, top) = (self.left + column * (width + gap[0]), self.top + row * (height + gap[1]));
            Self::new(left, top, width, height)
        })
    }
}

/// A pair of axes with linear scales; a logarithmic one is a linear scale of decadic logarithms.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axes {
    pub(crate) area: Area,
    pub(crate) x: [f64; 2],
    pub(crate) y: [f64; 2],
}

const FRAME: Stroke = Stroke::solid(colour::FRAME, 1.0);
const GRID: Stroke = Stroke::solid(colour::GRID, 1.0);
const TICK_LENGTH: f64 = 4.0;
/// (px) From the frame to the baseline of the numbers below it, and of the axis' name.
pub(crate) const NUMBERS_BELOW: f64 = 17.0;
/// (px) Between two numbers below the frame.
const NUMBERS_APART: f64 = 4.0;
pub(crate) const NAME_BELOW: f64 = 36.0;
/// (px) From the frame to the end of the numbers on its left.
const NUMBERS_LEFT: f64 = 8.0;
/// (px) From the numbers to the baseline of the axis' name on their left.
const NAME_GAP: f64 = 6.0;
/// (px) From the frame to the baseline of the vertical axis' name, in most figures.
pub(crate) const NAME_LEFT: f64 = 56.0;
/// (px) From the frame up to the baseline of the title.
pub(crate) const TITLE_ABOVE: f64 = 8.0;

/// Returns whether a number can be drawn at all.
pub(crate) fn drawable(value: f64) -> bool {
    value.abs() < 1e30
}

/// Below this a value is rounding, in every unit that is drawn.
const ROUNDING: f64 = 1e-9;

/// Range of the drawable values with a margin; ±1 round 0 where there are none.
pub(crate) fn range(values: impl Iterator<Item = f64>, margin: f64) -> [f64; 2] {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    values.filter(|&value| drawable(value)).for_each(|value| {
        low = if value < low { value } else { low };
        high = if value > high { value } else { high };
    });
    if low > high {
        return [-1.0, 1.0];
    }
    let [low, high] = [low, high].map(|end| if end.abs() < ROUNDING { 0.0 } else { end });
    let size = low.abs().max(high.abs());
    // A constant signal: from 0 to twice its size.
    let least = if size > 0.0 { size } else { 1.0 };
    let extra = if high - low > 1e-9 * size { margin * (high - low) } else { least };
    [low - extra, high + extra]
}

/// A range of time, or 0 to 1 where it is empty or cannot be drawn.
pub(crate) fn time_range([start_s, end_s]: [f64; 2]) -> [f64; 2] {
    if end_s > start_s && drawable(start_s) && drawable(end_s) { [start_s, end_s] } else { [0.0, 1.0] }
}

/// Values that divide a range into as many equal parts, each at the start of its part.
pub(crate) fn over([from, to]: [f64; 2], values: &[f64]) -> impl DoubleEndedIterator<Item = (f64, f64)> {
    let part = (to - from) / values.len().max(1) as f64;
    values.iter().enumerate().map(move |(k, &value)| (from + k as f64 * part, value))
}

/// The largest size of the drawable values; 0 where there are none.
pub(crate) fn largest<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values.into_iter().map(|value| value.abs()).filter(|&size| drawable(size)).fold(0.0, f64::max)
}

impl Axes {
    pub(crate) fn new(area: Area, x: [f64; 2], y: [f64; 2]) -> Self {
        Self { area, x, y }
    }

    /// Axes whose title is drawn.
    pub(crate) fn titled(canvas: &mut Canvas, area: Area, x: [f64; 2], y: [f64; 2], title: &str) -> Self {
        let axes = Self::new(area, x, y);
        axes.title(canvas, title);
        axes
    }

    pub(crate) fn title(&self, canvas: &mut Canvas, text: &str) {
        canvas.text((self.area.left, self.area.top - TITLE_ABOVE), text, TextStyle::AXES_TITLE);
    }

    pub(crate) fn px(&self, x: f64) -> f64 {
        self.area.left + (x - self.x[0]) / (self.x[1] - self.x[0]) * self.area.width
    }

    pub(crate) fn py(&self, y: f64) -> f64 {
        self.area.bottom() - (y - self.y[0]) / (self.y[1] - self.y[0]) * self.area.height
    }

    pub(crate) fn at(&self, x: f64, y: f64) -> Pixel {
        (self.px(x), self.py(y))
    }

    /// The frame, to be drawn over everything else.
    pub(crate) fn frame(&self, canvas: &mut Canvas) {
        let Area { left, top, .. } = self.area;
        let (right, bottom) = (self.area.right(), self.area.bottom());
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
        canvas.polyline(&corners, FRAME);
    }

    /// A legend in the title's line, at the right end of the axes.
    pub(crate) fn legend(&self, canvas: &mut Canvas, entries: &[Entry]) {
        legend::row(canvas, (self.area.right(), self.area.top - TITLE_ABOVE), entries);
    }

    /// Grid lines, ticks and numbers of the horizontal axis, and its name.
    pub(crate) fn x_axis(&self, canvas: &mut Canvas, ticks: &Ticks, name: &str) {
        self.x_grid(canvas, ticks);
        self.x_numbers(canvas, ticks);
        self.x_name(canvas, name);
    }

    /// Name of the horizontal axis.
    pub(crate) fn x_name(&self, canvas: &mut Canvas, name: &str) {
        canvas.text((self.area.middle().0, self.area.bottom() + NAME_BELOW), name, TextStyle::AXIS);
    }

    /// Grid lines and ticks of the horizontal axis.
    pub(crate) fn x_grid(&self, canvas: &mut Canvas, ticks: &Ticks) {
        let bottom = self.area.bottom();
        for &value in &ticks.values {
            let x = self.px(value);
            self.vertical(canvas, value, GRID);
            canvas.line((x, bottom), (x, bottom + TICK_LENGTH), FRAME);
        }
    }

    /// Numbers below the horizontal axis, but for those that would touch the one before.
    pub(crate) fn x_numbers(&self, canvas: &mut Canvas, ticks: &Ticks) {
        let mut free_from = f64::NEG_INFINITY;
        for &value in &ticks.values {
            let (x, text) = (self.px(value), ticks.text(value));
            let half_width = TextStyle::TICK.width(&text) / 2.0;
            if x - half_width < free_from {
                continue;
            }
            canvas.text((x, self.area.bottom() + NUMBERS_BELOW), &text, TextStyle::TICK);
            free_from = x + half_width + NUMBERS_APART;
        }
    }

    /// Grid lines and ticks of the vertical axis.
    pub(crate) fn y_grid(&self, canvas: &mut Canvas, ticks: &Ticks) {
        let (left, right) = (self.area.left, self.area.right());
        for &value in &ticks.values {
            let y = self.py(value);
            canvas.line((left, y), (right, y), GRID);
            canvas.line((left - TICK_LENGTH, y), (left, y), FRAME);
        }
    }

    /// Draws what [`Self::y_grid`] draws, with numbers and the axis' name, whose baseline is `name_left` of the frame, or farther
    /// where the numbers are wide.
    pub(crate) fn y_axis(&self, canvas: &mut Canvas, ticks: &Ticks, name: &str, name_left: f64) {
        self.y_grid(canvas, ticks);
        let left = self.area.left;
        for &value in &ticks.values {
            let style = TextStyle::TICK.anchored(Anchor::End);
            canvas.text((left - NUMBERS_LEFT, self.py(value) + 0.36 * style.size), &ticks.text(value), style);
        }
        let widest =
            ticks.values.iter().map(|&value| TextStyle::TICK.width(&ticks.text(value))).fold(0.0, f64::max);
        let name_left = name_left.max(NUMBERS_LEFT + widest + NAME_GAP);
        // Beside the widest numbers the gap gives way before the figure's edge does.
        let baseline = (left - name_left).max(TextStyle::AXIS.size);
        canvas.text((baseline, self.area.middle().1), name, TextStyle::AXIS.upwards());
    }

    /// Pixels of a curve whose x does not fall.
    pub(crate) fn along_x(&self, points: impl Iterator<Item = (f64, f64)>) -> Vec<Pixel> {
        let drawable = points.filter(|&(x, y)| drawable(x) && drawable(y));
        curve::simplify(&curve::per_column(drawable.map(|(x, y)| self.at(x, y))))
    }

    /// Pixels of a curve whose y does not fall.
    pub(crate) fn along_y(&self, points: impl Iterator<Item = (f64, f64)>) -> Vec<Pixel> {
        let drawable = points.filter(|&(x, y)| drawable(x) && drawable(y));
        // Upwards is falling pixels; the columns only ask for one direction.
        let turned = drawable.map(|(x, y)| (-self.py(y), self.px(x)));
        let turned = curve::simplify(&curve::per_column(turned));
        turned.into_iter().map(|(y, x)| (x, -y)).collect()
    }

    /// A curve whose x does not fall.
    pub(crate) fn line(&self, canvas: &mut Canvas, points: impl Iterator<Item = (f64, f64)>, stroke: Stroke) {
        canvas.polyline(&self.along_x(points), stroke);
    }

    pub(crate) fn horizontal(&self, canvas: &mut Canvas, y: f64, stroke: Stroke) {
        canvas.line((self.area.left, self.py(y)), (self.area.right(), self.py(y)), stroke);
    }

    pub(crate) fn vertical(&self, canvas: &mut Canvas, x: f64, stroke: Stroke) {
        canvas.line((self.px(x), self.area.top), (self.px(x), self.area.bottom()), stroke);
    }

    /// A filled part of the horizontal axis, cut at the frame.
    pub(crate) fn band(&self, canvas: &mut Canvas, from: f64, to: f64, fill: Fill) {
        let (from, to) = (from.max(self.x[0]), to.min(self.x[1]));
        if from < to {
            canvas.rectangle((self.px(from), self.area.top), (self.px(to), self.area.bottom()), fill);
        }
    }

    /// Words in the middle, instead of a curve; no line runs through them.
    pub(crate) fn note(&self, canvas: &mut Canvas, text: &str) {
        let (x, y) = self.area.middle();
        let style = TextStyle::NOTE.coloured(colour::MUTED).anchored(Anchor::Middle);
        let half = style.width(text) / 2.0 + 3.0;
        let [from, to] = [(x - half, y - style.size), (x + half, y + 0.4 * style.size)];
        canvas.rectangle(from, to, Fill::solid(colour::WHITE));
        canvas.text((x, y), text, style);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_of_awkward_values() {
        assert_eq!(range([].into_iter(), 0.1), [-1.0, 1.0]);
        assert_eq!(range([f64::NAN, f64::INFINITY].into_iter(), 0.1), [-1.0, 1.0]);
        assert_eq!(range([0.0, 0.0].into_iter(), 0.1), [-1.0, 1.0]);
        assert_eq!(range([5.0].into_iter(), 0.1), [0.0, 10.0]);
        assert_eq!(range([0.0, 10.0].into_iter(), 0.1), [-1.0, 11.0]);
    }

    #[test]
    fn pixels_run_downwards() {
        let axes = Axes::new(Area::new(10.0, 20.0, 100.0, 50.0), [0.0, 1.0], [-1.0, 1.0]);
        assert_eq!(axes.at(0.0, -1.0), (10.0, 70.0));
        assert_eq!(axes.at(1.0, 1.0), (110.0, 20.0));
        let upwards = axes.along_y([(0.0, -1.0), (1.0, 1.0)].into_iter());
        assert_eq!(upwards, [(10.0, 70.0), (110.0, 20.0)]);
    }
}
