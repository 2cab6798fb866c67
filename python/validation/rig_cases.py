"""What scripts about the paper's three rigs share: the rigs with damage, and what was measured on them (Figure 6 of arXiv:2410.05073)."""

from __future__ import annotations

import tomllib  # type: ignore[import-not-found, unused-ignore]
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import meshtone as mt

FOLDER = Path("examples", "experiments")
RIGS = ("breakage", "pitting", "destruction")
INDICATORS = ("rms", "kurtosis")

Values = npt.NDArray[np.float64]


def experiment(name: str) -> tuple[dict[str, Any], str]:
    """An experiment's file, and the text of its rig's scenario."""
    stated = tomllib.loads((FOLDER / f"{name}_contact.toml").read_text())
    return stated, (FOLDER / stated["scenario"]).read_text()


def rig_with(rig: str, fault: Any, changes: dict[str, Any] | None = None) -> mt.Scenario:
    """The rig's scenario with a fault, and with other numbers under dotted keys."""

    def inline(value: Any) -> str:
        if isinstance(value, dict):
            return "{ " + ", ".join(f"{key} = {inline(inner)}" for key, inner in value.items()) + " }"
        if isinstance(value, list):
            return "[" + ", ".join(map(inline, value)) + "]"
        if isinstance(value, bool):
            return str(value).lower()
        return f'"{value}"' if isinstance(value, str) else repr(value)

    table = tomllib.loads(rig)
    for key, value in (changes or {}).items():
        *sections, last = key.split(".")
        place = table
        for section in sections:
            place = place.setdefault(section, {})
        place[last] = value
    if fault is not None:
        table["fault"] = fault
    return mt.Scenario.from_toml("".join(f"{key} = {inline(value)}\n" for key, value in table.items()))


def indicators_of(difference: Values) -> tuple[float, float]:
    """log10 of a difference signal's rms, in its unit, and of its kurtosis."""
    kurtosis = ((difference - difference.mean()) ** 4).mean() / difference.var() ** 2
    return float(np.log10(difference.std())), float(np.log10(kurtosis))


def difference_of(scenario: mt.Scenario, signals: mt.Signals, noise: Values | None = None) -> Values:
    """The gear's difference signal of the vertical acceleration, as the rigs' recordings were processed."""
    gear_hz = scenario.pinion_speed_hz * scenario.pinion_teeth / scenario.gear_teeth
    vertical = np.tile(signals.vertical_g.astype(float), 2)
    if noise is not None:
        vertical = vertical + noise
    phase = mt.ShaftPhase.constant(gear_hz, signals.sampling_rate_hz, len(vertical))
    return np.asarray(mt.process_channel(vertical, phase, scenario.gear_teeth).difference, dtype=float)


def measured(name: str) -> list[list[Values]]:
    """log10 of the measured records' indicators, by case and indicator; a record's two cannot be paired.

    The file has them sorted: they are shuffled, so that every other one is not its neighbours' mean.
    """
    rows = [line.split(",") for line in (FOLDER / "fig6_indicators.csv").read_text().splitlines()[1:] if not line.startswith("#")]
    of_rig = [row for row in rows if row[0] == name and row[2] == "measured"]
    count = 1 + max(int(row[3]) for row in of_rig)
    draw = np.random.default_rng(7)
    return [
        [draw.permutation([float(row[4]) for row in of_rig if row[1] == indicator and int(row[3]) == case]) for indicator in INDICATORS]
        for case in range(count)
    ]
