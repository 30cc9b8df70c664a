"""Time integration by name."""

from rfmpm.mpm.solvers.alone import Alone
from rfmpm.mpm.solvers.explicit import Controls, advance
from rfmpm.mpm.solvers.team import make_team

SOLVERS = {"explicit": advance}

__all__ = ["SOLVERS", "Alone", "Controls", "advance", "make_team"]
