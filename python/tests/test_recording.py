"""Reading recordings."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import meshtone
from meshtone import read_recording


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
    with pytest.raises(KeyError, match="the recording has bearing"):
        _ = recording["tacho"]
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
