//! Tones that belong to no shaft and no mesh of a train.

use std::f64::consts::TAU;

use meshtone_fourier::{Complex64, hann_window, real_spectrum};
use serde::Serialize;

use super::spectrum::windowed;
use super::{AngularSignal, GearTrain, upper_median};

/// (lines) How near a line is to an order, to belong to it: the main lobe of Hann's window, and a little.
const NEAR_LINES: f64 = 2.5;
/// (-) A line is a tone where its square is so many times the median of its neighbours'. Of noise, one in 10⁹ is.
const TONE: f64 = 30.0;
/// (-) Part of the energy in tones of no shaft from which on they are warned of: teeth that strike and part make up to a seventh that repeats
/// with no shaft, since it depends on which two teeth meet.
const COUNTS: f64 = 0.2;
/// Part of the Nyquist order up to which lines are right.
const PASSED: f64 = 0.8;
/// Lines that are compared with their median.
const BAND: usize = 96;
/// Fewest revolutions whose lines are distinguished from the shafts' orders.
const FEWEST_REVOLUTIONS: usize = 6;
/// Tones that a warning names.
const NAMED: usize = 3;
/// (Hz) Mains frequencies.
const MAINS_HZ: [f64; 2] = [50.0, 60.0];
/// The highest harmonic of them that is looked for.
const MAINS_HARMONICS: f64 = 12.0;
/// Terms of the Blackman–Harris window: its side lobes are 92 dB down, so that no side lobe of a mesh order looks like a tone.
///
/// Source: F. J. Harris, "On the use of windows for harmonic analysis with the discrete Fourier transform", Proc. IEEE 66 (1978) 51–83,
/// table 1.
const WINDOW: [f64; 4] = [0.35875, -0.48829, 0.14128, -0.01168];
/// (lines) Half the width of its main lobe.
const LOBE: usize = 4;
/// (lines) How near the middle of a tone is to an order of a shaft, and to one at which the same teeth meet again, to belong to it.
const OWN: [f64; 2] = [2.0, 1.0];
/// (lines) Least distance of the orders at which the same teeth meet again where they are told from each other.
const APART: f64 = 4.0;
/// (cycles) How well the phase of a mesh tone is known: beyond it another line would have been followed.
const FOLLOWED_CYCLES: f64 = 0.5;
/// Orders of one shaft by which a mesh has sidebands that are no orders of another one.
const SIDEBANDS: i32 = 4;
/// (-) Least square of a tone over that of the strongest line: weaker ones are left out.
const LEAST: f64 = 1e-6;

/// A tone that belongs to no shaft and no mesh.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ForeignTone {
    /// (Hz) At the mean speed of the recording.
    pub frequency_hz: f64,
    /// (orders) Its order: of the wheel's shaft, of a gearbox of the input.
    pub order: f64,
    /// (unit of the signal) Its amplitude.
    pub amplitude: f64,
    /// (-) Its part of the recording's energy.
    #[serde(rename = "part_of_energy")]
    pub part: f64,
    /// Whether it is a harmonic of a mains frequency.
    #[serde(skip)]
    pub may_be_mains: bool,
}

/// What a search for tones that belong to no shaft and no mesh found.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ForeignSearch {
    /// The tones, the strongest first.
    pub tones: Vec<ForeignTone>,
    /// (-) Part of the orders that were searched at which a tone would belong to the train: it falls with the length of the recording, which
    /// distinguishes orders.
    pub own_part: f64,
    /// (s) Length that a recording needs for weak tones to be distinguished from hunting-tooth orders; none where this one has it.
    pub needed_s: Option<f64>,
}

/// Tones that belong to no shaft and make much of a recording.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ForeignTones {
    /// (-) Part of the recording's energy that all of them have.
    pub part: f64,
    /// The strongest of them, at most three.
    pub strongest: Vec<ForeignTone>,
}

impl ForeignTones {
    /// The energy of tones and the strongest of them; none of no tones.
    ///
    /// # Arguments
    /// * `tones` - all of a recording, the strongest first
    pub fn of(tones: &[ForeignTone]) -> Option<Self> {
        let part: f64 = tones.iter().map(|tone| tone.part).sum();
        // Neighbouring tones share the lines between them.
        (!tones.is_empty())
            .then(|| Self { part: part.min(1.0), strongest: tones.iter().take(NAMED).copied().collect() })
    }

    /// Returns whether they make a fifth of the energy or more.
    pub fn count(&self) -> bool {
        self.part > COUNTS
    }
}

/// The spectrum of a recording, and for each line whether it belongs to no shaft.
#[derive(Debug, Clone)]
pub struct LinesOffShafts {
    /// Of the recording without its mean behind Hann's window: line k is order k/revolutions.
    pub spectrum: Vec<Complex64>,
    /// Whether each line lies beside the orders of all shafts.
    pub is_off: Vec<bool>,
}

/// Finds the lines of a recording that are beside the orders of all shafts of a train.
///
/// Orders at which the same teeth meet again are the train's own as well: of a pair multiples of 1/q, where the tooth counts are as p to q in
/// lowest terms. They are left out where the recording is long enough to distinguish them.
///
/// # Arguments
/// * `angular` - the recording over whole revolutions of a shaft
/// * `train` - the shafts
/// * `shaft` - number of the shaft
pub fn lines_off_shafts(angular: &AngularSignal, train: &GearTrain, shaft: usize) -> LinesOffShafts {
    let revolutions = angular.revolutions();
    let points = revolutions * angular.points_per_revolution;
    let spectrum = real_spectrum(&windowed(&angular.values[..points], &hann_window(points)));
    let (mut spacings, hunting) = train.spacings(shaft);
    if hunting * revolutions as f64 > 4.0 * NEAR_LINES {
        spacings.push(hunting);
    }
    let is_off = |line: usize| {
        let order = line as f64 / revolutions.max(1) as f64;
        spacings.iter().all(|spacing| distance(order, *spacing) * revolutions as f64 > NEAR_LINES)
    };
    LinesOffShafts { is_off: (0..spectrum.len()).map(is_off).collect(), spectrum }
}

/// Searches a recording for tones that belong to no shaft and no mesh of a train.
///
/// A tone is a line that is larger than its neighbours, stands 15 dB above the median around it and is not 60 dB below the strongest line. It is
/// the train's own at an order of any shaft, at a sideband of a mesh by up to four orders of any two shafts together, and at an order at which
/// the same teeth meet again, where the recording distinguishes these.
///
/// # Arguments
/// * `angular` - the recording over whole revolutions of a shaft
/// * `train` - the shafts
/// * `shaft` - number of the shaft
/// * `mean_speed_hz` - (Hz) mean speed of the shaft
/// * `followed_order` - order of the mesh tone from which the angle is known, where it is: its error grows with the order that is looked at
///
/// # Returns
/// None of fewer than six revolutions, in which nothing is distinguished.
///
/// ```
/// use meshtone::signal::{AngularSettings, GearTrain, ShaftPhase, angular_resample, foreign_tones};
///
/// let wave = |hz: f64, i: usize| (std::f64::consts::TAU * hz * i as f64 / 1e4).cos();
/// let signal: Vec<f64> = (0..20_000).map(|i| wave(380.0, i) + 0.1 * wave(313.0, i)).collect();
/// let phase = ShaftPhase::constant(20.0, 1e4, signal.len())?;
/// let angular = angular_resample(&signal, &phase, &AngularSettings::default())?;
/// let train = GearTrain::of_wheels([("pinion", 19), ("gear", 38)]);
/// let found = foreign_tones(&angular, &train, 0, 20.0, None).ok_or("too short")?;
/// let [tone] = found.tones[..] else { panic!() };
/// assert!((tone.frequency_hz - 313.0).abs() < 0.05 && (tone.amplitude - 0.1).abs() < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn foreign_tones(
    angular: &AngularSignal,
    train: &GearTrain,
    shaft: usize,
    mean_speed_hz: f64,
    followed_order: Option<f64>,
) -> Option<ForeignSearch> {
    let revolutions = angular.revolutions();
    if revolutions < FEWEST_REVOLUTIONS {
        return None;
    }
    let points = revolutions * angular.points_per_revolution;
    let spectrum = real_spectrum(&windowed(&angular.values[..points], &blackman_harris(points)));
    let squares: Vec<f64> = spectrum.iter().map(|line| line.norm_sqr()).collect();
    let passed = ((PASSED * angular.nyquist_order) as usize * revolutions).min(squares.len());
    let lines = LOBE + 1..passed.saturating_sub(LOBE);
    let energy: f64 = squares[lines.start.min(passed)..passed].iter().sum();
    let largest = squares[..passed].iter().copied().fold(0.0, f64::max);
    let medians: Vec<f64> = squares[..passed].chunks(BAND).map(upper_median).collect();
    let drift_rev = followed_order.map_or(0.0, |followed| FOLLOWED_CYCLES / followed);
    let highest = passed as f64 / revolutions as f64;
    let own = OwnOrders::new(train, shaft, revolutions as f64, (highest, drift_rev));
    let to_input = train.speed_ratio(shaft, train.input()).value();
    let tone = |line: usize| {
        let square = squares[line];
        let is_peak = square > squares[line - 1] && square >= squares[line + 1];
        if !is_peak || square < LEAST * largest || square < TONE * medians[line / BAND] {
            return None;
        }
        // The tip of a parabola through the logarithms of three lines.
        let [before, at, after] = [-1, 0, 1].map(|by| libm::log(squares[line.saturating_add_signed(by)]));
        let centre = line as f64 + 0.5 * (before - after) / (before - 2.0 * at + after);
        let order = centre / revolutions as f64;
        if !centre.is_finite() || own.contains(order) {
            return None;
        }
        let lobe: f64 = squares[line - LOBE..=line + LOBE].iter().sum();
        let mean_square_of_window =
            0.5 * WINDOW.iter().map(|term| term * term).sum::<f64>() + 0.5 * WINDOW[0] * WINDOW[0];
        Some(ForeignTone {
            frequency_hz: order * mean_speed_hz,
            order: order * to_input,
            amplitude: 2.0 * (lobe / mean_square_of_window).sqrt() / points as f64,
            part: (lobe / energy).min(1.0),
            may_be_mains: is_of_mains(
                order * mean_speed_hz,
                MAINS_HARMONICS,
                2.0 * (mean_speed_hz / revolutions as f64),
            ),
        })
    };
    let mut tones: Vec<ForeignTone> = lines.filter_map(tone).collect();
    tones.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    let needed_rev = APART / train.spacings(shaft).1;
    // Of a recording only whole revolutions are left.
    let needed_s = (needed_rev > revolutions as f64).then_some((needed_rev + 1.0) / mean_speed_hz);
    Some(ForeignSearch { tones, own_part: own.part(), needed_s })
}

/// The orders of a train, to which a tone may belong.
struct OwnOrders {
    /// First and last order of ranges that do not overlap, in rising order.
    ranges: Vec<[f64; 2]>,
    /// The last order that is looked at.
    highest: f64,
}

impl OwnOrders {
    /// # Arguments
    /// * `highest`, `drift_rev` - the last order that is looked at, and (rev) how far the angle may be off
    fn new(train: &GearTrain, shaft: usize, revolutions: f64, (highest, drift_rev): (f64, f64)) -> Self {
        let (shafts, hunting) = train.spacings(shaft);
        let of_input = train.speed_ratio(train.input(), shaft).value();
        let [near_shaft, near_other] = OWN.map(|lines| lines / revolutions);
        let near = |order: f64, by: f64| {
            let by = by.max(drift_rev * order / revolutions);
            [order - by, order + by]
        };
        let multiples = |spacing: f64, by: f64| {
            let last = ((highest + by) / spacing) as u32;
            (0..=last).map(move |multiple| near(f64::from(multiple) * spacing, by))
        };
        let mut all: Vec<[f64; 2]> =
            shafts.iter().flat_map(|spacing| multiples(*spacing, near_shaft)).collect();
        if hunting * revolutions >= APART {
            all.extend(multiples(hunting, near_other));
        }
        for mesh in (0..train.meshes.len()).map(|mesh| train.mesh_order(mesh) * of_input) {
            let offsets = sidebands(&shafts).filter(|off| off.abs() <= 0.5 * mesh);
            for off in offsets {
                let of_harmonic = |harmonic: u32| near(f64::from(harmonic) * mesh + off, near_other);
                all.extend((0..=(highest / mesh + 1.0) as u32).map(of_harmonic));
            }
        }
        all.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut ranges: Vec<[f64; 2]> = Vec::new();
        for [from, to] in all {
            match ranges.last_mut() {
                Some(before) if from <= before[1] => before[1] = before[1].max(to),
                _ => ranges.push([from, to]),
            }
        }
        Self { ranges, highest }
    }

    /// Returns whether a tone of an order is the train's own.
    fn contains(&self, order: f64) -> bool {
        let after = self.ranges.partition_point(|[from, _]| *from <= order);
        after.checked_sub(1).is_some_and(|at| order <= self.ranges[at][1])
    }

    /// (-) Part of the orders that is the train's own.
    fn part(&self) -> f64 {
        let inside = |[from, to]: &[f64; 2]| (to.min(self.highest) - from.max(0.0)).max(0.0);
        self.ranges.iter().map(inside).sum::<f64>() / self.highest
    }
}

/// (orders) Distances of sidebands from a mesh harmonic: sums of some orders of any two shafts.
fn sidebands(shafts: &[f64]) -> impl Iterator<Item = f64> {
    let orders = || (-SIDEBANDS..=SIDEBANDS).map(f64::from);
    let pairs = shafts.iter().enumerate().flat_map(move |(at, a)| shafts[at..].iter().map(move |b| (*a, *b)));
    pairs.flat_map(move |(a, b)| orders().flat_map(move |k| orders().map(move |l| k * a + l * b)))
}

/// How far an order is from the next multiple of a spacing.
fn distance(order: f64, spacing: f64) -> f64 {
    (order - (order / spacing).round() * spacing).abs()
}

/// Returns whether a frequency is so near a harmonic of a mains frequency, of the first so many.
pub(super) fn is_of_mains(frequency_hz: f64, harmonics: f64, near_hz: f64) -> bool {
    MAINS_HZ.into_iter().any(|mains_hz| {
        let harmonic = (frequency_hz / mains_hz).round().clamp(1.0, harmonics);
        (frequency_hz - harmonic * mains_hz).abs() < near_hz
    })
}

fn blackman_harris(points: usize) -> Vec<f64> {
    let at = |point: usize| {
        let angle = TAU * point as f64 / points as f64;
        WINDOW.iter().enumerate().map(|(term, share)| share * libm::cos(term as f64 * angle)).sum()
    };
    (0..points).map(at).collect()
}

impl std::fmt::Display for ForeignTones {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "tones at no order of any shaft make {:.0} % of the recording's energy, the strongest at ",
            100.0 * self.part
        )?;
        for (number, tone) in self.strongest.iter().enumerate() {
            let before = if number == 0 { "" } else { ", " };
            let mains = if tone.may_be_mains { ", a harmonic of the mains" } else { "" };
            let ForeignTone { frequency_hz, order, part, .. } = tone;
            write!(f, "{before}{frequency_hz:.2} Hz (order {order:.3}, {:.0} %{mains})", 100.0 * part)?;
        }
        write!(
            f,
            ": another stage or machine, a bearing, or teeth or speed that are not as stated; the average does not contain them"
        )
    }
}
