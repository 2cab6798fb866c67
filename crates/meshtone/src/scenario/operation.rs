//! Speed and load.

/// How the pair is driven and loaded.
#[derive(Debug, Clone, PartialEq)]
pub struct Operation {
    /// (rev/s) Nominal speed of the motor, which turns the pinion.
    pub pinion_speed_hz: f64,
    /// (N m) Nominal torque of the brake on the gear's shaft.
    pub brake_torque_nm: f64,
    /// (Hz) Half width of a uniform error of the motor's speed, drawn for every sample. Default 0.
    pub speed_fluctuation_hz: f64,
    /// (N m) Half width of a uniform error of the brake's torque, drawn for every sample. Default 0.
    pub torque_fluctuation_nm: f64,
    /// Speed of the motor against time, instead of the constant `pinion_speed_hz`, which stays
    /// the speed that the sampling rate is chosen for.
    pub speed_profile_hz: Option<Profile>,
    /// Torque of the brake against time, instead of the constant `brake_torque_nm`.
    pub torque_profile_nm: Option<Profile>,
}

impl Operation {
    /// Constant speed and load.
    ///
    /// # Arguments
    /// As the fields of the same names.
    pub fn new(pinion_speed_hz: f64, brake_torque_nm: f64) -> Self {
        Self {
            pinion_speed_hz,
            brake_torque_nm,
            speed_fluctuation_hz: 0.0,
            torque_fluctuation_nm: 0.0,
            speed_profile_hz: None,
            torque_profile_nm: None,
        }
    }
}

/// A quantity against time: straight lines between the points, constant outside them.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// (s) Strictly increasing times; 0 is the start of the simulation, before settling.
    pub time_s: Vec<f64>,
    /// (Hz or N m) The quantity at those times.
    pub value: Vec<f64>,
}
