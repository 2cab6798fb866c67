"""Recordings as rows of a data set."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Union

import numpy.typing as npt

from . import _core
from ._warnings import typed, warn_of_signal
from .signal._arguments import Array, positive, signal_array
from .signal.phase import ShaftPhase, native_phase
from .scenario import Scenario, native_scenario

if TYPE_CHECKING:
    import pyarrow

    from .datasets import Dataset

Channels = Union[npt.ArrayLike, Mapping[str, npt.ArrayLike]]
"""The analysed channel, or several by the data set's names."""


def table_like(
    dataset: Dataset,
    recordings: Channels | Sequence[Channels],
    phase: ShaftPhase | Sequence[ShaftPhase],
    machine: Scenario,
    sampling_rate_hz: float,
    shaft: str | None,
) -> pyarrow.Table:
    """A row for each window of the recordings, in the columns of the data set; null in what a recording does not tell.

    Parameters
    ----------
    dataset, recordings, phase, machine, sampling_rate_hz, shaft
        As of :meth:`meshtone.Dataset.like`.
    """
    import pyarrow
    import pyarrow.parquet

    phases = [phase] if isinstance(phase, ShaftPhase) else list(phase)
    several = [recordings] if isinstance(phase, ShaftPhase) else list(recordings)  # type: ignore[arg-type]
    if len(several) != len(phases) or not phases:
        raise ValueError(f"{len(several)} recordings, but {len(phases)} phases: give one of each")
    named = [(_channels(channels), native_phase(of)) for channels, of in zip(several, phases)]
    rate_hz = positive("sampling_rate_hz", sampling_rate_hz)
    with TemporaryDirectory() as folder:
        for name in _core.PLAN_FILES:
            if (text := dataset._beside(name)) is not None:
                Path(folder, name).write_bytes(text)
        rows, doubts = _core.rows_like(Path(folder, _core.PLAN_FILES[0]), named, native_scenario(machine), rate_hz, shaft)
    warn_of_signal(typed(doubts))
    found = pyarrow.parquet.read_table(pyarrow.BufferReader(rows))
    schema, conditions = dataset.arrow.schema, set(dataset.condition_columns)
    # What the scenario of the machine says beside the conditions are assumptions and no measurements.
    told = [name for name in found.column_names if name in conditions or b"key" not in (found.schema.field(name).metadata or {})]
    arrays = [
        found[field.name].cast(field.type) if field.name in told else pyarrow.nulls(found.num_rows, field.type) for field in schema
    ]
    return pyarrow.table(arrays, schema=pyarrow.schema([field.with_nullable(True) for field in schema]))


def _channels(channels: Any) -> list[tuple[str | None, Array]]:
    """Channels by their names; None is the name of the analysed one."""
    if isinstance(channels, Mapping):
        return [(name, signal_array(samples)) for name, samples in channels.items()]
    return [(None, signal_array(channels))]
