//! A race as a comb of lines, and how strongly a spectrum has it.

use super::bands::BandSpectra;
use super::lines::{DefectKind, SLIP};
use crate::bearing::DefectOrders;

/// Harmonics of a race that are looked at together.
const HARMONICS: i32 = 5;
/// (-) Weight of a harmonic over that of the one before, and of a sideband over that of the one nearer to the harmonic.
const WEIGHTS: (f64, f64) = (0.8, 0.5);
/// Harmonics and sidebands on either side in which nothing else is looked for once a comb is found.
const EXPLAINED: (i32, i32) = (9, 3);
/// (resolved lines) A line and a shaft's whole order reach so far on either side, and shafts of whose whole orders two are closer leave nothing between.
const WIDTH: (f64, f64) = (1.6, 8.0);
/// (-) Random slip widens a line by so much of its order on either side.
const WIDENED: f64 = 0.003;
/// (orders) Below this, the envelope has what drifts.
const LOWEST: f64 = 0.25;
/// (orders of the shaft) Orders at which combs are tried.
const TRIED: (f64, f64) = (1.3, 13.0);
/// Combs that are tried between two lines: the fifth harmonic moves by more than one.
const TRIED_A_LINE: f64 = 3.0;
/// Bands whose mean is the score: a resonance is in bands of several widths, chance in one.
const BANDS: usize = 4;

/// A race with its lines, in orders of the shaft in its bearing's inner ring.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Comb {
    pub race: DefectKind,
    /// The bearings that it may be of, by their places.
    pub bearings: Vec<usize>,
    /// Number of its shaft among those that have bearings.
    pub shaft: usize,
    pub order: f64,
    /// Distance of the sidebands: what turns the place of the defect through the load, or an imbalance over it.
    beside: f64,
}

impl Comb {
    /// The comb of a race.
    ///
    /// # Arguments
    /// * `race` - which
    /// * `orders` - of the bearing
    /// * `bearing`, `shaft` - their numbers
    pub fn new(race: DefectKind, orders: &DefectOrders, bearing: usize, shaft: usize) -> Self {
        let beside = if race == DefectKind::Element { orders.cage } else { 1.0 };
        Self { race, bearings: vec![bearing], shaft, order: race.order(orders), beside }
    }

    /// The same comb at another order.
    ///
    /// # Arguments
    /// * `order` - where
    pub fn at(&self, order: f64) -> Self {
        Self { order, ..self.clone() }
    }

    /// Whether it is of the same race, so near that slip may take one for the other.
    ///
    /// # Arguments
    /// * `other` - the other comb
    pub fn is_like(&self, other: &Self) -> bool {
        let is_near = |one: f64, other: f64| (one / other - 1.0).abs() <= SLIP;
        (self.race, self.shaft) == (other.race, other.shaft)
            && is_near(self.order, other.order)
            && is_near(self.beside, other.beside)
    }

    /// The orders of its lines at a place, with their weights. The elements pass a defect of the outer race under the same load each time: it has no sidebands.
    fn lines(&self, order: f64) -> impl Iterator<Item = (f64, f64)> {
        let sidebands = if self.race == DefectKind::OuterRace { 0 } else { 2 };
        let beside = self.beside;
        (1..=HARMONICS).flat_map(move |harmonic| {
            (-sidebands..=sidebands).map(move |side: i32| {
                let weight = WEIGHTS.0.powi(harmonic - 1) * WEIGHTS.1.powi(side.abs());
                ((f64::from(harmonic) * order + f64::from(side) * beside).abs(), weight)
            })
        })
    }
}

/// What is left to read of the spectra of a shaft.
#[derive(Debug, Clone)]
pub(super) struct Readable<'a> {
    pub spectra: &'a BandSpectra,
    /// Whether a line is nobody's yet.
    is_free: Vec<bool>,
}

impl<'a> Readable<'a> {
    /// All but the lowest orders and the whole orders of shafts.
    ///
    /// # Arguments
    /// * `spectra` - of a shaft
    /// * `shafts` - (orders of that shaft) speeds of all shafts
    pub fn new(spectra: &'a BandSpectra, shafts: &[f64]) -> Self {
        let mut readable = Self { spectra, is_free: vec![true; spectra.lines()] };
        readable.take(0.0, LOWEST);
        let reach = WIDTH.0 / spectra.resolved;
        for shaft in shafts.iter().filter(|shaft| **shaft * spectra.resolved >= WIDTH.1) {
            let last = (spectra.lines() as f64 * spectra.step / shaft) as usize;
            (1..=last).for_each(|whole| readable.take(whole as f64 * shaft, reach));
        }
        readable
    }

    /// Takes the lines around an order.
    fn take(&mut self, order: f64, reach: f64) {
        let line = |order: f64| (order / self.spectra.step).max(0.0);
        let end = (line(order + reach).floor() as usize + 1).min(self.is_free.len());
        let from = (line(order - reach).ceil() as usize).min(end);
        self.is_free[from..end].fill(false);
    }

    /// What is left without the lines of a comb.
    ///
    /// # Arguments
    /// * `comb` - where it was found
    pub fn without(&self, comb: &Comb) -> Self {
        let mut left = self.clone();
        let (harmonics, sidebands) = EXPLAINED;
        for harmonic in 1..=harmonics {
            let at = f64::from(harmonic) * comb.order;
            for side in -sidebands..=sidebands {
                let reach = WIDTH.0 / self.spectra.resolved + WIDENED * at;
                left.take((at + f64::from(side) * comb.beside).abs(), reach);
            }
        }
        left
    }

    /// Number of the line at an order; none where it is taken or beyond the spectra.
    fn line(&self, order: f64) -> Option<usize> {
        let line = (order / self.spectra.step).round() as usize;
        self.is_free.get(line).copied().unwrap_or(false).then_some(line)
    }

    /// Whether at least half of the weight of a comb can be read.
    ///
    /// # Arguments
    /// * `comb`, `order` - where
    pub fn reads(&self, comb: &Comb, order: f64) -> bool {
        let (mut read, mut all) = (0.0, 0.0);
        for (order, weight) in comb.lines(order) {
            all += weight;
            read += self.line(order).map_or(0.0, |_| weight);
        }
        read >= 0.5 * all
    }

    /// How strong a comb is in each band: the weighted sum of how far its lines stand out, without the largest: one tone is no comb.
    fn in_bands(&self, comb: &Comb, order: f64) -> Vec<f64> {
        let bands = self.spectra.bands.len();
        let (mut sums, mut largest) = (vec![0.0; bands], vec![f64::MIN; bands]);
        for (order, weight) in comb.lines(order) {
            let Some(line) = self.line(order) else { continue };
            for ((sum, largest), standing) in
                sums.iter_mut().zip(&mut largest).zip(self.spectra.standing(line))
            {
                let part = weight * standing;
                *sum += part;
                *largest = f64::max(*largest, part);
            }
        }
        sums.iter_mut().zip(largest).filter(|(_, of)| *of > f64::MIN).for_each(|(sum, of)| *sum -= of);
        sums
    }

    /// The band in which a comb is strongest.
    ///
    /// # Arguments
    /// * `comb` - where it was found
    pub fn strongest_band(&self, comb: &Comb) -> usize {
        let strengths = self.in_bands(comb, comb.order);
        (0..strengths.len()).max_by(|a, b| strengths[*a].total_cmp(&strengths[*b])).unwrap_or(0)
    }

    /// The scores of a comb at all orders that are tried: the mean of its strengths in the bands in which it is strongest.
    ///
    /// # Arguments
    /// * `comb` - which lines
    pub fn scores(&self, comb: &Comb) -> Scores {
        let step = self.spectra.step / TRIED_A_LINE;
        let count = ((TRIED.1 - TRIED.0) / step) as usize;
        let score = |at: usize| {
            let mut strengths = self.in_bands(comb, TRIED.0 + at as f64 * step);
            strengths.sort_unstable_by(|a, b| b.total_cmp(a));
            strengths.truncate(BANDS);
            strengths.iter().sum::<f64>() / strengths.len().max(1) as f64
        };
        Scores { step, scores: (0..count).map(score).collect() }
    }
}

/// Scores of a comb at many orders.
pub(super) struct Scores {
    step: f64,
    scores: Vec<f64>,
}

impl Scores {
    /// The places at which a comb is as near to an order as slip may move it.
    fn near(&self, order: f64) -> std::ops::Range<usize> {
        let place = |order: f64| ((order - TRIED.0) / self.step).max(0.0).ceil() as usize;
        let end = place((1.0 + SLIP) * order).min(self.scores.len());
        place((1.0 - SLIP) * order).min(end)..end
    }

    /// The order and the score of the strongest comb near an order.
    ///
    /// # Arguments
    /// * `order` - from 1.3 to 13
    pub fn best_near(&self, order: f64) -> Option<(f64, f64)> {
        let strongest = self.near(order).max_by(|a, b| self.scores[*a].total_cmp(&self.scores[*b]))?;
        Some((TRIED.0 + strongest as f64 * self.step, self.scores[strongest]))
    }

    /// Middles of windows of slip over all orders that are tried, side by side.
    pub fn windows() -> impl Iterator<Item = f64> {
        let first = TRIED.0 * (1.0 + SLIP);
        (0..)
            .map(move |at| first * (1.0 + SLIP).powi(at))
            .take_while(|middle| middle * (1.0 + SLIP) < TRIED.1)
    }
}
