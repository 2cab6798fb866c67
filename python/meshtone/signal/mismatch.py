"""A check of a recording against what the user states about it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy.typing as npt

from .. import _core
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
    if pulses_per_revolution is not None and speed_hz is not None:
        raise ValueError("pulses_per_revolution and speed_hz: a phase is from one of them; leave the other out")
    found = _core.find_mismatch(
        signal_array(signal),
        native_phase(phase),
        teeth_number(teeth),
        None if mate_teeth is None else whole("mate_teeth", mate_teeth, 1),
        None if pulses_per_revolution is None else whole("pulses_per_revolution", pulses_per_revolution, 1),
        speed_hz,
    )
    return None if found is None else Mismatch(*found)
