"""A scene: everything that realisations of one study share, and what one of them starts from."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, pi
from typing import NamedTuple

import numpy as np

from rfmpm.ground import height_at
from rfmpm.kernel_tools import Tensor, Vector, zeros
from rfmpm.mpm.attachments import Load, Obstacle
from rfmpm.mpm.boundary import WALLS, Walls
from rfmpm.mpm.cells import Cells, make_cells
from rfmpm.mpm.energy import elastic_energy
from rfmpm.mpm.geometry import Body, Filling, body, fill_body
from rfmpm.mpm.initial_stress import INITIAL_STRESSES, Unreleased
from rfmpm.mpm.nonlocal_softening import Averaging, averaging
from rfmpm.mpm.placing import load_of, obstacle_of
from rfmpm.mpm.shapes import build_axis
from rfmpm.mpm.soils import GRAVITY, Soils, soils_of, stress_factor
from rfmpm.mpm.solvers import Alone, Controls, make_team
from rfmpm.mpm.state import Axes, Grid, Points, copy_points

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
    soils: Soils
    lame: float | np.ndarray  # shape (n,) where there are several materials [Pa]
    shear: float | np.ndarray  # the same [Pa]
    cell_means: bool  # volumetric strain and pressure are means over the points of a cell
    load: Load | None = None  # on the surface
    obstacle: Obstacle | None = None
    removed: Filling | None = None  # points that are there when the initial stresses are found, and then cut away


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
    points, removed = fill_body(study, shape)
    kind, per_cell = study.discretisation.shape, study.discretisation.points_per_cell
    axes = Axes(*(build_axis(kind, cell, round(extent / cell), per_cell) for extent in (shape.length, shape.top)))
    return _scene(study, shape, axes, points, removed)


def with_parameters(scene: Scene, study) -> Scene:
    """Make the scene of a study that differs from the scene's own in numbers of material and boundaries alone.

    Elastic stresses at rest are scaled where they can be, see `stress_factor`; else they are found anew.

    Args:
        scene: of the other study.
        study: the study.

    Returns:
        The scene.
    """
    stress, points = None, scene.points
    factor = stress_factor(scene.soils, soils_of(study, scene.soils.counts))
    is_scaled = factor is not None and (factor == 1.0 or scene.load is None)
    if study.time.initial_stress == "elastic" and is_scaled:
        stress = Tensor(*(factor * component for component in points.stress))
    filling = Filling(np.column_stack(points.position), points.volume.copy(), scene.soils.counts)
    return _scene(study, scene.body, scene.axes, filling, scene.removed, stress)


def _scene(
    study, shape: Body, axes: Axes, filling: Filling, removed: Filling | None, stress: Tensor | None = None
) -> Scene:
    cell, soils = study.discretisation.cell_m, soils_of(study, filling.counts)
    position, volume, _ = filling
    lame, shear = soils.elastic_constants
    walls = Walls(_wall(study.boundary.base), _wall(study.boundary.sides))
    mass = soils.density * volume
    length = soils.softening_length
    averaged = study.discretisation.volumetric_strain == "cell_mean"
    if stress is None:
        stress = _stress_at_rest(study, shape, filling, removed, axes, walls, averaged)
    still = Vector(np.zeros(len(volume)), np.zeros(len(volume)))
    points = Points(Vector(*position.T.copy()), still, mass, volume, stress)
    controls = Controls(
        gravity=GRAVITY,
        cell=cell,
        wave_speed=soils.wave_speed(),
        courant=study.time.step_fraction,
        dissipation_time=study.discretisation.dissipation_time_s,
        filter_interval=FILTER_INTERVAL,
        average_interval=_average_interval(soils, length) if length else inf,
        rest_fraction=REST_FRACTION,
        rest_time=REST_TIME,
        own_share=axes.x.OWN_SHARE,
        settling_rate=_critical_rate(shape, soils.shear_wave_speed(lambda material: material.law != "elastic")),
        energy_scale=elastic_energy(points, lame, shear),
        growth_limit=GROWTH_LIMIT,
    )
    load, obstacle = load_of(study, position), obstacle_of(study, shape)
    return Scene(shape, cell, points, axes, walls, controls, soils, lame, shear, averaged, load, obstacle, removed)


def _stress_at_rest(
    study, shape: Body, filling: Filling, removed: Filling | None, axes: Axes, walls: Walls, averaged: bool
) -> Tensor:
    """Stresses of the points, found with those that are then cut away."""
    position, volume, counts = filling
    parts = [soils_of(study, counts)]
    if removed is not None:
        parts.append(soils_of(study, removed.counts))
        position = np.concatenate([position, removed.position])
        volume = np.concatenate([volume, removed.volume])
    (lame, shear), density = (
        [_together([part.elastic_constants[k] for part in parts]) for k in range(2)],
        _together([part.density for part in parts]),
    )
    mass = density * volume
    soil = np.concatenate([np.repeat(np.arange(len(part.counts)), part.counts) for part in parts])
    if (load := load_of(study, filling.position)) is not None:
        mass[load.point] += load.force / GRAVITY  # it weighs like soil; mass does nothing else here
    still = Unreleased(shape.outline, soil, position, mass, volume, axes, walls, lame, shear, GRAVITY, averaged)
    stress = INITIAL_STRESSES[study.time.initial_stress](still, study)
    return Tensor(*(component[: sum(counts)] for component in stress))


def _together(values: list) -> float | np.ndarray:
    """Values of points that follow each other; one value of a single material stays one."""
    return values[0] if np.ndim(values[0]) == 0 else np.concatenate(values)


def _average_interval(soils: Soils, length: float) -> float:
    """Time from one average of the softening to the next [s]."""
    return AVERAGE_SHARE * length / soils.shear_wave_speed(lambda one: getattr(one, "softening_length_m", None))


class Released(NamedTuple):
    """What one realisation changes or owns."""

    points: Points
    law: tuple
    history: tuple | None
    grid: Grid
    cells: Cells | None
    averaging: Averaging | None
    load: Load | None
    obstacle: Obstacle | None


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
    law, history = scene.soils.laws(scene.cell, strengths or {})
    cells = make_cells(count, scene.axes) if scene.cell_means else None
    averaged, means = scene.soils.averaged(history), None
    if averaged is not None:
        means = averaging(scene.soils.softening_length, averaged, scene.axes)
    outside = (_copied(scene.load), _copied(scene.obstacle))
    return Released(copy_points(scene.points), law, history, empty_grid(scene.axes), cells, means, *outside)


def _copied(record: tuple | None) -> tuple | None:
    """A record of arrays that can change without this one."""
    return None if record is None else type(record)(*(values.copy() for values in record))


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
        own.load, own.obstacle, passes,
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


def ground_height(study, x: np.ndarray) -> np.ndarray:
    """Height of the ground beyond the toe before it moves, at some x, same shape [m]."""
    ground = body(study).ground
    return np.zeros_like(x) if ground is None else height_at(ground, x)


def domain_size(study) -> tuple[float, float]:
    """Length and height of the domain [m]."""
    return body(study).length, body(study).top


def _critical_rate(shape: Body, shear_wave_speed: float) -> float:
    """Rate that damps the body's slowest swing critically: a quarter of a shear wave over its height [1/s]."""
    return pi * shear_wave_speed / shape.outline[:, 1].max()


def _wall(boundary):
    kind = WALLS[boundary.kind]
    return kind(*(getattr(boundary, name) for name in kind._fields))
