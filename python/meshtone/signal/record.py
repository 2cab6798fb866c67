"""The whole chain: what one channel shows about one wheel."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy.typing as npt

from .. import _core, _display
from .._warnings import warn
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

    def __init__(self, native: _core.Record | _Remembered, *, teeth: int, name: str = "signal") -> None:
        self._native = native
        self.teeth = teeth
        """Teeth of the wheel."""
        self.name = name
        """Of the channel."""

    @property
    def average(self) -> Array:
        """Synchronous average."""
        return read_only(self._native.average)

    @property
    def revolutions(self) -> int:
        """Revolutions that were averaged."""
        return self._native.revolutions

    @property
    def nyquist_order(self) -> float:
        """(orders of the shaft) Highest order that the sampling rate shows."""
        return self._native.nyquist_order

    @property
    def regular(self) -> Array:
        """Mesh harmonics and their sidebands."""
        return read_only(self._native.regular)

    @property
    def residual(self) -> Array:
        """What is left without the mesh harmonics."""
        return read_only(self._native.residual)

    @property
    def difference(self) -> Array:
        """What is left without the mesh harmonics and their sidebands."""
        return read_only(self._native.difference)

    @property
    def envelope(self) -> Array:
        """Envelope of the difference."""
        return read_only(self._native.envelope)

    @property
    def order_spectrum(self) -> Array:
        """Amplitude at each order of the shaft, in the channel's unit; the index is the order; shape (points // 2 + 1,)."""
        return read_only(self._native.order_spectrum)

    @property
    def envelope_spectrum(self) -> Array:
        """The envelope's amplitude at each order, in the channel's unit; the index is the order; shape (points // 2 + 1,)."""
        return read_only(self._native.envelope_spectrum)

    # Not a property, behind which notebooks do not look for keys.
    @functools.cached_property
    def indicators(self) -> Indicators:
        """Condition indicators by name, ``difference_kurtosis``, ``fm4`` and so on, with units, formulas and sources in
        :class:`~meshtone.signal.Indicators`; NaN where one is not defined."""
        return Indicators(self._native.indicators)

    @property
    def warnings(self) -> list[str]:
        """What is doubtful."""
        return self._native.warnings

    def __reduce__(self) -> tuple[Callable[[dict[str, Any], int, str], Record], tuple[dict[str, Any], int, str]]:
        return (_remembered, ({name: getattr(self._native, name) for name in _OF_RECORD}, self.teeth, self.name))

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
            _display.remarks(self.warnings),
        )

    def __repr__(self) -> str:
        return f"<Record of {self.name}: average of {self.revolutions} revolutions, {self.average.size} points>"


_OF_RECORD = (
    "average",
    "revolutions",
    "nyquist_order",
    "regular",
    "residual",
    "difference",
    "envelope",
    "order_spectrum",
    "envelope_spectrum",
    "indicators",
    "warnings",
)
"""What a record is made of."""


class _Remembered(SimpleNamespace):
    """What a pickled record was made of."""

    average: Array
    revolutions: int
    nyquist_order: float
    regular: Array
    residual: Array
    difference: Array
    envelope: Array
    order_spectrum: Array
    envelope_spectrum: Array
    indicators: dict[str, float]
    warnings: list[str]


def _remembered(parts: dict[str, Any], teeth: int, name: str) -> Record:
    return Record(_Remembered(**parts), teeth=teeth, name=name)


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
    record = _core.process_channel(signal_array(signal), native_phase(phase), teeth_number(teeth), settings)
    warn(record.warnings)
    return Record(record, teeth=teeth, name=name)


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
    warn(warning for record in records for warning in record.warnings)
    return [Record(record, teeth=teeth, name=name) for record in records]
