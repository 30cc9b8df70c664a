"""How far an ensemble is from its law: differences of found and asked statistics, in standard errors.

Every statistic is an average over realisations of one number per realisation, so that the standard error is that of
independent numbers, however much the points of a realisation have in common.
"""

from types import SimpleNamespace

import numpy as np

ROWS, COLUMNS, SPACING = 12, 24, 0.25
MEAN, SPREAD = 20e3, 0.3
BOXES = [(1, 2), (2, 2), (3, 4), (6, 6), (12, 24)]  # rows and columns of the lattice, which they divide


def settings(correlation: str, distribution: str, **changes) -> SimpleNamespace:
    return SimpleNamespace(**{
        "distribution": distribution,
        "coefficient_of_variation": SPREAD,
        "correlation": correlation,
        "scale_of_fluctuation_h_m": 2.0,
        "scale_of_fluctuation_v_m": 1.0,
        "rotation_deg": 0.0,
        "method": "cholesky",
        "averaging": "point",
        "correlation_space": "gaussian",
        "nugget": 0.0,
        "lower_over_mean": 0.2,
        "upper_over_mean": 3.0,
        "sample": tuple(np.random.default_rng(3).gamma(4.0, 5.0, 60)),
        "matern_nu": 1.5,
    } | changes)  # fmt: skip


def lattice() -> np.ndarray:
    x, y = np.meshgrid(SPACING * np.arange(COLUMNS), SPACING * np.arange(ROWS))
    return np.column_stack([x.ravel(), y.ravel()])


def lags() -> list[tuple[int, int]]:
    """Columns and rows of lags up to 2 theta along x, along y and along both diagonals."""
    along_x = [(k, 0) for k in range(1, 17)]
    along_y = [(0, k) for k in range(1, 9)]
    return along_x + along_y + [(k, k) for k in range(1, 9)] + [(k, -k) for k in range(1, 9)]


def in_standard_errors(samples: np.ndarray, asked: np.ndarray) -> np.ndarray:
    """Samples of shape (realisations, ...) against asked values of shape (...)."""
    error = samples.std(axis=0, ddof=1) / np.sqrt(len(samples))
    return (samples.mean(axis=0) - asked) / error


def shifted(values: np.ndarray, columns: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
    """Both ends of all pairs of lattice values, shape (realisations, rows, columns), a lag apart."""
    first = values[:, max(-rows, 0) : ROWS - max(rows, 0), : COLUMNS - columns]
    second = values[:, max(rows, 0) : ROWS - max(-rows, 0), columns:]
    return first, second


def physical_differences(values: np.ndarray, covariance: np.ndarray) -> dict[str, np.ndarray]:
    """Mean and variance of every point, covariance over lags, and variance of averages over boxes.

    Args:
        values: physical values, shape (realisations, points).
        covariance: asked, shape (points, points).

    Returns:
        differences in standard errors, by statistic.
    """
    excess = values - MEAN
    fields = excess.reshape(-1, ROWS, COLUMNS)
    index = np.arange(ROWS * COLUMNS).reshape(1, ROWS, COLUMNS)
    found = {
        "mean": in_standard_errors(values, np.full(values.shape[1], MEAN)),
        "variance": in_standard_errors(excess**2, np.diag(covariance)),
    }
    samples, asked = [], []
    for lag in lags():
        first, second = shifted(fields, *lag)
        samples.append(np.einsum("rij,rij->r", first, second) / first[0].size)
        asked.append(covariance[tuple(end.ravel() for end in shifted(index, *lag))].mean())
    found["covariance over lags"] = in_standard_errors(np.array(samples).T, np.array(asked))
    samples, asked = [], []
    for rows, columns in BOXES:
        split = (-1, ROWS // rows, rows, COLUMNS // columns, columns)
        averages = fields.reshape(split).mean(axis=(2, 4))
        samples.append((averages**2).mean(axis=(1, 2)))
        member = index.reshape(split[1:]).transpose(0, 2, 1, 3).reshape(-1, rows * columns)
        asked.append(np.mean([covariance[np.ix_(box, box)].mean() for box in member]))
    found["variance of box averages"] = in_standard_errors(np.array(samples).T, np.array(asked))
    return found


def normal_differences(z: np.ndarray, correlation: np.ndarray) -> dict[str, np.ndarray]:
    """Kurtosis of increments along x and y, and the variation of the variogram of one realisation.

    Args:
        z: standard-normal values, shape (realisations, points).
        correlation: asked, shape (points, points).

    Returns:
        differences in standard errors, by statistic.
    """
    fields = z.reshape(-1, ROWS, COLUMNS)
    index = np.arange(ROWS * COLUMNS).reshape(1, ROWS, COLUMNS)
    kurtosis, variation = [], []
    for lag in ((1, 0), (0, 1)):
        first, second = shifted(fields, *lag)
        increment = (second - first).reshape(len(z), -1)
        a, b = (end.ravel() for end in shifted(index, *lag))
        asked = (correlation[np.ix_(b, b)] - correlation[np.ix_(b, a)] - correlation[np.ix_(a, b)]
                 + correlation[np.ix_(a, a)])  # fmt: skip
        second_moment, fourth = (increment**2).mean(axis=1), (increment**4).mean(axis=1)
        # Delta method for a ratio of averages over realisations.
        ratio = fourth.mean() / second_moment.mean() ** 2
        influence = fourth / second_moment.mean() ** 2 - 2.0 * ratio * second_moment / second_moment.mean()
        kurtosis.append((ratio - 3.0) / (influence.std(ddof=1) / np.sqrt(len(z))))
        # A mean of squares of jointly normal increments of covariance D has the variance 2 sum D_ij^2 / n^2.
        relative = second_moment / np.diag(asked).mean()
        expected = 2.0 * np.mean(asked**2) / np.diag(asked).mean() ** 2
        squares = (relative - 1.0) ** 2
        variation.append((squares.mean() - expected) / (squares.std(ddof=1) / np.sqrt(len(z))))
    return {"kurtosis of increments": np.array(kurtosis), "variation of variograms": np.array(variation)}
