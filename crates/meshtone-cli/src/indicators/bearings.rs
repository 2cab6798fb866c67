//! Bearings: the options that name them, the verdict about each, and the lines of their defects in a recording.

use clap::Args;
use meshtone::bearing::{BearingGeometry, NAMED_BEARINGS, NamedBearing};
use meshtone::signal::{
    BearingRecords, BearingSeparation, BearingSettings, EnvelopeBand, FrequencyBand, GearTrain, SignalError,
    TrainBearing, TrainRecording,
};
use meshtone_io::indicators::BearingEntry;
use serde_json::{Value, json};

use super::train::find;
use crate::choice::{Choice, name_of, one_of};
use crate::failure::Failure;

/// Bearings, and how the lines of their defects are looked for.
#[derive(Debug, Default, Args)]
#[command(next_help_heading = "Bearings")]
pub struct BearingOptions {
    /// Rolling bearing that is judged, by what a sensor at its seat records, and the shaft in its inner ring: by its name, or by the number of its elements, their
    /// diameter, the pitch diameter (mm) and the contact angle (°), such as 6205, ER-10K@output or 9,7.94,39.04,0@pinion; or by its row in a
    /// list of yours, such as ours.csv:6308, whose first line names the columns designation, elements, element_mm, pitch_mm and contact_angle_deg. May be repeated.
    /// [default: the rolling bearings of the scenario; default shaft: the one that speed or pulses are of]
    #[arg(long = "bearing", value_name = "BEARING[@SHAFT]", value_parser = bearing)]
    pub bearings: Vec<NamedChoice>,
    /// (Hz) Band of the squared envelope that is drawn; `kurtogram` takes that of the largest kurtosis, at least three times as wide as the largest BPFI. The verdict
    /// looks at many bands. [default: that in which the verdict sees most]
    #[arg(long, value_name = "FROM,TO", value_parser = band)]
    pub band_hz: Option<EnvelopeBand>,
    /// What is removed from the recording before its envelope is drawn [default: averages]
    #[arg(long, value_parser = one_of(&SEPARATIONS))]
    pub bearing_separation: Option<BearingSeparation>,
}

/// A bearing as the command line names it.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedChoice {
    name: String,
    geometry: BearingGeometry,
    shaft: Option<String>,
}

impl NamedChoice {
    /// A bearing of a scenario, as the command line would name it.
    fn of_train(TrainBearing { geometry, shaft }: &TrainBearing, train: &GearTrain) -> Self {
        let BearingGeometry { elements, element_mm, pitch_mm, contact_angle_deg } = *geometry;
        let named = NAMED_BEARINGS.iter().find(|named| named.geometry == *geometry);
        let name = match named {
            Some(named) => named.name.to_owned(),
            None if contact_angle_deg == 0.0 => format!("{elements},{element_mm},{pitch_mm}"),
            None => format!("{elements},{element_mm},{pitch_mm},{contact_angle_deg}"),
        };
        Self { name, geometry: *geometry, shaft: Some(train.shafts[*shaft].name.clone()) }
    }
}

/// Ways to separate a recording.
const SEPARATIONS: [Choice<BearingSeparation>; 4] = [
    (
        "averages",
        "What repeats with the shafts, by averages over their revolutions",
        BearingSeparation::Averages,
    ),
    (
        "discrete-random",
        "Tones of a constant speed, which are predictable",
        BearingSeparation::DiscreteRandom,
    ),
    ("prewhitening", "The amplitude of every line of the spectrum", BearingSeparation::Prewhitening),
    ("none", "Nothing", BearingSeparation::None),
];

/// A bearing as the option names it, or why it cannot be.
pub fn bearing(text: &str) -> Result<NamedChoice, String> {
    let (name, shaft) = match text.split_once('@') {
        Some((name, shaft)) => (name, Some(shaft.to_owned())),
        None => (text, None),
    };
    let known = |named: &NamedBearing| (named.name.to_owned(), named.geometry);
    let (name, geometry) = match (NamedBearing::find(name), name.rsplit_once(".csv:")) {
        (Some(named), _) => known(named),
        (None, Some((file, designation))) => {
            (designation.to_owned(), of_list(&format!("{file}.csv"), designation)?)
        }
        (None, None) => (name.to_owned(), geometry(name)?),
    };
    Ok(NamedChoice { name, geometry, shaft })
}

/// The geometry of a row in a user's list, whose first line names the columns.
fn of_list(file: &str, designation: &str) -> Result<BearingGeometry, String> {
    let text = std::fs::read_to_string(file).map_err(|error| format!("{file}: {error}"))?;
    let mut lines = text.trim_start_matches('\u{feff}').lines();
    let head = lines.next().unwrap_or_default();
    // Beside semicolons a comma is the decimal sign.
    let separator = if head.contains(';') { ';' } else { ',' };
    let cells = |line| -> Vec<&str> {
        str::split(line, separator).map(|cell| cell.trim().trim_matches('"')).collect()
    };
    let heads = cells(head);
    let columns = ["designation", "elements", "element_mm", "pitch_mm", "contact_angle_deg"];
    let places = columns.map(|column| heads.iter().position(|head| *head == column));
    let [Some(name), Some(elements), Some(element_mm), Some(pitch_mm), Some(angle_deg)] = places else {
        return Err(format!("the first line of {file} must name the columns {}", columns.join(", ")));
    };
    let row = lines.map(cells).find(|row| row.get(name) == Some(&designation));
    let row = row.ok_or_else(|| format!("{file} has no bearing {designation} in its column designation"))?;
    let numbers = [elements, element_mm, pitch_mm, angle_deg]
        .map(|place| row.get(place).copied().unwrap_or_default().replace(',', "."));
    if let Some(at) = numbers.iter().position(|cell| cell.parse::<f64>().is_err()) {
        let (column, cell) = (columns[at + 1], &numbers[at]);
        return Err(format!("{file}, {designation}: {column} = {cell:?} must be a number"));
    }
    geometry(&numbers.join(",")).map_err(|error| format!("{file}, {designation}: {error}"))
}

/// A geometry in numbers.
fn geometry(text: &str) -> Result<BearingGeometry, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    let (elements, element_mm, pitch_mm, angle_deg) = match numbers.as_deref() {
        Some(&[elements, element_mm, pitch_mm]) => (elements, element_mm, pitch_mm, 0.0),
        Some(&[elements, element_mm, pitch_mm, angle_deg]) => (elements, element_mm, pitch_mm, angle_deg),
        _ => {
            let names = NAMED_BEARINGS.map(|named| named.name).join(", ");
            return Err(format!(
                "must be one of {names}, or the number of elements, their diameter and the pitch diameter in mm, as in 9,7.94,39.04, or a row of \
                 a list, as in ours.csv:6308"
            ));
        }
    };
    if elements.fract() != 0.0 {
        return Err("the first number must be the whole number of elements".to_owned());
    }
    BearingGeometry::new(elements as u32, element_mm, pitch_mm, angle_deg).map_err(|error| error.to_string())
}

fn band(text: &str) -> Result<EnvelopeBand, String> {
    if text == "kurtogram" {
        return Ok(EnvelopeBand::Kurtogram);
    }
    let ends = text.split_once(',').and_then(|(from, to)| Some((from.parse().ok()?, to.parse().ok()?)));
    match ends {
        Some((from_hz, to_hz)) if 0.0 <= from_hz && from_hz < to_hz => {
            Ok(EnvelopeBand::Stated(FrequencyBand { from_hz, to_hz }))
        }
        _ => Err("must be two frequencies in Hz, the lower one first, both from 0 to half the sampling rate, as in 2000,5500, or kurtogram; leave \
                  the option out for the band in which the verdict sees most"
            .to_owned()),
    }
}

impl BearingOptions {
    /// What is removed first.
    fn removed(&self) -> BearingSeparation {
        self.bearing_separation.unwrap_or_default()
    }

    /// The band as it was stated: two frequencies, or `kurtogram`.
    pub fn stated_band(&self) -> Value {
        match self.band_hz {
            None | Some(EnvelopeBand::Verdict) => Value::Null,
            Some(EnvelopeBand::Kurtogram) => "kurtogram".into(),
            Some(EnvelopeBand::Stated(band)) => json!([band.from_hz, band.to_hz]),
        }
    }

    /// Name of the separation.
    pub fn separation(&self) -> Option<&'static str> {
        name_of(&SEPARATIONS, self.removed())
    }

    /// The bearings that are looked for: those that are named, or those of the machine's scenario.
    fn chosen(&self, train: &GearTrain) -> Vec<NamedChoice> {
        if !self.bearings.is_empty() {
            return self.bearings.clone();
        }
        train.distinct_bearings().iter().map(|bearing| NamedChoice::of_train(bearing, train)).collect()
    }

    /// The bearings that are looked for, as the command line names them.
    ///
    /// # Arguments
    /// * `train` - the machine
    pub fn names(&self, train: &GearTrain) -> Vec<String> {
        let name = |of: &NamedChoice| match &of.shaft {
            Some(shaft) => format!("{}@{shaft}", of.name),
            None => of.name.clone(),
        };
        self.chosen(train).iter().map(name).collect()
    }

    /// Refuses a band that the recording does not have.
    fn check_band(&self, sampling_rate_hz: f64) -> Result<(), Failure> {
        let half_hz = 0.5 * sampling_rate_hz;
        match self.band_hz {
            Some(EnvelopeBand::Stated(FrequencyBand { from_hz, to_hz })) if to_hz > half_hz => {
                let problem = format!(
                    "--band-hz {from_hz},{to_hz}: the band ends above {half_hz} Hz, half the sampling rate; must be within 0 to {half_hz} Hz"
                );
                let help = "name a band around a resonance, or leave the option out for the band in which the verdict sees most";
                Failure::refuse(problem, help)
            }
            _ => Ok(()),
        }
    }

    /// Refuses options of a search where there is no bearing.
    fn check_needless(&self) -> Result<(), Failure> {
        let option = match (self.band_hz, self.bearing_separation) {
            (Some(_), _) => "--band-hz",
            (None, Some(_)) => "--bearing-separation",
            (None, None) => return Ok(()),
        };
        let problem =
            format!("{option}: no bearing is looked for: none is named, and no scenario has a rolling one");
        Failure::refuse(problem, "name one with --bearing, or leave the option out")
    }

    /// Looks for the bearings in a recording; none where none is named and the machine has none.
    ///
    /// # Arguments
    /// * `recording` - the channel and how the shafts turned
    /// * `unit` - of the channel
    /// * `refuse` - the words of an error
    pub fn look_for(
        &self,
        recording: &TrainRecording,
        unit: Option<&str>,
        refuse: impl Fn(&SignalError) -> Failure,
    ) -> Result<Option<FoundBearings>, Failure> {
        let chosen = self.chosen(recording.train);
        if chosen.is_empty() {
            return self.check_needless().map(|()| None);
        }
        self.check_band(recording.sampling_rate_hz)?;
        let shafts = &recording.train.shafts;
        let own = recording.turning.known_shaft(recording.train);
        let place = |of: &NamedChoice| -> Result<TrainBearing, Failure> {
            let shaft = match &of.shaft {
                Some(name) => {
                    let names = shafts.iter().map(|shaft| shaft.name.clone()).collect();
                    find(&format!("--bearing {}@{name}", of.name), "shaft", name, names)?
                }
                None => own,
            };
            Ok(TrainBearing { geometry: of.geometry, shaft })
        };
        let placed = chosen.iter().map(place).collect::<Result<Vec<_>, _>>()?;
        let settings = BearingSettings { separation: self.removed(), band: self.band_hz.unwrap_or_default() };
        let records = recording.bearings(&placed, &settings).map_err(|error| refuse(&error))?;
        let is_plain = |unit: &str| unit.chars().all(char::is_alphanumeric);
        let squared = |unit: &str| if is_plain(unit) { format!("{unit}²") } else { format!("({unit})²") };
        let unit = unit.filter(|_| self.removed() != BearingSeparation::Prewhitening).map(squared);
        let mut entries = Vec::new();
        for (place, ((of, bearing), (_, lines))) in
            chosen.iter().zip(placed).zip(&records.bearings).enumerate()
        {
            let phase = recording.phase(bearing.shaft).map_err(|error| refuse(&error))?;
            entries.push(BearingEntry {
                recording: 0,
                name: of.name.clone(),
                bearing,
                shaft: shafts[bearing.shaft].name.clone(),
                mean_speed_hz: phase.mean_speed_hz(recording.sampling_rate_hz),
                verdict: (records.defects.verdict(place).name(), records.defects.in_words(place)),
                races: records
                    .defects
                    .races
                    .iter()
                    .filter(|test| test.bearings.contains(&place))
                    .cloned()
                    .collect(),
                unexplained: records.defects.unexplained.clone().filter(|comb| comb.shaft == bearing.shaft),
                band: records.band,
                band_kurtosis: records.kurtosis,
                amplitude_unit: unit.clone(),
                lines: lines.clone(),
            });
        }
        Ok(Some(FoundBearings { records, entries }))
    }
}

/// What a recording shows about bearings.
pub struct FoundBearings {
    /// Kurtogram, band and spectra.
    pub records: BearingRecords,
    /// Each bearing with its lines; the number of the recording is not yet known.
    pub entries: Vec<BearingEntry>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bearings_by_name_and_by_geometry() {
        let of = bearing("er10k@output").unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(
            (of.name.as_str(), of.geometry.elements, of.shaft.as_deref()),
            ("ER-10K", 8, Some("output"))
        );
        let of = bearing("16,8.4,71.5,15.17").unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((of.geometry.contact_angle_deg, of.shaft), (15.17, None));
        for (text, words) in [
            ("6206", "6203, 6205, ER-10K"),
            ("7.94,9,39.04", "whole number of elements"),
            ("9,39.04,7.94", "room on the pitch circle"),
            ("9,x,7.94", "must be one of"),
        ] {
            assert!(bearing(text).is_err_and(|error| error.contains(words)), "{text}");
        }
        assert!(band("5500,2000").is_err() && band("2000").is_err() && band("2000,5500").is_ok());
    }
}
