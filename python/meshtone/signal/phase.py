"""The angle that a shaft has turned by, sample by sample."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy.typing as npt

from .. import _core
from .._warnings import SignalWarning, typed, warn_of_signal
from ._arguments import Array, positive, read_only, signal_array, teeth_number, whole


class ShaftPhase:
    """How far a shaft has turned at each sample of a recording.

    Parameters
    ----------
    revolutions : array_like, shape (samples,)
        (rev) Angle at each sample; it rises.
    first_sample : int
        Number of the recording's sample that the first angle belongs to.

    Raises
    ------
    ValueError
        NaN; fewer than two angles; one that is not larger than the one before it: the shaft stands still or turns backwards.

    Examples
    --------
    >>> phase = ShaftPhase.constant(20.0, 1000.0, 101)
    >>> round(float(phase.revolutions[-1]), 6)
    2.0
    """

    def __init__(self, revolutions: npt.ArrayLike, first_sample: int = 0) -> None:
        self._native = _core.ShaftPhase(signal_array(revolutions), whole("first_sample", first_sample))
        self._warnings = typed(self._native.warnings)

    @classmethod
    def _wrap(cls, native: _core.ShaftPhase) -> ShaftPhase:
        phase = cls.__new__(cls)
        phase._native = native
        phase._warnings = typed(native.warnings)
        return phase

    @classmethod
    def _wrap_and_warn(cls, native: _core.ShaftPhase) -> ShaftPhase:
        phase = cls._wrap(native)
        warn_of_signal(phase._warnings)
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

        Raises
        ------
        ValueError
            A speed or rate that is not above 0; fewer than two samples.
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
        time_s : array_like, shape (pulses,)
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
            Fewer than three pulses; some that are equal or out of order, or that cannot be mended; a stated speed that is not theirs.

        Notes
        -----
        Between the pulses the angle follows monotone cubics: F. N. Fritsch, R. E. Carlson, "Monotone piecewise cubic interpolation",
        SIAM Journal on Numerical Analysis 17 (1980) 238–246.
        """
        native = _core.ShaftPhase.from_pulses(
            signal_array(time_s),
            whole("pulses_per_revolution", pulses_per_revolution, 1),
            sampling_rate_hz,
            whole("samples", samples),
            stated_speed_hz,
        )
        return cls._wrap_and_warn(native)

    @classmethod
    def from_speed_profile(
        cls, time_s: npt.ArrayLike, speed_hz: npt.ArrayLike, sampling_rate_hz: float, samples: int
    ) -> ShaftPhase:
        """From a speed that is known at some times, with straight lines between them, which are integrated exactly.

        Parameters
        ----------
        time_s : array_like, shape (points,)
            (s) Times; 0 is the first sample.
        speed_hz : array_like, shape (points,)
            (rev/s) Speed at them.
        sampling_rate_hz : float
            (S/s) Of the recording.
        samples : int
            Length of the recording.

        Raises
        ------
        ValueError
            NaN; another number of speeds than of times; times that do not rise; a speed that is not above 0.
        """
        times, speeds = signal_array(time_s), signal_array(speed_hz)
        return cls._wrap_and_warn(
            _core.ShaftPhase.from_speed_profile(times, speeds, sampling_rate_hz, whole("samples", samples))
        )

    @classmethod
    def from_speed_samples(cls, speed_hz: npt.ArrayLike, sampling_rate_hz: float) -> ShaftPhase:
        """From the speed at every sample, by the trapezoidal rule.

        Parameters
        ----------
        speed_hz : array_like, shape (samples,)
            (rev/s) Speed.
        sampling_rate_hz : float
            (S/s) Of the recording.

        Raises
        ------
        ValueError
            NaN; fewer than two samples; a shaft that stands still or turns backwards.
        """
        return cls._wrap(_core.ShaftPhase.from_speed_samples(signal_array(speed_hz), sampling_rate_hz))

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
            (any unit) The vibration.
        sampling_rate_hz : float
            (S/s) Its sampling rate.
        teeth : int
            Of the wheel on the shaft.
        shaft_hz : float
            (rev/s) Nominal speed of the shaft.
        harmonic : int
            Which mesh harmonic is followed.
        half_band_hz : float, optional
            (Hz) Half width of the band around it; half of ``shaft_hz`` by default, without the sidebands of one revolution.

        Raises
        ------
        ValueError
            NaN, a constant signal; no mesh tone stands out in the band; a band beyond half the sampling rate.

        Notes
        -----
        F. Bonnardot, M. El Badaoui, R. B. Randall, J. Danière, F. Guillet, "Use of the acceleration signal of a gearbox in order to
        perform angular resampling", Mechanical Systems and Signal Processing 19 (2005) 766–785.
        """
        native = _core.ShaftPhase.from_mesh_tone(
            signal_array(signal), sampling_rate_hz, teeth_number(teeth), shaft_hz, whole("harmonic", harmonic, 1), half_band_hz
        )
        return cls._wrap_and_warn(native)

    def of_mate(self, teeth: int, mate_teeth: int) -> ShaftPhase:
        """Phase of the other shaft: this one times ``teeth / mate_teeth``.

        Parameters
        ----------
        teeth : int
            Of the wheel on this shaft.
        mate_teeth : int
            Of the wheel on the other.

        Raises
        ------
        ValueError
            A number of teeth below 1.
        """
        return ShaftPhase._wrap(self._native.of_mate(teeth_number(teeth), whole("mate_teeth", mate_teeth, 1)))

    def __getitem__(self, samples: slice) -> ShaftPhase:
        """The phase of a part of the recording: ``phase[a:b]`` belongs to ``signal[a:b]``.

        Parameters
        ----------
        samples : slice
            Samples of the recording, without a step.

        Raises
        ------
        TypeError
            Something else than a slice.
        ValueError
            A slice with a step, or of fewer than two samples that have a phase.

        Examples
        --------
        >>> phase = ShaftPhase.constant(20.0, 1000.0, 101)
        >>> phase[50:]
        <ShaftPhase: 1.00 revolutions in 51 samples from sample 0>
        """
        if not isinstance(samples, slice):
            raise TypeError(f"phase[{samples!r}]: must be a slice of samples, such as phase[0:1000]; revolutions has the angles")
        start, stop, step = samples.indices(self.first_sample + self.revolutions.size)
        if step != 1:
            raise ValueError(f"phase[::{step}]: a slice of a phase has no step")
        return ShaftPhase._wrap(self._native.part(start, max(start, stop)))

    @property
    def first_sample(self) -> int:
        """Number of the recording's sample that the first angle belongs to."""
        return self._native.first_sample

    @property
    def revolutions(self) -> Array:
        """(rev) Angle at each sample; shape (samples,)."""
        return read_only(self._native.revolutions)

    @property
    def warnings(self) -> list[SignalWarning]:
        """What is doubtful about it."""
        return list(self._warnings)

    @property
    def zero(self) -> str:
        """What angle 0 is: ``first sample``, ``pulse``, ``first pulse``, ``angle 0`` as given, or, after a mesh tone, ``chance``."""
        return self._native.zero

    def __reduce__(self) -> tuple[Callable[[Array, int, list[SignalWarning], str], ShaftPhase], tuple[Array, int, list[SignalWarning], str]]:
        return (_remembered, (self._native.revolutions, self.first_sample, self._warnings, self.zero))

    def mean_speed_hz(self, sampling_rate_hz: float) -> float:
        """(rev/s) Mean speed.

        Parameters
        ----------
        sampling_rate_hz : float
            (S/s) Of the recording.

        Raises
        ------
        ValueError
            A rate that is not above 0.
        """
        return self._native.mean_speed_hz(positive("sampling_rate_hz", sampling_rate_hz))

    def __repr__(self) -> str:
        revolutions = self.revolutions
        span = revolutions[-1] - revolutions[0]
        return f"<ShaftPhase: {span:.2f} revolutions in {revolutions.size} samples from sample {self.first_sample}>"


def _remembered(revolutions: Array, first_sample: int, warnings: list[SignalWarning], zero: str = "angle 0") -> ShaftPhase:
    phase = ShaftPhase._wrap(_core.ShaftPhase(revolutions, first_sample, zero))
    phase._warnings = warnings
    return phase


def native_phase(phase: ShaftPhase) -> _core.ShaftPhase:
    if not isinstance(phase, ShaftPhase):
        raise TypeError(f"phase: must be a ShaftPhase, not {type(phase).__name__}; ShaftPhase.constant is that of a constant speed")
    return phase._native


def tachometer_pulses(
    waveform: npt.ArrayLike,
    sampling_rate_hz: float,
    *,
    threshold: float | None = None,
    hysteresis: float | None = None,
    edge: Literal["rising", "falling"] = "rising",
) -> Array:
    """Times at which a tachometer's waveform crosses the threshold, on straight lines between its samples.

    Parameters
    ----------
    waveform : array_like, shape (samples,)
        (any unit) The tachometer's channel.
    sampling_rate_hz : float
        (S/s) Its sampling rate.
    threshold : float, optional
        (the waveform's unit) By default the middle of its levels, which are the quantiles of 0.5 and 99.5 %.
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
    return _core.tachometer_pulses(signal_array(waveform), sampling_rate_hz, threshold, hysteresis, edge)


def repair_pulses(time_s: npt.ArrayLike) -> tuple[Array, list[str]]:
    """Put missing pulses in and take doubled ones out.

    Each interval is compared with the median of four neighbours on each side: below half of it the later pulse is one too many, above
    1.6 of it pulses are missing, which are put in at equal distances.

    Parameters
    ----------
    time_s : array_like, shape (pulses,)
        (s) Times of the pulses.

    Returns
    -------
    time_s : array, shape (mended pulses,)
        (s) Times of the mended pulses.
    warnings : list of str
        What was found.

    Raises
    ------
    ValueError
        Fewer than three pulses; pulses that are equal or out of order; so many missing or doubled ones that the rest cannot be trusted.
    """
    return _core.repair_pulses(signal_array(time_s))
