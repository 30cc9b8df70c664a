"""Every marginal distribution: positive, increasing, and with the asked mean and standard deviation."""

import pickle

import numpy as np
import pytest

from rfmpm.random_fields.marginals import MARGINALS

every_marginal = pytest.mark.parametrize("distribution", MARGINALS.values(), ids=MARGINALS)
every_spread = pytest.mark.parametrize("coefficient_of_variation", [0.01, 0.1, 0.25, 0.5, 0.75, 0.95])
MEAN = 20e3
SAMPLE = tuple(np.random.default_rng(3).gamma(4.0, 5.0, 60))
OWN = {"lower_over_mean": 0.2, "upper_over_mean": 5.0, "sample": SAMPLE}  # what some distributions need beside moments


def make(distribution, mean, coefficient_of_variation):
    return distribution.from_moments(mean, coefficient_of_variation, **{name: OWN[name] for name in distribution.needs})


@every_marginal
@every_spread
def test_mean_and_standard_deviation_by_quadrature(distribution, coefficient_of_variation):
    marginal = make(distribution, MEAN, coefficient_of_variation)
    # Trapezoids converge exponentially for smooth integrands; a sample's monotone curve bends sixty times, which costs
    # the cube of a step each, 1e-9. Beyond 14 the normal density is below 1e-43.
    z, step = np.linspace(-14.0, 14.0, 28_008, retstep=True)
    weight = step * np.exp(-0.5 * z**2) / np.sqrt(2.0 * np.pi)
    value = marginal.transform(z)
    mean = np.sum(weight * value)
    deviation = np.sqrt(np.sum(weight * (value - MEAN) ** 2))
    assert mean == pytest.approx(MEAN, rel=1e-8)
    assert deviation == pytest.approx(MEAN * coefficient_of_variation, rel=1e-8)


@every_marginal
@every_spread
def test_positive_and_increasing_far_into_both_tails(distribution, coefficient_of_variation):
    marginal = make(distribution, MEAN, coefficient_of_variation)
    value = marginal.transform(np.linspace(-12.0, 12.0, 20_001))
    assert np.all(value > 0.0)
    assert np.all(np.diff(value) >= 0.0)
    lower, upper = (getattr(marginal, bound, end) for bound, end in (("lower", 0.0), ("upper", np.inf)))
    assert np.all((value >= lower) & (value <= upper))
    # Strictly, but for values so close to a bound that floating point does not tell them from it.
    told = (value[:-1] > lower * (1.0 + 1e-9)) & (value[1:] < upper * (1.0 - 1e-9))
    assert np.all(np.diff(value)[told] > 0.0)
    assert told.sum() > 10_000
    assert np.all(np.isfinite(value))


@every_marginal
def test_the_unit_of_the_mean_is_the_unit_of_the_value(distribution):
    z = np.linspace(-4.0, 4.0, 9)
    in_pa = make(distribution, 20e3, 0.3).transform(z)
    in_kpa = make(distribution, 20.0, 0.3).transform(z)
    np.testing.assert_allclose(in_pa, 1e3 * in_kpa, rtol=1e-12)


@every_marginal
@pytest.mark.parametrize(
    ("mean", "coefficient_of_variation", "named"),
    [(0.0, 0.25, "mean"), (-1.0, 0.25, "mean"), (np.nan, 0.25, "mean"), (1.0, 0.0, "coefficient_of_variation")],
)
def test_moments_out_of_range_are_refused(distribution, mean, coefficient_of_variation, named):
    with pytest.raises(ValueError, match=named):
        make(distribution, mean, coefficient_of_variation)


@every_marginal
def test_a_marginal_keeps_shapes_and_travels_between_processes(distribution):
    marginal = make(distribution, MEAN, 0.3)
    z = np.linspace(-3.0, 3.0, 6).reshape(2, 3)
    value = marginal.transform(z)
    assert value.shape == (2, 3)
    assert np.shape(marginal.transform(np.array(0.5))) == ()
    again = pickle.loads(pickle.dumps(marginal))
    assert again == marginal
    assert np.array_equal(again.transform(z), value)
