//! What a recording of the healthy machine says beside the path: how its speed wanders, and how much of it no line has.

use super::recording::InputRecording;
use super::sidebands::{RecordedSidebands, RepeatedLines, compared};
use super::{NINETY_PERCENT, PASSED, PathError, PathSettings, at_steady_speed, seeds, simulate_all};
use crate::batch::{Control, KeepOf};
use crate::scenario::Scenario;
use crate::sensor::FrequencyResponse;
use crate::signal::{AngularSettings, GearTrain, ShaftPhase, SignalError, StraightLine, angular_resample};
use crate::simulate::Simulation;

/// (1/s) Mean speeds of which the wander is known: the process has nothing faster.
const SPEEDS_PER_S: f64 = 16.0;
/// Fewest of them that tell their standard deviation.
const FEWEST_SPEEDS: usize = 32;
/// (-) Correlation of two of them that follow each other: the corner of the wander is at 1 Hz.
const CORRELATION: f64 = 0.675;
/// (-) Standard deviation of the wander over that of its means over the time between two of them.
const OVER_MEANS: f64 = 1.032;
/// (-) Deviation of a speed that was stated to be constant, or to rise steadily.
const ROUNDING: f64 = 1e-7;
/// Cycles of the train that are compared, and the fewest of which what repeats is told from what does not.
const CYCLES: usize = 4;
const FEWEST_CYCLES: usize = 3;
/// (s) Longest simulation of so many cycles.
const LONGEST_S: f64 = 10.0;
/// Most draws of the wheels, and Student's quantile of 90 % for so many.
const MOST_DRAWS: usize = 6;
const OF_FEW_DRAWS: f64 = 2.015;

/// How the longest steady recording of a healthy machine is driven, and what it has between its lines; nothing of run-ups.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct RecordedDrive {
    /// (%) Standard deviation of the speed below 8 Hz, without a steady rise, and the interval that holds it with 90 %: the key
    /// `operation.speed_wander_percent`. None where the speed was stated, not measured.
    pub speed_wander_percent: Option<[f64; 3]>,
    /// (-) The part of the power that repeats itself after each cycle of the train, of the recording and of the mean simulation.
    pub line_share: Option<[f64; 2]>,
    /// (-) By what the key `random_force` of every mesh is to be multiplied for the recording's share, and its interval of 90 % over draws of the
    /// wheels. Noise of the sensor counts as such a force.
    pub random_force_factor: Option<[f64; 3]>,
    /// Sidebands of a gearbox at the first orders of each of its shafts; none of a pair.
    pub sidebands: Vec<RecordedSidebands>,
    /// (s) How long a recording at this speed must be for the last three; 0 where no gearbox is compared.
    pub needed_s: f64,
    /// Simulations that failed, of those that were compared for them.
    pub failed: usize,
}

impl RecordedDrive {
    /// The drive of the longest of some recordings that is steady.
    ///
    /// # Arguments
    /// * `scenario` - of the healthy machine
    /// * `train` - its tooth counts
    /// * `recordings` - by one sensor
    /// * `path` - to the sensor
    /// * `settings` - how many draws
    /// * `control` - cancellation
    pub(super) fn of(
        scenario: &Scenario,
        train: &GearTrain,
        recordings: &[InputRecording],
        path: FrequencyResponse,
        settings: &PathSettings,
        control: &super::ExperimentControl,
    ) -> Result<Self, PathError> {
        let steady = recordings
            .iter()
            .enumerate()
            .filter(|(_, recording)| !recording.input.is_run_up(recording.sampling_rate_hz));
        let Some((index, recording)) = steady.max_by(|(_, a), (_, b)| a.length_s().total_cmp(&b.length_s()))
        else {
            return Ok(Self::default());
        };
        let mut drive = Self { speed_wander_percent: wander_percent(recording), ..Self::default() };
        let cycle = train.revolutions_of_a_cycle(train.input());
        let speed_hz = recording.input.mean_speed_hz(recording.sampling_rate_hz);
        // Of slow trains as many cycles as are simulated in a moment.
        let in_longest = LONGEST_S * speed_hz / cycle as f64 - 0.1;
        let cycles = (recording.input.span_rev() / cycle as f64).min(in_longest).min(CYCLES as f64) as usize;
        let length_s = (cycles as f64 + 0.1) * cycle as f64 / speed_hz;
        let has_random_force = scenario.meshes.iter().any(|mesh| mesh.random_force > 0.0);
        if scenario.rig().is_some() && !has_random_force {
            return Ok(drive);
        }
        if cycles < FEWEST_CYCLES {
            let needed_s = (FEWEST_CYCLES as f64 + 0.1) * cycle as f64 / speed_hz;
            // Of slower trains too much would have to be simulated.
            drive.needed_s = if needed_s <= LONGEST_S { needed_s } else { 0.0 };
            return Ok(drive);
        }
        let mut simulated = at_steady_speed(scenario, speed_hz, length_s);
        simulated.sensors[0].frequency_response = Some(path);
        // Teeth that part and meet again do not repeat themselves exactly where the speed wanders.
        simulated.operation.speed_wander_percent =
            drive.speed_wander_percent.map_or(0.0, |[wander, ..]| wander);
        // Both are compared up to the same order.
        let most_hz =
            (PASSED[0] * recording.sampling_rate_hz).min(PASSED[1] * scenario.solver.sampling_rate_hz);
        let points = (2.0 * most_hz * cycle as f64 / speed_hz) as usize;
        let lines =
            |values: &[f64], input: &ShaftPhase| repeated_lines(values, input, train, [cycle, points]);
        let recorded = lines(recording.values_g, &recording.input)
            .map_err(|error| PathError::Recording { index, problem: error.into() })?;
        let draws =
            seeds(settings).into_iter().take(MOST_DRAWS).map(|seed| simulated.clone().with_seed(seed));
        let keep = KeepOf(|_: usize, simulation: Simulation| {
            let channels = &simulation.channels;
            let input = ShaftPhase::of_simulated_input(
                &simulation.stages.scenario,
                channels.start_s,
                channels.len(),
            )?;
            lines(&channels.signals[0].values, &input)
        });
        let mut of_draws: Vec<RepeatedLines> = Vec::new();
        let control = Control { cancelled: control.cancelled, ..Control::default() };
        let failed =
            simulate_all(draws.collect(), &keep, &control, |_, of| of_draws.extend(of.ok().flatten()))?;
        drive.failed = failed.len();
        let Some(recorded) = recorded else { return Ok(drive) };
        if scenario.rig().is_none() {
            drive.sidebands = compared(scenario, train, &recorded, &of_draws);
        }
        let shares: Vec<f64> = of_draws.iter().map(|of| of.share).collect();
        let recorded = recorded.share;
        if let Some(mean) = mean(&shares).filter(|_| has_random_force) {
            drive.line_share = Some([recorded, mean]);
            let between = |share: f64| (1.0 / share - 1.0).max(0.0);
            let factors: Vec<f64> = shares
                .iter()
                .map(|&share| (between(recorded) / between(share)).sqrt())
                .filter(|factor| factor.is_finite())
                .collect();
            drive.random_force_factor = factor_of(&factors);
        }
        Ok(drive)
    }
}

fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// The mean of a factor over draws, and what one draw more lies between with 90 %; none of fewer than two.
pub(super) fn factor_of(factors: &[f64]) -> Option<[f64; 3]> {
    let mean = mean(factors).filter(|_| factors.len() > 1)?;
    let count = factors.len() as f64;
    let variance = factors.iter().map(|factor| (factor - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let reach = OF_FEW_DRAWS * (variance * (1.0 + 1.0 / count)).sqrt();
    Some([mean, (mean - reach).max(0.0), mean + reach])
}

/// (%) Standard deviation of the speed, without its mean and a steady rise, with its interval; none of a speed that was stated or is too short.
fn wander_percent(recording: &InputRecording) -> Option<[f64; 3]> {
    let step = (recording.sampling_rate_hz / SPEEDS_PER_S) as usize;
    let count = recording.samples().checked_div(step)?.saturating_sub(1);
    if count < FEWEST_SPEEDS {
        return None;
    }
    let speeds: Vec<f64> = (0..count).map(|n| recording.speed_hz(n * step, (n + 1) * step)).collect();
    let StraightLine { mean: mean_hz, off, .. } = StraightLine::through(&speeds);
    // Speeds that follow each other are alike: a mean or a rise takes as much of their variance as of so many independent ones.
    let alike = (1.0 + CORRELATION) / (1.0 - CORRELATION);
    let variance = off / (count as f64 - 2.0 * alike);
    let deviation = OVER_MEANS * variance.sqrt() / mean_hz;
    let correlated = CORRELATION * CORRELATION;
    let independent = count as f64 * (1.0 - correlated) / (1.0 + correlated) - 2.0;
    let reach = NINETY_PERCENT / (2.0 * independent).sqrt();
    (deviation > ROUNDING).then(|| {
        [1.0, 1.0 / (1.0 + reach), 1.0 / (1.0 - reach).max(0.1)].map(|factor| 100.0 * deviation * factor)
    })
}

/// What repeats in a signal after each cycle of the train; none of too few cycles.
///
/// # Arguments
/// * `values` - the signal
/// * `input` - angle of the input
/// * `train` - its tooth counts
/// * `cycle` - revolutions of the input in a cycle, and how many points it is resampled to
fn repeated_lines(
    values: &[f64],
    input: &ShaftPhase,
    train: &GearTrain,
    [cycle, points]: [usize; 2],
) -> Result<Option<RepeatedLines>, SignalError> {
    let of_cycle = input.of_mate(1, u32::try_from(cycle).unwrap_or(u32::MAX))?;
    let settings = AngularSettings { points_per_revolution: Some(points), ..AngularSettings::default() };
    let angular = angular_resample(values, &of_cycle, &settings)?;
    if angular.revolutions() < FEWEST_CYCLES {
        return Ok(None);
    }
    RepeatedLines::of(&angular, train, cycle)
}
