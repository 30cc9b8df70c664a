"""`rfmpm rerun`: a realisation on record computed again, compared bit for bit, with its pictures."""

from pathlib import Path
from typing import Annotated, Any

import typer

from rfmpm.cli.endings import TOO_MANY_FAILED, WRONG_STUDY, end
from rfmpm.cli.tables import outcome_rows, print_table


def rerun(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a campaign, complete or not.")],
    index: Annotated[int, typer.Option("--index", min=0, metavar="I", help="Which realisation.")],
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Default: rerun_I in the folder.")] = None,
    frames: Annotated[int, typer.Option(min=0, metavar="N", help="Snapshots to keep on the way.")] = 0,
) -> None:
    """Compute a realisation on record again: is it the same, bit for bit? Snapshots, picture."""
    from rfmpm.study import load_study

    study = load_study(directory / "study.toml")
    from rfmpm import ensemble, results
    from rfmpm.variables import BY_CHANCE, STATUS_NAMES

    try:
        recorded = ensemble.find_row(directory, index)
    except LookupError as error:
        end(str(error.args[0]), WRONG_STUDY)
    row, outcome = _again(study, index, frames)
    if outcome is not None:
        _write(outcome, study, out or directory / f"rerun_{index}")
    found = results.columns([row], study)
    for change in _changes(recorded.attributes, results.row_attributes(study)):
        typer.echo(f"then and now: {change}")
    names = list(results.differences(recorded.columns, found))
    status = int(recorded.columns["status"][0])
    if names and status in BY_CHANCE:
        reason = recorded.columns["status_reason"][0]
        words = f"realisation {index} is on record as {STATUS_NAMES[status]} ({reason}), which did not come again"
        end(f"{words}; rfmpm run --repeat-failed replaces the row", TOO_MANY_FAILED)
    if names:
        values = [f"  {name}: {_shown(recorded.columns[name])} -> {_shown(found[name])}" for name in names]
        end("\n".join([f"realisation {index} is not the one on record; it differs in", *values]), TOO_MANY_FAILED)
    typer.echo(f"realisation {index} is the one on record, bit for bit")


def _again(study: Any, index: int, frames: int) -> tuple[dict[str, Any], Any]:
    """Row and outcome; no outcome if the realisation raises, which a campaign records as crashed."""
    from threadpoolctl import threadpool_limits

    from rfmpm import realisation
    from rfmpm.ensemble.worker import described
    from rfmpm.variables import failed_row

    with threadpool_limits(limits=1):  # as in a campaign
        prepared = realisation.prepare(study)
        try:
            outcome = realisation.simulate(prepared, index, frames=frames)
        except Exception as failure:
            reason = described(failure)
            typer.echo(f"status  crashed: {reason}")
            return failed_row(study, index, "crashed", reason), None
    return realisation.as_row(outcome, index), outcome


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
