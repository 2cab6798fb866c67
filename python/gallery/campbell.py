"""A speed sweep as a Campbell diagram, of ideal teeth and of real ones.

Simulations at constant speeds from 10 to 60 rev/s: each column is the spectrum of the vertical acceleration at one speed. Ideal
teeth excite the harmonics of the mesh and nothing else (1× is the mesh frequency); they are strong where they cross a natural
frequency. The deviations of DIN grade 7 excite every order of both shafts, and the natural frequencies stand out as bands.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm

import meshtone as mt
from meshtone.plotting import GREY, ORANGE

LIMIT_HZ, BAND_HZ = 5000.0, 50.0
speeds_hz = np.linspace(10, 60, 101)
centres_hz = np.arange(BAND_HZ / 2, LIMIT_HZ, BAND_HZ)
healthy = mt.examples.healthy()
natural_hz = mt.simulate(healthy).natural_frequencies_hz

figure, axes = plt.subplots(1, 2, figsize=(10, 5), sharey=True, layout="constrained")
for ax, din_grade, title in zip(axes, (0, 7), ("Ideal teeth", "Teeth of DIN grade 7")):
    sweep = [healthy.copy(pinion_speed_hz=speed_hz, din_grade=din_grade) for speed_hz in speeds_hz]
    levels_g = np.full((centres_hz.size, speeds_hz.size), 1e-9)
    for column, result in zip(levels_g.T, mt.simulate_many(sweep, channels=["vertical_g"])):
        amplitude_g = 2 * np.abs(np.fft.rfft(result.vertical_g)) / result.vertical_g.size
        frequency_hz = np.fft.rfftfreq(result.vertical_g.size, 1 / result.sampling_rate_hz)
        shown = (frequency_hz > 0) & (frequency_hz < LIMIT_HZ)
        # The spectra have lines of their own: the strongest in each band is shown.
        np.maximum.at(column, (frequency_hz[shown] / BAND_HZ).astype(int), amplitude_g[shown])
    image = ax.pcolormesh(speeds_hz, centres_hz, levels_g, norm=LogNorm(1e-3, 1), cmap="Blues", shading="nearest")
    for harmonic in range(1, 9):
        mesh_hz = harmonic * healthy.pinion_teeth * speeds_hz
        ax.plot(speeds_hz, mesh_hz, color=GREY, linewidth=0.7, linestyle=(0, (1, 4)))
        if din_grade == 0 and harmonic < 7:
            last = np.flatnonzero(mesh_hz < 0.93 * LIMIT_HZ)[-1]
            ax.text(speeds_hz[last] - 1, mesh_hz[last] + 40, f"{harmonic}×", ha="right", fontsize=9)
    ax.hlines(natural_hz, 10, 60, color=ORANGE, linewidth=0.8, linestyle="--")
    ax.set(title=title, xlabel="Pinion speed (rev/s)", xlim=(10, 60), ylim=(0, LIMIT_HZ))
axes[0].set_ylabel("Frequency (Hz)")
marks = axes[1].secondary_yaxis("right")
# Some lie so near each other that one mark does for both.
apart_hz = natural_hz[(natural_hz < LIMIT_HZ) & (np.diff(natural_hz, prepend=-1000) > 150)]
marks.set_yticks(apart_hz, [f"{mark_hz:.0f}" for mark_hz in apart_hz])
marks.set_ylabel("Natural frequencies (Hz)")
figure.colorbar(image, label="Vertical acceleration, amplitude (g)", extend="both")
figure.savefig(Path(*sys.argv[1:2], "python_campbell.png"), dpi=100)
