"""The same slope in Taichi, where it is installed: quadratic B-splines, FLIP, stress last, von Mises, one thread."""

from typing import Any


def build(scene: Any, law: Any, dt: float) -> Any:
    """Compile the peer and give it the scene's points.

    Args:
        scene: the short slope's scene.
        law: its von Mises law, from `mpm.scene.release`.
        dt: time step [s].

    Returns:
        A function that takes so many steps; None where Taichi is not installed.
    """
    try:
        import taichi as ti
    except ImportError:
        return None
    ti.init(arch=ti.cpu, default_fp=ti.f64, cpu_max_num_threads=1, log_level=ti.ERROR, offline_cache=False)
    count = len(scene.points.mass)
    columns, rows = scene.axes.x.cells + 3, scene.axes.y.cells + 3
    inverse, gravity = scene.axes.x.inverse_cell, scene.controls.gravity
    lame, shear, softening = law.lame, law.shear, law.softening
    position, velocity = (ti.Vector.field(2, ti.f64, count) for _ in range(2))
    mass, volume, strained, peak, residual = (ti.field(ti.f64, count) for _ in range(5))
    stress = ti.Vector.field(4, ti.f64, count)
    node_mass = ti.field(ti.f64, (columns, rows))
    flow, change = (ti.Vector.field(2, ti.f64, (columns, rows)) for _ in range(2))

    @ti.func
    def weights(f):
        return [0.5 * (1.5 - f) ** 2, 0.75 - (f - 1.0) ** 2, 0.5 * (f - 0.5) ** 2]

    @ti.func
    def slopes(f):
        return [(f - 1.5) * inverse, -2.0 * (f - 1.0) * inverse, (f - 0.5) * inverse]

    @ti.kernel
    def step():
        for node in ti.grouped(node_mass):
            node_mass[node] = 0.0
            flow[node] = [0.0, 0.0]
            change[node] = [0.0, 0.0]
        for p in position:
            s = position[p] * inverse + 1.0
            base = int(s - 0.5)
            f = s - base
            w, d = weights(f), slopes(f)
            for a, b in ti.static(ti.ndrange(3, 3)):
                weight = w[a][0] * w[b][1]
                gx, gy = d[a][0] * w[b][1], w[a][0] * d[b][1]
                node = base + ti.Vector([a, b])
                node_mass[node] += weight * mass[p]
                flow[node] += weight * mass[p] * velocity[p]
                change[node] -= volume[p] * ti.Vector(
                    [stress[p][0] * gx + stress[p][3] * gy, stress[p][3] * gx + stress[p][1] * gy]
                )
        for node in ti.grouped(node_mass):
            m = node_mass[node]
            if m > 0.0:
                old = flow[node] / m
                new = old + dt * (change[node] / m - ti.Vector([0.0, gravity]))
                if node[1] <= 1:
                    new = [0.0, 0.0]
                if node[0] <= 1:
                    new[0] = 0.0
                flow[node] = new
                change[node] = new - old
        for p in position:
            s = position[p] * inverse + 1.0
            base = int(s - 0.5)
            f = s - base
            w, d = weights(f), slopes(f)
            moved, gained = ti.Vector([0.0, 0.0]), ti.Vector([0.0, 0.0])
            gradient = ti.Matrix([[0.0, 0.0], [0.0, 0.0]])
            for a, b in ti.static(ti.ndrange(3, 3)):
                node = base + ti.Vector([a, b])
                moved += w[a][0] * w[b][1] * flow[node]
                gained += w[a][0] * w[b][1] * change[node]
                gradient += flow[node].outer_product(ti.Vector([d[a][0] * w[b][1], w[a][0] * d[b][1]]))
            velocity[p] += gained
            position[p] += dt * moved
            xx, yy = dt * gradient[0, 0], dt * gradient[1, 1]
            xy, spin = 0.5 * dt * (gradient[0, 1] + gradient[1, 0]), 0.5 * dt * (gradient[1, 0] - gradient[0, 1])
            volume[p] *= 1.0 + xx + yy
            old = stress[p]
            bulk = lame * (xx + yy)
            sxx = old[0] - 2.0 * spin * old[3] + bulk + 2.0 * shear * xx
            syy = old[1] + 2.0 * spin * old[3] + bulk + 2.0 * shear * yy
            szz = old[2] + bulk
            sxy = old[3] + spin * (old[0] - old[1]) + 2.0 * shear * xy
            mean = (sxx + syy + szz) / 3.0
            j2 = 0.5 * ((sxx - mean) ** 2 + (syy - mean) ** 2 + (szz - mean) ** 2) + sxy**2
            cohesion = ti.max(residual[p], peak[p] - softening * strained[p])
            scale = 1.0
            if j2 > cohesion * cohesion:
                tau = ti.sqrt(j2)
                g = (tau - cohesion) / (shear - softening * ti.sqrt(1.0 / 3.0))
                cohesion -= softening * ti.sqrt(1.0 / 3.0) * g
                if cohesion < residual[p]:
                    cohesion = residual[p]
                    g = (tau - cohesion) / shear
                scale = cohesion / tau
                strained[p] += g * ti.sqrt(1.0 / 3.0)
            stress[p] = [
                mean + scale * (sxx - mean),
                mean + scale * (syy - mean),
                mean + scale * (szz - mean),
                scale * sxy,
            ]

    def advance(steps: int) -> None:
        for _ in range(steps):
            step()
        ti.sync()

    _fill(scene, law, position, velocity, mass, volume, stress, peak, residual)
    return advance


def _fill(scene, law, position, velocity, mass, volume, stress, peak, residual) -> None:
    import numpy as np

    points = scene.points
    position.from_numpy(np.column_stack(points.position))
    velocity.from_numpy(np.column_stack(points.velocity))
    mass.from_numpy(points.mass)
    volume.from_numpy(points.volume)
    stress.from_numpy(np.column_stack(points.stress))
    peak.from_numpy(law.peak)
    residual.from_numpy(law.residual)
