import os
import signal

import pytest

from rfmpm.ensemble.stop import Abandoned, Stop


def test_signal_inside_a_realisation_abandons_it():
    stop = Stop()
    with stop.listening(), pytest.raises(Abandoned), stop.interruptible():
        os.kill(os.getpid(), signal.SIGTERM)
    assert stop.is_requested


def test_signal_outside_is_only_noted_and_the_next_realisation_does_not_begin():
    stop = Stop()
    with stop.listening():
        os.kill(os.getpid(), signal.SIGINT)
        with pytest.raises(Abandoned), stop.interruptible():
            raise AssertionError("began")


def test_second_signal_does_not_disturb_the_writing():
    stop = Stop()
    with stop.listening():
        with pytest.raises(Abandoned), stop.interruptible():
            os.kill(os.getpid(), signal.SIGTERM)
        os.kill(os.getpid(), signal.SIGTERM)
    assert stop.count == 2
