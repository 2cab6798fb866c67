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
OF_QUANTILES = [f"quantile_{round(100 * quantile)}" for quantile in QUANTILES]
"""Columns of quantiles."""

BIASED = "calibration"
"""Has no interval: fewer units scatter more about the diagonal, so that most draws of units with replacement lie above the value itself."""


def measures_of_kinds(
    given: Mapping[str, Numbers], kinds: npt.NDArray[np.str_], also: npt.NDArray[np.str_], severities: Numbers, classes: npt.NDArray[np.str_]
) -> dict[str, Measure]:
    """Measures of probabilities of classes.

    Parameters
    ----------
    given : mapping of str to array, shape (records,)
        The probability of each class, and quantiles of the severity or none.
    kinds, also, severities : array, shape (records,)
        The truth: the class, that of a second fault ('' of none), the severity.
    classes : array of str
        What could be learnt.
    """
    damaged, probability = kinds != "healthy", 1.0 - given["healthy"]
    named = classes[np.argmax(np.column_stack([given[name] for name in classes]), axis=1)]
    right = (named == kinds) | (named == also)
    return {
        "recall": lambda i: mean_recall(kinds[i], right[i]),
        "auc": lambda i: auc(damaged[i], probability[i]),
        "calibration": lambda i: calibration_error(damaged[i], probability[i]),
        **_crps(given, severities),
    }


def measures_of_scores(given: Mapping[str, Numbers], kinds: npt.NDArray[np.str_]) -> dict[str, Measure]:
    """Measures of the column `score`, which is more for what looks damaged, of records of these kinds."""
    return {"auc": lambda i: auc(kinds[i] != "healthy", given["score"][i])}


def measures_of_lives(given: Mapping[str, Numbers], left: Numbers, constant: float) -> dict[str, Measure]:
    """Measures of what is left of lives.

    Parameters
    ----------
    given : mapping of str to array, shape (records,)
        The column `left`, and its quantiles or none.
    left : array, shape (records,)
        The truth.
    constant : float
        The best constant answer.
    """
    off, of_constant = np.abs(given["left"] - left), np.abs(constant - left)
    return {
        "of_constant": lambda i: float(off[i].mean() / of_constant[i].mean()),
        "mae": lambda i: float(off[i].mean()),
        **_crps(given, left),
    }


def _crps(given: Mapping[str, Numbers], truth: Numbers) -> dict[str, Measure]:
    """Continuous ranked probability score, where quantiles are given: twice their mean pinball loss."""
    if OF_QUANTILES[0] not in given:
        return {}
    off = [truth - given[name] for name in OF_QUANTILES]
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


def mean_recall(kinds: npt.NDArray[np.str_], right: npt.NDArray[np.bool_]) -> float:
    """Mean over the classes of the part that is named rightly."""
    return float(np.mean([np.mean(right[kinds == kind]) for kind in np.unique(kinds)]))


def calibration_error(damaged: npt.NDArray[np.bool_], probability: Numbers) -> float:
    """Mean distance of probability and frequency of damage, over ten equal parts of the records by rising probability."""
    parts = np.array_split(np.argsort(probability, kind="stable"), 10)
    return float(np.mean([abs(probability[part].mean() - damaged[part].mean()) for part in parts if len(part)]))
