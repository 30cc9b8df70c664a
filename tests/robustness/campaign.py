"""Runs the coarse campaign as a program of its own, so that tests can kill it or start it under mpirun.

python campaign.py DIR REALISATIONS [WORKERS] [SECONDS each realisation is held up] [WALL TIME in seconds]
With PLAN in the environment, the study is changed as plans.json says under that name; REALISATIONS is "".
With TALLY, every realisation that begins is a line of that file; with SEGMENT_SECONDS, segments are written that often.
Prints the hash of the content on rank 0; exit codes as those of `rfmpm run`.
"""

import json
import os
import sys
import time
from pathlib import Path

from rfmpm import ensemble, realisation, results
from rfmpm.ensemble import segments
from rfmpm.study import load_study

COARSE = Path(__file__).with_name("coarse.toml")
PLANS = COARSE.with_name("plans.json")
ROWS_OF_A_SEGMENT = 8  # so that a campaign of seconds writes several


def hold_up(seconds: float) -> None:
    run = realisation.run

    def slow_run(prepared, index, watch, **options):
        if "TALLY" in os.environ:
            with open(os.environ["TALLY"], "a") as tally:
                tally.write(f"{index}\n")
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            watch()
            time.sleep(min(0.02, seconds))
        return run(prepared, index, watch=watch, **options)

    realisation.run = slow_run


def main(directory: str, realisations: str, workers: str = "", seconds: str = "0", wall_time: str = "") -> int:
    segments.ROWS = ROWS_OF_A_SEGMENT
    segments.SECONDS = float(os.environ.get("SEGMENT_SECONDS", segments.SECONDS))
    hold_up(float(seconds))
    options = {"progress": False, "wall_time": float(wall_time) if wall_time else None}
    study = load_study(COARSE)
    if "PLAN" in os.environ:
        study = study.with_changes(json.loads(PLANS.read_text())[os.environ["PLAN"]])
    number, crew = (int(text) if text else None for text in (realisations, workers))
    try:
        found = ensemble.run(study, directory, number, crew, **options)
    except ensemble.Interrupted as error:
        print(error, file=sys.stderr)
        return 75
    except ensemble.CampaignFailed as error:
        print(error, file=sys.stderr)
        return 3
    except (ensemble.FolderMismatch, ensemble.LauncherMismatch) as error:
        print(error, file=sys.stderr)
        return 2
    if found is not None:
        print(results.content_hash(found))
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
