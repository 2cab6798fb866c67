//! Extremely randomised trees: probabilities of classes, by the votes of many trees.

use meshtone::random::{Draws, Purpose};
use rayon::prelude::*;

use crate::LearnError;

/// Trees that vote.
const TREES: u64 = 200;
/// (-) Splits that are drawn at each node, of which the best counts, over the number of features. Most features tell nothing of most damage, so that with few
/// draws those that do would rarely be among them (the source, section 3.2); a feature may be drawn twice.
const TRIED: f64 = 0.3;
/// Fewest rows of a leaf.
const LEAST_LEAF: usize = 2;

/// Extremely randomised trees.
///
/// A tree asks for the order of numbers, not for their distances: rows beyond all examples, such as recordings are, are not extrapolated.
///
/// Source: P. Geurts, D. Ernst, L. Wehenkel, "Extremely randomized trees", Machine Learning 63 (2006) 3.
#[derive(Debug, Clone, PartialEq)]
pub struct ExtraTrees {
    trees: Vec<Vec<Node>>,
}

#[derive(Debug, Clone, PartialEq)]
enum Node {
    /// Rows whose feature is above the threshold go on at `above`, the others at the next node.
    Split { feature: usize, threshold: f64, above: usize },
    /// (-) The share of each class.
    Leaf(Vec<f64>),
}

impl ExtraTrees {
    /// Grows the trees.
    ///
    /// # Arguments
    /// * `rows` - numbers of the examples, all as many and finite
    /// * `classes` - the class of each, from 0
    /// * `weights` - what an example of each class counts
    /// * `seed` - of the draws
    ///
    /// # Errors
    /// No rows.
    pub fn learn(
        rows: &[Vec<f64>],
        classes: &[usize],
        weights: &[f64],
        seed: u64,
    ) -> Result<Self, LearnError> {
        if rows.is_empty() {
            return Err(LearnError::TooFewRows);
        }
        let grow = |tree: u64| {
            let draws = Draws::new(seed, Purpose::Trees, tree);
            let mut growing = Growing { rows, classes, weights, draws, nodes: Vec::new() };
            growing.grow((0..rows.len()).collect());
            growing.nodes
        };
        Ok(Self { trees: (0..TREES).into_par_iter().map(grow).collect() })
    }

    /// (-) The probability of each class.
    ///
    /// # Arguments
    /// * `row` - numbers, as many as the examples had
    pub fn probabilities(&self, row: &[f64]) -> Vec<f64> {
        let mut sum: Vec<f64> = Vec::new();
        for tree in &self.trees {
            let mut at = 0;
            while let Node::Split { feature, threshold, above } = &tree[at] {
                at = if row[*feature] > *threshold { *above } else { at + 1 };
            }
            if let Node::Leaf(shares) = &tree[at] {
                sum.resize(shares.len(), 0.0);
                sum.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share / self.trees.len() as f64);
            }
        }
        sum
    }
}

/// A tree that grows.
struct Growing<'a> {
    rows: &'a [Vec<f64>],
    classes: &'a [usize],
    weights: &'a [f64],
    draws: Draws,
    nodes: Vec<Node>,
}

impl Growing<'_> {
    /// Adds a node for some examples, and all below it.
    fn grow(&mut self, examples: Vec<usize>) {
        let sums = self.sums(&examples);
        let total: f64 = sums.iter().sum();
        let is_pure = sums.contains(&total);
        let split = if is_pure || examples.len() < 2 * LEAST_LEAF { None } else { self.split(&examples) };
        let Some((feature, threshold)) = split else {
            self.nodes.push(Node::Leaf(sums.iter().map(|sum| sum / total).collect()));
            return;
        };
        let (above, below) = examples.into_iter().partition(|&row| self.rows[row][feature] > threshold);
        let at = self.nodes.len();
        self.nodes.push(Node::Split { feature, threshold, above: 0 });
        self.grow(below);
        let next = self.nodes.len();
        if let Some(Node::Split { above, .. }) = self.nodes.get_mut(at) {
            *above = next;
        }
        self.grow(above);
    }

    /// The best of some random splits, each of a feature at a random place between its ends.
    fn split(&mut self, examples: &[usize]) -> Option<(usize, f64)> {
        let width = self.rows[0].len();
        let (mut best, mut best_gain) = (None, f64::NEG_INFINITY);
        for _ in 0..(TRIED * width as f64).ceil() as usize {
            let feature = (self.draws.bits() % width as u64) as usize;
            let part = self.draws.uniform(0.5, 0.5);
            let values = examples.iter().map(|&row| self.rows[row][feature]);
            let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| {
                (least.min(value), most.max(value))
            });
            let threshold = least + part * (most - least);
            let (above, below): (Vec<usize>, Vec<usize>) =
                examples.iter().partition(|&&row| self.rows[row][feature] > threshold);
            if above.len().min(below.len()) < LEAST_LEAF {
                continue;
            }
            // Gini's impurity falls as this rises.
            let purity = |part: &[usize]| {
                let sums = self.sums(part);
                sums.iter().map(|sum| sum * sum).sum::<f64>() / sums.iter().sum::<f64>()
            };
            let gain = purity(&above) + purity(&below);
            if gain > best_gain {
                (best, best_gain) = (Some((feature, threshold)), gain);
            }
        }
        best
    }

    /// The weight of each class among some examples.
    fn sums(&self, examples: &[usize]) -> Vec<f64> {
        let mut sums = vec![0.0; self.weights.len()];
        examples.iter().for_each(|&row| sums[self.classes[row]] += self.weights[self.classes[row]]);
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two of three numbers tell the class by whether both are above 0, which no line does; beyond the examples the answer stays.
    #[test]
    fn trees_learn_a_corner_and_keep_it_beyond_the_examples() {
        let mut draws = Draws::new(1, Purpose::Trees, 0);
        let rows: Vec<Vec<f64>> =
            (0..600).map(|_| (0..3).map(|_| draws.uniform(0.0, 1.0)).collect()).collect();
        let of = |row: &[f64]| usize::from(row[0] > 0.0 && row[1] > 0.0);
        let classes: Vec<usize> = rows.iter().map(|row| of(row)).collect();
        let trees = ExtraTrees::learn(&rows[..400], &classes[..400], &[1.0, 1.0], 1).unwrap();
        let right = (400..600).filter(|&row| {
            let probabilities = trees.probabilities(&rows[row]);
            assert!((probabilities.iter().sum::<f64>() - 1.0).abs() < 1e-9);
            (probabilities[1] > 0.5) == (classes[row] == 1)
        });
        assert!(right.count() > 180);
        assert!(trees.probabilities(&[9.0, 7.0, 0.0])[1] > 0.8);
        assert_eq!(trees, ExtraTrees::learn(&rows[..400], &classes[..400], &[1.0, 1.0], 1).unwrap());
        assert!(ExtraTrees::learn(&[], &[], &[1.0], 1).is_err());
    }
}
