//! Signals as text: a line of names, and a line for each sample.

use std::io::{self, BufWriter, Write};

use super::super::TIME;
use super::super::signal_table::SignalTable;

/// Writes every number with the fewest digits that give it back exactly.
pub fn write(table: &SignalTable, to: impl Write) -> io::Result<()> {
    let mut to = BufWriter::new(to);
    to.write_all(TIME.as_bytes())?;
    table.channels.signals.iter().try_for_each(|column| write!(to, ",{}", column.name))?;
    for sample in 0..table.channels.len() {
        write!(to, "\n{:?}", table.channels.time_s(sample))?;
        table.channels.signals.iter().try_for_each(|column| write!(to, ",{:?}", column.values[sample]))?;
    }
    writeln!(to)?;
    to.flush()
}
