//! The meaning of angle 0 of a shaft.

/// Meaning of angle 0 of a shaft, from which its teeth are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum AngleZero {
    /// Angle 0 of angles that the user gave.
    #[default]
    Given,
    /// Angle 0 of a simulation: tooth 1 enters contact.
    Simulated,
    /// Each pulse of one in a revolution of this shaft: the same place of the wheel in every recording.
    Pulse,
    /// The first pulse of the recording.
    FirstPulse,
    /// The first sample of the recording.
    FirstSample,
    /// Any tooth's contact: a mesh tone does not say which.
    Chance,
}

meshtone_toml::named!(AngleZero {
    Given = "angle 0",
    Simulated = "simulation",
    Pulse = "pulse",
    FirstPulse = "first pulse",
    FirstSample = "first sample",
    Chance = "chance",
});

impl AngleZero {
    /// Returns whether teeth can be counted from it.
    pub fn counts_teeth(self) -> bool {
        self != Self::Chance
    }

    /// Returns whether it is the same place of the wheel in every recording.
    pub fn is_mark(self) -> bool {
        matches!(self, Self::Simulated | Self::Pulse)
    }

    /// Angle 0 of the shaft that this one drives or is driven by: only another pulse of its own would be a mark on it.
    pub(super) fn of_mate(self) -> Self {
        match self {
            Self::Pulse => Self::FirstPulse,
            other => other,
        }
    }
}
