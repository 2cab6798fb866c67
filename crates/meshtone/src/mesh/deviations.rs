//! How the flanks of a mesh deviate from the ideal ones: profile errors of each tooth, and wheels that do not turn about their axes.

use std::f64::consts::TAU;

use super::gear_mesh::Mesh;
use crate::error_table::ErrorTable;
use crate::interpolation::NotAKnotSpline;
use crate::wheel::{ProfileErrors, RunOut, Teeth, WheelName};

/// The deviations of both wheels of a mesh.
pub struct PairDeviations<'a> {
    /// Both wheels.
    pub teeth: &'a Teeth,
    /// Profile errors of both wheels; none for ideal teeth.
    pub errors: Option<&'a ProfileErrors>,
    /// (m) Eccentricity of the pinion and of the gear.
    pub eccentricity_m: [f64; 2],
    /// Run-out of the pinion and of the gear.
    pub run_out: [RunOut; 2],
}

/// Deviations of all flanks of one wheel from their ideal profile.
pub(super) struct FlankErrors<'a> {
    /// (mm) Over the rows of the profile errors; one a tooth, none for ideal teeth.
    by_row: Vec<NotAKnotSpline<'a>>,
    rows: usize,
    wheel: WheelName,
    teeth: &'a Teeth,
}

impl<'a> FlankErrors<'a> {
    /// Of both wheels.
    pub(super) fn of_both(deviations: &PairDeviations<'a>) -> [Self; 2] {
        WheelName::BOTH.map(|wheel| {
            let table = deviations.errors.map(|errors| match wheel {
                WheelName::Pinion => &errors.pinion_profile_errors_mm,
                WheelName::Gear => &errors.gear_profile_errors_mm,
            });
            let teeth = table.into_iter().flat_map(ErrorTable::each_tooth);
            Self {
                by_row: teeth.map(|tooth| NotAKnotSpline::uniform(0.0, 1.0, tooth)).collect(),
                rows: table.map_or(2, ErrorTable::points),
                wheel,
                teeth: deviations.teeth,
            }
        })
    }

    /// (m) Deviation of a tooth where it is touched at a position of the path.
    pub(super) fn at_position_m(&self, tooth: usize, position: f64) -> f64 {
        self.by_row.get(tooth).map_or(0.0, |errors| errors.at(self.row(position)) * 1e-3)
    }

    /// (m) Deviations of every tooth at some positions of the path.
    pub(super) fn tabulate_at(&self, positions: impl Iterator<Item = f64>) -> Vec<Vec<f64>> {
        let rows: Vec<f64> = positions.map(|position| self.row(position)).collect();
        self.by_row.iter().map(|errors| rows.iter().map(|&row| errors.at(row) * 1e-3).collect()).collect()
    }

    /// Row of the profile errors, counted through, that is touched at `position` of the path of contact: rows are uniform
    /// in radius, from where contact starts to where it ends.
    fn row(&self, position: f64) -> f64 {
        let wheel = self.teeth.wheel(self.wheel);
        let first = match self.wheel {
            WheelName::Pinion => self.teeth.contact.pinion_initial_radius_mm,
            WheelName::Gear => self.teeth.contact.gear_initial_radius_mm,
        };
        let radius = self.teeth.path.curvature_mm(self.wheel, position).hypot(wheel.base_radius_mm);
        let from_root = ((radius - first) / (wheel.tip_radius_mm - first)).clamp(0.0, 1.0);
        let passed = if self.wheel == WheelName::Pinion { from_root } else { 1.0 - from_root };
        passed * (self.rows - 1) as f64
    }
}

/// Wheels whose teeth do not turn about their axes.
pub(super) struct Eccentricity {
    /// (m) Of each wheel, what goes with the sine of its angle and what with the cosine.
    sine_and_cosine_m: [[f64; 2]; 2],
}

impl Eccentricity {
    /// `±E sin(α + θ)` of a wheel that sits off its axis, and `F_r/2 sin(θ + φ)` of its run-out. None where all turn true.
    pub(super) fn of(deviations: &PairDeviations) -> Option<Self> {
        let PairDeviations { eccentricity_m, run_out, teeth, .. } = *deviations;
        let runs_out = run_out.iter().any(|run_out| run_out.run_out_um != 0.0);
        let (axis_sine, axis_cosine) = teeth.gear.working_pressure_angle_rad.sin_cos();
        let sine_and_cosine_m = WheelName::BOTH.map(|wheel| {
            let of_wheel_m = eccentricity_m[wheel as usize];
            let axis_m = if wheel == WheelName::Gear { of_wheel_m } else { -of_wheel_m };
            let amplitude_mm = run_out[wheel as usize].amplitude_mm();
            let (sine, cosine) = run_out[wheel as usize].phase_rad.sin_cos();
            [
                axis_m * axis_cosine + amplitude_mm * 1e-3 * cosine,
                axis_m * axis_sine + amplitude_mm * 1e-3 * sine,
            ]
        });
        (eccentricity_m != [0.0; 2] || runs_out).then_some(Self { sine_and_cosine_m })
    }

    /// (m) A deviation of all teeth of a wheel alike.
    ///
    /// # Arguments
    /// * `wheel` - which
    /// * `turns` - (rev) how far it has turned
    pub(super) fn of_wheel_m(&self, wheel: WheelName, turns: f64) -> f64 {
        let [with_sine, with_cosine] = self.sine_and_cosine_m[wheel as usize];
        let (sine, cosine) = (TAU * turns).sin_cos();
        with_sine * sine + with_cosine * cosine
    }

    /// Adds it to a wheel's teeth at every point of their contact, where a tooth is always at the same angle: that of the tooth
    /// and that of the point are added by the sines' theorem.
    pub(super) fn add_to(&self, tables_m: &mut [Vec<f64>], mesh: &Mesh, wheel: WheelName) {
        let [with_sine, with_cosine] = self.sine_and_cosine_m[wheel as usize];
        let pitch_rad = TAU / tables_m.len() as f64;
        let points: Vec<(f64, f64)> =
            (0..mesh.points()).map(|point| (pitch_rad * mesh.position(point)).sin_cos()).collect();
        for (tooth, table) in tables_m.iter_mut().enumerate() {
            let (sine, cosine) = (pitch_rad * tooth as f64).sin_cos();
            let with_point_cosine = with_sine * sine + with_cosine * cosine;
            let with_point_sine = with_sine * cosine - with_cosine * sine;
            for (deviation, (sine, cosine)) in table.iter_mut().zip(&points) {
                *deviation += with_point_cosine * cosine + with_point_sine * sine;
            }
        }
    }
}
