"""The signal chain and the readers against NumPy, SciPy, polars, pandas and pyarrow, in one process.

Run by hand: ``python python/benchmarks/compare.py [repeats]``. The ways of a task take turns, five times each; the medians of wall and
of processor time are printed (polars and pyarrow use several threads), and how far the results are apart.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, Literal, TypeVar

import numpy as np
import numpy.typing as npt
import pandas as pd
import polars as pl
import pyarrow as pa
import pyarrow.parquet as pq
from scipy import interpolate, io, ndimage, signal, stats

import meshtone as mt

Array = npt.NDArray[np.float64]
Result = dict[str, Any]
T = TypeVar("T")

RATE_HZ = 50_000.0
SAMPLES = 3_000_000
SHAFT_HZ = 40.0
TEETH = 19
POINTS_PER_REVOLUTION = 2048
SIDEBANDS = 2
SHAFT_ORDERS = np.arange(1, 8)


def recording() -> tuple[Array, Array]:
    """A mesh tone with harmonics, sidebands, a fault once a revolution and noise; and the times of its pulses."""
    time_s = np.arange(SAMPLES) / RATE_HZ
    revolutions = SHAFT_HZ * time_s + 0.3 * np.sin(2 * np.pi * 0.1 * time_s)
    angle = 2 * np.pi * revolutions
    mesh = sum(np.cos(harmonic * TEETH * angle) / harmonic for harmonic in range(1, 6))
    fault = np.exp(-(((revolutions + 0.5) % 1 - 0.5) ** 2) / 2e-5) * np.cos(150 * angle)
    noise = np.random.default_rng(1).normal(0, 0.3, SAMPLES)
    vibration = (1 + 0.1 * np.cos(angle)) * mesh + 0.5 * fault + noise
    return vibration, np.interp(np.arange(1, int(revolutions[-1])), revolutions, time_s)


def meshtone_chain(interpolation: Literal["band-limited", "pchip"]) -> Callable[[Array, Array], Result]:
    """The chain in single steps, as they can be called from Python."""

    def chain(vibration: Array, pulses_s: Array) -> Result:
        phase = mt.signal.ShaftPhase.from_pulses(pulses_s, 1, RATE_HZ, vibration.size)
        angular = mt.signal.angular_resample(vibration, phase, interpolation=interpolation)
        average = mt.signal.synchronous_average(angular)
        parts = mt.signal.separate(average, TEETH)
        shapes = [average, parts.regular, parts.residual, parts.difference, mt.signal.envelope(parts.difference)]
        return {
            "average": average,
            "kurtosis": [mt.signal.statistics(shape)["kurtosis"] for shape in shapes][3],
            "fm0": mt.signal.fm0(average, TEETH),
            "fm4": mt.signal.fm4(parts.difference),
            "m6a": mt.signal.m6a(parts.difference),
            "energy ratio": mt.signal.energy_ratio(parts.difference, parts.regular),
        }

    return chain


def meshtone_channel(vibration: Array, pulses_s: Array) -> Result:
    """The chain in one call."""
    phase = mt.signal.ShaftPhase.from_pulses(pulses_s, 1, RATE_HZ, vibration.size)
    record = mt.process_channel(vibration, phase, TEETH)
    values = record.indicators
    return {
        "average": record.average,
        "kurtosis": values["difference_kurtosis"],
        "fm0": values["fm0"],
        "fm4": values["fm4"],
        "m6a": values["m6a"],
        "energy ratio": values["energy_ratio"],
    }


def straight_lines(vibration: Array, places: Array) -> Array:
    return np.interp(places, np.arange(vibration.size), vibration)


def spline_filter(vibration: Array, places: Array) -> Array:
    return np.asarray(ndimage.map_coordinates(vibration, places[np.newaxis], order=3, mode="mirror"))


def cubic_spline(vibration: Array, places: Array) -> Array:
    return np.asarray(interpolate.CubicSpline(np.arange(vibration.size), vibration)(places))


def pchip(vibration: Array, places: Array) -> Array:
    return np.asarray(interpolate.PchipInterpolator(np.arange(vibration.size), vibration)(places))


def moment(values: Array, order: int) -> float:
    centred = values - values.mean()
    return float(np.mean(centred**order) / np.mean(centred**2) ** (order / 2))


def numpy_chain(read: Callable[[Array, Array], Array]) -> Callable[[Array, Array], Result]:
    """The same steps; from angle to time in one interpolation, since the pulses' times are all that is known."""

    def chain(vibration: Array, pulses_s: Array) -> Result:
        revolutions = pulses_s.size - 1
        angles = np.arange(revolutions * POINTS_PER_REVOLUTION) / POINTS_PER_REVOLUTION
        places = interpolate.PchipInterpolator(np.arange(pulses_s.size), pulses_s * RATE_HZ)(angles)
        average = read(vibration, places).reshape(revolutions, POINTS_PER_REVOLUTION).mean(axis=0)
        spectrum = np.fft.rfft(average)
        mesh_orders = np.arange(TEETH, spectrum.size, TEETH)
        sidebands = (mesh_orders[:, np.newaxis] + np.arange(-SIDEBANDS, SIDEBANDS + 1)).ravel()
        of_regular, of_mesh = np.zeros(spectrum.size, dtype=bool), np.zeros(spectrum.size, dtype=bool)
        of_regular[SHAFT_ORDERS] = of_mesh[SHAFT_ORDERS] = of_mesh[mesh_orders] = True
        of_regular[sidebands[sidebands < spectrum.size]] = True
        regular = np.fft.irfft(np.where(of_regular, spectrum, 0))
        residual = np.fft.irfft(np.where(of_mesh, 0, spectrum))
        difference = np.fft.irfft(np.where(of_regular, 0, spectrum))
        envelope = np.abs(signal.hilbert(difference))
        shapes = [
            (np.sqrt(np.mean(part**2)), np.ptp(part), np.abs(part).max(), stats.skew(part), moment(part, 4))
            for part in (average, regular, residual, difference, envelope)
        ]
        amplitudes = 2 * np.abs(spectrum[mesh_orders]) / average.size
        return {
            "average": average,
            "kurtosis": shapes[3][4],
            "fm0": float(np.ptp(average) / amplitudes.sum()),
            "fm4": moment(difference, 4),
            "m6a": moment(difference, 6),
            "energy ratio": float(difference.std() / regular.std()),
        }

    return chain


def medians(ways: Mapping[str, Callable[[], T]], repeats: int) -> tuple[dict[str, tuple[float, float]], dict[str, T]]:
    """(s) Median wall and processor time of each way, all in turn; and what each gave."""
    results = {name: way() for name, way in ways.items()}
    times: dict[str, list[tuple[float, float]]] = {name: [] for name in ways}
    for _ in range(repeats):
        for name, way in ways.items():
            wall, cpu = time.perf_counter(), time.process_time()
            way()
            times[name].append((time.perf_counter() - wall, time.process_time() - cpu))
    middle = {name: np.median(of, axis=0) for name, of in times.items()}
    return {name: (float(wall), float(cpu)) for name, (wall, cpu) in middle.items()}, results


def report(title: str, times: dict[str, tuple[float, float]], remarks: dict[str, str]) -> None:
    """Times, and how many times Meshtone's each is: of the first way."""
    print(f"\n{title:<34} {'wall':>9} {'ratio':>6} {'processor':>11} {'ratio':>6}")
    wall, cpu = next(iter(times.values()))
    for name, (way_wall, way_cpu) in times.items():
        figures = f"{way_wall * 1e3:>6.1f} ms {way_wall / wall:>6.2f} {way_cpu * 1e3:>8.1f} ms {way_cpu / cpu:>6.2f}"
        print(f"{name:<34} {figures}  {remarks.get(name, '')}")


def rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))


def compare_chains(vibration: Array, pulses_s: Array, repeats: int) -> None:
    chains = {
        "Meshtone, one call": meshtone_channel,
        "Meshtone, step by step": meshtone_chain("band-limited"),
        "Meshtone, step by step, PCHIP": meshtone_chain("pchip"),
        "NumPy interp, straight lines": numpy_chain(straight_lines),
        "SciPy map_coordinates, cubic": numpy_chain(spline_filter),
        "SciPy PchipInterpolator": numpy_chain(pchip),
        "SciPy CubicSpline": numpy_chain(cubic_spline),
    }
    ways = {name: partial(chain, vibration, pulses_s) for name, chain in chains.items()}
    times, results = medians(ways, repeats)
    first = results["Meshtone, one call"]
    remarks = {}
    for name, result in results.items():
        apart = rms(result["average"] - first["average"]) / rms(first["average"])
        indicators = max(abs(value / first[key] - 1) for key, value in result.items() if key != "average")
        remarks[name] = f"average {100 * apart:.3f} %, indicators {100 * indicators:.2f} % apart"
        # Straight lines and PCHIP lose some of the highest mesh harmonic; the rest is the same signal.
        assert apart < 0.01, f"{name}: the averages are {100 * apart:.2f} % apart"
    report("signal chain, 60 s at 50 kS/s", times, remarks)


def compare_readers(vibration: Array, folder: Path, repeats: int) -> None:
    time_s = np.arange(SAMPLES) / RATE_HZ
    table = pa.table({"time_s": time_s, "vibration_g": vibration})
    csv, parquet = folder / "run.csv", folder / "run.parquet"
    mat, packed = folder / "run.mat", folder / "packed.mat"
    pl.DataFrame({"time_s": time_s.round(5), "vibration_g": vibration}).write_csv(csv)
    pq.write_table(table, parquet, compression="snappy")
    variables = {"vibration_g": vibration, "fs": RATE_HZ}
    io.savemat(mat, variables)
    io.savemat(packed, variables, do_compression=True)

    def meshtone(path: Path) -> Callable[[], Array]:
        return lambda: next(iter(mt.read_recording(path).channels.values()))

    tasks: dict[Path, dict[str, Callable[[], Array]]] = {
        csv: {
            "Meshtone": meshtone(csv),
            "polars": lambda: pl.read_csv(csv)["vibration_g"].to_numpy(),
            "pandas": lambda: pd.read_csv(csv)["vibration_g"].to_numpy(),
            "pandas, engine pyarrow": lambda: pd.read_csv(csv, engine="pyarrow")["vibration_g"].to_numpy(),
            "NumPy loadtxt": lambda: np.loadtxt(csv, delimiter=",", skiprows=1)[:, 1],
        },
        mat: {"Meshtone": meshtone(mat), "SciPy loadmat": lambda: io.loadmat(mat)["vibration_g"].ravel()},
        packed: {"Meshtone": meshtone(packed), "SciPy loadmat": lambda: io.loadmat(packed)["vibration_g"].ravel()},
        parquet: {
            "Meshtone": meshtone(parquet),
            "pyarrow": lambda: pq.read_table(parquet)["vibration_g"].to_numpy(),
            "polars": lambda: pl.read_parquet(parquet)["vibration_g"].to_numpy(),
        },
    }
    for path, ways in tasks.items():
        times, results = medians(ways, repeats)
        for name, values in results.items():
            np.testing.assert_allclose(values, vibration, rtol=1e-14, err_msg=name)
        report(f"reading {path.name}, {path.stat().st_size / 1e6:.0f} MB", times, {})


def main() -> None:
    repeats = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    versions = {module.__name__: module.__version__ for module in (np, pl, pd, pa)}
    print(", ".join(f"{name} {version}" for name, version in versions.items()))
    vibration, pulses_s = recording()
    compare_chains(vibration, pulses_s, repeats)
    with tempfile.TemporaryDirectory() as folder:
        compare_readers(vibration, Path(folder), repeats)


if __name__ == "__main__":
    main()
