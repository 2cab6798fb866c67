//! The panel of a gearbox: the train from the front and from above, damaged wheels, the spectrum in orders of the input.

use std::f64::consts::TAU;

use meshtone::scenario::{Scenario, ScenarioWheel};
use meshtone::signal::{
    AngularSettings, AngularSignal, GearTrain, ShaftPhase, SignalError, StatedTurning, SynchronousAverage,
    TrainRecording, TrainTurning, angular_resample,
};
use meshtone::{Simulation, Stages};

use super::side::Side;
use super::spectrum::{self, InputSpectrum};
use super::{
    BELOW_HEADING, CIRCLE_NAMES, COLUMN_GAP, COLUMN_WIDTH, EDGE, FULL_WIDTH, LEFT, NAME_LEFT, TEETH_HEIGHT,
    column_left, heading, teeth, tooth,
};
use crate::damaged_tooth::{self, DamagedTooth};
use crate::drawing::{
    Anchor, Area, Axes, Canvas, Fill, Pixel, Stroke, TextStyle, Ticks, axes, capitalised, colour, described,
    number, over,
};
use crate::{Figure, PlotError};

const TRAIN_TOP: f64 = 118.0;
const TRAIN_HEIGHT: f64 = 300.0;
/// (px) From the bottom of a row to the top of the next.
const ROW_GAP: f64 = 86.0;
/// (px) The same where the next has a heading.
const HEADING_GAP: f64 = 120.0;
const CURVES_HEIGHT: f64 = 150.0;
const SPECTRUM_HEIGHT: f64 = 200.0;
/// (px) Below the last row.
const FOOT: f64 = 62.0;

const OUTLINE: Stroke = Stroke::solid(colour::INK, 1.2);
const SHAFT: Stroke = Stroke::solid(colour::MUTED, 1.0);
const CURVE: Stroke = Stroke::solid(colour::BLUE, 1.1);
const DAMAGED: Fill = Fill::tint(colour::VERMILLION, 0.3);
const WHEEL: Fill = Fill::solid(colour::STEEL);

/// Draws the results panel of a gearbox's simulation.
///
/// # Arguments
/// * `gearbox` - what was simulated
/// * `simulation` - its stages and signals
///
/// # Errors
/// Signals without a spectrum.
pub(super) fn draw(gearbox: &Scenario, simulation: &Simulation) -> Result<Figure, PlotError> {
    let stages = &simulation.stages;
    let wheels = Wheels::of(gearbox, stages)?;
    let wheels_top = TRAIN_TOP + TRAIN_HEIGHT;
    let spectrum_top = wheels_top + wheels.height() + ROW_GAP;
    let (title, facts) = (title(gearbox), facts(gearbox, stages));
    let mut canvas = Canvas::page((spectrum_top + SPECTRUM_HEIGHT + FOOT) as u32, EDGE, &title, &facts);
    let half = (FULL_WIDTH - COLUMN_GAP) / 2.0;
    let train = drawn_wheels(gearbox, stages);
    let [front, above] =
        [LEFT, LEFT + half + COLUMN_GAP].map(|left| Area::new(left, TRAIN_TOP, half, TRAIN_HEIGHT));
    draw_front(&mut canvas, front, (gearbox, stages), &train);
    draw_above(&mut canvas, above, (gearbox, stages), &train);
    wheels.draw(&mut canvas, wheels_top, gearbox, simulation);
    spectrum(&mut canvas, Area::new(LEFT, spectrum_top, FULL_WIDTH, SPECTRUM_HEIGHT), (gearbox, simulation));
    let what = "Results panel of a simulated gearbox: the train from the front and from above, teeth, mesh stiffness and \
                averages of its wheels, and the spectrum of a sensor in orders of the input.";
    Ok(canvas.finish(&title, &described(what, &facts)))
}

fn title(gearbox: &Scenario) -> String {
    let faults = gearbox.faults.iter().map(|of| {
        let kind = of.damage.kind().replace('-', " ");
        format!("{kind} on {} of {}", of.tooth.in_words(), of.wheel)
    });
    let spalls = gearbox.bearings().iter().flat_map(|bearing| {
        let at = bearing.seat_name();
        bearing
            .defect
            .iter()
            .map(move |of| format!("{} spall on bearing {at}", of.race.kind().replace('-', " ")))
    });
    let faults = capitalised(&faults.chain(spalls).collect::<Vec<_>>().join(", "));
    if faults.is_empty() { "Healthy gearbox".to_owned() } else { faults }
}

fn facts(gearbox: &Scenario, stages: &Stages) -> Vec<String> {
    let stage = |mesh: usize| {
        let gears = &stages.layout.gears[mesh];
        format!(
            "{}: {}/{} teeth, {} mm{}",
            gearbox.meshes[mesh].name(),
            gears.pinion_teeth,
            gears.gear_teeth,
            heading::module(gears),
            heading::helix(gears).map_or_else(String::new, |helix| format!(", {helix}"))
        )
    };
    let drive = &gearbox.operation;
    (0..gearbox.meshes.len())
        .map(stage)
        .chain([
            format!("input {} Hz", number(drive.pinion_speed_hz)),
            format!("brake torque {} N·m", number(drive.brake_torque_nm)),
            format!("hunting-tooth period {} revolutions of the input", stages.layout.cycle_revolutions()),
        ])
        .collect()
}

/// (px) From the axis of a shaft to the edge of a bearing.
const BEARING_PX: f64 = 9.0;

/// A wheel on the drawing.
struct DrawnWheel<'a> {
    name: &'a str,
    /// (mm) Axis, and middle of the face.
    x: f64,
    y: f64,
    z: f64,
    radius: f64,
    width: f64,
    is_damaged: bool,
    is_ring: bool,
}

/// All wheels of the train.
fn drawn_wheels<'a>(gearbox: &'a Scenario, stages: &Stages) -> Vec<DrawnWheel<'a>> {
    let layout = &stages.layout;
    let drawn = |(number, wheel): (usize, &'a ScenarioWheel)| {
        let ScenarioWheel { name, teeth, face_width_mm, .. } = wheel;
        let (mesh, _) = layout.mesh_of(number)?;
        let shaft = layout.shaft_of_wheel[number];
        let [x, y] = layout.positions_m[shaft].map(|m| m * 1e3);
        let z = layout.z_mm(gearbox, number);
        let radius = layout.gears[mesh].transverse_module_mm() * f64::from(*teeth) / 2.0;
        let is_damaged = gearbox.faults.iter().any(|fault| fault.wheel == *name);
        let is_ring = layout.is_ring(number);
        Some(DrawnWheel { name, x, y, z, radius, width: *face_width_mm, is_damaged, is_ring })
    };
    gearbox.wheels.iter().enumerate().filter_map(drawn).collect()
}

/// (-) Outer radius of a ring over that of its pitch circle, as it is drawn.
const RIM: f64 = 1.1;

/// From where to where all wheels reach.
fn extent(wheels: &[DrawnWheel], of: fn(&DrawnWheel) -> f64) -> [f64; 2] {
    let radius = |wheel: &DrawnWheel| wheel.radius * if wheel.is_ring { RIM } else { 1.0 };
    let low = wheels.iter().map(|wheel| of(wheel) - radius(wheel)).fold(f64::INFINITY, f64::min);
    let high = wheels.iter().map(|wheel| of(wheel) + radius(wheel)).fold(f64::NEG_INFINITY, f64::max);
    [low, high]
}

/// A rectangle by its middle and half its sides.
fn rectangle(axes: &Axes, (z, x): (f64, f64), (half_z, half_x): (f64, f64)) -> [Pixel; 4] {
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(a, b)| axes.at(z + a * half_z, x + b * half_x))
}

/// Pitch circles and shafts across the axes.
fn draw_front(
    canvas: &mut Canvas,
    area: Area,
    (gearbox, stages): (&Scenario, &Stages),
    wheels: &[DrawnWheel],
) {
    let (x, y) = equal_scales(area, extent(wheels, |wheel| wheel.x), extent(wheels, |wheel| wheel.y));
    let axes = Axes::titled(canvas, area, x, y, "Train from the front, pitch circles");
    axes.x_axis(canvas, &Ticks::nice(x[0], x[1], 10), "x (mm)");
    axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 6), "y (mm)", NAME_LEFT);
    // The farther ones first.
    let mut order: Vec<&DrawnWheel> = wheels.iter().collect();
    order.sort_by(|a, b| b.radius.total_cmp(&a.radius));
    for wheel in order {
        let fill = if wheel.is_damaged { DAMAGED } else { Fill::tint(colour::STEEL, 0.7) };
        let circle = |radius: f64| circle(&axes, wheel.x, wheel.y, radius);
        if wheel.is_ring {
            canvas.outlined(&circle(RIM * wheel.radius), OUTLINE, fill);
            canvas.outlined(&circle(wheel.radius), OUTLINE, Fill::solid(colour::WHITE));
        } else {
            canvas.outlined(&circle(wheel.radius), OUTLINE, fill);
        }
    }
    for (shaft, [x_m, y_m]) in gearbox.shafts().iter().zip(&stages.layout.positions_m) {
        let radius = shaft.radius_at_mm(0.5);
        canvas.outlined(&circle(&axes, x_m * 1e3, y_m * 1e3, radius), SHAFT, Fill::solid(colour::WHITE));
    }
    for wheel in wheels {
        // Inside a ring there are its planets.
        let part = if wheel.is_ring { 0.9 } else { 0.72 };
        let at = axes.at(wheel.x, wheel.y + part * wheel.radius);
        canvas.text(at, wheel.name, TextStyle::NOTE.anchored(Anchor::Middle).with_halo());
    }
    axes.frame(canvas);
}

/// Shafts, wheels and bearings along the axes.
fn draw_above(
    canvas: &mut Canvas,
    area: Area,
    (gearbox, stages): (&Scenario, &Stages),
    wheels: &[DrawnWheel],
) {
    let layout = &stages.layout;
    let ends_mm = |at: f64| gearbox.shafts().iter().map(move |shaft| shaft.z_mm(at));
    let (first, last) =
        (ends_mm(0.0).fold(f64::INFINITY, f64::min), ends_mm(1.0).fold(f64::NEG_INFINITY, f64::max));
    let longest = last - first;
    let [low, high] = extent(wheels, |wheel| wheel.x);
    let margin = 0.05 * (high - low);
    let (z, x) = ([first - 0.12 * longest, last + 0.12 * longest], [low - margin, high + margin]);
    let axes = Axes::titled(canvas, area, z, x, "From above");
    axes.x_axis(canvas, &Ticks::nice(z[0], z[1], 10), "z (mm)");
    axes.y_axis(canvas, &Ticks::nice(x[0], x[1], 6), "x (mm)", NAME_LEFT);
    for (shaft, [x_m, _]) in gearbox.shafts().iter().zip(&layout.positions_m) {
        let (x, radius, half) = (x_m * 1e3, shaft.radius_at_mm(0.5), shaft.length_mm / 2.0);
        let middle = shaft.z_mm(0.5);
        canvas.outlined(&rectangle(&axes, (middle, x), (half, radius)), SHAFT, Fill::solid(colour::WHITE));
        let coupled = match shaft.couples_to.name() {
            "nothing" => String::new(),
            to => format!(", {to}"),
        };
        let style = TextStyle::NOTE.coloured(colour::MUTED).with_halo();
        // Above the bearings.
        let at = (axes.px(shaft.start_mm - 0.11 * longest), axes.py(x) - BEARING_PX - 5.0);
        canvas.text(at, &format!("{}{coupled}", shaft.name), style);
    }
    for wheel in wheels {
        let fill = if wheel.is_damaged { DAMAGED } else { WHEEL };
        let style = TextStyle::NOTE.anchored(Anchor::Middle).with_halo();
        if wheel.is_ring {
            // Its planets are seen between both sides of its rim.
            let (middle, half) = ((RIM + 1.0) / 2.0 * wheel.radius, (RIM - 1.0) / 2.0 * wheel.radius);
            for x in [-middle, middle] {
                let side = rectangle(&axes, (wheel.z, wheel.x + x), (wheel.width / 2.0, half));
                canvas.outlined(&side, OUTLINE, fill);
            }
            canvas.text(axes.at(wheel.z, wheel.x + middle), wheel.name, style);
            continue;
        }
        let outline = rectangle(&axes, (wheel.z, wheel.x), (wheel.width / 2.0, wheel.radius));
        canvas.outlined(&outline, OUTLINE, fill);
        canvas.text(axes.at(wheel.z, wheel.x), wheel.name, style);
    }
    // Those of planets are inside of these.
    let bearings = gearbox.bearings().iter().zip(&layout.shaft_of_bearing);
    for (bearing, shaft) in bearings.filter(|(_, shaft)| **shaft < gearbox.shafts().len()) {
        let (shaft, [x_m, _]) = (&gearbox.shafts()[*shaft], layout.positions_m[*shaft]);
        let (x, y) = axes.at(shaft.z_mm(bearing.at), x_m * 1e3);
        let (top, bottom) = (y - BEARING_PX, y + BEARING_PX);
        let corners = [(x - 5.0, top), (x + 5.0, top), (x + 5.0, bottom), (x - 5.0, bottom)];
        canvas.outlined(&corners, OUTLINE, Fill::hatch(colour::INK));
    }
    axes.frame(canvas);
}

/// Ranges that show both extents at the same scale.
fn equal_scales(area: Area, x: [f64; 2], y: [f64; 2]) -> ([f64; 2], [f64; 2]) {
    let size = |range: [f64; 2]| (range[1] - range[0]) * 1.08;
    let mm_per_px = (size(x) / area.width).max(size(y) / area.height);
    let about = |range: [f64; 2], px: f64| {
        let middle = (range[0] + range[1]) / 2.0;
        [middle - mm_per_px * px / 2.0, middle + mm_per_px * px / 2.0]
    };
    (about(x, area.width), about(y, area.height))
}

fn circle(axes: &Axes, x: f64, y: f64, radius: f64) -> Vec<Pixel> {
    const CORNERS: usize = 90;
    let angle = |n: usize| TAU * n as f64 / CORNERS as f64;
    (0..CORNERS).map(|n| axes.at(x + radius * angle(n).cos(), y + radius * angle(n).sin())).collect()
}

/// Most wheels that have room.
const MOST_WHEELS: usize = 4;
/// Most wheels of which face, profile errors and stiffness have room too.
const MOST_WHOLE: usize = 2;

/// The wheels that have a column each: those that are damaged, or the first ones where none is.
struct Wheels<'a> {
    /// Their numbers.
    numbers: Vec<usize>,
    /// The damaged wheels' teeth.
    damaged: Vec<Side<'a>>,
}

impl<'a> Wheels<'a> {
    fn of(gearbox: &Scenario, stages: &'a Stages) -> Result<Self, PlotError> {
        let is_damaged =
            |number: &usize| gearbox.faults.iter().any(|fault| fault.wheel == gearbox.wheels[*number].name);
        let damaged: Vec<usize> = (0..gearbox.wheels.len()).filter(is_damaged).collect();
        let sides = damaged.iter().take(MOST_WHEELS);
        let sides = sides
            .filter_map(|number| Side::of_gearbox(gearbox, stages, *number))
            .collect::<Result<_, _>>()?;
        let first = || stages.layout.wheels_of_mesh.iter().map(|wheels| wheels[1]).take(MOST_WHOLE).collect();
        Ok(Self { numbers: if damaged.is_empty() { first() } else { damaged }, damaged: sides })
    }

    /// (px) Height of all that is drawn of them, with the gap above it.
    fn height(&self) -> f64 {
        match self.damaged.len() {
            0 => ROW_GAP + CURVES_HEIGHT,
            1 => HEADING_GAP + TEETH_HEIGHT,
            _ => HEADING_GAP + TEETH_HEIGHT + ROW_GAP + CURVES_HEIGHT,
        }
    }

    /// Draws a column for each: its first damaged tooth as a pair's, the stiffness of its mesh and the average of the first sensor's signal,
    /// both over a revolution of it. One column leaves room for the curves beside the tooth; of more than two only tooth and average are
    /// drawn.
    fn draw(&self, canvas: &mut Canvas, above: f64, gearbox: &Scenario, simulation: &Simulation) {
        let teeth_top = above + HEADING_GAP;
        let below_teeth = if self.damaged.is_empty() { above } else { teeth_top + TEETH_HEIGHT };
        let curves = Area::new(LEFT, below_teeth + ROW_GAP, FULL_WIDTH, CURVES_HEIGHT);
        let whole = self.numbers.len() <= MOST_WHOLE;
        let each = if whole { 2 } else { 1 };
        let columns = self.numbers.len().clamp(1, MOST_WHEELS);
        let areas: Vec<Area> = match &self.damaged[..] {
            [_] => {
                let beside = Area::new(column_left(1), teeth_top, COLUMN_WIDTH, TEETH_HEIGHT);
                beside.grid([1, 2], [0.0, ROW_GAP], (TEETH_HEIGHT - ROW_GAP) / 2.0).collect()
            }
            _ => curves.grid([each * columns, 1], [COLUMN_GAP, 0.0], CURVES_HEIGHT).collect(),
        };
        for (column, side) in self.damaged.iter().enumerate() {
            if whole {
                teeth(canvas, (column_left(column), teeth_top), side);
            } else {
                let Area { left, width, .. } = areas[column];
                heading::column(canvas, (left, teeth_top - BELOW_HEADING), width, side);
                let area = Area::new(left, teeth_top, width - CIRCLE_NAMES, TEETH_HEIGHT);
                let (across, along) = side.view(area);
                tooth::draw(canvas, area, across, along, side);
            }
        }
        for (wheel, areas) in self.numbers.iter().zip(areas.chunks(each)) {
            if let [area, _] = areas {
                stiffness(canvas, *area, (gearbox, &simulation.stages), *wheel);
            }
            average(canvas, areas[each - 1], (gearbox, simulation), *wheel);
        }
        if let Some(more @ 1..) = self.numbers.len().checked_sub(MOST_WHEELS) {
            let wheels = if more == 1 { "wheel is" } else { "wheels are" };
            let text = format!("{more} more damaged {wheels} in the summary");
            canvas.text((curves.right(), curves.top - 24.0), &text, TextStyle::NOTE.anchored(Anchor::End));
        }
    }
}

/// Tints the turns of a wheel's damaged teeth, from where each enters contact.
fn tint(canvas: &mut Canvas, axes: &Axes, stages: &Stages, wheel: usize, pitch: f64) {
    let Some((mesh, side)) = stages.layout.mesh_of(wheel) else { return };
    let damaged = DamagedTooth::of_pair(&stages.pairs[mesh], side);
    let teeth = stages.layout.gears[mesh].teeth(side);
    damaged_tooth::tint(canvas, axes, damaged_tooth::marked(&damaged, teeth), teeth, pitch);
}

fn stiffness(canvas: &mut Canvas, area: Area, (gearbox, stages): (&Scenario, &Stages), wheel: usize) {
    let layout = &stages.layout;
    let Some((mesh, _)) = layout.mesh_of(wheel) else { return };
    let (tables, teeth) = (&stages.meshes[mesh], gearbox.wheels[wheel].teeth as usize);
    let stiffness: Vec<f64> = tables.stiffness_n_per_mm(0..teeth).iter().map(|of_mm| 1e-3 * of_mm).collect();
    let y = axes::range(stiffness.iter().copied(), 0.08);
    let title =
        format!("Stiffness of {} over a turn of {}", gearbox.meshes[mesh].name(), gearbox.wheels[wheel].name);
    let axes = Axes::titled(canvas, area, [0.0, teeth as f64], y, &title);
    tint(canvas, &axes, stages, wheel, 1.0);
    let name = format!("Pitches since the first tooth of {} enters contact", gearbox.wheels[wheel].name);
    axes.x_axis(canvas, &Ticks::whole(0.0, teeth as f64, 8), &name);
    axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 5), "Stiffness (N/µm)", NAME_LEFT);
    axes.line(canvas, over(axes.x, &stiffness), CURVE);
    axes.frame(canvas);
}

fn average(canvas: &mut Canvas, area: Area, (gearbox, simulation): (&Scenario, &Simulation), wheel: usize) {
    let (stages, name) = (&simulation.stages, &gearbox.wheels[wheel].name);
    let average = over_wheel_angle(gearbox, simulation, wheel);
    let values = average.as_ref().map_or(&[][..], |average| &average.values);
    let y = axes::range(values.iter().copied(), 0.06);
    let title = match average.as_ref().map_or(0, |average| average.revolutions) {
        0 => format!("Average over the revolutions of {name}"),
        1 => format!("One revolution of {name}"),
        revolutions => format!("Average of {revolutions} revolutions of {name}"),
    };
    let axes = Axes::titled(canvas, area, [0.0, 360.0], y, &title);
    tint(canvas, &axes, stages, wheel, 360.0 / f64::from(gearbox.wheels[wheel].teeth));
    axes.x_axis(canvas, &Ticks::every(90.0, 0.0, 360.0), "Angle since its first tooth enters contact (°)");
    axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 5), "Acceleration (g)", NAME_LEFT);
    match &average {
        Ok(_) => axes.line(canvas, over(axes.x, values), CURVE),
        Err(error) => axes.note(canvas, spectrum::note(error)),
    }
    axes.frame(canvas);
}

/// The average of the first sensor's signal over the revolutions of a wheel.
fn over_wheel_angle(
    gearbox: &Scenario,
    simulation: &Simulation,
    wheel: usize,
) -> Result<SynchronousAverage, SignalError> {
    let first = simulation.channels.signals.first();
    let channel = first.map_or("", |signal| &signal.name);
    let train = GearTrain::of_stages(&simulation.stages).at_sensor(gearbox, channel);
    let turning = TrainTurning::Shaft {
        shaft: train.input(),
        phase: input_phase(gearbox, simulation)?,
        stated: StatedTurning::Other,
    };
    let signal = first.map_or(&[][..], |signal| &signal.values);
    let sampling_rate_hz = simulation.channels.sampling_rate_hz;
    TrainRecording { signal, sampling_rate_hz, train: &train, turning: &turning }
        .average(wheel, &AngularSettings::default())
}

/// The phase of the input at the kept samples.
fn input_phase(gearbox: &Scenario, simulation: &Simulation) -> Result<ShaftPhase, SignalError> {
    let channels = &simulation.channels;
    ShaftPhase::of_simulated_input(gearbox, channels.start_s, channels.len())
}

/// The spectrum of the first sensor, with the orders of all meshes and shafts. Where the speed changes it is of the signal over the angle of the
/// input.
fn spectrum(canvas: &mut Canvas, area: Area, (gearbox, simulation): (&Scenario, &Simulation)) {
    let (stages, channels) = (&simulation.stages, &simulation.channels);
    let Some(signal) = channels.signals.first() else { return };
    let angular = if stages.is_steady() {
        let points_per_revolution = stages.time.samples_per_pinion_revolution;
        let nyquist_order = points_per_revolution as f64 / 2.0;
        let values = signal.values.clone();
        Ok(AngularSignal { points_per_revolution, start_rev: 0.0, nyquist_order, values })
    } else {
        input_phase(gearbox, simulation)
            .and_then(|phase| angular_resample(&signal.values, &phase, &AngularSettings::default()))
            .map_err(|error| spectrum::note(&error))
    };
    let meshes = gearbox.meshes.iter().zip(&stages.meshes);
    let spectrum = InputSpectrum {
        quantity: (&signal.name.trim_end_matches("_g").replace('_', " "), signal.unit),
        shaft: "input",
        angular,
        shafts: stages.layout.ratios.iter().map(|ratio| ratio.value()).collect(),
        meshes: meshes.map(|(mesh, tables)| (mesh.name(), tables.turning.pitches_per_revolution)).collect(),
    };
    spectrum.draw(canvas, area);
}
