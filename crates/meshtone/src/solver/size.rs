//! How large a problem the step is compiled for.

use super::integrate::Problem;

/// Number of modes and of mesh directions that a step is compiled for, the smaller sizes first. Fixed sizes let the compiler
/// unroll the step and keep it in registers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Size {
    /// A healthy pair, a missing or a destroyed tooth: the wheels do not tilt.
    Flat,
    /// The load moves along the face: the wheels tilt.
    Tilting,
    /// The pressure angle changes.
    Rolling,
    /// Everything, as after an arbitrary initial displacement; also at varying speed or load.
    General,
    /// The published law, whatever the damage. It is there for comparison: one size saves a sixth of the library's compilation.
    Published,
    /// The published law, and all else.
    PublishedGeneral,
    /// Teeth in contact, the load midway along the face.
    ContactFlat,
    /// Teeth in contact, the load moving along the face.
    ContactTilting,
    /// Teeth in contact, and all else.
    ContactGeneral,
}

impl Size {
    /// The smallest size that holds a simulation.
    pub(crate) fn of(problem: &Problem) -> Self {
        if problem.mesh.contact().is_some() {
            return match (problem.steady, problem.model.modes(), problem.model.directions.len()) {
                (true, 0..=8, 0..=1) => Self::ContactFlat,
                (true, 0..=12, 0..=2) => Self::ContactTilting,
                _ => Self::ContactGeneral,
            };
        }
        let sizes = (problem.model.modes(), problem.model.directions.len());
        if problem.mesh.cycle().is_some() {
            return match (problem.steady, sizes) {
                (true, (0..=8, 0..=3)) => Self::Published,
                _ => Self::PublishedGeneral,
            };
        }
        if !problem.steady {
            return Self::General;
        }
        match sizes {
            (0..=5, 0..=1) => Self::Flat,
            (0..=7, 0..=2) => Self::Tilting,
            (0..=7, 3) => Self::Rolling,
            _ => Self::General,
        }
    }
}
