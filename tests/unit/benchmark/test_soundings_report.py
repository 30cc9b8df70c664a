"""The report of soundings: every case has its rows."""

from rfmpm.benchmark import soundings
from rfmpm.benchmark.soundings import CASES, Found, run


def test_the_report_has_a_row_for_every_estimate(tmp_path, monkeypatch):
    one = soundings.one
    kept: list[Found] = []

    def first_of_its_kind(seed, ratio, correlation, trend):
        if seed == 0:
            kept[:] = [one(seed, ratio, correlation, trend)]
        return kept[0]

    monkeypatch.setattr(soundings, "one", first_of_its_kind)
    told = []
    text = run(tmp_path, True, told.append).read_text(encoding="utf-8")
    assert len(told) == 2 * len(CASES)
    assert text.count("| theta, restricted likelihood |") == 2 * len(CASES)
    assert "{" not in text
