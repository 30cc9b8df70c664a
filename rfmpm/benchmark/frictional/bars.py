"""The pile of aluminium bars of Bui et al. (2008): readings of a surface from points, and the measured one.

There is no surface of points; three readings of one are compared with the measured one, so that none flatters unseen.
Near x = 0 the column and its mirror image across the wall are read together.
"""

from collections.abc import Callable, Mapping

import numpy as np

from rfmpm.benchmark.papers.case import REPOSITORY

NAME = "bui_2008_aluminium_bars"
CURVE = REPOSITORY / "tests" / "papers" / "bui_2008" / "surface.csv"
AREA = 0.02  # of the column [m2]; every point starts with the same share
THINNEST = 1.5e-3  # [m]: the thicker bars, and the height of the last place at which the pile was measured
SHARE = 0.995  # of the area, that lies behind the front as a campaign defines it
STEP = 5e-4  # [m] of the search for the front


def measured() -> tuple[np.ndarray, np.ndarray]:
    """The measured surface: x and height, shape (n,) each [m]."""
    x, height = np.loadtxt(CURVE, delimiter=",").T / 1e3
    return x, height


def by_mass(points: Mapping[str, np.ndarray], cell: float, at: np.ndarray) -> np.ndarray:
    """Height that the soil would have at its first density, spread by the quadratic B-spline of one cell.

    Args:
        points: final state of the points by name, shape (n,) each.
        cell: side of a cell [m].
        at: places, shape (m,) [m].

    Returns:
        Heights, shape (m,) [m].
    """
    x = points["x"]
    return _spread(x, np.full(len(x), AREA / len(x)), cell, at)


def by_volume(points: Mapping[str, np.ndarray], cell: float, at: np.ndarray) -> np.ndarray:
    """The same with the points' present volumes, gaps included; arguments as of `by_mass`."""
    return _spread(points["x"], points["volume"], cell, at)


def by_top(points: Mapping[str, np.ndarray], cell: float, at: np.ndarray) -> np.ndarray:
    """Top of the highest point's square within half a cell; arguments as of `by_mass`."""
    top = points["y"] + 0.5 * np.sqrt(points["volume"])
    near = np.abs(points["x"] - at[:, None]) <= 0.5 * cell
    return np.where(near, top, 0.0).max(axis=1)


READINGS: dict[str, Callable] = {"first density": by_mass, "present volume": by_volume, "highest point": by_top}


def error(reading: Callable, points: Mapping[str, np.ndarray], cell: float) -> float:
    """Root mean square of a reading less the measured surface, over the measured places [m]."""
    at, height = measured()
    return float(np.sqrt(np.mean((reading(points, cell, at) - height) ** 2)))


def front(points: Mapping[str, np.ndarray], cell: float) -> float:
    """Furthest place at which the soil at its first density is as thick as a bar [m]."""
    at = np.arange(0.0, points["x"].max() + 2.0 * cell, STEP)
    return float(at[by_mass(points, cell, at) >= THINNEST].max())


def front_of_share(x: np.ndarray, area: np.ndarray) -> float:
    """Place behind which the share of the area lies [m], by places and areas of shape (n,)."""
    order = np.argsort(x)
    sums = np.cumsum(area[order])
    return float(x[order][np.searchsorted(sums, SHARE * sums[-1])])


def measured_front_of_share() -> float:
    """The same of the measured surface, a straight line between the places [m]."""
    x, height = measured()
    fine = np.arange(x[0], x[-1], STEP)
    return front_of_share(fine, np.interp(fine, x, height))


def _spread(x: np.ndarray, area: np.ndarray, cell: float, at: np.ndarray) -> np.ndarray:
    weight = _spline((at[:, None] - x) / cell) + _spline((at[:, None] + x) / cell)
    return weight @ area / cell


def _spline(distance: np.ndarray) -> np.ndarray:
    """Quadratic B-spline of unit width and integral."""
    r = np.abs(distance)
    return np.where(r < 0.5, 0.75 - r * r, np.where(r < 1.5, 0.5 * (1.5 - r) ** 2, 0.0))
