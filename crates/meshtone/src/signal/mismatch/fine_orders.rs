//! The order spectrum of many revolutions at once, which shows what lies between the shaft's orders.

use std::f64::consts::TAU;

use meshtone_fourier::{convenient_count, real_spectrum};

use crate::signal::{AngularSignal, upper_median};

/// Most values that are transformed: more would take longer than the rest of the chain.
const MOST_VALUES: usize = 1 << 19;
/// Fewest revolutions that are looked at, however many values they have.
const FEWEST_REVOLUTIONS: usize = 8;
/// Bins on each side of a line that hold it under Hann's window.
const LOBE: usize = 2;
/// Part of the Nyquist order up to which lines are right.
const PASSED: f64 = 0.8;
/// Highest order of a comb's lines.
const HIGHEST_ORDER: f64 = 400.0;
/// Bins that hold one maximum.
const BLOCK: usize = 16;
/// Least and largest logarithm of a mesh line over its strongest neighbour that counts: one line must not decide alone.
const PROMINENCES: (f64, f64) = (-1.0, 3.0);
/// Energy of a line over the median of its surroundings, from which on it is hardly noise.
const LINE: f64 = 8.0;
/// Largest logarithm of a comb's line over the noise floor, likewise.
const LARGEST_CONTRAST: f64 = 2.0;
/// Mean and standard deviation of that logarithm in noise.
const NOISE_CONTRAST: (f64, f64) = (-0.048, 0.605);
/// Blocks on each side of a line's own whose median is the noise floor.
const FLOOR_BLOCKS: usize = 2;
/// Fewest bins between a comb's lines, and fewest lines.
const LEAST_COMB: (f64, usize) = (6.0, 3);

/// The values of as many revolutions as can be transformed quickly.
pub(super) fn affordable(angular: &AngularSignal) -> Option<&[f64]> {
    let points = angular.points_per_revolution;
    let affordable = (MOST_VALUES / points.max(1)).max(FEWEST_REVOLUTIONS);
    let revolutions = convenient_count(angular.revolutions().min(affordable));
    angular.values.get(..revolutions * points)
}

/// Energies of lines at fine steps of the order.
pub(super) struct FineOrders {
    /// Bins of an order: revolutions that were transformed.
    pub(super) bins_per_order: f64,
    /// Energy of a line in each bin.
    lines: Vec<f64>,
    /// The largest of each block of them.
    largest: Vec<f64>,
    /// The median of each of these blocks.
    medians: Vec<f64>,
    /// The logarithms of the lines.
    logarithms: Vec<f64>,
    /// The logarithm of the noise floor in each block.
    floors: Vec<f64>,
}

impl FineOrders {
    /// Of as many revolutions as can be transformed quickly. None where there is nothing to see.
    pub(super) fn of(angular: &AngularSignal) -> Option<Self> {
        let points = angular.points_per_revolution;
        let values = affordable(angular)?;
        let revolutions = values.len() / points.max(1);
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        let step = TAU / values.len().max(1) as f64;
        let windowed: Vec<f64> = values
            .iter()
            .enumerate()
            .map(|(i, value)| (value - mean) * 0.5 * (1.0 - (step * i as f64).cos()))
            .collect();
        let highest = PASSED * angular.nyquist_order.min(0.5 * points as f64);
        let bins = (highest * revolutions as f64) as usize;
        let power: Vec<f64> =
            real_spectrum(&windowed).iter().take(bins + LOBE + 1).map(|x| x.norm_sqr()).collect();
        if power.len() <= 2 * BLOCK {
            return None;
        }
        let line = |bin: usize| {
            power[bin.saturating_sub(LOBE)..(bin + LOBE + 1).min(power.len())].iter().sum::<f64>()
        };
        let lines: Vec<f64> = (0..power.len() - LOBE).map(line).collect();
        let strongest = lines.iter().copied().fold(0.0, f64::max);
        if strongest <= 0.0 {
            return None;
        }
        let of_comb = lines.len().min(((HIGHEST_ORDER + 1.0) * revolutions as f64) as usize);
        let floor = |block: usize| {
            let from = block.saturating_sub(FLOOR_BLOCKS) * BLOCK;
            upper_median(&lines[from..((block + FLOOR_BLOCKS + 1) * BLOCK).min(lines.len())])
        };
        Some(Self {
            // What is nothing but rounding has no shape.
            floors: (0..of_comb.div_ceil(BLOCK))
                .map(|block| (floor(block) + 1e-24 * strongest).ln())
                .collect(),
            bins_per_order: revolutions as f64,
            largest: lines.chunks(BLOCK).map(|block| block.iter().copied().fold(0.0, f64::max)).collect(),
            medians: lines.chunks(BLOCK).map(upper_median).collect(),
            logarithms: lines.iter().take(of_comb).map(|line| (line + 1e-24 * strongest).ln()).collect(),
            lines,
        })
    }

    /// Highest order that is shown.
    pub(super) fn highest_order(&self) -> f64 {
        self.lines.len() as f64 / self.bins_per_order
    }

    fn bin(&self, order: f64) -> usize {
        (order * self.bins_per_order).round() as usize
    }

    /// Logarithm of the energy of the line at an order over that of its strongest neighbour. None where the neighbours cannot
    /// be stated from it, or lie beyond what the recording shows.
    ///
    /// # Arguments
    /// * `order` - of the line
    /// * `reach` - (orders) how far the neighbours are
    pub(super) fn prominence(&self, order: f64, reach: f64) -> Option<f64> {
        const APART: usize = 2 * LOBE + 1;
        let (bin, reach) = (self.bin(order), self.bin(reach));
        if reach < APART + 3 || bin < APART + LOBE || bin + APART + 1 >= self.lines.len() {
            return None;
        }
        let below = self.strongest(bin.saturating_sub(reach).max(LOBE + 1), bin - APART);
        let above = self.strongest(bin + APART, (bin + reach).min(self.lines.len() - 1));
        let neighbour = below.max(above);
        let own = self.lines[bin - 1..=bin + 1].iter().copied().fold(0.0, f64::max);
        let (least, largest) = PROMINENCES;
        if neighbour <= 0.0 {
            return None;
        }
        // Where nothing is but noise a harmonic is weak, which says nothing of its order.
        let is_noise = || neighbour < LINE * self.median(bin.saturating_sub(reach), bin + reach);
        let prominence = (own / neighbour).ln().clamp(least, largest);
        Some(if prominence < 0.0 && is_noise() { 0.0 } else { prominence })
    }

    /// About the median of a range of bins: that of its blocks' medians.
    fn median(&self, from: usize, to: usize) -> f64 {
        let (first, last) = (from / BLOCK, (to / BLOCK).min(self.medians.len() - 1));
        upper_median(&self.medians[first.min(last)..=last])
    }

    /// The strongest line of a range of bins, its ends included.
    fn strongest(&self, from: usize, to: usize) -> f64 {
        let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        let (first, last) = (from.div_ceil(BLOCK), (to + 1) / BLOCK);
        if from > to {
            return 0.0;
        }
        if first >= last {
            return largest(&self.lines[from..=to]);
        }
        largest(&self.lines[from..first * BLOCK])
            .max(largest(&self.largest[first..last]))
            .max(largest(&self.lines[last * BLOCK..=to]))
    }

    /// Height of the multiples of an order above the noise floor about each, in standard deviations of noise. None where they
    /// cannot be distinguished.
    ///
    /// # Arguments
    /// * `spacing` - the order
    /// * `known` - other orders, whose multiples are left out
    pub(super) fn comb(&self, spacing: f64, known: &[f64]) -> Option<f64> {
        let (least_spacing, fewest) = LEAST_COMB;
        if spacing * self.bins_per_order < least_spacing {
            return None;
        }
        let clear = |order: f64| {
            let apart = |known: f64| ((order / known).round() * known - order).abs() * self.bins_per_order;
            known.iter().all(|known| apart(*known) > (2 * LOBE + 1) as f64)
        };
        let highest = (self.logarithms.len() as f64 / self.bins_per_order - 1.0).min(HIGHEST_ORDER);
        let contrast = |multiple: usize| {
            let order = Some(multiple as f64 * spacing).filter(|order| clear(*order))?;
            Some(self.contrast(order)?.clamp(-LARGEST_CONTRAST, LARGEST_CONTRAST))
        };
        let multiples = (highest / spacing) as usize;
        let contrasts: Vec<f64> = (1..=multiples).filter_map(contrast).collect();
        let noise = NOISE_CONTRAST.1 * (contrasts.len() as f64).sqrt();
        (contrasts.len() >= fewest).then(|| contrasts.iter().sum::<f64>() / noise)
    }

    /// Logarithm of the energy of the line at an order over the noise floor about it, less its mean in noise.
    pub(super) fn contrast(&self, order: f64) -> Option<f64> {
        let bin = self.bin(order);
        Some(self.logarithms.get(bin)? - self.floors.get(bin / BLOCK)? - NOISE_CONTRAST.0)
    }

    /// Energy of the line at an order.
    pub(super) fn energy(&self, order: f64) -> Option<f64> {
        self.lines.get(self.bin(order)).copied()
    }

    /// Returns whether multiples of an order can be distinguished, also from those of the shaft.
    pub(super) fn resolves(&self, spacing: f64) -> bool {
        spacing * self.bins_per_order > (2 * (2 * LOBE + 1)) as f64
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::random::{Draws, Purpose};

    #[test]
    fn a_comb_in_noise_scores_a_standard_deviation() {
        let mut draws = Draws::new(1, Purpose::DiagnosisNoise, 0);
        let values: Vec<f64> = (0..128 * 1024).map(|_| draws.normal()).collect();
        let angular =
            AngularSignal { points_per_revolution: 1024, start_rev: 0.0, nyquist_order: 512.0, values };
        let orders = FineOrders::of(&angular).unwrap();
        let all: Vec<f64> =
            (10..40_000).step_by(7).filter_map(|bin| orders.contrast(bin as f64 / 128.0)).collect();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        let deviation = (all.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / all.len() as f64).sqrt();
        assert!(mean.abs() < 0.05 && (deviation / NOISE_CONTRAST.1 - 1.0).abs() < 0.05, "{mean} {deviation}");
    }
}
