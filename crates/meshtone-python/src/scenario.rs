//! Scenarios.

use std::path::PathBuf;

use meshtone::scenario::{self, ProfileErrors, ScenarioError};
use meshtone::wheel::ErrorTable;
use meshtone_io::memory;
use meshtone_io::scenario_file::ScenarioFile;
use numpy::{PyArray2, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::matrix;
use crate::error::{read_error, scenario_error, value_error};
use crate::value::table;

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

    /// From the text of a scenario file, of one pair or of a gearbox.
    #[staticmethod]
    fn from_toml(text: &str, of_pair: bool) -> PyResult<Self> {
        let read = if of_pair {
            scenario::Scenario::pair_from_toml(text)
        } else {
            scenario::Scenario::from_toml(text)
        };
        let this = read.map(Self).map_err(|error| scenario_error(&error))?;
        match this.other_form(of_pair, "from_toml") {
            Some(problem) => Err(value_error(problem)),
            None => Ok(this),
        }
    }

    /// From a scenario file, and the files that it names, of one pair or of a gearbox.
    #[staticmethod]
    fn from_file(path: PathBuf, of_pair: bool) -> PyResult<Self> {
        let read = if of_pair { ScenarioFile::read_pair(&path) } else { ScenarioFile::read(&path) };
        let file = read.map_err(|error| read_error(&path, &error))?;
        let this = Self(file.scenario);
        match this.other_form(of_pair, "from_file") {
            Some(problem) => Err(value_error(format!("{}: {problem}", path.display()))),
            None => Ok(this),
        }
    }

    /// Whether a scenario file's text is of a gearbox.
    #[staticmethod]
    fn is_of_gearbox(text: &str) -> PyResult<bool> {
        scenario::Scenario::is_long_form(text).map_err(|error| scenario_error(&error))
    }

    /// Whether it is of one pair.
    #[getter]
    fn is_pair(&self) -> bool {
        self.0.rig().is_some()
    }

    /// The name of the channel of its first sensor.
    fn leading_channel(&self) -> String {
        self.0.leading_channel()
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

impl Scenario {
    /// The scenario, where it has the form that is asked for.
    fn other_form(&self, of_pair: bool, constructor: &str) -> Option<String> {
        let is_other = self.is_pair() != of_pair;
        is_other.then(|| format!("is of one pair of gears; Scenario.{constructor} reads it"))
    }
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
