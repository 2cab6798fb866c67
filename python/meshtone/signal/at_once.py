"""Average and difference of one's own arrays, in one call."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ._arguments import Array, signal_array
from .angular import angular_resample, synchronous_average
from .phase import ShaftPhase
from .separation import separate


def tsa(
    signal: npt.ArrayLike,
    sampling_rate_hz: float,
    pulses_s: npt.ArrayLike,
    pulses_per_revolution: int = 1,
    *,
    points_per_revolution: int | None = None,
) -> Array:
    """Time-synchronous average: one revolution of a shaft, at equal angles, the mean of all whole ones.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        The signal, in any unit.
    sampling_rate_hz : float
        (S/s) Its rate.
    pulses_s : array_like, shape (pulses,)
        (s) Times of the shaft's pulses; 0 is the first sample. :func:`tachometer_pulses` finds them in a tachometer's signal.
    pulses_per_revolution : int
        Of the shaft that is averaged over.
    points_per_revolution : int, optional
        Values in a revolution; by default so many that nothing is lost.

    Returns
    -------
    array, shape (points,)
        In the signal's unit.

    Raises
    ------
    ValueError
        NaN, a constant signal, fewer than two whole revolutions, pulses that cannot be mended.

    Notes
    -----
    S. Braun, "The synchronous (time domain) average revisited", Mechanical Systems and Signal Processing 25 (2011).

    Examples
    --------
    >>> import numpy as np
    >>> time_s = np.arange(20_000) / 10e3
    >>> average = tsa(np.cos(2 * np.pi * 20 * 19 * time_s), 10e3, np.arange(0, 2, 1 / 20))
    >>> round(float(average.max() - average.min()), 2)
    2.0
    """
    values = signal_array(signal)
    if np.ndim(pulses_s) == 0:
        raise TypeError(_no_times(pulses_s, sampling_rate_hz, values.size))
    phase = ShaftPhase.from_pulses(pulses_s, pulses_per_revolution, sampling_rate_hz, values.size)
    return synchronous_average(angular_resample(values, phase, points_per_revolution=points_per_revolution))


def _no_times(given: object, sampling_rate_hz: float, samples: int) -> str:
    """The error message for a number where times of pulses belong: it is rather a speed."""
    times = "times of the shaft's pulses in s, an array"
    if not isinstance(given, (int, float)):
        return f"pulses_s = {given!r}: must be {times}"
    return (
        f"pulses_s = {given:g}: must be {times}; of a constant speed of {given:g} revolutions per second "
        f"np.arange(0, {samples} / {sampling_rate_hz:g}, 1 / {given:g})"
    )


def difference(
    signal: npt.ArrayLike,
    sampling_rate_hz: float,
    pulses_s: npt.ArrayLike,
    teeth: int,
    pulses_per_revolution: int = 1,
    *,
    sidebands: int | None = None,
    shaft_orders: Sequence[int] | None = None,
) -> Array:
    """Difference signal: the time-synchronous average without what the mesh makes of it.

    Parameters
    ----------
    signal, sampling_rate_hz, pulses_s, pulses_per_revolution
        As of :func:`tsa`.
    teeth : int
        Of the wheel on the shaft that the pulses are of.
    sidebands, shaft_orders
        What is taken off beside the mesh harmonics, as of :func:`separate`.

    Returns
    -------
    array, shape (points,)
        In the signal's unit.

    Raises
    ------
    ValueError
        As :func:`tsa` and :func:`separate`.

    Examples
    --------
    >>> import numpy as np
    >>> time_s = np.arange(20_000) / 10e3
    >>> mesh, fault = np.cos(2 * np.pi * 20 * 19 * time_s), 0.1 * np.cos(2 * np.pi * 20 * 27 * time_s)
    >>> round(float(np.abs(difference(mesh + fault, 10e3, np.arange(0, 2, 1 / 20), teeth=19)).max()), 2)
    0.1
    """
    average = tsa(signal, sampling_rate_hz, pulses_s, pulses_per_revolution)
    return separate(average, teeth, sidebands=sidebands, shaft_orders=shaft_orders).difference
