"""What a plan draws about a rig that is not known, and the noise of a healthy machine."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from meshtone.signal import ShaftPhase
from test_like import CLASSES, MACHINE, RIG, made


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


def test_the_background_of_a_healthy_machine_is_the_noise(tmp_path: Path) -> None:
    draws = np.random.default_rng(2)
    time_s = np.arange(400_000) / 50e3
    # Noise of a band from 1 to 2 kHz under mesh tones.
    lines = np.fft.rfft(draws.standard_normal(time_s.size))
    frequency_hz = np.fft.rfftfreq(time_s.size, 1 / 50e3)
    lines[(frequency_hz < 1e3) | (frequency_hz > 2e3)] = 0.0
    noise = np.fft.irfft(lines, time_s.size)
    tones = sum(np.cos(2 * np.pi * 680.0 * h * time_s) for h in range(1, 6))
    np.savez(tmp_path / "healthy.npz", bearing=noise + tones, sampling_rate_hz=50e3)
    rules = '[[vary]]\nkey = "noise.snr_db"\nfixed = 0.0\n'
    keep = '[keep]\nchannels = ["vertical_g"]\n[split]\ntrain = 1.0\n'
    text = MACHINE + CLASSES + rules + keep
    quiet = made(tmp_path, text.replace("fixed = 0.0", "fixed = 300.0"))
    loud = made(tmp_path, 'background = "healthy.npz"\n' + text)
    for before, after in zip(quiet.signals("vertical_g"), loud.signals("vertical_g"), strict=True):
        added = np.asarray(after - before, dtype=float)
        assert np.std(added) == pytest.approx(np.std(before), rel=0.1)
        power = np.abs(np.fft.rfft(added * np.hanning(added.size))) ** 2
        at_hz = np.fft.rfftfreq(added.size, 1 / 25e3)
        assert power[(at_hz > 950) & (at_hz < 2050)].sum() > 0.9 * power.sum()
    pieces = [after - before for before, after in zip(quiet.signals("vertical_g"), loud.signals("vertical_g"), strict=True)]
    assert abs(np.corrcoef(pieces[0][:10_000], pieces[1][:10_000])[0, 1]) < 0.5
    # The copy of the plan beside the data has the noise with it.
    assert (loud.path / "background.csv").exists()
    rate_hz = loud[0]["sampling_rate_hz"]
    phase = ShaftPhase.constant(40.0, rate_hz, loud[0]["vertical_g"].size)
    assert len(loud.like(loud[0]["vertical_g"], phase, RIG, rate_hz)) == 1
    with pytest.raises(ValueError, match="background.*has no level"):
        made(tmp_path, 'background = "healthy.npz"\n' + MACHINE + CLASSES + keep)
    with pytest.raises(ValueError, match="no-such.csv"):
        made(tmp_path, 'background = "no-such.csv"\n' + text)
