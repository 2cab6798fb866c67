"""What is measured of answers, in NumPy alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

Numbers = npt.NDArray[np.float64]
Measure = Callable[[npt.NDArray[np.intp]], float]
"""From places of records, which may be drawn several times, to a score."""

DRAWS = 400
QUANTILES = np.arange(0.1, 0.95, 0.1)


def measures_of_kinds(
    given: Mapping[str, Numbers], kinds: npt.NDArray[np.str_], severities: Numbers, classes: npt.NDArray[np.str_]
) -> dict[str, Measure]:
    """Measures of probabilities of classes, or of a score of damage.

    Parameters
    ----------
    given : mapping of str to array, shape (records,)
        The answers.
    kinds, severities : array, shape (records,)
        The truth.
    classes : array of str
        What could be learnt.

    Raises
    ------
    ValueError
        Neither a score nor the probabilities of all classes.
    """
    damaged = kinds != "healthy"
    if "score" in given:
        return {"auc": lambda i: auc(damaged[i], given["score"][i])}
    if missing := [str(name) for name in classes if name not in given]:
        raise ValueError(f"there is no column '{missing[0]}': the probability of each of {', '.join(classes)} is needed")
    probabilities = np.column_stack([given[name] for name in classes])
    probability = 1.0 - given["healthy"]
    named = classes[np.argmax(probabilities, axis=1)]
    return {
        "recall": lambda i: mean_recall(kinds[i], named[i]),
        "auc": lambda i: auc(damaged[i], probability[i]),
        "calibration": lambda i: calibration_error(damaged[i], probability[i]),
        **_crps(given, severities),
    }


def measures_of_lives(given: Mapping[str, Numbers], left: Numbers, constant: float) -> dict[str, Measure]:
    """Measures of what is left of lives.

    Parameters
    ----------
    given : mapping of str to array, shape (records,)
        The answers.
    left : array, shape (records,)
        The truth.
    constant : float
        The best constant answer.

    Raises
    ------
    ValueError
        No answer.
    """
    if "left" not in given:
        raise ValueError("there is no column 'left': the part of its life that a gear has left is needed")
    off, of_constant = np.abs(given["left"] - left), np.abs(constant - left)
    return {
        "of_constant": lambda i: float(off[i].mean() / of_constant[i].mean()),
        "mae": lambda i: float(off[i].mean()),
        **_crps(given, left),
    }


def _crps(given: Mapping[str, Numbers], truth: Numbers) -> dict[str, Measure]:
    """Continuous ranked probability score, where quantiles are given: twice their mean pinball loss."""
    names = [f"quantile_{round(100 * quantile)}" for quantile in QUANTILES]
    if not all(name in given for name in names):
        return {}
    off = [truth - given[name] for name in names]
    losses = 2.0 * np.mean([np.maximum(q * e, (q - 1.0) * e) for q, e in zip(QUANTILES, off, strict=True)], axis=0)
    return {"crps": lambda i: float(losses[i].mean())}


def interval(measure: Measure, chosen: npt.NDArray[np.intp], units: npt.NDArray[Any]) -> list[float]:
    """The measure of chosen records, and the ends of 90 % of it where their units are drawn with replacement."""
    _, numbers = np.unique(units[chosen], return_inverse=True)
    of_unit = [chosen[numbers == number] for number in range(numbers.max() + 1)]
    drawn = []
    for draw in range(DRAWS):
        units_drawn = np.random.default_rng([2024, draw]).integers(len(of_unit), size=len(of_unit))
        drawn.append(measure(np.concatenate([of_unit[number] for number in units_drawn])))
    low, high = np.nanquantile(drawn, [0.05, 0.95])
    return [round(float(value), 3) for value in (measure(chosen), low, high)]


def auc(damaged: npt.ArrayLike, score: Numbers) -> float:
    """Area under the receiver operating characteristic, by Mann and Whitney's mean ranks; NaN of one class alone."""
    is_damaged = np.asarray(damaged, dtype=bool)
    _, number, count = np.unique(score, return_inverse=True, return_counts=True)
    rank = (np.cumsum(count) - (count - 1) / 2)[number]
    found = np.count_nonzero(is_damaged)
    pairs = found * (len(is_damaged) - found)
    return float((rank[is_damaged].sum() - found * (found + 1) / 2) / pairs) if pairs else float("nan")


def mean_recall(kinds: npt.NDArray[np.str_], named: npt.NDArray[np.str_]) -> float:
    """Mean over the classes of the part that is named rightly."""
    return float(np.mean([np.mean(named[kinds == kind] == kind) for kind in np.unique(kinds)]))


def calibration_error(damaged: npt.NDArray[np.bool_], probability: Numbers) -> float:
    """Mean distance of probability and frequency of damage, over ten equal parts of the records by rising probability."""
    parts = np.array_split(np.argsort(probability, kind="stable"), 10)
    return float(np.mean([abs(probability[part].mean() - damaged[part].mean()) for part in parts if len(part)]))
