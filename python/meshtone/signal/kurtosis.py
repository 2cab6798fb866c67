"""Bands in which a signal is impulsive."""

from __future__ import annotations

from dataclasses import dataclass

import numpy.typing as npt

from .. import _core
from ._arguments import Array, positive, signal_array, whole


@dataclass(frozen=True)
class KurtogramBand:
    """A band of a kurtogram.

    Attributes
    ----------
    band_hz : (float, float)
        (Hz) Its ends.
    kurtosis : float
        (-) Kurtosis of the complex envelope in it.
    """

    band_hz: tuple[float, float]
    kurtosis: float


@dataclass(frozen=True, eq=False)
class Kurtogram:
    """Kurtosis of a signal's complex envelope in bands of all widths.

    Attributes
    ----------
    levels : list of array
        (-) For each level the kurtosis in its bands, which divide 0 to half the sampling rate into equal parts.
    sampling_rate_hz : float
        (S/s) Sampling rate of the signal.
    """

    levels: list[Array]
    sampling_rate_hz: float

    def best(self, least_width_hz: float = 0.0) -> KurtogramBand:
        """The band with the largest kurtosis.

        Parameters
        ----------
        least_width_hz : float
            (Hz) Narrower bands do not count: an envelope shows no frequency above the width of its band. Where none is wide enough, the band of
            all frequencies is given.
        """
        best = _core.best_band(self.levels, self.sampling_rate_hz, float(least_width_hz))
        assert best is not None  # There always is the band of all frequencies.
        return KurtogramBand(best[:2], best[2])


def kurtogram(signal: npt.ArrayLike, sampling_rate_hz: float, *, most_levels: int = 7) -> Kurtogram:
    """Fast kurtogram: kurtosis of the complex envelope c, ⟨|c|⁴⟩/⟨|c|²⟩² − 2, in 1, 2, 3, 4, 6, 8, 12 … equal bands.

    It is 0 in Gaussian noise, −1 of a tone, and large where bursts stand out. Bands are cut out of the spectrum of the whole signal, so that
    values differ slightly from those of the original's short filters.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        (any unit) The signal; less than 1 % at its end is left out where its length is inconvenient.
    sampling_rate_hz : float
        (S/s) Its sampling rate.
    most_levels : int
        There are at most 2 to this power of bands, fewer where one would hold fewer than 256 lines of the spectrum.

    Returns
    -------
    Kurtogram

    Raises
    ------
    ValueError
        NaN; a constant signal; fewer than 512 samples.

    Notes
    -----
    J. Antoni, "Fast computation of the kurtogram for the detection of transient faults", Mechanical Systems and Signal Processing 21 (2007)
    108–124.

    Examples
    --------
    >>> import numpy as np
    >>> time_s = np.arange(50_000) / 20_000
    >>> bursts = np.exp(-1000 * (time_s % 0.05)) * np.sin(2 * np.pi * 3000 * time_s)
    >>> noise = 0.1 * np.random.default_rng(1).standard_normal(time_s.size)
    >>> best = kurtogram(bursts + noise + 2 * np.sin(2 * np.pi * 1000 * time_s), 20_000).best(500)
    >>> best.band_hz[0] < 3000 < best.band_hz[1]
    True
    """
    rate_hz = positive("sampling_rate_hz", sampling_rate_hz)
    return Kurtogram(_core.kurtogram(signal_array(signal), rate_hz, whole("most_levels", most_levels)), rate_hz)


def spectral_kurtosis(signal: npt.ArrayLike, block_samples: int) -> Array:
    """For each frequency how much the power varies from block to block: ⟨|X|⁴⟩/⟨|X|²⟩² − 2 of the spectra X of blocks with a Hann window.

    It is 0 in stationary Gaussian noise, −1 at a steady tone, and large where bursts stand out. At frequency 0 and at half the sampling
    rate, where the spectrum is real, 3 is subtracted instead of 2.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        (any unit) The signal, at least two blocks long.
    block_samples : int
        Length of a block, at least 4: longer than a burst, shorter than the distance of two. Each begins a quarter of it after the one before.

    Returns
    -------
    array, shape (block_samples // 2 + 1,)
        From frequency 0 to half the sampling rate; 0 where there is nothing, which is not impulsive.

    Raises
    ------
    ValueError
        NaN; a constant signal; blocks that are too short or too long.

    Notes
    -----
    J. Antoni, "The spectral kurtosis: a useful tool for characterising non-stationary signals", Mechanical Systems and Signal Processing 20
    (2006) 282–307.

    Examples
    --------
    >>> import numpy as np
    >>> spectral_kurtosis(np.cos(2 * np.pi * np.arange(4096) / 4), 64)[16].round(6)
    np.float64(-1.0)
    """
    return _core.spectral_kurtosis(signal_array(signal), whole("block_samples", block_samples, 4))
