//! The head of LabVIEW's measurement files (LVM): text that states the interval, the start and the units of its columns.

use super::cells::decoded;
use super::head::Line;
use crate::recording::error::Problem;
use crate::recording::label::Label;
use crate::recording::rate::StatedRate;

const MARK: &[u8] = b"LabVIEW Measurement";
const END: &[u8] = b"***End_of_Header***";

/// What the head states.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LvmHead {
    pub stated: StatedRate,
    pub start_s: f64,
    units: Vec<String>,
}

impl LvmHead {
    /// The head, and how many lines it has; none of other text. The head of the file ends as that of its first channels does.
    pub(super) fn of(lines: &[Line]) -> Result<Option<(Self, usize)>, Problem> {
        if !lines.first().is_some_and(|line| line.text.starts_with(MARK)) {
            return Ok(None);
        }
        let is_end = |line: &Line| line.text.trim_ascii().starts_with(END);
        let second = lines.iter().enumerate().filter(|(_, line)| is_end(line)).nth(1);
        let Some((end, _)) = second else { return Err(Problem::broken("it ends within its head")) };
        let cells = |key: &str| -> Vec<String> {
            let line =
                lines[..end].iter().rev().map(|line| decoded(line.text)).find(|line| line.starts_with(key));
            let separator = |line: &String| if line.contains('\t') { '\t' } else { ',' };
            let cells = line.iter().flat_map(|line| line.trim_end().split(separator(line)).skip(1));
            cells.map(|cell| cell.trim().to_owned()).collect()
        };
        let number = |key: &str| -> Result<Option<f64>, Problem> {
            let cells: Vec<String> = cells(key).into_iter().filter(|cell| !cell.is_empty()).collect();
            if cells.iter().any(|cell| *cell != cells[0]) {
                let problem = format!(
                    "has channels of several rates or starts ({key}: {}); export each by itself",
                    cells.join(", ")
                );
                return Err(Problem::Refused(problem));
            }
            Ok(cells.first().and_then(|cell| cell.replace(',', ".").parse().ok()))
        };
        if let Some(other) = cells("X_Dimension").iter().find(|x| !x.is_empty() && *x != "Time") {
            return Err(Problem::Refused(format!("holds values over {other}, not over time")));
        }
        let increment_s = number("Delta_X")?.ok_or_else(|| Problem::broken("its head states no Delta_X"))?;
        let stated = StatedRate { by: "Delta_X".to_owned(), rate_hz: 1.0 / increment_s };
        Ok(Some((
            Self { stated, start_s: number("X0")?.unwrap_or(0.0), units: cells("Y_Unit_Label") },
            end + 1,
        )))
    }

    /// Gives the columns their units; those of times, which the head states, and of remarks are none.
    pub(super) fn complete(&self, labels: &mut [Label]) {
        let mut units = self.units.iter();
        for label in labels {
            if label.is_value_of("x") || label.name == "Comment" {
                label.not_numeric = Some("times, which the head states, or remarks".to_owned());
            } else {
                let unit = units.next().filter(|unit| !unit.is_empty());
                label.unit = label.unit.take().or_else(|| unit.cloned());
            }
        }
    }
}
