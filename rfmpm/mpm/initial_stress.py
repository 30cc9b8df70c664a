"""Stresses of the body at rest under gravity: one elastic static solve on the background grid."""

import numpy as np

from rfmpm.kernel_tools import Tensor
from rfmpm.kernel_tools.threads import single_blas_thread
from rfmpm.mpm.boundary import Roller, Walls
from rfmpm.mpm.state import Axes


def elastic_gravity_stress(
    position: np.ndarray,
    mass: np.ndarray,
    volume: np.ndarray,
    axes: Axes,
    walls: Walls,
    lame: float,
    shear: float,
    gravity: float,
) -> Tensor:
    """Solve K u = f with the points as quadrature and the run's own shape functions, and take the stresses.

    The stresses are then in balance on the grid to rounding: nothing moves at release but what yields or slides. They
    depend on geometry and elastic constants alone. A wall with friction holds.

    Args:
        position: shape (n, 2) [m].
        mass, volume: shape (n,) [kg/m], [m3/m].
        axes: shape functions.
        walls: walls of the domain.
        lame, shear: elastic constants [Pa].
        gravity: downwards [m/s2].

    Returns:
        Stress at the points, arrays of shape (n,) [Pa].
    """
    import scipy.linalg  # noqa: F401  (brings the BLAS that single_blas_thread limits)
    from scipy.sparse import bmat, diags
    from scipy.sparse.linalg import spsolve

    value, slope_x, slope_y = interpolation(position, axes)
    v = diags(volume)
    along, across = lame + 2.0 * shear, lame
    xx = slope_x.T @ v @ slope_x
    yy = slope_y.T @ v @ slope_y
    xy = slope_x.T @ v @ slope_y
    stiffness = bmat(
        [[along * xx + shear * yy, across * xy + shear * xy.T], [across * xy.T + shear * xy, along * yy + shear * xx]]
    ).tocsr()
    force = np.concatenate([np.zeros(value.shape[1]), -gravity * (value.T @ mass)])
    free = _free_components(axes, walls) & (stiffness.diagonal() > 0.0)
    # Scaled to a unit diagonal, for nodes that hardly touch a point; the shift keeps patterns that no point resists
    # (one point in a linear cell) out of the solution.
    scale = 1.0 / np.sqrt(stiffness.diagonal()[free])
    scaled = diags(scale) @ stiffness[free][:, free] @ diags(scale) + diags(np.full(len(scale), 1e-10))
    displacement = np.zeros(len(free))
    with single_blas_thread():
        displacement[free] = scale * spsolve(scaled.tocsc(), scale * force[free])
    ux, uy = np.split(displacement, 2)
    exx, eyy, gxy = slope_x @ ux, slope_y @ uy, slope_y @ ux + slope_x @ uy
    volumetric = lame * (exx + eyy)
    return Tensor(volumetric + 2.0 * shear * exx, volumetric + 2.0 * shear * eyy, volumetric, shear * gxy)


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
