//! The teeth of each mesh, and the deviations and damage of its wheels.

use std::f64::consts::PI;

use crate::damage::{DamagedTooth, Fault, damaged_teeth_of_file};
use crate::error::ScenarioError;
use crate::known::Known;
use crate::mesh::HelixWobble;
use crate::operation::{CycleGrid, TimeGrid};
use crate::published;
use crate::random::{Draws, Purpose};
use crate::scenario::{Layout, Model, Scenario};
use crate::wheel::quality::{deviations, profile_errors};
use crate::wheel::{
    Deviations, ERROR_POINTS, ErrorTable, Gears, KnownProfiles, ProfileErrors, Quality, RunOut, Teeth, Wheel,
    WheelName, teeth_of_known,
};

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
    /// The helix slope of both that turns with them.
    pub(crate) helix_wobble: [HelixWobble; 2],
    /// (µm) Misalignment of the shafts over the face width.
    pub misalignment_um: f64,
    /// (mm) Eccentricity of the seats of both wheels, beside their run-out.
    pub eccentricity_mm: [f64; 2],
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
/// * `known` - profiles that are known already
pub(super) fn healthy_teeth(model: Model, layout: &Layout, known: &KnownProfiles) -> Vec<Teeth> {
    let of_mesh = |gears: &Gears, bores_mm| match model.has_meshes() {
        true => teeth_of_known(gears, bores_mm, known),
        false => published::teeth(gears, bores_mm),
    };
    let bores_mm = layout.wheels_of_mesh.iter().map(|wheels| wheels.map(|wheel| layout.bore_radii_mm[wheel]));
    layout.gears.iter().zip(bores_mm).map(|(gears, bores_mm)| of_mesh(gears, bores_mm)).collect()
}

/// The wheels of a mesh with their deviations, without damage.
///
/// # Arguments
/// * `scenario`, `layout`, `time` - what is simulated, how it stands and turns, and its division of time
/// * `mesh` - number of the mesh
/// * `teeth` - its healthy teeth
/// * `known` - deviations that are known already
/// * `static_force_n` - (N) force that holds the brake's nominal torque
pub(super) fn sound_pair(
    scenario: &Scenario,
    layout: &Layout,
    time: &TimeGrid,
    mesh: usize,
    teeth: Teeth,
    known: &KnownDeviations,
    static_force_n: f64,
) -> MeshedPair {
    let gears = &layout.gears[mesh];
    let numbers = layout.wheels_of_mesh[mesh];
    let Deviations { flanks: profile_errors, run_out, helix_slope_um } = if scenario.model.has_meshes() {
        of_both(scenario, layout, mesh, &teeth, known)
    } else {
        // The published code knows profile errors only.
        let flanks = profile_errors(&scenario.quality(), &teeth, scenario.seed);
        Deviations { flanks, ..Deviations::default() }
    }
    .counted_from(layout.first_teeth[mesh]);
    let faults = layout.faults_of_mesh(&scenario.placed_faults(), mesh).into_iter();
    MeshedPair {
        cycle: CycleGrid::new(gears.pinion_teeth, gears.gear_teeth, time.sampling_rate_hz),
        profile_errors,
        run_out,
        helix_slope_um,
        helix_wobble: numbers.map(|wheel| {
            let of = &scenario.wheels[wheel];
            HelixWobble {
                slope: of.helix_wobble_um * 1e-3 / of.face_width_mm,
                phase_rad: Draws::new(scenario.seed_of_wheel(wheel), Purpose::HelixWobble, 0).uniform(PI, PI),
                teeth: of.teeth,
            }
        }),
        misalignment_um: scenario.meshes[mesh].misalignment_um,
        eccentricity_mm: numbers.map(|wheel| scenario.wheels[wheel].eccentricity_mm),
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

    /// The pair where the gear drives the pinion: the flanks that carry are others, with the deviations and the damage that are stated.
    ///
    /// # Arguments
    /// * `teeth` - both wheels, the gear first
    pub(super) fn exchanged(&self, teeth: Teeth) -> Self {
        let backwards = |table: &ErrorTable| {
            let last = table.points() - 1;
            ErrorTable::from_fn(table.points(), table.teeth(), |point, tooth| table[(last - point, tooth)])
        };
        // Rows of both lie in the order in which they touch.
        let flanks = self.profile_errors.as_ref().map(|errors| ProfileErrors {
            pinion_profile_errors_mm: backwards(&errors.gear_profile_errors_mm),
            gear_profile_errors_mm: backwards(&errors.pinion_profile_errors_mm),
        });
        let mut this = Self {
            profile_errors: flanks,
            run_out: [self.run_out[1], self.run_out[0]],
            helix_slope_um: [self.helix_slope_um[1], self.helix_slope_um[0]],
            helix_wobble: [self.helix_wobble[1], self.helix_wobble[0]],
            eccentricity_mm: [self.eccentricity_mm[1], self.eccentricity_mm[0]],
            teeth,
            ..self.clone()
        };
        this.damaged.iter_mut().for_each(|tooth| tooth.wheel = tooth.wheel.mate());
        this
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
        scenario: &Scenario,
        layout: &Layout,
        mesh: usize,
    ) -> Result<Self, ScenarioError> {
        let (numbers, faults): (Vec<usize>, Vec<Fault>) =
            layout.faults_of_mesh(&scenario.placed_faults(), mesh).into_iter().unzip();
        let (entries, seed) = (scenario.faults.len(), scenario.seed);
        self.damaged = damaged_teeth_of_file(&faults, &numbers, entries, &self.teeth, seed)?;
        Ok(self)
    }
}

/// Deviations, by quality and seed of both wheels, the wheels, and the radii at which contact begins: of the units of a data set, at 50 kB each.
pub(super) type KnownDeviations = Known<([(Quality, u64); 2], [(Wheel, f64); 2]), Deviations, 128>;

/// The deviations of a mesh's wheels, each drawn with its seed: a wheel in two meshes has the same in both.
fn of_both(
    scenario: &Scenario,
    layout: &Layout,
    mesh: usize,
    teeth: &Teeth,
    known: &KnownDeviations,
) -> Deviations {
    let numbers = layout.wheels_of_mesh[mesh];
    let draws = WheelName::BOTH.map(|side| {
        let seed = scenario.seed_of_wheel(numbers[side as usize]);
        (layout.quality_of_mesh(scenario, mesh, side), seed)
    });
    let wheels = WheelName::BOTH.map(|side| (*teeth.wheel(side), teeth.initial_contact_radius_mm(side)));
    let drawn = known.get((draws, wheels), |(draws, _)| {
        let draw = |(quality, seed): &(Quality, u64)| deviations(quality, teeth, *seed);
        let pinion = draw(&draws[0]);
        if draws[0] == draws[1] {
            return pinion;
        }
        let gear = draw(&draws[1]);
        Deviations {
            run_out: [pinion.run_out[0], gear.run_out[1]],
            helix_slope_um: [pinion.helix_slope_um[0], gear.helix_slope_um[1]],
            flanks: joined(pinion.flanks, gear.flanks, teeth),
        }
    });
    Deviations::clone(&drawn)
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
