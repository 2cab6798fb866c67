//! Signals as an archive of NumPy arrays: each under its name, with the time and the sampling rate.

use std::io::{self, BufWriter, Seek, Write};

use super::super::signal_table::SignalTable;
use super::super::{RATE, TIME};
use crate::npz::NpzWriter;

pub fn write(table: &SignalTable, to: impl Write + Seek) -> io::Result<()> {
    let mut archive = NpzWriter::stored(BufWriter::new(to));
    archive.add(RATE, &[], &[table.channels.sampling_rate_hz])?;
    archive.add(TIME, &[table.channels.len()], &table.times_s())?;
    for column in &table.channels.signals {
        archive.add(&column.name, &[column.values.len()], &column.values)?;
    }
    archive.finish()?.flush()
}
