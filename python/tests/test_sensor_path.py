"""The path to a sensor, from recordings of the healthy machine."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import meshtone as mt

RIG = mt.Scenario(
    module_mm=3,
    pinion_teeth=20,
    gear_teeth=40,
    face_width_mm=15,
    pinion_speed_hz=40,
    brake_torque_nm=50,
    din_grade=6,
    sampling_rate_hz=2e4,
    duration_s=2,
    sensors=[mt.Sensor()],
)
TRIPLE = {"frequency_hz": [0.0, 1e5], "magnitude": [3.0, 3.0], "phase_deg": [0.0, 0.0]}


def test_a_path_is_found_and_taken(tmp_path: Path) -> None:
    reported: list[tuple[int, int]] = []
    healthy = mt.simulate(RIG.copy(seed=7, sensors=[mt.Sensor(frequency_response=TRIPLE)]))
    path = mt.estimate_path(healthy, RIG, draws=8, progress=lambda *counts: reported.append(counts))
    assert reported[-1] == (16, 16)
    inside = (path.frequency_hz > path.compared_hz[0]) & (path.frequency_hz < path.compared_hz[1])
    error_db = path.magnitude_db[inside] - 20 * np.log10(3)
    assert np.sqrt(np.mean(error_db**2)) < 3
    assert np.all(path.low_db <= path.magnitude_db) and np.all(path.magnitude_db <= path.high_db)
    assert not path.magnitude_db.flags.writeable

    # Of a measured signal with its phase it is the same, but for where revolutions begin.
    rate_hz = healthy.sampling_rate_hz
    phase = mt.ShaftPhase.constant(40.0, rate_hz, healthy.time_s.size)
    again = mt.estimate_path((healthy.sensors["pinion_support_vertical"], rate_hz, phase), RIG, draws=8)
    assert np.sqrt(np.mean((again.magnitude_db - path.magnitude_db) ** 2)) < 0.5

    # So it is by the phase of the gear's shaft.
    phase = mt.ShaftPhase.constant(20.0, rate_hz, healthy.time_s.size)
    of_gear = mt.signal.TrainRecording(healthy.sensors["pinion_support_vertical"], phase, rate_hz, shaft="gear")
    again = mt.estimate_path(of_gear, RIG, draws=8)
    assert np.sqrt(np.mean((again.magnitude_db - path.magnitude_db) ** 2)) < 0.5

    path.write_csv(tmp_path / "path.csv")
    lines = (tmp_path / "path.csv").read_text().splitlines()
    assert lines[0] == "frequency_hz,magnitude,phase_deg,magnitude_db,low_db,high_db"
    assert len(lines) == path.frequency_hz.size + 1
    tuned = mt.simulate(RIG.copy(seed=7, sensors=[mt.Sensor(frequency_response=path.frequency_response)]))
    levels = [np.std(simulation.sensors["pinion_support_vertical"]) for simulation in (tuned, healthy)]
    assert abs(20 * np.log10(levels[0] / levels[1])) < 3


def test_what_is_wrong_is_refused() -> None:
    healthy = mt.simulate(RIG)
    with pytest.raises(ValueError, match=r"draws = 4.*8"):
        mt.estimate_path(healthy, RIG, draws=4)
    with pytest.raises(ValueError, match=r"quality\.din_grade.*ideal wheels"):
        mt.estimate_path(healthy, RIG.copy(din_grade=0))
    with pytest.raises(ValueError, match="at least one"):
        mt.estimate_path([], RIG)
    phase = mt.ShaftPhase.constant(40.0, healthy.sampling_rate_hz, healthy.time_s.size)
    of_shaft = mt.signal.TrainRecording(healthy.vertical_g, phase, healthy.sampling_rate_hz, shaft="output")
    with pytest.raises(ValueError, match=r"shaft = 'output': must be one of pinion, gear"):
        mt.estimate_path(of_shaft, RIG)
    with pytest.raises(TypeError, match="must be simulations"):
        mt.estimate_path(healthy.vertical_g, RIG)  # type: ignore[arg-type]
