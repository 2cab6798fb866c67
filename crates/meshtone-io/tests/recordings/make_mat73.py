"""Writes the HDF5 files of this folder, with h5py: one as MATLAB's `save -v7.3` arranges it, and a plain one.

    python make_mat73.py

The numbers follow from the sample's index, so that the tests can state them.
"""

from pathlib import Path

import h5py
import numpy as np

HERE = Path(__file__).parent
INDEX = np.arange(50)
RATE_HZ = 12_800.0

ONE = 0.5 * INDEX - 3.0
PAIR = np.column_stack([ONE, -2.0 * ONE])


def variable(group: h5py.Group, name: str, values: np.ndarray, kind: str, **options: object) -> None:
    """An array of MATLAB, whose dimensions stand in reverse order."""
    dataset = group.create_dataset(name, data=np.ascontiguousarray(np.atleast_2d(values).T), **options)
    dataset.attrs["MATLAB_class"] = np.bytes_(kind)


with h5py.File(HERE / "v73.mat", "w", userblock_size=512) as file:
    # A column vector in compressed chunks, as MATLAB writes all larger arrays.
    variable(file, "acc", ONE.reshape(-1, 1), "double", chunks=(1, 20), compression="gzip", shuffle=True)
    variable(file, "count", (INDEX * INDEX).astype(">i2").reshape(-1, 1), "int16")
    variable(file, "fs", np.array([[RATE_HZ]]), "double")
    variable(file, "name", np.frombuffer("bench".encode("utf-16-le"), np.uint16).reshape(1, -1), "char")
    run = file.create_group("run")
    run.attrs["MATLAB_class"] = np.bytes_("struct")
    variable(run, "pair", PAIR.astype(np.float32), "single")
    # MATLAB writes the dimensions of an empty array in its place, and a sparse array as a group.
    empty = file.create_dataset("empty", data=np.array([0, 0], np.uint64))
    empty.attrs["MATLAB_class"] = np.bytes_("double")
    empty.attrs["MATLAB_empty"] = np.uint8(1)
    sparse = file.create_group("sparse")
    sparse.attrs["MATLAB_class"] = np.bytes_("double")
    sparse.attrs["MATLAB_sparse"] = np.uint64(2)
    for name, values in {"data": [1.0, 2.0], "ir": np.uint64([0, 1]), "jc": np.uint64([0, 1, 2])}.items():
        sparse.create_dataset(name, data=values)
    refs = file.create_group("#refs#")
    variable(refs, "a", ONE.reshape(-1, 1), "double")
    cells = file.create_dataset("cells", data=np.array([[refs["a"].ref]], dtype=h5py.ref_dtype), dtype=h5py.ref_dtype)
    cells.attrs["MATLAB_class"] = np.bytes_("cell")
with (HERE / "v73.mat").open("r+b") as stream:
    stream.write(b"MATLAB 7.3 MAT-file, written by h5py".ljust(124) + b"\x00\x02IM")

with h5py.File(HERE / "plain.h5", "w") as file:
    file.create_dataset("bench/pair", data=PAIR, chunks=(16, 2), compression="gzip")
    file.create_dataset("bench/t", data=INDEX / RATE_HZ)
    file.create_dataset("remark", data="nothing")
