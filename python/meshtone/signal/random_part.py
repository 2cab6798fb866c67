"""The part of a recording that is not periodic, and its velocity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy.typing as npt

from .. import _core
from ._arguments import Array, positive, signal_array, whole
from .phase import ShaftPhase, native_phase


@dataclass(frozen=True, eq=False)
class SynchronousResidual:
    """A recording without what repeats with its shafts.

    Attributes
    ----------
    values : array, shape (samples with a phase,)
        In the signal's unit.
    first_sample : int
        Sample of the recording that the first value belongs to.
    """

    values: Array
    first_sample: int


@dataclass(frozen=True, eq=False)
class DiscreteRandomParts:
    """A signal in two parts, whose sum it is, in its unit.

    Attributes
    ----------
    discrete : array, shape (samples,)
        Its tones: what can be predicted from the signal a delay earlier.
    random : array, shape (samples,)
        All else: noise, and bearings, which slip.
    """

    discrete: Array
    random: Array


def synchronous_residual(signal: npt.ArrayLike, phases: Sequence[ShaftPhase]) -> SynchronousResidual:
    """Remove the averages over the revolutions of all shafts from a recording, one after the other.

    Bearings, which slip, and noise stay; of R revolutions the average takes 1/R of their power.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        (any unit) The recording.
    phases : sequence of ShaftPhase
        Of the shafts, such as of :meth:`ShaftPhase.of_mate`; all begin at the same sample and have as many.

    Returns
    -------
    SynchronousResidual

    Raises
    ------
    ValueError
        No phase; phases of other samples; NaN; a constant signal; fewer than two revolutions.

    Examples
    --------
    >>> import numpy as np
    >>> from meshtone import ShaftPhase
    >>> phase = ShaftPhase.constant(20.0, 10_000.0, 20_000)
    >>> residual = synchronous_residual(np.cos(2 * np.pi * 19 * phase.revolutions), [phase])
    >>> bool(np.abs(residual.values).max() < 1e-3)
    True
    """
    first_sample, values = _core.synchronous_residual(signal_array(signal), [native_phase(phase) for phase in phases])
    return SynchronousResidual(values, first_sample)


def discrete_random_separation(
    signal: npt.ArrayLike, block_samples: int, delay_samples: int | None = None
) -> DiscreteRandomParts:
    """Separate a signal of constant speed into its tones and the rest; the speed need not be known.

    The size of the transfer function from the signal a delay earlier to the signal is near 1 at tones and near 0 elsewhere; it is the filter,
    without phase. Within half a block of the ends the discrete part is too small.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        (any unit) The signal, at least eight blocks and the delay long.
    block_samples : int
        Length of a block, at least 16: it resolves tones whose distance is more than about four times the sampling rate over
        it.
    delay_samples : int, optional
        Longer than a burst rings and slip leaves the next ones in step; by default a block.

    Returns
    -------
    DiscreteRandomParts

    Raises
    ------
    ValueError
        NaN; a constant signal; blocks that are too short; too short a signal.

    Notes
    -----
    J. Antoni, R. B. Randall, "Unsupervised noise cancellation for vibration signals: part II – a novel frequency-domain algorithm", Mechanical
    Systems and Signal Processing 18 (2004) 103–117.

    Examples
    --------
    >>> import numpy as np
    >>> noise = np.random.default_rng(1).standard_normal(100_000)
    >>> parts = discrete_random_separation(3 * np.cos(0.7 * np.arange(100_000)) + noise, 512)
    >>> bool(np.std(parts.random[1000:-1000] - noise[1000:-1000]) < 0.2)
    True
    """
    block = whole("block_samples", block_samples, 16)
    delay = block if delay_samples is None else whole("delay_samples", delay_samples, 1)
    return DiscreteRandomParts(*_core.discrete_random_separation(signal_array(signal), block, delay))


def cepstral_prewhitening(signal: npt.ArrayLike) -> Array:
    """The signal with all lines of its spectrum at the same amplitude and with their own phases: its real cepstrum is 0 but for the first value.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        (any unit) The signal.

    Returns
    -------
    array, shape (samples,)
        (-) With an rms of 1.

    Raises
    ------
    ValueError
        NaN; a constant signal.

    Notes
    -----
    P. Borghesani, P. Pennacchi, R. B. Randall, N. Sawalhi, R. Ricci, Mechanical Systems and Signal Processing 36 (2013) 370–384.

    Examples
    --------
    >>> import numpy as np
    >>> white = cepstral_prewhitening(np.random.default_rng(1).standard_normal(1000))
    >>> np.abs(np.fft.rfft(white)).std().round(9)
    np.float64(0.0)
    """
    return _core.cepstral_prewhitening(signal_array(signal))


def velocity_rms(acceleration_m_per_s2: npt.ArrayLike, sampling_rate_hz: float) -> float:
    """Rms of the vibration velocity from 10 to 1000 Hz, as ISO 20816-1:2016 defines it.

    The power spectrum of blocks of 4 s with a Hann window, divided by (2πf)² and summed.

    Parameters
    ----------
    acceleration_m_per_s2 : array_like, shape (samples,)
        (m/s²) The acceleration, at least 1 s of it.
    sampling_rate_hz : float
        (S/s) Its sampling rate, more than 2000.

    Returns
    -------
    float
        (mm/s)

    Raises
    ------
    ValueError
        NaN; a constant signal; a lower sampling rate; less than 1 s.

    Examples
    --------
    >>> import numpy as np
    >>> round(velocity_rms(np.cos(2 * np.pi * 100 * np.arange(20_000) / 10_000), 10_000), 4)
    1.1254
    """
    return _core.velocity_rms(signal_array(acceleration_m_per_s2), positive("sampling_rate_hz", sampling_rate_hz))
