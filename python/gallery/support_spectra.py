"""What a rig rings at: the spectrum of one support of the present defaults beside those of before, with the modes named.

Before: supports of 1.6 kg at 1592 and 4285 Hz, the mean of both, no wall. Now: supports of 2.3 kg at 450 and 2900 Hz, the pinion's
support, a wall of 4 kHz under the sensor. The mean of both hides the mode in which they move out of phase.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import meshtone as mt
from meshtone.plotting import BLUE, GREY

GEAR_SUPPORT, PINION_SUPPORT = [13, 14], [15, 16]
today = mt.examples.tooth_breakage().copy(sensors=[mt.Sensor()])
former = today.copy(
    support={"mass_kg": 1.6, "base_hz": 1592.0, "differential_hz": 4285.0},
    sensors=[mt.Sensor(at="support", path={"plate_hz": 0.0})],
)

figure, axes = plt.subplots(2, 1, figsize=(9, 7), sharex=True, sharey=True, layout="constrained")
for ax, scenario, name in [(axes[0], former, "Before: mean of both supports"), (axes[1], today, "Now: the pinion's support")]:
    simulation = mt.simulate(scenario)
    [signal] = simulation.sensors.values()
    amplitude_g = 2 * np.abs(np.fft.rfft(signal)) / signal.size
    # The highest line in each 25 Hz.
    step = round(25 * signal.size / simulation.sampling_rate_hz)
    highest_g = amplitude_g[: len(amplitude_g) // step * step].reshape(-1, step).max(axis=1)
    ax.semilogy(0.025 * (np.arange(highest_g.size) + 0.5), highest_g, color=BLUE, linewidth=1)
    named: list[float] = []
    for frequency_hz, shape in zip(simulation.natural_frequencies_hz, simulation.mode_shapes.T):
        energy = simulation.mass_diagonal * shape**2
        # Both directions often ring at nearly one frequency.
        if energy[GEAR_SUPPORT + PINION_SUPPORT].sum() > energy.sum() / 6 and (not named or frequency_hz > 1.15 * named[-1]):
            named.append(frequency_hz)
            words = "in phase" if shape[GEAR_SUPPORT] @ shape[PINION_SUPPORT] > 0 else "out of phase"
            ax.axvline(frequency_hz / 1e3, color=GREY, linestyle="--", linewidth=0.8)
            ax.text(frequency_hz / 1e3 + 0.03, 1.4, f"{frequency_hz:.0f} Hz, {words}", rotation=90, va="bottom", fontsize=8)
    ax.set(ylabel="Amplitude (g)", ylim=(1e-4, 1e4))
    ax.set_title(name, loc="right")
    ax.grid(alpha=0.3)
axes[1].set_xlabel("Frequency (kHz)")
axes[1].set_xlim(0, 10)
figure.savefig(Path(*sys.argv[1:2], "python_support_spectra.png"), dpi=100)
