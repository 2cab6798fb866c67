//! Records as rows.

use meshtone_io::table::Cells;

use super::{BETWEEN_CODES, Column, ColumnKind, column_name};
use crate::plan::Content;
use crate::record::Record;

/// A record and its enhanced difference signal, if it has one.
pub(super) struct Row {
    pub record: Box<Record>,
    pub enhanced: Vec<f32>,
}

impl Row {
    /// (bytes) How large its signals are.
    pub fn bytes(&self) -> usize {
        let Record { channels, average, difference, .. } = &*self.record;
        let values = channels.iter().map(Vec::len).sum::<usize>() + average.len() + difference.len();
        4 * (values + self.enhanced.len())
    }
}

/// One column of some rows.
pub(super) fn cells<'r>(column: &Column, rows: &'r [Row], content: &Content) -> Cells<'r> {
    let names = content.splits.names();
    let whole = |value: &dyn Fn(&Record) -> u64| {
        Cells::Int64(rows.iter().map(|row| Some(value(&row.record) as i64)).collect())
    };
    let small = |value: &dyn Fn(&Record) -> Option<u32>| {
        Cells::Int32(rows.iter().map(|row| value(&row.record).map(|value| value as i32)).collect())
    };
    let text = |value: &dyn Fn(&Record) -> String| {
        Cells::Text(rows.iter().map(|row| Some(value(&row.record))).collect())
    };
    let text_or_null = |value: &dyn Fn(&Record) -> Option<&'static str>| {
        Cells::Text(rows.iter().map(|row| value(&row.record).map(str::to_string)).collect())
    };
    let number = |value: &dyn Fn(&Record) -> Option<f64>| {
        Cells::Float64(rows.iter().map(|row| value(&row.record)).collect())
    };
    let signal =
        |values: &dyn Fn(&'r Row) -> &'r [f32]| Cells::Float32List(rows.iter().map(values).collect());
    match &column.kind {
        ColumnKind::Record => whole(&|r| r.drawn.index),
        ColumnKind::Unit => whole(&|r| r.drawn.unit),
        ColumnKind::Mounting => whole(&|r| r.drawn.mounting),
        ColumnKind::Age => number(&|r| r.drawn.age.map(|age| age.age_rev)),
        ColumnKind::Remaining => number(&|r| r.drawn.age.map(|age| age.remaining_rev)),
        ColumnKind::Censored => small(&|r| r.drawn.age.map(|age| u32::from(age.is_censored))),
        ColumnKind::SimulatedTime => number(&|r| Some(r.simulated_s)),
        ColumnKind::PointsPerRevolution => {
            small(&|_| content.keep.over_angle.map(|angle| angle.points_per_revolution as u32))
        }
        ColumnKind::OctaveRms(octave) => number(&|r| r.octaves.get(*octave).map(|band| band.rms)),
        ColumnKind::OctaveKurtosis(octave) => {
            number(&|r| r.octaves.get(*octave).and_then(|band| band.kurtosis))
        }
        ColumnKind::Seed => whole(&|r| r.drawn.seed),
        ColumnKind::WheelsSeed => whole(&|r| r.drawn.wheels_seed),
        ColumnKind::Split => text(&|r| names[r.drawn.split].to_owned()),
        ColumnKind::Label => text(&|r| content.classes[r.drawn.class].label.clone()),
        ColumnKind::Severity => small(&|r| Some(u32::from(r.drawn.severity))),
        ColumnKind::SeverityMeasure => number(&|r| r.drawn.severity_measure),
        ColumnKind::FaultKind(number) => text_or_null(&|r| r.faults.get(*number).map(|fault| fault.kind)),
        ColumnKind::FaultWheel(number) => {
            text_or_null(&|r| r.faults.get(*number).map(|fault| fault.wheel.name()))
        }
        ColumnKind::FaultTooth(number) => small(&|r| r.faults.get(*number).and_then(|fault| fault.tooth)),
        ColumnKind::FaultSeverity(of_fault) => {
            number(&|r| r.faults.get(*of_fault).map(|fault| fault.severity))
        }
        ColumnKind::FaultArea(of_fault) => {
            number(&|r| r.faults.get(*of_fault).and_then(|fault| fault.area_percent))
        }
        ColumnKind::SamplingRate => number(&|r| Some(r.sampling_rate_hz)),
        ColumnKind::GearAngle => number(&|r| Some(r.gear_angle_rev)),
        ColumnKind::PinionTeeth => small(&|r| Some(r.teeth[0])),
        ColumnKind::GearTeeth => small(&|r| Some(r.teeth[1])),
        ColumnKind::PinionSpeed => number(&|r| Some(r.pinion_speed_hz)),
        ColumnKind::GearSpeed => {
            number(&|r| Some(r.pinion_speed_hz * f64::from(r.teeth[0]) / f64::from(r.teeth[1])))
        }
        ColumnKind::BrakeTorque => number(&|r| Some(r.brake_torque_nm)),
        ColumnKind::Warnings => {
            text(&|r| r.warnings.iter().map(|kind| kind.code()).collect::<Vec<_>>().join(BETWEEN_CODES))
        }
        ColumnKind::SlackFraction => number(&|r| Some(r.slack_fraction)),
        ColumnKind::Key(key) => {
            let name = column_name(key);
            let is_in_column = |other: &str| other == key || column_name(other) == name;
            number(&|r| {
                let drawn = r.drawn.values.iter().find(|(other, _)| is_in_column(other));
                drawn.map(|(_, value)| *value)
            })
        }
        ColumnKind::Indicator(name) => {
            number(&|r| r.indicators.iter().find(|value| value.name == *name).and_then(|value| value.value))
        }
        ColumnKind::Channel(channel) => signal(&|row| &row.record.channels[*channel]),
        ColumnKind::Average => signal(&|row| &row.record.average),
        ColumnKind::Difference => signal(&|row| &row.record.difference),
        ColumnKind::EnhancedDifference => signal(&|row| &row.enhanced),
    }
}
