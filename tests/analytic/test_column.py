"""An elastic column between rollers under its own weight: initial stresses, and rest when it is released."""

import numpy as np
import pytest

WEIGHT, HEIGHT = 20e3, 2.0  # [N/m3], [m]
every_shape = pytest.mark.parametrize("shape", ["linear", "quadratic_bspline"])


def column(blocks, cell=0.25, points=4, shape="quadratic_bspline"):
    return blocks.scene(
        1.0, HEIGHT, 0.0, cell=cell, discretisation__points_per_cell=points, discretisation__shape=shape
    )


def stress_error(scene):
    """Largest error of the vertical stress over unit weight times cell: the stress that one more cell brings."""
    exact = -WEIGHT * (HEIGHT - scene.points.position.y)
    return np.abs(scene.points.stress.yy - exact).max() / (WEIGHT * scene.cell)


@every_shape
def test_one_point_per_cell_has_the_exact_stress(blocks, shape):
    # In the middle of a cell both shapes take the mean of what the node above and below carry. The shift that keeps
    # the solve regular is 1e-10 of the stiffness.
    assert stress_error(column(blocks, points=1, shape=shape)) < 1e-6


@every_shape
@pytest.mark.parametrize("points", [4, 9])
def test_stress_is_unit_weight_times_depth(blocks, shape, points):
    # Points feel the stress their interpolation can carry: linear shapes have one in a cell (a third of a cell off for
    # 9 points), B-splines one within half a cell of the base; near the top the grid ends in the air.
    assert stress_error(column(blocks, points=points, shape=shape)) < {"linear": 0.34, "quadratic_bspline": 0.2}[shape]


@every_shape
def test_error_of_the_stress_falls_with_the_cell(blocks, shape):
    errors = [stress_error(column(blocks, cell, shape=shape)) * cell for cell in (0.5, 0.25, 0.125)]
    # Order 1 in the largest error, which sits at the base and at the top.
    assert np.polyfit(np.log((0.5, 0.25, 0.125)), np.log(errors), 1)[0] == pytest.approx(1.0, abs=0.1)


@every_shape
def test_lateral_stress_is_that_of_a_confined_column(blocks, shape):
    stress = column(blocks, shape=shape).points.stress
    confined = 0.33 / 0.67 * stress.yy
    for across in (stress.xx, stress.zz):
        np.testing.assert_allclose(across, confined, rtol=0.0, atol=1e-9 * WEIGHT * HEIGHT)
    assert np.abs(stress.xy).max() < 1e-9 * WEIGHT * HEIGHT


@every_shape
@pytest.mark.parametrize("points", [1, 4, 9])
def test_released_column_stays_at_rest(blocks, shape, points):
    scene = column(blocks, points=points, shape=shape)
    flight = blocks.flight(blocks.launched(scene, stress=scene.points.stress))
    flight.until(1.0)
    assert flight.now.step_count > 100
    # The solve leaves 1e-10 of the weight out of balance: speeds of that times g t, energies of its square.
    energy = flight.points.mass.sum() * (9.81 * 1.0) ** 2
    assert flight.now.kinetic < (1e-9) ** 2 * energy
    moved = np.hypot(*(now - then for now, then in zip(flight.points.position, scene.points.position, strict=True)))
    assert moved.max() < 1e-9 * HEIGHT
