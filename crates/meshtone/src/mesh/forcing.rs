//! What drives the machine, sample by sample: motor and brake, and the pairs of each mesh.

use std::array::from_fn;
use std::f64::consts::TAU;

use super::deviations::{Eccentricity, FlankErrors, PairDeviations};
use super::gear_mesh::{FaceForm, Mesh, PairTable};
use super::path_table::{CornerTable, PairState};
use crate::bearing::{BearingBlock, BearingTurning};
use crate::machine::TurningForce;
use crate::operation::{Motion, TimeGrid};
use crate::wheel::WheelName;

/// Pairs of spur wheels that a step looks at: as many as reach from `ε + 0.6` back to `−0.6` base pitches.
pub(crate) const PAIRS: usize = 3;

/// Forcing of successive samples of one simulation.
#[derive(Debug, Clone, Default)]
pub struct ForcingBlock {
    /// How motor and brake differ from their nominal motion, empty while both are steady; and what turns with the shafts.
    pub external: ExternalBlock,
    /// The pairs of each mesh.
    pub meshes: Vec<PairsBlock>,
    /// The elements of each rolling bearing.
    pub(crate) bearings: Vec<BearingBlock>,
}

/// How motor and brake differ from the nominal motion at successive samples, and what turns with the shafts.
#[derive(Debug, Clone, Default)]
pub struct ExternalBlock {
    /// (rad) Angle of the motor less that of the rigid rotation at the nominal speed.
    pub motor_lead_rad: Vec<f64>,
    /// (N m) Torque of the brake less its nominal value.
    pub torque_deviation_nm: Vec<f64>,
    /// (rad/s) Speed of the motor less the nominal one.
    pub speed_deviation_rad_per_s: Vec<f64>,
    /// Of each force that turns with a shaft: the cosine and the sine of the shaft's angle, times the square of its speed where the force
    /// grows with it.
    pub(crate) turning: Vec<[Vec<f64>; 2]>,
}

impl ExternalBlock {
    /// The motion of motor and brake, in this order.
    pub(crate) fn parts(&self) -> [&Vec<f64>; 3] {
        [&self.motor_lead_rad, &self.torque_deviation_nm, &self.speed_deviation_rad_per_s]
    }
}

/// The pairs of one mesh at successive samples, slice by slice. With m pairs at once pair n is in place `n mod m`, and spring s of all is
/// slice `s mod N` of the pair in place `s div N`.
#[derive(Debug, Clone, Default)]
pub struct PairsBlock {
    /// (N/m) Stiffness of each spring; 0 where there is no pair.
    pub stiffness: Vec<Vec<f64>>,
    /// (m) What the pair's deviation and separation add to the deflection, with the damping's lead: `o + τ ȯ`, `o = e − S`.
    pub offset: Vec<Vec<f64>>,
    /// What each spring has outside the path, before its start and beyond its end; none of spur teeth.
    pub(crate) corners: Vec<[CornerBlock; 2]>,
    /// Of each place, the classes of its pairs, each from a sample on; none of spur teeth.
    pub(crate) classes: Vec<Vec<(usize, usize)>>,
    /// (-) Of each spring, where the middle of what touches of its face lies along it, from −1 to 1, and half of its width, of any value where there is no
    /// pair; none where they are the same throughout.
    pub(crate) strips: Vec<[Vec<f64>; 2]>,
    /// (m) Of each spring, [`Mesh::wobble_m`] of its pair with what its deviations add, of any value where there is none; none where no slope turns and no
    /// contact line tilts, or the tilt is no unknown.
    pub(crate) wobble: Vec<Vec<f64>>,
    /// (-, m) Of each spring, friction across the line of action per force along it and its moment about the pitch point, of any value where
    /// there is no pair; none without friction.
    pub(crate) sliding: Vec<[Vec<f64>; 2]>,
}

/// One corner of a spring at successive samples: as [`CornerAt`](super::law::CornerAt).
#[derive(Debug, Clone, Default)]
pub(crate) struct CornerBlock {
    pub(crate) offset: Vec<f64>,
    pub(crate) near: Vec<f64>,
    pub(crate) far: Vec<f64>,
    /// None where the mesh does not tilt.
    pub(crate) place: Vec<f64>,
}

impl PairsBlock {
    /// Room for `samples` samples of the springs of a mesh, whatever they hold: the tabulated forcing sets each.
    fn resize(&mut self, mesh: &Mesh, samples: usize) {
        let (springs, has_corners) = (mesh.springs(), mesh.has_corners());
        self.stiffness.resize_with(springs, Vec::new);
        self.offset.resize_with(springs, Vec::new);
        self.corners.resize_with(if has_corners { springs } else { 0 }, Default::default);
        self.classes.resize_with(if has_corners { mesh.pairs_at_once() } else { 0 }, Vec::new);
        let of_corners = self.corners.iter_mut().flatten();
        let of_corners =
            of_corners.flat_map(|corner| [&mut corner.offset, &mut corner.near, &mut corner.far]);
        for values in self.stiffness.iter_mut().chain(&mut self.offset).chain(of_corners) {
            values.resize(samples, 0.0);
        }
        if mesh.tilts() {
            self.corners.iter_mut().flatten().for_each(|corner| corner.place.resize(samples, 0.0));
        }
        self.sliding.resize_with(if mesh.has_friction() { springs } else { 0 }, Default::default);
        self.sliding.iter_mut().flatten().for_each(|values| values.resize(samples, 0.0));
        self.strips.resize_with(if mesh.has_strips() { springs } else { 0 }, Default::default);
        self.strips.iter_mut().flatten().for_each(|values| values.resize(samples, 0.0));
        self.wobble.resize_with(if mesh.leans_with_pairs() { springs } else { 0 }, Vec::new);
        self.wobble.iter_mut().for_each(|values| values.resize(samples, 0.0));
        self.classes.iter_mut().for_each(Vec::clear);
    }

    /// `samples` samples without pairs.
    fn clear(&mut self, mesh: &Mesh, samples: usize) {
        self.resize(mesh, 0);
        self.resize(mesh, samples);
    }

    /// Sets friction and places of the springs of a pair at a sample, between two points of its tables.
    ///
    /// # Arguments
    /// * `mesh` - whose tables
    /// * `class` - of the pair
    /// * `at` - number of the pair's first spring, and of the sample
    /// * `point` - index of the point before, and (-) part of the way to the next one
    fn set_sliding_and_strips(
        &mut self,
        (mesh, class): (&Mesh, usize),
        (first_spring, sample): (usize, usize),
        (index, part): (usize, f64),
    ) {
        for (sliding, tables) in self.sliding.iter_mut().skip(first_spring).zip(&mesh.sliding) {
            for (values, table) in sliding.iter_mut().zip(tables) {
                values[sample] = between(table, index, part);
            }
        }
        if let Some(strip) = self.strips.get_mut(first_spring) {
            let [here, next] = [index, index + 1].map(|point| mesh.strip(class, point));
            for (values, (here, next)) in strip.iter_mut().zip(here.into_iter().zip(next)) {
                values[sample] = here + part * (next - here);
            }
        }
    }

    /// The class of the pair in a place at a sample; that of sound pairs before the first one.
    pub(crate) fn class_at(&self, place: usize, sample: usize) -> usize {
        let before = self.classes[place].iter().rev().find(|(from, _)| *from <= sample);
        before.map_or(SOUND, |(_, class)| *class)
    }
}

/// Forcing of one simulation, block by block.
pub struct Forcing<'a> {
    motion: Motion<'a>,
    /// Whether motor and brake are steady.
    is_steady: bool,
    /// Whether the motor is, so that all wheels turn evenly but for their vibration.
    turns_evenly: bool,
    /// Number of the next sample.
    sample: usize,
    samples_per_revolution: f64,
    step_s: f64,
    nominal_speed_hz: f64,
    nominal_torque_nm: f64,
    meshes: Vec<MeshForcing<'a>>,
    bearings: Vec<BearingTurning<'a>>,
    turning_forces: Vec<TurningShaft>,
    /// (rev) Rotation of the motor at the samples of a block, where a mesh or a bearing needs it.
    revolutions: Vec<f64>,
}

impl<'a> Forcing<'a> {
    /// Forcing from sample `first_sample` on.
    ///
    /// # Arguments
    /// * `motion` - motor and brake, unless they are steady from `first_sample` on
    /// * `time` - division of time
    /// * `nominal` - (Hz, N m) nominal speed and torque
    /// * `first_sample` - number of the first sample
    /// * `meshes` - each mesh, with the deviations of its flanks
    pub fn new(
        motion: Motion<'a>,
        time: &TimeGrid,
        [nominal_speed_hz, nominal_torque_nm]: [f64; 2],
        first_sample: usize,
        meshes: impl IntoIterator<Item = (&'a Mesh, PairDeviations<'a>)>,
    ) -> Self {
        let turns_evenly = motion.is_steady();
        let is_steady = turns_evenly && motion.has_constant_torque();
        let meshes = meshes.into_iter().map(|(mesh, deviations)| {
            let turning = mesh.turning;
            let per_revolution = mesh.points_per_pitch as f64 * turning.pitches_per_revolution;
            // The ratio of a wheel's speed to the motor's is rarely an exact number.
            let points_per_sample = per_revolution / time.samples_per_pinion_revolution as f64;
            let every_sample_is_a_point =
                turning.first_pitch == 0.0 && (points_per_sample - 1.0).abs() < ROUNDING;
            let reading = match (turns_evenly, every_sample_is_a_point) {
                (true, true) => Reading::EveryPoint,
                (true, false) => Reading::BetweenPoints { points_per_sample },
                (false, _) => Reading::AnyMotion,
            };
            MeshForcing::new(mesh, &deviations, time.step_s(), (reading, points_per_sample))
        });
        Self {
            motion: motion.starting_at(first_sample),
            is_steady,
            turns_evenly,
            sample: first_sample,
            samples_per_revolution: time.samples_per_pinion_revolution as f64,
            step_s: time.step_s(),
            nominal_speed_hz,
            nominal_torque_nm,
            meshes: meshes.collect(),
            bearings: Vec::new(),
            turning_forces: Vec::new(),
            revolutions: Vec::new(),
        }
    }

    /// Returns the forcing with rolling bearings.
    ///
    /// # Arguments
    /// * `bearings` - from the start of the simulation
    pub(crate) fn with_bearings(self, bearings: Vec<BearingTurning<'a>>) -> Self {
        Self { bearings, ..self }
    }

    /// Returns the forcing with forces that turn with the shafts.
    ///
    /// # Arguments
    /// * `turning_forces` - of the machine
    pub(crate) fn with_turning_forces(self, turning_forces: &[TurningForce]) -> Self {
        let turning_forces = turning_forces.iter().map(|force| TurningShaft {
            speed_ratio: force.speed_ratio,
            of_square_speed: force.of_square_speed,
            turned: Default::default(),
        });
        Self { turning_forces: turning_forces.collect(), ..self }
    }

    /// The meshes.
    pub(crate) fn meshes(&self) -> impl Iterator<Item = &Mesh> + Clone {
        self.meshes.iter().map(|forcing| forcing.mesh)
    }

    /// Sets a block to the next `samples` samples.
    ///
    /// # Arguments
    /// * `samples` - how many
    /// * `block` - is overwritten
    pub fn next_block(&mut self, samples: usize, block: &mut ForcingBlock) {
        self.revolutions.clear();
        if !self.is_steady {
            self.follow_motion(samples, &mut block.external);
        } else if !self.bearings.is_empty()
            || self.meshes.iter().any(|mesh| mesh.reading != Reading::EveryPoint)
        {
            let turned = |k: usize| (self.sample + k) as f64 / self.samples_per_revolution;
            self.revolutions.extend((0..samples).map(turned));
        }
        block.meshes.resize_with(self.meshes.len(), PairsBlock::default);
        for (mesh, pairs) in self.meshes.iter_mut().zip(&mut block.meshes) {
            mesh.next_block(self.sample, samples, &self.revolutions, pairs);
        }
        block.bearings.resize_with(self.bearings.len(), BearingBlock::default);
        for (bearing, elements) in self.bearings.iter_mut().zip(&mut block.bearings) {
            bearing.next_block(&self.revolutions, elements);
        }
        self.turn_with_shafts(samples, &mut block.external);
        self.sample += samples;
    }

    /// Sets the angles of all shafts with a turning force. While the motor is steady only that of a block's first sample is computed: the
    /// shaft turns on from it as in every block before, so that a sample takes four products and no sine.
    fn turn_with_shafts(&mut self, samples: usize, block: &mut ExternalBlock) {
        block.turning.resize_with(self.turning_forces.len(), Default::default);
        for ([cos, sin], shaft) in block.turning.iter_mut().zip(&mut self.turning_forces) {
            cos.clear();
            sin.clear();
            if self.turns_evenly {
                shaft.turn_evenly(samples, 1.0 / self.samples_per_revolution);
                let factor = shaft.factor(TAU * self.nominal_speed_hz);
                let first = shaft.direction(self.sample as f64 / self.samples_per_revolution);
                let [cos_0, sin_0] = first.map(|direction| factor * direction);
                let [cos_k, sin_k] = shaft.turned.each_ref().map(|turned| &turned[..samples]);
                cos.extend(cos_k.iter().zip(sin_k).map(|(cos_k, sin_k)| cos_0 * cos_k - sin_0 * sin_k));
                sin.extend(cos_k.iter().zip(sin_k).map(|(cos_k, sin_k)| sin_0 * cos_k + cos_0 * sin_k));
                continue;
            }
            for (motor, deviation_rad_per_s) in self.revolutions.iter().zip(&block.speed_deviation_rad_per_s)
            {
                let factor = shaft.factor(TAU * self.nominal_speed_hz + deviation_rad_per_s);
                let direction = shaft.direction(*motor);
                cos.push(factor * direction[0]);
                sin.push(factor * direction[1]);
            }
        }
    }

    fn follow_motion(&mut self, samples: usize, block: &mut ExternalBlock) {
        block.motor_lead_rad.clear();
        block.torque_deviation_nm.clear();
        block.speed_deviation_rad_per_s.clear();
        for (k, motion) in self.motion.by_ref().take(samples).enumerate() {
            let rotation = self.nominal_speed_hz * ((self.sample + k) as f64 * self.step_s);
            self.revolutions.push(motion.revolutions);
            block.motor_lead_rad.push(TAU * (motion.revolutions - rotation));
            block.torque_deviation_nm.push(motion.torque_nm - self.nominal_torque_nm);
            block.speed_deviation_rad_per_s.push(TAU * (motion.speed_hz - self.nominal_speed_hz));
        }
    }
}

/// A shaft with which a force turns.
struct TurningShaft {
    /// (-) Its rotation over that of the motor.
    speed_ratio: f64,
    /// Whether the force grows with the square of its speed.
    of_square_speed: bool,
    /// The cosine and the sine of what it has turned since the first sample of a block, where the motor is steady.
    turned: [Vec<f64>; 2],
}

impl TurningShaft {
    /// The cosine and the sine of its angle.
    ///
    /// # Arguments
    /// * `motor_revolutions` - (rev) rotation of the motor
    fn direction(&self, motor_revolutions: f64) -> [f64; 2] {
        let (sin, cos) = (TAU * self.speed_ratio * motor_revolutions).sin_cos();
        [cos, sin]
    }

    /// (rad²/s², or 1) What the force is per unit.
    ///
    /// # Arguments
    /// * `motor_rad_per_s` - (rad/s) speed of the motor
    fn factor(&self, motor_rad_per_s: f64) -> f64 {
        if self.of_square_speed { (self.speed_ratio * motor_rad_per_s).powi(2) } else { 1.0 }
    }

    /// Tabulates what it turns from the first sample of a block to the others, up to the longest block so far.
    ///
    /// # Arguments
    /// * `samples` - number of samples of the block
    /// * `step_revolutions` - (rev) rotation of the motor in a sample
    fn turn_evenly(&mut self, samples: usize, step_revolutions: f64) {
        for k in self.turned[0].len()..samples {
            let [cos, sin] = self.direction(k as f64 * step_revolutions);
            self.turned[0].push(cos);
            self.turned[1].push(sin);
        }
    }
}

/// Relative difference of two rates below which they are the same but for rounding.
const ROUNDING: f64 = 1e-13;

/// How a mesh turns with the motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turning {
    /// (-) Pairs that meet in a revolution of the motor.
    pub pitches_per_revolution: f64,
    /// (base pitches) Position of pair 0 at the start of the simulation.
    pub first_pitch: f64,
}

/// How the tables of a mesh are read.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Reading {
    /// Every sample is a point of the tables.
    EveryPoint,
    /// Samples lie evenly between the points.
    BetweenPoints {
        /// (-) Points from one sample to the next.
        points_per_sample: f64,
    },
    /// Samples lie wherever motor and brake bring the mesh.
    AnyMotion,
}

/// Forcing of one mesh.
struct MeshForcing<'a> {
    mesh: &'a Mesh,
    pinion: FlankErrors<'a>,
    gear: FlankErrors<'a>,
    eccentricity: Option<Eccentricity>,
    /// (-) τ over the time step.
    lead: f64,
    reading: Reading,
    /// The pairs at every point, while motor and brake are steady, and always where the teeth are helical or in slices.
    tables: Option<TabulatedPairs>,
    /// (m) Offset of each spring at the two samples before, with the pair's number, where motor or brake is not steady; then the slope of each.
    before: Vec<(i64, [f64; 2])>,
}

/// Pairs at every point of their tables, with the damping's lead. Tables of a class have all points of the first slice, then those of the
/// next one.
struct TabulatedPairs {
    /// (N/m) By class.
    stiffness: Vec<Vec<f64>>,
    /// (m) By class, `−S`; less that of sound pairs, which is a part of the gear's table, where the face is one slice.
    further_apart_m: Vec<Vec<f64>>,
    /// (m) Deviation by tooth, at the mesh's points of flanks; none where all are ideal.
    pinion_m: Vec<Vec<f64>>,
    /// (m) Deviation by tooth, and of spur teeth `−S` of sound pairs: all that most pairs need beside the pinion's.
    gear_m: Vec<Vec<f64>>,
    /// (m) Of helical teeth whose undivided face tilts, by how much more they deviate at the end of the face at positive z than midway, by wheel and tooth.
    slopes_m: [Vec<Vec<f64>>; 2],
    /// (m) Of teeth with corners or slices, what all places of a tooth deviate by alike, by wheel and tooth; none where all turn true.
    alike_m: Option<[Vec<Vec<f64>>; 2]>,
    /// (m) Of teeth with corners, deviations by wheel and tooth at single places of the flanks.
    flanks_m: [Vec<Vec<f64>>; 2],
    /// Of each class, slice and end what lies outside the path, with the damping's lead.
    corners: Vec<Vec<[CornerEdges; 2]>>,
}

/// What lies outside the path at one end of a slice.
struct CornerEdges {
    /// (√m) Its edges at the points, near to the path and far from it.
    edges: [Vec<f64>; 2],
    /// (m) As of [`CornerParts`].
    apart_m: f64,
}

/// The class of sound pairs.
const SOUND: usize = 0;

/// Makes an offset at uniform points `o + τ ȯ`, the derivative by central differences: one to the point before would be late by half
/// a step, and the motion's error of the first order.
fn add_lead(offset_m: &mut [f64], lead: f64) {
    let mut before = offset_m.first().copied().unwrap_or(0.0);
    for n in 0..offset_m.len() {
        let now = offset_m[n];
        let after = offset_m.get(n + 1).copied().unwrap_or(now);
        offset_m[n] += lead / 2.0 * (after - before);
        before = now;
    }
}

impl TabulatedPairs {
    /// Tabulates stiffness, separation and deviations.
    ///
    /// Of spur teeth alike along the face, everything that a tooth adds to the offset is put into one table of it, so that a pair takes two.
    /// Others read a tooth's deviations at points of their own.
    ///
    /// # Arguments
    /// * `lead` - (-) τ over the time from one point to the next, of what is read with the damping's lead
    /// * `lead_of_corners` - (base pitches) how far the wheels turn in τ
    fn new(
        mesh: &Mesh,
        flanks: [&FlankErrors; 2],
        eccentricity: Option<&Eccentricity>,
        [lead, lead_of_corners]: [f64; 2],
    ) -> Self {
        let sound = &mesh.classes[SOUND].states;
        let is_whole = mesh.face == FaceForm::Spur;
        let teeth = |wheel: WheelName| vec![vec![0.0; mesh.points()]; mesh.sequence.teeth_of(wheel)];
        let tabulate = |wheel: WheelName| -> [Vec<Vec<f64>>; 2] {
            let mut tables = flanks[wheel as usize].tabulate_at(mesh.flank_positions());
            let mut slopes = Vec::new();
            if !is_whole {
                [tables, slopes] = mesh.along_face(&tables);
            } else {
                if tables.is_empty() {
                    tables = teeth(wheel);
                }
                if let Some(eccentricity) = eccentricity {
                    eccentricity.add_to(&mut tables, mesh, wheel);
                }
                if wheel == WheelName::Gear {
                    let apart = |(deviation, state): (&mut f64, &PairState)| *deviation -= state.separation_m;
                    tables.iter_mut().for_each(|table| table.iter_mut().zip(sound).for_each(apart));
                }
            }
            tables.iter_mut().chain(&mut slopes).for_each(|table| add_lead(table, lead));
            [tables, slopes]
        };
        let [[pinion_m, pinion_slopes_m], [gear_m, gear_slopes_m]] = WheelName::BOTH.map(tabulate);
        let alike = |eccentricity: &Eccentricity| {
            WheelName::BOTH.map(|wheel| {
                let mut tables = teeth(wheel);
                eccentricity.add_to(&mut tables, mesh, wheel);
                tables.iter_mut().for_each(|table| add_lead(table, lead));
                tables
            })
        };
        let of_corners = |class: &PairTable| {
            let of_end = |table: &CornerTable, end: usize| CornerEdges {
                edges: table.roots(end, lead_of_corners),
                apart_m: table.separation_m - table.deeper_m(lead_of_corners),
            };
            let of_slice = |ends: &[CornerTable; 2]| from_fn(|end| of_end(&ends[end], end));
            class.corners.iter().map(of_slice).collect()
        };
        let at_places = |wheel: WheelName| {
            // A flank does not change at its end: there is no damping's lead.
            let tables = || flanks[wheel as usize].tabulate_at(mesh.flank_positions());
            if mesh.has_corners() { tables() } else { Vec::new() }
        };
        let further_apart = |class: &PairTable| {
            let states = sound.iter().zip(&class.states);
            let of_sound = |state: &PairState| if is_whole { state.separation_m } else { 0.0 };
            let mut further_m: Vec<f64> =
                states.map(|(sound, state)| of_sound(sound) - state.separation_m).collect();
            further_m.chunks_mut(mesh.points()).for_each(|slice| add_lead(slice, lead));
            further_m
        };
        Self {
            stiffness: (mesh.classes.iter())
                .map(|class| class.states.iter().map(|state| state.stiffness_n_per_m).collect())
                .collect(),
            further_apart_m: mesh.classes.iter().map(further_apart).collect(),
            pinion_m,
            gear_m,
            slopes_m: [pinion_slopes_m, gear_slopes_m],
            alike_m: eccentricity.filter(|_| !is_whole).map(alike),
            flanks_m: WheelName::BOTH.map(at_places),
            corners: mesh.classes.iter().map(of_corners).collect(),
        }
    }

    /// The tables of a pair, each with the point of it that is the pair's first point: what its slices have in common, then for each
    /// slice its stiffness and what it has of its own.
    fn of_pair(&self, mesh: &Mesh, pair: i64) -> PairParts<'_> {
        let class = mesh.sequence.class(pair);
        let teeth: [usize; 2] = mesh.sequence.teeth(pair).into();
        let flanks = || [&self.pinion_m, &self.gear_m].into_iter().zip(teeth);
        let points = mesh.points();
        let alike = self.alike_m.iter().flatten().zip(teeth).map(|(tables, tooth)| (&tables[tooth][..], 0));
        let slice = |slice: usize| {
            let of_class = (class != SOUND || mesh.face != FaceForm::Spur)
                .then(|| (&self.further_apart_m[class][slice * points..(slice + 1) * points], 0));
            let from = mesh.first_flank_point(slice);
            let of_teeth =
                flanks().filter_map(|(tables, tooth)| tables.get(tooth)).map(|table| (&table[..], from));
            let corners = self.corners[class].get(slice).map(|ends| {
                [0, 1].map(|end| {
                    let CornerEdges { edges: [near, far], apart_m } = &ends[end];
                    let place = mesh.classes[class].corners[slice][end].place;
                    let flanks = self.flanks_m.iter().zip(teeth);
                    CornerParts {
                        near,
                        far,
                        apart_m: *apart_m,
                        flanks: flanks.filter_map(|(tables, tooth)| Some(&tables.get(tooth)?[..])).collect(),
                        place,
                        reading: mesh.corner_reading(slice, end, place),
                    }
                })
            });
            SliceParts {
                stiffness: &self.stiffness[class][slice * points..(slice + 1) * points],
                offsets: of_teeth.chain(of_class).collect(),
                corners,
            }
        };
        PairParts {
            class,
            wobble_m: mesh.wobble_m(pair),
            slopes: (self.slopes_m.iter().zip(teeth))
                .filter_map(|(tables, tooth)| Some(&tables.get(tooth)?[..]))
                .collect(),
            alike: alike.collect(),
            slices: (0..mesh.slices()).map(slice).collect(),
        }
    }
}

/// (m) A table, and the point of it that is the first point of a pair.
type FromPoint<'a> = (&'a [f64], usize);

/// The tables that make the springs of a pair.
struct PairParts<'a> {
    class: usize,
    /// (m) As of [`Mesh::wobble_m`].
    wobble_m: f64,
    /// (m) What its deviations add to that, at the pair's points.
    slopes: Vec<&'a [f64]>,
    /// What all slices add to their offset.
    alike: Vec<FromPoint<'a>>,
    slices: Vec<SliceParts<'a>>,
}

/// The tables of one slice of a pair.
struct SliceParts<'a> {
    /// (N/m) At the pair's points.
    stiffness: &'a [f64],
    /// Their sum is the slice's offset, but for what all slices have.
    offsets: Vec<FromPoint<'a>>,
    /// What it has outside the path; none of spur teeth, nor of missing ones.
    corners: Option<[CornerParts<'a>; 2]>,
}

/// The tables of one corner of a slice.
struct CornerParts<'a> {
    /// (√m) Its edges at the pair's points.
    near: &'a [f64],
    far: &'a [f64],
    /// (m) Separation at the end of the path, less what the damping's lead makes the penetration deeper.
    apart_m: f64,
    /// (m) Deviations of both flanks, at the mesh's points of flanks.
    flanks: Vec<&'a [f64]>,
    /// (base pitches) Where its end of the path is.
    place: f64,
    reading: CornerReading,
}

/// Where the deviations are read that a corner feels: at the part of the contact line outside the path that is nearest to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CornerReading {
    /// The point of the flanks' tables that this part is at when the pair is at its first point.
    pub(super) first: f64,
    /// The points between which it lies outside the path.
    pub(super) outside: [f64; 2],
}

impl CornerParts<'_> {
    /// (m) What deviations and separation add at a point of the pair.
    fn offset_m(&self, point: f64) -> f64 {
        let [least, most] = self.reading.outside;
        let at = (self.reading.first + point).clamp(least, most);
        let index = at as usize;
        let part = at - index as f64;
        let read = |table: &[f64]| {
            let [here, next] = [index, index + 1].map(|n| table[n.min(table.len() - 1)]);
            here + part * (next - here)
        };
        self.flanks.iter().map(|table| read(table)).sum::<f64>() - self.apart_m
    }
}

impl<'a> MeshForcing<'a> {
    fn new(
        mesh: &'a Mesh,
        deviations: &PairDeviations<'a>,
        step_s: f64,
        (reading, nominal_points_per_sample): (Reading, f64),
    ) -> Self {
        let [pinion, gear] = FlankErrors::of_both(deviations);
        let lead = mesh.damping_time_s / step_s;
        let eccentricity = Eccentricity::of(deviations);
        // (-) τ over the time from one point to the next. In any motion it is found from the samples.
        let lead_of_points = match reading {
            Reading::EveryPoint => Some(lead),
            Reading::BetweenPoints { points_per_sample } => Some(lead * points_per_sample),
            Reading::AnyMotion => (mesh.face != FaceForm::Spur).then_some(0.0),
        };
        let points_per_sample = match reading {
            Reading::EveryPoint => 1.0,
            Reading::BetweenPoints { points_per_sample } => points_per_sample,
            Reading::AnyMotion => nominal_points_per_sample,
        };
        let of_corners = lead * points_per_sample / mesh.points_per_pitch as f64;
        let tables = lead_of_points.map(|lead| {
            TabulatedPairs::new(mesh, [&pinion, &gear], eccentricity.as_ref(), [lead, of_corners])
        });
        let before = vec![(i64::MIN, [0.0; 2]); 2 * mesh.springs()];
        Self { mesh, pinion, gear, eccentricity, lead, reading, tables, before }
    }

    /// Sets a block to `samples` samples from `first` on.
    ///
    /// # Arguments
    /// * `revolutions` - (rev) rotation of the motor at each, where the samples are not points of the tables
    fn next_block(&mut self, first: usize, samples: usize, revolutions: &[f64], block: &mut PairsBlock) {
        match (&self.tables, self.reading) {
            (Some(tables), Reading::EveryPoint) => {
                block.resize(self.mesh, samples);
                self.copy_from(tables, first, block);
            }
            (Some(tables), _) => {
                block.clear(self.mesh, samples);
                let mut before = std::mem::take(&mut self.before);
                self.read_tables_between_points(tables, revolutions, &mut before, block);
                self.before = before;
            }
            (None, _) => {
                block.clear(self.mesh, samples);
                self.read_between_points(revolutions, block);
            }
        }
    }

    /// Copies the pairs at successive points from their tables. Each place of the block holds one pair after the other, so that whole
    /// ranges are copied, and zeros between them.
    fn copy_from(&self, tables: &TabulatedPairs, first: usize, block: &mut PairsBlock) {
        let (per_pitch, before) = (self.mesh.points_per_pitch, self.mesh.points_before);
        let samples = block.stiffness[0].len();
        let (slices, at_once) = (self.mesh.slices(), self.mesh.pairs_at_once());
        // Sample s is point s + before of pair 0, and each pair begins a pitch after the one before.
        let (first_point, last_point) = (first + before, first + samples - 1 + before);
        let oldest = (first_point as i64 - self.mesh.points() as i64).div_euclid(per_pitch as i64) + 1;
        let pairs = oldest..=(last_point / per_pitch) as i64;
        let mut set = vec![0; at_once];
        for pair in pairs {
            let Some(Part { from, until, point }) = self.part(pair, first, samples) else { continue };
            let place = pair.rem_euclid(at_once as i64) as usize;
            let PairParts { class, wobble_m, slopes, alike, slices: parts } = tables.of_pair(self.mesh, pair);
            if let Some(classes) = block.classes.get_mut(place) {
                classes.push((from, class));
            }
            for (slice, part) in parts.iter().enumerate() {
                let spring = place * slices + slice;
                block.stiffness[spring][set[place]..from].fill(0.0);
                block.offset[spring][set[place]..from].fill(0.0);
                block.stiffness[spring][from..until]
                    .copy_from_slice(&part.stiffness[point..point + until - from]);
                if let Some(sliding) = block.sliding.get_mut(spring) {
                    for (values, table) in sliding.iter_mut().zip(&self.mesh.sliding[slice]) {
                        values[from..until].copy_from_slice(&table[point..point + until - from]);
                    }
                }
                if let Some([places, half_widths]) = block.strips.get_mut(spring) {
                    for (at, point) in (from..until).zip(point..) {
                        [places[at], half_widths[at]] = self.mesh.strip(class, point);
                    }
                }
                let offsets = &mut block.offset[spring][from..until];
                let mut terms =
                    part.offsets.iter().chain(&alike).map(|(table, begin)| &table[begin + point..]);
                // Most pairs have two: both are added at once.
                match (terms.next(), terms.next()) {
                    (Some(one), Some(other)) => {
                        for (offset, (one, other)) in offsets.iter_mut().zip(one.iter().zip(other)) {
                            *offset = one + other;
                        }
                    }
                    (Some(one), None) => offsets.copy_from_slice(&one[..until - from]),
                    _ => offsets.fill(0.0),
                }
                for term in terms {
                    offsets.iter_mut().zip(term).for_each(|(offset, term)| *offset += term);
                }
                let closer_m = self.mesh.slice_closer_m(slice, wobble_m);
                if closer_m != 0.0 {
                    offsets.iter_mut().for_each(|offset| *offset += closer_m);
                }
                if let Some(wobble) = block.wobble.get_mut(spring) {
                    let wobble = &mut wobble[from..until];
                    wobble.fill(wobble_m);
                    for slope in &slopes {
                        wobble.iter_mut().zip(&slope[point..]).for_each(|(wobble, slope)| *wobble += slope);
                    }
                }
                let Some(corners) = block.corners.get_mut(spring) else { continue };
                for (end, CornerBlock { offset, near, far, place: strip }) in corners.iter_mut().enumerate() {
                    near[set[place]..from].fill(0.0);
                    far[set[place]..from].fill(0.0);
                    let Some(corner) = part.corners.as_ref().map(|corners| &corners[end]) else {
                        near[from..until].fill(0.0);
                        far[from..until].fill(0.0);
                        continue;
                    };
                    let points = point..point + until - from;
                    near[from..until].copy_from_slice(&corner.near[points.clone()]);
                    far[from..until].copy_from_slice(&corner.far[points.clone()]);
                    let outside = |point: &usize| corner.far[*point] > corner.near[*point];
                    for at in points.filter(outside) {
                        let alike_m: f64 = alike.iter().map(|(table, begin)| table[begin + at]).sum();
                        let sample = from + at - point;
                        offset[sample] = corner.offset_m(at as f64) + alike_m + closer_m;
                        if self.mesh.tilts() {
                            strip[sample] = self.mesh.corner_strip(slice, end, corner.place, at as f64);
                            offset[sample] += strip[sample] * wobble_m;
                        }
                    }
                }
            }
            set[place] = until;
        }
        for (spring, (stiffness, offset)) in block.stiffness.iter_mut().zip(&mut block.offset).enumerate() {
            stiffness[set[spring / slices]..].fill(0.0);
            offset[set[spring / slices]..].fill(0.0);
        }
        for (spring, corners) in block.corners.iter_mut().enumerate() {
            for CornerBlock { near, far, .. } in corners {
                near[set[spring / slices]..].fill(0.0);
                far[set[spring / slices]..].fill(0.0);
            }
        }
    }

    /// The samples of a block from `first` on in which a pair takes part.
    fn part(&self, pair: i64, first: usize, samples: usize) -> Option<Part> {
        let since_first =
            pair * self.mesh.points_per_pitch as i64 - self.mesh.points_before as i64 - first as i64;
        let from = since_first.max(0);
        let until = (since_first + self.mesh.points() as i64).min(samples as i64);
        let part =
            || Part { from: from as usize, until: until as usize, point: (from - since_first) as usize };
        (from < until).then(part)
    }

    /// Reads the tables between their points, pair by pair: straight from one point to the next. Where the mesh turns evenly the samples of
    /// a pair follow from its first one, and the tables have the damping's lead; elsewhere it is found from the samples.
    ///
    /// # Arguments
    /// * `tables` - the pairs at every point
    /// * `revolutions` - (rev) rotation of the motor at each sample of the block
    /// * `before` - as [`Self::before`]
    /// * `block` - holds zeros
    fn read_tables_between_points(
        &self,
        tables: &TabulatedPairs,
        revolutions: &[f64],
        before: &mut [(i64, [f64; 2])],
        block: &mut PairsBlock,
    ) {
        let (mesh, per_pitch) = (self.mesh, self.mesh.points_per_pitch as f64);
        let turning = mesh.turning;
        // Points of pair 0.
        let point_at = |revolutions: f64| {
            (turning.first_pitch + revolutions * turning.pitches_per_revolution) * per_pitch
                + mesh.points_before as f64
        };
        let points: Vec<f64> = revolutions.iter().map(|revolutions| point_at(*revolutions)).collect();
        let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return };
        let is_even = self.reading != Reading::AnyMotion;
        let step = if is_even { (last - first) / (points.len() - 1).max(1) as f64 } else { 0.0 };
        let reach = mesh.points() as f64 - 1.0;
        let mut places = Vec::new();
        for pair in ((first - reach) / per_pitch).floor() as i64..=(last / per_pitch).floor() as i64 {
            let begins = pair as f64 * per_pitch;
            // As many as are certainly in it; each is checked again.
            let [from, until] = match step > 0.0 {
                true => [begins - step, begins + reach + 2.0 * step]
                    .map(|at| ((at - first) / step).max(0.0) as usize),
                false => [0, usize::MAX],
            };
            let parts = tables.of_pair(mesh, pair);
            let own = points.iter().map(|point| point - begins).enumerate().take(until).skip(from);
            let own = own.filter(|(_, point)| (0.0..reach).contains(point));
            places.clear();
            places.extend(own.map(|(sample, point)| parts.place(sample, point)));
            let Some(first) = places.first() else { continue };
            let place = pair.rem_euclid(mesh.pairs_at_once() as i64) as usize;
            if let Some(classes) = block.classes.get_mut(place) {
                classes.push((first.sample, parts.class));
            }
            let first_spring = place * mesh.slices();
            for at in &places {
                block.set_sliding_and_strips(
                    (mesh, parts.class),
                    (first_spring, at.sample),
                    (at.index, at.part),
                );
            }
            // Slice by slice, each along all samples.
            for (number, slice) in parts.slices.iter().enumerate() {
                let spring = first_spring + number;
                let closer_m = mesh.slice_closer_m(number, parts.wobble_m);
                if let Some(wobble) = block.wobble.get_mut(spring) {
                    for at in &places {
                        let slope: f64 = parts.slopes.iter().map(|table| at.of(table, 0)).sum();
                        let before = &mut before[mesh.springs() + spring];
                        wobble[at.sample] =
                            parts.wobble_m + if is_even { slope } else { self.leading(slope, pair, before) };
                    }
                }
                for (end, corner) in slice.corners.iter().flatten().enumerate() {
                    let CornerBlock { offset, near: nears, far: fars, place: strip } =
                        &mut block.corners[spring][end];
                    for at in &places {
                        let [near, far] = [corner.near, corner.far].map(|table| at.of(table, 0));
                        (nears[at.sample], fars[at.sample]) = (near, far);
                        if far > near {
                            offset[at.sample] = corner.offset_m(at.point) + at.alike_m + closer_m;
                            if mesh.tilts() {
                                strip[at.sample] = mesh.corner_strip(number, end, corner.place, at.point);
                                offset[at.sample] += strip[at.sample] * parts.wobble_m;
                            }
                        }
                    }
                }
                let (stiffness, offsets) = (&mut block.stiffness[spring], &mut block.offset[spring]);
                for at in &places {
                    let own_m: f64 = slice.offsets.iter().map(|(table, from)| at.of(table, *from)).sum();
                    let offset = own_m + at.alike_m + closer_m;
                    stiffness[at.sample] = at.of(slice.stiffness, 0);
                    offsets[at.sample] =
                        if is_even { offset } else { self.leading(offset, pair, &mut before[spring]) };
                }
            }
        }
    }

    /// (m) An offset with the damping's lead, by the samples before it.
    ///
    /// # Arguments
    /// * `offset` - (m) of a pair's spring at a sample
    /// * `pair` - its number
    /// * `before` - of the spring
    fn leading(&self, offset: f64, pair: i64, before: &mut (i64, [f64; 2])) -> f64 {
        let [last, last_but_one] = if before.0 == pair { before.1 } else { [f64::NAN; 2] };
        *before = (pair, [offset, last]);
        // The next one is not known: the slope here of the parabola through the last three, or of the line through two.
        let change = if last.is_nan() {
            0.0
        } else if last_but_one.is_nan() {
            offset - last
        } else {
            1.5 * offset - 2.0 * last + 0.5 * last_but_one
        };
        offset + self.lead * change
    }

    /// Reads the pairs of spur wheels, whose face is one slice, at any rotation of the motor: stiffness and separation from their tables,
    /// deviations from the flanks themselves.
    fn read_between_points(&mut self, revolutions: &[f64], block: &mut PairsBlock) {
        let (mesh, per_pitch) = (self.mesh, self.mesh.points_per_pitch as f64);
        let at_once = mesh.pairs_at_once() as i64;
        for (k, revolutions) in revolutions.iter().enumerate() {
            let pitches = mesh.turning.first_pitch + revolutions * mesh.turning.pitches_per_revolution;
            let eccentric = self.eccentricity.as_ref().map_or(0.0, |eccentricity| {
                let of_wheel =
                    |wheel| eccentricity.of_wheel_m(wheel, pitches / mesh.sequence.teeth_of(wheel) as f64);
                WheelName::BOTH.map(of_wheel).iter().sum()
            });
            let latest = (pitches + mesh.points_before as f64 / per_pitch).floor() as i64;
            for pair in latest + 1 - at_once..=latest {
                let place = pair.rem_euclid(at_once) as usize;
                let position = pitches - pair as f64;
                let point = position * per_pitch + mesh.points_before as f64;
                let states = &mesh.classes[mesh.sequence.class(pair)].states;
                let (index, part) = (point.floor().max(0.0) as usize, point - point.floor());
                let mut before = self.before[place];
                let Some([here, next]) = states.get(index..index + 2) else {
                    self.before[place] = (i64::MIN, [0.0; 2]);
                    continue;
                };
                let between = |a: f64, b: f64| a + part * (b - a);
                let (pinion_tooth, gear_tooth) = mesh.sequence.teeth(pair);
                let offset = self.pinion.at_position_m(pinion_tooth, position)
                    + self.gear.at_position_m(gear_tooth, position)
                    + eccentric
                    - between(here.separation_m, next.separation_m);
                let class = mesh.sequence.class(pair);
                block.set_sliding_and_strips((mesh, class), (place, k), (index, part));
                if let Some(wobble) = block.wobble.get_mut(place) {
                    wobble[k] = mesh.wobble_m(pair);
                }
                block.stiffness[place][k] = between(here.stiffness_n_per_m, next.stiffness_n_per_m);
                block.offset[place][k] = self.leading(offset, pair, &mut before);
                self.before[place] = before;
            }
        }
    }
}

impl PairParts<'_> {
    /// Where its tables are read at a sample.
    ///
    /// # Arguments
    /// * `sample` - number of the sample in its block
    /// * `point` - of the tables, at least 0
    fn place(&self, sample: usize, point: f64) -> TablePlace {
        let index = point as usize;
        let part = point - index as f64;
        let alike_m = self.alike.iter().map(|(table, from)| between(table, index + from, part)).sum();
        TablePlace { sample, point, index, part, alike_m }
    }
}

/// Where the tables of a pair are read at a sample.
struct TablePlace {
    /// Number of the sample in its block.
    sample: usize,
    point: f64,
    /// Of the point before.
    index: usize,
    /// (-) Of the way to the next one.
    part: f64,
    /// (m) What all slices of the pair add to their offset.
    alike_m: f64,
}

impl TablePlace {
    /// A table here, whose point `from` is the first one of the pair.
    fn of(&self, table: &[f64], from: usize) -> f64 {
        between(table, self.index + from, self.part)
    }
}

/// A table between two of its points.
fn between(table: &[f64], index: usize, part: f64) -> f64 {
    table[index] + part * (table[index + 1] - table[index])
}

/// The samples of a block in which a pair takes part, and its point at the first of them.
struct Part {
    from: usize,
    until: usize,
    point: usize,
}
