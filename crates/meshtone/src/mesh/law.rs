//! The law of a mesh: `f = Σ k_n max(0, x_n + τ ẋ_n) − k̄ max(0, −j − (δ + τ δ̇))` with `x_n = δ + e_n − S_n`, summed over its springs: the
//! pairs of teeth, or the slices of each pair where its gap varies along the face.
//!
//! A contact line of helical teeth that leaves its path touches there with a corner, place by place: with S the corner's separation, and
//! k' the stiffness per base pitch, what lies from p to q base pitches outside the path carries `k' ∫ max(0, x − S) ds`, which is in closed form
//! ([`CornerLaw`]). It is added to the spring of what lies on the path.
//!
//! Flanks push and never pull. Where they may pull, as in a linear mesh, every pair on its path carries `k_n (x_n + τ ẋ_n)` of either
//! sign, and coast flanks are out of reach.
//!
//! Stiffness, deviation and separation of every pair are known functions of the rotation, so a mesh has one unknown in a step, the
//! deflection with its damping's lead, `D = δ + τ δ̇`. At the step's end `D = D₀ − Γ f(D)`, where D₀ is what it would be without
//! the mesh's force: a rising, piecewise linear equation, solved exactly by Newton's method. The drive flanks' force is
//! convex, so that from the first iterate on the method comes down to the solution, and ends when no pair leaves. With corners it is smooth:
//! there the method ends when an iterate is so near to the last one that the tangent is exact between them.
//!
//! Where the face closes unevenly and the wheels tilt under the load, the mesh has a second unknown, the slope of its deflection along the face: at
//! ζ from −1 to 1 the deflection is `D + ζ (T + c)`, with T what the tilt of the wheels adds at the end of the face at positive z, and c what their flanks do. A
//! spring is then a strip of the face with an even stiffness, of which that part carries where it is positive ([`MeshLaw::tilted`]). Force and moment are the
//! derivatives of `Σ ∫ ½ k' max(0, x)² dz`, which is convex, so that a step has one solution.
//!
//! Where two teeth meet at speed the force begins when `x + τ ẋ` crosses 0, which is earlier than x does by τ, a few
//! microseconds: so the force has no jump, and the equation always a solution.

use super::corner::TERMS;
use super::forcing::{CornerBlock, PairsBlock};
use super::gear_mesh::Mesh;
use crate::simd::{Instructions, Lanes};

/// How two flanks touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contact {
    /// They push, and never pull.
    Unilateral,
    /// They push and pull as long as they are on their path, as in a linear mesh.
    Bilateral,
}

impl Contact {
    /// (m) Penetration below which a pair carries nothing.
    fn lets_go_at_m(self) -> f64 {
        match self {
            Self::Unilateral => 0.0,
            Self::Bilateral => f64::NEG_INFINITY,
        }
    }

    /// Whether a pair carries a force at a penetration.
    ///
    /// # Arguments
    /// * `penetration_m` - (m) deflection less separation
    pub(super) fn touches(self, penetration_m: f64) -> bool {
        penetration_m > self.lets_go_at_m()
    }
}

/// What a contact line of helical teeth carries outside its path, at one of its ends.
///
/// Per unit of stiffness a line from the path's end to where the corner reaches at `m²` carries `κ(D, m) = J(v) + s*(v) (D − v²)` with
/// `v = min(√D, m)` and `J = ∫ s* dD`: the corner touches as far as it reaches, or the whole line does. A line from one place to
/// another carries the difference of two of these. κ is smooth and convex in D, its slope is s*(v). With the damping's lead a line may lie on
/// the other side of the corner's place, where S is the same: there m is negative, and κ is odd.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct CornerLaw {
    /// (N/m) Stiffness per base pitch of the contact line.
    pub stiffness_n_per_m: f64,
    /// (base pitches per m^(j/2)) a_j of the reach `s*(D) = Σ a_j v^j`, from j = 1.
    pub coefficients: [f64; TERMS],
}

/// Parts of a_j in `s* − J/v²`: `κ = D Σ a_j v^j − v² Σ a_j v^j j/(j + 2)`.
const OF_DEPTH: [f64; TERMS] = [1.0 / 3.0, 2.0 / 4.0, 3.0 / 5.0, 4.0 / 6.0, 5.0 / 7.0, 6.0 / 8.0];

impl CornerLaw {
    /// Of no stiffness.
    pub(crate) const NONE: Self = Self { stiffness_n_per_m: 0.0, coefficients: [0.0; TERMS] };

    /// (m, base pitches) κ and its slope, at a penetration, its root and the edge m.
    #[inline(always)]
    fn until(&self, penetration_m: f64, root: f64, edge: f64) -> [f64; 2] {
        let v = root.min(edge.abs());
        let [mut reach, mut depth] = [0.0; 2];
        for (a, part) in self.coefficients.iter().zip(OF_DEPTH).rev() {
            reach = (reach + a) * v;
            depth = (depth + a * part) * v;
        }
        [penetration_m * reach - v * v * depth, reach].map(|value| value.copysign(edge))
    }
}

/// A corner at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CornerAt {
    /// Number of its law.
    pub(crate) law: u32,
    /// (m) What deviations and separation add to the deflection at the end of the path.
    pub(crate) offset_m: f64,
    /// (√m) The edges of the line, as the v at which the corner reaches them: that nearer to the path, and the farther one.
    pub(crate) near: f64,
    pub(crate) far: f64,
    /// (-) Of a face that tilts, where it touches along it, from −1 to 1: as of [`Mesh::corner_strip`].
    pub(crate) place: f64,
}

impl CornerAt {
    /// Whether any part of the contact line lies outside the path, and within reach.
    pub(crate) fn can_touch(&self) -> bool {
        self.far > self.near
    }

    /// (N, N/m) Force and slope.
    ///
    /// # Arguments
    /// * `laws` - among which is its own
    /// * `deflection_m` - (m) D
    #[inline(always)]
    pub(crate) fn force_and_slope(&self, laws: &[CornerLaw], deflection_m: f64) -> [f64; 2] {
        let penetration_m = deflection_m + self.offset_m;
        let nearest = self.near.max(-self.far).max(0.0);
        if penetration_m <= nearest * nearest {
            return [0.0; 2];
        }
        let (law, root) = (&laws[self.law as usize], penetration_m.sqrt());
        let far = law.until(penetration_m, root, self.far);
        let near = law.until(penetration_m, root, self.near);
        [0, 1].map(|n| law.stiffness_n_per_m * (far[n] - near[n]))
    }
}

/// The laws of the corners of some pairs, of which there are none of spur teeth, side by side.
pub(crate) type CornerLanes<const L: usize, const C: usize> = [[CornerLane<L>; 2]; C];

/// One corner's law in each of `L` simulations: its stiffness, and its coefficients for reach and depth.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(crate) struct CornerLane<const L: usize> {
    stiffness: Lanes<L>,
    of_reach: [Lanes<L>; TERMS],
    of_depth: [Lanes<L>; TERMS],
}

impl<const L: usize> CornerLane<L> {
    /// Lines the laws of `L` simulations up.
    pub(crate) fn new(laws: [CornerLaw; L]) -> Self {
        Self {
            stiffness: Lanes::from_fn(|l| laws[l].stiffness_n_per_m),
            of_reach: std::array::from_fn(|j| Lanes::from_fn(|l| laws[l].coefficients[j])),
            of_depth: std::array::from_fn(|j| Lanes::from_fn(|l| laws[l].coefficients[j] * OF_DEPTH[j])),
        }
    }

    /// κ and its slope, as [`CornerLaw::until`].
    #[inline(always)]
    fn until<I: Instructions>(
        &self,
        simd: I,
        [penetration, root]: [Lanes<L>; 2],
        edge: Lanes<L>,
    ) -> [Lanes<L>; 2] {
        let v = root.min(simd, edge.max(simd, edge.neg(simd)));
        let [mut reach, mut depth] = [self.of_reach[TERMS - 1], self.of_depth[TERMS - 1]];
        for j in (0..TERMS - 1).rev() {
            reach = reach.mul_add(simd, v, self.of_reach[j]);
            depth = depth.mul_add(simd, v, self.of_depth[j]);
        }
        let reach = reach.mul(simd, v);
        let depth = depth.mul(simd, v).mul(simd, v.mul(simd, v));
        let (zero, kappa) = (Lanes::splat(0.0), penetration.mul(simd, reach).sub(simd, depth));
        // Not as a closure over an array, which is compiled without the instruction set.
        [
            kappa.neg(simd).where_less(simd, edge, zero, kappa),
            reach.neg(simd).where_less(simd, edge, zero, reach),
        ]
    }
}

/// A corner of a pair at one sample, in each of `L` simulations: as [`CornerAt`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct CornerSample<const L: usize> {
    offset: Lanes<L>,
    near: Lanes<L>,
    far: Lanes<L>,
}

impl<const L: usize> CornerSample<L> {
    const NONE: Self = Self { offset: Lanes([0.0; L]), near: Lanes([0.0; L]), far: Lanes([0.0; L]) };

    /// (N, N/m) Force and slope at a deflection.
    #[inline(always)]
    fn force_and_slope<I: Instructions>(
        &self,
        simd: I,
        law: &CornerLane<L>,
        deflection: Lanes<L>,
    ) -> [Lanes<L>; 2] {
        let penetration = deflection.add(simd, self.offset).max(simd, Lanes::splat(0.0));
        let at = [penetration, penetration.sqrt(simd)];
        let [far, near] = [law.until(simd, at, self.far), law.until(simd, at, self.near)];
        [
            law.stiffness.mul(simd, far[0].sub(simd, near[0])),
            law.stiffness.mul(simd, far[1].sub(simd, near[1])),
        ]
    }
}

/// The pairs of a mesh at one sample, of which `P` are looked at together, and `C` have corners of their own. Aligned so that eight numbers side by side never straddle two
/// cache lines.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(crate) struct PairsSample<const L: usize, const P: usize, const C: usize> {
    /// (N/m) Stiffness of each pair; 0 where there is none.
    pub(crate) stiffness: [Lanes<L>; P],
    /// (m) What deviations, damage and separation add to the deflection, with the damping's lead: `o + τ ȯ`, `o = e − S`.
    pub(crate) offset: [Lanes<L>; P],
    /// (-) Where the middle of what is left of its face lies along it, of teeth that tilt.
    pub(crate) place: [Lanes<L>; P],
    /// What lies outside the path, before its start and beyond its end.
    pub(crate) corners: [[CornerSample<L>; 2]; C],
}

impl<const L: usize, const P: usize, const C: usize> PairsSample<L, P, C> {
    /// No pairs.
    pub(crate) const NONE: Self = Self {
        stiffness: [Lanes([0.0; L]); P],
        offset: [Lanes([0.0; L]); P],
        place: [Lanes([0.0; L]); P],
        corners: [[CornerSample::NONE; 2]; C],
    };

    /// Lines the blocks of `L` simulations up, sample by sample: all lanes of a number lie in one line of the cache. Places that a
    /// simulation has not got hold no pair.
    pub(crate) fn line_up(samples: &mut [Self], blocks: &[&PairsBlock; L]) {
        let none = vec![0.0; samples.len()];
        for place in 0..P {
            let part = |of: fn(&PairsBlock) -> &Vec<Vec<f64>>| {
                blocks.map(|pairs| of(pairs).get(place).map_or(&none[..], Vec::as_slice))
            };
            line_up(samples, part(|pairs| &pairs.stiffness), |sample| &mut sample.stiffness[place]);
            line_up(samples, part(|pairs| &pairs.offset), |sample| &mut sample.offset[place]);
            if blocks.iter().any(|pairs| !pairs.strips.is_empty()) {
                let places = blocks.map(|pairs| pairs.strips.get(place).map_or(&none[..], |of| &of[0][..]));
                line_up(samples, places, |sample| &mut sample.place[place]);
            }
        }
        for (place, end) in (0..C).flat_map(|place| [(place, 0), (place, 1)]) {
            let part = |of: fn(&CornerBlock) -> &Vec<f64>| {
                blocks.map(|pairs| {
                    pairs.corners.get(place).map_or(&none[..], |corners| of(&corners[end]).as_slice())
                })
            };
            line_up(samples, part(|corner| &corner.offset), |sample| &mut sample.corners[place][end].offset);
            line_up(samples, part(|corner| &corner.near), |sample| &mut sample.corners[place][end].near);
            line_up(samples, part(|corner| &corner.far), |sample| &mut sample.corners[place][end].far);
        }
    }
}

/// Samples that are lined up at once: so many numbers fill a line of the cache.
const CHUNK: usize = 8;

/// Lines one number of `L` simulations up, sample by sample.
///
/// # Arguments
/// * `samples` - are given the number
/// * `parts` - the number of each simulation at these samples
/// * `set` - the place of the number in a sample
#[inline(always)]
pub(crate) fn line_up<T, const L: usize>(
    samples: &mut [T],
    parts: [&[f64]; L],
    set: impl Fn(&mut T) -> &mut Lanes<L>,
) {
    let length = parts.iter().map(|part| part.len()).min().unwrap_or(0).min(samples.len());
    let (chunks, rest) = samples[..length].as_chunks_mut::<CHUNK>();
    let whole = chunks.len() * CHUNK;
    for (c, chunk) in chunks.iter_mut().enumerate() {
        // Of fixed length, so that no index is checked within a chunk.
        let columns: [&[f64; CHUNK]; L] = std::array::from_fn(|lane| &parts[lane].as_chunks().0[c]);
        for (k, sample) in chunk.iter_mut().enumerate() {
            *set(sample) = Lanes::from_fn(|lane| columns[lane][k]);
        }
    }
    for (k, sample) in rest.iter_mut().enumerate() {
        *set(sample) = Lanes::from_fn(|lane| parts[lane][whole + k]);
    }
}

/// The springs of a mesh at one sample: pairs of teeth, or their slices, and their corners.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Springs<'a> {
    /// (N/m) Stiffness of each; 0 where there is none.
    pub(crate) stiffness: &'a [f64],
    /// (m) What deviations, damage and separation add to the deflection, with the damping's lead.
    pub(crate) offset: &'a [f64],
    /// Friction across the line of action per force of each, with the sense of its sliding, and (m) its arm beyond the pitch point times that;
    /// none without friction.
    pub(crate) sliding: [&'a [f64]; 2],
    /// What helical teeth have outside their path.
    pub(crate) corners: &'a [CornerAt],
    /// The laws of these.
    pub(crate) laws: &'a [CornerLaw],
    /// Of each law what `sliding` is of springs.
    pub(crate) sliding_of_laws: &'a [[f64; 2]],
    /// (-) Of a face that tilts, the middle of each along it, from −1 to 1, and half of its width.
    pub(crate) strips: &'a [[f64; 2]],
    /// (m) Of the same, by how much closer its flanks are at 1 than at 0 while its wheels do not tilt.
    pub(crate) closer_m: f64,
    /// (m) What is added to that of each; none where all are alike.
    pub(crate) wobble: &'a [f64],
}

/// What a mesh with two unknowns carries: all of its numbers are by the deflection D midway, and by what the tilt adds at the end of the face, T.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct TiltedLoad {
    /// (N) Force, and moment about the middle of the face over half its width.
    pub(crate) forces: [f64; 2],
    /// (N/m) Of the force by D, of the force by T and of the moment by D, and of the moment by T.
    pub(crate) slopes: [f64; 3],
    /// Friction across the line of action and its moment about the pitch point, each with its slopes by D and T; 0 without friction.
    pub(crate) friction: [[f64; 3]; 2],
}

impl TiltedLoad {
    /// Adds what a spring carries at a place.
    #[inline(always)]
    fn add(&mut self, [force, moment]: [f64; 2], slopes: [f64; 3], sliding: Option<[f64; 2]>) {
        self.forces[0] += force;
        self.forces[1] += moment;
        self.slopes.iter_mut().zip(slopes).for_each(|(sum, slope)| *sum += slope);
        for (sums, part) in self.friction.iter_mut().zip(sliding.into_iter().flatten()) {
            for (sum, number) in sums.iter_mut().zip([force, slopes[0], slopes[1]]) {
                *sum += part * number;
            }
        }
    }
}

/// (m) Lean below which a strip is as if it did not lean: no penetration is as small.
const NO_LEAN_M: f64 = 1e-40;

impl<'a> Springs<'a> {
    /// Those of frictionless flanks; arguments as the fields.
    pub(crate) fn frictionless(
        stiffness: &'a [f64],
        offset: &'a [f64],
        corners: &'a [CornerAt],
        laws: &'a [CornerLaw],
    ) -> Self {
        Self {
            stiffness,
            offset,
            sliding: [&[]; 2],
            corners,
            laws,
            sliding_of_laws: &[],
            strips: &[],
            closer_m: 0.0,
            wobble: &[],
        }
    }

    /// One of them, without corners.
    pub(crate) fn only(self, n: usize) -> Self {
        let one = |of: &'a [f64]| of.get(n..=n).unwrap_or_default();
        Self {
            stiffness: one(self.stiffness),
            offset: one(self.offset),
            sliding: self.sliding.map(one),
            wobble: one(self.wobble),
            strips: self.strips.get(n..=n).unwrap_or_default(),
            corners: &[],
            ..self
        }
    }
}

/// Springs that are summed at once.
const AT_ONCE: usize = 4;

/// The springs of a mesh at successive samples, sample by sample.
#[derive(Debug, Clone, Default)]
pub(crate) struct SpringSamples {
    /// Numbers of a sample: stiffnesses, then offsets, with friction both numbers of sliding, and the wobble of a mesh that has it, with zeros up to whole sums.
    values: Vec<f64>,
    springs: usize,
    /// How many numbers a spring has.
    per_spring: usize,
    /// Whether the last of these is [`Springs::wobble`].
    wobbles: bool,
    /// The corners that can touch, sample by sample, and where those of each sample end.
    corners: Vec<CornerAt>,
    corners_until: Vec<usize>,
    /// The laws of all corners of the mesh.
    laws: Vec<CornerLaw>,
    /// Of each law the friction of what it carries, as of [`Springs::sliding_of_laws`].
    sliding_of_laws: Vec<[f64; 2]>,
    /// (m) By how much closer its flanks are at the end of the face, where the tilt is an unknown.
    closer_m: Option<f64>,
    /// How they lie along a face that tilts, as of [`Springs`], and the same sample by sample, where it differs; empty elsewhere.
    strips: Vec<[f64; 2]>,
    strips_of_samples: Vec<[f64; 2]>,
}

impl SpringSamples {
    /// No samples of a mesh.
    ///
    /// # Arguments
    /// * `mesh` - the mesh
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let wobbles = mesh.leans_with_pairs();
        let per_spring = if mesh.has_friction() { 4 } else { 2 } + usize::from(wobbles);
        Self {
            laws: mesh.corner_laws(),
            sliding_of_laws: mesh.sliding_of_corner_laws(),
            closer_m: mesh.closer_at_end_m,
            strips: (0..mesh.springs()).map(|n| mesh.strip_of_slice(n % mesh.slices())).collect(),
            per_spring,
            wobbles,
            ..Self::default()
        }
    }

    /// Whether the mesh has corners or tilts, so that its force is smooth.
    #[inline(always)]
    pub(crate) fn is_smooth(&self) -> bool {
        !self.laws.is_empty() || self.closer_m.is_some()
    }

    /// Takes the samples of a block.
    pub(crate) fn line_up(&mut self, block: &PairsBlock) {
        let samples = block.stiffness.first().map_or(0, Vec::len);
        self.springs = block.stiffness.len().next_multiple_of(AT_ONCE);
        let stride = self.per_spring * self.springs;
        self.values.resize(samples * stride, 0.0);
        let numbers = |number: usize| number * self.springs..;
        let sliding = [0, 1].map(|number| block.sliding.iter().map(move |sliding| &sliding[number]));
        let [friction, arms] = sliding;
        let columns = numbers(0).zip(&block.stiffness).chain(numbers(1).zip(&block.offset));
        let columns = columns.chain(numbers(2).zip(friction)).chain(numbers(3).zip(arms));
        let columns = columns.chain(numbers(self.per_spring - 1).zip(&block.wobble));
        let columns: Vec<(usize, &Vec<f64>)> = columns.collect();
        // A few samples at a time, whose numbers stay in the cache.
        for (chunk, rows) in self.values.chunks_mut(CHUNK * stride).enumerate() {
            for (place, column) in &columns {
                let values = &column[chunk * CHUNK..];
                rows.chunks_exact_mut(stride).zip(values).for_each(|(row, value)| row[*place] = *value);
            }
        }
        self.strips_of_samples
            .resize(if block.strips.is_empty() { 0 } else { samples * self.springs }, [0.0; 2]);
        for (n, [places, half_widths]) in block.strips.iter().enumerate() {
            let samples = self.strips_of_samples.chunks_exact_mut(self.springs);
            samples.zip(places.iter().zip(half_widths)).for_each(|(sample, (a, b))| sample[n] = [*a, *b]);
        }
        self.line_corners_up(block, samples);
    }

    /// Takes the corners that can touch, sample by sample.
    fn line_corners_up(&mut self, block: &PairsBlock, samples: usize) {
        self.corners.clear();
        self.corners_until.clear();
        if self.laws.is_empty() {
            return;
        }
        let slices = block.corners.len() / block.classes.len().max(1);
        for sample in 0..samples {
            for (spring, ends) in block.corners.iter().enumerate() {
                for (end, corner) in ends.iter().enumerate() {
                    let at = CornerAt {
                        law: 0,
                        offset_m: corner.offset[sample],
                        near: corner.near[sample],
                        far: corner.far[sample],
                        place: corner.place.get(sample).copied().unwrap_or(0.0),
                    };
                    if at.can_touch() {
                        let class = block.class_at(spring / slices, sample);
                        let law = (class * slices + spring % slices) * 2 + end;
                        self.corners.push(CornerAt { law: law as u32, ..at });
                    }
                }
            }
            self.corners_until.push(self.corners.len());
        }
    }

    /// The springs at a sample.
    #[inline(always)]
    pub(crate) fn at(&self, sample: usize) -> Springs<'_> {
        let stride = self.per_spring * self.springs;
        let numbers = &self.values[sample * stride..(sample + 1) * stride];
        let part = |number: usize| &numbers[number * self.springs..(number + 1) * self.springs];
        let sliding = if self.per_spring > 3 { [part(2), part(3)] } else { [&[][..]; 2] };
        let until = |sample: usize| self.corners_until.get(sample).copied().unwrap_or(0);
        let from = sample.checked_sub(1).map_or(0, until);
        Springs {
            stiffness: part(0),
            offset: part(1),
            sliding,
            corners: &self.corners[from..until(sample)],
            laws: &self.laws,
            sliding_of_laws: &self.sliding_of_laws,
            strips: self
                .strips_of_samples
                .get(sample * self.springs..(sample + 1) * self.springs)
                .filter(|strips| !strips.is_empty())
                .unwrap_or(&self.strips),
            closer_m: self.closer_m.unwrap_or(0.0),
            wobble: if self.wobbles { part(self.per_spring - 1) } else { &[] },
        }
    }
}

/// The law of a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshLaw {
    /// How its flanks touch.
    pub contact: Contact,
    /// (s) τ, the contact's damping over its stiffness.
    pub damping_time_s: f64,
    /// (N/m) Stiffness of coast flanks in contact.
    pub back_stiffness_n_per_m: f64,
    /// (m) Normal backlash; none where coast flanks are out of reach.
    pub backlash_m: Option<f64>,
}

/// (m) A backlash that no deflection reaches. It is finite, so that products with 0 stay numbers.
const OUT_OF_REACH_M: f64 = 1e9;

impl MeshLaw {
    /// (m) Deflection at which the coast flanks touch, `−j`.
    fn back_touches_at_m(&self) -> f64 {
        -self.backlash_m.unwrap_or(OUT_OF_REACH_M)
    }

    /// (N/m) A stiffness that no pairs of the mesh reach together: there is at most one more of them than in the mean.
    pub(crate) fn most_stiffness_n_per_m(&self) -> f64 {
        2.0 * self.back_stiffness_n_per_m
    }

    /// (N, N/m) The force that the flanks carry at a deflection, and its slope, without friction.
    ///
    /// # Arguments
    /// * `springs` - stiffness and offset of each
    /// * `deflection_m` - (m) D
    #[inline(always)]
    pub(crate) fn force_and_slope(&self, springs: Springs, deflection_m: f64) -> [f64; 2] {
        self.load(springs, [], deflection_m).0
    }

    /// (N, N/m) The force that the flanks carry at a deflection, and the friction of the drive flanks: across the line of action, and (N m, N) its moment
    /// about the pitch point; each with its slope. Coast flanks slide without friction.
    ///
    /// # Arguments
    /// * `springs` - of the mesh; without friction of its own beside meshes that have some, its friction is 0
    /// * `deflection_m` - (m) D
    #[inline(always)]
    pub(crate) fn force_and_friction(
        &self,
        springs: Springs,
        deflection_m: f64,
    ) -> ([f64; 2], [[f64; 2]; 2]) {
        if springs.sliding[0].is_empty() {
            return (self.force_and_slope(springs, deflection_m), [[0.0; 2]; 2]);
        }
        self.load(springs, springs.sliding, deflection_m)
    }

    /// The force at a deflection, and what `P` of the numbers of sliding make of the force of each spring; each with its slope.
    ///
    /// The springs are summed in as many sums as fit side by side, so that the compiler can take several of them at once.
    #[inline(always)]
    fn load<const P: usize>(
        &self,
        springs: Springs,
        sliding: [&[f64]; P],
        deflection_m: f64,
    ) -> ([f64; 2], [[f64; 2]; P]) {
        let lets_go_m = self.contact.lets_go_at_m();
        let mut by_place = [[0.0; AT_ONCE]; 2];
        let mut sliding_by_place = [[[0.0; AT_ONCE]; 2]; P];
        let mut add = |n: usize, [stiffness, offset]: [f64; 2], parts: [f64; P]| {
            let penetration_m = deflection_m + offset;
            let touching = if penetration_m > lets_go_m { stiffness } else { 0.0 };
            let load = [touching * penetration_m, touching];
            for k in 0..2 {
                by_place[k][n] += load[k];
                sliding_by_place.iter_mut().zip(parts).for_each(|(sums, part)| sums[k][n] += load[k] * part);
            }
        };
        let (stiffness, of_rest) = springs.stiffness.as_chunks::<AT_ONCE>();
        let (offset, offset_of_rest) = springs.offset.as_chunks::<AT_ONCE>();
        let whole = sliding.map(|of| of.as_chunks::<AT_ONCE>().0);
        for (chunk, (stiffness, offset)) in stiffness.iter().zip(offset).enumerate() {
            let parts = whole.map(|of| of[chunk]);
            for n in 0..AT_ONCE {
                add(n, [stiffness[n], offset[n]], parts.map(|of| of[n]));
            }
        }
        // Springs with friction fit whole sums: see [`SpringSamples`].
        for (stiffness, offset) in of_rest.iter().zip(offset_of_rest) {
            add(0, [*stiffness, *offset], [0.0; P]);
        }
        let total = |[a, b, c, d]: [f64; AT_ONCE]| (a + b) + (c + d);
        let [mut force, mut slope] = by_place.map(total);
        let mut friction = sliding_by_place.map(|sums| sums.map(total));
        for corner in springs.corners {
            let of_corner = corner.force_and_slope(springs.laws, deflection_m);
            force += of_corner[0];
            slope += of_corner[1];
            for (p, sums) in friction.iter_mut().enumerate() {
                let part = springs.sliding_of_laws[corner.law as usize][p];
                sums.iter_mut().zip(of_corner).for_each(|(sum, of_corner)| *sum += of_corner * part);
            }
        }
        let back_m = self.back_touches_at_m() - deflection_m;
        let back = if back_m > 0.0 { self.back_stiffness_n_per_m } else { 0.0 };
        ([force - back * back_m.max(0.0), slope + back], friction)
    }

    /// What a mesh with two unknowns carries.
    ///
    /// A strip of half width w about ζ, with x midway, leans by `(T + c) w` towards its ends: of it the part `a = ½ + x/(2 (T + c) w)`, at least 0
    /// and at most 1, carries, about a place that lies `(1 − a) w` nearer to the end that is pressed more. What carries has the force of its middle, and
    /// about that the moment of inertia `(2 a w)²/12`.
    ///
    /// # Arguments
    /// * `springs` - with their strips
    /// * `deflection_m` - (m) D and T
    #[inline(always)]
    pub(crate) fn tilted(&self, springs: Springs, [deflection_m, tilt_m]: [f64; 2]) -> TiltedLoad {
        let mut sums = TiltedLoad::default();
        let rubs = !springs.sliding[0].is_empty();
        let each = springs.stiffness.iter().zip(springs.offset).zip(springs.strips).enumerate();
        for (n, ((stiffness, offset), [middle, half_width])) in each {
            let lean_m = tilt_m + springs.closer_m + springs.wobble.get(n).copied().unwrap_or(0.0);
            let per_m = 0.5 / (lean_m.abs() * half_width).max(NO_LEAN_M);
            let middle_m = deflection_m + offset + middle * lean_m;
            let part = (0.5 + middle_m * per_m).clamp(0.0, 1.0);
            let beside = (1.0 - part) * half_width.copysign(lean_m);
            let (place, carries) = (middle + beside, stiffness * part);
            let force = carries * (middle_m + beside * lean_m);
            let spread = carries * (part * part * half_width * half_width / 3.0);
            let moment = place * force + spread * lean_m;
            let slopes = [carries, carries * place, carries * place * place + spread];
            let sliding = rubs.then(|| [springs.sliding[0][n], springs.sliding[1][n]]);
            sums.add([force, moment], slopes, sliding);
        }
        for corner in springs.corners {
            // It reaches over so little of the face that it has the deflection of one place.
            let (place, lean_m) = (corner.place, tilt_m + springs.closer_m);
            let [force, slope] = corner.force_and_slope(springs.laws, deflection_m + place * lean_m);
            let sliding = rubs.then(|| springs.sliding_of_laws[corner.law as usize]);
            sums.add([force, place * force], [slope, place * slope, place * place * slope], sliding);
        }
        let back_m = self.back_touches_at_m() - deflection_m;
        if back_m > 0.0 {
            sums.forces[0] -= self.back_stiffness_n_per_m * back_m;
            sums.slopes[0] += self.back_stiffness_n_per_m;
        }
        sums
    }

    /// (m) D at which a mesh with two unknowns carries a force at rest.
    ///
    /// # Arguments
    /// * `springs` - with their strips
    /// * `tilt_m` - (m) T
    /// * `force_n` - (N) the force; where it is 0, the deflection is one at which nothing touches
    pub(crate) fn tilted_at_rest(&self, springs: Springs, tilt_m: f64, force_n: f64) -> f64 {
        let carried = |deflection_m: f64| self.tilted(springs, [deflection_m, tilt_m]);
        let (mut low_m, mut high_m) = (0.0, FIRST_PRESSED_M);
        while carried(high_m).forces[0] < force_n && high_m < 1.0 {
            high_m *= 2.0;
        }
        while carried(low_m).forces[0] > 0.0 && low_m > -1.0 {
            low_m -= high_m;
        }
        // The force is convex from where it begins: Newton's steps come down, and halves are there for rounding.
        let mut at_m = high_m;
        for _ in 0..MOST_SMOOTH_ITERATIONS {
            let load = carried(at_m);
            let step_m = (force_n - load.forces[0]) / load.slopes[0].max(f64::MIN_POSITIVE);
            let next_m = at_m + step_m;
            let next_m = if next_m > low_m { next_m } else { (low_m + at_m) / 2.0 };
            if (next_m - at_m).abs() <= 1e-15 * at_m.abs() {
                break;
            }
            at_m = next_m;
        }
        at_m
    }
}

/// The laws of one mesh in each of `L` simulations side by side.
pub(crate) struct LawLanes<const L: usize> {
    /// (N) Mesh force under the constant loads, which the forces on the modes are relative to.
    static_force: Lanes<L>,
    back_stiffness: Lanes<L>,
    back_touches: Lanes<L>,
    /// (m) Penetration below which a pair carries nothing.
    lets_go: Lanes<L>,
    /// (m) By how much closer the flanks of wheels that do not tilt are at the end of the face than midway; nothing of a mesh with one unknown.
    closer: [Option<f64>; L],
}

impl<const L: usize> LawLanes<L> {
    /// Lines the laws of `L` simulations up.
    ///
    /// # Arguments
    /// * `laws` - of each
    /// * `static_force_n` - (N) mesh force of each under the constant loads
    /// * `closer_m` - (m) of each mesh with two unknowns, by how much closer its flanks are at the end of the face than midway
    pub(crate) fn new(laws: [MeshLaw; L], static_force_n: [f64; L], closer_m: [Option<f64>; L]) -> Self {
        Self {
            static_force: Lanes(static_force_n),
            back_stiffness: Lanes::from_fn(|l| laws[l].back_stiffness_n_per_m),
            back_touches: Lanes::from_fn(|l| laws[l].back_touches_at_m()),
            lets_go: Lanes::from_fn(|l| laws[l].contact.lets_go_at_m()),
            closer: closer_m,
        }
    }

    /// (N) The mesh's force on the modes at the end of a step, relative to the static one: the whole force, and where R is 2 its moment
    /// about the middle of the face over half its width.
    ///
    /// The equation is solved for the drive flanks first; only where D would reach the coast flanks, which is rare, they are added
    /// and the equation is solved again.
    ///
    /// # Arguments
    /// * `free` - (m) each unknown with its damping's lead at the step's end, without the new force
    /// * `compliance` - (m/N) the same per new force in each
    /// * `sample` - the pairs at the step's end
    /// * `corners` - their laws
    /// * `last` - what touched at the step's start; set to what does at its end
    #[inline(always)]
    pub(crate) fn force<I: Instructions, const R: usize, const P: usize, const C: usize>(
        &self,
        simd: I,
        free: &[Lanes<L>; R],
        compliance: &[[Lanes<L>; R]; R],
        sample: &PairsSample<L, P, C>,
        corners: &CornerLanes<L, C>,
        last: &mut LastContact<L>,
    ) -> [Lanes<L>; R] {
        if C > 0 {
            let mut result = [Lanes::splat(0.0); R];
            result[0] = self.smooth_force(simd, free[0], compliance[0][0], sample, corners, last);
            return result;
        }
        if R > 1 && self.closer != [None; L] {
            let tilted = self.tilted_force(simd, free, compliance, sample, last);
            if self.closer.iter().any(Option::is_none) {
                // Side by side with others that have one unknown.
                let mut result = [Lanes::splat(0.0); R];
                result[0] = self.touching_force(simd, free[0], compliance[0][0], sample, &mut last.touching);
                for l in (0..L).filter(|l| self.closer[*l].is_some()) {
                    for r in 0..R {
                        result[r].0[l] = tilted[r].0[l];
                    }
                }
                return result;
            }
            return tilted;
        }
        let mut result = [Lanes::splat(0.0); R];
        result[0] = self.touching_force(simd, free[0], compliance[0][0], sample, &mut last.touching);
        result
    }

    /// (N) The force of a mesh of spur teeth with one unknown, relative to the static one.
    #[inline(always)]
    fn touching_force<I: Instructions, const P: usize, const C: usize>(
        &self,
        simd: I,
        free: Lanes<L>,
        compliance: Lanes<L>,
        sample: &PairsSample<L, P, C>,
        touching: &mut Touching<L>,
    ) -> Lanes<L> {
        let load = compliance.mul_add(simd, self.static_force, free);
        let one = Lanes::splat(1.0);
        let before = *touching;
        let (mut deflection, mut sums) = self.solve(simd, sample, [compliance, one, load], touching);
        let zero = Lanes::splat(0.0);
        let mut back = zero;
        let mut is_back = false;
        for l in 0..L {
            is_back |= deflection.0[l] < self.back_touches.0[l];
        }
        if is_back {
            let stiffness = self.back_stiffness.where_less(simd, deflection, self.back_touches, zero);
            let pushed = compliance.mul(simd, stiffness);
            let own = one.add(simd, pushed);
            let loaded = pushed.mul_add(simd, self.back_touches, load);
            // Where no coast flank touches the solution is found again, from the same pairs on.
            *touching = before;
            (deflection, sums) = self.solve(simd, sample, [compliance, own, loaded], touching);
            back = stiffness.mul(simd, self.back_touches.sub(simd, deflection));
        }
        let force = sums[0].mul_add(simd, deflection, sums[1]).sub(simd, back);
        self.static_force.sub(simd, force)
    }

    /// (N) Force and moment of a mesh of spur teeth whose tilt is an unknown, by Newton's method as of [`Self::smooth_force`].
    #[inline(always)]
    fn tilted_force<I: Instructions, const R: usize, const P: usize, const C: usize>(
        &self,
        simd: I,
        free: &[Lanes<L>; R],
        compliance: &[[Lanes<L>; R]; R],
        sample: &PairsSample<L, P, C>,
        last: &mut LastContact<L>,
    ) -> [Lanes<L>; R] {
        let [[a, b], [c, d]] = [0, 1].map(|row: usize| [0, 1].map(|column: usize| compliance[row][column]));
        let loads =
            [a.mul_add(simd, self.static_force, free[0]), c.mul_add(simd, self.static_force, free[1])];
        let mut closer = [0.0; L];
        for l in 0..L {
            closer[l] = self.closer[l].unwrap_or(0.0);
        }
        let one = Lanes::splat(1.0);
        let [mut deflection, mut tilt] = [last.deflection, last.tilt];
        let [mut force, mut moment] = [Lanes::splat(0.0); 2];
        let mut is_found = [false; L];
        for _ in 0..MOST_SMOOTH_ITERATIONS {
            let ([force_now, moment_now], [whole, cross, of_tilt]) =
                self.tilted(simd, sample, closer, [deflection, tilt]);
            let pushed = a.mul(simd, force_now).add(simd, b.mul(simd, moment_now));
            let turned = c.mul(simd, force_now).add(simd, d.mul(simd, moment_now));
            let residuals = [
                loads[0].sub(simd, deflection).sub(simd, pushed),
                loads[1].sub(simd, tilt).sub(simd, turned),
            ];
            let jacobian = [
                a.mul_add(simd, whole, b.mul_add(simd, cross, one)),
                a.mul(simd, cross).add(simd, b.mul(simd, of_tilt)),
                c.mul(simd, whole).add(simd, d.mul(simd, cross)),
                c.mul_add(simd, cross, d.mul_add(simd, of_tilt, one)),
            ];
            let determinant =
                jacobian[1].negative_mul_add(simd, jacobian[2], jacobian[0].mul(simd, jacobian[3]));
            let step = [
                jacobian[1].negative_mul_add(simd, residuals[1], jacobian[3].mul(simd, residuals[0])),
                jacobian[2].negative_mul_add(simd, residuals[0], jacobian[0].mul(simd, residuals[1])),
            ];
            let step = [step[0].div(simd, determinant), step[1].div(simd, determinant)];
            let next = [deflection.add(simd, step[0]), tilt.add(simd, step[1])];
            let ahead = [
                whole.mul_add(simd, step[0], cross.mul_add(simd, step[1], force_now)),
                cross.mul_add(simd, step[0], of_tilt.mul_add(simd, step[1], moment_now)),
            ];
            let mut all_found = true;
            for l in 0..L {
                if !is_found[l] {
                    (deflection.0[l], tilt.0[l]) = (next[0].0[l], next[1].0[l]);
                    (force.0[l], moment.0[l]) = (ahead[0].0[l], ahead[1].0[l]);
                    let most = TANGENT_PART * next[0].0[l].abs() + TANGENT_M;
                    is_found[l] = step[0].0[l].abs() <= most && step[1].0[l].abs() <= most;
                }
                all_found &= is_found[l];
            }
            if all_found {
                break;
            }
        }
        (last.deflection, last.tilt) = (deflection, tilt);
        let mut result = [moment.neg(simd); R];
        result[0] = self.static_force.sub(simd, force);
        result
    }

    /// Force and moment of spur teeth on what is left of their faces, and their slopes, as of [`MeshLaw::tilted`].
    #[inline(always)]
    fn tilted<I: Instructions, const P: usize, const C: usize>(
        &self,
        simd: I,
        sample: &PairsSample<L, P, C>,
        closer: [f64; L],
        [deflection, tilt]: [Lanes<L>; 2],
    ) -> ([Lanes<L>; 2], [Lanes<L>; 3]) {
        let [zero, half, one] = [0.0, 0.5, 1.0].map(Lanes::splat);
        let lean = tilt.add(simd, Lanes(closer));
        let size = lean.max(simd, lean.neg(simd));
        let pressed_end = Lanes::splat(-1.0).where_less(simd, lean, zero, one);
        let ([mut force, mut moment], [mut whole, mut cross, mut of_tilt]) = ([zero; 2], [zero; 3]);
        for n in 0..P {
            let of_left = sample.place[n];
            let half_width = one.sub(simd, of_left.max(simd, of_left.neg(simd)));
            let per_m = half.div(simd, size.mul(simd, half_width).max(simd, Lanes::splat(NO_LEAN_M)));
            let middle = of_left.mul_add(simd, lean, deflection.add(simd, sample.offset[n]));
            let part = middle.mul_add(simd, per_m, half).max(simd, zero).min(simd, one);
            let beside = one.sub(simd, part).mul(simd, pressed_end).mul(simd, half_width);
            let place = of_left.add(simd, beside);
            let carries = sample.stiffness[n].mul(simd, part);
            let own = carries.mul(simd, beside.mul_add(simd, lean, middle));
            let reach = part.mul(simd, half_width);
            let spread = carries.mul(simd, reach.mul(simd, reach).mul(simd, Lanes::splat(1.0 / 3.0)));
            let turned = carries.mul(simd, place);
            force = force.add(simd, own);
            moment = place.mul_add(simd, own, spread.mul_add(simd, lean, moment));
            whole = whole.add(simd, carries);
            cross = cross.add(simd, turned);
            of_tilt = turned.mul_add(simd, place, spread.add(simd, of_tilt));
        }
        let back = self.back_stiffness.where_less(simd, deflection, self.back_touches, zero);
        let pressed = deflection.sub(simd, self.back_touches);
        ([back.mul_add(simd, pressed, force), moment], [whole.add(simd, back), cross, of_tilt])
    }

    /// (N) The force of a mesh of teeth with corners, relative to the static one.
    ///
    /// Newton's method begins at the last step's deflection, from where it mostly takes two iterations. The last evaluation is spared: once
    /// an iterate has moved by less than a ten-millionth, the force goes on along the tangent, which is wrong by the square of that. A
    /// simulation that has come so far stays as it is while others side by side go on, so that their number changes nothing.
    #[inline(always)]
    fn smooth_force<I: Instructions, const P: usize, const C: usize>(
        &self,
        simd: I,
        free: Lanes<L>,
        compliance: Lanes<L>,
        sample: &PairsSample<L, P, C>,
        corners: &CornerLanes<L, C>,
        last: &mut LastContact<L>,
    ) -> Lanes<L> {
        let load = compliance.mul_add(simd, self.static_force, free);
        let mut deflection = last.deflection;
        let mut force = Lanes::splat(0.0);
        let mut is_found = [false; L];
        for _ in 0..MOST_SMOOTH_ITERATIONS {
            let [now, slope] = self.force_and_slope(simd, sample, corners, deflection);
            let residual = load.sub(simd, deflection).sub(simd, compliance.mul(simd, now));
            let step = residual.div(simd, compliance.mul_add(simd, slope, Lanes::splat(1.0)));
            let next = deflection.add(simd, step);
            let ahead = slope.mul_add(simd, step, now);
            let mut all_found = true;
            for l in 0..L {
                if !is_found[l] {
                    (deflection.0[l], force.0[l]) = (next.0[l], ahead.0[l]);
                    is_found[l] = step.0[l].abs() <= TANGENT_PART * next.0[l].abs() + TANGENT_M;
                }
                all_found &= is_found[l];
            }
            if all_found {
                break;
            }
        }
        last.deflection = deflection;
        self.static_force.sub(simd, force)
    }

    /// (N, N/m) The force of teeth with corners at a deflection, and its slope.
    #[inline(always)]
    fn force_and_slope<I: Instructions, const P: usize, const C: usize>(
        &self,
        simd: I,
        sample: &PairsSample<L, P, C>,
        corners: &CornerLanes<L, C>,
        deflection: Lanes<L>,
    ) -> [Lanes<L>; 2] {
        let zero = Lanes::splat(0.0);
        let [mut force, mut slope] = [zero; 2];
        for n in 0..P {
            let penetration = deflection.add(simd, sample.offset[n]);
            let stiffness = sample.stiffness[n].where_less(simd, self.lets_go, penetration, zero);
            force = stiffness.mul_add(simd, penetration, force);
            slope = slope.add(simd, stiffness);
        }
        for (corner, law) in sample.corners.iter().flatten().zip(corners.iter().flatten()) {
            let [of_corner, slope_of_corner] = corner.force_and_slope(simd, law, deflection);
            force = force.add(simd, of_corner);
            slope = slope.add(simd, slope_of_corner);
        }
        let back = self.back_stiffness.where_less(simd, deflection, self.back_touches, zero);
        let pressed = deflection.sub(simd, self.back_touches);
        [back.mul_add(simd, pressed, force), slope.add(simd, back)]
    }

    /// Solves `a D + Γ Σ k (D + o) = b` over the pairs that touch at D.
    ///
    /// Begins with the pairs that touched in the step before, which mostly are those of this one: then only `b` waits for that
    /// step's force, and the division does not. Whichever pairs it begins with, no others together push harder than those that touch,
    /// so that the first iterate does not lie below the solution, and the method comes down to it.
    ///
    /// # Arguments
    /// * `sample`, `compliance`, `own`, `load` - the pairs, Γ, a and b
    /// * `touching` - the pairs that may touch; set to those that do
    #[inline(always)]
    fn solve<I: Instructions, const P: usize, const C: usize>(
        &self,
        simd: I,
        sample: &PairsSample<L, P, C>,
        [compliance, own, load]: [Lanes<L>; 3],
        touching: &mut Touching<L>,
    ) -> (Lanes<L>, [Lanes<L>; 2]) {
        let mut sums = sums_over(simd, sample, touching);
        let mut deflection = load;
        // Pairs can leave one after the other, and one iteration sees that none does.
        for _ in 0..P + 2 {
            let share = Lanes::splat(1.0).div(simd, compliance.mul_add(simd, sums[0], own));
            deflection = compliance.negative_mul_add(simd, sums[1], load).mul(simd, share);
            let now = self.touching_at(simd, sample, deflection);
            // All lanes are compared, without a branch for each.
            let mut changed = false;
            for l in 0..L {
                changed |= now[l] != touching[l];
            }
            if !changed {
                break;
            }
            *touching = now;
            sums = sums_over(simd, sample, touching);
        }
        (deflection, sums)
    }

    /// The pairs that touch at a deflection.
    #[inline(always)]
    fn touching_at<I: Instructions, const P: usize, const C: usize>(
        &self,
        simd: I,
        sample: &PairsSample<L, P, C>,
        deflection: Lanes<L>,
    ) -> Touching<L> {
        let mut touching = [0; L];
        for n in 0..P {
            let penetration = deflection.add(simd, sample.offset[n]);
            for l in 0..L {
                touching[l] |= usize::from(penetration.0[l] > self.lets_go.0[l]) << n;
            }
        }
        touching
    }
}

/// Which pairs touch, of each simulation: a bit for each place.
type Touching<const L: usize> = [usize; L];

/// Where a step begins its search.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(crate) struct LastContact<const L: usize> {
    /// (m) D at the last step, of teeth with corners or whose wheels tilt, and T of the latter.
    deflection: Lanes<L>,
    tilt: Lanes<L>,
    /// The pairs that touched, of teeth without.
    touching: Touching<L>,
}

impl<const L: usize> LastContact<L> {
    /// Before the first step.
    pub(crate) const fn none() -> Self {
        Self { deflection: Lanes([0.0; L]), tilt: Lanes([0.0; L]), touching: [0; L] }
    }
}

/// Most of Newton's iterations of a smooth, rising law, which has needed 5 at most.
const MOST_SMOOTH_ITERATIONS: usize = 30;
/// (-, m) Move of an iterate, by the deflection and beside it, within which the tangent of a smooth law is the law.
pub(crate) const TANGENT_PART: f64 = 1e-7;
pub(crate) const TANGENT_M: f64 = 1e-16;

/// Sums over pairs: of k, and of k times the offset.
#[inline(always)]
fn sums_over<I: Instructions, const L: usize, const P: usize, const C: usize>(
    simd: I,
    sample: &PairsSample<L, P, C>,
    touching: &Touching<L>,
) -> [Lanes<L>; 2] {
    let zero = Lanes::splat(0.0);
    let mut sums = [zero; 2];
    for n in 0..P {
        let mut stiffness = zero;
        for l in 0..L {
            // All bits or none: unlike a choice it compiles to no branch.
            let touches = ((touching[l] >> n & 1) as u64).wrapping_neg();
            stiffness.0[l] = f64::from_bits(sample.stiffness[n].0[l].to_bits() & touches);
        }
        sums[0] = sums[0].add(simd, stiffness);
        sums[1] = stiffness.mul_add(simd, sample.offset[n], sums[1]);
    }
    sums
}

/// (m) Deflection at which some springs and corners carry a force at rest. Where it is 0, the one at which the first would touch.
///
/// Those without corners in the order in which they touch, then on from there: with corners the force is larger, and convex, so that Newton's
/// method comes down to the solution.
///
/// # Arguments
/// * `contact` - how the flanks touch
/// * `springs` - stiffness and offset of each, and the corners
/// * `force_n` - (N) the force, 0 or more
pub(crate) fn deflection_at_rest(contact: Contact, springs: Springs, force_n: f64) -> f64 {
    let numbers =
        springs.stiffness.iter().zip(springs.offset).map(|(&stiffness, &offset)| [stiffness, offset]);
    let mut ordered: Vec<[f64; 2]> = numbers.filter(|[stiffness, _]| *stiffness > 0.0).collect();
    // The one that touches first has the largest offset.
    ordered.sort_by(|a, b| b[1].total_cmp(&a[1]));
    let (mut stiffness, mut load) = (0.0, force_n);
    let mut deflection = ordered.first().map(|[_, offset]| -offset);
    for [k, offset] in ordered {
        if let Some(so_far) = deflection.filter(|_| stiffness > 0.0)
            && !contact.touches(so_far + offset)
        {
            break;
        }
        stiffness += k;
        load -= k * offset;
        deflection = Some(load / stiffness);
    }
    let touches_at = |corner: &CornerAt| corner.near.max(0.0).powi(2) - corner.offset_m;
    let Some(first) = springs.corners.iter().map(touches_at).reduce(f64::min) else {
        return deflection.unwrap_or(0.0);
    };
    if force_n <= 0.0 {
        return deflection.map_or(first, |deflection| deflection.min(first));
    }
    let law = MeshLaw { contact, damping_time_s: 0.0, back_stiffness_n_per_m: 0.0, backlash_m: None };
    // Where nothing is on its path a deflection that is too large is found first.
    let mut pressed_m = FIRST_PRESSED_M;
    let mut at = deflection.unwrap_or(first);
    while law.force_and_slope(springs, at)[0] < force_n && deflection.is_none() && pressed_m < 1.0 {
        (at, pressed_m) = (first + pressed_m, 2.0 * pressed_m);
    }
    for _ in 0..MOST_SMOOTH_ITERATIONS {
        let [carried_n, slope] = law.force_and_slope(springs, at);
        let step = (force_n - carried_n) / slope.max(f64::MIN_POSITIVE);
        at += step;
        if step.abs() <= 1e-15 * at.abs() {
            break;
        }
    }
    at
}

/// (m) Where a deflection that is too large is sought at first.
const FIRST_PRESSED_M: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::PAIRS;
    use crate::simd::{Dispatch, InstructionSet, Task};

    /// Flanks that push, without damping and with coast flanks out of reach.
    const UNDAMPED: MeshLaw = MeshLaw {
        contact: Contact::Unilateral,
        damping_time_s: 0.0,
        back_stiffness_n_per_m: 0.0,
        backlash_m: None,
    };

    /// One mass behind a law, `ẍ + 2ζẋ + force = load`, stepped by Newmark's method (γ = ½, β = ¼).
    struct Oscillator<F> {
        damping_ratio: f64,
        half_step: f64,
        steps: usize,
        /// Stiffness, offset and load at each time.
        at: F,
        law: MeshLaw,
    }

    impl<F: Fn(f64) -> ([f64; PAIRS], [f64; PAIRS], f64)> Task for Oscillator<F> {
        /// Displacement and acceleration.
        type Output = Vec<[f64; 2]>;

        #[inline(always)]
        fn run<I: Instructions>(self, simd: I) -> Vec<[f64; 2]> {
            let h = self.half_step;
            let law = LawLanes::<1>::new([self.law], [0.0], [None]);
            let e = 1.0 / (1.0 + 2.0 * self.damping_ratio * h);
            let ([mut x, mut s, mut w], mut load) = ([0.0; 3], (self.at)(0.0).2);
            let mut states = Vec::with_capacity(self.steps);
            for step in 1..=self.steps {
                let (stiffness, offset, now) = (self.at)(step as f64 * 2.0 * h);
                let sample = sample(stiffness, offset);
                let change = 2.0 * e * s + h * h * e * (w + load + now);
                let (free, compliance) = ([Lanes([x + change])], [[Lanes([h * h * e])]]);
                let [Lanes([new])] =
                    law.force(simd, &free, &compliance, &sample, &[], &mut LastContact::none());
                let change = change + h * h * e * new;
                (x, s, w, load) = (x + change, change - s, new, now);
                states.push([x, new + now - 2.0 * self.damping_ratio * s / h]);
            }
            states
        }
    }

    /// The oscillator of Kahraman and Singh, Journal of Sound and Vibration 142 (1990), with three harmonics of stiffness and
    /// error. The numbers are of an 8th-order Runge-Kutta solution at a tolerance of 1e-10.
    #[test]
    fn backlash_oscillator_as_solved_by_runge_kutta() {
        let omega = 0.5;
        let at = |t: f64| {
            let stiffness = 1.0
                - 0.2 * (omega * t).cos()
                - 0.1 * (2.0 * omega * t).cos()
                - 0.05 * (3.0 * omega * t).cos();
            let errors = [0.01, 0.004, 0.002].iter().zip(1..).map(|(force, j)| {
                let omega = f64::from(j) * omega;
                force * omega * omega * (omega * t).cos()
            });
            ([stiffness, 0.0, 0.0], [-1.0, 0.0, 0.0], 0.1 + errors.sum::<f64>())
        };
        let period = std::f64::consts::TAU / omega;
        let per_period = 20_000;
        let oscillator = Oscillator {
            damping_ratio: 0.05,
            half_step: period / per_period as f64 / 2.0,
            steps: 61 * per_period,
            at,
            law: MeshLaw { backlash_m: Some(1.0), back_stiffness_n_per_m: 1.0, ..UNDAMPED },
        };
        let states = InstructionSet::in_use().run(oscillator);
        let last = &states[60 * per_period..];
        let mean = |of: &dyn Fn(&[f64; 2]) -> f64| last.iter().map(of).sum::<f64>() / last.len() as f64;
        let centre = mean(&|state| state[0]);
        let rms = mean(&|state| (state[0] - centre).powi(2)).sqrt();
        let acceleration = mean(&|state| state[1] * state[1]).sqrt();
        let least = last.iter().map(|state| state[0]).fold(f64::INFINITY, f64::min);
        let most = last.iter().map(|state| state[0]).fold(f64::NEG_INFINITY, f64::max);
        for (found, expected) in [
            (centre, 1.092_863),
            (rms, 0.090_334),
            (least, 0.951_038),
            (most, 1.242_393),
            (acceleration, 0.089_211),
        ] {
            assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
        }
    }

    /// A mass thrown between both flanks, without damping: its energy stays.
    #[test]
    fn back_flanks_push_back() {
        let oscillator = |half_step: f64, steps: usize| Oscillator {
            damping_ratio: 0.0,
            half_step,
            steps,
            // A push to start with.
            at: |t: f64| ([100.0, 0.0, 0.0], [0.0; PAIRS], if t < 0.1 { -1.0 } else { 0.0 }),
            law: MeshLaw { backlash_m: Some(0.5), back_stiffness_n_per_m: 100.0, ..UNDAMPED },
        };
        let states = InstructionSet::in_use().run(oscillator(5e-4, 40_000));
        let (least, most) = states.iter().fold((0.0f64, 0.0f64), |(a, b), s| (a.min(s[0]), b.max(s[0])));
        // Speed 0.1 behind stiffness 100: 0.01 deep on either side.
        assert!((least + 0.51).abs() < 2e-4 && (most - 0.01).abs() < 2e-4, "{least} {most}");
    }

    fn sample(stiffness: [f64; PAIRS], offset: [f64; PAIRS]) -> PairsSample<1, PAIRS, 0> {
        PairsSample {
            stiffness: stiffness.map(Lanes::splat),
            offset: offset.map(Lanes::splat),
            ..PairsSample::NONE
        }
    }

    /// How the slices of three pairs lie along a face.
    fn strips(slices: usize) -> Vec<[f64; 2]> {
        let place = |n: usize| (2.0 * (n % slices) as f64 + 1.0) / slices as f64 - 1.0;
        (0..3 * slices).map(|n| [place(n), 1.0 / slices as f64]).collect()
    }

    /// Force and moment are those of many small springs, their slopes their derivatives, and these symmetric, whatever part of the face bears.
    #[test]
    fn a_face_that_leans_is_as_its_springs() {
        const SPRINGS: usize = 4000;
        let (stiffness, offset) = ([2e8, 1.5e8, 1e8], [0.5e-6, -1e-6, -4e-6]);
        let numbers = |slices: usize| -> [Vec<f64>; 2] {
            let each =
                |of: [f64; 3], share: f64| of.into_iter().flat_map(|x| vec![x * share; slices]).collect();
            [each(stiffness, 1.0 / slices as f64), each(offset, 1.0)]
        };
        for [d, t] in
            [[3e-6, 1e-6], [1e-6, 4e-6], [-1e-6, -6e-6], [2e-6, 0.0], [-3e-6, 1e-6], [0.4e-6, -9e-6]]
        {
            for (slices, closer_m) in [(1, 0.0), (1, 2e-6), (5, -1e-6)] {
                let ([stiffness, offset], strips) = (numbers(slices), strips(slices));
                let springs = Springs {
                    strips: &strips,
                    closer_m,
                    ..Springs::frictionless(&stiffness, &offset, &[], &[])
                };
                let load = |d: f64, t: f64| UNDAMPED.tilted(springs, [d, t]);
                let found = load(d, t);
                let mut sums = [0.0; 2];
                for (k, o) in [2e8, 1.5e8, 1e8].into_iter().zip([0.5e-6, -1e-6, -4e-6]) {
                    for n in 0..SPRINGS {
                        let place = (2.0 * n as f64 + 1.0) / SPRINGS as f64 - 1.0;
                        let force = k / SPRINGS as f64 * f64::max(0.0, d + o + place * (t + closer_m));
                        sums = [sums[0] + force, sums[1] + place * force];
                    }
                }
                for (found, sum) in found.forces.into_iter().zip(sums) {
                    assert!((found - sum).abs() < 1e-5 * (1.0 + sums[0]), "{slices} {d} {t}: {found} {sum}");
                }
                let h = 1e-11;
                let [plus, minus] = [1.0, -1.0].map(|side| [load(d + side * h, t), load(d, t + side * h)]);
                for (by, [of_force, of_moment]) in [[0, 1], [1, 2]].into_iter().enumerate() {
                    for (row, slope) in [of_force, of_moment].into_iter().enumerate() {
                        let change = (plus[by].forces[row] - minus[by].forces[row]) / (2.0 * h);
                        let slope = found.slopes[slope];
                        assert!((change - slope).abs() < 1e-5 * 4.5e8, "{slices} {d} {t}: {change} {slope}");
                    }
                }
            }
        }
    }

    /// A pair bears on `√(2δ/s)` of its face where its flanks close by s over it, as was solved statically of a pair of 19 mm with 15 slices and
    /// 20 N/(mm µm) under 754 and 251 N, whichever end the slope is at, and whether it turns or stays.
    #[test]
    fn pairs_that_wobble_bear_on_as_much_as_was_solved_in_slices() {
        for (closer_um, force_n, bears) in [
            (0.0, 754.0, 1.0),
            (6.0, 754.0, 0.81),
            (10.0, 754.0, 0.62),
            (20.0, 754.0, 0.44),
            (6.0, 251.0, 0.47),
            (20.0, 251.0, 0.25),
        ] {
            let (stiffness, offset, strips) = ([20e9 * 0.019_05], [0.0], [[0.0, 1.0]]);
            let even = Springs { strips: &strips, ..Springs::frictionless(&stiffness, &offset, &[], &[]) };
            let bearing = |closer_m: f64, wobble_m: f64| {
                let wobble = [wobble_m];
                let springs = Springs { closer_m, wobble: &wobble, ..even };
                let at_rest_m = UNDAMPED.tilted_at_rest(springs, 0.0, force_n);
                UNDAMPED.tilted(springs, [at_rest_m, 0.0]).slopes[0] / stiffness[0]
            };
            let end_m = closer_um * 0.5e-6;
            let part = bearing(0.0, end_m);
            assert!((part / bears - 1.0).abs() < 0.03, "{closer_um} {force_n}: {part}");
            for same in [bearing(0.0, -end_m), bearing(end_m, 0.0), bearing(3e-6, end_m - 3e-6)] {
                assert!((same - part).abs() < 1e-9, "{closer_um} {force_n}: {same} {part}");
            }
        }
    }

    /// A step with two unknowns obeys its equations, with all of the face in contact, an end of it, the other, or nothing, coast flanks too, and side by
    /// side with one unknown as alone.
    #[test]
    fn a_step_of_a_face_that_leans_is_solved() {
        use crate::random::{Draws, Purpose};
        struct Solve<'a, const L: usize> {
            law: &'a LawLanes<L>,
            free: [Lanes<L>; 2],
            compliance: [[Lanes<L>; 2]; 2],
            pairs: &'a PairsSample<L, PAIRS, 0>,
        }
        impl<const L: usize> Task for Solve<'_, L> {
            type Output = [Lanes<L>; 2];
            #[inline(always)]
            fn run<I: Instructions>(self, simd: I) -> [Lanes<L>; 2] {
                let mut last = LastContact::none();
                self.law.force(simd, &self.free, &self.compliance, self.pairs, &[], &mut last)
            }
        }
        let mut draws = Draws::new(4, Purpose::Candidate, 0);
        let mut seen = [0; 4];
        for _ in 0..2000 {
            let mut micrometre = |half: f64| draws.uniform(0.0, half) * 1e-6;
            let offset = [micrometre(10.0), micrometre(10.0), micrometre(10.0)];
            let free = [micrometre(30.0), micrometre(30.0)];
            let (closer_m, backlash) = (micrometre(10.0), micrometre(20.0).abs());
            let [own, of_tilt] = [draws.uniform(1e-9, 1e-9), draws.uniform(1e-8, 1e-8)];
            let cross = draws.uniform(0.0, 0.9) * f64::sqrt(own * of_tilt);
            let gamma = [[own, cross], [cross, of_tilt]];
            let stiffness: [f64; PAIRS] = std::array::from_fn(|_| draws.uniform(2e8, 2e8));
            let law = MeshLaw {
                contact: Contact::Unilateral,
                backlash_m: Some(backlash),
                back_stiffness_n_per_m: 2e8,
                damping_time_s: 2e-6,
            };
            let one = sample(stiffness, offset);
            let alone = LawLanes::new([law], [300.0], [Some(closer_m)]);
            let lanes = |value: f64| Lanes([value]);
            let solve = Solve {
                law: &alone,
                free: free.map(lanes),
                compliance: gamma.map(|row| row.map(lanes)),
                pairs: &one,
            };
            let [force, moment] = InstructionSet::in_use().run(solve).map(|lanes| lanes.0[0]);
            let carried = [300.0 - force, -moment];
            // Both unknowns follow from what is carried, and make it again.
            let unknowns =
                [0, 1].map(|row: usize| free[row] + gamma[row][0] * force + gamma[row][1] * moment);
            let strips = strips(1);
            let springs =
                Springs { strips: &strips, closer_m, ..Springs::frictionless(&stiffness, &offset, &[], &[]) };
            let load = law.tilted(springs, unknowns);
            for (carried, found) in carried.into_iter().zip(load.forces) {
                assert!((carried - found).abs() < 1e-6 * (1.0 + carried.abs()), "{carried} {found}");
            }
            let part = load.slopes[0] / stiffness.iter().sum::<f64>();
            let which = [part > 0.999, load.slopes[1] > 0.0, load.slopes[1] < 0.0, carried[0] < 0.0];
            seen.iter_mut().zip(which).for_each(|(count, is)| *count += usize::from(is));
            // Beside a simulation with one unknown.
            let two = LawLanes::new([law; 2], [300.0; 2], [Some(closer_m), None]);
            let lanes = |value: f64| Lanes([value; 2]);
            let pairs = PairsSample {
                stiffness: stiffness.map(lanes),
                offset: offset.map(lanes),
                ..PairsSample::NONE
            };
            let mut compliance = gamma.map(|row| row.map(lanes));
            let mut of_both = free.map(lanes);
            of_both[1].0[1] = 0.0;
            for [row, column] in [[0, 1], [1, 0], [1, 1]] {
                compliance[row][column].0[1] = 0.0;
            }
            let solve = Solve { law: &two, free: of_both, compliance, pairs: &pairs };
            let together = InstructionSet::in_use().run(solve);
            assert_eq!([together[0].0[0], together[1].0[0]], [force, moment]);
            let plain = LawLanes::new([law], [300.0], [None]);
            let solve = Solve {
                law: &plain,
                free: [Lanes([free[0]]), Lanes([0.0])],
                compliance: [[Lanes([own]), Lanes([0.0])], [Lanes([0.0]); 2]],
                pairs: &one,
            };
            let of_one = InstructionSet::in_use().run(solve);
            assert_eq!([together[0].0[1], together[1].0[1]], [of_one[0].0[0], 0.0]);
        }
        assert!(seen.iter().all(|&count| count > 50), "{seen:?}");
    }

    #[test]
    fn two_pairs_share_a_load_as_in_closed_form() {
        let (stiffness, offset) = ([2e8, 1e8, 0.0], [1e-6, -2e-6, 0.0]);
        let two = Springs::frictionless(&stiffness, &offset, &[], &[]);
        // Light: the first alone. Heavy: both, δ = (F − Σ k o)/Σ k.
        let at_rest = |contact, load| deflection_at_rest(contact, two, load);
        assert!((at_rest(Contact::Unilateral, 100.0) - (100.0 / 2e8 - 1e-6)).abs() < 1e-15);
        assert!((at_rest(Contact::Unilateral, 3000.0) - 3000.0 / 3e8).abs() < 1e-15);
        // Flanks that may pull share every load.
        assert!((at_rest(Contact::Bilateral, 100.0) - 100.0 / 3e8).abs() < 1e-15);
        for contact in [Contact::Unilateral, Contact::Bilateral] {
            let law = MeshLaw { contact, ..UNDAMPED };
            for load in [0.0, 100.0, 599.0, 601.0, 3000.0] {
                let [carried, _] = law.force_and_slope(two, at_rest(contact, load));
                assert!((carried - load).abs() < 1e-9, "{carried} {load}");
            }
        }
    }

    /// Against bisection, over drawn pairs, compliances and free deflections: coast flanks and jammed teeth too.
    #[test]
    fn a_step_is_solved_exactly() {
        use crate::random::{Draws, Purpose};
        struct Solve<'a> {
            law: &'a LawLanes<1>,
            free: f64,
            compliance: f64,
            pairs: &'a PairsSample<1, PAIRS, 0>,
        }
        impl Task for Solve<'_> {
            type Output = f64;
            #[inline(always)]
            fn run<I: Instructions>(self, simd: I) -> f64 {
                let (free, compliance) = ([Lanes([self.free])], [[Lanes([self.compliance])]]);
                self.law.force(simd, &free, &compliance, self.pairs, &[], &mut LastContact::none())[0].0[0]
            }
        }
        let mut draws = Draws::new(1, Purpose::Candidate, 0);
        let mut touched = [0; 3];
        for _ in 0..2000 {
            let mut micrometre = |half: f64| draws.uniform(0.0, half) * 1e-6;
            let offset = [micrometre(10.0), micrometre(10.0), micrometre(10.0)];
            let (free, backlash) = (micrometre(30.0), micrometre(10.0).abs());
            let compliance = draws.uniform(1e-9, 1e-9);
            let stiffness: [f64; PAIRS] = std::array::from_fn(|_| draws.uniform(2e8, 2e8));
            let law = MeshLaw {
                contact: Contact::Unilateral,
                backlash_m: Some(backlash),
                back_stiffness_n_per_m: 2e8,
                damping_time_s: 2e-6,
            };
            let lanes = LawLanes::new([law], [300.0], [None]);
            let pairs = sample(stiffness, offset);
            let solve = Solve { law: &lanes, free, compliance, pairs: &pairs };
            let force = 300.0 - InstructionSet::in_use().run(solve);
            let springs = Springs::frictionless(&stiffness, &offset, &[], &[]);
            let of = |d: f64| law.force_and_slope(springs, d)[0];
            let relative = |d: f64| 300.0 - of(d);
            let (mut low, mut high) = (-1e-3, 1e-3);
            for _ in 0..200 {
                let middle = (low + high) / 2.0;
                if middle - compliance * relative(middle) < free {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            assert!((force - of(low)).abs() < 1e-8 * (1.0 + force.abs()), "{force} {}", of(low));
            let which = [force.abs() < 1e-9, force >= 1e-9, force <= -1e-9];
            touched.iter_mut().zip(which).for_each(|(count, is)| *count += usize::from(is));
        }
        assert!(touched.iter().all(|&count| count > 50), "{touched:?}");
    }
}
