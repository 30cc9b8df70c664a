"""On the path of a Python, this lets the realisation $DEADLY kill its process, in whatever process it runs."""

import os
import signal

from rfmpm import realisation

real_run = realisation.run


def run(prepared, index, **options):
    if index == int(os.environ["DEADLY"]):
        os.kill(os.getpid(), signal.SIGKILL)
    return real_run(prepared, index, **options)


realisation.run = run
