"""What was simulated, in words for a reader who knows risk but not the method."""

NAMES = {
    "ok": "came to rest",
    "not_at_rest": "still moving at the end",
    "diverged": "diverged",
    "left_grid": "a point left the grid",
    "timeout": "ran out of time",
    "crashed": "crashed",
    "lost": "lost",
}

MEANS = {
    "cohesion": ("cohesion_kpa", " kPa"),
    "residual_cohesion": ("residual_cohesion_kpa", " kPa"),
    "friction_angle": ("friction_angle_deg", "° (its tangent is what varies)"),
}


def setting(study) -> str:
    """Say in one sentence what slope it is about.

    Args:
        study: the Study.

    Returns:
        A sentence.
    """
    varied = ", ".join(name.replace("_", " ") for name in dict.fromkeys(field.variable for field in study.fields))
    soil = f"whose {varied} varies from place to place" if varied else "of the same strength everywhere"
    doubt = " Some of its numbers are uncertain." if study.uncertain else ""
    return f"{_body(study)} {soil}.{doubt}"


def background(study) -> str:
    """Say what was simulated.

    Args:
        study: the Study.

    Returns:
        A few sentences.
    """
    return f"{_body(study)} is released under its own weight. {_strength(study)}"


def _body(study) -> str:
    geometry = study.geometry
    if geometry.kind == "slope":
        return f"A slope {geometry.height_m:g} m high, inclined at {geometry.angle_deg:g}°,"
    if geometry.kind == "regions":
        return f"A body of {len(geometry.region)} regions of {', '.join(one.name for one in study.material)}"
    return f"A block of soil {geometry.width_m:g} m wide and {geometry.height_m:g} m high"


def _strength(study) -> str:
    if not study.fields:
        return "Its strength is the same everywhere and in every realisation."
    kind = "body" if study.geometry.kind == "regions" else study.geometry.kind
    properties = "; ".join(_random_property(study, field) for field in study.fields)
    return (
        f"Its strength varies from place to place: {properties}. "
        f"Each realisation is one such {kind} with its own pattern of weak and strong zones, followed "
        f"until it comes to rest, for at most {study.time.end_s:g} s."
    )


def _random_property(study, field) -> str:
    (key, unit), settings = MEANS[field.variable], field.settings
    means = [(f"{getattr(study.material[k], key):g}{unit}", study.material[k].name) for k in field.materials]
    mean = means[0][0] if len(means) == 1 else " and ".join(f"{value} in {name}" for value, name in means)
    return (
        f"{field.name.replace('_', ' ')} has a mean of {mean} and a coefficient of variation of "
        f"{100 * settings.coefficient_of_variation:g} %, and stays alike over about "
        f"{settings.scale_of_fluctuation_h_m:g} m along and {settings.scale_of_fluctuation_v_m:g} m across the layering"
    )
