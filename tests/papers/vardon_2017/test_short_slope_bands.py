"""What the runs of the short slope are judged by, on bands that are painted and on a run with coarse cells."""

from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

from rfmpm.benchmark.papers.case import study
from rfmpm.benchmark.papers.short_slope import COARSE, PARTED, STUDY, Run, run
from rfmpm.benchmark.papers.short_slope_stress_regions import (
    AT_RESIDUAL,
    AT_YIELD,
    ELASTIC,
    REGIONS,
    SOFTENING,
    TIMES,
    UNLOADING,
    regions,
    shares,
)

CREST, HEIGHT, SPACING = 10.0, 5.0, 0.25  # [m]
AT_PEAK, SOFTENED = 0.0, 1.0  # plastic strain [-]; 4 kPa are reached at 0.16


@cache
def coarse():
    return run(COARSE)


def painted(*bands):
    """A rectangle as long as the crest; soil within a spacing of each band's x, above its y, is at its residual."""
    places = np.arange(0.5 * SPACING, CREST, SPACING), np.arange(0.5 * SPACING, HEIGHT, SPACING)
    x, y = (axis.ravel() for axis in np.meshgrid(*places))
    strain = np.full(len(x), AT_PEAK)
    for place, bottom in bands:
        strain[(np.abs(x - place) < 0.6 * SPACING) & (y > bottom)] = SOFTENED
    points = {"x_initial": x, "y_initial": y, "plastic_strain": strain, "displacement_y": -x}
    return points | {"cohesion": np.full(len(x), 20e3)}


def judged(*states):
    frames = [(float(time), points) for time, points in enumerate(states)]
    return Run(study(STUDY, COARSE), SimpleNamespace(points=states[-1], frames=frames))


def test_band_from_base_to_crest_cuts_it_and_one_that_ends_on_the_way_does_not():
    whole, begun, cut = painted(), painted((6.0, 2.0)), painted((6.0, 0.0))
    own = judged(whole, begun, cut)
    assert own.standing(whole) == own.standing(begun) == CREST
    assert own.standing(cut) == pytest.approx(6.0, abs=SPACING)
    assert [cut.time for cut in own.cuts] == [2.0]


def test_bands_count_as_two_where_they_are_far_apart():
    near, far = 6.0 - 0.7 * PARTED, 6.0 - 2.0 * PARTED
    bands = [(6.0, 0.0)], [(6.0, 0.0), (near, 0.0)], [(6.0, 0.0), (far, 0.0)]
    assert [cut.time for cut in judged(*(painted(*some) for some in bands)).cuts] == [0.0, 2.0]


def test_pieces_are_what_bands_cut_the_crest_into():
    points = painted((3.0, 0.0), (7.0, 0.0))
    back, middle, front = judged(points).pieces(points)
    assert back.front < 3.0 < middle.back < middle.front < 7.0 < front.back
    assert middle.area == pytest.approx(4.0 * HEIGHT, abs=2.0 * SPACING * HEIGHT)
    assert middle.settlement == pytest.approx(5.0, abs=SPACING)
    assert len(judged(painted((3.0, 2.0))).pieces(painted((3.0, 2.0)))) == 1


@pytest.mark.parametrize("time", TIMES)
def test_regions_are_told_by_what_the_soil_went_through(time):
    own = coarse()
    points = own.at(time)
    where, strain = regions(own, points), points["plastic_strain"]
    assert np.all(strain[where == ELASTIC] == 0.0)
    assert np.all(strain[where == AT_RESIDUAL] >= own.residual_strain[where == AT_RESIDUAL])
    for partly in (SOFTENING, UNLOADING):
        assert np.all(strain[where == partly] > 0.0)
        assert np.all(strain[where == partly] < own.residual_strain[where == partly])
    assert shares(own, time).sum() == pytest.approx(1.0, rel=1e-12)


def test_strength_that_the_regions_are_told_by_is_that_of_the_law():
    own = coarse()
    points = own.at(TIMES[0])
    soft = regions(own, points) == SOFTENING
    lost = 0.8 * points["plastic_strain"] / own.residual_strain
    normal = np.array([points[f"stress_{axis}"] for axis in ("xx", "yy", "zz")])
    j2 = 0.5 * ((normal - normal.mean(axis=0)) ** 2).sum(axis=0) + points["stress_xy"] ** 2
    ratio = np.sqrt(j2[soft]) / (20e3 * (1.0 - lost[soft]))
    assert ratio.max() == pytest.approx(1.0, rel=1e-9)  # rounding, over many steps: nothing lies beyond yield
    assert ratio.min() > AT_YIELD


def test_every_region_is_there_while_it_slides_and_nothing_softens_at_rest():
    sliding, resting = shares(coarse(), TIMES[0]), shares(coarse(), TIMES[-1])
    assert len(sliding) == len(REGIONS)
    assert sliding.min() > 0.01
    assert resting[SOFTENING] < 0.005
    assert resting[AT_RESIDUAL] > sliding[AT_RESIDUAL]
    assert resting[ELASTIC] < sliding[ELASTIC]
