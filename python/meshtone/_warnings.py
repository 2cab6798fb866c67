"""What is doubtful, as Python's warnings."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterable
from types import FrameType

__all__ = ["MeshtoneWarning", "warn"]


class MeshtoneWarning(UserWarning):
    """Something that can be done, or has been, but deserves attention: every warning of Meshtone is one of these.

    Attributes
    ----------
    code : str or None
        What it is about, for programs to distinguish, such as ``"step-error"``; of the warnings of a simulation.

    Examples
    --------
    Make errors of them, or look at nothing but their codes:

    >>> import warnings
    >>> import meshtone
    >>> from meshtone import examples
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always", meshtone.MeshtoneWarning)
    ...     simulation = meshtone.simulate(examples.healthy().copy(pinion_teeth=14))
    >>> [warning.message.code for warning in caught if isinstance(warning.message, meshtone.MeshtoneWarning)]
    ['undercut']
    """

    def __init__(self, message: str, code: str | None = None) -> None:
        super().__init__(message)
        self.code = code


def warn(messages: Iterable[str], codes: Iterable[str] | None = None) -> None:
    """Warn the user's own code, wherever in the package it was noticed.

    Parameters
    ----------
    messages : iterable of str
        What is doubtful.
    codes : iterable of str, optional
        What each of these is about.
    """
    messages = list(messages)
    for message, code in zip(messages, [None] * len(messages) if codes is None else codes):
        warnings.warn(MeshtoneWarning(message, code), stacklevel=_levels_to_the_user())


def _levels_to_the_user() -> int:
    """Levels from :func:`warn` up to the first function that is none of the package."""
    frame: FrameType | None = sys._getframe(1)
    levels = 1
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == __name__.partition(".")[0]:
        frame, levels = frame.f_back, levels + 1
    return levels
