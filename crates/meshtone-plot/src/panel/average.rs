//! The first sensor's signal, or the vertical acceleration, averaged over the revolutions of either shaft.

use meshtone::Stages;
use meshtone::sensor::{Channels, SignalSource};
use meshtone::signal::{ChainSettings, SimulatedShafts};
use meshtone::wheel::WheelName;

use super::damage;
use crate::damaged_tooth::{self, DamagedTooth};
use crate::drawing::{Area, Axes, Canvas, Sample, Stroke, Ticks, axes, capitalised, colour, over};

pub(super) const CURVE: Stroke = Stroke::solid(colour::BLUE, 1.2);
const SECOND_CURVE: Stroke = Stroke::solid(colour::GREEN, 1.4);
const MARGIN: f64 = 0.06;

/// Draws both averages on the same scale; or, where the speed changes and nothing can be averaged revolution by
/// revolution, the signal and the speeds over time.
pub(super) fn draw(canvas: &mut Canvas, areas: [Area; 2], stages: &Stages, channels: &Channels) {
    if stages.scenario.operation.speed_profile_hz.is_some() {
        over_time(canvas, areas, channels);
        return;
    }
    let shafts = SimulatedShafts::of_stages(stages, channels.start_s, channels.len());
    let (quantity, signal) = leading(channels);
    let quantity = capitalised(&quantity);
    // Where there is no whole revolution there is no average.
    let average = |shaft| shafts.average(signal, shaft, &ChainSettings::default()).ok();
    let averages = WheelName::BOTH
        .map(|shaft| average(shaft).map_or_else(Default::default, |of| (of.values, of.revolutions)));
    let values = averages.iter().flat_map(|(values, _)| values.iter().copied());
    let y = axes::range(values, MARGIN);
    for (column, (values, revolutions)) in averages.iter().enumerate() {
        let wheel = WheelName::BOTH[column];
        let teeth = stages.layout.gears[0].teeth(wheel);
        let damaged = DamagedTooth::of_stages(stages, wheel);
        let marked = damaged_tooth::marked(&damaged, teeth);
        let name = wheel.name();
        let title = match revolutions {
            0 => format!("Average over the {name}’s revolutions"),
            1 => format!("One revolution of the {name}"),
            count => format!("Average of {count} {name} revolutions"),
        };
        let axes = Axes::titled(canvas, areas[column], [0.0, 360.0], y, &title);
        if let Some(text) = damaged_tooth::in_words(&[(name, marked)]) {
            axes.legend(canvas, &[(Sample::Area(damaged_tooth::TINT), &text)]);
        }
        damaged_tooth::tint(canvas, &axes, marked, teeth, 360.0 / f64::from(teeth.max(1)));
        let since =
            format!("{} angle since its {} (°)", capitalised(name), damage::start_of_revolution(&damaged));
        axes.x_axis(canvas, &Ticks::every(45.0, 0.0, 360.0), &since);
        axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 5), &format!("{quantity} (g)"), super::NAME_LEFT);
        curve(canvas, &axes, values, channels);
        axes.frame(canvas);
    }
}

/// Most letters of a name for which a vertical axis has room.
const LONGEST_NAME: usize = 28;

/// What the main signal shows, as a sentence has it, and its samples: a sensor's is its name as the user wrote it, where there is room for it.
pub(super) fn leading(channels: &Channels) -> (String, &[f64]) {
    let signal = channels.leading();
    let quantity = match signal.filter(|signal| matches!(signal.source, SignalSource::Sensor(_))) {
        Some(sensor) => match sensor.name.strip_suffix("_g").unwrap_or(&sensor.name) {
            name if name.len() > LONGEST_NAME => "first sensor".to_owned(),
            name => name.replace('_', " "),
        },
        None => "vertical acceleration".to_owned(),
    };
    (quantity, signal.map_or(&[], |signal| &signal.values))
}

/// Draws an average from the angle at which the first tooth enters contact.
fn curve(canvas: &mut Canvas, axes: &Axes, values: &[f64], channels: &Channels) {
    match (values, channels.is_empty()) {
        ([], true) => axes.note(canvas, "no samples were kept"),
        ([], false) => axes.note(canvas, "the kept signal is shorter than a revolution"),
        _ => axes.line(canvas, over(axes.x, values), CURVE),
    }
}

fn over_time(canvas: &mut Canvas, areas: [Area; 2], channels: &Channels) {
    let time = match channels.len() {
        0 | 1 => [channels.start_s, channels.start_s + 1.0],
        samples => [channels.time_s(0), channels.time_s(samples - 1)],
    };
    let time = axes::time_range(time);
    let (quantity, signal) = leading(channels);
    let quantity = capitalised(&quantity);
    let acceleration = [(signal, CURVE)];
    let speeds = [
        (channels.of(SignalSource::ShaftSpeed(0)), CURVE),
        (channels.of(SignalSource::ShaftSpeed(1)), SECOND_CURVE),
    ];
    let title = format!("{quantity}, at changing speed");
    signals(canvas, areas[0], time, &title, &format!("{quantity} (g)"), &acceleration);
    let axes = signals(canvas, areas[1], time, "Speed of both shafts", "Speed (Hz)", &speeds);
    axes.legend(canvas, &[(Sample::Line(CURVE), "pinion"), (Sample::Line(SECOND_CURVE), "gear")]);
}

/// Signals of all samples over time.
fn signals(
    canvas: &mut Canvas,
    area: Area,
    time: [f64; 2],
    title: &str,
    name: &str,
    curves: &[(&[f64], Stroke)],
) -> Axes {
    let y = axes::range(curves.iter().flat_map(|(values, _)| values.iter().copied()), MARGIN);
    let axes = Axes::titled(canvas, area, time, y, title);
    axes.x_axis(canvas, &Ticks::nice(time[0], time[1], 10), "Time since the start of the simulation (s)");
    axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 5), name, super::NAME_LEFT);
    for (values, stroke) in curves {
        let step = (time[1] - time[0]) / values.len().saturating_sub(1).max(1) as f64;
        let points = values.iter().enumerate().map(|(k, &value)| (time[0] + k as f64 * step, value));
        axes.line(canvas, points, *stroke);
    }
    if curves.iter().all(|(values, _)| values.is_empty()) {
        axes.note(canvas, "no samples were kept");
    }
    axes.frame(canvas);
    axes
}
