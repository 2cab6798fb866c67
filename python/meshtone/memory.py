"""How much memory may be taken."""

from __future__ import annotations

from . import _core
from .signal._arguments import whole

__all__ = ["set_memory_limit"]

LARGEST_BYTES = 2**64 - 1
"""What a limit can be: no machine has more."""


def set_memory_limit(limit_bytes: int | None) -> None:
    """Set the most memory for one simulation, and for what is read of one file.

    What would take more is refused with a ``ValueError`` that says how much it would take, before it is computed or while it is
    read: a tooth count or a rate with a typing error in it, a compressed file of a few megabytes that stands for gigabytes.

    Parameters
    ----------
    limit_bytes : int or None
        (bytes) The limit, for everything that is read and simulated from then on; None for what is free on the machine, where the
        system says so, and at most 8 GiB, as it is at first. Each simulation of a batch or a data set is compared by itself, with
        the limit or with 8 GiB, not with what is free.

    Raises
    ------
    ValueError
        A limit below 1.
    TypeError
        One that is no whole number.

    Examples
    --------
    >>> import meshtone
    >>> scenario = meshtone.examples.healthy()
    >>> meshtone.set_memory_limit(10_000_000)
    >>> try:
    ...     meshtone.simulate(scenario)
    ... except ValueError as error:
    ...     print("at most 9.5 MiB are allowed" in str(error))
    True
    >>> meshtone.set_memory_limit(None)
    """
    _core.set_memory_limit(None if limit_bytes is None else min(whole("limit_bytes", limit_bytes, 1), LARGEST_BYTES))
