//! Mesh frequencies that meet natural frequencies.

use std::f64::consts::TAU;

use crate::error::{ScenarioWarning, WarningKind};
use crate::simulate::Stages;

/// (-) How near a multiple of a mesh frequency may come to a natural frequency without a warning.
const NEAR: f64 = 0.01;
/// Multiples of a mesh frequency that are looked at: the strongest.
const MULTIPLES: u32 = 3;
/// (-) Deflection of a mesh in a resonating mode over its deflection by the same force at rest, from which on the mode is named. Most
/// modes of a gearbox, of which some is always near, do not move the mesh that much.
const LEAST_AMPLIFICATION: f64 = 1.0;

impl Stages {
    /// Modes of shafts of beams that the meshes deform and whose frequency is nearly a multiple of a mesh frequency.
    pub(super) fn mesh_resonances(&self) -> Option<ScenarioWarning> {
        // A pair on a rig is not looked at: this would be a warning that its scenarios have never had.
        let has_one_speed = self.scenario.operation.speed_profile_hz.is_none();
        let (_, modal) = self.machine().filter(|_| has_one_speed && self.scenario.rig().is_none())?;
        let speed_hz = self.scenario.operation.pinion_speed_hz;
        let mesh_hz: Vec<f64> =
            self.meshes.iter().map(|mesh| mesh.turning.pitches_per_revolution * speed_hz).collect();
        // Without the higher modes the frequencies are 0.1 % off.
        let highest_hz = 4.0 * f64::from(MULTIPLES) * mesh_hz.iter().copied().fold(0.0, f64::max);
        let mut found = Vec::new();
        for mode in modal.closed_modes(&self.closed_meshes(), TAU * highest_hz) {
            let natural_hz = mode.decay.frequency_hz;
            for (mesh, (mesh_hz, energy)) in mesh_hz.iter().zip(&mode.mesh_energies).enumerate() {
                // At resonance a mode answers a force in the mesh with φ²/(2ζω²), where at rest all modes together answer with 1/k; the
                // part of the mode's strain energy that is in the mesh is kφ²/ω².
                let damping_ratio = mode.decay.decay_per_s / (TAU * natural_hz);
                let amplification = energy / (2.0 * damping_ratio);
                let multiple = (1..=MULTIPLES)
                    .find(|&multiple| (natural_hz / (f64::from(multiple) * mesh_hz) - 1.0).abs() < NEAR);
                if let Some(multiple) = multiple.filter(|_| amplification > LEAST_AMPLIFICATION) {
                    let name = self.layout.mesh_names[mesh].as_deref().unwrap_or_default();
                    let order = f64::from(multiple) * mesh_hz;
                    found.push(format!(
                        "{natural_hz:.1} Hz by {order:.1} Hz, {multiple} times that of mesh {name}"
                    ));
                }
            }
        }
        (!found.is_empty()).then(|| {
            let message = format!(
                "mesh frequencies coincide with natural frequencies within 1 %: {}; there the vibration \
                 depends on damping and on small changes of speed",
                found.join(", ")
            );
            ScenarioWarning::new(WarningKind::MeshResonance, self.scenario.words().speed_key, message)
        })
    }
}
