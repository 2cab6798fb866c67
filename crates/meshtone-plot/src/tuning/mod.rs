//! An experiment of the hybrid stage on one page.
//!
//! Above each other and with the cases as their common horizontal axis stand the indicators, the error of each case, and the difference
//! signals of the original simulation, enhanced and, where recordings or difference signals were given, measured: what Figure 6 of
//! arXiv:2410.05073 compares.

mod cases;
mod data;
mod differences;
mod heading;
mod symbols;

use meshtone::tuning::{Experiment, ExperimentResult};

use crate::drawing::{Area, Canvas, WIDTH};
use crate::{Figure, PlotError};
use data::Data;

/// With two rows of difference signals; each more makes the figure higher by [`MORE_SIGNALS`].
const HEIGHT: u32 = 1000;
const MORE_SIGNALS: u32 = 136;

const LEFT: f64 = 74.0;
const CASES_WIDTH: f64 = 1500.0;
/// (px) From the frame of a plot to the baseline of its vertical axis' name.
const NAME_LEFT: f64 = 48.0;
/// (px) Left edge of title and facts.
const TEXT_LEFT: f64 = 15.0;

/// (px) From a heading's baseline to the rule below it.
const RULE_BELOW: f64 = 6.0;
const HEADING_BASELINE: f64 = 125.0;
/// (px) From a heading's baseline to the frame of the first plot below it, which has a title.
const BELOW_HEADING: f64 = 38.0;
/// (px) Lower edge of the lowest plots, with two rows of difference signals.
const BOTTOM: f64 = 950.0;

/// (px) From the last line of the cases' names to the next heading's baseline.
const BELOW_LABELS: f64 = 36.0;
const DIFFERENCES_HEIGHT: f64 = 108.0;
/// (px) Between two rows of difference signals: the lower one's title.
const DIFFERENCES_GAP: f64 = 28.0;
/// (px) Greatest height of a plot of an indicator, and room for the title above the next one.
const TALLEST: f64 = 173.0;
const TITLE_HEIGHT: f64 = 27.0;

/// Draws an experiment of the hybrid stage: what was measured, simulated and enhanced.
///
/// # Arguments
/// * `experiment` - what was tuned
/// * `result` - of that experiment
/// * `title` - what stands above the figure
///
/// # Errors
/// A result of another number of cases than the experiment's; signals that cannot be enhanced.
///
/// ```
/// use meshtone::tuning::*;
/// use meshtone::scenario::{Fault, GearPair, MissingTooth, Scenario};
///
/// let case = |label: &str, faults: Vec<Fault>| Case {
///     label: label.into(),
///     severity: faults.len() as f64,
///     faults,
/// };
/// let mut base = Scenario::new(GearPair::example());
/// base.solver.sampling_rate_hz = 25e3;
/// let experiment = Experiment {
///     base,
///     cases: vec![
///         case("healthy", vec![]),
///         case("missing tooth", vec![Fault::on_first_gear_tooth(MissingTooth)]),
///     ],
///     chain: DifferenceChain::new(25e3),
///     measured: Measurements::from_compared(
///         vec![TuningIndicator::Rms],
///         vec![vec![vec![-0.02, 0.0, 0.03]], vec![vec![0.7, 0.72, 0.75]]],
///     )?,
///     bounds: EnhancementBounds::default(),
///     keys: Vec::new(),
///     candidates: 0,
///     seed: 1,
/// };
/// let control = ExperimentControl { progress: &|_, _| (), cancelled: &false.into() };
/// let result = run_experiment(&experiment, &control)?;
/// let figure = meshtone_plot::tuning_figure(&experiment, &result, "A rig with a missing tooth")?;
/// assert!(figure.labels().iter().any(|label| label.text == "missing tooth"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn tuning_figure(
    experiment: &Experiment,
    result: &ExperimentResult,
    title: &str,
) -> Result<Figure, PlotError> {
    let data = Data::new(experiment, result)?;
    let signals = differences::rows(&data);
    let more = MORE_SIGNALS * (signals as u32).saturating_sub(2);
    let figure_bottom = BOTTOM + f64::from(more);
    let mut canvas = Canvas::new(WIDTH, HEIGHT + more);
    heading::draw(&mut canvas, title, &data);

    // Error of each case below the indicators.
    let rows = data.indicators().len() + 1;
    let labels = cases::labels_height(CASES_WIDTH, &data);
    let first_top = HEADING_BASELINE + BELOW_HEADING;
    let differences = 2.0 * DIFFERENCES_HEIGHT + DIFFERENCES_GAP + BELOW_HEADING + BELOW_LABELS;
    let room = BOTTOM - differences - labels - first_top;
    let areas = Area::new(LEFT, first_top, CASES_WIDTH, room);
    let areas: Vec<Area> = areas.grid([1, rows], [0.0, TITLE_HEIGHT], TALLEST).collect();
    let bottom = areas.last().map_or(first_top, Area::bottom);
    canvas.section((LEFT, HEADING_BASELINE), CASES_WIDTH, "Indicators of the difference signal", RULE_BELOW);
    cases::draw(&mut canvas, &areas, &data);

    let baseline = bottom + labels + BELOW_LABELS;
    canvas.section((LEFT, baseline), CASES_WIDTH, &differences::heading(&data), RULE_BELOW);
    let top = baseline + BELOW_HEADING;
    let areas = Area::new(LEFT, top, CASES_WIDTH, figure_bottom - top);
    let areas: Vec<Area> = areas.grid([1, signals], [0.0, DIFFERENCES_GAP], f64::INFINITY).collect();
    differences::draw(&mut canvas, &areas, &data);

    Ok(canvas.finish(title, &heading::description(&data)))
}
