//! Channels of one file that were not sampled together: each with its own rate, or its own times.

use std::rc::Rc;

use super::assemble::assemble;
use super::error::Problem;
use super::label::Label;
use super::rate::StatedRate;
use super::selection::Selection;
use super::time::{shortest_within, timing};
use super::{Recording, RecordingOptions, RecordingWarning};
use crate::memory;

/// Part to which the rate of a channel that is interpolated is said.
const STATED: f64 = 1e-6;
/// Part of a recording over which a channel that is interpolated has samples, at least.
const COVERED: f64 = 0.9;

/// When the samples of a column were taken.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum TimeBase {
    /// At a constant rate, which something states.
    Uniform { stated: StatedRate, start_s: f64 },
    /// (s) At times, which rise, of a channel of a name.
    Times { of: String, times_s: Rc<Vec<f64>> },
}

impl TimeBase {
    fn time_s(&self, sample: usize) -> f64 {
        match self {
            Self::Uniform { stated, start_s } => start_s + sample as f64 / stated.rate_hz,
            Self::Times { times_s, .. } => times_s.get(sample).copied().unwrap_or(f64::INFINITY),
        }
    }

    /// (S/s) The rate, or the mean one.
    fn rate_hz(&self) -> f64 {
        match self {
            Self::Uniform { stated, .. } => stated.rate_hz,
            Self::Times { times_s, .. } => match times_s[..] {
                [first, .., last] => (times_s.len() - 1) as f64 / (last - first),
                _ => 0.0,
            },
        }
    }

    /// (s) The longest time from one sample to the next.
    fn apart_s(&self) -> f64 {
        match self {
            Self::Uniform { stated, .. } => 1.0 / stated.rate_hz,
            Self::Times { times_s, .. } => {
                times_s.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
            }
        }
    }

    /// As a constant rate, where it is one.
    fn uniform(&self) -> Result<(StatedRate, f64), Problem> {
        match self {
            Self::Uniform { stated, start_s } => Ok((stated.clone(), *start_s)),
            Self::Times { of, times_s } => {
                let timing = timing(of, times_s, 1.0)?;
                Ok((StatedRate { by: format!("channel {of}"), rate_hz: timing.rate_hz }, timing.start_s))
            }
        }
    }
}

/// Makes one recording of columns with their own time bases: at the highest rate of all, to which slower ones are interpolated between
/// their neighbours, as is right for a speed or a torque. A warning names each. Where the options state the rate, the columns are taken
/// as they are.
///
/// # Arguments
/// * `labels`, `selection`, `options` - as for [`assemble`]
/// * `samples`, `bases` - of each column of [`Selection::wanted`]
pub(super) fn assemble_bases(
    labels: &[Label],
    selection: &Selection,
    mut samples: Vec<Vec<f64>>,
    bases: &[TimeBase],
    options: &RecordingOptions,
) -> Result<Recording, Problem> {
    let lead = (0..bases.len())
        .reduce(|lead, other| if bases[other].rate_hz() > bases[lead].rate_hz() { other } else { lead });
    let Some(lead) = lead else { return assemble(labels, selection, samples, &[], options) };
    let is_like = |other: &TimeBase| match (&bases[lead], other) {
        (TimeBase::Uniform { stated, start_s }, TimeBase::Uniform { stated: of_other, start_s: other_s }) => {
            (of_other.rate_hz / stated.rate_hz - 1.0).abs() <= 1e-6 && start_s == other_s
        }
        (one, other) => one == other,
    };
    let (stated, start_s) = bases[lead].uniform().or_else(|problem| {
        options
            .sampling_rate_hz
            .map(|rate_hz| (StatedRate { by: String::new(), rate_hz }, 0.0))
            .ok_or(problem)
    })?;
    let mut warnings = Vec::new();
    let count = samples[lead].len();
    let slow = bases.iter().filter(|base| !is_like(base)).count() as u64;
    if let Some(objection) = memory::limit().objection(slow.saturating_mul(8 * count as u64)) {
        let problem = format!(
            "{slow} channels interpolated to {count} samples {objection}; choose fewer channels (option channels)"
        );
        return Err(Problem::Refused(problem));
    }
    for (slot, base) in bases.iter().enumerate().filter(|(_, base)| !is_like(base)) {
        if options.sampling_rate_hz.is_some() {
            continue;
        }
        let label = &labels[selection.wanted[slot]];
        if base.rate_hz() == stated.rate_hz {
            let (other_s, raw) = (base.time_s(0), &label.raw);
            return Err(Problem::Refused(format!(
                "{raw} starts at {other_s} s, another channel at {start_s} s; choose channels that were recorded together"
            )));
        }
        let rises = match base {
            TimeBase::Times { times_s, .. } => times_s.windows(2).all(|pair| pair[0] <= pair[1]),
            TimeBase::Uniform { .. } => true,
        };
        let own_s = Some(base.rate_hz()).filter(|rate_hz| *rate_hz > 0.0).map_or(0.0, f64::recip);
        let end_s = start_s + count as f64 / stated.rate_hz;
        let [own_start_s, last_s] =
            [0, samples[slot].len().saturating_sub(1)].map(|sample| base.time_s(sample));
        let covered_s = end_s.min(last_s + own_s) - start_s.max(own_start_s - own_s);
        // Elsewhere its first or last sample would stand for what was not measured.
        if !rises || covered_s.is_nan() || covered_s < COVERED * (end_s - start_s) {
            return Err(Problem::Refused(format!(
                "{} has samples from {own_start_s} s to {last_s} s, and others from {start_s} s to {end_s} s, or its times go back; choose \
                 channels that were recorded together",
                label.raw
            )));
        }
        samples[slot] =
            interpolated(&samples[slot], base, |sample| start_s + sample as f64 / stated.rate_hz, count);
        warnings.push(RecordingWarning::Interpolated {
            name: label.name.clone(),
            own_hz: shortest_within(base.rate_hz(), STATED),
            apart_s: base.apart_s(),
            rate_hz: stated.rate_hz,
        });
    }
    let recording = assemble(labels, selection, samples, &[stated], options)?;
    let start_s = if options.sampling_rate_hz.is_some() { 0.0 } else { start_s };
    Ok(Recording { start_s, warnings: [recording.warnings, warnings].concat(), ..recording })
}

/// Samples at other times: on the straight line between neighbours, before the first and behind the last as these.
///
/// # Arguments
/// * `samples`, `base` - what there is
/// * `time_s` - (s) the times of the result
/// * `count` - how many
fn interpolated(samples: &[f64], base: &TimeBase, time_s: impl Fn(usize) -> f64, count: usize) -> Vec<f64> {
    let Some(last) = samples.len().checked_sub(1) else { return Vec::new() };
    let mut before = 0;
    let at = |sample: usize| {
        let time_s = time_s(sample);
        while before < last && base.time_s(before + 1) <= time_s {
            before += 1;
        }
        let next = (before + 1).min(last);
        let (from_s, to_s) = (base.time_s(before), base.time_s(next));
        let part = if to_s > from_s { ((time_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0) } else { 0.0 };
        samples[before] + part * (samples[next] - samples[before])
    };
    (0..count).map(at).collect()
}

impl Recording {
    /// Whether it covers at least nine tenths of the time of another recording, so that it can be brought to the samples of that one.
    ///
    /// # Arguments
    /// * `other` - the other recording
    pub fn covers(&self, other: &Recording) -> bool {
        let end_s = |of: &Recording| of.start_s + of.len() as f64 / of.sampling_rate_hz;
        let covered_s = end_s(self).min(end_s(other)) - self.start_s.max(other.start_s);
        covered_s >= COVERED * (end_s(other) - other.start_s)
    }

    /// The first channel of a recording over the same time, at the samples of another one.
    ///
    /// # Arguments
    /// * `other` - the recording whose samples count
    pub fn at_samples_of(self, other: &Recording) -> Recording {
        let stated = StatedRate { by: String::new(), rate_hz: self.sampling_rate_hz };
        let base = TimeBase::Uniform { stated, start_s: self.start_s };
        let time_s = |sample: usize| other.start_s + sample as f64 / other.sampling_rate_hz;
        let mut warnings = self.warnings;
        let channels = self.channels.into_iter().map(|channel| {
            warnings.push(RecordingWarning::Interpolated {
                name: channel.name.clone(),
                own_hz: self.sampling_rate_hz,
                apart_s: 1.0 / self.sampling_rate_hz,
                rate_hz: other.sampling_rate_hz,
            });
            let samples = interpolated(&channel.samples, &base, time_s, other.len());
            super::Channel { samples, ..channel }
        });
        let channels = channels.collect();
        Recording {
            channels,
            warnings,
            sampling_rate_hz: other.sampling_rate_hz,
            start_s: other.start_s,
            ..self
        }
    }
}
