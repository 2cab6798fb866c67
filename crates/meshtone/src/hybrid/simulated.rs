//! Simulated difference signals of all cases, and what they would show after an enhancement.

use super::modify::check_cycle;
use super::{Enhancement, HybridError, JointMoments, TuningIndicator, WindowMoments};

/// Draws of noise over which indicators without a closed form are averaged.
const NOISE_DRAWS: u64 = 4;
/// Of those draws.
const NOISE_SEED: u64 = 0;

/// Simulated difference signals of the cases of one rig; the first is the healthy one.
#[derive(Debug, Clone)]
pub struct SimulatedCases {
    differences: Vec<Vec<f64>>,
    centre_rev: f64,
    windows: Vec<WindowMoments>,
}

impl SimulatedCases {
    /// Takes the difference signals.
    ///
    /// # Arguments
    /// * `differences` - one cycle of each case, all of one length, of the same wheels; the first is the healthy one
    ///
    /// # Errors
    /// Fewer than two cases, NaN, fewer than 4 values, different lengths, a healthy signal that is 0.
    ///
    /// ```
    /// use meshtone::hybrid::{Enhancement, SimulatedCases, TuningIndicator};
    ///
    /// let healthy: Vec<f64> = (0..1024).map(|i| (0.7 * f64::from(i)).sin()).collect();
    /// let mut broken = healthy.clone();
    /// (500..520).for_each(|i| broken[i] += 30.0 * (1.3 * i as f64).sin());
    /// let cases = SimulatedCases::new(vec![healthy, broken])?;
    /// assert!((cases.centre_rev() - 0.498).abs() < 0.003);
    /// let predicted = cases.predict(&[TuningIndicator::Kurtosis], &Enhancement::default())?;
    /// assert!(predicted[1][0] > predicted[0][0] + 1.0); // decades
    /// # Ok::<(), meshtone::hybrid::HybridError>(())
    /// ```
    pub fn new(differences: Vec<Vec<f64>>) -> Result<Self, HybridError> {
        let [healthy, faulty @ ..] = differences.as_slice() else {
            return Err(HybridError::Cases { simulated: 0, measured: 0 });
        };
        if faulty.is_empty() {
            return Err(HybridError::Cases { simulated: 1, measured: 1 });
        }
        for difference in &differences {
            check_cycle("a simulated difference signal", difference)?;
            if difference.len() != healthy.len() {
                return Err(HybridError::LengthMismatch { signal: difference.len(), healthy: healthy.len() });
            }
        }
        // A signal that is 0 cannot be what others are relative to.
        TuningIndicator::Rms.measure(healthy)?;
        let centre_rev = fault_centre_rev(healthy, faulty);
        let windows = differences
            .iter()
            .map(|difference| WindowMoments::new(difference, healthy, centre_rev))
            .collect::<Result<_, _>>()?;
        Ok(Self { differences, centre_rev, windows })
    }

    /// The signals.
    pub fn differences(&self) -> &[Vec<f64>] {
        &self.differences
    }

    /// (rev) Where the faults' responses are: the centre of every change of duration.
    pub fn centre_rev(&self) -> f64 {
        self.centre_rev
    }

    /// Indicators after an enhancement, by case and indicator, as [`TuningIndicator::compared`] has them.
    ///
    /// By the moments of what the noise is expected to give; for the envelope's, which have no closed form, the mean over
    /// a few draws.
    ///
    /// # Arguments
    /// * `indicators` - which
    /// * `enhancement` - what is changed
    ///
    /// # Errors
    /// As of [`Enhancement::without_noise`]; a signal that becomes constant.
    pub fn predict(
        &self,
        indicators: &[TuningIndicator],
        enhancement: &Enhancement,
    ) -> Result<Vec<Vec<f64>>, HybridError> {
        let mut of_envelopes = Vec::new();
        if indicators.iter().any(|indicator| indicator.is_of_envelope()) {
            of_envelopes = self.envelopes(indicators, enhancement)?;
        }
        let windows = self.at_width(enhancement.width_ratio);
        let mut predicted = vec![Vec::with_capacity(indicators.len()); windows.len()];
        for (j, &indicator) in indicators.iter().enumerate() {
            for (case, values) in predicted.iter_mut().enumerate() {
                values.push(match closed_form(indicator, &windows, case, enhancement) {
                    Some(value) => value,
                    None => of_envelopes[case][j],
                });
            }
        }
        Ok(predicted)
    }

    pub(super) fn at_width(&self, width_ratio: f64) -> Vec<JointMoments> {
        self.windows.iter().map(|window| window.at_width(width_ratio)).collect()
    }

    /// Means over draws of noise, by case and indicator.
    fn envelopes(
        &self,
        indicators: &[TuningIndicator],
        enhancement: &Enhancement,
    ) -> Result<Vec<Vec<f64>>, HybridError> {
        let mut healthy = Vec::new();
        let mut predicted = Vec::new();
        for (case, difference) in self.differences.iter().enumerate() {
            let enhanced = enhancement.without_noise(difference, &self.differences[0], self.centre_rev)?;
            let draws: Vec<Vec<f64>> = (0..NOISE_DRAWS)
                .map(|draw| enhanced.with_noise(NOISE_SEED, case as u64 * NOISE_DRAWS + draw))
                .collect::<Result<_, _>>()?;
            let mean = |indicator: TuningIndicator| {
                let values: Result<Vec<f64>, _> = draws.iter().map(|draw| indicator.measure(draw)).collect();
                values.map(|values| values.iter().sum::<f64>() / values.len() as f64)
            };
            let means: Vec<f64> = indicators.iter().map(|&j| mean(j)).collect::<Result<_, _>>()?;
            if case == 0 {
                healthy.clone_from(&means);
            }
            let compared = indicators.iter().zip(means).zip(&healthy);
            predicted.push(compared.map(|((j, value), &healthy)| j.compared(value, healthy)).collect());
        }
        Ok(predicted)
    }
}

/// An indicator by moments, where it has a closed form.
pub(super) fn closed_form(
    indicator: TuningIndicator,
    windows: &[JointMoments],
    case: usize,
    enhancement: &Enhancement,
) -> Option<f64> {
    let square = windows[0].healthy_square();
    let variance = enhancement.noise_level.powi(2) * square;
    let moments = windows[case].mixed(enhancement.fault_to_harmonics_ratio).with_noise(variance);
    let value = indicator.of_moments(moments)?;
    Some(indicator.compared(value, (square + variance).sqrt()))
}

/// (rev) Where faults show: the centre on the circle of the fourth power of what they add.
fn fault_centre_rev(healthy: &[f64], faulty: &[Vec<f64>]) -> f64 {
    let points = healthy.len() as f64;
    let (mut cosine, mut sine) = (0.0, 0.0);
    for signal in faulty {
        for (i, (x, h)) in signal.iter().zip(healthy).enumerate() {
            let angle = std::f64::consts::TAU * (i as f64 + 0.5) / points;
            let weight = (x - h).powi(4);
            cosine += weight * angle.cos();
            sine += weight * angle.sin();
        }
    }
    (sine.atan2(cosine) / std::f64::consts::TAU).rem_euclid(1.0)
}
