from types import SimpleNamespace

import pytest

from rfmpm.ensemble.dispatcher import Dispatcher
from rfmpm.ensemble.worker import Report
from rfmpm.variables import STATUS


class Notes(list):
    def write(self, event, **details):
        self.append((event, details))


@pytest.fixture
def notes():
    return Notes()


@pytest.fixture
def shown():
    return []


@pytest.fixture
def desk(notes, shown):
    return Dispatcher([4, 5, 7], notes, SimpleNamespace(show=lambda done, failed: shown.append((done, failed))))


def test_hands_out_in_order_and_counts(desk, shown):
    assert [desk.answer(0, Report()), desk.answer(1, Report())] == [4, 5]
    assert desk.answer(1, Report(status=STATUS["diverged"])) == 7
    assert desk.answer(0, Report(status=STATUS["not_at_rest"])) is None
    assert shown[-1] == (2, 1)


def test_last_report_gets_nothing(desk):
    assert desk.answer(0, Report(is_last=True)) is None
    assert desk.answer(1, Report()) == 4


@pytest.mark.parametrize("report", [Report(is_stopping=True), Report(error="disk full")])
def test_one_worker_that_stops_stops_all(desk, report):
    assert desk.answer(0, Report()) == 4
    assert desk.answer(1, report) is None
    assert desk.answer(0, Report(status=0)) is None


def test_lost_worker_is_noted_with_its_realisation_and_others_go_on(desk, notes):
    desk.answer(0, Report())
    desk.lost(0, "killed by SIGKILL")
    assert notes == [("worker_lost", {"rank": 0, "realisation": 4, "reason": "killed by SIGKILL"})]
    assert desk.answer(1, Report()) == 5
