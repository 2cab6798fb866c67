//! The options, in the groups in which the help shows them.

use std::path::PathBuf;

use clap::Args;
use meshtone::scenario::Scenario;
use meshtone::signal::{Interpolation, PulseEdge};
use meshtone_io::recording::{DecimalSign, Separator};

use super::limits::{ISO_20816, Iso20816};
use crate::choice::{Choice, one_of};
use crate::terminal::print_error_line;

/// Options that select parts of the files, and state what the files do not say themselves.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Recording")]
pub struct ReadingOptions {
    /// Column to process, by its name or its number from 1.
    /// [default: the only one; of a simulation its first listed sensor, or the vertical acceleration]
    #[arg(short, long, value_name = "CHANNEL")]
    pub channel: Option<String>,
    /// (S/s) Sampling rate, if the file does not state it, or instead of the file's
    #[arg(long, value_name = "RATE", value_parser = positive, allow_negative_numbers = true)]
    pub sampling_rate_hz: Option<f64>,
    /// Column of the time, by its name or number, or `none`. [default: the one that is named as time]
    #[arg(long, value_name = "CHANNEL")]
    pub time_column: Option<String>,
    /// Variable of an NPZ, MAT or HDF5 file that holds the recording, such as `run.sensors`; of a bearing-datasets folder the recording_id
    #[arg(long, value_name = "NAME")]
    pub variable: Option<String>,
    /// (mV/unit) Sensitivity of the sensor: the channel holds volts and is divided by it
    #[arg(long, value_name = "MV", allow_negative_numbers = true)]
    pub sensitivity_mv_per_unit: Option<f64>,
    /// Unit of the channel (after the division), such as g or m/s²
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<String>,
    /// Separator of the cells of a text file. [default: detected]
    #[arg(long, value_parser = one_of(&SEPARATORS))]
    pub separator: Option<Separator>,
    /// Decimal sign of a text file. [default: detected]
    #[arg(long, value_parser = one_of(&DECIMAL_SIGNS))]
    pub decimal_sign: Option<DecimalSign>,
    /// Lines to skip at the start of a text file
    #[arg(long, value_name = "LINES", default_value_t = 0)]
    pub skip_lines: usize,
}

impl ReadingOptions {
    /// Puts the sensor of the chosen channel first in a scenario, and says so where that changes what is simulated.
    pub fn lead_with_sensor(&self, scenario: &mut Scenario) {
        if let Some(channel) = self.channel.as_deref().filter(|channel| scenario.lead_with_sensor(channel)) {
            print_error_line(format_args!(
                "the scenario's sensor of the channel {channel} is simulated, in place of the first listed one"
            ));
        }
    }

    /// Advice where the sampling rate is so low that it is rather meant in kHz.
    pub fn in_kilohertz(&self) -> Option<String> {
        const MOST_KILOHERTZ: f64 = 200.0;
        let rate = self.sampling_rate_hz.filter(|rate| *rate <= MOST_KILOHERTZ)?;
        Some(format!(
            "--sampling-rate-hz {rate} are {rate} samples a second; for {rate} kHz write --sampling-rate-hz {}",
            (1e6 * rate).round() / 1e3
        ))
    }
}

/// The wheels, and how far their shafts have turned.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Wheels and phase (what `meshtone simulate` wrote needs none of these)")]
pub struct PhaseOptions {
    /// Teeth of the wheel on the shaft to which speed or pulses belong
    #[arg(long, value_name = "TEETH", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub teeth: Option<u32>,
    /// Teeth of the mating gear, to process it too, on its own shaft
    #[arg(long, value_name = "TEETH", requires = "teeth", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub mate_teeth: Option<u32>,
    /// (Hz) Speed of the shaft: constant; with pulses, the value for their check; with --from-mesh-tone, the nominal speed
    #[arg(long, value_name = "SPEED", value_parser = positive, allow_negative_numbers = true)]
    pub shaft_hz: Option<f64>,
    /// Channel with a tachometer's waveform, by its name or number
    #[arg(long, value_name = "CHANNEL", group = "pulses", group = "source")]
    pub tach: Option<String>,
    /// File with the times of a tachometer's pulses, in s, on the recording's own time; or array of the recording's file with them
    #[arg(long, value_name = "FILE", group = "pulses", group = "source")]
    pub pulse_times: Option<PathBuf>,
    /// Channel with the shaft's speed in Hz or rpm, by its name or number
    #[arg(long, value_name = "CHANNEL", group = "source", conflicts_with = "shaft_hz")]
    pub speed_channel: Option<String>,
    /// File with two columns, time in s and speed in Hz or rpm, on the recording's own time
    #[arg(long, value_name = "FILE", group = "source", conflicts_with = "shaft_hz")]
    pub speed_profile: Option<PathBuf>,
    /// Follow the mesh tone; needs no tachometer, but a nearly constant speed
    #[arg(long, group = "source", requires = "shaft_hz")]
    pub from_mesh_tone: bool,
    /// Pulses in a revolution
    #[arg(long, value_name = "PULSES", requires = "pulses", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub pulses_per_rev: u32,
    /// (unit of the waveform) Level that a pulse crosses. [default: the middle]
    #[arg(long, value_name = "LEVEL", requires = "tach", allow_negative_numbers = true)]
    pub threshold: Option<f64>,
    /// (unit of the waveform) Hysteresis, by which it must return before the next pulse counts. [default:
    /// 0.2 of its range]
    #[arg(long, value_name = "LEVEL", requires = "tach", value_parser = positive, allow_negative_numbers = true)]
    pub hysteresis: Option<f64>,
    /// Side of a pulse that counts
    #[arg(long, requires = "tach", default_value = "rising", value_parser = one_of(&EDGES))]
    pub edge: PulseEdge,
}

/// The part of a scenario that the phase is of.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Shafts of the scenario")]
pub struct ShaftOptions {
    /// Name of the shaft to which speed or pulses belong: of a pair, pinion or gear. [default: the
    /// input]
    #[arg(long, value_name = "NAME")]
    pub shaft: Option<String>,
    /// Mesh whose tone is followed, such as z3-z4. [default: the first one on the shaft]
    #[arg(long, value_name = "NAME", conflicts_with_all = ["tach", "pulse_times", "speed_channel", "speed_profile"])]
    pub mesh: Option<String>,
}

/// Settings by which the channel is processed.
#[derive(Debug, Args)]
#[command(next_help_heading = "Processing")]
pub struct ProcessingOptions {
    /// Sidebands on each side of every mesh order that belong to the regular part
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(..=1_000_000))]
    pub sidebands: u32,
    /// The shaft orders 1 to N belong to it; 0: none
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(..=1_000_000))]
    pub low_orders: u32,
    /// Cut each recording into segments of M revolutions (of each wheel), at least 2, and make a series of them
    #[arg(long, value_name = "M", value_parser = several)]
    pub revolutions: Option<u32>,
    /// The first N records are sound: mean and three standard deviations over them are the limit of each indicator of the trend
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(3..=1_000_000))]
    pub sound_records: Option<u32>,
    /// Class and mounting of the machine, to put the velocity into a zone of ISO 20816-3; compare the printed boundaries with your edition
    #[arg(long, value_name = "MACHINE", value_parser = one_of(&ISO_20816))]
    pub iso_20816: Option<Iso20816>,
    /// Interpolation of the signal between its samples for the averages; the order map is always band-limited
    #[arg(long, default_value = "band-limited", value_parser = one_of(&INTERPOLATIONS))]
    pub interpolation: Interpolation,
}

const SEPARATORS: [Choice<Separator>; 5] = [
    ("comma", "", Separator::Comma),
    ("semicolon", "", Separator::Semicolon),
    ("tab", "", Separator::Tab),
    ("bar", "", Separator::Bar),
    ("whitespace", "", Separator::Whitespace),
];

const DECIMAL_SIGNS: [Choice<DecimalSign>; 2] =
    [("point", "", DecimalSign::Point), ("comma", "", DecimalSign::Comma)];

/// Sides of a pulse.
pub const EDGES: [Choice<PulseEdge>; 2] =
    [("rising", "", PulseEdge::Rising), ("falling", "", PulseEdge::Falling)];

/// Ways to interpolate.
pub const INTERPOLATIONS: [Choice<Interpolation>; 2] = [
    ("band-limited", "Exact up to 0.8 of half the sampling rate", Interpolation::BandLimited),
    ("pchip", "Interpolation of the published code, which flattens peaks", Interpolation::Pchip),
];

fn several(text: &str) -> Result<u32, String> {
    let number = text.parse().ok().filter(|number: &u32| *number >= 2);
    number.ok_or_else(|| {
        "must be a whole number, at least 2: of one revolution there is nothing to average".to_string()
    })
}

/// A number above 0.
pub fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "must be a number above 0".to_string())
}
