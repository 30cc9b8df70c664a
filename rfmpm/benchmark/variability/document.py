"""The study carried out: its rows, its dataset and its page, renewed after every round."""

import os
from collections.abc import Callable
from pathlib import Path

from rfmpm import results
from rfmpm.benchmark.variability.campaigns import Grid, run_in_rounds
from rfmpm.benchmark.variability.page import write_page
from rfmpm.benchmark.variability.summary import summarise
from rfmpm.benchmark.variability.uniform import add_uniform

DATASET = "random_field_study.nc"


def run(
    study,
    grid: Grid,
    folder: Path,
    reports: Path,
    *,
    block: int,
    workers: int | None,
    command: str,
    tell: Callable[[str], None],
) -> None:
    """Run or continue the study; dataset and page are those of the last complete round, whenever it is stopped.

    Args:
        study: with a random cohesion.
        grid: of the combinations.
        folder: of the campaigns.
        reports: where dataset, page and pictures go; made if missing.
        block: realisations that a round adds to each combination [-].
        workers: local processes; as many as there are processors if None.
        command: that does this, for the page.
        tell: is told the progress, line by line.

    Raises:
        as `ensemble.run`.
    """
    reports.mkdir(parents=True, exist_ok=True)
    for rows in run_in_rounds(study, grid, folder, block, workers, tell):
        found = add_uniform(summarise(grid, rows), study)
        load = f"{os.getloadavg()[2]:.1f} on {os.cpu_count()} cores" if hasattr(os, "getloadavg") else "unknown"
        found.attrs |= {"command": command, "load": load}
        results.write_dataset(reports / DATASET, found)
        tell(str(write_page(found, study, reports)))
