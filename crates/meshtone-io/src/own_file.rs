//! Files that belong to a running program, under names that begin with `.meshtone-`.
//!
//! Each is locked as long as its program runs; however a program ends, the system takes its locks away. So what another program
//! is writing can be distinguished from what a killed one has left behind. On file systems without locks nothing counts as left
//! behind.

use std::collections::BTreeSet;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError, RwLock};
use std::thread::sleep;
use std::time::Duration;

use tempfile::{NamedTempFile, PersistError};

/// What the names begin with.
pub const PREFIX: &str = ".meshtone-";

/// How often a file is begun anew that another program has taken for left behind before it was locked.
const TRIES: usize = 16;
/// How long a program that clears up has a file locked at most, and more.
const CLEARING: Duration = Duration::from_millis(10);

/// All of this program's own paths, which are removed where it receives a signal to end.
static OWN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn own() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // A set of paths is whole whatever happened to whoever changed it.
    OWN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A path that is among this program's own until it is dropped.
#[derive(Debug)]
struct OwnPath(PathBuf);

impl Drop for OwnPath {
    fn drop(&mut self) {
        own().remove(&self.0);
    }
}

/// A way to give a temporary file its name.
pub(crate) type Persist = fn(NamedTempFile, &Path) -> Result<File, PersistError>;

/// A file under a temporary name. It disappears where it is dropped.
#[derive(Debug)]
pub(crate) struct TemporaryFile {
    /// The file, to be written to. It is gone before it is taken from the list.
    pub(crate) file: NamedTempFile,
    own_path: OwnPath,
}

impl TemporaryFile {
    /// Begins a file.
    ///
    /// # Arguments
    /// * `directory` - the directory of the file
    pub fn begin(directory: &Path) -> io::Result<Self> {
        clear_up_once(directory);
        for _ in 0..TRIES {
            // A signal to end the program is not to come between the two.
            let mut own = own();
            let file = builder().tempfile_in(directory)?;
            own.insert(file.path().to_path_buf());
            drop(own);
            let own_path = OwnPath(file.path().to_path_buf());
            let begun = Self { file, own_path };
            if !is_taken(begun.file.as_file()) && begun.file.path().exists() {
                return Ok(begun);
            }
        }
        Err(io::Error::other("another program removes what is begun there"))
    }

    /// Gives the file a name.
    ///
    /// # Arguments
    /// * `path` - the name
    /// * `persist` - whether a file that has the name is replaced, or refused
    pub fn persist(self, path: &Path, persist: Persist) -> io::Result<()> {
        let Self { file, own_path } = self;
        let held = own();
        let named = persist(file, path).map(drop).map_err(|error| error.error);
        drop(held);
        drop(own_path);
        named
    }
}

/// A place that this program has for itself, until it is dropped or the program ends.
#[derive(Debug)]
#[must_use = "dropped, the place is anybody's"]
pub struct Claim {
    own_path: OwnPath,
    // Unlocked after it has been removed.
    _file: File,
}

impl Claim {
    /// Claims a place; none where another program has it.
    ///
    /// # Arguments
    /// * `directory` - an existing directory
    /// * `what` - of what is done there, a word for a file's name
    ///
    /// # Errors
    /// The directory cannot be written to.
    ///
    /// ```
    /// use meshtone_io::own_file::Claim;
    ///
    /// let directory = tempfile::tempdir()?;
    /// let first = Claim::take(directory.path(), "results")?;
    /// assert!(first.is_some() && Claim::take(directory.path(), "results")?.is_none());
    /// drop(first);
    /// assert!(Claim::take(directory.path(), "results")?.is_some());
    /// # Ok::<(), std::io::Error>(())
    /// ```
    pub fn take(directory: &Path, what: &str) -> io::Result<Option<Self>> {
        let path = directory.join(format!("{PREFIX}{what}"));
        for _ in 0..TRIES {
            let mut held = own();
            if held.contains(&path) {
                return Ok(None);
            }
            let file = File::options().create(true).truncate(false).write(true).open(&path)?;
            if !is_taken(&file) && is_at(&file, &path) {
                held.insert(path.clone());
                return Ok(Some(Self { own_path: OwnPath(path), _file: file }));
            }
            drop(held);
            // Who clears up has it for a moment only.
            sleep(CLEARING);
        }
        Ok(None)
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // What cannot be removed is left behind, unlocked, and cleared away by the next program.
        let _ = fs::remove_file(&self.own_path.0);
    }
}

/// A directory that disappears again, dropped, if it is empty.
#[derive(Debug)]
#[must_use = "dropped, an empty directory disappears"]
pub struct NewDirectory(OwnPath);

impl NewDirectory {
    /// Creates a directory and those that it is in, as far as there are none.
    ///
    /// # Arguments
    /// * `path` - the directory
    ///
    /// # Errors
    /// One of them cannot be created; those that were are removed again.
    ///
    /// Returns the new ones, innermost first.
    pub fn create_all(path: &Path) -> io::Result<Vec<Self>> {
        let missing = path.ancestors().filter(|part| !part.as_os_str().is_empty());
        let missing: Vec<&Path> = missing.take_while(|part| !part.exists()).collect();
        let new = missing.iter().map(|part| Self(OwnPath(part.to_path_buf()))).collect();
        // A signal to end the program is not to come between the two.
        let mut held = own();
        held.extend(missing.iter().map(|part| part.to_path_buf()));
        let created = create_directories(path);
        drop(held);
        created.map(|()| new)
    }
}

/// Creates a directory and those that it is in, as far as there are none.
///
/// # Arguments
/// * `path` - the directory
///
/// # Errors
/// One of them cannot be created.
pub fn create_directories(path: &Path) -> io::Result<()> {
    fs::create_dir_all(path).map_err(|error| io::Error::new(refusal(&error), error.to_string()))
}

/// Why something cannot be created in a directory that exists: where the system finds nothing, as in `/proc`, writing is not allowed.
pub(crate) fn refusal(error: &io::Error) -> io::ErrorKind {
    match error.kind() {
        io::ErrorKind::NotFound => io::ErrorKind::PermissionDenied,
        kind => kind,
    }
}

impl Drop for NewDirectory {
    fn drop(&mut self) {
        // What is not empty stays.
        let _ = fs::remove_dir(&self.0.0);
    }
}

/// Removes what killed programs have left in a directory. What cannot be removed stays, and so does what runs.
///
/// # Arguments
/// * `directory` - the directory; folders in it are left alone
pub fn remove_leftovers(directory: &Path) {
    for entry in fs::read_dir(directory).into_iter().flatten().flatten() {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file && entry.file_name().to_string_lossy().starts_with(PREFIX) {
            let _ = remove_left(&entry.path());
        }
    }
}

/// Removes what killed programs have left, before this one writes there for the first time.
fn clear_up_once(directory: &Path) {
    static CLEARED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

    if CLEARED.lock().unwrap_or_else(PoisonError::into_inner).insert(directory.to_path_buf()) {
        remove_leftovers(directory);
    }
}

fn remove_left(path: &Path) -> io::Result<()> {
    // Under its lock, so that no other program takes it meanwhile. Some network file systems lock only what may be written to.
    let file = File::options().write(true).open(path)?;
    if file.try_lock().is_ok() { fs::remove_file(path) } else { Ok(()) }
}

/// Removes all files of this program that have no name yet, and the new directories that are empty, and lets it neither begin nor
/// name any more. It is for a program that receives a signal to end.
///
/// The calling thread must end the program; any other thread that begins or names a file waits for ever.
pub fn remove_own() {
    std::mem::forget(UNDISTURBED.write().unwrap_or_else(PoisonError::into_inner));
    let own = own();
    own.iter().for_each(|path| drop(fs::remove_file(path)));
    // A directory that is in another comes after it in the set.
    own.iter().rev().for_each(|path| drop(fs::remove_dir(path)));
    std::mem::forget(own);
}

/// Held while something is done that is not to be left halfway.
static UNDISTURBED: RwLock<()> = RwLock::new(());

/// Does what takes a moment and is not to be left halfway where the program receives a signal to end, such as to name files that belong
/// together.
///
/// # Arguments
/// * `work` - what; it does not call this function itself
pub fn undisturbed<T>(work: impl FnOnce() -> T) -> T {
    let _held = UNDISTURBED.read().unwrap_or_else(PoisonError::into_inner);
    work()
}

/// Locks a file, where its file system has locks, unless another program has locked it. Returns whether one has.
fn is_taken(file: &File) -> bool {
    matches!(file.try_lock(), Err(TryLockError::WouldBlock))
}

/// Whether an open file is still the one of that name.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;

    let [here, there] =
        [file.metadata(), fs::metadata(path)].map(|it| it.map(|it| (it.dev(), it.ino())).ok());
    here.is_some() && here == there
}

/// Whether an open file is still the one of that name: without a number to compare, whether there is one.
#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}

/// Temporary files are private by default; a result is to have the permissions of any new file.
fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder
}
