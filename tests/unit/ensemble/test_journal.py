import json

from rfmpm.ensemble.journal import Journal


def test_unfinished_starts_since_the_last_fresh_start_are_counted_once_each(tmp_path):
    journal = Journal(tmp_path / "journal.jsonl")
    journal.write("start", fresh=False)
    journal.write("unfinished_start", realisation=3, host="a", pid=1, started="t1")
    journal.write("start", fresh=True)
    journal.write("unfinished_start", realisation=5, host="a", pid=1, started="t1")
    journal.write("unfinished_start", realisation=5, host="a", pid=1, started="t1")  # told twice
    with journal.path.open("a") as file:
        file.write('{"event": "unfinished_sta\n')
    journal.write("unfinished_start", realisation=5, host="a", pid=1, started="t2")
    journal.write("unfinished_start", realisation=6, host="b", pid=1, started="t2")
    assert journal.unfinished_starts() == {5: 2, 6: 1}
    assert journal.started() == json.loads(journal.path.read_text().splitlines()[2])["time"]


def test_a_campaign_ended_when_its_last_rows_were_written_and_not_when_it_was_asked_for_again(tmp_path):
    journal = Journal(tmp_path / "journal.jsonl")
    journal.write("start", fresh=False)
    assert journal.ended() == journal.started()
    for event in ("segment", "segment", "start", "stop"):
        journal.write(event)
    assert journal.ended() == json.loads(journal.path.read_text().splitlines()[2])["time"]


def test_a_line_after_a_torn_one_is_read(tmp_path):
    journal = Journal(tmp_path / "journal.jsonl")
    journal.path.write_text('{"event": "sta')
    journal.write("start")
    journal.write("segment")
    assert [event["event"] for event in journal.events()] == ["start", "segment"]


def test_journal_without_a_file_is_empty(tmp_path):
    assert Journal(tmp_path / "journal.jsonl").events() == []
