"""Envelope and spectra of an average."""

from __future__ import annotations

import numpy.typing as npt

from .. import _core
from ._arguments import Array, signal_array


def envelope(signal: npt.ArrayLike) -> Array:
    """Amplitude of the analytic signal: positive orders doubled, negative ones removed, mean and Nyquist order kept.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        (any unit) One period: what comes behind its end is its start.

    Returns
    -------
    array, shape (samples,)
        In the signal's unit.

    Raises
    ------
    ValueError
        NaN, or no samples.

    Notes
    -----
    S. L. Marple, "Computing the discrete-time 'analytic' signal via FFT", IEEE Transactions on Signal Processing 47 (1999) 2600–2603.

    Examples
    --------
    >>> import numpy as np
    >>> envelope(3 * np.cos(2 * np.pi * 5 * np.arange(64) / 64)).round(6)[:3]
    array([3., 3., 3.])
    """
    return _core.envelope(signal_array(signal))


def envelope_spectrum(signal: npt.ArrayLike) -> Array:
    """Amplitudes of the envelope at each order: the :func:`order_spectrum` of the :func:`envelope`, whose mean is at order 0.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        (any unit) One revolution at equal angles.

    Returns
    -------
    array, shape (samples // 2 + 1,)
        In the signal's unit; the index is the order.

    Raises
    ------
    ValueError
        NaN, or no samples.

    Notes
    -----
    P. D. McFadden, "Detecting fatigue cracks in gears by amplitude and phase demodulation of the meshing vibration", Journal of
    Vibration and Acoustics 108 (1986) 165–170.

    Examples
    --------
    >>> import numpy as np
    >>> angle = 2 * np.pi * np.arange(256) / 256
    >>> envelope_spectrum((2 + np.cos(3 * angle)) * np.cos(40 * angle)).round(6)[:4]
    array([2., 0., 0., 1.])
    """
    return _core.envelope_spectrum(signal_array(signal))


def order_spectrum(average: npt.ArrayLike) -> Array:
    """Amplitude at each order, single-sided and without a window: of a cosine its amplitude, at order 0 the mean's size.

    Parameters
    ----------
    average : array_like, shape (points,)
        (any unit) One revolution at equal angles.

    Returns
    -------
    array, shape (points // 2 + 1,)
        In the average's unit; the index is the order. With X the discrete Fourier transform of N points |X_0|/N, 2|X_k|/N, and
        |X_(N/2)|/N at the Nyquist order, by definition.

    Raises
    ------
    ValueError
        NaN, or no points.

    Examples
    --------
    >>> import numpy as np
    >>> order_spectrum(3 * np.cos(2 * np.pi * 5 * np.arange(64) / 64)).round(6)[5]
    np.float64(3.0)
    """
    return _core.order_spectrum(signal_array(average))
