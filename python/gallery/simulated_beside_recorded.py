"""A simulated gearbox beside recordings of a real one with the same teeth.

Third-octave levels over the energy of each channel: of two sensors of a recorded two-stage gearbox at two loads, and of four seats of a simulated
machine. Without friction, the random force and the modes of the housing its energy is in a few lines.
"""

import sys
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt

import meshtone as mt
from meshtone.plotting import BLUE, ORANGE

# Centre (Hz), and levels (dB) of the sensors a1 and a3 without a load and at half of it: healthy recordings of OEDI submission 623 (National Renewable
# Energy Laboratory, CC BY 4.0), measured for this comparison.
RECORDED = np.array(
    [
        [198.4, -18.09, -27.56, -29.52, -27.02],
        [250.0, -30.06, -24.44, -34.58, -27.80],
        [315.0, -31.19, -17.73, -30.00, -21.55],
        [396.9, -29.64, -22.83, -31.40, -21.43],
        [500.0, -22.94, -20.42, -29.47, -16.47],
        [630.0, -23.29, -17.59, -25.98, -19.11],
        [793.7, -26.59, -10.24, -20.18, -11.39],
        [1000.0, -22.48, -8.57, -19.17, -8.45],
        [1259.9, -14.81, -10.68, -15.42, -11.04],
        [1587.4, -13.61, -12.62, -14.27, -11.42],
        [2000.0, -9.81, -10.18, -9.53, -10.40],
        [2519.8, -9.55, -9.66, -10.15, -10.20],
        [3174.8, -7.43, -12.95, -6.89, -11.56],
        [4000.0, -3.81, -6.60, -3.82, -6.47],
        [5039.7, -11.74, -10.38, -12.52, -10.35],
        [6349.6, -25.25, -23.98, -25.87, -25.24],
    ]
)
CENTRE_HZ, RECORDED_DB = RECORDED[:, 0], RECORDED[:, 1:]
SEATS = ("input:0", "middle:0", "middle:1", "output:1")
QUIET = {"friction": 0.0, "random_force": 0.0}


def gearbox(**of_mesh: float) -> mt.Scenario:
    """Two stages of 32/80 and 48/64 teeth at 60 N m; the torque varies three times a revolution of the input."""
    ends = [(shaft, at) for shaft in ("input", "middle", "output") for at in (0.0, 1.0)]
    wheels = (("z1", "input", 0.25, 32), ("z2", "middle", 0.25, 80), ("z3", "middle", 0.75, 48), ("z4", "output", 0.75, 64))
    coupled: dict[str, Any] = {"input": "motor", "middle": "nothing", "output": "brake"}
    meshes: Any = [{"wheels": pair, "module_mm": 1.5875, **of_mesh} for pair in (["z1", "z2"], ["z3", "z4"])]
    return mt.Gearbox(
        shafts=[{"name": name, "length_mm": 240.0, "radius_mm": 20.0, "couples_to": to} for name, to in coupled.items()],
        wheels=[
            {"name": name, "shaft": shaft, "at": at, "teeth": teeth, "face_width_mm": 19.05, "iso_class": 4}
            for name, shaft, at, teeth in wheels
        ],
        meshes=meshes,
        bearings=[{"shaft": shaft, "at": at} for shaft, at in ends],
        housing={"modes": {"per_khz": 0.0 if of_mesh else 4.0}},
        operation={
            "input_speed_hz": 29.75,
            "brake_torque_nm": 60.0,
            "torque_ripple": [{"shaft": "input", "order": 3.0, "amplitude": 0.8}],
        },
        sensors=[{"at": seat} for seat in SEATS],
        solver={"sampling_rate_hz": 51200.0, "duration_s": 2.0},
    )


def levels_db(signal_g: npt.NDArray[np.float64], rate_hz: float) -> npt.NDArray[np.float64]:
    """Third-octave levels over the energy below 6.4 kHz, which is what a recorder at 12.8 kS/s hears."""
    power = np.abs(np.fft.rfft(signal_g * np.hanning(len(signal_g)))) ** 2
    hz = np.fft.rfftfreq(len(signal_g), 1 / rate_hz)
    edge = 2 ** (1 / 6)
    bands = [power[(hz >= centre / edge) & (hz < centre * edge)].sum() for centre in CENTRE_HZ]
    levels: npt.NDArray[np.float64] = 10 * np.log10(np.array(bands) / power[(hz > 20) & (hz < 6.4e3)].sum())
    return levels


def of_seats(scenario: mt.Scenario) -> npt.NDArray[np.float64]:
    """The levels of all seats of a simulation, a column each."""
    simulation = mt.simulate(scenario)
    signals = [simulation[seat.replace(":", "_") + "_vertical_g"] for seat in SEATS]
    return np.stack([levels_db(signal_g, simulation.sampling_rate_hz) for signal_g in signals], axis=1)


figure, axes = plt.subplots(1, 2, figsize=(10, 4), layout="constrained", sharey=True)
for ax, scenario, title in zip(axes, (gearbox(), gearbox(**QUIET)), ("As it is", "Frictionless, in a rigid housing"), strict=True):
    for levels, colour, label in ((RECORDED_DB, ORANGE, "recorded"), (of_seats(scenario), BLUE, "simulated")):
        ax.semilogx(CENTRE_HZ, levels, color=colour, linewidth=1, marker=".", label=[label, *[None] * (levels.shape[1] - 1)])
    ax.set(title=title, xlabel="Third octave (Hz)", ylim=(-60, 0), xticks=[250, 500, 1000, 2000, 4000], xticklabels=["250", "500", "1000", "2000", "4000"])
    ax.minorticks_off()
    ax.grid(visible=True, alpha=0.3)
axes[0].set_ylabel("Level over the signal's (dB)")
axes[0].legend()
figure.savefig(Path(*sys.argv[1:2], "python_simulated_beside_recorded.png"), dpi=100)
