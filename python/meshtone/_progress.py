"""Progress of long calls on the terminal."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable


def on_terminal(what: str) -> Callable[[int, int], None]:
    """A line that is written anew as things are finished, and ended once.

    Parameters
    ----------
    what : str
        What is counted, in the plural.
    """
    start = time.monotonic()
    ended = False

    def told(finished: int, total: int) -> None:
        nonlocal ended
        if total == 0 or ended:
            return
        ended = finished == total
        rate = finished / max(time.monotonic() - start, 1e-9)
        left = f", {(total - finished) / rate:.0f} s left" if 0 < finished < total else ""
        sys.stderr.write(f"\r{finished} of {total} {what}, {rate:.0f} a second{left}   " + ("\n" if ended else ""))
        sys.stderr.flush()

    return told
