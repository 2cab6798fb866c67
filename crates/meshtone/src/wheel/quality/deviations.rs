//! Deviations of a wheel's teeth as one tool and one machine make them: mostly alike.

use std::f64::consts::{PI, TAU};

use super::tolerances::Tolerances;
use super::{ERROR_POINTS, ProfileErrors, Quality, given_pitches_mm, with_given_pitches};
use crate::error_table::ErrorTable;
use crate::random::{Draws, Purpose};
use crate::wheel::{Teeth, Wheel, WheelName};

/// Deviations of the teeth of both wheels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Deviations {
    /// Of each tooth's flank, its pitch deviation included; none for ideal ones.
    pub flanks: Option<ProfileErrors>,
    /// Of each wheel as a whole: the pinion's and the gear's.
    pub run_out: [RunOut; 2],
    /// (µm) Helix slope deviation over the face width, of the pinion and of the gear; positive where metal is added towards
    /// positive z.
    pub helix_slope_um: [f64; 2],
}

impl Deviations {
    /// The same where another tooth of the gear is the first, as of a ring that meets a planet elsewhere.
    ///
    /// # Arguments
    /// * `first` - number of that tooth, from 0
    pub(crate) fn counted_from(mut self, first: usize) -> Self {
        if let (Some(flanks), 1..) = (&mut self.flanks, first) {
            let of_gear = &flanks.gear_profile_errors_mm;
            let teeth = of_gear.teeth();
            self.run_out[1].phase_rad += TAU * first as f64 / teeth as f64;
            flanks.gear_profile_errors_mm = ErrorTable::from_fn(of_gear.points(), teeth, |point, tooth| {
                of_gear[(point, (tooth + first) % teeth)]
            });
        }
        self
    }
}

/// Run-out of a wheel: its teeth sit on a circle beside its axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct RunOut {
    /// (µm) The run-out F_r, from the least to the largest deviation along the line of action.
    pub run_out_um: f64,
    /// (rad) Phase at the start of the simulation.
    pub phase_rad: f64,
}

impl RunOut {
    /// (mm) Amplitude along the line of action, half of the run-out.
    pub fn amplitude_mm(&self) -> f64 {
        self.run_out_um * 1e-3 / 2.0
    }
}

/// Waves of the profile form deviation along the flank.
const WAVES: f64 = 3.0;

/// The deviations of both wheels, drawn within their tolerances.
///
/// The slope and form deviation of a tooth are a part common to the wheel and a part of its own, `quality.tooth_share` of the
/// tolerance; pitches are off at random by `quality.pitch_share` of f_p, each wheel runs out by `quality.run_out_share` of F_r and
/// has a helix slope within `quality.helix_share` of f_Hβ. What is given stands in place of what would be drawn.
///
/// # Arguments
/// * `quality` - grade and shares
/// * `teeth` - both wheels
/// * `seed` - of the draw, unless `quality` has its own
pub fn deviations(quality: &Quality, teeth: &Teeth, seed: u64) -> Deviations {
    let mut deviations = drawn(quality, teeth, seed).unwrap_or_else(|| Deviations {
        flanks: with_given_pitches(quality.profile_errors.clone(), quality, teeth),
        ..Deviations::default()
    });
    for wheel in WheelName::BOTH {
        let (given, place) = (quality.given(wheel), wheel as usize);
        let RunOut { run_out_um, phase_rad } = &mut deviations.run_out[place];
        // Measured pitches have the run-out in them.
        let otherwise_um = if given.cumulative_pitch_um.is_some() { 0.0 } else { *run_out_um };
        *run_out_um = given.run_out_um.unwrap_or(otherwise_um);
        *phase_rad = given.run_out_phase_rad.unwrap_or(*phase_rad);
        let helix_slope_um = &mut deviations.helix_slope_um[place];
        *helix_slope_um = given.helix_slope_um.unwrap_or(*helix_slope_um);
    }
    deviations
}

/// A draw by grade or class; none where profile errors are given or teeth are ideal.
fn drawn(quality: &Quality, teeth: &Teeth, seed: u64) -> Option<Deviations> {
    if quality.profile_errors.is_some() {
        return None;
    }
    let tolerances = |wheel: &Wheel| match (quality.iso_class, quality.din_grade) {
        (0, 0) => None,
        (0, grade) => Some(Tolerances::din_3961(wheel, grade)),
        (class, _) => Some(Tolerances::iso_1328(wheel, class)),
    };
    let seed = quality.seed.unwrap_or(seed);
    let draw = |name: WheelName| {
        Some(Draw { quality, teeth, name, tolerances: tolerances(teeth.wheel(name))?, seed })
    };
    let (pinion, gear) = (draw(WheelName::Pinion)?, draw(WheelName::Gear)?);
    Some(Deviations {
        flanks: Some(ProfileErrors {
            pinion_profile_errors_mm: pinion.flanks(),
            gear_profile_errors_mm: gear.flanks(),
        }),
        run_out: [pinion.run_out(), gear.run_out()],
        helix_slope_um: [pinion.helix_slope_um(), gear.helix_slope_um()],
    })
}

struct Draw<'a> {
    quality: &'a Quality,
    teeth: &'a Teeth,
    name: WheelName,
    tolerances: Tolerances,
    seed: u64,
}

/// Sequence of the draws that a whole wheel shares: those of its teeth come after.
const COMMON: u64 = 0;
const RUN_OUT: u64 = 1;
const PITCH: u64 = 2;
const FIRST_TOOTH: u64 = 3;
/// Beyond any tooth's.
const HELIX: u64 = u64::MAX;
const WOBBLE: u64 = u64::MAX - 1;

impl Draw<'_> {
    fn draws(&self, index: u64) -> Draws {
        let purpose = self.name.choose(Purpose::PinionDeviations, Purpose::GearDeviations);
        Draws::new(self.seed, purpose, index)
    }

    fn run_out(&self) -> RunOut {
        let mut draws = self.draws(RUN_OUT);
        let phase_rad = draws.uniform(PI, PI);
        RunOut { run_out_um: self.quality.run_out_share * self.tolerances.run_out_um, phase_rad }
    }

    fn helix_slope_um(&self) -> f64 {
        self.draws(HELIX).uniform(0.0, self.quality.helix_share * self.tolerances.helix_slope_um)
    }

    /// (mm) Along the line of action, one a tooth: a walk of normal steps that closes, scaled so that the largest single pitch
    /// deviation is the share of f_p, and within F_p.
    fn pitches_mm(&self, wheel: &Wheel) -> Vec<f64> {
        let teeth = wheel.teeth as usize;
        let mut draws = self.draws(PITCH);
        let steps: Vec<f64> = (0..teeth).map(|_| draws.normal()).collect();
        let mean = steps.iter().sum::<f64>() / teeth as f64;
        let largest = steps.iter().map(|step| (step - mean).abs()).fold(f64::MIN_POSITIVE, f64::max);
        let single_mm = self.quality.pitch_share * self.tolerances.single_pitch_um * 1e-3 / largest;
        let mut place = 0.0;
        let mut places: Vec<f64> = steps
            .iter()
            .map(|step| {
                place += (step - mean) * single_mm;
                place
            })
            .collect();
        let (least, most) =
            places.iter().fold((f64::MAX, f64::MIN), |(least, most), p| (least.min(*p), most.max(*p)));
        let within =
            (self.tolerances.cumulative_pitch_um * 1e-3 / (most - least).max(f64::MIN_POSITIVE)).min(1.0);
        let cos = wheel.pressure_angle_rad.cos();
        places.iter_mut().for_each(|place| *place = (*place - (least + most) / 2.0) * within * cos);
        places
    }

    fn flanks(&self) -> ErrorTable {
        let wheel = self.teeth.wheel(self.name);
        let first = self.teeth.initial_contact_radius_mm(self.name);
        let share = self.quality.tooth_share;
        let (slope_mm, form_mm) =
            (self.tolerances.profile_slope_um * 1e-3, self.tolerances.profile_form_um * 1e-3);
        let mut common = self.draws(COMMON);
        let common_slope = common.uniform(0.0, 1.0 - share);
        let common_form = common.uniform(0.5, 0.5) * (1.0 - share);
        let phase = common.uniform(PI, PI);
        let pitches =
            given_pitches_mm(self.quality, wheel, self.name).unwrap_or_else(|| self.pitches_mm(wheel));
        let last = (ERROR_POINTS - 1) as f64;
        let rolled: Vec<f64> = (0..ERROR_POINTS)
            .map(|k| wheel.curvature_mm(first + (wheel.tip_radius_mm - first) * k as f64 / last))
            .collect();
        let along = |k: usize| (rolled[k] - rolled[0]) / (rolled[ERROR_POINTS - 1] - rolled[0]);
        let mut errors = ErrorTable::filled(ERROR_POINTS, wheel.teeth as usize, 0.0);
        for (tooth, pitch) in pitches.iter().enumerate() {
            let mut own = self.draws(FIRST_TOOTH + tooth as u64);
            let own_slope = own.uniform(0.0, share);
            let own_form = own.uniform(0.0, share);
            let own_phase = own.uniform(PI, PI);
            for k in 0..ERROR_POINTS {
                let s = along(k);
                let wave = |phase: f64| (TAU * WAVES * s + phase).sin() / 2.0;
                let row = self.name.choose(k, ERROR_POINTS - 1 - k);
                errors[(row, tooth)] = pitch
                    + slope_mm * (common_slope + own_slope) * (s - 0.5)
                    + form_mm * (common_form * wave(phase) + own_form * wave(own_phase));
            }
        }
        self.wobble(&mut errors, &pitches, along);
        errors
    }

    /// Adds the profile slope of a wheel whose hob or grinding wheel ran out: it varies once a revolution, `b s √3 x cos(2πk/z + φ)` of tooth k, with x
    /// from −1 to 1 along the profile and s the rms deviation of the profiles without the pitches. All profiles are then made smaller, so that
    /// their rms deviation stays as the class has it.
    fn wobble(&self, errors: &mut ErrorTable, pitches: &[f64], along: impl Fn(usize) -> f64) {
        let share = self.quality.slope_wobble;
        if share == 0.0 {
            return;
        }
        let row = |k: usize| self.name.choose(k, ERROR_POINTS - 1 - k);
        let squares = (0..pitches.len()).flat_map(|tooth| (0..ERROR_POINTS).map(move |k| (k, tooth)));
        let square = |(k, tooth): (usize, usize)| (errors[(row(k), tooth)] - pitches[tooth]).powi(2);
        let count = (pitches.len() * ERROR_POINTS) as f64;
        let rms_mm = (squares.map(square).sum::<f64>() / count).sqrt();
        let phase = self.draws(WOBBLE).uniform(PI, PI);
        // x² has the mean 1/3 and cos² 1/2, so that b adds b²/2 of the square of s.
        let smaller = 1.0 / (1.0 + share * share / 2.0).sqrt();
        for (tooth, pitch_mm) in pitches.iter().enumerate() {
            let angle = TAU * tooth as f64 / pitches.len() as f64 + phase;
            let slope_mm = share * rms_mm * 3f64.sqrt() * angle.cos();
            for k in 0..ERROR_POINTS {
                let profile_mm = errors[(row(k), tooth)] - pitch_mm + slope_mm * (2.0 * along(k) - 1.0);
                errors[(row(k), tooth)] = pitch_mm + smaller * profile_mm;
            }
        }
    }
}
