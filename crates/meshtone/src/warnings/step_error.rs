//! The error of a steady vibration that the solver's step causes.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::ops::{Index, Range};

use crate::checks::varying;
use crate::error::Error;
use crate::machine::{Axis, PINION_SUPPORT};
use crate::operation::greatest_common_divisor;
use crate::sensor::{ChannelKind, NamedSignal, Sensor, SensorDirection, SignalSource};
use crate::simulate::{Simulation, Stages, stages_within};
use crate::solver::{Block, MeanMachine, MotionState, Output, Recorder};
use crate::wheel::Gears;
use meshtone_fourier::real_spectrum;

use super::observer::{Observer, TurnSum, WheelTurnSums};

/// (-) Part of a signal's power below which a line of its spectrum does not count.
const LEAST_PART: f64 = 1e-6;
/// (g, N) Rms below which a signal is rounding, as where equal wheels move in opposition.
const ROUNDING: f64 = 1e-9;

/// (-) From one frequency at which the machine's answer is computed to the next: lines have in common what lies near them.
const APART: f64 = 0.005;
/// How many such frequencies on either side of a line are looked at: a mode's may be so far from that of the mean mesh, whose stiffness
/// varies.
const NEAR: i64 = 2;

/// (-) Estimate above which a simulation is repeated.
const SUSPICIOUS: f64 = 0.02;
/// (-) Estimate that is reported without a repetition. Linear records of the healthy example's machine are estimated at 1.4 to 3.2 %, and
/// change by 0.1 to 0.4 %.
const CERTAIN: f64 = 0.1;

/// Estimate of the step's error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum StepError {
    /// (-) How far the rms may be wrong, where the simulation could not be repeated with a finer step.
    Suspected(f64),
    /// The simulation was repeated.
    Shown {
        /// (-) By how much the rms grew: of the vertical acceleration or of the mesh force, whichever changed more.
        gain: f64,
        /// (S/s) Actual sampling rate of the repetition.
        finer_rate_hz: f64,
    },
}

/// Method by which the step's error is judged where a resonance is suspected of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StepJudgement {
    /// By a second simulation, with half the step: it takes twice as long as the first.
    Repeated,
    /// By the estimate alone, where that is 10 % or more. It is a bound: errors of a few per cent are not reported.
    Estimated,
}

/// Estimate of the step's error where a resonance is suspected of it.
///
/// # Arguments
/// * `estimate` - (-) how far the step may falsify the rms, by the signals alone
/// * `judgement` - whether that is enough
/// * `coarse` - what the signals that are judged have of what changes with the step
/// * `repeated` - the rate of a simulation with half the step, and the same of its signals
fn judged(
    estimate: f64,
    judgement: StepJudgement,
    coarse: &[f64],
    repeated: impl FnOnce() -> Result<(f64, Vec<f64>), Error>,
) -> Option<StepError> {
    if judgement == StepJudgement::Estimated {
        return (estimate >= CERTAIN).then_some(StepError::Suspected(estimate));
    }
    if estimate <= SUSPICIOUS {
        return None;
    }
    let Ok((finer_rate_hz, finer)) = repeated() else {
        return Some(StepError::Suspected(estimate));
    };
    let gains = coarse.iter().zip(finer).map(|(&coarse, finer)| gain(coarse, finer));
    Some(StepError::Shown { gain: largest(gains), finer_rate_hz })
}

/// The error of a pair's step: by its vertical acceleration and its mesh force, whose sums over turns have the lines.
pub(super) fn step_error(
    stages: &Stages,
    observer: &Observer,
    judgement: StepJudgement,
) -> Option<StepError> {
    let [acceleration, force] = observer.turns.as_ref()?;
    let estimate = estimate(stages, [acceleration, force]);
    judged(estimate, judgement, &[acceleration.rms(), force.rms()], || {
        let outputs = [ChannelKind::Vertical, ChannelKind::MeshForce].map(ChannelKind::output);
        finer(stages, &outputs).map(|(rate_hz, squares)| (rate_hz, squares.rms()))
    })
}

/// The rate of a simulation with half the step, and the sums of outputs there.
fn finer(stages: &Stages, outputs: &[Output]) -> Result<(f64, SquareSums), Error> {
    let (mut scenario, rate_hz) = (stages.scenario.clone(), stages.time.sampling_rate_hz);
    if scenario.rig().is_none() {
        scenario.keep_highest_mode(rate_hz);
    }
    scenario.solver.sampling_rate_hz = 2.0 * rate_hz;
    let finer = stages_within(&scenario, stages.memory_limit)?;
    let mut squares = SquareSums::of(outputs.len());
    finer.integrate(outputs, finer.time.first_kept_sample, &mut squares)?;
    Ok((finer.time.sampling_rate_hz, squares))
}

/// Sums of the squares of outputs, whose samples are kept nowhere.
struct SquareSums {
    samples: usize,
    /// Of the values and of their squares.
    sums: Vec<[f64; 2]>,
}

impl SquareSums {
    fn of(outputs: usize) -> Self {
        Self { samples: 0, sums: vec![[0.0; 2]; outputs] }
    }

    /// Adds the next samples.
    ///
    /// # Arguments
    /// * `samples` - their number
    /// * `of` - the values of each output
    fn add<'a>(&mut self, samples: usize, of: impl Fn(usize) -> &'a [f64]) {
        self.samples += samples;
        for (index, sum) in self.sums.iter_mut().enumerate() {
            *sum =
                of(index).iter().fold(*sum, |[sum, squares], value| [sum + value, squares + value * value]);
        }
    }

    /// Of parts of signals.
    fn of_signals(signals: &[Cow<[f64]>], part: Range<usize>) -> Self {
        let mut this = Self::of(signals.len());
        this.add(part.len(), |index| &signals[index][part.clone()]);
        this
    }

    fn rms(&self) -> Vec<f64> {
        self.sums.iter().map(|[_, squares]| (squares / self.samples.max(1) as f64).sqrt()).collect()
    }

    /// What each output varies by.
    fn varying(&self) -> Vec<f64> {
        let count = self.samples.max(1) as f64;
        self.sums.iter().map(|[sum, squares]| varying(sum / count, squares / count)).collect()
    }
}

impl Recorder for SquareSums {
    fn record(&mut self, block: &Block) {
        self.add(block.len(), |index| block.output(index));
    }
}

/// (-) How far the step may falsify the rms, without a second simulation.
///
/// Every sine of the signal that repeats with a wheel's turn is as large as the machine's answer at the frequency that the step
/// makes of its own, [`MeanMachine::squared_growth`]; what does not repeat, as the ringing after a hit, only changes its pitch. Of teeth
/// that part it says nothing: their motion has no resonance that lasts.
fn estimate(stages: &Stages, signals: [&WheelTurnSums; 2]) -> f64 {
    let (Some((_, modal)), [mesh]) = (stages.machine(), &stages.meshes[..]) else { return 0.0 };
    let sensor = [(PINION_SUPPORT.into(), Axis::Y)];
    let machine = MeanMachine::new(modal, vec![mesh.law()], stages.time.step_s(), &sensor);
    growth(&machine, lines(stages, signals), &signals.map(|signal| signal.rms().powi(2)))
}

/// (-) How much the rms of one of some signals may have to grow to be the machine's own.
///
/// # Arguments
/// * `machine` - with the signals' sensors
/// * `lines` - the sines of all signals
/// * `powers` - mean square of each signal
fn growth<P: Index<usize, Output = f64>>(
    machine: &MeanMachine,
    lines: impl Iterator<Item = Line<P>>,
    powers: &[f64],
) -> f64 {
    let mut gained = vec![0.0; powers.len()];
    let mut known: BTreeMap<i64, Vec<f64>> = BTreeMap::new();
    // Of most lines the nearest place is that of the line before.
    let (mut nearest, mut most) = (None, vec![0.0_f64; powers.len()]);
    for line in lines {
        let counts =
            |n: &usize| powers[*n] > ROUNDING * ROUNDING && line.powers[*n] > LEAST_PART * powers[*n];
        if !(0..powers.len()).any(|n| counts(&n)) {
            continue;
        }
        let place = (line.frequency_hz.ln() / APART.ln_1p()).round() as i64;
        if nearest.replace(place) != Some(place) {
            most.fill(0.0);
            for near in place - NEAR..=place + NEAR {
                let frequency_hz = || (near as f64 * APART.ln_1p()).exp();
                let growths =
                    known.entry(near).or_insert_with(|| machine.squared_growth(TAU * frequency_hz()));
                most.iter_mut().zip(growths).for_each(|(most, of)| *most = most.max((*of - 1.0).abs()));
            }
        }
        for n in (0..powers.len()).filter(counts) {
            gained[n] += line.powers[n] / powers[n] * most[n];
        }
    }
    gained.into_iter().map(|gained| (1.0 + gained).sqrt() - 1.0).fold(0.0, f64::max)
}

/// A sine of some signals.
struct Line<P> {
    frequency_hz: f64,
    /// Its mean square in each.
    powers: P,
}

/// The error of the step by its signals themselves: by its plain sensors and the forces of its meshes, whose spectra have the lines.
pub(super) fn step_error_of_signals(simulation: &Simulation, judgement: StepJudgement) -> Option<StepError> {
    let Simulation { stages, channels, .. } = simulation;
    let (_, modal) = stages.machine().filter(|_| stages.is_steady())?;
    let (motions, outputs) = judged_signals(simulation);
    let coarse = SquareSums::of_signals(&motions, 0..channels.len()).varying();
    let powers: Vec<f64> = coarse.iter().map(|varying| varying * varying).collect();
    let spectra: Vec<Vec<f64>> = motions.iter().map(|motion| power_spectrum(motion)).collect();
    let resolution_hz = channels.sampling_rate_hz / channels.len() as f64;
    let line = |index: usize| Line {
        frequency_hz: index as f64 * resolution_hz,
        powers: spectra.iter().map(|spectrum| spectrum[index]).collect::<Vec<f64>>(),
    };
    let is_strong = |index: &usize| {
        spectra.iter().zip(&powers).any(|(spectrum, whole)| spectrum[*index] > STRONG_PART * whole)
    };
    let lines = (1..channels.len().div_ceil(2)).filter(is_strong).map(line);
    let plain = stages.sensors.iter().filter(|sensor| is_plain(sensor));
    let sensors: Vec<_> = plain.map(|sensor| (sensor.name().into(), sensor.direction.axis())).collect();
    let laws = stages.meshes.iter().map(|mesh| mesh.law()).collect();
    let machine = MeanMachine::new(modal, laws, stages.time.step_s(), &sensors);
    judged(growth(&machine, lines, &powers), judgement, &coarse, || {
        finer(stages, &outputs).map(|(rate_hz, squares)| (rate_hz, squares.varying()))
    })
}

/// The error of the step in the most violent of the tenths of the kept time: that is simulated again with half the step, from the motion with
/// which it began. It needs no motion that lasts.
///
/// Single hits come at another time at any other step, and the most violent tenth is less so there. Where it changes, the whole is therefore simulated
/// again, which takes twice as long as the first time, unless speed or load pass along a profile.
pub(super) fn step_error_of_part(simulation: &Simulation) -> Option<StepError> {
    let Simulation { stages, channels, states, .. } = simulation;
    let (signals, outputs) = judged_signals(simulation);
    let part = |state: &MotionState| {
        let from = state.sample - stages.time.first_kept_sample;
        from..(from + channels.len() / 10).min(channels.len())
    };
    let violence = |state: &MotionState| -> f64 {
        let relative = |signal: &Cow<[f64]>| {
            let whole = mean_square(signal);
            if whole < ROUNDING * ROUNDING { 0.0 } else { mean_square(&signal[part(state)]) / whole }
        };
        signals.iter().map(relative).sum()
    };
    let violent = states.iter().max_by(|a, b| violence(a).total_cmp(&violence(b)))?;
    let samples = part(violent);
    let mut squares = SquareSums::of(outputs.len());
    if stages.integrate_part_finer(violent, samples.len(), &outputs, &mut squares).is_err() {
        return Some(StepError::Suspected(1.0));
    }
    let coarse = SquareSums::of_signals(&signals, samples).varying();
    let finer_part = squares.varying();
    let changed = largest(coarse.iter().zip(&finer_part).map(|(&coarse, &finer)| gain(coarse, finer)));
    let operation = &stages.scenario.operation;
    if operation.speed_profile_hz.is_some() || operation.torque_profile_nm.is_some() {
        // What passes once, as a resonance of a run-up, would be diluted in the whole.
        let rate_hz = 2.0 * stages.time.sampling_rate_hz;
        return judged(changed.abs(), StepJudgement::Repeated, &coarse, || Ok((rate_hz, finer_part)));
    }
    let whole = SquareSums::of_signals(&signals, 0..channels.len()).varying();
    judged(changed.abs(), StepJudgement::Repeated, &whole, || {
        finer(stages, &outputs).map(|(rate_hz, squares)| (rate_hz, squares.varying()))
    })
}

/// The signals that are judged, as the solution alone makes them, and their outputs.
fn judged_signals(simulation: &Simulation) -> (Vec<Cow<'_, [f64]>>, Vec<Output>) {
    let Simulation { stages, channels, .. } = simulation;
    let signals = channels.signals.iter().zip(stages.scenario.outputs());
    let judged = signals.filter(|(of, _)| is_judged(of.source, stages));
    judged.map(|(of, output)| (motion(stages, of), output)).unzip()
}

/// What a signal is of the solution, which alone is simulated again: without what random forces add to a plain sensor's.
fn motion<'a>(stages: &Stages, signal: &'a NamedSignal) -> Cow<'a, [f64]> {
    let SignalSource::Sensor(number) = signal.source else { return Cow::Borrowed(&signal.values) };
    if stages.random_forces.is_none() {
        return Cow::Borrowed(&signal.values);
    }
    let mut random = vec![0.0; signal.values.len()];
    stages.add_random_part(number, &mut random);
    Cow::Owned(signal.values.iter().zip(random).map(|(value, random)| value - random).collect())
}

/// The number of some that is the farthest from 0.
fn largest(gains: impl Iterator<Item = f64>) -> f64 {
    gains.fold(0.0, |most: f64, gain| if gain.abs() > most.abs() { gain } else { most })
}

/// (-) Part of a gearbox's signal's power from which a line of its spectrum counts: there are many lines.
const STRONG_PART: f64 = 1e-4;

/// Whether a signal's power says something of the step: that of a plain sensor, and the force of a mesh.
fn is_judged(source: SignalSource, stages: &Stages) -> bool {
    match source {
        SignalSource::Sensor(number) => stages.sensors.get(number).is_some_and(is_plain),
        SignalSource::MeshForce(_) | SignalSource::Supports(SensorDirection::Vertical) => true,
        _ => false,
    }
}

/// Whether a sensor shows the motion of its place as it is: of such sensors alone the motion is known at both steps without keeping it.
fn is_plain(sensor: &Sensor) -> bool {
    sensor.is_linear() && !sensor.filters()
}

/// By what part the rms of a signal is larger at the finer step; 0 where the signal is rounding alone.
fn gain(coarse: f64, finer: f64) -> f64 {
    if coarse < ROUNDING { 0.0 } else { finer / coarse - 1.0 }
}

fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64
}

/// Mean square of each line of a signal's spectrum, from 0 on.
fn power_spectrum(values: &[f64]) -> Vec<f64> {
    let scale = 2.0 / (values.len() as f64).powi(2);
    real_spectrum(values).into_iter().map(|line| scale * line.norm_sqr()).collect()
}

/// The sines of acceleration and force that repeat with every turn of the gear, and those that do with the pinion's.
fn lines(stages: &Stages, signals: [&WheelTurnSums; 2]) -> impl Iterator<Item = Line<[f64; 2]>> {
    let Gears { pinion_teeth: pinion, gear_teeth: gear, .. } = stages.layout.gears[0];
    let speed_hz = stages.scenario.operation.pinion_speed_hz;
    // Orders of the pinion that are orders of the gear too.
    let shared = (pinion / greatest_common_divisor(pinion, gear)) as usize;
    let gear_speed_hz = speed_hz * f64::from(pinion) / f64::from(gear);
    let of_wheel = |turns: [&TurnSum; 2], shaft_hz: f64| {
        let [acceleration, force] = turns.map(orders);
        acceleration.zip(force).map(move |((order, acceleration), (_, force))| {
            (order, Line { frequency_hz: order as f64 * shaft_hz, powers: [acceleration, force] })
        })
    };
    let of_gear = of_wheel(signals.map(|signal| &signal.of_gear), gear_speed_hz);
    let of_pinion = of_wheel(signals.map(|signal| &signal.of_pinion), speed_hz);
    of_gear.chain(of_pinion.filter(move |(order, _)| order % shared != 0)).map(|(_, line)| line)
}

/// Mean squares of the sines that repeat with a shaft's turn, by their order from 1; none of a signal shorter than a turn.
fn orders(turns: &TurnSum) -> impl Iterator<Item = (usize, f64)> + use<> {
    let samples_per_turn = turns.sum.len();
    let spectrum = if turns.sum.is_empty() { Vec::new() } else { real_spectrum(&turns.sum) };
    let scale = 2.0 / ((turns.count * samples_per_turn).max(1) as f64).powi(2);
    let below_nyquist = samples_per_turn.div_ceil(2);
    spectrum
        .into_iter()
        .take(below_nyquist)
        .enumerate()
        .skip(1)
        .map(move |(order, line)| (order, scale * line.norm_sqr()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_varies_about_its_mean_and_counts_from_a_twentieth_of_it_on() {
        let cases = [[0.0, 4.0, 2.0], [10.0, 109.0, 3.0], [-100.0, 10_004.0, 5.0]];
        assert!(cases.iter().all(|[mean, square, varies]| (varying(*mean, *square) - varies).abs() < 1e-9));
    }

    /// Parseval: a signal that repeats with the turn has all its power in its orders.
    #[test]
    fn orders_hold_the_power_of_what_repeats() {
        let samples = 150;
        let turn = |n: usize| {
            (TAU * n as f64 / samples as f64).sin() * 3.0 + (TAU * 70.0 * n as f64 / samples as f64).cos()
        };
        let signal: Vec<f64> = (0..4 * samples).map(turn).collect();
        let mut turns = TurnSum::new(samples, signal.len());
        // In blocks of any length, with a part of a turn left over.
        signal.chunks(97).for_each(|block| turns.add(block));
        turns.add(&signal[..samples / 2]);
        let found: Vec<(usize, f64)> = orders(&turns).filter(|(_, power)| *power > 1e-12).collect();
        assert_eq!(found.iter().map(|(order, _)| *order).collect::<Vec<_>>(), [1, 70]);
        assert!((found[0].1 - 4.5).abs() < 1e-12 && (found[1].1 - 0.5).abs() < 1e-12, "{found:?}");
        assert_eq!(orders(&TurnSum::new(700, signal.len())).count(), 0);
    }
}
