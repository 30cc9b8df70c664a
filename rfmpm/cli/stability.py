"""`rfmpm stability`: the factor of safety of a slope."""

import tempfile
import time
from math import inf
from pathlib import Path
from typing import Annotated, Any

import typer

from rfmpm.cli.endings import TOO_MANY_FAILED, WRONG_STUDY, end
from rfmpm.cli.run import OutFolder, StudyFile
from rfmpm.cli.tables import print_table


def stability(
    study: StudyFile,
    method: Annotated[
        str | None, typer.Option("--method", metavar="NAME", help="Default: the study's, or bishop.")
    ] = None,
    index: Annotated[int, typer.Option("--index", min=0, metavar="I", help="Which realisation.")] = 0,
    homogeneous: Annotated[
        bool, typer.Option("--homogeneous", help="Mean strength everywhere, nothing uncertain.")
    ] = False,
    out: OutFolder = None,
) -> None:
    """Find the factor of safety of one realisation's field, and picture what slides."""
    from rfmpm.study import load_study

    settings = load_study(study)
    method = method or settings.quantities.safety_method or "bishop"
    from rfmpm.stability import METHODS

    if method not in METHODS:
        end(f"--method {method}: must be one of {', '.join(METHODS)}", WRONG_STUDY)
    is_random = bool(settings.fields or settings.uncertain) and not homogeneous
    name = f"stability_{index}" if is_random else "stability"
    folder = out or Path(settings.output.directory) / name
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryFile(dir=folder):  # fail now rather than after the computation
        pass
    from rfmpm import planning, realisation, report

    replay = planning.Replay(settings)
    prepared, xi = replay.prepared, replay.options(index).get("xi") if is_random else None
    started = time.perf_counter()
    found, strength = realisation.stability(prepared, method, index, homogeneous=homogeneous, xi=xi)
    took = time.perf_counter() - started
    title = f"{method.replace('_', ' ')}, {f'realisation {index}' if is_random else 'homogeneous'}"
    report.write_stability_picture(prepared, strength, found, title, folder / "stability.png")
    typer.echo(folder / "stability.png")
    print_table(_rows(found, title, took))
    if found.factor == inf:
        end(f"{method} has no solution on any surface: try bishop", TOO_MANY_FAILED)


def _rows(found: Any, title: str, took: float) -> list[tuple[str, str]]:
    """What was found, as labels and texts; a method that knows no slip surface says the factor alone."""
    from rfmpm.report.words import duration

    rows = [("method", title), ("factor of safety", "none" if found.factor == inf else f"{found.factor:.4f}")]
    surface = getattr(found, "surface", None)
    if surface is not None and len(surface):
        (x_in, y_in), (x_out, y_out) = surface[0], surface[-1]
        rows.append(("slip surface", found.kind))
        rows.append(("enters at", f"x = {x_in:.2f} m, y = {y_in:.2f} m"))
        rows.append(("leaves at", f"x = {x_out:.2f} m, y = {y_out:.2f} m"))
        rows.append(("lowest point", f"y = {surface[:, 1].min():.2f} m"))
    return [*rows, ("time, compiling included", duration(took))]
