"""Recordings as records of a data set."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.dataset
import pytest
from meshtone import Dataset, Scenario, gearbox_template, generate_dataset, simulate
from meshtone.signal import ShaftPhase, process_channel

MACHINE = """
[scenario.gears]
module_mm = 3.0
pinion_teeth = 17
gear_teeth = 38
face_width_mm = 15.0
[scenario.operation]
pinion_speed_hz = 40.0
brake_torque_nm = 50.0
[scenario.quality]
iso_class = 5
[scenario.solver]
sampling_rate_hz = 50e3
settle_tolerance = 1e-3
"""

CLASSES = """
[[class]]
label = "healthy"
[[class]]
label = "missing-tooth"
fault = { kind = "missing-tooth" }
"""

RIG = Scenario(module_mm=3.0, pinion_teeth=17, gear_teeth=38, face_width_mm=15.0, pinion_speed_hz=40.0, brake_torque_nm=50.0)


def made(folder: Path, text: str, *, records: int = 4) -> Dataset:
    plan = folder / "plan.toml"
    plan.write_text(f"records = {records}\nunits = 2\n{text}", "utf-8")
    return generate_dataset(plan, folder / f"set-{len(list(folder.iterdir()))}")


def indicators(dataset: Dataset) -> list[str]:
    prefixes = ("average_", "regular_", "residual_", "difference_", "envelope_", "mesh_harmonic_")
    present = [name for name in dataset.scalar_columns if name not in dataset.empty_columns]
    return [name for name in present if name.startswith(prefixes)] + ["fm0", "fm4", "m6a", "energy_ratio"]


@pytest.fixture(scope="module")
def gears(tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    rules = '[[vary]]\nkey = "operation.pinion_speed_hz"\nuniform = [30.0, 40.0]\n[[vary]]\nkey = "gears.face_width_mm"\nuniform = [14.0, 16.0]\n'
    keep = '[keep]\nchannels = ["vertical_g"]\n[split]\ntrain = 1.0\n'
    return made(tmp_path_factory.mktemp("gears"), MACHINE + CLASSES + rules + keep)


def test_a_record_that_is_recorded_has_its_own_columns(gears: Dataset) -> None:
    """Its raw channel passes the anti-aliasing filter a second time, which changes the band beyond 0.8 of half the rate alone: 0.7 % were seen."""
    columns = indicators(gears)
    for number in range(len(gears)):
        record = gears[number]
        phase = ShaftPhase.constant(record["pinion_speed_hz"], record["sampling_rate_hz"], record["vertical_g"].size)
        like = gears.like(record["vertical_g"], phase, RIG, record["sampling_rate_hz"])
        assert len(like) == 1 and like.columns == gears.columns
        known = like[0]
        assert (known["gear_teeth"], known["face_width_mm"], known["label"], known["fault_kind"]) == (38, 15.0, None, None)
        assert known["pinion_speed_hz"] == pytest.approx(record["pinion_speed_hz"], rel=1e-9)
        of_record = np.array([record[name] for name in columns])
        np.testing.assert_allclose(like.matrix(columns)[0], of_record, rtol=0.01, atol=1e-4)
        np.testing.assert_allclose(known["average_g"], record["average_g"], atol=0.005 * np.ptp(record["average_g"]))


def test_a_longer_recording_at_another_rate_has_several_windows(gears: Dataset) -> None:
    simulation = simulate(RIG.copy(sampling_rate_hz=50e3, duration_s=3.0, settle_tolerance=1e-3))
    signal, rate_hz = simulation.vertical_g, simulation.sampling_rate_hz
    phase = ShaftPhase.constant(40.0, rate_hz, signal.size)
    like = gears.like(signal, phase, RIG, rate_hz)
    # A record is 38 revolutions of the pinion; the first begins with the phase.
    assert len(like) == 3 and like.column("record").tolist() == [0, 1, 2]
    own = process_channel(signal, phase.of_mate(17, 38)[: int(rate_hz)], 38)
    assert like.column("mesh_harmonic_1_g")[0] == pytest.approx(own.indicators["mesh_harmonic_1"], rel=0.02)
    short = {"vertical_g": signal[: int(1.4 * rate_hz)]}
    halves = gears.like([{"vertical_g": signal}, short], [phase, phase[: int(1.4 * rate_hz)]], RIG, rate_hz)
    assert halves.column("unit").tolist() == [0, 0, 0, 1]
    of_gear = gears.like(signal, phase.of_mate(17, 38), RIG, rate_hz, shaft="gear")
    np.testing.assert_allclose(of_gear.matrix(["average_rms_g"]), like.matrix(["average_rms_g"]), rtol=1e-3)
    # As a network takes it.
    first = like.filter(pyarrow.dataset.field("record") < 2)
    X, y = first.arrays(["average_g"], points=256)
    assert X.shape == (2, 1, 256) and set(y) == {None}
    np.testing.assert_array_equal(first.matrix(["average_rms_g"]), like.matrix(["average_rms_g"])[:2])
    with pytest.raises(ValueError, match="belong to no split"):
        like.split("train")


def test_what_does_not_fit_is_refused_in_words(gears: Dataset) -> None:
    signal = np.sin(np.arange(100_000) / 7.0)
    phase = ShaftPhase.constant(40.0, 50e3, signal.size)
    cases: list[tuple[Any, str]] = [
        ((signal, phase, RIG, 20e3), "below the 25000 Hz of the data set"),
        (({"axial": signal}, phase, RIG, 50e3), "no channel \"axial\", but vertical_g"),
        ((signal[:30_000], phase[:30_000], RIG, 50e3), "revolutions of the gear"),
        ((signal[:90_000], phase, RIG, 50e3), "its phase is known up to sample 100000"),
        (([signal], [phase, phase], RIG, 50e3), "1 recordings, but 2 phases"),
    ]
    for arguments, words in cases:
        with pytest.raises(ValueError, match=words):
            gears.like(*arguments)
    with pytest.raises(ValueError, match="no shaft \"output\", but pinion, gear"):
        gears.like(signal, phase, RIG, 50e3, shaft="output")
    gearbox = Scenario.from_toml(gearbox_template())
    with pytest.raises(ValueError, match="no wheel \"gear\", which the data set averages"):
        gears.like(signal, phase, gearbox, 50e3)
    with pytest.raises(ValueError, match="no step"):
        phase[::2]


def test_over_the_angle_and_by_a_transformer(tmp_path: Path) -> None:
    from meshtone.sklearn import DatasetTransformer

    keep = '[keep]\nchannels = ["vertical_g"]\npoints_per_revolution = 512\nrevolutions = 4\nwheel = ["gear", "pinion"]\n[split]\ntrain = 1.0\n'
    gears = made(tmp_path, MACHINE + CLASSES + keep)
    draws = np.random.default_rng(1)
    time_s = np.arange(60_000) / 50e3
    records = np.cos(2 * np.pi * 680.0 * time_s) + 0.1 * draws.standard_normal((3, time_s.size))
    phase = ShaftPhase.constant(40.0, 50e3, time_s.size)
    like = gears.like(list(records), [phase] * 3, RIG, 50e3)
    # 1.2 s are 21 revolutions of the gear.
    assert len(like) == 15 and like.arrays(["vertical_g"])[0].shape == (15, 1, 2048)
    columns = ["gear_mesh_harmonic_1_g", "pinion_mesh_harmonic_1_g"]
    assert np.allclose(like.matrix(columns), 1.0, rtol=0.02)
    transformer = DatasetTransformer(gears, columns, RIG, sampling_rate_hz=50e3, shaft_hz=40.0)
    rows = transformer.fit_transform(records)
    assert rows.shape == (3, 2) and list(transformer.get_feature_names_out()) == columns
    np.testing.assert_allclose(rows[1], like.matrix(columns)[5:10].mean(axis=0))
    with pytest.raises(ValueError, match="no column 'fm5'"):
        DatasetTransformer(gears, ["fm5"], RIG, sampling_rate_hz=50e3, shaft_hz=40.0).fit(records)


def test_a_recording_of_a_gearbox(tmp_path: Path) -> None:
    from meshtone import _core

    gearbox = Scenario.from_toml(gearbox_template())
    (tmp_path / "machine.toml").write_text(gearbox_template(), "utf-8")
    text = 'scenario = "machine.toml"\n[[class]]\nlabel = "healthy"\n[keep]\nchannels = []\nduration_s = 0.6\n[split]\ntrain = 1.0\n'
    gears = made(tmp_path, text, records=2)
    simulation = simulate(gearbox)
    channel = next(name for name in simulation.channels if name.endswith("vertical_g"))
    signal, rate_hz = simulation[channel], simulation.sampling_rate_hz
    phase = ShaftPhase._wrap(_core.ShaftPhase.of_simulated(gearbox._native, simulation.start_s, signal.size))
    like = gears.like(signal, phase, gearbox, rate_hz)
    assert len(like) == 1
    assert like.column("z3_speed_hz")[0] == pytest.approx(gears.column("z3_speed_hz")[0], rel=1e-3)
    assert np.isfinite(like.matrix(["z1_fm4", "z4_mesh_harmonic_1_g", "z2_difference_octave_1_kurtosis"])).all()
