"""A suite of tasks for methods of gear diagnosis: frozen plans, one evaluator, one table.

A :class:`Task` says which records of which data set a method may learn from, and which it is scored on. :func:`open_task` makes the data
set, or opens it; :func:`evaluate` scores what a method answers; :func:`compare` puts submissions side by side. What is asked and what
simple methods score: the book's chapter "Data sets". It needs pyarrow: ``pip install 'meshtone[datasets]'``; the baselines need scikit-learn.

Examples
--------
::

    from meshtone import benchmark

    posed = benchmark.open_task("diagnosis", "sets")                       # makes sets/pairs-1, or opens it
    train, test = posed.records("train"), posed.records()
    model.fit(train.matrix(columns), posed.kinds("train"))
    answers = {"record": test["record"], **dict(zip(model.classes_, model.predict_proba(test.matrix(columns)).T))}
    scores = benchmark.evaluate(posed, answers)
    print(benchmark.compare("diagnosis", {"mine": scores, **benchmark.BASELINES["diagnosis"]}))
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .._names import absent, hint
from .._published import PUBLISHED
from .._warnings import warn
from ..datasets import Dataset, generate_dataset
from .measures import BIASED, OF_QUANTILES, interval, measures_of_kinds, measures_of_lives, measures_of_scores

if TYPE_CHECKING:
    import pandas
    import polars
    import pyarrow

__all__ = ["BASELINES", "SETS", "TASKS", "Posed", "Scores", "Task", "compare", "evaluate", "open_task"]

Texts = npt.NDArray[np.str_]
Numbers = npt.NDArray[np.float64]
Columns = Mapping[str, npt.NDArray[Any]]

Scores = dict[str, dict[str, list[float]]]
"""Of each split ``records``, how many were scored, and of each measure the value and the ends of its 90 % interval over units; of a calibration
error the value alone."""

FOLDER = Path(__file__).parent

SETS = {file.stem: file for file in sorted(FOLDER.glob("*.toml"))}
"""The frozen plans by the names of their data sets."""

BASELINES: dict[str, dict[str, Scores]] = json.loads((FOLDER / "scores.json").read_text("utf-8"))
"""The scores of the baselines, by task and name."""

RUN_UP = "run-up"
"""Label of records that are known to be healthy; and the role of what is known beside the training: those of a hidden rig, the first looks at a
life."""

FIRST_LOOKS = 3
"""As many looks at the beginning of a life are known and not scored."""

NOT_SCORED = ("train", RUN_UP)
"""Roles of records that a method may look at."""

SUM_TOLERANCE = 0.01
"""That of probabilities which were rounded for a file."""

ELSEWHERE = {
    "split train test": "records('train') gives the records to learn from, records() those that are scored",
    "matrix column columns arrays to_torch to_pandas signals": "records('train') and records() give data sets that have it",
    "labels label y target": "kinds('train') gives the classes, severities('train') how severe, left('train') what is left of a life",
    "classes answer_columns question measure": "task has it",
    "evaluate score": "benchmark.evaluate(posed, answers)",
}
"""What does what is expected of a :class:`Posed` by these names."""

ROUNDED = 1e-6
"""As much may numbers of single precision be beyond what they must be."""

Roles = dict[str, npt.NDArray[np.bool_]]
"""Which records a method learns from, "train", and which every other role has; a record may be in several."""


def _as_split(columns: Columns) -> Roles:
    return {str(split): columns["split"] == split for split in np.unique(columns["split"].astype(str)) if split != "validation"}


def _healthy_alone(columns: Columns) -> Roles:
    roles = _as_split(columns)
    return {**roles, "train": roles["train"] & (columns["label"] == "healthy")}


def _few(of_each_class: int, columns: Columns, draw: int = 0) -> Roles:
    """The first of a permutation of each class, so that more labels contain the fewer. The task is draw 0; others show how far it is chance."""
    roles, order = _as_split(columns), np.random.default_rng(draw).permutation(len(columns["label"]))
    first = np.zeros(len(order), dtype=bool)
    for label in np.unique(columns["label"]):
        first[order[(roles["train"] & (columns["label"] == label))[order]][:of_each_class]] = True
    return {**roles, "train": first}


def _other_rigs(columns: Columns) -> Roles:
    roles = _as_split(columns)
    known = columns["label"] == RUN_UP
    return {**roles, "test": roles["test"] & ~known, RUN_UP: roles["test"] & known}


def _later_looks(columns: Columns) -> Roles:
    """The first looks at each run are its run-up: who compares a look with those before it has nothing there, and would know it by that.

    Looks are spread evenly over the severity, so that their number alone says much of what is left.
    """
    roles, runs = _as_split(columns), np.char.add(columns["label"].astype(str), columns["unit"].astype(str))
    first = np.zeros(len(runs), dtype=bool)
    for run in np.unique(runs):
        looks = np.flatnonzero(runs == run)
        first[looks[np.argsort(columns["age_rev"][looks])][:FIRST_LOOKS]] = True
    return {**{role: of & ~first for role, of in roles.items()}, RUN_UP: first}


def _specimens(by_specimen: bool, columns: Columns, draw: int = 0) -> Roles:
    """Of each unit one class alone, as where each specimen carries its own fault; a third of the specimens, or of the records, is the test.

    The task is draw 0, as of :func:`_few`.
    """
    draws = np.random.default_rng(draw)
    classes, units = np.unique(columns["label"]), np.unique(columns["unit"])
    number = draws.permutation(len(units))[np.searchsorted(units, columns["unit"])]
    third = number // len(classes) % 3 if by_specimen else draws.integers(3, size=len(number))
    carried = columns["label"] == classes[number % len(classes)]
    return {"train": carried & (third > 0), "test": carried & (third == 0)}


def _laws(other: str, drawn: float, columns: Columns) -> Roles:
    """Each law of damage beside the healthy records.

    To learn from are all classes after their first laws, but of the class of `other`, such as "pits/drawn", the part `drawn` obeys that one.
    """
    labels, split = columns["label"].astype(str), columns["split"]
    is_first, at = np.char.find(labels, "/") < 0, np.random.default_rng(0).random(len(labels))
    is_switched = is_first & (labels == other.partition("/")[0])
    learnt = np.where(labels == other, at < drawn, is_first & (~is_switched | (at >= drawn)))
    roles = {"train": (split == "train") & learnt, "test": (split == "test") & is_first, "fillet": (split == "fillet") & is_first}
    for label in np.unique(labels[~is_first]):
        for law in (label.partition("/")[0], label):
            roles[str(law)] = (split == "test") & np.isin(labels, ["healthy", law])
    return roles


@dataclass(frozen=True)
class Task:
    """A question that is posed of a data set.

    Attributes
    ----------
    name : str
        Its name in :data:`TASKS`.
    set : str
        The data set, one of :data:`SETS`.
    question : str
        In words.
    measure : str
        The measure that ranks: "recall", "auc", or "of_constant", of which less is better.
    roles : callable
        From columns to the records to learn from, "train", and those of each split that is scored.

    Examples
    --------
    >>> from meshtone import benchmark
    >>> task = benchmark.TASKS["bearings"]
    >>> task.answer_columns
    ['record', 'healthy', 'inner-race', 'outer-race', 'pits', 'rolling-element', 'tooth-breakage']
    >>> list(task.records)
    ['test']
    """

    name: str
    set: str
    question: str
    measure: str
    roles: Callable[[Columns], Roles]

    @property
    def classes(self) -> list[str]:
        """Classes whose probabilities are asked for, sorted; none where the answer is one number."""
        if self.measure != "recall":
            return []
        labels = re.findall('^label = "(.+)"$', SETS[self.set].read_text("utf-8"), re.MULTILINE)
        return sorted(set(_kinds(np.array(labels)).tolist()))

    @property
    def answer_columns(self) -> list[str]:
        """Columns that answers must have; quantiles are optional (:func:`evaluate`)."""
        return ["record", *{"auc": ["score"], "of_constant": ["left"]}.get(self.measure, self.classes)]

    @property
    def records(self) -> dict[str, int]:
        """How many records each split has that is scored, in the whole data set; splits of laws of damage share their healthy records."""
        of_splits = next(iter(BASELINES.get(self.name, {}).values()), {})
        return {split: int(measures["records"][0]) for split, measures in of_splits.items()}


def _kinds(labels: Texts) -> Texts:
    """Classes of labels, without what tells laws of damage and run-ups apart."""
    return np.where(labels == RUN_UP, "healthy", np.char.partition(labels, "/")[..., 0]).astype(str)


TASKS = {
    task.name: task
    for task in [
        Task("diagnosis", "pairs-1", "healthy, or which of five kinds of damage, and how severe?", "recall", _as_split),
        Task("anomaly", "pairs-1", "damaged or not, learnt from healthy records alone?", "auc", _healthy_alone),
        Task("few-5", "pairs-1", "as diagnosis, from 5 labelled records of each class?", "recall", partial(_few, 5)),
        Task("few-20", "pairs-1", "as diagnosis, from 20 labelled records of each class?", "recall", partial(_few, 20)),
        Task("few-100", "pairs-1", "as diagnosis, from 100 labelled records of each class?", "recall", partial(_few, 100)),
        Task("rigs", "rigs-1", "which damage, on eight other rigs, of each of which twelve healthy records are known?", "recall", _other_rigs),
        Task("specimens-random", "pairs-1", "one fault a specimen, scored on other records of the same specimens", "recall", partial(_specimens, False)),
        Task("specimens", "pairs-1", "one fault a specimen, scored on other specimens", "recall", partial(_specimens, True)),
        Task("bearings", "gearbox-1", "which bearing race or tooth of a gearbox is damaged?", "recall", _as_split),
        Task("life", "lives-1", "which part of its life does a damaged gear have left, from the fourth look on?", "of_constant", _later_looks),
        Task("laws", "laws-1", "which damage, where it obeys another law than what was learnt?", "recall", partial(_laws, "", 0.0)),
        *(
            Task(
                f"laws-{part}-{other.partition('/')[2]}",
                "laws-1",
                f"the same, where {said} what is learnt of {kind} obeys the other law?",
                "recall",
                partial(_laws, other, drawn),
            )
            for other, kind in [("pits/drawn", "pits"), ("wear/uneven", "wear"), ("root-crack/worn", "cracks")]
            for part, said, drawn in [("half", "half of", 0.5), ("known", "all of", 1.0)]
        ),
    ]
}
"""The tasks by their names."""


class Posed:
    """A task and its data set. :func:`open_task` makes one.

    Attributes
    ----------
    task : Task
        The question.
    dataset : Dataset
        All records, also those that the task does not use.
    splits : list of str
        The splits that are scored.
    """

    def __init__(self, task: Task, dataset: Dataset) -> None:
        self.task, self.dataset = task, dataset
        needed = ("record", "unit", "split", "label", "age_rev")
        self._columns = {name: dataset.column(name) for name in needed if name in dataset.columns}
        self._roles = task.roles(self._columns)
        self.splits = [role for role in self._roles if role not in NOT_SCORED]

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            raise absent(self, name, ELSEWHERE)

    def __repr__(self) -> str:
        counts = ", ".join(f"{role} ({of.sum()})" for role, of in self._roles.items() if role in NOT_SCORED)
        return f"<Task '{self.task.name}' on {self.dataset.place}: {self.task.question} Known: {counts}; {self._asked()}>"

    def _asked(self) -> str:
        """What answers must have."""
        counts = ", ".join(f"{split} ({self._roles[split].sum()})" for split in self.splits)
        meaning = " (the probability of each class)" if self.task.classes else ""
        return (
            f"'{self.task.name}' asks for the columns {', '.join(self.task.answer_columns)}{meaning}, with one row for each of the "
            f"{np.count_nonzero(self._places())} records of {counts}, in any order; posed.records()['record'] has their numbers"
        )

    def records(self, *roles: str) -> Dataset:
        """Records by their roles, in the order of :attr:`dataset`.

        Parameters
        ----------
        *roles : str
            'train'; 'run-up', of the task "rigs" the records of the hidden rigs that are known to be healthy, of "life" the first three
            looks at each run; or splits; none: all that are scored.

        Raises
        ------
        ValueError
            A role that there is not.
        """
        import pyarrow
        import pyarrow.dataset

        numbers = pyarrow.array(self._columns["record"][self._places(*roles)])
        return self.dataset.filter(pyarrow.dataset.field("record").isin(numbers))

    def kinds(self, *roles: str) -> Texts:
        """What is to be said of each of these records: its class, without what tells laws of damage and run-ups apart."""
        return _kinds(self._columns["label"][self._places(*roles)].astype(str))

    def second_kinds(self, *roles: str) -> Texts:
        """Kind of a second damage of each of these records, '' of none: to name it is right too."""
        places = self._places(*roles)
        if "fault_2_kind" not in self.dataset.columns:
            return np.full(np.count_nonzero(places), "")
        return np.array([kind or "" for kind in self.dataset["fault_2_kind"][places]])

    def severities(self, *roles: str) -> Numbers:
        """Severity of the first damage of each of these records, 0 of a healthy one."""
        severities: Numbers = np.nan_to_num(self.dataset.matrix(["fault_severity"])[self._places(*roles), 0])
        return severities

    def left(self, *roles: str) -> Numbers:
        """Part of its life that the damaged wheel of each of these records has left, from 1 to 0."""
        age, remaining = self.dataset.matrix(["age_rev", "remaining_rev"])[self._places(*roles)].T
        return np.asarray(remaining / (age + remaining), dtype=np.float64)

    def units(self, *roles: str) -> npt.NDArray[Any]:
        """Unit of each of these records."""
        return self._columns["unit"][self._places(*roles)]

    def _places(self, *roles: str) -> npt.NDArray[np.bool_]:
        if other := [role for role in roles if role not in self._roles]:
            raise ValueError(f"there is no split '{other[0]}', but {', '.join(sorted(self._roles, key=lambda role: role not in NOT_SCORED))}")
        chosen: npt.NDArray[np.bool_] = np.any([self._roles[role] for role in roles or self.splits], axis=0)
        return chosen


def open_task(name: str, folder: str | PathLike[str], *, records: int | None = None, jobs: int | None = None) -> Posed:
    """Make a task's data set, or go on with it, or open it.

    Parameters
    ----------
    name : str
        One of :data:`TASKS`.
    folder : str or path
        Where the data sets are: this one in a folder of its name.
    records : int, optional
        In place of the plan's, to try a method: such scores compare with nothing.
    jobs : int, optional
        Threads that simulate; all cores by default.

    Returns
    -------
    Posed

    Raises
    ------
    ValueError
        No such task.
    OSError
        What kept the data set from being made.

    Warns
    -----
    MeshtoneWarning
        The data set is not the published one: another version made it.
    """
    task = _task(name)
    dataset = generate_dataset(SETS[task.set], Path(folder, task.set), records=records, jobs=jobs)
    found = hashlib.sha256((dataset.path / "manifest.json").read_bytes()).hexdigest()
    if records is None and found != PUBLISHED.get(task.set):
        warn([f"{dataset.place} is not the published {task.set}: another version of Meshtone made it, and its scores compare with none of those"])
    return Posed(task, dataset)


def _task(name: str) -> Task:
    if name not in list(TASKS):
        raise ValueError(f"there is no task '{name}'{hint(name, list(TASKS))}; there are {', '.join(TASKS)}")
    return TASKS[name]


def evaluate(
    posed: Posed, answers: str | PathLike[str] | Mapping[str, npt.ArrayLike] | pandas.DataFrame | polars.DataFrame | pyarrow.Table
) -> Scores:
    """Score what a method answers for the records of every split.

    Intervals hold 90 % of the scores of units that are drawn with replacement, because records of one unit are no independent witnesses.

    Parameters
    ----------
    posed : Posed
        The task.
    answers : mapping of arrays, table of pandas, polars or pyarrow, or path
        Columns, or the name of a Parquet or CSV file of them, as :attr:`Task.answer_columns` has them: ``record``, the numbers of all records
        that are scored, in any order, and

        * of a kind of damage the probability of each class, in a column of its name
        * of an anomaly ``score``, more for what looks damaged
        * of a life ``left``, the part that is left

        and, where the method knows them, ``quantile_10``, ``quantile_20`` to ``quantile_90``, of the severity or of the life that is left.
        Other columns and other records are not looked at.

    Returns
    -------
    Scores
        Of each split: ``records``, how many; ``auc``, of damaged against healthy; ``recall``, the mean of all classes; ``calibration``, by
        how much the probability of damage is off on average, over ten equal parts of the records; ``mae``; ``of_constant``, the error over
        that of the best constant; ``crps``, the continuous ranked probability score, from the quantiles.

    Raises
    ------
    TypeError
        What is no task that :func:`open_task` opened, or no columns.
    FileNotFoundError
        There is no such file.
    ValueError
        A file of another kind; records or columns that are missing or doubled; numbers that are not finite, or but for ``score`` not within 0
        to 1; probabilities of a record that do not add up to 1 within 0.01; quantiles that fall.
    """
    if isinstance(posed, str):
        task = _task(posed)
        raise TypeError(
            f"posed = '{posed}': must be what open_task('{posed}', FOLDER) returns; its splits have so many records: "
            + ", ".join(f"{split} {count}" for split, count in task.records.items())
        )
    if not isinstance(posed, Posed):
        raise TypeError(f"posed = {posed!r}: must be what open_task returns")
    given = _checked(posed, _columns(answers, posed))
    if posed.task.measure == "of_constant":
        measures = measures_of_lives(given, posed.left(), float(np.median(posed.left("train"))))
    elif posed.task.measure == "auc":
        measures = measures_of_scores(given, posed.kinds())
    else:
        measures = measures_of_kinds(given, posed.kinds(), posed.second_kinds(), posed.severities(), np.array(posed.task.classes))
    places, units = posed._places(), posed.units()
    chosen = {split: np.flatnonzero(posed._roles[split][places]) for split in posed.splits}
    return {
        split: {
            "records": [len(of)],
            **{name: [round(one(of), 3)] if name == BIASED else interval(one, of, units) for name, one in measures.items()},
        }
        for split, of in chosen.items()
    }


def _columns(answers: Any, posed: Posed) -> Mapping[str, npt.ArrayLike]:
    """Columns by their names, whatever has them."""
    import pyarrow
    import pyarrow.dataset

    if isinstance(answers, Mapping):
        return answers
    if isinstance(answers, (str, PathLike)):
        file = Path(answers)
        forms = {".csv": "csv", ".parquet": "parquet", ".pq": "parquet"}
        form = "parquet" if file.is_dir() else forms.get(file.suffix.lower())
        if form is None:
            raise ValueError(f"{file}: must be a file of Parquet or CSV, with such an ending: answers.parquet, answers.csv")
        try:
            answers = pyarrow.dataset.dataset(fspath(file), format=form).to_table()
        except ValueError as error:
            raise ValueError(f"{file} is no file of {form.replace('parquet', 'Parquet').replace('csv', 'CSV')}: {error}") from None
    elif hasattr(answers, "columns"):
        answers = pyarrow.table(answers)
    else:
        kind = f"an array of the shape {answers.shape}" if isinstance(answers, np.ndarray) else repr(answers)
        raise TypeError(f"answers: must be columns by their names, or a file of them, and not {kind}; {posed._asked()}")
    return dict(zip(answers.column_names, answers.columns, strict=True))


def _checked(posed: Posed, answers: Mapping[str, npt.ArrayLike]) -> dict[str, Numbers]:
    """The needed columns of answers, and quantiles if there are any, in the order of the records that are scored; others are not read."""
    measure, records = posed.task.measure, posed._columns["record"][posed._places()]
    of_quantiles = OF_QUANTILES if measure != "auc" and any(name in answers for name in OF_QUANTILES) else []
    needed = [*posed.task.answer_columns[1:], *of_quantiles]
    if missing := [name for name in ["record", *needed] if name not in answers]:
        optional = f"; of quantiles all of {OF_QUANTILES[0]}, {OF_QUANTILES[1]} to {OF_QUANTILES[-1]}" if of_quantiles else ""
        there = f"; there are {', '.join(map(str, answers))}" if answers else ""
        raise ValueError(f"there is no column '{missing[0]}'{hint(missing[0], map(str, answers))}{there}; {posed._asked()}{optional}")
    numbers = _numbers("record", answers)
    found, counts = np.unique(numbers, return_counts=True)
    if len(lacking := np.setdiff1d(records, found)) or (counts > 1).any():
        what = f"{len(lacking)} are missing, such as {lacking[0]}" if len(lacking) else f"{found[counts > 1][0]:g} is there more than once"
        raise ValueError(f"record: of {len(numbers)} numbers {what}; {posed._asked()}")
    order = np.argsort(numbers, kind="stable")[np.searchsorted(found, records)]
    # A probability of single precision may be above 1 by its rounding.
    least, most, allowed = (-np.inf, np.inf, "finite") if measure == "auc" else (-ROUNDED, 1.0 + ROUNDED, "within 0 to 1")
    given: dict[str, Numbers] = {}
    for name in needed:
        values = _numbers(name, answers)
        if values.shape != numbers.shape:
            raise ValueError(f"{name}: has the shape {values.shape}; it must have a number for each of the {len(numbers)} of `record`")
        given[name] = values[order]
        bad = ~np.isfinite(given[name]) | (given[name] < least) | (given[name] > most)
        if bad.any():
            more = f" and not so of {bad.sum() - 1} others" if bad.sum() > 1 else ""
            raise ValueError(f"{name}: is {given[name][bad][0]:g} of record {records[bad][0]}{more}; it must be {allowed}")
    if classes := posed.task.classes:
        total = np.sum([given[name] for name in classes], axis=0)
        if (bad := np.abs(total - 1.0) > SUM_TOLERANCE).any():
            raise ValueError(f"{', '.join(classes)}: add up to {total[bad][0]:g} of record {records[bad][0]}; probabilities must add up to 1")
    for lower, upper in zip(of_quantiles, of_quantiles[1:], strict=False):
        if (bad := given[upper] < given[lower] - ROUNDED).any():
            of = [f"{name} is {given[name][bad][0]:g}" for name in (lower, upper)]
            raise ValueError(f"{' and '.join(of)} of record {records[bad][0]}; quantiles must not fall")
    return given


def _numbers(name: str, answers: Mapping[str, npt.ArrayLike]) -> Numbers:
    try:
        values: Numbers = np.asarray(answers[name]).astype(np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: {error}; it must have numbers") from None
    if values.ndim != 1:
        raise ValueError(f"{name}: has the shape {values.shape}; it must have a number for each record")
    return values


def compare(task: str, submissions: Mapping[str, Scores], measures: Sequence[str] = ()) -> str:
    """A table of submissions to one task.

    Parameters
    ----------
    task : str
        One of :data:`TASKS`.
    submissions : mapping of str to Scores
        Names and what :func:`evaluate` returned.
    measures : sequence of str, optional
        Those that are shown; by default the one that ranks.

    Returns
    -------
    str
        In Markdown: a row for each submission, the best first, and a column for each split and measure. What was scored on other numbers of
        records than the task has, as after ``open_task(…, records=400)``, says so and stands below, since it compares with nothing.

    Raises
    ------
    TypeError
        Submissions without names.
    ValueError
        A task or measure that there is not; no submissions; scores that are not those of such a task.

    Examples
    --------
    >>> from meshtone import benchmark
    >>> print(benchmark.compare("bearings", benchmark.BASELINES["bearings"]).splitlines()[0])
    | bearings | test, recall |
    """
    asked = _task(task)
    if not isinstance(submissions, Mapping) or not all(_is_scores(scores) for scores in submissions.values()):
        raise TypeError("submissions: must be names and what evaluate returned, such as {'mine': evaluate(posed, answers)}")
    if not submissions:
        raise ValueError("submissions: there are none")
    shown = [measures] if isinstance(measures, str) else list(measures) or [asked.measure]
    splits = sorted({split for scores in submissions.values() for split in scores}, key=lambda split: (split != "test", split))
    for name, scores in submissions.items():
        if set(scores) != set(asked.records) or any(asked.measure not in of for of in scores.values()):
            raise ValueError(
                f"'{name}': these are no scores of '{task}', which has {asked.measure} of the splits {', '.join(asked.records)}, but "
                + "; ".join(f"of {split} {', '.join(of)}" for split, of in scores.items())
            )
    known = sorted({measure for scores in submissions.values() for of in scores.values() for measure in of})
    if other := [measure for measure in shown if measure not in known]:
        raise ValueError(f"there is no measure '{other[0]}'{hint(other[0], known)}; there are {', '.join(known)}")
    heads = [(split, measure) for split in splits for measure in shown]
    sign = 1 if asked.measure == "of_constant" else -1
    lines = ["| " + " | ".join([task, *(f"{split}, {measure}" for split, measure in heads)]) + " |", "|---|" + "---:|" * len(heads)]
    rows = []
    for name, scores in submissions.items():
        counts = {split: of["records"][0] for split, of in scores.items() if "records" in of}
        few = next((f" ({count} of {asked.records[split]} records of {split})" for split, count in counts.items() if count != asked.records[split]), "")
        cells = [_cell(scores.get(split, {}).get(measure)) for split, measure in heads]
        value = sign * scores[splits[0]][asked.measure][0]
        rows.append((bool(few), np.inf if np.isnan(value) else value, [name + few, *cells]))
    lines += ["| " + " | ".join(cells) + " |" for _, _, cells in sorted(rows, key=lambda row: row[:2])]
    return "\n".join(lines) + "\n"


def _is_scores(scores: Any) -> bool:
    return isinstance(scores, Mapping) and all(isinstance(of, Mapping) for of in scores.values())


def _cell(score: list[float] | None) -> str:
    if score is None:
        return "–"
    value, *ends = score
    return f"{value:.3f}".removesuffix(".000" if isinstance(value, int) else "") + (f" ({ends[0]:.3f} to {ends[1]:.3f})" if ends else "")
