//! What tuning found, in a form that other commands use.

use std::fmt::Write as _;
use std::path::Path;

use meshtone::scenario::{Model, Scenario, ScenarioError, WheelName};
use meshtone::sensor::{Channel, ChannelKind};
use meshtone::signal::{MeanPart, SeparationSettings};
use meshtone::tuning::{DifferenceChain, Enhancement, Experiment, ExperimentResult};
use meshtone_toml::{ReadResult, TomlDocument, TomlTable, TomlValue};

use crate::channel_name::read_any_acceleration;
use crate::scenario_file::{FileKind, ReadScenarioError, read_text};

/// What tuning found.
#[derive(Debug, Clone, PartialEq)]
pub struct Tuned {
    /// Reading of the model that was tuned: under another one the same numbers mean something else.
    pub model: Model,
    /// The three parameters.
    pub enhancement: Enhancement,
    /// (rev) Where the faults' responses are in the wheel's cycle, for signals that show none.
    pub centre_rev: f64,
    /// (-) Channel, rate and separation of the difference signals.
    pub channel: Channel,
    /// (S/s) The rig's sampling rate.
    pub sampling_rate_hz: f64,
    /// Name of the wheel over whose revolutions they are averaged.
    pub wheel: String,
    /// Sidebands that are taken away.
    pub sidebands: usize,
    /// The last of the shaft orders that are taken away.
    pub shaft_orders: usize,
    /// Numbers of the scenario that were tuned as well: key and value.
    pub keys: Vec<(String, f64)>,
}

impl Tuned {
    /// What an experiment found.
    ///
    /// # Arguments
    /// * `experiment`, `result` - as of [`meshtone::tuning::run_experiment`]
    pub fn of(experiment: &Experiment, result: &ExperimentResult) -> Self {
        let values = result.with_keys.as_ref().map_or(&[][..], |keys| &keys.values);
        let separation = experiment.chain.separation.clone().unwrap_or_else(|| SeparationSettings::new(1));
        Self {
            model: experiment.base.model,
            enhancement: result.tuning().enhancement,
            centre_rev: result.simulated().centre_rev(),
            channel: experiment.chain.channel.clone(),
            sampling_rate_hz: experiment.chain.sampling_rate_hz,
            wheel: experiment.chain.wheel.clone(),
            sidebands: separation.sidebands,
            shaft_orders: separation.shaft_orders.len(),
            keys: experiment.keys.iter().map(|key| key.key.clone()).zip(values.iter().copied()).collect(),
        }
    }

    /// A scenario with the tuned numbers; those of another fault's keys are left out.
    ///
    /// # Arguments
    /// * `scenario` - to be changed
    ///
    /// # Errors
    /// A number that is not allowed in this scenario.
    pub fn apply(&self, scenario: &Scenario) -> Result<Scenario, ScenarioError> {
        let numbers: Vec<(&str, f64)> = self.keys.iter().map(|(key, value)| (key.as_str(), *value)).collect();
        scenario.with_known_numbers(&numbers)
    }

    /// What a user should know before these values are used for a scenario.
    ///
    /// # Arguments
    /// * `scenario` - that they are used for
    pub fn warning_for(&self, scenario: &Scenario) -> Option<String> {
        if scenario.model != self.model {
            return Some(format!(
                "was tuned with model = \"{}\", but the scenario has \"{}\": the same numbers have another meaning there",
                self.model.name(),
                scenario.model.name()
            ));
        }
        // Those of a fault are of the scenarios that have it.
        let of_machine: Vec<&str> =
            self.keys.iter().map(|(key, _)| key.as_str()).filter(|key| !key.starts_with("fault")).collect();
        let is_other = !of_machine.is_empty() && of_machine.iter().all(|key| scenario.number(key).is_none());
        is_other.then(|| {
            format!("is of another machine: the scenario has none of its numbers ({})", of_machine.join(", "))
        })
    }

    /// How difference signals are taken.
    pub fn chain(&self) -> DifferenceChain {
        let separation = SeparationSettings {
            sidebands: self.sidebands,
            shaft_orders: (1..=self.shaft_orders).collect(),
            // A sensor's offset is no vibration.
            mean: MeanPart::Removed,
            ..SeparationSettings::new(1)
        };
        DifferenceChain {
            channel: self.channel.clone(),
            sampling_rate_hz: self.sampling_rate_hz,
            wheel: self.wheel.clone(),
            separation: Some(separation),
        }
    }
}

/// The text of a `tuned.toml`.
///
/// # Arguments
/// * `tuned` - what was found
/// * `from` - the experiment, which a comment of the file names
///
/// ```
/// use meshtone::sensor::ChannelKind;
/// use meshtone::tuning::Enhancement;
/// use meshtone::scenario::Model;
/// use meshtone_io::experiment::{Tuned, read_tuned, write_tuned};
///
/// let tuned = Tuned {
///     model: Model::Published,
///     enhancement: Enhancement { width_ratio: 0.18, fault_to_harmonics_ratio: 2.25, noise_level: 1.585 },
///     centre_rev: 0.03,
///     channel: ChannelKind::Vertical.into(),
///     sampling_rate_hz: 25e3,
///     wheel: "pinion".into(),
///     sidebands: 2,
///     shaft_orders: 7,
///     keys: vec![("rig.damping_ratio".into(), 0.034)],
/// };
/// let directory = tempfile::tempdir()?;
/// let path = directory.path().join("tuned.toml");
/// std::fs::write(&path, write_tuned(&tuned, "breakage.toml"))?;
/// assert_eq!(read_tuned(&path)?, tuned);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_tuned(tuned: &Tuned, from: &str) -> String {
    let Enhancement { width_ratio, fault_to_harmonics_ratio, noise_level } = tuned.enhancement;
    let channel = tuned.channel.name();
    let mut text = format!(
        "# Written by `meshtone tune` from {}.\n\
         model = \"{}\"            # of the simulations that were tuned\n\n\
         [enhancement]                 # of difference signals, in this order\n\
         width_ratio = {width_ratio:?}\n\
         fault_to_harmonics_ratio = {fault_to_harmonics_ratio:?}\n\
         noise_level = {noise_level:?}            # times the rms of the healthy signal\n\
         centre_rev = {:?}             # where a fault shows in the wheel's cycle\n\n\
         [signal]                      # how they are taken from a simulation\n\
         channel = \"{channel}\"\n\
         sampling_rate_hz = {:?}\n\
         wheel = \"{}\"                # over whose revolutions they are averaged\n\
         sidebands = {}\n\
         shaft_orders = {}\n",
        from.replace(char::is_control, " "),
        tuned.model.name(),
        tuned.centre_rev,
        tuned.sampling_rate_hz,
        tuned.wheel,
        tuned.sidebands,
        tuned.shaft_orders
    );
    for (key, value) in &tuned.keys {
        // Writing to a text cannot fail.
        let _ = write!(
            text,
            "\n[[key]]                       # of the scenario file\nkey = {key:?}\nvalue = {value:?}\n"
        );
    }
    text
}

/// Reads a `tuned.toml`.
///
/// # Arguments
/// * `path` - the file
///
/// # Errors
/// It cannot be read; an unknown or missing key, a value that is not allowed, with its line.
pub fn read_tuned(path: &Path) -> Result<Tuned, ReadScenarioError> {
    let text = read_text(path)?;
    let read = TomlDocument::parse(&text)
        .and_then(|document| document.root().read(tuned).map_err(|error| document.locate(error)));
    read.map_err(|error| ReadScenarioError::invalid(FileKind::Tuned, path.to_path_buf(), text, error))
}

/// Reads the content of the file.
///
/// Every value is checked where it is read, so that an error names its key and line. What a user may leave out in a file written by hand
/// takes the defaults of an experiment.
fn tuned(root: &TomlTable<'_>) -> ReadResult<Tuned> {
    let models = Model::ALL.map(|model| (model.name(), model));
    let model = root.read_optional("model", |value| value.choice(&models))?;
    let (enhancement, centre_rev) = root.table_or_empty("enhancement")?.read(|table| {
        let above_0 = |key, meaning: &str| {
            let value = table.required(key, meaning)?;
            let number = value.number()?;
            if number > 0.0 { Ok(number) } else { Err(value.error("must be more than 0")) }
        };
        let noise = table.required("noise_level", "the ratio of the noise to the healthy signal's rms")?;
        let noise_level = noise.number()?;
        if noise_level < 0.0 {
            return Err(noise.error("must be 0 or more"));
        }
        let ratio = table.required("fault_to_harmonics_ratio", "the weight of the fault's response")?;
        let enhancement = Enhancement {
            width_ratio: above_0("width_ratio", "the fraction of the cycle that is stretched to the cycle")?,
            fault_to_harmonics_ratio: ratio.number()?,
            noise_level,
        };
        Ok((enhancement, table.number("centre_rev")?.unwrap_or(0.0)))
    })?;
    let keys =
        root.read_optional("key", |value| value.array()?.iter().map(key).collect())?.unwrap_or_default();
    root.table_or_empty("signal")?.read(|table| {
        let channel = table.read_optional("channel", read_any_acceleration)?;
        let rate = table.required("sampling_rate_hz", "(S/s) the rig's sampling rate")?;
        let sampling_rate_hz = rate.number()?;
        if sampling_rate_hz <= 0.0 {
            return Err(rate.error("must be more than 0"));
        }
        let count = |key, default: usize| -> ReadResult<usize> {
            let given = table.read_optional(key, |value| value.integer(0..=10_000))?;
            Ok(given.map_or(default, |count| count as usize))
        };
        Ok(Tuned {
            model: model.unwrap_or(Model::Linear),
            enhancement,
            centre_rev,
            channel: channel.unwrap_or(ChannelKind::Vertical.into()),
            sampling_rate_hz,
            wheel: table
                .read_optional("wheel", |value| value.string().map(str::to_owned))?
                .unwrap_or_else(|| WheelName::default().into()),
            sidebands: count("sidebands", 2)?,
            shaft_orders: count("shaft_orders", 7)?,
            keys,
        })
    })
}

fn key(value: &TomlValue<'_>) -> ReadResult<(String, f64)> {
    value.table()?.read(|table| {
        let key =
            table.required("key", "the dotted key of a number of the scenario file")?.string()?.to_owned();
        Ok((key, table.required("value", "the number")?.number()?))
    })
}
