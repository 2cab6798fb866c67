"""What several tests need."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest

import meshtone

matplotlib.use("agg")

ROOT = Path(__file__).parents[2]
PUBLISHED = ROOT / "crates" / "meshtone" / "tests" / "published"

PAIR: dict[str, Any] = {
    "module_mm": 3,
    "pinion_teeth": 17,
    "gear_teeth": 38,
    "face_width_mm": 15,
    "pinion_speed_hz": 40,
    "brake_torque_nm": 10,
}
"""The pair of the paper's rig with a broken tooth: all that a scenario requires."""

FRACTIONS: dict[str, float] = {"start": 0.2, "end": 0.8, "depth": 0.5}

FAULTS: dict[str, meshtone.Fault | None] = {
    "healthy_din0": None,
    "healthy_din7": None,
    "missing_din0": meshtone.MissingTooth(),
    "breakage_din7": meshtone.ToothBreakage(chip_height_mm=5, chip_width_mm=12, tip_loss_mm=3),
    "partial_din0": meshtone.PartialFace(width_mm=2, start=0.2, end=0.8, depth=0.5),
    "through_din0": meshtone.ThroughFace(start=0.2, end=0.8, depth=0.5),
    "through_circ_din7": meshtone.ThroughFace(circle=meshtone.PitCircle(57.5, 3.66, 2.5)),
    "destruction_din0": meshtone.ToothDestruction(start=3 / 14, end=13 / 14),
    "destruction_slope_din0": meshtone.ToothDestruction(start=0.2, slope_deg=22),
}


class Published:
    """A scenario of the published model with its outputs."""

    def __init__(self, name: str) -> None:
        self.name = name
        with np.load(PUBLISHED / f"{name}.npz") as fields:
            self.fields: dict[str, Any] = {key: fields[key] for key in fields.files}
        pair = PAIR
        if name.startswith("destruction"):
            other = {"pinion_teeth": 18, "gear_teeth": 35, "face_width_mm": 30, "pinion_speed_hz": 45, "brake_torque_nm": 15}
            pair = {**PAIR, **other}
        errors = {}
        if name.endswith("din7"):
            errors = {f"{wheel}_profile_errors_mm": self.fields[f"{wheel}_profile_errors_mm"] for wheel in ("pinion", "gear")}
        self.scenario = meshtone.Scenario(model="published", fault=FAULTS[name], **pair, **errors)


@pytest.fixture(params=sorted(FAULTS), scope="module")
def published(request: pytest.FixtureRequest) -> Published:
    """Each of the nine scenarios of the published model."""
    return Published(request.param)


@pytest.fixture(scope="session")
def broken() -> meshtone.Simulation:
    """A simulation of a broken tooth."""
    return meshtone.simulate(meshtone.examples.tooth_breakage())


@pytest.fixture
def control_c() -> Iterator[None]:
    """Control-C is a KeyboardInterrupt, also where Python was started with it ignored, as in the background of a script."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def control_c_ignored() -> Iterator[None]:
    """Control-C does nothing."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    yield
    signal.signal(signal.SIGINT, before)
