"""What a sounding says: estimates against closed forms, invariances, and coverage on soundings of known theta."""

from math import inf

import numpy as np
import pytest

from rfmpm.columns import ColumnsError
from rfmpm.random_fields.correlation import CORRELATIONS
from rfmpm.random_fields.estimation import (
    HALF_CHI_SQUARED,
    choose_trend,
    distinct_correlations,
    estimate,
    likelihood,
    profile_interval,
    rank_correlations,
    vertical_correlation,
)
from rfmpm.random_fields.sounding import Sounding, read_sounding
from rfmpm.random_fields.variance_function import evenly_spaced, fit_variance_function

THETA, SPREAD = 0.5, 0.25


def synthetic(seed: int, length: float, spacing: float = 0.1, name: str = "markov_separable", gain: float = 0.0):
    depth = np.arange(0.5 * spacing, length, spacing)
    matrix = vertical_correlation(name, THETA, depth[:, None] - depth[None, :])
    z = np.linalg.cholesky(matrix + 1e-10 * np.eye(len(depth))) @ np.random.default_rng(seed).standard_normal(
        len(depth)
    )
    return Sounding(depth, np.exp(3.0 + gain * depth + SPREAD * z))


def test_the_likelihood_is_that_of_a_normal_density():
    from scipy.stats import multivariate_normal

    sounding = synthetic(1, 4.0)
    profile = likelihood(sounding, "markov_separable", "constant")
    k = int(np.argmax(profile.plain))
    correlation = vertical_correlation(
        "markov_separable", profile.theta[k], sounding.depth[:, None] - sounding.depth[None, :]
    )
    ones, logs = np.ones(len(sounding.depth)), np.log(sounding.value)
    mean = (ones @ np.linalg.solve(correlation, logs)) / (ones @ np.linalg.solve(correlation, ones))
    left = logs - mean
    variance = left @ np.linalg.solve(correlation, left) / len(left)
    expected = multivariate_normal(mean * ones, variance * correlation).logpdf(logs)
    # a spline through 48 values of theta; its error is far below the 1.92 that matters
    assert profile.plain[k] == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize("trend", ["constant", "linear"])
def test_the_restricted_likelihood_is_that_of_what_no_trend_changes(trend):
    from scipy.linalg import null_space
    from scipy.stats import multivariate_normal

    sounding = synthetic(1, 4.0)
    profile = likelihood(sounding, "markov_separable", trend)
    shape = np.vander(sounding.depth, 1 if trend == "constant" else 2)
    contrasts = null_space(shape.T).T
    best = int(np.argmax(profile.restricted))
    expected = []
    for k in (best, best + 300):
        correlation = vertical_correlation(
            "markov_separable", profile.theta[k], sounding.depth[:, None] - sounding.depth[None, :]
        )
        covariance = profile.variance[k] * contrasts @ correlation @ contrasts.T
        expected.append(
            multivariate_normal(np.zeros(len(contrasts)), covariance).logpdf(contrasts @ np.log(sounding.value))
        )
    found = profile.restricted[best + 300] - profile.restricted[best]
    # splines, and a nugget of 1e-9; the difference is of the order of one
    assert found == pytest.approx(expected[1] - expected[0], abs=3e-3)


def test_the_interval_is_where_the_likelihood_has_fallen_by_half_chi_squared():
    x = np.linspace(-10.0, 10.0, 20_001)
    interval = profile_interval(x, -0.5 * (x - 1.0) ** 2)
    assert interval == pytest.approx((1.0, 1.0 - 1.959964, 1.0 + 1.959964), abs=1.5e-3)  # one step of the grid
    assert pytest.approx(0.5 * 1.959964**2, abs=1e-6) == HALF_CHI_SQUARED
    assert profile_interval(x, x).high == inf
    assert profile_interval(x, -x).low == 0.0


@pytest.mark.parametrize("trend", ["constant", "linear"])
def test_units_scale_the_mean_and_metres_scale_theta(trend):
    sounding = synthetic(3, 10.0)
    first = estimate(sounding, "markov_separable", trend)
    other = estimate(Sounding(2.0 * sounding.depth, 1e3 * sounding.value), "markov_separable", trend)
    assert other.mean == pytest.approx(1e3 * first.mean, rel=1e-9)
    np.testing.assert_allclose(other.theta, 2.0 * np.array(first.theta), rtol=1e-9)
    np.testing.assert_allclose(other.coefficient_of_variation, first.coefficient_of_variation, rtol=1e-9)


def test_a_linear_trend_of_the_logarithm_does_not_change_what_it_leaves():
    flat, tilted = synthetic(4, 10.0), synthetic(4, 10.0, gain=0.3)
    first, other = (estimate(entry, "markov_separable", "linear") for entry in (flat, tilted))
    np.testing.assert_allclose(other.theta, first.theta, rtol=1e-9)
    assert other.coefficients[1] - first.coefficients[1] == pytest.approx(0.3, abs=1e-9)


def test_a_strong_trend_is_chosen_and_an_absent_one_is_not():
    assert choose_trend(synthetic(5, 20.0, gain=0.15), "markov_separable")[0] == "linear"
    chosen = [choose_trend(synthetic(seed, 20.0), "markov_separable")[0] for seed in range(10)]
    assert (
        chosen.count("constant") >= 8
    )  # BIC errs with probability P(chi2 > ln 200) = 0.02 if normal, more if correlated


def test_the_correlation_that_made_the_sounding_is_ranked_first():
    names = ["markov_separable", "gaussian"]  # as rough and as smooth as they come: others differ by less than chance
    for name in names:
        ranked = rank_correlations(synthetic(6, 15.0, name=name), "constant", names)
        assert [entry.correlation for entry in ranked] == [name, *set(names) - {name}]


def test_correlations_that_are_the_same_along_a_vertical_line_count_once():
    names = distinct_correlations()
    assert "markov_separable" in names
    assert "markov_ellipsoidal" not in names
    assert len(set(names)) == len(names) < len(CORRELATIONS)


def test_a_short_sounding_gives_an_open_interval():
    short = synthetic(2, 1.0)
    assert estimate(short, "markov_separable", "linear").theta.high == inf
    assert estimate(short, "markov_separable", "linear").coefficient_of_variation.high == inf


def test_the_variance_function_of_a_long_sounding_is_the_closed_form():
    fit = fit_variance_function(synthetic(7, 40.0), "markov_separable", "constant")
    x = 2.0 * fit.windows / fit.theta.value
    # Vanmarcke (1983): continuous window; the sum over points 0.1 m apart differs by less than a fifth of (0.1 / theta)
    closed = 2.0 * (np.exp(-x) - 1.0 + x) / x**2
    np.testing.assert_allclose(fit.fitted[5:], closed[5:], atol=0.2 * 0.1 / fit.theta.value)
    assert fit.theta.low < fit.theta.value < fit.theta.high
    assert fit.autocorrelation[0] == 1.0


def test_uneven_depths_are_interpolated():
    depth = np.sort(np.random.default_rng(1).uniform(0.0, 10.0, 80))
    even, values = evenly_spaced(Sounding(depth, np.exp(depth)))
    assert np.ptp(np.diff(even)) < 1e-12
    np.testing.assert_allclose(values, even, atol=1e-12)
    estimate(Sounding(depth, np.exp(np.sin(depth))), "markov_separable", "constant")  # needs no even spacing


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [10, 20])
def test_the_intervals_cover(ratio):
    """95 % intervals of 200 soundings; the profile likelihood is asymptotic, so that 90 % is asked of a short one."""
    count = 200
    covered = 0
    for seed in range(count):
        low, high = estimate(synthetic(seed, ratio * THETA), "markov_separable", "constant").theta[1:]
        covered += low <= THETA <= high
    assert covered / count > 0.90 - 4.0 * np.sqrt(0.9 * 0.1 / count)
    assert covered / count < 0.99


# --- files


@pytest.fixture
def write(tmp_path):
    def written(text: str, name: str = "cpt.csv"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return written


def test_a_sounding_is_read_by_increasing_depth_with_a_factor(write):
    rows = "".join(f"{0.5 * k},{10 + k}\n" for k in range(12, 0, -1))
    sounding = read_sounding(write("depth_m,value_kpa\n" + rows), factor=0.1)
    np.testing.assert_allclose(sounding.depth, 0.5 * np.arange(1, 13))
    np.testing.assert_allclose(sounding.value, 0.1 * (10 + np.arange(1, 13)), rtol=1e-12)


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("1,2\n", "holds 1 values: must be at least 10"),
        ("".join(f"{k},{k}\n" for k in range(12)), "line 2: value 0: must be greater than 0"),
        ("3,1\n" + "".join(f"{k},1\n" for k in range(12)), "line 2 and line 6: both at a depth of 3 m"),
        ("1,nan\n", "line 2: value = 'nan'"),
        ("".join(f"{k},{k}\n" for k in range(1, 4002)), "holds 4001 values: must be at most 2000; take one in 3"),
        ("".join(f"{k},3\n" for k in range(1, 13)), "one and the same value at all depths"),
    ],
)
def test_bad_soundings_are_refused_by_line(write, rows, said):
    with pytest.raises(ColumnsError, match=said):
        read_sounding(write("depth,value\n" + rows))


GEF = """#GEFID = 1, 1, 0
#COLUMN = 2
#COLUMNINFO = 1, m, sondeertrajectlengte, 1
#COLUMNINFO = 2, MPa, conusweerstand, 2
#COLUMNSEPARATOR = ;
#RECORDSEPARATOR = !
#COMPANYID = made for this test
#FILEDATE = 2026, 1, 1
#PROJECTID = CPT, 1
#TESTID = 1
#REPORTCODE = GEF-CPT-Report, 1, 1, 2, -
#STARTDATE = 2026, 1, 1
#XYID = 31000, 100000, 400000
#ZID = 31000, 0.0
#EOH =
"""


def test_a_gef_file_gives_cone_resistance_in_kpa(write):
    pytest.importorskip("pygef")
    rows = "".join(f"{0.02 * k:.2f};{1.0 + 0.1 * (k % 3):.3f}!\n" for k in range(1, 40))
    sounding = read_sounding(write(GEF + rows, "cpt.gef"))
    assert len(sounding.depth) == 39
    np.testing.assert_allclose(sounding.value[:3], [1100.0, 1200.0, 1000.0])


def test_a_gef_file_without_a_reader_says_what_to_install(write, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pygef", None)
    with pytest.raises(ModuleNotFoundError, match=r"rfmpm\[gef\]"):
        read_sounding(write(GEF, "cpt.gef"))
