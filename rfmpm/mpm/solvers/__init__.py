"""Time integration by name."""

from rfmpm.mpm.solvers.explicit import advance

SOLVERS = {"explicit": advance}
