//! The meshes in the summary of a simulation.

use meshtone::Simulation;
use meshtone::mesh::MeshCurve;
use meshtone::scenario::Gears;
use meshtone::sensor::{ContactFigures, SignalSource};
use meshtone::signal::GearTrain;
use serde::Serialize;
use serde_json::{Map, Value, json};

/// A mesh.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MeshSummary {
    /// Names of the driving and of the driven wheel.
    pub wheels: [String; 2],
    /// (Hz) Nominal mesh frequency.
    pub mesh_frequency_hz: f64,
    /// (-) Contact ratio, of helical wheels in the transverse section.
    pub contact_ratio: f64,
    /// Overlap and thrust; only of helical wheels.
    pub helix: Option<HelixSummary>,
    /// (-) Face load factor K_Hβ of sound teeth under the nominal load; only under `contact`.
    pub face_load_factor: Option<f64>,
    /// (-) Part of the driving wheel's mean power that the friction of the flanks leaves; only with friction.
    pub efficiency: Option<f64>,
    /// (N) Force that holds the nominal torque.
    pub static_force_n: f64,
    /// Over a revolution of the driven wheel.
    pub mesh_stiffness: MeshStiffness,
    /// Along the line of action, over the samples kept.
    pub mesh_force: MeshForce,
    /// Along the line of action, over the samples kept; only of a gearbox.
    pub transmission_error_um: Option<TransmissionError>,
}

impl MeshSummary {
    /// A mesh of a simulation.
    ///
    /// # Arguments
    /// * `simulation`, `train` - what was simulated, and its shafts and wheels by their names
    /// * `number` - of the mesh
    /// * `curve` - its stiffness over a revolution of the driven wheel
    pub(super) fn new(simulation: &Simulation, train: &GearTrain, number: usize, curve: &MeshCurve) -> Self {
        let Simulation { stages, channels, .. } = simulation;
        let (layout, pair) = (&stages.layout, &stages.pairs[number]);
        let wheels = layout.wheels_of_mesh[number];
        let gears = &layout.gears[number];
        let error_um = channels.of(SignalSource::TransmissionError(number));
        let error = stages.meshes.get(number).filter(|_| !error_um.is_empty()).map(|tables| {
            let revolution = 0..tables.sequence.gear_teeth();
            let static_um = tables.at_rest(pair.static_force_n, revolution).peak_to_peak_m() * 1e6;
            TransmissionError::of(error_um, static_um)
        });
        let force_n = channels.of(SignalSource::MeshForce(number));
        Self {
            wheels: wheels.map(|wheel| train.wheels[wheel].name.clone()),
            mesh_frequency_hz: layout.pitches_per_revolution(number)
                * stages.scenario.operation.pinion_speed_hz,
            contact_ratio: pair.teeth.contact.contact_ratio,
            helix: HelixSummary::of(gears, pair.static_force_n),
            face_load_factor: curve.face_load_factor,
            efficiency: simulation.efficiency(number),
            static_force_n: pair.static_force_n,
            mesh_stiffness: MeshStiffness::of(&curve.stiffness_n_per_mm),
            mesh_force: MeshForce::of(force_n, stages.scenario.model.teeth_part()),
            transmission_error_um: error,
        }
    }
}

/// Transmission error of a mesh: the rotation of its wheels against one another, along the line of action.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TransmissionError {
    /// (µm) Least.
    pub min: f64,
    /// (µm) Mean.
    pub mean: f64,
    /// (µm) Largest.
    pub max: f64,
    /// (µm) Largest less least.
    pub peak_to_peak: f64,
    /// (µm) Largest less least at rest under the nominal load, of the teeth without their deviations, over a revolution of the driven wheel.
    pub static_peak_to_peak: f64,
}

/// Overlap and thrust of a helical mesh.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct HelixSummary {
    /// (-) Overlap ratio ε_β.
    pub overlap_ratio: f64,
    /// (-) Total contact ratio ε_γ.
    pub total_contact_ratio: f64,
    /// (N) Force along the shafts under the nominal torque, on the driving wheel; positive towards positive z where it turns about that.
    pub axial_force_n: f64,
}

impl HelixSummary {
    /// Overlap and thrust of two wheels; none of spur wheels, which have neither.
    pub(super) fn of(gears: &Gears, static_force_n: f64) -> Option<Self> {
        gears.is_helical().then(|| Self {
            overlap_ratio: gears.overlap_ratio(),
            total_contact_ratio: gears.total_contact_ratio(),
            axial_force_n: static_force_n * gears.thrust(),
        })
    }
}

/// Stiffness of the mesh over a revolution of the gear.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MeshStiffness {
    /// (N/mm) Smallest.
    pub min_n_per_mm: f64,
    /// (N/mm) Mean.
    pub mean_n_per_mm: f64,
    /// (N/mm) Largest.
    pub max_n_per_mm: f64,
}

/// Force along the line of action.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MeshForce {
    /// (N) Smallest; negative where the mesh pulls.
    pub min_n: f64,
    /// (N) Mean.
    pub mean_n: f64,
    /// (N) Largest.
    pub max_n: f64,
    /// (-) Part of the time in which the mesh pulls; none under `contact`, whose teeth never do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tension_fraction: Option<f64>,
    /// Contact of the teeth; none where the model is not `contact`.
    #[serde(flatten)]
    pub contact: Option<ContactFigures>,
}

impl MeshStiffness {
    pub(super) fn of(stiffness_n_per_mm: &[f64]) -> Self {
        let [min_n_per_mm, mean_n_per_mm, max_n_per_mm] = extremes(stiffness_n_per_mm);
        Self { min_n_per_mm, mean_n_per_mm, max_n_per_mm }
    }
}

impl MeshForce {
    /// The numbers of a mesh's force.
    ///
    /// # Arguments
    /// * `force_n` - (N) the force at every kept sample
    /// * `teeth_part` - whether teeth that are pulled part
    pub(super) fn of(force_n: &[f64], teeth_part: bool) -> Self {
        let [min_n, mean_n, max_n] = extremes(force_n);
        let figures = ContactFigures::of_force(force_n);
        let tension_fraction = (!teeth_part).then_some(figures.back_flank_fraction);
        Self { min_n, mean_n, max_n, tension_fraction, contact: teeth_part.then_some(figures) }
    }
}

impl TransmissionError {
    pub(super) fn of(values_um: &[f64], static_peak_to_peak: f64) -> Self {
        let [min, mean, max] = extremes(values_um);
        Self { min, mean, max, peak_to_peak: max - min, static_peak_to_peak }
    }
}

/// What stands beside the list of meshes where there is one: the same numbers, as files of one pair have them.
pub(super) fn of_one_mesh(
    meshes: &[MeshSummary],
    samples_per_pinion_revolution: usize,
) -> Map<String, Value> {
    const SHARED: [&str; 5] = ["contact_ratio", "helix", "face_load_factor", "mesh_stiffness", "mesh_force"];
    let [mesh] = meshes else { return Map::new() };
    let mesh = json!(mesh);
    let mut numbers = Map::new();
    numbers.insert("samples_per_pinion_revolution".to_owned(), json!(samples_per_pinion_revolution));
    numbers.extend(SHARED.map(|key| (key.to_owned(), mesh[key].clone())));
    numbers
}

/// Smallest value, mean and largest value.
fn extremes(values: &[f64]) -> [f64; 3] {
    [
        values.iter().copied().fold(f64::INFINITY, f64::min),
        values.iter().sum::<f64>() / values.len() as f64,
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    ]
}
