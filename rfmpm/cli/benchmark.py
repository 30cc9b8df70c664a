"""`rfmpm benchmark ...`: measures the program on this machine."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer

from rfmpm.cli.endings import ends_in_words

benchmark = typer.Typer(
    help="Measure the program on this machine and write reports.", no_args_is_help=True, rich_markup_mode=None
)

ReportFolder = Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the report.")]
Quick = Annotated[bool, typer.Option("--quick", help="A few cases only: a look at the machinery.")]
Write = Callable[[Path, bool, Callable[[str], None]], Path]  # (folder, quick, told the progress) -> the report


def command(load: Callable[[], Write]) -> Callable[[], Write]:
    """Make a command of a function that imports what writes a report and returns it; its docstring is the help."""

    @benchmark.command(load.__name__, help=load.__doc__)
    @ends_in_words
    def measure(out: ReportFolder = Path("reports"), quick: Quick = False) -> None:
        typer.echo(load()(out, quick, typer.echo))

    return load


@command
def engine() -> Write:
    """Run time against error of every shape with every transfer: run_time_against_error.md and its pictures."""
    from rfmpm.benchmark.engine.document import run

    return run


@command
def stability() -> Write:
    """Sweep soils, steps and scenes to find what breaks the engine: stability.md and its pictures."""
    from rfmpm.benchmark.stability.document import run

    return run


@command
def savings() -> Write:
    """Measure what is saved by each thing that a scene does not need and the program skips: savings.md."""
    from rfmpm.benchmark.savings import run

    return run


@command
def slope() -> Write:
    """Run the short slope over time steps, constants, cells and kinds of softening: slope_error.md."""
    from rfmpm.benchmark.slope_error import write

    return write


@command
def verification() -> Write:
    """Compare the engine with exact and measured answers: verification.md."""
    from rfmpm.benchmark.verification import write

    return write


@command
def soundings() -> Write:
    """Estimate from soundings of known scale of fluctuation: bias and coverage, soundings.md."""
    from rfmpm.benchmark.soundings import run

    return run


@command
def fields() -> Write:
    """Run time against covariance error of every field method, and of other packages if installed: fields.md."""
    from rfmpm.benchmark.fields.document import run

    return run


@command
def scheduling() -> Write:
    """Overhead of handing out, 1000 ranks simulated, bias of stopping early, cost predicted: scheduling.md."""
    from rfmpm.benchmark.scheduling.document import run

    return run


@command
def probabilities() -> Write:
    """Error over cost, bias and coverage of every estimator on the short slope: probabilities.md and its picture."""
    from rfmpm.benchmark.probabilities.document import run

    return run


@command
def safety() -> Write:
    """Factors of safety against published ones, and against the displacements of the same fields: safety.md."""
    from rfmpm.benchmark.safety.document import run

    return run
