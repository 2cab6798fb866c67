"""Wheels with profile shift, as drawings state them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import PAIR

from meshtone import Scenario, simulate


def pair(**keys: Any) -> Scenario:
    """17 and 38 teeth of module 3."""
    return Scenario(**PAIR, **keys)


def test_shifted_pair() -> None:
    simulation = simulate(pair(pinion_profile_shift=0.3, gear_profile_shift=0.2))
    assert np.degrees(simulation.working_pressure_angle_rad) == pytest.approx(22.50252, abs=1e-5)
    assert simulation.centre_distance_mm == pytest.approx(83.9136, abs=5e-5)
    assert simulation.contact_ratio == pytest.approx(1.45981, abs=1e-5)
    tips_mm = [2 * simulation.pinion_radii_mm[1], 2 * simulation.gear_radii_mm[1]]
    assert tips_mm == pytest.approx([58.62719, 121.02719], abs=1e-5)
    # A shift leaves the base circle, and so the force.
    assert simulation.mesh_force_n.mean() == pytest.approx(10 / (0.057 * np.cos(np.radians(20))), rel=0.01)


def test_a_larger_distance_opens_backlash() -> None:
    near, far = simulate(pair()), simulate(pair(centre_distance_mm=82.8))
    assert near.normal_backlash_mm == pytest.approx(0.1275)
    assert far.normal_backlash_mm > near.normal_backlash_mm + 0.2
    assert far.contact_ratio < near.contact_ratio


def test_refused_with_the_number_that_does() -> None:
    with pytest.raises(ValueError, match="must be at least 0.0057"):
        pair(pinion_profile_shift=-0.1)
    with pytest.raises(ValueError, match="must be at least 82.5000 mm"):
        pair(centre_distance_mm=82.0)


def test_the_example_is_as_its_comments_say() -> None:
    path = Path(__file__).parents[2] / "examples" / "profile_shift.toml"
    simulation = simulate(Scenario.from_file(path))
    assert np.degrees(simulation.working_pressure_angle_rad) == pytest.approx(20.769, abs=5e-4)
    assert simulation.contact_ratio == pytest.approx(1.620, abs=5e-4)
    radii_mm = np.array([simulation.pinion_radii_mm, simulation.gear_radii_mm])
    assert 2 * radii_mm[:, 1] == pytest.approx([73.98, 136.98], abs=5e-3)
    assert 2 * radii_mm[:, 2] == pytest.approx([62.75, 125.75], abs=5e-3)
