//! Values that have a name.

/// Names the values of an enum without fields, in the order of their declaration.
///
/// ```
/// #[derive(Clone, Copy)]
/// pub enum Side {
///     Left,
///     Right,
/// }
/// meshtone_toml::named!(Side { Left = "left", Right = "right" });
/// assert_eq!((Side::NAMES.len(), Side::ALL[1].name()), (2, "right"));
/// ```
#[macro_export]
macro_rules! named {
    ($type:ident { $($value:ident = $name:literal),+ $(,)? }) => {
        impl $type {
            /// All values.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$value),+];
            /// All values with their names.
            pub const NAMES: [(&'static str, Self); Self::ALL.len()] = [$(($name, Self::$value)),+];

            /// Its name.
            pub const fn name(self) -> &'static str {
                Self::NAMES[self as usize].0
            }
        }
    };
}
