"""Scenarios of gearboxes: several meshes on common shafts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, Union

from . import _core
from ._keys import (
    GearboxBearing,
    GearboxHousing,
    GearboxMesh,
    GearboxOperation,
    GearboxPlanetary,
    GearboxSensor,
    GearboxShaft,
    GearboxSolver,
    GearboxWheel,
)
from ._sensor import Sensor
from .faults import Fault
from .scenario import Scenario, gearbox_of

__all__ = ["Gearbox", "gearbox_template"]

_Table = Mapping[str, Any]


def Gearbox(
    *,
    shafts: Sequence[GearboxShaft],
    bearings: Sequence[GearboxBearing],
    operation: GearboxOperation,
    wheels: Sequence[GearboxWheel] = (),
    meshes: Sequence[GearboxMesh] = (),
    planetary: Sequence[GearboxPlanetary] = (),
    housing: GearboxHousing | None = None,
    faults: Sequence[Union[Fault, _Table]] = (),
    sensors: Sequence[Union[Sensor, GearboxSensor]] = (),
    solver: GearboxSolver | None = None,
    material: str | _Table = "steel",
    seed: int = 1,
) -> Scenario:
    """A scenario of wheels on shafts of beams, in bearings and a housing.

    Each list has a dictionary for an entry, with the keys of that section of the scenario file, its names, units and defaults: the guide's
    chapter "Gearboxes" lists them.

    Parameters
    ----------
    shafts : sequence of dict
        ``name``, ``length_mm``, ``radius_mm`` and so on of each; one couples to the motor, one to the brake.
    wheels : sequence of dict
        ``name``, ``shaft``, ``at``, ``teeth``, ``face_width_mm`` and so on of each.
    meshes : sequence of dict
        ``wheels``, the names of the driving and of the driven one, ``module_mm`` and so on of each.
    planetary : sequence of dict
        ``name``, ``sun``, ``carrier``, ``ring``, ``teeth`` and so on of each planetary set.
    bearings : sequence of dict
        ``shaft``, ``at`` and so on of each.
    operation : dict
        ``input_speed_hz``, ``brake_torque_nm`` and so on.
    housing : dict, optional
        ``mass_kg`` and so on; ``{}`` for a housing with the defaults. Without it the bearings' seats stand on the ground.
    faults : sequence of faults or dict, optional
        Objects as of a pair, with the name of a wheel; or ``wheel``, ``kind`` and the sizes or the ``severity`` of each. A
        spall of a rolling bearing is a ``defect`` of its entry in ``bearings``.
    sensors : sequence of Sensor or dict, optional
        ``at``, ``direction`` and so on of each. Without one, a vertical one sits on every bearing's seat.
    solver : dict, optional
        ``sampling_rate_hz``, ``duration_s`` and so on.
    material : str or dict, optional
        Material of shafts and wheels: a name, or ``youngs_modulus_gpa``, ``poisson_ratio`` and ``density_kg_per_m3``.
    seed : int, optional
        Of every random draw.

    Returns
    -------
    Scenario

    Raises
    ------
    ValueError
        A key that there is not, a value that is not allowed, parts that do not fit one another.

    Examples
    --------
    >>> from meshtone import Gearbox
    >>> gearbox = Gearbox(
    ...     shafts=[{"name": "input", "length_mm": 200, "radius_mm": 10, "couples_to": "motor"},
    ...             {"name": "output", "length_mm": 200, "radius_mm": 10, "couples_to": "brake"}],
    ...     wheels=[{"name": "z1", "shaft": "input", "at": 0.5, "teeth": 17, "face_width_mm": 15},
    ...             {"name": "z2", "shaft": "output", "at": 0.5, "teeth": 38, "face_width_mm": 15}],
    ...     meshes=[{"wheels": ["z1", "z2"], "module_mm": 3}],
    ...     bearings=[{"shaft": shaft, "at": at} for shaft in ("input", "output") for at in (0.0, 1.0)],
    ...     operation={"input_speed_hz": 40, "brake_torque_nm": 10},
    ... )
    >>> gearbox
    <Gearbox of 2 shafts and meshes z1-z2>
    >>> gearbox.sections["mesh"][0]["pressure_angle_deg"]
    20.0
    """
    return Scenario._wrap(gearbox_of(dict(locals()), {}))


def gearbox_template(rig: Literal["phm2009-spur", "phm2009-helical", "uconn", "tecnalia", "nrel-grc", "planetary-lab", "oedi-623"] | None = None) -> str:
    """A commented gearbox to start from, as a scenario file: :meth:`Scenario.from_toml` reads it.

    Parameters
    ----------
    rig : {'phm2009-spur', 'phm2009-helical', 'uconn', 'tecnalia', 'nrel-grc', 'planetary-lab', 'oedi-623'}, optional
        A rig of which what is published stands in the file, with what has to be assumed marked so; an example by default.
    """
    return _core.gearbox_template(rig)
