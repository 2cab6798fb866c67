//! A pit over the whole face width: while the mate passes it, it turns about the pit's two edges.

use super::kind::MeshEffect;
use super::published::{self, FaultGeometry};
use super::severity::{LARGEST, SoundTooth};
use crate::wheel::Teeth;
use meshtone_toml::{ReadResult, TomlTable};

use super::DamageDescription;
use super::damaged_tooth::{DamagedTooth, HealthyTooth, RollingPit};
use super::{Kind, PitCircle};
use crate::error::ScenarioError;
use crate::keys::{Check, Keys, NumberFiles, Row, check_keys, field, flatten};
use crate::wheel::Gears;
use crate::wheel::ToothProfile;

/// A pit over the whole face width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThroughFace {
    /// The circle that is cut into the flank.
    pub pit: PitCircle,
}

impl Keys for ThroughFace {
    fn start() -> Self {
        Self { pit: PitCircle::start() }
    }

    fn rows() -> Vec<Row<Self>> {
        flatten(field!(pit)).collect()
    }

    fn choose(&mut self, table: &TomlTable<'_>, files: &dyn NumberFiles) -> ReadResult<()> {
        self.pit.choose(table, files)
    }
}

impl Kind for ThroughFace {
    const NAME: &str = "through-face";
    const EFFECT: MeshEffect = MeshEffect::Rolling;
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

    fn damage(&self, tooth: &mut DamagedTooth, healthy: &HealthyTooth) -> Result<(), ScenarioError> {
        let (pit, flank_y_mm) = healthy.cut(&self.pit)?;
        for i in pit.start_index..=pit.end_index {
            tooth.flank_y_mm[i] = tooth.cut_y_mm(i, flank_y_mm[i], healthy.profile());
            tooth.corner_y_mm[i] = tooth.flank_y_mm[i];
        }
        let (mate, met_by_start) = healthy.met_by(pit.start_index);
        let (_, met_by_end) = healthy.met_by(pit.end_index);
        tooth.rolling.push(RollingPit {
            start_index: pit.start_index,
            mid_index: pit.mid_index,
            end_index: pit.end_index,
            deviation_mm: largest_deviation_mm(healthy.profile(), pit.start_index, pit.end_index)
                + largest_deviation_mm(mate.profile, met_by_end, met_by_start),
        });
        let width_mm = healthy.wheel().face_width_mm;
        tooth.descriptions.push(DamageDescription::FaceFault { pit, width_mm });
        Ok(())
    }

    fn published_geometry(&self, teeth: &Teeth, _seed: u64) -> Result<FaultGeometry, ScenarioError> {
        published::through_face::geometry(self, teeth)
    }
}

/// (mm) Largest distance, across the chord, of the flank from the chord between two of its points.
pub(super) fn largest_deviation_mm(profile: &ToothProfile, start: usize, end: usize) -> f64 {
    let (x0, y0) = (profile.x_mm[start], profile.y_mm[start]);
    let (dx, dy) = (profile.x_mm[end] - x0, profile.y_mm[end] - y0);
    let chord = dx.hypot(dy);
    (start..=end)
        .map(|i| ((profile.y_mm[i] - y0) * dx - (profile.x_mm[i] - x0) * dy).abs() / chord)
        .fold(0.0, f64::max)
}
