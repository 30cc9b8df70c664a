from types import SimpleNamespace

import pytest

from rfmpm.ensemble import dispatcher
from rfmpm.ensemble.books import Books
from rfmpm.ensemble.dispatcher import Dispatcher, Todo
from rfmpm.ensemble.markers import Task
from rfmpm.ensemble.worker import Ended, Report
from rfmpm.variables import STATUS

TOTAL = 100


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
def clock(monkeypatch):
    now = [1000.0]
    monkeypatch.setattr(dispatcher, "time", SimpleNamespace(monotonic=lambda: now[0]))
    return now


def make(notes, shown, action="record", allowed=1.0, before=None, **options):
    progress = SimpleNamespace(show=lambda done, failed: shown.append((done, failed)))
    books = Books(TOTAL, before or {}, action, allowed)
    return Dispatcher(Todo([range(4, 6), range(7, 8)]), {5: 2}, books, notes, progress, **options)


@pytest.fixture
def desk(notes, shown):
    return make(notes, shown)


def after(index, status="ok", reason="", seconds=1.0):
    return Report(Ended(index, STATUS[status], reason, seconds))


def test_hands_out_in_order_with_the_number_of_the_start_and_counts(desk, shown):
    assert [desk.answer(0, Report()), desk.answer(1, Report())] == [Task(4, 1), Task(5, 3)]
    assert desk.answer(1, after(5, "diverged")) == Task(7, 1)
    assert desk.answer(0, after(4, "not_at_rest")) is None
    assert shown[-1] == (2, 1)
    assert desk.books.failures() == {"diverged": 1}


def test_a_journal_that_cannot_be_written_ends_the_run_and_keeps_the_books(desk, monkeypatch):
    def fail(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Notes, "write", fail)
    assert desk.answer(0, Report()) == Task(4, 1)
    assert desk.answer(0, after(4, "diverged")) is None
    assert desk.books.failures() == {"diverged": 1}
    assert "the journal cannot be written: [Errno 28]" in desk.stopped_by
    assert not desk.lost(1, "killed")


def test_todo_is_held_as_ranges():
    todo = Todo([range(3), range(5, 10**7)])
    assert [todo.take() for _ in range(5)] == [0, 1, 2, 5, 6]
    assert len(todo) == 10**7 - 7
    assert len(todo.ranges) == 1


def test_last_report_gets_nothing(desk):
    assert desk.answer(0, Report(is_last=True)) is None
    assert desk.answer(1, Report()) == Task(4)


@pytest.mark.parametrize("report", [Report(stopping="a signal"), Report(error="disk full")])
def test_one_worker_that_stops_stops_all(desk, report):
    assert desk.answer(0, Report()) == Task(4)
    assert desk.answer(1, report) is None
    assert desk.answer(0, after(4)) is None
    assert desk.stopped_by in ("a signal", "worker 1 could not go on: disk full")


def test_lost_worker_is_noted_with_its_realisation_and_others_go_on(desk, notes):
    desk.answer(0, Report())
    assert desk.lost(0, "killed by SIGKILL")  # and may be replaced
    assert notes == [("worker_lost", {"rank": 0, "realisation": 4, "reason": "killed by SIGKILL"})]
    assert desk.answer(1, Report()) == Task(5, 3)


def test_worker_that_died_over_nothing_is_not_replaced(desk):
    assert not desk.lost(0, "exit code 1")


def test_failed_realisation_is_noted_with_its_reason(desk, notes):
    desk.answer(0, Report())
    desk.answer(0, after(4, "crashed", "MemoryError"))
    assert notes == [("failed", {"rank": 0, "realisation": 4, "status": "crashed", "reason": "MemoryError"})]


def test_abort_ends_at_the_first_failure(notes, shown):
    desk = make(notes, shown, action="abort")
    desk.answer(0, Report())
    assert desk.answer(0, after(4, "diverged", "energy came from nothing")) is None
    assert "realisation 4 ended with status diverged: energy came from nothing" in desk.verdict
    assert desk.answer(1, Report()) is None


def test_more_failures_than_allowed_end_it_and_no_sooner(notes, shown):
    desk = make(notes, shown, allowed=10 / TOTAL, before={STATUS["crashed"]: 9})
    desk.answer(0, Report())
    assert desk.answer(0, after(4, "timeout", "slow")) == Task(5, 3)  # as many as are allowed
    assert desk.answer(0, after(5, "diverged", "energy")) is None
    assert "11 of 100 realisations have failed" in desk.verdict


def test_nothing_is_handed_out_that_would_outlast_the_deadline(notes, shown, clock):
    desk = make(notes, shown, deadline=1100.0)
    assert desk.answer(0, Report()) == Task(4)
    clock[0] = 1039.0
    assert desk.answer(0, after(4, seconds=60.0)) == Task(5, 3)
    assert desk.answer(1, Report()) == Task(7)  # 1039 + 60 < 1100
    desk.todo.ranges.append(range(8, 9))
    clock[0] = 1040.0
    assert desk.answer(1, after(7, seconds=1.0)) is None  # the longest so far counts
    assert "longest realisation so far, 60 s" in desk.stopped_by


def test_a_wall_time_that_is_over_before_anything_is_finished_is_called_too_short(notes, shown, clock):
    desk = make(notes, shown, deadline=-1.0)
    assert desk.answer(0, Report()) is None
    assert "too short" in desk.stopped_by


def test_running_lists_what_is_at_hand(desk, clock):
    desk.answer(0, Report(host="node1"))
    clock[0] += 5.0
    desk.answer(3, Report(host="node2"))
    assert desk.running() == [
        {"rank": 0, "host": "node1", "realisation": 4, "attempt": 1, "seconds": 5.0},
        {"rank": 3, "host": "node2", "realisation": 5, "attempt": 3, "seconds": 0.0},
    ]
