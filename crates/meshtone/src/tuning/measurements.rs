//! Measurements on a rig.

use super::simulated::burst_centre_rev;
use super::{HybridError, TuningIndicator};
use crate::random::{Draws, Purpose};

/// Measured indicators of one rig, by case; they enter as [`TuningIndicator::compared`] has them.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurements {
    indicators: Vec<TuningIndicator>,
    /// Records by [case][indicator].
    records: Vec<Vec<Records>>,
    /// Whether the records of a case belong together over the indicators.
    paired: bool,
    /// Standard deviation of all records, by indicator.
    scale: Vec<f64>,
    /// Values of [`Self::typical_difference`], by case; empty where only indicators were measured.
    typical_differences: Vec<Vec<f64>>,
}

/// All records of one case and indicator.
#[derive(Debug, Clone, PartialEq)]
struct Records {
    /// In the order of measurement.
    values: Vec<f64>,
    sorted: Vec<f64>,
    /// Running sums of the sorted values; the first is 0.
    sums: Vec<f64>,
}

impl Records {
    fn new(values: Vec<f64>) -> Self {
        let mut sorted = values.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let mut sum = 0.0;
        let sums = std::iter::once(0.0)
            .chain(sorted.iter().map(|value| {
                sum += value;
                sum
            }))
            .collect();
        Self { values, sorted, sums }
    }

    /// Mean of |record − value|.
    fn mean_distance(&self, value: f64) -> f64 {
        let count = self.sorted.len();
        let below = self.sorted.partition_point(|&record| record < value);
        let to_those_below = value * below as f64 - self.sums[below];
        let to_those_above = self.sums[count] - self.sums[below] - value * (count - below) as f64;
        (to_those_below + to_those_above) / count as f64
    }

    fn median(&self) -> f64 {
        let middle = self.sorted.len() / 2;
        if self.sorted.len() % 2 == 1 {
            self.sorted[middle]
        } else {
            0.5 * (self.sorted[middle - 1] + self.sorted[middle])
        }
    }
}

impl Measurements {
    /// Measured indicators that were compared already: logarithms, relative to the healthy state.
    ///
    /// # Arguments
    /// * `indicators` - what was measured
    /// * `values` - by case (the first is the healthy one), indicator and record; the number of records may differ
    ///
    /// # Errors
    /// No indicator; a case or an indicator without records; a value that is not finite; all records of an
    /// indicator equal.
    pub fn from_compared(
        indicators: Vec<TuningIndicator>,
        values: Vec<Vec<Vec<f64>>>,
    ) -> Result<Self, HybridError> {
        Self::new(indicators, values, false)
    }

    /// Measured difference signals.
    ///
    /// # Arguments
    /// * `indicators` - what is measured on them
    /// * `signals` - by case (the first is the healthy one) and record: one cycle each, all of one length
    ///
    /// # Errors
    /// Those of [`Self::from_compared`]; a constant signal; signals of different lengths.
    pub fn from_difference_signals(
        indicators: Vec<TuningIndicator>,
        signals: &[Vec<Vec<f64>>],
    ) -> Result<Self, HybridError> {
        let length = signals.iter().flatten().map(Vec::len).next().unwrap_or(0);
        if let Some(other) = signals.iter().flatten().find(|signal| signal.len() != length) {
            return Err(HybridError::LengthMismatch { signal: other.len(), healthy: length });
        }
        let mut values = vec![Vec::new(); signals.len()];
        for &indicator in &indicators {
            let measured: Vec<Vec<f64>> = signals
                .iter()
                .map(|records| records.iter().map(|signal| indicator.measure(signal)).collect())
                .collect::<Result<_, _>>()?;
            let healthy = measured.first().map_or(1.0, |records| mean(records));
            for (case, records) in measured.into_iter().enumerate() {
                let compared = records.into_iter().map(|value| indicator.compared(value, healthy)).collect();
                values[case].push(compared);
            }
        }
        let mut measurements = Self::new(indicators, values, true)?;
        measurements.typical_differences = measurements.typical(signals)?;
        Ok(measurements)
    }

    fn new(
        indicators: Vec<TuningIndicator>,
        values: Vec<Vec<Vec<f64>>>,
        paired: bool,
    ) -> Result<Self, HybridError> {
        if indicators.is_empty() {
            return Err(HybridError::NoIndicator);
        }
        for (case, by_indicator) in values.iter().enumerate() {
            for (index, indicator) in indicators.iter().enumerate() {
                let records = by_indicator.get(index).map_or(&[][..], Vec::as_slice);
                if records.is_empty() {
                    return Err(HybridError::NoRecords { case, indicator: indicator.name() });
                }
                if let Some(record) = records.iter().position(|value| !value.is_finite()) {
                    return Err(HybridError::RecordNotANumber { case, indicator: indicator.name(), record });
                }
            }
        }
        let scale = scales(&indicators, &values)?;
        let of_case = |case: Vec<Vec<f64>>| case.into_iter().map(Records::new).collect();
        let records = values.into_iter().map(of_case).collect();
        Ok(Self { indicators, records, paired, scale, typical_differences: Vec::new() })
    }

    /// The values that [`Self::typical_difference`] returns.
    fn typical(&self, signals: &[Vec<Vec<f64>>]) -> Result<Vec<Vec<f64>>, HybridError> {
        let rms = |signal: &Vec<f64>| TuningIndicator::Rms.measure(signal);
        let healthy_rms = mean(&signals[0].iter().map(rms).collect::<Result<Vec<_>, _>>()?);
        let of_case = |(case, records): (usize, &Vec<Vec<f64>>)| {
            let mut signal = records[self.nearest_to_medians(case)].clone();
            signal.iter_mut().for_each(|value| *value /= healthy_rms);
            if case > 0 {
                let points = signal.len();
                let centre = (burst_centre_rev(&signal) * points as f64) as usize;
                signal.rotate_left((centre + points - points / 2) % points);
            }
            signal
        };
        Ok(signals.iter().enumerate().map(of_case).collect())
    }

    /// The record of a case whose indicators together are the nearest to their medians, distances in σ̂.
    fn nearest_to_medians(&self, case: usize) -> usize {
        let by_indicator = &self.records[case];
        let distance = |record: usize| -> f64 {
            let of = |(records, scale): (&Records, &f64)| {
                (records.values[record] - records.median()).abs() / scale
            };
            by_indicator.iter().zip(&self.scale).map(of).sum()
        };
        let records = 0..by_indicator[0].values.len();
        records.min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
    }

    /// The measured indicators.
    pub fn indicators(&self) -> &[TuningIndicator] {
        &self.indicators
    }

    /// Number of cases, the healthy one included.
    pub fn cases(&self) -> usize {
        self.records.len()
    }

    /// All records of one case and indicator.
    ///
    /// # Arguments
    /// * `case`, `indicator` - their numbers
    pub fn records(&self, case: usize, indicator: usize) -> &[f64] {
        &self.records[case][indicator].values
    }

    /// Median of the records of one case and indicator.
    ///
    /// # Arguments
    /// * `case`, `indicator` - their numbers
    pub fn median(&self, case: usize, indicator: usize) -> f64 {
        self.records[case][indicator].median()
    }

    /// A measured difference signal of a case to be looked at, in mean rms of the healthy records: the record whose indicators
    /// are the nearest to the case's medians. That of a faulty case is turned until the response of its fault, the centre of
    /// its fourth power, lies in the middle of the cycle. None where only indicators were measured.
    ///
    /// # Arguments
    /// * `case` - its number
    pub fn typical_difference(&self, case: usize) -> Option<&[f64]> {
        self.typical_differences.get(case).map(Vec::as_slice)
    }

    /// σ̂ of Eq. 7: standard deviation of all records of an indicator, of a sample (n − 1).
    ///
    /// # Arguments
    /// * `indicator` - its number
    pub fn scale(&self, indicator: usize) -> f64 {
        self.scale[indicator]
    }

    /// Eq. 7 for one case and indicator: mean over the records of `|CI_exp − CI_sim|/σ̂_exp`.
    ///
    /// # Arguments
    /// * `case`, `indicator` - their numbers
    /// * `simulated` - CI_sim
    pub fn error(&self, case: usize, indicator: usize, simulated: f64) -> f64 {
        self.records[case][indicator].mean_distance(simulated) / self.scale[indicator]
    }

    /// Mean error of a case over the indicators.
    ///
    /// # Arguments
    /// * `case` - its number
    /// * `simulated` - CI_sim by indicator
    pub fn case_error(&self, case: usize, simulated: &[f64]) -> f64 {
        let sum: f64 = simulated.iter().enumerate().map(|(j, &value)| self.error(case, j, value)).sum();
        sum / simulated.len() as f64
    }

    /// Mean error over the cases, each weighing the same.
    ///
    /// # Arguments
    /// * `simulated` - CI_sim by case and indicator
    pub fn mean_error(&self, simulated: &[Vec<f64>]) -> f64 {
        let errors = simulated.iter().enumerate().map(|(case, values)| self.case_error(case, values));
        errors.sum::<f64>() / simulated.len() as f64
    }

    /// The measurements' own scatter: the mean error of their medians. No simulation can be better.
    pub fn scatter(&self) -> f64 {
        (0..self.cases()).map(|case| self.case_scatter(case)).sum::<f64>() / self.cases() as f64
    }

    /// Scatter of one case.
    ///
    /// # Arguments
    /// * `case` - its number
    pub fn case_scatter(&self, case: usize) -> f64 {
        let medians: Vec<f64> = (0..self.indicators.len()).map(|j| self.median(case, j)).collect();
        self.case_error(case, &medians)
    }

    /// One bootstrap sample: cases drawn again with replacement, and records within each. σ̂ stays; there is no typical
    /// difference signal.
    ///
    /// # Arguments
    /// * `seed`, `sample` - the same numbers give the same sample
    ///
    /// Returns the records of every case, and how often each case was drawn.
    pub fn resampled(&self, seed: u64, sample: u64) -> (Self, Vec<f64>) {
        let mut draws = Draws::new(seed, Purpose::Bootstrap, sample);
        let mut one_of = |count: usize| ((draws.uniform(0.5, 0.5) * count as f64) as usize).min(count - 1);
        let mut weights = vec![0.0; self.cases()];
        (0..self.cases()).for_each(|_| weights[one_of(self.cases())] += 1.0);
        let mut again = |count: usize| -> Vec<usize> { (0..count).map(|_| one_of(count)).collect() };
        let records = self.records.iter().map(|case| {
            let together = self.paired.then(|| again(case[0].values.len()));
            case.iter()
                .map(|records| {
                    let chosen = together.clone().unwrap_or_else(|| again(records.values.len()));
                    Records::new(chosen.into_iter().map(|i| records.values[i]).collect())
                })
                .collect()
        });
        let sample = Self {
            indicators: self.indicators.clone(),
            records: records.collect(),
            paired: self.paired,
            scale: self.scale.clone(),
            typical_differences: Vec::new(),
        };
        (sample, weights)
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn scales(indicators: &[TuningIndicator], values: &[Vec<Vec<f64>>]) -> Result<Vec<f64>, HybridError> {
    let of = |(index, indicator): (usize, &TuningIndicator)| {
        let all: Vec<f64> = values.iter().flat_map(|case| case[index].iter().copied()).collect();
        let centre = mean(&all);
        let square: f64 = all.iter().map(|value| (value - centre).powi(2)).sum();
        let scale = (square / (all.len() as f64 - 1.0)).sqrt();
        if scale > 0.0 { Ok(scale) } else { Err(HybridError::NoScatter { indicator: indicator.name() }) }
    };
    indicators.iter().enumerate().map(of).collect()
}
