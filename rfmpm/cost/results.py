"""What the results of a campaign take: bytes on the disk, and seconds to write the report."""

import time
from itertools import cycle, islice
from math import ceil
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from rfmpm import report, results
from rfmpm.campaign_status import now
from rfmpm.ensemble import segments
from rfmpm.mpm.scene import Scene
from rfmpm.results.row_files import bin_positions


class Size(NamedTuple):
    """Of files of rows of one kind."""

    file: float  # of no rows at all [bytes]
    row: float  # [bytes]


class Files(NamedTuple):
    """What files of rows and a report take."""

    segment: Size
    dataset: Size
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
    number = segments.ROWS
    many = [row | {"realisation": index} for index, row in enumerate(islice(cycle(_fitted(rows, study)), number))]
    segment = _size([_segment(study, many[:1], folder / "one"), _segment(study, many, folder / "many")], number)
    path = folder / results.ENSEMBLE_FILE
    started = time.process_time()
    times = {name: now() for name in ("start", "end")}
    dataset = []
    for some in (many[:1], many):
        results.write_dataset(path, results.dataset(some, study, times))
        dataset.append(path.stat().st_size)
    (folder / "study.toml").write_text(study.to_toml(), encoding="utf-8")
    x, y = scene.points.position.x, scene.points.position.y
    points = {"x": x, "y": y, "plastic_strain": np.zeros_like(x)}
    page = report.write(folder, simulate=lambda index: points | {"run_out": many[index]["run_out"]})
    seconds = time.process_time() - started
    made = [page, page.with_suffix(".json"), *(folder / "snapshots").glob("*")]
    return Files(segment, _size(dataset, number), sum(file.stat().st_size for file in made), seconds)


def _segment(study, rows: list[dict[str, Any]], folder: Path) -> int:
    """Bytes of a segment of some rows."""
    target = folder / segments.SEGMENTS
    target.mkdir(parents=True)
    writer = segments.SegmentWriter(folder, study, 0)
    for row in rows:
        writer.add(row)
    writer.flush()
    return sum(path.stat().st_size for path in target.iterdir())


def _size(bytes_of_one_and_many: list[int], many: int) -> Size:
    one, all_of_them = bytes_of_one_and_many
    row = max(all_of_them - one, 0) / (many - 1)
    return Size(one - row, row)


def _fitted(rows: list[dict[str, Any]], study) -> list[dict[str, Any]]:
    """Rows whose surfaces have as many bins as the study's; other cells may round its length otherwise."""
    if study.output.surface_bin_m is None:
        return rows
    bins = len(bin_positions(study))
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
    rows = count * (files.segment.row + files.dataset.row)
    return round(rows + segment_files * files.segment.file + files.dataset.file + files.report)
