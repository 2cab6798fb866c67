//! Stage 3: manufacturing errors of the tooth profiles.

mod deviations;
mod din3962;
mod errors;
mod rules;
mod tolerances;

pub use crate::error_table::ErrorTable;
pub use deviations::{Deviations, RunOut, deviations};
pub use errors::{ERROR_POINTS, ProfileErrors, Quality};
pub use tolerances::Tolerances;

use super::Teeth;
use crate::random::Purpose;

/// The profile errors of both wheels: those given by the user, or a draw by DIN 3962 grade.
///
/// # Arguments
/// * `quality` - grade, or the errors themselves
/// * `teeth` - both wheels
/// * `seed` - of the draw, unless `quality` has its own
///
/// Returns `None` for ideal teeth.
pub fn profile_errors(quality: &Quality, teeth: &Teeth, seed: u64) -> Option<ProfileErrors> {
    if quality.profile_errors.is_some() {
        return quality.profile_errors.clone();
    }
    let grade = din3962::Grade::new(quality.din_grade)?;
    let seed = quality.seed.unwrap_or(seed);
    let pinion_radius = teeth.contact.pinion_initial_radius_mm;
    let gear_radius = teeth.contact.gear_initial_radius_mm;
    Some(ProfileErrors {
        pinion_profile_errors_mm: grade.draw(
            &teeth.pinion,
            pinion_radius,
            seed,
            Purpose::PinionProfileErrors,
            din3962::Order::RootToTip,
        ),
        gear_profile_errors_mm: grade.draw(
            &teeth.gear,
            gear_radius,
            seed,
            Purpose::GearProfileErrors,
            din3962::Order::TipToRoot,
        ),
    })
}
