"""`rfmpm rerun`: a realisation on record computed again, compared bit for bit, with its pictures."""

from pathlib import Path
from typing import Annotated, Any

import typer

from rfmpm.cli.endings import TOO_MANY_FAILED, WRONG_STUDY, end
from rfmpm.cli.tables import outcome_rows, print_table


def rerun(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a campaign, complete or not.")],
    index: Annotated[int, typer.Option("--index", min=0, metavar="I", help="Which realisation.")],
    level: Annotated[
        int, typer.Option("--level", min=0, metavar="K", help="On which cells: 0 the study's own, K the K-th coarser.")
    ] = 0,
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Default: rerun_I in the folder.")] = None,
    frames: Annotated[int, typer.Option(min=0, metavar="N", help="Snapshots to keep on the way.")] = 0,
) -> None:
    """Compute a realisation on record again: is it the same, bit for bit? Snapshots, picture."""
    from rfmpm.study import load_study

    study = load_study(directory / "study.toml")
    from rfmpm import ensemble, planning, results
    from rfmpm.variables import BY_CHANCE, STATUS_NAMES

    try:
        recorded = ensemble.find_row(directory, index, level)
    except LookupError as error:
        end(str(error.args[0]), WRONG_STUDY)
    which = f"realisation {index}" + (f" on level {level}" if level else "")
    replay = planning.Replay(study, _rows_before(directory, study), level)
    row, outcome = _again(replay, index, frames)
    if outcome is not None:
        _write(outcome, replay.prepared.study, out or directory / f"rerun_{index}{f'_level_{level}' if level else ''}")
    found = results.columns([row], study)
    for change in _changes(recorded.attributes, results.row_attributes(study)):
        typer.echo(f"then and now: {change}")
    names = list(results.differences(recorded.columns, found))
    status = int(recorded.columns["status"][0])
    if names and status in BY_CHANCE:
        reason = recorded.columns["status_reason"][0]
        words = f"{which} is on record as {STATUS_NAMES[status]} ({reason}), which did not come again"
        end(f"{words}; rfmpm run --repeat-failed replaces the row", TOO_MANY_FAILED)
    if names:
        values = [f"  {name}: {_shown(recorded.columns[name])} -> {_shown(found[name])}" for name in names]
        end("\n".join([f"{which} is not the one on record; it differs in", *values]), TOO_MANY_FAILED)
    typer.echo(f"{which} is the one on record, bit for bit")


def _rows_before(directory: Path, study: Any) -> Any:
    """The rows from which a realisation may follow; None where each stands by itself."""
    from rfmpm import ensemble, planning

    if not planning.approaches_limit(study):
        return None
    try:
        return ensemble.rows_on_record(directory, study)
    except (ensemble.FolderMismatch, ensemble.RowsDiffer) as error:
        end(str(error), WRONG_STUDY)


def _again(replay: Any, index: int, frames: int) -> tuple[dict[str, Any], Any]:
    """Row and outcome; no outcome if the realisation raises, which a campaign records as crashed."""
    from threadpoolctl import threadpool_limits

    from rfmpm import planning, realisation
    from rfmpm.ensemble.worker import described
    from rfmpm.variables import failed_row

    with threadpool_limits(limits=1):  # as in a campaign
        options = replay.options(index)
        try:
            outcome = realisation.simulate(replay.prepared, index, frames=frames, **options)
        except Exception as failure:
            reason = described(failure)
            typer.echo(f"status  crashed: {reason}")
            return failed_row(replay.study, index, "crashed", reason, replay.level), None
    return planning.with_own_bins(realisation.as_row(outcome, index, replay.level), replay.study), outcome


def _write(outcome: Any, study: Any, folder: Path) -> None:
    from rfmpm import report, results

    folder.mkdir(parents=True, exist_ok=True)
    results.write_simulation(folder / "simulation.nc", outcome, study)
    report.write_simulation_picture(outcome, study, folder / "simulation.png")
    print_table(outcome_rows(outcome))
    for name in ("simulation.nc", "simulation.png"):
        typer.echo(folder / name)


def _changes(then: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """What of machine, sources and libraries is another one."""
    return [f"{name}: {then[name]} -> {now[name]}" for name in then if name in now and then[name] != now[name]]


def _shown(values: Any) -> str:
    value = values[0]
    if getattr(value, "ndim", 0):
        return f"a surface of {value.size} bins"
    return f"{value!s}" if isinstance(value, str) else f"{float(value)!r}"
