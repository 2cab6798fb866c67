//! Objects of a TDMS file, by their paths: channels, groups and the file itself, with their properties.

use std::collections::HashMap;
use std::io;

use crate::recording::error::Problem;
use crate::recording::fields::{Fields, invalid};
use crate::recording::label::Label;
use crate::recording::number::{NumberKind, Numbers};
use crate::recording::rate::StatedRate;
use crate::recording::unit::seconds_in;

/// Types that are no numbers: a text, and a time of 16 bytes.
pub(super) const TEXT: u32 = 0x20;
const TIME: u32 = 0x44;
/// Source of a scale that is no scale, and coefficients of a polynomial.
const RAW_NUMBERS: f64 = u32::MAX as f64;
const MOST_COEFFICIENTS: f64 = 16.0;
/// (bytes) What of a text is kept.
const LONGEST_TEXT: usize = 1024;
/// Properties that state a unit.
const UNITS: [&str; 4] = ["unit_string", "NI_UnitDescription", "Unit", "unit"];

pub(super) enum Property {
    Number(f64),
    Text(String),
}

/// A channel, a group or the file itself.
#[derive(Default)]
pub(super) struct Object {
    pub(super) path: Vec<String>,
    pub(super) properties: HashMap<String, Property>,
    pub(super) kind: Option<Kind>,
    /// Of its numbers in all segments.
    pub(super) count: u64,
}

/// A type of numbers, and its bytes.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Kind {
    pub(super) numbers: Option<NumberKind>,
    pub(super) bytes: u64,
}

impl Object {
    pub(super) fn is_channel(&self) -> bool {
        self.path.len() == 2 && self.count > 0
    }

    pub(super) fn name(&self) -> &str {
        self.path.last().map_or("", String::as_str)
    }

    /// The name of a channel, behind that of its group where another group has it too.
    pub(super) fn label(&self, namesakes: &HashMap<&str, usize>) -> Label {
        let is_single = namesakes.get(self.name()) == Some(&1);
        let plain =
            if is_single { Label::from_header(self.name()) } else { Label::plain(&self.path.join(".")) };
        let unit = UNITS.into_iter().find_map(|name| self.text(name)).filter(|unit| !unit.is_empty());
        let not_numeric = match self.kind {
            Some(Kind { numbers: Some(_), .. }) => None,
            _ => Some("no real numbers".to_owned()),
        };
        Label { unit: unit.map(str::to_owned).or(plain.unit.clone()), not_numeric, ..plain }
    }

    pub(super) fn number(&self, name: &str) -> Option<f64> {
        if let Some(Property::Number(number)) = self.properties.get(name) { Some(*number) } else { None }
    }

    pub(super) fn text(&self, name: &str) -> Option<&str> {
        if let Some(Property::Text(text)) = self.properties.get(name) { Some(text) } else { None }
    }

    /// The rate of a property that is named as one; a waveform's own interval counts by its unit.
    pub(super) fn stated(&self) -> Option<StatedRate> {
        let mut names: Vec<&String> =
            self.properties.keys().filter(|name| !name.starts_with("wf_")).collect();
        names.sort();
        names.into_iter().find_map(|name| StatedRate::from_named(name, self.number(name)?))
    }

    /// (s) One unit of a waveform's abscissa; none of one that is not over time, as a spectrum.
    pub(super) fn abscissa_unit_s(&self) -> Option<f64> {
        self.text("wf_xunit_string").filter(|unit| !unit.is_empty()).map_or(Some(1.0), seconds_in)
    }

    /// (s) When the first of its numbers was taken.
    pub(super) fn start_s(&self) -> f64 {
        let number = |name| self.number(name).unwrap_or(0.0);
        number("wf_start_time") + number("wf_start_offset") * self.abscissa_unit_s().unwrap_or(1.0)
    }

    /// How many scales it states.
    pub(super) fn scales(&self) -> usize {
        let scale_type = |scale: &usize| self.text(&format!("NI_Scale[{scale}]_Scale_Type"));
        let counted = || (0..).take_while(|scale| scale_type(scale).is_some()).count();
        self.number("NI_Number_Of_Scales").map_or_else(counted, |scales| scales as usize)
    }

    /// Applies the scales that it states for raw numbers: the last one to what the one that it names as its source gives.
    ///
    /// # Arguments
    /// * `channel` - whose numbers they are
    /// * `samples` - the numbers
    pub(super) fn scale(&self, channel: &str, samples: &mut [f64]) -> Result<(), Problem> {
        if self.text("NI_Scaling_Status") == Some("scaled") {
            return Ok(());
        }
        let refuse = |what: &str| {
            Problem::Refused(format!("scales channel {channel} by {what}, which is not read; save it scaled"))
        };
        let (mut chain, mut next) = (Vec::new(), self.scales().checked_sub(1));
        while let Some(scale) = next {
            let kind =
                self.text(&format!("NI_Scale[{scale}]_Scale_Type")).unwrap_or("a scale without a type");
            let stated = |name: &str| self.number(&format!("NI_Scale[{scale}]_{kind}_{name}"));
            let number = |name: &str| stated(name).ok_or_else(|| refuse(&format!("{kind} without {name}")));
            chain.push(match kind {
                "AdvancedAPI" => vec![0.0, 1.0],
                "Linear" => vec![number("Y_Intercept")?, number("Slope")?],
                "Polynomial" => {
                    let count = number("Coefficients_Size")?;
                    if !(1.0..=MOST_COEFFICIENTS).contains(&count) {
                        return Err(refuse(&format!("a polynomial of {count} coefficients")));
                    }
                    let powers = 0..count as u32;
                    powers.map(|power| number(&format!("Coefficients[{power}]"))).collect::<Result<_, _>>()?
                }
                other => return Err(refuse(other)),
            });
            // Sources are earlier scales, so that the chain ends.
            next = match stated("Input_Source").filter(|source| *source != RAW_NUMBERS) {
                Some(source) if (0.0..scale as f64).contains(&source) => Some(source as usize),
                Some(_) => return Err(refuse("scales of one another")),
                None => None,
            };
        }
        for coefficients in chain.iter().rev() {
            let scaled =
                |x: f64| coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient);
            samples.iter_mut().for_each(|sample| *sample = scaled(*sample));
        }
        Ok(())
    }
}

/// The parts of a path such as `/'group'/'it''s a channel'`.
pub(super) fn parts(path: &str) -> Vec<String> {
    let mut parts = Vec::new();
    let mut letters = path.chars().peekable();
    while letters.find(|letter| *letter == '\'').is_some() {
        let mut part = String::new();
        while let Some(letter) = letters.next() {
            match letter {
                '\'' if letters.peek() != Some(&'\'') => break,
                '\'' => part.extend(letters.next()),
                other => part.push(other),
            }
        }
        parts.push(part);
    }
    parts
}

pub(super) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

pub(super) fn property(fields: &mut Fields) -> Result<Option<Property>, Problem> {
    Ok(match fields.u32()? {
        TEXT => {
            let length = fields.u32()?;
            let bytes = fields.bytes(length.into())?;
            Some(Property::Text(text(&bytes[..bytes.len().min(LONGEST_TEXT)])))
        }
        // Parts of a second, as 64 bits behind the point, and seconds; the other way round where the highest byte is first.
        TIME => {
            let (a, b) = (fields.u64()?, fields.u64()?);
            let (part, whole) = if fields.big_endian { (b, a) } else { (a, b) };
            Some(Property::Number(whole as i64 as f64 + part as f64 / 2.0_f64.powi(64)))
        }
        code => {
            let Kind { numbers, bytes } = kind(code)?;
            let value = fields.bytes(bytes)?;
            match numbers {
                Some(kind) => {
                    Some(Property::Number(Numbers::plain(kind, fields.big_endian).read_one(&mut &*value)?))
                }
                None => None,
            }
        }
    })
}

pub(super) fn kind(code: u32) -> io::Result<Kind> {
    let numbers = match code {
        1 => NumberKind::I8,
        2 => NumberKind::I16,
        3 => NumberKind::I32,
        4 => NumberKind::I64,
        5 | 0x21 => NumberKind::U8,
        6 => NumberKind::U16,
        7 => NumberKind::U32,
        8 => NumberKind::U64,
        9 | 0x19 => NumberKind::F32,
        10 | 0x1a => NumberKind::F64,
        0x44 | 0x10_000d => return Ok(Kind { numbers: None, bytes: 16 }),
        0x08_000c => return Ok(Kind { numbers: None, bytes: 8 }),
        other => return Err(invalid(format!("a type of numbers, {other}, that is not known"))),
    };
    Ok(Kind { numbers: Some(numbers), bytes: numbers.size() as u64 })
}
