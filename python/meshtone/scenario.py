"""What is simulated."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, Literal, TypedDict, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._sections import FORMER_KEYS, KEY_IN_FILE, OTHER_ARGUMENTS, SECTION_OF_KEY, check_key, hint
from .faults import Fault, from_section, to_section

__all__ = ["Scenario", "Shaft", "TipRelief", "WheelInertia", "template"]

Material = Literal["steel", "copper", "aluminium", "brass", "cast-iron", "bronze"]


class TipRelief(TypedDict, total=False):
    """Material removed near the tips."""

    shape: Literal["parabolic", "linear"]
    length_mm: float
    depth_mm: float


class Shaft(TypedDict):
    """A shaft between a wheel and the motor or the brake."""

    length_mm: float
    radius_mm: float


class WheelInertia(TypedDict, total=False):
    """Mass and inertias of a wheel."""

    mass_kg: float
    polar_inertia_kgm2: float
    transverse_inertia_kgm2: float


Profile = Mapping[str, Union[Sequence[float], npt.NDArray[np.float64]]]


class Scenario:
    """Everything that one simulation depends on.

    The arguments are the keys of the scenario file, with its names, units and defaults; ``None`` is the default. A scenario does
    not change: :meth:`copy` gives another one.

    Parameters
    ----------
    module_mm : float
        (mm) Module of both wheels.
    pinion_teeth, gear_teeth : int
        Tooth counts of the driving and of the driven wheel.
    face_width_mm : float
        (mm) Face width of both wheels.
    pinion_speed_hz : float
        (rev/s) Nominal speed of the motor, which turns the pinion.
    brake_torque_nm : float
        (N m) Nominal torque of the brake on the gear's shaft.
    fault : MissingTooth or ToothBreakage or PartialFace or ThroughFace or ToothDestruction, optional
        The damage, if there is but one; a healthy pair by default.
    faults : sequence of faults, optional
        All damage, instead of ``fault``: any number of faults, on any teeth of either wheel.
    model : {'linear', 'published'}, optional
        The model of the mesh: what the theory says, or what the published code does, its slips included. 'linear' by default.
    seed : int, optional
        Of every random draw. 1 by default.
    pressure_angle_deg : float, optional
        (°) 20 by default.
    material : str, optional
        'steel', 'copper', 'aluminium', 'brass', 'cast-iron' or 'bronze'.
    tip_relief : dict or False, optional
        ``shape`` ('parabolic' or 'linear'), ``length_mm``, ``depth_mm``; False for none.
    crowning_mm : float, optional
        (mm) Constant reduction of the working flank. 0 by default.
    points_per_tooth : int, optional
        Points along a tooth's profile. 10000 by default.
    foundation : dict, optional
        Coefficients A to F of the polynomials L, M, P, Q of the fillet foundation's compliance.
    speed_fluctuation_hz, torque_fluctuation_nm : float, optional
        (Hz, N m) Half width of a uniform error, drawn for every sample. 0 by default.
    speed_profile_hz, torque_profile_nm : dict, optional
        ``time_s`` and ``value``: speed or torque against time instead of a constant one.
    din_grade : int, optional
        Manufacturing grade of DIN 3962, 1 (best) to 12; 0, the default, for ideal teeth.
    wheels_seed : int, optional
        Which wheels ``din_grade`` draws: ``seed`` of the section ``[quality]``. ``seed`` by default.
    pinion_profile_errors_mm, gear_profile_errors_mm : array of float64, shape (100, teeth), optional
        (mm) The teeth's profile errors themselves, instead of a draw by ``din_grade``.
    bearing_stiffness_n_per_m : float, optional
        (N/m) Stiffness of each wheel's bearing in x, y and z. 1.9e8 by default.
    wheel_rotational_stiffness_nm_per_rad : float, optional
        (N m/rad) Stiffness of each wheel against tilting. 1e8 by default.
    brake_inertia_kgm2 : float, optional
        (kg m²) 4.5e-3 by default.
    damping_ratio : float or sequence of 13 floats, optional
        (-) Of every mode. 0.05 by default.
    eccentricity_mm : float, optional
        (mm) Of both wheels. 0 by default.
    pinion_shaft, gear_shaft : dict, optional
        ``length_mm`` and ``radius_mm``.
    pinion_inertia, gear_inertia : dict, optional
        ``mass_kg``, ``polar_inertia_kgm2``, ``transverse_inertia_kgm2``; those of a solid disc by default.
    sampling_rate_hz : float, optional
        (S/s) Nominal rate; the actual one is the next that divides both shafts' revolutions. 1e5 by default.
    settle_fraction : float, optional
        (-) Part of the simulation that is discarded while the vibration settles. 0.5 by default.
    settle_tolerance : float, optional
        (-) 1e-6 by default; 0 simulates from the start.
    initial_displacement, initial_velocity : sequence of 13 floats, optional
        (m, rad; m/s, rad/s) Of the coordinates, in the order of the book's chapter "Equations of motion".

    Raises
    ------
    ValueError
        A value that is not allowed: the text names the key, the value and what is allowed.
    TypeError
        A key that a scenario does not have.

    Examples
    --------
    >>> scenario = Scenario(module_mm=3, pinion_teeth=17, gear_teeth=38, face_width_mm=15,
    ...                     pinion_speed_hz=40, brake_torque_nm=10, din_grade=7)
    >>> scenario
    Scenario(module_mm=3.0, pinion_teeth=17, gear_teeth=38, face_width_mm=15.0, pinion_speed_hz=40.0, \
brake_torque_nm=10.0, din_grade=7)
    >>> scenario.pressure_angle_deg
    20.0
    >>> scenario.copy(module_mm=-1)
    Traceback (most recent call last):
        ...
    ValueError: gears.module_mm = -1: must be more than 0 mm
    """

    __slots__ = ("_flat", "_native")

    _flat: dict[str, Any]
    _native: _core.Scenario

    model: Literal["linear", "published"]
    seed: int
    module_mm: float
    pinion_teeth: int
    gear_teeth: int
    face_width_mm: float
    pressure_angle_deg: float
    material: Material
    tip_relief: TipRelief | Literal[False]
    crowning_mm: float
    points_per_tooth: int
    foundation: dict[str, list[float]]
    pinion_speed_hz: float
    brake_torque_nm: float
    speed_fluctuation_hz: float
    torque_fluctuation_nm: float
    speed_profile_hz: dict[str, list[float]] | None
    torque_profile_nm: dict[str, list[float]] | None
    din_grade: int
    wheels_seed: int | None
    bearing_stiffness_n_per_m: float
    wheel_rotational_stiffness_nm_per_rad: float
    brake_inertia_kgm2: float
    damping_ratio: float | list[float]
    eccentricity_mm: float
    pinion_shaft: Shaft
    gear_shaft: Shaft
    pinion_inertia: WheelInertia | None
    gear_inertia: WheelInertia | None
    sampling_rate_hz: float
    settle_fraction: float
    settle_tolerance: float
    initial_displacement: list[float] | None
    initial_velocity: list[float] | None

    def __init__(
        self,
        *,
        module_mm: float,
        pinion_teeth: int,
        gear_teeth: int,
        face_width_mm: float,
        pinion_speed_hz: float,
        brake_torque_nm: float,
        fault: Fault | None = None,
        faults: Sequence[Fault] | None = None,
        model: Literal["linear", "published"] | None = None,
        seed: int | None = None,
        pressure_angle_deg: float | None = None,
        material: Material | None = None,
        tip_relief: TipRelief | Literal[False] | None = None,
        crowning_mm: float | None = None,
        points_per_tooth: int | None = None,
        foundation: Mapping[str, Sequence[float]] | None = None,
        speed_fluctuation_hz: float | None = None,
        torque_fluctuation_nm: float | None = None,
        speed_profile_hz: Profile | None = None,
        torque_profile_nm: Profile | None = None,
        din_grade: int | None = None,
        wheels_seed: int | None = None,
        pinion_profile_errors_mm: npt.ArrayLike | None = None,
        gear_profile_errors_mm: npt.ArrayLike | None = None,
        bearing_stiffness_n_per_m: float | None = None,
        wheel_rotational_stiffness_nm_per_rad: float | None = None,
        brake_inertia_kgm2: float | None = None,
        damping_ratio: float | Sequence[float] | None = None,
        eccentricity_mm: float | None = None,
        pinion_shaft: Shaft | None = None,
        gear_shaft: Shaft | None = None,
        pinion_inertia: WheelInertia | None = None,
        gear_inertia: WheelInertia | None = None,
        sampling_rate_hz: float | None = None,
        settle_fraction: float | None = None,
        settle_tolerance: float | None = None,
        initial_displacement: Sequence[float] | None = None,
        initial_velocity: Sequence[float] | None = None,
        **unknown: Any,
    ) -> None:
        arguments = dict(locals())
        for name in ("self", "unknown"):
            del arguments[name]
        for key in unknown:
            check_key(key)
        self._set(_native_of({**arguments, **unknown}))

    def _set(self, native: _core.Scenario) -> None:
        object.__setattr__(self, "_native", native)
        sections = native.sections()
        flat: dict[str, Any] = {}
        for key, section in SECTION_OF_KEY.items():
            keys = sections.get(section, {}) if section else sections
            flat[key] = keys.get(KEY_IN_FILE.get(key, key))
        faults = sections.get("fault", [])
        flat["faults"] = tuple(map(from_section, faults if isinstance(faults, list) else [faults]))
        object.__setattr__(self, "_flat", flat)

    @classmethod
    def _wrap(cls, native: _core.Scenario) -> Scenario:
        scenario = cls.__new__(cls)
        scenario._set(native)
        return scenario

    @classmethod
    def from_toml(cls, text: str) -> Scenario:
        """From the text of a scenario file.

        Parameters
        ----------
        text : str
            As ``meshtone init`` prints one.

        Raises
        ------
        ValueError
            Text that is not TOML, an unknown key, a value that is not allowed: with the line.

        Examples
        --------
        >>> Scenario.from_toml(template("missing-tooth")).fault
        MissingTooth(wheel='gear', tooth=1)
        """
        if "\n" not in text and text.endswith(".toml"):
            raise ValueError(f"'{text}' is the name of a file, not its text: Scenario.from_file reads it")
        return cls._wrap(_core.Scenario.from_toml(text))

    @classmethod
    def from_file(cls, path: str | PathLike[str]) -> Scenario:
        """From a scenario file, and the files that it names.

        Parameters
        ----------
        path : str or path
            The file.

        Raises
        ------
        FileNotFoundError
            There is no such file.
        ValueError
            As :meth:`from_toml`.
        """
        return cls._wrap(_core.Scenario.from_file(path))

    def to_toml(self) -> str:
        """The text of a scenario file, with every key.

        Returns
        -------
        str
            What :meth:`from_toml` reads back exactly.
        """
        return self._native.to_toml()

    def copy(self, **changes: Any) -> Scenario:
        """The same scenario with some keys changed.

        Parameters
        ----------
        **changes
            As the arguments of :class:`Scenario`; ``fault=None`` for a healthy pair, any other key None for its default. ``fault``
            and ``faults`` take the place of all faults that there are.

        Raises
        ------
        ValueError, TypeError
            As :class:`Scenario`.

        Examples
        --------
        >>> from meshtone import examples
        >>> examples.healthy().copy(pinion_speed_hz=25).pinion_speed_hz
        25.0
        """
        for key in changes:
            check_key(key)
        arguments = dict(self._flat)
        if "fault" in changes:
            del arguments["faults"]
        errors = self._native.profile_errors_mm()
        if errors is not None:
            arguments["pinion_profile_errors_mm"], arguments["gear_profile_errors_mm"] = errors
        return Scenario._wrap(_native_of({**arguments, **changes}))

    @property
    def fault(self) -> Fault | None:
        """The damage; None for a healthy pair.

        Raises
        ------
        ValueError
            There are several faults: ``faults`` has them.
        """
        if len(self.faults) > 1:
            raise ValueError(f"there are {len(self.faults)} faults: scenario.faults has them")
        return self.faults[0] if self.faults else None

    @property
    def faults(self) -> tuple[Fault, ...]:
        """All damage; empty for a healthy pair."""
        faults: tuple[Fault, ...] = self._flat["faults"]
        return faults

    @property
    def pinion_profile_errors_mm(self) -> npt.NDArray[np.float64] | None:
        """(mm) The pinion's profile errors, where they were given: 100 rows, a column a tooth."""
        errors = self._native.profile_errors_mm()
        return None if errors is None else errors[0]

    @property
    def gear_profile_errors_mm(self) -> npt.NDArray[np.float64] | None:
        """(mm) The gear's profile errors, where they were given: 100 rows, a column a tooth."""
        errors = self._native.profile_errors_mm()
        return None if errors is None else errors[1]

    @property
    def warnings(self) -> list[str]:
        """What is doubtful about the scenario, though it can be simulated."""
        return self._native.warnings()

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self._flat[name]
        except KeyError:
            if name in FORMER_KEYS:
                raise AttributeError(f"'{name}' {FORMER_KEYS[name]}") from None
            known = [*SECTION_OF_KEY, *OTHER_ARGUMENTS]
            raise AttributeError(f"a scenario has no key '{name}'{hint(name, known)}") from None

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"a scenario does not change: scenario.copy({name}={value!r}) gives another one")

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *SECTION_OF_KEY})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scenario) and bool(self._native == other._native)

    def __hash__(self) -> int:
        return hash(self.to_toml())

    def __reduce__(self) -> tuple[Any, tuple[str]]:
        return (Scenario.from_toml, (self.to_toml(),))

    def __repr__(self) -> str:
        required = {
            key: self._flat[key]
            for key in (
                "module_mm",
                "pinion_teeth",
                "gear_teeth",
                "face_width_mm",
                "pinion_speed_hz",
                "brake_torque_nm",
            )
        }
        default = _core.Scenario(_sections_of(required)).sections()
        shown = dict(required)
        for key, section in SECTION_OF_KEY.items():
            keys = default.get(section, {}) if section else default
            if key not in shown and self._flat[key] != keys.get(KEY_IN_FILE.get(key, key)):
                shown[key] = self._flat[key]
        if len(self.faults) == 1:
            shown["fault"] = self.faults[0]
        elif self.faults:
            shown["faults"] = list(self.faults)
        text = ", ".join(f"{key}={value!r}" for key, value in shown.items())
        if self._native.profile_errors_mm() is not None:
            text += ", pinion_profile_errors_mm=..., gear_profile_errors_mm=..."
        return f"Scenario({text})"


def _plain(value: Any) -> Any:
    """NumPy's numbers and arrays as Python's own."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    return value


def native_scenario(scenario: Scenario) -> _core.Scenario:
    """The compiled module's scenario."""
    if not isinstance(scenario, Scenario):
        raise TypeError(f"a Scenario is needed, not {scenario!r}; Scenario.from_file reads one from a file")
    return scenario._native


def _sections_of(arguments: Mapping[str, Any]) -> dict[str, Any]:
    sections: dict[str, Any] = {}
    for key, value in arguments.items():
        if value is None or key in OTHER_ARGUMENTS:
            continue
        section = SECTION_OF_KEY[key]
        keys = sections.setdefault(section, {}) if section else sections
        keys[KEY_IN_FILE.get(key, key)] = plain = _plain(value)
        if isinstance(plain, int) and abs(plain) >= 2**63:
            raise ValueError(f"{key} = {value}: must be below 2**63 = {2**63}")
    faults = [_plain(to_section(fault)) for fault in _faults_of(arguments)]
    if faults:
        sections["fault"] = faults[0] if len(faults) == 1 else faults
    return sections


def _faults_of(arguments: Mapping[str, Any]) -> Sequence[Any]:
    """The faults, whichever of the two arguments has them."""
    fault, faults = arguments.get("fault"), arguments.get("faults")
    if fault is not None and faults is not None:
        raise TypeError("fault and faults are both given: faults has all of them, fault is one alone")
    if isinstance(fault, (list, tuple)):
        raise TypeError("fault is a sequence: faults takes several")
    if fault is not None:
        return [fault]
    if faults is None:
        return []
    if not isinstance(faults, Sequence) or isinstance(faults, str):
        raise TypeError(f"faults = {faults!r}: must be a sequence of faults; fault takes a single one")
    return faults


def _native_of(arguments: Mapping[str, Any]) -> _core.Scenario:
    errors = [arguments.get(f"{wheel}_profile_errors_mm") for wheel in ("pinion", "gear")]
    pinion, gear = (None if error is None else np.asarray(error, dtype=np.float64) for error in errors)
    for wheel, error in (("pinion", pinion), ("gear", gear)):
        if error is not None and error.ndim != 2:
            raise ValueError(f"{wheel}_profile_errors_mm has shape {error.shape}: must be (100, teeth), a column a tooth")
    return _core.Scenario(_sections_of(arguments), pinion, gear)


def template(kind: str) -> str:
    """A commented scenario file to start from.

    Parameters
    ----------
    kind : str
        'healthy', or a kind of fault: 'missing-tooth', 'tooth-breakage', 'partial-face', 'through-face', 'tooth-destruction'.

    Returns
    -------
    str
        The file's text.

    Raises
    ------
    ValueError
        Another kind.

    Examples
    --------
    >>> print(template("healthy").splitlines()[0])
    # A Meshtone scenario: a pair of spur gears, how it is driven, and what is broken.
    """
    return _core.template(kind)
