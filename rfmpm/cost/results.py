"""What the results of a campaign take: bytes on the disk, and seconds to write the report."""

import time
from itertools import cycle, islice
from math import ceil
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from rfmpm import report, results
from rfmpm.ensemble import segments
from rfmpm.mpm.scene import Scene

ROWS = 16


class Files(NamedTuple):
    """What files of rows and a report take."""

    file: float  # of no rows at all [bytes]
    row: float  # [bytes]
    report: float  # [bytes]
    report_seconds: float  # besides simulating what it pictures [s]


def measure(study, scene: Scene, rows: list[dict[str, Any]], folder: Path) -> Files:
    """Write rows and a report as a campaign would, and look at the files.

    Args:
        study: the study.
        scene: its scene.
        rows: some of its rows, or of the same study with other cells.
        folder: empty.

    Returns:
        What they take.
    """
    many = [row | {"realisation": index} for index, row in enumerate(islice(cycle(_fitted(rows, study)), ROWS))]
    path = folder / results.ENSEMBLE_FILE
    results.write_rows(path, many[:1], study)
    one = path.stat().st_size
    started = time.process_time()
    now = {name: time.strftime("%Y-%m-%dT%H:%M:%S+00:00") for name in ("start", "end")}
    results.write_rows(path, many, study, now)
    row = max(path.stat().st_size - one, 0) / (ROWS - 1)
    (folder / "study.toml").write_text(study.to_toml(), encoding="utf-8")
    points = {
        "x": scene.points.position.x,
        "y": scene.points.position.y,
        "plastic_strain": np.zeros(scene.points.mass.size),
    }
    page = report.write(folder, simulate=lambda index: points | {"run_out": many[index]["run_out"]})
    seconds = time.process_time() - started
    made = [page, page.with_suffix(".json"), *(folder / "snapshots").glob("*")]
    return Files(one - row, row, sum(file.stat().st_size for file in made), seconds)


def _fitted(rows: list[dict[str, Any]], study) -> list[dict[str, Any]]:
    """Rows whose surfaces have as many bins as the study's; other cells may round its length otherwise."""
    from rfmpm.mpm.scene import domain_size
    from rfmpm.quantities.surface import bin_centres

    if study.output.surface_bin_m is None:
        return rows
    bins = len(bin_centres(domain_size(study)[0], study.output.surface_bin_m))
    return [row | {"final_surface": np.resize(row["final_surface"], bins)} for row in rows]


def segment_count(realisation: float, count: int, workers: int) -> int:
    """Count the segments of a campaign.

    Args:
        realisation: mean time of one [s].
        count: of realisations.
        workers: that share them.

    Returns:
        Files of at most so many rows and so many seconds as a worker collects.
    """
    in_each = min(segments.ROWS, 1 + int(segments.SECONDS / max(realisation, 1e-9)))
    return max(ceil(count / in_each), min(workers, count))


def disk(files: Files, count: int, segment_files: int) -> int:
    """Bytes of segments, dataset and report."""
    return round((segment_files + 1) * files.file + 2 * count * files.row + files.report)
