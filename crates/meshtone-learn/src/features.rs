//! Numbers that state what a wheel's average shows.
//!
//! *Levels* are logarithms of amplitudes: a path to the sensor adds to them, and those of a healthy recording of the same rig can
//! be taken away. *Shapes* do not depend on the amplitude.

use meshtone::signal::{analytic_signal, kurtosis, peak, rms};
use meshtone_fourier::Complex64;

use crate::lines::{WheelLines, revolution, separation};

/// (-) Least amplitude, as a part of the largest, whose logarithm is taken.
const FLOOR: f64 = 1e-6;
/// (-) Least energy over one tooth, as a part of the mean or of the burst: what a recording has everywhere, since loads differ and sensors have
/// noise. Without it, two simulations of one load would be unlike all others.
const LEAST_SHARE: f64 = 0.02;
/// Mesh harmonics whose levels are looked at.
const HARMONICS: usize = 8;
/// Mesh orders beyond which the local waveform is not looked at.
const LOCAL_ORDERS: usize = 4;
/// Values of the local waveform.
const LOCAL_POINTS: usize = 24;
/// (teeth) From where to where the local waveform goes, from the burst on.
const LOCAL_TEETH: [f64; 2] = [-2.0, 4.0];
/// (teeth) Middles of the windows around the burst whose shares of the energy are looked at.
const WINDOWS: [f64; 9] = [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 6.0];
/// Limits of the bands of the local spectrum, in mesh orders.
const LOCAL_BANDS: [f64; 7] = [0.0, 1.5, 2.5, 4.5, 7.5, 11.5, 16.5];
/// Mesh orders that divide the difference signal into parts whose shape is looked at.
const PARTS: [f64; 4] = [0.0, 3.5, 7.5, 16.5];

/// Features of a wheel's average.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelFeatures {
    /// (log10 g) Levels.
    pub levels: Vec<f64>,
    /// (-) Shapes.
    pub shapes: Vec<f64>,
    /// (rev) Where the burst is.
    pub burst_rev: f64,
    /// Number of bands of the difference signal among the levels.
    bands: usize,
}

impl WheelFeatures {
    /// Which of the levels are those of the difference signal in bands, one about each multiple of the mesh frequency.
    pub fn bands(&self) -> std::ops::Range<usize> {
        1..1 + self.bands
    }
}

/// Features of the lines of an average.
///
/// All but the levels of the regular part are of the difference signal, in which damage stands out. The burst, where the energy over
/// one tooth is largest, is found first: what is around it is compared there, since the damaged tooth may be any.
///
/// # Arguments
/// * `view` - the lines
/// * `last` - the last order that is whole in everything that is compared
/// * `has_regular_part` - whether the mesh harmonics are in it
pub fn wheel_features(view: &WheelLines, last: usize, has_regular_part: bool) -> WheelFeatures {
    let last = last.min(view.last());
    let difference = Difference::new(view, last);
    let energy = difference.energy_over_tooth();
    let at = largest_at(&energy);
    let mut shapes = difference.shapes();
    shapes.extend(difference.energy_around_burst(&energy, at));
    shapes.extend(difference.spectrum_around_burst(at, last));
    shapes.extend(difference.waveform_around_burst(at));
    WheelFeatures {
        levels: levels(view, &difference, last, has_regular_part),
        shapes,
        burst_rev: at as f64 / difference.points() as f64,
        bands: last / difference.teeth.max(1),
    }
}

/// (log10 g) Levels over mesh orders, each band from half a mesh order below to half above; with the regular part also of the mesh
/// harmonics, of what is beside them and of the lowest orders.
fn levels(view: &WheelLines, difference: &Difference, last: usize, has_regular_part: bool) -> Vec<f64> {
    let teeth = difference.teeth;
    let bands = last / teeth.max(1);
    let scale = rms(&difference.values).max(f64::MIN_POSITIVE);
    let level = |value: f64| value.max(FLOOR * scale).log10();
    let mut levels = vec![level(scale)];
    let of_band = |mesh: usize| band(&difference.lines, teeth, mesh as f64 + 0.5, mesh as f64 + 1.5);
    levels.extend((0..bands).map(|mesh| level(of_band(mesh))));
    if has_regular_part {
        let tone =
            |order: usize| view.lines.get(order).filter(|_| order <= last).map_or(0.0, |line| line.norm());
        let harmonics = bands.min(HARMONICS);
        levels.extend((1..=harmonics).map(|mesh| level(tone(mesh * teeth))));
        let beside = |mesh: usize| {
            let below = |less: usize| (mesh * teeth).saturating_sub(less);
            let orders = [below(2), below(1), mesh * teeth + 1, mesh * teeth + 2];
            orders.iter().map(|&order| tone(order).powi(2)).sum::<f64>().sqrt()
        };
        levels.extend((1..=harmonics).map(|mesh| level(beside(mesh))));
        let low: f64 = (1..=7).map(|order| tone(order).powi(2)).sum();
        levels.push(level(low.sqrt()));
    }
    levels
}

/// (g) Rms of the lines between two mesh orders.
fn band(lines: &[Complex64], teeth: usize, from: f64, to: f64) -> f64 {
    let order = |mesh: f64| ((mesh * teeth as f64) as usize).min(lines.len());
    let energy: f64 = lines[order(from)..order(to)].iter().map(|line| 2.0 * line.norm_sqr()).sum();
    energy.sqrt()
}

/// (-) Logarithms of kurtosis and crest factor.
fn shape(values: &[f64]) -> [f64; 2] {
    let of_finite = |value: f64| if value.is_finite() { value } else { 0.0 };
    let crest = peak(values) / rms(values).max(f64::MIN_POSITIVE);
    [kurtosis(values).unwrap_or(1.0).max(1.0).ln(), crest.max(1.0).ln()].map(of_finite)
}

/// The difference signal of a wheel of so many teeth over one revolution, as lines and as values.
struct Difference {
    teeth: usize,
    lines: Vec<Complex64>,
    values: Vec<f64>,
}

impl Difference {
    /// The difference signal up to an order that the lines have.
    fn new(view: &WheelLines, last: usize) -> Self {
        let lines: Vec<Complex64> = view.difference().into_iter().take(last + 1).collect();
        let points = (2 * last + 1).next_power_of_two().max(64);
        Self { teeth: view.teeth(), values: revolution(&lines, points), lines }
    }

    /// The squared envelope, the mean over one tooth around each point.
    fn energy_over_tooth(&self) -> Vec<f64> {
        let square: Vec<f64> = match analytic_signal(&self.values) {
            Ok(of) => of.iter().map(Complex64::norm_sqr).collect(),
            Err(_) => self.values.iter().map(|value| value * value).collect(),
        };
        moving_mean(&square, self.points() / self.teeth.max(1))
    }

    fn points(&self) -> usize {
        self.values.len()
    }

    fn pitch(&self) -> f64 {
        self.points() as f64 / self.teeth as f64
    }

    /// Shapes of the whole signal and of its parts over mesh orders.
    fn shapes(&self) -> Vec<f64> {
        let mut shapes = shape(&self.values).to_vec();
        for part in PARTS.windows(2) {
            let inside = |(order, &line): (usize, &Complex64)| {
                let mesh = order as f64 / self.teeth as f64;
                if mesh >= part[0] && mesh < part[1] { line } else { Complex64::default() }
            };
            let lines: Vec<Complex64> = self.lines.iter().enumerate().map(inside).collect();
            shapes.extend(shape(&revolution(&lines, self.points())));
        }
        shapes
    }

    /// How the energy over one tooth is spread: in windows around the burst, at the next largest burst, and over all teeth.
    ///
    /// # Arguments
    /// * `energy` - over one tooth around each point
    /// * `at` - point of the burst
    fn energy_around_burst(&self, energy: &[f64], at: usize) -> Vec<f64> {
        let (points, pitch) = (self.points(), self.pitch());
        let total = energy.iter().sum::<f64>().max(f64::MIN_POSITIVE) / points as f64;
        let around = |teeth_on: f64| energy[wrapped(at as f64 + teeth_on * pitch, points)] / total;
        let mut shapes: Vec<f64> = WINDOWS.iter().map(|&on| around(on).max(LEAST_SHARE).ln()).collect();
        let elsewhere = (0..points).filter(|&point| difference(point, at, points).abs() > 3.0 * pitch);
        let second = elsewhere.map(|point| energy[point]).fold(0.0, f64::max);
        shapes.push((second / energy[at].max(f64::MIN_POSITIVE)).max(LEAST_SHARE).ln());
        let half = energy.iter().filter(|&&value| value > 0.25 * energy[at]).count();
        shapes.push((half as f64 / points as f64).ln());
        let of_tooth = |tooth: usize| energy[wrapped(tooth as f64 * pitch, points)] / total;
        let mut of_teeth: Vec<f64> = (0..self.teeth).map(of_tooth).collect();
        of_teeth.sort_by(f64::total_cmp);
        let ranked = |part: f64| of_teeth[(part * (self.teeth - 1) as f64) as usize];
        shapes.extend([0.1, 0.5, 0.9].map(|part| ranked(part).max(LEAST_SHARE).ln()));
        shapes
    }

    /// Shares of the bands in the spectrum of what is within three teeth of the burst.
    fn spectrum_around_burst(&self, at: usize, last: usize) -> impl Iterator<Item = f64> {
        let window = |point: usize| {
            let from = difference(point, at, self.points()) / self.pitch();
            if from.abs() < 3.0 { 0.5 + 0.5 * (std::f64::consts::PI * from / 3.0).cos() } else { 0.0 }
        };
        let cut = self.values.iter().enumerate().map(|(point, value)| value * window(point));
        let cut: Vec<f64> = cut.collect();
        let local = WheelLines::of_values(&cut, separation(self.teeth as u32), last);
        let of = move |from, to| band(&local.lines, self.teeth, from, to);
        let energy = of(0.0, 16.5).max(f64::MIN_POSITIVE);
        LOCAL_BANDS.windows(2).map(move |limits| (of(limits[0], limits[1]) / energy).max(1e-3).ln())
    }

    /// The waveform around the burst over its largest value, its fine structure left out.
    fn waveform_around_burst(&self, at: usize) -> impl Iterator<Item = f64> {
        let orders = LOCAL_ORDERS * self.teeth + self.teeth / 2;
        let low: Vec<Complex64> = self.lines.iter().take(orders).copied().collect();
        let low = revolution(&low, self.points());
        let step = (LOCAL_TEETH[1] - LOCAL_TEETH[0]) / (LOCAL_POINTS - 1) as f64;
        let on = |index: usize| (LOCAL_TEETH[0] + index as f64 * step) * self.pitch();
        let wave: Vec<f64> =
            (0..LOCAL_POINTS).map(|index| low[wrapped(at as f64 + on(index), self.points())]).collect();
        let largest = wave.iter().fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs()));
        wave.into_iter().map(move |value| value / largest)
    }
}

/// Index at which a sequence is largest.
fn largest_at(values: &[f64]) -> usize {
    (0..values.len()).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(0)
}

/// Mean over some values around each, of a periodic sequence.
fn moving_mean(values: &[f64], width: usize) -> Vec<f64> {
    let (count, width) = (values.len(), width.clamp(1, values.len()));
    let mut sum: f64 = (0..width).map(|index| values[(count - width / 2 + index) % count]).sum();
    let mut means = Vec::with_capacity(count);
    for index in 0..count {
        means.push(sum.max(0.0) / width as f64);
        sum += values[(index + width - width / 2) % count] - values[(index + count - width / 2) % count];
    }
    means
}

fn wrapped(place: f64, points: usize) -> usize {
    (place.round().rem_euclid(points as f64)) as usize % points
}

/// From one of an even number of points on a circle to another, the shorter way.
fn difference(a: usize, b: usize, points: usize) -> f64 {
    ((a + points + points / 2 - b) % points) as f64 - (points / 2) as f64
}
