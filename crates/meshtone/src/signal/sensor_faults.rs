//! What a sensor, its cable or its recorder did wrong, as the samples show it.

use std::collections::{HashMap, HashSet};

use thiserror::Error;

use super::statistics::peak_to_peak;

/// Fewest samples by which a fault is judged.
const FEWEST: usize = 256;
/// Different values up to which a converter's steps are as large as the signal, and from which on they are fine beside it.
const COARSE: usize = 16;
const FINE: usize = 128;
/// Part of the range at an extreme of which a clipped signal has most samples at the extreme itself, and fewest samples there.
const TOP: f64 = 0.02;
const FEWEST_CLIPPED: usize = 8;
/// Times as often as any other value near it that an extreme occurs in a clipped signal: in a periodic one all occur alike.
const MORE_OFTEN: usize = 3;
/// Values by which it is known how often any occurs.
const COUNTED: usize = 15;
/// Times as long a run of one value is as chance makes the longest, and samples beyond that.
const RUN_FACTOR: f64 = 4.0;
const RUN_SAMPLES: f64 = 16.0;
/// Samples of a block that is looked for again.
const BLOCK: usize = 128;
/// Part of the range by which the samples behind a repeated block differ from those behind the first, in the mean.
const APART: f64 = 0.02;
/// Factor of a block's checksum from sample to sample: odd, with bits all over.
const CHECKSUM: u64 = 0x9e37_79b9_7f4a_7c15;
/// (g, m/s²) Gravity, which sensors that measure down to 0 Hz show, and the part by which they may be wrong.
const GRAVITY: [f64; 2] = [1.0, 9.81];
const OF_GRAVITY: f64 = 0.1;

/// Something that a sensor or recorder did wrong.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum SensorFault {
    /// The signal has flat tops at an extreme.
    #[error(
        "{count} samples are exactly {level}, an extreme: the signal is clipped; widen the range of recorder or sensor"
    )]
    Clipped {
        /// (unit of the signal) The extreme.
        level: f64,
        /// Samples there.
        count: usize,
    },
    /// The signal varies little about a mean far from 0.
    #[error(
        "the signal stands at {mean:.4} and varies by {peak_to_peak:.4} only, as the bias of a sensor without supply: check cable and supply, \
         or couple it by AC"
    )]
    Biased {
        /// (unit of the signal) Its mean.
        mean: f64,
        /// (unit of the signal) From its least to its largest sample.
        peak_to_peak: f64,
    },
    /// The signal stays at one value.
    #[error("from sample {} on {count} samples are all {value}: the signal dropped out; cut the recording there", index + 1)]
    DroppedOut {
        /// The first of the samples, counted from 0.
        index: usize,
        /// How many there are.
        count: usize,
        /// (unit of the signal) The value.
        value: f64,
    },
    /// A block of samples stands there twice.
    #[error(
        "the {count} samples from sample {} on are those from sample {} on: the recorder repeated a block, and another may be lost; cut the \
         recording there", index + 1, from + 1
    )]
    Repeated {
        /// The first of the repeated samples, counted from 0.
        index: usize,
        /// The first of those that they are equal to.
        from: usize,
        /// How many there are.
        count: usize,
    },
    /// The steps of the converter are as large as the signal.
    #[error(
        "the signal has {values} different values only: the converter's steps are coarse beside it; raise the gain"
    )]
    Coarse {
        /// How many.
        values: usize,
    },
}

impl SensorFault {
    /// The name of what it is, for programs to distinguish.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Clipped { .. } => "clipped",
            Self::Biased { .. } => "biased",
            Self::DroppedOut { .. } => "dropped-out",
            Self::Repeated { .. } => "repeated-block",
            Self::Coarse { .. } => "coarse-steps",
        }
    }

    /// Its numbers by name.
    pub(super) fn values(&self) -> Vec<(&'static str, f64)> {
        match *self {
            Self::Clipped { level, count } => vec![("level", level), ("count", count as f64)],
            Self::Biased { mean, peak_to_peak } => vec![("mean", mean), ("peak_to_peak", peak_to_peak)],
            Self::DroppedOut { index, count, value } => {
                vec![("index", index as f64), ("count", count as f64), ("value", value)]
            }
            Self::Repeated { index, from, count } => {
                vec![("index", index as f64), ("from", from as f64), ("count", count as f64)]
            }
            Self::Coarse { values } => vec![("values", values as f64)],
        }
    }
}

/// Looks for what a sensor or its recorder did wrong: clipping, a bias beside which the signal is small, dropouts, repeated blocks, and steps as
/// large as the signal. Of several places of one kind the first or the worst is given.
///
/// # Arguments
/// * `signal` - a vibration, in any unit; a tachometer is clipped by nature. Of fewer than 256 samples nothing is said
///
/// ```
/// use meshtone::signal::{SensorFault, sensor_faults};
///
/// let mut signal: Vec<f64> = (0..9000).map(|i| (7919 * i % 10_007) as f64 - 5000.0).collect();
/// assert_eq!(sensor_faults(&signal), []);
/// signal.iter_mut().for_each(|x| *x = x.clamp(-4000.0, 4000.0));
/// assert!(matches!(sensor_faults(&signal)[..], [SensorFault::Clipped { level: 4000.0, .. }]));
/// ```
pub fn sensor_faults(signal: &[f64]) -> Vec<SensorFault> {
    if signal.len() < FEWEST {
        return Vec::new();
    }
    let values = different_values(signal);
    let is_fine = values >= FINE;
    let coarse = (2..=COARSE).contains(&values).then_some(SensorFault::Coarse { values });
    let clipped = if is_fine { clipped(signal) } else { None };
    let dropped = if is_fine { dropped_out(signal, clipped) } else { None };
    let repeated = if is_fine { repeated(signal) } else { None };
    [biased(signal), clipped, dropped, repeated, coarse].into_iter().flatten().collect()
}

/// The number of different values, counted to where they are fine.
fn different_values(signal: &[f64]) -> usize {
    let mut found = HashSet::new();
    for value in signal {
        if found.insert(value.to_bits()) && found.len() >= FINE {
            break;
        }
    }
    found.len()
}

fn biased(signal: &[f64]) -> Option<SensorFault> {
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let range = peak_to_peak(signal);
    let is_gravity = GRAVITY.iter().any(|g| (mean.abs() / g - 1.0).abs() < OF_GRAVITY);
    // Samples that are all one value have their own error.
    (range > 0.0 && range < mean.abs() && !is_gravity)
        .then_some(SensorFault::Biased { mean, peak_to_peak: range })
}

/// The extreme at which a signal is flat, of two the one with more samples. A signal that is not clipped has fewer samples at its extreme than
/// just below it.
fn clipped(signal: &[f64]) -> Option<SensorFault> {
    let least = signal.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = signal.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let near = TOP * (largest - least);
    let at = |level: f64| {
        let mut counts: HashMap<u64, usize> = HashMap::new();
        let beside = signal.iter().filter(|x| (**x - level).abs() <= near);
        beside.for_each(|x| *counts.entry((x + 0.0).to_bits()).or_default() += 1);
        let count = counts.remove(&(level + 0.0).to_bits()).unwrap_or(0);
        let others: usize = counts.values().sum();
        let next = counts.values().copied().max().unwrap_or(0);
        let is_flat = count >= FEWEST_CLIPPED && count > others && count > MORE_OFTEN * next;
        let is_usual = || count <= MORE_OFTEN * usual_count(signal);
        (is_flat && !is_usual()).then_some(SensorFault::Clipped { level, count })
    };
    let count = |fault: &SensorFault| if let SensorFault::Clipped { count, .. } = fault { *count } else { 0 };
    [at(least), at(largest)].into_iter().flatten().max_by_key(count)
}

/// How often values of a signal occur: the median of some.
fn usual_count(signal: &[f64]) -> usize {
    let some = signal.iter().step_by((signal.len() / COUNTED).max(1));
    let mut counts: Vec<usize> = some.map(|value| signal.iter().filter(|x| *x == value).count()).collect();
    let middle = counts.len() / 2;
    *counts.select_nth_unstable(middle).1
}

/// The longest run of one value, where it is much longer than chance makes it.
fn dropped_out(signal: &[f64], clipped: Option<SensorFault>) -> Option<SensorFault> {
    let (mut equal, mut start, mut longest) = (0, 0, (0, 0));
    for index in 1..=signal.len() {
        if signal.get(index) == Some(&signal[index - 1]) {
            equal += 1;
            continue;
        }
        let is_clipped =
            matches!(clipped, Some(SensorFault::Clipped { level, .. }) if level.abs() == signal[start].abs());
        if index - start > longest.1 && !is_clipped {
            longest = (start, index - start);
        }
        start = index;
    }
    let (index, count) = longest;
    // Pairs that are equal by chance, without the run itself.
    let samples = signal.len() as f64;
    let chance = ((equal + 1usize).saturating_sub(count).max(1) as f64 / samples).min(0.9);
    let by_chance = libm::log(samples) / -libm::log(chance);
    let is_long = count as f64 > RUN_FACTOR * by_chance + RUN_SAMPLES;
    is_long.then(|| SensorFault::DroppedOut { index, count, value: signal[index] })
}

/// The first block that stands there twice, where most of the signal does not: what is periodic by nature repeats throughout.
///
/// Checksums of blocks that adjoin are compared with those of blocks at every sample, each made of the one before.
fn repeated(signal: &[f64]) -> Option<SensorFault> {
    let least_apart = APART * peak_to_peak(signal);
    let bits = |index: usize| (signal[index] + 0.0).to_bits();
    let first_factor = (0..BLOCK).fold(1_u64, |factor, _| factor.wrapping_mul(CHECKSUM));
    let mut known: HashMap<u64, usize> = HashMap::new();
    let (mut sum, mut first, mut all, mut next) = (0_u64, None, 0, 0);
    for end in 0..signal.len() {
        sum = sum.wrapping_mul(CHECKSUM).wrapping_add(bits(end));
        let Some(start) = (end + 1).checked_sub(BLOCK) else { continue };
        if start > 0 {
            sum = sum.wrapping_sub(bits(start - 1).wrapping_mul(first_factor));
        }
        let block = &signal[start..=end];
        if start >= next
            && let Some(&from) = known.get(&sum)
            && from + BLOCK <= start
            && signal[from..from + BLOCK] == *block
            && block.iter().any(|x| *x != block[0])
        {
            let more = signal[start..].iter().zip(&signal[from..]).take_while(|(a, b)| a == b).count();
            let behind = signal[start + more..].iter().zip(&signal[from + more..]).take(BLOCK);
            let apart: Vec<f64> = behind.map(|(a, b)| (a - b).abs()).collect();
            // What is nearly periodic goes on alike.
            if apart.is_empty() || apart.iter().sum::<f64>() > apart.len() as f64 * least_apart {
                all += more;
                first.get_or_insert(SensorFault::Repeated { index: start, from, count: more });
            }
            next = start + more;
        }
        if start % BLOCK == 0 {
            known.entry(sum).or_insert(start);
        }
    }
    first.filter(|_| 2 * all < signal.len())
}

/// Pairs of channels of which the second is a copy of the first.
///
/// # Arguments
/// * `channels` - equally long; constant ones are no copies
///
/// ```
/// use meshtone::signal::copies;
///
/// assert_eq!(copies(&[&[1.0, 2.0], &[2.0, 1.0], &[1.0, 2.0]]), [[0, 2]]);
/// ```
pub fn copies(channels: &[&[f64]]) -> Vec<[usize; 2]> {
    let varies = |channel: &[f64]| channel.iter().any(|x| *x != channel[0]);
    let varying: Vec<usize> = (0..channels.len()).filter(|of| varies(channels[*of])).collect();
    let first = |other: usize| {
        let earlier = varying.iter().take_while(|one| **one < other);
        earlier.map(|one| [*one, other]).find(|[one, other]| channels[*one] == channels[*other])
    };
    varying.iter().filter_map(|other| first(*other)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(samples: usize) -> Vec<f64> {
        let mut state = 1_u64;
        let mut uniform = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24) - 0.5
        };
        // As of a converter of 16 bits.
        (0..samples).map(|_| ((0..12).map(|_| uniform()).sum::<f64>() * 3000.0).round() / 1e4).collect()
    }

    fn codes(signal: &[f64]) -> Vec<&'static str> {
        sensor_faults(signal).iter().map(SensorFault::code).collect()
    }

    #[test]
    fn sound_signals_have_no_fault() {
        let tone = |steps: f64| -> Vec<f64> {
            (0..20_000).map(|i| (0.0371 * f64::from(i)).sin()).map(|x| (steps * x).round() / steps).collect()
        };
        assert!(codes(&noise(50_000)).is_empty());
        assert!(
            codes(&tone(1e9)).is_empty() && codes(&tone(2000.0)).is_empty() && codes(&tone(100.0)).is_empty()
        );
        // A sensor that measures gravity too; and what repeats throughout.
        assert!(codes(&noise(5000).iter().map(|x| 0.2 * x + 1.0).collect::<Vec<_>>()).is_empty());
        assert!(codes(&noise(500).repeat(8)).is_empty());
        assert!(codes(&noise(100)).is_empty() && codes(&[2.0; 1000]).is_empty());
    }

    #[test]
    fn each_fault_is_found_alone() {
        let signal = noise(20_000);
        let clipped: Vec<f64> = signal.iter().map(|x| x.clamp(-0.5, 0.5)).collect();
        assert_eq!(codes(&clipped), ["clipped"]);
        let one_side: Vec<f64> = signal.iter().map(|x| x.min(0.7)).collect();
        assert!(matches!(sensor_faults(&one_side)[..], [SensorFault::Clipped { level: 0.7, .. }]));
        assert_eq!(codes(&signal.iter().map(|x| 0.01 * x + 11.8).collect::<Vec<_>>()), ["biased"]);
        let mut dropped = signal.clone();
        dropped[7000..7100].fill(0.0);
        assert_eq!(
            sensor_faults(&dropped),
            [SensorFault::DroppedOut { index: 7000, count: 100, value: 0.0 }]
        );
        let mut repeated = signal.clone();
        repeated.copy_within(4001..5001, 9000);
        let found = sensor_faults(&repeated);
        assert!(
            matches!(found[..], [SensorFault::Repeated { index, from, count }] if index - from == 4999 && count > 800 && index + count == 10_000),
            "{found:?}"
        );
        assert_eq!(codes(&signal.iter().map(|x| (2.0 * x).round()).collect::<Vec<_>>()), ["coarse-steps"]);
    }
}
