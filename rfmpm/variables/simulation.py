"""The tables of what a simulation file holds: points, histories of the whole body and of chosen points."""

from rfmpm.variables.variable import Variable, always, has_obstacle, table, varies


def _point(name, unit, long_name, dims=("time", "point"), is_active=always, **attributes) -> Variable:
    return Variable(name, dims, "float64", unit, long_name, attributes, is_active)


POINT_VARIABLES = table(
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
        varies("residual_cohesion"),
        comment="Counts as far as it is below the peak cohesion.",
    ),
    _point("friction_angle", "rad", "peak angle of friction", ("point",), varies("friction_angle")),
    _point("volume", "m3 m-1", "volume of the point per metre of width"),
)

HISTORY_VARIABLES = table(
    _point("kinetic_energy", "J m-1", "kinetic energy per metre of width", ("history_time",)),
    _point("front", "m", "horizontal position of the front of the failed mass", ("history_time",)),
    _point("crest", "m", "horizontal position of the crest edge", ("history_time",)),
    _point(
        "impact_force",
        "N m-1",
        "horizontal force on the obstacles per metre of width, mean since the entry before",
        ("history_time",),
        has_obstacle,
    ),
    _point("failed_volume", "m3 m-1", "initial volume of the failed set per metre of width", ("history_time",)),
)


_MEAN = "Mean since the sample before: the difference of velocities over that time; 0 at the start."


def _motion(name, unit, long_name, dims=("motion_time", "history_point"), **attributes) -> Variable:
    return _point(name, unit, long_name, dims, **attributes)


MOTION_VARIABLES = table(
    _motion("history_x", "m", "horizontal position of the point at the start", ("history_point",)),
    _motion("history_y", "m", "height of the point above the base at the start", ("history_point",)),
    _motion("history_displacement_x", "m", "horizontal displacement of the point"),
    _motion("history_displacement_y", "m", "vertical displacement of the point", comment="Positive upwards."),
    _motion("history_velocity_x", "m s-1", "horizontal velocity of the point"),
    _motion("history_velocity_y", "m s-1", "vertical velocity of the point", comment="Positive upwards."),
    _motion("history_acceleration_x", "m s-2", "horizontal acceleration of the point", comment=_MEAN),
    _motion("history_acceleration_y", "m s-2", "vertical acceleration of the point", comment=f"Upwards. {_MEAN}"),
)
