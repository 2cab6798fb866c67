//! Steps of a machine with several meshes: one scalar unknown a mesh, all coupled through the machine.
//!
//! In the notation of [`super::step`], the deflections with their damping's lead, `D_a` of mesh a, obey `D + G f(D) = D₀` with
//! `G_ab = Σ_n B_na (β_n + ½ τ_a/Δt) Δt²E_n B_nb`, and `f_a` a rising, piecewise linear function of `D_a` alone.
//!
//! Newton's method takes the pairs that touch at the last iterate and solves the linear equations that these make. It ends, exactly,
//! when the same pairs touch at the new iterate. In theory it can go round in a circle; after [`MOST_PLAIN_ITERATIONS`] each iterate goes
//! only as far towards Newton's as makes the residual smaller.

use super::integrate::{Block, Diverged, Problem, Recorder, StepCounts, is_bounded};
use super::outputs::{EXTERNALS, OutputWeights, dot};
use super::prepare::{FirstState, Prepared};
use crate::mesh::{ForcingBlock, MeshLaw, PairsSample};
use crate::simd::{InstructionSet, Instructions, Lanes, Task};

/// Most meshes that one machine has.
pub(crate) const MOST_MESHES: usize = 8;

/// Samples that are forced and handed out at a time.
const BLOCK: usize = 256;

/// Modes that are stepped side by side.
const SIDE_BY_SIDE: usize = 8;

/// A number for each mode, some side by side; 0 behind the last mode.
type OfModes = Vec<Lanes<SIDE_BY_SIDE>>;
/// A number for each mesh.
type OfMeshes = [f64; MOST_MESHES];
/// A number for each pair of meshes.
type Matrix = [OfMeshes; MOST_MESHES];

/// Numbers of the modes, some side by side.
fn side_by_side(values: &[f64]) -> OfModes {
    let at = |chunk: usize, lane: usize| values.get(chunk * SIDE_BY_SIDE + lane).copied().unwrap_or(0.0);
    (0..values.len().div_ceil(SIDE_BY_SIDE)).map(|chunk| Lanes::from_fn(|lane| at(chunk, lane))).collect()
}

/// Integrates a simulation of any number of meshes, up to [`MOST_MESHES`].
///
/// # Errors
/// As [`super::integrate()`].
pub(super) fn integrate(
    mut problem: Problem,
    instructions: InstructionSet,
    recorder: &mut dyn Recorder,
) -> Result<(), Diverged> {
    let prepared = Prepared::new(&problem);
    let constants = Constants::new(&prepared);
    let (start, end) = (problem.time.first_simulated_sample, problem.time.samples);
    let mut block = ForcingBlock::default();
    problem.forcing.next_block(1, &mut block);
    let mut pairs = vec![vec![PairsSample::<1>::NONE; BLOCK]; prepared.laws.len()];
    line_up(&block, 1, &mut pairs);
    let first_pairs: Vec<PairsSample<1>> = pairs.iter().map(|of_mesh| of_mesh[0]).collect();
    let first_external = external(&block, 0);
    let first = prepared.first_state(&problem.machine, &first_pairs, 0, first_external);
    let mut state = State::new(first, first_external);
    let mut outputs: Vec<Vec<f64>> = vec![Vec::with_capacity(BLOCK); prepared.outputs.len()];
    let mut sample = start;
    while sample < end && recorder.goes_on() {
        let steps = BLOCK.min(end - sample);
        problem.forcing.next_block(steps, &mut block);
        line_up(&block, steps, &mut pairs);
        outputs.iter_mut().for_each(Vec::clear);
        let first_recorded = problem.first_sample.max(sample);
        instructions.run(Steps {
            constants: &constants,
            state: &mut state,
            pairs: &pairs,
            block: &block,
            is_steady: problem.is_steady,
            samples: sample..sample + steps,
            first_recorded,
            outputs: &mut outputs,
        });
        let moved = state.displacement.iter().chain(&state.velocity);
        if !moved.flat_map(|modes| &modes.0).all(|mode| is_bounded(*mode)) {
            return Err(Diverged { sample: sample + steps });
        }
        sample += steps;
        if first_recorded < sample {
            recorder.record(&Block::new(first_recorded, &outputs));
        }
    }
    recorder.count(state.counts);
    Ok(())
}

/// Lines the pairs of each mesh up, sample by sample.
fn line_up(block: &ForcingBlock, steps: usize, pairs: &mut [Vec<PairsSample<1>>]) {
    for (samples, of_mesh) in pairs.iter_mut().zip(&block.meshes) {
        PairsSample::line_up(&mut samples[..steps], &[of_mesh]);
    }
}

/// Motor lead, torque deviation and speed deviation at one sample of a block; 0 while motor and brake are steady.
fn external(block: &ForcingBlock, k: usize) -> [f64; EXTERNALS] {
    block.external.parts().map(|part| part.get(k).copied().unwrap_or(0.0))
}

/// What does not change from step to step.
struct Constants<'a> {
    prepared: &'a Prepared,
    restore: OfModes,
    damp: OfModes,
    external_push: [OfModes; EXTERNALS],
    columns: Vec<ColumnOfModes>,
    outputs: Vec<OutputOfModes<'a>>,
    /// The equations of a step where all loads act midway along their faces, without the free deflections.
    midway: Option<Equations>,
}

/// A column of a line of action.
struct ColumnOfModes {
    push: OfModes,
    of_displacement: OfModes,
    of_velocity: OfModes,
}

/// An output; an empty list stands for zeros.
struct OutputOfModes<'a> {
    displacement: OfModes,
    velocity: OfModes,
    acceleration: OfModes,
    weights: &'a OutputWeights,
}

impl<'a> Constants<'a> {
    fn new(prepared: &'a Prepared) -> Self {
        let column = |column: &super::prepare::Column| ColumnOfModes {
            push: side_by_side(&column.push),
            of_displacement: side_by_side(&column.of_displacement),
            of_velocity: side_by_side(&column.of_velocity),
        };
        let output = |weights: &'a OutputWeights| OutputOfModes {
            displacement: side_by_side(&weights.displacement),
            velocity: side_by_side(&weights.velocity),
            acceleration: side_by_side(&weights.acceleration),
            weights,
        };
        let all_midway = prepared.columns_of_mesh.iter().all(|columns| columns.len() == 1);
        Self {
            restore: side_by_side(&prepared.restore),
            damp: side_by_side(&prepared.damp),
            external_push: prepared.external_push.each_ref().map(|push| side_by_side(push)),
            columns: prepared.columns.iter().map(column).collect(),
            outputs: prepared.outputs.iter().map(output).collect(),
            midway: all_midway.then(|| prepared.equations(&[])),
            prepared,
        }
    }
}

/// The state of the modes, and where the next step begins its search.
struct State {
    displacement: OfModes,
    velocity: OfModes,
    acceleration: OfModes,
    /// (N) Force in each column, relative to the static one.
    force: Vec<f64>,
    external: [f64; EXTERNALS],
    /// (m) D of each mesh.
    deflection: OfMeshes,
    /// (m) Deflection in each column with its damping's lead, without the step's own force.
    free: Vec<f64>,
    counts: StepCounts,
}

impl State {
    fn new(first: FirstState, external: [f64; EXTERNALS]) -> Self {
        let FirstState { displacement, velocity, acceleration, force } = first;
        Self {
            displacement: side_by_side(&displacement),
            velocity: side_by_side(&velocity),
            acceleration: side_by_side(&acceleration),
            free: vec![0.0; force.len()],
            force,
            external,
            deflection: [0.0; MOST_MESHES],
            counts: StepCounts::default(),
        }
    }

    #[inline(always)]
    fn output<I: Instructions>(&self, simd: I, output: &OutputOfModes, sample: usize) -> f64 {
        let weights = output.weights;
        let forces = weights.force.iter().zip(&self.force).map(|(weight, force)| weight * force);
        let mut sum = Lanes::splat(0.0);
        sum = products(simd, sum, &output.displacement, &self.displacement);
        sum = products(simd, sum, &output.velocity, &self.velocity);
        sum = products(simd, sum, &output.acceleration, &self.acceleration);
        let of_external = dot(&weights.external, &self.external);
        weights.constant + weights.per_sample * sample as f64 + forces.sum::<f64>() + of_external + total(sum)
    }
}

/// Adds the products of two lists, as far as both reach.
#[inline(always)]
fn products<I: Instructions>(
    simd: I,
    mut sum: Lanes<SIDE_BY_SIDE>,
    a: &[Lanes<SIDE_BY_SIDE>],
    b: &[Lanes<SIDE_BY_SIDE>],
) -> Lanes<SIDE_BY_SIDE> {
    for (a, b) in a.iter().zip(b) {
        sum = a.mul_add(simd, *b, sum);
    }
    sum
}

/// The sum of numbers side by side.
#[inline(always)]
fn total(lanes: Lanes<SIDE_BY_SIDE>) -> f64 {
    let [a, b, c, d, e, f, g, h] = lanes.0;
    ((a + b) + (c + d)) + ((e + f) + (g + h))
}

/// The steps of one block of samples: all that is compiled for each instruction set.
struct Steps<'a, 'c> {
    constants: &'a Constants<'c>,
    state: &'a mut State,
    /// For each mesh, the pairs at the samples after the state's.
    pairs: &'a [Vec<PairsSample<1>>],
    block: &'a ForcingBlock,
    is_steady: bool,
    samples: std::ops::Range<usize>,
    first_recorded: usize,
    outputs: &'a mut [Vec<f64>],
}

impl Task for Steps<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(self, simd: I) {
        for (k, sample) in self.samples.clone().enumerate() {
            if sample >= self.first_recorded {
                for (values, output) in self.outputs.iter_mut().zip(&self.constants.outputs) {
                    values.push(self.state.output(simd, output, sample));
                }
            }
            let external = (!self.is_steady).then(|| external(self.block, k));
            self.state.step(simd, self.constants, self.pairs, k, external);
        }
    }
}

impl State {
    /// Moves on by one sample: first without the new forces of the meshes, then by these.
    #[inline(always)]
    fn step<I: Instructions>(
        &mut self,
        simd: I,
        constants: &Constants,
        pairs: &[Vec<PairsSample<1>>],
        k: usize,
        external: Option<[f64; EXTERNALS]>,
    ) {
        let chunks = self.displacement.len();
        for n in 0..chunks {
            let velocity = self.velocity[n].add(simd, self.acceleration[n]);
            let displacement = self.displacement[n].add(simd, velocity);
            let damped = constants.damp[n].mul(simd, velocity);
            let mut acceleration = constants.restore[n].mul_add(simd, displacement, damped);
            for (push, external) in constants.external_push.iter().zip(external.into_iter().flatten()) {
                acceleration = push[n].mul_add(simd, Lanes::splat(external), acceleration);
            }
            (self.velocity[n], self.displacement[n], self.acceleration[n]) = (velocity, displacement, acceleration);
        }
        self.external = external.unwrap_or_default();
        let prepared = constants.prepared;
        for ((free, column), of_modes) in self.free.iter_mut().zip(&prepared.columns).zip(&constants.columns) {
            let mut sum = products(simd, Lanes::splat(0.0), &of_modes.of_displacement, &self.displacement);
            sum = products(simd, sum, &of_modes.of_velocity, &self.velocity);
            let driven = external.map_or(0.0, |external| {
                dot(&column.of_external, &external)
            });
            *free = column.static_deflection + driven + total(sum);
        }
        constants.mesh_forces(pairs, k, self);
        for (column, force) in constants.columns.iter().zip(&self.force) {
            let force = Lanes::splat(*force);
            for (acceleration, push) in self.acceleration.iter_mut().zip(&column.push) {
                *acceleration = push.mul_add(simd, force, *acceleration);
            }
        }
    }
}

impl Constants<'_> {
    /// Sets (N) the forces of the meshes on the modes at the end of a step, in each column, relative to the static ones.
    ///
    /// # Arguments
    /// * `pairs`, `k` - the pairs of each mesh, and which sample of them is the step's end
    /// * `state` - has the free deflections, and each mesh's deflection at the step's start, which is set to that at its end
    fn mesh_forces(&self, pairs: &[Vec<PairsSample<1>>], k: usize, state: &mut State) {
        let prepared = self.prepared;
        let mut face_centres = [0.0; MOST_MESHES];
        face_centres.iter_mut().zip(pairs).for_each(|(centre, pairs)| *centre = pairs[k].face_centre.0[0]);
        let own;
        let equations = match &self.midway {
            Some(equations) => equations,
            None => {
                own = prepared.equations(&face_centres);
                &own
            }
        };
        let mut free = equations.of_static;
        for (mesh, free) in free.iter_mut().enumerate().take(equations.count) {
            let mut columns = prepared.columns_of_mesh[mesh].clone();
            *free += columns.next().map_or(0.0, |column| state.free[column]);
            *free += columns.map(|column| face_centres[mesh] * state.free[column]).sum::<f64>();
        }
        let law = PairsLaw { laws: &prepared.laws, pairs, k };
        let [iterations, searched] = equations.solve(&law, &free, &mut state.deflection);
        state.counts.steps += 1;
        state.counts.iterations += iterations;
        state.counts.most_iterations = state.counts.most_iterations.max(iterations);
        state.counts.searched += searched;
        for (mesh, static_force_n) in prepared.static_force_n.iter().enumerate() {
            let [force, _] = law.force_and_slope(mesh, state.deflection[mesh]);
            let mut columns = prepared.columns_of_mesh[mesh].clone();
            if let Some(middle) = columns.next() {
                // The static force acts midway along the face.
                state.force[middle] = static_force_n - force;
            }
            columns.for_each(|column| state.force[column] = -face_centres[mesh] * force);
        }
    }
}

impl Prepared {
    /// The equations of a step without the free deflections.
    ///
    /// # Arguments
    /// * `face_centres` - (m) where along its face the load of each mesh acts; what is missing acts midway
    fn equations(&self, face_centres: &[f64]) -> Equations {
        // Each load acts in the one direction g(z̄) = g₀ + z̄ g₁.
        let weights = |mesh: usize| {
            let z = face_centres.get(mesh).copied().unwrap_or(0.0);
            let mut columns = self.columns_of_mesh[mesh].clone();
            let middle = columns.next().map(|first| (first, 1.0));
            middle.into_iter().chain(columns.map(move |tilt| (tilt, z)))
        };
        let count = self.laws.len();
        let mut equations = Equations {
            count,
            compliance: [[0.0; MOST_MESHES]; MOST_MESHES],
            of_static: [0.0; MOST_MESHES],
        };
        for a in 0..count {
            for (b, static_force_n) in self.static_force_n.iter().enumerate() {
                let from = self.columns_of_mesh[b].start;
                for (r, of_r) in weights(a) {
                    // The static force acts midway along the face.
                    equations.of_static[a] += of_r * self.compliance[r][from] * static_force_n;
                    for (s, of_s) in weights(b) {
                        equations.compliance[a][b] += of_r * self.compliance[r][s] * of_s;
                    }
                }
            }
        }
        equations
    }
}

/// Force and slope of each mesh at a deflection: rising and piecewise linear.
trait Law {
    /// (N, N/m) Of a mesh at (m) a deflection.
    fn force_and_slope(&self, mesh: usize, deflection_m: f64) -> [f64; 2];
}

/// The pairs at one sample.
struct PairsLaw<'a> {
    laws: &'a [MeshLaw],
    pairs: &'a [Vec<PairsSample<1>>],
    k: usize,
}

impl Law for PairsLaw<'_> {
    #[inline(always)]
    fn force_and_slope(&self, mesh: usize, deflection_m: f64) -> [f64; 2] {
        self.laws[mesh].force_and_slope(&self.pairs[mesh][self.k], 0, deflection_m)
    }
}

/// Most of Newton's iterations without a search along the line. Of 2 000 random problems of up to eight meshes none needed more than 8.
const MOST_PLAIN_ITERATIONS: usize = 12;
/// Most iterations of all: beyond, rounding decides between two sets of pairs that are as good.
const MOST_ITERATIONS: usize = 50;

/// The equations of a step, `D + G f(D) = D₀`.
struct Equations {
    /// Number of meshes.
    count: usize,
    /// (m/N) G.
    compliance: Matrix,
    /// (m) What the static forces, which the forces on the modes are relative to, add to D₀.
    of_static: OfMeshes,
}

impl Equations {
    /// Solves the equations.
    ///
    /// # Arguments
    /// * `law` - of the meshes
    /// * `free` - (m) D₀
    /// * `deflection` - (m) where to begin; set to the solution
    ///
    /// # Returns
    /// How many iterations it took, and 1 where some were searches along the line.
    fn solve(&self, law: &impl Law, free: &OfMeshes, deflection: &mut OfMeshes) -> [u64; 2] {
        for iteration in 0..MOST_ITERATIONS {
            let (newton, slopes) = self.newton(law, free, deflection);
            let same = (0..self.count).all(|a| law.force_and_slope(a, newton[a])[1] == slopes[a]);
            if same || iteration < MOST_PLAIN_ITERATIONS {
                *deflection = newton;
            } else {
                self.go_towards(law, free, deflection, &newton);
            }
            if same {
                return [iteration as u64 + 1, u64::from(iteration > MOST_PLAIN_ITERATIONS)];
            }
        }
        [MOST_ITERATIONS as u64, 1]
    }

    /// The solution if the pairs that touch at `deflection` went on touching, `(1 + G K) D = D₀ − G (f − K D)`, and their slopes K.
    fn newton(&self, law: &impl Law, free: &OfMeshes, deflection: &OfMeshes) -> (OfMeshes, OfMeshes) {
        let (mut matrix, mut right) = ([[0.0; MOST_MESHES]; MOST_MESHES], *free);
        let mut slopes = [0.0; MOST_MESHES];
        for b in 0..self.count {
            let [force, slope] = law.force_and_slope(b, deflection[b]);
            slopes[b] = slope;
            for a in 0..self.count {
                let share = self.compliance[a][b];
                matrix[a][b] = share * slope + f64::from(a == b);
                right[a] -= share * (force - slope * deflection[b]);
            }
        }
        solve_linear(self.count, matrix, &mut right);
        (right, slopes)
    }

    /// Goes from `from` towards `to`, Newton's iterate, as far as makes the residual smaller: up to the next pair that touches or leaves the
    /// residual falls in proportion.
    fn go_towards(&self, law: &impl Law, free: &OfMeshes, from: &mut OfMeshes, to: &OfMeshes) {
        let residual = |deflection: &OfMeshes| {
            let of_mesh = |a: usize| {
                let pressed = (0..self.count).map(|b| self.compliance[a][b] * law.force_and_slope(b, deflection[b])[0]);
                (deflection[a] + pressed.sum::<f64>() - free[a]).powi(2)
            };
            (0..self.count).map(of_mesh).sum::<f64>()
        };
        let (start, before) = (*from, residual(from));
        let mut part = 1.0;
        for _ in 0..HALVINGS {
            *from = std::array::from_fn(|a| start[a] + part * (to[a] - start[a]));
            if residual(from) < before {
                return;
            }
            part /= 2.0;
        }
    }
}

/// Halvings of the way until only rounding is left of it.
const HALVINGS: usize = 60;

/// Solves a few linear equations by elimination with pivots from the column.
///
/// # Arguments
/// * `count` - number of equations
/// * `matrix` - by rows
/// * `right` - the right-hand side; set to the solution
fn solve_linear(count: usize, mut matrix: Matrix, right: &mut OfMeshes) {
    for column in 0..count {
        let pivot = (column..count)
            .max_by(|&a, &b| matrix[a][column].abs().total_cmp(&matrix[b][column].abs()))
            .unwrap_or(column);
        matrix.swap(column, pivot);
        right.swap(column, pivot);
        for row in column + 1..count {
            let factor = matrix[row][column] / matrix[column][column];
            for k in column..count {
                matrix[row][k] -= factor * matrix[column][k];
            }
            right[row] -= factor * right[column];
        }
    }
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|k| matrix[row][k] * right[k]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Draws, Purpose};

    /// A law that is a function.
    struct Function<F>(F);

    impl<F: Fn(usize, f64) -> [f64; 2]> Law for Function<F> {
        fn force_and_slope(&self, mesh: usize, deflection_m: f64) -> [f64; 2] {
            self.0(mesh, deflection_m)
        }
    }

    /// Springs that push from given deflections on, and back flanks: 2 000 drawn problems of one to eight meshes, also of such as are
    /// coupled far more strongly than those of a machine. The solution obeys the equations, from wherever the search begins.
    #[test]
    fn drawn_equations_are_solved_exactly() {
        let mut draws = Draws::new(3, Purpose::Candidate, 0);
        for problem in 0..2_000 {
            let count = 1 + problem % MOST_MESHES;
            let strength = 10f64.powf(draws.uniform(0.0, 2.0));
            let mut springs = [[[0.0; 2]; 4]; MOST_MESHES];
            springs.iter_mut().flatten().for_each(|spring| {
                *spring = [draws.uniform(1.0, 1.0), draws.uniform(0.0, 1.0)];
            });
            let law = |mesh: usize, deflection: f64| {
                let touching = springs[mesh].iter().filter(|[_, offset]| deflection + offset > 0.0);
                touching.fold([0.0; 2], |[force, slope], [k, offset]| {
                    [force + k * (deflection + offset), slope + k]
                })
            };
            // S = A Aᵀ.
            let a: Matrix = std::array::from_fn(|_| std::array::from_fn(|_| draws.uniform(0.0, 1.0)));
            let mut equations = Equations {
                count,
                compliance: [[0.0; MOST_MESHES]; MOST_MESHES],
                of_static: [0.0; MOST_MESHES],
            };
            let free: OfMeshes = std::array::from_fn(|_| draws.uniform(0.0, 3.0));
            for row in 0..count {
                for column in 0..count {
                    equations.compliance[row][column] =
                        strength * (0..MOST_MESHES).map(|k| a[row][k] * a[column][k]).sum::<f64>();
                }
            }
            for start in [-10.0, 0.0, 10.0] {
                let mut deflection = [start; MOST_MESHES];
                equations.solve(&Function(law), &free, &mut deflection);
                for row in 0..count {
                    let pressed: f64 = (0..count)
                        .map(|column| equations.compliance[row][column] * law(column, deflection[column])[0])
                        .sum();
                    let residual = deflection[row] + pressed - free[row];
                    assert!(residual.abs() < 1e-9 * (1.0 + strength), "{problem}: {residual}");
                }
            }
        }
    }

    /// The search along the line alone comes to the same solution.
    #[test]
    fn search_along_the_line_ends_at_the_solution() {
        let law = |_: usize, deflection: f64| if deflection > 0.0 { [3.0 * deflection, 3.0] } else { [0.0, 0.0] };
        let mut compliance = [[0.0; MOST_MESHES]; MOST_MESHES];
        compliance[0][..2].copy_from_slice(&[2.0, 0.9]);
        compliance[1][..2].copy_from_slice(&[0.9, 1.0]);
        let mut free = [0.0; MOST_MESHES];
        free[..2].copy_from_slice(&[1.0, -0.2]);
        let equations = Equations { count: 2, compliance, of_static: [0.0; MOST_MESHES] };
        let law = Function(law);
        let mut exact = [0.0; MOST_MESHES];
        equations.solve(&law, &free, &mut exact);
        let mut searched = [-4.0; MOST_MESHES];
        for _ in 0..20 {
            let (newton, _) = equations.newton(&law, &free, &searched);
            equations.go_towards(&law, &free, &mut searched, &newton);
        }
        assert!((searched[0] - exact[0]).abs() < 1e-12 && (searched[1] - exact[1]).abs() < 1e-12, "{searched:?}");
    }
}
