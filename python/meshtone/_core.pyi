"""The compiled module. Its functions are documented where the package shows them."""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, final

import numpy as np
import numpy.typing as npt

_Array = npt.NDArray[np.float64]
_Path = str | PathLike[str]
_Column = int | str
_Bearing = tuple[int, float, float, float]

__all__ = [
    "Adaptation",
    "ExploreServer",
    "INDICATORS",
    "ORDER_MAP_MESH_ORDERS",
    "Observation",
    "PLAN_FILES",
    "Scenario",
    "ShaftPhase",
    "Simulation",
    "__version__",
    "adapt_dataset",
    "add_noise",
    "angular_resample",
    "bearings_of_train",
    "best_band",
    "cepstral_prewhitening",
    "change_duration",
    "change_fault_to_harmonics_ratio",
    "check_diagnosis",
    "check_plan",
    "check_recording",
    "dataset_template",
    "defect_lines",
    "defect_orders",
    "diagnose",
    "discrete_random_separation",
    "energy_ratio",
    "enhance",
    "envelope",
    "envelope_spectrum",
    "estimate_path",
    "find_mismatch",
    "fm0",
    "fm4",
    "gearbox_template",
    "generate_dataset",
    "kurtogram",
    "m6a",
    "m8a",
    "merge_datasets",
    "na4",
    "named_bearings",
    "order_map",
    "order_spectrum",
    "process_channel",
    "process_series",
    "process_simulated",
    "process_train",
    "read_recording",
    "recording_files",
    "repair_pulses",
    "resample",
    "rows_like",
    "separate",
    "set_memory_limit",
    "sideband_level_factor",
    "simulate",
    "simulate_many",
    "spectral_kurtosis",
    "squared_envelope",
    "squared_envelope_spectrum",
    "statistics",
    "synchronous_average",
    "synchronous_residual",
    "tachometer_pulses",
    "template",
    "trace",
    "tune",
    "tuned_rig",
    "velocity_rms",
    "verify_dataset",
    "write_signals",
]

INDICATORS: tuple[str, ...]
ORDER_MAP_MESH_ORDERS: float
PLAN_FILES: tuple[str, ...]
__version__: str

@final
class Scenario:
    def __new__(
        cls,
        sections: dict[str, Any],
        pinion_profile_errors_mm: _Array | None = None,
        gear_profile_errors_mm: _Array | None = None,
    ) -> Scenario: ...
    @staticmethod
    def from_toml(text: str) -> Scenario: ...
    @staticmethod
    def from_file(path: _Path) -> Scenario: ...
    @property
    def is_pair(self) -> bool: ...
    def leading_channel(self) -> str: ...
    def sensor_channels(self) -> list[str]: ...
    def wheels(self) -> list[tuple[str, int, float, float, float]]: ...
    def meshes(self) -> list[tuple[str, list[str]]]: ...
    def to_toml(self) -> str: ...
    def sections(self) -> dict[str, Any]: ...
    def channels(self) -> list[str]: ...
    def profile_errors_mm(self) -> tuple[_Array, _Array] | None: ...
    def fault_severities(self) -> list[float]: ...
    def with_own_sizes(self) -> Scenario: ...
    def warnings(self) -> list[str]: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...

def template(kind: str, all_keys: bool) -> str: ...
@final
class Adaptation:
    def json(self) -> str: ...
    def probabilities(self, recording: tuple[_Array, float, ShaftPhase, str | None]) -> tuple[list[list[float]], str | None]: ...

@final
class ExploreServer:
    def __new__(cls, scenario: Scenario, port: int, in_notebook: bool) -> ExploreServer: ...
    @property
    def url(self) -> str | None: ...
    @property
    def scenario(self) -> Scenario: ...
    def close(self) -> None: ...
@final
class Simulation:
    @property
    def scenario(self) -> Scenario: ...
    @property
    def sampling_rate_hz(self) -> float: ...
    @property
    def start_s(self) -> float: ...
    @property
    def channels(self) -> dict[str, _Array]: ...
    @property
    def tension_fraction(self) -> float: ...
    @property
    def contact_figures(self) -> list[tuple[float, float, int, float]] | None: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def warning_codes(self) -> list[str]: ...
    @property
    def mode_shapes(self) -> _Array: ...
    @property
    def computing_time_s(self) -> list[tuple[str, float]]: ...
    def fields(self) -> dict[str, Any]: ...
    def summary(self) -> dict[str, Any]: ...
    def natural_frequencies_with_hz(self, mesh_stiffness_n_per_m: list[float]) -> list[float]: ...
    def mesh_stiffness_n_per_mm(self, mesh: int, first_pitch: int, pitches: int) -> _Array: ...
    def static_mesh(
        self, mesh: int, force_n: float | None, pitches: tuple[int, int], points_per_pitch: int
    ) -> tuple[_Array, int, _Array]: ...
    def tooth_profile_mm(self, wheel: str) -> list[_Array]: ...
    def damaged_teeth_mm(self) -> list[tuple[str, int, _Array]]: ...
    def damages(self) -> list[dict[str, Any]]: ...
    def profile_errors_mm(self, mesh: int) -> tuple[_Array, _Array] | None: ...
    def wheel_deviations(self) -> list[tuple[str, str, float]]: ...

def write_signals(
    path: _Path,
    scenario: Scenario,
    is_resampled: bool,
    rate_and_start: tuple[float, float],
    signals: Sequence[tuple[str, _Array]],
) -> None: ...
def process_simulated(
    scenario: Scenario, signal: _Array, channel: str, wheel: str | None, start_s: float, sidebands: int | None = None
) -> dict[str, Any]: ...
def gearbox_template(rig: str | None = None) -> str: ...
def simulate(scenario: Scenario) -> Simulation: ...
def trace(scenario: Scenario, average_rate_hz: float | None = None) -> dict[str, Any]: ...
def simulate_many(
    scenarios: Sequence[Scenario],
    channels: Sequence[str] | None,
    threads: int | None,
    stop_at_error: bool,
    progress: Callable[[int, int], None] | None,
) -> list[Any]: ...
@final
class ShaftPhase:
    def __new__(cls, revolutions: _Array, first_sample: int = 0, zero: str = "angle 0") -> ShaftPhase: ...
    @staticmethod
    def of_simulated(scenario: Scenario, start_s: float, samples: int) -> ShaftPhase: ...
    @staticmethod
    def constant(speed_hz: float, sampling_rate_hz: float, samples: int) -> ShaftPhase: ...
    @staticmethod
    def from_pulses(
        time_s: _Array,
        pulses_per_revolution: int,
        sampling_rate_hz: float,
        samples: int,
        stated_speed_hz: float | None,
    ) -> ShaftPhase: ...
    @staticmethod
    def from_speed_profile(
        time_s: _Array, speed_hz: _Array, sampling_rate_hz: float, samples: int
    ) -> ShaftPhase: ...
    @staticmethod
    def from_speed_samples(speed_hz: _Array, sampling_rate_hz: float) -> ShaftPhase: ...
    @staticmethod
    def from_mesh_tone(
        signal: _Array,
        sampling_rate_hz: float,
        teeth: int,
        shaft_hz: float,
        harmonic: int,
        half_band_hz: float | None,
    ) -> ShaftPhase: ...
    def of_mate(self, teeth: int, mate_teeth: int) -> ShaftPhase: ...
    def part(self, start: int, stop: int) -> ShaftPhase: ...
    @property
    def zero(self) -> str: ...
    @property
    def first_sample(self) -> int: ...
    @property
    def revolutions(self) -> _Array: ...
    @property
    def warnings(self) -> list[tuple[str, str, list[tuple[str, float]]]]: ...
    def mean_speed_hz(self, sampling_rate_hz: float) -> float: ...

def tachometer_pulses(
    waveform: _Array,
    sampling_rate_hz: float,
    threshold: float | None,
    hysteresis: float | None,
    edge: str,
) -> _Array: ...
def repair_pulses(time_s: _Array) -> tuple[_Array, list[str]]: ...
def process_train(
    signal: _Array,
    phase: ShaftPhase,
    machine: Scenario,
    sampling_rate_hz: float,
    shaft: str | None = None,
    sidebands: int | None = None,
    shaft_orders: list[int] | None = None,
) -> dict[str, Any]: ...
def process_channel(
    signal: _Array, phase: ShaftPhase, teeth: int, settings: Mapping[str, object] | None = None
) -> dict[str, Any]: ...
def find_mismatch(
    signal: _Array,
    phase: ShaftPhase,
    teeth: int,
    mate_teeth: int | None = None,
    pulses_per_revolution: int | None = None,
    speed_hz: float | None = None,
) -> tuple[str, float, str, float | None] | None: ...
def check_recording(
    signal: _Array,
    phase: ShaftPhase,
    sampling_rate_hz: float,
    teeth: int,
    mate_teeth: int | None = None,
    pulses_per_revolution: int | None = None,
    speed_hz: float | None = None,
) -> list[tuple[str, str, list[tuple[str, float]]]]: ...
def process_series(
    signals: Sequence[_Array],
    phases: Sequence[ShaftPhase],
    teeth: int,
    settings: Mapping[str, object] | None = None,
) -> list[dict[str, Any]]: ...
def resample(signal: _Array, from_hz: float, to_hz: float, edge: str) -> _Array: ...
def angular_resample(
    signal: _Array, phase: ShaftPhase, points_per_revolution: int | None, interpolation: str
) -> tuple[_Array, int, float, float]: ...
def order_map(
    signal: _Array, phase: ShaftPhase, sampling_rate_hz: float, revolutions: int | None, highest_order: float | None
) -> tuple[int, _Array, _Array, npt.NDArray[np.float64]]: ...
def named_bearings() -> list[tuple[str, _Bearing, str]]: ...
def defect_orders(bearing: _Bearing) -> tuple[float, float, float, float]: ...
def defect_lines(
    step: float, amplitudes: _Array, bearing: _Bearing, shaft: float
) -> list[tuple[str, str, float, float, float, float, bool]]: ...
def squared_envelope(signal: _Array, sampling_rate_hz: float, band_hz: tuple[float, float] | None) -> _Array: ...
def squared_envelope_spectrum(
    signal: _Array, sampling_rate_hz: float, band_hz: tuple[float, float] | None, phase: ShaftPhase | None
) -> tuple[float, _Array]: ...
def kurtogram(signal: _Array, sampling_rate_hz: float, most_levels: int) -> list[_Array]: ...
def bearings_of_train(
    signal: _Array,
    phase: ShaftPhase,
    machine: Scenario | None,
    sampling_rate_hz: float,
    shaft: str | None,
    bearings: Sequence[tuple[tuple[int, float, float, float], str | None]] | None,
    separation: str,
    band_hz: tuple[float, float] | None,
    of_kurtogram: bool,
) -> dict[str, Any]: ...
def best_band(levels: Sequence[_Array], sampling_rate_hz: float, least_width_hz: float) -> tuple[float, float, float] | None: ...
def spectral_kurtosis(signal: _Array, block_samples: int) -> _Array: ...
def cepstral_prewhitening(signal: _Array) -> _Array: ...
def discrete_random_separation(signal: _Array, block_samples: int, delay_samples: int) -> tuple[_Array, _Array]: ...
def synchronous_residual(signal: _Array, phases: Sequence[ShaftPhase]) -> tuple[int, _Array]: ...
def velocity_rms(acceleration_m_per_s2: _Array, sampling_rate_hz: float) -> float: ...
def synchronous_average(values: _Array, points_per_revolution: int) -> _Array: ...
def separate(
    average: _Array, teeth: int, sidebands: int | None, shaft_orders: Sequence[int] | None
) -> tuple[_Array, _Array, _Array]: ...
def envelope(signal: _Array) -> _Array: ...
def envelope_spectrum(signal: _Array) -> _Array: ...
def order_spectrum(average: _Array) -> _Array: ...
def fm0(average: _Array, teeth: int) -> float: ...
def fm4(difference: _Array) -> float: ...
def m6a(difference: _Array) -> float: ...
def m8a(difference: _Array) -> float: ...
def na4(residuals: Sequence[_Array]) -> _Array: ...
def energy_ratio(difference: _Array, regular: _Array) -> float: ...
def sideband_level_factor(average: _Array, teeth: int) -> float: ...
def statistics(signal: _Array) -> dict[str, float]: ...
def read_recording(
    path: _Path,
    channels: Sequence[_Column],
    sampling_rate_hz: float | None,
    variable: str | None,
    time: _Column | None,
    calibrations: Sequence[tuple[_Column, float | None, str | None]],
) -> dict[str, Any]: ...
def recording_files() -> list[tuple[str, bytes]]: ...
def set_memory_limit(limit_bytes: int | None) -> None: ...
def change_duration(signal: _Array, width_ratio: float, centre_rev: float) -> _Array: ...
def change_fault_to_harmonics_ratio(
    signal: _Array, healthy: _Array, fault_to_harmonics_ratio: float
) -> _Array: ...
def add_noise(signal: _Array, noise_level: float, healthy_rms: float, seed: int, draw: int) -> _Array: ...
def tune(path: _Path, progress: Callable[[int, int], None] | None) -> tuple[str, str]: ...
def enhance(scenario: Scenario, tuned: _Path, draws: int, seed: int) -> tuple[_Array, float]: ...
@final
class Observation:
    @staticmethod
    def of_simulated(
        machine: Scenario, signal: _Array, start_s: float
    ) -> Observation: ...
    @staticmethod
    def of_measured(
        signal: _Array,
        sampling_rate_hz: float,
        phase: ShaftPhase,
        shaft: str | None,
        machine: Scenario,
    ) -> Observation: ...
    @staticmethod
    def of_revolution(values: _Array, gear_teeth: int, signal: str) -> Observation: ...

def check_diagnosis(
    machine: Scenario, now: Sequence[Observation], healthy: Sequence[Observation]
) -> list[tuple[str, str]]: ...
def diagnose(
    machine: Scenario,
    now: Sequence[Observation],
    healthy: Sequence[Observation],
    reference: _Path | None,
    records: int,
    progress: Callable[[int, int], None] | None,
) -> tuple[str, _Array, list[_Array]]: ...
def tuned_rig(scenario: Scenario, path: _Path) -> Scenario: ...
def adapt_dataset(
    machine: Scenario,
    recordings: Sequence[tuple[_Array, float, ShaftPhase, str | None]],
    to: _Path,
    classes: Sequence[str] | None,
    numbers: tuple[int, int, int],
    progress: Callable[[int, int], None] | None,
) -> Adaptation: ...
def estimate_path(
    machine: Scenario,
    recordings: Sequence[tuple[_Array, float, ShaftPhase, str | None]],
    draws: int,
    seed: int,
    progress: Callable[[int, int], None] | None,
) -> tuple[
    list[_Array],
    list[float],
    tuple[
        list[float] | None,
        list[float] | None,
        list[float] | None,
        list[tuple[str, int, list[float], list[float], bool]],
    ],
    str,
    list[int],
]: ...
def dataset_template() -> str: ...
def check_plan(plan: _Path) -> None: ...
def generate_dataset(
    plan: _Path | dict[str, Any],
    records: int | None,
    to: str,
    jobs: int | None,
    part: int,
    of: int,
    progress: Callable[[int, int], None] | None,
) -> tuple[list[tuple[str, str]], list[str]]: ...
def merge_datasets(parts: Sequence[str], to: str, verify: bool) -> None: ...
def rows_like(
    plan: _Path,
    recordings: Sequence[tuple[Sequence[tuple[str | None, _Array]], ShaftPhase]],
    machine: Scenario,
    sampling_rate_hz: float,
    shaft: str | None,
) -> tuple[bytes, list[tuple[str, str, list[tuple[str, float]]]]]: ...
def verify_dataset(path: str, bytes: bool) -> tuple[list[str], list[str], dict[str, str]]: ...
