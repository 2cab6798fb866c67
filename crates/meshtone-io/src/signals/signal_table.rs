//! What a file of signals holds.

use std::io::{self, Seek, Write};

use meshtone::scenario::Scenario;
use meshtone::sensor::{Channels, NamedSignal};

use super::format::{SignalFormat, csv, mat, npz, parquet, wav};
use super::{GEARBOX_KEY, SCENARIO_KEY};

/// The signals of a simulation, with what a file says of them.
#[derive(Debug, Clone)]
pub struct SignalTable<'a> {
    /// The metadata key and the TOML of what was simulated.
    pub(super) scenario: Option<(&'static str, String)>,
    pub(super) channels: &'a Channels,
}

impl<'a> SignalTable<'a> {
    /// The signals of a scenario.
    ///
    /// # Arguments
    /// * `scenario` - what was simulated
    /// * `channels` - the signals
    pub fn of_scenario(scenario: impl Into<Scenario>, channels: &'a Channels) -> Self {
        let scenario = scenario.into();
        let key = if scenario.rig().is_none() { GEARBOX_KEY } else { SCENARIO_KEY };
        Self { scenario: Some((key, scenario.to_toml())), channels }
    }

    /// Signals that are not what a simulation of a scenario gives.
    ///
    /// # Arguments
    /// * `channels` - the signals
    pub fn without_scenario(channels: &'a Channels) -> Self {
        Self { scenario: None, channels }
    }

    /// Writes the signals.
    ///
    /// # Arguments
    /// * `to` - where the file is written to; it needs no buffer
    /// * `format` - of the file
    ///
    /// # Errors
    /// Those of `to`; more samples than the format can hold; signals of different lengths.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    /// use meshtone_io::recording::{RecordingOptions, read_recording};
    /// use meshtone_io::signals::{SignalFormat, SignalTable};
    ///
    /// let simulation = meshtone::simulate(&Scenario::new(GearPair::example()))?;
    /// let table = SignalTable::of_scenario(&simulation.stages.scenario, &simulation.channels);
    /// let directory = tempfile::tempdir()?;
    /// let path = directory.path().join("signals.mat");
    /// table.write(std::fs::File::create(&path)?, SignalFormat::Mat)?;
    ///
    /// let recording = read_recording(&path, &RecordingOptions::default())?;
    /// assert_eq!(recording.sampling_rate_hz, simulation.channels.sampling_rate_hz);
    /// assert_eq!(recording.channels[1].samples, simulation.channels["vertical_g"]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn write(&self, to: impl Write + Seek + Send, format: SignalFormat) -> io::Result<()> {
        self.check_lengths()?;
        match format {
            SignalFormat::Parquet => parquet::write(self, to),
            SignalFormat::Csv => csv::write(self, to),
            SignalFormat::Mat => mat::write(self, to),
            SignalFormat::Npz => npz::write(self, to),
            SignalFormat::Wav => wav::write(self, to),
        }
    }

    /// Writes the signals as Parquet to anything, also to what has no places to go back to.
    ///
    /// # Arguments
    /// * `to` - where the file is written to; it needs no buffer
    ///
    /// # Errors
    /// Those of `to`; signals of different lengths.
    pub fn write_parquet(&self, to: impl Write + Send) -> io::Result<()> {
        self.check_lengths()?;
        parquet::write(self, to)
    }

    /// Checks that all signals have as many samples as the first.
    ///
    /// # Errors
    /// Two signals of different lengths.
    pub fn check_lengths(&self) -> io::Result<()> {
        let signals = &self.channels.signals;
        let unequal = signals.windows(2).find(|pair| pair[0].values.len() != pair[1].values.len());
        unequal.map_or(Ok(()), |pair| {
            let of = |signal: &NamedSignal| format!("{} has {}", signal.name, signal.values.len());
            let problem = format!("signals must be equally long: {} samples, {}", of(&pair[0]), of(&pair[1]));
            Err(io::Error::new(io::ErrorKind::InvalidInput, problem))
        })
    }

    /// (s) Times of all samples.
    pub(super) fn times_s(&self) -> Vec<f64> {
        (0..self.channels.len()).map(|sample| self.channels.time_s(sample)).collect()
    }
}
