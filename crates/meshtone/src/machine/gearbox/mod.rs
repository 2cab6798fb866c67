//! A gearbox as a machine: shafts of beams, wheels on them as rigid discs, bearings in seats, a housing on feet, motor and brake.
//!
//! x and y lie across the shafts, y is up, z runs along the shafts. Every node has the coordinates x, y, z and the rotations φx, φy, φz
//! about them. No coordinate is turned: with several meshes there is no common line of action.

mod beam;
mod housing_modes;
mod parts;
mod planetary;

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector, Vector3};

use super::body::WheelBody;
use super::parts::{AcrossLine, Axis, Drive, LineOfAction, Machine, Place, Spring};
use super::{Spinning, TurningForce, Unbalance};
use crate::keys::Keys;
use crate::wheel::Material;
use beam::{Beam, PER_NODE};
pub use housing_modes::HousingModes;
use housing_modes::HousingPoint;
pub use parts::{Bearing, BearingKind, Coupled, Foot, GearboxShaft, Housing, Seat};
pub use planetary::{RimParts, RimShape, SetCoordinates, SetParts};

/// What the machine is made of.
#[derive(Debug, Clone, Copy)]
pub struct GearboxParts<'a> {
    /// The shafts, each with x and y of its axis in m.
    pub shafts: &'a [(&'a GearboxShaft, [f64; 2])],
    /// Rotation of each shaft over that of the input, positive about z.
    pub speed_ratios: &'a [f64],
    /// The wheels.
    pub discs: &'a [Disc],
    /// The meshes.
    pub meshes: &'a [MeshLine],
    /// The bearings.
    pub bearings: &'a [SeatedBearing<'a>],
    /// The housing; none where the seats stand on the ground.
    pub housing: Option<&'a Housing>,
    /// Material of the shafts.
    pub material: Material,
    /// The unbalances of wheels and shafts.
    pub unbalances: &'a [PlacedUnbalance<'a>],
    /// (kg m²) Inertia of the brake.
    pub brake_inertia_kgm2: f64,
    /// The planetary sets, whose meshes come after the others.
    pub sets: &'a [SetParts],
}

/// A wheel on a shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Number of the shaft.
    pub shaft: usize,
    /// (-) Where along it.
    pub at: f64,
    /// Mass and inertias.
    pub body: WheelBody,
    /// (N m/rad) Torsional stiffness of its body between the bore and the rim with its inertia; none of a rigid disc.
    pub body_stiffness_nm_per_rad: Option<f64>,
}

/// An unbalance on its shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedUnbalance<'a> {
    /// Number of the shaft.
    pub shaft: usize,
    /// (-) Where along it.
    pub at: f64,
    /// How large, and its direction.
    pub unbalance: &'a Unbalance,
}

/// A bearing on its shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeatedBearing<'a> {
    /// Number of the shaft.
    pub shaft: usize,
    /// What the scenario says of it.
    pub bearing: &'a Bearing,
    /// (N/m) Its stiffness across the shaft, of x and y: of a rolling bearing that of the linear spring in its place.
    pub radial_n_per_m: [[f64; 2]; 2],
}

impl<'a> SeatedBearing<'a> {
    /// A bearing with its linear stiffness.
    ///
    /// # Arguments
    /// * `shaft` - number of the shaft
    /// * `bearing` - what the scenario says of it
    pub fn linear(shaft: usize, bearing: &'a Bearing) -> Self {
        let along_x = bearing.stiffness_n_per_m;
        let along_y = bearing.vertical_stiffness_n_per_m.unwrap_or(along_x);
        Self { shaft, bearing, radial_n_per_m: [[along_x, 0.0], [0.0, along_y]] }
    }
}

/// Where two wheels push one another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshLine {
    /// Number of the driving and of the driven wheel.
    pub wheels: [usize; 2],
    /// (m) How far from their middle planes the middle of what their faces have in common is, along z.
    pub offsets_m: [f64; 2],
    /// (m) Their base radii.
    pub base_radii_m: [f64; 2],
    /// (rad) Working pressure angle in the transverse section.
    pub working_pressure_angle_rad: f64,
    /// (-) Force along the shafts per transverse force, `h tan β_b`: positive of a driving wheel with a right-hand helix, 0 of spur wheels.
    pub thrust: f64,
    /// Whether forces across its line of action act too: friction, and a random part.
    pub has_forces_across: bool,
}

impl MeshLine {
    /// The line where the second wheel pushes the first one.
    pub(crate) fn exchanged(mut self) -> Self {
        self.wheels.reverse();
        self.offsets_m.reverse();
        self.base_radii_m.reverse();
        Self { thrust: -self.thrust, ..self }
    }
}

/// A place at which the motion can be measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GearboxPlace {
    /// The seat of a bearing, by its number.
    Seat(usize),
    /// A shaft, by its number, at a part of its length.
    Shaft(usize, f64),
    /// A point of the housing, or of the ground where there is none.
    Housing([f64; 3]),
}

/// A gearbox in coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct GearboxMachine {
    /// Its parts.
    pub machine: Machine,
    /// (m) For each shaft, how far from its beginning its nodes lie, with the first coordinate of each.
    nodes: Vec<Vec<(f64, usize)>>,
    /// First coordinate of the housing and (m) its centre; none without one.
    housing: Option<(usize, Vector3<f64>)>,
    /// The housing's modes, and the coordinate of the first; none of a rigid housing.
    housing_modes: Option<(usize, HousingModes)>,
    /// First coordinate of each bearing's seat.
    seats: Vec<usize>,
    /// The coordinate of each wheel's rotation: that of its node where the disc is rigid.
    rotations: Vec<usize>,
    /// Rotation of each shaft over that of the input.
    pub speed_ratios: Vec<f64>,
    /// The coordinates of each planetary set.
    pub sets: Vec<SetCoordinates>,
}

/// Least distance of two nodes, as a part of the shaft's length: what is closer is one node.
const SAME_NODE: f64 = 1e-9;

/// Where the nodes of a shaft lie, as parts of its length: at its ends, at every wheel and bearing and where the radius changes, and
/// between these as evenly as the number of elements allows.
///
/// # Arguments
/// * `shaft` - the shaft
/// * `places` - (-) of its wheels and bearings
fn node_places(shaft: &GearboxShaft, places: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut until_mm = 0.0;
    let ends_of_pieces: Vec<f64> = (shaft.segments.iter())
        .map(|[length_mm, _]| {
            until_mm += length_mm;
            until_mm / shaft.length_mm
        })
        .filter(|place| *place < 1.0)
        .collect();
    let mut fixed: Vec<f64> = [0.0, 1.0].into_iter().chain(places).chain(ends_of_pieces).collect();
    fixed.sort_by(f64::total_cmp);
    fixed.dedup_by(|a, b| (*a - *b).abs() < SAME_NODE);
    let mut nodes = vec![fixed[0]];
    for ends in fixed.windows(2) {
        let part = ends[1] - ends[0];
        let pieces = ((part * f64::from(shaft.elements)).round() as usize).max(1);
        nodes.extend((1..=pieces).map(|piece| ends[0] + part * piece as f64 / pieces as f64));
    }
    nodes
}

/// (rad/s) Natural frequency, 1.6 MHz, from which on a spring between two bodies is a constraint: no motion that is simulated tells it from a
/// stiffer one. The modes are found to 2e-16 of the square of the highest one, so that a stiffer spring would take the digits of
/// all others: at 1e13 N m/rad free rotation would be a vibration of 10 Hz.
const CONSTRAINT_RAD_PER_S: f64 = 1e7;

/// (N/m, N m/rad) The stiffness of a spring, or that of a constraint in its place.
///
/// # Arguments
/// * `mass` - of all bodies
/// * `stretch` - number of a coordinate and its weight in what the spring resists
/// * `stiffness` - (N/m, N m/rad) as it is given
fn limited_stiffness(mass: &DMatrix<f64>, stretch: &[(usize, f64)], stiffness: f64) -> f64 {
    let per_mass: f64 =
        stretch.iter().map(|&(coordinate, weight)| weight * weight / mass[(coordinate, coordinate)]).sum();
    stiffness.min(CONSTRAINT_RAD_PER_S.powi(2) / per_mass)
}

/// The machine while it is put together.
struct Assembly {
    names: Vec<Cow<'static, str>>,
    mass: DMatrix<f64>,
    /// One of each damping ratio.
    springs: Vec<Spring>,
}

impl Assembly {
    /// The spring of a damping ratio, to which a part is added.
    fn spring(&mut self, damping_ratio: f64) -> &mut Spring {
        let known = self.springs.iter().position(|spring| spring.damping_ratio == damping_ratio);
        let number = known.unwrap_or_else(|| {
            self.springs.push(Spring::new(self.mass.nrows(), damping_ratio));
            self.springs.len() - 1
        });
        &mut self.springs[number]
    }

    /// Adds a spring between bodies whose masses are all there: one so stiff that it is a constraint as [`CONSTRAINT_RAD_PER_S`] says.
    ///
    /// # Arguments
    /// * `stretch` - number of a coordinate and its weight in what the spring resists
    /// * `stiffness` - (N/m, N m/rad) as it is given
    /// * `damping_ratio` - (-) of the spring
    fn hold(&mut self, stretch: &[(usize, f64)], stiffness: f64, damping_ratio: f64) {
        let limited = limited_stiffness(&self.mass, stretch, stiffness);
        self.spring(damping_ratio).resist(stretch, limited);
    }

    /// Adds a rigid body at a node.
    fn add_body(&mut self, node: usize, mass_kg: f64, [about_x, about_y, about_z]: [f64; 3]) {
        let values = [mass_kg, mass_kg, mass_kg, about_x, about_y, about_z];
        for (coordinate, value) in values.into_iter().enumerate() {
            self.mass[(node + coordinate, node + coordinate)] += value;
        }
    }

    fn add_beam(&mut self, nodes: [usize; 2], beam: &Beam, damping_ratio: f64) {
        let (mass, stiffness) = (beam.mass(), beam.stiffness());
        let coordinate = |local: usize| nodes[local / PER_NODE] + local % PER_NODE;
        for row in 0..2 * PER_NODE {
            for column in 0..2 * PER_NODE {
                self.mass[(coordinate(row), coordinate(column))] += mass[(row, column)];
            }
        }
        let spring = self.spring(damping_ratio);
        for row in 0..2 * PER_NODE {
            for column in 0..2 * PER_NODE {
                spring.stiffness[(coordinate(row), coordinate(column))] += stiffness[(row, column)];
            }
        }
    }
}

/// Motion of a point of a rigid body along each axis, by the body's coordinates: `u + φ × r`.
///
/// # Arguments
/// * `body` - the body's first coordinate
/// * `r` - (m) from its centre to the point
fn point_of_body(body: usize, r: Vector3<f64>) -> [Vec<(usize, f64)>; 3] {
    let [x, y, z] = [0, 1, 2].map(|axis| body + axis);
    let [about_x, about_y, about_z] = [3, 4, 5].map(|axis| body + axis);
    [
        vec![(x, 1.0), (about_y, r.z), (about_z, -r.y)],
        vec![(y, 1.0), (about_z, r.x), (about_x, -r.z)],
        vec![(z, 1.0), (about_x, r.y), (about_y, -r.x)],
    ]
}

impl GearboxMachine {
    /// Puts the machine together.
    ///
    /// Coordinates are counted shaft by shaft, node by node from its beginning on; then come the housing, the seats in the order of the bearings,
    /// the brake's rotation, the modes of the housing, and the rotations of wheels on elastic bodies. The parts are then added one after the other.
    ///
    /// # Arguments
    /// * `parts` - what it is made of
    pub fn new(parts: &GearboxParts) -> Self {
        let mut next = 0;
        let mut names: Vec<Cow<'static, str>> = Vec::new();
        let mut add_node = |of: &str| {
            next += PER_NODE;
            let axes = ["x", "y", "z", "phi_x", "phi_y", "phi_z"];
            names.extend(axes.map(|axis| Cow::from(format!("{axis}_{of}"))));
            next - PER_NODE
        };
        let nodes: Vec<Vec<(f64, usize)>> = (parts.shafts.iter().enumerate())
            .map(|(number, (shaft, _))| {
                let discs = parts.discs.iter().filter(|disc| disc.shaft == number).map(|disc| disc.at);
                let bearings = parts.bearings.iter().filter(|of| of.shaft == number).map(|of| of.bearing.at);
                let places = node_places(shaft, discs.chain(bearings));
                let node = |(n, place): (usize, &f64)| {
                    (place * shaft.length_mm * 1e-3, add_node(&format!("{}_{n}", shaft.name)))
                };
                places.iter().enumerate().map(node).collect()
            })
            .collect();
        let housing = parts.housing.map(|_| (add_node("housing"), centre_m(parts.shafts)));
        let seats: Vec<usize> = (parts.bearings.iter())
            .map(|of| add_node(&format!("seat_{}_{}", parts.shafts[of.shaft].0.name, of.bearing.at)))
            .collect();
        let brake = next;
        names.push("phi_z_brake".into());
        let housing_modes = parts.housing.map(|housing| (names.len(), housing.modes));
        let modes = housing_modes.map_or(0, |(_, modes)| modes.count());
        names.extend((1..=modes).map(|mode| Cow::from(format!("housing_mode_{mode}"))));
        let node_of = |disc: &Disc| {
            let z_m = disc.at * parts.shafts[disc.shaft].0.length_mm * 1e-3;
            nearest_node(&nodes[disc.shaft], z_m)
        };
        let rotation = |(number, disc): (usize, &Disc)| match disc.body_stiffness_nm_per_rad {
            Some(_) => {
                names.push(format!("phi_z_wheel_{number}").into());
                names.len() - 1
            }
            None => node_of(disc) + ABOUT_Z,
        };
        let rotations: Vec<usize> = parts.discs.iter().enumerate().map(rotation).collect();
        let sets: Vec<SetCoordinates> =
            parts.sets.iter().map(|set| SetCoordinates::new(set, &mut names)).collect();
        let coordinates = names.len();
        let mut assembly =
            Assembly { names, mass: DMatrix::zeros(coordinates, coordinates), springs: Vec::new() };
        assembly.mass[(brake, brake)] = parts.brake_inertia_kgm2;
        let this = Self {
            machine: Machine {
                names: Vec::new(),
                mass: DMatrix::zeros(0, 0),
                turn: DMatrix::identity(coordinates, coordinates),
                springs: Vec::new(),
                lines: Vec::new(),
                bearings: Vec::new(),
                turning_forces: Vec::new(),
                spinning: Vec::new(),
                drives: Vec::new(),
                places: Vec::new(),
                rigid_rotation: DVector::zeros(coordinates),
            },
            nodes,
            housing,
            housing_modes,
            seats,
            rotations,
            speed_ratios: parts.speed_ratios.to_vec(),
            sets,
        };
        this.add_shafts(parts, brake, &mut assembly);
        this.add_supports(parts, &mut assembly);
        let end = |shaft: usize, is_at_end: bool| {
            let nodes = &this.nodes[shaft];
            if is_at_end { nodes[nodes.len() - 1].1 + ABOUT_Z } else { first_rotation(nodes) }
        };
        let sets = || this.sets.iter().zip(parts.sets);
        sets().for_each(|(set, of)| set.add(of, end, &mut assembly));
        let Assembly { names, mass, springs } = assembly;
        let mut machine = Machine {
            names,
            springs,
            lines: (parts.meshes.iter())
                .map(|mesh| this.line_of_action(parts, mesh, coordinates))
                .chain(sets().flat_map(|(set, of)| set.lines(of, coordinates)))
                .collect(),
            bearings: this.rolling_bearings(parts, coordinates),
            turning_forces: this.turning_forces(parts, &mass),
            drives: this.drives(parts, brake, &mass),
            mass,
            ..this.machine
        };
        for (nodes, ratio) in this.nodes.iter().zip(parts.speed_ratios) {
            nodes.iter().for_each(|(_, node)| machine.rigid_rotation[node + ABOUT_Z] = *ratio);
        }
        for (rotation, disc) in this.rotations.iter().zip(parts.discs) {
            machine.rigid_rotation[*rotation] = parts.speed_ratios[disc.shaft];
        }
        let brakes = parts.shafts.iter().zip(parts.speed_ratios);
        let ratio_of_brake =
            brakes.filter(|((shaft, _), _)| shaft.couples_to == Coupled::Brake).map(|(_, ratio)| *ratio);
        machine.rigid_rotation[brake] = ratio_of_brake.sum();
        sets().for_each(|(set, of)| set.turn(of, &mut machine.rigid_rotation));
        Self { machine, ..this }
    }

    /// First coordinate of the node of a shaft nearest to a place.
    fn node(&self, shaft: usize, z_m: f64) -> usize {
        nearest_node(&self.nodes[shaft], z_m)
    }

    /// First coordinate of a wheel's node.
    fn node_of_disc(&self, parts: &GearboxParts, disc: usize) -> usize {
        let Disc { shaft, at, .. } = parts.discs[disc];
        self.node(shaft, at * parts.shafts[shaft].0.length_mm * 1e-3)
    }

    /// Adds beams, wheels and couplings.
    fn add_shafts(&self, parts: &GearboxParts, brake: usize, assembly: &mut Assembly) {
        for (nodes, (shaft, _)) in self.nodes.iter().zip(parts.shafts) {
            for ends in nodes.windows(2) {
                let beam = beam_between(shaft, [ends[0].0, ends[1].0], parts.material);
                assembly.add_beam([ends[0].1, ends[1].1], &beam, shaft.damping_ratio);
            }
        }
        for (number, disc) in parts.discs.iter().enumerate() {
            let WheelBody { mass_kg, polar_kgm2, transverse_kgm2 } = disc.body;
            let node = self.node_of_disc(parts, number);
            assembly.add_body(node, mass_kg, [transverse_kgm2, transverse_kgm2, 0.0]);
            let rotation = self.rotations[number];
            assembly.mass[(rotation, rotation)] += polar_kgm2;
            if let Some(stiffness) = disc.body_stiffness_nm_per_rad {
                let (shaft, _) = parts.shafts[disc.shaft];
                assembly.hold(&[(rotation, 1.0), (node + ABOUT_Z, -1.0)], stiffness, shaft.damping_ratio);
            }
        }
        for (nodes, (shaft, _)) in self.nodes.iter().zip(parts.shafts) {
            let stretch = match shaft.couples_to {
                Coupled::Motor => vec![(first_rotation(nodes), 1.0)],
                Coupled::Brake => vec![(nodes[nodes.len() - 1].1 + ABOUT_Z, 1.0), (brake, -1.0)],
                Coupled::Nothing => continue,
            };
            assembly.hold(&stretch, shaft.coupling_nm_per_rad(), shaft.damping_ratio);
        }
    }

    /// Adds bearings, seats and the housing with its feet.
    fn add_supports(&self, parts: &GearboxParts, assembly: &mut Assembly) {
        if let (Some(housing), Some((body, _))) = (parts.housing, self.housing) {
            assembly.add_body(body, housing.mass_kg, [housing.moment_of_inertia_kgm2(); 3]);
            if let Some((first, modes)) = self.housing_modes {
                for (mode, rad_per_s) in modes.angular_frequencies().into_iter().enumerate() {
                    assembly.mass[(first + mode, first + mode)] = housing.mass_kg;
                    let stiffness_n_per_m = housing.mass_kg * rad_per_s * rad_per_s;
                    assembly.spring(modes.damping_ratio).resist(&[(first + mode, 1.0)], stiffness_n_per_m);
                }
            }
        }
        for (number, (&SeatedBearing { shaft, bearing, radial_n_per_m }, &seat)) in
            parts.bearings.iter().zip(&self.seats).enumerate()
        {
            let (of_shaft, [x_m, y_m]) = parts.shafts[shaft];
            let z_m = of_shaft.z_mm(bearing.at) * 1e-3;
            let node = self.node(shaft, bearing.at * of_shaft.length_mm * 1e-3);
            let Seat { mass_kg, inertia_kgm2, tilt_stiffness_nm_per_rad, .. } = bearing.seat;
            let of_seat = along_axes(bearing.seat.stiffness_n_per_m, bearing.seat.vertical_stiffness_n_per_m);
            assembly.add_body(seat, mass_kg, [inertia_kgm2; 3]);
            let tilt = bearing.tilt_stiffness_nm_per_rad;
            let [[xx, xy], [_, yy]] = radial_n_per_m;
            let inner = [xx, yy, bearing.axial_n_per_m(), tilt, tilt];
            let stretch = |coordinate: usize| [(node + coordinate, 1.0), (seat + coordinate, -1.0)];
            for (coordinate, stiffness) in inner.into_iter().enumerate() {
                assembly.hold(&stretch(coordinate), stiffness, bearing.damping_ratio);
            }
            let spring = assembly.spring(bearing.damping_ratio);
            spring.couple(&stretch(0), &stretch(1), xy);
            spring.couple(&stretch(1), &stretch(0), xy);
            let held = match self.housing {
                Some((housing, centre)) => point_of_body(housing, Vector3::new(x_m, y_m, z_m) - centre),
                None => [Vec::new(), Vec::new(), Vec::new()],
            };
            for (axis, held) in held.into_iter().enumerate() {
                let mut stretch = vec![(seat + axis, 1.0)];
                let shapes = self.housing_shapes(HousingPoint::Seat(number), axis);
                let held = held.into_iter().chain(shapes);
                stretch.extend(held.map(|(coordinate, weight)| (coordinate, -weight)));
                assembly.hold(&stretch, of_seat[axis], bearing.damping_ratio);
                let mut twist = vec![(seat + 3 + axis, 1.0)];
                twist.extend(self.housing.map(|(housing, _)| (housing + 3 + axis, -1.0)));
                assembly.hold(&twist, tilt_stiffness_nm_per_rad, bearing.damping_ratio);
            }
        }
        if let (Some(housing), Some((body, centre))) = (parts.housing, self.housing) {
            for foot in feet(housing, parts.shafts) {
                let place = Vector3::from(foot.at_mm) * 1e-3;
                let of_foot = along_axes(foot.stiffness_n_per_m, foot.vertical_stiffness_n_per_m);
                for (stretch, stiffness) in point_of_body(body, place - centre).iter().zip(of_foot) {
                    assembly.hold(stretch, stiffness, housing.damping_ratio);
                }
            }
        }
    }

    /// The forces of unbalances and of bent shafts. A bent shaft resists being straightened: it pushes with `K u₀`, its stiffness times its
    /// shape without a load.
    fn turning_forces(&self, parts: &GearboxParts, mass: &DMatrix<f64>) -> Vec<TurningForce> {
        let coordinates = mass.nrows();
        let of_unbalance = |of: &PlacedUnbalance| {
            let motion = self.between_nodes(of.shaft, of.at);
            let [x, y] = [0, 1].map(|axis| {
                let mut along = DVector::zeros(coordinates);
                motion[axis].iter().for_each(|&(coordinate, weight)| along[coordinate] += weight);
                along
            });
            TurningForce::of_unbalance(of.unbalance, parts.speed_ratios[of.shaft], [x, y])
        };
        let of_bow = |number: usize| {
            let (nodes, (shaft, _)) = (&self.nodes[number], parts.shafts[number]);
            let wave_per_m = std::f64::consts::PI / (shaft.length_mm * 1e-3);
            let middle_m = shaft.bow.middle_um * 1e-6;
            let forces = [0, 1].map(|axis| {
                let mut force = DVector::zeros(coordinates);
                for ends in nodes.windows(2) {
                    let beam = beam_between(shaft, [ends[0].0, ends[1].0], parts.material);
                    let mut shape = DVector::zeros(2 * PER_NODE);
                    for (node, (z_m, _)) in ends.iter().enumerate() {
                        let (sin, cos) = (wave_per_m * z_m).sin_cos();
                        shape[node * PER_NODE + axis] = middle_m * sin;
                        // Along the shaft x grows with φy, and y falls with φx.
                        let slope = if axis == 0 { (ABOUT_Y, 1.0) } else { (ABOUT_X, -1.0) };
                        shape[node * PER_NODE + slope.0] = slope.1 * middle_m * wave_per_m * cos;
                    }
                    let pushed = beam.stiffness() * shape;
                    for (local, value) in pushed.iter().enumerate() {
                        force[ends[local / PER_NODE].1 + local % PER_NODE] += value;
                    }
                }
                force
            });
            TurningForce::new(parts.speed_ratios[number], false, forces, shaft.bow.angle_deg)
        };
        let bent = (0..parts.shafts.len()).filter(|&number| parts.shafts[number].0.bow.middle_um > 0.0);
        let of_pins = self.sets.iter().zip(parts.sets).filter_map(|(set, of)| set.pin_errors(of, mass));
        parts.unbalances.iter().map(of_unbalance).chain(bent.map(of_bow)).chain(of_pins).collect()
    }

    /// Stretch of each rolling bearing along x and y, of planets along ζ and η.
    fn rolling_bearings(&self, parts: &GearboxParts, coordinates: usize) -> Vec<[DVector<f64>; 2]> {
        let stretch = |(of, seat): (&SeatedBearing, &usize)| {
            let node = self.node(of.shaft, of.bearing.at * parts.shafts[of.shaft].0.length_mm * 1e-3);
            [0, 1].map(|axis| {
                let mut stretch = DVector::zeros(coordinates);
                stretch[node + axis] = 1.0;
                stretch[seat + axis] = -1.0;
                stretch
            })
        };
        let rolling = parts.bearings.iter().zip(&self.seats).filter(|(of, _)| of.bearing.element().is_some());
        let of_planets =
            self.sets.iter().zip(parts.sets).flat_map(|(set, of)| set.rolling_bearings(of, coordinates));
        rolling.map(stretch).chain(of_planets).collect()
    }

    /// What turns with each node. Beams count half at either end.
    ///
    /// # Arguments
    /// * `parts` - what the machine is made of
    pub fn spinning(&self, parts: &GearboxParts) -> Vec<Spinning> {
        let discs = parts.discs.iter().enumerate().map(|(number, disc)| Spinning {
            about_x: self.node_of_disc(parts, number) + ABOUT_X,
            polar_kgm2: disc.body.polar_kgm2 * parts.speed_ratios[disc.shaft],
        });
        let beams = self.nodes.iter().zip(parts.shafts).zip(parts.speed_ratios).flat_map(
            |((nodes, (shaft, _)), ratio)| {
                nodes.windows(2).flat_map(move |ends| {
                    let half_kgm2 =
                        beam_between(shaft, [ends[0].0, ends[1].0], parts.material).polar_kgm2() / 2.0;
                    [ends[0].1, ends[1].1]
                        .map(|node| Spinning { about_x: node + ABOUT_X, polar_kgm2: half_kgm2 * ratio })
                })
            },
        );
        discs.chain(beams).collect()
    }

    /// (N) Static load of each rolling bearing along x and y, with closed meshes; all of a shaft's bearings share it by their springs.
    ///
    /// # Arguments
    /// * `parts` - what the machine is made of
    /// * `torque_nm` - (N m) of the brake
    pub fn static_bearing_loads_n(&self, parts: &GearboxParts, torque_nm: f64) -> Vec<[f64; 2]> {
        const MESH_N_PER_M: f64 = 3e8;
        let machine = &self.machine;
        let stiffness = machine.closed_stiffness(&vec![MESH_N_PER_M; machine.lines.len()]);
        let displacement =
            machine.displaced_by(stiffness, &[machine.load_at_rest(torque_nm)]).column(0).into_owned();
        let rolling = parts.bearings.iter().filter(|of| of.bearing.element().is_some());
        let of_planets = parts.sets.iter().flat_map(|set| {
            set.rolling_n_per_m.iter().map(|(planet, spring)| (*spring, set.pin_errors_m[*planet]))
        });
        let on_shafts = rolling.map(|of| (of.radial_n_per_m, [0.0; 2]));
        let springs = on_shafts.chain(of_planets).zip(&machine.bearings);
        // A pin off its place presses its planet's bearing by as much as the planet does not give way.
        springs
            .map(|((spring, off_m), stretch)| {
                let [x_m, y_m] = [0, 1].map(|axis| stretch[axis].dot(&displacement) + off_m[axis]);
                spring.map(|[of_x, of_y]| of_x * x_m + of_y * y_m)
            })
            .collect()
    }

    /// The line of action of a mesh: the driving wheel, which turns in the sense s about z, pushes the other one along
    /// `n = s cos α t + sin α c − s h tan β_b z`, c the direction from centre to centre, `t = z × c`, and h the hand of the driving wheel's
    /// helix. With the arm r from each wheel's own centre to the pitch point midway along what the faces have in common it is `[n; r × n]` of the
    /// driving wheel, less the same of the driven one.
    /// Deflections and forces along it are those of the transverse section, in which `F r_b` is the torque.
    ///
    /// Friction acts along `q = −s z × n`, against the sliding of the driving wheel's flank beyond the pitch point. At the distance d from
    /// there its arm is longer by `d n`, which adds the moment `d n × q = −s d z`.
    fn line_of_action(&self, parts: &GearboxParts, mesh: &MeshLine, coordinates: usize) -> LineOfAction {
        let [driving, driven] = mesh.wheels;
        let centre = |disc: usize| {
            let [x, y] = parts.shafts[parts.discs[disc].shaft].1;
            Vector3::new(x, y, 0.0)
        };
        let c = (centre(driven) - centre(driving)).normalize();
        let along = Vector3::z();
        let sense = parts.speed_ratios[parts.discs[driving].shaft].signum();
        let (sin, cos) = mesh.working_pressure_angle_rad.sin_cos();
        let n = along.cross(&c) * (sense * cos) + c * sin - along * (sense * mesh.thrust);
        let zeros = || DVector::zeros(coordinates);
        let mut line = LineOfAction { at_middle: zeros(), per_m: zeros(), across: None };
        let mut across = AcrossLine { at_pitch_point: zeros(), per_m: zeros() };
        let q = along.cross(&n) * -sense;
        for (disc, of, side) in [(driving, 0, 1.0), (driven, 1, -1.0)] {
            let node = self.node_of_disc(parts, disc);
            let arm = c * (side * mesh.base_radii_m[of] / cos) + along * mesh.offsets_m[of];
            let (moment, per_m) = (arm.cross(&n), along.cross(&n));
            let moment_across = arm.cross(&q);
            for axis in 0..3 {
                line.at_middle[node + axis] = side * n[axis];
                line.at_middle[node + 3 + axis] = side * moment[axis];
                line.per_m[node + 3 + axis] = side * per_m[axis];
                across.at_pitch_point[node + axis] = side * q[axis];
                across.at_pitch_point[node + 3 + axis] = side * moment_across[axis];
            }
            let rotation = self.rotations[disc];
            line.at_middle.swap_rows(node + ABOUT_Z, rotation);
            across.at_pitch_point.swap_rows(node + ABOUT_Z, rotation);
            across.per_m[rotation] = -side * sense;
        }
        line.across = mesh.has_forces_across.then_some(across);
        line
    }

    /// The coordinates of the housing's modes, each with its shape at a point along an axis.
    fn housing_shapes(&self, point: HousingPoint, axis: usize) -> Vec<(usize, f64)> {
        let shapes =
            |(first, modes): (usize, HousingModes)| (first..).zip(modes.shapes(point, axis)).collect();
        self.housing_modes.map_or_else(Vec::new, shapes)
    }

    /// The motor turns its shaft at its beginning; the brake's torque acts against its rotation.
    fn drives(&self, parts: &GearboxParts, brake: usize, mass: &DMatrix<f64>) -> Vec<Drive> {
        let mut drives = Vec::new();
        for ((nodes, (shaft, _)), ratio) in self.nodes.iter().zip(parts.shafts).zip(parts.speed_ratios) {
            match shaft.couples_to {
                Coupled::Motor => {
                    let coordinate = first_rotation(nodes);
                    drives.push(Drive::Motor {
                        coordinate,
                        stiffness_nm_per_rad: limited_stiffness(
                            mass,
                            &[(coordinate, 1.0)],
                            shaft.coupling_nm_per_rad(),
                        ),
                        speed_ratio: *ratio,
                    });
                }
                Coupled::Brake => {
                    drives.push(Drive::Brake { coordinate: brake, torque_share: -ratio.signum() });
                }
                Coupled::Nothing => {}
            }
        }
        drives
    }

    /// Names a place where the motion can be measured, along x, y and z.
    ///
    /// # Arguments
    /// * `name` - the name that an output has for it
    /// * `place` - where it is
    pub fn add_place(&mut self, name: String, place: GearboxPlace) {
        let along = |node: usize| [0, 1, 2].map(|axis| vec![(node + axis, 1.0)]);
        let motion = match place {
            GearboxPlace::Seat(bearing) => along(self.seats[bearing]),
            GearboxPlace::Shaft(shaft, at) => self.between_nodes(shaft, at),
            GearboxPlace::Housing(at_m) => match self.housing {
                Some((housing, centre)) => {
                    let mut motion = point_of_body(housing, Vector3::from(at_m) - centre);
                    for (axis, motion) in motion.iter_mut().enumerate() {
                        motion.extend(self.housing_shapes(HousingPoint::At(at_m), axis));
                    }
                    motion
                }
                None => [Vec::new(), Vec::new(), Vec::new()],
            },
        };
        let motion = [Axis::X, Axis::Y, Axis::Z].into_iter().zip(motion).collect();
        self.machine.places.push(Place { name: name.into(), motion });
    }

    /// The motion of a shaft at a place, straight between the nodes.
    fn between_nodes(&self, shaft: usize, at: f64) -> [Vec<(usize, f64)>; 3] {
        let nodes = &self.nodes[shaft];
        let z_m = at * nodes[nodes.len() - 1].0;
        let after = nodes.iter().position(|(node_m, _)| *node_m >= z_m).unwrap_or(nodes.len() - 1).max(1);
        let ((before_m, before), (after_m, after)) = (nodes[after - 1], nodes[after]);
        let part = (z_m - before_m) / (after_m - before_m);
        [0, 1, 2].map(|axis| vec![(before + axis, 1.0 - part), (after + axis, part)])
    }

    /// Names the rotation of a shaft at its beginning, positive as it turns.
    ///
    /// # Arguments
    /// * `name` - the name that an output has for it
    /// * `shaft` - its number
    pub fn add_rotation(&mut self, name: String, shaft: usize) {
        let motion = vec![(self.nodes[shaft][0].1 + ABOUT_Z, self.speed_ratios[shaft].signum())];
        self.machine.places.push(Place { name: name.into(), motion: vec![(Axis::Rotation, motion)] });
    }

    /// Names how far the wheels of a mesh have turned against one another, along the line of action: the transmission error with the sign
    /// by which the mesh is pressed.
    ///
    /// # Arguments
    /// * `name` - the name that an output has for it
    /// * `mesh` - its number
    pub fn add_transmission_error(&mut self, name: String, mesh: usize) {
        let line = &self.machine.lines[mesh].at_middle;
        // A planet is carried along by its carrier.
        let of_sets = self.sets.iter().flat_map(SetCoordinates::rotations);
        let turned = self.rotations.iter().copied().chain(of_sets).map(|rotation| (rotation, line[rotation]));
        let motion = turned.filter(|(_, weight)| *weight != 0.0).collect();
        self.machine.places.push(Place { name: name.into(), motion: vec![(Axis::Rotation, motion)] });
    }
}

/// Coordinates of a node: its rotations about x, about y and about the shaft.
const ABOUT_X: usize = 3;
const ABOUT_Y: usize = 4;
const ABOUT_Z: usize = 5;

/// (N/m) Stiffness along x, y and z.
fn along_axes(stiffness: f64, vertical: Option<f64>) -> [f64; 3] {
    [stiffness, vertical.unwrap_or(stiffness), stiffness]
}

/// The coordinate that the motor turns: the rotation of a shaft's first node.
fn first_rotation(nodes: &[(f64, usize)]) -> usize {
    nodes[0].1 + ABOUT_Z
}

/// First coordinate of the one of a shaft's nodes that is nearest to a place.
fn nearest_node(nodes: &[(f64, usize)], z_m: f64) -> usize {
    let nearest = nodes.iter().min_by(|a, b| (a.0 - z_m).abs().total_cmp(&(b.0 - z_m).abs()));
    nearest.map_or(0, |(_, node)| *node)
}

/// The beam of a shaft between two nodes.
///
/// # Arguments
/// * `shaft` - the shaft
/// * `ends_m` - (m) z of the nodes
/// * `material` - of the shaft
fn beam_between(shaft: &GearboxShaft, [from_m, to_m]: [f64; 2], material: Material) -> Beam {
    let middle_m = (from_m + to_m) / 2.0;
    Beam {
        length_m: to_m - from_m,
        radius_m: shaft.radius_at_mm(middle_m * 1e3 / shaft.length_mm) * 1e-3,
        bore_radius_m: shaft.bore_radius_mm * 1e-3,
        material,
    }
}

/// (m) Centre of the housing: the mean of the shafts' axes, midway between the first beginning and the last end of a shaft.
fn centre_m(shafts: &[(&GearboxShaft, [f64; 2])]) -> Vector3<f64> {
    let mean = |axis: usize| {
        shafts.iter().map(|(_, position_m)| position_m[axis]).sum::<f64>() / shafts.len() as f64
    };
    Vector3::new(mean(0), mean(1), ends_mm(shafts).iter().sum::<f64>() * 0.5e-3)
}

/// (m) Least and largest coordinate of the shafts' axes.
fn extremes(shafts: &[(&GearboxShaft, [f64; 2])], axis: usize) -> [f64; 2] {
    let values = || shafts.iter().map(|(_, position_m)| position_m[axis]);
    [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
}

/// (mm) z of the first beginning and of the last end of a shaft.
fn ends_mm(shafts: &[(&GearboxShaft, [f64; 2])]) -> [f64; 2] {
    let ends = |at: f64| shafts.iter().map(move |(shaft, _)| shaft.z_mm(at));
    [ends(0.0).fold(f64::INFINITY, f64::min), ends(1.0).fold(f64::NEG_INFINITY, f64::max)]
}

/// The housing's feet, given or by default.
fn feet(housing: &Housing, shafts: &[(&GearboxShaft, [f64; 2])]) -> Vec<Foot> {
    if !housing.feet.is_empty() {
        return housing.feet.clone();
    }
    const OUTSIDE_MM: f64 = 100.0;
    let [[left, right], [low, _]] = [0, 1].map(|axis| extremes(shafts, axis).map(|value| value * 1e3));
    let corners = [left - OUTSIDE_MM, right + OUTSIDE_MM].into_iter();
    corners
        .flat_map(|x| ends_mm(shafts).map(|z| Foot { at_mm: [x, low - OUTSIDE_MM, z], ..Foot::start() }))
        .collect()
}
