"""THE tables of variables: what a row, a simulation file and their NetCDF attributes hold; nothing else names them."""

from rfmpm.variables.coordinates import COORDINATES
from rfmpm.variables.rows import PROVENANCE, RUN_DEPENDENT, VARIABLES, active_variables, failed_row
from rfmpm.variables.simulation import HISTORY_VARIABLES, MOTION_VARIABLES, POINT_VARIABLES
from rfmpm.variables.status import BY_CHANCE, FAILED, FAILED_CODES, STATUS, STATUS_NAMES
from rfmpm.variables.variable import Variable

__all__ = [
    "BY_CHANCE",
    "COORDINATES",
    "FAILED",
    "FAILED_CODES",
    "HISTORY_VARIABLES",
    "MOTION_VARIABLES",
    "POINT_VARIABLES",
    "PROVENANCE",
    "RUN_DEPENDENT",
    "STATUS",
    "STATUS_NAMES",
    "VARIABLES",
    "Variable",
    "active_variables",
    "failed_row",
]
