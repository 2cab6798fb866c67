//! Steps of a machine with several meshes: one scalar unknown a mesh, all coupled through the machine.
//!
//! In the notation of [`super::step`], the deflections with their damping's lead, `D_a` of mesh a, obey `D + G f(D) = D₀` with
//! `G_ab = Σ_n B_na (β_n + ½ τ_a/Δt) Δt²E_n B_nb`, and `f_a` a rising, piecewise linear function of `D_a` alone.
//!
//! Newton's method takes the pairs that touch at the last iterate and solves the linear equations that these make. It ends, exactly,
//! when the same pairs touch at the new iterate. In theory it can go round in a circle; after [`MOST_PLAIN_ITERATIONS`] each iterate goes
//! only as far towards Newton's as makes the residual smaller.

use super::integrate::{Block, Diverged, Problem, Recorder, is_bounded};
use super::outputs::{EXTERNALS, OutputWeights, dot};
use super::prepare::{FirstState, Prepared};
use crate::mesh::{ForcingBlock, PairsSample};

/// Most meshes that one machine has.
pub(crate) const MOST_MESHES: usize = 8;

/// Samples that are forced and handed out at a time.
const BLOCK: usize = 256;

/// A number for each mesh.
type OfMeshes = [f64; MOST_MESHES];
/// A number for each pair of meshes.
type Matrix = [OfMeshes; MOST_MESHES];

/// Integrates a simulation of any number of meshes, up to [`MOST_MESHES`].
///
/// # Errors
/// As [`super::integrate()`].
pub(super) fn integrate(mut problem: Problem, recorder: &mut dyn Recorder) -> Result<(), Diverged> {
    let prepared = Prepared::new(&problem);
    let (start, end) = (problem.time.first_simulated_sample, problem.time.samples);
    let mut block = ForcingBlock::default();
    let mut samples = vec![PairsSample::<1>::NONE; prepared.laws.len()];
    problem.forcing.next_block(1, &mut block);
    take_sample(&block, 0, &mut samples);
    let first = prepared.first_state(&problem.machine, &samples, 0, external(&block, 0));
    let mut state = State { sample: first, deflection: [0.0; MOST_MESHES] };
    let mut outputs: Vec<Vec<f64>> = vec![Vec::with_capacity(BLOCK); prepared.outputs.len()];
    let mut sample = start;
    while sample < end && recorder.goes_on() {
        let steps = BLOCK.min(end - sample);
        problem.forcing.next_block(steps, &mut block);
        outputs.iter_mut().for_each(Vec::clear);
        let first_recorded = problem.first_sample.max(sample);
        for step in 0..steps {
            if sample + step >= first_recorded {
                for (values, weights) in outputs.iter_mut().zip(&prepared.outputs) {
                    values.push(state.output(weights, sample + step));
                }
            }
            take_sample(&block, step, &mut samples);
            state.step(&prepared, &samples, external(&block, step));
        }
        if !state.sample.displacement.iter().chain(&state.sample.velocity).all(|mode| is_bounded(*mode)) {
            return Err(Diverged { sample: sample + steps });
        }
        sample += steps;
        if first_recorded < sample {
            recorder.record(&Block::new(first_recorded, &outputs));
        }
    }
    Ok(())
}

/// Takes the pairs of each mesh at one sample of a block.
fn take_sample(block: &ForcingBlock, k: usize, samples: &mut [PairsSample<1>]) {
    for (sample, pairs) in samples.iter_mut().zip(&block.meshes) {
        for place in 0..pairs.stiffness.len() {
            sample.stiffness[place].0[0] = pairs.stiffness[place][k];
            sample.offset[place].0[0] = pairs.offset[place][k];
        }
        sample.face_centre.0[0] = pairs.face_centre.get(k).copied().unwrap_or(0.0);
    }
}

/// Motor lead, torque deviation and speed deviation at one sample of a block; 0 while motor and brake are steady.
fn external(block: &ForcingBlock, k: usize) -> [f64; EXTERNALS] {
    block.external.parts().map(|part| part.get(k).copied().unwrap_or(0.0))
}

/// The state of the modes, and where the next step begins its search.
struct State {
    sample: FirstState,
    /// (m) D of each mesh.
    deflection: OfMeshes,
}

impl State {
    fn output(&self, weights: &OutputWeights, sample: usize) -> f64 {
        weights.constant
            + weights.per_sample * sample as f64
            + dot(&weights.displacement, &self.sample.displacement)
            + dot(&weights.velocity, &self.sample.velocity)
            + dot(&weights.acceleration, &self.sample.acceleration)
            + dot(&weights.force, &self.sample.force)
    }

    /// Moves on by one sample: first without the new forces of the meshes, then by these.
    fn step(
        &mut self,
        prepared: &Prepared,
        samples: &[PairsSample<1>],
        external: [f64; EXTERNALS],
    ) {
        let FirstState { displacement, velocity, acceleration, force } = &mut self.sample;
        for n in 0..displacement.len() {
            velocity[n] += acceleration[n];
            displacement[n] += velocity[n];
            let driven: f64 = (0..EXTERNALS).map(|x| prepared.external_push[x][n] * external[x]).sum();
            acceleration[n] = prepared.restore[n] * displacement[n] + prepared.damp[n] * velocity[n] + driven;
        }
        let free: Vec<f64> = (prepared.columns.iter())
            .map(|column| {
                column.static_deflection
                    + dot(&column.of_displacement, displacement)
                    + dot(&column.of_velocity, velocity)
                    + dot(&column.of_external, &external)
            })
            .collect();
        *force = prepared.mesh_forces(&free, samples, &mut self.deflection);
        for (column, force) in prepared.columns.iter().zip(force) {
            acceleration.iter_mut().zip(&column.push).for_each(|(acceleration, push)| *acceleration += push * *force);
        }
    }
}

impl Prepared {
    /// (N) The forces of the meshes on the modes at the end of a step, in each column, relative to the static ones.
    ///
    /// # Arguments
    /// * `free` - (m) deflection with its damping's lead in each column, without the new forces
    /// * `samples` - the pairs of each mesh at the step's end
    /// * `deflection` - (m) D of each mesh at the step's start; set to that at its end
    fn mesh_forces(
        &self,
        free: &[f64],
        samples: &[PairsSample<1>],
        deflection: &mut OfMeshes,
    ) -> Vec<f64> {
        let count = self.laws.len();
        // Each load acts in the one direction g(z̄) = g₀ + z̄ g₁.
        let weights = |mesh: usize| {
            let mut columns = self.columns_of_mesh[mesh].clone();
            let middle = columns.next().map(|first| (first, 1.0));
            middle.into_iter().chain(columns.map(move |tilt| (tilt, samples[mesh].face_centre.0[0])))
        };
        let mut equations = Equations {
            count,
            compliance: [[0.0; MOST_MESHES]; MOST_MESHES],
            free: [0.0; MOST_MESHES],
        };
        for a in 0..count {
            equations.free[a] = weights(a).map(|(r, of_r)| of_r * free[r]).sum();
            for (b, static_force_n) in self.static_force_n.iter().enumerate() {
                let from = self.columns_of_mesh[b].start;
                for (r, of_r) in weights(a) {
                    // The static force acts midway along the face.
                    equations.free[a] += of_r * self.compliance[r][from] * static_force_n;
                    for (s, of_s) in weights(b) {
                        equations.compliance[a][b] += of_r * self.compliance[r][s] * of_s;
                    }
                }
            }
        }
        let force_and_slope =
            |mesh: usize, deflection_m: f64| self.laws[mesh].force_and_slope(&samples[mesh], 0, deflection_m);
        equations.solve(&force_and_slope, deflection);
        let mut forces = vec![0.0; free.len()];
        for (mesh, static_force_n) in self.static_force_n.iter().enumerate() {
            let [force, _] = force_and_slope(mesh, deflection[mesh]);
            for (column, weight) in weights(mesh) {
                forces[column] = -weight * force;
            }
            // The static force acts midway along the face.
            forces[self.columns_of_mesh[mesh].start] += static_force_n;
        }
        forces
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
    /// (m) D₀.
    free: OfMeshes,
}

impl Equations {
    /// Solves the equations.
    ///
    /// # Arguments
    /// * `law` - force and slope of a mesh at a deflection; piecewise linear
    /// * `deflection` - (m) where to begin; set to the solution
    fn solve(&self, law: &dyn Fn(usize, f64) -> [f64; 2], deflection: &mut OfMeshes) {
        for iteration in 0..MOST_ITERATIONS {
            let (newton, slopes) = self.newton(law, deflection);
            let same = (0..self.count).all(|a| law(a, newton[a])[1] == slopes[a]);
            if same || iteration < MOST_PLAIN_ITERATIONS {
                *deflection = newton;
            } else {
                self.go_towards(law, deflection, &newton);
            }
            if same {
                return;
            }
        }
    }

    /// The solution if the pairs that touch at `deflection` went on touching, `(1 + G K) D = D₀ − G (f − K D)`, and their slopes K.
    fn newton(&self, law: &dyn Fn(usize, f64) -> [f64; 2], deflection: &OfMeshes) -> (OfMeshes, OfMeshes) {
        let (mut matrix, mut right) = ([[0.0; MOST_MESHES]; MOST_MESHES], self.free);
        let mut slopes = [0.0; MOST_MESHES];
        for b in 0..self.count {
            let [force, slope] = law(b, deflection[b]);
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
    fn go_towards(&self, law: &dyn Fn(usize, f64) -> [f64; 2], from: &mut OfMeshes, to: &OfMeshes) {
        let residual = |deflection: &OfMeshes| {
            let of_mesh = |a: usize| {
                let pressed = (0..self.count).map(|b| self.compliance[a][b] * law(b, deflection[b])[0]);
                (deflection[a] + pressed.sum::<f64>() - self.free[a]).powi(2)
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
                free: std::array::from_fn(|_| draws.uniform(0.0, 3.0)),
            };
            for row in 0..count {
                for column in 0..count {
                    equations.compliance[row][column] =
                        strength * (0..MOST_MESHES).map(|k| a[row][k] * a[column][k]).sum::<f64>();
                }
            }
            for start in [-10.0, 0.0, 10.0] {
                let mut deflection = [start; MOST_MESHES];
                equations.solve(&law, &mut deflection);
                for row in 0..count {
                    let pressed: f64 = (0..count)
                        .map(|column| equations.compliance[row][column] * law(column, deflection[column])[0])
                        .sum();
                    let residual = deflection[row] + pressed - equations.free[row];
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
        let equations = Equations { count: 2, compliance, free };
        let mut exact = [0.0; MOST_MESHES];
        equations.solve(&law, &mut exact);
        let mut searched = [-4.0; MOST_MESHES];
        for _ in 0..20 {
            let (newton, _) = equations.newton(&law, &searched);
            equations.go_towards(&law, &mut searched, &newton);
        }
        assert!((searched[0] - exact[0]).abs() < 1e-12 && (searched[1] - exact[1]).abs() < 1e-12, "{searched:?}");
    }
}
