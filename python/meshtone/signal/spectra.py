"""Envelope and spectra of an average."""

from __future__ import annotations

import numpy.typing as npt

from .. import _core
from ._arguments import Array, signal_array


def envelope(signal: npt.ArrayLike) -> Array:
    """Amplitude of the analytic signal.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        One period.

    Returns
    -------
    array, shape (samples,)

    Raises
    ------
    ValueError
        NaN, or no samples.
    """
    return _core.envelope(signal_array(signal))


def envelope_spectrum(signal: npt.ArrayLike) -> Array:
    """Amplitudes of the envelope at each order.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        One revolution.

    Returns
    -------
    array, shape (samples // 2 + 1,)
        The index is the order.
    """
    return _core.envelope_spectrum(signal_array(signal))


def order_spectrum(average: npt.ArrayLike) -> Array:
    """Amplitude at each order: of a cosine its amplitude, at order 0 the mean.

    Parameters
    ----------
    average : array_like, shape (points,)
        One revolution at equal angles.

    Returns
    -------
    array, shape (points // 2 + 1,)
        The index is the order.

    Examples
    --------
    >>> import numpy as np
    >>> order_spectrum(3 * np.cos(2 * np.pi * 5 * np.arange(64) / 64)).round(6)[5]
    np.float64(3.0)
    """
    return _core.order_spectrum(signal_array(average))
