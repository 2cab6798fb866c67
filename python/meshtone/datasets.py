"""Labelled data sets: made after a plan, loaded lazily, split without leaks.

What a plan says, and what a data set holds: the book's chapter "Data sets". Loading needs pyarrow: ``pip install 'meshtone[datasets]'``.

Examples
--------
>>> import pathlib, tempfile
>>> from meshtone import datasets
>>> folder = tempfile.TemporaryDirectory()
>>> path = pathlib.Path(folder.name, "gears")
>>> plan = pathlib.Path(folder.name, "plan.toml")
>>> _ = plan.write_text('''
... records = 8
... units = 4
... scenario = "machine.toml"
... [[class]]
... label = "healthy"
... [[class]]
... label = "missing-tooth"
... fault = { kind = "missing-tooth" }
... [split]
... train = 0.5
... test = 0.5
... ''')
>>> from meshtone import template
>>> _ = pathlib.Path(folder.name, "machine.toml").write_text(template("healthy"), encoding="utf-8")
>>> gears = datasets.generate_dataset(plan, path)
>>> gears
<Dataset of 8 records: 4 healthy, 4 missing-tooth; splits test (4), train (4)>
>>> train = gears.split("train")
>>> sorted(set(train.column("label")))
['healthy', 'missing-tooth']
>>> train.signals("vertical_g")[0].dtype
dtype('float32')
>>> folder.cleanup()
"""

from __future__ import annotations

import errno
import json
import operator
import os
import stat
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core, _display, _progress
from ._extras import extra
from ._files import written_whole
from ._names import hint
from ._warnings import warn
from .signal import resample
from .signal._arguments import whole

if TYPE_CHECKING:
    import pandas
    import polars
    import pyarrow
    import pyarrow.dataset
    import pyarrow.fs

__all__ = ["Dataset", "dataset_template", "generate_dataset", "load_dataset", "merge_datasets", "verify_dataset"]

FloatSignal = npt.NDArray[np.float32]

OVER_A_REVOLUTION = ("average_g", "difference_g", "enhanced_relative_difference")
"""Columns of signals at equal angles of one revolution; the others are at equal times."""


def dataset_template() -> str:
    """A commented plan to start from.

    Returns
    -------
    str
        The text of a plan file.

    Examples
    --------
    >>> dataset_template().startswith("#")
    True
    """
    return _core.dataset_template()


def generate_dataset(
    plan: str | PathLike[str],
    path: str | PathLike[str],
    *,
    jobs: int | None = None,
    part: tuple[int, int] | None = None,
    progress: bool | Callable[[int, int], None] = False,
) -> Dataset:
    """Make a data set after a plan, or go on with one that was interrupted.

    The result has the same bytes with any number of jobs and parts, and however often it was interrupted. What is there already is
    compared with the SHA-256 that was taken while it was written; a file that differs is made again, with a warning.

    Parameters
    ----------
    plan : str or path
        The plan file.
    path : str or path
        Directory to write to, or the URL of an object store where the compiled module was built with those.
    jobs : int, optional
        Threads that simulate; all cores by default.
    part : tuple of int, optional
        ``(i, n)`` makes only part i, from 1, of n. Parts may be made at the same time, in one directory or apart.
    progress : bool or callable, optional
        True for a line on the terminal or a bar in a notebook; or called with the numbers of records that are finished and of all.

    Returns
    -------
    Dataset
        What lies there now.

    Raises
    ------
    FileNotFoundError
        There is no such plan.
    ValueError
        What is wrong with the plan, with key and line; a directory with other files, or with the data set of another plan; a plan
        of which no record can be simulated.
    BlockingIOError
        Another program makes the same in the same directory.
    OSError
        A full disk, or what else kept it from being written; what is finished stays.
    KeyboardInterrupt
        Ctrl-C stops it; what is finished stays.
    """
    with extra("datasets"):
        import pyarrow.dataset  # noqa: F401  # before hours of work, not after them

    report = _progress.shown("records") if progress is True else (progress or None)
    number, of = (1, 1) if part is None else _part(part)
    threads = None if jobs is None else whole("jobs", jobs, 1)
    remade, doubts = _core.generate_dataset(plan, fspath(path), threads, number, of, report)
    warn(doubts)
    if remade:
        file, reason = remade[0]
        warn([f"{len(remade)} files were made again; {file}: {reason}"])
    made = _open(path)
    if made.failures:
        first = made.failures[0]
        warn(
            [
                f"{len(made.failures)} records of the plan could not be simulated and are missing; "
                f"record {first['record']}: {first['reason']}"
            ]
        )
    return made


def _part(part: tuple[int, int]) -> tuple[int, int]:
    try:
        number, of = part
    except (TypeError, ValueError):
        raise TypeError(f"part = {part!r}: must be (i, n) with i from 1 to n") from None
    return whole("part[0]", number), whole("part[1]", of)


def merge_datasets(
    parts: Sequence[str | PathLike[str]], path: str | PathLike[str], *, verify: bool = False
) -> Dataset:
    """Merge the parts of a data set that were made separately.

    What is copied is compared with the SHA-256 that was taken while it was made.

    Parameters
    ----------
    parts : sequence of str or path
        Their directories.
    path : str or path
        Directory of the whole; may be one of the parts.
    verify : bool
        Whether files that were made in the directory of the whole are read too, instead of only looking at their sizes.

    Returns
    -------
    Dataset

    Raises
    ------
    FileNotFoundError, NotADirectoryError
        A part that is no directory, or has no data set in it.
    ValueError
        Parts of different plans; files that no part has, or that are damaged in all of them.
    OSError
        What kept it from being written.
    """
    for part in parts:
        _check_place(part, "plan.toml")
    _core.merge_datasets([fspath(part) for part in parts], fspath(path), verify)
    return load_dataset(path)


def verify_dataset(path: str | PathLike[str]) -> dict[str, str]:
    """Compare every byte of a data set with what was written: names, sizes, counts, SHA-256, rows and columns.

    Parameters
    ----------
    path : str or path
        Its directory, or that of a part.

    Returns
    -------
    dict
        What is wrong, by the names of the files that it is wrong with; empty where all is as it was written.

    Raises
    ------
    FileNotFoundError, NotADirectoryError
        There is no such directory, or no data set in it.
    ValueError
        A manifest that cannot be read, or of a later version.
    """
    _check_place(path, "manifest.json")
    _, _, missing, problems = _core.verify_dataset(fspath(path), True)
    return {**problems, **dict.fromkeys(missing, "it is missing")}


def load_dataset(path: str | PathLike[str], *, verify: bool = False) -> Dataset:
    """Open a data set. Nothing but the names and sizes of its files is read before it is asked for.

    Parameters
    ----------
    path : str or path
        Its directory, or its URL in an object store where the compiled module was built with those.
    verify : bool
        Whether every byte is compared with what was written, as :func:`verify_dataset` does.

    Returns
    -------
    Dataset

    Raises
    ------
    FileNotFoundError, NotADirectoryError
        There is no such directory, or no data set in it.
    ValueError
        A file that the manifest does not name, or that has another size than it says; counts that disagree; a manifest of a later
        version; with `verify` whatever is not as it was written.
    ModuleNotFoundError
        pyarrow is not installed.
    """
    opened = _open(path, verify)
    if not opened.is_complete:
        warn([f"{opened.place} is not complete: it has {len(opened)} records; generate_dataset goes on with it"])
    elif opened.manifest.get("format_version") == 1:
        warn(
            [
                f"{opened.place} was made by an earlier version: its hashes are of what was on the disk when it was completed, not of "
                "what was written"
            ]
        )
    return opened


def _open(path: str | PathLike[str], verify: bool = False) -> Dataset:
    with extra("datasets"):
        import pyarrow
        import pyarrow.dataset

    place = fspath(path)
    _check_place(place, "manifest.json")
    _, names, _, problems = _core.verify_dataset(fspath(path), verify)
    # A data card that is missing is no reason not to read the data.
    wrong = {name: what for name, what in problems.items() if verify or name.startswith(("data/", "manifest.json"))}
    if wrong:
        name, what = next(iter(wrong.items()))
        more = f", and {len(wrong) - 1} more files" if len(wrong) > 1 else ""
        raise ValueError(
            f"{place} is not as it was written: {name}: {what}{more}; verify_dataset reports all of them, generate_dataset makes them again"
        )
    if names:
        filesystem, folder = _filesystem(place)
        files = [f"{folder}/{name}" for name in names]
        return Dataset(place, pyarrow.dataset.dataset(files, format="parquet", filesystem=filesystem), None)
    # A part that has no shard of its own, the first there.
    schema = pyarrow.schema([("label", pyarrow.string()), ("split", pyarrow.string())])
    return Dataset(place, pyarrow.dataset.dataset(schema.empty_table()), None)


def is_url(place: str) -> bool:
    """Whether a place is none of this machine's directories by its name."""
    return "://" in place


def _filesystem(place: str) -> tuple[pyarrow.fs.FileSystem, str]:
    """What pyarrow reads a place's files with, and the place's name there."""
    import pyarrow.fs

    scheme, _, name = place.partition("://")
    if not name:
        return pyarrow.fs.LocalFileSystem(), Path(place).as_posix()
    name = name.rstrip("/")
    if scheme.lower() != "s3":
        filesystem, name = pyarrow.fs.FileSystem.from_uri(f"{scheme}://{name}")
        return filesystem, name
    # By the variables that the compiled module knows, of which pyarrow reads the keys for itself.
    endpoint, region = (
        next((os.environ[name] for name in names if name in os.environ), None)
        for names in (("AWS_ENDPOINT", "AWS_ENDPOINT_URL"), ("AWS_REGION", "AWS_DEFAULT_REGION"))
    )
    return pyarrow.fs.S3FileSystem(endpoint_override=endpoint, region=region), name


def _check_place(path: str | PathLike[str], file: str) -> None:
    """Refuse a place without a data set, of which `file` is a part."""
    name = fspath(path)
    if is_url(name):
        # An object store, which reports it by itself.
        return
    if not stat.S_ISDIR(os.stat(name).st_mode):
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), name)
    if not Path(name, file).exists():
        raise FileNotFoundError(errno.ENOENT, f"it holds no data set: there is no {file} in it", name)


class Dataset:
    """A data set, or those of its records that a filter leaves. :func:`load_dataset` opens one.

    Its length is the number of records; ``dataset[0]`` is the first one, and ``for record in dataset`` goes through them as
    :meth:`records` does.

    Attributes
    ----------
    place : str
        Its directory, or its URL in an object store.
    """

    def __init__(
        self, place: str, native: pyarrow.dataset.Dataset, expression: pyarrow.dataset.Expression | None
    ) -> None:
        self.place = place
        self._native = native
        self._filter = expression
        self._length: int | None = None
        self._rows: Rows | None = None

    @property
    def path(self) -> Path:
        """Its directory.

        Raises
        ------
        ValueError
            It is in an object store.
        """
        if is_url(self.place):
            raise ValueError(f"{self.place} is no directory: `place` has its URL")
        return Path(self.place)

    @property
    def arrow(self) -> pyarrow.dataset.Dataset:
        """The whole data set as pyarrow has it, without the filter."""
        return self._native

    @property
    def manifest(self) -> dict[str, Any]:
        """``manifest.json``: versions, hashes, counts, failures; without most of them as long as parts are missing."""
        filesystem, folder = _filesystem(self.place)
        try:
            with filesystem.open_input_stream(f"{folder}/manifest.json") as file:
                manifest: dict[str, Any] = json.loads(file.read())
        except FileNotFoundError:
            return {}
        return manifest

    @property
    def is_complete(self) -> bool:
        """Whether all parts are there, with all the files that the manifest lists."""
        manifest = self.manifest
        if manifest.get("complete") is not True:
            return False
        import pyarrow.fs

        filesystem, folder = _filesystem(self.place)
        there = filesystem.get_file_info(pyarrow.fs.FileSelector(f"{folder}/data", allow_not_found=True, recursive=True))
        names = {file.path.removeprefix(f"{folder}/") for file in there}
        return all(file["name"] in names for file in manifest["files"])

    @property
    def failures(self) -> list[dict[str, Any]]:
        """Records that could not be simulated and are missing: ``record`` and ``reason``; once the data set is complete."""
        return list(self.manifest.get("failures", []))

    @property
    def columns(self) -> list[str]:
        """Names of the columns, with units."""
        return list(self._native.schema.names)

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column that has one."""
        units = {}
        for name in self.columns:
            metadata = self._native.schema.field(name).metadata or {}
            unit = metadata.get(b"unit", b"").decode()
            if unit:
                units[name] = unit
        return units

    def __len__(self) -> int:
        if self._length is None:
            self._length = int(self._native.count_rows(filter=self._filter))
        return self._length

    def __getitem__(self, index: int) -> dict[str, Any]:
        """A record, by its place among these, as :meth:`records` gives it; the last file that was read is kept in memory.

        Parameters
        ----------
        index : int
            From 0, or from -1 backwards.

        Returns
        -------
        dict
            A value or an array of float32 for each column.

        Raises
        ------
        IndexError
            There are not so many records.
        """
        if self._rows is None:
            self._rows = Rows(self, self.columns)
        return self._rows[index]

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return self.records()

    def __repr__(self) -> str:
        labels = Counter(self.column("label").tolist())
        splits = Counter(self.column("split").tolist())
        counts = ", ".join(f"{count} {label}" for label, count in sorted(labels.items()))
        parts = ", ".join(f"{name} ({count})" for name, count in sorted(splits.items()))
        state = "" if self.is_complete else ", not complete"
        return f"<Dataset of {len(self)} records{state}: {counts}; splits {parts}>"

    def _repr_html_(self) -> str:
        pairs = Counter(zip(self.column("label").tolist(), self.column("split").tolist(), strict=True))
        labels, splits = (sorted({pair[place] for pair in pairs}) for place in (0, 1))
        counts = [(label, *(pairs[label, split] for split in splits)) for label in labels]
        state = "" if self.is_complete else ", not complete"
        facts = {"Directory": self.place, "Columns": ", ".join(self.columns)}
        return _display.page(
            f"Dataset of {len(self)} records{state}", _display.table([("", *splits), *counts]), _display.table(facts)
        )

    def filter(self, expression: pyarrow.dataset.Expression) -> Dataset:
        """The records for which an expression holds.

        Parameters
        ----------
        expression : pyarrow.dataset.Expression
            ``pyarrow.dataset.field("pinion_speed_hz") > 30``.
        """
        both = expression if self._filter is None else self._filter & expression
        return Dataset(self.place, self._native, both)

    def split(self, name: str) -> Dataset:
        """The records of a split.

        Parameters
        ----------
        name : str
            'train', 'validation', 'test', or one of the plan's shifts.

        Raises
        ------
        ValueError
            A split that there is not.
        """
        import pyarrow.dataset

        known = sorted(set(self.column("split").tolist()))
        if name not in known:
            raise ValueError(f"there is no split '{name}', but {', '.join(known)}")
        return self.filter(pyarrow.dataset.field("split") == name)

    def to_arrow(self, columns: Sequence[str] | None = None) -> pyarrow.Table:
        """The records as a table of pyarrow.

        Parameters
        ----------
        columns : sequence of str, optional
            All by default, signals too.

        Raises
        ------
        ValueError
            A column that there is not.
        """
        self._check(columns or ())
        return self._native.to_table(columns=None if columns is None else list(columns), filter=self._filter)

    def to_pandas(self, columns: Sequence[str] | None = None) -> pandas.DataFrame:
        """The records as a table of pandas; without the signals, which do not belong there, if no columns are named.

        Needs pandas: ``pip install 'meshtone[tables]'``.

        Parameters
        ----------
        columns : sequence of str, optional
            All but the signals by default.

        Raises
        ------
        ModuleNotFoundError
            pandas is not installed.
        ValueError
            A column that there is not.
        """
        chosen = self.scalar_columns if columns is None else list(columns)
        with extra("tables"):
            return self.to_arrow(chosen).to_pandas()

    def to_polars(self, columns: Sequence[str] | None = None) -> polars.DataFrame:
        """The records as a table of polars; without the signals if no columns are named.

        Needs polars: ``pip install 'meshtone[polars]'``.

        Parameters
        ----------
        columns : sequence of str, optional
            All but the signals by default.

        Raises
        ------
        ModuleNotFoundError
            polars is not installed.
        ValueError
            A column that there is not.
        """
        with extra("polars"):
            import polars
        return polars.DataFrame(self.to_arrow(self.scalar_columns if columns is None else columns))

    @property
    def scalar_columns(self) -> list[str]:
        """Names of the columns that hold one value a record."""
        import pyarrow.types

        schema = self._native.schema
        return [name for name in self.columns if not pyarrow.types.is_list(schema.field(name).type)]

    @property
    def signal_columns(self) -> list[str]:
        """Names of the columns that hold a signal."""
        scalars = set(self.scalar_columns)
        return [name for name in self.columns if name not in scalars]

    def column(self, name: str) -> npt.NDArray[Any]:
        """A column of one value a record.

        Parameters
        ----------
        name : str
            One of :attr:`scalar_columns`.

        Returns
        -------
        array, shape (records,)

        Raises
        ------
        ValueError
            A column that there is not, or that holds signals.
        """
        self._check([name])
        if name in self.signal_columns:
            raise ValueError(f"column '{name}' holds signals: signals('{name}') gives them")
        values: npt.NDArray[Any] = self.to_arrow([name]).column(0).to_numpy()
        return values

    def signals(self, name: str) -> list[FloatSignal]:
        """The signals of a column, an array each; all in memory. :meth:`records` reads them bit by bit.

        Parameters
        ----------
        name : str
            One of :attr:`signal_columns`.

        Returns
        -------
        list of array of float32
            Their lengths may differ. They are views of what was read, and cannot be written to.

        Raises
        ------
        ValueError
            A column that there is not, or that holds no signals.
        """
        self._check_signals([name])
        chunks = self.to_arrow([name]).column(0).chunks
        return [signal for chunk in chunks for signal in _signals_of(chunk)]

    def records(self, columns: Sequence[str] | None = None, *, batch_size: int = 64) -> Iterator[dict[str, Any]]:
        """The records one after the other; only some are in memory at a time.

        Parameters
        ----------
        columns : sequence of str, optional
            All by default.
        batch_size : int
            How many are read at a time.

        Yields
        ------
        dict
            A value or an array of float32 for each column.

        Raises
        ------
        ValueError
            A column that there is not.
        """
        self._check(columns or ())
        chosen = self.columns if columns is None else list(columns)
        batch_size = whole("batch_size", batch_size, 1)
        for batch in self._native.to_batches(columns=chosen, filter=self._filter, batch_size=batch_size):
            yield from _records_of(batch)

    def matrix(self, columns: Sequence[str]) -> npt.NDArray[np.float64]:
        """Columns of numbers side by side, as classifiers take them.

        Parameters
        ----------
        columns : sequence of str
            Indicators, keys.

        Returns
        -------
        array of float64, shape (records, columns)

        Raises
        ------
        ValueError
            A column that there is not, or that holds no numbers.
        """
        if isinstance(columns, str):
            raise TypeError(f"columns = '{columns}': must be a sequence of names, such as ['{columns}']")
        values = []
        for name in columns:
            try:
                values.append(np.asarray(self.column(name), dtype=np.float64))
            except (TypeError, ValueError) as error:
                if name in self.scalar_columns:
                    raise ValueError(f"column '{name}' holds no numbers") from error
                raise
        return np.column_stack(values)

    def arrays(
        self, signals: str | Sequence[str], *, points: int | None = None, label: str = "label"
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[Any]]:
        """Signals of one length and their labels, X and y, as aeon and sktime take them; ``X.reshape(len(X), -1)`` is as scikit-learn does.

        Parameters
        ----------
        signals : str or sequence of str
            One or several of :attr:`signal_columns`: the channels.
        points : int, optional
            Length of all. Signals over a revolution, such as ``average_g``, are resampled to it, as :func:`meshtone.signal.resample`
            does; of others it takes the first ones. Where it is left out, all must be of one length.
        label : str
            The column that y is.

        Returns
        -------
        X : array of float32, shape (records, channels, points)
            In the units that :attr:`units` has.
        y : array, shape (records,)

        Raises
        ------
        ValueError
            A column that there is not, or that holds no signals; signals of several lengths; one that is shorter than asked for.

        Examples
        --------
        With scikit-learn, and a transformer of aeon::

            X, y = train.arrays(["average_g", "difference_g"], points=1024)
            LogisticRegression().fit(X.reshape(len(X), -1), y)
            RocketClassifier().fit(X, y)
        """
        names = [signals] if isinstance(signals, str) else list(signals)
        self._check_signals(names)
        length = None if points is None else whole("points", points, 1)
        y = self.column(label)
        X = np.empty((len(self), len(names), length or 0), dtype=np.float32)
        for row, record in enumerate(self.records(names)):
            if length is None:
                length = record[names[0]].size
                X = np.empty((len(self), len(names), length), dtype=np.float32)
            for channel, name in enumerate(names):
                if points is None and record[name].size != length:
                    raise ValueError(
                        f"record {row} has {record[name].size} points of '{name}', the first one {length} of '{names[0]}': "
                        "points=… makes them of one length"
                    )
                X[row, channel] = with_points(name, record[name], length)
        return X, y

    def to_torch(
        self,
        signal: str,
        *,
        points: int | None = None,
        label: str = "label",
        transform: Callable[[FloatSignal], Any] | None = None,
    ) -> Any:
        """A ``torch.utils.data.Dataset`` of (signal, class number); its attribute ``classes`` has the labels.

        Needs torch: ``pip install 'meshtone[torch]'``. The labels are read at once; of the signals, the last file that was
        asked for is kept in memory, so that reading in order is fast.

        Parameters
        ----------
        signal : str
            One of :attr:`signal_columns`.
        points : int, optional
            Length of all, as of :meth:`arrays`, so that a ``DataLoader`` puts them into batches as it is; by default their own.
        label : str
            The column of labels.
        transform : callable, optional
            Given each signal, as long as asked for; what it returns stands in its place.

        Returns
        -------
        torch.utils.data.Dataset

        Raises
        ------
        ModuleNotFoundError
            torch is not installed.
        ValueError
            A column that there is not.
        """
        with extra("torch"):
            from ._torch import TorchDataset

        self._check_signals([signal])
        self._check([label])
        return TorchDataset(self, signal, label, None if points is None else whole("points", points, 1), transform)

    def to_mat(self, file: str | PathLike[str], columns: Sequence[str] | None = None) -> None:
        """Write the records as a MATLAB v5 file: a struct array ``records`` with a field for each column.

        Needs SciPy: ``pip install 'meshtone[matlab]'``.

        Parameters
        ----------
        file : str or path
            The file; it appears whole or not at all.
        columns : sequence of str, optional
            All by default.

        Raises
        ------
        ValueError
            A column that there is not; no records; more than the 2 GiB that a variable of such a file holds.
        """
        with extra("matlab"):
            import scipy.io

        rows, size = [], 0
        for record in self.records(columns):
            size += sum(value.nbytes for value in record.values() if isinstance(value, np.ndarray))
            if size >= 2**31:
                raise ValueError("the signals take more than the 2 GiB of a MATLAB v5 file: filter, or name columns")
            rows.append(record)
        if not rows:
            raise ValueError("there are no records to write")
        array = np.empty(len(rows), dtype=[(name, object) for name in rows[0]])
        for place, row in enumerate(rows):
            array[place] = tuple(np.nan if value is None else value for value in row.values())
        with written_whole(file) as stream:
            scipy.io.savemat(stream, {"records": array}, do_compression=True, long_field_names=True)

    def _check_signals(self, columns: Sequence[str]) -> None:
        self._check(columns)
        for name in columns:
            if name not in self.signal_columns:
                raise ValueError(f"column '{name}' holds one value a record: column('{name}') gives them")
        if not columns:
            raise ValueError(f"no signals are named; there are {', '.join(self.signal_columns)}")

    def _check(self, columns: Sequence[str]) -> None:
        for name in columns:
            if name not in self.columns:
                meant = hint(name, self.columns) or f", but {', '.join(self.columns)}"
                raise ValueError(f"there is no column '{name}'{meant}")


class Rows:
    """Records of a data set by their places; the last file that was read is kept in memory, so that reading in order is fast.

    Parameters
    ----------
    dataset : Dataset
        The records.
    columns : sequence of str
        What is read of them.
    """

    def __init__(self, dataset: Dataset, columns: Sequence[str]) -> None:
        self._columns, self._filter = list(columns), dataset._filter
        self._fragments = list(dataset.arrow.get_fragments())
        self._ends = np.cumsum([fragment.count_rows(filter=self._filter) for fragment in self._fragments], dtype=int)
        self._read: tuple[int, list[dict[str, Any]]] | None = None

    def __len__(self) -> int:
        return int(self._ends[-1]) if self._ends.size else 0

    def __getitem__(self, index: int) -> dict[str, Any]:
        try:
            number = operator.index(index)
        except TypeError:
            raise TypeError(f"record {index!r}: must be a whole number; filter and split give several records") from None
        if not -len(self) <= number < len(self):
            raise IndexError(f"record {number} of {len(self)}")
        number %= len(self)
        place = int(np.searchsorted(self._ends, number, side="right"))
        # Other threads may put another shard there meanwhile.
        read = self._read
        if read is None or read[0] != place:
            batches = self._fragments[place].to_batches(columns=self._columns, filter=self._filter)
            self._read = read = (place, [record for batch in batches for record in _records_of(batch)])
        first = int(self._ends[place - 1]) if place else 0
        return dict(read[1][number - first])


def with_points(name: str, values: FloatSignal, points: int) -> FloatSignal:
    """A signal of a column, as long as it is asked for.

    Parameters
    ----------
    name : str
        The column.
    values : array, shape (samples,)
        The signal.
    points : int
        Its wanted length.

    Raises
    ------
    ValueError
        There are fewer samples, and they are not those of a revolution.
    """
    if values.size == points:
        return values
    if name in OVER_A_REVOLUTION:
        return resample(values, values.size, points, edge="periodic").astype(np.float32)
    if values.size < points:
        raise ValueError(f"points = {points}: a record has {values.size} of '{name}'")
    return values[:points]


def _records_of(batch: pyarrow.RecordBatch) -> Iterator[dict[str, Any]]:
    """The rows of an Arrow table, with signals as views of its memory."""
    import pyarrow.types

    columns = [
        _signals_of(column) if pyarrow.types.is_list(column.type) else column.to_pylist() for column in batch.columns
    ]
    for row in range(batch.num_rows):
        yield {name: values[row] for name, values in zip(batch.schema.names, columns)}


def _signals_of(chunk: Any) -> list[FloatSignal]:
    """The lists of an Arrow array, as views of its memory."""
    offsets = chunk.offsets.to_numpy()
    values = chunk.values.to_numpy(zero_copy_only=False)
    return [values[start:end] for start, end in zip(offsets[:-1], offsets[1:])]
