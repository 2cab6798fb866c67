//! Simulated difference signals of all cases, and what they would show after an enhancement.

use super::envelopes::WindowEnvelopes;
use super::modify::check_cycle;
use super::{Enhancement, HybridError, JointMoments, TuningIndicator, WindowMoments};

/// Simulated difference signals of the cases of one rig; the first is the healthy one.
#[derive(Debug, Clone)]
pub struct SimulatedCases {
    differences: Vec<Vec<f64>>,
    centre_rev: f64,
    windows: Vec<WindowMoments>,
    envelopes: Vec<WindowEnvelopes>,
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
    /// use meshtone::tuning::{Enhancement, SimulatedCases, TuningIndicator};
    ///
    /// let healthy: Vec<f64> = (0..1024).map(|i| (0.7 * f64::from(i)).sin()).collect();
    /// let mut broken = healthy.clone();
    /// (500..520).for_each(|i| broken[i] += 30.0 * (1.3 * i as f64).sin());
    /// let cases = SimulatedCases::new(vec![healthy, broken])?;
    /// assert!((cases.centre_rev() - 0.498).abs() < 0.003);
    /// let predicted = cases.predict(&[TuningIndicator::Kurtosis], &Enhancement::default())?;
    /// assert!(predicted[1][0] > predicted[0][0] + 1.0); // decades
    /// # Ok::<(), meshtone::tuning::HybridError>(())
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
        let envelopes = differences
            .iter()
            .map(|difference| WindowEnvelopes::new(difference, healthy, centre_rev))
            .collect::<Result<_, _>>()?;
        Ok(Self { differences, centre_rev, windows, envelopes })
    }

    /// The signals.
    pub fn differences(&self) -> &[Vec<f64>] {
        &self.differences
    }

    /// The signals alone, of which everything else follows.
    pub(super) fn into_differences(self) -> Vec<Vec<f64>> {
        self.differences
    }

    /// (rev) Where the faults' responses are: the centre of every change of duration.
    pub fn centre_rev(&self) -> f64 {
        self.centre_rev
    }

    /// Indicators that are expected after an enhancement, by case and indicator, as [`TuningIndicator::compared`] has them:
    /// those of the moments that the noise is expected to give.
    ///
    /// # Arguments
    /// * `indicators` - which
    /// * `enhancement` - what is changed
    ///
    /// # Errors
    /// A width ratio that is not above 0, a noise level below 0, a number that is not finite; an indicator that is not a number,
    /// such as the kurtosis of a constant signal.
    pub fn predict(
        &self,
        indicators: &[TuningIndicator],
        enhancement: &Enhancement,
    ) -> Result<Vec<Vec<f64>>, HybridError> {
        enhancement.check()?;
        let at_duration = self.at_duration(indicators, enhancement.width_ratio);
        let mut predicted = vec![Vec::with_capacity(indicators.len()); self.differences.len()];
        for (case, values) in predicted.iter_mut().enumerate() {
            at_duration.indicators(case, enhancement, |_, value| values.push(value));
            if let Some(j) = values.iter().position(|value| !value.is_finite()) {
                return Err(HybridError::Constant { indicator: indicators[j].name() });
            }
        }
        Ok(predicted)
    }

    /// The cases after a change of duration.
    ///
    /// # Arguments
    /// * `indicators` - that are asked for
    /// * `width_ratio` - (-) as of [`super::change_duration`]
    pub(super) fn at_duration<'a>(
        &'a self,
        indicators: &'a [TuningIndicator],
        width_ratio: f64,
    ) -> CasesOfDuration<'a> {
        let asked = |of_envelope: bool| indicators.iter().any(|one| one.is_of_envelope() == of_envelope);
        let moments: Vec<JointMoments> =
            self.windows.iter().map(|window| window.at_duration(width_ratio)).collect();
        CasesOfDuration {
            simulated: self,
            indicators,
            width_ratio,
            of_signals: asked(false),
            of_envelopes: asked(true),
            healthy_square: moments[0].healthy_square(),
            healthy_envelope_square: self.envelopes[0].healthy_square(width_ratio),
            moments,
        }
    }
}

/// The cases after a change of duration.
pub(super) struct CasesOfDuration<'a> {
    simulated: &'a SimulatedCases,
    indicators: &'a [TuningIndicator],
    width_ratio: f64,
    of_signals: bool,
    of_envelopes: bool,
    moments: Vec<JointMoments>,
    healthy_square: f64,
    healthy_envelope_square: f64,
}

impl CasesOfDuration<'_> {
    /// Expected indicators of a case, as they are compared.
    ///
    /// # Arguments
    /// * `case` - its number
    /// * `enhancement` - of this width
    /// * `take` - given each indicator's number and value
    pub(super) fn indicators(
        &self,
        case: usize,
        enhancement: &Enhancement,
        mut take: impl FnMut(usize, f64),
    ) {
        let alpha = enhancement.fault_to_harmonics_ratio;
        let variance = enhancement.noise_level.powi(2) * self.healthy_square;
        let signal = self.of_signals.then(|| self.moments[case].mixed(alpha).with_noise(variance));
        let envelope = self
            .of_envelopes
            .then(|| self.simulated.envelopes[case].moments(self.width_ratio, alpha, variance));
        for (j, indicator) in self.indicators.iter().enumerate() {
            let (moments, healthy_square) = if indicator.is_of_envelope() {
                (envelope, self.healthy_envelope_square + 2.0 * variance)
            } else {
                (signal, self.healthy_square + variance)
            };
            let value = moments.map_or(f64::NAN, |moments| indicator.of_moments(moments));
            take(j, indicator.compared(value, healthy_square.sqrt()));
        }
    }
}

/// (rev) Where faults show: the centre of the burst of what they add.
fn fault_centre_rev(healthy: &[f64], faulty: &[Vec<f64>]) -> f64 {
    let added = faulty.iter().map(|signal| signal.iter().zip(healthy).map(|(x, h)| x - h));
    centre_of_bursts_rev(added, healthy.len())
}

/// (rev) Where the burst of a cycle is.
///
/// # Arguments
/// * `cycle` - one revolution
pub(super) fn burst_centre_rev(cycle: &[f64]) -> f64 {
    centre_of_bursts_rev(std::iter::once(cycle.iter().copied()), cycle.len())
}

/// (rev) The centre on the circle of the fourth power of cycles of so many points.
fn centre_of_bursts_rev(cycles: impl Iterator<Item: Iterator<Item = f64>>, points: usize) -> f64 {
    let (mut cosine, mut sine) = (0.0, 0.0);
    for cycle in cycles {
        for (i, value) in cycle.enumerate() {
            let angle = std::f64::consts::TAU * (i as f64 + 0.5) / points as f64;
            let weight = value.powi(4);
            cosine += weight * angle.cos();
            sine += weight * angle.sin();
        }
    }
    (sine.atan2(cosine) / std::f64::consts::TAU).rem_euclid(1.0)
}
