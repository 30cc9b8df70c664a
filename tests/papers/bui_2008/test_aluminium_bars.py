"""Collapse of aluminium bars: Bui et al. (2008), Int. J. Numer. Anal. Methods Geomech. 32, 1537-1570.

Surface: at each x the height that the soil there would have at its first density, the mass being spread with the
quadratic B-spline of one cell and mirrored at the wall. The measured curve, `surface.csv`, was read from the paper's
figure to about 1 mm; the area below it is 203 cm2, that of the column 200 cm2, so that no computed surface that keeps
its mass comes closer than about 0.7 mm.

The measure of the surface matters as much as the cells. It was chosen after others had been looked at, because it keeps
the mass and has least noise from single points. Mohr-Coulomb at 10, 5, 2.5 mm, root mean square: this 1.4, 3.0, 3.7;
the same with the points' present volumes, gaps included, 1.7, 3.4, 3.8; volume in a column one cell wide, unsmoothed,
2.3 and 4.2; top of the highest point in that column 3.3 and 3.9 mm (these two at 10 and 5 mm). Which one stands behind
the peer's figure is not known, so that "closer than the best peer" holds for this measure and 10 mm cells alone.

The best published code known to us has a root mean square of 1.7 mm. With the soil's data as given, none fitted:

    cell              10 mm   5 mm   2.5 mm
    Mohr-Coulomb       1.4    3.0    3.7 mm
    Drucker-Prager     1.4    3.0    3.8 mm

It grows as the cells shrink: the share of numerical dissipation falls from 14 to 5 % of gravity's work and the crest
sinks, by 2 to 6 mm, while the front comes to where it was measured. So the good match on coarse cells is in part that
of two errors. At 5 mm a step of 0.2 of the critical one (2.6), dissipation in 0.1 s (2.7), nine points per cell (3.1),
a stiffness five times higher (2.8) and a rough wall (3.0 mm) change little. Friction does: were 19.8 degrees the angle
of a direct shear test, tan(19.8) = sin(phi) without dilation, phi would be 21.1 and the figures 1.6 mm at 5 and 2.3 mm
at 2.5 mm.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

import rfmpm

HERE = Path(__file__).parent
STUDY = HERE.parents[2] / "configs" / "papers" / "bui_2008_aluminium_bars.toml"
AREA = 0.02  # [m2]
BEST_PEER = 1.7e-3  # [m]


@cache
def measured():
    """Measured surface: x and height, shape (n,) each [m]."""
    return tuple(np.loadtxt(HERE / "surface.csv", delimiter=",").T / 1e3)


@cache
def outcome(law, cell):
    study = rfmpm.load_study(STUDY)
    return rfmpm.simulate(study.with_changes({"discretisation.cell_m": cell, "material.0.law": law}))


def spline(distance):
    """Quadratic B-spline of unit width and integral."""
    r = np.abs(distance)
    return np.where(r < 0.5, 0.75 - r * r, np.where(r < 1.5, 0.5 * (1.5 - r) ** 2, 0.0))


def surface(points, cell, at):
    """Height of the soil at its first density, at the places `at`, shape (n,) [m]."""
    x, area = points["x"], AREA / len(points["x"])  # every point starts with the same volume
    weight = spline((at[:, None] - x) / cell) + spline((at[:, None] + x) / cell)
    return weight.sum(axis=1) * area / cell


def root_mean_square(law, cell):
    at, height = measured()
    return float(np.sqrt(np.mean((surface(outcome(law, cell).points, cell, at) - height) ** 2)))


def test_surface_of_the_column_before_it_collapses_is_its_height():
    study = rfmpm.load_study(STUDY)
    x = rfmpm.simulate(study.with_changes({"time.end_s": 1e-5})).points["x"]
    at = np.array([0.0, 0.05, 0.1, 0.19])
    np.testing.assert_allclose(surface({"x": x}, 0.005, at), 0.1, rtol=1e-3)  # the points move by micrometres
    assert surface({"x": x}, 0.005, np.array([0.3])) == 0.0


@pytest.mark.parametrize("law", ["mohr_coulomb", "drucker_prager"])
def test_ten_cells_high_is_below_the_figure_of_the_best_peer(law):
    assert root_mean_square(law, 0.01) < BEST_PEER


@pytest.mark.parametrize("law", ["mohr_coulomb", "drucker_prager"])
def test_twenty_cells_high_stays_within_a_twentieth_of_the_height(law):
    # Regression: 3.0 mm.
    assert root_mean_square(law, 0.005) < 5e-3
    assert outcome(law, 0.005).status in ("ok", "not_at_rest")


@pytest.mark.slow
def test_forty_cells_high_stays_within_a_twentieth_of_the_height_and_meets_the_front():
    # Regression: 3.7 mm.
    assert root_mean_square("mohr_coulomb", 0.0025) < 5e-3
    x, height = measured()
    front = np.quantile(outcome("mohr_coulomb", 0.0025).points["x"], 0.995)
    assert x[height > 2e-3].max() - 0.02 < front < x.max() + 0.02  # the bars are 1 to 1.5 mm thick, read every 20 mm
