"""A check of a recording against what the user states about it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy.typing as npt

from .. import _core
from .._warnings import SignalWarning, typed
from ._arguments import signal_array, teeth_number, whole
from .phase import ShaftPhase, native_phase


@dataclass(frozen=True)
class Mismatch:
    """A value that fits a recording better than the stated one.

    Attributes
    ----------
    cause : str
        The quantity that was stated wrongly: ``teeth``, ``mate_teeth``, ``other_shaft``, ``pulses_per_revolution``, ``speed_hz``,
        or ``varying_speed`` where a constant one is stated.
    alternative : float
        The better value; of ``other_shaft`` the teeth of the wheel that is on the shaft that speed or pulses are of; of
        ``varying_speed`` (-) the standard deviation of the revolutions' speeds over their mean.
    message : str
        Both in words.
    energy_ratio : float or None
        (-) Of ``speed_hz``: energy at the mesh orders of the average at the better speed over that at the stated one.
    """

    cause: str
    alternative: float
    message: str
    energy_ratio: float | None


def find_mismatch(
    signal: npt.ArrayLike,
    phase: ShaftPhase,
    teeth: int,
    *,
    mate_teeth: int | None = None,
    pulses_per_revolution: int | None = None,
    speed_hz: float | None = None,
) -> Mismatch | None:
    """Look for a sign that a recording does not fit what is stated: another tooth count, the other shaft, other pulses, speed.

    Where the recording is too short or too noisy to tell, or a wheel is stated to have more than 100 000 teeth, there is none.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        (any unit) The channel.
    phase : ShaftPhase
        Of the wheel's shaft, as it is stated.
    teeth : int
        Of the wheel on that shaft.
    mate_teeth : int, optional
        Of the wheel that meshes with it.
    pulses_per_revolution : int, optional
        Where the phase is from pulses.
    speed_hz : float, optional
        (rev/s) Where it is that of a constant speed.

    Returns
    -------
    Mismatch or None

    Raises
    ------
    ValueError
        As :func:`process_channel`; both pulses and a speed.

    Notes
    -----
    Its measures and bounds are the project's own: the book's chapter "From a recording to indicators".

    Examples
    --------
    >>> import numpy as np
    >>> from meshtone import ShaftPhase
    >>> rate_hz, teeth = 10_000.0, 19
    >>> turned = 20.0 * np.arange(40_000) / rate_hz
    >>> mesh = sum(np.cos(2 * np.pi * h * teeth * turned) / h for h in (1, 2, 3))
    >>> vibration = (1 + 0.2 * np.cos(2 * np.pi * turned)) * mesh
    >>> phase = ShaftPhase.constant(20.016, rate_hz, vibration.size)
    >>> found = find_mismatch(vibration, phase, teeth, speed_hz=20.016)
    >>> if found is not None:
    ...     print(found.cause, round(found.alternative, 4))
    speed_hz 20.0
    """
    stated = _stated(teeth, mate_teeth, pulses_per_revolution, speed_hz)
    found = _core.find_mismatch(signal_array(signal), native_phase(phase), *stated)
    return None if found is None else Mismatch(*found)


def check_recording(
    signal: npt.ArrayLike,
    phase: ShaftPhase,
    sampling_rate_hz: float,
    teeth: int,
    *,
    mate_teeth: int | None = None,
    pulses_per_revolution: int | None = None,
    speed_hz: float | None = None,
) -> list[SignalWarning]:
    """All that ``meshtone indicators`` would warn of: the phase, what does not fit, tones of neither shaft, an average of noise.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        (any unit) The channel.
    phase : ShaftPhase
        Of the wheel's shaft, as it is stated.
    sampling_rate_hz : float
        (S/s) Of the signal.
    teeth, mate_teeth, pulses_per_revolution, speed_hz
        As of :func:`find_mismatch`; tones of neither shaft are only looked for where ``mate_teeth`` is given, and with a phase from the
        mesh tone ``speed_hz`` is the nominal speed.

    Returns
    -------
    list of SignalWarning

    Raises
    ------
    ValueError
        As :func:`find_mismatch`.

    Examples
    --------
    A recording at 12.8 kHz, stated as 20 kHz:

    >>> import numpy as np
    >>> from meshtone import ShaftPhase
    >>> time_s = np.arange(80_000) / 12_800.0
    >>> vibration = sum(np.cos(2 * np.pi * 29.75 * 32 * h * time_s) for h in (1, 2, 3))
    >>> vibration = vibration + np.random.default_rng(1).normal(size=time_s.size)
    >>> phase = ShaftPhase.constant(30.0, 20_000.0, vibration.size)
    >>> [warning.code for warning in check_recording(vibration, phase, 20_000.0, 32, speed_hz=30.0)]
    ['nothing-synchronous']
    """
    stated = _stated(teeth, mate_teeth, pulses_per_revolution, speed_hz)
    return typed(_core.check_recording(signal_array(signal), native_phase(phase), sampling_rate_hz, *stated))


def _stated(
    teeth: int, mate_teeth: int | None, pulses_per_revolution: int | None, speed_hz: float | None
) -> tuple[int, int | None, int | None, float | None]:
    """What is stated, checked, as the compiled module takes it."""
    if pulses_per_revolution is not None and speed_hz is not None:
        raise ValueError("pulses_per_revolution and speed_hz: a phase is from one of them; leave the other out")
    return (
        teeth_number(teeth),
        None if mate_teeth is None else whole("mate_teeth", mate_teeth, 1),
        None if pulses_per_revolution is None else whole("pulses_per_revolution", pulses_per_revolution, 1),
        speed_hz,
    )
