//! How severe a damage is: from 0, none, to 1, the largest that the tooth allows, whatever its kind.

use super::Kind;
use crate::keys::rows_but;
use crate::wheel::{Teeth, ToothProfile, WheelName};

/// (-) Part of a flank's length or of a face's width that the largest damage takes: the rest is what a pit needs beside it for its
/// edges.
pub(super) const LARGEST: f64 = 0.9;
/// Points of the profile that a cut must have to be seen.
const FEWEST_POINTS: f64 = 8.0;

/// The sound tooth that a severity is about.
pub(crate) struct SoundTooth<'a> {
    pub(super) profile: &'a ToothProfile,
    /// Profile index where contact starts at the root side.
    pub(super) first_contact: usize,
    pub(super) face_width_mm: f64,
    /// (mm) From root to tip circle.
    pub(super) height_mm: f64,
}

impl<'a> SoundTooth<'a> {
    /// A tooth of one of the two wheels.
    pub(super) fn new(teeth: &'a Teeth, wheel: WheelName) -> Self {
        let of_wheel = teeth.section(wheel);
        Self {
            profile: teeth.profile(wheel),
            first_contact: teeth.initial_contact_index(wheel),
            face_width_mm: of_wheel.face_width_mm,
            height_mm: (of_wheel.tip_radius_mm - of_wheel.root_radius_mm).abs(),
        }
    }

    /// (mm) Height of the flank's part in contact, along the tooth's centre line.
    pub(super) fn contact_height_mm(&self) -> f64 {
        self.profile.tip_x_mm() - self.profile.x_mm[self.first_contact]
    }

    /// (mm) Length of the flank's part in contact, along the flank.
    pub(super) fn contact_length_mm(&self) -> f64 {
        let (x, y) = (&self.profile.x_mm, &self.profile.y_mm);
        (self.first_contact + 1..x.len()).map(|i| (x[i] - x[i - 1]).hypot(y[i] - y[i - 1])).sum()
    }

    /// (mm) Half the thickness of the tooth where it is thinnest in contact.
    pub(super) fn least_half_thickness_mm(&self) -> f64 {
        self.profile.y_mm[self.first_contact..].iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Whether it is a tooth of a ring, whose flank is concave and whose x are less than 0.
    pub(super) fn is_concave(&self) -> bool {
        self.profile.tip_x_mm() < 0.0
    }

    /// Number of steps between the profile's points along the part in contact.
    pub(super) fn contact_steps(&self) -> f64 {
        (self.profile.len() - 1 - self.first_contact) as f64
    }

    /// Whether the profile's points can show a piece of the flank's part in contact, by its fraction of it.
    pub(super) fn shows(&self, fraction: f64) -> bool {
        fraction * self.contact_steps() >= FEWEST_POINTS
    }
}

/// A damage without sizes of its own: those of its kind's example stand in their place and do not count.
pub(super) fn without_sizes<K: Kind>(damage: &K) -> K {
    let mut without = K::example();
    rows_but::<K>(K::SIZES).iter().for_each(|row| row.copy(damage, &mut without));
    without
}
