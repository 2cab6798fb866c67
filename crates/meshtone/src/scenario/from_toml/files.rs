//! The files that a scenario file may name.

use super::super::{FileProblem, FrequencyResponse, Profile, ProfileErrors, WheelDeviations};
use crate::error_table::ErrorTable;
use crate::keys::NumberFiles;

/// Loads the files that a scenario file names, so that the library itself touches no files.
pub trait ScenarioFiles {
    /// The profile errors in a file named by `quality.errors_file`.
    ///
    /// # Arguments
    /// * `name` - as written in the scenario file
    ///
    /// # Errors
    /// Problems of the file. Shape and values are checked by
    /// [`Scenario::validate`](crate::scenario::Scenario::validate).
    fn profile_errors(&self, name: &str) -> Result<ProfileErrors, FileProblem>;

    /// Other deviations in the file named by `quality.errors_file`, of the pinion and of the gear: pitches, run-out, helix slope. Nothing
    /// else unless this is implemented.
    ///
    /// # Arguments
    /// * `name` - as written in the scenario file
    ///
    /// # Errors
    /// Problems of the file.
    fn wheel_deviations(&self, name: &str) -> Result<[WheelDeviations; 2], FileProblem> {
        let _ = name;
        Ok([WheelDeviations::default(), WheelDeviations::default()])
    }

    /// The profile in a file named by `operation.speed_profile_hz` or `operation.torque_profile_nm`.
    ///
    /// # Arguments
    /// * `name` - as written in the scenario file
    ///
    /// # Errors
    /// Problems of the file. Order of times and values are checked by
    /// [`Scenario::validate`](crate::scenario::Scenario::validate).
    fn profile(&self, name: &str) -> Result<Profile, FileProblem>;

    /// The frequency response in a file named by `sensor.frequency_response`. Whoever has no such files leaves it out.
    ///
    /// # Arguments
    /// * `name` - as written in the scenario file
    ///
    /// # Errors
    /// Problems of the file. Order of frequencies and values are checked by
    /// [`Scenario::validate`](crate::scenario::Scenario::validate).
    fn frequency_response(&self, name: &str) -> Result<FrequencyResponse, FileProblem> {
        Err(FileProblem::new(
            format!("names the file {name}, but no frequency responses are read here"),
            "write the values here as { frequency_hz = […], magnitude = […], phase_deg = […] }",
        ))
    }
}

/// The numbers in the files that a scenario names.
pub(in crate::scenario) struct Numbers<'f>(pub(in crate::scenario) &'f dyn ScenarioFiles);

impl NumberFiles for Numbers<'_> {
    fn times_and_values(&self, name: &str) -> Result<[Vec<f64>; 2], FileProblem> {
        self.0.profile(name).map(|profile| [profile.time_s, profile.value])
    }

    fn frequencies_magnitudes_phases(&self, name: &str) -> Result<[Vec<f64>; 3], FileProblem> {
        let response = self.0.frequency_response(name)?;
        Ok([response.frequency_hz, response.magnitude, response.phase_deg])
    }

    fn matrices(&self, name: &str) -> Result<[ErrorTable; 2], FileProblem> {
        let errors = self.0.profile_errors(name)?;
        Ok([errors.pinion_profile_errors_mm, errors.gear_profile_errors_mm])
    }

    fn named_numbers(&self, name: &str) -> Result<Vec<(&'static str, Vec<f64>)>, FileProblem> {
        Ok(WheelDeviations::entries(&self.0.wheel_deviations(name)?))
    }
}
