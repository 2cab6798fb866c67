"""Progress of long calls: a line on the terminal, a bar in a notebook."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from html import escape
from typing import Any

SHORTEST_S = 0.1
"""(s) Between two messages to a notebook."""


def shown(what: str) -> Callable[[int, int], None]:
    """A line that is written anew as things are finished, and ended once; in a file that once; in a notebook one bar that moves.

    Parameters
    ----------
    what : str
        What is counted, in the plural.
    """
    start = time.monotonic()
    ended = False
    show = _in_notebook() or _on_terminal

    def report(finished: int, total: int) -> None:
        nonlocal ended
        if total == 0 or ended:
            return
        ended = finished == total
        rate = finished / max(time.monotonic() - start, 1e-9)
        left = f", {(total - finished) / rate:.0f} s left" if 0 < finished < total else ""
        show(finished, total, f"{finished} of {total} {what}, {rate:.0f} a second{left}")

    return report


def _on_terminal(finished: int, total: int, words: str) -> None:
    if not sys.stderr.isatty():
        # A file keeps what a terminal writes over: the end alone.
        if finished == total:
            sys.stderr.write(f"{words}\n")
        return
    sys.stderr.write(f"\r{words}   " + ("\n" if finished == total else ""))
    sys.stderr.flush()


def _in_notebook() -> Callable[[int, int, str], None] | None:
    """What shows progress in a notebook; none elsewhere."""
    if "IPython" not in sys.modules:
        return None
    from IPython import get_ipython
    from IPython.display import HTML, display

    if getattr(get_ipython(), "kernel", None) is None:
        return None
    bar: Any = None
    last = 0.0

    def show(finished: int, total: int, words: str) -> None:
        nonlocal bar, last
        now = time.monotonic()
        if bar is not None and finished < total and now < last + SHORTEST_S:
            return
        last = now
        page = HTML(f'<progress value="{finished}" max="{total}" style="width:20em"></progress> {escape(words)}')
        if bar is None:
            bar = display(page, display_id=True)
        else:
            bar.update(page)

    return show
