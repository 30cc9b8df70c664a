"""Oscillation of stresses, and compression of a column: Vardon (2016), lecture, TU Delft, on coarse cells."""

import numpy as np
import pytest

from rfmpm.benchmark.papers.column_compression import compressed
from rfmpm.benchmark.papers.oscillation import NEIGHBOURS, components, oscillation
from rfmpm.benchmark.papers.stress_oscillation import SHAPE, settled


def lattice():
    x, y = np.meshgrid(np.arange(60) * 0.125, np.arange(40) * 0.125)
    return x.ravel(), y.ravel()


def test_field_that_changes_evenly_does_not_oscillate():
    x, y = lattice()
    assert oscillation(x, y, 3.0 - 2.0 * x + 5.0 * y) < 1e-12


def test_noise_oscillates_by_itself_and_by_what_its_neighbours_foresee():
    x, y = lattice()
    noise = np.random.default_rng(1).standard_normal(len(x))
    # A plane through twelve points foresees their mean at their middle: variance 1/12 more. The share of two mean
    # squares of n values; neighbours share points, so that about n / 12 of them are independent.
    error = np.sqrt(2.0 / (len(x) / NEIGHBOURS)) / 2.0
    assert oscillation(x, y, noise) == pytest.approx(np.sqrt(1.0 + 1.0 / NEIGHBOURS), abs=4.0 * error)


def test_components_of_known_stresses():
    state = {"xx": [-3.0, 1.0], "yy": [-3.0, -1.0], "zz": [-3.0, 0.0], "xy": [0.0, 2.0]}
    found = components({f"stress_{name}": np.array(values) for name, values in state.items()})
    np.testing.assert_allclose(found["isotropic"], [-3.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(found["deviatoric"], [0.0, np.sqrt(1.0 + 4.0)], atol=1e-12)
    np.testing.assert_allclose(found["tangential"], [0.0, 2.0], atol=1e-12)


def test_linear_shapes_oscillate_where_points_cross_cells_and_splines_do_not():
    found = {}
    for shape in ("linear", "quadratic_bspline"):
        points = settled({SHAPE: shape, "discretisation.cell_m": 0.5, "material.0.youngs_modulus_kpa": 150.0})
        assert np.hypot(points["displacement_x"], points["displacement_y"]).max() > 0.75  # a cell and a half
        found[shape] = {
            name: oscillation(points["x"], points["y"], values) for name, values in components(points).items()
        }
    for name, share in found["linear"].items():
        assert share > 3.0 * found["quadratic_bspline"][name]


def test_compressed_column_comes_to_its_exact_stress_with_splines_and_not_with_linear_shapes():
    linear, spline = ([compressed(shape, count).error for count in (10, 40)] for shape in ("linear", "cubic_bspline"))
    assert spline[1] < 0.5 * spline[0]
    assert spline[1] < 0.005  # of the stress at the base
    assert linear[1] > linear[0]
    assert linear[1] > 10.0 * spline[1]
