//! A page on which a scenario is changed and seen.

use std::sync::{Mutex, PoisonError};

use meshtone_diagnose::ReferenceStore;
use meshtone_explore::{Embedding, Server, ServerSettings};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;

use crate::scenario::Scenario;

/// A page that is served in a thread of its own, which never needs the interpreter.
#[pyclass(frozen, module = "meshtone._core")]
pub struct ExploreServer {
    served: Mutex<Served>,
}

/// The server, or the last scenario of one that was closed.
enum Served {
    Now(Server),
    Before(Box<meshtone::scenario::Scenario>),
}

#[pymethods]
impl ExploreServer {
    /// Serves a page; port 0 is any that is free.
    #[new]
    fn new(scenario: &Scenario, port: u16, in_notebook: bool) -> PyResult<Self> {
        let embedding = if in_notebook { Embedding::Notebook } else { Embedding::Refused };
        let scenario = scenario.0.clone();
        let reference = ReferenceStore::default_folder();
        let settings = ServerSettings { scenario, port, embedding, reference };
        let server = Server::start(settings).map_err(|error| {
            PyOSError::new_err(format!("port = {port}: cannot serve a page there: {error}"))
        })?;
        Ok(Self { served: Mutex::new(Served::Now(server)) })
    }

    /// The page's address; none where it is no longer served.
    #[getter]
    fn url(&self) -> Option<String> {
        match &*self.served.lock().unwrap_or_else(PoisonError::into_inner) {
            Served::Now(server) => Some(server.url()),
            Served::Before(_) => None,
        }
    }

    /// The scenario on the page, or the last one.
    #[getter]
    fn scenario(&self) -> Scenario {
        match &*self.served.lock().unwrap_or_else(PoisonError::into_inner) {
            Served::Now(server) => Scenario(server.scenario()),
            Served::Before(scenario) => Scenario((**scenario).clone()),
        }
    }

    /// Serves it no longer.
    fn close(&self, py: Python<'_>) {
        py.detach(|| {
            let mut served = self.served.lock().unwrap_or_else(PoisonError::into_inner);
            if let Served::Now(server) = &*served {
                *served = Served::Before(Box::new(server.scenario()));
            }
        });
    }
}
