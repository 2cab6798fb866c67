"""A data set for a machine of which healthy recordings are known."""

import warnings
from pathlib import Path

import numpy as np
import pytest

import meshtone as mt


@pytest.mark.filterwarnings("ignore::meshtone.MeshtoneWarning")
def test_damage_of_a_machine_behind_an_unknown_path_is_found(tmp_path: Path) -> None:
    rig = mt.examples.healthy().copy(sampling_rate_hz=2e4, settle_tolerance=1e-3, sensors=[mt.Sensor(name="housing")])
    path = {"frequency_hz": [0.0, 1e4], "magnitude": [3.0, 3.0], "phase_deg": [0.0, 0.0]}
    machine = rig.copy(wheels_seed=7, duration_s=6.0, sensors=[mt.Sensor(name="housing", frequency_response=path)])
    adapted = mt.adapt(mt.simulate(machine), rig, tmp_path / "set", classes=["missing-tooth", "tooth-breakage"], units=16, draws=8)
    assert adapted.classes == ["healthy", "missing-tooth", "tooth-breakage"]
    assert adapted.healthy.size > 4 and (adapted.healthy <= adapted.threshold).mean() > 0.85
    assert len(adapted.dataset) == 16 * 5
    assert set(adapted.dataset["label"]) == set(adapted.classes)
    least, most = adapted.expected.area_under_curve[1:]
    assert 0.5 < least <= adapted.expected.area_under_curve[0] <= most <= 1.0
    missing = mt.simulate(machine.copy(seed=3, fault=mt.MissingTooth()))
    probabilities = adapted.probabilities(missing)
    np.testing.assert_allclose(probabilities.sum(axis=1), 1.0, atol=1e-9)
    assert (1.0 - probabilities[:, 0] > adapted.threshold).all()
    healthy = mt.simulate(machine.copy(seed=4, duration_s=2.0))
    turning = mt.ShaftPhase.constant(machine.pinion_speed_hz, healthy.sampling_rate_hz, healthy.sensors["housing"].size)
    for unit, is_doubted in ((1.0, False), (9.81, True)):
        with warnings.catch_warnings(record=True) as doubts:
            warnings.simplefilter("always")
            adapted.probabilities((unit * healthy.sensors["housing"], healthy.sampling_rate_hz, turning))
        assert any("more than in any simulation" in str(doubt.message) for doubt in doubts) == is_doubted
    with pytest.raises(ValueError, match="there are missing-tooth"):
        mt.adapt(mt.simulate(machine), rig, tmp_path / "other", classes=["rust"])
