//! The model that is learnt from a reference set for one question.

use std::sync::OnceLock;

use meshtone::scenario::DamageKind;
use meshtone_learn::{OutlierTest, RandomFeatures, SizeModel, Softmax, fold_of, ridge};
use nalgebra::DMatrix;

use crate::DiagnoseError;
use crate::draw::{DrawnFault, RECORDS_PER_UNIT};
use crate::layout::{FeatureRow, Layout};
use crate::mounting::CommonChanges;
use crate::observation::{Question, SignalKind};
use crate::prior::Focus;
use crate::reference::{ReferenceRecord, ReferenceSet};

/// Random features beside the linear ones.
const RANDOM_FEATURES: usize = 512;
/// (-) Penalty of the regression on classes, by which the linear features were best on other simulations.
const PENALTY: f64 = 100.0;
/// (-) Probability before anything is seen that nothing is damaged; the kinds of damage share the rest evenly.
const PRIOR_HEALTHY: f64 = 0.5;
/// Fewest records that can be learnt from.
const FEWEST_RECORDS: usize = 200;

/// A class: what is damaged; none where nothing is.
pub(crate) type Class = Option<(usize, usize)>;

/// A model that is learnt from a reference set for one question.
pub struct Learned<'a> {
    pub(crate) reference: &'a ReferenceSet,
    pub(crate) kinds: Vec<DamageKind>,
    pub(crate) layout: Layout,
    /// The records that it was learnt from.
    pub(crate) records: Vec<&'a ReferenceRecord>,
    /// (rev) Where the bursts of their wheels are.
    pub(crate) bursts_rev: Vec<Vec<f64>>,
    pub(crate) classes: Vec<Class>,
    pub(crate) class_of: Vec<usize>,
    random: RandomFeatures,
    features: DMatrix<f64>,
    coefficients: DMatrix<f64>,
    softmax: Softmax,
    size_models: Vec<OnceLock<SizeModels>>,
    pub(crate) outside: OutlierTest,
    /// The healthy records that the others are compared with, as they are.
    pub(crate) healthy_outside: Option<OutlierTest>,
    pub(crate) common_changes: CommonChanges,
}

/// What is seen in the recordings of a question.
pub(crate) struct Seen {
    pub row: FeatureRow,
    /// Its features as regressions use them.
    pub features: Vec<f64>,
    /// (-) Probability of each class.
    pub of_class: Vec<f64>,
    /// (-) Probability of damage to each wheel.
    pub of_wheels: Vec<f64>,
}

/// Severity and sizes of a class's damages, by their places among the sizes; none of the severity.
pub(crate) type SizeModels = Result<Vec<(Option<usize>, SizeModel)>, DiagnoseError>;

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
        let (rows, healthy) = layout.simulations(reference, &records);
        let mut classes: Vec<Class> = records.iter().map(|record| class_of(record)).collect();
        classes.sort_unstable();
        classes.dedup();
        let place = |record: &&ReferenceRecord| classes.iter().position(|class| *class == class_of(record));
        let class_of: Vec<usize> = records.iter().filter_map(place).collect();
        let folds: Vec<usize> = records.iter().map(|record| fold_of(record.unit())).collect();
        let weights = weights(&class_of, &classes);
        let alike: Vec<_> = rows.iter().filter_map(|row| row.alike.as_ref()).collect();
        let common_changes = CommonChanges::new(&alike);
        let (values, bursts_rev): (Vec<Vec<f64>>, _) =
            rows.into_iter().map(|row| (row.values, row.burst_rev)).unzip();
        let random = RandomFeatures::new(&values, RANDOM_FEATURES, reference.prior.seed);
        let features = random.of(&values);
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
        let healthy_outside = layout.has_healthy.then(|| {
            let rows: Vec<Vec<f64>> = healthy.values().map(|state| layout.row(state, None).values).collect();
            OutlierTest::new(&rows, healthy.keys().copied().collect(), vec![true; rows.len()])
        });
        let size_models = classes.iter().map(|_| OnceLock::new()).collect();
        Ok(Self {
            reference,
            kinds,
            layout,
            records,
            bursts_rev,
            classes,
            class_of,
            random,
            features,
            coefficients: regression.coefficients,
            softmax,
            size_models,
            outside,
            healthy_outside,
            common_changes,
        })
    }

    /// What is seen in the recordings of a question.
    pub(crate) fn seen(&self, question: &Question) -> Seen {
        let row = self.layout.question(question);
        let features: Vec<f64> = self.random.of(std::slice::from_ref(&row.values)).iter().copied().collect();
        let columns = self.coefficients.column_iter();
        let scores = columns.map(|column| column.iter().zip(&features).map(|(a, b)| a * b).sum());
        let of_class = self.softmax.probabilities(&scores.collect::<Vec<f64>>());
        let of_wheel = |wheel: usize| {
            let classes = self.classes.iter().zip(&of_class);
            let of_wheel = classes.filter(|(class, _)| class.is_some_and(|(_, of)| of == wheel));
            of_wheel.map(|(_, probability)| probability).sum()
        };
        let of_wheels = (0..self.reference.prior.train.wheels.len()).map(of_wheel).collect();
        Seen { row, features, of_class, of_wheels }
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
        let mut rows = self.rows_of(class);
        rows.retain(|row| self.records[*row].fault.as_ref().is_some_and(is_within));
        let mut records: Vec<&ReferenceRecord> = rows.iter().map(|&row| self.records[row]).collect();
        let mut features = self.features.select_columns(&rows);
        if let Some(refined) = refined {
            let more = self.comparable(refined);
            if more.len() < refined.records.len() / 2 {
                return Err(DiagnoseError::NoReference);
            }
            let (rows, _) = self.layout.simulations(refined, &more);
            let values: Vec<Vec<f64>> = rows.into_iter().map(|row| row.values).collect();
            let known = features.ncols();
            features = features.resize_horizontally(known + more.len(), 0.0);
            features.columns_mut(known, more.len()).copy_from(&self.random.of(&values));
            records.extend(more);
        }
        let faults: Vec<&DrawnFault> = records.iter().filter_map(|record| record.fault.as_ref()).collect();
        let folds: Vec<usize> = records.iter().map(|record| fold_of(record.unit())).collect();
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

    /// The damaged records of a refined round that can be compared with the question.
    fn comparable<'r>(&self, refined: &'r ReferenceSet) -> Vec<&'r ReferenceRecord> {
        let is_whole = |record: &ReferenceRecord| {
            record.wheels.iter().zip(&self.layout.last).all(|(wheel, last)| wheel.last() >= *last)
        };
        let is_compared = |record: &&ReferenceRecord| {
            let has_healthy = || refined.healthy_of(record).is_some_and(is_whole);
            record.fault.is_some() && is_whole(record) && (!self.layout.has_healthy || has_healthy())
        };
        refined.records.iter().filter(is_compared).collect()
    }
}

fn class_of(record: &ReferenceRecord) -> Class {
    record.fault.as_ref().map(|fault| (fault.kind, fault.wheel))
}

/// Weights by which half of all records are healthy, and each kind of damage on each wheel is as likely as the next.
fn weights(class_of: &[usize], classes: &[Class]) -> Vec<f64> {
    let damaged = classes.iter().filter(|class| class.is_some()).count().max(1) as f64;
    let weight = |(place, class): (usize, &Class)| {
        let share = if class.is_some() { (1.0 - PRIOR_HEALTHY) / damaged } else { PRIOR_HEALTHY };
        share * class_of.len() as f64 / class_of.iter().filter(|of| **of == place).count() as f64
    };
    let weights: Vec<f64> = classes.iter().enumerate().map(weight).collect();
    class_of.iter().map(|&class| weights[class]).collect()
}
