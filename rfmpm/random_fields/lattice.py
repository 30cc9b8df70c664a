"""The uniform tensor lattice on which given points lie: the material points of a slope are a part of one."""

from dataclasses import dataclass

import numpy as np

ROUNDING = 1e-8  # of a spacing: how far a point may be from its place; above what adding up cells leaves, 1e-9
MOST_NODES_PER_POINT, FEWEST_NODES = 16, 4096  # a sparser lattice costs more than it saves
SMALLEST_REMAINDER = 1e-5  # of the widest gap: two coordinates closer than that are one


@dataclass(frozen=True)
class Lattice:
    """Nodes (x0 + column dx, y0 + row dy); node number row * columns + column.

    Attributes:
        x0, y0: position of the first node [m].
        dx, dy: spacings [m]; that of an axis with one node is the other one, or 1 m for a single node.
        columns, rows: number of nodes along x and along y.
        index: node number of every point, shape (n,).
    """

    x0: float
    y0: float
    dx: float
    dy: float
    columns: int
    rows: int
    index: np.ndarray

    @property
    def lags_x(self) -> np.ndarray:
        """Lags from the first column to each, shape (columns,) [m]."""
        return self.dx * np.arange(self.columns)

    @property
    def lags_y(self) -> np.ndarray:
        """Lags from the first row to each, shape (rows,) [m]."""
        return self.dy * np.arange(self.rows)


def find_lattice(points: np.ndarray) -> Lattice | None:
    """The coarsest uniform lattice that holds all points, or None where they are scattered.

    Args:
        points: positions, shape (n, 2) [m]; each may be a hundred-millionth of a spacing beside its node.

    Returns:
        the lattice; None too where it would have more than 16 nodes per point (and more than 4096 nodes).
    """
    x, y = np.asarray(points, dtype=float).T
    most = max(MOST_NODES_PER_POINT * len(x), FEWEST_NODES)
    along_x, along_y = _axis(x, most), _axis(y, most)
    if along_x is None or along_y is None:
        return None
    (x0, dx, column), (y0, dy, row) = along_x, along_y
    columns, rows = int(column.max()) + 1, int(row.max()) + 1
    if columns * rows > most:
        return None
    dx, dy = dx or dy or 1.0, dy or dx or 1.0
    return Lattice(x0, y0, dx, dy, columns, rows, row * columns + column)


def require_lattice(points: np.ndarray, method: str) -> Lattice:
    """The lattice that holds all points; ValueError, which names the method, where there is none."""
    lattice = find_lattice(points)
    if lattice is None:
        raise ValueError(
            f"{method}: these {len(points)} points are not on a uniform lattice; take method auto, cholesky or "
            "local_kriging"
        )
    return lattice


def _axis(values: np.ndarray, most: int) -> tuple[float, float, np.ndarray] | None:
    # First coordinate, spacing (0 for a single one) and number of every coordinate; None where they are scattered.
    ordered = np.sort(values)
    first, extent = float(ordered[0]), float(ordered[-1] - ordered[0])
    exact = 4.0 * np.finfo(float).eps * float(np.max(np.abs(ordered[[0, -1]])))
    if extent <= 4.0 * exact:
        return first, 0.0, np.zeros(len(values), dtype=np.int64)
    gaps = np.diff(ordered)
    small = SMALLEST_REMAINDER * gaps.max()
    gaps = gaps[gaps > small]
    spacing = _common_measure(np.unique(np.round(gaps / small)) * small, gaps.min(), extent / most)
    if spacing is None:
        return None
    spacing = extent / round(extent / spacing)
    number = np.rint((values - first) / spacing)
    if np.max(np.abs(values - first - number * spacing)) > ROUNDING * spacing + exact:
        return None
    return first, spacing, number.astype(np.int64)


def _common_measure(gaps: np.ndarray, smallest: float, least: float) -> float | None:
    # Euclid's algorithm on the gaps; a remainder below a thousandth of the smallest gap is rounding. None below least.
    measure = float(smallest)
    for gap in gaps:
        a, b = gap, measure
        while b > 1e-3 * smallest:
            a, b = b, abs(a - b * round(a / b))
        measure = a
        if measure < least:
            return None
    return measure
