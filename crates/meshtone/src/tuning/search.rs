//! The enhancement that fits best: a grid, then a local refinement.

use std::sync::atomic::{AtomicBool, Ordering};

use argmin::core::{CostFunction, Error, Executor, State};
use argmin::solver::neldermead::NelderMead;

use super::simulated::CasesOfDuration;
use super::{Enhancement, HybridError, Measurements, SimulatedCases};

/// Points of the global grid, by parameter.
const GRID: [usize; 3] = [24, 16, 16];
/// Coarse grid where every point costs a pass over all envelopes.
const COARSE_GRID: [usize; 3] = [12, 8, 8];
/// Starts of the refinement: this many of the grid's best points.
const STARTS: usize = 3;
const MOST_ITERATIONS: u64 = 120;
/// Of the simplex's errors, where the refinement ends.
const TOLERANCE: f64 = 1e-6;

/// A range of each of the three parameters, such as the bounds of the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnhancementBounds {
    /// (-) Least and largest width ratio.
    pub width_ratio: [f64; 2],
    /// (-) Least and largest fault-to-harmonics ratio.
    pub fault_to_harmonics_ratio: [f64; 2],
    /// (-) Least and largest noise level.
    pub noise_level: [f64; 2],
}

impl Default for EnhancementBounds {
    /// Wide enough for every rig that was tried.
    fn default() -> Self {
        Self { width_ratio: [0.05, 2.0], fault_to_harmonics_ratio: [0.2, 8.0], noise_level: [0.02, 8.0] }
    }
}

impl EnhancementBounds {
    pub(super) fn all(&self) -> [(&'static str, [f64; 2]); 3] {
        [
            ("width_ratio", self.width_ratio),
            ("fault_to_harmonics_ratio", self.fault_to_harmonics_ratio),
            ("noise_level", self.noise_level),
        ]
    }

    /// Refuses bounds that hold nothing.
    ///
    /// # Errors
    /// A bound that is not above 0 and finite; a least value above the largest.
    pub fn check(&self) -> Result<(), HybridError> {
        for (name, [least, largest]) in self.all() {
            if !(least > 0.0 && least <= largest && largest.is_finite()) {
                return Err(HybridError::Parameter {
                    name: format!("the range of {name}"),
                    value: format!("[{least}, {largest}]"),
                    allowed: "two numbers above 0, the smaller first".into(),
                });
            }
        }
        Ok(())
    }

    pub(super) fn logarithms(&self) -> [[f64; 2]; 3] {
        self.all().map(|(_, range)| range.map(f64::ln))
    }
}

/// The parameters' logarithms.
pub(super) type Point = [f64; 3];

pub(super) fn enhancement(point: Point) -> Enhancement {
    let [width_ratio, fault_to_harmonics_ratio, noise_level] = point.map(f64::exp);
    Enhancement { width_ratio, fault_to_harmonics_ratio, noise_level }
}

pub(super) fn point(enhancement: &Enhancement) -> Point {
    [enhancement.width_ratio, enhancement.fault_to_harmonics_ratio, enhancement.noise_level].map(f64::ln)
}

/// An enhancement and its error.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Fit {
    /// The parameters.
    pub enhancement: Enhancement,
    /// Mean error over cases and indicators (Eq. 7).
    pub error: f64,
}

/// What simulated cases are fitted to.
#[derive(Clone, Copy)]
pub(super) struct Target<'a> {
    pub(super) measured: &'a Measurements,
    pub(super) bounds: &'a EnhancementBounds,
    /// Set by the caller to stop.
    pub(super) cancelled: &'a AtomicBool,
}

/// The objective that is minimised: the mean error over the cases.
#[derive(Clone, Copy)]
pub(super) struct Objective<'a> {
    pub(super) simulated: &'a SimulatedCases,
    pub(super) target: Target<'a>,
    /// Weights of the cases.
    pub(super) weights: &'a [f64],
}

/// Every case weighs the same, but for one that is left out.
pub(super) fn equal_weights(cases: usize, left_out: Option<usize>) -> Vec<f64> {
    (0..cases).map(|case| if Some(case) == left_out { 0.0 } else { 1.0 }).collect()
}

impl Objective<'_> {
    pub(super) fn at(&self, point: Point) -> Result<f64, HybridError> {
        let measured = self.target.measured;
        stop_where(self.target.cancelled)?;
        let enhancement = enhancement(point);
        let at_duration = self.simulated.at_duration(measured.indicators(), enhancement.width_ratio);
        Ok(weighted_mean(self.weights, |case| case_error(measured, &at_duration, case, &enhancement)))
    }
}

fn stop_where(cancelled: &AtomicBool) -> Result<(), HybridError> {
    if cancelled.load(Ordering::Relaxed) { Err(HybridError::Cancelled) } else { Ok(()) }
}

/// Expected error of a case, the mean over the indicators.
fn case_error(
    measured: &Measurements,
    at_duration: &CasesOfDuration,
    case: usize,
    enhancement: &Enhancement,
) -> f64 {
    let mut sum = 0.0;
    at_duration.indicators(case, enhancement, |j, value| sum += measured.error(case, j, value));
    sum / measured.indicators().len() as f64
}

fn weighted_mean(weights: &[f64], of_case: impl Fn(usize) -> f64) -> f64 {
    let counting = || weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0);
    let sum: f64 = counting().map(|(case, weight)| weight * of_case(case)).sum();
    sum / counting().map(|(_, weight)| weight).sum::<f64>()
}

/// Errors of all cases over a grid of the parameters: whichever case is left out, they are the same.
pub(super) struct Grid<'a> {
    simulated: &'a SimulatedCases,
    target: Target<'a>,
    points: Vec<Point>,
    /// By point and case.
    errors: Vec<f64>,
}

impl<'a> Grid<'a> {
    pub(super) fn new(simulated: &'a SimulatedCases, target: Target<'a>) -> Result<Self, HybridError> {
        let Target { measured, bounds, cancelled } = target;
        bounds.check()?;
        let cases = simulated.differences().len();
        if cases != measured.cases() {
            return Err(HybridError::Cases { simulated: cases, measured: measured.cases() });
        }
        let costly = measured.indicators().iter().any(|indicator| indicator.is_of_envelope());
        let counts = if costly { COARSE_GRID } else { GRID };
        let ranges = bounds.logarithms();
        // One place of a parameter that is held.
        let places: [Vec<f64>; 3] = std::array::from_fn(|d| {
            let [from, to] = ranges[d];
            let count = if to > from { counts[d] } else { 1 };
            (0..count).map(|k| from + (to - from) * (k as f64 + 0.5) / count as f64).collect()
        });
        let (mut points, mut errors) = (Vec::new(), Vec::new());
        for &width in &places[0] {
            stop_where(cancelled)?;
            let at_duration = simulated.at_duration(measured.indicators(), width.exp());
            for &ratio in &places[1] {
                for &noise in &places[2] {
                    let point = [width, ratio, noise];
                    let enhancement = enhancement(point);
                    points.push(point);
                    errors.extend(
                        (0..cases).map(|case| case_error(measured, &at_duration, case, &enhancement)),
                    );
                }
            }
        }
        Ok(Self { simulated, target, points, errors })
    }

    /// The best enhancement: refined from the grid's best points.
    ///
    /// # Arguments
    /// * `left_out` - number of a case that does not count, if any
    pub(super) fn fit(&self, left_out: Option<usize>) -> Result<Fit, HybridError> {
        let weights = equal_weights(self.target.measured.cases(), left_out);
        let objective = Objective { simulated: self.simulated, target: self.target, weights: &weights };
        let ranges = self.target.bounds.logarithms();
        let steps: [f64; 3] = std::array::from_fn(|d| (ranges[d][1] - ranges[d][0]) / GRID[d] as f64);
        let mut best: Option<(f64, Point)> = None;
        for (error, start) in self.best(&weights) {
            let refined = refine(&objective, ranges, start, steps)?;
            for found in [(error, start), refined] {
                if best.is_none_or(|(least, _)| found.0 < least) {
                    best = Some(found);
                }
            }
        }
        let (error, found) = best.ok_or(HybridError::NoFit)?;
        Ok(Fit { enhancement: enhancement(found), error })
    }

    /// The points with the least mean errors.
    fn best(&self, weights: &[f64]) -> Vec<(f64, Point)> {
        let mut best: Vec<(f64, Point)> = Vec::new();
        for (&point, errors) in self.points.iter().zip(self.errors.chunks_exact(weights.len())) {
            let error = weighted_mean(weights, |case| errors[case]);
            let place = best.partition_point(|(other, _)| *other <= error);
            if place < STARTS && !error.is_nan() {
                best.insert(place, (error, point));
                best.truncate(STARTS);
            }
        }
        best
    }
}

/// Finds the enhancement with the lowest mean error: over a grid, then refined from its best points.
///
/// # Arguments
/// * `simulated` - difference signals of all cases
/// * `measured` - of the same cases
/// * `bounds` - where the parameters are searched
/// * `left_out` - number of a case that does not count, if any
/// * `cancelled` - set it to stop
///
/// # Errors
/// Bounds that hold nothing; not as many simulated cases as measured ones; nothing left to fit; [`HybridError::Cancelled`].
pub fn fit(
    simulated: &SimulatedCases,
    measured: &Measurements,
    bounds: &EnhancementBounds,
    left_out: Option<usize>,
    cancelled: &AtomicBool,
) -> Result<Fit, HybridError> {
    Grid::new(simulated, Target { measured, bounds, cancelled })?.fit(left_out)
}

/// Nelder and Mead's search from a point, within ranges; a range of no width holds its parameter.
///
/// Only the free parameters make the simplex, since one with a held parameter would be flat. The method knows no limits: a vertex beyond
/// them costs what the nearest point within costs, and more the farther it is, which leads the simplex back.
pub(super) fn refine(
    objective: &Objective,
    ranges: [[f64; 2]; 3],
    start: Point,
    steps: [f64; 3],
) -> Result<(f64, Point), HybridError> {
    let free: Vec<usize> = (0..3).filter(|&d| ranges[d][1] > ranges[d][0]).collect();
    let clamped =
        |point: Point| -> Point { std::array::from_fn(|d| point[d].clamp(ranges[d][0], ranges[d][1])) };
    let held = clamped(start);
    if free.is_empty() {
        return Ok((objective.at(held)?, held));
    }
    let whole = |vertex: &[f64]| {
        let mut point = held;
        for (&d, &value) in free.iter().zip(vertex) {
            point[d] = value;
        }
        point
    };
    let first: Vec<f64> = free.iter().map(|&d| held[d]).collect();
    let simplex = std::iter::once(first.clone())
        .chain(free.iter().enumerate().map(|(n, &d)| {
            let mut vertex = first.clone();
            // Towards the range's middle, so that no vertex lies outside.
            let middle = 0.5 * (ranges[d][0] + ranges[d][1]);
            vertex[n] += if vertex[n] < middle { steps[d] } else { -steps[d] };
            vertex
        }))
        .collect();
    let cost = Cost(|vertex: &[f64]| {
        let point = whole(vertex);
        let inside = clamped(point);
        let outside: f64 = (0..3).map(|d| (point[d] - inside[d]).abs()).sum();
        Ok(objective.at(inside)? + outside)
    });
    let solver = NelderMead::new(simplex).with_sd_tolerance(TOLERANCE).map_err(|_| HybridError::NoFit)?;
    let result = Executor::new(cost, solver)
        .configure(|state| state.max_iters(MOST_ITERATIONS))
        .run()
        .map_err(|error| error.downcast::<HybridError>().unwrap_or(HybridError::NoFit))?;
    let state = result.state();
    let vertex = state.get_best_param().ok_or(HybridError::NoFit)?;
    let inside = clamped(whole(vertex));
    Ok((objective.at(inside)?, inside))
}

struct Cost<F>(F);

impl<F: Fn(&[f64]) -> Result<f64, HybridError>> CostFunction for Cost<F> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, vertex: &Vec<f64>) -> Result<f64, Error> {
        (self.0)(vertex).map_err(Error::from)
    }
}
