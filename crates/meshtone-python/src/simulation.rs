//! One simulation.

use std::num::NonZeroUsize;

use meshtone::damage::{DamageDescription, DamagedTooth, ToothPart};
use meshtone::scenario::{self, ScenarioWarning, ScenarioWheel};
use meshtone::sensor::{ContactFigures, SignalSource};
use meshtone::signal::{TrainRecording, TrainSettings, TrainTurning};
use meshtone::wheel::{WheelDeviations, WheelName};
use meshtone::{StageTime, Stages, StepJudgement, Trace};
use meshtone_io::memory;
use meshtone_io::run_identity::RunIdentity;
use meshtone_io::summary::Summary;
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::array::{Array, Signal, array, field, matrix, named_arrays, samples};
use crate::error::{scenario_error, simulation_error, value_error};
use crate::process::{record_parts, separation, train, train_parts};
use crate::scenario::{BothWheels, Scenario, both_wheels, in_words};
use crate::signals_file::named_channels;

/// Deflection, number of the first pair and the forces of the pairs.
type StaticMesh<'py> = (Array<'py>, i64, Bound<'py, PyArray2<f64>>);

/// A simulation: every stage's results and the signals.
#[pyclass(frozen, module = "meshtone._core")]
pub struct Simulation {
    stages: Stages,
    /// (S/s)
    #[pyo3(get)]
    sampling_rate_hz: f64,
    /// (s) Of the first kept sample.
    #[pyo3(get)]
    start_s: f64,
    /// The signals by their names, sensors first.
    #[pyo3(get)]
    channels: Py<PyDict>,
    /// (-) Part of the kept time in which the force of a mesh is negative: of the mesh in which it is largest.
    #[pyo3(get)]
    tension_fraction: f64,
    /// Of each mesh the contact of the teeth, where they part: (-) part of the time apart, (-) part of it with coast flanks in touch, how often
    /// these hit, (N) largest force.
    #[pyo3(get)]
    contact_figures: Option<Vec<(f64, f64, usize, f64)>>,
    all_warnings: Vec<ScenarioWarning>,
    timings: Vec<StageTime>,
    step_counts: [u64; 4],
}

/// Simulates a scenario, and collects all warnings; it is simulated a second time where its step is doubtful.
#[pyfunction]
pub fn simulate(py: Python<'_>, scenario: &Scenario) -> PyResult<Simulation> {
    let simulated = py.detach(|| {
        let (stages, mut warnings) = meshtone::stages_and_warnings(&scenario.0, memory::limit())?;
        let simulation = stages.simulate()?;
        warnings.extend(simulation.warnings_of_signals(StepJudgement::Repeated));
        Ok((simulation, warnings))
    });
    let (simulation, warnings) = simulated.map_err(|error| simulation_error(&error))?;
    Simulation::new(py, simulation, warnings)
}

/// Simulates a scenario and gives every stage's output by name.
#[pyfunction]
#[pyo3(signature = (scenario, average_rate_hz=None))]
pub fn trace<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    average_rate_hz: Option<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let traced = py.detach(|| match average_rate_hz {
        Some(rate) => meshtone::trace_at(&scenario.0, rate),
        None => meshtone::trace(&scenario.0),
    });
    let (_, trace) = traced.map_err(|error| simulation_error(&error))?;
    fields(py, trace)
}

/// The fields of a trace by their names.
fn fields(py: Python<'_>, trace: Trace) -> PyResult<Bound<'_, PyDict>> {
    let named = trace.fields.into_iter().map(|entry| Ok((entry.name.clone(), field(py, entry)?)));
    named.collect::<PyResult<Vec<_>>>()?.into_py_dict(py)
}

impl Simulation {
    fn new(
        py: Python<'_>,
        simulation: meshtone::Simulation,
        warnings: Vec<ScenarioWarning>,
    ) -> PyResult<Self> {
        let meshtone::Simulation { stages, channels, timings, step_counts, .. } = simulation;
        let of_mesh = |mesh| ContactFigures::of_force(channels.of(SignalSource::MeshForce(mesh)));
        let figures: Vec<ContactFigures> = (0..stages.pairs.len()).map(of_mesh).collect();
        let contact = |of: &ContactFigures| {
            (of.apart_fraction, of.back_flank_fraction, of.back_flank_hits, of.largest_force_n)
        };
        let teeth_part = stages.scenario.model.teeth_part();
        Ok(Self {
            contact_figures: teeth_part.then(|| figures.iter().map(contact).collect()),
            tension_fraction: figures.iter().map(|of| of.back_flank_fraction).fold(0.0, f64::max),
            sampling_rate_hz: channels.sampling_rate_hz,
            start_s: channels.start_s,
            channels: named_arrays(py, channels)?,
            all_warnings: warnings,
            timings,
            step_counts,
            stages,
        })
    }

    /// Each wheel's number, and the number of the first mesh that it is in with its side there.
    fn wheel(&self, name: &str) -> PyResult<(usize, usize, WheelName)> {
        let wheels = &self.stages.scenario.wheels;
        let number = wheels.iter().position(|wheel| wheel.name == name);
        let place = number.and_then(|number| Some((number, self.stages.layout.mesh_of(number)?)));
        let (number, (mesh, side)) = place.ok_or_else(|| no_wheel(&self.stages.scenario, name))?;
        Ok((number, mesh, side))
    }

    /// The damaged teeth of every wheel, with its name: as in the first mesh that it is in.
    fn damaged(&self) -> impl Iterator<Item = (&str, &DamagedTooth)> {
        let wheels = self.stages.scenario.wheels.iter().enumerate();
        wheels.flat_map(move |(number, wheel)| {
            let place = self.stages.layout.mesh_of(number).into_iter();
            place.flat_map(move |(mesh, side)| {
                let of_mesh = self.stages.pairs[mesh].damaged.iter();
                of_mesh.filter(move |alike| alike.wheel == side).map(|alike| (wheel.name.as_str(), alike))
            })
        })
    }
}

#[pymethods]
impl Simulation {
    /// The simulated scenario.
    #[getter]
    fn scenario(&self) -> Scenario {
        Scenario(self.stages.scenario.clone())
    }

    /// Its warnings.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        in_words(&self.all_warnings).0
    }

    /// Subject of each warning.
    #[getter]
    fn warning_codes(&self) -> Vec<&'static str> {
        in_words(&self.all_warnings).1
    }

    /// (s) Of the stages, by name.
    #[getter]
    fn computing_time_s(&self) -> Vec<(&'static str, f64)> {
        self.timings.iter().map(|stage| (stage.stage, stage.elapsed.as_secs_f64())).collect()
    }

    /// The content of summary.json.
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let scenario = &self.stages.scenario;
        let signals: Vec<(String, Signal<'py>)> = self.channels.bind(py).items().extract()?;
        let channels = named_channels(scenario, [self.sampling_rate_hz, self.start_s], &signals)?;
        let mut simulation = self.stages.clone().with_channels(channels);
        simulation.timings.clone_from(&self.timings);
        simulation.step_counts = self.step_counts;
        let summary = py.detach(|| Summary::new(&simulation, RunIdentity::of(scenario), &self.all_warnings));
        let json = serde_json::to_string(&summary).map_err(value_error)?;
        Ok(py.import("json")?.call_method1("loads", (json,))?.cast_into()?)
    }

    /// (Hz) Natural frequencies with other mesh stiffnesses in N/m.
    fn natural_frequencies_with_hz(
        &self,
        py: Python<'_>,
        mesh_stiffness_n_per_m: Vec<f64>,
    ) -> PyResult<Vec<f64>> {
        let (given, meshes) = (mesh_stiffness_n_per_m.len(), self.stages.meshes.len());
        if meshes == 0 {
            return Err(no_meshes());
        }
        if given != meshes {
            return Err(value_error(format!(
                "mesh_stiffness_n_per_m: has {given} numbers; must have {meshes}, one a mesh"
            )));
        }
        Ok(py.detach(|| self.stages.natural_frequencies_with_hz(&mesh_stiffness_n_per_m)))
    }

    /// The fields of a trace that belong to the stages before the time loop.
    fn fields<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        fields(py, meshtone::stage_trace(&self.stages))
    }

    /// (-) Mode shapes, a column each, normalised to unit modal mass.
    #[getter]
    fn mode_shapes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let shapes = self.stages.mode_shapes();
        let coordinates = shapes.first().map_or(0, Vec::len);
        let rows = (0..coordinates).flat_map(|coordinate| shapes.iter().map(move |shape| shape[coordinate]));
        matrix(py, rows.collect(), [coordinates, shapes.len()])
    }

    /// (N/mm) Stiffness of a mesh at every point of some pitches, on the grid of the published code under every model.
    fn mesh_stiffness_n_per_mm<'py>(
        &self,
        py: Python<'py>,
        mesh: usize,
        first_pitch: i64,
        pitches: i64,
    ) -> PyResult<Array<'py>> {
        let shown = first_pitch..first_pitch + pitches;
        let curves =
            self.stages.mesh_curves_on_coarse_grid(Some(shown)).map_err(|error| scenario_error(&error))?;
        Ok(array(py, curves.into_iter().nth(mesh).map_or_else(Vec::new, |curve| curve.stiffness_n_per_mm)))
    }

    /// A mesh at rest under a force: (m) deflection, number of the first pair, (N) each pair's force; not under `published`.
    fn static_mesh<'py>(
        &self,
        py: Python<'py>,
        mesh: usize,
        force_n: Option<f64>,
        pitches: (usize, usize),
        points_per_pitch: NonZeroUsize,
    ) -> PyResult<StaticMesh<'py>> {
        let meshes = self.stages.meshes_at(points_per_pitch).map_err(|error| scenario_error(&error))?;
        let at_rest = meshes.get(mesh).ok_or_else(no_meshes)?;
        let force_n = force_n.unwrap_or(self.stages.pairs[mesh].static_force_n);
        let at_rest = py.detach(|| at_rest.at_rest(force_n, pitches.0..pitches.1));
        let (rows, columns) = (at_rest.pair_force_n.len(), at_rest.deflection_m.len());
        let forces = matrix(py, at_rest.pair_force_n.concat(), [rows, columns])?;
        Ok((array(py, at_rest.deflection_m), at_rest.first_pair, forces))
    }

    /// (mm) Profile of a wheel's tooth: x, y.
    fn tooth_profile_mm<'py>(&self, py: Python<'py>, wheel: &str) -> PyResult<[Array<'py>; 2]> {
        let (_, mesh, side) = self.wheel(wheel)?;
        let profile = self.stages.pairs[mesh].teeth.profile(side);
        Ok([array(py, profile.x_mm.clone()), array(py, profile.y_mm.clone())])
    }

    /// (mm) The damaged teeth: wheel, number from 1, and y of the flank, where it is cut furthest back, at the profile's
    /// points.
    fn damaged_teeth_mm<'py>(&self, py: Python<'py>) -> Vec<(&str, usize, Array<'py>)> {
        let of_alike = |(wheel, alike): (_, &DamagedTooth)| {
            let flank = array(py, alike.outline_y_mm());
            let of_tooth = |tooth: &usize| (wheel, tooth + 1, flank.clone());
            alike.teeth.iter().map(of_tooth).collect::<Vec<_>>()
        };
        self.damaged().flat_map(of_alike).collect()
    }

    /// What each damaged tooth has lost, damage by damage: wheel, number from 1, kind, what it takes of the tooth, first and last
    /// profile index, whether a part of the face is sound there, its sizes and a caption in words, (mm) outlines on the face as z and x, (mm) x and
    /// y of a crack's start and tip.
    fn damages<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let damages = self.damaged().flat_map(|(wheel, alike)| {
            let each = alike
                .teeth
                .iter()
                .flat_map(|tooth| alike.descriptions.iter().map(move |damage| (tooth, damage)));
            each.map(move |(tooth, damage)| (wheel, alike, tooth + 1, damage))
        });
        let entry = |(wheel, alike, tooth, damage): (&str, &DamagedTooth, usize, &DamageDescription)| {
            let outlines = damage.face.iter().map(|patch| patch.outline_mm.clone());
            let crack = alike.crack.filter(|_| damage.part == ToothPart::Root).map(|crack| {
                let (tip_x_mm, tip_y_mm) = crack.tip_mm();
                [[crack.start_x_mm, tip_x_mm], [crack.start_y_mm, tip_y_mm]]
            });
            let entry = PyDict::new(py);
            entry.set_item("wheel", wheel)?;
            entry.set_item("tooth", tooth)?;
            entry.set_item("kind", damage.kind)?;
            entry.set_item("part", damage.part.name())?;
            entry.set_item("range", damage.range)?;
            entry.set_item("is_partial", damage.is_partial)?;
            entry.set_item("sizes", &damage.sizes)?;
            entry.set_item("caption", &damage.caption)?;
            entry.set_item("face_mm", outlines.collect::<Vec<_>>())?;
            entry.set_item("crack_mm", crack)?;
            Ok(entry)
        };
        damages.map(entry).collect()
    }

    /// (mm) Profile errors of the driving and the driven wheel of a mesh, a column a tooth; none for ideal teeth.
    fn profile_errors_mm<'py>(&self, py: Python<'py>, mesh: usize) -> PyResult<Option<BothWheels<'py>>> {
        self.stages.pairs[mesh].profile_errors.as_ref().map(|errors| both_wheels(py, errors)).transpose()
    }

    /// (µm, rad) What each wheel has beside its profile errors: its name, the key in a scenario, and the number.
    fn wheel_deviations(&self) -> Vec<(&str, &'static str, f64)> {
        let all = self.stages.wheel_deviations();
        let wheels = self.stages.scenario.wheels.iter().enumerate();
        let of_wheel = |(number, wheel)| {
            let place = self.stages.layout.mesh_of(number);
            let of = place.and_then(|(mesh, side)| Some((wheel, all.get(mesh)?[side as usize].clone())));
            of.into_iter().flat_map(|(wheel, of): (&ScenarioWheel, WheelDeviations)| {
                let keys = [
                    ("run_out_um", of.run_out_um),
                    ("run_out_phase_rad", of.run_out_phase_rad),
                    ("helix_slope_um", of.helix_slope_um),
                ];
                keys.into_iter().filter_map(|(key, number)| Some((wheel.name.as_str(), key, number?)))
            })
        };
        wheels.flat_map(of_wheel).collect()
    }
}

/// The error of what the published model does not have.
fn no_meshes() -> PyErr {
    value_error("the published model has no pairs that share a force: set model = 'contact'")
}

/// A simulated signal, taken to the average over a revolution of a wheel's shaft and to indicators; or, without the name of a wheel, to those
/// of all.
#[pyfunction]
#[pyo3(signature = (scenario, signal, channel, wheel, start_s, sidebands=None))]
pub fn process_simulated<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    signal: Signal<'py>,
    channel: &str,
    wheel: Option<&str>,
    start_s: f64,
    sidebands: Option<usize>,
) -> PyResult<Bound<'py, PyDict>> {
    let (signal, train) = (samples(&signal)?, train(scenario)?.at_sensor(&scenario.0, channel));
    let turning = TrainTurning::of_simulated(&scenario.0, start_s, signal.len()).map_err(value_error)?;
    let sampling_rate_hz = scenario.0.time_grid().sampling_rate_hz;
    let recording = TrainRecording { signal, sampling_rate_hz, train: &train, turning: &turning };
    let separation = separation(1, sidebands, None);
    let Some(wheel) = wheel else { return train_parts(py, &recording, separation) };
    let number = train.wheels.iter().position(|known| known.name == wheel);
    let number = number.ok_or_else(|| no_wheel(&scenario.0, wheel))?;
    let settings = TrainSettings { separation, ..TrainSettings::default() };
    let processed = py.detach(|| recording.process_one(number, &settings)).map_err(value_error)?;
    let record = processed.records.into_iter().next().ok_or_else(|| value_error("there is no record"))?;
    record_parts(py, record)
}

fn no_wheel(scenario: &scenario::Scenario, wheel: &str) -> PyErr {
    let names: Vec<String> = scenario.wheels.iter().map(|wheel| format!("'{}'", wheel.name)).collect();
    value_error(format!("wheel = '{wheel}': must be {}", names.join(" or ")))
}
