"""The path to a sensor, found again from recordings of the healthy machine.

A hidden path with three resonances on a slope of 6 dB an octave lies between a support and its sensor. Once from a run-up and once from
one speed the machine is compared with simulations of the same machine with other wheels.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import meshtone as mt
from meshtone.plotting import BLUE, GREY, ORANGE

hz = np.arange(0.0, 50_000, 10)
hidden = (50 + 1j * hz) / 2000
for resonance_hz, damping_ratio, share in [(1300, 0.04, 0.3), (3400, 0.03, 0.3), (7200, 0.03, -0.3)]:
    ratio = hz / resonance_hz
    hidden *= 1 + share * ratio**2 / (1 - ratio**2 + 2j * damping_ratio * ratio)

rig = mt.examples.healthy().copy(brake_torque_nm=20, din_grade=7, sensors=[mt.Sensor()])
path = {"frequency_hz": hz, "magnitude": np.abs(hidden), "phase_deg": np.degrees(np.angle(hidden))}
machine = rig.copy(seed=501, sensors=[mt.Sensor(frequency_response=path)])
run_up = machine.copy(speed_profile_hz={"time_s": [0, 10], "value": [20, 60]}, settle_fraction=1 / 11)
one_speed = machine.copy(duration_s=5)

figure, axes = plt.subplots(2, 1, figsize=(9, 7), sharex=True, sharey=True, layout="constrained")
for ax, recorded, name, colour in [(axes[0], run_up, "run-up, 20 to 60 rev/s", BLUE), (axes[1], one_speed, "5 s at 40 rev/s", ORANGE)]:
    found = mt.estimate_path(mt.simulate(recorded), rig)
    ax.plot(hz, 20 * np.log10(np.abs(hidden)), color=GREY, linewidth=2, label="hidden")
    ax.plot(found.frequency_hz, found.magnitude_db, color=colour, label="estimated")
    ax.fill_between(found.frequency_hz, found.low_db, found.high_db, color=colour, alpha=0.25, linewidth=0, label="90 %")
    ax.set(title=f"From a {name}" if recorded is run_up else f"From {name}", ylabel="Magnitude (dB)", xscale="log")
    ax.set(xlim=(300, 12_000), ylim=(-25, 35))
    ax.grid(alpha=0.3, which="both")
    ax.legend(loc="upper left")
axes[1].set_xlabel("Frequency (Hz)")
figure.savefig(Path(*sys.argv[1:2], "python_sensor_path.png"), dpi=100)
