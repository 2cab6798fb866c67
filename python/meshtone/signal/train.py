"""All shafts and wheels of a pair or a gearbox, by the phase of one shaft."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from .. import _core
from .._warnings import SignalWarning, typed, warn_of_signal
from ..scenario import Scenario, native_scenario
from ._arguments import finite_signal, positive, regular_part, signal_array
from .bearings import Bearing, DefectLine, SquaredEnvelopeSpectrum
from .kurtosis import Kurtogram
from .phase import ShaftPhase, native_phase
from .record import Record


@dataclass(frozen=True)
class ForeignLine:
    """A line of a recording that belongs to no shaft and no mesh of a machine.

    Attributes
    ----------
    frequency_hz : float
        (Hz) At the mean speed of the recording.
    order : float
        (orders of the pinion's shaft, of a gearbox of the input) Its order.
    amplitude : float
        (unit of the signal) Its amplitude.
    part_of_energy : float
        (-) Its part of the recording's energy.
    """

    frequency_hz: float
    order: float
    amplitude: float
    part_of_energy: float


@dataclass(frozen=True)
class TrainRecord:
    """What one channel shows about all wheels of a machine.

    Attributes
    ----------
    wheels : dict of str to Record
        By the wheels' names, of those that turn often enough for an average. Wheels on one shaft have the same average and difference; their tooth counts differ.
    shafts : dict of str to str
        The shaft of each wheel.
    mean_speeds_hz : dict of str to float
        (Hz) Mean speed of each shaft that has a wheel.
    foreign_lines : list of ForeignLine or None
        Lines that belong to no shaft and no mesh, the strongest first; None where they were not looked for: over a run-up, where a stated value
        does not fit, in fewer than six revolutions. Weak ones are listed only where the recording has four hunting-tooth periods: see ``foreign_lines_need_s``.
    own_orders_part : float or None
        (-) Part of all orders at which a line is taken to be of a shaft or a mesh: foreign lines among them are not found. It falls with the length of
        the recording.
    foreign_lines_need_s : float or None
        (s) Length that a recording needs for weak foreign lines to be distinguished from hunting-tooth orders; None where this one has it.
    warnings : list of SignalWarning
        What is doubtful.
    """

    wheels: dict[str, Record] = field(repr=False)
    shafts: dict[str, str]
    mean_speeds_hz: dict[str, float]
    foreign_lines: list[ForeignLine] | None
    own_orders_part: float | None
    foreign_lines_need_s: float | None
    warnings: list[SignalWarning]

    def __getitem__(self, wheel: str) -> Record:
        if wheel not in self.wheels:
            raise KeyError(f"there is no average of a wheel {wheel!r}; there are those of {', '.join(self.wheels)}")
        return self.wheels[wheel]


@dataclass(frozen=True)
class RaceTest:
    """What a recording shows of one race of a bearing.

    Attributes
    ----------
    race : str
        ``outer race``, ``inner race`` or ``rolling element``.
    order, found_order : float
        (orders of the shaft) Its first line without slip, and where its lines are strongest together, within 3 %.
    band_hz : (float, float)
        (Hz) Band in which they are strongest.
    depth : float
        (-) Amplitude of the first line over the mean of the squared envelope. Compare it with an earlier recording; it is no severity.
    false_alarm_probability : float
        (-) Probability that some race looks like this without a defect; 0.01 stands for all below.
    is_detected : bool
        Whether it is below 0.01.
    """

    race: str
    order: float
    found_order: float
    band_hz: tuple[float, float]
    depth: float
    false_alarm_probability: float
    is_detected: bool

    @property
    def slip(self) -> float:
        """(-) How far its lines are from where they would be without slip, as a part."""
        return self.found_order / self.order - 1


@dataclass(frozen=True)
class UnexplainedComb:
    """The strongest comb of lines that is of no stated race.

    Attributes
    ----------
    order : float
        (orders of the bearing's shaft) Its first line.
    band_hz : (float, float)
        (Hz) Band in which it is strongest.
    ratios : list of (str, float)
        For each race how many times as fast the shaft would have to turn to explain it.
    in_words : str
        All that as a sentence.
    """

    order: float
    band_hz: tuple[float, float]
    ratios: list[tuple[str, float]]
    in_words: str


@dataclass(frozen=True)
class BearingVerdict:
    """What a recording says about a bearing.

    Attributes
    ----------
    verdict : str
        ``outer race``, ``inner race`` or ``rolling element``, of several the first that was found; ``nothing``; ``cannot tell``.
    in_words : str
        A sentence: the race with its band, slip and probability, or why the recording does not tell.
    races : list of RaceTest
        Its races, those with a defect first.
    unexplained : UnexplainedComb or None
        Lines of no stated race, where none is named: speed, rate or geometry does not fit.
    """

    verdict: str
    in_words: str
    races: list[RaceTest]
    unexplained: UnexplainedComb | None


@dataclass(frozen=True, eq=False)
class BearingRecords:
    """What a recording shows about bearings.

    Attributes
    ----------
    verdicts : list of BearingVerdict
        The verdict about each bearing.
    kurtogram : Kurtogram
        Of what was left after the separation.
    band_hz : (float, float)
        (Hz) Band of the squared envelope.
    kurtosis : float or None
        (-) Kurtosis in it, where the kurtogram chose it.
    bearings : list of (Bearing, str)
        The bearings that were looked for, each with the name of its shaft.
    spectra : list of SquaredEnvelopeSpectrum
        Of each bearing, over the orders of its shaft.
    lines : list of list of DefectLine
        The lines of each bearing.
    warnings : list of SignalWarning
        ``not-averaged``: shafts with fewer than eight revolutions, whose tones are left.
    """

    verdicts: list[BearingVerdict]
    kurtogram: Kurtogram = field(repr=False)
    band_hz: tuple[float, float]
    kurtosis: float | None
    bearings: list[tuple[Bearing, str]]
    spectra: list[SquaredEnvelopeSpectrum] = field(repr=False)
    lines: list[list[DefectLine]] = field(repr=False)
    warnings: list[SignalWarning]


@dataclass(frozen=True, eq=False)
class TrainRecording:
    """A channel of a recording of a machine, with the phase of one of its shafts, which the tooth counts carry to the others.

    Attributes
    ----------
    signal : array_like, shape (samples,)
        (any unit) The channel.
    phase : ShaftPhase
        Of one shaft.
    sampling_rate_hz : float
        (S/s) Of the signal.
    machine : Scenario, optional
        Its tooth counts and its rolling bearings are used; without it there is one shaft, and no wheel.
    shaft : str, optional
        Name of the shaft that the phase is of; by default the pinion's, or the input of a gearbox.
    """

    signal: npt.ArrayLike = field(repr=False)
    phase: ShaftPhase = field(repr=False)
    sampling_rate_hz: float
    machine: Scenario | None = field(default=None, repr=False)
    shaft: str | None = None

    def bearings(
        self,
        bearings: Sequence[Bearing | tuple[Bearing, str]] | None = None,
        *,
        separation: Literal["averages", "discrete-random", "prewhitening", "none"] = "averages",
        band_hz: tuple[float, float] | Literal["kurtogram"] | None = None,
    ) -> BearingRecords:
        """Judge bearings and look at the lines of their defects, as ``meshtone indicators`` does.

        The verdict holds for bearings at whose seat the sensor is. It does not depend on ``separation`` and ``band_hz``, which are of the lines and spectra.

        Parameters
        ----------
        bearings : sequence of Bearing or (Bearing, str), optional
            Each with the name of the shaft in its inner ring, by default the shaft that the phase is of. Without it, the rolling bearings of
            the machine, each geometry on a shaft once.
        separation : {'averages', 'discrete-random', 'prewhitening', 'none'}
            What is removed first because it comes from the gears.
        band_hz : (float, float) or 'kurtogram', optional
            (Hz) Band of the squared envelope; by default that in which the verdict sees most. That of the kurtogram has the largest kurtosis among those at
            least three times as wide as the largest BPFI.

        Returns
        -------
        BearingRecords

        Raises
        ------
        ValueError
            No bearing, and a machine without rolling ones; a shaft that there is not; a band that is empty or reaches beyond half the sampling rate; NaN; a constant signal.

        Examples
        --------
        A resonance at 4 kHz that rings whenever a ball passes a place of the outer race, beside a mesh of 19 teeth:

        >>> import numpy as np
        >>> from meshtone import ShaftPhase
        >>> from meshtone.signal import Bearing, TrainRecording
        >>> bearing = Bearing.named("6205")
        >>> phase = ShaftPhase.constant(30.0, 20_000.0, 60_000)
        >>> since_s = (phase.revolutions * bearing.defect_orders.outer_race % 1) / (30 * bearing.defect_orders.outer_race)
        >>> ringing = np.exp(-800 * since_s) * np.sin(2 * np.pi * 4000 * since_s)
        >>> noise = np.random.default_rng(1).standard_normal(ringing.size)
        >>> recording = TrainRecording(ringing + noise + np.cos(2 * np.pi * 19 * phase.revolutions), phase, 20_000.0)
        >>> found = recording.bearings([bearing])
        >>> found.verdicts[0].verdict
        'outer race'
        >>> max(found.lines[0], key=lambda line: line.amplitude).line
        'BPFO'
        """
        placed = None if bearings is None else [(of, None) if isinstance(of, Bearing) else of for of in bearings]
        rate_hz = positive("sampling_rate_hz", self.sampling_rate_hz)
        parts = _core.bearings_of_train(
            signal_array(self.signal),
            native_phase(self.phase),
            None if self.machine is None else native_scenario(self.machine),
            rate_hz,
            self.shaft,
            None if placed is None else [(of._native, shaft) for of, shaft in placed],
            separation,
            None if band_hz == "kurtogram" else band_hz,
            band_hz == "kurtogram",
        )
        warnings = typed(parts["warnings"])
        warn_of_signal(warnings)
        verdicts = [
            BearingVerdict(
                name, in_words, [RaceTest(*of) for of in races], None if unexplained is None else UnexplainedComb(*unexplained)
            )
            for name, in_words, races, unexplained in parts["verdicts"]
        ]
        return BearingRecords(
            verdicts=verdicts,
            kurtogram=Kurtogram(parts["levels"], rate_hz),
            band_hz=parts["band_hz"],
            kurtosis=parts["kurtosis"],
            bearings=[(Bearing(*geometry), shaft) for geometry, shaft in parts["placed"]],
            spectra=[SquaredEnvelopeSpectrum(np.arange(of.size) * step, of) for step, of, _ in parts["bearings"]],
            lines=[[DefectLine(*line) for line in lines] for _, _, lines in parts["bearings"]],
            warnings=warnings,
        )


def measured(one: Any) -> tuple[npt.NDArray[np.float64], float, _core.ShaftPhase, str | None] | None:
    """A measured recording of a machine that is stated beside it, as the compiled module takes it; None of anything else."""
    if isinstance(one, tuple) and len(one) == 3:
        values, rate_hz, phase = one
        shaft = None
    elif isinstance(one, TrainRecording):
        values, rate_hz, phase, shaft = one.signal, one.sampling_rate_hz, one.phase, one.shaft
    else:
        return None
    return finite_signal(values), positive("sampling_rate_hz", rate_hz), native_phase(phase), shaft


def process_train(
    signal: npt.ArrayLike,
    phase: ShaftPhase,
    machine: Scenario,
    sampling_rate_hz: float,
    *,
    shaft: str | None = None,
    sidebands: int | None = None,
    shaft_orders: Sequence[int] | None = None,
    name: str = "signal",
) -> TrainRecord:
    """Take one channel to the averages and indicators of every wheel of a pair or a gearbox, and to the lines of neither shafts nor meshes.

    The phase of one shaft is carried to the others through the tooth counts. In a gearbox of three shafts or more the difference signal is also
    without the whole orders of faster shafts and of other meshes.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        (any unit) The channel.
    phase : ShaftPhase
        Of one shaft.
    machine : Scenario
        Its tooth counts are used.
    sampling_rate_hz : float
        (S/s) Of the signal.
    shaft : str, optional
        Name of the shaft that the phase is of: of a scenario ``pinion`` or ``gear``. By default the pinion's, or the input of a gearbox.
    sidebands, shaft_orders
        As of :func:`process_channel`.
    name : str
        Of the channel, for figures.

    Returns
    -------
    TrainRecord

    Raises
    ------
    ValueError
        A shaft that there is not; for the first wheel of which that is so, what :func:`process_channel` refuses.

    Examples
    --------
    A tachometer on the input shows all shafts of a gearbox:

    >>> import numpy as np
    >>> from meshtone import Scenario, gearbox_template, signal, simulate
    >>> gearbox = Scenario.from_toml(gearbox_template())
    >>> simulation = simulate(gearbox)
    >>> vibration, rate_hz = simulation["output_1_vertical_g"], simulation.sampling_rate_hz
    >>> pulses_s = np.arange(0.0, 1.0, 1 / 30)
    >>> phase = signal.ShaftPhase.from_pulses(pulses_s, 1, rate_hz, vibration.size)
    >>> record = signal.process_train(vibration, phase, gearbox, rate_hz)
    >>> {wheel: record[wheel].revolutions for wheel in record.wheels}
    {'z1': 29, 'z2': 9, 'z3': 9, 'z4': 5}
    >>> record.foreign_lines
    []
    """
    bands, orders = regular_part(sidebands, shaft_orders)
    rate_hz = positive("sampling_rate_hz", sampling_rate_hz)
    parts = _core.process_train(signal_array(signal), native_phase(phase), native_scenario(machine), rate_hz, shaft, bands, orders)
    return train_record(parts, name)


def train_record(parts: dict[str, Any], name: str) -> TrainRecord:
    """The results of the compiled module, with its warnings."""
    warnings = typed(parts["warnings"])
    warn_of_signal(warnings)
    wheels = parts["wheels"]
    foreign = parts["foreign"]
    return TrainRecord(
        wheels={wheel: Record(record, teeth=teeth, name=name) for wheel, _, teeth, _, record in wheels},
        shafts={wheel: shaft for wheel, shaft, *_ in wheels},
        mean_speeds_hz={shaft: speed_hz for _, shaft, _, speed_hz, _ in wheels},
        foreign_lines=None if foreign is None else [ForeignLine(*line) for line in foreign],
        own_orders_part=parts["own_orders_part"],
        foreign_lines_need_s=parts["foreign_lines_need_s"],
        warnings=warnings,
    )
