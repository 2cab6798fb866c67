"""A simulation has the same members whatever its scenario is: a pair, a helical pair, a gearbox."""

import inspect
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.pyplot
import numpy as np
import numpy.typing as npt
import pytest

import meshtone as mt

matplotlib.use("agg")

GEARBOX = mt.Scenario.from_toml(mt.gearbox_template()).copy(
    solver={"sampling_rate_hz": 2e4, "duration_s": 1.0}, fault=mt.MissingTooth(wheel="z3", tooth=5)
)
PAIR = mt.examples.missing_tooth().copy(sampling_rate_hz=2e4)
SCENARIOS = {
    "pair": PAIR,
    "linear": PAIR.copy(model="linear"),
    "published": PAIR.copy(model="published"),
    "helical": PAIR.copy(helix_angle_deg=15.0),
    "gearbox": GEARBOX,
}
OF_A_PAIR = ("horizontal_g", "vertical_g", "axial_g", "pinion_shaft_speed_hz", "gear_shaft_speed_hz", "mesh_force_n")
ARGUMENTS: dict[str, Callable[[mt.Simulation], tuple[Any, ...]]] = {
    "contact_figures_of": lambda of: (of.meshes[0],),
    "natural_frequencies_with_hz": lambda of: ([3e8] * len(of.meshes),),
}
"""What a method cannot be called without."""


@pytest.fixture(scope="module")
def simulations() -> dict[str, mt.Simulation]:
    return {name: mt.simulate(scenario) for name, scenario in SCENARIOS.items()}


def members(of: mt.Simulation) -> list[str]:
    return [name for name in dir(of) if not name.startswith("_") or name == "_repr_html_"]


@pytest.mark.filterwarnings("ignore::meshtone.MeshtoneWarning")
def test_members_do_not_depend_on_the_form(simulations: dict[str, mt.Simulation]) -> None:
    assert len(members(simulations["pair"])) > 60
    for other in simulations.values():
        assert dir(other) == dir(simulations["pair"])
    assert dir(simulations["gearbox"].signals().scenario) == dir(simulations["pair"].scenario)


@pytest.mark.parametrize("form", SCENARIOS)
@pytest.mark.filterwarnings("ignore::meshtone.MeshtoneWarning")
def test_every_member_is_there_or_says_what_is(form: str, simulations: dict[str, mt.Simulation], tmp_path: Path) -> None:
    simulation = simulations[form]
    # What there is only of one pair is in no gearbox, and the published model has no pairs of teeth that share a force.
    lacking: dict[str, set[str]] = {
        "gearbox": {*OF_A_PAIR, *(set(mt.Simulation.__annotations__) - {"natural_frequencies_hz", *simulation.fields})},
        "published": {"static_mesh", "natural_frequencies_with_hz"},
    }
    refused = set()
    for name in members(simulation):
        try:
            member: Any = getattr(simulation, name)
            if inspect.ismethod(member):
                arguments: Any = ARGUMENTS.get(name)
                of_name = arguments(simulation) if arguments else ()
                given: tuple[Any, ...] = (tmp_path / "signals.npz",) if name == "save" else of_name
                member(*given)
        except (AttributeError, ValueError) as error:
            assert any(words in str(error) for words in ("a gearbox has no", "the published model has no", "a simulation has no field")), error
            refused.add(name)
        matplotlib.pyplot.close("all")
    published_has_not = {name for name in refused if name in mt.Simulation.__annotations__} if form != "gearbox" else set()
    assert refused - published_has_not == lacking.get(form, set())
    assert (tmp_path / "signals.npz").stat().st_size > 0


def test_a_simulation_of_a_gearbox_is_kept_and_repeated(simulations: dict[str, mt.Simulation]) -> None:
    simulation = simulations["gearbox"]
    again = pickle.loads(pickle.dumps(simulation))
    assert np.array_equal(again["force_n.z3-z4"], simulation["force_n.z3-z4"])
    assert repr(simulation) == f"<Simulation of 32/96, 48/80 teeth, missing-tooth of z3 tooth 5: {simulation.time_s.size} samples at 20010 S/s>"


def test_the_contact_of_each_mesh(simulations: dict[str, mt.Simulation]) -> None:
    simulation = simulations["gearbox"]
    assert simulation.meshes == ("z1-z2", "z3-z4") and simulation.wheels == ("z1", "z2", "z3", "z4")
    figures = simulation.contact_figures_of("z3-z4")
    assert figures is not None
    force_n = simulation["force_n.z3-z4"]
    assert figures.largest_force_n == pytest.approx(np.abs(force_n).max()) and figures.apart_fraction == np.mean(force_n == 0)
    assert simulation.contact_figures == simulation.contact_figures_of("z1-z2")
    with pytest.raises(ValueError, match="mesh = 'z1-z4': must be one of z1-z2, z3-z4"):
        simulation.contact_figures_of("z1-z4")


def test_a_mesh_of_a_gearbox_at_rest(simulations: dict[str, mt.Simulation]) -> None:
    simulation = simulations["gearbox"]
    at_rest = simulation.static_mesh(800, mesh="z3-z4", pitches=(6, 8))
    assert np.abs(at_rest.pair_force_n.sum(axis=0) - 800).max() < 1e-6
    # The fifth tooth of z3 is missing: its pair, the fifth, carries nothing.
    missing = simulation.static_mesh(800, mesh="z3-z4", pitches=(4, 5))
    assert np.all(missing.pair_force_n[missing.pairs == 4] == 0)
    _, stiffness = simulation.mesh_stiffness_curve("z3-z4")
    least = stiffness.reshape(80, -1).min(axis=1)
    assert set(np.flatnonzero(least < 0.99 * np.median(least))) == {4, 5, 52, 53}


def test_a_wheel_of_a_gearbox_is_processed(simulations: dict[str, mt.Simulation]) -> None:
    simulation = simulations["gearbox"]
    record = simulation.process("force_n.z3-z4", "z3")
    assert record.teeth == 48 and np.array_equal(record.difference, simulation.process_wheels("force_n.z3-z4")["z3"].difference)
    # The burst of the missing tooth is where the panel tints it: in the fifth pitch of z3.
    assert 4.0 < np.argmax(np.abs(record.envelope)) / record.envelope.size * 48 < 6.0
    with pytest.raises(ValueError, match="wheel = 'z5': must be one of z1, z2, z3, z4"):
        simulation.process(wheel="z5")


def test_the_panel_of_a_gearbox(simulations: dict[str, mt.Simulation]) -> None:
    titles = [axes.get_title() for axes in simulations["gearbox"].plot().axes]
    assert titles == ["Tooth 5 of wheel z3", "Mesh z1-z2", "Mesh z3-z4", "", "", "Average, z3 shaft", "Difference, z3 shaft"]


def test_what_only_a_gearbox_has(simulations: dict[str, mt.Simulation]) -> None:
    fields, deviations = simulations["gearbox"].fields, simulations["gearbox"].wheel_deviations()
    assert fields["speed_ratio"] == pytest.approx([1, -1 / 3, 1 / 5]) and "contact_ratio.z3-z4" in fields
    assert "z4_run_out_um" in deviations and len(deviations) == 12
    with pytest.raises(AttributeError, match="a gearbox has no signal 'vertical_g'; it has input_0_vertical_g, output_1_vertical_g"):
        _ = simulations["gearbox"].vertical_g
    with pytest.raises(AttributeError, match="a gearbox has no key 'pinion_teeth': scenario.sections has"):
        _ = GEARBOX.pinion_teeth
    assert GEARBOX.sampling_rate_hz == 2e4 and GEARBOX.brake_torque_nm == GEARBOX.sections["operation"]["brake_torque_nm"]


@pytest.mark.parametrize("form", ["helical", "gearbox"])
def test_a_trace_has_the_fields(form: str, simulations: dict[str, mt.Simulation]) -> None:
    trace = mt.trace(SCENARIOS[form])
    for name, value in simulations[form].fields.items():
        assert np.array_equal(trace[name], value), name
    if form == "gearbox":
        assert np.array_equal(trace["force_n.z1-z2"], simulations[form]["force_n.z1-z2"])


# What moves the wheels, in both forms.

SLOW: dict[str, Any] = {"module_mm": 3, "pinion_teeth": 17, "gear_teeth": 38, "face_width_mm": 15, "brake_torque_nm": 10}


def one_stage(speed_hz: float, *, pinion: dict[str, Any] | None = None, gear: dict[str, Any] | None = None, mesh: dict[str, Any] | None = None) -> mt.Scenario:
    """The pair's wheels on shafts of beams."""
    return mt.Gearbox(
        shafts=[
            {"name": "input", "length_mm": 200, "radius_mm": 10, "couples_to": "motor"},
            {"name": "output", "length_mm": 200, "radius_mm": 10, "couples_to": "brake"},
        ],
        wheels=[
            {"name": "z1", "shaft": "input", "at": 0.5, "teeth": 17, "face_width_mm": 15, **(pinion or {})},  # type: ignore[typeddict-item]
            {"name": "z2", "shaft": "output", "at": 0.5, "teeth": 38, "face_width_mm": 15, **(gear or {})},  # type: ignore[typeddict-item]
        ],
        meshes=[{"wheels": ["z1", "z2"], "module_mm": 3, **(mesh or {})}],  # type: ignore[typeddict-item]
        bearings=[{"shaft": shaft, "at": at} for shaft in ("input", "output") for at in (0.0, 1.0)],
        operation={"input_speed_hz": speed_hz, "brake_torque_nm": 10},
        solver={"sampling_rate_hz": 1e4, "duration_s": 38 / speed_hz},
    )


def line(signal: npt.NDArray[np.float64], turns: int) -> float:
    """Amplitude of what comes so many times in the whole signal."""
    return float(2 * np.abs(np.fft.rfft(signal)[turns]) / signal.size)


@pytest.mark.filterwarnings("ignore::meshtone.MeshtoneWarning")
@pytest.mark.parametrize(("wheel", "turns"), [("pinion", 38), ("gear", 17)])
def test_an_eccentric_wheel_of_a_gearbox_is_felt_once_a_revolution(wheel: str, turns: int) -> None:
    centred, eccentric = (mt.simulate(one_stage(5.0, **{wheel: {"eccentricity_mm": offset_mm}})) for offset_mm in (0.0, 0.02))
    # So slow that nothing vibrates: the wheels turn against one another by as much as the eccentric one's flank is off, 20 µm.
    error_um = eccentric["transmission_error_um.z1-z2"]
    assert line(error_um, turns) == pytest.approx(20.0, rel=0.02)
    assert line(error_um, 55 - turns) < 0.5 and line(centred["transmission_error_um.z1-z2"], turns) < 0.5


@pytest.mark.filterwarnings("ignore::meshtone.MeshtoneWarning")
def test_misaligned_shafts_of_a_gearbox_load_the_face_as_those_of_a_pair() -> None:
    straight, gearbox = (mt.simulate(one_stage(40.0, mesh={"misalignment_um": of_um}).copy(solver={"duration_s": 0.1})) for of_um in (0.0, 30.0))
    pair = mt.simulate(mt.Scenario(**SLOW, pinion_speed_hz=40, misalignment_um=30, sampling_rate_hz=1e4, duration_s=0.1))
    at_rest = [of.static_mesh(500).transmission_error_um for of in (gearbox, pair, straight)]
    # The nearer end touches 15 µm before the middle, and yields. The wheels tilt a little differently under the uneven load: on beams in
    # bearings, and in a rig.
    shift_um = np.mean(at_rest[0] - at_rest[2])
    assert -15.0 < shift_um < -4.0
    assert at_rest[0] == pytest.approx(at_rest[1], abs=0.01 * abs(shift_um))
