"""Data sets on an existing Dask cluster: ``pip install 'meshtone[dask]'``."""

from __future__ import annotations

import os
from os import PathLike
from typing import TYPE_CHECKING, Any

from . import _core
from ._extras import extra
from .datasets import Dataset, is_url, load_dataset
from .signal._arguments import whole

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["generate"]


def _part(plan: str, path: str, number: int, of: int) -> int:
    """One part of a data set, with one thread: the cluster runs as many parts at a time as it has threads."""
    _core.generate_dataset(plan, None, path, 1, number, of, None)
    return number


def generate(
    plan: str | PathLike[str], path: str | PathLike[str], client: Client, *, parts: int | None = None, retries: int = 10
) -> Dataset:
    """Make a data set with the workers of a Dask cluster.

    The parts of the plan are the tasks; all write into one directory, which every worker must reach under the same path, or into one
    object store, whose keys and region stand in every worker's environment. A part
    whose worker is lost is done again by another, which keeps the shards that were finished. The result has the same bytes
    as that of :func:`meshtone.datasets.generate_dataset`.

    Parameters
    ----------
    plan : str or path
        The plan file, on a path that every worker reaches.
    path : str or path
        Directory to write to, or the URL of an object store where the compiled module was built with those.
    client : distributed.Client
        Of the cluster.
    parts : int, optional
        How many tasks; four for each thread of the cluster by default.
    retries : int
        How often a part that failed is tried again.

    Returns
    -------
    Dataset

    Raises
    ------
    FileNotFoundError, ValueError, OSError
        As :func:`meshtone.datasets.generate_dataset`.
    """
    with extra("dask"):
        import pyarrow.dataset  # noqa: F401  # before hours of work, not after them
        from distributed import as_completed

    # Workers have working directories of their own.
    plan, path = os.path.abspath(plan), os.fspath(path)
    path = path if is_url(path) else os.path.abspath(path)
    _core.check_plan(plan)
    count = max(1, 4 * sum(client.nthreads().values())) if parts is None else whole("parts", parts, 1)
    retries = whole("retries", retries)
    futures: list[Any] = [
        client.submit(_part, plan, path, number, count, pure=False, retries=retries) for number in range(1, count + 1)
    ]
    try:
        for future in as_completed(futures):
            future.result()
    except BaseException:
        client.cancel(futures)
        raise
    # The last part alone cannot know that it is the last: manifest and data card are written here.
    _core.merge_datasets([path], path, False)
    return load_dataset(path)
