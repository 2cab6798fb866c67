//! Everything about a simulation that does not change from step to step, and its first state.

use super::integrate::Problem;
use super::modal::ModalMachine;
use super::outputs::{EXTERNALS, OutputWeights, dot, external_forces};
use crate::mesh::{MeshLaw, PairsSample, deflection_at_rest};

/// The constants of one simulation's steps; the columns of all lines of action are counted through, mesh by mesh.
pub(super) struct Prepared {
    /// (s) h, half of the time step.
    pub(super) half_step_s: f64,
    /// (-) `2E` of each mode, `E = 1/(1 + 2ζω h + ω² h²)`.
    pub(super) keep: Vec<f64>,
    /// (-) `2 h² ω² E`.
    pub(super) restore: Vec<f64>,
    /// `h² E` times the modal force of each external.
    pub(super) external_push: [Vec<f64>; EXTERNALS],
    /// Each column of the lines of action.
    pub(super) columns: Vec<Column>,
    /// (m/N) Γ: deflection in each column per force of the step in each.
    pub(super) compliance: Vec<Vec<f64>>,
    /// The outputs.
    pub(super) outputs: Vec<OutputWeights>,
    /// The law of each mesh.
    pub(super) laws: Vec<MeshLaw>,
    /// (N) Force of each mesh under the constant loads.
    pub(super) static_force_n: Vec<f64>,
}

/// One column of a line of action, and what the deflection in it at the end of a step, with its damping's lead ℓ = 1 + τ/h, is without
/// the step's own force.
///
/// With the step's change S it is `D = B·(q₀ + ℓ S − (ℓ − 1) s₀)`, hence a sum over the modes of the state before. That state but
/// for its own force's share is known a step earlier. So the sum over the modes is made while that force is sought, and when it is
/// found only its product with one number is left: without that a step of a single simulation waits most of its time.
pub(super) struct Column {
    /// `h² E B`: a force's displacement in each mode.
    pub(super) push: Vec<f64>,
    /// (m) Deflection under the constant loads.
    pub(super) static_deflection: f64,
    /// `B (1 − 2ℓh²ω²E)`.
    pub(super) of_displacement: Vec<f64>,
    /// `B (2ℓE − ℓ + 1)`.
    pub(super) of_velocity: Vec<f64>,
    /// (m/N) Per force at the step's start in each column: its share in the state there, and `ℓ Γ`.
    pub(super) of_force: Vec<f64>,
    /// Per sum of an external at both ends of the step.
    pub(super) of_external: [f64; EXTERNALS],
}

/// State of the modes at the first sample.
pub(super) struct FirstState {
    pub(super) displacement: Vec<f64>,
    pub(super) scaled_velocity: Vec<f64>,
    /// (N) Force in each column.
    pub(super) force: Vec<f64>,
}

impl Prepared {
    /// The constants of a simulation.
    ///
    /// Follows the equations of [`super::step`]: the factors of each mode first, then what they make of a force in each column of the
    /// lines of action.
    pub(super) fn new(problem: &Problem) -> Self {
        let model = &problem.machine;
        let h = problem.time.step_s() / 2.0;
        let modes = model.modes();
        let e: Vec<f64> =
            (0..modes).map(|n| 1.0 / (1.0 + h * model.damping[n] + h * h * model.stiffness[n])).collect();
        let keep: Vec<f64> = e.iter().map(|e| 2.0 * e).collect();
        let restore: Vec<f64> = (0..modes).map(|n| 2.0 * h * h * model.stiffness[n] * e[n]).collect();
        let share: Vec<f64> = e.iter().map(|e| h * h * e).collect();
        let shared = |force: &[f64]| share.iter().zip(force).map(|(s, f)| s * f).collect::<Vec<f64>>();
        let external_push = external_forces(model).map(|force| shared(&force));
        let lines: Vec<(&[f64], f64)> = (model.lines.iter().zip(&problem.laws))
            .flat_map(|(line, law)| line.columns.iter().map(|column| (column.as_slice(), law.lead(h))))
            .collect();
        let pushes: Vec<Vec<f64>> = lines.iter().map(|(line, _)| shared(line)).collect();
        let compliance: Vec<Vec<f64>> = lines
            .iter()
            .map(|(line, _)| {
                let weighted: Vec<f64> = line.iter().zip(&share).map(|(line, share)| line * share).collect();
                lines.iter().map(|(other, _)| nalgebra_dot(&weighted, other)).collect()
            })
            .collect();
        let column = |r: usize| {
            let (line, lead) = lines[r];
            let of_modes = |f: &dyn Fn(usize) -> f64| (0..modes).map(|n| line[n] * f(n)).collect::<Vec<f64>>();
            let of_displacement = of_modes(&|n| 1.0 - lead * restore[n]);
            let of_velocity = of_modes(&|n| lead * keep[n] - (lead - 1.0));
            let of_force = pushes.iter().zip(&compliance[r]).map(|(push, compliance)| {
                dot(&of_displacement, push) + dot(&of_velocity, push) + lead * compliance
            });
            Column {
                push: pushes[r].clone(),
                static_deflection: dot(line, &model.static_displacement),
                of_force: of_force.collect(),
                of_external: external_push.each_ref().map(|push| lead * dot(line, push)),
                of_displacement,
                of_velocity,
            }
        };
        Self {
            half_step_s: h,
            columns: (0..lines.len()).map(column).collect(),
            outputs: problem.outputs.iter().map(|output| output.weights(model, h)).collect(),
            keep,
            restore,
            external_push,
            compliance,
            laws: problem.laws.clone(),
            static_force_n: model.lines.iter().map(|line| line.static_force_n).collect(),
        }
    }

    /// The state at the first simulated sample: with the given velocity, and the meshes closed at rest. All that deforms is then as
    /// under the constant loads, and the shafts that turn freely have turned until the pairs carry the load.
    ///
    /// # Arguments
    /// * `model` - the machine
    /// * `samples`, `lane` - the pairs of each mesh at that sample
    pub(super) fn first_state<const L: usize>(
        &self,
        model: &ModalMachine,
        samples: &[PairsSample<L>],
        lane: usize,
    ) -> FirstState {
        let scaled_velocity: Vec<f64> =
            model.initial_velocity.iter().map(|velocity| velocity * self.half_step_s).collect();
        // Column numbers of the lines of action of each mesh.
        let mut next = 0;
        let columns: Vec<std::ops::Range<usize>> = (model.lines.iter())
            .map(|line| {
                next += line.columns.len();
                next - line.columns.len()..next
            })
            .collect();
        let at_face_centre = |mesh: usize, of: &dyn Fn(usize) -> f64| {
            let z = samples[mesh].face_centre.0[lane];
            let tilted: f64 = columns[mesh].clone().skip(1).map(|column| z * of(column)).sum();
            (of(columns[mesh].start), tilted)
        };
        let missing: Vec<f64> = (self.laws.iter().enumerate())
            .map(|(mesh, law)| {
                let force_n = self.static_force_n[mesh].max(0.0);
                let closed = deflection_at_rest(law.contact, &samples[mesh], lane, force_n);
                let (at_rest, tilted) =
                    at_face_centre(mesh, &|column| self.columns[column].static_deflection);
                closed - at_rest - tilted
            })
            .collect();
        let displacement = model.turned_by(&missing);
        let lines: Vec<&Vec<f64>> = model.lines.iter().flat_map(|line| &line.columns).collect();
        let mut force = Vec::with_capacity(lines.len());
        for (mesh, law) in self.laws.iter().enumerate() {
            let (deflection, tilted) = at_face_centre(mesh, &|column| {
                self.columns[column].static_deflection + dot(lines[column], &displacement)
            });
            let lead = law.damping_time_s / self.half_step_s * dot(lines[columns[mesh].start], &scaled_velocity);
            let carried = law.force_n(&samples[mesh], lane, deflection + tilted + lead);
            let whole = self.static_force_n[mesh] - carried;
            force.push(whole);
            let z = samples[mesh].face_centre.0[lane];
            force.extend(columns[mesh].clone().skip(1).map(|_| z * (whole - self.static_force_n[mesh])));
        }
        FirstState { displacement, scaled_velocity, force }
    }
}

/// `Σ a_n b_n` in the order in which nalgebra sums.
fn nalgebra_dot(a: &[f64], b: &[f64]) -> f64 {
    nalgebra::DVectorView::from_slice(a, a.len()).dot(&nalgebra::DVectorView::from_slice(b, b.len()))
}
