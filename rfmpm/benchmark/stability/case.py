"""One run of the stress test: a small slope with something changed, and what may come of it."""

from collections.abc import Callable, Mapping
from copy import deepcopy
from dataclasses import dataclass, field
from typing import Any

from rfmpm.realisation import Prepared
from rfmpm.study import Study

CELL = 0.5  # [m]

# The short slope of the main study on coarse cells: a run takes a fraction of a second.
SLOPE = {
    "study": {"name": "stress test", "seed": 20160901},
    "geometry": {"kind": "slope", "height_m": 5.0, "crest_m": 10.0, "angle_deg": 45.0, "foreland_m": 25.0},
    "discretisation": {"cell_m": CELL, "points_per_cell": 4, "shape": "quadratic_bspline"},
    "boundary": {"base": {"kind": "friction", "coefficient": 0.3}, "sides": {"kind": "roller"}},
    "material": [
        {
            "name": "clay",
            "law": "von_mises",
            "unit_weight_kn_m3": 20.0,
            "youngs_modulus_kpa": 1000.0,
            "poissons_ratio": 0.33,
            "cohesion_kpa": 20.0,
            "residual_cohesion_kpa": 4.0,
            "softening_modulus_kpa": 50.0,
            "softening_length_m": 0.5,
            "viscosity_kpa_s": 0.3,
        }
    ],
    "time": {"end_s": 20.0},
    "output": {"directory": "unused"},
}
ELASTIC = {
    "name": "clay",
    "law": "elastic",
    "unit_weight_kn_m3": 20.0,
    "youngs_modulus_kpa": 1000.0,
    "poissons_ratio": 0.33,
}


def random_strength(cov: float, scale_h: float, scale_v: float) -> dict[str, Any]:
    """Table of a lognormal cohesion: coefficient of variation, scales of fluctuation [m]."""
    return {
        "material": "clay",
        "distribution": "lognormal",
        "coefficient_of_variation": cov,
        "correlation": "markov_separable",
        "scale_of_fluctuation_h_m": scale_h,
        "scale_of_fluctuation_v_m": scale_v,
        "method": "cholesky",
    }


def block(width: float, height: float, foreland: float) -> dict[str, Any]:
    """Geometry of a rectangular block [m]."""
    return {"kind": "block", "width_m": width, "height_m": height, "foreland_m": foreland}


@dataclass(frozen=True)
class Case:
    """One run; those of a sweep with the same row and column share a place in its picture."""

    row: str
    column: str
    changes: Mapping[str, Any] = field(default_factory=dict)  # of the slope above, by dotted path
    index: int = 0  # of the realisation
    arrange: Callable[[Prepared], Prepared] | None = None  # changes what a study file cannot say
    refusal: str = ""  # key that a refusal must name; empty where none is expected
    may_stop: bool = False  # made to blow up: to be stopped is right

    def study(self) -> Study:
        """Make the study; raises StudyError where it is refused."""
        return Study(**deepcopy(SLOPE)).with_changes(self.changes)


@dataclass(frozen=True)
class Sweep:
    """A question about stability and the cases that answer it."""

    name: str
    title: str
    rows: str  # what the rows are
    columns: str  # what the columns are
    cases: list[Case]
