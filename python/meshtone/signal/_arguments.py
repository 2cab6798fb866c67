"""Arguments as the compiled module takes them."""

from __future__ import annotations

import math
import operator
from collections.abc import Sequence
from typing import SupportsIndex

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def signal_array(values: npt.ArrayLike) -> Array:
    """A real signal of one dimension."""
    if np.ma.is_masked(values):
        raise ValueError("a signal has no masked values: fill them or cut them off, signal.compressed() leaves them out")
    array = np.asarray(values)
    if array.ndim != 1:
        raise ValueError(f"a signal has one dimension; given is an array of shape {array.shape}")
    if np.iscomplexobj(array):
        raise TypeError("a signal is real; given is an array of complex numbers")
    return np.ascontiguousarray(array, dtype=np.float64)


def finite_signal(values: npt.ArrayLike) -> Array:
    """A signal without NaN or infinity."""
    array = signal_array(values)
    wrong = np.flatnonzero(~np.isfinite(array))
    if wrong.size:
        raise ValueError(f"sample {wrong[0]} is {array[wrong[0]]}; {wrong.size} of {array.size} samples are not finite numbers")
    return array


def read_only(values: Array) -> Array:
    """What is handed out of an object: changing it would change what the object says of itself."""
    values.flags.writeable = False
    return values


def positive(name: str, value: float) -> float:
    """A number above 0 that an argument is, or an error that names it."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name} = {value!r}: must be a number") from None
    if not 0 < number < math.inf:
        raise ValueError(f"{name} = {number:g}: must be more than 0, and finite")
    return number


def whole(name: str, value: float | SupportsIndex, least: int = 0) -> int:
    """A whole number that an argument is, also as a float, which computing makes of it; or an error that names the argument."""
    if isinstance(value, (float, np.floating)) and value.is_integer():
        value = int(value)
    try:
        number = operator.index(value)  # type: ignore[arg-type]  # a float is no index, which the error says
    except TypeError:
        raise TypeError(f"{name} = {value!r}: must be a whole number") from None
    if number < least:
        raise ValueError(f"{name} = {number}: must be at least {least}")
    return number


def teeth_number(teeth: int) -> int:
    """A number of teeth."""
    return whole("teeth", teeth, 1)


def regular_part(sidebands: int | None, shaft_orders: Sequence[int] | None) -> tuple[int | None, list[int] | None]:
    """What belongs to the regular part, where it is given."""
    return (
        None if sidebands is None else whole("sidebands", sidebands),
        None if shaft_orders is None else [whole("shaft_orders", order) for order in shaft_orders],
    )


def separation_settings(teeth: int, sidebands: int | None, shaft_orders: Sequence[int] | None) -> dict[str, object] | None:
    """The same with the teeth; None where nothing is given."""
    if sidebands is None and shaft_orders is None:
        return None
    bands, orders = regular_part(sidebands, shaft_orders)
    return {"teeth": teeth_number(teeth), "sidebands": bands, "shaft_orders": orders}
