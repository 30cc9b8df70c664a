"""`rfmpm run`: the campaign."""

import re
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from rfmpm.cli.endings import WRONG_STUDY, campaigns_end_in_words, end, end_if_too_many_failed, failures
from rfmpm.cli.ranges import index_range

StudyFile = Annotated[Path, typer.Argument(metavar="STUDY", help="Study file (TOML).")]
OutFolder = Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Folder of the results.")]
CLOCK = re.compile(
    r"(?P<days>\d+)-(?P<hours>\d+):(?P<minutes>\d\d)(?::(?P<seconds>\d\d))?"
    r"|(?:(?P<h>\d+):)?(?P<m>\d+):(?P<s>\d\d)"
)
UNITS = {"s": 1.0, "m": 60.0, "h": 3600.0, "d": 86400.0}


def seconds_of(text: str) -> float:
    """Read a time as people and batch systems write it.

    Args:
        text: seconds (3600), a number with a unit (90m, 6h, 1.5d), or a clock as Slurm reads it: hours:minutes:seconds,
            minutes:seconds, days-hours:minutes:seconds, days-hours:minutes (5:30:00, 30:00, 1-12:00:00, 1-12:00).

    Returns:
        Seconds.

    Raises:
        typer.BadParameter: if it is none of these, or nothing.
    """
    if found := re.fullmatch(r"(\d+(?:\.\d*)?)([smhd]?)", text.strip().lower()):
        seconds = float(found[1]) * UNITS[found[2] or "s"]
    elif found := CLOCK.fullmatch(text.strip()):
        parts = {unit: float(number) for unit, number in found.groupdict(default="0").items()}
        seconds = sum(UNITS[name[0]] * number for name, number in parts.items())
    else:
        seconds = 0.0
    if seconds <= 0.0:
        raise typer.BadParameter(f"{text}: must be a time such as 3600 (seconds), 90m, 6h or 5:30:00")
    return seconds


def run(
    study: StudyFile,
    out: OutFolder = None,
    realisations: Annotated[int | None, typer.Option(metavar="N", help="Instead of the study's number.")] = None,
    seed: Annotated[int | None, typer.Option(metavar="S", help="Instead of the study's seed.")] = None,
    workers: Annotated[int | None, typer.Option(min=1, metavar="N", help="Local processes; default: cores.")] = None,
    fresh: Annotated[bool, typer.Option("--fresh", help="Start anew instead of continuing.")] = False,
    allow_failed: Annotated[
        float | None,
        typer.Option(
            min=0.0, max=1.0, metavar="SHARE", help="Failed realisations beyond it: exit 3. Default: the study's."
        ),
    ] = None,
    wall_time: Annotated[
        float | None,
        typer.Option(
            parser=seconds_of,
            metavar="TIME",
            help="End by then with exit 75, to be continued: 3600, 90m, 6h, 5:30:00. Give some minutes less than the "
            "batch system does.",
        ),
    ] = None,
    repeat_failed: Annotated[
        bool, typer.Option("--repeat-failed", help="Run once more what a crash or a time limit ended.")
    ] = False,
    log_level: Annotated[
        Literal["debug", "info", "warning", "error"],
        typer.Option(help="Of the logs of the workers, DIR/logs/rank-*.log; info: a line for each realisation."),
    ] = "warning",
    indices: Annotated[
        str | None, typer.Option(metavar="A:B", help="Only the realisations from A up to B, itself not included.")
    ] = None,
) -> None:
    """Run the campaign, or continue what the folder holds of the same study."""
    from rfmpm.study import load_study

    given = {"study.realisations": realisations, "study.seed": seed}
    settings = load_study(study).with_changes({path: value for path, value in given.items() if value is not None})
    folder = out or Path(settings.output.directory)
    options = {
        "indices": index_range(indices),
        "fresh": fresh,
        "allow_failed": allow_failed,
        "wall_time": wall_time,
        "log_level": log_level,
        "repeat_failed": repeat_failed,
    }
    dataset = _campaign(settings, folder, workers, options)
    if dataset is None:
        return  # another rank than the first
    from rfmpm import report as reporting

    typer.echo(f"dataset: {folder / 'ensemble.nc'}")
    typer.echo(f"report:  {reporting.write(folder)}")
    for line in reporting.summary_lines(dataset, settings):
        typer.echo(line)
    allowed = settings.failures.max_failed_fraction if allow_failed is None else allow_failed
    end_if_too_many_failed(failures(dataset), dataset.sizes["realisation"], allowed)


def _campaign(settings: Any, folder: Path, workers: int | None, options: dict[str, Any]) -> Any:
    from rfmpm import ensemble, planning
    from rfmpm.ensemble.mpi import launched_ranks

    if (part := options["indices"]) is not None:
        if not planning.is_divisible(settings):
            end(f"--indices {part[0]}:{part[1]}: {planning.NOT_DIVISIBLE}", WRONG_STUDY)
        if part[1] > settings.study.realisations:
            end(f"--indices {part[0]}:{part[1]}: the study has {settings.study.realisations}", WRONG_STUDY)
    if options["repeat_failed"] and planning.approaches_limit(settings):
        end(f"--repeat-failed: {planning.NOT_AGAIN}", WRONG_STUDY)
    if workers is not None and (launched_ranks() or 1) > 1:
        end("--workers: the ranks of mpirun are the workers; leave the option out", WRONG_STUDY)
    with campaigns_end_in_words():
        return ensemble.run(settings, folder, realisations=settings.study.realisations, workers=workers, **options)
