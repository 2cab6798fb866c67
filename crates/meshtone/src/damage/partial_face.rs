//! A pit over a part of the face width, from one side.

use super::severity::{LARGEST, SoundTooth};

use super::damaged_tooth::{DamagedTooth, HealthyTooth};
use super::{DamageResult, Kind, PitCircle, ToothPart};
use crate::keys::{Check, Range, check_keys, field, flatten, keys, require};
use crate::wheel::Gears;

/// A pit over a part of the face width, from one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartialFace {
    /// (mm) Width of the pit along the face.
    pub width_mm: f64,
    /// The circle that is cut into the flank.
    pub pit: PitCircle,
}

keys! {
    PartialFace = Self { width_mm: f64::NAN, pit: PitCircle::start() }, chosen by pit;
    width_mm "mm" "the width of the pit along the face, from one side"
        .required_unless(&["severity"]).range(Range::positive()).rule("less than the face width");
    .. { flatten(field!(pit)) };
}

impl Kind for PartialFace {
    const NAME: &str = "partial-face";
    const TITLE: &str = "pit over part of the face";
    const MOVES_FORCES: bool = true;
    const PART: ToothPart = ToothPart::FlankLength;
    const SIZES: &[&str] = &["width_mm", "start", "end", "depth", "circle"];

    fn example() -> Self {
        Self { width_mm: 2.0, pit: PitCircle::example() }
    }

    /// As wide, of the face, as it is long, of the flank.
    fn of_severity(&self, severity: f64, tooth: &SoundTooth) -> Option<Self> {
        let part = LARGEST * severity.sqrt();
        let pit = PitCircle::of_length(part);
        tooth.shows(part).then_some(Self { width_mm: part * tooth.face_width_mm, pit })
    }

    /// Its area over the largest one's.
    fn severity(&self, tooth: &SoundTooth) -> f64 {
        let area = self.width_mm / tooth.face_width_mm * self.pit.length(tooth);
        (area / (LARGEST * LARGEST)).min(1.0)
    }

    fn check(&self, gears: &Gears) -> Check {
        check_keys(self, "fault")?;
        let problem = format!("must be less than {} mm, the face width", gears.face_width_mm);
        require("fault.width_mm", self.width_mm, self.width_mm < gears.face_width_mm, problem).map_err(
            |error| error.with_help("for a pit over the whole width, use kind = \"through-face\""),
        )?;
        self.pit.check_edges()
    }

    fn damage(&self, tooth: &mut DamagedTooth, healthy: &HealthyTooth) -> DamageResult {
        let (pit, flank_y_mm) = healthy.cut(&self.pit)?;
        for i in pit.start_index..=pit.end_index {
            tooth.corner_width_mm[i] = self.width_mm;
            tooth.corner_y_mm[i] = tooth.cut_y_mm(i, flank_y_mm[i], healthy.profile());
        }
        Ok(pit.describe::<Self>(self.width_mm, &flank_y_mm, healthy))
    }
}
