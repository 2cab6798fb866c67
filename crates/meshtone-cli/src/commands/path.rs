//! `meshtone path`

use std::path::{self, PathBuf};
use std::sync::atomic::AtomicBool;

use clap::Args;
use meshtone::Error;
use meshtone::scenario::Scenario;
use meshtone::signal::{SignalWarning, StatedFacts, TrainBearing, TrainRecording};
use meshtone::tuning::{
    ExperimentControl, HealthyRecording, PathError, PathEstimate, PathSettings, RecordedDrive,
    RecordingProblem, SidebandCause, estimate_path,
};
use meshtone_diagnose::other_tone;
use meshtone_io::indicators::WarningEntry;
use meshtone_io::own_file::undisturbed;
use meshtone_io::path_csv::path_csv;
use meshtone_io::scenario_file::ScenarioFile;
use serde_json::{Value, json};

use crate::check::check;
use crate::diagnose::observe::to_g;
use crate::failure::Failure;
use crate::indicators::options::{PhaseOptions, ReadingOptions, ShaftOptions};
use crate::indicators::reading::Input;
use crate::indicators::refuse::{RefusedInput, refuse};
use crate::indicators::train::Turned;
use crate::progress::with_bar;
use crate::replacement::stage_text;
use crate::same_file::is_same_file;
use crate::shown::Shown;
use crate::warnings::{self, about};

/// Estimate the path to a sensor from recordings of the healthy machine
///
/// Simulates the machine at the recordings' speeds with many draws of its wheels: the path is the ratio of recordings to simulations at
/// each frequency that mesh harmonics, sidebands and the broad-band remainder have in common. Recordings at several speeds or of a
/// run-up are better than those of one speed. Writes frequency_hz, magnitude, phase_deg (of minimum phase), and in dB the magnitude and
/// its 90 % interval. The sensor of the scenario takes it by frequency_response = { file = "path.csv" }.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Path {
    /// Recordings by one sensor: any file of `meshtone indicators`, or directories that `meshtone simulate` wrote
    #[arg(value_name = "HEALTHY", required = true)]
    recordings: Vec<PathBuf>,
    /// The healthy machine, a pair or a gearbox, with the recordings' load; the sensor that recorded is the listed one of the channel, or the first one; its faults are left out
    #[arg(long, value_name = "SCENARIO.toml")]
    scenario: PathBuf,
    /// File to write; it is replaced if it exists
    #[arg(short, long, value_name = "FILE.csv")]
    output: PathBuf,
    /// Draws of the wheels
    #[arg(long, value_name = "N", default_value_t = 24, value_parser = clap::value_parser!(u64).range(*PathSettings::DRAWS.start() as u64..=*PathSettings::DRAWS.end() as u64))]
    draws: u64,
    /// Seed of the draws
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    shown: Shown,
    #[command(flatten)]
    reading: ReadingOptions,
    #[command(flatten)]
    phase: PhaseOptions,
    #[command(flatten)]
    shafts: ShaftOptions,
}

const EXAMPLES: &str = "\
Examples:
  meshtone path run_up.csv -c bearing --tach tacho --scenario rig.toml -o path.csv
  meshtone path slow.csv fast.csv -c bearing --tach tacho --scenario rig.toml -o path.csv
  meshtone path steady.wav --unit g --scenario rig.toml -o path.csv     the speed is the scenario's, made exact by the mesh tone";

impl Path {
    pub fn run(&self) -> Result<(), Failure> {
        let file = ScenarioFile::read(&self.scenario)?;
        let mut scenario = file.scenario.clone().with_faults(Vec::new());
        self.reading.lead_with_sensor(&mut scenario);
        let (doubts, _) = check(&scenario).map_err(|error| file.refuse(error))?;
        warnings::print(&file, &doubts);
        let recordings = self.recordings.iter().map(PathBuf::as_path);
        let mut read = file.sources().chain(recordings).chain(self.phase.files());
        if let Some(source) = read.find(|source| is_same_file(&self.output, source)) {
            let problem = format!("-o {}: is read, as {}", self.output.display(), source.display());
            return Failure::refuse(problem, "name another file with -o");
        }
        let mut healthy = Vec::with_capacity(self.recordings.len());
        for path in &self.recordings {
            let (recording, doubts) = self.recording(path, &scenario)?;
            doubts.iter().for_each(|entry| crate::terminal::warn(warnings::in_words(entry)));
            healthy.push(recording);
        }
        let settings = PathSettings { draws: self.draws as usize, seed: self.seed };
        let estimate = with_bar("simulations", !self.shown.quiet, |show| {
            let progress = |finished: usize, all: usize| show(finished as u64, all as u64);
            let cancelled = AtomicBool::new(false);
            estimate_path(
                &scenario,
                &healthy,
                &settings,
                &ExperimentControl { progress: &progress, cancelled: &cancelled },
            )
        });
        let estimate = estimate.map_err(|error| self.refuse(&file, error))?;
        let staged = stage_text(&self.output, &path_csv(&estimate))?;
        undisturbed(|| staged.commit())?;
        if estimate.failed_draws + estimate.drive.failed > 0 {
            crate::terminal::warn(format_args!(
                "simulations failed: {} of {} draws of the wheels are left out of the path, {} of those for the drive",
                estimate.failed_draws, self.draws, estimate.drive.failed
            ));
        }
        self.shown.print(&self.output.display(), || summary(&estimate, &self.output), || numbers(&estimate))
    }

    /// Reads a recording whole, with how its shafts turned, and what is doubtful about it.
    ///
    /// Where the mesh tone of a pair was followed, a doubtful phase may be that of another tone, which other tooth counts say.
    fn recording(
        &self,
        path: &path::Path,
        scenario: &Scenario,
    ) -> Result<(HealthyRecording, Vec<WarningEntry>), Failure> {
        let mut input = Input::read(path, &self.reading, self.phase.channel())?;
        to_g(&mut input.channel, path, self.reading.sensitivity_mv_per_unit.is_some())?;
        let Turned { train, turning, warnings, .. } =
            Turned::new(&input, &self.phase, &self.shafts, Some(scenario))?;
        let Input { source, channel, sampling_rate_hz, .. } = input;
        let what = format!("channel {}", channel.name);
        let refused = |error| refuse(&source, &what, RefusedInput::Phase, &error);
        let bearings: Vec<TrainBearing> = train.bearings.iter().map(|(_, bearing)| *bearing).collect();
        let heard =
            TrainRecording { signal: &channel.samples, sampling_rate_hz, train: &train, turning: &turning };
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
        let (shaft, phase, stated) = turning.known_phase(&train).map_err(refused)?;
        if train.meshes.len() == 1
            && let Some(stated) = StatedFacts::of_shaft(&train, shaft, stated)
            && let Some(mismatch) =
                other_tone(&channel.samples, sampling_rate_hz, &phase, &stated).map_err(refused)?
        {
            let problem = RecordingProblem::DoesNotFit(Box::new(SignalWarning::DoesNotFit(mismatch)));
            let problem = format!("{}: {problem}", path.display());
            return Failure::refuse(problem, "state the speed, or a tachometer with --tach");
        }
        let doubtful = phase.warnings.iter().map(|warning| about(&source, warning));
        let warnings = warnings.into_iter().chain(doubtful).chain(unsound).collect();
        Ok((HealthyRecording { values_g: channel.samples, sampling_rate_hz, shaft, phase, stated }, warnings))
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

/// The estimate, for programs.
fn numbers(estimate: &PathEstimate) -> Value {
    let drive = &estimate.drive;
    let sidebands = drive.sidebands.iter().map(|of| {
        let is_unexplained = of.is_unexplained();
        json!({ "shaft": of.shaft, "order": of.order, "level": of.level, "factor": of.factor, "is_unexplained": is_unexplained })
    });
    json!({
        "frequency_hz": estimate.frequency_hz,
        "magnitude_db": estimate.magnitude_db,
        "low_db": estimate.low_db,
        "high_db": estimate.high_db,
        "phase_deg": estimate.phase_deg,
        "compared_hz": estimate.compared_hz,
        "misfit": estimate.misfit,
        "failed_draws": estimate.failed_draws,
        "speed_wander_percent": drive.speed_wander_percent,
        "line_share": drive.line_share,
        "random_force_factor": drive.random_force_factor,
        "sidebands": sidebands.collect::<Vec<_>>(),
    })
}

/// The path at octaves.
fn summary(estimate: &PathEstimate, output: &path::Path) -> String {
    let [from_hz, to_hz] = estimate.compared_hz;
    let mut text = format!("  {:>10}  {:>8}  {:>18}\n", "Hz", "dB", "90 %");
    let octaves = std::iter::successors(Some(125.0), |hz| Some(2.0 * hz)).take_while(|hz| *hz <= to_hz);
    for hz in octaves.filter(|hz| *hz >= from_hz) {
        let at = estimate.frequency_hz.partition_point(|point| *point < hz);
        let [db, low, high] =
            [&estimate.magnitude_db, &estimate.low_db, &estimate.high_db].map(|values| values[at]);
        text += &format!("  {hz:>10.0}  {db:>8.1}  {:>18}\n", format!("{low:.1} to {high:.1}"));
    }
    format!(
        "{text}\n  compared from {from_hz:.0} to {to_hz:.0} Hz; the recordings differ {:.1} times as much from the simulations as draws of the \
         wheels do\n  take it by frequency_response = {{ file = \"{1}\" }}\n{2}\n{1}\n",
        estimate.misfit.into_iter().fold(0.0, f64::max).sqrt(),
        output.display(),
        drive(&estimate.drive)
    )
}

/// Says what the recordings tell of the drive, and which keys to write for it.
fn drive(found: &RecordedDrive) -> String {
    let mut text = String::new();
    if let Some([wander, low, high]) = found.speed_wander_percent {
        text += &format!(
            "  the speed wanders by {wander:.3} % (90 %: {low:.3} to {high:.3}): operation.speed_wander_percent = {wander:.3}\n"
        );
    }
    if let (Some([recorded, simulated]), Some([factor, low, high])) =
        (found.line_share, found.random_force_factor)
    {
        text += &format!(
            "  lines hold {:.0} % of the recorded power and {:.0} % of the simulated one: multiply random_force of every mesh by {factor:.2} (90 %: {low:.2} to \
             {high:.2})\n",
            100.0 * recorded,
            100.0 * simulated
        );
    }
    if found.needed_s > 0.0 {
        text += &format!(
            "  random_force and sidebands are compared from {:.1} s of one recording at this speed on\n",
            found.needed_s
        );
    }
    for of in &found.sidebands {
        let [recorded, simulated] = of.level;
        let [factor, low, high] = of.factor;
        let what = match of.cause {
            SidebandCause::Torque | SidebandCause::Wheels if low <= 1.0 && 1.0 <= high => "as simulated",
            SidebandCause::Torque => "multiply torque_ripple at this order by it",
            SidebandCause::Wheels => "multiply run_out_share and slope_wobble of the shaft's wheels by it",
            SidebandCause::Nothing if of.is_unexplained() => {
                "not explained: does the torque vary so, or is a wheel damaged?"
            }
            SidebandCause::Nothing => continue,
        };
        text += &format!(
            "  sidebands at order {} of {}: {recorded:.2} of their harmonic, simulated {simulated:.2}; factor {factor:.2} (90 %: {low:.2} to {high:.2}): {what}\n",
            of.order, of.shaft
        );
    }
    text
}
