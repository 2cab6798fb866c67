"""From a healthy and a damaged recording of a gearbox to the damaged wheel.

A tooth of one of four wheels is broken. Recorded is a sensor on a bearing's seat; the tooth counts carry the angle of the input to all
shafts. The wheel whose difference signal has become the most impulsive is the damaged one. Two wheels on one shaft have the same difference
signal: `mt.diagnose` tells them apart.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt

import meshtone as mt
from meshtone.plotting import BLUE, ORANGE

HEALTHY = mt.gearbox_template() + "settle_fraction = 0.81\n"
DAMAGED = HEALTHY + '\n[[fault]]\nwheel = "z4"\ntooth = 12\nkind = "tooth-breakage"\nseverity = 0.9\n'

before, now = (mt.simulate(mt.Scenario.from_toml(text)).process_wheels("output_1_vertical_g") for text in (HEALTHY, DAMAGED))
rise = {name: now[name].indicators["fm4"] / before[name].indicators["fm4"] for name in now.wheels}
wheel = max(rise, key=rise.__getitem__)
print(f"{wheel}, on the {now.shafts[wheel]} shaft, is damaged: its FM4 is {rise[wheel]:.1f} times that of the healthy gearbox")

figure, axes = plt.subplots(len(rise), 1, figsize=(9, 9), layout="constrained", sharex=True)
for ax, name in zip(axes, rise, strict=True):
    # What both have in common is dark: the one shows through the other.
    for record, colour, label in ((now, ORANGE, "now"), (before, BLUE, "healthy")):
        signal_g = record[name].difference
        angle_deg = [360 * point / len(signal_g) for point in range(len(signal_g))]
        ax.plot(angle_deg, signal_g, color=colour, linewidth=0.6, alpha=0.7, label=label)
    ax.set(title=f"{name}: FM4 is {rise[name]:.1f} times that of the healthy gearbox", ylabel="Difference signal (g)", xlim=(0, 360))
axes[0].legend(loc="upper right")
axes[-1].set_xlabel("Angle of the wheel (°)")
figure.savefig(Path(*sys.argv[1:2], "python_gearbox_wheel.png"), dpi=100)
