//! The model that is learnt from a reference set for one question.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use meshtone::random::{Draws, Purpose};
use meshtone::scenario::DamageKind;
use meshtone::signal::TrainWheel;
use meshtone_learn::{
    OutlierTest, RandomFeatures, SizeModel, Softmax, Standardisation, WheelFeatures, WheelLines,
    beyond_healthy, fold_of, quantiles, ridge, wheel_features,
};
use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::DiagnoseError;
use crate::answer::wheel_in_words;
use crate::mounting::Alike;
use crate::observation::{Observation, SignalKind};
use crate::prior::{DrawnFault, Focus, RECORDS_PER_UNIT};
use crate::reference::{ReferenceRecord, ReferenceSet};

/// Random features beside the linear ones.
const RANDOM_FEATURES: usize = 512;
/// (-) Penalty of the regression on classes, by which the linear features were best on other simulations.
const PENALTY: f64 = 100.0;
/// (-) Probability before anything is seen that nothing is damaged; the kinds of damage share the rest evenly.
const PRIOR_HEALTHY: f64 = 0.5;
/// (-) Noise in an average of unknown noise, as a part of its difference signal's rms: least and largest.
const UNKNOWN_NOISE: [f64; 2] = [0.003, 0.2];
/// (log10) Change of a wheel over its healthy level, below which it has not changed: two simulations of one load are equal but for their damage,
/// as no recordings are.
const LEAST_CHANGE: f64 = -1.5;
/// Fewest records that can be learnt from.
const FEWEST_RECORDS: usize = 200;
/// Fewest mesh orders that a signal must show.
const FEWEST_MESH_ORDERS: usize = 2;

/// A question: recordings of a rig in one state, and of the same rig when it was healthy.
#[derive(Debug, Clone, Copy)]
pub struct Question<'a> {
    /// Recordings of the state in question, at least one.
    pub now: &'a [Observation],
    /// Recordings of the same rig when it was healthy; may be empty.
    pub healthy: &'a [Observation],
}

impl Question<'_> {
    /// All recordings, those in question first.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Observation> {
        self.now.iter().chain(self.healthy)
    }
}

/// A class: what is damaged; none where nothing is.
pub(crate) type Class = Option<(usize, usize)>;

/// A model that is learnt from a reference set for one question.
pub struct Learned<'a> {
    pub(crate) reference: &'a ReferenceSet,
    pub(crate) kinds: Vec<DamageKind>,
    pub(crate) layout: Layout,
    /// The records that it was learnt from.
    pub(crate) records: Vec<&'a ReferenceRecord>,
    pub(crate) rows: Vec<FeatureRow>,
    pub(crate) classes: Vec<Class>,
    pub(crate) class_of: Vec<usize>,
    folds: Vec<usize>,
    standard: Standardisation,
    random: RandomFeatures,
    features: DMatrix<f64>,
    coefficients: DMatrix<f64>,
    softmax: Softmax,
    size_models: Vec<OnceLock<SizeModels>>,
    pub(crate) outside: OutlierTest,
    /// Healthy records as they are, without a healthy one before them.
    pub(crate) healthy_outside: Option<OutlierTest>,
}

/// Severity and sizes of a class's damages, by their places among the sizes; none of the severity.
pub(crate) type SizeModels = Result<Vec<(Option<usize>, SizeModel)>, DiagnoseError>;

/// The features that are compared, of the question and of simulations in recordings like those of the question.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    pub signal: SignalKind,
    pub has_healthy: bool,
    /// The last order of each wheel that is whole everywhere.
    pub last: Vec<usize>,
    /// The mesh frequency of each wheel, in orders of the first shaft.
    mesh_orders: Vec<f64>,
    /// (g) Noise in the lines of the recordings that are asked about, and of the healthy ones.
    noises: [Vec<Vec<f64>>; 2],
    /// (Hz) The rig's speed of the shaft that drives.
    nominal_hz: f64,
    /// Whether the recordings' speed is known.
    knows_speed: bool,
}

/// The wheels that a signal shows: all, or of a single revolution the gear, a pair's last.
fn shown(signal: SignalKind, wheels: &[WheelLines]) -> Vec<Option<&WheelLines>> {
    let is_shown = |place: usize| signal == SignalKind::Recording || place + 1 == wheels.len();
    wheels.iter().enumerate().map(|(place, wheel)| is_shown(place).then_some(wheel)).collect()
}

/// A wheel when it was healthy.
struct HealthyWheel {
    lines: WheelLines,
    features: WheelFeatures,
}

/// Features of one record.
#[derive(Debug, Clone)]
pub(crate) struct FeatureRow {
    pub values: Vec<f64>,
    /// (rev) Where the burst of each wheel is.
    pub burst_rev: Vec<f64>,
    /// What changed alike in all wheels since the healthy one; none without one, or of a single wheel.
    pub alike: Option<Alike>,
}

impl Layout {
    /// What is compared for a question.
    ///
    /// Recordings that cannot be compared, of other wheels, values that are not finite, or a signal of another kind, are refused here,
    /// before any simulation is looked at. The orders reach as far as the shortest of all averages, since features over other orders would
    /// differ without any damage.
    pub(crate) fn of(question: &Question, reference: &ReferenceSet) -> Result<Self, DiagnoseError> {
        let first = question.now.first().ok_or(DiagnoseError::NoRecording)?;
        let rig = &reference.prior.train.wheels;
        let expected: Vec<u32> = rig.iter().map(|wheel| wheel.teeth).collect();
        for asked in question.all() {
            // A wheel that is not seen may be the expected one.
            let teeth = |(place, seen): (usize, &Option<WheelLines>)| {
                let unseen = || expected.get(place).copied().unwrap_or(0);
                seen.as_ref().map_or_else(unseen, |wheel| wheel.teeth() as u32)
            };
            let given: Vec<u32> = asked.wheels.iter().enumerate().map(teeth).collect();
            if given != expected {
                return Err(DiagnoseError::OtherWheels { given, expected });
            }
            if let Some(value) = asked.input_speed_hz.filter(|hz| !hz.is_finite() || *hz <= 0.0) {
                let (what, beside) = ("speed (Hz)", " and more than 0");
                return Err(DiagnoseError::NotFinite { what, value, beside });
            }
            let lines = asked.wheels.iter().flatten().flat_map(|wheel| &wheel.lines);
            if let Some(value) = lines.map(|line| line.norm()).find(|norm| !norm.is_finite()) {
                return Err(DiagnoseError::NotFinite { what: "average", value, beside: "" });
            }
            if asked.signal != first.signal {
                let (healthy, asked) = (asked.signal.name(), first.signal.name());
                return Err(DiagnoseError::OtherSignal { healthy, asked });
            }
        }
        let last = |wheel: usize| {
            let simulated = reference.records.iter().map(|record| &record.wheels[wheel]);
            let observed = question.all().filter_map(|asked| asked.wheels[wheel].as_ref());
            simulated.chain(observed).map(WheelLines::last).min().unwrap_or(0)
        };
        let last: Vec<usize> = (0..rig.len()).map(last).collect();
        let train = &reference.prior.train;
        let mesh_order =
            |wheel: &TrainWheel| f64::from(wheel.teeth) * train.speed_ratio(wheel.shaft, 0).value();
        for ((wheel, &last), _) in rig.iter().zip(&last).zip(&first.wheels).filter(|(_, seen)| seen.is_some())
        {
            let needed = FEWEST_MESH_ORDERS * wheel.teeth as usize + wheel.teeth as usize / 2;
            if last < needed {
                let (of, wheel) = (first.signal.name(), wheel_in_words(&wheel.name));
                return Err(DiagnoseError::TooFewOrders { of, wheel, last, needed });
            }
        }
        Ok(Self {
            signal: first.signal,
            has_healthy: !question.healthy.is_empty(),
            last,
            mesh_orders: rig.iter().map(mesh_order).collect(),
            noises: [question.now, question.healthy].map(noise_of),
            nominal_hz: reference.prior.base.operation.pinion_speed_hz,
            knows_speed: question.now.iter().any(|asked| asked.input_speed_hz.is_some()),
        })
    }

    /// Finds the features of simulations that can be compared with the question, in their order. Those of the healthy one of a unit are found once
    /// for all that are compared with it.
    fn simulations(&self, reference: &ReferenceSet, records: &[&ReferenceRecord]) -> Vec<FeatureRow> {
        let seed = reference.prior.seed;
        let mut before: Vec<&ReferenceRecord> = match self.has_healthy {
            true => records.iter().filter_map(|record| reference.healthy_of(record)).collect(),
            false => Vec::new(),
        };
        before.dedup_by_key(|record| record.number);
        let of_unit = |record: &&ReferenceRecord| {
            let noisy = with_noise(record, self, &self.noises[1], seed);
            (record.unit(), self.healthy(&shown(self.signal, &noisy)))
        };
        let before: BTreeMap<u64, Vec<Option<HealthyWheel>>> = before.par_iter().map(of_unit).collect();
        let row = |record: &&ReferenceRecord| {
            let now = with_noise(record, self, &self.noises[0], seed);
            let speed = if self.knows_speed { (record.input_speed_hz / self.nominal_hz).ln() } else { 0.0 };
            self.row(&shown(self.signal, &now), before.get(&record.unit()).map(Vec::as_slice), speed)
        };
        records.par_iter().map(row).collect()
    }

    /// Finds the features of wheels when they are healthy.
    fn healthy(&self, wheels: &[Option<&WheelLines>]) -> Vec<Option<HealthyWheel>> {
        let of = |(wheel, lines): (usize, &Option<&WheelLines>)| {
            let lines = (*lines)?.clone();
            let features = wheel_features(&lines, self.last[wheel], self.signal.has_regular_part());
            Some(HealthyWheel { lines, features })
        };
        wheels.iter().enumerate().map(of).collect()
    }

    /// Features of two states of one rig, or of one alone.
    ///
    /// Beside a healthy one only changes count: levels and shapes themselves are the rig's and its path's, which no prior contains. Simulations are told apart as well
    /// without them.
    ///
    /// # Arguments
    /// * `now` - lines of the wheels that are seen
    /// * `healthy` - the same wheels when they were healthy
    /// * `speed` - (-) logarithm of the speed over the rig's; 0 where it is not known
    fn row(
        &self,
        now: &[Option<&WheelLines>],
        healthy: Option<&[Option<HealthyWheel>]>,
        speed: f64,
    ) -> FeatureRow {
        let mut row = FeatureRow { values: vec![speed], burst_rev: vec![0.0; now.len()], alike: None };
        let regular = self.signal.has_regular_part();
        let mut bands = Vec::new();
        for (wheel, now) in now.iter().enumerate() {
            let (Some(now), last) = (now, self.last[wheel]) else { continue };
            let plain = wheel_features(now, last, regular);
            let Some(HealthyWheel { lines, features: before }) =
                healthy.and_then(|healthy| healthy[wheel].as_ref())
            else {
                row.burst_rev[wheel] = plain.burst_rev;
                row.values.extend(plain.levels);
                row.values.extend(plain.shapes);
                continue;
            };
            let beyond = wheel_features(&beyond_healthy(now, lines, last), last, false);
            row.burst_rev[wheel] = beyond.burst_rev;
            let louder = less(&plain.levels, &before.levels);
            bands.push((self.mesh_orders[wheel], louder[plain.bands()].to_vec()));
            // A level that is wrong as a whole is wrong in all orders, damage in some.
            row.values.push(quantiles(louder.iter().map(|level| (*level, 1.0)).collect(), [0.5])[0]);
            row.values.extend(louder);
            row.values.extend(less(&plain.shapes, &before.shapes));
            let changed = less(&beyond.levels, &before.levels);
            row.values.extend(changed.into_iter().map(|level| level.max(LEAST_CHANGE)));
            row.values.extend(beyond.shapes);
        }
        row.alike = Alike::new(&bands);
        row
    }

    /// Features of the question: the mean over its recordings.
    fn question(&self, question: &Question) -> FeatureRow {
        let mut rows = Vec::new();
        let before: Vec<_> = question.healthy.iter().map(|before| self.healthy(&before.seen())).collect();
        for now in question.now {
            let speed = now.input_speed_hz.map_or(0.0, |hz| (hz / self.nominal_hz).ln());
            let now = now.seen();
            if before.is_empty() {
                rows.push(self.row(&now, None, speed));
            }
            rows.extend(before.iter().map(|before| self.row(&now, Some(before), speed)));
        }
        let count = rows.len() as f64;
        let mut mean = rows[0].clone();
        for other in &rows[1..] {
            mean.values.iter_mut().zip(&other.values).for_each(|(sum, value)| *sum += value);
        }
        mean.values.iter_mut().for_each(|value| *value /= count);
        mean.alike = Alike::mean(&rows.iter().filter_map(|row| row.alike.as_ref()).collect::<Vec<_>>());
        mean
    }
}

fn less(now: &[f64], before: &[f64]) -> Vec<f64> {
    now.iter().zip(before).map(|(now, before)| now - before).collect()
}

/// The test whether a healthy recording is like the healthy simulations, in its own noise and without another recording beside it.
fn healthy_test(layout: &Layout, reference: &ReferenceSet) -> OutlierTest {
    let noises = [layout.noises[1].clone(), Vec::new()];
    let alone = Layout { has_healthy: false, noises, ..layout.clone() };
    let healthy: Vec<&ReferenceRecord> = reference.healthy().collect();
    let rows: Vec<Vec<f64>> =
        alone.simulations(reference, &healthy).into_iter().map(|row| row.values).collect();
    let units = healthy.iter().map(|record| record.unit()).collect();
    OutlierTest::new(&rows, units, vec![true; rows.len()])
}

impl<'a> Learned<'a> {
    /// Learns what a question needs.
    ///
    /// Simulations that the question cannot resemble are left out first. The features of the others, made with the question's noise
    /// and orders, are standardised and regressed on the classes. The probabilities are fitted to predictions for simulations that the
    /// regression has not seen: to its own ones it would be too certain. The models of sizes are fitted once they are needed.
    ///
    /// # Arguments
    /// * `reference` - simulations of what may be
    /// * `question` - recordings; what they are decides which simulations, orders and noise they are held against
    ///
    /// # Errors
    /// A recording of other wheels, or of too few orders; too few simulations.
    pub fn new(reference: &'a ReferenceSet, question: &Question) -> Result<Self, DiagnoseError> {
        let layout = Layout::of(question, reference)?;
        let kinds = reference.prior.kinds();
        let is_asked = |record: &&ReferenceRecord| {
            let of_gear = record.fault.as_ref().is_none_or(|fault| fault.wheel + 1 == record.wheels.len());
            let is_first = record.number.is_multiple_of(RECORDS_PER_UNIT);
            (layout.signal == SignalKind::Recording || of_gear)
                && (!layout.has_healthy || (!is_first && reference.healthy_of(record).is_some()))
        };
        let records: Vec<&ReferenceRecord> = reference.records.iter().filter(is_asked).collect();
        if records.len() < FEWEST_RECORDS {
            return Err(DiagnoseError::NoReference);
        }
        let rows = layout.simulations(reference, &records);
        let mut classes: Vec<Class> = records.iter().map(|record| class_of(record)).collect();
        classes.sort_unstable();
        classes.dedup();
        let place = |record: &&ReferenceRecord| classes.iter().position(|class| *class == class_of(record));
        let class_of: Vec<usize> = records.iter().filter_map(place).collect();
        let folds: Vec<usize> = records.iter().map(|record| fold_of(record.unit())).collect();
        let weights = weights(&class_of, &classes);
        let values: Vec<Vec<f64>> = rows.iter().map(|row| row.values.clone()).collect();
        let standard = Standardisation::of(&values);
        let standardised: Vec<Vec<f64>> = values.iter().map(|row| standard.apply(row)).collect();
        let width = values.first().map_or(0, Vec::len);
        let random = RandomFeatures::new(width, RANDOM_FEATURES, reference.prior.seed);
        let features = random.of(&standardised);
        let is_class = |class: usize, row: usize| f64::from(u8::from(class_of[row] == class));
        let targets = DMatrix::from_fn(classes.len(), records.len(), is_class);
        let regression = ridge(&features, &targets, &weights, &folds, PENALTY)?;
        let softmax = Softmax::fit(&regression.out_of_fold, &class_of, &weights)?;
        // Two damages at once may be anything between and beside the kinds: what is unlike a single one is outside.
        let is_single =
            |record: &ReferenceRecord| record.fault.as_ref().is_none_or(|of| of.kind < kinds.len());
        // Healthy records count as one each, not as half of all. They are the least strange ones, so that more weight would make damaged
        // recordings be called outside more often than the p-value says.
        let expected = records.iter().map(|record| is_single(record)).collect();
        let units = records.iter().map(|record| record.unit()).collect();
        let outside = OutlierTest::new(&values, units, expected);
        let healthy_outside = layout.has_healthy.then(|| healthy_test(&layout, reference));
        let size_models = classes.iter().map(|_| OnceLock::new()).collect();
        Ok(Self {
            reference,
            kinds,
            layout,
            records,
            rows,
            classes,
            class_of,
            folds,
            standard,
            random,
            features,
            coefficients: regression.coefficients,
            softmax,
            size_models,
            outside,
            healthy_outside,
        })
    }

    /// Features of the question.
    pub(crate) fn row(&self, question: &Question) -> FeatureRow {
        self.layout.question(question)
    }

    /// Features of a row as regressions use them.
    pub(crate) fn features(&self, row: &FeatureRow) -> Vec<f64> {
        self.random.of(&[self.standard.apply(&row.values)]).column(0).iter().copied().collect()
    }

    /// (-) The probability of each class.
    pub(crate) fn probabilities(&self, features: &[f64]) -> Vec<f64> {
        let columns = self.coefficients.column_iter();
        let scores = columns.map(|column| column.iter().zip(features).map(|(a, b)| a * b).sum());
        self.softmax.probabilities(&scores.collect::<Vec<f64>>())
    }

    /// (-) The probability of damage to each wheel.
    ///
    /// # Arguments
    /// * `of_class` - (-) probability of each class
    pub(crate) fn wheel_probabilities(&self, of_class: &[f64]) -> Vec<f64> {
        let of_wheel = |wheel: usize| {
            let classes = self.classes.iter().zip(of_class);
            let of_wheel = classes.filter(|(class, _)| class.is_some_and(|(_, of)| of == wheel));
            of_wheel.map(|(_, probability)| probability).sum()
        };
        (0..self.reference.prior.train.wheels.len()).map(of_wheel).collect()
    }

    /// The rows of a class.
    pub(crate) fn rows_of(&self, class: usize) -> Vec<usize> {
        (0..self.class_of.len()).filter(|&row| self.class_of[row] == class).collect()
    }

    /// Model of the numbers of the damages of a class: the severity, then the sizes that vary, by their places.
    ///
    /// # Arguments
    /// * `class` - a damaged one, by its place
    ///
    /// # Errors
    /// Too few simulations.
    pub(crate) fn sizes(&self, class: usize) -> Result<&[(Option<usize>, SizeModel)], DiagnoseError> {
        let known = self.size_models[class].get_or_init(|| self.fit_sizes(class, None));
        known.as_deref().map_err(Clone::clone)
    }

    /// Does what [`Self::sizes`] does, by the simulations within a range of severities.
    ///
    /// # Arguments
    /// * `refined` - more simulations in the range of their focus; none: all severities, without more
    pub(crate) fn fit_sizes(&self, class: usize, refined: Option<&ReferenceSet>) -> SizeModels {
        let focus = refined.and_then(|refined| refined.prior.focus.as_ref());
        let is_within = |fault: &DrawnFault| {
            focus
                .is_none_or(|Focus { severity: [least, most], .. }| (least..=most).contains(&&fault.severity))
        };
        let (rows, mut faults): (Vec<usize>, Vec<&DrawnFault>) = self
            .rows_of(class)
            .into_iter()
            .filter_map(|row| Some((row, self.records[row].fault.as_ref().filter(|fault| is_within(fault))?)))
            .unzip();
        let mut folds: Vec<usize> = rows.iter().map(|&row| self.folds[row]).collect();
        let mut features = self.features.select_columns(&rows);
        if let Some(refined) = refined {
            let more = self.refined_rows(refined);
            if more.len() < refined.records.len() / 2 {
                return Err(DiagnoseError::NoReference);
            }
            let values: Vec<Vec<f64>> =
                more.iter().map(|(_, row)| self.standard.apply(&row.values)).collect();
            let known = features.ncols();
            features = features.resize_horizontally(known + more.len(), 0.0);
            features.columns_mut(known, more.len()).copy_from(&self.random.of(&values));
            folds.extend(more.iter().map(|(record, _)| fold_of(record.unit())));
            faults.extend(more.iter().filter_map(|(record, _)| record.fault.as_ref()));
        }
        let mut places = vec![None];
        let mut numbers = vec![faults.iter().map(|fault| fault.severity).collect::<Vec<f64>>()];
        for place in 0..faults.first().map_or(0, |fault| fault.sizes.len()) {
            let values: Vec<f64> = faults.iter().map(|fault| fault.sizes[place]).collect();
            // A list is no number; what is the same always needs no regression.
            if values.iter().all(|value| value.is_finite()) && values.iter().any(|value| *value != values[0])
            {
                places.push(Some(place));
                numbers.push(values);
            }
        }
        let models = SizeModel::fit(&features, &numbers, &folds)?;
        Ok(places.into_iter().zip(models).collect())
    }

    /// The damaged records of a refined round that can be compared with the question, with what they show.
    fn refined_rows<'r>(&self, refined: &'r ReferenceSet) -> Vec<(&'r ReferenceRecord, FeatureRow)> {
        let is_whole = |record: &ReferenceRecord| {
            record.wheels.iter().zip(&self.layout.last).all(|(wheel, last)| wheel.last() >= *last)
        };
        let is_compared = |record: &&ReferenceRecord| {
            let has_healthy = || refined.healthy_of(record).is_some_and(is_whole);
            record.fault.is_some() && is_whole(record) && (!self.layout.has_healthy || has_healthy())
        };
        let records: Vec<&ReferenceRecord> = refined.records.iter().filter(is_compared).collect();
        let rows = self.layout.simulations(refined, &records);
        records.into_iter().zip(rows).collect()
    }
}

fn class_of(record: &ReferenceRecord) -> Class {
    record.fault.as_ref().map(|fault| (fault.kind, fault.wheel))
}

/// Weights by which half of all records are healthy, and each kind of damage on each wheel is as likely as the next.
fn weights(class_of: &[usize], classes: &[Class]) -> Vec<f64> {
    let counts: Vec<f64> =
        (0..classes.len()).map(|class| class_of.iter().filter(|of| **of == class).count() as f64).collect();
    let damaged = classes.iter().filter(|class| class.is_some()).count().max(1) as f64;
    let total = class_of.len() as f64;
    let weight = |class: usize| match classes[class] {
        None => PRIOR_HEALTHY * total / counts[class],
        Some(_) => (1.0 - PRIOR_HEALTHY) / damaged * total / counts[class],
    };
    class_of.iter().map(|&class| weight(class)).collect()
}

/// (g) The noise in the lines by mesh order, the mean of the recordings; empty where it is not known.
fn noise_of(recordings: &[Observation]) -> Vec<Vec<f64>> {
    let wheels = recordings.first().map_or(0, |asked| asked.noise.len());
    let of_wheel = |wheel: usize| {
        let known: Vec<&Vec<f64>> =
            recordings.iter().map(|asked| &asked.noise[wheel]).filter(|noise| !noise.is_empty()).collect();
        let Some(count) = known.iter().map(|noise| noise.len()).min() else { return Vec::new() };
        let square =
            |band: usize| known.iter().map(|noise| noise[band].powi(2)).sum::<f64>() / known.len() as f64;
        (0..count).map(|band| square(band).sqrt()).collect()
    };
    (0..wheels).map(of_wheel).collect()
}

/// The lines of a record as they would be in a recording with such noise.
fn with_noise(record: &ReferenceRecord, layout: &Layout, noise: &[Vec<f64>], seed: u64) -> Vec<WheelLines> {
    let mut draws = Draws::new(seed, Purpose::DiagnosisNoise, record.number);
    let [least, largest] = UNKNOWN_NOISE;
    let part = least * (largest / least).powf(draws.uniform(0.5, 0.5));
    let noisy = |(wheel, lines): (usize, &WheelLines)| {
        let known = noise.get(wheel).map_or(&[][..], Vec::as_slice);
        lines.with_noise(layout.last[wheel], known, part, &mut draws)
    };
    record.wheels.iter().enumerate().map(noisy).collect()
}
