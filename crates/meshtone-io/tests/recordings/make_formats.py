"""Writes the files of the folder ``formats``, with the writers that practitioners use.

    pip install scipy h5py pyuff npTDMS asammdf openpyxl
    python make_formats.py

All hold ``acc`` in g and ``tacho`` in V at 25 600 S/s; some a ``speed`` in Hz at 100 S/s too. The numbers follow from the sample's index, so
that the tests can state them.
"""

import struct
from pathlib import Path

import h5py
import numpy as np
import pyuff
from asammdf import MDF, Signal
from nptdms import ChannelObject, RootObject, TdmsFile, TdmsWriter
from openpyxl import Workbook
from scipy.io import savemat

HERE = Path(__file__).parent / "formats"
HERE.mkdir(exist_ok=True)
RATE_HZ = 25_600.0
INDEX = np.arange(256)
TIME = INDEX / RATE_HZ
ACC = (INDEX * 7919 % 1009 - 504) / 256.0
TACHO = np.where(INDEX % 64 < 6, 5.0, 0.0)
SLOW_HZ = 1000.0
SPEED = 25.0 + np.arange(10) / 8.0


def tdms() -> None:
    def channel(name, data, unit, increment=1.0 / RATE_HZ, group="run", **more):
        properties = {"wf_increment": increment, "wf_start_offset": 0.0, "unit_string": unit, **more}
        return ChannelObject(group, name, data, properties={} if increment is None else properties)

    acc, tacho = channel("acc", ACC, "g"), channel("tacho", TACHO.astype(np.float32), "V")
    with TdmsWriter(HERE / "plain.tdms") as writer:
        writer.write_segment([RootObject(properties={"operator": "nobody"}), acc, tacho])
    with TdmsWriter(HERE / "segments.tdms") as writer:
        for part in np.split(INDEX, 4):
            writer.write_segment([channel("acc", ACC[part], "g"), channel("tacho", TACHO[part], "V")])
    with TdmsWriter(HERE / "time.tdms") as writer:
        plain = [ChannelObject("run", name, data, properties={}) for name, data in [("time [s]", TIME), ("acc [g]", ACC), ("tacho", TACHO)]]
        writer.write_segment(plain)
    with TdmsWriter(HERE / "rates.tdms") as writer:
        writer.write_segment([acc, tacho, channel("speed", SPEED, "Hz", 1.0 / SLOW_HZ, "slow")])
    scaled = {"NI_Scaling_Status": "unscaled", "NI_Number_Of_Scales": np.uint32(1), "NI_Scale[0]_Scale_Type": "Linear"}
    scaled |= {"NI_Scale[0]_Linear_Slope": 1 / 256, "NI_Scale[0]_Linear_Y_Intercept": 0.0, "NI_Scale[0]_Linear_Input_Source": np.uint32(0xFFFFFFFF)}
    with TdmsWriter(HERE / "scaled.tdms") as writer:
        writer.write_segment([channel("acc", (256 * ACC).astype(np.int16), "g", **scaled), tacho])
    # Interleaved, highest byte first, as real-time controllers write; nptdms has no writer for it, but reads it.
    text = lambda words: struct.pack(">I", len(words)) + words.encode()
    number = lambda name, value: text(name) + struct.pack(">Id", 10, value)
    unit = lambda value: text("unit_string") + struct.pack(">I", 0x20) + text(value)
    index = struct.pack(">IIIQ", 20, 10, 1, len(ACC))
    objects = [text(f"/'run'/'{name}'") + index + struct.pack(">I", 2) + number("wf_increment", 1.0 / RATE_HZ) + unit(u)
               for name, u in [("acc", "g"), ("tacho", "V")]]
    metadata = struct.pack(">I", 2) + b"".join(objects)
    raw = np.column_stack([ACC, TACHO]).astype(">f8").tobytes()
    contents = 1 << 1 | 1 << 2 | 1 << 3 | 1 << 5 | 1 << 6
    lead = b"TDSm" + struct.pack("<I", contents) + struct.pack(">IQQ", 4713, len(metadata) + len(raw), len(metadata))
    (HERE / "interleaved.tdms").write_bytes(lead + metadata + raw)
    assert np.array_equal(TdmsFile.read(HERE / "interleaved.tdms")["run"]["acc"][:], ACC)


def mdf() -> None:
    signals = [Signal(ACC, TIME, unit="g", name="acc"), Signal(TACHO.astype(np.float32), TIME, unit="V", name="tacho")]
    for name, compression in [("plain", 0), ("deflated", 1), ("transposed", 2)]:
        with MDF(version="4.10") as file:
            file.append(signals)
            file.save(HERE / f"{name}.mf4", overwrite=True, compression=compression)
    counts = Signal((256 * ACC).astype(np.int16), TIME, unit="g", name="acc", conversion={"a": 1 / 256, "b": 0.0})
    with MDF(version="4.10") as file:
        file.append([counts, signals[1]])
        file.append([Signal(SPEED, np.arange(10) / SLOW_HZ, unit="Hz", name="speed")])
        file.save(HERE / "rates.mf4", overwrite=True)


def excel() -> None:
    def save(name, head, rows, with_info=False, time_format=None):
        book = Workbook()
        sheet = book.active
        for line in head + rows:
            sheet.append(line)
        if time_format:
            for cell in sheet["A"][len(head):]:
                cell.number_format = time_format
        if with_info:
            book.create_sheet("info", 0).append(["operator", "nobody", 7])
        book.save(HERE / name)

    columns = [TIME.tolist(), ACC.tolist(), TACHO.tolist()]
    rows = [list(row) for row in zip(*columns, strict=True)]
    save("plain.xlsx", [["time [s]", "acc [g]", "tacho [V]"]], rows)
    save("units.xlsx", [["time", "acc", "tacho"], ["s", "g", "V"]], rows, with_info=True)
    days = [[row[0] / 86_400.0, *row[1:]] for row in rows]
    save("clock.xlsx", [["Time", "acc [g]", "tacho [V]"]], days, time_format="hh:mm:ss.000")


def matlab_and_hdf5() -> None:
    savemat(HERE / "version4.mat", {"acc": ACC, "tacho": TACHO.astype(np.float32), "fs": RATE_HZ}, format="4")
    # Channels of two rates, each with its times, and the instants of pulses.
    savemat(HERE / "rates.mat", {"t": TIME, "acc": ACC, "tacho": TACHO, "t_speed": np.arange(10) / SLOW_HZ, "speed": SPEED, "pulses": TIME[::64]})
    for name, version in [("old", "earliest"), ("new", "latest")]:
        with h5py.File(HERE / f"links_{name}.h5", "w", libver=version) as file:
            group = file.create_group("run")
            group["acc"], group["tacho"] = ACC, TACHO
            group["fs"] = RATE_HZ
            if name == "new":
                group["again"] = h5py.SoftLink("/run/acc")
            group["root"] = file["/"]
    with h5py.File(HERE / "soft_old.h5", "w", libver="earliest") as file:
        file["acc"] = ACC
        file["again"] = h5py.SoftLink("/acc")
    with h5py.File(HERE / "half.h5", "w") as file:
        file["acc"], file["tacho"], file["fs"] = ACC.astype(np.float16), TACHO, RATE_HZ


def universal() -> None:
    axes = ["abscissa", "ordinate", "orddenom", "z_axis"]
    nothing = {f"{axis}_{what}_unit_exp": 0 for axis in axes for what in ["len", "force", "temp"]}
    nothing |= {f"{axis}_axis_units_lab": "NONE" for axis in axes[2:]}
    for name, is_binary in [("text", 0), ("binary", 1)]:
        path = HERE / f"{name}.uff"
        path.unlink(missing_ok=True)
        file = pyuff.UFF(str(path))
        for number, (label, data, unit) in enumerate([("acc", ACC, "g"), ("tacho", TACHO, "V")]):
            written = pyuff.prepare_58(
                binary=is_binary, func_type=1, rsp_node=number + 1, rsp_dir=3, ref_dir=0, ref_node=0, rsp_ent_name=label, ref_ent_name="NONE",
                id1=label, id2="NONE", id3="NONE", id4="NONE", id5="NONE", data=data, x=TIME, ord_data_type=4, num_pts=len(data),
                abscissa_spacing=1, abscissa_min=0.0, abscissa_inc=1.0 / RATE_HZ, abscissa_spec_data_type=17, 
                abscissa_axis_units_lab="s", ordinate_spec_data_type=12, ordinate_axis_units_lab=unit,
                ver_num=0, load_case_id=0, z_axis_value=0.0, orddenom_spec_data_type=0, z_axis_spec_data_type=0, **nothing, return_full_dict=True,
            )
            file.write_sets(written, "add")


tdms()
mdf()
excel()
matlab_and_hdf5()
universal()
