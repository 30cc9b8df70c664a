"""A campaign whose realisations sleep for given times, as a program that mpirun can start.

    python -m rfmpm.benchmark.scheduling.stand_in DIR SECONDS.npy [--workers N]
    mpirun -n 2 python -m rfmpm.benchmark.scheduling.stand_in DIR CLAIMS --flood

The first leaves in DIR/spans.npy, shape (n, 3), when each realisation began and ended [s] and in which process. The
second prints the seconds that rank 0 takes for a claim while claims wait in line.
"""

import argparse
import os
import time
from pathlib import Path

import numpy as np

from rfmpm import ensemble, realisation
from rfmpm.ensemble import mpi
from rfmpm.ensemble.books import Books
from rfmpm.ensemble.dispatcher import Dispatcher, Todo
from rfmpm.ensemble.journal import Journal
from rfmpm.ensemble.progress import Progress
from rfmpm.ensemble.worker import Ended, Report
from rfmpm.study import Study
from rfmpm.variables import STATUS, active_variables

ROWS_PER_SEGMENT = 16
STUDY = {
    "study": {"name": "stand-in", "seed": 1},
    "geometry": {"kind": "block", "width_m": 2.0, "height_m": 2.0, "foreland_m": 2.0},
    "discretisation": {"cell_m": 1.0, "points_per_cell": 4, "shape": "linear"},
    "boundary": {"base": {"kind": "roller"}, "sides": {"kind": "roller"}},
    "material": [
        {
            "name": "soil",
            "law": "elastic",
            "unit_weight_kn_m3": 20.0,
            "youngs_modulus_kpa": 1e3,
            "poissons_ratio": 0.3,
        }
    ],
    "time": {"end_s": 1.0},
    "output": {"directory": "unused"},
}


def main() -> None:
    """Run the stand-in."""
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("what")
    parser.add_argument("--workers", type=int)
    parser.add_argument("--flood", action="store_true")
    given = parser.parse_args()
    if given.flood:
        flood(given.folder, int(given.what))
    else:
        sleep_campaign(given.folder, np.load(given.what), given.workers)


def sleep_campaign(folder: Path, seconds: np.ndarray, workers: int | None) -> None:
    """Run a campaign whose realisations sleep."""
    study = Study(**STUDY).with_changes({"study.realisations": len(seconds)})
    names = [variable.name for variable in active_variables(study)]

    def sleep(prepared, index, **_):
        began = time.time()
        time.sleep(seconds[index])
        row = dict.fromkeys(names, 0.0) | {"realisation": index, "status": STATUS["ok"], "status_reason": ""}
        return row | {"run_out": began, "influence_distance": time.time(), "failure_volume": float(os.getpid())}

    realisation.run = sleep  # in this program alone
    rows = ensemble.run(study, folder / "campaign", workers=workers, progress=False)
    if rows is not None:
        spans = [rows[name].values for name in ("run_out", "influence_distance", "failure_volume")]
        np.save(folder / "spans.npy", np.column_stack(spans))


def flood(folder: Path, claims: int) -> None:
    """Let rank 1 claim without waiting for answers, and time how rank 0 serves."""
    crew = mpi.Ranks()
    if crew.rank == 0:
        books, progress = Books(claims + 1, {}, "record", 1.0), Progress(claims + 1, 0, is_shown=False)
        dispatcher = Dispatcher(Todo([range(claims + 1)]), {}, books, Journal(folder / "journal.jsonl"), progress)
        crew._meet()
        time.sleep(1.0)  # the claims arrive
        started = time.perf_counter()
        crew._serve(dispatcher, lambda: None)
        print((time.perf_counter() - started) / claims)
        return
    segment = [{"segment": "00001-1-00001-0123456789abcdef.rows", "realisations": list(range(ROWS_PER_SEGMENT))}]
    ended = [Ended(index, STATUS["ok"], "", 0.0) for index in range(claims)]
    reports = [Report(end, segments=[] if end.code % ROWS_PER_SEGMENT else segment) for end in ended]
    crew._meet()
    sent = [crew.comm.isend(report, 0, mpi._CLAIM) for report in reports]
    for _ in reports:
        crew.comm.recv(source=0, tag=mpi._ANSWER)
    crew.comm.send(Report(is_last=True), 0, mpi._CLAIM)
    for request in sent:
        request.wait()


if __name__ == "__main__":
    main()
