//! Gearboxes.

use std::path::PathBuf;

use meshtone::StepJudgement;
use meshtone::batch::simulate_many_gearboxes;
use meshtone::scenario::{self, GearboxRig, ScenarioForm, ScenarioWarning};
use meshtone_io::memory;
use meshtone_io::run_identity::RunIdentity;
use meshtone_io::scenario_file::ScenarioFile;
use meshtone_io::signals::SignalTable;
use meshtone_io::summary::Summary;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::named_arrays;
use crate::batch::Batch;
use crate::error::{read_error, scenario_error, simulation_error, value_error};
use crate::signals_file::write;
use crate::simulation::{fields, simulated};
use crate::value::table;

/// A gearbox as the library has it.
#[pyclass(frozen, eq, module = "meshtone._core")]
#[derive(Clone, PartialEq)]
pub struct Gearbox(pub scenario::Gearbox);

#[pymethods]
impl Gearbox {
    /// From the sections of a scenario file.
    #[new]
    fn new(sections: &Bound<'_, PyDict>) -> PyResult<Self> {
        let text = table(sections)?.to_string();
        let read = scenario::Gearbox::from_toml(&text);
        read.map(Self).map_err(|error| scenario_error(&error.at_line(None)))
    }

    /// From the text of a scenario file.
    #[staticmethod]
    fn from_toml(text: &str) -> PyResult<Self> {
        scenario::Gearbox::from_toml(text).map(Self).map_err(|error| scenario_error(&error))
    }

    /// From a scenario file, and the files that it names.
    #[staticmethod]
    fn from_file(path: PathBuf) -> PyResult<Self> {
        let file = ScenarioFile::read_form(&path).map_err(|error| read_error(&path, &error))?;
        match file.scenario {
            ScenarioForm::Gearbox(gearbox) => Ok(Self(gearbox)),
            _ => Err(value_error(format!(
                "{}: is of one pair of gears; Scenario.from_file reads it",
                path.display()
            ))),
        }
    }

    /// Whether a scenario file's text is of a gearbox.
    #[staticmethod]
    fn is_written_in(text: &str) -> PyResult<bool> {
        scenario::Gearbox::is_written_in(text).map_err(|error| scenario_error(&error))
    }

    /// The name of the channel of its first sensor.
    fn leading_channel(&self) -> String {
        self.0.leading_channel()
    }

    /// The text of a scenario file.
    fn to_toml(&self) -> String {
        meshtone::written_out(&self.0.to_toml())
    }

    /// The sections with all their keys, defaults included.
    fn sections<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let sections: toml::Table = self.0.to_toml().parse().map_err(value_error)?;
        let json = serde_json::to_string(&sections).map_err(value_error)?;
        Ok(py.import("json")?.call_method1("loads", (json,))?.cast_into()?)
    }

    /// Warnings about it, as far as they can be known before the time loop.
    fn warnings(&self) -> PyResult<Vec<String>> {
        let warnings = self.0.validate_within(memory::limit()).map_err(|error| scenario_error(&error))?;
        Ok(warnings.iter().map(ToString::to_string).collect())
    }
}

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
pub fn simulate_gearbox(py: Python<'_>, gearbox: &Gearbox) -> PyResult<GearboxSimulation> {
    let (simulation, warnings) = simulated(py, &gearbox.0)?;
    GearboxSimulation::new(py, simulation, warnings)
}

/// Simulates gearboxes, none a second time; the error of one stands in its place. Where the first error is that of all, what has not begun is
/// left out then.
#[pyfunction]
pub fn simulate_gearboxes<'py>(
    py: Python<'py>,
    gearboxes: Vec<PyRef<'py, Gearbox>>,
    threads: Option<usize>,
    stop_at_error: bool,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Vec<Py<PyAny>>> {
    let gearboxes: Vec<scenario::Gearbox> = gearboxes.iter().map(|gearbox| gearbox.0.clone()).collect();
    let estimated = |_: usize, of: meshtone::Simulation| {
        let warnings = [of.stages.warnings(), of.warnings_of_signals(StepJudgement::Estimated)].concat();
        (of, warnings)
    };
    let batch = Batch { all: gearboxes.len(), threads, stop_at_error };
    let results = batch.run(py, progress, |control, take| {
        simulate_many_gearboxes(gearboxes, &estimated, control, take);
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
