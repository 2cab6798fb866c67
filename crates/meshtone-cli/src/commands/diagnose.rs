//! `meshtone diagnose`

use std::path::{Path, PathBuf};

use clap::Args;
use meshtone::scenario::Scenario;
use meshtone::signal::TrainWheel;
use meshtone_diagnose::{Answer, DiagnosisWarning, Observation, Question, SignalKind};
use meshtone_io::experiment::read_tuned;
use meshtone_io::indicators::WarningEntry;
use meshtone_io::own_file::undisturbed;
use meshtone_io::scenario_file::{FileKind, ScenarioFile};
use serde_json::{Value, json};

use crate::check::check;
use crate::choice::{Choice, one_of};
use crate::diagnose::healthy::HealthyOptions;
use crate::diagnose::observe::Observer;
use crate::diagnose::reference::{ReferenceOptions, answer};
use crate::diagnose::{figure, table};
use crate::failure::Failure;
use crate::indicators::figures::several_names;
use crate::indicators::options::{PhaseOptions, ReadingOptions, ShaftOptions};
use crate::output_directory::{OutputDirectory, named_after};
use crate::replacement::{replace, stage_figure, stage_text};
use crate::shown::Shown;
use crate::terminal::warn;
use crate::warnings;

const JSON: &str = "diagnosis.json";
const FIGURE: [&str; 2] = ["diagnosis.svg", "diagnosis.png"];
const FILES: [&str; 3] = [JSON, FIGURE[0], FIGURE[1]];

/// Diagnose a gear: compare recordings with simulations
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
    /// Recordings of one state of the gears: any file of `meshtone indicators`, or directories that `meshtone simulate` wrote
    #[arg(value_name = "RECORDING", required = true)]
    recordings: Vec<PathBuf>,
    /// The rig, a pair or a gearbox, with the recordings' speed and load; the listed sensor of the channel is simulated, or the first one; its
    /// faults are left out
    #[arg(long, value_name = "SCENARIO.toml")]
    scenario: PathBuf,
    /// Recordings of the same rig, by the same sensor, when it was healthy
    #[arg(long, value_name = "RECORDING", num_args = 1..)]
    healthy: Vec<PathBuf>,
    /// Result of `meshtone tune`: numbers that it tuned are put into the scenario
    #[arg(long, value_name = "tuned.toml")]
    tuned: Option<PathBuf>,
    /// Kind of the recordings; `average` and `difference`: one revolution of the gear of a pair
    #[arg(long, default_value = "recording", value_parser = one_of(&SIGNALS))]
    signal: SignalKind,
    #[command(flatten)]
    kept: ReferenceOptions,
    /// Directory to write to. [default: <name of the first recording>_diagnosis in the current directory]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    shown: Shown,
    /// Draw no figure
    #[arg(long)]
    no_figure: bool,
    #[command(flatten)]
    reading: ReadingOptions,
    #[command(flatten)]
    phase: PhaseOptions,
    #[command(flatten)]
    shafts: ShaftOptions,
    #[command(flatten)]
    of_healthy: HealthyOptions,
}

const EXAMPLES: &str = "\
Examples:
  meshtone diagnose broken --scenario healthy.toml --healthy sound     what `meshtone simulate` wrote
  meshtone diagnose run.csv -c bearing --tach tacho --scenario rig.toml --healthy first.csv
  meshtone diagnose fast.csv --shaft-hz 28.3 --scenario rig.toml --healthy slow.csv --healthy-shaft-hz 19.9
  meshtone diagnose run.csv -c bearing --scenario rig.toml             the speed is the scenario's, made exact by the mesh tone
  meshtone diagnose figure5.csv --signal difference --unit g --scenario rig.toml";

const SIGNALS: [Choice<SignalKind>; 3] = [
    ("recording", "Any number of revolutions", SignalKind::Recording),
    ("average", "The gear's synchronous average", SignalKind::Average),
    ("difference", "One revolution without mesh harmonics and their sidebands", SignalKind::Difference),
];

impl Diagnose {
    pub fn run(&self) -> Result<(), Failure> {
        let scenario = self.scenario()?;
        let observer = Observer::new(&scenario, self.signal, &self.reading, &self.phase, &self.shafts)?;
        let (now, of_now) = observe(&observer, &self.recordings)?;
        let (reading, phase) = (self.of_healthy.reading(&self.reading), self.of_healthy.phase(&self.phase));
        let observer = Observer::new(&scenario, self.signal, &reading, &phase, &self.shafts)?;
        let (healthy, of_healthy) = observe(&observer, &self.healthy).map_err(HealthyOptions::named)?;
        let question = Question { now: &now, healthy: &healthy };
        let directory = self.output.clone().unwrap_or_else(|| named_after(&self.recordings[0], "diagnosis"));
        let recordings = self.recordings.iter().chain(&self.healthy).map(PathBuf::as_path);
        let of_rig = [self.scenario.as_path()].into_iter().chain(self.tuned.as_deref());
        let read: Vec<&Path> =
            recordings.chain(self.phase.files()).chain(phase.files()).chain(of_rig).collect();
        let output = OutputDirectory::for_files(&directory, &FILES, &read)?;
        let prior = question.prior(&scenario).map_err(|error| {
            let failure = Failure::bad_input(error.to_string());
            error.help.into_iter().fold(failure, Failure::with_help)
        })?;
        question.check(&prior)?;
        // Before minutes of simulations.
        let of_reading = of_now.iter().chain(&of_healthy).map(warnings::in_words);
        let of_reading: Vec<DiagnosisWarning> =
            of_reading.map(|said| DiagnosisWarning { code: "reading", message: said }).collect();
        let known = [of_reading.clone(), question.warnings(&prior)].concat();
        known.iter().map(|of| &of.message).for_each(warn);
        let store = self.kept.store()?;
        let of = self.scenario.display().to_string();
        let reference = self.kept.simulations(&store, &prior, &of, self.shown.quiet)?;
        let mut answer = answer(&reference, &question, self.shown.quiet)?;
        answer.warnings.splice(0..0, of_reading);
        let json = self.json(&answer, &store.folder_of(&prior));
        self.write(&output.path, &answer, &json, &prior.train.wheels)?;
        let unknown = answer.warnings.iter().filter(|warning| !known.contains(warning));
        unknown.map(|of| &of.message).for_each(warn);
        let to = directory.display();
        self.shown.print(&to, || format!("{} -> {to}\n{}", self.title(), table::table(&answer)), || json)
    }

    /// The rig.
    fn scenario(&self) -> Result<Scenario, Failure> {
        let file = ScenarioFile::read(&self.scenario)?;
        let mut scenario = file.scenario.clone().with_faults(Vec::new());
        if let Some(path) = &self.tuned {
            let refuse = |problem: String| Failure::bad_input(format!("{}: {problem}", path.display()));
            let tuned = read_tuned(path).map_err(|error| Failure::of_file(FileKind::Tuned, error))?;
            if let Some(problem) = tuned.warning_for(&scenario) {
                return Err(refuse(problem).with_help("tune again with this scenario"));
            }
            scenario = tuned.apply(&scenario).map_err(|error| refuse(error.to_string()))?;
        }
        self.reading.lead_with_sensor(&mut scenario);
        let (doubts, _) = check(&scenario).map_err(|error| file.refuse(error))?;
        warnings::print(&file, &doubts);
        Ok(scenario)
    }

    fn json(&self, answer: &Answer, folder: &Path) -> Value {
        let names =
            |paths: &[PathBuf]| paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>();
        let mut all = answer.to_json();
        all["recordings"] = json!(names(&self.recordings));
        all["healthy"] = json!(names(&self.healthy));
        all["scenario"] = json!(self.scenario.display().to_string());
        all["tuned"] = json!(self.tuned.as_ref().map(|path| path.display().to_string()));
        all["reference"] = answer.reference_json(self.kept.records, folder);
        all
    }

    fn write(
        &self,
        directory: &Path,
        answer: &Answer,
        json: &Value,
        rig: &[TrainWheel],
    ) -> Result<(), Failure> {
        let mut staged = match self.no_figure {
            true => Vec::new(),
            false => stage_figure(directory, FIGURE, &figure::draw(answer, &self.title(), rig))?,
        };
        staged.push(stage_text(&directory.join(JSON), &format!("{json:#}\n"))?);
        Ok(undisturbed(|| replace(directory, &FILES, &FILES, staged))?)
    }

    fn title(&self) -> String {
        several_names(&self.recordings)
    }
}

/// Observes files.
fn observe(observer: &Observer, paths: &[PathBuf]) -> Result<(Vec<Observation>, Vec<WarningEntry>), Failure> {
    let (mut observations, mut warnings) = (Vec::new(), Vec::new());
    for path in paths {
        let (observation, of_path) = observer.observe(path)?;
        observations.push(observation);
        warnings.extend(of_path);
    }
    Ok((observations, warnings))
}
