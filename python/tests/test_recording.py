"""Reading recordings."""

from __future__ import annotations

import errno
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

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


def test_npz(tmp_path: Path) -> None:
    path = tmp_path / "run.npz"
    np.savez(path, vibration=np.sin(np.arange(100.0)), fs=np.array(1000.0))
    recording = read_recording(path, variable="vibration", sampling_rate_hz=1000)
    [samples] = recording.channels.values()
    assert np.array_equal(samples, np.sin(np.arange(100.0)))
    assert isinstance(recording, meshtone.Recording)


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
