"""Writes the MATLAB files of this folder, with SciPy.

    python make_mat.py

The numbers follow from the sample's index, so that the tests can state them.
"""

from pathlib import Path

import numpy as np
from scipy.io import savemat

HERE = Path(__file__).parent
INDEX = np.arange(50)
RATE_HZ = 12_800.0

ONE = 0.5 * INDEX - 3.0
TWO = (INDEX * INDEX).astype(np.int16)
PAIR = np.column_stack([ONE, -2.0 * ONE])

FLAT = {
    "X097_DE_time": ONE.reshape(-1, 1),
    "X097_FE_time": TWO.reshape(-1, 1),
    "X097RPM": 1796.0,
    "fs": RATE_HZ,
}

runs = np.empty((1, 2), dtype=object)
runs[0, 0] = {"signal": ONE, "load": "none"}
runs[0, 1] = {"signal": ONE[:20], "load": "full"}

cells = np.empty((1, 3), dtype=object)
cells[0, 0] = ONE
cells[0, 1] = "a remark"
cells[0, 2] = PAIR

record = np.zeros((1, 2), dtype=[("signal", object), ("name", object)])
record[0, 0] = (ONE, "first")
record[0, 1] = (2.0 * ONE, "second")

NESTED = {
    "bench": {
        "info": {"operator": "nobody", "teeth": np.array([[17, 38]], dtype=np.uint8)},
        "sensors": {"pair": PAIR, "t": INDEX / RATE_HZ, "speed": np.full(50, 24.5, dtype=np.float32)},
        "sampling_rate_hz": RATE_HZ,
    },
    "record": record,
    "cells": cells,
    "runs": runs,
    "flag": True,
    "complex": ONE + 1j * ONE,
    "empty": np.zeros((0, 0)),
}

savemat(HERE / "flat.mat", FLAT, do_compression=False)
savemat(HERE / "flat_compressed.mat", FLAT, do_compression=True)
savemat(HERE / "nested.mat", NESTED, do_compression=False)
savemat(HERE / "nested_compressed.mat", NESTED, do_compression=True)
savemat(HERE / "version4.mat", {"x": ONE}, format="4")
