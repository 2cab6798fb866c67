//! Recordings of the healthy machine, and the pieces of them that are simulated.

use super::{PathError, RecordingProblem};
use crate::operation::Profile;
use crate::signal::{GearTrain, ShaftPhase, StatedTurning, TrainRecording, TrainTurning};

/// Mesh periods in a window, so that mesh harmonics and the sidebands around them are apart.
const PERIODS_IN_WINDOW: f64 = 20.0;
/// (s) Least and largest window: a resonance must be resolved, and a speed nearly constant.
const WINDOW_S: [f64; 2] = [0.05, 0.5];
/// Least samples in a window, and in a mesh period, so that the first mesh harmonic is passed.
const LEAST_IN_WINDOW: f64 = 16.0;
const SAMPLES_IN_PERIOD: f64 = 2.5;
/// Windows in a piece.
const WINDOWS_IN_PIECE: f64 = 8.0;
/// (s) Least length of a piece.
const SHORTEST_PIECE_S: f64 = 1.0;
/// Most pieces of all recordings that are simulated: more would take longer and tell hardly more.
const MOST_PIECES: usize = 32;
/// (-) Part of a piece's first speed from which it is taken to come at least, and to which inverse at most.
const LEAST_BEFORE: f64 = 0.5;

/// A recording of a machine by one sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorRecording {
    /// (g) The sensor's signal.
    pub values_g: Vec<f64>,
    /// (S/s) Its sampling rate.
    pub sampling_rate_hz: f64,
    /// Number of a shaft of the machine.
    pub shaft: usize,
    /// Angle of that shaft over the samples.
    pub phase: ShaftPhase,
    /// The source of the angle, whose mistakes are looked for.
    pub stated: StatedTurning,
}

impl SensorRecording {
    /// Carries the phase to the pinion's shaft or the input.
    ///
    /// # Arguments
    /// * `train` - tooth counts of the machine
    pub(super) fn over_input(&self, train: &GearTrain) -> Result<InputRecording<'_>, RecordingProblem> {
        let (shaft, shafts) = (self.shaft, train.shafts.len());
        if shaft >= shafts {
            return Err(RecordingProblem::NoSuchShaft { shaft, shafts });
        }
        let input = train.carried(&self.phase, shaft, train.input())?;
        Ok(InputRecording { values_g: &self.values_g, sampling_rate_hz: self.sampling_rate_hz, input })
    }

    /// Checks that the recording is of this machine and of nothing else.
    ///
    /// # Arguments
    /// * `train` - tooth counts of the machine
    pub(super) fn check(&self, train: &GearTrain) -> Result<(), RecordingProblem> {
        let Self { values_g, sampling_rate_hz, shaft, phase, stated } = self;
        let turning = TrainTurning::Shaft { shaft: *shaft, phase: phase.clone(), stated: *stated };
        let recording = TrainRecording {
            signal: values_g,
            sampling_rate_hz: *sampling_rate_hz,
            train,
            turning: &turning,
        };
        match recording.check()?.into_iter().next() {
            Some(warning) => Err(RecordingProblem::DoesNotFit(Box::new(warning))),
            None => Ok(()),
        }
    }
}

/// A recording over the angle of the pinion's shaft, of a gearbox of the input.
pub(super) struct InputRecording<'a> {
    /// (g) The sensor's signal.
    pub values_g: &'a [f64],
    /// (S/s) Its sampling rate.
    pub sampling_rate_hz: f64,
    /// Phase of the shaft.
    pub input: ShaftPhase,
}

impl InputRecording<'_> {
    /// (Hz) Mean speed of the pinion between two samples of the phase.
    pub(super) fn speed_hz(&self, from: usize, to: usize) -> f64 {
        let angle = &self.input.revolutions;
        (angle[to] - angle[from]) * self.sampling_rate_hz / (to - from) as f64
    }

    /// Samples that have both a value and an angle.
    pub(super) fn samples(&self) -> usize {
        self.input.revolutions.len().min(self.values_g.len().saturating_sub(self.input.first_sample))
    }

    /// (s) How long it has an angle.
    pub(super) fn length_s(&self) -> f64 {
        self.samples() as f64 / self.sampling_rate_hz
    }

    /// The samples of a piece.
    pub(super) fn values_of(&self, piece: &Piece) -> &[f64] {
        let first = self.input.first_sample + piece.first;
        &self.values_g[first..first + piece.samples]
    }
}

/// A piece of a recording, as long as is simulated at once.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Piece {
    /// Number of the recording, from 0.
    pub recording: usize,
    /// First sample, counted from the first that has an angle.
    pub first: usize,
    /// Samples.
    pub samples: usize,
    /// (s) Length.
    pub length_s: f64,
    /// (s, Hz) Speed of the pinion since the piece's start.
    pub speed_hz: Profile,
}

impl Piece {
    /// (s, Hz) Speed of the pinion in a simulation that settles before the piece, where the speed goes on as it begins.
    ///
    /// # Arguments
    /// * `settling_s` - (s) from the simulation's start to the piece's
    pub(super) fn settled_speed_hz(&self, settling_s: f64) -> Profile {
        let Profile { time_s, value } = &self.speed_hz;
        let slope = (value[1] - value[0]) / (time_s[1] - time_s[0]);
        let least = LEAST_BEFORE * value[0];
        let before_hz = (value[0] - slope * (settling_s + time_s[0])).clamp(least, value[0] / LEAST_BEFORE);
        let times = std::iter::once(0.0).chain(time_s.iter().map(|time_s| settling_s + time_s));
        Profile {
            time_s: times.collect(),
            value: std::iter::once(before_hz).chain(value.iter().copied()).collect(),
        }
    }

    /// (Hz) Mean speed of the pinion.
    pub(super) fn mean_speed_hz(&self) -> f64 {
        self.speed_hz.value.iter().sum::<f64>() / self.speed_hz.value.len() as f64
    }
}

/// Cuts recordings into pieces, and chooses the window for the spectra of all of them.
///
/// # Arguments
/// * `recordings` - all of them
/// * `mesh_order` - (orders of the pinion or the input) of the slowest mesh
///
/// # Returns
/// (s) The window's length, and the pieces.
pub(super) fn pieces(recordings: &[InputRecording], mesh_order: f64) -> Result<(f64, Vec<Piece>), PathError> {
    let slowest_hz = |recording: &InputRecording| {
        let last = recording.samples().saturating_sub(1);
        let step = ((WINDOW_S[0] * recording.sampling_rate_hz) as usize).clamp(1, last.max(1));
        let speeds = (0..last / step).map(|part| recording.speed_hz(part * step, (part + 1) * step));
        speeds.fold(f64::INFINITY, f64::min)
    };
    let slowest_hz = recordings.iter().map(slowest_hz).fold(f64::INFINITY, f64::min);
    let window_s = (PERIODS_IN_WINDOW / (slowest_hz * mesh_order)).clamp(WINDOW_S[0], WINDOW_S[1]);
    let most_of_each = (MOST_PIECES / recordings.len()).max(1);
    let mut pieces = Vec::new();
    for (number, recording) in recordings.iter().enumerate() {
        let (rate_hz, samples) = (recording.sampling_rate_hz, recording.samples());
        let refuse = |problem| Err(PathError::Recording { index: number, problem });
        let needed_hz = (LEAST_IN_WINDOW / window_s).max(SAMPLES_IN_PERIOD * slowest_hz * mesh_order);
        // Neither is an infinite speed, that of a recording without two samples, a rate.
        if needed_hz.is_finite() && rate_hz < needed_hz {
            return refuse(RecordingProblem::LowRate { rate_hz, needed_hz });
        }
        let recording_s = samples as f64 / rate_hz;
        let needed_s = 2.0 * window_s;
        if recording_s < needed_s {
            return refuse(RecordingProblem::TooShort { recording_s, needed_s });
        }
        let length_s = (WINDOWS_IN_PIECE * window_s).max(SHORTEST_PIECE_S).min(recording_s);
        let length = ((length_s * rate_hz) as usize).min(samples);
        let count = (samples / length).min(most_of_each);
        // Each piece lies in a slot of its own; run-ups that are alike are cut at different speeds.
        let slot = samples as f64 / count as f64;
        let shift = (number as f64 + 0.5) / recordings.len() as f64 * (slot - length as f64);
        let first = |at: usize| (at as f64 * slot + shift) as usize;
        pieces.extend((0..count).map(|at| piece(recording, number, first(at), length, window_s)));
    }
    Ok((window_s, pieces))
}

fn piece(recording: &InputRecording, number: usize, first: usize, samples: usize, window_s: f64) -> Piece {
    let rate_hz = recording.sampling_rate_hz;
    let parts = ((2.0 * samples as f64 / rate_hz / window_s).round() as usize).clamp(2, samples - 1);
    let edge = |part: usize| part * (samples - 1) / parts;
    let middle_s = |part: usize| (edge(part) + edge(part + 1)) as f64 / 2.0 / rate_hz;
    let speed_hz = |part: usize| recording.speed_hz(first + edge(part), first + edge(part + 1));
    Piece {
        recording: number,
        first,
        samples,
        length_s: samples as f64 / rate_hz,
        speed_hz: Profile {
            time_s: (0..parts).map(middle_s).collect(),
            value: (0..parts).map(speed_hz).collect(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // Run-ups that are alike: no sample lies in two pieces of one recording, and the pieces of all of them begin at different places.
    #[test]
    fn pieces_of_a_recording_lie_apart() {
        for recordings in [1, 2, 8] {
            let recording = || InputRecording {
                values_g: &[0.0; 45_000],
                sampling_rate_hz: 1e4,
                input: ShaftPhase::from_speed_profile(&[0.0, 4.5], &[20.0, 60.0], 1e4, 45_000).unwrap(),
            };
            let all: Vec<InputRecording> = (0..recordings).map(|_| recording()).collect();
            let (_, pieces) = pieces(&all, 20.0).unwrap();
            let mut first: Vec<usize> = pieces.iter().map(|piece| piece.first).collect();
            for pair in pieces.windows(2).filter(|pair| pair[0].recording == pair[1].recording) {
                assert!(pair[0].first + pair[0].samples <= pair[1].first, "{recordings}");
            }
            assert!(pieces.iter().all(|piece| piece.first + piece.samples <= 45_000), "{recordings}");
            let all = first.len();
            first.sort_unstable();
            first.dedup();
            assert_eq!((all, first.len()), (4 * recordings, all));
        }
    }
}
