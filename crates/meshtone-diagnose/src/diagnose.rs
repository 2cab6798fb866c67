//! From a question to its answer.

use std::collections::BTreeMap;

use meshtone::signal::{AngleZero, rms};
use meshtone_fourier::Complex64;
use meshtone_learn::{WheelLines, interval, quantiles, revolution};

use crate::DiagnoseError;
use crate::answer::{
    Answer, AnyDamage, Explanation, HEALTHY, KindAnswer, PlaceAnswer, SEVERAL, SizeAnswer, ToothAnswer,
};
use crate::any_damage::sentence;
use crate::bearings;
use crate::draw::DrawnFault;
use crate::layout::Layout;
use crate::learn::{Learned, Seen};
use crate::observation::{Observation, Question};
use crate::prior::Prior;
use crate::refine::Refined;
use crate::rule::Rule;
use crate::warnings::warnings;

/// (-) p-value below which a recording is called unlike all that was simulated.
pub const OUTSIDE: f64 = 0.05;
/// Simulations whose signals make the predictive band.
const IN_BAND: usize = 120;
/// Simulations that show how far a burst is behind the tooth's first contact.
const NEAR: usize = 60;
/// Simulations of a kind among which that is shown whose level is the recording's.
const ALIKE: usize = 12;
/// Explanations that are shown.
const EXPLANATIONS: usize = 3;
/// (-) Probability below which the size of a damage is said for its likelier wheel alone.
const NEGLIGIBLE: f64 = 0.02;

/// Values that a number may have, with their weights.
type Draws = Vec<(f64, f64)>;

/// Says what is wrong with the wheels of a rig.
///
/// A question that needs other features than those that were learnt is refused, since its values would stand in the wrong columns. Then
/// follow the answers of the kinds, the likeliest first, the tests whether the recordings are like any simulation, and what is shown.
/// Warnings and summary come last, because they read the answer.
///
/// # Arguments
/// * `learned` - of the reference set, for a question like this one
/// * `question` - the recordings
/// * `refined` - what a refined round for this question adds, where there was one
///
/// # Errors
/// A question unlike the one that was learnt for; too few simulations of a kind.
pub fn diagnose(
    learned: &Learned,
    question: &Question,
    refined: Option<&Refined>,
) -> Result<Answer, DiagnoseError> {
    question.check(&learned.reference.prior)?;
    let layout = Layout::of(question, learned.reference)?;
    let known = &learned.layout;
    let is_shorter = layout.last.iter().zip(&known.last).any(|(asked, known)| asked < known);
    if layout.signal != known.signal || layout.has_healthy != known.has_healthy || is_shorter {
        let problem = "the question is unlike the one that was learnt for: another signal, with or without healthy recordings, or fewer orders";
        return Err(DiagnoseError::Unfit(problem.to_owned()));
    }
    let asked = Asked { learned, question, refined, seen: learned.seen(question) };
    let Seen { row, of_class, of_wheels, .. } = &asked.seen;
    let healthy = learned.classes.iter().zip(of_class).filter(|(class, _)| class.is_none());
    let mut kinds = vec![KindAnswer {
        label: HEALTHY,
        probability: healthy.map(|(_, probability)| probability).sum(),
        severity: None,
        severity_draws: Vec::new(),
        sizes: Vec::new(),
        place: None,
    }];
    for kind in 0..=learned.kinds.len() {
        kinds.extend(asked.kind_answer(kind)?);
    }
    kinds.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    // No simulation has what speaks against a recording.
    let is_own = question.now.iter().any(|asked| asked.mismatch.is_some());
    let least = 1.0 / (learned.records.len() + 1) as f64;
    let healthy_alone = Question { now: question.healthy, healthy: &[] };
    let wheels = &learned.reference.prior.train.wheels;
    let of_any = of_wheels.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let any_damage = AnyDamage::over(&kinds, of_wheels);
    let is_seen = |wheel: &usize| question.now[0].wheels[*wheel].is_some();
    let shown_wheel = any_damage.as_ref().map(|any| any.wheel).filter(is_seen).unwrap_or(wheels.len() - 1);
    let shown = question.now[0].wheels[shown_wheel].as_ref();
    let difference_g = shown.map_or_else(Vec::new, |lines| asked.difference_g(lines, shown_wheel));
    let mut answer = Answer {
        signal: layout.signal,
        has_healthy: layout.has_healthy,
        recordings: question.now.len(),
        counted_from: (0..wheels.len()).map(|wheel| counted_from(question, wheel)).collect(),
        wheels: wheels.iter().map(|wheel| wheel.name.clone()).collect(),
        wheel_probabilities: of_wheels.iter().map(|of| of / of_any).collect(),
        shown_wheel,
        bearings: bearings::answers(&learned.reference.prior.train, question),
        summary: String::new(),
        any_damage,
        simulated_records: learned.reference.records.len(),
        reference_records: learned.records.len(),
        refined_records: refined.map_or(0, |refined| refined.records),
        kinds,
        outside_model: if is_own { least } else { learned.outside.p_value(&row.values) },
        healthy_outside_model: learned
            .healthy_outside
            .as_ref()
            .map(|outside| outside.p_value(&learned.layout.question(&healthy_alone).values)),
        common_change: row.alike.as_ref().map(|alike| learned.common_changes.of(alike)),
        is_misstated: question.is_misstated(),
        rule: Rule::new(question, &layout),
        warnings: Vec::new(),
        band_g: asked.band_g(shown_wheel),
        explanations: asked.explanations(shown_wheel, &difference_g),
        difference_g,
    };
    answer.warnings = warnings(&answer, learned, question);
    let of_bearings = bearings::sentence(&answer.bearings);
    answer.summary = of_bearings.into_iter().chain([sentence(&answer)]).collect::<Vec<_>>().join(" ");
    Ok(answer)
}

/// A question beside what was learnt for it.
struct Asked<'a> {
    learned: &'a Learned<'a>,
    question: &'a Question<'a>,
    refined: Option<&'a Refined>,
    seen: Seen,
}

impl Asked<'_> {
    /// The answer about a kind of damage; none where no simulation is of that kind.
    ///
    /// A kind has a class for each wheel. Its severity and sizes are those of both, weighted by probability; its place is the likelier
    /// wheel's, since a tooth is one of one wheel.
    fn kind_answer(&self, kind: usize) -> Result<Option<KindAnswer>, DiagnoseError> {
        let learned = self.learned;
        let (label, size_keys) =
            learned.kinds.get(kind).map_or((SEVERAL, &[][..]), |kind| (kind.name, kind.sizes));
        let wheel_of = |class: usize| learned.classes[class].filter(|(of, _)| *of == kind).map(|of| of.1);
        let classes = (0..self.seen.of_class.len())
            .filter_map(|class| Some((class, wheel_of(class)?, self.seen.of_class[class])))
            .collect::<Vec<(usize, usize, f64)>>();
        let Some(&(likeliest, wheel, of_wheel)) = classes.iter().max_by(|a, b| a.2.total_cmp(&b.2)) else {
            return Ok(None);
        };
        let probability: f64 = classes.iter().map(|(_, _, part)| part).sum();
        let share = |part: f64| part / probability.max(f64::MIN_POSITIVE);
        // The severity, and by their places the sizes that vary; the weights of a class add up to its share.
        let mut numbers: BTreeMap<Option<usize>, Draws> = BTreeMap::new();
        if size_keys.is_empty() && kind < learned.kinds.len() {
            numbers.insert(None, vec![(1.0, 1.0)]);
        } else {
            for (class, _, part) in classes {
                if class != likeliest && part <= NEGLIGIBLE * probability {
                    continue;
                }
                let models = match self.refined.filter(|refined| refined.class == class) {
                    Some(refined) => &refined.models,
                    None => learned.sizes(class)?,
                };
                for (number, model) in models {
                    let draws = model.posterior(&self.seen.features);
                    let total: f64 = draws.iter().map(|(_, weight)| weight).sum();
                    let draws =
                        draws.into_iter().map(|(value, weight)| (value, share(part) * weight / total));
                    numbers.entry(*number).or_default().extend(draws);
                }
            }
        }
        let severity_draws = numbers.remove(&None).unwrap_or_default();
        let size = |(place, draws): (&Option<usize>, &Draws)| {
            Some(SizeAnswer { key: size_keys[(*place)?], interval: interval(draws) })
        };
        Ok(Some(KindAnswer {
            label,
            probability,
            severity: Some(interval(&severity_draws)),
            severity_draws,
            sizes: numbers.iter().filter_map(size).collect(),
            place: Some(self.place(likeliest, wheel, share(of_wheel))),
        }))
    }

    /// Place of a damage of a class: the angle of its burst, less the distance of the simulations' bursts behind the tooth's first contact.
    fn place(&self, class: usize, wheel: usize, of_wheel: f64) -> PlaceAnswer {
        let learned = self.learned;
        let mut answer =
            PlaceAnswer { wheel, wheel_probability: of_wheel, is_on_one_tooth: false, tooth: None };
        let teeth = f64::from(learned.reference.prior.train.wheels[wheel].teeth);
        let on_one = |fault: &DrawnFault| fault.is_on_one_tooth;
        let is_on_one = |row: &usize| learned.records[*row].fault.as_ref().is_some_and(on_one);
        answer.is_on_one_tooth = learned.rows_of(class).iter().all(is_on_one);
        if !answer.is_on_one_tooth || counted_from(self.question, wheel).is_none() {
            return answer;
        }
        // Those that resemble the recording most show how far the burst is behind.
        let behind = self.nearest(class, NEAR).filter_map(|other| {
            let tooth = f64::from(learned.records[other].fault.as_ref()?.tooth) - 1.0;
            let pitches = learned.bursts_rev[other][wheel] * teeth - tooth;
            Some((pitches + teeth / 2.0).rem_euclid(teeth) - teeth / 2.0)
        });
        let behind: Vec<f64> = behind.collect();
        // The pitch in which most of them are.
        let share = |from: f64| behind.iter().filter(|pitches| (**pitches - from).abs() <= 0.5).count();
        let Some(most) = behind.iter().copied().max_by_key(|&from| share(from)) else { return answer };
        let inside: Vec<f64> =
            behind.iter().copied().filter(|pitches| (pitches - most).abs() <= 0.5).collect();
        let offset = inside.iter().sum::<f64>() / inside.len() as f64;
        // A zero without a sign.
        let tooth = (self.seen.row.burst_rev[wheel] * teeth - offset).round().rem_euclid(teeth) + 0.0;
        answer.tooth = Some(ToothAnswer {
            number: tooth as u32 + 1,
            angle_deg: 360.0 * tooth / teeth,
            probability: inside.len() as f64 / behind.len() as f64,
        });
        answer
    }

    /// The simulations of a class that resemble the recording most, nearest first.
    fn nearest(&self, class: usize, count: usize) -> impl Iterator<Item = usize> {
        let is_of_class = |other: usize| self.learned.class_of[other] == class;
        let point = self.learned.outside.point(&self.seen.row.values);
        self.learned.outside.nearest(&point, &is_of_class, count).into_iter().map(|(_, record)| record)
    }

    /// (g) The difference signal of a wheel over one revolution.
    fn difference_g(&self, lines: &WheelLines, wheel: usize) -> Vec<f64> {
        let last = self.learned.layout.last[wheel];
        let lines: Vec<Complex64> = lines.difference().into_iter().take(last + 1).collect();
        revolution(&lines, (2 * last + 1).next_power_of_two())
    }

    /// (g) A simulation's difference signal of a wheel, its burst where the first recording has it (of what is beyond the healthy recording where there is one),
    /// and as large as behind the recording's path.
    fn of_record(&self, record: usize, wheel: usize) -> Vec<f64> {
        let turn = self.seen.row.burst_rev[wheel] - self.learned.bursts_rev[record][wheel];
        let record = self.learned.records[record];
        let measured = self.question.healthy.first().and_then(|healthy| healthy.wheels[wheel].as_ref());
        let rms_g = |lines| rms_g(lines, self.learned.layout.last[wheel]);
        let gain = match (measured, self.learned.reference.healthy_of(record)) {
            (Some(measured), Some(simulated)) => {
                rms_g(measured) / rms_g(&simulated.wheels[wheel]).max(f64::MIN_POSITIVE)
            }
            _ => 1.0,
        };
        let mut signal = self.difference_g(&record.wheels[wheel], wheel);
        let points = signal.len() as f64;
        signal.rotate_right((turn * points).round().rem_euclid(points) as usize);
        signal.iter_mut().for_each(|value| *value *= gain);
        signal
    }

    /// (g) Finds the values between which nine in ten of the simulated signals of a wheel are that resemble the recording: of each class as many
    /// signals as it is probable.
    fn band_g(&self, wheel: usize) -> [Vec<f64>; 2] {
        let near = self.seen.of_class.iter().enumerate().flat_map(|(class, probability)| {
            let share = (probability * IN_BAND as f64).round() as usize;
            self.nearest(class, share.min(self.learned.rows_of(class).len() / 3))
        });
        let signals: Vec<Vec<f64>> = near.map(|record| self.of_record(record, wheel)).collect();
        let bounds = |point: usize| {
            let values = signals.iter().map(|signal| (signal[point], 1.0)).collect();
            quantiles(values, [0.05, 0.95]).into()
        };
        let points = (2 * self.learned.layout.last[wheel] + 1).next_power_of_two();
        let (low, high) = (0..points).map(bounds).unzip();
        [low, high]
    }

    /// A simulation of each of the likeliest kinds, of either wheel: of the nearest ones that whose signal is as loud as the recording's, since levels are a small part
    /// of what makes them near.
    ///
    /// # Arguments
    /// * `shown_wheel`, `difference_g` - the wheel that is shown, and the recording's signal
    fn explanations(&self, shown_wheel: usize, difference_g: &[f64]) -> Vec<Explanation> {
        let of_class = &self.seen.of_class;
        let mut order: Vec<usize> = (0..of_class.len()).collect();
        order.sort_by(|&a, &b| of_class[b].total_cmp(&of_class[a]));
        let apart = |signal: &[f64]| (rms(signal) / rms(difference_g)).ln().abs();
        let explain = |class: usize| {
            let near = self.nearest(class, ALIKE).map(|record| (record, self.of_record(record, shown_wheel)));
            let (record, difference_g) = near.min_by(|a, b| apart(&a.1).total_cmp(&apart(&b.1)))?;
            let fault = self.learned.records[record].fault.as_ref();
            Some(Explanation {
                label: fault.map_or(HEALTHY, |fault| Prior::label(&self.learned.kinds, fault.kind)),
                wheel: fault.map(|fault| fault.wheel),
                severity: fault.map_or(0.0, |fault| fault.severity),
                difference_g,
            })
        };
        order.into_iter().take(EXPLANATIONS).filter_map(explain).collect()
    }
}

/// From what the teeth of a wheel are counted; none where that is chance, or another place of the wheel in each recording.
fn counted_from(question: &Question, wheel: usize) -> Option<AngleZero> {
    let zero = |asked: &Observation| asked.zero[wheel];
    let first = zero(question.now.first()?);
    let is_one = question.now.len() == 1 || first.is_mark();
    let counts = first.counts_teeth() && is_one && question.now.iter().all(|asked| zero(asked) == first);
    counts.then_some(first)
}

/// (g) Rms of the difference signal.
fn rms_g(wheel: &WheelLines, last: usize) -> f64 {
    wheel.difference().iter().take(last + 1).map(|line| 2.0 * line.norm_sqr()).sum::<f64>().sqrt()
}
