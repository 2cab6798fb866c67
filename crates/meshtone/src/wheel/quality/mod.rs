//! Manufacturing errors of the tooth profiles.

mod deviations;
mod din3962;
mod errors;
mod measured;
mod rules;
mod tolerances;

pub use crate::error_table::ErrorTable;
pub use deviations::{Deviations, RunOut, deviations};
pub(crate) use errors::file_deviations;
pub use errors::{ERROR_POINTS, ProfileErrors, Quality};
pub(crate) use measured::DEVIATION_KEYS;
pub use measured::WheelDeviations;
pub(crate) use rules::{check_errors, ignored_shares, one_source};
pub use tolerances::Tolerances;

use super::{Teeth, Wheel, WheelName};

/// The profile errors of both wheels: those given by the user, or a draw by DIN 3962 grade; and given pitch deviations.
///
/// # Arguments
/// * `quality` - grade, or the errors themselves
/// * `teeth` - both wheels
/// * `seed` - of the draw, unless `quality` has its own
///
/// Returns `None` for ideal teeth.
pub fn profile_errors(quality: &Quality, teeth: &Teeth, seed: u64) -> Option<ProfileErrors> {
    let flanks = quality.profile_errors.clone().or_else(|| drawn_profiles(quality, teeth, seed));
    with_given_pitches(flanks, quality, teeth)
}

/// Profile errors with the pitch deviations that are given: along the line of action, by the cosine of the pressure angle.
fn with_given_pitches(
    flanks: Option<ProfileErrors>,
    quality: &Quality,
    teeth: &Teeth,
) -> Option<ProfileErrors> {
    let given = WheelName::BOTH.map(|wheel| given_pitches_mm(quality, teeth.wheel(wheel), wheel));
    if given.iter().all(Option::is_none) {
        return flanks;
    }
    let [pinion, gear] = WheelName::BOTH.map(|wheel| teeth.wheel(wheel).teeth as usize);
    let mut flanks = flanks.unwrap_or_else(|| ProfileErrors {
        pinion_profile_errors_mm: ErrorTable::filled(ERROR_POINTS, pinion, 0.0),
        gear_profile_errors_mm: ErrorTable::filled(ERROR_POINTS, gear, 0.0),
    });
    let tables = [&mut flanks.pinion_profile_errors_mm, &mut flanks.gear_profile_errors_mm];
    for (table, pitches_mm) in tables.into_iter().zip(given) {
        for (tooth, pitch_mm) in pitches_mm.iter().flatten().enumerate() {
            (0..table.points()).for_each(|point| table[(point, tooth)] += pitch_mm);
        }
    }
    Some(flanks)
}

/// (mm) Given pitch deviations along the line of action.
fn given_pitches_mm(quality: &Quality, wheel: &Wheel, name: WheelName) -> Option<Vec<f64>> {
    let cos = wheel.pressure_angle_rad.cos();
    let pitches_um = quality.given(name).cumulative_pitch_um.as_ref()?;
    Some(pitches_um.iter().map(|pitch_um| pitch_um * 1e-3 * cos).collect())
}

/// A draw by DIN 3962 grade; none for ideal teeth.
fn drawn_profiles(quality: &Quality, teeth: &Teeth, seed: u64) -> Option<ProfileErrors> {
    let grade = din3962::Grade::new(quality.din_grade)?;
    let seed = quality.seed.unwrap_or(seed);
    Some(ProfileErrors {
        pinion_profile_errors_mm: grade.draw(teeth, WheelName::Pinion, seed),
        gear_profile_errors_mm: grade.draw(teeth, WheelName::Gear, seed),
    })
}
