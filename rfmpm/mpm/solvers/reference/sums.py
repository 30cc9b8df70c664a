"""Sums over the nodes of a point and over the points of a node, as they stand in the equations.

`w` are weights along one axis: of the nodes i, i + 1, ... along x and j, j + 1, ... along y.
"""

from rfmpm.kernel_tools import Vector, inlined
from rfmpm.mpm.solvers.reference.state import Gradient


@inlined
def gather(field, i, wx, j, wy):
    """Sum over nodes of w f."""
    total = 0.0
    for b in range(len(wy)):
        for a in range(len(wx)):
            total += wx[a] * wy[b] * field[j + b, i + a]
    return total


@inlined
def scatter(field, i, wx, j, wy, amount):
    """Add w times `amount` to the nodes."""
    for b in range(len(wy)):
        for a in range(len(wx)):
            field[j + b, i + a] += wx[a] * wy[b] * amount


@inlined
def scatter_line(field, i, wx, j, wy, amount, along_x, along_y, place, cell):
    """Add w times what grows linearly from `amount` at the point's place to the nodes."""
    for b in range(len(wy)):
        for a in range(len(wx)):
            dx, dy = (i + a) * cell - place.x, (j + b) * cell - place.y
            field[j + b, i + a] += wx[a] * wy[b] * (amount + along_x * dx + along_y * dy)


@inlined
def gather_vector(field, i, wx, j, wy):
    """Sum over nodes of w v."""
    return Vector(gather(field.x, i, wx, j, wy), gather(field.y, i, wx, j, wy))


@inlined
def gather_gradient(field, i, wx, dx, j, wy, dy):
    """Sum over nodes of v grad w."""
    return Gradient(
        gather(field.x, i, dx, j, wy), gather(field.x, i, wx, j, dy),
        gather(field.y, i, dx, j, wy), gather(field.y, i, wx, j, dy),
    )  # fmt: skip


@inlined
def gather_moment(field, i, wx, dx, j, wy, dy, place, cell):
    """Sum over nodes of w v (x_i - x_p), over the sum of w (x_i - x_p)^2.

    On a node where all the weight is, the latter is zero and the limit is the slope towards the next one.
    """
    slope = gather_gradient(field, i, wx, dx, j, wy, dy)
    xx = xy = yx = yy = spread_x = spread_y = 0.0
    for a in range(len(wx)):
        spread_x += wx[a] * ((i + a) * cell - place.x) ** 2
    for b in range(len(wy)):
        spread_y += wy[b] * ((j + b) * cell - place.y) ** 2
    for b in range(len(wy)):
        for a in range(len(wx)):
            w, vx, vy = wx[a] * wy[b], field.x[j + b, i + a], field.y[j + b, i + a]
            to_x, to_y = (i + a) * cell - place.x, (j + b) * cell - place.y
            xx, xy = xx + w * vx * to_x, xy + w * vx * to_y
            yx, yy = yx + w * vy * to_x, yy + w * vy * to_y
    smallest = 1e-9 * cell * cell
    if spread_x > smallest:
        slope = Gradient(xx / spread_x, slope.xy, yx / spread_x, slope.yy)
    if spread_y > smallest:
        slope = Gradient(slope.xx, xy / spread_y, slope.yx, yy / spread_y)
    return slope
