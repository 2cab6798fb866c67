//! `meshtone tune`

use std::fmt::Write as _;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use meshtone::tuning::{Experiment, ExperimentControl, ExperimentResult, Tuning, run_experiment};
use meshtone_io::atomic_file::StagedFile;
use meshtone_io::experiment::{ExperimentFile, Tuned, read_experiment, tuning_json, warnings, write_tuned};
use meshtone_io::own_file::undisturbed;
use meshtone_io::scenario_file::FileKind;
use meshtone_plot::tuning_figure;

use crate::failure::Failure;
use crate::other_kind::TUNED;
use crate::output_directory::{OutputDirectory, named_after};
use crate::same_file::is_same_file;
use crate::terminal::{print, print_error_line};

const TUNING: &str = "tuning.json";
const FIGURE: [&str; 2] = ["tuning.svg", "tuning.png"];
const FILES: [&str; 4] = [TUNING, TUNED, FIGURE[0], FIGURE[1]];

/// Tune simulations to what was measured on a rig
///
/// Simulates the experiment's cases and finds the enhancement, and the scenario's numbers, with which they resemble the
/// measurements most. Writes tuning.json, tuned.toml, tuning.svg and tuning.png; nothing is written unless all went well.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Tune {
    /// The experiment: base scenario, cases, measurements, what is tuned
    #[arg(value_name = "EXPERIMENT.toml")]
    experiment: PathBuf,
    /// Directory to write to. [default: <file name without .toml>_tuning in the current directory]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print no table and no progress; warnings and errors are still printed
    #[arg(short, long)]
    quiet: bool,
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
        let directory = self.directory()?;
        for name in FILES {
            let target = directory.join(name);
            if let Some(source) = file.sources.iter().find(|source| is_same_file(source, &target)) {
                let problem = format!("{} would be replaced, but is read", source.display());
                return Err(Failure::bad_input(problem).with_help("name another directory with -o"));
            }
        }
        let directory = OutputDirectory::for_files(&directory, &FILES)?;
        self.tune(&file, directory.path())?;
        Ok(())
    }

    fn directory(&self) -> Result<PathBuf, Failure> {
        let default = || named_after(&self.experiment, "_tuning");
        self.output
            .clone()
            .or_else(default)
            .ok_or_else(|| Failure::bad_input(format!("{} is no experiment file", self.experiment.display())))
    }

    fn tune(&self, file: &ExperimentFile, directory: &Path) -> Result<(), Failure> {
        let experiment = &file.experiment;
        let bar = Mutex::new(self.progress_bar());
        let progress = |finished: usize, all: usize| {
            // A poisoned lock means another thread's end, which is told elsewhere.
            if let Ok(bar) = bar.lock() {
                bar.set_length(all as u64);
                bar.set_position(finished as u64);
            }
        };
        let cancelled = AtomicBool::new(false);
        let control = ExperimentControl { progress: &progress, cancelled: &cancelled };
        let result = run_experiment(experiment, &control)
            .map_err(|error| Failure::bad_input(format!("{}: {error}", self.experiment.display())))?;
        if let Ok(bar) = bar.lock() {
            bar.finish_and_clear();
        }
        self.write(file, &result, directory)?;
        for warning in warnings(file, &result) {
            print_error_line(format!("warning: {warning}"));
        }
        if self.quiet { Ok(()) } else { print(&table(experiment, &result, directory)) }
    }

    fn progress_bar(&self) -> ProgressBar {
        if self.quiet {
            return ProgressBar::hidden();
        }
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        if let Ok(style) =
            ProgressStyle::with_template("{bar:30} {pos} of {len} simulations, {per_sec}, {eta} left")
        {
            bar.set_style(style);
        }
        bar
    }

    fn write(
        &self,
        file: &ExperimentFile,
        result: &ExperimentResult,
        directory: &Path,
    ) -> Result<(), Failure> {
        let experiment = &file.experiment;
        let json = tuning_json(file, result);
        let name = self.experiment.file_name().unwrap_or_default().to_string_lossy();
        let toml = write_tuned(&Tuned::of(experiment, result), &name);
        let mut staged =
            if self.no_figure { Vec::new() } else { figure(experiment, result, directory, &name)? };
        for (name, text) in [(TUNING, json), (TUNED, toml)] {
            staged.push(StagedFile::write(&directory.join(name), |file| file.write_all(text.as_bytes()))?);
        }
        undisturbed(|| staged.into_iter().try_for_each(StagedFile::commit))?;
        if self.no_figure {
            // An earlier tuning's would show something else.
            for name in FIGURE {
                remove(&directory.join(name))?;
            }
        }
        Ok(())
    }
}

fn figure(
    experiment: &Experiment,
    result: &ExperimentResult,
    directory: &Path,
    name: &str,
) -> Result<Vec<StagedFile>, Failure> {
    let cannot = |error| {
        Failure::failed(format!("cannot draw the figure: {error}"))
            .with_help("--no-figure writes the other results without it")
    };
    let title = format!("Simulations tuned to measurements: {name}");
    let figure = tuning_figure(experiment, result, &title).map_err(cannot)?;
    let png = figure.png().map_err(cannot)?;
    let [svg_path, png_path] = FIGURE.map(|name| directory.join(name));
    Ok(vec![
        StagedFile::write(&svg_path, |file| file.write_all(figure.svg().as_bytes()))?,
        StagedFile::write(&png_path, |file| file.write_all(&png))?,
    ])
}

fn remove(path: &Path) -> Result<(), Failure> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(Failure::of_writing(error.kind(), format!("cannot remove {}: {error}", path.display())))
        }
        _ => Ok(()),
    }
}

fn table(experiment: &Experiment, result: &ExperimentResult, directory: &Path) -> String {
    let mut text = String::new();
    let tuning = result.tuning();
    // Writing to a text cannot fail.
    let _ = writeln!(text, "  {:<28}{:>10}  95 % interval", "parameter", "value");
    let intervals = tuning.intervals;
    for (name, value, [least, largest]) in [
        ("width ratio", tuning.enhancement.width_ratio, intervals.width_ratio),
        (
            "fault-to-harmonics ratio",
            tuning.enhancement.fault_to_harmonics_ratio,
            intervals.fault_to_harmonics_ratio,
        ),
        ("noise level", tuning.enhancement.noise_level, intervals.noise_level),
    ] {
        let _ = writeln!(text, "  {name:<28}{value:>10.3}  {least:.3} to {largest:.3}");
    }
    if let Some(keys) = &result.with_keys {
        for (key, value) in experiment.keys.iter().zip(&keys.values) {
            let _ = writeln!(text, "  {:<28}{:>10}", key.key, short(*value));
        }
    }
    let _ =
        writeln!(text, "\n  {:<40}{:>10}{:>10}{:>15}", "mean error", "original", "enhanced", "leave one out");
    let mut row = |name: &str, tuning: &Tuning| {
        let _ = writeln!(
            text,
            "  {name:<40}{:>10.3}{:>10.3}{:>15.3}",
            tuning.original_error,
            tuning.enhanced_error,
            tuning.mean_leave_one_out_error()
        );
    };
    row("the three parameters alone", &result.enhancement_alone);
    if let Some(keys) = &result.with_keys {
        row("with the scenario's numbers", &keys.tuning);
    }
    let _ = writeln!(text, "  {:<40}{:>20.3}", "the measurements' own scatter", tuning.scatter);
    let _ = writeln!(text, "\n  {:<40}{:>10}{:>10}{:>15}", "case", "original", "enhanced", "leave one out");
    for (number, case) in experiment.cases.iter().enumerate() {
        let measured = &experiment.measured;
        let _ = writeln!(
            text,
            "  {:<40}{:>10.3}{:>10.3}{:>15.3}",
            case.label,
            measured.case_error(number, &tuning.original[number]),
            measured.case_error(number, &tuning.enhanced[number]),
            tuning.leave_one_out_error[number]
        );
    }
    let _ = writeln!(text, "\n{}", directory.display());
    text
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
