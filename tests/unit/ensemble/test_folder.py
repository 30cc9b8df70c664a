import json

from rfmpm.ensemble import folder


def test_differences_name_keys_that_only_one_study_has(study):
    text = study.to_toml().replace("surface_bin_m = 1.0\n", "")
    other = folder.load_study(text)
    assert folder.differences(study, other) == ["output.surface_bin_m: 1.0 -> absent"]


def test_journal_counts_deaths_since_the_last_fresh_start_and_survives_a_torn_line(tmp_path):
    journal = folder.Journal(tmp_path / "journal.jsonl")
    journal.write("start", fresh=False)
    journal.write("worker_lost", rank=0, realisation=3)
    journal.write("start", fresh=True)
    journal.write("worker_lost", rank=0, realisation=5)
    journal.write("worker_lost", rank=1, realisation=None)
    with journal.path.open("a") as file:
        file.write('{"event": "worker_l\n')
    journal.write("worker_lost", rank=0, realisation=5)
    assert journal.fatal_starts() == {5: 2}
    assert journal.started() == json.loads(journal.path.read_text().splitlines()[2])["time"]


def test_a_campaign_ended_when_its_last_rows_were_written_and_not_when_it_was_asked_for_again(tmp_path):
    journal = folder.Journal(tmp_path / "journal.jsonl")
    journal.write("start", fresh=False)
    assert journal.ended() == journal.started()
    for event in ("segment", "segment", "start", "stop"):
        journal.write(event)
    assert journal.ended() == json.loads(journal.path.read_text().splitlines()[2])["time"]


def test_journal_without_a_file_is_empty(tmp_path):
    assert folder.Journal(tmp_path / "journal.jsonl").events() == []
