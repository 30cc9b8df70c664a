"""Every case of the papers, on coarse cells: it runs, is judged, and its page says so.

Whether a statement agrees is left to the run on the cells of the page, in reports/papers; what must come out on coarse
cells is asked for in the folder of each paper.
"""

import csv
from functools import cache

import pytest

from rfmpm.benchmark.papers import CASES
from rfmpm.benchmark.papers.case import REPOSITORY, Case, Figure, Finding, Reproduction
from rfmpm.benchmark.papers.document import write


@cache
def reproduced(name):
    return CASES[name].reproduce(True)


@pytest.mark.parametrize("name", CASES)
def test_every_statement_is_judged(name):
    for finding in reproduced(name).findings:
        assert finding.said
        assert finding.criterion
        assert finding.found
        assert isinstance(finding.agrees, bool)


def test_pages_in_reports_hold_every_case_and_a_reason_for_every_disagreement():
    with (REPOSITORY / "reports" / "papers" / "findings.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["case"] for row in rows} == set(CASES)
    assert all(row["agrees"] == "True" or row["reason"] for row in rows)


@pytest.mark.parametrize("name", CASES)
def test_every_picture_is_drawn_and_captioned(name, tmp_path):
    assert reproduced(name).figures
    for number, figure in enumerate(reproduced(name).figures):
        figure.draw(tmp_path / f"{number}.png")
        assert figure.caption
        assert (tmp_path / f"{number}.png").read_bytes().startswith(b"\x89PNG")


def toy(agrees):
    finding = Finding("it slides", "moves", "1 m", agrees, "" if agrees else "too strong")
    figure = Figure("a picture", lambda path: path.write_bytes(b"picture"))
    return Case(
        "Toy", "Nobody (1900)", "It slides.", (), "All.", lambda coarse: Reproduction([finding], [figure], "Why.")
    )


def test_pages_name_their_command_and_the_list_counts_what_agrees(tmp_path, monkeypatch):
    monkeypatch.setattr("rfmpm.benchmark.papers.document.CASES", {"first": toy(True), "second": toy(False)})
    told = []
    for names in (["first", "second"], ["second"]):  # again: its lines take the place of the earlier ones
        write(names, tmp_path, "python papers.py", told.append)
    page, other, summary = ((tmp_path / name).read_text() for name in ("second.md", "first.md", "index.md"))
    assert "python papers.py second" in page
    assert "**disagrees**" in page
    assert "too strong" in page
    assert "disagree" not in other
    assert "1 of 2 agree" in summary
    assert (tmp_path / "findings.csv").read_text().count("\n") == 3
    assert (tmp_path / "second.png").exists()
    assert len(told) == 3
