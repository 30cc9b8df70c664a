"""Rows of an ensemble to labelled datasets and back; files appear whole or not at all."""

import contextlib
import hashlib
import os
import secrets
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rfmpm.results.provenance import global_attributes
from rfmpm.variables import COORDINATES, Variable, active_variables

if TYPE_CHECKING:
    import xarray as xr

ENSEMBLE_FILE = "ensemble.nc"
_MISSING_INTEGER = -1  # on disk; NaN in memory
_NEVER_MISSING = ("status", "realisation", "level", "x")


class UnreadableRows(ValueError):
    """A file of rows that is torn, altered or not one of ours."""


def dataset(rows: Sequence[Mapping[str, Any]], study, attributes: Mapping[str, Any] | None = None) -> "xr.Dataset":
    """Label rows with dimensions, units and definitions from the table of variables.

    Args:
        rows: one mapping per realisation with every active variable by name, "realisation" and optionally "level".
        study: the study they belong to.
        attributes: further global attributes.

    Returns:
        Dataset sorted by realisation; counts and flags are floats with NaN where a realisation failed.

    Raises:
        KeyError: if a row lacks an active variable.
        ValueError: if a surface has another number of bins than the domain.
    """
    import xarray as xr

    rows = sorted(rows, key=lambda row: int(row["realisation"]))
    active = active_variables(study)
    coordinates = {
        "realisation": np.array([row["realisation"] for row in rows], "int64"),
        "level": np.array([row.get("level", 0) for row in rows], "int32"),
    }
    data = {}
    for variable in active:
        if variable.dims == ("realisation", "x"):
            data[variable.name] = _surfaces([row[variable.name] for row in rows], study)
            coordinates["x"] = _bin_centres(study)
        else:
            data[variable.name] = _column(variable, [row[variable.name] for row in rows])
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


def _column(variable: Variable, values: list) -> np.ndarray:
    if variable.dtype == "str":
        return np.array([str(value) for value in values], dtype=object)
    return np.array(values, "int8" if variable.name == "status" else "float64")


def _surfaces(values: list, study) -> np.ndarray:
    count = len(_bin_centres(study))
    return np.array([np.broadcast_to(np.asarray(value, "float64"), count) for value in values]).reshape(-1, count)


def _bin_centres(study) -> np.ndarray:
    from rfmpm.mpm.scene import domain_size
    from rfmpm.quantities.surface import bin_centres

    return bin_centres(domain_size(study)[0], study.output.surface_bin_m)


def content_hash(ensemble: "xr.Dataset") -> str:
    """Hash what a campaign found, wall time and attributes left out; equal for any number of workers.

    Args:
        ensemble: as `dataset` makes it or `open_ensemble` reads it.

    Returns:
        sha256, hexadecimal.
    """
    state = hashlib.sha256()
    for name in sorted(str(name) for name in ensemble.variables if name != "wall_time"):
        variable = ensemble.variables[name]
        state.update(f"{name}{variable.dims}{variable.shape}".encode())
        if variable.dtype.kind in "biuf":
            values = np.array(variable.values, "<f8")
            values[np.isnan(values)] = np.nan  # one bit pattern for all of them
            state.update(values.tobytes())
        else:
            state.update("\0".join(str(value) for value in variable.values.ravel()).encode())
    return state.hexdigest()


def write_rows(path: Path, rows: Sequence[Mapping[str, Any]], study, attributes: Mapping | None = None) -> None:
    """Write rows to a file that survives a crash from the moment it has its name.

    Args:
        path: the file; replaced if it exists.
        rows: as for `dataset`.
        study: the study they belong to.
        attributes: further global attributes.

    Raises:
        OSError: if the file cannot be written.
    """
    write_dataset(path, dataset(rows, study, attributes))


def write_dataset(path: Path, labelled: "xr.Dataset") -> None:
    """Write a dataset as NetCDF-4: temporary name in the same folder, flushed to the disk, then renamed.

    Args:
        path: the file; replaced if it exists.
        labelled: the dataset.

    Raises:
        OSError: if the file cannot be written.
    """
    path = Path(path)
    temporary = path.with_name(f".{path.name}.{secrets.token_hex(4)}")
    try:
        labelled.to_netcdf(temporary, format="NETCDF4", engine="netcdf4")
        flush_to_disk(temporary)
        os.replace(temporary, path)
    except RuntimeError as error:  # what netCDF4 makes of a full disk
        raise OSError(f"{path}: cannot be written, is the disk full? ({error})") from error
    finally:
        temporary.unlink(missing_ok=True)
    flush_to_disk(path.parent)


def flush_to_disk(path: Path) -> None:
    """Wait until a file, or a folder's list of names, is on the disk; folders where the system allows it.

    Args:
        path: the file or folder.
    """
    with contextlib.suppress(PermissionError) if path.is_dir() else contextlib.nullcontext():
        descriptor = os.open(path, os.O_RDONLY if path.is_dir() else os.O_RDWR)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def read_rows(path: Path) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Read a file of `write_rows` and check it against its own hash.

    Args:
        path: the file.

    Returns:
        Rows as they were given, and the global attributes.

    Raises:
        UnreadableRows: if the file is torn, altered or not one of ours.
    """
    try:
        stored = _open(path)
        is_intact = content_hash(stored) == stored.attrs["content_hash"]
    except Exception as error:  # a damaged file makes the libraries below raise nearly anything
        raise UnreadableRows(f"{path}: {type(error).__name__}: {error}") from error
    if not is_intact:
        raise UnreadableRows(f"{path}: content does not match its hash")
    columns = {str(name): stored[name].values for name in stored.variables if name != "x"}
    rows = [{name: values[i] for name, values in columns.items()} for i in range(stored.sizes["realisation"])]
    return rows, dict(stored.attrs)


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
    return _open(path)


def _open(path: Path) -> "xr.Dataset":
    import xarray as xr

    with xr.open_dataset(path, engine="netcdf4", decode_times=False, decode_timedelta=False) as stored:
        return stored.load()
