//! Why there is no diagnosis.

use meshtone_diagnose::{DiagnoseError, StoreError};

use crate::failure::Failure;

impl From<StoreError> for Failure {
    fn from(error: StoreError) -> Self {
        match error {
            StoreError::File(error) => {
                Self::from(error).with_help("name another folder for the simulations with --reference DIR")
            }
            StoreError::Cancelled => Self::failed(error.to_string()),
        }
    }
}

impl From<DiagnoseError> for Failure {
    fn from(error: DiagnoseError) -> Self {
        let message = error.to_string();
        let help = match error {
            DiagnoseError::TooFewOrders { .. } => {
                "record at a higher rate, or check --sampling-rate-hz and the scenario's speed and teeth"
            }
            DiagnoseError::OtherSpeed { .. } => {
                "check --shaft-hz (revolutions per second), --shaft or --teeth (what speed or pulses are of) and the speed in the scenario"
            }
            DiagnoseError::NoReference => "or make more of them, with --records",
            DiagnoseError::NotSolved => return Self::failed(message),
            _ => return Self::bad_input(message),
        };
        Self::bad_input(message).with_help(help)
    }
}
