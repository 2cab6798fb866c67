//! Averages of the wheels of a planetary set, whose planets carry the meshes past a sensor that stands still.

use std::f64::consts::PI;

use super::check::{check_count, check_length, check_positive};
use super::{AngularSignal, SignalError, SynchronousAverage};
use crate::scenario::Ratio;

/// A signal over the angle of a wheel against the carrier, with the passages of one planet that carries a mesh of the wheel past the sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct PassingSignal {
    /// The signal over whole revolutions of the wheel against the carrier. Where several planets mesh with the wheel, its angle is counted so that a
    /// tooth is at each of them at the same angle.
    pub angular: AngularSignal,
    /// (rev) Angle of the wheel at any passage of the planet.
    pub passage_rev: f64,
}

/// How the passages of planets follow one another over the angle of a wheel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Passages {
    /// (rev) What the wheel turns against the carrier from one passage of a planet to its next.
    pub period: Ratio,
    /// Number of planets: the window is the so-manieth part of the period.
    pub planets: usize,
    /// Teeth of the wheel.
    pub teeth: u32,
}

/// Windowed average of a wheel of a planetary set.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PlanetaryAverage {
    /// The average over the angle of the wheel, from angle 0 on. Its revolutions are those without windows that would weaken noise as much.
    pub average: SynchronousAverage,
    /// How often each tooth that comes to mesh in front of the sensor did so: all of them equally often.
    pub passages_of_each_tooth: usize,
}

/// The middle of a window.
struct Window {
    signal: usize,
    centre_rev: f64,
    tooth: usize,
}

impl Passages {
    /// Number of the tooth that meshes in front of the sensor, from that of the first signal's passage.
    fn tooth(&self, signals: &[PassingSignal], angle_rev: f64) -> usize {
        let first_rev = signals.first().map_or(0.0, |of| of.passage_rev);
        let turned = ((angle_rev - first_rev) * f64::from(self.teeth)).round();
        turned.rem_euclid(f64::from(self.teeth)) as usize
    }

    /// The teeth that come to mesh in front of the sensor, and the number of passages of each planet after which all have.
    fn cycle(&self, signals: &[PassingSignal]) -> (Vec<bool>, usize) {
        let mut comes = vec![false; self.teeth as usize];
        let mut needed = 0;
        for passage in 0..self.period.denominator.clamp(1, MOST_PASSAGES) {
            for of in signals {
                let tooth = self.tooth(signals, of.passage_rev + passage as f64 * self.period.value());
                if !std::mem::replace(&mut comes[tooth], true) {
                    needed = passage as usize + 1;
                }
            }
        }
        (comes, needed)
    }

    /// The windows that lie in the signals as a whole, in their order.
    fn windows(&self, signals: &[PassingSignal]) -> Vec<Window> {
        let (period_rev, half_rev) = (self.period.value(), self.half_rev());
        let of_signal = |(signal, of): (usize, &PassingSignal)| {
            let [start_rev, end_rev] =
                [0, of.angular.revolutions()].map(|rev| of.angular.start_rev + rev as f64);
            let first = ((start_rev + half_rev - of.passage_rev) / period_rev - ROUNDING).ceil();
            let last = ((end_rev - half_rev - of.passage_rev) / period_rev + ROUNDING).floor();
            let count = (last - first + 1.0).max(0.0) as usize;
            let first_rev = of.passage_rev + first * period_rev;
            (0..count).map(move |number| (signal, first_rev + number as f64 * period_rev))
        };
        let all = signals.iter().enumerate().flat_map(of_signal);
        let mut windows: Vec<Window> = all
            .map(|(signal, centre_rev)| Window { signal, centre_rev, tooth: self.tooth(signals, centre_rev) })
            .collect();
        windows.sort_by(|a, b| a.centre_rev.total_cmp(&b.centre_rev));
        windows
    }

    fn half_rev(&self) -> f64 {
        self.period.value() / (2.0 * self.planets as f64)
    }
}

/// Part of a period that is taken for rounding.
const ROUNDING: f64 = 1e-9;
/// Passages among which the teeth that come to mesh in front of the sensor are looked for.
const MOST_PASSAGES: i64 = 100_000;
/// Part of the mean sum of windows below which an angle counts as not seen.
const UNSEEN: f64 = 0.05;

/// Average of a planet or a sun: of what the sensor hears while a planet passes, at the angle that the wheel has then.
///
/// A sensor on the ring hears the meshes of the planet in front of it best. Around every passage a Hann window, of the carrier's revolution over the
/// number of planets, is cut out and laid at the wheel's own angle; the sum is divided by the sum of the windows. A planet has a passage in every
/// revolution of the carrier; of the sun those of all planets count. Every tooth that comes to mesh in front of the sensor counts equally often: what
/// is left beyond that is not used. Then what is the same at all teeth stays the same at all teeth.
///
/// # Arguments
/// * `signals` - (at least 1, all with equally many points) one for each planet that meshes with the wheel
/// * `passages` - how these follow one another
///
/// # Errors
/// No signals, or unequal ones; no teeth, planets or period; fewer passages than bring every tooth before the sensor; teeth that never come into a
/// window.
///
/// Sources: P. D. McFadden, "A technique for calculating the time domain averages of the vibration of the individual planet gears and the sun gear in
/// an epicyclic gearbox", J. Sound Vib. 144 (1991) 163–172.
///
/// ```
/// use meshtone::scenario::Ratio;
/// use meshtone::signal::{AngularSignal, PassingSignal, Passages, planetary_average};
///
/// // A planet of 10 teeth turns 2.9 times while the carrier turns once; its tooth 3 knocks wherever it is.
/// let knock = |i: usize| if i % 100 == 35 { 1.0 } else { 0.0 };
/// let values = (0..100 * 60).map(knock).collect();
/// let angular = AngularSignal { points_per_revolution: 100, start_rev: 0.0, nyquist_order: 50.0, values };
/// let passages = Passages { period: Ratio::ONE.times(29, 10), planets: 3, teeth: 10 };
/// let found = planetary_average(&[PassingSignal { angular, passage_rev: 0.7 }], &passages)?;
/// assert_eq!(found.passages_of_each_tooth, 2);
/// assert!((0..100).all(|i| (found.average.values[i] - knock(i)).abs() < 1e-12));
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn planetary_average(
    signals: &[PassingSignal],
    passages: &Passages,
) -> Result<PlanetaryAverage, SignalError> {
    let points = check(signals, passages)?;
    let (comes, needed) = passages.cycle(signals);
    let windows = passages.windows(signals);
    let mut there_are = vec![0; comes.len()];
    windows.iter().for_each(|window| there_are[window.tooth] += 1);
    let of_coming = comes.iter().zip(&there_are).filter(|(comes, _)| **comes);
    let each = of_coming.map(|(_, count)| *count).min().unwrap_or(0);
    if each == 0 {
        let revolutions = windows.iter().filter(|window| window.signal == 0).count();
        return Err(SignalError::TooFewPassages { revolutions, needed });
    }
    let half_rev = passages.half_rev();
    let [mut sums, mut weights, mut squares] = [(); 3].map(|()| vec![0.0; points]);
    let mut used = vec![0; comes.len()];
    for Window { signal, centre_rev, tooth } in windows {
        if used[tooth] == each {
            continue;
        }
        used[tooth] += 1;
        let AngularSignal { start_rev, values, .. } = &signals[signal].angular;
        let point = |angle_rev: f64| (angle_rev - start_rev) * points as f64;
        // The first value need not be at a whole revolution.
        let turned = (start_rev.rem_euclid(1.0) * points as f64).round() as usize;
        let [from, to] = [point(centre_rev - half_rev).ceil(), point(centre_rev + half_rev).floor()];
        for at in from.max(0.0) as usize..(to.max(0.0) as usize + 1).min(values.len()) {
            let away = (at as f64 - point(centre_rev)) / (half_rev * points as f64);
            let weight = 0.5 + 0.5 * (PI * away).cos();
            let place = (at + turned) % points;
            sums[place] += weight * values[at];
            weights[place] += weight;
            squares[place] += weight * weight;
        }
    }
    let mean = weights.iter().sum::<f64>() / points as f64;
    if weights.iter().any(|weight| *weight <= UNSEEN * mean) {
        let seen = comes.iter().filter(|comes| **comes).count();
        return Err(SignalError::TeethNotSeen { seen, teeth: passages.teeth });
    }
    let independent = weights.iter().zip(&squares).map(|(weight, square)| weight * weight / square);
    let average = SynchronousAverage {
        revolutions: independent.fold(f64::INFINITY, f64::min).round() as usize,
        nyquist_order: signals.iter().map(|of| of.angular.nyquist_order).fold(f64::INFINITY, f64::min),
        values: sums.iter().zip(&weights).map(|(sum, weight)| sum / weight).collect(),
    };
    Ok(PlanetaryAverage { average: average.of_enough_revolutions()?, passages_of_each_tooth: each })
}

/// Checks what the fields of the arguments leave open, and returns the number of points.
fn check(signals: &[PassingSignal], passages: &Passages) -> Result<usize, SignalError> {
    check_count("signals of planets that pass", signals.len(), 1)?;
    let points = signals[0].angular.points_per_revolution;
    for of in signals {
        check_length("points of a revolution", of.angular.points_per_revolution, points)?;
    }
    let counts = [points as f64, passages.planets as f64, f64::from(passages.teeth), passages.period.value()];
    let names = ["points_per_revolution", "planets", "teeth", "period"];
    names.into_iter().zip(counts).try_for_each(|(name, value)| check_positive(name, value))?;
    Ok(points)
}
