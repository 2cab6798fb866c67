"""Thirteen ordinary scripts about simulations and data sets, each of a few lines.

    pip install 'meshtone[plot,datasets,tables,sklearn,xarray,polars]'
    python examples/datasets/thirteen_scripts.py FOLDER        # what they write goes there

Those of packages that are not installed are left out.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import meshtone as mt
from meshtone import benchmark, datasets

PLAN = {
    "records": 200,
    "units": 10,
    "scenario": {
        "gears": {"module_mm": 3.0, "pinion_teeth": 17, "gear_teeth": 38, "face_width_mm": 15.0},
        "operation": {"pinion_speed_hz": 40.0, "brake_torque_nm": 60.0},
        "quality": {"iso_class": 5},
    },
    "class": [{"label": "healthy"}, {"label": "missing-tooth", "fault": {"kind": "missing-tooth"}}],
    "vary": [{"key": "operation.pinion_speed_hz", "uniform": [30.0, 50.0]}],
    "keep": {"points_per_revolution": 512, "revolutions": 4},
    "split": {"train": 0.5, "validation": 0.0, "test": 0.5},
}


def signals_by_name(folder: Path) -> None:
    simulation = mt.simulate(mt.examples.tooth_breakage())
    [signals] = mt.simulate_many([mt.examples.healthy()])
    print(simulation["vertical_g"].std(), signals["vertical_g"].std(), list(simulation.channels))


def simulation_as_a_table(folder: Path) -> None:
    table = mt.simulate(mt.examples.healthy()).to_pandas()
    print(table["vertical_g"].rolling(1000).std().max())


def simulation_in_xarray(folder: Path) -> None:
    print(mt.simulate(mt.examples.healthy()).to_xarray()["vertical_g"].sel(time_s=slice(0.1, 0.2)).std().item())


def plan_as_a_dictionary(folder: Path) -> None:
    print(datasets.generate_dataset(PLAN, folder / "twenty", records=20))


def rows_and_columns(folder: Path) -> None:
    gears = gears_in(folder)
    print(len(gears[:10]), gears[3]["label"], gears["label"][:3], len(gears.sample(5)), len(gears.take([0, 2])))


def filter_by_a_function(folder: Path) -> None:
    print(len(gears_in(folder).filter(lambda record: record["label"] == "healthy" and record["pinion_speed_hz"] > 40)))


def group_with_pandas(folder: Path) -> None:
    print(gears_in(folder).to_pandas().groupby("label")["difference_kurtosis"].median())


def columns_with_polars(folder: Path) -> None:
    print(gears_in(folder).to_polars(["label", "fm4"]).group_by("label").mean())


def records_in_xarray(folder: Path) -> None:
    print(gears_in(folder).to_xarray(["average_g"])["average_g"].std("sample").mean().item())


def learn_from_indicators(folder: Path) -> None:
    from sklearn.linear_model import LogisticRegression
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    train, test = gears_in(folder).split("train"), gears_in(folder).split("test")
    model = make_pipeline(StandardScaler(), LogisticRegression())
    model.fit(train.matrix(train.indicator_columns), train["label"])
    print(model.score(test.matrix(test.indicator_columns), test["label"]))


def learn_from_signals(folder: Path) -> None:
    from meshtone.sklearn import IndicatorTransformer
    from sklearn.linear_model import LogisticRegression
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    tone = np.cos(2 * np.pi * 20 * 19 * np.arange(8192) / 10e3)
    records = tone + 0.1 * np.random.default_rng(0).standard_normal((20, 8192))
    records[::2, ::500] += 1.0
    chain = IndicatorTransformer(sampling_rate_hz=10e3, shaft_hz=20, teeth=19).set_output(transform="pandas")
    print(make_pipeline(chain, StandardScaler(), LogisticRegression()).fit(records, np.arange(20) % 2).score(records, np.arange(20) % 2))


def shuffled_batches_of_torch(folder: Path) -> None:
    from torch.utils.data import DataLoader

    batch, label = next(iter(DataLoader(gears_in(folder).to_torch(["average_g"], points=512), batch_size=16, shuffle=True)))
    print(batch.shape, label[:4])


def submit_to_the_benchmark(folder: Path) -> None:
    posed = benchmark.open_task("anomaly", folder, records=400)  # without records the whole set: folder/pairs-1
    train, test = posed.records("train"), posed.records()
    score = np.abs(test["difference_kurtosis"] - np.median(train["difference_kurtosis"]))
    scores = benchmark.evaluate(posed, {"record": test["record"], "score": score})  # or a Parquet or CSV file
    print(benchmark.compare("anomaly", {"kurtosis of the difference": scores, **benchmark.BASELINES["anomaly"]}))


def gears_in(folder: Path) -> datasets.Dataset:
    """The data set of most scripts, made by the first one."""
    return datasets.generate_dataset(PLAN, folder / "gears")


SCRIPTS = [
    signals_by_name, simulation_as_a_table, simulation_in_xarray, plan_as_a_dictionary, rows_and_columns, filter_by_a_function,
    group_with_pandas, columns_with_polars, records_in_xarray, learn_from_indicators, learn_from_signals, shuffled_batches_of_torch,
    submit_to_the_benchmark,
]  # fmt: skip

if __name__ == "__main__":
    for script in SCRIPTS:
        print(f"-- {script.__name__}")
        try:
            script(Path(sys.argv[1]))
        except ModuleNotFoundError as error:
            print(f"left out: {error}")
