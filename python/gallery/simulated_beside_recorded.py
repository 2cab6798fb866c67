"""A simulated gearbox beside recordings of a real one with the same teeth.

Third-octave levels over the energy of each channel: of two sensors of a recorded two-stage gearbox at two loads, and of four seats of a simulated
machine. Without friction, the random force and the modes of the housing its energy is in a few lines.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import meshtone as mt
from meshtone.plotting import BLUE, ORANGE

RECORDED = np.genfromtxt(Path(__file__).with_name("recorded_third_octaves.csv"), delimiter=",", comments="#", skip_header=3)
CENTRE_HZ, RECORDED_DB = RECORDED[:, 0], RECORDED[:, 1:]
SEATS = ("input:0", "middle:0", "middle:1", "output:1")
QUIET = {"friction": 0.0, "random_force": 0.0}


def gearbox(**of_mesh):
    """Two stages of 32/80 and 48/64 teeth at 60 N m; the torque varies three times a revolution of the input."""
    ends = [(shaft, at) for shaft in ("input", "middle", "output") for at in (0.0, 1.0)]
    wheels = (("z1", "input", 0.25, 32), ("z2", "middle", 0.25, 80), ("z3", "middle", 0.75, 48), ("z4", "output", 0.75, 64))
    coupled = {"input": "motor", "middle": "nothing", "output": "brake"}
    return mt.Gearbox(
        shaft=[{"name": name, "length_mm": 240.0, "radius_mm": 20.0, "couples_to": to} for name, to in coupled.items()],
        wheel=[
            {"name": name, "shaft": shaft, "at": at, "teeth": teeth, "face_width_mm": 19.05, "iso_class": 4}
            for name, shaft, at, teeth in wheels
        ],
        mesh=[{"wheels": pair, "module_mm": 1.5875, **of_mesh} for pair in (["z1", "z2"], ["z3", "z4"])],
        bearing=[{"shaft": shaft, "at": at} for shaft, at in ends],
        housing={"modes": {"per_khz": 0.0 if of_mesh else 4.0}},
        operation={
            "input_speed_hz": 29.75,
            "brake_torque_nm": 60.0,
            "torque_ripple": [{"shaft": "input", "order": 3.0, "amplitude": 0.8}],
        },
        sensor=[{"at": seat} for seat in SEATS],
        solver={"sampling_rate_hz": 51200.0, "duration_s": 2.0},
    )


def levels_db(signal_g, rate_hz):
    """Third-octave levels over the energy below 6.4 kHz, which is what a recorder at 12.8 kS/s hears."""
    power = np.abs(np.fft.rfft(signal_g * np.hanning(len(signal_g)))) ** 2
    hz = np.fft.rfftfreq(len(signal_g), 1 / rate_hz)
    edge = 2 ** (1 / 6)
    bands = [power[(hz >= centre / edge) & (hz < centre * edge)].sum() for centre in CENTRE_HZ]
    return 10 * np.log10(np.array(bands) / power[(hz > 20) & (hz < 6.4e3)].sum())


def of_seats(scenario):
    """The levels of all seats of a simulation, a column each."""
    simulation = mt.simulate(scenario)
    signals = [simulation[seat.replace(":", "_") + "_vertical_g"] for seat in SEATS]
    return np.stack([levels_db(signal_g, simulation.sampling_rate_hz) for signal_g in signals], axis=1)


figure, axes = plt.subplots(1, 2, figsize=(10, 4), layout="constrained", sharey=True)
for ax, scenario, title in zip(axes, (gearbox(), gearbox(**QUIET)), ("As it is", "Frictionless, in a rigid housing"), strict=True):
    for levels, colour, label in ((RECORDED_DB, ORANGE, "recorded"), (of_seats(scenario), BLUE, "simulated")):
        ax.semilogx(CENTRE_HZ, levels, color=colour, linewidth=1, marker=".", label=[label, *[None] * (levels.shape[1] - 1)])
    ax.set(title=title, xlabel="Third octave (Hz)", ylim=(-60, 0))
    ax.grid(visible=True, alpha=0.3)
axes[0].set_ylabel("Level over the signal's (dB)")
axes[0].legend()
figure.savefig(Path(*sys.argv[1:2], "python_simulated_beside_recorded.png"), dpi=100)
