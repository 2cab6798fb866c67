//! The mesh: which teeth meet, how stiff they are together, how far their flanks deviate, and what force that makes.

mod bridging;
pub(crate) mod contact_forcing;
mod contact_mesh;
mod contact_pairs;
mod corner;
mod face_load;
pub(crate) mod forcing;
pub(crate) mod law;
mod load_state;
mod pair;
mod pair_forcing;
mod pair_mesh;
#[doc(hidden)]
pub mod published;
mod sequence;
mod static_mesh;

pub(crate) use contact_forcing::ContactForcing;
pub(crate) use contact_mesh::ContactParameters;
pub use contact_mesh::{ContactMesh, ContactTable};
pub use contact_pairs::ContactState;
pub(crate) use contact_pairs::TipShape;
pub(crate) use face_load::FaceSlope;
pub use load_state::LoadState;
pub(crate) use load_state::{DIRECTIONS, DirectionMatrix, DirectionVector, ROTATION};
pub use pair::{PairState, Pairs};
pub(crate) use pair_forcing::{ALL_DIRECTIONS, PairDeviations, PairForcing};
pub use pair_mesh::{PairMesh, PairTable};
#[doc(hidden)]
pub use published::PublishedMesh;
pub use sequence::{PairKind, PairSequence};
pub use static_mesh::StaticMesh;

use law::{MeshTable, PublishedCycle, Reduction};
use nalgebra::SMatrix;

/// The mesh under one of the models.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Mesh {
    /// As the published code has it.
    #[doc(hidden)]
    Published(Box<PublishedMesh>),
    /// A sequence of tooth pairs.
    Pairs(Box<PairMesh>),
    /// A sequence of tooth pairs that push and never pull.
    Contact(Box<ContactMesh>),
}

/// What the mesh can do to the wheels: which of its directions it uses and couples, and its mean stiffness.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MeshSpan {
    /// Whether the pressure angle is the nominal one always.
    pub(crate) constant_angle: bool,
    /// Which of the constant directions the mesh couples at any point of the cycle.
    pub(crate) coupled: SMatrix<bool, DIRECTIONS, DIRECTIONS>,
    /// (N/m) Mean over the cycle, in the constant directions.
    pub(crate) mean_stiffness: DirectionMatrix,
}

impl Mesh {
    /// The pairs of teeth; none under `published`.
    pub fn pairs(&self) -> Option<&PairMesh> {
        match self {
            Self::Pairs(mesh) => Some(mesh),
            Self::Published(_) | Self::Contact(_) => None,
        }
    }

    /// The pairs in contact; only under `contact`.
    pub fn contact(&self) -> Option<&ContactMesh> {
        match self {
            Self::Contact(mesh) => Some(mesh),
            Self::Published(_) | Self::Pairs(_) => None,
        }
    }

    /// The published mesh; none under the other models.
    #[doc(hidden)]
    pub fn published(&self) -> Option<&PublishedMesh> {
        match self {
            Self::Published(mesh) => Some(mesh),
            Self::Pairs(_) | Self::Contact(_) => None,
        }
    }

    /// Number of points from one pair to the next, of [`Self::stiffness_n_per_mm`].
    pub fn points_per_pitch(&self) -> usize {
        match self {
            Self::Published(mesh) => mesh.grid.points_per_pitch,
            Self::Pairs(mesh) => mesh.points_per_pitch,
            Self::Contact(mesh) => mesh.points_per_pitch,
        }
    }

    /// (N/mm) Stiffness of all pairs in contact, over one gear revolution from its first tooth's start of contact: of the first
    /// one, where damaged pinion teeth make the next different.
    pub fn stiffness_n_per_mm(&self) -> Vec<f64> {
        match self {
            Self::Published(mesh) => mesh.stiffness.mesh_n_per_mm.clone(),
            Self::Pairs(mesh) => mesh.stiffness_n_per_mm(0..mesh.sequence.gear_teeth()),
            Self::Contact(mesh) => mesh.stiffness_n_per_mm(0..mesh.sequence.gear_teeth()),
        }
    }

    /// (N/mm) The same of a healthy pair of wheels, over one pitch.
    pub fn healthy_stiffness_n_per_mm(&self) -> Vec<f64> {
        match self {
            Self::Published(mesh) => mesh.stiffness.healthy_mesh_n_per_mm.clone(),
            Self::Pairs(mesh) => mesh.healthy_stiffness_n_per_mm(),
            Self::Contact(mesh) => mesh.healthy_stiffness_n_per_mm(),
        }
    }

    /// (N/mm) Mean stiffness over the cycle.
    pub fn mean_stiffness_n_per_mm(&self) -> f64 {
        match self {
            Self::Published(mesh) => mesh.stiffness.mean_n_per_mm(),
            Self::Pairs(mesh) => mesh.mean_whole_stiffness_n_per_m() * 1e-3,
            Self::Contact(mesh) => mesh.mean_stiffness_n_per_m * 1e-3,
        }
    }

    /// How a sound pair carries its load.
    pub fn nominal_load(&self) -> &LoadState {
        match self {
            Self::Published(mesh) => &mesh.load.nominal,
            Self::Pairs(mesh) => &mesh.nominal,
            Self::Contact(mesh) => &mesh.nominal,
        }
    }

    pub(crate) fn span(&self) -> MeshSpan {
        let (mean_stiffness, others): (_, Box<dyn Iterator<Item = &LoadState>>) = match self {
            Self::Published(mesh) => (mesh.load.mean_stiffness(), Box::new(mesh.load.faulty.iter())),
            Self::Pairs(mesh) => (mesh.mean_stiffness(), Box::new(mesh.other_loads())),
            Self::Contact(mesh) => (mesh.closed(mesh.mean_stiffness_n_per_m), Box::new(std::iter::empty())),
        };
        let nominal = self.nominal_load();
        let mut span = MeshSpan {
            constant_angle: true,
            coupled: nominal.mean_square(nominal.pressure_angle_rad).map(|entry| entry != 0.0),
            mean_stiffness,
        };
        let mut last = *nominal;
        for state in others {
            if std::mem::replace(&mut last, *state) == *state {
                continue;
            }
            span.constant_angle &= state.pressure_angle_rad == nominal.pressure_angle_rad;
            let square = state.mean_square(nominal.pressure_angle_rad);
            span.coupled.zip_apply(&square, |coupled, entry| *coupled |= entry != 0.0);
        }
        span
    }

    /// (N/m) `Σ k · mean(g gᵀ)` at a point of the cycle, in the constant directions.
    ///
    /// # Arguments
    /// * `point` - under `published` a coarse point of the cycle, else an entry of the pairs' table
    pub(crate) fn stiffness_at(&self, point: usize) -> DirectionMatrix {
        match self {
            Self::Published(mesh) => mesh.load.stiffness(point),
            Self::Pairs(mesh) => mesh.stiffness_at(point),
            Self::Contact(mesh) => mesh.closed(mesh.whole_stiffness_at(point)),
        }
    }

    /// The mesh over its cycle, as a step under a law of tables needs it; under `contact` as if it were closed.
    pub(crate) fn table<const R: usize>(&self, reduction: &Reduction) -> MeshTable<R> {
        match self {
            Self::Published(mesh) => MeshTable::new(reduction, mesh.tabulated_stiffness()),
            Self::Pairs(mesh) => {
                MeshTable::new(reduction, (0..mesh.entries()).map(|entry| mesh.stiffness_at(entry)))
            }
            Self::Contact(mesh) => {
                let closed = |since| mesh.closed(mesh.whole_stiffness_at(since));
                MeshTable::new(reduction, (0..mesh.points_per_pitch).map(closed))
            }
        }
    }

    /// How the entries of the table follow one another, where the step's result decides; none where the motor does.
    pub(crate) fn cycle(&self) -> Option<PublishedCycle> {
        self.published().map(PublishedMesh::cycle)
    }
}
