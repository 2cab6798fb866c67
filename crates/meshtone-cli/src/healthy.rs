//! Recordings of the healthy machine, and the path to their sensor that they tell.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use clap::Args;
use meshtone::Error;
use meshtone::scenario::Scenario;
use meshtone::signal::{SignalWarning, StatedFacts, TrainBearing, TrainRecording};
use meshtone::tuning::{
    ExperimentControl, PathError, PathEstimate, PathSettings, RecordingProblem, SensorRecording,
    estimate_path,
};
use meshtone_diagnose::other_tone;
use meshtone_io::indicators::WarningEntry;
use meshtone_io::scenario_file::ScenarioFile;

use crate::check::check;
use crate::diagnose::observe::to_g;
use crate::failure::Failure;
use crate::indicators::options::{PhaseOptions, ReadingOptions, ShaftOptions};
use crate::indicators::reading::Input;
use crate::indicators::refuse::{RefusedInput, refuse};
use crate::indicators::train::Turned;
use crate::progress::with_bar;
use crate::same_file::is_same_file;
use crate::warnings::{self, about};

/// Recordings of a healthy machine, and what is known of it.
#[derive(Debug, Args)]
pub struct HealthyRecordings {
    /// Recordings by one sensor: any file of `meshtone indicators`, or directories that `meshtone simulate` wrote
    #[arg(value_name = "HEALTHY", required = true)]
    pub recordings: Vec<PathBuf>,
    /// The healthy machine, a pair or a gearbox, with the recordings' load; the sensor that recorded is the listed one of the channel, or the first one; its faults are left out
    #[arg(long, value_name = "SCENARIO.toml")]
    pub scenario: PathBuf,
    /// Draws of the wheels from which the path is estimated
    #[arg(long, value_name = "N", default_value_t = 24, value_parser = clap::value_parser!(u64).range(*PathSettings::DRAWS.start() as u64..=*PathSettings::DRAWS.end() as u64))]
    pub draws: u64,
    /// Seed of the draws
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    #[command(flatten)]
    reading: ReadingOptions,
    #[command(flatten)]
    phase: PhaseOptions,
    #[command(flatten)]
    shafts: ShaftOptions,
}

/// Estimates the path to the sensor, with a progress bar.
///
/// # Arguments
/// * `scenario` - the healthy machine
/// * `recordings` - of it
/// * `draws`, `seed` - of the wheels
/// * `is_quiet` - whether no progress is shown
pub fn estimated(
    scenario: &Scenario,
    recordings: &[SensorRecording],
    draws: u64,
    seed: u64,
    is_quiet: bool,
) -> Result<PathEstimate, PathError> {
    let settings = PathSettings { draws: draws as usize, seed };
    with_bar("simulations", !is_quiet, |show| {
        let progress = |finished: usize, all: usize| show(finished as u64, all as u64);
        let cancelled = AtomicBool::new(false);
        let control = ExperimentControl { progress: &progress, cancelled: &cancelled };
        estimate_path(scenario, recordings, &settings, &control)
    })
}

/// A recording over the angle of the shaft that is known to turn.
///
/// # Arguments
/// * `input` - the recording, in g
/// * `turned` - how its shafts turned
pub fn over_shaft(input: Input, turned: &Turned) -> Result<SensorRecording, Failure> {
    let Input { source, channel, sampling_rate_hz, .. } = input;
    let what = format!("channel {}", channel.name);
    let phase = turned.turning.known_phase(&turned.train);
    let (shaft, phase, stated) =
        phase.map_err(|error| refuse(&source, &what, RefusedInput::Phase, &error))?;
    Ok(SensorRecording { values_g: channel.samples, sampling_rate_hz, shaft, phase, stated })
}

/// A healthy machine and its recordings.
pub struct HealthyMachine {
    file: ScenarioFile,
    /// The scenario without faults, the sensor that recorded first.
    pub scenario: Scenario,
    /// The recordings, in g.
    pub recordings: Vec<SensorRecording>,
}

impl HealthyRecordings {
    /// Reads the scenario and the recordings.
    ///
    /// # Arguments
    /// * `output` - the path that the caller will write to, which must be none of those that are read
    pub fn read(&self, output: &Path) -> Result<HealthyMachine, Failure> {
        let file = ScenarioFile::read(&self.scenario)?;
        let mut scenario = file.scenario.clone().with_faults(Vec::new());
        self.reading.lead_with_sensor(&mut scenario);
        let (doubts, _) = check(&scenario).map_err(|error| file.refuse(error))?;
        warnings::print(&file, &doubts);
        let recordings = self.recordings.iter().map(PathBuf::as_path);
        let same = file.sources().chain(recordings).chain(self.phase.files());
        if let Some(source) = { same }.find(|source| is_same_file(output, source)) {
            let problem = format!("-o {}: is read, as {}", output.display(), source.display());
            return Failure::refuse(problem, "name another file with -o");
        }
        let mut healthy = Vec::with_capacity(self.recordings.len());
        for path in &self.recordings {
            let (recording, doubts) = self.recording(path, &scenario)?;
            doubts.iter().for_each(|entry| crate::terminal::warn(warnings::in_words(entry)));
            healthy.push(recording);
        }
        Ok(HealthyMachine { file, scenario, recordings: healthy })
    }

    /// Estimates the path to the sensor.
    ///
    /// # Arguments
    /// * `machine` - what was read
    /// * `is_quiet` - whether no progress is shown
    pub fn estimate(&self, machine: &HealthyMachine, is_quiet: bool) -> Result<PathEstimate, Failure> {
        let estimate = estimated(&machine.scenario, &machine.recordings, self.draws, self.seed, is_quiet);
        let estimate = estimate.map_err(|error| self.refuse(&machine.file, error))?;
        if estimate.failed_draws + estimate.drive.failed > 0 {
            crate::terminal::warn(format_args!(
                "simulations failed: {} of {} draws of the wheels are left out of the path, {} of those for the drive",
                estimate.failed_draws, self.draws, estimate.drive.failed
            ));
        }
        Ok(estimate)
    }

    /// Reads a recording whole, with how its shafts turned, and what is doubtful about it.
    ///
    /// Where the mesh tone of a pair was followed, a doubtful phase may be that of another tone, which other tooth counts say.
    fn recording(
        &self,
        path: &Path,
        scenario: &Scenario,
    ) -> Result<(SensorRecording, Vec<WarningEntry>), Failure> {
        let mut input = Input::read(path, &self.reading, self.phase.channel())?;
        to_g(&mut input.channel, path, self.reading.sensitivity_mv_per_unit.is_some())?;
        let source = input.source.clone();
        let what = format!("channel {}", input.channel.name);
        let turned = Turned::new(&input, &self.phase, &self.shafts, Some(scenario))?;
        let recording = over_shaft(input, &turned)?;
        let Turned { train, turning, warnings, .. } = turned;
        let refused = |error| refuse(&source, &what, RefusedInput::Phase, &error);
        let bearings: Vec<TrainBearing> = train.bearings.iter().map(|(_, bearing)| *bearing).collect();
        let SensorRecording { values_g: signal, sampling_rate_hz, shaft, phase, stated } = &recording;
        let sampling_rate_hz = *sampling_rate_hz;
        let heard = TrainRecording { signal, sampling_rate_hz, train: &train, turning: &turning };
        let heard = heard.bearing_defects(&bearings).map_err(refused)?;
        // The path of a damaged machine would take its bursts for the path's.
        let unsound = heard.races.iter().filter(|race| race.is_detected()).map(|race| {
            let (part, seats, seen) =
                (race.race.name(), &train.bearings[race.bearings[0]].0, race.in_words());
            about(
                &source,
                format_args!(
                    "the machine should be healthy, but the {part} of bearing {seats} has a defect: {seen}"
                ),
            )
        });
        let unsound: Vec<WarningEntry> = unsound.collect();
        if train.meshes.len() == 1
            && let Some(stated) = StatedFacts::of_shaft(&train, *shaft, *stated)
            && let Some(mismatch) = other_tone(signal, sampling_rate_hz, phase, &stated).map_err(refused)?
        {
            let problem = RecordingProblem::DoesNotFit(Box::new(SignalWarning::DoesNotFit(mismatch)));
            let problem = format!("{}: {problem}", path.display());
            return Failure::refuse(problem, "state the speed, or a tachometer with --tach");
        }
        let doubtful = phase.warnings.iter().map(|warning| about(&source, warning));
        let warnings = warnings.into_iter().chain(doubtful).chain(unsound).collect();
        Ok((recording, warnings))
    }

    /// Names the file that an error is about.
    fn refuse(&self, file: &ScenarioFile, error: PathError) -> Failure {
        match error {
            PathError::Simulation(Error::Scenario(error)) => file.refuse(error).into(),
            PathError::Recording { index, problem } => {
                let path = &self.recordings[index];
                let failure = Failure::bad_input(format!("{}: {problem}", path.display()));
                match problem {
                    RecordingProblem::Signal(error) => {
                        refuse(path, "the signal", RefusedInput::Phase, &error)
                    }
                    RecordingProblem::DoesNotFit(_) => failure
                        .with_help("check --shaft, --mesh, --pulses-per-rev, the speed and the scenario"),
                    _ => failure,
                }
            }
            error => Failure::bad_input(error.to_string()),
        }
    }
}
