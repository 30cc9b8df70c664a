"""The average of the plastic strain: exact for a uniform strain, the Gaussian's for a wave, the same on any grid."""

from math import exp, pi

import numpy as np
import pytest

from rfmpm.kernel_tools import Tensor, Vector
from rfmpm.mpm.geometry import fill
from rfmpm.mpm.laws.history import NonlocalHistory
from rfmpm.mpm.nonlocal_softening import OVERSHOOT, average_softening, averaging, shape_variance
from rfmpm.mpm.shapes import SHAPES, build_axis
from rfmpm.mpm.state import Axes, Points

LENGTH, WIDTH, HEIGHT = 0.5, 8.0, 4.0  # [m]
every_shape = pytest.mark.parametrize("shape", SHAPES)


def averaged(strain, cell=0.125, shape="quadratic_bspline", before=0.0):
    """Horizontal positions, and softening strain of points that fill the domain with a plastic strain of x."""
    axes = Axes(*(build_axis(shape, cell, round(extent / cell), 4) for extent in (WIDTH, HEIGHT)))
    outline = np.array([(0.0, 0.0), (WIDTH, 0.0), (WIDTH, HEIGHT), (0.0, HEIGHT)])
    position, volume = fill(outline, cell, 4)
    x, y = position.T.copy()
    nothing = np.zeros_like(volume)
    points = Points(Vector(x, y), Vector(nothing, nothing), volume, volume, Tensor(nothing, nothing, nothing, nothing))
    history = NonlocalHistory(strain(x), np.full_like(volume, before))
    box = 0, axes.x.cells, 0, axes.y.cells
    average_softening(points, history, axes, averaging(LENGTH, history, axes), box)
    return x, y, history


@every_shape
def test_a_uniform_strain_is_its_own_average_up_to_the_edges(shape):
    _, _, history = averaged(lambda x: np.full_like(x, 0.3), shape=shape)
    np.testing.assert_allclose(history.averaged_strain, 0.3, rtol=1e-12)  # identity


@pytest.mark.parametrize("cell", [0.5, 0.25, 0.125])
def test_a_wave_is_damped_as_by_a_gaussian_whatever_the_cell(cell):
    wave = 2.0 * pi / 4.0  # [1/m]
    x, y, history = averaged(lambda x: 1.0 + np.cos(wave * x), cell=cell)
    kept = exp(-0.5 * (wave * LENGTH) ** 2)
    expected = 1.0 + np.cos(wave * x) * (1.0 - OVERSHOOT + OVERSHOOT * kept)
    inside = (abs(x - 0.5 * WIDTH) < 2.0) & (abs(y - 0.5 * HEIGHT) < 0.5)
    # The variances agree; the next moments differ by the fourth order of wave times cell: 0.08, 0.005, 0.0003 of 2 m.
    error = np.abs(history.averaged_strain - expected)[inside].max()
    assert error < 0.3 * (wave * cell) ** 4 + 0.003  # 0.003: the Gaussian is cut off at 3.5 standard deviations


def test_strength_once_lost_stays_lost():
    _, _, history = averaged(lambda x: np.zeros_like(x), before=0.7)
    assert (history.averaged_strain == 0.7).all()


@pytest.mark.parametrize(("shape", "variance"), [("linear", 1 / 6), ("quadratic_bspline", 1 / 4)])
def test_variance_of_a_shape(shape, variance):
    # The mean over 64 midpoints misses the integral of f (1 - f) by 1 / (12 * 64^2) = 2.03e-5.
    assert shape_variance(build_axis(shape, 0.5, 12, 4)) == pytest.approx(variance, abs=2.1e-5)
