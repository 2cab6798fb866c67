//! The path to a sensor, from recordings of the healthy machine.
//!
//! Pieces of the recordings are simulated at their speeds with many draws of the wheels. What the recordings show more than the
//! simulations at a frequency, in mesh harmonics, sidebands and remainder alike, is the path.

mod adapted;
mod cells;
mod drive;
mod error;
mod minimum_phase;
mod recording;
mod sidebands;
mod smoothing;

pub use drive::RecordedDrive;
pub use error::{PathError, RecordingProblem};
pub use recording::SensorRecording;
pub use sidebands::{RecordedSidebands, SidebandCause};

use std::ops::RangeInclusive;

use cells::{Cells, MeshOrders};
use minimum_phase::minimum_phase_deg;
use recording::{InputRecording, Piece, pieces};
use smoothing::{CellLevel, smooth};

use super::ExperimentControl;
use crate::batch::{Control, Keep, simulate_many};
use crate::error::{Error, ScenarioError};
use crate::random::{Draws, Purpose};
use crate::scenario::{Scenario, ScenarioWheel, Sensor};
use crate::sensor::{Channel, FrequencyResponse, ResponseInput};
use crate::signal::{
    AngularSettings, GearTrain, SignalError, angular_resample, lines_off_shafts, upper_median,
};
use crate::simulate::Stages;
use crate::solver::Output;

/// (s) What is simulated before a piece of a recording, for the vibration to settle.
const SETTLING_S: f64 = 0.3;
/// (-) Part of the sampling rates up to which the signals are right: of the recording behind its filter, of the simulation by its step.
const PASSED: [f64; 2] = [0.4, 0.25];
/// (-) Least power of a cell over that of noise, of many lines; and by how much that of one line must exceed it. One line of noise in 10⁵ is 12
/// times its mean, and the quietest windows are up to a third below the mean: 18 times, since a single cell draws a path towards it.
const ABOVE_NOISE: f64 = 6.0;
const ABOVE_NOISE_OF_ONE: f64 = 18.0;
/// Windows over whose quietest succession noise is averaged.
const QUIET_WINDOWS: usize = 4;
/// (-) Median over mean of the squared magnitude of normal noise.
const MEDIAN_OF_SQUARES: f64 = std::f64::consts::LN_2;
/// Revolutions of the slowest shaft below which noise is not told from what repeats.
const FEWEST_REVOLUTIONS: usize = 6;
/// Standard deviations on either side that hold 90 %.
const NINETY_PERCENT: f64 = 1.645;
/// (-) How far a recording may be from the simulations, over what draws of the wheels explain.
const MOST_MISFIT: f64 = 3.0;

/// Settings of [`estimate_path`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PathSettings {
    /// Draws of the wheels with which every piece of a recording is simulated; one of [`Self::DRAWS`].
    pub draws: usize,
    /// Seed of the draws.
    pub seed: u64,
}

impl PathSettings {
    /// The numbers of draws that are allowed: fewer have no scatter that is known, more tell nothing.
    pub const DRAWS: RangeInclusive<usize> = 8..=512;
}

impl Default for PathSettings {
    /// 24 draws.
    fn default() -> Self {
        Self { draws: 24, seed: 1 }
    }
}

/// The path from the simulated motion of a sensor's place to what the sensor shows.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PathEstimate {
    /// (Hz) Rising frequencies, from 0 to half the lowest sampling rate.
    pub frequency_hz: Vec<f64>,
    /// (dB) Magnitude.
    pub magnitude_db: Vec<f64>,
    /// (dB) The lower end of the interval that holds it with 90 %.
    pub low_db: Vec<f64>,
    /// (dB) The upper end.
    pub high_db: Vec<f64>,
    /// (°) Phase: the least that a system of this magnitude can have.
    pub phase_deg: Vec<f64>,
    /// (Hz) The lowest and the highest frequency at which recordings were above their noise, and compared with simulations.
    pub compared_hz: [f64; 2],
    /// (-) Distance of the recordings from the simulations, over what wheels explain: mean squares of the kinds of lines and of the cells.
    pub misfit: [f64; 2],
    /// What the recordings say of the drive, of what lies between their lines, and of sidebands.
    pub drive: RecordedDrive,
    /// Draws of the wheels that were left out, since a simulation with them failed.
    pub failed_draws: usize,
}

impl PathEstimate {
    /// The path for a sensor.
    pub fn frequency_response(&self) -> FrequencyResponse {
        FrequencyResponse {
            frequency_hz: self.frequency_hz.clone(),
            magnitude: self.magnitude_db.iter().map(|db| libm::pow(10.0, db / 20.0)).collect(),
            phase_deg: self.phase_deg.clone(),
        }
    }
}

/// Estimates the path to the first sensor of a scenario, of a pair or a gearbox, from recordings of the healthy machine.
///
/// Several speeds or a run-up say more than one speed: the same mesh harmonic is then seen at many frequencies, and what the
/// wheels make of it can be told from the path. The path is that from what the scenario's first sensor would show, its wall and mounted
/// resonance included, to the recordings; a measured frequency response, noise and range of the sensor are left out. Faults and
/// profiles of the scenario are left out as well: its load is that of the recordings.
///
/// # Arguments
/// * `scenario` - of the healthy machine
/// * `recordings` - one or more, of one sensor
/// * `settings` - how many draws
/// * `control` - progress over the simulations; cancellation
///
/// # Errors
/// A recording that is too short, or unlike this machine; recordings that no path explains; a scenario that cannot be simulated.
pub fn estimate_path(
    scenario: &Scenario,
    recordings: &[SensorRecording],
    settings: &PathSettings,
    control: &ExperimentControl,
) -> Result<PathEstimate, PathError> {
    let train = GearTrain::of_scenario(scenario)?;
    let meshes = MeshOrders::of(&train);
    if recordings.is_empty() {
        return Err(PathError::NoRecording);
    }
    if !PathSettings::DRAWS.contains(&settings.draws) {
        return Err(PathError::Draws { draws: settings.draws, allowed: PathSettings::DRAWS });
    }
    check_wheels(scenario)?;
    let refused = |index| move |problem| PathError::Recording { index, problem };
    let over_input = recordings.iter().enumerate();
    let over_input = over_input.map(|(index, of)| of.over_input(&train).map_err(refused(index)));
    let over_input = over_input.collect::<Result<Vec<_>, _>>()?;
    let (window_s, pieces) = pieces(&over_input, MeshOrders::slowest(&meshes))?;
    for (index, recording) in recordings.iter().enumerate() {
        recording.check(&train).map_err(refused(index))?;
    }
    let rate_hz = recordings.iter().map(|recording| recording.sampling_rate_hz).fold(f64::INFINITY, f64::min);
    let most_hz = (PASSED[0] * rate_hz).min(PASSED[1] * scenario.solver.sampling_rate_hz);
    let cells = Cells::new(&pieces, window_s, [most_hz, rate_hz / 2.0], &meshes);
    let measured = measured_powers(&over_input, &pieces, &cells, &train)?;
    if measured.iter().all(|power| *power <= 0.0) {
        return Err(too_short(&over_input, &train).unwrap_or(PathError::OnlyNoise));
    }
    let (simulated, failed_draws) = simulated(scenario, &pieces, &cells, settings, control)?;
    let levels = levels(&cells, &measured, &simulated);
    if levels.is_empty() {
        return Err(PathError::OnlyNoise);
    }
    let path = smooth(&cells.frequency_hz, &levels).ok_or(PathError::NotSolved)?;
    let misfit = [path.kind_misfit, path.cell_misfit];
    if misfit.into_iter().any(|misfit| misfit > MOST_MISFIT) {
        return Err(PathError::UnlikeSimulations { misfit: misfit[0].max(misfit[1]), most: MOST_MISFIT });
    }
    // Nothing passes outside a frequency response, so that this one begins at 0.
    let from_0 = |first: f64, values: &[f64]| [&[first], values].concat();
    let frequency_hz = from_0(0.0, &cells.frequency_hz);
    let magnitude_db = from_0(path.magnitude_db[0], &path.magnitude_db);
    let deviation_db = from_0(path.deviation_db[0], &path.deviation_db);
    let end_db = |sign: f64| {
        let ends = magnitude_db.iter().zip(&deviation_db);
        ends.map(|(db, deviation_db)| db + sign * NINETY_PERCENT * deviation_db).collect()
    };
    let compared = levels.iter().map(|level| cells.frequency_hz[level.cell.frequency]);
    let compared_hz = compared.fold([f64::INFINITY, 0.0], |[from, to], hz| [from.min(hz), to.max(hz)]);
    let mut estimate = PathEstimate {
        low_db: end_db(-1.0),
        high_db: end_db(1.0),
        phase_deg: minimum_phase_deg(&frequency_hz, &magnitude_db),
        compared_hz,
        frequency_hz,
        magnitude_db,
        misfit,
        drive: RecordedDrive::default(),
        failed_draws,
    };
    let response = estimate.frequency_response();
    estimate.drive = RecordedDrive::of(scenario, &train, &over_input, response, settings, control)?;
    Ok(estimate)
}

/// The longest steady recording, where all of them are too short for their noise to be known.
fn too_short(recordings: &[InputRecording], train: &GearTrain) -> Option<PathError> {
    let slowest = train.shafts.iter().map(|shaft| shaft.speed_ratio.value()).fold(f64::INFINITY, f64::min);
    // The first revolution may begin anywhere.
    let needed_rev = (FEWEST_REVOLUTIONS + 1) as f64 / slowest;
    let (index, longest) = recordings
        .iter()
        .enumerate()
        .max_by(|(_, a), (_, b)| a.input.span_rev().total_cmp(&b.input.span_rev()))?;
    let recording_s = longest.length_s();
    let needed_s = recording_s * needed_rev / longest.input.span_rev();
    let problem = RecordingProblem::TooShort { recording_s, needed_s };
    (recording_s < needed_s).then_some(PathError::Recording { index, problem })
}

/// Refuses wheels of which every draw is the same, and a sensor that shows forces.
fn check_wheels(scenario: &Scenario) -> Result<(), ScenarioError> {
    if scenario.sensors.first().is_some_and(|sensor| sensor.response_input == ResponseInput::Force) {
        let problem = "the path that is estimated is a ratio of accelerations";
        return Err(ScenarioError::new("sensor.response_input", "\"force\"", problem)
            .with_help("remove response_input")
            .in_entry("sensor", 0, scenario.sensors.len()));
    }
    let key = |wheel: usize, key: &str| scenario.key_of_quality(wheel, key);
    let help = |wheel: usize| {
        format!(
            "state the grade of the wheels with {} or {}",
            key(wheel, "din_grade"),
            key(wheel, "iso_class")
        )
    };
    if let Some(given) = scenario.wheels.iter().position(|wheel| wheel.profile_errors_mm.is_some()) {
        let problem = "the errors of the teeth are given, so that no draw of the wheels differs from another";
        let help = format!(
            "leave errors_file and profile errors out, and {}, by which the wheels are drawn",
            help(given)
        );
        return Err(ScenarioError::new(key(given, "profile_errors_mm"), "", problem).with_help(help));
    }
    let is_ideal = |wheel: &ScenarioWheel| wheel.din_grade == 0 && wheel.iso_class == 0;
    if let Some(ideal) = scenario.wheels.iter().position(is_ideal) {
        let problem = "ideal wheels have no sidebands, and no draw of them differs from another";
        return Err(ScenarioError::new(key(ideal, "din_grade"), 0, problem).with_help(help(ideal)));
    }
    Ok(())
}

/// (g²/Hz) Power of the recordings in each cell; 0 in a cell of hardly more than noise.
///
/// Noise is at most what is beside the orders of all shafts, and at most what there is in the quietest windows: the former says it
/// at one speed, the latter over a run-up. As the most that it may be it is not subtracted.
fn measured_powers(
    recordings: &[InputRecording],
    pieces: &[Piece],
    cells: &Cells,
    train: &GearTrain,
) -> Result<Vec<f64>, PathError> {
    // Of each cell its power, that of noise, and its lines.
    let mut powers = vec![[0.0; 3]; cells.cells.len()];
    for (number, recording) in recordings.iter().enumerate() {
        let mut noise = noise_density(recording, cells, train)
            .map_err(|error| PathError::Recording { index: number, problem: error.into() })?;
        let of_recording = || pieces.iter().enumerate().filter(|(_, piece)| piece.recording == number);
        let mut of_pieces = Vec::new();
        for (index, piece) in of_recording() {
            let spectra = cells.spectra(index, recording.values_of(piece), recording.sampling_rate_hz);
            for several in spectra.chunks_exact(QUIET_WINDOWS) {
                let around = cells.around_frequencies(several);
                noise.iter_mut().zip(around).for_each(|(least, power)| *least = least.min(power));
            }
            of_pieces.push((index, cells.powers(index, &spectra)));
        }
        for (index, of_piece) in of_pieces {
            let with_lines = of_piece.into_iter().zip(&cells.lines[index]).zip(&cells.cells);
            for ([power, of_noise, count], ((own, lines), cell)) in powers.iter_mut().zip(with_lines) {
                *power += own;
                *of_noise += lines * noise[cell.frequency];
                *count += lines;
            }
        }
    }
    let above = |[power, noise, lines]: [f64; 3]| {
        // Of few lines, noise alone may be many times its mean.
        let least = ABOVE_NOISE.max(1.0 + ABOVE_NOISE_OF_ONE / lines.sqrt());
        if power > least * noise { power } else { 0.0 }
    };
    Ok(powers.into_iter().map(above).collect())
}

/// (g²/Hz) Density of a recording's noise: the median of the lines beside the orders of all shafts; infinite of a recording too
/// short to tell, and of a run-up, over whose angle the noise of high frequencies is lost where the shaft turns slowly.
fn noise_density(
    recording: &InputRecording,
    cells: &Cells,
    train: &GearTrain,
) -> Result<Vec<f64>, SignalError> {
    let unknown = vec![f64::INFINITY; cells.frequency_hz.len()];
    if recording.input.is_run_up(recording.sampling_rate_hz) {
        return Ok(unknown);
    }
    let speed = |shaft: &usize| train.shafts[*shaft].speed_ratio.value();
    let slowest = (0..train.shafts.len()).min_by(|a, b| speed(a).total_cmp(&speed(b))).unwrap_or(0);
    let of_slowest = train.carried(&recording.input, train.input(), slowest)?;
    let angular = angular_resample(recording.values_g, &of_slowest, &AngularSettings::default())?;
    let revolutions = angular.revolutions();
    if revolutions < FEWEST_REVOLUTIONS {
        return Ok(unknown);
    }
    let shaft_hz = of_slowest.mean_speed_hz(recording.sampling_rate_hz);
    let lines = lines_off_shafts(&angular, train, slowest);
    let points = (revolutions * angular.points_per_revolution) as f64;
    // The mean square of Hann's window is 3/8.
    let scale = 1.0 / (0.375 * points * angular.points_per_revolution as f64 * shaft_hz);
    let line_at = |hz: f64| ((hz / shaft_hz * revolutions as f64) as usize).min(lines.spectrum.len());
    let density = |pair: &[f64]| {
        let (from, to) = (line_at(pair[0]), line_at(pair[1]));
        let off = (from..to).filter(|&line| lines.is_off[line]);
        let squares: Vec<f64> = off.map(|line| lines.spectrum[line].norm_sqr()).collect();
        scale * upper_median(&squares) / MEDIAN_OF_SQUARES
    };
    // Around each frequency as far as the next but one.
    let last = cells.frequency_hz.len() - 1;
    let [least_hz, most_hz] = cells.compared_hz;
    let edge = |at: usize| cells.frequency_hz[at.min(last)].clamp(least_hz, most_hz);
    Ok((0..=last).map(|at| density(&[edge(at.saturating_sub(2)), edge(at + 2)])).collect())
}

/// The seeds of the draws of the wheels.
fn seeds(settings: &PathSettings) -> Vec<u64> {
    let seed = |draw| Draws::new(settings.seed, Purpose::PathWheels, draw).bits() >> 1;
    (0..settings.draws as u64).map(seed).collect()
}

/// What a simulation shows of its piece: before it the speed comes to that with which the piece begins.
fn settled(shown: &[f64], rate_hz: f64) -> &[f64] {
    shown.get((SETTLING_S * rate_hz).round() as usize..).unwrap_or(&[])
}

/// A sensor that shows the motion of its place, through its wall and its mounted resonance alone.
fn without_path(sensor: Sensor) -> Sensor {
    Sensor {
        frequency_response: None,
        response_input: ResponseInput::default(),
        noise_density_g_per_rthz: 0.0,
        range_g: None,
        bits: None,
        ..sensor
    }
}

/// (g²/Hz) Power in each cell of simulations with each draw of the wheels, and how many draws are left out since a simulation failed.
fn simulated(
    scenario: &Scenario,
    pieces: &[Piece],
    cells: &Cells,
    settings: &PathSettings,
    control: &ExperimentControl,
) -> Result<(Vec<Vec<f64>>, usize), PathError> {
    let draws = settings.draws;
    let seeds = seeds(settings);
    let scenarios = pieces.iter().flat_map(|piece| {
        let of_piece = at_speed_of(scenario, piece);
        seeds.iter().map(move |&seed| of_piece.clone().with_seed(seed)).collect::<Vec<Scenario>>()
    });
    let mut powers = vec![vec![0.0; cells.cells.len()]; draws];
    let keep = KeepPowers { cells, draws };
    let all = pieces.len() * draws;
    let progress = |finished: usize| (control.progress)(finished, all);
    let control = Control { progress: &progress, cancelled: control.cancelled, ..Control::default() };
    let failed = simulate_all(scenarios.collect(), &keep, &control, |index, kept| {
        powers[index % draws].iter_mut().zip(kept).for_each(|(sum, power)| *sum += power);
    })?;
    let is_left = |draw: usize| failed.iter().all(|(index, _)| index % draws != draw);
    let left: Vec<Vec<f64>> =
        powers.into_iter().enumerate().filter(|(draw, _)| is_left(*draw)).map(|(_, powers)| powers).collect();
    let failed_draws = draws - left.len();
    match failed.into_iter().next() {
        Some((_, error)) if left.len() < *PathSettings::DRAWS.start() => Err(error.into()),
        _ => Ok((left, failed_draws)),
    }
}

/// Simulates some scenarios.
///
/// # Arguments
/// * `scenarios` - to be simulated
/// * `keep` - what is kept of each
/// * `control` - progress and cancellation
/// * `take` - takes what was kept, with the scenario's index
///
/// Returns those that failed.
///
/// # Errors
/// [`PathError::Cancelled`] where some were not begun.
fn simulate_all<K: Keep>(
    scenarios: Vec<Scenario>,
    keep: &K,
    control: &Control,
    mut take: impl FnMut(usize, K::Kept) + Send,
) -> Result<Vec<(usize, Error)>, PathError> {
    let all = scenarios.len();
    let mut failed = Vec::new();
    let taken = simulate_many(scenarios, keep, control, |index, kept| match kept {
        Ok(kept) => take(index, kept),
        Err(error) => failed.push((index, error)),
    });
    if taken < all { Err(PathError::Cancelled) } else { Ok(failed) }
}

/// The healthy machine at a constant speed, with other wheels than those of the scenario's own.
///
/// # Arguments
/// * `scenario` - of the machine
/// * `speed_hz` - (rev/s) of the motor
/// * `length_s` - (s) of the kept signal
fn at_steady_speed(scenario: &Scenario, speed_hz: f64, length_s: f64) -> Scenario {
    let mut healthy = scenario.clone().with_faults(Vec::new());
    let first = scenario.all_sensors().into_iter().next();
    healthy.sensors = vec![without_path(first.unwrap_or_default())];
    healthy.wheels_seed = None;
    healthy.operation.pinion_speed_hz = speed_hz;
    (healthy.operation.speed_profile_hz, healthy.operation.torque_profile_nm) = (None, None);
    healthy.operation.speed_wander_percent = 0.0;
    healthy.solver.pinion_revolutions = None;
    healthy.solver.duration_s = Some(length_s);
    healthy
}

/// The healthy machine at the speed of a piece of a recording, which has the recording's own wander.
fn at_speed_of(scenario: &Scenario, piece: &Piece) -> Scenario {
    let mut healthy = at_steady_speed(scenario, piece.mean_speed_hz(), piece.length_s);
    healthy.operation.speed_profile_hz = Some(piece.settled_speed_hz(SETTLING_S));
    healthy.operation.end_profiles_at(SETTLING_S + piece.length_s);
    healthy.solver.discard_and_keep(0.0, SETTLING_S + piece.length_s);
    healthy
}

/// (dB) Levels of the cells in which there is something to compare.
fn levels(cells: &Cells, measured: &[f64], simulated: &[Vec<f64>]) -> Vec<CellLevel> {
    let level = |(index, &cell)| {
        let of_draw = simulated.iter().map(|powers: &Vec<f64>| powers[index]);
        if measured[index] <= 0.0 || of_draw.clone().any(|power| power <= 0.0) {
            return None;
        }
        let db = |power: f64| 10.0 * libm::log10(power);
        let mean_db = of_draw.clone().map(db).sum::<f64>() / simulated.len() as f64;
        Some(CellLevel {
            cell,
            ratio_db: db(measured[index]) - mean_db,
            scatter_db: of_draw.map(|power| db(power) - mean_db).collect(),
        })
    };
    cells.cells.iter().enumerate().filter_map(level).collect()
}

/// Keeps the power in each cell of each of many simulations, whose numbers are those of pieces times draws.
struct KeepPowers<'a> {
    cells: &'a Cells,
    draws: usize,
}

impl Keep for KeepPowers<'_> {
    type Recorder = Vec<Vec<f64>>;
    type Kept = Vec<f64>;

    fn outputs(&self, scenario: &Scenario) -> Result<Vec<Output>, ScenarioError> {
        Ok(vec![Channel::leading(&scenario.sensors).output_of(scenario)?])
    }

    fn kept_bytes(&self, _: &Scenario) -> usize {
        self.cells.cells.len() * size_of::<f64>()
    }

    fn recorder(&self, _: &Stages) -> Self::Recorder {
        Self::Recorder::default()
    }

    fn keep(&self, index: usize, stages: Stages, recorded: Self::Recorder) -> Vec<f64> {
        let motion = recorded.into_iter().next().unwrap_or_default();
        let shown = stages.shown(&Channel::leading(&stages.sensors), motion);
        let piece = index / self.draws;
        let rate_hz = stages.time.sampling_rate_hz;
        self.cells.powers(piece, &self.cells.spectra(piece, settled(&shown, rate_hz), rate_hz))
    }
}
