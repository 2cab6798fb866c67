//! What a damage is, as data for pictures, traces and summaries: no reader needs to know its kind.

use super::ToothPart;
use super::damaged_tooth::{DamagedTooth, HealthyTooth};
use super::kind::Kind;
use crate::error::ScenarioError;
use crate::wheel::ToothProfile;

/// What one damage has done to a tooth, filled in by the file of its kind.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct DamageDescription {
    /// Which of the scenario's faults it is, from 0.
    pub fault: usize,
    /// The kind of damage, by its name in the scenario file.
    pub kind: &'static str,
    /// What it is called in a title, such as `pit over part of the face`.
    pub title: &'static str,
    /// What it takes of the tooth.
    pub part: ToothPart,
    /// Its quantities: names, with the unit at their ends, and values.
    pub quantities: Vec<(&'static str, QuantityValue)>,
    /// First and last profile index that it reaches.
    pub range: [usize; 2],
    /// Whether a part of the face width is sound there.
    pub is_partial: bool,
    /// What it takes of the tooth's face.
    pub face: Vec<FacePatch>,
    /// Its sizes, in short phrases.
    pub sizes: Vec<String>,
    /// One or two short lines for a picture of the tooth's face.
    pub caption: Vec<String>,
}

/// What a damage has done, or why it does not fit the tooth.
pub(crate) type DamageResult = Result<DamageDescription, ScenarioError>;

/// The value of a damage's quantity.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum QuantityValue {
    /// A number.
    Number(f64),
    /// Several numbers, such as one for each pit.
    Numbers(Vec<f64>),
    /// A number for each point of the tooth's profile.
    OverProfile(Vec<f64>),
    /// Indices of profile points, from 0.
    Indices(Vec<usize>),
    /// A word, such as a grade.
    Word(&'static str),
}

/// A piece of a tooth's face that a damage takes. Points are z along the face from its middle and x along the tooth's centre line from
/// the wheel's centre, both in mm; a damage that reaches from one end of the face reaches from positive z.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FacePatch {
    /// (mm) Outline of what is lost; empty of a crack, which takes no area.
    pub outline_mm: Vec<[f64; 2]>,
    /// (mm) The line between what is lost and what is left, or along which a crack is open.
    pub edge_mm: Vec<[f64; 2]>,
}

impl DamageDescription {
    /// A damage of a kind, without sizes and quantities.
    ///
    /// # Arguments
    /// * `range` - first and last profile index that it reaches
    pub(crate) fn of<K: Kind>(range: [usize; 2]) -> Self {
        Self {
            fault: 0,
            kind: K::NAME,
            title: K::TITLE,
            part: K::PART,
            quantities: Vec::new(),
            range,
            is_partial: false,
            face: Vec::new(),
            sizes: Vec::new(),
            caption: Vec::new(),
        }
    }

    /// The numbers of a quantity, one after the other; none of a word, and where the damage has none of this name.
    ///
    /// # Arguments
    /// * `name` - of the quantity
    pub fn numbers(&self, name: &str) -> Vec<f64> {
        let named = self.quantities.iter().filter(|(own, _)| *own == name);
        named.flat_map(|(_, value)| value.numbers()).collect()
    }
}

impl QuantityValue {
    /// Its numbers, one after the other; none of a word.
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Number(value) => vec![*value],
            Self::Numbers(values) | Self::OverProfile(values) => values.clone(),
            Self::Indices(indices) => indices.iter().map(|&index| index as f64).collect(),
            Self::Word(_) => Vec::new(),
        }
    }
}

/// What a fault has done, with the numbers from 1 of the teeth that it is on, rising; nothing where it is too small to show.
///
/// # Arguments
/// * `damaged` - the damaged teeth
/// * `fault` - which of the scenario's faults, from 0
pub fn damages_of_fault(damaged: &[DamagedTooth], fault: usize) -> Vec<(u32, &DamageDescription)> {
    let mut damages = Vec::new();
    for alike in damaged {
        let of_fault = alike.descriptions.iter().filter(|damage| damage.fault == fault);
        damages.extend(
            of_fault.flat_map(|damage| alike.teeth.iter().map(move |&index| (index as u32 + 1, damage))),
        );
    }
    damages.sort_by_key(|(tooth, _)| *tooth);
    damages
}

impl FacePatch {
    /// A rectangle, with edges on all sides.
    pub(super) fn rectangle(z_mm: [f64; 2], x_mm: [f64; 2]) -> Self {
        let corners = [
            [z_mm[0], x_mm[0]],
            [z_mm[1], x_mm[0]],
            [z_mm[1], x_mm[1]],
            [z_mm[0], x_mm[1]],
            [z_mm[0], x_mm[0]],
        ];
        Self { outline_mm: corners[..4].to_vec(), edge_mm: corners.to_vec() }
    }

    /// The whole width of the face between two profile points.
    pub(super) fn whole_width(range: [usize; 2], healthy: &HealthyTooth) -> Self {
        let half_mm = healthy.wheel().face_width_mm / 2.0;
        Self::rectangle([-half_mm, half_mm], range.map(|index| healthy.profile().x_mm[index]))
    }
}

/// (mm) How far a flank is cut back across the tooth where it is cut most.
pub(super) fn largest_depth_mm(profile: &ToothProfile, flank_y_mm: &[f64]) -> f64 {
    profile.y_mm.iter().zip(flank_y_mm).map(|(sound, cut)| sound - cut).fold(0.0, f64::max)
}

/// A size in words, to a hundredth.
pub(super) fn hundredths(value: f64) -> String {
    format!("{}", (value * 100.0).round() / 100.0)
}

/// A size in words, to a tenth.
pub(super) fn tenths(value: f64) -> String {
    format!("{}", (value * 10.0).round() / 10.0)
}
