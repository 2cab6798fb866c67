//! A pit on the gear's flank, with the positions at which it is in contact.

use crate::damage::{Pit, PitCircle, cut_flank};
use crate::error::ScenarioError;
use crate::wheel::Teeth;

/// A pit's place and the flank with the pit cut into it.
///
/// # Errors
/// As [`cut_flank`].
pub(super) fn pit_on_gear(given: &PitCircle, teeth: &Teeth) -> Result<(Pit, Vec<f64>), ScenarioError> {
    let (profile, contact) = (&teeth.gear_profile, &teeth.contact);
    // The published positions are uniform in x.
    let (x_contact, x_tip) = (profile.x_mm[contact.initial_contact_index], profile.tip_x_mm());
    let position = |i: usize| contact.span_rev * (profile.x_mm[i] - x_tip) / (x_contact - x_tip);
    cut_flank(given, profile, contact.initial_contact_index, two_nearest, position)
}

/// The two samples of the half circle that are nearest to the flank. Where the second directly follows the first, the published code
/// drops the first and takes the next.
fn two_nearest(above: &[f64]) -> (usize, usize) {
    let mut order: Vec<usize> = (0..above.len()).collect();
    order.sort_by(|&i, &j| above[i].abs().total_cmp(&above[j].abs()));
    let (a, b) = if order[1] == order[0] + 1 { (order[1], order[2]) } else { (order[0], order[1]) };
    (a.min(b), a.max(b))
}
