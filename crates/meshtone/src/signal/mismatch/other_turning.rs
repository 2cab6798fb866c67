//! Another source of the phase of a train of several meshes: the pulses or the speed are of another shaft, or so many pulses are not a revolution.

use super::fine_orders::FineOrders;
use super::hypotheses::{HARMONICS, SAME_LINE, SIDEBANDS, pulse_counts};
use super::{Alternative, CLEAR_MESH, LEAST_COMB, LEAST_MESH, LEAST_MESH_GAIN, POOR_COMB, StatedTurning};
use crate::signal::GearTrain;

/// Least gain in evidence of another number of pulses. Many are tried, and 441 right statements about 49 simulated gearboxes gave none.
const LEAST_GAIN_OF_PULSES: f64 = 15.0;
/// Least sum of prominences of the mesh lines that another number of pulses has beside the stated meshes and shafts, where its shaft orders do not
/// stand out: three lines that stand out as far as counts.
const LEAST_LINES_OF_PULSES: f64 = 9.0;
/// Gain that another shaft has from the start, since it is a likelier mistake than a number of pulses that fits alike.
const SHAFT_IS_LIKELIER: f64 = 1.0;

/// The lines of a train whose stated shaft turns `factor` times as quickly as the angle says.
struct Turning<'a> {
    orders: &'a FineOrders,
    /// (orders of the stated angle) Frequencies of the meshes.
    meshes: Vec<f64>,
    /// (orders of the stated angle) Frequencies of the shafts, the stated one first.
    shafts: Vec<f64>,
    /// (orders of the stated angle) The mesh harmonics with their prominences, those that coincide once.
    lines: Vec<(f64, f64)>,
}

impl<'a> Turning<'a> {
    fn new(orders: &'a FineOrders, train: &GearTrain, shaft: usize, factor: f64) -> Self {
        let of_input = factor * train.speed_ratio(train.input(), shaft).value();
        let meshes: Vec<f64> =
            (0..train.meshes.len()).map(|mesh| of_input * train.mesh_order(mesh)).collect();
        let others = (0..train.shafts.len()).filter(|other| *other != shaft);
        let shafts = [shaft].into_iter().chain(others);
        let of_mesh = |mesh: &f64| {
            let (mesh, reach) = (*mesh, (SIDEBANDS * factor.max(1.0)).min(0.6 * mesh));
            let harmonics = (1..=HARMONICS).map(move |harmonic| f64::from(harmonic) * mesh);
            harmonics.map_while(move |order| Some((order, orders.prominence(order, reach)?)))
        };
        let mut lines: Vec<(f64, f64)> = meshes.iter().flat_map(of_mesh).collect();
        lines.sort_by(|a, b| a.0.total_cmp(&b.0));
        lines.dedup_by(|a, b| (a.0 - b.0).abs() * orders.bins_per_order < SAME_LINE);
        Self {
            orders,
            shafts: shafts.map(|other| factor * train.speed_ratio(other, shaft).value()).collect(),
            meshes,
            lines,
        }
    }

    /// The sum of the prominences of the mesh lines.
    fn mesh(&self) -> f64 {
        self.lines.iter().map(|(_, prominence)| prominence).sum()
    }

    /// Sum of the prominences of the mesh lines that are at no multiple of other orders; 0 where there is no such line.
    fn mesh_beside<'o>(&self, others: impl Iterator<Item = &'o f64> + Clone) -> f64 {
        let is_of = |order: f64, spacing: f64| {
            let multiple = (order / spacing).round();
            multiple >= 1.0 && (multiple * spacing - order).abs() * self.orders.bins_per_order < SAME_LINE
        };
        let own =
            self.lines.iter().filter(|(order, _)| !others.clone().any(|spacing| is_of(*order, *spacing)));
        own.map(|(_, prominence)| prominence).sum()
    }

    /// Largest height of a shaft's orders beside those of another turning; 0 where none stand out.
    fn shaft_orders_beside(&self, other: &Self) -> f64 {
        let heights = self.shafts.iter().filter_map(|spacing| self.orders.comb(*spacing, &other.shafts));
        heights.fold(0.0, f64::max)
    }

    /// The evidence that it has beyond that for the stated turning, where it is clearly more.
    ///
    /// Lines that only the stated turning has must not stand out, and lines that only this one has must stand out: mesh lines, or orders of a shaft.
    /// Where it has no line of its own, because the shaft turns a whole multiple as quickly as stated, all of its mesh lines must stand out.
    ///
    /// # Arguments
    /// * `stated` - the stated turning
    /// * `factor` - how quickly the stated shaft turns, over what is stated
    /// * `is_pulses` - whether it is another number of pulses, which needs more
    fn gain_if_clear(&self, stated: &Self, factor: f64, is_pulses: bool) -> Option<f64> {
        let lost_lines = stated.mesh_beside(self.meshes.iter());
        let lost_orders = stated.shaft_orders_beside(self);
        if lost_lines > 0.0 || lost_orders > POOR_COMB {
            return None;
        }
        let new_lines = self.mesh_beside(stated.meshes.iter());
        let new_orders = self.shaft_orders_beside(stated);
        let gain = new_lines - lost_lines + new_orders - lost_orders;
        let mesh = self.mesh();
        let is_whole = (factor - factor.round()).abs() < 1e-9;
        let beside = || self.mesh_beside(stated.meshes.iter().chain(&stated.shafts));
        let is_clear = if is_whole && mesh > CLEAR_MESH {
            true
        } else if is_pulses {
            gain > LEAST_GAIN_OF_PULSES
                && new_lines >= lost_lines
                && (new_orders > LEAST_COMB || beside() > LEAST_LINES_OF_PULSES)
        } else {
            new_orders > LEAST_COMB || new_lines > LEAST_MESH_GAIN && mesh > LEAST_MESH
        };
        is_clear.then_some(gain)
    }
}

/// Returns whether the lines of all meshes of a train together speak for another speed, and not only those of one.
///
/// # Arguments
/// * `orders`, `train`, `shaft` - as of [`other_turning`]
/// * `factor` - the speed over the stated one
pub(super) fn meshes_together_speak_for(
    factor: f64,
    orders: &FineOrders,
    train: &GearTrain,
    shaft: usize,
) -> bool {
    let [other, stated] = [factor, 1.0].map(|factor| Turning::new(orders, train, shaft, factor).mesh());
    other - stated > LEAST_MESH_GAIN
}

/// Looks for the shaft, or the number of pulses, that fits a recording clearly better than what is stated.
///
/// # Arguments
/// * `orders` - of the recording, over the stated angle
/// * `train` - of several meshes
/// * `shaft` - number of the shaft whose angle is stated
/// * `turning` - the source from which its angle is known
///
/// # Returns
/// What is right, and the number of the shaft that speed or pulses are of, where it is another one.
pub(super) fn other_turning(
    orders: &FineOrders,
    train: &GearTrain,
    shaft: usize,
    turning: StatedTurning,
) -> Option<(Alternative, Option<usize>)> {
    let as_stated = Turning::new(orders, train, shaft, 1.0);
    let shafts = (0..train.shafts.len()).filter_map(|other| {
        let teeth = train.teeth_on(other).next()?;
        let factor = train.speed_ratio(shaft, other).value();
        Some((factor, Alternative::OtherShaft { mate_teeth: teeth }, Some(other)))
    });
    let pulses = match turning {
        StatedTurning::Pulses { per_revolution } => {
            let of_wheels = train.wheels.iter().map(|wheel| wheel.teeth);
            let counts = pulse_counts(per_revolution, of_wheels).into_iter();
            let other = move |pulses: u32| {
                let factor = f64::from(per_revolution) / f64::from(pulses);
                (factor, Alternative::PulsesPerRevolution { pulses, stated: per_revolution }, None)
            };
            counts.map(other).collect()
        }
        _ => Vec::new(),
    };
    let better = shafts.chain(pulses).filter(|(factor, ..)| *factor != 1.0);
    let better = better.filter_map(|(factor, alternative, of_shaft)| {
        let other = Turning::new(orders, train, shaft, factor);
        let likelier = if of_shaft.is_some() { SHAFT_IS_LIKELIER } else { 0.0 };
        let gain = other.gain_if_clear(&as_stated, factor, of_shaft.is_none())? + likelier;
        Some((gain, (alternative, of_shaft)))
    });
    better.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, better)| better)
}
