"""Looks closely at a data set's questions: shortcuts, kinds, severities, noise and more models than the baselines of `meshtone.benchmark`.

    pip install 'meshtone[datasets,tables,plot]' scikit-learn   # aeon for random kernels, torch for the network: left out without
    python score.py pairs-1 -o scores                # scores.json, scores.md and three figures
    python score.py pairs-1 -o scores --check        # exit code 1 where the bounds of a fair question do not hold

Every model is trained on the split `train`, what draws with five seeds, and scored on `test`. Intervals hold 90 % of what one training scores
where the test split's units (a bootstrap: records of one unit are no independent witnesses) and the seed are drawn. What a model answered is
kept in `scores/runs` for this data set, script and libraries: a long scoring that was stopped goes on where it was.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import sys
import zipfile
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import NoReturn

import numpy as np
import pandas as pd
from sklearn.dummy import DummyClassifier
from sklearn.ensemble import HistGradientBoostingRegressor
from sklearn.impute import SimpleImputer
from sklearn.linear_model import RidgeClassifierCV
from sklearn.metrics import roc_curve
from sklearn.model_selection import GridSearchCV, GroupKFold
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVC

import meshtone as mt
from meshtone.benchmark.baselines import CLASSIFIERS
from meshtone.benchmark.measures import QUANTILES, auc, mean_recall

# What is known of a machine without looking at its vibration.
CONDITIONS = ["pinion_speed_hz", "brake_torque_nm", "pinion_teeth", "gear_teeth", "module_mm", "face_width_mm"]
PARTS = ("average_", "regular_", "residual_", "difference_", "envelope_")
GEAR = ["fm0", "fm4", "m6a", "m8a", "na4", "energy_ratio", "sideband_level_factor"]
ORDERS = "mesh_harmonic_"
DRAWS = 400

# The question is fair where a method can win on merit: neither hopeless nor solved, and nothing but the vibration shows it.
BOUNDS = {"detection": (0.85, 0.97), "diagnosis": (0.6, 0.9), "kind at its largest severity": (0.75, 1.0), "healthy twin": (0.0, 0.6)}


class Records:
    """The records of a split, as models take them."""

    def __init__(self, table: pd.DataFrame, signals: np.ndarray, indicators: list[str], orders: list[str]) -> None:
        self.table, self.signals = table, signals
        self.labels = table["label"].to_numpy(str)
        self.damaged = (self.labels != "healthy").astype(int)
        self.severity = table["fault_severity"].fillna(0.0).to_numpy()
        self.grades = table["severity"].to_numpy(int)
        self.units = table["unit"].to_numpy()
        conditions = table[[name for name in CONDITIONS if name in table]].to_numpy(float)
        self.conditions = np.log(conditions)
        # Indicators span decades; a skewness may be negative, and 0 is no logarithm.
        self.indicators = np.hstack([np.arcsinh(100.0 * table[indicators].to_numpy(float)), self.conditions])
        self.features = np.hstack([self.indicators, np.arcsinh(100.0 * table[orders].to_numpy(float))])


def records(dataset: mt.Dataset) -> tuple[Records, Records]:
    # Octaves beyond half the sampling rate are null in all records.
    present = [name for name in dataset.scalar_columns if name not in dataset.empty_columns]
    indicators = [name for name in present if name.startswith(PARTS) or name in GEAR]
    orders = [name for name in present if name.startswith(ORDERS)]

    def of(split: str) -> Records:
        part = dataset.split(split)
        signals, _ = part.arrays(["average_g", "difference_g"])
        return Records(part.to_pandas(), signals, indicators, orders)

    return of("train"), of("test")


def scaled(signals: np.ndarray) -> np.ndarray:
    """Signals over their rms, and its logarithm as one more channel: sizes vary over decades."""
    size = np.sqrt(np.mean(signals**2, axis=2, keepdims=True)) + 1e-12
    level = np.repeat(np.log10(size), signals.shape[2], axis=2)
    return np.concatenate([signals / size, level], axis=1).astype(np.float32)


def shares(margin: np.ndarray) -> np.ndarray:
    """What adds up to 1 and is in the margins' order: of a model that gives no probabilities."""
    margin = np.stack([-margin, margin], axis=1) if margin.ndim == 1 else margin
    odds = np.exp(margin - margin.max(axis=1, keepdims=True))
    return odds / odds.sum(axis=1, keepdims=True)


class OnIndicators:
    """A scikit-learn classifier on the indicators without the order features."""

    def __init__(self, make: Callable[[int], object]) -> None:
        self.make = make

    def probabilities(self, train: Records, target: np.ndarray, test: Records, seed: int) -> np.ndarray:
        return self.make(seed).fit(train.indicators, target).predict_proba(test.indicators)


class OnFeatures:
    """A scikit-learn classifier on the indicators and the order features."""

    def __init__(self, make: Callable[[int], object]) -> None:
        self.make = make

    def probabilities(self, train: Records, target: np.ndarray, test: Records, seed: int) -> np.ndarray:
        return self.make(seed).fit(train.features, target).predict_proba(test.features)


class SupportVectors:
    """Support vectors on the indicators and the order features; the penalty is the best of fifths of the training's units that are left out."""

    def probabilities(self, train: Records, target: np.ndarray, test: Records, seed: int) -> np.ndarray:
        machine = make_pipeline(SimpleImputer(keep_empty_features=True), StandardScaler(), SVC(class_weight="balanced"))
        penalties = {"svc__C": [1.0, 3.0, 10.0, 30.0]}
        scoring = "roc_auc" if target.max() == 1 else "balanced_accuracy"
        parts = GroupKFold(min(5, len(np.unique(train.units))))
        search = GridSearchCV(machine, penalties, scoring=scoring, cv=parts, n_jobs=-1)
        search.fit(train.features, target, groups=train.units)
        print(f"    best by {scoring}: C = {search.best_params_['svc__C']:g} of {penalties['svc__C']}", file=sys.stderr)
        return shares(search.decision_function(test.features))


class RandomKernels:
    """MiniRocket (Dempster, Schmidt and Webb 2021) on averages, and a ridge classifier."""

    def probabilities(self, train: Records, target: np.ndarray, test: Records, seed: int) -> np.ndarray:
        from aeon.transformations.collection.convolution_based import MiniRocket

        kernels = MiniRocket(random_state=seed).fit(scaled(train.signals))
        inputs = [np.hstack([np.asarray(kernels.transform(scaled(part.signals))), part.features]) for part in (train, test)]
        inputs = [SimpleImputer(keep_empty_features=True).fit(inputs[0]).transform(part) for part in inputs]
        scaler = StandardScaler().fit(inputs[0])
        ridge = RidgeClassifierCV(alphas=np.logspace(0, 5, 11), class_weight="balanced")
        ridge.fit(scaler.transform(inputs[0]), target)
        return shares(ridge.decision_function(scaler.transform(inputs[1])))


class Network:
    """Three convolutions and a mean over the angle: no tooth is the first."""

    def probabilities(self, train: Records, target: np.ndarray, test: Records, seed: int) -> np.ndarray:
        import torch
        from torch import nn

        torch.manual_seed(seed)
        device = "cuda" if torch.cuda.is_available() else "cpu"
        channels = 2 * train.signals.shape[1]
        classes = int(target.max()) + 1

        def stage(inputs: int, outputs: int, width: int) -> list[nn.Module]:
            ring = nn.Conv1d(inputs, outputs, width, padding=width // 2, padding_mode="circular")
            return [ring, nn.BatchNorm1d(outputs), nn.ReLU(), nn.MaxPool1d(4)]

        network = nn.Sequential(
            *stage(channels, 24, 15), *stage(24, 48, 9), *stage(48, 64, 5),
            nn.AdaptiveMaxPool1d(1), nn.Flatten(), nn.Dropout(0.2), nn.Linear(64, classes),
        ).to(device)  # fmt: skip
        inputs = torch.from_numpy(scaled(train.signals)).to(device)
        answers = torch.from_numpy(target.astype(np.int64)).to(device)
        weights = len(target) / (classes * np.bincount(target, minlength=classes))
        loss = nn.CrossEntropyLoss(weight=torch.tensor(weights, dtype=torch.float32, device=device))
        optimiser = torch.optim.AdamW(network.parameters(), lr=2e-3, weight_decay=1e-3)
        epochs, batch = 30, 64
        schedule = torch.optim.lr_scheduler.OneCycleLR(
            optimiser, 4e-3, total_steps=epochs * -(-len(target) // batch)
        )
        for _ in range(epochs):
            for chosen in torch.randperm(len(target)).split(batch):
                turned = torch.roll(inputs[chosen], int(torch.randint(inputs.shape[2], ())), 2)
                optimiser.zero_grad()
                loss(network(turned), answers[chosen]).backward()
                optimiser.step()
                schedule.step()
        network.eval()
        with torch.no_grad():
            return torch.softmax(network(torch.from_numpy(scaled(test.signals)).to(device)), 1).cpu().numpy()


class NetworkAndBoosting:
    """The mean of what the network and gradient boosting on the indicators and the order features answer."""

    def probabilities(self, train: Records, target: np.ndarray, test: Records, seed: int) -> np.ndarray:
        models = (Network(), OnFeatures(boosting))
        return np.mean([model.probabilities(train, target, test, seed) for model in models], axis=0)


def logistic(seed: int) -> object:
    return CLASSIFIERS["logistic regression"]()


def boosting(seed: int) -> object:
    return CLASSIFIERS["gradient boosting"]().set_params(random_state=seed)


MODELS = {
    "constant": (OnFeatures(lambda seed: DummyClassifier(strategy="prior")), None),
    "logistic regression": (OnFeatures(logistic), None),
    "support vectors": (SupportVectors(), None),
    "gradient boosting without order features": (OnIndicators(boosting), None),
    "gradient boosting": (OnFeatures(boosting), None),
    "random kernels": (RandomKernels(), "aeon"),
    "network": (Network(), "torch"),
    "network and gradient boosting": (NetworkAndBoosting(), "torch"),
}

# What a seed changes.
DRAWN = ("random kernels", "network", "network and gradient boosting")


def resampled(units: np.ndarray, seed: int) -> np.ndarray:
    """Records of units that are drawn with replacement."""
    draw = np.random.default_rng([2024, seed])
    names, numbers = np.unique(units, return_inverse=True)
    of_unit = [np.flatnonzero(numbers == number) for number in range(len(names))]
    return np.concatenate([of_unit[number] for number in draw.integers(len(names), size=len(names))])


def interval(scores: list[Callable[[np.ndarray], float]], units: np.ndarray) -> list[float]:
    """The score of all records, of several seeds their mean, and the 90 % interval of one training on units and by a seed that are drawn."""
    drawn = np.array([scores[draw % len(scores)](resampled(units, draw)) for draw in range(max(DRAWS, len(scores)))])
    ends = np.nanquantile(drawn, [0.05, 0.95])
    of_all = np.mean([score(np.arange(len(units))) for score in scores])
    return [round(float(value), 3) for value in (of_all, *ends)]


def detection(test: Records, runs: list[np.ndarray]) -> dict[str, object]:
    """Of all damaged records, at each level of noise, of each kind, in each grade of severity; and the limit of each kind."""
    healthy = test.damaged == 0
    alarms = [np.quantile(run[healthy], 0.95) for run in runs]

    def scores_of(chosen: np.ndarray) -> list[Callable[[np.ndarray], float]]:
        return [lambda i, run=run: auc(test.damaged[i][chosen[i]], run[i][chosen[i]]) for run in runs]

    kinds = {}
    everything = np.arange(len(test.labels))
    for label in sorted(set(test.labels) - {"healthy"}):
        of_kind = test.labels == label
        by_grade, limit = {}, None
        for grade in np.unique(test.grades[of_kind]):
            graded = of_kind & (test.grades == grade)
            by_grade[str(grade)] = round(float(np.mean([score(everything) for score in scores_of(healthy | graded)])), 3)
            found = np.mean([run[graded] > alarm for run, alarm in zip(runs, alarms, strict=True)])
            if limit is None and found >= 0.9:
                limit = round(float(test.severity[graded].min()), 2)
        kinds[label] = {"auc": interval(scores_of(healthy | of_kind), test.units), "auc by grade": by_grade, "found from severity": limit}
    by_noise = {name: interval(scores_of(chosen), test.units) for name, chosen in noise_levels(test).items()}
    return {"auc": interval(scores_of(np.ones(len(test.labels), bool)), test.units), "auc by noise": by_noise, "kinds": kinds}


def noise_levels(test: Records) -> dict[str, np.ndarray]:
    """Thirds of the records by their ratio of signal to noise, the noisiest first; none where the plan varies no such ratio."""
    if "noise_snr_db" not in test.table:
        return {}
    ratio = test.table["noise_snr_db"].to_numpy(float)
    ends = np.nanquantile(ratio, [0.0, 1 / 3, 2 / 3, 1.0])
    return {
        f"{low:.0f} to {high:.0f} dB": (ratio >= low) & ((ratio < high) | (high == ends[-1]))
        for low, high in zip(ends, ends[1:], strict=False)
    }


def severity(train: Records, test: Records, model: str) -> list[float]:
    """Continuous ranked probability score of the severity, from quantiles."""
    def predicted(quantile: float) -> np.ndarray:
        if model == "constant":
            return np.full(len(test.severity), np.quantile(train.severity, quantile))
        machine = HistGradientBoostingRegressor(loss="quantile", quantile=quantile, max_iter=100, random_state=0)
        return machine.fit(train.features, train.severity).predict(test.features)

    off = [test.severity - predicted(quantile) for quantile in QUANTILES]
    # Twice the mean pinball loss over the quantiles.
    losses = 2.0 * np.mean([np.maximum(q * e, (q - 1.0) * e) for q, e in zip(QUANTILES, off, strict=True)], axis=0)
    return interval([lambda i: float(np.mean(losses[i]))], test.units)


def shortcuts(train: Records, test: Records) -> dict[str, list[float]]:
    """What reveals damage where a data set is posed badly: conditions, lengths, and how far a record is from a healthy one of its unit,
    which are twins where only noise is between them. The first two may be no better than chance, 0.5, by more than their intervals; the third
    a little, as damage changes an average, but not as twins would be, at 1.
    """
    def by(inputs: Callable[[Records], np.ndarray]) -> list[float]:
        probability = boosting(0).fit(inputs(train), train.damaged).predict_proba(inputs(test))[:, 1]
        return interval([lambda i: auc(test.damaged[i], probability[i])], test.units)

    def length(part: Records) -> np.ndarray:
        return part.table[["simulated_s", "sampling_rate_hz"]].to_numpy(float)

    def twin(part: Records) -> np.ndarray:
        """How far the average is from that of the unit's healthy record nearest in speed and load."""
        far = np.full(len(part.labels), np.nan)
        averages = part.signals[:, 0]
        for unit in np.unique(part.units):
            of_unit = np.flatnonzero(part.units == unit)
            healthy = of_unit[part.damaged[of_unit] == 0]
            for record in of_unit:
                others = healthy[healthy != record]
                if len(others):
                    apart = np.sum((part.conditions[others, :2] - part.conditions[record, :2]) ** 2, axis=1)
                    other = averages[others[np.argmin(apart)]]
                    size = np.sqrt(np.mean(averages[record] ** 2) + np.mean(other**2))
                    far[record] = np.sqrt(np.mean((averages[record] - other) ** 2)) / size
        return far[:, None]

    return {"conditions": by(lambda part: part.conditions), "length": by(length), "healthy twin": by(twin)}


def answers(name: str, seed: int, train: Records, test: Records, kept: Path) -> dict[str, np.ndarray]:
    """The probability of damage and the named kind of every test record, as kept or by training."""
    file = kept / f"{name.replace(' ', '-')}-{seed}.npz"
    if file.exists():
        try:
            earlier = dict(np.load(file))
            print(f"{name}, seed {seed}: as kept in {file}", file=sys.stderr)
            return earlier
        except (EOFError, OSError, ValueError, zipfile.BadZipFile):
            print(f"{name}, seed {seed}: {file} cannot be read and is made anew", file=sys.stderr)
    print(f"{name}, seed {seed}", file=sys.stderr)
    model, _ = MODELS[name]
    labels, numbers = np.unique(train.labels, return_inverse=True)
    trained = {
        "damaged": model.probabilities(train, train.damaged, test, seed)[:, 1],
        "label": labels[np.argmax(model.probabilities(train, numbers, test, seed), axis=1)],
    }
    kept.mkdir(parents=True, exist_ok=True)
    unfinished = file.with_suffix(f".{os.getpid()}.npz")
    np.savez(unfinished, **trained)
    unfinished.replace(file)
    return trained


def surroundings(dataset: mt.Dataset) -> dict[str, str]:
    """What an answer depends on: the data set, this script, the libraries."""
    versions = {"data set": dataset.manifest["sha256"], "script": hashlib.sha256(Path(__file__).read_bytes()).hexdigest()}
    for name in ("meshtone", "numpy", "scikit-learn", "aeon", "torch"):
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            continue
    return versions


def scores(train: Records, test: Records, models: list[str], seeds: int, kept: Path) -> tuple[dict, dict]:
    labels = np.unique(train.labels)
    result: dict = {"records": {"train": len(train.labels), "test": len(test.labels)}, "models": {}}
    probabilities = {}
    for name in models:
        runs = []
        try:
            for seed in range(seeds if name in DRAWN else 1):
                runs.append(answers(name, seed, train, test, kept))
        except ModuleNotFoundError:
            print(f"{name}: left out, for {MODELS[name][1]} is not installed", file=sys.stderr)
            continue
        damaged, kinds = [run["damaged"] for run in runs], [run["label"] for run in runs]
        single = [auc(test.damaged, run) for run in damaged]
        probabilities[name] = damaged[int(np.argsort(single)[len(single) // 2])]
        named = [lambda i, k=k: mean_recall(test.labels[i], test.labels[i] == k[i]) for k in kinds]
        result["models"][name] = {
            "detection": detection(test, damaged),
            "detection of all seeds": [round(float(value), 3) for value in single],
            "diagnosis": interval(named, test.units),
            "diagnosis of all seeds": [round(mean_recall(test.labels, test.labels == run), 3) for run in kinds],
            "recall": {
                str(label): round(float(np.mean([run[test.labels == label] == label for run in kinds])), 3) for label in labels
            },
        }
        print(f"{name}: detection {result['models'][name]['detection']['auc']}, diagnosis {result['models'][name]['diagnosis']}")
    result["severity crps"] = {name: severity(train, test, name) for name in ("constant", "gradient boosting")}
    result["shortcuts"] = shortcuts(train, test)
    return result, probabilities


def broken(result: dict) -> list[str]:
    """Where the bounds of a fair question do not hold."""
    found = []
    best = {key: max(model[key]["auc"][0] if key == "detection" else model[key][0] for model in result["models"].values()) for key in ("detection", "diagnosis")}
    for key, value in best.items():
        least, most = BOUNDS[key]
        if not least <= value <= most:
            found.append(f"best {key} {value} is not from {least} to {most}")
    name = max(result["models"], key=lambda name: result["models"][name]["detection"]["auc"][0])
    for kind, scores in result["models"][name]["detection"]["kinds"].items():
        grades = list(scores["auc by grade"].values())
        if grades[-1] < BOUNDS["kind at its largest severity"][0]:
            found.append(f"{kind} at its largest severity: {grades[-1]}")
        # So much is within what the records of a grade say.
        if any(after < before - 0.03 for before, after in zip(grades, grades[1:], strict=False)):
            found.append(f"{kind} is not monotonic in severity: {grades}")
    for shortcut, (value, least, _) in result["shortcuts"].items():
        holds = value <= BOUNDS[shortcut][1] if shortcut in BOUNDS else least <= 0.5
        if not holds:
            found.append(f"shortcut {shortcut}: {value}, from {least} on")
    return found


def table(result: dict) -> str:
    lines = ["| model | detection, AUC | diagnosis, mean recall |", "|---|---:|---:|"]
    shown = "{0[0]:.3f} ({0[1]:.3f} to {0[2]:.3f})"
    for name, model in result["models"].items():
        lines.append(f"| {name} | {shown.format(model['detection']['auc'])} | {shown.format(model['diagnosis'])} |")
    best = max(result["models"], key=lambda name: result["models"][name]["detection"]["auc"][0])
    lines += ["", f"Of {best}:", "", "| kind | AUC | by grade of severity | 90 % found from | named rightly |", "|---|---:|---|---:|---:|"]
    for kind, scores in result["models"][best]["detection"]["kinds"].items():
        grades = ", ".join(f"{value:.2f}" for value in scores["auc by grade"].values())
        limit = "-" if scores["found from severity"] is None else scores["found from severity"]
        lines.append(f"| {kind} | {shown.format(scores['auc'])} | {grades} | {limit} | {result['models'][best]['recall'][kind]:.2f} |")
    if by_noise := result["models"][best]["detection"]["auc by noise"]:
        lines += ["", "| signal to noise | AUC |", "|---|---:|"]
        lines += [f"| {name} | {shown.format(value)} |" for name, value in by_noise.items()]
    lines += ["", "| severity | CRPS |", "|---|---:|"]
    lines += [f"| {name} | {shown.format(value)} |" for name, value in result["severity crps"].items()]
    lines += ["", "| shortcut | AUC |", "|---|---:|"]
    lines += [f"| {name} | {shown.format(value)} |" for name, value in result["shortcuts"].items()]
    return "\n".join(lines) + "\n"


def figures(test: Records, result: dict, probabilities: dict, folder: Path) -> None:
    import matplotlib

    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    best = max(result["models"], key=lambda name: result["models"][name]["detection"]["auc"][0])
    # Of the middle one of the seeds.
    probability = probabilities[best]
    kinds = result["models"][best]["detection"]["kinds"]
    colours = dict(zip(kinds, plt.get_cmap("tab10").colors, strict=False))
    healthy = test.damaged == 0

    figure, axes = plt.subplots(figsize=(5.5, 5), layout="constrained")
    for kind in kinds:
        chosen = healthy | (test.labels == kind)
        false, true, _ = roc_curve(test.damaged[chosen], probability[chosen])
        axes.plot(false, true, color=colours[kind], label=f"{kind}, {auc(test.damaged[chosen], probability[chosen]):.2f}")
    axes.plot([0, 1], [0, 1], ":", color="grey")
    axes.set(xlabel="false alarms, part of the healthy records", ylabel="found, part of the damaged records", title=f"Detection by {best}")
    axes.legend(title="kind, AUC", fontsize=8)
    figure.savefig(folder / "roc.png", dpi=130)
    plt.close(figure)

    figure, axes = plt.subplots(figsize=(6, 4.2), layout="constrained")
    for kind in kinds:
        grades = kinds[kind]["auc by grade"]
        of_grade = [np.median(test.severity[(test.labels == kind) & (test.grades == int(grade))]) for grade in grades]
        axes.plot(of_grade, list(grades.values()), "o-", color=colours[kind], label=kind)
    axes.axhline(0.5, ls=":", color="grey")
    worst = min(min(kind["auc by grade"].values()) for kind in kinds.values())
    axes.set(xlim=(0, 1), ylim=(min(0.4, worst - 0.02), 1.02), title=f"Detection over severity by {best}")
    axes.set(xlabel="severity, 1 the largest that the tooth allows", ylabel="AUC against healthy")
    axes.legend(fontsize=8, loc="lower right")
    figure.savefig(folder / "severity.png", dpi=130)
    plt.close(figure)

    shown = ["healthy", *kinds]
    figure, rows = plt.subplots(len(shown), 1, figsize=(7, 1.05 * len(shown)), sharex=True, layout="constrained")
    for axes, label in zip(np.atleast_1d(rows), shown, strict=True):
        of_kind = np.flatnonzero(test.labels == label)
        record = of_kind[np.argmax(test.severity[of_kind])]
        difference = test.signals[record, 1]
        axes.plot(np.linspace(0, 360, len(difference), endpoint=False), difference, lw=0.6, color=colours.get(label, "black"))
        severity = "" if label == "healthy" else f", severity {test.severity[record]:.2f}"
        speed, load = test.table.iloc[record][["pinion_speed_hz", "brake_torque_nm"]]
        axes.set_title(f"{label}{severity}, {speed:.0f} Hz, {load:.0f} N m", fontsize=8, loc="left", pad=2)
        axes.margins(x=0)
    axes.set_xlabel("angle of the gear, °")
    figure.supylabel("difference signal, g", fontsize=9)
    figure.savefig(folder / "examples.png", dpi=130)
    plt.close(figure)


def opened(path: Path, refuse: Callable[[str], NoReturn]) -> tuple[mt.Dataset, Records, Records]:
    """A data set with what is learnt from and what is asked; `refuse` reports what keeps one from being scored."""
    try:
        dataset = mt.load_dataset(path)
    except (OSError, ValueError) as error:
        refuse(str(error))
    if not dataset.is_complete:
        refuse(f"{path} is not complete: the `meshtone dataset` command that began it goes on with it")
    if "sha256" not in dataset.manifest:
        refuse(f"{path} is of an earlier format, without checksums: make it anew")
    try:
        train, test = records(dataset)
    except (KeyError, ValueError) as error:
        refuse(f"{error}\nmodels take `average_g` and `difference_g` of one length: `points_per_revolution` in the plan's [keep]")
    for split, part in (("train", train), ("test", test)):
        if len(set(part.damaged)) < 2:
            refuse(f"split `{split}` of {path} needs healthy and damaged records to distinguish them")
    return dataset, train, test


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("dataset", type=Path)
    arguments.add_argument("-o", "--output", type=Path, required=True, help="folder of the scores")
    arguments.add_argument("--models", nargs="+", choices=MODELS, default=list(MODELS), metavar="MODEL", help=", ".join(MODELS))
    arguments.add_argument("--seeds", type=int, default=5, help="of models that draw, at least 1")
    arguments.add_argument("--check", action="store_true", help="exit code 1 where the bounds of a fair question do not hold")
    given = arguments.parse_args()
    if given.seeds < 1:
        arguments.error(f"--seeds {given.seeds}: at least 1 is needed")
    dataset, train, test = opened(given.dataset, arguments.error)
    made_with = surroundings(dataset)
    digest = hashlib.sha256(json.dumps(made_with).encode()).hexdigest()
    result, probabilities = scores(train, test, given.models, given.seeds, given.output / "runs" / digest[:16])
    if not result["models"]:
        arguments.error("no model is left: install what those need that --models names")
    result = {"made with": made_with, "seeds": given.seeds, **result}
    result["broken bounds"] = broken(result)
    given.output.mkdir(parents=True, exist_ok=True)
    (given.output / "scores.json").write_text(json.dumps(result, indent=1) + "\n")
    (given.output / "scores.md").write_text(table(result), encoding="utf-8")
    figures(test, result, probabilities, given.output)
    print(table(result))
    if result["broken bounds"]:
        print("Bounds of a fair question, which want thousands of records and a good model, that do not hold:", file=sys.stderr)
    for problem in result["broken bounds"]:
        print(f"  {problem}", file=sys.stderr)
    return int(given.check and bool(result["broken bounds"]))


if __name__ == "__main__":
    sys.exit(main())
