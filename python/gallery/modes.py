"""Which modes a pair on its shafts and supports has: what moves, what is strained, how much is damped.

The machine seen along its shafts, at rest (dashed) and displaced, with the mesh closed. A spoke shows how a wheel turns; a black square
is the support that the bearings of its shaft sit in. The bar below each is the share of each part in the strain energy. Left out are the
modes in which nothing moves in this plane: tilts of the wheels, and movement along the shafts.
"""

import sys
import textwrap
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Rectangle
from numpy.typing import NDArray

import meshtone as mt
from meshtone.plotting import BLUE, GREY, ORANGE

simulation = mt.simulate(mt.examples.healthy().copy(model="contact"))
scenario = simulation.scenario
gear_mm, pinion_mm = scenario.module_mm * scenario.gear_teeth / 2, scenario.module_mm * scenario.pinion_teeth / 2
# Coordinates: x, y of gear and pinion, rotations of gear, pinion and brake, z, tilts; x, y of the gear's and of the pinion's support.
GEAR, PINION, TURNS, GEAR_SUPPORT, PINION_SUPPORT = [0, 1], [2, 3], [4, 5, 6], [13, 14], [15, 16]
# Centre and radius in mm, the coordinates of the centre, and that of the rotation.
PLACES: dict[str, tuple[tuple[float, float], float, list[int], int]] = {
    "brake": ((-1.75 * gear_mm, 0), pinion_mm, [], 6),
    "gear": ((0, 0), gear_mm, GEAR, 4),
    "pinion": ((gear_mm + pinion_mm, 0), pinion_mm, PINION, 5),
}
SUPPORTS = {"gear": GEAR_SUPPORT, "pinion": PINION_SUPPORT}
PARTS = {"teeth": ORANGE, "gear's shaft, bending": BLUE, "pinion's shaft, bending": "#56b4e9", "gear's shaft, twist": "#009e73"}
PARTS |= {"pinion's shaft, twist": "#a6d854", "supports": GREY}


def strain_shares(shape: NDArray[np.float64]) -> NDArray[np.float64]:
    """Parts of the strain energy, in the order of PARTS."""
    free, closed = simulation.stiffness_matrix_open, simulation.stiffness_matrix_mean
    pinion_shaft, gear_shaft = simulation.shaft_stiffness_nm_per_rad

    def bending(wheel: list[int], support: list[int], tilts: list[int]) -> float:
        bent = np.concatenate([shape[wheel] - shape[support], shape[tilts]])
        own = np.ix_(wheel + tilts, wheel + tilts)
        return float(bent @ free[own] @ bent)

    parts: list[float] = [float(shape @ (closed - free) @ shape), bending(GEAR, GEAR_SUPPORT, [9, 11]), bending(PINION, PINION_SUPPORT, [10, 12])]
    parts += [gear_shaft * (shape[4] - shape[6]) ** 2, pinion_shaft * shape[5] ** 2]
    whole = shape @ closed @ shape
    return np.asarray([*parts, whole - sum(parts)]) / whole


def in_words(shape: NDArray[np.float64]) -> str:
    """What has more than a sixth of the kinetic energy, the most first."""
    energy = simulation.mass_diagonal * shape**2
    together = shape[GEAR_SUPPORT] @ shape[PINION_SUPPORT] > 0
    moving = {f"{name} turns": energy[turn] for name, (_, _, _, turn) in PLACES.items()}
    moving |= {f"{name} moves": energy[wheel].sum() for name, (_, _, wheel, _) in PLACES.items() if wheel}
    moving[f"supports move {'together' if together else 'apart'}"] = energy[GEAR_SUPPORT + PINION_SUPPORT].sum()
    most = sorted((what for what in moving if moving[what] > energy.sum() / 6), key=lambda what: -moving[what])
    return textwrap.fill(", ".join(most), 38)


def draw(ax: Axes, shape: NDArray[np.float64], colours: tuple[str, str], style: str) -> None:
    """The machine, displaced by a shape in mm and rad; colours of wheels and supports."""
    for name, (centre, radius, wheel, turn) in PLACES.items():
        middle = np.array(centre) + (shape[wheel] if wheel else 0.0)
        ax.add_patch(Circle(tuple(middle), radius, fill=False, color=colours[0], linestyle=style))
        spoke = middle + radius * np.array([-np.sin(shape[turn]), np.cos(shape[turn])])
        ax.plot(*zip(middle, spoke), color=colours[0], linestyle=style, linewidth=1)
        if name in SUPPORTS:
            corner = np.array(centre) + shape[SUPPORTS[name]] - 9
            ax.add_patch(Rectangle(tuple(corner), 18, 18, fill=False, color=colours[1], linestyle=style))


omega = 2 * np.pi * simulation.natural_frequencies_hz
angle = np.radians(scenario.pressure_angle_deg)
closed_n_per_m = (simulation.stiffness_matrix_mean - simulation.stiffness_matrix_open)[0, 0] / np.sin(angle) ** 2
base_m = 1e-3 * np.cos(angle) * np.array([pinion_mm, gear_mm])
mesh_mass_kg = 1 / (base_m**2 / [simulation.pinion_polar_inertia_kgm2, simulation.gear_polar_inertia_kgm2]).sum()
mesh_damping_s = 2 * scenario.mesh_damping_ratio * np.sqrt(mesh_mass_kg / closed_n_per_m)
damping = simulation.damping_matrix + mesh_damping_s * (simulation.stiffness_matrix_mean - simulation.stiffness_matrix_open)

shapes = simulation.mode_shapes.T
in_plane = [n for n, shape in enumerate(shapes) if np.delete(simulation.mass_diagonal * shape**2, range(7, 13)).sum() > 0.5]
figure, grid = plt.subplots(3, 4, figsize=(13, 8.8), layout="constrained")
for ax, mode in zip(grid.flat, in_plane):
    shape = shapes[mode]
    moved = [*shape[GEAR + PINION + GEAR_SUPPORT + PINION_SUPPORT], *1e-3 * shape[TURNS] * [gear_mm, pinion_mm, pinion_mm]]
    draw(ax, np.zeros(17), (GREY, GREY), "--")
    # The largest movement is drawn 14 mm long.
    scale = 14 / (1e3 * np.abs(moved).max())
    mm = np.full(17, 1e3)
    mm[TURNS] = 1
    draw(ax, scale * mm * shape, (BLUE, "black"), "-")
    left = -140.0
    for share, colour in zip(strain_shares(shape), PARTS.values()):
        ax.add_patch(Rectangle((left, -92), 260 * share, 12, color=colour, linewidth=0))
        left += 260 * share
    ratio = shape @ damping @ shape / (2 * omega[mode])
    ax.set_title(f"{simulation.natural_frequencies_hz[mode]:.0f} Hz, damping ratio {100 * ratio:.1f} %\n{in_words(shape)}", fontsize=10)
for ax in grid.flat:
    ax.set(aspect="equal", xlim=(-148, 128), ylim=(-98, 74))
    ax.axis("off")
key = grid.flat[len(in_plane)]
draw(key, np.zeros(17), (GREY, GREY), "--")
for name, (centre, radius, *_) in PLACES.items():
    key.text(centre[0], -radius - 3, name, ha="center", va="top", fontsize=9)
# A pinion that turns counterclockwise pushes the gear down.
pitch_point, along = np.array([gear_mm, 0]), 40 * np.array([np.sin(angle), np.cos(angle)])
key.plot(*zip(pitch_point - along, pitch_point + along), color=ORANGE, linewidth=1)
key.text(*(pitch_point + along + [4, 0]), "line of action", color=ORANGE, fontsize=9)
key.text(0, -12, "support", ha="center", va="top", fontsize=9)
key.set_title("The machine at rest, and the parts\nthat share the strain energy", fontsize=10)
handles = [Rectangle((0, 0), 1, 1, color=colour, linewidth=0) for colour in PARTS.values()]
for ax in grid.flat[len(in_plane) + 1 :]:
    ax.remove()
figure.legend(handles, PARTS, loc="outside lower center", ncols=len(PARTS), frameon=False)
figure.savefig(Path(*sys.argv[1:2], "python_modes.png"), dpi=100)
