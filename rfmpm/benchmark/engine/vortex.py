"""The generalised vortex, a manufactured solution: Kamojjala, Brannon, Sadeghirad and Guilkey (2015), section 4.

A ring of inner radius 0.75 m and outer radius 1.25 m turns by the angle a(r, t) = g(t) h(r) about its centre, with
g = A sin(pi t / T) and h = (1 - 16 d^2)^3, d = r - 1: both edges stand still and are free of stress. Here the ring is
part of a square body whose rest never moves; by itself, it would be free to turn as a whole, and errors of the torque
would be all that is seen. For the same reason h has the power 3, not 2 as in the source: the force is then continuous.
Radii do not change, so that the first radius is the present one, nor does the volume.

Stress of the engine's own law (Hooke's in rate form; the stress turns with the body, so its rate is Jaumann's): in the
axes (r, theta), which turn at w = g' h, the spin is w + s/2 and the only rate of deformation D_rt = s/2, where
s = d(gamma)/dt with the shear gamma = r da/dr. Hence the rates of s_rr, s_tt and s_rt with respect to gamma are
-s_rt, s_rt and G + (s_rr - s_tt) / 2, which from zero give

    s_rt = G sin(gamma),    s_tt = -s_rr = G (1 - cos(gamma)).

Under that law a shear beyond pi / 2 meets less and less resistance, and no motion is the only one: A = pi, as often
taken, would shear by 20. It is 0.08 here, which shears by 0.6.

Momentum, rho a = div s + rho b with a_r = -r w^2 and a_t = r dw/dt, then asks for

    b_r = -r w^2 + G / rho (sin(gamma) gamma' + 2 (1 - cos(gamma)) / r),
    b_t = r dw/dt - G / rho (cos(gamma) gamma' + 2 sin(gamma) / r),    gamma' = g (h' + r h'').
"""

from dataclasses import replace
from math import cos, hypot, pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from rfmpm.benchmark.engine.blocks import elastic_block
from rfmpm.benchmark.engine.runs import Measurement, Run, timed
from rfmpm.benchmark.engine.schemes import Scheme
from rfmpm.kernel_tools import Tensor, Vector
from rfmpm.mpm import scene as scenes
from rfmpm.mpm.shapes import build_axis
from rfmpm.mpm.state import Axes, Points

NAME, TITLE = "vortex", "Generalised vortex"
ERRORS = {"position": "error of the positions over the mean radius [1]"}
INNER, OUTER, CENTRE, SIDE = 0.75, 1.25, 1.3, 2.6  # [m]
MODULUS, POISSON, DENSITY = 1e6, 0.3, 1000.0  # [Pa], [1], [kg/m3]
SHEAR = 0.5 * MODULUS / (1.0 + POISSON)
AMPLITUDE, DURATION, END = 0.08, 1.0, 0.5  # [rad], T [s], when it has turned furthest [s]


class Vortex(NamedTuple):
    """The force that keeps the ring on its way."""

    amplitude: float  # [rad]
    duration: float  # T [s]
    specific_shear: float  # G / rho [m2/s2]
    centre: float  # both coordinates [m]

    def acceleration(self, x, y, time):
        """Components (x, y) of b [m/s2]."""
        to_x, to_y = x - self.centre, y - self.centre
        r = hypot(to_x, to_y)
        if r <= 0.75 or r >= 1.25:
            return 0.0, 0.0
        d, rate = r - 1.0, pi / self.duration
        u = 1.0 - 16.0 * d * d
        h, slope, bend = u**3, -96.0 * d * u * u, -96.0 * u * u + 6144.0 * d * d * u
        g = self.amplitude * sin(rate * time)
        spin, spin_up = self.amplitude * rate * cos(rate * time) * h, -rate * rate * g * h
        gamma, gradient = r * g * slope, g * (slope + r * bend)
        radial = -r * spin * spin + self.specific_shear * (sin(gamma) * gradient + 2.0 * (1.0 - cos(gamma)) / r)
        around = r * spin_up - self.specific_shear * (cos(gamma) * gradient + 2.0 * sin(gamma) / r)
        return (radial * to_x - around * to_y) / r, (radial * to_y + around * to_x) / r


def profile(radius: np.ndarray) -> np.ndarray:
    """The function h of radii [m]; same shape [1]."""
    d = radius - 1.0
    return np.where((radius > INNER) & (radius < OUTER), (1.0 - 16.0 * d**2) ** 3, 0.0)


def measure(scheme: Scheme, cells: int, repeats: int, amplitude: float = AMPLITUDE, end: float = END) -> Measurement:
    """Run the vortex on so many cells across the body and compare the ring's points' places, root mean square."""
    cell = SIDE / cells
    scene, place = _scene(scheme, cells, cell, amplitude)
    force = Vortex(amplitude, DURATION, SHEAR / DENSITY, CENTRE)
    cpu_time, run, _ = timed(lambda: Run(scene, scheme, force), lambda run: run.until(end), repeats)
    radius = np.hypot(*place.T)
    turned = amplitude * np.sin(pi * run.time / DURATION) * profile(radius)
    angle = np.arctan2(place[:, 1], place[:, 0]) + turned
    off_x = run.points.position.x - CENTRE - radius * np.cos(angle)
    off_y = run.points.position.y - CENTRE - radius * np.sin(angle)
    in_ring = (radius > INNER) & (radius < OUTER)
    error = np.nan if run.is_broken else float(np.sqrt(np.mean((off_x**2 + off_y**2)[in_ring])))
    return Measurement(NAME, scheme, cell, cpu_time, {"position": error})


def _scene(scheme: Scheme, cells: int, cell: float, amplitude: float):
    """The body in its first motion, and its points' places relative to the centre, shape (n, 2) [m]."""
    side = round(sqrt(scheme.points_per_cell))
    spacing = cell / side
    line = (np.arange(cells * side) + 0.5) * spacing - CENTRE
    place = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    spin = amplitude * pi / DURATION * profile(np.hypot(*place.T))
    zero = np.zeros(len(place))
    points = Points(
        Vector(CENTRE + place[:, 0], CENTRE + place[:, 1]),
        Vector(-spin * place[:, 1], spin * place[:, 0]),
        zero + DENSITY * spacing**2,
        zero + spacing**2,
        Tensor(zero, zero, zero, zero),
    )
    # A small block has all but the points; above the body the grid has room for splines.
    built = scenes.build(
        elastic_block(3.0 * cell, cell, cell, scheme.shape, scheme.points_per_cell, DENSITY, MODULUS, POISSON)
    )
    axes = Axes(*(build_axis(scheme.shape, cell, count, scheme.points_per_cell) for count in (cells, cells + 4)))
    return replace(built, points=points, axes=axes, controls=built.controls._replace(gravity=0.0)), place
