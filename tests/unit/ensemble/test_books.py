import pytest

from rfmpm.ensemble.books import Books
from rfmpm.ensemble.worker import Ended
from rfmpm.variables import STATUS


def books(action="record", allowed=0.05, before=None, total=100):
    return Books(total, before or {}, action, allowed)


def failed(index, status="diverged", reason="energy came from nothing"):
    return Ended(index, STATUS[status], reason, 1.0)


def test_rows_of_earlier_runs_count_too():
    kept = books(before={STATUS["ok"]: 40, STATUS["crashed"]: 10}, total=200)
    assert kept.before == 50
    assert not kept.why_not()
    kept.enter(failed(50))
    assert (
        "11 of 200 realisations have failed, more than the allowed 0.05 of them (1 diverged, 10 crashed)"
        in kept.why_not()
    )
    assert (kept.done, kept.failed) == (1, 1)


def test_commonest_reason_is_named():
    kept = books(allowed=0.0)
    for index in range(9):
        kept.enter(failed(index))
    assert not kept.why_not()  # so few are judged when it is complete
    kept.enter(failed(9, "timeout", "slow"))
    assert "most often: realisation 0 ended with status diverged: energy came from nothing" in kept.why_not()
    assert "--allow-failed" in kept.why_not()


def test_what_is_not_at_rest_has_not_failed():
    kept = books("abort", 0.0)
    kept.enter(failed(0, "not_at_rest", ""))
    assert not kept.why_not()


@pytest.mark.parametrize("action", ["record", "retry"])
def test_only_abort_minds_a_single_failure(action):
    kept = books(action)
    kept.enter(failed(3))
    assert not kept.why_not()
    kept = books("abort")
    kept.enter(failed(3))
    assert "realisation 3 ended with status diverged" in kept.why_not()
