//! Quantities that are columns of numbers, in the scenario or in a file of their own.

use meshtone_toml::{ReadResult, TomlValue};

use super::files::{FileProblem, load};
use super::text::array;
use super::value::Written;

/// The columns of a quantity.
pub(crate) struct Columns<const N: usize> {
    /// What they are, with its article.
    pub(crate) noun: &'static str,
    pub(crate) names: [&'static str; N],
    /// What a file is not given beside, and what is to be removed then.
    pub(crate) inline: [&'static str; 2],
}

impl<const N: usize> Columns<N> {
    /// Reads the columns from a table, or from the file that it names.
    pub(crate) fn read(
        &self,
        value: &TomlValue<'_>,
        from_file: impl FnOnce(&str) -> Result<[Vec<f64>; N], FileProblem>,
    ) -> ReadResult<[Vec<f64>; N]> {
        let Self { noun, names, inline: [beside, removed] } = self;
        value.table()?.read(|table| {
            let given = names.map(|name| table.optional(name));
            let missing = names.iter().zip(&given).find(|(_, column)| column.is_none());
            match (table.optional("file"), missing) {
                (Some(file), _) if given.iter().all(Option::is_none) => load(&file, from_file),
                (Some(_), _) => {
                    let problem = format!("given beside {beside}; {noun} has only one source");
                    Err(table.error("file", problem).with_help(format!("remove the file, or the {removed}")))
                }
                (None, Some((missing, _))) => {
                    let inline = names.map(|name| format!("{name} = […]")).join(", ");
                    let problem = format!("missing; {noun} is {{ {inline} }} or {{ file = \"….csv\" }}");
                    Err(table.error(missing, problem))
                }
                (None, None) => {
                    let mut columns = std::array::from_fn(|_| Vec::new());
                    for (column, given) in columns.iter_mut().zip(given.iter().flatten()) {
                        *column = given.numbers()?;
                    }
                    Ok(columns)
                }
            }
        })
    }

    /// The columns as they are written in the scenario.
    pub(crate) fn write(&self, columns: [&[f64]; N]) -> Written {
        let line = |(name, column): (&str, &[f64])| (name.to_string(), array(column.iter().copied()));
        Written::Lines(self.names.into_iter().zip(columns).map(line).collect())
    }
}
