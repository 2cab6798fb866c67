//! What damages take of a tooth, and with it which of them can be on one tooth together.

/// What a kind of damage takes of a tooth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ToothPart {
    /// All of it, once.
    Whole,
    /// Its tip or a corner of it, through the whole thickness, once.
    Tip,
    /// Material in the root, which stays where it is, once.
    Root,
    /// A length of the working flank. Another damage may take another length.
    FlankLength,
    /// Spots of the working flank, over a part of the face. Others may overlap them.
    FlankSpots,
    /// The surface of the working flank, once. A tooth that is gone may have lost it before.
    FlankSurface,
}

impl ToothPart {
    /// Its name in a word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Whole => "whole",
            Self::Tip => "tip",
            Self::Root => "root",
            Self::FlankLength | Self::FlankSpots | Self::FlankSurface => "flank",
        }
    }

    /// Whether it is the working flank, or a part of it.
    pub fn is_of_flank(self) -> bool {
        matches!(self, Self::FlankLength | Self::FlankSpots | Self::FlankSurface)
    }

    /// Why a tooth that has lost one part cannot lose the other, whatever their sizes; none where it can.
    pub(super) fn excludes(self, other: Self) -> Option<&'static str> {
        match (self, other) {
            (Self::Whole, Self::FlankSurface) | (Self::FlankSurface, Self::Whole) => None,
            (Self::Whole, _) | (_, Self::Whole) => Some("a missing tooth can have no other damage than wear"),
            (one, other) if one != other => None,
            (Self::FlankLength | Self::FlankSpots, _) => None,
            (Self::Tip, _) => Some("a tooth can have one breakage only"),
            (Self::Root, _) => Some("a tooth can have one root crack only"),
            (Self::FlankSurface, _) => Some("a flank can have one wear fault only"),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::damage::damage_kinds;

    /// A missing tooth has no other damage but wear; a tooth breaks, cracks and wears once.
    #[test]
    fn kinds_exclude_each_other_by_what_they_take() {
        let kinds = damage_kinds();
        for one in &kinds {
            for other in &kinds {
                let [first, second] = [one.name, other.name];
                let missing = [first, second].contains(&"missing-tooth");
                let worn = [first, second].contains(&"wear");
                let once = ["tooth-breakage", "root-crack", "wear"].contains(&first) && first == second;
                let excluded = one.example.part().excludes(other.example.part()).is_some();
                assert_eq!(excluded, (missing && !worn) || once, "{first} and {second}");
            }
        }
    }
}
