//! The amplitude spectrum over orders of the input shaft, of a pair and of a gearbox.

use meshtone::Stages;
use meshtone::sensor::Channels;
use meshtone::signal::{AngularSignal, ChainSettings, SignalError, SimulatedShafts, order_spectrum};
use meshtone::wheel::WheelName;

use super::NAME_LEFT;
use crate::drawing::{Area, Axes, Canvas, Sample, Stroke, TextStyle, Ticks, axes, colour, number};

const CURVE: Stroke = Stroke::solid(colour::BLUE, 1.1);
const MESH_LINE: Stroke = Stroke::dashed(colour::VERMILLION, 1.0, &[4.0, 3.0]);
const SHAFT_LINE: Stroke = Stroke::dashed(colour::GREEN, 1.0, &[2.0, 3.0]);
/// Orders of the quickest mesh that are shown.
const MESH_ORDERS: f64 = 4.5;

/// The first sensor's signal over whole revolutions of the input shaft, and the orders of shafts and meshes.
pub(super) struct InputSpectrum<'a> {
    /// The quantity and its unit, as titles have them.
    pub(super) quantity: (&'a str, &'a str),
    /// Name of the input shaft, such as `input`.
    pub(super) shaft: &'a str,
    /// The signal at equal angles, or the note that stands in place of its spectrum.
    pub(super) angular: Result<AngularSignal, &'static str>,
    /// (orders) Speeds of all shafts over the input's.
    pub(super) shafts: Vec<f64>,
    /// Names of the meshes, where there are several, and their orders.
    pub(super) meshes: Vec<(String, f64)>,
}

/// Draws the spectrum of a pair; also at changing speed, where it is of the signal over the pinion's angle.
pub(super) fn of_pair(canvas: &mut Canvas, area: Area, stages: &Stages, channels: &Channels) {
    let (quantity, signal) = super::average::leading(channels);
    let shafts = SimulatedShafts::of_stages(stages, channels.start_s, channels.len());
    let angular = shafts.angular(signal, WheelName::Pinion, &ChainSettings::default());
    let [pinion, gear] = WheelName::BOTH.map(|wheel| f64::from(stages.layout.gears[0].teeth(wheel)));
    let spectrum = InputSpectrum {
        quantity: (&quantity, "g"),
        shaft: "pinion",
        angular: angular.map_err(|error| note(&error)),
        shafts: vec![1.0, pinion / gear],
        meshes: vec![(String::new(), pinion)],
    };
    spectrum.draw(canvas, area);
}

/// Note where the turning of the shaft cannot be stated.
pub(super) const ANGLE_UNKNOWN: &str = "the shaft’s angle is not known";
const TOO_SHORT: &str = "the kept signal is shorter than a revolution";

/// The note where a signal cannot be stated at equal angles.
pub(super) fn note(error: &SignalError) -> &'static str {
    match error {
        SignalError::TooFew { .. }
        | SignalError::TooFewRevolutions { .. }
        | SignalError::TooFewPassages { .. }
        | SignalError::TeethNotSeen { .. }
        | SignalError::LengthMismatch { .. } => TOO_SHORT,
        SignalError::Constant { .. } => "the signal is constant",
        _ => ANGLE_UNKNOWN,
    }
}

impl InputSpectrum<'_> {
    /// Amplitudes on a linear scale, with a line at each order of shafts and meshes.
    pub(super) fn draw(&self, canvas: &mut Canvas, area: Area) {
        let angular = self.angular.as_ref().ok();
        let revolutions = angular.map_or(0, AngularSignal::revolutions);
        let highest = MESH_ORDERS * self.meshes.iter().map(|(_, order)| *order).fold(0.0, f64::max);
        let highest = angular.map_or(highest, |angular| highest.min(angular.nyquist_order));
        let whole =
            angular.and_then(|angular| angular.values.get(..revolutions * angular.points_per_revolution));
        let amplitudes = whole.and_then(|whole| order_spectrum(whole).ok()).unwrap_or_default();
        let step = 1.0 / revolutions.max(1) as f64;
        // Without order 0, the mean.
        let points = amplitudes.iter().enumerate().take((highest / step) as usize + 1).skip(1);
        let shown: Vec<(f64, f64)> =
            points.map(|(line, amplitude)| (line as f64 * step, *amplitude)).collect();
        let y = [0.0, 1.1 * axes::largest(shown.iter().map(|(_, amplitude)| amplitude)).max(1e-9)];
        let Self { quantity: (quantity, unit), shaft, .. } = self;
        let title = match revolutions {
            0 => format!("Order spectrum of {quantity}"),
            _ => format!("Order spectrum of {quantity}, {revolutions} revolutions of the {shaft}"),
        };
        let axes = Axes::titled(canvas, area, [0.0, highest], y, &title);
        axes.x_axis(canvas, &Ticks::nice(0.0, highest, 16), &format!("Order of the {shaft}"));
        axes.y_axis(canvas, &Ticks::nice(y[0], y[1], 5), &format!("Amplitude ({unit})"), NAME_LEFT);
        for order in &self.shafts {
            axes.vertical(canvas, order.abs(), SHAFT_LINE);
        }
        for (name, order) in &self.meshes {
            for harmonic in (1..).take_while(|harmonic| f64::from(*harmonic) * order <= highest) {
                axes.vertical(canvas, f64::from(harmonic) * order, MESH_LINE);
            }
            let style = TextStyle::NOTE.coloured(colour::VERMILLION).with_halo();
            let text = format!("{name} {}", number(*order));
            canvas.text((axes.px(*order) + 4.0, area.top + 14.0), text.trim(), style);
        }
        match &self.angular {
            Err(note) => axes.note(canvas, note),
            Ok(_) if revolutions == 0 => axes.note(canvas, TOO_SHORT),
            Ok(_) => axes.line(canvas, shown.into_iter(), CURVE),
        }
        let entries =
            [(Sample::Line(MESH_LINE), "mesh and its harmonics"), (Sample::Line(SHAFT_LINE), "shafts")];
        axes.legend(canvas, &entries);
        axes.frame(canvas);
    }
}
