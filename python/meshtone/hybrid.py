"""The hybrid stage: simulated difference signals that resemble a rig's.

What the three modifications mean, and how they are tuned: the book's chapters "The hybrid stage" and "Tuning to a rig".
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from os import PathLike
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core, _progress
from ._files import written_whole
from ._warnings import warn
from .faults import in_words
from .scenario import Scenario, native_scenario
from .signal._arguments import signal_array, whole

__all__ = [
    "EnhancedSignals",
    "Tuning",
    "add_noise",
    "change_duration",
    "change_fault_to_harmonics_ratio",
    "enhance",
    "tune",
]

Array = npt.NDArray[np.float64]


def change_duration(signal: npt.ArrayLike, width_ratio: float, centre_rev: float) -> Array:
    """Stretch or shrink the fault's response.

    Parameters
    ----------
    signal : array_like, shape (points,)
        One cycle.
    width_ratio : float
        (-) Below 1 the central part of that width is stretched to the whole cycle; above 1 the cycle is shrunk.
    centre_rev : float
        (rev) Where the fault's response is.

    Returns
    -------
    array, shape (points,)

    Raises
    ------
    ValueError
        NaN, fewer than 4 points, a width that is not above 0.

    Examples
    --------
    >>> import numpy as np
    >>> bool(np.allclose(change_duration(np.arange(8.0), 1.0, 0.5), np.arange(8.0)))
    True
    """
    return _core.change_duration(signal_array(signal), width_ratio, centre_rev)


def change_fault_to_harmonics_ratio(
    signal: npt.ArrayLike, healthy: npt.ArrayLike, fault_to_harmonics_ratio: float
) -> Array:
    """Change the ratio of the fault's response to what a healthy pair shows: α·signal + (1 − α)·healthy.

    Parameters
    ----------
    signal, healthy : array_like, shape (points,)
        One cycle of the damaged and of the healthy pair, of the same duration.
    fault_to_harmonics_ratio : float
        (-) α; 1 changes nothing.

    Returns
    -------
    array, shape (points,)

    Examples
    --------
    >>> change_fault_to_harmonics_ratio([1.0, 3.0, 1.0, 1.0], [1.0, 1.0, 1.0, 1.0], 2.0)
    array([1., 5., 1., 1.])
    """
    return _core.change_fault_to_harmonics_ratio(signal_array(signal), signal_array(healthy), fault_to_harmonics_ratio)


def add_noise(
    signal: npt.ArrayLike, noise_level: float, healthy_rms: float, *, seed: int = 1, draw: int = 0
) -> Array:
    """Add white Gaussian noise.

    Parameters
    ----------
    signal : array_like, shape (points,)
        One cycle.
    noise_level : float
        (-) Standard deviation of the noise over ``healthy_rms``.
    healthy_rms : float
        (the signal's unit) Rms of the healthy pair's cycle.
    seed, draw : int
        The same two give the same noise.

    Returns
    -------
    array, shape (points,)

    Examples
    --------
    >>> import numpy as np
    >>> round(float(add_noise(np.zeros(100_000), 0.5, 2.0).std()), 1)
    1.0
    """
    return _core.add_noise(signal_array(signal), noise_level, healthy_rms, whole("seed", seed), whole("draw", draw))


@dataclass(frozen=True)
class Tuning:
    """What an experiment gave.

    Attributes
    ----------
    parameters : dict of str to float
        ``width_ratio``, ``fault_to_harmonics_ratio``, ``noise_level``.
    error : dict of str to float
        ``original``, ``enhanced``, ``leave_one_out`` and what ``tuning.json`` has beside them.
    report : dict
        All of ``tuning.json``.
    tuned_toml : str
        The text of ``tuned.toml``, which :func:`enhance`, the program and data sets take.
    """

    parameters: dict[str, Any]
    error: dict[str, Any]
    report: dict[str, Any] = field(repr=False)
    tuned_toml: str = field(repr=False)

    def save(self, path: str | PathLike[str]) -> None:
        """Write ``tuned.toml``.

        Parameters
        ----------
        path : str or path
            The file; it appears whole or not at all.

        Raises
        ------
        OSError
            A directory, or what else kept it from being written.
        """
        with written_whole(path) as stream:
            stream.write(self.tuned_toml.encode())


def tune(experiment: str | PathLike[str], *, progress: bool | Callable[[int, int], None] = False) -> Tuning:
    """Tune simulations to what was measured on a rig. Each doubt is a :class:`~meshtone.MeshtoneWarning`.

    Parameters
    ----------
    experiment : str or path
        The experiment file, as of ``meshtone tune``.
    progress : bool or callable, optional
        True for a line on the terminal or a bar in a notebook; or called with the numbers of simulations that are finished and of all.

    Returns
    -------
    Tuning

    Raises
    ------
    FileNotFoundError
        There is no such file.
    ValueError
        What is wrong with the experiment: with key and line.
    KeyboardInterrupt
        Ctrl-C stops it.
    """
    report = _progress.shown("simulations") if progress is True else (progress or None)
    text, tuned_toml = _core.tune(experiment, report)
    report = json.loads(text)
    warn(report["warnings"])
    return Tuning(report["parameters"], report["error"], report, tuned_toml)


@dataclass(frozen=True)
class EnhancedSignals:
    """Enhanced difference signals of a scenario.

    Attributes
    ----------
    relative_difference : array, shape (draws, points)
        One revolution of the tuned wheel a row, over the rms of the enhanced healthy signal.
    healthy_rms_g : float
        (g) That rms, of the simulation.
    label : str
        The faults' kinds, or 'healthy'.
    """

    relative_difference: Array = field(repr=False)
    healthy_rms_g: float
    label: str


def enhance(scenario: Scenario, tuned: str | PathLike[str], *, draws: int = 10, seed: int = 1) -> EnhancedSignals:
    """Difference signals that stand in for measured ones.

    Parameters
    ----------
    scenario : Scenario
        What is simulated.
    tuned : str or path
        ``tuned.toml``.
    draws : int
        Draws of the noise.
    seed : int
        Of the noise.

    Returns
    -------
    EnhancedSignals

    Raises
    ------
    FileNotFoundError
        There is no such file.
    ValueError
        A file that is not a ``tuned.toml``; a scenario that cannot be simulated.
    """
    signals, healthy_rms_g = _core.enhance(native_scenario(scenario), tuned, whole("draws", draws, 1), whole("seed", seed))
    label = in_words(scenario.faults)
    return EnhancedSignals(signals, healthy_rms_g, label)
