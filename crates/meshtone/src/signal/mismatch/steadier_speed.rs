//! The constant speed at which the mesh harmonics turn least over the recording.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use meshtone_fourier::{Complex64, convenient_length, inverse_complex};

use super::fine_orders::FineOrders;
use super::hypotheses::Hypothesis;
use crate::signal::AngularSignal;

/// Harmonics that are followed, at most.
const FOLLOWED: usize = 3;
/// Of the first so many.
const HARMONICS: u32 = 8;
/// (bins of the fine orders) Range to each side in which the speed is looked for.
const RANGE: f64 = 2.0;
/// Steps of the search in a width of the recording's own line.
const STEPS: f64 = 4.0;
/// Least part of the harmonics' energy that is steady at the best speed.
const LEAST_STEADY: f64 = 0.3;
/// Values of the spectrum in which the speed is looked for, at least, of every revolution.
const OVERSAMPLING: usize = 8;
/// Least sum of the followed harmonics' prominences.
const LEAST_PROMINENCE: f64 = 2.0;

/// A better speed.
#[derive(Debug, Clone, Copy)]
pub(super) struct SteadierSpeed {
    /// Over the one that is stated.
    pub(super) factor: f64,
    /// Energy of the harmonics in the average over that at the stated speed.
    pub(super) energy_ratio: f64,
}

/// One harmonic, revolution by revolution.
struct Harmonic {
    order: f64,
    turns: Vec<Complex64>,
}

impl Harmonic {
    /// Of the shaft that turns `factor` times as quickly as the angle says.
    fn of(angular: &AngularSignal, order: f64, factor: f64) -> Self {
        let points = angular.points_per_revolution;
        let step = -TAU * order * factor / points as f64;
        let wave: Vec<Complex64> = (0..points).map(|n| Complex64::cis(step * n as f64)).collect();
        let turn = |(revolution, values): (usize, &[f64])| {
            amplitude(values, &wave) * Complex64::cis(-TAU * (order * factor * revolution as f64).fract())
        };
        Self { order, turns: angular.values.chunks_exact(points).enumerate().map(turn).collect() }
    }

    /// The harmonic with each revolution weighted.
    fn weighted(&self, weight: impl Fn(usize) -> f64) -> Self {
        let turns = self.turns.iter().enumerate().map(|(r, turn)| turn * weight(r)).collect();
        Self { order: self.order, turns }
    }

    /// Energy that is steady where the shaft turns by `by` of its speed quicker.
    fn steady(&self, by: f64) -> f64 {
        let step = Complex64::cis(-TAU * self.order * by);
        let turned =
            |(sum, turning): (Complex64, Complex64), turn: &Complex64| (sum + turn * turning, turning * step);
        self.turns.iter().fold((Complex64::default(), Complex64::new(1.0, 0.0)), turned).0.norm_sqr()
    }

    /// [`Self::steady`] at as many speeds as are asked for, of the nearest line of a fine spectrum: each costs no sum over the
    /// revolutions, of which a long recording has as many as speeds.
    fn steady_nearly(&self) -> impl Fn(f64) -> f64 + use<> {
        let mut padded = self.turns.clone();
        padded.resize(convenient_length(OVERSAMPLING * self.turns.len()), Complex64::default());
        let spectrum: Vec<f64> = inverse_complex(padded).iter().map(Complex64::norm_sqr).collect();
        let (order, lines) = (self.order, spectrum.len() as i64);
        move |by| {
            let line = (-order * by * lines as f64).round() as i64;
            spectrum[line.rem_euclid(lines) as usize]
        }
    }

    fn energy(&self) -> f64 {
        self.turns.iter().map(Complex64::norm_sqr).sum::<f64>() * self.turns.len() as f64
    }
}

/// `Σ value wave`, in sums side by side.
fn amplitude(values: &[f64], wave: &[Complex64]) -> Complex64 {
    const LANES: usize = 8;
    let mut sums = [Complex64::default(); LANES];
    for (values, wave) in values.chunks(LANES).zip(wave.chunks(LANES)) {
        for (sum, (value, wave)) in sums.iter_mut().zip(values.iter().zip(wave)) {
            sum.re += value * wave.re;
            sum.im += value * wave.im;
        }
    }
    sums.into_iter().sum()
}

/// The speed near that of a hypothesis at which the mesh harmonics are steadiest.
///
/// Few harmonics that stand out are followed. An approximation that is quick to compute is looked at over the whole range, the exact
/// measure only about its best place, and a parabola through three values gives the place between the steps.
///
/// None where no harmonic stands out, or none is steady.
pub(super) fn steadier_speed(
    angular: &AngularSignal,
    orders: &FineOrders,
    hypothesis: &Hypothesis,
    teeth: u32,
) -> Option<SteadierSpeed> {
    let factor = hypothesis.wheel_spacing;
    let mut prominent: Vec<(f64, f64)> = (1..=HARMONICS)
        .map(|harmonic| f64::from(harmonic * teeth))
        .map_while(|order| Some((orders.prominence(order * factor, hypothesis.reach())?, order)))
        .filter(|(prominence, _)| *prominence > 0.0)
        .collect();
    prominent.sort_by(|a, b| b.0.total_cmp(&a.0));
    prominent.truncate(FOLLOWED);
    let lowest = prominent.iter().map(|(_, order)| *order).min_by(f64::total_cmp)?;
    let highest = prominent.iter().map(|(_, order)| *order).max_by(f64::total_cmp)?;
    let harmonics: Vec<Harmonic> =
        prominent.iter().map(|(_, order)| Harmonic::of(angular, *order, factor)).collect();
    let revolutions = angular.revolutions() as f64;
    // Hann's window keeps what lies beside the mesh out of the search.
    let window = |r: usize| 0.5 * (1.0 - (TAU * (r as f64 + 0.5) / revolutions).cos());
    let windowed: Vec<Harmonic> = harmonics.iter().map(|harmonic| harmonic.weighted(window)).collect();
    let steady = |by: f64| windowed.iter().map(|harmonic| harmonic.steady(by)).sum::<f64>();
    let step = 1.0 / (STEPS * revolutions * highest);
    let steps = (RANGE / (orders.bins_per_order * lowest) / step).ceil() as i32;
    let nearly: Vec<_> = windowed.iter().map(Harmonic::steady_nearly).collect();
    let steady_nearly = |by: f64| nearly.iter().map(|steady| steady(by)).sum::<f64>();
    let best_of = |steps: RangeInclusive<i32>, steady: &dyn Fn(f64) -> f64| {
        let all = steps.map(|k| (steady(f64::from(k) * step), k));
        all.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| k)
    };
    let about = best_of(-steps..=steps, &steady_nearly)?;
    let best = best_of((about - 1).max(-steps)..=(about + 1).min(steps), &steady)?;
    let near = f64::from(best) * step;
    let [below, at, above] = [near - step, near, near + step].map(steady);
    let bend = below - 2.0 * at + above;
    let by = if bend < 0.0 { near + 0.5 * step * (below - above) / bend } else { near };
    let whole = |by: f64| harmonics.iter().map(|harmonic| harmonic.steady(by)).sum::<f64>();
    let energy: f64 = harmonics.iter().map(Harmonic::energy).sum();
    if whole(by) < LEAST_STEADY * energy {
        return None;
    }
    let stated = if factor == 1.0 {
        whole(0.0)
    } else {
        let as_stated = |harmonic: &Harmonic| Harmonic::of(angular, harmonic.order, 1.0).steady(0.0);
        harmonics.iter().map(as_stated).sum()
    };
    let stands_out = |(_, order): &(f64, f64)| orders.prominence(order * (factor + by), hypothesis.reach());
    if prominent.iter().filter_map(stands_out).sum::<f64>() < LEAST_PROMINENCE {
        return None;
    }
    Some(SteadierSpeed { factor: factor + by, energy_ratio: whole(by) / stated })
}
