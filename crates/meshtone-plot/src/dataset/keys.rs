//! Distributions of the varied keys.

use super::{DatasetPreview, TRAIN, as_strips, split_colour, split_stroke};
use crate::drawing::{Area, Axes, Canvas, Fill, Pixel, TextStyle, Ticks, colour};

const COLUMNS: usize = 2;
const ROWS: usize = 6;
const BINS: usize = 16;
/// (px) Between two plots below each other: the numbers of the upper and the title of the lower one.
const GAP: [f64; 2] = [34.0, 52.0];
const TALLEST: f64 = 150.0;
/// Positive values that span more than this ratio are drawn by their logarithms, if their median is below this part of the sum of
/// the least and the largest.
const LOGARITHMIC: f64 = 15.0;
const SKEWED: f64 = 0.3;
/// (px) Between the strips of two splits.
const STRIP_GAP: f64 = 2.0;
/// Of the fullest bin.
const DARKEST: f64 = 0.95;
/// Fewer different values than this have a bar each.
const FEW: usize = 12;

pub(super) fn draw(canvas: &mut Canvas, area: Area, preview: &DatasetPreview) {
    let shown = preview.keys.len().min(COLUMNS * ROWS);
    let plots = area.grid([COLUMNS, shown.div_ceil(COLUMNS)], GAP, TALLEST);
    for (key, plot) in preview.keys.iter().zip(plots) {
        histogram(canvas, plot, &key.name, &key.values, preview);
    }
    if preview.keys.len() > shown {
        let rest = format!("and {} more keys", preview.keys.len() - shown);
        canvas.text((area.left, area.bottom() + 40.0), &rest, TextStyle::NOTE.coloured(colour::MUTED));
    }
}

/// Draws the distribution of a key's values in each split.
///
/// Values that spread over decades, most of them small, are shown by their logarithms. Where there are few different values, each has a bin
/// of its own; otherwise bins of equal width divide the range. All splits have the same bins and the same scale, so that they can be
/// compared.
fn histogram(canvas: &mut Canvas, area: Area, name: &str, values: &[f64], preview: &DatasetPreview) {
    let sorted = finite_and_sorted(values);
    let (Some(&low), Some(&high)) = (sorted.first(), sorted.last()) else { return };
    let median = sorted[sorted.len() / 2];
    let logarithmic = low > 0.0 && high > LOGARITHMIC * low && median < SKEWED * (low + high);
    let values: Vec<f64> =
        values.iter().map(|value| if logarithmic { value.log10() } else { *value }).collect();
    let mut distinct = finite_and_sorted(&values);
    distinct.dedup();
    let (least, largest) = (distinct[0], distinct[distinct.len() - 1]);
    let are_few = distinct.len() <= FEW;
    let (range, bins) = if are_few {
        // So narrow that neighbours have bins of their own.
        let step = distinct.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let margin = if step.is_finite() { 0.5 * step } else { 0.5 };
        let range = [least - margin, largest + margin];
        let bins = ((range[1] - range[0]) / (2.0 * (least - range[0])).max(1e-300)).round() as usize;
        (range, bins.clamp(1, 60))
    } else {
        ([least, largest], BINS)
    };
    let shares: Vec<Vec<f64>> = (0..preview.splits.len())
        .map(|split| shares(&values, &preview.split_of, split, range, bins))
        .collect();
    let highest = shares.iter().flatten().copied().fold(0.0f64, f64::max);
    let y = [0.0, 1.08 * if highest > 0.0 { highest } else { 1.0 }];
    let axes = Axes::titled(canvas, area, range, y, &TextStyle::AXES_TITLE.fitted(name, area.width));
    let ticks = match logarithmic {
        true => Ticks::of_logarithms(range[0], range[1]).thinned(6),
        false if are_few && distinct.iter().all(|value| value.fract() == 0.0) => {
            Ticks::whole(range[0], range[1], 5)
        }
        false => Ticks::nice(range[0], range[1], 5),
    };
    axes.x_grid(canvas, &ticks);
    axes.x_numbers(canvas, &ticks);
    let edge = |bin: usize| range[0] + (range[1] - range[0]) * bin as f64 / bins as f64;
    if as_strips(preview) {
        strips(canvas, &axes, &shares, edge);
    } else {
        outlines(canvas, &axes, &shares, edge);
    }
    axes.frame(canvas);
}

fn finite_and_sorted(values: &[f64]) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// Bars for the training, and the outline of the distribution of each other split that has records with the key.
fn outlines(canvas: &mut Canvas, axes: &Axes, shares: &[Vec<f64>], edge: impl Fn(usize) -> f64) {
    let has_records = |shares: &[f64]| shares.iter().any(|&share| share > 0.0);
    for (split, shares) in shares.iter().enumerate().filter(|(_, shares)| has_records(shares)) {
        if split == 0 {
            let bars: Vec<[Pixel; 2]> = shares
                .iter()
                .enumerate()
                .map(|(b, &share)| [axes.at(edge(b), share), axes.at(edge(b + 1), 0.0)])
                .collect();
            canvas.rectangles(&bars, TRAIN);
        } else {
            let mut steps = vec![axes.at(edge(0), 0.0)];
            for (b, &share) in shares.iter().enumerate() {
                steps.extend([axes.at(edge(b), share), axes.at(edge(b + 1), share)]);
            }
            steps.push(axes.at(edge(shares.len()), 0.0));
            canvas.polyline(&steps, split_stroke(split));
        }
    }
}

/// A strip for each split that has records with the key, in the order of the legend: the darker, the more of its records are in a
/// bin, over those in its fullest one. Outlines of so many splits would hide each other.
fn strips(canvas: &mut Canvas, axes: &Axes, shares: &[Vec<f64>], edge: impl Fn(usize) -> f64) {
    let Area { top, height, .. } = axes.area;
    let pitch = height / shares.len().max(1) as f64;
    for (split, shares) in shares.iter().enumerate() {
        let fullest = shares.iter().copied().fold(0.0f64, f64::max);
        let upper = top + pitch * split as f64 + STRIP_GAP / 2.0;
        for (bin, share) in shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
            let opacity = DARKEST * share / fullest;
            let corners = [(axes.px(edge(bin)), upper), (axes.px(edge(bin + 1)), upper + pitch - STRIP_GAP)];
            canvas.rectangle(corners[0], corners[1], Fill::tint(split_colour(split), opacity));
        }
    }
}

/// Part of a split's records in each bin.
fn shares(
    values: &[f64],
    split_of: &[usize],
    split: usize,
    [least, largest]: [f64; 2],
    bins: usize,
) -> Vec<f64> {
    let mut counts = vec![0.0; bins];
    let mut all = 0.0;
    for (value, _) in values.iter().zip(split_of).filter(|(value, of)| value.is_finite() && **of == split) {
        let bin = ((value - least) / (largest - least) * bins as f64).floor().max(0.0) as usize;
        counts[bin.min(bins - 1)] += 1.0;
        all += 1.0;
    }
    if all > 0.0 {
        counts.iter_mut().for_each(|count| *count /= all);
    }
    counts
}
