//! The signal chain from simulated channels to a record: sampling rate, path, noise, average, difference signal, indicators.
//!
//! Average, difference and indicators are computed from the samples of a raw channel as they are kept, with noise and rounding to
//! single precision. A user who reads the raw channel finds the same average.

use std::cell::OnceCell;
use std::error::Error;

use meshtone::batch::{Observation, SignalRecorder};
use meshtone::damage::damages_of_fault;
use meshtone::scenario::{ScenarioWarning, Sensor};
use meshtone::sensor::{Channel, ContactFigures, SignalSource};
use meshtone::signal::{AngleZero, AntiAliasing, Edge, GearTrain, MeanPart, ShaftPhase, SignalError};
use meshtone::tuning::DifferenceChain;
use meshtone::{Simulation, Stages, StepJudgement};

use super::kept::KeptChain;
use super::window::Window;
use super::{Record, RecordFault, RecordSpall, RecordWheel, TurningWheel, noise, path, start};
use crate::draw::DrawnRecord;
use crate::plan::{Content, FaultPlace, FaultyBase, Keep};

/// Parts of a record by whose ends growth is judged.
const PARTS: usize = 10;
/// Growth between their quietest above which a motion is not steady: some tenfold over the whole record.
const MOST_GROWTH: f64 = 6.0;

/// Refuses a motion that should be steady but grows throughout the record.
///
/// # Arguments
/// * `channels`, `samples` - what was simulated
/// * `damping_key` - key of the scenario by which the damping is raised
fn refuse_growth(channels: &[Channel], samples: &[Vec<f32>], damping_key: &str) -> Result<(), String> {
    let accelerations = channels.iter().zip(samples).filter(|(channel, _)| channel.is_acceleration());
    growth(accelerations.map(|(_, samples)| &samples[..])).map_or(Ok(()), |growth| {
        Err(format!(
            "the motion grows from the record's start to its end, by a factor of {growth:.0}: damping does \
             not remove the energy that the varying mesh stiffness adds to a mode; raise {damping_key} or \
             use other teeth or another speed"
        ))
    })
}

/// (-) By what factor the accelerations grow from a record's start to its end; none where they hardly do. Of three tenths at either end the
/// quietest counts, as a damaged tooth that meets in the others is no growth.
fn growth<'a>(signals: impl Iterator<Item = &'a [f32]>) -> Option<f64> {
    let mut squares = [0.0; PARTS];
    for samples in signals {
        let part = (samples.len() / PARTS).max(1);
        for (square, samples) in squares.iter_mut().zip(samples.chunks(part)) {
            *square += samples.iter().map(|&x| f64::from(x) * f64::from(x)).sum::<f64>();
        }
    }
    let [a, b, c, .., x, y, z] = squares;
    let (first, last) = (a.min(b).min(c), x.min(y).min(z));
    (last > MOST_GROWTH * MOST_GROWTH * first).then(|| (last / first).sqrt())
}

/// A simulation that is read like a recording: from the mark on, at the sampling rate of the data set.
pub(super) struct View<'a> {
    content: &'a Content,
    keep: &'a Keep,
    simulated: &'a Stages,
    window: Window,
    /// (rev) Angle of the input at every sample from the record's first on, computed when it is needed first.
    input_rev: OnceCell<Vec<f64>>,
}

impl<'a> View<'a> {
    pub fn new(content: &'a Content, window: Window, simulated: &'a Stages) -> Self {
        Self { content, keep: &content.keep, simulated, window, input_rev: OnceCell::new() }
    }

    /// Makes a record of the simulation of a pair.
    pub fn record_of_pair(
        &self,
        drawn: DrawnRecord,
        observation: Observation,
        recorder: SignalRecorder,
    ) -> Result<Record, Box<dyn Error>> {
        let samples = self.before_linear_sensors(recorder);
        let parts = self.simulated.scenario.model.teeth_part();
        let slack = if parts { observation.apart_fraction } else { observation.tension_fraction };
        self.record(drawn, &samples, &observation.warnings, vec![slack])
    }

    /// Makes a record of the simulation of a train, whose sensors are applied already.
    pub fn record_of_train(
        &self,
        drawn: DrawnRecord,
        simulation: &Simulation,
    ) -> Result<Record, Box<dyn Error>> {
        // The error is only estimated, as that of a pair's record.
        let of_signals = simulation.warnings_of_signals(StepJudgement::Estimated);
        let warnings = [self.simulated.warnings(), of_signals].concat();
        let channels = &simulation.channels;
        let single = |channel: &Channel| {
            let name = channel.name();
            let signal = channels.signal(&name);
            let signal =
                signal.ok_or_else(|| format!("the simulation of the gearbox has no signal `{name}`"))?;
            Ok::<_, String>(signal.iter().map(|&value| value as f32).collect())
        };
        let samples: Vec<Vec<f32>> = self.keep.simulated().iter().map(single).collect::<Result<_, _>>()?;
        let apart =
            |mesh| ContactFigures::of_force(channels.of(SignalSource::MeshForce(mesh))).apart_fraction;
        let apart = (0..self.simulated.meshes.len()).map(apart).collect();
        self.record(drawn, &samples, &warnings, apart)
    }

    /// Makes the record of a healthy twin, which has only the difference signal.
    pub fn twin(&self, drawn: DrawnRecord, recorder: SignalRecorder) -> Result<Record, SignalError> {
        let simulated = self.keep.simulated();
        let samples = self.before_linear_sensors(recorder);
        let mut record = self.empty(drawn);
        if let Some(analysed) = simulated.iter().position(|channel| *channel == self.keep.analysed) {
            let only = analysed..analysed + 1;
            let channels = self.passed(&record.drawn, &simulated[only.clone()], &samples[only])?;
            record.clean_difference = self.clean_difference(&channels[0])?;
        }
        Ok(record)
    }

    /// Makes the record.
    ///
    /// The channels are resampled, passed along the path to the sensor, and given noise, in this order. The enhanced signal starts from
    /// the difference before the noise; everything else is computed with it.
    fn record(
        &self,
        drawn: DrawnRecord,
        samples: &[Vec<f32>],
        warnings: &[ScenarioWarning],
        slack_fractions: Vec<f64>,
    ) -> Result<Record, Box<dyn Error>> {
        let keep = self.keep;
        let simulated = keep.simulated();
        if self.is_steady() {
            let damping_key = match self.simulated.scenario.rig() {
                Some(_) => "rig.damping_ratio",
                None => "damping_ratio of meshes, shafts and bearings",
            };
            refuse_growth(&simulated, samples, damping_key)?;
        }
        let mut channels = self.passed(&drawn, &simulated, samples)?;
        let analysed = simulated.iter().position(|channel| *channel == keep.analysed);
        let mut record = Record { slack_fractions, ..self.empty(drawn) };
        for warning in warnings {
            if !record.warnings.contains(&warning.kind) {
                record.warnings.push(warning.kind);
            }
        }
        if let Some(analysed) = analysed {
            record.clean_difference = self.clean_difference(&channels[analysed])?;
        }
        for (number, (kind, channel)) in simulated.iter().zip(&mut channels).enumerate() {
            if kind.is_acceleration() {
                let (background, rate_hz) = (self.content.background.as_ref(), keep.sampling_rate_hz);
                noise::add(&record.drawn, background, number as u64, rate_hz, channel)?;
            }
        }
        self.chain()?.fill(&mut record, analysed, channels)?;
        Ok(record)
    }

    /// Whether motor and brake are steady: the record then begins at the mark.
    fn is_steady(&self) -> bool {
        self.simulated.is_steady()
    }

    /// How a wheel turns.
    fn wheel(&self, wheel: &str) -> &TurningWheel {
        &self.window.turning.wheels[self.window.turning.number(wheel)]
    }

    /// The fault at a place; none of a healthy twin.
    fn fault(&self, place: FaultPlace) -> Option<RecordFault> {
        match place {
            FaultPlace::Teeth(number) => {
                let (_, fault) = self.simulated.scenario.placed_faults().into_iter().nth(number)?;
                let pairs = self.simulated.pairs.iter();
                Some(RecordFault {
                    kind: fault.damage.kind(),
                    wheel: Some(fault.wheel.clone()),
                    tooth: start::tooth(fault, &self.window.turning, &self.window.counted_from),
                    severity: *self.simulated.fault_severities.get(number)?,
                    area_percent: (pairs.flat_map(|pair| damages_of_fault(&pair.damaged, number)))
                        .flat_map(|(_, damage)| damage.numbers("area_percent"))
                        .reduce(f64::max),
                    spall: None,
                })
            }
            FaultPlace::Spall { bearing, number } => {
                let (_, rolling) = self.simulated.bearings.iter().find(|(other, _)| *other == bearing)?;
                let sizes = *rolling.parts.spalls.get(number)?;
                let order = rolling.parts.geometry.defect_orders().of_defect(sizes.place);
                let bearing = self.simulated.scenario.bearings()[bearing].seat_name();
                Some(RecordFault {
                    kind: sizes.place.kind(),
                    severity: sizes.severity,
                    spall: Some(RecordSpall { bearing, sizes, order }),
                    ..RecordFault::default()
                })
            }
        }
    }

    fn empty(&self, drawn: DrawnRecord) -> Record {
        let content = self.content;
        let places = FaultyBase::new(&content.base, &content.classes[drawn.class].faults).places;
        let turning = &self.window.turning;
        let starts_at_tooth = self.is_steady() && turning.enter_together;
        let wheel = |(number, wheel): (usize, &TurningWheel)| RecordWheel {
            teeth: wheel.teeth,
            speed_hz: wheel.speed_hz,
            angle_rev: if starts_at_tooth { 0.0 } else { self.angles(number, 1)[0] },
        };
        let operation = &self.simulated.scenario.operation;
        Record {
            drawn,
            faults: places.into_iter().filter_map(|place| self.fault(place)).collect(),
            wheels: turning.wheels.iter().enumerate().map(wheel).collect(),
            input_speed_hz: operation.pinion_speed_hz,
            brake_torque_nm: operation.brake_torque_nm,
            sampling_rate_hz: self.keep.sampling_rate_hz,
            simulated_s: self.span_s(),
            ..Record::default()
        }
    }

    /// (s) How long the record is.
    fn span_s(&self) -> f64 {
        let time = &self.simulated.time;
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
        recorder.channels_by(|channel, motion| match self.linear_sensor(channel) {
            Some(_) => motion,
            None => self.simulated.shown(channel, motion),
        })
    }

    /// The sensor of a channel, where its signal is a linear function of its place's motion and not made yet.
    fn linear_sensor(&self, channel: &Channel) -> Option<&'a Sensor> {
        // Those of shafts of beams are applied in the simulation.
        self.simulated.scenario.rig()?;
        let is_of = |sensor: &&Sensor| *channel == Channel::Sensor(sensor.name());
        self.simulated.scenario.sensors.iter().find(is_of).filter(|sensor| sensor.is_linear())
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
        let (from_hz, to_hz) = (self.simulated.time.sampling_rate_hz, keep.sampling_rate_hz);
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

    /// (rev) Angle of a wheel at samples of the simulation from the record's first on, from where its teeth begin to be counted.
    ///
    /// # Arguments
    /// * `number` - of the wheel
    /// * `most` - how many samples
    fn angles(&self, number: usize, most: usize) -> Vec<f64> {
        let wheel = &self.window.turning.wheels[number];
        let ratio = wheel.pitches_per_revolution / f64::from(wheel.teeth);
        let first = self.start_rev(number);
        let revolutions = self.input_rev.get_or_init(|| {
            let (time, from) = (&self.simulated.time, self.window.margin);
            // The torque has no part in it.
            let motion = self.simulated.motion().with_ripple(Vec::new());
            let kept = motion.skip(time.first_kept_sample + from).take(time.kept_samples() - from);
            kept.map(|sample| sample.revolutions).collect()
        });
        revolutions.iter().take(most).map(|revolution| revolution * ratio + first).collect()
    }

    /// Phase of an averaged wheel's shaft at the recording's samples.
    fn phase(&self, wheel: &str, samples: usize) -> Result<ShaftPhase, SignalError> {
        let rate_hz = self.keep.sampling_rate_hz;
        let turning = &self.window.turning;
        if self.is_steady() && turning.enter_together {
            return ShaftPhase::constant(self.wheel(wheel).speed_hz, rate_hz, samples);
        }
        // The wheels of a pair turn with the marked one.
        let number = if turning.enter_together { turning.marked } else { turning.number(wheel) };
        let turns = f64::from(turning.wheels[number].teeth) / f64::from(self.wheel(wheel).teeth);
        let mut angles = self.angles(number, usize::MAX);
        // Where the planets of a set stand is known with the angles since the simulation's start.
        let is_of_set = number >= self.simulated.scenario.own_wheels();
        if is_of_set {
            let first = self.start_rev(number);
            angles.iter_mut().for_each(|angle| *angle -= first);
        }
        let step = self.simulated.time.sampling_rate_hz / rate_hz;
        let at = |i: usize| {
            let place = i as f64 * step;
            let (whole, last) = (place as usize, angles.len() - 1);
            let from = angles[whole.min(last)];
            let angle = from + (place - whole as f64) * (angles[(whole + 1).min(last)] - from);
            angle * turns
        };
        let mut phase = ShaftPhase::new(0, (0..samples).map(at).collect())?;
        if is_of_set {
            phase.zero = AngleZero::Simulated;
        }
        Ok(phase)
    }

    /// (rev) Where a wheel stands at the simulation's start, counted from its first tooth of the record.
    fn start_rev(&self, number: usize) -> f64 {
        let wheel = &self.window.turning.wheels[number];
        (wheel.first_pitch - self.window.counted_from[number] as f64) / f64::from(wheel.teeth)
    }

    /// The chain that makes a record of the channels: of the machine with the place of the analysed channel's sensor, and with the wheels of
    /// planetary sets counted from their first tooth of the record.
    fn chain(&self) -> Result<KeptChain<'_>, SignalError> {
        let scenario = &self.simulated.scenario;
        let mut train = GearTrain::of_stages(self.simulated).at_sensor(scenario, &self.keep.analysed.name());
        for (number, wheel) in train.wheels.iter_mut().enumerate().skip(scenario.own_wheels()) {
            wheel.start_rev = self.start_rev(number);
        }
        let wheels = self.keep.wheel.all().iter();
        let phases = wheels.map(|wheel| self.phase(wheel, self.samples())).collect::<Result<_, _>>()?;
        Ok(KeptChain { keep: self.keep, train, phases })
    }

    /// The difference signal that is enhanced, without noise.
    fn clean_difference(&self, signal: &[f32]) -> Result<Vec<f64>, SignalError> {
        if self.content.tuned.is_none() {
            return Ok(Vec::new());
        }
        // The same settings as those of the signals that the enhancement was tuned with.
        let angular = DifferenceChain::angular_settings(self.simulated.scenario.model);
        let (_, record) = self.chain()?.analyse(signal, 0, angular, MeanPart::Removed)?;
        Ok(record.parts.difference)
    }
}

#[cfg(test)]
mod tests {
    use super::growth;

    #[test]
    fn only_what_grows_throughout_is_refused() {
        let signal = |of: &dyn Fn(f32) -> f32| -> Vec<f32> {
            (0..1000).map(|n| of(n as f32 / 1000.0) * (n as f32).sin()).collect()
        };
        let factor = |of: &dyn Fn(f32) -> f32| growth([&signal(of)[..]].into_iter());
        assert!(factor(&|part| (3.0 * part).exp()).is_some_and(|factor| (7.5..9.0).contains(&factor)));
        assert!(factor(&|part| 1.0 + 0.01 * (8.4 * part).exp()).is_some());
        assert_eq!(factor(&|part| if part > 0.95 { 30.0 } else { 1.0 }), None);
        // A tooth that meets every 0.4 of the record, and every quarter, once in the first three tenths and twice in the last.
        assert_eq!(factor(&|part| if (part + 0.25) % 0.4 < 0.05 { 30.0 } else { 1.0 }), None);
        assert_eq!(factor(&|part| if (part + 0.03) % 0.25 < 0.05 { 30.0 } else { 1.0 }), None);
        assert_eq!(growth(std::iter::empty()), None);
    }
}
