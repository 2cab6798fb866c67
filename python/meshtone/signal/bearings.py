"""Rolling bearings: the orders of their defects, and the lines of a squared envelope spectrum at these orders."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from .. import _core
from ._arguments import Array, positive, signal_array, whole
from .phase import ShaftPhase, native_phase


@dataclass(frozen=True)
class DefectOrders:
    """Orders at which the defects of a bearing show, in orders of the shaft in its inner ring; the outer ring stands still.

    Attributes
    ----------
    cage : float
        (orders) FTF, at which the cage turns.
    outer_race : float
        (orders) BPFO, at which the elements pass a place of the outer race.
    inner_race : float
        (orders) BPFI, at which the elements pass a place of the inner race.
    element_spin : float
        (orders) BSF, at which an element turns about itself; a place on it meets a race twice a turn, so that its line is at 2 BSF.
    """

    cage: float
    outer_race: float
    inner_race: float
    element_spin: float


@dataclass(frozen=True)
class Bearing:
    """Geometry of a rolling bearing, as far as its defect orders depend on it.

    Attributes
    ----------
    elements : int
        Number of balls or rollers, of one row; 3 to 200.
    element_mm : float
        (mm) Their diameter.
    pitch_mm : float
        (mm) Diameter of the circle through their centres.
    contact_angle_deg : float
        (°) Contact angle, 0 to below 90.
    source : str, optional
        The publication that states the geometry, of a bearing by name.

    Raises
    ------
    ValueError
        Values out of these ranges; elements that have no room beside each other.

    Examples
    --------
    >>> Bearing(9, 7.94, 39.04) == Bearing.named("6205")
    True
    >>> orders = Bearing.named("ER-10K").defect_orders
    >>> round(orders.outer_race, 5), round(orders.inner_race, 5)
    (3.05231, 4.94769)
    """

    elements: int
    element_mm: float
    pitch_mm: float
    contact_angle_deg: float = 0.0
    source: str | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        _core.defect_orders(self._native)

    @property
    def _native(self) -> tuple[int, float, float, float]:
        return whole("elements", self.elements, 1), self.element_mm, self.pitch_mm, self.contact_angle_deg

    @staticmethod
    def named(name: str) -> Bearing:
        """A bearing of a public recording by its designation; another maker's of the same designation may differ.

        Parameters
        ----------
        name : str
            Of :data:`NAMED_BEARINGS`.

        Raises
        ------
        KeyError
            Another name.
        """
        if name not in NAMED_BEARINGS:
            raise KeyError(f"there is no bearing {name!r}; there are {', '.join(NAMED_BEARINGS)}")
        return NAMED_BEARINGS[name]

    @property
    def defect_orders(self) -> DefectOrders:
        """The defect orders, for rolling without slip, which moves them by up to some 1 or 2 %.

        R. B. Randall, J. Antoni, Mechanical Systems and Signal Processing 25 (2011) 485–520, equations 1 to 4.
        """
        return DefectOrders(*_core.defect_orders(self._native))


NAMED_BEARINGS: dict[str, Bearing] = {name: Bearing(*of, source) for name, of, source in _core.named_bearings()}
"""The bearings of public recordings, each with its source."""


@dataclass(frozen=True, eq=False)
class SquaredEnvelopeSpectrum:
    """Spectrum of a squared envelope, with a Hann window and without its mean.

    Attributes
    ----------
    places : array, shape (lines,)
        Frequencies in Hz, or orders of the shaft.
    amplitude : array, shape (lines,)
        In the signal's unit, squared; of a cosine its amplitude, at least 0.85 of it between two lines.
    """

    places: Array
    amplitude: Array


@dataclass(frozen=True)
class DefectLine:
    """A line at which a defect would show.

    Attributes
    ----------
    line : str
        Its name, such as ``BPFO``, ``2 BPFO`` or ``4 BSF``.
    part : {'cage', 'outer race', 'inner race', 'rolling element'}
        Part of the bearing that would be damaged.
    order : float
        (orders of the shaft) Its place without slip.
    found_order : float
        (orders of the shaft) Place of the largest amplitude within 1.5 % of it.
    amplitude : float
        (unit of the signal, squared) That amplitude.
    over_median : float
        (-) That amplitude over the median of those beside it; noise alone has 2 to 4.
    is_beside_shaft_order : bool
        Whether the spectrum is too coarse to separate the line from a whole order of the shaft.
    """

    line: str
    part: str
    order: float
    found_order: float
    amplitude: float
    over_median: float
    is_beside_shaft_order: bool


def squared_envelope(signal: npt.ArrayLike, sampling_rate_hz: float, band_hz: tuple[float, float] | None = None) -> Array:
    """Square of the modulus of the analytic signal of a band.

    Parameters
    ----------
    signal : array_like, shape (samples,)
        (any unit) The signal.
    sampling_rate_hz : float
        (S/s) Its sampling rate.
    band_hz : (float, float), optional
        (Hz) Ends of the band; by default all frequencies but 0.

    Returns
    -------
    array, shape (samples,)
        In the signal's unit, squared.

    Raises
    ------
    ValueError
        NaN; a constant signal; a band that is empty or reaches beyond half the sampling rate.

    Examples
    --------
    >>> import numpy as np
    >>> squared_envelope(3 * np.cos(2 * np.pi * 100 * np.arange(1000) / 1000) + 1, 1000.0, (50.0, 150.0)).round(6)[:2]
    array([9., 9.])
    """
    return _core.squared_envelope(signal_array(signal), positive("sampling_rate_hz", sampling_rate_hz), band_hz)


def squared_envelope_spectrum(
    signal: npt.ArrayLike, sampling_rate_hz: float, band_hz: tuple[float, float] | None = None
) -> SquaredEnvelopeSpectrum:
    """Spectrum of the :func:`squared_envelope` over frequency.

    Parameters
    ----------
    signal, sampling_rate_hz, band_hz
        As of :func:`squared_envelope`.

    Returns
    -------
    SquaredEnvelopeSpectrum
        Over Hz.

    Raises
    ------
    ValueError
        As :func:`squared_envelope`.

    Examples
    --------
    >>> import numpy as np
    >>> time_s = np.arange(1000) / 1000
    >>> modulated = (1 + np.cos(2 * np.pi * 30 * time_s)) * np.cos(2 * np.pi * 200 * time_s)
    >>> squared_envelope_spectrum(modulated, 1000.0).amplitude[[30, 60]].round(6)
    array([2. , 0.5])
    """
    step, amplitude = _core.squared_envelope_spectrum(
        signal_array(signal), positive("sampling_rate_hz", sampling_rate_hz), band_hz, None
    )
    return SquaredEnvelopeSpectrum(np.arange(amplitude.size, dtype=np.float64) * step, amplitude)


def squared_envelope_order_spectrum(
    signal: npt.ArrayLike, sampling_rate_hz: float, phase: ShaftPhase, band_hz: tuple[float, float] | None = None
) -> SquaredEnvelopeSpectrum:
    """Spectrum of the :func:`squared_envelope` over the orders of a shaft, whose speed may vary: the band stays one of frequency.

    Parameters
    ----------
    signal, sampling_rate_hz, band_hz
        As of :func:`squared_envelope`.
    phase : ShaftPhase
        Of the shaft.

    Returns
    -------
    SquaredEnvelopeSpectrum
        Over orders.

    Raises
    ------
    ValueError
        As :func:`squared_envelope`, and fewer than one whole revolution.
    """
    step, amplitude = _core.squared_envelope_spectrum(
        signal_array(signal), positive("sampling_rate_hz", sampling_rate_hz), band_hz, native_phase(phase)
    )
    return SquaredEnvelopeSpectrum(np.arange(amplitude.size, dtype=np.float64) * step, amplitude)


def defect_lines(spectrum: SquaredEnvelopeSpectrum, bearing: Bearing, shaft: float = 1.0) -> list[DefectLine]:
    """The lines of a bearing's defects: FTF, and three harmonics each of BPFO, BPFI and 2 BSF.

    Each is the largest amplitude within 1.5 % of its place; those within two lines of a whole order of the shaft are not taken for it, unless
    its own place is as near.

    Parameters
    ----------
    spectrum : SquaredEnvelopeSpectrum
        Over orders of a shaft, or over Hz.
    bearing : Bearing
        The bearing.
    shaft : float
        (of the spectrum's axis) Place of order 1 of the bearing's shaft: 1 over its own orders, its speed in Hz over frequency.

    Returns
    -------
    list of DefectLine
        Those within the spectrum.

    Examples
    --------
    A resonance at 4 kHz that rings whenever a ball passes a place of the outer race:

    >>> import numpy as np
    >>> from meshtone import ShaftPhase
    >>> bearing = Bearing.named("6205")
    >>> phase = ShaftPhase.constant(30.0, 20_000.0, 60_000)
    >>> since_s = (phase.revolutions * bearing.defect_orders.outer_race % 1) / (30 * bearing.defect_orders.outer_race)
    >>> vibration = np.exp(-800 * since_s) * np.sin(2 * np.pi * 4000 * since_s)
    >>> spectrum = squared_envelope_order_spectrum(vibration, 20_000.0, phase, (3000.0, 5000.0))
    >>> max(defect_lines(spectrum, bearing), key=lambda line: line.amplitude).line
    'BPFO'
    """
    step = spectrum.places[1] if spectrum.places.size > 1 else 1.0
    place = positive("shaft", shaft)
    return [DefectLine(*line) for line in _core.defect_lines(float(step), signal_array(spectrum.amplitude), bearing._native, place)]
