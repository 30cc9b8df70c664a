"""The section of a prepared study, and the strength of its material points in one realisation."""

from collections.abc import Mapping
from math import radians, sqrt
from typing import Any, NamedTuple

import numpy as np

from rfmpm.mpm.boundary import Friction, Roller
from rfmpm.mpm.scene import GRAVITY
from rfmpm.stability.limit_equilibrium import Critical, critical_surface
from rfmpm.stability.section import Section, Side, sides_of

STRENGTH_OF = {"sqrt_j2": 1.0, "sqrt_3j2": 1.0 / sqrt(3.0)}  # undrained shear strength over cohesion
FIRM = 1e12  # cohesion of what never yields [Pa]: any surface through it has a factor beyond all others


class Strength(NamedTuple):
    """What resists and what drives, at the material points; arrays of shape (n,)."""

    cohesion: np.ndarray  # [Pa]
    friction_angle: np.ndarray  # [rad]
    unit_weight: np.ndarray  # [N/m3]


def section_of(scene: Any, points_per_cell: int) -> Section:
    """Make the section of a scene; its sides are walls and its floor is firm, so that no surface leaves through them.

    On a floor with friction, or on rollers, surfaces run along it; soil on a fixed one holds by its own strength.

    Args:
        scene: `body`, `points`, `load`, `walls` and `cell` are read.
        points_per_cell: in a full cell.

    Returns:
        The section.
    """
    outline, points = scene.body.outline, np.column_stack(scene.points.position)
    ground, square = ground_of(outline, scene.body.length), scene.cell / sqrt(points_per_cell)
    friction = _friction_of(scene.walls.base)
    section = Section(ground, float(outline[:, 1].min()), points, square, base_friction=friction)
    if scene.load is None:
        return section
    left = np.floor(points[scene.load.point, 0] / square + 1e-9) * square
    return section._replace(load=np.column_stack([left, left + square, scene.load.force / square]))


def _friction_of(base: tuple) -> float:
    """Coefficient of friction of a base [-]; infinite where nothing moves on it."""
    if isinstance(base, Friction):
        return base.coefficient
    return 0.0 if isinstance(base, Roller) else np.inf


def ground_of(outline: np.ndarray, length: float) -> np.ndarray:
    """The free surface of a body between walls at 0 and at the length of the domain.

    Args:
        outline: corners of the body, anticlockwise, shape (k, 2) [m].
        length: of the domain [m].

    Returns:
        The surface from left to right, shape (m, 2) [m]; a side that stands free of its wall belongs to it.
    """
    x, y = outline.T
    left, right = x == x.min(), x == x.max()
    first = np.flatnonzero(left)[(np.argmax if x.min() <= 0.0 else np.argmin)(y[left])]
    last = np.flatnonzero(right)[(np.argmax if x.max() >= length else np.argmin)(y[right])]
    backwards = np.roll(outline[::-1], first + 1 - len(outline), axis=0)  # clockwise, from the first corner on
    return backwards[: (first - last) % len(outline) + 1]


def strength_of(prepared: Any, fields: Mapping[str, np.ndarray]) -> Strength:
    """Peak strength and weight of the material points in one realisation.

    Args:
        prepared: the prepared study.
        fields: of the realisation by name, shape (n,) each, in SI units; what is missing is the material's own.

    Returns:
        The strength. An undrained one is the cohesion, by the material's convention, without friction; what is elastic
        never yields.

    Raises:
        ValueError: nothing yields.
    """
    soils, points = prepared.scene.soils, prepared.scene.points
    if all(material.law == "elastic" for material in soils.materials):
        raise ValueError('material.0.law = "elastic": has no strength, hence no factor of safety')
    own = soils.of_each([getattr(material, "cohesion_kpa", 0.0) * 1e3 for material in soils.materials])
    cohesion = fields.get("cohesion", own) * soils.of_each([_per_cohesion(material) for material in soils.materials])
    yields = soils.of_each([float(material.law != "elastic") for material in soils.materials])
    cohesion = np.where(yields > 0.0, cohesion, FIRM)
    angles = [radians(getattr(material, "friction_angle_deg", 0.0)) for material in soils.materials]
    angle = fields["friction_angle"] if "friction_angle" in fields else soils.of_each(angles)
    # Where a law has no friction, its field says so with something that is not a number.
    angle = np.where(np.isnan(angle), 0.0, angle)
    return Strength(cohesion, angle, points.mass * GRAVITY / points.volume)


def _per_cohesion(material: Any) -> float:
    """Shear strength without normal stress over the cohesion [-]."""
    return STRENGTH_OF[material.strength_convention] if material.law == "von_mises" else 1.0


def lay(scene: Any, points_per_cell: int) -> tuple[Side, ...]:
    """What limit equilibrium shares between the realisations of a scene."""
    return sides_of(section_of(scene, points_per_cell))


def limit_equilibrium(method: str, prepared: Any, fields: Mapping[str, np.ndarray]) -> Critical:
    """The slip surface of least factor of safety in one realisation, by a method of slices.

    Args:
        method: as for `critical_surface`.
        prepared: the prepared study.
        fields: as for `strength_of`.

    Returns:
        The surface and its factor.
    """
    sides = prepared.sides or lay(prepared.scene, prepared.study.discretisation.points_per_cell)
    return critical_surface(sides, *strength_of(prepared, fields), method)
