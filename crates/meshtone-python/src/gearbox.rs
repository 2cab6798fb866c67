//! Gearboxes.

use std::path::PathBuf;

use meshtone::StepJudgement;
use meshtone::batch::{KeepOf, simulate_many};
use meshtone::scenario::{self, GearboxRig, ScenarioWarning};
use meshtone_io::run_identity::RunIdentity;
use meshtone_io::signals::SignalTable;
use meshtone_io::summary::Summary;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::named_arrays;
use crate::batch::Batch;
use crate::error::{simulation_error, value_error};
use crate::scenario::Scenario;
use crate::signals_file::write;
use crate::simulation::{fields, simulated};

/// A simulation of a gearbox.
#[pyclass(frozen, module = "meshtone._core")]
pub struct GearboxSimulation {
    simulation: meshtone::Simulation,
    /// The signals by their names.
    #[pyo3(get)]
    channels: Py<PyDict>,
    /// (S/s)
    #[pyo3(get)]
    sampling_rate_hz: f64,
    /// (s) Of the first kept sample.
    #[pyo3(get)]
    start_s: f64,
    all_warnings: Vec<ScenarioWarning>,
}

impl GearboxSimulation {
    fn new(
        py: Python<'_>,
        simulation: meshtone::Simulation,
        all_warnings: Vec<ScenarioWarning>,
    ) -> PyResult<Self> {
        Ok(Self {
            sampling_rate_hz: simulation.channels.sampling_rate_hz,
            start_s: simulation.channels.start_s,
            channels: named_arrays(py, simulation.channels.clone())?,
            all_warnings,
            simulation,
        })
    }
}

#[pymethods]
impl GearboxSimulation {
    /// Its warnings.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.all_warnings.iter().map(ToString::to_string).collect()
    }

    /// Subject of each warning.
    #[getter]
    fn warning_codes(&self) -> Vec<&'static str> {
        self.all_warnings.iter().map(|warning| warning.kind.code()).collect()
    }

    /// The content of summary.json.
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let simulation = &self.simulation;
        let summary = py.detach(|| {
            Summary::new(simulation, RunIdentity::of(&simulation.stages.scenario), &self.all_warnings)
        });
        let json = serde_json::to_string(&summary).map_err(value_error)?;
        Ok(py.import("json")?.call_method1("loads", (json,))?.cast_into()?)
    }

    /// Writes the signals in the format that the file's ending says.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let meshtone::Simulation { stages, channels, .. } = &self.simulation;
        py.detach(|| write(&path, &SignalTable::of_scenario(&stages.scenario, channels)))
    }

    /// Every stage's output by name.
    fn trace<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        fields(py, py.detach(|| meshtone::simulation_trace(&self.simulation)))
    }

    /// (Hz) Natural frequencies with other mesh stiffnesses in N/m.
    fn natural_frequencies_hz(
        &self,
        py: Python<'_>,
        mesh_stiffness_n_per_m: Option<Vec<f64>>,
    ) -> PyResult<Vec<f64>> {
        let stages = &self.simulation.stages;
        let stiffness = mesh_stiffness_n_per_m.unwrap_or_else(|| stages.mean_stiffness_n_per_m());
        let meshes = stages.meshes.len();
        if stiffness.len() != meshes {
            let given = stiffness.len();
            return Err(value_error(format!(
                "mesh_stiffness_n_per_m: has {given} numbers; must have {meshes}, one a mesh"
            )));
        }
        Ok(py.detach(|| stages.natural_frequencies_with_hz(&stiffness)))
    }
}

/// Simulates a gearbox; it is simulated a second time where its step is doubtful.
#[pyfunction]
pub fn simulate_gearbox(py: Python<'_>, gearbox: &Scenario) -> PyResult<GearboxSimulation> {
    let (simulation, warnings) = simulated(py, &gearbox.0)?;
    GearboxSimulation::new(py, simulation, warnings)
}

/// Simulates gearboxes, none a second time; the error of one stands in its place. Where the first error is that of all, what has not begun is
/// left out then.
#[pyfunction]
pub fn simulate_gearboxes<'py>(
    py: Python<'py>,
    gearboxes: Vec<PyRef<'py, Scenario>>,
    threads: Option<usize>,
    stop_at_error: bool,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Vec<Py<PyAny>>> {
    let gearboxes: Vec<scenario::Scenario> = gearboxes.iter().map(|gearbox| gearbox.0.clone()).collect();
    let estimated = KeepOf(|_: usize, of: meshtone::Simulation| {
        let warnings = [of.stages.warnings(), of.warnings_of_signals(StepJudgement::Estimated)].concat();
        (of, warnings)
    });
    let batch = Batch { all: gearboxes.len(), threads, stop_at_error };
    let results = batch.run(py, progress, |control, take| {
        simulate_many(gearboxes, &estimated, control, take);
    })?;
    let made = results.into_iter().map(|result| match result {
        Ok((simulation, warnings)) => {
            Ok(Py::new(py, GearboxSimulation::new(py, simulation, warnings)?)?.into_any())
        }
        Err(error) => Ok(simulation_error(&error).into_value(py).into_any()),
    });
    made.collect()
}

/// A commented gearbox, or what is published of a rig.
#[pyfunction]
#[pyo3(signature = (rig=None))]
pub fn gearbox_template(rig: Option<&str>) -> PyResult<String> {
    let Some(name) = rig else { return Ok(scenario::gearbox_template(None)) };
    let known = GearboxRig::ALL.into_iter().find(|rig| rig.name() == name);
    let names = GearboxRig::ALL.map(GearboxRig::name).join(", ");
    let known = known.ok_or_else(|| value_error(format!("rig = {name}: must be one of {names}")))?;
    Ok(scenario::gearbox_template(Some(known)))
}
