"""Data sets for torch; imported only where torch is there."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import torch
import torch.utils.data

from .datasets import Rows, with_points

if TYPE_CHECKING:
    from .datasets import Dataset, FloatSignal


class TorchDataset(torch.utils.data.Dataset):  # type: ignore[misc, type-arg, unused-ignore]
    """(signal, class number) of each record. :meth:`meshtone.datasets.Dataset.to_torch` makes one."""

    def __init__(
        self,
        dataset: Dataset,
        signal: str,
        label: str,
        points: int | None,
        transform: Callable[[FloatSignal], Any] | None,
    ) -> None:
        labels = dataset.column(label)
        self.classes = sorted(set(labels.tolist()))
        """The labels, in the order of their numbers."""
        self._numbers = np.searchsorted(np.asarray(self.classes), labels)
        self._rows = Rows(dataset, [signal])
        self._signal, self._points, self._transform = signal, points, transform

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, index: int) -> tuple[Any, int]:
        signal = self._rows[index][self._signal]
        if self._points is not None:
            signal = with_points(self._signal, signal, self._points)
        number = int(self._numbers[index])
        return (torch.from_numpy(signal.copy()) if self._transform is None else self._transform(signal)), number
