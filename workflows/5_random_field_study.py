"""The short slope over the variation, the vertical scale and the anisotropy of its strength.

    python workflows/5_random_field_study.py [--workers N]

writes reports/random_field_study.md with its pictures and its dataset, random_field_study.nc. All combinations grow
together, a round of realisations at a time, and every complete round renews the reports; stopped, the same command goes
on in results/random_field_study. With --page it writes page and pictures again from the dataset and runs nothing.
"""

from pathlib import Path
from typing import Annotated

import typer

import rfmpm
from rfmpm.benchmark.variability.campaigns import Grid
from rfmpm.benchmark.variability.document import DATASET, run
from rfmpm.benchmark.variability.page import write_page
from rfmpm.cli.endings import campaigns_end_in_words

ROOT = Path(__file__).parents[1]
REPORTS = ROOT / "reports"
GRID = Grid(coefficient_of_variation=(0.1, 0.25, 0.5), vertical_scale=(0.5, 1.0, 2.5), scale_ratio=(1.0, 6.0, 12.0))
BLOCK = 8  # realisations of each combination in a round


def main(
    workers: Annotated[int | None, typer.Option(min=1, metavar="N", help="Local processes; default: cores.")] = None,
    page: Annotated[bool, typer.Option("--page", help="Write the page again from the dataset; run nothing.")] = False,
) -> None:
    """Run or continue the random-field study of the short slope, and write its page."""
    study = rfmpm.load_study(ROOT / "configs" / "random_field_study.toml")
    if page:
        write_page(rfmpm.open_ensemble(REPORTS / DATASET), study, REPORTS)
        return
    command = "python workflows/5_random_field_study.py" + (f" --workers {workers}" if workers else "")
    with campaigns_end_in_words():
        run(
            study,
            GRID,
            ROOT / study.output.directory,
            REPORTS,
            block=BLOCK,
            workers=workers,
            command=command,
            tell=typer.echo,
        )


if __name__ == "__main__":
    typer.run(main)
