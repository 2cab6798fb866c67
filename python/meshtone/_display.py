"""What notebooks show of an object: a light page with pictures, made without matplotlib."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape

import numpy as np
import numpy.typing as npt

WIDTH, HEIGHT = 640, 170
"""(px) Of a picture."""
LEFT, RIGHT, TOP, BOTTOM = 62, 8, 8, 38
"""(px) What is left free around its curve."""
BLUE, ORANGE = "#0072b2", "#d55e00"
"""As in the figures."""

LABELS = {
    "horizontal_g": "Horizontal acceleration (g)",
    "vertical_g": "Vertical acceleration (g)",
    "axial_g": "Axial acceleration (g)",
    "pinion_shaft_speed_hz": "Pinion speed (rev/s)",
    "gear_shaft_speed_hz": "Gear speed (rev/s)",
    "mesh_force_n": "Mesh force (N)",
}


def channel_label(channel: str) -> str:
    """What an axis says of a channel: a sensor's is its name; the unit where the name has it."""
    if channel in LABELS:
        return LABELS[channel]
    return with_unit(channel.removesuffix("_g").replace("_", " ").capitalize(), unit_of(channel))


def unit_of(channel: str) -> str:
    """The unit of a channel, as its name has it; empty where it has none, as of a recording's."""
    if channel in LABELS:
        return LABELS[channel].rpartition("(")[2].rstrip(")")
    return "g" if channel.endswith("_g") else ""


def with_unit(quantity: str, unit: str) -> str:
    """What an axis says of a quantity."""
    return f"{quantity} ({unit})" if unit else quantity


def indicators(values: Mapping[str, float], names: Sequence[str], channel: str) -> dict[str, str]:
    """Rows of a table: some condition indicators of a channel; rms and peaks have its unit, the others none.

    Parameters
    ----------
    values : mapping of str to float
        All indicators.
    names : sequence of str
        Those that are shown, as far as they are there.
    channel : str
        The channel.
    """
    unit = unit_of(channel)
    units = {name: unit if name.endswith(("_rms", "_peak_to_peak")) else "" for name in names}
    return {name: f"{values[name]:.4g} {units[name]}".rstrip() for name in names if name in values}


def page(title: str, *parts: str) -> str:
    """A heading and what follows it, as HTML.

    Parameters
    ----------
    title : str
        Text.
    *parts : str
        HTML.
    """
    return f'<div><p style="margin:.3em 0"><b>{escape(title)}</b></p>{"".join(parts)}</div>'


def table(rows: Mapping[str, object] | Iterable[Sequence[object]]) -> str:
    """A table without a heading, as HTML.

    Parameters
    ----------
    rows : mapping or iterable of sequences
        Of a mapping each item is a row.
    """
    lines = rows.items() if isinstance(rows, Mapping) else rows
    cell = '<td style="text-align:left;padding:1px 12px 1px 0">'
    body = "".join("<tr>" + "".join(f"{cell}{escape(str(value))}</td>" for value in line) + "</tr>" for line in lines)
    return f'<table style="border:none">{body}</table>'


def remarks(lines: Sequence[str]) -> str:
    """What deserves attention, as HTML.

    Parameters
    ----------
    lines : sequence of str
        Warnings.
    """
    if not lines:
        return ""
    items = "".join(f"<li>{escape(line)}</li>" for line in lines)
    return f'<p style="margin:.3em 0">Warnings:</p><ul style="margin:.2em 0">{items}</ul>'


def curve(
    values: npt.ArrayLike, *, span: tuple[float, float], over: str, label: str, second: npt.ArrayLike | None = None
) -> str:
    """A curve over an axis, as SVG.

    Parameters
    ----------
    values : array_like, shape (points,)
        What is drawn, at equal distances.
    span : (float, float)
        Where the first point and the place after the last one lie on the axis.
    over : str
        The axis, with its unit.
    label : str
        The values, with their unit.
    second : array_like, optional
        Another curve over the same axis, drawn on top.
    """
    curves = [np.asarray(each, dtype=float) for each in (values, second) if each is not None]
    finite = np.concatenate([each[np.isfinite(each)] for each in curves])
    least, largest = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    if largest <= least:
        least, largest = least - 0.5, largest + 0.5
    inner_width, inner_height = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM

    def x(place: float) -> float:
        return LEFT + inner_width * (place - span[0]) / (span[1] - span[0])

    def y(value: float) -> float:
        return TOP + inner_height * (largest - value) / (largest - least)

    parts = []
    for tick in _ticks(*span, most=8):
        parts.append(f'<path d="M{x(tick):.1f} {TOP}V{TOP + inner_height}" stroke-opacity=".15"/>')
        parts.append(f'<text x="{x(tick):.1f}" y="{HEIGHT - 22}" text-anchor="middle">{tick:g}</text>')
    for tick in _ticks(least, largest, most=5):
        parts.append(f'<path d="M{LEFT} {y(tick):.1f}H{WIDTH - RIGHT}" stroke-opacity=".15"/>')
        parts.append(f'<text x="{LEFT - 5}" y="{y(tick) + 4:.1f}" text-anchor="end">{tick:g}</text>')
    middle = TOP + inner_height / 2
    parts.append(f'<text x="{LEFT + inner_width / 2}" y="{HEIGHT - 5}" text-anchor="middle">{escape(over)}</text>')
    parts.append(f'<text transform="rotate(-90 12 {middle})" x="12" y="{middle}" text-anchor="middle">{escape(label)}</text>')
    for each, colour in zip(curves, (BLUE, ORANGE), strict=False):
        parts.append(f'<path d="{_path(each, y, inner_width)}" stroke="{colour}"/>')
    # Texts and lines take the page's own colour: light on dark, dark on light.
    style = 'fill="none" stroke="currentColor" font-size="11" font-family="sans-serif"'
    text = "<style>.meshtone text{fill:currentColor;stroke:none}</style>"
    return (
        f'<svg class="meshtone" role="img" aria-label="{escape(f"{label} over {over}")}" width="{WIDTH}" height="{HEIGHT}" '
        f'viewBox="0 0 {WIDTH} {HEIGHT}" style="max-width:100%;display:block" {style}>{text}{"".join(parts)}</svg>'
    )


def _path(values: npt.NDArray[np.float64], y: Callable[[float], float], width: int) -> str:
    """A curve of at most two points for each pixel: of many samples the least and the largest in each."""
    size = values.size
    if size > 2 * width:
        edges = np.linspace(0, size, width + 1).astype(int)
        least, largest = np.minimum.reduceat(values, edges[:-1]), np.maximum.reduceat(values, edges[:-1])
        places = np.repeat(LEFT + np.arange(width) + 0.5, 2)
        heights = np.column_stack([least, largest])
        # Up in one pixel and down in the next: half the way.
        heights[1::2] = heights[1::2, ::-1]
        values = heights.ravel()
    else:
        places = LEFT + width * np.arange(size) / max(size, 1)
    command, points = "M", []
    for place, value in zip(places, values, strict=True):
        if not math.isfinite(value):
            command = "M"
            continue
        points.append(f"{command}{place:.1f} {y(value):.0f}")
        command = "L"
    return "".join(points)


def _ticks(least: float, largest: float, *, most: int) -> list[float]:
    """Round numbers between two: 1, 2 or 5 times a power of ten apart."""
    rough = (largest - least) / most
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in (1, 2, 5, 10) if factor * power >= rough * (1 - 1e-9))
    first, last = math.ceil(least / step - 1e-9), math.floor(largest / step + 1e-9)
    # The digits that the step has, not those of a number times it.
    return [float(f"{number * step:.12g}") for number in range(first, last + 1)]
