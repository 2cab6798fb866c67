//! Scenarios.

use std::path::PathBuf;

use meshtone::scenario::{self, GearboxRig, ProfileErrors, ScenarioError, ScenarioWarning, ScenarioWheel};
use meshtone::sensor::{Channel, Sensor};
use meshtone::signal::TrainWheel;
use meshtone::wheel::ErrorTable;
use meshtone_io::memory;
use meshtone_io::scenario_file::ScenarioFile;
use numpy::{PyArray2, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::matrix;
use crate::error::{read_error, scenario_error, value_error};
use crate::process::train;
use crate::value::table;

/// Name, tooth count, (mm) face width, (Hz) nominal speed, (rev) angle where that of its shaft is 0.
type StatedWheel = (String, u32, f64, f64, f64);

/// A scenario as the library has it.
#[pyclass(frozen, eq, module = "meshtone._core")]
#[derive(Clone, PartialEq)]
pub struct Scenario(pub scenario::Scenario);

#[pymethods]
impl Scenario {
    /// From the sections of a scenario file, of either form.
    #[new]
    #[pyo3(signature = (sections, pinion_profile_errors_mm=None, gear_profile_errors_mm=None))]
    fn new(
        sections: &Bound<'_, PyDict>,
        pinion_profile_errors_mm: Option<PyReadonlyArray2<'_, f64>>,
        gear_profile_errors_mm: Option<PyReadonlyArray2<'_, f64>>,
    ) -> PyResult<Self> {
        let text = table(sections)?.to_string();
        let mut scenario = scenario::Scenario::from_toml(&text).map_err(without_line)?;
        match (pinion_profile_errors_mm, gear_profile_errors_mm) {
            (Some(pinion), Some(gear)) => {
                for (wheel, errors) in scenario.wheels.iter_mut().zip([pinion, gear]) {
                    wheel.profile_errors_mm = Some(error_table(&errors));
                }
                scenario.validate().map_err(|error| scenario_error(&error))?;
            }
            (None, None) => {}
            _ => {
                return Err(value_error(
                    "pinion_profile_errors_mm and gear_profile_errors_mm belong together: give both or neither",
                ));
            }
        }
        Ok(Self(scenario))
    }

    /// From the text of a scenario file, of either form.
    #[staticmethod]
    fn from_toml(text: &str) -> PyResult<Self> {
        scenario::Scenario::from_toml(text).map(Self).map_err(|error| scenario_error(&error))
    }

    /// From a scenario file, of either form, and the files that it names.
    #[staticmethod]
    fn from_file(path: PathBuf) -> PyResult<Self> {
        let file = ScenarioFile::read(&path).map_err(|error| read_error(&path, &error))?;
        Ok(Self(file.scenario))
    }

    /// Whether it is of one pair in a rig.
    #[getter]
    fn is_pair(&self) -> bool {
        self.0.rig().is_some()
    }

    /// The name of the channel that is looked at first.
    fn leading_channel(&self) -> String {
        Channel::leading(&self.0.all_sensors()).name().into_owned()
    }

    /// The names of the channels of its sensors: of the listed ones, or of shafts of beams without any those on the bearings' seats.
    fn sensor_channels(&self) -> Vec<String> {
        self.0.all_sensors().iter().map(Sensor::channel).collect()
    }

    /// What is stated of each wheel.
    fn wheels(&self) -> PyResult<Vec<StatedWheel>> {
        let train = train(self)?;
        let wheel = |(of, stated): (TrainWheel, &ScenarioWheel)| {
            let speed_hz = train.shafts[of.shaft].speed_ratio.value() * self.0.operation.pinion_speed_hz;
            (of.name, of.teeth, stated.face_width_mm, speed_hz, of.start_rev)
        };
        Ok(train.wheels.iter().cloned().zip(&self.0.wheels).map(wheel).collect())
    }

    /// Of each mesh its name and the names of its driving and its driven wheel.
    fn meshes(&self) -> Vec<(String, Vec<String>)> {
        self.0.meshes.iter().map(|mesh| (mesh.name(), mesh.wheels.to_vec())).collect()
    }

    /// The text of a scenario file.
    fn to_toml(&self) -> String {
        meshtone::written_out(&self.0.to_toml())
    }

    /// The sections with all their keys, defaults included, but for the profile errors.
    fn sections<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut small = self.0.clone();
        if self.is_pair() {
            small.wheels.iter_mut().for_each(|wheel| wheel.profile_errors_mm = None);
        }
        // Python's reader of JSON makes all the values at once; the numbers stay what they are.
        let json = serde_json::to_string(&small).map_err(value_error)?;
        Ok(py.import("json")?.call_method1("loads", (json,))?.cast_into()?)
    }

    /// The names of its simulation's channels, sensors first.
    fn channels(&self) -> Vec<String> {
        self.0.signals().iter().map(|signal| signal.name.to_string()).collect()
    }

    /// Pinion's and gear's profile errors, where they were given.
    fn profile_errors_mm<'py>(&self, py: Python<'py>) -> PyResult<Option<BothWheels<'py>>> {
        self.0.quality().profile_errors.as_ref().map(|errors| both_wheels(py, errors)).transpose()
    }

    /// Severity of each fault, from 0 to 1.
    fn fault_severities(&self) -> PyResult<Vec<f64>> {
        self.0.fault_severities().map_err(|error| scenario_error(&error))
    }

    /// Returns the scenario with the sizes of every fault that was given by its severity.
    fn with_own_sizes(&self) -> PyResult<Self> {
        self.0.with_own_sizes().map(Self).map_err(|error| scenario_error(&error))
    }

    /// Warnings about it, as far as they can be known before the time loop.
    fn warnings(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let checked = py.detach(|| meshtone::stages_and_warnings(&self.0, memory::limit()));
        let (_, warnings) = checked.map_err(|error| scenario_error(&error))?;
        Ok(warnings.iter().map(ToString::to_string).collect())
    }
}

/// Warnings as sentences, and the subject of each.
pub fn in_words(warnings: &[ScenarioWarning]) -> (Vec<String>, Vec<&'static str>) {
    warnings.iter().map(|warning| (warning.to_string(), warning.kind.code())).unzip()
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

/// A scenario file of a kind of fault, or `healthy`, with the keys that matter or with all.
#[pyfunction]
pub fn template(kind: &str, all_keys: bool) -> PyResult<String> {
    let text = if all_keys { scenario::template_of_all_keys(kind) } else { scenario::template(kind) };
    text.ok_or_else(|| {
        value_error(format!("kind = {kind}: must be one of {}", scenario::template_kinds().join(", ")))
    })
}

/// The error without the line: the text was made from Python's values.
fn without_line(error: ScenarioError) -> PyErr {
    scenario_error(&error.at_line(None))
}

fn error_table(array: &PyReadonlyArray2<'_, f64>) -> ErrorTable {
    let [rows, columns] = [array.shape()[0], array.shape()[1]];
    let view = array.as_array();
    ErrorTable::from_fn(rows, columns, |row, column| view[[row, column]])
}

/// An array each of the pinion and the gear.
pub type BothWheels<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>);

/// Profile errors of both wheels, a column a tooth.
pub fn both_wheels<'py>(py: Python<'py>, errors: &ProfileErrors) -> PyResult<BothWheels<'py>> {
    Ok((rows(py, &errors.pinion_profile_errors_mm)?, rows(py, &errors.gear_profile_errors_mm)?))
}

/// A matrix as NumPy has it, rows first.
fn rows<'py>(py: Python<'py>, errors: &ErrorTable) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let (points, teeth) = (errors.points(), errors.teeth());
    let values: Vec<f64> = (0..points * teeth).map(|n| errors[(n / teeth, n % teeth)]).collect();
    matrix(py, values, [points, teeth])
}
