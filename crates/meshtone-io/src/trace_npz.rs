//! Traces as NumPy archives.

use std::io::{self, BufWriter, Write};

use meshtone::Trace;

use crate::npz::NpzWriter;
use crate::run_identity::RunIdentity;

/// Name of the entry that holds the run's identity, a 64-bit number: [`RunIdentity::number`].
pub const RUN_ENTRY: &str = "run";

/// Writes every field of a trace under its name, in its shape, in double precision; and the run's identity under
/// [`RUN_ENTRY`].
///
/// # Arguments
/// * `to` - where the archive is written to
/// * `run` - the run that it belongs to
/// * `trace` - the fields
///
/// # Errors
/// Those of `to`, and a field whose values do not fill its shape.
pub fn write_trace(to: impl Write + io::Seek, run: RunIdentity, trace: &Trace) -> io::Result<()> {
    let mut archive = NpzWriter::stored(BufWriter::new(to));
    for field in &trace.fields {
        archive.add(&field.name, &field.shape, &field.values)?;
    }
    archive.add_whole(RUN_ENTRY, run.number())?;
    archive.finish()?.flush()
}
