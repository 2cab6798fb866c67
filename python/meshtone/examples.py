"""Scenarios to start from: the pair of the paper's examples, healthy and with each fault; and recordings to try.

Examples
--------
>>> from meshtone import examples
>>> examples.tooth_breakage().fault
ToothBreakage(chip_height_mm=5.0, chip_width_mm=12.0, tip_loss_mm=3.0, wheel='gear', tooth=1, severity=None, flank=None)
>>> sorted(examples.all())
['healthy', 'missing-tooth', 'partial-face', 'pits', 'root-crack', 'through-face', 'tooth-breakage', 'tooth-destruction', 'wear']
"""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from ._core import recording_files
from ._files import written_whole
from .scenario import Scenario, template

__all__ = [
    "all",
    "healthy",
    "missing_tooth",
    "partial_face",
    "pits",
    "recordings",
    "root_crack",
    "through_face",
    "tooth_breakage",
    "tooth_destruction",
    "wear",
]


def healthy() -> Scenario:
    """A healthy pair, 17 and 38 teeth, 40 Hz, 10 N m, DIN grade 7."""
    return Scenario.from_toml(template("healthy"))


def missing_tooth() -> Scenario:
    """The same pair without the gear's first tooth."""
    return Scenario.from_toml(template("missing-tooth"))


def tooth_breakage() -> Scenario:
    """The same pair with a chipped tooth."""
    return Scenario.from_toml(template("tooth-breakage"))


def root_crack() -> Scenario:
    """The same pair with a crack in a tooth's root."""
    return Scenario.from_toml(template("root-crack"))


def partial_face() -> Scenario:
    """The same pair with a pit over a part of the face width."""
    return Scenario.from_toml(template("partial-face"))


def pits() -> Scenario:
    """The same pair with three pits in a flank."""
    return Scenario.from_toml(template("pits"))


def through_face() -> Scenario:
    """The same pair with a pit over the whole face width."""
    return Scenario.from_toml(template("through-face"))


def tooth_destruction() -> Scenario:
    """A pair with a flank that has been worn away."""
    return Scenario.from_toml(template("tooth-destruction"))


def wear() -> Scenario:
    """The same pair with all teeth of the gear worn."""
    return Scenario.from_toml(template("wear"))


def all() -> dict[str, Scenario]:
    """All of them, by the kind of fault."""
    return {
        "healthy": healthy(),
        "missing-tooth": missing_tooth(),
        "tooth-breakage": tooth_breakage(),
        "root-crack": root_crack(),
        "partial-face": partial_face(),
        "pits": pits(),
        "through-face": through_face(),
        "tooth-destruction": tooth_destruction(),
        "wear": wear(),
    }


def recordings(folder: str | PathLike[str] = "recordings") -> Path:
    """Recordings of simulated machines, as ``meshtone init recordings`` writes them: 25 files, 25 MB.

    They are of this pair and of a gearbox: healthy, with a broken tooth, with a spall in a bearing, during a run-up, and on twelve days
    on which a tooth breaks. ``README.md`` says what is in each.

    Parameters
    ----------
    folder : str or path
        Where they are written; it is made, and files of the same names are replaced.

    Returns
    -------
    pathlib.Path
        The folder.

    Raises
    ------
    OSError
        A file cannot be written.
    """
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    for name, content in recording_files():
        with written_whole(place / name) as stream:
            stream.write(content)
    return place
