"""Figures, with matplotlib: they return figures and axes that can be changed.

Needs matplotlib: ``pip install 'meshtone[plot]'``.
"""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._display import LABELS, channel_label
from ._extras import extra
from .faults import in_words
from .signal._arguments import whole
from .signal.indicators import INDICATORS, SHOWN
from .simulation import Wheel, chosen_channel, mesh_frequencies_hz, mesh_wheels, of_wheel, teeth_in_words, wheel_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    from .signal import OrderMap, Record
    from .simulation import Simulation

__all__ = [
    "plot_indicators",
    "plot_mesh_stiffness",
    "plot_order_map",
    "plot_record",
    "plot_signal",
    "plot_simulation",
    "plot_spectrum",
    "plot_tooth",
    "png",
]

BLUE, ORANGE, GREY = "#0072b2", "#d55e00", "#8c8c8c"
"""Colours that also readers with colour blindness can distinguish (Okabe and Ito)."""

LINES = ((BLUE, "o"), (ORANGE, "s"), ("#009e73", "^"), ("#cc79a7", "D"), ("#56b4e9", "v"), ("#e69f00", "P"))
"""Colour and marker of each line where there are several; from the seventh on they come again, dashed."""

PART: dict[str, Any] = {"facecolor": "none", "edgecolor": ORANGE, "hatch": "////", "linewidth": 1.0}
MISSING: dict[str, Any] = {"facecolor": "white", "edgecolor": ORANGE, "hatch": "//", "linewidth": 1.0}
WHOLE: dict[str, Any] = {"facecolor": ORANGE, "edgecolor": "none", "alpha": 0.7}
TURN: dict[str, Any] = {"facecolor": ORANGE, "edgecolor": "none", "alpha": 0.2}
"""The parts of a revolution in which a damaged tooth is in contact."""

MOST_NAMED = 3
"""Teeth that are named one by one; of more it is said how many they are."""

AROUND_DAMAGE = 8
"""(pitches) What the mesh stiffness is shown over."""


def _new_figure(size: tuple[float, float]) -> Figure:
    with extra("plot"):
        import matplotlib.pyplot as plt

    return plt.figure(figsize=size, layout="constrained")


def png(figure: Figure) -> bytes:
    """A figure as PNG, for notebooks; it is closed.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    """
    import matplotlib.pyplot as plt

    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=100)
    plt.close(figure)
    return buffer.getvalue()


def _axes(ax: Axes | None, size: tuple[float, float] = (8.0, 3.2)) -> Axes:
    return ax if ax is not None else _new_figure(size).subplots()


def plot_signal(
    simulation: Simulation, channel: str | None = None, *, revolutions: float = 2.0, ax: Axes | None = None
) -> Axes:
    """A signal over some revolutions of the first driven wheel, the gear.

    Parameters
    ----------
    simulation : Simulation
        What is shown.
    channel : str, optional
        One of ``scenario.channels``; the first sensor's by default, or ``vertical_g`` of a pair without one.
    revolutions : float
        (rev) Of that wheel, from the first kept sample on.
    ax : matplotlib.axes.Axes, optional
        Where it is drawn; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ValueError
        A channel that there is not; no revolutions.
    """
    channel = chosen_channel(simulation.scenario, channel)
    if not revolutions > 0:
        raise ValueError(f"revolutions = {revolutions}: must be more than 0")
    ax = _axes(ax)
    values = simulation[channel][: _samples_of(simulation, revolutions)]
    ax.plot(simulation.time_s[: values.size], values, color=BLUE, linewidth=0.8)
    ax.set(xlabel="Time (s)", ylabel=channel_label(channel))
    ax.margins(x=0)
    ax.grid(alpha=0.3)
    return ax


def _samples_of(simulation: Simulation, revolutions: float) -> int:
    """How many samples some revolutions of the first driven wheel take, from the first one on."""
    scenario = simulation.scenario
    wheel = wheel_of(scenario, None)
    if _speed_profile(simulation) is None:
        return max(2, int(round(revolutions * simulation.sampling_rate_hz / wheel.speed_hz)))
    phase = _core.ShaftPhase.of_simulated(scenario._native, simulation.start_s, simulation.time_s.size)
    input_hz = wheel_of(scenario, mesh_wheels(scenario, 0)[0]).speed_hz
    turned_rev = (phase.revolutions - phase.revolutions[0]) * wheel.speed_hz / input_hz
    return max(2, int(np.searchsorted(turned_rev, revolutions)))


def _speed_profile(simulation: Simulation) -> dict[str, Any] | None:
    profile: dict[str, Any] | None = simulation.scenario.sections["operation"].get("speed_profile_hz")
    return profile


def plot_mesh_stiffness(
    simulation: Simulation, mesh: str | None = None, *, pitches: tuple[int, int] | None = None, ax: Axes | None = None
) -> Axes:
    """Mesh stiffness over some tooth pitches, with the contact of all damaged teeth of either wheel tinted.

    Parameters
    ----------
    simulation : Simulation
        What is shown.
    mesh : str, optional
        One of ``simulation.meshes``; the first by default.
    pitches : tuple of int, optional
        (pitches) From and to, since tooth 1 of either wheel entered contact. By default 8 pitches: the first damaged tooth enters
        contact at the first or the second.
    ax : matplotlib.axes.Axes, optional
        Where it is drawn; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ValueError
        A mesh that there is not; pitches before the first one, or none.
    """
    number = simulation._mesh(mesh)
    first, last = _whole_pitches(pitches) if pitches is not None else _around_damage(simulation, number)
    if not 0 <= first < last:
        raise ValueError(f"pitches = {pitches}: must be from 0 or more to more than that")
    ax = _axes(ax)
    stiffness = 1e-3 * simulation._native.mesh_stiffness_n_per_mm(number, first, last - first)
    ax.plot(first + np.arange(stiffness.size) / stiffness.size * (last - first), stiffness, color=BLUE, linewidth=1.2)
    wheels = mesh_wheels(simulation.scenario, number)
    over = f"Angle of {of_wheel(simulation.scenario, wheels[1])} (tooth pitches; tooth 1 enters contact at 0)"
    ax.set(xlabel=over, ylabel="Mesh stiffness (N/µm)")
    if len(simulation.meshes) > 1:
        ax.set_title(f"Mesh {simulation.meshes[number]}")
    ax.set_xlim(first, last)
    # Room for the legend above the curve.
    ax.set_ylim(0, 1.3 * stiffness.max())
    _tint(ax, simulation, number, wheels, (first, last))
    ax.grid(alpha=0.3)
    return ax


def _around_damage(simulation: Simulation, mesh: int) -> tuple[int, int]:
    # Tooth j of either wheel enters contact first after j - 1 pitches; one more shows what was before.
    first = max(0, min((tooth - 2 for tooth in _damaged_in(simulation, mesh)), default=0))
    return first, first + AROUND_DAMAGE


def _damaged_in(simulation: Simulation, mesh: int) -> list[int]:
    """The numbers of the damaged teeth of both wheels of a mesh."""
    return [tooth for wheel in mesh_wheels(simulation.scenario, mesh) for tooth in _damaged_teeth(simulation, wheel)]


def _damaged_teeth(simulation: Simulation, wheel: str) -> list[int]:
    """The numbers of a wheel's damaged teeth, in their order."""
    # Not by the scenario's faults: one of severity 0 damages nothing.
    return sorted(tooth for of_wheel, tooth, _ in simulation._native.damaged_teeth_mm() if of_wheel == wheel)


def _whole_pitches(pitches: tuple[int, int]) -> tuple[int, int]:
    first, last = pitches
    return whole("pitches[0]", first), whole("pitches[1]", last)


def _tint(
    ax: Axes, simulation: Simulation, mesh: int, wheels: Sequence[str], pitches: tuple[float, float], start: float = 0.0
) -> None:
    """Tints where damaged teeth of the wheels of a mesh are in contact, or would be, and says in a legend which ones.

    The axis begins ``start`` pitches after tooth 1 has entered contact."""
    teeth_of = {wheel: wheel_of(simulation.scenario, wheel).teeth for wheel in wheels}
    damaged = {wheel: _damaged_teeth(simulation, wheel) for wheel in wheels}
    is_damaged = lambda pair: any(pair % teeth_of[wheel] + 1 in damaged[wheel] for wheel in wheels)
    of_mesh = "" if simulation._is_pair else f".{simulation.meshes[mesh]}"
    overlap = float(simulation.fields.get(f"overlap_ratio{of_mesh}", 0.0))
    contact = (-overlap / 2 - start, float(simulation.fields[f"contact_ratio{of_mesh}"]) + overlap / 2 - start)
    for begin, end in _turns(pitches, contact, is_damaged):
        ax.axvspan(begin, end, zorder=0, **TURN)
    if any(damaged.values()):
        label = "in contact: " + " and ".join(f"{wheel} {_numbered(teeth)}" for wheel, teeth in damaged.items() if teeth)
        ax.legend(handles=[_patch(label)], fontsize="small", loc="upper right", framealpha=1.0)


def _turns(
    pitches: tuple[float, float], contact: tuple[float, float], is_damaged: Callable[[int], bool]
) -> list[tuple[float, float]]:
    """(pitches) The parts of a window in which damaged pairs are in contact; those that overlap are one."""
    turns: list[tuple[float, float]] = []
    for pair in range(math.floor(pitches[0] - contact[1]), math.ceil(pitches[1] - contact[0])):
        start, end = max(pair + contact[0], pitches[0]), min(pair + contact[1], pitches[1])
        if not is_damaged(pair) or start >= end:
            continue
        if turns and turns[-1][1] >= start:
            start = turns.pop()[0]
        turns.append((start, end))
    return turns


def _patch(label: str) -> Patch:
    from matplotlib.patches import Patch

    return Patch(label=label, **TURN)


def _numbered(teeth: Sequence[int]) -> str:
    """``tooth 6``, ``teeth 2 and 6``; of many, how many they are."""
    if len(teeth) == 1:
        return f"tooth {teeth[0]}"
    if len(teeth) > MOST_NAMED:
        return f"{len(teeth)} teeth"
    return f"teeth {', '.join(map(str, teeth[:-1]))} and {teeth[-1]}"


def plot_spectrum(simulation: Simulation, channel: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Amplitude of a signal against frequency, with the harmonics of the meshes where the speed is constant.

    Parameters
    ----------
    simulation : Simulation
        What is shown.
    channel : str, optional
        One of ``scenario.channels``; the first sensor's by default, or ``vertical_g`` of a pair without one.
    ax : matplotlib.axes.Axes, optional
        Where it is drawn; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
    """
    channel = chosen_channel(simulation.scenario, channel)
    ax = _axes(ax)
    values = simulation[channel]
    amplitude = 2 * np.abs(np.fft.rfft(values - values.mean())) / values.size
    frequency_hz = np.fft.rfftfreq(values.size, 1 / simulation.sampling_rate_hz)
    meshes_hz = mesh_frequencies_hz(simulation.scenario)
    limit_hz = min(40 * max(meshes_hz), frequency_hz[-1])
    shown = (frequency_hz > 0) & (frequency_hz <= limit_hz)
    ax.semilogy(frequency_hz[shown] / 1e3, np.maximum(amplitude[shown], 1e-12), color=GREY, linewidth=0.6, label="spectrum")
    steady = meshes_hz if _speed_profile(simulation) is None else []
    for number, ((colour, marker), mesh_hz) in enumerate(zip(LINES, steady)):
        of_mesh = "mesh harmonics" if len(steady) == 1 else f"harmonics of {simulation.meshes[number]}"
        # Where harmonics of several meshes coincide, the larger markers of the first ones show around those of the last.
        size = 3 + 2 * (len(steady) - 1 - number)
        harmonics = mesh_hz * np.arange(1, int(limit_hz / mesh_hz) + 1)
        lines = np.minimum(np.searchsorted(frequency_hz, harmonics - frequency_hz[1] / 2), amplitude.size - 1)
        ax.plot(harmonics / 1e3, amplitude[lines], marker, markersize=size, color=colour, label=f"{of_mesh} ({mesh_hz:g} Hz)")
    top = amplitude[shown].max()
    ax.set_ylim(top * 1e-6, top * 3)
    ax.set_xlim(0, limit_hz / 1e3)
    quantity, unit = channel_label(channel).rsplit(" ", 1)
    ax.set(xlabel="Frequency (kHz)", ylabel=f"{quantity},\namplitude {unit}")
    ax.legend(loc="lower right", fontsize="small", ncols=2, framealpha=1.0)
    ax.grid(alpha=0.3)
    return ax


def plot_tooth(
    simulation: Simulation, wheel: str | None = None, *, tooth: int | None = None, ax: Axes | None = None
) -> Axes:
    """A tooth at equal scales, with its damage; the title names the other damaged teeth of its wheel.

    Parameters
    ----------
    simulation : Simulation
        What is shown.
    wheel : str, optional
        Whose tooth, one of ``simulation.wheels``; by default the driven one's of the first mesh, the gear's.
    tooth : int, optional
        Its number, from 1. By default the wheel's first damaged tooth; of a sound wheel its first tooth.
    ax : matplotlib.axes.Axes, optional
        Where it is drawn; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
    """
    of = wheel_of(simulation.scenario, wheel)
    x_mm, y_mm = simulation.tooth_profile(of.name)
    damaged = _damaged_teeth(simulation, of.name)
    if tooth is None:
        tooth = damaged[0] if damaged else 1
    tooth = whole("tooth", tooth)
    if not 1 <= tooth <= of.teeth:
        raise ValueError(f"tooth = {tooth}: must be from 1 to {of.teeth}, as many as {of_wheel(simulation.scenario, of.name)} has")
    ax = _axes(ax, (4.0, 4.0))
    outline_y = np.concatenate([y_mm, -y_mm[::-1]])
    outline_x = np.concatenate([x_mm, x_mm[::-1]])
    ax.fill(outline_y, outline_x, facecolor="#e8e8e8", edgecolor="black", linewidth=1.0)
    flanks = {(name, number): flank for name, number, flank in simulation._native.damaged_teeth_mm()}
    flank_y_mm = flanks.get((of.name, tooth), y_mm)
    for damage in simulation._native.damages():
        if (damage["wheel"], damage["tooth"]) == (of.name, tooth):
            _plot_damage(ax, damage, (x_mm, y_mm), flank_y_mm, of.face_width_mm)
    ax.set_aspect("equal")
    ax.set(xlabel="Across the tooth (mm)", ylabel="From the wheel's centre (mm)", title=_title_of_tooth(of_wheel(simulation.scenario, of.name), tooth, damaged))
    if ax.get_legend_handles_labels()[0]:
        ax.legend(fontsize="small", loc="upper center", bbox_to_anchor=(0.5, -0.22))
    return ax


def _title_of_tooth(wheel: str, tooth: int, damaged: Sequence[int]) -> str:
    title = f"{'First tooth' if tooth == 1 else f'Tooth {tooth}'} of {wheel}"
    others = [number for number in damaged if number != tooth]
    return f"{title}\n(also damaged: {_numbered(others)})" if others else title


def _plot_damage(
    ax: Axes,
    damage: dict[str, Any],
    flank_mm: tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]],
    cut_y_mm: npt.NDArray[np.float64],
    face_width_mm: float,
) -> None:
    """What a damage has taken: hatched where it takes a part of the face's width, filled where it takes all of it."""
    label = ", ".join(line.rstrip(",") for line in damage["caption"])
    if damage["crack_mm"] is not None:
        crack_x_mm, crack_y_mm = damage["crack_mm"]
        ax.plot(crack_y_mm, crack_x_mm, color=ORANGE, linewidth=2.5, label=label)
        return
    x_mm, y_mm = flank_mm
    first, last = damage["range"]
    reached = (np.arange(x_mm.size) >= first) & (np.arange(x_mm.size) <= last)
    if damage["part"] == "flank":
        lost = reached & (y_mm > cut_y_mm + 1e-9)
        pieces = [(lost, cut_y_mm, PART if damage["is_partial"] else WHOLE, label)]
    elif damage["part"] == "whole":
        pieces = [(reached, -y_mm, MISSING, label)]
    else:
        # Through the whole thickness, in pieces that take more or less of the face.
        outlines = [np.transpose(outline) for outline in damage["face_mm"]]
        inside = [reached & (x_mm >= x.min()) & (x_mm <= x.max()) for _, x in outlines]
        styles = [WHOLE if np.ptp(z) >= face_width_mm else PART for z, _ in outlines]
        pieces = [
            (lost, -y_mm, style, size) for lost, style, size in zip(inside, styles, damage["sizes"][-len(outlines) :])
        ]
    for lost, inner_y_mm, style, text in pieces:
        y = np.concatenate([y_mm[lost], inner_y_mm[lost][::-1]])
        ax.fill(y, np.concatenate([x_mm[lost], x_mm[lost][::-1]]), label=text, **style)


def plot_record(record: Record) -> Figure:
    """Average over a revolution, order spectrum, difference with its envelope.

    Parameters
    ----------
    record : Record
        What is shown.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = _new_figure((9.0, 7.0))
    average_ax, spectrum_ax, difference_ax = figure.subplots(3)
    _plot_over_teeth(average_ax, record.average, record.teeth, BLUE, "average")
    average_ax.set(ylabel=_label(record), title=f"Average of {record.revolutions} revolutions")
    spectrum = record.order_spectrum
    orders = np.arange(spectrum.size)
    limit = min(spectrum.size, 12 * record.teeth)
    spectrum_ax.semilogy(orders[1:limit], np.maximum(spectrum[1:limit], 1e-12), color=GREY, linewidth=0.8)
    mesh = orders[record.teeth : limit : record.teeth]
    spectrum_ax.plot(mesh, spectrum[mesh], "o", markersize=4, color=BLUE, label="mesh orders")
    spectrum_ax.set(xlabel="Order of the shaft", ylabel=_amplitude_label(record), xlim=(0, limit))
    top = spectrum[1:limit].max()
    if top > 0:
        spectrum_ax.set_ylim(top * 1e-5, top * 3)
    spectrum_ax.legend(fontsize="small", loc="lower right")
    spectrum_ax.grid(alpha=0.3)
    _plot_over_teeth(difference_ax, record.difference, record.teeth, BLUE, "difference")
    _plot_over_teeth(difference_ax, record.envelope, record.teeth, ORANGE, "envelope")
    difference_ax.set(ylabel=_label(record), title="Difference signal")
    difference_ax.legend(fontsize="small", loc="upper right")
    return figure


def _label(record: Record) -> str:
    return LABELS.get(record.name, record.name).replace(" acceleration", "\nacceleration")


def _amplitude_label(record: Record) -> str:
    unit = LABELS.get(record.name, "").rpartition(" ")[2]
    return f"Amplitude {unit}".rstrip()


def _plot_over_teeth(ax: Axes, values: npt.NDArray[np.float64], teeth: int, colour: str, label: str) -> None:
    ax.plot(np.arange(values.size) / values.size * teeth, values, color=colour, linewidth=0.8, label=label)
    ax.set(xlabel="Angle (tooth pitches)", xlim=(0, teeth))
    ax.grid(alpha=0.3)


def plot_order_map(order_map: OrderMap, teeth: int | None = None, *, over: str = "time", ax: Axes | None = None) -> Axes:
    """Amplitudes over order and time or speed, on a logarithmic scale from above the noise floor.

    Parameters
    ----------
    order_map : OrderMap
        What is shown.
    teeth : int, optional
        Of the wheel on the shaft: mesh orders are numbered, and shown up to the sixth.
    over : {'time', 'speed'}
        The vertical axis. Over the speed, which must rise or fall throughout.
    ax : matplotlib.axes.Axes, optional
        Where it is drawn; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ValueError
        Another axis; a map of one part; a speed that does not rise or fall throughout.

    Examples
    --------
    >>> import matplotlib, numpy as np, meshtone
    >>> matplotlib.use("agg")
    >>> phase = meshtone.ShaftPhase.from_speed_profile([0, 4], [5, 15], 4000.0, 16_001)
    >>> order_map = meshtone.signal.order_map(np.cos(2 * np.pi * 19 * phase.revolutions), phase, 4000.0)
    >>> plot_order_map(order_map, 19, over="speed").get_ylabel()
    'Speed of the shaft (rev/s)'
    """
    places = {"time": order_map.time_s, "speed": order_map.speed_hz}
    if over not in places:
        raise ValueError(f"over = {over!r}: must be 'time' or 'speed'")
    if order_map.time_s.size < 2:
        raise ValueError("the map has one part, which shows no change; make the parts shorter, by revolutions")
    steps = np.diff(places[over])
    # A constant speed differs by rounding from part to part.
    least = 1e-6 * np.abs(places[over]).max()
    if not (np.all(steps > least) or np.all(steps < -least)):
        raise ValueError("over = 'speed': the speed must rise or fall throughout; show it over time")
    from matplotlib.colors import LogNorm

    ax = _axes(ax, (9.0, 4.5))
    orders, amplitude = order_map.orders, order_map.amplitude
    if teeth is not None:
        teeth = whole("teeth", teeth, 1)
        shown = orders <= _core.ORDER_MAP_MESH_ORDERS * teeth
        orders, amplitude = orders[shown], amplitude[:, shown]
        ax.set_xticks(teeth * np.arange(int(orders[-1] / teeth) + 1))
    top = max(float(amplitude.max()), 1e-12)
    bottom = min(max(1.5 * float(np.median(amplitude)), 1e-3 * top), 0.5 * top)
    norm = LogNorm(bottom, top)
    mesh = ax.pcolormesh(orders, places[over], np.maximum(amplitude, bottom), norm=norm, cmap="Blues", rasterized=True)
    ax.figure.colorbar(mesh, ax=ax, label="Amplitude (unit of the signal)")
    ylabel = "Time (s)" if over == "time" else "Speed of the shaft (rev/s)"
    ax.set(xlabel="Order of the shaft", ylabel=ylabel)
    return ax


def plot_simulation(simulation: Simulation) -> Figure:
    """The panel: tooth, mesh stiffness, signal, spectrum, average and difference over a revolution of the gear.

    Of a gearbox the stiffness of every mesh. Where other wheels are damaged, a tooth of each is shown too, and average and difference over
    its revolution. The contact of all damaged teeth is tinted.

    Parameters
    ----------
    simulation : Simulation
        What is shown.

    Returns
    -------
    matplotlib.figure.Figure
    """
    scenario, meshes = simulation.scenario, range(len(simulation.meshes))
    shown = [wheel for wheel in simulation.wheels if _damaged_teeth(simulation, wheel)]
    leading = wheel_of(scenario, None)
    # The gear is always shown; of a gearbox with damage the damaged wheels alone.
    if not shown or (simulation._is_pair and leading.name not in shown):
        shown.append(leading.name)
    wheels = [wheel_of(scenario, wheel) for wheel in shown]
    teeth = [f"tooth {wheel.name}" for wheel in wheels]
    # As few columns as have the teeth beside one another and the row divided into thirds and halves: more make the layout fail.
    columns = math.lcm(6, len(teeth))
    if len(wheels) == len(meshes) == 1:
        top = [teeth * 2 + ["stiffness 0"] * 4]
    else:
        top = [[tooth for tooth in teeth for _ in range(columns // len(teeth))], *([f"stiffness {mesh}"] * columns for mesh in meshes)]
    halves = columns // 2
    layout: list[Any] = [
        *top,
        ["signal"] * columns,
        ["spectrum"] * columns,
        *([f"average {wheel.name}"] * halves + [f"difference {wheel.name}"] * halves for wheel in wheels),
    ]
    figure = _new_figure((11.0, 2.5 * len(layout)))
    axes = figure.subplot_mosaic(layout, height_ratios=[1.5] + [1] * (len(layout) - 1))
    for wheel in wheels:
        plot_tooth(simulation, wheel.name, ax=axes[f"tooth {wheel.name}"])
        _plot_revolution(simulation, wheel, axes[f"average {wheel.name}"], axes[f"difference {wheel.name}"])
    for mesh in meshes:
        plot_mesh_stiffness(simulation, simulation.meshes[mesh], pitches=_all_damage(simulation, mesh), ax=axes[f"stiffness {mesh}"])
    plot_signal(simulation, ax=axes["signal"])
    plot_spectrum(simulation, ax=axes["spectrum"])
    figure.suptitle(
        f"{teeth_in_words(scenario)}, {_speed(simulation)}, {scenario.brake_torque_nm:g} N m: {in_words(scenario.faults)}",
        wrap=True,
    )
    return figure


def _all_damage(simulation: Simulation, mesh: int) -> tuple[int, int]:
    """(pitches) Around the first damaged tooth; a revolution of the gear where other damaged teeth are not in contact there."""
    around = _around_damage(simulation, mesh)
    if all(tooth < around[1] for tooth in _damaged_in(simulation, mesh)):
        return around
    return 0, wheel_of(simulation.scenario, mesh_wheels(simulation.scenario, mesh)[1]).teeth


def _plot_revolution(simulation: Simulation, wheel: Wheel, average_ax: Axes, difference_ax: Axes) -> None:
    """Average and difference over a wheel's revolution, on one scale, with the contact of its damaged teeth tinted."""
    record = simulation.process(None, wheel.name)
    limit = max(np.abs(record.average).max(), np.abs(record.difference).max()) * 1.25
    ylabel = channel_label(record.name).replace(" acceleration", "")
    mesh = next(n for n in range(len(simulation.meshes)) if wheel.name in mesh_wheels(simulation.scenario, n))
    parts = [(average_ax, "average", record.average), (difference_ax, "difference", record.difference)]
    for ax, name, values in parts:
        _plot_over_teeth(ax, values, record.teeth, BLUE, name)
        # The average is over the shaft's revolution, which wheels on one shaft share.
        _tint(ax, simulation, mesh, (wheel.name,), (0, record.teeth), wheel.start_rev * wheel.teeth)
        ax.set(title=f"{name.capitalize()}, {wheel.name} shaft", ylabel=ylabel, ylim=(-limit, limit))


def _speed(simulation: Simulation) -> str:
    profile = _speed_profile(simulation)
    if profile is None:
        return f"{wheel_of(simulation.scenario, mesh_wheels(simulation.scenario, 0)[0]).speed_hz:g} rev/s"
    return f"{min(profile['value']):g} to {max(profile['value']):g} rev/s"


def plot_indicators(
    table: Mapping[str, Sequence[float]] | Any,
    *,
    x: str,
    indicators: Sequence[str] | None = None,
    by: str | None = None,
) -> Figure:
    """Indicators against what was varied, an axes each.

    A line joins the values of one ``x`` each, or the medians where several records have one ``x``. Values at more than 30 places that
    come once each, as where ``x`` was drawn, are points alone: a line through scatter would show but zigzags.

    Parameters
    ----------
    table : pandas.DataFrame, polars.DataFrame, or mapping of str to sequence
        A column for ``x``, one for each indicator.
    x : str
        The column that is varied: severity, speed, number of the record.
    indicators : sequence of str, optional
        Which columns are shown; all other numeric ones by default, of all of a record's indicators those that its notebook page shows.
    by : str, optional
        A column of labels: a line each.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    ValueError
        A column that there is not.

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("agg")
    >>> figure = plot_indicators({"chip_width_mm": [0, 6, 12], "kurtosis": [3.1, 9.0, 60.0]}, x="chip_width_mm")
    >>> figure.axes[0].get_ylabel()
    'kurtosis'
    """
    columns = {str(name): np.asarray(table[name]) for name in (table.keys() if isinstance(table, Mapping) else table.columns)}
    if indicators is None:
        numeric = [name for name, values in columns.items() if name not in (x, by) and values.dtype.kind in "fiu"]
        indicators = [name for name in SHOWN if name in numeric] if set(INDICATORS) <= set(numeric) else numeric
    for name in [x, *indicators, *([by] if by else [])]:
        if name not in columns:
            raise ValueError(f"the table has no column '{name}', but {', '.join(columns)}")
    if not indicators:
        raise ValueError(f"the table has no numeric column beside '{x}'")
    rows = -(-len(indicators) // 2)
    wide = min(2, len(indicators))
    figure = _new_figure((4.6 * wide, 2.8 * rows))
    axes = np.atleast_1d(figure.subplots(rows, wide)).ravel()
    for ax, name in zip(axes, indicators):
        groups = np.unique(columns[by]) if by else [None]
        for number, group in enumerate(groups):
            colour, marker = LINES[number % len(LINES)]
            style = "-" if number < len(LINES) else "--"
            # Where lines coincide, the larger markers of the first ones show around those of the last.
            size = min(4 + 2 * (len(groups) - 1 - number), 12)
            chosen = np.ones(columns[x].size, bool) if group is None else columns[by or x] == group
            places, values = columns[x][chosen], columns[name][chosen]
            levels = np.unique(places)
            if levels.size < places.size:
                ax.plot(places, values, color=colour, marker=marker, linestyle="none", markersize=3, alpha=0.4)
                values = np.array([np.nanmedian(values[places == level]) for level in levels])
            else:
                values = values[np.argsort(places, kind="stable")]
                style = style if _is_stepped(levels) else "none"
            ax.plot(levels, values, color=colour, marker=marker, linestyle=style, markersize=size, label=str(group))
        ax.set(xlabel=x, ylabel=name)
        ax.grid(alpha=0.3)
        if by:
            ax.legend(fontsize="small", title=by, title_fontsize="small")
    for ax in axes[len(indicators) :]:
        ax.remove()
    return figure


def _is_stepped(levels: npt.NDArray[Any]) -> bool:
    """Whether values were chosen rather than drawn: few, or at equal steps."""
    few = 30
    if levels.size <= few or levels.dtype.kind not in "fiu":
        return True
    steps = np.diff(levels)
    return bool(np.allclose(steps, steps[0]))
