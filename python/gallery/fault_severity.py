"""What every kind of damage shows at three severities.

A row a kind, on tooth 1 of the gear, and the last two on tooth 1 of the pinion, of wheels that are ideal but for the damage. Left the difference
signal over a revolution of the damaged wheel, whose tooth enters contact at 0; right the spectrum of its envelope over the orders of that
wheel's shaft, and dotted that of the most severe damage in the average over the other shaft. Mind the scales: each row has its own. The
table that is printed has the indicators of the same damage on wheels of DIN grade 5.
"""

import sys
from pathlib import Path
from typing import Literal

import matplotlib.pyplot as plt
import numpy as np

import meshtone as mt

Wheel = Literal["gear", "pinion"]
SEVERITIES = (0.2, 0.5, 0.9)
KINDS = {
    "Wear": mt.Wear,
    "Root crack": mt.RootCrack,
    "Pits": mt.Pits,
    "Pit over part of the face": mt.PartialFace,
    "Tooth breakage": mt.ToothBreakage,
    "Tooth destruction": mt.ToothDestruction,
    "Pit over the whole face": mt.ThroughFace,
    "Missing tooth": mt.MissingTooth,
}
OTHER: dict[Wheel, Wheel] = {"gear": "pinion", "pinion": "gear"}
INDICATORS = {"rms (g)": "difference_rms", "kurtosis": "difference_kurtosis", "envelope's kurtosis": "envelope_kurtosis"}
ORDERS = 40

ideal, graded = (mt.examples.healthy().copy(din_grade=grade) for grade in (0, 5))
rows: list[tuple[str, Wheel, type[mt.Fault]]] = [(name, "gear", kind) for name, kind in KINDS.items()]
rows += [(name, "pinion", KINDS[name]) for name in ("Root crack", "Pit over the whole face")]
shades = plt.get_cmap("viridis")(np.linspace(0.8, 0.1, len(SEVERITIES)))
sound = {wheel: mt.simulate(graded).process("vertical_g", wheel) for wheel in OTHER}


def line_of_table(wheel: Wheel, name: str, severity: float, record: mt.Record) -> str:
    """The indicators; NA4 is that of a record after one of the sound wheels."""
    values = [record.indicators[key] for key in INDICATORS.values()]
    values.append(mt.signal.na4([sound[wheel].residual, record.residual])[1])
    return f"| {name} | {wheel} | {severity:g} | " + " | ".join(f"{value:#.3g}" for value in values) + " |"


table = ["| damage | of the | severity | " + " | ".join(INDICATORS) + " | NA4 |", "|---|---|---|" + "---|" * (len(INDICATORS) + 1)]
table += [line_of_table(wheel, "none", 0, record) for wheel, record in sound.items()]
figure, grid = plt.subplots(len(rows), 2, figsize=(12, 2.6 * len(rows)), width_ratios=(3, 2), layout="constrained")
for (signal, spectrum), (name, wheel, kind) in zip(grid, rows):
    severities = (1.0,) if kind is mt.MissingTooth else SEVERITIES
    most = 0.0
    # The most severe one behind the others.
    for severity, shade in reversed(list(zip(severities, shades[-len(severities) :]))):
        fault = kind(severity=severity, wheel=wheel, tooth=1)
        simulation = mt.simulate(ideal.copy(fault=fault))
        record = simulation.process("vertical_g", wheel)
        pitches = (np.arange(record.difference.size) / record.difference.size - 0.25) * record.teeth
        turned = np.roll(record.difference, record.difference.size // 4)
        signal.plot(pitches, turned, color=shade, linewidth=0.8, label=f"severity {severity:g}")
        spectrum.semilogy(record.envelope_spectrum[: ORDERS + 1], color=shade, linewidth=1.2, marker=".", markersize=5)
        most = max(most, record.envelope_spectrum[1 : ORDERS + 1].max())
        if severity == severities[-1]:
            faded = simulation.process("vertical_g", OTHER[wheel]).envelope_spectrum[: ORDERS + 1]
            # What is less than can be seen is drawn at the lower edge.
            shown = np.maximum(faded, 1.5e-4 * most)
            label = f"in the average over the {OTHER[wheel]}'s shaft, at most"
            spectrum.semilogy(shown, color=shade, linestyle=":", linewidth=1.2, label=label)
    for severity in severities:
        damaged = mt.simulate(graded.copy(fault=kind(severity=severity, wheel=wheel, tooth=1)))
        table.append(line_of_table(wheel, name.lower(), severity, damaged.process("vertical_g", wheel)))
    signal.set(title=f"{name}, {wheel}", xlim=(pitches[0], pitches[-1]), ylabel="Difference signal (g)")
    signal.set_xlabel(f"Angle of the {wheel} (tooth pitches)")
    spectrum.set(title=f"Envelope over the {wheel}'s revolution", xlim=(0.5, ORDERS), ylim=(1e-4 * most, 10 * most), ylabel="Amplitude (g)")
    spectrum.set_xlabel(f"Order of the {wheel}'s shaft")
    signal.legend(frameon=False, fontsize=9, loc="upper right")
    spectrum.legend(frameon=False, fontsize=9, loc="upper right")
for ax in grid.flat:
    ax.grid(alpha=0.3)
figure.savefig(Path(*sys.argv[1:2], "python_fault_severity.png"), dpi=100)
print("\n".join(table))
