//! A data set in an object store.

use std::fmt;
use std::fs::File;
use std::future::Future;
use std::io::{self, Read, Seek};
use std::sync::Arc;

use futures::StreamExt;
use object_store::path::Path;
use object_store::{ObjectStore, ObjectStoreExt, PutPayload};

use super::remote_file::RemoteFile;
use super::{Files, Storage};
use crate::shard::{self, ReadShard, Wanted};

/// (bytes) Objects that are larger are uploaded in parts of this size.
const PART_BYTES: u64 = 8 << 20;

/// The objects of a store whose names begin with a prefix.
#[derive(Debug)]
pub(super) struct Objects {
    pub store: Arc<dyn ObjectStore>,
    pub prefix: Path,
}

impl Objects {
    fn location(&self, name: &str) -> Path {
        let parts = name.split('/').filter(|part| !part.is_empty());
        parts.fold(self.prefix.clone(), |path, part| path.join(part))
    }

    fn file(&self, name: &str) -> io::Result<RemoteFile> {
        let path = self.location(name);
        let length = wait(async { Ok(self.store.head(&path).await?.size) })?;
        Ok(RemoteFile { store: self.store.clone(), path, length, position: 0 })
    }

    fn upload_parts(&self, path: &Path, file: File) -> io::Result<()> {
        let mut upload = wait(self.store.put_multipart(path))?;
        let sent = (|| {
            loop {
                let mut bytes = Vec::new();
                Read::take(&file, PART_BYTES).read_to_end(&mut bytes)?;
                if bytes.is_empty() {
                    return wait(upload.complete()).map(|_| ());
                }
                wait(upload.put_part(PutPayload::from(bytes)))?;
            }
        })();
        if sent.is_err() {
            // Parts that stay behind cost money. If aborting fails too, the store removes them after some time.
            let _ = wait(upload.abort());
        }
        sent
    }
}

impl Storage for Objects {
    fn files(&self) -> io::Result<Files> {
        wait(async {
            let mut listed = self.store.list(Some(&self.prefix));
            let mut files = Files::new();
            while let Some(object) = listed.next().await {
                let object = object?;
                let parts = object.location.prefix_match(&self.prefix);
                let parts: Vec<String> =
                    parts.into_iter().flatten().map(|part| part.as_ref().to_owned()).collect();
                files.insert(parts.join("/"), object.size);
            }
            Ok(files)
        })
    }

    fn open(&self, name: &str) -> io::Result<Box<dyn Read + '_>> {
        Ok(Box::new(self.file(name)?))
    }

    fn shard(&self, name: &str, wanted: Wanted) -> io::Result<ReadShard> {
        shard::read(self.file(name)?, wanted)
    }

    /// Writes to a temporary file on this machine first and then uploads it, so that large objects need not be held in memory.
    fn write(&self, name: &str, content: &mut dyn FnMut(&mut File) -> io::Result<()>) -> io::Result<()> {
        let mut file = tempfile::tempfile()?;
        content(&mut file)?;
        let length = file.stream_position()?;
        file.rewind()?;
        let path = self.location(name);
        if length > PART_BYTES {
            return self.upload_parts(&path, file);
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        wait(async { self.store.put(&path, PutPayload::from(bytes)).await.map(|_| ()) })
    }

    fn name_of(&self, name: &str) -> String {
        format!("{self}/{name}")
    }
}

impl fmt::Display for Objects {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}/{}", self.store, self.prefix)
    }
}

/// Waits for an operation of an object store.
#[cfg(not(feature = "cloud"))]
pub(super) fn wait<T>(operation: impl Future<Output = object_store::Result<T>>) -> io::Result<T> {
    futures::executor::block_on(operation).map_err(into_io)
}

/// Waits for an operation of an object store, whose connections live in a runtime of their own.
#[cfg(feature = "cloud")]
pub(super) fn wait<T>(operation: impl Future<Output = object_store::Result<T>>) -> io::Result<T> {
    use std::sync::OnceLock;
    use tokio::runtime::{Builder, Runtime};

    static RUNTIME: OnceLock<io::Result<Runtime>> = OnceLock::new();
    let runtime = RUNTIME.get_or_init(|| Builder::new_multi_thread().worker_threads(1).enable_all().build());
    match runtime {
        Ok(runtime) => runtime.block_on(operation).map_err(into_io),
        Err(error) => Err(io::Error::new(error.kind(), error.to_string())),
    }
}

fn into_io(error: object_store::Error) -> io::Error {
    let kind = match &error {
        object_store::Error::NotFound { .. } => io::ErrorKind::NotFound,
        object_store::Error::PermissionDenied { .. } | object_store::Error::Unauthenticated { .. } => {
            io::ErrorKind::PermissionDenied
        }
        _ => io::ErrorKind::Other,
    };
    io::Error::new(kind, error)
}
