//! The Python module `meshtone._core`: what the package `meshtone` is built around.
//!
//! Everything here is thin: it turns Python values into the library's and back, releases the interpreter's lock while the
//! library computes, and gives its errors as Python's, with the same text. What users see, with its documentation, is in
//! `python/meshtone`.
// Functions that Python calls take what Python gives, and are documented there.
#![allow(clippy::too_many_arguments)]

mod adapt;
mod array;
mod batch;
mod bearing;
mod dataset;
mod diagnose;
mod error;
mod explore;
mod hybrid;
mod interrupt;
mod memory;
mod phase;
mod process;
mod recording;
mod scenario;
mod sensor_path;
mod signal;
mod signals_file;
mod simulation;
mod value;

use pyo3::prelude::*;

#[pymodule]
mod _core {
    #[pymodule_export]
    use crate::{
        adapt::{Adaptation, adapt_dataset},
        batch::simulate_many,
        bearing::{
            bearings_of_train, best_band, cepstral_prewhitening, defect_lines, defect_orders,
            discrete_random_separation, kurtogram, named_bearings, spectral_kurtosis, squared_envelope,
            squared_envelope_spectrum, synchronous_residual, velocity_rms,
        },
        dataset::{
            check_plan, dataset_template, generate_dataset, merge_datasets, rows_like, verify_dataset,
        },
        diagnose::{Observation, check_diagnosis, diagnose, tuned_rig},
        explore::ExploreServer,
        hybrid::{add_noise, change_duration, change_fault_to_harmonics_ratio, enhance, tune},
        memory::set_memory_limit,
        phase::{ShaftPhase, repair_pulses, tachometer_pulses},
        process::{check_recording, find_mismatch, process_channel, process_series, process_train},
        recording::{read_recording, recording_files},
        scenario::{Scenario, gearbox_template, template},
        sensor_path::estimate_path,
        signal::{
            angular_resample, energy_ratio, envelope, envelope_spectrum, fm0, fm4, m6a, m8a, na4, order_map,
            order_spectrum, resample, separate, sideband_level_factor, statistics, synchronous_average,
        },
        signals_file::write_signals,
        simulation::{Simulation, process_simulated, simulate, trace},
    };

    use pyo3::exceptions::PyImportError;
    use pyo3::prelude::*;
    use pyo3::types::PyTuple;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        meshtone::InstructionSet::from_environment()
            .map_err(|error| PyImportError::new_err(error.to_string()))?;
        module.add("ORDER_MAP_MESH_ORDERS", meshtone::signal::OrderMapSettings::MESH_ORDERS)?;
        let indicators = meshtone::signal::Indicators::default().table("");
        module.add("INDICATORS", PyTuple::new(module.py(), indicators.into_iter().map(|of| of.name))?)?;
        module.add("PLAN_FILES", PyTuple::new(module.py(), meshtone_dataset::plan::PlanFile::NAMES)?)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
