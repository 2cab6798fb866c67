//! Values that have a name.

/// Names of the values of an enum in the scenario file: `by_name!(Wheel, ["pinion" => Wheel::Pinion, …])`.
macro_rules! by_name {
    ($type:ty, [$($name:literal => $value:path),+ $(,)?]) => {
        impl $type {
            /// The name in the scenario file.
            pub fn name(self) -> &'static str {
                match self {
                    $($value => $name,)+
                }
            }
        }

        impl $crate::keys::KeyValue for $type {
            fn read(
                &mut self,
                value: &meshtone_toml::TomlValue<'_>,
                _files: &dyn $crate::keys::NumberFiles,
            ) -> meshtone_toml::ReadResult<()> {
                *self = [$($value),+][value.one_of(&[$($name),+])?];
                Ok(())
            }

            fn write(&self) -> $crate::keys::Written {
                $crate::keys::Written::Value(format!("\"{}\"", self.name()))
            }

            fn kind() -> $crate::keys::KeyKind {
                $crate::keys::KeyKind::Name(vec![$($name),+])
            }
        }
    };
}
pub(crate) use by_name;
