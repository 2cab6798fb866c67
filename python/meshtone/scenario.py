"""What is simulated."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core, _display
from ._keys import KEY_IN_FILE, REQUIRED_KEYS, SECTION_OF_KEY, ScenarioChanges, ScenarioKeys, Shaft, WheelInertia
from ._names import hint
from ._sections import OTHER_ARGUMENTS, check_key, with_whole_numbers
from .faults import Fault, from_section, to_section
from .sensors import Sensor, sections_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["Scenario", "Shaft", "WheelInertia", "template"]


class Scenario(ScenarioKeys):
    """Everything that one simulation depends on: a pair in a rig, or, as :func:`~meshtone.Gearbox` makes it, any number of wheels on shafts.

    The arguments are the keys of the scenario file of a pair, with its names, units and defaults: ``help(Scenario.__init__)`` lists them. A
    scenario does not change: :meth:`copy` gives another one.

    Examples
    --------
    >>> scenario = Scenario(module_mm=3, pinion_teeth=17, gear_teeth=38, face_width_mm=15,
    ...                     pinion_speed_hz=40, brake_torque_nm=10, din_grade=7)
    >>> scenario
    Scenario(module_mm=3.0, pinion_teeth=17, gear_teeth=38, face_width_mm=15.0, brake_torque_nm=10.0, \
pinion_speed_hz=40.0, din_grade=7)
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

    if not TYPE_CHECKING:  # the arguments are those of the base class

        @functools.wraps(ScenarioKeys.__init__)
        def __init__(self, *values: Any, **arguments: Any) -> None:
            if values:
                raise TypeError(f"{values[0]!r}: a scenario takes its keys by name, Scenario(module_mm=3, …); Scenario.from_file reads a file")
            # Before Python says what is missing: a misspelt key is why.
            for key, value in arguments.items():
                check_key(key, value)
            super().__init__(**arguments)

    @classmethod
    def _wrap(cls, native: _core.Scenario) -> Scenario:
        scenario = cls.__new__(cls)
        scenario._set(native)
        return scenario

    @classmethod
    def from_toml(cls, text: str) -> Scenario:
        """From the text of a scenario file, of a pair or of a gearbox.

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
        >>> from meshtone import Scenario, gearbox_template, template
        >>> Scenario.from_toml(template("missing-tooth")).fault
        MissingTooth(wheel='gear', tooth=1, severity=None, flank=None)
        >>> Scenario.from_toml(gearbox_template("phm2009-spur"))
        <Gearbox of 3 shafts and meshes z1-z2, z3-z4>
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

    @property
    def sections(self) -> dict[str, Any]:
        """The sections of the scenario file with all their keys, defaults included: a copy; of a pair without profile errors."""
        return self._native.sections()

    def _from_keys(self, arguments: dict[str, Any], unknown: dict[str, Any]) -> None:
        self._set(_native_of({**arguments, **unknown}))

    def _set(self, native: _core.Scenario) -> None:
        object.__setattr__(self, "_native", native)
        sections = native.sections()
        flat: dict[str, Any] = {}
        for key, section in SECTION_OF_KEY.items():
            keys, name = sections.get(section, {}) if section else sections, KEY_IN_FILE.get(key, key)
            if native.is_pair or name in keys:
                flat[key] = keys.get(name)
        faults = sections.get("fault", [])
        flat["faults"] = tuple(map(from_section, faults if isinstance(faults, list) else [faults]))
        sensors = sections.get("sensor", [])
        flat["sensors"] = tuple(Sensor(**keys) for keys in (sensors if isinstance(sensors, list) else [sensors]))
        object.__setattr__(self, "_flat", flat)

    def copy(self, **changes: Unpack[ScenarioChanges]) -> Scenario:
        """The same scenario with some keys changed.

        Parameters
        ----------
        **changes
            As the arguments of :class:`Scenario`, or of :func:`~meshtone.Gearbox` where one made it; ``fault=None`` for healthy wheels, any
            other key None for its default. ``fault`` and ``faults`` take the place of all faults that there are, ``sensors`` that of all
            sensors, and so do the other lists of a gearbox; of its ``operation``, ``housing`` and ``solver`` the given keys change.

        Raises
        ------
        ValueError, TypeError
            As :class:`Scenario`.

        Examples
        --------
        >>> from meshtone import MissingTooth, Scenario, examples, gearbox_template
        >>> examples.healthy().copy(pinion_speed_hz=25).pinion_speed_hz
        25.0
        >>> gearbox = Scenario.from_toml(gearbox_template())
        >>> gearbox.copy(fault=MissingTooth(wheel="z3"), solver={"duration_s": 0.5}).fault
        MissingTooth(wheel='z3', tooth=1, severity=None, flank=None)
        """
        if not self._native.is_pair:
            return Scenario._wrap(gearbox_of(dict(changes), self.sections))
        for key, value in changes.items():
            check_key(key, value)
        arguments = dict(self._flat)
        if "fault" in changes:
            del arguments["faults"]
        for key in {"flank_relief", "tip_chamfer_mm"} & changes.keys():
            # That of both wheels takes the place of their own.
            arguments.pop(f"pinion_{key}", None)
            arguments.pop(f"gear_{key}", None)
        errors = self._native.profile_errors_mm()
        if errors is not None:
            arguments["pinion_profile_errors_mm"], arguments["gear_profile_errors_mm"] = errors
        return Scenario._wrap(_native_of({**arguments, **changes}))

    @property
    def fault(self) -> Fault | None:
        """The damage; None for healthy wheels.

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
        """All damage; empty for healthy wheels. A fault of a rolling bearing is the dictionary of its keys."""
        faults: tuple[Fault, ...] = self._flat["faults"]
        return faults

    @property
    def fault_severities(self) -> list[float]:
        """(-) How severe each of :attr:`faults` is, from 0, none, to 1, the largest that the tooth allows.

        It is what was given, or follows from the sizes; the guide's chapter on faults has each kind's scale. They are in the
        order of :attr:`faults` of this scenario; :meth:`with_own_sizes` may have fewer.

        >>> from meshtone.faults import ToothBreakage
        >>> chipped = Scenario(module_mm=3, pinion_teeth=17, gear_teeth=38, face_width_mm=15, pinion_speed_hz=40,
        ...                    brake_torque_nm=10, fault=ToothBreakage(chip_height_mm=5, chip_width_mm=12))
        >>> [round(severity, 2) for severity in chipped.fault_severities]
        [0.4]
        """
        return self._native.fault_severities()

    def with_own_sizes(self) -> Scenario:
        """The same scenario with the sizes of every fault that was given by its severity.

        A fault of severity 0, or one that is smaller than the tooth profile's points can show, is left out.

        >>> from meshtone.faults import RootCrack
        >>> cracked = Scenario(module_mm=3, pinion_teeth=17, gear_teeth=38, face_width_mm=15, pinion_speed_hz=40,
        ...                    brake_torque_nm=10, fault=RootCrack(severity=0.5))
        >>> cracked.with_own_sizes().fault  # doctest: +ELLIPSIS
        RootCrack(depth_mm=2.128..., angle_deg=45.0, length_mm=None, wheel='gear', tooth=1, severity=None, flank=None)
        """
        return Scenario._wrap(self._native.with_own_sizes())

    @property
    def sensors(self) -> tuple[Sensor, ...]:
        """The listed sensors; empty where there are none."""
        sensors: tuple[Sensor, ...] = self._flat["sensors"]
        return sensors

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of its simulation's channels: ``NAME_g`` of each sensor, then those of :data:`meshtone.CHANNELS`, or of a gearbox
        ``force_n.MESH`` and ``transmission_error_um.MESH`` of each mesh and ``speed_hz.SHAFT`` of each shaft."""
        return tuple(self._native.channels())

    @property
    def pinion_profile_errors_mm(self) -> npt.NDArray[np.float64] | None:
        """(mm) The pinion's profile errors, where they were given: 100 rows, a column a tooth."""
        return self._profile_errors(0, "pinion_profile_errors_mm")

    @property
    def gear_profile_errors_mm(self) -> npt.NDArray[np.float64] | None:
        """(mm) The gear's profile errors, where they were given: 100 rows, a column a tooth."""
        return self._profile_errors(1, "gear_profile_errors_mm")

    def _profile_errors(self, wheel: int, key: str) -> npt.NDArray[np.float64] | None:
        if not self._native.is_pair:
            raise AttributeError(key)
        errors = self._native.profile_errors_mm()
        return None if errors is None else errors[wheel]

    @property
    def warnings(self) -> list[str]:
        """Warnings about a scenario that can be simulated, as far as they can be known before simulating.

        These are what ``meshtone simulate`` prints before it simulates; :attr:`Simulation.warnings` has the others too.

        Raises
        ------
        ValueError
            A fault that does not fit the tooth.
        """
        return self._native.warnings()

    if not TYPE_CHECKING:  # a key that there is not is an error of types, too

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_"):
                raise AttributeError(name)
            try:
                return self._flat[name]
            except KeyError:
                known = [*SECTION_OF_KEY, *OTHER_ARGUMENTS]
                if name in known and not self._native.is_pair:
                    raise AttributeError(f"a gearbox has no key '{name}': scenario.sections has those of its shafts, wheels and meshes") from None
                way = f"; {_OTHER_WAYS[name]}" if name in _OTHER_WAYS else hint(name, known)
                raise AttributeError(f"a scenario has no key '{name}'{way}") from None

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

    def _not_default(self) -> dict[str, Any]:
        """The arguments that make this scenario, without those that are at their defaults."""
        required = {key: self._flat[key] for key in (*REQUIRED_KEYS, "pinion_speed_hz")}
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
        if self.sensors:
            shown["sensors"] = list(self.sensors)
        return shown

    def _repr_html_(self) -> str:
        if self._native.is_pair:
            return _display.page("Scenario", _display.table(self._not_default()))
        rows = [(section, entry) for section, entries in self.sections.items() for entry in (entries if isinstance(entries, list) else [entries])]
        return _display.page("Gearbox", _display.table(rows))

    def __repr__(self) -> str:
        if not self._native.is_pair:
            meshes = ", ".join(name for name, _ in self._native.meshes())
            return f"<Gearbox of {len(self.sections['shaft'])} shafts and meshes {meshes}>"
        text = ", ".join(f"{key}={value!r}" for key, value in self._not_default().items())
        if self._native.profile_errors_mm() is not None:
            text += ", pinion_profile_errors_mm=..., gear_profile_errors_mm=..."
        return f"Scenario({text})"


_WRITES = "open('scenario.toml', 'w').write(scenario.to_toml()) writes its file"
_SIMULATED = "what shows vibration is its simulation, meshtone.simulate(scenario)"
_OTHER_WAYS = {
    **dict.fromkeys(("save", "write", "to_file", "dump"), _WRITES),
    **dict.fromkeys(("load", "read", "open"), "Scenario.from_file reads a file"),
    **dict.fromkeys(("simulate", "run"), "meshtone.simulate(scenario) simulates it"),
    **dict.fromkeys(("process", "signals", "plot", "vertical_g", "indicators"), _SIMULATED),
}
"""What is tried on a scenario, and how it is done."""


def _signature_of_copy() -> inspect.Signature:
    """The keys of its argument ``**changes``, for those who complete names or ask for help at run time; ``...`` leaves one as it is."""
    given = inspect.signature(ScenarioKeys.__init__).parameters.values()
    keys = [parameter.replace(default=...) for parameter in given if parameter.kind is inspect.Parameter.KEYWORD_ONLY]
    return inspect.Signature([inspect.Parameter("self", inspect.Parameter.POSITIONAL_OR_KEYWORD), *keys], return_annotation="Scenario")


vars(Scenario)["copy"].__signature__ = _signature_of_copy()

# The generated base class is no name that a user knows: what is missing is missing in a call of Scenario.
ScenarioKeys.__init__.__qualname__ = "Scenario"


def _plain(value: Any) -> Any:
    """NumPy's numbers and arrays as Python's own; keys that are None are left out."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items() if entry is not None}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    return value


def native_scenario(scenario: Scenario) -> _core.Scenario:
    """The compiled module's scenario."""
    if not isinstance(scenario, Scenario):
        several = "; simulate_many takes several" if isinstance(scenario, (list, tuple)) else ""
        raise TypeError(f"a Scenario is needed, not {scenario!r}; Scenario.from_file reads one from a file{several}")
    return scenario._native


def _sections_of(arguments: Mapping[str, Any]) -> dict[str, Any]:
    sections: dict[str, Any] = {}
    given = {key: _plain(value) for key, value in arguments.items() if value is not None and key not in OTHER_ARGUMENTS}
    for key, value in with_whole_numbers(given, ScenarioKeys.__annotations__).items():
        section = SECTION_OF_KEY[key]
        keys = sections.setdefault(section, {}) if section else sections
        keys[KEY_IN_FILE.get(key, key)] = value
        if isinstance(value, int) and abs(value) >= 2**63:
            raise ValueError(f"{key} = {value}: must be below 2**63 = {2**63}")
    faults = [_fault_section(name, fault) for name, fault in _faults_of(arguments)]
    if faults:
        sections["fault"] = faults[0] if len(faults) == 1 else faults
    sensors = [with_whole_numbers(_plain(section), Sensor.__annotations__) for section in sections_of(arguments.get("sensors"))]
    if sensors:
        sections["sensor"] = sensors[0] if len(sensors) == 1 else sensors
    return sections


GEARBOX_LISTS = {"shafts": "shaft", "wheels": "wheel", "meshes": "mesh", "planetary": "planetary", "bearings": "bearing"}
"""The arguments that are the lists of a gearbox, with the names of their sections."""
GEARBOX_TABLES = ("operation", "housing", "solver")
"""The arguments that are its tables."""


def gearbox_of(arguments: Mapping[str, Any], sections: dict[str, Any]) -> _core.Scenario:
    """A gearbox of some sections and of arguments that change them.

    Parameters
    ----------
    arguments : mapping
        Those of ``Gearbox``; None is the default.
    sections : dict
        Where they stand; it is changed.
    """
    for name, value in arguments.items():
        if name in GEARBOX_LISTS:
            if isinstance(value, (str, Mapping)) or not isinstance(value, Sequence):
                raise TypeError(f"{name}: {value!r} must be a sequence of dictionaries")
            sections[GEARBOX_LISTS[name]] = [_plain(entry) for entry in value]
        elif name in GEARBOX_TABLES:
            changed = None if value is None else _plain({**sections.get(name, {}), **value})
            sections.pop(name, None)
            sections.update({} if changed is None else {name: changed})
        elif name in ("material", "seed", "wheels_seed"):
            sections.pop(name, None)
            sections.update({} if value is None else {name: _plain(value)})
        elif name not in ("fault", "faults", "sensors"):
            known = [*GEARBOX_LISTS, *GEARBOX_TABLES, "faults", "sensors", "material", "seed", "wheels_seed"]
            raise TypeError(f"a gearbox has no argument '{name}'{hint(name, known) or '; it has ' + ', '.join(known)}")
    if "fault" in arguments or "faults" in arguments:
        sections["fault"] = [_fault_section(name, fault) for name, fault in _faults_of(arguments)]
    if "sensors" in arguments:
        given = arguments["sensors"] or ()
        sections["sensor"] = [_plain(one) if isinstance(one, Mapping) else _plain(sections_of([one])[0]) for one in given]
    # What is left out is at its default: a file states no empty lists of these.
    optional = {name: sections.pop(name) for name in ("fault", "sensor", "planetary", "wheel", "mesh") if name in sections}
    return _core.Scenario({**sections, **{name: entries for name, entries in optional.items() if entries}})


def _fault_section(name: str, fault: Any) -> dict[str, Any]:
    """The section of a fault: an object, or the dictionary of its keys."""
    if isinstance(fault, Mapping):
        section: dict[str, Any] = _plain(fault)
        return section
    return with_whole_numbers(_plain(to_section(fault, name)), type(fault).__annotations__)


def _faults_of(arguments: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """The faults, whichever of the two arguments has them, each with its name in messages."""
    fault, faults = arguments.get("fault"), arguments.get("faults")
    if fault is not None and faults is not None:
        raise TypeError("fault and faults are both given: faults has all of them, fault is one alone")
    if isinstance(fault, (list, tuple)):
        raise TypeError("fault is a sequence: faults takes several")
    if fault is not None:
        return [("fault", fault)]
    if faults is None:
        return []
    if not isinstance(faults, Sequence) or isinstance(faults, str):
        raise TypeError(f"faults = {faults!r}: must be a sequence of faults; fault takes a single one")
    return [(f"faults[{index}]", fault) for index, fault in enumerate(faults)]


def _native_of(arguments: Mapping[str, Any]) -> _core.Scenario:
    errors = [arguments.get(f"{wheel}_profile_errors_mm") for wheel in ("pinion", "gear")]
    pinion, gear = (None if error is None else np.asarray(error, dtype=np.float64) for error in errors)
    for wheel, error in (("pinion", pinion), ("gear", gear)):
        if error is not None and error.ndim != 2:
            raise ValueError(f"{wheel}_profile_errors_mm has shape {error.shape}: must be (100, teeth), a column a tooth")
    return _core.Scenario(_sections_of(arguments), pinion, gear)


def template(kind: str, *, all_keys: bool = False) -> str:
    """A commented scenario file to start from.

    Parameters
    ----------
    kind : str
        'healthy', 'helical', or a kind of fault: 'missing-tooth', 'tooth-breakage', 'root-crack', 'partial-face', 'through-face', 'pits',
        'tooth-destruction', 'wear'.
    all_keys : bool
        Whether every key stands in it, with its unit, meaning and default, instead of those that matter.

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
    # A Meshtone scenario: a pair of gears, its operation, and its damage.
    """
    return _core.template(kind, all_keys)
