//! The first sensor's signal, or the vertical acceleration, averaged over the revolutions of either shaft.

use meshtone::Stages;
use meshtone::sensor::{Channel, Channels};
use meshtone::signal::{ChainSettings, Shaft, SimulatedShafts};
use meshtone::wheel::WheelName;

use super::damage;
use crate::axes::{self, Area, Axes};
use crate::canvas::Canvas;
use crate::damaged_tooth;
use crate::legend::{self, Entry, Sample};
use crate::style::{Stroke, colour};
use crate::ticks::Ticks;

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
    let shafts = SimulatedShafts::of_channels(&stages.scenario, channels);
    let quantity = quantity(&channels.leading().0);
    let averages = Shaft::BOTH.map(|shaft| Average::new(channels, &shafts, shaft));
    let values = averages.iter().flat_map(|average| average.values.iter().copied());
    let y = axes::range(values, MARGIN);
    for (column, average) in averages.iter().enumerate() {
        let axes = Axes::new(areas[column], [0.0, 360.0], y);
        let wheel = WheelName::BOTH[column];
        let damaged = damage::damaged_teeth(stages, wheel);
        axes.title(canvas, &average.title(wheel.name()));
        if let Some(text) = damaged_tooth::in_words(&[(wheel.name(), &damaged)]) {
            let end_of_title = (axes.area.right(), axes.area.top - axes::TITLE_ABOVE);
            legend::row(canvas, end_of_title, &[damaged_tooth::legend_entry(&text)]);
        }
        let teeth = stages.teeth.wheel(wheel).teeth;
        damaged_tooth::tint(canvas, &axes, &damaged, teeth, 360.0 / f64::from(teeth.max(1)));
        let name = if wheel == WheelName::Pinion { "Pinion" } else { "Gear" };
        let since = format!("{name} angle since its {} (°)", damage::start_of_revolution(&damaged));
        axes.x_axis(canvas, &Ticks::every(45.0, 0.0, 360.0), &since);
        axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 5), &format!("{quantity} (g)"), super::NAME_LEFT);
        average.draw(canvas, &axes);
        axes.frame(canvas);
    }
}

/// Most letters of a name for which a vertical axis has room.
const LONGEST_NAME: usize = 28;

/// What a channel shows, as a title has it: a sensor's is its name, where there is room for it.
fn quantity(channel: &Channel) -> String {
    match channel {
        Channel::Sensor(name) if name.len() > LONGEST_NAME => "First sensor".to_owned(),
        Channel::Sensor(name) => {
            let words = name.replace('_', " ");
            let mut letters = words.chars();
            let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
            first + letters.as_str()
        }
        _ => "Vertical acceleration".to_owned(),
    }
}

/// An average from the angle at which the first tooth enters contact.
struct Average {
    values: Vec<f64>,
    revolutions: usize,
    is_empty: bool,
}

impl Average {
    fn new(channels: &Channels, shafts: &SimulatedShafts, shaft: Shaft) -> Self {
        // Where there is no whole revolution there is no average.
        let average = shafts.average(channels.leading().1, shaft, &ChainSettings::default());
        let (values, revolutions) =
            average.map_or_else(|_| (Vec::new(), 0), |average| (average.values, average.revolutions));
        Self { values, revolutions, is_empty: channels.is_empty() }
    }

    fn title(&self, wheel: &str) -> String {
        match self.revolutions {
            0 => format!("Average over the {wheel}’s revolutions"),
            1 => format!("One revolution of the {wheel}"),
            count => format!("Average of {count} {wheel} revolutions"),
        }
    }

    fn draw(&self, canvas: &mut Canvas, axes: &Axes) {
        if self.values.is_empty() {
            let reason = if self.is_empty {
                "no samples were kept"
            } else {
                "the kept signal is shorter than a revolution"
            };
            axes.note(canvas, reason);
            return;
        }
        let degrees = 360.0 / self.values.len() as f64;
        axes.line(
            canvas,
            self.values.iter().enumerate().map(|(k, &value)| (k as f64 * degrees, value)),
            CURVE,
        );
    }
}

fn over_time(canvas: &mut Canvas, areas: [Area; 2], channels: &Channels) {
    let samples = channels.len();
    let time = if samples > 1 {
        [channels.time_s(0), channels.time_s(samples - 1)]
    } else {
        [channels.start_s, channels.start_s + 1.0]
    };
    let time = if time[1] > time[0] && time.iter().all(|&t| axes::drawable(t)) { time } else { [0.0, 1.0] };
    let (channel, signal) = channels.leading();
    let quantity = quantity(&channel);
    let acceleration = [(signal, CURVE)];
    let speeds = [
        (channels.pinion_shaft_speed_hz.as_slice(), CURVE),
        (channels.gear_shaft_speed_hz.as_slice(), SECOND_CURVE),
    ];
    let title = format!("{quantity}, at changing speed");
    signals(canvas, areas[0], time, &title, &format!("{quantity} (g)"), &acceleration);
    let axes = signals(canvas, areas[1], time, "Speed of both shafts", "Speed (Hz)", &speeds);
    let entries = [("pinion", CURVE), ("gear", SECOND_CURVE)]
        .map(|(text, stroke)| Entry { sample: Sample::Line(stroke), text });
    legend::row(canvas, (axes.area.right(), axes.area.top - axes::TITLE_ABOVE), &entries);
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
    let axes = Axes::new(area, time, y);
    axes.title(canvas, title);
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
