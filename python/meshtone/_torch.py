"""Data sets for torch; imported only where torch is there."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import torch
import torch.utils.data

if TYPE_CHECKING:
    from .datasets import Dataset, FloatSignal


class TorchDataset(torch.utils.data.Dataset):  # type: ignore[misc, type-arg, unused-ignore]
    """(signal, class number) of each record. :meth:`meshtone.datasets.Dataset.to_torch` makes one."""

    def __init__(
        self, dataset: Dataset, signal: str, label: str, transform: Callable[[FloatSignal], Any] | None
    ) -> None:
        labels = dataset.column(label)
        self.classes = sorted(set(labels.tolist()))
        """The labels, in the order of their numbers."""
        self._numbers = np.searchsorted(np.asarray(self.classes), labels)
        self._signal, self._transform = signal, transform
        self._fragments = [
            (fragment, fragment.count_rows(filter=dataset._filter)) for fragment in dataset.arrow.get_fragments()
        ]
        self._ends = np.cumsum([count for _, count in self._fragments])
        self._filter = dataset._filter
        self._read: tuple[int, list[FloatSignal]] | None = None

    def __len__(self) -> int:
        return len(self._numbers)

    def __getitem__(self, index: int) -> tuple[Any, int]:
        if not -len(self) <= index < len(self):
            raise IndexError(f"record {index} of {len(self)}")
        index %= len(self)
        place = int(np.searchsorted(self._ends, index, side="right"))
        if self._read is None or self._read[0] != place:
            from .datasets import _signals_of

            table = self._fragments[place][0].to_table(columns=[self._signal], filter=self._filter)
            self._read = (place, [s for chunk in table.column(0).chunks for s in _signals_of(chunk)])
        first = int(self._ends[place - 1]) if place else 0
        signal = self._read[1][index - first]
        if self._transform is not None:
            return self._transform(signal), int(self._numbers[index])
        return torch.from_numpy(signal.copy()), int(self._numbers[index])
