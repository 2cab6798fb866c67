"""Order tracking of a run-up.

A pair of ideal teeth speeds up from 20 to 60 rev/s. Every harmonic of the mesh sweeps over a factor of three in frequency, and the
spectrum shows no more than the natural frequencies that are passed. Over the angle of the pinion, which the speed signal gives, the
harmonics are lines again: at multiples of its 17 teeth. The order map has these lines at every speed, and the natural frequencies that
pass over them.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import meshtone as mt
from meshtone.plotting import BLUE, ORANGE

scenario = mt.examples.healthy().copy(din_grade=0, speed_profile_hz={"time_s": [0, 3], "value": [20, 60]}, settle_fraction=0.25)
run_up = mt.simulate(scenario)
rate_hz, teeth = run_up.sampling_rate_hz, scenario.pinion_teeth

amplitude_g = 2 * np.abs(np.fft.rfft(run_up.vertical_g)) / run_up.vertical_g.size
frequency_hz = np.fft.rfftfreq(run_up.vertical_g.size, 1 / rate_hz)
phase = mt.ShaftPhase.from_speed_samples(run_up.pinion_shaft_speed_hz, rate_hz)
angular = mt.signal.angular_resample(run_up.vertical_g, phase)
order_amplitude_g = 2 * np.abs(np.fft.rfft(angular.values)) / angular.values.size
orders = np.fft.rfftfreq(angular.values.size, 1 / angular.points_per_revolution)

order_map = mt.signal.order_map(run_up.vertical_g, phase, rate_hz, revolutions=8)

figure, (frequency_ax, order_ax, map_ax) = plt.subplots(
    3, 1, figsize=(9, 10), height_ratios=[1, 1, 1.8], layout="constrained"
)
shown = frequency_hz < 8 * teeth * 60
frequency_ax.plot(frequency_hz[shown], amplitude_g[shown], color=BLUE, linewidth=0.5)
frequency_ax.set(title="Over frequency: smeared", xlabel="Frequency (Hz)", ylabel="Vertical amplitude (g)")
shown = orders < 8.5 * teeth
order_ax.plot(orders[shown], order_amplitude_g[shown], color=ORANGE, linewidth=0.7)
order_ax.set(title="Over order: sharp", xlabel="Order of the pinion (cycles per revolution)", ylabel="Vertical amplitude (g)")
order_ax.set_xticks(teeth * np.arange(9))
order_map.plot(teeth, over="speed", ax=map_ax)
figure.axes[-1].set_ylabel("Vertical amplitude (g)")
map_ax.set(title="Over order and speed", xlabel="Order of the pinion", ylabel="Pinion speed (rev/s)")
for ax in (frequency_ax, order_ax):
    ax.margins(x=0)
    ax.grid(alpha=0.3)
figure.savefig(Path(*sys.argv[1:2], "python_run_up.png"), dpi=100)
