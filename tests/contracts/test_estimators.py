"""Every listed estimator: unbiased on problems with known answers, intervals that cover, sane at the extremes.

Coverage: 500 campaigns with fixed seeds (200 where coefficients are fitted); 0.95 but for 3.3 standard errors of such a
measurement, and not above where an interval does not set out to be conservative (probabilities do while counts are few:
Clopper-Pearson for plain Monte Carlo, allowances for others). Bias: with as many cases as here a bias of 2 standard
errors comes about by chance, so 3.5 are allowed (two-sided chance of one false alarm among 50 cases: 2 %).
"""

import numpy as np
import pytest
from model_problem import MAKERS, Campaign, Model, repeat

from rfmpm.estimators import ESTIMATORS, Exceedances, Question, Rows, Value

REPEATS, FITTED_REPEATS = 500, 200  # of estimators that are quick, and of those that fit coefficients
STANDARD_ERRORS = 3.5
NORMAL, SKEWED = Model(), Model(is_skewed=True)


def asked(name: str, **width) -> tuple[Model, Question, float]:
    """Model, question and true answer of a case."""
    if name == "mean":
        return NORMAL, Question("run_out", **width), NORMAL.mean()
    if name == "skewed mean":
        return SKEWED, Question("run_out", **width), SKEWED.mean()
    if name == "quantile":
        return NORMAL, Question("run_out", "quantile", probability=0.9, **width), NORMAL.quantile(0.9)
    probability = {"probability": 0.15, "small probability": 0.02}[name]
    return NORMAL, Question("run_out", "exceedance", limit=NORMAL.quantile(1.0 - probability), **width), probability


def check(name: str, question: str, n: int | None, repeats: int = REPEATS, **width):
    repeats = min(repeats, FITTED_REPEATS) if name.startswith(("control_variate", "two_phase")) else repeats
    model, wanted, truth = asked(question, **width)
    found = repeat(name, model, wanted, n, repeats)
    bias = abs(found.value.mean() - truth) / found.value.std(ddof=1)
    chance = STANDARD_ERRORS / np.sqrt(repeats)
    # a quantile and an estimate after stopping on its width have a bias of the order 1 / n: see `Staged`
    assert bias < chance + (0.25 if question == "quantile" or n is None else 0.0)
    # standard errors of a measured coverage of 0.95; among 50 cases one false alarm has a chance of 5 %
    scatter = 3.3 * np.sqrt(0.05 * 0.95 / repeats)
    assert found.coverage(truth) >= 0.95 - scatter
    if question == "mean":
        assert found.coverage(truth) <= 0.95 + scatter
    return found


def test_every_entry_has_a_model_problem():
    own_tests = {"stratified", "subset_simulation"}  # rare events, whose realisations follow from those before them
    assert {name.split(",")[0] for name in MAKERS} == set(ESTIMATORS) - own_tests


@pytest.mark.slow
@pytest.mark.parametrize("question", ["mean", "skewed mean", "probability", "small probability"])
@pytest.mark.parametrize("name", MAKERS)
def test_fixed_number_is_unbiased_and_covers(name, question):
    check(name, question, 128)


@pytest.mark.slow
@pytest.mark.parametrize(("question", "width"), [("mean", 0.4), ("probability", 0.05)])
@pytest.mark.parametrize("name", MAKERS)
def test_stopping_on_the_width_is_unbiased_and_covers(name, question, width):
    found = check(name, question, None, half_width=width)
    assert np.all(found.upper - found.lower <= 2.0 * width)


@pytest.mark.slow
@pytest.mark.parametrize("name", MAKERS)
def test_quantile_is_covered(name):
    check(name, "quantile", 128, repeats=100)


@pytest.mark.parametrize("name", ["monte_carlo", "replicated", "multilevel"])
def test_is_unbiased_and_covers_in_short(name):
    check(name, "mean", 64, repeats=100)


# What a campaign does


@pytest.mark.parametrize("name", MAKERS)
@pytest.mark.parametrize("n", [None, 50])
def test_following_the_plan_passes_the_same_stages(name, n):
    model, question, _ = asked("mean", **({} if n else {"half_width": 0.9}))
    campaign = model.campaign(3, is_design=name == "replicated")
    rows, planned = (way(MAKERS[name](question, campaign, n)) for way in (campaign.run, campaign.follow))
    np.testing.assert_array_equal(rows.level, planned.level)
    np.testing.assert_array_equal(rows.index, planned.index)
    assert MAKERS[name](question, campaign, n).plan(rows) == []


@pytest.mark.parametrize("name", MAKERS)
def test_plan_names_what_is_missing_of_the_stage(name):
    model, question, _ = asked("mean")
    campaign = model.campaign(1)
    estimator = MAKERS[name](question, campaign, 64)
    rows = campaign.rows(estimator.first_numbers())
    holed = rows.where((rows.level > 0) | (rows.index != 5))
    assert [(run.level, run.indices) for run in estimator.plan(holed)] == [(0, range(5, 6))]
    assert estimator.plan(holed) == estimator.plan(holed)


@pytest.mark.parametrize("name", MAKERS)
def test_the_most_realisations_end_a_campaign_unanswered(name):
    model, question, _ = asked("mean", half_width=1e-6, at_most=128)
    campaign = model.campaign(2)
    rows = campaign.run(MAKERS[name](question, campaign, None))
    assert np.sum(rows.level == 0) == 128


@pytest.mark.parametrize("name", [name for name in MAKERS if "alone" not in name and name != "monte_carlo"])
def test_costs_less_than_plain_monte_carlo(name):
    model, question, _ = asked("mean", half_width=0.4)
    campaign = model.campaign(4, is_design=name == "replicated")
    plain = campaign.run(MAKERS["monte_carlo"](question, campaign, None))
    assert campaign.run(MAKERS[name](question, campaign, None)).work.sum() < 0.8 * plain.work.sum()


# Extremes


def outcome_of(name: str, fine, coarse=None, question="probability", is_censored=None):
    """Estimate from given values on the levels."""
    levels = [np.asarray(fine, float), np.asarray(fine if coarse is None else coarse)]
    campaign = Campaign(NORMAL.campaign(0, n=1024).components, levels)
    numbers = (len(fine), len(campaign.levels[1]))
    censored = None if is_censored is None else np.tile(is_censored, 2)
    _, asks, _ = asked(question)
    return MAKERS[name](asks, campaign, max(len(fine), 1)).estimate(campaign.rows(numbers, censored))


@pytest.mark.parametrize("name", MAKERS)
@pytest.mark.parametrize(("value", "expected"), [(0.0, 0.0), (99.0, 1.0)])
@pytest.mark.parametrize("n", [16, 64])
def test_never_and_always_have_intervals_with_width(name, value, expected, n):
    for coarse in (np.full(n, value), np.full(4 * n, value)):
        found = outcome_of(name, np.full(n, value), coarse)
        assert found.value == expected
        assert 0.0 <= found.lower <= expected <= found.upper <= 1.0
        assert found.upper - found.lower > 2.0 / n


@pytest.mark.parametrize("name", MAKERS)
@pytest.mark.parametrize("question", ["mean", "probability", "quantile"])
def test_one_realisation(name, question):
    found = outcome_of(name, [11.0] if name != "replicated" else np.full(16, 11.0), question=question)
    if question == "probability":
        assert 0.0 <= found.lower <= found.upper <= 1.0
        assert found.upper > 0.15
    elif name != "replicated" or question == "mean":
        assert (found.lower, found.upper) == (-np.inf, np.inf)


@pytest.mark.parametrize("name", MAKERS)
@pytest.mark.parametrize("question", ["mean", "probability", "quantile"])
def test_nothing_and_all_failed_say_nothing(name, question):
    for n in (0, 32):
        found = outcome_of(name, np.full(n, np.nan), question=question)
        assert np.isnan(found.value)
        assert (found.lower, found.upper) == ((0.0, 1.0) if question == "probability" else (-np.inf, np.inf))
        assert (f"{n} failed of {n}" in found.note) == (n > 0)


@pytest.mark.parametrize("name", MAKERS)
def test_all_censored_exceed(name):
    found = outcome_of(name, np.full(64, 3.0), np.full(256, 3.0), is_censored=None)
    assert found.value == 0.0
    campaign = Campaign(Model().campaign(0).components, [np.full(64, 3.0), np.full(64, 3.0)])
    _, question, _ = asked("probability")
    found = MAKERS[name](question, campaign, 64).estimate(campaign.rows((64, 64), np.ones(128, bool)))
    assert found.value == 1.0
    assert "64 censored" in found.note


@pytest.mark.parametrize("name", MAKERS)
def test_identical_levels(name):
    campaign = NORMAL.campaign(15)
    fine, coarse = campaign.levels[0][:64], campaign.levels[0][:512]
    found = outcome_of(name, fine, coarse, "mean")
    if name in ("multilevel", "control_variate, levels alone"):
        assert found.value == pytest.approx(coarse.mean(), rel=1e-12)  # identity
    assert found.lower < 10.0 < found.upper
    assert outcome_of(name, fine, coarse).lower >= 0.0


@pytest.mark.parametrize("name", MAKERS)
def test_failed_rows_are_bounds_of_a_probability(name):
    campaign = NORMAL.campaign(6)
    fine, coarse = campaign.levels[0][:128], campaign.levels[1][:512]
    holed = np.where(np.arange(128) % 10 == 3, np.nan, fine)
    complete, found = outcome_of(name, fine, coarse), outcome_of(name, holed, coarse)
    assert found.lower <= complete.value <= found.upper
    assert found.upper - found.lower > complete.upper - complete.lower
    assert "13 failed of 128 counted both ways" in found.note
    assert "13 failed of 128 left out" in outcome_of(name, holed, coarse, "mean").note


@pytest.mark.parametrize(("name", "question"), [("multilevel", "mean"), ("control_variate", "probability")])
def test_failures_on_coarser_cells_do_not_bias(name, question):
    model, wanted, truth = asked(question)
    values = []
    for seed in range(40):
        campaign = model.campaign(seed)
        fails = campaign.levels[1] > model.quantile(0.7)  # the long run-outs break down on coarse cells
        campaign.levels[1][fails] = np.nan
        found = MAKERS[name](wanted, campaign, 64).estimate(campaign.rows((64, 256)))
        values.append(found.value)
    assert "failed on coarser cells" in found.note
    assert abs(np.mean(values) - truth) < STANDARD_ERRORS * np.std(values) / np.sqrt(len(values))


# Whole curves


@pytest.mark.parametrize("name", MAKERS)
def test_curve_falls_within_its_bands(name):
    campaign = NORMAL.campaign(7)
    _, question, _ = asked("mean")
    band = MAKERS[name](question, campaign, 64).exceedance_curve(campaign.rows((64, 256)))
    for edge in (band.lower, band.value, band.upper, band.simultaneous_lower, band.simultaneous_upper):
        assert np.all(np.diff(edge) <= 1e-12)
        assert np.all((edge >= 0.0) & (edge <= 1.0))
    assert np.all(band.simultaneous_lower <= band.lower + 1e-12)
    assert np.all(band.lower <= band.value + 1e-12)
    assert np.all(band.value <= band.upper + 1e-12)
    assert np.all(band.upper <= band.simultaneous_upper + 1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("name", MAKERS)
def test_simultaneous_band_holds_the_whole_curve(name):
    _, question, _ = asked("mean")
    probabilities = np.linspace(0.95, 0.05, 19)
    limits, repeats = np.array([NORMAL.quantile(1.0 - p) for p in probabilities]), 200
    held = 0
    for seed in range(repeats):
        campaign = NORMAL.campaign(seed, is_design=name == "replicated")
        band = MAKERS[name](question, campaign, 128).exceedance_curve(campaign.rows((128, 640)), limits)
        held += np.all((band.simultaneous_lower <= probabilities) & (probabilities <= band.simultaneous_upper))
    # 3.3 standard errors as above: at least 0.899; eight replicates of a design give 0.915
    assert held / repeats >= 0.95 - 3.3 * np.sqrt(0.05 * 0.95 / repeats)


@pytest.mark.parametrize("name", MAKERS)
def test_expectations_of_the_curve_and_of_the_question_agree(name):
    campaign = NORMAL.campaign(8)
    _, question, _ = asked("probability")
    estimator, rows = MAKERS[name](question, campaign, 64), campaign.rows((64, 256))
    found, estimate = estimator.expectation(rows, Exceedances(np.array([question.limit]))), estimator.estimate(rows)
    assert (found.value[0], found.lower[0], found.upper[0]) == pytest.approx(
        (estimate.value, estimate.lower, estimate.upper), rel=1e-12
    )
    assert estimator.expectation(rows, Value()).value.shape == (1,)


def test_numbers_that_cannot_be():
    question = Question("run_out")
    empty = Rows(*(np.zeros(0, kind) for kind in (int, int, float, bool, float)))
    for name, maker in MAKERS.items():
        with pytest.raises(ValueError, match="at least 1"):
            maker(question, NORMAL.campaign(0, n=16), 0)
        with pytest.raises(ValueError, match="half width"):
            maker(question, NORMAL.campaign(0, n=16), None)
        assert MAKERS[name](question, NORMAL.campaign(0, n=16), 8).plan(empty)
