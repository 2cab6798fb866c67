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
>>> gears.condition_columns
['pinion_teeth', 'gear_teeth', 'pinion_speed_hz', 'brake_torque_nm']
>>> any(train.to_pandas()[name].isna().all() for name in gears.condition_columns), "difference_octave_32_rms_g" in gears.empty_columns
(False, True)
>>> folder.cleanup()
"""

from __future__ import annotations

import errno
import hashlib
import json
import operator
import os
import re
import shutil
import stat
import tempfile
import weakref
import zipfile
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from copy import copy
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, SupportsIndex, overload

import numpy as np
import numpy.typing as npt

from . import _core, _display, _progress
from ._extras import extra
from ._files import written_whole
from ._names import absent, hint
from ._published import PUBLISHED
from ._warnings import warn
from .signal import resample
from .signal._arguments import whole

if TYPE_CHECKING:
    import pandas
    import polars
    import pyarrow
    import pyarrow.dataset
    import pyarrow.fs
    import xarray

    from ._like import Channels
    from ._torch import TorchDataset
    from .signal.phase import ShaftPhase
    from .scenario import Scenario

__all__ = ["Dataset", "dataset_template", "generate_dataset", "load", "load_dataset", "merge_datasets", "verify_dataset"]

FloatSignal = npt.NDArray[np.float32]

KNOWN = ("pinion_speed_hz", "input_speed_hz", "brake_torque_nm")
"""Columns of what is known of a machine without its vibration, beside those of :data:`KNOWN_OF_WHEELS`."""

KNOWN_OF_WHEELS = re.compile(r"(?!fault|latent).*(teeth|module_mm|face_width_mm|helix_angle_deg|pressure_angle_deg)")
"""Likewise, of each wheel or mesh."""

TARGETS = re.compile(r"label|severity.*|fault.*|remaining_rev")
"""Columns of the damage that was simulated."""

MIXED_PARTS = 16
"""Parts of files, of at most 64 records, that are in memory at a time while records are shuffled."""

ELSEWHERE = {
    "select iloc loc head tail limit slice": "take(places) or [:10] gives records by their places, to_pandas(columns) a table of some columns",
    "shuffle permutation": "records(shuffle=seed), or take(np.random.default_rng(seed).permutation(len(dataset)))",
    "map apply transform with_transform set_transform with_format": "records() goes through the records, to_torch(…, transform=…) takes a function",
    "train_test_split": "split('train') and split('test'), which share no unit",
    "select_columns drop remove_columns sort sort_values groupby group_by query value_counts describe": "to_pandas() gives a table that has it",
    "to_csv to_parquet to_json to_dict to_dicts to_list": "to_pandas() or to_arrow() gives a table that has it; list(dataset) gives dictionaries",
    "column_names features keys": "columns has the names, units their units",
    "num_rows n_rows shape size count": "len(dataset) is the number of records",
    "where": "filter(lambda record: record['label'] == 'healthy')",
    "to_numpy values X data": "matrix(indicator_columns) gives numbers, arrays(signals) signals of one length",
    "y target targets labels": "dataset['label'] gives the labels, target_columns what else may be learnt",
    "iter_batches batch iter": "records(batch_size=…) reads so many at a time",
}
"""What does what other libraries have by these names."""

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
    plan: str | PathLike[str] | dict[str, Any],
    path: str | PathLike[str],
    *,
    records: int | None = None,
    jobs: int | None = None,
    part: tuple[int, int] | None = None,
    progress: bool | Callable[[int, int], None] = False,
) -> Dataset:
    """Make a data set after a plan, or go on with one that was interrupted.

    The result has the same bytes with any number of jobs and parts, and however often it was interrupted. What is there already is
    compared with the SHA-256 that was taken while it was written; a file that differs is made again, with a warning.

    Parameters
    ----------
    plan : str, path or dict
        The plan file; or what stands in one, whose names of files are then relative to the working directory.
    path : str or path
        Directory to write to, or the URL of an object store where the compiled module was built with those.
    records : int, optional
        How many, in place of the plan's number.
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
    count = None if records is None else whole("records", records, 1)
    remade, doubts = _core.generate_dataset(plan, count, fspath(path), threads, number, of, report)
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
        A manifest that cannot be read, or of another version.
    """
    _check_place(path, "manifest.json")
    _, missing, problems = _core.verify_dataset(fspath(path), True)
    return {**problems, **dict.fromkeys(missing, "it is missing")}


def load_dataset(path: str | PathLike[str], *, verify: bool = False) -> Dataset:
    """Open a data set. Nothing but the names, sizes and metadata of its files is read before it is asked for.

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
        A file that the manifest does not name, or that has another size than it says; counts that disagree; a manifest of another
        version; with `verify` whatever is not as it was written.
    ModuleNotFoundError
        pyarrow is not installed.
    """
    opened = _open(path, verify)
    if not opened.is_complete:
        warn([f"{opened.place} is not complete: it has {len(opened)} records; generate_dataset goes on with it"])
    return opened


def load(name: str, path: str | PathLike[str]) -> Dataset:
    """Open a published data set after comparing every byte with what was published.

    Parameters
    ----------
    name : str
        One of :data:`meshtone.benchmark.SETS`, such as 'pairs-1'.
    path : str or path
        Its archive, ``pairs-1.zip``, which is unpacked into the folder ``pairs-1`` beside it unless that exists; or that folder.

    Returns
    -------
    Dataset

    Raises
    ------
    FileNotFoundError
        There is no such file or folder.
    ValueError
        No data set of that name is published; a file is not the published one.

    Examples
    --------
    ::

        pairs = datasets.load("pairs-1", "pairs-1.zip")
        train = pairs.split("train")
    """
    if name not in PUBLISHED:
        raise ValueError(f"no data set '{name}' is published{hint(name, PUBLISHED)}; there is {', '.join(PUBLISHED)}")
    place = Path(path)
    folder = place if place.is_dir() else place.parent / name
    if not folder.exists():
        _unpack(place, name, folder)
    _check_place(folder, "manifest.json")
    _check_published(folder, name, (folder / "manifest.json").read_bytes(), "remove it and load the archive")
    return load_dataset(folder, verify=True)


def _check_published(place: Path, name: str, manifest: bytes, remedy: str) -> None:
    """Refuse a manifest that is not the published one."""
    found = hashlib.sha256(manifest).hexdigest()
    if found != PUBLISHED[name]:
        raise ValueError(
            f"{place} is not the published {name}: the SHA-256 of its manifest.json is {found} instead of {PUBLISHED[name]}; {remedy}, or open "
            "it with load_dataset"
        )


def _unpack(archive: Path, name: str, folder: Path) -> None:
    """Unpack a published data set.

    The manifest is compared first with what was published, and every file that it names with the size and the SHA-256 there; the digits of a
    shard's own SHA-256, its seal, count as zeros in it. Other files of the archive are not read. The folder appears whole or not at all.
    """
    try:
        with zipfile.ZipFile(archive) as packed, tempfile.TemporaryDirectory(dir=archive.parent) as unfinished:
            manifest = packed.read(f"{name}/manifest.json")
            _check_published(archive, name, manifest, "fetch it again, or unpack it")
            whole, stated = Path(unfinished, name), json.loads(manifest)
            for file in [*stated["documents"], *stated["files"]]:
                member = packed.getinfo(f"{name}/{file['name']}")
                content = packed.read(member) if member.file_size == file["bytes"] else b""
                seal = file.get("seal", "")
                hashed = content.replace(seal.encode(), b"0" * len(seal)) if seal else content
                if hashlib.sha256(hashed).hexdigest() != (seal or file["sha256"]):
                    raise ValueError(f"{archive} is not the published {name}: {file['name']} in it has other bytes; fetch it again")
                (whole / file["name"]).parent.mkdir(parents=True, exist_ok=True)
                (whole / file["name"]).write_bytes(content)
            (whole / "manifest.json").write_bytes(manifest)
            whole.rename(folder)
    except (zipfile.BadZipFile, KeyError) as error:
        raise ValueError(f"{archive} is no whole archive of {name}: {error.args[0]}; fetch it again") from None


def _open(path: str | PathLike[str], verify: bool = False) -> Dataset:
    with extra("datasets"):
        import pyarrow
        import pyarrow.dataset

    place = fspath(path)
    _check_place(place, "manifest.json")
    names, _, problems = _core.verify_dataset(fspath(path), verify)
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
        checked = pyarrow.dataset.ParquetFragmentScanOptions(page_checksum_verification=True)
        parquet = pyarrow.dataset.ParquetFileFormat(default_fragment_scan_options=checked)
        return Dataset(place, pyarrow.dataset.dataset(files, format=parquet, filesystem=filesystem), None)
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
        self,
        place: str,
        native: pyarrow.dataset.Dataset,
        expression: pyarrow.dataset.Expression | None,
        empty_columns: list[str] | None = None,
    ) -> None:
        self.place = place
        self._native = native
        # Arrow's threads end later than a scan. If they are the last to hold memory of Python, such as an array given to `isin`, while Python
        # exits, the process aborts. A copy has memory of Arrow alone.
        self._filter = copy(expression)
        self._length: int | None = None
        self._empty = empty_columns
        self._rows: Rows | None = None

    def __getstate__(self) -> dict[str, Any]:
        # What is mapped into memory is of this process; of records in memory pyarrow pickles the table alone.
        return {**vars(self), "_rows": None, "_native": self._native if self._is_in_files else self._native.to_table()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        import pyarrow
        import pyarrow.dataset

        native = state["_native"]
        vars(self).update(state, _native=pyarrow.dataset.dataset(native) if isinstance(native, pyarrow.Table) else native)

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            raise absent(self, name, ELSEWHERE)

    @property
    def _is_in_files(self) -> bool:
        return hasattr(self._native, "files")

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
        text = self._beside("manifest.json")
        manifest: dict[str, Any] = {} if text is None else json.loads(text)
        return manifest

    def _beside(self, name: str) -> bytes | None:
        """A file beside the data; None where there is none of that name."""
        filesystem, folder = _filesystem(self.place)
        try:
            with filesystem.open_input_stream(f"{folder}/{name}") as file:
                text: bytes = file.read()
        except FileNotFoundError:
            return None
        return text

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

    @overload
    def __getitem__(self, index: SupportsIndex) -> dict[str, Any]: ...
    @overload
    def __getitem__(self, index: slice) -> Dataset: ...
    @overload
    def __getitem__(self, index: str) -> Any: ...
    def __getitem__(self, index: SupportsIndex | slice | str) -> Any:
        """A record by its place among these, records by a slice, or a column by its name.

        The first access to a file's records decodes it, the later ones take microseconds in any order.

        Parameters
        ----------
        index : int, slice or str
            From 0, or from -1 backwards.

        Returns
        -------
        dict, Dataset, or what :meth:`column` or :meth:`signals` returns
            Of a record a value or an array of float32 for each column.

        Raises
        ------
        IndexError
            There are not so many records.
        ValueError
            A column that there is not.
        """
        if isinstance(index, str):
            self._check([index])
            return self.signals(index) if index in self.signal_columns else self.column(index)
        if isinstance(index, slice):
            return self.take(range(len(self))[index])
        if self._rows is None:
            self._rows = Rows(self, self.columns)
        return self._rows[index]

    def take(self, places: Sequence[int] | npt.NDArray[np.integer[Any]]) -> Dataset:
        """Records by their places among these, in that order.

        Parameters
        ----------
        places : sequence of int
            From 0; a place may occur more than once. ``np.flatnonzero`` gives those of a mask.

        Returns
        -------
        Dataset
            In memory, with all columns.

        Raises
        ------
        IndexError
            There are not so many records.
        TypeError
            What is no whole number, such as the values of a mask.

        Examples
        --------
        ::

            first, shuffled = gears[:10], gears.take(np.random.default_rng(0).permutation(len(gears)))
        """
        import pyarrow.dataset

        numbers = np.asarray(places)
        if numbers.size and numbers.dtype.kind not in "iu":
            raise TypeError(f"places: must be whole numbers, and not {numbers.dtype}; np.flatnonzero(mask) gives those of a mask")
        numbers = numbers.astype(np.int64)
        if numbers.size and not 0 <= numbers.min() <= numbers.max() < len(self):
            raise IndexError(f"places of {len(self)} records are from 0 to {len(self) - 1}")
        table = self._native.take(numbers, filter=self._filter)
        return Dataset(self.place, pyarrow.dataset.dataset(table), None, self.empty_columns)

    def sample(self, records: int, *, seed: int = 0) -> Dataset:
        """Some of the records, drawn without replacement and in their order.

        Parameters
        ----------
        records : int
            How many.
        seed : int
            Of the draw: the same seed draws the same places.

        Returns
        -------
        Dataset
            In memory, with all columns.

        Raises
        ------
        ValueError
            There are not so many records.
        """
        if not 0 <= whole("records", records) <= len(self):
            raise ValueError(f"records = {records}: there are {len(self)}")
        return self.take(np.sort(np.random.default_rng(seed).permutation(len(self))[:records]))

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return self.records()

    def __repr__(self) -> str:
        if not len(self):
            return f"<Dataset of {self._state()}>"
        # Recordings have neither label nor split.
        labels = Counter(label or "without label" for label in self.column("label").tolist())
        splits = Counter(name for name in self.column("split").tolist() if name)
        counts = ", ".join(f"{count} {label}" for label, count in sorted(labels.items()))
        parts = "; splits " + ", ".join(f"{name} ({count})" for name, count in sorted(splits.items())) if splits else ""
        return f"<Dataset of {self._state()}: {counts}{parts}>"

    def _state(self) -> str:
        """How many records there are, of how many, and where."""
        of = "" if self._filter is None else f" of {self._native.count_rows()}"
        return f"{len(self)}{of} records" + ("" if self._is_in_files else " in memory") + ("" if self.is_complete else ", not complete")

    def _repr_html_(self) -> str:
        pairs = Counter(zip(self.column("label").tolist(), self.column("split").tolist(), strict=True))
        labels, splits = (sorted({pair[place] for pair in pairs}) for place in (0, 1))
        counts = [(label, *(pairs[label, split] for split in splits)) for label in labels]
        facts = {"Directory": self.place, "Columns": ", ".join(self.columns)}
        return _display.page(
            f"Dataset of {self._state()}", _display.table([("", *splits), *counts]), _display.table(facts)
        )

    def filter(self, expression: pyarrow.dataset.Expression | Callable[[dict[str, Any]], bool]) -> Dataset:
        """The records for which an expression or a function holds; the signals are not read before they are asked for.

        Parameters
        ----------
        expression : pyarrow.dataset.Expression or callable
            ``pyarrow.dataset.field("pinion_speed_hz") > 30``, of which nothing is read either, or a function of the values of a record
            without its signals, ``lambda record: record["pinion_speed_hz"] > 30``.

        Raises
        ------
        TypeError
            Something else.
        """
        import pyarrow.dataset

        if callable(expression):
            chosen = [record["record"] for record in self.records(self.scalar_columns) if expression(record)]
            expression = pyarrow.dataset.field("record").isin(pyarrow.array(chosen, self._native.schema.field("record").type))
        if not isinstance(expression, pyarrow.dataset.Expression):
            raise TypeError(
                f"expression = {expression!r}: must be one of pyarrow, such as pyarrow.dataset.field('pinion_speed_hz') > 30, or a function"
            )
        both = expression if self._filter is None else self._filter & expression
        return Dataset(self.place, self._native, both, self._empty)

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

        known = sorted(set(self.column("split").tolist()) - {None})
        if not known:
            raise ValueError("records made of recordings belong to no split")
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
        """The records as a table of pandas, with a row for each record and a column for each value.

        Needs pandas: ``pip install 'meshtone[tables]'``.

        Parameters
        ----------
        columns : sequence of str, optional
            All but the signals and :attr:`empty_columns` by default.

        Raises
        ------
        ModuleNotFoundError
            pandas is not installed.
        ValueError
            A column that there is not.
        """
        chosen = self._value_columns() if columns is None else list(columns)
        with extra("tables"):
            return self.to_arrow(chosen).to_pandas()

    def to_polars(self, columns: Sequence[str] | None = None) -> polars.DataFrame:
        """The records as a table of polars, with a row for each record and a column for each value.

        Needs polars: ``pip install 'meshtone[polars]'``.

        Parameters
        ----------
        columns : sequence of str, optional
            All but the signals and :attr:`empty_columns` by default.

        Raises
        ------
        ModuleNotFoundError
            polars is not installed.
        ValueError
            A column that there is not.
        """
        with extra("polars"):
            import polars
        return polars.DataFrame(self.to_arrow(self._value_columns() if columns is None else columns))

    def to_xarray(self, signals: Sequence[str] = (), *, points: int | None = None) -> xarray.Dataset:
        """The records as xarray has them, over ``record``.

        Needs xarray and pandas: ``pip install 'meshtone[xarray]'``.

        Parameters
        ----------
        signals : sequence of str, optional
            Signals that are added, over ``record`` and ``sample``.
        points : int, optional
            Their length, as of :meth:`arrays`.

        Raises
        ------
        ModuleNotFoundError
            xarray or pandas is not installed.
        ValueError
            As :meth:`arrays`.
        """
        with extra("xarray"):
            table: xarray.Dataset = self.to_pandas().set_index("record").to_xarray()
        for name in signals:
            table[name] = (("record", "sample"), self.arrays(name, points=points)[0][:, 0])
        return table

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

    @property
    def empty_columns(self) -> list[str]:
        """Names of the columns that are null in every record of the whole data set, such as octaves beyond half the sampling rate.

        Tables leave them out if no columns are named; a learner refuses them.
        """
        if self._empty is None:
            groups = [group for fragment in self._native.get_fragments() for group in _null_counts(fragment)]
            self._empty = [name for name in self.scalar_columns if groups and all(group[name] for group in groups)]
        return list(self._empty)

    @property
    def condition_columns(self) -> list[str]:
        """Names of the columns of what is known of a machine without its vibration: speed, torque, teeth, module, face width, angles."""
        names = [name for name in self.scalar_columns if name in KNOWN or KNOWN_OF_WHEELS.fullmatch(name)]
        return [name for name in names if name not in self.empty_columns]

    @property
    def target_columns(self) -> list[str]:
        """Names of the columns that say what is damaged, and how much: a learner may learn these, and nothing from them."""
        return [name for name in self._value_columns() if TARGETS.fullmatch(name)]

    @property
    def indicator_columns(self) -> list[str]:
        """Names of the columns of condition indicators, which a recording has too: with :attr:`condition_columns` all from which a
        learner may learn."""
        fields = {name: self._native.schema.field(name).metadata or {} for name in self._value_columns()}
        return [name for name, metadata in fields.items() if metadata.get(b"description", b"").startswith(b"indicator ")]

    def _value_columns(self) -> list[str]:
        empty = set(self.empty_columns)
        return [name for name in self.scalar_columns if name not in empty]

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

    def records(
        self, columns: Sequence[str] | None = None, *, batch_size: int = 64, shuffle: int | None = None
    ) -> Iterator[dict[str, Any]]:
        """The records one after the other; only some are in memory at a time.

        Parameters
        ----------
        columns : sequence of str, optional
            All by default.
        batch_size : int
            How many are read at a time.
        shuffle : int, optional
            Seed of a random order, such as the number of the epoch: parts of files are read in random order, and the records of sixteen
            parts, about a thousand, are mixed. So a set that no memory holds is read in pieces, where :meth:`to_torch` reads single records.

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
        if shuffle is not None:
            yield from self._shuffled(chosen, np.random.default_rng(whole("shuffle", shuffle, 0)))
            return
        for batch in self._native.to_batches(columns=chosen, filter=self._filter, batch_size=batch_size):
            yield from _records_of(batch)

    def _shuffled(self, columns: list[str], draws: np.random.Generator) -> Iterator[dict[str, Any]]:
        """The records of row groups in random order, of so many groups at a time mixed with each other."""
        import pyarrow.dataset

        # Of a set in memory there is one part.
        parts: list[Any] = []
        for fragment in self._native.get_fragments():
            in_file = isinstance(fragment, pyarrow.dataset.ParquetFileFragment)
            parts += fragment.split_by_row_group() if in_file else [fragment]
        order = draws.permutation(len(parts))
        for first in range(0, len(parts), MIXED_PARTS):
            tables = [parts[part].to_table(columns=columns, filter=self._filter) for part in order[first : first + MIXED_PARTS]]
            mixed = [record for table in tables for batch in table.to_batches() for record in _records_of(batch)]
            yield from (mixed[place] for place in draws.permutation(len(mixed)))

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
            A column that there is not, that holds no numbers, or that is null in every record of the data set.
        """
        names = _names("columns", columns)
        self._check_values(names)
        values = []
        for name in names:
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
        signals: str | Sequence[str],
        *,
        targets: str | Sequence[str] = "label",
        classes: Mapping[str, Sequence[Any]] | None = None,
        conditions: bool | Sequence[str] = False,
        points: int | None = None,
        transform: Callable[[FloatSignal], Any] | None = None,
    ) -> TorchDataset:
        """A ``torch.utils.data.Dataset`` of (signals, target), or of ((signals, conditions), target) with conditions.

        Needs torch: ``pip install 'meshtone[torch]'``. Targets and conditions are read at once, the signals when they are asked
        for, in any order: shuffled epochs are as fast as ordered ones after the first.

        Parameters
        ----------
        signals : str or sequence of str
            One or several of :attr:`signal_columns`: the channels. A record's signals are a tensor of float32 of the shape
            (channels, points).
        targets : str or sequence of str
            Columns to learn. The target is a value where one name is given, and a dictionary of values where a sequence is given. Text
            is a class number (int); a number, such as ``fault_severity`` or ``age_rev``, is a tensor of float32 of the shape (). A
            severity is 0 where a record has no such fault; another number is NaN where the record has none.
        classes : mapping, optional
            Labels in the order of their numbers, by the names of targets. By default a text has the labels of the whole data set, sorted,
            so that all splits and filters number them alike; None is first where records have no text. A number whose labels are
            given, such as ``{"severity": range(6)}``, is a class too. The attribute ``classes`` of the result has them, so that another
            data set can be numbered alike.
        conditions : bool or sequence of str
            Whether the inputs have :attr:`condition_columns` too, or those columns of numbers that are named: a tensor of float32 of
            the shape (conditions,), in the units of :attr:`units`. The attribute ``conditions`` has their names.
        points : int, optional
            Length of all signals, as of :meth:`arrays`, so that a ``DataLoader`` makes batches of them; by default their own.
        transform : callable, optional
            Given each record's signals as an array; what it returns stands in their place.

        Returns
        -------
        torch.utils.data.Dataset

        Raises
        ------
        ModuleNotFoundError
            torch is not installed.
        ValueError
            A column that there is not, that is null in every record, or that holds no numbers where they are needed; a label that is not
            among the given classes; when a record is read, signals of several lengths.

        Examples
        --------
        ::

            train = gears.split("train").to_torch(
                ["average_g", "difference_g"], targets=["label", "fault_severity"], conditions=True, points=1024
            )
            for (signals, conditions), target in DataLoader(train, batch_size=32, shuffle=True):
                kind, severity = network(signals, conditions)
                loss = cross_entropy(kind, target["label"]) + mse_loss(severity, target["fault_severity"])
        """
        with extra("torch"):
            from ._torch import TorchDataset

        channels = [signals] if isinstance(signals, str) else list(signals)
        self._check_signals(channels)
        known = [] if conditions is False else self.condition_columns if conditions is True else _names("conditions", conditions)
        names = [targets] if isinstance(targets, str) else _names("targets", targets)
        self._check_values([*known, *names])
        classes = self._classes(names, classes)
        values = {name: self._numbers(name, classes.get(name)) for name in names}
        return TorchDataset(
            Rows(self, channels),
            channels,
            values[targets] if isinstance(targets, str) else values,
            classes,
            {name: self.matrix([name])[:, 0] for name in known},
            None if points is None else whole("points", points, 1),
            transform,
        )

    def _classes(self, targets: Sequence[str], given: Mapping[str, Sequence[Any]] | None) -> dict[str, list[Any]]:
        """Labels of the targets that are classes, in the order of their numbers."""
        import pyarrow.types

        if given is not None and not isinstance(given, Mapping):
            raise TypeError(f"classes = {given!r}: must be a mapping, such as {{'{targets[0]}': [...]}}")
        classes = {name: list(labels) for name, labels in (given or {}).items()}
        if other := [name for name in classes if name not in targets]:
            raise ValueError(f"classes: '{other[0]}' is no target, but {', '.join(targets)}")
        schema = self._native.schema
        for name in targets:
            if name not in classes and pyarrow.types.is_string(schema.field(name).type):
                labels = set(self._native.to_table(columns=[name]).column(0).to_pylist())
                classes[name] = sorted(labels, key=lambda label: (label is not None, label))
        return classes

    def _numbers(self, name: str, classes: Sequence[Any] | None) -> npt.NDArray[Any]:
        """What a network learns of a column: class numbers (int64), or the numbers themselves (float32)."""
        if classes is None:
            numbers = self.matrix([name])[:, 0].astype(np.float32)
            return np.nan_to_num(numbers) if re.fullmatch(r"fault(_\d+)?_severity", name) else numbers
        place = {label: number for number, label in enumerate(classes)}
        labels = self.to_arrow([name]).column(0).to_pylist()
        if missing := [label for label in labels if label not in place]:
            raise ValueError(f"classes: there is no {missing[0]!r} among those of '{name}', which are {', '.join(map(repr, classes))}")
        return np.array([place[label] for label in labels], dtype=np.int64)

    def like(
        self,
        recordings: Channels | Sequence[Channels],
        phase: ShaftPhase | Sequence[ShaftPhase],
        machine: Scenario,
        sampling_rate_hz: float,
        *,
        shaft: str | None = None,
    ) -> Dataset:
        """Take recordings to records like these: same channel, sampling rate or points per revolution, windows, columns and names.

        Each recording is divided into windows as long as a record of the plan, one after the other, from a whole revolution of the averaged
        wheel on. The channels are resampled and processed by the code that makes the data set's records.

        Parameters
        ----------
        recordings : array_like, shape (samples,), or mapping of str to array_like, or a sequence of these
            (g) The analysed channel, or several channels by the names of their columns. A channel that is not recorded is empty.
        phase : ShaftPhase, or a sequence of these
            Of one shaft; with a sequence of recordings one for each.
        machine : Scenario
            What was recorded: its tooth counts are used, and :attr:`condition_columns` have its values.
        sampling_rate_hz : float
            (S/s) Of all recordings, at least that of the data set.
        shaft : str, optional
            Name of the shaft that the phases are of: of a scenario ``pinion`` or ``gear``. By default the pinion's, or the input of a gearbox.

        Returns
        -------
        Dataset
            In memory. ``record`` counts the windows, ``unit`` the recordings; what no recording tells, such as the label, is null.

        Raises
        ------
        ValueError
            A machine without the plan's wheels, a channel or shaft that there is not, a lower sampling rate, fewer revolutions than a record
            has, or what :func:`meshtone.process_channel` refuses.

        Examples
        --------
        ::

            phase = mt.signal.ShaftPhase.constant(25.0, 50e3, signal.size)
            rig = gears.like(signal, phase, mt.Scenario(**rig), 50e3)
            model.predict(rig.matrix(columns))
        """
        import pyarrow.dataset

        from ._like import table_like

        table = table_like(self, recordings, phase, machine, sampling_rate_hz, shaft)
        # Columns that the data set fills are there for a learner, whatever is known about a recording.
        return Dataset(self.place, pyarrow.dataset.dataset(table), None, self.empty_columns)

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

    def to_bearing_datasets(self, folder: str | PathLike[str]) -> None:
        """Write the raw channels in the schema, version 2, of the Python package ``bearing-datasets`` 0.3.0.

        ``metadata.parquet`` has a row for each signal, and ``signals/`` the samples: the book's chapter "Data sets" lists the columns.

        Parameters
        ----------
        folder : str or path
            The folder, which must not exist or be empty but for an export that was interrupted; its name is that of the written data set.

        Raises
        ------
        ValueError
            A data set that is not complete or keeps no raw channel; a bearing of its base scenario with a spall, which no class labels; a
            folder that has files in it.

        Examples
        --------
        ::

            gears.split("test").to_bearing_datasets("sets/gears")
            bearing_datasets.open("gears", "sets").signal("record-17/vertical_g")
        """
        from ._bearing_datasets import write_bearing_datasets

        write_bearing_datasets(self, Path(folder))

    def _check_signals(self, columns: Sequence[str]) -> None:
        self._check(columns)
        for name in columns:
            if name not in self.signal_columns:
                raise ValueError(f"column '{name}' holds one value a record: column('{name}') gives them")
        if not columns:
            raise ValueError(f"no signals are named; there are {', '.join(self.signal_columns)}")

    def _check_values(self, columns: Sequence[str]) -> None:
        """Refuse columns from which nothing can be learnt."""
        self._check(columns)
        if empty := [name for name in columns if name in self.empty_columns]:
            raise ValueError(f"null in every record: {', '.join(empty)}; leave out what `empty_columns` lists")

    def _check(self, columns: Sequence[str]) -> None:
        for name in columns:
            if name not in self.columns:
                meant = hint(name, self.columns) or f", but {', '.join(self.columns)}"
                raise ValueError(f"there is no column '{name}'{meant}")


class Rows:
    """Records of a data set by their places, in any order.

    The first access to a file writes what is wanted of it, uncompressed, to a temporary file in Arrow's format, which is mapped into
    memory: each file is decoded once, in whatever order records are read, and the system keeps in memory what fits there. Processes that are
    forked from this one, such as a ``DataLoader``'s workers, share the files that were read before.

    Parameters
    ----------
    dataset : Dataset
        The records.
    columns : sequence of str
        What is read of them.
    """

    def __init__(self, dataset: Dataset, columns: Sequence[str]) -> None:
        self._dataset, self._columns = dataset, list(columns)
        self._fragments = list(dataset.arrow.get_fragments())
        self._ends = np.cumsum([fragment.count_rows(filter=dataset._filter) for fragment in self._fragments], dtype=int)
        self._mapped: dict[int, list[tuple[str, Any, Any]]] = {}
        # Made here and not by the first reader: a forked worker that makes one leaves it behind.
        self._folder = _TemporaryFolder()

    def __reduce__(self) -> tuple[type[Rows], tuple[Dataset, list[str]]]:
        # A process that is not forked from this one has no claim to its temporary files.
        return Rows, (self._dataset, self._columns)

    def __len__(self) -> int:
        return int(self._ends[-1]) if self._ends.size else 0

    def __getitem__(self, index: SupportsIndex) -> dict[str, Any]:
        try:
            number = operator.index(index)
        except TypeError:
            raise TypeError(f"record {index!r}: must be a whole number; slices, take, filter and split give several") from None
        if not -len(self) <= number < len(self):
            raise IndexError(f"record {number} of {len(self)}")
        number %= len(self)
        place = int(np.searchsorted(self._ends, number, side="right"))
        row = number - (int(self._ends[place - 1]) if place else 0)
        return {
            name: values[row].as_py() if ends is None else values[ends[row] : ends[row + 1]]
            for name, values, ends in self._columns_of(place)
        }

    def _columns_of(self, place: int) -> list[tuple[str, Any, Any]]:
        """Of each wanted column of a file its name and its values; of signals also where each one ends."""
        if place not in self._mapped:
            import pyarrow

            table = self._fragments[place].to_table(columns=self._columns, filter=self._dataset._filter).combine_chunks()
            # Another thread may do the same at the same time: each writes a file of its own.
            file = self._folder.new_file()
            with pyarrow.OSFile(file, "wb") as sink, pyarrow.ipc.new_file(sink, table.schema) as writer:
                writer.write_table(table)
            batches = pyarrow.ipc.open_file(pyarrow.memory_map(file)).read_all().combine_chunks().to_batches()
            self._mapped[place] = [_mapped_column(name, batches[0].column(name)) for name in table.column_names]
        return self._mapped[place]


class _TemporaryFolder:
    """A folder that is removed with the object, by the process that made it only."""

    def __init__(self) -> None:
        self._name = tempfile.mkdtemp(prefix="meshtone-")
        weakref.finalize(self, _remove_as, os.getpid(), self._name)

    def new_file(self) -> str:
        handle, name = tempfile.mkstemp(dir=self._name)
        os.close(handle)
        return name


def _remove_as(process: int, folder: str) -> None:
    if os.getpid() == process:
        shutil.rmtree(folder, ignore_errors=True)


def _mapped_column(name: str, column: Any) -> tuple[str, Any, Any]:
    import pyarrow.types

    if not pyarrow.types.is_list(column.type):
        return name, column, None
    return name, column.values.to_numpy(zero_copy_only=False), column.offsets.to_numpy()


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


def _names(argument: str, names: Sequence[str]) -> list[str]:
    """Names of columns, of which a single one is given in a sequence too."""
    if isinstance(names, str):
        raise TypeError(f"{argument} = '{names}': must be a sequence of names, such as ['{names}']")
    if not names:
        raise ValueError(f"{argument}: no columns are named")
    return list(names)


def _null_counts(fragment: pyarrow.dataset.ParquetFileFragment) -> Iterator[dict[str, bool]]:
    """For each part of a file, which columns are null in all of its records, by the statistics at the file's end."""
    for number in range(fragment.metadata.num_row_groups):
        group = fragment.metadata.row_group(number)
        columns = [group.column(place) for place in range(group.num_columns)]
        yield {
            column.path_in_schema: column.statistics is not None and column.statistics.null_count == group.num_rows
            for column in columns
        }


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
