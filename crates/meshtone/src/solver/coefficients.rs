//! The coefficients of several simulations, side by side.

use super::integrate::Problem;
use super::prepare::{Prepared, externals, sum};
use super::shared_forcing::SharedForcing;
use super::step::{Coefficients, Norm, State};
use crate::simd::Lanes;

/// A value of each lane.
fn lanes<const L: usize>(f: impl FnMut(usize) -> f64) -> Lanes<L> {
    Lanes::from_fn(f)
}

/// Modal values of each lane; modes that a lane has not got are 0.
fn modal<'a, const L: usize, const N: usize>(of: impl Fn(usize) -> &'a [f64]) -> [Lanes<L>; N] {
    std::array::from_fn(|n| lanes(|l| of(l).get(n).copied().unwrap_or(0.0)))
}

/// As [`modal`], of values that are computed.
fn computed<const L: usize, const N: usize>(of: impl FnMut(usize) -> Vec<f64>) -> [Lanes<L>; N] {
    let values: [Vec<f64>; L] = std::array::from_fn(of);
    modal(|l| &values[l])
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
        keep: modal(|l| &prepared[l].factors.keep),
        restore: modal(|l| &prepared[l].factors.restore),
        push: std::array::from_fn(|r| computed(|l| prepared[l].push(problems[l], r))),
        external_push: std::array::from_fn(|x| computed(|l| prepared[l].share(externals(&prepared[l])[x]))),
        mesh: std::array::from_fn(|r| modal(|l| column(l, r))),
        angle: modal(|l| &prepared[l].angle),
        angle_push: std::array::from_fn(|r| {
            lanes(|l| sum(&prepared[l].angle, &prepared[l].push(problems[l], r)))
        }),
        compliance: std::array::from_fn(|r| {
            std::array::from_fn(|c| {
                lanes(|l| prepared[l].factors.compliance.get((r, c)).copied().unwrap_or(0.0))
            })
        }),
        static_deflection: std::array::from_fn(|r| lanes(|l| prepared[l].static_deflection[r])),
        static_angle: lanes(|l| prepared[l].static_angle),
        start: lanes(|l| problems[l].time.first_simulated_sample as f64),
        points_per_sample: lanes(|l| prepared[l].points_per_sample),
        norm: Norm {
            rigid_displacement: computed(|l| {
                let step_rad = model(l).rotation_rad_per_s * 2.0 * half_step(l);
                model(l).rigid_velocity.iter().map(|rigid| rigid * step_rad).collect()
            }),
            // K̂ r = k_p e_θp + (2/dt) C r + (4/dt²) M r, whatever the mesh stiffness.
            rigid_increment: computed(|l| {
                let (h, model) = (half_step(l), model(l));
                (0..model.modes())
                    .map(|n| {
                        let rigid = (2.0 * model.damping[n] + 2.0 / h) * model.rigid_velocity[n];
                        model.rotation_rad_per_s * (model.motor[n] * 2.0 * h + rigid)
                    })
                    .collect()
            }),
            external: std::array::from_fn(|x| modal(|l| externals(&prepared[l])[x])),
            twice_stiffness: computed(|l| {
                model(l).stiffness.iter().map(|stiffness| 2.0 * stiffness).collect()
            }),
            two_per_h2: lanes(|l| 2.0 / (half_step(l) * half_step(l))),
        },
    }
}

/// The first states of `L` simulations, side by side.
///
/// # Arguments
/// * `problems`, `prepared` - the simulations
/// * `forcing` - forcing whose first sample is theirs
pub(super) fn first_states<const L: usize, const N: usize, const R: usize>(
    problems: &[&Problem; L],
    prepared: &[Prepared<R>; L],
    forcing: &SharedForcing<L, R>,
) -> State<L, N, R> {
    let first: [_; L] = std::array::from_fn(|l| {
        let errors = forcing.errors[0].map(|error| error.0[l]);
        let external = forcing.external[0].map(|external| external.0[l]);
        prepared[l].first_state(problems[l], &errors, &external, forcing.entries[0][l] as usize)
    });
    State {
        displacement: modal(|l| &first[l].displacement),
        scaled_velocity: modal(|l| &first[l].scaled_velocity),
        force: std::array::from_fn(|r| lanes(|l| first[l].force[r])),
        external: forcing.external[0],
        entry: std::array::from_fn(|l| first[l].entry),
    }
}
