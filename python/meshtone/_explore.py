"""A page on which a scenario is changed and seen at once."""

from __future__ import annotations

import sys
import webbrowser
from html import escape
from types import TracebackType

from . import _core
from .scenario import Scenario, native_scenario, template

__all__ = ["Explorer", "explore"]


class Explorer:
    """A page that :func:`explore` serves, until it is closed or no longer referred to.

    It is a context manager, which closes it at the end.
    """

    def __init__(self, scenario: Scenario, port: int, in_notebook: bool) -> None:
        self._server = _core.ExploreServer(native_scenario(scenario), port, in_notebook)

    @property
    def url(self) -> str | None:
        """The page's address, which only this machine can open; None once it is closed."""
        return self._server.url

    @property
    def scenario(self) -> Scenario:
        """What is set on the page: the scenario that was last answered in full; of a closed page the last of all."""
        return Scenario._wrap(self._server.scenario)

    def close(self) -> None:
        """Serve the page no longer."""
        self._server.close()

    def __enter__(self) -> Explorer:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"Explorer({self.url or 'closed'})"

    def _repr_html_(self) -> str:
        if self.url is None:
            return "<p>This page is closed.</p>"
        frame = 'style="width:100%;height:850px;border:1px solid #ccc" title="Meshtone: explore"'
        return f'<iframe src="{escape(self.url)}" {frame} allow="clipboard-write"></iframe>'


def explore(scenario: Scenario | None = None, *, port: int = 0, open_browser: bool | None = None) -> Explorer:
    """Open a page on which a scenario is changed and seen at once: teeth, forces, signal, spectra, indicators.

    The page is served by this process on this machine alone, in a thread that leaves Python free. In a notebook it appears where the
    result is shown; the notebook must run on the machine whose browser shows it.

    Parameters
    ----------
    scenario : Scenario, optional
        What the page opens with; a healthy pair by default. A gearbox has a page of its own.
    port : int
        Port of 127.0.0.1; 0, the default, for any that is free.
    open_browser : bool, optional
        Whether the browser opens it; by default it does, but not in a notebook.

    Returns
    -------
    Explorer
        ``scenario`` of it is what is set on the page.

    Raises
    ------
    OSError
        The port cannot be had.

    Examples
    --------
    >>> from meshtone import examples, explore
    >>> with explore(examples.tooth_breakage(), open_browser=False) as explorer:
    ...     explorer.scenario.fault.kind
    'tooth-breakage'
    >>> explorer
    Explorer(closed)
    """
    in_notebook = _in_notebook()
    explorer = Explorer(scenario if scenario is not None else Scenario.from_toml(template("healthy")), port, in_notebook)
    if open_browser is None:
        open_browser = not in_notebook
    if open_browser and explorer.url is not None:
        webbrowser.open(explorer.url)
    return explorer


def _in_notebook() -> bool:
    """Whether a notebook shows what is returned."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and hasattr(shell, "kernel")
