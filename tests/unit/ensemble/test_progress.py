import sys
from types import SimpleNamespace

import pytest

from rfmpm.ensemble import progress


@pytest.fixture
def clock(monkeypatch):
    now = [100.0]
    monkeypatch.setattr(progress, "time", SimpleNamespace(monotonic=lambda: now[0]))
    return now


def test_time_left_follows_the_rate_of_this_run(clock):
    shown = progress.Progress(total=50, before=20)
    clock[0] += 60.0
    # 10 in a minute; 50 - 20 - 10 are left
    assert shown.seconds_left(10) == pytest.approx(120.0, rel=1e-12)  # identity
    assert shown.line(10, 1) == "30/50 realisations, 10 per minute, 0:02:00 left, 1 failed"


def test_before_the_first_one_nothing_is_known(clock):
    assert "time left unknown" in progress.Progress(total=5, before=0).line(0, 0)


def test_lines_come_now_and_then_and_at_the_end(clock, capsys):
    with progress.Progress(total=100, before=0) as shown:
        for done in range(1, 101):
            clock[0] += 1.0
            shown.show(done, 0)
        shown.show(100, 0)  # the last reports of the workers bring nothing new
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 10
    assert lines[-1].startswith("100/100 realisations")


def test_silence(clock, capsys):
    with progress.Progress(total=1, before=0, is_shown=False) as shown:
        clock[0] += 100.0
        shown.show(1, 0)
    assert capsys.readouterr().err == ""


def test_terminal_gets_a_bar(clock, monkeypatch, capsys):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with progress.Progress(total=4, before=1) as shown:
        clock[0] += 1.0
        shown.show(2, 1)
    assert "3/4" in capsys.readouterr().err
