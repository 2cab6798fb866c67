"""Sensors: their scenario, their signals, and what leads the results."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import meshtone
from meshtone import MissingTooth, Scenario, Sensor, examples, simulate, simulate_many


def _sensed(**changes: object) -> Scenario:
    sensors = [Sensor(name="casing", resonance_hz=3e3), Sensor(range_g=0.5, bits=8, path={"plate_hz": 0.0})]
    return examples.healthy().copy(**{"sampling_rate_hz": 2e4, "sensors": sensors, **changes})


def test_scenario_with_sensors() -> None:
    scenario = _sensed()
    assert [sensor.name for sensor in scenario.sensors] == ["casing", None]
    assert scenario.sensors[0].resonance_damping_ratio == 0.02
    assert scenario.channels == ("casing_g", "pinion_support_vertical_g", *meshtone.CHANNELS)
    assert Scenario.from_toml(scenario.to_toml()) == scenario == pickle.loads(pickle.dumps(scenario))
    assert scenario.copy(fault=MissingTooth()).sensors == scenario.sensors
    assert scenario.copy(sensors=None) == scenario.copy(sensors=[]) == examples.healthy().copy(sampling_rate_hz=2e4)
    assert "sensors=[Sensor(name='casing'" in repr(scenario)
    assert eval(repr(scenario), vars(meshtone)) == scenario
    assert copy.copy(scenario.sensors[0]) == scenario.sensors[0]


def test_refused_sensors() -> None:
    with pytest.raises(ValueError, match=r"sensor\.bits = 16: needs sensor\.range_g"):
        _sensed(sensors=[Sensor(bits=16)])
    with pytest.raises(ValueError, match=r"sensor\[1\]\.name = \"pinion_support_vertical\".*sensor\[0\]"):
        _sensed(sensors=[Sensor(), Sensor(range_g=1)])
    with pytest.raises(TypeError, match=r"sensors\[0\] = 'support': must be a Sensor"):
        _sensed(sensors=["support"])
    with pytest.raises(TypeError, match="must be a sequence of sensors"):
        _sensed(sensors=Sensor())
    with pytest.raises(TypeError, match=r"sensors\[0\] is the class Sensor"):
        _sensed(sensors=[Sensor])


def test_signals_of_sensors() -> None:
    simulation = simulate(_sensed())
    assert list(simulation.sensors) == ["casing", "pinion_support_vertical"]
    casing = simulation.sensors["casing"]
    assert simulation.casing_g is casing  # type: ignore[attr-defined]
    assert casing.shape == simulation.vertical_g.shape
    # A resonance of 3 kHz, below the motion's own: it is not the motion.
    assert not np.allclose(casing, simulation.vertical_g)
    limited = simulation.sensors["pinion_support_vertical"]
    assert np.array_equal(limited, np.clip(np.round(np.clip(simulation.vertical_g, -0.5, 0.5) * 256) / 256, -0.5, 0.5))
    plain = simulate(_sensed(sensors=None))
    assert plain.sensors == {}
    assert np.array_equal(plain.vertical_g, simulation.vertical_g)
    # Its attributes are those of every simulation; what is completed in brackets is its own.
    assert "casing_g" in simulation._ipython_key_completions_() and "casing_g" not in dir(simulation)
    with pytest.raises(AttributeError, match=r"no field 'casin_g'; did you mean 'casing_g'\?"):
        _ = simulation.casin_g  # type: ignore[attr-defined]


def test_first_sensor_leads() -> None:
    simulation = simulate(_sensed())
    assert simulation.process().name == "casing_g"
    assert simulation.process("vertical_g").name == "vertical_g"
    with pytest.raises(ValueError, match="'sideways': must be one of casing_g, pinion_support_vertical_g, horizontal_g"):
        simulation.process("sideways")
    assert simulation.plot_signal().get_ylabel() == "Casing (g)"
    assert simulation.plot_spectrum("vertical_g").get_ylabel() == "Vertical acceleration,\namplitude (g)"


def test_force_through_a_flat_path() -> None:
    path = {"frequency_hz": np.array([0.0, 1e5]), "magnitude": [1.0, 1.0], "phase_deg": (0.0, 0.0)}
    simulation = simulate(_sensed(sensors=[Sensor(name="path", response_input="force", frequency_response=path, path={"plate_hz": 0.0})]))
    assert np.allclose(simulation.sensors["path"], simulation.mesh_force_n / 9.81, rtol=0, atol=1e-10)


def test_many_with_sensors() -> None:
    scenario = _sensed()
    with_it, without = simulate_many([scenario, scenario.copy(sensors=None)], channels=["casing_g", "vertical_g"], on_error="return")
    assert isinstance(with_it, meshtone.Signals)
    assert np.array_equal(with_it.channels["casing_g"], simulate(scenario).sensors["casing"].astype(np.float32))
    assert with_it.process().name == "casing_g"
    assert isinstance(without, ValueError)
    assert "no channel `casing_g`; there are horizontal_g" in str(without)
    [by_default] = simulate_many([scenario])
    assert isinstance(by_default, meshtone.Signals)
    assert by_default.process().name == "vertical_g"
    with pytest.raises(ValueError, match="'case_g': must be one of casing_g"):
        simulate_many([scenario], channels=["case_g"])
