"""What happens on the points, one equation after the other."""

from math import hypot, sqrt

from rfmpm.kernel_tools import Tensor, Vector, at, kernel, put
from rfmpm.mpm.protocols import update_stress, weights
from rfmpm.mpm.solvers.reference.protocols import acceleration, new_gradient, new_velocity
from rfmpm.mpm.solvers.reference.state import Gradient
from rfmpm.mpm.solvers.reference.sums import (
    gather_gradient,
    gather_moment,
    gather_vector,
    scatter,
    scatter_line,
)


@kernel
def map_momentum(points, carried, axes, mass, momentum, cell):
    """m_i = sum w m_p,  (m v)_i = sum w m_p (v_p + C_p (x_i - x_p)); C_p where the points carry a gradient."""
    for p in range(points.mass.size):
        place, m, v = at(points.position, p), points.mass[p], at(points.velocity, p)
        i, wx, _ = weights(axes.x, place.x)
        j, wy, _ = weights(axes.y, place.y)
        scatter(mass, i, wx, j, wy, m)
        if carried is None:
            scatter(momentum.x, i, wx, j, wy, m * v.x)
            scatter(momentum.y, i, wx, j, wy, m * v.y)
        else:
            c = at(carried, p)
            scatter_line(momentum.x, i, wx, j, wy, m * v.x, m * c.xx, m * c.xy, place, cell)
            scatter_line(momentum.y, i, wx, j, wy, m * v.y, m * c.yx, m * c.yy, place, cell)


@kernel
def map_force(points, axes, force, body_force, time):
    """f_i = sum w m_p b_p - sum V_p sigma_p grad w; b_p where there is a body force besides gravity."""
    for p in range(points.mass.size):
        place, m, volume, stress = at(points.position, p), points.mass[p], points.volume[p], at(points.stress, p)
        i, wx, dx = weights(axes.x, place.x)
        j, wy, dy = weights(axes.y, place.y)
        scatter(force.x, i, dx, j, wy, -volume * stress.xx)
        scatter(force.x, i, wx, j, dy, -volume * stress.xy)
        scatter(force.y, i, dx, j, wy, -volume * stress.xy)
        scatter(force.y, i, wx, j, dy, -volume * stress.yy)
        if body_force is not None:
            bx, by = acceleration(body_force, place.x, place.y, time)
            scatter(force.x, i, wx, j, wy, m * bx)
            scatter(force.y, i, wx, j, wy, m * by)


@kernel
def map_interpolated(points, axes, velocity, momentum):
    """(m v)_i = sum w m_p (sum w v_j): a velocity to the points and back."""
    for p in range(points.mass.size):
        m = points.mass[p]
        i, wx, _ = weights(axes.x, points.position.x[p])
        j, wy, _ = weights(axes.y, points.position.y[p])
        v = gather_vector(velocity, i, wx, j, wy)
        scatter(momentum.x, i, wx, j, wy, m * v.x)
        scatter(momentum.y, i, wx, j, wy, m * v.y)


@kernel
def update_velocities(points, carried, transfer, axes, nodes, blend, cell):
    """Velocities, and gradients where they are carried, from the grid."""
    for p in range(points.mass.size):
        place = at(points.position, p)
        i, wx, dx = weights(axes.x, place.x)
        j, wy, dy = weights(axes.y, place.y)
        interpolated = gather_vector(nodes.velocity, i, wx, j, wy)
        change = gather_vector(nodes.change, i, wx, j, wy)
        filtered = gather_vector(nodes.filtered, i, wx, j, wy) if blend > 0.0 else interpolated
        put(points.velocity, p, new_velocity(transfer, at(points.velocity, p), interpolated, change, filtered, blend))
        if carried is not None:
            slope = gather_gradient(nodes.velocity, i, wx, dx, j, wy, dy)
            moment = gather_moment(nodes.velocity, i, wx, dx, j, wy, dy, place, cell)
            put(carried, p, new_gradient(transfer, slope, moment))


@kernel
def strain(points, law, history, axes, velocity, dt):
    """F = I + dt L;  V <- V det F;  sigma <- R sigma R^T, then the law's own increment with D dt."""
    for p in range(points.mass.size):
        i, wx, dx = weights(axes.x, points.position.x[p])
        j, wy, dy = weights(axes.y, points.position.y[p])
        slope = gather_gradient(velocity, i, wx, dx, j, wy, dy)
        f = Gradient(1.0 + dt * slope.xx, dt * slope.xy, dt * slope.yx, 1.0 + dt * slope.yy)
        points.volume[p] *= f.xx * f.yy - f.xy * f.yx
        change = Tensor(f.xx - 1.0, f.yy - 1.0, 0.0, 0.5 * (f.xy + f.yx))
        stress, past = update_stress(at(law, p), turn(at(points.stress, p), f), change, at(history, p), dt)
        put(points.stress, p, stress)
        put(history, p, past)


@kernel
def turn(stress, f):
    """R sigma R^T with R of F = R U; in the plane R turns by atan2(f.yx - f.xy, f.xx + f.yy)."""
    length = sqrt((f.xx + f.yy) ** 2 + (f.yx - f.xy) ** 2)
    c, s = (f.xx + f.yy) / length, (f.yx - f.xy) / length
    return Tensor(
        c * c * stress.xx - 2.0 * c * s * stress.xy + s * s * stress.yy,
        s * s * stress.xx + 2.0 * c * s * stress.xy + c * c * stress.yy,
        stress.zz,
        c * s * (stress.xx - stress.yy) + (c * c - s * s) * stress.xy,
    )


@kernel
def move(points, axes, velocity, dt, limit):
    """x <- x + dt sum w v. Returns the largest speed [m/s], and a point that left the grid or its senses, or -1."""
    fastest = 0.0
    length, height = axes.x.cells / axes.x.inverse_cell, axes.y.cells / axes.y.inverse_cell
    for p in range(points.mass.size):
        i, wx, _ = weights(axes.x, points.position.x[p])
        j, wy, _ = weights(axes.y, points.position.y[p])
        v = gather_vector(velocity, i, wx, j, wy)
        place = Vector(points.position.x[p] + dt * v.x, points.position.y[p] + dt * v.y)
        if not (0.0 <= place.x <= length and 0.0 <= place.y <= height):
            return fastest, p
        put(points.position, p, place)
        speed = hypot(points.velocity.x[p], points.velocity.y[p])
        if not speed <= limit:
            return fastest, p
        fastest = max(fastest, speed)
    return fastest, -1
