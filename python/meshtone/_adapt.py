"""A data set for a machine of which only healthy recordings are known."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _core, _progress
from ._path import FEWEST_DRAWS, Recorded, _healthy
from .datasets import Dataset, load_dataset
from .scenario import Scenario, native_scenario
from ._warnings import warn
from .signal._arguments import whole

__all__ = ["Adaptation", "Expected", "adapt"]

Array = npt.NDArray[np.float64]
ADAPTATION = "adaptation.json"
FEWEST_UNITS = 16


class Expected(NamedTuple):
    """What a diagnosis by the set's classifier is worth on simulated machines that differ from the scenario: mean, least, largest of them."""

    machines: int
    """Number of them."""
    area_under_curve: tuple[float, float, float]
    """(-) How often a damaged record has a larger probability of damage than a healthy one."""
    detection_balanced_accuracy: tuple[float, float, float]
    """(-) Of damaged or healthy, by the threshold that a machine's healthy records give."""
    recall: tuple[float, float, float]
    """(-) Mean over the classes of how often the class is named."""


class Adaptation:
    """A data set for a machine, and the classifier that was learnt from it. :func:`adapt` makes one.

    Attributes
    ----------
    path : Path
        Directory of the data set.
    classes : list of str
        The classes, the healthy one first.
    threshold : float
        (-) Probability of damage above which a window is called damaged: at most one in twenty windows of the healthy recordings, and of
        healthy simulations, is above it.
    healthy : array, shape (windows,)
        (-) Probability of damage of each window of the healthy recordings at the set's speeds, beside the others.
    expected : Expected
        What may be expected of a diagnosis.
    warnings : list of str
        What is doubtful about the healthy recordings; :func:`adapt` has warned of it.
    """

    def __init__(self, native: _core.Adaptation, path: Path) -> None:
        self._native, self.path = native, path
        found = json.loads(native.json())
        self.classes: list[str] = found["classes"]
        self.threshold: float = found["threshold"]
        self.healthy: Array = np.array(found["healthy_windows"])
        expected = found["expected"]
        area, detection, recall = (
            (expected[key]["mean"], expected[key]["least"], expected[key]["largest"]) for key in Expected._fields[1:]
        )
        self.expected = Expected(expected["machines"], area, detection, recall)
        self.warnings: list[str] = found["warnings"]

    @property
    def dataset(self) -> Dataset:
        """The simulated records."""
        return load_dataset(self.path)

    def probabilities(self, recording: Recorded) -> Array:
        """The probability of each class for windows of a recording, beside the machine's healthy recordings.

        Parameters
        ----------
        recording : as of :func:`adapt`
            By the same sensor, about as fast as the scenario and at least as long as a record.

        Returns
        -------
        array, shape (windows, classes)
            (-) In the order of :attr:`classes`; a window is called damaged where 1 less the first exceeds :attr:`threshold`.

        Raises
        ------
        ValueError
            A recording that is too short, or of a lower sampling rate than the set; a speed beside those of the set.

        Warns
        -----
        MeshtoneWarning
            Most windows differ from the healthy recordings more than in any simulation: a wrong unit or rate, another mounting, noise. Not
            where no healthy recording has a window.
        """
        probabilities, doubt = self._native.probabilities(_healthy(recording))
        warn([doubt] if doubt else [])
        return np.array(probabilities)

    def __repr__(self) -> str:
        area = self.expected.area_under_curve[0]
        return f"<Adaptation {self.path}: {', '.join(self.classes)}; expected area under the curve {area:.2f}>"


def adapt(
    recordings: Recorded | list[Recorded],
    scenario: Scenario,
    path: str | PathLike[str],
    *,
    classes: Sequence[str] | None = None,
    units: int = 128,
    draws: int = 24,
    seed: int = 1,
    progress: bool | Callable[[int, int], None] = False,
) -> Adaptation:
    """Make a labelled data set for a machine from its healthy recordings, and learn a classifier from it.

    What the recordings tell of the path to the sensor, of the drive and of sidebands is put into the scenario, as by :func:`estimate_path`.
    Simulations of it are the data set; an interrupted call goes on where it was. The same as ``meshtone adapt``.

    Parameters
    ----------
    recordings : one, or a list of several, by one sensor
        As of :func:`estimate_path`. Those at the scenario's speed, of several times a record's length, calibrate the threshold.
    scenario : Scenario
        The healthy machine, with the recordings' load.
    path : str or path
        Directory of the data set.
    classes : sequence of str, optional
        Kinds of damage, or ``'outer'``, ``'inner'``, ``'element'`` of a bearing, behind ``@`` the wheel or the bearing's seat,
        ``'pits@z3'``, ``'outer@input:0'``; without it the gear of a pair. By default every kind on every wheel.
    units : int
        (16 or more) Pairs of wheels, or gearboxes, each with one record of every class and three healthy ones.
    draws : int
        (8 or more) Draws of the wheels from which the path is estimated.
    seed : int
        Seed of all draws.
    progress : bool or callable, optional
        As of :func:`estimate_path`, of records.

    Returns
    -------
    Adaptation

    Raises
    ------
    TypeError
        Classes that are a text.
    ValueError
        A recording that does not fit the scenario; no class, or one that the machine cannot have; a directory with something else in it.
    OSError
        A file that cannot be written.
    KeyboardInterrupt
        Ctrl-C stops it.

    Examples
    --------
    ::

        adapted = mt.adapt(healthy, rig, "set", classes=["pits", "tooth-breakage"])
        adapted.probabilities((signal_g, 25_600.0, phase))
    """
    if isinstance(classes, str):
        raise TypeError(f"classes = {classes!r}: must be a list of classes, [{classes!r}]")
    several: list[Any] = recordings if isinstance(recordings, list) else [recordings]
    report = _progress.shown("records") if progress is True else (progress or None)
    numbers = (whole("units", units, FEWEST_UNITS), whole("draws", draws, FEWEST_DRAWS), whole("seed", seed))
    healthy = [_healthy(one) for one in several]
    native = _core.adapt_dataset(native_scenario(scenario), healthy, Path(path), None if classes is None else list(classes), numbers, report)
    adapted = Adaptation(native, Path(path))
    warn(adapted.warnings)
    return adapted
