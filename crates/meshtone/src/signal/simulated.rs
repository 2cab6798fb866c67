//! The chain for what was simulated: the scenario says how far the shafts have turned.

use super::average::average_of;
use super::check::{check_channel, check_length};
use super::{
    AngleZero, AngularSignal, ChainSettings, Interpolation, Record, ShaftPhase, SignalError,
    SynchronousAverage, angular_resample, process_angular_segments, process_average,
};
use crate::operation::{Motion, TimeGrid};
use crate::scenario::Scenario;
use crate::sensor::Channels;
use crate::simulate::Stages;
use crate::wheel::{Gears, WheelName};

/// Angles of the shafts of a simulated pair at its kept samples. At whole revolutions the wheel's first tooth
/// enters contact.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedShafts {
    teeth: [u32; 2],
    sampling_rate_hz: f64,
    samples: usize,
    turning: SimulatedAngle,
}

#[derive(Debug, Clone, PartialEq)]
enum SimulatedAngle {
    /// Whole numbers of samples in each revolution.
    Steady { start: usize, samples_per_pinion_revolution: usize },
    /// (rev) Angle of the pinion at each sample.
    Varying(Vec<f64>),
}

impl SimulatedShafts {
    /// The shafts of a scenario.
    ///
    /// # Arguments
    /// * `scenario` - what was simulated; a valid one
    /// * `start_s` - (s) [`Channels::start_s`]
    /// * `samples` - how many were kept
    pub fn new(scenario: &Scenario, start_s: f64, samples: usize) -> Self {
        let scenario = scenario.without_ignored_keys();
        let time = scenario.time_grid();
        Self::moving(&scenario.gears(), &time, scenario.motion(&time), (start_s, samples))
    }

    /// The shafts of a simulated pair. Those of a gearbox turn at other ratios and phases: see [`TrainRecording`](super::TrainRecording).
    ///
    /// # Arguments
    /// * `stages` - of the pair's simulation
    /// * `start_s`, `samples` - as of [`Self::new`]
    pub fn of_stages(stages: &Stages, start_s: f64, samples: usize) -> Self {
        Self::moving(&stages.layout.gears[0], &stages.time, stages.motion(), (start_s, samples))
    }

    /// The shafts of a pair that turn as a motion says, from a time on for some samples.
    fn moving(gears: &Gears, time: &TimeGrid, motion: Motion, (start_s, samples): (f64, usize)) -> Self {
        let start = sample_at(time, start_s);
        let turning = if motion.is_steady() {
            let samples_per_pinion_revolution = time.samples_per_pinion_revolution;
            SimulatedAngle::Steady { start, samples_per_pinion_revolution }
        } else {
            SimulatedAngle::Varying(
                motion.skip(start).take(samples).map(|sample| sample.revolutions).collect(),
            )
        };
        let teeth = [gears.pinion_teeth, gears.gear_teeth];
        Self { teeth, sampling_rate_hz: time.sampling_rate_hz, samples, turning }
    }

    /// The shafts of a simulation's channels.
    ///
    /// # Arguments
    /// * `scenario` - what was simulated
    /// * `channels` - the kept signals
    pub fn of_channels(scenario: &Scenario, channels: &Channels) -> Self {
        Self::new(scenario, channels.start_s, channels.len())
    }

    /// (S/s) Sampling rate that the scenario leads to.
    pub fn sampling_rate_hz(&self) -> f64 {
        self.sampling_rate_hz
    }

    /// Returns whether both shafts turn at constant speed.
    pub fn is_steady(&self) -> bool {
        matches!(self.turning, SimulatedAngle::Steady { .. })
    }

    /// Teeth of a shaft's wheel.
    ///
    /// # Arguments
    /// * `shaft` - that of which wheel
    pub fn teeth(&self, shaft: WheelName) -> u32 {
        self.teeth[shaft as usize]
    }

    /// (Hz) Mean speed of a shaft.
    ///
    /// # Arguments
    /// * `shaft` - that of which wheel
    pub fn mean_speed_hz(&self, shaft: WheelName) -> f64 {
        let pinion_hz = match &self.turning {
            SimulatedAngle::Steady { samples_per_pinion_revolution, .. } => {
                self.sampling_rate_hz / *samples_per_pinion_revolution as f64
            }
            SimulatedAngle::Varying(angles) => match angles[..] {
                [first, .., last] => (last - first) * self.sampling_rate_hz / (angles.len() - 1) as f64,
                _ => 0.0,
            },
        };
        pinion_hz * f64::from(self.teeth[0]) / f64::from(self.teeth(shaft).max(1))
    }

    /// A signal over whole revolutions of a shaft, from an angle on at which the wheel's first tooth enters contact.
    ///
    /// At constant speed there is nothing to interpolate: the samples of a revolution are the points, and a signal of whole
    /// revolutions, as the simulation keeps it, is continued periodically, so that none of it is left out.
    ///
    /// # Arguments
    /// * `signal` - one of the kept signals
    /// * `shaft` - that of which wheel
    /// * `settings` - how it is resampled where the speed varies
    ///
    /// # Errors
    /// A signal of another length; where the speed varies, what [`angular_resample`] refuses.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    /// use meshtone::signal::{ChainSettings, SimulatedShafts};
    /// use meshtone::wheel::WheelName;
    ///
    /// let mut scenario = Scenario::new(GearPair { pinion_teeth: 20, gear_teeth: 40, ..GearPair::example() });
    /// scenario.solver.sampling_rate_hz = 1e4;
    /// let channels = meshtone::simulate(&scenario)?.channels;
    /// let shafts = SimulatedShafts::of_channels(&scenario, &channels);
    /// let angular = shafts.angular(&channels["vertical_g"], WheelName::Gear, &ChainSettings::default())?;
    /// assert_eq!((angular.start_rev, angular.revolutions()), (0.0, 20));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn angular(
        &self,
        signal: &[f64],
        shaft: WheelName,
        settings: &ChainSettings,
    ) -> Result<AngularSignal, SignalError> {
        check_length("samples of a simulated signal", signal.len(), self.samples)?;
        match &self.turning {
            SimulatedAngle::Steady { start, samples_per_pinion_revolution: of_pinion } => {
                let [pinion, gear] = self.teeth.map(|teeth| teeth.max(1) as usize);
                Ok(from_first_tooth(signal, *start, shaft.choose(*of_pinion, of_pinion / pinion * gear)))
            }
            SimulatedAngle::Varying(_) => angular_resample(signal, &self.phase(shaft)?, &settings.angular),
        }
    }

    /// The angle of a shaft at each kept sample.
    ///
    /// # Arguments
    /// * `shaft` - that of which wheel
    ///
    /// # Errors
    /// Fewer than two samples.
    pub fn phase(&self, shaft: WheelName) -> Result<ShaftPhase, SignalError> {
        let pinion_rev = match &self.turning {
            SimulatedAngle::Steady { start, samples_per_pinion_revolution } => {
                let angle = |sample: usize| (start + sample) as f64 / *samples_per_pinion_revolution as f64;
                (0..self.samples).map(angle).collect()
            }
            SimulatedAngle::Varying(angles) => angles.clone(),
        };
        let pinion = ShaftPhase::new(0, pinion_rev)?.with_zero(AngleZero::Simulated);
        match shaft {
            WheelName::Pinion => Ok(pinion),
            WheelName::Gear => pinion.of_mate(self.teeth[0], self.teeth[1]),
        }
    }

    /// The phase of a shaft whose speed varies; none at constant speed.
    ///
    /// # Arguments
    /// * `shaft` - that of which wheel
    ///
    /// # Errors
    /// Fewer than two samples.
    pub fn varying_phase(&self, shaft: WheelName) -> Result<Option<ShaftPhase>, SignalError> {
        (!self.is_steady()).then(|| self.phase(shaft)).transpose()
    }

    /// Average over the whole revolutions of [`Self::angular`]; of fewer than two it is no more than what there is.
    ///
    /// # Arguments
    /// * `signal`, `shaft`, `settings` - as for [`Self::angular`]
    ///
    /// # Errors
    /// Those of [`Self::angular`].
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    /// use meshtone::signal::{ChainSettings, SimulatedShafts};
    /// use meshtone::wheel::WheelName;
    ///
    /// let mut scenario = Scenario::new(GearPair { pinion_teeth: 20, gear_teeth: 40, ..GearPair::example() });
    /// scenario.solver.sampling_rate_hz = 1e4;
    /// let channels = meshtone::simulate(&scenario)?.channels;
    /// let shafts = SimulatedShafts::of_channels(&scenario, &channels);
    /// let average = shafts.average(&channels["vertical_g"], WheelName::Gear, &ChainSettings::default())?;
    /// assert_eq!(average.revolutions, 20);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn average(
        &self,
        signal: &[f64],
        shaft: WheelName,
        settings: &ChainSettings,
    ) -> Result<SynchronousAverage, SignalError> {
        let angular = self.angular(signal, shaft, settings)?;
        Ok(average_of(&angular, &angular.values))
    }

    /// Does what [`super::process_channel`] does, for one wheel of a simulated pair.
    ///
    /// # Arguments
    /// * `signal` - one of the kept signals
    /// * `shaft` - which wheel's
    /// * `settings` - how
    ///
    /// # Errors
    /// Those of [`super::process_channel`].
    pub fn process(
        &self,
        signal: &[f64],
        shaft: WheelName,
        settings: &ChainSettings,
    ) -> Result<Record, SignalError> {
        check_channel(signal)?;
        let average = self.average(signal, shaft, settings)?.of_enough_revolutions()?;
        process_average(average, self.teeth(shaft), &self.settings(settings))
    }

    /// Does what [`super::process_segments`] does, for one wheel of a simulated pair.
    ///
    /// # Arguments
    /// * `signal`, `shaft`, `settings` - as for [`Self::process`]
    /// * `revolutions` - (at least 2) of each segment
    ///
    /// # Errors
    /// Those of [`super::process_segments`].
    pub fn process_segments(
        &self,
        signal: &[f64],
        shaft: WheelName,
        settings: &ChainSettings,
        revolutions: usize,
    ) -> Result<Vec<Record>, SignalError> {
        check_channel(signal)?;
        let angular = self.angular(signal, shaft, settings)?;
        process_angular_segments(&angular, self.teeth(shaft), &self.settings(settings), revolutions)
    }

    /// Nothing is interpolated at constant speed, so nothing is weakened.
    fn settings(&self, settings: &ChainSettings) -> ChainSettings {
        let mut settings = settings.clone();
        if self.is_steady() {
            settings.angular.interpolation = Interpolation::BandLimited;
        }
        settings
    }
}

impl ShaftPhase {
    /// The phase of the input of a simulation at its kept samples.
    ///
    /// # Arguments
    /// * `scenario` - what was simulated; a valid one
    /// * `start_s` - (s) time of the first sample; that of the first kept one is 0
    /// * `samples` - how many were kept
    ///
    /// # Errors
    /// Fewer than two samples.
    pub fn of_simulated_input(
        scenario: &Scenario,
        start_s: f64,
        samples: usize,
    ) -> Result<Self, SignalError> {
        let time = scenario.time_grid();
        let start = sample_at(&time, start_s);
        let motion = scenario.motion(&time);
        let revolutions = motion.skip(start).take(samples).map(|sample| sample.revolutions).collect();
        Ok(Self::new(0, revolutions)?.with_zero(AngleZero::Simulated))
    }
}

/// Number of the sample at a time since the first kept one.
fn sample_at(time: &TimeGrid, start_s: f64) -> usize {
    let since_kept = (start_s * time.sampling_rate_hz).round().max(0.0) as usize;
    time.first_kept_sample.saturating_add(since_kept).min(time.samples)
}

/// The samples over whole revolutions, from the first whole one on.
fn from_first_tooth(signal: &[f64], start: usize, points: usize) -> AngularSignal {
    let before = (points - start % points) % points;
    let values = if signal.len().is_multiple_of(points) && !signal.is_empty() {
        [&signal[before..], &signal[..before]].concat()
    } else {
        let whole = signal.len().saturating_sub(before) / points * points;
        signal.get(before..before + whole).unwrap_or(&[]).to_vec()
    };
    AngularSignal {
        points_per_revolution: points,
        start_rev: 0.0,
        nyquist_order: points as f64 / 2.0,
        values,
    }
}

#[cfg(test)]
mod tests {
    use super::from_first_tooth;

    #[test]
    fn whole_revolutions_are_turned_and_others_cut() {
        let signal = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        assert_eq!(from_first_tooth(&signal, 0, 3).values, signal);
        assert_eq!(from_first_tooth(&signal, 4, 3).values, [3.0, 4.0, 5.0, 6.0, 1.0, 2.0]);
        assert_eq!(from_first_tooth(&signal, 3, 4).values, [2.0, 3.0, 4.0, 5.0]);
        assert_eq!(from_first_tooth(&signal, 1, 5).revolutions(), 0);
        assert_eq!(from_first_tooth(&[], 1, 5).revolutions(), 0);
    }
}
