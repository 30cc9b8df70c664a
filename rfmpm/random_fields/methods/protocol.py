"""What a field method offers."""

from typing import Any, Protocol

import numpy as np

from rfmpm.random_fields.correlation import Anisotropy


class FieldMethod(Protocol):
    """A field method: all it needs beside its record is `xi`, so any plan of `xi` can drive it.

    Attributes:
        Record: NamedTuple of arrays, made once for a correlation and a set of points.
    """

    Record: type[Any]

    @staticmethod
    def prepare(correlation: Anisotropy, points: np.ndarray, **options: float) -> Any:
        """Make the record for points, shape (n, 2) [m]; what `OPTIONS` lists of the method may be given by name."""

    @staticmethod
    def n_variables(record: Any) -> int:
        """Length of the vector `xi` that the record takes."""

    @staticmethod
    def transform(record: Any, xi: np.ndarray) -> np.ndarray:
        """Turn `xi`, shape (n_variables,) [-], into the standard-normal field at the points, shape (n,) [-]."""

    @staticmethod
    def is_intact(record: Any, points: np.ndarray) -> bool:
        """Whether a record read from a file can be one for these points; false for a damaged or a foreign one."""

    @staticmethod
    def covariance_error(record: Any) -> float:
        """Largest difference between the covariance of the field and the asked one [-]; each method says where."""
