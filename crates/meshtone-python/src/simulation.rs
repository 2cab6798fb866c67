//! One simulation.

use std::num::NonZeroUsize;

use meshtone::damage::{DamageDescription, DamagedTooth, ToothPart};
use meshtone::scenario::ScenarioWarning;
use meshtone::sensor::{ContactFigures, SignalSource};
use meshtone::signal::SimulatedShafts;
use meshtone::wheel::{WheelDeviations, WheelName};
use meshtone::{Stages, StepJudgement, Trace};
use meshtone_io::memory;
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::array::{Array, Signal, array, field, matrix, named_arrays, samples};
use crate::error::{scenario_error, simulation_error, value_error};
use crate::process::{Settings, record_parts};
use crate::scenario::{BothWheels, Scenario, both_wheels};

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
    /// (-) Part of the kept time in which the mesh force is negative.
    #[pyo3(get)]
    tension_fraction: f64,
    /// Contact of the teeth, under `contact`: (-) part of the time apart, (-) part of it with coast flanks in touch, how often
    /// these hit, (N) largest force.
    #[pyo3(get)]
    contact_figures: Option<(f64, f64, usize, f64)>,
    /// Its warnings.
    #[pyo3(get)]
    warnings: Vec<String>,
    /// Subject of each warning.
    #[pyo3(get)]
    warning_codes: Vec<&'static str>,
    /// (s) Of the stages, by name.
    #[pyo3(get)]
    computing_time_s: Vec<(&'static str, f64)>,
}

/// Simulates a scenario.
#[pyfunction]
pub fn simulate(py: Python<'_>, scenario: &Scenario) -> PyResult<Simulation> {
    let (simulation, warnings) = simulated(py, &scenario.0)?;
    Simulation::new(py, simulation, &warnings)
}

/// Simulates a scenario, and collects all warnings; it is simulated a second time where its step is doubtful.
pub fn simulated(
    py: Python<'_>,
    scenario: &meshtone::scenario::Scenario,
) -> PyResult<(meshtone::Simulation, Vec<ScenarioWarning>)> {
    let simulated = py.detach(|| {
        let (stages, mut warnings) = meshtone::stages_and_warnings(scenario, memory::limit())?;
        let simulation = stages.simulate()?;
        warnings.extend(simulation.warnings_of_signals(StepJudgement::Repeated));
        Ok((simulation, warnings))
    });
    simulated.map_err(|error| simulation_error(&error))
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
pub fn fields(py: Python<'_>, trace: Trace) -> PyResult<Bound<'_, PyDict>> {
    let named = trace.fields.into_iter().map(|entry| Ok((entry.name.clone(), field(py, entry)?)));
    named.collect::<PyResult<Vec<_>>>()?.into_py_dict(py)
}

impl Simulation {
    fn new(py: Python<'_>, simulation: meshtone::Simulation, warnings: &[ScenarioWarning]) -> PyResult<Self> {
        let contact = |figures: ContactFigures| {
            let ContactFigures { apart_fraction, back_flank_fraction, back_flank_hits, .. } = figures;
            (apart_fraction, back_flank_fraction, back_flank_hits, figures.largest_force_n)
        };
        let contact_figures = simulation.contact_figures().map(contact);
        let channels = simulation.channels;
        let force = ContactFigures::of_force(channels.of(SignalSource::MeshForce(0)));
        Ok(Self {
            contact_figures,
            tension_fraction: force.back_flank_fraction,
            warnings: warnings.iter().map(ToString::to_string).collect(),
            warning_codes: warnings.iter().map(|warning| warning.kind.code()).collect(),
            sampling_rate_hz: channels.sampling_rate_hz,
            start_s: channels.start_s,
            channels: named_arrays(py, channels)?,
            computing_time_s: simulation
                .timings
                .iter()
                .map(|stage| (stage.stage, stage.elapsed.as_secs_f64()))
                .collect(),
            stages: simulation.stages,
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

    /// (N/mm) Mesh stiffness at every point of some pitches, on the grid of the published code under every model.
    fn mesh_stiffness_n_per_mm<'py>(
        &self,
        py: Python<'py>,
        first_pitch: i64,
        pitches: i64,
    ) -> PyResult<Array<'py>> {
        let shown = first_pitch..first_pitch + pitches;
        let curves =
            self.stages.mesh_curves_on_coarse_grid(Some(shown)).map_err(|error| scenario_error(&error))?;
        Ok(array(py, curves.into_iter().next().map_or_else(Vec::new, |curve| curve.stiffness_n_per_mm)))
    }

    /// The mesh at rest under a force: (m) deflection, number of the first pair, (N) each pair's force; not under `published`.
    fn static_mesh<'py>(
        &self,
        py: Python<'py>,
        force_n: Option<f64>,
        pitches: (usize, usize),
        points_per_pitch: NonZeroUsize,
    ) -> PyResult<StaticMesh<'py>> {
        let meshes = self.stages.meshes_at(points_per_pitch).map_err(|error| scenario_error(&error))?;
        let Some(mesh) = meshes.first() else {
            return Err(value_error(
                "the published model has no pairs that share a force: set model = 'contact'",
            ));
        };
        let force_n = force_n.unwrap_or_else(|| self.stages.static_force_n());
        let at_rest = py.detach(|| mesh.at_rest(force_n, pitches.0..pitches.1));
        let (rows, columns) = (at_rest.pair_force_n.len(), at_rest.deflection_m.len());
        let forces = matrix(py, at_rest.pair_force_n.concat(), [rows, columns])?;
        Ok((array(py, at_rest.deflection_m), at_rest.first_pair, forces))
    }

    /// (mm) Profile of a wheel's tooth: x, y.
    fn tooth_profile_mm<'py>(&self, py: Python<'py>, wheel: &str) -> PyResult<[Array<'py>; 2]> {
        let profile = self.stages.pairs[0].teeth.profile(wheel_name(wheel)?);
        Ok([array(py, profile.x_mm.clone()), array(py, profile.y_mm.clone())])
    }

    /// (mm) The damaged teeth: wheel, number from 1, and y of the flank, where it is cut furthest back, at the profile's
    /// points.
    fn damaged_teeth_mm<'py>(&self, py: Python<'py>) -> Vec<(&'static str, usize, Array<'py>)> {
        let of_alike = |alike: &DamagedTooth| {
            let (wheel, flank) = (alike.wheel.name(), array(py, alike.outline_y_mm()));
            let of_tooth = |tooth: &usize| (wheel, tooth + 1, flank.clone());
            alike.teeth.iter().map(of_tooth).collect::<Vec<_>>()
        };
        self.stages.pairs[0].damaged.iter().flat_map(of_alike).collect()
    }

    /// What each damaged tooth has lost, damage by damage: wheel, number from 1, kind, what it takes of the tooth, first and last
    /// profile index, whether a part of the face is sound there, its sizes and a caption in words, (mm) outlines on the face as z and x, (mm) x and
    /// y of a crack's start and tip.
    fn damages<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let damages = self.stages.pairs[0].damaged.iter().flat_map(|alike| {
            let each = alike
                .teeth
                .iter()
                .flat_map(|tooth| alike.descriptions.iter().map(move |damage| (tooth, damage)));
            each.map(move |(tooth, damage)| (alike, tooth + 1, damage))
        });
        let entry = |(alike, tooth, damage): (&DamagedTooth, usize, &DamageDescription)| {
            let outlines = damage.face.iter().map(|patch| patch.outline_mm.clone());
            let crack = alike.crack.filter(|_| damage.part == ToothPart::Root).map(|crack| {
                let (tip_x_mm, tip_y_mm) = crack.tip_mm();
                [[crack.start_x_mm, tip_x_mm], [crack.start_y_mm, tip_y_mm]]
            });
            let entry = PyDict::new(py);
            entry.set_item("wheel", alike.wheel.name())?;
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

    /// (mm) Profile errors of both wheels, a column a tooth; none for ideal teeth.
    fn profile_errors_mm<'py>(&self, py: Python<'py>) -> PyResult<Option<BothWheels<'py>>> {
        self.stages.pairs[0].profile_errors.as_ref().map(|errors| both_wheels(py, errors)).transpose()
    }

    /// (µm, rad) What both wheels have beside their profile errors, by the keys of a scenario.
    fn wheel_deviations(&self) -> Vec<(&'static str, Vec<f64>)> {
        WheelDeviations::entries(&self.stages.wheel_deviations()[0])
    }
}

/// A simulated signal, taken to the average over a revolution of a wheel's shaft and to indicators.
#[pyfunction]
#[pyo3(signature = (scenario, signal, wheel, start_s, settings=None))]
pub fn process_simulated<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    signal: Signal<'py>,
    wheel: &str,
    start_s: f64,
    settings: Option<Settings>,
) -> PyResult<Bound<'py, PyDict>> {
    let shaft = wheel_name(wheel)?;
    let signal = samples(&signal)?;
    let settings = Settings::chain(settings);
    let record = py.detach(|| {
        let shafts = SimulatedShafts::new(&scenario.0, start_s, signal.len());
        shafts.process(signal, shaft, &settings)
    });
    record_parts(py, record.map_err(value_error)?)
}

/// A wheel by its name.
fn wheel_name(wheel: &str) -> PyResult<WheelName> {
    WheelName::BOTH.into_iter().find(|name| name.name() == wheel).ok_or_else(|| no_wheel(wheel))
}

fn no_wheel(wheel: &str) -> PyErr {
    value_error(format!("'{wheel}': must be 'pinion' or 'gear'"))
}
