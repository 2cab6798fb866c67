"""Sensors on the rig, whose signals a simulation shows first.

The fields of :class:`Sensor` have the names, units and defaults of the scenario file's sections ``[[sensor]]``; all may be left out.

>>> from meshtone import Sensor, examples, simulate
>>> scenario = examples.healthy().copy(sampling_rate_hz=2e4, sensors=[Sensor(resonance_hz=6e3, range_g=50, bits=16)])
>>> simulation = simulate(scenario)
>>> simulation.pinion_support_vertical_g is simulation.sensors["pinion_support_vertical"]
True
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Any

from ._sensor import Sensor

__all__ = ["Sensor"]


def to_section(sensor: Any, argument: str) -> dict[str, Any]:
    """The section of a sensor in a scenario file.

    Parameters
    ----------
    sensor : Sensor
        The sensor.
    argument : str
        What it was given as, for messages.
    """
    if sensor is Sensor:
        raise TypeError(f"{argument} is the class Sensor: give one of its objects, Sensor(…)")
    if not isinstance(sensor, Sensor):
        raise TypeError(f"{argument} = {sensor!r}: must be a Sensor")
    entries = {field.name: getattr(sensor, field.name) for field in fields(sensor)}
    return {name: entry for name, entry in entries.items() if entry is not None}


def sections_of(sensors: Any) -> list[dict[str, Any]]:
    """The sections of all sensors.

    Parameters
    ----------
    sensors : sequence of Sensor or None
        None for no sensors.
    """
    if sensors is None:
        return []
    if not isinstance(sensors, Sequence) or isinstance(sensors, str):
        raise TypeError(f"sensors = {sensors!r}: must be a sequence of sensors: [Sensor(…)]")
    return [to_section(sensor, f"sensors[{index}]") for index, sensor in enumerate(sensors)]
