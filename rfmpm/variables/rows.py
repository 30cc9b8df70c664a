"""The table of what a row holds: what came of a realisation, and where it was computed.

A text in `attributes` may name settings of the study in braces, e.g. `{study.quantities.displacement_threshold_m}`;
the file then records the value that was used.
"""

from typing import Any

from rfmpm import failure_modes
from rfmpm.variables.status import FAILED, STATUS
from rfmpm.variables.variable import (
    Variable,
    has_factor,
    has_obstacle,
    has_surface,
    is_uncertain,
    starts_otherwise,
    table,
)

_YES_NO = {"flag_values": (0, 1), "flag_meanings": "no yes"}
_FAILED_SET = (
    "failed set: the material points that moved further than {study.quantities.displacement_threshold_m:g} m "
    "between start and end"
)


def _quantity(name, unit, long_name, comment, dtype="float64", **attributes) -> Variable:
    return Variable(name, ("realisation",), dtype, unit, long_name, {"comment": comment, **attributes})


VARIABLES = table(
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
        starts_otherwise,
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
        has_factor,
    ),
    Variable(
        "impact_force_peak",
        ("realisation",),
        "float64",
        "N m-1",
        "largest force on the obstacles per metre of width",
        {"comment": "Horizontal, to the right positive; the largest mean over 0.1 s of model time, all obstacles."},
        has_obstacle,
    ),
    Variable(
        "final_surface",
        ("realisation", "x"),
        "float64",
        "m",
        "height of the final ground surface",
        {"comment": "Highest ground in each bin, above the base; 0 where the base is bare, missing where it failed."},
        has_surface,
    ),
    Variable(
        "uncertain_value",
        ("realisation", "uncertain"),
        "float64",
        "",
        "values of the uncertain numbers of the study",
        {"comment": "Each in the unit that its key ends in; missing where the realisation crashed or was lost."},
        is_uncertain,
    ),
)

PROVENANCE = table(
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
