"""What a plan draws about a rig that is not known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from test_like import CLASSES, MACHINE, made


@pytest.mark.parametrize(
    ("variation", "drawn", "fixed"),
    [
        ("known-rig", {"misalignment_um", "mesh_damping_ratio"}, {"path_gain_db", "base_hz", "support_base_hz"}),
        ("known-rig-unknown-path", {"misalignment_um", "path_gain_db", "path_strength"}, {"support_base_hz"}),
        ("unknown-rig", {"path_gain_db", "support_base_hz", "support_mass_kg", "bearing_stiffness_n_per_m", "iso_class"}, set()),
    ],
)
def test_variations_draw_what_is_not_known(tmp_path: Path, variation: str, drawn: set[str], fixed: set[str]) -> None:
    own = '[[vary]]\nkey = "operation.pinion_speed_hz"\nfixed = 33.0\n'
    keep = "[keep]\nchannels = []\n[split]\ntrain = 1.0\n"
    gears = made(tmp_path, f'variation = "{variation}"\n' + MACHINE + CLASSES + own + keep, records=8)
    assert drawn <= set(gears.columns) and not fixed & set(gears.columns)
    for name in drawn:
        assert len(set(gears.column(name).tolist())) > 1, name
    # A rule of the plan takes precedence.
    assert set(gears.column("pinion_speed_hz").tolist()) == {33.0}
    torque_nm = gears.column("brake_torque_nm")
    factor = 1.5 if variation == "unknown-rig" else 1.05
    assert (torque_nm >= 50.0 / factor).all() and (torque_nm <= 50.0 * factor).all() and np.ptp(torque_nm) > 0.0


def test_a_variation_needs_the_contact_model(tmp_path: Path) -> None:
    text = 'variation = "known-rig"\n' + MACHINE.replace("[scenario.gears]", '[scenario]\nmodel = "linear"\n[scenario.gears]')
    with pytest.raises(ValueError, match='is for the model "contact"'):
        made(tmp_path, text + CLASSES)
    with pytest.raises(ValueError, match="known-rig-unknown-path"):
        made(tmp_path, 'variation = "rig"\n' + MACHINE + CLASSES)
