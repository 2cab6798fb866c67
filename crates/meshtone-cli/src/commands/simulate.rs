//! `meshtone simulate`

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;
use meshtone::scenario::{Model, Quality, Scenario, ScenarioError, ScenarioFiles, ScenarioWarning};
use meshtone::{Simulation, StageTime, Stages, StepJudgement, Trace};
use meshtone_io::atomic_file::check_target;
use meshtone_io::experiment::{Tuned, read_tuned};
use meshtone_io::run_identity::RunIdentity;
use meshtone_io::scenario_file::{FileKind, FilesBeside, ScenarioFile};
use meshtone_io::signals::{SignalFormat, SignalTable};
use meshtone_io::summary::Summary;
use meshtone_plot::{Figure, PlotError, panel};
use serde_json::json;

use crate::check::check;
use crate::choice::{Choice, one_of};
use crate::failure::Failure;
use crate::output_directory::{OutputDirectory, named_after};
use crate::progress::with_spinner;
use crate::results::{self, RESULTS, Results};
use crate::same_file::is_same_file;
use crate::shown::Shown;
use crate::table::table;
use crate::terminal::warn;
use crate::warnings;

/// Simulate scenarios: signals, summary and results panel
///
/// Writes signals.parquet (or .csv, .mat, .npz, .wav), summary.json, panel.svg and panel.png. Files of an earlier run are replaced;
/// every file is written completely or not at all. Nothing is simulated or written unless all scenarios are valid.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Simulate {
    /// Scenario files
    #[arg(value_name = "SCENARIO.toml", required = true)]
    scenarios: Vec<PathBuf>,
    /// Directory to write to; for several scenarios, to DIR/<file name without .toml> each.
    /// [default: <file name without .toml>_results in the current directory]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Model of the mesh, instead of the scenario's own
    #[arg(long, value_parser = one_of(&MODELS))]
    model: Option<Model>,
    /// Profile errors, as `meshtone wheels` writes them, instead of the scenario's section [quality]; the name is relative to the
    /// current directory
    #[arg(long, value_name = "WHEELS.npz")]
    errors_file: Option<PathBuf>,
    /// Result of `meshtone tune`: its numbers of the scenario are put into every scenario that has them
    #[arg(long, value_name = "tuned.toml")]
    tuned: Option<PathBuf>,
    /// Write every stage's output too (one scenario only)
    #[arg(long, value_name = "FILE.npz")]
    trace: Option<PathBuf>,
    /// Formats of the signals, a file each; several are separated by commas. Only Parquet contains the scenario, which `meshtone panel` and
    /// other commands take from it
    #[arg(long, value_name = "FORMAT", value_delimiter = ',', default_value = "parquet", value_parser = one_of(&FORMATS))]
    format: Vec<SignalFormat>,
    #[command(flatten)]
    shown: Shown,
    /// Do not draw the results panel
    #[arg(long)]
    no_panel: bool,
}

const EXAMPLES: &str = "\
Examples:
  meshtone simulate broken.toml                         into ./broken_results
  meshtone simulate broken.toml -o out --trace all.npz  with every stage's output
  meshtone simulate broken.toml --format mat            signals for MATLAB
  meshtone simulate healthy.toml broken.toml -o out     into out/healthy and out/broken
  meshtone simulate pit.toml chip.toml --errors-file wheels.npz -o out   both on the same wheels";

const FORMATS: [Choice<SignalFormat>; 5] = [
    (
        SignalFormat::Parquet.name(),
        "Apache Parquet, with the scenario and the unit of each signal",
        SignalFormat::Parquet,
    ),
    (SignalFormat::Csv.name(), "Text: a line of names, a line for each sample", SignalFormat::Csv),
    (
        SignalFormat::Mat.name(),
        "MATLAB, version 5, which SciPy reads too: a column vector for each signal",
        SignalFormat::Mat,
    ),
    (SignalFormat::Npz.name(), "NumPy: an array for each signal", SignalFormat::Npz),
    (
        SignalFormat::Wav.name(),
        "Floating point of 32 bits between -1 and 1; the comment in the file states the full scale of each channel",
        SignalFormat::Wav,
    ),
];

const TRACE_HELP: &str = "name another file with --trace, in a directory that exists";

const MODELS: [Choice<Model>; 3] = [
    (
        "contact",
        "Teeth that touch and separate, flexible shafts, and supports that carry the sensors",
        Model::Contact,
    ),
    ("linear", "A linear mesh that is always closed", Model::Linear),
    ("published", "The published code with its known errors", Model::Published),
];

/// A scenario that can be simulated, and where its results go.
struct Run {
    file: ScenarioFile,
    /// The file's scenario with what the command line changes.
    scenario: Scenario,
    warnings: Vec<ScenarioWarning>,
    /// Computed while the scenario was checked; kept where it is the only one, as several would fill the memory.
    stages: Option<Stages>,
    directory: PathBuf,
}

impl Run {
    /// The directory of its results, and the files that were read for it.
    fn files(&self) -> (&Path, Vec<&Path>) {
        (&self.directory, self.file.sources().collect())
    }
}

impl Simulate {
    pub fn run(&self) -> Result<(), Failure> {
        if self.trace.is_some() && self.scenarios.len() > 1 {
            let given = self.scenarios.len();
            let problem = format!("--trace: {given} scenarios are given; must be one");
            let help = "a trace is one file; run `meshtone simulate` once for each trace";
            return Failure::refuse(problem, help);
        }
        let directories = self.directories()?;
        let errors = self.errors_file.as_deref().map(read_errors).transpose()?;
        let tuned = self.tuned.as_deref().map(read_tuned).transpose();
        let tuned = tuned.map_err(|error| Failure::of_file(FileKind::Tuned, error))?;
        let runs = self.scenarios.iter().zip(directories);
        let runs =
            runs.map(|(path, directory)| self.prepare(path, directory, errors.as_ref(), tuned.as_ref()));
        let runs = runs.collect::<Result<Vec<_>, _>>()?;
        let read = runs.iter().flat_map(|run| run.files().1);
        let named = self.errors_file.as_deref().into_iter().chain(self.tuned.as_deref());
        let read: Vec<&Path> = read.chain(named).collect();
        let directories = runs.iter().map(|run| OutputDirectory::prepare(run.files().0, &read));
        let directories = directories.collect::<Result<Vec<_>, _>>()?;
        if let Some(trace) = &self.trace {
            check_trace(trace, runs[0].files().0, &read)?;
        }
        for (number, (run, directory)) in runs.into_iter().zip(directories).enumerate() {
            self.simulate(run, &directory, number)?;
        }
        Ok(())
    }

    /// The directory of each scenario's results.
    fn directories(&self) -> Result<Vec<PathBuf>, Failure> {
        let mut directories = Vec::with_capacity(self.scenarios.len());
        for path in &self.scenarios {
            let Some(stem) = path.file_stem() else {
                return Err(Failure::bad_input(format!("{} is no scenario file", path.display())));
            };
            let directory = match &self.output {
                None => named_after(path, "results"),
                Some(output) if self.scenarios.len() == 1 => output.clone(),
                Some(output) => output.join(stem),
            };
            if let Some(other) = directories.iter().position(|other| *other == directory) {
                let problem = format!(
                    "{} and {} would both write to {}",
                    self.scenarios[other].display(),
                    path.display(),
                    directory.display()
                );
                let help = "rename one of the files, or run them one after the other with different -o";
                return Failure::refuse(problem, help);
            }
            directories.push(directory);
        }
        Ok(directories)
    }

    fn prepare(
        &self,
        path: &Path,
        directory: PathBuf,
        errors: Option<&Quality>,
        tuned: Option<&Tuned>,
    ) -> Result<Run, Failure> {
        let file = ScenarioFile::read(path)?;
        if file.scenario.rig().is_none() {
            self.refuse_options_of_pair(path)?;
        }
        let scenario = self.changed(path, file.scenario.clone(), errors, tuned)?;
        let (warnings, stages) = check(&scenario).map_err(|error| self.refuse(&file, error))?;
        let stages = (self.scenarios.len() == 1).then_some(stages);
        Ok(Run { file, scenario, warnings, stages, directory })
    }

    /// A scenario with what the command line changes.
    fn changed(
        &self,
        path: &Path,
        mut scenario: Scenario,
        errors: Option<&Quality>,
        tuned: Option<&Tuned>,
    ) -> Result<Scenario, Failure> {
        if let (Some(tuned), Some(tuned_path)) = (tuned, &self.tuned) {
            if let Some(warning) = tuned.warning_for(&scenario) {
                warn(format_args!("{}: {warning}", tuned_path.display()));
            }
            scenario = tuned.apply(&scenario).map_err(|error| {
                let (tuned, path) = (tuned_path.display(), path.display());
                Failure::bad_input(format!("--tuned {tuned}: {error} ({path})"))
            })?;
        }
        if let Some(model) = self.model {
            scenario.model = model;
        }
        if let Some(errors) = errors {
            scenario.set_quality(errors.clone());
        }
        Ok(scenario)
    }

    /// A gearbox knows one model and no files of a pair.
    fn refuse_options_of_pair(&self, path: &Path) -> Result<(), Failure> {
        let of_pair = [
            ("--model", self.model.is_some_and(|model| model != Model::Contact)),
            ("--errors-file", self.errors_file.is_some()),
        ];
        let Some((option, _)) = of_pair.iter().find(|(_, given)| *given) else { return Ok(()) };
        let problem =
            format!("{option}: {} is of a gearbox, and this is known of one pair only", path.display());
        Failure::refuse(problem, format!("leave {option} out, or simulate a scenario of one pair"))
    }

    /// Writes all files of a run.
    fn write(
        &self,
        directory: &OutputDirectory,
        signals: SignalTable,
        summary: &Summary,
        trace: Option<&Trace>,
        draw: impl FnOnce() -> Result<Figure, PlotError> + Send,
    ) -> Result<(), Failure> {
        let trace = trace.zip(self.trace.as_deref());
        let results = Results { run: summary.run, signals, summary: json!(summary), trace };
        results::write(&directory.path, &results, &self.format, (!self.no_panel).then_some(draw))
    }

    /// Simulates, with something that moves on the terminal meanwhile, and prints warnings and the main numbers.
    fn report(
        &self,
        file: &ScenarioFile,
        directory: &OutputDirectory,
        number: usize,
        simulate: impl FnOnce() -> Result<Reported, Failure>,
    ) -> Result<(), Failure> {
        let from = file.path.display();
        let message = format!("{from} ({} of {})", number + 1, self.scenarios.len());
        let (summary, by_signals, written) = with_spinner(message, !self.shown.quiet, simulate)?;
        warnings::print(file, &by_signals);
        written?;
        let to = directory.path.display();
        self.shown.print(&to, || format!("{from} -> {to}\n{}\n", table(&summary)), || json!(summary))
    }

    /// An error about a scenario, or about the errors file that the command line put in its place.
    fn refuse(&self, file: &ScenarioFile, error: ScenarioError) -> Failure {
        match (&self.errors_file, error.key.strip_prefix("quality.")) {
            (Some(errors_file), Some(entry)) => {
                let (errors_file, scenario) = (errors_file.display(), file.path.display());
                let problem = error.problem;
                let message = format!("--errors-file {errors_file}: {entry}: {problem} ({scenario})");
                Failure { help: error.help, ..Failure::bad_input(message) }
            }
            _ => file.refuse(error).into(),
        }
    }

    fn simulate(&self, run: Run, directory: &OutputDirectory, number: usize) -> Result<(), Failure> {
        warnings::print(&run.file, &run.warnings);
        self.report(&run.file, directory, number, || {
            let (simulation, trace) = simulate(&run.scenario, run.stages, self.trace.is_some())
                .map_err(|error| not_simulated(&run.file, error))?;
            let by_signals = simulation.warnings_of_signals(StepJudgement::Repeated);
            let identity = RunIdentity::of(&run.scenario);
            let summary = Summary::new(&simulation, identity, &[&run.warnings[..], &by_signals].concat());
            let signals = SignalTable::of_scenario(&run.scenario, &simulation.channels);
            let draw = || panel::draw(&simulation);
            let written = self.write(directory, signals, &summary, trace.as_ref(), draw);
            Ok((summary, by_signals, written))
        })
    }
}

/// The main numbers of a run, what its signals show to be doubtful, and whether its files could be written.
type Reported = (Summary, Vec<ScenarioWarning>, Result<(), Failure>);

/// Refuses a trace that cannot be written, or would replace a result or a file that is read.
///
/// # Arguments
/// * `trace` - its file
/// * `directory` - of the results, which exists
/// * `read` - files that are read
fn check_trace(trace: &Path, directory: &Path, read: &[&Path]) -> Result<(), Failure> {
    let refuse = |problem: &str| {
        let problem = format!("--trace {}: {problem}; must be a file of its own", trace.display());
        Failure::refuse(problem, TRACE_HELP)
    };
    if RESULTS.iter().any(|name| is_same_file(trace, &directory.join(name))) {
        return refuse("is where the run writes another of its results");
    }
    if read.iter().any(|file| is_same_file(trace, file)) {
        return refuse("is a file that the run reads");
    }
    check_target(trace).map_err(|error| {
        let message = format!("--trace {}: cannot be written: {}", trace.display(), error.source);
        Failure::of_writing(error.source.kind(), message).with_help(TRACE_HELP)
    })
}

/// Wheels with the deviations of a file.
fn read_errors(path: &Path) -> Result<Quality, Failure> {
    if !path.try_exists().unwrap_or(true) {
        let problem = format!("--errors-file: there is no file {}", path.display());
        return Failure::refuse(problem, "check the name; it is relative to the current directory");
    }
    let (files, name) = (FilesBeside::new(""), path.to_string_lossy());
    let errors = files.profile_errors(&name);
    let wheels = errors.and_then(|errors| Ok(Quality::of_wheels(errors, files.wheel_deviations(&name)?)));
    wheels.map_err(|problem| {
        Failure::bad_input(format!("--errors-file: {}", problem.problem)).with_help(problem.help)
    })
}

/// A scenario that gave no simulation, named by its file.
fn not_simulated(file: &ScenarioFile, error: meshtone::Error) -> Failure {
    let help = error.help().map(str::to_owned);
    match error {
        meshtone::Error::Scenario(error) => file.refuse(error).into(),
        error => {
            let message = format!("{}: {error}", file.path.display());
            Failure { help, ..Failure::bad_input(message) }
        }
    }
}

fn simulate(
    scenario: &Scenario,
    stages: Option<Stages>,
    with_trace: bool,
) -> Result<(Simulation, Option<Trace>), meshtone::Error> {
    let stages =
        stages.map_or_else(|| meshtone::stages_within(scenario, meshtone_io::memory::limit()), Ok)?;
    if !with_trace {
        return Ok((stages.simulate()?, None));
    }
    let before: Duration = stages.timings.iter().map(|time| time.elapsed).sum();
    let start = Instant::now();
    let (mut simulation, trace) = meshtone::trace_of(stages)?;
    let known: Duration = simulation.timings.iter().map(|time| time.elapsed).sum();
    let elapsed = start.elapsed().saturating_sub(known.saturating_sub(before));
    // A gearbox is traced after its time integration, which is known then; a pair during it.
    let stage = if known > before { "trace" } else { "time integration and trace" };
    simulation.timings.push(StageTime { stage, elapsed });
    Ok((simulation, Some(trace)))
}
