"""A linear classifier on the indicators of a data set: what it confuses, on units it has not seen and at speeds it has not seen.

    python classifier.py [DIRECTORY]
"""

import sys
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from meshtone import datasets, examples

INDICATORS = ["difference_rms_g", "difference_kurtosis", "envelope_kurtosis", "fm4", "m6a", "energy_ratio", "average_crest_factor"]
MACHINE = examples.healthy().copy(settle_tolerance=1e-3)
PLAN = """
records = 400
units = 20
scenario = "machine.toml"
class = [
    { label = "healthy" },
    { label = "tooth-breakage", fault = { kind = "tooth-breakage", chip_height_mm = 5.0, chip_width_mm = 8.0, tip_loss_mm = 3.0 } },
    { label = "tooth-destruction", fault = { kind = "tooth-destruction", start = 0.2, end = 0.9 } },
    { label = "through-face", fault = { kind = "through-face", start = 0.2, end = 0.8, depth = 0.5 } },
]
vary = [
    { key = "operation.pinion_speed_hz", uniform = [20.0, 50.0] },
    { key = "operation.brake_torque_nm", uniform = [8.0, 12.0] },
]
[split]
train = 0.5
test = 0.25
shift = [{ name = "fast", part = 0.25, when = "operation.pinion_speed_hz > 40" }]
"""


def inputs(part: datasets.Dataset) -> "np.typing.NDArray[np.float64]":
    """Indicators span decades: their logarithms, and 1 for the constant."""
    return np.column_stack([np.log(part.matrix(INDICATORS)), np.ones(len(part))])


folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
with tempfile.TemporaryDirectory() as place:
    Path(place, "machine.toml").write_text(MACHINE.to_toml())
    plan = Path(place, "plan.toml")
    plan.write_text(PLAN)
    gears = datasets.generate_dataset(plan, Path(place, "gears"))
    train = gears.split("train")
    classes = sorted(set(train.column("label")))
    wanted = np.equal.outer(train.column("label"), np.array(classes, dtype=object)).astype(float)
    weights = np.linalg.lstsq(inputs(train), wanted, rcond=None)[0]

    figure, axes = plt.subplots(1, 2, figsize=(10.0, 4.6), layout="constrained")
    for ax, split, title in zip(axes, ["test", "fast"], ["other wheels", "other wheels, faster than any in training"]):
        part = gears.split(split)
        found = np.array(classes)[np.argmax(inputs(part) @ weights, axis=1)]
        true = part.column("label")
        table = np.array([[np.sum((true == a) & (found == b)) for b in classes] for a in classes])
        ax.imshow(table / table.sum(axis=1, keepdims=True), cmap="Blues", vmin=0, vmax=1)
        for row, counts in enumerate(table):
            for column, count in enumerate(counts):
                dark = count > table[row].sum() / 2
                ax.text(column, row, str(count), ha="center", va="center", color="white" if dark else "black")
        names = [name.replace("-", "\n") for name in classes]
        ax.set(xticks=range(len(classes)), yticks=range(len(classes)), xticklabels=names, yticklabels=names)
        ax.set(xlabel="found", ylabel="true", title=f"{title}\naccuracy {np.mean(found == true):.2f} of {len(part)} records")

figure.savefig(folder / "python_classifier.png", dpi=100)
