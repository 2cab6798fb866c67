"""Simulations tuned to the paper's three rigs.

Rms and kurtosis of the gear's difference signal in every state of each rig: what was measured (Figure 6 of arXiv:2410.05073), what the
simulation gives as it stands, and what it gives after tuning. Takes about a minute. Run it in the repository's folder.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt

import meshtone as mt
from meshtone.plotting import BLUE, ORANGE

SERIES = {"measured_median": ("measured", "black", "o"), "original": ("simulated", BLUE, "^"), "enhanced": ("tuned", ORANGE, "s")}


figure, grid = plt.subplots(2, 3, figsize=(11, 6.2), sharex="col", sharey="row", layout="constrained")
for column, name in zip(grid.T, ("breakage", "pitting", "destruction")):
    tuning = mt.tune(Path("examples", "experiments", f"{name}.toml"))
    cases = tuning.report["cases"]
    for ax, indicator in zip(column, ("rms", "kurtosis")):
        for key, (label, colour, marker) in SERIES.items():
            values = [10 ** case["indicators"][indicator][key] for case in cases]
            ax.plot(range(len(cases)), values, color=colour, marker=marker, markersize=5, linewidth=0.8, label=label)
        ax.set_yscale("log")
        ax.yaxis.set_major_formatter("{x:g}")
        ax.grid(alpha=0.3, which="both")
    error = tuning.error
    column[0].set_title(
        f"{name.capitalize()}\nmean error: {error['original']:.2f}, tuned {error['enhanced']:.2f}\n"
        f"(leaving one case out {error['leave_one_out']:.2f})",
        fontsize=10,
    )
    labels = [case["label"].removeprefix("chipped, ").removesuffix(" destroyed") for case in cases]
    column[1].set_xticks(range(len(cases)), labels, rotation=40, ha="right", rotation_mode="anchor", fontsize=9)
grid[0, 0].set_ylabel("Rms over that of\nthe healthy pair (-)")
grid[1, 0].set_ylabel("Kurtosis (-)")
grid[0, 0].legend(fontsize="small")
figure.savefig(Path(*sys.argv[1:2], "python_tuned_rigs.png"), dpi=100)
