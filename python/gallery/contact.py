"""How pairs of teeth share a load at rest, and how much the load moves the driven wheel: Harris's map.

Above, the forces of the pairs under 200 N m on the gear, over the pitches around the first tooth's contact, sound and with 3 mm of its tip
broken off; one pair is dark, the next one light. Below, the static transmission error at five torques, and its peak-to-peak over torque,
with flanks as they are and with relief for the load of 200 N m.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import meshtone as mt
from meshtone.plotting import BLUE, GREY, ORANGE

LIGHT_BLUE = "#56b4e9"

RELIEF = {"shape": "linear", "length_mm": 2.0, "amount_um": 21.0}
torques_nm = np.linspace(10, 400, 40)
healthy = mt.examples.healthy().copy(model="contact", brake_torque_nm=200, tip_chamfer_mm=0.3)
broken = healthy.copy(fault=mt.ToothBreakage(chip_height_mm=5, chip_width_mm=12, tip_loss_mm=3))

base_radius_m = 1e-3 * healthy.module_mm * healthy.gear_teeth / 2 * np.cos(np.radians(20))
figure, ((sound, damaged), (error, harris)) = plt.subplots(2, 2, figsize=(11, 7), layout="constrained")
for ax, scenario, title in ((sound, healthy, "Sound teeth, 200 N m"), (damaged, broken, "The gear's first tooth has lost 3 mm of its tip")):
    at_rest = mt.simulate(scenario).static_mesh(pitches=(36, 41))
    for pair, force_n in zip(at_rest.pairs, at_rest.pair_force_n):
        is_broken = scenario is broken and pair % scenario.gear_teeth == 0
        colour = ORANGE if is_broken else (BLUE, LIGHT_BLUE)[pair % 2]
        label = "pair of the broken tooth" if is_broken else None
        # Lines end where the pair lets go.
        force_kn = np.where(force_n > 0, force_n / 1e3, np.nan)
        ax.plot(at_rest.pitch - scenario.gear_teeth, force_kn, color=colour, linewidth=2 if is_broken else 1.5, label=label)
    whole_kn = healthy.brake_torque_nm / base_radius_m / 1e3
    ax.axhline(whole_kn, color=GREY, linestyle=":", label="all pairs together")
    ax.set(title=title, xlabel="Pitches since the first tooth enters its path", xlim=(-2, 3), ylim=(0, 1.25 * whole_kn))
    ax.set_ylabel("Force of each pair (kN)")
    ax.legend(frameon=False, loc="upper left", ncols=2)

for label, colour, relief in (("flanks without relief", GREY, None), ("relief for 200 N m", BLUE, RELIEF)):
    scenario = healthy if relief is None else healthy.copy(flank_relief=relief)
    simulation = mt.simulate(scenario)
    peak_um = [simulation.static_mesh(torque / base_radius_m).peak_to_peak_um for torque in torques_nm]
    harris.plot(torques_nm, peak_um, color=colour, label=label)
    if relief is not None:
        for torque, shade in zip((50, 100, 200, 300, 400), np.linspace(0.45, 1, 5)):
            at_rest = simulation.static_mesh(torque / base_radius_m)
            error.plot(at_rest.pitch, at_rest.transmission_error_um, color=BLUE, alpha=shade)
            error.text(2.02, at_rest.transmission_error_um[-1], f"{torque} N m", va="center", fontsize=9)
error.set(title="With relief for 200 N m, at five torques", xlabel="Pitches since a pair enters its path", xlim=(0, 2))
error.set(ylabel="Static transmission error (µm)", ylim=(0, None))
harris.set(title="Harris's map of the transmission error", xlabel="Torque on the gear (N m)", xlim=(0, 400), ylim=(0, None))
harris.axvline(200, color=GREY, linestyle=":")
harris.set_ylabel("Peak-to-peak (µm)")
harris.legend(frameon=False)
for ax in figure.axes:
    ax.grid(alpha=0.3)
figure.savefig(Path(*sys.argv[1:2], "python_contact.png"), dpi=100)
