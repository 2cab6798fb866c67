"""Gearboxes: several meshes on common shafts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal, Union

import numpy as np
import numpy.typing as npt

from . import _core, _progress
from ._gearbox_keys import (
    GearboxBearing,
    GearboxHousing,
    GearboxMesh,
    GearboxOperation,
    GearboxSensor,
    GearboxShaft,
    GearboxSolver,
    GearboxWheel,
)
from ._scenario_text import ScenarioText
from ._warnings import warn

if TYPE_CHECKING:
    from .signal.train import TrainRecord

__all__ = ["Gearbox", "GearboxSimulation", "gearbox_template", "simulate_gearbox", "simulate_gearboxes"]

_Table = Mapping[str, Any]


class Gearbox(ScenarioText):
    """Everything that the simulation of a gearbox depends on.

    Each list has a dictionary for an entry, with the keys of that section of the scenario file, its names, units and defaults: the guide's
    chapter "Gearboxes" lists them. A gearbox does not change.

    Parameters
    ----------
    shafts : sequence of dict
        ``name``, ``length_mm``, ``radius_mm`` and so on of each; one couples to the motor, one to the brake.
    wheels : sequence of dict
        ``name``, ``shaft``, ``at``, ``teeth``, ``face_width_mm`` and so on of each.
    meshes : sequence of dict
        ``wheels``, the names of the driving and of the driven one, ``module_mm`` and so on of each.
    bearings : sequence of dict
        ``shaft``, ``at`` and so on of each.
    operation : dict
        ``input_speed_hz``, ``brake_torque_nm`` and so on.
    housing : dict, optional
        ``mass_kg`` and so on; ``{}`` for a housing with the defaults. Without it the bearings' seats stand on the ground.
    faults : sequence of dict, optional
        ``wheel``, ``kind`` and the sizes or the ``severity`` of each.
    sensors : sequence of dict, optional
        ``at``, ``direction`` and so on of each. Without one, a vertical one sits on every bearing's seat.
    solver : dict, optional
        ``sampling_rate_hz``, ``duration_s`` and so on.
    material : str or dict, optional
        Material of shafts and wheels: a name, or ``youngs_modulus_gpa``, ``poisson_ratio`` and ``density_kg_per_m3``.
    seed : int, optional
        Of every random draw.

    Raises
    ------
    ValueError
        A key that there is not, a value that is not allowed, parts that do not fit one another.

    Examples
    --------
    >>> from meshtone import Gearbox
    >>> gearbox = Gearbox(
    ...     shafts=[{"name": "input", "length_mm": 200, "radius_mm": 10, "couples_to": "motor"},
    ...             {"name": "output", "length_mm": 200, "radius_mm": 10, "couples_to": "brake"}],
    ...     wheels=[{"name": "z1", "shaft": "input", "at": 0.5, "teeth": 17, "face_width_mm": 15},
    ...             {"name": "z2", "shaft": "output", "at": 0.5, "teeth": 38, "face_width_mm": 15}],
    ...     meshes=[{"wheels": ["z1", "z2"], "module_mm": 3}],
    ...     bearings=[{"shaft": shaft, "at": at} for shaft in ("input", "output") for at in (0.0, 1.0)],
    ...     operation={"input_speed_hz": 40, "brake_torque_nm": 10},
    ... )
    >>> gearbox
    <Gearbox of 2 shafts and meshes z1-z2>
    >>> gearbox.sections["mesh"][0]["pressure_angle_deg"]
    20.0
    """

    __slots__ = ("_native", "_sections")

    _is_pair = False
    _native: _core.Scenario
    _sections: dict[str, Any]

    def __init__(
        self,
        *,
        shafts: Sequence[GearboxShaft],
        wheels: Sequence[GearboxWheel],
        meshes: Sequence[GearboxMesh],
        bearings: Sequence[GearboxBearing],
        operation: GearboxOperation,
        housing: GearboxHousing | None = None,
        faults: Sequence[_Table] = (),
        sensors: Sequence[GearboxSensor] = (),
        solver: GearboxSolver | None = None,
        material: str | _Table = "steel",
        seed: int = 1,
    ) -> None:
        sections: dict[str, Any] = {"seed": seed, "material": _plain(material), "operation": _plain(operation)}
        lists: dict[str, Any] = {"shaft": shafts, "wheel": wheels, "mesh": meshes, "bearing": bearings, "fault": faults, "sensor": sensors}
        for name, entries in lists.items():
            if isinstance(entries, (str, Mapping)) or not isinstance(entries, Sequence):
                raise TypeError(f"{name}: {entries!r} must be a sequence of dictionaries")
            if entries:
                sections[name] = [_plain(entry) for entry in entries]
        tables: dict[str, Any] = {"housing": housing, "solver": solver}
        sections.update({name: _plain(table) for name, table in tables.items() if table is not None})
        self._set(_core.Scenario(sections))

    def _set(self, native: _core.Scenario) -> None:
        self._native = native
        self._sections = native.sections()

    @property
    def sections(self) -> dict[str, Any]:
        """The sections with all their keys, defaults included: a copy."""
        return self._native.sections()

    @property
    def warnings(self) -> list[str]:
        """Warnings about a gearbox that can be simulated."""
        return self._native.warnings()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Gearbox) and self._native == other._native

    def __hash__(self) -> int:
        return hash(self.to_toml())

    def __repr__(self) -> str:
        meshes = ", ".join("-".join(mesh["wheels"]) for mesh in self._sections["mesh"])
        return f"<Gearbox of {len(self._sections['shaft'])} shafts and meshes {meshes}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return (Gearbox.from_toml, (self.to_toml(),))


class GearboxSimulation:
    """A simulation of a gearbox: its signals, and what every stage found.

    Attributes
    ----------
    gearbox : Gearbox
        What was simulated.
    channels : dict of str to array of float64, shape (samples,)
        Sensors first (``NAME_g``), then ``force_n.MESH`` and ``transmission_error_um.MESH`` of each mesh and ``speed_hz.SHAFT`` of each
        shaft.
    sampling_rate_hz : float
        (S/s) Of all signals.
    start_s : float
        (s) Time of the first kept sample since the start of the simulation.
    warnings : list of str
        What deserves attention.
    """

    def __init__(self, gearbox: Gearbox, native: _core.GearboxSimulation) -> None:
        self.gearbox = gearbox
        self.channels: dict[str, npt.NDArray[np.float64]] = native.channels
        self.sampling_rate_hz = native.sampling_rate_hz
        self.start_s = native.start_s
        self.warnings = native.warnings
        self._native = native

    def __getitem__(self, name: str) -> npt.NDArray[np.float64]:
        if name not in self.channels:
            raise KeyError(f"there is no channel {name!r}; there are {', '.join(self.channels)}")
        return self.channels[name]

    @property
    def time_s(self) -> npt.NDArray[np.float64]:
        """(s) Time of each sample since the start of the simulation."""
        samples = len(next(iter(self.channels.values())))
        return self.start_s + np.arange(samples) / self.sampling_rate_hz

    @property
    def scenario(self) -> Gearbox:
        """What was simulated: :attr:`gearbox`, by the name that a simulation of a pair has for it."""
        return self.gearbox

    @property
    def warning_codes(self) -> list[str]:
        """What each of :attr:`warnings` is about, for programs to distinguish."""
        return self._native.warning_codes

    def process(self, channel: str | None = None, *, sidebands: int | None = None) -> TrainRecord:
        """Take one of the signals to the averages and indicators of every wheel.

        Parameters
        ----------
        channel : str, optional
            One of the channels; the first sensor's by default.
        sidebands : int, optional
            Sidebands on either side of each mesh harmonic that belong to the regular part.

        Returns
        -------
        TrainRecord

        Raises
        ------
        KeyError
            A channel that there is not.
        ValueError
            As :func:`~meshtone.signal.process_train`.

        Examples
        --------
        >>> from meshtone import Gearbox, gearbox_template, simulate_gearbox
        >>> record = simulate_gearbox(Gearbox.from_toml(gearbox_template())).process()
        >>> record.shafts
        {'z1': 'input', 'z2': 'middle', 'z3': 'middle', 'z4': 'output'}
        >>> record["z3"].revolutions
        9
        """
        # They need a gearbox themselves.
        from .signal.train import train_record

        name = next(iter(self.channels)) if channel is None else channel
        values = self[name]
        phase = _core.ShaftPhase.of_simulated_input(self.gearbox._native, self.start_s, values.size)
        parts = _core.process_train(values, phase, self.gearbox._native, self.sampling_rate_hz, None, sidebands)
        return train_record(parts, name)

    def save(self, path: str | PathLike[str]) -> None:
        """Write the signals; the file's ending says the format, as of :meth:`Simulation.save`.

        Parameters
        ----------
        path : path-like
            The file. In a MAT-file the names of the signals have an underscore in place of what MATLAB does not accept:
            ``force_n_z1_z2``.

        Raises
        ------
        ValueError, OSError
            As :meth:`Simulation.save`.
        """
        self._native.save(path)

    def summary(self) -> dict[str, Any]:
        """What ``meshtone simulate`` writes to ``summary.json``.

        Examples
        --------
        >>> from meshtone import Gearbox, gearbox_template, simulate_gearbox
        >>> gearbox = Gearbox.from_toml(gearbox_template("uconn"))
        >>> [mesh["wheels"] for mesh in simulate_gearbox(gearbox).summary()["meshes"]]
        [['z1', 'z2'], ['z3', 'z4']]
        """
        return self._native.summary()

    def trace(self) -> dict[str, Any]:
        """Every stage's output by name, for checking number by number: what ``meshtone simulate --trace`` writes."""
        return self._native.trace()

    def natural_frequencies_hz(self, mesh_stiffness_n_per_m: Sequence[float] | None = None) -> npt.NDArray[np.float64]:
        """(Hz) Natural frequencies with the meshes closed, rising.

        Parameters
        ----------
        mesh_stiffness_n_per_m : sequence of float, optional
            (N/m) Of each mesh; its mean stiffness by default.
        """
        given = None if mesh_stiffness_n_per_m is None else [float(value) for value in mesh_stiffness_n_per_m]
        return np.asarray(self._native.natural_frequencies_hz(given))

    def __repr__(self) -> str:
        meshes = ", ".join("-".join(mesh["wheels"]) for mesh in self.gearbox._sections["mesh"])
        samples = len(next(iter(self.channels.values())))
        return f"<Simulation of a gearbox, {meshes}: {samples} samples at {self.sampling_rate_hz:.0f} S/s>"


def simulate_gearbox(gearbox: Gearbox) -> GearboxSimulation:
    """Simulate a gearbox. Each doubt about it is a :class:`~meshtone.MeshtoneWarning`.

    Parameters
    ----------
    gearbox : Gearbox
        What is simulated.

    Returns
    -------
    GearboxSimulation

    Raises
    ------
    ValueError
        A fault that does not fit the tooth, a solution that grows without bound.

    Examples
    --------
    >>> from meshtone import Gearbox, gearbox_template, simulate_gearbox
    >>> simulation = simulate_gearbox(Gearbox.from_toml(gearbox_template("tecnalia")))
    >>> simulation
    <Simulation of a gearbox, z1-z2, z3-z4: 20490 samples at 20490 S/s>
    >>> list(simulation.channels)[:3]
    ['input_0_vertical_g', 'output_1_vertical_g', 'force_n.z1-z2']
    """
    simulation = GearboxSimulation(gearbox, _core.simulate_gearbox(_checked(gearbox, "gearbox")))
    warn(simulation.warnings, simulation._native.warning_codes)
    return simulation


def simulate_gearboxes(
    gearboxes: Iterable[Gearbox],
    *,
    on_error: Literal["raise", "return"] = "raise",
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] = False,
) -> list[Any]:
    """Simulate many gearboxes, in all cores. None is simulated a second time with half the step, as :func:`simulate_gearbox` does where the
    step is doubtful: the estimate of its error decides alone, whatever the number of gearboxes.

    Parameters
    ----------
    gearboxes : iterable of Gearbox
        What is simulated.
    on_error : {'raise', 'return'}
        What becomes of the error of a gearbox that cannot be simulated: it is raised, and what has not begun is not simulated any more; or it
        stands in the place of the simulation.
    threads : int, optional
        How many; all cores by default. Results do not depend on it.
    progress : bool or callable, optional
        True for a line on the terminal or a bar in a notebook; or called with the numbers of those that are finished and of all.

    Returns
    -------
    list of GearboxSimulation, or with ``on_error="return"`` of GearboxSimulation and ValueError
        In the order of the gearboxes; results do not depend on the number of threads.

    Raises
    ------
    ValueError
        As :func:`simulate_gearbox`.
    TypeError
        Something that is no gearbox.
    KeyboardInterrupt
        Ctrl-C stops the simulations.
    """
    gearboxes = list(gearboxes)
    # It is in a package that needs a gearbox itself.
    from .signal._arguments import whole

    native = [_checked(gearbox, f"gearboxes[{index}]") for index, gearbox in enumerate(gearboxes)]
    ask = _progress.shown("simulations") if progress is True else (progress or None)
    most = None if threads is None else whole("threads", threads, 1)
    results = _core.simulate_gearboxes(native, most, on_error == "raise", ask)
    made: list[Union[GearboxSimulation, ValueError]] = []
    for gearbox, result in zip(gearboxes, results):
        if isinstance(result, Exception):
            if on_error == "raise":
                raise result
            made.append(result)  # type: ignore[arg-type]
        else:
            made.append(GearboxSimulation(gearbox, result))
    return made


def _checked(gearbox: Gearbox, name: str) -> _core.Scenario:
    """The gearbox as the compiled module has it."""
    if not isinstance(gearbox, Gearbox):
        raise TypeError(f"{name} = {gearbox!r}: must be a Gearbox")
    return gearbox._native


def gearbox_template(rig: Literal["phm2009-spur", "phm2009-helical", "uconn", "tecnalia"] | None = None) -> str:
    """A commented gearbox to start from, as a scenario file.

    Parameters
    ----------
    rig : {'phm2009-spur', 'phm2009-helical', 'uconn', 'tecnalia'}, optional
        A rig of which what is published stands in the file, with what has to be assumed marked so; an example by default.
    """
    return _core.gearbox_template(rig)


def _plain(value: Any) -> Any:
    """Numbers of numpy, tuples and mappings as TOML has them."""
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items() if entry is not None}
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    return value
