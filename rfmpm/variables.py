"""THE table of variables: what a row, a simulation file and their NetCDF attributes hold; nothing else names them.

A text in `attributes` may name settings of the study in braces, e.g. `{study.quantities.displacement_threshold_m}`;
the file then records the value that was used.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from rfmpm import failure_modes

STATUS = {"ok": 0, "not_at_rest": 1, "diverged": 2, "left_grid": 3, "timeout": 4, "crashed": 5, "lost": 6, "refused": 7}
FAILED = frozenset({"diverged", "left_grid", "timeout", "crashed", "lost", "refused"})  # their quantities are NaN
STATUS_NAMES = {code: name for name, code in STATUS.items()}
FAILED_CODES = frozenset(STATUS[name] for name in FAILED)
BY_CHANCE = frozenset(STATUS[name] for name in ("timeout", "crashed", "lost"))  # may end otherwise the next time

_YES_NO = {"flag_values": (0, 1), "flag_meanings": "no yes"}
_FAILED_SET = (
    "failed set: the material points that moved further than {study.quantities.displacement_threshold_m:g} m "
    "between start and end"
)


def _always(study) -> bool:
    return True


def _has_surface(study) -> bool:
    return study.output.surface_bin_m is not None


def _has_obstacle(study) -> bool:
    return bool(study.obstacle)


def _has_factor(study) -> bool:
    return bool(study.quantities.factor_of_safety)


def _starts_otherwise(study) -> bool:
    return study.time.initial_stress != "elastic"


def _is_uncertain(study) -> bool:
    return study.uncertain is not None


def _varies(name: str) -> Callable[[Any], bool]:
    return lambda study: name in study.random_field


@dataclass(frozen=True)
class Variable:
    """One variable: its place in a file, its unit (empty for flags and texts) and its definition."""

    name: str
    dims: tuple[str, ...]
    dtype: str
    unit: str
    long_name: str
    attributes: Mapping[str, Any] = field(default_factory=dict)
    is_active: Callable[[Any], bool] = _always


def _quantity(name, unit, long_name, comment, dtype="float64", **attributes) -> Variable:
    return Variable(name, ("realisation",), dtype, unit, long_name, {"comment": comment, **attributes})


def _table(*variables: Variable) -> dict[str, Variable]:
    return {variable.name: variable for variable in variables}


VARIABLES = _table(
    _quantity(
        "run_out",
        "m",
        "run-out distance",
        f"Horizontal distance from the initial toe to the front of the connected failed mass, the front being the "
        f"quantile {{study.quantities.front_quantile:g}} of its mass; {_FAILED_SET}.",
    ),
    _quantity(
        "run_out_censored",
        "",
        "run-out is a lower bound",
        "The front reached the far wall, so that the run-out is at least the value given.",
        "int8",
        **_YES_NO,
    ),
    _quantity(
        "retrogression_distance",
        "m",
        "retrogression distance",
        f"Initial crest edge minus the smallest initial x of a failed point in the top row; {_FAILED_SET}.",
    ),
    _quantity(
        "retrogression_censored",
        "",
        "retrogression is a lower bound",
        "The failure reached the boundary behind the crest, so that the retrogression is at least the value given.",
        "int8",
        **_YES_NO,
    ),
    _quantity(
        "failure_volume",
        "m3 m-1",
        "failure volume per metre of width",
        f"Initial volume of the failed set per metre of width; {_FAILED_SET}.",
    ),
    _quantity(
        "initial_failure_volume",
        "m3 m-1",
        "volume of the initial failure per metre of width",
        "Initial volume, per metre of width, of the points that had moved further than "
        "{study.quantities.displacement_threshold_m:g} m at the first minimum of the kinetic energy.",
    ),
    _quantity(
        "influence_distance",
        "m",
        "influence distance",
        "Run-out plus horizontal width of the slope plus retrogression distance.",
    ),
    _quantity(
        "block_count",
        "1",
        "number of blocks",
        "Connected components of the failed set with plastic strain below {study.quantities.block_plastic_strain:g} "
        "and an area of at least {study.quantities.block_minimum_area_m2:g} m2.",
        "int32",
    ),
    _quantity(
        "failure_mode",
        "",
        "kind of failure",
        "The first that fits. "
        + "; ".join(f"{name}: {failure_modes.DEFINITIONS[name]}" for name in failure_modes.ORDER)
        + f". Slip surface: the lower border of the largest connected part of the failed set before it moved; blocks "
        f"as counted in block_count; {_FAILED_SET}.",
        "int8",
        flag_values=tuple(range(len(failure_modes.MODES))),
        flag_meanings=" ".join(failure_modes.MODES),
    ),
    _quantity(
        "status",
        "",
        "how the realisation ended",
        "Quantities of a realisation that did not end ok or not_at_rest are missing; it enters an estimate as bounds.",
        "int8",
        flag_values=tuple(STATUS.values()),
        flag_meanings=" ".join(STATUS),
    ),
    _quantity("status_reason", "", "why it ended so", "Empty where there is nothing to say.", "str"),
    _quantity(
        "time_at_rest",
        "s",
        "model time at which the body came to rest",
        "At rest: kinetic energy below 1e-3 of its maximum for 1 s of model time. What only swings elastically after "
        "the last flow is damped. Missing where it did not come to rest before the end.",
    ),
    _quantity("step_count", "1", "number of time steps", "Time steps computed.", "int64"),
    _quantity(
        "wall_time",
        "s",
        "computing time",
        "Elapsed time of this realisation on its worker; differs from run to run.",
    ),
    _quantity(
        "plastic_work_share",
        "1",
        "share of plastic work",
        "Work of the stress that is not stored elastically, relative to the work done by gravity.",
    ),
    _quantity(
        "friction_work_share",
        "1",
        "share of the work of friction",
        "Work of friction on base and sides, relative to the work done by gravity.",
    ),
    _quantity(
        "numerical_dissipation_share",
        "1",
        "share of numerical dissipation",
        "Energy that the transfer between points and grid and the integration in time take, relative to the work done "
        "by gravity; negative where they add energy.",
    ),
    _quantity(
        "energy_balance_error",
        "1",
        "error of the energy balance",
        "Work of gravity less kinetic energy, elastic energy gained, plastic work, work of friction and numerical "
        "dissipation, relative to the work of gravity.",
    ),
    Variable(
        "out_of_balance",
        ("realisation",),
        "float64",
        "1",
        "initial forces out of balance",
        {
            "comment": "Norm of the unbalanced forces on the free nodes before the first step, over that of gravity's; "
            "known where the simulation failed, too."
        },
        _starts_otherwise,
    ),
    Variable(
        "factor_of_safety",
        ("realisation",),
        "float64",
        "1",
        "factor of safety",
        {
            "comment": "With the peak strength at the material points, by {study.quantities.safety_method}: limit "
            "equilibrium gives the smallest over slip surfaces, strength_reduction the number by which cohesion and "
            "tan(phi) can be divided; known where the simulation failed, missing where the method has no solution."
        },
        _has_factor,
    ),
    Variable(
        "impact_force_peak",
        ("realisation",),
        "float64",
        "N m-1",
        "largest force on the obstacles per metre of width",
        {"comment": "Horizontal, to the right positive; the largest mean over 0.1 s of model time, all obstacles."},
        _has_obstacle,
    ),
    Variable(
        "final_surface",
        ("realisation", "x"),
        "float64",
        "m",
        "height of the final ground surface",
        {"comment": "Highest ground in each bin, above the base; 0 where the base is bare, missing where it failed."},
        _has_surface,
    ),
    Variable(
        "uncertain_value",
        ("realisation", "uncertain"),
        "float64",
        "",
        "values of the uncertain numbers of the study",
        {"comment": "Each in the unit that its key ends in; missing where the realisation crashed or was lost."},
        _is_uncertain,
    ),
)

PROVENANCE = _table(
    _quantity(
        "attempt",
        "1",
        "number of starts until it ended",
        "1 unless an earlier start took its worker with it or was tried again; differs from run to run.",
        "int32",
    ),
    _quantity(
        "origin",
        "1",
        "where it was computed",
        "Number of the line of the global attribute origins that names machine and versions; differs from run to run.",
        "int32",
    ),
)

RUN_DEPENDENT = frozenset({"wall_time", *PROVENANCE})  # no part of what a campaign found: left out of its hash

COORDINATES = _table(
    Variable(
        "realisation",
        ("realisation",),
        "int64",
        "1",
        "index of the realisation",
        {"comment": "Computed again, bit for bit, by: rfmpm rerun DIR --index INDEX [--level LEVEL]."},
    ),
    Variable(
        "level",
        ("realisation",),
        "int32",
        "1",
        "level of the plan",
        {
            "comment": "On whose cells it was simulated: 0 for the study's own, k for the k-th of its "
            "estimator.coarser_cells_m. A realisation has the same random numbers on every level."
        },
    ),
    Variable(
        "x",
        ("x",),
        "float64",
        "m",
        "horizontal position of the bin centre",
        {"axis": "X", "comment": "From the left side of the domain."},
        _has_surface,
    ),
    Variable(
        "uncertain",
        ("uncertain",),
        "str",
        "",
        "key of an uncertain number",
        {"comment": "Dotted path in the study, lists by position."},
        _is_uncertain,
    ),
)


def _point(name, unit, long_name, dims=("time", "point"), is_active=_always, **attributes) -> Variable:
    return Variable(name, dims, "float64", unit, long_name, attributes, is_active)


POINT_VARIABLES = _table(
    _point("x", "m", "horizontal position"),
    _point("y", "m", "height above the base"),
    _point("x_initial", "m", "horizontal position at the start", ("point",)),
    _point("y_initial", "m", "height above the base at the start", ("point",)),
    _point("displacement_x", "m", "horizontal displacement"),
    _point("displacement_y", "m", "vertical displacement", comment="Positive upwards."),
    _point("velocity_x", "m s-1", "horizontal velocity"),
    _point("velocity_y", "m s-1", "vertical velocity", comment="Positive upwards."),
    _point("stress_xx", "Pa", "horizontal normal stress", comment="Tension positive."),
    _point("stress_yy", "Pa", "vertical normal stress", comment="Tension positive."),
    _point("stress_zz", "Pa", "out-of-plane normal stress", comment="Tension positive."),
    _point("stress_xy", "Pa", "shear stress"),
    _point("plastic_strain", "1", "plastic shear strain invariant"),
    _point("cohesion", "Pa", "peak cohesion", ("point",)),
    _point(
        "residual_cohesion",
        "Pa",
        "residual cohesion of its random field",
        ("point",),
        _varies("residual_cohesion"),
        comment="Counts as far as it is below the peak cohesion.",
    ),
    _point("friction_angle", "rad", "peak angle of friction", ("point",), _varies("friction_angle")),
    _point("volume", "m3 m-1", "volume of the point per metre of width"),
)

HISTORY_VARIABLES = _table(
    _point("kinetic_energy", "J m-1", "kinetic energy per metre of width", ("history_time",)),
    _point("front", "m", "horizontal position of the front of the failed mass", ("history_time",)),
    _point("crest", "m", "horizontal position of the crest edge", ("history_time",)),
    _point(
        "impact_force",
        "N m-1",
        "horizontal force on the obstacles per metre of width, mean since the entry before",
        ("history_time",),
        _has_obstacle,
    ),
    _point("failed_volume", "m3 m-1", "initial volume of the failed set per metre of width", ("history_time",)),
)


_MEAN = "Mean since the sample before: the difference of velocities over that time; 0 at the start."


def _motion(name, unit, long_name, dims=("motion_time", "history_point"), **attributes) -> Variable:
    return _point(name, unit, long_name, dims, **attributes)


MOTION_VARIABLES = _table(
    _motion("history_x", "m", "horizontal position of the point at the start", ("history_point",)),
    _motion("history_y", "m", "height of the point above the base at the start", ("history_point",)),
    _motion("history_displacement_x", "m", "horizontal displacement of the point"),
    _motion("history_displacement_y", "m", "vertical displacement of the point", comment="Positive upwards."),
    _motion("history_velocity_x", "m s-1", "horizontal velocity of the point"),
    _motion("history_velocity_y", "m s-1", "vertical velocity of the point", comment="Positive upwards."),
    _motion("history_acceleration_x", "m s-2", "horizontal acceleration of the point", comment=_MEAN),
    _motion("history_acceleration_y", "m s-2", "vertical acceleration of the point", comment=f"Upwards. {_MEAN}"),
)


def active_variables(study) -> list[Variable]:
    """List the variables that one row of a study holds.

    Args:
        study: the study.

    Returns:
        The active entries of VARIABLES, in its order; an inactive one is neither computed nor stored.
    """
    return [variable for variable in VARIABLES.values() if variable.is_active(study)]


def failed_row(
    study, index: int, status: str, reason: str, level: int = 0, wall_time: float = float("nan")
) -> dict[str, Any]:
    """Make the row of a realisation that has no result.

    Args:
        study: the study.
        index: of the realisation.
        status: one of FAILED.
        reason: what happened, one line.
        level: of the plan.
        wall_time: spent on it [s].

    Returns:
        A row whose quantities are NaN (one scalar NaN for a whole surface).

    Raises:
        ValueError: for a status that is not one of FAILED.
    """
    if status not in FAILED:
        raise ValueError(f"status = {status!r}: allowed are {', '.join(sorted(FAILED))}")
    row: dict[str, Any] = {variable.name: float("nan") for variable in active_variables(study)}
    row.update(realisation=index, level=level, status=STATUS[status], status_reason=reason, wall_time=wall_time)
    return row
