//! Labelled data sets of spur gear vibration.
//!
//! A [`plan::Plan`] says what a data set consists of; [`draw::Sampler`] draws any of its records by its number alone;
//! [`generate`](generate::generate) simulates them and writes shards of Parquet, which can be stopped at any moment and gone on with;
//! [`merge`](merge::merge) puts parts together that were made apart; [`verify`](verify::verify) says whether a data set is what was written.
#![deny(missing_docs)]

mod card;
mod contents;
mod croissant;
pub mod digest;
pub mod draw;
mod error;
pub mod expression;
mod finish;
pub mod generate;
mod manifest;
pub mod merge;
mod part_list;
pub mod plan;
pub mod record;
pub mod sampling;
mod sealed;
pub mod shard;
pub mod store;
pub mod verify;
mod words;

pub use error::DatasetError;
pub use words::counted;
