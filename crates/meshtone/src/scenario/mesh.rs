//! Two wheels of a scenario in mesh.

use super::ScenarioWheel;
use crate::keys::{KeyRow, Keys, field, rows};
use crate::wheel::rows::*;
use crate::wheel::{EndRelief, FoundationCoefficients, Gears, Hand, Material, WheelName};

/// Two wheels in mesh.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ScenarioMesh {
    /// Names of the driving and of the driven wheel.
    pub wheels: [String; 2],
    /// (mm) Module, of helical wheels in the normal section.
    pub module_mm: f64,
    /// (°) Pressure angle at the pitch circle, of helical wheels in the normal section. Default 20.
    pub pressure_angle_deg: f64,
    /// (°) Helix angle at the pitch circle. Default 0: spur wheels.
    pub helix_angle_deg: f64,
    /// Hand of the driving wheel's helix; the driven one's is the other one. Default right.
    pub hand: Hand,
    /// (µm) Lead crowning of both wheels together. Default 0.
    pub lead_crowning_um: f64,
    /// Relief of the flanks towards both ends of the face. Default none.
    pub end_relief: EndRelief,
    /// Number of slices of the face where the gap varies along it. Default 21.
    pub slices: u32,
    /// (mm) Distance between the axes; none for the one at which the teeth have no backlash.
    pub centre_distance_mm: Option<f64>,
    /// (mm) Normal backlash; none for two thirds of `0.06 + 0.0005 a + 0.03 m`.
    pub backlash_mm: Option<f64>,
    /// (µm) How far the shafts deviate from parallel in the plane of action, over the face width, the wheels under their nominal
    /// load: positive where it brings the flanks closer together towards positive z. Default 0.
    pub misalignment_um: f64,
    /// Number of points along a tooth's profile. Default 10 000.
    pub points_per_tooth: usize,
    /// Coefficients of the fillet foundation's compliance. Default: Sainsot et al. 2004, with the rotation of the wheels' bodies in the machine.
    pub foundation: FoundationCoefficients,
    /// (base pitches) Position of the first pair at the start; none for 0, and for what the teeth of an idler make it.
    pub phase: Option<f64>,
    /// (-) Damping of the contact over the critical one of the wheels' rotation on the mean mesh. Default 0.08, in a rig
    /// 0.15.
    pub damping_ratio: f64,
    /// (-) Coefficient of friction of the flanks. Default 0.05, in a rig 0.
    pub friction: f64,
    /// (-) Size of the random force across the line of action, `c` of [its density](crate::simulate). Default 0.055, in a rig 0.
    pub random_force: f64,
    /// Whether the driven wheel is a ring with internal teeth.
    pub is_internal: bool,
    /// Whether it follows from a planetary set, and has no section of its own.
    pub is_of_set: bool,
}

impl ScenarioMesh {
    /// A mesh with the rest at its default.
    ///
    /// # Arguments
    /// They are the fields of the same names.
    pub fn new(wheels: [&str; 2], module_mm: f64) -> Self {
        Self { wheels: wheels.map(str::to_owned), module_mm, ..Self::start() }
    }

    /// Name of the mesh, of which those of its channels are made: `z1-z2`.
    pub fn name(&self) -> String {
        self.wheels.join("-")
    }

    /// The geometry of two wheels in this mesh.
    ///
    /// # Arguments
    /// * `pinion`, `gear` - the driving and the driven wheel
    /// * `material` - that of wheels without one of their own
    pub(crate) fn gears(&self, pinion: &ScenarioWheel, gear: &ScenarioWheel, material: Material) -> Gears {
        let width_mm = pinion.face_width_mm.min(gear.face_width_mm);
        let mut gears = Gears::new(self.module_mm, pinion.teeth, gear.teeth, width_mm);
        gears.pressure_angle_deg = self.pressure_angle_deg;
        (gears.helix_angle_deg, gears.hand) = (self.helix_angle_deg, self.hand);
        (gears.lead_crowning_um, gears.end_relief, gears.slices) =
            (self.lead_crowning_um, self.end_relief, self.slices);
        (gears.pinion_profile_shift, gears.gear_profile_shift) = (pinion.profile_shift, gear.profile_shift);
        (gears.pinion_addendum, gears.gear_addendum) = (pinion.addendum, gear.addendum);
        (gears.pinion_dedendum, gears.gear_dedendum) = (pinion.dedendum, gear.dedendum);
        gears.centre_distance_mm = self.centre_distance_mm;
        gears.internal = self.is_internal;
        gears.backlash_mm = self.backlash_mm;
        gears.material = material;
        (gears.pinion_material, gears.gear_material) = (pinion.material, gear.material);
        let wheels = [pinion, gear];
        gears.flank_relief = wheels.map(|wheel| wheel.flank_relief);
        gears.tip_chamfer_mm = wheels.map(|wheel| wheel.tip_chamfer_mm);
        gears.active_profile_shortening = wheels.map(|wheel| wheel.active_profile_shortening);
        gears.uniform_flank_reduction_mm = wheels.map(|wheel| wheel.uniform_flank_reduction_mm);
        (gears.points_per_tooth, gears.foundation) = (self.points_per_tooth, self.foundation);
        gears
    }

    /// States the geometry of two wheels in this mesh.
    ///
    /// # Arguments
    /// * `gears` - the geometry
    /// * `pinion`, `gear` - the driving and the driven wheel
    pub(crate) fn set_gears(&mut self, gears: &Gears, pinion: &mut ScenarioWheel, gear: &mut ScenarioWheel) {
        (self.module_mm, self.pressure_angle_deg) = (gears.module_mm, gears.pressure_angle_deg);
        (self.helix_angle_deg, self.hand) = (gears.helix_angle_deg, gears.hand);
        (self.lead_crowning_um, self.end_relief, self.slices) =
            (gears.lead_crowning_um, gears.end_relief, gears.slices);
        (self.centre_distance_mm, self.backlash_mm) = (gears.centre_distance_mm, gears.backlash_mm);
        (self.points_per_tooth, self.foundation) = (gears.points_per_tooth, gears.foundation);
        for (side, wheel) in WheelName::BOTH.into_iter().zip([pinion, gear]) {
            wheel.teeth = gears.teeth(side);
            wheel.face_width_mm = gears.face_width_mm;
            wheel.profile_shift = side.choose(gears.pinion_profile_shift, gears.gear_profile_shift);
            wheel.addendum = side.choose(gears.pinion_addendum, gears.gear_addendum);
            wheel.material = side.choose(gears.pinion_material, gears.gear_material);
            wheel.dedendum = side.choose(gears.pinion_dedendum, gears.gear_dedendum);
            wheel.flank_relief = gears.flank_relief[side as usize];
            wheel.tip_chamfer_mm = gears.tip_chamfer_mm[side as usize];
            wheel.active_profile_shortening = gears.active_profile_shortening[side as usize];
            wheel.uniform_flank_reduction_mm = gears.uniform_flank_reduction_mm[side as usize];
        }
    }
}

impl Keys for ScenarioMesh {
    const SECTION: &str = "mesh";

    fn start() -> Self {
        Self {
            wheels: [String::new(), String::new()],
            module_mm: f64::NAN,
            pressure_angle_deg: 20.0,
            helix_angle_deg: 0.0,
            hand: Hand::Right,
            lead_crowning_um: 0.0,
            end_relief: EndRelief::default(),
            slices: 21,
            centre_distance_mm: None,
            backlash_mm: None,
            misalignment_um: 0.0,
            points_per_tooth: 10_000,
            foundation: FoundationCoefficients::default(),
            phase: None,
            damping_ratio: 0.08,
            friction: 0.05,
            random_force: 0.055,
            is_internal: false,
            is_of_set: false,
        }
    }

    fn rows() -> Vec<KeyRow<Self>> {
        rows! {
            wheels "" "the names of the driving and of the driven wheel" .required();
            = { module_row(field!(module_mm)) };
            = { pressure_angle_row(field!(pressure_angle_deg)) };
            = { helix_angle_row(field!(helix_angle_deg)) };
            = { hand_row("the hand of the driving wheel's helix; the driven one's is the other one", field!(hand)) };
            = { lead_crowning_row(field!(lead_crowning_um)) };
            = { end_relief_row(field!(end_relief)) };
            = { slices_row(field!(slices)) };
            = { centre_distance_row(field!(centre_distance_mm)) };
            = { backlash_row(field!(backlash_mm)) };
            = { misalignment_row(field!(misalignment_um)) };
            = { points_row(field!(points_per_tooth)) };
            = { foundation_row(field!(foundation)) };
            phase "base pitches" "where on its path of contact the first pair of teeth is at the start"
                .otherwise("0; for a wheel in two meshes, the phase that follows from the other mesh")
                .alternative("0.0");
            = { mesh_damping_row(field!(damping_ratio)) };
            = { friction_row(field!(friction)) };
            = { random_force_row(
                "the size of the random force across the line of action, modulated by the load; 0 for none",
                field!(random_force),
            ) };
        }
    }
}
