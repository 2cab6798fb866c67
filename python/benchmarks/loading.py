"""How fast a data set is read in a learner's order, beside pyarrow alone and Hugging Face's ``datasets``, with a floor for each number.

Run by hand: ``python python/benchmarks/loading.py DIRECTORY``, the directory of a data set such as ``python/meshtone/benchmark/pairs-1.toml`` makes.
Exits with 1 if a floor is missed. Where torch is not installed, its ``DataLoader`` is stood for by what it does with a data set: batches of
shuffled places. Of ``datasets`` its copy in Arrow's format is read, which it makes first, as NumPy arrays and in batches of 32.
"""

from __future__ import annotations

import importlib.util
import sys
import tempfile
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


def others(gears: Dataset, places: np.ndarray) -> dict[str, Callable[[], list[tuple[str, float, float]]]]:
    """What is measured where a package is installed."""

    def hugging_face() -> list[tuple[str, float, float]]:
        with tempfile.TemporaryDirectory() as cache:
            return [("shuffled, Hugging Face", per_second(len(places), shuffled_by_hugging_face(gears, places, cache)), 0.0)]

    def torch() -> list[tuple[str, float, float]]:
        alone = by_workers(gears, 0)
        return [("DataLoader, no worker", alone, 0.0), ("DataLoader, two workers", by_workers(gears, 2), 0.0)]

    return {"datasets": hugging_face, "torch": torch}


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


def shuffled_by_hugging_face(gears: Dataset, places: np.ndarray, cache: str) -> Callable[[], object]:
    """The same with Hugging Face's ``datasets``, from its own copy."""
    import datasets  # type: ignore[import-untyped]

    read = datasets.load_dataset("parquet", data_files=gears.arrow.files, split="train", cache_dir=cache)
    arrays = read.select_columns([SIGNAL]).with_format("numpy")
    return lambda: [arrays[places[first : first + 32]] for first in range(0, len(places), 32)]


def by_workers(gears: Dataset, workers: int) -> float:
    """(1/s) Records a second of torch's ``DataLoader`` over all signals as they are.

    Workers pay where a transform takes its time: two on two busy cores lost below 0.1 ms of work a record, and gained a quarter at 0.4 ms.
    """
    from torch.utils.data import DataLoader

    signals = gears.to_torch(gears.signal_columns, points=POINTS)
    loader = DataLoader(signals, batch_size=64, shuffle=True, num_workers=workers, persistent_workers=workers > 0)
    return per_second(len(gears), lambda: list(loader))


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
        ("records(shuffle=0)", per_second(len(gears), lambda: list(gears.records([SIGNAL], shuffle=0))), 1000.0),
        ("shuffled, pyarrow alone", per_second(min(len(gears), 320), lambda: shuffled_by_pyarrow(gears, places)), 0.0),
        ("IndicatorTransformer", per_second(len(records), lambda: chain.transform(records)), 2000.0),
    ]
    for package, measure in others(gears, places).items():
        if importlib.util.find_spec(package):
            table += measure()
    for name, speed, floor in table:
        print(f"{name:<26} {speed:>9.0f} records/s" + (f", at least {floor:.0f}" if floor else ""))
    return int(any(speed < floor for _, speed, floor in table))


if __name__ == "__main__":
    sys.exit(main())
