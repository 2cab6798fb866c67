//! Errors about a recording.

use crate::bearing::BearingError;
use thiserror::Error;

/// A recording, a phase or a setting that gives no right result.
///
/// Samples and pulses are counted from 0.
///
/// ```
/// use meshtone::signal::check_channel;
///
/// let error = check_channel(&[0.1, f64::NAN, 0.3, f64::NAN]).unwrap_err();
/// assert_eq!(error.to_string(), "sample 1 is NaN; 2 of 4 samples are not finite numbers");
/// ```
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SignalError {
    /// NaN or infinity, as gaps are often written.
    #[error("sample {sample} is {value}; {count} of {samples} samples are not finite numbers")]
    NotFinite {
        /// First such sample.
        sample: usize,
        /// Its value.
        value: f64,
        /// The number of them.
        count: usize,
        /// Length of the channel.
        samples: usize,
    },
    /// Every sample has the same value: the sensor was not connected, or the wrong column was read.
    #[error("all {samples} samples are {value}: a constant channel contains no information")]
    Constant {
        /// The value.
        value: f64,
        /// Length of the channel.
        samples: usize,
    },
    /// There are too few values.
    #[error("{what}: there are {given}, but at least {needed} are needed")]
    TooFew {
        /// Name of the scarce quantity.
        what: &'static str,
        /// The number of them.
        given: usize,
        /// The number that is needed.
        needed: usize,
    },
    /// Two things that must be equally long are not.
    #[error("{what}: {given} values, but {expected} are expected")]
    LengthMismatch {
        /// Name of the values whose length is wrong.
        what: &'static str,
        /// Its length.
        given: usize,
        /// The length that it should have.
        expected: usize,
    },
    /// The recording holds too few whole revolutions.
    #[error(
        "the recording covers {} of the shaft, but at least {needed} are needed", covered(*revolutions)
    )]
    TooFewRevolutions {
        /// (rev) What is covered.
        revolutions: f64,
        /// The requirement.
        needed: usize,
    },
    /// The carrier turns too little for every tooth of a wheel to mesh in front of the sensor.
    #[error(
        "the planets pass the sensor in {revolutions} whole revolutions of the carrier, but at least {needed} are needed until every tooth has \
         been in front of it"
    )]
    TooFewPassages {
        /// (rev) Revolutions of the carrier whose passage the recording holds.
        revolutions: usize,
        /// (rev) The requirement.
        needed: usize,
    },
    /// The teeth that come to mesh in front of the sensor are so few that its windows leave gaps between them.
    #[error(
        "only {seen} of {teeth} teeth come to mesh in front of the sensor, however long the recording is, and others are never near it: the tooth \
         counts have a common factor"
    )]
    TeethNotSeen {
        /// Number of teeth that do.
        seen: usize,
        /// Teeth of the wheel.
        teeth: u32,
    },
    /// A recording that is to be continued periodically does not hold whole revolutions.
    #[error(
        "a recording can be continued periodically only if it spans whole revolutions, but this one spans {revolutions:.6}"
    )]
    NotWholeRevolutions {
        /// (rev) What is covered.
        revolutions: f64,
    },
    /// A pulse comes before the one that precedes it in the list.
    #[error("pulse {index} at {time_s} s comes before pulse {} at {previous_s} s: pulses must be in order of time", index - 1)]
    PulsesOutOfOrder {
        /// The later one in the list.
        index: usize,
        /// (s) Its time.
        time_s: f64,
        /// (s) Time of the one before.
        previous_s: f64,
    },
    /// Two pulses at the same time.
    #[error("pulses {} and {index} are both at {time_s} s: a pulse must come after the one before it", index - 1)]
    PulsesEqual {
        /// The later one in the list.
        index: usize,
        /// (s) Their time.
        time_s: f64,
    },
    /// More pulses are missing in one place than can be put in evenly without guessing the speed.
    #[error(
        "some {missing} pulses are missing between {after_s:.6} s (pulse {index}) and the next one: at most {allowed} can \
         be filled in; process the parts before and after on their own"
    )]
    PulseGap {
        /// The pulse before the gap, in the list as given.
        index: usize,
        /// (s) Its time.
        after_s: f64,
        /// Number of missing pulses, by the spacing of those around.
        missing: f64,
        /// Largest number allowed.
        allowed: usize,
    },
    /// The stated speed is not the one of the pulses.
    #[error(
        "the pulses give {found_hz:.4} Hz, but {stated_hz:.4} Hz is stated ({:+.1} %): check the speed and the number \
         of pulses per revolution", 100.0 * (stated_hz / found_hz - 1.0)
    )]
    SpeedMismatch {
        /// (Hz) Mean speed by the pulses.
        found_hz: f64,
        /// (Hz) The stated speed.
        stated_hz: f64,
    },
    /// The shaft does not turn forwards.
    #[error(
        "the shaft stands still or turns backwards at sample {sample}: its phase goes from {from_rev} to {to_rev} rev"
    )]
    NotForwards {
        /// The sample.
        sample: usize,
        /// (rev) Phase at the sample before.
        from_rev: f64,
        /// (rev) Phase at the sample.
        to_rev: f64,
    },
    /// The mesh order, or frequency, is beyond what the sampling rate shows.
    #[error(
        "mesh order {mesh_order} is beyond the Nyquist order {nyquist_order:.1}: the sampling rate is too low for this \
         speed and tooth count"
    )]
    MeshOrderBeyondNyquist {
        /// Orders of the shaft.
        mesh_order: f64,
        /// Half the samples in a revolution.
        nyquist_order: f64,
    },
    /// No tone stands out at the mesh frequency.
    #[error(
        "no mesh tone at {frequency_hz:.2} Hz ± {half_band_hz:.2} Hz: the mean power there is {ratio:.2} times the \
         noise around it, at least {needed} is needed; check the tooth count and the speed, and take the phase from a tachometer where the \
         speed changes over the recording"
    )]
    NoMeshTone {
        /// (Hz) Where it is expected.
        frequency_hz: f64,
        /// (Hz) Half width of the band.
        half_band_hz: f64,
        /// (-) Mean power in the band over the median around it.
        ratio: f64,
        /// (-) What is demanded.
        needed: f64,
    },
    /// A parameter has a value that makes no sense.
    #[error("{name} is {}, but must be {allowed}", short(*value))]
    Parameter {
        /// Name of the parameter.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The allowed values.
        allowed: &'static str,
    },
}

impl From<BearingError> for SignalError {
    fn from(BearingError { name, value, allowed }: BearingError) -> Self {
        Self::parameter(name, value, allowed)
    }
}

impl SignalError {
    pub(crate) fn parameter(name: &'static str, value: f64, allowed: &'static str) -> Self {
        Self::Parameter { name, value, allowed }
    }
}

/// A number without hundreds of zeros.
fn short(value: f64) -> String {
    let is_short = value == 0.0 || !value.is_finite() || (1e-5..1e15).contains(&value.abs());
    if is_short { value.to_string() } else { format!("{value:e}") }
}

/// A number of revolutions in words, whole ones as they were counted.
fn covered(revolutions: f64) -> String {
    match revolutions {
        1.0 => "1 whole revolution".to_owned(),
        whole if whole.fract() == 0.0 => format!("{whole} whole revolutions"),
        part => format!("{part:.3} revolutions"),
    }
}
