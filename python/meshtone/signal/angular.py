"""Other rates, equal angles, and averages over revolutions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy.typing as npt

from .. import _core
from ._arguments import Array, signal_array, whole
from .phase import ShaftPhase, native_phase


def resample(
    signal: npt.ArrayLike,
    from_hz: float,
    to_hz: float,
    *,
    edge: Literal["zero", "reflect", "periodic"] = "reflect",
) -> Array:
    """The same signal at another sampling rate, whatever their ratio, behind an anti-aliasing filter.

    Within 0.2 % up to 0.8 of half the lower rate, half at half that rate, below 0.2 % from 1.2 of it on: the filter of SciPy's
    ``resample_poly``, and where the rates have no ratio of whole numbers up to 100 000 the same to 5e-6 of the largest value.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        The signal.
    from_hz, to_hz : float
        (S/s) Its rate and the wanted one.
    edge : {'reflect', 'zero', 'periodic'}
        How the signal goes on beyond its ends.

    Returns
    -------
    array

    Raises
    ------
    ValueError
        NaN; a rate that is not positive, or below 1e-5 of the other.

    Examples
    --------
    >>> import numpy as np
    >>> resample(np.ones(1000), 1000, 500).round(6)[:3]
    array([1., 1., 1.])
    """
    return _core.resample(signal_array(signal), from_hz, to_hz, edge)


@dataclass(frozen=True)
class AngularSignal:
    """A signal over whole revolutions of a shaft, at equal angles.

    Attributes
    ----------
    values : array, shape (revolutions * points_per_revolution,)
        Revolution after revolution.
    points_per_revolution : int
        Values in a revolution.
    start_rev : float
        (rev) Angle of the first value.
    nyquist_order : float
        Highest order that the sampling rate shows.
    """

    values: Array
    points_per_revolution: int
    start_rev: float
    nyquist_order: float


def angular_resample(
    signal: npt.ArrayLike,
    phase: ShaftPhase,
    *,
    points_per_revolution: int | None = None,
    interpolation: Literal["band-limited", "pchip"] = "band-limited",
) -> AngularSignal:
    """A signal over whole revolutions of a shaft, at equal angles.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        The signal.
    phase : ShaftPhase
        Of the shaft.
    points_per_revolution : int, optional
        Values in a revolution; by default so many that nothing is lost.
    interpolation : {'band-limited', 'pchip'}
        How the signal is read between its samples.

    Returns
    -------
    AngularSignal

    Raises
    ------
    ValueError
        NaN, a constant signal, fewer than two whole revolutions.
    """
    points = None if points_per_revolution is None else whole("points_per_revolution", points_per_revolution, 1)
    return AngularSignal(*_core.angular_resample(signal_array(signal), native_phase(phase), points, interpolation))


def synchronous_average(angular: AngularSignal) -> Array:
    """Average over the revolutions.

    Parameters
    ----------
    angular : AngularSignal
        From :func:`angular_resample`.

    Returns
    -------
    array, shape (points_per_revolution,)
    """
    return _core.synchronous_average(angular.values, angular.points_per_revolution)
