//! A verdict about a bearing in words.

use super::{BearingDefects, BearingVerdict, CannotTell, DefectKind, RaceTest, UnexplainedComb};
use crate::signal::FrequencyBand;

impl std::fmt::Display for CannotTell {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::FewTurns { turns, needed } => {
                let (turns, needed) = (rounded_down(*turns), needed.ceil());
                write!(to, "its shaft turns {turns:.1} times, and {needed:.0} are needed; record longer")
            }
            Self::FewCycles { cycles, needed } => write!(
                to,
                "the recording has {:.1} hunting-tooth periods, and {:.0} are needed to remove the lines of the gears; record longer",
                rounded_down(*cycles),
                needed.ceil()
            ),
            Self::Unresolved => write!(
                to,
                "the lines of a race cannot be separated from the orders of shafts or from those of another race; record longer, or at a \
                 higher rate"
            ),
            Self::DoesNotFit => write!(to, "lines stand out that are of no stated race"),
            Self::Trace(race) => {
                write!(to, "there is a trace of {}, which chance may have made", race.named())
            }
        }
    }
}

/// A tenth at most less: what is short of a number is not written as that number.
fn rounded_down(count: f64) -> f64 {
    (10.0 * count).floor() / 10.0
}

impl BearingVerdict {
    /// The verdict in one or two words: `outer race`, `inner race`, `rolling element`, of several the first that was found; `nothing`, or `cannot tell`.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Defect(parts) => parts.first().map_or("nothing", |part| part.name()),
            Self::Nothing => "nothing",
            Self::CannotTell(_) => "cannot tell",
        }
    }
}

impl DefectKind {
    /// `the outer race`, `a rolling element`.
    fn named(self) -> String {
        format!("{} {}", if self == Self::Element { "a" } else { "the" }, self.name())
    }
}

fn hertz(FrequencyBand { from_hz, to_hz }: FrequencyBand) -> String {
    format!("{from_hz:.0} to {to_hz:.0} Hz")
}

impl RaceTest {
    /// What is seen of the race, as `lines in 1500 to 2250 Hz, slip 0.2 %, depth 1.58, false alarm below 1 in 100`.
    pub fn in_words(&self) -> String {
        let (band, slip) = (hertz(self.band), 100.0 * self.slip());
        let chance = if self.is_detected() {
            "below 1 in 100".to_owned()
        } else {
            format!("{:.0} in 100", 100.0 * self.false_alarm_probability)
        };
        format!("lines in {band}, slip {slip:.1} %, depth {:.2}, false alarm {chance}", self.depth)
    }
}

impl std::fmt::Display for UnexplainedComb {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            to,
            "lines at multiples of order {:.3} of the shaft, in {}, are of no stated race: the speed, the sampling rate or a geometry does not fit, or \
             something else is heard; they would be of",
            self.order,
            hertz(self.band)
        )?;
        for (place, (race, _, ratio)) in self.ratios.iter().enumerate() {
            let (comma, inverse) = (if place > 0 { "," } else { "" }, 1.0 / ratio);
            write!(
                to,
                "{comma} {} if the shaft turned {ratio:.3} times as fast or the sampling rate were {inverse:.3} times as high",
                race.named()
            )?;
        }
        Ok(())
    }
}

impl BearingDefects {
    /// What the recording says about a bearing, as a sentence without a full stop.
    ///
    /// # Arguments
    /// * `bearing` - its place
    pub fn in_words(&self, bearing: usize) -> String {
        let of_bearing = || self.races.iter().filter(|of| of.bearings.contains(&bearing));
        match self.verdict(bearing) {
            BearingVerdict::Defect(_) => {
                let found = of_bearing().filter(|of| of.is_detected());
                let found: Vec<String> =
                    found.map(|of| format!("{} has a defect: {}", of.race.named(), of.in_words())).collect();
                found.join("; ")
            }
            BearingVerdict::Nothing => match of_bearing().next() {
                Some(of) => format!(
                    "no defect is heard; the strongest race is {}: {}",
                    of.race.named(),
                    of.in_words()
                ),
                None => "no defect is heard".to_owned(),
            },
            BearingVerdict::CannotTell(why) => format!("the recording does not tell: {why}"),
        }
    }
}
