//! What is said about the bearings of a rig. It needs no simulation: their defects repeat with no shaft, and the verdict is that of `meshtone indicators`.

use meshtone::signal::{BearingDefects, DefectKind, GearTrain, RaceTest};

use crate::observation::Question;

/// Answer about one race, or the rolling elements, of one bearing, or of several that cannot be told apart.
#[derive(Debug, Clone, PartialEq)]
pub struct BearingAnswer {
    /// Names of the bearings that the defect may be of: shaft and place, such as `input:0`; several where their orders differ by less than slip does.
    pub bearings: Vec<String>,
    /// What the recording with the least false-alarm probability shows; that probability is over all races and recordings. The depth is no severity.
    pub test: RaceTest,
    /// (-) The largest depth of the same race's lines in a healthy recording; none without one in which they are tested.
    pub healthy_depth: Option<f64>,
}

impl BearingAnswer {
    /// (-) Depth of the lines over that in a healthy recording, from which on they are of a defect. A guess.
    pub const RISE: f64 = 2.0;

    /// Returns whether the race is said to have a defect: its lines are there, and at least [`Self::RISE`] times as deep as in a healthy recording. Without one
    /// those of an outer race are of no defect, because elements that pass the outer race of a sound bearing under load excite the same lines.
    pub fn is_defect(&self) -> bool {
        let has_risen = match self.healthy_depth {
            Some(healthy) => self.test.depth >= Self::RISE * healthy,
            None => self.test.race != DefectKind::OuterRace,
        };
        self.test.is_detected() && has_risen
    }

    /// Returns whether its lines are there, and no healthy recording says whether a sound outer race excites them.
    fn may_be_defect(&self) -> bool {
        self.test.is_detected() && !self.is_defect() && self.healthy_depth.is_none()
    }

    /// `the outer race of bearing input:0 or input:1`.
    fn named(&self) -> String {
        let part = match self.test.race {
            DefectKind::Element => "a rolling element".to_owned(),
            race => format!("the {}", race.name()),
        };
        format!("{part} of bearing {}", self.bearings.join(" or "))
    }

    /// What is seen of its lines.
    fn in_words(&self) -> String {
        let healthy =
            self.healthy_depth.map(|healthy| format!(" (depth {healthy:.2} in the healthy recording)"));
        let alike = "; the orders of these bearings differ by less than slip";
        let alike = if self.bearings.len() > 1 { alike } else { "" };
        format!("{}: {}{}{alike}", self.named(), self.test.in_words(), healthy.unwrap_or_default())
    }
}

/// The races over all recordings of a state: defects first, then the most certain lines.
///
/// # Arguments
/// * `train` - of the rig
/// * `question` - the recordings
pub(crate) fn answers(train: &GearTrain, question: &Question) -> Vec<BearingAnswer> {
    let mut all: Vec<BearingAnswer> = Vec::new();
    for test in question.now.iter().flat_map(|asked| &asked.bearings.races) {
        let is_same = |of: &RaceTest| (of.race, &of.bearings) == (test.race, &test.bearings);
        let healthy = question.healthy.iter().flat_map(|asked| &asked.bearings.races);
        let false_alarm_probability = (question.now.len() as f64 * test.false_alarm_probability).min(1.0);
        let answer = BearingAnswer {
            bearings: test.bearings.iter().map(|place| train.bearings[*place].0.clone()).collect(),
            test: RaceTest { false_alarm_probability, ..test.clone() },
            healthy_depth: healthy.filter(|of| is_same(of)).map(|of| of.depth).reduce(f64::max),
        };
        match all.iter_mut().find(|of| is_same(&of.test)) {
            Some(known) if known.test.false_alarm_probability <= false_alarm_probability => {}
            Some(known) => *known = answer,
            None => all.push(answer),
        }
    }
    all.sort_by(|one, other| {
        let p = |of: &BearingAnswer| of.test.false_alarm_probability;
        other.is_defect().cmp(&one.is_defect()).then(p(one).total_cmp(&p(other)))
    });
    all
}

/// What the recordings say nothing about, in words.
///
/// # Arguments
/// * `train` - of the rig
/// * `question` - the recordings
pub(crate) fn doubts(train: &GearTrain, question: &Question) -> Vec<String> {
    let name = |place: &usize| &train.bearings[*place].0;
    let mut doubts = Vec::new();
    for BearingDefects { untold, unexplained, .. } in question.now.iter().map(|of| &of.bearings) {
        doubts.extend(
            untold.iter().map(|(place, why)| format!("not all is said about bearing {}: {why}", name(place))),
        );
        doubts.extend(
            unexplained.iter().map(|comb| format!("shaft {}: {comb}", train.shafts[comb.shaft].name)),
        );
    }
    let is_uncompared = |answer: &&BearingAnswer| answer.test.is_detected() && answer.healthy_depth.is_none();
    if !question.healthy.is_empty() {
        doubts.extend(answers(train, question).iter().filter(is_uncompared).map(|of| {
            format!(
                "the lines of {} are not compared with the healthy recording, in which they cannot be read: it must be as long as this one, and have at least \
                 its sampling rate",
                of.named()
            )
        }));
    }
    doubts
}

/// The sentences that a summary begins with; none where nothing is detected.
pub(crate) fn sentence(answers: &[BearingAnswer]) -> Option<String> {
    let named = |is_named: fn(&BearingAnswer) -> bool| {
        let named: Vec<String> = answers.iter().filter(|of| is_named(of)).map(BearingAnswer::named).collect();
        (!named.is_empty()).then(|| named.join("; "))
    };
    let damaged = named(BearingAnswer::is_defect).map(|named| format!("A bearing is damaged: {named}."));
    let perhaps = named(BearingAnswer::may_be_defect).map(|named| {
        format!(
            "A bearing may be damaged: {named}; the elements of a sound bearing can cause the same lines, which a recording of the healthy gearbox would show."
        )
    });
    let sentences: Vec<String> = damaged.into_iter().chain(perhaps).collect();
    (!sentences.is_empty()).then(|| sentences.join(" "))
}

/// Notes about the bearings: the detected lines, or that there are none.
pub(crate) fn notes(answers: &[BearingAnswer]) -> Vec<String> {
    let detected = answers.iter().filter(|of| of.test.is_detected()).map(|of| {
        let is_as_healthy = !of.is_defect() && of.healthy_depth.is_some();
        let healthy = "; less than twice as deep as in the healthy recording, so no defect is stated";
        format!("{}{}", of.in_words(), if is_as_healthy { healthy } else { "" })
    });
    let mut notes: Vec<String> = detected.collect();
    match answers.first() {
        Some(strongest) if notes.is_empty() => notes.push(format!(
            "no defect of a bearing is detected in {} races; strongest: {}",
            answers.len(),
            strongest.in_words()
        )),
        _ if answers.iter().any(BearingAnswer::is_defect) => {
            notes.push("the severity of a bearing's defect is not estimated".to_owned());
        }
        _ => {}
    }
    notes
}

#[cfg(test)]
mod tests {
    use crate::observation::Observation;
    use meshtone::random::{Draws, Purpose};
    use meshtone::scenario::{BearingDefect, BearingKind, DefectPlace, Scenario};
    use meshtone::signal::{FrequencyBand, TrainRecording, TrainTurning};

    use super::*;

    fn answer(bearings: &[&str], race: DefectKind, p: f64, healthy_depth: Option<f64>) -> BearingAnswer {
        let test = RaceTest {
            race,
            bearings: (0..bearings.len()).collect(),
            order: 3.052,
            found_order: 3.049,
            band: FrequencyBand { from_hz: 1500.0, to_hz: 2250.0 },
            depth: 0.4,
            false_alarm_probability: p,
        };
        BearingAnswer {
            bearings: bearings.iter().map(|name| (*name).to_owned()).collect(),
            test,
            healthy_depth,
        }
    }

    #[test]
    fn bearings_of_the_same_orders_are_both_named() {
        let both = answer(&["input:0", "input:1"], DefectKind::OuterRace, 1e-5, None);
        let answers = [both, answer(&["output:0"], DefectKind::Element, 0.3, None)];
        assert_eq!(
            sentence(&answers).unwrap(),
            "A bearing may be damaged: the outer race of bearing input:0 or input:1; the elements of a sound bearing can cause the same lines, \
             which a recording of the healthy gearbox would show."
        );
        let notes = notes(&answers);
        assert_eq!(notes.len(), 1);
        assert!(
            notes[0].contains(
                "false alarm below 1 in 100; the orders of these bearings differ by less than slip"
            ),
            "{}",
            notes[0]
        );
        assert_eq!(sentence(&answers[1..]), None);
    }

    #[test]
    fn lines_are_of_a_defect_where_they_have_risen() {
        let outer = |healthy| answer(&["input:0"], DefectKind::OuterRace, 1e-5, healthy);
        assert!(outer(Some(0.19)).is_defect() && !outer(Some(0.21)).is_defect() && !outer(None).is_defect());
        assert_eq!(sentence(&[outer(Some(0.21))]), None);
        assert!(
            notes(&[outer(Some(0.21))])[0]
                .contains("depth 0.40, false alarm below 1 in 100 (depth 0.21 in the healthy recording)")
        );
        // An inner race needs no comparison, but is compared where it can be.
        let inner = |healthy| answer(&["input:0"], DefectKind::InnerRace, 1e-5, healthy);
        assert!(inner(None).is_defect() && inner(Some(0.19)).is_defect() && !inner(Some(0.21)).is_defect());
    }

    /// From the simulation of a gearbox on ball bearings to the answer: a spall on the outer race is a defect beside the recording of the sound bearing, and
    /// the sound bearing beside itself has none.
    #[test]
    fn spall_of_a_simulated_bearing_is_a_defect_and_a_sound_bearing_is_none() {
        let observed = |spall: Option<BearingDefect>, seed: u64| {
            let mut gearbox = Scenario::from_toml(include_str!("../../../examples/gearbox.toml")).unwrap();
            gearbox.bearings_mut()[0].kind = BearingKind::Ball;
            gearbox.bearings_mut()[0].name = Some("ER-10K".to_owned());
            gearbox.bearings_mut()[0].defect = spall.into_iter().collect();
            gearbox.solver.sampling_rate_hz = 25_600.0;
            gearbox.solver.duration_s = Some(3.0);
            let channels = meshtone::simulate(&gearbox).unwrap().channels;
            let train = GearTrain::of_scenario(&gearbox).unwrap();
            let turning = TrainTurning::of_simulated(&gearbox, channels.start_s, channels.len()).unwrap();
            let mut draws = Draws::new(1, Purpose::DiagnosisNoise, seed);
            let signal = channels.signal(&gearbox.leading_channel()).unwrap();
            let signal: Vec<f64> = signal.iter().map(|value| value + 0.1 * draws.normal()).collect();
            let sampling_rate_hz = channels.sampling_rate_hz;
            let recording =
                TrainRecording { signal: &signal, sampling_rate_hz, train: &train, turning: &turning };
            (Observation::of_recording(&recording).unwrap(), train)
        };
        let defects = |spall: Option<BearingDefect>| {
            let (now, train) = observed(spall, 0);
            let healthy = [observed(None, 1).0];
            let question = Question { now: &[now], healthy: &healthy };
            let defects = answers(&train, &question).into_iter().filter(BearingAnswer::is_defect);
            defects.map(|of| (of.bearings.concat(), of.test.race)).collect::<Vec<_>>()
        };
        assert_eq!(defects(None), []);
        let spall = BearingDefect::new(DefectPlace::Outer, 0.2);
        assert_eq!(defects(Some(spall)), [("input:0".to_owned(), DefectKind::OuterRace)]);
    }
}
