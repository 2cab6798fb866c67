//! What the fuzz targets have in common: wrong input for every reader ([`readers`]), and laws that hold for whatever is right ([`laws`]).
//!
//! ```sh
//! cargo xtask fuzz                            # five minutes, shared by all targets
//! cargo xtask fuzz --minutes 1 --target hdf5  # one of them alone
//! ```
//!
//! Coverage guides what is tried: an input that reaches new code is kept and changed further. A target fails where it panics, takes too
//! much time or memory, or breaks a law; the input is kept then.

pub mod laws;
pub mod readers;

use std::backtrace::Backtrace;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock};

use meshtone::scenario::MemoryLimit;

/// (bytes) What a reader is allowed; buffers stand beside it.
const LIMIT_BYTES: u64 = 256 << 20;

/// Does what a target does with an input. Panics that a reader catches itself, those of other libraries' decoders, are none of its own.
fn guarded(target: impl FnOnce()) {
    static SAID: Mutex<String> = Mutex::new(String::new());
    static PREPARED: OnceLock<()> = OnceLock::new();
    PREPARED.get_or_init(|| {
        MemoryLimit::set(Some(LIMIT_BYTES));
        // One thread: other targets run beside this one.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(1).build_global();
        std::panic::set_hook(Box::new(|panic| {
            *SAID.lock().unwrap() = format!("{panic}\n{}", Backtrace::capture())
        }));
    });
    if catch_unwind(AssertUnwindSafe(target)).is_err() {
        eprintln!("{}", SAID.lock().unwrap());
        std::process::abort();
    }
}

/// The folder in which inputs stand as files while they are read.
fn folder() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = std::env::temp_dir().join(format!("meshtone-fuzz-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        folder
    })
}

/// Writes an input, or what a reader looks for beside it.
///
/// # Arguments
/// * `name` - of the file, in the [folder] of this run
fn written(name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder().join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(&path, bytes).unwrap();
    path
}
