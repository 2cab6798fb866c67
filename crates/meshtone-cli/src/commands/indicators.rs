//! `meshtone indicators`

use std::path::{Path, PathBuf};

use clap::Args;
use meshtone_io::indicators::{RecordingEntry, WarningEntry};
use meshtone_io::scenario_file::ScenarioFile;
use meshtone_plot::trend::Trend;

use crate::failure::Failure;
use crate::indicators::bearings::BearingOptions;
use crate::indicators::options::{PhaseOptions, ProcessingOptions, ReadingOptions, ShaftOptions};
use crate::indicators::process::process;
use crate::indicators::reading::Input;
use crate::indicators::results::{Series, settings};
use crate::indicators::{figures, files, limits, table};
use crate::output_directory::{OutputDirectory, named_after};
use crate::progress::with_spinner;
use crate::shown::Shown;
use crate::terminal::warn;
use crate::warnings::in_words;

/// Warnings of one recording that are printed; the others are counted.
const PRINTED: usize = 5;

/// Condition indicators of recordings, simulated or measured
///
/// Averages a channel over the revolutions of a shaft, separates the average into its parts, and writes indicators.json,
/// indicators.parquet, average and spectra of each wheel's last record (averages.parquet, spectra.parquet), and their figure
/// (indicators.svg, .png). Several recordings, or
/// segments of one (--revolutions), are a series in the order given, with a figure of the trend (trend.svg, .png). Of a
/// run-up the amplitudes over order and time are drawn too (order_map.svg, .png), and of bearings that are named or that the
/// scenario has the defect lines (bearings.parquet, .svg, .png). Nothing is written unless all recordings are valid.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Indicators {
    /// Recordings, in the order of time: CSV and other text, Parquet, NPY, NPZ, MAT, HDF5, WAV, universal files, TDMS, MDF 4, LVM, Excel, or directories that
    /// `meshtone simulate` wrote or that are sets of the Python package bearing-datasets
    #[arg(value_name = "RECORDING", required = true)]
    recordings: Vec<PathBuf>,
    /// Directory to write to. [default: <name of the recording>_indicators, for several series_indicators, in the
    /// current directory]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    shown: Shown,
    /// Write the tables as CSV too
    #[arg(long)]
    csv: bool,
    /// Draw no figures
    #[arg(long)]
    no_figure: bool,
    #[command(flatten)]
    reading: ReadingOptions,
    /// The machine, a pair or a gearbox: its tooth counts give the phase of all shafts from that of one, every wheel is
    /// processed, and the defect lines of its rolling bearings are looked for
    #[arg(long, value_name = "SCENARIO.toml", conflicts_with_all = ["teeth", "mate_teeth"])]
    scenario: Option<PathBuf>,
    #[command(flatten)]
    phase: PhaseOptions,
    #[command(flatten)]
    shafts: ShaftOptions,
    #[command(flatten)]
    processing: ProcessingOptions,
    #[command(flatten)]
    bearings: BearingOptions,
}

const EXAMPLES: &str = "\
Examples:
  meshtone indicators broken                                        what `meshtone simulate` wrote there, both wheels
  meshtone indicators run.csv --channel bearing --teeth 38 --shaft-hz 17.9
  meshtone indicators run.csv -c bearing --tach tacho --teeth 17 --mate-teeth 38
  meshtone indicators run.csv -c bearing --scenario gearbox.toml --tach tacho --shaft input     every shaft of a gearbox
  meshtone indicators run.csv -c bearing --bearing 6205 --tach tacho                a bearing, of a rig without gears too
  meshtone indicators day*.parquet -c bearing --teeth 38 --shaft-hz 17.9 -o trend   a series, in this order";

impl Indicators {
    pub fn run(&self) -> Result<(), Failure> {
        let directory = self.directory();
        let file = self.scenario.as_deref().map(ScenarioFile::read).transpose()?;
        let scenario = file.as_ref().map(|file| &file.scenario);
        let mut series = Series::default();
        for (number, path) in self.recordings.iter().enumerate() {
            let of = format!("({} of {})", number + 1, self.recordings.len());
            with_spinner(format!("{} {of}", path.display()), !self.shown.quiet, || {
                let input = Input::read(path, &self.reading, self.phase.channel())?;
                let processed =
                    process(&input, &self.phase, &self.shafts, scenario, &self.processing, &self.bearings);
                let processed = processed.map_err(|failure| Failure {
                    help: self.reading.in_kilohertz().or(failure.help),
                    ..failure
                })?;
                series.add(input, processed, &self.processing)
            })?;
        }
        series.finish()?;
        let mut trends = figures::trends(&series);
        self.refuse_unanswered(&series)?;
        if let Some(first) = self.processing.sound_records {
            series.results.limits = limits::set(&series, &mut trends, first as usize);
        }
        let scenario = self.scenario.as_deref();
        series.results.settings = settings(
            &self.phase,
            &self.shafts,
            scenario,
            series.latest.as_ref(),
            &self.processing,
            &self.bearings,
        );
        if let Some(message) = order_of_names(&self.recordings) {
            series.results.warnings.push(WarningEntry { source: None, message, kind: None });
        }
        let sources = file.iter().flat_map(ScenarioFile::sources);
        let recordings = self.recordings.iter().map(PathBuf::as_path);
        let read: Vec<&Path> = recordings.chain(self.phase.files()).chain(sources).collect();
        let output = OutputDirectory::for_files(&directory, &files::FILES, &read)?;
        self.write(&output.path, &series, trends)?;
        print_warnings(&series.results.warnings);
        let from = match &self.recordings[..] {
            [only] => only.display().to_string(),
            several => format!("{} recordings", several.len()),
        };
        let (to, limits) = (directory.display(), self.processing.iso_20816);
        let table = || format!("{from} -> {to}\n{}", table::table(&series, limits));
        self.shown.print(&to, table, || series.results.to_json())
    }

    /// Refuses options that nothing of the recordings can answer.
    fn refuse_unanswered(&self, series: &Series) -> Result<(), Failure> {
        let most = series.wheels.iter().map(|wheel| series.of(wheel).count()).max().unwrap_or(0);
        if let Some(first) = self.processing.sound_records.filter(|first| *first as usize >= most) {
            let problem =
                format!("--sound-records {first}: a wheel has {most} at most, so that none is judged");
            return Failure::refuse(problem, "name more recordings, or state fewer that are sound");
        }
        let has_velocity = |entry: &RecordingEntry| entry.velocity_rms_mm_per_s.is_some();
        if self.processing.iso_20816.is_some() && !series.results.recordings.iter().any(has_velocity) {
            let problem =
                format!("--iso-20816: {} is not known to be an acceleration", series.results.channel);
            return Failure::refuse(problem, "state its unit by --unit, g or m/s2");
        }
        Ok(())
    }

    fn directory(&self) -> PathBuf {
        match (&self.output, &self.recordings[..]) {
            (Some(output), _) => output.clone(),
            (None, [only]) => named_after(only, "indicators"),
            (None, _) => PathBuf::from("series_indicators"),
        }
    }

    fn write(&self, directory: &Path, series: &Series, trends: Vec<Trend>) -> Result<(), Failure> {
        let figures = match series.latest.as_ref().filter(|_| !self.no_figure) {
            None => files::Figures::default(),
            Some(latest) => files::Figures {
                record: figures::of_record(series, latest, &self.processing),
                trend: series
                    .is_series()
                    .then(|| figures::of_trend(series, trends, &latest.turned.source, &self.processing)),
                order_map: figures::of_order_map(series, latest),
                bearings: figures::of_bearings(series, latest, self.bearings.separation()),
            },
        };
        files::write(directory, series, &figures, self.csv)
    }
}

fn print_warnings(warnings: &[WarningEntry]) {
    for of_one in warnings.chunk_by(|a, b| a.source == b.source) {
        of_one.iter().take(PRINTED).map(in_words).for_each(warn);
        if let Some(more) = of_one.len().checked_sub(PRINTED).filter(|more| *more > 0) {
            warn(format_args!("… and {more} more, in indicators.json"));
        }
    }
}

/// A shell puts run10 before run2: NA4 and the trend would be those of another order.
fn order_of_names(recordings: &[PathBuf]) -> Option<String> {
    let names: Vec<String> = recordings.iter().map(|path| path.display().to_string()).collect();
    let place =
        names.windows(2).position(|pair| pair[0] < pair[1] && numbers(&pair[0]) > numbers(&pair[1]))?;
    let alphabetical = names.is_sorted();
    alphabetical.then(|| {
        format!(
            "the series is in the order given, in which {} comes before {}; if time goes by their numbers, name them in \
             that order, as with `$(ls -v …)`",
            names[place],
            names[place + 1]
        )
    })
}

/// The numbers in a name, the words between them left out.
fn numbers(name: &str) -> Vec<u64> {
    let parts = name.split(|letter: char| !letter.is_ascii_digit());
    parts.filter(|part| !part.is_empty()).filter_map(|part| part.parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shells_order_is_noticed() {
        let warned =
            |names: &[&str]| order_of_names(&names.iter().map(PathBuf::from).collect::<Vec<_>>()).is_some();
        assert!(warned(&["run1.csv", "run10.csv", "run2.csv"]));
        assert!(!warned(&["run1.csv", "run2.csv", "run10.csv"]));
        assert!(!warned(&["run01.csv", "run02.csv", "run10.csv"]));
        assert!(!warned(&["sound.csv", "worn.csv"]));
        assert!(!warned(&["run2.csv", "run1.csv"]));
    }
}
