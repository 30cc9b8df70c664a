"""`rfmpm benchmark ...`: measures the program on this machine."""

from pathlib import Path
from typing import Annotated

import typer

from rfmpm.cli.endings import ends_in_words

benchmark = typer.Typer(
    help="Measure the program on this machine and write reports.", no_args_is_help=True, rich_markup_mode=None
)

ReportFolder = Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the report.")]
Quick = Annotated[bool, typer.Option("--quick", help="A few cases only: a look at the machinery.")]


@benchmark.callback()
def _group() -> None:
    """Measure the program on this machine and write reports."""


@benchmark.command("engine")
@ends_in_words
def engine(out: ReportFolder = Path("reports"), quick: Quick = False) -> None:
    """Run time against error of every shape with every transfer: run_time_against_error.md and its pictures."""
    from rfmpm.benchmark.engine.document import run

    typer.echo(run(out, quick, typer.echo))
