"""`rfmpm merge`: one study run in parts becomes one folder."""

from pathlib import Path
from typing import Annotated

import typer

from rfmpm.cli.endings import STOPPED_EARLY, WRONG_STUDY, end, end_if_too_many_failed

MOST_RANGES = 20  # of what is missing


def merge(
    directories: Annotated[list[Path], typer.Argument(metavar="DIR...", help="Folders of one study run in parts.")],
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the whole; made if need be.")],
) -> None:
    """Put the parts of one study together, and say what is missing."""
    from rfmpm import ensemble
    from rfmpm.ensemble.parts import ranges

    try:
        whole = ensemble.merge_parts(directories, out)
    except (ensemble.FolderMismatch, ensemble.RowsDiffer) as error:
        end(str(error), WRONG_STUDY)
    lacking = len(whole.missing)
    typer.echo(f"{whole.total - lacking} of {whole.total} realisations in {out}")
    if not lacking:
        typer.echo(f"dataset: {out / 'ensemble.nc'}")
        end_if_too_many_failed(whole.failed, whole.total, whole.allowed)
        return
    named = ranges(whole.missing)
    more = f" and {len(named) - MOST_RANGES} more gaps" if len(named) > MOST_RANGES else ""
    end(
        f"missing are the realisations {', '.join(named[:MOST_RANGES])}{more}; "
        f"run them with: rfmpm run {out / 'study.toml'} --out {out}",
        STOPPED_EARLY,
    )
