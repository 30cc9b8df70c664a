"""The only writer of result files: labelled NetCDF datasets made from the one table of variables."""

from rfmpm.results.ensemble_file import write_ensemble
from rfmpm.results.netcdf import ENSEMBLE_FILE, content_hash, dataset, open_ensemble, write_dataset
from rfmpm.results.provenance import global_attributes, row_attributes, source_hash, versions
from rfmpm.results.row_files import (
    ROWS_SUFFIX,
    Columns,
    StoredRows,
    UnreadableRows,
    columns,
    copy_rows,
    differences,
    read_rows,
    write_rows,
)
from rfmpm.results.simulation import write_simulation
from rfmpm.results.sweep import SWEEP_FILE, sweep_dataset
from rfmpm.results.xi import read_xi, write_xi

__all__ = [
    "ENSEMBLE_FILE",
    "ROWS_SUFFIX",
    "SWEEP_FILE",
    "Columns",
    "StoredRows",
    "UnreadableRows",
    "columns",
    "content_hash",
    "copy_rows",
    "dataset",
    "differences",
    "global_attributes",
    "open_ensemble",
    "read_rows",
    "read_xi",
    "row_attributes",
    "source_hash",
    "sweep_dataset",
    "versions",
    "write_dataset",
    "write_ensemble",
    "write_rows",
    "write_simulation",
    "write_xi",
]
