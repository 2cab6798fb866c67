//! Numbers that tell what a wheel's average shows.
//!
//! *Levels* are logarithms of amplitudes: a path to the sensor adds to them, and those of a healthy recording of the same rig can
//! be taken away. *Shapes* do not depend on the amplitude.

use meshtone::signal::{envelope, kurtosis, peak, rms};
use meshtone_fourier::Complex64;

use crate::observation::{WheelLines, revolution};

/// (-) Least amplitude, as a part of the largest, whose logarithm is taken.
const FLOOR: f64 = 1e-6;
/// Mesh harmonics whose levels are looked at.
const HARMONICS: usize = 8;
/// Mesh orders beyond which the local waveform is not looked at.
const LOCAL_ORDERS: usize = 4;
/// Values of the local waveform.
const LOCAL_POINTS: usize = 24;
/// (teeth) From where to where the local waveform goes, from the burst on.
const LOCAL_TEETH: [f64; 2] = [-2.0, 4.0];
/// (teeth) Middles of the windows around the burst whose shares of the energy are looked at.
const WINDOWS: [f64; 9] = [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 6.0];
/// Limits of the bands of the local spectrum, in mesh orders.
const LOCAL_BANDS: [f64; 7] = [0.0, 1.5, 2.5, 4.5, 7.5, 11.5, 16.5];
/// Mesh orders that divide the difference signal into parts whose shape is looked at.
const PARTS: [f64; 4] = [0.0, 3.5, 7.5, 16.5];

/// Features of a wheel's average.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WheelFeatures {
    /// (log10 g) Levels.
    pub levels: Vec<f64>,
    /// (-) Shapes.
    pub shapes: Vec<f64>,
    /// (rev) Where the burst is.
    pub burst_rev: f64,
}

/// Features of the lines of an average.
///
/// # Arguments
/// * `view` - the lines
/// * `last` - the last order that is whole in everything that is compared
/// * `has_regular_part` - whether the mesh harmonics are in it
pub(crate) fn wheel_features(view: &WheelLines, last: usize, has_regular_part: bool) -> WheelFeatures {
    let teeth = view.teeth as usize;
    let last = last.min(view.last());
    let difference: Vec<Complex64> = view.difference().into_iter().take(last + 1).collect();
    let points = (2 * last + 1).next_power_of_two().max(64);
    let mut levels = Vec::new();
    let mut shapes = Vec::new();

    // Levels over mesh orders: each band from half a mesh order below to half above.
    let band = |lines: &[Complex64], from: f64, to: f64| {
        let order = |mesh: f64| ((mesh * teeth as f64) as usize).min(lines.len());
        let energy: f64 = lines[order(from)..order(to)].iter().map(|line| 2.0 * line.norm_sqr()).sum();
        energy.sqrt()
    };
    let bands = last / teeth.max(1);
    let whole = revolution(&difference, points);
    let scale = rms(&whole).max(f64::MIN_POSITIVE);
    let level = |value: f64| value.max(FLOOR * scale).log10();
    levels.push(level(scale));
    levels.extend((0..bands).map(|mesh| level(band(&difference, mesh as f64 + 0.5, mesh as f64 + 1.5))));
    if has_regular_part {
        let tone =
            |order: usize| view.lines.get(order).filter(|_| order <= last).map_or(0.0, |line| line.norm());
        let harmonics = bands.min(HARMONICS);
        levels.extend((1..=harmonics).map(|mesh| level(tone(mesh * teeth))));
        let beside = |mesh: usize| {
            let below = |less: usize| (mesh * teeth).saturating_sub(less);
            let orders = [below(2), below(1), mesh * teeth + 1, mesh * teeth + 2];
            orders.iter().map(|&order| tone(order).powi(2)).sum::<f64>().sqrt()
        };
        levels.extend((1..=harmonics).map(|mesh| level(beside(mesh))));
        let low: f64 = (1..=7).map(|order| tone(order).powi(2)).sum();
        levels.push(level(low.sqrt()));
    }

    let of_finite = |value: f64| if value.is_finite() { value } else { 0.0 };
    let shape = |values: &[f64]| {
        let crest = peak(values) / rms(values).max(f64::MIN_POSITIVE);
        [kurtosis(values).unwrap_or(1.0).max(1.0).ln(), crest.max(1.0).ln()].map(of_finite)
    };
    shapes.extend(shape(&whole));
    for part in PARTS.windows(2) {
        let inside = |(order, &line): (usize, &Complex64)| {
            let mesh = order as f64 / teeth as f64;
            if mesh >= part[0] && mesh < part[1] { line } else { Complex64::default() }
        };
        let lines: Vec<Complex64> = difference.iter().enumerate().map(inside).collect();
        shapes.extend(shape(&revolution(&lines, points)));
    }

    // The burst: where the envelope's energy over one tooth is largest.
    let pitch = points as f64 / teeth as f64;
    let smooth = energy_over_tooth(&whole, teeth);
    let at = largest_at(&smooth);
    let total = smooth.iter().sum::<f64>().max(f64::MIN_POSITIVE) / points as f64;
    let around = |teeth_on: f64| smooth[wrapped(at as f64 + teeth_on * pitch, points)] / total;
    shapes.extend(WINDOWS.iter().map(|&on| around(on).max(1e-4).ln()));
    let elsewhere = (0..points).filter(|&point| distance(point, at, points) > 3.0 * pitch);
    let second = elsewhere.map(|point| smooth[point]).fold(0.0, f64::max);
    shapes.push((second / smooth[at].max(f64::MIN_POSITIVE)).max(1e-4).ln());
    let half = smooth.iter().filter(|&&value| value > 0.25 * smooth[at]).count();
    shapes.push((half as f64 / points as f64).ln());
    let mut teeths: Vec<f64> =
        (0..teeth).map(|tooth| smooth[wrapped(tooth as f64 * pitch, points)] / total).collect();
    teeths.sort_by(f64::total_cmp);
    shapes.extend([0.1, 0.5, 0.9].map(|part| teeths[(part * (teeth - 1) as f64) as usize].max(1e-4).ln()));

    // The spectrum around the burst.
    let window = |point: usize| {
        let from = wrapped_difference(point, at, points) / pitch;
        if from.abs() < 3.0 { 0.5 + 0.5 * (std::f64::consts::PI * from / 3.0).cos() } else { 0.0 }
    };
    let cut: Vec<f64> = whole.iter().enumerate().map(|(point, value)| value * window(point)).collect();
    let local = WheelLines::of_values(&cut, view.teeth, last);
    let energy = band(&local.lines, 0.0, 16.5).max(f64::MIN_POSITIVE);
    shapes.extend(
        LOCAL_BANDS
            .windows(2)
            .map(|limits| (band(&local.lines, limits[0], limits[1]) / energy).max(1e-3).ln()),
    );

    // The waveform around the burst, its fine structure left out.
    let low: Vec<Complex64> = difference.iter().take(LOCAL_ORDERS * teeth + teeth / 2).copied().collect();
    let low = revolution(&low, points);
    let step = (LOCAL_TEETH[1] - LOCAL_TEETH[0]) / (LOCAL_POINTS - 1) as f64;
    let wave: Vec<f64> = (0..LOCAL_POINTS)
        .map(|index| low[wrapped(at as f64 + (LOCAL_TEETH[0] + index as f64 * step) * pitch, points)])
        .collect();
    let largest = wave.iter().fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs()));
    shapes.extend(wave.iter().map(|value| value / largest));
    WheelFeatures { levels, shapes, burst_rev: at as f64 / points as f64 }
}

/// (rev) Where the burst of a difference signal is: where its envelope's energy over one tooth is largest.
///
/// # Arguments
/// * `view` - the lines
/// * `last` - the last order that is looked at
pub(crate) fn burst_rev(view: &WheelLines, last: usize) -> f64 {
    let last = last.min(view.last());
    let difference: Vec<Complex64> = view.difference().into_iter().take(last + 1).collect();
    let points = (2 * last + 1).next_power_of_two().max(64);
    let smooth = energy_over_tooth(&revolution(&difference, points), view.teeth as usize);
    largest_at(&smooth) as f64 / points as f64
}

/// Index at which a sequence is largest.
fn largest_at(values: &[f64]) -> usize {
    (0..values.len()).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(0)
}

/// The squared envelope, the mean over one tooth around each point.
fn energy_over_tooth(values: &[f64], teeth: usize) -> Vec<f64> {
    let of = envelope(values).unwrap_or_else(|_| values.to_vec());
    let square: Vec<f64> = of.iter().map(|value| value * value).collect();
    moving_mean(&square, values.len() / teeth.max(1))
}

/// Mean over some values around each, of a periodic sequence.
fn moving_mean(values: &[f64], width: usize) -> Vec<f64> {
    let (count, width) = (values.len(), width.clamp(1, values.len()));
    let mut sum: f64 = (0..width).map(|index| values[(count - width / 2 + index) % count]).sum();
    let mut means = Vec::with_capacity(count);
    for index in 0..count {
        means.push(sum.max(0.0) / width as f64);
        sum += values[(index + width - width / 2) % count] - values[(index + count - width / 2) % count];
    }
    means
}

fn wrapped(place: f64, points: usize) -> usize {
    (place.round().rem_euclid(points as f64)) as usize % points
}

fn wrapped_difference(a: usize, b: usize, points: usize) -> f64 {
    let half = points as f64 / 2.0;
    (a as f64 - b as f64 + half).rem_euclid(points as f64) - half
}

fn distance(a: usize, b: usize, points: usize) -> f64 {
    wrapped_difference(a, b, points).abs()
}
