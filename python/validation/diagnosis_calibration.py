"""Whether a diagnosis is right as often as it says, from the table that the example `calibration` wrote.

    cargo run --release -p meshtone-diagnose --example calibration -- examples/healthy.toml recording healthy calibration.csv
    python python/validation/diagnosis_calibration.py calibration.csv

Prints scores with 95 % intervals and draws reliability, ranks, coverage and detection.
"""

import csv
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from scipy.stats import chi2, rankdata

from meshtone.plotting import BLUE, ORANGE

#: Parts of the posterior between whose bounds the true severity falls, and how often it should.
BOUNDS = ("q05", "q25", "q50", "q75", "q95")
SHARES = np.array([0.05, 0.2, 0.25, 0.25, 0.2, 0.05])
#: Pairs of wheels that are tested by themselves, too: of many pairs smaller deviations are seen.
FIRST = 128
#: (-) Differences of speed and load from those of the healthy recording, up to which both are the same.
SAME_SPEED, SAME_LOAD = 2e-3, 0.03
#: Probability before anything is seen that the pair is healthy.
PRIOR_HEALTHY = 0.5

source = Path(sys.argv[1])
rows = list(csv.DictReader(source.open()))
kind = np.array([row["kind"] for row in rows])
healthy = kind == "healthy"
unit = np.array([int(row["unit"]) for row in rows])
severity = np.array([float(row["severity"]) for row in rows])
damaged = np.array([float(row["damaged"]) for row in rows])
outside = np.array([float(row["outside"]) for row in rows])
said = np.array([row["said"] for row in rows])
# As many healthy as damaged recordings, as the probabilities suppose.
weights = np.where(healthy, PRIOR_HEALTHY / healthy.mean(), (1 - PRIOR_HEALTHY) / (~healthy).mean())


def bootstrapped(score: Callable[[np.ndarray[Any, Any]], Any]) -> str:
    """A score of the recordings, with the 95 % interval of 1000 samples of pairs of wheels: those of one pair are not independent."""
    pairs = [np.flatnonzero(unit == one) for one in np.unique(unit)]
    draws = np.random.default_rng(1).integers(len(pairs), size=(1000, len(pairs)))
    values = [score(np.concatenate([pairs[place] for place in chosen])) for chosen in draws]
    low, high = np.nanquantile(values, [0.025, 0.975])
    return f"{score(np.arange(len(rows))):.3f} ({low:.3f} to {high:.3f})"


def share(of: np.ndarray[Any, Any], among: np.ndarray[Any, Any]) -> str:
    """A part of some recordings with its interval."""
    return bootstrapped(lambda chosen: np.mean(of[chosen][among[chosen]]))


def area(of: np.ndarray[Any, Any], among: np.ndarray[Any, Any]) -> float:
    """Area under the curve of the probability of damage, by which some recordings are told from others."""
    ranked = rankdata(np.concatenate([damaged[of], damaged[among]]))
    return float((ranked[: of.sum()].sum() - of.sum() * (of.sum() + 1) / 2) / (of.sum() * among.sum()))


def brier(chosen: np.ndarray[Any, Any]) -> Any:
    """Brier (1950) of the probability of damage."""
    return np.average((damaged[chosen] - ~healthy[chosen]) ** 2, weights=weights[chosen])


sized = ~healthy & (kind != "missing-tooth")
quantiles = np.array([[float(row[bound] or "nan") for bound in BOUNDS] for row in rows])
inside = [(quantiles[:, low] <= severity) & (severity <= quantiles[:, high]) for low, high in ((1, 3), (0, 4))]
places = (severity[sized, None] > quantiles[sized]).sum(axis=1)
ranks = np.bincount(places, minlength=6)


def rank_p_value(pairs: np.ndarray[Any, Any]) -> float:
    """Score test of flat ranks of some pairs of wheels, with the covariance between pairs: recordings of one pair are not independent."""
    beyond = np.eye(len(SHARES))[places] - SHARES
    # The last place follows from the others.
    of_pairs = np.array([beyond[unit[sized] == one, :-1].sum(axis=0) for one in pairs])
    total = of_pairs.sum(axis=0)
    return float(chi2.sf(total @ np.linalg.solve(of_pairs.T @ of_pairs, total), len(SHARES) - 1))


print(f"{len(rows)} recordings, {healthy.sum()} healthy")
print(f"Brier score of the probability of damage: {bootstrapped(brier)}; 0.25 knows nothing")
print(f"healthy called damaged: {share(damaged > 0.5, healthy)}")
print(f"severity within 50 %: {share(inside[0], sized)}, within 90 %: {share(inside[1], sized)}")
first = np.unique(unit)[:FIRST]
print(f"ranks flat: p = {rank_p_value(np.unique(unit)):.2f}, of the first {len(first)} pairs {rank_p_value(first):.2f}")
print(f"called outside (p < 0.05): healthy {share(outside < 0.05, healthy)}, damaged {share(outside < 0.05, ~healthy)}")
kinds = [name for name in dict.fromkeys(kind) if name != "healthy"]
large = ~healthy & (severity > 0.4)
apart = np.array([[abs(float(row[key])) for key in ("speed_ln", "load_ln")] for row in rows])
same = (apart < (SAME_SPEED, SAME_LOAD)).all(axis=1)
print(f"area under the curve, severity above 0.4: {area(large, healthy):.3f}, at the same speed and load {area(large & same, healthy & same):.3f}")
print("kind                 called damaged    the same, severity above 0.4    named rightly    50 %  90 %   detected from severity")
edges = np.linspace(0.0, 1.0, 6)
detection = {}
for name in kinds:
    of = kind == name
    large = of & (severity > 0.4)
    detection[name] = [np.mean(damaged[of & (severity > low) & (severity <= high)] > 0.5) if name != "missing-tooth" else 1.0 for low, high in zip(edges, edges[1:])]
    found = [edges[place] for place in range(5) if all(part >= 0.9 for part in detection[name][place:])]
    limit = f"{found[0]:.1f}" if found else "never"
    cover = "            " if name == "missing-tooth" else f"{inside[0][of].mean():.2f}  {inside[1][of].mean():.2f}"
    print(f"{name:18s} {np.mean(damaged[of] > 0.5):12.2f} {np.mean(damaged[large] > 0.5):20.2f} {np.mean(said[of] == name):24.2f} {'':8s} {cover}   {limit}")

figure, axes = plt.subplots(1, 3, figsize=(12, 4), layout="constrained")
bins = np.linspace(0, 1, 11)
for low, high in zip(bins, bins[1:]):
    within = (damaged >= low) & (damaged < high + (high == 1))
    if within.sum() >= 5:
        axes[0].plot(np.average(damaged[within], weights=weights[within]), np.average(~healthy[within], weights=weights[within]), "o", color=BLUE, markersize=3 + within.sum() ** 0.5 / 2)
axes[0].plot([0, 1], [0, 1], color="grey", linewidth=0.8)
axes[0].set(xlabel="Probability of damage, as stated (-)", ylabel="Part that is damaged (-)", title="Reliability (area: recordings)")
axes[1].bar(range(6), ranks / ranks.sum(), color=BLUE, label="found")
axes[1].hlines(SHARES, np.arange(6) - 0.45, np.arange(6) + 0.45, color=ORANGE, linewidth=2, label="expected")
axes[1].set_xticks(range(6), ["0–5", "5–25", "25–50", "50–75", "75–95", "95–100"], fontsize=8)
axes[1].set(xlabel="Where the true severity is in the posterior (%)", ylabel="Part of the recordings (-)", title="Ranks of the severity")
axes[1].legend(loc="upper left", fontsize="small")
axes[1].set_ylim(0, 0.33)
for name in kinds:
    if name != "missing-tooth":
        axes[2].plot((edges[1:] + edges[:-1]) / 2, detection[name], "o-", markersize=4, linewidth=1, label=name)
axes[2].set(xlabel="Severity (-)", ylabel="Called damaged (-)", ylim=(-0.03, 1.03), title="Detection")
axes[2].legend(fontsize="small", loc="center left", bbox_to_anchor=(1.0, 0.5))
for ax in axes:
    ax.grid(alpha=0.3)
folder = Path(sys.argv[2]) if len(sys.argv) > 2 else source.parent
figure.savefig(folder / "diagnosis_calibration.png", dpi=100)
