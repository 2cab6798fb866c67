//! The summary of a gearbox's simulation.

use meshtone::GearboxSimulation;
use meshtone::bearing::{RollingBearing, Spall};
use meshtone::scenario::{FaultyTeeth, ScenarioWarning};
use meshtone::sensor::{ContactFigures, SignalSource};
use serde::Serialize;

use super::{
    ChannelSummary, FORMAT_VERSION, HelixSummary, MeshForce, MeshStiffness, SummaryEnd, SummaryHead,
    extremes, json,
};
use crate::run_identity::RunIdentity;

/// The main numbers of a gearbox's simulation; what a pair's summary has too has the same name there.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct GearboxSummary {
    /// What every summary begins with.
    #[serde(flatten)]
    pub head: SummaryHead,
    /// The faults.
    pub faults: Vec<WheelFault>,
    /// Samples per revolution of the input, at the nominal speed.
    pub samples_per_input_revolution: usize,
    /// Revolutions of the input after which all teeth and shafts stand as at the start.
    pub cycle_input_revolutions: i64,
    /// The shafts, in the order of the file.
    pub shafts: Vec<ShaftSummary>,
    /// The meshes, in the order of the file.
    pub meshes: Vec<MeshSummary>,
    /// The rolling bearings, in the order of the file.
    pub bearings: Vec<BearingSummary>,
    /// (Hz) The natural frequencies with the meshes closed at their mean stiffness, rising.
    pub natural_frequencies_hz: Vec<f64>,
    /// Main numbers of each signal, by the name of its column.
    #[serde(serialize_with = "json::channels")]
    pub channels: Vec<ChannelSummary>,
    /// Computing time and warnings.
    #[serde(flatten)]
    pub end: SummaryEnd,
}

/// A fault of a gearbox: kind and place, each as in the scenario file, and how severe it is.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct WheelFault {
    /// Kind of damage.
    pub kind: &'static str,
    /// Name of the damaged wheel.
    pub wheel: String,
    /// Which of its teeth, by their numbers from 1.
    #[serde(serialize_with = "json::tooth")]
    pub tooth: FaultyTeeth,
    /// (-) How severe it is, from 0 to 1.
    pub severity: f64,
}

/// A shaft of a gearbox.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ShaftSummary {
    /// Its name.
    pub name: String,
    /// (rev/s) Its nominal speed.
    pub speed_hz: f64,
    /// Its speed over that of the input as a fraction; negative where it turns against the input.
    pub speed_ratio: String,
}

/// A mesh of a gearbox.
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
    /// (-) Face load factor K_Hβ of sound teeth under the nominal load.
    pub face_load_factor: f64,
    /// (N) Force that holds the nominal torque.
    pub static_force_n: f64,
    /// Over a revolution of the driven wheel.
    pub mesh_stiffness: MeshStiffness,
    /// Along the line of action, over the samples kept.
    pub mesh_force: MeshForce,
    /// Along the line of action, over the samples kept.
    pub transmission_error_um: TransmissionError,
}

/// How far the wheels of a mesh turn against one another, along the line of action.
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

/// A rolling bearing of a gearbox.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct BearingSummary {
    /// Name of its seat: shaft and place, such as `input:0`.
    pub at: String,
    /// Kind of its elements.
    pub kind: &'static str,
    /// (N) Its radial load that holds the nominal torque.
    pub static_load_n: f64,
    /// (N/m) Its stiffness along that load, averaged over the places of the cage.
    pub stiffness_n_per_m: f64,
    /// Orders of its shaft at which defects show, without slip.
    pub orders: BearingOrders,
    /// Its spalls.
    pub defects: Vec<DefectSummary>,
}

/// Orders at which the defects of a bearing show.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct BearingOrders {
    /// The cage turns.
    pub ftf: f64,
    /// Elements pass a place of the outer race.
    pub bpfo: f64,
    /// Elements pass a place of the inner race.
    pub bpfi: f64,
    /// An element turns about itself.
    pub bsf: f64,
}

/// A spall of a rolling bearing.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct DefectSummary {
    /// Part that has it.
    pub race: &'static str,
    /// (mm) Its width along the path of the elements.
    pub width_mm: f64,
    /// (µm) By how much an element drops into it at most.
    pub drop_um: f64,
    /// (°) From the direction of the static load to its middle, of the inner race at the start.
    pub angle_deg: f64,
    /// (-) Its width over the diameter of an element.
    pub severity: f64,
}

impl BearingSummary {
    fn new(at: String, bearing: &RollingBearing) -> Self {
        let parts = &bearing.parts;
        let orders = parts.geometry.defect_orders();
        let [x_n, y_n] = bearing.static_load_n;
        let defect = |spall: &Spall| DefectSummary {
            race: spall.place.name(),
            width_mm: spall.width_mm,
            drop_um: spall.drop_um,
            angle_deg: spall.angle_deg,
            severity: spall.severity,
        };
        Self {
            at,
            kind: parts.contact.element.name(),
            static_load_n: x_n.hypot(y_n),
            stiffness_n_per_m: bearing.stiffness_n_per_m,
            orders: BearingOrders {
                ftf: orders.cage,
                bpfo: orders.outer_race,
                bpfi: orders.inner_race,
                bsf: orders.element_spin,
            },
            defects: parts.spalls.iter().map(defect).collect(),
        }
    }
}

impl GearboxSummary {
    /// Sums up a simulation.
    ///
    /// # Arguments
    /// * `simulation` - its stages and signals
    /// * `run` - the run's identity
    /// * `warnings` - what deserves attention
    pub fn new(simulation: &GearboxSimulation, run: RunIdentity, warnings: &[ScenarioWarning]) -> Self {
        let (stages, channels) = (&simulation.stages, &simulation.channels);
        let gearbox = &stages.gearbox;
        let meshes = gearbox.meshes.iter().enumerate().map(|(number, mesh)| {
            let tables = &stages.meshes[number];
            let revolution = 0..tables.sequence.gear_teeth();
            let [min_n_per_mm, mean_n_per_mm, max_n_per_mm] =
                extremes(&tables.stiffness_n_per_mm(revolution.clone()));
            let force = channels.of(SignalSource::MeshForce(number));
            let [min_n, mean_n, max_n] = extremes(force);
            let [min, mean, max] = extremes(channels.of(SignalSource::TransmissionError(number)));
            let static_force_n = stages.pairs[number].static_force_n;
            MeshSummary {
                wheels: mesh.wheels.clone(),
                mesh_frequency_hz: tables.turning.pitches_per_revolution
                    * gearbox.operation.drive.pinion_speed_hz,
                contact_ratio: stages.pairs[number].teeth.contact.contact_ratio,
                helix: HelixSummary::of(&stages.layout.gears[number], static_force_n),
                face_load_factor: tables.face_load_factor,
                static_force_n,
                mesh_stiffness: MeshStiffness { min_n_per_mm, mean_n_per_mm, max_n_per_mm },
                mesh_force: MeshForce {
                    min_n,
                    mean_n,
                    max_n,
                    tension_fraction: None,
                    contact: Some(ContactFigures::of_force(force)),
                },
                transmission_error_um: TransmissionError {
                    min,
                    mean,
                    max,
                    peak_to_peak: max - min,
                    static_peak_to_peak: tables.at_rest(static_force_n, revolution).peak_to_peak_m() * 1e6,
                },
            }
        });
        let shafts = gearbox.shafts.iter().zip(&stages.layout.ratios).map(|(shaft, ratio)| ShaftSummary {
            name: shaft.name.clone(),
            speed_hz: ratio.value().abs() * gearbox.operation.drive.pinion_speed_hz,
            speed_ratio: ratio.to_string(),
        });
        let faults = gearbox.faults.iter().zip(&stages.fault_severities).map(|(of, &severity)| WheelFault {
            kind: of.fault.damage.kind(),
            wheel: of.wheel.clone(),
            tooth: of.fault.tooth.clone(),
            severity,
        });
        Self {
            head: SummaryHead {
                format_version: FORMAT_VERSION,
                meshtone_version: env!("CARGO_PKG_VERSION"),
                run,
                model: "contact",
                seed: gearbox.seed,
                sampling_rate_hz: channels.sampling_rate_hz,
                samples: channels.len(),
                start_s: channels.start_s,
            },
            faults: faults.collect(),
            samples_per_input_revolution: stages.time.samples_per_pinion_revolution,
            cycle_input_revolutions: stages.layout.cycle_revolutions(),
            shafts: shafts.collect(),
            meshes: meshes.collect(),
            bearings: (stages.bearings.iter())
                .map(|(number, bearing)| BearingSummary::new(gearbox.bearings[*number].seat_name(), bearing))
                .collect(),
            natural_frequencies_hz: stages.natural_frequencies_hz(),
            channels: ChannelSummary::all(channels),
            end: SummaryEnd::new(&simulation.timings, warnings),
        }
    }
}
