"""Local average subdivision: its published artefacts without stretching, and little of them with it."""

import numpy as np
import pytest

from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.methods.local_average_subdivision import LocalAverageSubdivision
from rfmpm.random_fields.methods.subdivision import grow, stage_tables

SPACING = 0.125


class CellAverage:
    """Covariance between averages over square cells of an ellipsoidal Markov field of unit variance."""

    theta_h, theta_v, rotation, separable = 6.0, 0.5, 0.0, False

    def rho(self, lag_x, lag_y):
        # The lag between two places in cells has a triangular density; four Gauss points on each half of it.
        node, weight = np.polynomial.legendre.leggauss(4)
        offset = SPACING * np.concatenate([0.5 * (node - 1.0), 0.5 * (node + 1.0)])
        weight = 0.5 * np.tile(weight, 2) * (1.0 - np.abs(offset) / SPACING)
        kernel = CORRELATIONS["markov_ellipsoidal"](self.theta_h, self.theta_v)
        return sum(
            a * b * kernel.rho(lag_x + along, lag_y + up)
            for a, along in zip(weight, offset, strict=True)
            for b, up in zip(weight, offset, strict=True)
        )


def variance_map(correlation, first_shape: tuple[int, int], stages: int) -> np.ndarray:
    """Variance of every cell of the last stage over the asked one, from the linear map."""
    first, estimate, spread = stage_tables(correlation, np.full(2, SPACING), np.array(first_shape), stages)
    lower = np.linalg.cholesky(first)

    def cells(stage: int, child: int | None, unit: np.ndarray) -> np.ndarray:
        field = unit if child is None else np.zeros_like(unit)
        for later in range(stage, stages):
            new = np.zeros((*field.shape, 3))
            if later == stage and child is not None:
                new[..., child] = unit
            field = grow(field, new, estimate[later], spread[later])
        return field

    variance = sum(cells(0, None, column.reshape(first_shape)) ** 2 for column in lower.T)
    for stage in range(stages):
        shape = np.array(first_shape) * 2**stage
        for place in range(np.prod(shape)):
            unit = np.zeros(shape)
            unit.ravel()[place] = 1.0
            variance = variance + sum(cells(stage, child, unit) ** 2 for child in range(3))
    zero = np.zeros(1)
    return variance / correlation.rho(zero, zero)[0]


@pytest.mark.slow
def test_the_variance_map_at_ratio_12_has_the_published_pattern():
    """-26 to +22 % was found with Fenton's own program on 120 x 40 cells of 0.125 m; a percent is its reading error."""
    variance = variance_map(CellAverage(), (5, 15), 3)
    assert variance.shape == (40, 120)
    assert variance.min() - 1.0 == pytest.approx(-0.26, abs=0.01)
    assert variance.max() - 1.0 == pytest.approx(0.22, abs=0.01)


def test_stretching_brings_the_error_within_a_twentieth():
    x, y = np.meshgrid(SPACING * np.arange(60), SPACING * np.arange(20))
    points = np.column_stack([x.ravel(), y.ravel()])
    correlation = CORRELATIONS["markov_ellipsoidal"](6.0, 0.5)
    stretched = LocalAverageSubdivision.prepare(correlation, points)
    plain = LocalAverageSubdivision.prepare(correlation, points, is_stretched=False)
    assert stretched.stretch.tolist() == [12, 1]
    assert stretched.error < 0.05 < 0.2 < plain.error
    assert np.all(np.abs(stretched.variance_range - 1.0) < 0.05)


def test_children_average_to_their_parents_at_every_stage():
    correlation = CORRELATIONS["markov_separable"](1.0, 1.0)
    _, estimate, spread = stage_tables(correlation, np.full(2, SPACING), np.array([3, 5]), 1)
    rng = np.random.default_rng(5)
    parents = rng.standard_normal((3, 5))
    children = grow(parents, rng.standard_normal((3, 5, 3)), estimate[0], spread[0])
    means = children.reshape(3, 2, 5, 2).mean(axis=(1, 3))
    np.testing.assert_allclose(means, parents, rtol=0, atol=1e-14)  # identity


def test_the_window_moves_the_field_and_nothing_else():
    x, y = np.meshgrid(SPACING * np.arange(40), SPACING * np.arange(30))
    points = np.column_stack([x.ravel(), y.ravel()])
    record = LocalAverageSubdivision.prepare(CORRELATIONS["markov_ellipsoidal"](1.0, 1.0), points)
    xi = np.random.default_rng(6).standard_normal(LocalAverageSubdivision.n_variables(record))
    fields = []
    for place in (-9.0, 9.0):  # the first and the last window
        xi[-2:] = place
        fields.append(LocalAverageSubdivision.transform(record, xi).reshape(30, 40))
    down, across = record.windows - 1
    assert down > 0
    np.testing.assert_array_equal(fields[0][down:, across:], fields[1][: 30 - down, : 40 - across])
