//! Fields of the signal chain: the vertical signal's average over the gear's revolutions.

use super::Trace;
use crate::operation::TimeGrid;
use crate::sensor::{Channels, SensorDirection, SignalSource};
use crate::signal::{
    AngleZero, AngularSettings, AntiAliasing, ChainSettings, Edge, GearTrain, Interpolation, Record,
    ShaftPhase, SignalError, StatedTurning, TrainRecording, TrainSettings, TrainTurning, process_channel,
    resample, resample_to, whole_ratio,
};
use crate::simulate::Stages;
use crate::wheel::WheelName;

/// Samples of the lower rate by which a periodic signal is continued at each end: more than the resampling filter and the
/// interpolation reach.
const CONTINUATION: usize = 40;

/// Adds the average, the difference and the order spectrum, where there are at least two revolutions of the gear and its
/// mesh frequency is below half of the rate.
///
/// As in the published code the signal is resampled first, and read by PCHIP between its samples; unlike there the
/// kept signal is continued periodically before, so that nothing rings.
pub(super) fn average(trace: &mut Trace, stages: &Stages, channels: &Channels, rate_hz: f64) {
    let rate_hz = rate_hz.min(stages.time.sampling_rate_hz);
    let Ok(record) = wheel_record(
        stages,
        WheelName::Gear,
        channels.of(SignalSource::Supports(SensorDirection::Vertical)),
        channels.of(SignalSource::ShaftSpeed(0)),
        rate_hz,
        ChainSettings { angular: by_pchip(), separation: None },
    ) else {
        return;
    };
    let points = record.average.values.len();
    // Orders up to half of the rate; the published spectrum doubles order 0 too.
    let orders = (record.average.nyquist_order * (1.0 + 1e-9)) as usize;
    let mut amplitude = record.order_spectrum;
    amplitude[0] *= 2.0;
    amplitude.truncate(orders.min(points / 2 + 1));
    trace.vector("synchronous_average_g", record.average.values);
    trace.vector("difference_g", record.parts.difference);
    trace.vector("order_amplitude_g", amplitude);
    trace.scalar("sa_rate_in_hz", rate_hz);
}

/// A signal is read by PCHIP between its samples, under every model.
fn by_pchip() -> AngularSettings {
    AngularSettings { interpolation: Interpolation::Pchip, ..AngularSettings::default() }
}

/// A wheel's average of a simulated channel and what follows from it, resampled to `rate_hz` first.
pub(crate) fn wheel_record(
    stages: &Stages,
    wheel: WheelName,
    signal: &[f64],
    pinion_speed_hz: &[f64],
    rate_hz: f64,
    settings: ChainSettings,
) -> Result<Record, SignalError> {
    let sampling_rate_hz = stages.time.sampling_rate_hz;
    let gears = &stages.layout.gears[0];
    let rates = Rates { from_hz: sampling_rate_hz, to_hz: rate_hz };
    let (signal, phase) = match whole_revolutions(stages, wheel) {
        Some(revolutions) => rates.periodic(signal, revolutions)?,
        None => {
            let pinion = if !stages.scenario.operation.keeps_speed() {
                ShaftPhase::from_speed_samples(pinion_speed_hz, sampling_rate_hz)?
            } else {
                let speed_hz = stages.scenario.operation.pinion_speed_hz;
                ShaftPhase::constant(speed_hz, sampling_rate_hz, signal.len())?
            };
            let shaft = pinion.of_mate(gears.pinion_teeth, gears.teeth(wheel))?;
            (resample_to(signal, sampling_rate_hz, rate_hz, Edge::Reflect)?, rates.phase(&shaft)?)
        }
    };
    process_channel(&signal, &phase, gears.teeth(wheel), &settings)
}

/// Does what [`wheel_record`] does of a wheel on a shaft of beams: the input turns as the motor does, and its phase gives those of the others.
///
/// # Arguments
/// * `stages`, `signal`, `rate_hz` - as of [`wheel_record`]
/// * `train`, `wheel` - the machine, and the number of its wheel
/// * `settings` - how the channel is processed
pub(crate) fn train_record(
    stages: &Stages,
    (train, wheel): (&GearTrain, usize),
    signal: &[f64],
    rate_hz: f64,
    settings: &TrainSettings,
) -> Result<Record, SignalError> {
    let rates = Rates { from_hz: stages.time.sampling_rate_hz, to_hz: rate_hz };
    let input = ShaftPhase::of_simulated_input(&stages.scenario, 0.0, signal.len())?;
    let turning = TrainTurning::Shaft {
        shaft: train.input(),
        phase: rates.phase(&input)?.with_zero(AngleZero::Simulated),
        stated: StatedTurning::Other,
    };
    let signal = resample_to(signal, rates.from_hz, rate_hz, Edge::Reflect)?;
    let recording = TrainRecording { signal: &signal, sampling_rate_hz: rate_hz, train, turning: &turning };
    // Without segments there is one record.
    Ok(recording.process_one(wheel, settings)?.records.swap_remove(0))
}

/// The whole number of a wheel's revolutions that the kept signal spans, where it does and is periodic.
fn whole_revolutions(stages: &Stages, wheel: WheelName) -> Option<usize> {
    let TimeGrid { samples_per_pinion_revolution, .. } = stages.time;
    let gears = &stages.layout.gears[0];
    let per_revolution =
        samples_per_pinion_revolution / gears.pinion_teeth as usize * gears.teeth(wheel) as usize;
    let kept = stages.time.kept_samples();
    let steady = stages.scenario.operation.keeps_speed();
    (steady && kept > 0 && kept.is_multiple_of(per_revolution)).then(|| kept / per_revolution)
}

/// A change of the sampling rate.
struct Rates {
    /// (S/s)
    from_hz: f64,
    /// (S/s)
    to_hz: f64,
}

impl Rates {
    /// The signal at its new rate, with a continuation at both ends, and its phase over the samples between.
    fn periodic(&self, signal: &[f64], revolutions: usize) -> Result<(Vec<f64>, ShaftPhase), SignalError> {
        let n = signal.len();
        let Some((up, down)) = whole_ratio(self.from_hz, self.to_hz)? else {
            let step = self.from_hz / self.to_hz;
            let samples = (n as f64 / step).ceil() as usize + 1;
            let places = -(CONTINUATION as isize)..(samples + CONTINUATION) as isize;
            let filter = AntiAliasing::new(self.from_hz, self.to_hz)?;
            let read = filter.read_double(signal, places.map(|m| m as f64 * step), Edge::Periodic);
            let angle = |i: usize| i as f64 * step * revolutions as f64 / n as f64;
            return Ok((read, ShaftPhase::new(CONTINUATION, (0..samples).map(angle).collect())?));
        };
        // Whole multiples of `down` samples become whole multiples of `up`.
        let blocks = CONTINUATION.div_ceil(up);
        let reach = (blocks * down) as isize;
        let continued: Vec<f64> =
            (-reach..n as isize + reach).map(|i| signal[i.rem_euclid(n as isize) as usize]).collect();
        let samples_per_revolution = n as f64 * up as f64 / (down as f64 * revolutions as f64);
        let samples = (n * up).div_ceil(down) + 1;
        let angles = (0..samples).map(|i| i as f64 / samples_per_revolution).collect();
        Ok((resample(&continued, up, down, Edge::Periodic)?, ShaftPhase::new(blocks * up, angles)?))
    }

    /// A phase at the samples of the new rate, by straight lines.
    fn phase(&self, phase: &ShaftPhase) -> Result<ShaftPhase, SignalError> {
        let angles = &phase.revolutions;
        let last = angles.len() - 1;
        let at = |(whole, part): (usize, f64)| {
            let from = angles[whole.min(last)];
            from + part * (angles[(whole + 1).min(last)] - from)
        };
        let angles = match whole_ratio(self.from_hz, self.to_hz)? {
            Some((up, down)) => (0..last * up / down + 1)
                .map(|i| at((i * down / up, (i * down % up) as f64 / up as f64)))
                .collect(),
            None => {
                let step = self.from_hz / self.to_hz;
                let places = (0..(last as f64 / step) as usize + 1).map(|i| i as f64 * step);
                places.map(|place| at((place as usize, place.fract()))).collect()
            }
        };
        ShaftPhase::new(0, angles)
    }
}
