//! A second judge: what a rule says of the recordings' indicators, without a simulation.

use meshtone::signal::{Indicators, separate};
use meshtone_fourier::Complex64;
use meshtone_learn::{WheelLines, revolution};
use serde_json::{Map, Value, json};

use crate::answer::wheel_in_words;
use crate::learn::{Layout, Question};
use crate::observation::{Observation, SignalKind};

/// The indicators: keys of `indicators.json`, names in words, and the factor to the healthy recording's value from which on each is above its limit, where
/// there are too few recordings for a mean and a standard deviation.
const INDICATORS: [(&str, &str, f64); 3] =
    [("fm4", "FM4", 1.5), ("fm0", "FM0", 1.5), ("sideband_level_factor", "sidebands", 2.0)];
/// Healthy recordings from which on the limit is their mean and [`DEVIATIONS`] standard deviations, as of a trend.
const ENOUGH: usize = 3;
const DEVIATIONS: f64 = 3.0;

/// An indicator of a wheel's average, now and when it was healthy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RuleValue {
    /// Key of the indicator in `indicators.json`.
    pub indicator: &'static str,
    /// Its name in words.
    pub name: &'static str,
    /// (-) Mean over the recordings in question.
    pub now: f64,
    /// (-) Mean over the healthy recordings; none without any.
    pub healthy: Option<f64>,
    /// (-) Value above which the wheel counts as damaged; none without a healthy recording.
    pub limit: Option<f64>,
}

impl RuleValue {
    /// Returns how many times its limit it is; none without a limit.
    fn of_limit(&self) -> Option<f64> {
        Some(self.now / self.limit?)
    }

    /// Returns whether it is above its limit; none without one.
    pub fn is_above(&self) -> Option<bool> {
        Some(self.of_limit()? > 1.0)
    }
}

/// What a rule says: of each wheel, in the rig's order, its indicators; none of a wheel that is not seen.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rule {
    /// The indicators of each wheel, as far as they are defined.
    pub wheels: Vec<Vec<RuleValue>>,
}

impl Rule {
    /// Applies the rule to recordings.
    ///
    /// All averages are compared up to the last order that all of them have, because FM4 and FM0 grow with the band.
    pub(crate) fn new(question: &Question, layout: &Layout) -> Self {
        let of = |asked: &[Observation], wheel: usize| -> Vec<[Option<f64>; INDICATORS.len()]> {
            let seen = asked.iter().filter_map(|asked| asked.wheels[wheel].as_ref());
            seen.map(|lines| indicators(lines, layout.last[wheel], layout.signal)).collect()
        };
        let of_wheel = |wheel: usize| {
            let [now, healthy] = [question.now, question.healthy].map(|asked| of(asked, wheel));
            let value = |place: usize| {
                let [now, healthy] = [&now, &healthy]
                    .map(|all| all.iter().map(|one| one[place]).collect::<Option<Vec<f64>>>());
                let (indicator, name, factor) = INDICATORS[place];
                let healthy = healthy.filter(|values| !values.is_empty());
                let now = now.filter(|values| !values.is_empty())?;
                Some(RuleValue {
                    indicator,
                    name,
                    now: mean(&now),
                    healthy: healthy.as_deref().map(mean),
                    limit: healthy.as_deref().map(|values| limit(values, factor)),
                })
            };
            (0..INDICATORS.len()).filter_map(value).collect()
        };
        Self { wheels: (0..layout.last.len()).map(of_wheel).collect() }
    }

    /// Returns whether an indicator of a wheel is above its limit; none where nothing has a limit.
    pub fn is_damaged(&self) -> Option<bool> {
        self.wheels.iter().flatten().filter_map(RuleValue::is_above).reduce(|any, above| any || above)
    }

    /// The verdict in words: what is above its limit, or what is nearest to it.
    ///
    /// # Arguments
    /// * `wheels` - their names
    pub(crate) fn in_words(&self, wheels: &[String]) -> Option<String> {
        let all =
            self.wheels.iter().zip(wheels).flat_map(|(of, name)| of.iter().map(move |value| (name, value)));
        let said = |(name, of): &(&String, &RuleValue)| {
            let beside = of.healthy.zip(of.limit);
            let beside = beside.map_or_else(String::new, |(healthy, limit)| {
                format!(" (healthy {healthy:.2}, limit {limit:.2})")
            });
            format!("{} {:.2} of the {}{beside}", of.name, of.now, wheel_in_words(name))
        };
        let mut all: Vec<(&String, &RuleValue)> = all.collect();
        // The farthest above its limit first.
        all.sort_by(|(_, a), (_, b)| b.of_limit().unwrap_or(0.0).total_cmp(&a.of_limit().unwrap_or(0.0)));
        let listed =
            |values: &[(&String, &RuleValue)]| values.iter().map(said).collect::<Vec<_>>().join(", ");
        let above = all.partition_point(|(_, value)| value.is_above() == Some(true));
        Some(match self.is_damaged() {
            None if all.is_empty() => return None,
            None => {
                format!("the indicators alone have no limits without a healthy recording: {}", listed(&all))
            }
            Some(true) => format!("by the indicators alone it is damaged: {}", listed(&all[..above])),
            Some(false) => format!(
                "by the indicators alone it is healthy; nearest to its limit is {}",
                listed(&all[..1])
            ),
        })
    }

    /// The rule as JSON.
    ///
    /// # Arguments
    /// * `wheels` - their names
    pub(crate) fn to_json(&self, wheels: &[String]) -> Value {
        let value = |of: &RuleValue| {
            let all =
                json!({ "now": of.now, "healthy": of.healthy, "limit": of.limit, "is_above": of.is_above() });
            (of.indicator.to_owned(), all)
        };
        let of_wheel = |(name, of): (&String, &Vec<RuleValue>)| {
            (name.clone(), Value::Object(of.iter().map(value).collect()))
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

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Limit of an indicator by its values in healthy recordings.
fn limit(healthy: &[f64], factor: f64) -> f64 {
    let mean = mean(healthy);
    if healthy.len() < ENOUGH {
        return factor * mean;
    }
    let squares: f64 = healthy.iter().map(|value| (value - mean).powi(2)).sum();
    mean + DEVIATIONS * (squares / (healthy.len() - 1) as f64).sqrt()
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
        for (value, expected) in found.wheels[1].iter().zip(expected) {
            assert!((value.now / expected.unwrap() - 1.0).abs() < 1e-9, "{value:?} {expected:?}");
        }
    }

    #[test]
    fn limits_are_a_factor_or_three_deviations_of_the_healthy_recordings() {
        let all: Vec<Observation> = records(&prior(), 8 * 4).iter().map(observed).collect();
        let sound: Vec<Observation> = all.iter().step_by(8).cloned().collect();
        let one = rule(&all[..1], &sound[..1]);
        assert_eq!(one.is_damaged(), Some(false));
        let of = &one.wheels[1][0];
        assert!(
            (of.now / of.healthy.unwrap() - 1.0).abs() < 1e-12
                && (of.limit.unwrap() / of.now - INDICATORS[0].2).abs() < 1e-12
        );
        let words = one.in_words(&["pinion".into(), "gear".into()]).unwrap();
        assert!(words.starts_with("by the indicators alone it is healthy"), "{words}");

        let several = rule(&all[..1], &sound);
        let single = |of: &Observation| rule(std::slice::from_ref(of), &[]).wheels[1][0].now;
        let values: Vec<f64> = sound.iter().map(single).collect();
        let mean = values.iter().sum::<f64>() / 4.0;
        let deviation = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / 3.0).sqrt();
        assert!((several.wheels[1][0].limit.unwrap() - mean - 3.0 * deviation).abs() < 1e-9);

        // Without a healthy recording nothing has a limit; a burst is above it.
        let alone = rule(&all[..1], &[]);
        assert_eq!(
            (alone.is_damaged(), &alone.to_json(&["pinion".into(), "gear".into()])["is_damaged"]),
            (None, &Value::Null)
        );
        let heavy = records(&prior(), 400);
        let is_heavy = |of: &&crate::ReferenceRecord| {
            of.fault.as_ref().is_some_and(|fault| fault.wheel == 1 && fault.severity > 0.9)
        };
        let heavy = heavy.iter().find(is_heavy).unwrap();
        let before = observed(&records(&prior(), heavy.number)[heavy.unit() as usize * 8]);
        let found = rule(&[observed(heavy)], &[before]);
        let names = ["pinion".to_owned(), "gear".to_owned()];
        assert_eq!(
            (found.is_damaged(), found.wheels[1][0].is_above()),
            (Some(true), Some(true)),
            "{found:?}"
        );
        assert_eq!(found.to_json(&names)["wheels"]["gear"]["fm4"]["is_above"], true);
        assert!(found.in_words(&names).unwrap().starts_with("by the indicators alone it is damaged: "));
    }
}
