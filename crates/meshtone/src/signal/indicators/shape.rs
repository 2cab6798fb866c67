//! Indicators of any signal's shape.

use super::IndicatorValue;
use crate::signal::{crest_factor, kurtosis, peak, peak_to_peak, rms, skewness, standard_deviation};

/// Size and shape of a signal; `µ_k = Σ(x − x̄)ᵏ/n`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct ShapeIndicators {
    /// (the signal's unit) Root mean square, `√(Σx²/n)`, mean included.
    pub rms: f64,
    /// (the signal's unit) Largest less least value.
    pub peak_to_peak: f64,
    /// (-) Largest `|x|` over rms; none for 0.
    pub crest_factor: Option<f64>,
    /// (-) `µ₃/µ₂^1.5`; none for a constant.
    pub skewness: Option<f64>,
    /// (-) `µ₄/µ₂²`, not the excess over 3; none for a constant.
    pub kurtosis: Option<f64>,
}

impl ShapeIndicators {
    /// The indicators of a signal.
    ///
    /// # Arguments
    /// * `signal` - the signal
    ///
    /// Source of their use on gears: P. Večeř, M. Kreidl, R. Šmíd, "Condition indicators for gearbox condition monitoring
    /// systems", Acta Polytechnica 45(6) (2005) 35–43.
    ///
    /// ```
    /// let square = meshtone::signal::ShapeIndicators::new(&[2.0, -2.0, 2.0, -2.0]);
    /// assert_eq!((square.rms, square.peak_to_peak), (2.0, 4.0));
    /// assert_eq!((square.crest_factor, square.skewness, square.kurtosis), (Some(1.0), Some(0.0), Some(1.0)));
    /// ```
    pub fn new(signal: &[f64]) -> Self {
        Self {
            rms: rms(signal),
            peak_to_peak: peak_to_peak(signal),
            crest_factor: crest_factor(signal),
            skewness: skewness(signal),
            kurtosis: kurtosis(signal),
        }
    }

    /// Shape indicators of a signal that counts as constant if it varies by rounding only.
    pub(super) fn above(signal: &[f64], rounding: f64) -> Self {
        let mut indicators = Self::new(signal);
        if peak(signal) <= rounding || standard_deviation(signal) <= rounding {
            indicators.skewness = None;
            indicators.kurtosis = None;
        }
        indicators
    }

    pub(super) fn table(&self, part: &str, unit: &str) -> Vec<IndicatorValue> {
        [
            ("rms", unit, Some(self.rms)),
            ("peak_to_peak", unit, Some(self.peak_to_peak)),
            ("crest_factor", "-", self.crest_factor),
            ("skewness", "-", self.skewness),
            ("kurtosis", "-", self.kurtosis),
        ]
        .map(|(name, unit, value)| IndicatorValue::new(format!("{part}_{name}"), unit, value))
        .into()
    }
}
