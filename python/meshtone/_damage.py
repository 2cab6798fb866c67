"""A class for each kind of damage.

Written by `cargo xtask generate` from the rows of the Rust library: a change belongs there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Union

__all__ = [
    "Fault",
    "MissingTooth",
    "PartialFace",
    "PitCircle",
    "Pits",
    "RandomPits",
    "RootCrack",
    "ThroughFace",
    "ToothBreakage",
    "ToothDestruction",
    "Wear",
]


@dataclass(frozen=True)
class PitCircle:
    """The circle that is cut into the flank, instead of start, end and depth.

    Parameters
    ----------
    x_mm : float
        (mm) The centre's position along the tooth's centre line, from the wheel's centre. Allowed: > 0.
    y_mm : float
        (mm) The centre's distance from the tooth's centre line, towards the working flank.
    radius_mm : float
        (mm) The circle's radius. Allowed: > 0.
    """

    x_mm: float
    y_mm: float
    radius_mm: float


@dataclass(frozen=True)
class RandomPits:
    """Pits that are drawn for each tooth from the seed, instead of a list.

    Parameters
    ----------
    density_per_cm2 : float
        (1/cm²) The mean number of pits in a square centimetre of flank; Poisson. Allowed: ≥ 0; at most 1000 a tooth.
    spread : float
        (-) The standard deviation of their centres about the working pitch circle, a fraction of the contact part;
        normal. Allowed: 0…1.
    radius_mm : float
        (mm) The median of their radii; lognormal. Allowed: > 0.
    radius_spread : float
        (-) The standard deviation of the radii's natural logarithm. Allowed: 0…2.
    depth_mm : float
        (mm) The depth of all, along the flank's normal. Allowed: ≥ 0.
    """

    density_per_cm2: float
    spread: float
    radius_mm: float
    radius_spread: float
    depth_mm: float


@dataclass(frozen=True)
class MissingTooth:
    """The tooth is gone.

    Parameters
    ----------
    wheel : str, optional
        The damaged wheel. Allowed: "pinion", "gear", or the name of a wheel of a gearbox. Default: "gear".
    tooth : int, sequence of ints or 'all', optional
        The damaged tooth's number, in the order of entering contact; an array of several, or "all". Allowed: whole
        number > 0; at most the wheel's teeth, each once. Default: 1.
    severity : float, optional
        (-) The severity of the damage, instead of its sizes: 0 is none, 1 the largest that the tooth allows. Allowed:
        0…1; 1 for a missing tooth. Default: that of the sizes.
    flank : {'sun', 'ring', 'both'}, optional
        The flank of a planet's tooth that is damaged, that which meets the sun or that which meets the ring. Default:
        both.
    """

    kind: ClassVar[str] = "missing-tooth"
    wheel: str = "gear"
    tooth: int | Sequence[int] | Literal["all"] = 1
    severity: float | None = None
    flank: Literal["sun", "ring", "both"] | None = None


@dataclass(frozen=True)
class ToothBreakage:
    """A corner of the tooth has chipped off.

    Parameters
    ----------
    chip_height_mm : float, optional
        (mm) The extent of the chipped corner from the tip along the tooth. Allowed: > 0; less than the tooth's height.
        Required, unless ``severity`` is given.
    chip_width_mm : float, optional
        (mm) Its extent along the face width, at the tip. Allowed: > 0; at most the face width. Required, unless
        ``severity`` is given.
    tip_loss_mm : float, optional
        (mm) The length of tip that is lost over the whole width. Allowed: ≥ 0; less than the tooth's height. Default:
        0.0.
    wheel : str, optional
        The damaged wheel. Allowed: "pinion", "gear", or the name of a wheel of a gearbox. Default: "gear".
    tooth : int, sequence of ints or 'all', optional
        The damaged tooth's number, in the order of entering contact; an array of several, or "all". Allowed: whole
        number > 0; at most the wheel's teeth, each once. Default: 1.
    severity : float, optional
        (-) The severity of the damage, instead of its sizes: 0 is none, 1 the largest that the tooth allows. Allowed:
        0…1; 1 for a missing tooth. Default: that of the sizes.
    flank : {'sun', 'ring', 'both'}, optional
        The flank of a planet's tooth that is damaged, that which meets the sun or that which meets the ring. Default:
        both.
    """

    kind: ClassVar[str] = "tooth-breakage"
    chip_height_mm: float | None = None
    chip_width_mm: float | None = None
    tip_loss_mm: float | None = None
    wheel: str = "gear"
    tooth: int | Sequence[int] | Literal["all"] = 1
    severity: float | None = None
    flank: Literal["sun", "ring", "both"] | None = None


@dataclass(frozen=True)
class RootCrack:
    """The root is cracked on the side of the working flank.

    Parameters
    ----------
    depth_mm : float, optional
        (mm) The depth of the crack from the fillet, where it is deepest. Allowed: ≥ 0; must not pass the tooth's centre
        line. Required, unless ``severity`` is given.
    angle_deg : float, optional
        (°) The crack's angle to the tooth's centre line. Allowed: > 0, ≤ 90. Default: 45.0.
    length_mm : float, optional
        (mm) The length of the crack along the face, deepest at one side and ending in a parabola. Allowed: > 0; at most
        the face width. Default: over the whole face, equally deep.
    wheel : str, optional
        The damaged wheel. Allowed: "pinion", "gear", or the name of a wheel of a gearbox. Default: "gear".
    tooth : int, sequence of ints or 'all', optional
        The damaged tooth's number, in the order of entering contact; an array of several, or "all". Allowed: whole
        number > 0; at most the wheel's teeth, each once. Default: 1.
    severity : float, optional
        (-) The severity of the damage, instead of its sizes: 0 is none, 1 the largest that the tooth allows. Allowed:
        0…1; 1 for a missing tooth. Default: that of the sizes.
    flank : {'sun', 'ring', 'both'}, optional
        The flank of a planet's tooth that is damaged, that which meets the sun or that which meets the ring. Default:
        both.
    """

    kind: ClassVar[str] = "root-crack"
    depth_mm: float | None = None
    angle_deg: float | None = None
    length_mm: float | None = None
    wheel: str = "gear"
    tooth: int | Sequence[int] | Literal["all"] = 1
    severity: float | None = None
    flank: Literal["sun", "ring", "both"] | None = None


@dataclass(frozen=True)
class PartialFace:
    """A pit in the flank, over a part of the face width, from one side.

    Parameters
    ----------
    width_mm : float, optional
        (mm) The width of the pit along the face, from one side. Allowed: > 0; less than the face width. Required,
        unless ``severity`` is given.
    start : float, optional
        (-) The pit's first edge, a fraction of the flank's contact part from its root. Allowed: ≥ 0, < 1. Required,
        unless ``circle`` or ``severity`` is given.
    end : float, optional
        (-) The pit's second edge, likewise. Allowed: more than ``start``, ≤ 1. Required, unless ``circle`` or
        ``severity`` is given.
    depth : float, optional
        (-) The pit's depth over half its chord. Allowed: > 0, ≤ 1; the circle must not undercut the flank: about 0.7 in
        its middle, 0.4 at the tip. Required, unless ``circle`` or ``severity`` is given.
    circle : PitCircle, optional
        The circle that is cut into the flank, instead of start, end and depth. Allowed: must cut the flank twice.
        Default: none.
    wheel : str, optional
        The damaged wheel. Allowed: "pinion", "gear", or the name of a wheel of a gearbox. Default: "gear".
    tooth : int, sequence of ints or 'all', optional
        The damaged tooth's number, in the order of entering contact; an array of several, or "all". Allowed: whole
        number > 0; at most the wheel's teeth, each once. Default: 1.
    severity : float, optional
        (-) The severity of the damage, instead of its sizes: 0 is none, 1 the largest that the tooth allows. Allowed:
        0…1; 1 for a missing tooth. Default: that of the sizes.
    flank : {'sun', 'ring', 'both'}, optional
        The flank of a planet's tooth that is damaged, that which meets the sun or that which meets the ring. Default:
        both.
    """

    kind: ClassVar[str] = "partial-face"
    width_mm: float | None = None
    start: float | None = None
    end: float | None = None
    depth: float | None = None
    circle: PitCircle | None = None
    wheel: str = "gear"
    tooth: int | Sequence[int] | Literal["all"] = 1
    severity: float | None = None
    flank: Literal["sun", "ring", "both"] | None = None


@dataclass(frozen=True)
class ThroughFace:
    """A pit in the flank, over the whole face width.

    Parameters
    ----------
    start : float, optional
        (-) The pit's first edge, a fraction of the flank's contact part from its root. Allowed: ≥ 0, < 1. Required,
        unless ``circle`` or ``severity`` is given.
    end : float, optional
        (-) The pit's second edge, likewise. Allowed: more than ``start``, ≤ 1. Required, unless ``circle`` or
        ``severity`` is given.
    depth : float, optional
        (-) The pit's depth over half its chord. Allowed: > 0, ≤ 1; the circle must not undercut the flank: about 0.7 in
        its middle, 0.4 at the tip. Required, unless ``circle`` or ``severity`` is given.
    circle : PitCircle, optional
        The circle that is cut into the flank, instead of start, end and depth. Allowed: must cut the flank twice.
        Default: none.
    wheel : str, optional
        The damaged wheel. Allowed: "pinion", "gear", or the name of a wheel of a gearbox. Default: "gear".
    tooth : int, sequence of ints or 'all', optional
        The damaged tooth's number, in the order of entering contact; an array of several, or "all". Allowed: whole
        number > 0; at most the wheel's teeth, each once. Default: 1.
    severity : float, optional
        (-) The severity of the damage, instead of its sizes: 0 is none, 1 the largest that the tooth allows. Allowed:
        0…1; 1 for a missing tooth. Default: that of the sizes.
    flank : {'sun', 'ring', 'both'}, optional
        The flank of a planet's tooth that is damaged, that which meets the sun or that which meets the ring. Default:
        both.
    """

    kind: ClassVar[str] = "through-face"
    start: float | None = None
    end: float | None = None
    depth: float | None = None
    circle: PitCircle | None = None
    wheel: str = "gear"
    tooth: int | Sequence[int] | Literal["all"] = 1
    severity: float | None = None
    flank: Literal["sun", "ring", "both"] | None = None


@dataclass(frozen=True)
class Pits:
    """Pits in the working flank, any number of them.

    Parameters
    ----------
    at : sequence of floats, optional
        (-) The centre of each pit, a fraction of the flank's contact part from its root. Allowed: 0…1. Required, unless
        ``random`` or ``severity`` is given.
    z_mm : sequence of floats, optional
        (mm) The centre of each along the face, from the face's middle; one number per pit, as for all keys here.
        Allowed: within half the face width and the radius. Required, unless ``random`` or ``severity`` is given.
    radius_mm : sequence of floats, optional
        (mm) The radius of each along the flank. Allowed: > 0. Required, unless ``random`` or ``severity`` is given.
    face_radius_mm : sequence of floats, optional
        (mm) The radius of each along the face, for ellipses. Allowed: > 0. Default: ``radius_mm``: circles.
    depth_mm : sequence of floats, optional
        (mm) The depth of each, along the flank's normal. Allowed: ≥ 0; less than the tooth is thick. Required, unless
        ``random`` or ``severity`` is given.
    random : RandomPits, optional
        Pits that are drawn for each tooth from the seed, instead of a list. Default: none.
    wheel : str, optional
        The damaged wheel. Allowed: "pinion", "gear", or the name of a wheel of a gearbox. Default: "gear".
    tooth : int, sequence of ints or 'all', optional
        The damaged tooth's number, in the order of entering contact; an array of several, or "all". Allowed: whole
        number > 0; at most the wheel's teeth, each once. Default: 1.
    severity : float, optional
        (-) The severity of the damage, instead of its sizes: 0 is none, 1 the largest that the tooth allows. Allowed:
        0…1; 1 for a missing tooth. Default: that of the sizes.
    flank : {'sun', 'ring', 'both'}, optional
        The flank of a planet's tooth that is damaged, that which meets the sun or that which meets the ring. Default:
        both.
    """

    kind: ClassVar[str] = "pits"
    at: Sequence[float] | None = None
    z_mm: Sequence[float] | None = None
    radius_mm: Sequence[float] | None = None
    face_radius_mm: Sequence[float] | None = None
    depth_mm: Sequence[float] | None = None
    random: RandomPits | None = None
    wheel: str = "gear"
    tooth: int | Sequence[int] | Literal["all"] = 1
    severity: float | None = None
    flank: Literal["sun", "ring", "both"] | None = None


@dataclass(frozen=True)
class ToothDestruction:
    """The working flank is ground down along a straight line.

    Parameters
    ----------
    start : float, optional
        (-) Where the ground line begins, a fraction of the flank's contact part from its root; negative: below it.
        Allowed: > −1, < 1. Required, unless ``severity`` is given.
    end : float, optional
        (-) The flank point to which the line leads, likewise. Allowed: more than ``start``, ≤ 1. Required, unless
        ``slope_deg`` or ``severity`` is given.
    slope_deg : float, optional
        (°) The angle to the tooth's centre line by which the line falls towards the tip, instead of end. Allowed: > 0,
        < 90. Default: none.
    offset_mm : float, optional
        (mm) How far inside the flank the line begins. Allowed: ≥ 0; less than π/4 modules, half the tooth's thickness.
        Default: 0.0.
    noise_mm : float, optional
        (mm) The amplitude of the uniform random roughness of the ground flank. Allowed: ≥ 0; likewise. Default: 0.0.
    wheel : str, optional
        The damaged wheel. Allowed: "pinion", "gear", or the name of a wheel of a gearbox. Default: "gear".
    tooth : int, sequence of ints or 'all', optional
        The damaged tooth's number, in the order of entering contact; an array of several, or "all". Allowed: whole
        number > 0; at most the wheel's teeth, each once. Default: 1.
    severity : float, optional
        (-) The severity of the damage, instead of its sizes: 0 is none, 1 the largest that the tooth allows. Allowed:
        0…1; 1 for a missing tooth. Default: that of the sizes.
    flank : {'sun', 'ring', 'both'}, optional
        The flank of a planet's tooth that is damaged, that which meets the sun or that which meets the ring. Default:
        both.
    """

    kind: ClassVar[str] = "tooth-destruction"
    start: float | None = None
    end: float | None = None
    slope_deg: float | None = None
    offset_mm: float | None = None
    noise_mm: float | None = None
    wheel: str = "gear"
    tooth: int | Sequence[int] | Literal["all"] = 1
    severity: float | None = None
    flank: Literal["sun", "ring", "both"] | None = None


@dataclass(frozen=True)
class Wear:
    """The working flanks are worn by sliding.

    Parameters
    ----------
    depth_um : float, optional
        (µm) The largest depth of wear, along the flank's normal. Allowed: 0…100. Required, unless ``severity`` is
        given.
    wheel : str, optional
        The damaged wheel. Allowed: "pinion", "gear", or the name of a wheel of a gearbox. Default: "gear".
    tooth : int, sequence of ints or 'all', optional
        The damaged tooth's number, in the order of entering contact; an array of several, or "all". Allowed: whole
        number > 0; at most the wheel's teeth, each once. Default: "all".
    severity : float, optional
        (-) The severity of the damage, instead of its sizes: 0 is none, 1 the largest that the tooth allows. Allowed:
        0…1; 1 for a missing tooth. Default: that of the sizes.
    flank : {'sun', 'ring', 'both'}, optional
        The flank of a planet's tooth that is damaged, that which meets the sun or that which meets the ring. Default:
        both.
    """

    kind: ClassVar[str] = "wear"
    depth_um: float | None = None
    wheel: str = "gear"
    tooth: int | Sequence[int] | Literal["all"] = "all"
    severity: float | None = None
    flank: Literal["sun", "ring", "both"] | None = None


Fault = Union[MissingTooth, ToothBreakage, RootCrack, PartialFace, ThroughFace, Pits, ToothDestruction, Wear]
"""Any kind of damage."""

KINDS: tuple[type[Any], ...] = (MissingTooth, ToothBreakage, RootCrack, PartialFace, ThroughFace, Pits, ToothDestruction, Wear)
"""The classes."""

TABLES: dict[str, type[Any]] = {"circle": PitCircle, "random": RandomPits}
"""Classes of the tables inside a fault, by key."""
