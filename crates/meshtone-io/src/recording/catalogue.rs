//! The arrays of a file that holds several, as columns.

use std::path::Path;

use meshtone_toml::nearest_name;

use super::array::{ArrayLayout, shape_text};
use super::label::Label;
use super::number::NumberKind;
use super::rate::StatedRate;
use super::{ReadRecordingError, RecordingOptions};

/// Arrays beyond which a file is none that recordings come in; each costs memory.
pub(super) const MAX_ARRAYS: usize = 10_000;
/// Columns of all arrays together, likewise.
const MAX_COLUMNS: usize = 100_000;

/// How the numbers of an array stand in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Numbers {
    pub kind: NumberKind,
    pub big_endian: bool,
}

/// An array, before it is read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ArrayEntry {
    /// Its name, or the path to it; empty if it has none.
    pub name: String,
    pub shape: Vec<u64>,
    /// Whether neighbours in the first dimension are neighbours in the file.
    pub first_runs_fastest: bool,
    /// How its numbers stand in the file; what it holds instead, if those are not real numbers.
    pub numbers: Result<Numbers, String>,
    /// Its type, for messages.
    pub type_name: String,
    /// Its number, if it holds only one.
    pub single: Option<f64>,
    /// Whether it is 0 throughout and another array has its name.
    pub is_zero_twin: bool,
}

impl ArrayEntry {
    fn described(&self) -> String {
        format!("{} ({} {})", self.name, shape_text(&self.shape), self.type_name)
    }

    /// Whether it holds one number only.
    pub(super) fn is_single(&self) -> bool {
        self.shape.iter().all(|length| *length == 1)
    }
}

/// Where a column's samples are.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    entry: usize,
    channel: usize,
}

/// The columns of all arrays, or of the chosen variable.
#[derive(Debug)]
pub(super) struct Catalogue {
    pub labels: Vec<Label>,
    places: Vec<Place>,
    pub stated: Vec<StatedRate>,
}

impl Catalogue {
    /// Makes columns of arrays.
    ///
    /// # Arguments
    /// * `path`, `options` - of the recording
    /// * `entries` - the file's arrays
    /// * `units_in_names` - whether a name such as `acc [g]` says the unit
    pub(super) fn new(
        path: &Path,
        entries: &[ArrayEntry],
        options: &RecordingOptions,
        units_in_names: bool,
    ) -> Result<Catalogue, ReadRecordingError> {
        let variable = options.variable.as_deref().map(str::trim);
        let chosen = |entry: &ArrayEntry| variable.is_none_or(|variable| is_within(&entry.name, variable));
        let rates = |within: bool| -> Vec<StatedRate> {
            let entries = entries.iter().filter(|entry| !within || chosen(entry));
            entries.filter_map(|entry| StatedRate::from_named(&entry.name, entry.single?)).collect()
        };
        let inside = rates(true);
        let stated = if inside.is_empty() { rates(false) } else { inside };
        let mut catalogue = Catalogue { labels: Vec::new(), places: Vec::new(), stated };
        for (index, entry) in entries.iter().enumerate().filter(|(_, entry)| chosen(entry)) {
            if !entry.is_single() || entry.name.is_empty() || variable == Some(entry.name.as_str()) {
                catalogue.add(index, entry, variable, units_in_names);
            }
        }
        if catalogue.labels.len() > MAX_COLUMNS {
            let problem = format!("its arrays have more than {MAX_COLUMNS} columns; choose a variable");
            return Err(ReadRecordingError::Ambiguous {
                path: path.to_path_buf(),
                problem,
                present: Vec::new(),
            });
        }
        let useless = catalogue.labels.iter().all(|label| label.not_numeric.is_some());
        match variable {
            Some(variable) if useless => Err(no_variable(path, entries, variable)),
            _ => Ok(catalogue),
        }
    }

    fn add(&mut self, index: usize, entry: &ArrayEntry, variable: Option<&str>, units_in_names: bool) {
        let layout = ArrayLayout::of_shape(&entry.shape, entry.first_runs_fastest);
        let layout = entry.numbers.clone().and(layout);
        let name = short_name(&entry.name, variable);
        let label = |name: &str| Label {
            raw: name.to_string(),
            name: name.to_string(),
            unit: None,
            array: None,
            not_numeric: None,
            is_zero_twin: entry.is_zero_twin,
        };
        let mut push = |label: Label, channel: usize| {
            self.labels.push(label);
            self.places.push(Place { entry: index, channel });
        };
        match layout {
            Err(kind) => push(Label { not_numeric: Some(kind), ..label(name) }, 0),
            Ok(layout) if layout.channels == 1 => push(
                match (name, units_in_names) {
                    ("", _) => Label::numbered("channel", 1),
                    (_, true) => Label::from_header(name),
                    (_, false) => label(name),
                },
                0,
            ),
            Ok(layout) => {
                for channel in 0..layout.channels.min(MAX_COLUMNS) {
                    let number = channel + 1;
                    let column = if name.is_empty() {
                        Label::numbered("channel", number)
                    } else {
                        Label { array: Some(name.to_string()), ..label(&format!("{name} {number}")) }
                    };
                    push(column, channel);
                }
            }
        }
    }

    /// Samples of columns.
    ///
    /// # Arguments
    /// * `wanted` - the columns
    /// * `entries` - those that the catalogue was made of
    pub(super) fn samples<'c>(
        &'c self,
        wanted: &'c [usize],
        entries: &'c [ArrayEntry],
    ) -> impl Iterator<Item = u64> + 'c {
        let layout = |entry: &ArrayEntry| ArrayLayout::of_shape(&entry.shape, entry.first_runs_fastest);
        wanted.iter().map(move |column| {
            layout(&entries[self.places[*column].entry]).map_or(0, |layout| layout.samples)
        })
    }

    /// Reads columns, array by array.
    ///
    /// # Arguments
    /// * `wanted` - the columns, rising
    /// * `entries` - those that the catalogue was made of
    /// * `read` - reads the wanted channels of the array with an index
    pub(super) fn read(
        &self,
        wanted: &[usize],
        entries: &[ArrayEntry],
        mut read: impl FnMut(usize, ArrayLayout, Numbers, &[bool]) -> Result<Vec<Vec<f64>>, ReadRecordingError>,
    ) -> Result<Vec<Vec<f64>>, ReadRecordingError> {
        let mut samples = Vec::with_capacity(wanted.len());
        let mut rest = wanted;
        while let Some(first) = rest.first() {
            let index = self.places[*first].entry;
            let same = rest.iter().take_while(|column| self.places[**column].entry == index).count();
            let entry = &entries[index];
            let layout = ArrayLayout::of_shape(&entry.shape, entry.first_runs_fastest);
            if let (Ok(layout), Ok(numbers)) = (layout, &entry.numbers) {
                let mut channels = vec![false; layout.channels];
                rest[..same].iter().for_each(|column| channels[self.places[*column].channel] = true);
                samples.extend(read(index, layout, *numbers, &channels)?);
            }
            rest = &rest[same..];
        }
        Ok(samples)
    }
}

/// Whether a path is the variable, or leads into it. `a(1)` and `a` are the same where `a` is single.
fn is_within(name: &str, variable: &str) -> bool {
    let within = |variable: &str| {
        let rest = name.strip_prefix(variable);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '(', '{']))
    };
    within(variable) || within(&variable.replace("(1)", ""))
}

/// The name inside the variable.
fn short_name<'n>(name: &'n str, variable: Option<&str>) -> &'n str {
    let inside = variable.and_then(|variable| name.strip_prefix(variable)?.strip_prefix('.'));
    inside.unwrap_or(name)
}

fn no_variable(path: &Path, entries: &[ArrayEntry], wanted: &str) -> ReadRecordingError {
    let nearest = nearest_name(wanted, entries.iter().map(|entry| entry.name.as_str()));
    let nearest = nearest.filter(|nearest| *nearest != wanted).map(str::to_string);
    let present = entries.iter().map(ArrayEntry::described).collect();
    ReadRecordingError::NoVariable { path: path.to_path_buf(), wanted: wanted.to_string(), nearest, present }
}
