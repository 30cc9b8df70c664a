"""Ridge regression with one regressor that is not penalised, for many responses at once."""

from typing import NamedTuple

import numpy as np

PENALTIES = np.geomspace(1e-4, 1e4, 17)  # in units of the number of cases, for features of variance near 1


class Fit(NamedTuple):
    """Coefficients of y = constant + slope x + features @ weights, for m responses."""

    slope: np.ndarray  # shape (m,)
    weights: np.ndarray  # shape (d, m)


def fit(y: np.ndarray, x: np.ndarray | None, features: np.ndarray | None) -> Fit:
    """Fit m responses by their own regressor each and by common features.

    The features' weights are penalised by their sum of squares; the penalty of each response is the one with the least
    generalised cross-validation score.

    Args:
        y: responses, shape (n, m).
        x: regressor of each response, shape (n, m), not penalised; None for none.
        features: shape (n, d) with variances near 1; None for none.

    Returns:
        Fit; a slope is 0 where its regressor does not vary.

    Source: Hoerl and Kennard (1970), Technometrics 12, 55-67; Golub, Heath and Wahba (1979), Technometrics 21, 215-223.
    """
    y = y - y.mean(axis=0)
    x = np.zeros_like(y) if x is None else x - x.mean(axis=0)
    if features is None or not features.shape[1]:
        return Fit(_ratio(np.sum(x * y, axis=0), np.sum(x * x, axis=0)), np.zeros((0, y.shape[1])))
    left, singular, right = np.linalg.svd(features - features.mean(axis=0), full_matrices=False)
    along_y, along_x = left.T @ y, left.T @ x
    best = np.full(y.shape[1], np.inf)
    slope, shrunk = np.zeros(y.shape[1]), np.zeros(along_y.shape)
    for penalty in PENALTIES * len(y):
        keep = (singular**2 / (singular**2 + penalty))[:, None]
        weighted = np.sum(x * x, axis=0) - np.sum(keep * along_x**2, axis=0)
        product = np.sum(x * y, axis=0) - np.sum(keep * along_x * along_y, axis=0)
        now = _ratio(product, weighted)
        along = along_y - now * along_x
        square = np.sum((y - now * x) ** 2, axis=0) - np.sum((1.0 - (1.0 - keep) ** 2) * along**2, axis=0)
        freedom = len(y) - 1.0 - (weighted > 0.0) - keep.sum()
        score = np.where(freedom > 0.0, np.maximum(square, 0.0) / np.maximum(freedom, 1e-9) ** 2, np.inf)
        better = score < best
        best = np.where(better, score, best)
        slope = np.where(better, now, slope)
        shrunk = np.where(better, (singular / (singular**2 + penalty))[:, None] * along, shrunk)
    return Fit(slope, right.T @ shrunk)


def _ratio(product: np.ndarray, square: np.ndarray) -> np.ndarray:
    tiny = 1e-12 * max(float(np.max(square, initial=0.0)), 1e-300)
    return np.where(square > tiny, product / np.where(square > tiny, square, 1.0), 0.0)
