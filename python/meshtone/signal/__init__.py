"""From a channel, simulated or measured, to condition indicators; every step can be used alone.

The chain, its definitions and their sources: the book's chapter "From a recording to indicators". Arrays are float64; others are
converted. Values that are not defined (the kurtosis of a constant) are NaN.

Examples
--------
A rig's recording with a tachometer:

>>> import numpy as np
>>> from meshtone import signal
>>> rate_hz, shaft_hz, teeth = 10_000.0, 20.0, 19
>>> time_s = np.arange(20_000) / rate_hz
>>> vibration = np.cos(2 * np.pi * shaft_hz * teeth * time_s) + 0.1 * np.cos(2 * np.pi * 253 * time_s)
>>> tachometer = np.where((time_s * shaft_hz) % 1 < 0.1, 5.0, 0.0)
>>> pulses_s = signal.tachometer_pulses(tachometer, rate_hz)
>>> phase = signal.ShaftPhase.from_pulses(pulses_s, 1, rate_hz, vibration.size)
>>> record = signal.process_channel(vibration, phase, teeth)
>>> record.revolutions, round(float(record.order_spectrum[teeth]), 2)
(38, 1.0)
"""

from .._warnings import SignalWarning
from .angular import AngularSignal, angular_resample, resample, synchronous_average
from .at_once import difference, tsa
from .bearings import (
    NAMED_BEARINGS,
    Bearing,
    DefectLine,
    DefectOrders,
    SquaredEnvelopeSpectrum,
    defect_lines,
    squared_envelope,
    squared_envelope_order_spectrum,
    squared_envelope_spectrum,
)
from .indicators import Indicators, energy_ratio, fm0, fm4, m6a, m8a, na4, sideband_level_factor, statistics
from .kurtosis import Kurtogram, KurtogramBand, kurtogram, spectral_kurtosis
from .mismatch import Mismatch, check_recording, find_mismatch
from .orders import OrderMap, order_map
from .phase import ShaftPhase, repair_pulses, tachometer_pulses
from .random_part import (
    DiscreteRandomParts,
    SynchronousResidual,
    cepstral_prewhitening,
    discrete_random_separation,
    synchronous_residual,
    velocity_rms,
)
from .record import Record, process_channel, process_series
from .separation import Parts, separate
from .spectra import envelope, envelope_spectrum, order_spectrum
from .train import (
    BearingRecords,
    BearingVerdict,
    ForeignLine,
    RaceTest,
    TrainRecord,
    TrainRecording,
    UnexplainedComb,
    process_train,
)

__all__ = [
    "NAMED_BEARINGS",
    "AngularSignal",
    "Bearing",
    "BearingRecords",
    "BearingVerdict",
    "DefectLine",
    "DefectOrders",
    "DiscreteRandomParts",
    "ForeignLine",
    "Indicators",
    "Kurtogram",
    "KurtogramBand",
    "Mismatch",
    "OrderMap",
    "Parts",
    "RaceTest",
    "Record",
    "ShaftPhase",
    "SignalWarning",
    "SquaredEnvelopeSpectrum",
    "SynchronousResidual",
    "TrainRecord",
    "TrainRecording",
    "UnexplainedComb",
    "angular_resample",
    "cepstral_prewhitening",
    "check_recording",
    "defect_lines",
    "difference",
    "discrete_random_separation",
    "energy_ratio",
    "envelope",
    "envelope_spectrum",
    "find_mismatch",
    "fm0",
    "fm4",
    "kurtogram",
    "m6a",
    "m8a",
    "na4",
    "order_map",
    "order_spectrum",
    "process_channel",
    "process_series",
    "process_train",
    "repair_pulses",
    "resample",
    "separate",
    "sideband_level_factor",
    "spectral_kurtosis",
    "squared_envelope",
    "squared_envelope_order_spectrum",
    "squared_envelope_spectrum",
    "statistics",
    "synchronous_average",
    "synchronous_residual",
    "tachometer_pulses",
    "tsa",
    "velocity_rms",
]
