"""What each fault does to the gear's difference signal.

One pair of wheels six times: healthy, and with each kind of damage on the first tooth, over a revolution of the gear. The damaged
tooth enters contact at 0; the pair rings on after it. In blue the healthy pair's signal: what the deviations excite. Mind the
scales: each row has its own.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import meshtone as mt
from meshtone.plotting import BLUE, ORANGE

healthy = mt.examples.healthy().copy(din_grade=5)
faults: dict[str, mt.Fault | None] = {
    "Healthy": None,
    "Pit over part of the face": mt.PartialFace(width_mm=13, start=0.1, end=0.9, depth=0.5),
    "Tooth destruction": mt.ToothDestruction(start=0.5, end=0.95),
    "Tooth breakage": mt.ToothBreakage(chip_height_mm=5, chip_width_mm=12, tip_loss_mm=3),
    "Pit over the whole face": mt.ThroughFace(start=0.2, end=0.8, depth=0.5),
    "Missing tooth": mt.MissingTooth(),
}

figure, grid = plt.subplots(2, 3, figsize=(11, 5.6), sharex=True, sharey="row", layout="constrained")
unbroken = mt.simulate(healthy).process().difference
for ax, (name, fault) in zip(grid.flat, faults.items()):
    record = mt.simulate(healthy.copy(fault=fault)).process("vertical_g", "gear")
    # A quarter of the revolution is shown before the damaged tooth.
    turned = record.difference.size // 4
    pitches = (np.arange(record.difference.size) - turned) / record.difference.size * record.teeth
    if fault is not None:
        ax.plot(pitches, np.roll(record.difference, turned), color=ORANGE, linewidth=0.7, label="damaged")
    ax.plot(pitches, np.roll(unbroken, turned), color=BLUE, linewidth=0.7, label="healthy")
    rms_g, kurtosis = record.indicators["difference_rms"], record.indicators["difference_kurtosis"]
    ax.set_title(f"{name}\nrms {rms_g:.1f} g, kurtosis {kurtosis:.0f}", fontsize=11)
    ax.set_xlim(pitches[0], pitches[-1])
    ax.grid(alpha=0.3)
grid[0, 1].legend(frameon=False, fontsize=9, loc="upper right")
for ax in grid[-1]:
    ax.set_xlabel("Angle of the gear (tooth pitches)")
for ax in grid[:, 0]:
    ax.set_ylabel("Vertical difference signal (g)")
figure.savefig(Path(*sys.argv[1:2], "python_faults.png"), dpi=100)
