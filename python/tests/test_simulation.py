"""Simulations: signals, batches, cancellation."""

from __future__ import annotations

import pickle
import signal
import subprocess
import sys
import threading
import time
import warnings
from typing import Any

import numpy as np
import pytest

import meshtone
from meshtone import examples, simulate, simulate_many


def test_signals(broken: meshtone.Simulation) -> None:
    for name in meshtone.CHANNELS:
        values = getattr(broken, name)
        assert values.shape == (95608,)
        assert values.dtype == np.float64
        assert np.isfinite(values).all()
    # No copies: the same array each time.
    assert broken.vertical_g is broken.vertical_g
    assert np.allclose(np.diff(broken.time_s), 1 / broken.sampling_rate_hz)
    assert broken.sampling_rate_hz == 100640
    # Torque equilibrium: the mean mesh force is the brake's torque over the gear's base radius.
    base_radius_m = broken.gear_radii_mm[3] * 1e-3
    assert broken.mesh_force_n.mean() == pytest.approx(10 / base_radius_m, rel=0.01)


def test_matrices(broken: meshtone.Simulation) -> None:
    stiffness, mass, shapes = broken.stiffness_matrix_mean, broken.mass_diagonal, broken.mode_shapes
    assert stiffness.shape == shapes.shape == (17, 17)
    omega = 2 * np.pi * broken.natural_frequencies_hz
    residual = stiffness @ shapes - (mass[:, None] * shapes) * omega**2
    assert np.abs(residual).max() < 1e-6 * np.abs(stiffness @ shapes).max()
    assert np.allclose(shapes.T @ (mass[:, None] * shapes), np.eye(17), atol=1e-9)


def test_curves(broken: meshtone.Simulation) -> None:
    gear_rev, stiffness = broken.mesh_stiffness_curve()
    assert gear_rev.shape == stiffness.shape
    assert gear_rev[0] == 0 and gear_rev[-1] < 1
    assert np.array_equal(stiffness[::4], broken.mesh_stiffness_n_per_mm)
    x_mm, y_mm = broken.tooth_profile("pinion")
    assert x_mm.shape == y_mm.shape == (10000,)
    assert [x_mm[-1], y_mm[-1]] == pytest.approx(broken.pinion_tip_xy_mm)
    errors = broken.profile_errors_mm()
    assert errors is not None
    pinion, gear = errors
    assert pinion.shape == (100, 17) and gear.shape == (100, 38)
    with pytest.raises(ValueError, match="wheel = 'wheel': must be one of pinion, gear"):
        broken.tooth_profile("wheel")
    with pytest.raises(AttributeError, match="no field 'stiffness'"):
        _ = broken.stiffness  # type: ignore[attr-defined]


def test_healthy_has_no_errors_under_ideal_quality() -> None:
    ideal = simulate(examples.healthy().copy(din_grade=0, sampling_rate_hz=1e4))
    assert ideal.profile_errors_mm() is None


def test_process(broken: meshtone.Simulation) -> None:
    record = broken.process("vertical_g", "gear")
    assert record.revolutions == 17
    assert record.average.shape == record.difference.shape == record.envelope.shape == (5624,)
    assert np.allclose(record.regular + record.difference, record.average, atol=1e-9 * np.abs(record.average).max())
    difference = record.difference
    moment = np.mean((difference - difference.mean()) ** 4) / np.var(difference) ** 2
    assert record.indicators["difference_kurtosis"] == pytest.approx(moment, rel=1e-9)
    assert record.indicators["fm4"] == pytest.approx(moment, rel=1e-9)
    assert broken.process("vertical_g", "pinion").revolutions == 38
    wider = broken.process(sidebands=8)
    assert np.std(wider.difference) < np.std(record.difference)
    with pytest.raises(ValueError, match="channel = 'sideways_g'"):
        broken.process("sideways_g")
    with pytest.raises(ValueError, match="wheel = 'axle'"):
        broken.process(wheel="axle")


def test_many_are_the_same_as_one(broken: meshtone.Simulation) -> None:
    healthy = examples.healthy()
    scenarios = [broken.scenario, healthy, healthy.copy(seed=2), examples.missing_tooth()]
    reported: list[tuple[int, int]] = []
    results = simulate_many(scenarios, threads=2, progress=lambda done, of: reported.append((done, of)))
    assert reported[-1] == (4, 4)
    for scenario, result in zip(scenarios, results):
        assert result.scenario == scenario
        alone = simulate(scenario)
        assert result.sampling_rate_hz == alone.sampling_rate_hz
        assert result.vertical_g.dtype == np.float32
        assert np.array_equal(result.vertical_g, alone.vertical_g.astype(np.float32))
    first = results[0]
    ours, theirs = first.process().indicators, broken.process().indicators
    assert ours["difference_kurtosis"] == pytest.approx(theirs["difference_kurtosis"], rel=1e-5)
    with pytest.raises(ValueError, match="no channel 'axial_g' was kept"):
        first.process("axial_g")
    [forces] = simulate_many([healthy], channels=["mesh_force_n"])
    assert list(forces.channels) == ["mesh_force_n"]
    with pytest.raises(AttributeError, match="no channel 'vertical_g' was kept"):
        _ = forces.vertical_g


def test_many_keep_the_errors_in_their_places() -> None:
    healthy = examples.healthy().copy(sampling_rate_hz=1e4)
    # Valid as a scenario, but the circle misses the tooth.
    misses = healthy.copy(fault=meshtone.ThroughFace(circle=meshtone.PitCircle(10.0, 30.0, 0.5)))
    first, second, third = simulate_many([healthy, misses, healthy], on_error="return")
    assert isinstance(second, ValueError)
    assert "fault.circle" in str(second)
    assert isinstance(first, meshtone.Signals) and isinstance(third, meshtone.Signals)
    with pytest.raises(ValueError, match=r"fault\.circle") as alone:
        simulate(misses)
    assert str(alone.value) == str(second)
    # Unless asked for, the first error is that of all, and says whose it is.
    with pytest.raises(ValueError) as of_all:
        simulate_many([healthy, misses, misses])
    assert str(of_all.value) == f"scenarios[1]: {second}"
    reported: list[tuple[int, int]] = []
    with pytest.raises(ValueError, match=r"^scenarios\[0\]: "):
        simulate_many([misses, *[healthy] * 400], threads=1, progress=lambda done, of: reported.append((done, of)))
    assert reported[-1][0] < reported[-1][1] == 401
    with pytest.raises(ValueError, match="on_error = 'ignore': must be 'raise' or 'return'"):
        simulate_many([healthy], on_error="ignore")  # type: ignore[call-overload]


def test_what_is_not_a_scenario() -> None:
    name: Any = "healthy.toml"
    for call in (simulate, meshtone.trace, lambda scenario: simulate_many([scenario])):
        with pytest.raises(TypeError, match="a Scenario is needed, not 'healthy.toml'; Scenario.from_file"):
            call(name)
    with pytest.raises(TypeError, match="; simulate_many takes several"):
        simulate([examples.healthy()])  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="average_rate_hz = -1: must be more than 0"):
        meshtone.trace(examples.healthy(), average_rate_hz=-1)


def test_pickled_simulation_is_the_same(broken: meshtone.Simulation) -> None:
    pickled = pickle.dumps(broken)
    assert len(pickled) < 10_000
    again = pickle.loads(pickled)
    assert again.scenario == broken.scenario
    assert np.array_equal(again.vertical_g, broken.vertical_g)


def test_many_refuse() -> None:
    with pytest.raises(ValueError, match="'sideways': must be one of horizontal_g"):
        simulate_many([examples.healthy()], channels=["sideways"])
    with pytest.raises(ValueError, match="threads = 0"):
        simulate_many([examples.healthy()], threads=0)
    with pytest.raises(ValueError, match="threads = -1: must be at least 1"):
        simulate_many([examples.healthy()], threads=-1)
    with pytest.raises(TypeError, match="simulate takes one"):
        simulate_many(examples.healthy())  # type: ignore[call-overload]
    with pytest.raises(TypeError, match=r"channels = 'axial_g': .*\['axial_g'\]"):
        simulate_many([examples.healthy()], channels="axial_g")
    assert simulate_many([]) == []


def test_progress_that_raises_stops_the_rest() -> None:
    def stop(done: int, of: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        simulate_many((examples.healthy().copy(seed=seed) for seed in range(400)), progress=stop)


def press_control_c() -> None:
    main = threading.main_thread().ident
    assert main is not None
    signal.pthread_kill(main, signal.SIGINT)


@pytest.mark.usefixtures("control_c")
def test_control_c_stops() -> None:
    timer = threading.Timer(0.3, press_control_c)
    scenarios = [examples.healthy().copy(seed=seed) for seed in range(1000)]
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        simulate_many(scenarios)
    # All of them would take at least ten times as long on any machine.
    assert time.monotonic() - start < 10
    timer.join()


@pytest.mark.usefixtures("control_c_ignored")
def test_control_c_that_is_ignored_does_not_stop() -> None:
    pressed: list[int] = []

    def press(done: int, of: int) -> None:
        press_control_c()
        pressed.append(done)

    results = simulate_many([examples.healthy().copy(seed=seed) for seed in range(4)], progress=press)
    assert pressed
    assert all(isinstance(result, meshtone.Signals) for result in results)


def test_other_threads_run_meanwhile() -> None:
    counted = 0
    done = threading.Event()

    def count() -> None:
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    simulate_many([examples.healthy().copy(seed=seed) for seed in range(32)])
    done.set()
    thread.join()
    assert counted > 10


def test_damage_to_either_wheel() -> None:
    healthy = examples.healthy().copy(sampling_rate_hz=1e4, din_grade=0)
    chip = meshtone.ToothBreakage(chip_height_mm=4, chip_width_mm=9, tip_loss_mm=2, wheel="pinion", tooth=5)
    both = simulate(healthy.copy(faults=[chip, meshtone.MissingTooth(tooth=20)]))
    assert repr(both).startswith("<Simulation of 17/38 teeth, tooth-breakage of pinion tooth 5, missing-tooth of gear tooth 20: ")
    gear_rev, stiffness = both.mesh_stiffness_curve()
    _, sound = simulate(healthy).mesh_stiffness_curve()
    changed = gear_rev[np.abs(stiffness - sound) > 1e-9 * sound] * 38
    # The pinion's tooth 5 meets every 17 pitches, from the fourth on; the gear's tooth 20 after 19.
    turns = [(4, 6), (19, 21), (21, 23), (38, 38)]
    assert all(any(start <= pitch <= end for start, end in turns) for pitch in changed)
    assert all(((start <= changed) & (changed <= end)).any() for start, end in turns[:3])


def test_warnings_are_those_of_the_program() -> None:
    # A light load, under which `linear` pulls, and too long a step for the resonance of so slender teeth.
    scenario = meshtone.examples.healthy().copy(model="linear", pinion_teeth=14, brake_torque_nm=5, sampling_rate_hz=2e4)
    simulation = meshtone.simulate(scenario)
    before, *by_signals = simulation.warnings
    assert [before] == scenario.warnings and before.startswith("gears.pinion_teeth: ")
    [tension, step] = by_signals
    assert step.startswith("solver.sampling_rate_hz: ")
    assert tension.startswith(f"operation.brake_torque_nm: the mesh force is negative for {100 * simulation.tension_fraction:.1f} % of")
    assert simulation.tension_fraction == np.mean(simulation.mesh_force_n < 0)


def test_warnings_are_given_once_where_the_user_called() -> None:
    with warnings.catch_warnings(record=True) as reported:
        warnings.simplefilter("always")
        simulation = meshtone.simulate(examples.healthy().copy(pinion_teeth=14, sampling_rate_hz=2e4, settle_fraction=0.02))
        simulation.plot()
    of_meshtone = [warning for warning in reported if isinstance(warning.message, meshtone.MeshtoneWarning)]
    assert [str(warning.message) for warning in of_meshtone] == simulation.warnings
    assert [warning.message.code for warning in of_meshtone] == simulation.warning_codes  # type: ignore[union-attr]
    assert simulation.warning_codes[0] == "undercut"
    assert {warning.filename for warning in of_meshtone} == {__file__}
    assert pickle.loads(pickle.dumps(of_meshtone[0].message)).code == "undercut"


def test_many_simulations_warn_once_a_code() -> None:
    healthy = examples.healthy().copy(sampling_rate_hz=2e4)
    with pytest.warns(meshtone.MeshtoneWarning) as reported:
        made = meshtone.simulate_many([healthy, *(healthy.copy(pinion_teeth=14, seed=seed) for seed in range(3))])
    assert [str(warning.message).split(": ")[0] for warning in reported if warning.message.code == "undercut"] == [  # type: ignore[union-attr]
        "3 of 4 simulations, the first"
    ]
    codes = [result.warning_codes for result in made]
    assert ["undercut" in of_one for of_one in codes] == [False, True, True, True]
    alone = meshtone.simulate(healthy.copy(pinion_teeth=14, seed=0))
    # A batch repeats a part of what a simulation alone repeats at half the step.
    of_batch, of_one = ([warning for warning in of.warnings if "the step" not in warning] for of in (made[1], alone))
    assert of_batch == of_one


def test_signals_cannot_be_written_to(broken: meshtone.Simulation) -> None:
    kurtosis = broken.process().indicators["average_kurtosis"]
    for values in (broken.vertical_g, broken.mesh_force_n, broken.stiffness_matrix_mean):
        with pytest.raises(ValueError, match="read-only"):
            values *= 3
    assert broken.process().indicators["average_kurtosis"] == kurtosis


def test_a_target_rate_is_met() -> None:
    scenario = examples.healthy().copy(sampling_rate_hz=2e4)
    [own], [at_rate] = simulate_many([scenario]), simulate_many([scenario], target_rate_hz=1e4)
    assert at_rate.sampling_rate_hz == 1e4 and own.sampling_rate_hz > 1e4
    seconds = own.vertical_g.size / own.sampling_rate_hz
    assert at_rate.vertical_g.size == pytest.approx(seconds * 1e4, abs=1)
    assert at_rate.vertical_g.dtype == np.float32
    # Both begin with the samples in single precision.
    assert np.array_equal(meshtone.simulate(scenario).signals(1e4).vertical_g, at_rate.vertical_g)
    with pytest.raises(ValueError, match=r"own rate.*ShaftPhase.constant\(17.8947, 10000, x.size\), 38\)"):
        at_rate.process()
    with pytest.raises(AttributeError, match=r'signals.process\(\).indicators\["fm4"\]'):
        _ = own.fm4  # type: ignore[attr-defined]
    for refused in (0, -1, float("nan"), float("inf")):
        with pytest.raises(ValueError, match=f"target_rate_hz = {refused}: must be more than 0, and finite"):
            simulate_many([scenario], target_rate_hz=refused)
        with pytest.raises(ValueError, match=f"target_rate_hz = {refused}: must be more than 0, and finite"):
            own.at_rate(refused)
    with pytest.raises(TypeError, match="target_rate_hz = '10 kHz': must be a number"):
        own.at_rate("10 kHz")  # type: ignore[arg-type]


def test_a_rate_below_the_mesh_is_warned_of() -> None:
    # 17 teeth at 40 Hz: 680 Hz.
    scenario = examples.healthy().copy(sampling_rate_hz=2e4)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        [own] = simulate_many([scenario], target_rate_hz=1400)
    with pytest.warns(meshtone.MeshtoneWarning, match=r"target_rate_hz = 1360: .* the mesh, whose frequency of 680 Hz is not below half"):
        own = simulate(scenario).signals(1360)
    assert own.sampling_rate_hz == 1360
    fast = scenario.copy(pinion_speed_hz=50)
    with pytest.warns(meshtone.MeshtoneWarning, match=r"frequency of 1 of 2 scenarios, the first of 850 Hz is not below half"):
        simulate_many([scenario, fast], target_rate_hz=1500)


def test_a_memory_limit_that_is_refused() -> None:
    for limit_bytes in (0, -1):
        with pytest.raises(ValueError, match=f"limit_bytes = {limit_bytes}: must be at least 1"):
            meshtone.set_memory_limit(limit_bytes)
    with pytest.raises(TypeError, match="limit_bytes = '1 GB': must be a whole number"):
        meshtone.set_memory_limit("1 GB")  # type: ignore[arg-type]
    for large_bytes in (8e9, 1e30):
        meshtone.set_memory_limit(large_bytes)  # type: ignore[arg-type]
    meshtone.set_memory_limit(None)


@pytest.mark.parametrize(
    ("missing", "extra", "use"),
    [
        ("matplotlib", "plot", "meshtone.simulate(meshtone.examples.healthy().copy(sampling_rate_hz=1e4)).plot_signal()"),
        ("pyarrow", "datasets", "meshtone.load_dataset('gears')"),
        ("sklearn", "sklearn", "import meshtone.sklearn"),
        ("distributed", "dask", "from meshtone import dask; dask.generate('plan.toml', 'gears', None)"),
    ],
)
def test_what_is_not_installed_is_named_with_its_extra(missing: str, extra: str, use: str) -> None:
    program = f"import sys; sys.modules['{missing}'] = None\nimport meshtone\n{use}"
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", program], capture_output=True, text=True, check=False)
    assert f"ModuleNotFoundError: {missing} is not installed: pip install 'meshtone[{extra}]'" in done.stderr


def test_a_batch_says_once_what_it_steps_alone() -> None:
    healthy = examples.healthy().copy(sampling_rate_hz=2e4)
    crowned = healthy.copy(lead_crowning_um=5.0)
    with pytest.warns(meshtone.MeshtoneWarning, match="2 of 3 simulations were stepped alone.*slices") as caught:
        results = simulate_many([crowned, healthy, crowned.copy(seed=2)])
    told = [warning.message for warning in caught if isinstance(warning.message, meshtone.MeshtoneWarning)]
    assert [warning.code for warning in told] == ["stepped-alone"]
    # It is no doubt about the signals.
    assert [result.warning_codes for result in results] == [[], [], []]
