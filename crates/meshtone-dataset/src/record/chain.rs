//! The signal chain from simulated channels to a record: sampling rate, path, noise, average, difference signal, indicators.
//!
//! Average, difference and indicators are computed from the samples of a raw channel as they are kept, with noise and rounding to
//! single precision. A user who reads the raw channel finds the same average.

use std::error::Error;

use meshtone::Stages;
use meshtone::batch::{Observation, SignalRecorder};
use meshtone::damage::damages_of_fault;
use meshtone::scenario::{Fault, Sensor, WheelName};
use meshtone::sensor::Channel;
use meshtone::signal::{
    AngularSettings, AntiAliasing, ChainSettings, Edge, MeanPart, Record as Analysis, SeparationSettings,
    ShaftPhase, SignalError, angular_resample, octave_bands, process_channel,
};
use meshtone::tuning::DifferenceChain;

use super::window::Window;
use super::{Record, RecordFault, noise, path};
use crate::draw::DrawnRecord;
use crate::plan::{Content, Keep, OverAngle};

/// Makes a record of its simulation.
///
/// The channels are resampled, passed along the path to the sensor, and given noise, in this order. The enhanced signal starts from
/// the difference before the noise; everything else is computed with it.
pub(super) fn record(
    content: &Content,
    drawn: DrawnRecord,
    stages: &Stages,
    observation: Observation,
    recorder: SignalRecorder,
) -> Result<Record, Box<dyn Error>> {
    let keep = &content.keep;
    let view = View::new(content, &drawn, &stages.scenario.faults, stages)?;
    let simulated = keep.simulated();
    let samples = view.before_linear_sensors(recorder);
    if view.is_steady() {
        refuse_growth(&simulated, &samples)?;
    }
    let mut channels = view.passed(&drawn, &simulated, &samples)?;
    let analysed = simulated.iter().position(|channel| *channel == keep.analysed);
    let mut record = view.empty(drawn);
    let parts = stages.scenario.model.teeth_part();
    record.slack_fraction = if parts { observation.apart_fraction } else { observation.tension_fraction };
    for warning in &observation.warnings {
        if !record.warnings.contains(&warning.kind) {
            record.warnings.push(warning.kind);
        }
    }
    if let Some(analysed) = analysed {
        record.clean_difference = view.clean_difference(&channels[analysed], content)?;
    }
    for (number, (kind, channel)) in simulated.iter().zip(&mut channels).enumerate() {
        if kind.is_acceleration() {
            noise::add(&record.drawn, number as u64, channel);
        }
    }
    if let (Some(analysed), true) = (analysed, keep.is_analysed()) {
        let analysis = view.analyse(&channels[analysed], AngularSettings::default(), MeanPart::default())?;
        if keep.average {
            record.average = view.of_revolution(&analysis.average.values)?;
        }
        if keep.difference {
            record.difference = view.of_revolution(&analysis.parts.difference)?;
        }
        if keep.indicators {
            record.indicators = analysis.indicators.table("g");
            // At higher orders the filter attenuates the signal.
            let passed = PASSED * analysis.average.nyquist_order;
            record.octaves = octave_bands(&analysis.parts.difference, view.teeth(), passed)?;
        }
    }
    channels.truncate(keep.channels.len());
    if let Some(seconds) = keep.duration_s {
        view.cut(&mut channels, seconds)?;
    }
    if let Some(angle) = keep.over_angle {
        record.sampling_rate_hz = angle.points_per_revolution as f64 * view.shaft_hz();
        for channel in &mut channels {
            *channel = view.over_angle(channel, angle)?;
        }
    }
    record.channels = channels;
    Ok(record)
}

/// Makes the record of a healthy twin, which has only the difference signal.
pub(super) fn twin(
    content: &Content,
    drawn: DrawnRecord,
    faults: &[Fault],
    stages: &Stages,
    recorder: SignalRecorder,
) -> Result<Record, SignalError> {
    let view = View::new(content, &drawn, faults, stages)?;
    let simulated = content.keep.simulated();
    let samples = view.before_linear_sensors(recorder);
    let mut record = view.empty(drawn);
    if let Some(analysed) = simulated.iter().position(|channel| *channel == content.keep.analysed) {
        let only = analysed..analysed + 1;
        let channels = view.passed(&record.drawn, &simulated[only.clone()], &samples[only])?;
        record.clean_difference = view.clean_difference(&channels[0], content)?;
    }
    Ok(record)
}

/// (-) Part of half the sampling rate up to which the filter does not attenuate.
const PASSED: f64 = 0.8;
/// Growth is judged by the first and the last part of a record, one of so many.
const END: usize = 10;
/// Growth from the first to the last part above which a motion is not steady.
const MOST_GROWTH: f64 = 10.0;

/// Refuses a motion that should be steady but grows throughout the record.
fn refuse_growth(channels: &[Channel], samples: &[Vec<f32>]) -> Result<(), String> {
    let square = |part: &[f32]| part.iter().map(|&x| f64::from(x) * f64::from(x)).sum::<f64>();
    let (mut first, mut last) = (0.0, 0.0);
    for (_, samples) in channels.iter().zip(samples).filter(|(channel, _)| channel.is_acceleration()) {
        let part = samples.len() / END;
        first += square(&samples[..part]);
        last += square(&samples[samples.len() - part..]);
    }
    if last > MOST_GROWTH * MOST_GROWTH * first {
        let growth = (last / first).sqrt();
        return Err(format!(
            "the motion grows from the record's start to its end, by a factor of {growth:.0}: damping does not take what \
             the varying mesh stiffness puts into a mode; raise rig.damping_ratio or use other teeth or another speed"
        ));
    }
    Ok(())
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

/// A simulation that is read like a recording: from the mark on, at the sampling rate of the data set.
struct View<'a> {
    keep: &'a Keep,
    stages: &'a Stages,
    window: Window,
}

impl<'a> View<'a> {
    fn new(
        content: &'a Content,
        drawn: &DrawnRecord,
        faults: &[Fault],
        stages: &'a Stages,
    ) -> Result<Self, SignalError> {
        let keep = &content.keep;
        let window = Window::new(keep, drawn, faults, &stages.scenario, &stages.time)?;
        Ok(Self { keep, stages, window })
    }

    /// Whether motor and brake are steady: the record then begins at the mark.
    fn is_steady(&self) -> bool {
        self.stages.is_steady()
    }

    fn empty(&self, drawn: DrawnRecord) -> Record {
        let scenario = &self.stages.scenario;
        let fault = |(number, (fault, severity)): (usize, (&Fault, &f64))| RecordFault {
            kind: fault.damage.kind(),
            wheel: fault.wheel,
            tooth: self.window.start.tooth(fault, &scenario.gears),
            severity: *severity,
            area_percent: damages_of_fault(&self.stages.damaged, number)
                .into_iter()
                .flat_map(|(_, damage)| damage.numbers("area_percent"))
                .reduce(f64::max),
        };
        let faults = scenario.faults.iter().zip(&self.stages.fault_severities).enumerate();
        Record {
            drawn,
            faults: faults.map(fault).collect(),
            gear_angle_rev: if self.is_steady() { 0.0 } else { self.gear_angles()[0] },
            teeth: [scenario.gears.pinion_teeth, scenario.gears.gear_teeth],
            pinion_speed_hz: scenario.operation.pinion_speed_hz,
            brake_torque_nm: scenario.operation.brake_torque_nm,
            sampling_rate_hz: self.keep.sampling_rate_hz,
            simulated_s: self.span_s(),
            ..Record::default()
        }
    }

    /// (s) How long the record is.
    fn span_s(&self) -> f64 {
        let time = &self.stages.time;
        (time.kept_samples() - 2 * self.window.margin) as f64 * time.step_s()
    }

    /// Number of samples of the record. Of a steady motion so many that the last revolution is whole: its last value lies before the
    /// end of the revolution.
    fn samples(&self) -> usize {
        let span = self.span_s() * self.keep.sampling_rate_hz;
        if self.is_steady() { (span - 1e-6).ceil() as usize + 1 } else { (span - 1e-6).floor() as usize }
    }

    /// What was recorded of each channel: the signals of sensors that are not linear, else the motion of their places.
    fn before_linear_sensors(&self, recorder: SignalRecorder) -> Vec<Vec<f32>> {
        let stages = self.stages;
        recorder.channels_by(|channel, motion| match self.linear_sensor(channel) {
            Some(_) => motion,
            None => stages.shown(channel, motion),
        })
    }

    /// The sensor of a channel, where its signal is a linear function of its place's motion.
    fn linear_sensor(&self, channel: &Channel) -> Option<&Sensor> {
        let is_of = |sensor: &&Sensor| *channel == Channel::Sensor(sensor.name());
        self.stages.scenario.sensors.iter().find(is_of).filter(|sensor| sensor.is_linear())
    }

    /// The channels at the data set's rate, behind their sensors and the record's path.
    ///
    /// Linear sensors are applied here, together with the path, and not in the simulation: at the data set's rate there are fewer
    /// samples. Their past is read as well, as far as they remember it.
    fn passed(
        &self,
        drawn: &DrawnRecord,
        channels: &[Channel],
        samples: &[Vec<f32>],
    ) -> Result<Vec<Vec<f32>>, SignalError> {
        let keep = self.keep;
        let (from_hz, to_hz) = (self.stages.time.sampling_rate_hz, keep.sampling_rate_hz);
        let step = from_hz / to_hz;
        // The filter is steep because records begin at any moment: frequencies that fold back would differ between them.
        let filter = AntiAliasing::steep(from_hz, to_hz)?;
        let before = (self.window.margin.saturating_sub(filter.reach()) as f64 / step) as usize;
        let first = self.window.margin as f64 - before as f64 * step;
        let places = (0..self.samples() + 2 * before).map(|i| first + i as f64 * step);
        let signals: Vec<&[f32]> = samples.iter().map(Vec::as_slice).collect();
        let mut signals = filter.read(&signals, places, Edge::Reflect);
        for (channel, signal) in channels.iter().zip(&mut signals) {
            if channel.is_acceleration() {
                path::pass(drawn, &channel.name(), self.linear_sensor(channel), to_hz, signal);
            }
            signal.drain(..before);
            signal.truncate(self.samples());
        }
        Ok(signals)
    }

    /// (rev) Angle of the gear at every kept sample of the simulation, from the mark.
    fn gear_angles(&self) -> Vec<f64> {
        let Stages { time, scenario, .. } = self.stages;
        let gears = &scenario.gears;
        let ratio = f64::from(gears.pinion_teeth) / f64::from(gears.gear_teeth);
        let mark = f64::from(self.window.start.mark_teeth) / f64::from(gears.gear_teeth);
        let motion = scenario.motion(time).skip(time.first_kept_sample).take(time.kept_samples());
        motion.map(|sample| sample.revolutions * ratio - mark).collect()
    }

    /// Phase of the averaged wheel's shaft at the recording's samples.
    fn phase(&self, samples: usize) -> Result<ShaftPhase, SignalError> {
        let rate_hz = self.keep.sampling_rate_hz;
        let gears = &self.stages.scenario.gears;
        if self.is_steady() {
            return ShaftPhase::constant(self.shaft_hz(), rate_hz, samples);
        }
        let angles = self.gear_angles();
        let turns_per_gear_turn = f64::from(gears.gear_teeth) / f64::from(gears.teeth(self.keep.wheel));
        let step = self.stages.time.sampling_rate_hz / rate_hz;
        let at = |i: usize| {
            let place = i as f64 * step;
            let (whole, last) = (place as usize, angles.len() - 1);
            let from = angles[whole.min(last)];
            let angle = from + (place - whole as f64) * (angles[(whole + 1).min(last)] - from);
            angle * turns_per_gear_turn
        };
        ShaftPhase::new(0, (0..samples).map(at).collect())
    }

    fn analyse(
        &self,
        signal: &[f32],
        angular: AngularSettings,
        mean: MeanPart,
    ) -> Result<Analysis, SignalError> {
        let teeth = self.teeth();
        let separation = SeparationSettings {
            sidebands: self.keep.sidebands,
            shaft_orders: (1..=self.keep.shaft_orders).collect(),
            mean,
            ..SeparationSettings::new(teeth as usize)
        };
        let settings = ChainSettings { angular, separation: Some(separation) };
        let double: Vec<f64> = signal.iter().map(|&x| f64::from(x)).collect();
        process_channel(&double, &self.phase(signal.len())?, teeth, &settings)
    }

    /// The difference signal that is enhanced, without noise.
    fn clean_difference(&self, signal: &[f32], content: &Content) -> Result<Vec<f64>, SignalError> {
        if content.tuned.is_none() {
            return Ok(Vec::new());
        }
        // The same settings as those of the signals that the enhancement was tuned with.
        let angular = DifferenceChain::angular_settings(self.stages.scenario.model);
        Ok(self.analyse(signal, angular, MeanPart::Removed)?.parts.difference)
    }

    /// Teeth of the averaged wheel.
    fn teeth(&self) -> u32 {
        self.stages.scenario.gears.teeth(self.keep.wheel)
    }

    /// (Hz) Nominal speed of the averaged wheel's shaft.
    fn shaft_hz(&self) -> f64 {
        let gears = &self.stages.scenario.gears;
        let pinion_hz = self.stages.scenario.operation.pinion_speed_hz;
        match self.keep.wheel {
            WheelName::Pinion => pinion_hz,
            WheelName::Gear => pinion_hz * f64::from(gears.pinion_teeth) / f64::from(gears.gear_teeth),
        }
    }

    /// A signal over one revolution, with as many values as are asked for.
    fn of_revolution(&self, values: &[f64]) -> Result<Vec<f32>, SignalError> {
        let Some(angle) = self.keep.over_angle else {
            return Ok(values.iter().map(|&value| value as f32).collect());
        };
        let points = angle.points_per_revolution;
        at_points(values, values.len(), points, points, Edge::Periodic)
    }

    /// A channel over whole revolutions, from the mark on.
    fn over_angle(&self, signal: &[f32], angle: OverAngle) -> Result<Vec<f32>, SignalError> {
        // The chain refuses a constant channel.
        if let Some(&first) = signal.first().filter(|first| signal.iter().all(|x| x == *first)) {
            return Ok(vec![first; angle.values()]);
        }
        let double: Vec<f64> = signal.iter().map(|&x| f64::from(x)).collect();
        let angular = angular_resample(&double, &self.phase(signal.len())?, &AngularSettings::default())?;
        if angular.revolutions() < angle.revolutions {
            let what = "revolutions of a record for keep.revolutions";
            let (given, needed) = (angular.revolutions(), angle.revolutions);
            return Err(SignalError::TooFew { what, given, needed });
        }
        let (from, to) = (angular.points_per_revolution, angle.points_per_revolution);
        at_points(&angular.values, from, to, angle.values(), Edge::Reflect)
    }

    /// Cuts the channels to a duration.
    fn cut(&self, channels: &mut [Vec<f32>], seconds: f64) -> Result<(), SignalError> {
        let wanted = (seconds * self.keep.sampling_rate_hz).round() as usize;
        for channel in channels {
            if channel.len() < wanted {
                let what = "samples of a record for keep.duration_s";
                return Err(SignalError::TooFew { what, given: channel.len(), needed: wanted });
            }
            channel.truncate(wanted);
        }
        Ok(())
    }
}
