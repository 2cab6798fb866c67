//! This module says what is usual: limits of a trend from its first records, and the zones of ISO 20816-3.

use meshtone_io::indicators::{LimitEntry, RecordEntry};
use meshtone_plot::trend::Trend;

use super::results::Series;
use crate::choice::{Choice, name_of};

/// A machine's class and mounting, as ISO 20816-3 distinguishes them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Iso20816 {
    /// More than 300 kW, on a rigid support.
    LargeRigid,
    /// More than 300 kW, on a flexible support.
    LargeFlexible,
    /// From 15 to 300 kW, on a rigid support.
    MediumRigid,
    /// From 15 to 300 kW, on a flexible support.
    MediumFlexible,
}

/// Classes and mountings by their names.
pub const ISO_20816: [Choice<Iso20816>; 4] = [
    ("large-rigid", "More than 300 kW, rigid support", Iso20816::LargeRigid),
    ("large-flexible", "More than 300 kW, flexible support", Iso20816::LargeFlexible),
    ("medium-rigid", "15 to 300 kW, rigid support", Iso20816::MediumRigid),
    ("medium-flexible", "15 to 300 kW, flexible support", Iso20816::MediumFlexible),
];

impl Iso20816 {
    /// (mm/s) Rms of the velocity at the boundaries between the zones A and B, B and C, C and D: ISO 20816-3, annex A. The user compares them
    /// with the edition of the standard that applies.
    pub fn boundaries_mm_per_s(self) -> [f64; 3] {
        match self {
            Self::LargeRigid | Self::MediumFlexible => [2.3, 4.5, 7.1],
            Self::LargeFlexible => [3.5, 7.1, 11.0],
            Self::MediumRigid => [1.4, 2.8, 4.5],
        }
    }

    /// The zone of a velocity.
    pub fn zone(self, velocity_mm_per_s: f64) -> char {
        let above =
            self.boundaries_mm_per_s().iter().filter(|boundary| velocity_mm_per_s > **boundary).count();
        ['A', 'B', 'C', 'D'][above]
    }

    /// In words, with the boundaries.
    pub fn in_words(self) -> String {
        let [ab, bc, cd] = self.boundaries_mm_per_s();
        let name = name_of(&ISO_20816, self).unwrap_or_default();
        format!("ISO 20816-3, {name}: A/B {ab}, B/C {bc}, C/D {cd} mm/s")
    }
}

/// Gives indicators their limits, and says where each was crossed first.
///
/// # Arguments
/// * `series` - all records
/// * `trends` - the indicators, record by record
/// * `first` - records that are sound, of each wheel
pub fn set(series: &Series, trends: &mut [Trend], first: usize) -> Vec<LimitEntry> {
    let mut entries = Vec::new();
    for trend in trends {
        for (wheel, values) in series.wheels.iter().zip(&trend.values) {
            let limit = limit(&values[..first.min(values.len())]);
            trend.limits.push(limit);
            let Some(limit) = limit else { continue };
            let is_above =
                |(_, value): &(&RecordEntry, &Option<f64>)| value.is_some_and(|value| value > limit);
            let crossed = series.of(wheel).zip(values).skip(first).find(is_above);
            let crossed_at = crossed.map(|(record, _)| (record.recording, record.segment));
            let (wheel, indicator) = (wheel.name.clone(), trend.name.clone());
            entries.push(LimitEntry { wheel, indicator, limit, crossed_at });
        }
    }
    entries
}

/// Mean and three standard deviations; none where an indicator is not defined in all records.
fn limit(values: &[Option<f64>]) -> Option<f64> {
    let values: Vec<f64> = values.iter().copied().collect::<Option<_>>()?;
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    Some(mean + 3.0 * variance.sqrt()).filter(|limit| limit.is_finite())
}

#[cfg(test)]
mod tests {
    use super::{ISO_20816, Iso20816, limit};

    #[test]
    fn zones_and_limits() {
        let of = |velocity: f64| Iso20816::MediumRigid.zone(velocity);
        assert_eq!([0.5, 1.4, 1.5, 2.9, 4.6].map(of), ['A', 'A', 'B', 'C', 'D']);
        let bounds = ISO_20816.map(|(.., machine)| machine.boundaries_mm_per_s());
        assert_eq!(bounds, [[2.3, 4.5, 7.1], [3.5, 7.1, 11.0], [1.4, 2.8, 4.5], [2.3, 4.5, 7.1]]);
        assert_eq!(limit(&[Some(1.0), Some(2.0), Some(3.0)]), Some(5.0));
        assert_eq!(limit(&[Some(1.0), None]), None);
        assert_eq!(limit(&[Some(1.0)]), None);
    }
}
