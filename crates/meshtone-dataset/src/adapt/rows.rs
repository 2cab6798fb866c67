//! Records of a data set as rows of numbers, each beside healthy records of its unit.

use std::fs::File;
use std::io;

use bytes::Bytes;
use meshtone::signal::{
    DefectKind, FrequencyBand, GearTrain, cepstral_prewhitening, defect_lines, squared_envelope_spectrum,
};
use meshtone_io::table::TableReader;
use meshtone_learn::median;
use parquet::errors::ParquetError;
use parquet::file::reader::ChunkReader;
use rayon::prelude::*;

use super::detector::HEALTHY;
use crate::error::DatasetError;
use crate::plan::Plan;
use crate::shard::{FOLDER, Topic, columns};
use crate::store::Destination;

/// (Hz) Bands in which the lines of bearings are looked for: somewhere in the structure rings at each strike.
const BANDS_HZ: [[f64; 2]; 3] = [[500.0, 3000.0], [3000.0, 6000.0], [6000.0, 10_000.0]];
/// (-) Part of the sampling rate up to which signals are right.
const PASSED: f64 = 0.4;
/// Indicators span decades, and some may be negative: small ones are taken as they are, large ones by their logarithm.
const LINEAR_TO: f64 = 0.01;

/// Logarithms of the lines of each race of the rolling bearings over the medians beside them, the mean of the harmonics, in each band; NaN of a
/// signal without an envelope. The signal is whitened, or the lines of the meshes would hide those of all but large spalls.
///
/// # Arguments
/// * `samples`, `rate_hz` - the signal
/// * `train` - its bearings
/// * `input_hz` - speed of the input
fn bearing_lines(samples: &[f64], rate_hz: f64, train: &GearTrain, input_hz: f64) -> Vec<f64> {
    let mut found = Vec::new();
    let white = cepstral_prewhitening(samples).unwrap_or_default();
    for [from_hz, to_hz] in BANDS_HZ.into_iter().filter(|[_, to_hz]| *to_hz <= PASSED * rate_hz) {
        let spectrum = squared_envelope_spectrum(&white, rate_hz, Some(FrequencyBand { from_hz, to_hz }));
        for bearing in train.distinct_bearings() {
            let shaft_hz = input_hz * train.speed_ratio(bearing.shaft, train.input()).value();
            let lines = spectrum
                .as_ref()
                .map(|spectrum| defect_lines(spectrum, &bearing.geometry.defect_orders(), shaft_hz));
            let lines = lines.unwrap_or_default();
            for kind in [DefectKind::OuterRace, DefectKind::InnerRace, DefectKind::Element] {
                let of_kind = lines.iter().filter(|line| line.kind == kind).map(|line| line.over_median.ln());
                let of_kind: Vec<f64> = of_kind.collect();
                found.push(of_kind.iter().sum::<f64>() / of_kind.len() as f64);
            }
        }
    }
    found
}

/// Records in the columns that a recording has, too.
#[derive(Debug, Clone, Default)]
pub(super) struct Rows {
    /// Indicators of each, NaN where it has no value.
    pub values: Vec<Vec<f64>>,
    /// (Hz) Speed of the input of each.
    pub speed_hz: Vec<f64>,
    /// The label of each; none of recordings.
    pub labels: Vec<Option<String>>,
    /// The unit of each, of recordings the recording.
    pub units: Vec<u64>,
}

impl Rows {
    /// Those of a whole data set in a directory.
    ///
    /// # Arguments
    /// * `plan` - of the data set
    /// * `set` - its directory
    pub fn of_set(plan: &Plan, set: &Destination) -> Result<Self, DatasetError> {
        let mut rows = Self::default();
        for name in set.files()?.keys().filter(|name| name.starts_with(FOLDER)) {
            let file = set.path().map(|path| File::open(path.join(name)));
            let file = file.unwrap_or_else(|| Err(io::ErrorKind::Unsupported.into()));
            let file = file.map_err(DatasetError::read(name.clone()))?;
            rows.add(plan, file)
                .map_err(|error| DatasetError::read(name.clone())(io::Error::other(error)))?;
        }
        Ok(rows)
    }

    /// Those of recordings, from [`rows_like`](crate::rows_like).
    ///
    /// # Arguments
    /// * `plan` - of the data set
    /// * `parquet` - the table
    pub fn of_recordings(plan: &Plan, parquet: Vec<u8>) -> Result<Self, DatasetError> {
        let mut rows = Self::default();
        let added = rows.add(plan, Bytes::from(parquet));
        added.map_err(|error| DatasetError::read("the table of recordings")(io::Error::other(error)))?;
        Ok(rows)
    }

    fn add<R: ChunkReader + 'static>(&mut self, plan: &Plan, file: R) -> Result<(), ParquetError> {
        let table = TableReader::new(file)?;
        let numbers = |name: &str| match table.column(name) {
            Some(column) => Ok(table.numbers(column, 0)?.values),
            None => Err(ParquetError::General(format!("there is no column {name}"))),
        };
        let units = numbers("unit")?;
        let speed = if plan.content.base.rig().is_some() { "pinion_speed_hz" } else { "input_speed_hz" };
        self.speed_hz.extend(numbers(speed)?);
        let indicators = columns(plan).into_iter().filter(|of| matches!(of.topic, Topic::Indicator { .. }));
        let indicators = indicators.map(|of| numbers(&of.name)).collect::<Result<Vec<_>, _>>()?;
        let scaled = |value: f64| (value / LINEAR_TO).asinh();
        let first = self.len();
        let row = |row: usize| indicators.iter().map(|column| scaled(column[row])).collect();
        self.values.extend((0..units.len()).map(row));
        let train = GearTrain::of_scenario(&plan.content.base);
        let train = train.map_err(|error| ParquetError::General(error.to_string()))?;
        let channel = table.column(&plan.content.keep.analysed.name());
        if let Some(channel) = channel.filter(|_| !train.bearings.is_empty()) {
            let rate_hz = plan.content.keep.sampling_rate_hz;
            let mut row = first;
            for group in 0..table.groups() {
                let samples = table.lists(channel, group)?;
                let (values, speeds) = (&mut self.values[row..], &self.speed_hz[row..]);
                let all = values.par_iter_mut().zip(speeds).zip(&samples);
                all.for_each(|((values, speed_hz), samples)| {
                    values.extend(bearing_lines(samples, rate_hz, &train, *speed_hz));
                });
                row += samples.len();
            }
        }
        match table.column("label") {
            Some(column) => self.labels.extend(table.texts(column)?),
            None => self.labels.extend(units.iter().map(|_| None)),
        }
        self.units.extend(units.into_iter().map(|unit| unit as u64));
        Ok(())
    }

    /// (Hz) The least and the largest speed, with a margin (-).
    pub fn speeds_hz(&self, margin: f64) -> [f64; 2] {
        let all = || self.speed_hz.iter().copied();
        [all().fold(f64::INFINITY, f64::min) * (1.0 - margin), all().fold(0.0, f64::max) * (1.0 + margin)]
    }

    /// Number of records.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether a record's label says that it is healthy.
    pub fn is_healthy(&self, row: usize) -> bool {
        self.labels[row].as_deref() == Some(HEALTHY)
    }

    /// Those records that a condition chooses.
    pub fn filter(&self, is_chosen: impl Fn(usize) -> bool) -> Self {
        let chosen: Vec<usize> = (0..self.len()).filter(|&row| is_chosen(row)).collect();
        Self {
            values: chosen.iter().map(|&row| self.values[row].clone()).collect(),
            speed_hz: chosen.iter().map(|&row| self.speed_hz[row]).collect(),
            labels: chosen.iter().map(|&row| self.labels[row].clone()).collect(),
            units: chosen.iter().map(|&row| self.units[row]).collect(),
        }
    }

    /// These records, and behind them others.
    pub fn with(&self, others: &Self) -> Self {
        Self {
            values: [&self.values[..], &others.values].concat(),
            speed_hz: [&self.speed_hz[..], &others.speed_hz].concat(),
            labels: [&self.labels[..], &others.labels].concat(),
            units: [&self.units[..], &others.units].concat(),
        }
    }

    /// By how much each record's values exceed the medians of the healthy records of its unit, without itself.
    ///
    /// What they are themselves is the machine's own, which no simulation has as it is: beside it trees are wrong more often than without.
    ///
    /// # Arguments
    /// * `healthy` - whether a record is known to be healthy
    pub fn beside_healthy(&self, healthy: &dyn Fn(usize) -> bool) -> Vec<Vec<f64>> {
        let row = |row: usize| {
            let others =
                (0..self.len()).filter(|&of| of != row && self.units[of] == self.units[row] && healthy(of));
            let others: Vec<usize> = others.collect();
            let beyond = |(column, value): (usize, &f64)| {
                let known = others.iter().map(|&of| self.values[of][column]);
                value - median(&known.filter(|value| value.is_finite()).collect::<Vec<f64>>())
            };
            self.values[row].iter().enumerate().map(beyond).collect()
        };
        (0..self.len()).map(row).collect()
    }
}
