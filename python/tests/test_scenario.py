"""Scenarios: arguments, round trips, errors."""

from __future__ import annotations

import dataclasses
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import FAULTS, PAIR, ROOT

import meshtone
from meshtone import Scenario, examples


@pytest.mark.parametrize("fault", FAULTS.values())
def test_round_trips(fault: meshtone.Fault | None) -> None:
    scenario = Scenario(**PAIR, fault=fault, din_grade=6, damping_ratio=[0.04] * 13)
    for same in (Scenario.from_toml(scenario.to_toml()), pickle.loads(pickle.dumps(scenario)), scenario.copy()):
        assert same == scenario
        assert hash(same) == hash(scenario)
    assert getattr(scenario.fault, "kind", None) == getattr(fault, "kind", None)
    assert eval(repr(scenario), vars(meshtone)) == scenario


def test_tips_of_each_wheel() -> None:
    both = Scenario(**PAIR, flank_relief={"amount_um": 10.0}, tip_chamfer_mm=0.5)
    scenario = both.copy(gear_flank_relief={"amount_um": 20.0})
    assert scenario == Scenario(**PAIR, pinion_flank_relief={"amount_um": 10.0}, gear_flank_relief={"amount_um": 20.0}, tip_chamfer_mm=0.5)
    assert scenario.flank_relief is None and scenario.tip_chamfer_mm == 0.5
    assert scenario.pinion_flank_relief is not None and scenario.pinion_flank_relief["amount_um"] == 10.0
    for same in (Scenario.from_toml(scenario.to_toml()), pickle.loads(pickle.dumps(scenario)), scenario.copy(), eval(repr(scenario), vars(meshtone))):
        assert same == scenario
    assert scenario.copy(flank_relief={"amount_um": 10.0}) == both


def test_lists_of_faults() -> None:
    chip = meshtone.ToothBreakage(chip_height_mm=3.0, chip_width_mm=4.0, tip_loss_mm=0.0, wheel="pinion", tooth=3)
    missing = meshtone.MissingTooth(tooth=6)
    both = Scenario(**PAIR, faults=[chip, missing])
    assert both.faults == (chip, missing)
    for same in (Scenario.from_toml(both.to_toml()), pickle.loads(pickle.dumps(both)), both.copy()):
        assert same == both
    assert eval(repr(both), vars(meshtone)) == both
    assert both.copy(fault=missing) == Scenario(**PAIR, fault=missing) == Scenario(**PAIR, faults=[missing])
    assert both.copy(fault=None).faults == both.copy(faults=[]).faults == ()
    assert both.copy(faults=[missing]).fault == missing
    with pytest.raises(ValueError, match=r"there are 2 faults: scenario\.faults has them"):
        _ = both.fault
    with pytest.raises(TypeError, match="fault and faults are both given"):
        Scenario(**PAIR, fault=chip, faults=[missing])
    with pytest.raises(TypeError, match="fault is a sequence: faults takes several"):
        Scenario(**PAIR, fault=[chip, missing])  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"faults\[1\] = 'broken': must be an object of MissingTooth, .*ToothDestruction, Wear"):
        examples.healthy().copy(faults=[meshtone.MissingTooth(), "broken"])
    with pytest.raises(TypeError, match=r"faults\[0\] is the class MissingTooth"):
        examples.healthy().copy(faults=[meshtone.MissingTooth])
    with pytest.raises(TypeError, match="faults = .*: must be a sequence of faults"):
        Scenario(**PAIR, faults=missing)  # type: ignore[arg-type]


def test_every_key_of_a_fault_is_a_field() -> None:
    for kind, scenario in examples.all().items():
        if scenario.fault is None:
            continue
        [section] = [part for part in meshtone.template(kind).split("\n[") if part.startswith("[fault]")]
        lines = [line.removeprefix("#") for line in section.splitlines() if " = " in line and not line.startswith("# ")]
        keys = {line.split(" = ")[0] for line in lines}
        assert keys - {"kind"} <= {field.name for field in dataclasses.fields(scenario.fault)}, kind
        assert keys >= {"kind", "wheel", "tooth"}


def test_every_key_of_a_scenario_file_is_an_argument() -> None:
    from meshtone._keys import SECTION_OF_KEY

    for kind in examples.all():
        text = meshtone.template(kind, all_keys=True)
        keys = set()
        section = ""
        for line in text.splitlines():
            line = line.removeprefix("# ") if line.startswith(("# pinion_inertia =", "# gear_inertia =")) else line.removeprefix("#")
            if line.startswith("["):
                section = line.strip("[]")
            elif " = " in line and not line.startswith(" "):
                keys.add((section, line.split(" = ")[0].split(".")[0]))
        for section, key in keys:
            if section != "fault" and (section, key) != ("quality", "seed"):
                assert SECTION_OF_KEY.get(key) == section, key
        assert keys >= {("gears", "module_mm"), ("solver", "initial_displacement")}


def test_profile_errors() -> None:
    pinion, gear = np.full((100, 17), 1e-3), np.arange(3800.0).reshape(100, 38) * 1e-6
    scenario = Scenario(**PAIR, pinion_profile_errors_mm=pinion, gear_profile_errors_mm=gear)
    for same in (scenario, scenario.copy(pinion_speed_hz=30), pickle.loads(pickle.dumps(scenario))):
        given = (same.pinion_profile_errors_mm, same.gear_profile_errors_mm)
        assert given[0] is not None and given[1] is not None
        assert np.array_equal(given[0], pinion) and np.array_equal(given[1], gear)
    with pytest.raises(ValueError, match="belong together"):
        Scenario(**PAIR, pinion_profile_errors_mm=pinion)
    with pytest.raises(ValueError, match="gear_profile_errors_mm"):
        Scenario(**PAIR, pinion_profile_errors_mm=pinion, gear_profile_errors_mm=gear[:, :-1])


def test_examples_are_the_files(tmp_path: Path) -> None:
    for path in sorted((ROOT / "examples").glob("*.toml")):
        assert isinstance(Scenario.from_file(path), Scenario)
    with pytest.raises(FileNotFoundError, match="absent.toml"):
        Scenario.from_file(tmp_path / "absent.toml")
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(meshtone.template("healthy").replace("module_mm = 3.0", "modul_mm = 3.0"), encoding="utf-8")
    with pytest.raises(ValueError, match="module_mm"):
        Scenario.from_file(wrong)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"module_mm": -1}, "gears.module_mm = -1: must be more than 0 mm"),
        ({"pinion_teeth": 3}, "gears.pinion_teeth = 3: must be from 6"),
        ({"din_grade": 13}, "quality.din_grade = 13"),
        ({"material": "wood"}, "gears.material"),
        ({"model": "other"}, "model"),
        ({"fault": meshtone.MissingTooth(tooth=39)}, "fault.tooth = 39: must be at most 38"),
        ({"faults": [meshtone.MissingTooth(), meshtone.MissingTooth(wheel="pinion", tooth=0)]}, "fault[1].tooth = 0"),
        ({"fault": meshtone.MissingTooth(tooth=[2, 39])}, "fault.tooth[1] = 39: must be at most 38"),
        ({"fault": meshtone.MissingTooth(tooth=[2, 3, 2])}, "fault.tooth[2] = 2: is named twice"),
        ({"fault": meshtone.ToothBreakage(chip_height_mm=-5, chip_width_mm=12)}, "fault.chip_height_mm = -5"),
        ({"damping_ratio": [0.05] * 12}, "rig.damping_ratio"),
        ({"seed": 2**63}, "seed = 9223372036854775808: must be below 2**63"),
        ({"pinion_profile_errors_mm": [0.0], "gear_profile_errors_mm": [0.0]}, "pinion_profile_errors_mm has shape (1,)"),
    ],
)
def test_values_that_are_not_allowed(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError) as error:
        Scenario(**{**PAIR, **changes})
    assert message in str(error.value)
    assert "line " not in str(error.value)


@pytest.mark.parametrize("tooth", [[1, 2, 9], (1, 2, 9), "all"])
def test_a_fault_on_several_teeth(tooth: Any) -> None:
    scenario = Scenario(**PAIR, fault=meshtone.RootCrack(depth_mm=2, tooth=tooth))
    (fault,) = scenario.faults
    assert fault.tooth == (tooth if tooth == "all" else [1, 2, 9])
    assert Scenario.from_toml(scenario.to_toml()) == scenario


def test_keys_that_there_are_not() -> None:
    with pytest.raises(TypeError, match="no key 'modul_mm'; did you mean 'module_mm'"):
        Scenario(**PAIR, modul_mm=3)  # type: ignore[arg-type]
    # A misspelt key is why one is missing: that is said, not only what is missing.
    others = {key: value for key, value in PAIR.items() if key != "module_mm"}
    with pytest.raises(TypeError, match="no key 'Modul_mm'; did you mean 'module_mm'"):
        Scenario(**others, Modul_mm=3)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="no key 'speed'"):
        examples.healthy().copy(speed=3)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="fault = 'broken'"):
        Scenario(**PAIR, fault="broken")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"fault is the class MissingTooth: .*MissingTooth\("):
        Scenario(**PAIR, fault=meshtone.MissingTooth)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"circle = \(57, 3, 2\): must be a PitCircle"):
        Scenario(**PAIR, fault=meshtone.ThroughFace(circle=(57, 3, 2)))  # type: ignore[arg-type]
    with pytest.raises(AttributeError, match="no key 'modul_mm'; did you mean 'module_mm'"):
        _ = examples.healthy().modul_mm  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match=r"scenario.copy\(seed=2\)"):
        examples.healthy().seed = 2
    with pytest.raises(AttributeError, match="no key 'speed'"):
        _ = examples.healthy().speed  # type: ignore[attr-defined]
    with pytest.raises(TypeError, match="no key 'speed_rpm': speeds are revolutions per second, pinion_speed_hz=40"):
        examples.healthy().copy(speed_rpm=2400)  # type: ignore[call-arg]
    with pytest.raises(AttributeError, match=r"scenario.to_toml\(\)\) writes its file"):
        examples.healthy().save("rig.toml")  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match=r"its simulation, meshtone.simulate\(scenario\)"):
        _ = examples.healthy().vertical_g  # type: ignore[attr-defined]


def test_seed_of_the_wheels() -> None:
    scenario = examples.healthy().copy(wheels_seed=7)
    assert scenario.wheels_seed == 7 and scenario.seed == 1
    assert "seed = 7" in scenario.to_toml() and "wheels_seed=7" in repr(scenario)
    wheels = [meshtone.simulate(s.copy(sampling_rate_hz=1e4)).profile_errors_mm() for s in (scenario, scenario.copy(seed=3))]
    assert wheels[0] is not None and wheels[1] is not None
    assert np.array_equal(wheels[0][1], wheels[1][1])


def test_a_file_name_is_not_a_files_text() -> None:
    with pytest.raises(ValueError, match=r"'healthy\.toml' is the name of a file.*from_file"):
        Scenario.from_toml("healthy.toml")


def test_what_is_missing_is_missing_in_a_scenario() -> None:
    for positional in ("healthy.toml", PAIR):
        with pytest.raises(TypeError, match=r"takes its keys by name, Scenario\(module_mm=3, …\); Scenario.from_file reads a file"):
            Scenario(positional)  # type: ignore[arg-type, call-arg]
    with pytest.raises(TypeError, match=r"^Scenario\(\) missing 5 required keyword-only arguments: 'module_mm', 'pinion_teeth'"):
        Scenario()  # type: ignore[call-arg]


def test_warnings() -> None:
    assert examples.healthy().warnings == []
    ignored = examples.healthy().copy(model="published", eccentricity_mm=0.1)
    assert all(isinstance(warning, str) for warning in ignored.warnings)
    # Before simulating, all that the program reports then: also what the stages show.
    undamped = examples.healthy().copy(model="linear", damping_ratio=0.0, mesh_damping_ratio=0.0)
    assert any("never decays" in warning for warning in undamped.warnings)
    profile = {"time_s": [0, 0.1], "value": [30, 50]}
    with pytest.raises(ValueError, match=r"solver\.duration_s = 1\.0: given beside a profile that ends at 0\.1 s"):
        examples.healthy().copy(speed_profile_hz=profile, duration_s=1.0)


def test_faults_say_which_argument_is_meant() -> None:
    with pytest.raises(TypeError, match=r"RootCrack has no argument 'depht_mm'; did you mean 'depth_mm'\?"):
        meshtone.RootCrack(depht_mm=1.0)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="MissingTooth has no argument 'x'; it has wheel, tooth, severity"):
        meshtone.MissingTooth(x=1)  # type: ignore[call-arg]
    drawn = {"density_per_cm2": 20.0, "spread": 0.2, "radius_mm": 0.3, "radius_spread": 0.3, "depth_mm": 0.05}
    pits = meshtone.Pits(random=drawn)  # type: ignore[arg-type]
    assert pits == meshtone.Pits(random=meshtone.RandomPits(**drawn))
    with pytest.raises(TypeError, match=r"RandomPits has no argument 'radius'; did you mean 'radius_mm'\?"):
        meshtone.Pits(random={"radius": 1})  # type: ignore[arg-type]


def test_whole_numbers_may_be_floats() -> None:
    computed = {key: float(value) if key.endswith("teeth") else value for key, value in PAIR.items()}
    sensors = [meshtone.Sensor(range_g=50, bits=16.0)]  # type: ignore[arg-type]
    for number in (float, np.float32):
        tooth = [number(3), number(4)]
        scenario = Scenario(**computed, seed=number(2), fault=meshtone.MissingTooth(tooth=tooth), sensors=sensors)  # type: ignore[arg-type]
        assert (scenario.pinion_teeth, scenario.seed, scenario.faults[0].tooth, scenario.sensors[0].bits) == (17, 2, [3, 4], 16)
        assert Scenario.from_toml(scenario.to_toml()) == scenario
    with pytest.raises(ValueError, match=r"gears.pinion_teeth = 17.5: must be a whole number"):
        examples.healthy().copy(pinion_teeth=17.5)
