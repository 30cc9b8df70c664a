"""Stresses of the body at rest under gravity: one elastic static solve on the background grid."""

import numpy as np

from rfmpm.kernel_tools import Tensor
from rfmpm.kernel_tools.threads import single_blas_thread
from rfmpm.mpm.boundary import Roller, Walls
from rfmpm.mpm.state import Axes

ABSURD = 3.0  # times the weight of a column as high as the body, per area: no stress at rest
SCRAP = 0.5  # of a cell; where the outline leaves less soil in one, it is a scrap


def elastic_gravity_stress(
    position: np.ndarray,
    mass: np.ndarray,
    volume: np.ndarray,
    axes: Axes,
    walls: Walls,
    lame: float | np.ndarray,
    shear: float | np.ndarray,
    gravity: float,
    cell_means: bool,
) -> Tensor:
    """Solve K u = f with the points as quadrature and the run's own shape functions, and take the stresses.

    The stresses are then in balance on the grid to rounding: nothing moves at release but what yields or slides. They
    depend on geometry and elastic constants alone. A wall with friction holds.

    A scrap of soil in a cell of its own, at an inclined face, reaches nodes that nothing else does. With one point per
    cell such nodes hardly resist, and its stress, with that of a whole row beside it, may grow beyond measure. Where it
    does the scrap is left out, with the nodes that it alone reaches: it has no stress and its own small weight to fall.

    Args:
        position: shape (n, 2) [m].
        mass, volume: shape (n,) [kg/m], [m3/m].
        axes: shape functions.
        walls: walls of the domain.
        lame, shear: elastic constants, one value or shape (n,) [Pa].
        gravity: downwards [m/s2].
        cell_means: whether volumetric strain and pressure are means over the points of a cell.

    Returns:
        Stress at the points, arrays of shape (n,) [Pa].
    """
    kept = np.ones(len(mass), dtype=bool)
    most = ABSURD * gravity * np.max(mass / volume) * np.ptp(position[:, 1])
    stress = _solve(position, mass, volume, axes, walls, lame, shear, gravity, cell_means)
    while np.any(is_absurd := np.max(np.abs(np.array(stress)), axis=0) > most):
        is_absurd &= _is_scrap(position, volume, axes)
        if not np.any(is_absurd):
            break
        kept &= ~is_absurd
        own = [constant if np.ndim(constant) == 0 else constant[kept] for constant in (lame, shear)]
        found = _solve(position[kept], mass[kept], volume[kept], axes, walls, *own, gravity, cell_means)
        stress = Tensor(*(np.zeros(len(mass)) for _ in found))
        for whole, part in zip(stress, found, strict=True):
            whole[kept] = part
    return stress


def _is_scrap(position: np.ndarray, volume: np.ndarray, axes: Axes) -> np.ndarray:
    """Which points lie in cells that are not half full; shape (n,)."""
    cell = _cells_of(position, axes)
    return np.bincount(cell, volume)[cell] * axes.x.inverse_cell * axes.y.inverse_cell < SCRAP


def _cells_of(position: np.ndarray, axes: Axes) -> np.ndarray:
    """Number of the cell of each point among those that hold points, shape (n,)."""
    column, row = (position * axes.x.inverse_cell).astype(int).T
    return np.unique(row * (axes.x.cells + 1) + column, return_inverse=True)[1]


def _solve(position, mass, volume, axes, walls, lame, shear, gravity, cell_means) -> Tensor:
    """The stresses that `elastic_gravity_stress` describes, of all points given."""
    import scipy.linalg  # noqa: F401  (brings the BLAS that single_blas_thread limits)
    from scipy.sparse import diags
    from scipy.sparse.linalg import spsolve

    value, slope_x, slope_y = interpolation(position, axes)
    exx, eyy, gxy = _strains(slope_x, slope_y, _averages(position, volume, axes) if cell_means else None)
    stiffness = _stiffness(exx, eyy, gxy, volume, lame, shear)
    force = np.concatenate([np.zeros(value.shape[1]), -gravity * (value.T @ mass)])
    free = _free_components(axes, walls) & (stiffness.diagonal() > 0.0)
    # Scaled to a unit diagonal, for nodes that hardly touch a point; the shift keeps patterns that no point resists
    # (one point in a linear cell) out of the solution.
    scale = 1.0 / np.sqrt(stiffness.diagonal()[free])
    scaled = diags(scale) @ stiffness[free][:, free] @ diags(scale) + diags(np.full(len(scale), 1e-10))
    displacement = np.zeros(len(free))
    with single_blas_thread():
        displacement[free] = scale * spsolve(scaled.tocsc(), scale * force[free])
    exx, eyy, gxy = (strain @ displacement for strain in (exx, eyy, gxy))
    volumetric = lame * (exx + eyy)
    return Tensor(volumetric + 2.0 * shear * exx, volumetric + 2.0 * shear * eyy, volumetric, shear * gxy)


def _stiffness(exx, eyy, gxy, volume, lame, shear):
    """Sum over the points of volume times strain times elastic constants times strain."""
    from scipy.sparse import diags

    along, across = lame + 2.0 * shear, lame
    if np.ndim(lame) == 0:
        v = diags(volume)
        mixed = exx.T @ v @ eyy
        normal = along * (exx.T @ v @ exx + eyy.T @ v @ eyy) + across * (mixed + mixed.T)
        return (normal + shear * (gxy.T @ v @ gxy)).tocsr()
    along, across, skew = (diags(volume * constant) for constant in (along, across, shear))
    mixed = exx.T @ across @ eyy
    return (exx.T @ along @ exx + eyy.T @ along @ eyy + mixed + mixed.T + gxy.T @ skew @ gxy).tocsr()


def _strains(slope_x, slope_y, averages):
    """Strains xx, yy and engineering xy at the points, as matrices on the displacements (all x, then all y)."""
    from scipy.sparse import bmat, identity

    if averages is None:
        nothing = slope_x * 0.0
        return bmat([[slope_x, nothing]]), bmat([[nothing, slope_y]]), bmat([[slope_y, slope_x]])
    change_x, change_y = (0.5 * (averages - identity(len(averages.indptr) - 1)) @ slope for slope in (slope_x, slope_y))
    return (
        bmat([[slope_x + change_x, change_y]]),
        bmat([[change_x, slope_y + change_y]]),
        bmat([[slope_y, slope_x]]),
    )


def _averages(position, volume, axes):
    """Matrix (n, n) that replaces a value at each point by the volume-weighted mean over the points of its cell."""
    from scipy.sparse import csr_matrix, diags

    cell = _cells_of(position, axes)
    points = np.arange(len(volume))
    sums = csr_matrix((volume, (cell, points)))
    spread = csr_matrix((np.ones(len(volume)), (points, cell)))
    return (spread @ diags(1.0 / np.asarray(sums.sum(axis=1)).ravel()) @ sums).tocsr()


def interpolation(position: np.ndarray, axes: Axes):
    """Weights and slopes of all nodes at all points.

    Args:
        position: shape (n, 2) [m].
        axes: shape functions.

    Returns:
        Three sparse matrices of shape (n, nodes): value [-], slope along x and along y [1/m]; nodes row by row.
    """
    from scipy.sparse import csr_matrix

    columns, rows = axes.x.cells + 1, axes.y.cells + 1
    node, value, slope_x, slope_y = [], [], [], []
    for x, y in position:
        i, wx, dx = axes.x.weights(x)
        j, wy, dy = axes.y.weights(y)
        node.append([(j + b) * columns + i + a for b in range(len(wy)) for a in range(len(wx))])
        value.append(np.outer(wy, wx).ravel())
        slope_x.append(np.outer(wy, dx).ravel())
        slope_y.append(np.outer(dy, wx).ravel())
    node = np.array(node)
    first = np.arange(len(position) + 1) * node.shape[1]
    shape = (len(position), columns * rows)
    return tuple(csr_matrix((np.ravel(w), node.ravel(), first), shape=shape) for w in (value, slope_x, slope_y))


def _free_components(axes: Axes, walls: Walls) -> np.ndarray:
    """Which components (all x, then all y) the walls leave free; shape (2 nodes,)."""
    rows, columns = axes.y.cells + 1, axes.x.cells + 1
    free = np.ones((2, rows, columns), dtype=bool)
    free[1, 0] = False
    free[0, 0] = isinstance(walls.base, Roller)
    free[0][:, [0, -1]] = False
    if not isinstance(walls.sides, Roller):
        free[1][:, [0, -1]] = False
    return free.ravel()
