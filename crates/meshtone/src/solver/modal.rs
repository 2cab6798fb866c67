//! A machine in its modes, without what stays at rest.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::outputs::dot;
use crate::machine::{Axis, ClosedMesh, DecayingMode, Drive, Machine, Modes, Place, weights};

/// A machine without its meshes, in the modes that take part in the motion: first those that the meshes move.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalMachine {
    /// Mass-normalised shapes of the active modes, in the machine's coordinates.
    pub shapes: Vec<DVector<f64>>,
    /// (1/s²) ω² of the active modes.
    pub stiffness: Vec<f64>,
    /// (1/s) 2ζω of the active modes.
    pub damping: Vec<f64>,
    /// The line of action of each mesh.
    pub lines: Vec<ModalLine>,
    /// The stretch of each rolling bearing along x and y, in the modes.
    pub bearings: Vec<[Vec<f64>; 2]>,
    /// Forces that turn with the shafts, in the modes.
    pub turning_forces: Vec<ModalTurningForce>,
    /// What spins with gyroscopic moments, in the modes.
    pub spinning: Vec<ModalSpinning>,
    /// Modal force per rad of motor angle.
    pub motor: Vec<f64>,
    /// Modal force per N m of brake torque.
    pub brake: Vec<f64>,
    /// Modal velocity of the rigid rotation at 1 rad/s.
    pub rigid_velocity: Vec<f64>,
    /// The rigid rotation in the machine's coordinates.
    pub rigid_rotation: DVector<f64>,
    /// (rad/s) Speed of the rigid rotation on top of which the modes move: the nominal one.
    pub rotation_rad_per_s: f64,
    /// Modal displacement under the constant loads: the nominal torque, and the static force of each mesh midway along its face.
    pub static_displacement: Vec<f64>,
    /// Modal velocity at the start, relative to the rigid rotation.
    pub initial_velocity: Vec<f64>,
    /// The modes that are not stepped.
    pub residual: Residual,
    /// The machine's places, which outputs read.
    pub places: Vec<Place>,
}

/// The modes that are not stepped: they are so high that they deform at every instant as at rest. Without such modes all lists are empty.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Residual {
    /// (1/s²) ω² of each.
    stiffness: Vec<f64>,
    /// Their mass-normalised shapes.
    shapes: Vec<DVector<f64>>,
    /// Their entries in the columns of [`ModalMachine::columns`], and then across the lines.
    columns: Vec<Vec<f64>>,
    /// Their force per rad of motor angle.
    motor: Vec<f64>,
    /// Their force per N m of brake torque.
    brake: Vec<f64>,
    /// Their displacement under the constant loads.
    static_displacement: Vec<f64>,
}

/// What the modes that are not stepped add to a combination of them.
pub(super) struct AtRest {
    /// Under the constant loads.
    pub(super) constant: f64,
    /// (1/N) Per force in each column of the lines of action and of the bearings.
    pub(super) of_force: Vec<f64>,
    /// Per rad of the motor's lead and per N m of the brake's torque deviation.
    pub(super) of_drives: [f64; 2],
}

impl Residual {
    /// Whether all modes are stepped.
    pub(super) fn is_empty(&self) -> bool {
        self.stiffness.is_empty()
    }

    /// (m/N) What the modes add to the deflection in each column per force in each.
    pub(super) fn compliance(&self) -> Vec<Vec<f64>> {
        self.of_columns().into_iter().map(|at_rest| at_rest.of_force).collect()
    }

    /// What the modes add to a combination of them.
    ///
    /// # Arguments
    /// * `weights` - of the modes
    fn at_rest(&self, weights: &[f64]) -> AtRest {
        let yielding =
            |force: &[f64]| (0..weights.len()).map(|n| weights[n] * force[n] / self.stiffness[n]).sum();
        AtRest {
            constant: dot(weights, &self.static_displacement),
            of_force: self.columns.iter().map(|column| yielding(column)).collect(),
            of_drives: [yielding(&self.motor), yielding(&self.brake)],
        }
    }

    /// What the modes add to the deflection in each column of the lines of action.
    pub(super) fn of_columns(&self) -> Vec<AtRest> {
        self.columns.iter().map(|column| self.at_rest(column)).collect()
    }

    /// What the modes add to a combination of the machine's coordinates.
    ///
    /// # Arguments
    /// * `weights` - of the coordinates
    pub(super) fn of_coordinates(&self, weights: &DVector<f64>) -> AtRest {
        let entries = entries(weights);
        let of_shape = |shape: &DVector<f64>| entries.iter().map(|&(n, weight)| weight * shape[n]).sum();
        self.at_rest(&self.shapes.iter().map(of_shape).collect::<Vec<f64>>())
    }
}

/// A force that turns with a shaft, in the modes: see [`TurningForce`](crate::machine::TurningForce).
#[derive(Debug, Clone, PartialEq)]
pub struct ModalTurningForce {
    /// (-) Rotation of the shaft over that of the motor.
    pub speed_ratio: f64,
    /// Whether it grows with the square of the shaft's speed.
    pub of_square_speed: bool,
    /// Modal forces where the shaft stands as at the start, and a quarter of a revolution later.
    pub at: [Vec<f64>; 2],
}

/// What spins in the modes: see [`Spinning`](crate::machine::Spinning).
#[derive(Debug, Clone, PartialEq)]
pub struct ModalSpinning {
    /// Modal tilt about x and about y.
    pub tilts: [Vec<f64>; 2],
    /// (kg m²/s) Its angular momentum at the motor's nominal speed.
    pub momentum: f64,
}

/// The line of action of a mesh in the modes.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalLine {
    /// At the middle of the face.
    pub at_middle: Vec<f64>,
    /// What is added at the end of the face at positive z; none where the wheels' tilt is no unknown.
    pub to_end: Option<Vec<f64>>,
    /// Modal force of friction across it: per N at the pitch point, and per N and m beyond it; none of a mesh without friction or a random part.
    pub across: Option<[Vec<f64>; 2]>,
    /// (-) Sum of the wheels' speeds, at which their flanks slide with the distance from the pitch point, over that of the motor; 0 without
    /// [`Self::across`].
    pub sliding_speed_ratio: f64,
    /// (N) The mesh's force under the constant loads, which the displacements do not bring about: they are relative to it.
    pub static_force_n: f64,
}

impl ModalLine {
    /// The line of action at both ends of the face, or at its middle where no load moves away from it.
    pub(super) fn extremes(&self) -> [Vec<f64>; 2] {
        [-1.0, 1.0].map(|side| {
            let mut line = self.at_middle.clone();
            let to_end = self.to_end.iter().flatten();
            line.iter_mut().zip(to_end).for_each(|(line, to_end)| *line += side * to_end);
            line
        })
    }
}

/// A mode of a machine whose meshes are closed.
#[derive(Debug, Clone, PartialEq)]
pub struct ClosedMode {
    /// Its frequency and how fast it decays.
    pub decay: DecayingMode,
    /// (-) Part of its strain energy that each mesh has.
    pub mesh_energies: Vec<f64>,
}

/// How a simulation starts.
#[derive(Debug, Clone, Copy)]
pub struct InitialMotion<'a> {
    /// (rad/s) Nominal speed of the motor.
    pub nominal_rad_per_s: f64,
    /// (N m) Nominal torque of the brake.
    pub brake_torque_nm: f64,
    /// (rad/s) Speed of the motor at the start, at which all turns rigidly.
    pub motor_rad_per_s: f64,
    /// (m/s, rad/s) Velocity at the start in the machine's first coordinates; none for the rigid rotation.
    pub velocity: Option<&'a [f64]>,
}

/// (m) Deflection of a mesh or a bearing that no machine survives.
const LARGEST_DEFLECTION_M: f64 = 0.1;
/// (m √kg) Displacement of a mode that no machine reaches, whatever it deflects.
const LARGEST_DISPLACEMENT: f64 = 1e12;
/// (-) Part of the largest modal entry of the rigid rotation above which a mode turns with the motor.
const TURNING: f64 = 1e-9;

/// Below this part of the largest entry a modal entry is rounding.
const ROUNDING: f64 = 1e-13;

impl ModalMachine {
    /// Leaves out the modes that nothing sets in motion.
    ///
    /// # Arguments
    /// * `machine` - the machine
    /// * `modes` - its modes without the meshes
    /// * `half_faces_m` - (m) half the face width of each mesh whose tilt is an unknown; 0 of the others
    /// * `start` - how the simulation starts
    pub fn new(machine: &Machine, modes: &Modes, half_faces_m: &[f64], start: InitialMotion) -> Self {
        let shapes = modes.shapes.transpose();
        let modal = |turned: &DVector<f64>| clean(&shapes * turned);
        let modal_motion =
            |motion: &DVector<f64>| modal(&(&machine.mass * (machine.turn.transpose() * motion)));
        let [motor, brake] = drives(machine).map(|force| modal(&force));
        let rigid = modal_motion(&machine.rigid_rotation);
        let velocity = match start.velocity {
            Some(given) => {
                DVector::from_fn(machine.coordinates(), |n, _| given.get(n).copied().unwrap_or(0.0))
            }
            None => &machine.rigid_rotation * start.motor_rad_per_s,
        };
        let velocity = modal_motion(&(velocity - &machine.rigid_rotation * start.nominal_rad_per_s));
        let lines: Vec<Vec<DVector<f64>>> = (machine.lines.iter().zip(half_faces_m))
            .map(|(line, &half_m)| {
                let to_end = (half_m > 0.0).then(|| modal(&(&line.per_m * half_m)));
                [Some(modal(&line.at_middle)), to_end].into_iter().flatten().collect()
            })
            .collect();
        let across: Vec<Option<[DVector<f64>; 2]>> = (machine.lines.iter())
            .map(|line| line.across.as_ref().map(|across| [&across.at_pitch_point, &across.per_m].map(modal)))
            .collect();
        let bearings: Vec<[DVector<f64>; 2]> =
            machine.bearings.iter().map(|stretch| stretch.each_ref().map(modal)).collect();
        let turning: Vec<[DVector<f64>; 2]> =
            machine.turning_forces.iter().map(|force| force.at.each_ref().map(modal)).collect();
        let spinning: Vec<[DVector<f64>; 2]> = (machine.spinning.iter())
            .map(|of| [of.about_x, of.about_x + 1].map(|row| modes.shapes.row(row).transpose()))
            .collect();
        let moved = |n: usize| {
            let columns = lines.iter().flatten().chain(bearings.iter().flatten());
            let columns = columns.chain(turning.iter().flatten()).chain(across.iter().flatten().flatten());
            let columns = columns.chain(spinning.iter().flatten());
            [&motor, &brake, &rigid, &velocity].into_iter().chain(columns).any(|v| v[n] != 0.0)
        };
        // Modes that no mesh moves come last.
        let moved_by_meshes = |n: usize| lines.iter().flatten().any(|column| column[n] != 0.0);
        let (mut active, others): (Vec<usize>, Vec<usize>) =
            (0..machine.coordinates()).filter(|&n| moved(n)).partition(|&n| moved_by_meshes(n));
        active.extend(others);
        let pick = |vector: &DVector<f64>| active.iter().map(|&n| vector[n]).collect::<Vec<f64>>();
        let mut this = Self {
            shapes: turned_back(&machine.turn, &modes.shapes, &active),
            stiffness: active.iter().map(|&n| modes.angular_frequencies[n].powi(2)).collect(),
            damping: active.iter().map(|&n| modes.damping_per_s(n)).collect(),
            lines: (lines.iter().zip(&across).zip(&machine.lines))
                .map(|((columns, across), line)| ModalLine {
                    at_middle: pick(&columns[0]),
                    to_end: columns.get(1).map(pick),
                    sliding_speed_ratio: (line.across.as_ref())
                        .map_or(0.0, |across| across.per_m.dot(&machine.rigid_rotation).abs()),
                    across: across.as_ref().map(|across| across.each_ref().map(pick)),
                    static_force_n: 0.0,
                })
                .collect(),
            bearings: bearings.iter().map(|stretch| stretch.each_ref().map(pick)).collect(),
            turning_forces: (machine.turning_forces.iter().zip(&turning))
                .map(|(force, at)| ModalTurningForce {
                    speed_ratio: force.speed_ratio,
                    of_square_speed: force.of_square_speed,
                    at: at.each_ref().map(pick),
                })
                .collect(),
            spinning: (machine.spinning.iter().zip(&spinning))
                .map(|(of, tilts)| ModalSpinning {
                    tilts: tilts.each_ref().map(pick),
                    momentum: of.polar_kgm2 * start.nominal_rad_per_s,
                })
                .collect(),
            motor: pick(&motor),
            brake: pick(&brake),
            rigid_velocity: pick(&rigid),
            rigid_rotation: machine.rigid_rotation.clone(),
            rotation_rad_per_s: start.nominal_rad_per_s,
            static_displacement: Vec::new(),
            initial_velocity: pick(&velocity),
            residual: Residual::default(),
            places: machine.places.clone(),
        };
        this.balance(start.brake_torque_nm);
        this
    }

    /// The machine with the modes up to a frequency; those above stay as flexibility.
    ///
    /// # Arguments
    /// * `angular_frequency` - (rad/s) of the highest mode that is stepped
    pub fn up_to(mut self, angular_frequency: f64) -> Self {
        let is_stepped: Vec<bool> =
            self.stiffness.iter().map(|stiffness| stiffness.sqrt() <= angular_frequency).collect();
        let split = |values: &mut Vec<f64>| take_out(values, &is_stepped);
        self.residual = Residual {
            shapes: take_out(&mut self.shapes, &is_stepped),
            columns: {
                let (mut middles, mut ends, mut across) = (Vec::new(), Vec::new(), Vec::new());
                for line in &mut self.lines {
                    middles.push(&mut line.at_middle);
                    ends.extend(&mut line.to_end);
                    across.extend(line.across.iter_mut().flatten());
                }
                let bearings = self.bearings.iter_mut().flatten();
                middles.into_iter().chain(bearings).chain(ends).chain(across).map(split).collect()
            },
            motor: split(&mut self.motor),
            brake: split(&mut self.brake),
            static_displacement: split(&mut self.static_displacement),
            stiffness: split(&mut self.stiffness),
        };
        for values in [&mut self.damping, &mut self.rigid_velocity, &mut self.initial_velocity] {
            split(values);
        }
        // What turns with a shaft hardly moves what is left out: the motion of a bent shaft's middle differs by 0.1 % from that with all modes.
        self.turning_forces.iter_mut().flat_map(|force| &mut force.at).for_each(|values| drop(split(values)));
        self.spinning.iter_mut().flat_map(|of| &mut of.tilts).for_each(|values| drop(split(values)));
        self
    }

    /// (m √kg) How far each mode may move in a machine that exists: until a mesh or a bearing deflects by [`LARGEST_DEFLECTION_M`]. A mode that
    /// turns with the motor has no such bound, since its displacement is relative to the rotation at the nominal speed.
    pub(super) fn largest_displacements(&self) -> Vec<f64> {
        let columns = || self.lines.iter().map(|line| &line.at_middle).chain(self.bearings.iter().flatten());
        let turns_most = self.rigid_velocity.iter().fold(0.0, |most: f64, rigid| most.max(rigid.abs()));
        let of_mode = |n: usize| {
            let deflected = columns().map(|column| column[n].abs()).fold(0.0, f64::max);
            let is_turning = self.rigid_velocity[n].abs() > TURNING * turns_most;
            if is_turning {
                LARGEST_DISPLACEMENT
            } else {
                (LARGEST_DEFLECTION_M / deflected).min(LARGEST_DISPLACEMENT)
            }
        };
        (0..self.modes()).map(of_mode).collect()
    }

    /// Finds the static forces of the meshes that hold the shafts that turn freely, and the displacement under these and the torque.
    fn balance(&mut self, torque_nm: f64) {
        let (forces_n, displacement) = self.balanced(torque_nm);
        for (line, force_n) in self.lines.iter_mut().zip(forces_n) {
            line.static_force_n = force_n;
        }
        self.static_displacement = displacement;
    }

    /// (N, m √kg) The static forces of the meshes under a torque, and the displacement under these and the torque.
    ///
    /// # Arguments
    /// * `torque_nm` - (N m) of the brake
    pub(super) fn balanced(&self, torque_nm: f64) -> (Vec<f64>, Vec<f64>) {
        let forces_n = self.balancing_forces_n(torque_nm);
        let displacement = (0..self.modes())
            .map(|n| {
                let meshes: f64 =
                    self.lines.iter().zip(&forces_n).map(|(line, force_n)| line.at_middle[n] * force_n).sum();
                let load = self.brake[n] * torque_nm - meshes;
                // What turns freely is in balance already.
                if self.stiffness[n] == 0.0 { 0.0 } else { load / self.stiffness[n] }
            })
            .collect();
        (forces_n, displacement)
    }

    /// (N) The static forces of the meshes that hold the shafts that turn freely.
    ///
    /// # Arguments
    /// * `torque_nm` - (N m) of the brake
    pub(crate) fn balancing_forces_n(&self, torque_nm: f64) -> Vec<f64> {
        let free = self.free_modes();
        let torques = DVector::from_iterator(free.len(), free.iter().map(|&n| torque_nm * self.brake[n]));
        solve(&self.line_entries(&free).transpose(), &torques).iter().copied().collect()
    }

    /// The modes with the meshes closed, of those up to a frequency without them; damping does not couple them.
    ///
    /// # Arguments
    /// * `meshes` - closed
    /// * `highest_rad_per_s` - (rad/s) natural frequency of the highest mode that counts
    pub fn closed_modes(&self, meshes: &[ClosedMesh], highest_rad_per_s: f64) -> Vec<ClosedMode> {
        let low: Vec<usize> =
            (0..self.modes()).filter(|&n| self.stiffness[n].sqrt() <= highest_rad_per_s).collect();
        let of_low = |values: &[f64]| DVector::from_iterator(low.len(), low.iter().map(|&n| values[n]));
        let mut closed = DMatrix::from_diagonal(&of_low(&self.stiffness));
        let mut damping = DMatrix::from_diagonal(&of_low(&self.damping));
        let columns: Vec<DVector<f64>> = self.lines.iter().map(|line| of_low(&line.at_middle)).collect();
        for (column, mesh) in columns.iter().zip(meshes) {
            let stiffness = column * column.transpose() * mesh.stiffness_n_per_m;
            damping += &stiffness * mesh.damping_time_s;
            closed += stiffness;
        }
        let eigen = closed.symmetric_eigen();
        let mode = |(square, shape): (&f64, nalgebra::DVectorView<f64>)| {
            let energy = |(column, mesh): (&DVector<f64>, &ClosedMesh)| {
                mesh.stiffness_n_per_m * column.dot(&shape).powi(2) / square.abs().max(f64::MIN_POSITIVE)
            };
            let frequency_hz = square.max(0.0).sqrt() / TAU;
            ClosedMode {
                decay: DecayingMode { frequency_hz, decay_per_s: (&damping * shape).dot(&shape) / 2.0 },
                mesh_energies: columns.iter().zip(meshes).map(energy).collect(),
            }
        };
        eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()).map(mode).collect()
    }

    /// Of the modes that the meshes move, with the meshes closed: natural frequency in Hz and rate of decay in 1/s of the one that is the
    /// slowest to decay; a rate without end where they move none.
    ///
    /// # Arguments
    /// * `meshes` - closed
    /// * `highest_rad_per_s` - (rad/s) natural frequency of the highest mode that counts
    pub(crate) fn slowest_closed(&self, meshes: &[ClosedMesh], highest_rad_per_s: f64) -> DecayingMode {
        // An energy is the square of a modal entry, which is rounding below ROUNDING of the largest.
        let is_moved =
            |mode: &ClosedMode| mode.mesh_energies.iter().any(|energy| *energy > ROUNDING * ROUNDING);
        let none = DecayingMode { frequency_hz: 0.0, decay_per_s: f64::INFINITY };
        let moved = self.closed_modes(meshes, highest_rad_per_s).into_iter().filter(is_moved);
        let decays = moved.map(|mode| mode.decay);
        decays.min_by(|a, b| a.decay_per_s.total_cmp(&b.decay_per_s)).unwrap_or(none)
    }

    /// Modal displacement of the shafts that turn freely by which the meshes deflect as asked.
    ///
    /// # Arguments
    /// * `deflection_m` - (m) of each mesh at the middle of its face
    pub(super) fn turned_by(&self, deflection_m: &[f64]) -> Vec<f64> {
        let free = self.free_modes();
        let turned = solve(&self.line_entries(&free), &DVector::from_column_slice(deflection_m));
        let mut displacement = vec![0.0; self.modes()];
        for (&mode, turned) in free.iter().zip(turned.iter()) {
            displacement[mode] = *turned;
        }
        displacement
    }

    /// Numbers of the modes that nothing but a mesh holds.
    fn free_modes(&self) -> Vec<usize> {
        (0..self.modes()).filter(|&n| self.stiffness[n] == 0.0).collect()
    }

    /// Entries of the lines of action in some modes: a row for each mesh.
    fn line_entries(&self, modes: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(self.lines.len(), modes.len(), |line, mode| self.lines[line].at_middle[modes[mode]])
    }

    /// Number of active modes.
    pub fn modes(&self) -> usize {
        self.stiffness.len()
    }

    /// Number of the modes that the meshes move, which come first.
    pub(super) fn modes_moved_by_meshes(&self) -> usize {
        let columns = self.lines.iter().flat_map(|line| std::iter::once(&line.at_middle).chain(&line.to_end));
        let moved = columns.filter_map(|column| column.iter().rposition(|entry| *entry != 0.0));
        moved.max().map_or(0, |last| last + 1)
    }

    /// The columns in which meshes and bearings push the modes, each with the number of its mesh: the lines of action at the middle of each face,
    /// then the stretches of the bearings, along x and y of each, and then what the meshes whose tilt is an unknown have to the end of the face.
    pub(super) fn columns(&self) -> impl Iterator<Item = (&[f64], Option<usize>)> {
        let middles = self.lines.iter().enumerate().map(|(mesh, line)| (&line.at_middle[..], Some(mesh)));
        let bearings = self.bearings.iter().flatten().map(|column| (&column[..], None));
        let ends = self.lines.iter().enumerate();
        let ends = ends.filter_map(|(mesh, line)| Some((&line.to_end.as_ref()?[..], Some(mesh))));
        middles.chain(bearings).chain(ends)
    }

    /// Weights of the machine's coordinates in the motion of a place, as [`Machine::weights`].
    pub(crate) fn weights(&self, place: &str, axis: Axis) -> DVector<f64> {
        weights(&self.places, self.rigid_rotation.len(), place, axis)
    }

    /// Weights of the modes in a combination of the machine's coordinates, and that combination per unit of the rigid rotation.
    ///
    /// # Arguments
    /// * `weights` - of the coordinates
    pub(super) fn of_coordinates(&self, weights: &DVector<f64>) -> (Vec<f64>, f64) {
        let entries = entries(weights);
        let of_modes = self.shapes.iter().map(|shape| sum_or_zero(shape, &entries)).collect();
        (of_modes, self.rigid_rotation.dot(weights))
    }
}

/// Shapes in the coordinates themselves. Most entries of `turn` are 0.
fn turned_back(turn: &DMatrix<f64>, shapes: &DMatrix<f64>, modes: &[usize]) -> Vec<DVector<f64>> {
    let rows = |column: usize| (0..turn.nrows()).map(move |row| (row, column));
    let entries: Vec<_> = (0..turn.ncols()).flat_map(rows).filter(|entry| turn[*entry] != 0.0).collect();
    let shape = |&mode: &usize| {
        let mut shape = DVector::zeros(turn.nrows());
        entries.iter().for_each(|&(row, column)| shape[row] += turn[(row, column)] * shapes[(column, mode)]);
        shape
    };
    modes.iter().map(shape).collect()
}

/// Takes the entries out of a list that are not to stay.
fn take_out<T>(values: &mut Vec<T>, stays: &[bool]) -> Vec<T> {
    let (kept, out): (Vec<_>, Vec<_>) =
        std::mem::take(values).into_iter().zip(stays).partition(|(_, stays)| **stays);
    *values = kept.into_iter().map(|(value, _)| value).collect();
    out.into_iter().map(|(value, _)| value).collect()
}

/// Forces of all motors per rad of the input's angle, and of all brakes per N m of the nominal torque, in turned coordinates: drives
/// act on rotations, which are not turned.
fn drives(machine: &Machine) -> [DVector<f64>; 2] {
    let [mut motors, mut brakes] = [0, 1].map(|_| DVector::zeros(machine.coordinates()));
    for drive in &machine.drives {
        match *drive {
            Drive::Motor { coordinate, stiffness_nm_per_rad, speed_ratio } => {
                motors[coordinate] += stiffness_nm_per_rad * speed_ratio;
            }
            Drive::Brake { coordinate, torque_share } => brakes[coordinate] += torque_share,
        }
    }
    [motors, brakes]
}

/// Solves `A x = b`; where there are more equations than unknowns or fewer, with the least squares.
fn solve(matrix: &DMatrix<f64>, right: &DVector<f64>) -> DVector<f64> {
    if matrix.is_empty() {
        return DVector::zeros(matrix.ncols());
    }
    let exact = matrix.is_square().then(|| matrix.clone().lu().solve(right)).flatten();
    exact.unwrap_or_else(|| {
        let svd = matrix.clone().svd(true, true);
        let rounding = ROUNDING * svd.singular_values.max();
        // Both sets of singular vectors have been asked for.
        svd.solve(right, rounding).unwrap_or_else(|_| DVector::zeros(matrix.ncols()))
    })
}

/// A modal vector without the entries that only rounding makes.
fn clean(vector: DVector<f64>) -> DVector<f64> {
    let largest = vector.amax();
    vector.map(|entry| if entry.abs() < ROUNDING * largest { 0.0 } else { entry })
}

/// Numbers and values of the entries of a vector that are not 0.
fn entries(vector: &DVector<f64>) -> Vec<(usize, f64)> {
    vector.iter().copied().enumerate().filter(|(_, entry)| *entry != 0.0).collect()
}

/// The sum of some coordinates with their weights, or 0 where the terms cancel to rounding: wheels of equal mass move in opposition, and
/// their sum is no signal.
fn sum_or_zero(shape: &DVector<f64>, weights: &[(usize, f64)]) -> f64 {
    const CANCELLED: f64 = 1e-12;
    let terms = weights.iter().map(|&(n, weight)| weight * shape[n]);
    let (sum, size) = (terms.clone().sum::<f64>(), terms.map(f64::abs).sum::<f64>());
    if sum.abs() < CANCELLED * size { 0.0 } else { sum }
}
