"""The same slope in Taichi, which must be installed: quadratic B-splines, FLIP, stress last, von Mises, one thread."""

from typing import Any

import numpy as np
import taichi as ti

ROOT = 3.0**-0.5


@ti.func
def weights(f):
    """Weights of the three nodes along x and y, for a point f cells beyond the first of them."""
    return [0.5 * (1.5 - f) ** 2, 0.75 - (f - 1.0) ** 2, 0.5 * (f - 0.5) ** 2]


@ti.func
def slopes(f, inverse):
    """Slopes of these weights [1/m]; `inverse` is one over the cell [1/m]."""
    return [(f - 1.5) * inverse, -2.0 * (f - 1.0) * inverse, (f - 0.5) * inverse]


@ti.data_oriented
class Peer:
    """The points of a scene and its grid, in Taichi.

    Args:
        scene: the short slope's scene.
        law: its von Mises law, from `mpm.scene.release`.
        dt: time step [s].
    """

    def __init__(self, scene: Any, law: Any, dt: float):
        ti.init(arch=ti.cpu, default_fp=ti.f64, cpu_max_num_threads=1, log_level=ti.ERROR, offline_cache=False)
        self.dt, self.inverse, self.gravity = dt, scene.axes.x.inverse_cell, scene.controls.gravity
        self.lame, self.shear, self.softening = law.lame, law.shear, law.softening
        count, nodes = len(scene.points.mass), (scene.axes.x.cells + 3, scene.axes.y.cells + 3)
        self.position, self.velocity = (ti.Vector.field(2, ti.f64, count) for _ in range(2))
        self.mass, self.volume, self.strained = (ti.field(ti.f64, count) for _ in range(3))
        self.peak, self.residual = (ti.field(ti.f64, count) for _ in range(2))
        self.stress = ti.Vector.field(4, ti.f64, count)  # xx, yy, zz, xy
        self.node_mass = ti.field(ti.f64, nodes)
        self.flow, self.change = (ti.Vector.field(2, ti.f64, nodes) for _ in range(2))  # momentum, force; then velocity
        self._fill(scene.points, law)

    def _fill(self, points, law) -> None:
        for name in ("position", "velocity", "stress"):
            getattr(self, name).from_numpy(np.column_stack(getattr(points, name)))
        for name in ("mass", "volume"):
            getattr(self, name).from_numpy(getattr(points, name))
        self.peak.from_numpy(law.peak)
        self.residual.from_numpy(law.residual)

    def advance(self, steps: int) -> None:
        """Take so many steps."""
        for _ in range(steps):
            self.step()
        ti.sync()

    @ti.kernel
    def step(self):
        """One step: empty the grid, points to grid, move the grid, grid to points."""
        for node in ti.grouped(self.node_mass):
            self.node_mass[node] = 0.0
            self.flow[node] = [0.0, 0.0]
            self.change[node] = [0.0, 0.0]
        for p in self.position:
            self.scatter(p)
        for node in ti.grouped(self.node_mass):
            self.move(node)
        for p in self.position:
            gradient = self.gather(p)
            self.update_stress(p, self.dt * gradient)

    @ti.func
    def scatter(self, p):
        """Add a point's mass, momentum and internal force to its nodes."""
        s = self.position[p] * self.inverse + 1.0
        base = int(s - 0.5)
        w, d = weights(s - base), slopes(s - base, self.inverse)
        stress = self.stress[p]
        for a, b in ti.static(ti.ndrange(3, 3)):
            weight = w[a][0] * w[b][1]
            gx, gy = d[a][0] * w[b][1], w[a][0] * d[b][1]
            node = base + ti.Vector([a, b])
            self.node_mass[node] += weight * self.mass[p]
            self.flow[node] += weight * self.mass[p] * self.velocity[p]
            self.change[node] -= self.volume[p] * ti.Vector(
                [stress[0] * gx + stress[3] * gy, stress[3] * gx + stress[1] * gy]
            )

    @ti.func
    def move(self, node):
        """Turn a node's momentum and force into its new velocity and the change of it; base fixed, back a roller."""
        m = self.node_mass[node]
        if m > 0.0:
            old = self.flow[node] / m
            new = old + self.dt * (self.change[node] / m - ti.Vector([0.0, self.gravity]))
            if node[1] <= 1:
                new = [0.0, 0.0]
            if node[0] <= 1:
                new[0] = 0.0
            self.flow[node] = new
            self.change[node] = new - old

    @ti.func
    def gather(self, p):
        """Move a point with its nodes. Returns its velocity gradient [1/s]."""
        s = self.position[p] * self.inverse + 1.0
        base = int(s - 0.5)
        w, d = weights(s - base), slopes(s - base, self.inverse)
        moved, gained = ti.Vector([0.0, 0.0]), ti.Vector([0.0, 0.0])
        gradient = ti.Matrix([[0.0, 0.0], [0.0, 0.0]])
        for a, b in ti.static(ti.ndrange(3, 3)):
            node = base + ti.Vector([a, b])
            moved += w[a][0] * w[b][1] * self.flow[node]
            gained += w[a][0] * w[b][1] * self.change[node]
            gradient += self.flow[node].outer_product(ti.Vector([d[a][0] * w[b][1], w[a][0] * d[b][1]]))
        self.velocity[p] += gained
        self.position[p] += self.dt * moved
        return gradient

    @ti.func
    def update_stress(self, p, change):
        """Elastic predictor and radial return, for a change of displacement gradient in this step [-]."""
        xx, yy = change[0, 0], change[1, 1]
        xy, spin = 0.5 * (change[0, 1] + change[1, 0]), 0.5 * (change[1, 0] - change[0, 1])
        self.volume[p] *= 1.0 + xx + yy
        old = self.stress[p]
        bulk = self.lame * (xx + yy)
        sxx = old[0] - 2.0 * spin * old[3] + bulk + 2.0 * self.shear * xx
        syy = old[1] + 2.0 * spin * old[3] + bulk + 2.0 * self.shear * yy
        szz = old[2] + bulk
        sxy = old[3] + spin * (old[0] - old[1]) + 2.0 * self.shear * xy
        mean = (sxx + syy + szz) / 3.0
        j2 = 0.5 * ((sxx - mean) ** 2 + (syy - mean) ** 2 + (szz - mean) ** 2) + sxy**2
        scale = self.soften(p, j2)
        self.stress[p] = [
            mean + scale * (sxx - mean),
            mean + scale * (syy - mean),
            mean + scale * (szz - mean),
            scale * sxy,
        ]

    @ti.func
    def soften(self, p, j2):
        """Let a point yield where its trial J2 [Pa2] asks for it. Returns what the deviator is multiplied by."""
        cohesion = ti.max(self.residual[p], self.peak[p] - self.softening * self.strained[p])
        scale = 1.0
        if j2 > cohesion * cohesion:
            tau = ti.sqrt(j2)
            g = (tau - cohesion) / (self.shear - self.softening * ROOT)
            cohesion -= self.softening * ROOT * g
            if cohesion < self.residual[p]:
                cohesion = self.residual[p]
                g = (tau - cohesion) / self.shear
            scale = cohesion / tau
            self.strained[p] += g * ROOT
        return scale
