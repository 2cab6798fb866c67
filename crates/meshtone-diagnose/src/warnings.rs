//! Warnings about an answer.

use meshtone::damage::damage_kinds;
use meshtone::signal::ForeignTones;

use crate::answer::{Answer, p_in_words};
use crate::diagnose::OUTSIDE;
use crate::learn::Learned;
use crate::observation::{Observation, Question};
use crate::prior::Prior;
use crate::{bearings, consistency, level, speed};

/// (-) Part of the energy from which on tones of no shaft are mentioned where a recording is unlike the simulations. Sound pairs have none; teeth that
/// part, which depend on the two that meet, make up to a twentieth.
const NOTICED: f64 = 0.005;

/// Something that deserves attention about a diagnosis.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagnosisWarning {
    /// Its subject, by which programs distinguish warnings.
    pub code: &'static str,
    /// In words.
    pub message: String,
}

impl Question<'_> {
    /// Lists what is doubtful about the recordings and the scenario, as far as that is seen without a simulation.
    ///
    /// # Arguments
    /// * `prior` - what may be about the rig
    pub fn warnings(&self, prior: &Prior) -> Vec<DiagnosisWarning> {
        let mismatches = |of: &[Observation], whose: &str| -> Vec<String> {
            of.iter().filter_map(|asked| Some(format!("{whose}{}", asked.mismatch.as_ref()?))).collect()
        };
        let ideal_wheels = prior.base.has_ideal_wheels().then(|| {
            "wheels of the scenario have no deviations (din_grade and iso_class are 0), as none has: the probabilities are far too sure; write the grade of each \
             wheel"
                .to_owned()
        });
        let no_healthy = self.healthy.is_empty().then(|| {
            "without a recording of the same rig when it was healthy, small damage is not distinguished from the wheels' own deviations and the sensor's path"
                .to_owned()
        });
        listed([
            ("ideal-wheels", Vec::from_iter(ideal_wheels)),
            ("mismatch", mismatches(self.now, "")),
            ("mismatch", mismatches(self.healthy, "healthy recording: ")),
            ("doubt", self.all().flat_map(|asked| asked.doubts.clone()).collect()),
            ("bearing", bearings::doubts(&prior.train, self)),
            ("speed", speed::doubts(self, prior)),
            ("several-states", consistency::levels_apart(self)),
            ("no-healthy", Vec::from_iter(no_healthy)),
        ])
    }
}

/// Warnings by their codes, each once.
fn listed<const N: usize>(found: [(&'static str, Vec<String>); N]) -> Vec<DiagnosisWarning> {
    let mut warnings = Vec::new();
    for (code, messages) in found {
        for message in messages {
            let warning = DiagnosisWarning { code, message };
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
        }
    }
    warnings
}

/// Warnings about an answer.
///
/// Each has its code and, where it applies, its sentence; the table puts them in the order in which a reader needs them. What follows from another warning is
/// not said again.
///
/// # Arguments
/// * `answer` - all but its warnings
/// * `learned`, `question` - what it was made of
pub(crate) fn warnings(answer: &Answer, learned: &Learned, question: &Question) -> Vec<DiagnosisWarning> {
    let mounting = answer.common_change.filter(|_| answer.is_remounted()).map(|change| {
        let [least, most] = change.within_db;
        let why = level::unit_hint(learned, question).unwrap_or_else(|| {
            "the sensor or its mounting was probably changed; give a healthy recording of this sensor and mounting".to_owned()
        });
        format!(
            "the difference signals of all wheels changed alike since the healthy recording, by {least:.1} to {most:.1} dB, as in few simulations ({}): {why}",
            p_in_words(change.p)
        )
    });
    let outside = answer.is_recording_outside().then(|| {
        let foreign = question.now.iter().filter_map(|asked| asked.foreign.as_ref());
        let foreign = foreign.max_by(|a, b| a.part.total_cmp(&b.part)).filter(|tones| tones.part > NOTICED);
        let of_bearing = "a damaged bearing may be the reason, since no simulation has one";
        let of_tones = |tones: &ForeignTones| {
            format!(
                "it also has tones at no order of any shaft, {:.1} % of its energy, the strongest at {:.2} Hz: the scenario may be of another \
                 machine, or of one pair of a gearbox, or its teeth or speed are not those of the rig",
                100.0 * tones.part,
                tones.strongest.first().map_or(f64::NAN, |tone| tone.frequency_hz)
            )
        };
        let unknown = "what is wrong may be none of the kinds that are known here, or the scenario is not this rig";
        let why = level::unit_hint(learned, question)
            .or_else(|| answer.has_bearing_lines().then(|| of_bearing.to_owned()))
            .or_else(|| foreign.map(of_tones))
            .unwrap_or_else(|| unknown.to_owned());
        format!("the recording is unlike what was simulated ({}): {why}", p_in_words(answer.outside_model))
    });
    // What changed since may be like the simulations all the same.
    let healthy = answer.healthy_outside_model.filter(|p| *p < 0.5 * OUTSIDE).map(|p| {
        format!(
            "the healthy recording is unlike a healthy rig of the scenario ({}): was it healthy? If it was, changes are judged all the same, the better the more \
             speed, load, wheels and sensor of the scenario are the rig's",
            p_in_words(p)
        )
    });
    let found = [
        ("mounting", mounting),
        ("outside", outside),
        ("healthy-outside", healthy),
        ("level", level::doubt(learned, question)),
        ("contradiction", consistency::contradicting_states(learned, question)),
        ("not-simulated", not_simulated(answer)),
    ];
    let found = listed(found.map(|(code, said)| (code, Vec::from_iter(said))));
    [question.warnings(&learned.reference.prior), found].concat()
}

/// Kinds of damage that the answer does not know.
fn not_simulated(answer: &Answer) -> Option<String> {
    let is_missing = |name: &&str| !answer.kinds.iter().any(|kind| kind.label == *name);
    let missing: Vec<&str> = damage_kinds().iter().map(|kind| kind.name).filter(is_missing).collect();
    (!missing.is_empty()).then(|| {
        format!(
            "not looked for, since the scenario cannot be simulated with it: {}; another model may know it (model = \"contact\")",
            missing.join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use meshtone::signal::AngleZero;

    use super::*;
    use crate::diagnose::diagnose;
    use crate::synthetic::{observed, prior, reference};
    use crate::{DiagnoseError, ToothAnswer};

    fn said(learned: &Learned, now: &[Observation], healthy: &[Observation]) -> Answer {
        diagnose(learned, &Question { now, healthy }, None).unwrap()
    }

    fn number(tooth: Option<ToothAnswer>) -> Option<u32> {
        tooth.map(|tooth| tooth.number)
    }

    fn has(answer: &Answer, words: &str) -> bool {
        answer.warnings.iter().any(|warning| warning.message.contains(words))
    }

    // One set for all that is asked: to learn from it is what takes long.
    #[test]
    fn what_an_answer_is_not_silent_about() {
        let prior = prior();
        let reference = reference(&prior, 1200);
        let is_heavy = |record: &&crate::ReferenceRecord| {
            record
                .fault
                .as_ref()
                .is_some_and(|fault| fault.severity > 0.9 && fault.wheel == 1 && fault.is_on_one_tooth)
        };
        let broken = reference.records.iter().find(is_heavy).unwrap();
        let tooth = broken.fault.as_ref().map(|fault| fault.tooth);
        let (broken, sound) = (observed(broken), observed(reference.healthy_of(broken).unwrap()));
        let question = Question { now: std::slice::from_ref(&broken), healthy: std::slice::from_ref(&sound) };
        let learned = Learned::new(&reference, &question).unwrap();
        let (broken_alone, sound_alone) = (std::slice::from_ref(&broken), std::slice::from_ref(&sound));
        let ask = |now: &[Observation]| said(&learned, now, sound_alone);

        let answer = ask(broken_alone);
        assert_eq!(answer.counted_from, vec![Some(AngleZero::Simulated); 2]);
        let any = answer.any_damage.unwrap();
        assert_eq!((any.wheel, number(any.tooth)), (1, tooth), "{answer:#?}");
        assert!(answer.summary.contains("damaged"), "{}", answer.summary);
        for words in ["one state", "times as loud", "turns at", "unlike a healthy rig"] {
            assert!(!has(&answer, words), "{:?}", answer.warnings);
        }

        // Two recordings without a mark in common, and one whose angle means nothing.
        let turned = |zero| Observation { zero: vec![zero; 2], ..broken.clone() };
        for now in [vec![turned(AngleZero::Chance)], vec![turned(AngleZero::FirstSample); 2]] {
            let answer = ask(&now);
            let place = answer.likeliest_damage().unwrap().place.unwrap();
            assert!(place.tooth.is_none() && place.is_on_one_tooth && answer.counted_from == vec![None; 2]);
        }
        let place = ask(&[turned(AngleZero::FirstSample)]).likeliest_damage().unwrap().place.unwrap();
        assert_eq!(number(place.tooth), tooth);

        assert!(has(&ask(&[broken.clone(), sound.clone()]), "hardly of one state"));
        let times = |factor: f64| {
            let mut loud = sound.clone();
            for wheel in loud.wheels.iter_mut().flatten() {
                wheel.lines.iter_mut().for_each(|line| *line *= factor);
            }
            loud
        };
        assert!(has(&said(&learned, broken_alone, &[times(1000.0)]), "unit"));
        assert!(has(&ask(&[times(9.81)]), "9.81 times as loud as the healthy recording"));
        // Another path, whether there is damage or not: louder and quieter at the same frequencies of both wheels.
        for now in [&sound, &broken] {
            let mut remounted = now.clone();
            for wheel in remounted.wheels.iter_mut().flatten() {
                let teeth = wheel.teeth() as f64;
                let gain = |order: usize| 10f64.powf(0.6 * (2.0 * order as f64 / teeth).sin());
                wheel.lines.iter_mut().enumerate().for_each(|(order, line)| *line *= gain(order));
            }
            let answer = ask(&[remounted]);
            assert!(
                answer.is_outside() && has(&answer, "its mounting was probably changed"),
                "{:?}",
                answer.common_change
            );
            assert!(answer.summary.contains("mounting") && !ask(std::slice::from_ref(now)).is_remounted());
        }
        let blamed = said(&learned, sound_alone, broken_alone);
        assert!(
            has(&blamed, "unlike a healthy rig") && has(&blamed, "was it healthy?"),
            "{:?}",
            blamed.warnings
        );
        let other = sound.clone().with_mismatch("another machine");
        let mismatch = said(&learned, broken_alone, &[other]);
        assert!(
            mismatch.is_outside() && !mismatch.is_remounted() && mismatch.summary.contains("what is stated")
        );
        assert!(has(&mismatch, "healthy recording: another machine"));

        let at = |speed_hz| Observation { input_speed_hz: Some(speed_hz), ..broken.clone() };
        assert!(has(&ask(&[at(46.0)]), "the pinion turns at 46.000 Hz"));
        // What is seen in the recording itself is the reason.
        let pulses = at(22.0).with_mismatch("fits one pulse a revolution");
        let refused = Question { now: &[pulses], healthy: &[] }.check(&prior).unwrap_err();
        assert!(refused.to_string().ends_with("fits one pulse a revolution"), "{refused}");
        for (speed_hz, words) in [
            (2400.0, "rpm that was given as Hz"),
            (2.0 / 3.0, "has the scenario its speed in rpm"),
            (40.0 * 38.0 / 17.0, "of the pinion's shaft, not of the gear's shaft"),
            (40.0 * 17.0 / 38.0, "of the gear's shaft, not of the pinion's shaft"),
            (120.0, "is it in Hz"),
        ] {
            let now = [at(speed_hz)];
            let refused = Question { now: &now, healthy: &[] }.check(&prior).unwrap_err();
            assert!(
                matches!(refused, DiagnoseError::OtherSpeed { .. }) && refused.to_string().contains(words),
                "{refused}"
            );
        }
    }
}
