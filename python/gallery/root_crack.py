"""What a root crack takes from the stiffness of a pair of teeth.

Left, the stiffness of the pair with the gear's cracked tooth over its path, for cracks nearly up to the centre line of the tooth. In the
middle, the loss over the crack's depth at four positions; dots are another program's. Right, the mean loss over the path, also of cracks that
run out along the face.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import meshtone as mt

# Depth, and losses at the four positions in per cent.
OTHER_PROGRAM = np.array(
    [[0.5, 1.69, 0.86, 0.61, 0.23], [1, 4.32, 2.04, 1.49, 0.47], [2, 12.33, 5.56, 3.87, 1.01], [3, 24.51, 10.79, 7.32, 1.77]]
)

healthy = mt.examples.healthy().copy(din_grade=0, foundation={"rotation": "tooth"})
depths_mm = np.linspace(0, 4.25, 18)
whole_face_mm = healthy.face_width_mm


def stiffness(depth_mm: float, length_mm: float | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Position (base pitches) and stiffness (N/µm) of the pair of the cracked tooth."""
    trace = mt.trace(healthy.copy(fault=mt.RootCrack(depth_mm=depth_mm, length_mm=length_mm)))
    pair_n_per_um = 1e-3 * trace["pair_stiffness_faulty_n_per_mm"]
    return np.linspace(0, trace["contact_ratio"], pair_n_per_um.size), pair_n_per_um


curves = [stiffness(depth_mm) for depth_mm in depths_mm.tolist()]
position, sound = curves[0]
loss_percent = np.array([100 * (1 - cracked / sound) for _, cracked in curves])

figure, (path, places, lengths) = plt.subplots(1, 3, figsize=(13, 4.2), layout="constrained")
shades = plt.get_cmap("viridis")(np.linspace(0, 0.9, 6))
for depth_mm, shade in zip((0, 0.5, 1, 2, 3, 4), shades):
    cracked = curves[int(np.argmin(abs(depths_mm - depth_mm)))][1]
    path.plot(position, cracked, color=shade, label=f"{depth_mm:g} mm" if depth_mm else "sound")
path.set(title="Pair with the cracked tooth", xlabel="Position on the path (base pitches)", ylabel="Stiffness (N/µm)", ylim=(0, None))
path.legend(title="Crack", frameon=False, ncols=2, loc="lower center")

names = ["tip of the cracked tooth", "start of single contact", "pitch point", "end of the path"]
# The gear's tip begins the path; at the pitch point its flank has the radius of curvature r sin α, r the pitch radius.
module_mm, alpha = healthy.module_mm, np.radians(20)
pitch_radius_mm = module_mm * healthy.gear_teeth / 2
tip_curvature_mm = np.sqrt((pitch_radius_mm + module_mm) ** 2 - (pitch_radius_mm * np.cos(alpha)) ** 2)
pitch_point = (tip_curvature_mm - pitch_radius_mm * np.sin(alpha)) / (np.pi * module_mm * np.cos(alpha))
at = [0, position[-1] - 1, pitch_point, position[-1]]
for name, place, others, shade in zip(names, at, OTHER_PROGRAM.T[1:], plt.get_cmap("viridis")(np.linspace(0, 0.85, 4))):
    places.plot(depths_mm, loss_percent[:, np.argmin(abs(position - place))], color=shade, label=name)
    places.plot(OTHER_PROGRAM[:, 0], others, "o", color=shade, markersize=6, markeredgecolor="black")
places.plot([], [], "o", color="white", markeredgecolor="black", label="another program")
places.set(title="Over the whole face", xlabel="Depth (mm)", ylabel="Loss of the pair's stiffness (%)")
places.legend(frameon=False)

for length_mm, shade in zip((3.75, 7.5, whole_face_mm, None), plt.get_cmap("viridis")(np.linspace(0, 0.85, 4))):
    mean = [np.mean(100 * (1 - stiffness(depth_mm, length_mm)[1] / sound)) for depth_mm in depths_mm.tolist()]
    label = "equally deep over the face" if length_mm is None else f"parabola of {length_mm:g} mm"
    lengths.plot(depths_mm, mean, color=shade, label=label)
lengths.set(title="Mean over the path", xlabel="Depth where it is deepest (mm)", ylabel="Loss of the pair's stiffness (%)")
lengths.legend(frameon=False)
for ax in (path, places, lengths):
    ax.grid(alpha=0.3)
for ax in (places, lengths):
    ax.set(xlim=(0, depths_mm[-1]), ylim=(0, None))
figure.savefig(Path(*sys.argv[1:2], "python_root_crack.png"), dpi=100)
