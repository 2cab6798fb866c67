"""The chain as a transformer of scikit-learn, which must be installed: ``pip install 'meshtone[sklearn]'``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._extras import extra
from ._names import hint
from .datasets import Dataset
from .signal import Record, ShaftPhase, process_channel
from .scenario import Scenario

with extra("sklearn"):
    from sklearn.base import BaseEstimator, TransformerMixin
    from sklearn.utils.validation import check_is_fitted, validate_data

__all__ = ["DatasetTransformer", "IndicatorTransformer"]


class IndicatorTransformer(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """From records of one channel, a row each, to condition indicators, a column each.

    All records have one rate and one constant speed; records with speeds of their own go through
    :func:`meshtone.process_channel`, one after the other.

    Parameters
    ----------
    sampling_rate_hz : float
        (S/s) Of the records.
    shaft_hz : float
        (rev/s) Speed of the wheel's shaft.
    teeth : int
        Of the wheel.
    indicators : sequence of str, optional
        Names of those that are wanted, as ``record.indicators`` has them; by default all that are defined at this rate, speed and tooth
        count (octaves above half the sampling rate are not). Units, formulas and sources: :class:`meshtone.signal.Indicators`.
    sidebands : int, optional
        Sidebands on either side of each mesh harmonic that belong to the regular part; 2 by default.

    Examples
    --------
    >>> import numpy as np
    >>> from meshtone.sklearn import IndicatorTransformer
    >>> time_s = np.arange(10_000) / 10e3
    >>> records = np.cos(2 * np.pi * 20 * 19 * time_s) + 0.1 * np.random.default_rng(0).standard_normal((3, 10_000))
    >>> chain = IndicatorTransformer(sampling_rate_hz=10e3, shaft_hz=20, teeth=19, indicators=["fm4", "difference_rms"])
    >>> chain.fit_transform(records).shape
    (3, 2)
    >>> list(chain.get_feature_names_out())
    ['fm4', 'difference_rms']
    """

    def __init__(
        self,
        sampling_rate_hz: float,
        shaft_hz: float,
        teeth: int,
        *,
        indicators: Sequence[str] | None = None,
        sidebands: int | None = None,
    ) -> None:
        self.sampling_rate_hz = sampling_rate_hz
        self.shaft_hz = shaft_hz
        self.teeth = teeth
        self.indicators = indicators
        self.sidebands = sidebands

    def fit(self, X: npt.ArrayLike, y: Any = None) -> IndicatorTransformer:
        """Find which indicators are defined for records of this length: nothing is learnt of their values.

        Parameters
        ----------
        X : array_like, shape (records, samples)
            (any unit) The records.
        y : ignored

        Raises
        ------
        ValueError
            An array of another number of dimensions, or without records; values that are masked or not finite; an indicator that there is
            not; records that :func:`meshtone.process_channel` refuses.
        """
        samples = _records(self, X, reset=True).shape[1]
        # A mesh tone in noise, of which all indicators are finite that are defined for such records.
        tone = np.cos(2 * np.pi * self.shaft_hz * self.teeth / self.sampling_rate_hz * np.arange(samples))
        defined = self._record(tone + 0.1 * np.random.default_rng(0).standard_normal(samples)).indicators
        asked = [name for name, value in defined.items() if np.isfinite(value)] if self.indicators is None else list(self.indicators)
        if unknown := [name for name in asked if name not in defined]:
            raise ValueError(
                f"indicators: there is no '{unknown[0]}'; there are {', '.join(defined)}{hint(unknown[0], list(defined))}"
            )
        self.names_ = asked
        return self

    def transform(self, X: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Take each record to its indicators.

        Parameters
        ----------
        X : array_like, shape (records, samples)
            (any unit) The records, as long as those of ``fit``.

        Returns
        -------
        array, shape (records, indicators)
            Rms and peak-to-peak in the records' unit, the others without one; NaN where one is not defined for a record, such as the
            kurtosis of zeros (``sklearn.impute.SimpleImputer`` replaces it).

        Raises
        ------
        ValueError
            As :meth:`fit`, of any record.
        sklearn.exceptions.NotFittedError
            :meth:`fit` has not been called.
        """
        check_is_fitted(self)
        rows = [self._record(record).indicators for record in _records(self, X)]
        return np.array([[row[name] for name in self.names_] for row in rows], dtype=np.float64)

    def get_feature_names_out(self, input_features: Any = None) -> npt.NDArray[np.object_]:
        """Names of the columns."""
        return np.array(self.names_, dtype=object)

    def _record(self, record: npt.NDArray[Any]) -> Record:
        phase = ShaftPhase.constant(self.shaft_hz, self.sampling_rate_hz, record.size)
        return process_channel(record, phase, self.teeth, sidebands=self.sidebands)


class DatasetTransformer(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """From records of one channel, a row each, to columns of a data set, so that what was learnt of it answers for recordings.

    All records have one rate and one constant speed; records with speeds of their own go through :meth:`meshtone.Dataset.like`.

    Parameters
    ----------
    dataset : Dataset
        Whose columns are computed.
    columns : sequence of str
        Columns of numbers.
    machine : Scenario
        What was recorded.
    sampling_rate_hz : float
        (S/s) Of the records.
    shaft_hz : float
        (rev/s) Speed of the pinion's shaft, or of the input of a gearbox.

    Examples
    --------
    ::

        columns = ["fm4", "difference_rms_g", "mesh_harmonic_1_sideband_minus_1_g"]
        model.fit(gears.matrix(columns), gears.column("label"))
        rig = DatasetTransformer(gears, columns, machine, sampling_rate_hz=50e3, shaft_hz=25.0)
        model.predict(rig.fit_transform(records))
    """

    def __init__(
        self, dataset: Dataset, columns: Sequence[str], machine: Scenario, *, sampling_rate_hz: float, shaft_hz: float
    ) -> None:
        self.dataset = dataset
        self.columns = columns
        self.machine = machine
        self.sampling_rate_hz = sampling_rate_hz
        self.shaft_hz = shaft_hz

    def fit(self, X: npt.ArrayLike, y: Any = None) -> DatasetTransformer:
        """Look at the columns: nothing is learnt of the records.

        Parameters
        ----------
        X : array_like, shape (records, samples)
            (g) The records.
        y : ignored

        Raises
        ------
        ValueError
            An array of another number of dimensions, or without records; masked values; a column that the data set does not have.
        """
        _records(self, X, reset=True)
        self.dataset._check_values(self.columns)
        self.names_ = list(self.columns)
        return self

    def transform(self, X: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Take each record to the columns.

        Parameters
        ----------
        X : array_like, shape (records, samples)
            (g) The records.

        Returns
        -------
        array, shape (records, columns)
            In the columns' units: the mean over the windows of a record; NaN where a column is not defined.

        Raises
        ------
        ValueError
            As :meth:`fit`; a record that :meth:`meshtone.Dataset.like` refuses.
        sklearn.exceptions.NotFittedError
            :meth:`fit` has not been called.
        """
        check_is_fitted(self)
        records = _records(self, X)
        phase = ShaftPhase.constant(self.shaft_hz, self.sampling_rate_hz, records.shape[1])
        rows = self.dataset.like(list(records), [phase] * len(records), self.machine, self.sampling_rate_hz)
        values, number = rows.matrix(self.names_), rows.column("unit")
        return np.array([values[number == record].mean(axis=0) for record in range(len(records))])

    def get_feature_names_out(self, input_features: Any = None) -> npt.NDArray[np.object_]:
        """Names of the columns."""
        return np.array(self.names_, dtype=object)


def _records(transformer: BaseEstimator, X: npt.ArrayLike, *, reset: bool = False) -> npt.NDArray[np.float64]:
    if np.ma.is_masked(X):
        raise ValueError("records have no masked values: fill them, or leave such records out")
    return validate_data(transformer, X, reset=reset, dtype=np.float64)  # type: ignore[no-any-return]
