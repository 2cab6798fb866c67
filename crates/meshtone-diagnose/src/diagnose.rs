//! From a question to its answer.

use meshtone::signal::AngleZero;
use meshtone::wheel::WheelName;

use crate::DiagnoseError;
use crate::answer::{Answer, AnyDamage, Explanation, HEALTHY, KindAnswer, PlaceAnswer, SizeAnswer};
use crate::any_damage::sentence;
use crate::features::burst_rev;
use crate::learn::{FeatureRow, Layout, Learned, Question};
use crate::observation::{Observation, WheelLines, revolution};
use crate::quantile::{interval, quantile};
use crate::refine::Refined;
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

/// Says what is wrong with a gear pair.
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
    let asked = Layout::of(question, learned.reference)?;
    let known = &learned.layout;
    let is_shorter = asked.last.iter().zip(known.last).any(|(asked, known)| *asked < known);
    if asked.signal != known.signal || asked.has_healthy != known.has_healthy || is_shorter {
        return Err(DiagnoseError::OtherQuestion);
    }
    let row = learned.row(question);
    let features = learned.features(&row);
    let of_class = learned.probabilities(&features);
    let mut kinds = vec![KindAnswer {
        label: HEALTHY,
        probability: learned
            .classes
            .iter()
            .zip(&of_class)
            .filter(|(class, _)| class.is_none())
            .map(|(_, p)| p)
            .sum(),
        severity: None,
        sizes: Vec::new(),
        place: None,
    }];
    let mut draws_of: Vec<(&'static str, Draws)> = Vec::new();
    for (kind, described) in learned.kinds.iter().enumerate() {
        let classes: Vec<(usize, WheelName, f64)> = learned
            .classes
            .iter()
            .enumerate()
            .filter_map(|(place, class)| {
                class.filter(|(of, _)| *of == kind).map(|(_, wheel)| (place, wheel, of_class[place]))
            })
            .collect();
        let Some(&(likeliest, wheel, of_wheel)) = classes.iter().max_by(|a, b| a.2.total_cmp(&b.2)) else {
            continue;
        };
        let probability: f64 = classes.iter().map(|(_, _, part)| part).sum();
        let counted: Vec<(usize, f64)> = classes
            .iter()
            .filter(|(class, _, part)| *class == likeliest || *part > NEGLIGIBLE * probability)
            .map(|(class, _, part)| (*class, part / probability.max(f64::MIN_POSITIVE)))
            .collect();
        // The severity, then the sizes that vary.
        let mut numbers: Vec<(Option<usize>, Draws)> = Vec::new();
        if described.sizes.is_empty() {
            numbers.push((None, vec![(1.0, 1.0)]));
        } else {
            for &(class, part) in &counted {
                let models = match refined.and_then(|refined| refined.of_class(class)) {
                    Some(models) => models,
                    None => learned.sizes(class)?,
                };
                for (number, model) in models {
                    let draws = model.posterior(&features);
                    let total: f64 = draws.iter().map(|(_, weight)| weight).sum();
                    let draws = draws.into_iter().map(|(value, weight)| (value, part * weight / total));
                    match numbers.iter_mut().find(|(known, _)| known == number) {
                        Some((_, all)) => all.extend(draws),
                        None => numbers.push((*number, draws.collect())),
                    }
                }
            }
        }
        let severity = numbers.remove(0).1;
        let sizes = numbers.iter().filter_map(|(place, draws)| {
            Some(SizeAnswer { key: described.sizes[(*place)?], interval: interval(draws) })
        });
        let sizes = sizes.collect();
        kinds.push(KindAnswer {
            label: described.name,
            probability,
            severity: Some(interval(&severity)),
            sizes,
            place: Some(place(
                learned,
                question,
                &row,
                likeliest,
                wheel,
                of_wheel / probability.max(f64::MIN_POSITIVE),
            )),
        });
        draws_of.push((described.name, severity));
    }
    kinds.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let mut outside_model = learned.outside.p_value(&row.values);
    // No simulation has what speaks against a recording.
    let least = 1.0 / (learned.records.len() + 1) as f64;
    let of_mismatch = |recordings: &[Observation]| {
        if recordings.iter().any(|asked| asked.mismatch.is_some()) { least } else { 1.0 }
    };
    outside_model = outside_model.min(of_mismatch(question.now));
    let healthy_outside_model = learned.healthy_outside.as_ref().map(|outside| {
        outside.p_value(&learned.healthy_row(question).values).min(of_mismatch(question.healthy))
    });
    let any_damage = AnyDamage::over(&kinds, &draws_of);
    let likeliest = kinds.iter().find(|kind| kind.label != HEALTHY).map(|kind| kind.label);
    let severity_draws = draws_of.into_iter().find(|(label, _)| Some(*label) == likeliest);
    let shown = GearView::of(learned, question);
    let mut answer = Answer {
        signal: learned.layout.signal,
        has_healthy: learned.layout.has_healthy,
        recordings: question.now.len(),
        counted_from: [WheelName::Pinion, WheelName::Gear].map(|wheel| counted_from(question, wheel)),
        summary: String::new(),
        any_damage,
        simulated_records: learned.reference.records.len(),
        reference_records: learned.records.len(),
        refined_records: refined.map_or(0, |refined| refined.records),
        kinds,
        outside_model,
        healthy_outside_model,
        warnings: Vec::new(),
        difference_g: shown.difference_g.clone(),
        band_g: shown.band(learned, &row, &of_class),
        explanations: shown.explanations(learned, &row, &of_class),
        severity_draws: severity_draws.map_or_else(Vec::new, |(_, draws)| spread(&draws)),
    };
    answer.warnings = warnings(&answer, learned, question);
    let is_outside = [Some(outside_model), healthy_outside_model].into_iter().flatten().any(|p| p < OUTSIDE);
    answer.summary = sentence(answer.damaged(), answer.any_damage.as_ref(), is_outside);
    Ok(answer)
}

/// A weighted sample as one without weights.
fn spread(draws: &[(f64, f64)]) -> Vec<f64> {
    const COUNT: usize = 400;
    let mut sorted = draws.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    (0..COUNT).map(|at| quantile(&sorted, (at as f64 + 0.5) / COUNT as f64)).collect()
}

/// Place of a damage of a class: the angle of its burst, less the distance of the simulations' bursts behind the tooth's first contact.
fn place(
    learned: &Learned,
    question: &Question,
    row: &FeatureRow,
    class: usize,
    wheel: WheelName,
    of_wheel: f64,
) -> PlaceAnswer {
    let mut answer = PlaceAnswer {
        wheel,
        wheel_probability: of_wheel,
        is_on_one_tooth: false,
        tooth: None,
        angle_deg: None,
        tooth_probability: None,
    };
    let index = usize::from(wheel == WheelName::Gear);
    let teeth = f64::from(learned.reference.prior.base.gears.teeth(wheel));
    let rows = learned.rows_of(class);
    let on_one = |fault: &crate::prior::DrawnFault| fault.is_on_one_tooth;
    if !rows.iter().all(|&row| learned.records[row].fault.as_ref().is_some_and(on_one)) {
        return answer;
    }
    answer.is_on_one_tooth = true;
    if counted_from(question, wheel).is_none() {
        return answer;
    }
    // Those that resemble the recording most show how far the burst is behind.
    let point = learned.outside.point(&row.values);
    let near = learned.outside.nearest(&point, |other| learned.class_of[other] == class, 60);
    let behind: Vec<f64> = near
        .iter()
        .filter_map(|&(_, other)| {
            let tooth = f64::from(learned.records[other].fault.as_ref()?.tooth) - 1.0;
            let pitches = learned.rows[other].burst_rev[index] * teeth - tooth;
            Some((pitches + teeth / 2.0).rem_euclid(teeth) - teeth / 2.0)
        })
        .collect();
    // The pitch in which most of them are.
    let share = |from: f64| behind.iter().filter(|pitches| (**pitches - from).abs() <= 0.5).count();
    let Some(most) = behind.iter().copied().max_by_key(|&from| share(from)) else { return answer };
    let inside: Vec<f64> = behind.iter().copied().filter(|pitches| (pitches - most).abs() <= 0.5).collect();
    let offset = inside.iter().sum::<f64>() / inside.len() as f64;
    // A zero without a sign.
    let tooth = (row.burst_rev[index] * teeth - offset).round().rem_euclid(teeth) + 0.0;
    answer.tooth = Some(tooth as u32 + 1);
    answer.angle_deg = Some(360.0 * tooth / teeth);
    answer.tooth_probability = Some(inside.len() as f64 / behind.len() as f64);
    answer
}

/// From what the teeth of a wheel are counted; none where that is chance, or another place of the wheel in each recording.
fn counted_from(question: &Question, wheel: WheelName) -> Option<AngleZero> {
    let zero = |asked: &Observation| asked.zero[usize::from(wheel == WheelName::Gear)];
    let first = zero(question.now.first()?);
    let is_one = question.now.len() == 1 || first.is_mark();
    let counts = first.counts_teeth() && is_one && question.now.iter().all(|asked| zero(asked) == first);
    counts.then_some(first)
}

/// Part of the figure that shows the gear.
struct GearView {
    /// (g) The difference signal of the first recording.
    difference_g: Vec<f64>,
    /// (rev) Where its burst is.
    burst_rev: f64,
    /// (g) Rms of the healthy recording's difference signal, by which simulations are brought to the path's gain.
    healthy_rms_g: Option<f64>,
    last: usize,
    points: usize,
}

impl GearView {
    fn of(learned: &Learned, question: &Question) -> Self {
        let last = learned.layout.last[1];
        let points = (2 * last + 1).next_power_of_two();
        let gear = &question.now[0].gear;
        Self {
            difference_g: revolution(&cut(gear, last), points),
            burst_rev: burst_rev(gear, last),
            healthy_rms_g: question.healthy.first().map(|healthy| rms_g(&healthy.gear, last)),
            last,
            points,
        }
    }

    /// A simulation's difference signal, its burst where the recording has it, and as large as behind the recording's path.
    fn of_record(&self, learned: &Learned, record: usize) -> Vec<f64> {
        let record = learned.records[record];
        let gear = &record.wheels[1];
        let of_unit = learned.reference.healthy_of(record);
        let gain = match (self.healthy_rms_g, of_unit) {
            (Some(measured), Some(healthy)) => {
                measured / rms_g(&healthy.wheels[1], self.last).max(f64::MIN_POSITIVE)
            }
            _ => 1.0,
        };
        let signal = revolution(&cut(gear, self.last), self.points);
        let shift = ((self.burst_rev - burst_rev(gear, self.last)) * self.points as f64).round();
        let from =
            |point: usize| (point as f64 - shift).rem_euclid(self.points as f64) as usize % self.points;
        (0..self.points).map(|point| gain * signal[from(point)]).collect()
    }

    /// Between which values nine in ten of the simulated signals are that resemble the recording.
    fn band(&self, learned: &Learned, row: &FeatureRow, of_class: &[f64]) -> [Vec<f64>; 2] {
        let near = similar_simulations(learned, row, of_class, IN_BAND);
        let signals: Vec<Vec<f64>> =
            near.iter().map(|&(_, record)| self.of_record(learned, record)).collect();
        let bounds = |point: usize| {
            let mut values: Vec<(f64, f64)> = signals.iter().map(|signal| (signal[point], 1.0)).collect();
            values.sort_by(|a, b| a.0.total_cmp(&b.0));
            [quantile(&values, 0.05), quantile(&values, 0.95)]
        };
        let (low, high) = (0..self.points).map(bounds).map(|[low, high]| (low, high)).unzip();
        [low, high]
    }

    /// The nearest simulation of each of the likeliest kinds, of either wheel.
    fn explanations(&self, learned: &Learned, row: &FeatureRow, of_class: &[f64]) -> Vec<Explanation> {
        let mut order: Vec<usize> = (0..of_class.len()).collect();
        order.sort_by(|&a, &b| of_class[b].total_cmp(&of_class[a]));
        let point = learned.outside.point(&row.values);
        let explain = |class: usize| {
            let nearest = learned.outside.nearest(&point, |other| learned.class_of[other] == class, 1);
            let record = nearest.first()?.1;
            let fault = learned.records[record].fault.as_ref();
            Some(Explanation {
                label: fault.map_or(HEALTHY, |fault| learned.kinds[fault.kind].name),
                wheel: fault.map(|fault| fault.wheel),
                severity: fault.map_or(0.0, |fault| fault.severity),
                difference_g: self.of_record(learned, record),
            })
        };
        order.into_iter().take(EXPLANATIONS).filter_map(explain).collect()
    }
}

/// The difference signal's lines.
fn cut(gear: &WheelLines, last: usize) -> Vec<meshtone_fourier::Complex64> {
    gear.difference().into_iter().take(last + 1).collect()
}

/// (g) Rms of the difference signal.
fn rms_g(gear: &WheelLines, last: usize) -> f64 {
    cut(gear, last).iter().map(|line| 2.0 * line.norm_sqr()).sum::<f64>().sqrt()
}

/// The simulations that resemble the recording most: of each class as many as it is probable.
fn similar_simulations(
    learned: &Learned,
    row: &FeatureRow,
    of_class: &[f64],
    count: usize,
) -> Vec<(f64, usize)> {
    let point = learned.outside.point(&row.values);
    let mut near = Vec::new();
    for (class, probability) in of_class.iter().enumerate() {
        let share = (probability * count as f64).round() as usize;
        let rows = learned.rows_of(class);
        let share = share.min(rows.len() / 3);
        if share > 0 {
            near.extend(learned.outside.nearest(&point, |other| learned.class_of[other] == class, share));
        }
    }
    near
}
