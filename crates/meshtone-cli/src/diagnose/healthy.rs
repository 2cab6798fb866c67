//! Options that state how the healthy recordings differ from the others.

use std::path::PathBuf;

use clap::Args;

use crate::failure::Failure;
use crate::indicators::options::{PhaseOptions, ReadingOptions, positive};

/// Options of the healthy recordings, each in place of the option of the others that has its name.
#[derive(Debug, Args)]
#[command(next_help_heading = "Healthy recordings, where they are not as the others")]
#[group(id = "of_healthy", multiple = true, requires = "healthy")]
pub struct HealthyOptions {
    /// Column to process
    #[arg(long, value_name = "CHANNEL")]
    healthy_channel: Option<String>,
    /// (S/s) Sampling rate
    #[arg(long, value_name = "RATE", value_parser = positive, allow_negative_numbers = true)]
    healthy_sampling_rate_hz: Option<f64>,
    /// Variable of the file, or recording_id
    #[arg(long, value_name = "NAME")]
    healthy_variable: Option<String>,
    /// (mV/unit) Sensitivity of the sensor
    #[arg(long, value_name = "MV", allow_negative_numbers = true)]
    healthy_sensitivity_mv_per_unit: Option<f64>,
    /// Unit of the channel
    #[arg(long, value_name = "UNIT")]
    healthy_unit: Option<String>,
    /// (Hz) Speed of the shaft: constant; with pulses, the value for their check; with --healthy-from-mesh-tone, the nominal speed
    #[arg(long, value_name = "SPEED", value_parser = positive, allow_negative_numbers = true)]
    healthy_shaft_hz: Option<f64>,
    /// Channel with a tachometer's waveform
    #[arg(long, value_name = "CHANNEL", group = "source_of_healthy")]
    healthy_tach: Option<String>,
    /// File or array with the times of pulses
    #[arg(long, value_name = "FILE", group = "source_of_healthy")]
    healthy_pulse_times: Option<PathBuf>,
    /// Channel with the shaft's speed
    #[arg(long, value_name = "CHANNEL", group = "source_of_healthy", conflicts_with = "healthy_shaft_hz")]
    healthy_speed_channel: Option<String>,
    /// File with time and speed
    #[arg(long, value_name = "FILE", group = "source_of_healthy", conflicts_with = "healthy_shaft_hz")]
    healthy_speed_profile: Option<PathBuf>,
    /// Follow the mesh tone
    #[arg(long, group = "source_of_healthy", requires = "healthy_shaft_hz")]
    healthy_from_mesh_tone: bool,
}

impl HealthyOptions {
    /// A failure with a healthy recording, whose help names the options of the others.
    pub fn named(failure: Failure) -> Failure {
        let others = failure.help.as_ref().map_or_else(String::new, |help| format!("{help}; "));
        failure.with_help(
            others
                + "options of the healthy recordings begin with --healthy-, see `meshtone diagnose --help`",
        )
    }

    /// The options by which the healthy recordings are read.
    ///
    /// # Arguments
    /// * `reading` - those of the other recordings
    pub fn reading(&self, reading: &ReadingOptions) -> ReadingOptions {
        let reading = reading.clone();
        ReadingOptions {
            channel: self.healthy_channel.clone().or(reading.channel),
            sampling_rate_hz: self.healthy_sampling_rate_hz.or(reading.sampling_rate_hz),
            variable: self.healthy_variable.clone().or(reading.variable),
            sensitivity_mv_per_unit: self.healthy_sensitivity_mv_per_unit.or(reading.sensitivity_mv_per_unit),
            unit: self.healthy_unit.clone().or(reading.unit),
            ..reading
        }
    }

    /// The options of the phase of the healthy recordings: those of the others, or where a speed or a source is named for them, these alone.
    ///
    /// # Arguments
    /// * `phase` - those of the other recordings
    pub fn phase(&self, phase: &PhaseOptions) -> PhaseOptions {
        let own = PhaseOptions {
            shaft_hz: self.healthy_shaft_hz,
            tach: self.healthy_tach.clone(),
            pulse_times: self.healthy_pulse_times.clone(),
            speed_channel: self.healthy_speed_channel.clone(),
            speed_profile: self.healthy_speed_profile.clone(),
            from_mesh_tone: self.healthy_from_mesh_tone,
            ..phase.clone()
        };
        if own.states_shaft_angle() { own } else { phase.clone() }
    }
}
