//! A wheel, as the panel sees it.

use meshtone::damage::DamagedTooth;
use meshtone::scenario::Scenario;
use meshtone::wheel::{ErrorTable, Teeth, ToothProfile, Wheel, WheelName};
use meshtone::{MeshedPair, Stages};

use crate::PlotError;
use crate::drawing::Area;

/// A wheel, and one of its teeth: the first damaged one, or the first.
pub(super) struct Side<'a> {
    /// Its name as titles have it.
    pub(super) name: String,
    pub(super) shaft: String,
    /// What stands before a tooth's number, with a space; nothing where the heading's name is enough.
    of_tooth: &'static str,
    /// The wheel, of helical ones that of the normal section, in which teeth are drawn.
    pub(super) wheel: &'a Wheel,
    pub(super) profile: &'a ToothProfile,
    /// Profile index where contact starts.
    pub(super) contact_index: usize,
    /// (mm) Contact lines on the face every half base pitch, by z and x of their points; none of spur teeth.
    pub(super) contact_lines_mm: Vec<Vec<[f64; 2]>>,
    /// (mm) x where what shapes the tip starts, and its name.
    pub(super) tip_shapes: Vec<(f64, &'static str)>,
    /// What is left of the tooth; none of a sound one.
    pub(super) tooth: Option<&'a DamagedTooth>,
    /// All damaged teeth of the wheel.
    pub(super) damaged: Vec<crate::DamagedTooth>,
    /// (mm) One column per tooth.
    pub(super) errors_mm: Option<&'a ErrorTable>,
    /// Whether the rows of `errors_mm` run from tip to contact start.
    pub(super) errors_from_tip: bool,
}

impl<'a> Side<'a> {
    pub(super) fn new(stages: &'a Stages, name: WheelName) -> Result<Self, PlotError> {
        let [title, shaft, of_tooth] = match name {
            WheelName::Pinion => ["Pinion", "input shaft", "pinion "],
            WheelName::Gear => ["Gear", "output shaft", "gear "],
        };
        let heading = [title.to_owned(), shaft.to_owned()];
        let overlap = stages.meshes.first().map_or(0.0, |mesh| mesh.face.overlap());
        Self::of_pair(name, heading, of_tooth, (&stages.pairs[0], overlap), stages.tip_lengths_mm(name))
    }

    /// A wheel of a gearbox, in its first mesh; none of a wheel in no mesh.
    pub(super) fn of_gearbox(
        gearbox: &Scenario,
        stages: &'a Stages,
        wheel: usize,
    ) -> Option<Result<Self, PlotError>> {
        let (mesh, name) = stages.layout.mesh_of(wheel)?;
        let (of_mesh, of_file) = (&stages.pairs[mesh], &gearbox.wheels[wheel]);
        let heading = [of_file.name.clone(), format!("shaft {}", of_file.shaft)];
        let tips_mm = stages.layout.gears[mesh].tip_lengths_mm(name);
        Some(Self::of_pair(name, heading, "", (of_mesh, stages.meshes[mesh].face.overlap()), tips_mm))
    }

    /// One of two wheels in mesh, with (base pitches) how much farther on its path a pair is at the end of the face at positive z than at
    /// the other one.
    fn of_pair(
        name: WheelName,
        [title, shaft]: [String; 2],
        of_tooth: &'static str,
        (pair, overlap): (&'a MeshedPair, f64),
        tip_lengths_mm: [f64; 2],
    ) -> Result<Self, PlotError> {
        let MeshedPair { teeth, damaged, profile_errors, .. } = pair;
        let profile = teeth.profile(name);
        let contact_index = teeth.initial_contact_index(name);
        let points = profile.len().min(profile.y_mm.len());
        if points < 2 || contact_index + 1 >= points {
            let wheel = if of_tooth.is_empty() { title } else { format!("the {}", name.name()) };
            return Err(PlotError::NoProfile { wheel, points });
        }
        let standing_out = crate::DamagedTooth::of_pair(pair, name);
        let first = standing_out.first().map(|tooth| tooth.tooth as usize - 1);
        let mut of_wheel = damaged.iter().filter(|tooth| tooth.wheel == name);
        Ok(Self {
            name: title,
            shaft,
            of_tooth,
            wheel: teeth.section(name),
            contact_lines_mm: contact_lines_mm(teeth, name, overlap),
            profile,
            contact_index,
            tip_shapes: tip_shapes(tip_lengths_mm, profile),
            tooth: first.and_then(|first| of_wheel.find(|alike| alike.teeth.contains(&first))),
            damaged: standing_out,
            errors_mm: profile_errors.as_ref().map(|errors| match name {
                WheelName::Pinion => &errors.pinion_profile_errors_mm,
                WheelName::Gear => &errors.gear_profile_errors_mm,
            }),
            errors_from_tip: name == WheelName::Gear,
        })
    }

    /// Index of the tooth, from 0.
    pub(super) fn tooth_index(&self) -> usize {
        self.tooth.map_or(0, DamagedTooth::first_tooth)
    }

    /// What the tooth is called.
    pub(super) fn tooth_name(&self) -> String {
        match self.tooth_index() {
            0 => "first tooth".to_owned(),
            index => format!("{}tooth {}", self.of_tooth, index + 1),
        }
    }

    /// Whether the whole tooth is gone.
    pub(super) fn is_missing(&self) -> bool {
        self.tooth.is_some_and(DamagedTooth::is_missing)
    }

    pub(super) fn last(&self) -> usize {
        self.profile.len() - 1
    }

    pub(super) fn contact_x_mm(&self) -> f64 {
        self.profile.x_mm[self.contact_index]
    }

    /// (mm) Point of the sound flank; `side` is 1 for the drive and −1 for the coast flank.
    pub(super) fn flank(&self, index: usize, side: f64) -> (f64, f64) {
        (side * self.profile.y_mm[index], self.profile.x_mm[index])
    }

    /// (mm) Ranges across and along the tooth that fill `area` at equal scales.
    pub(super) fn view(&self, area: Area) -> ([f64; 2], [f64; 2]) {
        let module = self.wheel.module_mm;
        let root = self.profile.x_mm[0];
        // A crack may reach into the wheel's body.
        let crack = self.tooth.and_then(|tooth| tooth.crack).map_or(root, |crack| crack.tip_mm().0);
        let low = root.min(crack) - 0.34 * module;
        let high = self.wheel.tip_radius_mm.max(self.profile.tip_x_mm()) + 0.22 * module;
        let widest = self.profile.y_mm.iter().fold(0.5 * module, |widest, y| widest.max(*y));
        let px_per_mm = (area.height / (high - low)).min(area.width / (2.12 * widest));
        let across = area.width / px_per_mm / 2.0;
        let spare = (area.height / px_per_mm - (high - low)) / 2.0;
        ([-across, across], [low - spare, high + spare])
    }

    /// (mm) x of the flank at `radius_mm` from the wheel's centre, above the start of contact.
    pub(super) fn x_at_radius_mm(&self, radius_mm: f64) -> f64 {
        let (mut low, mut high) = (self.contact_index, self.last());
        while low + 1 < high {
            let middle = (low + high) / 2;
            if self.profile.radius_mm(middle) <= radius_mm { low = middle } else { high = middle }
        }
        let (a, b) = (self.profile.radius_mm(low), self.profile.radius_mm(high));
        let t = if b > a { ((radius_mm - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
        self.profile.x_mm[low] + t * (self.profile.x_mm[high] - self.profile.x_mm[low])
    }
}

fn contact_lines_mm(teeth: &Teeth, name: WheelName, overlap: f64) -> Vec<Vec<[f64; 2]>> {
    if overlap == 0.0 {
        return Vec::new();
    }
    let reach = ((teeth.path.contact_ratio + overlap.abs()) * 2.0).ceil() as i32;
    let lines = (-reach..=reach).map(|half| teeth.contact_line_mm(name, overlap, f64::from(half) / 2.0));
    lines.filter(|line| line.len() > 1).collect()
}

/// From the tip inwards, as the scenario says: the resampled pinion profile's own index is that of the profile before
/// resampling.
fn tip_shapes(lengths_mm: [f64; 2], profile: &ToothProfile) -> Vec<(f64, &'static str)> {
    let named = lengths_mm.into_iter().zip(["chamfer", "tip relief"]);
    let shown = named.filter(|(length_mm, _)| *length_mm > 0.0 && profile.len() > 1);
    shown.map(|(length_mm, name)| (profile.tip_x_mm() - length_mm, name)).collect()
}
