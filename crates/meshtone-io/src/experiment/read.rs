//! The experiment file.

use std::path::{Path, PathBuf};

use meshtone::scenario::{Fault, Scenario, WheelName};
use meshtone::sensor::Channel;
use meshtone::signal::{GearTrain, MeanPart, SeparationSettings, TrainWheel};
use meshtone::stages;
use meshtone::tuning::{
    Case, DifferenceChain, EnhancementBounds, Experiment, HybridError, KeyRange, MOST_CANDIDATES, TunedKey,
    TuningIndicator,
};
use meshtone_toml::{ReadResult, TomlDocument, TomlError, TomlTable, TomlValue, nearest_name};

use super::measured::{self, CaseFiles, Wanted};
use super::recordings::RATE_TOLERANCE;
use crate::channel_name::{accelerations, read_channel};
use crate::scenario_file::{FileKind, ReadScenarioError, ScenarioFile, read_text};

/// Combinations of the tuned keys' values that are simulated unless the file says otherwise.
const CANDIDATES: u64 = 160;

/// A rate of at most so much may be meant in kHz.
const MOST_KILOHERTZ: f64 = 200.0;

/// An experiment file that has been read, with everything that it names.
#[derive(Debug, Clone, PartialEq)]
pub struct ExperimentFile {
    /// What it says.
    pub experiment: Experiment,
    /// All files that were read: this one, the scenario's, the measurements'.
    pub sources: Vec<PathBuf>,
    /// What is doubtful about the recordings.
    pub warnings: Vec<String>,
}

/// Reads an experiment, its base scenario and its measurements.
///
/// # Arguments
/// * `path` - the experiment file; names of other files in it are relative to its directory
///
/// # Errors
/// A file that cannot be read; what is wrong in one of them, with key and line; what [`Experiment::check`] refuses.
pub fn read_experiment(path: &Path) -> Result<ExperimentFile, ReadScenarioError> {
    let text = read_text(path)?;
    let mut reading =
        Reading { path, sources: vec![path.to_path_buf()], warnings: Vec::new(), scenario_error: None };
    let read = TomlDocument::parse(&text).and_then(|document| {
        document.root().read(|root| reading.experiment(root)).map_err(|error| document.locate(error))
    });
    let Reading { sources, warnings, scenario_error, .. } = reading;
    match read {
        Ok(experiment) => Ok(ExperimentFile { experiment, sources, warnings }),
        // An error in the scenario file is reported with that file's lines.
        Err(error) => Err(scenario_error.unwrap_or_else(|| {
            ReadScenarioError::invalid(FileKind::Experiment, path.to_path_buf(), text, error)
        })),
    }
}

/// What is kept while an experiment is read.
pub(super) struct Reading<'a> {
    /// The experiment file.
    path: &'a Path,
    /// All files that were read.
    sources: Vec<PathBuf>,
    /// What is doubtful about the recordings.
    pub(super) warnings: Vec<String>,
    /// What is wrong in the scenario file, with that file's lines.
    scenario_error: Option<ReadScenarioError>,
}

impl Reading<'_> {
    fn directory(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }

    /// The path of a file that the experiment names, relative to its directory; it is added to the files that were read.
    pub(super) fn source(&mut self, name: &str) -> PathBuf {
        let path = self.directory().join(name);
        self.sources.push(path.clone());
        path
    }

    fn experiment(&mut self, root: &TomlTable<'_>) -> ReadResult<Experiment> {
        let base = self.scenario(root)?;
        if !base.planetary().is_empty() {
            let problem = HybridError::Planetary.to_string();
            return Err(root
                .error("scenario", problem)
                .with_help("name the scenario of a pair or a gearbox"));
        }
        let train = GearTrain::of_scenario(&base)?;
        let (chain, wheel) = root.table_or_empty("signal")?.read(|table| signal(table, &base, &train))?;
        let listed = root.required("case", "the cases, [[case]] each, the healthy one first")?;
        let (mut cases, mut files) = (Vec::new(), Vec::new());
        for value in listed.array()? {
            let (case, of_case) = value.table()?.read(|table| case(table, &base))?;
            let scenario = base.clone().with_faults(case.faults.clone());
            // Before anything is simulated.
            if let Err(error) = stages(&scenario) {
                let key = format!("{}.{}", value.path(), error.key);
                return Err(error.with_key(key).at_line(Some(value.line())));
            }
            cases.push(case);
            files.push(of_case);
        }
        check_cases(&listed, &cases)?;
        let Tune { indicators, bounds, keys, candidates, seed } = root.table_or_empty("tune")?.read(tune)?;
        let wanted = Wanted {
            cases: &cases,
            files: &files,
            indicators: &indicators,
            chain: &chain,
            base: &base,
            train,
            wheel,
        };
        let measured = root.table_or_empty("measured")?.read(|table| measured::read(table, &wanted, self))?;
        let experiment = Experiment { base, cases, chain, measured, bounds, keys, candidates, seed };
        for number in 0..experiment.keys.len() {
            experiment.check_key(number).map_err(|error| key_error(number, &error, &experiment.base))?;
        }
        experiment.check().map_err(|error| TomlError::new("tune", "", error.to_string()))?;
        Ok(experiment)
    }

    fn scenario(&mut self, root: &TomlTable<'_>) -> ReadResult<Scenario> {
        let named = root.required("scenario", "the scenario file that all cases have in common")?;
        let mut error = match ScenarioFile::read(&self.directory().join(named.string()?)) {
            Ok(file) => {
                self.sources.extend(file.sources().map(Path::to_path_buf));
                return Ok(file.scenario);
            }
            Err(error) => error,
        };
        let problem = named.error(error.to_string());
        if let ReadScenarioError::Invalid { error: inner, .. } = &mut error {
            let named_by = format!("{} names this file in line {}", self.path.display(), named.line());
            inner.help = Some(match inner.help.take() {
                Some(help) => format!("{help} ({named_by})"),
                None => named_by,
            });
            self.scenario_error = Some(error);
            return Err(problem);
        }
        Err(problem.with_help("check the name; it is relative to the experiment file's directory"))
    }
}

/// An error about a tuned key, which is reported at its own line.
fn key_error(number: usize, error: &HybridError, base: &Scenario) -> TomlError {
    let located = TomlError::new(format!("tune.key[{number}].key"), "", error.to_string());
    let help = match error {
        HybridError::Simulation(error) => error.help().map(str::to_owned),
        HybridError::NoSuchKey { key } => {
            let known = base.settable_numbers();
            let nearest = nearest_name(key, known.iter().map(|number| number.key.as_str()));
            nearest.map(|nearest| format!("did you mean `{nearest}`?"))
        }
        _ => None,
    };
    help.into_iter().fold(located, TomlError::with_help)
}

fn check_cases(listed: &TomlValue<'_>, cases: &[Case]) -> ReadResult<()> {
    if cases.len() < 2 {
        return Err(listed.error(format!("{} case; must be two or more, the healthy one first", cases.len())));
    }
    for (number, case) in cases.iter().enumerate() {
        if case.faults.is_empty() != (number == 0) {
            let error = HybridError::HealthyCase { case: number, label: case.label.clone() };
            return Err(listed.array()?[number].error(error.to_string()));
        }
        if let Some(other) = cases[..number].iter().position(|other| other.severity == case.severity) {
            let problem =
                format!("has the severity {} of case {other}; each must have its own", case.severity);
            return Err(listed.array()?[number].error(problem));
        }
    }
    Ok(())
}

fn case<'a>(table: &TomlTable<'a>, base: &Scenario) -> ReadResult<(Case, CaseFiles<'a>)> {
    let label = table.required("label", "the case's name")?.string()?.to_owned();
    let severity =
        table.required("severity", "the severity of the fault, 0 for the healthy case")?.number()?;
    let faults = match base.rig() {
        Some(_) => Fault::list_from_table(table)?,
        None => {
            let named = table.tables("fault")?.into_iter().map(|table| table.read(Fault::on_named_wheel));
            named.collect::<ReadResult<_>>()?
        }
    };
    Ok((Case { label, severity, faults }, CaseFiles::read(table)?))
}

/// Reads how difference signals are taken. The sampling rate must lie between twice the mesh frequency and the simulation's rate:
/// below, the mesh is not in the signals, and above, the simulations hold nothing to compare with.
fn signal(table: &TomlTable<'_>, base: &Scenario, train: &GearTrain) -> ReadResult<(DifferenceChain, usize)> {
    let channel = table.read_optional("channel", |value| read_channel(value, &accelerations(base)))?;
    let wheel = averaged_wheel(table, base, train)?;
    let TrainWheel { teeth, shaft, .. } = train.wheels[wheel];
    let rate = table.required("sampling_rate_hz", "(S/s) the sampling rate of the rig's recordings")?;
    let sampling_rate_hz = rate.number()?;
    let mesh_order = train.speed_ratio(shaft, train.input()).times(i64::from(teeth), 1);
    let mesh_hz = base.operation.pinion_speed_hz * mesh_order.value();
    if sampling_rate_hz <= 2.0 * mesh_hz {
        let problem = format!("must be more than twice the mesh frequency of {mesh_hz} Hz");
        let error = rate.error(problem);
        if !(sampling_rate_hz > 0.0 && sampling_rate_hz <= MOST_KILOHERTZ) {
            return Err(error);
        }
        let hertz = 1e3 * sampling_rate_hz;
        return Err(error.with_help(format!("in samples a second: {sampling_rate_hz} kHz are {hertz}")));
    }
    let simulated_hz = stages(base).map_err(|error| rate.error(error.to_string()))?.time.sampling_rate_hz;
    if sampling_rate_hz > simulated_hz * (1.0 + RATE_TOLERANCE) {
        let problem = format!(
            "must be at most the simulation's sampling rate of {simulated_hz:.1} S/s, since what is above half of that is not in the simulated signals"
        );
        let help = "raise solver.sampling_rate_hz in the scenario, or resample the recordings";
        return Err(rate.error(problem).with_help(help));
    }
    // The meshes of all wheels on a shaft are taken away from the average over its revolutions.
    let fewest = u64::from(train.teeth_on(shaft).min().unwrap_or(teeth));
    let default = SeparationSettings::new(teeth as usize);
    let count = |key, most: u64| table.read_optional(key, |value| value.integer(0..=most));
    let sidebands = count("sidebands", fewest.saturating_sub(2) / 2)?;
    let orders = count("shaft_orders", fewest - 1)?;
    let separation = SeparationSettings {
        sidebands: sidebands.map_or(default.sidebands, |count| count as usize),
        shaft_orders: orders
            .map_or_else(|| default.shaft_orders.clone(), |last| (1..=last as usize).collect()),
        mean: MeanPart::Removed,
        ..default
    };
    let chain = DifferenceChain {
        channel: channel.unwrap_or_else(|| Channel::leading(&base.all_sensors())),
        sampling_rate_hz,
        wheel: train.wheels[wheel].name.clone(),
        separation: Some(separation),
    };
    Ok((chain, wheel))
}

/// The number of the wheel over whose revolutions is averaged: by default the gear of a pair.
fn averaged_wheel(table: &TomlTable<'_>, base: &Scenario, train: &GearTrain) -> ReadResult<usize> {
    let names: Vec<(&str, usize)> =
        train.wheels.iter().enumerate().map(|(number, wheel)| (wheel.name.as_str(), number)).collect();
    if base.rig().is_some() && table.optional("wheel").is_none() {
        return Ok(WheelName::default() as usize);
    }
    table.required("wheel", "the wheel over whose revolutions the signals are averaged")?.choice(&names)
}

struct Tune {
    indicators: Vec<TuningIndicator>,
    bounds: EnhancementBounds,
    keys: Vec<TunedKey>,
    candidates: usize,
    seed: u64,
}

/// Reads what is tuned: the indicators that are compared, the bounds of the enhancement, and keys of the scenario with their ranges.
/// Each key that is absent takes its default.
fn tune(table: &TomlTable<'_>) -> ReadResult<Tune> {
    let indicators = match table.optional("indicators") {
        None => vec![TuningIndicator::Rms, TuningIndicator::Kurtosis],
        Some(value) => {
            let chosen = value
                .array()?
                .iter()
                .map(|value| value.choice(&TuningIndicator::NAMES))
                .collect::<ReadResult<Vec<_>>>()?;
            if chosen.is_empty() {
                return Err(value.error("names no indicator; must name one or more"));
            }
            if let Some(twice) = (1..chosen.len()).find(|&n| chosen[..n].contains(&chosen[n])) {
                return Err(value.error(format!("names {} twice", chosen[twice].name())));
            }
            chosen
        }
    };
    let range = |key, default: [f64; 2]| -> ReadResult<[f64; 2]> {
        let Some(value) = table.optional(key) else { return Ok(default) };
        let [least, largest] = if value.is_array() { value.exactly()? } else { [value.number()?; 2] };
        if !(least > 0.0 && least <= largest) {
            return Err(value.error("must be [least, largest], both above 0, or one number to hold it there"));
        }
        Ok([least, largest])
    };
    let default = EnhancementBounds::default();
    let bounds = EnhancementBounds {
        width_ratio: range("width_ratio", default.width_ratio)?,
        fault_to_harmonics_ratio: range("fault_to_harmonics_ratio", default.fault_to_harmonics_ratio)?,
        noise_level: range("noise_level", default.noise_level)?,
    };
    let key = |value: &TomlValue<'_>| {
        let key = value.table()?.read(tuned_key)?;
        key.check().map_err(|error| value.error(error.to_string()))?;
        Ok(key)
    };
    let keys = table.read_optional("key", |value| value.array()?.iter().map(key).collect())?;
    let candidates = table.read_optional("candidates", |value| value.integer(1..=MOST_CANDIDATES as u64))?;
    let seed = table.read_optional("seed", |value| value.integer(0..=u64::MAX))?;
    Ok(Tune {
        indicators,
        bounds,
        keys: keys.unwrap_or_default(),
        candidates: candidates.unwrap_or(CANDIDATES) as usize,
        seed: seed.unwrap_or(1),
    })
}

fn tuned_key(table: &TomlTable<'_>) -> ReadResult<TunedKey> {
    let key = table.required("key", "the dotted key of a number of the scenario file")?.string()?.to_owned();
    let one_of = table.optional("one_of");
    let ends = ["least", "largest"].map(|end| table.optional(end));
    let logarithmic = table.read_optional("logarithmic", TomlValue::boolean)?;
    // An unknown key is reported before a missing one.
    table.refuse_unknown(&[])?;
    let range = match (one_of, ends) {
        (Some(values), [None, None]) if logarithmic.is_none() => KeyRange::OneOf(values.numbers()?),
        (None, [Some(least), Some(largest)]) => KeyRange::Between {
            least: least.number()?,
            largest: largest.number()?,
            logarithmic: logarithmic.unwrap_or(false),
        },
        _ => {
            let problem = "needs either one_of = [values], or least and largest (and logarithmic = true for equal ratios)";
            return Err(table.error("key", problem));
        }
    };
    Ok(TunedKey { key, range })
}
