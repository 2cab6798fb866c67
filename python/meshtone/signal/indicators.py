"""Condition indicators of averages and their parts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy.typing as npt

from .. import _core
from ._arguments import Array, signal_array, teeth_number


def fm0(average: npt.ArrayLike, teeth: int) -> float:
    """FM0: peak-to-peak of the average over the sum of its mesh harmonics' amplitudes.

    Parameters
    ----------
    average : array_like, shape (points,)
        One revolution at equal angles.
    teeth : int
        Of the wheel.
    """
    return _core.fm0(signal_array(average), teeth_number(teeth))


def fm4(difference: npt.ArrayLike) -> float:
    """FM4: µ4 / µ2² of the difference.

    Parameters
    ----------
    difference : array_like, shape (points,)
        From :func:`separate`.

    Examples
    --------
    >>> import numpy as np
    >>> round(fm4(np.cos(2 * np.pi * np.arange(100) / 100)), 12)
    1.5
    """
    return _core.fm4(signal_array(difference))


def m6a(difference: npt.ArrayLike) -> float:
    """M6A: µ6 / µ2³ of the difference.

    Parameters
    ----------
    difference : array_like, shape (points,)
        From :func:`separate`.
    """
    return _core.m6a(signal_array(difference))


def m8a(difference: npt.ArrayLike) -> float:
    """M8A: µ8 / µ2⁴ of the difference.

    Parameters
    ----------
    difference : array_like, shape (points,)
        From :func:`separate`.
    """
    return _core.m8a(signal_array(difference))


def na4(residuals: Sequence[npt.ArrayLike]) -> Array:
    """NA4 of each record of a series: µ4 of its residual over the square of the mean µ2 of the records so far.

    Parameters
    ----------
    residuals : sequence of array_like
        In the order of the records.

    Returns
    -------
    array, shape (records,)
    """
    return _core.na4([signal_array(residual) for residual in residuals])


def energy_ratio(difference: npt.ArrayLike, regular: npt.ArrayLike) -> float:
    """Standard deviation of the difference over that of the regular part.

    Parameters
    ----------
    difference, regular : array_like, shape (points,)
        From :func:`separate`.
    """
    return _core.energy_ratio(signal_array(difference), signal_array(regular))


def sideband_level_factor(average: npt.ArrayLike, teeth: int) -> float:
    """Amplitudes of the first sidebands of the mesh order over the average's standard deviation.

    Parameters
    ----------
    average : array_like, shape (points,)
        One revolution at equal angles.
    teeth : int
        Of the wheel.
    """
    return _core.sideband_level_factor(signal_array(average), teeth_number(teeth))


def statistics(signal: npt.ArrayLike) -> dict[str, float]:
    """Rms, peak-to-peak, crest factor, skewness and kurtosis (3 for Gaussian noise).

    Parameters
    ----------
    signal : array_like, shape (samples,)
        The signal.

    Returns
    -------
    dict of str to float

    Raises
    ------
    ValueError
        NaN, a constant signal.

    Examples
    --------
    >>> import numpy as np
    >>> {name: round(value, 3) for name, value in statistics(np.cos(np.arange(628) / 100)).items()}["rms"]
    0.707
    """
    return _core.statistics(signal_array(signal))
