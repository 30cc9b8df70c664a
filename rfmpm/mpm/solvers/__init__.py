"""Time integration by name."""

from rfmpm.mpm.solvers.explicit import Controls, advance

SOLVERS = {"explicit": advance}

__all__ = ["SOLVERS", "Controls", "advance"]
