"""One realisation in a process of its own, whose death harms nobody and can only be its own doing."""

import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

from rfmpm.ensemble.markers import Task
from rfmpm.ensemble.stop import SIGNALS

LAUNCHER_VARIABLES = ("PMI", "PMIX", "OMPI", "MPI", "HYDRA", "HYDI", "SLURM", "PBS", "PRTE", "MV2", "I_MPI")
DOUBT = 2.0  # seconds: whoever kills the whole job kills the parent within them, and the realisation is not blamed


class ChildDied(RuntimeError):
    """The process of a realisation ended without a result; says how."""


def run_apart(study, directory: Path, task: Task) -> dict[str, Any]:
    """Run a realisation in a new process and wait for it.

    Args:
        study: the study.
        directory: of the campaign.
        task: the realisation.

    Returns:
        Its row.

    Raises:
        ChildDied: if the process ended without one.
    """
    code = "from rfmpm.ensemble import isolation; isolation.serve()"
    # a session of its own: signals to the group of the job reach the parent, which ends the child
    with subprocess.Popen(
        [sys.executable, "-c", code],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env=_environment(),
        start_new_session=True,
    ) as child:
        try:
            with suppress(BrokenPipeError):
                child.stdin.write(pickle.dumps((study, Path(directory), task)))
                child.stdin.flush()  # it stays open: its end tells the child that the parent is gone
            answer = child.stdout.read()
            if child.wait() == 0 and answer:
                return pickle.loads(answer)
            time.sleep(DOUBT)
        finally:
            child.kill()
            with suppress(BrokenPipeError):  # of what a child that died at once has not taken
                child.stdin.close()
    raise ChildDied(cause(child.returncode))


def cause(exit_code: int | None) -> str:
    """Say how a process ended.

    Args:
        exit_code: as subprocess and multiprocessing give it; negative for a signal.

    Returns:
        A few words.
    """
    if exit_code is not None and exit_code < 0:
        with suppress(ValueError):
            return f"killed by {signal.Signals(-exit_code).name}"
    return f"exit code {exit_code}"


def _environment() -> dict[str, str]:
    kept = {name: value for name, value in os.environ.items() if not name.startswith(LAUNCHER_VARIABLES)}
    package = str(Path(__file__).parents[2])
    return {**kept, "PYTHONPATH": os.pathsep.join(filter(None, [package, kept.get("PYTHONPATH")]))}


def serve() -> None:
    """Be the child: read what to run from standard input, write the row to standard output."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    answer = os.dup(1)
    os.dup2(2, 1)  # what a library prints is not the answer
    study, directory, task = pickle.load(sys.stdin.buffer)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    from threadpoolctl import threadpool_limits

    from rfmpm.ensemble.worker import Worker

    worker = Worker(study, directory)
    with threadpool_limits(limits=1):
        worker.prepare([task.level])
        row = worker.run_here(task)
    with os.fdopen(answer, "wb") as file:
        pickle.dump(row, file)
    os._exit(0)  # the thread that waits for the parent's end is not to be waited for


def _end_with_parent() -> None:
    while os.read(0, 1024):
        pass
    os._exit(1)
