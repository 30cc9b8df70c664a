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


@benchmark.command("engine")
@ends_in_words
def engine(out: ReportFolder = Path("reports"), quick: Quick = False) -> None:
    """Run time against error of every shape with every transfer: run_time_against_error.md and its pictures."""
    from rfmpm.benchmark.engine.document import run

    typer.echo(run(out, quick, typer.echo))


@benchmark.command("stability")
@ends_in_words
def stability(out: ReportFolder = Path("reports"), quick: Quick = False) -> None:
    """Sweep soils, steps and scenes to find what breaks the engine: stability.md and its pictures."""
    from rfmpm.benchmark.stability.document import run

    typer.echo(run(out, quick, typer.echo))


@benchmark.command("savings")
@ends_in_words
def savings(out: ReportFolder = Path("reports"), quick: Quick = False) -> None:
    """Measure what is saved by each thing that a scene does not need and the program skips: savings.md."""
    from rfmpm.benchmark.savings import run

    typer.echo(run(out, quick, typer.echo))


@benchmark.command("slope")
@ends_in_words
def slope(out: ReportFolder = Path("reports"), quick: Quick = False) -> None:
    """Run the short slope over time steps, constants, cells and kinds of softening: slope_error.md."""
    from rfmpm.benchmark.slope_error import write

    typer.echo(write(out, quick, typer.echo))


@benchmark.command("verification")
@ends_in_words
def verification(out: ReportFolder = Path("reports"), quick: Quick = False) -> None:
    """Compare the engine with exact and measured answers: verification.md."""
    from rfmpm.benchmark.verification import write

    typer.echo(write(out, quick, typer.echo))
