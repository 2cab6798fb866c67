//! Indicators that a simulation is tuned by.

use super::{HybridError, Moments};
use crate::signal::{envelope, kurtosis, rms, skewness};

/// An indicator of the difference signal.
///
/// All but the skewnesses, which may be negative, enter as their decadic logarithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TuningIndicator {
    /// log₁₀ of the rms, over the mean rms of the healthy state.
    Rms,
    /// log₁₀ of the kurtosis µ₄/µ₂².
    Kurtosis,
    /// Skewness µ₃/µ₂^1.5.
    Skewness,
    /// log₁₀ of the rms of the envelope, over that of the healthy state.
    EnvelopeRms,
    /// log₁₀ of the kurtosis of the envelope.
    EnvelopeKurtosis,
    /// Skewness of the envelope.
    EnvelopeSkewness,
}

meshtone_toml::named!(TuningIndicator {
    Rms = "rms",
    Kurtosis = "kurtosis",
    Skewness = "skewness",
    EnvelopeRms = "envelope_rms",
    EnvelopeKurtosis = "envelope_kurtosis",
    EnvelopeSkewness = "envelope_skewness",
});

impl TuningIndicator {
    /// Returns whether the healthy state's rms is divided out.
    pub fn is_relative(self) -> bool {
        matches!(self, Self::Rms | Self::EnvelopeRms)
    }

    /// Returns whether the logarithm is taken.
    pub fn is_logarithmic(self) -> bool {
        !matches!(self, Self::Skewness | Self::EnvelopeSkewness)
    }

    /// Returns whether it is of the envelope.
    pub fn is_of_envelope(self) -> bool {
        matches!(self, Self::EnvelopeRms | Self::EnvelopeKurtosis | Self::EnvelopeSkewness)
    }

    /// The indicator of a signal, before the logarithm.
    ///
    /// # Arguments
    /// * `signal` - difference signal, one cycle
    ///
    /// # Errors
    /// A constant signal, which has no shape; NaN.
    pub fn measure(self, signal: &[f64]) -> Result<f64, HybridError> {
        let of = |signal: &[f64]| match self {
            Self::Rms | Self::EnvelopeRms => Some(rms(signal)).filter(|&rms| rms > 0.0),
            Self::Kurtosis | Self::EnvelopeKurtosis => kurtosis(signal),
            Self::Skewness | Self::EnvelopeSkewness => skewness(signal),
        };
        let value = if self.is_of_envelope() { of(&envelope(signal)?) } else { of(signal) };
        value.ok_or(HybridError::Constant { indicator: self.name() })
    }

    /// The indicator by moments, before the logarithm.
    ///
    /// # Arguments
    /// * `moments` - of the difference signal; of its envelope where [`Self::is_of_envelope`]
    pub fn of_moments(self, moments: Moments) -> f64 {
        match self {
            Self::Rms | Self::EnvelopeRms => moments.rms(),
            Self::Kurtosis | Self::EnvelopeKurtosis => moments.kurtosis(),
            Self::Skewness | Self::EnvelopeSkewness => moments.skewness(),
        }
    }

    /// The number that is compared: the logarithm where it is taken.
    ///
    /// # Arguments
    /// * `value` - as of [`Self::measure`]
    /// * `healthy` - mean over the healthy state; read where the indicator [`Self::is_relative`]
    pub fn compared(self, value: f64, healthy: f64) -> f64 {
        let value = if self.is_relative() { value / healthy } else { value };
        if self.is_logarithmic() { value.log10() } else { value }
    }
}
