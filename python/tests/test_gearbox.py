"""Gearboxes in Python."""

import pickle

from typing import Any

import numpy as np
import pytest

import meshtone as mt

STEEL = {"youngs_modulus_gpa": 206.0, "poisson_ratio": 0.3, "density_kg_per_m3": 7850.0}


def gearbox(**changes: Any) -> mt.Scenario:
    """One pair on two shafts."""
    arguments: dict[str, Any] = {
        "shafts": [
            {"name": "input", "length_mm": 200, "radius_mm": 10, "couples_to": "motor"},
            {"name": "output", "length_mm": 200, "radius_mm": 10, "couples_to": "brake"},
        ],
        "wheels": [
            {"name": "z1", "shaft": "input", "at": 0.5, "teeth": 17, "face_width_mm": 15},
            {"name": "z2", "shaft": "output", "at": 0.5, "teeth": 38, "face_width_mm": 15},
        ],
        "meshes": [{"wheels": ["z1", "z2"], "module_mm": 3}],
        "bearings": [{"shaft": shaft, "at": at} for shaft in ("input", "output") for at in (0.0, 1.0)],
        "operation": {"input_speed_hz": 40, "brake_torque_nm": 10},
        "solver": {"duration_s": 0.2},
    }
    return mt.Gearbox(**{**arguments, **changes})


def test_one_pair_carries_its_torque() -> None:
    # Friction would take a part of it.
    simulation = mt.simulate(gearbox(material=STEEL, meshes=[{"wheels": ["z1", "z2"], "module_mm": 3, "friction": 0.0}]))
    force_n = 10 / (3e-3 * 38 / 2 * np.cos(np.radians(20)))
    mesh = simulation.summary()["meshes"][0]
    assert mesh["static_force_n"] == pytest.approx(force_n, rel=1e-9)
    assert np.mean(simulation["force_n.z1-z2"]) == pytest.approx(force_n, rel=1e-3)
    assert np.mean(simulation["speed_hz.output"]) == pytest.approx(40 * 17 / 38, rel=1e-3)
    assert len(simulation.time_s) == len(simulation["force_n.z1-z2"])


def test_frequencies_with_other_stiffnesses() -> None:
    simulation = mt.simulate(gearbox())
    own = simulation.natural_frequencies_hz
    assert own == pytest.approx(simulation.summary()["natural_frequencies_hz"])
    mean = simulation.fields["mean_stiffness_n_per_m.z1-z2"]
    assert simulation.natural_frequencies_with_hz([mean]) == pytest.approx(own)
    stiffer = simulation.natural_frequencies_with_hz([4 * mean])
    assert np.all(stiffer >= own * (1 - 1e-9)) and np.any(stiffer > 1.05 * own)
    with pytest.raises(ValueError, match="must have 1, one a mesh"):
        simulation.natural_frequencies_with_hz([1e8, 1e8])


def test_is_kept_and_read_back() -> None:
    box = gearbox(faults=[{"wheel": "z2", "tooth": 3, "kind": "missing-tooth"}], housing={})
    assert mt.Scenario.from_toml(box.to_toml()) == box
    assert pickle.loads(pickle.dumps(box)) == box
    assert box.sections["fault"][0]["wheel"] == "z2"
    assert box.fault == mt.MissingTooth(wheel="z2", tooth=3)
    assert gearbox(faults=[mt.MissingTooth(wheel="z2", tooth=3)], housing={}) == box
    assert box.copy(fault=None, operation={"input_speed_hz": 20}) == gearbox(housing={}, operation={"input_speed_hz": 20, "brake_torque_nm": 10})
    with pytest.raises(TypeError, match="a gearbox has no argument 'pinion_speed_hz'"):
        box.copy(pinion_speed_hz=20)


def test_batch_gives_the_same_as_alone() -> None:
    """A batch may have pairs and gearboxes; what is kept are the channels that are looked at first."""
    wheels = [{**wheel, "iso_class": 6} for wheel in gearbox().sections["wheel"]]
    pair = mt.examples.healthy().copy(sampling_rate_hz=2e4)
    scenarios = [gearbox(seed=1, wheels=wheels), pair, gearbox(seed=2, wheels=wheels)]
    alone = [mt.simulate(scenario) for scenario in scenarios]
    reported: list[tuple[int, int]] = []
    together = mt.simulate_many(scenarios, threads=2, progress=lambda done, of: reported.append((done, of)))
    assert reported[-1] == (3, 3) and [of.scenario for of in together] == scenarios
    assert list(together[1].channels) == ["horizontal_g", "vertical_g"] and len(together[0].channels) == 4
    for one, other in zip(alone, together):
        for name, values in other.channels.items():
            assert np.array_equal(one[name].astype(np.float32), values)
    assert not np.array_equal(alone[0]["input_0_vertical_g"], alone[2]["input_0_vertical_g"])
    [forces, _] = mt.simulate_many([scenarios[0], scenarios[2]], channels=["force_n.z1-z2"])
    assert np.array_equal(forces.channels["force_n.z1-z2"], alone[0]["force_n.z1-z2"].astype(np.float32))
    with pytest.raises(ValueError, match="threads"):
        mt.simulate_many(scenarios, threads=0)
    with pytest.raises(ValueError, match="'force_n.z1-z3': must be one of input_0_vertical_g"):
        mt.simulate_many(scenarios, channels=["force_n.z1-z3"])
    with pytest.raises(ValueError, match=r"scenarios\[1\]: .*no channel `force_n.z1-z2`; there are horizontal_g"):
        mt.simulate_many(scenarios, channels=["force_n.z1-z2"])


def test_a_batch_of_gearboxes_has_a_target_rate() -> None:
    [signals] = mt.simulate_many([gearbox()], target_rate_hz=8000)
    assert signals.sampling_rate_hz == 8000 and signals.channels["input_0_vertical_g"].size == 1600
    with pytest.warns(mt.MeshtoneWarning, match="leaves nothing of the mesh, whose frequency of 680 Hz"):
        mt.simulate_many([gearbox()], target_rate_hz=1000)


def test_judgement_does_not_depend_on_how_many_there_are() -> None:
    text = mt.gearbox_template("uconn").replace("duration_s = 1.0", "duration_s = 0.2").replace("speed_wander_percent = 0.03", "")
    doubtful = mt.Scenario.from_toml(text.replace("sampling_rate_hz = 100000.0", "sampling_rate_hz = 20000.0"))
    with pytest.warns(mt.MeshtoneWarning):
        [alone] = mt.simulate_many([doubtful])
    with pytest.warns(mt.MeshtoneWarning):
        [one, other] = mt.simulate_many([doubtful, doubtful])
    assert alone.warnings == one.warnings == other.warnings
    with pytest.warns(mt.MeshtoneWarning, match="S/s the rms is"):
        mt.simulate(doubtful)


def test_no_more_memory_is_taken_than_is_free() -> None:
    mt.set_memory_limit(10**15)
    large = gearbox(solver={"duration_s": 1e6})
    mt.set_memory_limit(None)
    with pytest.raises(ValueError, match="solver.duration_s.* free on this machine"):
        mt.simulate(large)


def test_profile_errors_are_of_the_wheel() -> None:
    wheels = gearbox().sections["wheel"]
    errors_mm = np.full((100, 17), 2e-3)
    box = gearbox(wheels=[{**wheels[0], "profile_errors_mm": errors_mm}, wheels[1]])
    assert np.array_equal(box.sections["wheel"][0]["profile_errors_mm"], errors_mm)
    with pytest.raises(ValueError, match=r"wheel\[1\].profile_errors_mm .*must be 100 × 38"):
        gearbox(wheels=[wheels[0], {**wheels[1], "profile_errors_mm": errors_mm}])


def test_mistakes_are_named() -> None:
    with pytest.raises(ValueError, match=r"wheel\[1\].shaft = \"none\" .*: is no shaft's name; there are \"input\", \"output\""):
        gearbox(wheels=[gearbox().sections["wheel"][0], {**gearbox().sections["wheel"][1], "shaft": "none"}])
    with pytest.raises(ValueError, match="bearing"):
        gearbox(bearings=[{"shaft": "input", "at": 0.0, "stiffnes_n_per_m": 1e8}])
    with pytest.raises(TypeError, match="must be a sequence of dictionaries"):
        gearbox(shafts={"name": "input"})
    with pytest.raises(ValueError, match="shaft"):
        gearbox(shafts=[], wheels=[], meshes=[], bearings=[])
    with pytest.raises(ValueError, match="must be one of phm2009-spur, phm2009-helical, uconn, tecnalia, nrel-grc, planetary-lab, oedi-623"):
        mt.gearbox_template("none")  # type: ignore[arg-type]


def test_material_of_a_pair_is_a_table_too() -> None:
    pair = mt.examples.healthy()
    steel = {"youngs_modulus_gpa": 210.0, "poisson_ratio": 0.3, "density_kg_per_m3": 7840.0}
    given, named = pair.copy(material=steel), pair.copy(material="steel")
    assert given.material == steel
    assert np.array_equal(mt.simulate(given).vertical_g, mt.simulate(named).vertical_g)


def two_stages(**changes: Any) -> mt.Scenario:
    """Two stages at a low rate."""
    sections = mt.Scenario.from_toml(mt.gearbox_template()).sections
    lists = {"shaft": "shafts", "wheel": "wheels", "mesh": "meshes", "bearing": "bearings", "sensor": "sensors"}
    arguments: dict[str, Any] = {name: sections[section] for section, name in lists.items()}
    # Its speed is constant, so that phases are those of a clock.
    arguments["operation"] = {**sections["operation"], "speed_wander_percent": 0.0}
    arguments["housing"] = sections["housing"]
    arguments["solver"] = {"sampling_rate_hz": 2e4, "duration_s": 2.0}
    return mt.Gearbox(**{**arguments, **changes})


def test_a_recording_shows_every_shaft() -> None:
    damaged = two_stages(faults=[{"wheel": "z4", "tooth": 5, "kind": "missing-tooth"}])
    simulation = mt.simulate(damaged)
    own = simulation.process_wheels()
    assert own.mean_speeds_hz == pytest.approx({"input": 30, "middle": 10, "output": 6})
    assert own["z2"].indicators["difference_rms"] == own["z3"].indicators["difference_rms"]
    assert own.foreign_lines == []
    assert own.own_orders_part is not None and 0.0 < own.own_orders_part < 1.0

    # A tachometer on the output, and the tone of something else.
    values, rate_hz = simulation["output_1_vertical_g"], simulation.sampling_rate_hz
    time_s = np.arange(values.size) / rate_hz
    phase = mt.ShaftPhase.from_pulses(np.arange(0.01, 2.0, 1 / 6), 1, rate_hz, values.size)
    tone = np.std(values) * np.cos(2 * np.pi * 91.57 * time_s)
    record = mt.signal.process_train(values + tone, phase, damaged, rate_hz, shaft="output")
    assert record.foreign_lines is not None
    assert record.foreign_lines[0].frequency_hz == pytest.approx(91.57, abs=0.2)
    assert record.foreign_lines[0].order == pytest.approx(91.57 / 30, abs=0.01)
    assert {wheel: record[wheel].teeth for wheel in record.wheels} == {"z1": 32, "z2": 96, "z3": 48, "z4": 80}
    with pytest.raises(ValueError, match="shaft = 'exit': must be one of input, middle, output"):
        mt.signal.process_train(values, phase, damaged, rate_hz, shaft="exit")
    with pytest.raises(KeyError, match="there is no average of a wheel 'z5'"):
        record["z5"]

    # A pair is a train of two shafts.
    pair = mt.simulate(mt.examples.healthy().copy(sampling_rate_hz=2e4))
    of_pinion = mt.ShaftPhase.constant(40.0, pair.sampling_rate_hz, pair.vertical_g.size)
    both = mt.signal.process_train(pair.vertical_g, of_pinion, pair.scenario, pair.sampling_rate_hz)
    alone = mt.process_channel(pair.vertical_g, of_pinion, 17)
    # Octaves that the sampling rate does not show are NaN.
    assert both["pinion"].indicators == pytest.approx(alone.indicators, rel=0, abs=0, nan_ok=True)
    assert both.shafts["gear"] == "gear"


def test_a_path_of_a_gearbox_is_found() -> None:
    triple = {"frequency_hz": [0.0, 1e5], "magnitude": [3.0, 3.0], "phase_deg": [0.0, 0.0]}
    rig = two_stages()
    sensor = {**rig.sections["sensor"][0], "frequency_response": triple}
    healthy = mt.simulate(two_stages(sensors=[sensor], seed=7))
    path = mt.estimate_path(healthy, rig, draws=8)
    inside = (path.frequency_hz > path.compared_hz[0]) & (path.frequency_hz < path.compared_hz[1])
    assert np.sqrt(np.mean((path.magnitude_db[inside] - 20 * np.log10(3)) ** 2)) < 3
