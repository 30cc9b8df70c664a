"""`rfmpm sounding`: from a sounding to the table of a random field."""

from pathlib import Path
from typing import Annotated

import typer

from rfmpm.cli.endings import WRONG_STUDY, end


def sounding(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="CSV with depth_m and value, or a GEF file.")],
    factor: Annotated[
        float, typer.Option(metavar="F", help="Value of the variable per value of the file: 1 / cone factor.")
    ] = 1.0,
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Folder of the picture.")] = None,
) -> None:
    """Estimate trend, variation and vertical scale of fluctuation: table, study table, picture."""
    from rfmpm.columns import ColumnsError
    from rfmpm.report.sounding_page import write_sounding

    if not 0.0 < factor < float("inf"):
        end(f"--factor {factor}: must be positive and finite", WRONG_STUDY)
    folder = out or Path("results") / f"sounding_{file.stem}"
    try:
        for line in write_sounding(file, folder, factor):
            typer.echo(line)
    except (ColumnsError, ModuleNotFoundError) as error:
        end(str(error), WRONG_STUDY)
    typer.echo(folder / "sounding.png")
