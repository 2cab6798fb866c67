"""Data sets: made, loaded, filtered, handed on."""

from __future__ import annotations

import copy
import errno
import hashlib
import importlib
import importlib.util
import json
import multiprocessing
import pickle
import re
import shutil
import subprocess
import sys
import types
import zipfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import polars
import pyarrow.dataset
import pyarrow.parquet
import pytest
import scipy.io

import meshtone
from meshtone import datasets
from meshtone._bearing_datasets import Base
from meshtone._published import PUBLISHED

PLAN = """\
records = 24
units = 6
scenario = "machine.toml"
[[class]]
label = "healthy"
[[class]]
label = "tooth-breakage"
fault = { kind = "tooth-breakage", chip_height_mm = 5.0, chip_width_mm = 8.0, tip_loss_mm = 2.0 }
severity = 3
[[vary]]
key = "operation.pinion_speed_hz"
uniform = [20.0, 50.0]
[keep]
records_per_shard = 8
[split]
train = 0.5
test = 0.5
"""


def write_plan(folder: Path) -> Path:
    machine = meshtone.examples.healthy().copy(sampling_rate_hz=5e4, settle_tolerance=1e-3)
    (folder / "machine.toml").write_text(machine.to_toml(), encoding="utf-8")
    plan = folder / "plan.toml"
    plan.write_text(PLAN, encoding="utf-8")
    return plan


def digests(folder: Path) -> dict[str, str]:
    """SHA-256 of every file."""
    return {
        str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest()
        for file in sorted(folder.rglob("*"))
        if file.is_file()
    }


@pytest.fixture(scope="module")
def gears(tmp_path_factory: pytest.TempPathFactory) -> datasets.Dataset:
    folder = tmp_path_factory.mktemp("gears")
    return datasets.generate_dataset(write_plan(folder), folder / "set")


def test_columns(gears: datasets.Dataset) -> None:
    assert len(gears) == 24
    labels = gears.column("label")
    assert sorted(set(labels)) == ["healthy", "tooth-breakage"]
    speeds = gears.column("pinion_speed_hz")
    assert speeds.min() >= 20 and speeds.max() <= 50
    assert gears.units["pinion_speed_hz"] == "Hz"
    table = gears.to_pandas()
    assert len(table) == 24 and "vertical_g" not in table and "difference_kurtosis" in table
    assert gears.matrix(["difference_kurtosis", "pinion_speed_hz"]).shape == (24, 2)
    assert "vertical_g" in gears.signal_columns
    for wrong in (lambda: gears.column("speed"), lambda: gears.to_arrow(["speed"]), lambda: gears.signals("speed")):
        with pytest.raises(ValueError, match="no column 'speed'"):
            wrong()
    with pytest.raises(ValueError, match="did you mean 'pinion_speed_hz'"):
        gears.column("pinion_sped_hz")
    with pytest.raises(TypeError, match=r"\['fm4'\]"):
        gears.matrix("fm4")
    with pytest.raises(ValueError, match="'label' holds no numbers"):
        gears.matrix(["label"])
    with pytest.raises(ValueError, match=r"signals\('vertical_g'\)"):
        gears.column("vertical_g")
    with pytest.raises(ValueError, match=r"column\('label'\)"):
        gears.signals("label")


def test_splits_share_no_unit(gears: datasets.Dataset) -> None:
    train, test = gears.split("train"), gears.split("test")
    assert len(train) + len(test) == 24
    assert not set(train.column("unit")) & set(test.column("unit"))
    with pytest.raises(ValueError, match="no split 'valid'"):
        gears.split("valid")


def test_signals_are_those_of_the_records(gears: datasets.Dataset) -> None:
    signals = gears.signals("vertical_g")
    records = list(gears.records(["record", "vertical_g"], batch_size=5))
    numbers = [record["record"] for record in records]
    assert numbers == gears.column("record").tolist() and sorted(numbers) == list(range(24))
    assert all(np.array_equal(record["vertical_g"], signal) for record, signal in zip(records, signals))
    fast = gears.filter(pyarrow.dataset.field("pinion_speed_hz") > 35)
    assert len(fast) == int((gears.column("pinion_speed_hz") > 35).sum())
    assert len(fast.signals("vertical_g")) == len(fast)


def test_a_record_by_its_place(gears: datasets.Dataset) -> None:
    test = gears.split("test")
    for dataset in (gears, test):
        records = list(dataset)
        assert len(records) == len(dataset) and list(records[0]) == dataset.columns
        # In any order, over the borders of the files.
        for place in (0, 11, len(dataset) - 1, -1, -len(dataset), np.int64(3)):
            record = dataset[place]
            assert record["record"] == records[place]["record"]
            assert np.array_equal(record["vertical_g"], records[place]["vertical_g"])
        drawn = dataset.take([7, 2, 7])
        assert drawn["record"].tolist() == [records[place]["record"] for place in (7, 2, 7)]
        assert np.array_equal(drawn[0]["vertical_g"], records[7]["vertical_g"]) and len(dataset[2:9:3]) == 3
        assert dataset.sample(5, seed=1)["record"].tolist() == sorted(dataset.sample(5, seed=1)["record"], key=dataset["record"].tolist().index)
    with pytest.raises(IndexError, match="places of 24 records are from 0 to 23"):
        gears.take([24])
    with pytest.raises(ValueError, match="records = 25: there are 24"):
        gears.sample(25)
    with pytest.raises(TypeError, match="or a function"):
        gears.filter("label == 'healthy'")
    for places in (gears["label"] == "healthy", [0.5]):
        with pytest.raises(TypeError, match=r"places: must be whole numbers, and not (bool|float64); np.flatnonzero\(mask\)"):
            gears.take(places)  # type: ignore[arg-type]
    assert len(gears.take([])) == 0
    # Another process maps files of its own.
    assert pickle.loads(pickle.dumps(datasets.Rows(test, ["record"])))[0] == {"record": int(test["record"][0])}
    groups = [gears.indicator_columns, gears.condition_columns, gears.target_columns]
    assert [name in group for group, name in zip(groups, ("fm4", "pinion_speed_hz", "fault_severity"))] == [True] * 3
    assert len({name for group in groups for name in group}) == sum(map(len, groups)) and "seed" not in sum(groups, [])
    # What is done to a record is done to no other.
    test[0]["label"] = "mended"
    assert test[0]["label"] in ("healthy", "tooth-breakage")
    for place in (len(gears), -len(gears) - 1):
        with pytest.raises(IndexError, match=f"record {place} of 24"):
            gears[place]
    with pytest.raises(TypeError, match="slices, take, filter and split give several"):
        gears[1.5]  # type: ignore[call-overload]


def first_signals(dataset: datasets.Dataset, places: list[int]) -> list[Any]:
    """What a worker is asked for."""
    return [dataset[place]["average_g"] for place in places]


def test_other_processes_read_records_by_their_places_too(gears: datasets.Dataset) -> None:
    """Of all kinds of selections: those in files, and those in memory, which pyarrow cannot pickle."""
    healthy = pyarrow.dataset.field("label") == "healthy"
    selections = [gears, gears.split("test"), gears.filter(lambda record: record["fm4"] > 3), gears[3:15], gears[3:15].filter(healthy), gears.take([])]
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        for dataset in selections:
            again = pickle.loads(pickle.dumps(dataset))
            assert again["record"].tolist() == copy.copy(dataset)["record"].tolist() == dataset["record"].tolist() and repr(again) == repr(dataset)
            places = list(range(min(3, len(dataset))))
            for read, signal in zip(pool.submit(first_signals, dataset, places).result(), first_signals(dataset, places), strict=True):
                assert np.array_equal(read, signal)


def test_what_other_libraries_have_is_named(gears: datasets.Dataset) -> None:
    for name, meant in [
        ("select", r"Dataset has no attribute 'select': take\(places\) or \[:10\] gives records by their places, to_pandas\(columns\)"),
        ("shuffle", r"records\(shuffle=seed\)"),
        ("train_test_split", r"split\('train'\) and split\('test'\), which share no unit"),
        ("column", None),
        ("signal_colums", "Dataset has no attribute 'signal_colums'; did you mean 'signal_columns'"),
        ("nothing_like_it", "Dataset has no attribute 'nothing_like_it'$"),
    ]:
        assert hasattr(gears, name) == (meant is None)
        if meant:
            with pytest.raises(AttributeError, match=meant):
                getattr(gears, name)
    # All that is named in place of others is there.
    named = set(re.findall(r"\b([a-z_]+)\(", " ".join(datasets.ELSEWHERE.values()))) - {"len", "list", "default_rng", "permutation"}
    assert named and all(hasattr(gears, name) for name in named)
    assert not any(hasattr(gears, name) for names in datasets.ELSEWHERE for name in names.split())


def test_tables(gears: datasets.Dataset) -> None:
    of_pandas, of_polars = gears.to_pandas(), gears.to_polars()
    assert of_polars.columns == list(of_pandas.columns)
    assert of_polars["difference_kurtosis"].to_list() == of_pandas["difference_kurtosis"].tolist()
    [signals] = gears.to_polars(["average_g"])
    assert np.array_equal(signals[5].to_numpy(), gears.signals("average_g")[5])


def test_arrays_for_learners(gears: datasets.Dataset) -> None:
    test = gears.split("test")
    X, y = test.arrays(["average_g", "difference_g"], points=1024)
    assert X.shape == (len(test), 2, 1024) and X.dtype == np.float32
    assert np.array_equal(y, test.column("label"))
    # The orders that both lengths have are the signal's own.
    spectra = [np.fft.rfft(values)[:200] / len(values) for values in (test.signals("average_g")[0], X[0, 0])]
    assert np.abs(spectra[1] - spectra[0]).max() < 2e-3 * np.abs(spectra[0]).max()
    # Raw channels are not resampled: their samples belong to a rate.
    shortest = min(signal.size for signal in test.signals("vertical_g"))
    raw, severity = test.arrays("vertical_g", points=float(shortest), label="severity")  # type: ignore[arg-type]
    assert raw.shape == (len(test), 1, shortest) and np.array_equal(raw[2, 0], test.signals("vertical_g")[2][:shortest])
    assert np.array_equal(severity, test.column("severity"))
    slow = gears.filter(pyarrow.dataset.field("record") == int(test.column("record")[0]))
    assert slow.arrays("vertical_g")[0].shape == (1, 1, slow.signals("vertical_g")[0].size)
    with pytest.raises(ValueError, match=r"record \d+ has \d+ points of 'vertical_g', the first one \d+ of .*points="):
        gears.arrays("vertical_g")
    with pytest.raises(ValueError, match=r"points = 1000000: a record has \d+ of 'vertical_g'"):
        gears.arrays("vertical_g", points=1_000_000)
    with pytest.raises(ValueError, match=r"'fm4' holds one value a record: column\('fm4'\)"):
        gears.arrays(["fm4"])
    with pytest.raises(ValueError, match="no signals are named; there are horizontal_g, vertical_g, average_g"):
        gears.arrays([])


def test_python_of_the_data_card(gears: datasets.Dataset, monkeypatch: pytest.MonkeyPatch) -> None:
    blocks = re.findall(r"^```python\n(.*?)^```$", (gears.path / "README.md").read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    monkeypatch.chdir(gears.path)
    for block, package in zip(blocks, ("meshtone", "pandas", "polars", "dask", "datasets"), strict=True):
        assert package in block
        if package == "datasets":
            # The test below says so where it is not installed.
            continue
        names: dict[str, Any] = {}
        exec(compile(block, f"{package} on the card", "exec"), names)
        assert len(names["train"]) == len(gears.split("train"))
    assert set(names["train"].columns) == {"label", "severity", "horizontal_g"}


def test_hugging_face_gives_the_declared_splits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the name of a configuration, and without a network."""
    monkeypatch.setenv("HF_HUB_OFFLINE", "1")
    hugging_face = pytest.importorskip("datasets", reason="datasets is not installed: pip install datasets")
    plan = write_plan(tmp_path)
    shift = '[[split.shift]]\nname = "fast-ones"\npart = 0.2\nwhen = "operation.pinion_speed_hz > 40"\n'
    plan.write_text(PLAN.replace("test = 0.5", f"test = 0.3\n{shift}"), encoding="utf-8")
    made = datasets.generate_dataset(plan, tmp_path / "set")
    read = hugging_face.load_dataset(str(made.path), cache_dir=str(tmp_path / "cache"))
    # Names of splits are words there.
    assert {name.replace("_", "-"): len(split) for name, split in read.items()} == {
        name: len(made.split(name)) for name in ("train", "test", "fast-ones")
    }
    units = [set(split["unit"]) for split in read.values()]
    assert sum(map(len, units)) == len(set.union(*units)) == 6
    train = hugging_face.load_dataset(str(made.path), split="train", cache_dir=str(tmp_path / "cache"))
    assert train["record"][:] == sorted(train["record"]) == made.split("train").column("record").tolist()
    # Labels are classes, numbered as in torch.
    assert train.features["label"].names == sorted(set(made["label"]))
    assert [train.features["label"].int2str(number) for number in train["label"]] == made.split("train")["label"].tolist()
    assert train[0]["vertical_g"] == made.split("train").signals("vertical_g")[0].tolist()


def test_who_made_it_and_where_it_is(tmp_path: Path) -> None:
    plan = write_plan(tmp_path)
    about = 'creator = "Us"\nurl = "https://example.org/gears"\ndoi = "10.5281/zenodo.1"\npublished = "2026-11-30"\n'
    plan.write_text(about + PLAN, encoding="utf-8")
    folder = datasets.generate_dataset(plan, tmp_path / "set").path
    metadata = json.loads((folder / "croissant.json").read_text("utf-8"))
    assert metadata["creator"] == {"@type": "sc:Organization", "name": "Us"} and metadata["url"] == "https://example.org/gears"
    assert metadata["datePublished"] == "2026-11-30" and metadata["sameAs"] == "https://doi.org/10.5281/zenodo.1"
    assert "Cite as: Us: " in (folder / "README.md").read_text("utf-8") and metadata["citeAs"].endswith(", https://doi.org/10.5281/zenodo.1")


def test_a_plan_is_a_dictionary_too_and_has_other_numbers_of_records(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = write_plan(tmp_path)
    fewer = datasets.generate_dataset(plan, tmp_path / "fewer", records=12)
    assert len(fewer) == 12 and len(datasets.generate_dataset(plan, tmp_path / "fewer", records=12)) == 12
    with pytest.raises(ValueError, match="data set of another plan|another plan"):
        datasets.generate_dataset(plan, tmp_path / "fewer", records=13)
    with pytest.raises(ValueError, match="records = 0"):
        datasets.generate_dataset(plan, tmp_path / "none", records=0)
    # What a dictionary names lies in the working directory.
    monkeypatch.chdir(tmp_path)
    given = {"records": 12, "units": 4, "scenario": "machine.toml", "class": [{"label": "healthy"}, {"label": "missing", "fault": {"kind": "missing-tooth"}}]}
    made = datasets.generate_dataset(given, tmp_path / "of dictionary")
    assert len(made) == 12 and set(made["label"]) == {"healthy", "missing"}
    with pytest.raises(ValueError, match="recrods"):
        datasets.generate_dataset({**given, "recrods": 3}, tmp_path / "misspelt")


def test_shuffled_records_are_all_records_once(gears: datasets.Dataset) -> None:
    orders = [[record["record"] for record in gears.records(["record", "average_g"], shuffle=seed)] for seed in (0, 0, 1)]
    assert orders[0] == orders[1] != orders[2] and sorted(orders[0]) == sorted(orders[2]) == sorted(gears["record"])
    healthy = gears.filter(lambda record: record["label"] == "healthy")
    assert sorted(record["record"] for record in healthy.records(shuffle=3)) == sorted(gears["record"][gears["label"] == "healthy"])
    assert sorted(record["record"] for record in gears[:5].records(shuffle=0)) == sorted(gears[:5]["record"])
    assert set(healthy["label"]) == {"healthy"} and len(healthy.split("train")) < len(healthy)


def test_records_in_xarray(gears: datasets.Dataset) -> None:
    pytest.importorskip("xarray", reason="xarray is not installed: pip install xarray")
    table = gears.to_xarray(["average_g"], points=256)
    assert table["average_g"].sizes == {"record": 24, "sample": 256} and list(table["label"].values) == list(gears["label"])


def test_card_of_splits_by_mounting(tmp_path: Path) -> None:
    plan = write_plan(tmp_path)
    text = PLAN.replace("records = 24", "records = 8").replace("units = 6", "units = 2\nmountings = 2")
    plan.write_text(text.replace("[split]", '[split]\nby = "mounting"'), encoding="utf-8")
    card = (datasets.generate_dataset(plan, tmp_path / "set").path / "README.md").read_text(encoding="utf-8")
    assert "**Splits are by mounting**: " in card and "| *mountings* | 2 | 2 | 4 |" in card


def test_croissant(gears: datasets.Dataset) -> None:
    """What machines read of a data set agrees with its files."""
    metadata = json.loads((gears.path / "croissant.json").read_text(encoding="utf-8"))
    assert metadata["conformsTo"] == "http://mlcommons.org/croissant/1.0" and metadata["version"] == "1.0.0"
    splits, records = metadata["recordSet"]
    assert {entry["splits/name"] for entry in splits["data"]} == set(gears.column("split"))
    assert [field["name"] for field in records["field"]] == gears.columns
    assert [field["name"] for field in records["field"] if field.get("repeated")] == gears.signal_columns
    kinds = {"string": "sc:Text", "int": "sc:Integer", "double": "sc:Float", "list": "sc:Float"}
    for field, column in zip(records["field"], gears.arrow.schema, strict=True):
        kind = next(kind for name, kind in kinds.items() if str(column.type).startswith(name))
        assert kind in (field["dataType"], field["dataType"][0])
        unit = column.metadata[b"unit"].decode()
        assert unit in ("", "-") or field["description"].endswith(f"; unit: {unit}")
    shards, _, *files = metadata["distribution"]
    assert len(list(gears.path.glob(shards["includes"]))) == len(gears.manifest["files"])
    found = digests(gears.path)
    assert {file["contentUrl"]: file["sha256"] for file in files} == {
        name: found[name] for name in ("README.md", "plan.toml", "preview.png", "preview.svg", "scenario.toml")
    }


def test_croissant_is_read_by_its_own_library(tmp_path: Path) -> None:
    mlcroissant = pytest.importorskip("mlcroissant", reason="mlcroissant is not installed: pip install mlcroissant")
    plan = write_plan(tmp_path)
    text = 'title = "Gears"\npublished = "2026-11-22"\n' + PLAN.replace("[keep]", '[keep]\nchannels = ["vertical_g"]\nduration_s = 0.05')
    plan.write_text(text, encoding="utf-8")
    made = datasets.generate_dataset(plan, tmp_path / "set")
    read = mlcroissant.Dataset(tmp_path / "set" / "croissant.json")
    issues = read.metadata.ctx.issues
    assert not issues.errors and not issues.warnings, issues.report()
    records = list(read.records("records"))
    assert [record["records/record"] for record in records] == made.column("record").tolist()
    assert [record["records/split"].decode() for record in records] == made.column("split").tolist()
    for record, signal in zip(records, made.signals("vertical_g"), strict=True):
        assert record["records/vertical_g"] == signal.tolist()
    assert [record["records/fault_tooth"] for record in records] == made.to_arrow(["fault_tooth"]).column(0).to_pylist()


def test_repr(gears: datasets.Dataset) -> None:
    assert all(label in gears._repr_html_() for label in ("healthy", "train"))
    assert "24 records" in repr(gears) and "healthy" in repr(gears)
    assert re.fullmatch(r"<Dataset of 12 of 24 records: \d+ healthy, \d+ tooth-breakage; splits test \(12\)>", repr(gears.split("test")))
    assert repr(gears[:3]).startswith("<Dataset of 3 records in memory: ") and repr(gears.take([])) == "<Dataset of 0 records in memory>"
    assert repr(gears.filter(lambda record: False)) == "<Dataset of 0 of 24 records>"
    assert gears.manifest["records"] == 24 and gears.manifest["complete"] is True
    assert "24" in (gears.path / "README.md").read_text(encoding="utf-8")


def test_parts_and_interruption_change_nothing(gears: datasets.Dataset, tmp_path: Path) -> None:
    plan = write_plan(tmp_path)

    class Enough(Exception):
        pass

    def stop(done: int, of: int) -> None:
        raise Enough

    with pytest.raises(Enough):
        datasets.generate_dataset(plan, tmp_path / "set", jobs=1, progress=stop)
    reported: list[tuple[int, int]] = []
    datasets.generate_dataset(plan, tmp_path / "set", progress=lambda done, of: reported.append((done, of)))
    assert reported[-1][0] == reported[-1][1]
    assert digests(tmp_path / "set") == digests(gears.path)
    for number in (1, 2):
        datasets.generate_dataset(plan, tmp_path / f"part{number}", part=(number, 2))
    whole = datasets.merge_datasets([tmp_path / "part1", tmp_path / "part2"], tmp_path / "whole")
    assert digests(whole.path) == digests(gears.path)


def test_a_lost_file_is_reported_and_made_again(gears: datasets.Dataset, tmp_path: Path) -> None:
    path = tmp_path / "set"
    shutil.copytree(gears.path, path)
    (path / "data" / "train-000001.parquet").unlink()
    with pytest.warns(UserWarning, match="not complete: it has 20 records"):
        damaged = datasets.load_dataset(path)
    assert "20 records, not complete" in repr(damaged)
    assert datasets.generate_dataset(write_plan(tmp_path), path).is_complete
    assert digests(path) == digests(gears.path)


def flip(file: Path, number: int) -> None:
    """Turn over one bit: multiples of the golden ratio leave no pattern."""
    content = bytearray(file.read_bytes())
    bit = int(number * 0.618033988749895 % 1 * 8 * len(content))
    content[bit // 8] ^= 1 << bit % 8
    file.write_bytes(content)


def test_every_flipped_bit_is_found(gears: datasets.Dataset, tmp_path: Path) -> None:
    path = tmp_path / "set"
    shutil.copytree(gears.path, path)
    assert datasets.verify_dataset(path) == {}
    assert len(datasets.load_dataset(path, verify=True)) == 24
    file = path / "data" / "train-000001.parquet"
    whole = file.read_bytes()
    for number in range(1, 31):
        flip(file, number)
        assert list(datasets.verify_dataset(path)) == ["data/train-000001.parquet"]
        with pytest.raises(ValueError, match=r"train-000001.parquet: its bytes are not those that were written"):
            datasets.load_dataset(path, verify=True)
        file.write_bytes(whole)
    flip(file, 31)
    with pytest.warns(UserWarning, match=r"1 files were made again; data/train-000001.parquet: its bytes"):
        datasets.generate_dataset(write_plan(tmp_path), path)
    assert digests(path) == digests(gears.path)


def test_a_flipped_bit_is_refused_or_changes_nothing(gears: datasets.Dataset, tmp_path: Path) -> None:
    path = tmp_path / "set"
    shutil.copytree(gears.path, path)
    file = path / "data" / "train-000001.parquet"
    whole, refused = file.read_bytes(), 0
    for number in range(1, 81):
        flip(file, number)
        try:
            read = datasets.load_dataset(path).to_arrow()
        except (OSError, ValueError):
            refused += 1
        else:
            assert read.equals(gears.to_arrow()), number
        file.write_bytes(whole)
    assert refused > 70


def test_other_programs_read_the_files(gears: datasets.Dataset) -> None:
    for file in (gears.path / "data").glob("*.parquet"):
        table = pyarrow.parquet.read_table(file, page_checksum_verification=True)
        assert polars.read_parquet(file).to_dicts() == table.to_pylist()
        assert list(pandas.read_parquet(file)["label"]) == table["label"].to_pylist()


def test_names_and_sizes_are_always_looked_at(gears: datasets.Dataset, tmp_path: Path) -> None:
    path = tmp_path / "set"
    shutil.copytree(gears.path, path)
    first, extra = (path / "data" / f"train-{number:06}.parquet" for number in (0, 4))
    shutil.copy(first, extra)
    with pytest.raises(ValueError, match="train-000004.parquet: the manifest does not name it"):
        datasets.load_dataset(path)
    extra.unlink()
    first.write_bytes(first.read_bytes()[:-1])
    with pytest.raises(ValueError, match=r"train-000000.parquet: it has \d+ bytes instead of \d+"):
        datasets.load_dataset(path)
    shutil.copy(gears.path / "data" / first.name, first)
    # Without its card it can be read, but is not all that was written.
    (path / "README.md").unlink()
    assert len(datasets.load_dataset(path)) == 24
    assert datasets.verify_dataset(path) == {"README.md": "it is missing"}
    manifest = path / "manifest.json"
    manifest.write_text(manifest.read_text(encoding="utf-8").replace('"format_version": 5', '"format_version": 9'), encoding="utf-8")
    with pytest.raises(ValueError, match="has the format 9; this version of Meshtone knows format 5"):
        datasets.load_dataset(path)


def test_no_record_at_all(tmp_path: Path) -> None:
    plan = write_plan(tmp_path)
    plan.write_text(PLAN.replace("[keep]", "[keep]\nsampling_rate_hz = 100.0"), encoding="utf-8")
    with pytest.raises(ValueError, match="none of the plan's 24 records could be simulated; record 0: "):
        datasets.generate_dataset(plan, tmp_path / "set")


def test_another_program_in_the_same_directory(tmp_path: Path) -> None:
    fcntl = pytest.importorskip("fcntl")
    (tmp_path / "set").mkdir()
    plan = write_plan(tmp_path)
    # What a program holds as long as it makes a data set.
    with (tmp_path / "set" / ".meshtone-part-1-1").open("w") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        with pytest.raises(BlockingIOError, match="another program is making a data set in"):
            datasets.generate_dataset(plan, tmp_path / "set")
    # Killed, it holds nothing any more.
    assert datasets.generate_dataset(plan, tmp_path / "set").is_complete
    assert not list((tmp_path / "set").glob(".meshtone-*"))


def test_a_part_without_shards(tmp_path: Path) -> None:
    nothing = datasets.generate_dataset(write_plan(tmp_path), tmp_path / "set", part=(9, 9))
    assert len(nothing) == 0 and not nothing.is_complete


def test_mat(gears: datasets.Dataset, tmp_path: Path) -> None:
    file = tmp_path / "gears.mat"
    gears.split("train").to_mat(file, ["label", "pinion_speed_hz", "difference_g"])
    records = scipy.io.loadmat(file, squeeze_me=True)["records"]
    assert len(records) == len(gears.split("train"))
    assert np.allclose(records[0]["difference_g"], gears.split("train").signals("difference_g")[0])
    assert [path.name for path in tmp_path.iterdir()] == ["gears.mat"]


def test_refused(gears: datasets.Dataset, tmp_path: Path) -> None:
    plan = write_plan(tmp_path)
    with pytest.raises(FileNotFoundError):
        datasets.generate_dataset(tmp_path / "absent.toml", tmp_path / "set")
    with pytest.raises(FileNotFoundError, match="holds no data set") as absent:
        datasets.load_dataset(tmp_path)
    assert (absent.value.errno, absent.value.filename) == (errno.ENOENT, str(tmp_path))
    with pytest.raises(FileNotFoundError, match="holds no data set"):
        datasets.verify_dataset(tmp_path)
    (tmp_path / "file").touch()
    places = {"absent": (FileNotFoundError, errno.ENOENT), "file": (NotADirectoryError, errno.ENOTDIR)}
    for name, (kind, number) in places.items():
        place = str(tmp_path / name)
        for call in (datasets.load_dataset, datasets.verify_dataset, lambda place: datasets.merge_datasets([place], tmp_path / "set")):
            with pytest.raises(kind) as wrong_place:
                call(place)
            assert (wrong_place.value.errno, wrong_place.value.filename) == (number, place)
    with pytest.raises(IsADirectoryError) as directory:
        gears.to_mat(tmp_path)
    assert directory.value.filename == str(tmp_path)
    with pytest.raises(OSError) as refused:
        datasets.generate_dataset(plan, tmp_path / "file")
    assert refused.value.errno
    assert refused.value.filename
    with pytest.raises(ValueError, match=r"part = \(3, 2\)"):
        datasets.generate_dataset(plan, tmp_path / "set", part=(3, 2))
    with pytest.raises(TypeError, match=r"part = 3: must be \(i, n\)"):
        datasets.generate_dataset(plan, tmp_path / "set", part=3)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"jobs = 2\.5: must be a whole number"):
        datasets.generate_dataset(plan, tmp_path / "set", jobs=2.5)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="jobs = 0"):
        datasets.generate_dataset(plan, tmp_path / "set", jobs=0)
    plan.write_text(PLAN.replace("uniform = [20.0, 50.0]", "uniform = [50.0, 20.0]"), encoding="utf-8")
    with pytest.raises(ValueError, match="uniform"):
        datasets.generate_dataset(plan, tmp_path / "set")
    assert not (tmp_path / "set").exists()
    plan.write_text(PLAN.replace("24", "30"), encoding="utf-8")
    with pytest.raises(ValueError):
        datasets.generate_dataset(plan, gears.path)


def stand_in_for_torch(monkeypatch: pytest.MonkeyPatch) -> None:
    """The little that is used of torch, which is too large to be installed for a test."""
    torch, utils, data = (types.ModuleType(name) for name in ("torch", "torch.utils", "torch.utils.data"))
    vars(data)["Dataset"] = object
    vars(torch).update(utils=utils, from_numpy=lambda array: array)
    vars(utils)["data"] = data
    for module in (torch, utils, data):
        monkeypatch.setitem(sys.modules, module.__name__, module)


def test_without_torch(gears: datasets.Dataset, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "torch", None)
    monkeypatch.delitem(sys.modules, "meshtone._torch", raising=False)
    with pytest.raises(ModuleNotFoundError, match=r"torch is not installed: pip install 'meshtone\[torch\]'"):
        gears.to_torch("average_g")


def test_torch(gears: datasets.Dataset, monkeypatch: pytest.MonkeyPatch) -> None:
    if importlib.util.find_spec("torch") is None:
        stand_in_for_torch(monkeypatch)
        monkeypatch.delitem(sys.modules, "meshtone._torch", raising=False)
    train = gears.split("train")
    pairs = train.to_torch("average_g")
    assert len(pairs) == len(train) and pairs.classes == {"label": ["healthy", "tooth-breakage"]}
    signals, labels = train.signals("average_g"), train.column("label")
    # In any order, over the borders of the files.
    for index in [*range(len(train)), 3, 0, -1]:
        signal, number = pairs[index]
        assert np.array_equal(np.asarray(signal), signals[index][None])
        assert pairs.classes["label"][number] == labels[index]
    with pytest.raises(IndexError, match="record 99 of"):
        pairs[99]
    halves = train.to_torch("average_g", transform=lambda signals: signals[:, ::2])
    assert np.array_equal(halves[1][0], signals[1][None, ::2])
    # Of one length, a DataLoader stacks them as it is.
    both = train.to_torch(["average_g", "difference_g"], points=512)
    batch = np.stack([np.asarray(both[index][0]) for index in range(4)])
    assert np.array_equal(batch, train.arrays(["average_g", "difference_g"], points=512)[0][:4])
    for refused, message in (
        (lambda: train.to_torch("fm4"), r"column\('fm4'\) gives them"),
        (lambda: train.to_torch("mean_g"), "no column 'mean_g'"),
        (lambda: train.to_torch("average_g", targets="fault_size"), "no column 'fault_size'"),
        (lambda: train.to_torch("average_g", targets=[]), "targets: no columns are named"),
        (lambda: train.to_torch("average_g", targets=gears.empty_columns), f"null in every record: {gears.empty_columns[0]}"),
        (lambda: train.to_torch("average_g", conditions=["split"]), "'split' holds no numbers"),
        (lambda: train.to_torch("average_g", classes={"label": ["healthy"]}), "there is no 'tooth-breakage' among those of 'label'"),
        (lambda: train.to_torch("average_g", classes={"labels": ["healthy"]}), "'labels' is no target, but label"),
        (lambda: train.to_torch(["vertical_g", "average_g"])[0], r"the record has \d+ of 'vertical_g', \d+ of 'average_g': points="),
    ):
        with pytest.raises(ValueError, match=message):
            refused()
    with pytest.raises(TypeError, match=r"must be a mapping, such as \{'label': \[...\]\}"):
        train.to_torch("average_g", classes=["healthy"])  # type: ignore[arg-type]
    monkeypatch.delitem(sys.modules, "meshtone._torch", raising=False)


def test_torch_in_batches(gears: datasets.Dataset) -> None:
    torch = pytest.importorskip("torch", reason="torch is not installed: pip install 'meshtone[torch]'")
    damaged = gears.filter(pyarrow.dataset.field("label") == "tooth-breakage")
    targets = ["label", "fault_kind", "fault_severity", "fault_tooth", "severity"]

    def batch(records: datasets.Dataset, **options: Any) -> Any:
        pairs = records.to_torch(["average_g", "difference_g"], points=256, targets=targets, conditions=True, **options)
        return pairs, next(iter(torch.utils.data.DataLoader(pairs, batch_size=len(records))))

    pairs, ((signals, conditions), target) = batch(gears)
    assert signals.shape == (24, 2, 256) and signals.dtype == torch.float32
    assert pairs.conditions == gears.condition_columns == ["pinion_teeth", "gear_teeth", "pinion_speed_hz", "brake_torque_nm"]
    assert np.array_equal(conditions.numpy(), gears.matrix(gears.condition_columns).astype(np.float32))
    assert list(target) == targets
    kinds = {"label": torch.int64, "fault_kind": torch.int64}
    assert {name: values.dtype for name, values in target.items()} == {name: kinds.get(name, torch.float32) for name in targets}
    assert pairs.classes["fault_kind"] == [None, "tooth-breakage"]
    healthy = gears.column("label") == "healthy"
    assert np.array_equal(target["fault_severity"].numpy(), np.where(healthy, 0, gears.column("fault_severity")).astype(np.float32))
    assert np.array_equal(np.isnan(target["fault_tooth"].numpy()), healthy)
    # A part without healthy records numbers its classes as the whole does.
    part, (_, alone) = batch(damaged)
    assert part.classes == pairs.classes
    assert torch.equal(alone["label"], target["label"][torch.from_numpy(~healthy)]) and set(alone["label"].tolist()) == {1}
    _, (_, graded) = batch(damaged, classes={"severity": range(6), "label": ["tooth-breakage", "healthy"]})
    assert graded["severity"].tolist() == [3] * len(damaged) and set(graded["label"].tolist()) == {0}
    # A single name gives a bare value.
    assert damaged.to_torch("average_g", targets="fault_severity")[0][1].shape == ()


def test_columns_that_are_null_in_every_record(gears: datasets.Dataset) -> None:
    table = gears.to_arrow(gears.scalar_columns)
    empty = [name for name in table.column_names if table.column(name).null_count == len(table)]
    assert gears.empty_columns == empty != []
    healthy = gears.filter(pyarrow.dataset.field("label") == "healthy")
    # What is null in some part only stays, so that all parts have the same columns.
    assert healthy.empty_columns == empty
    assert list(healthy.to_pandas().columns) == [name for name in gears.scalar_columns if name not in empty]
    with pytest.raises(ValueError, match=f"null in every record: {empty[0]}; leave out what `empty_columns` lists"):
        gears.matrix(["fm4", empty[0]])
    [line] = re.findall("^Null in every record.*: (.*)\\.$", (gears.path / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert line.replace("`", "").split(", ") == empty


def test_front_matter_of_the_card(gears: datasets.Dataset) -> None:
    card = (gears.path / "README.md").read_text(encoding="utf-8")
    _, head, body = card.split("---\n", 2)
    assert head.startswith('license: "cc-by-4.0"\npretty_name: ') and "\ntags: [vibration, " in head
    files = re.findall(r'^  - split: "(\w+)"\n    path: "(.+)"$', head, re.MULTILINE)
    assert files == [(name, f"data/{name}-{'[0-9]' * 6}.parquet") for name in ("train", "test")]
    assert "Cite as: " in body


def test_object_store_in_a_build_without_them() -> None:
    with pytest.raises(ValueError) as refused:
        datasets.load_dataset("s3://")
    if "has no object stores" not in str(refused.value):
        pytest.skip("this build has object stores")
    assert "pip install . --config-settings build-args='--features cloud'" in str(refused.value)


def test_a_published_set_is_unpacked_and_compared(
    gears: datasets.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As `cargo xtask benchmark` packs the benchmark."""
    folder = tmp_path / "made" / "pairs-1"
    shutil.copytree(gears.path, folder)
    script = Path(__file__).parents[2] / "examples" / "datasets" / "publish.py"

    def publish(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, str(script), str(folder), *arguments]
        return subprocess.run(command, capture_output=True, text=True, encoding="utf-8")

    assert publish().returncode == 0
    archive = folder.with_name("pairs-1.zip")
    packed = archive.read_bytes()
    digest, name = archive.with_name("pairs-1.zip.sha256").read_text("utf-8").split()
    assert (digest, name) == (hashlib.sha256(packed).hexdigest(), archive.name)
    with zipfile.ZipFile(archive) as opened:
        # The bytes do not depend on the system.
        assert {(member.create_system, member.external_attr >> 16) for member in opened.infolist()} == {(3, 0o644)}
        assert "CC-BY-4.0" in opened.read("LICENSE").decode()
        sums = [line.split("  ") for line in opened.read("SHA256SUMS").decode().splitlines()]
        assert {name: digest for digest, name in sums} == {f"pairs-1/{name}": digest for name, digest in digests(folder).items()}
    # Another SHA-256 in the package is reported with the line to write, and the archive has the same bytes again.
    published = tmp_path / "published.py"
    published.write_text("", encoding="utf-8")
    other = publish("--published", str(published))
    line = f'"pairs-1": "{digests(folder)["manifest.json"]}"'
    assert other.returncode == 1 and line in other.stderr and archive.read_bytes() == packed
    published.write_text(line, encoding="utf-8")
    assert publish("--published", str(published)).returncode == 0

    downloads = tmp_path / "downloads"
    downloads.mkdir()
    shutil.copy(archive, downloads)
    with pytest.raises(ValueError, match=r"is not the published pairs-1: the SHA-256 of its manifest.json is [0-9a-f]{64} instead"):
        datasets.load("pairs-1", downloads / archive.name)
    # Nothing of a wrong archive stays, so that another one can be fetched.
    assert [file.name for file in downloads.iterdir()] == [archive.name]
    monkeypatch.setitem(PUBLISHED, "pairs-1", digests(folder)["manifest.json"])
    changed = downloads / "changed.zip"
    with zipfile.ZipFile(archive) as opened, zipfile.ZipFile(changed, "w") as rewritten:
        for member in opened.namelist():
            other_bytes = b"x" if member.endswith("train-000001.parquet") else opened.read(member)
            rewritten.writestr(member, other_bytes)
        rewritten.writestr("pairs-1/more.txt", "more")
    with pytest.raises(ValueError, match=r"is not the published pairs-1: data/train-000001.parquet in it has other bytes; fetch it again"):
        datasets.load("pairs-1", changed)
    with zipfile.ZipFile(archive) as opened, zipfile.ZipFile(changed, "w") as rewritten:
        rewritten.writestr("pairs-1/manifest.json", opened.read("pairs-1/manifest.json"))
    with pytest.raises(ValueError, match="is no whole archive of pairs-1: There is no item named"):
        datasets.load("pairs-1", changed)
    changed.unlink()
    assert [file.name for file in downloads.iterdir()] == [archive.name]
    for place in (archive.name, "pairs-1"):
        loaded = datasets.load("pairs-1", downloads / place)
        assert loaded.path == downloads / "pairs-1" and len(loaded) == 24
    flip(downloads / "pairs-1" / "data" / "train-000001.parquet", 3)
    with pytest.raises(ValueError, match=r"train-000001.parquet: its bytes are not those that were written"):
        datasets.load("pairs-1", downloads / archive.name)
    with pytest.raises(ValueError, match="no data set 'pairs' is published; did you mean 'pairs-1'"):
        datasets.load("pairs", archive)
    with pytest.raises(FileNotFoundError):
        datasets.load("pairs-1", tmp_path / "absent.zip")
    (tmp_path / "text.zip").write_text("text", encoding="utf-8")
    with pytest.raises(ValueError, match="is no whole archive of pairs-1"):
        datasets.load("pairs-1", tmp_path / "text.zip")
    assert not (tmp_path / "pairs-1").exists()


CLASSES_WITH_TWO = """
[[class]]
label = "two"
fault = [{ kind = "missing-tooth", wheel = "pinion" }, { kind = "missing-tooth", tooth = 3 }]
"""


def test_the_schema_of_bearing_datasets(tmp_path: Path, gears: datasets.Dataset) -> None:
    """The package itself validates the set, checks every sample, and reads what the records hold."""
    bd = pytest.importorskip("bearing_datasets", reason="bearing-datasets is not installed: pip install bearing-datasets==0.3.0")
    cli, schema = (importlib.import_module(f"bearing_datasets.{name}") for name in ("cli", "schema"))
    plan = write_plan(tmp_path)
    plan.write_text(PLAN.replace("[[vary]]", CLASSES_WITH_TWO + "[[vary]]", 1), encoding="utf-8")
    dataset = datasets.generate_dataset(plan, tmp_path / "set")
    dataset.to_bearing_datasets(tmp_path / "sets/gears")
    written = bd.open("gears", tmp_path / "sets")
    metadata = written.metadata()
    assert written.manifest["schema_version"] == schema.SCHEMA_VERSION == 2
    schema.validate(metadata, written.manifest["columns"])
    assert list(metadata.columns[: len(schema.REQUIRED)]) == list(schema.REQUIRED)
    assert (metadata["sensor_at_fault"] == schema.at_fault(metadata["sensor_location"], metadata["fault_location"])).all()
    both = metadata[metadata["native_label"] == "two"]
    words = [("missing-tooth+missing-tooth", "gear+gear", "gearbox_gear_input+gearbox_gear_output", "pinion+gear")]
    assert list({*zip(*(both[f"fault_{name}"] for name in ("kind", "type", "location", "wheel")))}) == words
    with pytest.raises(SystemExit) as end:
        cli.main(["--root", str(tmp_path / "sets"), "verify", "gears"])
    assert end.value.code in (0, None)
    for record in dataset:
        rows = metadata[metadata["recording_id"] == f"record-{record['record']}"]
        assert list(rows["channel"]) == ["horizontal_g", "vertical_g"]
        row = rows.iloc[1]
        assert (written.signal(row["signal_id"]) == record["vertical_g"]).all()
        assert row["n_samples"] == len(record["vertical_g"]) and row["fs"] == record["sampling_rate_hz"]
        assert row["native_label"] == record["label"] and row["split"] == record["split"] and row["unit_id"] == record["unit"]
        assert row["speed_rpm"] == 60 * record["pinion_speed_hz"] and row["load"] == record["brake_torque_nm"]
        assert (row["fault_severity_level"] > 0) == (record["label"] != "healthy")
    recording = meshtone.read_recording(tmp_path / "sets/gears", variable="record-1")
    assert list(recording) == ["horizontal_g", "vertical_g"] and recording.units["vertical_g"] == "g"
    # A filter leaves its records; nothing is written over what is there but what was interrupted.
    part = gears.split("test")
    (tmp_path / "sets/part/signals").mkdir(parents=True)
    (tmp_path / "sets/part/signals/part-float32.parquet").write_bytes(b"PAR1")
    part.to_bearing_datasets(tmp_path / "sets/part")
    assert len(bd.open("part", tmp_path / "sets").metadata()) == 2 * len(part)
    with pytest.raises(ValueError, match="part has files in it"):
        part.to_bearing_datasets(tmp_path / "sets/part")


def test_what_the_schema_of_bearing_datasets_cannot_have(tmp_path: Path) -> None:
    plan = write_plan(tmp_path)
    datasets.generate_dataset(plan, tmp_path / "half", part=(1, 2))
    with pytest.warns(UserWarning, match="not complete"):
        half = datasets.load_dataset(tmp_path / "half")
    bearing = Base(
        meshtone.gearbox_template().replace("at = 0.0", 'at = 0.0\nkind = "ball"\nname = "ER-10K"\ndefect = [{ race = "outer", width_mm = 0.5 }]', 1)
    )
    refused = [(half, "is not complete")]
    plan.write_text(PLAN.replace("[keep]", "[keep]\nchannels = []"), encoding="utf-8")
    refused.append((datasets.generate_dataset(plan, tmp_path / "bare"), "keeps no raw channels"))
    for dataset, words in refused:
        with pytest.raises(ValueError, match=words):
            dataset.to_bearing_datasets(tmp_path / "out")
    assert not (tmp_path / "out").exists()
    with pytest.raises(ValueError, match=r"bearing\[input:0\] of the base scenario has a spall"):
        bearing.check_healthy()
