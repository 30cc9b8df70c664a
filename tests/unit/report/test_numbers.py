"""The numbers behind the report."""

import json

import numpy as np
import pytest
from synthetic import make_ensemble, make_study

from rfmpm import estimators
from rfmpm.mpm.scene import toe_x
from rfmpm.report import numbers as numbers_of_report
from rfmpm.report import summary_lines
from rfmpm.report.numbers import analyse, as_json


@pytest.fixture(scope="module")
def study():
    return make_study()


def test_estimates_are_those_of_the_estimators(study):
    ensemble = make_ensemble(study, failed=(5, 40), censored=(7,))
    numbers = analyse(ensemble, study)
    run_out = ensemble["run_out"].values
    censored = np.arange(64) == 7
    expected = estimators.exceedance(run_out, 5.0, censored)
    assert numbers.answer == numbers.exceedance
    for name in ("value", "lower", "upper", "n"):
        assert getattr(numbers.exceedance, name) == getattr(expected, name)
    assert numbers.mean_run_out.value == pytest.approx(np.nanmean(run_out), rel=1e-12)  # identity
    assert (numbers.held, numbers.used, numbers.completed, numbers.censored) == (64, 64, 62, 1)
    assert numbers.statuses == {"ok": 62, "diverged": 2}
    assert numbers.reasons[1] == (40, "diverged", "energy grew at step 4040")
    assert numbers.cost["computing"] == pytest.approx(ensemble["wall_time"].values.sum(), rel=1e-12)  # identity
    assert numbers.cost["elapsed"] == 750.0


def test_rows_beyond_a_gap_are_not_used(study):
    ensemble = make_ensemble(study, n=20)
    holed = ensemble.isel(realisation=[3, 0, 1, 2, 5, 6])
    numbers = analyse(holed, study)
    assert (numbers.held, numbers.used) == (6, 4)
    assert numbers.mean_run_out.value == ensemble["run_out"].values[:4].mean()


def test_pictured_are_median_95th_percentile_and_worst(study):
    ensemble = make_ensemble(study, n=40, failed=(3,))
    run_out = ensemble["run_out"].values
    order = np.argsort(run_out)  # NaN last
    chosen = analyse(ensemble, study).pictured
    assert [name for name, _, _ in chosen] == ["median", "95th percentile", "worst"]
    assert [index for _, index, _ in chosen] == [order[19], order[37], order[38]]  # ranks 20, 38 and 39 of 39
    assert chosen[2][2] == np.nanmax(run_out)


def test_one_realisation_is_pictured_once(study):
    assert [name for name, _, _ in analyse(make_ensemble(study, n=1), study).pictured] == [
        "median, 95th percentile, worst"
    ]


def test_inundation_falls_from_the_toe_and_matches_a_count(study):
    ensemble = make_ensemble(study, failed=(5, 40))
    numbers = analyse(ensemble, study)
    band = numbers.inundation
    depth = ensemble["final_surface"].sel(x=toe_x(study) + band.at[20], method="nearest").values
    assert band.at[0] == pytest.approx(0.125, abs=1e-12)  # identity: half a bin beyond the toe
    assert band.value[20] == np.mean(depth[~np.isnan(depth)] >= 0.1)
    assert np.all(np.diff(band.value) <= 0.0)
    assert np.all((band.lower <= band.value) & (band.value <= band.upper))
    assert band.upper[-1] == estimators.exceedance(ensemble["run_out"].values, 1e9).upper  # the two failed count


def test_inundation_does_not_depend_on_how_many_rows_are_looked_at_together(study, monkeypatch):
    ensemble = make_ensemble(study, failed=(5, 40))
    expected = analyse(ensemble, study).inundation
    monkeypatch.setattr(numbers_of_report, "BLOCK", 7)
    np.testing.assert_array_equal(analyse(ensemble, study).inundation.value, expected.value)


def test_curves_of_many_realisations_have_few_points_which_are_those_of_all(study, monkeypatch):
    ensemble = make_ensemble(study, failed=(5, 40))
    every = analyse(ensemble, study)
    monkeypatch.setattr(numbers_of_report, "MOST_POINTS", 10)
    few = analyse(ensemble, study)
    assert few.running_mean.at.tolist() == few.running_exceedance.at.tolist() == [1, 8, 15, 22, 29, 36, 43, 50, 57, 64]
    assert few.curve.at.size == 12  # the two ends stand beside the steps
    for name in ("running_mean", "running_exceedance", "curve"):
        band, whole = getattr(few, name), getattr(every, name)
        at = np.searchsorted(whole.at, band.at)
        np.testing.assert_array_equal(whole.at[at], band.at)
        np.testing.assert_array_equal(band.value, whole.value[at])
        np.testing.assert_array_equal(band.lower, whole.lower[at])


def test_without_surface_there_is_no_inundation():
    study = make_study(**{"output.surface_bin_m": None})
    assert analyse(make_ensemble(study, n=3), study).inundation is None


def test_a_bin_without_soil_is_dry_not_unknown(study):
    ensemble = make_ensemble(study, n=3)
    ensemble["final_surface"] = ensemble["final_surface"].where(ensemble["final_surface"] > 0.0)
    assert analyse(ensemble, study).inundation.value[-1] == 0.0


@pytest.mark.parametrize("options", [{"n": 1}, {"n": 4, "failed": range(4)}, {"n": 4, "still": range(4)}])
def test_json_has_no_value_that_json_lacks(study, options):
    text = json.dumps(as_json(analyse(make_ensemble(study, **options), study)), allow_nan=False)
    assert json.loads(text)["exceedance"]["confidence"] == 0.95


def test_summary_lines(study):
    ensemble = make_ensemble(study, failed=(5, 40), censored=(7,))
    first, second, third = summary_lines(ensemble, study)
    assert first == "mean run-out      6.88 m  (95 % interval 6.0 to 7.7 m, 64 realisations)"
    assert second == "P(run-out > 5 m)  0.71    (95 % interval 0.56 to 0.82, 1 censored counted as exceeding)"
    assert third.startswith("cost              14.5 min  (computing time, 13.6 s per realisation; 12.5 min from start")
    assert third.endswith("2 of 64 failed)")


def test_summary_lines_of_nothing(study):
    first, second, _ = summary_lines(make_ensemble(study, n=2, failed=(0, 1)), study)
    assert first == "mean run-out      unknown  (no interval, 2 realisations)"
    assert second == "P(run-out > 5 m)  unknown  (95 % interval 0 to 1)"
