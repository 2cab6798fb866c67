"""Damage to a tooth: one class for each kind.

Their fields have the names, units and defaults of the scenario file's sections ``[[fault]]``. Every fault has ``wheel``, 'gear' or
'pinion', and ``tooth``: its number from 1, several numbers, or 'all'; the gear's first tooth by default. In place of its sizes it
may have ``severity``, from 0, none, to 1, the largest that the tooth allows: :meth:`Scenario.with_own_sizes` has the sizes.

>>> from meshtone import MissingTooth, RootCrack, ToothBreakage
>>> MissingTooth(wheel="pinion", tooth=3)
MissingTooth(wheel='pinion', tooth=3, severity=None, flank=None)
>>> RootCrack(depth_mm=1.0, tooth=[1, 2])
RootCrack(depth_mm=1.0, angle_deg=None, length_mm=None, wheel='gear', tooth=[1, 2], severity=None, flank=None)
>>> ToothBreakage(chip_height_mm=5.0, chip_width_mm=12.0)
ToothBreakage(chip_height_mm=5.0, chip_width_mm=12.0, tip_loss_mm=None, wheel='gear', tooth=1, severity=None, flank=None)
"""

from __future__ import annotations

import difflib
import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

from . import _damage
from ._damage import *
from ._damage import KINDS, TABLES, Fault, MissingTooth, ToothBreakage

__all__ = [*_damage.__all__]


def _with_plain_words(kind: type[Any]) -> None:
    """Lets a class take a dictionary for a table, and say which argument is meant by one that it does not have."""
    own: Callable[..., None] = kind.__init__
    known = [field.name for field in fields(kind)]

    @functools.wraps(own)
    def init(self: Any, *values: Any, **arguments: Any) -> None:
        for name in arguments:
            if name not in known:
                near = difflib.get_close_matches(name, known, n=1)
                words = f"did you mean '{near[0]}'?" if near else f"it has {', '.join(known)}"
                raise TypeError(f"{kind.__name__} has no argument '{name}'; {words}")
        tables = {name: table for name, table in TABLES.items() if isinstance(arguments.get(name), Mapping)}
        own(self, *values, **{**arguments, **{name: table(**arguments[name]) for name, table in tables.items()}})

    kind.__init__ = init


for _kind in (*KINDS, *TABLES.values()):
    _with_plain_words(_kind)


def _keys(value: Any) -> dict[str, Any]:
    """The fields that are set, as the scenario file has them."""
    entries = {field.name: getattr(value, field.name) for field in fields(value)}
    if isinstance(entries.get("tooth"), (tuple, range)):
        entries["tooth"] = list(entries["tooth"])
    return {
        name: _keys(entry) if is_dataclass(entry) else entry for name, entry in entries.items() if entry is not None
    }


def to_section(fault: Any, argument: str = "fault") -> dict[str, Any]:
    """The section of a fault in a scenario file.

    Parameters
    ----------
    fault : Fault
        The fault.
    argument : str
        What it was given as, for messages.
    """
    if fault in KINDS:
        raise TypeError(f"{argument} is the class {fault.__name__}: give one of its objects, {fault.__name__}(…)")
    if type(fault) not in KINDS:
        kinds = ", ".join(kind.__name__ for kind in KINDS)
        end = ", or None for a healthy pair" if argument == "fault" else ""
        raise TypeError(f"{argument} = {fault!r}: must be an object of {kinds}{end}")
    for name, table in TABLES.items():
        entry = getattr(fault, name, None)
        if entry is not None and not isinstance(entry, table):
            names = ", ".join(field.name for field in fields(table))
            raise TypeError(f"{name} = {entry!r}: must be a {table.__name__}({names})")
    return {"kind": fault.kind, **_keys(fault)}


def from_section(section: Mapping[str, Any]) -> Any:
    """The fault that a section of a scenario file describes; of a rolling bearing the section itself."""
    keys = dict(section)
    name = keys.pop("kind")
    kind = next((kind for kind in KINDS if kind.kind == name), None)
    if kind is None:
        return dict(section)
    for table in TABLES.keys() & keys.keys():
        keys[table] = TABLES[table](**keys[table])
    fault: Fault = kind(**keys)
    return fault


def in_words(faults: Sequence[Any]) -> str:
    """Kinds of the faults, and where they are if that is not the gear's first tooth; 'healthy' if there is none."""
    if not faults:
        return "healthy"
    first = faults[0]
    if len(faults) == 1 and not isinstance(first, Mapping) and (first.wheel, first.tooth) == ("gear", type(first).tooth):
        return str(first.kind)
    return ", ".join(map(_in_words, faults))


def _in_words(fault: Any) -> str:
    if isinstance(fault, Mapping):
        return f"{fault['kind']} of bearing {fault['bearing']}"
    return f"{fault.kind} of {_teeth_in_words(fault)}"


def _teeth_in_words(fault: Fault) -> str:
    if fault.tooth == "all":
        return f"all {fault.wheel} teeth"
    if isinstance(fault.tooth, int):
        return f"{fault.wheel} tooth {fault.tooth}"
    return f"{fault.wheel} teeth {', '.join(map(str, fault.tooth))}"
