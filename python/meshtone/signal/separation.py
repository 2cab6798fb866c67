"""What of an average the mesh makes, and what is left."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy.typing as npt

from .. import _core
from ._arguments import Array, regular_part, signal_array, teeth_number


@dataclass(frozen=True)
class Parts:
    """Parts of an average, in its unit.

    Attributes
    ----------
    regular : array, shape (points,)
        Mesh harmonics, their sidebands and the low orders of the shaft.
    residual : array, shape (points,)
        The average without the mesh harmonics and the low orders of the shaft; the sidebands stay in it.
    difference : array, shape (points,)
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
        (any unit) One revolution at equal angles.
    teeth : int
        Of the wheel.
    sidebands : int, optional
        Sidebands on either side of each mesh harmonic that belong to the regular part; 2 by default.
    shaft_orders : sequence of int, optional
        Orders of the shaft that belong to the regular part; 1 to 7 by default.

    Returns
    -------
    Parts

    Raises
    ------
    ValueError
        NaN; a mesh order beyond the Nyquist order; so many sidebands that those of two mesh harmonics meet.

    Notes
    -----
    P. D. McFadden, Journal of Vibration and Acoustics 108 (1986) 165–170; J. J. Zakrajsek, D. P. Townsend, H. J. Decker, NASA
    TM-105950 (1993).

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
