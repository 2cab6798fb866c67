//! Traces as NumPy archives.

use std::io::{self, BufWriter, Write};

use meshtone::{Trace, TraceField};
use ndarray::{ArrayViewD, IxDyn, arr0};
use ndarray_npy::NpzWriter;

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
    let mut archive = NpzWriter::new(BufWriter::new(to));
    for field in &trace.fields {
        archive.add_array(field.name.as_str(), &array(field)?).map_err(io::Error::other)?;
    }
    archive.add_array(RUN_ENTRY, &arr0(run.number())).map_err(io::Error::other)?;
    archive.finish().map_err(io::Error::other)?.flush()
}

fn array(field: &TraceField) -> io::Result<ArrayViewD<'_, f64>> {
    ArrayViewD::from_shape(IxDyn(&field.shape), &field.values)
        .map_err(|error| io::Error::other(format!("{}: {error}", field.name)))
}
