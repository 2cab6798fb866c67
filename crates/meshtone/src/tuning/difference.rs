//! Simulated difference signals.

use super::HybridError;
use crate::batch::{Control, Keep, simulate_many};
use crate::error::ScenarioError;
use crate::model::Model;
use crate::scenario::Scenario;
use crate::sensor::{Channel, ChannelKind};
use crate::signal::{
    AngularSettings, ChainSettings, GearTrain, Interpolation, Record, SeparationSettings, ShaftPhase,
    SignalError, TrainSettings, points_per_revolution,
};
use crate::simulate::Stages;
use crate::solver::Output;
use crate::wheel::WheelName;

/// Settings by which a difference signal is taken from a simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct DifferenceChain {
    /// The channel: of a sensor, one that every scenario lists.
    pub channel: Channel,
    /// (S/s) The rig's sampling rate, to which the simulated signal is brought first; at most the simulation's.
    pub sampling_rate_hz: f64,
    /// Over whose revolutions the signal is averaged: the name of the wheel that carries the fault.
    pub wheel: String,
    /// Sidebands and shaft orders that are taken away; by default as the paper has them. The mesh orders are always those of the
    /// wheel's shaft as it is simulated, whatever `teeth` says.
    pub separation: Option<SeparationSettings>,
}

impl DifferenceChain {
    /// The vertical acceleration of the gear's revolutions at a rig's sampling rate.
    ///
    /// # Arguments
    /// * `sampling_rate_hz` - (S/s)
    pub fn new(sampling_rate_hz: f64) -> Self {
        let channel = ChannelKind::Vertical.into();
        Self { channel, sampling_rate_hz, wheel: WheelName::Gear.into(), separation: None }
    }

    /// Settings by which signals, simulated or measured, are read at equal angles: under `published` by PCHIP as in the paper, which flattens a
    /// burst the more the farther its peaks lie from a point; under `linear` band-limited.
    ///
    /// # Arguments
    /// * `model` - of the scenario
    pub fn angular_settings(model: Model) -> AngularSettings {
        let interpolation =
            if model.has_meshes() { Interpolation::BandLimited } else { Interpolation::Pchip };
        AngularSettings { interpolation, ..AngularSettings::default() }
    }

    /// The wheel's average, its difference signal and indicators.
    ///
    /// # Arguments
    /// * `stages` - of the simulation
    /// * `signal` - the channel, all kept samples
    /// * `pinion_speed_hz` - (Hz) of a pair likewise; read where the speed follows a profile
    ///
    /// # Errors
    /// A wheel that the machine does not have; those of [`crate::signal::process_channel`].
    pub fn record(
        &self,
        stages: &Stages,
        signal: &[f64],
        pinion_speed_hz: &[f64],
    ) -> Result<Record, HybridError> {
        let rate_hz = self.sampling_rate_hz.min(stages.time.sampling_rate_hz);
        let wheel = self.wheel_of(&stages.scenario)?;
        let train = GearTrain::of_stages(stages);
        let angular = Self::angular_settings(stages.scenario.model);
        let Some(side) = stages.scenario.rig().and(WheelName::BOTH.get(wheel)) else {
            let ratio = train.speed_ratio(train.wheels[wheel].shaft, train.input());
            let shaft_hz = stages.scenario.operation.pinion_speed_hz * ratio.value();
            let points_per_revolution = Some(self.points_per_revolution(shaft_hz)?);
            let settings = TrainSettings {
                angular: AngularSettings { points_per_revolution, ..angular },
                separation: self.separation.clone().unwrap_or_else(|| SeparationSettings::new(1)),
                revolutions: None,
            };
            return Ok(crate::trace::train_record(stages, (&train, wheel), signal, rate_hz, &settings)?);
        };
        let separation = self.separation.as_ref().map(|settings| train.separation(wheel, settings));
        let settings = ChainSettings { angular, separation };
        Ok(crate::trace::wheel_record(stages, *side, signal, pinion_speed_hz, rate_hz, settings)?)
    }

    /// The points of a revolution, simulated or recorded, of a shaft that turns at its nominal speed.
    ///
    /// # Arguments
    /// * `shaft_hz` - (Hz) that speed
    ///
    /// # Errors
    /// A speed or a rate that is not above 0.
    pub fn points_per_revolution(&self, shaft_hz: f64) -> Result<usize, SignalError> {
        let samples = (3.0 * self.sampling_rate_hz / shaft_hz).ceil() as usize;
        let three = ShaftPhase::constant(shaft_hz, self.sampling_rate_hz, samples)?;
        Ok(points_per_revolution(&three))
    }

    /// The number of the wheel in a scenario.
    ///
    /// # Arguments
    /// * `scenario` - a valid one
    ///
    /// # Errors
    /// It has no wheel of this name, or a planetary set, whose wheels pass the sensor or turn about moving axes.
    pub fn wheel_of(&self, scenario: &Scenario) -> Result<usize, HybridError> {
        if !scenario.planetary().is_empty() {
            return Err(HybridError::Planetary);
        }
        let names = scenario.wheel_names();
        let found = names.iter().position(|name| *name == self.wheel);
        found.ok_or_else(|| HybridError::NoSuchWheel { wheel: self.wheel.clone(), known: names.join(", ") })
    }
}

/// Difference signals of some scenarios, in their order.
///
/// # Arguments
/// * `scenarios` - what is simulated
/// * `chain` - how a difference signal is taken
///
/// # Errors
/// Those of [`DifferenceChain::wheel_of`], before anything is simulated; the first scenario's that cannot be simulated or has no
/// difference signal.
///
/// ```
/// use meshtone::tuning::{DifferenceChain, difference_signals};
/// use meshtone::scenario::{Fault, GearPair, MissingTooth, Scenario};
///
/// let mut healthy = Scenario::new(GearPair::example());
/// healthy.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 7);
/// let broken = healthy.clone().with_faults(vec![Fault::on_first_gear_tooth(MissingTooth)]);
/// let signals = difference_signals(vec![healthy, broken], &DifferenceChain::new(25e3))?;
/// assert_eq!((signals.len(), signals[0].len()), (2, 2048));
/// # Ok::<(), meshtone::tuning::HybridError>(())
/// ```
pub fn difference_signals(
    scenarios: Vec<Scenario>,
    chain: &DifferenceChain,
) -> Result<Vec<Vec<f64>>, HybridError> {
    scenarios.iter().try_for_each(|scenario| chain.wheel_of(scenario).map(drop))?;
    let mut signals = Vec::with_capacity(scenarios.len());
    simulate_many(scenarios, &KeepDifference(chain), &Control::default(), |_, kept| signals.push(kept));
    signals.into_iter().map(|kept| kept?).collect()
}

/// Keeps the difference signal of each of many simulations.
pub(super) struct KeepDifference<'a>(pub(super) &'a DifferenceChain);

impl Keep for KeepDifference<'_> {
    // The channel, and of a pair the pinion's speed.
    type Recorder = Vec<Vec<f64>>;
    type Kept = Result<Vec<f64>, HybridError>;

    fn outputs(&self, scenario: &Scenario) -> Result<Vec<Output>, ScenarioError> {
        let channel = self.0.channel.output_of(scenario)?;
        let speed = scenario.rig().map(|_| ChannelKind::PinionShaftSpeed.output());
        Ok([channel].into_iter().chain(speed).collect())
    }

    fn recorder(&self, _: &Stages) -> Self::Recorder {
        Self::Recorder::default()
    }

    fn keep(&self, _: usize, stages: Stages, recorded: Self::Recorder) -> Self::Kept {
        let mut recorded = recorded.into_iter();
        let [motion, pinion_speed_hz] = [(); 2].map(|()| recorded.next().unwrap_or_default());
        let channel = stages.shown(&self.0.channel, motion);
        Ok(self.0.record(&stages, &channel, &pinion_speed_hz)?.parts.difference)
    }
}
