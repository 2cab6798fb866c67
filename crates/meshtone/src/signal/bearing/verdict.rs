//! Whether a recording shows a defect of a bearing: the lines of a race together, against the same lines at orders of no bearing.

use std::collections::BTreeSet;

use super::TrainBearing;
use super::bands::{BandSpectra, band_spectra};
use super::comb::{Comb, Readable, Scores};
use super::lines::{DefectKind, SLIP};
use super::recording::{FEWEST_CYCLES, LEAST_WIDTH};
use crate::signal::{FrequencyBand, ShaftPhase, SignalError, SynchronousResidual, TrainRecording};

/// (rev) Fewest turns of a shaft: slip would move a race's line over those beside it.
const FEWEST_TURNS: f64 = 14.0;
/// Fewest windows at orders of no bearing from which a false alarm's probability is estimated.
const FEWEST_WINDOWS: usize = 20;
/// (-) Exponent of what the tail of the windows' scores says, as counted with recordings of nothing: `cargo xtask measure`.
const CALIBRATION: f64 = 0.6;
/// (-) A comb at half or a third of the strongest one's order with so much of its score is the one that is meant.
const ALIKE: f64 = 0.7;

/// Races in which a defect is looked for.
const RACES: [DefectKind; 3] = [DefectKind::OuterRace, DefectKind::InnerRace, DefectKind::Element];

/// What a recording says about one race of a bearing.
#[derive(Debug, Clone, PartialEq)]
pub struct RaceTest {
    /// The race.
    pub race: DefectKind,
    /// The bearings that it may be of, by their places: several where their orders differ by less than slip does.
    pub bearings: Vec<usize>,
    /// (orders of the bearing's shaft) Its first line without slip.
    pub order: f64,
    /// (orders of the bearing's shaft) Its first line where its lines are strongest together, within 3 % of that.
    pub found_order: f64,
    /// The band in which they are strongest.
    pub band: FrequencyBand,
    /// (-) Amplitude of the first line over the mean of the squared envelope in that band. It may be compared with that of an earlier recording, and is no severity.
    pub depth: f64,
    /// (-) Probability that some race of some bearing looks like this where there is no defect, at most 1: the search over races, slip and bands is in it. Below
    /// 0.01 it is not known how far below.
    pub false_alarm_probability: f64,
}

impl RaceTest {
    /// (-) Probability of a false alarm below which a race is named.
    pub const DETECTED: f64 = 0.01;
    /// (-) Probability below which there is a trace: neither nothing nor a defect.
    pub const TRACE: f64 = 0.05;

    /// Returns whether its lines are there.
    pub fn is_detected(&self) -> bool {
        self.false_alarm_probability < Self::DETECTED
    }

    /// (-) The probability of a false alarm as far as it is known: at least 0.01.
    pub fn stated_probability(&self) -> f64 {
        self.false_alarm_probability.max(Self::DETECTED)
    }

    /// (-) Slip: how far its lines are from where they would be without, as a part.
    pub fn slip(&self) -> f64 {
        self.found_order / self.order - 1.0
    }
}

/// Why a recording does not tell whether a bearing has a defect.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum CannotTell {
    /// The shaft turns too few times: (rev) how many, and how many are needed.
    FewTurns {
        /// (rev) Turns of the shaft.
        turns: f64,
        /// (rev) Fewest.
        needed: f64,
    },
    /// The recording has too few cycles, after which the same teeth meet again, for their average to be removed: gears have lines where bearings have theirs.
    FewCycles {
        /// Cycles in the recording.
        cycles: f64,
        /// Fewest.
        needed: f64,
    },
    /// Lines of some race cannot be separated from the orders of shafts or of a race that is named, or lie beyond the recording's frequencies.
    Unresolved,
    /// The lines of a race stand out, but chance may do as much.
    Trace(DefectKind),
    /// Lines stand out that are of no stated race: [`BearingDefects::unexplained`].
    DoesNotFit,
}

/// What a recording says about a bearing.
#[derive(Debug, Clone, PartialEq)]
pub enum BearingVerdict {
    /// Parts with a defect, in the order in which they were found.
    Defect(Vec<DefectKind>),
    /// There are no lines of a defect.
    Nothing,
    /// The recording does not tell.
    CannotTell(CannotTell),
}

/// The strongest comb of lines that no shaft and no stated race explains.
#[derive(Debug, Clone, PartialEq)]
pub struct UnexplainedComb {
    /// Number of the shaft of whose orders it is.
    pub shaft: usize,
    /// (orders of that shaft) Its first line.
    pub order: f64,
    /// The band in which it is strongest.
    pub band: FrequencyBand,
    /// (-) Probability that chance makes a comb as strong at any order, at most 1.
    pub false_alarm_probability: f64,
    /// For each race of a bearing on that shaft, and the place of its bearing, its order over the race's: so many times as fast the shaft would have to turn, so
    /// many times as large the race's order would have to be, or the sampling rate by the inverse, to explain it.
    pub ratios: Vec<(DefectKind, usize, f64)>,
}

/// What a recording shows about defects of bearings.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct BearingDefects {
    /// The races that were looked at: those that are named in the order in which they were found, then the others, the strongest first.
    pub races: Vec<RaceTest>,
    /// Bearings, by their places, about some race of which the recording says nothing, and why.
    pub untold: Vec<(usize, CannotTell)>,
    /// A comb that is there and is no stated race's, where none is named: a speed, a rate or a geometry does not fit, or another machine is heard.
    pub unexplained: Option<UnexplainedComb>,
}

impl BearingDefects {
    /// What the recording says about a bearing.
    ///
    /// # Arguments
    /// * `bearing` - its place
    pub fn verdict(&self, bearing: usize) -> BearingVerdict {
        let of_bearing = || self.races.iter().filter(|of| of.bearings.contains(&bearing));
        let named: Vec<DefectKind> = of_bearing().filter(|of| of.is_detected()).map(|of| of.race).collect();
        let trace = of_bearing().find(|of| of.false_alarm_probability < RaceTest::TRACE);
        let untold = self.untold.iter().find(|(place, _)| *place == bearing);
        let is_of_shaft = |comb: &&UnexplainedComb| comb.ratios.iter().any(|(_, place, _)| *place == bearing);
        let misfit = self.unexplained.as_ref().filter(is_of_shaft).map(|_| CannotTell::DoesNotFit);
        let doubt = misfit.or(trace.map(|of| CannotTell::Trace(of.race))).or(untold.map(|(_, why)| *why));
        match doubt {
            _ if !named.is_empty() => BearingVerdict::Defect(named),
            Some(why) => BearingVerdict::CannotTell(why),
            None => BearingVerdict::Nothing,
        }
    }
}

impl TrainRecording<'_> {
    /// Judges bearings: which race of which has a defect, if any.
    ///
    /// The average over the cycle after which the same teeth meet again is removed, since gears have lines at the orders of bearings. Of what is left the squared
    /// envelope in bands of five widths is observed over the angle; a race's lines together are scored in the bands in which they are strongest, within the slip
    /// of elements; and the same comb at orders of no bearing says what chance makes of that search. The answer holds for bearings at whose seat the
    /// sensor is: on the way from another seat a defect's lines change.
    ///
    /// # Arguments
    /// * `bearings` - the bearings, any number
    ///
    /// # Errors
    /// NaN; a constant signal; a bearing on a shaft that the train does not have; a phase that is not the recording's.
    ///
    /// ```
    /// use meshtone::bearing::NamedBearing;
    /// use meshtone::random::{Draws, Purpose};
    /// use meshtone::signal::{
    ///     BearingVerdict, DefectKind, GearTrain, ShaftPhase, StatedTurning, TrainBearing, TrainRecording, TrainTurning,
    /// };
    ///
    /// // A resonance at 4 kHz that rings whenever a ball passes a place of the outer race, in noise.
    /// let geometry = NamedBearing::find("6205").ok_or("no such bearing")?.geometry;
    /// let phase = ShaftPhase::constant(30.0, 20_000.0, 60_000)?;
    /// let mut noise = Draws::new(1, Purpose::RecordNoise, 0);
    /// let mut ringing = |angle: f64| {
    ///     let since_s = (angle * 3.585).fract() / (30.0 * 3.585);
    ///     (-800.0 * since_s).exp() * (std::f64::consts::TAU * 4000.0 * since_s).sin() + noise.normal()
    /// };
    /// let signal: Vec<f64> = phase.revolutions.iter().map(|angle| ringing(*angle)).collect();
    /// let train = GearTrain::of_shaft("motor");
    /// let turning = TrainTurning::Shaft { shaft: 0, phase, stated: StatedTurning::Other };
    /// let recording = TrainRecording { signal: &signal, sampling_rate_hz: 20_000.0, train: &train, turning: &turning };
    /// let found = recording.bearing_defects(&[TrainBearing { geometry, shaft: 0 }])?;
    /// assert_eq!(found.verdict(0), BearingVerdict::Defect(vec![DefectKind::OuterRace]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn bearing_defects(&self, bearings: &[TrainBearing]) -> Result<BearingDefects, SignalError> {
        let phases = self.phases_of(bearings)?;
        if bearings.is_empty() {
            return Ok(BearingDefects::default());
        }
        self.defects_without(self.without_cycle(&phases)?.as_ref(), &phases, bearings)
    }

    /// Judges bearings by what is left of the recording.
    ///
    /// # Arguments
    /// * `left` - the recording without its cycles, or how many of these it has, where they are too few
    /// * `phases` - of all shafts
    /// * `bearings` - the bearings
    pub(super) fn defects_without(
        &self,
        left: Result<&SynchronousResidual, &f64>,
        phases: &[ShaftPhase],
        bearings: &[TrainBearing],
    ) -> Result<BearingDefects, SignalError> {
        let mut found = BearingDefects::default();
        let separated = match left {
            Ok(separated) => separated,
            Err(&cycles) => {
                let why = CannotTell::FewCycles { cycles, needed: FEWEST_CYCLES };
                found.untold = (0..bearings.len()).map(|place| (place, why)).collect();
                return Ok(found);
            }
        };
        let shafts: BTreeSet<usize> = bearings.iter().map(|of| of.shaft).collect();
        let samples = separated.first_sample..separated.first_sample + separated.values.len();
        let (shafts, phases): (Vec<usize>, Vec<ShaftPhase>) = shafts
            .into_iter()
            .filter_map(|shaft| Some((shaft, phases[shaft].part(samples.clone()).ok()?)))
            .filter(|(_, phase)| phase.span_rev() >= FEWEST_TURNS)
            .unzip();
        let mut combs: Vec<Comb> = Vec::new();
        let mut least_width_hz = 0.0_f64;
        for (place, of) in bearings.iter().enumerate() {
            let Some(shaft) = shafts.iter().position(|shaft| *shaft == of.shaft) else {
                let turns = self.phase(of.shaft)?.span_rev();
                found.untold.push((place, CannotTell::FewTurns { turns, needed: FEWEST_TURNS }));
                continue;
            };
            let orders = of.geometry.defect_orders();
            let speed_hz = phases[shaft].mean_speed_hz(self.sampling_rate_hz);
            least_width_hz = least_width_hz.max(LEAST_WIDTH * orders.inner_race * speed_hz);
            for race in RACES {
                let comb = Comb::new(race, &orders, place, shaft);
                match combs.iter_mut().find(|known| known.is_like(&comb)) {
                    Some(known) => known.bearings.push(place),
                    None => combs.push(comb),
                }
            }
        }
        let spectra = band_spectra(&separated.values, self.sampling_rate_hz, &phases, least_width_hz)?;
        let speeds = |of: usize| -> Vec<f64> {
            (0..self.train.shafts.len())
                .map(|shaft| self.train.speed_ratio(shaft, shafts[of]).value())
                .collect()
        };
        judge(&spectra, combs, speeds, &mut found);
        if let Some(unexplained) = &mut found.unexplained {
            unexplained.shaft = shafts[unexplained.shaft];
        }
        Ok(found)
    }
}

/// A comb where it was found.
struct Found {
    comb: Comb,
    probability: f64,
}

/// Tests each race, that which chance explains least first, and the others without the lines of those that are named; where none is, the strongest comb of no race.
///
/// # Arguments
/// * `spectra` - of each shaft that has bearings
/// * `combs` - the races
/// * `speeds` - (orders of a shaft) speeds of all shafts
/// * `found` - takes up what is said
fn judge(
    spectra: &[BandSpectra],
    mut combs: Vec<Comb>,
    speeds: impl Fn(usize) -> Vec<f64>,
    found: &mut BearingDefects,
) {
    let all = combs.clone();
    let mut left: Vec<Readable> =
        spectra.iter().enumerate().map(|(shaft, of)| Readable::new(of, &speeds(shaft))).collect();
    let named = loop {
        let mut tested: Vec<(Found, RaceTest)> = Vec::new();
        for comb in &combs {
            let readable = &left[comb.shaft];
            let Some(found) = test(readable, comb, &all) else { continue };
            let false_alarm_probability = calibrated(all.len() as f64 * found.probability);
            let band = readable.strongest_band(&found.comb);
            let test = RaceTest {
                race: comb.race,
                bearings: comb.bearings.clone(),
                order: comb.order,
                found_order: found.comb.order,
                band: readable.spectra.bands[band],
                depth: readable.spectra.depth(found.comb.order, band),
                false_alarm_probability,
            };
            tested.push((found, test));
        }
        tested.sort_by(|a, b| a.0.probability.total_cmp(&b.0.probability));
        let is_named = tested.first().is_some_and(|(_, test)| test.is_detected());
        if !is_named {
            let is_tested = |comb: &Comb| {
                tested.iter().any(|(_, of)| (of.race, &of.bearings) == (comb.race, &comb.bearings))
            };
            let unread: BTreeSet<usize> =
                combs.iter().filter(|comb| !is_tested(comb)).flat_map(|comb| comb.bearings.clone()).collect();
            found.untold.extend(unread.into_iter().map(|place| (place, CannotTell::Unresolved)));
            let named = !found.races.is_empty();
            found.races.extend(tested.into_iter().map(|(_, test)| test));
            break named;
        }
        let (strongest, test) = tested.swap_remove(0);
        left[strongest.comb.shaft] = left[strongest.comb.shaft].without(&strongest.comb);
        combs.retain(|comb| (comb.race, &comb.bearings) != (test.race, &test.bearings));
        found.races.push(test);
    };
    if !named {
        found.unexplained = (0..left.len())
            .filter_map(|shaft| unexplained(&left[shaft], shaft, &all))
            .min_by(|a, b| a.false_alarm_probability.total_cmp(&b.false_alarm_probability))
            .filter(|of| of.false_alarm_probability < RaceTest::DETECTED);
    }
}

/// The probability of a false alarm as it is counted, from the one that the tail of scores says.
fn calibrated(probability: f64) -> f64 {
    probability.min(1.0).powf(CALIBRATION)
}

/// Where a race is strongest, and the probability that chance makes its comb as strong: an exponential tail above the median of the scores in windows of the same
/// room for slip at orders of no race, without its own lines. None where they cannot be read, or there are too few windows.
fn test(left: &Readable, comb: &Comb, all: &[Comb]) -> Option<Found> {
    if !left.reads(comb, comb.order) {
        return None;
    }
    let (order, score) = left.scores(comb).best_near(comb.order)?;
    let comb = comb.at(order);
    let scores = left.without(&comb).scores(&comb);
    let windows = chance(left, &comb, all, &scores);
    Some(Found { probability: beyond(score, windows)?, comb })
}

/// Scores in the windows that can be read and are of no race.
fn chance(left: &Readable, comb: &Comb, all: &[Comb], scores: &Scores) -> Vec<f64> {
    let of_shaft = || all.iter().filter(|of| of.shaft == comb.shaft).map(|of| of.order).chain([comb.order]);
    Scores::windows()
        .filter(|middle| of_shaft().all(|order| (middle / order - 1.0).abs() > 2.0 * SLIP))
        .filter(|middle| left.reads(comb, *middle))
        .filter_map(|middle| Some(scores.best_near(middle)?.1))
        .collect()
}

/// The probability that chance exceeds a score, from scores that are chance's.
fn beyond(score: f64, mut windows: Vec<f64>) -> Option<f64> {
    if windows.len() < FEWEST_WINDOWS {
        return None;
    }
    windows.sort_unstable_by(f64::total_cmp);
    let (middle, upper) = (windows[windows.len() / 2], &windows[windows.len() / 2..]);
    let excess = upper.iter().map(|score| score - middle).sum::<f64>() / (upper.len() - 1) as f64;
    Some((0.5 * (-(score - middle) / excess.max(f64::MIN_POSITIVE)).exp()).min(1.0))
}

/// The strongest comb of a shaft at orders of no race.
fn unexplained(left: &Readable, shaft: usize, all: &[Comb]) -> Option<UnexplainedComb> {
    let of_shaft: Vec<&Comb> = all.iter().filter(|of| of.shaft == shaft).collect();
    // As of an outer race, without sidebands, and as of an inner race.
    let kinds = RACES.iter().filter(|race| **race != DefectKind::Element);
    let strongest = |race: &DefectKind| {
        let comb = of_shaft.iter().find(|comb| comb.race == *race)?;
        let scores = left.scores(comb);
        let windows: Vec<f64> = Scores::windows()
            .filter(|middle| of_shaft.iter().all(|of| (middle / of.order - 1.0).abs() > SLIP))
            .filter(|middle| left.reads(comb, *middle))
            .collect();
        let best = windows.iter().filter_map(|middle| scores.best_near(*middle));
        let largest = best.max_by(|a, b| a.1.total_cmp(&b.1))?;
        // Every other, or third, line of a comb is a comb, too.
        let mut lower = [3.0, 2.0].into_iter().filter_map(|times| scores.best_near(largest.0 / times));
        let (order, score) = lower.find(|of| of.1 >= ALIKE * largest.1).unwrap_or(largest);
        let comb = comb.at(order);
        let chance = chance(left, &comb, all, &left.without(&comb).scores(&comb));
        let probability = beyond(score, chance)? * 2.0 * windows.len() as f64;
        Some((probability, comb))
    };
    let (probability, comb) = kinds.filter_map(strongest).min_by(|a, b| a.0.total_cmp(&b.0))?;
    let ratio = |of: &&Comb| {
        of.bearings.iter().map(|place| (of.race, *place, comb.order / of.order)).collect::<Vec<_>>()
    };
    Some(UnexplainedComb {
        shaft,
        order: comb.order,
        band: left.spectra.bands[left.strongest_band(&comb)],
        false_alarm_probability: calibrated(probability),
        ratios: of_shaft.iter().flat_map(ratio).collect(),
    })
}
