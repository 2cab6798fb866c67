"""From a healthy and a damaged recording of a gearbox to the damaged wheel.

A tooth of one of four wheels is missing. Recorded is a sensor on a bearing's seat; the tooth counts carry the angle of the input to all
shafts. The difference signals show on which shaft the damage is; the diagnosis compares them with simulations and names the wheel.
"""

import sys
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt

import meshtone as mt
from meshtone.plotting import BLUE, ORANGE

SOLVER = "sampling_rate_hz = 12000.0\nduration_s = 1.6\nsettle_fraction = 0.3\n"
HEALTHY = mt.gearbox_template().split("# Without")[0] + '[[sensor]]\nat = "middle:1"\n\n[solver]\n' + SOLVER
rig, broken = (mt.Gearbox.from_toml(HEALTHY + fault) for fault in ("", '[[fault]]\nwheel = "z3"\ntooth = 12\nkind = "missing-tooth"\n'))
before, now = mt.simulate_gearbox(rig), mt.simulate_gearbox(broken)
with tempfile.TemporaryDirectory() as folder:
    found = mt.diagnose(now, rig, before, reference=folder, records=1024)
print(found.summary)

records = [simulation.process() for simulation in (before, now)]
figure, axes = plt.subplots(len(records[0].wheels), 1, figsize=(9, 9), layout="constrained", sharex=True)
for ax, wheel in zip(axes, records[0].wheels, strict=True):
    for record, colour, label in zip(records, (BLUE, ORANGE), ("healthy", "now"), strict=True):
        signal_g = record[wheel].difference
        ax.plot([360 * point / len(signal_g) for point in range(len(signal_g))], signal_g, color=colour, linewidth=0.7, label=label)
    probability = found.to_dict()["wheel_probabilities"][wheel]
    ax.set(title=f"{wheel}: damaged with {100 * probability:.0f} %", ylabel="Difference (g)", xlim=(0, 360))
axes[0].legend(loc="upper right")
axes[-1].set_xlabel("Angle of the wheel (°)")
figure.savefig(Path(*sys.argv[1:2], "python_gearbox_wheel.png"), dpi=100)
