"""Collapse of planar granular columns on a rough base: Lube et al. (2005), Phys. Rev. E 72, 041301, and Lajeunesse et
al. (2005), Phys. Fluids 17, 103302.

The experiments of both lie between their two laws of the run-out; so must ours. Nothing is fitted; the friction angle
is 31 degrees, that of dry sand. Found, as a share of the law of Lube et al.:

    a                               0.5   1     2     3     5     8
    cells of a tenth of L0          0.82  0.97  0.89  0.98  1.11  1.15
    cells of a twentieth            1.04  1.14  0.94  1.09  1.18  1.19

On cells of a tenth flat columns stop short, the soil that flows being one or two cells thick. The experiments found no
influence of the friction angle; the continuum has one: 3 degrees are worth a tenth.
"""

from functools import cache

import numpy as np
import pytest

from rfmpm.benchmark.frictional import columns

run_out = cache(columns.run_out)
TALL = (3.0, 5.0, 8.0)
TOLERANCE = 0.2  # of a run-out: three degrees of friction are worth a tenth, half the cell another tenth


def test_laws_are_those_of_the_papers():
    assert columns.lube(1.0) == (1.2, 1.2)
    assert columns.lube(8.0) == pytest.approx((7.6, 7.6), rel=1e-12)  # identity: 1.9 * 8^(2/3)
    assert columns.span(2.0) == pytest.approx((2.4, 3.6), rel=1e-12)
    assert columns.span(8.0) == pytest.approx((7.6, 9.2), rel=1e-12)


@pytest.mark.parametrize("aspect", [1.0, 2.0])
def test_run_out_lies_between_the_two_laws(aspect):
    low, high = columns.span(aspect)
    assert low <= run_out(aspect, 20) <= high


@pytest.mark.slow
@pytest.mark.parametrize("aspect", sorted(set(columns.ASPECTS) - {1.0, 2.0}))
def test_run_out_of_flat_and_tall_columns_lies_between_the_two_laws(aspect):
    low, high = columns.span(aspect)
    assert low <= run_out(aspect, 20) <= high


def test_run_out_grows_with_the_height_and_falls_with_friction():
    reaches = [run_out(aspect, 10) for aspect in columns.ASPECTS]
    assert reaches == sorted(reaches)
    assert run_out(2.0, 10, 34.0) < run_out(2.0, 10) < run_out(2.0, 10, 28.0)


def test_tall_columns_run_out_with_a_power_of_about_two_thirds():
    exponent = np.polyfit(np.log(TALL), np.log([run_out(aspect, 10) for aspect in TALL]), 1)[0]
    # Found 0.82; the experiments' 2/3 belongs to the whole range above 2.8, with a tolerance of the run-outs above.
    assert exponent == pytest.approx(2.0 / 3.0, abs=np.log((1.0 + TOLERANCE) / (1.0 - TOLERANCE)) / np.log(8.0 / 3.0))
