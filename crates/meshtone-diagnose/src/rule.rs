//! A second judge: what a rule says of the recordings' indicators, without a simulation.

use meshtone::signal::{Indicators, separate};
use meshtone_fourier::Complex64;
use meshtone_learn::{WheelLines, mean, revolution};
use serde_json::{Map, Value, json};

use crate::answer::wheel_in_words;
use crate::layout::Layout;
use crate::observation::{Observation, Question, SignalKind};

/// The indicators: keys of `indicators.json`, names in words, and the factor to the healthy recordings' mean from which on each is above its limit.
const INDICATORS: [(&str, &str, f64); 3] =
    [("fm4", "FM4", 1.5), ("fm0", "FM0", 1.5), ("sideband_level_factor", "sidebands", 2.0)];
/// Healthy recordings from which on the limit is no less than their mean and [`DEVIATIONS`] standard deviations, as of a trend.
const ENOUGH: usize = 3;
const DEVIATIONS: f64 = 3.0;

/// An indicator of a wheel's average, now and when it was healthy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RuleValue {
    /// (-) Mean over the recordings in question.
    pub now: f64,
    /// (-) Mean over the healthy recordings; none without any.
    pub healthy: Option<f64>,
    /// (-) Value above which the wheel counts as damaged; none without a healthy recording.
    pub limit: Option<f64>,
}

impl RuleValue {
    /// Returns whether it is above its limit; none without one.
    pub fn is_above(&self) -> Option<bool> {
        Some(self.now > self.limit?)
    }
}

/// What a rule says: of each wheel, in the rig's order, FM4, FM0 and the level of sidebands, as far as they are defined.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rule {
    /// The indicators of each wheel.
    pub wheels: Vec<[Option<RuleValue>; INDICATORS.len()]>,
}

impl Rule {
    /// Applies the rule to recordings.
    ///
    /// All averages are compared up to the last order that all of them have, because FM4 and FM0 grow with the band.
    pub(crate) fn new(question: &Question, layout: &Layout) -> Self {
        let of_wheel = |wheel: usize| {
            let [now, healthy] = [question.now, question.healthy].map(|asked: &[Observation]| {
                let seen = asked.iter().filter_map(|asked| asked.wheels[wheel].as_ref());
                let all = seen.map(|lines| indicators(lines, layout.last[wheel], layout.signal));
                all.collect::<Vec<[Option<f64>; INDICATORS.len()]>>()
            });
            std::array::from_fn(|place| {
                let [now, healthy] = [&now, &healthy].map(|all| {
                    let values: Option<Vec<f64>> = all.iter().map(|one| one[place]).collect();
                    values.filter(|values| !values.is_empty())
                });
                let limit = healthy.as_deref().map(|values| limit(values, INDICATORS[place].2));
                Some(RuleValue { now: mean(&now?), healthy: healthy.as_deref().map(mean), limit })
            })
        };
        Self { wheels: (0..layout.last.len()).map(of_wheel).collect() }
    }

    /// Returns whether an indicator of a wheel is above its limit; none where nothing has a limit.
    pub fn is_damaged(&self) -> Option<bool> {
        let above = self.wheels.iter().flatten().flatten().filter_map(RuleValue::is_above);
        above.reduce(|any, above| any || above)
    }

    /// The verdict in words; none without a limit.
    ///
    /// # Arguments
    /// * `wheels` - their names
    pub(crate) fn in_words(&self, wheels: &[String]) -> Option<String> {
        let (mut above, mut judged) = (Vec::new(), Vec::new());
        for (place, (_, name, _)) in INDICATORS.iter().enumerate() {
            for (wheel, of) in wheels.iter().zip(&self.wheels) {
                let Some(RuleValue { now, limit: Some(limit), .. }) = of[place] else { continue };
                if judged.last() != Some(name) {
                    judged.push(*name);
                }
                if now > limit {
                    let wheel = wheel_in_words(wheel);
                    above.push(format!("{name} {now:.2} of the {wheel} (limit {limit:.2})"));
                }
            }
        }
        Some(match self.is_damaged()? {
            true => format!("by the indicators alone it is damaged: {}", above.join(", ")),
            false => {
                format!("by the indicators alone it is healthy: {} are below their limits", judged.join(", "))
            }
        })
    }

    /// The rule as JSON.
    ///
    /// # Arguments
    /// * `wheels` - their names
    pub(crate) fn to_json(&self, wheels: &[String]) -> Value {
        let of_wheel = |(name, of): (&String, &[Option<RuleValue>; INDICATORS.len()])| {
            let values = INDICATORS.iter().zip(of).filter_map(|((key, ..), of)| {
                let RuleValue { now, healthy, limit } = (*of)?;
                let above = of.and_then(|of| of.is_above());
                let json = json!({ "now": now, "healthy": healthy, "limit": limit, "is_above": above });
                Some(((*key).to_owned(), json))
            });
            (name.clone(), Value::Object(values.collect()))
        };
        let wheels: Map<String, Value> = wheels.iter().zip(&self.wheels).map(of_wheel).collect();
        json!({ "is_damaged": self.is_damaged(), "wheels": wheels })
    }
}

/// The values of [`INDICATORS`]; none where one is not defined, as of mesh harmonics that a difference signal lacks.
///
/// # Arguments
/// * `wheel` - lines of its average
/// * `last` - the last order that all recordings have
/// * `signal` - what the recordings are
fn indicators(wheel: &WheelLines, last: usize, signal: SignalKind) -> [Option<f64>; INDICATORS.len()] {
    let lines: Vec<Complex64> = wheel.lines.iter().take(last + 1).copied().collect();
    let average = revolution(&lines, (2 * last + 1).next_power_of_two());
    let found = separate(&average, &wheel.separation)
        .and_then(|parts| Indicators::new(&average, &parts, wheel.teeth()));
    let Ok(found) = found else { return [None; INDICATORS.len()] };
    let of_regular = |value: Option<f64>| value.filter(|_| signal.has_regular_part());
    [found.fm4, of_regular(found.fm0), of_regular(found.sideband_level_factor)]
}

/// Limit of an indicator by its values in healthy recordings. Few recordings of one day scatter less than those of another day, so that the factor counts however
/// many there are.
fn limit(healthy: &[f64], factor: f64) -> f64 {
    let mean = mean(healthy);
    if healthy.len() < ENOUGH {
        return factor * mean;
    }
    let squares: f64 = healthy.iter().map(|value| (value - mean).powi(2)).sum();
    (mean + DEVIATIONS * (squares / (healthy.len() - 1) as f64).sqrt()).max(factor * mean)
}

#[cfg(test)]
mod tests {
    use meshtone::signal::{fm0, fm4, order_spectrum, separate};

    use super::*;
    use crate::reference::ReferenceSet;
    use crate::synthetic::{observed, prior, records};

    fn rule(now: &[Observation], healthy: &[Observation]) -> Rule {
        let question = Question { now, healthy };
        let layout = Layout::of(&question, &ReferenceSet { prior: prior(), records: Vec::new() }).unwrap();
        Rule::new(&question, &layout)
    }

    // The values are those of the signal chain, over the band that both recordings have.
    #[test]
    fn indicators_are_compared_in_the_band_of_all_recordings() {
        let all: Vec<Observation> = records(&prior(), 3).iter().map(observed).collect();
        let (mut sound, broken) = (all[0].clone(), &all[2..]);
        let last = 3 * 38 + 20;
        let cut =
            |of: &mut Observation| of.wheels.iter_mut().flatten().for_each(|of| of.lines.truncate(last + 1));
        let whole = rule(broken, std::slice::from_ref(&sound));
        cut(&mut sound);
        let found = rule(broken, std::slice::from_ref(&sound));
        let mut both_cut = broken.to_vec();
        both_cut.iter_mut().for_each(cut);
        assert_eq!(found, rule(&both_cut, &[sound]));
        assert_ne!(found, whole);
        let gear = both_cut[0].wheels[1].as_ref().unwrap();
        let average = revolution(&gear.lines, 512);
        let parts = separate(&average, &gear.separation).unwrap();
        let expected =
            [fm4(&parts.difference), fm0(&average, &order_spectrum(&average).unwrap(), 38).unwrap()];
        for (value, expected) in found.wheels[1].iter().flatten().zip(expected) {
            assert!((value.now / expected.unwrap() - 1.0).abs() < 1e-9, "{value:?} {expected:?}");
        }
    }

    #[test]
    fn limits_are_a_factor_or_three_deviations_of_the_healthy_recordings() {
        let names = ["pinion".to_owned(), "gear".to_owned()];
        let sound: Vec<Observation> = records(&prior(), 8 * 4).iter().step_by(8).map(observed).collect();
        let fm4 = |rule: &Rule| rule.wheels[1][0].unwrap();
        let one = rule(&sound[..1], &sound[..1]);
        assert_eq!((one.is_damaged(), fm4(&one).limit), (Some(false), Some(INDICATORS[0].2 * fm4(&one).now)));
        assert!(one.in_words(&names).unwrap().starts_with("by the indicators alone it is healthy"));

        let values: Vec<f64> = sound.iter().map(|of| fm4(&rule(std::slice::from_ref(of), &[])).now).collect();
        let mean = values.iter().sum::<f64>() / 4.0;
        let deviation = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / 3.0).sqrt();
        let expected = (mean + 3.0 * deviation).max(INDICATORS[0].2 * mean);
        assert!((fm4(&rule(&sound[..1], &sound)).limit.unwrap() - expected).abs() < 1e-9);

        // Without a healthy recording nothing has a limit; a burst is above it.
        let alone = rule(&sound[..1], &[]);
        assert_eq!((alone.is_damaged(), alone.in_words(&names)), (None, None));
        let all = records(&prior(), 400);
        let is_heavy = |of: &&crate::ReferenceRecord| {
            of.fault.as_ref().is_some_and(|fault| fault.wheel == 1 && fault.severity > 0.9)
        };
        let heavy = all.iter().find(is_heavy).unwrap();
        let found = rule(&[observed(heavy)], &[observed(&all[heavy.unit() as usize * 8])]);
        assert_eq!((found.is_damaged(), fm4(&found).is_above()), (Some(true), Some(true)), "{found:?}");
        assert_eq!(found.to_json(&names)["wheels"]["gear"]["fm4"]["is_above"], true);
        let words = found.in_words(&names).unwrap();
        assert!(words.starts_with("by the indicators alone it is damaged: FM4 "), "{words}");
    }
}
