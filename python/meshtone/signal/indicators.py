"""Condition indicators of averages and their parts.

The mean x̄, the population moments µ_k = mean((x − x̄)^k), and the amplitudes A of the order spectrum are those of the book's chapter
"From a recording to indicators", which has all sources.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NoReturn

import numpy.typing as npt

from .. import _core
from .._names import near
from ._arguments import Array, signal_array, teeth_number


INDICATORS = _core.INDICATORS
"""Names of all."""


SHOWN = ("average_rms", "difference_rms", "difference_kurtosis", "fm0", "fm4", "na4")
"""Names of those that are shown where there is little room."""


class Indicators(dict[str, float]):
    """All condition indicators of a record, by name: a dictionary that says which name was meant by one that it does not have.

    Notes
    -----
    Of each of the five signals ``average``, ``regular``, ``residual``, ``difference`` and ``envelope`` (that of the difference) its
    size and shape, after P. Večeř, M. Kreidl, R. Šmíd, "Condition indicators for gearbox condition monitoring systems", Acta
    Polytechnica 45(6) (2005) 35–43:

    ========================  ==================  =============================================  ==========================
    name                      unit                formula                                        of Gaussian noise
    ========================  ==================  =============================================  ==========================
    ``…_rms``                 the channel's       √mean(x²), mean included                       its standard deviation
    ``…_peak_to_peak``        the channel's       max x − min x
    ``…_crest_factor``        \\-                  max |x| / rms
    ``…_skewness``            \\-                  µ3 / µ2^1.5                                    0
    ``…_kurtosis``            \\-                  µ4 / µ2², not the excess                       3
    ========================  ==================  =============================================  ==========================

    and those of gears, all without unit: ``fm0``, ``fm4``, ``m6a``, ``m8a``, ``na4``, ``energy_ratio``, ``sideband_level_factor``,
    whose formulas and sources the functions of their names in :mod:`meshtone.signal` have. Of the difference there are the rms and the
    kurtosis in octaves of mesh orders, ``difference_octave_1_rms``, ``difference_octave_half_kurtosis``, and of the average the
    amplitudes of the mesh harmonics 1 to 8 and of two sidebands on each side: ``mesh_harmonic_3``, ``mesh_harmonic_3_sideband_minus_1``,
    ``mesh_harmonic_3_sideband_plus_2``. One that is not defined, as the kurtosis of a part that is 0 or an amplitude beyond what the
    sampling rate shows, is NaN.

    Examples
    --------
    >>> indicators = Indicators(fm0=4.1, fm4=3.2)
    >>> indicators["fm4"]
    3.2
    >>> indicators["FM4"]
    Traceback (most recent call last):
        ...
    KeyError: "there is no indicator 'FM4'; did you mean 'fm4'? There are fm0, fm4"
    """

    def __missing__(self, name: str) -> NoReturn:
        meant = " or ".join(f"'{known}'" for known in near(name, self))
        question = f"did you mean {meant}? There" if meant else "there"
        raise KeyError(f"there is no indicator '{name}'; {question} are {', '.join(self)}")


def fm0(average: npt.ArrayLike, teeth: int) -> float:
    """FM0: peak-to-peak of the average over the sum of its mesh harmonics' amplitudes, (max x − min x) / Σ_h A(h·teeth).

    It rises where one tooth is damaged (more peak) and where all are worn (less mesh).

    Parameters
    ----------
    average : array_like, shape (points,)
        (any unit) One revolution at equal angles.
    teeth : int
        Of the wheel.

    Returns
    -------
    float
        (-) NaN where there is no mesh.

    Raises
    ------
    ValueError
        NaN; no points; a mesh order beyond the Nyquist order.

    Notes
    -----
    R. M. Stewart, "Some useful data analysis techniques for gearbox diagnostics", report MHM/R/10/77, ISVR, University of
    Southampton (1977).

    Examples
    --------
    >>> import numpy as np
    >>> round(fm0(np.cos(2 * np.pi * 10 * np.arange(40) / 40), teeth=10), 12)
    2.0
    """
    return _core.fm0(signal_array(average), teeth_number(teeth))


def fm4(difference: npt.ArrayLike) -> float:
    """FM4: kurtosis of the difference, µ4 / µ2²; 3 where it is noise, more where a tooth stands out.

    Parameters
    ----------
    difference : array_like, shape (points,)
        (any unit) From :func:`separate`.

    Returns
    -------
    float
        (-) NaN where the difference is constant, has NaN in it, or no points.

    Raises
    ------
    ValueError
        An array that is not of one dimension.

    Notes
    -----
    R. M. Stewart, as :func:`fm0`.

    Examples
    --------
    >>> import numpy as np
    >>> round(fm4(np.cos(2 * np.pi * np.arange(100) / 100)), 12)
    1.5
    """
    return _core.fm4(signal_array(difference))


def m6a(difference: npt.ArrayLike) -> float:
    """M6A: µ6 / µ2³ of the difference; 15 where it is Gaussian noise. More sensitive to peaks than FM4.

    Parameters
    ----------
    difference : array_like, shape (points,)
        (any unit) From :func:`separate`.

    Returns
    -------
    float
        (-) NaN as of :func:`fm4`.

    Raises
    ------
    ValueError
        An array that is not of one dimension.

    Notes
    -----
    H. R. Martin, "Statistical moment analysis as a means of surface damage detection", Proceedings of the 7th International Modal
    Analysis Conference (1989) 1016–1021.

    Examples
    --------
    >>> m6a([1.0, -1.0, 1.0, -1.0])
    1.0
    """
    return _core.m6a(signal_array(difference))


def m8a(difference: npt.ArrayLike) -> float:
    """M8A: µ8 / µ2⁴ of the difference; 105 where it is Gaussian noise.

    Parameters
    ----------
    difference : array_like, shape (points,)
        (any unit) From :func:`separate`.

    Returns
    -------
    float
        (-) NaN as of :func:`fm4`.

    Raises
    ------
    ValueError
        An array that is not of one dimension.

    Notes
    -----
    H. R. Martin, as :func:`m6a`.

    Examples
    --------
    >>> m8a([1.0, -1.0, 1.0, -1.0])
    1.0
    """
    return _core.m8a(signal_array(difference))


def na4(residuals: Sequence[npt.ArrayLike]) -> Array:
    """NA4 of each record of a series: µ4 of its residual over the square of the mean µ2 of the records so far.

    Unlike FM4 it goes on rising while damage spreads, because the variance of the sound beginning stays in the mean.

    Parameters
    ----------
    residuals : sequence of array_like, shape (points,)
        (any unit, the same of all) From :func:`separate`, in the order of the records.

    Returns
    -------
    array, shape (records,)
        (-) NaN as long as all residuals are constant.

    Raises
    ------
    ValueError
        NaN; no records; one without points.

    Notes
    -----
    J. J. Zakrajsek, D. P. Townsend, H. J. Decker, "An analysis of gear fault detection methods as applied to pitting fatigue failure
    data", NASA TM-105950 (1993).

    Examples
    --------
    >>> na4([[1.0, -1.0, 1.0, -1.0], [1.0, -1.0, 3.0, -3.0]]).round(2)
    array([1.  , 4.56])
    """
    return _core.na4([signal_array(residual) for residual in residuals])


def energy_ratio(difference: npt.ArrayLike, regular: npt.ArrayLike) -> float:
    """Energy ratio: standard deviation of the difference over that of the regular part, √(µ2 / µ2).

    Parameters
    ----------
    difference, regular : array_like, shape (points,)
        (any unit, the same of both) From :func:`separate`.

    Returns
    -------
    float
        (-) NaN where the regular part is constant, or one of them has NaN in it.

    Raises
    ------
    ValueError
        An array that is not of one dimension.

    Notes
    -----
    N. S. Swansson, "Application of vibration signal analysis techniques to signal monitoring", Conference on Friction and Wear in
    Engineering, Institution of Engineers, Australia (1980) 262–267.

    Examples
    --------
    >>> energy_ratio([1.0, -1.0], [4.0, -4.0])
    0.25
    """
    return _core.energy_ratio(signal_array(difference), signal_array(regular))


def sideband_level_factor(average: npt.ArrayLike, teeth: int) -> float:
    """Sideband level factor: amplitudes of the first sidebands of the mesh order over the average's standard deviation.

    Parameters
    ----------
    average : array_like, shape (points,)
        (any unit) One revolution at equal angles.
    teeth : int
        Of the wheel.

    Returns
    -------
    float
        (-) NaN where the average is constant; a sideband beyond the Nyquist order counts as 0.

    Raises
    ------
    ValueError
        NaN; no points; a mesh order beyond the Nyquist order.

    Notes
    -----
    P. Večeř, M. Kreidl, R. Šmíd, "Condition indicators for gearbox condition monitoring systems", Acta Polytechnica 45(6) (2005)
    35–43.

    Examples
    --------
    >>> import numpy as np
    >>> round(sideband_level_factor(np.cos(2 * np.pi * 9 * np.arange(40) / 40), teeth=10) ** 2, 12)
    2.0
    """
    return _core.sideband_level_factor(signal_array(average), teeth_number(teeth))


def statistics(signal: npt.ArrayLike) -> dict[str, float]:
    """Size and shape of a signal: rms, peak-to-peak, crest factor, skewness and kurtosis.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        (any unit) The signal.

    Returns
    -------
    dict of str to float
        ``rms`` and ``peak_to_peak`` in the signal's unit, ``crest_factor``, ``skewness`` and ``kurtosis`` (3 for Gaussian noise)
        without one; as :class:`Indicators` defines them.

    Raises
    ------
    ValueError
        NaN, a constant signal, fewer than two samples.

    Notes
    -----
    P. Večeř, M. Kreidl, R. Šmíd, as :func:`sideband_level_factor`.

    Examples
    --------
    >>> import numpy as np
    >>> {name: round(value, 3) for name, value in statistics(np.cos(np.arange(628) / 100)).items()}["rms"]
    0.707
    """
    return _core.statistics(signal_array(signal))
