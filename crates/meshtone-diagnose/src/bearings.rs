//! What is said about the bearings of a rig. It needs no simulation: their defects repeat with no shaft.

use meshtone::signal::{BearingDefects, DefectKind, GearTrain, RaceTest};

use crate::observation::Observation;

/// Answer about one race, or the rolling elements, of one bearing, or of several that cannot be told apart.
#[derive(Debug, Clone, PartialEq)]
pub struct BearingAnswer {
    /// Names of the bearings that the defect may be of: shaft and place, such as `input:0`; several where their orders differ by less than slip does.
    pub bearings: Vec<String>,
    /// The race.
    pub race: DefectKind,
    /// (orders of the bearing's shaft) Its first line without slip.
    pub order: f64,
    /// (orders of the bearing's shaft) Where its lines are strongest together.
    pub found_order: f64,
    /// (-) Amplitude of its harmonics over the median beside them, their geometric mean. It is no severity.
    pub over_median: f64,
    /// (-) Probability that lines without those of any race look like this one, over all races and recordings.
    pub false_alarm_probability: f64,
}

impl BearingAnswer {
    /// Returns whether its lines are there. Those of an outer race can be of a sound bearing, too.
    pub fn is_detected(&self) -> bool {
        self.false_alarm_probability < RaceTest::DETECTED
    }

    /// `the outer race of bearing input:0 or input:1`.
    fn named(&self) -> String {
        let part = if self.race == DefectKind::Element {
            "a rolling element".to_owned()
        } else {
            format!("the {}", self.race.name())
        };
        format!("{part} of bearing {}", self.bearings.join(" or "))
    }

    /// Place and strength of its lines.
    fn in_words(&self) -> String {
        let alike = if self.bearings.len() > 1 {
            "; the orders of these bearings differ by less than slip"
        } else {
            ""
        };
        format!(
            "{}: lines at order {:.3} of its shaft ({:.3} without slip), {:.1} times the median, false alarm {}{alike}",
            self.named(),
            self.found_order,
            self.order,
            self.over_median,
            crate::p_in_words(self.false_alarm_probability)
        )
    }
}

/// The races over all recordings of a state, the most certain defect first.
///
/// # Arguments
/// * `train` - of the rig
/// * `now` - the recordings
pub(crate) fn answers(train: &GearTrain, now: &[Observation]) -> Vec<BearingAnswer> {
    let mut all: Vec<BearingAnswer> = Vec::new();
    for BearingDefects { races, .. } in now.iter().map(|asked| &asked.bearings) {
        for race in races {
            let answer = BearingAnswer {
                bearings: race.bearings.iter().map(|place| train.bearings[*place].0.clone()).collect(),
                race: race.race,
                order: race.order,
                found_order: race.found_order,
                over_median: race.over_median,
                false_alarm_probability: (now.len() as f64 * race.false_alarm_probability).min(1.0),
            };
            let is_same =
                |of: &&mut BearingAnswer| (of.race, &of.bearings) == (answer.race, &answer.bearings);
            match all.iter_mut().find(is_same) {
                Some(known) if known.false_alarm_probability <= answer.false_alarm_probability => {}
                Some(known) => *known = answer,
                None => all.push(answer),
            }
        }
    }
    all.sort_by(|one, other| one.false_alarm_probability.total_cmp(&other.false_alarm_probability));
    all
}

/// What a recording says nothing about, in words.
pub(crate) fn doubts(train: &GearTrain, asked: &Observation) -> Vec<String> {
    let BearingDefects { too_short, unresolved, warnings, .. } = &asked.bearings;
    let short = too_short.iter().map(|(place, turns, needed)| {
        format!(
            "no defect of bearing {} is looked for: its cage turns {turns:.1} times, and {needed:.0} are needed; record longer",
            train.bearings[*place].0
        )
    });
    let unresolved = unresolved.iter().map(|place| {
        format!(
            "not all races of bearing {} are looked at: their lines are beyond the band of the recording, or too near to the orders of shafts; \
             record longer, or at a higher rate",
            train.bearings[*place].0
        )
    });
    short.chain(unresolved).chain(warnings.iter().map(ToString::to_string)).collect()
}

/// The sentences that a summary begins with; none where nothing is detected.
///
/// Elements that pass the outer race of a sound bearing under load excite the same lines as a defect there, so that only the other races
/// are said to be damaged.
pub(crate) fn sentence(answers: &[BearingAnswer]) -> Option<String> {
    let named = |is_outer: bool| {
        let detected = answers.iter().filter(|of| of.is_detected());
        let of_race = detected.filter(|of| (of.race == DefectKind::OuterRace) == is_outer);
        let named: Vec<String> = of_race.map(BearingAnswer::named).collect();
        (!named.is_empty()).then(|| named.join("; "))
    };
    let damaged = named(false).map(|named| format!("A bearing is damaged: {named}."));
    let passed = named(true).map(|named| {
        format!(
            "A bearing may be damaged: {named}; the elements of a sound bearing can cause the same lines."
        )
    });
    let sentences: Vec<String> = damaged.into_iter().chain(passed).collect();
    (!sentences.is_empty()).then(|| sentences.join(" "))
}

/// Notes about the bearings: the detected defects, or that there are none.
pub(crate) fn notes(answers: &[BearingAnswer]) -> Vec<String> {
    let detected: Vec<String> =
        answers.iter().filter(|of| of.is_detected()).map(BearingAnswer::in_words).collect();
    match answers.first() {
        None => Vec::new(),
        Some(strongest) if detected.is_empty() => {
            vec![format!(
                "no defect of a bearing is detected in {} races; strongest: {}",
                answers.len(),
                strongest.in_words()
            )]
        }
        Some(_) => detected
            .into_iter()
            .chain(["the severity of a bearing's defect is not estimated".to_owned()])
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(bearings: &[&str], race: DefectKind, p: f64) -> BearingAnswer {
        BearingAnswer {
            bearings: bearings.iter().map(|name| (*name).to_owned()).collect(),
            race,
            order: 3.052,
            found_order: 3.049,
            over_median: 41.0,
            false_alarm_probability: p,
        }
    }

    #[test]
    fn bearings_of_the_same_orders_are_both_named() {
        let both = answer(&["input:0", "input:1"], DefectKind::OuterRace, 1e-5);
        let answers = [both, answer(&["output:0"], DefectKind::Element, 0.3)];
        assert_eq!(
            sentence(&answers).unwrap(),
            "A bearing may be damaged: the outer race of bearing input:0 or input:1; the elements of a sound bearing can cause the same lines."
        );
        let notes = notes(&answers);
        assert_eq!(notes.len(), 2);
        assert!(
            notes[0].contains("false alarm p < 0.001; the orders of these bearings differ by less than slip"),
            "{}",
            notes[0]
        );
        assert!(notes[1].contains("severity"));
        assert_eq!(sentence(&answers[1..]), None);
    }
}
