"""Files that appear whole or not at all."""

from __future__ import annotations

import errno
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import BinaryIO, cast

__all__ = ["written_whole"]


@contextmanager
def written_whole(path: str | PathLike[str]) -> Iterator[BinaryIO]:
    """A file that is written beside its place, and put there once all of it is written.

    Parameters
    ----------
    path : str or path
        Its place; a file that is there already is replaced.

    Raises
    ------
    OSError
        A directory is in its place, or what else kept it from being written.
    """
    target = Path(path)
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), os.fspath(path))
    with tempfile.NamedTemporaryFile(prefix=f".{target.name}-", dir=target.parent, delete=False) as stream:
        beside = Path(stream.name)
        try:
            yield cast(BinaryIO, stream)
            stream.close()
            # Such files are for their owner alone at first.
            umask = os.umask(0)
            os.umask(umask)
            beside.chmod(0o666 & ~umask)
            beside.replace(target)
        finally:
            beside.unlink(missing_ok=True)
