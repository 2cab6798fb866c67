//! The signals; and the chain from a recording, simulated or measured, to condition indicators.
//!
//! [`process_channel`] is the chain on one page. Each of its steps can be used alone:
//!
//! | step | functions |
//! |---|---|
//! | another sampling rate | [`resample_to`], [`resample`], [`resample_with`], [`resampling_ratio`], [`resampling_taps`]; at any places [`AntiAliasing`] |
//! | phase of the shaft | [`ShaftPhase`], [`tachometer_pulses`], [`repair_pulses`] |
//! | over the angle | [`angular_resample`], [`interpolate_pchip`], [`interpolate_band_limited`] |
//! | synchronous average | [`synchronous_average`], [`segmented_averages`] |
//! | average of a planet or a sun | [`planetary_average`] |
//! | separation | [`separate`] |
//! | spectra and envelope | [`order_spectrum`], over time [`order_map`], [`envelope`], [`envelope_spectrum`] |
//! | every shaft of a pair or a gearbox | [`GearTrain`], [`TrainRecording`], [`foreign_tones`] |
//! | whether it fits what the user stated | [`check_recording`], of [`find_mismatch`] and [`lines_off_shafts`]; [`synchronous_part`] |
//! | whether sensor and recorder worked | [`sensor_faults`], [`copies`] |
//! | what was simulated | [`SimulatedShafts`], whose phase the scenario says |
//! | bearings | [`TrainRecording::bearing_defects`]; for people who look [`TrainRecording::bearings`], [`BearingGeometry`](crate::bearing::BearingGeometry), [`defect_lines`] of [`squared_envelope_spectrum`] and [`squared_envelope_order_spectrum`] |
//! | bands that are impulsive | [`kurtogram`], [`spectral_kurtosis`] |
//! | what is not periodic | [`synchronous_residual`], [`discrete_random_separation`], [`cepstral_prewhitening`] |
//! | a machine as a whole | [`velocity_rms`] |
//! | indicators | [`Indicators`], [`fm0`], [`fm4`], [`m6a`], [`m8a`], [`na4`], [`energy_ratio`], [`sideband_level_factor`], [`octave_bands`], [`mesh_harmonics`] |

mod angular;
mod anti_aliasing;
mod average;
mod bearing;
mod check;
mod check_recording;
mod edge;
mod envelope;
mod error;
mod filter_bank;
mod foreign_tones;
mod gear_train;
mod indicators;
mod interpolate;
mod kaiser;
mod kurtogram;
mod mismatch;
mod octaves;
mod order_map;
mod phase;
mod planetary_average;
mod planetary_recording;
mod prewhitening;
mod random_part;
mod record;
mod resample;
mod sensor_faults;
mod separation;
mod simulated;
mod spectrum;
mod squared_envelope;
mod statistics;
mod synchronous_part;
mod train_recording;
mod velocity;
mod warning;

pub use angular::{AngularSettings, AngularSignal, Interpolation, angular_resample, points_per_revolution};
pub use anti_aliasing::AntiAliasing;
pub use average::{
    FEWEST_REVOLUTIONS, SynchronousAverage, revolution_average, segmented_averages, synchronous_average,
};
pub use bearing::{
    BearingDefects, BearingRecords, BearingSeparation, BearingSettings, BearingVerdict, CannotTell,
    DefectKind, DefectLine, EnvelopeBand, RaceTest, TrainBearing, UnexplainedComb, defect_lines,
};
pub use check::{SAMPLING_RATES_HZ, check_channel};
pub use check_recording::check_recording;
pub use edge::Edge;
pub use envelope::{analytic_signal, envelope, envelope_spectrum};
pub use error::SignalError;
pub use foreign_tones::{
    ForeignSearch, ForeignTone, ForeignTones, LinesOffShafts, foreign_tones, lines_off_shafts,
};
pub use gear_train::{GearTrain, TrainShaft, TrainWheel};
pub use indicators::{
    IndicatorValue, Indicators, MESH_HARMONICS, MESH_SIDEBANDS, MeshHarmonic, ShapeIndicators, energy_ratio,
    fm0, fm4, m6a, m8a, mesh_harmonics, na4, sideband_level_factor,
};
pub use interpolate::{interpolate_band_limited, interpolate_pchip};
pub use kaiser::kaiser;
pub use kurtogram::{Kurtogram, KurtogramBand, kurtogram, spectral_kurtosis};
pub use mismatch::{Alternative, Mismatch, StatedFacts, StatedTurning, find_mismatch, find_train_mismatch};
pub use octaves::{OCTAVES, OctaveBand, octave_bands};
pub use order_map::{OrderMap, OrderMapSettings, order_map};
pub use phase::{
    AngleZero, MeshTone, PulseEdge, PulseTrain, ShaftPhase, Tachometer, repair_pulses, tachometer_pulses,
};
pub use planetary_average::{Passages, PassingSignal, PlanetaryAverage, planetary_average};
pub use planetary_recording::TrainSet;
pub use prewhitening::cepstral_prewhitening;
pub use random_part::{
    DiscreteRandomParts, SynchronousResidual, discrete_random_separation, synchronous_residual,
};
pub use record::{
    ChainSettings, Record, Recording, process_angular, process_angular_segments, process_average,
    process_channel, process_segments, process_series,
};
pub(crate) use resample::whole_ratio;
pub use resample::{resample, resample_to, resample_with, resampling_ratio, resampling_taps};
pub use sensor_faults::{SensorFault, copies, sensor_faults};
pub use separation::{MeanPart, Separation, SeparationSettings, separate};
pub use simulated::SimulatedShafts;
pub use spectrum::order_spectrum;
pub use squared_envelope::{
    FrequencyBand, SquaredEnvelopeSpectrum, squared_envelope, squared_envelope_order_spectrum,
    squared_envelope_spectrum,
};
pub(crate) use statistics::{StraightLine, upper_median};
pub use statistics::{
    central_moment, crest_factor, kurtosis, peak, peak_to_peak, rms, skewness, standard_deviation,
    standardised_moment,
};
pub use synchronous_part::{SynchronousPart, synchronous_part};
pub use train_recording::{
    TrainRecording, TrainRecords, TrainSettings, TrainTurning, WheelError, WheelRecords,
};
pub use velocity::{VELOCITY_BAND, velocity_rms};
pub use warning::SignalWarning;
