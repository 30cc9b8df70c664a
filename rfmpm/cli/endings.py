"""How a command ends when it cannot do what it was asked: one message on standard error, one exit code."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any, NoReturn

import typer

WRONG_STUDY, TOO_MANY_FAILED, STOPPED_EARLY = 2, 3, 75
RANK_VARIABLES = ("PMI_RANK", "PMIX_RANK", "OMPI_COMM_WORLD_RANK")


def ends_in_words(function: Callable[..., None]) -> Callable[..., None]:
    """Let the expected failures of a command end in one message and an exit code instead of a traceback."""

    @wraps(function)
    def guarded(*args: Any, **kwargs: Any) -> None:
        try:
            function(*args, **kwargs)
        except KeyboardInterrupt:
            end("stopped early", STOPPED_EARLY)
        except OSError as error:
            end(f"{error.filename}: {error.strerror}" if error.filename else str(error), WRONG_STUDY)
        except _refusals() as error:
            end(str(error), WRONG_STUDY)

    return guarded


def _refusals() -> type[Exception]:
    # Evaluated only once something is raised: `rfmpm --help` need not load the study.
    from rfmpm.study import StudyError

    return StudyError


@contextmanager
def campaigns_end_in_words() -> Iterator[None]:
    """Let what a campaign raises in the body end in its message and exit code."""
    from rfmpm import ensemble

    try:
        yield
    except (ensemble.FolderMismatch, ensemble.LauncherMismatch, ensemble.RowsDiffer, ensemble.TooShort) as error:
        end(str(error), WRONG_STUDY)
    except ensemble.CampaignFailed as error:
        end(str(error), TOO_MANY_FAILED)
    except ensemble.Interrupted as error:
        end(str(error), STOPPED_EARLY)


def failures(dataset: Any) -> int:
    """Count the failed rows of a dataset."""
    from rfmpm.variables import FAILED_CODES

    return int(dataset["status"].isin(list(FAILED_CODES)).sum())


def end_if_too_many_failed(failed: int, total: int, allowed: float, where: str = "") -> None:
    """End with an exit code if more than the allowed share of rows failed; `where` says of which campaign."""
    if failed > allowed * total:
        share = f"more than the allowed {allowed:.3g} of them"
        end(f"{where}{failed} of {total} realisations failed, {share}", TOO_MANY_FAILED)


def end(message: str, code: int) -> NoReturn:
    """Say why, and leave with an exit code."""
    if is_first_rank():
        typer.echo(f"rfmpm: {message}", err=True)
    raise typer.Exit(code)


def is_first_rank() -> bool:
    """Whether this process speaks for all: told from the launcher, so that no command needs MPI to say so."""
    told = [os.environ[name] for name in RANK_VARIABLES if name in os.environ]
    return all(rank == "0" for rank in told or [os.environ.get("SLURM_PROCID", "0")])
