"""Rows of an ensemble to labelled datasets and back; files appear whole or not at all."""

import contextlib
import hashlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rfmpm.results.provenance import global_attributes
from rfmpm.results.row_files import columns, labels_along, whole_file
from rfmpm.variables import COORDINATES, PROVENANCE, RUN_DEPENDENT, Variable, active_variables

if TYPE_CHECKING:
    import xarray as xr

ENSEMBLE_FILE = "ensemble.nc"
_VALUES_AT_ONCE = 2**20  # that a large variable is read and hashed by
_MISSING_INTEGER = -1  # on disk; NaN in memory
_NEVER_MISSING = ("status", "realisation", "level", "x", "time", "history_time", "motion_time", *PROVENANCE)


def dataset(rows: Sequence[Mapping[str, Any]], study, attributes: Mapping[str, Any] | None = None) -> "xr.Dataset":
    """Label rows with dimensions, units and definitions from the table of variables.

    Args:
        rows: one mapping per realisation with every active variable by name, "realisation" and optionally "level".
        study: the study they belong to.
        attributes: further global attributes.

    Returns:
        Dataset sorted by level and realisation; counts and flags are floats with NaN where a realisation failed.

    Raises:
        KeyError: if a row lacks an active variable.
        ValueError: if a surface has another number of bins than the domain.
    """
    import xarray as xr

    data = columns(rows, study)
    data["origin"] = np.zeros(len(rows), "int32")
    active = [*active_variables(study), *PROVENANCE.values()]
    coordinates = {name: data[name] for name in ("realisation", "level")}
    for dimension in sorted({name for variable in active for name in variable.dims[1:]}):
        coordinates[dimension] = labels_along(dimension, study)
    labelled = xr.Dataset(
        {variable.name: labelled_array(variable, data[variable.name], study) for variable in active},
        {name: labelled_array(COORDINATES[name], values, study) for name, values in coordinates.items()},
        global_attributes(study) | dict(attributes or {}),
    )
    labelled.attrs["content_hash"] = content_hash(labelled)
    return labelled


def labelled_array(variable: Variable, values: np.ndarray, study) -> "xr.Variable":
    """Give values the dimensions, attributes and disk encoding that the table states.

    Args:
        variable: its row of the table.
        values: shaped as its dimensions.
        study: whose settings the definitions name.

    Returns:
        The labelled values.
    """
    import xarray as xr

    attributes: dict[str, Any] = {"long_name": variable.long_name}
    if variable.unit:
        attributes["units"] = variable.unit
    for name, value in variable.attributes.items():
        attributes[name] = value.format(study=study) if isinstance(value, str) else np.array(value, variable.dtype)
    encoding: dict[str, Any] = {}
    if variable.dtype != "str":
        encoding = {"dtype": variable.dtype, "zlib": True, "shuffle": True, "complevel": 4, "_FillValue": None}
        if variable.name not in _NEVER_MISSING:
            encoding["_FillValue"] = np.nan if variable.dtype.startswith("float") else _MISSING_INTEGER
    return xr.Variable(variable.dims, values, attributes, encoding)


def content_hash(ensemble: "xr.Dataset") -> str:
    """Hash what a campaign found; equal for any number of workers. Attributes and what depends on the run are left out.

    Args:
        ensemble: as `dataset` makes it or `open_ensemble` reads it; one that is not loaded is read block by block.

    Returns:
        sha256, hexadecimal.
    """
    state = hashlib.sha256()
    for name in sorted(str(name) for name in ensemble.variables if name not in RUN_DEPENDENT):
        variable = ensemble.variables[name]
        state.update(f"{name}{variable.dims}{variable.shape}".encode())
        step = max(1, _VALUES_AT_ONCE // max(1, int(np.prod(variable.shape[1:]))))
        for start in range(0, variable.shape[0], step):
            state.update(_hashed_bytes(variable[start : start + step].values, is_first=start == 0))
    return state.hexdigest()


def _hashed_bytes(values: np.ndarray, is_first: bool) -> bytes:
    if values.dtype.kind not in "biuf":
        return ("" if is_first else "\0").encode() + "\0".join(str(value) for value in values.ravel()).encode()
    values = np.array(values, "<f8")
    values[np.isnan(values)] = np.nan  # one bit pattern for all of them
    return values.tobytes()


def write_dataset(path: Path, labelled: "xr.Dataset") -> None:
    """Write a dataset as NetCDF-4: temporary name in the same folder, flushed to the disk, then renamed.

    Args:
        path: the file; replaced if it exists.
        labelled: the dataset.

    Raises:
        OSError: if the file cannot be written.
    """
    with in_netcdf_words(path), whole_file(Path(path)) as temporary:
        labelled.to_netcdf(temporary, format="NETCDF4", engine="netcdf4")


@contextlib.contextmanager
def in_netcdf_words(path: Path) -> Iterator[None]:
    """Raise OSError for what netCDF4 makes of a full disk.

    Args:
        path: the file that the body writes.
    """
    try:
        yield
    except RuntimeError as error:
        raise OSError(f"{path}: cannot be written, is the disk full? ({error})") from error


def open_ensemble(source: Path | str) -> "xr.Dataset":
    """Open the result of a campaign.

    Args:
        source: its folder or its ensemble.nc.

    Returns:
        The dataset, loaded; the file is closed again.

    Raises:
        FileNotFoundError: if the campaign is not complete or the folder holds none.
    """
    path = Path(source)
    path = path / ENSEMBLE_FILE if path.is_dir() else path
    if not path.is_file():
        raise FileNotFoundError(f"{path}: no such file; has the campaign been completed?")
    import xarray as xr

    with xr.open_dataset(path, engine="netcdf4", decode_times=False, decode_timedelta=False) as stored:
        return stored.load()
