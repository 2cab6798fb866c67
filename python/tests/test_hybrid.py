"""The hybrid stage."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

from meshtone import examples, hybrid

TUNED = ROOT / "examples" / "experiments" / "breakage.toml"


def test_modifications() -> None:
    cycle = np.zeros(1000)
    cycle[480:520] = 1.0
    wide = hybrid.change_duration(cycle, 0.5, 0.5)
    assert wide.sum() == pytest.approx(80, abs=3)
    healthy = np.sin(np.arange(1000.0))
    mixed = hybrid.change_fault_to_harmonics_ratio(cycle, healthy, 1.7)
    assert np.allclose(mixed, 1.7 * cycle - 0.7 * healthy)
    noisy = [hybrid.add_noise(cycle, 0.5, 2.0, seed=3, draw=draw) for draw in (0, 0, 1)]
    assert np.array_equal(noisy[0], noisy[1]) and not np.array_equal(noisy[0], noisy[2])
    with pytest.raises(ValueError, match="width_ratio"):
        hybrid.change_duration(cycle, 0.0, 0.5)
    with pytest.raises(ValueError, match="noise_level"):
        hybrid.add_noise(cycle, -1.0, 2.0)


def test_tune_and_enhance(tmp_path: Path) -> None:
    # The three parameters alone: the keys take most of the time.
    text = TUNED.read_text(encoding="utf-8")
    folder = TUNED.parent
    alone = tmp_path / "breakage.toml"
    kept, skip = [], False
    for line in text.splitlines():
        if line.startswith("["):
            skip = line.startswith("[[tune.key]]")
        if not skip:
            kept.append(line)
    for name in folder.iterdir():
        if name.name != TUNED.name:
            (tmp_path / name.name).symlink_to(name)
    alone.write_text("\n".join(kept) + "\n", encoding="utf-8")
    reported: list[tuple[int, int]] = []
    tuning = hybrid.tune(alone, progress=lambda done, of: reported.append((done, of)))
    assert reported[-1][0] == reported[-1][1] > 0
    assert set(tuning.parameters) >= {"width_ratio", "fault_to_harmonics_ratio", "noise_level"}
    assert tuning.error["enhanced"] < 0.25 < tuning.error["original"]
    tuned = tmp_path / "tuned.toml"
    tuning.save(tuned)
    signals = hybrid.enhance(examples.tooth_breakage(), tuned, draws=3)
    assert signals.relative_difference.shape[0] == 3 and signals.label == "tooth-breakage"
    assert not np.array_equal(signals.relative_difference[0], signals.relative_difference[1])
    again = hybrid.enhance(examples.tooth_breakage(), tuned, draws=3)
    assert np.array_equal(signals.relative_difference, again.relative_difference)
    with pytest.raises(FileNotFoundError):
        hybrid.enhance(examples.healthy(), tmp_path / "absent.toml")
    with pytest.raises(FileNotFoundError):
        hybrid.tune(tmp_path / "absent.toml")
    wrong = tmp_path / "wrong.toml"
    text = alone.read_text(encoding="utf-8")
    wrong.write_text(text.replace("[tune]", "[tun]", 1) + "\nunknown = 1\n", encoding="utf-8")
    with pytest.raises(ValueError, match="wrong.toml"):
        hybrid.tune(wrong)
