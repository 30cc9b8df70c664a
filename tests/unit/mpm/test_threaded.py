"""Threads that share every step: the result of one, the same each time, and the same way to end."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import rfmpm
from rfmpm import realisation
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.solvers import SOLVERS, Alone
from rfmpm.mpm.state import LEFT_GRID, RUNNING, start
from rfmpm.study import StudyError

pytestmark = pytest.mark.timeout(900)  # the first test of a scene compiles two engines

SLOPE = rfmpm.load_study(Path(__file__).parents[3] / "configs" / "short_slope.toml").with_changes(
    {"discretisation.cell_m": 0.5, "geometry.foreland_m": 5.0, "material.0.cohesion_kpa": 10.0, "time.end_s": 1.5}
)
TIME = SLOPE.time.end_s  # the slope yields; the filter and the average of the softening act several times
PLAIN = {"discretisation.volumetric_strain": "point", "material.0.softening_length_m": None}
SCENES = {"means over cells, softening over a length": {}, "neither": PLAIN}


@pytest.fixture(scope="module", params=SCENES.values(), ids=SCENES.keys())
def scene(request):
    return scenes.build(SLOPE.with_changes(request.param))


def run(scene, threads, astray=None):
    """Progress and what a realisation owns at TIME; `astray`: a point that starts below the base."""
    own = scenes.release(scene, None)
    if astray is not None:
        own.points.position.y[astray] = -0.1
    return SOLVERS["explicit"](start(), TIME, *scenes.arguments(scene, own, threads)), own


def arrays(own):
    return *own.points.position, *own.points.velocity, own.points.volume, *own.points.stress, *own.history


@pytest.mark.slow
@pytest.mark.parametrize("threads", [2, 3])
def test_threads_find_what_one_finds(scene, threads):
    (one_now, one), (now, own) = run(scene, 1), run(scene, threads)
    assert now.status == one_now.status == RUNNING
    assert now.step_count == one_now.step_count > 100
    assert own.history.plastic_strain.max() > 1e-2
    # Sums over nodes and cells are taken in another order: rounding, which grows a little from step to step.
    for found, expected in zip(arrays(own), arrays(one), strict=True):
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-9 * np.abs(expected).max())
    np.testing.assert_allclose(now, one_now, rtol=1e-9, atol=1e-9 * one_now.stress_work)


@pytest.mark.slow
def test_the_same_threads_find_the_same_bits(scene):
    (first_now, first), (now, own) = run(scene, 2), run(scene, 2)
    assert now == first_now
    for found, expected in zip(arrays(own), arrays(first), strict=True):
        np.testing.assert_array_equal(found, expected)


@pytest.mark.slow
def test_bits_depend_on_the_shares_and_not_on_who_takes_them(scene):
    (now, own), alike = run(scene, 3), scenes.release(scene, None)
    *arguments, team = scenes.arguments(scene, alike, 3)
    assert SOLVERS["explicit"](start(), TIME, *arguments, team._replace(threads=1)) == now
    for found, expected in zip(arrays(alike), arrays(own), strict=True):
        np.testing.assert_array_equal(found, expected)


@pytest.mark.slow
@pytest.mark.parametrize("astray", [0, -1])  # a point of the first share, of the last
def test_a_lost_point_ends_the_run_of_all(scene, astray):
    now, _ = run(scene, 2, astray)
    assert now.status == LEFT_GRID
    assert now.culprit == astray % len(scene.points.mass)


@pytest.mark.slow
def test_a_realisation_takes_threads():
    one, two = rfmpm.simulate(SLOPE, threads=1), rfmpm.simulate(SLOPE, threads=2)
    assert two.step_count == one.step_count
    np.testing.assert_allclose(two.points["x"], one.points["x"], rtol=1e-9)  # rounding, as above
    assert (two.points["x"] != one.points["x"]).any()


@pytest.mark.slow
def test_another_process_loads_them_from_the_cache(scene):
    run(scene, 2)
    code = (
        "from rfmpm import load_study\nfrom rfmpm.mpm import scene as scenes\nfrom rfmpm.mpm.solvers import advance\n"
        "from rfmpm.mpm.state import start\n"
        f"scene = scenes.build(load_study({str(Path(__file__).parents[3] / 'configs' / 'short_slope.toml')!r}))\n"
        "advance(start(), 0.1, *scenes.arguments(scene, scenes.release(scene, None), 2))\n"
        "print(sum(advance.stats.cache_hits.values()), sum(advance.stats.cache_misses.values()))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=os.environ)
    assert done.stdout.split() == ["1", "0"]


@pytest.mark.parametrize("threads", [0, -1, 10_000])
def test_no_threads_and_more_than_points_are_refused(threads):
    with pytest.raises(StudyError, match=rf"threads = {threads}: .*between 1 and \d+"):
        rfmpm.simulate(SLOPE, threads=threads)


def test_a_large_scene_alone_is_worth_more_than_one_thread(monkeypatch):
    monkeypatch.setattr(realisation, "start_threads", lambda: 7)
    prepared = realisation.prepare(SLOPE)
    assert realisation.threads_for(prepared) == 1
    monkeypatch.setattr(realisation, "WORTH_SHARING", len(prepared.scene.points.mass))
    assert realisation.threads_for(prepared) == 7


def test_a_row_of_an_ensemble_is_never_shared(monkeypatch):
    taken = []
    monkeypatch.setattr(realisation, "WORTH_SHARING", 1)
    monkeypatch.setitem(
        SOLVERS,
        "explicit",
        lambda now, until, *arguments: taken.append(arguments[-1]) or now._replace(status=LEFT_GRID),
    )
    realisation.run(realisation.prepare(SLOPE), index=0)
    assert taken == [Alone()]
