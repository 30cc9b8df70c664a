"""A hundred random geometries: each runs a few steps, or is refused with a reason; none crashes."""

from math import ceil

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rfmpm.ground import body_polygon, regions_of
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.solvers import SOLVERS
from rfmpm.mpm.state import AT_REST, RUNNING, start
from rfmpm.study import StudyError, load_study

CLAY = {
    "name": "clay",
    "law": "von_mises",
    "unit_weight_kn_m3": 20.0,
    "youngs_modulus_kpa": 2000.0,
    "poissons_ratio": 0.3,
    "cohesion_kpa": 15.0,
}
SAND = {
    **CLAY,
    "name": "sand",
    "law": "mohr_coulomb",
    "cohesion_kpa": 2.0,
    "friction_angle_deg": 30.0,
}
numbers = st.floats(0.0, 1.0)


@st.composite
def grounds(draw):
    """Tables of a study: two soils below a random ground, one above the other, corners now and then misplaced."""
    cell, foreland = draw(st.sampled_from([0.5, 0.4, 0.8])), draw(st.sampled_from([0.0, 3.0, 5.5]))
    widths = draw(st.lists(st.floats(1.0, 4.0), min_size=2, max_size=5))
    x = np.concatenate([[0.0], np.cumsum(widths)])
    x[-1] = length = max(ceil(x[-1] / cell), 5) * cell  # that a wall may stand there
    border = np.array([draw(st.floats(1.0, 4.0)) for _ in x])
    top = border + np.array([draw(st.floats(1.0, 4.0)) for _ in x])
    lower = [*zip(x, border, strict=True), (length, 0.0), (0.0, 0.0)]
    upper = [*zip(x, top, strict=True), *reversed(list(zip(x, border, strict=True)))]
    if draw(st.integers(0, 3)) == 3:
        corner = draw(st.integers(0, len(upper) - 1))
        upper[corner] = (upper[corner][0] + draw(st.floats(-2.0, 2.0)), upper[corner][1] + draw(st.floats(-2.0, 2.0)))
    regions = [("upper", "clay", upper), ("lower", "sand", lower)]
    geometry = {
        "kind": "regions",
        "foreland_m": foreland,
        "region": [
            {"name": name, "material": material, "corners_m": [[float(a), float(b)] for a, b in corners]}
            for name, material, corners in regions
        ],
    }
    if draw(st.integers(0, 2)) == 2:
        a, b = sorted((draw(numbers) * length, draw(numbers) * length))
        low = 8.0 * draw(numbers)
        geometry["cut"] = [{"corners_m": [[a, low], [b, low], [b, 9.0], [a, 9.0]]}]
    return {
        "study": {"name": "random ground", "seed": 1},
        "geometry": geometry,
        "discretisation": {"cell_m": cell, "points_per_cell": 4, "shape": "quadratic_bspline"},
        "boundary": {"base": {"kind": "friction", "coefficient": 0.3}, "sides": {"kind": "roller"}},
        "material": [CLAY, SAND],
        "time": {"end_s": 1.0},
        "output": {"directory": "results"},
    }


def built(tables):
    """The scene, or None where the study is refused with reasons."""
    study = problems = None
    try:
        study = load_study(tables)
    except StudyError as error:
        problems = error.problems
    if study is None:
        assert problems
        assert all(": " in problem for problem in problems)
        return None
    scene = scenes.build(study)
    assert np.isfinite(scene.points.stress.yy).all()
    area = scene.points.volume.sum()
    assert len(scene.points.mass) > 0
    assert area <= scene.body.length * scene.body.height * (1.0 + 1e-9)
    assert scene.body.toe >= scene.body.crest_edge
    return scene


EVERY = {"deadline": None, "derandomize": True, "max_examples": 100, "suppress_health_check": list(HealthCheck)}


@settings(**EVERY)
@given(grounds())
def test_a_ground_is_built_with_its_area_or_refused(tables):
    if (scene := built(tables)) is None:
        return
    study = load_study(tables)
    regions = regions_of(study.geometry, study.material[0].name, study.discretisation.cell_m)
    area = body_polygon(study.geometry, regions).area
    assert scene.points.volume.sum() == pytest.approx(area, rel=1e-3)  # what is asked; slivers are left out


@pytest.mark.slow
@settings(**EVERY)
@given(grounds())
def test_a_ground_runs_or_is_refused(tables):
    if (scene := built(tables)) is None:
        return
    now = SOLVERS["explicit"](start(), 0.05, *scenes.arguments(scene, scenes.release(scene, None)))
    assert now.status in (RUNNING, AT_REST)
    assert now.step_count > 0
