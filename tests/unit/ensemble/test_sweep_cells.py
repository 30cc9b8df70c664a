"""A sweep: its cells, what is refused before anything runs, and that it goes on where it was."""

import pytest

from rfmpm import ensemble, results
from rfmpm.ensemble import sweep
from rfmpm.ensemble.sweep import Axis, cells, run_cells
from rfmpm.study import StudyError
from rfmpm.variables import failed_row

VARIATION = "random_field.cohesion.coefficient_of_variation"
SCALES = ("random_field.cohesion.scale_of_fluctuation_v_m", "random_field.cohesion.scale_of_fluctuation_h_m")
AXES = [
    Axis("variation", (VARIATION,), ((0.1,), (0.3,))),
    Axis("theta_v", SCALES, ((1.0, 6.0), (2.0, 12.0))),
]


@pytest.fixture(scope="module")
def small(study):
    return study.with_changes({"study.realisations": 3})


def test_cells_hold_every_combination_and_share_the_seed(small):
    grid = cells(small, AXES)
    fields = [cell.study.random_field["cohesion"] for cell in grid]
    found = [(f.coefficient_of_variation, f.scale_of_fluctuation_v_m, f.scale_of_fluctuation_h_m) for f in fields]
    assert found == [(0.1, 1.0, 6.0), (0.1, 2.0, 12.0), (0.3, 1.0, 6.0), (0.3, 2.0, 12.0)]
    assert [cell.position for cell in grid] == [(0, 0), (0, 1), (1, 0), (1, 1)]
    assert {cell.study.study.seed for cell in grid} == {small.study.seed}
    assert len({cell.name for cell in grid}) == 4


def test_everything_wrong_in_any_cell_is_said_once_before_anything_runs(small):
    axes = [Axis("v", (VARIATION,), ((-1.0,), (0.2,))), Axis("m", ("time.end_s",), ((1.0,), (-2.0,)))]
    with pytest.raises(StudyError) as caught:
        cells(small, axes)
    text = str(caught.value)
    assert text.count("coefficient_of_variation = -1") == 1
    assert text.count("time.end_s = -2") == 1
    assert "in the cell v=-1.0,m=1.0" in text


def test_a_sweep_goes_on_where_it_was(small, tmp_path, monkeypatch):
    grid, told = cells(small, AXES), []
    run = sweep.run

    def run_until_the_third(study, directory, workers):
        if directory.name == grid[2].name:
            raise ensemble.Interrupted("stopped early")
        return run(study, directory, workers=workers, progress=False)

    monkeypatch.setattr(sweep, "run", run_until_the_third)
    with pytest.raises(ensemble.Interrupted):
        list(run_cells(grid, tmp_path, 1, told.append))
    assert len(told) == 3
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(cell.name for cell in grid[:2])
    segments = {path: path.stat().st_mtime_ns for path in tmp_path.glob("*/segments/*")}

    monkeypatch.setattr(
        sweep, "run", lambda study, folder, workers: run(study, folder, workers=workers, progress=False)
    )
    found = {cell.position: rows for cell, rows in run_cells(grid, tmp_path, 1, told.append)}
    assert list(found) == [cell.position for cell in grid]
    assert segments.items() <= {path: path.stat().st_mtime_ns for path in tmp_path.glob("*/segments/*")}.items()
    assert len(segments) == 2  # what was finished has not run again
    dataset = results.sweep_dataset(AXES, found, limit=1.0)
    assert dataset["run_out"].dims == ("variation", "theta_v", "realisation")
    assert dataset["theta_v"].values.tolist() == [1.0, 2.0]
    assert dataset["theta_v"].attrs["units"] == "m"
    assert dataset["scale_of_fluctuation_h_m"].values.tolist() == [6.0, 12.0]
    for position, rows in found.items():
        cell = dataset.isel(variation=position[0], theta_v=position[1])
        assert (cell["run_out"].values == rows["run_out"].values).all()
        assert float(cell["mean_run_out"]) == pytest.approx(float(rows["run_out"].mean()), rel=1e-12)  # identity
        assert float(cell["exceedance_probability"]) == float((rows["run_out"] > 1.0).mean())
    results.write_dataset(tmp_path / "sweep.nc", dataset)
    assert results.open_ensemble(tmp_path / "sweep.nc")["status"].shape == (2, 2, 3)


@pytest.mark.parametrize(("stretch", "is_there"), [(1.0, True), (1.01, False)])
def test_surfaces_are_kept_only_where_all_cells_have_the_same_bins(small, stretch, is_there):
    width = small.with_changes({"output.surface_bin_m": 1.0})
    rows = results.dataset([failed_row(width, 0, "diverged", "")], width)
    cells_rows = {(0,): rows, (1,): rows.assign_coords(x=stretch * rows["x"])}
    axes = [Axis("bin", ("output.surface_bin_m",), ((1.0,), (stretch,)))]
    assert ("final_surface" in results.sweep_dataset(axes, cells_rows, limit=1.0)) == is_there


@pytest.mark.parametrize(
    ("key", "unit"),
    [
        ("geometry.height_m", "m"),
        ("material.0.cohesion_kpa", "kPa"),
        ("material.0.unit_weight_kn_m3", "kN m-3"),
        ("material.0.viscosity_kpa_s", "kPa s"),
        ("random_field.cohesion.trend_kpa_per_m", "kPa m-1"),
        (VARIATION, "1"),
    ],
)
def test_unit_is_the_end_of_the_key(key, unit):
    from rfmpm.results.sweep import unit_of

    assert unit_of(key) == unit
