//! The balance of torques of every shaft that nothing but meshes and a brake holds.

use nalgebra::DVector;

use crate::machine::{Drive, Machine, connected_groups};

/// How the torques on a shaft, with all that turns with it, add up. All of it is per unit of the motor's rotation, by which a shaft turns faster or
/// slower: that changes no balance, and makes those of all shafts alike.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TorqueBalance {
    /// (m) What the force of each mesh turns the shaft with; only meshes that do.
    pub(crate) meshes: Vec<(usize, f64)>,
    /// (m) What friction across the line of action of each of these meshes turns it with at the pitch point; 0 without friction.
    across_m: Vec<f64>,
    /// (-) The part of the brake's torque that acts on it.
    brake: f64,
    /// (kg m²) Its moment of inertia.
    inertia_kgm2: f64,
    /// What the shaft's rotation moves.
    shaft: DVector<f64>,
}

impl TorqueBalance {
    /// Those of all shafts that no motor holds.
    ///
    /// # Arguments
    /// * `machine` - without its meshes
    pub(crate) fn of(machine: &Machine) -> Vec<Self> {
        let rigid = &machine.rigid_rotation;
        let turning: Vec<usize> = (0..rigid.len()).filter(|&n| rigid[n] != 0.0).collect();
        let connects = |row: usize, column: usize| {
            let entry = (turning[row], turning[column]);
            machine.mass[entry] != 0.0 || machine.springs.iter().any(|spring| spring.stiffness[entry] != 0.0)
        };
        let groups = connected_groups(turning.len(), connects).into_iter();
        let is_driven = |shaft: &DVector<f64>| {
            machine
                .drives
                .iter()
                .any(|drive| matches!(drive, Drive::Motor { coordinate, .. } if shaft[*coordinate] != 0.0))
        };
        let shafts = groups.map(|group| {
            let mut shaft = DVector::zeros(rigid.len());
            group.iter().map(|&n| turning[n]).for_each(|n| shaft[n] = rigid[n]);
            shaft
        });
        shafts.filter(|shaft| !is_driven(shaft)).map(|shaft| Self::of_shaft(machine, &shaft)).collect()
    }

    fn of_shaft(machine: &Machine, shaft: &DVector<f64>) -> Self {
        let arms_m = machine.lines.iter().map(|line| line.at_middle.dot(shaft)).enumerate();
        let meshes: Vec<(usize, f64)> = arms_m.filter(|(_, arm_m)| *arm_m != 0.0).collect();
        let across_m = |&(mesh, _): &(usize, f64)| {
            machine.lines[mesh].across.as_ref().map_or(0.0, |across| across.at_pitch_point.dot(shaft).abs())
        };
        let brakes = machine.drives.iter().map(|drive| match *drive {
            Drive::Brake { coordinate, torque_share } => torque_share * shaft[coordinate],
            Drive::Motor { .. } => 0.0,
        });
        Self {
            across_m: meshes.iter().map(across_m).collect(),
            meshes,
            brake: brakes.sum(),
            inertia_kgm2: (&machine.mass * shaft).dot(shaft),
            shaft: shaft.clone(),
        }
    }

    /// (-) Rotation of the shaft per unit of the motor's, seen at a place on it; none of a place elsewhere.
    ///
    /// # Arguments
    /// * `weights` - of the coordinates in the rotation of the place
    pub(crate) fn rotation_at(&self, weights: &DVector<f64>) -> Option<f64> {
        Some(self.shaft.dot(weights)).filter(|rotation| *rotation != 0.0)
    }

    /// (N m) The brake's part and what speeds the shaft up, less what the meshes hold: 0 where they balance.
    ///
    /// # Arguments
    /// * `forces_n` - (N) mean force of each mesh
    /// * `torque_nm` - (N m) mean torque of the brake
    /// * `acceleration_rad_per_s2` - (rad/s²) mean acceleration of the motor
    pub(crate) fn missing_nm(&self, forces_n: &[f64], torque_nm: f64, acceleration_rad_per_s2: f64) -> f64 {
        let held: f64 = self.meshes.iter().map(|&(mesh, arm_m)| arm_m * forces_n[mesh]).sum();
        self.brake * torque_nm - held - self.inertia_kgm2 * acceleration_rad_per_s2
    }

    /// (N m) By how much friction can put the torques off balance at most: it pushes one way before the pitch point and the other way behind it.
    ///
    /// # Arguments
    /// * `forces_n` - (N) rms of the force of each mesh
    /// * `coefficients` - (-) of friction of each mesh
    pub(crate) fn friction_nm(&self, forces_n: &[f64], coefficients: &[f64]) -> f64 {
        let of_mesh =
            |(&(mesh, _), across_m): (&(usize, f64), &f64)| coefficients[mesh] * forces_n[mesh] * across_m;
        self.meshes.iter().zip(&self.across_m).map(of_mesh).sum()
    }

    /// (N m) What an imbalance counts against: the largest torque on the shaft.
    ///
    /// # Arguments
    /// * `forces_n` - (N) rms of the force of each mesh
    /// * `torque_nm` - (N m) largest torque of the brake
    pub(crate) fn largest_nm(&self, forces_n: &[f64], torque_nm: f64) -> f64 {
        let held = self.meshes.iter().map(|&(mesh, arm_m)| (arm_m * forces_n[mesh]).abs());
        held.fold((self.brake * torque_nm).abs(), f64::max)
    }
}
