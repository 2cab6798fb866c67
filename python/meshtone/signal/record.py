"""The whole chain: what one channel shows about one wheel."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy.typing as npt

from .. import _core, _display
from .._warnings import SignalWarning, typed, warn_of_signal
from ._arguments import Array, read_only, separation_settings, signal_array, teeth_number
from .indicators import SHOWN, Indicators
from .phase import ShaftPhase, native_phase

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Record:
    """What one channel shows about one wheel.

    Made by :func:`process_channel`, :func:`process_series` and :meth:`meshtone.Simulation.process`. Signals are in the channel's
    unit, over one revolution at equal angles; shape (points,); they cannot be written to.
    """

    def __init__(self, parts: dict[str, Any], *, teeth: int, name: str = "signal") -> None:
        self._parts = parts
        self.teeth = teeth
        """Teeth of the wheel."""
        self.name = name
        """Of the channel."""

    def _signal(self, name: str) -> Array:
        signal: Array = self._parts[name]
        return read_only(signal)

    @property
    def average(self) -> Array:
        """Synchronous average."""
        return self._signal("average")

    @property
    def revolutions(self) -> int:
        """Revolutions that were averaged."""
        return int(self._parts["revolutions"])

    @property
    def nyquist_order(self) -> float:
        """(orders of the shaft) Highest order that the sampling rate shows."""
        return float(self._parts["nyquist_order"])

    @property
    def regular(self) -> Array:
        """Mesh harmonics and their sidebands."""
        return self._signal("regular")

    @property
    def residual(self) -> Array:
        """What is left without the mesh harmonics."""
        return self._signal("residual")

    @property
    def difference(self) -> Array:
        """What is left without the mesh harmonics and their sidebands."""
        return self._signal("difference")

    @property
    def envelope(self) -> Array:
        """Envelope of the difference."""
        return self._signal("envelope")

    @property
    def order_spectrum(self) -> Array:
        """Amplitude at each order of the shaft, in the channel's unit; the index is the order; shape (points // 2 + 1,)."""
        return self._signal("order_spectrum")

    @property
    def envelope_spectrum(self) -> Array:
        """The envelope's amplitude at each order, in the channel's unit; the index is the order; shape (points // 2 + 1,)."""
        return self._signal("envelope_spectrum")

    # Not a property, behind which notebooks do not look for keys.
    @functools.cached_property
    def indicators(self) -> Indicators:
        """Condition indicators by name, ``difference_kurtosis``, ``fm4`` and so on, with units, formulas and sources in
        :class:`~meshtone.signal.Indicators`; NaN where one is not defined."""
        return Indicators(self._parts["indicators"])

    @property
    def warnings(self) -> list[SignalWarning]:
        """What is doubtful."""
        return typed(self._parts["warnings"])

    def __reduce__(self) -> tuple[Callable[[dict[str, Any], int, str], Record], tuple[dict[str, Any], int, str]]:
        return (_remembered, (self._parts, self.teeth, self.name))

    def plot(self) -> Figure:
        """Average, order spectrum, difference with its envelope. See :func:`meshtone.plotting.plot_record`."""
        from .. import plotting

        return plotting.plot_record(self)

    def _repr_html_(self) -> str:
        label, unit = _display.channel_label(self.name), _display.unit_of(self.name)
        span, over = (0.0, 1.0), "Angle of the shaft (revolutions)"
        rows = _display.indicators(self.indicators, SHOWN, self.name)
        return _display.page(
            f"{label}: average of {self.revolutions} revolutions of a wheel with {self.teeth} teeth",
            _display.table(rows),
            _display.curve(self.average, span=span, over=over, label=_display.with_unit("Average", unit)),
            _display.curve(self.difference, span=span, over=over, label=_display.with_unit("Difference", unit)),
            _display.remarks([warning.message for warning in self.warnings]),
        )

    def __repr__(self) -> str:
        return f"<Record of {self.name}: average of {self.revolutions} revolutions, {self.average.size} points>"


def _remembered(parts: dict[str, Any], teeth: int, name: str) -> Record:
    return Record(parts, teeth=teeth, name=name)


def process_channel(
    signal: npt.ArrayLike,
    phase: ShaftPhase,
    teeth: int,
    *,
    sidebands: int | None = None,
    shaft_orders: Sequence[int] | None = None,
    name: str = "signal",
) -> Record:
    """Take one channel to its average, its parts, spectra and indicators.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        (any unit) The channel.
    phase : ShaftPhase
        Of the wheel's shaft.
    teeth : int
        Of the wheel.
    sidebands : int, optional
        Sidebands on either side of each mesh harmonic that belong to the regular part; 2 by default.
    shaft_orders : sequence of int, optional
        Orders of the shaft that belong to the regular part; 1 to 7 by default.
    name : str
        Of the channel, for figures.

    Returns
    -------
    Record

    Raises
    ------
    ValueError
        NaN, a constant channel, fewer than two revolutions, a mesh order beyond the Nyquist order.
    """
    settings = separation_settings(teeth, sidebands, shaft_orders)
    parts = _core.process_channel(signal_array(signal), native_phase(phase), teeth_number(teeth), settings)
    warn_of_signal(typed(parts["warnings"]))
    return Record(parts, teeth=teeth, name=name)


def process_series(
    signals: Sequence[npt.ArrayLike],
    phases: Sequence[ShaftPhase],
    teeth: int,
    *,
    sidebands: int | None = None,
    shaft_orders: Sequence[int] | None = None,
    name: str = "signal",
) -> list[Record]:
    """Take the recordings of a series, in order, to their indicators: NA4 refers to all the earlier ones.

    Parameters
    ----------
    signals : sequence of array_like, shape (samples,)
        (any unit, the same of all) The channel in each recording.
    phases : sequence of ShaftPhase
        Of the wheel's shaft in each recording.
    teeth, sidebands, shaft_orders, name
        As of :func:`process_channel`.

    Returns
    -------
    list of Record

    Raises
    ------
    ValueError
        As :func:`process_channel`; another number of phases than of signals.
    """
    settings = separation_settings(teeth, sidebands, shaft_orders)
    if isinstance(phases, ShaftPhase):
        raise TypeError("phases: must be a list of one ShaftPhase for each signal, not one alone")
    native = [native_phase(phase) for phase in phases]
    records = _core.process_series([signal_array(signal) for signal in signals], native, teeth_number(teeth), settings)
    warn_of_signal(warning for parts in records for warning in typed(parts["warnings"]))
    return [Record(parts, teeth=teeth, name=name) for parts in records]
