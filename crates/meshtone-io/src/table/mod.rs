//! Tables as Apache Parquet, with what Arrow knows about their columns besides.
//!
//! The `parquet` crate reads and writes columns of plain values. Programs that build on Arrow (pyarrow, pandas, polars) keep a
//! schema of their own in such a file, under the key `ARROW:schema`: units and descriptions of columns stand there, and types
//! that Parquet lacks. It is read and written here, because Arrow's own crates for it take as long to compile as the rest of
//! Meshtone.

mod arrow_schema;
mod flat_buffer;
mod found_type;
mod metadata_hash;
mod page_checksum;
mod read;
mod split_signal;
mod write;

pub use found_type::{FoundType, NumberType};
pub use metadata_hash::{SEAL, UNKNOWN_HASH, place_of_hash};
pub use read::{FoundColumn, Numbers, TableReader};
pub(crate) use write::write_compressed;
pub use write::{CellType, Cells, TableColumn, TableWriter};

use std::io;

use parquet::errors::ParquetError;

/// The reader's or writer's error, as the file's where it is that one: a full disk stays one.
///
/// # Arguments
/// * `error` - of the `parquet` crate
pub fn into_io(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(source) => match source.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(source) => io::Error::other(source),
        },
        error => io::Error::other(error),
    }
}
