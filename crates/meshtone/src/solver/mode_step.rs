//! How one mode is stepped: which method of Newmark's family, and with which constants.
//!
//! Over a step Δt the mode `q̈ + c q̇ + k q = p` obeys, in all methods with γ = ½,
//! `q₁ = q₀ + Δt q̇₀ + Δt² ((½ − β) q̈₀ + β q̈₁)` and `q̇₁ = q̇₀ + ½ Δt (q̈₀ + q̈₁)`.
//!
//! β = 1/12 is the method of Fox and Goodwin: its error in frequency falls with the fourth power of the step, that of β = ¼ with the
//! second. It is stable as long as `ω Δt < √6`, whereas β = ¼ is stable always, and so holds the modes that a step cannot resolve.
//!
//! Of either method, k and c are replaced by those with which the *steps* of the free mode decay and turn exactly as the mode itself
//! does, and p is scaled as k, so that the deflection under a constant load stays. So what the step falsifies is only the answer to a
//! force that changes within it.
//!
//! Sources: L. Fox and E. T. Goodwin, "Some new methods for the numerical integration of ordinary differential equations",
//! Proceedings of the Cambridge Philosophical Society 45 (1949); T. J. R. Hughes, *The Finite Element Method* (2000), chapter 9, for
//! stability and period errors; R. E. Mickens, *Nonstandard Finite Difference Models of Differential Equations* (1994), for
//! constants that make steps exact.

use meshtone_fourier::Complex64;

use super::modal::ModalMachine;
use crate::mesh::MeshLaw;

/// (-) β of Fox and Goodwin.
const FOX_GOODWIN: f64 = 1.0 / 12.0;
/// (-) β of the average acceleration.
const AVERAGE_ACCELERATION: f64 = 0.25;

/// (rad) Turn of a mode in a step above which it counts as unresolved: less than 2.6 samples in a period.
const MOST_RESOLVED_RAD: f64 = 2.4;

/// (-) Part of the limit of stability that a mesh which closes may use up.
const STABLE_PART: f64 = 0.8;

/// The constants with which a mode is stepped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StepOfMode {
    /// (-) β.
    pub(super) beta: f64,
    /// (-) The factor of the modal force.
    pub(super) force_factor: f64,
    /// (-) `Δt² k` as it is stepped.
    stiffness: f64,
    /// (-) `Δt c` as it is stepped.
    damping: f64,
}

impl ModalMachine {
    /// How each mode is stepped.
    ///
    /// A mesh that closes couples the modes. The steps are stable if `Δt² K` with the closed mesh, over the modes with β = 1/12, lies
    /// below 6: for one line of action B and the mesh's stiffness k_m, if `Σ k_m Δt² B_n²/(6 − Δt² k_n) < 1` over these modes. Where
    /// that is not so, all modes that the mesh reaches are stepped with β = ¼.
    ///
    /// # Arguments
    /// * `laws` - of each mesh
    /// * `step_s` - (s) Δt
    pub(super) fn steps(&self, laws: &[MeshLaw], step_s: f64) -> Vec<StepOfMode> {
        let modes = || self.stiffness.iter().zip(&self.damping);
        let of_mode = |(&stiffness, &damping): (&f64, &f64)| {
            if stiffness.sqrt() * step_s < MOST_RESOLVED_RAD {
                StepOfMode::fitted(stiffness, damping, step_s, FOX_GOODWIN)
            } else {
                StepOfMode::plain(stiffness, damping, step_s, AVERAGE_ACCELERATION)
            }
        };
        let mut steps: Vec<StepOfMode> = modes().map(of_mode).collect();
        for (line, law) in self.lines.iter().zip(laws) {
            let mesh_stiffness = step_s * step_s * law.most_stiffness_n_per_m();
            let used_up = |line: &Vec<f64>| -> f64 {
                let term = |(step, line): (&StepOfMode, &f64)| match step.beta {
                    FOX_GOODWIN => mesh_stiffness * step.force_factor * line * line / (6.0 - step.stiffness),
                    _ => 0.0,
                };
                steps.iter().zip(line).map(term).sum()
            };
            if line.extremes().iter().any(|line| used_up(line) > STABLE_PART) {
                for (n, (&stiffness, &damping)) in modes().enumerate() {
                    if steps[n].beta == FOX_GOODWIN
                        && (line.at_middle[n] != 0.0
                            || line.to_end.as_ref().is_some_and(|to_end| to_end[n] != 0.0))
                    {
                        steps[n] = StepOfMode::fitted(stiffness, damping, step_s, AVERAGE_ACCELERATION);
                    }
                }
            }
        }
        steps
    }
}

impl StepOfMode {
    /// The mode's own constants.
    fn plain(stiffness: f64, damping: f64, step_s: f64, beta: f64) -> Self {
        Self { beta, force_factor: 1.0, stiffness: stiffness * step_s * step_s, damping: damping * step_s }
    }

    /// Constants with which the free mode's steps are exact.
    ///
    /// The steps `z` of the free mode solve `(1 + ½C + βK) z² − (2 − (1 − 2β) K) z + (1 − ½C + βK) = 0`, with K = Δt² k and C = Δt c;
    /// those of the mode itself have the product `e^(−C)` and a sum in which its frequency stands.
    fn fitted(stiffness: f64, damping: f64, step_s: f64, beta: f64) -> Self {
        let own = Self::plain(stiffness, damping, step_s, beta);
        if stiffness == 0.0 {
            return own;
        }
        let product = (-own.damping).exp();
        let square = own.stiffness - own.damping * own.damping / 4.0;
        let turn = if square < 0.0 { (-square).sqrt().cosh() } else { square.sqrt().cos() };
        // Half of the sum, over half of 1 and the product.
        let mean = 2.0 * (-own.damping / 2.0).exp() * turn / (1.0 + product);
        let fitted = 2.0 * (1.0 - mean) / (1.0 - 2.0 * beta + 2.0 * beta * mean);
        let loss = 2.0 * (1.0 + beta * fitted) * (1.0 - product) / (1.0 + product);
        Self { beta, force_factor: fitted / own.stiffness, stiffness: fitted, damping: loss }
    }

    /// (-) A mode's own rate over that which the steps make of its free vibration.
    pub(super) fn rate_factor(&self) -> f64 {
        // The steps turn by θ with `2 − 2 cos θ = K/(1 + βK)`, and their rate is that of the trapezium rule.
        let turn_rad = (1.0 - self.stiffness / (2.0 * (1.0 + self.beta * self.stiffness))).max(-1.0).acos();
        if turn_rad == 0.0 {
            return 1.0;
        }
        2.0 * turn_rad * (turn_rad / 2.0).tan() / self.stiffness
    }

    /// (-) `E = 1/(1 + ½ Δt c + β Δt² k)`: acceleration at a step's end per force that nothing yields to.
    pub(super) fn yielding(&self) -> f64 {
        1.0 / (1.0 + self.damping / 2.0 + self.beta * self.stiffness)
    }

    /// (-) Change of `Δt² q̈` at a step's end per displacement that is predicted for it.
    pub(super) fn of_displacement(&self) -> f64 {
        -self.stiffness * self.yielding()
    }

    /// (-) The same per predicted `Δt q̇`.
    pub(super) fn of_velocity(&self) -> f64 {
        -self.damping * self.yielding()
    }

    /// `Δt² q̈` of a state, as the steps have it.
    ///
    /// # Arguments
    /// * `displacement`, `scaled_velocity` - q and `Δt q̇`
    /// * `scaled_force` - `Δt² p`, with its factor
    pub(super) fn acceleration(&self, displacement: f64, scaled_velocity: f64, scaled_force: f64) -> f64 {
        scaled_force - self.damping * scaled_velocity - self.stiffness * displacement
    }

    /// What the steps make of a steady sine: displacement, `Δt q̇` and `Δt² q̈` per `Δt²` times the modal force.
    ///
    /// # Arguments
    /// * `sine` - the sine
    pub(super) fn answer(&self, sine: &SampledSine) -> [Complex64; 3] {
        let acceleration = sine.second_difference / (1.0 + self.beta * sine.second_difference);
        let velocity = Complex64::new(0.0, sine.velocity) * acceleration;
        let displacement = self.force_factor / (acceleration + self.stiffness + velocity * self.damping);
        [displacement, displacement * velocity, displacement * acceleration / self.force_factor]
    }
}
/// A steady sine at equal times, `z^n` with `z = exp(jωΔt)`.
pub(super) struct SampledSine {
    /// `z − 2 + 1/z`.
    second_difference: f64,
    /// Imaginary part of `½ (z + 1)/(z − 1)`, which is `Δt q̇` per `Δt² q̈`.
    velocity: f64,
}

impl SampledSine {
    /// # Arguments
    /// * `turn_rad` - (rad) ω Δt, between 0 and π
    pub(super) fn new(turn_rad: f64) -> Self {
        Self { second_difference: 2.0 * turn_rad.cos() - 2.0, velocity: -0.5 / (turn_rad / 2.0).tan() }
    }
}
