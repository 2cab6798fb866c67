//! What the models make of the machine and its meshes.

use crate::machine::{Machine, Modes, Rig, Supports};
use crate::mesh::Contact;
use crate::model::Model;

/// All in which the models differ that are a machine around meshes, beside the keys that they ignore.
pub(super) struct MachineOptions {
    /// How the flanks of a mesh touch.
    pub(super) contact: Contact,
    /// Whether what the shafts' bearings sit in moves.
    pub(super) supports: Supports,
    /// The modes with their damping.
    pub(super) modes: fn(&Machine, &Rig) -> Modes,
    /// Whether misaligned shafts and helix slopes distribute the load unevenly along the face.
    pub(super) feels_misalignment: bool,
}

impl MachineOptions {
    /// The options of a model; none of the published one, which has a machine of its own.
    pub(super) fn of(model: Model) -> Option<Self> {
        match model {
            Model::Contact => Some(Self {
                contact: Contact::Unilateral,
                supports: Supports::Moving,
                modes: |machine, _| Modes::damped_by_springs(machine),
                feels_misalignment: true,
            }),
            // Flanks that may pull bear on the whole face.
            Model::Linear => Some(Self {
                contact: Contact::Bilateral,
                supports: Supports::Held,
                modes: |machine, rig| Modes::damped_alike(machine, rig.damping_ratio.of_all_modes()),
                feels_misalignment: false,
            }),
            Model::Published => None,
        }
    }
}
