"""The runner: carries out a campaign over processes or MPI ranks, resumes it, and keeps failures as rows."""

from rfmpm.ensemble.books import CampaignFailed
from rfmpm.ensemble.campaign import Interrupted, TooShort
from rfmpm.ensemble.course import rows_on_record
from rfmpm.ensemble.finished import RowsDiffer
from rfmpm.ensemble.folder import FolderMismatch
from rfmpm.ensemble.mpi import LauncherMismatch
from rfmpm.ensemble.parts import merge_parts
from rfmpm.ensemble.runner import run
from rfmpm.ensemble.segments import find_row

__all__ = [
    "CampaignFailed",
    "FolderMismatch",
    "Interrupted",
    "LauncherMismatch",
    "RowsDiffer",
    "TooShort",
    "find_row",
    "merge_parts",
    "rows_on_record",
    "run",
]
