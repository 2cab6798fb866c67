"""How fast a data set is read in a learner's order, beside pyarrow alone, with a floor for each number.

Run by hand: ``python python/benchmarks/loading.py DIRECTORY``, the directory of a data set such as ``python/meshtone/benchmark/pairs-1.toml`` makes.
Exits with 1 if a floor is missed. torch's ``DataLoader`` is stood for by what it does with a data set: batches of shuffled places.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import numpy as np
import pyarrow.dataset

import meshtone as mt
from meshtone.datasets import Dataset, Rows
from meshtone.sklearn import IndicatorTransformer

SIGNAL = "average_g"
POINTS = 1024


def per_second(records: int, work: Callable[[], object]) -> float:
    """(1/s) Records a second: the best of three runs."""
    durations = []
    for _ in range(3):
        start_s = time.perf_counter()
        work()
        durations.append(time.perf_counter() - start_s)
    return records / min(durations)


def epoch(rows: Rows, places: np.ndarray) -> float:
    """One epoch of batches of 32, as a network is given them."""
    total = 0.0
    for first in range(0, len(places), 32):
        batch = np.stack([rows[place][SIGNAL][:POINTS] for place in places[first : first + 32]])
        total += float(batch[0, 0])
    return total


def shuffled_by_pyarrow(gears: Dataset, places: np.ndarray) -> None:
    """The same with pyarrow alone: each batch is taken from the files."""
    native: pyarrow.dataset.Dataset = gears.arrow
    for first in range(0, min(len(places), 320), 32):
        native.take(places[first : first + 32], columns=[SIGNAL])


def main() -> int:
    """Measure, print, compare."""
    gears = mt.load_dataset(sys.argv[1])
    places = np.random.default_rng(0).permutation(len(gears))
    rows = Rows(gears, [SIGNAL])
    start_s = time.perf_counter()
    epoch(rows, places)
    first_epoch = len(gears) / (time.perf_counter() - start_s)
    tone = np.cos(2 * np.pi * 20 * 19 / 10e3 * np.arange(8192))
    records = tone + 0.1 * np.random.default_rng(0).standard_normal((64, 8192))
    chain = IndicatorTransformer(sampling_rate_hz=10e3, shaft_hz=20, teeth=19).fit(records)
    table = [
        ("first shuffled epoch", first_epoch, 1000.0),
        ("later shuffled epochs", per_second(len(gears), lambda: epoch(rows, places)), 5000.0),
        ("in order, records()", per_second(len(gears), lambda: list(gears.records([SIGNAL]))), 4000.0),
        ("shuffled, pyarrow alone", per_second(min(len(gears), 320), lambda: shuffled_by_pyarrow(gears, places)), 0.0),
        ("IndicatorTransformer", per_second(len(records), lambda: chain.transform(records)), 2000.0),
    ]
    for name, speed, floor in table:
        print(f"{name:<26} {speed:>9.0f} records/s" + (f", at least {floor:.0f}" if floor else ""))
    return int(any(speed < floor for _, speed, floor in table))


if __name__ == "__main__":
    sys.exit(main())
