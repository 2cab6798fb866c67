//! Where a data set is written to: a directory, or an object store (feature `objects`).
//!
//! Everything appears whole or not at all. In a directory a file is written under another name beside its place and renamed; an
//! object store shows an object once it is complete.

mod directory;
mod file_url;
#[cfg(feature = "objects")]
mod object;
#[cfg(feature = "objects")]
mod remote_file;

use std::collections::BTreeMap;
use std::fmt;
use std::fs::File;
use std::io::{self, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use meshtone_io::own_file::Claim;

use crate::digest::{Digest, Hashing};
use crate::error::DatasetError;
use crate::shard::{ReadShard, Wanted};
use directory::Directory;

/// Where a data set is written to.
#[derive(Debug, Clone)]
pub struct Destination {
    place: Arc<dyn Place>,
}

/// Holds files by their names, with `/` between folders. It shows itself as users name it.
trait Place: fmt::Debug + fmt::Display + Send + Sync {
    /// The names of all files with their sizes in bytes; none where the place does not exist.
    fn files(&self) -> io::Result<BTreeMap<String, u64>>;

    /// Those of one of the data set's folders.
    fn files_in(&self, folder: &str) -> io::Result<BTreeMap<String, u64>> {
        let mut files = self.files()?;
        files.retain(|name, _| name.strip_prefix(folder).is_some_and(|rest| rest.starts_with('/')));
        Ok(files)
    }

    /// Reads a file from its start.
    fn open(&self, name: &str) -> io::Result<Box<dyn Read + '_>>;

    /// Reads some of a shard.
    fn shard(&self, name: &str, wanted: Wanted) -> io::Result<ReadShard>;

    /// Writes a file that appears whole or not at all; its content is written once.
    fn write(&self, name: &str, content: &mut dyn FnMut(&mut File) -> io::Result<()>) -> io::Result<()>;

    /// Removes a file.
    fn remove(&self, name: &str) -> io::Result<()>;

    /// A file's name for messages.
    fn name_of(&self, name: &str) -> String;

    /// Has something of the place for this program alone; none where another program has it. An object store knows no such thing.
    fn claim(&self, _what: &str) -> io::Result<Option<Claimed>> {
        Ok(Some(Claimed { _claim: None }))
    }

    /// Removes what killed runs have left behind.
    fn remove_leftovers(&self) {}

    /// Whether files can be written.
    fn check_writable(&self) -> io::Result<()> {
        Ok(())
    }

    /// The directory, where it is one.
    fn path(&self) -> Option<&Path> {
        None
    }
}

/// Something of a place that this program has for itself, as far as the place knows of such.
#[derive(Debug)]
#[must_use = "dropped, it is anybody's"]
pub(crate) struct Claimed {
    _claim: Option<Claim>,
}

/// (bytes) What is read at once of a file that is hashed.
const READ_BYTES: usize = 1 << 20;

const HELP: &str = "name a directory or a URL such as file:///data/gears or s3://bucket/gears";

impl Destination {
    /// A directory, which need not exist.
    ///
    /// # Arguments
    /// * `path` - the directory
    pub fn directory(path: impl Into<PathBuf>) -> Self {
        Self { place: Arc::new(Directory::new(path.into())) }
    }

    /// A place in an object store.
    ///
    /// # Arguments
    /// * `store` - the store
    /// * `prefix` - what the names of all objects begin with; empty for none
    #[cfg(feature = "objects")]
    pub fn objects(store: Arc<dyn object_store::ObjectStore>, prefix: &str) -> Self {
        Self { place: Arc::new(object::Objects::new(store, prefix.into())) }
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
        let Some((scheme, rest)) = text.split_once("://") else { return Ok(Self::directory(text)) };
        match scheme.to_ascii_lowercase().as_str() {
            "file" => file_url::path(rest).map(Self::directory).ok_or_else(|| {
                DatasetError::refused(format!("{text} names no directory of this machine"), HELP)
            }),
            "memory" => Err(DatasetError::refused(format!("{text} would be gone with the program"), HELP)),
            scheme if file_url::is_scheme(scheme) => Self::remote(text),
            _ => Err(DatasetError::refused(
                format!("{text} is no URL: a letter, then letters, digits, +, - or . stand before ://"),
                HELP,
            )),
        }
    }

    #[cfg(feature = "objects")]
    fn remote(url: &str) -> Result<Self, DatasetError> {
        let parsed = url::Url::parse(url)
            .map_err(|error| DatasetError::refused(format!("{url} is no URL: {error}"), HELP))?;
        match object_store::parse_url_opts(&parsed, std::env::vars()) {
            Ok((store, prefix)) => Ok(Self { place: Arc::new(object::Objects::new(store.into(), prefix)) }),
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

    /// All that is there: names from the data set's own directory, with `/` between folders, and sizes in bytes; nothing where the
    /// place does not exist.
    pub(crate) fn files(&self) -> Result<BTreeMap<String, u64>, DatasetError> {
        self.place.files().map_err(DatasetError::read(self.to_string()))
    }

    /// As [`Self::files`], of one of the data set's folders.
    pub(crate) fn files_in(&self, folder: &str) -> Result<BTreeMap<String, u64>, DatasetError> {
        self.place.files_in(folder).map_err(DatasetError::read(self.to_string()))
    }

    /// Whether there is a file of a name.
    pub(crate) fn has(&self, name: &str) -> Result<bool, DatasetError> {
        match self.place.open(name) {
            Ok(_) => Ok(true),
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
                Ok(false)
            }
            Err(error) => Err(DatasetError::read(self.place.name_of(name))(error)),
        }
    }

    /// The content of a small file; none where there is none. What is no text any more is replaced, and fails its seal.
    pub(crate) fn text(&self, name: &str) -> Result<Option<String>, DatasetError> {
        let mut content = Vec::new();
        match self.place.open(name).and_then(|mut file| file.read_to_end(&mut content)) {
            Ok(_) => Ok(Some(String::from_utf8_lossy(&content).into_owned())),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(DatasetError::read(self.place.name_of(name))(error)),
        }
    }

    /// What a shard says about itself and some of its values, or why it cannot be read.
    pub(crate) fn read_shard(&self, name: &str, wanted: Wanted) -> io::Result<ReadShard> {
        self.place.shard(name, wanted)
    }

    /// The digest of a file.
    pub(crate) fn digest(&self, name: &str) -> Result<Digest, DatasetError> {
        let mut hashing = Hashing::new(io::sink());
        let mut reader = self.place.open(name).map_err(DatasetError::read(self.place.name_of(name)))?;
        let read = io::copy(&mut BufReader::with_capacity(READ_BYTES, &mut reader), &mut hashing);
        read.map_err(DatasetError::read(self.place.name_of(name)))?;
        Ok(hashing.digest())
    }

    /// Writes a file that appears whole or not at all.
    pub(crate) fn write<T>(
        &self,
        name: &str,
        write: impl FnOnce(&mut File) -> io::Result<T>,
    ) -> Result<T, DatasetError> {
        let mut write = Some(write);
        let mut result = None;
        let written = self.place.write(name, &mut |file| {
            result = write.take().map(|write| write(file)).transpose()?;
            Ok(())
        });
        written
            .and_then(|()| result.ok_or_else(|| io::Error::other("nothing was written")))
            .map_err(DatasetError::write(self.place.name_of(name)))
    }

    /// Writes a small file.
    pub(crate) fn write_bytes(&self, name: &str, bytes: &[u8]) -> Result<(), DatasetError> {
        self.write(name, |file| file.write_all(bytes))
    }

    /// Takes over a file of another place, if it has the digest that it should have. Returns whether it has.
    pub(crate) fn take_over(&self, other: &Self, name: &str, digest: &Digest) -> Result<bool, DatasetError> {
        let mut reader = other.place.open(name).map_err(DatasetError::read(other.place.name_of(name)))?;
        let mut differs = false;
        let written = self.write(name, |file| {
            let mut hashing = Hashing::new(file);
            io::copy(&mut BufReader::with_capacity(READ_BYTES, &mut reader), &mut hashing)?;
            differs = hashing.digest() != *digest;
            // An error keeps the file from being named.
            if differs { Err(io::Error::other("it is damaged")) } else { Ok(()) }
        });
        if differs { Ok(false) } else { written.map(|()| true) }
    }

    /// A file's name for messages.
    pub(crate) fn name_of(&self, name: &str) -> String {
        self.place.name_of(name)
    }

    /// Removes a file; none is there afterwards.
    pub(crate) fn remove(&self, name: &str) -> Result<(), DatasetError> {
        match self.place.remove(name) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(DatasetError::write(self.place.name_of(name))(error))
            }
            _ => Ok(()),
        }
    }

    /// Has something of the place for this program alone.
    ///
    /// # Arguments
    /// * `what` - a word for it
    /// * `in_words` - what another program does that has it
    pub(crate) fn claim(&self, what: &str, in_words: &str) -> Result<Claimed, DatasetError> {
        let claimed = self.place.claim(what).map_err(DatasetError::write(self.to_string()))?;
        claimed.ok_or_else(|| DatasetError::Busy { place: self.to_string(), doing: in_words.to_owned() })
    }

    /// Removes what killed runs have left behind.
    pub(crate) fn remove_leftovers(&self) {
        self.place.remove_leftovers();
    }

    /// Whether files can be written there. A directory that does not exist is created for it.
    pub(crate) fn check_writable(&self) -> Result<(), DatasetError> {
        self.place.check_writable().map_err(DatasetError::write(self.to_string()))
    }

    /// The directory, where it is one.
    pub fn path(&self) -> Option<&Path> {
        self.place.path()
    }
}

impl fmt::Display for Destination {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.place.fmt(formatter)
    }
}

fn without_cloud(url: &str) -> DatasetError {
    DatasetError::refused(
        format!("this build of the program cannot write to {url}"),
        "build it with object stores: cargo build --release --features cloud",
    )
}
