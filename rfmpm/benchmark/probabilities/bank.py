"""The rows that estimators draw from: kept beside the report, or run where they are missing."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rfmpm import ensemble
from rfmpm.study import Study

FILE = "probabilities_rows.nc"
SCRATCH = Path("results/probabilities")  # folders of the campaigns


class Column(NamedTuple):
    """Run-out of a campaign [m], NaN where a realisation failed, and its time steps; each of shape (n,)."""

    run_out: np.ndarray
    steps: np.ndarray


def columns(folder: Path, studies: dict[str, Study], tell: Callable[[str], None]) -> dict[str, Column]:
    """Find the rows of every campaign, or run it.

    Args:
        folder: that holds FILE, or gets it.
        studies: by name, each with its number of realisations.
        tell: is told which campaign is run.

    Returns:
        Columns by the name of the study.
    """
    import xarray as xr

    path, kept = folder / FILE, {}
    if path.is_file():
        with xr.open_dataset(path) as stored:
            kept = {name: _column(stored, name, study) for name, study in studies.items()}
    found = {}
    for name, study in studies.items():
        found[name] = kept.get(name) or _run(name, study, tell)
    if any(kept.get(name) is None for name in studies):
        _write(path, found, studies)
    return found


def _column(stored, name: str, study: Study) -> Column | None:
    """Its column in the file, None where that is of another study or has fewer rows."""
    n = study.study.realisations
    if stored.attrs.get(f"{name}_physics_hash") != study.physics_hash or stored.sizes.get(name, 0) < n:
        return None
    return Column(*(stored[f"{name}_{what}"].values[:n].astype(float) for what in Column._fields))


def _run(name: str, study: Study, tell: Callable[[str], None]) -> Column:
    tell(f"{name}: {study.study.realisations} realisations on cells of {study.discretisation.cell_m:g} m")
    rows = ensemble.run(study, SCRATCH / name)
    return Column(rows["run_out"].values, rows["step_count"].values.astype(float))


def _write(path: Path, found: dict[str, Column], studies: dict[str, Study]) -> None:
    import xarray as xr

    entries = {
        f"{name}_{what}": (name, getattr(column, what).astype(dtype), {"units": unit})
        for name, column in found.items()
        for what, dtype, unit in (("run_out", "float32", "m"), ("steps", "int32", "1"))
    }
    hashes = {f"{name}_physics_hash": study.physics_hash for name, study in studies.items()}
    dataset = xr.Dataset(entries, attrs={"title": "rows of rfmpm benchmark probabilities", **hashes})
    dataset.to_netcdf(path, encoding={name: {"zlib": True, "shuffle": True} for name in entries})
