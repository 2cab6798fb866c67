//! A check of a recording against what its user states about it: teeth, shaft, pulses, speed.

mod changing_speed;
mod fine_orders;
mod hypotheses;
mod other_turning;
mod steadier_speed;
mod varying_speed;
mod words;

use super::{AngularSignal, GearTrain};
use changing_speed::changing_speed;
use fine_orders::FineOrders;
use hypotheses::Hypothesis;
use other_turning::{meshes_together_speak_for, other_turning};
use steadier_speed::{SteadierSpeed, steadier_speed};
use varying_speed::varying_speed;

/// Least gain in evidence over the stated facts.
const LEAST_GAIN: f64 = 6.0;
/// Least sum of prominences of the mesh lines that a hypothesis has for itself.
const LEAST_MESH: f64 = 4.0;
/// Least of these of the mesh lines that the stated facts do not explain.
const LEAST_MESH_GAIN: f64 = 3.0;
/// The same of three lines that stand out as far as counts and are no multiples of the stated pair's own orders: neither the shaft's orders nor
/// a strong first one are needed then.
const CLEAR_MESH: f64 = 7.0;
/// [`LEAST_MESH`] for a speed, of which many are tried: two lines that stand out as far as counts.
const LEAST_MESH_OF_SPEED: f64 = 5.5;
/// Least gain of the wheel's orders where the mesh lines speak for another number of pulses: noise.
const LEAST_WHEEL_GAIN: f64 = -1.0;
/// Least score of a comb of shaft orders that decides, in standard deviations of noise.
const LEAST_COMB: f64 = 8.0;
/// Score of shaft orders that are clearly there.
const CLEAR_COMB: f64 = 12.0;
/// Largest one of shaft orders that are not there.
const POOR_COMB: f64 = 3.0;
/// Least ratio of the mesh harmonics' energy in the average at a better speed.
const LEAST_ENERGY_RATIO: f64 = 1.2;
/// Most teeth of a wheel: every count between half and twice as many is compared.
const MOST_TEETH: u32 = 100_000;

/// The source from which the angle of the shaft is known, as the user states it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StatedTurning {
    /// Pulses, so many a revolution.
    Pulses {
        /// The number.
        per_revolution: u32,
    },
    /// The mesh tone, followed in a narrow band.
    MeshTone {
        /// (Hz) The nominal speed of the shaft.
        nominal_hz: f64,
    },
    /// A constant speed.
    ConstantSpeed {
        /// (Hz) The speed.
        speed_hz: f64,
    },
    /// A speed that was measured, or anything else that is not off as a whole.
    Other,
}

/// The facts that a user states about a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StatedFacts {
    /// Teeth of the wheel on the shaft.
    pub teeth: u32,
    /// Teeth of the wheel that meshes with it.
    pub mate_teeth: Option<u32>,
    /// The source from which the angle of the shaft is known.
    pub turning: StatedTurning,
}

impl StatedFacts {
    /// The facts of a wheel on a shaft of a train, and of its mate; none of a shaft without wheels.
    ///
    /// # Arguments
    /// * `train` - the tooth counts
    /// * `shaft` - number of the shaft
    /// * `turning` - the source from which its angle is known
    pub fn of_shaft(train: &GearTrain, shaft: usize, turning: StatedTurning) -> Option<Self> {
        let wheel = train.wheels.iter().position(|wheel| wheel.shaft == shaft)?;
        let mate = train.meshes.iter().find_map(|mesh| match *mesh {
            [driving, driven] if driving == wheel => Some(driven),
            [driving, driven] if driven == wheel => Some(driving),
            _ => None,
        });
        let teeth = |number: usize| train.wheels[number].teeth;
        Some(Self { teeth: teeth(wheel), mate_teeth: mate.map(teeth), turning })
    }
}

/// A fact that fits the recording better than the stated one.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Alternative {
    /// Another number of teeth of the wheel on the shaft.
    Teeth {
        /// The number.
        teeth: u32,
    },
    /// Another number of teeth of its mate.
    MateTeeth {
        /// The number.
        teeth: u32,
        /// The stated number.
        stated: u32,
    },
    /// Speed or pulses are those of the mate's shaft, or of any other one of a train of several meshes.
    OtherShaft {
        /// Stated teeth of the mate, or of a wheel on that shaft.
        mate_teeth: u32,
    },
    /// Another number of pulses in a revolution.
    PulsesPerRevolution {
        /// The number.
        pulses: u32,
        /// The stated number.
        stated: u32,
    },
    /// Another constant speed.
    ShaftSpeed {
        /// (Hz) The speed.
        speed_hz: f64,
        /// (Hz) The stated speed.
        stated_hz: f64,
    },
    /// A speed that varies, where a constant one is stated.
    VaryingSpeed {
        /// (-) Standard deviation of the revolutions' speeds over their mean.
        variation: f64,
        /// (Hz) The stated speed.
        stated_hz: f64,
    },
}

impl Alternative {
    /// Returns whether it is another speed.
    pub fn is_speed(&self) -> bool {
        matches!(self, Self::ShaftSpeed { .. } | Self::VaryingSpeed { .. })
    }

    /// The name of the quantity, for programs to distinguish.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Teeth { .. } => "teeth",
            Self::MateTeeth { .. } => "mate_teeth",
            Self::OtherShaft { .. } => "other_shaft",
            Self::PulsesPerRevolution { .. } => "pulses_per_revolution",
            Self::ShaftSpeed { .. } => "speed_hz",
            Self::VaryingSpeed { .. } => "varying_speed",
        }
    }

    /// The better value: teeth, pulses, (Hz) speed; of a speed that varies (-) its standard deviation over its mean.
    pub fn value(&self) -> f64 {
        match *self {
            Self::Teeth { teeth } | Self::MateTeeth { teeth, .. } => f64::from(teeth),
            Self::OtherShaft { mate_teeth } => f64::from(mate_teeth),
            Self::PulsesPerRevolution { pulses, .. } => f64::from(pulses),
            Self::ShaftSpeed { speed_hz, .. } => speed_hz,
            Self::VaryingSpeed { variation, .. } => variation,
        }
    }
}

/// Evidence for an interpretation of the recording.
#[derive(Debug, Clone, Copy)]
struct Evidence {
    /// (-) Sum over the mesh harmonics of the logarithm of each line over its strongest neighbour, each from −1 to 3.
    mesh: f64,
    /// (-) Height of the wheel's shaft orders above the bins between them, in standard deviations of noise.
    /// None where the recording is too short to tell.
    wheel_orders: Option<f64>,
    /// (-) Height of the mate's shaft orders, likewise.
    mate_orders: Option<f64>,
}

impl Evidence {
    fn total(&self) -> f64 {
        self.mesh + self.wheel_orders.unwrap_or(0.0) + self.mate_orders.unwrap_or(0.0)
    }
}

/// A stated fact that does not fit the recording, with an alternative that fits better.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Mismatch {
    /// The stated facts.
    pub stated: StatedFacts,
    /// The alternative.
    pub alternative: Alternative,
    /// (-) Energy of the mesh harmonics in the average at the alternative speed over that at the stated one; none where the speed is
    /// not in doubt.
    pub energy_ratio: Option<f64>,
    /// Names of the stated shaft and of the one that fits, where a train of several meshes has another one.
    pub shafts: Option<[String; 2]>,
}

/// Looks for a sign that the recording does not fit the stated facts: another tooth count, the other shaft, another number of pulses,
/// another speed, one that varies where a constant one is stated.
///
/// The mesh harmonics of the right interpretation stand out of their neighbours, and the orders of either shaft out of what lies
/// between them. An alternative is reported where it has clearly more of both than the stated facts. Where the recording is too
/// short or too noisy to tell, nothing is; nor where a wheel is stated to have more than 100 000 teeth, which are not compared.
///
/// # Arguments
/// * `angular` - the recording over the angle of the shaft, as it is stated
/// * `stated` - the facts that the user states
///
/// ```
/// use meshtone::signal::{AngularSettings, Alternative, ShaftPhase, StatedFacts, StatedTurning, angular_resample, find_mismatch};
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
/// let mut stated = StatedFacts { teeth: 19, mate_teeth: None, turning: StatedTurning::Other };
/// assert_eq!(find_mismatch(&angular, &stated), None);
/// stated.teeth = 20;
/// assert_eq!(find_mismatch(&angular, &stated).map(|mismatch| mismatch.alternative), Some(Alternative::Teeth { teeth: 19 }));
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn find_mismatch(angular: &AngularSignal, stated: &StatedFacts) -> Option<Mismatch> {
    find_among(angular, stated, &FineOrders::of(angular)?, |_| true)
}

/// Does what [`find_mismatch`] does for a shaft of a train.
///
/// Of a train of several meshes the shaft, the number of pulses and the speed are doubted, but not the tooth counts: lines of another mesh would
/// look like another count. None of a shaft without wheels.
///
/// # Arguments
/// * `angular` - the recording over the angle of the shaft, as it is stated
/// * `train` - the tooth counts
/// * `shaft` - number of the shaft
/// * `turning` - the source from which its angle is known
pub fn find_train_mismatch(
    angular: &AngularSignal,
    train: &GearTrain,
    shaft: usize,
    turning: StatedTurning,
) -> Option<Mismatch> {
    let stated = StatedFacts::of_shaft(train, shaft, turning)?;
    if train.meshes.len() < 2 {
        return find_mismatch(angular, &stated);
    }
    let orders = FineOrders::of(angular)?;
    let speed = find_among(angular, &stated, &orders, Alternative::is_speed);
    // That the speed is another one as a whole, which the lines of a mesh say, and not how it is off, which their phases say.
    let is_by_lines = |found: &Mismatch| {
        matches!(found.alternative, Alternative::ShaftSpeed { .. }) && found.energy_ratio.is_none()
    };
    if speed.as_ref().is_some_and(|found| !is_by_lines(found)) {
        return speed;
    }
    let name = |shaft: usize| train.shafts[shaft].name.clone();
    let of_other = |(alternative, other): (Alternative, Option<usize>)| Mismatch {
        stated,
        alternative,
        energy_ratio: None,
        shafts: other.map(|other| [name(shaft), name(other)]),
    };
    let is_of_all = |found: &Mismatch| match found.alternative {
        Alternative::ShaftSpeed { speed_hz, stated_hz } => {
            meshes_together_speak_for(speed_hz / stated_hz, &orders, train, shaft)
        }
        _ => true,
    };
    let other = other_turning(&orders, train, shaft, turning).map(of_other);
    other.or_else(|| speed.filter(is_of_all))
}

/// Does what [`find_mismatch`] does, comparing only some of the alternatives.
fn find_among(
    angular: &AngularSignal,
    stated: &StatedFacts,
    orders: &FineOrders,
    is_compared: impl Fn(&Alternative) -> bool,
) -> Option<Mismatch> {
    if stated.teeth.max(stated.mate_teeth.unwrap_or(0)) > MOST_TEETH {
        return None;
    }
    let as_stated = Hypothesis::as_stated(stated);
    let stated_evidence = as_stated.evidence_beside(orders, &[]);
    let of_pair = Hypothesis::orders_of_pair(stated, orders);
    let mismatch =
        |alternative, energy_ratio| Mismatch { stated: *stated, alternative, energy_ratio, shafts: None };
    if let StatedTurning::ConstantSpeed { speed_hz: stated_hz }
    | StatedTurning::MeshTone { nominal_hz: stated_hz } = stated.turning
        && let Some(variation) = changing_speed(angular, stated.teeth)
    {
        let alternative = Alternative::VaryingSpeed { variation, stated_hz };
        return Some(mismatch(alternative, None));
    }
    // Where the shaft's own orders are not seen, a mesh frequency is as well of another speed as of other teeth.
    let may_be_speed = matches!(stated.turning, StatedTurning::ConstantSpeed { .. })
        && stated_evidence.wheel_orders.is_none_or(|score| score < POOR_COMB);
    let total =
        |hypothesis: &Hypothesis, evidence: &Evidence| evidence.total() + hypothesis.prior(may_be_speed);
    let better: Vec<(Hypothesis, Evidence)> = hypotheses::alternatives(stated, orders)
        .filter(|hypothesis| is_compared(&hypothesis.alternative) && !hypothesis.is_of_mains(stated, orders))
        .filter_map(|hypothesis| {
            let better = evidence_if_better(
                &hypothesis,
                &as_stated,
                &stated_evidence,
                may_be_speed,
                &of_pair,
                orders,
            )?;
            Some((hypothesis, better))
        })
        .collect();
    let likeliest = better.iter().max_by(|(a, of_a), (b, of_b)| total(a, of_a).total_cmp(&total(b, of_b)));
    // The orders of a mate of twice as many teeth may be the hunting-tooth orders of the right one.
    let half = likeliest
        .and_then(|(likeliest, _)| better.iter().find(|(half, _)| half.explains_mate_of(likeliest, stated)));
    let likeliest = half.or(likeliest).copied();
    if let StatedTurning::ConstantSpeed { speed_hz } = stated.turning {
        let hypothesis = likeliest.map_or(as_stated, |(hypothesis, _)| hypothesis);
        let speed_is_alternative = likeliest
            .is_some_and(|(hypothesis, _)| matches!(hypothesis.alternative, Alternative::ShaftSpeed { .. }));
        let steadier = steadier_speed(angular, orders, &hypothesis, stated.teeth).filter(|steadier| {
            (likeliest.is_none() || speed_is_alternative) && steadier.energy_ratio >= LEAST_ENERGY_RATIO
        });
        let is_doubtful = steadier.is_some() || speed_is_alternative || !as_stated.stands_out(orders);
        let variation =
            if is_doubtful { varying_speed(angular, orders, &as_stated, stated.teeth) } else { None };
        if let Some(variation) = variation {
            let alternative = Alternative::VaryingSpeed { variation, stated_hz: speed_hz };
            return Some(mismatch(alternative, None));
        }
        if let Some(SteadierSpeed { factor, energy_ratio }) = steadier {
            let alternative = Alternative::ShaftSpeed { speed_hz: speed_hz * factor, stated_hz: speed_hz };
            return Some(mismatch(alternative, Some(energy_ratio)));
        }
    }
    Some(mismatch(likeliest?.0.alternative, None))
}

/// The evidence for a hypothesis, where it is clearly more than that for the stated facts.
///
/// Mesh orders that both have in common say nothing and are left out. Each kind of hypothesis then needs the evidence that a mistake of its
/// kind would leave, of the mesh, of the wheel's or of the mate's orders; and in sum it must have clearly more than the stated facts,
/// because a wrong warning is worse than none.
///
/// # Arguments
/// * `may_be_speed` - whether other teeth are stated from another speed by nothing
/// * `of_pair` - the orders of the stated pair beside the wheel's, which are evidence for no other mate
fn evidence_if_better(
    hypothesis: &Hypothesis,
    as_stated: &Hypothesis,
    stated: &Evidence,
    may_be_speed: bool,
    of_pair: &[f64],
    orders: &FineOrders,
) -> Option<Evidence> {
    let known = if hypothesis.moves_wheel() { &[] } else { of_pair };
    let own = hypothesis.evidence_beside(orders, known);
    let new_mesh = hypothesis.unshared_mesh(as_stated, &[], orders);
    let lost_mesh = as_stated.unshared_mesh(hypothesis, &[], orders).unwrap_or(0.0);
    let wheel_gain = gain(own.wheel_orders, stated.wheel_orders);
    let mate_gain = gain(own.mate_orders, stated.mate_orders);
    let mesh_gain = new_mesh.unwrap_or(0.0) - lost_mesh;
    let is_of_speed = match hypothesis.alternative {
        Alternative::ShaftSpeed { .. } => true,
        Alternative::Teeth { .. } => may_be_speed,
        _ => false,
    };
    let least_mesh = if is_of_speed { LEAST_MESH_OF_SPEED } else { LEAST_MESH };
    let has_mesh =
        own.mesh > least_mesh && new_mesh.is_some_and(|new| new > LEAST_MESH_GAIN) && lost_mesh <= 0.0;
    let has_wheel = own.wheel_orders > Some(LEAST_COMB) && wheel_gain > LEAST_COMB;
    let has_mate = own.mate_orders > Some(LEAST_COMB) && stated.mate_orders.is_some_and(|stated| stated < POOR_COMB)
        // Only beside the orders of the one shaft can those of the other be read.
        && stated.wheel_orders > Some(POOR_COMB)
        && !hypothesis.has_weak_mate(as_stated, orders);
    // Where one's own orders are clear, those of a mate are seen too.
    let lacks_mate =
        own.wheel_orders > Some(CLEAR_COMB) && own.mate_orders.is_some_and(|own| own < POOR_COMB);
    let is_founded = match hypothesis.alternative {
        Alternative::MateTeeth { .. } => has_mate,
        Alternative::Teeth { .. } => has_mesh && !lacks_mate || has_mate && lost_mesh <= 0.0,
        Alternative::OtherShaft { .. } => has_mesh || has_mate && lost_mesh <= 0.0,
        Alternative::PulsesPerRevolution { .. } => {
            let is_possible = own.wheel_orders.is_some()
                && lost_mesh <= 0.0
                && !hypothesis.is_part_without_lines(as_stated, of_pair, orders);
            is_possible && (has_mesh && wheel_gain > LEAST_WHEEL_GAIN || has_wheel && mesh_gain > 0.0)
        }
        Alternative::ShaftSpeed { .. } | Alternative::VaryingSpeed { .. } => {
            has_mesh || has_wheel && lost_mesh <= 0.0
        }
    };
    let counted_mate_gain = if hypothesis.moves_wheel() { mate_gain.min(0.0) } else { mate_gain };
    (is_founded && mesh_gain + wheel_gain + counted_mate_gain > LEAST_GAIN).then_some(own)
}

/// The score of a hypothesis less that of the stated facts; 0 where the latter cannot be seen.
fn gain(own: Option<f64>, stated: Option<f64>) -> f64 {
    match (own, stated) {
        (_, None) => 0.0,
        (None, Some(stated)) => -stated.max(0.0),
        (Some(own), Some(stated)) => own - stated,
    }
}
