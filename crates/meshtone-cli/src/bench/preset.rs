//! The public sets that are known, and their recordings in a folder.

use std::cmp::Reverse;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use meshtone::scenario::{GearboxRig, Scenario, gearbox_template};
use meshtone_io::recording::{RecordingOptions, read_recording};
use meshtone_toml::{ReadResult, TomlDocument, TomlTable, TomlValue};

use crate::failure::Failure;
use crate::indicators::bearings::{NamedChoice, bearing};
use crate::indicators::options::ReadingOptions;
use crate::terminal::warn;

/// State of what has no damage.
pub const HEALTHY: &str = "healthy";
const PRESETS: &str = include_str!("presets.toml");
/// Folders within folders in which recordings are looked for; a link may lead back.
const MOST_LEVELS: usize = 8;

/// A public set.
pub struct Preset {
    pub name: String,
    pub title: String,
    pub reference: String,
    /// Where each number is from.
    pub sources: Vec<String>,
    pub machine: Machine,
    rpm_variable: Option<String>,
    channels: Vec<String>,
    unit: Option<String>,
    /// Names of files, with what each is.
    files: Vec<(String, Label)>,
}

/// What the recordings are of.
pub enum Machine {
    Bearing(NamedChoice),
    /// With the classes of damage that its recordings may be of.
    Gearbox(Box<Scenario>, Vec<String>),
}

/// What the set says of a file.
#[derive(Clone)]
pub struct Label {
    /// `healthy`, a race, or another damage.
    pub is: String,
    pub size: Option<String>,
    /// (Hz) Of a bearing's shaft.
    pub shaft_hz: Option<f64>,
    /// (S/s) Where it is stated.
    pub sampling_rate_hz: Option<f64>,
}

/// One channel of a file.
pub struct Recorded {
    pub path: PathBuf,
    pub channel: String,
    pub label: Label,
    /// The number at the end of the file's name, such as the load.
    pub number: String,
    /// How it is read.
    pub reading: ReadingOptions,
}

impl Preset {
    /// All sets.
    pub fn all() -> Result<Vec<Self>, Failure> {
        let document = TomlDocument::parse(PRESETS);
        let sets = document.and_then(|document| {
            document.root().read(|root| root.tables("set")?.into_iter().map(Self::read).collect())
        });
        sets.map_err(|error| Failure::failed(format!("presets.toml: {error}")))
    }

    /// Reads a set. The lists of files, and the speeds that go by the places in them, become one list of files with what each is, so that nothing else knows of
    /// groups.
    fn read(table: TomlTable<'_>) -> ReadResult<Self> {
        let owned = |of: &TomlValue<'_>| of.string().map(str::to_owned);
        let text = |table: &TomlTable<'_>, key| owned(&table.required(key, "text")?);
        let texts = |table: &TomlTable<'_>, key| -> ReadResult<Vec<String>> {
            table.required(key, "texts")?.array()?.iter().map(owned).collect()
        };
        table.read(|set| {
            let machine = match set.read_optional("rig", rig)? {
                Some(scenario) => Machine::Gearbox(Box::new(scenario), texts(set, "classes")?),
                None => {
                    let named = set.required("bearing", "the bearing")?;
                    Machine::Bearing(bearing(named.string()?).map_err(|problem| named.error(problem))?)
                }
            };
            let shaft_hz = set.read_optional("shaft_hz", TomlValue::numbers)?.unwrap_or_default();
            let (of_set_hz, mut files) = (set.number("sampling_rate_hz")?, Vec::new());
            for group in set.tables("recordings")? {
                let (is, size) = (text(&group, "is")?, group.read_optional("size", owned)?);
                let sampling_rate_hz = group.number("sampling_rate_hz")?.or(of_set_hz);
                for (place, file) in texts(&group, "files")?.into_iter().enumerate() {
                    let shaft_hz = shaft_hz.get(place).or(shaft_hz.last()).copied();
                    let label = Label { is: is.clone(), size: size.clone(), shaft_hz, sampling_rate_hz };
                    files.push((file, label));
                }
                group.refuse_unknown(&[])?;
            }
            Ok(Self {
                name: text(set, "name")?,
                title: text(set, "title")?,
                reference: text(set, "reference")?,
                sources: texts(set, "sources")?,
                machine,
                rpm_variable: set.read_optional("rpm_variable", owned)?,
                channels: texts(set, "channels")?,
                unit: set.read_optional("unit", owned)?,
                files,
            })
        })
    }

    /// Finds the set that a folder holds: the stated one, or that which most names of files are of.
    ///
    /// # Arguments
    /// * `directory` - the folder
    /// * `stated` - name of the set
    ///
    /// Returns the set and its recordings, in the order of the preset.
    pub fn find(directory: &Path, stated: Option<&str>) -> Result<(Self, Vec<Recorded>), Failure> {
        let mut files = Vec::new();
        let (shown, unknown) = (directory.display(), stated.unwrap_or_default());
        files_beneath(directory, MOST_LEVELS, &mut files).map_err(|error| {
            Failure::of_reading(error.kind(), format!("cannot read the folder {shown}: {error}"))
        })?;
        let all = Self::all()?;
        let names: Vec<String> = all.iter().map(|set| set.name.clone()).collect();
        let chosen = all.into_iter().filter(|set| stated.is_none_or(|name| set.name == name));
        let mut found: Vec<(Vec<Recorded>, Self)> = chosen.map(|set| (set.among(&files), set)).collect();
        let looked_for: Vec<String> = found.iter().map(|(_, set)| set.in_words()).collect();
        found.sort_by_key(|(recorded, set)| Reverse(recorded.len() / set.channels.len()));
        for (_, Self { name, .. }) in found.iter().skip(1).filter(|(recorded, _)| !recorded.is_empty()) {
            warn(format_args!("{shown} also holds recordings of {name}, which --set {name} scores"));
        }
        match found.into_iter().next() {
            None => {
                let problem = format!("--set {unknown}: there is no such set");
                Failure::refuse(problem, format!("name one of {}", names.join(", ")))
            }
            Some((recorded, _)) if recorded.is_empty() => {
                let problem = format!("{shown}: none of the {} files in it has a name of a set", files.len());
                Failure::refuse(
                    problem,
                    format!("looked for are {}; were they renamed?", looked_for.join("; ")),
                )
            }
            Some((recorded, set)) => Ok((set, recorded)),
        }
    }

    /// `cwru (97.mat, 98.mat, 99.mat, …)`.
    fn in_words(&self) -> String {
        let files = self.files.iter().take(3).map(|(file, _)| file.replace('#', "*"));
        format!("{} ({}, …)", self.name, files.collect::<Vec<_>>().join(", "))
    }

    /// The recordings of the set among files, in the order of the preset and of the numbers in their names.
    fn among(&self, files: &[PathBuf]) -> Vec<Recorded> {
        let mut found = Vec::new();
        for (pattern, label) in &self.files {
            let named = files.iter().filter(|path| is_named(pattern, &file_name(path)));
            let mut named: Vec<&PathBuf> = named.collect();
            named.sort_by_key(|path| (number(path).parse::<u64>().ok(), *path));
            for path in named {
                found.extend(self.channels.iter().map(|channel| self.recorded(path, label.clone(), channel)));
            }
        }
        found
    }

    fn recorded(&self, path: &Path, mut label: Label, channel: &str) -> Recorded {
        let number = number(path);
        let own = self.rpm_variable.as_ref().and_then(|variable| rpm(path, &numbered(variable, &number)));
        label.shaft_hz = own.map(|rpm| rpm / 60.0).or(label.shaft_hz);
        let channel = numbered(channel, &number);
        let reading = ReadingOptions {
            channel: Some(channel.clone()),
            sampling_rate_hz: label.sampling_rate_hz,
            unit: self.unit.clone(),
            ..ReadingOptions::default()
        };
        Recorded { path: path.to_path_buf(), channel, label, number, reading }
    }
}

/// Name of a file.
pub fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// The scenario of a rig. Its sensors are not known.
fn rig(value: &TomlValue<'_>) -> ReadResult<Scenario> {
    let named: Vec<(&str, GearboxRig)> = GearboxRig::ALL.map(|rig| (rig.name(), rig)).to_vec();
    let scenario = Scenario::from_toml(&gearbox_template(Some(value.choice(&named)?)));
    Ok(scenario.map_err(|error| value.error(error.to_string()))?.with_sensors(Vec::new()))
}

/// All files in a folder and in those within it.
fn files_beneath(directory: &Path, levels: usize, found: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(directory)? {
        let path = entry?.path();
        match path.is_dir() {
            // What may not be looked into holds no recordings.
            true if levels > 0 => drop(files_beneath(&path, levels - 1, found)),
            true => {}
            false => found.push(path),
        }
    }
    Ok(())
}

/// Whether a file has a name, alone or behind words that a copy of the set put before it, as in `12k_Drive_End_IR007_0_105.mat`.
fn is_named(pattern: &str, name: &str) -> bool {
    let fits = |name: &str| match pattern.split_once('#') {
        None => name == pattern,
        Some((head, tail)) => {
            let digits = name.strip_prefix(head).and_then(|rest| rest.strip_suffix(tail));
            digits
                .is_some_and(|digits| !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit()))
        }
    };
    // Names with a leading point are a system's own.
    !name.starts_with('.') && (fits(name) || name.match_indices('_').any(|(at, _)| fits(&name[at + 1..])))
}

/// The number at the end of a file's name.
fn number(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    stem[stem.trim_end_matches(|letter: char| letter.is_ascii_digit()).len()..].to_owned()
}

/// A name with a number in place of its run of `#`.
fn numbered(name: &str, number: &str) -> String {
    let width = name.matches('#').count();
    name.replacen(&"#".repeat(width.max(1)), &format!("{number:0>width$}"), 1)
}

/// (rev/min) A number of a file.
fn rpm(path: &Path, variable: &str) -> Option<f64> {
    let options = RecordingOptions {
        variable: Some(variable.to_owned()),
        sampling_rate_hz: Some(1.0),
        ..RecordingOptions::default()
    };
    let rpm = *read_recording(path, &options).ok()?.channels.first()?.samples.first()?;
    (rpm.is_finite() && rpm > 0.0).then_some(rpm)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use std::collections::BTreeSet;

    use meshtone::signal::DefectKind;

    use super::*;

    #[test]
    fn every_file_has_one_state_that_can_be_told() {
        for set in Preset::all().unwrap() {
            let races = DefectKind::ALL.map(DefectKind::name);
            let can_be_told = |is: &str| is == HEALTHY || races.contains(&is);
            let is_bearing = matches!(set.machine, Machine::Bearing(_));
            assert!(set.files.iter().any(|(_, label)| label.is == HEALTHY), "{}", set.name);
            assert!(!is_bearing || set.files.iter().all(|(_, label)| can_be_told(&label.is)), "{}", set.name);
            let files: Vec<&String> = set.files.iter().map(|(file, _)| file).collect();
            assert_eq!(files.iter().collect::<BTreeSet<_>>().len(), files.len(), "{}", set.name);
            assert!(!set.channels.is_empty() && !set.sources.is_empty());
        }
    }

    #[test]
    fn names_of_files_and_of_variables() {
        assert!(is_named("97.mat", "97.mat") && is_named("97.mat", "48k_Normal_0_97.mat"));
        assert!(!is_named("97.mat", "197.mat") && !is_named("97.mat", "._97.mat"));
        assert!(is_named("OuterRaceFault_#.mat", "OuterRaceFault_3.mat"));
        assert!(!is_named("OuterRaceFault_#.mat", "OuterRaceFault_vload_3.mat"));
        assert!(!is_named("h30hz#.csv", "h30hz.csv") && is_named("h30hz#.csv", "h30hz50.csv"));
        assert_eq!(number(Path::new("Healthy/h30hz50.csv")), "50");
        assert_eq!([numbered("X###RPM", "97"), numbered("a1", "97")], ["X097RPM", "a1"]);
    }
}
