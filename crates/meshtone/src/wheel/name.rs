//! The name of one of the two wheels.

use crate::keys::by_name;

/// One of the two wheels of the pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum WheelName {
    /// The driving wheel.
    Pinion,
    /// The driven wheel.
    #[default]
    Gear,
}

by_name!(WheelName, ["pinion" => WheelName::Pinion, "gear" => WheelName::Gear]);

impl WheelName {
    /// Both, the pinion first.
    pub const BOTH: [Self; 2] = [Self::Pinion, Self::Gear];

    /// The other wheel.
    pub fn mate(self) -> Self {
        self.choose(Self::Gear, Self::Pinion)
    }

    /// This wheel's one of what there is of both.
    pub(crate) fn choose<T>(self, pinion: T, gear: T) -> T {
        match self {
            Self::Pinion => pinion,
            Self::Gear => gear,
        }
    }
}

/// The name of a pair's wheel.
impl From<WheelName> for String {
    fn from(wheel: WheelName) -> Self {
        wheel.name().to_owned()
    }
}
