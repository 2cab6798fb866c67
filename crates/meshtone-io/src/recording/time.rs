//! The sampling rate out of a time column.
//!
//! The times are compared with the straight line through them (least squares). They may deviate by a hundredth
//! of the interval, by what floating point makes of large times, and by half the step to which they are rounded
//! in the file: 50 kS/s with four decimals of a second are five equal times in a row, and uniform none the less.
//! That step is found from the numbers themselves.

use super::error::Problem;

/// Part of the interval by which a time may deviate.
const JITTER: f64 = 0.01;
/// A rate that is less certain is none.
const MAX_UNCERTAINTY: f64 = 1e-3;
/// Decimals of a time beyond which it counts as exact; the number of digits in double precision is the limit.
const MAX_DECIMALS: i32 = 15;
/// Largest whole number up to which a double has digits to spare for distinguishing it from its neighbours.
const MAX_WHOLE: f64 = (1_u64 << 46) as f64;
/// To this, no double below [`MAX_WHOLE`] can be added without being rounded to a whole number.
const NO_DECIMALS: f64 = 1.5 * (1_u64 << 52) as f64;
/// Values that are summed or compared side by side.
const LANES: usize = 8;
/// Steps that are alike, out of all, for times to be on a grid of their own rather than rounded to one.
const ALIKE: f64 = 0.99;

/// What a time column says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Timing {
    pub rate_hz: f64,
    pub start_s: f64,
    /// Part of the rate by which it may be wrong, because the times are rounded.
    pub uncertainty: f64,
}

/// The straight line through the times.
struct Line {
    first: f64,
    /// Mean step from the first time to the last.
    chord: f64,
    /// What least squares correct of that line: its middle and its slope.
    mean: f64,
    slope: f64,
    middle: f64,
}

/// The steps from each time to the next.
struct Steps {
    median: f64,
    /// Part of all that is the median.
    alike: f64,
    /// Of a step from the median.
    largest_difference: f64,
}

/// Finds the sampling rate.
///
/// The times must rise, and must not deviate from the straight line through them by more than rounding explains. Where they do, the
/// error names the step that differs most, since that is where samples are missing. The rate is then the number of fewest digits that
/// the times allow.
///
/// # Arguments
/// * `column` - the name of the time column, for messages
/// * `times` - finite times in the file's unit
/// * `unit_s` - (s) that unit
pub(super) fn timing(column: &str, times: &[f64], unit_s: f64) -> Result<Timing, Problem> {
    let refuse = |problem: &str| Err(Problem::time(column, problem));
    let (&[first, .., last], count) = (times, times.len()) else {
        return refuse("has one sample only, which gives no sampling rate");
    };
    // All are compared first: without a way out in between, in vectors.
    let goes_back = times.iter().zip(&times[1..]).fold(false, |back, (from, to)| back | (to < from));
    let back = || times.windows(2).position(|pair| pair[1] < pair[0]);
    if let Some(index) = goes_back.then(back).flatten() {
        let (from, to) = (times[index] * unit_s, times[index + 1] * unit_s);
        return refuse(&format!("goes back from {from} s to {to} s at sample {}", index + 2));
    }
    if last <= first {
        return refuse(&format!("stays at {} s", first * unit_s));
    }
    let steps = steps(times);
    let line = line(times);
    let largest = first.abs().max(last.abs());
    let largest_deviation = largest_of(times.len(), |index| line.deviation(times, index));
    let rounding = 4.0 * f64::EPSILON * largest;
    let resolution = resolution(times, largest, &steps);
    let sampling_noise = 1.0 + 4.0 / (count as f64).sqrt();
    // Where rounding is finer than the interval, a missing sample shows in any case, so that room can be left
    // for the slow beat between the interval and the rounding step.
    // A little more than half a step otherwise: ties are rounded away from 0, on both sides of it.
    let share = if resolution < 0.5 * line.interval() { 0.75 } else { 0.52 };
    let allowed = share * sampling_noise * resolution + JITTER * line.interval() + rounding;
    if largest_deviation > allowed {
        let step = |index: usize| times[index + 1] - times[index];
        let from_median = |index: &usize| (step(*index) - steps.median).abs() == steps.largest_difference;
        let worst = (0..count - 1).find(from_median).unwrap_or(0);
        let deviates = |index: &usize| line.deviation(times, *index) == largest_deviation;
        let interval = if steps.median > 0.0 { steps.median } else { line.interval() };
        let [step_s, interval_s, deviation_s] =
            [step(worst), interval, largest_deviation].map(|time| readable(time * unit_s));
        return Err(Problem::Refused(format!(
            "time column {column} is not uniform: from sample {} to the next it advances by {step_s} s, elsewhere by {interval_s} s; \
             the largest deviation from uniform time is {deviation_s} s, at sample {}; resample the recording, cut it at the gap, \
             or, if the samples are uniform and only the time column is not, give the sampling rate (option sampling_rate_hz)",
            worst + 1,
            (0..count).find(deviates).unwrap_or(0) + 1,
        )));
    }
    let uncertainty = (1.5 * resolution + rounding) / (last - first) + 1e-12;
    if uncertainty > MAX_UNCERTAINTY {
        let (resolution_s, span_s) = (readable(resolution * unit_s), readable((last - first) * unit_s));
        let percent = readable(100.0 * uncertainty);
        return refuse(&format!(
            "is rounded to {resolution_s} s over {span_s} s, which gives the sampling rate only to {percent} %"
        ));
    }
    let rate_hz = shortest_within(1.0 / (line.interval() * unit_s), uncertainty);
    Ok(Timing { rate_hz, start_s: first * unit_s, uncertainty })
}

impl Line {
    fn interval(&self) -> f64 {
        self.chord + self.slope
    }

    fn beyond_chord(&self, times: &[f64], index: usize) -> f64 {
        (times[index] - self.first) - index as f64 * self.chord
    }

    /// Of a time from the line.
    #[inline]
    fn deviation(&self, times: &[f64], index: usize) -> f64 {
        (self.beyond_chord(times, index) - self.mean - self.slope * (index as f64 - self.middle)).abs()
    }
}

/// Least squares, as a correction of the line from the first to the last time: that keeps all digits.
fn line(times: &[f64]) -> Line {
    let (first, last) = (times[0], times[times.len() - 1]);
    let count = times.len() as f64;
    let chord = (last - first) / (count - 1.0);
    let middle = 0.5 * (count - 1.0);
    let chord = Line { first, chord, mean: 0.0, slope: 0.0, middle };
    // Sums side by side, as one would wait for itself.
    let (mut sums, mut moments) = ([0.0; LANES], [0.0; LANES]);
    let whole = times.len() - times.len() % LANES;
    let mut add = |index: usize, lane: usize| {
        let deviation = chord.beyond_chord(times, index);
        sums[lane] += deviation;
        moments[lane] += (index as f64 - middle) * deviation;
    };
    for start in (0..whole).step_by(LANES) {
        for lane in 0..LANES {
            add(start + lane, lane);
        }
    }
    for index in whole..times.len() {
        add(index, 0);
    }
    let slope = moments.iter().sum::<f64>() * 12.0 / (count * (count * count - 1.0));
    Line { mean: sums.iter().sum::<f64>() / count, slope, ..chord }
}

/// The largest of some values that are not negative.
fn largest_of(count: usize, value: impl Fn(usize) -> f64) -> f64 {
    let larger = |a: f64, b: f64| if b > a { b } else { a };
    let mut largest = [0.0; LANES];
    let whole = count - count % LANES;
    for start in (0..whole).step_by(LANES) {
        for lane in 0..LANES {
            largest[lane] = larger(largest[lane], value(start + lane));
        }
    }
    let rest = (whole..count).map(value);
    largest.into_iter().chain(rest).fold(0.0, larger)
}

fn steps(times: &[f64]) -> Steps {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    let median = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let largest_difference = largest_of(steps.len(), |index| (steps[index] - median).abs());
    let is_alike = |step: &&f64| (**step - median).abs() <= JITTER * median;
    let alike = if largest_difference <= JITTER * median {
        steps.len()
    } else {
        steps.iter().filter(is_alike).count()
    };
    Steps { median, alike: alike as f64 / steps.len() as f64, largest_difference }
}

/// The step to which the times are rounded; 0 where they are as exact as numbers are.
fn resolution(times: &[f64], largest: f64, steps: &Steps) -> f64 {
    let found = decimal_step(times, largest).unwrap_or_else(|| single_precision_step(times, largest));
    if steps.alike == 1.0 {
        // On a grid of their own; single precision makes even those steps differ a little.
        found.min(steps.largest_difference)
    } else if steps.alike >= ALIKE && found >= 0.5 * steps.median {
        0.0
    } else {
        found
    }
}

/// 10 to the power of minus the decimals, of the times in the largest decade (smaller ones may have more).
fn decimal_step(times: &[f64], largest: f64) -> Option<f64> {
    let mut decimals = 0;
    let mut scale = 1.0;
    for time in times.iter().filter(|time| time.abs() >= 0.1 * largest) {
        loop {
            let scaled = time * scale;
            // The nearest whole number, as the sum has no room for digits behind the point.
            let whole = (scaled + NO_DECIMALS) - NO_DECIMALS;
            if (scaled - whole).abs() <= 4.0 * f64::EPSILON * scaled.abs() {
                break;
            }
            decimals += 1;
            scale = 10_f64.powi(decimals);
            if decimals > MAX_DECIMALS || largest * scale > MAX_WHOLE {
                return None;
            }
        }
    }
    Some(1.0 / scale)
}

fn single_precision_step(times: &[f64], largest: f64) -> f64 {
    let single = times.iter().all(|time| f64::from(*time as f32) == *time);
    if single { largest * f64::from(f32::EPSILON) } else { 0.0 }
}

/// The number of fewest digits that differs by no more than a part of it.
pub(super) fn shortest_within(value: f64, part: f64) -> f64 {
    let rounded = |digits: usize| format!("{value:.digits$e}").parse().unwrap_or(value);
    (0..16).map(rounded).find(|short: &f64| (short / value - 1.0).abs() <= part).unwrap_or(value)
}

/// A number for a message, to six digits.
pub(super) fn readable(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests;
