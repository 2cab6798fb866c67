"""Recordings of a rig, or what ``meshtone simulate`` wrote: CSV, TSV, Parquet, NPY, NPZ, MAT, HDF5, WAV, universal files, TDMS, MDF 4, Excel."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike
from typing import Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._names import hint
from ._warnings import warn
from .scenario import Scenario
from .signal._arguments import positive, whole

__all__ = ["Recording", "read_recording"]

Array = npt.NDArray[np.float64]
Column = Union[int, str]


@dataclass(frozen=True)
class Recording:
    """Channels that were recorded together: as of a dictionary, ``recording["bearing"]`` has one, ``in`` and ``for`` go over the names.

    Attributes
    ----------
    sampling_rate_hz : float
        (S/s) Of all channels.
    start_s : float
        (s) Time of the first sample.
    channels : dict of str to array of float64, shape (samples,)
        By name, in the file's order.
    units : dict of str to str or None
        Unit of each channel, where the file says it.
    scenario : Scenario or None
        What was simulated, where the file is one that Meshtone wrote.
    """

    sampling_rate_hz: float
    start_s: float
    channels: dict[str, Array] = field(repr=False)
    units: dict[str, str | None]
    scenario: Scenario | None = field(repr=False)

    def __getitem__(self, name: str) -> Array:
        """The samples of a channel."""
        try:
            return self.channels[name]
        except KeyError:
            meant = hint(name, self.channels)
            raise KeyError(f"no channel '{name}'; the recording has {', '.join(self.channels)}{meant}") from None

    def __contains__(self, name: object) -> bool:
        return name in self.channels

    def __iter__(self) -> Iterator[str]:
        """The names of the channels, as of a dictionary."""
        return iter(self.channels)

    def __len__(self) -> int:
        """How many channels there are."""
        return len(self.channels)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self.channels)


def read_recording(
    path: str | PathLike[str],
    *,
    channels: Sequence[Column] = (),
    sampling_rate_hz: float | None = None,
    variable: str | None = None,
    time: Column | None = None,
    sensitivity_v_per_unit: Mapping[Column, float] | None = None,
    units: Mapping[Column, str] | None = None,
) -> Recording:
    """Read a recording.

    Parameters
    ----------
    path : str or path
        The file, or a folder that ``meshtone simulate`` wrote.
    channels : sequence of str or int
        Names or numbers (from 1) of the columns; all numeric ones by default.
    sampling_rate_hz : float, optional
        (S/s) By default what the file states, or its time column.
    variable : str, optional
        Of NPZ, MAT and HDF5 files: the variable that holds the recording, ``run.sensors`` for nested ones. Of the folder of a set of
        ``bearing-datasets``: the ``recording_id``.
    time : str or int, optional
        The time column; by default the one whose name says so.
    sensitivity_v_per_unit : mapping of channel to float, optional
        (V/unit) Of the sensors: samples in volts are divided by it.
    units : mapping of channel to str, optional
        Units of the samples, after that division.

    Returns
    -------
    Recording

    Raises
    ------
    FileNotFoundError, IsADirectoryError, OSError
        There is no such file; a folder that ``meshtone simulate`` did not write; what else the system refused.
    ValueError
        A broken file, a column that there is not, NaN, times that are not uniform, no sampling rate: with the place in the file.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "run.csv")
    ...     _ = path.write_text("time [s],bearing [g]\\n0,1.5\\n0.01,-2.25\\n0.02,0.5\\n")
    ...     recording = read_recording(path)
    >>> recording
    Recording(sampling_rate_hz=100.0, start_s=0.0, units={'bearing': 'g'})
    >>> recording["bearing"]
    array([ 1.5 , -2.25,  0.5 ])
    >>> "tacho" in recording, list(recording)
    (False, ['bearing'])
    """
    if isinstance(channels, str):
        raise TypeError(f"channels = '{channels}': must be a sequence of names or numbers: ['{channels}']")
    chosen = [_column("channels", column) for column in channels]
    sensitivities, named = dict(sensitivity_v_per_unit or {}), dict(units or {})
    calibrations = [
        (_column("sensitivity_v_per_unit, units", channel), sensitivities.get(channel), named.get(channel))
        for channel in {**sensitivities, **named}
    ]
    rate_hz = None if sampling_rate_hz is None else positive("sampling_rate_hz", sampling_rate_hz)
    time = None if time is None else _column("time", time)
    read = _core.read_recording(path, chosen, rate_hz, variable, time, calibrations)
    warn([message for message, _ in read["warnings"]], [code for _, code in read["warnings"]])
    text = read["scenario_toml"]
    return Recording(
        sampling_rate_hz=read["sampling_rate_hz"],
        start_s=read["start_s"],
        channels={name: samples for name, _, samples in read["channels"]},
        units={name: unit for name, unit, _ in read["channels"]},
        scenario=None if text is None else Scenario.from_toml(text),
    )


def _column(argument: str, column: Column) -> Column:
    """A column's name, or its number, from 1."""
    return column if isinstance(column, str) else whole(argument, column, 1)
