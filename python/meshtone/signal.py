"""From a channel, simulated or measured, to condition indicators; every step can be used alone.

The chain, its definitions and their sources: the book's chapter "From a recording to indicators". Arrays are float64; others are
converted. Values that are not defined (the kurtosis of a constant) are NaN.

Examples
--------
A rig's recording with a tachometer:

>>> import numpy as np
>>> from meshtone import signal
>>> rate_hz, shaft_hz, teeth = 10_000.0, 20.0, 19
>>> time_s = np.arange(20_000) / rate_hz
>>> vibration = np.cos(2 * np.pi * shaft_hz * teeth * time_s) + 0.1 * np.cos(2 * np.pi * 253 * time_s)
>>> tachometer = np.where((time_s * shaft_hz) % 1 < 0.1, 5.0, 0.0)
>>> pulses_s = signal.tachometer_pulses(tachometer, rate_hz)
>>> phase = signal.ShaftPhase.from_pulses(pulses_s, 1, rate_hz, vibration.size)
>>> record = signal.process_channel(vibration, phase, teeth)
>>> record.revolutions, round(float(record.order_spectrum[teeth]), 2)
(38, 1.0)
"""

from __future__ import annotations

import operator
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from . import _core

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = [
    "AngularSignal",
    "Parts",
    "Record",
    "ShaftPhase",
    "angular_resample",
    "energy_ratio",
    "envelope",
    "envelope_spectrum",
    "fm0",
    "fm4",
    "m6a",
    "m8a",
    "na4",
    "order_spectrum",
    "process_channel",
    "process_series",
    "repair_pulses",
    "resample",
    "separate",
    "sideband_level_factor",
    "statistics",
    "synchronous_average",
    "tachometer_pulses",
]

Array = npt.NDArray[np.float64]


def _signal(values: npt.ArrayLike) -> Array:
    array = np.asarray(values)
    if array.ndim != 1:
        raise ValueError(f"a signal has one dimension; given is an array of shape {array.shape}")
    if np.iscomplexobj(array):
        raise TypeError("a signal is real; given is an array of complex numbers")
    return np.ascontiguousarray(array, dtype=np.float64)


def whole(name: str, value: int, least: int = 0) -> int:
    """A whole number that an argument is, or an error that names it."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} = {value!r}: must be a whole number") from None
    if number < least:
        raise ValueError(f"{name} = {number}: must be at least {least}")
    return number


def _native_phase(phase: ShaftPhase) -> _core.ShaftPhase:
    if not isinstance(phase, ShaftPhase):
        raise TypeError(f"phase: must be a ShaftPhase, not {type(phase).__name__}; ShaftPhase.constant is that of a constant speed")
    return phase._native


class ShaftPhase:
    """How far a shaft has turned at each sample of a recording.

    Parameters
    ----------
    revolutions : array_like, shape (samples,)
        (rev) Angle at each sample; it rises.
    first_sample : int
        Number of the recording's sample that the first angle belongs to.

    Examples
    --------
    >>> phase = ShaftPhase.constant(20.0, 1000.0, 101)
    >>> round(float(phase.revolutions[-1]), 6)
    2.0
    """

    def __init__(self, revolutions: npt.ArrayLike, first_sample: int = 0) -> None:
        self._native = _core.ShaftPhase(_signal(revolutions), whole("first_sample", first_sample))

    @classmethod
    def _wrap(cls, native: _core.ShaftPhase) -> ShaftPhase:
        phase = cls.__new__(cls)
        phase._native = native
        return phase

    @classmethod
    def constant(cls, speed_hz: float, sampling_rate_hz: float, samples: int) -> ShaftPhase:
        """Of a constant speed.

        Parameters
        ----------
        speed_hz : float
            (rev/s) Speed.
        sampling_rate_hz : float
            (S/s) Of the recording.
        samples : int
            Length of the recording.
        """
        return cls._wrap(_core.ShaftPhase.constant(speed_hz, sampling_rate_hz, whole("samples", samples)))

    @classmethod
    def from_pulses(
        cls,
        time_s: npt.ArrayLike,
        pulses_per_revolution: int,
        sampling_rate_hz: float,
        samples: int,
        *,
        stated_speed_hz: float | None = None,
    ) -> ShaftPhase:
        """From the times of pulses; missing and doubled ones are mended and reported in :attr:`warnings`.

        Parameters
        ----------
        time_s : array_like
            (s) Times of the pulses; 0 is the first sample.
        pulses_per_revolution : int
            At least 1.
        sampling_rate_hz : float
            (S/s) Of the recording.
        samples : int
            Length of the recording.
        stated_speed_hz : float, optional
            (Hz) What the speed should be, to be checked to 5 %.

        Raises
        ------
        ValueError
            Pulses that are equal or out of order, or that cannot be mended; a stated speed that is not theirs.
        """
        native = _core.ShaftPhase.from_pulses(
            _signal(time_s),
            whole("pulses_per_revolution", pulses_per_revolution, 1),
            sampling_rate_hz,
            whole("samples", samples),
            stated_speed_hz,
        )
        return cls._wrap(native)

    @classmethod
    def from_speed_profile(
        cls, time_s: npt.ArrayLike, speed_hz: npt.ArrayLike, sampling_rate_hz: float, samples: int
    ) -> ShaftPhase:
        """From a speed that is known at some times, with straight lines between them.

        Parameters
        ----------
        time_s : array_like
            (s) Times; 0 is the first sample.
        speed_hz : array_like
            (rev/s) Speed at them.
        sampling_rate_hz : float
            (S/s) Of the recording.
        samples : int
            Length of the recording.
        """
        times, speeds = _signal(time_s), _signal(speed_hz)
        return cls._wrap(
            _core.ShaftPhase.from_speed_profile(times, speeds, sampling_rate_hz, whole("samples", samples))
        )

    @classmethod
    def from_speed_samples(cls, speed_hz: npt.ArrayLike, sampling_rate_hz: float) -> ShaftPhase:
        """From the speed at every sample.

        Parameters
        ----------
        speed_hz : array_like, shape (samples,)
            (rev/s) Speed.
        sampling_rate_hz : float
            (S/s) Of the recording.
        """
        return cls._wrap(_core.ShaftPhase.from_speed_samples(_signal(speed_hz), sampling_rate_hz))

    @classmethod
    def from_mesh_tone(
        cls,
        signal: npt.ArrayLike,
        sampling_rate_hz: float,
        teeth: int,
        shaft_hz: float,
        *,
        harmonic: int = 1,
        half_band_hz: float | None = None,
    ) -> ShaftPhase:
        """From the vibration itself, without a tachometer: the phase of a mesh harmonic.

        Parameters
        ----------
        signal : array_like, shape (samples,)
            The vibration.
        sampling_rate_hz : float
            (S/s) Its sampling rate.
        teeth : int
            Of the wheel on the shaft.
        shaft_hz : float
            (rev/s) Nominal speed of the shaft.
        harmonic : int
            Which mesh harmonic is followed.
        half_band_hz : float, optional
            (Hz) Half width of the band around it.
        """
        native = _core.ShaftPhase.from_mesh_tone(
            _signal(signal), sampling_rate_hz, _teeth(teeth), shaft_hz, whole("harmonic", harmonic, 1), half_band_hz
        )
        return cls._wrap(native)

    def of_mate(self, teeth: int, mate_teeth: int) -> ShaftPhase:
        """Phase of the other shaft.

        Parameters
        ----------
        teeth : int
            Of the wheel on this shaft.
        mate_teeth : int
            Of the wheel on the other.
        """
        return ShaftPhase._wrap(self._native.of_mate(_teeth(teeth), whole("mate_teeth", mate_teeth, 1)))

    @property
    def first_sample(self) -> int:
        """Number of the recording's sample that the first angle belongs to."""
        return self._native.first_sample

    @property
    def revolutions(self) -> Array:
        """(rev) Angle at each sample; shape (samples,)."""
        return self._native.revolutions

    @property
    def warnings(self) -> list[str]:
        """What is doubtful about it."""
        return self._native.warnings

    def mean_speed_hz(self, sampling_rate_hz: float) -> float:
        """(rev/s) Mean speed.

        Parameters
        ----------
        sampling_rate_hz : float
            (S/s) Of the recording.
        """
        return self._native.mean_speed_hz(sampling_rate_hz)

    def __repr__(self) -> str:
        revolutions = self.revolutions
        span = revolutions[-1] - revolutions[0]
        return f"<ShaftPhase: {span:.2f} revolutions in {revolutions.size} samples from sample {self.first_sample}>"


class Record:
    """What one channel shows about one wheel.

    Made by :func:`process_channel`, :func:`process_series` and :meth:`meshtone.Simulation.process`. Signals are in the channel's
    unit, over one revolution at equal angles; shape (points,).
    """

    def __init__(self, native: _core.Record, *, teeth: int, name: str = "signal") -> None:
        self._native = native
        self.teeth = teeth
        """Teeth of the wheel."""
        self.name = name
        """Of the channel."""

    @property
    def average(self) -> Array:
        """Synchronous average."""
        return self._native.average

    @property
    def revolutions(self) -> int:
        """Revolutions that were averaged."""
        return self._native.revolutions

    @property
    def nyquist_order(self) -> float:
        """Highest order that the sampling rate shows."""
        return self._native.nyquist_order

    @property
    def regular(self) -> Array:
        """Mesh harmonics and their sidebands."""
        return self._native.regular

    @property
    def residual(self) -> Array:
        """What is left without the mesh harmonics."""
        return self._native.residual

    @property
    def difference(self) -> Array:
        """What is left without the mesh harmonics and their sidebands."""
        return self._native.difference

    @property
    def envelope(self) -> Array:
        """Envelope of the difference."""
        return self._native.envelope

    @property
    def order_spectrum(self) -> Array:
        """Amplitude at each order of the shaft; the index is the order."""
        return self._native.order_spectrum

    @property
    def envelope_spectrum(self) -> Array:
        """The envelope's amplitude at each order; the index is the order."""
        return self._native.envelope_spectrum

    @property
    def indicators(self) -> dict[str, float]:
        """Condition indicators by name: ``difference_kurtosis``, ``fm0``, ``fm4``, ``na4``, ...; NaN where one is not defined."""
        return self._native.indicators

    @property
    def warnings(self) -> list[str]:
        """What is doubtful."""
        return self._native.warnings

    def plot(self) -> Figure:
        """Average, order spectrum, difference with its envelope. See :func:`meshtone.plotting.plot_record`."""
        from . import plotting

        return plotting.plot_record(self)

    def _repr_png_(self) -> bytes:
        from . import plotting

        return plotting.png(self.plot())

    def __repr__(self) -> str:
        return f"<Record of {self.name}: average of {self.revolutions} revolutions, {self.average.size} points>"


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
        The channel.
    phase : ShaftPhase
        Of the wheel's shaft.
    teeth : int
        Of the wheel.
    sidebands : int, optional
        Sidebands on either side of each mesh harmonic that belong to the regular part.
    shaft_orders : sequence of int, optional
        Orders of the shaft that belong to the regular part.
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
    settings = _settings(teeth, sidebands, shaft_orders)
    record = _core.process_channel(_signal(signal), _native_phase(phase), _teeth(teeth), settings)
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
        The channel in each recording.
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
    settings = _settings(teeth, sidebands, shaft_orders)
    if isinstance(phases, ShaftPhase):
        raise TypeError("phases: must be a list of one ShaftPhase for each signal, not one alone")
    native = [_native_phase(phase) for phase in phases]
    records = _core.process_series([_signal(signal) for signal in signals], native, _teeth(teeth), settings)
    return [Record(record, teeth=teeth, name=name) for record in records]


def _teeth(teeth: int) -> int:
    return whole("teeth", teeth, 1)


def _regular_part(sidebands: int | None, shaft_orders: Sequence[int] | None) -> tuple[int | None, list[int] | None]:
    return (
        None if sidebands is None else whole("sidebands", sidebands),
        None if shaft_orders is None else [whole("shaft_orders", order) for order in shaft_orders],
    )


def _settings(teeth: int, sidebands: int | None, shaft_orders: Sequence[int] | None) -> dict[str, object] | None:
    if sidebands is None and shaft_orders is None:
        return None
    bands, orders = _regular_part(sidebands, shaft_orders)
    return {"teeth": _teeth(teeth), "sidebands": bands, "shaft_orders": orders}


def tachometer_pulses(
    waveform: npt.ArrayLike,
    sampling_rate_hz: float,
    *,
    threshold: float | None = None,
    hysteresis: float | None = None,
    edge: Literal["rising", "falling"] = "rising",
) -> Array:
    """Times at which a tachometer's waveform crosses the threshold.

    Parameters
    ----------
    waveform : array_like, shape (samples,)
        The tachometer's channel.
    sampling_rate_hz : float
        (S/s) Its sampling rate.
    threshold : float, optional
        (the waveform's unit) By default the middle of its levels.
    hysteresis : float, optional
        (the waveform's unit) How far it must go back before another pulse counts. By default 0.2 of the levels' distance.
    edge : {'rising', 'falling'}
        Which side of a pulse counts.

    Returns
    -------
    array, shape (pulses,)
        (s) Times; 0 is the first sample.

    Raises
    ------
    ValueError
        NaN, a constant waveform, a threshold that is never crossed.
    """
    return _core.tachometer_pulses(_signal(waveform), sampling_rate_hz, threshold, hysteresis, edge)


def repair_pulses(time_s: npt.ArrayLike) -> tuple[Array, list[str]]:
    """Put missing pulses in and take doubled ones out.

    Parameters
    ----------
    time_s : array_like
        (s) Times of the pulses.

    Returns
    -------
    time_s : array
        (s) Times of the mended pulses.
    warnings : list of str
        What was found.

    Raises
    ------
    ValueError
        Fewer than two pulses; pulses that are equal or out of order; so many missing or doubled ones that the rest cannot be trusted.
    """
    return _core.repair_pulses(_signal(time_s))


def resample(
    signal: npt.ArrayLike,
    from_hz: float,
    to_hz: float,
    *,
    edge: Literal["zero", "reflect", "periodic"] = "reflect",
) -> Array:
    """The same signal at another sampling rate, by a polyphase filter.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        The signal.
    from_hz, to_hz : float
        (S/s) Its rate and the wanted one.
    edge : {'reflect', 'zero', 'periodic'}
        How the signal goes on beyond its ends.

    Returns
    -------
    array

    Raises
    ------
    ValueError
        NaN; rates without a usable ratio of whole numbers.

    Examples
    --------
    >>> import numpy as np
    >>> resample(np.ones(1000), 1000, 500).round(6)[:3]
    array([1., 1., 1.])
    """
    return _core.resample(_signal(signal), from_hz, to_hz, edge)


@dataclass(frozen=True)
class AngularSignal:
    """A signal over whole revolutions of a shaft, at equal angles.

    Attributes
    ----------
    values : array, shape (revolutions * points_per_revolution,)
        Revolution after revolution.
    points_per_revolution : int
        Values in a revolution.
    start_rev : float
        (rev) Angle of the first value.
    nyquist_order : float
        Highest order that the sampling rate shows.
    """

    values: Array
    points_per_revolution: int
    start_rev: float
    nyquist_order: float


def angular_resample(
    signal: npt.ArrayLike,
    phase: ShaftPhase,
    *,
    points_per_revolution: int | None = None,
    interpolation: Literal["band-limited", "pchip"] = "band-limited",
) -> AngularSignal:
    """A signal over whole revolutions of a shaft, at equal angles.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        The signal.
    phase : ShaftPhase
        Of the shaft.
    points_per_revolution : int, optional
        Values in a revolution; by default so many that nothing is lost.
    interpolation : {'band-limited', 'pchip'}
        How the signal is read between its samples.

    Returns
    -------
    AngularSignal

    Raises
    ------
    ValueError
        NaN, a constant signal, fewer than two whole revolutions.
    """
    points = None if points_per_revolution is None else whole("points_per_revolution", points_per_revolution, 1)
    return AngularSignal(*_core.angular_resample(_signal(signal), _native_phase(phase), points, interpolation))


def synchronous_average(angular: AngularSignal) -> Array:
    """Average over the revolutions.

    Parameters
    ----------
    angular : AngularSignal
        From :func:`angular_resample`.

    Returns
    -------
    array, shape (points_per_revolution,)
    """
    return _core.synchronous_average(angular.values, angular.points_per_revolution)


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
    bands, orders = _regular_part(sidebands, shaft_orders)
    return Parts(*_core.separate(_signal(average), _teeth(teeth), bands, orders))


def envelope(signal: npt.ArrayLike) -> Array:
    """Amplitude of the analytic signal.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        One period.

    Returns
    -------
    array, shape (samples,)

    Raises
    ------
    ValueError
        NaN, or no samples.
    """
    return _core.envelope(_signal(signal))


def envelope_spectrum(signal: npt.ArrayLike) -> Array:
    """Amplitudes of the envelope at each order.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        One revolution.

    Returns
    -------
    array, shape (samples // 2 + 1,)
        The index is the order.
    """
    return _core.envelope_spectrum(_signal(signal))


def order_spectrum(average: npt.ArrayLike) -> Array:
    """Amplitude at each order: of a cosine its amplitude, at order 0 the mean.

    Parameters
    ----------
    average : array_like, shape (points,)
        One revolution at equal angles.

    Returns
    -------
    array, shape (points // 2 + 1,)
        The index is the order.

    Examples
    --------
    >>> import numpy as np
    >>> order_spectrum(3 * np.cos(2 * np.pi * 5 * np.arange(64) / 64)).round(6)[5]
    np.float64(3.0)
    """
    return _core.order_spectrum(_signal(average))


def fm0(average: npt.ArrayLike, teeth: int) -> float:
    """FM0: peak-to-peak of the average over the sum of its mesh harmonics' amplitudes.

    Parameters
    ----------
    average : array_like, shape (points,)
        One revolution at equal angles.
    teeth : int
        Of the wheel.
    """
    return _core.fm0(_signal(average), _teeth(teeth))


def fm4(difference: npt.ArrayLike) -> float:
    """FM4: µ4 / µ2² of the difference.

    Parameters
    ----------
    difference : array_like, shape (points,)
        From :func:`separate`.

    Examples
    --------
    >>> import numpy as np
    >>> round(fm4(np.cos(2 * np.pi * np.arange(100) / 100)), 12)
    1.5
    """
    return _core.fm4(_signal(difference))


def m6a(difference: npt.ArrayLike) -> float:
    """M6A: µ6 / µ2³ of the difference.

    Parameters
    ----------
    difference : array_like, shape (points,)
        From :func:`separate`.
    """
    return _core.m6a(_signal(difference))


def m8a(difference: npt.ArrayLike) -> float:
    """M8A: µ8 / µ2⁴ of the difference.

    Parameters
    ----------
    difference : array_like, shape (points,)
        From :func:`separate`.
    """
    return _core.m8a(_signal(difference))


def na4(residuals: Sequence[npt.ArrayLike]) -> Array:
    """NA4 of each record of a series: µ4 of its residual over the square of the mean µ2 of the records so far.

    Parameters
    ----------
    residuals : sequence of array_like
        In the order of the records.

    Returns
    -------
    array, shape (records,)
    """
    return _core.na4([_signal(residual) for residual in residuals])


def energy_ratio(difference: npt.ArrayLike, regular: npt.ArrayLike) -> float:
    """Standard deviation of the difference over that of the regular part.

    Parameters
    ----------
    difference, regular : array_like, shape (points,)
        From :func:`separate`.
    """
    return _core.energy_ratio(_signal(difference), _signal(regular))


def sideband_level_factor(average: npt.ArrayLike, teeth: int) -> float:
    """Amplitudes of the first sidebands of the mesh order over the average's standard deviation.

    Parameters
    ----------
    average : array_like, shape (points,)
        One revolution at equal angles.
    teeth : int
        Of the wheel.
    """
    return _core.sideband_level_factor(_signal(average), _teeth(teeth))


def statistics(signal: npt.ArrayLike) -> dict[str, float]:
    """Rms, peak-to-peak, crest factor, skewness and kurtosis (3 for Gaussian noise).

    Parameters
    ----------
    signal : array_like, shape (samples,)
        The signal.

    Returns
    -------
    dict of str to float

    Raises
    ------
    ValueError
        NaN, a constant signal.

    Examples
    --------
    >>> import numpy as np
    >>> {name: round(value, 3) for name, value in statistics(np.cos(np.arange(628) / 100)).items()}["rms"]
    0.707
    """
    return _core.statistics(_signal(signal))
