import json
import os

from rfmpm.ensemble.markers import Marker, Task, take_left_behind


def test_marker_says_what_runs_and_goes_with_its_worker(tmp_path):
    (tmp_path / "running").mkdir()
    marker = Marker(tmp_path, 3)
    marker.put(Task(7, 1))
    marker.put(Task(9, 2))
    (path,) = (tmp_path / "running").iterdir()
    content = json.loads(path.read_text())
    assert (path.name, content["realisation"], content["attempt"], content["pid"]) == ("00003.json", 9, 2, os.getpid())
    marker.remove()
    assert take_left_behind(tmp_path) == []


def test_what_is_left_behind_is_taken_once_and_a_torn_one_tells_nothing(tmp_path, caplog):
    (tmp_path / "running").mkdir()
    Marker(tmp_path, 0).put(Task(4))
    (tmp_path / "running" / "00001.json").write_text('{"realisation": 5, "att')
    (tmp_path / "running" / "00002.json").write_text("")
    (found,) = take_left_behind(tmp_path)
    assert (found["realisation"], found["rank"]) == (4, 0)
    assert [record.args[0].name for record in caplog.records] == ["00001.json", "00002.json"]
    assert list((tmp_path / "running").iterdir()) == []
