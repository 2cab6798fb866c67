//! Records as rows.

use std::sync::Arc;

use arrow::array::{
    ArrayRef, Float32Builder, Float64Builder, Int32Builder, Int64Builder, ListBuilder, StringBuilder,
};
use arrow::datatypes::{DataType, Field};

use super::{Column, ColumnKind};
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
pub(super) fn array(column: &Column, rows: &[Row], content: &Content) -> ArrayRef {
    let names = content.splits.names();
    let whole = |value: &dyn Fn(&Record) -> u64| -> ArrayRef {
        let mut builder = Int64Builder::with_capacity(rows.len());
        rows.iter().for_each(|row| builder.append_value(value(&row.record) as i64));
        Arc::new(builder.finish())
    };
    let small = |value: &dyn Fn(&Record) -> Option<u32>| -> ArrayRef {
        let mut builder = Int32Builder::with_capacity(rows.len());
        rows.iter().for_each(|row| builder.append_option(value(&row.record).map(|value| value as i32)));
        Arc::new(builder.finish())
    };
    let text = |value: &dyn Fn(&Record) -> String| -> ArrayRef {
        let mut builder = StringBuilder::new();
        rows.iter().for_each(|row| builder.append_value(value(&row.record)));
        Arc::new(builder.finish())
    };
    let number = |value: &dyn Fn(&Record) -> Option<f64>| -> ArrayRef {
        let mut builder = Float64Builder::with_capacity(rows.len());
        rows.iter().for_each(|row| builder.append_option(value(&row.record)));
        Arc::new(builder.finish())
    };
    let signal = |values: &dyn Fn(&Row) -> &[f32]| -> ArrayRef {
        let item = Field::new("item", DataType::Float32, false);
        let mut builder = ListBuilder::new(Float32Builder::new()).with_field(item);
        for row in rows {
            builder.values().append_slice(values(row));
            builder.append(true);
        }
        Arc::new(builder.finish())
    };
    match &column.kind {
        ColumnKind::Record => whole(&|r| r.drawn.index),
        ColumnKind::Unit => whole(&|r| r.drawn.unit),
        ColumnKind::Seed => whole(&|r| r.drawn.seed),
        ColumnKind::WheelsSeed => whole(&|r| r.drawn.wheels_seed),
        ColumnKind::Split => text(&|r| names[r.drawn.split].to_owned()),
        ColumnKind::Label => text(&|r| content.classes[r.drawn.class].label.clone()),
        ColumnKind::Severity => small(&|r| Some(u32::from(r.drawn.severity))),
        ColumnKind::SeverityMeasure => number(&|r| r.drawn.severity_measure),
        ColumnKind::FaultTooth => small(&|r| r.fault_tooth),
        ColumnKind::SamplingRate => number(&|_| Some(content.keep.sampling_rate_hz)),
        ColumnKind::GearAngle => number(&|r| Some(r.gear_angle_rev)),
        ColumnKind::PinionTeeth => small(&|r| Some(r.teeth[0])),
        ColumnKind::GearTeeth => small(&|r| Some(r.teeth[1])),
        ColumnKind::PinionSpeed => number(&|r| Some(r.pinion_speed_hz)),
        ColumnKind::GearSpeed => {
            number(&|r| Some(r.pinion_speed_hz * f64::from(r.teeth[0]) / f64::from(r.teeth[1])))
        }
        ColumnKind::BrakeTorque => number(&|r| Some(r.brake_torque_nm)),
        ColumnKind::Key(key) => {
            number(&|r| r.drawn.values.iter().find(|(other, _)| other == key).map(|(_, value)| *value))
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
