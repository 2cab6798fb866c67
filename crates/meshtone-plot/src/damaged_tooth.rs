//! The turn of the damaged tooth within a revolution of its wheel.

use crate::axes::Axes;
use crate::canvas::Canvas;
use crate::legend::{Entry, Sample};
use crate::style::{Fill, colour};

const TINT: Fill = Fill::tint(colour::VERMILLION, 0.22);

/// The damaged tooth of a wheel whose revolution begins where that tooth enters contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DamagedTooth {
    /// (pitches) How far the wheel turns while the tooth is in contact: the contact ratio.
    pub contact_pitches: f64,
    /// Whether the whole tooth is gone.
    pub is_missing: bool,
}

impl DamagedTooth {
    /// Tints the part of the revolution in which the tooth is in contact, or would be.
    ///
    /// # Arguments
    /// * `canvas`, `axes` - where
    /// * `pitch` - one pitch in the unit of the horizontal axis
    pub(crate) fn tint(self, canvas: &mut Canvas, axes: &Axes, pitch: f64) {
        axes.band(canvas, 0.0, self.contact_pitches * pitch, TINT);
    }

    /// What the tint means.
    pub(crate) fn legend_entry(self) -> Entry<'static> {
        let text = if self.is_missing { "turn of the missing tooth" } else { "damaged tooth in contact" };
        Entry { sample: Sample::Area(TINT), text }
    }
}
