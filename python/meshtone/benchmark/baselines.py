"""Three simple methods for each task; they need scikit-learn: ``pip install 'meshtone[datasets,sklearn]'``.

    python -m meshtone.benchmark.baselines FOLDER [TASK …]     # makes the data sets in FOLDER, writes scores.json and a table
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import signal
from .._extras import extra
from ..datasets import Dataset
from . import FIRST_LOOKS, RUN_UP, TASKS, Posed, Scores, compare, evaluate, open_task
from .measures import QUANTILES

with extra("sklearn"):
    from sklearn.covariance import LedoitWolf
    from sklearn.ensemble import (
        ExtraTreesClassifier,
        ExtraTreesRegressor,
        HistGradientBoostingClassifier,
        HistGradientBoostingRegressor,
        IsolationForest,
    )
    from sklearn.impute import SimpleImputer
    from sklearn.linear_model import LogisticRegression, RidgeCV
    from sklearn.model_selection import GroupKFold, cross_val_predict
    from sklearn.neighbors import LocalOutlierFactor
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler
    from threadpoolctl import threadpool_limits

Matrix = npt.NDArray[np.float64]

BEARING = signal.Bearing.named("6205")
"""That of the data set's gearbox."""

BANDS_HZ = ((500.0, 3000.0), (3000.0, 6000.0), (6000.0, 10000.0))


def scaled(model: Any) -> Any:
    """A model behind mean values for missing ones and a scale of 1."""
    return make_pipeline(SimpleImputer(keep_empty_features=True), StandardScaler(), model)


class Outliers:
    """How far a record is from healthy ones, by an estimator with ``score_samples``, or by Mahalanobis' distance."""

    def __init__(self, estimator: Any) -> None:
        self.steps = make_pipeline(SimpleImputer(keep_empty_features=True), StandardScaler())
        self.estimator = estimator

    def scores(self, train: Matrix, test: Matrix) -> Matrix:
        """How unlike those to learn from each record is."""
        self.estimator.fit(self.steps.fit_transform(train))
        records = self.steps.transform(test)
        if isinstance(self.estimator, LedoitWolf):
            return np.asarray(self.estimator.mahalanobis(records), dtype=np.float64)
        return -np.asarray(self.estimator.score_samples(records), dtype=np.float64)


CLASSIFIERS: dict[str, Callable[[], Any]] = {
    "logistic regression": lambda: scaled(LogisticRegression(C=0.3, max_iter=5000, class_weight="balanced")),
    "extra trees": lambda: ExtraTreesClassifier(200, min_samples_leaf=2, class_weight="balanced", random_state=0),
    "gradient boosting": lambda: HistGradientBoostingClassifier(
        max_iter=100, min_samples_leaf=5, l2_regularization=1.0, class_weight="balanced", random_state=0, early_stopping=False
    ),
}
DETECTORS: dict[str, Callable[[], Any]] = {
    "Mahalanobis distance": lambda: LedoitWolf(),
    "isolation forest": lambda: IsolationForest(n_estimators=300, random_state=0),
    "local outlier factor": lambda: LocalOutlierFactor(20, novelty=True),
}
REGRESSORS: dict[str, Callable[[], Any]] = {
    "ridge regression": lambda: scaled(RidgeCV(np.logspace(-1, 5, 13))),
    "extra trees": lambda: ExtraTreesRegressor(100, min_samples_leaf=3, max_features=0.3, random_state=0),
    "gradient boosting": lambda: HistGradientBoostingRegressor(
        loss="absolute_error", max_iter=100, random_state=0, early_stopping=False
    ),
}


def features(dataset: Dataset) -> Matrix:
    """Indicators and conditions of each record, and of a gearbox the lines of its bearing.

    Indicators span decades; a skewness may be negative, and 0 is no logarithm.
    """
    columns = [np.arcsinh(100.0 * dataset.matrix(dataset.indicator_columns)), np.log(dataset.matrix(dataset.condition_columns))]
    if "seat_g" in dataset.signal_columns:
        columns.append(np.array([bearing_lines(*record.values()) for record in dataset.records(["seat_g", "input_speed_hz", "sampling_rate_hz"])]))
    return np.hstack(columns)


def bearing_lines(samples: npt.NDArray[Any], speed_hz: float, rate_hz: float) -> list[float]:
    """Logarithms of the defect lines of a bearing over the median beside them, in the squared envelope of three bands."""
    lines = []
    for band_hz in BANDS_HZ:
        spectrum = signal.squared_envelope_spectrum(samples, rate_hz, band_hz)
        lines += [float(np.log(line.over_median)) for line in signal.defect_lines(spectrum, BEARING, speed_hz)]
    return lines


def beside_run_up(values: Matrix, labels: npt.NDArray[Any], units: npt.NDArray[Any]) -> Matrix:
    """Values of each record over those of its rig's run-up: less their median, over their interquartile range."""
    relative = np.empty_like(values)
    for unit in np.unique(units):
        of_unit = units == unit
        low, middle, high = np.nanquantile(values[of_unit & (labels == RUN_UP)], [0.25, 0.5, 0.75], axis=0)
        relative[of_unit] = (values[of_unit] - middle) / (high - low + 1e-3)
    return relative


def beside_history(values: Matrix, runs: npt.NDArray[Any], age: npt.NDArray[Any]) -> Matrix:
    """Values of each record less those of the first looks at its run, as far as there were so many, and the mean of the last four looks
    less the same.
    """
    relative = np.empty((len(values), 2 * values.shape[1]))
    for run in np.unique(runs):
        looks = np.flatnonzero(runs == run)
        looks = looks[np.argsort(age[looks])]
        for place, look in enumerate(looks):
            begin = values[looks[: min(FIRST_LOOKS, place + 1)]].mean(axis=0)
            latest = values[looks[max(0, place - 3) : place + 1]].mean(axis=0)
            relative[look] = np.concatenate([values[look] - begin, latest - begin])
    return relative


def answers(posed: Posed) -> Iterator[tuple[str, dict[str, npt.NDArray[Any]]]]:
    """What each of a task's three baselines answers.

    The features of all records are computed once. Quantiles of a severity or a life are those of the errors that the model makes on
    fifths of the training's units that are left out of it.
    """
    dataset = posed.dataset
    values, record, label, unit = features(dataset), dataset["record"], dataset["label"].astype(str), dataset["unit"]
    of_train, of_test = (np.isin(record, posed.records(*role)["record"]) for role in (["train"], []))
    # An octave beyond half the sampling rate of all but a few records is no feature.
    values = values[:, np.isfinite(values[of_train]).mean(axis=0) > 0.5]
    if RUN_UP in label:
        values = np.hstack([values, beside_run_up(values, label, unit)])
    if "age_rev" in dataset.columns:
        runs = np.char.add(label, unit.astype(str))
        values = np.hstack([values, beside_history(values, runs, dataset["age_rev"])])
    train, test = values[of_train], values[of_test]
    number = {"record": record[of_test]}
    if posed.task.measure == "auc":
        for name, detector in DETECTORS.items():
            yield name, {**number, "score": Outliers(detector()).scores(train, test)}
        return
    if posed.task.measure == "of_constant":
        for name, regressor in REGRESSORS.items():
            yield name, {**number, **quantiles(regressor(), train, posed.left("train"), posed.units("train"), test)}
        return
    severities = quantiles(REGRESSORS["extra trees"](), train, posed.severities("train"), posed.units("train"), test)
    for name, classifier in CLASSIFIERS.items():
        model = classifier().fit(train, posed.kinds("train"))
        yield name, {**number, **dict(zip(model.classes_, model.predict_proba(test).T, strict=True)), **severities}


def quantiles(model: Any, train: Matrix, target: Matrix, units: npt.NDArray[Any], test: Matrix) -> dict[str, Matrix]:
    """A regression's answers from 0 to 1, and their quantiles by its errors on units that it has not seen."""
    unseen = cross_val_predict(model, train, target, groups=units, cv=GroupKFold(min(5, len(np.unique(units)))))
    answer = model.fit(train, target).predict(test)
    ends = {f"quantile_{round(100 * q)}": np.clip(answer + np.quantile(target - unseen, q), 0.0, 1.0) for q in QUANTILES}
    return {"left": np.clip(answer, 0.0, 1.0), **ends}


def score(name: str, folder: Path, records: int | None = None) -> dict[str, Scores]:
    """Scores of a task's baselines.

    Parameters
    ----------
    name : str
        One of :data:`meshtone.benchmark.TASKS`.
    folder : path
        Where the data sets are, or are made.
    records : int, optional
        As of :func:`meshtone.benchmark.open_task`.
    """
    posed = open_task(name, folder, records=records)
    # Threads of so small models wait for each other longer than they compute where the cores are busy.
    with threadpool_limits(1):
        return {model: evaluate(posed, given) for model, given in answers(posed)}


def main() -> None:
    """Score the tasks that are named, or all of them."""
    folder, *names = sys.argv[1:]
    file = Path(folder, "scores.json")
    scores = json.loads(file.read_text("utf-8")) if file.exists() else {}
    for name in names or TASKS:
        scores[name] = score(name, Path(folder))
        scores = {task: scores[task] for task in TASKS if task in scores}
        # A line for each measure.
        text = re.sub(r"\n\s*(?=[-\d\]N])", " ", json.dumps(scores, indent=1))
        file.write_text(text + "\n", "utf-8")
        print(compare(name, scores[name]), flush=True)


if __name__ == "__main__":
    main()
