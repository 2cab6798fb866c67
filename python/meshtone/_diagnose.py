"""What may be wrong with a gear, found from recordings by simulations."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from html import escape
from os import PathLike
from typing import Any, Literal, Union

import numpy as np
import numpy.typing as npt

from . import _core, _progress
from ._warnings import SignalWarning, typed, warn_of_signal
from .recording import Recording
from .scenario import Scenario, native_scenario
from .signal._arguments import finite_signal, read_only, whole
from .signal.phase import ShaftPhase
from .signal.train import TrainRecording, measured
from .simulation import Simulation, chosen_channel

__all__ = ["Diagnosis", "diagnose"]

Array = npt.NDArray[np.float64]
Recorded = Union[Simulation, Recording, TrainRecording, tuple[npt.ArrayLike, float, ShaftPhase], npt.NDArray[Any]]
SignalKind = Literal["recording", "average", "difference"]

SHOWN = 0.005
"""(-) Probability below which a notebook's table leaves a kind out."""


@dataclass(frozen=True)
class Diagnosis:
    """What may be wrong with a gear. Probabilities are given the scenario.

    Attributes
    ----------
    kinds : dict of str to dict
        ``healthy``, every kind of damage, and ``several-damages``, two at once, the likeliest first: ``probability``; and if it is that, ``severity`` and ``sizes``
        (``median``, ``within_50``, ``within_90``), ``wheel``, ``wheel_probability``, ``is_on_one_tooth``, ``tooth``,
        ``tooth_probability``, ``angle_deg``. A tooth is None where nothing says from where to count, as after a mesh tone.
    any_damage : dict or None
        The same of a damage whatever its kind: ``severity``, ``wheel``, ``tooth`` and their probabilities, ``one_tooth_probability``.
    bearings : list of dict
        Of a gearbox with ball or roller bearings every race, those with a defect first: ``bearings``, the names of those that it may be of, ``race``,
        ``is_defect``, ``is_detected`` (lines that a sound bearing can have, too), ``false_alarm_probability`` (0.01 stands for all below), ``order``,
        ``found_order``, ``slip``, ``band_hz``, ``depth``, ``healthy_depth``. No severity is estimated.
    rule : dict
        What the indicators alone say, without a simulation: ``is_damaged`` (None without a healthy recording), and ``wheels`` with ``fm4``, ``fm0`` and
        ``sideband_level_factor`` of each, ``now``, ``healthy``, ``limit`` and ``is_above``.
    summary : str
        What it comes to, in a sentence.
    damaged : float
        (-) Probability that anything is damaged.
    outside_model : float
        (-) p-value: the part of the simulations that are as unlike the others as the recordings are, with a healthy recording as what changed since. Below
        0.05, with a healthy recording 0.025, the probabilities mean nothing.
    is_outside : bool
        Whether nothing can be said: the recordings are unlike all that was simulated, or the sensor was mounted anew since the healthy one (``mounting``).
    warnings : list of SignalWarning
        What deserves attention: ``code`` and ``message``.
    shown_wheel : str
        The wheel that the signals are of: the likeliest damaged one.
    difference_g : array, shape (points,)
        (g) The first recording's difference signal over a revolution of that wheel.
    band_g : tuple of array, shape (points,)
        (g) Between which values nine in ten of the simulations that resemble it are.
    """

    kinds: dict[str, dict[str, Any]] = field(repr=False)
    any_damage: dict[str, Any] | None = field(repr=False)
    bearings: list[dict[str, Any]] = field(repr=False)
    rule: dict[str, Any] = field(repr=False)
    summary: str
    damaged: float
    outside_model: float
    is_outside: bool
    warnings: list[SignalWarning]
    shown_wheel: str
    difference_g: Array = field(repr=False)
    band_g: tuple[Array, Array] = field(repr=False)
    _report: dict[str, Any] = field(repr=False)

    def to_dict(self) -> dict[str, Any]:
        """All but the signals, as in ``diagnosis.json``."""
        copy: dict[str, Any] = json.loads(json.dumps(self._report))
        return copy

    def _repr_html_(self) -> str:
        warnings = "".join(f"<p>{escape(warning.message)}</p>" for warning in self.warnings)
        if self.is_outside:
            return f"<p>{escape(self.summary)}</p>{warnings}"
        shown = [(kind, said) for kind, said in self.kinds.items() if said["probability"] >= SHOWN]
        rows = "".join(f"<tr><td>{kind}</td>{_cells(said)}</tr>" for kind, said in shown)
        head = "<tr><th>kind</th><th>probability</th><th>severity (90 %)</th><th>where</th></tr>"
        p = "p < 0.001" if self.outside_model < 0.001 else f"p = {self.outside_model:.3f}"
        facts = f"damaged with a probability of {100 * self.damaged:.1f} %, {p}; given the scenario"
        return f"<p>{escape(self.summary)}</p><p>{facts}</p><table>{head}{rows}</table>{warnings}"


def _cells(said: dict[str, Any]) -> str:
    severity, where = said["severity"], said["wheel"]
    size = "-"
    if severity is not None:
        low, high = severity["within_90"]
        size = f"{severity['median']:.2f} ({low:.2f} to {high:.2f})"
    if said["tooth"] is not None:
        where = f"{where}, tooth {said['tooth']}"
    elif said["is_on_one_tooth"]:
        where = f"{where}, one tooth"
    return f"<td>{100 * said['probability']:.1f} %</td><td>{size}</td><td>{where or '-'}</td>"


def diagnose(
    recordings: Recorded | Sequence[Recorded],
    scenario: Scenario,
    healthy: Recorded | Sequence[Recorded] | None = None,
    *,
    signal: SignalKind = "recording",
    tuned: str | PathLike[str] | None = None,
    reference: str | PathLike[str] | None = None,
    records: int = 6144,
    progress: bool | Callable[[int, int], None] = False,
) -> Diagnosis:
    """Say what may be wrong with a gear, by simulations of its rig with all kinds of damage.

    The first question about a scenario takes minutes; its simulations are kept for the next one. What is doubtful about the recordings
    and the scenario is warned of before them, what the answer shows at the end; ``warnings`` of the answer has both.

    Parameters
    ----------
    recordings : one or several, all of one state of the gear
        A :class:`Simulation`, of which the first sensor counts; a :class:`Recording` of what ``meshtone
        simulate`` wrote; or a measured signal with its rate and the phase of the pinion or of a gearbox's input,
        ``(signal_g, sampling_rate_hz, phase)``. Of a phase of another shaft a :class:`~meshtone.signal.TrainRecording` that names it, in g; its
        ``machine`` is not used, but the scenario. With another `signal` arrays: one revolution of the gear, in g.
    scenario : Scenario
        The rig; its faults are left out.
    healthy : the same, optional
        The same rig when it was healthy, each recording at its own rate; all at one speed, best that of the others: beyond 5 % healthy rigs are simulated at
        that speed too.
    signal : {'recording', 'average', 'difference'}
        What the recordings are.
    tuned : str or path, optional
        A ``tuned.toml``, whose numbers are put into the scenario.
    reference : str or path, optional
        Folder in which simulations are kept; by default ``meshtone/reference`` in the user's cache directory.
    records : int
        (512 to 20480) Simulations to learn from, in batches of 512.
    progress : bool or callable, optional
        True for a line on the terminal or a bar in a notebook; or called with the numbers of simulations that are there and of all.

    Returns
    -------
    Diagnosis

    Raises
    ------
    ValueError
        Recordings of other wheels, of a speed far from the scenario's, too short, or in which too few orders are whole: before anything is
        simulated. A ``tuned.toml`` of another model.
    OSError
        A folder or file that cannot be read or written.
    KeyboardInterrupt
        Ctrl-C stops it; simulations in finished batches of 512 stay.

    Examples
    --------
    >>> import warnings
    >>> from meshtone import MeshtoneWarning, MissingTooth, diagnose, examples, simulate
    >>> rig = examples.healthy()

    What is doubtful is warned of before minutes of simulations, so that it can be an error:

    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("error", MeshtoneWarning)
    ...     try:
    ...         diagnose(simulate(rig), rig)
    ...     except MeshtoneWarning as warning:
    ...         print(warning.code)
    no-healthy

    >>> found = diagnose(simulate(rig.copy(fault=MissingTooth())), rig, simulate(rig))   # doctest: +SKIP
    >>> next(iter(found.kinds)), found.damaged > 0.99                                      # doctest: +SKIP
    ('missing-tooth', True)
    """
    if signal not in ("recording", "average", "difference"):
        raise ValueError(f"signal '{signal}': must be 'recording', 'average' or 'difference'")
    if not native_scenario(scenario).is_pair and signal != "recording":
        raise ValueError(f"signal = '{signal}': needs the scenario of a pair; give whole recordings of a gearbox")
    rig = native_scenario(scenario)
    if tuned is not None:
        rig = _core.tuned_rig(rig, tuned)
    now = _observations("recordings", recordings, scenario, signal)
    before = [] if healthy is None else _observations("healthy", healthy, scenario, signal)
    count = _records(records)
    known = typed((code, message, []) for code, message in _core.check_diagnosis(rig, now, before))
    warn_of_signal(known)
    shown = _progress.shown("simulations") if progress is True else (progress or None)
    text, difference_g, (low, high) = _core.diagnose(rig, now, before, reference, count, shown)
    report = json.loads(text)
    found = [SignalWarning(said["code"], said["message"], {}) for said in report["warnings"]]
    warn_of_signal(warning for warning in found if warning not in known)
    return Diagnosis(
        kinds=report["kinds"],
        any_damage=report["any_damage"],
        bearings=report["bearings"],
        rule=report["rule"],
        summary=report["summary"],
        damaged=report["damaged"],
        outside_model=report["outside_model"],
        is_outside=report["is_outside"],
        warnings=found,
        shown_wheel=report["shown_wheel"],
        difference_g=read_only(difference_g),
        band_g=(read_only(low), read_only(high)),
        _report=report,
    )


def _records(records: int) -> int:
    most = 20_480
    if whole("records", records, 512) > most:
        raise ValueError(f"records = {records}: must be at most {most}: time and memory grow with their square")
    return records


def _observations(
    name: str,
    given: Recorded | Sequence[Recorded],
    scenario: Scenario,
    signal: str,
) -> list[_core.Observation]:
    several: Sequence[Any] = given if isinstance(given, list) else [given]
    if not several:
        raise ValueError(f"{name}: must be at least one")
    return [_observation(name, one, scenario, signal) for one in several]


def _observation(name: str, one: Any, scenario: Scenario, signal: str) -> _core.Observation:
    if signal != "recording":
        return _core.Observation.of_revolution(finite_signal(one), scenario.gear_teeth, signal)
    if isinstance(one, (Simulation, Recording)) and one.scenario is not None:
        values = one[chosen_channel(one.scenario, None)]
        return _core.Observation.of_simulated(native_scenario(one.scenario), values, one.start_s)
    known = measured(one)
    if known is not None:
        return _core.Observation.of_measured(*known, native_scenario(scenario))
    raise TypeError(
        f"{name}: must be simulations, recordings of them, (signal_g, sampling_rate_hz, phase), or a signal.TrainRecording"
    )
