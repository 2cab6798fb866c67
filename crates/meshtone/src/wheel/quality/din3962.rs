//! Profile errors by the grades of DIN 3962.
//!
//! Each tooth's error is a line of the profile angle deviation f_Hα plus a wave of the profile
//! form deviation f_fα plus roughness, after the manual of the published model and DIN 3962.

use crate::error_table::ErrorTable;
use crate::random::{Draws, Purpose};
use crate::wheel::{ERROR_POINTS, Teeth, WheelName};

/// (µm) f_Hα of grades 1 to 12.
const ANGLE_DEVIATION_UM: [f64; 12] = [1.0, 1.5, 2.0, 3.0, 4.5, 6.0, 9.0, 12.0, 18.0, 28.0, 45.0, 71.0];
/// (µm) f_fα of grades 1 to 12.
const FORM_DEVIATION_UM: [f64; 12] = [1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 11.0, 16.0, 22.0, 36.0, 56.0, 90.0];
/// (µm) Half width of the uniform roughness of grades 1 to 12.
const ROUGHNESS_UM: [f64; 12] = [0.02, 0.04, 0.06, 0.08, 0.10, 0.20, 0.30, 0.40, 0.60, 1.00, 1.50, 2.30];

/// Waves along the flank, below and from 20 teeth on.
const WAVES: [f64; 2] = [2.5, 3.5];
/// Relative half width of the draws of f_Hα, f_fα and the number of waves.
const SPREAD: f64 = 0.1;

/// Tolerances of one grade.
pub(super) struct Grade {
    angle_deviation_mm: f64,
    form_deviation_mm: f64,
    roughness_mm: f64,
}

impl Grade {
    /// The tolerances of grade 1 to 12; none for 0 (ideal).
    pub(super) fn new(grade: u8) -> Option<Self> {
        let index = usize::from(grade).checked_sub(1)?;
        Some(Self {
            angle_deviation_mm: ANGLE_DEVIATION_UM.get(index)? * 1e-3,
            form_deviation_mm: FORM_DEVIATION_UM.get(index)? * 1e-3,
            roughness_mm: ROUGHNESS_UM.get(index)? * 1e-3,
        })
    }

    /// (mm) Errors of every tooth of a wheel, 100 × teeth.
    pub(super) fn draw(&self, teeth: &Teeth, name: WheelName, seed: u64) -> ErrorTable {
        let (wheel, first) = (teeth.wheel(name), teeth.initial_contact_radius_mm(name));
        let purpose = name.choose(Purpose::PinionProfileErrors, Purpose::GearProfileErrors);
        let last = (ERROR_POINTS - 1) as f64;
        let path = |k: usize| wheel.curvature_mm(first + (wheel.tip_radius_mm - first) * k as f64 / last);
        let (path_start, path_end) = (path(0), path(ERROR_POINTS - 1));
        let waves = if wheel.teeth < 20 { WAVES[0] } else { WAVES[1] };
        let mut errors = ErrorTable::filled(ERROR_POINTS, wheel.teeth as usize, 0.0);
        for tooth in 0..errors.teeth() {
            let mut draws = Draws::new(seed, purpose, tooth as u64);
            let mut around = |nominal: f64| draws.uniform(nominal, SPREAD * nominal);
            let angle_deviation = around(self.angle_deviation_mm);
            let form_deviation = around(self.form_deviation_mm);
            let waves = around(waves);
            let phase = draws.uniform(0.0, std::f64::consts::PI);
            for k in 0..ERROR_POINTS {
                let s = (path(k) - path_start) / (path_end - path_start);
                let wave = (2.0 * std::f64::consts::PI * waves * s + phase).sin();
                // The driving wheel's teeth pass through contact from root to tip, the driven one's from tip to root.
                let row = name.choose(k, ERROR_POINTS - 1 - k);
                errors[(row, tooth)] =
                    angle_deviation * s + 0.5 * form_deviation * wave + draws.uniform(0.0, self.roughness_mm);
            }
        }
        errors
    }
}
