//! Reading TOML key by key, with errors that name key, line, value and remedy.
//!
//! For files that people write, so that all of them are refused in the same words: wrong types, missing and unknown keys
//! (with the nearest right name), numbers that are not finite, text that is not TOML.
//!
//! ```
//! use meshtone_toml::TomlDocument;
//!
//! let document = TomlDocument::parse("[motor]\nspeed_hz = 40\n")?;
//! let speed_hz = document.root().read(|root| {
//!     root.table_or_empty("motor")?.read(|motor| motor.required("speed_hz", "(rev/s) speed")?.number())
//! })?;
//! assert_eq!(speed_hz, 40.0);
//! # Ok::<(), meshtone_toml::TomlError>(())
//! ```
#![deny(missing_docs)]

mod document;
mod error;
mod key_path;
mod named;
mod nearest;
mod table;
mod value;

pub use document::TomlDocument;
pub use error::{ErrorKind, TomlError};
pub use nearest::nearest_name;
pub use table::TomlTable;
pub use value::TomlValue;

/// Result of a reader: the value, or a problem of the file.
pub type ReadResult<T> = Result<T, TomlError>;
