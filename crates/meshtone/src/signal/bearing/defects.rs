//! Whether a recording shows a defect of a bearing: the lines of a race together, against the same lines at orders of no bearing.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use super::lines::{DefectKind, SLIP};
use super::{BearingSettings, TrainBearing};
use crate::signal::{FrequencyBand, SignalError, SignalWarning, SquaredEnvelopeSpectrum, TrainRecording};

/// Harmonics of a race that are looked at together.
const HARMONICS: u32 = 3;
/// Harmonics and sidebands of a defect that was found, in which no other is looked for.
const EXPLAINED: (i32, i32) = (12, 4);
/// (lines) A line of a spectrum with a Hann window, and a shaft's whole order, reach so far on either side.
const WIDTH: f64 = 2.5;
/// (-) Random slip widens a line by so much of its order on either side.
const WIDENED: f64 = 0.005;
/// (lines) Shafts whose whole orders are closer leave nothing between them.
const CLOSEST: f64 = 4.0 * WIDTH;
/// (-) Largest ratio of a decoy's order to that of the race, and the inverse of the smallest.
const FARTHEST: f64 = 2.0;
/// Fewest decoys from which a false alarm's probability is estimated.
const FEWEST_DECOYS: usize = 20;
/// (lines) Half the least width in which the median of the lines is taken, and in orders of the first bearing's shaft.
const BESIDE: (f64, f64) = (24.0, 0.5);
/// Medians in half that width: from one to the next they hardly change, and one for each line would take long.
const MEDIANS: usize = 8;
/// (rev) Fewest turns of a cage.
const FEWEST_CAGE_TURNS: f64 = 12.0;
/// (-) Score of a line that cannot be read: about the mean of noise, ln(1 + the largest of three exponential numbers of mean 1).
const UNREAD: f64 = 1.0;
/// Euler's constant: (mean - mode) / scale of a Gumbel distribution.
const EULER: f64 = 0.577_215_664_901_532_9;

/// Races in which a defect is looked for.
const RACES: [DefectKind; 3] = [DefectKind::OuterRace, DefectKind::InnerRace, DefectKind::Element];

/// Whether one race of a bearing has a defect.
#[derive(Debug, Clone, PartialEq)]
pub struct RaceTest {
    /// The race.
    pub race: DefectKind,
    /// The bearings that it may be of, by their places: several where their orders differ by less than slip does.
    pub bearings: Vec<usize>,
    /// (orders of the first bearing's shaft) Its first line without slip.
    pub order: f64,
    /// (orders of the first bearing's shaft) Its first line where its lines are strongest together, within 1.5 % of that.
    pub found_order: f64,
    /// (-) Amplitude over the median beside it, geometric mean of three harmonics and their nearest sidebands, as far as they can be read.
    pub over_median: f64,
    /// (-) Probability that lines without those of any race look like this one, at most 1: times the number of races.
    pub false_alarm_probability: f64,
}

impl RaceTest {
    /// (-) Probability of a false alarm below which the lines of a race are said to be there.
    pub const DETECTED: f64 = 0.01;

    /// Returns whether the lines of a race are said to be there. Those of an inner race or an element are of a defect; elements that pass the outer race
    /// of a sound bearing under load excite its lines, too.
    pub fn is_detected(&self) -> bool {
        self.false_alarm_probability < Self::DETECTED
    }
}

/// What a recording shows about defects of bearings.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct BearingDefects {
    /// The races that were looked at: those with a defect in the order in which they were found, then the others, the strongest first.
    pub races: Vec<RaceTest>,
    /// Bearings, by their places, about which the recording says nothing, because their cages turn too few times: how many times, and how many are needed.
    pub too_short: Vec<(usize, f64, f64)>,
    /// Bearings whose lines lie beyond the frequencies of the recording, or cannot be separated from the orders of shafts.
    pub unresolved: Vec<usize>,
    /// Bearings with a race that is not tested because its lines lie within those of a race that was detected.
    pub hidden: Vec<usize>,
    /// The band of the squared envelope.
    pub band: Option<FrequencyBand>,
    /// Revolutions of the first bearing's shaft.
    pub revolutions: f64,
    /// What is doubtful about the recording.
    pub warnings: Vec<SignalWarning>,
}

impl BearingDefects {
    /// (-) The strength over the median that the lines of a race have in this recording, as it would be in one of another length: the median of
    /// noise falls with the root of the length, a line does not. None where they are not tested.
    ///
    /// # Arguments
    /// * `other` - a test of the same bearings in another recording
    /// * `revolutions` - of the first bearing's shaft in that recording
    pub fn over_median_of(&self, other: &RaceTest, revolutions: f64) -> Option<f64> {
        let same = self.races.iter().find(|of| (of.race, &of.bearings) == (other.race, &other.bearings))?;
        Some(same.over_median * (revolutions / self.revolutions).sqrt())
    }
}

/// A race with its lines, in orders of one shaft of the machine.
struct Comb {
    race: DefectKind,
    bearings: Vec<usize>,
    /// Order of the first bearing's shaft.
    shaft: f64,
    order: f64,
    /// Distance of the sidebands; none without sidebands.
    beside: Option<f64>,
}

impl Comb {
    /// The last order that is read, of the farthest decoy.
    fn last_order(&self) -> f64 {
        let farthest = FARTHEST * (1.0 + SLIP) * self.order;
        f64::from(HARMONICS + 1) * farthest + self.beside.unwrap_or_default()
    }

    /// Lines at harmonics and sidebands, where the race's order is `order`: the harmonic, the sideband, the order.
    fn lines(&self, order: f64, harmonics: i32, sidebands: i32) -> impl Iterator<Item = (i32, i32, f64)> {
        let (beside, sidebands) = self.beside.map_or((0.0, 0), |beside| (beside, sidebands));
        (1..=harmonics).flat_map(move |harmonic| {
            (-sidebands..=sidebands)
                .map(move |side| (harmonic, side, f64::from(harmonic) * order + f64::from(side) * beside))
        })
    }
}

/// Whether two orders are the same for all that slip allows.
fn is_near(one: f64, other: f64) -> bool {
    (one / other - 1.0).abs() <= 2.0 * SLIP
}

/// A spectrum by how far its lines stand out, without those that are explained.
#[derive(Clone)]
struct Standing {
    step: f64,
    /// Power over its median beside each line, of exponential noise with a mean of 1; NaN where the line is explained.
    powers: Vec<f64>,
}

impl Standing {
    fn new(spectrum: &SquaredEnvelopeSpectrum, last_order: f64) -> Self {
        let step = spectrum.step;
        let count = spectrum.amplitudes.len().min((last_order / step) as usize);
        let half = BESIDE.0.max(BESIDE.1 / step) as usize;
        let squares: Vec<f64> = spectrum.amplitudes.iter().map(|amplitude| amplitude * amplitude).collect();
        let stride = (half / MEDIANS).max(1);
        let median = |line: usize| {
            let mut beside =
                squares[line.saturating_sub(half).max(1)..(line + half + 1).min(squares.len())].to_vec();
            let middle = beside.len() / 2;
            beside.select_nth_unstable_by(middle, f64::total_cmp).1.max(f64::MIN_POSITIVE)
        };
        let medians: Vec<f64> = (1..count).step_by(stride).map(median).collect();
        let power = |line: usize| std::f64::consts::LN_2 * squares[line] / medians[(line - 1) / stride];
        let mut powers = vec![f64::NAN; 1];
        powers.extend((1..count).map(power));
        Self { step, powers }
    }

    fn explain(&mut self, order: f64, reach: f64) {
        let from = ((order - reach) / self.step).ceil().max(0.0) as usize;
        let end = (((order + reach) / self.step).floor() + 1.0).max(0.0) as usize;
        let end = end.min(self.powers.len());
        self.powers[from.min(end)..end].fill(f64::NAN);
    }

    /// Takes the whole orders of shafts away, as far as something is left between them.
    fn explain_shafts(&mut self, shafts: &[f64]) {
        let (step, reach) = (self.step, WIDTH * self.step);
        for shaft in shafts.iter().filter(|shaft| **shaft / step >= CLOSEST) {
            let last = (self.powers.len() as f64 * step / shaft) as usize;
            (1..=last).for_each(|whole| self.explain(whole as f64 * shaft, reach));
        }
    }

    /// Takes the lines of a defect away.
    fn explain_comb(&mut self, comb: &Comb, order: f64) {
        let (harmonics, sidebands) = EXPLAINED;
        for (harmonic, _, at) in comb.lines(order, harmonics, sidebands) {
            self.explain(at, WIDTH * self.step + WIDENED * f64::from(harmonic) * order);
        }
    }

    /// Power of the line at an order, or of one beside it; none where all are explained or beyond the spectrum.
    fn power(&self, order: f64) -> Option<f64> {
        let line = (order / self.step).round() as usize;
        let three = self.powers.get(line.saturating_sub(1)..line + 2)?;
        three.iter().copied().filter(|power| !power.is_nan()).reduce(f64::max)
    }

    /// The largest score of a race whose order is within slip of a place, and its order; none where fewer than half of its lines can be read.
    ///
    /// The score is the sum of ln(1 + power) over the harmonics and their nearest sidebands: a single strong line counts little.
    fn best(&self, comb: &Comb, place: f64) -> Option<(f64, f64)> {
        let step = 0.5 * self.step / f64::from(HARMONICS);
        let tried = (SLIP * place / step).ceil().max(1.0) as i32;
        let orders = (-tried..=tried).map(|at| place * (1.0 + SLIP * f64::from(at) / f64::from(tried)));
        let score = |order: f64| {
            let powers = comb.lines(order, HARMONICS as i32, 1).map(|(.., at)| self.power(at));
            let (mut score, mut read, mut all) = (0.0, 0, 0);
            for power in powers {
                all += 1;
                read += usize::from(power.is_some());
                score += power.map_or(UNREAD, f64::ln_1p);
            }
            (2 * read > all).then_some((score, order))
        };
        orders.filter_map(score).max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The order of a race at which its lines stand out most, and the probability that noise reaches as much.
    ///
    /// The decoys are the same comb at other orders, each with the same room for slip, in the spectrum without the race's own lines. A Gumbel distribution,
    /// which is that of maxima, has their mean and standard deviation.
    fn test(&self, comb: &Comb) -> Option<(f64, f64)> {
        let (score, order) = self.best(comb, comb.order)?;
        let mut without = self.clone();
        without.explain_comb(comb, order);
        let apart = ((1.0 + SLIP) / (1.0 - SLIP)).ln();
        let each_side = (FARTHEST.ln() / apart) as i32;
        let places = (-each_side..=each_side).filter(|at| at.abs() > 1);
        let decoys: Vec<f64> = places
            .filter_map(|at| Some(without.best(comb, comb.order * (f64::from(at) * apart).exp())?.0))
            .collect();
        if decoys.len() < FEWEST_DECOYS {
            return None;
        }
        let count = decoys.len() as f64;
        let mean = decoys.iter().sum::<f64>() / count;
        let variance = decoys.iter().map(|decoy| (decoy - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let scale = (6.0 * variance).sqrt() / PI;
        let beyond = (score - (mean - EULER * scale)) / scale.max(f64::MIN_POSITIVE);
        Some((order, -f64::exp_m1(-(-beyond).exp())))
    }

    /// Amplitude of a race's lines over the median, the geometric mean of those that can be read.
    fn over_median(&self, comb: &Comb, order: f64) -> f64 {
        let powers = comb.lines(order, HARMONICS as i32, 1).filter_map(|(.., at)| self.power(at));
        let logs: Vec<f64> = powers.map(|power| (power / std::f64::consts::LN_2).ln()).collect();
        (0.5 * logs.iter().sum::<f64>() / logs.len().max(1) as f64).exp()
    }

    /// Tests each race, that which noise explains least first, and the others without the lines of those that are detected. Returns the tests, the races of
    /// which too few lines can be read, and those of which they lie within the lines of a detected race.
    fn races(mut self, mut combs: Vec<Comb>) -> (Vec<RaceTest>, Vec<Comb>, Vec<Comb>) {
        let whole = self.clone();
        let (mut races, mut readable) = (Vec::new(), None);
        loop {
            let found = combs.iter().enumerate().filter_map(|(at, comb)| Some((at, comb, self.test(comb)?)));
            let found: Vec<_> = found.collect();
            let asked = *readable.get_or_insert(found.len()) as f64;
            let test = |(at, comb, (order, p)): (usize, &Comb, (f64, f64))| {
                let test = RaceTest {
                    race: comb.race,
                    bearings: comb.bearings.clone(),
                    order: comb.order / comb.shaft,
                    found_order: order / comb.shaft,
                    over_median: whole.over_median(comb, order),
                    false_alarm_probability: (asked * p).min(1.0),
                };
                (at, test)
            };
            let mut tested: Vec<(usize, RaceTest)> = found.into_iter().map(test).collect();
            tested.sort_by(|a, b| a.1.false_alarm_probability.total_cmp(&b.1.false_alarm_probability));
            match tested.first() {
                Some((at, strongest)) if strongest.is_detected() => {
                    let comb = combs.remove(*at);
                    self.explain_comb(&comb, strongest.found_order * comb.shaft);
                    races.push(strongest.clone());
                }
                _ => {
                    let is_tested = |at: usize| tested.iter().any(|(of, _)| *of == at);
                    let untested = combs.into_iter().enumerate().filter(|(at, _)| !is_tested(*at));
                    let (hidden, unread) =
                        untested.map(|(_, comb)| comb).partition(|comb| whole.test(comb).is_some());
                    races.extend(tested.into_iter().map(|(_, test)| test));
                    return (races, unread, hidden);
                }
            }
        }
    }
}

impl TrainRecording<'_> {
    /// Tests for a defect of each race of each bearing, in the spectrum of the squared envelope after the gears' averages are removed.
    ///
    /// A race's lines (three harmonics, of an inner race with the sidebands of its shaft, of an element with those of its cage) are looked at together, within 1.5 % of
    /// their place for slip, and compared with the same lines at orders from half to twice as high. Whole orders of all shafts are left out. The race that noise
    /// explains least is named first, and the others are tested without its lines, as long as one is detected.
    ///
    /// # Arguments
    /// * `bearings` - the bearings of the machine, all of them: they are distinguished from each other
    /// * `settings` - what is removed, and the band
    ///
    /// # Errors
    /// Those of [`Self::bearings`].
    pub fn bearing_defects(
        &self,
        bearings: &[TrainBearing],
        settings: &BearingSettings,
    ) -> Result<BearingDefects, SignalError> {
        let Some(first) = bearings.first() else { return Ok(BearingDefects::default()) };
        let records = self.bearings(bearings, settings)?;
        let ratio = |shaft: usize| self.train.speed_ratio(shaft, first.shaft).value();
        let spectrum = &records.bearings[0].0;
        let speed_hz = self.phase(first.shaft)?.mean_speed_hz(self.sampling_rate_hz);
        let width = (records.band.to_hz - records.band.from_hz) / speed_hz;
        let (combs, too_short) = combs(bearings, ratio, spectrum.step);
        let last_read = combs.iter().map(Comb::last_order).fold(0.0, f64::max);
        let mut standing = Standing::new(spectrum, width.min(last_read));
        let shafts: Vec<f64> = (0..self.train.shafts.len()).map(ratio).collect();
        standing.explain_shafts(&shafts);
        let revolutions = 1.0 / spectrum.step;
        let (races, unread, hidden) = standing.races(combs);
        let bearings = |combs: Vec<Comb>| {
            let bearings: BTreeSet<usize> = combs.into_iter().flat_map(|comb| comb.bearings).collect();
            bearings.into_iter().collect()
        };
        Ok(BearingDefects {
            races,
            too_short,
            unresolved: bearings(unread),
            hidden: bearings(hidden),
            band: Some(records.band),
            revolutions,
            warnings: records.warnings,
        })
    }
}

/// The races with their lines, in orders of one shaft, and the bearings whose cages turn too few times.
///
/// # Arguments
/// * `ratio` - speed of a shaft over that of the one shaft
/// * `step` - distance of the lines of the spectrum, one over the turns of the one shaft
fn combs(
    bearings: &[TrainBearing],
    ratio: impl Fn(usize) -> f64,
    step: f64,
) -> (Vec<Comb>, Vec<(usize, f64, f64)>) {
    let (mut combs, mut too_short): (Vec<Comb>, _) = (Vec::new(), Vec::new());
    for (place, of) in bearings.iter().enumerate() {
        let (orders, shaft) = (of.geometry.defect_orders(), ratio(of.shaft));
        let cage_turns = orders.cage * shaft / step;
        if cage_turns < FEWEST_CAGE_TURNS {
            too_short.push((place, cage_turns, FEWEST_CAGE_TURNS));
            continue;
        }
        for race in RACES {
            let order = race.order(&orders) * shaft;
            let beside = match race {
                DefectKind::InnerRace => Some(shaft),
                DefectKind::Element => Some(orders.cage * shaft),
                _ => None,
            };
            let is_alike = |comb: &&mut Comb| {
                comb.race == race
                    && is_near(comb.order, order)
                    && comb.beside.zip(beside).is_none_or(|(one, other)| is_near(one, other))
            };
            match combs.iter_mut().find(is_alike) {
                Some(alike) => alike.bearings.push(place),
                None => combs.push(Comb { race, bearings: vec![place], shaft, order, beside }),
            }
        }
    }
    (combs, too_short)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bearing::NamedBearing;
    use crate::random::{Draws, Purpose};
    use crate::signal::{GearTrain, ShaftPhase, StatedTurning, TrainTurning};

    const RATE_HZ: f64 = 20_000.0;

    fn bearing(name: &str, shaft: usize) -> TrainBearing {
        TrainBearing { geometry: NamedBearing::find(name).unwrap().geometry, shaft }
    }

    /// A resonance that rings at each pass of a race's order, in noise, beside a mesh; the passes are 1 % later than without slip.
    fn look_for(order: Option<f64>, seconds: f64, seed: u64, bearings: &[TrainBearing]) -> BearingDefects {
        let train = GearTrain::of_wheels([("pinion", 20), ("gear", 61)]);
        let samples = (seconds * RATE_HZ) as usize;
        let phase = ShaftPhase::constant(30.0, RATE_HZ, samples).unwrap();
        let mut draws = Draws::new(seed, Purpose::RecordNoise, 0);
        let mut value = |angle: f64| {
            let ringing = order.map_or(0.0, |order| {
                let order = 0.99 * order;
                let since_s = (angle * order).fract() / (30.0 * order);
                (-800.0 * since_s).exp() * (2.0 * PI * 4000.0 * since_s).sin()
            });
            0.5 * ringing + 2.0 * (2.0 * PI * 20.0 * angle).cos() + 0.3 * draws.normal()
        };
        let signal: Vec<f64> = phase.revolutions.iter().map(|angle| value(*angle)).collect();
        let turning = TrainTurning::Shaft { shaft: 0, phase, stated: StatedTurning::Other };
        let recording =
            TrainRecording { signal: &signal, sampling_rate_hz: RATE_HZ, train: &train, turning: &turning };
        recording.bearing_defects(bearings, &BearingSettings::default()).unwrap()
    }

    #[test]
    fn the_race_that_rings_is_found_and_no_other() {
        let bearings = [bearing("6205", 0), bearing("ER-10K", 1), bearing("6205", 0)];
        let orders = bearings[0].geometry.defect_orders();
        for (race, order) in
            [(DefectKind::OuterRace, orders.outer_race), (DefectKind::InnerRace, orders.inner_race)]
        {
            let found = look_for(Some(order), 4.0, 1, &bearings);
            let detected: Vec<&RaceTest> = found.races.iter().filter(|of| of.is_detected()).collect();
            assert_eq!(detected.len(), 1, "{found:#?}");
            assert_eq!((detected[0].race, &detected[0].bearings), (race, &vec![0, 2]));
            assert!((detected[0].found_order / order - 0.99).abs() < 0.002);
            // Six of the nine lines of an inner race are sidebands, which this ringing does not have.
            let lines = if race == DefectKind::InnerRace { 9.0 / 3.0 } else { 1.0 };
            assert!(detected[0].over_median.powf(lines) > 5.0, "{}", detected[0].over_median);
            assert!(found.too_short.is_empty());
        }
    }

    #[test]
    fn bearings_whose_orders_differ_by_less_than_slip_are_both_named() {
        let bearings = [bearing("ER-10K", 0), bearing("6203", 0), bearing("6205", 0)];
        let order = bearings[1].geometry.defect_orders().outer_race;
        let found = look_for(Some(order), 4.0, 2, &bearings);
        let detected: Vec<&RaceTest> = found.races.iter().filter(|of| of.is_detected()).collect();
        assert_eq!(detected.len(), 1, "{found:#?}");
        assert_eq!((detected[0].race, &detected[0].bearings), (DefectKind::OuterRace, &vec![0, 1]));
    }

    #[test]
    fn noise_is_no_defect_and_a_short_recording_says_nothing() {
        let bearings = [bearing("6205", 0), bearing("ER-10K", 1)];
        for seed in 0..4 {
            let found = look_for(None, 4.0, seed, &bearings);
            assert!(!found.races.iter().any(RaceTest::is_detected), "{found:#?}");
        }
        let short = look_for(None, 0.9, 0, &bearings);
        assert_eq!(short.too_short.iter().map(|of| of.0).collect::<Vec<_>>(), [0, 1]);
        assert!(short.races.is_empty());
    }
}
