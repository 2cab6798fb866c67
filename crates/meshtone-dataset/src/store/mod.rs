//! Where a data set is written to: a directory, or an object store (feature `objects`).
//!
//! Every file appears whole or not at all. In a directory, a file is written under a temporary name and then renamed. An object store
//! shows an object once it is complete.

mod directory;
mod file_url;
#[cfg(feature = "objects")]
mod object;
#[cfg(feature = "objects")]
mod remote_file;

use std::collections::BTreeMap;
use std::fmt;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use meshtone_io::own_file::Claim;

use crate::contents::WRONG_BYTES;
use crate::digest::{Digest, Hashing};
use crate::error::DatasetError;
use crate::shard::{self, ReadShard, Wanted};
use crate::verify::Check;
use directory::Directory;
#[cfg(feature = "objects")]
use object::Objects;

/// Names of files, with `/` between folders, and their sizes in bytes.
pub(crate) type Files = BTreeMap<String, u64>;

/// The place that a data set is written to.
#[derive(Debug, Clone)]
pub struct Destination {
    storage: Arc<dyn Storage>,
    /// The directory, if the data set is in one.
    directory: Option<PathBuf>,
}

/// Files by their names, with `/` between folders. A storage is displayed as users name it.
trait Storage: fmt::Debug + fmt::Display + Send + Sync {
    /// The names of all files with their sizes in bytes; none where the place does not exist.
    fn files(&self) -> io::Result<Files>;

    /// Reads a file from its start.
    fn open(&self, name: &str) -> io::Result<Box<dyn Read + '_>>;

    /// Reads some values of a shard.
    fn shard(&self, name: &str, wanted: Wanted) -> io::Result<ReadShard>;

    /// Writes a file that appears whole or not at all. `content` is called once.
    fn write(&self, name: &str, content: &mut dyn FnMut(&mut File) -> io::Result<()>) -> io::Result<()>;

    /// The name of a file for messages.
    fn name_of(&self, name: &str) -> String;
}

/// (bytes) Size of the blocks in which a file is read to be hashed.
const READ_BYTES: usize = 1 << 20;

const HELP: &str = "name a directory or a URL such as file:///data/gears or s3://bucket/gears";

impl Destination {
    /// A directory, which need not exist.
    ///
    /// # Arguments
    /// * `path` - the directory
    pub fn directory(path: impl Into<PathBuf>) -> Self {
        let path = path.into();
        Self { storage: Arc::new(Directory { path: path.clone() }), directory: Some(path) }
    }

    /// A place in an object store.
    ///
    /// # Arguments
    /// * `store` - the store
    /// * `prefix` - what the names of all objects begin with; empty for none
    #[cfg(feature = "objects")]
    pub fn objects(store: Arc<dyn object_store::ObjectStore>, prefix: &str) -> Self {
        let prefix = prefix.into();
        Self { storage: Arc::new(Objects { store, prefix }), directory: None }
    }

    /// A directory's name or a URL: `file:`, and with the feature `cloud` `s3:`, `gs:`, `az:` and `https:`.
    ///
    /// # Arguments
    /// * `text` - as a user writes it
    ///
    /// Access keys, regions and endpoints are read from the environment, by the names that the crate `object_store` gives them,
    /// such as `AWS_ACCESS_KEY_ID` and `AWS_ENDPOINT`.
    ///
    /// # Errors
    /// The text is not a URL, or one of a kind that this build does not know.
    ///
    /// ```
    /// use meshtone_dataset::store::Destination;
    ///
    /// assert_eq!(Destination::parse("file:///tmp/gears")?.to_string(), "/tmp/gears");
    /// assert!(Destination::parse("gopher://gears").is_err());
    /// # Ok::<(), meshtone_dataset::DatasetError>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, DatasetError> {
        let Some((scheme, rest)) = text.split_once("://") else { return Ok(Self::directory(text)) };
        let problem = match scheme.to_ascii_lowercase().as_str() {
            "file" => match file_url::path(rest) {
                Some(path) => return Ok(Self::directory(path)),
                None => "names no directory of this machine",
            },
            "memory" => "would be gone with the program",
            scheme if file_url::is_scheme(scheme) => return Self::remote(text),
            _ => "is no URL: a letter, then letters, digits, +, - or . stand before ://",
        };
        Err(DatasetError::refused(format!("{text} {problem}"), HELP))
    }

    #[cfg(feature = "objects")]
    fn remote(url: &str) -> Result<Self, DatasetError> {
        let parsed = url::Url::parse(url)
            .map_err(|error| DatasetError::refused(format!("{url} is no URL: {error}"), HELP))?;
        match object_store::parse_url_opts(&parsed, std::env::vars()) {
            Ok((store, prefix)) => {
                Ok(Self { storage: Arc::new(Objects { store: store.into(), prefix }), directory: None })
            }
            Err(error) if cfg!(feature = "cloud") => {
                Err(DatasetError::refused(format!("cannot write to {url}: {error}"), HELP))
            }
            Err(_) => Err(without_cloud(url)),
        }
    }

    #[cfg(not(feature = "objects"))]
    fn remote(url: &str) -> Result<Self, DatasetError> {
        Err(without_cloud(url))
    }

    /// All files that are there: names from the data set's own directory, with `/` between folders, and sizes in bytes. There are none
    /// where the place does not exist.
    pub(crate) fn files(&self) -> Result<Files, DatasetError> {
        self.storage.files().map_err(DatasetError::read(self.to_string()))
    }

    /// The content of a small file; none where there is no such file.
    fn bytes(&self, name: &str) -> Result<Option<Vec<u8>>, DatasetError> {
        let mut content = Vec::new();
        match self.storage.open(name).and_then(|mut file| file.read_to_end(&mut content)) {
            Ok(_) => Ok(Some(content)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(DatasetError::read(self.storage.name_of(name))(error)),
        }
    }

    /// The content of a small file as text; none where there is no such file. Damaged text is replaced, and its seal does not fit.
    pub(crate) fn text(&self, name: &str) -> Result<Option<String>, DatasetError> {
        Ok(self.bytes(name)?.map(|content| String::from_utf8_lossy(&content).into_owned()))
    }

    /// Reads the metadata of a shard and some of its values.
    pub(crate) fn read_shard(&self, name: &str, wanted: Wanted) -> io::Result<ReadShard> {
        self.storage.shard(name, wanted)
    }

    /// The digest of a file.
    pub(crate) fn digest(&self, name: &str) -> Result<Digest, DatasetError> {
        let read = self.storage.open(name).and_then(|reader| {
            let mut hashing = Hashing::new(io::sink());
            io::copy(&mut BufReader::with_capacity(READ_BYTES, reader), &mut hashing)?;
            Ok(hashing.digest())
        });
        read.map_err(DatasetError::read(self.storage.name_of(name)))
    }

    /// Writes a file that appears whole or not at all.
    pub(crate) fn write<T>(
        &self,
        name: &str,
        write: impl FnOnce(&mut File) -> io::Result<T>,
    ) -> Result<T, DatasetError> {
        let mut write = Some(write);
        let mut result = None;
        let written = self.storage.write(name, &mut |file| {
            result = write.take().map(|write| write(file)).transpose()?;
            Ok(())
        });
        written
            .and_then(|()| result.ok_or_else(|| io::Error::other("nothing was written")))
            .map_err(DatasetError::write(self.storage.name_of(name)))
    }

    /// Writes a small file, unless a file with the same content is there.
    pub(crate) fn write_unless_there(&self, name: &str, bytes: &[u8]) -> Result<(), DatasetError> {
        if self.bytes(name)?.as_deref() == Some(bytes) { Ok(()) } else { self.write_bytes(name, bytes) }
    }

    /// Writes a small file.
    pub(crate) fn write_bytes(&self, name: &str, bytes: &[u8]) -> Result<(), DatasetError> {
        self.write(name, |file| file.write_all(bytes))
    }

    /// Reads some columns of a shard, where its bytes are checked after it was read to its end.
    ///
    /// # Errors
    /// In words, what is wrong with it.
    pub(crate) fn checked_shard(
        &self,
        name: &str,
        columns: &[&str],
        check: Check,
    ) -> Result<ReadShard, String> {
        if check == Check::Bytes {
            let proven = self.storage.open(name).and_then(shard::proven);
            proven.map_err(|error| unreadable(&error))?.ok_or(WRONG_BYTES)?;
        }
        self.read_shard(name, Wanted::Columns(columns)).map_err(|error| unreadable(&error))
    }

    /// Copies a shard from another place if it is as it was written. Returns whether it is.
    pub(crate) fn take_over(&self, other: &Self, name: &str) -> Result<bool, DatasetError> {
        let mut reader = other.storage.open(name).map_err(DatasetError::read(other.storage.name_of(name)))?;
        let mut differs = false;
        let written = self.write(name, |file| {
            io::copy(&mut BufReader::with_capacity(READ_BYTES, &mut reader), file)?;
            file.rewind()?;
            differs = shard::proven(&mut *file)?.is_none();
            // After an error, the file does not get its name.
            if differs { Err(io::Error::other("it is damaged")) } else { Ok(()) }
        });
        if differs { Ok(false) } else { written.map(|()| true) }
    }

    /// The name of a file for messages.
    pub(crate) fn name_of(&self, name: &str) -> String {
        self.storage.name_of(name)
    }

    /// Claims something of the place for this program alone until the claim is dropped. An object store has no claims.
    ///
    /// # Arguments
    /// * `what` - a word for it
    /// * `in_words` - what another program does that has claimed it
    pub(crate) fn claim(&self, what: &str, in_words: &str) -> Result<Option<Claim>, DatasetError> {
        let Some(path) = self.path() else { return Ok(None) };
        let claim = Claim::take(path, what).map_err(DatasetError::write(self.to_string()))?;
        let busy = || DatasetError::Busy { place: self.to_string(), doing: in_words.to_owned() };
        claim.ok_or_else(busy).map(Some)
    }

    /// Removes what killed runs have left behind.
    pub(crate) fn remove_leftovers(&self) {
        if let Some(path) = self.path() {
            directory::remove_leftovers(path, "");
        }
    }

    /// Checks that files can be written. A directory that does not exist is created.
    pub(crate) fn check_writable(&self) -> Result<(), DatasetError> {
        let checked = self.path().map_or(Ok(()), directory::check_writable);
        checked.map_err(DatasetError::write(self.to_string()))
    }

    /// The directory, if the data set is in one.
    pub fn path(&self) -> Option<&Path> {
        self.directory.as_deref()
    }
}

impl fmt::Display for Destination {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.storage.fmt(formatter)
    }
}

/// The problem of a file that cannot be read, in words.
fn unreadable(error: &io::Error) -> String {
    format!("it cannot be read: {error}")
}

fn without_cloud(url: &str) -> DatasetError {
    DatasetError::refused(
        format!("this build has no object stores, such as that of {url}"),
        "in the source code's folder build the program with them: cargo build --release --features cloud, and the Python package: \
         pip install . --config-settings build-args='--features cloud'",
    )
}
