//! The key `model`.

use meshtone_toml::{ReadResult, TomlValue};

use super::{KeyKind, KeyValue, NumberFiles, Written};
use crate::model::Model;

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
