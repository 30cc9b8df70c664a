"""`rfmpm sweep`: a grid of parameters, a campaign in each of its cells, one dataset."""

import tomllib
from pathlib import Path
from typing import Annotated, Any

import typer

from rfmpm.cli.endings import (
    WRONG_STUDY,
    campaigns_end_in_words,
    end,
    end_if_too_many_failed,
    failures,
    is_first_rank,
)

FORM = "write --vary KEY=V1,V2,... or NAME:KEY=V1,V2,... or KEY1,KEY2=A1:B1,A2:B2,... for keys that change together"


def sweep(
    study: Annotated[Path, typer.Argument(metavar="STUDY", help="Study file (TOML).")],
    vary: Annotated[
        list[str],
        typer.Option(
            metavar="KEY=V1,V2,...",
            help="A key of the study and its values; once for each dimension. NAME:KEY=... names the dimension; "
            "KEY1,KEY2=A1:B1,A2:B2 changes keys together.",
        ),
    ],
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Folder of the results.")] = None,
    realisations: Annotated[int | None, typer.Option(metavar="N", help="Of each cell; default: the study's.")] = None,
    workers: Annotated[int | None, typer.Option(min=1, metavar="N", help="Local processes; default: cores.")] = None,
) -> None:
    """Run a campaign for every cell of a grid of parameters; the same line continues what the folder holds."""
    from rfmpm.ensemble.mpi import launched_ranks
    from rfmpm.ensemble.sweep import cells
    from rfmpm.study import load_study

    axes = [read_axis(text) for text in vary]
    _check_names([axis.name for axis in axes])
    if workers is not None and (launched_ranks() or 1) > 1:
        end("--workers: the ranks of mpirun are the workers; leave the option out", WRONG_STUDY)
    settings = load_study(study)
    if realisations is not None:
        settings = settings.with_changes({"study.realisations": realisations})
    if settings.study.until is not None or settings.estimator is not None:
        end(
            "sweep: the cells of a grid are compared on the same, independent realisations: give study.realisations "
            "instead of study.until, and leave [estimator] out",
            WRONG_STUDY,
        )
    grid = cells(settings, axes)
    folder = out or Path(f"{settings.output.directory}_sweep")
    campaigns = _campaigns(grid, folder, workers)
    if campaigns and all(rows is not None for rows in campaigns.values()):  # other ranks than the first have none
        _write(folder, settings, axes, campaigns)
        for cell in grid:
            allowed = cell.study.failures.max_failed_fraction
            rows = campaigns[cell.position]
            end_if_too_many_failed(failures(rows), rows.sizes["realisation"], allowed, f"cell {cell.name}: ")


def read_axis(text: str) -> Any:
    """Read one --vary; ends the program in words where it cannot be read."""
    from rfmpm.ensemble.sweep import Axis

    left, equals, right = text.partition("=")
    name, colon, keys = left.partition(":")
    if not colon:
        name, keys = "", left
    keys = tuple(key.strip() for key in keys.split(","))
    values = tuple(tuple(_value(part) for part in entry.split(":")) for entry in right.split(","))
    if not equals or not all(keys) or any("" in entry for entry in values):
        end(f"--vary {text}: {FORM}", WRONG_STUDY)
    if any(len(entry) != len(keys) for entry in values):
        end(f"--vary {text}: {len(keys)} keys need as many values, joined by colons; {FORM}", WRONG_STUDY)
    if len(set(values)) < len(values):
        end(f"--vary {text}: a value is given twice", WRONG_STUDY)
    return Axis(name.strip() or keys[0].rpartition(".")[2], keys, values)


def _value(text: str) -> Any:
    try:
        return tomllib.loads(f"value = {text.strip()}")["value"]
    except tomllib.TOMLDecodeError:
        return text.strip()


def _check_names(names: list[str]) -> None:
    for name in names:
        if not name.isidentifier() or name in ("realisation", "x", "level"):
            end(f"--vary: {name} cannot name a dimension; {FORM}", WRONG_STUDY)
        if names.count(name) > 1:
            end(f"--vary: two dimensions are called {name}; name one by NAME:KEY=...", WRONG_STUDY)


def _campaigns(grid: list, folder: Path, workers: int | None) -> dict[tuple[int, ...], Any]:
    from rfmpm.ensemble.sweep import run_cells

    def tell(line: str) -> None:
        if is_first_rank():
            typer.echo(line)

    with campaigns_end_in_words():
        return {cell.position: rows for cell, rows in run_cells(grid, folder, workers, tell)}


def _write(folder: Path, settings: Any, axes: list, campaigns: dict) -> None:
    from rfmpm import results
    from rfmpm.report.sweep_page import draw_sweep, table_lines

    limit, names = settings.quantities.run_out_limit_m, [axis.name for axis in axes]
    dataset = results.sweep_dataset(axes, campaigns, limit)
    results.write_dataset(folder / results.SWEEP_FILE, dataset)
    draw_sweep(dataset, names, limit, folder / "sweep.png")
    table = table_lines(dataset, names, limit)
    note = (
        f"{settings.study.realisations} realisations in each cell; 95 % intervals. Realisation i has the same random "
        "numbers in every cell, so that cells differ less by chance than their intervals tell."
    )
    text = [f"# {settings.study.name}: sweep", "", "![Run-out over the grid](sweep.png)", "", *table, "", note, ""]
    (folder / "sweep.md").write_text("\n".join(text), encoding="utf-8")
    for path in (folder / "sweep.png", folder / results.SWEEP_FILE, folder / "sweep.md"):
        typer.echo(path)
    for line in [*table, note]:
        typer.echo(line)
