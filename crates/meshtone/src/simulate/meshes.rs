//! The meshes with their tables.

use std::num::NonZeroUsize;

use super::{AssembledMachine, MeshedPair};
use crate::damage::DamagedTooth;
use crate::error::{self, ScenarioError};
use crate::machine::Machine;
use crate::mesh::{
    Contact, FaceForm, FacesAtRest, Friction, LoadAlongFace, Mesh, MeshParameters, PairSequence, PairTable,
    Pairs, TipShape, Turning, UnevenFace, is_slanted, place_on_face,
};
use crate::operation::TimeGrid;
use crate::scenario::{Layout, Scenario};
use crate::wheel::{Gears, NamedGears, WheelName};

/// The meshes of a scenario.
///
/// # Arguments
/// * `scenario`, `layout`, `time` - what is simulated, how it stands and turns, and its division of time
/// * `pairs`, `machine` - the wheels of each mesh, and the machine around them
/// * `points_per_pitch` - from one pair of teeth to the next; none for those that the time loop has
///
/// # Errors
/// Damaged teeth that were put beyond a wheel's last one, misaligned shafts without a load, and a mesh that cannot carry any.
pub(super) fn meshes(
    scenario: &Scenario,
    layout: &Layout,
    time: &TimeGrid,
    (pairs, machine): (&[MeshedPair], &AssembledMachine),
    points_per_pitch: Option<NonZeroUsize>,
) -> Result<Vec<Mesh>, ScenarioError> {
    let contact = if scenario.model.teeth_part() { Contact::Unilateral } else { Contact::Bilateral };
    let mesh_of = |(number, pair): (usize, &MeshedPair), along_face: Option<(LoadAlongFace, bool)>| {
        let turning = Turning {
            pitches_per_revolution: layout.pitches_per_revolution(number),
            first_pitch: layout.phases[number],
        };
        let mesh = MeshOf {
            gears: &scenario.named_gears(layout, number),
            pair,
            machine,
            number,
            along_face,
            // Flanks that may pull bear on the whole face.
            closer_um: match contact {
                Contact::Unilateral => pair.closer_um(),
                Contact::Bilateral => 0.0,
            },
            contact,
            turning,
            friction: scenario.meshes[number].friction,
            sense: layout.driving_ratio(number).signum(),
        };
        let of_time = || points_of(time, scenario.operation.turns_evenly(), &turning, pair);
        mesh.with_tables(points_per_pitch.unwrap_or_else(of_time))
    };
    let even: Vec<Mesh> =
        pairs.iter().enumerate().map(|pair| mesh_of(pair, None)).collect::<Result<_, _>>()?;
    let Some(faces) = faces_at_rest(scenario, layout, &machine.machine, pairs, &even) else {
        return Ok(even);
    };
    // How each bears at rest says which of them need another form.
    let meshes = even.into_iter().zip(faces.loads()).zip(pairs.iter().zip(&layout.gears).enumerate());
    let of_load = |((mut mesh, load), (number, (pair, gears))): ((Mesh, _), (_, (&MeshedPair, &Gears)))| {
        mesh.bear(load);
        let closer_m = pair.closer_um() * 1e-6;
        let is_uneven = gears.is_crowned() || pair.damaged.iter().any(DamagedTooth::varies_over_face);
        let unevenness = mesh.unevenness_of(load.lean_m + closer_m, pair.static_force_n);
        let tilts = unevenness > MOST_UNEVENNESS
            || is_uneven && load.tilt_product > MOST_TILT_PRODUCT
            || mesh.loses_a_part()
            || mesh.wobbles();
        let leans_in_slices = !tilts && closer_m != 0.0 && (mesh.slices() > 1 || gears.is_helical());
        if leans_in_slices || tilts && gears.is_helical() {
            mesh = mesh_of((number, pair), Some((load, tilts)))?;
        }
        if tilts {
            mesh.tilt(closer_m);
        }
        mesh.bear(load);
        Ok(mesh)
    };
    meshes.map(of_load).collect()
}

/// (-) λ above which the slope of a mesh's deflection along the face is an unknown: it adds λ²(1 + χ)/3 to the mesh's compliance.
const MOST_UNEVENNESS: f64 = 0.2;
/// (-) χ above which it is one where the gap varies along the face.
const MOST_TILT_PRODUCT: f64 = 0.1;

/// (base pitches) Overlap above which a helical face that tilts is not divided: a corner, which reaches 0.05 base pitches at 10 µm, touches in one place of it.
const LEAST_UNDIVIDED: f64 = 0.5;

/// How each mesh bears along its face at rest: by the lean of the shafts under the nominal load, misalignment, slopes of the flanks, crowning and
/// end relief. None without a load, or where flanks may pull.
///
/// # Arguments
/// * `scenario`, `layout` - what is simulated, and its wheels
/// * `machine` - around the meshes
/// * `pairs`, `meshes` - the wheels of each mesh, and their stiffness
pub(super) fn faces_at_rest(
    scenario: &Scenario,
    layout: &Layout,
    machine: &Machine,
    pairs: &[MeshedPair],
    meshes: &[Mesh],
) -> Option<FacesAtRest> {
    if !scenario.model.teeth_part() || pairs.iter().any(|pair| pair.static_force_n <= 0.0) {
        return None;
    }
    let stiffness: Vec<f64> = meshes.iter().map(|mesh| mesh.even_stiffness_n_per_m).collect();
    let leans = machine.leans(&stiffness, scenario.operation.brake_torque_nm);
    let face = |((pair, gears), stiffness): ((&MeshedPair, &Gears), &f64)| {
        let width_m = gears.face_width_mm * 1e-3;
        let slope = pair.closer_um() * 1e-6 / width_m;
        let numbers = [width_m, *stiffness, pair.static_force_n, slope];
        UnevenFace::new(numbers, |part| gears.mean_gap_mm(part) * 1e-3)
    };
    Some(FacesAtRest { faces: pairs.iter().zip(&layout.gears).zip(&stiffness).map(face).collect(), leans })
}

/// Points from one pair to the next: where a whole number of samples passes between them every sample is one, else the coarse points of
/// the cycle, between which the tables are read.
fn points_of(time: &TimeGrid, turns_evenly: bool, turning: &Turning, pair: &MeshedPair) -> NonZeroUsize {
    let samples = time.samples_per_pinion_revolution as f64 / turning.pitches_per_revolution;
    let is_whole = (samples.round() / samples - 1.0).abs() < 1e-12;
    let is_each = is_whole && turning.first_pitch == 0.0 && turns_evenly;
    let points = if is_each { samples.round() as usize } else { pair.cycle.points_per_pitch };
    NonZeroUsize::new(points).unwrap_or(NonZeroUsize::MIN)
}

/// The mesh, unless it can carry nothing, or has more pairs at once than a step looks at.
fn checked(mesh: Mesh, gears: &NamedGears) -> Result<Mesh, ScenarioError> {
    if mesh.contact_ratio <= 0.0 {
        let problem = "the tips' chamfers and the active profile's shortening leave no path of contact";
        let help = format!("lower {}", gears.shorteners().join(" or "));
        return Err(ScenarioError::new(gears.whole(), "", problem).with_help(help));
    }
    if mesh.mean_stiffness_n_per_m.is_nan() || mesh.mean_stiffness_n_per_m <= 0.0 {
        return Err(error::not_stiff(gears.foundation()));
    }
    if mesh.face.overlap() == 0.0 && mesh.contact_ratio > Mesh::MOST_CONTACT_RATIO {
        let (ratio, most) = (mesh.contact_ratio, Mesh::MOST_CONTACT_RATIO);
        let problem = format!(
            "has a contact ratio of {ratio:.2} between the chamfers; must be at most {most:.1} under the model of contact"
        );
        let angle = gears.key("pressure_angle_deg");
        let help = format!("raise {angle}; of one pair, model = \"linear\" has no such limit");
        return Err(ScenarioError::new(gears.whole(), "", problem).with_help(help));
    }
    let meets = |table: &PairTable| table.kind.pairs_per_cycle > 0 && table.can_touch();
    if mesh.classes.iter().any(meets) { Ok(mesh) } else { Err(error::nothing_left()) }
}

/// What a mesh is made of.
struct MeshOf<'a> {
    gears: &'a NamedGears<'a>,
    pair: &'a MeshedPair,
    machine: &'a AssembledMachine,
    /// Of the mesh in the machine.
    number: usize,
    /// (µm) By how much more the flanks close at one end of the face than at the other.
    closer_um: f64,
    contact: Contact,
    turning: Turning,
    /// (-) Coefficient of friction of the flanks.
    friction: f64,
    /// 1 where the driving wheel turns about positive z, −1 where it turns the other way.
    sense: f64,
    /// How it bears along its face at rest, and whether its tilt is an unknown; none before that is known.
    along_face: Option<(LoadAlongFace, bool)>,
}

impl MeshOf<'_> {
    /// The mesh with its tables.
    ///
    /// # Errors
    /// Damaged teeth that were put beyond a wheel's last one, misaligned shafts without a load, and a mesh that cannot carry any.
    fn with_tables(&self, points_per_pitch: NonZeroUsize) -> Result<Mesh, ScenarioError> {
        let &Self { gears, machine, number, closer_um, .. } = self;
        let &MeshedPair { ref teeth, ref damaged, static_force_n, .. } = self.pair;
        let sequence = PairSequence::new(gears.pinion_teeth, gears.gear_teeth, damaged)?;
        if closer_um != 0.0 && static_force_n <= 0.0 {
            let (key, uneven) = gears.load();
            let problem = "the mesh is unloaded, but its flanks are misaligned along the face; must be loaded, because the load determines how much of the face is in contact";
            let help = format!("load the mesh by operation.brake_torque_nm, or set {uneven} to 0");
            return Err(ScenarioError::new(key, "", problem).with_help(help));
        }
        let width_m = gears.face_width_mm * 1e-3;
        // While the whole face bears, wheels whose tilt is no unknown yield to a part of what closes their flanks.
        let one_unknown = self.along_face.filter(|_| !self.tilts());
        let closer_m = one_unknown.map_or(0.0, |(load, _)| closer_um * 1e-6 / (1.0 + load.tilt_product));
        let slices = if self.gap_varies_along_face() { gears.slices as usize } else { 1 };
        let overlap = self.sense * gears.hand.sign() * gears.overlap_ratio();
        let is_spur = !is_slanted(overlap / slices as f64);
        let gaps_m = || {
            (0..slices)
                .map(|slice| [slice, slice + 1].map(|edge| place_on_face(edge as f64, slices)))
                .map(|ends| gears.mean_gap_mm(ends) * 1e-3)
                .collect()
        };
        let face = match (slices, is_spur) {
            (1, true) => FaceForm::Spur,
            (1, false) => FaceForm::Helical { overlap },
            _ => FaceForm::Sliced { overlap: if is_spur { 0.0 } else { overlap }, gaps_m: gaps_m() },
        };
        let parameters = MeshParameters {
            contact: self.contact,
            turning: self.turning,
            damping_ratio: machine.mesh_damping_ratio[number],
            mesh_mass_kg: machine.mesh_mass_kg[number],
            // Across the teeth, as it is measured; in the transverse section it is larger.
            backlash_m: gears.normal_backlash_mm() * 1e-3 / gears.base_helix_angle_rad().cos(),
            static_force_n,
            closer_m,
            wobble: self.wobbles().then_some(self.pair.helix_wobble),
            face,
            tilts: self.tilts(),
            face_width_m: width_m,
            friction: self.friction(),
        };
        let shapes = WheelName::BOTH.map(|wheel| TipShape {
            chamfer_mm: gears.chamfer_mm(wheel),
            active_profile_shortening: match self.contact {
                Contact::Unilateral => gears.active_profile_shortening[wheel as usize],
                Contact::Bilateral => 0.0,
            },
            relief: gears.flank_relief[wheel as usize],
        });
        let tabulated = |faces: &[Pairs]| {
            checked(Mesh::new(faces, shapes, sequence, points_per_pitch, parameters), gears)
        };
        if slices == 1 {
            return tabulated(&[Pairs::new(teeth, damaged, gears)]);
        }
        let width_mm = gears.face_width_mm;
        let of_slice = teeth.with_face_width(width_mm / slices as f64);
        let damaged: Vec<Vec<DamagedTooth>> = (0..slices)
            .map(|slice| [slice, slice + 1].map(|edge| width_mm * place_on_face(edge as f64, slices)))
            .map(|ends_mm| damaged.iter().map(|tooth| tooth.slice(ends_mm, width_mm)).collect())
            .collect();
        let sound = Pairs::new(&of_slice, &[], gears);
        tabulated(&damaged.iter().map(|damaged| sound.with_damaged(damaged)).collect::<Vec<_>>())
    }

    /// Whether a slope of the flanks along the face turns with the wheels: nothing where flanks may pull, or without a load.
    fn wobbles(&self) -> bool {
        let is_pressed = self.contact == Contact::Unilateral && self.pair.static_force_n > 0.0;
        is_pressed && self.pair.helix_wobble.iter().any(|wheel| wheel.slope != 0.0)
    }

    /// Whether its tilt is known to be an unknown.
    fn tilts(&self) -> bool {
        self.along_face.is_some_and(|(_, tilts)| tilts)
    }

    /// Friction of the flanks; none of frictionless ones.
    fn friction(&self) -> Option<Friction> {
        let teeth = &self.pair.teeth;
        (self.friction > 0.0).then(|| Friction {
            // The force across the teeth is larger than that in the transverse section.
            coefficient: self.friction / self.gears.base_helix_angle_rad().cos(),
            pitch_point: if self.gears.ring_drives {
                teeth.path.from_end(teeth.pitch_point())
            } else {
                teeth.pitch_point()
            },
            base_pitch_m: teeth.path.base_pitch_mm * 1e-3,
        })
    }

    /// Whether the face is cut into slices, since the gap between two flanks differs along it. Teeth that tilt, unless a
    /// corner reaches over much of their face, and spur teeth that have lost a part of theirs need none: see [`MeshLaw`](crate::mesh::MeshLaw) and [`Pairs`].
    fn gap_varies_along_face(&self) -> bool {
        let gears = self.gears;
        let varies_along_contact_lines = || {
            let is_steep = gears.overlap_ratio() > LEAST_UNDIVIDED;
            !(self.tilts() && is_steep) && (self.along_face.is_some() || self.wobbles())
                || gears.is_relieved()
                || self.pair.damaged.iter().any(DamagedTooth::varies_over_face)
        };
        gears.is_crowned() || gears.is_helical() && varies_along_contact_lines()
    }
}
