//! The teeth of each mesh, and the deviations and damage of its wheels.

use crate::damage::{DamagedTooth, Fault, damaged_teeth_of_file};
use crate::error::ScenarioError;
use crate::machine::Rig;
use crate::operation::{CycleGrid, TimeGrid};
use crate::published;
use crate::random::{Draws, Purpose};
use crate::scenario::{Gearbox, GearboxLayout, Model, ScenarioForm};
use crate::wheel::quality::{deviations, profile_errors};
use crate::wheel::{Deviations, ERROR_POINTS, ErrorTable, ProfileErrors, RunOut, Teeth, WheelName, teeth};

/// Two wheels in mesh: what the stages before the mesh make of them.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct MeshedPair {
    /// Both healthy wheels and their contact.
    pub teeth: Teeth,
    /// Division of the mesh cycle.
    pub cycle: CycleGrid,
    /// Profile errors; none for ideal teeth.
    pub profile_errors: Option<ProfileErrors>,
    /// Run-out of the driving and of the driven wheel.
    pub run_out: [RunOut; 2],
    /// (µm) Helix slope deviation of both over the face width.
    pub helix_slope_um: [f64; 2],
    /// (µm) Misalignment of the shafts over the face width.
    pub misalignment_um: f64,
    /// (mm) Eccentricity of the seats of both wheels, beside their run-out.
    pub eccentricity_mm: f64,
    /// The damaged teeth.
    pub damaged: Vec<DamagedTooth>,
    /// The faults on both wheels with their sizes, each with its number in the scenario.
    pub faults: Vec<(usize, Fault)>,
    /// (N) Force along the line of action that holds the brake's nominal torque.
    pub static_force_n: f64,
}

/// The healthy teeth of each mesh's wheels.
///
/// # Arguments
/// * `model` - of the scenario
/// * `layout` - its gears, and the bores of its wheels
pub(super) fn healthy_teeth(model: Model, layout: &GearboxLayout) -> Vec<Teeth> {
    let of_mesh = if model.has_meshes() { teeth } else { published::teeth };
    let bores_mm = layout.wheels_of_mesh.iter().map(|wheels| wheels.map(|wheel| layout.bore_radii_mm[wheel]));
    layout.gears.iter().zip(bores_mm).map(|(gears, bores_mm)| of_mesh(gears, bores_mm)).collect()
}

/// The wheels of a mesh with their deviations, without damage.
///
/// # Arguments
/// * `scenario`, `layout`, `time` - what is simulated, how it stands and turns, and its division of time
/// * `mesh` - number of the mesh
/// * `teeth` - its healthy teeth
/// * `static_force_n` - (N) force that holds the brake's nominal torque
pub(super) fn sound_pair(
    scenario: &ScenarioForm,
    layout: &GearboxLayout,
    time: &TimeGrid,
    mesh: usize,
    teeth: Teeth,
    static_force_n: f64,
) -> MeshedPair {
    let gears = &layout.gears[mesh];
    let Deviations { flanks: profile_errors, run_out, helix_slope_um } = match scenario {
        ScenarioForm::Pair(pair) if pair.model.has_meshes() => deviations(&pair.quality, &teeth, pair.seed),
        // The published code knows profile errors only.
        ScenarioForm::Pair(pair) => {
            let flanks = profile_errors(&pair.quality, &teeth, pair.seed);
            Deviations { flanks, ..Deviations::default() }
        }
        ScenarioForm::Gearbox(gearbox) => drawn_apart(gearbox, layout, mesh, &teeth),
    };
    let of_rig = |of: fn(&Rig) -> f64| scenario.pair().map_or(0.0, |pair| of(&pair.rig));
    let faults = layout.faults_of_mesh(&scenario.faults(), mesh).into_iter();
    MeshedPair {
        cycle: CycleGrid::new(gears.pinion_teeth, gears.gear_teeth, time.sampling_rate_hz),
        profile_errors,
        run_out,
        helix_slope_um,
        misalignment_um: of_rig(|rig| rig.misalignment_um),
        eccentricity_mm: of_rig(|rig| rig.eccentricity_mm),
        damaged: Vec::new(),
        faults: faults.map(|(number, fault)| (number, fault.with_sizes(&teeth))).collect(),
        static_force_n,
        teeth,
    }
}

impl MeshedPair {
    /// (µm) By how much more the unloaded flanks close at one end of the face than at the other, positive towards positive z.
    pub(super) fn closer_um(&self) -> f64 {
        self.misalignment_um + self.helix_slope_um.iter().sum::<f64>()
    }

    /// The pair with its damaged teeth.
    ///
    /// # Arguments
    /// * `scenario`, `layout` - what is simulated, and how it stands and turns
    /// * `mesh` - number of the mesh
    ///
    /// # Errors
    /// A fault that does not fit its tooth.
    pub(super) fn damaged(
        mut self,
        scenario: &ScenarioForm,
        layout: &GearboxLayout,
        mesh: usize,
    ) -> Result<Self, ScenarioError> {
        let (numbers, faults): (Vec<usize>, Vec<Fault>) =
            layout.faults_of_mesh(&scenario.faults(), mesh).into_iter().unzip();
        let (entries, seed) = (scenario.fault_count(), scenario.seed());
        self.damaged = damaged_teeth_of_file(&faults, &numbers, entries, &self.teeth, seed)?;
        Ok(self)
    }
}

/// The deviations of a mesh's wheels, each drawn with a seed of its own: a wheel in two meshes has the same in both.
fn drawn_apart(gearbox: &Gearbox, layout: &GearboxLayout, mesh: usize, teeth: &Teeth) -> Deviations {
    let numbers = layout.wheels_of_mesh[mesh];
    let [pinion, gear] = WheelName::BOTH.map(|side| {
        let seed = gearbox.wheels_seed.unwrap_or(gearbox.seed);
        let seed = Draws::new(seed, Purpose::GearboxWheel, numbers[side as usize] as u64).bits();
        deviations(&layout.quality_of_mesh(gearbox, mesh, side), teeth, seed)
    });
    Deviations {
        run_out: [pinion.run_out[0], gear.run_out[1]],
        helix_slope_um: [pinion.helix_slope_um[0], gear.helix_slope_um[1]],
        flanks: joined(pinion.flanks, gear.flanks, teeth),
    }
}

/// The pinion's errors of one draw and the gear's of another; ideal where one has none.
fn joined(
    pinion: Option<ProfileErrors>,
    gear: Option<ProfileErrors>,
    teeth: &Teeth,
) -> Option<ProfileErrors> {
    let is_given = pinion.is_some() || gear.is_some();
    let table = |errors: Option<ProfileErrors>, wheel: WheelName| match errors {
        Some(errors) => wheel.choose(errors.pinion_profile_errors_mm, errors.gear_profile_errors_mm),
        None => ErrorTable::filled(ERROR_POINTS, teeth.wheel(wheel).teeth as usize, 0.0),
    };
    is_given.then(|| ProfileErrors {
        pinion_profile_errors_mm: table(pinion, WheelName::Pinion),
        gear_profile_errors_mm: table(gear, WheelName::Gear),
    })
}
