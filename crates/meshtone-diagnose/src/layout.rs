//! Features of recordings and of simulations that can be compared with them.

use std::collections::BTreeMap;

use meshtone::random::{Draws, Purpose};
use meshtone::signal::TrainWheel;
use meshtone_learn::{WheelFeatures, WheelLines, beyond_healthy, median, wheel_features};
use rayon::prelude::*;

use crate::DiagnoseError;
use crate::answer::wheel_in_words;
use crate::mounting::Alike;
use crate::observation::{Observation, Question, SignalKind};
use crate::reference::{ReferenceRecord, ReferenceSet};

/// (-) Noise in an average of unknown noise, as a part of its difference signal's rms: least and largest.
const UNKNOWN_NOISE: [f64; 2] = [0.003, 0.2];
/// (log10) Change of a wheel over its healthy level, below which it has not changed: two simulations of one load are equal but for their damage,
/// as no recordings are.
const LEAST_CHANGE: f64 = -1.5;
/// Fewest mesh orders that a signal must show.
const FEWEST_MESH_ORDERS: usize = 2;

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

/// A rig in one state.
pub(crate) struct State {
    /// The wheels that are seen, with their features.
    wheels: Vec<Option<(WheelLines, WheelFeatures)>>,
    /// (-) Logarithm of the speed over the rig's; 0 where it is not known.
    speed: f64,
}

/// Features of one record.
#[derive(Debug, Clone)]
pub(crate) struct FeatureRow {
    pub values: Vec<f64>,
    /// (rev) Where the burst of each wheel is.
    pub burst_rev: Vec<f64>,
    /// What changed alike in all wheels since the healthy state; none without one, or of a single wheel.
    pub alike: Option<Alike>,
}

impl Layout {
    /// What is compared for a question.
    ///
    /// Recordings that cannot be compared, of other wheels, values that are not finite, or a signal of another kind, are refused here,
    /// before any simulation is looked at. The orders reach as far as the shortest of all averages, since features over other orders would
    /// differ without any damage.
    pub(crate) fn of(question: &Question, reference: &ReferenceSet) -> Result<Self, DiagnoseError> {
        let unfit = |problem: String| Err(DiagnoseError::Unfit(problem));
        let Some(first) = question.now.first() else {
            return unfit("there is no recording to ask about".to_owned());
        };
        let rig = &reference.prior.train.wheels;
        let expected: Vec<String> = rig.iter().map(|wheel| wheel.teeth.to_string()).collect();
        for asked in question.all() {
            // A wheel that is not seen may be the expected one.
            let teeth = |(place, seen): (usize, &Option<WheelLines>)| match seen {
                Some(wheel) => wheel.teeth().to_string(),
                None => expected.get(place).cloned().unwrap_or_default(),
            };
            let given: Vec<String> = asked.wheels.iter().enumerate().map(teeth).collect();
            if given != expected {
                let (given, expected) = (given.join(", "), expected.join(", "));
                return unfit(format!(
                    "the recording is of wheels with {given} teeth, the scenario has {expected}, in its order"
                ));
            }
            if let Some(hz) = asked.input_speed_hz.filter(|hz| !hz.is_finite() || *hz <= 0.0) {
                return unfit(format!("a recording's speed (Hz) is {hz}; must be finite and more than 0"));
            }
            let lines = asked.wheels.iter().flatten().flat_map(|wheel| &wheel.lines);
            if let Some(value) = lines.map(|line| line.norm()).find(|norm| !norm.is_finite()) {
                return unfit(format!("a recording's average is {value}; must be finite"));
            }
            if asked.signal != first.signal {
                return unfit(format!(
                    "one recording is given as `{}`, another as `{}` (whole recording, average or difference signal); all must be the same",
                    asked.signal.name(),
                    first.signal.name()
                ));
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
        let seen = rig.iter().zip(&last).zip(&first.wheels).filter(|(_, seen)| seen.is_some());
        for ((wheel, last), _) in seen {
            let needed = FEWEST_MESH_ORDERS * wheel.teeth as usize + wheel.teeth as usize / 2;
            if *last < needed {
                return Err(DiagnoseError::TooFewOrders(format!(
                    "the {}, or the simulations, show orders up to {last} of the {}'s shaft; at least {FEWEST_MESH_ORDERS} mesh orders, {needed}, are needed",
                    first.signal.name(),
                    wheel_in_words(&wheel.name)
                )));
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

    /// Finds the features of simulations that can be compared with the question, in their order, and by their units the healthy ones that they are compared with,
    /// if any.
    pub(crate) fn simulations(
        &self,
        reference: &ReferenceSet,
        records: &[&ReferenceRecord],
    ) -> (Vec<FeatureRow>, BTreeMap<u64, State>) {
        let seed = reference.prior.seed;
        let [of_now, of_healthy] = &self.noises;
        let mut healthy: Vec<&ReferenceRecord> = records
            .iter()
            .filter(|_| self.has_healthy)
            .filter_map(|record| reference.healthy_of(record))
            .collect();
        healthy.dedup_by_key(|record| record.number);
        let of_unit = |record: &&ReferenceRecord| (record.unit(), self.simulated(record, of_healthy, seed));
        let healthy: BTreeMap<u64, State> = healthy.par_iter().map(of_unit).collect();
        let row = |record: &&ReferenceRecord| {
            self.row(&self.simulated(record, of_now, seed), healthy.get(&record.unit()))
        };
        (records.par_iter().map(row).collect(), healthy)
    }

    /// A simulation as it would be in a recording with such noise.
    fn simulated(&self, record: &ReferenceRecord, noise: &[Vec<f64>], seed: u64) -> State {
        let mut draws = Draws::new(seed, Purpose::DiagnosisNoise, record.number);
        let [least, largest] = UNKNOWN_NOISE;
        let part = least * (largest / least).powf(draws.uniform(0.5, 0.5));
        let wheels = record.wheels.iter().enumerate().map(|(wheel, lines)| {
            let known = noise.get(wheel).map_or(&[][..], Vec::as_slice);
            let noisy = lines.with_noise(self.last[wheel], known, part, &mut draws);
            // A single revolution is of the gear, a pair's last wheel.
            let is_seen = self.signal == SignalKind::Recording || wheel + 1 == record.wheels.len();
            is_seen.then_some(noisy)
        });
        self.state(wheels.collect(), Some(record.input_speed_hz).filter(|_| self.knows_speed))
    }

    fn state(&self, wheels: Vec<Option<WheelLines>>, speed_hz: Option<f64>) -> State {
        let wheel = |(lines, last): (Option<WheelLines>, &usize)| {
            let lines = lines?;
            let features = wheel_features(&lines, *last, self.signal.has_regular_part());
            Some((lines, features))
        };
        State {
            wheels: wheels.into_iter().zip(&self.last).map(wheel).collect(),
            speed: speed_hz.map_or(0.0, |hz| (hz / self.nominal_hz).ln()),
        }
    }

    /// Features of a state beside a healthy one, or alone.
    ///
    /// Beside a healthy one only changes count: levels and shapes themselves are the rig's and its path's, which no prior contains. Simulations are told apart as well
    /// without them.
    pub(crate) fn row(&self, now: &State, healthy: Option<&State>) -> FeatureRow {
        let mut row =
            FeatureRow { values: vec![now.speed], burst_rev: vec![0.0; now.wheels.len()], alike: None };
        let mut bands = Vec::new();
        for (wheel, now) in now.wheels.iter().enumerate() {
            let Some((lines, plain)) = now else { continue };
            let Some((healthy, before)) = healthy.and_then(|healthy| healthy.wheels[wheel].as_ref()) else {
                row.burst_rev[wheel] = plain.burst_rev;
                row.values.extend(plain.levels.iter().chain(&plain.shapes));
                continue;
            };
            let last = self.last[wheel];
            let beyond = wheel_features(&beyond_healthy(lines, healthy, last), last, false);
            row.burst_rev[wheel] = beyond.burst_rev;
            let louder = less(&plain.levels, &before.levels);
            bands.push((self.mesh_orders[wheel], louder[plain.bands()].to_vec()));
            // A level that is wrong as a whole is wrong in all orders, damage in some.
            row.values.push(median(&louder));
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
    pub(crate) fn question(&self, question: &Question) -> FeatureRow {
        let states = |recordings: &[Observation]| -> Vec<State> {
            recordings.iter().map(|asked| self.state(asked.wheels.clone(), asked.input_speed_hz)).collect()
        };
        let healthy = states(question.healthy);
        let beside = |now: &State| -> Vec<FeatureRow> {
            match healthy.is_empty() {
                true => vec![self.row(now, None)],
                false => healthy.iter().map(|healthy| self.row(now, Some(healthy))).collect(),
            }
        };
        let rows: Vec<FeatureRow> = states(question.now).iter().flat_map(beside).collect();
        let alike: Option<Vec<&[f64]>> =
            rows.iter().map(|row| Some(row.alike.as_ref()?.0.as_slice())).collect();
        FeatureRow {
            values: mean(&rows.iter().map(|row| row.values.as_slice()).collect::<Vec<_>>()),
            burst_rev: rows[0].burst_rev.clone(),
            alike: alike.map(|alike| Alike(mean(&alike))),
        }
    }
}

/// The mean of rows of as many values.
fn mean(rows: &[&[f64]]) -> Vec<f64> {
    let of = |at: usize| rows.iter().map(|row| row[at]).sum::<f64>() / rows.len() as f64;
    (0..rows[0].len()).map(of).collect()
}

fn less(now: &[f64], before: &[f64]) -> Vec<f64> {
    now.iter().zip(before).map(|(now, before)| now - before).collect()
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
