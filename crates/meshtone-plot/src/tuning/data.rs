//! The data of the figure.

use meshtone::tuning::{
    Enhancement, Experiment, ExperimentResult, HybridError, Measurements, SimulatedCases, Tuning,
    TuningIndicator,
};

use crate::PlotError;

/// Draws of noise whose spread is shown.
pub(super) const DRAWS: u64 = 20;
/// Cases whose difference signals there is room for.
const MOST_SIGNALS: usize = 9;

pub(super) struct Data<'a> {
    pub(super) experiment: &'a Experiment,
    pub(super) result: &'a ExperimentResult,
    pub(super) tuning: &'a Tuning,
    /// Difference signals of the original simulation, in healthy rms, the faults' responses in the middle.
    pub(super) original_signals: Vec<Vec<f64>>,
    /// Enhanced difference signals, with one draw of noise.
    pub(super) enhanced_signals: Vec<Vec<f64>>,
    /// A measured difference signal of each case, likewise; none where only indicators were measured.
    pub(super) measured_signals: Option<Vec<&'a [f64]>>,
    /// Lowest and highest enhanced indicator over the draws, by case and indicator.
    pub(super) spread: Vec<Vec<[f64; 2]>>,
}

impl<'a> Data<'a> {
    pub(super) fn new(experiment: &'a Experiment, result: &'a ExperimentResult) -> Result<Self, PlotError> {
        let measured = experiment.measured.cases();
        let tunings = [&result.enhancement_alone, result.tuning()];
        let counts = tunings
            .iter()
            .flat_map(|tuning| [tuning.original.len(), tuning.enhanced.len(), tuning.left_out.len()]);
        let signals = [&result.original, result.simulated()].map(|cases| cases.differences().len());
        let mut counts = counts.chain(signals).chain([experiment.cases.len()]);
        if let Some(simulated) = counts.find(|&count| count != measured) {
            return Err(HybridError::Cases { simulated, measured }.into());
        }
        let tuning = result.tuning();
        let original = signals_of(&result.original, &Enhancement::default(), experiment.seed, 1)?;
        let enhanced = signals_of(result.simulated(), &tuning.enhancement, experiment.seed, DRAWS)?;
        let first = |cases: &[Vec<Vec<f64>>]| cases.iter().map(|draws| draws[0].clone()).collect();
        Ok(Self {
            experiment,
            result,
            tuning,
            original_signals: first(&original),
            enhanced_signals: first(&enhanced),
            measured_signals: (0..measured)
                .map(|case| experiment.measured.typical_difference(case))
                .collect(),
            spread: spread(&experiment.measured, &enhanced)?,
        })
    }

    /// The measured indicators that there is room for: as many as there are kinds.
    pub(super) fn indicators(&self) -> &[TuningIndicator] {
        let all = self.measured().indicators();
        &all[..all.len().min(TuningIndicator::ALL.len())]
    }

    pub(super) fn measured(&self) -> &Measurements {
        &self.experiment.measured
    }

    pub(super) fn cases(&self) -> usize {
        self.experiment.cases.len()
    }

    /// Numbers of the cases whose signals are shown: all, or some at equal distances with the first and the last.
    pub(super) fn shown_cases(&self) -> Vec<usize> {
        let cases = self.cases();
        if cases <= MOST_SIGNALS {
            return (0..cases).collect();
        }
        let gaps = MOST_SIGNALS - 1;
        (0..=gaps).map(|k| (k * (cases - 1) + gaps / 2) / gaps).collect()
    }
}

/// Signals by case and draw of the noise, over the healthy rms that is expected.
fn signals_of(
    simulated: &SimulatedCases,
    enhancement: &Enhancement,
    seed: u64,
    draws: u64,
) -> Result<Vec<Vec<Vec<f64>>>, HybridError> {
    let differences = simulated.differences();
    differences
        .iter()
        .enumerate()
        .map(|(case, difference)| {
            let enhanced = enhancement.without_noise(difference, &differences[0], simulated.centre_rev())?;
            let unit = enhanced.healthy_rms * (1.0 + enhancement.noise_level.powi(2)).sqrt();
            (0..draws)
                .map(|draw| {
                    let signal = enhanced.with_noise(seed, case as u64 * draws + draw)?;
                    Ok(signal.into_iter().map(|value| value / unit).collect())
                })
                .collect()
        })
        .collect()
}

fn spread(measured: &Measurements, signals: &[Vec<Vec<f64>>]) -> Result<Vec<Vec<[f64; 2]>>, HybridError> {
    let mut healthy = Vec::new();
    signals
        .iter()
        .map(|draws| {
            let values: Vec<Vec<f64>> = measured
                .indicators()
                .iter()
                .map(|indicator| draws.iter().map(|signal| indicator.measure(signal)).collect())
                .collect::<Result<_, _>>()?;
            if healthy.is_empty() {
                healthy =
                    values.iter().map(|values| values.iter().sum::<f64>() / values.len() as f64).collect();
            }
            let ends = |(j, values): (usize, &Vec<f64>)| {
                let compared =
                    values.iter().map(|&value| measured.indicators()[j].compared(value, healthy[j]));
                compared.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
                    [low.min(value), high.max(value)]
                })
            };
            Ok(values.iter().enumerate().map(ends).collect())
        })
        .collect()
}
