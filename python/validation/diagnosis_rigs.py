"""What the paper's three rigs show about their damage, by two indicators, each case left out in turn.

Rms and kurtosis of the gear's difference signal were measured in every state of each rig (Figure 6 of arXiv:2410.05073). For every case
the simulations are brought to the rig by what the rig's *other* cases measured above them: their mean, and how far they scatter.
Then the case is asked: is it damaged, and how far has it come? Takes about a minute. Run it in the repository's folder.
"""

import sys
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from scipy.stats import spearmanr

import meshtone as mt
from meshtone.plotting import BLUE, ORANGE

sys.path.insert(0, str(Path(__file__).parent))
from rig_cases import RIGS, difference_of, experiment, indicators_of, measured, rig_with  # noqa: E402

#: Wheels that are simulated for every state.
WHEELS = 40
#: Probability, before anything is seen, that the gear is healthy.
PRIOR_HEALTHY = 0.5
#: Least standard deviation of log10 of an indicator: another day, another mounting.
LEAST_DEVIATION = 0.05


def between(first: Any, second: Any, part: float) -> Any:
    """A fault between two of one kind."""
    if isinstance(first, dict):
        return {key: between(first[key], second[key], part) for key in first}
    return first if isinstance(first, str) else (1 - part) * first + part * second


def states(stated: dict[str, Any], rig: str) -> list[tuple[float, Any]]:
    """Places along the case list, with the faults there; 0 is healthy."""
    faults = [case.get("fault") for case in stated["case"]]
    severity = rig_with(rig, faults[1]).fault_severities[0]
    places = [(0.0, None)] + [(part, {"kind": faults[1]["kind"], "severity": part * severity}) for part in (0.25, 0.5, 0.75)]
    for number, fault in enumerate(faults[1:], 1):
        places.append((float(number), fault))
        after = faults[number + 1] if number + 1 < len(faults) else None
        if after is not None and after["kind"] == fault["kind"]:
            places.append((number + 0.5, between(fault, after, 0.5)))
    if faults[-1]["kind"] == faults[-2]["kind"]:
        # Nothing says that the largest measured damage is the largest there is.
        for beyond in (0.5, 1.0):
            fault = between(faults[-2], faults[-1], 1 + beyond)
            if "end" in fault:
                fault["end"] = min(fault["end"], 1.0)  # the flank's
            places.append((len(faults) - 1 + beyond, fault))
    return places


def simulated(rig: str, places: list[tuple[float, Any]], rate_hz: float) -> np.ndarray[Any, Any]:
    """log10 of rms and kurtosis over those of the same wheels without damage: (place, wheels, indicator)."""
    draws = np.random.default_rng(1)
    wheels = [
        {"seed": seed, "tip_chamfer_mm": draws.uniform(0.3, 0.9), "brake_torque_factor": draws.uniform(0.9, 1.1)}
        for seed in range(1, WHEELS + 1)
    ]
    scenarios = []
    for _, fault in places:
        scenario = rig_with(rig, fault)
        torque = scenario.brake_torque_nm
        for wheel in wheels:
            own = dict(wheel)
            scenarios.append(scenario.copy(brake_torque_nm=torque * own.pop("brake_torque_factor"), **own))
    results = mt.simulate_many(scenarios, channels=["vertical_g"], target_rate_hz=rate_hz)
    values = [indicators_of(difference_of(scenario, signals)) for scenario, signals in zip(scenarios, results)]
    logs: np.ndarray[Any, Any] = np.array(values).reshape(len(places), WHEELS, 2)
    related: np.ndarray[Any, Any] = logs - logs[0]
    return related


def related_to_healthy(records: list[list[Any]]) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """(case, indicator): median of log10 over the records, over the healthy case's; and the healthy case's deviation.

    Of the healthy records every other one is what all is related to, and the rest is the case that is asked.
    """
    related = np.array([np.median(indicator[::2]) for indicator in records[0]])
    healthy = [np.median(indicator[1::2]) for indicator in records[0]]
    damaged = [[np.median(indicator) for indicator in case] for case in records[1:]]
    scatter = np.array([indicator.std() for indicator in records[0]])
    return np.array([healthy, *damaged]) - related, np.maximum(scatter, LEAST_DEVIATION)


def quantile(places: np.ndarray[Any, Any], weights: np.ndarray[Any, Any], part: float) -> float:
    """The first place up to which so much of the weight lies."""
    total = np.cumsum(weights)
    return float(places[np.searchsorted(total, part * total[-1])])


def ask(
    case: int,
    seen: np.ndarray[Any, Any],
    scatter: np.ndarray[Any, Any],
    places: list[float],
    simulations: np.ndarray[Any, Any],
) -> tuple[float, list[float]]:
    """Probability of damage, and place along the case list, of a case that is left out."""
    means, deviations = simulations.mean(axis=1), simulations.std(axis=1)
    others = [other for other in range(1, len(seen)) if other != case]
    at = [places.index(float(other)) for other in others]
    beyond = np.array([seen[other] - means[place] for other, place in zip(others, at)])
    # How the rig differs from the simulations grows with the damage: none at the healthy case, which both are related to.
    bias, spread = beyond.mean(axis=0), np.maximum(beyond.std(axis=0, ddof=1), LEAST_DEVIATION)
    logged = []
    for place, mean, deviation in zip(places, means, deviations):
        grown = min(place, 1.0)
        variance = scatter**2 + deviation**2 + (grown * spread) ** 2 * (1 + 1 / len(others))
        logged.append(-0.5 * np.sum((seen[case] - mean - grown * bias) ** 2 / variance + np.log(variance)))
    logs = np.array(logged)
    likelihood = np.exp(logs - logs.max())
    damaged = np.array(places) > 0
    weights = np.gradient(np.array(places)[damaged])
    evidence = np.sum(likelihood[damaged] * weights) / weights.sum() * (1 - PRIOR_HEALTHY)
    probability = evidence / (evidence + PRIOR_HEALTHY * likelihood[0])
    return probability, [quantile(np.array(places)[damaged], likelihood[damaged] * weights, part) for part in (0.05, 0.5, 0.95)]


figure, axes = plt.subplots(1, 3, figsize=(11, 3.8), layout="constrained")
print("rig          case                       damaged  median  90 % interval  holds it")
for ax, name in zip(axes, RIGS):
    stated, rig = experiment(name)
    steps = states(stated, rig)
    places = [place for place, _ in steps]
    seen, scatter = related_to_healthy(measured(name))
    simulations = simulated(rig, steps, stated["signal"]["sampling_rate_hz"])
    answers = [ask(case, seen, scatter, places, simulations) for case in range(len(seen))]
    for case, (probability, (low, middle, high)) in enumerate(answers):
        held = "" if case == 0 else "yes" if low <= case <= high else "no"
        print(f"{name:12s} {stated['case'][case]['label']:26s} {probability:7.3f} {middle:7.2f}  {low:5.2f} – {high:4.2f}   {held}")
    expected = [probability * middle for probability, (_, middle, _) in answers]
    correlation = spearmanr(expected, np.arange(len(expected))).statistic
    holds = np.mean([low <= case <= high for case, (_, (low, _, high)) in enumerate(answers) if case])
    print(f"{name:12s} rank correlation {correlation:.2f}, the 90 % interval holds {holds:.0%} of the damaged cases\n")
    cases = np.arange(len(answers))
    lows, middles, highs = np.array([interval for _, interval in answers]).T
    said = [probability for probability, _ in answers]
    ax.plot(cases, cases, color="grey", linewidth=0.8, label="true")
    ax.errorbar(cases[1:], middles[1:], [(middles - lows)[1:], (highs - middles)[1:]], fmt="o", color=BLUE, label="median, 90 %")
    for at, value in zip(cases, said):
        ax.annotate(f"{value:.2f}", (at, -0.9), ha="center", fontsize=8, color=ORANGE)
    labels = [case["label"].removeprefix("chipped, ").removesuffix(" destroyed") for case in stated["case"]]
    ax.set_xticks(cases, labels, rotation=40, ha="right", rotation_mode="anchor", fontsize=9)
    ax.set_ylim(-1.2, places[-1] + 0.5)
    ax.set_title(f"{name.capitalize()}: rank correlation {correlation:.2f}", fontsize=10)
    ax.grid(alpha=0.3)
axes[0].set_ylabel("Number of the case (-)\nbelow: probability of damage (-)")
axes[0].legend(fontsize="small", loc="upper left")
figure.savefig(Path(*sys.argv[1:2], "diagnosis_rigs.png"), dpi=100)
