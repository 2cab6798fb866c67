//! Warnings about a recording.

use thiserror::Error;

use super::{ForeignTone, ForeignTones, Mismatch, SensorFault, SignalError, SynchronousPart, WheelError};

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
    /// The average holds hardly more than noise would leave.
    #[error(
        "no signal is synchronous with the wheel of {teeth} teeth: the average of {0} revolutions holds {1:.2} % of the recording's \
         mean square, noise alone leaves {2:.2} %; its indicators are meaningless. {3}",
        part.revolutions, 100.0 * part.of_mean_square, 100.0 / part.revolutions as f64, remedy(other.as_deref())
    )]
    NothingSynchronous {
        /// What the average holds.
        part: SynchronousPart,
        /// Teeth of the wheel.
        teeth: u32,
        /// Name of a wheel of another shaft with which most of the recording repeats, where there is one.
        other: Option<String>,
    },
    /// The recording is too short for an average over some shafts, or over any: what repeats with them is left beside the lines of bearings.
    #[error("{}", not_averaged(shafts, *of_all, *needed))]
    NotAveraged {
        /// The shafts, and (rev) how often each turns in the recording.
        shafts: Vec<(String, f64)>,
        /// Whether these are all shafts, so that nothing is removed.
        of_all: bool,
        /// (rev) Fewest revolutions that are averaged.
        needed: f64,
    },
    /// Where the planets of a set stand is not known but taken from the recording.
    #[error(
        "the recording does not say where the planets of {set} stand: planet 1 is taken to pass the sensor where the carrier has turned {carrier_deg:.0}° \
         (or any whole planets more), at which the mesh is loudest"
    )]
    PlanetsFound {
        /// The set.
        set: String,
        /// (°) Angle of the carrier, in its sense, from where its phase is 0.
        carrier_deg: f64,
    },
    /// A wheel turns too little for an average; others have one.
    #[error("there is no result of {0}")]
    WheelWithoutAverage(WheelError),
    /// Tones that belong to neither shaft make much of the recording.
    #[error("{0}")]
    ForeignTones(ForeignTones),
    /// Sensor or recorder did not work as they should.
    #[error("{0}")]
    SensorFault(SensorFault),
}

impl SignalWarning {
    /// The name of what it is about, for programs to distinguish.
    pub fn code(&self) -> &'static str {
        match self {
            Self::MissingPulses { .. } => "missing-pulses",
            Self::DoubledPulse { .. } => "doubled-pulse",
            Self::ProfileEndsEarly { .. } => "profile-ends-early",
            Self::MeshToneFades { .. } => "mesh-tone-fades",
            Self::StrongerNeighbour { .. } => "stronger-neighbour",
            Self::MeshOrderNearNyquist { .. } => "mesh-order-near-nyquist",
            Self::DoesNotFit(mismatch) => mismatch.alternative.code(),
            Self::NothingSynchronous { .. } => "nothing-synchronous",
            Self::NotAveraged { .. } => "not-averaged",
            Self::PlanetsFound { .. } => "planets-found",
            Self::WheelWithoutAverage(_) => "wheel-without-average",
            Self::ForeignTones(_) => "foreign-tones",
            Self::SensorFault(fault) => fault.code(),
        }
    }

    /// Its numbers by name, of a tone that is one of several with its place behind the name.
    pub fn values(&self) -> Vec<(String, f64)> {
        let of = |values: &[(&str, f64)]| {
            values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect()
        };
        match self {
            Self::MissingPulses { index, after_s, count } => {
                of(&[("index", *index as f64), ("after_s", *after_s), ("count", *count as f64)])
            }
            Self::DoubledPulse { index, time_s } => of(&[("index", *index as f64), ("time_s", *time_s)]),
            Self::ProfileEndsEarly { profile_end_s, recording_end_s } => {
                of(&[("profile_end_s", *profile_end_s), ("recording_end_s", *recording_end_s)])
            }
            Self::MeshToneFades { sample, ratio } => of(&[("sample", *sample as f64), ("ratio", *ratio)]),
            Self::StrongerNeighbour { frequency_hz, ratio, speed_hz } => {
                of(&[("frequency_hz", *frequency_hz), ("ratio", *ratio), ("speed_hz", *speed_hz)])
            }
            Self::MeshOrderNearNyquist { mesh_order, nyquist_order, passed } => {
                of(&[("mesh_order", *mesh_order), ("nyquist_order", *nyquist_order), ("passed", *passed)])
            }
            Self::DoesNotFit(mismatch) => {
                let mut values = of(&[("alternative", mismatch.alternative.value())]);
                values.extend(mismatch.energy_ratio.map(|ratio| ("energy_ratio".to_owned(), ratio)));
                values
            }
            Self::NothingSynchronous { part, teeth, .. } => of(&[
                ("of_mean_square", part.of_mean_square),
                ("revolutions", part.revolutions as f64),
                ("teeth", f64::from(*teeth)),
            ]),
            Self::NotAveraged { shafts, needed, .. } => {
                let of_shaft = |(index, (_, turned)): (usize, &(String, f64))| {
                    (format!("revolutions_{}", index + 1), *turned)
                };
                let all = std::iter::once(("needed".to_owned(), *needed));
                all.chain(shafts.iter().enumerate().map(of_shaft)).collect()
            }
            Self::PlanetsFound { carrier_deg, .. } => of(&[("carrier_deg", *carrier_deg)]),
            Self::WheelWithoutAverage(WheelError { teeth, error, .. }) => {
                let mut values = of(&[("teeth", f64::from(*teeth))]);
                let counts = match error {
                    SignalError::TooFewRevolutions { revolutions, needed } => Some((*revolutions, *needed)),
                    SignalError::TooFewPassages { revolutions, needed } => {
                        Some((*revolutions as f64, *needed))
                    }
                    _ => None,
                };
                if let Some((revolutions, needed)) = counts {
                    values.extend(of(&[("revolutions", revolutions), ("needed", needed as f64)]));
                }
                values
            }
            Self::SensorFault(fault) => of(&fault.values()),
            Self::ForeignTones(tones) => {
                let of_tone = |(index, tone): (usize, &ForeignTone)| {
                    let named = |name: &str, value: f64| (format!("{name}_{}", index + 1), value);
                    [
                        named("frequency_hz", tone.frequency_hz),
                        named("order", tone.order),
                        named("part", tone.part),
                    ]
                };
                let all = std::iter::once(("part".to_owned(), tones.part));
                all.chain(tones.strongest.iter().enumerate().flat_map(of_tone)).collect()
            }
        }
    }
}

/// What to do about [`SignalWarning::NothingSynchronous`].
fn remedy(other: Option<&str>) -> String {
    const CHECK: &str = "Check the tooth counts, the pulses per revolution, the speed and whether it is steady, the sampling rate, and the \
                         recording's length and noise";
    let hides = |other| {
        format!(
            "Most of the recording repeats with {other}, whose damage may hide this wheel; or these teeth are stated wrongly"
        )
    };
    other.map_or_else(|| CHECK.to_owned(), hides)
}

/// The words of [`SignalWarning::NotAveraged`].
fn not_averaged(shafts: &[(String, f64)], of_all: bool, needed: f64) -> String {
    let turned = shafts.iter().map(|(name, turned)| format!("{turned:.1} revolutions of shaft {name}"));
    let turned = turned.collect::<Vec<_>>().join(" and ");
    let left = if of_all { "no average is removed" } else { "its average is not removed" };
    format!(
        "the recording has {turned}, and an average needs at least {needed}: {left}, so that tones of gears may stand beside the lines of \
         bearings; record for longer, or take another separation: discrete-random or prewhitening"
    )
}
