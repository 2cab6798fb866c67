"""Other rates, equal angles, and averages over revolutions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy.typing as npt

from .. import _core
from ._arguments import Array, finite_signal, signal_array, whole
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
        (any unit) The signal.
    from_hz, to_hz : float
        (S/s) Its rate and the wanted one.
    edge : {'reflect', 'zero', 'periodic'}
        How the signal goes on beyond its ends.

    Returns
    -------
    array, shape (samples · to_hz / from_hz, rounded up,)
        In the signal's unit; the first sample stays where it is.

    Raises
    ------
    ValueError
        NaN; no samples; a rate that is not positive, or below 1e-5 of the other.

    Notes
    -----
    The low-pass is that of MATLAB's ``resample`` and SciPy's ``resample_poly``: a sinc of 10 zero crossings on each side under
    Kaiser's window, β = 5.

    Examples
    --------
    >>> import numpy as np
    >>> resample(np.ones(1000), 1000, 500).round(6)[:3]
    array([1., 1., 1.])
    """
    return _core.resample(finite_signal(signal), from_hz, to_hz, edge)


@dataclass(frozen=True)
class AngularSignal:
    """A signal over whole revolutions of a shaft, at equal angles.

    Attributes
    ----------
    values : array, shape (revolutions * points_per_revolution,)
        Revolution after revolution, in the signal's unit.
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
        (any unit) The signal.
    phase : ShaftPhase
        Of the shaft.
    points_per_revolution : int, optional
        Values in a revolution; by default the power of two that is no less than the samples in the slowest one.
    interpolation : {'band-limited', 'pchip'}
        How the signal is read between its samples: by a sinc of 32 taps under Kaiser's window, or by monotone cubics.

    Returns
    -------
    AngularSignal

    Raises
    ------
    ValueError
        NaN, a constant signal, fewer than two whole revolutions.

    Notes
    -----
    K. R. Fyfe, E. D. S. Munck, "Analysis of computed order tracking", Mechanical Systems and Signal Processing 11 (1997) 187–205;
    ``'pchip'``: F. N. Fritsch, R. E. Carlson, SIAM Journal on Numerical Analysis 17 (1980) 238–246.

    Examples
    --------
    >>> import numpy as np
    >>> from meshtone import ShaftPhase
    >>> phase = ShaftPhase.constant(20.0, 1000.0, 1000)
    >>> angular = angular_resample(np.cos(2 * np.pi * 3 * phase.revolutions), phase)
    >>> angular.points_per_revolution, angular.values.size, round(angular.nyquist_order, 6)
    (64, 1216, 25.0)
    """
    points = None if points_per_revolution is None else whole("points_per_revolution", points_per_revolution, 1)
    return AngularSignal(*_core.angular_resample(signal_array(signal), native_phase(phase), points, interpolation))


def synchronous_average(angular: AngularSignal) -> Array:
    """Average over the revolutions: what repeats with the shaft stays, noise falls with the square root of their number.

    Parameters
    ----------
    angular : AngularSignal
        From :func:`angular_resample`.

    Returns
    -------
    array, shape (points_per_revolution,)
        In the signal's unit.

    Raises
    ------
    ValueError
        Fewer than two revolutions.

    Notes
    -----
    S. G. Braun, "The extraction of periodic waveforms by time domain averaging", Acustica 32 (1975) 69–77; P. D. McFadden, "A revised
    model for the extraction of periodic waveforms by time domain averaging", Mechanical Systems and Signal Processing 1 (1987) 83–95.
    """
    return _core.synchronous_average(angular.values, angular.points_per_revolution)
