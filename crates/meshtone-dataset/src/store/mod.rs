//! Where a data set is written to: a directory, or an object store.
//!
//! Everything appears whole or not at all. In a directory a file is written under another name beside its place and renamed; an
//! object store shows an object once it is complete.

mod directory;
mod object;
mod remote_file;

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use object_store::ObjectStore;
use sha2::{Digest, Sha256};
use url::Url;

use crate::error::DatasetError;
use crate::plan::hex;
use crate::shard::{self, ReadShard};
use object::Objects;

/// Where a data set is written to.
#[derive(Debug, Clone)]
pub struct Destination {
    place: Place,
}

#[derive(Debug, Clone)]
enum Place {
    Directory(PathBuf),
    Objects(Objects),
}

impl Destination {
    /// A directory, which need not exist.
    ///
    /// # Arguments
    /// * `path` - the directory
    pub fn directory(path: impl Into<PathBuf>) -> Self {
        Self { place: Place::Directory(path.into()) }
    }

    /// A place in an object store.
    ///
    /// # Arguments
    /// * `store` - the store
    /// * `prefix` - what the names of all objects begin with; empty for none
    pub fn objects(store: Arc<dyn ObjectStore>, prefix: &str) -> Self {
        Self { place: Place::Objects(Objects::new(store, prefix.into())) }
    }

    /// A directory's name or a URL: `file:`, and with the feature `cloud` `s3:`, `gs:`, `az:` and `https:`.
    ///
    /// # Arguments
    /// * `text` - as a user writes it
    ///
    /// Access keys, regions and endpoints are read from the environment, by the names that [`object_store`] gives them, such as
    /// `AWS_ACCESS_KEY_ID` and `AWS_ENDPOINT`.
    ///
    /// # Errors
    /// A URL that is none, or of a kind that this build does not know.
    ///
    /// ```
    /// use meshtone_dataset::store::Destination;
    ///
    /// assert_eq!(Destination::parse("file:///tmp/gears")?.to_string(), "/tmp/gears");
    /// assert!(Destination::parse("gopher://gears").is_err());
    /// # Ok::<(), meshtone_dataset::DatasetError>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, DatasetError> {
        if !text.contains("://") {
            return Ok(Self::directory(text));
        }
        let help = "name a directory or a URL such as file:///data/gears or s3://bucket/gears";
        let url = Url::parse(text)
            .map_err(|error| DatasetError::refused(format!("{text} is no URL: {error}"), help))?;
        if url.scheme() == "file" {
            let path = url.to_file_path();
            return path.map(Self::directory).map_err(|()| {
                DatasetError::refused(format!("{text} names no directory of this machine"), help)
            });
        }
        if url.scheme() == "memory" {
            return Err(DatasetError::refused(format!("{text} would be gone with the program"), help));
        }
        match object_store::parse_url_opts(&url, std::env::vars()) {
            Ok((store, prefix)) => Ok(Self { place: Place::Objects(Objects::new(store.into(), prefix)) }),
            Err(error) if cfg!(feature = "cloud") => {
                Err(DatasetError::refused(format!("cannot write to {text}: {error}"), help))
            }
            Err(_) => Err(DatasetError::refused(
                format!("this build of the program cannot write to {text}"),
                "build it with object stores: cargo build --release --features cloud",
            )),
        }
    }

    /// Names of all that is there, from the data set's own directory, with `/` between folders; none where it does not
    /// exist.
    pub(crate) fn names(&self) -> Result<Vec<String>, DatasetError> {
        let names = match &self.place {
            Place::Directory(path) => directory::names(path),
            Place::Objects(objects) => objects.names(),
        };
        names.map_err(DatasetError::read(self.to_string()))
    }

    /// The content of a small file; none where there is none.
    pub(crate) fn text(&self, name: &str) -> Result<Option<String>, DatasetError> {
        let text = match &self.place {
            Place::Directory(path) => std::fs::read_to_string(path.join(name)),
            Place::Objects(objects) => {
                let mut text = String::new();
                objects.open(name).and_then(|file| file.reader(0).read_to_string(&mut text)).map(|_| text)
            }
        };
        match text {
            Ok(text) => Ok(Some(text)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(DatasetError::read(self.name_of(name))(error)),
        }
    }

    /// What a shard says about itself and some of its columns; none where there is none, or what is there is no whole shard.
    pub(crate) fn shard(&self, name: &str, columns: &[&str]) -> Option<ReadShard> {
        match &self.place {
            Place::Directory(path) => shard::read(File::open(path.join(name)).ok()?, columns).ok(),
            Place::Objects(objects) => shard::read(objects.open(name).ok()?, columns).ok(),
        }
    }

    /// As [`Self::shard`], of one row alone: the signals of a whole shard may be large.
    pub(crate) fn shard_row(&self, name: &str, columns: &[&str], row: usize) -> Option<ReadShard> {
        match &self.place {
            Place::Directory(path) => shard::read_row(File::open(path.join(name)).ok()?, columns, row).ok(),
            Place::Objects(objects) => shard::read_row(objects.open(name).ok()?, columns, row).ok(),
        }
    }

    /// SHA-256 and length of a file.
    pub(crate) fn sha256(&self, name: &str) -> Result<(String, u64), DatasetError> {
        self.reader(name)
            .and_then(|mut reader| hash(&mut *reader))
            .map_err(DatasetError::read(self.name_of(name)))
    }

    /// Writes a file that appears whole or not at all.
    pub(crate) fn write<T>(
        &self,
        name: &str,
        write: impl FnOnce(&mut File) -> io::Result<T>,
    ) -> Result<T, DatasetError> {
        let written = match &self.place {
            Place::Directory(path) => directory::write(path, name, write),
            Place::Objects(objects) => objects.write(name, write),
        };
        written.map_err(DatasetError::write(self.name_of(name)))
    }

    /// Writes a small file.
    pub(crate) fn write_bytes(&self, name: &str, bytes: &[u8]) -> Result<(), DatasetError> {
        self.write(name, |file| io::Write::write_all(file, bytes))
    }

    /// Takes over a file of another place.
    pub(crate) fn take_over(&self, other: &Self, name: &str) -> Result<(), DatasetError> {
        let mut reader = other.reader(name).map_err(DatasetError::read(other.name_of(name)))?;
        self.write(name, |file| io::copy(&mut reader, file).map(|_| ()))
    }

    /// Removes what killed runs have left behind.
    pub(crate) fn remove_leftovers(&self) {
        if let Place::Directory(path) = &self.place {
            directory::remove_leftovers(path);
        }
    }

    /// Whether files can be written there. A directory that does not exist is created for it.
    pub(crate) fn check_writable(&self) -> Result<(), DatasetError> {
        match &self.place {
            Place::Directory(path) => {
                directory::check_writable(path).map_err(DatasetError::write(self.to_string()))
            }
            Place::Objects(_) => Ok(()),
        }
    }

    fn reader(&self, name: &str) -> io::Result<Box<dyn Read + '_>> {
        Ok(match &self.place {
            Place::Directory(path) => Box::new(File::open(path.join(name))?),
            Place::Objects(objects) => Box::new(objects.open(name)?.reader(0)),
        })
    }

    fn name_of(&self, name: &str) -> String {
        match &self.place {
            Place::Directory(path) => path.join(name).display().to_string(),
            Place::Objects(objects) => format!("{objects}/{name}"),
        }
    }

    /// The directory, where it is one.
    pub fn path(&self) -> Option<&Path> {
        match &self.place {
            Place::Directory(path) => Some(path),
            Place::Objects(_) => None,
        }
    }
}

impl std::fmt::Display for Destination {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.place {
            Place::Directory(path) => path.display().fmt(formatter),
            Place::Objects(objects) => objects.fmt(formatter),
        }
    }
}

fn hash(reader: &mut dyn Read) -> io::Result<(String, u64)> {
    let mut hash = Sha256::new();
    let mut buffer = vec![0; 1 << 20];
    let mut length = 0;
    loop {
        match reader.read(&mut buffer)? {
            0 => return Ok((hex(&hash.finalize()), length)),
            count => {
                hash.update(&buffer[..count]);
                length += count as u64;
            }
        }
    }
}
