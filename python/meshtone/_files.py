"""Files that appear whole or not at all."""

from __future__ import annotations

import errno
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from os import PathLike
from pathlib import Path
from typing import BinaryIO

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
    # A name of its own: others may write to the same place meanwhile.
    beside = target.with_name(f".{target.name}-{secrets.token_hex(6)}")
    try:
        with beside.open("xb") as stream:
            yield stream
        beside.replace(target)
    except OSError as error:
        if error.filename == os.fspath(beside):
            error.filename = os.fspath(target)
        raise
    finally:
        with suppress(OSError):
            beside.unlink()
