"""What a study file cannot say: scenes rearranged by hand before they run. Each returns the changed prepared study."""

from dataclasses import dataclass, replace
from math import inf

import numpy as np

from rfmpm.kernel_tools import Tensor, Vector
from rfmpm.mpm.state import Points
from rfmpm.realisation import Prepared


def beyond_the_critical_step(fraction: float, prepared: Prepared) -> Prepared:
    """Take steps of any fraction of the critical one; a study may not ask for more than 1."""
    courant = prepared.scene.controls.courant * fraction / prepared.study.time.step_fraction
    return _with_controls(prepared, courant=courant)


def never_at_rest(prepared: Prepared) -> Prepared:
    """Release without any stress and go on to the end, at rest or not."""
    return _with_controls(unstressed(prepared), rest_time=inf)


def unstressed(prepared: Prepared) -> Prepared:
    """Release without any stress."""
    points = prepared.scene.points
    zero = Tensor(*(np.zeros_like(component) for component in points.stress))
    return _with_controls(_with_points(prepared, points._replace(stress=zero)), energy_scale=0.0)


def lone_point(column: float, row: float, prepared: Prepared) -> Prepared:
    """Keep one point, without stress, at (column, row) in cells from the lower left."""
    cell, points = prepared.scene.cell, prepared.scene.points
    single = Points(
        Vector(np.array([column * cell]), np.array([row * cell])),
        Vector(*(component[:1].copy() for component in points.velocity)),
        points.mass[:1].copy(),
        points.volume[:1].copy(),
        Tensor(*(component[:1].copy() for component in points.stress)),
    )
    return unstressed(_with_points(prepared, single))


def parted(gap: float, prepared: Prepared) -> Prepared:
    """Lift the upper half by a gap in cells, and release without any stress, so that it falls on the lower one."""
    scene = prepared.scene
    lifted = scene.points.position.y > 0.5 * scene.body.height
    position = scene.points.position._replace(y=scene.points.position.y + lifted * gap * scene.cell)
    return unstressed(_with_points(prepared, scene.points._replace(position=position)))


@dataclass(frozen=True)
class Pattern:
    """A marginal distribution that gives every point a strength of its own, whatever the field says."""

    values: np.ndarray  # (n,) [Pa]

    def transform(self, z: np.ndarray) -> np.ndarray:
        """The values."""
        return self.values


def contrast(pattern: str, ratio: float, prepared: Prepared) -> Prepared:
    """Give neighbouring points strengths that differ by a ratio; the weak have the mean strength over its root."""
    points, cell = prepared.scene.points, prepared.scene.cell
    spacing = cell / np.sqrt(prepared.study.discretisation.points_per_cell)
    column, row = (np.floor(along / spacing).astype(int) for along in points.position)
    middle = np.argmin(np.hypot(points.position.x - prepared.scene.body.crest_edge, points.position.y - 2.0 * cell))
    is_weak = {
        "every other point": (column + row) % 2 == 0,
        "every other layer": row % 2 == 0,
        "one weak point": np.arange(len(row)) == middle,
        "all weak but one": np.arange(len(row)) != middle,
    }[pattern]
    mean = prepared.study.material[0].cohesion_kpa * 1e3
    values = np.where(is_weak, mean / np.sqrt(ratio), mean * np.sqrt(ratio))
    (part,) = prepared.fields["cohesion"].parts
    part = replace(part, field=replace(part.field, marginal=Pattern(values)))
    entries = {"cohesion": replace(prepared.fields["cohesion"], parts=(part,))}
    return replace(prepared, properties=replace(prepared.properties, entries=entries))


def _with_points(prepared: Prepared, points: Points) -> Prepared:
    return replace(prepared, scene=replace(prepared.scene, points=points))


def _with_controls(prepared: Prepared, **changes: float) -> Prepared:
    return replace(prepared, scene=replace(prepared.scene, controls=prepared.scene.controls._replace(**changes)))
