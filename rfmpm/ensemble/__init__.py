"""The runner: carries out a campaign over processes or MPI ranks, resumes it, and keeps failures as rows."""

from rfmpm.ensemble.folder import FolderMismatch
from rfmpm.ensemble.mpi import LauncherMismatch
from rfmpm.ensemble.runner import Interrupted, run

__all__ = ["FolderMismatch", "Interrupted", "LauncherMismatch", "run"]
