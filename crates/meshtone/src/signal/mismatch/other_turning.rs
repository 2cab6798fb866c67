//! Another source of the phase of a train of several meshes: the pulses or the speed are of another shaft, or so many pulses are not a revolution.

use super::fine_orders::FineOrders;
use super::hypotheses::{HARMONICS, SAME_LINE, SIDEBANDS, pulse_counts};
use super::{Alternative, CLEAR_MESH, Evidence, LEAST_COMB, LEAST_MESH_GAIN, POOR_COMB, StatedTurning};
use crate::signal::GearTrain;

/// Least gain in evidence of another shaft, of which there are few.
const LEAST_GAIN_OF_SHAFT: f64 = 8.0;
/// The same of another number of pulses, of which many are tried.
const LEAST_GAIN_OF_PULSES: f64 = 15.0;
/// What the gain of another shaft counts more, since it is a likelier mistake than a number of pulses that fits alike.
const SHAFT_IS_LIKELIER: f64 = 1.0;
/// Least sum of prominences of the mesh lines that another number of pulses has beside the stated meshes and shafts, where its shaft orders do not
/// stand out.
const LEAST_LINES_OF_PULSES: f64 = 9.0;

/// A better source with its evidence, and that of the stated one.
#[derive(Debug, Clone, Copy)]
pub(super) struct OtherTurning {
    pub(super) alternative: Alternative,
    pub(super) evidence: Evidence,
    pub(super) stated_evidence: Evidence,
    /// By how much the evidence is more than the stated one's, of what only one of them has.
    gain: f64,
}

/// The lines of a train whose stated shaft turns `factor` times as quickly as the angle says.
struct Turning<'a> {
    orders: &'a FineOrders,
    /// (orders of the stated angle) Frequencies of the meshes.
    meshes: Vec<f64>,
    /// (orders of the stated angle) Frequencies of the shafts, the stated one first.
    shafts: Vec<f64>,
}

impl<'a> Turning<'a> {
    fn new(orders: &'a FineOrders, train: &GearTrain, shaft: usize, factor: f64) -> Self {
        let of_input = factor * train.speed_ratio(train.input(), shaft).value();
        let others = (0..train.shafts.len()).filter(|other| *other != shaft);
        let shafts = [shaft].into_iter().chain(others);
        Self {
            orders,
            meshes: (0..train.meshes.len()).map(|mesh| of_input * train.mesh_order(mesh)).collect(),
            shafts: shafts.map(|other| factor * train.speed_ratio(other, shaft).value()).collect(),
        }
    }

    /// Orders of the mesh harmonics with their prominences.
    fn mesh_lines(&self) -> impl Iterator<Item = (f64, f64)> {
        self.meshes.iter().flat_map(move |mesh| {
            let reach = (SIDEBANDS * self.shafts[0].max(1.0)).min(0.6 * mesh);
            let harmonics = (1..=HARMONICS).map(move |harmonic| f64::from(harmonic) * mesh);
            harmonics.map_while(move |order| Some((order, self.orders.prominence(order, reach)?)))
        })
    }

    fn evidence(&self) -> Evidence {
        Evidence {
            mesh: self.mesh_lines().map(|(_, prominence)| prominence).sum(),
            wheel_orders: self.orders.comb(self.shafts[0], &[]),
            mate_orders: None,
        }
    }

    /// Sum of the prominences of the mesh lines that are at no multiple of other orders; 0 where there is no such line.
    fn mesh_beside<'o>(&self, others: impl Iterator<Item = &'o f64> + Clone) -> f64 {
        let is_of = |order: f64, spacing: f64| {
            let multiple = (order / spacing).round();
            multiple >= 1.0 && (multiple * spacing - order).abs() * self.orders.bins_per_order < SAME_LINE
        };
        let own =
            self.mesh_lines().filter(|(order, _)| !others.clone().any(|spacing| is_of(*order, *spacing)));
        own.map(|(_, prominence)| prominence).sum()
    }

    /// Largest height of a shaft's orders beside those of another turning; 0 where none stand out.
    fn shaft_orders_beside(&self, other: &Self) -> f64 {
        let heights = self.shafts.iter().filter_map(|spacing| self.orders.comb(*spacing, &other.shafts));
        heights.fold(0.0, f64::max)
    }

    /// The evidence that it has beyond that for the stated turning, where it is clearly more.
    ///
    /// What only the stated turning has must not stand out. What only this one has must stand out clearly; where it has nothing of its own, because
    /// the shaft turns a whole multiple as quickly as stated, all of its mesh lines must.
    ///
    /// # Arguments
    /// * `stated` - the stated turning
    /// * `factor` - how quickly the stated shaft turns, over what is stated
    /// * `is_pulses` - whether it is another number of pulses
    fn gain_if_clear(&self, stated: &Self, factor: f64, is_pulses: bool) -> Option<f64> {
        let lost_lines = stated.mesh_beside(self.meshes.iter());
        let lost_orders = stated.shaft_orders_beside(self);
        if lost_lines > 0.0 || lost_orders > POOR_COMB {
            return None;
        }
        let new_lines = self.mesh_beside(stated.meshes.iter());
        let new_orders = self.shaft_orders_beside(stated);
        let gain = new_lines - lost_lines + new_orders - lost_orders;
        let is_whole = (factor - factor.round()).abs() < 1e-9;
        let has_own = || {
            let beside = || self.mesh_beside(stated.meshes.iter().chain(&stated.shafts));
            let is_clear = if is_pulses {
                gain > LEAST_GAIN_OF_PULSES && (new_orders > LEAST_COMB || beside() > LEAST_LINES_OF_PULSES)
            } else {
                gain > LEAST_GAIN_OF_SHAFT
            };
            is_clear && new_lines >= lost_lines
        };
        (is_whole && self.evidence().mesh > CLEAR_MESH || has_own()).then_some(gain)
    }
}

/// Whether the lines of all meshes of a train speak for another speed, and not only those of one.
///
/// # Arguments
/// * `orders`, `train`, `shaft` - as of [`other_turning`]
/// * `factor` - the speed over the stated one
pub(super) fn all_meshes_speak_for(
    factor: f64,
    orders: &FineOrders,
    train: &GearTrain,
    shaft: usize,
) -> bool {
    let [other, stated] =
        [factor, 1.0].map(|factor| Turning::new(orders, train, shaft, factor).evidence().mesh);
    other - stated > LEAST_MESH_GAIN
}

/// Looks for the shaft, or the number of pulses, that fits a recording clearly better than what is stated.
///
/// # Arguments
/// * `orders` - of the recording, over the stated angle
/// * `train` - of several meshes
/// * `shaft` - number of the shaft whose angle is stated
/// * `turning` - the source from which its angle is known
pub(super) fn other_turning(
    orders: &FineOrders,
    train: &GearTrain,
    shaft: usize,
    turning: StatedTurning,
) -> Option<OtherTurning> {
    let as_stated = Turning::new(orders, train, shaft, 1.0);
    let stated_evidence = as_stated.evidence();
    let shafts = (0..train.shafts.len()).filter_map(|other| {
        let teeth = train.teeth_on(other).next()?;
        let factor = train.speed_ratio(shaft, other).value();
        Some((factor, Alternative::ShaftOfTrain { teeth }))
    });
    let pulses = match turning {
        StatedTurning::Pulses { per_revolution } => {
            let of_wheels = train.wheels.iter().map(|wheel| wheel.teeth);
            let counts = pulse_counts(per_revolution, of_wheels).into_iter();
            let other = move |pulses: u32| {
                let factor = f64::from(per_revolution) / f64::from(pulses);
                (factor, Alternative::PulsesPerRevolution { pulses, stated: per_revolution })
            };
            counts.map(other).collect()
        }
        _ => Vec::new(),
    };
    let better =
        shafts.chain(pulses).filter(|(factor, _)| *factor != 1.0).filter_map(|(factor, alternative)| {
            let is_pulses = matches!(alternative, Alternative::PulsesPerRevolution { .. });
            let other = Turning::new(orders, train, shaft, factor);
            let gain = other.gain_if_clear(&as_stated, factor, is_pulses)?
                + if is_pulses { 0.0 } else { SHAFT_IS_LIKELIER };
            Some(OtherTurning { alternative, evidence: other.evidence(), stated_evidence, gain })
        });
    better.max_by(|a, b| a.gain.total_cmp(&b.gain))
}
