//! The results panel: one simulation on one page.
//!
//! In two columns, for pinion and gear, the tooth in its own plane, the tooth's face, the profile errors and the average
//! over the shaft's revolutions; below, the mesh stiffness over a gear revolution and the order spectrum. The tooth, its face and its profile
//! errors share their vertical axis: the distance from the wheel's centre along the tooth's centre line.

mod average;
mod damage;
mod errors;
mod face;
mod gearbox;
mod heading;
mod side;
mod spectrum;
mod stiffness;
mod tooth;

use meshtone::scenario::Scenario;
use meshtone::sensor::Channels;
use meshtone::wheel::WheelName;
use meshtone::{Simulation, Stages};

use crate::drawing::{Area, Canvas, NAME_LEFT, Pixel, described};
use crate::{Figure, PlotError};
use side::Side;

const HEIGHT: u32 = 1240;
/// (px) From the panel's edge to title and facts.
const EDGE: f64 = 7.0;

const LEFT: f64 = 74.0;
const COLUMN_WIDTH: f64 = 710.0;
const COLUMN_GAP: f64 = 82.0;
const FULL_WIDTH: f64 = 2.0 * COLUMN_WIDTH + COLUMN_GAP;

/// (px) From the baseline of a column's heading to its teeth.
const BELOW_HEADING: f64 = 38.0;
const TEETH_TOP: f64 = 134.0;
const TEETH_HEIGHT: f64 = 324.0;
const AVERAGES_TOP: f64 = 534.0;
const AVERAGES_HEIGHT: f64 = 168.0;
const STIFFNESS_TOP: f64 = 778.0;
const STIFFNESS_HEIGHT: f64 = 172.0;
const SPECTRUM_TOP: f64 = 1024.0;
const SPECTRUM_HEIGHT: f64 = 168.0;

const TOOTH_WIDTH: f64 = 360.0;
/// (px) Room for the names of the circles, right of the tooth.
const CIRCLE_NAMES: f64 = 50.0;
const FACE_WIDTH: f64 = 160.0;
const FACE_GAP: f64 = 14.0;
const ERRORS_WIDTH: f64 = COLUMN_WIDTH - TOOTH_WIDTH - CIRCLE_NAMES - FACE_WIDTH - FACE_GAP;

/// Draws the results panel of a simulation.
///
/// # Arguments
/// * `simulation` - what was simulated, and the kept signals, as simulated; of a pair they may be empty
///
/// # Errors
/// Signals at another sampling rate than the simulation's; of a gearbox, signals without a spectrum.
///
/// ```
/// use meshtone::scenario::{Fault, GearPair, MissingTooth, Scenario};
///
/// let mut scenario = Scenario::new(GearPair::example());
/// scenario.faults = vec![Fault::on_first_gear_tooth(MissingTooth)];
/// scenario.solver.sampling_rate_hz = 2e4;
/// let panel = meshtone_plot::panel::draw(&meshtone::simulate(&scenario)?)?;
/// assert!(panel.svg().contains("Missing tooth"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn draw(simulation: &Simulation) -> Result<Figure, PlotError> {
    let Simulation { stages, channels, .. } = simulation;
    check_rate(stages, channels)?;
    let scenario = &stages.scenario;
    if scenario.rig().is_some() {
        draw_pair(scenario, stages, channels)
    } else {
        gearbox::draw(scenario, simulation)
    }
}

fn draw_pair(scenario: &Scenario, stages: &Stages, channels: &Channels) -> Result<Figure, PlotError> {
    let (title, facts) = (heading::title(scenario, stages), heading::facts(scenario));
    let mut canvas = Canvas::page(HEIGHT, EDGE, &title, &facts);
    for (column, wheel) in WheelName::BOTH.into_iter().enumerate() {
        teeth(&mut canvas, (column_left(column), TEETH_TOP), &Side::new(stages, wheel)?);
    }
    average::draw(&mut canvas, [0, 1].map(averages_area), stages, channels);
    stiffness::draw(&mut canvas, Area::new(LEFT, STIFFNESS_TOP, FULL_WIDTH, STIFFNESS_HEIGHT), stages);
    spectrum::of_pair(
        &mut canvas,
        Area::new(LEFT, SPECTRUM_TOP, FULL_WIDTH, SPECTRUM_HEIGHT),
        stages,
        channels,
    );
    let what = "Results panel of a simulated gear pair: teeth, tooth faces, profile errors, averages over the shafts' \
                revolutions and mesh stiffness.";
    Ok(canvas.finish(&title, &described(what, &facts)))
}

fn column_left(column: usize) -> f64 {
    LEFT + column as f64 * (COLUMN_WIDTH + COLUMN_GAP)
}

fn averages_area(column: usize) -> Area {
    Area::new(column_left(column), AVERAGES_TOP, COLUMN_WIDTH, AVERAGES_HEIGHT)
}

/// A wheel's tooth, its face and its profile errors, below a heading.
fn teeth(canvas: &mut Canvas, (left, top): Pixel, side: &Side) {
    heading::column(canvas, (left, top - BELOW_HEADING), COLUMN_WIDTH, side);
    let area = |left: f64, width: f64| Area::new(left, top, width, TEETH_HEIGHT);
    let tooth = area(left, TOOTH_WIDTH);
    let (across, along) = side.view(tooth);
    tooth::draw(canvas, tooth, across, along, side);
    let face_left = tooth.right() + CIRCLE_NAMES;
    face::draw(canvas, area(face_left, FACE_WIDTH), along, side);
    errors::draw(canvas, area(face_left + FACE_WIDTH + FACE_GAP, ERRORS_WIDTH), along, side);
}

fn check_rate(stages: &Stages, channels: &Channels) -> Result<(), PlotError> {
    let (channels_hz, simulation_hz) = (channels.sampling_rate_hz, stages.time.sampling_rate_hz);
    if channels.is_empty() || (channels_hz - simulation_hz).abs() <= 1e-6 * simulation_hz {
        return Ok(());
    }
    Err(PlotError::SamplingRate { channels_hz, simulation_hz })
}
