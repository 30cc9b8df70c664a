"""The lock of a folder: refused while the holder lives, taken over from the dead."""

import json
import threading
import time
from types import SimpleNamespace

import pytest

from rfmpm import campaign_status
from rfmpm.ensemble import lock


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    monkeypatch.setattr(lock, "LOOK_FOR", 0.5)
    monkeypatch.setattr(lock, "SETTLE", 0.05)


@pytest.fixture
def no_system_locks(monkeypatch):
    import fcntl

    def unsupported(*_):
        raise OSError(38, "Function not implemented")

    monkeypatch.setattr(fcntl, "flock", unsupported)


def leave(directory, host, pid=1):
    (directory / lock.LOCK_FILE).write_text(json.dumps({"host": host, "pid": pid, "started": "yesterday"}))


def holder(directory):
    return json.loads((directory / lock.LOCK_FILE).read_text())


def test_second_is_refused_and_told_who_holds_it(tmp_path):
    with lock.locked(tmp_path, "today"), pytest.raises(lock.InUse, match=r"process \d+ on .+, started today"):
        lock.locked(tmp_path, "later").__enter__()
    with lock.locked(tmp_path, "then"):
        pass
    assert (tmp_path / lock.LOCK_FILE).read_text() == ""


def test_dead_of_this_host_is_taken_over_at_once(tmp_path, monkeypatch):
    monkeypatch.setattr(lock, "_look_for_life", lambda *_: pytest.fail("looked for life"))
    leave(tmp_path, lock.platform.node())
    with lock.locked(tmp_path, "now"):
        assert holder(tmp_path)["started"] == "now"


def test_dead_of_another_host_is_taken_over_after_a_look(tmp_path, caplog):
    leave(tmp_path, "another-host")
    with lock.locked(tmp_path, "now"):
        assert "process 1 on another-host" in caplog.text


@pytest.mark.parametrize("host", ["another-host", lock.platform.node()])
def test_holder_that_lives_is_found_without_locks_of_the_system(tmp_path, no_system_locks, host):
    leave(tmp_path, host)
    is_over = threading.Event()

    def live():
        beat = 0
        while not is_over.is_set():
            beat += 1
            campaign_status.write(tmp_path, {"beat": beat})
            time.sleep(0.05)

    thread = threading.Thread(target=live)
    thread.start()
    try:
        with pytest.raises(lock.InUse, match=host):
            lock.locked(tmp_path, "now").__enter__()
    finally:
        is_over.set()
        thread.join()


def test_of_two_that_begin_at_once_without_locks_of_the_system_the_last_to_write_stays(
    tmp_path, no_system_locks, monkeypatch
):
    monkeypatch.setattr(lock, "time", SimpleNamespace(sleep=lambda _: leave(tmp_path, "quicker", 7)))
    with pytest.raises(lock.InUse, match="process 7 on quicker"):
        lock.locked(tmp_path, "now").__enter__()
    assert json.loads((tmp_path / lock.LOCK_FILE).read_text())["host"] == "quicker"


def test_clock_set_back_refuses_nothing(tmp_path, monkeypatch):
    (tmp_path / lock.LOCK_FILE).write_text(
        json.dumps({"host": lock.platform.node(), "pid": 1, "started": "2999-01-01T00:00:00+00:00"})
    )
    with lock.locked(tmp_path, "1970-01-01T00:00:00+00:00"):
        assert holder(tmp_path)["started"].startswith("1970")
