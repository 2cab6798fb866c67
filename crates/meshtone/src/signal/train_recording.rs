//! A recording of a train: from the phase of one shaft to the averages, indicators and foreign tones of all.

use thiserror::Error;

use super::average::average_of;
use super::check_recording::RecordingCheck;
use super::record::{process_angular, process_angular_segments};
use super::{
    AngleZero, AngularSettings, AngularSignal, ChainSettings, ForeignSearch, GearTrain, Interpolation,
    Record, SeparationSettings, ShaftPhase, SignalError, SignalWarning, SimulatedShafts, StatedTurning,
    SynchronousAverage, TrainWheel, angular_resample, check_channel, sensor_faults,
};
use crate::scenario::Scenario;
use crate::wheel::WheelName;

/// (-) Part of the mean square from which on most of a recording repeats with a shaft; noise leaves less of any two revolutions that count.
const MOST: f64 = 0.75;

/// How the shafts of a train turn over a recording.
#[derive(Debug, Clone, PartialEq)]
pub enum TrainTurning {
    /// The phase of one shaft is known, from which those of the others follow through the tooth counts.
    Shaft {
        /// Number of the shaft.
        shaft: usize,
        /// Its phase.
        phase: ShaftPhase,
        /// The source of that phase, whose mistakes are looked for.
        stated: StatedTurning,
    },
    /// A simulated pair, whose shafts both have whole numbers of samples in a revolution where the speed is constant.
    SimulatedPair(SimulatedShafts),
}

impl TrainTurning {
    /// How the shafts of what was simulated turned.
    ///
    /// # Arguments
    /// * `scenario` - what was simulated; a valid one
    /// * `start_s` - (s) time of the first kept sample since the start of the simulation
    /// * `samples` - how many were kept
    ///
    /// # Errors
    /// Fewer than two samples.
    pub fn of_simulated(scenario: &Scenario, start_s: f64, samples: usize) -> Result<Self, SignalError> {
        // Only of two wheels that enter contact together each has whole numbers of samples in its revolution.
        if scenario.rig().is_some() {
            return Ok(Self::SimulatedPair(SimulatedShafts::new(scenario, start_s, samples)));
        }
        Ok(Self::Shaft {
            shaft: scenario.input_shaft(),
            phase: ShaftPhase::of_simulated_input(scenario, start_s, samples)?,
            stated: StatedTurning::Other,
        })
    }

    /// The shaft whose phase is known with that phase, and what is stated about it: of what was simulated the input's.
    ///
    /// # Arguments
    /// * `train` - the machine
    ///
    /// # Errors
    /// Fewer than two samples.
    pub fn known_phase(&self, train: &GearTrain) -> Result<(usize, ShaftPhase, StatedTurning), SignalError> {
        match self {
            Self::Shaft { shaft, phase, stated } => Ok((*shaft, phase.clone(), *stated)),
            Self::SimulatedPair(shafts) => {
                Ok((train.input(), shafts.phase(WheelName::Pinion)?, StatedTurning::Other))
            }
        }
    }

    /// Number of the shaft whose phase is known: of what was simulated the input.
    pub fn known_shaft(&self, train: &GearTrain) -> usize {
        match self {
            Self::Shaft { shaft, .. } => *shaft,
            Self::SimulatedPair(_) => train.input(),
        }
    }
}

/// A channel of a recording of a pair or a gearbox, with the angles of its shafts.
///
/// ```
/// use meshtone::scenario::{Scenario, gearbox_template};
/// use meshtone::signal::{GearTrain, ShaftPhase, StatedTurning, TrainRecording, TrainSettings, TrainTurning};
///
/// let mut gearbox = Scenario::from_toml(&gearbox_template(None))?;
/// gearbox.solver.duration_s = Some(1.0);
/// let channels = meshtone::simulate(&gearbox)?.channels;
/// let train = GearTrain::of_scenario(&gearbox)?;
/// let phase = ShaftPhase::of_simulated_input(&gearbox, channels.start_s, channels.len())?;
/// let turning = TrainTurning::Shaft { shaft: train.input(), phase, stated: StatedTurning::Other };
/// let signal = channels.signal("output_1_vertical_g").ok_or("no such channel")?;
/// let recording =
///     TrainRecording { signal, sampling_rate_hz: channels.sampling_rate_hz, train: &train, turning: &turning };
/// let records = recording.process(&TrainSettings::default())?;
/// let revolutions: Vec<usize> = records.wheels.iter().map(|of| of.records[0].average.revolutions).collect();
/// assert_eq!(revolutions, [29, 9, 9, 5]);
/// assert!(records.foreign.is_some_and(|found| found.tones.is_empty()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct TrainRecording<'a> {
    /// The channel.
    pub signal: &'a [f64],
    /// (S/s) Its sampling rate.
    pub sampling_rate_hz: f64,
    /// The machine.
    pub train: &'a GearTrain,
    /// How it turned.
    pub turning: &'a TrainTurning,
}

/// Settings by which a recording of a train is processed.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainSettings {
    /// Settings of the resampling over the angle.
    pub angular: AngularSettings,
    /// Sidebands, shaft orders and mean of the regular part of every wheel; its tooth counts are those of the train.
    pub separation: SeparationSettings,
    /// (rev) At least 2: length of the segments into which the recording is cut, of each shaft; none for one record of all.
    pub revolutions: Option<usize>,
}

impl Default for TrainSettings {
    fn default() -> Self {
        Self {
            angular: AngularSettings::default(),
            separation: SeparationSettings::new(1),
            revolutions: None,
        }
    }
}

/// What a recording shows about one wheel.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct WheelRecords {
    /// Number of the wheel in the train.
    pub wheel: usize,
    /// (Hz) Mean speed of its shaft.
    pub mean_speed_hz: f64,
    /// One record, or one of each segment. Those of wheels on one shaft have the same average and difference.
    pub records: Vec<Record>,
    /// (s) Middle of each, since the first sample.
    pub middles_s: Vec<f64>,
}

/// What a recording shows about a train.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct TrainRecords {
    /// The wheels that turn often enough for an average, in the order of the train.
    pub wheels: Vec<WheelRecords>,
    /// All tones that belong to no shaft and no mesh. They are not looked for where the mate of a single wheel is not known,
    /// where a stated value does not fit, over a run-up, in fewer than six revolutions, and in a simulated pair.
    pub foreign: Option<ForeignSearch>,
    /// What is doubtful, each once.
    pub warnings: Vec<SignalWarning>,
}

/// A wheel for which a recording gives no result.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{wheel} of {teeth} teeth: {error}")]
pub struct WheelError {
    /// Name of the wheel.
    pub wheel: String,
    /// Its teeth.
    pub teeth: u32,
    /// What is wrong.
    pub error: SignalError,
}

impl TrainRecording<'_> {
    /// The phase of a shaft.
    ///
    /// # Arguments
    /// * `shaft` - its number
    ///
    /// # Errors
    /// Angles that do not rise; fewer than two samples.
    pub fn phase(&self, shaft: usize) -> Result<ShaftPhase, SignalError> {
        match self.turning {
            TrainTurning::Shaft { shaft: of, phase, .. } => self.train.carried(phase, *of, shaft),
            TrainTurning::SimulatedPair(shafts) => shafts.phase(WheelName::BOTH[shaft.min(1)]),
        }
    }

    /// (Hz) Mean speed of a shaft.
    ///
    /// # Arguments
    /// * `shaft` - its number
    ///
    /// # Errors
    /// Those of [`TrainRecording::phase`].
    pub fn mean_speed_hz(&self, shaft: usize) -> Result<f64, SignalError> {
        match self.turning {
            TrainTurning::SimulatedPair(shafts) => Ok(shafts.mean_speed_hz(WheelName::BOTH[shaft.min(1)])),
            TrainTurning::Shaft { .. } => Ok(self.phase(shaft)?.mean_speed_hz(self.sampling_rate_hz)),
        }
    }

    /// The signal over whole revolutions of a wheel: in a simulation from an angle on at which its first tooth enters contact, else from one at which
    /// its shaft has angle 0.
    ///
    /// # Arguments
    /// * `wheel` - its number
    /// * `settings` - how it is resampled
    ///
    /// # Errors
    /// Those of [`angular_resample`].
    pub fn angular(&self, wheel: usize, settings: &AngularSettings) -> Result<AngularSignal, SignalError> {
        match self.turning {
            TrainTurning::SimulatedPair(shafts) => {
                let settings = ChainSettings { angular: *settings, separation: None };
                shafts.angular(self.signal, WheelName::BOTH[wheel.min(1)], &settings)
            }
            TrainTurning::Shaft { .. } => angular_resample(self.signal, &self.wheel_phase(wheel)?, settings),
        }
    }

    /// The average over the revolutions of a wheel, of one at least: of planets and suns that a carrier takes past the sensor by windows around their
    /// passages.
    ///
    /// # Arguments
    /// * `wheel` - its number
    /// * `settings` - how the signal is resampled
    ///
    /// # Errors
    /// Those of [`angular_resample`]; no whole revolution, or teeth that did not pass the sensor.
    pub fn average(
        &self,
        wheel: usize,
        settings: &AngularSettings,
    ) -> Result<SynchronousAverage, SignalError> {
        if let Some(passing) = self.passing(wheel, settings)? {
            return passing.average();
        }
        let angular = self.angular(wheel, settings)?;
        match angular.revolutions() {
            0 => Err(SignalError::TooFewRevolutions { revolutions: 0.0, needed: 1 }),
            _ => Ok(average_of(&angular, &angular.values)),
        }
    }

    /// The phase of a wheel, whose first tooth enters contact at angle 0 where that is known.
    pub(super) fn wheel_phase(&self, wheel: usize) -> Result<ShaftPhase, SignalError> {
        let of = &self.train.wheels[wheel];
        let mut phase = self.phase(of.shaft)?;
        if phase.zero == AngleZero::Simulated {
            phase.revolutions.iter_mut().for_each(|angle| *angle += of.start_rev);
        }
        Ok(phase)
    }

    /// Looks for what does not fit over the angle of the shaft whose phase is known, and for foreign tones that make much of the recording. The
    /// angles of the other shafts follow from the tooth counts.
    ///
    /// # Errors
    /// Those of [`angular_resample`].
    pub fn check(&self) -> Result<Vec<SignalWarning>, SignalError> {
        let TrainTurning::Shaft { shaft, phase, .. } = self.turning else { return Ok(Vec::new()) };
        check_channel(self.signal)?;
        let angular = angular_resample(self.signal, phase, &AngularSettings::default())?;
        Ok(self.check_over(&angular, *shaft).warnings)
    }

    /// What is doubtful about the phase, and what the sensor did wrong; nothing in a simulation.
    pub fn doubts(&self) -> Vec<SignalWarning> {
        let TrainTurning::Shaft { phase, .. } = self.turning else { return Vec::new() };
        let faults = sensor_faults(self.signal).into_iter().map(SignalWarning::SensorFault);
        phase.warnings.iter().cloned().chain(faults).collect()
    }

    /// Looks for what does not fit, and for foreign tones, over the angle of a shaft; for nothing where its phase follows from that of another.
    fn check_over(&self, angular: &AngularSignal, shaft: usize) -> RecordingCheck {
        match self.turning {
            TrainTurning::Shaft { shaft: of, phase, stated } if *of == shaft => {
                RecordingCheck::new(angular, self.train, shaft, *stated, phase, self.sampling_rate_hz)
            }
            _ => RecordingCheck::default(),
        }
    }

    /// Processes the channel for every wheel, and looks for what does not fit and for foreign tones.
    ///
    /// A wheel that turns too little for an average, or for a segment, gets no result but a warning, where others turn often enough. The angle of
    /// the shaft whose phase is known is checked against what is stated, since the angles of the other shafts follow from the tooth counts.
    ///
    /// # Arguments
    /// * `settings` - how
    ///
    /// # Errors
    /// Those of [`super::process_channel`] and [`super::process_segments`], with the first wheel that has one; that a wheel turns too little only
    /// where all do.
    pub fn process(&self, settings: &TrainSettings) -> Result<TrainRecords, WheelError> {
        let mut found = TrainRecords { wheels: Vec::new(), foreign: None, warnings: self.doubts() };
        let mut first_without = None;
        for (number, of) in self.train.wheels.iter().enumerate() {
            let without = |error| WheelError { wheel: of.name.clone(), teeth: of.teeth, error };
            let is_first = self.train.wheels.iter().position(|other| other.shaft == of.shaft) == Some(number);
            let angular = check_channel(self.signal).and_then(|()| self.angular(number, &settings.angular));
            let check = match (&angular, is_first) {
                (Ok(angular), true) => self.check_over(angular, of.shaft),
                _ => RecordingCheck::default(),
            };
            found.foreign = found.foreign.or(check.foreign);
            let mut warnings = check.warnings;
            match angular.and_then(|angular| self.process_wheel(number, &angular, settings)) {
                Ok(wheel) => found.wheels.push(wheel),
                Err(
                    error @ (SignalError::TooFewRevolutions { .. }
                    | SignalError::TooFewPassages { .. }
                    | SignalError::TeethNotSeen { .. }),
                ) => {
                    warnings.push(SignalWarning::WheelWithoutAverage(without(error.clone())));
                    first_without.get_or_insert(without(error));
                }
                Err(error) => return Err(without(error)),
            }
            for warning in warnings {
                if !found.warnings.contains(&warning) {
                    found.warnings.push(warning);
                }
            }
        }
        // Where one shaft has it all, others have nothing because of that one.
        let holder = found.wheels.iter().find(|of| of.records.iter().all(|record| record.held > Some(MOST)));
        let holder = holder.map(|of| &self.train.wheels[of.wheel]);
        let holder = holder.map(|TrainWheel { name, teeth, .. }| format!("{name} ({teeth} teeth)"));
        for record in found.wheels.iter_mut().flat_map(|of| &mut of.records) {
            for warning in &mut record.warnings {
                if let SignalWarning::NothingSynchronous { other, .. } = warning {
                    other.clone_from(&holder);
                }
                if !found.warnings.contains(warning) {
                    found.warnings.push(warning.clone());
                }
            }
        }
        match first_without {
            Some(error) if found.wheels.is_empty() => Err(error),
            _ => Ok(found),
        }
    }

    /// Processes the channel for one wheel, and looks for nothing else.
    ///
    /// # Arguments
    /// * `wheel` - its number
    /// * `settings` - how
    ///
    /// # Errors
    /// Those of [`Self::process`], of this wheel.
    pub fn process_one(&self, wheel: usize, settings: &TrainSettings) -> Result<WheelRecords, SignalError> {
        check_channel(self.signal)?;
        self.process_wheel(wheel, &self.angular(wheel, &settings.angular)?, settings)
    }

    /// Does what [`Self::process_one`] does with the channel over the angle of the wheel.
    ///
    /// # Arguments
    /// * `wheel` - its number
    /// * `angular` - of [`Self::angular`] with the same settings
    /// * `settings` - how
    ///
    /// # Errors
    /// Those of [`Self::process_one`].
    pub fn process_wheel(
        &self,
        wheel: usize,
        angular: &AngularSignal,
        settings: &TrainSettings,
    ) -> Result<WheelRecords, SignalError> {
        let of = &self.train.wheels[wheel];
        let mut chain = ChainSettings {
            angular: settings.angular,
            separation: Some(self.train.separation(wheel, &settings.separation)),
        };
        let (mean_speed_hz, phase) = match self.turning {
            TrainTurning::Shaft { .. } => {
                let phase = self.wheel_phase(wheel)?;
                (phase.mean_speed_hz(self.sampling_rate_hz), Some(phase))
            }
            TrainTurning::SimulatedPair(shafts) => {
                // Nothing is interpolated at constant speed, so that nothing is weakened.
                if shafts.is_steady() {
                    chain.angular.interpolation = Interpolation::BandLimited;
                }
                (shafts.mean_speed_hz(WheelName::BOTH[wheel.min(1)]), None)
            }
        };
        let records = match (self.passing(wheel, &settings.angular)?, settings.revolutions) {
            (Some(passing), revolutions) => passing.records(&chain, revolutions)?,
            (None, None) => vec![process_angular(angular, of.teeth, &chain)?],
            (None, Some(count)) => process_angular_segments(angular, of.teeth, &chain, count)?,
        };
        let second = |turned_rev: f64| match &phase {
            Some(phase) => phase.sample_at(angular.start_rev + turned_rev) / self.sampling_rate_hz,
            None => turned_rev / mean_speed_hz,
        };
        let count = settings.revolutions.unwrap_or(angular.revolutions()) as f64;
        let middles_s = (0..records.len()).map(|record| second((record as f64 + 0.5) * count)).collect();
        Ok(WheelRecords { wheel, mean_speed_hz, records, middles_s })
    }
}
