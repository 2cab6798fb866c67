//! A test whether the speed changes over a recording by so much that no phase can be followed.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use meshtone_fourier::real_spectrum;

use crate::signal::{AngularSignal, upper_median};

/// Numbers of windows that the recording is cut into: the more, the faster the change that is followed, and the fewer, the
/// weaker the lines that are seen.
const WINDOWS: [usize; 3] = [16, 40, 100];
/// (rev of the stated speed) Shortest window.
const SHORTEST: f64 = 0.6;
/// (rev of the stated speed) Longest window, so that a long recording takes no longer.
const LONGEST: f64 = 8.0;
/// Most teeth for which speeds are distinguished in reasonable time.
const MOST_TEETH: u32 = 1000;
/// Lines of a comb, of which the first is the mesh or another one.
const HARMONICS: u32 = 4;
/// Largest ratio of a speed to the stated one, and of the stated one to it.
const LARGEST_RATIO: f64 = 5.0;
/// Largest change of the logarithm of the speed from one window to the next.
const LARGEST_CHANGE: f64 = 0.09;
/// Bins on each side of a line whose median is its floor.
const FLOOR_BINS: usize = 20;
/// Largest logarithm of a line over its floor that counts.
const LARGEST_CONTRAST: f64 = 3.0;
/// Part of the Nyquist order up to which lines are right.
const PASSED: f64 = 0.8;
/// Steps of the speed in a bin of the second line.
const STEPS: f64 = 2.0;
/// Least gain in contrast of a changing speed over the best constant one, in each window.
const LEAST_GAIN: f64 = 2.8;
/// Least standard deviation of the speed over its mean.
const LEAST_VARIATION: f64 = 0.01;

/// (-) Standard deviation of the speed over its mean, where it changes over the recording.
///
/// The recording is cut into windows. In each, every speed has the contrast of its comb of lines with the noise floor. The path of speeds
/// from window to window with the largest sum is compared with the best constant speed: the lines of a shaft that
/// accelerates move, and those of noise or of a constant speed have no path that gains as much.
pub(super) fn changing_speed(angular: &AngularSignal, teeth: u32) -> Option<f64> {
    if teeth > MOST_TEETH {
        return None;
    }
    let paths = WINDOWS.into_iter().filter_map(|windows| Path::of(angular, teeth, windows));
    let best = paths.max_by(|a, b| a.gain.total_cmp(&b.gain))?;
    (best.gain > LEAST_GAIN && best.variation > LEAST_VARIATION).then_some(best.variation)
}

/// The best path of speeds.
struct Path {
    /// Contrast that it gains over the best constant speed, in each window.
    gain: f64,
    /// (-) Standard deviation of its speeds over their mean.
    variation: f64,
}

impl Path {
    fn of(angular: &AngularSignal, teeth: u32, windows: usize) -> Option<Self> {
        let points = angular.points_per_revolution as f64;
        let each = angular.values.len() / windows;
        let length = each.min((LONGEST * points) as usize);
        let window_rev = length as f64 / points;
        if window_rev < SHORTEST || length < 8 * FLOOR_BINS {
            return None;
        }
        let step = 1.0 / (STEPS * 2.0 * f64::from(teeth) * window_rev);
        let each_side = (LARGEST_RATIO.ln() / step) as i32;
        let ratios: Vec<f64> = (-each_side..=each_side).map(|k| (f64::from(k) * step).exp()).collect();
        let bins = (PASSED * angular.nyquist_order * window_rev) as usize;
        let mesh_bin = f64::from(teeth) * window_rev;
        let starts = (0..windows).map(|window| window * each);
        let contrasts: Vec<Vec<f64>> = starts
            .filter_map(|start| angular.values.get(start..start + length))
            .map(|values| {
                let lines = &contrast(values, bins);
                let line = |bin: f64| lines.get(bin.round() as usize).copied().unwrap_or(0.0);
                let comb = |ratio: &f64| (1..=HARMONICS).map(|h| line(f64::from(h) * mesh_bin * ratio)).sum();
                ratios.iter().map(comb).collect()
            })
            .collect();
        let reach = ((LARGEST_CHANGE / step) as usize).max(1);
        let (path, sum) = best_path(&contrasts, reach)?;
        let constant = |speed: usize| contrasts.iter().map(|of_window| of_window[speed]).sum::<f64>();
        let constant = (0..ratios.len()).map(constant).fold(0.0, f64::max);
        let speeds: Vec<f64> = path.into_iter().map(|speed| ratios[speed]).collect();
        let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
        let variance = speeds.iter().map(|speed| (speed - mean).powi(2)).sum::<f64>() / speeds.len() as f64;
        Some(Self { gain: (sum - constant) / windows as f64, variation: variance.sqrt() / mean })
    }
}

/// The path through rows of values with the largest sum, and that sum.
///
/// # Arguments
/// * `rows` - equally long
/// * `reach` - places by which the path moves from one row to the next at most
fn best_path(rows: &[Vec<f64>], reach: usize) -> Option<(Vec<usize>, f64)> {
    let (first, others) = rows.split_first()?;
    let mut sums = first.clone();
    let mut origins: Vec<Vec<usize>> = Vec::new();
    for row in others {
        let origin = best_near(&sums, reach);
        sums = origin.iter().zip(row).map(|(&from, value)| sums[from] + value).collect();
        origins.push(origin);
    }
    let mut at = (0..sums.len()).max_by(|a, b| sums[*a].total_cmp(&sums[*b]))?;
    let sum = sums[at];
    let mut path = vec![at];
    for origin in origins.iter().rev() {
        at = origin[at];
        path.push(at);
    }
    Some((path, sum))
}

/// Logarithms of the power of the first bins over the median around each, cut off at 0 and [`LARGEST_CONTRAST`].
fn contrast(values: &[f64], bins: usize) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let turn = TAU / values.len() as f64;
    let window = |i: usize| 0.5 * (1.0 - (turn * i as f64).cos());
    let windowed: Vec<f64> = values.iter().enumerate().map(|(i, value)| (value - mean) * window(i)).collect();
    let power: Vec<f64> = real_spectrum(&windowed).iter().take(bins).map(|x| x.norm_sqr()).collect();
    let floor = |block: usize| {
        let from = block.saturating_sub(1) * FLOOR_BINS;
        upper_median(&power[from..((block + 2) * FLOOR_BINS).min(power.len())])
    };
    let of_block = |(block, powers): (usize, &[f64])| {
        let floor = floor(block).max(f64::MIN_POSITIVE);
        powers.iter().map(|power| (power / floor).ln().clamp(0.0, LARGEST_CONTRAST)).collect::<Vec<_>>()
    };
    power.chunks(FLOOR_BINS).enumerate().flat_map(of_block).collect()
}

/// Index of the largest of the values within some places of each.
fn best_near(values: &[f64], reach: usize) -> Vec<usize> {
    let mut candidates = VecDeque::new();
    let mut next = 0;
    let at = |place: usize| {
        while next < values.len() && next <= place + reach {
            while candidates.back().is_some_and(|&last| values[last] <= values[next]) {
                candidates.pop_back();
            }
            candidates.push_back(next);
            next += 1;
        }
        while candidates.front().is_some_and(|&first| first + reach < place) {
            candidates.pop_front();
        }
        candidates.front().copied().unwrap_or(place)
    };
    (0..values.len()).map(at).collect()
}
