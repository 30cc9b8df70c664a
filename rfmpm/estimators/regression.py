"""Ridge regression with one regressor that is not penalised, for many responses at once."""

from typing import NamedTuple

import numpy as np

PENALTIES = np.geomspace(1e-3, 1e3, 10)  # in units of the number of cases, for features of variance near 1


class Fit(NamedTuple):
    """Coefficients of y = constant + slope x + features @ weights, for m responses."""

    slope: np.ndarray  # shape (m,)
    weights: np.ndarray  # shape (d, m)


def fit(y: np.ndarray, x: np.ndarray | None, features: np.ndarray | None, most: float = np.inf) -> Fit:
    """Fit m responses by their own regressor each and by common features.

    The features' weights are penalised by their sum of squares; the penalty of each response is the one with the least
    generalised cross-validation score.

    Args:
        y: responses, shape (n, m).
        x: regressor of each response, shape (n, m), not penalised; None for none.
        features: shape (n, d) with variances near 1; None for none.
        most: bound of the slopes, which are then not negative either; infinite for no bounds.

    Returns:
        Fit; a slope is 0 where its regressor does not vary.

    Source: Hoerl and Kennard (1970), Technometrics 12, 55-67; Golub, Heath and Wahba (1979), Technometrics 21, 215-223.
    """
    y = y - y.mean(axis=0)
    x = np.zeros_like(y) if x is None else x - x.mean(axis=0)
    xx, xy, yy = (np.sum(a * b, axis=0) for a, b in ((x, x), (x, y), (y, y)))
    if features is None or not features.shape[1]:
        return Fit(_bounded(_ratio(xy, xx), most), np.zeros((0, y.shape[1])))
    features = features - features.mean(axis=0)
    square, axes = np.linalg.eigh(features.T @ features)
    square = np.maximum(square, 0.0)
    along_y, along_x = axes.T @ (features.T @ y), axes.T @ (features.T @ x)
    # One line for each penalty: what is left of products of y and x after the features are taken out of them.
    penalty = (PENALTIES * len(y))[:, None]
    inverse = 1.0 / (square + penalty)
    slope = _bounded(_ratio(xy - inverse @ (along_x * along_y), xx - inverse @ along_x**2), most)
    along = along_y - slope[:, None, :] * along_x
    removed = np.einsum("pd,pdm->pm", 2.0 * inverse - square * inverse**2, along**2)
    rest = np.maximum(yy - 2.0 * slope * xy + slope**2 * xx - removed, 0.0)
    freedom = len(y) - 1.0 - (xx > 0.0) - (square * inverse).sum(axis=1)[:, None]
    best = np.argmin(np.where(freedom > 0.0, rest / np.maximum(freedom, 1e-9) ** 2, np.inf), axis=0)
    column = np.arange(y.shape[1])
    return Fit(slope[best, column], axes @ (inverse[best].T * along[best, :, column].T))


def _bounded(slope: np.ndarray, most: float) -> np.ndarray:
    return slope if np.isinf(most) else np.clip(slope, 0.0, most)


def _ratio(product: np.ndarray, square: np.ndarray) -> np.ndarray:
    tiny = 1e-12 * max(float(np.max(square, initial=0.0)), 1e-300)
    return np.where(square > tiny, product / np.where(square > tiny, square, 1.0), 0.0)
