//! Other interpretations of a recording.

use super::fine_orders::FineOrders;
use super::{Alternative, CLEAR_MESH, Evidence, StatedFacts, StatedTurning};
use crate::operation::greatest_common_divisor;
use crate::signal::foreign_tones::is_of_mains;

/// Mesh harmonics that are looked at, of the teeth that are stated: other counts have theirs in the same range, so that a multiple
/// of the right one has fewer.
pub(super) const HARMONICS: u32 = 8;
/// Most harmonics of any count.
const MOST_HARMONICS: u32 = 12;
/// (shaft orders) How far beside a mesh line its neighbours are looked for.
pub(super) const SIDEBANDS: f64 = 4.5;
/// Fewest teeth of a wheel.
const FEWEST_TEETH: u32 = 6;
/// Pulses in a revolution that encoders and marks on shafts have.
const USUAL_PULSES: [u32; 31] = [
    1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 16, 20, 24, 30, 32, 36, 48, 50, 60, 64, 72, 90, 100, 120, 128, 180, 250,
    256, 360, 500, 512,
];
/// Part by which a stated speed may be off.
const SPEED_RANGE: f64 = 0.06;
/// Least order up to which the steps of the speed are fine enough, even where the recording does not show it.
const LEAST_HIGHEST_ORDER: f64 = 1000.0;
/// Steps of a comb's speed in one of the mesh lines'.
const FINER: i32 = 16;
/// Harmonics that hum has.
const MAINS_HARMONICS: f64 = 8.0;
/// (bins) Distance from a harmonic of hum at which a line may be it.
const MAINS_BINS: f64 = 2.0;
/// (bins) Distance of orders that are one line.
pub(super) const SAME_LINE: f64 = 1.5;

/// An interpretation of the recording. Orders are those of the shaft as it is stated.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hypothesis {
    /// The fact that it assumes.
    pub(super) alternative: Alternative,
    /// Order at which teeth mesh.
    pub(super) mesh_order: f64,
    /// Order at which the averaged wheel turns.
    pub(super) wheel_spacing: f64,
    /// The orders at which the shafts turn.
    combs: [Option<f64>; 2],
    /// Highest order at which mesh lines are looked for.
    highest_order: f64,
}

impl Hypothesis {
    /// The hypothesis that the stated facts are right.
    pub(super) fn as_stated(stated: &StatedFacts) -> Self {
        Self::with_teeth(stated, stated.teeth, stated.mate_teeth)
    }

    fn with_teeth(stated: &StatedFacts, teeth: u32, mate_teeth: Option<u32>) -> Self {
        let ratio = mate_teeth.map(|mate_teeth| f64::from(teeth) / f64::from(mate_teeth));
        Self {
            alternative: Alternative::Teeth { teeth },
            mesh_order: f64::from(teeth),
            wheel_spacing: 1.0,
            combs: [Some(1.0), ratio],
            highest_order: f64::from(HARMONICS * stated.teeth),
        }
    }

    /// The hypothesis that the shaft turns `factor` times as quickly as it is stated.
    fn scaled(stated: &StatedFacts, factor: f64, alternative: Alternative) -> Self {
        let stated = Self::as_stated(stated);
        Self {
            alternative,
            mesh_order: factor * stated.mesh_order,
            wheel_spacing: factor,
            combs: stated.combs.map(|comb| comb.map(|order| factor * order)),
            highest_order: stated.highest_order * factor.max(1.0),
        }
    }

    /// The hypothesis that speed or pulses are those of the mate's shaft, and that this wheel has `mate_teeth`.
    fn of_mates_shaft(teeth: u32, mate_teeth: u32) -> Self {
        let ratio = f64::from(mate_teeth) / f64::from(teeth);
        Self {
            alternative: Alternative::OtherShaft { mate_teeth },
            mesh_order: f64::from(mate_teeth),
            wheel_spacing: ratio,
            combs: [Some(1.0), Some(ratio)],
            highest_order: f64::from(HARMONICS * teeth),
        }
    }

    /// Likelihood of the mistake before the recording is looked at, in units of the evidence.
    ///
    /// # Arguments
    /// * `may_be_speed` - whether other teeth are stated from another speed by nothing, which names the teeth as well
    pub(super) fn prior(&self, may_be_speed: bool) -> f64 {
        match self.alternative {
            Alternative::Teeth { .. } if may_be_speed => -1.0,
            Alternative::OtherShaft { .. } => 2.0,
            Alternative::PulsesPerRevolution { .. } | Alternative::Teeth { .. } => 1.0,
            Alternative::MateTeeth { .. }
            | Alternative::ShaftSpeed { .. }
            | Alternative::VaryingSpeed { .. } => 0.0,
        }
    }

    /// Returns whether it moves the orders of both shafts.
    pub(super) fn moves_wheel(&self) -> bool {
        matches!(self.alternative, Alternative::PulsesPerRevolution { .. } | Alternative::ShaftSpeed { .. })
    }

    /// Returns whether its mesh would be at a multiple of a mains frequency, whose hum has harmonics as a mesh has; known of a constant speed.
    pub(super) fn is_of_mains(&self, stated: &StatedFacts, orders: &FineOrders) -> bool {
        let StatedTurning::ConstantSpeed { speed_hz } = stated.turning else { return false };
        if !matches!(self.alternative, Alternative::Teeth { .. } | Alternative::ShaftSpeed { .. }) {
            return false;
        }
        let near_hz = MAINS_BINS * speed_hz / orders.bins_per_order;
        is_of_mains(self.mesh_order * speed_hz, MAINS_HARMONICS, near_hz)
    }

    /// Orders of the mesh harmonics with their prominences.
    pub(super) fn mesh_lines<'a>(
        &self,
        orders: &'a FineOrders,
    ) -> impl Iterator<Item = (f64, f64)> + use<'a> {
        let (mesh_order, reach) = (self.mesh_order, self.reach());
        let highest_order = self.highest_order * (1.0 + 1e-9);
        let all = (1..=MOST_HARMONICS).map(move |harmonic| f64::from(harmonic) * mesh_order);
        all.take_while(move |order| *order <= highest_order)
            .map_while(move |order| Some((order, orders.prominence(order, reach)?)))
    }

    /// (orders) How far beside a mesh line its neighbours are looked for: the sidebands of the shaft that is stated, and of the
    /// wheel's where that turns more quickly because pulses are miscounted.
    pub(super) fn reach(&self) -> f64 {
        let of_wheel = if self.moves_wheel() { SIDEBANDS * self.wheel_spacing } else { 0.0 };
        of_wheel.max(SIDEBANDS.min(0.6 * self.mesh_order))
    }

    /// Returns whether so many mesh lines stand out that the orders are as steady as the mesh needs them.
    pub(super) fn stands_out(&self, orders: &FineOrders) -> bool {
        const ENOUGH: usize = 2;
        self.mesh_lines(orders).filter(|(_, prominence)| *prominence > 0.0).count() >= ENOUGH
    }

    fn mesh(&self, orders: &FineOrders) -> f64 {
        self.mesh_lines(orders).map(|(_, prominence)| prominence).sum()
    }

    /// The evidence for it beside orders that are known: those do not count for the mate's shaft, nor do the wheel's own.
    pub(super) fn evidence_beside(&self, orders: &FineOrders, known: &[f64]) -> Evidence {
        let [first, second] = self.combs;
        let known: Vec<f64> = first.into_iter().chain(known.iter().copied()).collect();
        Evidence {
            mesh: self.mesh(orders),
            wheel_orders: first.and_then(|spacing| orders.comb(spacing, &[])),
            mate_orders: second.and_then(|spacing| orders.comb(spacing, &known)),
        }
    }

    /// The orders that a pair excites beside those of the wheel: the mate's, and those of the hunting tooth, 1/q where the tooth
    /// counts are as p to q in lowest terms, where the recording is long enough to distinguish them.
    pub(super) fn orders_of_pair(stated: &StatedFacts, orders: &FineOrders) -> Vec<f64> {
        let Some(mate_teeth) = stated.mate_teeth else { return Vec::new() };
        let period = mate_teeth / greatest_common_divisor(stated.teeth, mate_teeth).max(1);
        let hunting = 1.0 / f64::from(period.max(1));
        let of_mate = f64::from(stated.teeth) / f64::from(mate_teeth);
        if orders.resolves(hunting) { vec![hunting] } else { vec![of_mate] }
    }

    /// Returns whether the first line of its mate's shaft is far weaker than the stated mate's.
    pub(super) fn has_weak_mate(&self, stated: &Self, orders: &FineOrders) -> bool {
        match (self.combs[1], stated.combs[1]) {
            (Some(own), Some(stated)) => is_far_weaker(own, stated, orders),
            _ => false,
        }
    }

    /// Returns whether it is of a mate with half as many teeth as another, nearer to the stated one, whose orders are then hunting-tooth orders
    /// of this pair.
    pub(super) fn explains_mate_of(&self, other: &Self, stated: &StatedFacts) -> bool {
        match (self.alternative, other.alternative) {
            (
                Alternative::MateTeeth { teeth: own, stated: said },
                Alternative::MateTeeth { teeth: other, .. },
            ) => {
                let period = own / greatest_common_divisor(stated.teeth, own).max(1);
                // In ratio: of 80 and 160 the former is nearer to 81.
                let is_nearer = u64::from(own) * u64::from(other) > u64::from(said).pow(2);
                other == 2 * own && is_nearer && (stated.teeth * period).is_multiple_of(other)
            }
            _ => false,
        }
    }

    /// Returns whether its shaft turns a whole part as quickly as the stated one, and what it then has beside the stated orders is
    /// missing or the pair's own: the wheel's orders, and a first mesh line, or several that are clear.
    pub(super) fn is_part_without_lines(&self, stated: &Self, of_pair: &[f64], orders: &FineOrders) -> bool {
        const LEAST: f64 = 3.0;
        let parts = 1.0 / self.wheel_spacing;
        if parts < 1.5 || (parts - parts.round()).abs() > 1e-9 {
            return false;
        }
        let known: Vec<f64> = of_pair.iter().copied().chain([1.0]).collect();
        if self.unshared_mesh(stated, &known, orders).is_some_and(|new| new > CLEAR_MESH) {
            return false;
        }
        orders.comb(self.wheel_spacing, &known).is_none_or(|score| score < LEAST)
            || is_far_weaker(self.mesh_order, stated.mesh_order, orders)
    }

    /// Sum of the prominences of its mesh lines that are neither the other hypothesis's nor multiples of known orders; none where there is no
    /// such line.
    pub(super) fn unshared_mesh(&self, other: &Self, known: &[f64], orders: &FineOrders) -> Option<f64> {
        let is_own = |order: f64| {
            let is_apart = |spacing: f64| {
                let multiple = (order / spacing).round().max(1.0);
                (multiple * spacing - order).abs() * orders.bins_per_order >= SAME_LINE
            };
            is_apart(other.mesh_order) && known.iter().all(|spacing| is_apart(*spacing))
        };
        let own: Vec<f64> = self
            .mesh_lines(orders)
            .filter(|(order, _)| is_own(*order))
            .map(|(_, prominence)| prominence)
            .collect();
        (!own.is_empty()).then(|| own.iter().sum())
    }
}

/// Returns whether the line at an order has less than a hundredth of the energy of another.
fn is_far_weaker(order: f64, other: f64, orders: &FineOrders) -> bool {
    const FAR_WEAKER: f64 = 1e-2;
    matches!((orders.energy(order), orders.energy(other)), (Some(own), Some(other)) if own < FAR_WEAKER * other)
}

/// All hypotheses that are compared with the stated facts.
pub(super) fn alternatives<'a>(
    stated: &'a StatedFacts,
    orders: &'a FineOrders,
) -> impl Iterator<Item = Hypothesis> + 'a {
    let other_teeth =
        other_counts(stated.teeth).map(|teeth| Hypothesis::with_teeth(stated, teeth, stated.mate_teeth));
    let other_mates = stated.mate_teeth.into_iter().flat_map(move |mate_teeth| {
        other_counts(mate_teeth).map(move |teeth| Hypothesis {
            alternative: Alternative::MateTeeth { teeth, stated: mate_teeth },
            ..Hypothesis::with_teeth(stated, stated.teeth, Some(teeth))
        })
    });
    let other_shaft = stated
        .mate_teeth
        .filter(|mate_teeth| *mate_teeth != stated.teeth)
        .map(|mate_teeth| Hypothesis::of_mates_shaft(stated.teeth, mate_teeth));
    let turning: Vec<Hypothesis> = match stated.turning {
        StatedTurning::Pulses { per_revolution } => other_pulses(stated, per_revolution),
        StatedTurning::ConstantSpeed { speed_hz } => other_speeds(stated, speed_hz, orders),
        StatedTurning::MeshTone { .. } | StatedTurning::Other => Vec::new(),
    };
    other_shaft.into_iter().chain(turning).chain(other_teeth).chain(other_mates)
}

/// Tooth counts between half of one and twice it.
fn other_counts(teeth: u32) -> impl Iterator<Item = u32> {
    (FEWEST_TEETH.max(teeth / 2 + 1)..2 * teeth).filter(move |other| *other != teeth)
}

/// Numbers of pulses in a revolution that may be meant instead of a stated one.
///
/// # Arguments
/// * `per_revolution` - the stated number
/// * `teeth` - of the wheels, one pulse of each tooth
pub(super) fn pulse_counts(per_revolution: u32, teeth: impl IntoIterator<Item = u32>) -> Vec<u32> {
    let near = [-2, -1, 1, 2].into_iter().filter_map(|by| per_revolution.checked_add_signed(by));
    let multiples = [2, 3, 4].into_iter().filter_map(|by| per_revolution.checked_mul(by));
    let parts =
        [2, 3, 4].into_iter().filter(|by| per_revolution.is_multiple_of(*by)).map(|by| per_revolution / by);
    let mut counts: Vec<u32> =
        USUAL_PULSES.into_iter().chain(near).chain(multiples).chain(parts).chain(teeth).collect();
    counts.sort_unstable();
    counts.dedup();
    counts.retain(|&count| count > 0 && count != per_revolution);
    counts
}

fn other_pulses(stated: &StatedFacts, per_revolution: u32) -> Vec<Hypothesis> {
    let of_wheels = [Some(stated.teeth), stated.mate_teeth].into_iter().flatten();
    let hypothesis = |pulses: u32| {
        let factor = f64::from(per_revolution) / f64::from(pulses);
        Hypothesis::scaled(
            stated,
            factor,
            Alternative::PulsesPerRevolution { pulses, stated: per_revolution },
        )
    };
    pulse_counts(per_revolution, of_wheels).into_iter().map(hypothesis).collect()
}

/// The speeds within some percent at which the mesh lines stand out most, and at which the wheel's orders do.
fn other_speeds(stated: &StatedFacts, speed_hz: f64, orders: &FineOrders) -> Vec<Hypothesis> {
    // Two bins of the highest harmonic, as wide as its line; none is read far beyond what the recording shows.
    let highest = f64::from(HARMONICS * stated.teeth).min(orders.highest_order().max(LEAST_HIGHEST_ORDER));
    let step = 2.0 / (highest * orders.bins_per_order);
    let steps = (SPEED_RANGE / step) as i32;
    let hypothesis = |factor: f64| {
        let alternative = Alternative::ShaftSpeed { speed_hz: factor * speed_hz, stated_hz: speed_hz };
        Hypothesis::scaled(stated, factor, alternative)
    };
    let best = |hypotheses: &[Hypothesis], of: &dyn Fn(&Hypothesis) -> f64| {
        let all = hypotheses.iter().map(|hypothesis| (of(hypothesis), hypothesis));
        all.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, hypothesis)| *hypothesis)
    };
    let wheel_orders = |hypothesis: &Hypothesis| orders.comb(hypothesis.wheel_spacing, &[]).unwrap_or(0.0);
    let coarse: Vec<Hypothesis> =
        (-steps..=steps).filter(|k| *k != 0).map(|k| hypothesis(1.0 + f64::from(k) * step)).collect();
    let by_mesh = best(&coarse, &|hypothesis| hypothesis.mesh(orders));
    // Combs reach to higher orders than the mesh lines, and are as much finer.
    let by_wheel = best(&coarse, &wheel_orders).and_then(|coarse| {
        let finer = |k: i32| hypothesis(coarse.wheel_spacing + f64::from(k) * step / f64::from(FINER));
        best(&(-FINER..=FINER).map(finer).collect::<Vec<_>>(), &wheel_orders)
    });
    by_mesh.into_iter().chain(by_wheel).collect()
}
