//! A machine as a list of parts: bodies, springs with their damping, lines of action, drives, and places where a sensor can sit.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use super::{Spinning, TurningForce};

/// A machine without its meshes, in n coordinates.
///
/// The matrices and vectors are given in *turned* coordinates, `u = turn · u'`. A machine with one mesh turns the plane of its wheels
/// until one axis lies along the line of action. Most entries are then exactly zero, and what the mesh does not reach stays out of the
/// solution.
#[derive(Debug, Clone, PartialEq)]
pub struct Machine {
    /// Names of the coordinates.
    pub names: Vec<Cow<'static, str>>,
    /// (kg, kg m, kg m²) Mass matrix; the same in turned coordinates. It is diagonal where all masses are rigid bodies.
    pub mass: DMatrix<f64>,
    /// Columns: unit vectors of the turned coordinates.
    pub turn: DMatrix<f64>,
    /// The elastic parts.
    pub springs: Vec<Spring>,
    /// A line of action for each mesh.
    pub lines: Vec<LineOfAction>,
    /// Of each rolling bearing the displacement of its inner ring against its outer one along x and along y, per unit of each coordinate.
    pub bearings: Vec<[DVector<f64>; 2]>,
    /// Forces that turn with the shafts.
    pub turning_forces: Vec<TurningForce>,
    /// What spins with gyroscopic moments that are stepped.
    pub spinning: Vec<Spinning>,
    /// Motors and brakes.
    pub drives: Vec<Drive>,
    /// Where something can be measured.
    pub places: Vec<Place>,
    /// Rotation of all shafts per unit rotation of the motor while nothing deforms, in the coordinates themselves.
    pub rigid_rotation: DVector<f64>,
}

/// An elastic part of a machine, with its damping.
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    /// Its stiffness matrix.
    pub stiffness: DMatrix<f64>,
    /// (-) Damping over the critical damping of a mode in which only this part deforms.
    pub damping_ratio: f64,
}

/// The line along which two wheels push one another, in turned coordinates: `g(z) = at_middle + z · per_m` at the axial position z.
#[derive(Debug, Clone, PartialEq)]
pub struct LineOfAction {
    /// At the middle of the face: the deflection of the mesh per unit of each coordinate.
    pub at_middle: DVector<f64>,
    /// (1/m) What is added per m along the face.
    pub per_m: DVector<f64>,
    /// How a force that slides across the line of action acts; none of a mesh without friction.
    pub across: Option<AcrossLine>,
}

/// How a force across a line of action acts on the two wheels in turned coordinates: that of friction, which pushes the driving wheel along q, n turned
/// by a quarter in the transverse section, and the driven one against it.
#[derive(Debug, Clone, PartialEq)]
pub struct AcrossLine {
    /// Generalised force per N that acts at the pitch point.
    pub at_pitch_point: DVector<f64>,
    /// (m) What is added per N and m by which the contact point lies beyond the pitch point, along n.
    pub per_m: DVector<f64>,
}

/// How the wheels of meshes lean at rest.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Leans {
    /// (-) By how much closer together the flanks of each mesh come per length of its face, towards positive z.
    pub(crate) slopes: Vec<f64>,
    /// (rad/(N m)) By how much less per moment of each mesh's force about the middle of its face.
    pub(crate) rad_per_nm: Vec<Vec<f64>>,
}

/// What drives a shaft or brakes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// A rotation that is prescribed behind the torsional stiffness of a shaft.
    Motor {
        /// Number of the coordinate that the shaft turns.
        coordinate: usize,
        /// (N m/rad) Torsional stiffness of the shaft.
        stiffness_nm_per_rad: f64,
        /// (-) Rotation of this motor over that of the input.
        speed_ratio: f64,
    },
    /// A torque that is prescribed.
    Brake {
        /// Number of the coordinate on which it acts.
        coordinate: usize,
        /// (-) Its part of the nominal torque.
        torque_share: f64,
    },
}

/// A direction in which something is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Horizontal, from shaft to shaft.
    X,
    /// Vertical.
    Y,
    /// Along the shafts.
    Z,
    /// The rotation about the shaft.
    Rotation,
}

/// A named place where the motion can be measured: coordinates with their weights, for each axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// Its name.
    pub name: Cow<'static, str>,
    /// Number and weight of the coordinates that move it along an axis.
    pub motion: Vec<(Axis, Vec<(usize, f64)>)>,
}

impl Spring {
    /// A part that does not resist anything yet.
    ///
    /// # Arguments
    /// * `coordinates` - number of coordinates of the machine
    /// * `damping_ratio` - (-) of the part
    pub fn new(coordinates: usize, damping_ratio: f64) -> Self {
        Self { stiffness: DMatrix::zeros(coordinates, coordinates), damping_ratio }
    }

    /// Numbers of the coordinates that it holds.
    pub(crate) fn coordinates(&self) -> Vec<usize> {
        let columns = self.stiffness.column_iter().enumerate();
        columns.filter(|(_, column)| column.iter().any(|value| *value != 0.0)).map(|(n, _)| n).collect()
    }

    /// Adds `k v vᵀ`: a spring that resists a combination of coordinates.
    ///
    /// # Arguments
    /// * `stretch` - v, by the number of a coordinate and its weight
    /// * `stiffness` - (N/m, N m/rad) k
    pub fn resist(&mut self, stretch: &[(usize, f64)], stiffness: f64) {
        self.couple(stretch, stretch, stiffness);
    }

    /// Adds `k v wᵀ`, a coupling of two combinations of coordinates; the caller adds its transpose where v and w differ.
    ///
    /// # Arguments
    /// * `rows`, `columns` - v and w, by the number of a coordinate and its weight
    /// * `stiffness` - (N/m, N, N m/rad) k
    pub fn couple(&mut self, rows: &[(usize, f64)], columns: &[(usize, f64)], stiffness: f64) {
        for &(row, of_row) in rows {
            for &(column, of_column) in columns {
                self.stiffness[(row, column)] += stiffness * of_row * of_column;
            }
        }
    }

    /// The part in turned coordinates, without the couplings that only rounding makes: coordinates that the part does not connect
    /// stay apart.
    ///
    /// # Arguments
    /// * `turn` - unit vectors of the turned coordinates
    pub fn turned(&self, turn: &DMatrix<f64>) -> Self {
        let turned = turn.transpose() * &self.stiffness * turn;
        let stiffness = DMatrix::from_fn(turned.nrows(), turned.ncols(), |r, c| {
            let both = (turned[(r, c)] + turned[(c, r)]) / 2.0;
            let scale = (turned[(r, r)] * turned[(c, c)]).abs().sqrt();
            if both.abs() <= ROUNDING * scale { 0.0 } else { both }
        });
        Self { stiffness, ..*self }
    }
}

/// Part of the geometric mean of two diagonal entries below which what couples them is rounding.
const ROUNDING: f64 = 1e-12;

impl Machine {
    /// Number of coordinates.
    pub fn coordinates(&self) -> usize {
        self.mass.nrows()
    }

    /// Stiffness matrix of all springs, in turned coordinates.
    pub fn stiffness(&self) -> DMatrix<f64> {
        let zeros = DMatrix::zeros(self.coordinates(), self.coordinates());
        self.springs.iter().fold(zeros, |sum, spring| sum + &spring.stiffness)
    }

    /// Stiffness matrix with the meshes closed, in turned coordinates.
    ///
    /// # Arguments
    /// * `mesh_stiffness_n_per_m` - (N/m) of each mesh along its line of action
    pub fn closed_stiffness(&self, mesh_stiffness_n_per_m: &[f64]) -> DMatrix<f64> {
        let meshes = self.lines.iter().zip(mesh_stiffness_n_per_m);
        meshes.fold(self.stiffness(), |sum, (line, stiffness)| {
            sum + &line.at_middle * line.at_middle.transpose() * *stiffness
        })
    }

    /// The torque of the brake on the coordinates.
    pub(super) fn braked(&self, torque_nm: f64) -> DVector<f64> {
        let mut torque = DVector::zeros(self.coordinates());
        for drive in &self.drives {
            if let Drive::Brake { coordinate, torque_share } = drive {
                torque[*coordinate] += torque_share * torque_nm;
            }
        }
        torque
    }

    /// The torque of the brake and the forces that do not turn, such as those of pins off their places.
    ///
    /// # Arguments
    /// * `torque_nm` - (N m) of the brake
    pub(super) fn load_at_rest(&self, torque_nm: f64) -> DVector<f64> {
        let constant = self.turning_forces.iter().filter(|of| of.speed_ratio == 0.0 && !of.of_square_speed);
        constant.fold(self.braked(torque_nm), |sum, of| sum + &of.at[0])
    }

    /// (N) Force of each mesh at rest under the torque of the brake and the forces that do not turn, such as those of pins off their places.
    ///
    /// # Arguments
    /// * `mesh_stiffness_n_per_m` - (N/m) of each mesh along its line of action
    /// * `torque_nm` - (N m) of the brake
    pub(crate) fn forces_at_rest_n(&self, mesh_stiffness_n_per_m: &[f64], torque_nm: f64) -> Vec<f64> {
        let load = self.load_at_rest(torque_nm);
        let displaced = self.displaced_by(self.closed_stiffness(mesh_stiffness_n_per_m), &[load]);
        let lines = self.lines.iter().zip(mesh_stiffness_n_per_m);
        lines.map(|(line, stiffness)| stiffness * line.at_middle.dot(&displaced.column(0))).collect()
    }

    /// How the wheels of each mesh lean against one another at rest under the torque of the brake, with closed meshes whose forces act midway
    /// along their faces, and how much less by moments of these forces.
    ///
    /// # Arguments
    /// * `mesh_stiffness_n_per_m` - (N/m) of each mesh along its line of action
    /// * `torque_nm` - (N m) of the brake
    pub(crate) fn leans(&self, mesh_stiffness_n_per_m: &[f64], torque_nm: f64) -> Leans {
        let torque = self.braked(torque_nm);
        let moments = self.lines.iter().map(|line| line.per_m.clone());
        let loads: Vec<DVector<f64>> = std::iter::once(torque).chain(moments).collect();
        let displaced = self.displaced_by(self.closed_stiffness(mesh_stiffness_n_per_m), &loads);
        let slope = |line: &LineOfAction, load: usize| line.per_m.dot(&displaced.column(load));
        Leans {
            slopes: self.lines.iter().map(|line| slope(line, 0)).collect(),
            rad_per_nm: (self.lines.iter())
                .map(|line| (1..loads.len()).map(|load| slope(line, load)).collect())
                .collect(),
        }
    }

    /// Displacements at rest under loads, a column each. The coupling of the motor and the supports hold everything but a shaft that may slide,
    /// which a billionth of its own stiffness holds.
    ///
    /// # Arguments
    /// * `stiffness` - of the machine with its meshes closed
    /// * `loads` - (N, N m) on each coordinate
    pub(super) fn displaced_by(&self, stiffness: DMatrix<f64>, loads: &[DVector<f64>]) -> DMatrix<f64> {
        let (loads, held) =
            (DMatrix::from_columns(loads), DMatrix::from_diagonal(&(stiffness.diagonal() * 1e-9)));
        (stiffness + held).cholesky().map_or_else(|| loads.clone() * 0.0, |factor| factor.solve(&loads))
    }

    /// A matrix in turned coordinates, in the coordinates themselves.
    pub fn turn_back(&self, turned: &DMatrix<f64>) -> DMatrix<f64> {
        &self.turn * turned * self.turn.transpose()
    }

    /// Weights of the coordinates in the motion of a place along an axis; all 0 where the place has no motion of that kind.
    ///
    /// # Arguments
    /// * `place` - its name
    /// * `axis` - the axis
    #[cfg(feature = "internals")]
    pub fn weights(&self, place: &str, axis: Axis) -> DVector<f64> {
        weights(&self.places, self.coordinates(), place, axis)
    }
}

/// [`Machine::weights`] of a machine's places and number of coordinates.
pub(crate) fn weights(places: &[Place], coordinates: usize, place: &str, axis: Axis) -> DVector<f64> {
    let mut weights = DVector::zeros(coordinates);
    let place = places.iter().find(|other| other.name == place);
    let motion = place.and_then(|place| place.motion.iter().find(|(other, _)| *other == axis));
    for &(coordinate, weight) in motion.iter().flat_map(|(_, motion)| motion) {
        weights[coordinate] = weight;
    }
    weights
}
