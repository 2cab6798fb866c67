//! The server: this machine alone, and its own page alone.

mod diagnosis;
mod files;
mod guard;
mod latest;
mod requests;
#[cfg(test)]
mod tests;

use std::net::{Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

#[cfg(fuzzing)]
pub use requests::read_request;

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use meshtone::scenario::Scenario;
use meshtone_diagnose::ReferenceStore;
use tokio::net::TcpListener;
use tokio::sync::{Semaphore, oneshot};

use crate::answer::HealthyIndicators;
use guard::Guard;
use latest::NewestRequests;

/// Requests that are computed at once: one for what is seen, one for what is compared with it.
const AT_ONCE: usize = 2;
/// Bytes of the token in the address.
const TOKEN_BYTES: usize = 16;

/// A connection may wait so long for the head of its next request.
const IDLE: Duration = if cfg!(test) { Duration::from_millis(500) } else { Duration::from_secs(30) };
/// Nothing is accepted for so long once accepting has failed.
const AFTER_FAILURE: Duration = Duration::from_millis(100);

/// Whether another page may show this one in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Embedding {
    /// None may.
    #[default]
    Refused,
    /// A notebook of this machine may.
    Notebook,
}

/// Settings by which the page is served.
#[derive(Debug, Clone, PartialEq)]
pub struct ServerSettings {
    /// The scenario that the page opens with: a pair or a gearbox, which have pages of their own.
    pub scenario: Scenario,
    /// The port; 0 for any that is free.
    pub port: u16,
    /// Whether a notebook may show it.
    pub embedding: Embedding,
    /// Where the simulations of diagnoses are kept, as [`ReferenceStore::default_folder`]; none where nothing is diagnosed.
    pub reference: Option<PathBuf>,
}

/// A page that is served, until it is dropped.
#[derive(Debug)]
pub struct Server {
    address: SocketAddr,
    token: String,
    shared: Arc<Shared>,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

/// State that all requests share.
#[derive(Debug)]
struct Shared {
    /// Scenario with which the page opens.
    start: Scenario,
    /// The scenario on the page: the last scenario that was answered in full.
    current: Mutex<Scenario>,
    /// The newest request of each page.
    latest: NewestRequests,
    /// Room for computations.
    room: Arc<Semaphore>,
    /// The gears without damage that were computed last, and for what.
    healthy: Mutex<Option<(String, HealthyIndicators)>>,
    /// Room for one diagnosis at a time.
    room_of_diagnosis: Arc<Semaphore>,
    /// Where their simulations are kept.
    reference: Option<ReferenceStore>,
}

impl Server {
    /// Serves a page on 127.0.0.1, in a thread of its own.
    ///
    /// # Arguments
    /// * `settings` - what, and where
    ///
    /// # Errors
    /// The port cannot be had; no random numbers for the address; no thread.
    ///
    /// ```
    /// use meshtone::scenario::{Scenario};
    /// use meshtone_explore::{Embedding, Server, ServerSettings, presets};
    ///
    /// let scenario = Scenario::from_toml(presets()[0].toml)?;
    /// let settings =
    ///     ServerSettings { scenario: scenario.clone(), port: 0, embedding: Embedding::Refused, reference: None };
    /// let server = Server::start(settings)?;
    /// assert!(server.url().starts_with("http://127.0.0.1:"));
    /// assert_eq!(server.scenario(), scenario);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn start(settings: ServerSettings) -> std::io::Result<Self> {
        let ServerSettings { scenario, port, embedding, reference } = settings;
        let token = random_token()?;
        let listener = std::net::TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        let shared = Arc::new(Shared {
            start: scenario.clone(),
            current: Mutex::new(scenario),
            latest: NewestRequests::default(),
            room: Arc::new(Semaphore::new(AT_ONCE)),
            healthy: Mutex::new(None),
            room_of_diagnosis: Arc::new(Semaphore::new(1)),
            reference: reference.map(ReferenceStore::new),
        });
        let guard = Guard::new(address.port(), &token, embedding);
        let router = guard.protect(requests::router(Arc::clone(&shared)).merge(files::router(&shared.start)));
        // What needs the runtime is made before the thread, so that its failure is reported.
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .max_blocking_threads(2 * AT_ONCE)
            .build()?;
        let listener = {
            let _entered = runtime.enter();
            TcpListener::from_std(listener)?
        };
        let (stop, stopped) = oneshot::channel();
        let work = move || {
            // Neither waits for requests that are still open.
            runtime.block_on(serve(listener, router, stopped));
            runtime.shutdown_background();
        };
        let thread = std::thread::Builder::new().name("explore".to_owned()).spawn(work)?;
        Ok(Self { address, token, shared, stop: Some(stop), thread: Some(thread) })
    }

    /// The page's address, with the token that its requests need.
    pub fn url(&self) -> String {
        format!("http://{}/{}/", self.address, self.token)
    }

    /// The scenario on the page: the last scenario that it was answered in full, or the one that it opens with.
    pub fn scenario(&self) -> Scenario {
        self.shared.current.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Waits until the page is no longer served.
    pub fn wait(mut self) {
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has ended too.
            let _ = thread.join();
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        if let Some(stop) = self.stop.take() {
            let _ = stop.send(());
        }
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

async fn serve(listener: TcpListener, router: Router, stopped: oneshot::Receiver<()>) {
    tokio::select! {
        never = accept(listener, router) => never,
        _ = stopped => {}
    }
}

/// Serves connections, each by itself: what one suffers is its own. `axum::serve` sets no time after which idle ones are closed.
async fn accept(listener: TcpListener, router: Router) {
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            // As where there are too many files open: some will be closed.
            tokio::time::sleep(AFTER_FAILURE).await;
            continue;
        };
        let service = TowerToHyperService::new(router.clone());
        let mut connection = http1::Builder::new();
        connection.timer(TokioTimer::new()).header_read_timeout(IDLE);
        tokio::spawn(connection.serve_connection(TokioIo::new(stream), service));
    }
}

fn random_token() -> std::io::Result<String> {
    let mut bytes = [0; TOKEN_BYTES];
    getrandom::fill(&mut bytes).map_err(|error| std::io::Error::other(error.to_string()))?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}
