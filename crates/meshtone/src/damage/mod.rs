//! What is broken: one file a kind of damage.
//!
//! A kind's file holds its parameters, their rules and what it does to a tooth ([`DamagedTooth`]).

mod damaged_tooth;
mod description;
mod fault;
mod faulty_teeth;
mod flank_pits;
mod kind;
mod missing_tooth;
mod part;
mod partial_face;
mod pit_circle;
mod pits;
mod root_crack;
mod section;
mod severity;
mod slice;
mod through_face;
mod tooth_breakage;
mod tooth_destruction;
mod wear;

pub(crate) use damaged_tooth::HealthyTooth;
pub(crate) use damaged_tooth::damaged_teeth_of_file;
pub use damaged_tooth::{DamagedTooth, damaged_teeth};
pub(crate) use description::DamageResult;
pub use description::{DamageDescription, FacePatch, QuantityValue, damages_of_fault};
pub(crate) use fault::check_faults;
pub use fault::{Fault, FaultFlank, keys_of_every_fault};
pub use faulty_teeth::FaultyTeeth;
pub use flank_pits::FlankPits;
pub(crate) use flank_pits::united;
pub(crate) use kind::{Kind, PaperRig};
pub use part::ToothPart;
pub use pit_circle::PitCircle;
pub(crate) use pit_circle::{Pit, cut_flank};
pub use pits::FlankPit;
pub use root_crack::Crack;
pub use section::Section;
pub(crate) use section::shear_flexibility;
pub use tooth_destruction::DestructionLine;
pub use wear::{load_share, slide_factor};

use meshtone_toml::{ReadResult, TomlTable};

use crate::keys::{
    Check, KeyDescription, Keys, NoFiles, check_rows, commented_rows, describe, essential_rows, read_keys,
    read_rows, rows_but, write_rows,
};
use crate::wheel::Gears;
use severity::SoundTooth;

/// The kinds of damage, each with what it is in a sentence: in a file of its own, a struct implements [`Kind`].
macro_rules! kinds {
    ($(#[doc = $summary:literal] $file:ident::$kind:ident,)+) => {
        /// What is wrong with a tooth.
        #[derive(Debug, Clone, PartialEq)]
        #[non_exhaustive]
        pub enum Damage {
            $(#[doc = $summary] $kind($kind),)+
        }

        /// The parameters of each kind.
        pub(crate) mod kinds {
            $(pub use super::$file::$kind;)+
        }

        pub use kinds::*;

        $(impl From<$kind> for Damage {
            fn from(damage: $kind) -> Self {
                Self::$kind(damage)
            }
        })+

        impl Damage {
            /// The value of `kind` in the scenario file.
            pub fn kind(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => $kind::NAME,)+
                }
            }

            /// What it is, in a sentence.
            pub fn summary(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => $summary.trim_ascii(),)+
                }
            }

            /// Every kind by its name, with each key at its default.
            fn starts() -> Vec<(&'static str, Self)> {
                vec![$(($kind::NAME, Self::$kind($kind::start()))),+]
            }

            fn read(&mut self, table: &TomlTable<'_>) -> ReadResult<()> {
                match self {
                    $(Self::$kind(damage) => read_keys(damage, table, &NoFiles),)+
                }
            }

            fn check(&self, gears: &Gears) -> Check {
                match self {
                    $(Self::$kind(damage) => Kind::check(damage, gears),)+
                }
            }

            /// The teeth that it is on where none are named.
            pub(crate) fn usual_teeth(&self) -> FaultyTeeth {
                match self {
                    $(Self::$kind(_) => $kind::TEETH,)+
                }
            }

            /// Whether each tooth has random draws of its own, so that no two are alike.
            pub(crate) fn is_drawn(&self) -> bool {
                match self {
                    $(Self::$kind(damage) => damage.is_drawn(),)+
                }
            }

            /// Names of the keys that a severity stands in place of.
            fn sizes(&self) -> &'static [&'static str] {
                match self {
                    $(Self::$kind(_) => $kind::SIZES,)+
                }
            }

            /// Reads the keys that may stand beside a severity.
            fn read_but_sizes(&mut self, table: &TomlTable<'_>) -> ReadResult<()> {
                match self {
                    $(Self::$kind(damage) => read_rows(&rows_but($kind::SIZES), damage, table, &NoFiles),)+
                }
            }

            /// The lines of its keys, but for those that are left out.
            fn write(&self, left_out: &[&str]) -> String {
                match self {
                    $(Self::$kind(damage) => write_rows(&rows_but(left_out), damage),)+
                }
            }

            /// The same with a comment for every key.
            fn commented(&self, left_out: &[&str]) -> String {
                match self {
                    $(Self::$kind(damage) => commented_rows(&rows_but(left_out), damage, &$kind::start(), $kind::SECTION),)+
                }
            }

            /// The same of those alone that have no default, each with its meaning.
            fn essential(&self) -> String {
                match self {
                    $(Self::$kind(damage) => essential_rows(&rows_but(&[]), damage, &$kind::start()),)+
                }
            }

            fn check_but_sizes(&self) -> Check {
                match self {
                    $(Self::$kind(damage) => check_rows(&rows_but($kind::SIZES), damage, "fault"),)+
                }
            }

            fn without_sizes(&self) -> Self {
                match self {
                    $(Self::$kind(damage) => Self::$kind(severity::without_sizes(damage)),)+
                }
            }

            /// The damage with the sizes of a severity above 0; none where it is smaller than the profile's points can show.
            fn of_severity(&self, severity: f64, tooth: &SoundTooth) -> Option<Self> {
                match self {
                    $(Self::$kind(damage) => damage.of_severity(severity, tooth).map(Self::$kind),)+
                }
            }

            /// (-) How severe it is, from 0 to 1.
            fn severity(&self, tooth: &SoundTooth) -> f64 {
                match self {
                    $(Self::$kind(damage) => damage.severity(tooth),)+
                }
            }

            /// What it takes of a tooth.
            pub fn part(&self) -> ToothPart {
                match self {
                    $(Self::$kind(_) => $kind::PART,)+
                }
            }

            /// Whether its quantities have `area_percent`, the part of the flank that it takes.
            pub fn has_area(&self) -> bool {
                match self {
                    $(Self::$kind(_) => $kind::HAS_AREA,)+
                }
            }

            /// Whether its pairs' forces act beside the middle of the face or at another angle than the nominal one.
            pub(crate) fn moves_forces(&self) -> bool {
                match self {
                    $(Self::$kind(_) => $kind::MOVES_FORCES,)+
                }
            }

            fn damage(&self, tooth: &mut DamagedTooth, healthy: &HealthyTooth) -> DamageResult {
                match self {
                    $(Self::$kind(damage) => damage.damage(tooth, healthy),)+
                }
            }
        }

        /// Every kind of damage.
        pub fn damage_kinds() -> Vec<DamageKind> {
            vec![$(DamageKind {
                name: $kind::NAME,
                type_name: stringify!($kind),
                summary: $summary.trim_ascii(),
                keys: describe::<$kind>(),
                place: fault::keys_of_place(Damage::$kind($kind::start())),
                example: Damage::$kind($kind::example()),
                sizes: $kind::SIZES,
                rig: $kind::RIG,
            }),+]
        }
    };
}

kinds! {
    /// The tooth is gone.
    missing_tooth::MissingTooth,
    /// A corner of the tooth has chipped off.
    tooth_breakage::ToothBreakage,
    /// The root is cracked on the side of the working flank.
    root_crack::RootCrack,
    /// A pit in the flank, over a part of the face width, from one side.
    partial_face::PartialFace,
    /// A pit in the flank, over the whole face width.
    through_face::ThroughFace,
    /// Pits in the working flank, any number of them.
    pits::Pits,
    /// The working flank is ground down along a straight line.
    tooth_destruction::ToothDestruction,
    /// The working flanks are worn by sliding.
    wear::Wear,
}

/// A kind of damage, for documentation.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct DamageKind {
    /// The value of `kind` in the scenario file.
    pub name: &'static str,
    /// Its type in Rust and Python.
    pub type_name: &'static str,
    /// What it is, in a sentence.
    pub summary: &'static str,
    /// Its keys, beside those of every fault.
    pub keys: Vec<KeyDescription>,
    /// The keys of every fault beside `kind`, with the defaults of this kind.
    pub place: Vec<KeyDescription>,
    /// What a file to start from has.
    pub example: Damage,
    /// Its keys that a severity stands in place of, by their names.
    pub sizes: &'static [&'static str],
    pub(crate) rig: PaperRig,
}

impl Damage {
    /// A damage of the kind that a table names, its keys not read yet.
    fn start_of(table: &TomlTable<'_>) -> ReadResult<Self> {
        let starts = Self::starts();
        let names: Vec<_> = starts.iter().map(|(name, _)| format!("\"{name}\"")).collect();
        let meaning =
            format!("one of {}; for a healthy pair, leave out the section [fault]", names.join(", "));
        table.required("kind", &meaning)?.choice(&starts)
    }
}
