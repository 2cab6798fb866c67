"""Reads a data set with pyarrow and polars, and checks what a user relies on.

usage: python read.py DIRECTORY
"""

import json
import sys
from pathlib import Path

import numpy as np
import polars as pl
import pyarrow.dataset as ds
import pyarrow.parquet as pq

directory = Path(sys.argv[1])
manifest = json.loads((directory / "manifest.json").read_text(encoding="utf-8"))
rows = sum(file["rows"] for file in manifest["files"])

# pyarrow: types, units, metadata, lists.
table = ds.dataset(directory / "data").to_table().sort_by("record")
assert table.num_rows == rows, (table.num_rows, rows)
schema = pq.ParquetFile(directory / manifest["files"][0]["name"]).schema_arrow
assert schema.field("vertical_g").metadata[b"unit"] == b"g"
assert schema.field("pinion_speed_hz").metadata[b"unit"] == b"Hz"
assert str(schema.field("vertical_g").type) == "list<item: float not null>", schema.field("vertical_g").type
plan = pq.read_metadata(directory / manifest["files"][0]["name"]).metadata[b"meshtone.plan_sha256"].decode()
assert plan == manifest["plan_sha256"]
arrow_signal = np.asarray(table["vertical_g"][5].as_py(), dtype=np.float32)
assert arrow_signal.size > 1000 and np.isfinite(arrow_signal).all()

# polars: the same numbers, filters, nulls, and counts that the manifest says.
frame = pl.scan_parquet(directory / "data" / "*.parquet").sort("record").collect()
assert frame.height == rows
assert frame["vertical_g"].dtype == pl.List(pl.Float32)
assert (frame["vertical_g"][5].to_numpy() == arrow_signal).all()
assert frame.filter(pl.col("label") == "healthy")["fault_tooth"].null_count() == frame.filter(pl.col("label") == "healthy").height
for split, labels in manifest["counts"].items():
    for label, count in labels.items():
        found = frame.filter((pl.col("split") == split) & (pl.col("label") == label)).height
        assert found == count, (split, label, found, count)
splits = frame.group_by("unit").agg(pl.col("split").n_unique())
assert splits["split"].max() == 1

# The average is that of the raw signal.
row = frame.row(7, named=True)
signal, speed, rate = np.asarray(row["vertical_g"]), row["gear_speed_hz"], row["sampling_rate_hz"]
points = len(row["average_g"])
turns = int(len(signal) * speed / rate)
angles = (np.arange(turns * points) / points) * rate / speed
average = np.interp(angles, np.arange(len(signal)), signal).reshape(turns, points).mean(axis=0)
assert np.corrcoef(average, row["average_g"])[0, 1] > 0.9

print(f"{rows} records, {len(manifest['files'])} files: pyarrow and polars agree")
