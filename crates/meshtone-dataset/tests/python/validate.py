"""Validates an exported data set by the Python package bearing-datasets itself, and compares it with the data set that it was made of.

usage: python validate.py DIRECTORY

The folder `set` has the data set, and `sets/gears` the exported one.
"""

import sys
from pathlib import Path

import numpy as np
import pyarrow.dataset as ds

try:
    import bearing_datasets as bd
    from bearing_datasets.cli import main
    from bearing_datasets.schema import REQUIRED, SCHEMA_VERSION, at_fault, validate
except ImportError:
    print("skipped: bearing-datasets is not installed: pip install bearing-datasets==0.3.0")
    sys.exit()

directory = Path(sys.argv[1])
gears = bd.open("gears", directory / "sets")
metadata = gears.metadata()
assert gears.manifest["schema_version"] == SCHEMA_VERSION == 2
validate(metadata, gears.manifest["columns"])
assert list(metadata.columns[: len(REQUIRED)]) == list(REQUIRED)
assert (metadata["sensor_at_fault"] == at_fault(metadata["sensor_location"], metadata["fault_location"])).all()
assert set(metadata["fault_kind"]) == {"none", "tooth-breakage", "missing-tooth", "missing-tooth+missing-tooth"}
both = metadata[metadata["fault_kind"].str.contains(r"\+")]
assert set(both["fault_type"]) == {"gear+gear"}
assert set(both["fault_location"]) == {"gearbox_gear_input+gearbox_gear_output"}
# The package's own check of every sample.
try:
    main(["--root", str(directory / "sets"), "verify", "gears"])
except SystemExit as end:
    assert end.code == 0
table = ds.dataset(directory / "set" / "data").to_table().to_pandas()
for record in table.itertuples():
    rows = metadata[metadata["recording_id"] == f"record-{record.record}"]
    assert list(rows["channel"]) == ["horizontal_g", "vertical_g"]
    row = rows.iloc[1]
    assert (gears.signal(row["signal_id"]) == np.asarray(record.vertical_g)).all()
    assert row["n_samples"] == len(record.vertical_g) and row["fs"] == record.sampling_rate_hz
    assert row["native_label"] == record.label and row["split"] == record.split and row["unit_id"] == record.unit
    assert row["speed_rpm"] == 60 * record.pinion_speed_hz and row["load"] == record.brake_torque_nm
print(f"{len(metadata)} signals: bearing-datasets validates and reads them")
