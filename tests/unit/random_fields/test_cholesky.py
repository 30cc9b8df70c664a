import os
import subprocess
import sys

import numpy as np
import pytest

from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.methods.cholesky import Cholesky


def lattice(columns: int, rows: int, spacing: float) -> np.ndarray:
    x, y = np.meshgrid(np.arange(columns) * spacing, np.arange(rows) * spacing)
    return np.column_stack([x.ravel(), y.ravel()])


def covariance(correlation, points):
    lag = points[:, None] - points[None, :]
    return correlation.rho(lag[..., 0], lag[..., 1])


@pytest.mark.parametrize("kernel", CORRELATIONS.values(), ids=CORRELATIONS)
def test_factor_is_lower_and_exact_up_to_its_nugget(kernel):
    # More points than one block row, not a multiple of it.
    points = lattice(21, 10, 0.5)
    correlation = kernel(6.0, 1.0, 0.4)
    lower, nugget = Cholesky.prepare(correlation, points)
    assert np.array_equal(lower, np.tril(lower))
    assert lower.flags.c_contiguous
    asked = covariance(correlation, points) + nugget * np.eye(len(points))
    np.testing.assert_allclose(lower @ lower.T, asked, rtol=0, atol=1e-12)


def test_a_well_conditioned_matrix_gets_no_nugget():
    record = Cholesky.prepare(CORRELATIONS["markov_separable"](6.0, 1.0), lattice(20, 10, 0.25))
    assert record.nugget == 0.0


def test_a_singular_matrix_gets_the_smallest_nugget_that_factors():
    points, correlation = lattice(20, 20, 0.05), CORRELATIONS["gaussian"](6.0, 6.0)
    record = Cholesky.prepare(correlation, points)
    assert 0.0 < record.nugget <= 1e-10
    with pytest.raises(np.linalg.LinAlgError):
        np.linalg.cholesky(covariance(correlation, points) + 0.01 * record.nugget * np.eye(len(points)))


def test_coincident_points_get_one_value():
    points = lattice(10, 10, 0.5)
    points = np.concatenate([points, points[:7]])
    record = Cholesky.prepare(CORRELATIONS["markov_ellipsoidal"](6.0, 1.0), points)
    field = Cholesky.transform(record, np.random.default_rng(0).standard_normal(len(points)))
    # Four standard deviations of the difference that the largest nugget allows.
    np.testing.assert_allclose(field[100:], field[:7], rtol=0, atol=4.0 * np.sqrt(2e-10))


def test_what_is_not_a_correlation_is_refused():
    class Wave:
        theta_h = theta_v = 1.0
        rotation = 0.3

        def rho(self, lag_x, lag_y):
            return np.where(np.hypot(lag_x, lag_y) < 1.0, 1.0, -0.5)

    with pytest.raises(
        ValueError, match=r"scale_of_fluctuation_v_m = 1, rotation_deg = 17\.\d+ .* not positive definite"
    ):
        Cholesky.prepare(Wave(), lattice(5, 5, 0.7))


@pytest.mark.parametrize(
    ("part", "other"),
    [
        ("lower", np.asfortranarray),
        ("lower", lambda lower: lower.astype(">f8")),
        ("nugget", lambda nugget: np.array("0")),
    ],
)
def test_a_record_of_another_layout_or_type_is_not_intact(part, other):
    points = lattice(5, 5, 0.5)
    record = Cholesky.prepare(CORRELATIONS["markov_separable"](6.0, 1.0), points)
    assert not Cholesky.is_intact(record._replace(**{part: other(getattr(record, part))}), points)


MAKE_A_FIELD = """
import hashlib, numpy as np
from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.methods.cholesky import Cholesky
rng = np.random.default_rng(0)
record = Cholesky.prepare(CORRELATIONS["markov_separable"](6.0, 1.0), rng.uniform(0.0, 10.0, (700, 2)))
print(hashlib.sha256(Cholesky.transform(record, rng.standard_normal(700)).tobytes()).hexdigest())
"""


def test_bits_do_not_depend_on_the_number_of_blas_threads():
    names = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
    bits = {
        subprocess.run(
            [sys.executable, "-c", MAKE_A_FIELD],
            env=os.environ | dict.fromkeys(names, threads),
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for threads in ("1", "2", "4")
    }
    assert len(bits) == 1
