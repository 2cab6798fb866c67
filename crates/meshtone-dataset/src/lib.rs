//! Labelled data sets of spur gear vibration.
//!
//! A [`plan::Plan`] says what a data set consists of. [`draw::Sampler`] draws any record from its number alone.
//! [`generate`](generate::generate) simulates the records and writes them as Parquet shards; it can be stopped at any moment and resumed.
//! [`merge`](merge::merge) joins parts that were made separately. [`verify`](verify::verify) checks a data set against its hashes.
#![deny(missing_docs)]

pub mod adapt;
mod card;
mod contents;
mod croissant;
pub mod digest;
pub mod draw;
mod error;
pub mod expression;
mod finish;
pub mod generate;
mod like;
mod manifest;
pub mod merge;
pub mod plan;
pub mod record;
pub mod sampling;
pub mod shard;
pub mod store;
pub mod verify;
mod words;

pub use error::DatasetError;
pub use like::{RecordedRows, rows_like};
pub use words::counted;
