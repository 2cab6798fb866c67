//! The arrays of a file that holds several, as columns.

use meshtone_toml::nearest_name;

use super::array::{ArrayLayout, shape_text};
use super::assemble::assemble;
use super::error::Problem;
use super::label::Label;
use super::number::Numbers;
use super::rate::{self, StatedRate};
use super::selection::{Selection, select};
use super::{Recording, RecordingOptions, RecordingWarning, memory_need};
use crate::memory;

/// Arrays beyond which a file is none that recordings come in; each costs memory.
pub(super) const MAX_ARRAYS: usize = 10_000;
/// Structs, cells or groups inside each other beyond which a file is none that recordings come in.
pub(super) const MAX_DEPTH: usize = 32;
/// Bytes of samples that a compressed byte may well stand for; memory for more is taken only as they come.
pub(super) const USUAL_COMPRESSION: u64 = 16;
/// Columns of all arrays together, likewise.
const MAX_COLUMNS: usize = 100_000;

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
    /// (bytes) What reading it takes beside the samples.
    pub beside_bytes: u64,
    /// Whether it is 0 throughout and another array has its name.
    pub is_zero_twin: bool,
}

impl ArrayEntry {
    fn described(&self) -> String {
        format!("{} ({} {})", self.name, shape_text(&self.shape), self.type_name)
    }

    fn layout(&self) -> Result<ArrayLayout, String> {
        ArrayLayout::of_shape(&self.shape, self.first_runs_fastest)
    }

    /// Whether it holds one number only.
    fn is_single(&self) -> bool {
        self.shape.iter().all(|length| *length == 1)
    }
}

/// Reads a recording whose channels are those of arrays.
///
/// # Arguments
/// * `entries` - the file's arrays
/// * `options` - of the recording
/// * `units_in_names` - whether a name such as `acc [g]` says the unit
/// * `read` - reads the wanted channels of the array with an index
pub(super) fn read_arrays(
    entries: &[ArrayEntry],
    options: &RecordingOptions,
    units_in_names: bool,
    mut read: impl FnMut(usize, ArrayLayout, Numbers, &[bool]) -> Result<Vec<Vec<f64>>, Problem>,
) -> Result<Recording, Problem> {
    let catalogue = Catalogue::new(entries, options, units_in_names)?;
    let Catalogue { labels, stated, .. } = &catalogue;
    let selection = select(labels, options)?;
    let samples = |column: usize| catalogue.layout(column).map_or(0, |layout| layout.samples);
    let of_wanted = selection.wanted.iter().filter_map(|column| catalogue.places.get(*column));
    let beside_bytes = of_wanted.map(|(array, _)| entries[*array].beside_bytes).max().unwrap_or_default();
    memory_need::check(memory::limit(), options, &selection, samples, beside_bytes)?;
    let samples = catalogue.read(&selection.wanted, &mut read)?;
    let single = |entry: &ArrayEntry| Some(format!("{} = {}", entry.name, entry.single?));
    let singles: Vec<String> = entries.iter().filter_map(single).collect();
    let recording = assemble(labels, &selection, samples, stated, options);
    let mut recording = recording.map_err(|problem| problem.with_numbers(&singles))?;
    recording.warnings.extend(zero_twins(labels, &selection));
    let times = |column: usize| Ok(catalogue.read(&[column], &mut read)?.concat());
    recording.warnings.extend(rate::other_than_timed(labels, &selection, options, times));
    Ok(recording)
}

/// The columns of all arrays, or of the chosen variable.
struct Catalogue<'e> {
    entries: &'e [ArrayEntry],
    labels: Vec<Label>,
    /// Of each column, the index of its array and its channel in it.
    places: Vec<(usize, usize)>,
    stated: Vec<StatedRate>,
}

impl<'e> Catalogue<'e> {
    fn new(
        entries: &'e [ArrayEntry],
        options: &RecordingOptions,
        units_in_names: bool,
    ) -> Result<Self, Problem> {
        let variable = options.variable.as_deref().map(str::trim);
        let chosen = |entry: &ArrayEntry| variable.is_none_or(|variable| is_within(&entry.name, variable));
        let rates = |within: bool| -> Vec<StatedRate> {
            let entries = entries.iter().filter(|entry| !within || chosen(entry));
            entries.filter_map(|entry| StatedRate::from_named(&entry.name, entry.single?)).collect()
        };
        let inside = rates(true);
        let stated = if inside.is_empty() { rates(false) } else { inside };
        let mut catalogue = Catalogue { entries, labels: Vec::new(), places: Vec::new(), stated };
        for (index, entry) in entries.iter().enumerate().filter(|(_, entry)| chosen(entry)) {
            if !entry.is_single() || entry.name.is_empty() || variable == Some(entry.name.as_str()) {
                catalogue.add(index, entry, variable, units_in_names);
            }
        }
        if catalogue.labels.len() > MAX_COLUMNS {
            let problem = format!("its arrays have more than {MAX_COLUMNS} columns; choose a variable");
            return Err(Problem::Refused(problem));
        }
        let useless = catalogue.labels.iter().all(|label| label.not_numeric.is_some());
        match variable {
            Some(variable) if useless => Err(no_variable(entries, variable)),
            _ => Ok(catalogue),
        }
    }

    fn add(&mut self, index: usize, entry: &ArrayEntry, variable: Option<&str>, units_in_names: bool) {
        let name = short_name(&entry.name, variable);
        let samples = entry.layout().ok().map(|layout| layout.samples);
        let plain = |name: &str| Label { is_zero_twin: entry.is_zero_twin, samples, ..Label::plain(name) };
        let labels = match entry.numbers.clone().and_then(|_| entry.layout()) {
            Err(kind) => vec![Label { not_numeric: Some(kind), ..plain(name) }],
            Ok(ArrayLayout { channels, .. }) => match (name, channels) {
                ("", _) => (1..=channels).map(|number| Label::numbered("channel", number)).collect(),
                (_, 1) if units_in_names => vec![Label { samples, ..Label::from_header(name) }],
                (_, 1) => vec![plain(name)],
                _ => {
                    let of_array = |number| plain(&format!("{name} {number}"));
                    let of_array = (1..=channels).map(of_array);
                    of_array.map(|label| Label { array: Some(name.to_string()), ..label }).collect()
                }
            },
        };
        self.places.extend((0..labels.len()).map(|channel| (index, channel)));
        self.labels.extend(labels);
    }

    fn layout(&self, column: usize) -> Result<ArrayLayout, String> {
        self.entries[self.places[column].0].layout()
    }

    /// Reads columns, array by array.
    ///
    /// # Arguments
    /// * `wanted` - the columns, rising
    /// * `read` - reads the wanted channels of the array with an index
    fn read(
        &self,
        wanted: &[usize],
        mut read: impl FnMut(usize, ArrayLayout, Numbers, &[bool]) -> Result<Vec<Vec<f64>>, Problem>,
    ) -> Result<Vec<Vec<f64>>, Problem> {
        let mut samples = Vec::with_capacity(wanted.len());
        for of_array in wanted.chunk_by(|one, next| self.places[*one].0 == self.places[*next].0) {
            let index = self.places[of_array[0]].0;
            let entry = &self.entries[index];
            if let (Ok(layout), Ok(numbers)) = (entry.layout(), &entry.numbers) {
                let mut channels = vec![false; layout.channels];
                of_array.iter().for_each(|column| channels[self.places[*column].1] = true);
                samples.extend(read(index, layout, *numbers, &channels)?);
            }
        }
        Ok(samples)
    }
}

/// Zero twins of what was read, which were left out.
fn zero_twins(labels: &[Label], selection: &Selection) -> Vec<RecordingWarning> {
    let is_read = |name: &str| selection.channels.iter().any(|&index| labels[index].raw == name);
    let warning = |(index, label): (usize, &Label)| {
        let left_out = label.is_zero_twin && !selection.channels.contains(&index) && is_read(&label.raw);
        left_out.then(|| RecordingWarning::ZeroTwin { name: label.raw.clone(), number: index + 1 })
    };
    labels.iter().enumerate().filter_map(warning).collect()
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

fn no_variable(entries: &[ArrayEntry], wanted: &str) -> Problem {
    let nearest = nearest_name(wanted, entries.iter().map(|entry| entry.name.as_str()));
    let nearest = nearest.filter(|nearest| *nearest != wanted);
    let present: Vec<String> = entries.iter().map(ArrayEntry::described).collect();
    Problem::absent(&format!("variable `{wanted}` that holds numbers"), nearest, &present)
}
