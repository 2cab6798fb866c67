//! From the channels of a record, simulated or recorded, to what a data set keeps of them.

use meshtone::signal::{
    AngleZero, AngularSettings, AngularSignal, AntiAliasing, Edge, GearTrain, MeanPart, Record as Analysis,
    SeparationSettings, ShaftPhase, SignalError, StatedTurning, TrainRecording, TrainSettings, TrainTurning,
    angular_resample,
};

use super::{Record, RecordAverage};
use crate::plan::{Keep, OverAngle};

/// How the channels of a record become what its data set keeps. Simulated and recorded channels take the same way.
pub(super) struct KeptChain<'a> {
    /// What is kept.
    pub keep: &'a Keep,
    /// The machine by its tooth counts.
    pub train: GearTrain,
    /// Phases of the shafts of the averaged wheels, at the samples of the channels.
    pub phases: Vec<ShaftPhase>,
}

impl KeptChain<'_> {
    /// Puts averages and channels into a record, whose wheels are known.
    ///
    /// # Arguments
    /// * `record` - the record
    /// * `analysed` - number of the analysed channel; none where nothing is analysed
    /// * `channels` - (g, N, …) in the order of [`Keep::simulated`], at the data set's rate; empty where one was not recorded
    ///
    /// # Errors
    /// Those of [`TrainRecording::process_one`]; channels that are shorter than what is kept.
    pub fn fill(
        &self,
        record: &mut Record,
        analysed: Option<usize>,
        mut channels: Vec<Vec<f32>>,
    ) -> Result<(), SignalError> {
        let keep = self.keep;
        let mut over_angle = None;
        if let Some(analysed) = analysed.filter(|_| keep.is_analysed()) {
            for number in 0..keep.wheel.all().len() {
                let (angular, average) = self.average(&channels[analysed], number)?;
                record.averages.push(average);
                // A planet's average begins elsewhere.
                let is_first = number == 0 && self.phases[0].zero != AngleZero::Simulated;
                over_angle = if is_first { Some((analysed, angular)) } else { over_angle };
            }
        }
        channels.truncate(keep.channels.len());
        let recorded = |channel: &&mut Vec<f32>| !channel.is_empty();
        if let Some(seconds) = keep.duration_s {
            let wanted = (seconds * keep.sampling_rate_hz).round() as usize;
            for channel in channels.iter_mut().filter(recorded) {
                if channel.len() < wanted {
                    let what = "samples of a record for keep.duration_s";
                    return Err(SignalError::TooFew { what, given: channel.len(), needed: wanted });
                }
                channel.truncate(wanted);
            }
        }
        if let Some(angle) = keep.over_angle {
            let speed_hz = record.wheels[self.number(&keep.wheel.all()[0])].speed_hz;
            record.sampling_rate_hz = angle.points_per_revolution as f64 * speed_hz;
            for (number, channel) in channels.iter_mut().enumerate().filter(|(_, channel)| recorded(channel))
            {
                let known = over_angle.take_if(|(analysed, _)| number == *analysed);
                *channel = self.over_angle(channel, angle, known.map(|(_, angular)| angular))?;
            }
        }
        record.channels = channels;
        Ok(())
    }

    /// The analysed channel over the angle of one of the averaged wheels, and the results of the signal chain for that wheel.
    ///
    /// # Arguments
    /// * `signal` - the analysed channel
    /// * `averaged` - number of the wheel among the averaged ones
    /// * `angular`, `mean` - how
    pub fn analyse(
        &self,
        signal: &[f32],
        averaged: usize,
        angular: AngularSettings,
        mean: MeanPart,
    ) -> Result<(AngularSignal, Analysis), SignalError> {
        let number = self.number(&self.keep.wheel.all()[averaged]);
        let teeth = self.train.wheels[number].teeth;
        let separation = SeparationSettings {
            sidebands: self.keep.sidebands,
            shaft_orders: (1..=self.keep.shaft_orders).collect(),
            mean,
            ..SeparationSettings::new(teeth as usize)
        };
        let phase = self.phases[averaged].clone();
        let turning = TrainTurning::Shaft {
            shaft: self.train.wheels[number].shaft,
            phase,
            stated: StatedTurning::Other,
        };
        let (signal, sampling_rate_hz) = (double(signal), self.keep.sampling_rate_hz);
        let recording =
            TrainRecording { signal: &signal, sampling_rate_hz, train: &self.train, turning: &turning };
        let settings = TrainSettings { angular, separation, revolutions: None };
        let angular = recording.angular(number, &settings.angular)?;
        let records = recording.process_wheel(number, &angular, &settings)?.records;
        let needed = meshtone::signal::FEWEST_REVOLUTIONS;
        let record = records.into_iter().next();
        Ok((angular, record.ok_or(SignalError::TooFewRevolutions { revolutions: 0.0, needed })?))
    }

    /// Number of a wheel of the plan in the machine.
    fn number(&self, wheel: &str) -> usize {
        self.train.wheels.iter().position(|known| known.name == wheel).unwrap_or(0)
    }

    /// A channel over the angle of an averaged wheel, and what it shows over the wheel's revolutions.
    fn average(
        &self,
        signal: &[f32],
        averaged: usize,
    ) -> Result<(AngularSignal, RecordAverage), SignalError> {
        let (angular, analysis) =
            self.analyse(signal, averaged, AngularSettings::default(), MeanPart::default())?;
        let mut kept = RecordAverage { warnings: analysis.warnings, ..RecordAverage::default() };
        if self.keep.average {
            kept.average = self.of_revolution(&analysis.average.values)?;
        }
        if self.keep.difference {
            kept.difference = self.of_revolution(&analysis.parts.difference)?;
        }
        if self.keep.indicators {
            kept.indicators = analysis.indicators.table("g");
        }
        Ok((angular, kept))
    }

    /// A signal over one revolution, with as many values as are asked for.
    fn of_revolution(&self, values: &[f64]) -> Result<Vec<f32>, SignalError> {
        let Some(angle) = self.keep.over_angle else {
            return Ok(values.iter().map(|&value| value as f32).collect());
        };
        let points = angle.points_per_revolution;
        at_points(values, values.len(), points, points, Edge::Periodic)
    }

    /// A channel over whole revolutions of the first averaged wheel, from the first one on.
    ///
    /// # Arguments
    /// * `signal` - the channel
    /// * `angle` - what is kept of it
    /// * `known` - the channel over the wheel's angle, where that is known
    fn over_angle(
        &self,
        signal: &[f32],
        angle: OverAngle,
        known: Option<AngularSignal>,
    ) -> Result<Vec<f32>, SignalError> {
        // The chain refuses a constant channel.
        if let Some(&first) = signal.first().filter(|first| signal.iter().all(|x| x == *first)) {
            return Ok(vec![first; angle.values()]);
        }
        let resampled = || angular_resample(&double(signal), &self.phases[0], &AngularSettings::default());
        let angular = known.map_or_else(resampled, Ok)?;
        if angular.revolutions() < angle.revolutions {
            let what = "revolutions of a record for keep.revolutions";
            let (given, needed) = (angular.revolutions(), angle.revolutions);
            return Err(SignalError::TooFew { what, given, needed });
        }
        let (from, to) = (angular.points_per_revolution, angle.points_per_revolution);
        at_points(&angular.values, from, to, angle.values(), Edge::Reflect)
    }
}

fn double(signal: &[f32]) -> Vec<f64> {
    signal.iter().map(|&x| f64::from(x)).collect()
}

/// Values at equal angles at another number of points in a revolution.
fn at_points(
    values: &[f64],
    from: usize,
    to: usize,
    count: usize,
    edge: Edge,
) -> Result<Vec<f32>, SignalError> {
    let step = from as f64 / to as f64;
    let filter = AntiAliasing::steep(from as f64, to as f64)?;
    let read = filter.read_double(values, (0..count).map(|i| i as f64 * step), edge);
    Ok(read.into_iter().map(|value| value as f32).collect())
}
