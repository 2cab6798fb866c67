"""Data sets for torch; imported only where torch is there."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import torch
import torch.utils.data

from .datasets import with_points

if TYPE_CHECKING:
    from .datasets import FloatSignal, Rows

Values = npt.NDArray[Any]


class TorchDataset(torch.utils.data.Dataset):  # type: ignore[misc, type-arg, unused-ignore]
    """Inputs and targets of each record. :meth:`meshtone.datasets.Dataset.to_torch` makes one.

    Attributes
    ----------
    classes : dict
        Labels in the order of their numbers, by the targets that are classes.
    conditions : list of str
        Names of the conditions, in their order.
    """

    def __init__(
        self,
        rows: Rows,
        channels: Sequence[str],
        targets: Values | Mapping[str, Values],
        classes: dict[str, list[Any]],
        conditions: Mapping[str, Values],
        points: int | None,
        transform: Callable[[FloatSignal], Any] | None,
    ) -> None:
        self.classes = classes
        self.conditions = list(conditions)
        self._known = np.column_stack(list(conditions.values())).astype(np.float32) if conditions else None
        self._rows, self._channels, self._targets = rows, channels, targets
        self._points, self._transform = points, transform

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, index: int) -> tuple[Any, Any]:
        record = self._rows[index]
        signals = self._stacked([record[name] for name in self._channels])
        inputs = torch.from_numpy(signals) if self._transform is None else self._transform(signals)
        if self._known is not None:
            inputs = (inputs, torch.from_numpy(self._known[index].copy()))
        if isinstance(self._targets, Mapping):
            return inputs, {name: _target(values[index]) for name, values in self._targets.items()}
        return inputs, _target(self._targets[index])

    def _stacked(self, signals: Sequence[FloatSignal]) -> FloatSignal:
        if self._points is not None:
            signals = [with_points(name, signal, self._points) for name, signal in zip(self._channels, signals, strict=True)]
        sizes = {signal.size for signal in signals}
        if len(sizes) > 1:
            lengths = ", ".join(f"{signal.size} of '{name}'" for name, signal in zip(self._channels, signals, strict=True))
            raise ValueError(f"the record has {lengths}: points=… makes them of one length")
        return np.stack(signals)


def _target(value: Any) -> Any:
    """A class number as Python has it, of which a batch is of int64; another number as a tensor of float32."""
    return int(value) if isinstance(value, np.integer) else torch.from_numpy(np.array(value))
