//! The answer about a damage whatever its kind.

use crate::answer::{Answer, AnyDamage, HEALTHY, KindAnswer, SEVERAL, ToothAnswer};
use meshtone_learn::interval;

/// (-) Probability of damage from which on it is said to be there, and below which it is not seen.
const DECIDED: [f64; 2] = [0.1, 0.9];
/// (-) Probability of damage from which on it may be there as well as not, and is likely.
const LIKELY: [f64; 2] = [0.3, 0.7];
/// (-) Severities from which on damage is moderate, and heavy: thirds of the scale.
const DEGREES: [f64; 2] = [1.0 / 3.0, 2.0 / 3.0];
/// (-) Probability of a wheel, or a tooth, from which on it is named in words.
const NAMED: f64 = 0.8;

impl AnyDamage {
    /// Over all kinds, each as probable as it is said to be.
    ///
    /// Severities are mixed by their kinds' probabilities. The wheel is the likelier one over all kinds, and the tooth is the likeliest one
    /// of that wheel, given that wheel. It is none where no kind is possible.
    ///
    /// # Arguments
    /// * `kinds` - what is said of each
    /// * `of_wheel` - (-) probability of damage to each wheel
    pub(crate) fn over(kinds: &[KindAnswer], of_wheel: &[f64]) -> Option<Self> {
        let damaged = || kinds.iter().filter(|kind| kind.label != HEALTHY);
        let draws = damaged().flat_map(|kind| {
            let total: f64 = kind.severity_draws.iter().map(|(_, weight)| weight).sum();
            let share = kind.probability / total.max(f64::MIN_POSITIVE);
            kind.severity_draws.iter().map(move |(value, weight)| (*value, share * weight))
        });
        let draws: Vec<(f64, f64)> = draws.collect();
        let total: f64 = damaged().map(|kind| kind.probability).sum();
        if draws.is_empty() || total <= 0.0 {
            return None;
        }
        let by_probability = |a: &(usize, &f64), b: &(usize, &f64)| a.1.total_cmp(b.1);
        let (wheel, of_likeliest) = of_wheel.iter().enumerate().max_by(by_probability)?;
        let wheel_probability = of_likeliest / total;
        // The kinds' teeth on this wheel, each with the sum of its shares.
        let mut teeth: Vec<ToothAnswer> = Vec::new();
        for kind in damaged() {
            let Some(place) = kind.place.filter(|place| place.wheel == wheel) else { continue };
            let Some(tooth) = place.tooth else { continue };
            let share = kind.probability * place.wheel_probability * tooth.probability;
            match teeth.iter_mut().find(|known| known.number == tooth.number) {
                Some(known) => known.probability += share,
                None => teeth.push(ToothAnswer { probability: share, ..tooth }),
            }
        }
        let is_on_one_tooth = |kind: &KindAnswer| kind.place.is_some_and(|place| place.is_on_one_tooth);
        let on_one_tooth: f64 =
            damaged().filter(|kind| is_on_one_tooth(kind)).map(|kind| kind.probability).sum();
        let likeliest = teeth.into_iter().max_by(|a, b| a.probability.total_cmp(&b.probability));
        let given_wheel = |share: f64| (share / (total * wheel_probability)).min(1.0);
        Some(Self {
            severity: interval(&draws),
            wheel,
            wheel_probability,
            one_tooth_probability: on_one_tooth / total,
            tooth: likeliest
                .map(|tooth| ToothAnswer { probability: given_wheel(tooth.probability), ..tooth }),
        })
    }

    /// Its severity and place, in words.
    fn in_words(&self) -> String {
        let severity = self.severity;
        let degree = match severity.median {
            value if value < DEGREES[0] => "lightly",
            value if value < DEGREES[1] => "moderately",
            _ => "heavily",
        };
        let [from, to] = severity.within_90;
        format!("{degree} ({:.1} of 1, 90 %: {from:.1} to {to:.1})", severity.median)
    }

    fn where_to_look(&self, answer: &Answer) -> String {
        if self.wheel_probability < NAMED {
            return format!("look at {}", likely_wheels(answer));
        }
        let wheel = answer.wheel_in_words(self.wheel);
        // All teeth may be likelier than one.
        match self.tooth.filter(|_| self.one_tooth_probability >= 0.5) {
            Some(ToothAnswer { number, probability, .. }) if probability >= NAMED => {
                format!("look at tooth {number} of the {wheel}")
            }
            Some(tooth) => format!("look at every tooth of the {wheel}, first at tooth {}", tooth.number),
            None if self.one_tooth_probability >= NAMED => {
                format!("look at every tooth of the {wheel}: one is damaged, but it is not known which")
            }
            None => format!("look at every tooth of the {wheel}"),
        }
    }
}

/// The wheels of which one is the damaged one as surely as a wheel is named, the likeliest first.
fn likely_wheels(answer: &Answer) -> String {
    let mut order: Vec<usize> = (0..answer.wheels.len()).collect();
    order.sort_by(|&a, &b| answer.wheel_probabilities[b].total_cmp(&answer.wheel_probabilities[a]));
    let mut sum = 0.0;
    let is_needed = |wheel: &usize| {
        let is_needed = sum < NAMED;
        sum += answer.wheel_probabilities[*wheel];
        is_needed
    };
    let likely: Vec<&str> =
        order.into_iter().take_while(is_needed).map(|wheel| &*answer.wheels[wheel]).collect();
    match &likely[..] {
        all if all.len() == answer.wheels.len() => {
            format!("{} wheels", if all.len() == 2 { "both" } else { "all" })
        }
        [others @ .., last] if !others.is_empty() => format!("the wheels {} and {last}", others.join(", ")),
        one => format!("the wheel {}", one.concat()),
    }
}

/// What is said of the teeth, in a sentence.
///
/// # Arguments
/// * `answer` - all but the summary
pub(crate) fn sentence(answer: &Answer) -> String {
    if answer.is_outside() {
        let why = match answer.is_remounted() {
            _ if answer.is_misstated => "what is stated of the recordings does not fit them",
            true => "the sensor, its unit or its mounting was changed since the healthy recording",
            false if answer.has_bearing_lines() => {
                "the recordings are unlike what was simulated, perhaps because of the bearing"
            }
            false => "the recordings are unlike what was simulated",
        };
        return format!("Nothing can be said of the teeth: {why}.");
    }
    let ([unseen, seen], damaged) = (DECIDED, answer.damaged());
    match &answer.any_damage {
        Some(any) if damaged >= seen => {
            let what = match any.wheel_probability < NAMED {
                true => "One of the wheels".to_owned(),
                false => format!("The {}", answer.wheel_in_words(any.wheel)),
            };
            let has_several = answer.likeliest_damage().is_some_and(|kind| kind.label == SEVERAL);
            let several =
                if has_several { " Two damages at once are likelier than a single one." } else { "" };
            format!("{what} is damaged, {}; {}.{several}", any.in_words(), any.where_to_look(answer))
        }
        Some(any) if damaged >= LIKELY[0] => {
            let (how, place) = (any.in_words(), any.where_to_look(answer));
            let is_likely = match damaged >= LIKELY[1] {
                true => "Damage is likely, but not sure",
                false => "Damage can neither be excluded nor be shown",
            };
            format!("{is_likely}; if there is any, {how}; {place}.")
        }
        Some(_) if damaged > unseen => "Damage is not likely, but not excluded.".to_owned(),
        _ => "No damage is seen; what is small may be there all the same.".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answer::PlaceAnswer;
    use crate::observation::SignalKind;

    fn kind(label: &'static str, probability: f64, tooth: Option<u32>, wheel: usize) -> KindAnswer {
        let place = PlaceAnswer {
            wheel,
            wheel_probability: 0.9,
            is_on_one_tooth: true,
            tooth: tooth.map(|number| ToothAnswer { number, angle_deg: f64::from(number), probability: 1.0 }),
        };
        let place = (label != HEALTHY).then_some(place);
        let severity_draws = if label == HEALTHY { Vec::new() } else { vec![(1.0, 1.0)] };
        KindAnswer { label, probability, severity: None, severity_draws, sizes: Vec::new(), place }
    }

    /// An answer that holds no more than a sentence says.
    fn answer(kinds: Vec<KindAnswer>, any_damage: Option<AnyDamage>, outside_model: f64) -> Answer {
        Answer {
            signal: SignalKind::Recording,
            has_healthy: false,
            recordings: 1,
            wheels: ["pinion", "gear"].map(str::to_owned).into(),
            wheel_probabilities: vec![0.0, 1.0],
            counted_from: vec![None; 2],
            bearings: Vec::new(),
            summary: String::new(),
            any_damage,
            simulated_records: 0,
            reference_records: 0,
            refined_records: 0,
            kinds,
            outside_model,
            healthy_outside_model: None,
            common_change: None,
            is_misstated: false,
            rule: crate::Rule::default(),
            warnings: Vec::new(),
            shown_wheel: 1,
            difference_g: Vec::new(),
            band_g: Default::default(),
            explanations: Vec::new(),
        }
    }

    // Three quarters of the damage is a missing tooth, the rest a pit; both on the gear.
    #[test]
    fn kinds_count_as_they_are_probable() {
        let with = |draws: &[(f64, f64)], kind| KindAnswer { severity_draws: draws.to_vec(), ..kind };
        let kinds = [
            with(&[(1.0, 5.0)], kind("missing-tooth", 0.6, Some(8), 1)),
            kind(HEALTHY, 0.2, None, 1),
            with(&[(0.2, 0.5), (0.4, 0.5)], kind("pits", 0.2, Some(3), 0)),
        ];
        let any = AnyDamage::over(&kinds, &[0.24, 0.56]).unwrap();
        let tooth = any.tooth.unwrap();
        assert_eq!((any.wheel, tooth.number), (1, 8));
        assert!((any.wheel_probability - 0.7).abs() < 1e-12);
        // Of the gear's 0.7: all of the missing tooth's 0.75 × 0.9.
        assert!((tooth.probability - 0.675 / 0.7).abs() < 1e-12);
        assert!(any.severity.median > 0.8 && any.severity.within_90[0] < 0.3, "{:?}", any.severity);
        assert!(AnyDamage::over(&kinds[1..2], &[0.0, 0.0]).is_none());
    }

    #[test]
    fn a_sentence_says_no_more_than_is_known() {
        let said_of = |label, tooth, damaged: f64, outside_model| {
            let kinds = vec![kind(label, damaged, tooth, 1), kind(HEALTHY, 1.0 - damaged, None, 1)];
            let any = AnyDamage::over(&kinds, &[0.0, damaged]);
            sentence(&answer(kinds, any, outside_model))
        };
        let said = |damaged| said_of("missing-tooth", Some(8), damaged, 1.0);
        assert_eq!(
            said(0.99),
            "The gear is damaged, heavily (1.0 of 1, 90 %: 1.0 to 1.0); look at tooth 8 of the gear."
        );
        assert!(
            said_of("missing-tooth", Some(8), 0.99, 0.001).starts_with("Nothing can be said of the teeth")
        );
        assert!(said(0.8).starts_with("Damage is likely, but not sure"));
        assert!(
            said(0.6).starts_with("Damage can neither be excluded nor be shown; if there is any, heavily")
        );
        assert!(said(0.2).contains("not excluded"));
        assert!(said(0.05).starts_with("No damage is seen"));
        let unknown = said_of("missing-tooth", None, 1.0, 1.0);
        assert!(unknown.ends_with("one is damaged, but it is not known which."));
        assert!(
            said_of(SEVERAL, None, 1.0, 1.0).ends_with("Two damages at once are likelier than a single one.")
        );
    }

    #[test]
    fn the_wheels_that_may_be_damaged_are_named() {
        let of = |probabilities: [f64; 4]| {
            let wheels = ["z1", "z2", "z3", "z4"].map(str::to_owned).into();
            let wheel_probabilities = probabilities.into();
            likely_wheels(&Answer { wheels, wheel_probabilities, ..answer(Vec::new(), None, 1.0) })
        };
        assert_eq!(of([0.02, 0.5, 0.45, 0.03]), "the wheels z2 and z3");
        assert_eq!(of([0.02, 0.3, 0.4, 0.28]), "the wheels z3, z2 and z4");
        assert_eq!(of([0.25; 4]), "all wheels");
    }
}
