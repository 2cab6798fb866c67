//! Keys of the scenario file: one row a key.
//!
//! A struct of parameters says in [`Keys::rows`] what its keys are: name, unit, meaning, range and the field that holds the
//! value. From these rows come the reading of a scenario file, its writing, the checks of single values, the commented files
//! of `meshtone init`, the guide's lists and the arguments of the Python classes. What concerns several keys at once is a
//! function beside the rows.
//!
//! ```ignore
//! keys! {
//!     Shaft = Shaft { length_mm: 200.0, radius_mm: 10.0 };
//!     length_mm "mm" "length between wheel and motor or brake" .range(Range::positive().implausible_above(1e6));
//!     radius_mm "mm" "radius, which is also the wheel's bore"
//!         .range(Range::positive()).rule("less than the root radius");
//! }
//! ```

mod cell;
mod check;
mod columns;
mod description;
mod files;
mod head;
mod model;
mod names;
mod range;
mod row;
mod table;
mod text;
mod value;

pub(crate) use cell::{Field, flatten};
pub(crate) use check::{Check, below, refuse, require};
pub(crate) use columns::Columns;
pub use description::{KeyDescription, KeyKind};
pub use files::FileProblem;
pub(crate) use files::{NoFiles, NumberFiles, load};
pub(crate) use names::by_name;
pub(crate) use range::Range;
pub(crate) use row::{KeyRow, documented, row, sub_table};
pub(crate) use table::{
    Keys, check_keys, check_rows, commented, commented_rows, describe, describe_from, describe_rows,
    essential_rows, read_keys, read_rows, rows_but, rows_of, write_keys, write_rows,
};
pub(crate) use text::{array, comment};
pub(crate) use value::{KeyValue, Written};

/// The field of a section that a row's value is kept in.
///
/// `field!(name)` is a field, `field!(place.name)` one further inside, `field!(in Section: name)` that of a section that is named; `field!(Form::Variant, name)` is there only where the
/// section, an enum, has that form; `field!(Form::Variant, 0)` is its only value.
macro_rules! field {
    (in $section:ty: $($name:ident).+) => {
        $crate::keys::Field::new(|section: &$section| Some(&section.$($name).+), |section: &mut $section| Some(&mut section.$($name).+))
    };
    ($($name:ident).+) => {
        $crate::keys::Field::new(|section: &Self| Some(&section.$($name).+), |section: &mut Self| Some(&mut section.$($name).+))
    };
    ($form:path, 0) => {
        $crate::keys::Field::new(
            |section: &Self| match section {
                $form(value) => Some(value),
                _ => None,
            },
            |section: &mut Self| match section {
                $form(value) => Some(value),
                _ => None,
            },
        )
    };
    ($form:path, $name:ident) => {
        $crate::keys::Field::new(
            |section: &Self| match section {
                $form { $name, .. } => Some($name),
                _ => None,
            },
            |section: &mut Self| match section {
                $form { $name, .. } => Some($name),
                _ => None,
            },
        )
    };
}
pub(crate) use field;

/// The rows of a section, in the order of the documentation: the field, whose name is the key's, its unit and its meaning, then what
/// else is known of it. Before a field of one form of the section stands that form in brackets, with `0` where it is the form's only
/// value, and before one further inside its place in parentheses, before a field of another name than the key that name in angles; `=` begins a row that is made otherwise, and `..` several.
macro_rules! rows {
    ($($(.. $others:block)? $(= $other:block)? $(
        $([$form:path $(, $only:literal)?])? $(<$field:ident>)? $(($place:ident))? $name:ident $unit:literal $meaning:literal $(. $known:ident ($($word:expr),*))*
    )?;)*) => {{
        let mut rows = Vec::new();
        $(
            $(rows.extend($others);)?
            $(rows.extend([$other]);)?
            $(rows.extend([
                $crate::keys::row(stringify!($name), $unit, $meaning, $crate::keys::rows!(@ $([$form $(, $only)?])? $(<$field>)? $(($place))? $name))$(.$known($($word),*))*
            ]);)?
        )*
        rows
    }};
    (@ [$form:path, $only:literal] $name:ident) => { $crate::keys::field!($form, 0) };
    (@ [$form:path] $name:ident) => { $crate::keys::field!($form, $name) };
    (@ <$field:ident> $name:ident) => { $crate::keys::field!($field) };
    (@ ($place:ident) $name:ident) => { $crate::keys::field!($place.$name) };
    (@ $name:ident) => { $crate::keys::field!($name) };
}
pub(crate) use rows;

/// The keys of a type: what they are before a file is read, which may also be the `default`, then their [`rows`]; before it the section's name, if it has one. Which form
/// a table has is decided by a field (`chosen by`) or a method (`chosen with`).
macro_rules! keys {
    ($($section:literal:)? $type:ident = default $start:expr $(, chosen with $form:ident)?; $($rows:tt)*) => {
        impl Default for $type {
            fn default() -> Self {
                $start
            }
        }

        $crate::keys::keys! { $($section:)? $type = Self::default() $(, chosen with $form)?; $($rows)* }
    };
    ($($section:literal:)? $type:ident = $start:expr $(, chosen by $part:ident)? $(, chosen with $form:ident)?; $($rows:tt)*) => {
        impl $crate::keys::Keys for $type {
            $(const SECTION: &str = $section;)?

            fn start() -> Self {
                $start
            }

            fn rows() -> Vec<$crate::keys::KeyRow<Self>> {
                $crate::keys::rows! { $($rows)* }
            }

            $(fn choose(&mut self, table: &meshtone_toml::TomlTable<'_>, files: &dyn $crate::keys::NumberFiles) -> meshtone_toml::ReadResult<()> {
                self.$part.choose(table, files)
            })?

            $(fn choose(&mut self, table: &meshtone_toml::TomlTable<'_>, _: &dyn $crate::keys::NumberFiles) -> meshtone_toml::ReadResult<()> {
                self.$form(table)
            })?
        }
    };
}
pub(crate) use keys;
