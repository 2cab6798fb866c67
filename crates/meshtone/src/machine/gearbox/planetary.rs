//! Planetary sets in a gearbox: rigid bodies and an elastic rim in the frame of the carrier, where lines of action do not turn.
//!
//! Sun, carrier and ring have the coordinates x, y and their rotation, a planet ζ along the line from the axis to its pin, η across that line in the
//! sense of positive rotation, and its rotation. All of them are small motions beside those of the rigid set. A set is held across its axis by
//! springs of its own, alike in all directions, and is tied to shafts by rotation only: then nothing in the equations depends on where the carrier
//! stands.
//!
//! Sources: Lin and Parker, J. Vib. Acoust. 121 (1999) 316, of which the rigid set is the model; the ring's rim as a ring that bends without
//! stretching: Love, The Mathematical Theory of Elasticity, 4th ed., §293.

use std::borrow::Cow;
use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::{Assembly, TurningForce, limited_stiffness};
use crate::machine::WheelBody;
use crate::machine::parts::{AcrossLine, LineOfAction};

/// What a planetary set is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct SetParts {
    /// Its name.
    pub name: String,
    /// (rad) Where each planet stands on the carrier, from x towards y.
    pub angles_rad: Vec<f64>,
    /// (m) Distance of the planets' axes from that of the set.
    pub centre_distance_m: f64,
    /// Rotation of sun, carrier and ring over that of the input.
    pub ratios: [f64; 3],
    /// Rotation of the planets against the carrier over that of the input.
    pub planet_ratio: f64,
    /// Number of the shaft of sun, carrier and ring, and whether the member is at its end rather than at its beginning; none of a fixed one.
    pub shafts: [Option<(usize, bool)>; 3],
    /// Mass and inertias of sun, planet, ring and carrier.
    pub bodies: [WheelBody; 4],
    /// (N/m) What holds sun, carrier and ring across the axis.
    pub supports_n_per_m: [f64; 3],
    /// (N m/rad) Between sun, carrier and ring and their shafts, or the ground.
    pub couplings_nm_per_rad: [f64; 3],
    /// (N/m) Stiffness of each pin.
    pub pin_n_per_m: f64,
    /// (N/m) What stands in place of that at planets on rolling bearings: the number of the planet, and the bearing's linear spring along ζ and η.
    pub rolling_n_per_m: Vec<(usize, [[f64; 2]; 2])>,
    /// (m) How far each pin stands off its place, along ζ and along η; empty for none.
    pub pin_errors_m: Vec<[f64; 2]>,
    /// The rim of the ring.
    pub rim: RimParts,
    /// (-) Damping ratio of pins, supports, rim and couplings.
    pub damping_ratio: f64,
    /// Whether the sun drives its planets, seen from the carrier.
    pub sun_drives: bool,
    /// (m) Base radii of sun, planet at the sun, planet at the ring, and ring.
    pub base_radii_m: [f64; 4],
    /// (rad) Working pressure angles of the sun's meshes and the ring's.
    pub working_pressure_angles_rad: [f64; 2],
    /// Whether forces across the lines of action act too.
    pub has_forces_across: bool,
}

/// The elastic rim of a ring, without the motion of the ring as a rigid body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RimParts {
    /// (m) Radius of its middle.
    pub radius_m: f64,
    /// (m) Its thickness.
    pub thickness_m: f64,
    /// (m) Its width.
    pub width_m: f64,
    /// (Pa) Modulus of elasticity.
    pub elasticity_pa: f64,
    /// (kg/m³) Density.
    pub density_kg_per_m3: f64,
    /// (N/m) Stiffness of the support of the whole ring: across its axis, and against its rotation along the base circle.
    pub support_n_per_m: [f64; 2],
    /// The largest number of waves around it.
    pub waves: usize,
}

impl SetParts {
    /// (N/m) Stiffness of a planet's pin, or of the rolling bearing on it, along ζ and η.
    fn pin_n_per_m(&self, planet: usize) -> [[f64; 2]; 2] {
        let rolling = self.rolling_n_per_m.iter().find(|(of, _)| *of == planet);
        rolling.map_or([[self.pin_n_per_m, 0.0], [0.0, self.pin_n_per_m]], |(_, spring)| *spring)
    }

    /// (kg) The mass that the wheels' rotation has along each line of action, those of the sun first.
    pub fn mesh_masses_kg(&self) -> Vec<f64> {
        let [sun, planet, ring, _] = self.bodies.map(|body| body.polar_kgm2);
        let [sun_m, planet_at_sun_m, planet_at_ring_m, ring_m] = self.base_radii_m;
        let mass = |wheels: [(f64, f64); 2]| {
            1.0 / wheels.map(|(of, radius_m)| radius_m * radius_m / of).iter().sum::<f64>()
        };
        let at_sun = mass([(sun, sun_m), (planet, planet_at_sun_m)]);
        // A ring that is held does not turn with its planets.
        let ring = if self.shafts[RING].is_some() { ring } else { f64::INFINITY };
        let at_ring = mass([(planet, planet_at_ring_m), (ring, ring_m)]);
        let planets = self.angles_rad.len();
        [vec![at_sun; planets], vec![at_ring; planets]].concat()
    }
}

impl RimParts {
    /// For each shape the mass and the stiffness of its amplitude.
    ///
    /// The support is spread evenly around the rim, radially and tangentially, so that it holds the rigid ring as stated: `k = π (κ_r + κ_t)` across and
    /// `2π κ_t` around.
    fn shape(&self, shape: RimShape) -> [f64; 2] {
        let Self { radius_m, thickness_m, width_m, elasticity_pa, density_kg_per_m3, .. } = *self;
        let area = thickness_m * width_m;
        let bending = elasticity_pa * width_m * thickness_m.powi(3) / 12.0;
        let [across, around] = self.support_n_per_m;
        let tangential = around / (2.0 * PI);
        let radial = (across / PI - tangential).max(0.0);
        let line_density = density_kg_per_m3 * area * radius_m;
        match shape.waves {
            0 => [2.0 * PI * line_density, 2.0 * PI * (elasticity_pa * area / radius_m + radial)],
            k => {
                let k2 = (k * k) as f64;
                let bent = PI * bending * (k2 - 1.0).powi(2) / radius_m.powi(3);
                [PI * line_density * (1.0 + 1.0 / k2), bent + PI * (radial + tangential / k2)]
            }
        }
    }

    /// The shapes: even, and with two waves and more, as a cosine and a sine each. With one wave the ring moves as a rigid body.
    pub fn shapes(&self) -> Vec<RimShape> {
        let even = RimShape { waves: 0, is_sine: false };
        let waves =
            (2..=self.waves).flat_map(|waves| [false, true].map(|is_sine| RimShape { waves, is_sine }));
        [even].into_iter().chain(waves).collect()
    }
}

/// A shape in which a rim is displaced, `cos kφ` or `sin kφ` outwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RimShape {
    /// k, the number of waves.
    pub waves: usize,
    /// Whether it is the sine.
    pub is_sine: bool,
}

impl RimShape {
    /// (-) Displacement outwards and in the sense of positive rotation at an angle: bending without stretching makes the second the negative integral
    /// of the first.
    ///
    /// # Arguments
    /// * `angle_rad` - (rad) φ, from x towards y in the carrier's frame
    pub fn at(self, angle_rad: f64) -> [f64; 2] {
        let (sin, cos) = (self.waves as f64 * angle_rad).sin_cos();
        self.of_wave([cos, sin])[0]
    }

    /// (-) The same, and how both change with the angle.
    ///
    /// # Arguments
    /// * `wave` - cosine and sine of kφ
    pub fn of_wave(self, [cos, sin]: [f64; 2]) -> [[f64; 2]; 2] {
        let k = self.waves as f64;
        match (self.waves, self.is_sine) {
            (0, _) => [[1.0, 0.0], [0.0; 2]],
            (_, false) => [[cos, -sin / k], [-k * sin, -cos]],
            (_, true) => [[sin, cos / k], [k * cos, -sin]],
        }
    }
}

/// The coordinates of a set.
#[derive(Debug, Clone, PartialEq)]
pub struct SetCoordinates {
    /// The first of the sun, of the carrier and of the ring: x, y, rotation.
    pub members: [usize; 3],
    /// The first of each planet: ζ, η, rotation.
    pub planets: Vec<usize>,
    /// Each shape of the ring's rim with its coordinate.
    pub rim: Vec<(RimShape, usize)>,
}

const SUN: usize = 0;
const CARRIER: usize = 1;
const RING: usize = 2;

impl SetCoordinates {
    /// Counts the coordinates of a set on from those that there are.
    ///
    /// # Arguments
    /// * `parts` - of the set
    /// * `names` - of all coordinates
    pub(super) fn new(parts: &SetParts, names: &mut Vec<Cow<'static, str>>) -> Self {
        let mut add = |of: &[&str], whose: &str| {
            names.extend(of.iter().map(|axis| Cow::from(format!("{axis}_{}.{whose}", parts.name))));
            names.len() - of.len()
        };
        let members = ["sun", "carrier", "ring"].map(|member| add(&["x", "y", "phi_z"], member));
        let planets = (1..=parts.angles_rad.len())
            .map(|planet| add(&["zeta", "eta", "phi_z"], &format!("planet{planet}")))
            .collect();
        let rim = (parts.rim.shapes().into_iter())
            .map(|shape| {
                let name = if shape.is_sine { "rim_sin" } else { "rim_cos" };
                (shape, add(&[&format!("{name}{}", shape.waves)], "ring"))
            })
            .collect();
        Self { members, planets, rim }
    }

    /// Adds the bodies of a set, its pins, supports and couplings.
    ///
    /// # Arguments
    /// * `parts` - of the set
    /// * `node` - the rotation of the first node of a shaft, or of the last one
    /// * `assembly` - to which they are added
    pub(super) fn add(&self, parts: &SetParts, node: impl Fn(usize, bool) -> usize, assembly: &mut Assembly) {
        let [sun, planet, ring, carrier] = parts.bodies;
        let members = self.members.iter().zip([sun, carrier, ring]);
        let planets = self.planets.iter().map(|first| (first, planet));
        for (&first, body) in members.chain(planets) {
            let masses = [body.mass_kg, body.mass_kg, body.polar_kgm2];
            (first..).zip(masses).for_each(|(n, mass)| assembly.mass[(n, n)] += mass);
        }
        for &(shape, coordinate) in &self.rim {
            assembly.mass[(coordinate, coordinate)] += parts.rim.shape(shape)[0];
        }
        let damping = parts.damping_ratio;
        for &(shape, coordinate) in &self.rim {
            assembly.hold(&[(coordinate, 1.0)], parts.rim.shape(shape)[1], damping);
        }
        for (member, &first) in self.members.iter().enumerate() {
            for axis in [first, first + 1] {
                assembly.hold(&[(axis, 1.0)], parts.supports_n_per_m[member], damping);
            }
            let rotation = first + 2;
            let twist = match parts.shafts[member] {
                Some((shaft, is_at_end)) => vec![(rotation, 1.0), (node(shaft, is_at_end), -1.0)],
                None => vec![(rotation, 1.0)],
            };
            assembly.hold(&twist, parts.couplings_nm_per_rad[member], damping);
        }
        for (planet, [along, across]) in self.pins(parts).iter().enumerate() {
            let [[radial, mixed], [_, tangential]] = parts.pin_n_per_m(planet);
            assembly.hold(along, radial, damping);
            assembly.hold(across, tangential, damping);
            let spring = assembly.spring(damping);
            spring.couple(along, across, mixed);
            spring.couple(across, along, mixed);
        }
    }

    /// By how much each pin is stretched along ζ and along η: the planet's motion less that of its place on the carrier.
    fn pins(&self, parts: &SetParts) -> Vec<[Vec<(usize, f64)>; 2]> {
        let [x, y, rotation] = [0, 1, 2].map(|axis| self.members[CARRIER] + axis);
        let of_planet = |(angle, &first): (&f64, &usize)| {
            let (sin, cos) = angle.sin_cos();
            [
                vec![(first, 1.0), (x, -cos), (y, -sin)],
                vec![(first + 1, 1.0), (x, sin), (y, -cos), (rotation, -parts.centre_distance_m)],
            ]
        };
        parts.angles_rad.iter().zip(&self.planets).map(of_planet).collect()
    }

    /// The stretch of each planet's rolling bearing along ζ and η: of its inner ring on the pin against its outer one in the planet.
    ///
    /// # Arguments
    /// * `parts` - of the set
    /// * `coordinates` - number of coordinates of the machine
    pub(super) fn rolling_bearings(&self, parts: &SetParts, coordinates: usize) -> Vec<[DVector<f64>; 2]> {
        let pins = self.pins(parts);
        let of_planet = |(planet, _): &(usize, _)| {
            pins[*planet].each_ref().map(|stretch| {
                let mut of_bearing = DVector::zeros(coordinates);
                stretch.iter().for_each(|&(n, weight)| of_bearing[n] = -weight);
                of_bearing
            })
        };
        parts.rolling_n_per_m.iter().map(of_planet).collect()
    }

    /// The constant forces of pins that stand off their places: each presses its planet and its carrier with the stiffness that it has in the machine
    /// times the error.
    ///
    /// # Arguments
    /// * `parts` - of the set
    /// * `mass` - of the machine
    pub(super) fn pin_errors(&self, parts: &SetParts, mass: &DMatrix<f64>) -> Option<TurningForce> {
        let mut force = DVector::zeros(mass.nrows());
        for (planet, (stretch, error_m)) in self.pins(parts).iter().zip(&parts.pin_errors_m).enumerate() {
            let [[radial, mixed], [_, tangential]] = parts.pin_n_per_m(planet);
            let [radial, tangential] = [(0, radial), (1, tangential)]
                .map(|(n, spring)| limited_stiffness(mass, &stretch[n], spring));
            for (stretch, spring) in stretch.iter().zip([[radial, mixed], [mixed, tangential]]) {
                let pushed_n: f64 =
                    spring.iter().zip(error_m).map(|(spring, error_m)| spring * error_m).sum();
                stretch.iter().for_each(|&(n, weight)| force[n] += weight * pushed_n);
            }
        }
        let is_some = force.iter().any(|value| *value != 0.0);
        is_some.then(|| TurningForce::new(0.0, false, [force, DVector::zeros(mass.nrows())], 0.0))
    }

    /// Motion of the rigid set per unit of the input's rotation.
    ///
    /// # Arguments
    /// * `parts` - of the set
    /// * `rigid_rotation` - of the machine, to which it is added
    pub(super) fn turn(&self, parts: &SetParts, rigid_rotation: &mut DVector<f64>) {
        for (first, ratio) in self.members.iter().zip(parts.ratios) {
            rigid_rotation[first + 2] = ratio;
        }
        for first in &self.planets {
            rigid_rotation[first + 1] = parts.ratios[CARRIER] * parts.centre_distance_m;
            rigid_rotation[first + 2] = parts.ratios[CARRIER] + parts.planet_ratio;
        }
    }

    /// The coordinates that move as the rigid set turns.
    pub(super) fn rotations(&self) -> impl Iterator<Item = usize> {
        let members = self.members.iter().map(|first| first + 2);
        members.chain(self.planets.iter().flat_map(|first| [first + 1, first + 2]))
    }

    /// The lines of action of all meshes, those of the sun first.
    ///
    /// A wheel at O₁ that drives in the sense s pushes its mate along `n = s cos α z × ê + sin α ê`, ê the direction from O₁ to the pitch point, which
    /// for the ring is the same as that to the planet. The mate's arm from its own centre to the pitch point is −r₂ ê, and +r₂ ê of the ring, in whose
    /// inside it lies. A ring that drives is taken for a planet that drives with its other flanks, in the other sense.
    ///
    /// # Arguments
    /// * `parts` - of the set
    /// * `coordinates` - number of coordinates of the machine
    pub(super) fn lines(&self, parts: &SetParts, coordinates: usize) -> Vec<LineOfAction> {
        let [sun_m, planet_at_sun_m, planet_at_ring_m, ring_m] = parts.base_radii_m;
        let [at_sun_rad, at_ring_rad] = parts.working_pressure_angles_rad;
        let sense_of_sun = (parts.ratios[SUN] - parts.ratios[CARRIER]).signum();
        let of_sun = |(&angle, &planet): (&f64, &usize)| {
            let sun = Body::at_axis(self.members[SUN], angle);
            let planet = Body::planet(planet);
            let alpha = at_sun_rad;
            // From the wheel that drives to the other one.
            let (sense, outwards, bodies) = if parts.sun_drives {
                (sense_of_sun, 1.0, [(sun, sun_m), (planet, -planet_at_sun_m)])
            } else {
                (-sense_of_sun, -1.0, [(planet, -planet_at_sun_m), (sun, sun_m)])
            };
            self.line(parts, coordinates, sense, outwards, alpha, bodies, 1.0)
        };
        let of_ring = |(&angle, &planet): (&f64, &usize)| {
            let ring = Body::at_axis(self.members[RING], angle);
            let bodies = [(Body::planet(planet), planet_at_ring_m), (ring, ring_m)];
            // A ring that drives uses the flanks with which the planet would drive in the other sense, and goes along the path the other way.
            let (sense, along) = if parts.sun_drives { (-sense_of_sun, 1.0) } else { (sense_of_sun, -1.0) };
            let mut line = self.line(parts, coordinates, sense, 1.0, at_ring_rad, bodies, along);
            let (sin, cos) = at_ring_rad.sin_cos();
            for &(shape, coordinate) in &self.rim {
                let [radial, tangential] = shape.at(angle);
                line.at_middle[coordinate] = -(sin * radial + sense * cos * tangential);
                if let Some(across) = &mut line.across {
                    across.at_pitch_point[coordinate] = -(cos * radial - sense * sin * tangential);
                }
            }
            line
        };
        let planets = || parts.angles_rad.iter().zip(&self.planets);
        planets().map(of_sun).chain(planets().map(of_ring)).collect()
    }

    /// One line of action.
    ///
    /// # Arguments
    /// * `sense` - s of the wheel that drives
    /// * `outwards` - 1 where ê points from the axis outwards, −1 where it points inwards
    /// * `alpha` - (rad) working pressure angle
    /// * `bodies` - the wheel that drives and its mate, each with its arm from its centre outwards as a base radius in m
    /// * `along` - 1 where pairs go along n, −1 where they go against it
    #[expect(clippy::too_many_arguments, reason = "what a line of action depends on")]
    fn line(
        &self,
        parts: &SetParts,
        coordinates: usize,
        sense: f64,
        outwards: f64,
        alpha: f64,
        bodies: [(Body, f64); 2],
        along: f64,
    ) -> LineOfAction {
        let (sin, cos) = alpha.sin_cos();
        // n and q = −s z × n, along ê₀, which points outwards from the axis, and along z × ê₀.
        let n = [outwards * sin, outwards * sense * cos];
        let q = [sense * n[1], -sense * n[0]];
        let zeros = || DVector::zeros(coordinates);
        let mut line = LineOfAction { at_middle: zeros(), per_m: zeros(), across: None };
        let mut across = AcrossLine { at_pitch_point: zeros(), per_m: zeros() };
        for ((body, base_radius_m), side) in bodies.into_iter().zip([1.0, -1.0]) {
            let arm_m = base_radius_m / cos;
            body.add(&mut line.at_middle, n, arm_m, side);
            body.add(&mut across.at_pitch_point, q, arm_m, side);
            across.per_m[body.first + 2] = -side * sense * along;
        }
        line.across = parts.has_forces_across.then_some(across);
        line
    }
}

/// A body in the plane, with its frame.
#[derive(Clone, Copy)]
struct Body {
    first: usize,
    /// Cosine and sine of the angle from its first axis to the planet's ζ.
    turned: [f64; 2],
}

impl Body {
    /// A body whose coordinates are x and y.
    fn at_axis(first: usize, angle_rad: f64) -> Self {
        let (sin, cos) = angle_rad.sin_cos();
        Self { first, turned: [cos, sin] }
    }

    fn planet(first: usize) -> Self {
        Self { first, turned: [1.0, 0.0] }
    }

    /// Adds what a force along a direction does at the end of an arm that points along ζ.
    ///
    /// # Arguments
    /// * `direction` - along ζ and η
    /// * `arm_m` - (m) from the body's centre
    /// * `side` - 1 or −1
    fn add(self, line: &mut DVector<f64>, [zeta, eta]: [f64; 2], arm_m: f64, side: f64) {
        let [cos, sin] = self.turned;
        line[self.first] += side * (zeta * cos - eta * sin);
        line[self.first + 1] += side * (zeta * sin + eta * cos);
        line[self.first + 2] += side * arm_m * eta;
    }
}
