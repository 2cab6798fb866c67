"""Reading recordings."""

from __future__ import annotations

import errno
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow
import pyarrow.parquet
import pytest
from scipy import io

import meshtone
from meshtone import hybrid, read_recording


def test_csv(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_text("bearing,tacho\n0.10,5\n-0.20,0\n0.05,5\n", encoding="utf-8")
    recording = read_recording(
        path,
        channels=["bearing"],
        sampling_rate_hz=25_600,
        sensitivity_v_per_unit={"bearing": 0.1},
        units={"bearing": "g"},
    )
    assert recording["bearing"] == pytest.approx([1.0, -2.0, 0.5])
    assert recording.units == {"bearing": "g"} and recording.scenario is None
    assert list(read_recording(path, sampling_rate_hz=10).channels) == ["bearing", "tacho"]
    with pytest.raises(KeyError, match="no channel 'Bearings'; the recording has bearing; did you mean 'bearing'"):
        _ = recording["Bearings"]
    assert "bearing" in recording and "tacho" not in recording and len(recording) == 1
    assert {name: recording[name].size for name in recording} == {"bearing": 3}
    with pytest.raises(ValueError, match="sampling"):
        read_recording(path)
    with pytest.raises(ValueError, match="gearbox"):
        read_recording(path, channels=["gearbox"], sampling_rate_hz=1)
    with pytest.raises(FileNotFoundError):
        read_recording(tmp_path / "absent.csv")



def test_what_is_doubtful_about_a_file_is_warned_of(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_text("time [s],bearing [g],again [g]\n" + "".join(f"{k / 1000},{k % 7},{k % 7}\n" for k in range(50)))
    with pytest.warns(meshtone.MeshtoneWarning, match="again has the samples of bearing") as caught:
        read_recording(path)
    with pytest.warns(meshtone.MeshtoneWarning, match="stated as 900 S/s, but time column time .s. says 1000 S/s") as other:
        read_recording(path, channels=["bearing"], sampling_rate_hz=900)
    assert [warning.message.code for warning in [*caught, *other]] == ["copied-channel", "other-rate"]


def test_npz(tmp_path: Path) -> None:
    path = tmp_path / "run.npz"
    np.savez(path, vibration=np.sin(np.arange(100.0)), fs=np.array(1000.0))
    recording = read_recording(path, variable="vibration", sampling_rate_hz=1000)
    [samples] = recording.channels.values()
    assert np.array_equal(samples, np.sin(np.arange(100.0)))
    assert isinstance(recording, meshtone.Recording)


def test_signals_of_every_format(tmp_path: Path) -> None:
    """What is saved is read back, and by the programs that the formats are for."""
    simulation = meshtone.simulate(meshtone.examples.tooth_breakage().copy(duration_s=0.2))
    signals = simulation.signals(25_000)
    for ending in ("parquet", "csv", "mat", "npz", "wav"):
        path = tmp_path / f"signals.{ending}"
        simulation.save(path)
        recording = read_recording(path)
        assert recording.sampling_rate_hz == simulation.sampling_rate_hz and recording.start_s == pytest.approx(simulation.start_s)
        assert list(recording) == list(simulation.scenario.channels) and recording.units["vertical_g"] == "g"
        exact = ending != "wav"
        assert recording["vertical_g"] == pytest.approx(simulation.vertical_g, rel=0, abs=0 if exact else 32 * 2**-24)
        assert (recording.scenario is not None) == (ending == "parquet")
    loaded = io.loadmat(tmp_path / "signals.mat")
    assert np.array_equal(loaded["vertical_g"].ravel(), simulation.vertical_g) and loaded["sampling_rate_hz"] == 100_640
    assert np.array_equal(np.load(tmp_path / "signals.npz")["time_s"], simulation.time_s)
    table = np.genfromtxt(tmp_path / "signals.csv", delimiter=",", names=True)
    assert np.array_equal(table["mesh_force_n"], simulation.mesh_force_n)
    rate, samples = io.wavfile.read(tmp_path / "signals.wav")
    assert rate == 100_640 and samples[:, 1] * 32 == pytest.approx(simulation.vertical_g, rel=0, abs=32 * 2**-24)
    signals.save(tmp_path / "slow.wav")
    name = next(iter(signals.channels))
    uneven = replace(signals, channels={**signals.channels, name: signals.channels[name][:-1]})
    with pytest.raises(ValueError, match="must be equally long"):
        uneven.save(tmp_path / "uneven.wav")
    slow = read_recording(tmp_path / "slow.wav")
    assert slow.sampling_rate_hz == 25_000 and slow["vertical_g"] == pytest.approx(signals.vertical_g)
    before = sorted(path.name for path in tmp_path.iterdir())
    with pytest.raises(ValueError, match=r"signals\.xlsx: .* \.parquet, \.csv, \.mat, \.npz, \.wav"):
        simulation.save(tmp_path / "signals.xlsx")
    with pytest.raises(OSError, match="cannot write"):
        simulation.save(tmp_path / "absent" / "signals.csv")
    assert sorted(path.name for path in tmp_path.iterdir()) == before


def test_signals_of_a_gearbox(tmp_path: Path) -> None:
    simulation = meshtone.simulate(meshtone.Scenario.from_toml(meshtone.gearbox_template()))
    simulation.save(tmp_path / "signals.mat")
    loaded = io.loadmat(tmp_path / "signals.mat")
    assert np.array_equal(loaded["force_n_z1_z2"].ravel(), simulation["force_n.z1-z2"])
    simulation.save(tmp_path / "signals.parquet")
    assert read_recording(tmp_path / "signals.parquet").scenario == simulation.scenario
    # At another rate they are no longer what the scenario gives.
    simulation.signals(8000).save(tmp_path / "resampled.parquet")
    resampled = read_recording(tmp_path / "resampled.parquet")
    assert resampled.scenario is None and resampled.units["transmission_error_um.z3-z4"] == "µm"


def test_arguments_that_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_text("bearing,tacho\n0.10,5\n-0.20,0\n0.05,5\n", encoding="utf-8")
    # Numbers that were computed.
    assert list(read_recording(path, channels=[2.0], sampling_rate_hz=np.float32(10))) == ["tacho"]  # type: ignore[list-item]
    with pytest.raises(TypeError, match=r"channels = 'bearing': must be a sequence .*\['bearing'\]"):
        read_recording(path, channels="bearing")
    with pytest.raises(TypeError, match=r"channels = 1\.5: must be a whole number"):
        read_recording(path, channels=[1.5])  # type: ignore[list-item]
    with pytest.raises(ValueError, match="time = 0: must be at least 1"):
        read_recording(path, time=0)
    with pytest.raises(ValueError, match="sampling_rate_hz = -1: must be more than 0"):
        read_recording(path, sampling_rate_hz=-1)


READERS: dict[str, Callable[[str], Any]] = {
    "recording": read_recording,
    "scenario": meshtone.Scenario.from_file,
    "experiment": hybrid.tune,
    "tuned": lambda path: hybrid.enhance(meshtone.examples.healthy(), path),
    "plan": lambda path: meshtone.generate_dataset(path, "never written"),
    "save": hybrid.Tuning({}, {}, {}, "").save,
}


@pytest.mark.parametrize("what", READERS)
def test_places_where_no_file_is(what: str, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    places = [("", IsADirectoryError, errno.EISDIR), ("file/below", NotADirectoryError, errno.ENOTDIR)]
    if what != "save":
        places.append(("absent", FileNotFoundError, errno.ENOENT))
    for name, kind, number in places:
        path = str(tmp_path / name)
        with pytest.raises(kind) as refused:
            READERS[what](path)
        assert (refused.value.errno, str(refused.value.filename).removesuffix(".tmp")) == (number, path)
    assert [left.name for left in tmp_path.iterdir()] == ["file"]


def test_a_recording_of_a_set_that_bearing_datasets_built(tmp_path: Path) -> None:
    """Its own writer makes a file for each type of numbers."""
    build = pytest.importorskip("bearing_datasets.build", reason="bearing-datasets is not installed: pip install bearing-datasets==0.3.0")
    import pandas

    generator = np.random.default_rng(1)
    signals: dict[str, np.ndarray[Any, Any]] = {
        "run 1/acc": generator.normal(size=500),
        "run 1/tacho": generator.integers(-3000, 3000, 500).astype(np.int16),
        "run 2/acc": generator.normal(size=300).astype(np.float32),
        "run 2/slow": generator.normal(size=30),
    }
    writer = build.SignalWriter(tmp_path / "signals", row_group_bytes=4000)
    for name, signal in signals.items():
        writer.add(name, signal)
    writer.close()
    table = pandas.DataFrame.from_dict(writer.locations, orient="index", columns=["signal_file", "signal_row_group", "signal_row"])
    table["recording_id"], table["channel"] = zip(*(name.split("/") for name in signals))
    table["fs"] = [10000, 10000, 5000.0, 100.0]
    table["n_samples"] = [signal.size for signal in signals.values()]
    table["unit"] = ["m/s^2", "counts", "g", "unknown"]
    table.to_parquet(tmp_path / "metadata.parquet")
    for place in (tmp_path, tmp_path / "metadata.parquet"):
        recording = read_recording(place, variable="run 1")
        assert recording.sampling_rate_hz == 10000
        assert list(recording.channels) == ["acc", "tacho"] and recording.units == {"acc": "m/s^2", "tacho": None}
        for name in recording:
            assert (recording[name] == signals[f"run 1/{name}"]).all()
    acc = read_recording(tmp_path, variable="run 2", channels=["acc"])
    assert acc.sampling_rate_hz == 5000 and (acc["acc"] == signals["run 2/acc"]).all()
    with pytest.raises(ValueError, match=r"choose those that belong together|states a sampling rate"):
        read_recording(tmp_path, variable="run 2")
    with pytest.raises(ValueError, match="choose one by its recording_id .*: run 1, run 2"):
        read_recording(tmp_path)
    table["n_samples"] = 7
    table.to_parquet(tmp_path / "metadata.parquet")
    with pytest.raises(ValueError, match="acc has 500 samples, and metadata.parquet says 7; build the data set again"):
        read_recording(tmp_path, variable="run 1")


def test_checksums_of_other_programs_are_compared(tmp_path: Path) -> None:
    time_s, file = np.arange(20_000) / 10_000, tmp_path / "run.parquet"
    table = pyarrow.table({"time_s": time_s, "vertical_g": np.random.default_rng(5).normal(size=time_s.size)})
    pyarrow.parquet.write_table(table, file, use_dictionary=False, write_page_checksum=True)
    whole = file.read_bytes()
    assert np.array_equal(read_recording(file)["vertical_g"], table["vertical_g"])
    for number in range(1, 31):
        changed = bytearray(whole)
        # Pages take all of the file but some hundred bytes at its ends.
        changed[1000 + int(number * 0.618033988749895 % 1 * (len(whole) - 4000))] ^= 1 << number % 8
        file.write_bytes(changed)
        with pytest.raises(ValueError, match="is not a whole Parquet file: .*checksum"):
            read_recording(file)
