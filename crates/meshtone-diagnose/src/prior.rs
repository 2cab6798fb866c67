//! The prior: damage, and everything that differs from rig to rig.

use meshtone::damage::{Fault, damage_kinds};
use meshtone::scenario::{DamageKind, Scenario, ScenarioError, Sensor, SensorPath, log_deviation};
use meshtone::signal::GearTrain;

/// (-) Spread of the speed in a refined round for a recording of known speed: what a speed is known to.
const KNOWN_SPEED_SPREAD: f64 = 0.002;

/// Uncertainty of a number of the scenario: it is multiplied by e to the power of a normal number.
#[derive(Debug, Clone, PartialEq)]
pub struct Spread {
    /// Dotted key, as in the scenario file.
    pub key: String,
    /// (-) Standard deviation of its logarithm.
    pub deviation: f64,
}

/// Damage that a refined round draws: one kind on one wheel, within a range of severities.
///
/// Within the range its density is that of the prior, so that what is left out is all that is lost: Deistler, Goncalves, Macke,
/// "Truncated proposals for scalable and hassle-free simulation-based inference", NeurIPS 2022.
#[derive(Debug, Clone, PartialEq)]
pub struct Focus {
    /// The kind, by its place in [`Prior::kinds`].
    pub kind: usize,
    /// The damaged wheel, by its place among the rig's.
    pub wheel: usize,
    /// (-) The least and the largest severity.
    pub severity: [f64; 2],
}

/// The prior of damage and rig.
///
/// Drawn for a pair of wheels (eight records): its wheels' deviations, its structure, its path to the sensor. Drawn
/// for a record: speed, load, damage. A third of the records are nearer to speed and load of the healthy record of their pair: the logarithms of
/// the ratios are multiplied by a factor from 0.001 to 1 whose logarithm is uniform.
#[derive(Debug, Clone, PartialEq)]
pub struct Prior {
    /// The rig, healthy; its wheels are one draw of those that may be.
    pub base: Scenario,
    /// Shafts and wheels of the rig.
    pub train: GearTrain,
    /// Spreads of what is not known well: stiffnesses, frequencies, masses, spans, dampings, tip chamfer, backlash.
    pub spreads: Vec<Spread>,
    /// (-) Most by which the grade of the wheels is another; each step as likely as the next, within grades 1 to 12 or classes 1 to 11.
    pub grade_steps: u32,
    /// (-) Speed: the largest logarithm of its ratio to the rig's, either way. Seven tenths of it are the pair's, the rest is the
    /// record's, each uniform.
    pub speed_spread: f64,
    /// (-) Load of a pair: the largest logarithm of its ratio to the rig's, either way, uniform.
    pub load_spread: f64,
    /// (-) Load of a record: the largest logarithm of its ratio to the pair's, either way. The logarithm is this times the fourth power of a uniform
    /// number: half of the records are within 15 % of the pair's load, and one in five is beyond a factor of 2.7.
    pub load_change: f64,
    /// (dB) Standard deviation of the sensor path's gain.
    pub gain_db: f64,
    /// States that the rig names no sensor and has supports, so that the sensor may be on the support of either shaft, or on the seat of any
    /// bearing, on a wall or not.
    pub has_any_sensor: bool,
    /// (Hz) Speed of the rig's shaft that drives in the healthy records that all others of their pair are compared with, where it is another one.
    pub healthy_speed_hz: Option<f64>,
    /// Seed of all draws.
    pub seed: u64,
    /// The damage of a refined round; none where every kind on either wheel is drawn.
    pub focus: Option<Focus>,
}

impl Prior {
    /// The default prior of a rig.
    ///
    /// # Arguments
    /// * `rig` - the rig's scenario, of a pair or a gearbox; its faults are left out
    ///
    /// # Errors
    /// Those of [`GearTrain::of_scenario`].
    pub fn new(rig: &Scenario) -> Result<Self, ScenarioError> {
        let mut base = rig.clone().with_faults(Vec::new());
        base.sensors.truncate(1);
        let has_any_sensor = base.sensors.is_empty();
        if let Some(set) = base.planetary().first() {
            let problem = "is a planetary set, and these are not diagnosed: the average of a planet takes many revolutions of the carrier, and \
                           thousands of simulations of that length would have to be compared";
            return Err(ScenarioError::new("planetary", format!("{:?}", set.name), problem).with_help(
                "use `meshtone indicators`, which names the wheel whose average stands out, or learn from a data set (`meshtone init dataset \
                 --planetary`)",
            ));
        }
        if base.rig().is_none() {
            once(&mut base)?;
        } else if has_any_sensor {
            base.sensors = vec![unstated(Sensor::default())];
        }
        let deviations =
            base.numbers().into_iter().map(|number| (log_deviation(&base, &number.key), number.key));
        let spreads = deviations.filter_map(|(deviation, key)| Some(Spread { key, deviation: deviation? }));
        Ok(Self {
            spreads: spreads.collect(),
            train: GearTrain::of_scenario(&base)?,
            base,
            has_any_sensor,
            grade_steps: 1,
            speed_spread: 0.1,
            load_spread: 0.28,
            load_change: 2.3,
            gain_db: 6.0,
            healthy_speed_hz: None,
            seed: 1,
            focus: None,
        })
    }

    /// Other wheels with one damage, at a recording's speed.
    ///
    /// # Arguments
    /// * `focus` - the damage
    /// * `input_speed_hz`, `healthy_speed_hz` - (Hz) of the recording and of the healthy one, where they are known
    pub fn narrowed(&self, focus: Focus, input_speed_hz: Option<f64>, healthy_speed_hz: Option<f64>) -> Self {
        let mut narrowed = Self { seed: self.seed.wrapping_add(1), focus: Some(focus), ..self.clone() };
        if self.healthy_speed_hz.is_some() {
            narrowed.healthy_speed_hz = healthy_speed_hz;
        }
        if let Some(speed_hz) = input_speed_hz {
            narrowed.base.operation.pinion_speed_hz = speed_hz;
            narrowed.speed_spread = KNOWN_SPEED_SPREAD;
        }
        narrowed
    }

    /// The kinds of damage that the rig's model knows.
    pub fn kinds(&self) -> Vec<DamageKind> {
        let of_kind = |kind: &DamageKind| {
            let fault = Fault::at_usual_place(kind.example.clone()).with_severity(1.0);
            self.base.wheels.iter().rev().any(|wheel| {
                let fault = Fault { wheel: wheel.name.clone(), ..fault.clone() };
                self.base.clone().with_faults(vec![fault]).validate().is_ok()
            })
        };
        damage_kinds().into_iter().filter(of_kind).collect()
    }
}

/// The sensor of a rig that names none: on a support, its wall is drawn.
pub(crate) fn unstated(mut sensor: Sensor) -> Sensor {
    sensor.name = Some("support".to_owned());
    sensor.path = SensorPath::RIGID;
    sensor
}

/// Revolutions of the slowest shaft of a gearbox that an average needs at least.
const FEWEST_TURNS: f64 = 8.0;

/// Changes how long a steady gearbox is simulated: until the same teeth meet again on all shafts, since what follows repeats it; where that
/// takes longer than the scenario's own time, that time, but [`FEWEST_TURNS`] of the slowest shaft at least. It settles as long as before, and
/// has no random forces.
fn once(gearbox: &mut Scenario) -> Result<(), ScenarioError> {
    let layout = gearbox.layout()?;
    let cycle = layout.cycle_revolutions() as f64;
    let slowest = layout.ratios.iter().map(|ratio| ratio.value().abs()).fold(1.0, f64::min);
    let time = gearbox.time_grid();
    let revolutions = |samples: usize| samples as f64 / time.samples_per_pinion_revolution as f64;
    let kept = revolutions(time.kept_samples());
    let needed = cycle.min(kept.max(FEWEST_TURNS / slowest));
    // One cycle stands for a long recording over angle, whose averages have little of what is random; noise is added to the averages.
    gearbox.operation.speed_wander_percent = 0.0;
    gearbox.meshes.iter_mut().for_each(|mesh| mesh.random_force = 0.0);
    if gearbox.operation.is_steady() && needed != kept {
        let settled = revolutions(time.first_kept_sample);
        let solver = &mut gearbox.solver;
        solver.duration_s = None;
        solver.pinion_revolutions = Some(needed);
        solver.settle_fraction = settled / (settled + needed);
    }
    Ok(())
}
