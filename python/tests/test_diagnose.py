"""What may be wrong with a gear."""

from __future__ import annotations

import json
import pickle
import warnings
from pathlib import Path

import numpy as np
import pytest

import meshtone as mt

RIG = mt.Scenario(
    model="linear",
    module_mm=3,
    pinion_teeth=20,
    gear_teeth=40,
    face_width_mm=15,
    pinion_speed_hz=40,
    brake_torque_nm=200,
    din_grade=6,
    sampling_rate_hz=8000,
)


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the simulations of all tests."""
    return tmp_path_factory.mktemp("reference")


@pytest.mark.filterwarnings("ignore::meshtone.MeshtoneWarning")
def test_from_signals_to_an_answer(reference: Path) -> None:
    reported: list[tuple[int, int]] = []
    gone = mt.simulate(RIG.copy(fault=mt.MissingTooth(tooth=8)))

    def ask(recording: object, healthy: object = None, **options: object) -> mt.Diagnosis:
        return mt.diagnose(recording, RIG, healthy, reference=reference, records=512, **options)  # type: ignore[arg-type]

    found = ask(gone, mt.simulate(RIG), progress=lambda *counts: reported.append(counts))
    assert reported[-1] == (512, 512)
    kind, said = next(iter(found.kinds.items()))
    assert kind in ("missing-tooth", "tooth-breakage", "tooth-destruction")
    assert (said["wheel"], said["tooth"], said["angle_deg"]) == ("gear", 8, 63.0)
    assert found.damaged > 0.9
    assert found.any_damage is not None
    assert (found.any_damage["wheel"], found.any_damage["tooth"]) == ("gear", 8)
    assert found.summary.startswith("The gear is damaged")
    assert found.outside_model > 0.01
    assert found.difference_g.shape == found.band_g[0].shape
    assert np.mean(found.band_g[0] <= found.band_g[1]) == 1
    assert json.loads(json.dumps(found.to_dict()))["kinds"] == found.kinds
    assert "tooth 8" in found._repr_html_()

    gear = found.rule["wheels"]["gear"]
    assert found.rule["is_damaged"] and gear["fm4"]["is_above"]
    assert gear["fm4"]["now"] > gear["fm4"]["limit"] > gear["fm4"]["healthy"]

    # A healthy recording of another speed and rate is compared with simulations at that speed.
    slow = mt.simulate(RIG.copy(pinion_speed_hz=28, sampling_rate_hz=6000))
    phase = mt.ShaftPhase.constant(28.0, 6000.0, slow.vertical_g.size)
    other = ask(gone, (slow.vertical_g, 6000.0, phase))
    assert other.damaged > 0.9
    assert [warning.code for warning in other.warnings if "28.000 Hz in the healthy recording" in warning.message] == ["speed"]

    revolution = ask(found.difference_g, signal="difference")
    assert revolution.to_dict()["signal"] == "difference"
    assert any("when it was healthy" in warning.message for warning in revolution.warnings)

    # What has no mark names no tooth, nor does it after it was pickled.
    anywhere = mt.ShaftPhase.from_mesh_tone(np.cos(2 * np.pi * 800 * np.arange(gone.vertical_g.size) / 8000), 8000.0, 20, 40.0)
    assert pickle.loads(pickle.dumps(anywhere)).zero == "chance"
    unmarked = ask((gone.vertical_g, 8000.0, anywhere))
    said = unmarked.kinds[next(iter(found.kinds))]
    assert (said["tooth"], said["angle_deg"], said["is_on_one_tooth"]) == (None, None, True)
    assert unmarked.to_dict()["teeth_counted_from"] == {"pinion": None, "gear": None}
    quick = mt.ShaftPhase.constant(80.0, 8000.0, gone.vertical_g.size)

    short = mt.ShaftPhase.constant(40, 8000, gone.vertical_g.size + 1)
    other_teeth = mt.simulate(RIG.copy(gear_teeth=60))
    for recording, signal, message in [
        ([], "recording", "at least one"),
        (gone, "spectrum", "must be 'recording', 'average' or 'difference'"),
        (other_teeth, "recording", "teeth"),
        ((gone.vertical_g, 8000.0, short), "recording", "phase"),
        ((gone.vertical_g, 8000.0, quick), "recording", "not of the gear's"),
    ]:
        with pytest.raises(ValueError, match=message):
            ask(recording, signal=signal)
    with pytest.raises(TypeError, match="sampling_rate_hz, phase"):
        ask(gone.vertical_g)


@pytest.mark.filterwarnings("ignore::meshtone.MeshtoneWarning")
def test_what_is_seen_is_warned_of_before_anything_is_simulated(reference: Path, tmp_path: Path) -> None:
    gone = mt.simulate(RIG.copy(fault=mt.MissingTooth(tooth=8)))
    before: list[list[str | None]] = []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", mt.MeshtoneWarning)

        def codes() -> list[str | None]:
            return [given.message.code for given in caught if isinstance(given.message, mt.MeshtoneWarning)]

        # A scenario of its own, of which no simulations are kept.
        rig = RIG.copy(din_grade=0)
        found = mt.diagnose(gone, rig, reference=reference, records=512, progress=lambda *_: before.append(codes()))
    assert before[0] == ["ideal-wheels", "no-healthy"]
    assert codes() == [warning.code for warning in found.warnings]
    assert caught[0].filename == __file__

    # A refusal makes no simulations, nor does a warning that is an error.
    with pytest.raises(ValueError, match="wheels with 20, 60 teeth"):
        mt.diagnose(mt.simulate(RIG.copy(gear_teeth=60)), RIG, reference=tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error", mt.MeshtoneWarning)
        with pytest.raises(mt.MeshtoneWarning, match="when it was healthy"):
            mt.diagnose(gone, RIG, reference=tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_gearbox_is_asked_about_before_anything_is_simulated() -> None:
    """Its simulation is observed wheel by wheel; a pair's scenario and a pair's options are refused."""
    gearbox = mt.Scenario.from_toml(mt.gearbox_template())
    recording = mt.simulate(gearbox)
    with warnings.catch_warnings():
        warnings.simplefilter("error", mt.MeshtoneWarning)
        with pytest.raises(mt.MeshtoneWarning, match="the recording is short"):
            mt.diagnose(recording, gearbox)
        # Its output turns once where its input turns five times.
        values, rate_hz = recording["output_1_vertical_g"], recording.sampling_rate_hz
        phase = mt.ShaftPhase.constant(6.0, rate_hz, values.size)
        with pytest.raises(mt.MeshtoneWarning, match="the recording is short"):
            mt.diagnose(mt.signal.TrainRecording(values, phase, rate_hz, shaft="output"), gearbox)
        with pytest.raises(ValueError, match=r"input turns at 18\.0000 Hz by the recording"):
            mt.diagnose(mt.signal.TrainRecording(values, phase, rate_hz, shaft="middle"), gearbox)
    with pytest.raises(ValueError, match="wheels with 32, 96, 48, 80 teeth, the scenario has 20, 40"):
        mt.diagnose(recording, RIG)
    with pytest.raises(ValueError, match="signal = 'average'"):
        mt.diagnose(recording, gearbox, signal="average")
