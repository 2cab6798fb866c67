"""One simulation, or many."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Union, overload

import numpy as np
import numpy.typing as npt

from . import _core, _display, _progress
from ._extras import extra
from ._names import hint
from ._warnings import typed, warn, warn_of_signal
from .faults import in_words
from .scenario import Scenario, native_scenario
from .signal import Record, resample
from .signal.indicators import INDICATORS
from .signal._arguments import positive, read_only, regular_part, whole
from .signal.train import TrainRecord, train_record

if TYPE_CHECKING:
    import pandas
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["CHANNELS", "ContactFigures", "Signals", "Simulation", "StaticMesh", "simulate", "simulate_many", "trace"]

Array = npt.NDArray[np.float64]

CHANNELS = ("horizontal_g", "vertical_g", "axial_g", "pinion_shaft_speed_hz", "gear_shaft_speed_hz", "mesh_force_n")
"""The signals of every pair, with their units; those of listed sensors come before them in ``scenario.channels``."""


@dataclass(frozen=True)
class ContactFigures:
    """How the teeth of a mesh touched over the kept time.

    Attributes
    ----------
    apart_fraction : float
        Part of the time in which no teeth touched.
    back_flank_fraction : float
        Part of the time in which coast flanks touched.
    back_flank_hits : int
        How often coast flanks hit.
    largest_force_n : float
        (N) Largest force, of either sign.
    """

    apart_fraction: float
    back_flank_fraction: float
    back_flank_hits: int
    largest_force_n: float


@dataclass(frozen=True)
class StaticMesh:
    """A mesh at rest under a force.

    Attributes
    ----------
    pitch : array, shape (points,)
        Pitches since the start of the simulation.
    transmission_error_um : array, shape (points,)
        (µm) Deflection along the line of action, the static transmission error; NaN where no pair can touch.
    pairs : array of int, shape (pairs,)
        Numbers of the pairs; pair n enters contact n pitches after the start, between the driving wheel's tooth n mod z_p and the driven one's
        n mod z_g, counted from 0.
    pair_force_n : array, shape (pairs, points)
        (N) Force of each pair.
    """

    pitch: Array
    transmission_error_um: Array
    pairs: npt.NDArray[np.int_]
    pair_force_n: Array

    @property
    def peak_to_peak_um(self) -> float:
        """(µm) Largest less smallest transmission error."""
        return float(np.nanmax(self.transmission_error_um) - np.nanmin(self.transmission_error_um))


class Simulation:
    """A simulation of any scenario: every stage's results and the signals. :func:`simulate` makes one.

    Beside the attributes below it has every field of a trace that belongs to the stages before the time loop, under the trace's names:
    ``natural_frequencies_hz``, ``mesh_stiffness_n_per_mm`` (every 4th point of a revolution of the gear),
    ``pair_stiffness_healthy_n_per_mm``, ``mass_diagonal``, ``damping_matrix``, ``stiffness_matrix_mean``, ``contact_ratio``, and so on:
    :attr:`fields` has them all. Type checkers know those of every pair; those of a fault are ``fields["fault_area_percent"]`` to them, and
    the signals of named sensors ``sensors["casing"]``. What a gearbox does not have, such as ``vertical_g``, is an AttributeError that says
    what it has: its signals are ``simulation["force_n.z1-z2"]``.

    Examples
    --------
    >>> from meshtone import examples, simulate
    >>> simulation = simulate(examples.tooth_breakage())
    >>> simulation.vertical_g.shape, simulation.vertical_g.dtype
    ((95608,), dtype('float64'))
    >>> simulation.natural_frequencies_hz.round(1)[:3]
    array([102.7, 379. , 381.2])
    >>> round(float(simulation.contact_ratio), 3)
    1.609
    """

    pinion_profile_x_mm: Array
    pinion_profile_y_mm: Array
    pinion_tip_xy_mm: Array
    pinion_radii_mm: Array
    gear_profile_x_mm: Array
    gear_profile_y_mm: Array
    gear_tip_xy_mm: Array
    gear_radii_mm: Array
    pinion_profile_errors_mm: Array
    gear_profile_errors_mm: Array
    shaft_stiffness_nm_per_rad: Array
    pair_stiffness_healthy_n_per_mm: Array
    pair_stiffness_faulty_n_per_mm: Array
    mesh_stiffness_n_per_mm: Array
    natural_frequencies_hz: Array
    mass_diagonal: Array
    damping_matrix: Array
    stiffness_matrix_open: Array
    stiffness_matrix_mean: Array
    force_first_200: Array
    force_kept_first_500: Array
    mesh_error_force_n: Array
    contact_ratio: float
    working_pressure_angle_rad: float
    centre_distance_mm: float
    normal_backlash_mm: float
    face_load_factor: float
    lean_um: float
    tilt_product: float
    fine_step_rev: float
    coarse_step_rev: float
    pinion_revolutions: float
    pinion_mass_kg: float
    pinion_transverse_inertia_kgm2: float
    pinion_polar_inertia_kgm2: float
    gear_mass_kg: float
    gear_transverse_inertia_kgm2: float
    gear_polar_inertia_kgm2: float

    def __init__(self, scenario: Scenario, native: _core.Simulation) -> None:
        self._scenario = scenario
        self._native = native
        self._fields: dict[str, Any] | None = None
        for signal in native.channels.values():
            read_only(signal)

    def __getitem__(self, channel: str) -> Array:
        """The signal of a name."""
        if channel not in self._native.channels:
            raise KeyError(f"there is no channel {channel!r}; there are {', '.join(self._native.channels)}")
        return self._native.channels[channel]

    def _ipython_key_completions_(self) -> list[str]:
        return list(self._native.channels)

    @property
    def scenario(self) -> Scenario:
        """What was simulated."""
        return self._scenario

    @property
    def meshes(self) -> tuple[str, ...]:
        """The names of the meshes, that of the driving wheel before that of the driven one: ``pinion-gear``, ``z1-z2``."""
        return tuple(name for name, _ in self._scenario._native.meshes())

    @property
    def wheels(self) -> tuple[str, ...]:
        """The names of the wheels."""
        return tuple(name for name, *_ in self._scenario._native.wheels())

    @property
    def sampling_rate_hz(self) -> float:
        """(S/s) Sampling rate: the nominal one, raised to a whole number of samples in each revolution of either shaft, which may be
        many times as many; :meth:`signals` gives another rate exactly."""
        return self._native.sampling_rate_hz

    @property
    def start_s(self) -> float:
        """(s) Time of the first kept sample since the start of the simulation."""
        return self._native.start_s

    @property
    def time_s(self) -> Array:
        """(s) Time of each sample since the start of the simulation."""
        return self.start_s + np.arange(_samples(self)) / self.sampling_rate_hz

    @property
    def channels(self) -> dict[str, Array]:
        """All signals by their names, in the order of :attr:`Scenario.channels`: sensors first; shape (samples,) each."""
        return dict(self._native.channels)

    @property
    def horizontal_g(self) -> Array:
        """(g) Horizontal acceleration of the two supports, their mean; under ``linear`` and ``published`` the sum of both wheels'; shape (samples,)."""
        return self._channel("horizontal_g")

    @property
    def vertical_g(self) -> Array:
        """(g) Vertical acceleration of the two supports, their mean; under ``linear`` and ``published`` the sum of both wheels'; shape (samples,)."""
        return self._channel("vertical_g")

    @property
    def axial_g(self) -> Array:
        """(g) Axial acceleration of the two wheels, summed; shape (samples,)."""
        return self._channel("axial_g")

    @property
    def pinion_shaft_speed_hz(self) -> Array:
        """(rev/s) Speed of the pinion; shape (samples,)."""
        return self._channel("pinion_shaft_speed_hz")

    @property
    def gear_shaft_speed_hz(self) -> Array:
        """(rev/s) Speed of the gear; shape (samples,)."""
        return self._channel("gear_shaft_speed_hz")

    @property
    def mesh_force_n(self) -> Array:
        """(N) Force of the mesh along the line of action; shape (samples,). Under ``contact`` 0 while no teeth touch, negative while back
        flanks do."""
        return self._channel("mesh_force_n")

    def _channel(self, name: str) -> Array:
        if name not in self._native.channels:
            # As an AttributeError it goes on to __getattr__, which says what there is.
            raise AttributeError(name)
        return self._native.channels[name]

    @property
    def sensors(self) -> dict[str, Array]:
        """(g) What the scenario's sensors show, by their names, in their order; each is an attribute too, ``NAME_g``; shape (samples,). Of a
        gearbox without listed sensors those on the seats of all bearings."""
        return {name.removesuffix("_g"): self._native.channels[name] for name in self.scenario._native.sensor_channels()}

    @property
    def tension_fraction(self) -> float:
        """Part of the kept time in which the mesh force is negative: a linear mesh pulls where real teeth would separate. Of several meshes
        that of the one which pulls most."""
        return self._native.tension_fraction

    @property
    def contact_figures(self) -> ContactFigures | None:
        """How the teeth touched, of several meshes those of the first: :meth:`contact_figures_of` has each; None but under ``contact``."""
        return self.contact_figures_of(self.meshes[0])

    def contact_figures_of(self, mesh: str) -> ContactFigures | None:
        """How the teeth of a mesh touched; None but under ``contact``.

        Parameters
        ----------
        mesh : str
            One of :attr:`meshes`.
        """
        number, figures = self._mesh(mesh), self._native.contact_figures
        return None if figures is None else ContactFigures(*figures[number])

    def _mesh(self, mesh: str | None) -> int:
        """The number of a mesh; of the first where none is named."""
        if mesh is None:
            return 0
        if mesh not in self.meshes:
            raise ValueError(f"mesh = {mesh!r}: must be one of {', '.join(self.meshes)}")
        return self.meshes.index(mesh)

    @property
    def warnings(self) -> list[str]:
        """What is doubtful, as ``meshtone simulate`` prints it: the scenario's warnings, then those of the signals."""
        return self._native.warnings

    @property
    def warning_codes(self) -> list[str]:
        """What each of :attr:`warnings` is about, for programs to distinguish: ``"step-error"``, ``"mesh-pulls"``, and so on."""
        return self._native.warning_codes

    @property
    def mode_shapes(self) -> Array:
        """Mode shapes in the columns, in the order of ``natural_frequencies_hz``, of unit modal mass; of a pair of the shape (13, 13), under
        ``contact`` (17, 17): x and y of the gear's and of the pinion's support come last; of a gearbox a row for each of its coordinates."""
        return self._native.mode_shapes

    def natural_frequencies_with_hz(self, mesh_stiffness_n_per_m: Sequence[float]) -> Array:
        """(Hz) Natural frequencies, rising, with other stiffnesses of the meshes than their means, which ``natural_frequencies_hz`` has.

        Parameters
        ----------
        mesh_stiffness_n_per_m : sequence of float
            (N/m) Of each mesh.

        Raises
        ------
        ValueError
            Another number of meshes; the model ``published``, which has one of its own.
        """
        return np.asarray(self._native.natural_frequencies_with_hz([float(value) for value in mesh_stiffness_n_per_m]))

    def summary(self) -> dict[str, Any]:
        """What ``meshtone simulate`` writes to ``summary.json``.

        Examples
        --------
        >>> from meshtone import Scenario, gearbox_template, simulate
        >>> gearbox = Scenario.from_toml(gearbox_template("uconn"))
        >>> [mesh["wheels"] for mesh in simulate(gearbox).summary()["meshes"]]
        [['z1', 'z2'], ['z3', 'z4']]
        """
        return self._native.summary()

    def signals(self, target_rate_hz: float | None = None) -> Signals:
        """All channels in single precision, at another rate.

        Parameters
        ----------
        target_rate_hz : float, optional
            (S/s) The rate, met exactly by resampling, as of :meth:`Signals.at_rate`; by default the simulation's own.

        Returns
        -------
        Signals

        Raises
        ------
        ValueError
            As :meth:`Signals.at_rate`.

        Examples
        --------
        >>> from meshtone import examples, simulate
        >>> simulate(examples.healthy()).signals(10_000).vertical_g.shape
        (9500,)
        """
        channels = {name: signal.astype(np.float32) for name, signal in self._native.channels.items()}
        own = Signals(self.scenario, self.sampling_rate_hz, self.start_s, channels, self.warnings, self.warning_codes)
        return own if target_rate_hz is None else own.at_rate(target_rate_hz)

    def to_pandas(self) -> pandas.DataFrame:
        """All signals as a table of pandas, a column each, over ``time_s``, which is the index.

        Needs pandas: ``pip install 'meshtone[tables]'``.

        Raises
        ------
        ModuleNotFoundError
            pandas is not installed.

        Examples
        --------
        >>> from meshtone import examples, simulate
        >>> simulate(examples.healthy()).to_pandas().shape
        (95608, 6)
        """
        with extra("tables"):
            import pandas
        return pandas.DataFrame(self.channels, index=pandas.Index(self.time_s, name="time_s"))

    def to_xarray(self) -> xarray.Dataset:
        """All signals as xarray has them, over ``time_s``.

        Needs xarray and pandas: ``pip install 'meshtone[xarray]'``.

        Raises
        ------
        ModuleNotFoundError
            xarray or pandas is not installed.
        """
        with extra("xarray"):
            signals: xarray.Dataset = self.to_pandas().to_xarray()
        return signals

    def save(self, path: str | PathLike[str]) -> None:
        """Write the signals; the file's ending says the format. :func:`read_recording` reads all of them.

        Parameters
        ----------
        path : path-like
            The file, which appears whole or not at all. ``.parquet`` contains the scenario too; ``.csv``, ``.npz`` and ``.mat`` (MATLAB,
            version 5) have ``time_s``, one column or array for each signal and, but for CSV, the number ``sampling_rate_hz``; ``.wav`` has
            floating point of 32 bits between -1 and 1, with the full scale of each channel in the file's comment. In a MAT-file the names
            have an underscore in place of what MATLAB does not accept: ``force_n_z1_z2``.

        Raises
        ------
        ValueError
            Another ending.
        OSError
            The file cannot be written, or the format cannot hold so many samples.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> from meshtone import examples, read_recording, simulate
        >>> simulation = simulate(examples.healthy())
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = pathlib.Path(folder, "signals.mat")
        ...     simulation.save(path)
        ...     recording = read_recording(path)
        >>> bool((recording["vertical_g"] == simulation.vertical_g).all()), recording.sampling_rate_hz, recording.units["vertical_g"]
        (True, 100640.0, 'g')
        """
        signals = list(self._native.channels.items())
        _core.write_signals(path, native_scenario(self.scenario), False, (self.sampling_rate_hz, self.start_s), signals)

    @property
    def computing_time_s(self) -> dict[str, float]:
        """(s) Wall time of each stage."""
        return dict(self._native.computing_time_s)

    @property
    def fields(self) -> dict[str, Any]:
        """Fields of a trace of the stages before the time loop: a number or an array each."""
        if self._fields is None:
            self._fields = self._native.fields()
            for values in self._fields.values():
                if isinstance(values, np.ndarray):
                    read_only(values)
        return self._fields

    if not TYPE_CHECKING:  # a field that there is not is an error of types, too

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_"):
                raise AttributeError(name)
            if name in self._native.channels:
                return self._native.channels[name]
            try:
                return self.fields[name]
            except KeyError:
                _refuse_indicator(name, "a simulation has", "its", "simulation")
                if name == "to_csv":
                    raise AttributeError(f"a simulation has no '{name}'; {_SAVED}") from None
                if name in CHANNELS:
                    raise AttributeError(f"a gearbox has no signal '{name}'; it has {', '.join(self.scenario.channels)}") from None
                near = hint(name, [*self.fields, *self.scenario.channels]) or "; simulation.fields has all"
                raise AttributeError(f"{'a simulation' if self._is_pair else 'a gearbox'} has no field '{name}'{near}") from None

    @property
    def _is_pair(self) -> bool:
        return self._scenario._native.is_pair

    def __dir__(self) -> list[str]:
        # The same of all simulations: what only some have is in fields and channels.
        return sorted({*super().__dir__(), *Simulation.__annotations__})

    def mesh_stiffness_curve(self, mesh: str | None = None) -> tuple[Array, Array]:
        """Mesh stiffness over a revolution of the driven wheel: the first one, where damage to the driving one makes the next different.

        Parameters
        ----------
        mesh : str, optional
            One of :attr:`meshes`; the first by default.

        Returns
        -------
        gear_rev : array, shape (points,)
            (rev) Angle of the driven wheel since its first tooth entered contact.
        stiffness_n_per_mm : array, shape (points,)
            (N/mm) Mesh stiffness.
        """
        number = self._mesh(mesh)
        stiffness = self._native.mesh_stiffness_n_per_mm(number, 0, wheel_of(self.scenario, mesh_wheels(self.scenario, number)[1]).teeth)
        return np.arange(stiffness.size) / stiffness.size, stiffness

    def static_mesh(
        self,
        force_n: float | None = None,
        *,
        mesh: str | None = None,
        pitches: tuple[int, int] = (0, 2),
        points_per_pitch: int = 500,
    ) -> StaticMesh:
        """How the pairs share a force at rest, without deviations, with relief, chamfer and damage. Not under ``published``.

        Parameters
        ----------
        force_n : float, optional
            (N) Along the line of action; that of the brake's torque by default.
        mesh : str, optional
            One of :attr:`meshes`; the first by default.
        pitches : tuple of two int
            First and last of the pitches shown, from the start of the simulation.
        points_per_pitch : int
            Number of points in each.

        Returns
        -------
        StaticMesh

        Raises
        ------
        ValueError
            The model ``published``; a negative force.

        Examples
        --------
        >>> from meshtone import examples, simulate
        >>> at_rest = simulate(examples.healthy().copy(model="contact")).static_mesh(500)
        >>> bool(abs(at_rest.pair_force_n.sum(axis=0) - 500).max() < 1e-6)
        True
        """
        if force_n is not None and not force_n >= 0:
            raise ValueError(f"force_n = {force_n}: must be 0 or more")
        first, last = whole("pitches[0]", pitches[0], 0), whole("pitches[1]", pitches[1], 1)
        points = whole("points_per_pitch", points_per_pitch, 1)
        deflection_m, first_pair, pair_force_n = self._native.static_mesh(self._mesh(mesh), force_n, (first, last), points)
        return StaticMesh(
            pitch=first + np.arange(deflection_m.size) / points,
            transmission_error_um=1e6 * deflection_m,
            pairs=first_pair + np.arange(len(pair_force_n)),
            pair_force_n=pair_force_n,
        )

    def tooth_profile(self, wheel: str | None = None) -> tuple[Array, Array]:
        """Half of a healthy tooth.

        Parameters
        ----------
        wheel : str, optional
            Whose, one of :attr:`wheels`; by default the driven one's of the first mesh: the gear's.

        Returns
        -------
        x_mm, y_mm : array, shape (points,)
            (mm) From root to tip; x along the tooth's middle, y half its thickness.
        """
        x_mm, y_mm = self._native.tooth_profile_mm(wheel_of(self.scenario, wheel).name)
        return x_mm, y_mm

    def profile_errors_mm(self, mesh: str | None = None) -> tuple[Array, Array] | None:
        """Profile errors of both wheels of a mesh.

        Parameters
        ----------
        mesh : str, optional
            One of :attr:`meshes`; the first by default.

        Returns
        -------
        tuple of arrays, shape (100, teeth), or None
            (mm) The driving and the driven wheel's, root to tip in the rows, a column a tooth; None for ideal teeth.
        """
        return self._native.profile_errors_mm(self._mesh(mesh))

    def wheel_deviations(self) -> dict[str, float]:
        """What the wheels have beside their profile errors, of which pitch deviations are a part.

        Returns
        -------
        dict
            (µm, rad) Run-out with its phase and helix slope of each wheel, by its name and the key: ``z3_run_out_um``, of a pair the
            arguments of :class:`~meshtone.Scenario`: with :meth:`profile_errors_mm` they are the same wheels. Empty under ``published``.

        Examples
        --------
        >>> import meshtone
        >>> from meshtone import examples
        >>> simulation = meshtone.simulate(examples.healthy().copy(model="contact", sampling_rate_hz=2e4))
        >>> sorted(simulation.wheel_deviations())[:3]
        ['gear_helix_slope_um', 'gear_run_out_phase_rad', 'gear_run_out_um']
        """
        return {f"{wheel}_{key}": number for wheel, key, number in self._native.wheel_deviations()}

    def process(self, channel: str | None = None, wheel: str | None = None, *, sidebands: int | None = None) -> Record:
        """Take one of the signals to its average over a revolution, its parts and its indicators.

        Parameters
        ----------
        channel : str, optional
            One of ``scenario.channels``; the first sensor's by default, or ``vertical_g`` of a pair without one.
        wheel : str, optional
            On whose shaft, one of :attr:`wheels`; by default the driven one of the first mesh: the gear.
        sidebands : int, optional
            Sidebands on either side of each mesh harmonic that belong to the regular part.

        Returns
        -------
        Record

        Raises
        ------
        ValueError
            A channel that there is not, or that is constant; fewer than two revolutions; a mesh order beyond the Nyquist order.

        Examples
        --------
        >>> from meshtone import examples, simulate
        >>> record = simulate(examples.tooth_breakage()).process()
        >>> record.revolutions, record.indicators["difference_kurtosis"] > 10
        (17, True)
        """
        channel = chosen_channel(self.scenario, channel)
        return _process(self.scenario, self[channel], self.start_s, channel, wheel, sidebands)

    def process_wheels(self, channel: str | None = None, *, sidebands: int | None = None) -> TrainRecord:
        """Take one of the signals to the averages and indicators of every wheel.

        Parameters
        ----------
        channel, sidebands
            As of :meth:`process`.

        Returns
        -------
        TrainRecord

        Raises
        ------
        ValueError
            As of :meth:`process`.

        Examples
        --------
        >>> from meshtone import Scenario, gearbox_template, simulate
        >>> record = simulate(Scenario.from_toml(gearbox_template())).process_wheels()
        >>> record.shafts
        {'z1': 'input', 'z2': 'middle', 'z3': 'middle', 'z4': 'output'}
        >>> record["z3"].revolutions
        9
        """
        channel = chosen_channel(self.scenario, channel)
        bands, _ = regular_part(sidebands, None)
        parts = _core.process_simulated(native_scenario(self.scenario), self[channel], channel, None, self.start_s, bands)
        return train_record(parts, channel)

    def plot(self) -> Figure:
        """The panel: teeth, mesh stiffness, signal, spectrum, average, difference; damage is marked. See :mod:`meshtone.plotting`."""
        from . import plotting

        return plotting.plot_simulation(self)

    def plot_signal(self, channel: str | None = None, *, revolutions: float = 2.0, ax: Axes | None = None) -> Axes:
        """A signal over some revolutions of the first driven wheel, the gear. See :func:`meshtone.plotting.plot_signal`."""
        from . import plotting

        return plotting.plot_signal(self, channel, revolutions=revolutions, ax=ax)

    def plot_mesh_stiffness(
        self, mesh: str | None = None, *, pitches: tuple[int, int] | None = None, ax: Axes | None = None
    ) -> Axes:
        """Mesh stiffness over some tooth pitches. See :func:`meshtone.plotting.plot_mesh_stiffness`."""
        from . import plotting

        return plotting.plot_mesh_stiffness(self, mesh, pitches=pitches, ax=ax)

    def plot_spectrum(self, channel: str | None = None, *, ax: Axes | None = None) -> Axes:
        """Amplitude against frequency. See :func:`meshtone.plotting.plot_spectrum`."""
        from . import plotting

        return plotting.plot_spectrum(self, channel, ax=ax)

    def plot_tooth(self, wheel: str | None = None, *, tooth: int | None = None, ax: Axes | None = None) -> Axes:
        """A tooth of a wheel: its first damaged one, or another. See :func:`meshtone.plotting.plot_tooth`."""
        from . import plotting

        return plotting.plot_tooth(self, wheel, tooth=tooth, ax=ax)

    def _repr_html_(self) -> str:
        rows = {**_facts(self.scenario), "Signal": _length(_samples(self), self.sampling_rate_hz)}
        return _page(self, chosen_channel(self.scenario, None), rows, self.warnings)

    def __reduce__(self) -> tuple[Callable[[Scenario], Simulation], tuple[Scenario]]:
        # The scenario gives the same bits again, and is 10 000 times smaller.
        return (_again, (self.scenario,))

    def __repr__(self) -> str:
        what, samples = teeth_in_words(self.scenario), _samples(self)
        return f"<Simulation of {what}, {in_words(self.scenario.faults)}: {samples} samples at {self.sampling_rate_hz:.0f} S/s>"


def chosen_channel(scenario: Scenario, channel: str | None) -> str:
    """The channel that is asked for; by default the one that is looked at first.

    Parameters
    ----------
    scenario : Scenario
        What is simulated.
    channel : str or None
        A name.

    Raises
    ------
    ValueError
        A channel that there is not.
    """
    if channel is None:
        return scenario._native.leading_channel()
    if channel not in scenario.channels:
        raise ValueError(f"channel = '{channel}': must be one of {', '.join(scenario.channels)}")
    return channel


class Wheel(NamedTuple):
    """What a scenario says of a wheel.

    Attributes
    ----------
    name : str
        Its name.
    teeth : int
        Its tooth count.
    face_width_mm : float
        (mm) Its face width.
    speed_hz : float
        (Hz) Its nominal speed.
    start_rev : float
        (rev) Its angle where that of its shaft is 0, counted from where its first tooth enters contact.
    """

    name: str
    teeth: int
    face_width_mm: float
    speed_hz: float
    start_rev: float


def wheel_of(scenario: Scenario, name: str | None) -> Wheel:
    """The wheel of a name; by default the driven one of the first mesh.

    Parameters
    ----------
    scenario : Scenario
        What is simulated.
    name : str or None
        A name.

    Raises
    ------
    ValueError
        A wheel that there is not.
    """
    wheels = {wheel.name: wheel for wheel in (Wheel(*each) for each in scenario._native.wheels())}
    chosen = mesh_wheels(scenario, 0)[1] if name is None else name
    if chosen not in wheels:
        raise ValueError(f"wheel = {name!r}: must be one of {', '.join(wheels)}")
    return wheels[chosen]


def mesh_wheels(scenario: Scenario, mesh: int) -> list[str]:
    """The names of the driving and of the driven wheel of a mesh, by its number."""
    return scenario._native.meshes()[mesh][1]


def mesh_frequencies_hz(scenario: Scenario) -> list[float]:
    """(Hz) The nominal frequency of each mesh."""
    driving = [wheel_of(scenario, wheels[0]) for _, wheels in scenario._native.meshes()]
    return [wheel.teeth * wheel.speed_hz for wheel in driving]


def teeth_in_words(scenario: Scenario) -> str:
    """``17/38 teeth``; of several meshes each."""
    meshes = ["/".join(str(wheel_of(scenario, wheel).teeth) for wheel in wheels) for _, wheels in scenario._native.meshes()]
    return f"{', '.join(meshes)} teeth"


def _samples(simulation: Simulation) -> int:
    return int(next(iter(simulation._native.channels.values())).size)


class _Channels:
    """Channels by their names, for type checkers; the signals of named sensors are ``channels["casing_g"]`` to them."""

    horizontal_g: npt.NDArray[np.float32]
    vertical_g: npt.NDArray[np.float32]
    axial_g: npt.NDArray[np.float32]
    pinion_shaft_speed_hz: npt.NDArray[np.float32]
    gear_shaft_speed_hz: npt.NDArray[np.float32]
    mesh_force_n: npt.NDArray[np.float32]


@dataclass(frozen=True)
class Signals(_Channels):
    """Some channels of one of many simulations.

    Attributes
    ----------
    scenario : Scenario
        What was simulated.
    sampling_rate_hz : float
        (S/s)
    start_s : float
        (s) Time of the first sample since the start of the simulation.
    channels : dict of str to array of float32, shape (samples,)
        By the names of ``scenario.channels``; they are attributes too: ``signals.vertical_g``.
    warnings, warning_codes : list of str
        What is doubtful, and what each of these is about, as of a :class:`Simulation`.
    is_resampled : bool
        Whether the rate is another than the simulation's own.
    """

    scenario: Scenario
    sampling_rate_hz: float
    start_s: float
    channels: dict[str, npt.NDArray[np.float32]] = field(repr=False)
    warnings: list[str] = field(default_factory=list, repr=False)
    warning_codes: list[str] = field(default_factory=list, repr=False)
    is_resampled: bool = field(default=False, repr=False)

    def __post_init__(self) -> None:
        for signal in self.channels.values():
            signal.flags.writeable = False

    def __getitem__(self, channel: str) -> npt.NDArray[np.float32]:
        """The signal of a name."""
        if channel not in self.channels:
            raise KeyError(f"there is no channel {channel!r}; there are {', '.join(self.channels)}")
        return self.channels[channel]

    def at_rate(self, target_rate_hz: float) -> Signals:
        """The same signals at exactly this sampling rate, by a polyphase filter that keeps what lies below half of it.

        A simulation's own rate is the nominal one, raised so that both wheels turn a whole number of samples:
        10 000 S/s become 180 880 where 17 teeth at 40 Hz mesh with 38.

        Parameters
        ----------
        target_rate_hz : float
            (S/s) The rate, more than 0. Of at most twice the mesh frequency it leaves nothing of the mesh, and a
            :class:`~meshtone.MeshtoneWarning` says so.

        Returns
        -------
        Signals

        Raises
        ------
        ValueError
            A rate that is not more than 0, or below 1e-5 of the simulation's own.

        Examples
        --------
        >>> from meshtone import examples, simulate_many
        >>> [signals] = simulate_many([examples.healthy()])
        >>> signals.sampling_rate_hz, signals.at_rate(25_000).sampling_rate_hz
        (100640.0, 25000.0)
        """
        rate_hz = positive("target_rate_hz", target_rate_hz)
        _warn_of_rate(rate_hz, [self.scenario])
        return self._resampled(rate_hz)

    def save(self, path: str | PathLike[str]) -> None:
        """Write the signals as :meth:`Simulation.save` does; the scenario only where they have the simulation's own rate.

        Parameters
        ----------
        path : path-like
            The file.

        Raises
        ------
        ValueError, OSError
            As :meth:`Simulation.save`.
        """
        signals = [(name, signal.astype(np.float64)) for name, signal in self.channels.items()]
        rate_and_start = (self.sampling_rate_hz, self.start_s)
        _core.write_signals(path, native_scenario(self.scenario), self.is_resampled, rate_and_start, signals)

    def _resampled(self, rate_hz: float) -> Signals:
        channels = {name: resample(signal, self.sampling_rate_hz, rate_hz).astype(np.float32) for name, signal in self.channels.items()}
        return replace(self, sampling_rate_hz=rate_hz, channels=channels, is_resampled=True)

    if not TYPE_CHECKING:  # a channel that there is not is an error of types, too

        def __getattr__(self, name: str) -> npt.NDArray[np.float32]:
            if name.startswith("_") or name == "channels":
                raise AttributeError(name)
            try:
                return self.channels[name]
            except KeyError:
                _refuse_indicator(name, "signals have", "their", "signals")
                raise AttributeError(f"no channel '{name}' was kept, but {', '.join(self.channels)}") from None

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.channels})

    def process(self, channel: str | None = None, wheel: str | None = None, *, sidebands: int | None = None) -> Record:
        """Take one of the channels to its average over a revolution, its parts and its indicators.

        Parameters
        ----------
        channel, wheel, sidebands
            As of :meth:`Simulation.process`; the channel must have been kept. By default the first that was kept where the first sensor's
            was not; of a pair ``vertical_g``.

        Returns
        -------
        Record

        Raises
        ------
        ValueError
            As :meth:`Simulation.process`; a channel that was not kept; signals at another rate than the simulation's own.

        Examples
        --------
        >>> from meshtone import examples, simulate_many
        >>> [signals] = simulate_many([examples.tooth_breakage()])
        >>> signals.process().revolutions
        17
        """
        if self.is_resampled:
            raise ValueError(_not_at_own_rate(self.scenario, self.sampling_rate_hz, wheel))
        if channel is None:
            leading, other = chosen_channel(self.scenario, None), "vertical_g" if self.scenario._native.is_pair else next(iter(self.channels))
            channel = leading if leading in self.channels else other
        if channel not in self.channels:
            raise ValueError(f"no channel '{channel}' was kept, but {', '.join(self.channels)}")
        return _process(self.scenario, self.channels[channel], self.start_s, channel, wheel, sidebands)

    def _repr_html_(self) -> str:
        channel = next(iter(self.channels))
        rows = {**_facts(self.scenario), "Signal": _length(self.channels[channel].size, self.sampling_rate_hz)}
        return _page(self, channel, {**rows, "Channels": ", ".join(self.channels)}, self.warnings)


def _refuse_indicator(name: str, who_has: str, whose: str, variable: str) -> None:
    """Say where an indicator is to be had, if the name is that of one."""
    if name == "indicators" or name in INDICATORS:
        key = "" if name == "indicators" else f'["{name}"]'
        raise AttributeError(f"{who_has} no '{name}'; {whose} record has: {variable}.process().indicators{key}") from None


_SAVED = "simulation.save('signals.csv') writes the signals, `meshtone simulate` all results"
"""How a simulation is kept."""


def _not_at_own_rate(scenario: Scenario, rate_hz: float, wheel: str | None) -> str:
    """Why signals that were brought to another rate are not processed, and what is."""
    of = wheel_of(scenario, wheel)
    return (
        f"process takes signals at the simulation's own rate, of which a revolution has a whole number of samples; at {rate_hz:g} S/s it "
        "has not. Process them before the rate is changed (simulate_many without target_rate_hz, then at_rate), or as a rig's: "
        f"meshtone.process_channel(x, meshtone.ShaftPhase.constant({of.speed_hz:.6g}, {rate_hz:g}, x.size), {of.teeth})"
    )


def _facts(scenario: Scenario) -> dict[str, str]:
    """What a notebook says of a scenario."""
    sections = scenario.sections
    widths = "/".join(dict.fromkeys(f"{width_mm:g}" for _, _, width_mm, *_ in scenario._native.wheels()))
    modules = [mesh["module_mm"] for mesh in sections["mesh"]] if "mesh" in sections else [scenario.module_mm]
    module = "/".join(dict.fromkeys(f"{module_mm:g}" for module_mm in modules))
    driving, hz = mesh_wheels(scenario, 0)[0], wheel_of(scenario, mesh_wheels(scenario, 0)[0]).speed_hz
    return {
        "Teeth": f"{teeth_in_words(scenario).removesuffix(' teeth')}, module {module} mm, face {widths} mm",
        "Operation": f"{driving} {hz:g} Hz, brake {scenario.brake_torque_nm:g} N m",
        "Damage": in_words(scenario.faults),
        # A gearbox has one model.
        **({"Model": scenario.model} if "model" in sections else {}),
    }


def _length(samples: int, rate_hz: float) -> str:
    return f"{samples} samples, {samples / rate_hz:.3g} s at {rate_hz:.6g} S/s"


def _page(of: Simulation | Signals, channel: str, rows: dict[str, str], remarks: Sequence[str]) -> str:
    """A simulation for a notebook: facts, a signal, and what it shows about the damaged wheel."""
    # A fault of a rolling bearing is of no wheel.
    damaged = next((fault.wheel for fault in of.scenario.faults if not isinstance(fault, Mapping)), None)
    wheel = wheel_of(of.scenario, damaged)
    signal = np.asarray(of.channels[channel])
    shown = signal[: round(2 * of.sampling_rate_hz / wheel.speed_hz)]
    label = _display.channel_label(channel)
    span = (of.start_s, of.start_s + shown.size / of.sampling_rate_hz)
    pictures = [_display.curve(shown, span=span, over="Time (s)", label=label)]
    try:
        with warnings.catch_warnings():
            # What is shown is not asked for anew: the page lists what is doubtful.
            warnings.simplefilter("ignore")
            record = of.process(channel, wheel.name)
    except ValueError:
        # Too short for an average, or no vibration: the signal is all there is to see.
        pass
    else:
        names = ("difference_rms", "difference_kurtosis", "fm0")
        rows = rows | _display.indicators(record.indicators, names, channel)
        over = f"Angle of {of_wheel(of.scenario, wheel.name)} (revolutions)"
        pictures.append(_display.curve(record.difference, span=(0.0, 1.0), over=over, label=_display.with_unit("Difference", _display.unit_of(channel))))
    return _display.page(type(of).__name__, _display.table(rows), *pictures, _display.remarks(remarks))


def of_wheel(scenario: Scenario, wheel: str) -> str:
    """What a wheel is called in a text: ``the gear``, ``wheel z3``."""
    return f"the {wheel}" if scenario._native.is_pair else f"wheel {wheel}"


def _process(
    scenario: Scenario, signal: npt.ArrayLike, start_s: float, channel: str, wheel: str | None, sidebands: int | None
) -> Record:
    of = wheel_of(scenario, wheel)
    bands, _ = regular_part(sidebands, None)
    values = np.ascontiguousarray(signal, dtype=np.float64)
    parts = _core.process_simulated(scenario._native, values, channel, of.name, start_s, bands)
    warn_of_signal(typed(parts["warnings"]))
    return Record(parts, teeth=of.teeth, name=channel)


def simulate(scenario: Scenario) -> Simulation:
    """Simulate a scenario. Each doubt about it is a :class:`~meshtone.MeshtoneWarning`.

    Parameters
    ----------
    scenario : Scenario
        What is simulated.

    Returns
    -------
    Simulation

    Raises
    ------
    ValueError
        A fault that does not fit the tooth, a solution that grows without bound.

    Examples
    --------
    >>> from meshtone import Scenario, ToothBreakage, simulate
    >>> broken = Scenario(module_mm=3, pinion_teeth=17, gear_teeth=38, face_width_mm=15, pinion_speed_hz=40,
    ...                   brake_torque_nm=10, fault=ToothBreakage(chip_height_mm=5, chip_width_mm=12))
    >>> simulate(broken)
    <Simulation of 17/38 teeth, tooth-breakage: 95608 samples at 100640 S/s>
    >>> from meshtone import gearbox_template
    >>> simulation = simulate(Scenario.from_toml(gearbox_template("tecnalia")))
    >>> simulation
    <Simulation of 29/100, 36/90 teeth, healthy: 100020 samples at 100020 S/s>
    >>> list(simulation.channels)[:3]
    ['input_0_vertical_g', 'output_1_vertical_g', 'force_n.z1-z2']
    """
    native = _core.simulate(native_scenario(scenario))
    warn(native.warnings, native.warning_codes)
    return Simulation(scenario, native)


def _again(scenario: Scenario) -> Simulation:
    """Give warnings of a simulation once only."""
    return Simulation(scenario, _core.simulate(native_scenario(scenario)))


def trace(scenario: Scenario, *, average_rate_hz: float | None = None) -> dict[str, Any]:
    """Simulate a scenario and give every stage's output by name, for checking number by number.

    Parameters
    ----------
    scenario : Scenario
        What is simulated.
    average_rate_hz : float, optional
        (S/s) Rate at which the average's fields are given. 25000 by default.

    Returns
    -------
    dict of str to float or array of float64
        What ``meshtone simulate --trace`` writes.

    Raises
    ------
    ValueError
        As :func:`simulate`.

    Examples
    --------
    >>> from meshtone import examples, trace
    >>> trace(examples.healthy())["acceleration"].shape
    (4000, 17)
    """
    rate_hz = None if average_rate_hz is None else positive("average_rate_hz", average_rate_hz)
    return _core.trace(native_scenario(scenario), rate_hz)


@overload
def simulate_many(
    scenarios: Iterable[Scenario],
    *,
    channels: Sequence[str] | None = None,
    target_rate_hz: float | None = None,
    on_error: Literal["raise"] = "raise",
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] = False,
) -> list[Signals]: ...
@overload
def simulate_many(
    scenarios: Iterable[Scenario],
    *,
    channels: Sequence[str] | None = None,
    target_rate_hz: float | None = None,
    on_error: Literal["return"],
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] = False,
) -> list[Union[Signals, ValueError]]: ...
def simulate_many(
    scenarios: Iterable[Scenario],
    *,
    channels: Sequence[str] | None = None,
    target_rate_hz: float | None = None,
    on_error: Literal["raise", "return"] = "raise",
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] = False,
) -> list[Signals] | list[Union[Signals, ValueError]]:
    """Simulate many scenarios side by side: several times faster than one after the other.

    Parameters
    ----------
    scenarios : iterable of Scenario
        What is simulated.
    channels : sequence of str, optional
        What is kept of each, in single precision: some of ``scenario.channels``; by default ``horizontal_g`` and ``vertical_g`` of a pair,
        the sensors of a gearbox. A scenario without a sensor that is named cannot be simulated so.
    target_rate_hz : float, optional
        (S/s) The rate of the results, met exactly by resampling, as of :meth:`Signals.at_rate`; by default the simulations' own.
    on_error : {'raise', 'return'}
        What becomes of the error of a scenario that cannot be simulated: it is raised, with the scenario's index, and what has not
        begun is not simulated any more; or it stands in the place of the signals and stops no other.
    threads : int, optional
        How many; all cores by default. Results do not depend on it.
    progress : bool or callable, optional
        True for a line on the terminal or a bar in a notebook; or called with the numbers of those that are finished and of all.

    Returns
    -------
    list of Signals, or with ``on_error="return"`` of Signals and ValueError
        In the order of the scenarios. Each kind of warning is given once, with how many scenarios it concerns; each result's
        ``warnings`` have its own. Of a gearbox the step's error is estimated only: :func:`simulate` simulates it a second time with half the
        step where that is doubtful.

    Raises
    ------
    ValueError
        A channel that there is not; a rate that is not more than 0; with ``on_error="raise"`` a scenario that cannot be simulated.
    KeyboardInterrupt
        Ctrl-C stops the simulations.

    Examples
    --------
    >>> from meshtone import MissingTooth, PitCircle, Signals, ThroughFace, examples, simulate_many
    >>> healthy = examples.healthy()
    >>> results = simulate_many(healthy.copy(seed=seed) for seed in range(8))
    >>> len(results), results[0].vertical_g.dtype
    (8, dtype('float32'))

    Of many, some of which may not fit their tooth, those that can be simulated:

    >>> damage = [MissingTooth(), ThroughFace(circle=PitCircle(10.0, 30.0, 0.5))]
    >>> results_or_errors = simulate_many([healthy.copy(fault=fault) for fault in damage], on_error="return")
    >>> [isinstance(result, Signals) for result in results_or_errors]
    [True, False]
    """
    if isinstance(scenarios, Scenario):
        raise TypeError("scenarios: must be several, in a list or the like; simulate takes one")
    if isinstance(channels, str):
        raise TypeError(f"channels = '{channels}': must be a sequence of names: ['{channels}']")
    if on_error not in ("raise", "return"):
        raise ValueError(f"on_error = {on_error!r}: must be 'raise' or 'return'")
    rate_hz = None if target_rate_hz is None else positive("target_rate_hz", target_rate_hz)
    scenarios = list(scenarios)
    ask = _progress.shown("simulations") if progress is True else (progress or None)
    native = [native_scenario(scenario) for scenario in scenarios]
    most = None if threads is None else whole("threads", threads, 1)
    raises = on_error == "raise"
    results = _core.simulate_many(native, None if channels is None else list(channels), most, raises, ask)
    if raises:
        _raise_first(results)
    _warn_of_stepped_alone([result.pop("stepped_alone") for result in results if isinstance(result, dict)])
    made = [_signals(scenario, result) for scenario, result in zip(scenarios, results)]
    _warn_of_many([result for result in made if isinstance(result, Signals)])
    if rate_hz is None:
        return made
    _warn_of_rate(rate_hz, [result.scenario for result in made if isinstance(result, Signals)])
    return [result._resampled(rate_hz) if isinstance(result, Signals) else result for result in made]


def _raise_first(results: Sequence[dict[str, Any] | ValueError]) -> None:
    """The first error, with its place, as that of all."""
    for index, result in enumerate(results):
        if isinstance(result, ValueError):
            raise ValueError(f"scenarios[{index}]: {result}") from result


def _warn_of_stepped_alone(reasons: list[str | None]) -> None:
    """One warning of all simulations of a batch that are not stepped side by side with others."""
    alone = [reason for reason in reasons if reason is not None]
    if len(reasons) > 1 and alone:
        of = f"{len(alone)} of {len(reasons)} simulations"
        warn([f"{of} were stepped alone, which takes several times as long as side by side: {alone[0]}"], ["stepped-alone"])


def _warn_of_rate(rate_hz: float, scenarios: Sequence[Scenario]) -> None:
    """One warning of all scenarios whose mesh frequency a rate does not show."""
    mesh_hz = [min(mesh_frequencies_hz(scenario)) for scenario in scenarios]
    beyond_hz = [frequency_hz for frequency_hz in mesh_hz if rate_hz <= 2 * frequency_hz]
    if beyond_hz:
        of = f" of {len(beyond_hz)} of {len(scenarios)} scenarios, the first" if len(scenarios) > 1 else ""
        warn([f"target_rate_hz = {rate_hz:g}: leaves nothing of the mesh, whose frequency{of} of {beyond_hz[0]:g} Hz is not below half of it"])


def _signals(scenario: Scenario, result: dict[str, Any] | ValueError) -> Signals | ValueError:
    if isinstance(result, ValueError):
        return result
    rate, start = result.pop("sampling_rate_hz"), result.pop("start_s")
    warnings, codes = result.pop("warnings"), result.pop("warning_codes")
    return Signals(scenario, rate, start, result, warnings, codes)


def _warn_of_many(made: list[Signals]) -> None:
    """One warning a code, with the first scenario that it is about."""
    of_codes: dict[str, list[tuple[int, str]]] = {}
    for number, signals in enumerate(made):
        for message, code in zip(signals.warnings, signals.warning_codes):
            of_codes.setdefault(code, []).append((number, message))
    messages = [
        f"{len({number for number, _ in of_code})} of {len(made)} simulations, the first: {of_code[0][1]}" for of_code in of_codes.values()
    ]
    warn(messages, of_codes)
