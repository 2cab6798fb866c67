"""Damage to a tooth: one class for each kind.

Their fields have the names, units and defaults of the scenario file's sections ``[[fault]]``. Every fault has ``wheel``, 'gear' or
'pinion', and ``tooth``, its number from 1; the gear's first tooth by default.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Literal, Union

__all__ = [
    "Fault",
    "MissingTooth",
    "PartialFace",
    "PitCircle",
    "ThroughFace",
    "ToothBreakage",
    "ToothDestruction",
]


def _keys(value: Any) -> dict[str, Any]:
    """The fields that are set, as the scenario file has them."""
    keys: dict[str, Any] = {}
    for field in fields(value):
        entry = getattr(value, field.name)
        if entry is not None:
            keys[field.name] = _keys(entry) if isinstance(entry, PitCircle) else entry
    return keys


@dataclass(frozen=True)
class PitCircle:
    """The circle that a pit is cut by, in the tooth's own plane.

    Parameters
    ----------
    x_mm, y_mm : float
        (mm) Centre; x along the tooth from the wheel's centre, y across it.
    radius_mm : float
        (mm) Radius.
    """

    x_mm: float
    y_mm: float
    radius_mm: float


@dataclass(frozen=True)
class MissingTooth:
    """The tooth is gone.

    Parameters
    ----------
    wheel : {'gear', 'pinion'}, optional
        The damaged wheel.
    tooth : int, optional
        The number of the damaged tooth, from 1, in the order in which the teeth enter contact.

    Examples
    --------
    >>> MissingTooth(wheel="pinion", tooth=3)
    MissingTooth(wheel='pinion', tooth=3)
    """

    kind: ClassVar[str] = "missing-tooth"
    wheel: Literal["gear", "pinion"] = "gear"
    tooth: int = 1


@dataclass(frozen=True)
class ToothBreakage:
    """A corner of the tooth has chipped off.

    Parameters
    ----------
    chip_height_mm : float
        (mm) Extent of the chip from the tip towards the root.
    chip_width_mm : float
        (mm) Extent of the chip along the face width, at the tip.
    tip_loss_mm : float, optional
        (mm) Length of the tip that is lost over the whole width. 0 by default.
    wheel : {'gear', 'pinion'}, optional
        The damaged wheel.
    tooth : int, optional
        The number of the damaged tooth, from 1, in the order in which the teeth enter contact.

    Examples
    --------
    >>> ToothBreakage(chip_height_mm=5.0, chip_width_mm=12.0)
    ToothBreakage(chip_height_mm=5.0, chip_width_mm=12.0, tip_loss_mm=None, wheel='gear', tooth=1)
    """

    kind: ClassVar[str] = "tooth-breakage"
    chip_height_mm: float
    chip_width_mm: float
    tip_loss_mm: float | None = None
    wheel: Literal["gear", "pinion"] = "gear"
    tooth: int = 1


@dataclass(frozen=True)
class PartialFace:
    """A pit over a part of the face width.

    The pit is given by ``start``, ``end`` and ``depth``, or by ``circle``.

    Parameters
    ----------
    width_mm : float
        (mm) Width of the pit along the face.
    start, end : float, optional
        (-) Where it starts and ends, as fractions of the part of the flank that is in contact, from the root.
    depth : float, optional
        (-) Depth over half its length.
    circle : PitCircle, optional
        The circle that cuts the pit out.
    wheel : {'gear', 'pinion'}, optional
        The damaged wheel.
    tooth : int, optional
        The number of the damaged tooth, from 1, in the order in which the teeth enter contact.
    """

    kind: ClassVar[str] = "partial-face"
    width_mm: float
    start: float | None = None
    end: float | None = None
    depth: float | None = None
    circle: PitCircle | None = None
    wheel: Literal["gear", "pinion"] = "gear"
    tooth: int = 1


@dataclass(frozen=True)
class ThroughFace:
    """A pit over the whole face width.

    The pit is given by ``start``, ``end`` and ``depth``, or by ``circle``.

    Parameters
    ----------
    start, end : float, optional
        (-) Where it starts and ends, as fractions of the part of the flank that is in contact, from the root.
    depth : float, optional
        (-) Depth over half its length.
    circle : PitCircle, optional
        The circle that cuts the pit out.
    wheel : {'gear', 'pinion'}, optional
        The damaged wheel.
    tooth : int, optional
        The number of the damaged tooth, from 1, in the order in which the teeth enter contact.
    """

    kind: ClassVar[str] = "through-face"
    start: float | None = None
    end: float | None = None
    depth: float | None = None
    circle: PitCircle | None = None
    wheel: Literal["gear", "pinion"] = "gear"
    tooth: int = 1


@dataclass(frozen=True)
class ToothDestruction:
    """The flank has been worn away along a straight line.

    Parameters
    ----------
    start : float
        (-) Where the destruction starts, as a fraction of the part of the flank that is in contact, from the root.
    end : float, optional
        (-) Where it ends, if ``slope_deg`` is not given.
    slope_deg : float, optional
        (°) Slope of the line, if ``end`` is not given.
    offset_mm : float, optional
        (mm) Shift of the line into the tooth. 0 by default.
    noise_mm : float, optional
        (mm) Roughness of the line. 0 by default.
    wheel : {'gear', 'pinion'}, optional
        The damaged wheel.
    tooth : int, optional
        The number of the damaged tooth, from 1, in the order in which the teeth enter contact.
    """

    kind: ClassVar[str] = "tooth-destruction"
    start: float
    end: float | None = None
    slope_deg: float | None = None
    offset_mm: float | None = None
    noise_mm: float | None = None
    wheel: Literal["gear", "pinion"] = "gear"
    tooth: int = 1


Fault = Union[MissingTooth, ToothBreakage, PartialFace, ThroughFace, ToothDestruction]
"""Any of the five faults."""

_KINDS: dict[str, type[Any]] = {
    kind.kind: kind for kind in (MissingTooth, ToothBreakage, PartialFace, ThroughFace, ToothDestruction)
}


def to_section(fault: Any) -> dict[str, Any]:
    """The section of a fault in a scenario file."""
    if fault in _KINDS.values():
        raise TypeError(f"fault is the class {fault.__name__}: give one of its objects, {fault.__name__}(…)")
    if type(fault) not in _KINDS.values():
        kinds = ", ".join(kind.__name__ for kind in _KINDS.values())
        raise TypeError(f"fault = {fault!r}: must be an object of {kinds}, or None for a healthy pair")
    circle = getattr(fault, "circle", None)
    if circle is not None and not isinstance(circle, PitCircle):
        raise TypeError(f"circle = {circle!r}: must be a PitCircle(x_mm, y_mm, radius_mm)")
    return {"kind": fault.kind, **_keys(fault)}


def from_section(section: Mapping[str, Any]) -> Fault:
    """The fault that a section of a scenario file describes."""
    keys = dict(section)
    kind = _KINDS[keys.pop("kind")]
    if "circle" in keys:
        keys["circle"] = PitCircle(**keys["circle"])
    fault: Fault = kind(**keys)
    return fault


def in_words(faults: Sequence[Fault]) -> str:
    """Kinds of the faults, and where they are if that is not the gear's first tooth; 'healthy' if there is none."""
    if not faults:
        return "healthy"
    first = faults[0]
    if len(faults) == 1 and (first.wheel, first.tooth) == ("gear", 1):
        return first.kind
    return ", ".join(f"{fault.kind} of {fault.wheel} tooth {fault.tooth}" for fault in faults)
