//! Meshes whose load is at one end of the face, by the lean of their shafts.

use crate::error::{ScenarioWarning, WarningKind};
use crate::scenario::Scenario;
use crate::simulate::Stages;

/// (-) Face load factor above which a mesh is warned of: with less the whole face of an uncrowned tooth bears.
const MOST_FACTOR: f64 = 2.0;
/// (-) By how much thicker a shaft is proposed, at most.
const THICKER: f64 = 1.5;
/// (modules) Least rim that is left between a proposed shaft and the roots of its wheels.
const LEAST_RIM: f64 = 1.2;
/// Crownings that are tried, up to the shafts' lean.
const CROWNINGS: u32 = 40;

impl Stages {
    /// Meshes that bear unevenly along their faces, each with what would help.
    pub(super) fn uneven_faces(&self) -> impl Iterator<Item = ScenarioWarning> {
        let meshes = self.meshes.iter().zip(&self.pairs).enumerate();
        // A misalignment that is stated has been thought of: what the shafts add to it counts.
        let uneven = meshes.filter(|(_, (mesh, pair))| {
            let of_lean = 1.0 + mesh.unevenness_of(mesh.along_face.lean_m, pair.static_force_n);
            mesh.along_face.face_load_factor.min(of_lean) > MOST_FACTOR
        });
        uneven.map(|(mesh, (of, _))| {
            let load = of.along_face;
            let name = self.layout.mesh_names[mesh].as_ref();
            let of_mesh = name.map_or_else(String::new, |name| format!(" of mesh {name}"));
            let [thicker, key] = self.thicker_shaft(mesh);
            // Where others are in the way the wheels cannot sit there.
            let centred = Some(self.factor_of(&self.centred(mesh), mesh)).filter(|factor| factor.is_finite());
            let centred = centred.map_or_else(String::new, |factor| {
                format!("wheels midway between their bearings would make it {factor:.1}, and ")
            });
            let [crowning_um, crowned] = self.best_crowning(mesh);
            let message = format!(
                "the load{of_mesh} is at one end of the face: its face load factor is {:.1}, as the shafts lean by {:.1} µm over the \
                 face; {thicker}{centred}a crowning of {crowning_um:.1} µm would make it {crowned:.1}",
                load.face_load_factor,
                load.lean_m.abs() * 1e6
            );
            ScenarioWarning::new(WarningKind::UnevenFace, key, message)
        })
    }

    /// Which shaft of a mesh helps most where it is thicker, in words, and the key of its radius.
    fn thicker_shaft(&self, mesh: usize) -> [String; 2] {
        let shafts = self.layout.wheels_of_mesh[mesh].map(|wheel| self.layout.shaft_of_wheel[wheel]);
        let tried = shafts.map(|shaft| {
            let times = self.room_around(shaft).min(THICKER);
            let mut thicker = self.scenario.clone();
            let key = thicker.scale_shaft_radius(shaft, times);
            (self.factor_of(&thicker, mesh), times, shaft, key)
        });
        let [a, b] = tried;
        let (factor, times, shaft, key) = if a.0 <= b.0 { a } else { b };
        let name = self.scenario.shaft_in_words(&self.layout.shaft_names[shaft]);
        [format!("{name} {:.0} % thicker would make it {factor:.1}, ", 100.0 * (times - 1.0)), key]
    }

    /// (-) By how much thicker a shaft may be that leaves its wheels a rim.
    fn room_around(&self, shaft: usize) -> f64 {
        let wheels =
            (0..self.layout.shaft_of_wheel.len()).filter(|&wheel| self.layout.shaft_of_wheel[wheel] == shaft);
        let room = wheels.filter_map(|wheel| {
            let (mesh, side) = self.layout.mesh_of(wheel)?;
            let rim_mm = LEAST_RIM * self.layout.gears[mesh].module_mm;
            let root_mm = self.pairs[mesh].teeth.wheel(side).root_radius_mm;
            Some((root_mm - rim_mm) / self.layout.bore_radii_mm[wheel])
        });
        room.fold(f64::INFINITY, f64::min).max(1.0)
    }

    /// The scenario with the wheels of a mesh midway between the ends of their shafts.
    fn centred(&self, mesh: usize) -> Scenario {
        let mut centred = self.scenario.clone();
        if let Some(rig) = centred.rig_mut() {
            (rig.pinion_shaft.wheel_at, rig.gear_shaft.wheel_at) = (0.5, 0.5);
        } else {
            self.layout.wheels_of_mesh[mesh].iter().for_each(|&wheel| centred.wheels[wheel].at = 0.5);
        }
        centred
    }

    /// (-) The face load factor of a mesh in a changed scenario.
    fn factor_of(&self, changed: &Scenario, mesh: usize) -> f64 {
        let faces = self.faces_at_rest_of(changed);
        faces.map_or(f64::NAN, |faces| faces.loads()[mesh].face_load_factor)
    }

    /// (µm, -) The further crowning with which the face load factor of a mesh is least, and that factor.
    fn best_crowning(&self, mesh: usize) -> [f64; 2] {
        let Some(faces) = self.faces_at_rest_of(&self.scenario) else { return [f64::NAN; 2] };
        let most_um = self.meshes[mesh].along_face.lean_m.abs() * 1e6;
        let tried = (0..=CROWNINGS).map(|n| most_um * f64::from(n) / f64::from(CROWNINGS));
        let tried = tried.map(|um| [um, faces.crowned(mesh, um * 1e-6).loads()[mesh].face_load_factor]);
        tried.min_by(|a, b| a[1].total_cmp(&b[1])).unwrap_or([f64::NAN; 2])
    }
}
