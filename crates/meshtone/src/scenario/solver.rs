//! Sampling, length, settling and initial state.

/// How the equations of motion are solved.
#[derive(Debug, Clone, PartialEq)]
pub struct Solver {
    /// (S/s) Nominal sampling rate; the actual one is the next that divides both shafts'
    /// revolutions. Default 1e5.
    pub sampling_rate_hz: f64,
    /// (-) Part of `2 z_g` pinion revolutions that is simulated first and discarded. Default 0.5.
    pub settle_fraction: f64,
    /// (-) How far the transient of the slowest mode must have decayed where the kept signal starts: `corrected` starts
    /// in the static equilibrium of the loaded mesh, and leaves out what is not needed for that. 0 for
    /// the whole settling. Default 1e-6.
    pub settle_tolerance: f64,
    /// (m, rad) Initial displacement of the 13 coordinates. Default 0 under `published`, the static
    /// equilibrium of the loaded mesh under `corrected`.
    pub initial_displacement: Option<[f64; 13]>,
    /// (m/s, rad/s) Initial velocity of the 13 coordinates. Default the rigid rotation.
    pub initial_velocity: Option<[f64; 13]>,
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            sampling_rate_hz: 1e5,
            settle_fraction: 0.5,
            settle_tolerance: 1e-6,
            initial_displacement: None,
            initial_velocity: None,
        }
    }
}
