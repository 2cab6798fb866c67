"""The path to a sensor, from recordings of the healthy machine."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from os import PathLike
from typing import Any, NamedTuple, Union

import numpy as np
import numpy.typing as npt

from . import _core, _progress
from ._files import written_whole
from ._warnings import warn
from .recording import Recording
from .scenario import Scenario, native_scenario
from .signal._arguments import read_only, whole
from .signal.phase import ShaftPhase
from .signal.train import TrainRecording, measured
from .simulation import Simulation, chosen_channel

__all__ = ["PathEstimate", "estimate_path"]

Array = npt.NDArray[np.float64]
Recorded = Union[Simulation, Recording, TrainRecording, tuple[npt.ArrayLike, float, ShaftPhase]]
FEWEST_DRAWS = 8


class Sidebands(NamedTuple):
    """Sidebands at the distance of a shaft's order from the mesh harmonics, as amplitudes over that of their own harmonic."""

    shaft: str
    """Name of the shaft."""
    order: int
    """Its order."""
    level: tuple[float, ...]
    """(-) Their median in the recording, and in the mean simulation."""
    factor: tuple[float, ...]
    """(-) By what those simulated are to be multiplied, with its interval of 90 % over the draws."""
    is_unexplained: bool
    """Whether the recording has more than draws of the wheels, and the scenario no torque that varies so."""


@dataclass(frozen=True)
class PathEstimate:
    """The path from the simulated motion of a sensor's place to what the sensor shows.

    Attributes
    ----------
    frequency_hz : array, shape (points,)
        (Hz) Rising frequencies, from 0 to half the lowest sampling rate.
    magnitude_db : array, shape (points,)
        (dB) Magnitude.
    low_db, high_db : array, shape (points,)
        (dB) The interval that holds it with 90 %.
    phase_deg : array, shape (points,)
        (°) Phase: the least that a system of this magnitude can have.
    compared_hz : tuple of float
        (Hz) The lowest and the highest frequency at which recordings and simulations were compared.
    speed_wander_percent : tuple of float, or None
        (%) Standard deviation of the speed below 8 Hz of the longest steady recording, and the interval that holds it with 90 %: the key
        of that name. None of run-ups and of a speed that was stated, not measured.
    line_share : tuple of float, or None
        (-) The part of the power that repeats with the hunting-tooth period, of the recording and of the mean simulation; None of run-ups, of fewer than
        three periods and without random forces.
    random_force_factor : tuple of float, or None
        (-) By what ``random_force`` of every mesh is to be multiplied for the recording's share, and its interval of 90 % over the draws. Noise of
        the sensor counts as such a force.
    sidebands : list of Sidebands
        Those of a gearbox at the first orders of its shafts; empty of a pair, of run-ups and of fewer than three periods.
    failed_draws : int
        Draws of the wheels that are left out of the path, since a simulation with them failed.
    """

    frequency_hz: Array = field(repr=False)
    magnitude_db: Array = field(repr=False)
    low_db: Array = field(repr=False)
    high_db: Array = field(repr=False)
    phase_deg: Array = field(repr=False)
    compared_hz: tuple[float, float]
    speed_wander_percent: tuple[float, ...] | None
    line_share: tuple[float, ...] | None
    random_force_factor: tuple[float, ...] | None
    sidebands: list[Sidebands]
    failed_draws: int
    _csv: str = field(repr=False)

    @property
    def frequency_response(self) -> dict[str, Array]:
        """The path as ``Sensor(frequency_response=…)`` takes it."""
        magnitude = 10 ** (self.magnitude_db / 20)
        return {"frequency_hz": self.frequency_hz, "magnitude": magnitude, "phase_deg": self.phase_deg}

    def write_csv(self, path: str | PathLike[str]) -> None:
        """Write the file that ``frequency_response = { file = … }`` of a scenario takes.

        Parameters
        ----------
        path : str or path
            Its place; a file that is there already is replaced.
        """
        with written_whole(path) as stream:
            stream.write(self._csv.encode())


def estimate_path(
    recordings: Recorded | list[Recorded],
    scenario: Scenario,
    *,
    draws: int = 24,
    seed: int = 1,
    progress: bool | Callable[[int, int], None] = False,
) -> PathEstimate:
    """Estimate the path to a scenario's first sensor from recordings of the healthy machine.

    The machine is simulated at the recordings' speeds with many draws of its wheels. What the recordings show more at a frequency, in
    mesh harmonics, sidebands and the broad-band remainder alike, is the path. A run-up or several speeds say more than one speed.

    Parameters
    ----------
    recordings : one, or a list of several, by one sensor
        A :class:`Simulation`; a :class:`Recording` of what ``meshtone simulate`` wrote; or a measured signal
        with its rate and the phase of the pinion, or of the input of a gearbox, ``(signal_g, sampling_rate_hz, phase)``. Of a phase of another
        shaft a :class:`~meshtone.signal.TrainRecording` that names it, in g; its ``machine`` is not used, but the scenario.
    scenario : Scenario
        The healthy machine, with the recordings' load. The wall and the mounted resonance of its first sensor stay beside the path; a
        ``frequency_response`` that it has is left out.
    draws : int
        (8 or more) Draws of the wheels.
    seed : int
        Seed of the draws.
    progress : bool or callable, optional
        True for a line on the terminal or a bar in a notebook; or called with the numbers of finished simulations and of all.

    Returns
    -------
    PathEstimate

    Raises
    ------
    ValueError
        A recording that is too short or does not fit the scenario; recordings that no path explains.
    KeyboardInterrupt
        Ctrl-C stops it.

    Examples
    --------
    >>> from meshtone import Sensor, estimate_path, examples, simulate
    >>> rig = examples.healthy().copy(sampling_rate_hz=2e4, sensors=[Sensor()])
    >>> path = estimate_path(simulate(rig.copy(seed=7)), rig, draws=8)
    >>> float(path.frequency_hz[-1])
    10200.0
    >>> tuned = rig.copy(sensors=[Sensor(frequency_response=path.frequency_response)])
    """
    several: list[Any] = recordings if isinstance(recordings, list) else [recordings]
    report = _progress.shown("simulations") if progress is True else (progress or None)
    columns, compared_hz, drive, csv, failed = _core.estimate_path(
        native_scenario(scenario),
        [_healthy(one) for one in several],
        whole("draws", draws, FEWEST_DRAWS),
        whole("seed", seed),
        report,
    )
    frequency_hz, magnitude_db, low_db, high_db, phase_deg = columns
    if any(failed):
        message = f"simulations failed: {failed[0]} of {draws} draws are left out of the path, {failed[1]} of those for the drive"
        warn([message], ["failed-draws"])
    *of_drive, sidebands = drive
    wander, share, factor = (None if known is None else tuple(known) for known in of_drive)
    return PathEstimate(
        frequency_hz=read_only(frequency_hz),
        magnitude_db=read_only(magnitude_db),
        low_db=read_only(low_db),
        high_db=read_only(high_db),
        phase_deg=read_only(phase_deg),
        compared_hz=(compared_hz[0], compared_hz[1]),
        speed_wander_percent=wander,
        line_share=share,
        random_force_factor=factor,
        sidebands=[
            Sidebands(shaft, order, tuple(level), tuple(factor), more)
            for shaft, order, level, factor, more in sidebands
        ],
        failed_draws=failed[0],
        _csv=csv,
    )


def _healthy(one: Any) -> tuple[Array, float, _core.ShaftPhase, str | None]:
    known = measured(one)
    if known is not None:
        return known
    if not isinstance(one, (Recording, Simulation)) or one.scenario is None:
        raise TypeError(
            "recordings: must be simulations, recordings of them, (signal_g, sampling_rate_hz, phase), or a signal.TrainRecording"
        )
    values = one[chosen_channel(one.scenario, None)]
    phase = _core.ShaftPhase.of_simulated(native_scenario(one.scenario), one.start_s, values.size)
    return values, one.sampling_rate_hz, phase, None
