//! A pit over the whole face width: while the mate passes it, it turns about the pit's two edges.

use super::severity::{LARGEST, SoundTooth};

use super::damaged_tooth::{DamagedTooth, HealthyTooth};
use super::{DamageResult, Kind, PitCircle, ToothPart};
use crate::keys::{Check, check_keys, field, flatten, keys};
use crate::wheel::Gears;

/// A pit over the whole face width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThroughFace {
    /// The circle that is cut into the flank.
    pub pit: PitCircle,
}

keys! {
    ThroughFace = Self { pit: PitCircle::start() }, chosen by pit;
    .. { flatten(field!(pit)) };
}

impl Kind for ThroughFace {
    const NAME: &str = "through-face";
    const TITLE: &str = "pit over the whole face";
    const MOVES_FORCES: bool = true;
    const PART: ToothPart = ToothPart::FlankLength;
    const SIZES: &[&str] = &["start", "end", "depth", "circle"];

    fn example() -> Self {
        Self { pit: PitCircle::example() }
    }

    fn of_severity(&self, severity: f64, tooth: &SoundTooth) -> Option<Self> {
        let length = LARGEST * severity;
        tooth.shows(length).then_some(Self { pit: PitCircle::of_length(length) })
    }

    /// Its length over the largest one's.
    fn severity(&self, tooth: &SoundTooth) -> f64 {
        (self.pit.length(tooth) / LARGEST).min(1.0)
    }

    fn check(&self, _gears: &Gears) -> Check {
        check_keys(self, "fault")?;
        self.pit.check_edges()
    }

    fn damage(&self, tooth: &mut DamagedTooth, healthy: &HealthyTooth) -> DamageResult {
        let (pit, flank_y_mm) = healthy.cut(&self.pit)?;
        for i in pit.start_index..=pit.end_index {
            tooth.flank_y_mm[i] = tooth.cut_y_mm(i, flank_y_mm[i], healthy.profile());
            tooth.corner_y_mm[i] = tooth.flank_y_mm[i];
        }
        tooth.upper_edges.push(pit.end_index);
        Ok(pit.describe::<Self>(healthy.wheel().face_width_mm, &flank_y_mm, healthy))
    }
}
