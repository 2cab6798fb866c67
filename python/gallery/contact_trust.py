"""How far the motion of teeth that part can be trusted.

Above, the mesh force over a pitch, and the supports' acceleration, against a machine that ROSS assembles and a Runge-Kutta method
integrates: an eccentric pair under 1 N m, in a backlash of 5 µm. Below left, a difference of 1e-9 in the load over time: at 10 N m it
stays, at 1 N m the motion is chaotic. Below right, what a smaller step changes in the indicators. Run it in the repository's folder.
"""

import json
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import meshtone as mt
from meshtone.plotting import BLUE, GREY, ORANGE

figure, ((force, acceleration), (growth, steps)) = plt.subplots(2, 2, figsize=(11, 7.2), layout="constrained")

reference = json.loads(Path("python", "tests", "references", "ross_backlash.json").read_text(encoding="utf-8"))["both flanks"]
simulation = mt.simulate(mt.Scenario.from_toml(reference["scenario"]).copy(sampling_rate_hz=1e5))
first_s, last_s = reference["window_s"]
window_s = np.linspace(first_s, last_s, len(reference["window_mesh_force_n"]))
compared = (
    (force, "mesh_force_n", "Mesh force (N)", (15, 16.6), window_s, reference["window_mesh_force_n"]),
    (acceleration, "vertical_g", "Vertical acceleration (g)", (10, 25), np.array(reference["time_s"]), reference["vertical_g"]),
)
for ax, channel, label, shown_ms, instants_s, expected in compared:
    ax.plot(1e3 * simulation.time_s, getattr(simulation, channel), color=BLUE, linewidth=1, label="Meshtone, default step")
    ax.plot(1e3 * instants_s, expected, ".", color=ORANGE, markersize=3, label="ROSS and Runge-Kutta")
    ax.set(xlabel="Time (ms)", ylabel=label, xlim=shown_ms, ylim=np.array([-1.1, 1.4]) * np.abs(expected).max())
    ax.legend(frameon=False, loc="upper right", ncols=2)
force.set_title("Between drive flanks (positive) and coast flanks (negative)")
acceleration.set_title("The supports' mean vertical acceleration, the same")

missing = mt.examples.healthy().copy(model="contact", fault=mt.MissingTooth())
from_start = missing.copy(settle_fraction=0)
for torque_nm, colour in ((10, BLUE), (2, GREY), (1, ORANGE)):
    one, other = (mt.simulate(from_start.copy(brake_torque_nm=load)) for load in (torque_nm, torque_nm * (1 + 1e-9)))
    # Rms over each tooth pitch.
    samples = round(one.sampling_rate_hz / (missing.pinion_speed_hz * missing.pinion_teeth))
    difference = (one.vertical_g - other.vertical_g)[: one.vertical_g.size // samples * samples].reshape(-1, samples)
    relative = np.sqrt(np.mean(difference**2, axis=1)) / one.vertical_g.std()
    revolutions = np.arange(relative.size) / missing.pinion_teeth
    growth.semilogy(revolutions, relative, color=colour, linewidth=0.8, label=f"{torque_nm} N m")
growth.set(title="A missing tooth, the load changed by 1e-9", xlabel="Revolutions of the pinion")
growth.set(ylabel="Difference over rms (-)", ylim=(1e-12, 1e2), xlim=(0, None))
growth.legend(frameon=False, ncols=3, loc="upper left")

FACTORS = (1e5, 2e5, 3.5e5, 6e5)
for scenario, name, colour in ((missing.copy(fault=None), "healthy", BLUE), (missing, "missing tooth", ORANGE)):
    finest = mt.simulate(scenario.copy(sampling_rate_hz=1.6e6)).process().indicators
    simulations = [mt.simulate(scenario.copy(sampling_rate_hz=rate)) for rate in FACTORS]
    step_us = [1e6 / simulation.sampling_rate_hz for simulation in simulations]
    for indicator, marker in (("rms", "o-"), ("kurtosis", "s--")):
        key = f"difference_{indicator}"
        change = [100 * abs(simulation.process().indicators[key] / finest[key] - 1) for simulation in simulations]
        steps.loglog(step_us, change, marker, color=colour, markersize=4, label=f"{indicator}, {name}")
steps.axhline(1, color=GREY, linestyle=":")
steps.set(title="Difference signal, 10 N m, against a step of 0.57 µs", xlabel="Step (µs)", ylabel="Change (%)", ylim=(1e-7, 5))
steps.set_xticks([1, 2, 3, 4], ["1", "2", "3", "4"])
steps.minorticks_off()
steps.legend(frameon=False, loc="lower right", fontsize=9, ncols=2)
for ax in figure.axes:
    ax.grid(alpha=0.3)
figure.savefig(Path(*sys.argv[1:2], "python_contact_trust.png"), dpi=100)
