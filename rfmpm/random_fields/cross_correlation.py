"""Correlation between the properties of one soil: the intrinsic model.

Standard-normal fields of one and the same correlation rho, mixed by the lower factor of the matrix R of the
coefficients, have the covariances R_ij rho(lag): each keeps its own correlation in space exactly, and at one point two
of them are correlated by R_ij (Wackernagel 2003, Multivariate Geostatistics, chapter 22). The coefficients belong to
the standard-normal fields; two lognormal properties of log standard deviations s and t have
(exp(R_ij s t) - 1) / sqrt((exp(s^2) - 1) (exp(t^2) - 1)).
"""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np


def mixing_matrix(names: Sequence[str], correlations: Iterable[Any]) -> np.ndarray:
    """Lower factor of the matrix of the coefficients.

    Args:
        names: the properties, in the order of the study; the first one keeps its field.
        correlations: entries with `between`, two of the names, and `coefficient` [-]; pairs left out are independent.

    Returns:
        the lower factor, shape (k, k) [-].

    Raises:
        ValueError: no random variables can have these coefficients at once.
    """
    matrix = np.eye(len(names))
    for entry in correlations:
        first, second = (names.index(name) for name in entry.between)
        matrix[first, second] = matrix[second, first] = entry.coefficient
    try:
        return np.linalg.cholesky(matrix)
    except np.linalg.LinAlgError:
        raise ValueError(
            f"the correlations between {', '.join(names)} exclude each other: bring the coefficients closer to 0"
        ) from None


def mix(lower: np.ndarray, fields: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Mix independent standard-normal fields, each of shape (n,) [-], into correlated ones; `lower` of shape (k, k)."""
    mixed = []
    for row, own in enumerate(fields):
        others = (lower[row, k] * fields[k] for k in range(row) if lower[row, k] != 0.0)
        mixed.append(sum(others, own if lower[row, row] == 1.0 else lower[row, row] * own))
    return mixed
