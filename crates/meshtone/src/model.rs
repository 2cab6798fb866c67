//! Which model is simulated.

use meshtone_toml::{ReadResult, TomlValue};

use crate::keys::{KeyKind, KeyValue, NumberFiles, Written};

/// Which reading of the mesh is simulated.
///
/// The published code differs from the theory of its own paper in several places (listed in the
/// chapter "Published, linear and contact" of the documentation).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[non_exhaustive]
pub enum Model {
    /// Teeth that push and never pull, on shafts that bend, in supports that a sensor sits on. The default.
    #[default]
    Contact,
    /// The theory of a linear mesh: flanks that are conjugate, loads that act at the flank's own angle, one angle for
    /// stiffness and deviations.
    Linear,
    /// The published code, its known errors included, so that results can be compared number by number.
    Published,
}

impl Model {
    /// All of them, the default first.
    pub const ALL: [Self; 3] = [Self::Contact, Self::Linear, Self::Published];

    /// The name in the scenario file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Contact => "contact",
            Self::Linear => "linear",
            Self::Published => "published",
        }
    }
}

impl KeyValue for Model {
    fn read(&mut self, value: &TomlValue<'_>, _files: &dyn NumberFiles) -> ReadResult<()> {
        *self = value.choice(&names())?;
        Ok(())
    }

    fn write(&self) -> Written {
        Written::Value(format!("\"{}\"", self.name()))
    }

    fn kind() -> KeyKind {
        KeyKind::Name(names().map(|(name, _)| name).to_vec())
    }
}

fn names() -> [(&'static str, Model); 3] {
    Model::ALL.map(|model| (model.name(), model))
}
