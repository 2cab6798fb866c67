"""The class of a sensor.

Written by `cargo xtask generate` from the rows of the Rust library: a change belongs there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypedDict


class SensorPath(TypedDict, total=False):
    """The table ``path`` of a sensor.

    Attributes
    ----------
    plate_hz : float
        (Hz) The frequency at which the wall under the sensor bends as far as the support moves; 0: no wall. Allowed: ≥
        0, ≤ 10000000.
    strength : float
        (-) The standard deviation of a housing mode's share; 0: no modes. Allowed: ≥ 0, ≤ 100.
    modes_per_khz : float
        (1/kHz) The housing modes in a kilohertz. Allowed: > 0, ≤ 1000.
    band_hz : sequence of 2 floats
        (Hz) The frequency band of the housing's modes. Allowed: > 0, ≤ 10000000; the first less than the second.
    damping_ratio : float
        (-) The damping ratio of the housing's modes. Allowed: > 0, ≤ 1.
    seed : int
        The seed of the housing's modes. Allowed: whole number.
    """

    plate_hz: float
    strength: float
    modes_per_khz: float
    band_hz: Sequence[float]
    damping_ratio: float
    seed: int


@dataclass(frozen=True)
class Sensor:
    """An accelerometer on the rig; ``None`` is the default of a key.

    Parameters
    ----------
    name : str, optional
        The sensor's name; its signal is the channel ``NAME_g``. Allowed: a letter, then letters, digits and ``_``; no
        other channel's. Default: place and direction, such as ``gear_support_vertical``.
    at : {'support', 'pinion-support', 'gear-support', 'wheels'}, optional
        Where it sits: on both supports (their mean), on one, or on the wheels (their sum); always the wheels under
        linear and published. Default: "pinion-support". Ignored by linear, published.
    direction : {'radial', 'tangential', 'vertical', 'horizontal', 'axial'}, optional
        The direction it measures in; under contact axial only at the wheels. Default: "vertical".
    resonance_hz : float, optional
        (Hz) The natural frequency of the sensor on its mount. Allowed: > 0, ≤ 10000000. Default: none.
    resonance_damping_ratio : float, optional
        (-) The damping ratio of that resonance. Allowed: > 0, ≤ 10. Default: 0.02.
    noise_density_g_per_rthz : float, optional
        (g/√Hz) The density of its white normal noise: the standard deviation over the root of half the sampling rate.
        Allowed: ≥ 0, ≤ 1000. Default: 0.0.
    noise_seed : int, optional
        The seed of the noise alone. Allowed: whole number. Default: the scenario's ``seed``.
    range_g : float, optional
        (g) The largest acceleration, of either sign, that it measures. Allowed: > 0, ≤ 1e9. Default: none.
    bits : int, optional
        The resolution: the range from minus to plus has 2^bits steps. Allowed: whole number 8…32; with range_g.
        Default: none.
    path : SensorPath, optional
        The wall and the modes of a housing between its place and the sensor; rigid under linear and published. Default:
        { plate_hz = 4000.0, strength = 0.0, modes_per_khz = 1.43, band_hz = [3500.0, 14000.0], damping_ratio = 0.015,
        seed = 1 }. Ignored by linear, published.
    frequency_response : dict of frequency_hz, magnitude and phase_deg, optional
        (Hz, -, °) The measured path to the sensor: magnitude and phase over frequency, straight between the points, the
        phase unwrapped; zero outside them. Or { file = "….csv" } with the columns frequency_hz, magnitude, phase_deg.
        Allowed: at least 2 points, frequencies increasing from 0 on, magnitudes ≥ 0. Default: none.
    response_input : {'acceleration', 'force'}, optional
        The input of the frequency response: the place's acceleration, magnitudes without unit; or, regardless of ``at``
        and ``direction``, the force along the line of action, magnitudes in (m/s²)/N. Default: "acceleration".

    Notes
    -----
    Its signal is in g, of shape (samples,). What is not allowed is a ``ValueError`` of the scenario that has the sensor.
    Mounted resonance: ISO 5348. Frequency response: ISO 7626-5. The book's chapter "Sensors" has the formulas.
    """

    name: str | None = None
    at: Literal["support", "pinion-support", "gear-support", "wheels"] | None = None
    direction: Literal["radial", "tangential", "vertical", "horizontal", "axial"] | None = None
    resonance_hz: float | None = None
    resonance_damping_ratio: float | None = None
    noise_density_g_per_rthz: float | None = None
    noise_seed: int | None = None
    range_g: float | None = None
    bits: int | None = None
    path: SensorPath | None = None
    frequency_response: Mapping[str, Any] | None = None
    response_input: Literal["acceleration", "force"] | None = None
