"""ensemble.nc in bounded memory: written block by block, hashed as it then lies on the disk."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rfmpm.results.netcdf import content_hash, dataset, in_netcdf_words
from rfmpm.results.row_files import Columns, whole_file

_CHUNK = 2**17  # values that NetCDF compresses together


def write_ensemble(
    path: Path, study, total: int, blocks: Iterable[Columns], attributes: Mapping[str, Any] | None = None
) -> str:
    """Write an ensemble of any size; no more than one block is in memory.

    Args:
        path: the file; replaced if it exists.
        study: the study its rows belong to.
        total: number of rows.
        blocks: columns by name, as `columns` makes them and with "origin"; together all rows, sorted by level
            and realisation.
        attributes: further global attributes.

    Returns:
        Hash of the content, see `content_hash`; the file has it as an attribute.

    Raises:
        OSError: if the file cannot be written.
    """
    import netCDF4
    import xarray as xr

    labels = dataset([], study, attributes)
    with in_netcdf_words(path), whole_file(Path(path)) as temporary:
        with netCDF4.Dataset(temporary, "w", format="NETCDF4") as file:
            _define(file, labels, total)
            start = 0
            for block in blocks:
                stop = start + len(block["realisation"])
                for name, variable in labels.variables.items():
                    if "realisation" in variable.dims:
                        file[name][start:stop] = _on_disk(block[name], variable.encoding)
                start = stop
        with xr.open_dataset(temporary, engine="netcdf4", decode_times=False, decode_timedelta=False) as written:
            found = content_hash(written)
        with netCDF4.Dataset(temporary, "a") as file:
            file.content_hash = found
    return found


def _define(file, labels, total: int) -> None:
    """Make the dimensions and empty variables of a file, and all attributes, as xarray would."""
    sizes = {**labels.sizes, "realisation": total}
    for name, size in sizes.items():
        file.createDimension(name, size)
    file.setncatts(labels.attrs)
    for name, variable in labels.variables.items():
        encoding = variable.encoding
        width = int(np.prod([sizes[dim] for dim in variable.dims[1:]]))
        stored = file.createVariable(
            name,
            encoding.get("dtype", str),
            variable.dims,
            fill_value=encoding.get("_FillValue"),
            compression="zlib" if encoding else None,
            complevel=4,
            chunksizes=[min(sizes[variable.dims[0]], max(1, _CHUNK // width)), *variable.shape[1:]],
        )
        stored.setncatts(variable.attrs)
        if name not in labels.coords:
            stored.coordinates = "level"
    for name in sizes.keys() - {"realisation"}:
        file[name][:] = labels[name].values


def _on_disk(values: np.ndarray, encoding: Mapping[str, Any]) -> np.ndarray:
    fill = encoding.get("_FillValue")
    if encoding and values.dtype.kind == "f" and fill is not None and not np.isnan(fill):
        return np.where(np.isnan(values), fill, values).astype(encoding["dtype"])
    return values
