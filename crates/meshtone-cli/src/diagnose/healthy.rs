//! What differs in the healthy recordings.

use std::path::PathBuf;

use clap::Args;

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
    /// (Hz) Speed of the shaft; without --shaft-hz and pulses the nominal speed of the mesh tone
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
    #[arg(long, group = "source_of_healthy")]
    healthy_from_mesh_tone: bool,
}

impl HealthyOptions {
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

    /// The options of the phase of the healthy recordings.
    ///
    /// A source that is named for them replaces the others' source with its speed. A speed alone replaces a speed, in whatever way that is used; where
    /// nothing is said of the others, it is the nominal speed of the mesh tone, as theirs is the scenario's.
    ///
    /// # Arguments
    /// * `phase` - those of the other recordings
    pub fn phase(&self, phase: &PhaseOptions) -> PhaseOptions {
        let mut own = phase.clone();
        let has_source = self.healthy_tach.is_some()
            || self.healthy_pulse_times.is_some()
            || self.healthy_speed_channel.is_some()
            || self.healthy_speed_profile.is_some()
            || self.healthy_from_mesh_tone;
        if has_source {
            own.shaft_hz = None;
            own.tach.clone_from(&self.healthy_tach);
            own.pulse_times.clone_from(&self.healthy_pulse_times);
            own.speed_channel.clone_from(&self.healthy_speed_channel);
            own.speed_profile.clone_from(&self.healthy_speed_profile);
            own.from_mesh_tone = self.healthy_from_mesh_tone;
        } else if self.healthy_shaft_hz.is_some() {
            own.from_mesh_tone |= !phase.states_shaft_angle();
            (own.speed_channel, own.speed_profile) = (None, None);
        }
        own.shaft_hz = self.healthy_shaft_hz.or(own.shaft_hz);
        own
    }
}
