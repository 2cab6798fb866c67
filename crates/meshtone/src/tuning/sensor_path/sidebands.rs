//! Sidebands of the meshes over a cycle of the train: how strong they are beside their own harmonics, which no path changes much.

use meshtone_fourier::real_spectrum;

use super::drive::factor_of;
use crate::scenario::{Coupled, GearboxShaft, Ripple, Scenario};
use crate::signal::{
    AngularSignal, GearTrain, SignalError, synchronous_average, synchronous_part, upper_median,
};

/// Orders of a shaft that are looked at.
const MOST_ORDER: usize = 4;
/// (-) Power of a harmonic over that of what does not repeat, from which on its sidebands are looked at.
const ABOVE_REST: f64 = 20.0;
/// Fewest sidebands that say how strong they are.
const FEWEST: usize = 8;
/// (-) Least factor of sidebands without a cause, with its interval, from which on they are named: of some ten orders one or two have intervals
/// that begin a little above 1.
const UNEXPLAINED: f64 = 1.5;
/// (orders) How near to another one an order is the same.
pub(super) const SAME: f64 = 1e-9;

/// Sidebands at a distance of one order of a shaft from the mesh harmonics, of a recording and of the simulations.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RecordedSidebands {
    /// Name of the shaft: of several with this order the first.
    pub shaft: String,
    /// Order of the shaft.
    pub order: usize,
    /// (-) Median amplitude over that of their own harmonic, of the recording and of the mean simulation.
    pub level: [f64; 2],
    /// (-) By what those of the simulations are to be multiplied, and the interval of 90 % over draws of the wheels.
    pub factor: [f64; 3],
    /// What the scenario has at this order.
    pub cause: SidebandCause,
}

/// What makes sidebands of an order in a scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SidebandCause {
    /// The torque varies so, `operation.torque_ripple`; of a shaft's own order its wheels' errors too.
    Torque,
    /// The wheels' errors, of a shaft's own order: `run_out_share` and `slope_wobble`.
    Wheels,
    /// Nothing that is stated.
    Nothing,
}

impl RecordedSidebands {
    /// Whether the recording has more of them than draws of the wheels explain, and the scenario nothing that makes them.
    pub fn is_unexplained(&self) -> bool {
        self.cause == SidebandCause::Nothing && self.factor[1] > UNEXPLAINED
    }
}

/// A shaft's order at which sidebands are looked for.
pub(super) struct SidebandOrder {
    shaft: usize,
    order: usize,
    /// (orders of the input)
    of_input: f64,
}

/// The orders of all shafts, each once.
pub(super) fn sideband_orders(train: &GearTrain) -> Vec<SidebandOrder> {
    let mut orders: Vec<SidebandOrder> = Vec::new();
    let speed = |shaft: usize| train.shafts[shaft].speed_ratio.value();
    for order in 1..=MOST_ORDER {
        for shaft in 0..train.shafts.len() {
            let of_input = order as f64 * speed(shaft);
            if !orders.iter().any(|known| (known.of_input - of_input).abs() < SAME) {
                orders.push(SidebandOrder { shaft, order, of_input });
            }
        }
    }
    orders
}

/// What repeats in a signal after each cycle of the train.
pub(super) struct RepeatedLines {
    /// (-) Its part of the power, of which noise leaves nothing on average.
    pub(super) share: f64,
    /// (-) Of each of [`sideband_orders`], the median level; none where too few stand out.
    pub(super) levels: Vec<Option<f64>>,
}

impl RepeatedLines {
    /// Of a signal over whole cycles; none of a constant one.
    ///
    /// # Arguments
    /// * `angular` - the signal, a cycle a revolution
    /// * `train` - its tooth counts
    /// * `cycle` - revolutions of the input in a cycle
    ///
    /// # Errors
    /// Those of the average.
    pub(super) fn of(
        angular: &AngularSignal,
        train: &GearTrain,
        cycle: usize,
    ) -> Result<Option<Self>, SignalError> {
        let count = angular.revolutions();
        let average = synchronous_average(angular)?;
        let Some(part) = synchronous_part(&angular.values, &average.values) else { return Ok(None) };
        let cycles = count as f64;
        let share = ((part.of_mean_square * cycles - 1.0) / (cycles - 1.0)).clamp(1e-6, 1.0);
        let spectrum = real_spectrum(&angular.values[..count * angular.points_per_revolution]);
        let most_order = angular.points_per_revolution as f64 / (2 * cycle) as f64;
        let power = |line: usize| spectrum.get(line).map_or(0.0, |value| value.norm_sqr());
        // Between the lines of the cycles lies what does not repeat.
        let rest = |line: usize| {
            let beside = (1..count).flat_map(|apart| [line.saturating_sub(apart), line + apart]);
            beside.map(power).sum::<f64>() / (2.0 * (cycles - 1.0))
        };
        let line_of = |order: f64| (order * cycle as f64).round() as usize * count;
        let level = |of: &SidebandOrder| {
            let mut squares = Vec::new();
            // Those of other shafts are not modulated by it, or by way of its own.
            let is_on =
                |mesh: &usize| train.meshes[*mesh].iter().any(|wheel| train.wheels[*wheel].shaft == of.shaft);
            for mesh in (0..train.meshes.len()).filter(is_on) {
                let mesh_order = train.mesh_order(mesh);
                let is_below = |harmonic: &f64| harmonic * mesh_order + of.of_input < most_order;
                for centre in (1..).map(f64::from).take_while(is_below).map(|harmonic| harmonic * mesh_order)
                {
                    let (line, apart) = (line_of(centre), line_of(of.of_input));
                    let harmonic = power(line) - rest(line);
                    if harmonic > ABOVE_REST * rest(line) {
                        let beside = [line.saturating_sub(apart), line + apart];
                        squares.extend(beside.map(|line| (power(line) - rest(line)).max(0.0) / harmonic));
                    }
                }
            }
            (squares.len() >= FEWEST).then(|| upper_median(&squares).sqrt())
        };
        Ok(Some(Self { share, levels: sideband_orders(train).iter().map(level).collect() }))
    }
}

/// (orders of the input) The order of a ripple of the torque.
///
/// # Arguments
/// * `ripple` - the ripple
/// * `scenario`, `train` - of the machine
pub(super) fn ripple_order(ripple: &Ripple, scenario: &Scenario, train: &GearTrain) -> f64 {
    let named = train.shafts.iter().position(|shaft| Some(&shaft.name) == ripple.shaft.as_ref());
    // Without a name it is the brake's: of a rig the gear's.
    let is_brakes = |shaft: &GearboxShaft| shaft.couples_to == Coupled::Brake;
    let of_brake = || scenario.shafts().iter().position(is_brakes).or(train.shafts.len().checked_sub(1));
    let shaft = named.or_else(of_brake).and_then(|shaft| train.shafts.get(shaft));
    shaft.map_or(0.0, |shaft| ripple.order * shaft.speed_ratio.value())
}

/// The sidebands of a recording beside those of simulations, of each order that both show.
///
/// # Arguments
/// * `scenario`, `train` - of the machine
/// * `recorded` - of the recording
/// * `draws` - of each simulation
pub(super) fn compared(
    scenario: &Scenario,
    train: &GearTrain,
    recorded: &RepeatedLines,
    draws: &[RepeatedLines],
) -> Vec<RecordedSidebands> {
    let ripples: Vec<f64> =
        scenario.operation.torque_ripple.iter().map(|ripple| ripple_order(ripple, scenario, train)).collect();
    let all = sideband_orders(train).into_iter().enumerate();
    let of_order = |(number, of): (usize, SidebandOrder)| {
        let recorded = recorded.levels[number]?;
        let simulated: Vec<f64> =
            draws.iter().filter_map(|draw| draw.levels[number]).filter(|level| *level > 0.0).collect();
        let factors: Vec<f64> = simulated.iter().map(|level| recorded / level).collect();
        let cause = if ripples.iter().any(|order| (order - of.of_input).abs() < SAME) {
            SidebandCause::Torque
        } else if of.order == 1 {
            SidebandCause::Wheels
        } else {
            SidebandCause::Nothing
        };
        Some(RecordedSidebands {
            shaft: train.shafts[of.shaft].name.clone(),
            order: of.order,
            level: [recorded, simulated.iter().sum::<f64>() / simulated.len() as f64],
            factor: factor_of(&factors)?,
            cause,
        })
    };
    all.filter_map(of_order).collect()
}
