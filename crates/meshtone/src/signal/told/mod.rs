//! Whether a recording is of what its user says: teeth, shaft, pulses, speed.

mod claims;
mod fine_orders;
mod steady;
mod varying;
mod words;

use super::AngularSignal;
use claims::Claim;
use fine_orders::FineOrders;
use steady::{Steadied, steadied};
use varying::varying;

/// Least gain in evidence over what is told.
const LEAST_GAIN: f64 = 6.0;
/// Least sum of prominences of the mesh lines that a claim has for itself.
const LEAST_MESH: f64 = 4.0;
/// Least of these of the mesh lines that are not those of what is told.
const LEAST_MESH_GAIN: f64 = 3.0;
/// The same as [`LEAST_MESH`] of a speed, of which many are tried: two lines that stand out as far as counts.
const LEAST_MESH_OF_SPEED: f64 = 5.5;
/// Least gain of the wheel's orders where the mesh lines speak for another number of pulses: noise.
const LEAST_WHEEL_GAIN: f64 = -1.0;
/// Least score of a comb of shaft orders that decides, in standard deviations of noise.
const LEAST_COMB: f64 = 6.0;
/// Largest one of shaft orders that are not there.
const POOR_COMB: f64 = 3.0;
/// Least ratio of the mesh harmonics' energy in the average at a better speed.
const LEAST_ENERGY_RATIO: f64 = 1.2;
/// Most teeth of a wheel: every count between half and twice as many is compared.
const MOST_TEETH: u32 = 100_000;

/// What tells how far the shaft has turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ToldTurning {
    /// Pulses, so many a revolution.
    Pulses {
        /// How many.
        per_revolution: u32,
    },
    /// A constant speed.
    ConstantSpeed {
        /// (Hz) The speed.
        speed_hz: f64,
    },
    /// A speed that was measured, or anything else that is not off as a whole.
    Other,
}

/// What is said about a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Told {
    /// Teeth of the wheel on the shaft.
    pub teeth: u32,
    /// Teeth of the wheel that meshes with it.
    pub mate_teeth: Option<u32>,
    /// What tells how far the shaft has turned.
    pub turning: ToldTurning,
}

/// What is likelier than what is told.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Likelier {
    /// Another number of teeth of the wheel on the shaft.
    Teeth {
        /// How many.
        teeth: u32,
    },
    /// Another number of teeth of its mate.
    MateTeeth {
        /// How many.
        teeth: u32,
        /// How many it is told to have.
        told: u32,
    },
    /// Speed or pulses are those of the mate's shaft.
    OtherShaft {
        /// Teeth that the mate is told to have.
        mate_teeth: u32,
    },
    /// Another number of pulses in a revolution.
    PulsesPerRevolution {
        /// How many.
        pulses: u32,
        /// How many are told.
        told: u32,
    },
    /// Another constant speed.
    ShaftSpeed {
        /// (Hz) The speed.
        speed_hz: f64,
        /// (Hz) The one that is told.
        told_hz: f64,
    },
    /// A speed that varies, where a constant one is told.
    VaryingSpeed {
        /// (-) Standard deviation of the revolutions' speeds over their mean.
        variation: f64,
        /// (Hz) The one that is told.
        told_hz: f64,
    },
}

/// What speaks for a reading of the recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
    /// (-) Sum over the mesh harmonics of the logarithm of each line over its strongest neighbour, each from −1 to 3.
    pub mesh: f64,
    /// (-) How far the wheel's shaft orders stand out of what lies between them, in standard deviations of noise.
    /// None where the recording is too short to tell.
    pub wheel_orders: Option<f64>,
    /// (-) The same of the mate's shaft orders.
    pub mate_orders: Option<f64>,
}

impl Evidence {
    fn total(&self) -> f64 {
        self.mesh + self.wheel_orders.unwrap_or(0.0) + self.mate_orders.unwrap_or(0.0)
    }
}

/// What a recording says against what is told.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Misfit {
    /// What is told.
    pub told: Told,
    /// What speaks for it.
    pub told_evidence: Evidence,
    /// What is likelier.
    pub likelier: Likelier,
    /// What speaks for that.
    pub evidence: Evidence,
    /// (-) Energy of the mesh harmonics in the average at the likelier speed over that at the one told; none where the speed is
    /// not in doubt.
    pub energy_ratio: Option<f64>,
}

/// Looks for a sign that the recording is not of what is told: another tooth count, the other shaft, another number of pulses,
/// another speed, one that varies where a constant one is told.
///
/// The mesh harmonics of the right reading stand out of their neighbours, and the orders of either shaft out of what lies
/// between them. A reading is reported where it has clearly more of both than what is told. Where the recording is too
/// short or too noisy to tell, nothing is; nor where a wheel is told to have more than 100 000 teeth, which are not compared.
///
/// # Arguments
/// * `angular` - the recording over the angle of the shaft, as it is told
/// * `told` - what is told
///
/// ```
/// use meshtone::signal::{AngularSettings, Likelier, ShaftPhase, Told, ToldTurning, angular_resample, misfit};
///
/// // A wheel of 19 teeth at 20 Hz with sidebands and three harmonics, and a little noise, as every recording has.
/// let wave = |order: f64, i: usize| (std::f64::consts::TAU * order * 20.0 * i as f64 / 1e4).cos();
/// let mesh = |i| wave(19.0, i) + 0.5 * wave(38.0, i) + 0.4 * wave(57.0, i);
/// let noise = |i: usize| 4e-5 * (i * i % 10_007) as f64;
/// let sidebands = |i| 0.1 * wave(20.0, i) + 0.1 * wave(18.0, i);
/// let signal: Vec<f64> = (0..20_000).map(|i| mesh(i) + sidebands(i) + noise(i)).collect();
/// let phase = ShaftPhase::constant(20.0, 1e4, signal.len())?;
/// let angular = angular_resample(&signal, &phase, &AngularSettings::default())?;
///
/// let mut told = Told { teeth: 19, mate_teeth: None, turning: ToldTurning::Other };
/// assert_eq!(misfit(&angular, &told), None);
/// told.teeth = 20;
/// assert_eq!(misfit(&angular, &told).map(|misfit| misfit.likelier), Some(Likelier::Teeth { teeth: 19 }));
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn misfit(angular: &AngularSignal, told: &Told) -> Option<Misfit> {
    if told.teeth.max(told.mate_teeth.unwrap_or(0)) > MOST_TEETH {
        return None;
    }
    let orders = FineOrders::of(angular)?;
    let as_told = Claim::as_told(told);
    let told_evidence = as_told.evidence(&orders);
    // Where the shaft's own orders are not seen, a mesh frequency is as well of another speed as of other teeth.
    let may_be_speed = matches!(told.turning, ToldTurning::ConstantSpeed { .. })
        && told_evidence.wheel_orders.is_none_or(|score| score < POOR_COMB);
    let total = |claim: &Claim, evidence: &Evidence| evidence.total() + claim.prior(may_be_speed);
    let likeliest = claims::others(told, &orders)
        .filter(|claim| !claim.is_of_mains(told, &orders))
        .filter_map(|claim| Some((claim, gained(&claim, &as_told, &told_evidence, may_be_speed, &orders)?)))
        .max_by(|(a, of_a), (b, of_b)| total(a, of_a).total_cmp(&total(b, of_b)));
    if let ToldTurning::ConstantSpeed { speed_hz } = told.turning {
        let (claim, evidence) = likeliest.unwrap_or((as_told, told_evidence));
        let speed_is_likelier =
            likeliest.is_some_and(|(claim, _)| matches!(claim.likelier, Likelier::ShaftSpeed { .. }));
        let steadied = steadied(angular, &orders, &claim, told.teeth).filter(|steadied| {
            (likeliest.is_none() || speed_is_likelier) && steadied.energy_ratio >= LEAST_ENERGY_RATIO
        });
        let is_doubtful = steadied.is_some() || speed_is_likelier || !as_told.stands_out(&orders);
        let variation = if is_doubtful { varying(angular, &orders, &as_told, told.teeth) } else { None };
        if let Some(variation) = variation {
            let likelier = Likelier::VaryingSpeed { variation, told_hz: speed_hz };
            let evidence = told_evidence;
            return Some(Misfit { told: *told, told_evidence, likelier, evidence, energy_ratio: None });
        }
        if let Some(Steadied { factor, energy_ratio }) = steadied {
            let likelier = Likelier::ShaftSpeed { speed_hz: speed_hz * factor, told_hz: speed_hz };
            let energy_ratio = Some(energy_ratio);
            return Some(Misfit { told: *told, told_evidence, likelier, evidence, energy_ratio });
        }
    }
    let (claim, evidence) = likeliest?;
    Some(Misfit { told: *told, told_evidence, likelier: claim.likelier, evidence, energy_ratio: None })
}

/// The evidence for a claim, where it is clearly more than that for what is told.
///
/// # Arguments
/// * `may_be_speed` - whether other teeth are told from another speed by nothing
fn gained(
    claim: &Claim,
    as_told: &Claim,
    told: &Evidence,
    may_be_speed: bool,
    orders: &FineOrders,
) -> Option<Evidence> {
    let own = claim.evidence(orders);
    let new_mesh = claim.own_mesh(as_told, orders);
    let lost_mesh = as_told.own_mesh(claim, orders).unwrap_or(0.0);
    let wheel_gain = gain(own.wheel_orders, told.wheel_orders);
    let mate_gain = gain(own.mate_orders, told.mate_orders);
    let mesh_gain = new_mesh.unwrap_or(0.0) - lost_mesh;
    let is_of_speed = match claim.likelier {
        Likelier::ShaftSpeed { .. } => true,
        Likelier::Teeth { .. } => may_be_speed,
        _ => false,
    };
    let least_mesh = if is_of_speed { LEAST_MESH_OF_SPEED } else { LEAST_MESH };
    let has_mesh =
        own.mesh > least_mesh && new_mesh.is_some_and(|new| new > LEAST_MESH_GAIN) && lost_mesh <= 0.0;
    let has_wheel = own.wheel_orders > Some(LEAST_COMB) && wheel_gain > LEAST_COMB;
    let has_mate = own.mate_orders > Some(LEAST_COMB) && told.mate_orders.is_some_and(|told| told < POOR_COMB)
        // Only beside the orders of the one shaft can those of the other be read.
        && told.wheel_orders > Some(POOR_COMB);
    let is_founded = match claim.likelier {
        Likelier::MateTeeth { .. } => has_mate,
        Likelier::Teeth { .. } | Likelier::OtherShaft { .. } => has_mesh || has_mate && lost_mesh <= 0.0,
        Likelier::PulsesPerRevolution { .. } => {
            let is_possible = own.wheel_orders.is_some() && lost_mesh <= 0.0;
            is_possible && (has_mesh && wheel_gain > LEAST_WHEEL_GAIN || has_wheel && mesh_gain > 0.0)
        }
        Likelier::ShaftSpeed { .. } | Likelier::VaryingSpeed { .. } => {
            has_mesh || has_wheel && lost_mesh <= 0.0
        }
    };
    let counted_mate_gain = if claim.moves_wheel() { mate_gain.min(0.0) } else { mate_gain };
    (is_founded && mesh_gain + wheel_gain + counted_mate_gain > LEAST_GAIN).then_some(own)
}

/// What a claim has more than what is told; nothing where the latter cannot be seen.
fn gain(own: Option<f64>, told: Option<f64>) -> f64 {
    match (own, told) {
        (_, None) => 0.0,
        (None, Some(told)) => -told.max(0.0),
        (Some(own), Some(told)) => own - told,
    }
}
