"""The stress test's judge, its guard and its report, on cases that take no time."""

import os
import time
from functools import partial

import numpy as np
import pytest

from rfmpm import realisation
from rfmpm.benchmark.stability import arrangements, guard, verdict
from rfmpm.benchmark.stability.case import Case, Sweep
from rfmpm.benchmark.stability.document import write_report
from rfmpm.benchmark.stability.pictures import draw_overview, draw_sweep, places, worst
from rfmpm.benchmark.stability.sweeps import all_sweeps
from rfmpm.study import StudyError

SHORT = {
    "discretisation.cell_m": 1.0,
    "material.0.softening_length_m": 1.0,
    "time.end_s": 0.5,
    "material.0.cohesion_kpa": 30.0,
}
UNHEARD = Case("a", "b", {"time.step_fraction": 1.1}, refusal="time.step_fraction")


def ran(case=None):
    prepared = realisation.prepare((case or Case("a", "b", SHORT)).study())
    return realisation.simulate(prepared), prepared


def refusal_of(case):
    try:
        case.study()
    except StudyError as error:
        return error.problems
    return []


def test_every_case_is_a_study_or_refused_with_the_key_it_names():
    for sweep in all_sweeps():
        for case in sweep.cases:
            problems = refusal_of(case)
            assert bool(problems) == bool(case.refusal), (sweep.name, case, problems)
            assert all(case.refusal in problem for problem in problems)


def test_a_sound_run_is_done():
    assert verdict.judge(Case("a", "b", SHORT)).kind in (verdict.DONE, verdict.OPEN)


def test_a_refusal_is_right_only_where_it_names_the_key():
    assert verdict.judge(UNHEARD).kind == verdict.REFUSED
    assert verdict.judge(Case("a", "b", UNHEARD.changes)).kind == verdict.FAIL
    assert verdict.judge(Case("a", "b", UNHEARD.changes, refusal="material.0")).kind == verdict.FAIL


def test_a_run_beyond_the_critical_step_is_stopped_and_its_advice_put_to_the_test():
    beyond = partial(arrangements.beyond_the_critical_step, 4.0)
    stopped = verdict.judge(Case("a", "b", SHORT, arrange=beyond, may_stop=True))
    assert stopped.kind == verdict.STOPPED
    # The step is forced, so that the smaller one of the advice is none.
    assert verdict.judge(Case("a", "b", SHORT, arrange=beyond)).kind == verdict.FAIL


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("stress_xy", np.nan, "not a number"),
        ("x", -1.0, "outside the domain"),
        ("y", 1e3, "outside the domain"),
        ("volume", -1.0, "inside out"),
        ("velocity_x", 1e3, "twice the speed"),
        ("stress_xy", 1e6, "outside the yield surface"),
    ],
)
def test_what_cannot_be_is_found(name, value, said):
    outcome, prepared = ran()
    assert verdict.faults(outcome, prepared) == []
    outcome.points[name][3] = value
    assert said in verdict.faults(outcome, prepared)[0]


def test_contrast_is_between_neighbours_and_of_the_ratio():
    fields = {"random_field.cohesion": next(s for s in all_sweeps() if s.name == "variability").cases[0].changes[
        "random_field.cohesion"]}  # fmt: skip
    prepared = arrangements.contrast(
        "every other point", 1000.0, realisation.prepare(Case("a", "b", SHORT | fields).study())
    )
    values = prepared.fields["cohesion"].parts[0].field.marginal.transform(None)
    # identity: the ratio is a product of two roots
    assert values.max() / values.min() == pytest.approx(1000.0, rel=1e-12)
    first, second = np.argsort(np.column_stack(prepared.scene.points.position) @ [1.0, 1e6])[:2]
    assert values[first] != values[second]


def test_a_process_that_dies_is_a_verdict_and_the_next_case_runs():
    watch = guard.Guard(60.0)
    try:
        dead = watch.judge(Case("a", "b", SHORT, arrange=partial(die, 7)))
        assert dead.kind == verdict.FAIL
        assert "exit code 7" in dead.words
        assert watch.judge(UNHEARD).kind == verdict.REFUSED
    finally:
        watch.close()


def die(code, prepared):
    os._exit(code)


def test_a_run_without_end_is_a_failure_and_a_busy_machine_is_none():
    watch = guard.Guard(60.0)
    try:
        watch.judge(UNHEARD)  # starts the process
        watch.patience = 1.0
        assert "ZeroDivisionError" in watch.judge(Case("a", "b", SHORT, arrange=partial(wait, 2.0))).words
        endless = watch.judge(Case("a", "b", SHORT, arrange=go_on))
        assert (endless.kind, endless.words) == (verdict.FAIL, "no end after 1 s of computing")
    finally:
        watch.close()


def wait(seconds, prepared):
    time.sleep(seconds)
    return 1 / 0


def go_on(prepared):
    while True:
        pass


def test_an_error_is_a_verdict():
    watch = guard.Guard(60.0)
    try:
        assert "ZeroDivisionError" in watch.judge(Case("a", "b", SHORT, arrange=divide_by_nothing)).words
    finally:
        watch.close()


def divide_by_nothing(prepared):
    return 1 / 0


def test_a_place_shows_its_worst_and_the_report_names_every_failure(tmp_path):
    sweep = Sweep("toy", "Toy", "rows", "columns", [Case("a", "1"), Case("a", "1"), Case("a", "2")])
    verdicts = [verdict.Verdict(verdict.DONE, "", 0.001), verdict.Verdict(verdict.FAIL, "lost"),
                verdict.Verdict(verdict.STOPPED, "left")]  # fmt: skip
    assert worst(places(sweep, verdicts)["a", "1"]) == verdict.FAIL
    draw_sweep(sweep, verdicts, tmp_path / "sweep.png")
    draw_overview([(sweep, verdicts)], tmp_path / "all.png")
    text = write_report([(sweep, verdicts)])
    assert "| Toy | a; 1 | lost |" in text
    assert "| Toy | a; 2 | left |" in text
