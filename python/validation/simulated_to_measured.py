"""Learnt from simulations, asked about measurements: are the paper's rigs damaged, and how badly?

For each rig of Figure 6 of arXiv:2410.05073 a data set is simulated from what a rig's owner knows: teeth, face width, speed, load, grade.
What nobody states (structure, damping, chamfer, the wheels' deviations) is drawn over the ranges of the rig's experiment file, machine by
machine; load, support and noise vary from record to record. The damages
have the sizes of the rig's own cases. Models learn from these records alone, and are asked about the measured ones.

* *Rig data only*: they learn from all machines.
* *Tuned*: from the tenth of the machines that comes nearest to what the rig's *other* damaged cases measured. The case that is asked, and
  the healthy records beside it, have no part in that.

All is related to healthy: of the measured healthy records every other one is the reference, and only the rest is asked. A measured record's
two indicators cannot be paired, so that each is asked alone, and both only of a case's medians. Takes some three minutes. Run it in the
repository's folder; it needs scikit-learn and matplotlib.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from scipy.stats import rankdata, spearmanr
from sklearn.linear_model import LinearRegression, LogisticRegression
from sklearn.neighbors import KNeighborsClassifier, KNeighborsRegressor
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

import meshtone as mt
from meshtone.plotting import BLUE, ORANGE

sys.path.insert(0, str(Path(__file__).parent))
from rig_cases import INDICATORS, RIGS, Values, difference_of, experiment, indicators_of, measured, rig_with  # noqa: E402

MACHINES = 120
#: Part of them that is taken for like the rig.
NEAREST = 0.1
#: Healthy records of a machine that its records are related to, and that models learn from.
REFERENCE, HEALTHY = 3, 3
#: What a record's load and its support's stiffness are multiplied by, and its ratio of signal to noise.
LOAD, SUPPORT, SNR_DB = (0.95, 1.05), (0.92, 1.09), (20.0, 40.0)
DRAWS = 200
VIEWS = {"rms": [0], "kurtosis": [1], "both": [0, 1]}
MODELS = {
    "linear": (lambda: LogisticRegression(class_weight="balanced"), LinearRegression),
    "neighbours": (lambda: KNeighborsClassifier(15), lambda: KNeighborsRegressor(15)),
}


def machine(stated: dict[str, Any], draw: np.random.Generator) -> dict[str, Any]:
    """What is not known of a rig: one draw of what its experiment file tunes."""
    drawn: dict[str, Any] = {}
    for key in stated["tune"]["key"]:
        if key["key"] == "seed":
            drawn["seed"] = int(draw.integers(1, 2**31))
        elif key.get("logarithmic"):
            drawn[key["key"]] = float(np.exp(draw.uniform(np.log(key["least"]), np.log(key["largest"]))))
        else:
            drawn[key["key"]] = float(draw.uniform(key["least"], key["largest"]))
    return drawn


def simulated(stated: dict[str, Any], rig: str) -> tuple[Values, Values]:
    """log10 of indicators over the machine's healthy ones: healthy (machine, record, indicator), and damaged (machine, case, indicator)."""
    draw = np.random.default_rng(17)
    faults = [None] * (REFERENCE + HEALTHY) + [case["fault"] for case in stated["case"][1:]]
    torque = rig_with(rig, None).brake_torque_nm
    scenarios, snr_db = [], []
    for _ in range(MACHINES):
        own = machine(stated, draw)
        for fault in faults:
            record = dict(own)
            record["operation.brake_torque_nm"] = torque * float(draw.uniform(*LOAD))
            record["rig.support.base_hz"] *= float(np.exp(draw.uniform(*np.log(SUPPORT))))
            scenarios.append(rig_with(rig, fault, record))
            snr_db.append(draw.uniform(*SNR_DB))
    values = []
    results = mt.simulate_many(scenarios, channels=["vertical_g"], target_rate_hz=stated["signal"]["sampling_rate_hz"], progress=True)
    for scenario, signals, ratio in zip(scenarios, results, snr_db):
        deviation = float(signals.vertical_g.std()) * 10 ** (-ratio / 20)
        noise = draw.normal(0.0, deviation, 2 * len(signals.vertical_g))
        values.append(indicators_of(difference_of(scenario, signals, noise)))
    logs = np.array(values).reshape(MACHINES, len(faults), 2)
    related = logs - np.median(logs[:, :REFERENCE], axis=1, keepdims=True)
    return related[:, REFERENCE : REFERENCE + HEALTHY], related[:, REFERENCE + HEALTHY :]


def asked(name: str) -> list[list[Values]]:
    """Measured records by case and indicator, over the median of the healthy ones that are the reference and are not asked."""
    records = measured(name)
    reference = [np.median(indicator[::2]) for indicator in records[0]]
    records[0] = [indicator[1::2] for indicator in records[0]]
    return [[values - middle for values, middle in zip(case, reference)] for case in records]


def chosen(damaged: Values, medians: Values, left_out: int | None) -> np.ndarray[Any, Any]:
    """Machines to learn from: all, or the nearest to what cases other than one measured."""
    if left_out is None:
        return np.arange(MACHINES)
    others = [case for case in range(len(medians)) if case != left_out]
    apart = np.mean((damaged[:, others] - medians[others]) ** 2, axis=(1, 2))
    return np.argsort(apart)[: round(NEAREST * MACHINES)]


class Learnt:
    """A model of damaged or not, and one of the number of the case, of some indicators."""

    def __init__(self, model: str, view: list[int], healthy: Values, damaged: Values) -> None:
        cases = damaged.shape[1]
        inputs = np.vstack([healthy.reshape(-1, 2), damaged.reshape(-1, 2)])[:, view]
        numbers = np.concatenate([np.zeros(healthy[..., 0].size), np.tile(np.arange(1, cases + 1), len(damaged))])
        classifier, regressor = (make_pipeline(StandardScaler(), make()) for make in MODELS[model])
        # As many healthy as damaged ones: neighbours know no weights.
        sound = np.flatnonzero(numbers == 0)
        again = np.resize(sound, np.count_nonzero(numbers))
        balanced = np.concatenate([again, np.flatnonzero(numbers)])
        self.classifier = classifier.fit(inputs[balanced], numbers[balanced] > 0)
        self.regressor = regressor.fit(inputs[balanced], numbers[balanced])

    def probability(self, inputs: Values) -> Values:
        answer: Values = self.classifier.predict_proba(inputs)[:, 1]
        return answer

    def number(self, inputs: Values) -> Values:
        answer: Values = self.regressor.predict(inputs)
        return answer


def answers(model: str, view: list[int], data: tuple[Values, Values], records: list[list[Values]], tuned: bool) -> list[list[Values]]:
    """Of each damaged case, by models that it has no part in: probability and number, of the healthy records and of its own.

    Of two indicators together the medians of resampled records, for their records cannot be paired.
    """
    healthy, damaged = data
    draw = np.random.default_rng(3)

    def inputs(case: int) -> Values:
        if len(view) == 1:
            return records[case][view[0]][:, None]
        resampled = [[np.median(draw.choice(values, len(values))) for values in records[case]] for _ in range(DRAWS)]
        return np.array(resampled)

    asked_of = [inputs(case) for case in range(len(records))]
    medians = np.array([[np.median(values) for values in case] for case in records[1:]])
    found = []
    for case in range(len(medians)):
        machines = chosen(damaged, medians, case if tuned else None)
        learnt = Learnt(model, view, healthy[machines], damaged[machines])
        found.append([of(part) for of in (learnt.probability, learnt.number) for part in (asked_of[0], asked_of[case + 1])])
    return found


def area(sound: Values, damaged: Values) -> float:
    """Of how many pairs of a healthy and a damaged record the damaged one is called likelier to be so; ties count half."""
    ranks = rankdata(np.concatenate([sound, damaged]))[len(sound) :]
    return float((ranks.mean() - (len(damaged) + 1) / 2) / len(sound))


def scores(found: list[list[Values]], draw: np.random.Generator | None) -> list[float]:
    """AUC, balanced accuracy, false alarms, rank correlation; of all records, or of some drawn with replacement."""

    def drawn(*values: Values) -> list[Values]:
        if draw is None:
            return list(values)
        places = draw.integers(len(values[0]), size=len(values[0]))
        return [value[places] for value in values]

    areas, alarms, hits, numbers, cases = [], [], [], [], []
    for case, (sound, damaged, sound_number, number) in enumerate(found, 1):
        sound, sound_number = drawn(sound, sound_number)
        damaged, number = drawn(damaged, number)
        areas.append(area(sound, damaged))
        alarms.append(np.mean(sound > 0.5))
        hits.append(np.mean(damaged > 0.5))
        # Each case weighs as much as another, whatever its records: its median stands for it.
        numbers += [np.median(number)]
        cases += [case]
        if case == 1:
            numbers, cases = [np.median(sound_number), *numbers], [0, *cases]
    rank = 0.0 if np.ptp(numbers) == 0 else spearmanr(numbers, cases).statistic
    false, true = float(np.mean(alarms)), float(np.mean(hits))
    return [float(np.mean(areas)), (true + 1 - false) / 2, false, true, float(rank)]


def shown(found: list[list[Values]], medians_only: bool) -> list[str]:
    """Scores with 90 % intervals; where medians are asked they are resampled already, and an area means nothing."""
    draws = np.array([scores(found, np.random.default_rng([5, number])) for number in range(DRAWS)])
    ends = np.quantile(draws, [0.05, 0.95], axis=0)
    texts = [f"{value:.2f} ({low:.2f} to {high:.2f})" for value, low, high in zip(scores(found, None), *ends)]
    return ["–", *texts[1:]] if medians_only else texts


def draw_rig(axes: Any, name: str, stated: dict[str, Any], data: tuple[Values, Values], records: list[list[Values]]) -> None:
    """Where simulated machines, those that are near, and measured medians lie, case by case."""
    medians = np.array([[np.median(values) for values in case] for case in records])
    healthy, damaged = data
    near = chosen(damaged, medians[1:], -1)
    for row, indicator in enumerate(INDICATORS):
        for machines, colour, label in ((np.arange(MACHINES), "grey", "rig data only"), (near, BLUE, "nearest tenth, to all cases")):
            values = [healthy[machines, :, row].ravel(), *damaged[machines, :, row].T]
            low, middle, high = np.array([np.quantile(of, [0.05, 0.5, 0.95]) for of in values]).T
            axes[row].fill_between(range(len(values)), low, high, color=colour, alpha=0.25, lw=0, label=f"{label}, 90 %")
            axes[row].plot(middle, color=colour, lw=1)
        spread = np.array([np.quantile(case[row], [0.05, 0.5, 0.95]) for case in records]).T
        axes[row].errorbar(range(len(records)), spread[1], np.abs(spread[[0, 2]] - spread[1]), fmt="o", color=ORANGE, label="measured, 90 %")
        axes[row].grid(alpha=0.3)
    axes[0].set_title(name.capitalize(), fontsize=10)
    labels = [case["label"].removeprefix("chipped, ").removesuffix(" destroyed") for case in stated["case"]]
    axes[1].set_xticks(range(len(labels)), labels, rotation=40, ha="right", rotation_mode="anchor", fontsize=8)


def main() -> None:
    figure, axes = plt.subplots(2, 3, figsize=(11, 6), layout="constrained", sharex="col")
    print("| rig | learnt from | model | indicator | AUC | balanced accuracy | false alarms | found | rank correlation |")
    print("|---|---|---|---|---|---|---|---|---|")
    by_case = []
    for column, name in enumerate(RIGS):
        stated, rig = experiment(name)
        records, data = asked(name), simulated(stated, rig)
        for tuned in (False, True):
            learnt_from = "tuned" if tuned else "rig data only"
            for model in MODELS:
                for view, places in VIEWS.items():
                    found = answers(model, places, data, records, tuned)
                    print(f"| {name} | {learnt_from} | {model} | {view} | {' | '.join(shown(found, view == 'both'))} |", flush=True)
                    hits = ", ".join(f"{np.mean(damaged > 0.5):.2f}" for _, damaged, _, _ in found)
                    by_case.append(f"{name}, {learnt_from}, {model}, {view}: {hits}")
        draw_rig(axes[:, column], name, stated, data, records)
    print("\nPart of each damaged case's records, or of its resampled medians, that is called damaged:\n" + "\n".join(by_case))
    axes[0, 0].set_ylabel("log10 of rms over healthy (-)")
    axes[1, 0].set_ylabel("log10 of kurtosis over healthy (-)")
    axes[0, 0].legend(fontsize="small", loc="upper left")
    figure.savefig(Path(*sys.argv[1:2], "simulated_to_measured.png"), dpi=100)


if __name__ == "__main__":
    main()
