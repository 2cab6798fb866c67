//! The coefficients and first states of several simulations, side by side.

use super::integrate::Problem;
use super::lanes::Lanes;
use super::outputs::EXTERNALS;
use super::prepare::{FirstState, Prepared, column, sum};
use super::step::{Coefficients, Norm, State};

/// Sets one lane; what there are no values for stays 0.
///
/// Compiled once for each number of lanes, whatever the size of the step.
#[inline(never)]
fn set<const L: usize>(lanes: &mut [Lanes<L>], lane: usize, values: &[f64]) {
    for (lanes, value) in lanes.iter_mut().zip(values) {
        lanes.0[lane] = *value;
    }
}

/// Lines the constants of `L` simulations up.
pub(super) fn coefficients<const L: usize, const N: usize, const R: usize>(
    problems: &[&Problem; L],
    prepared: &[Prepared; L],
) -> Coefficients<L, N, R> {
    let mut c = Coefficients::zero();
    for (lane, (problem, prepared)) in problems.iter().zip(prepared).enumerate() {
        c.set(lane, &Constants::new(problem, prepared, R));
    }
    c
}

/// The first states of `L` simulations, side by side.
pub(super) fn first_states<const L: usize, const N: usize, const R: usize>(
    first: &[FirstState; L],
) -> State<L, N, R> {
    let mut state = State::zero();
    for (lane, first) in first.iter().enumerate() {
        set(&mut state.displacement, lane, &first.displacement);
        set(&mut state.scaled_velocity, lane, &first.scaled_velocity);
        set(&mut state.force, lane, &first.force);
        set(&mut state.external, lane, &first.external);
        state.angle.0[lane] = first.angle;
        state.entry[lane] = first.entry;
    }
    state.angles_before = [state.angle; 2];
    state
}

/// The constants of one simulation, in the order and meaning of [`Coefficients`].
struct Constants<'a> {
    keep: &'a [f64],
    restore: &'a [f64],
    push: Vec<Vec<f64>>,
    external_push: [Vec<f64>; EXTERNALS],
    mesh: Vec<&'a [f64]>,
    angle: &'a [f64],
    angle_push: Vec<f64>,
    compliance: Vec<Vec<f64>>,
    static_deflection: &'a [f64],
    scalars: Scalars,
    rigid_displacement: Vec<f64>,
    rigid_increment: Vec<f64>,
    external: &'a [Vec<f64>; EXTERNALS],
    twice_stiffness: Vec<f64>,
}

/// Those of them that are single numbers.
struct Scalars {
    static_angle: f64,
    start: f64,
    points_per_sample: f64,
    cycle: f64,
    pitch: f64,
    window: f64,
    two_per_h2: f64,
}

impl<'a> Constants<'a> {
    /// # Arguments
    /// * `problem`, `prepared` - the simulation
    /// * `directions` - at least those that it has
    fn new(problem: &'a Problem, prepared: &'a Prepared, directions: usize) -> Self {
        let (model, time) = (problem.model, &problem.stages.time);
        let h = prepared.scales.half_step_s;
        let share = |force: &[f64]| -> Vec<f64> {
            prepared.factors.share.iter().zip(force).map(|(share, force)| share * force).collect()
        };
        let push: Vec<Vec<f64>> = (0..directions).map(|r| share(column(model, r))).collect();
        let compliance = &prepared.factors.compliance;
        let step_rad = model.rotation_rad_per_s * 2.0 * h;
        // K̂ r = k_p e_θp + (2/dt) C r + (4/dt²) M r, whatever the mesh stiffness.
        let rigid_increment = |n: usize| {
            let rigid = (2.0 * model.damping[n] + 2.0 / h) * model.rigid_velocity[n];
            model.rotation_rad_per_s * (model.motor[n] * 2.0 * h + rigid)
        };
        Self {
            keep: &prepared.factors.keep,
            restore: &prepared.factors.restore,
            angle_push: push.iter().map(|push| sum(&prepared.angle, push)).collect(),
            push,
            external_push: prepared.scales.external.each_ref().map(|external| share(external)),
            mesh: (0..directions).map(|r| column(model, r)).collect(),
            angle: &prepared.angle,
            compliance: compliance.row_iter().map(|row| row.iter().copied().collect()).collect(),
            static_deflection: &prepared.static_deflection,
            scalars: Scalars {
                static_angle: prepared.static_angle,
                start: time.first_simulated_sample as f64,
                points_per_sample: prepared.points_per_sample,
                cycle: prepared.table.cycle as f64,
                pitch: prepared.table.pitch as f64,
                window: prepared.table.window as f64,
                two_per_h2: 2.0 / (h * h),
            },
            rigid_displacement: model.rigid_velocity.iter().map(|rigid| rigid * step_rad).collect(),
            rigid_increment: (0..model.modes()).map(rigid_increment).collect(),
            external: &prepared.scales.external,
            twice_stiffness: model.stiffness.iter().map(|stiffness| 2.0 * stiffness).collect(),
        }
    }
}

impl<const L: usize, const N: usize, const R: usize> Coefficients<L, N, R> {
    /// Simulations in which nothing moves.
    fn zero() -> Self {
        let zero = Lanes::splat(0.0);
        let (modes, directions) = ([zero; N], [zero; R]);
        Self {
            keep: modes,
            restore: modes,
            push: [modes; R],
            external_push: [modes; EXTERNALS],
            mesh: [modes; R],
            angle: modes,
            angle_push: directions,
            compliance: [directions; R],
            static_deflection: directions,
            static_angle: zero,
            start: zero,
            points_per_sample: zero,
            cycle: zero,
            per_cycle: zero,
            pitch: zero,
            per_pitch: zero,
            window: zero,
            norm: Norm {
                rigid_displacement: modes,
                rigid_increment: modes,
                external: [modes; EXTERNALS],
                twice_stiffness: modes,
                two_per_h2: zero,
            },
        }
    }

    /// Sets one lane.
    fn set(&mut self, lane: usize, constants: &Constants) {
        set(&mut self.keep, lane, constants.keep);
        set(&mut self.restore, lane, constants.restore);
        for (push, values) in self.push.iter_mut().zip(&constants.push) {
            set(push, lane, values);
        }
        for (push, values) in self.external_push.iter_mut().zip(&constants.external_push) {
            set(push, lane, values);
        }
        for (mesh, values) in self.mesh.iter_mut().zip(&constants.mesh) {
            set(mesh, lane, values);
        }
        set(&mut self.angle, lane, constants.angle);
        set(&mut self.angle_push, lane, &constants.angle_push);
        for (row, values) in self.compliance.iter_mut().zip(&constants.compliance) {
            set(row, lane, values);
        }
        set(&mut self.static_deflection, lane, constants.static_deflection);
        set(&mut self.norm.rigid_displacement, lane, &constants.rigid_displacement);
        set(&mut self.norm.rigid_increment, lane, &constants.rigid_increment);
        for (external, values) in self.norm.external.iter_mut().zip(constants.external) {
            set(external, lane, values);
        }
        set(&mut self.norm.twice_stiffness, lane, &constants.twice_stiffness);
        let Scalars { static_angle, start, points_per_sample, cycle, pitch, window, two_per_h2 } =
            constants.scalars;
        self.static_angle.0[lane] = static_angle;
        self.start.0[lane] = start;
        self.points_per_sample.0[lane] = points_per_sample;
        self.cycle.0[lane] = cycle;
        self.per_cycle.0[lane] = 1.0 / cycle;
        self.pitch.0[lane] = pitch;
        self.per_pitch.0[lane] = 1.0 / pitch;
        self.window.0[lane] = window;
        self.norm.two_per_h2.0[lane] = two_per_h2;
    }
}

impl<const L: usize, const N: usize, const R: usize> State<L, N, R> {
    /// Nothing moves.
    fn zero() -> Self {
        let zero = Lanes::splat(0.0);
        Self {
            displacement: [zero; N],
            scaled_velocity: [zero; N],
            force: [zero; R],
            external: [zero; EXTERNALS],
            angle: zero,
            angles_before: [zero; 2],
            entry: [0; L],
        }
    }
}
