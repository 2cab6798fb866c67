//! `meshtone diagnose`

use std::fs;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use meshtone::scenario::Scenario;
use meshtone_diagnose::{
    Answer, Learned, Observation, Prior, Question, REFINED_RECORDS, ReferenceControl, ReferenceSet,
    ReferenceStore, Refined, SignalKind, diagnose, refine,
};
use meshtone_io::atomic_file::{StagedFile, WriteFileError};
use meshtone_io::experiment::read_tuned;
use meshtone_io::indicators::WarningEntry;
use meshtone_io::memory;
use meshtone_io::own_file::undisturbed;
use meshtone_io::scenario_file::ScenarioFile;
use serde_json::{Value, json};

use crate::check::check;
use crate::diagnose::observe::{Observed, Observer};
use crate::diagnose::{figure, table};
use crate::failure::Failure;
use crate::indicators::figures::name;
use crate::indicators::options::{PhaseOptions, ReadingOptions};
use crate::output_directory::OutputDirectory;
use crate::targets::{check_not_read, named_after};
use crate::terminal::{print, print_error_line};

/// Most simulations that are learnt from: time and memory grow with their square; so many take 70 s and 0.7 GB.
const MOST_RECORDS: u64 = 20_480;
const JSON: &str = "diagnosis.json";
const FIGURE: [&str; 2] = ["diagnosis.svg", "diagnosis.png"];
const FILES: [&str; 3] = [JSON, FIGURE[0], FIGURE[1]];

/// What may be wrong with a gear, found from recordings by simulations
///
/// Simulates the rig with every kind of damage and with everything that is not known of it, and says what the recordings resemble:
/// kinds of damage with their probabilities, severity with an interval, wheel and tooth, and whether they are like any simulation.
/// Probabilities are given the scenario; before the recordings healthy is one half, and all kinds of damage are alike.
/// Writes diagnosis.json, diagnosis.svg and diagnosis.png.
///
/// The first question about a scenario simulates for some minutes. The simulations are kept, also where they are stopped, and
/// later questions take them from there: in meshtone/reference of the user's cache directory ($XDG_CACHE_HOME or ~/.cache,
/// ~/Library/Caches on macOS, %LOCALAPPDATA% on Windows), which may be removed at any time.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Diagnose {
    /// Recordings of one state of the gear pair: any file of `meshtone indicators`, or directories that `meshtone simulate` wrote
    #[arg(value_name = "RECORDING", required = true)]
    recordings: Vec<PathBuf>,
    /// The rig, with the recordings' speed and load; its faults are left out
    #[arg(long, value_name = "SCENARIO.toml")]
    scenario: PathBuf,
    /// Recordings of the same rig, by the same sensor, when it was healthy
    #[arg(long, value_name = "RECORDING", num_args = 1..)]
    healthy: Vec<PathBuf>,
    /// What `meshtone tune` found: numbers that it tuned are put into the scenario
    #[arg(long, value_name = "tuned.toml")]
    tuned: Option<PathBuf>,
    /// What the recordings are; `average` and `difference`: one revolution of the gear
    #[arg(long, default_value = "recording")]
    signal: SignalArgument,
    /// Folder in which the simulations are kept. [default: in the user's cache directory, see --help]
    #[arg(long, value_name = "DIR")]
    reference: Option<PathBuf>,
    /// Simulations to learn from, in batches of 512, up to 20480: twice as many take four times as long to compare
    #[arg(long, value_name = "N", default_value_t = 6144, value_parser = clap::value_parser!(u64).range(512..=MOST_RECORDS))]
    records: u64,
    /// Directory to write to. [default: <name of the first recording>_diagnosis in the current directory]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print no table and no progress; warnings and errors are still printed
    #[arg(short, long)]
    quiet: bool,
    /// Draw no figure
    #[arg(long)]
    no_figure: bool,
    #[command(flatten)]
    reading: ReadingOptions,
    #[command(flatten)]
    phase: PhaseOptions,
}

const EXAMPLES: &str = "\
Examples:
  meshtone diagnose broken --scenario healthy.toml --healthy sound     what `meshtone simulate` wrote
  meshtone diagnose run.csv -c bearing --tach tacho --scenario rig.toml --healthy first.csv
  meshtone diagnose run.csv -c bearing --scenario rig.toml             the speed is the scenario's, made exact by the mesh tone
  meshtone diagnose figure5.csv --signal difference --unit g --scenario rig.toml";

/// [`SignalKind`] on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum SignalArgument {
    /// Any number of revolutions
    Recording,
    /// The gear's synchronous average
    Average,
    /// The same without mesh harmonics and their sidebands
    Difference,
}

impl From<SignalArgument> for SignalKind {
    fn from(argument: SignalArgument) -> Self {
        match argument {
            SignalArgument::Recording => Self::Recording,
            SignalArgument::Average => Self::Average,
            SignalArgument::Difference => Self::Difference,
        }
    }
}

impl Diagnose {
    pub fn run(&self) -> Result<(), Failure> {
        let scenario = self.scenario()?;
        let observer = Observer::new(&scenario, self.signal.into(), &self.reading, &self.phase)?;
        let (now, mut warnings) = observe(&observer, &self.recordings)?;
        let (healthy, more) = observe(&observer, &self.healthy)?;
        warnings.extend(more);
        let question = Question { now: &now, healthy: &healthy };
        let directory = self.directory();
        self.check_targets(&directory)?;
        let output = OutputDirectory::for_files(&directory, &FILES)?;
        let prior = Prior::new(&scenario);
        question.check(&prior)?;
        let store = ReferenceStore::new(self.folder()?);
        let reference = self.reference(&store, &prior)?;
        let learned = Learned::new(&reference, &question)?;
        let refined = self.refined(&learned, &question)?;
        let mut answer = diagnose(&learned, &question, refined.as_ref())?;
        answer.warnings.splice(0..0, warnings.iter().map(in_words));
        let json = self.json(&answer, &store.folder_of(&prior));
        self.write(output.path(), &answer, &json, scenario.gears.gear_teeth)?;
        for warning in &answer.warnings {
            print_error_line(format!("warning: {warning}"));
        }
        if self.quiet {
            return Ok(());
        }
        print(&format!("{} -> {}\n{}", self.title(), directory.display(), table::table(&answer)))
    }

    /// The rig.
    fn scenario(&self) -> Result<Scenario, Failure> {
        let file = ScenarioFile::read_within(&self.scenario, memory::limit())?;
        let mut scenario = file.scenario.clone().with_faults(Vec::new());
        if let Some(path) = &self.tuned {
            let tuned = read_tuned(path)?;
            let refuse = |problem: String| Failure::bad_input(format!("{}: {problem}", path.display()));
            if let Some(problem) = tuned.warning_for(&scenario) {
                return Err(refuse(problem).with_help("tune again with the scenario's model"));
            }
            scenario = tuned.apply(&scenario).map_err(|error| refuse(error.to_string()))?;
        }
        let (warnings, _) = check(&scenario).map_err(|error| file.refuse(error))?;
        for warning in warnings {
            print_error_line(format!("warning: {}: {warning}", self.scenario.display()));
        }
        Ok(scenario)
    }

    /// Where simulations are kept.
    fn folder(&self) -> Result<PathBuf, Failure> {
        self.reference.clone().or_else(ReferenceStore::default_folder).ok_or_else(|| {
            Failure::bad_input(
                "there is no folder for the simulations: the environment names no home directory",
            )
            .with_help("name one with --reference DIR")
        })
    }

    fn reference(&self, store: &ReferenceStore, prior: &Prior) -> Result<ReferenceSet, Failure> {
        let bar = self.progress_bar(self.records, "");
        let (folder, since) = (store.folder_of(prior), Instant::now());
        let kept = fs::read_dir(&folder).map_or(0, Iterator::count) as u64;
        let shows_progress = !self.quiet && kept < self.records.div_ceil(ReferenceStore::BATCH);
        if shows_progress {
            print_error_line(self.begins(&folder));
        }
        let progress = |finished: usize| bar.set_position(finished as u64);
        let control = ReferenceControl { progress: &progress, cancelled: &AtomicBool::new(false) };
        let reference = store.get(prior, self.records, &control);
        bar.finish_and_clear();
        let reference = reference?;
        if shows_progress {
            print_error_line(format!("simulated in {:.0} s", since.elapsed().as_secs_f64()));
        }
        Ok(reference)
    }

    /// What is said before the first simulation, also where no bar can be drawn.
    fn begins(&self, folder: &Path) -> String {
        format!(
            "simulating {} with every kind of damage, up to {} times; what is finished is kept in {}, also when stopped",
            self.scenario.display(),
            self.records,
            folder.display()
        )
    }

    /// More simulations of what is likely.
    fn refined(&self, learned: &Learned, question: &Question) -> Result<Option<Refined>, Failure> {
        let bar = self.progress_bar(REFINED_RECORDS, ", of the likeliest damage");
        let progress = |finished: usize| bar.set_position(finished as u64);
        let control = ReferenceControl { progress: &progress, cancelled: &AtomicBool::new(false) };
        let refined = refine(learned, question, &control);
        bar.finish_and_clear();
        Ok(refined?)
    }

    fn progress_bar(&self, count: u64, of: &'static str) -> ProgressBar {
        if self.quiet {
            return ProgressBar::hidden();
        }
        let bar = ProgressBar::with_draw_target(Some(count), ProgressDrawTarget::stderr());
        if let Ok(style) =
            ProgressStyle::with_template("{bar:30} {pos} of {len} simulations{msg}, {per_sec}, {eta} left")
        {
            bar.set_style(style);
            bar.set_message(of);
        }
        bar
    }

    fn directory(&self) -> PathBuf {
        self.output.clone().unwrap_or_else(|| named_after(&self.recordings[0], "diagnosis"))
    }

    /// Refuses to replace a file that is read.
    fn check_targets(&self, directory: &Path) -> Result<(), Failure> {
        let of_phase = self.phase.pulse_times.iter().chain(&self.phase.speed_profile);
        let of_rig = std::iter::once(&self.scenario).chain(&self.tuned);
        let read = self.recordings.iter().chain(&self.healthy).chain(of_phase).chain(of_rig);
        check_not_read(&FILES.map(|name| directory.join(name)), read)
    }

    fn json(&self, answer: &Answer, folder: &Path) -> Value {
        let names =
            |paths: &[PathBuf]| paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>();
        let mut all = answer.to_json();
        all["recordings"] = json!(names(&self.recordings));
        all["healthy"] = json!(names(&self.healthy));
        all["scenario"] = json!(self.scenario.display().to_string());
        all["tuned"] = json!(self.tuned.as_ref().map(|path| path.display().to_string()));
        all["reference"] = json!({
            "asked": self.records,
            "simulated": answer.simulated_records,
            "records": answer.reference_records,
            "refined_records": answer.refined_records,
            "folder": folder.display().to_string(),
        });
        all
    }

    fn write(&self, directory: &Path, answer: &Answer, json: &Value, gear_teeth: u32) -> Result<(), Failure> {
        let mut staged = Vec::new();
        if !self.no_figure {
            let figure = figure::draw(answer, &self.title(), gear_teeth);
            let png =
                figure.png().map_err(|error| Failure::failed(format!("cannot draw the figure: {error}")))?;
            let [svg_path, png_path] = FIGURE.map(|name| directory.join(name));
            staged.push(StagedFile::write(&svg_path, |file| file.write_all(figure.svg().as_bytes()))?);
            staged.push(StagedFile::write(&png_path, |file| file.write_all(&png))?);
        }
        let json = StagedFile::write(&directory.join(JSON), |file| writeln!(file, "{json:#}"))?;
        undisturbed(|| {
            // Without it the directory is not complete; an earlier figure would show something else.
            let gone = if self.no_figure { &FILES[..] } else { &FILES[..1] };
            gone.iter().try_for_each(|name| remove(&directory.join(name)))?;
            staged.into_iter().try_for_each(StagedFile::commit)?;
            Ok(json.commit()?)
        })
    }

    /// `run01.csv … run12.csv`.
    fn title(&self) -> String {
        match &self.recordings[..] {
            [first, .., last] => format!("{} … {}", name(first), name(last)),
            several => several.iter().map(|path| name(path)).collect(),
        }
    }
}

fn observe(observer: &Observer, paths: &[PathBuf]) -> Result<(Vec<Observation>, Vec<WarningEntry>), Failure> {
    let mut observations = Vec::new();
    let mut all = Vec::new();
    for path in paths {
        let Observed { observation, warnings } = observer.observe(path)?;
        observations.push(observation);
        all.extend(warnings);
    }
    Ok((observations, all))
}

fn in_words(warning: &WarningEntry) -> String {
    let source = warning.source.as_ref().map(|source| format!("{}: ", source.display())).unwrap_or_default();
    format!("{source}{}", warning.message)
}

fn remove(path: &Path) -> Result<(), WriteFileError> {
    match fs::remove_file(path) {
        Err(source) if source.kind() != ErrorKind::NotFound => {
            Err(WriteFileError { path: path.to_path_buf(), source })
        }
        _ => Ok(()),
    }
}
