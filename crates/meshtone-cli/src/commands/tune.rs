//! `meshtone tune`

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use clap::Args;
use meshtone::tuning::{Experiment, ExperimentControl, ExperimentResult, Tuning, run_experiment};
use meshtone_io::experiment::{ExperimentFile, Tuned, read_experiment, tuning_json, warnings, write_tuned};
use meshtone_io::own_file::undisturbed;
use meshtone_io::scenario_file::FileKind;
use meshtone_plot::tuning_figure;

use crate::failure::Failure;
use crate::other_kind::TUNED;
use crate::output_directory::{OutputDirectory, named_after};
use crate::progress::with_bar;
use crate::replacement::{cannot_draw, replace, stage_figure, stage_text};
use crate::shown::Shown;
use crate::terminal::warn;

const TUNING: &str = "tuning.json";
const FIGURE: [&str; 2] = ["tuning.svg", "tuning.png"];
const FILES: [&str; 4] = [TUNING, TUNED, FIGURE[0], FIGURE[1]];

/// Tune simulations to what was measured on a rig
///
/// Simulates the experiment's cases and finds the enhancement, and the scenario's numbers, with which they resemble the
/// measurements most. Writes tuning.json, tuned.toml, tuning.svg and tuning.png; nothing is written after an error.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Tune {
    /// The experiment: base scenario, cases, measurements, what is tuned
    #[arg(value_name = "EXPERIMENT.toml")]
    experiment: PathBuf,
    /// Directory to write to. [default: <file name without .toml>_tuning in the current directory]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    shown: Shown,
    /// Do not draw the figure
    #[arg(long)]
    no_figure: bool,
}

const EXAMPLES: &str = "\
Examples:
  meshtone tune breakage.toml                                  into ./breakage_tuning
  meshtone enhance broken.toml --tuned breakage_tuning/tuned.toml --draws 20";

impl Tune {
    pub fn run(&self) -> Result<(), Failure> {
        let file = read_experiment(&self.experiment)
            .map_err(|error| Failure::of_file(FileKind::Experiment, error))?;
        let directory = self.output.clone().unwrap_or_else(|| named_after(&self.experiment, "tuning"));
        let read: Vec<&Path> = file.sources.iter().map(PathBuf::as_path).collect();
        let output = OutputDirectory::for_files(&directory, &FILES, &read)?;
        let result = with_bar("simulations", !self.shown.quiet, |show| {
            let progress = |finished: usize, all: usize| show(finished as u64, all as u64);
            let control = ExperimentControl { progress: &progress, cancelled: &AtomicBool::new(false) };
            run_experiment(&file.experiment, &control)
        });
        let result =
            result.map_err(|error| Failure::bad_input(format!("{}: {error}", self.experiment.display())))?;
        self.write(&file, &result, &output.path)?;
        warnings(&file, &result).into_iter().for_each(warn);
        let table = || table(&file.experiment, &result, &directory);
        self.shown.print(&directory.display(), table, || tuning_json(&file, &result))
    }

    fn write(
        &self,
        file: &ExperimentFile,
        result: &ExperimentResult,
        directory: &Path,
    ) -> Result<(), Failure> {
        let experiment = &file.experiment;
        let name = self.experiment.file_name().unwrap_or_default().to_string_lossy();
        let mut staged = Vec::new();
        if !self.no_figure {
            let title = format!("Simulations tuned to measurements: {name}");
            let figure = tuning_figure(experiment, result, &title).map_err(cannot_draw)?;
            staged = stage_figure(directory, FIGURE, &figure)?;
        }
        let toml = write_tuned(&Tuned::of(experiment, result), &name);
        staged.push(stage_text(&directory.join(TUNED), &toml)?);
        staged.push(stage_text(&directory.join(TUNING), &format!("{:#}\n", tuning_json(file, result)))?);
        Ok(undisturbed(|| replace(directory, &FILES, &FILES, staged))?)
    }
}

fn table(experiment: &Experiment, result: &ExperimentResult, directory: &Path) -> String {
    let tuning = result.tuning();
    let (enhancement, intervals) = (&tuning.enhancement, &tuning.intervals);
    let mut text = format!("  {:<28}{:>10}  95 % interval\n", "parameter", "value");
    let mut parameter = |name: &str, value: f64, [least, largest]: [f64; 2]| {
        text += &format!("  {name:<28}{value:>10.3}  {least:.3} to {largest:.3}\n");
    };
    parameter("width ratio", enhancement.width_ratio, intervals.width_ratio);
    let ratio = enhancement.fault_to_harmonics_ratio;
    parameter("fault-to-harmonics ratio", ratio, intervals.fault_to_harmonics_ratio);
    parameter("noise level", enhancement.noise_level, intervals.noise_level);
    if let Some(keys) = &result.with_keys {
        for (key, value) in experiment.keys.iter().zip(&keys.values) {
            text += &format!("  {:<28}{:>10}\n", key.key, short(*value));
        }
    }
    text += &heads("mean error");
    let mean =
        |tuning: &Tuning| [tuning.original_error, tuning.enhanced_error, tuning.mean_leave_one_out_error()];
    text += &errors("the three parameters alone", mean(&result.enhancement_alone));
    if let Some(keys) = &result.with_keys {
        text += &errors("with the scenario's numbers", mean(&keys.tuning));
    }
    text += &format!("  {:<40}{:>20.3}\n", "the measurements' own scatter", tuning.scatter);
    text += &heads("case");
    for (number, case) in experiment.cases.iter().enumerate() {
        let error = |simulated| experiment.measured.case_error(number, simulated);
        let [original, enhanced] = [&tuning.original, &tuning.enhanced].map(|of| error(&of[number]));
        text += &errors(&case.label, [original, enhanced, tuning.left_out[number].error]);
    }
    text + &left_out(experiment, tuning) + &format!("\n{}\n", directory.display())
}

/// Each case as the others predict it: by indicator the measured median and the interval that is expected.
fn left_out(experiment: &Experiment, tuning: &Tuning) -> String {
    let measured = &experiment.measured;
    let names = measured.indicators().iter().map(|indicator| {
        let name = indicator.name();
        let name = if indicator.is_logarithmic() { format!("log10 {name}") } else { name.to_owned() };
        format!("{name:>27}")
    });
    let mut text = format!("\n  {:<40}{}\n", "left out: measured, 95 % interval", names.collect::<String>());
    for (number, (case, left_out)) in experiment.cases.iter().zip(&tuning.left_out).enumerate() {
        let expected = left_out.intervals.iter().enumerate().map(|(j, [least, largest])| {
            let interval = format!("{least:.2} to {largest:.2}");
            format!("{:>11.2}{interval:>16}", measured.median(number, j))
        });
        text += &format!("  {:<40}{}\n", case.label, expected.collect::<String>());
    }
    text
}

fn heads(name: &str) -> String {
    format!("\n  {name:<40}{:>10}{:>10}{:>15}\n", "original", "enhanced", "leave one out")
}

fn errors(name: &str, [original, enhanced, left_out]: [f64; 3]) -> String {
    format!("  {name:<40}{original:>10.3}{enhanced:>10.3}{left_out:>15.3}\n")
}

fn short(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e5 {
        // A seed, or a grade.
        format!("{value}")
    } else if (1e-3..1e5).contains(&value.abs()) {
        format!("{value:.4}")
    } else {
        format!("{value:.3e}")
    }
}
