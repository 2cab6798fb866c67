//! From a question to its answer.

use meshtone::signal::AngleZero;
use meshtone_fourier::Complex64;
use meshtone_learn::{WheelLines, interval, quantiles, revolution};

use crate::DiagnoseError;
use crate::answer::{
    Answer, AnyDamage, Explanation, HEALTHY, KindAnswer, PlaceAnswer, SEVERAL, SizeAnswer, ToothAnswer,
};
use crate::any_damage::sentence;
use crate::bearings;
use crate::layout::{FeatureRow, Layout};
use crate::learn::{Learned, Seen};
use crate::observation::{Observation, Question};
use crate::prior::{DrawnFault, Prior};
use crate::refine::Refined;
use crate::rule::Rule;
use crate::warnings::warnings;

/// (-) p-value below which a recording is called unlike all that was simulated.
pub const OUTSIDE: f64 = 0.05;
/// Simulations whose signals make the predictive band.
const IN_BAND: usize = 120;
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
        return Err(DiagnoseError::OtherQuestion);
    }
    let seen = learned.seen(question);
    let healthy = learned.classes.iter().zip(&seen.of_class).filter(|(class, _)| class.is_none());
    let probability = healthy.map(|(_, probability)| probability).sum();
    let mut kinds =
        vec![KindAnswer { label: HEALTHY, probability, severity: None, sizes: Vec::new(), place: None }];
    let asked = Asked { learned, question, refined, seen: &seen };
    let mut draws_of: Vec<(&'static str, Draws)> = Vec::new();
    for kind in 0..=learned.kinds.len() {
        if let Some((answer, severity)) = asked.kind_answer(kind)? {
            draws_of.push((answer.label, severity));
            kinds.push(answer);
        }
    }
    let Seen { row, of_class, .. } = &seen;
    kinds.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    // No simulation has what speaks against a recording.
    let is_own = question.now.iter().any(|asked| asked.mismatch.is_some());
    let least = 1.0 / (learned.records.len() + 1) as f64;
    let outside_model = if is_own { least } else { learned.outside.p_value(&row.values) };
    let healthy_outside_model = learned.healthy_outside.as_ref().map(|outside| {
        let alone = Question { now: question.healthy, healthy: &[] };
        outside.p_value(&learned.layout.question(&alone).values)
    });
    let common_change = row.alike.as_ref().map(|asked| learned.common_changes.of(asked));
    let wheels = &learned.reference.prior.train.wheels;
    let of_wheels = learned.wheel_probabilities(of_class);
    let any_damage = AnyDamage::over(&kinds, &draws_of, &of_wheels);
    let of_any = of_wheels.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let is_seen = |wheel: &usize| question.now[0].wheels[*wheel].is_some();
    let shown_wheel = any_damage.as_ref().map(|any| any.wheel).filter(is_seen).unwrap_or(wheels.len() - 1);
    let likeliest = kinds.iter().find(|kind| kind.label != HEALTHY).map(|kind| kind.label);
    let severity_draws = draws_of.into_iter().find(|(label, _)| Some(*label) == likeliest);
    let shown = WheelView::new(learned, question, &seen, shown_wheel);
    let mut answer = Answer {
        signal: learned.layout.signal,
        has_healthy: learned.layout.has_healthy,
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
        outside_model,
        healthy_outside_model,
        common_change,
        is_misstated: question.is_misstated(),
        rule: Rule::new(question, &layout),
        warnings: Vec::new(),
        difference_g: question.now[0].wheels[shown_wheel]
            .as_ref()
            .map_or_else(Vec::new, |of| shown.difference_g(of)),
        band_g: shown.band(),
        explanations: shown.explanations(),
        severity_draws: severity_draws.map_or_else(Vec::new, |(_, draws)| spread(draws)),
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
    seen: &'a Seen,
}

impl Asked<'_> {
    /// The answer about a kind of damage, with the draws of its severity; none where no simulation is of that kind.
    ///
    /// A kind has a class for each wheel. Its severity and sizes are those of both, weighted by probability; its place is the likelier
    /// wheel's, since a tooth is one of one wheel.
    fn kind_answer(&self, kind: usize) -> Result<Option<(KindAnswer, Draws)>, DiagnoseError> {
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
        // The severity, then the sizes that vary.
        let mut numbers: Vec<(Option<usize>, Draws)> = Vec::new();
        if size_keys.is_empty() && kind < learned.kinds.len() {
            numbers.push((None, vec![(1.0, 1.0)]));
        } else {
            for (class, _, part) in classes {
                if class != likeliest && part <= NEGLIGIBLE * probability {
                    continue;
                }
                self.add_draws(class, share(part), &mut numbers)?;
            }
        }
        let severity = numbers.remove(0).1;
        let size = |(place, draws): &(Option<usize>, Draws)| {
            Some(SizeAnswer { key: size_keys[(*place)?], interval: interval(draws) })
        };
        let answer = KindAnswer {
            label,
            probability,
            severity: Some(interval(&severity)),
            sizes: numbers.iter().filter_map(size).collect(),
            place: Some(place(learned, self.question, &self.seen.row, likeliest, wheel, share(of_wheel))),
        };
        Ok(Some((answer, severity)))
    }

    /// Adds the draws of a class's severity and sizes, whose weights add up to its share.
    fn add_draws(
        &self,
        class: usize,
        share: f64,
        numbers: &mut Vec<(Option<usize>, Draws)>,
    ) -> Result<(), DiagnoseError> {
        let models = match self.refined.and_then(|refined| refined.of_class(class)) {
            Some(models) => models,
            None => self.learned.sizes(class)?,
        };
        for (number, model) in models {
            let draws = model.posterior(&self.seen.features);
            let total: f64 = draws.iter().map(|(_, weight)| weight).sum();
            let draws = draws.into_iter().map(|(value, weight)| (value, share * weight / total));
            match numbers.iter_mut().find(|(known, _)| known == number) {
                Some((_, all)) => all.extend(draws),
                None => numbers.push((*number, draws.collect())),
            }
        }
        Ok(())
    }
}

/// A weighted sample as one without weights.
fn spread(draws: Draws) -> Vec<f64> {
    const COUNT: usize = 400;
    let parts: [f64; COUNT] = std::array::from_fn(|at| (at as f64 + 0.5) / COUNT as f64);
    quantiles(draws, parts).to_vec()
}

/// Place of a damage of a class: the angle of its burst, less the distance of the simulations' bursts behind the tooth's first contact.
fn place(
    learned: &Learned,
    question: &Question,
    row: &FeatureRow,
    class: usize,
    wheel: usize,
    of_wheel: f64,
) -> PlaceAnswer {
    let mut answer = PlaceAnswer { wheel, wheel_probability: of_wheel, is_on_one_tooth: false, tooth: None };
    let teeth = f64::from(learned.reference.prior.train.wheels[wheel].teeth);
    let on_one = |fault: &DrawnFault| fault.is_on_one_tooth;
    let is_on_one = |row: &usize| learned.records[*row].fault.as_ref().is_some_and(on_one);
    answer.is_on_one_tooth = learned.rows_of(class).iter().all(is_on_one);
    if !answer.is_on_one_tooth || counted_from(question, wheel).is_none() {
        return answer;
    }
    // Those that resemble the recording most show how far the burst is behind.
    let point = learned.outside.point(&row.values);
    let near = learned.outside.nearest(&point, &|other| learned.class_of[other] == class, 60);
    let behind = near.iter().filter_map(|&(_, other)| {
        let tooth = f64::from(learned.records[other].fault.as_ref()?.tooth) - 1.0;
        let pitches = learned.rows[other].burst_rev[wheel] * teeth - tooth;
        Some((pitches + teeth / 2.0).rem_euclid(teeth) - teeth / 2.0)
    });
    let behind: Vec<f64> = behind.collect();
    // The pitch in which most of them are.
    let share = |from: f64| behind.iter().filter(|pitches| (**pitches - from).abs() <= 0.5).count();
    let Some(most) = behind.iter().copied().max_by_key(|&from| share(from)) else { return answer };
    let inside: Vec<f64> = behind.iter().copied().filter(|pitches| (pitches - most).abs() <= 0.5).collect();
    let offset = inside.iter().sum::<f64>() / inside.len() as f64;
    // A zero without a sign.
    let tooth = (row.burst_rev[wheel] * teeth - offset).round().rem_euclid(teeth) + 0.0;
    answer.tooth = Some(ToothAnswer {
        number: tooth as u32 + 1,
        angle_deg: 360.0 * tooth / teeth,
        probability: inside.len() as f64 / behind.len() as f64,
    });
    answer
}

/// From what the teeth of a wheel are counted; none where that is chance, or another place of the wheel in each recording.
fn counted_from(question: &Question, wheel: usize) -> Option<AngleZero> {
    let zero = |asked: &Observation| asked.zero[wheel];
    let first = zero(question.now.first()?);
    let is_one = question.now.len() == 1 || first.is_mark();
    let counts = first.counts_teeth() && is_one && question.now.iter().all(|asked| zero(asked) == first);
    counts.then_some(first)
}

/// Part of the figure that shows a wheel.
struct WheelView<'a> {
    learned: &'a Learned<'a>,
    wheel: usize,
    /// (-) Probability of each class.
    of_class: &'a [f64],
    /// The recording among the simulations.
    point: Vec<f64>,
    /// (rev) Where the burst of the first recording is, of what is beyond the healthy recording where there is one.
    burst_rev: f64,
    /// (g) Rms of the healthy recording's difference signal, by which simulations are brought to the path's gain.
    healthy_rms_g: Option<f64>,
    last: usize,
    points: usize,
}

impl<'a> WheelView<'a> {
    fn new(
        learned: &'a Learned,
        question: &Question,
        Seen { row, of_class, .. }: &'a Seen,
        wheel: usize,
    ) -> Self {
        let last = learned.layout.last[wheel];
        let of = |asked: &'_ Observation| asked.wheels[wheel].clone();
        Self {
            learned,
            wheel,
            of_class,
            point: learned.outside.point(&row.values),
            burst_rev: row.burst_rev[wheel],
            healthy_rms_g: question.healthy.first().and_then(of).map(|of| rms_g(&of, last)),
            last,
            points: (2 * last + 1).next_power_of_two(),
        }
    }

    /// (g) The difference signal over one revolution.
    fn difference_g(&self, wheel: &WheelLines) -> Vec<f64> {
        let lines: Vec<Complex64> = wheel.difference().into_iter().take(self.last + 1).collect();
        revolution(&lines, self.points)
    }

    /// The simulations of a class that resemble the recording most, nearest first.
    fn nearest(&self, class: usize, count: usize) -> impl Iterator<Item = usize> {
        let nearest =
            self.learned.outside.nearest(&self.point, &|other| self.learned.class_of[other] == class, count);
        nearest.into_iter().map(|(_, record)| record)
    }

    /// A simulation's difference signal, its burst where the recording has it, and as large as behind the recording's path.
    fn of_record(&self, record: usize) -> Vec<f64> {
        let burst_rev = self.learned.rows[record].burst_rev[self.wheel];
        let record = self.learned.records[record];
        let wheel = &record.wheels[self.wheel];
        let of_unit = self.learned.reference.healthy_of(record);
        let gain = match (self.healthy_rms_g, of_unit) {
            (Some(measured), Some(healthy)) => {
                measured / rms_g(&healthy.wheels[self.wheel], self.last).max(f64::MIN_POSITIVE)
            }
            _ => 1.0,
        };
        let signal = self.difference_g(wheel);
        let shift = ((self.burst_rev - burst_rev) * self.points as f64).round();
        let from =
            |point: usize| (point as f64 - shift).rem_euclid(self.points as f64) as usize % self.points;
        (0..self.points).map(|point| gain * signal[from(point)]).collect()
    }

    /// Finds the values between which nine in ten of the simulated signals are that resemble the recording: of each class as many
    /// signals as it is probable.
    fn band(&self) -> [Vec<f64>; 2] {
        let near = self.of_class.iter().enumerate().flat_map(|(class, probability)| {
            let share = (probability * IN_BAND as f64).round() as usize;
            self.nearest(class, share.min(self.learned.rows_of(class).len() / 3))
        });
        let signals: Vec<Vec<f64>> = near.map(|record| self.of_record(record)).collect();
        let bounds = |point: usize| {
            let values = signals.iter().map(|signal| (signal[point], 1.0)).collect();
            quantiles(values, [0.05, 0.95]).into()
        };
        let (low, high) = (0..self.points).map(bounds).unzip();
        [low, high]
    }

    /// The nearest simulation of each of the likeliest kinds, of either wheel.
    fn explanations(&self) -> Vec<Explanation> {
        let mut order: Vec<usize> = (0..self.of_class.len()).collect();
        order.sort_by(|&a, &b| self.of_class[b].total_cmp(&self.of_class[a]));
        let explain = |class: usize| {
            let record = self.nearest(class, 1).next()?;
            let fault = self.learned.records[record].fault.as_ref();
            Some(Explanation {
                label: fault.map_or(HEALTHY, |fault| Prior::label(&self.learned.kinds, fault.kind)),
                wheel: fault.map(|fault| fault.wheel),
                severity: fault.map_or(0.0, |fault| fault.severity),
                difference_g: self.of_record(record),
            })
        };
        order.into_iter().take(EXPLANATIONS).filter_map(explain).collect()
    }
}

/// (g) Rms of the difference signal.
fn rms_g(wheel: &WheelLines, last: usize) -> f64 {
    wheel.difference().iter().take(last + 1).map(|line| 2.0 * line.norm_sqr()).sum::<f64>().sqrt()
}
