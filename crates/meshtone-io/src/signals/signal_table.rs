//! What a file of signals holds.

use std::borrow::Cow;
use std::io::{self, Seek, Write};

use meshtone::scenario::{Gearbox, Scenario};
use meshtone::sensor::{Channel, Channels};
use meshtone::{GearboxChannels, GearboxSignal};

use super::format::{SignalFormat, csv, mat, npz, parquet, wav};
use super::{GEARBOX_KEY, SCENARIO_KEY};

/// The signals of a simulation, with what a file says of them.
#[derive(Debug, Clone)]
pub struct SignalTable<'a> {
    /// The metadata key and the TOML of what was simulated.
    pub(super) scenario: Option<(&'static str, String)>,
    /// (S/s)
    pub(super) sampling_rate_hz: f64,
    /// (s) Time of the first sample.
    pub(super) start_s: f64,
    pub(super) columns: Vec<SignalColumn<'a>>,
}

/// A column of signals.
#[derive(Debug, Clone)]
pub(super) struct SignalColumn<'a> {
    pub name: Cow<'a, str>,
    pub unit: &'a str,
    pub meaning: &'a str,
    pub values: &'a [f64],
}

impl<'a> SignalTable<'a> {
    /// The signals of a pair: the sensors in their order, and the channels that every simulation has.
    ///
    /// # Arguments
    /// * `scenario` - what was simulated
    /// * `channels` - the signals
    pub fn of_pair(scenario: &Scenario, channels: &'a Channels) -> Self {
        let listed = channels.list().into_iter();
        let signals: Vec<_> =
            listed.filter_map(|channel| Some((channels.signal(&channel)?, channel))).collect();
        let named = signals.into_iter().map(|(values, channel)| (channel, values));
        Self::of_equally_long(Some(scenario), [channels.sampling_rate_hz, channels.start_s], named)
    }

    /// Some signals of a pair, at any rate.
    ///
    /// # Arguments
    /// * `scenario` - what was simulated; none where the signals are not what a simulation of it gives
    /// * `rate_and_start` - (S/s, s) sampling rate, and time of the first sample
    /// * `signals` - the channels and their samples
    ///
    /// # Errors
    /// Two channels of different lengths.
    pub fn of_channels(
        scenario: Option<&Scenario>,
        rate_and_start: [f64; 2],
        signals: impl IntoIterator<Item = (Channel, &'a [f64])>,
    ) -> io::Result<Self> {
        let columns: Vec<(Channel, &[f64])> = signals.into_iter().collect();
        let unequal = columns.windows(2).find(|pair| pair[0].1.len() != pair[1].1.len());
        if let Some(pair) = unequal {
            let of =
                |(channel, values): &(Channel, &[f64])| format!("{} has {}", channel.name(), values.len());
            let problem = format!("signals must be equally long: {} samples, {}", of(&pair[0]), of(&pair[1]));
            return Err(io::Error::new(io::ErrorKind::InvalidInput, problem));
        }
        Ok(Self::of_equally_long(scenario, rate_and_start, columns))
    }

    fn of_equally_long(
        scenario: Option<&Scenario>,
        [sampling_rate_hz, start_s]: [f64; 2],
        signals: impl IntoIterator<Item = (Channel, &'a [f64])>,
    ) -> Self {
        let column = |(channel, values): (Channel, &'a [f64])| SignalColumn {
            name: channel.name(),
            unit: channel.unit(),
            meaning: channel.meaning(),
            values,
        };
        Self {
            scenario: scenario.map(|scenario| (SCENARIO_KEY, scenario.to_toml())),
            sampling_rate_hz,
            start_s,
            columns: signals.into_iter().map(column).collect(),
        }
    }

    /// The signals of a gearbox.
    ///
    /// # Arguments
    /// * `gearbox` - what was simulated
    /// * `channels` - the signals
    pub fn of_gearbox(gearbox: &Gearbox, channels: &'a GearboxChannels) -> Self {
        let column = |signal: &'a GearboxSignal| SignalColumn {
            name: (&signal.name).into(),
            unit: signal.unit,
            meaning: match signal.unit {
                "N" => "force along the line of action of the mesh; negative where coast flanks touch",
                "µm" => {
                    "how far the wheels of the mesh have turned against one another, along the line of action"
                }
                "Hz" => "revolutions of the shaft per second",
                _ => "what the sensor shows, over 9.81 m/s²",
            },
            values: &signal.values,
        };
        Self {
            scenario: Some((GEARBOX_KEY, gearbox.to_toml())),
            sampling_rate_hz: channels.sampling_rate_hz,
            start_s: channels.start_s,
            columns: channels.signals.iter().map(column).collect(),
        }
    }

    /// Writes the signals.
    ///
    /// # Arguments
    /// * `to` - where the file is written to; it needs no buffer
    /// * `format` - of the file
    ///
    /// # Errors
    /// Those of `to`; more samples than the format can hold.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    /// use meshtone_io::recording::{RecordingOptions, read_recording};
    /// use meshtone_io::signals::{SignalFormat, SignalTable};
    ///
    /// let simulation = meshtone::simulate(&Scenario::new(GearPair::example()))?;
    /// let table = SignalTable::of_pair(&simulation.stages.scenario, &simulation.channels);
    /// let directory = tempfile::tempdir()?;
    /// let path = directory.path().join("signals.mat");
    /// table.write(std::fs::File::create(&path)?, SignalFormat::Mat)?;
    ///
    /// let recording = read_recording(&path, &RecordingOptions::default())?;
    /// assert_eq!(recording.sampling_rate_hz, simulation.channels.sampling_rate_hz);
    /// assert_eq!(recording.channels[1].samples, simulation.channels.vertical_g);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn write(&self, to: impl Write + Seek + Send, format: SignalFormat) -> io::Result<()> {
        match format {
            SignalFormat::Parquet => self.write_parquet(to),
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
    /// Those of `to`.
    pub fn write_parquet(&self, to: impl Write + Send) -> io::Result<()> {
        parquet::write(self, to)
    }

    /// Samples of each signal.
    pub(super) fn samples(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }

    /// (s) Time of a sample.
    pub(super) fn time_s(&self, sample: usize) -> f64 {
        self.start_s + sample as f64 / self.sampling_rate_hz
    }

    /// (s) Times of all samples.
    pub(super) fn times_s(&self) -> Vec<f64> {
        (0..self.samples()).map(|sample| self.time_s(sample)).collect()
    }
}
