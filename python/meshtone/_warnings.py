"""What is doubtful, as Python's warnings."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from types import FrameType

__all__ = ["MeshtoneWarning", "SignalWarning", "typed", "warn", "warn_of_signal"]

NativeWarning = tuple[str, str, list[tuple[str, float]]]


@dataclass(frozen=True)
class SignalWarning:
    """Something doubtful about a recording or about what is stated of it. ``str()`` gives the message.

    Attributes
    ----------
    code : str
        What it is about: ``nothing-synchronous``, ``foreign-tones``, ``missing-pulses``, ``doubled-pulse``, ``profile-ends-early``,
        ``mesh-tone-fades``, ``stronger-neighbour``, ``mesh-order-near-nyquist``, ``not-averaged``, ``wheel-without-average``, ``planets-found``, of sensor and recorder ``clipped``,
        ``biased``, ``dropped-out``, ``repeated-block`` and ``coarse-steps``, or a quantity that is stated wrongly, as
        :class:`~meshtone.signal.Mismatch` names it; of a diagnosis ``outside``, ``mismatch`` and others.
    message : str
        In words.
    values : dict of str to float
        Its numbers by name, with their units: of ``nothing-synchronous`` ``of_mean_square`` (-), ``revolutions`` and the
        wheel's ``teeth``; of ``foreign-tones`` ``part`` (-) and of each of the strongest ``frequency_hz_1``, ``order_1`` (shaft orders), ``part_1``; of a wrong quantity
        ``alternative``.
    """

    code: str
    message: str
    values: dict[str, float]

    def __str__(self) -> str:
        return self.message


def typed(native: Iterable[NativeWarning]) -> list[SignalWarning]:
    """The warnings of the compiled module."""
    return [SignalWarning(code, message, dict(values)) for code, message, values in native]


def warn_of_signal(warnings_of_signal: Iterable[SignalWarning]) -> None:
    """Warn the user's own code of what is doubtful about a signal."""
    of_signal = list(warnings_of_signal)
    warn([warning.message for warning in of_signal], [warning.code for warning in of_signal], [warning.values for warning in of_signal])


class MeshtoneWarning(UserWarning):
    """Something that can be done, or has been, but deserves attention: every warning of Meshtone is one of these.

    Attributes
    ----------
    code : str or None
        What it is about, for programs to distinguish, such as ``"step-error"``; of the warnings of a simulation or a recording.
    values : dict of str to float
        Its numbers by name, of the warnings of a recording: :class:`~meshtone.signal.SignalWarning`.

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

    def __init__(self, message: str, code: str | None = None, values: dict[str, float] | None = None) -> None:
        super().__init__(message)
        self.code = code
        self.values = {} if values is None else values


def warn(
    messages: Iterable[str], codes: Iterable[str] | None = None, values: Iterable[dict[str, float]] | None = None
) -> None:
    """Warn the user's own code, wherever in the package it was noticed.

    Parameters
    ----------
    messages : iterable of str
        What is doubtful.
    codes : iterable of str, optional
        What each of these is about.
    values : iterable of dict, optional
        Its numbers by name.
    """
    messages = list(messages)
    of_none: list[None] = [None] * len(messages)
    for message, code, numbers in zip(messages, codes or of_none, values or of_none):
        warnings.warn(MeshtoneWarning(message, code, numbers), stacklevel=_levels_to_the_user())


def _levels_to_the_user() -> int:
    """Levels from :func:`warn` up to the first function that is none of the package."""
    frame: FrameType | None = sys._getframe(1)
    levels = 1
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == __name__.partition(".")[0]:
        frame, levels = frame.f_back, levels + 1
    return levels
