//! The coefficients of several simulations, side by side.

use super::integrate::Problem;
use super::outputs::EXTERNALS;
use super::prepare::{FirstState, Prepared, externals, sum};
use super::step::{Ahead, Coefficients, Norm, State};
use crate::simd::Lanes;

/// A value of each lane. The functions that line values up are called through references to closures: they are compiled once for
/// each size, not once for each of its coefficients.
fn lanes<const L: usize>(f: &dyn Fn(usize) -> f64) -> Lanes<L> {
    Lanes::from_fn(f)
}

/// Values of each lane, one of each of `N` items.
fn items<const L: usize, const N: usize>(f: &dyn Fn(usize, usize) -> f64) -> [Lanes<L>; N] {
    let mut items = [Lanes::splat(0.0); N];
    for (n, item) in items.iter_mut().enumerate() {
        *item = lanes(&|l| f(l, n));
    }
    items
}

/// Modal values of each lane; modes that a lane has not got are 0.
fn modal<'a, const L: usize, const N: usize>(of: &dyn Fn(usize) -> &'a [f64]) -> [Lanes<L>; N] {
    items(&|l, n| of(l).get(n).copied().unwrap_or(0.0))
}

/// Values of each lane, one of each of `N` items in each of `I` rows.
fn rows<const L: usize, const N: usize, const I: usize>(
    f: &dyn Fn(usize, usize, usize) -> f64,
) -> [[Lanes<L>; N]; I] {
    let mut rows = [[Lanes::splat(0.0); N]; I];
    for (i, row) in rows.iter_mut().enumerate() {
        *row = items(&|l, n| f(l, i, n));
    }
    rows
}

/// As [`modal`], in each of `I` rows, of values that are computed.
fn modal_rows<const L: usize, const N: usize, const I: usize>(
    of: &dyn Fn(usize, usize) -> Vec<f64>,
) -> [[Lanes<L>; N]; I] {
    let mut rows = [[Lanes::splat(0.0); N]; I];
    for (i, row) in rows.iter_mut().enumerate() {
        *row = computed(&|l| of(l, i));
    }
    rows
}

/// As [`modal`], of values that are computed.
fn computed<const L: usize, const N: usize>(of: &dyn Fn(usize) -> Vec<f64>) -> [Lanes<L>; N] {
    let values: Vec<Vec<f64>> = (0..L).map(of).collect();
    modal(&|l| &values[l])
}

/// Lines the constants of `L` simulations up.
pub(super) fn coefficients<const L: usize, const N: usize, const R: usize>(
    problems: &[&Problem; L],
    prepared: &[Prepared<R>; L],
) -> Coefficients<L, N, R> {
    let model = |l: usize| problems[l].model;
    let column = |l: usize, r: usize| model(l).mesh.get(r).map_or(&[][..], |column| column.as_slice());
    let half_step = |l: usize| prepared[l].scales.half_step_s;
    Coefficients {
        keep: modal(&|l| &prepared[l].factors.keep),
        restore: modal(&|l| &prepared[l].factors.restore),
        push: modal_rows(&|l, r| prepared[l].push(problems[l], r)),
        external_push: modal_rows(&|l, x| prepared[l].share(externals(&prepared[l])[x])),
        mesh: rows(&|l, r, n| column(l, r).get(n).copied().unwrap_or(0.0)),
        angle: modal(&|l| &prepared[l].angle),
        angle_push: items(&|l, r| sum(&prepared[l].angle, &prepared[l].push(problems[l], r))),
        compliance: rows(&|l, r, c| prepared[l].factors.compliance.get((r, c)).copied().unwrap_or(0.0)),
        static_deflection: items(&|l, r| prepared[l].static_deflection[r]),
        static_angle: lanes(&|l| prepared[l].static_angle),
        start: lanes(&|l| problems[l].time.first_simulated_sample as f64),
        points_per_sample: lanes(&|l| prepared[l].points_per_sample),
        norm: Norm {
            rigid_displacement: computed(&|l| {
                let step_rad = model(l).rotation_rad_per_s * 2.0 * half_step(l);
                model(l).rigid_velocity.iter().map(|rigid| rigid * step_rad).collect()
            }),
            // K̂ r = k_p e_θp + (2/dt) C r + (4/dt²) M r, whatever the mesh stiffness.
            rigid_increment: computed(&|l| {
                let (h, model) = (half_step(l), model(l));
                (0..model.modes())
                    .map(|n| {
                        let rigid = (2.0 * model.damping[n] + 2.0 / h) * model.rigid_velocity[n];
                        model.rotation_rad_per_s * (model.motor[n] * 2.0 * h + rigid)
                    })
                    .collect()
            }),
            external: rows(&|l, x, n| externals(&prepared[l])[x].get(n).copied().unwrap_or(0.0)),
            twice_stiffness: computed(&|l| {
                model(l).stiffness.iter().map(|stiffness| 2.0 * stiffness).collect()
            }),
            two_per_h2: lanes(&|l| 2.0 / (half_step(l) * half_step(l))),
        },
        ahead: ahead(problems, prepared),
    }
}

/// What looks ahead to the deflection at the end of a step, side by side.
fn ahead<const L: usize, const N: usize, const R: usize>(
    problems: &[&Problem; L],
    prepared: &[Prepared<R>; L],
) -> Ahead<L, N, R> {
    let of_lane: [Vec<LookAhead>; L] = std::array::from_fn(|l| {
        (0..problems[l].model.mesh.len()).map(|r| LookAhead::new(problems[l], &prepared[l], r)).collect()
    });
    let numbers = |values: &[f64], n: usize| values.get(n).copied().unwrap_or(0.0);
    let of = |l: usize, r: usize, n: usize, part: fn(&LookAhead) -> &[f64]| {
        of_lane[l].get(r).map_or(0.0, |ahead| numbers(part(ahead), n))
    };
    Ahead {
        displacement: rows(&|l, r, n| of(l, r, n, |ahead| &ahead.displacement)),
        scaled_velocity: rows(&|l, r, n| of(l, r, n, |ahead| &ahead.scaled_velocity)),
        force: rows(&|l, r, s| of(l, r, s, |ahead| &ahead.force)),
        external: rows(&|l, r, x| of(l, r, x, |ahead| &ahead.external)),
    }
}

/// One direction's part of [`Ahead`], of one simulation.
struct LookAhead {
    displacement: Vec<f64>,
    scaled_velocity: Vec<f64>,
    force: Vec<f64>,
    external: Vec<f64>,
}

impl LookAhead {
    fn new<const R: usize>(problem: &Problem, prepared: &Prepared<R>, r: usize) -> Self {
        let lead = 1.0 + problem.contact_constants().damping_time_s / prepared.scales.half_step_s;
        let (line, factors) = (problem.model.mesh[r].as_slice(), &prepared.factors);
        let of_modes = |f: &dyn Fn(usize) -> f64| (0..line.len()).map(f).collect::<Vec<f64>>();
        let displacement = of_modes(&|n| line[n] * (1.0 - lead * factors.restore[n]));
        let scaled_velocity = of_modes(&|n| line[n] * (lead * factors.keep[n] - (lead - 1.0)));
        let force = |s: usize| {
            let push = prepared.push(problem, s);
            sum(&displacement, &push) + sum(&scaled_velocity, &push) + lead * factors.compliance[(r, s)]
        };
        let external = externals(prepared).map(|external| lead * sum(line, &prepared.share(external)));
        Self {
            force: (0..problem.model.mesh.len()).map(force).collect(),
            external: external.to_vec(),
            displacement,
            scaled_velocity,
        }
    }
}

/// Lines the first states of `L` simulations up.
///
/// # Arguments
/// * `coefficients` - of the steps
/// * `first` - of each
/// * `external` - externals at the first sample
pub(super) fn state<const L: usize, const N: usize, const R: usize>(
    coefficients: &Coefficients<L, N, R>,
    first: &[FirstState<R>; L],
    external: [Lanes<L>; EXTERNALS],
) -> State<L, N, R> {
    let displacement = modal(&|l| &first[l].displacement);
    let scaled_velocity = modal(&|l| &first[l].scaled_velocity);
    let force = items(&|l, r| first[l].force[r]);
    let motion = [&displacement, &scaled_velocity];
    State {
        ahead: items(&|l, r| coefficients.ahead_at_start(r, l, motion, &force)),
        displacement,
        scaled_velocity,
        force,
        external,
        entry: std::array::from_fn(|l| first[l].entry),
    }
}
