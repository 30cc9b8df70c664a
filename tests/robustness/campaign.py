"""Runs the coarse campaign as a program of its own, so that tests can kill it or start it under mpirun.

python campaign.py DIR REALISATIONS [WORKERS] [SECONDS each realisation is held up]
Prints the hash of the content on rank 0; exit code 75 if it stopped early.
"""

import sys
import time
from pathlib import Path

from rfmpm import ensemble, realisation, results
from rfmpm.ensemble import segments
from rfmpm.study import load_study

COARSE = Path(__file__).with_name("coarse.toml")
ROWS_OF_A_SEGMENT = 8  # so that a campaign of seconds writes several


def hold_up(seconds: float) -> None:
    run = realisation.run

    def slow_run(prepared, index):
        time.sleep(seconds)
        return run(prepared, index)

    realisation.run = slow_run


def main(directory: str, realisations: str, workers: str = "", seconds: str = "0") -> int:
    segments.ROWS = ROWS_OF_A_SEGMENT
    hold_up(float(seconds))
    try:
        found = ensemble.run(
            load_study(COARSE), directory, int(realisations), int(workers) if workers else None, progress=False
        )
    except ensemble.Interrupted as error:
        print(error, file=sys.stderr)
        return 75
    except (ensemble.FolderMismatch, ensemble.LauncherMismatch) as error:
        print(error, file=sys.stderr)
        return 2
    if found is not None:
        print(results.content_hash(found))
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
