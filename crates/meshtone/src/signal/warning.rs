//! Warnings about a recording.

use thiserror::Error;

use super::Mismatch;

/// Something about a recording that leaves the result right but that its user should know.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SignalWarning {
    /// Pulses are missing; they were put in evenly.
    #[error("{count} pulse(s) missing after {after_s:.6} s (pulse {index}); filled in evenly")]
    MissingPulses {
        /// The pulse before the gap, in the list as given.
        index: usize,
        /// (s) Its time.
        after_s: f64,
        /// Number of missing pulses.
        count: usize,
    },
    /// A pulse that is one too many; it was left out.
    #[error("doubled pulse at {time_s:.6} s (pulse {index}); left out")]
    DoubledPulse {
        /// The pulse, in the list as given.
        index: usize,
        /// (s) Its time.
        time_s: f64,
    },
    /// The speed profile is shorter than the recording.
    #[error(
        "the speed profile ends at {profile_end_s:.6} s, the recording at {recording_end_s:.6} s: the last speed is \
         held"
    )]
    ProfileEndsEarly {
        /// (s) Last time of the profile.
        profile_end_s: f64,
        /// (s) Time of the last sample.
        recording_end_s: f64,
    },
    /// The mesh tone nearly vanishes somewhere: its phase is doubtful there.
    #[error(
        "the mesh tone falls to {:.1} % of its mean amplitude at sample {sample}: the phase is doubtful there",
        100.0 * ratio
    )]
    MeshToneFades {
        /// Sample at which it is weakest.
        sample: usize,
        /// (-) Its amplitude there over the mean one.
        ratio: f64,
    },
    /// A line beside the band is stronger than the strongest in it, as where the stated speed is wrong.
    #[error(
        "a line at {frequency_hz:.2} Hz is {ratio:.1} times as strong as the tone that was followed: if that one is \
         the mesh, the speed is {speed_hz:.4} Hz"
    )]
    StrongerNeighbour {
        /// (Hz) The stronger line.
        frequency_hz: f64,
        /// (-) Its amplitude over that of the tone.
        ratio: f64,
        /// (Hz) Shaft speed if it is the mesh.
        speed_hz: f64,
    },
    /// The mesh frequency is so near half the sampling rate that the interpolation weakens it.
    #[error(
        "mesh order {mesh_order} is more than {:.0} % of the Nyquist order {nyquist_order:.1}: the interpolation between \
         samples weakens the mesh tone; record at a higher rate", 100.0 * passed
    )]
    MeshOrderNearNyquist {
        /// Orders of the shaft.
        mesh_order: f64,
        /// Half the samples in a revolution.
        nyquist_order: f64,
        /// (-) Part of the Nyquist order up to which the interpolation passes a tone with less than 5 % of loss.
        passed: f64,
    },
    /// The recording hardly fits what is stated: [`super::find_mismatch`].
    #[error("{0}")]
    DoesNotFit(Mismatch),
}
