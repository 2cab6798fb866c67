//! The equations of motion of a machine with any number of meshes, solved as they are written, with full matrices in the machine's own
//! coordinates: what the modal, low-rank solver is compared with.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::TAU;

use meshtone::Stages;
use meshtone::interpolation::NotAKnotSpline;
use meshtone::machine::{Drive, Machine, Modes};
use meshtone::mesh::{Contact, CornerTable, Mesh, PairDeviations, PairState};
use meshtone::operation::{MotionSample, TimeGrid};
use meshtone::solver::{Block, InitialMotion, Output, Recorder};
use meshtone::wheel::WheelName;
use nalgebra::{Complex, DMatrix, DVector, Matrix2, Vector2};

/// Most of Newton's iterations in a step.
const MOST_ITERATIONS: usize = 50;

/// The machine of a simulation, and its modes without the meshes.
pub fn machine_of(stages: &Stages) -> (&Machine, &Modes) {
    stages.machine_and_modes().unwrap()
}

/// The outputs of a solution, each at all recorded samples.
pub struct Recorded(pub Vec<Vec<f64>>);

impl Recorder for Recorded {
    fn record(&mut self, block: &Block) {
        for (n, values) in self.0.iter_mut().enumerate() {
            values.extend_from_slice(block.output(n));
        }
    }
}

/// The outputs of a simulation from a sample on, as far as it is bounded.
pub fn outputs_from(first_sample: usize, stages: &Stages, outputs: &[Output]) -> Vec<Vec<f64>> {
    let mut recorded = Recorded(vec![Vec::new(); outputs.len()]);
    // What comes after an error is without bound.
    let _ = stages.integrate(outputs, first_sample, &mut recorded);
    recorded.0
}

/// Displacement, velocity or acceleration of all coordinates of a machine, by the order of the derivative.
pub fn coordinates(machine: &Machine, derivative: usize) -> impl Iterator<Item = Output> {
    (0..machine.coordinates()).map(move |number| Output::Coordinate { number, derivative })
}

/// The deviations of the flanks of a mesh of a simulation.
pub fn deviations_of(stages: &Stages, mesh: usize) -> PairDeviations<'_> {
    let pair = &stages.pairs[mesh];
    PairDeviations {
        teeth: &pair.teeth,
        errors: pair.profile_errors.as_ref(),
        eccentricity_m: pair.eccentricity_mm.map(|of_wheel_mm| of_wheel_mm * 1e-3),
        run_out: pair.run_out,
    }
}

/// One mesh of a machine, with the deviations of its flanks.
pub struct DenseMesh<'a> {
    mesh: &'a Mesh,
    deviations: PairDeviations<'a>,
    /// (mm) Profile errors of each tooth over the rows of their table, of the pinion and of the gear.
    errors: [Vec<NotAKnotSpline<'a>>; 2],
}

/// What a mesh does at one sample.
struct Load<'a> {
    contact: Contact,
    /// (N/m, m) Stiffness of each pair, or of each slice of it, and what it adds to the deflection, with the damping's lead; (m) where its middle
    /// is along the face, and its width.
    pairs: Vec<[f64; 4]>,
    /// The same of what helical teeth have outside their path: a stretch of contact line each.
    corners: Vec<Stretch<'a>>,
    /// (N/m, m) The same of the coast flanks.
    back: Option<[f64; 2]>,
    /// (-) Of a mesh with two unknowns, by how much closer the flanks are per length of face.
    closer: Option<f64>,
}

/// A stretch of a contact line outside its path, at one sample.
struct Stretch<'a> {
    corner: &'a CornerTable,
    /// (base pitches) Its edges, outside the corner's place; on the other side of that the corner is as far apart.
    edges: [f64; 2],
    /// (m) What the pair adds to the deflection.
    offset_m: f64,
    /// (m) Where its end of the path lies along the face; 0 of a mesh with one unknown.
    z_m: f64,
}

impl Stretch<'_> {
    /// Places and weights of Gauss's rule with five points, which is exact for the law's integrand.
    const GAUSS: [[f64; 2]; 5] = [
        [-0.906_179_845_938_664, 0.236_926_885_056_189_1],
        [-0.538_469_310_105_683_1, 0.478_628_670_499_366_5],
        [0.0, 0.568_888_888_888_888_9],
        [0.538_469_310_105_683_1, 0.478_628_670_499_366_5],
        [0.906_179_845_938_664, 0.236_926_885_056_189_1],
    ];

    /// (base pitches) s* at a v.
    fn reach(&self, v: f64) -> f64 {
        self.corner.reach.coefficients.iter().zip(1..).map(|(a, j)| a * v.powi(j)).sum()
    }

    /// (√m) The v at which the corner reaches a place, by halves.
    fn root(&self, place: f64) -> f64 {
        let (mut low, mut high) = (0.0, self.corner.reach.most);
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            if self.reach(middle) < place { low = middle } else { high = middle }
        }
        f64::midpoint(low, high)
    }

    /// (m, base pitches) `∫ max(0, x − S) ds` from the corner's place to another one, and its slope.
    fn until(&self, x: f64, place: f64) -> [f64; 2] {
        let far = x.max(0.0).sqrt().min(self.root(place.abs()));
        let mut sums = [0.0; 2];
        for [at, weight] in Self::GAUSS {
            let v = far / 2.0 * (1.0 + at);
            let coefficients = self.corner.reach.coefficients.iter().zip(1..);
            let per_v: f64 = coefficients.map(|(a, j)| f64::from(j) * a * v.powi(j - 1)).sum();
            let part = weight * far / 2.0 * per_v;
            sums = [sums[0] + part * (x - v * v), sums[1] + part];
        }
        sums.map(|sum| sum.copysign(place))
    }

    /// (N, N/m) Force and slope.
    fn force_and_slope(&self, deflection_m: f64) -> [f64; 2] {
        let x = deflection_m + self.offset_m;
        let [near, far] = self.edges.map(|edge| self.until(x, edge));
        [0, 1].map(|n| self.corner.law.stiffness_n_per_m * (far[n] - near[n]))
    }
}

impl<'a> DenseMesh<'a> {
    /// Nothing is computed yet.
    pub fn new(mesh: &'a Mesh, deviations: PairDeviations<'a>) -> Self {
        let errors = WheelName::BOTH.map(|wheel| {
            let table = deviations.errors.map(|errors| match wheel {
                WheelName::Pinion => &errors.pinion_profile_errors_mm,
                WheelName::Gear => &errors.gear_profile_errors_mm,
            });
            let teeth =
                table.into_iter().flat_map(|table| (0..table.teeth()).map(|tooth| table.tooth(tooth)));
            teeth.map(|tooth| NotAKnotSpline::uniform(0.0, 1.0, tooth)).collect()
        });
        Self { mesh, deviations, errors }
    }

    /// (m) How far the flank of a pair's tooth lies outside of the ideal one, of a pair at a position in base pitches, on a slice that is
    /// at a position of its own.
    fn deviation_m(&self, wheel: WheelName, pair: i64, position: f64, of_slice: f64) -> f64 {
        let PairDeviations { teeth, errors, eccentricity_m, run_out } = &self.deviations;
        let (of_wheel, run_out) = (teeth.wheel(wheel), run_out[wheel as usize]);
        let (sign, first_mm) = match wheel {
            WheelName::Pinion => (-1.0, teeth.contact.pinion_initial_radius_mm),
            WheelName::Gear => (1.0, teeth.contact.gear_initial_radius_mm),
        };
        let tooth = pair.rem_euclid(i64::from(of_wheel.teeth));
        let angle = TAU * (tooth as f64 + position) / f64::from(of_wheel.teeth);
        let axis_m =
            sign * eccentricity_m[wheel as usize] * (teeth.gear.working_pressure_angle_rad + angle).sin();
        let circle_m = run_out.run_out_um * 0.5e-6 * (angle + run_out.phase_rad).sin();
        let flank_m = errors.map_or(0.0, |errors| {
            // Rows are uniform in radius, from where a flank's contact begins to where it ends: the gear's begins at its tip.
            let radius_mm = teeth.path.curvature_mm(wheel, of_slice).hypot(of_wheel.base_radius_mm);
            let from_root = ((radius_mm - first_mm) / (of_wheel.tip_radius_mm - first_mm)).clamp(0.0, 1.0);
            let passed = if wheel == WheelName::Pinion { from_root } else { 1.0 - from_root };
            let rows = (errors.pinion_profile_errors_mm.points() - 1) as f64;
            self.errors[wheel as usize][tooth as usize].at(passed * rows) * 1e-3
        });
        axis_m + circle_m + flank_m
    }

    /// (N/m, m) Stiffness of a pair's slice and its offset, deviation less separation, at a point of its table: between two of them
    /// where the point is not a whole number. None beyond the table.
    fn pair_at(&self, pair: i64, slice: usize, point: f64) -> Option<[f64; 2]> {
        let states = &self.mesh.classes[self.mesh.sequence.class(pair)].states;
        let points = self.mesh.points();
        let states = &states[slice * points..(slice + 1) * points];
        let (index, part) = (point.floor(), point - point.floor());
        let at = |n: f64| states.get((n >= 0.0).then_some(n as usize)?);
        let here = at(index)?;
        let next = if part > 0.0 { at(index + 1.0)? } else { here };
        let between = |of: fn(&PairState) -> f64| of(here) + part * (of(next) - of(here));
        let per_pitch = self.mesh.points_per_pitch as f64;
        // A slice is read off at the nearest point.
        let ahead = self.mesh.face.overlap() * ((slice as f64 + 0.5) / self.mesh.slices() as f64 - 0.5);
        let deviation_at = |point: f64| -> f64 {
            let position = (point - self.mesh.points_before as f64) / per_pitch;
            let of_slice = position + (ahead * per_pitch).round() / per_pitch;
            WheelName::BOTH.map(|wheel| self.deviation_m(wheel, pair, position, of_slice)).iter().sum()
        };
        // Deviations of slices are tabulated at points too.
        let deviation = if self.mesh.slices() == 1 {
            deviation_at(point)
        } else {
            deviation_at(index) + part * (deviation_at(index + 1.0) - deviation_at(index))
        };
        Some([between(|state| state.stiffness_n_per_m), deviation - between(|state| state.separation_m)])
    }

    /// What the slices of a pair have outside their path at a point of its tables. The places that corners reach have the damping's lead by
    /// the nominal speed, and where that is steady what all of a wheel's teeth deviate by alike; a flank at its end does not change.
    fn corners_at(
        &self,
        pair: i64,
        point: f64,
        (on_points, is_steady): (bool, bool),
        time: &TimeGrid,
    ) -> Vec<Stretch<'a>> {
        let mesh = self.mesh;
        let point = if on_points { point.round() } else { point };
        let last = (mesh.points() - 1) as f64;
        if !(0.0..last + f64::from(u8::from(on_points))).contains(&point) {
            return Vec::new();
        }
        let per_pitch = mesh.points_per_pitch as f64;
        let points_per_sample =
            per_pitch * mesh.turning.pitches_per_revolution / time.samples_per_pinion_revolution as f64;
        let lead = mesh.damping_time_s / time.step_s() * points_per_sample;
        // Straight between the points.
        let read = |table: &[f64], shift: f64, stretch: &Stretch| {
            let (index, part) = (point as usize, point - point.floor());
            let [here, next] = [index, (index + 1).min(table.len() - 1)]
                .map(|n| stretch.root((table[n] + shift).abs()).copysign(table[n] + shift));
            let v = here + part * (next - here);
            stretch.reach(v.abs()).copysign(v)
        };
        let ahead_pitches = lead / per_pitch;
        let windows = mesh.slices() as f64;
        let half = mesh.face.overlap().abs() / windows / 2.0;
        let stretch = |slice: usize, end: usize, corner: &'a CornerTable| {
            let position = (point - mesh.points_before as f64) / per_pitch;
            let ahead = mesh.face.overlap() * ((slice as f64 + 0.5) / windows - 0.5);
            let nearest = match end {
                0 => (position + ahead + half).min(corner.place),
                _ => (position + ahead - half).max(corner.place),
            };
            // Tabulated at points, straight between them.
            let before = mesh.points_before as f64;
            let place = nearest * per_pitch + before;
            let between = |at: f64, of: &dyn Fn(f64) -> f64| {
                of(at.floor()) + (at - at.floor()) * (of(at.floor() + 1.0) - of(at.floor()))
            };
            let at = |wheel, by: f64| {
                let of_points = |point: f64, place: f64| {
                    let [position, of_slice] = [point, place].map(|point| (point - before) / per_pitch);
                    self.deviation_m(wheel, pair, position, of_slice)
                };
                between(point + by, &|point| between(place, &|place| of_points(point, place)))
            };
            let deviation = |wheel| {
                let change = if is_steady { (at(wheel, 1.0) - at(wheel, -1.0)) / 2.0 } else { 0.0 };
                at(wheel, 0.0) + lead * change
            };
            let offset_m = WheelName::BOTH.map(deviation).iter().sum::<f64>() - corner.separation_m;
            // Within its slice.
            let ends = [slice, slice + 1].map(|edge| edge as f64 / windows - 0.5);
            let along = ((corner.place - position) / mesh.face.overlap()).clamp(ends[0], ends[1]);
            // Of a slice midway to that edge which lies farther outside the path.
            let outer = if (end == 1) == (mesh.face.overlap() > 0.0) { ends[1] } else { ends[0] };
            let along = if windows > 1.0 { f64::midpoint(along, outer) } else { along };
            let z_m = mesh.two_unknowns().map_or(0.0, |[width_m, _]| width_m * along);
            let mut stretch = Stretch { corner, edges: [0.0; 2], offset_m, z_m };
            let shift = if end == 0 { -ahead_pitches } else { ahead_pitches };
            stretch.edges = [&corner.near, &corner.far].map(|table| read(table, shift, &stretch));
            // The damping's lead makes the penetration deeper.
            stretch.offset_m += stretch.root(ahead_pitches).powi(2);
            stretch
        };
        let slices = mesh.classes[mesh.sequence.class(pair)].corners.iter().enumerate();
        slices
            .flat_map(|(slice, ends)| ends.iter().enumerate().map(move |(end, corner)| (slice, end, corner)))
            .map(|(slice, end, corner)| stretch(slice, end, corner))
            .collect()
    }

    /// The pairs that can touch after some pitches, the newest first, with the points of their tables.
    fn pairs_after(&self, pitches: f64) -> impl Iterator<Item = (i64, f64)> {
        let (per_pitch, before) = (self.mesh.points_per_pitch as f64, self.mesh.points_before as f64);
        let newest = ((pitches * per_pitch + before) / per_pitch).floor() as i64;
        let at_once = self.mesh.points().div_ceil(self.mesh.points_per_pitch) as i64;
        (0..at_once).map(move |age| (newest - age, (pitches - (newest - age) as f64) * per_pitch + before))
    }

    /// What the mesh does at a sample, of the motor's rotation until then.
    ///
    /// Where every sample is a point of the tables, the offset's derivative is a central difference of the table. Elsewhere the next
    /// sample is not known, and the derivative is that of the parabola through the last three.
    fn load(&self, revolutions: &[f64], sample: usize, is_steady: bool, time: &TimeGrid) -> Load<'a> {
        let mesh = self.mesh;
        let per_pitch = mesh.points_per_pitch as f64;
        let samples_per_revolution = time.samples_per_pinion_revolution as f64;
        let points_per_revolution = per_pitch * mesh.turning.pitches_per_revolution;
        let on_points = is_steady
            && mesh.turning.first_pitch == 0.0
            && (points_per_revolution / samples_per_revolution - 1.0).abs() < 1e-13;
        let pitches = |sample: usize| {
            mesh.turning.first_pitch + revolutions[sample] * mesh.turning.pitches_per_revolution
        };
        let last = (mesh.points() - 1) as f64;
        let of_slice = |((pair, point), slice): ((i64, f64), usize)| {
            let point = if on_points { point.round() } else { point };
            let [stiffness, offset] = self.pair_at(pair, slice, point)?;
            let before = |samples: usize| {
                let then = pitches(sample.checked_sub(samples)?) - pair as f64;
                Some(self.pair_at(pair, slice, then * per_pitch + mesh.points_before as f64)?[1])
            };
            let change = if on_points {
                let beside = |by: f64| self.pair_at(pair, slice, (point + by).clamp(0.0, last));
                (beside(1.0)?[1] - beside(-1.0)?[1]) / 2.0
            } else {
                match (before(1), before(2)) {
                    (Some(one), Some(two)) => 1.5 * offset - 2.0 * one + 0.5 * two,
                    (Some(one), None) => offset - one,
                    (None, _) => 0.0,
                }
            };
            let [z_m, width_m] = self.left_at(pair, slice, point)?;
            Some([stiffness, offset + mesh.damping_time_s * change / time.step_s(), z_m, width_m])
        };
        Load {
            contact: mesh.contact,
            pairs: (self.pairs_after(pitches(sample)))
                .flat_map(|pair| (0..mesh.slices()).map(move |slice| (pair, slice)))
                .filter_map(of_slice)
                .collect(),
            corners: (self.pairs_after(pitches(sample)))
                .flat_map(|(pair, point)| self.corners_at(pair, point, (on_points, is_steady), time))
                .collect(),
            back: mesh.backlash_m.map(|backlash_m| [mesh.closed_stiffness_n_per_m, backlash_m]),
            closer: self.mesh.two_unknowns().map(|[width_m, closer_m]| closer_m / width_m),
        }
    }

    /// (m) Middle and width of a slice, or of what touches of a whole face.
    fn left_at(&self, pair: i64, slice: usize, point: f64) -> Option<[f64; 2]> {
        let width_m = self.mesh.two_unknowns().map_or(0.0, |[width_m, _]| width_m);
        let strips = &self.mesh.classes[self.mesh.sequence.class(pair)].strips;
        if strips.is_empty() {
            return Some([self.place_m(slice), width_m / self.mesh.slices() as f64]);
        }
        let (index, part) = (point as usize, point - point.floor());
        let here = *strips.get(index)?;
        let next = strips.get(index + 1).copied().unwrap_or(here);
        let [place, half_width] = [0, 1].map(|n| here[n] + part * (next[n] - here[n]));
        Some([place * width_m / 2.0, half_width * width_m])
    }

    /// (m) Middle of a slice along the face; 0 of a mesh with one unknown.
    fn place_m(&self, slice: usize) -> f64 {
        let middle = (slice as f64 + 0.5) / self.mesh.slices() as f64 - 0.5;
        self.mesh.two_unknowns().map_or(0.0, |[width_m, _]| middle * width_m)
    }
}

/// Force and moment of a mesh at its deflection and the slope of this along the face, and the derivatives of both; one unknown has no moment.
type Carried = (Vector2<f64>, Matrix2<f64>);

impl Load<'_> {
    /// What is carried at a deflection and its slope along the face.
    ///
    /// With two unknowns a slice from a to c, with an even stiffness k' per length, penetrates by `x₀ + z x₁`: what of it does so has the moments `m_j`
    /// of its length, `F = k' (x₀ m₀ + x₁ m₁)`, and `M = k' (x₀ m₁ + x₁ m₂)`.
    fn carried(&self, deflection: Vector2<f64>) -> Carried {
        let mut sums: Carried = (Vector2::zeros(), Matrix2::zeros());
        let mut add = |force: Vector2<f64>, slopes: Matrix2<f64>| {
            sums.0 += force;
            sums.1 += slopes;
        };
        for [stiffness, offset, z_m, width_m] in &self.pairs {
            let Some(closer) = self.closer else {
                let penetration_m = deflection.x + offset;
                if self.contact == Contact::Bilateral || penetration_m > 0.0 {
                    add(
                        Vector2::new(stiffness * penetration_m, 0.0),
                        Matrix2::new(*stiffness, 0.0, 0.0, 0.0),
                    );
                }
                continue;
            };
            if *stiffness == 0.0 {
                continue;
            }
            let slope = deflection.y + closer;
            let at_0 = deflection.x + offset;
            let (mut from, mut until) = (z_m - width_m / 2.0, z_m + width_m / 2.0);
            if slope > 0.0 {
                from = from.max(-at_0 / slope).min(until);
            } else if slope < 0.0 {
                until = until.min(-at_0 / slope).max(from);
            } else if at_0 <= 0.0 {
                continue;
            }
            let m = [1, 2, 3].map(|n| (until.powi(n) - from.powi(n)) / f64::from(n) * stiffness / width_m);
            let slopes = Matrix2::new(m[0], m[1], m[1], m[2]);
            add(slopes * Vector2::new(at_0, slope), slopes);
        }
        for corner in &self.corners {
            let z_m = corner.z_m;
            let lean = self.closer.map_or(0.0, |closer| deflection.y + closer);
            let [force, slope] = corner.force_and_slope(deflection.x + z_m * lean);
            add(Vector2::new(1.0, z_m) * force, Matrix2::new(1.0, z_m, z_m, z_m * z_m) * slope);
        }
        if let Some([stiffness, backlash_m]) = self.back.filter(|[_, backlash]| deflection.x + backlash < 0.0)
        {
            add(
                Vector2::new(stiffness * (deflection.x + backlash_m), 0.0),
                Matrix2::new(stiffness, 0.0, 0.0, 0.0),
            );
        }
        sums
    }

    /// (m) Deflection at which the drive flanks carry a force, at a slope along the face.
    fn at_rest_m(&self, force_n: f64, slope: f64) -> f64 {
        let (mut low, mut high) = (-1e-2, 1e-2);
        for _ in 0..100 {
            let middle = (low + high) / 2.0;
            if self.carried(Vector2::new(middle, slope)).0.x < force_n { low = middle } else { high = middle }
        }
        high
    }
}

/// A machine with its meshes, and what drives it.
pub struct Dense<'a> {
    pub machine: &'a Machine,
    pub modes: &'a Modes,
    pub meshes: Vec<DenseMesh<'a>>,
    pub time: &'a TimeGrid,
    /// Motor and brake at every sample from the start.
    pub motion: Vec<MotionSample>,
    /// Whether motor and brake are steady.
    pub is_steady: bool,
    pub start: InitialMotion<'a>,
}

impl<'a> Dense<'a> {
    /// The machine of a simulation, over its first samples.
    pub fn of(stages: &'a Stages, samples: usize) -> Self {
        let (machine, modes) = machine_of(stages);
        let operation = &stages.scenario.operation;
        let profile = operation.speed_profile_hz.as_ref();
        Self {
            machine,
            modes,
            meshes: (stages.meshes.iter().enumerate())
                .map(|(number, mesh)| DenseMesh::new(mesh, deviations_of(stages, number)))
                .collect(),
            time: &stages.time,
            motion: stages.motion().take(samples).collect(),
            is_steady: stages.is_steady(),
            start: InitialMotion {
                nominal_rad_per_s: TAU * operation.pinion_speed_hz,
                brake_torque_nm: operation.brake_torque_nm,
                motor_rad_per_s: TAU * profile.map_or(operation.pinion_speed_hz, |profile| profile.value[0]),
                velocity: stages.scenario.solver.initial_velocity.as_ref().map(|given| given.as_slice()),
            },
        }
    }

    /// (N) What motor and brake do, and what damping makes of the motor's speed, relative to the rigid rotation at the nominal speed.
    fn external(&self, sample: usize, damping: &DMatrix<f64>) -> DVector<f64> {
        let MotionSample { revolutions, speed_hz, torque_nm } = self.motion[sample];
        let nominal = self.start.nominal_rad_per_s;
        let lead = TAU * revolutions - nominal * (sample as f64 * self.time.step_s());
        let mut force = damping * &self.machine.rigid_rotation * (TAU * speed_hz - nominal);
        for drive in &self.machine.drives {
            match *drive {
                Drive::Motor { coordinate, stiffness_nm_per_rad, speed_ratio } => {
                    force[coordinate] += stiffness_nm_per_rad * speed_ratio * lead;
                }
                Drive::Brake { coordinate, torque_share } => force[coordinate] += torque_share * torque_nm,
            }
        }
        force
    }

    /// The line of action of each mesh at the middle of its face, and what is added per m along it.
    fn lines(&self) -> Vec<[DVector<f64>; 2]> {
        let turned = |column: &DVector<f64>| &self.machine.turn * column;
        self.machine.lines.iter().map(|line| [&line.at_middle, &line.per_m].map(turned)).collect()
    }

    /// Displacement at rest under the first torque and the meshes' forces, which act midway along the faces, with the meshes closed.
    fn displacement_at_rest(&self, stiffness: &DMatrix<f64>, loads: &[Load]) -> DVector<f64> {
        let (n, meshes) = (self.machine.coordinates(), loads.len());
        let mut matrix = DMatrix::zeros(n + meshes, n + meshes);
        matrix.view_mut((0, 0), (n, n)).copy_from(stiffness);
        let lines = self.lines();
        for (mesh, [at_middle, _]) in lines.iter().enumerate() {
            matrix.view_mut((0, n + mesh), (n, 1)).copy_from(at_middle);
            matrix.view_mut((n + mesh, 0), (1, n)).copy_from(&at_middle.transpose());
        }
        let matrix = matrix.lu();
        let mut right = DVector::zeros(n + meshes);
        for drive in &self.machine.drives {
            if let Drive::Brake { coordinate, torque_share } = *drive {
                right[coordinate] += torque_share * self.motion[0].torque_nm;
            }
        }
        // Neither the forces nor the wheels' tilts depend on how far the meshes give way.
        let before = matrix.solve(&right).unwrap();
        for (mesh, load) in loads.iter().enumerate() {
            let slope = lines[mesh][1].dot(&before.rows(0, n));
            right[n + mesh] = load.at_rest_m(before[n + mesh].max(0.0), slope);
        }
        matrix.solve(&right).unwrap().rows(0, n).into_owned()
    }

    /// Accelerations of all coordinates at the samples of the motion, by Newmark's method with γ = ½ and a β of each mode.
    ///
    /// The unknown is u less the rigid rotation at the nominal speed, whose forces are subtracted. The equations are the same; in u
    /// itself rounding grows with the angle turned, which would hide what is compared. With the predictions ũ and ṽ, the acceleration a
    /// at a step's end obeys `(M + ½ Δt C + Δt² K β) a + Σ g f(D) = F − C ṽ − K ũ` with `D = gᵀ (ũ + τ ṽ + (Δt² β + ½ Δt τ) a)`, where M, C
    /// and β are the matrices of [`DenseSteps`]. The forces are piecewise linear: Newton's method has found them when the same flanks
    /// touch as before.
    pub fn accelerations(&self) -> Vec<DVector<f64>> {
        assert_eq!(self.time.first_simulated_sample, 0);
        let machine = self.machine;
        let dt = self.time.step_s();
        let steps = self.steps();
        let own_damping = self.modes.damping_matrix(machine);
        let stiffness = machine.turn_back(&machine.stiffness());
        let implicit = &steps.mass + &steps.damping * (dt / 2.0) + &stiffness * &steps.beta * (dt * dt);
        let revolutions: Vec<f64> = self.motion.iter().map(|motion| motion.revolutions).collect();
        let loads_at = |sample: usize| -> Vec<Load<'a>> {
            self.meshes
                .iter()
                .map(|mesh| mesh.load(&revolutions, sample, self.is_steady, self.time))
                .collect()
        };
        let tau: Vec<f64> = self.meshes.iter().map(|mesh| mesh.mesh.damping_time_s).collect();
        let rigid = &machine.rigid_rotation;
        let loads = loads_at(0);
        let mut u = self.displacement_at_rest(&stiffness, &loads);
        let given =
            |given: &[f64]| DVector::from_fn(rigid.len(), |n, _| given.get(n).copied().unwrap_or(0.0));
        let mut v = self.start.velocity.map_or_else(|| rigid * self.start.motor_rad_per_s, given)
            - rigid * self.start.nominal_rad_per_s;
        let mut force = self.external(0, &own_damping) - &steps.damping * &v - &stiffness * &u;
        let lines = self.lines();
        for ((line, load), tau) in lines.iter().zip(&loads).zip(&tau) {
            let of = |column: &DVector<f64>| column.dot(&u) + tau * column.dot(&v);
            let (carried, _) = load.carried(Vector2::new(of(&line[0]), of(&line[1])));
            force -= &line[0] * carried.x + &line[1] * carried.y;
        }
        let mut a = steps.mass.clone().lu().solve(&force).unwrap();
        // What is stepped is an acceleration of the changed mass: the machine's own has the same force.
        let own_mass = machine.mass.clone().cholesky().unwrap();
        let own = |a: &DVector<f64>| own_mass.solve(&(&steps.mass * a));
        let mut accelerations = vec![own(&a)];
        for sample in 1..self.motion.len() {
            let loads = loads_at(sample);
            let predicted_u = &u + &v * dt + (&a * 0.5 - &steps.beta * &a) * (dt * dt);
            let predicted_v = &v + &a * (dt / 2.0);
            let known = self.external(sample, &own_damping)
                - &steps.damping * &predicted_v
                - &stiffness * &predicted_u;
            // D is the free part and the part that goes with the acceleration.
            let free = |(line, tau): (&[DVector<f64>; 2], &f64)| {
                Vector2::from_iterator(
                    line.iter().map(|line| line.dot(&predicted_u) + tau * line.dot(&predicted_v)),
                )
            };
            let free: Vec<Vector2<f64>> = lines.iter().zip(&tau).map(free).collect();
            let with_a = |(line, tau): (&[DVector<f64>; 2], &f64)| {
                line.each_ref().map(|line| steps.beta.tr_mul(line) * (dt * dt) + line * (tau * dt / 2.0))
            };
            let with_a: Vec<[DVector<f64>; 2]> = lines.iter().zip(&tau).map(with_a).collect();
            let deflection =
                |a: &DVector<f64>, n: usize| free[n] + Vector2::new(with_a[n][0].dot(a), with_a[n][1].dot(a));
            let carried = |a: &DVector<f64>| -> Vec<Carried> {
                (0..lines.len()).map(|n| loads[n].carried(deflection(a, n))).collect()
            };
            let mut before = carried(&a);
            for iteration in 0.. {
                assert!(iteration < MOST_ITERATIONS, "sample {sample}: no end of the iterations");
                let (mut matrix, mut right) = (implicit.clone(), known.clone());
                for (n, (forces, slopes)) in before.iter().enumerate() {
                    // On the tangent: forces at free deflections.
                    let constant = forces - slopes * (deflection(&a, n) - free[n]);
                    for row in 0..2 {
                        right -= &lines[n][row] * constant[row];
                        for column in 0..2 {
                            if slopes[(row, column)] != 0.0 {
                                matrix +=
                                    &lines[n][row] * with_a[n][column].transpose() * slopes[(row, column)];
                            }
                        }
                    }
                }
                let next = matrix.lu().solve(&right).unwrap();
                let has_moved = (&next - &a).amax() > 1e-13 * next.amax();
                a = next;
                let now = carried(&a);
                // What corners and leaning faces carry is found to rounding.
                let is_near = |((force, now), (force_before, before)): (&Carried, &Carried)| {
                    (now - before).amax() <= 1e-13 * before.amax()
                        || (force - force_before).amax() <= 1e-14 * force_before.amax()
                };
                if !has_moved || now.iter().zip(&before).all(is_near) {
                    break;
                }
                before = now;
            }
            u = predicted_u + &steps.beta * &a * (dt * dt);
            v = predicted_v + &a * (dt / 2.0);
            accelerations.push(own(&a));
        }
        accelerations
    }

    /// How the modes are stepped: β = 1/12, or ¼ for those that turn by more than 2.4 in a step, and for all that a mesh
    /// reaches whose closing would make them unstable otherwise.
    pub fn steps(&self) -> DenseSteps {
        let (machine, dt) = (self.machine, self.time.step_s());
        let n = machine.coordinates();
        let shapes = &machine.turn * &self.modes.shapes;
        let omega = &self.modes.angular_frequencies;
        let resolved = |mode: usize| omega[mode] * dt < 2.4;
        let of = |mode: usize, beta: f64| {
            let (k, c) = (omega[mode] * omega[mode] * dt * dt, self.modes.damping_per_s(mode) * dt);
            if resolved(mode) && k > 0.0 { exact_steps(k, c, beta) } else { [k, c] }
        };
        let mut betas: Vec<f64> = (0..n).map(|mode| if resolved(mode) { 1.0 / 12.0 } else { 0.25 }).collect();
        for (line, mesh) in machine.lines.iter().zip(&self.meshes) {
            let reach_m = mesh.mesh.two_unknowns().map_or(0.0, |[width_m, _]| width_m / 2.0);
            let lines = [-1.0, 1.0].map(|side| {
                shapes.tr_mul(&(&machine.turn * (&line.at_middle + &line.per_m * (side * reach_m))))
            });
            // What only rounding reaches stays at rest.
            let reached = |mode: usize| lines.iter().any(|line| line[mode].abs() > 1e-12 * line.amax());
            let used_up = |line: &DVector<f64>| -> f64 {
                let stepped = (0..n).filter(|&mode| betas[mode] < 0.25);
                let term = |mode: usize| {
                    let k = omega[mode] * omega[mode] * dt * dt;
                    let stepped_k = of(mode, betas[mode])[0];
                    let factor = if k > 0.0 { stepped_k / k } else { 1.0 };
                    let mesh_n_per_m = 2.0 * mesh.mesh.closed_stiffness_n_per_m;
                    mesh_n_per_m * dt * dt * factor * line[mode].powi(2) / (6.0 - stepped_k)
                };
                stepped.map(term).sum()
            };
            if lines.iter().any(|line| used_up(line) > 0.8) {
                (0..n).filter(|&mode| reached(mode)).for_each(|mode| betas[mode] = 0.25);
            }
        }
        let mass = machine.mass.clone();
        let to_modes = shapes.transpose() * &mass;
        let matrix = |of_mode: &dyn Fn(usize) -> f64| {
            let diagonal = DMatrix::from_diagonal(&DVector::from_fn(n, |mode, _| of_mode(mode)));
            &shapes * diagonal * &to_modes
        };
        let inertia = |mode: usize| {
            let k = omega[mode] * omega[mode] * dt * dt;
            if k > 0.0 { k / of(mode, betas[mode])[0] } else { 1.0 }
        };
        DenseSteps {
            mass: &mass * matrix(&inertia),
            damping: &mass * matrix(&|mode| inertia(mode) * of(mode, betas[mode])[1] / dt),
            beta: matrix(&|mode| betas[mode]),
        }
    }
}

/// The matrices of a step in the machine's coordinates.
pub struct DenseSteps {
    /// (kg, kg m²) With the factor of each mode's inertia.
    pub mass: DMatrix<f64>,
    pub damping: DMatrix<f64>,
    /// (-) β of each mode.
    pub beta: DMatrix<f64>,
}

/// `Δt² k` and `Δt c` with which the steps of a free mode are exact: a root `z = exp(λ Δt)` of the mode is one of
/// `z² − 2z + 1 + K (β z² + (1 − 2β) z + β) + ½ C (z² − 1)`. In real and imaginary parts these are two linear equations.
fn exact_steps(k: f64, c: f64, beta: f64) -> [f64; 2] {
    let root = Complex::new(-c / 2.0, (k - c * c / 4.0).sqrt()).exp();
    let of_k = root * root * beta + root * (1.0 - 2.0 * beta) + beta;
    let of_c = (root * root - 1.0) / 2.0;
    let right = -(root * root - root * 2.0 + 1.0);
    let determinant = of_k.re * of_c.im - of_k.im * of_c.re;
    [
        (right.re * of_c.im - right.im * of_c.re) / determinant,
        (of_k.re * right.im - of_k.im * right.re) / determinant,
    ]
}
