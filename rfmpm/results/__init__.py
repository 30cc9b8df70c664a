"""The only writer of result files: labelled NetCDF datasets made from the one table of variables."""

from rfmpm.results.netcdf import (
    ENSEMBLE_FILE,
    UnreadableRows,
    content_hash,
    dataset,
    open_ensemble,
    read_rows,
    write_dataset,
    write_rows,
)
from rfmpm.results.provenance import global_attributes, source_hash, versions
from rfmpm.results.simulation import write_simulation
from rfmpm.results.sweep import SWEEP_FILE, sweep_dataset
from rfmpm.results.xi import read_xi, write_xi

__all__ = [
    "ENSEMBLE_FILE",
    "SWEEP_FILE",
    "UnreadableRows",
    "content_hash",
    "dataset",
    "global_attributes",
    "open_ensemble",
    "read_rows",
    "read_xi",
    "source_hash",
    "sweep_dataset",
    "versions",
    "write_dataset",
    "write_rows",
    "write_simulation",
    "write_xi",
]
