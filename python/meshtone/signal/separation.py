"""What of an average the mesh makes, and what is left."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy.typing as npt

from .. import _core
from ._arguments import Array, regular_part, signal_array, teeth_number


@dataclass(frozen=True)
class Parts:
    """Parts of an average; they are as long as it.

    Attributes
    ----------
    regular : array
        Mesh harmonics and their sidebands.
    residual : array
        The average without the mesh harmonics.
    difference : array
        The average without the regular part.
    """

    regular: Array
    residual: Array
    difference: Array


def separate(
    average: npt.ArrayLike,
    teeth: int,
    *,
    sidebands: int | None = None,
    shaft_orders: Sequence[int] | None = None,
) -> Parts:
    """Separate an average into its parts.

    Parameters
    ----------
    average : array_like, shape (points,)
        One revolution at equal angles.
    teeth : int
        Of the wheel.
    sidebands : int, optional
        Sidebands on either side of each mesh harmonic that belong to the regular part.
    shaft_orders : sequence of int, optional
        Orders of the shaft that belong to the regular part.

    Returns
    -------
    Parts

    Raises
    ------
    ValueError
        NaN; a mesh order beyond the Nyquist order.

    Examples
    --------
    >>> import numpy as np
    >>> angle = 2 * np.pi * np.arange(256) / 256
    >>> parts = separate(2 * np.cos(20 * angle) + np.cos(28 * angle), teeth=20)
    >>> round(float(np.abs(parts.difference).max()), 6)
    1.0
    """
    bands, orders = regular_part(sidebands, shaft_orders)
    return Parts(*_core.separate(signal_array(average), teeth_number(teeth), bands, orders))
