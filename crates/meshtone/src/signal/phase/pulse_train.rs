//! Pulses in order, with none missing and none doubled.

use crate::signal::check::{check_count, check_finite};
use crate::signal::{SignalError, SignalWarning, upper_median};

/// Number of intervals on each side that show how long an interval should be.
const NEIGHBOURS: usize = 4;
/// An interval of less than this part of its neighbours' median is half of a doubled pulse.
const DOUBLED: f64 = 0.5;
/// An interval of more than this part holds missing pulses.
const MISSING: f64 = 1.6;
/// Most pulses that are put in at one place: the speed may change within a longer gap.
const MOST_MISSING: usize = 20;

/// Times of pulses, evenly many per revolution.
#[derive(Debug, Clone, PartialEq)]
pub struct PulseTrain {
    /// (s) Times of the pulses; 0 is the recording's first sample.
    pub time_s: Vec<f64>,
    /// Warnings about pulses that were put in or left out.
    pub warnings: Vec<SignalWarning>,
}

/// Puts in missing pulses and leaves out doubled ones.
///
/// An interval between pulses is compared with the median of the four before and the four after it. Shorter than half of
/// it: the later pulse is one too many, as from a bouncing contact. Longer than 1.6 times it: pulses are missing, and
/// are put in evenly, up to 20 at one place. So pulses may be unevenly spaced by a good quarter of an interval.
///
/// # Arguments
/// * `time_s` - (s) the pulses' times, strictly rising
///
/// # Errors
/// Fewer than three pulses; NaN; pulses out of order or at the same time; more than 20 missing at one place.
///
/// ```
/// use meshtone::signal::repair_pulses;
///
/// let train = repair_pulses(&[0.0, 0.1, 0.2, 0.21, 0.3, 0.4, 0.7, 0.8])?;
/// assert_eq!(train.time_s.len(), 9);
/// assert_eq!(train.warnings[0].to_string(), "doubled pulse at 0.210000 s (pulse 3); left out");
/// assert_eq!(train.warnings[1].to_string(), "2 pulse(s) missing after 0.400000 s (pulse 5); filled in evenly");
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn repair_pulses(time_s: &[f64]) -> Result<PulseTrain, SignalError> {
    check_order(time_s)?;
    let mut warnings = Vec::new();
    // The kept pulses, each with its place in the list as given.
    let mut kept: Vec<(usize, f64)> = Vec::with_capacity(time_s.len());
    let intervals: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    for (index, &time_s) in time_s.iter().enumerate() {
        let since = kept.last().map(|&(_, last)| time_s - last);
        if since.is_some_and(|since| since < DOUBLED * usual(&intervals, index - 1)) {
            warnings.push(SignalWarning::DoubledPulse { index, time_s });
        } else {
            kept.push((index, time_s));
        }
    }
    let intervals: Vec<f64> = kept.windows(2).map(|pair| pair[1].1 - pair[0].1).collect();
    let mut complete = vec![kept[0].1];
    for (i, interval) in intervals.iter().enumerate() {
        let (index, after_s) = kept[i];
        let parts = interval / usual(&intervals, i);
        if parts > MISSING {
            let missing = parts.round() - 1.0;
            if missing > MOST_MISSING as f64 {
                return Err(SignalError::PulseGap { index, after_s, missing, allowed: MOST_MISSING });
            }
            let parts = parts.round().max(2.0) as usize;
            warnings.push(SignalWarning::MissingPulses { index, after_s, count: parts - 1 });
            complete.extend((1..parts).map(|k| after_s + interval * k as f64 / parts as f64));
        }
        complete.push(kept[i + 1].1);
    }
    Ok(PulseTrain { time_s: complete, warnings })
}

/// Median of the intervals around one, itself included: the larger middle one of an even number, since doubled pulses
/// make two short ones.
fn usual(intervals: &[f64], index: usize) -> f64 {
    let last = intervals.len() - 1;
    let from = index.min(last).saturating_sub(NEIGHBOURS);
    upper_median(&intervals[from..=(index + NEIGHBOURS).min(last)])
}

fn check_order(time_s: &[f64]) -> Result<(), SignalError> {
    check_count("tachometer pulses", time_s.len(), 3)?;
    check_finite(time_s)?;
    for index in 1..time_s.len() {
        let (previous_s, time_s) = (time_s[index - 1], time_s[index]);
        if time_s == previous_s {
            return Err(SignalError::PulsesEqual { index, time_s });
        }
        if time_s < previous_s {
            return Err(SignalError::PulsesOutOfOrder { index, time_s, previous_s });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_steady_or_rising_speed_is_left_alone() {
        // 20 to 60 Hz in 2 s, one pulse per revolution: t = (√(400 + 40 n) − 20)/20.
        let run_up: Vec<f64> =
            (0..80).map(|n| ((400.0 + 40.0 * f64::from(n)).sqrt() - 20.0) / 20.0).collect();
        let train = repair_pulses(&run_up).unwrap();
        assert_eq!((train.time_s, train.warnings), (run_up, vec![]));
    }

    #[test]
    fn pulses_missing_and_doubled_in_a_run_up() {
        let time = |n: u32| ((400.0 + 40.0 * f64::from(n)).sqrt() - 20.0) / 20.0;
        let mut damaged: Vec<f64> = (0..80).filter(|n| ![30, 31, 50].contains(n)).map(time).collect();
        damaged.insert(11, time(10) + 1e-3);
        let train = repair_pulses(&damaged).unwrap();
        assert_eq!(train.time_s.len(), 80);
        let expected = [
            SignalWarning::DoubledPulse { index: 11, time_s: time(10) + 1e-3 },
            SignalWarning::MissingPulses { index: 30, after_s: time(29), count: 2 },
            SignalWarning::MissingPulses { index: 48, after_s: time(49), count: 1 },
        ];
        assert_eq!(train.warnings, expected);
        let off = (0..80).map(|n| (train.time_s[n as usize] - time(n)).abs()).fold(0.0, f64::max);
        assert!(off < 1e-3, "{off}");
    }

    #[test]
    fn order() {
        let equal = repair_pulses(&[0.0, 1.0, 1.0, 2.0]);
        assert_eq!(equal, Err(SignalError::PulsesEqual { index: 2, time_s: 1.0 }));
        let back = repair_pulses(&[0.0, 1.0, 0.5, 2.0]).unwrap_err().to_string();
        assert_eq!(back, "pulse 2 at 0.5 s comes before pulse 1 at 1 s: pulses must be in order of time");
    }
}
