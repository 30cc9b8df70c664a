"""The command line: each command loads what it needs, does one thing and says where the result is."""

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from rfmpm.cli.benchmark import benchmark
from rfmpm.cli.endings import TOO_MANY_FAILED, WRONG_STUDY, end, ends_in_words
from rfmpm.cli.merge import merge
from rfmpm.cli.rerun import rerun
from rfmpm.cli.run import OutFolder, StudyFile, run
from rfmpm.cli.sounding import sounding
from rfmpm.cli.stability import stability
from rfmpm.cli.status import status
from rfmpm.cli.sweep import sweep
from rfmpm.cli.tables import cost_row, outcome_rows, print_table

FRAMES_OF_AN_ANIMATION = 60

app = typer.Typer(
    help="Probability of run-out, failure volume and retrogression of a slope.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)

app.command("run")(ends_in_words(run))
app.command("status")(ends_in_words(status))
app.add_typer(benchmark, name="benchmark")
app.command("merge")(ends_in_words(merge))
app.command("rerun")(ends_in_words(rerun))
app.command("sounding")(ends_in_words(sounding))
app.command("stability")(ends_in_words(stability))
app.command("sweep")(ends_in_words(sweep))

Index = Annotated[int, typer.Option("--index", min=0, metavar="I", help="Which realisation.")]


def main() -> None:
    """Run the command line."""
    app(prog_name="rfmpm")


def command(function: Callable[..., None]) -> Callable[..., None]:
    """Make a function a command of its name."""
    return app.command(function.__name__)(ends_in_words(function))


def _writable(folder: Path) -> Path:
    """Make a folder, and fail now rather than after the computation if it cannot be written to."""
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryFile(dir=folder):
        return folder


def _print_version(asked: bool) -> None:
    if asked:
        from rfmpm import __version__

        typer.echo(__version__)
        raise typer.Exit


@app.callback()
def rfmpm(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Probability of run-out, failure volume and retrogression of a slope."""


@command
def simulate(
    study: StudyFile,
    index: Index = 0,
    homogeneous: Annotated[
        bool, typer.Option("--homogeneous", help="Mean strength everywhere, nothing uncertain.")
    ] = False,
    out: OutFolder = None,
    frames: Annotated[int, typer.Option(min=0, metavar="N", help="Snapshots to keep on the way.")] = 0,
    animate: Annotated[bool, typer.Option("--animate", help="Write an animation (60 frames unless given).")] = False,
    xi: Annotated[
        Path | None, typer.Option("--xi", metavar="FILE", help="Random vector from a file of field --write-xi.")
    ] = None,
    threads: Annotated[
        int | None,
        typer.Option(min=1, metavar="N", help="That share every step; default: the cores for a large scene, else 1."),
    ] = None,
) -> None:
    """Simulate one realisation: snapshots, picture, animation."""
    from rfmpm.study import load_study

    settings = load_study(study)
    if xi is not None and (homogeneous or not (settings.fields or settings.uncertain)):
        end("--xi: there is nothing random to make of it; leave the option out", WRONG_STUDY)
    name = "simulation_homogeneous" if homogeneous else f"simulation_{index if xi is None else xi.stem}"
    folder = _writable(out or Path(settings.output.directory) / name)
    from rfmpm import planning, realisation, report, results

    frames = frames or (FRAMES_OF_AN_ANIMATION if animate else 0)
    replay = planning.Replay(settings)
    prepared = replay.prepared
    vector = None if homogeneous else _read_xi(xi, prepared) if xi is not None else replay.options(index).get("xi")
    threads = realisation.threads_for(prepared) if threads is None else threads
    outcome = realisation.simulate(prepared, index, frames=frames, homogeneous=homogeneous, xi=vector, threads=threads)
    written = [folder / "simulation.nc", folder / "simulation.png"]
    results.write_simulation(written[0], outcome, settings)
    report.write_simulation_picture(outcome, settings, written[1])
    if animate:
        written.append(folder / "simulation.gif")
        report.write_animation(outcome, settings, written[2])
    print_table(outcome_rows(outcome))
    for path in written:
        typer.echo(path)
    from rfmpm.variables import FAILED

    if outcome.status in FAILED:
        end(f"the realisation failed: {outcome.status}, {outcome.reason}", TOO_MANY_FAILED)


def _read_xi(path: Path, prepared: Any) -> Any:
    from rfmpm import results

    try:
        return results.read_xi(path, prepared.n_variables)
    except ValueError as error:
        end(str(error), WRONG_STUDY)


@command
def field(
    study: StudyFile,
    index: Index = 0,
    out: OutFolder = None,
    write_xi: Annotated[
        Path | None, typer.Option("--write-xi", metavar="FILE", help="Keep the realisation's random vector (.npy) too.")
    ] = None,
) -> None:
    """Realise the random field alone: picture, sample statistics against the asked ones."""
    from rfmpm.study import StudyError, load_study

    settings = load_study(study)
    if not settings.fields:
        raise StudyError(["random_field: this study has none; its strength is the same everywhere"], str(study))
    folder = _writable(out or Path(settings.output.directory) / f"field_{index}")
    from rfmpm import report

    for line in report.write_field(settings, index, folder):
        typer.echo(line)
    if write_xi is not None:
        from rfmpm import draw_xi, results

        results.write_xi(write_xi, draw_xi(settings, index))
        typer.echo(write_xi)


@command
def check(
    study: Annotated[Path | None, typer.Argument(metavar="STUDY", help="Study file (TOML).")] = None,
    schema: Annotated[bool, typer.Option("--schema", help="Print the JSON schema of study files.")] = False,
    picture: Annotated[
        Path | None, typer.Option("--picture", metavar="FILE", help="Draw the set-up into this PNG file.")
    ] = None,
) -> None:
    """Validate a study: everything that is wrong with it at once."""
    from rfmpm.study import Study, fields_need_making, load_study

    if schema:
        import json

        typer.echo(json.dumps(Study.json_schema(), indent=2))
    elif study is None:
        raise typer.BadParameter("give a study file, or --schema", param_hint="STUDY")
    if study is not None:
        settings = load_study(study)
        if fields_need_making(settings):
            _make_fields(settings, study)
        if settings.time.initial_stress != "elastic":
            _say_balance(settings, study)
        typer.echo(f"{study}: nothing is wrong", err=schema)
        if picture is not None:
            from rfmpm import report

            _writable(picture.parent)
            report.write_setup_picture(settings, picture)
            typer.echo(picture)


def _make_fields(settings: Any, source: Path) -> None:
    from rfmpm import realisation
    from rfmpm.study import StudyError, with_fastest_methods

    try:
        realisation.prepare_fields(with_fastest_methods(settings))
    except StudyError as error:
        raise StudyError(error.problems, str(source)) from None


def _say_balance(settings: Any, source: Path) -> None:
    from rfmpm import realisation
    from rfmpm.study import StudyError

    try:
        ratio = realisation.initial_balance(realisation.prepare(settings))
    except StudyError as error:
        raise StudyError(error.problems, str(source)) from None
    typer.echo(f"forces at the start out of balance by {ratio:.1e} of gravity's")


@command
def estimate(
    study: StudyFile,
    ranks: Annotated[
        int | None, typer.Option(min=1, metavar="N", help="Workers, on machines like this; default: cores.")
    ] = None,
) -> None:
    """Say what a campaign would cost, from short trials; run nothing else."""
    from rfmpm.study import load_study

    settings = load_study(study)
    from rfmpm import cost
    from rfmpm.ensemble.mpi import launched_ranks

    if (launched_ranks() or 1) > 1:
        end(
            "estimate: ranks that run its trials at once disturb each other; leave mpirun out, say --ranks N",
            WRONG_STUDY,
        )
    print_table(cost_row(key, value) for key, value in cost.estimate(settings, ranks).items())


@command
def report(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a campaign.")],
    out: Annotated[Path | None, typer.Option("--out", metavar="FILE", help="Instead of DIR/report.html.")] = None,
) -> None:
    """Write report.html (one self-contained file) and report.json."""
    if not (directory / "ensemble.nc").is_file():
        end(f"{directory}: no ensemble.nc here; has the campaign been completed?", WRONG_STUDY)
    from rfmpm import report as reporting

    typer.echo(reporting.write(directory, out))


@command
def warmup() -> None:
    """Compile and cache every kernel."""
    from rfmpm import cost

    for ready in cost.warmup():
        typer.echo(ready)
