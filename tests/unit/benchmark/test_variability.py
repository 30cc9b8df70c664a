"""The random-field study: its combinations, what it makes of known rows, how it goes on, and its page."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from rfmpm import campaign_status, load_study
from rfmpm.benchmark.variability import campaigns
from rfmpm.benchmark.variability.campaigns import Grid, cells, run_in_rounds
from rfmpm.benchmark.variability.contrasts import (
    against,
    against_uniform,
    correlations,
    exceeds,
    main_effects,
    mean_of,
    probability_beyond,
)
from rfmpm.benchmark.variability.document import DATASET, run
from rfmpm.benchmark.variability.findings import crest_lost, findings, span, standing, verdict
from rfmpm.benchmark.variability.summary import KEPT, QUANTITIES, each_cell, summarise
from rfmpm.benchmark.variability.uniform import add_uniform
from rfmpm.results import open_ensemble
from rfmpm.variables import STATUS

COARSE = Path(__file__).parents[2] / "robustness" / "coarse.toml"
GRID = Grid((0.1, 0.5), (1.0, 2.0), (1.0, 6.0))
N = 40


def rows_of(run_out, *, lost=(), failed=()) -> xr.Dataset:
    """Rows of a campaign with these run-outs; retrogression half of it, volume twice; some lose the crest or fail."""
    run_out = np.array(run_out, float)
    run_out[list(failed)] = np.nan
    flags = np.zeros(run_out.size)
    flags[list(lost)] = 1.0
    status = np.zeros(run_out.size, "int8")
    status[list(failed)] = STATUS["diverged"]
    columns = {
        "run_out": run_out,
        "run_out_censored": np.zeros(run_out.size),
        "retrogression_distance": 0.5 * run_out,
        "retrogression_censored": flags,
        "failure_volume": 2.0 * run_out,
        "block_count": np.ones(run_out.size),
        "status": status,
        "wall_time": np.full(run_out.size, 0.5),
    }
    data = {name: ("realisation", values) for name, values in columns.items()}
    return xr.Dataset(data, {"realisation": np.arange(run_out.size)}, {"seed": 1, "study": "toy"})


@pytest.fixture
def toy() -> xr.Dataset:
    """Isotropic slopes run 10 m but for chance; a ratio of 6 adds 1 m for the small variation, else nothing."""
    rng = np.random.default_rng(5)
    chance, other = rng.normal(0.0, 2.0, N), rng.normal(0.0, 0.1, N)
    isotropic, longer = 10.0 + chance, 11.0 + chance + other
    stands = np.where(np.arange(N) < 10, 0.0, isotropic)
    of = {
        (0, 0): rows_of(isotropic),
        (0, 1): rows_of(longer, lost=range(30)),
        (1, 0): rows_of(stands),
        (1, 1): rows_of(stands, failed=[39]),
    }
    found = summarise(GRID, {(i, j, k): of[i, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)})
    found = found.assign_coords(strength=["mean", "cautious"])
    found["uniform_cohesion"] = (("strength", "coefficient_of_variation"), [[20.0, 20.0], [17.0, 8.0]])
    for name in QUANTITIES:
        found[f"{name}_uniform"] = (("strength", "coefficient_of_variation"), [[10.0, 10.0], [14.0, 30.0]])
    return found


def test_horizontal_scale_is_the_ratio_times_the_vertical_one():
    found = cells(load_study(COARSE), Grid((0.1, 0.3), (0.5, 2.0), (1.0, 12.0)))
    fields = [cell.study.random_field["cohesion"] for cell in found]
    assert [(f.coefficient_of_variation, f.scale_of_fluctuation_v_m, f.scale_of_fluctuation_h_m) for f in fields] == [
        (v, scale, ratio * scale) for v in (0.1, 0.3) for scale in (0.5, 2.0) for ratio in (1.0, 12.0)
    ]
    assert len({cell.study.study.seed for cell in found}) == 1
    assert len({cell.name for cell in found}) == 8


def test_statistics_of_known_rows(toy):
    cell = toy.isel(coefficient_of_variation=1, vertical_scale=0, scale_ratio=0)
    values = cell["run_out"].values
    assert float(cell["run_out_mean"]) == pytest.approx(values.mean(), rel=1e-12)
    assert float(cell["run_out_standard_deviation"]) == pytest.approx(values.std(ddof=1), rel=1e-12)
    assert float(cell["run_out_exceedance"].sel(run_out_threshold=5.0)) == pytest.approx(0.75, rel=1e-12)
    assert float(cell["failure_volume_mean"]) == pytest.approx(2.0 * values.mean(), rel=1e-12)
    assert standing(cell) == 10
    for name in ("mean", "standard_deviation", "characteristic"):
        assert (toy[f"run_out_{name}_lower"] <= toy[f"run_out_{name}"]).all()
        assert (toy[f"run_out_{name}_upper"] >= toy[f"run_out_{name}"]).all()
    assert set(KEPT) < set(toy.data_vars)
    assert toy["run_out"].dims == (*Grid._fields, "realisation")


def test_lower_bounds_exceed_every_threshold_of_retrogression_and_volume(toy):
    cell = toy.isel(coefficient_of_variation=0, vertical_scale=0, scale_ratio=1)
    for name in ("retrogression_distance", "failure_volume"):
        assert float(cell[f"{name}_exceedance"][-1]) == 0.75
    assert float(cell["run_out_exceedance"][-1]) == 0.0
    assert crest_lost(cell).value == 0.75


def test_failed_rows_are_counted_and_widen_the_probability(toy):
    assert toy["failed_count"].values.ravel().tolist() == [0, 0, 0, 0, 0, 1, 0, 1]
    one, other = (toy.isel(coefficient_of_variation=1, vertical_scale=0, scale_ratio=i) for i in (0, 1))
    at = {"run_out_threshold": 5.0}
    assert float(other["run_out_exceedance_lower"].sel(at)) < float(one["run_out_exceedance_lower"].sel(at))
    assert float(toy["computing_time"].sum()) == 8 * N * 0.5


def test_a_difference_that_chance_does_not_explain_is_secure_and_no_other(toy):
    small, large = against(toy.isel(vertical_scale=[0]), "scale_ratio", 1.0, mean_of("run_out"))
    assert small.is_secure
    assert small.estimate.lower < 1.0 < small.estimate.upper
    assert (large.is_secure, large.estimate.value) == (False, 0.0)
    assert small.here == {"coefficient_of_variation": 0.1, "vertical_scale": 1.0, "scale_ratio": 6.0}
    assert small.there == {**small.here, "scale_ratio": 1.0}
    fails = against(toy, "coefficient_of_variation", 0.1, probability_beyond("run_out", 5.0))
    assert [each.is_secure for each in fails] == [True] * 4
    assert verdict(fails) == "of 4, 4 securely smaller, 0 undecided"
    assert next(correlations(toy, "scale_ratio", 1.0, "run_out")) > 0.99


def test_main_effects_are_averages_over_all_others(toy):
    variation, scale, ratio = main_effects(toy, lambda cell: exceeds(cell, "run_out", 5.0))
    assert (variation.here, variation.there) == ({"coefficient_of_variation": 0.5}, {"coefficient_of_variation": 0.1})
    assert (variation.is_secure, scale.is_secure, ratio.is_secure) == (True, False, False)
    assert variation.estimate.value == pytest.approx(-10 / 39, rel=1e-12)  # the failed one is left out
    assert (scale.estimate.value, variation.estimate.n) == (0.0, N - 1)
    half = main_effects(toy, lambda cell: cell["run_out"].values)[2]  # a metre for one of two variations
    assert half.is_secure
    assert half.estimate.lower < 0.5 < half.estimate.upper


def test_against_the_uniform_slope(toy):
    securely = [each.is_secure for each in against_uniform(toy, "run_out")]
    assert securely == [False, False] * 2 + [True, True] * 2  # the metre that pairs are sure of is lost in chance here


def test_a_family_is_allowed_for():
    """A difference at the edge of its own interval is no longer secure among many."""
    differences = np.random.default_rng(2).normal(0.0, 1.0, N)
    differences += 2.2 * differences.std(ddof=1) / np.sqrt(N) - differences.mean()
    few, many = Grid((0.1,), (1.0,), (1.0, 6.0)), Grid((0.1,), (1.0,), (1.0, *range(2, 12)))
    securely = []
    for grid in (few, many):
        found = summarise(grid, {(0, 0, i): rows_of(10.0 + (i > 0) * differences) for i in range(grid.shape[2])})
        securely.append({each.is_secure for each in against(found, "scale_ratio", 1.0, mean_of("run_out"))})
    assert securely == [{True}, {False}]


def test_every_finding_is_a_sentence(toy):
    found = list(findings(toy, 5.0))
    assert len(found) == 10
    assert all(text.startswith("**") and text.endswith(".") and "nan" not in text for text in found)
    assert span([1.04, 1.01], "m") == "1.0 m"
    assert span([-0.5, 2.0], signed=True) == "-0.5 to +2.0"


@pytest.mark.slow  # a dozen campaigns
@pytest.mark.timeout(600)
def test_rounds_keep_combinations_equal_and_go_on_where_they_were_stopped(tmp_path, monkeypatch):
    study = load_study(COARSE).with_changes({"study.realisations": 5})
    grid, told = Grid((0.1,), (2.0,), (1.0, 3.0)), []
    rounds = run_in_rounds(study, grid, tmp_path, 2, 1, told.append)
    first = next(rounds)
    assert [rows.sizes["realisation"] for rows in first.values()] == [2, 2]
    rounds.close()

    def one_cell_and_no_further(combinations, *others):
        yield next(iter(run_cells(combinations, *others)))
        raise KeyboardInterrupt

    run_cells = campaigns.run_cells
    monkeypatch.setattr(campaigns, "run_cells", one_cell_and_no_further)
    with pytest.raises(KeyboardInterrupt):
        next(run_in_rounds(study, grid, tmp_path, 2, 1, told.append))
    monkeypatch.undo()
    rest = run_in_rounds(study, grid, tmp_path, 2, 1, told.append)
    assert [[rows.sizes["realisation"] for rows in each.values()] for each in rest] == [[4, 4], [5, 5]]
    (last,) = run_in_rounds(study, grid, tmp_path, 2, 1, told.append)
    for position, rows in first.items():  # not run again
        np.testing.assert_array_equal(last[position]["wall_time"].values[:2], rows["wall_time"].values)


def test_a_campaign_stopped_on_its_way_does_not_begin_the_rounds_again(tmp_path, monkeypatch):
    study, grid = load_study(COARSE).with_changes({"study.realisations": 9}), Grid((0.1,), (2.0,), (1.0, 3.0))
    for cell, (state, done) in zip(cells(study, grid), [("complete", 6), ("stopped", 5)], strict=True):
        (tmp_path / cell.name).mkdir()
        campaign_status.write(
            tmp_path / cell.name, {"state": state, "done": done, "total": 6, "updated": campaign_status.now()}
        )
    asked = []

    def asked_for(combinations, *others):
        asked.append([cell.study.study.realisations for cell in combinations])
        return ((cell, "rows") for cell in combinations)

    monkeypatch.setattr(campaigns, "run_cells", asked_for)
    assert len(list(run_in_rounds(study, grid, tmp_path, 3, 1, print))) == 2
    assert asked == [[6, 6], [9, 9]]


@pytest.mark.slow
@pytest.mark.timeout(600)  # kernels with and without a field to compile, six pictures
def test_the_study_writes_its_dataset_and_page(tmp_path):
    study = load_study(COARSE).with_changes({"study.realisations": 2})
    grid, reports, told = Grid((0.1, 0.3), (1.0, 2.0), (1.0, 3.0)), tmp_path / "reports", []
    run(study, grid, tmp_path / "rows", reports, block=2, workers=1, command="make it", tell=told.append)
    text = (reports / "random_field_study.md").read_text(encoding="utf-8")
    assert "Made by `make it`" in text
    assert "8 combinations with 2 realisations each, 16 in all, of which 0 failed" in text
    assert "{" not in text
    pictures = [line.split("(")[-1].rstrip(")") for line in text.splitlines() if line.startswith("![")]
    assert len(pictures) == 6
    assert all((reports / name).stat().st_size > 0 for name in pictures)
    found = open_ensemble(reports / DATASET)
    assert [float(cell["scale_ratio"]) for cell in each_cell(found)] == [1.0, 3.0] * 4
    assert add_uniform(found, study)["run_out_uniform"].equals(found["run_out_uniform"])
