//! The mesh: which teeth meet, how stiff they are together, how far their flanks deviate, and what force that makes.

mod bridging;
mod corner;
pub(crate) mod curve;
mod deviations;
mod forcing;
mod gear_mesh;
mod law;
mod pair;
mod path_table;
mod sequence;
mod sliding;
mod static_mesh;
mod uneven_face;
mod window;

pub use corner::CornerReach;
pub use curve::MeshCurve;
pub use deviations::PairDeviations;
#[cfg(not(feature = "internals"))]
pub(crate) use forcing::ForcingBlock;
#[cfg(feature = "internals")]
pub use forcing::ForcingBlock;
pub(crate) use forcing::PAIRS;
pub use forcing::{Forcing, Turning};
pub use gear_mesh::{FaceForm, Mesh, PairTable};
pub(crate) use gear_mesh::{HelixWobble, MeshParameters};
pub use law::{Contact, CornerLaw, MeshLaw};
pub(crate) use law::{
    CornerLane, CornerLanes, LastContact, LawLanes, PairsSample, SpringSamples, TANGENT_M, TANGENT_PART,
    TiltedLoad, deflection_at_rest, line_up,
};
pub use pair::{LoadedPair, Pairs};
pub(crate) use path_table::TipShape;
pub use path_table::{CornerTable, PairState};
pub use sequence::{PairKind, PairSequence};
pub(crate) use sliding::Friction;
pub use static_mesh::StaticMesh;
pub use uneven_face::LoadAlongFace;
pub(crate) use uneven_face::{FacesAtRest, UnevenFace};
pub(crate) use window::{is_slanted, place_on_face};

#[cfg(test)]
mod tests;
