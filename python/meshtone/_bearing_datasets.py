"""A data set in the schema, version 2, of the Python package `bearing-datasets` 0.3.0: a table of all signals, and their samples.

Names and vocabularies are those of the package's module ``schema``. It knows every damage of a tooth as ``gear`` only, so that the kind stands
in a column of its own; spalls of bearings have its words. No cell may be empty: of the data set's other columns, those that every record has
are kept.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import os
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _core

if TYPE_CHECKING:
    import pyarrow
    import pyarrow.parquet

    from .datasets import Dataset

SIGNAL_FILE = "part-float32.parquet"
"""The file of all samples, in single precision."""

RENAMED = {"unit": "unit_id", "mounting": "mounting_id"}
"""Columns whose names mean something else in the schema."""

FAULT_TYPES = {"outer-race": "outer", "inner-race": "inner", "rolling-element": "rolling_element"}
"""The schema's words for the kinds of damage that it knows."""

FIXED_CHANNELS = {
    "pinion_shaft_speed_hz": ("gearbox_shaft_input", "none", "speed", "none"),
    "gear_shaft_speed_hz": ("gearbox_shaft_output", "none", "speed", "none"),
    "mesh_force_n": ("gearbox_gear", "none", "force", "none"),
    "axial_g": ("gearbox", "unknown", "acceleration", "axial"),
}
"""Place, mounting, quantity and axis of channels that are no listed sensor's."""

PLACES_OF_PAIR = {
    "support": ("gearbox", "pedestal"),
    "pinion-support": ("gearbox_bearing_input", "pedestal"),
    "gear-support": ("gearbox_bearing_output", "pedestal"),
    "wheels": ("gearbox_gear", "unknown"),
}
"""Place and mounting of a pair's listed sensors."""

Fault = dict[str, Any]
"""Kind, wheel, bearing and severity of a record's fault."""


class Base:
    """The scenario that all records of a data set have in common.

    Parameters
    ----------
    text : str
        The data set's `scenario.toml`.
    """

    def __init__(self, text: str) -> None:
        scenario = _core.Scenario.from_toml(text)
        self.is_gearbox = not scenario.is_pair
        self.sections: dict[str, Any] = scenario.sections()
        self.sensors: list[dict[str, Any]] = self.sections.get("sensor", [])
        if self.is_gearbox and not self.sensors:
            bearings = self.sections["bearing"]
            self.sensors = [{"at": f"{bearing['shaft']}:{bearing['at']:.15g}", "direction": "vertical"} for bearing in bearings]
        self.sensor_channels = [self._channel(sensor) for sensor in self.sensors]

    @staticmethod
    def _channel(sensor: dict[str, Any]) -> str:
        place = re.sub("[^0-9A-Za-z]", "_", sensor["at"]).strip("_").replace("__", "_")
        return f"{sensor.get('name', f'{place}_' + sensor['direction'])}_g"

    def check_healthy(self) -> None:
        """Refuse bearings with spalls, because healthy records would be written as normal."""
        for bearing in self.sections.get("bearing", []):
            if bearing.get("defect"):
                raise ValueError(
                    f"bearing[{bearing['shaft']}:{bearing['at']:.15g}] of the base scenario has a spall, which no class labels: have spalls in "
                    "classes alone, fault = { bearing = … }"
                )

    def is_steady(self) -> bool:
        """Whether speed and torque are constant."""
        operation = self.sections["operation"]
        varying = ("speed_profile_hz", "torque_profile_nm", "speed_fluctuation_hz", "torque_fluctuation_nm", "torque_ripple")
        return all(operation.get(name) in (None, 0.0, []) for name in varying)

    def shaft(self, name: str) -> str:
        """A shaft of a gearbox in the schema's words."""
        coupled = {shaft["name"]: shaft["couples_to"] for shaft in self.sections["shaft"]}
        return {"motor": "input", "brake": "output"}.get(coupled.get(name, ""), "intermediate")

    def fault_location(self, fault: Fault) -> str:
        """Where a damaged wheel or bearing sits. The pinion of a pair is on the input shaft."""
        if bearing := fault["bearing"]:
            return f"gearbox_bearing_{self.shaft(bearing.partition(':')[0])}"
        if not self.is_gearbox:
            return "gearbox_gear_input" if fault["wheel"] == "pinion" else "gearbox_gear_output"
        shafts = {wheel["name"]: wheel["shaft"] for wheel in self.sections["wheel"]}
        return f"gearbox_gear_{self.shaft(shafts.get(fault['wheel'], ''))}"

    def facts(self, channel: str) -> tuple[str, str, str, str]:
        """Place, mounting, quantity and axis of a channel."""
        if channel in self.sensor_channels:
            sensor = self.sensors[self.sensor_channels.index(channel)]
            return (*self._sensor_place(sensor["at"]), "acceleration", sensor["direction"])
        if channel in FIXED_CHANNELS:
            return FIXED_CHANNELS[channel]
        is_at_bearing = not self.is_gearbox and self.sections["model"] == "contact"
        place = ("gearbox_bearing_input", "pedestal") if is_at_bearing else ("gearbox", "unknown")
        return (*place, "acceleration", channel.removesuffix("_g"))

    def _sensor_place(self, at: str) -> tuple[str, str]:
        if not self.is_gearbox:
            return PLACES_OF_PAIR[at]
        first, *rest = at.split(":")
        if first == "housing":
            return "gearbox", "casing"
        if first == "shaft":
            return f"gearbox_shaft_{self.shaft(rest[0])}", "shaft"
        return f"gearbox_bearing_{self.shaft(first)}", "casing"


def write_bearing_datasets(dataset: Dataset, folder: Path) -> None:
    """Write the raw channels of a data set. The manifest comes last.

    Parameters
    ----------
    dataset, folder
        As of :meth:`meshtone.Dataset.to_bearing_datasets`.
    """
    import pyarrow

    base = Base((dataset._beside("scenario.toml") or b"").decode())
    channels = [name for name in dataset.signal_columns if _meaning(dataset, name).startswith("raw channel")]
    _check(dataset, folder, base, channels)
    whole = dataset.to_arrow(dataset.scalar_columns)
    others = [name for name in whole.column_names if _is_other(dataset, name) and not whole.column(name).null_count]
    (folder / "signals").mkdir(parents=True, exist_ok=True)
    # One row after the other: what is written of each signal, its meaning, and the value.
    columns = _columns(dataset, folder.absolute().name, base, others)
    rows: list[list[Any]] = []
    digests: dict[str, str] = {}
    schema = pyarrow.schema({"signal_id": pyarrow.string(), "signal": pyarrow.list_(pyarrow.float32())})
    with _table(folder / "signals" / SIGNAL_FILE, schema) as signals:
        records, groups = dataset.records([*dataset.scalar_columns, *channels]), itertools.count()
        while batch := list(itertools.islice(records, 64)):
            group, samples = next(groups), []
            names: list[str] = []
            for record in batch:
                faults = _faults(record)
                for channel in channels:
                    name, signal, place = f"record-{record['record']}/{channel}", record[channel], (group, len(names))
                    rows.append([value(record, faults, channel, place) for _, _, value in columns])
                    digests[name] = hashlib.sha256(b"float32" + signal.tobytes()).hexdigest()
                    names.append(name)
                    samples.append(signal)
            signals.write_table(pyarrow.table([names, pyarrow.array(samples, schema.field("signal").type)], schema))
    table = pyarrow.table({name: [row[place] for row in rows] for place, (name, _, _) in enumerate(columns)})
    with _table(folder / "metadata.parquet", table.schema) as metadata:
        metadata.write_table(table)
    about = {
        "dataset": folder.absolute().name,
        "title": dataset.manifest["title"],
        "license": dataset.manifest["licence"],
        "citation": json.loads(dataset._beside("croissant.json") or b"{}").get("citeAs", ""),
        "package_version": f"Meshtone {_core.__version__}",
        "schema_version": 2,
        "content_hash": hashlib.sha256("".join(f"{name}:{digests[name]}\n" for name in sorted(digests)).encode()).hexdigest(),
        "n_recordings": whole.num_rows,
        "n_signals": len(digests),
        "columns": {name: meaning for name, meaning, _ in columns},
        "raw_files": [],
    }
    (folder / "manifest.json").write_text(json.dumps(about, indent=2) + "\n", encoding="utf-8")


@contextmanager
def _table(path: Path, schema: pyarrow.Schema) -> Iterator[pyarrow.parquet.ParquetWriter]:
    """A table with checksums, and the SHA-256 of its metadata as the compiled module has it: its own digits count as zeros."""
    import pyarrow.parquet

    zeros = "0" * 64
    with pyarrow.parquet.ParquetWriter(path, schema, compression="zstd", write_page_checksum=True) as table:
        table.add_key_value_metadata({"meshtone.metadata_sha256": zeros})
        yield table
    with path.open("r+b") as file:
        file.seek(-8, os.SEEK_END)
        length = int.from_bytes(file.read(4), "little")
        start = file.seek(-8 - length, os.SEEK_END)
        metadata = file.read(length)
        file.seek(start)
        file.write(metadata.replace(zeros.encode(), hashlib.sha256(metadata).hexdigest().encode()))


def _check(dataset: Dataset, folder: Path, base: Base, channels: list[str]) -> None:
    """Refuse what cannot be written."""
    if not dataset.is_complete:
        raise ValueError(f"{dataset.place} is not complete: generate_dataset goes on with it")
    if not channels:
        raise ValueError(f"{dataset.place} keeps no raw channels, which are the signals of this schema: name some in keep.channels of the plan")
    if not folder.absolute().name:
        raise ValueError(f"the folder {folder} has no name, which is the name of the data set")
    signals = folder / "signals"
    # What was interrupted has signals or nothing, and is written again; a table alone is somebody's.
    there = set(folder.rglob("*"))
    if not {signals, signals / SIGNAL_FILE, folder / "metadata.parquet"}.issuperset(there) or there == {folder / "metadata.parquet"}:
        raise ValueError(f"{folder} has files in it: name a folder that is empty or does not exist")
    base.check_healthy()


def _meaning(dataset: Dataset, name: str) -> str:
    meaning: bytes = (dataset.arrow.schema.field(name).metadata or {}).get(b"description", b"")
    return meaning.decode()


def _is_other(dataset: Dataset, name: str) -> bool:
    """Whether the schema has no column of its own for what a column states, which is no indicator."""
    return not name.startswith("fault") and name != "label" and not _meaning(dataset, name).startswith("indicator ")


def _faults(record: dict[str, Any]) -> list[Fault]:
    """The faults of a record; none of a healthy one."""
    prefixes = [name.removesuffix("_kind") for name, value in record.items() if re.fullmatch(r"fault(_\d+)?_kind", name) and value]
    return [{name: record.get(f"{prefix}_{name}") for name in ("kind", "wheel", "bearing", "severity")} for prefix in prefixes]


def _is_at(sensor: str, fault: str) -> bool:
    """Whether one of two places is or contains the other, as the package compares them."""
    return f"{sensor}_".startswith(f"{fault}_") or f"{fault}_".startswith(f"{sensor}_")


def _joined(faults: list[Fault], healthy: str, word: Callable[[Fault], str]) -> str:
    return "+".join(word(fault) for fault in faults) or healthy


Value = Callable[[dict[str, Any], list[Fault], str, tuple[int, int]], Any]
"""A cell of a record with its faults, of a channel, whose samples lie in a group of rows, in a row."""


def _columns(dataset: Dataset, name: str, base: Base, others: list[str]) -> list[tuple[str, str, Value]]:
    """The columns of the table: name, meaning and value, in the order of the schema; those that only Meshtone has come last."""
    speed = "input_speed_hz" if base.is_gearbox else "pinion_speed_hz"
    profile = "constant" if base.is_steady() else "varying"
    units, facts = dataset.units, {channel: base.facts(channel) for channel in dataset.signal_columns}

    def graded(fault: Fault) -> str:
        return "not graded" if fault["severity"] is None else f"{fault['severity']:.3f}"

    columns: list[tuple[str, str, Value]] = [
        ("dataset", "name of the data set", lambda r, f, c, p: name),
        ("signal_id", "the signal: one channel of one record", lambda r, f, c, p: f"record-{r['record']}/{c}"),
        ("recording_id", "the record", lambda r, f, c, p: f"record-{r['record']}"),
        ("native_label", "the class of the plan", lambda r, f, c, p: r["label"]),
        ("channel", "column of the channel", lambda r, f, c, p: c),
        ("sensor_location", "where the sensor sits", lambda r, f, c, p: facts[c][0]),
        ("fs", "sampling rate in Hz; of channels over the angle at the speed of the record", lambda r, f, c, p: r["sampling_rate_hz"]),
        ("n_samples", "number of samples", lambda r, f, c, p: len(r[c])),
        (
            "fault_type",
            "gear for every damaged tooth; outer, inner or rolling_element of a bearing, '+'-joined; 'normal' if healthy",
            lambda r, f, c, p: _joined(f, "normal", lambda fault: FAULT_TYPES.get(fault["kind"], "gear")),
        ),
        (
            "fault_location",
            "where the damaged wheel or bearing sits, '+'-joined; 'none' if healthy",
            lambda r, f, c, p: _joined(f, "none", base.fault_location),
        ),
        (
            "sensor_at_fault",
            "whether sensor_location is or contains fault_location, or the reverse",
            lambda r, f, c, p: any(_is_at(facts[c][0], base.fault_location(fault)) for fault in f),
        ),
        ("signal_file", "file in signals/ that has the samples", lambda r, f, c, p: SIGNAL_FILE),
        ("signal_row_group", "its group of rows", lambda r, f, c, p: p[0]),
        ("signal_row", "row in that group", lambda r, f, c, p: p[1]),
        ("quantity", "quantity that is measured", lambda r, f, c, p: facts[c][2]),
        ("unit", "unit of the samples", lambda r, f, c, p: units[c]),
        ("axis", "direction of the measurement", lambda r, f, c, p: facts[c][3]),
        ("sensor_mounting", "what the sensor is on", lambda r, f, c, p: facts[c][1]),
        ("speed_rpm", "speed of the driving shaft, as the record was drawn", lambda r, f, c, p: 60.0 * r[speed]),
        ("speed_profile", "how the speed changes during the record", lambda r, f, c, p: profile),
        ("load", "brake torque on the output shaft, in load_unit", lambda r, f, c, p: r["brake_torque_nm"]),
        ("load_unit", "unit of load", lambda r, f, c, p: "Nm"),
        ("fault_origin", "artificial for every damage; 'none' if healthy", lambda r, f, c, p: "artificial" if f else "none"),
        (
            "fault_severity",
            "severity from 0 to 1 on the scale of the kind of damage, which Meshtone's guide defines; 'none' if healthy",
            lambda r, f, c, p: _joined(f, "none", graded),
        ),
        (
            "fault_severity_level",
            "grade of the severity, as the plan divides it; 0 if healthy",
            lambda r, f, c, p: max(r["severity"], 1) if f else 0,
        ),
        ("fault_kind", "kind of damage, '+'-joined; 'none' if healthy", lambda r, f, c, p: _joined(f, "none", lambda fault: fault["kind"])),
        (
            "fault_wheel",
            "the damaged wheel, '+'-joined; 'none' if healthy, and of a bearing",
            lambda r, f, c, p: _joined(f, "none", lambda fault: fault["wheel"] or "none"),
        ),
    ]
    if any(re.fullmatch(r"fault(_\d+)?_bearing", column) for column in dataset.columns):
        meaning = "the damaged bearing by its shaft and place, '+'-joined; 'none' if healthy, and of a wheel"
        columns.append(("fault_bearing", meaning, lambda r, f, c, p: _joined(f, "none", lambda fault: fault["bearing"] or "none")))
    return columns + [
        (RENAMED.get(other, other), _meaning(dataset, other), lambda r, f, c, p, other=other: r[other])
        for other in others
    ]
