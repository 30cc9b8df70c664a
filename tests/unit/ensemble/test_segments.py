import numpy as np

from rfmpm import results
from rfmpm.ensemble import segments
from rfmpm.variables import failed_row


def rows(study, count):
    return [failed_row(study, index, "lost", "") for index in range(count)]


def writer(study, tmp_path):
    (tmp_path / "segments").mkdir(exist_ok=True)
    return segments.SegmentWriter(tmp_path, study, 3)


def test_writes_when_enough_rows_have_gathered(study, tmp_path, monkeypatch):
    monkeypatch.setattr(segments, "ROWS", 16)
    made = writer(study, tmp_path)
    written = [made.add(row) for row in rows(study, segments.ROWS)]
    assert written[:-1] == [[]] * (segments.ROWS - 1)
    assert written[-1][0]["realisations"] == list(range(segments.ROWS))
    stored = results.read_rows(tmp_path / "segments" / written[-1][0]["segment"])
    np.testing.assert_array_equal(stored.columns["realisation"], range(segments.ROWS))


def test_writes_when_enough_time_has_passed(study, tmp_path, monkeypatch):
    clock = [0.0]
    monkeypatch.setattr(segments.time, "monotonic", lambda: clock[0])
    made = writer(study, tmp_path)
    first, second, third = rows(study, 3)
    assert made.add(first) == []
    clock[0] = 0.5 * segments.SECONDS
    assert made.add(second) == []
    clock[0] = segments.SECONDS
    assert len(made.add(third)) == 1
    assert made.flush() == []


def test_names_never_repeat(study, tmp_path):
    names = set()
    for repeat in range(3):
        made = writer(study, tmp_path)
        for row in rows(study, 2):
            made.add(row | {"wall_time": float(repeat)})
            names |= {entry["segment"] for entry in made.flush()}
    assert len(names) == 6
