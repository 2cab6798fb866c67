"""Packages that not every user needs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["extra"]


@contextmanager
def extra(name: str) -> Iterator[None]:
    """What is imported in its block belongs to an extra of this package: where it is missing, the error says how to install it.

    Parameters
    ----------
    name : str
        The extra, as ``pyproject.toml`` has it.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        missing = (error.name or "a package").partition(".")[0]
        raise ModuleNotFoundError(f"{missing} is not installed: pip install 'meshtone[{name}]'", name=error.name) from error
