"""A scene: everything that realisations of one study share, and what one of them starts from."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, pi, sqrt
from typing import NamedTuple

import numpy as np

from rfmpm.kernel_tools import Tensor, Vector, zeros
from rfmpm.mpm.boundary import WALLS, Walls
from rfmpm.mpm.cells import Cells, make_cells
from rfmpm.mpm.energy import elastic_energy
from rfmpm.mpm.geometry import Body, body, fill
from rfmpm.mpm.initial_stress import INITIAL_STRESSES, Unreleased
from rfmpm.mpm.laws import LAWS
from rfmpm.mpm.laws.elastic import lame_constants
from rfmpm.mpm.laws.history import NonlocalHistory
from rfmpm.mpm.nonlocal_softening import Averaging, averaging
from rfmpm.mpm.shapes import build_axis
from rfmpm.mpm.solvers import Alone, Controls, make_team
from rfmpm.mpm.state import Axes, Grid, Points, copy_points

GRAVITY = 9.81  # [m/s2]

FILTER_INTERVAL = 8  # steps; the filter acts at a rate, so this only spreads its cost
AVERAGE_SHARE = 0.5  # of the time in which a shear wave crosses the softening length, from one average to the next
REST_FRACTION, REST_TIME = 1e-3, 1.0
GROWTH_LIMIT = 0.05


@dataclass(frozen=True)
class Scene:
    """A body of points at rest in its grid; realisations copy the points."""

    body: Body
    cell: float  # [m]
    points: Points
    axes: Axes
    walls: Walls
    controls: Controls
    material: object  # the study's material
    lame: float  # [Pa]
    shear: float  # [Pa]
    cell_means: bool  # volumetric strain and pressure are means over the points of a cell


def build(study) -> Scene:
    """Build the scene of a study.

    Args:
        study: the study.

    Returns:
        The scene, its points under the stresses that `time.initial_stress` names. Where these lie beyond yield, the law
        takes them back to it when the run fills its grid, before the first step: what they exceed it by then sets the
        body in motion.
    """
    cell = study.discretisation.cell_m
    shape = body(study)
    position, volume = fill(shape.outline, cell, study.discretisation.points_per_cell)
    kind, per_cell = study.discretisation.shape, study.discretisation.points_per_cell
    axes = Axes(*(build_axis(kind, cell, round(extent / cell), per_cell) for extent in (shape.length, shape.top)))
    return _scene(study, shape, axes, position, volume)


def with_parameters(scene: Scene, study) -> Scene:
    """Make the scene of a study that differs from the scene's own in numbers of material and boundaries alone.

    Elastic stresses at rest are proportional to the unit weight and do not depend on Young's modulus, so that only
    another Poisson's ratio takes another solve.

    Args:
        scene: of the other study.
        study: the study.

    Returns:
        The scene.
    """
    before, after = scene.material, study.material[0]
    stress = None
    if study.time.initial_stress == "elastic" and before.poissons_ratio == after.poissons_ratio:
        factor = after.unit_weight_kn_m3 / before.unit_weight_kn_m3
        stress = Tensor(*(factor * component for component in scene.points.stress))
    position = np.column_stack(scene.points.position)
    return _scene(study, scene.body, scene.axes, position, scene.points.volume.copy(), stress)


def _scene(study, shape: Body, axes: Axes, position: np.ndarray, volume: np.ndarray, stress: Tensor | None = None):
    cell, material = study.discretisation.cell_m, study.material[0]
    density = material.unit_weight_kn_m3 * 1e3 / GRAVITY
    lame, shear = lame_constants(material.youngs_modulus_kpa * 1e3, material.poissons_ratio)
    walls = Walls(_wall(study.boundary.base), _wall(study.boundary.sides))
    mass = density * volume
    length = getattr(material, "softening_length_m", None)
    averaged = study.discretisation.volumetric_strain == "cell_mean"
    if stress is None:
        still = Unreleased(shape.outline, position, mass, volume, axes, walls, lame, shear, GRAVITY, averaged)
        stress = INITIAL_STRESSES[study.time.initial_stress](still, study)
    still = Vector(np.zeros(len(volume)), np.zeros(len(volume)))
    points = Points(Vector(*position.T.copy()), still, mass, volume, stress)
    controls = Controls(
        gravity=GRAVITY,
        cell=cell,
        wave_speed=sqrt((lame + 2.0 * shear) / density),
        courant=study.time.step_fraction,
        dissipation_time=study.discretisation.dissipation_time_s,
        filter_interval=FILTER_INTERVAL,
        average_interval=AVERAGE_SHARE * length / sqrt(shear / density) if length else inf,
        rest_fraction=REST_FRACTION,
        rest_time=REST_TIME,
        own_share=axes.x.OWN_SHARE,
        settling_rate=0.0 if material.law == "elastic" else _critical_rate(shape, sqrt(shear / density)),
        energy_scale=elastic_energy(points, lame, shear),
        growth_limit=GROWTH_LIMIT,
    )
    return Scene(shape, cell, points, axes, walls, controls, material, lame, shear, averaged)


class Released(NamedTuple):
    """What one realisation changes or owns."""

    points: Points
    law: tuple
    history: tuple | None
    grid: Grid
    cells: Cells | None
    averaging: Averaging | None


def release(scene: Scene, strengths: Mapping[str, np.ndarray] | None) -> Released:
    """Make what one realisation changes or owns.

    Args:
        scene: the scene.
        strengths: what varies from point to point, by name, arrays of shape (n,) in SI units, as the laws' `build`
            takes them; None for the material's own.

    Returns:
        What it owns.
    """
    count = len(scene.points.mass)
    law, history = LAWS[scene.material.law].build(scene.material, scene.cell, count, strengths or {})
    cells = make_cells(count, scene.axes) if scene.cell_means else None
    means = None
    if isinstance(history, NonlocalHistory):
        means = averaging(scene.material.softening_length_m, scene.axes)
    return Released(copy_points(scene.points), law, history, empty_grid(scene.axes), cells, means)


def arguments(scene: Scene, own: Released, threads: int = 1) -> tuple:
    """What a solver's `advance` takes after progress and time.

    Args:
        scene: the scene.
        own: what `release` made; the solver changes it.
        threads: that share every step.

    Returns:
        The arguments, in order.
    """
    passes = Alone() if threads == 1 else make_team(threads, own.grid, own.cells)
    return (
        own.points, own.law, own.history, scene.axes, own.grid, own.cells, own.averaging, scene.walls, scene.controls,
        passes,
    )  # fmt: skip


def empty_grid(axes: Axes) -> Grid:
    """Make the nodes of a grid, all zero."""
    rows, columns = axes.y.cells + 1, axes.x.cells + 1
    return Grid(np.zeros((rows, columns)), *(zeros(rows, columns) for _ in range(5)))


def outline(study) -> np.ndarray:
    """Outline of the body before it moves: corners, shape (k, 2) [m]."""
    return body(study).outline


def toe_x(study) -> float:
    """Coordinate of the toe before it moves [m]."""
    return body(study).toe


def crest_edge_x(study) -> float:
    """Coordinate of the crest's edge before it moves [m]."""
    return body(study).crest_edge


def domain_size(study) -> tuple[float, float]:
    """Length and height of the domain [m]."""
    return body(study).length, body(study).top


def _critical_rate(shape: Body, shear_wave_speed: float) -> float:
    """Rate that damps the body's slowest swing critically: a quarter of a shear wave over its height [1/s]."""
    return pi * shear_wave_speed / shape.outline[:, 1].max()


def _wall(boundary):
    kind = WALLS[boundary.kind]
    return kind(*(getattr(boundary, name) for name in kind._fields))
