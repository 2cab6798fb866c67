"""The orders of a shaft over the time of a run-up."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .. import _core
from ._arguments import Array, positive, signal_array, whole
from .phase import ShaftPhase, native_phase

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False)
class OrderMap:
    """Amplitudes over the order of a shaft and over time.

    Attributes
    ----------
    orders : array, shape (orders,)
        Orders of the shaft, from 0 in steps of 1/revolutions.
    time_s : array, shape (parts,)
        (s) Time of the middle of each part, since the first sample.
    speed_hz : array, shape (parts,)
        (rev/s) Mean speed of the shaft in each part.
    amplitude : array, shape (parts, orders)
        In the signal's unit; of a cosine its amplitude.
    revolutions : int
        (rev) Length of a part.
    """

    orders: Array
    time_s: Array
    speed_hz: Array
    amplitude: Array
    revolutions: int

    def plot(self, teeth: int | None = None, *, over: str = "time", ax: Axes | None = None) -> Axes:
        """Amplitudes over order and time or speed. See :func:`meshtone.plotting.plot_order_map`."""
        from .. import plotting

        return plotting.plot_order_map(self, teeth, over=over, ax=ax)


def order_map(
    signal: npt.ArrayLike,
    phase: ShaftPhase,
    sampling_rate_hz: float,
    *,
    revolutions: int | None = None,
    highest_order: float | None = None,
) -> OrderMap:
    """The order spectrum of overlapping parts of a recording: orders are upright lines, resonances are bands that move.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        (any unit) The recording.
    phase : ShaftPhase
        Of the shaft.
    sampling_rate_hz : float
        (S/s) Of the recording.
    revolutions : int, optional
        (rev) Length of a part, under Hann's window; each begins a quarter of it after the one before, or later where there would be more than
        200. By default a twelfth of the recording, from 2 to 16.
    highest_order : float, optional
        By default, and at most, that which the sampling rate shows at the highest speed.

    Returns
    -------
    OrderMap

    Raises
    ------
    ValueError
        NaN; a constant signal; parts of no revolution, or of more than the recording has; a highest order that is not above 0.

    Notes
    -----
    K. R. Fyfe, E. D. S. Munck, "Analysis of computed order tracking", Mechanical Systems and Signal Processing 11 (1997) 187–205.

    Examples
    --------
    >>> import numpy as np
    >>> from meshtone import ShaftPhase
    >>> phase = ShaftPhase.from_speed_profile([0, 4], [5, 15], 4000.0, 16_001)
    >>> of_run_up = order_map(3 * np.cos(2 * np.pi * 5 * phase.revolutions), phase, 4000.0)
    >>> of_run_up.amplitude.shape == (of_run_up.time_s.size, of_run_up.orders.size)
    True
    >>> float(of_run_up.orders[of_run_up.amplitude[0].argmax()]), float(of_run_up.amplitude.max().round(2))
    (5.0, 3.0)
    """
    length, time_s, speed_hz, amplitude = _core.order_map(
        signal_array(signal),
        native_phase(phase),
        positive("sampling_rate_hz", sampling_rate_hz),
        None if revolutions is None else whole("revolutions", revolutions, 1),
        None if highest_order is None else positive("highest_order", highest_order),
    )
    return OrderMap(np.arange(amplitude.shape[1]) / length, time_s, speed_hz, amplitude, length)
